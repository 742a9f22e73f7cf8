/* bench.c - our solver and CHOLMOD on OpenBLAS side by side, on the systems of guided projection: see --help.

   Ours is the real iteration, gproj_solve with a clock. CHOLMOD's is on the same rows: after an iteration they are
   linearised for the next one, and are handed over. Every solve begins at the same mesh, takes a few steps and gives as
   many samples. Where the caches can hold a factor, each solver has them to itself while it is measured, as it would in a
   program; larger ones take turns. */
#define _GNU_SOURCE
#include "bench.h"
#include "bench_machine.h"
#include "bench_mesh.h"
#include "bench_report.h"
#include <dirent.h>

enum {
    BENCH_SAMPLES_MAX = 400,
    BENCH_ITERATIONS = 6,   /* of a solve; the first one gives no sample */
    BENCH_WHOLE_SOLVE = 50, /* limit of a default solve, which goes to its end */
    BENCH_SET_UPS = 9,      /* at most */
    BENCH_CHOSEN = 32,      /* problems and sizes that may be named */
    BENCH_CASES = 256
};

typedef struct bench_problem {
    const char *name;
    bench_task task;
    bench_mesh (*mesh)(int32_t vertices);
    double bound[7]; /* of the ratio, at the sizes below; 0: none */
} bench_problem;

static bench_mesh bench_quad_mesh(int32_t vertices) { return bench_quads(vertices, false, false); }
static bench_mesh bench_dome_mesh(int32_t vertices) { return bench_quads(vertices, true, false); }
static bench_mesh bench_hybrid_mesh(int32_t vertices) { return bench_quads(vertices, false, true); }

static const int32_t bench_nominal[7] = {500, 1000, 3500, 10000, 30000, 100000, 300000};
static const bench_problem bench_problems[] = {
    {"quad", BENCH_PLANARITY, bench_quad_mesh, {0.35, 0.30, 0.25, 0.25, 0.25, 0.22, 0.20}},
    {"closed", BENCH_PLANARITY, bench_closed, {0.40, 0.35, 0.30, 0.30, 0.28, 0.28, 0.25}},
    {"hex", BENCH_PLANARITY, bench_hexagons, {0.50, 0.45, 0.45, 0.40, 0.40, 0.40, 0.40}},
    {"statics", BENCH_STATICS, bench_dome_mesh, {0.50, 0.45, 0.45, 0.40, 0.40, 0.40, 0}},
    {"fairness", BENCH_FAIRNESS, bench_quad_mesh, {0.40, 0.35, 0.35, 0.35, 0.35, 0.35, 0.30}},
    {"hybrid", BENCH_PLANARITY, bench_hybrid_mesh, {0}},
    {"volume", BENCH_VOLUME, bench_closed, {0}},
    {"default", BENCH_DEFAULT, bench_closed, {0}},
};
enum {
    BENCH_PROBLEMS = sizeof bench_problems / sizeof *bench_problems,
    BENCH_QUICK_PROBLEMS = 5,
    BENCH_QUICK_SIZE = 10000
};

typedef struct bench_options {
    int problems, sizes, samples;
    const char *problem[BENCH_CHOSEN];
    int32_t size[BENCH_CHOSEN];
    bool quick, markdown;
    const char *json, *svg; /* files; NULL: none */
} bench_options;

/* -- samples -- */

/* Times of iterations: the phases and the whole. */
typedef struct bench_samples {
    int count;
    double seconds[BENCH_TIMES][BENCH_SAMPLES_MAX];
} bench_samples;

static void bench_add_sample(bench_samples *samples, const double seconds[BENCH_PHASES]) {
    double whole = 0;
    int p;
    if (samples->count == BENCH_SAMPLES_MAX) return;
    for (p = 0; p < BENCH_PHASES; ++p) whole += samples->seconds[p][samples->count] = seconds[p];
    samples->seconds[BENCH_WHOLE][samples->count++] = whole;
}

static int bench_compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts the values. */
static double bench_median(double *value, int count) {
    if (count == 0) return 0;
    qsort(value, (size_t)count, sizeof *value, bench_compare);
    return count % 2 ? value[count / 2] : 0.5 * (value[count / 2 - 1] + value[count / 2]);
}

