/* bench.c - our solver and CHOLMOD on OpenBLAS side by side, on the systems of guided projection. */
#define _GNU_SOURCE
#include "bench.h"
#include "bench_mesh.h"
#include <sched.h>
#include <unistd.h>

enum {
    BENCH_SAMPLES_MAX = 400,
    BENCH_ITERATIONS = 6 /* of a solve; the first one is no sample */
};

typedef struct bench_problem {
    const char *name;
    bench_task task;
    bench_mesh (*mesh)(int32_t vertices);
    double bound[7]; /* of the ratio, at the sizes below */
} bench_problem;

static bench_mesh bench_open_mesh(int32_t vertices) { return bench_quads(vertices, false, false); }
static bench_mesh bench_dome_mesh(int32_t vertices) { return bench_quads(vertices, true, false); }

static const int32_t bench_size[7] = {500, 1000, 3500, 10000, 30000, 100000, 300000};
static const bench_problem bench_problems[] = {
    {"quad", BENCH_PLANARITY, bench_open_mesh, {0.35, 0.30, 0.25, 0.25, 0.25, 0.22, 0.20}},
    {"closed", BENCH_PLANARITY, bench_closed, {0.40, 0.35, 0.30, 0.30, 0.28, 0.28, 0.25}},
    {"hex", BENCH_PLANARITY, bench_hexagons, {0.50, 0.45, 0.45, 0.40, 0.40, 0.40, 0.40}},
    {"statics", BENCH_STATICS, bench_dome_mesh, {0.50, 0.45, 0.45, 0.40, 0.40, 0.40, 0}},
    {"fairness", BENCH_FAIRNESS, bench_open_mesh, {0.40, 0.35, 0.35, 0.35, 0.35, 0.35, 0.30}},
};
enum {
    BENCH_PROBLEMS = sizeof bench_problems / sizeof *bench_problems
};

/* Times of iterations, phase by phase; the last one is the whole. */
typedef struct bench_times {
    int count;
    double seconds[BENCH_PHASES + 1][BENCH_SAMPLES_MAX];
} bench_times;

static int bench_compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double bench_median(const double *value, int count) {
    double sorted[BENCH_SAMPLES_MAX];
    if (count == 0) return 0;
    memcpy(sorted, value, (size_t)count * sizeof *value);
    qsort(sorted, (size_t)count, sizeof *sorted, bench_compare);
    return count % 2 ? sorted[count / 2] : 0.5 * (sorted[count / 2 - 1] + sorted[count / 2]);
}

static void bench_sample(bench_times *times, const double seconds[BENCH_PHASES]) {
    double whole = 0;
    int p;
    if (times->count == BENCH_SAMPLES_MAX) return;
    for (p = 0; p < BENCH_PHASES; ++p) whole += times->seconds[p][times->count] = seconds[p];
    times->seconds[BENCH_PHASES][times->count++] = whole;
}

static double bench_phase(const bench_times *times, int phase) {
    return bench_median(times->seconds[phase], times->count);
}

/* One case under way. */
typedef struct bench_run {
    const bench_solver *solver;
    bench_form *form;
    bench_rows rows;
    bench_cholmod *cholmod;
    double *dx; /* CHOLMOD's next step */
    bool failed;
    double difference; /* largest of two steps, relative */
    double largest;    /* the first step */
    bench_times ours, theirs;
} bench_run;

static void bench_compare_steps(bench_run *run, const bench_step *step) {
    double size = 0, difference = 0, d;
    int32_t i;
    for (i = 0; i < step->variables; ++i) {
        d = step->dx[i] - run->dx[i];
        if (d < 0) d = -d;
        if (!(d <= difference)) difference = d;
        d = step->dx[i] < 0 ? -step->dx[i] : step->dx[i];
        if (d > size) size = d;
    }
    difference /= size;
    if (!(difference <= run->difference)) run->difference = difference;
}

static bool bench_visit_both(void *user, const bench_step *step) {
    bench_run *run = (bench_run *)user;
    double seconds[BENCH_PHASES];
    if (step->number > 1) {
        bench_compare_steps(run, step);
        bench_sample(&run->ours, step->seconds);
    }
    if (step->number == BENCH_ITERATIONS) return true;
    run->solver->rows(run->form, &run->rows);
    if (!run->cholmod) run->cholmod = bench_cholmod_create(&run->rows);
    if (!run->dx) run->dx = (double *)bench_take((size_t)step->variables, sizeof *run->dx);
    if (!run->cholmod || !bench_cholmod_step(run->cholmod, &run->rows, seconds, run->dx)) {
        run->failed = true;
        return false;
    }
    seconds[BENCH_REFRESH] = step->seconds[BENCH_REFRESH];
    bench_sample(&run->theirs, seconds);
    return true;
}

