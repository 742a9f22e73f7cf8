/* compare_claims.h - what the paper of each method claims, on small cases, before the methods are compared: so none of
   them is written worse than it is. */
#ifndef COMPARE_CLAIMS_H
#define COMPARE_CLAIMS_H

#include "compare_admm.h"
#include "compare_cubic.h"
#include "compare_poranne.h"
#include "compare_run.h"
#include "compare_shapeup.h"

static int compare_failures; /* claims that did not hold */

static void compare_claim(const compare_method *method, bool holds, const char *claim, const char *what,
                          double measured) {
    printf("  %-20s %s: %s = %.2g, %s\n", method->name, claim, what, measured, holds ? "holds" : "FAILS");
    compare_failures += !holds;
}

/* A warped square: its corners are at the height 0.2 over and under the least-squares plane z = 0. */
static void compare_warped_quad(int32_t i, int32_t j, double p[3]) { p[0] = i, p[1] = j, p[2] = i == j ? 0.2 : -0.2; }

/* A dome of 6 x 6 quads with dents, mean edge length 1. */
static void compare_patch(int32_t i, int32_t j, double p[3]) {
    double x = i - 3, y = j - 3;
    p[0] = 0.9 * x, p[1] = 0.9 * y, p[2] = -0.12 * (x * x + 0.7 * y * y + 0.2 * x * y) + 0.08 * sin(5 * x + 3 * y);
}

/* Runs a method on the patch. */
static compare_run compare_on_patch(const compare_method *method, bool circular, int32_t iterations, double penalty,
                                    double growth) {
    gproj_mesh *patch = make_grid(6, 6, compare_patch, NULL);
    compare_run run = compare_start(method, patch, circular, iterations, penalty, growth);
    gproj_mesh_destroy(patch);
    return run;
}

/* Tang et al. 2014: constraints are satisfied up to machine precision within a few iterations; so are cubic ones, if the
   mesh is not far from planar. */
static void compare_claim_guided(void) {
    compare_run normals = compare_on_patch(&compare_projection, false, 100, 0, 0);
    compare_run cubic = compare_on_patch(&compare_cubic, false, 100, 0, 0);
    int32_t a = compare_reaches(&normals, 1e-12), b = compare_reaches(&cubic, 1e-12);
    compare_claim(&compare_projection, a > 0 && a <= 10, "is planar to 1e-12 in at most 10 iterations", "iterations",
                  a);
    compare_claim(&compare_cubic, b > 0 && b <= 20, "is planar to 1e-12 in at most 20 iterations", "iterations", b);
    compare_run_free(&normals), compare_run_free(&cubic);
}

/* The height of the warped quad after one iteration, over that of its minimum, 0.2 / (1 + penalty), less 1. */
static double compare_height_error(const compare_method *method, double penalty) {
    gproj_mesh *quad = make_grid(1, 1, compare_warped_quad, NULL);
    compare_run run = compare_start(method, quad, false, 1, penalty, 1);
    double error = fabs(run.mesh->position[2] * (1 + penalty) / 0.2 - 1);
    compare_run_free(&run), gproj_mesh_destroy(quad);
    return error;
}

/* Runs Shape-Up on the patch; returns the largest rise of the energy in an iteration, over the energy at the start. */
static double compare_largest_rise(double penalty, bool circular) {
    gproj_mesh *patch = make_grid(6, 6, compare_patch, NULL), *mesh = gproj_mesh_copy(patch, NULL, NULL);
    compare_problem problem = {mesh, patch->position, compare_list_faces(mesh), circular, 300, penalty, 1};
    double before = compare_shapeup_energy(&problem), start = before, worst = -1;
    void *state = compare_shapeup_begin(&problem);
    int32_t i;
    for (i = 0; i < problem.iterations; ++i) {
        double after = (compare_shapeup_step(&problem, state), compare_shapeup_energy(&problem));
        worst = fmax(worst, (after - before) / start), before = after;
    }
    compare_shapeup_end(state);
    free(problem.faces.start), free(problem.faces.vertex);
    gproj_mesh_destroy(mesh), gproj_mesh_destroy(patch);
    return worst;
}

