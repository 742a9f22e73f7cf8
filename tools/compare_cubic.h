/* compare_cubic.h - guided projection without normals (method C in Figure 10 of Tang et al. 2014): four consecutive
   corners of a face are in a plane if

       det(b - a, c - a, d - a) = 0,

   which is cubic in their coordinates. Linearised at each iteration, it takes the library's steps, with its closeness.
   The determinant is the distance of the diagonals ac and bd times |(c - a) x (d - b)|; over the latter at the start it
   is a length, as the rows of other constraints. */
#ifndef COMPARE_CUBIC_H
#define COMPARE_CUBIC_H

#include "compare_projection.h"

typedef struct compare_cubic_state {
    compare_guided guided;
    int32_t rows;
    int32_t *corner; /* 4 vertices of each row */
    double *scale;   /* of each row */
} compare_cubic_state;

/* Computes phi and grad phi of a row at x; e: the edges from a, gradients at b, c, d are cross products of two others. */
static double compare_cubic_row(const double *x, const int32_t *corner, double scale, double g[12]) {
    double e[3][3], value;
    int32_t i;
    for (i = 0; i < 9; ++i) e[i / 3][i % 3] = x[3 * corner[i / 3 + 1] + i % 3] - x[3 * corner[0] + i % 3];
    for (i = 0; i < 3; ++i) compare_cross(e[(i + 1) % 3], e[(i + 2) % 3], g + 3 * (i + 1));
    value = scale * compare_dot(e[0], g + 3);
    for (i = 3; i < 12; ++i) g[i] *= scale;
    for (i = 0; i < 3; ++i) g[i] = -g[3 + i] - g[6 + i] - g[9 + i];
    return value;
}

/* Replaces each row by its tangent: phi(x) + grad phi'(y - x) for variables y. */
static void compare_cubic_refresh(void *user, gproj_system *system, int32_t group, const gproj_progress *progress) {
    const compare_cubic_state *state = user;
    const double *x = gproj_system_values(system);
    int32_t row, i;
    (void)progress;
    for (row = 0; row < state->rows; ++row) {
        const int32_t *corner = state->corner + 4 * row;
        double g[12], constant = compare_cubic_row(x, corner, state->scale[row], g);
        for (i = 0; i < 12; ++i) constant -= g[i] * x[3 * corner[i / 3] + i % 3];
        gproj_system_set_row(system, group, row, g, constant);
    }
}

/* Lists the rows: quads have one, other faces one for each corner after the third. */
static void compare_cubic_list(const compare_problem *problem, compare_cubic_state *state) {
    const compare_faces *faces = &problem->faces;
    const double *x = problem->original;
    size_t most = (size_t)faces->start[faces->count];
    int32_t k, i, first;
    state->corner = compare_take(4 * most, sizeof *state->corner);
    state->scale = compare_take(most, sizeof *state->scale);
    for (k = 0; k < faces->count; ++k)
        for (first = faces->start[k]; first + 3 < faces->start[k + 1]; ++first, ++state->rows) {
            int32_t *corner = state->corner + 4 * state->rows;
            double ac[3], bd[3], cross[3];
            memcpy(corner, faces->vertex + first, 4 * sizeof *corner);
            for (i = 0; i < 3; ++i) {
                ac[i] = x[3 * corner[2] + i] - x[3 * corner[0] + i];
                bd[i] = x[3 * corner[3] + i] - x[3 * corner[1] + i];
            }
            compare_cross(ac, bd, cross);
            state->scale[state->rows] = 1 / fmax(sqrt(compare_dot(cross, cross)), 1e-6);
        }
}

static void *compare_cubic_begin(compare_problem *problem) {
    compare_cubic_state *state = compare_take(1, sizeof *state);
    gproj_group group = {"det", GPROJ_CONSTRAINT, false, GPROJ_PLACE_NONE, gproj_keep(1), compare_cubic_refresh, state};
    int32_t number, row, i;
    gproj_system *system;
    double scale;
    compare_cubic_list(problem, state);
    state->guided.form = compare_guided_form(problem);
    gproj_form_units(state->guided.form, NULL, &scale);
    for (row = 0; row < state->rows; ++row) state->scale[row] /= scale * scale; /* areas in the form's units */
    system = gproj_form_system(state->guided.form);
    number = gproj_system_add_group(system, &group);
    for (row = 0; row < state->rows; ++row) {
        gproj_term term[12];
        for (i = 0; i < 12; ++i) term[i].i = 3 * state->corner[4 * row + i / 3] + i % 3, term[i].j = -1, term[i].a = 0;
        gproj_system_add_row(system, number, 12, term, 0, row);
    }
    gproj_solve_begin(state->guided.form, problem->iterations, NULL, NULL);
    return state;
}

static bool compare_cubic_step(compare_problem *problem, void *user) {
    compare_cubic_state *state = user;
    (void)problem;
    return compare_guided_step(&state->guided);
}

static void compare_cubic_end(void *user) {
    compare_cubic_state *state = user;
    gproj_form_destroy(state->guided.form);
    free(state->corner), free(state->scale), free(state);
}

static const compare_method compare_cubic = {
    "guided, cubic", "cubic", "#d68910", false, {0}, {0}, compare_cubic_begin, compare_cubic_step, compare_cubic_end};

#endif
