/* bench_report.h - what tools/bench has measured, as tables, JSON, a picture and a section for the README. */
#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H

#include "guidedproj.h"
#include "bench.h"
#include "plot.h"

enum {
    BENCH_WHOLE = BENCH_PHASES, /* beside the phases: their sum */
    BENCH_TIMES
};

/* One case. Seconds are medians; 0: not measured. */
typedef struct bench_result {
    const char *problem;
    int32_t nominal; /* what was asked for; the mesh has facts.vertices */
    double bound;    /* of the ratio; 0: none */
    int samples;
    bench_facts ours, theirs;
    double our_seconds[BENCH_TIMES], their_seconds[BENCH_TIMES]; /* theirs with our refresh */
    double our_factor;                                           /* a factorisation without right-hand sides */
    double cblas, scalar;                                        /* whole iterations of ours in other ways */
    double one_worker, two_workers;                              /* the same by the clock on the wall */
    double plain;  /* volume, default: whole iterations with planarity alone, without metric and safeguards */
    double guided; /* default: whole iterations while the smooth metric acts; else 0 */
    double our_error, their_error; /* of a step: largest difference from the refined one, relative */
} bench_result;

typedef struct bench_report {
    bench_machine machine;
    int argc;
    char **argv; /* the command */
    int count;
    const bench_result *result;
} bench_report;

static bool bench_has_both(const bench_result *r) { return r->their_seconds[BENCH_WHOLE] > 0; }

static double bench_ratio(const bench_result *r) { return r->our_seconds[BENCH_WHOLE] / r->their_seconds[BENCH_WHOLE]; }

/* GFlop/s of a factorisation without right-hand sides. */
static double bench_our_rate(const bench_result *r) { return 1e-9 * r->ours.flops / r->our_factor; }
static double bench_their_rate(const bench_result *r) {
    return 1e-9 * r->theirs.flops / r->their_seconds[BENCH_FACTOR];
}

static double bench_setup_ratio(const bench_result *r) { return r->ours.setup_seconds / r->theirs.setup_seconds; }

/* CHOLMOD needs the rows as well, as equations and linearised. */
static double bench_their_bytes(const bench_result *r) {
    return r->ours.rows_bytes + r->theirs.rows_bytes + r->theirs.peak_bytes;
}
static double bench_memory_ratio(const bench_result *r) { return r->ours.peak_bytes / bench_their_bytes(r); }

/* Do the steps agree? CHOLMOD's own are off by what rounding does to the matrix: where that is more, it is allowed. */
static bool bench_agrees(const bench_result *r) {
    return !bench_has_both(r) || r->our_error <= 1e-9 || r->our_error <= 3 * r->their_error;
}

static void bench_write_machine(FILE *file, const bench_machine *m) {
    fprintf(file, "%s, %s; CHOLMOD %s, supernodal, AMD; %s; kernels %s, dgemm %.1f GFlop/s; one thread\n", m->processor,
            m->compiler, m->cholmod, m->openblas, m->kernels, 1e-9 * m->peak);
}

/* -- tables -- */

static void bench_write_name(FILE *file, const bench_result *r) {
    fprintf(file, "%-12.12s %6d", r->problem, (int)r->ours.vertices);
}

/* "0.212  0.250 ok" */
static void bench_write_bounded(FILE *file, double value, double bound) {
    fprintf(file, " %6.3f", value);
    if (bound > 0)
        fprintf(file, " %5.2f %-5s", bound, value <= bound ? "ok" : "above");
    else
        fprintf(file, " %5s %-5s", "", "");
}

static void bench_write_times(FILE *file, const bench_report *report) {
    int i, p;
    fputs("\nmilliseconds of processor time of an iteration; ours | CHOLMOD's | ratio and its bound\n", file);
    fprintf(file, "%-12s %6s | %8s %8s %8s %8s %8s | %8s %8s %8s %8s |\n", "problem", "V", "refresh", "assembly",
            "factor", "solve", "whole", "assembly", "factor", "solve", "whole");
    for (i = 0; i < report->count; ++i) {
        const bench_result *r = &report->result[i];
        bench_write_name(file, r);
        fputs(" |", file);
        for (p = 0; p < BENCH_TIMES; ++p) fprintf(file, " %8.3f", 1e3 * r->our_seconds[p]);
        fputs(" |", file);
        for (p = BENCH_ASSEMBLE; bench_has_both(r) && p < BENCH_TIMES; ++p)
            fprintf(file, " %8.3f", 1e3 * r->their_seconds[p]);
        if (bench_has_both(r)) fputs(" |", file), bench_write_bounded(file, bench_ratio(r), r->bound);
        fputs("\n", file);
    }
}

