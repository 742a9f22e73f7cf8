/* compare.h - foundations for the methods of tools/compare: the problem, faces and their planes and circles, the step
   with a constant matrix, and sparse matrices that are factored again and again.

   All methods solve one problem for a mesh with mean edge length 1 and positions p at the start:

       sum_i |v_i - p_i|^2 small,   all faces planar (or circular).

   A method moves problem->mesh->position by one iteration in each call of `step`. Measures are taken by compare.c
   between the calls, the same for all methods. Include guidedproj.h before this file. */
#ifndef COMPARE_H
#define COMPARE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The corners of face k: vertex[start[k]..start[k + 1] - 1]. Faces with 3 corners are planar and left out. */
typedef struct compare_faces {
    int32_t count, most; /* most: corners of one face */
    int32_t *start, *vertex;
} compare_faces;

typedef struct compare_problem {
    gproj_mesh *mesh;       /* to be moved */
    const double *original; /* positions p: 3 * vertex_count */
    compare_faces faces;
    bool circular;          /* faces shall have circumcircles, not only planes */
    int32_t iterations;     /* limit */
    double penalty, growth; /* the tuning: the faces' weight against closeness 1, and its factor in each iteration */
} compare_problem;

typedef struct compare_method {
    const char *name, *file, *colour;
    bool circular;                           /* it can make circular faces, too */
    double penalty[12], growth[6];           /* the tuning grid, each up to a 0; an empty one: the method has none */
    void *(*begin)(compare_problem *);       /* allocates, prepares, factors */
    bool (*step)(compare_problem *, void *); /* one iteration; false: none, all is done */
    void (*end)(void *);
} compare_method;

static void compare_fail(const char *sentence) {
    fprintf(stderr, "compare: %s\n", sentence);
    exit(2);
}

static void *compare_take(size_t count, size_t size) {
    void *block = calloc(count + 1, size);
    if (!block) compare_fail("out of memory");
    return block;
}

static compare_faces compare_list_faces(const gproj_mesh *mesh) {
    compare_faces faces = {0, 0, NULL, NULL};
    int32_t corners = 0, f, k, h;
    faces.start = compare_take((size_t)mesh->face_count + 1, sizeof *faces.start);
    faces.vertex = compare_take((size_t)mesh->halfedge_count, sizeof *faces.vertex);
    for (f = 0; f < mesh->face_count; ++f) {
        if (mesh->face_degree[f] <= 3) continue;
        for (k = 0, h = mesh->face_halfedge[f]; k < mesh->face_degree[f]; ++k, h = mesh->next[h])
            faces.vertex[corners++] = mesh->origin[h];
        if (mesh->face_degree[f] > faces.most) faces.most = mesh->face_degree[f];
        faces.start[++faces.count] = corners;
    }
    return faces;
}

static double compare_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void compare_cross(const double a[3], const double b[3], double c[3]) {
    c[0] = a[1] * b[2] - a[2] * b[1], c[1] = a[2] * b[0] - a[0] * b[2], c[2] = a[0] * b[1] - a[1] * b[0];
}

/* ---- planes and circles ---- */

/* Subtracts the mean from `count` points. */
static void compare_centre(int32_t count, double *q) {
    double mean[3] = {0, 0, 0};
    int32_t i;
    for (i = 0; i < 3 * count; ++i) mean[i % 3] += q[i] / count;
    for (i = 0; i < 3 * count; ++i) q[i] -= mean[i % 3];
}

/* Copies the corners of face k, less their mean, to q. Returns their number. */
static int32_t compare_corners(const compare_problem *problem, int32_t k, double *q) {
    const int32_t *vertex = problem->faces.vertex + problem->faces.start[k];
    int32_t count = problem->faces.start[k + 1] - problem->faces.start[k], i;
    for (i = 0; i < 3 * count; ++i) q[i] = problem->mesh->position[3 * vertex[i / 3] + i % 3];
    compare_centre(count, q);
    return count;
}

