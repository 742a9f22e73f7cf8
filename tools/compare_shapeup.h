/* compare_shapeup.h - Shape-Up (Bouaziz, Deuss, Schwartzburg, Weise, Pauly 2012): local and global steps by turns
   make

       sum_i |v_i - p_i|^2 + penalty sum_k |C_k v - t_k|^2

   smaller, C_k v the corners of face k less their mean. Local: t_k becomes the planar (circular) polygon nearest to C_k
   v. Global: with all t_k given, v is the least-squares solution, by a matrix that never changes and is factored once.
   Neither step can raise the sum. */
#ifndef COMPARE_SHAPEUP_H
#define COMPARE_SHAPEUP_H

#include "compare.h"

static void *compare_shapeup_begin(compare_problem *problem) {
    compare_shapes *shapes = compare_take(1, sizeof *shapes);
    *shapes = compare_shapes_of(problem);
    return shapes;
}

static bool compare_shapeup_step(compare_problem *problem, void *user) {
    compare_shapes *shapes = user;
    int32_t k;
    for (k = 0; k < problem->faces.count; ++k) {
        double *target = shapes->target + 3 * problem->faces.start[k];
        compare_project(compare_corners(problem, k, target), target, problem->circular);
    }
    compare_reach(problem, shapes);
    return true;
}

/* The sum above with the best t_k. */
static double compare_shapeup_energy(const compare_problem *problem) {
    double *q = compare_take(6 * (size_t)problem->faces.most, sizeof *q), *t = q + 3 * problem->faces.most, sum = 0;
    int32_t i, k;
    for (i = 0; i < 3 * problem->mesh->vertex_count; ++i)
        sum +=
            (problem->mesh->position[i] - problem->original[i]) * (problem->mesh->position[i] - problem->original[i]);
    for (k = 0; k < problem->faces.count; ++k) {
        int32_t count = compare_corners(problem, k, q);
        memcpy(t, q, 3 * (size_t)count * sizeof *t);
        compare_project(count, t, problem->circular);
        for (i = 0; i < 3 * count; ++i) sum += problem->penalty * (q[i] - t[i]) * (q[i] - t[i]);
    }
    free(q);
    return sum;
}

static void compare_shapeup_end(void *user) {
    compare_shapes_free(user);
    free(user);
}

static const compare_method compare_shapeup = {"Shape-Up",
                                               "shapeup",
                                               "#2471a3",
                                               true,
                                               {1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e8},
                                               {0},
                                               compare_shapeup_begin,
                                               compare_shapeup_step,
                                               compare_shapeup_end};

#endif