static void bench_write_factors(FILE *file, const bench_report *report) {
    int i;
    double peak = 1e-9 * report->machine.peak;
    fputs(
        "\nfactors, without padding; ours and CHOLMOD's. Errors: largest difference from the refined step, relative\n",
        file);
    fprintf(file, "%-12s %6s %8s | %15s | %15s | %13s | %11s | %15s\n", "problem", "V", "unknowns", "M entries of L",
            "GFlop", "GFlop/s", "% of dgemm", "errors");
    for (i = 0; i < report->count; ++i) {
        const bench_result *r = &report->result[i];
        double a, b;
        if (!bench_has_both(r)) continue;
        a = bench_our_rate(r), b = bench_their_rate(r);
        bench_write_name(file, r);
        fprintf(file, " %8d | %7.2f %7.2f | %7.3f %7.3f | %6.1f %6.1f | %5.1f %5.1f | %7.1e %7.1e%s\n",
                (int)r->ours.unknowns, 1e-6 * r->ours.entries, 1e-6 * r->theirs.entries, 1e-9 * r->ours.flops,
                1e-9 * r->theirs.flops, a, b, 100 * a / peak, 100 * b / peak, r->our_error, r->their_error,
                bench_agrees(r) ? "" : " DIFFERENT");
    }
}

static void bench_write_others(FILE *file, const bench_report *report) {
    int i;
    fputs("\nset-up in ms (of that rows; pattern) and peak memory in MB, ours | CHOLMOD's | ratio; whole iterations in "
          "ms "
          "with CBLAS, without SIMD, and by the wall clock with workers\n",
          file);
    fprintf(file, "%-12s %6s | %17s | %17s | %5s | %8s | %8s | %5s | %9s %9s %9s %9s\n", "problem", "V", "set-up",
            "set-up", "ratio", "memory", "memory", "ratio", "CBLAS", "scalar", "1 worker", "2 workers");
    for (i = 0; i < report->count; ++i) {
        const bench_result *r = &report->result[i];
        if (!bench_has_both(r)) continue;
        bench_write_name(file, r);
        fprintf(file, " | %8.2f %8.2f | %8.2f %8.2f | %5.2f | %8.2f | %8.2f | %5.2f |", 1e3 * r->ours.setup_seconds,
                1e3 * r->ours.part_seconds, 1e3 * r->theirs.setup_seconds, 1e3 * r->theirs.part_seconds,
                bench_setup_ratio(r), 1e-6 * r->ours.peak_bytes, 1e-6 * bench_their_bytes(r), bench_memory_ratio(r));
        if (r->cblas > 0) fprintf(file, " %9.3f", 1e3 * r->cblas);
        if (r->scalar > 0) fprintf(file, " %9.3f", 1e3 * r->scalar);
        if (r->two_workers > 0) fprintf(file, " %9.3f %9.3f", 1e3 * r->one_worker, 1e3 * r->two_workers);
        fputs("\n", file);
    }
}

/* -- what is to be reached besides the ratios -- */

/* One line of a list: what was measured, and whether it is at most (low: at least) the bound. */
static void bench_write_verdict(FILE *file, const bench_result *r, const char *what, double value, bool low,
                                double bound) {
    fprintf(file, "%-36s %-10.10s %6d  %6.3f %s %5.2f  %s\n", what, r->problem, (int)r->ours.vertices, value,
            low ? ">=" : "<=", bound,
            (low ? value >= bound : value <= bound) ? "ok"
            : low                                   ? "below"
                                                    : "above");
}

static const bench_result *bench_find(const bench_report *report, const char *problem, int32_t nominal) {
    int i;
    for (i = 0; i < report->count; ++i)
        if (strcmp(report->result[i].problem, problem) == 0 && report->result[i].nominal == nominal)
            return &report->result[i];
    return NULL;
}

