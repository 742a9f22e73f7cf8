/* figures.c - the figures of "Form-finding with Polyhedral Meshes Made Simple" (2014), at the paper's size.

       make figures
       ./figures pictures                all of them, as pictures/figure_NAME.svg
       ./figures pictures --only 3,4a    some
       ./figures --only 9                the paper's table of iterations and seconds, beside ours

   The paper's meshes are not public. These are like them: cages subdivided by the library and cut along diagonals of
   their quads, grids, filled curves, with the paper's number of vertices or nearly so, and with its weights where it
   gives them. Wishes lead for the paper's number of iterations, or a few more; then the constraints alone converge, so
   that every figure is exact. Prints for each mesh its vertices, faces, variables, equations and bounds, iterations,
   seconds, the largest residual, and the verdict. Exit code 1: a mesh is not exact, or spoiled.

   figures_mesh.h makes the meshes, figures_run.h solves and reports, figures_picture.h draws, figures_statics.h,
   figures_shape.h and figures_motion.h have the figures. Figures 5, 6 and 10 are examples: volume, equal_areas,
   planarize_compare. */
#define _POSIX_C_SOURCE 200809L
#define GUIDEDPROJ_IMPLEMENTATION
#include "guidedproj.h"

#include <sys/stat.h>

#include "json.h"
#include "figures_mesh.h"
#include "figures_run.h"
#include "figures_picture.h"
#include "figures_statics.h"
#include "figures_shape.h"
#include "figures_motion.h"

/* The figures, in the order of the paper; `also` is made with the first one. */
static const struct {
    const char *name, *also;
    bool timed; /* in the paper's table */
    void (*make)(studio *s);
} figures[] = {{"1", "2", true, make_figure_2},       {"3", "3", true, make_figure_3},
               {"4", "4", false, make_figure_4},      {"7", "7", false, make_figure_7},
               {"8", "8", true, make_figure_8},       {"11", "11", true, make_figure_11},
               {"12", "12", true, make_figure_12},    {"13", "13", true, make_figure_13},
               {"inset", "inset", false, make_inset}, {"drag", "drag", false, make_drag}};

enum {
    FIGURES = sizeof figures / sizeof figures[0]
};

static const record *find_record(const studio *s, const char *name) {
    int i;
    for (i = 0; i < s->count; ++i)
        if (strcmp(s->record[i].name, name) == 0) return &s->record[i];
    return NULL;
}

/* Figure 9 in Markdown. */
static void print_table(const studio *s) {
    size_t i;
    puts("\n| figure | V | paper's | iterations | paper's | seconds | paper's |\n|---|---|---|---|---|---|---|");
    for (i = 0; i < TIMED_COUNT; ++i) {
        const record *r = find_record(s, timed[i].name);
        if (r)
            printf("| %s | %ld | %d | %ld | %d | %.2f | %s |\n", timed[i].name, (long)r->vertices, timed[i].vertices,
                   (long)r->iterations, timed[i].iterations, r->seconds, timed[i].seconds);
    }
}

static void print_json(const studio *s) {
    gprojx_json json = {stdout, 0, false, false}, *j = &json;
    int i;
    gprojx_json_open(j, NULL, '[');
    for (i = 0; i < s->count; ++i) {
        const record *r = &s->record[i];
        gprojx_json_open_row(j, NULL);
        gprojx_json_string(j, "figure", r->name);
        gprojx_json_integer(j, "vertices", r->vertices), gprojx_json_integer(j, "faces", r->faces);
        gprojx_json_integer(j, "variables", r->variables), gprojx_json_integer(j, "equations", r->equations);
        gprojx_json_integer(j, "iterations", r->iterations);
        gprojx_json_number(j, "seconds", r->seconds), gprojx_json_number(j, "worst", r->worst);
        gprojx_json_next(j, "exact"), fputs(r->exact ? "true" : "false", stdout);
        gprojx_json_integer(j, "spoiled", r->spoiled);
        gprojx_json_close(j, '}');
    }
    gprojx_json_close(j, ']');
    puts("");
}

static int usage(FILE *file) {
    fputs("usage: figures [FOLDER] [--only LIST] [--meshes] [--json]\n"
          "Makes the figures of the paper; without FOLDER it only solves and reports.\n"
          "  --only LIST  figures or parts: 1 2 3 4 7 8 11 12 13 inset drag, 4a, 2c, ..., and 9, the table of times\n"
          "  --meshes     also saves each mesh, figure_NAME.obj, and how it began, figure_NAME_before.obj\n"
          "  --json       the report as JSON\n",
          file);
    return file == stdout ? 0 : 2;
}

int main(int count, char **word) {
    static studio s;
    int i;
    s.host = gproj_default_host();
    for (i = 1; i < count; ++i)
        if (strcmp(word[i], "--help") == 0)
            return usage(stdout);
        else if (strcmp(word[i], "--only") == 0 && i + 1 < count)
            s.only = word[++i];
        else if (strcmp(word[i], "--meshes") == 0)
            s.meshes = true;
        else if (strcmp(word[i], "--json") == 0)
            s.json = true;
        else if (word[i][0] != '-' && !s.folder)
            s.folder = word[i];
        else
            return usage(stderr);
    s.table = is_named(s.only, "9", false);
    if (s.folder) mkdir(s.folder, 0777); /* or it is there */
    if (!s.json) printf("figure      V      F variables equations iterations seconds worst residual\n");
    for (i = 0; i < FIGURES; ++i)
        if (is_any_wanted(&s, figures[i].name) || is_any_wanted(&s, figures[i].also) || (s.table && figures[i].timed))
            figures[i].make(&s);
    if (s.count == 0) return fputs("figures: there is no such figure\n", stderr), 2;
    if (s.json)
        print_json(&s);
    else if (s.table)
        print_table(&s);
    return s.failed;
}