/* Finds the least-squares plane through 0 of points with mean 0: of the matrix A of their second moments, the
   eigenvector n with the smallest eigenvalue is the normal. It belongs to the largest eigenvalue of the adjugate, whose
   powers, scaled to trace 1, tend to n n'; each squaring doubles the digits. */
static void compare_normal(int32_t count, const double *q, double normal[3]) {
    double a[3][3] = {{0}}, b[3][3], squares, trace, length;
    int32_t most = 0, i, j, step;
    for (i = 0; i < count; ++i, q += 3)
        for (j = 0; j < 3; ++j) a[j][0] += q[j] * q[0], a[j][1] += q[j] * q[1], a[j][2] += q[j] * q[2];
    for (i = 0; i < 3; ++i) compare_cross(a[(i + 1) % 3], a[(i + 2) % 3], b[i]);
    for (step = 0; step < 12; ++step) {
        trace = b[0][0] + b[1][1] + b[2][2];
        for (i = 0, squares = 0; i < 3; ++i)
            for (j = 0; j < 3; ++j)
                a[i][j] = trace > 0 ? b[i][j] / trace : i == 2 && j == 2, squares += a[i][j] * a[i][j];
        if (squares > 1 - 4e-16) break; /* the other eigenvalues are gone */
        for (i = 0; i < 3; ++i)
            for (j = 0; j < 3; ++j) b[i][j] = compare_dot(a[i], a[j]); /* symmetric: rows are columns */
    }
    for (i = 1; i < 3; ++i)
        if (a[i][i] > a[most][most]) most = i;
    length = sqrt(compare_dot(a[most], a[most]));
    for (i = 0; i < 3; ++i) normal[i] = a[most][i] / length;
}

/* Solves the 2 x 2 system (xx xy; xy yy) d = r; a singular one gives 0. */
static void compare_solve_2(const double m[3], const double r[2], double d[2]) {
    double determinant = m[0] * m[2] - m[1] * m[1], inverse = determinant > 0 ? 1 / determinant : 0;
    d[0] = (m[2] * r[0] - m[1] * r[1]) * inverse, d[1] = (m[0] * r[1] - m[1] * r[0]) * inverse;
}

/* Moves points of a plane (x in q[3i], y in q[3i + 1], mean 0) to the nearest circle: the algebraic fit, |q|^2 = 2 c'q +
   const in the least-squares sense, improved by Gauss and Newton's method for the distances from the circle. */
static void compare_round(int32_t count, double *q) {
    double m[3] = {0, 0, 0}, r[2] = {0, 0}, c[2], d[2], radius = 0;
    int32_t i, step;
    for (i = 0; i < count; ++i) {
        double x = q[3 * i], y = q[3 * i + 1], square = x * x + y * y;
        m[0] += 2 * x * x, m[1] += 2 * x * y, m[2] += 2 * y * y, r[0] += square * x, r[1] += square * y;
    }
    compare_solve_2(m, r, c);
    for (step = 0; step <= 3; ++step) {
        double ux = 0, uy = 0; /* mean directions: the best radius, the mean distance, is eliminated */
        for (i = 0, radius = 0; i < count; ++i) {
            double x = q[3 * i] - c[0], y = q[3 * i + 1] - c[1], distance = hypot(x, y);
            radius += distance / count, ux += x / distance / count, uy += y / distance / count;
        }
        if (step == 3) break; /* this radius belongs to the last centre */
        m[0] = m[1] = m[2] = r[0] = r[1] = 0;
        for (i = 0; i < count; ++i) {
            double x = q[3 * i] - c[0], y = q[3 * i + 1] - c[1], distance = hypot(x, y);
            x = x / distance - ux, y = y / distance - uy, distance -= radius;
            m[0] += x * x, m[1] += x * y, m[2] += y * y, r[0] += distance * x, r[1] += distance * y;
        }
        compare_solve_2(m, r, d);
        c[0] += d[0], c[1] += d[1];
    }
    for (i = 0; i < count; ++i) {
        double x = q[3 * i] - c[0], y = q[3 * i + 1] - c[1], scale = radius / hypot(x, y);
        q[3 * i] = c[0] + scale * x, q[3 * i + 1] = c[1] + scale * y;
    }
}