/* Exponents of growth from 10k to the largest size. */
static void bench_write_growth(FILE *file, const bench_report *report, const bench_result *large) {
    const bench_result *small = bench_find(report, large->problem, 10000);
    double v, t, m, w;
    if (!small || large->nominal <= 10000 || !bench_has_both(large)) return;
    v = log((double)large->ours.vertices / small->ours.vertices);
    t = log(large->our_seconds[BENCH_WHOLE] / small->our_seconds[BENCH_WHOLE]);
    m = log(large->ours.peak_bytes / small->ours.peak_bytes);
    w = v + log(log((double)large->ours.vertices) / log((double)small->ours.vertices));
    bench_write_verdict(file, large, "time grows from 10k as V to the power", t / v, false, 1.5);
    bench_write_verdict(file, large, "memory, as V log V to the power", m / w, false, 1);
}

static void bench_write_verdicts(FILE *file, const bench_report *report) {
    double peak = 1e-9 * report->machine.peak;
    int i;
    fputs("\n", file);
    for (i = 0; i < report->count; ++i) {
        const bench_result *r = &report->result[i];
        double whole = r->our_seconds[BENCH_WHOLE], share = bench_our_rate(r) / peak;
        if (r->plain > 0 && r->guided == 0)
            bench_write_verdict(file, r, "with over without the global row", whole / r->plain, false, 1.1);
        if (r->guided > 0) {
            bench_write_verdict(file, r, "default over plain, metric at rest", whole / r->plain, false, 1.5);
            fprintf(file, "%-36s %-10.10s %6d  %6.3f\n", "default over plain, metric acting", r->problem,
                    (int)r->ours.vertices, r->guided / r->plain);
        }
        if (!bench_has_both(r) || r->bound == 0) continue;
        if (r->nominal >= 30000) bench_write_verdict(file, r, "factorisation, part of dgemm's peak", share, true, 0.45);
        if (r->nominal == 3500) bench_write_verdict(file, r, "factorisation, part of dgemm's peak", share, true, 0.25);
        bench_write_verdict(file, r, "set-up over CHOLMOD's", bench_setup_ratio(r), false, 0.5);
        if (r->nominal == 300000)
            bench_write_verdict(file, r, "memory over CHOLMOD's", bench_memory_ratio(r), false, 0.6);
        if (r->two_workers > 0)
            bench_write_verdict(file, r, "one worker over two", r->one_worker / r->two_workers, true, 1.6);
        if (r->scalar > 0) bench_write_verdict(file, r, "without SIMD over with", r->scalar / whole, false, 4);
        bench_write_growth(file, report, r);
    }
}

/* -- JSON -- */

static void bench_write_json_times(FILE *file, const char *name, const double *seconds) {
    fprintf(
        file,
        "      \"%s\": {\"refresh\": %.9g, \"assembly\": %.9g, \"factor\": %.9g, \"solve\": %.9g, \"whole\": %.9g},\n",
        name, seconds[BENCH_REFRESH], seconds[BENCH_ASSEMBLE], seconds[BENCH_FACTOR], seconds[BENCH_SOLVE],
        seconds[BENCH_WHOLE]);
}

static void bench_write_json_facts(FILE *file, const char *name, const bench_facts *facts, const char *part) {
    fprintf(file,
            "      \"%s\": {\"unknowns\": %d, \"entries\": %.0f, \"flops\": %.0f, \"setup_seconds\": %.9g, "
            "\"%s_seconds\": %.9g, \"rows_bytes\": %.0f, \"peak_bytes\": %.0f},\n",
            name, (int)facts->unknowns, facts->entries, facts->flops, facts->setup_seconds, part, facts->part_seconds,
            facts->rows_bytes, facts->peak_bytes);
}

