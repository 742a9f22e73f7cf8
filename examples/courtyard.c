/* courtyard.c - a roof over a courtyard: Figure 7 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

   A dome of planar panels that stands on the walls by compression alone, three times: (a) with fairness, (b) also with
   the wish that opposite edges of a panel carry the same force, (c) with 20 % more volume, but no edge longer and no
   panel larger than in (a). Diagonals meet the walls: edges along straight walls would force whole strips of panels
   into one plane. As many panels along as across: then the lines of the net, reflected at the walls, close. Writes
   courtyard_start.obj, and courtyard_a.obj, _b, _c and .svg (edges by their force).

   Build and run:   cc -O2 courtyard.c -lm -o courtyard && ./courtyard
   Prints:          the forces of (a) and (b), volume and bounds of (c) */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "../tools/forces.h" /* with math.h */
#include <stdio.h>
#include <string.h>

enum { SIDE = 20, MOST = (SIDE + 1) * (SIDE + 1) };

/* Diamonds around the points with odd i + j, triangles where the walls cut them. */
static gproj_mesh *make_dome(gproj_error *error) {
    static double position[3 * MOST];
    static int32_t degree[MOST], corner[4 * MOST], number[SIDE + 1][SIDE + 1];
    const double half_pi = 1.5707963267949;
    int32_t i, j, k, vertices = 0, faces = 0, corners = 0;
    for (i = 0; i <= SIDE; ++i)
        for (j = 0; j <= SIDE; ++j) {
            double x = 2.0 * i / SIDE - 1, y = 2.0 * j / SIDE - 1, *p = position + 3 * vertices;
            if ((i + j) % 2) continue;
            p[0] = 14 * x, p[1] = 10 * y, p[2] = 6 * cos(half_pi * x) * cos(half_pi * y);
            number[i][j] = vertices++;
        }
    for (i = 0; i <= SIDE; ++i)
        for (j = 0; j <= SIDE; ++j) {
            static const int step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
            if ((i + j) % 2 == 0) continue;
            degree[faces] = 0;
            for (k = 0; k < 4; ++k) {
                int32_t a = i + step[k][0], b = j + step[k][1];
                if (a < 0 || b < 0 || a > SIDE || b > SIDE) continue;
                corner[corners++] = number[a][b];
                ++degree[faces];
            }
            ++faces;
        }
    return gproj_mesh_create(vertices, position, faces, degree, corner, NULL, error);
}

typedef struct roof {
    gproj_mesh *mesh;
    gproj_forces forces;
    gproj_measures measures;
    double volume, density[4 * MOST];
} roof;

/* The wishes and the bounds of one of the three roofs: `like` has the largest edge and panel, NULL: no bounds. */
static bool design(roof *r, double volume, double force_fairness, const roof *like) {
    static int32_t support[MOST];
    gproj_supports supports = {0, support, NULL};
    gproj_loads loads = {0};
    gproj_error error;
    gproj_form *form;
    gproj_result result;
    int32_t v;
    r->mesh = make_dome(&error);
    if (!r->mesh || gproj_mesh_save(r->mesh, "courtyard_start.obj", &error)) return puts(error.message), false;
    form = gproj_form_create(r->mesh, NULL);
    for (v = 0; v < r->mesh->vertex_count; ++v)
        if (gproj_mesh_is_boundary_vertex(r->mesh, v)) support[supports.count++] = v;
    loads.area_load = 1;
    gproj_add_planarity(form, 1);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_compression(form, r->mesh->edge_count, NULL, 1);
    if (force_fairness > 0) gproj_add_force_fairness(form, force_fairness);
    if (like) {
        gproj_add_length_bounds(form, r->mesh->edge_count, NULL, 0, like->measures.max_edge, 1);
        gproj_add_area_bounds(form, r->mesh->face_count, NULL, 0, like->measures.max_face_area, 1);
    }
    gproj_add_volume(form, volume, 1);
    gproj_add_gliding_boundary(form, 1);
    gproj_add_closeness(form, 0.02);
    gproj_add_fairness(form, 0.02);
    result = gproj_solve(form, 24, NULL);
    r->forces = gproj_measure_forces(form, NULL);
    r->measures = gproj_measure(r->mesh, NULL, NULL);
    r->volume = gproj_volume(r->mesh);
    gproj_get_forces(form, r->density, NULL);
    gproj_form_destroy(form);
    if (result.outcome != GPROJ_CONVERGED) puts(result.message);
    return result.outcome == GPROJ_CONVERGED;
}

int main(void) {
    static roof a, b, c, *const all[3] = {&a, &b, &c};
    static const char *const title[3] = {"A roof over a courtyard", "With even forces", "With more volume"};
    bool stands = true, planar = true;
    int k;
    if (!design(&a, 1350, 0, NULL) || !design(&b, 1350, 0.05, NULL) || !design(&c, 1.2 * 1350, 0, &a)) return 1;
    for (k = 0; k < 3; ++k) {
        char name[] = "courtyard_?.svg";
        name[10] = (char)('a' + k);
        gprojx_picture_of_forces(name, title[k], all[k]->mesh, all[k]->density, a.forces.max_force, -62, 28);
        memcpy(name + 12, "obj", 3);
        gproj_mesh_save(all[k]->mesh, name, NULL);
        planar = planar && all[k]->measures.planarity_max <= 1e-9 && all[k]->measures.folded_edges == 0;
        stands = stands && all[k]->forces.residual <= 1e-9 && all[k]->forces.min_density >= -1e-9;
    }
    printf("all panels planar                  %s\n", planar ? "to 1e-9 mean edge lengths" : "no");
    printf("all stand by compression alone     %s\n", stands ? "to 1e-9" : "no");
    printf("(b) force fairness: largest force  %.0f %% less, at the same volume\n",
           100 * (1 - b.forces.max_force / a.forces.max_force));
    printf("(c) volume                         %.0f %% more\n", 100 * (c.volume / a.volume - 1));
    printf("(c) no edge longer than in (a)     %s\n",
           c.measures.max_edge <= a.measures.max_edge * (1 + 1e-9) ? "to 1e-9" : "no");
    printf("(c) no panel larger than in (a)    %s\n",
           c.measures.max_face_area <= a.measures.max_face_area * (1 + 1e-9) ? "to 1e-9" : "no");
    for (k = 0; k < 3; ++k) gproj_mesh_destroy(all[k]->mesh);
    return 0;
}