static void bench_medians(bench_samples *samples, double seconds[BENCH_TIMES]) {
    int p;
    for (p = 0; p < BENCH_TIMES; ++p) seconds[p] = bench_median(samples->seconds[p], samples->count);
}

static double bench_median_whole(bench_samples *samples) {
    return bench_median(samples->seconds[BENCH_WHOLE], samples->count);
}

/* -- one case -- */

/* A solve of ours, with CHOLMOD beside it or alone. */
typedef struct bench_run {
    const bench_solver *solver;
    bench_form *form;
    int set_ups;    /* of CHOLMOD, for their median */
    bool alone;     /* only ours is measured in this solve */
    bool apart;     /* ours is measured alone, CHOLMOD after a step that warms the caches */
    bool failed;    /* there is no CHOLMOD, or it failed: no memory */
    bool expecting; /* `next` is the step to come */
    bool compared;  /* a whole solve: all others have the same steps */
    int32_t iterations;
    bench_rows rows;
    bench_cholmod *cholmod;
    double cholmod_setup;
    double *step, *next; /* CHOLMOD's next step, as it is and refined */
    double our_error, their_error;
    bench_samples ours, theirs;
    bench_samples guided; /* of a default solve: ours while the smooth metric acts */
} bench_run;

/* The largest difference of two vectors over the largest entry of the second. */
static double bench_difference(int32_t count, const double *a, const double *b) {
    double size = 0, difference = 0;
    int32_t i;
    for (i = 0; i < count; ++i) {
        size = fmax(size, fabs(b[i]));
        if (!(fabs(a[i] - b[i]) <= difference)) difference = fabs(a[i] - b[i]); /* NaN stays */
    }
    return difference / size;
}

static void bench_compare_steps(bench_run *run, const bench_step *step) {
    double ours = bench_difference(step->variables, step->dx, run->next);
    double theirs = bench_difference(step->variables, run->step, run->next);
    if (!(ours <= run->our_error)) run->our_error = ours;
    if (!(theirs <= run->their_error)) run->their_error = theirs;
    run->expecting = false;
}

/* CHOLMOD's set-up, as often as wanted; the last one stays. */
static void bench_set_up_cholmod(bench_run *run) {
    double seconds[BENCH_SET_UPS];
    int i;
    for (i = 0; i < run->set_ups; ++i) {
        bench_cholmod_destroy(run->cholmod);
        run->cholmod = bench_cholmod_create(&run->rows);
        if (!run->cholmod) return;
        seconds[i] = bench_cholmod_facts(run->cholmod).setup_seconds;
    }
    run->cholmod_setup = bench_median(seconds, run->set_ups);
    run->step = (double *)bench_take((size_t)run->rows.variables, sizeof *run->step);
    run->next = (double *)bench_take((size_t)run->rows.variables, sizeof *run->next);
}

/* Lets CHOLMOD find the step that ours will take next. */
static bool bench_foresee(bench_run *run) {
    double seconds[BENCH_PHASES] = {0};
    run->solver->rows(run->form, &run->rows);
    if (!run->cholmod) bench_set_up_cholmod(run);
    if (!run->cholmod) return false;
    if (run->apart && !bench_cholmod_step(run->cholmod, &run->rows, seconds, run->step)) return false;
    if (!bench_cholmod_step(run->cholmod, &run->rows, seconds, run->step)) return false;
    bench_add_sample(&run->theirs, seconds);
    if (run->compared) return true;
    memcpy(run->next, run->step, (size_t)run->rows.variables * sizeof *run->next);
    run->expecting = bench_cholmod_refine(run->cholmod, &run->rows, run->next);
    return run->expecting;
}

static bool bench_visit_step(void *user, const bench_step *step) {
    bench_run *run = (bench_run *)user;
    if (run->expecting) bench_compare_steps(run, step);
    if (step->number > 1 && step->once && (run->alone || !run->apart))
        bench_add_sample(step->guided ? &run->guided : &run->ours, step->seconds);
    if (run->alone || step->number == run->iterations) return true;
    run->failed = !bench_foresee(run);
    return !run->failed;
}