static void bench_run_case(const bench_problem *problem, int32_t vertices, int samples, double peak) {
    bench_mesh mesh = problem->mesh(vertices);
    bench_run *run = (bench_run *)bench_take(1, sizeof *run);
    bench_facts a, b;
    double began = bench_now(), ratio;
    int p;
    run->solver = &bench_simd;
    run->form = run->solver->create(&mesh, problem->task, 1);
    while (run->ours.count < samples || (bench_now() - began < 0.5 && run->ours.count + 8 < BENCH_SAMPLES_MAX))
        if (!run->solver->solve(run->form, BENCH_ITERATIONS, bench_visit_both, run) || run->failed) exit(1);
    a = run->solver->facts(run->form);
    b = bench_cholmod_facts(run->cholmod);
    ratio = bench_phase(&run->ours, BENCH_PHASES) / bench_phase(&run->theirs, BENCH_PHASES);
    printf("%-8s %6d %7d %8.2f %8.2f %7.3f %7.3f", problem->name, a.vertices, a.unknowns, 1e-6 * a.entries,
           1e-6 * b.entries, 1e-9 * a.flops, 1e-9 * b.flops);
    for (p = 0; p <= BENCH_PHASES; ++p) printf(" %8.3f", 1e3 * bench_phase(&run->ours, p));
    printf(" |");
    for (p = 1; p <= BENCH_PHASES; ++p) printf(" %8.3f", 1e3 * bench_phase(&run->theirs, p));
    printf(" | %.0f%% setup %.2f/%.2f ms mem %.0f/%.0f kB diff %.1e n %d\n",
           100 * a.flops / bench_phase(&run->ours, BENCH_FACTOR) / peak, 1e3 * a.setup_seconds, 1e3 * b.setup_seconds,
           1e-3 * a.peak_bytes, 1e-3 * (a.rows_bytes + b.peak_bytes), run->difference, run->ours.count);
    printf("ratio %s %d %.3f\n", problem->name, vertices, ratio);
    fflush(stdout);
    bench_cholmod_destroy(run->cholmod);
    bench_rows_free(&run->rows);
    run->solver->destroy(run->form);
    bench_mesh_free(&mesh);
    free(run->dx);
    free(run);
}

static bool bench_set_environment(void) {
    bool all = getenv("OPENBLAS_CORETYPE") != NULL;
    if (!all && __builtin_cpu_supports("avx512f")) setenv("OPENBLAS_CORETYPE", "SkylakeX", 1);
    else if (!all && __builtin_cpu_supports("avx2")) setenv("OPENBLAS_CORETYPE", "Haswell", 1);
    setenv("OMP_NUM_THREADS", "1", 1);
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    setenv("OMP_THREAD_LIMIT", "1", 1);
    return all;
}

int main(int argc, char **argv) {
    double peak;
    int p, s, samples = 9;
    const char *only = NULL;
    int32_t size = 0;
    cpu_set_t set;
    if (!getenv("BENCH_STARTED")) {
        setenv("BENCH_STARTED", "1", 1);
        bench_set_environment();
        execv("/proc/self/exe", argv);
    }
    CPU_ZERO(&set);
    CPU_SET(sched_getcpu(), &set);
    sched_setaffinity(0, sizeof set, &set);
    for (p = 1; p < argc; ++p) {
        if (!strcmp(argv[p], "--problem") && p + 1 < argc) only = argv[++p];
        if (!strcmp(argv[p], "--size") && p + 1 < argc) size = atoi(argv[++p]);
        if (!strcmp(argv[p], "--samples") && p + 1 < argc) samples = atoi(argv[++p]);
    }
    peak = bench_dgemm_peak();
    bench_describe(stdout, peak);
    for (p = 0; p < BENCH_PROBLEMS; ++p)
        for (s = 0; s < 4; ++s)
            if ((!only || !strcmp(only, bench_problems[p].name)) && (!size || size == bench_size[s]))
                bench_run_case(&bench_problems[p], bench_size[s], samples, peak);
    return 0;
}