/* Moves points with mean 0 to the nearest points of a plane, or of a circle in it. */
static void compare_project(int32_t count, double *q, bool circular) {
    double n[3], e[3], g[3], away;
    int32_t i, k, axis = 0;
    compare_normal(count, q, n);
    if (!circular) {
        for (i = 0; i < count; ++i)
            for (k = 0, away = compare_dot(q + 3 * i, n); k < 3; ++k) q[3 * i + k] -= away * n[k];
        return;
    }
    for (k = 1; k < 3; ++k)
        if (fabs(n[k]) < fabs(n[axis])) axis = k;
    for (k = 0; k < 3; ++k) e[k] = (k == axis) - n[axis] * n[k];
    away = sqrt(compare_dot(e, e));
    for (k = 0; k < 3; ++k) e[k] /= away;
    compare_cross(n, e, g);
    for (i = 0; i < count; ++i) {
        double x = compare_dot(q + 3 * i, e), y = compare_dot(q + 3 * i, g);
        q[3 * i] = x, q[3 * i + 1] = y;
    }
    compare_round(count, q);
    for (i = 0; i < count; ++i) {
        double x = q[3 * i], y = q[3 * i + 1];
        for (k = 0; k < 3; ++k) q[3 * i + k] = x * e[k] + y * g[k];
    }
}

/* ---- sparse matrices ---- */

/* A symmetric matrix, assembled from entries that are added in the same order each time. */
typedef struct compare_matrix {
    gproj_cholesky *cholesky;
    int32_t n;
    int64_t count, capacity; /* entries so far */
    int32_t *column, *row;   /* of the entries in their order; until the first factorisation */
    int64_t *slot;           /* where each one's value stands; NULL before the first factorisation */
    double *value;           /* in that order before it, by columns after it */
} compare_matrix;

static compare_matrix compare_matrix_of(int32_t n) {
    compare_matrix matrix = {NULL, 0, 0, 0, NULL, NULL, NULL, NULL};
    matrix.cholesky = gproj_cholesky_create(NULL);
    matrix.n = n;
    return matrix;
}

static void *compare_grow(void *block, int64_t count, size_t size) {
    block = realloc(block, (size_t)count * size);
    if (!block) compare_fail("out of memory");
    return block;
}

/* Adds an entry; each pair of i and j in one order only. */
static void compare_add(compare_matrix *matrix, int32_t i, int32_t j, double value) {
    int64_t at = matrix->count++;
    if (matrix->slot) {
        matrix->value[matrix->slot[at]] = value;
        return;
    }
    if (at == matrix->capacity) {
        matrix->capacity = 2 * at + 1024;
        matrix->row = compare_grow(matrix->row, matrix->capacity, sizeof *matrix->row);
        matrix->column = compare_grow(matrix->column, matrix->capacity, sizeof *matrix->column);
        matrix->value = compare_grow(matrix->value, matrix->capacity, sizeof *matrix->value);
    }
    matrix->row[at] = i > j ? i : j, matrix->column[at] = i > j ? j : i, matrix->value[at] = value;
}

/* Sorts the entries by columns, finds their slots, and analyses the pattern. */
static void compare_analyse(compare_matrix *matrix) {
    int64_t *start = compare_take((size_t)matrix->n + 1, sizeof *start), at;
    int32_t *row = compare_take((size_t)matrix->count, sizeof *row), j;
    double *value = compare_take((size_t)matrix->count, sizeof *value);
    matrix->slot = compare_take((size_t)matrix->count, sizeof *matrix->slot);
    for (at = 0; at < matrix->count; ++at) ++start[matrix->column[at] + 1];
    for (j = 0; j < matrix->n; ++j) start[j + 1] += start[j];
    for (at = 0; at < matrix->count; ++at) matrix->slot[at] = start[matrix->column[at]]++;
    for (j = matrix->n; j > 0; --j) start[j] = start[j - 1];
    start[0] = 0;
    for (at = 0; at < matrix->count; ++at)
        row[matrix->slot[at]] = matrix->row[at], value[matrix->slot[at]] = matrix->value[at];
    free(matrix->value), matrix->value = value;
    gproj_cholesky_analyse(matrix->cholesky, matrix->n, start, row, NULL);
    free(start), free(row);
}