/* Solves until there are enough samples, and longer where they take no time. False where nothing can be sampled. */
static bool bench_solves(bench_run *run, bool alone, int samples, double seconds) {
    bench_samples *wanted = alone ? &run->ours : &run->theirs;
    double began = bench_wall();
    while (wanted->count < samples ||
           (bench_wall() - began < seconds && wanted->count + BENCH_ITERATIONS <= BENCH_SAMPLES_MAX)) {
        int before = wanted->count;
        run->alone = alone;
        if (!run->solver->solve(run->form, run->iterations, bench_visit_step, run)) return false;
        run->expecting = false;
        run->compared = run->compared || !alone;
        if (run->failed || wanted->count == before) return false;
    }
    return true;
}

/* Rounds of ours alone and of CHOLMOD, so that a slow spell of the machine falls on both. */
static bool bench_both(bench_run *run, int samples, double seconds) {
    int rounds = run->apart ? 2 : 1, i;
    for (i = 1; i <= rounds; ++i) {
        int share = (samples * i + rounds - 1) / rounds;
        if (run->apart && !bench_solves(run, true, share, seconds / rounds)) return false;
        if (!bench_solves(run, false, share, seconds / rounds)) return false;
    }
    return true;
}

static void bench_end_run(bench_run *run) {
    bench_cholmod_destroy(run->cholmod);
    if (run->form) run->solver->destroy(run->form);
    bench_rows_free(&run->rows);
    free(run->step);
    free(run->next);
    free(run);
}

/* A form that is set up; `seconds`: the median time of several such. */
static bench_form *bench_set_up(const bench_solver *solver, const bench_mesh *mesh, bench_task task, int32_t workers,
                                int set_ups, double *seconds) {
    double each[BENCH_SET_UPS];
    bench_form *form = NULL;
    int i;
    for (i = 0; i < set_ups; ++i) {
        if (form) solver->destroy(form);
        form = solver->create(mesh, task, workers);
        if (!form) return NULL;
        if (!solver->solve(form, 0, bench_visit_step, NULL)) {
            solver->destroy(form);
            return NULL;
        }
        each[i] = solver->facts(form).setup_seconds;
    }
    *seconds = bench_median(each, set_ups);
    return form;
}

static bench_run *bench_begin_run(const bench_solver *solver, int samples) {
    bench_run *run = (bench_run *)bench_take(1, sizeof *run);
    run->solver = solver;
    run->iterations = samples < BENCH_ITERATIONS - 1 ? samples + 1 : BENCH_ITERATIONS;
    return run;
}

/* The median time of an iteration of ours in another way; 0 where it cannot be had. */
static double bench_whole(const bench_solver *solver, const bench_mesh *mesh, bench_task task, int samples) {
    bench_run *run = bench_begin_run(solver, samples);
    double whole = 0, set_up;
    run->form = bench_set_up(solver, mesh, task, 0, 1, &set_up);
    if (run->form && bench_solves(run, true, samples, 0.5)) whole = bench_median_whole(&run->ours);
    bench_end_run(run);
    return whole;
}

/* Two runs in turns of a solve or some, so that a slow spell of the machine falls on both. False where nothing can be
   sampled. */
static bool bench_turns(bench_run *run[2], int samples, double seconds) {
    const bench_samples *wanted = &run[0]->ours;
    double began = bench_wall();
    while (wanted->count < samples ||
           (bench_wall() - began < seconds && wanted->count + BENCH_ITERATIONS <= BENCH_SAMPLES_MAX)) {
        int more = wanted->count + 1;
        if (!bench_solves(run[0], true, more, 0.005) || !bench_solves(run[1], true, more, 0.005)) return false;
    }
    return true;
}

/* Begins and makes two runs of ours, in turns. */
static bool bench_pair(bench_run *run[2], const bench_mesh *mesh, const bench_task task[2], const int32_t workers[2],
                       int samples) {
    double set_up;
    int i;
    for (i = 0; i < 2; ++i) {
        run[i] = bench_begin_run(&bench_simd, samples);
        if (task[i] == BENCH_DEFAULT) run[i]->iterations = BENCH_WHOLE_SOLVE;
        run[i]->form = bench_set_up(&bench_simd, mesh, task[i], workers[i], 1, &set_up);
    }
    return run[0]->form && run[1]->form && bench_turns(run, samples, 4);
}

static void bench_end_pair(bench_run *run[2]) {
    bench_end_run(run[0]);
    bench_end_run(run[1]);
}

