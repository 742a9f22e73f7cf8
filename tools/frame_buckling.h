/* frame_buckling.h - linear buckling of frames: by which factor all loads must grow until the frame bends sideways.

       if (gprojx_frame_buckle(&frame, axial, &buckling) != GPROJ_OK) ...     after gprojx_frame_solve
       buckling.factor[0], buckling.residual[0], buckling.shape               the smallest factor and the shape
       free(buckling.shape);

   The factors are the positive numbers f with (K + f G) x = 0 for some x: K is the elastic stiffness, G the geometric
   one of the axial forces under the given loads. Forces of both signs are allowed; negative f belong to loads turned
   round and do not count. With m = 1/f this is -G x = m K x, whose largest m are sought: K is positive definite, so
   they are at one end of the spectrum, however large negative m are. Displacements before buckling are neglected, and
   moments and torsion taken not to weaken the frame.

   Include guidedproj.h before this file. */
#ifndef GPROJX_FRAME_BUCKLING_H
#define GPROJX_FRAME_BUCKLING_H

#include "frame.h"

enum {
    GPROJX_WANTED = 4,     /* factors; up to four equal ones are found */
    GPROJX_DIMENSION = 32, /* of the subspace, before the better half is kept */
    GPROJX_ROUNDS = 400
};

typedef struct gprojx_buckling {
    double factor[GPROJX_WANTED];   /* ascending; INFINITY: there is none */
    double residual[GPROJX_WANTED]; /* relative: an exact factor is within factor times residual */
    int32_t rounds;
    bool converged; /* all residuals of factors are at most 1e-8 */
    double *shape;  /* of the smallest factor, 6 a node, largest displacement 1; by malloc; NULL: no factor */
} gprojx_buckling;

/* Vectors v, K v and -G v, 6 a node each, column by column. */
typedef struct gprojx_subspace {
    gprojx_frame *frame;
    const double *axial;
    size_t motions;
    int count;
    double *v, *kv, *gv;
    double *spare; /* room for GPROJX_DIMENSION columns more */
    double h[GPROJX_DIMENSION][GPROJX_DIMENSION], y[GPROJX_DIMENSION][GPROJX_DIMENSION];
} gprojx_subspace;

/* Eigenvalues of a symmetric matrix by Jacobi's rotations: h becomes diagonal, descending, and the columns of y the
   eigenvectors. */
static void gprojx_jacobi(int n, double h[][GPROJX_DIMENSION], double y[][GPROJX_DIMENSION]) {
    int i, j, k, sweep;
    for (i = 0; i < n; ++i)
        for (j = 0; j < n; ++j) y[i][j] = i == j;
    for (sweep = 0; sweep < 30; ++sweep)
        for (i = 0; i < n; ++i)
            for (j = i + 1; j < n; ++j) {
                double angle = 0.5 * atan2(2 * h[i][j], h[i][i] - h[j][j]), c = cos(angle), s = sin(angle), a, b;
                if (!(fabs(h[i][j]) > 1e-300)) continue;
                for (k = 0; k < n; ++k) {
                    a = h[k][i], b = h[k][j];
                    h[k][i] = c * a + s * b, h[k][j] = c * b - s * a;
                    a = y[k][i], b = y[k][j];
                    y[k][i] = c * a + s * b, y[k][j] = c * b - s * a;
                }
                for (k = 0; k < n; ++k) {
                    a = h[i][k], b = h[j][k];
                    h[i][k] = c * a + s * b, h[j][k] = c * b - s * a;
                }
            }
    for (i = 0; i < n; ++i)
        for (j = n - 1; j > i; --j)
            if (h[j][j] > h[j - 1][j - 1]) {
                double t = h[j][j];
                h[j][j] = h[j - 1][j - 1], h[j - 1][j - 1] = t;
                for (k = 0; k < n; ++k) t = y[k][j], y[k][j] = y[k][j - 1], y[k][j - 1] = t;
            }
}

/* Multiplies a vector by K or by -G, and leaves zeros at motions that are held. */
static void gprojx_subspace_multiply(const gprojx_subspace *s, bool geometric, const double *x, double *out) {
    size_t i;
    gprojx_frame_multiply(s->frame, geometric ? s->axial : NULL, x, out);
    for (i = 0; i < s->motions; ++i) out[i] = s->frame->unknown[i] < 0 ? 0 : geometric ? -out[i] : out[i];
}

/* Appends the vector that stands behind the last one, K-orthogonal to the others and with x'K x = 1; a vector that the
   others span is left out. Gram and Schmidt twice: the first time rounding leaves a part of the others. */
static void gprojx_subspace_append(gprojx_subspace *s) {
    size_t m = s->motions, i;
    double *x = s->v + (size_t)s->count * m, *kx = s->kv + (size_t)s->count * m, norm, before;
    int pass, j;
    gprojx_subspace_multiply(s, false, x, kx);
    before = sqrt(fmax(0, gprojx_frame_dot(m, x, kx)));
    for (pass = 0; pass < 2; ++pass) {
        for (j = 0; j < s->count; ++j) {
            double part = gprojx_frame_dot(m, s->kv + (size_t)j * m, x);
            for (i = 0; i < m; ++i) x[i] -= part * s->v[(size_t)j * m + i];
        }
        gprojx_subspace_multiply(s, false, x, kx);
        norm = sqrt(fmax(0, gprojx_frame_dot(m, x, kx)));
        if (!(norm > 1e-12 * before)) return;
        for (i = 0; i < m; ++i) x[i] /= norm, kx[i] /= norm;
        before = 1;
    }
    gprojx_subspace_multiply(s, true, x, s->gv + (size_t)s->count * m);
    s->count++;
}