static void bench_write_json_result(FILE *file, const bench_result *r) {
    fprintf(file, "    {\"problem\": \"%s\", \"nominal\": %d, \"vertices\": %d, \"samples\": %d,\n", r->problem,
            (int)r->nominal, (int)r->ours.vertices, r->samples);
    bench_write_json_facts(file, "ours", &r->ours, "rows");
    bench_write_json_times(file, "our_seconds", r->our_seconds);
    if (bench_has_both(r)) {
        bench_write_json_facts(file, "cholmod", &r->theirs, "pattern");
        bench_write_json_times(file, "cholmod_seconds", r->their_seconds);
        fprintf(file, "      \"our_factor_alone_seconds\": %.9g,\n", r->our_factor);
        fprintf(file, "      \"ratio\": %.6f, \"our_error\": %.3g, \"cholmod_error\": %.3g,\n", bench_ratio(r),
                r->our_error, r->their_error);
    }
    if (r->bound > 0) fprintf(file, "      \"bound\": %.2f,\n", r->bound);
    if (r->cblas > 0) fprintf(file, "      \"cblas_seconds\": %.9g,\n", r->cblas);
    if (r->scalar > 0) fprintf(file, "      \"scalar_seconds\": %.9g,\n", r->scalar);
    if (r->two_workers > 0)
        fprintf(file, "      \"workers_wall_seconds\": [%.9g, %.9g],\n", r->one_worker, r->two_workers);
    if (r->plain > 0) fprintf(file, "      \"plain_seconds\": %.9g,\n", r->plain);
    if (r->guided > 0) fprintf(file, "      \"guided_seconds\": %.9g,\n", r->guided);
    fprintf(file, "      \"agrees\": %s}", bench_agrees(r) ? "true" : "false");
}

static bool bench_write_json(FILE *file, const bench_report *report) {
    const bench_machine *m = &report->machine;
    int i;
    fprintf(
        file,
        "{\n  \"processor\": \"%s\", \"compiler\": \"%s\", \"cholmod\": \"%s\",\n  \"openblas\": \"%s\", \"kernels\": "
        "\"%s\", \"dgemm_flops_per_second\": %.6g,\n  \"cases\": [\n",
        m->processor, m->compiler, m->cholmod, m->openblas, m->kernels, m->peak);
    for (i = 0; i < report->count; ++i) {
        bench_write_json_result(file, &report->result[i]);
        fputs(i + 1 < report->count ? ",\n" : "\n", file);
    }
    fputs("  ]\n}\n", file);
    return !ferror(file);
}

/* -- picture -- */

enum {
    BENCH_PLOTTED = 7, /* problems at most */
    BENCH_POINTS = 16  /* sizes of one */
};

/* Curves of one problem: whole iterations of ours and of CHOLMOD's. */
typedef struct bench_curves {
    int count;
    double at[BENCH_POINTS], value[2][BENCH_POINTS];
    char name[2][80];
} bench_curves;

/* The exponent of growth: least squares of log value over log at, from 9000 vertices. */
static bool bench_slope(const bench_curves *c, int k, double *slope) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    int i;
    for (i = 0; i < c->count; ++i) {
        double u = log(c->at[i]), v = log(c->value[k][i]);
        if (c->at[i] < 9000) continue;
        n += 1, x += u, y += v, xx += u * u, xy += u * v;
    }
    if (n < 2 || !(n * xx - x * x > 0)) return false;
    *slope = (n * xy - x * y) / (n * xx - x * x);
    return true;
}

static void bench_name_curve(bench_curves *c, int k, const char *problem) {
    static const char *const solver[2] = {"guidedproj.h", "CHOLMOD and OpenBLAS"};
    double slope;
    if (bench_slope(c, k, &slope))
        snprintf(c->name[k], sizeof c->name[k], "%.20s, %s: V to the power %.2f from 10k", problem, solver[k], slope);
    else
        snprintf(c->name[k], sizeof c->name[k], "%.20s, %s", problem, solver[k]);
}

/* The cases of one problem, in order of size. */
static void bench_collect(bench_curves *c, const bench_report *report, const char *problem) {
    int i, j;
    memset(c, 0, sizeof *c);
    for (i = 0; i < report->count && c->count < BENCH_POINTS; ++i) {
        const bench_result *r = &report->result[i];
        if (strcmp(r->problem, problem) != 0 || !bench_has_both(r)) continue;
        for (j = c->count++; j > 0 && c->at[j - 1] > r->ours.vertices; --j)
            c->at[j] = c->at[j - 1], c->value[0][j] = c->value[0][j - 1], c->value[1][j] = c->value[1][j - 1];
        c->at[j] = r->ours.vertices;
        c->value[0][j] = r->our_seconds[BENCH_WHOLE], c->value[1][j] = r->their_seconds[BENCH_WHOLE];
    }
    for (i = 0; i < 2; ++i) bench_name_curve(c, i, problem);
}