/* The median time of a factorisation without right-hand sides, after a solve; more samples where they take no time. */
static double bench_factor_alone(const bench_run *run, int samples, double seconds) {
    double each[BENCH_SAMPLES_MAX], began = bench_wall();
    int count = 0;
    while (count < samples || (bench_wall() - began < seconds && count < BENCH_SAMPLES_MAX))
        each[count++] = run->solver->factor(run->form);
    return bench_median(each, count);
}

/* The bytes of a factor below which each solver gets the caches to itself. */
static const double bench_apart_bytes = 32e6;

/* Ours against CHOLMOD. */
static bool bench_measure_both(const bench_mesh *mesh, bench_task task, const bench_options *options,
                               bench_result *result) {
    bench_run *run = bench_begin_run(&bench_simd, options->samples);
    bool measured = false;
    double set_up = 0;
    run->set_ups = mesh->vertex_count <= 50000 ? BENCH_SET_UPS : 3;
    run->form = bench_set_up(&bench_simd, mesh, task, 0, run->set_ups, &set_up);
    if (run->form) {
        result->ours = bench_simd.facts(run->form);
        run->apart = 8 * result->ours.entries < bench_apart_bytes;
        measured = bench_both(run, options->samples, options->quick ? 0.2 : 1);
        if (run->failed) fputs("bench: no memory for CHOLMOD\n", stderr);
    }
    if (measured) {
        result->samples = run->ours.count < run->theirs.count ? run->ours.count : run->theirs.count;
        result->ours = bench_simd.facts(run->form);
        result->ours.setup_seconds = set_up;
        result->theirs = bench_cholmod_facts(run->cholmod);
        result->theirs.setup_seconds = run->cholmod_setup;
        result->our_factor = bench_factor_alone(run, options->samples, 0.2);
        bench_medians(&run->ours, result->our_seconds);
        bench_medians(&run->theirs, result->their_seconds);
        result->their_seconds[BENCH_REFRESH] = result->our_seconds[BENCH_REFRESH];
        result->their_seconds[BENCH_WHOLE] += result->our_seconds[BENCH_REFRESH];
        result->our_error = run->our_error;
        result->their_error = run->their_error;
    }
    bench_end_run(run);
    return measured;
}

/* The same system with one worker and with two. */
static void bench_measure_workers(const bench_mesh *mesh, bench_task task, int samples, bench_result *result) {
    static const int32_t workers[2] = {1, 2};
    const bench_task tasks[2] = {task, task};
    bench_run *run[2];
    bench_pin(false);
    if (bench_pair(run, mesh, tasks, workers, samples)) {
        result->one_worker = bench_median_whole(&run[0]->ours);
        result->two_workers = bench_median_whole(&run[1]->ours);
    }
    bench_end_pair(run);
    bench_pin(true);
}

/* The same system in other ways. */
static void bench_measure_others(const bench_mesh *mesh, bench_task task, int samples, bench_result *result) {
    if (mesh->vertex_count > 15000 && samples > 5) samples = 5; /* one solve */
    result->cblas = bench_whole(&bench_cblas, mesh, task, samples);
    result->scalar = bench_whole(&bench_scalar, mesh, task, samples);
    if (mesh->vertex_count > 25000) bench_measure_workers(mesh, task, samples, result);
}

/* Ours beside plain iterations on the same mesh: with the volume, or those of a default solve. */
static bool bench_measure_beside_plain(const bench_mesh *mesh, bench_task what, const bench_options *options,
                                       bench_result *result) {
    static const int32_t workers[2] = {0, 0};
    const bench_task task[2] = {what, BENCH_PLANARITY};
    bench_run *run[2];
    bool measured = bench_pair(run, mesh, task, workers, options->samples);
    if (measured) {
        result->ours = bench_simd.facts(run[0]->form);
        result->samples = run[0]->ours.count;
        bench_medians(&run[0]->ours, result->our_seconds);
        result->guided = bench_median_whole(&run[0]->guided);
        result->plain = bench_median_whole(&run[1]->ours);
    }
    bench_end_pair(run);
    return measured;
}

