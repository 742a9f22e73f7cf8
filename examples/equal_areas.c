/* equal_areas.c - panels of equal areas: Figure 6 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

   An oval dome of hexagons with an opening at its top. It is solved twice, with planar panels, the boundaries on their
   curves and the dome near its shape: without and with the wish that all panels have one area. Writes
   equal_areas_start.obj, equal_areas_without.obj and equal_areas.obj.

   Build and run:   cc -O2 equal_areas.c -lm -o equal_areas && ./equal_areas
   Prints:          the spread of the areas (standard deviation over mean) without and with the wish */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include <math.h>
#include <stdio.h>

enum { ROUND = 88, RINGS = 11 }; /* vertices around (even), rings of panels (odd) */

/* The point of the dome at angle `turn` in 0..1 and height parameter `up` in 0 (ground) .. 1 (opening). */
static void dome(double turn, double up, double out[3]) {
    double angle = 6.283185307179586 * turn, slope = 0.1 + 1.1 * up;
    out[0] = 12 * cos(slope) * cos(angle), out[1] = 9 * cos(slope) * sin(angle);
    out[2] = 7 * (sin(slope) - sin(0.1));
}

/* Vertex i of line j; the lines at the ground and at the opening have every second one only. */
static int32_t vertex(int32_t j, int32_t i) {
    int32_t inner = ROUND / 2 + (j - 1) * ROUND;
    return j == 0 ? i % ROUND / 2 : j == RINGS ? inner + i % ROUND / 2 : inner + i % ROUND;
}

/* Rings of hexagons like bricks, three vertices on the line below and three above; of pentagons first and last. */
static gproj_mesh *make_dome(gproj_error *error) {
    static double position[3 * ROUND * RINGS];
    static int32_t degree[ROUND / 2 * RINGS], corner[3 * ROUND * RINGS];
    int32_t i, j, k, faces = 0, corners = 0;
    for (j = 0; j <= RINGS; ++j)
        for (i = 0; i < ROUND; i += j % RINGS ? 1 : 2) {
            double zigzag = j % RINGS == 0 ? 0 : (i + j) % 2 ? -0.17 : 0.17;
            dome((double)i / ROUND, (j + zigzag) / RINGS, position + 3 * vertex(j, i));
        }
    for (j = 0; j < RINGS; ++j)
        for (i = j % 2; i < ROUND; i += 2) {
            int32_t first = corners;
            for (k = 0; k < 3; k += j == 0 ? 2 : 1) corner[corners++] = vertex(j, i + k);
            for (k = 2; k >= 0; k -= j == RINGS - 1 ? 2 : 1) corner[corners++] = vertex(j + 1, i + k);
            degree[faces++] = corners - first;
        }
    return gproj_mesh_create(ROUND * RINGS, position, faces, degree, corner, NULL, error);
}

/* Makes the panels planar, with this weight of equal areas, and writes the mesh. */
static gproj_measures shape(const gproj_mesh *original, double equal_areas, const char *path) {
    gproj_measures measures;
    gproj_mesh *mesh = gproj_mesh_copy(original, NULL, NULL);
    gproj_surface *surface = gproj_surface_create(original, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    gproj_add_planarity(form, 1);
    gproj_add_gliding_boundary(form, 1);
    gproj_add_reference(form, surface, 0.1);
    gproj_add_boundary_fairness(form, 0.05);
    gproj_add_tangential_fairness(form, 0.05);
    if (equal_areas > 0) gproj_add_equal_areas(form, equal_areas);
    result = gproj_solve(form, 30, NULL);
    measures = gproj_measure(mesh, original->position, NULL);
    if (result.outcome != GPROJ_CONVERGED) printf("not done: %s\n", result.message);
    gproj_mesh_save(mesh, path, NULL);
    gproj_form_destroy(form);
    gproj_surface_destroy(surface);
    gproj_mesh_destroy(mesh);
    return measures;
}

int main(void) {
    gproj_error error;
    gproj_mesh *mesh = make_dome(&error);
    gproj_measures without, with;
    if (!mesh) return puts(error.message), 1;
    gproj_mesh_save(mesh, "equal_areas_start.obj", NULL);
    without = shape(mesh, 0, "equal_areas_without.obj");
    with = shape(mesh, 0.2, "equal_areas.obj");
    printf("panels planar        %s\n",
           without.planarity_max < 1e-9 && with.planarity_max < 1e-9 ? "to 1e-9 mean edge lengths" : "no");
    printf("spread of the areas  %.2f without the wish\n", without.area_spread);
    printf("                     %s with it\n", with.area_spread < 0.01 ? "less than 0.01" : "0.01 or more");
    printf("largest to smallest  %.1f without, %.2f with\n", without.max_face_area / without.min_face_area,
           with.max_face_area / with.min_face_area);
    printf("crossed or turned    %d\n", (int)(with.bow_tie_faces + with.turned_faces + with.folded_edges));
    gproj_mesh_destroy(mesh);
    return 0;
}
