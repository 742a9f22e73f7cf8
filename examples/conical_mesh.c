/* conical_mesh.c - a hall whose two layers have constant distance: section 3.5 of "Form-finding with Polyhedral Meshes
   Made Simple" (2014).

   A vaulted hall follows a bent street; its surface is rippled, so its quads are warped. Made planar and conical, it has a
   parallel mesh: every panel of it is at the same distance from its panel below, for glass of constant thickness. The
   beams between the two layers are flat and meet in the axes of the nodes. Writes conical_start.obj, conical_mesh.obj,
   conical_offset.obj and conical_support.obj, one quad a beam.

   Build and run:   cc -O2 conical_mesh.c -lm -o conical_mesh && ./conical_mesh
   Prints:          what holds, and how exactly the layers are parallel */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "grid.h"

#include <math.h>
#include <stdio.h>

enum { LONG = 28, WIDE = 10 };

/* Places vertex j of arch i, which is orthogonal to the street; ripples run across the lines of the mesh. */
static void hall(int32_t i, int32_t j, double p[3]) {
    double x = 0, y = 0, turn = 0, angle = 2.4 * j / WIDE - 1.2, ripple = 1 + 0.03 * sin(0.8 * i + 0.9 * j);
    int32_t k;
    for (k = 0; k < i; ++k) { /* along the street */
        x += cos(turn);
        y += sin(turn);
        turn += 0.1 * sin(0.2 * k);
    }
    p[0] = x - 5 * ripple * sin(angle) * sin(turn);
    p[1] = y + 5 * ripple * sin(angle) * cos(turn);
    p[2] = 4 * ripple * cos(angle);
}

static void say(const char *what, double value) {
    printf("%s  %s\n", what, value <= 1e-9 ? "to 1e-9: yes" : "to 1e-9: no");
}

int main(void) {
    const double distance = 0.4;
    gproj_error error;
    gproj_mesh *mesh = make_grid(LONG, WIDE, hall, &error), *offset, *support;
    gproj_measures before = gproj_measure(mesh, NULL, NULL), after;
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_offset_measures between;
    gproj_result result;
    gproj_mesh_save(mesh, "conical_start.obj", NULL);
    gproj_add_planarity(form, 1);
    gproj_add_conicality(form, 1);
    gproj_add_closeness(form, 0.03);
    gproj_add_fairness(form, 0.01);
    result = gproj_solve(form, 12, NULL);
    offset = gproj_mesh_face_offset(mesh, distance, NULL, &error);
    support = gproj_mesh_support(mesh, offset, NULL, &error);
    if (result.outcome != GPROJ_CONVERGED || !support) return printf("%s; %s\n", result.message, error.message), 1;
    after = gproj_measure(mesh, NULL, NULL);
    between = gproj_measure_offset(mesh, offset);
    printf("before             planar to %.2f, conical to %.2f\n", before.planarity_max, before.conicality_max);
    say("panels planar    ", after.planarity_max);
    say("nodes conical    ", after.conicality_max);
    say("constant distance",
        fmax(distance - between.face_distance_min, between.face_distance_max - distance) / after.mean_edge);
    say("edges parallel   ", between.parallel_max);
    say("beams planar     ", gproj_measure(support, NULL, NULL).planarity_max);
    printf("folded edges       %d, reversed %d\n", (int)after.folded_edges, (int)between.reversed_edges);
    gproj_mesh_save(mesh, "conical_mesh.obj", NULL);
    gproj_mesh_save(offset, "conical_offset.obj", NULL);
    gproj_mesh_save(support, "conical_support.obj", NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(support);
    gproj_mesh_destroy(offset);
    gproj_mesh_destroy(mesh);
    return 0;
}
