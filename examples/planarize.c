/* planarize.c - the first program: flat panels on a free-form roof.

   Makes a doubly curved quad mesh whose panels are warped, makes all panels planar with the corners of the roof held,
   writes roof.obj (before) and planarize.obj (after), and prints what was done.

   Build and run:   cc -O2 planarize.c -lm -o planarize && ./planarize
   Prints:          see the end of main */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

enum { SIDE = 20 }; /* panels along each side */

/* A waved canopy. Its grid lines do not follow the curvature of the surface, so its panels are warped. */
static gproj_mesh *make_roof(gproj_error *error) {
    static double position[3 * (SIDE + 1) * (SIDE + 1)];
    static int32_t degree[SIDE * SIDE], corner[4 * SIDE * SIDE];
    int32_t i, j, vertices = 0, faces = 0;
    for (i = 0; i <= SIDE; ++i) {
        for (j = 0; j <= SIDE; ++j, ++vertices) {
            double x = (double)i / SIDE - 0.5, y = (double)j / SIDE - 0.5;
            position[3 * vertices] = 20 * x;
            position[3 * vertices + 1] = 20 * y;
            position[3 * vertices + 2] = 2.2 * cos(6.5 * x) + 1.6 * cos(4.5 * y + 1.5 * x * x) + 1.5 * x * y;
        }
    }
    for (i = 0; i < SIDE; ++i) {
        for (j = 0; j < SIDE; ++j, ++faces) {
            int32_t first = i * (SIDE + 1) + j;
            degree[faces] = 4;
            corner[4 * faces] = first;
            corner[4 * faces + 1] = first + SIDE + 1;
            corner[4 * faces + 2] = first + SIDE + 2;
            corner[4 * faces + 3] = first + 1;
        }
    }
    return gproj_mesh_create(vertices, position, faces, degree, corner, NULL, error);
}

int main(void) {
    gproj_error error;
    gproj_mesh *mesh = make_roof(&error);
    gproj_mesh *original = gproj_mesh_copy(mesh, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_measures before = gproj_measure(mesh, NULL, NULL), after;
    gproj_result result;

    gproj_add_planarity(form, 1);     /* what must hold: every panel is planar, */
    gproj_add_fixed_corners(form, 1); /* and the four corners stay */
    result = gproj_solve(form, 12, NULL);

    if (result.outcome != GPROJ_CONVERGED || !original) {
        printf("no flat roof: %s\n", result.message);
        return 1;
    }
    after = gproj_measure(mesh, original->position, NULL);
    printf("panels           %d\n", (int)mesh->face_count);
    printf("warped by        %.3f mean edge lengths before\n", before.planarity_max);
    printf("all planar       %s\n", after.planarity_max < 1e-12 ? "to 1e-12 mean edge lengths" : "no");
    printf("vertices moved   %.2f mean edge lengths on average\n", after.displacement_mean);
    printf("turned panels    %d\n", (int)after.turned_faces);
    gproj_mesh_save(original, "roof.obj", NULL);
    gproj_mesh_save(mesh, "planarize.obj", NULL);

    gproj_form_destroy(form);
    gproj_mesh_destroy(original);
    gproj_mesh_destroy(mesh);
    return 0;
}
