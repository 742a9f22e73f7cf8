/* planarize.c - the first program: flat panels on a free-form roof.

   Makes a doubly curved quad mesh whose panels are warped, makes all panels planar with the corners of the roof held,
   writes roof.obj (before) and planarize.obj (after), and prints what was done.

   Build and run:   cc -O2 planarize.c -lm -o planarize && ./planarize
   Prints:          see the end of main */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "grid.h"

#include <math.h>
#include <stdio.h>

enum { SIDE = 20 }; /* panels along each side */

/* Places vertex (i, j) of a waved canopy, whose grid lines do not follow the curvature: its panels are warped. */
static void canopy(int32_t i, int32_t j, double p[3]) {
    double x = (double)i / SIDE - 0.5, y = (double)j / SIDE - 0.5;
    p[0] = 20 * x;
    p[1] = 20 * y;
    p[2] = 2.2 * cos(6.5 * x) + 1.6 * cos(4.5 * y + 1.5 * x * x) + 1.5 * x * y;
}

int main(void) {
    gproj_error error;
    gproj_mesh *mesh = make_grid(SIDE, SIDE, canopy, &error);
    gproj_mesh *original = gproj_mesh_copy(mesh, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_measures before = gproj_measure(mesh, NULL, NULL), after;
    gproj_solve_options options = {0};
    gproj_result result;

    gproj_add_planarity(form, 1);     /* what must hold: every panel is planar, */
    gproj_add_fixed_corners(form, 1); /* and the four corners stay */
    options.smooth = true;            /* of all changes that do it, take the smoothest */
    result = gproj_solve(form, 300, &options);

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
