/* compare_poranne.h - alternating least squares with a growing penalty (Poranne, Ovreiu, Gotsman 2013): minimise

       sum_i |v_i - p_i|^2 + penalty sum_k sum_(i in k) (n_k'v_i - d_k)^2

   by turns: with the vertices given, n_k and d_k are the faces' least-squares planes; with the normals given, vertices
   and offsets d_k are the solution of a linear system, anew in each iteration, here with the offsets d_k = n_k'mean
   eliminated. Then the penalty grows. */
#ifndef COMPARE_PORANNE_H
#define COMPARE_PORANNE_H

#include "compare.h"

typedef struct compare_poranne_state {
    compare_matrix matrix;
    double penalty, *side, *q;
} compare_poranne_state;

static void *compare_poranne_begin(compare_problem *problem) {
    compare_poranne_state *state = compare_take(1, sizeof *state);
    state->matrix = compare_matrix_of(3 * problem->mesh->vertex_count);
    state->penalty = problem->penalty;
    state->side = compare_take(3 * (size_t)problem->mesh->vertex_count, sizeof *state->side);
    state->q = compare_take(3 * (size_t)problem->faces.most, sizeof *state->q);
    return state;
}

/* Adds a face with corners q to the matrix, penalty C'n n'C (lower half), and to the right-hand side. The heights n'q
   lose their mean once more: what rounding leaves of it would move the vertices freely, times the penalty. */
static void compare_poranne_face(compare_poranne_state *state, int32_t count, const int32_t *vertex, const double *q) {
    double n[3], mean = 0;
    int32_t i, j;
    compare_normal(count, q, n);
    for (i = 0; i < count; ++i) mean += compare_dot(n, q + 3 * i) / count;
    for (i = 0; i < 3 * count; ++i) {
        double height = compare_dot(n, q + i / 3 * 3) - mean;
        state->side[3 * vertex[i / 3] + i % 3] -= state->penalty * height * n[i % 3];
        for (j = 0; j <= i; ++j)
            compare_add(&state->matrix, 3 * vertex[i / 3] + i % 3, 3 * vertex[j / 3] + j % 3,
                        state->penalty * n[i % 3] * n[j % 3] * ((i / 3 == j / 3) - 1.0 / count));
    }
}

static bool compare_poranne_step(compare_problem *problem, void *user) {
    const compare_faces *faces = &problem->faces;
    compare_poranne_state *state = user;
    double *v = problem->mesh->position;
    int32_t i, k;
    if (state->penalty >= 1e15) return false; /* closeness is lost in rounding */
    for (i = 0; i < state->matrix.n; ++i) {
        compare_add(&state->matrix, i, i, 1);
        state->side[i] = problem->original[i] - v[i];
    }
    for (k = 0; k < faces->count; ++k) {
        int32_t count = compare_corners(problem, k, state->q);
        compare_poranne_face(state, count, faces->vertex + faces->start[k], state->q);
    }
    compare_factor(&state->matrix);
    gproj_cholesky_solve(state->matrix.cholesky, 1, state->side, state->side);
    for (i = 0; i < state->matrix.n; ++i) v[i] += state->side[i];
    state->penalty *= problem->growth;
    return true;
}

static void compare_poranne_end(void *user) {
    compare_poranne_state *state = user;
    compare_matrix_free(&state->matrix);
    free(state->side), free(state->q), free(state);
}

static const compare_method compare_poranne = {"alternating",
                                               "poranne",
                                               "#7d3c98",
                                               false,
                                               {1, 100},
                                               {1.02, 1.05, 1.1, 1.3, 2},
                                               compare_poranne_begin,
                                               compare_poranne_step,
                                               compare_poranne_end};

#endif
