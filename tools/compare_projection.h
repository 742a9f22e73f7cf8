/* compare_projection.h - guided projection (Tang, Sun, Gomes, Wallner, Pottmann 2014), by this library: normals (and
   points on the axes of circles) are variables, all equations are quadratic, and closeness guides in the first five
   iterations, with weight 0.03 * 0.3^n. There is nothing to tune: the weights are the library's defaults.

   And the same constraints with closeness to the end, by the library's steps to the nearest mesh with multipliers. */
#ifndef COMPARE_PROJECTION_H
#define COMPARE_PROJECTION_H

#include "compare.h"

typedef struct compare_guided {
    gproj_form *form;
    int32_t iterations; /* so far */
} compare_guided;

/* A form that is led by closeness, without constraints so far. */
static gproj_form *compare_guided_form(compare_problem *problem) {
    static const gproj_schedule schedule = {0.03, 0.3, 5};
    gproj_form *form = gproj_form_create(problem->mesh, NULL);
    gproj_set_schedule(form, gproj_add_closeness(form, 1), schedule);
    return form;
}

/* The call that ends a solve may find that all holds, and take no iteration. */
static bool compare_guided_step(compare_guided *guided) {
    int32_t before = guided->iterations;
    if (gproj_solve_is_on(guided->form)) guided->iterations = gproj_solve_advance(guided->form, 0).iterations;
    return guided->iterations > before;
}

static void *compare_guided_begin(compare_problem *problem, int32_t iterations, bool nearest) {
    compare_guided *guided = compare_take(1, sizeof *guided);
    gproj_solve_options options = {0};
    options.nearest = nearest;
    guided->form = compare_guided_form(problem);
    gproj_add_planarity(guided->form, 1);
    if (problem->circular) gproj_add_circularity(guided->form, 1);
    gproj_solve_begin(guided->form, iterations, &options, NULL);
    return guided;
}

static void *compare_projection_begin(compare_problem *problem) {
    return compare_guided_begin(problem, problem->iterations, false);
}

/* 30 iterations, as the library advises: the guard of the faces lasts almost to the last one. */
static void *compare_nearest_begin(compare_problem *problem) {
    return compare_guided_begin(problem, problem->iterations < 30 ? problem->iterations : 30, true);
}

static bool compare_projection_step(compare_problem *problem, void *user) {
    (void)problem;
    return compare_guided_step(user);
}

static void compare_projection_end(void *user) {
    compare_guided *guided = user;
    gproj_form_destroy(guided->form);
    free(guided);
}

static const compare_method compare_projection = {
    "guided projection",     "projection",          "#c0392b", true, {0}, {0}, compare_projection_begin,
    compare_projection_step, compare_projection_end};

static const compare_method compare_nearest = {
    "guided, nearest",     "nearest", "#7f8c8d", true, {0}, {0}, compare_nearest_begin, compare_projection_step,
    compare_projection_end};

#endif
