/* hybrid_fairing.c - fairing under planarity: Figure 3 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

   A roof of triangles and quads (a flying carpet) with planar panels that look restless: the normals jump from panel
   to panel. Keeping every panel planar, the boundary on its curve and the roof near its shape, the tangential fairness
   of the mesh and of its Gauss image (the mesh of the normals) make it calm. Writes hybrid_fairing_start.obj,
   hybrid_fairing_before.obj (planar panels) and hybrid_fairing.obj.

   Build and run:   cc -O2 hybrid_fairing.c -lm -o hybrid_fairing && ./hybrid_fairing
   Prints:          how much the variation of the Gauss map fell */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include <math.h>
#include <stdio.h>

enum { LONG = 24, WIDE = 14 };

/* A waved carpet with noise; every third strip of quads is cut into triangles. */
static gproj_mesh *make_carpet(gproj_error *error) {
    static double position[3 * (LONG + 1) * (WIDE + 1)];
    static int32_t degree[2 * LONG * WIDE], corner[6 * LONG * WIDE];
    uint32_t noise = 1;
    int32_t i, j, vertices = 0, faces = 0, corners = 0, k;
    for (i = 0; i <= LONG; ++i) {
        for (j = 0; j <= WIDE; ++j, ++vertices) {
            double x = i, y = j, bump;
            noise = noise * 1664525u + 1013904223u;
            bump = (i == 0 || j == 0 || i == LONG || j == WIDE) ? 0 : noise / 4294967296.0 - 0.5;
            position[3 * vertices] = x;
            position[3 * vertices + 1] = y;
            position[3 * vertices + 2] = 1.4 * sin(0.3 * x) - 0.06 * (y - 7) * (y - 7) + 0.3 * sin(0.1 * x * y / WIDE);
            position[3 * vertices + 2] += 0.6 * bump;
        }
    }
    for (i = 0; i < LONG; ++i) {
        for (j = 0; j < WIDE; ++j) {
            int32_t a = i * (WIDE + 1) + j, ring[4];
            ring[0] = a, ring[1] = a + WIDE + 1, ring[2] = a + WIDE + 2, ring[3] = a + 1;
            if (i % 3 == 1) {
                degree[faces] = degree[faces + 1] = 3;
                faces += 2;
                for (k = 0; k < 3; ++k) corner[corners++] = ring[k];
                for (k = 2; k < 5; ++k) corner[corners++] = ring[k % 4];
            } else {
                degree[faces++] = 4;
                for (k = 0; k < 4; ++k) corner[corners++] = ring[k];
            }
        }
    }
    return gproj_mesh_create(vertices, position, faces, degree, corner, NULL, error);
}

/* Planar panels, boundary on its curve; with `fair` also the wishes of the figure. */
static gproj_result shape(gproj_mesh *mesh, const gproj_surface *carpet, bool fair) {
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    gproj_add_planarity(form, 1);
    gproj_add_gliding_boundary(form, 1);
    if (fair) {
        gproj_add_reference(form, carpet, 0.1);
        gproj_add_boundary_fairness(form, 0.1);
        gproj_add_tangential_fairness(form, 0.1);
        gproj_add_gauss_fairness(form, 0.3);
    }
    result = gproj_solve(form, 16, NULL);
    gproj_form_destroy(form);
    return result;
}

int main(void) {
    gproj_error error;
    gproj_mesh *mesh = make_carpet(&error);
    gproj_surface *carpet = gproj_surface_create(mesh, NULL, &error);
    gproj_measures before, after;
    gproj_result flat, fair;
    gproj_mesh_save(mesh, "hybrid_fairing_start.obj", NULL);
    flat = shape(mesh, carpet, false);
    before = gproj_measure(mesh, NULL, NULL);
    gproj_mesh_save(mesh, "hybrid_fairing_before.obj", NULL);
    fair = shape(mesh, carpet, true);
    after = gproj_measure(mesh, NULL, NULL);
    if (flat.outcome != GPROJ_CONVERGED || fair.outcome != GPROJ_CONVERGED) {
        printf("not done: %s\n          %s\n", flat.message, fair.message);
        return 1;
    }
    printf("panels planar      %s\n", after.planarity_max < 1e-12 ? "to 1e-12 mean edge lengths" : "no");
    printf("Gauss variation    %.1f before, %.1f after: %.0f %% less\n", before.gauss_variation, after.gauss_variation,
           100 * (1 - after.gauss_variation / before.gauss_variation));
    printf("folded edges       %d\n", (int)after.folded_edges);
    gproj_mesh_save(mesh, "hybrid_fairing.obj", NULL);
    gproj_surface_destroy(carpet);
    gproj_mesh_destroy(mesh);
    return 0;
}