/* Replaces columns by their first `count` combinations with y. */
static void gprojx_subspace_combine(const gprojx_subspace *s, double *columns, int count) {
    size_t m = s->motions, i;
    int j, k;
    memset(s->spare, 0, (size_t)count * m * sizeof *columns);
    for (k = 0; k < count; ++k)
        for (j = 0; j < s->count; ++j)
            for (i = 0; i < m; ++i) s->spare[(size_t)k * m + i] += s->y[j][k] * columns[(size_t)j * m + i];
    memcpy(columns, s->spare, (size_t)count * m * sizeof *columns);
}

/* Turns the columns into those that make H = V'(-G)V diagonal: approximate eigenvectors, the best first [Rayleigh,
   Ritz]. */
static void gprojx_subspace_turn(gprojx_subspace *s) {
    size_t m = s->motions;
    int i, j;
    for (i = 0; i < s->count; ++i)
        for (j = 0; j <= i; ++j)
            s->h[i][j] = s->h[j][i] = gprojx_frame_dot(m, s->v + (size_t)i * m, s->gv + (size_t)j * m);
    gprojx_jacobi(s->count, s->h, s->y);
    gprojx_subspace_combine(s, s->v, s->count);
    gprojx_subspace_combine(s, s->kv, s->count);
    gprojx_subspace_combine(s, s->gv, s->count);
}

/* Adds inverse iterations K^-1 r of the residuals r = -G x - m K x of the wanted pairs, and puts the norms of r,
   sqrt(r' K^-1 r) / m, into the result: within that part of m there is an exact one. Returns whether all are small.
   */
static bool gprojx_subspace_extend(gprojx_subspace *s, gprojx_buckling *result) {
    size_t m = s->motions, i;
    double *r = s->spare, largest = fabs(s->h[0][0]), *x;
    bool done = s->h[0][0] > 0;
    int old = s->count, k;
    for (k = 0; k < GPROJX_WANTED && k < old; ++k) {
        double value = s->h[k][k];
        for (i = 0; i < m; ++i) r[i] = s->gv[(size_t)k * m + i] - value * s->kv[(size_t)k * m + i];
        x = s->v + (size_t)s->count * m;
        gprojx_frame_apply_inverse(s->frame, r, x);
        result->factor[k] = value > 1e-9 * largest ? 1 / value : INFINITY;
        result->residual[k] = sqrt(fmax(0, gprojx_frame_dot(m, r, x))) / fabs(value);
        if (value > 1e-9 * largest && result->residual[k] > 1e-8) done = false;
        if (result->residual[k] > 1e-10) gprojx_subspace_append(s);
    }
    return done || s->count == old;
}

static gproj_code gprojx_subspace_run(gprojx_subspace *s, gprojx_buckling *result) {
    size_t m = s->motions, i;
    double largest = 0;
    int k;
    for (k = 0; k < GPROJX_WANTED; ++k) { /* begins with arbitrary loads, which the frame makes smooth */
        for (i = 0; i < m; ++i) s->spare[i] = sin((k + 1) * (0.7 + 1.1 * (double)i));
        gprojx_frame_apply_inverse(s->frame, s->spare, s->v + (size_t)s->count * m);
        gprojx_subspace_append(s);
    }
    for (result->rounds = 1; result->rounds <= GPROJX_ROUNDS && !result->converged; ++result->rounds) {
        gprojx_subspace_turn(s);
        if (s->count + GPROJX_WANTED > GPROJX_DIMENSION) s->count = GPROJX_DIMENSION / 2;
        result->converged = gprojx_subspace_extend(s, result);
    }
    if (!(result->factor[0] < INFINITY)) return GPROJ_OK;
    result->shape = (double *)malloc(m * sizeof *result->shape);
    if (!result->shape) return GPROJ_ERROR_MEMORY;
    for (i = 0; i < m; i += 6) largest = fmax(largest, gprojx_length3(s->v + i));
    for (i = 0; i < m; ++i) result->shape[i] = s->v[i] / (largest > 0 ? largest : 1);
    return GPROJ_OK;
}

/* Finds the smallest positive factors of a solved frame. axial: the axial force of each beam, tension > 0. There is
   none if no beam is in compression. */
static gproj_code gprojx_frame_buckle(gprojx_frame *frame, const double *axial, gprojx_buckling *result) {
    gprojx_subspace *s = (gprojx_subspace *)calloc(1, sizeof *s);
    size_t block = 6 * (size_t)frame->node_count * GPROJX_DIMENSION;
    gproj_code code = GPROJ_ERROR_MEMORY;
    bool compressed = false;
    int32_t b;
    int k;
    memset(result, 0, sizeof *result);
    for (k = 0; k < GPROJX_WANTED; ++k) result->factor[k] = INFINITY;
    for (b = 0; b < frame->beam_count; ++b) compressed |= axial[b] < 0;
    if (s) s->v = (double *)malloc((4 * block + 1) * sizeof *s->v);
    if (s && s->v) {
        s->frame = frame, s->axial = axial, s->motions = 6 * (size_t)frame->node_count;
        s->kv = s->v + block, s->gv = s->kv + block, s->spare = s->gv + block;
        code = GPROJ_OK;
        if (compressed && frame->unknowns > 0)
            code = gprojx_subspace_run(s, result);
        else
            result->converged = true;
    }
    if (s) free(s->v);
    free(s);
    return code;
}

#endif
