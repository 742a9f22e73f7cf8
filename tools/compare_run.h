/* compare_run.h - runs of the methods of tools/compare, all measured alike, and their tuning. */
#ifndef COMPARE_RUN_H
#define COMPARE_RUN_H

#include "compare.h"
#include <time.h>

/* One method with one tuning. Entry i is the state after after[i] iterations: after each of the first 100, then after
   each tenth, and at the end. Entry 0 is the start. */
typedef struct compare_run {
    const compare_method *method;
    double penalty, growth;
    int32_t count, *after;
    double *residual;  /* planarity, or the larger of planarity and circularity: see gproj_measures */
    double *deviation; /* root mean square of |v - p| over the diagonal of the bounding box */
    double *seconds;   /* processor time so far, with the preparation, without measuring */
    gproj_mesh *mesh;  /* the result */
    int32_t spoiled;   /* faces and edges: see gproj_spoiled */
} compare_run;

static double compare_seconds(void) { return (double)clock() / CLOCKS_PER_SEC; }

static void compare_record(compare_run *run, const compare_problem *problem, int32_t iteration, double seconds) {
    gproj_measures measures = gproj_measure(run->mesh, problem->original, NULL);
    double round = problem->circular ? measures.circularity_max : 0;
    run->after[run->count] = iteration;
    run->residual[run->count] = fmax(measures.planarity_max, round);
    run->deviation[run->count] = measures.deviation_rms;
    run->seconds[run->count++] = seconds;
}

static double compare_last(const compare_run *run, const double *value) { return value[run->count - 1]; }

/* Runs a method from the mesh, which stays as it is. Ends after `iterations`, when the method says so, or one that has a
   tuning at rounding errors. */
static compare_run compare_start(const compare_method *method, const gproj_mesh *mesh, bool circular,
                                 int32_t iterations, double penalty, double growth) {
    compare_run run = {method, penalty, growth, 0, NULL, NULL, NULL, NULL, gproj_mesh_copy(mesh, NULL, NULL), 0};
    compare_problem problem = {run.mesh, mesh->position, compare_list_faces(mesh), circular, iterations,
                               penalty,  growth};
    double begin, seconds = 0;
    bool more = true;
    int32_t done = 0;
    void *state;
    run.after = compare_take((size_t)iterations + 1, sizeof *run.after);
    run.residual = compare_take(3 * ((size_t)iterations + 1), sizeof *run.residual);
    run.deviation = run.residual + iterations + 1, run.seconds = run.deviation + iterations + 1;
    begin = compare_seconds();
    state = method->begin(&problem);
    seconds = compare_seconds() - begin;
    compare_record(&run, &problem, 0, seconds);
    while (more && done < iterations && !(method->penalty[0] > 0 && compare_last(&run, run.residual) <= 1e-14)) {
        begin = compare_seconds();
        more = method->step(&problem, state);
        seconds += compare_seconds() - begin;
        done += more;
        if (more && (done <= 100 || done % 10 == 0)) compare_record(&run, &problem, done, seconds);
    }
    if (run.after[run.count - 1] < done) compare_record(&run, &problem, done, seconds);
    run.spoiled = gproj_measure_spoiled(run.mesh, mesh->position).total;
    method->end(state);
    free(problem.faces.start), free(problem.faces.vertex);
    return run;
}

static void compare_run_free(compare_run *run) {
    free(run->after), free(run->residual);
    gproj_mesh_destroy(run->mesh);
}

static int32_t compare_iterations(const compare_run *run) { return run->after[run->count - 1]; }

/* The first entry with a residual of at most this; -1: there is none. */
static int32_t compare_find(const compare_run *run, double residual) {
    int32_t i;
    for (i = 0; i < run->count; ++i)
        if (run->residual[i] <= residual) return i;
    return -1;
}

/* The iterations that a run needs to a residual; -1: it does not get there. */
static int32_t compare_reaches(const compare_run *run, double residual) {
    int32_t i = compare_find(run, residual);
    return i < 0 ? -1 : run->after[i];
}

/* The criterion of the tuning. Runs that spoil nothing and end with at most this deviation come first: of these the one
   with the least residual, where all below 1e-12 count as equal and the fewest iterations to there decide. Of others the
   one with the least deviation comes first. */
static bool compare_is_better(const compare_run *a, const compare_run *b, double deviation) {
    double from_a = compare_last(a, a->deviation), from_b = compare_last(b, b->deviation);
    int32_t fast_a = compare_reaches(a, 1e-12), fast_b = compare_reaches(b, 1e-12);
    bool fits_a = from_a <= deviation && a->spoiled == 0, fits_b = from_b <= deviation && b->spoiled == 0;
    if (fits_a != fits_b) return fits_a;
    if (!fits_a) return from_a < from_b;
    if (fast_a >= 0 || fast_b >= 0) return fast_a >= 0 && (fast_b < 0 || fast_a < fast_b);
    return compare_last(a, a->residual) < compare_last(b, b->residual);
}

/* Runs short runs again and keeps the least seconds of each iteration: others use the machine, too. */
static void compare_repeat(compare_run *run, const gproj_mesh *mesh, bool circular, int32_t iterations) {
    double spent;
    int32_t i;
    for (spent = compare_last(run, run->seconds); spent < 0.1; spent += compare_last(run, run->seconds) + 1e-3) {
        compare_run again = compare_start(run->method, mesh, circular, iterations, run->penalty, run->growth);
        for (i = 0; i < run->count && i < again.count; ++i) run->seconds[i] = fmin(run->seconds[i], again.seconds[i]);
        compare_run_free(&again);
    }
}

/* Runs a method with each tuning of its grid, tells how that ended, and returns the best run. */
static compare_run compare_tune(const compare_method *method, const gproj_mesh *mesh, bool circular, int32_t iterations,
                                double deviation) {
    static const double none[2] = {1, 0};
    const double *penalty = method->penalty[0] > 0 ? method->penalty : none, *growth;
    compare_run best = {NULL, 0, 0, 0, NULL, NULL, NULL, NULL, NULL, 0};
    for (; *penalty > 0; ++penalty)
        for (growth = method->growth[0] > 0 ? method->growth : none; *growth > 0; ++growth) {
            compare_run run = compare_start(method, mesh, circular, iterations, *penalty, *growth);
            if (method->penalty[0] > 0)
                printf("  %-20s %7g %6g %12.1e %11d %12.1e %8d\n", method->name, *penalty, *growth,
                       compare_last(&run, run.residual), compare_iterations(&run), compare_last(&run, run.deviation),
                       run.spoiled);
            if (!best.method || compare_is_better(&run, &best, deviation)) {
                compare_run worse = best;
                best = run, run = worse;
            }
            compare_run_free(&run);
        }
    compare_repeat(&best, mesh, circular, iterations);
    return best;
}

#endif
