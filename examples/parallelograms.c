/* parallelograms.c - panels like parallelograms: Figure 8 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

   A canopy of quads on five feet, smooth at first. It is solved twice, with planar panels, the feet in place and the
   canopy near its shape: without and with the wish that quads are parallelograms. With it, ribs emerge between the
   five sectors: the combinatorics and the wanted shape of the panels make them. Writes parallelograms_start.obj,
   parallelograms_without.obj and parallelograms.obj.

   Build and run:   cc -O2 parallelograms.c -lm -o parallelograms && ./parallelograms
   Prints:          the mean of |v1 - v2 + v3 - v4| over the panels, in mean edge lengths, without and with the wish */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include <math.h>
#include <stdio.h>

enum { FEET = 5, SIDE = 12, SECTOR = SIDE * (SIDE + 1) }; /* SIDE x SIDE panels in each sector */

/* Vertex (a, b) of a sector; its side a = 0 is the side b = 0 of the next one, and (0, 0) is the middle of all. */
static int32_t vertex(int32_t sector, int32_t a, int32_t b) {
    if (a == 0 && b == 0) return 0;
    if (a == 0) return vertex(sector + 1, b, 0);
    return 1 + sector % FEET * SECTOR + (a - 1) * (SIDE + 1) + b;
}

static gproj_mesh *make_canopy(gproj_error *error) {
    static double position[3 * (1 + FEET * SECTOR)] = {0, 0, 7};
    static int32_t degree[FEET * SIDE * SIDE], corner[4 * FEET * SIDE * SIDE];
    const double turn = 6.283185307179586 / FEET;
    int32_t s, a, b, faces = 0;
    for (s = 0; s < FEET; ++s)
        for (a = 0; a <= SIDE; ++a)
            for (b = 0; b <= SIDE; ++b) {
                double *p = position + 3 * vertex(s, a, b), bend = 1 - 0.27 * a * b / (SIDE * SIDE);
                p[0] = bend * (a * cos(turn * s) + b * cos(turn * (s + 1)));
                p[1] = bend * (a * sin(turn * s) + b * sin(turn * (s + 1)));
                p[2] = 7 - 7 * (p[0] * p[0] + p[1] * p[1]) / (1.5 * SIDE * SIDE);
            }
    for (s = 0; s < FEET; ++s)
        for (a = 0; a < SIDE; ++a)
            for (b = 0; b < SIDE; ++b, ++faces) {
                degree[faces] = 4;
                corner[4 * faces] = vertex(s, a, b), corner[4 * faces + 1] = vertex(s, a + 1, b);
                corner[4 * faces + 2] = vertex(s, a + 1, b + 1), corner[4 * faces + 3] = vertex(s, a, b + 1);
            }
    return gproj_mesh_create(1 + FEET * SECTOR, position, faces, degree, corner, NULL, error);
}

/* The mean of |v1 - v2 + v3 - v4| over all panels, in mean edge lengths. */
static double skew(const gproj_mesh *mesh) {
    double sum = 0;
    int32_t f, k;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        double d[3] = {0, 0, 0};
        for (k = 0; k < 12; ++k) {
            d[k % 3] += (k / 3 % 2 ? -1 : 1) * mesh->position[3 * mesh->origin[h] + k % 3];
            if (k % 3 == 2) h = mesh->next[h];
        }
        sum += sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
    return sum / mesh->face_count / gproj_mesh_mean_edge_length(mesh);
}

/* Makes the panels planar, with this weight of the wish, and writes the mesh; false where it did not converge. */
static bool shape(gproj_mesh *mesh, double parallelograms, const char *path) {
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    int32_t s, feet[FEET];
    for (s = 0; s < FEET; ++s) feet[s] = vertex(s, SIDE, SIDE);
    gproj_add_planarity(form, 1);
    gproj_add_fixed(form, FEET, feet, 1);
    gproj_add_closeness(form, 0.02);
    gproj_add_fairness(form, 0.05);
    gproj_add_parallelograms(form, parallelograms);
    result = gproj_solve(form, 24, NULL);
    gproj_mesh_save(mesh, path, NULL);
    gproj_form_destroy(form);
    return result.outcome == GPROJ_CONVERGED;
}

int main(void) {
    gproj_error error;
    gproj_mesh *mesh = make_canopy(&error), *other = mesh ? gproj_mesh_copy(mesh, NULL, &error) : NULL;
    gproj_measures measures;
    if (!mesh || !other) return puts(error.message), 1;
    gproj_mesh_save(mesh, "parallelograms_start.obj", NULL);
    if (!shape(mesh, 0, "parallelograms_without.obj") || !shape(other, 2, "parallelograms.obj"))
        return puts("the panels do not become planar"), 1;
    measures = gproj_measure(other, NULL, NULL);
    printf("panels planar            %s\n", measures.planarity_max < 1e-9 ? "to 1e-9 mean edge lengths" : "no");
    printf("off parallelograms by    %.3f mean edge lengths without the wish\n", skew(mesh));
    printf("                         %.3f with it\n", skew(other));
    printf("folded or crossed        %d\n", (int)(measures.folded_edges + measures.bow_tie_faces));
    gproj_mesh_destroy(mesh), gproj_mesh_destroy(other);
    return 0;
}
