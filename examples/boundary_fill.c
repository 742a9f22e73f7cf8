/* boundary_fill.c - one boundary, three combinatorics: Figure 4 of "Form-finding with Polyhedral Meshes Made Simple"
   (2014).

   A smooth closed curve on the ground is filled with quads three times: it makes a difference which of its points are
   taken as corners. One vertex of each mesh is then pulled up: an auxiliary projection, in which only fairness guides
   the others. At last all panels become planar. Writes boundary_fill_a.obj (3 corners), _b.obj (4) and _c.obj (5), and
   the flat meshes, boundary_fill_a_start.obj, _b_ and _c_.

   Build and run:   cc -O2 boundary_fill.c -lm -o boundary_fill && ./boundary_fill
   Prints:          what each mesh is like, how planar its panels are, and how far the three shapes are apart */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include <math.h>
#include <stdio.h>

enum { POINTS = 360, SHAPES = 3 };
#define EDGE 1.4

static double curve[3 * POINTS];

static void make_curve(void) {
    int i;
    for (i = 0; i < POINTS; ++i) {
        double turn = 6.28318530717959 * i / POINTS, r = 10 + 1.5 * cos(3 * turn) + 1.2 * sin(turn);
        curve[3 * i] = r * cos(turn), curve[3 * i + 1] = r * sin(turn);
    }
}

/* The curve filled, with corners at these points. */
static gproj_mesh *fill(int32_t corners, const int32_t *corner, gproj_fill_info *info, gproj_error *error) {
    gproj_fill_options options = {0};
    options.corner_count = corners, options.corners = corner;
    options.edge_length = EDGE;
    return gproj_mesh_fill(POINTS, curve, &options, info, NULL, error);
}

/* Pulls the vertex nearest to the origin up to this height; all others follow as fairness has it. */
static gproj_result lift(gproj_mesh *mesh, double height) {
    gproj_form *form = gproj_form_create(mesh, NULL);
    double target[3], *p = mesh->position;
    int32_t nearest = 0, i;
    gproj_result result;
    for (i = 1; i < mesh->vertex_count; ++i)
        if (hypot(p[3 * i], p[3 * i + 1]) < hypot(p[3 * nearest], p[3 * nearest + 1])) nearest = i;
    target[0] = p[3 * nearest], target[1] = p[3 * nearest + 1], target[2] = height;
    gproj_add_fixed_boundary(form, 1);
    gproj_add_targets(form, 1, &nearest, target, 1);
    gproj_add_closeness(form, 0.01);
    gproj_add_fairness(form, 0.3);
    result = gproj_solve(form, 10, NULL);
    gproj_form_destroy(form);
    return result;
}

/* Planar panels with the boundary on the curve: of all such meshes the one that is fairest, without being far away. */
static gproj_result make_planar(gproj_mesh *mesh) {
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_solve_options options = {0};
    gproj_result result;
    gproj_add_planarity(form, 1);
    gproj_add_gliding_boundary(form, 1);
    gproj_add_closeness(form, 0.05);
    gproj_add_fairness(form, 0.3);
    options.nearest = true;
    result = gproj_solve(form, 60, &options);
    gproj_form_destroy(form);
    return result;
}

/* The mean distance of the vertices of a from b. */
static double distance(const gproj_mesh *a, const gproj_mesh *b) {
    gproj_surface *surface = gproj_surface_create(b, NULL, NULL);
    double sum = 0;
    int32_t i;
    for (i = 0; i < a->vertex_count; ++i) sum += gproj_surface_closest(surface, a->position + 3 * i).distance;
    gproj_surface_destroy(surface);
    return sum / a->vertex_count;
}

int main(void) {
    static const int32_t three[] = {60, 180, 300}, four[] = {0, 90, 180, 270}, five[] = {0, 72, 144, 216, 288};
    static const int32_t *const corner[SHAPES] = {three, four, five};
    static const char *const name[SHAPES] = {"boundary_fill_a.obj", "boundary_fill_b.obj", "boundary_fill_c.obj"};
    static const char *const start[SHAPES] = {"boundary_fill_a_start.obj", "boundary_fill_b_start.obj",
                                              "boundary_fill_c_start.obj"};
    gproj_mesh *mesh[SHAPES];
    gproj_error error;
    int32_t k, i;
    make_curve();
    for (k = 0; k < SHAPES; ++k) {
        gproj_fill_info info;
        gproj_result lifted, result;
        gproj_measures measures;
        double highest = 0;
        mesh[k] = fill(3 + k, corner[k], &info, &error);
        if (!mesh[k]) return puts(error.message), 1;
        printf("%d corners: %d quads, %d of %d inner vertices irregular, angles %.0f to %.0f degrees\n", (int)(3 + k),
               (int)mesh[k]->face_count, (int)info.irregular_count,
               (int)(mesh[k]->vertex_count - info.boundary_count), info.min_angle, info.max_angle);
        gproj_mesh_save(mesh[k], start[k], NULL);
        lifted = lift(mesh[k], 5);
        result = make_planar(mesh[k]);
        if (lifted.outcome != GPROJ_CONVERGED) puts(lifted.message);
        if (result.outcome != GPROJ_CONVERGED) puts(result.message);
        measures = gproj_measure(mesh[k], NULL, NULL);
        for (i = 0; i < mesh[k]->vertex_count; ++i) highest = fmax(highest, mesh[k]->position[3 * i + 2]);
        printf("  panels planar %s, %d folded edges, %d crossed panels, %.1f high\n",
               measures.planarity_max <= 1e-9 ? "to 1e-9" : "no", (int)measures.folded_edges,
               (int)measures.bow_tie_faces, highest);
        gproj_mesh_save(mesh[k], name[k], NULL);
    }
    for (k = 0; k < SHAPES; ++k)
        printf("shapes with %d and %d corners are %.1f edge lengths apart\n", (int)(3 + k), (int)(3 + (k + 1) % SHAPES),
               distance(mesh[k], mesh[(k + 1) % SHAPES]) / EDGE);
    for (k = 0; k < SHAPES; ++k) gproj_mesh_destroy(mesh[k]);
    return 0;
}
