/* circular_mesh.c - nodes at constant distance: section 3.5 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

   A funnel of revolution, bent by an inversion in a sphere, which turns circles into circles, and then dented by wind.
   Made planar and circular again, it has a parallel mesh whose nodes are all at the same distance from the nodes below, so
   that all the struts between them have one length, and the panels between the layers are flat. Writes
   circular_start.obj, circular_mesh.obj, circular_offset.obj and circular_support.obj, one quad a panel.

   Build and run:   cc -O2 circular_mesh.c -lm -o circular_mesh && ./circular_mesh
   Prints:          what holds, and how exactly the layers are parallel */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "grid.h"

#include <math.h>
#include <stdio.h>

enum { AROUND = 26, HIGH = 10 };

/* x -> c + r^2 (x - c) / |x - c|^2 */
static void invert(double p[3]) {
    static const double centre[3] = {9, 0, 5};
    double d[3], square = 0;
    int k;
    for (k = 0; k < 3; ++k) {
        d[k] = p[k] - centre[k];
        square += d[k] * d[k];
    }
    for (k = 0; k < 3; ++k) p[k] = centre[k] + 60 * d[k] / square;
}

/* Places vertex (i, j): row i of the height, column j of three quarters of the way round, so that there is no hole. */
static void funnel(int32_t i, int32_t j, double p[3]) {
    double turn = 4.7 * j / AROUND + 0.8, z = 0.56 * i;
    double radius = 1.2 + 0.08 * z * z + 0.06 * sin(1.1 * j + 0.9 * i); /* with dents */
    p[0] = radius * cos(turn);
    p[1] = radius * sin(turn);
    p[2] = z;
    invert(p);
}

static void say(const char *what, double value) {
    printf("%s  %s\n", what, value <= 1e-9 ? "to 1e-9: yes" : "to 1e-9: no");
}

int main(void) {
    const double distance = 0.2;
    gproj_error error;
    gproj_mesh *mesh = make_grid(HIGH, AROUND, funnel, &error), *offset, *support;
    gproj_measures before = gproj_measure(mesh, NULL, NULL), after;
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_offset_measures between;
    gproj_result result;
    gproj_mesh_save(mesh, "circular_start.obj", NULL);
    gproj_add_planarity(form, 1);
    gproj_add_circularity(form, 1);
    gproj_add_closeness(form, 0.03);
    gproj_add_fairness(form, 0.02);
    result = gproj_solve(form, 12, NULL);
    offset = gproj_mesh_vertex_offset(mesh, distance, NULL, &error);
    support = gproj_mesh_support(mesh, offset, NULL, &error);
    if (result.outcome != GPROJ_CONVERGED || !support) return printf("%s; %s\n", result.message, error.message), 1;
    after = gproj_measure(mesh, NULL, NULL);
    between = gproj_measure_offset(mesh, offset);
    printf("before             planar to %.2f, circular to %.2f\n", before.planarity_max, before.circularity_max);
    say("panels planar    ", after.planarity_max);
    say("panels circular  ", after.circularity_max);
    say("constant distance",
        fmax(distance - between.vertex_distance_min, between.vertex_distance_max - distance) / after.mean_edge);
    say("edges parallel   ", between.parallel_max);
    say("supports planar  ", gproj_measure(support, NULL, NULL).planarity_max);
    printf("folded edges       %d, reversed %d\n", (int)after.folded_edges, (int)between.reversed_edges);
    gproj_mesh_save(mesh, "circular_mesh.obj", NULL);
    gproj_mesh_save(offset, "circular_offset.obj", NULL);
    gproj_mesh_save(support, "circular_support.obj", NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(support);
    gproj_mesh_destroy(offset);
    gproj_mesh_destroy(mesh);
    return 0;
}
