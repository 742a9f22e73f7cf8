/* figures_run.h - what all figures have in common: solving, measuring, reporting, saving.

   A plate is one mesh of a figure: the positions it began with, its form, iterations and seconds. Include guidedproj.h
   and figures_mesh.h before this file. */
#ifndef FIGURES_RUN_H
#define FIGURES_RUN_H

#include <stdarg.h>

#include "picture.h"
#include "forces.h"
#include "plot.h"

enum {
    MOST_RECORDS = 64,
    NAME_SIZE = 12
};

typedef struct record { /* of a plate that is done */
    char name[NAME_SIZE];
    int32_t vertices, faces, variables, equations, iterations, spoiled;
    double seconds, worst;
    bool exact;
    char verdict[200];
} record;

typedef struct studio { /* one run of the program */
    const char *folder, *only;
    bool meshes, json, failed;
    bool table;      /* of times is wanted */
    gproj_host host; /* with a clock */
    record record[MOST_RECORDS];
    int count;
} studio;

typedef struct plate {
    gproj_mesh *mesh;
    double *before; /* positions that the whole work began with */
    gproj_form *form;
    gproj_result result; /* of the last solve */
    int32_t iterations;  /* of all solves */
    double seconds;
} plate;

static const gproj_solve_options smoothly = {.smooth = true};

/* ---- which figures ---- */

/* Does the list of figures name this one, or a part of it if `parts`? */
static bool is_named(const char *list, const char *name, bool parts) {
    while (list && *list) {
        size_t size = strcspn(list, ","), length = strlen(name);
        if (size <= length && size > 0 && strncmp(list, name, size) == 0 &&
            (size == length || (name[size] >= 'a' && name[size] <= 'z')))
            return true;
        if (parts && size > length && strncmp(list, name, length) == 0 && list[length] >= 'a' && list[length] <= 'z')
            return true;
        list += size + (list[size] == ',');
    }
    return !list;
}

static bool is_wanted(const studio *s, const char *name) { return is_named(s->only, name, false); }

/* Is the figure, or one of its parts a, b, c, ..., wanted? */
static bool is_any_wanted(const studio *s, const char *figure) { return is_named(s->only, figure, true); }

/* The paper's Figure 9: sizes, iterations, seconds on a Core i5-3320M. */
static const struct {
    const char *name;
    int vertices, iterations;
    const char *seconds;
} timed[] = {{"2b", 1726, 5, "2.8"}, {"3c", 1766, 2, "0.45"}, {"3d", 1766, 5, "1.1"},       {"8b", 1121, 5, "0.4"},
             {"11c", 481, 5, "0.6"}, {"12", 521, 10, "1.5"},  {"13", 1056, 10, "3.3 + 0.8"}};

enum {
    TIMED_COUNT = sizeof timed / sizeof timed[0]
};

/* ---- plates ---- */

/* Begins with a mesh, which the plate owns from now on. */
static plate begin_plate(const studio *s, gproj_mesh *mesh) {
    plate p = {0};
    p.mesh = mesh;
    p.before = copy_positions(mesh);
    p.form = gproj_form_create(mesh, &s->host);
    return p;
}

/* Begins with a copy of another plate's mesh as it is now. */
static plate copy_plate(const studio *s, const plate *other) {
    gproj_error error;
    return begin_plate(s, must(gproj_mesh_copy(other->mesh, NULL, &error), &error));
}

/* Goes on with another form of the same mesh. */
static void renew_form(const studio *s, plate *p) {
    gproj_form_destroy(p->form);
    p->form = gproj_form_create(p->mesh, &s->host);
}

static void solve_plate(studio *s, plate *p, int32_t iterations, const gproj_solve_options *options) {
    double begun = s->host.clock.now(s->host.clock.user);
    p->result = gproj_solve(p->form, iterations, options);
    p->seconds += s->host.clock.now(s->host.clock.user) - begun;
    p->iterations += p->result.iterations;
}

static void end_plate(plate *p) {
    gproj_form_destroy(p->form);
    gproj_mesh_destroy(p->mesh);
    free(p->before);
}