/* Draws the problems that were run at two sizes or more. */
static bool bench_write_svg(FILE *file, const bench_report *report) {
    static const char *const colour[BENCH_PLOTTED][2] = {
        {"#b03020", "#e6b0a8"}, {"#2060a0", "#a9c7e4"}, {"#2e8040", "#aed6b6"}, {"#b07010", "#ecd2a0"},
        {"#703090", "#d2b6e0"}, {"#108080", "#a0d6d6"}, {"#505050", "#c4c4c4"}};
    bench_curves *curves = (bench_curves *)bench_take(BENCH_PLOTTED, sizeof *curves);
    gprojx_curve curve[2 * BENCH_PLOTTED];
    const double *at[2 * BENCH_PLOTTED];
    int i, k, drawn = 0;
    bool written;
    for (i = 0; i < report->count && drawn < BENCH_PLOTTED; ++i) {
        const char *problem = report->result[i].problem;
        for (k = 0; strcmp(report->result[k].problem, problem) != 0;) ++k;
        if (k < i) continue; /* not its first case */
        bench_collect(&curves[drawn], report, problem);
        if (curves[drawn].count < 2) continue;
        for (k = 0; k < 2; ++k) {
            gprojx_curve one = {curves[drawn].name[k], colour[drawn][k], curves[drawn].count, curves[drawn].value[k]};
            curve[2 * drawn + k] = one;
            at[2 * drawn + k] = curves[drawn].at;
        }
        ++drawn;
    }
    written = gprojx_plot_powers(file, "Seconds of an iteration", "vertices", 2 * drawn, curve, at) == GPROJ_OK;
    free(curves);
    return written;
}

/* -- the README's section -- */

/* The sizes that occur, ascending; returns how many. */
static int bench_sizes(const bench_report *report, int32_t size[BENCH_POINTS]) {
    int count = 0, i, j, k;
    for (i = 0; i < report->count && count < BENCH_POINTS; ++i) {
        int32_t nominal = report->result[i].nominal;
        for (j = 0; j < count && size[j] < nominal; ++j) continue;
        if (report->result[i].bound == 0 || (j < count && size[j] == nominal)) continue;
        for (k = count++; k > j; --k) size[k] = size[k - 1];
        size[j] = nominal;
    }
    return count;
}

/* A line of a table: a value of one problem at each size, "-" where there is none or 0. */
typedef double (*bench_value)(const bench_report *report, const bench_result *r);

static void bench_write_row(FILE *file, const bench_report *report, const char *label, const char *problem,
                            bool percent, bench_value value) {
    int32_t size[BENCH_POINTS];
    int count = bench_sizes(report, size), i;
    fprintf(file, "| %s |", label);
    for (i = 0; i < count; ++i) {
        const bench_result *r = bench_find(report, problem, size[i]);
        double v = r && (bench_has_both(r) || r->plain > 0) ? value(report, r) : 0;
        if (v > 0)
            fprintf(file, percent ? " %.0f %% |" : " %.2f |", percent ? 100 * v : v);
        else
            fputs(" - |", file);
    }
    fputs("\n", file);
}

static bool bench_has(const bench_report *report, const char *problem) {
    int i;
    for (i = 0; i < report->count; ++i)
        if (strcmp(report->result[i].problem, problem) == 0) return true;
    return false;
}

static double bench_value_ratio(const bench_report *report, const bench_result *r) {
    return (void)report, bench_ratio(r);
}
static double bench_value_share(const bench_report *report, const bench_result *r) {
    return 1e9 * bench_our_rate(r) / report->machine.peak;
}
static double bench_value_their_share(const bench_report *report, const bench_result *r) {
    return 1e9 * bench_their_rate(r) / report->machine.peak;
}
static double bench_value_flops(const bench_report *report, const bench_result *r) {
    return (void)report, r->ours.flops / r->theirs.flops;
}
static double bench_value_unknowns(const bench_report *report, const bench_result *r) {
    return (void)report, (double)r->ours.unknowns / r->theirs.unknowns;
}
static double bench_value_setup(const bench_report *report, const bench_result *r) {
    return (void)report, bench_setup_ratio(r);
}
static double bench_value_memory(const bench_report *report, const bench_result *r) {
    return (void)report, bench_memory_ratio(r);
}
static double bench_value_cblas(const bench_report *report, const bench_result *r) {
    return (void)report, r->cblas / r->our_seconds[BENCH_WHOLE];
}
static double bench_value_scalar(const bench_report *report, const bench_result *r) {
    return (void)report, r->scalar / r->our_seconds[BENCH_WHOLE];
}
static double bench_value_workers(const bench_report *report, const bench_result *r) {
    return (void)report, r->two_workers > 0 ? r->two_workers / r->one_worker : 0;
}
static double bench_value_global(const bench_report *report, const bench_result *r) {
    return (void)report, r->our_seconds[BENCH_WHOLE] / r->plain;
}