/* Measures one case and tells its ratio. False where it cannot be measured. */
static bool bench_case(const bench_mesh *mesh, bench_task task, const bench_options *options, bench_result *result) {
    bool measured, beside = task != BENCH_VOLUME && task != BENCH_DEFAULT; /* CHOLMOD's */
    fprintf(stderr, "%s %d\n", result->problem, (int)result->nominal);
    measured = beside ? bench_measure_both(mesh, task, options, result)
                      : bench_measure_beside_plain(mesh, task, options, result);
    if (!measured) fprintf(stderr, "bench: %s %d: nothing to measure\n", result->problem, (int)result->nominal);
    if (measured && !options->quick && beside) bench_measure_others(mesh, task, options->samples, result);
    if (measured && bench_has_both(result) && !options->markdown)
        printf("ratio %s %d %.3f\n", result->problem, (int)result->nominal, bench_ratio(result));
    fflush(stdout);
    return measured;
}

/* -- all cases -- */

static bool bench_is_chosen(const bench_options *options, const char *problem, bool quick) {
    int i;
    for (i = 0; i < options->problems; ++i)
        if (strcmp(options->problem[i], problem) == 0) return true;
    return options->problems == 0 && (quick || !options->quick);
}

static double bench_bound(const bench_problem *problem, int32_t nominal) {
    int i;
    for (i = 0; i < 7; ++i)
        if (bench_nominal[i] == nominal) return problem->bound[i];
    return 0;
}

static int bench_run_problem(const bench_problem *problem, const bench_options *options, bench_result *result,
                             int room) {
    int count = 0, i, sizes = options->sizes ? options->sizes : 7;
    for (i = 0; i < sizes && count < room; ++i) {
        bench_mesh mesh;
        memset(&result[count], 0, sizeof *result);
        result[count].problem = problem->name;
        result[count].nominal = options->sizes ? options->size[i] : bench_nominal[i];
        result[count].bound = bench_bound(problem, result[count].nominal);
        if (!options->sizes && options->quick && result[count].nominal > BENCH_QUICK_SIZE) continue;
        if (!options->sizes && result[count].bound == 0 && problem->bound[0] > 0) continue; /* not asked for */
        mesh = problem->mesh(result[count].nominal);
        count += bench_case(&mesh, problem->task, options, &result[count]);
        bench_mesh_free(&mesh);
    }
    return count;
}

/* Where real meshes are: GPROJ_DATA, or shared/data beside the repository. */
static void bench_data_folder(char *path, size_t size) {
    const char *data = getenv("GPROJ_DATA");
    ssize_t length = readlink("/proc/self/exe", path, size - 32);
    char *slash;
    path[length > 0 ? length : 0] = 0;
    slash = strrchr(path, '/');
    if (slash) strcpy(slash, "/../../shared/data");
    if (data && *data) snprintf(path, size, "%s", data);
}

/* Planarity of the real meshes that are there and chosen. Their names are never given back. */
static int bench_run_files(const bench_options *options, bench_result *result, int room) {
    char folder[1024], path[2048];
    struct dirent **entry;
    int entries, i, count = 0;
    bench_data_folder(folder, sizeof folder);
    entries = scandir(folder, &entry, NULL, alphasort);
    for (i = 0; i < entries; ++i) {
        char *name = entry[i]->d_name, *dot = strrchr(name, '.');
        bench_mesh mesh;
        snprintf(path, sizeof path, "%s/%s", folder, name);
        if (count == room || !dot || strcmp(dot, ".obj") != 0) continue;
        *dot = 0;
        if (!bench_is_chosen(options, name, false) || !bench_simd.load(path, &mesh)) continue;
        memset(&result[count], 0, sizeof *result);
        result[count].problem = name;
        result[count].nominal = mesh.vertex_count;
        count += bench_case(&mesh, BENCH_PLANARITY, options, &result[count]);
        bench_mesh_free(&mesh);
    }
    return count;
}

/* -- options -- */

/* clang-format off */
static const char bench_help[] =
    "usage: tools/bench [options]\n"
    "\n"
    "Iterations of guided projection by this library and by CHOLMOD (supernodal, AMD)\n"
    "on OpenBLAS: the same systems in one process on one core, medians of processor\n"
    "time. Prints \"ratio PROBLEM V X\" for each case, X our whole iteration over\n"
    "CHOLMOD's, and tables. Without options everything is measured, which takes about\n"
    "an hour.\n"
    "\n"
    "  --quick         five problems up to 10000 vertices, ours and CHOLMOD's only\n"
    "  --problem NAME  only this one; may be repeated: quad, closed, hex, statics,\n"
    "                  fairness, hybrid, volume, default (a default solve's\n"
    "                  iterations over plain ones), or a real mesh in the folder\n"
    "                  GPROJ_DATA or ../shared/data\n"
    "  --size V        only with about V vertices; may be repeated\n"
    "  --samples N     at least N samples of each time (9)\n"
    "  --json FILE     writes all that was measured (without options: bench.json)\n"
    "  --svg FILE      draws times over V (without options: bench.svg)\n"
    "  --markdown      prints the README's section on speed instead of tables\n"
    "  --help          prints this\n";