/* Factors the sum of the entries; the next ones begin a new sum. */
static void compare_factor(compare_matrix *matrix) {
    if (!matrix->slot) compare_analyse(matrix);
    matrix->count = 0;
    if (gproj_cholesky_factor(matrix->cholesky, matrix->value) != GPROJ_FACTORED)
        compare_fail("a matrix was not positive definite");
}

static void compare_matrix_free(compare_matrix *matrix) {
    gproj_cholesky_destroy(matrix->cholesky);
    free(matrix->row), free(matrix->column), free(matrix->slot), free(matrix->value);
}

/* ---- all vertices towards given shapes of the faces, by a constant matrix ---- */

typedef struct compare_shapes {
    compare_matrix matrix; /* I + penalty sum C'C for x, y and z alike; C takes the mean from the corners of a face */
    double *target;        /* 3 numbers with mean 0 for each corner of each face */
    double *side, *q;      /* work space: 3 * vertex_count, and 3 for each corner of a face */
} compare_shapes;

static compare_shapes compare_shapes_of(const compare_problem *problem) {
    const compare_faces *faces = &problem->faces;
    compare_shapes shapes;
    int32_t i, j, k;
    shapes.matrix = compare_matrix_of(problem->mesh->vertex_count);
    shapes.target = compare_take(3 * (size_t)faces->start[faces->count], sizeof *shapes.target);
    shapes.side = compare_take(3 * (size_t)problem->mesh->vertex_count, sizeof *shapes.side);
    shapes.q = compare_take(3 * (size_t)faces->most, sizeof *shapes.q);
    for (i = 0; i < shapes.matrix.n; ++i) compare_add(&shapes.matrix, i, i, 1);
    for (k = 0; k < faces->count; ++k)
        for (i = faces->start[k]; i < faces->start[k + 1]; ++i)
            for (j = faces->start[k]; j <= i; ++j)
                compare_add(&shapes.matrix, faces->vertex[i], faces->vertex[j],
                            problem->penalty * ((i == j) - 1.0 / (faces->start[k + 1] - faces->start[k])));
    compare_factor(&shapes.matrix);
    return shapes;
}

/* Moves the vertices to the minimum of sum |v - p|^2 + penalty sum |C v - target|^2. Steps from the present v, so that
   rounding is relative to the step. */
static void compare_reach(compare_problem *problem, compare_shapes *shapes) {
    const compare_faces *faces = &problem->faces;
    int32_t n = shapes->matrix.n, i, k;
    double *v = problem->mesh->position, *side = shapes->side;
    for (i = 0; i < 3 * n; ++i) side[i % 3 * n + i / 3] = problem->original[i] - v[i];
    for (k = 0; k < faces->count; ++k) {
        int32_t first = faces->start[k], count = compare_corners(problem, k, shapes->q);
        for (i = 0; i < 3 * count; ++i)
            side[i % 3 * n + faces->vertex[first + i / 3]] +=
                problem->penalty * (shapes->target[3 * first + i] - shapes->q[i]);
    }
    gproj_cholesky_solve(shapes->matrix.cholesky, 3, side, side);
    for (i = 0; i < 3 * n; ++i) v[i] += side[i % 3 * n + i / 3];
}

static void compare_shapes_free(compare_shapes *shapes) {
    compare_matrix_free(&shapes->matrix);
    free(shapes->target), free(shapes->side), free(shapes->q);
}

#endif