/* Adds fairness and tangential fairness, if their weights are not 0, with these weights for `last` iterations. */
static void add_fairness(plate *p, double fair, double tangential, double decay, int32_t last) {
    gproj_schedule schedule = gproj_fade(1, last);
    schedule.decay = decay;
    schedule.weight = fair;
    if (fair > 0) gproj_set_schedule(p->form, gproj_add_fairness(p->form, fair), schedule);
    schedule.weight = tangential;
    if (tangential > 0) gproj_set_schedule(p->form, gproj_add_tangential_fairness(p->form, tangential), schedule);
}

/* ---- files ---- */

/* Opens FOLDER/figure_NAME.svg; NULL where no picture is wanted. */
static FILE *open_picture(studio *s, const char *name) {
    char path[1024];
    FILE *file;
    if (!s->folder || !is_wanted(s, name)) return NULL;
    snprintf(path, sizeof path, "%s/figure_%s.svg", s->folder, name);
    file = fopen(path, "w");
    if (!file) fprintf(stderr, "figures: cannot write %s\n", path), s->failed = true;
    return file;
}

static void close_file(studio *s, FILE *file, gproj_code code) {
    if (fclose(file) == 0 && code == GPROJ_OK) return;
    fputs("figures: a picture could not be written\n", stderr);
    s->failed = true;
}

static void save_mesh(studio *s, const gproj_mesh *mesh, const char *name, const char *ending) {
    char path[1024];
    gproj_error error;
    snprintf(path, sizeof path, "%s/figure_%s%s.obj", s->folder, name, ending);
    if (gproj_mesh_save(mesh, path, &error) == GPROJ_OK) return;
    fprintf(stderr, "figures: %s\n", error.message);
    s->failed = true;
}

/* Saves the mesh as it was before, and as it is. */
static void save_plate(studio *s, const plate *p, const char *name) {
    gproj_error error;
    gproj_mesh *before = must(gproj_mesh_copy(p->mesh, NULL, &error), &error);
    memcpy(before->position, p->before, 3 * sizeof *p->before * (size_t)p->mesh->vertex_count);
    save_mesh(s, p->mesh, name, "");
    save_mesh(s, before, name, "_before");
    gproj_mesh_destroy(before);
}

/* ---- the report ---- */

static int32_t count_equations(const gproj_form *form, int32_t groups) {
    int32_t k, rows = 0;
    for (k = 0; k < groups; ++k) {
        gproj_group_info info = gproj_form_group_info(form, k);
        if (info.kind != GPROJ_WISH && info.schedule.weight > 0) rows += info.rows;
    }
    return rows;
}

static void print_record(const record *r) {
    printf("%-7s %5ld %6ld %9ld %9ld %10ld %7.3f %.1e  %s\n", r->name, (long)r->vertices, (long)r->faces,
           (long)r->variables, (long)r->equations, (long)r->iterations, r->seconds, r->worst,
           r->exact && r->spoiled == 0 ? "exact and sound" : r->verdict);
    fflush(stdout);
}

/* Notes how the plate ended, also if only other parts of its figure are wanted. One that is not exact, or is spoiled,
   makes the run fail. */
static void report_plate(studio *s, const plate *p, const char *name) {
    gproj_system *system = gproj_form_system(p->form);
    record *r;
    if (s->count == MOST_RECORDS) return;
    r = &s->record[s->count++];
    memset(r, 0, sizeof *r);
    snprintf(r->name, sizeof r->name, "%s", name);
    r->vertices = p->mesh->vertex_count, r->faces = p->mesh->face_count;
    r->variables = gproj_system_variable_count(system);
    r->equations = count_equations(p->form, gproj_system_group_count(system));
    r->iterations = p->iterations, r->seconds = p->seconds, r->worst = p->result.residual;
    r->exact = p->result.outcome == GPROJ_CONVERGED;
    r->spoiled = gproj_measure_spoiled(p->mesh, p->before).total;
    snprintf(r->verdict, sizeof r->verdict, "spoiled: %ld; %.160s", (long)r->spoiled, p->result.message);
    if (!r->exact || r->spoiled > 0) s->failed = true;
    if (!s->json) print_record(r);
    if (s->meshes && s->folder) save_plate(s, p, name);
}

#endif