/* Bouaziz et al. 2012: the energy never rises, because local and global steps both minimise it. */
static void compare_claim_shapeup(void) {
    double penalty, worst = -1;
    for (penalty = 1; penalty < 1e9; penalty *= 100) worst = fmax(worst, compare_largest_rise(penalty, false));
    compare_claim(&compare_shapeup, worst < 1e-13, "the energy rises in no iteration", "largest rise", worst);
    worst = compare_height_error(&compare_shapeup, 100);
    compare_claim(&compare_shapeup, worst < 1e-12, "a warped quad goes to the minimum", "relative error", worst);
}

/* The largest distance of the vertices of two meshes. */
static double compare_distance(const gproj_mesh *a, const gproj_mesh *b) {
    double most = 0;
    int32_t i;
    for (i = 0; i < 3 * a->vertex_count; ++i) most = fmax(most, fabs(a->position[i] - b->position[i]));
    return most;
}

/* Deng et al. 2014: hard constraints hold while the soft ones are as small as can be, so the mesh is the nearest planar
   one, which the library finds by Newton's method with multipliers. */
static void compare_claim_admm(void) {
    compare_run run = compare_on_patch(&compare_admm, false, 5000, 10, 1);
    compare_run nearest = compare_on_patch(&compare_nearest, false, 50, 0, 0);
    double distance = compare_distance(nearest.mesh, run.mesh);
    compare_claim(&compare_admm, compare_reaches(&run, 1e-10) > 0, "hard constraints hold", "planarity",
                  compare_last(&run, run.residual));
    compare_claim(&compare_admm, distance < 1e-6, "is the nearest planar mesh", "distance from it", distance);
    compare_run_free(&nearest), compare_run_free(&run);
}

/* Poranne et al. 2013: as the penalty grows the faces become planar. */
static void compare_claim_poranne(void) {
    compare_run run = compare_on_patch(&compare_poranne, false, 1000, 1, 1.1);
    double error = compare_height_error(&compare_poranne, 100), worst = 0;
    int32_t i;
    for (i = 110; i < run.count && run.residual[i] > 1e-11; ++i)
        worst = fmax(worst, run.residual[i] / run.residual[i - 1]);
    compare_claim(&compare_poranne, compare_reaches(&run, 1e-11) > 0, "is planar at the end", "planarity",
                  compare_last(&run, run.residual));
    compare_claim(&compare_poranne, worst > 0 && worst < 0.5, "planarity falls as the penalty grows 2.6 times",
                  "largest factor", worst);
    compare_claim(&compare_poranne, error < 1e-12, "a warped quad goes to the minimum", "relative error", error);
    compare_run_free(&run);
}

/* Circles: the same for the three methods that know them. */
static void compare_claim_circles(void) {
    compare_run guided = compare_on_patch(&compare_projection, true, 100, 0, 0);
    compare_run admm = compare_on_patch(&compare_admm, true, 5000, 10, 1);
    int32_t a = compare_reaches(&guided, 1e-12);
    double rise = compare_largest_rise(1000, true);
    compare_claim(&compare_projection, a > 0 && a <= 15, "is circular to 1e-12 in at most 15 iterations", "iterations",
                  a);
    compare_claim(&compare_shapeup, rise < 1e-13, "circles: the energy rises in no iteration", "largest rise", rise);
    compare_claim(&compare_admm, compare_reaches(&admm, 1e-10) > 0, "circles: hard constraints hold", "residual",
                  compare_last(&admm, admm.residual));
    compare_run_free(&guided), compare_run_free(&admm);
}

/* Shows the claims of all methods. */
static void compare_show_claims(void) {
    puts("Claims of the methods' own papers, on a warped quad and on a patch of 6 x 6 warped quads:");
    compare_claim_guided();
    compare_claim_shapeup();
    compare_claim_admm();
    compare_claim_poranne();
    compare_claim_circles();
    puts("");
}

#endif
