/* greenhouse.c - lifting a flat mesh: Figure 13 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

   A flat mesh of quads fills a curve on the ground. It is lifted: every vertex rises above its place until the net
   stands by compression alone. Then it moves freely, its panels become planar, and its edges meet the ground at right
   angles; tangential fairness guides with the paper's weight. Writes greenhouse.obj and .svg.

   Build and run:   cc -O2 greenhouse.c -lm -o greenhouse && ./greenhouse
   Prints:          does it stand, are panels planar and angles right, and how steep it is at the ground: there a smooth
                    surface would meet the plane at a constant angle (Joachimsthal) */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include "../tools/forces.h"

enum { LONG = 16, WIDE = 6, CORE = (LONG + 1) * (WIDE + 1), AROUND = 2 * (LONG + WIDE), RINGS = 8 };
enum { VERTICES = CORE + AROUND * RINGS, FACES = LONG * WIDE + AROUND * RINGS };

/* Vertex j of ring i: rings 1..RINGS lie around a rectangle of quads; ring 0 is the border of that. */
static int32_t ring_vertex(int32_t i, int32_t j) {
    j = (j + AROUND) % AROUND;
    if (i > 0) return CORE + (i - 1) * AROUND + j;
    if (j <= LONG) return j * (WIDE + 1);
    if (j <= LONG + WIDE) return LONG * (WIDE + 1) + j - LONG;
    return j <= 2 * LONG + WIDE ? (2 * LONG + WIDE - j) * (WIDE + 1) + WIDE : AROUND - j;
}

/* The last ring on the ground curve, a bean; all others in the middle of their neighbours. */
static gproj_mesh *make_flat(gproj_error *error) {
    static double position[3 * VERTICES];
    static int32_t degree[FACES], corner[4 * FACES];
    int32_t i, j, k, sweep, ring[8], *c = corner;
    gproj_mesh *mesh;
    for (i = 0; i < LONG * WIDE; ++i, c += 4)
        c[0] = i + i / WIDE, c[1] = c[0] + WIDE + 1, c[2] = c[1] + 1, c[3] = c[0] + 1;
    for (i = 0; i < AROUND * RINGS; ++i, c += 4) {
        c[0] = ring_vertex(i / AROUND, i % AROUND), c[1] = ring_vertex(i / AROUND + 1, i % AROUND);
        c[2] = ring_vertex(i / AROUND + 1, i % AROUND + 1), c[3] = ring_vertex(i / AROUND, i % AROUND + 1);
    }
    for (i = 0; i < FACES; ++i) degree[i] = 4;
    for (j = 0; j < AROUND; ++j) {
        double turn = 6.28318530717959 * (j - LONG - 0.5 * WIDE) / AROUND, *p = position + 3 * (VERTICES - AROUND + j);
        turn += 0.12 * sin(2 * turn); /* about equal distances */
        p[0] = 14 * cos(turn), p[1] = 8 * sin(turn) - 1.5 * cos(2 * turn);
    }
    mesh = gproj_mesh_create(VERTICES, position, FACES, degree, corner, NULL, error);
    for (sweep = 0; mesh && sweep < 3000 * 2; ++sweep)
        for (i = 0, k = sweep % 2; i < VERTICES - AROUND; ++i) {
            int32_t count = gproj_mesh_one_ring(mesh, i, ring, 8);
            double sum = 0;
            for (j = 0; j < count; ++j) sum += mesh->position[3 * ring[j] + k];
            mesh->position[3 * i + k] = sum / count;
        }
    return mesh;
}

/* What both steps share: load by the area of panels, supports on the ground, compression alone. */
static gproj_form *stand(gproj_mesh *mesh, const double *density) {
    static int32_t support[AROUND];
    gproj_loads loads = {0};
    gproj_supports supports = {AROUND, support, NULL};
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t j;
    for (j = 0; j < AROUND; ++j) support[j] = ring_vertex(RINGS, j);
    loads.area_load = 1;
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_compression(form, mesh->edge_count, NULL, 1);
    gproj_add_gliding_boundary(form, 1);
    gproj_set_forces(form, density);
    return form;
}

int main(void) {
    static double density[2 * FACES + AROUND];
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
    for (j = 0; j < mesh->edge_count; ++j) density[j] = 3; /* equal forces: in plan, the flat mesh is in equilibrium */
    form = stand(mesh, density);
    gproj_add_lifting(form, 1);
    lift.skip_closeness = true;
    lift.tolerance = 1e-10, lift.epsilon = 1e-6; /* keeps it so: lifting and equilibrium in plan depend on each other */
    result = gproj_solve(form, 20, &lift);
    if (result.outcome != GPROJ_CONVERGED) return puts(result.message), 1;
    gproj_get_forces(form, density);
    gproj_form_destroy(form);
    form = stand(mesh, density);
    gproj_add_planarity(form, 1);
    right = gproj_add_orthogonal_boundary(form, 1);
    gproj_set_schedule(form, gproj_add_tangential_fairness(form, 1), wish);
    result = gproj_solve(form, 40, NULL);
    if (result.outcome != GPROJ_CONVERGED) return puts(result.message), 1;
    forces = gproj_measure_forces(form);
    for (j = 0; j < AROUND; ++j) {
        const double *a = mesh->position + 3 * (VERTICES - AROUND + j), *b = a - 3 * AROUND; /* the ring above */
        double steep = atan2(b[2] - a[2], sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])));
        low = fmin(low, 57.29577951308 * steep), high = fmax(high, 57.29577951308 * steep);
    }
    printf("panels planar         %s\n", gproj_measure(mesh, NULL, NULL).planarity_max <= 1e-9 ? "to 1e-9" : "no");
    printf("every vertex stands   %s\n", forces.residual <= 1e-9 ? "to 1e-9 of its load" : "no");
    printf("compression alone     %s\n", forces.min_density >= -1e-9 * forces.max_density ? "yes" : "no");
    printf("angles at the ground  %s\n", gproj_form_group_info(form, right).max <= 1e-9 ? "right to 1e-9" : "no");
    printf("slope at the ground   %.0f degrees, the same within %.1f\n", (low + high) / 2, high - low);
    printf("folded edges          %d\n", (int)gproj_measure(mesh, NULL, NULL).folded_edges);
    gproj_get_forces(form, density);
    gproj_mesh_save(mesh, "greenhouse.obj", NULL);
    gprojx_picture_of_forces("greenhouse.svg", mesh, density, 0, -62, 28);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return 0;
}