static void bench_write_heading(FILE *file, const bench_report *report, const char *first) {
    int32_t size[BENCH_POINTS];
    int count = bench_sizes(report, size), i;
    fprintf(file, "| %s |", first);
    for (i = 0; i < count; ++i) fprintf(file, size[i] % 1000 ? " %g k |" : " %.0f k |", 1e-3 * size[i]);
    fputs("\n|---|", file);
    for (i = 0; i < count; ++i) fputs("---|", file);
    fputs("\n", file);
}

static void bench_write_details(FILE *file, const bench_report *report, const char *title, const char *problem) {
    if (!bench_has(report, problem)) return;
    fprintf(file, "\n%s in more detail:\n\n", title);
    bench_write_heading(file, report, "V");
    bench_write_row(file, report, "unknowns / CHOLMOD's", problem, false, bench_value_unknowns);
    bench_write_row(file, report, "flops / CHOLMOD's", problem, false, bench_value_flops);
    bench_write_row(file, report, "factorisation, part of dgemm's peak", problem, true, bench_value_share);
    bench_write_row(file, report, "CHOLMOD's", problem, true, bench_value_their_share);
    bench_write_row(file, report, "set-up / CHOLMOD's", problem, false, bench_value_setup);
    bench_write_row(file, report, "peak memory / CHOLMOD's", problem, false, bench_value_memory);
    bench_write_row(file, report, "time with CBLAS / without", problem, false, bench_value_cblas);
    bench_write_row(file, report, "time without SIMD / with", problem, false, bench_value_scalar);
    bench_write_row(file, report, "time of two workers / of one", problem, false, bench_value_workers);
}

static void bench_write_markdown(FILE *file, const bench_report *report) {
    static const char *const label[][2] = {{"quad", "planar quads"},
                                           {"closed", "planar quads, closed mesh"},
                                           {"hex", "planar hexagons"},
                                           {"statics", "planar quads and equilibrium"},
                                           {"fairness", "planar quads and fairness"},
                                           {"hybrid", "planar quads and triangles"}};
    const bench_machine *m = &report->machine;
    int i;
    fprintf(file,
            "A whole iteration (evaluation, assembly, factorisation, solution) in the time that the same takes with "
            "CHOLMOD "
            "%s\n(supernodal, ordered by AMD) on OpenBLAS (%s kernels), by number of vertices; one thread of an %s, "
            "%s:\n\n",
            m->cholmod, m->kernels, m->processor, m->compiler);
    bench_write_heading(file, report, "V");
    for (i = 0; i < (int)(sizeof label / sizeof *label); ++i)
        if (bench_has(report, label[i][0]))
            bench_write_row(file, report, label[i][1], label[i][0], false, bench_value_ratio);
    fputs("\nPlanarity alone is solved for one multiplier a quad, with equilibrium for three more a vertex; with "
          "fairness the unknowns are\nall variables.\n",
          file);
    bench_write_details(file, report, "Planar quads", "quad");
    bench_write_details(file, report, "Planar quads and fairness", "fairness");
    if (bench_has(report, "volume")) {
        fputs("\nA volume to be kept, one row with all vertices, beside planar quads on a closed mesh:\n\n", file);
        bench_write_heading(file, report, "V");
        bench_write_row(file, report, "time with the volume / without", "volume", false, bench_value_global);
    }
    fputs("\nBy `make -C tools bench && tools/bench", file);
    for (i = 1; i < report->argc; ++i) fprintf(file, " %s", report->argv[i]);
    fputs(
        "`\n(Debian: libsuitesparse-dev, libopenblas-dev). `tools/bench --quick` compares up to 10 k vertices within a "
        "minute, `tools/bench` all sizes in about an hour.\n",
        file);
}

#endif
