/* compare_report.h - the table, plots and pictures of tools/compare. */
#ifndef COMPARE_REPORT_H
#define COMPARE_REPORT_H

#include "compare_run.h"
#include "picture.h"
#include "plot.h"

enum {
    COMPARE_METHODS = 6,
    COMPARE_LABEL = 96
};

/* The residual after so many iterations, or at the end of a shorter run. */
static double compare_residual_after(const compare_run *run, int32_t iterations) {
    int32_t i = 0;
    while (i + 1 < run->count && run->after[i + 1] <= iterations) ++i;
    return run->residual[i];
}

static double compare_step_seconds(const compare_run *run) {
    return run->count > 1 ? (compare_last(run, run->seconds) - run->seconds[0]) / compare_iterations(run) : 0;
}

/* Prints the table: a line for each run, seconds as multiples of the first run's. */
static void compare_print_table(int count, const compare_run *run, const char *what) {
    static const double goal[] = {1e-3, 1e-4, 1e-6, 1e-9, 1e-12};
    double base = compare_step_seconds(&run[0]);
    int k, g;
    printf("\n| method | penalty, growth | %s after 10 | 100 | 1000 iterations | iterations | deviation | spoiled "
           "| seconds per iteration | to 1e-3 | to 1e-4 | to 1e-6 | to 1e-9 | to 1e-12 |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
           what);
    for (k = 0; k < count; ++k) {
        printf("| %s | ", run[k].method->name);
        if (run[k].method->penalty[0] > 0) printf("%g", run[k].penalty);
        if (run[k].method->growth[0] > 0) printf(", %g", run[k].growth);
        printf(" | %.1e | %.1e | %.1e | %d | %.1e | %d | %.2f |", compare_residual_after(&run[k], 10),
               compare_residual_after(&run[k], 100), compare_residual_after(&run[k], 1000), compare_iterations(&run[k]),
               compare_last(&run[k], run[k].deviation), run[k].spoiled,
               base > 0 ? compare_step_seconds(&run[k]) / base : 0);
        for (g = 0; g < 5; ++g) {
            int32_t i = compare_find(&run[k], goal[g]), first = compare_find(&run[0], goal[g]);
            if (i < 0 || first < 0)
                printf(" - |");
            else
                printf(" %.2f |", run[k].seconds[i] / run[0].seconds[first]);
        }
        puts("");
    }
    printf("Seconds are multiples of those of %s: %.2f ms per iteration, after %.2f ms of preparation.\n",
           run[0].method->name, 1e3 * base, 1e3 * run[0].seconds[0]);
}

static FILE *compare_open(const char *folder, const char *kind, const char *name) {
    char path[1024];
    FILE *file;
    snprintf(path, sizeof path, "%s/%s_%s.svg", folder, kind, name);
    file = fopen(path, "w");
    if (!file) compare_fail("the folder cannot be written to");
    return file;
}

static void compare_close(FILE *file, gproj_code code) {
    if (fclose(file) != 0 && code == GPROJ_OK) code = GPROJ_ERROR_FILE;
    if (code != GPROJ_OK) compare_fail(gproj_code_string(code));
}

/* Writes the method's name with the tuning. */
static void compare_label(const compare_run *run, char label[COMPARE_LABEL]) {
    char growth[32] = "";
    if (run->method->growth[0] > 0) snprintf(growth, sizeof growth, ", growing by %g", run->growth);
    if (run->method->penalty[0] > 0)
        snprintf(label, COMPARE_LABEL, "%s, penalty %g%s", run->method->name, run->penalty, growth);
    else
        snprintf(label, COMPARE_LABEL, "%s", run->method->name);
}

/* Draws curves over the iterations, or over milliseconds; of many entries only some, at equal distances. */
static void compare_plot(FILE *file, const char *title, int count, const compare_run *run, bool deviation,
                         bool seconds) {
    gprojx_curve curve[COMPARE_METHODS];
    const double *at[COMPARE_METHODS];
    char name[COMPARE_METHODS][COMPARE_LABEL];
    double *x, *y;
    int32_t i;
    int k;
    gproj_code code;
    for (k = 0; k < count; ++k) {
        int n = 0;
        at[k] = x = compare_take(2 * (size_t)run[k].count, sizeof *x), y = x + run[k].count;
        for (i = 1; i < run[k].count; ++i) {
            double place = seconds ? fmax(1e3 * run[k].seconds[i], 1e-3) : run[k].after[i];
            if (n > 0 && i + 1 < run[k].count && place < 1.12 * x[n - 1]) continue;
            x[n] = place, y[n++] = deviation ? run[k].deviation[i] : fmin(run[k].residual[i], 10); /* not inf */
        }
        compare_label(&run[k], name[k]);
        curve[k] = (gprojx_curve){name[k], run[k].method->colour, n, y};
    }
    code = gprojx_plot_powers(file, title, seconds ? "milliseconds of processor time" : "iterations", count, curve, at);
    for (k = 0; k < count; ++k) free((void *)at[k]);
    compare_close(file, code);
}

/* Draws a mesh, faces coloured by planarity. */
static void compare_picture(FILE *file, const compare_run *run, const gproj_mesh *start) {
    gprojx_picture_options options = {0};
    double *planarity = compare_take(2 * (size_t)start->face_count, sizeof *planarity);
    char caption[160], title[COMPARE_LABEL];
    snprintf(caption, sizeof caption, "after %d iterations; deviation from the start %.1e of the diagonal",
             compare_iterations(run), compare_last(run, run->deviation));
    gproj_measure(run->mesh, NULL, planarity);
    gproj_measure(start, NULL, planarity + start->face_count);
    compare_label(run, title);
    options.title = title, options.caption = caption;
    options.original = start->position;
    options.face_value = planarity, options.face_before = planarity + start->face_count;
    options.legend = "planarity";
    compare_close(file, gprojx_picture(file, run->mesh, &options));
    free(planarity);
}

/* Writes plots and pictures to the folder, with names that begin with `kind`. */
static void compare_draw(const char *folder, const char *kind, const char *what, int count, const compare_run *run,
                         const gproj_mesh *start) {
    char residual[96];
    int k;
    snprintf(residual, sizeof residual, "%s, in mean edge lengths", what);
    compare_plot(compare_open(folder, kind, "iterations"), residual, count, run, false, false);
    compare_plot(compare_open(folder, kind, "seconds"), residual, count, run, false, true);
    compare_plot(compare_open(folder, kind, "deviation_iterations"), "Deviation from the start, in diagonals", count,
                 run, true, false);
    compare_plot(compare_open(folder, kind, "deviation_seconds"), "Deviation from the start, in diagonals", count, run,
                 true, true);
    for (k = 0; k < count; ++k) compare_picture(compare_open(folder, kind, run[k].method->file), &run[k], start);
}

#endif
