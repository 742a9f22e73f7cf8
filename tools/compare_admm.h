/* compare_admm.h - augmented Lagrangian with splitting (Deng, Bouaziz, Deuss, Kaspar, Schwartzburg, Pauly 2014, 2015;
   known as the alternating direction method of multipliers): closeness is soft, planarity (circularity) hard,

       minimise sum_i |v_i - p_i|^2   subject to   C_k v = t_k,  t_k planar (circular),

   C_k v the corners of face k less their mean, with multipliers penalty * u_k. By turns t_k becomes the polygon nearest
   to C_k v + u_k, v the minimum of sum |v - p|^2 + penalty sum |C v - t + u|^2 (by a matrix that never changes), and
   u_k grows by C_k v - t_k. At rest C v = t holds whatever the penalty, and v is nearest to p. */
#ifndef COMPARE_ADMM_H
#define COMPARE_ADMM_H

#include "compare.h"

typedef struct compare_admm_state {
    compare_shapes shapes; /* with the targets t - u */
    double *t, *u;
} compare_admm_state;

static void *compare_admm_begin(compare_problem *problem) {
    compare_admm_state *state = compare_take(1, sizeof *state);
    size_t corners = (size_t)problem->faces.start[problem->faces.count];
    state->shapes = compare_shapes_of(problem);
    state->t = compare_take(6 * corners, sizeof *state->t);
    state->u = state->t + 3 * corners;
    return state;
}

static bool compare_admm_step(compare_problem *problem, void *user) {
    const compare_faces *faces = &problem->faces;
    compare_admm_state *state = user;
    int32_t k, i;
    for (k = 0; k < faces->count; ++k) {
        int32_t first = 3 * faces->start[k], count = compare_corners(problem, k, state->t + first);
        for (i = first; i < first + 3 * count; ++i) state->t[i] += state->u[i];
        compare_project(count, state->t + first, problem->circular);
        for (i = first; i < first + 3 * count; ++i) state->shapes.target[i] = state->t[i] - state->u[i];
    }
    compare_reach(problem, &state->shapes);
    for (k = 0; k < faces->count; ++k) {
        int32_t first = 3 * faces->start[k], count = compare_corners(problem, k, state->shapes.q);
        for (i = 0; i < 3 * count; ++i) state->u[first + i] += state->shapes.q[i] - state->t[first + i];
    }
    return true;
}

static void compare_admm_end(void *user) {
    compare_admm_state *state = user;
    compare_shapes_free(&state->shapes);
    free(state->t), free(state);
}

static const compare_method compare_admm = {"ADMM",
                                            "admm",
                                            "#1e8449",
                                            true,
                                            {3, 6, 10, 20, 40, 100, 1000, 10000},
                                            {0},
                                            compare_admm_begin,
                                            compare_admm_step,
                                            compare_admm_end};

#endif