/* clang-format on */

static void bench_wrong(const char *what) {
    fprintf(stderr, "bench: %s; see tools/bench --help\n", what);
    exit(2);
}

/* A whole number in low..high. */
static int bench_number(const char *text, int low, int high) {
    char *end;
    long value = strtol(text, &end, 10);
    if (*end || end == text || value < low || value > high) bench_wrong("a number is out of its range");
    return (int)value;
}

static bench_options bench_read_options(int argc, char **argv) {
    bench_options o;
    int i;
    memset(&o, 0, sizeof o);
    o.samples = 9;
    for (i = 1; i < argc; ++i) {
        const char *name = argv[i], *value = i + 1 < argc ? argv[i + 1] : NULL;
        bool plain = true;
        if (strcmp(name, "--help") == 0)
            fputs(bench_help, stdout), exit(0);
        else if (strcmp(name, "--quick") == 0)
            o.quick = true;
        else if (strcmp(name, "--markdown") == 0)
            o.markdown = true;
        else
            plain = false;
        if (plain) continue;
        if (!value) bench_wrong("an option is unknown or has no value");
        ++i;
        if (strcmp(name, "--problem") == 0 && o.problems < BENCH_CHOSEN)
            o.problem[o.problems++] = value;
        else if (strcmp(name, "--size") == 0 && o.sizes < BENCH_CHOSEN)
            o.size[o.sizes++] = bench_number(value, 50, 2000000);
        else if (strcmp(name, "--samples") == 0)
            o.samples = bench_number(value, 1, BENCH_SAMPLES_MAX / 2);
        else if (strcmp(name, "--json") == 0)
            o.json = value;
        else if (strcmp(name, "--svg") == 0)
            o.svg = value;
        else
            bench_wrong("an option is unknown");
    }
    if (argc == 1) o.json = "bench.json", o.svg = "bench.svg";
    return o;
}

static bool bench_write_file(const char *path, const bench_report *report,
                             bool (*write)(FILE *file, const bench_report *report)) {
    FILE *file = fopen(path, "w");
    bool written = file && write(file, report);
    if (file && fclose(file) != 0) written = false;
    fprintf(stderr, written ? "wrote %s\n" : "bench: cannot write %s\n", path);
    return written;
}

int main(int argc, char **argv) {
    static bench_result result[BENCH_CASES];
    bench_report report;
    bench_options options;
    int i, code = 0;
    options = bench_read_options(argc, argv);
    bench_prepare(argv);
    bench_pin(true);
    report.machine = bench_this_machine();
    report.result = result;
    report.argc = argc, report.argv = argv;
    report.count = 0;
    if (!options.markdown) bench_write_machine(stdout, &report.machine);
    for (i = 0; i < BENCH_PROBLEMS; ++i)
        if (bench_is_chosen(&options, bench_problems[i].name, i < BENCH_QUICK_PROBLEMS))
            report.count +=
                bench_run_problem(&bench_problems[i], &options, result + report.count, BENCH_CASES - report.count);
    report.count += bench_run_files(&options, result + report.count, BENCH_CASES - report.count);
    if (report.count == 0) bench_wrong("nothing was measured");
    if (options.markdown) {
        bench_write_markdown(stdout, &report);
    } else {
        bench_write_times(stdout, &report);
        bench_write_factors(stdout, &report);
        bench_write_others(stdout, &report);
        bench_write_verdicts(stdout, &report);
    }
    if (options.json && !bench_write_file(options.json, &report, bench_write_json)) code = 2;
    if (options.svg && !bench_write_file(options.svg, &report, bench_write_svg)) code = 2;
    for (i = 0; i < report.count; ++i) {
        if (bench_agrees(&result[i])) continue;
        fprintf(stderr, "bench: %s %d: the steps differ by %.1e\n", result[i].problem, (int)result[i].nominal,
                result[i].our_error);
        code = 1;
    }
    return code;
}
