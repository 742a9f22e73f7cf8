/* greenhouse.c - lifting a flat mesh: Figure 13 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

   A flat mesh of quads fills a curve on the ground. It is lifted: every vertex rises above its place until the net
   stands by compression alone. Then it moves freely, its panels become planar, and its edges meet the ground at right
   angles; tangential fairness guides with the paper's weight. Writes greenhouse_start.obj, greenhouse.obj and .svg.

   Build and run:   cc -O2 greenhouse.c -lm -o greenhouse && ./greenhouse
   Prints:          does it stand, are panels planar and angles right, and how steep it is at the ground: there a smooth
                    surface would meet the plane at a constant angle (Joachimsthal) */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "../tools/forces.h"

#include <math.h>
#include <stdio.h>

enum { LONG = 16, WIDE = 6, AROUND = 2 * (LONG + WIDE), RINGS = 8, EDGES = 1200 };

/* The ground curve, a bean, filled with quads: rings around a grid. */
static gproj_mesh *make_flat(gproj_error *error) {
    static const int32_t corner[] = {0, LONG, LONG + WIDE, 2 * LONG + WIDE};
    double curve[3 * AROUND] = {0};
    gproj_fill_options options = {0};
    int32_t j;
    for (j = 0; j < AROUND; ++j) {
        double turn = 6.28318530717959 * (j - LONG - 0.5 * WIDE) / AROUND;
        turn += 0.12 * sin(2 * turn); /* about equal distances */
        curve[3 * j] = 14 * cos(turn), curve[3 * j + 1] = 8 * sin(turn) - 1.5 * cos(2 * turn);
    }
    options.corner_count = 4, options.corners = corner;
    options.rings = RINGS;
    options.keep_points = true;
    return gproj_mesh_fill(AROUND, curve, &options, NULL, NULL, error);
}

/* What both steps share: load by the area of panels, supports on the ground, compression alone. */
static void stand(gproj_form *form, const gproj_mesh *mesh, const double *density) {
    static int32_t support[AROUND];
    gproj_loads loads = {0};
    gproj_supports supports = {AROUND, support, NULL};
    int32_t j;
    for (j = 0; j < AROUND; ++j) support[j] = j; /* the boundary comes first */
    loads.area_load = 1;
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_compression(form, mesh->edge_count, NULL, 1);
    gproj_add_gliding_boundary(form, 1);
    gproj_set_forces(form, density, NULL);
}

int main(void) {
    static double density[EDGES];
    gproj_schedule wish = {0.05, 0.95, 15};
    gproj_solve_options lift = {0};
    gproj_error error;
    gproj_mesh *mesh = make_flat(&error);
    gproj_form *form;
    gproj_forces forces;
    gproj_result result;
    double low = 90, high = 0;
    int32_t j, right;
    if (!mesh) return puts(error.message), 1;
    if (mesh->edge_count > EDGES) return 1;
    gproj_mesh_save(mesh, "greenhouse_start.obj", NULL);
    for (j = 0; j < mesh->edge_count; ++j) density[j] = 3; /* equal forces: in plan, the flat mesh is in equilibrium */
    form = gproj_form_create(mesh, NULL);
    gproj_add_lifting(form, 1);
    stand(form, mesh, density);
    lift.skip_closeness = true;
    lift.tolerance = 1e-10, lift.epsilon = 1e-6; /* keeps it so: lifting and equilibrium in plan depend on each other */
    result = gproj_solve(form, 20, &lift);
    if (result.outcome != GPROJ_CONVERGED) return puts(result.message), 1;
    gproj_get_forces(form, density, NULL);
    gproj_form_destroy(form);
    form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1);
    right = gproj_add_orthogonal_boundary(form, 1);
    stand(form, mesh, density);
    gproj_set_schedule(form, gproj_add_tangential_fairness(form, 1), wish);
    result = gproj_solve(form, 40, NULL);
    if (result.outcome != GPROJ_CONVERGED) return puts(result.message), 1;
    forces = gproj_measure_forces(form, NULL);
    for (j = 0; j < AROUND; ++j) {
        int32_t inner[3]; /* its neighbours: the middle one is not on the ground */
        const double *a = mesh->position + 3 * j, *b;
        gproj_mesh_one_ring(mesh, j, inner, 3);
        b = mesh->position + 3 * inner[1];
        double steep = atan2(b[2] - a[2], hypot(b[0] - a[0], b[1] - a[1]));
        low = fmin(low, 57.29577951308 * steep), high = fmax(high, 57.29577951308 * steep);
    }
    printf("panels planar         %s\n", gproj_measure(mesh, NULL, NULL).planarity_max <= 1e-9 ? "to 1e-9" : "no");
    printf("every vertex stands   %s\n", forces.residual <= 1e-9 ? "to 1e-9 of its load" : "no");
    printf("compression alone     %s\n", forces.min_density >= -1e-9 * forces.max_density ? "yes" : "no");
    printf("angles at the ground  %s\n", gproj_form_group_info(form, right).max <= 1e-9 ? "right to 1e-9" : "no");
    printf("slope at the ground   %.0f degrees, the same within %.1f\n", (low + high) / 2, high - low);
    printf("folded edges          %d\n", (int)gproj_measure(mesh, NULL, NULL).folded_edges);
    gproj_get_forces(form, density, NULL);
    gproj_mesh_save(mesh, "greenhouse.obj", NULL);
    gprojx_picture_of_forces("greenhouse.svg", "A greenhouse that stands by compression alone", mesh, density, 0, -62,
                             28);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return 0;
}
