/* test_dense.c - >>dense: the kernels against plain triple loops. */
#define GPROJ_STATIC
#include "gprojt.h"

/* The place of row i and column j in a column-major array. */
static size_t at(int32_t i, int32_t j, int32_t stride) { return (size_t)i + (size_t)j * (size_t)stride; }

/* A symmetric positive definite matrix of order n, column-major, full. */
static void fill_spd(int32_t n, double *a, uint64_t *seed) {
    int32_t i, j;
    for (j = 0; j < n; ++j)
        for (i = j; i < n; ++i) {
            double v = i == j ? n + 1.0 + gprojt_uniform(seed) : 2.0 * gprojt_uniform(seed) - 1.0;
            a[at(i, j, n)] = a[at(j, i, n)] = v;
        }
}

/* The first w steps of a Cholesky factorisation; what is left of the rest stands in its lower triangle. */
static void naive_partial(int32_t n, int32_t w, double *a) {
    int32_t i, j, k;
#define A(i, j) a[at(i, j, n)]
    for (k = 0; k < w; ++k) {
        A(k, k) = sqrt(A(k, k));
        for (i = k + 1; i < n; ++i) A(i, k) /= A(k, k);
        for (j = k + 1; j < n; ++j)
            for (i = j; i < n; ++i) A(i, j) -= A(i, k) * A(j, k);
    }
#undef A
}

static int32_t round_up(int32_t rows) { return (rows + GPROJI_BLOCK - 1) / GPROJI_BLOCK * GPROJI_BLOCK; }

/* Storage row of row i of a panel with w pivots. */
static int32_t storage(int32_t w, int32_t i) { return i + gproji_panel_shift(w); }

static gproji_panel panel_of(int32_t rows, int32_t w, double *values, int32_t stride, double *inverse, double *update) {
    gproji_panel panel;
    memset(&panel, 0, sizeof panel);
    panel.rows = rows, panel.w = w, panel.shift = gproji_panel_shift(w), panel.stride = stride;
    panel.values = values, panel.inverse = inverse, panel.update = update;
    return panel;
}

/* Factors a panel with w pivots and u rows below, forms the update matrix, solves with it: all against the loops. */
static void check_panel(int32_t w, int32_t u, uint64_t *seed) {
    int32_t n = w + u, rows = storage(w, w) + round_up(u), i, j;
    int32_t stride = gproji_stride(rows);
    size_t panel_size = (size_t)stride * (size_t)w, update_size = (size_t)gproji_update_entries(round_up(u)) + 1;
    double *a = (double *)malloc((size_t)n * (size_t)n * sizeof(double));
    double *panel = (double *)calloc(panel_size, sizeof(double)),
           *inverse = (double *)malloc((size_t)w * sizeof(double));
    double *update = (double *)malloc(update_size * sizeof(double));
    double *z = (double *)calloc((size_t)stride, sizeof(double)), *b = (double *)malloc((size_t)n * sizeof(double));
    double error = 0, bound = 1e-11;
    gproji_panel job;
    fill_spd(n, a, seed);
    for (j = 0; j < w; ++j)
        for (i = j; i < n; ++i) panel[at(storage(w, i), j, stride)] = a[at(i, j, n)];
    for (i = 0; i < (int32_t)update_size; ++i) update[i] = 0.25; /* what is there before the product */
    naive_partial(n, w, a);
    job = panel_of(rows, w, panel, stride, inverse, update);
    GPROJT_CHECK(gproji_panel_factor(NULL, &job) == -1);
    for (j = 0; j < w; ++j) {
        for (i = j; i < n; ++i) error = fmax(error, fabs(panel[at(storage(w, i), j, stride)] - a[at(i, j, n)]));
        for (i = storage(w, n); i < rows; ++i) error = fmax(error, fabs(panel[at(i, j, stride)]));
    }
    if (u > 0) {
        update[update_size - 1] = 7.0; /* one beyond the end */
        gproji_panel_update(NULL, &job);
        for (j = 0; j < u; ++j)
            for (i = j; i < u; ++i) {
                double sum = 0.25;
                int32_t k;
                for (k = 0; k < w; ++k) sum -= a[at(w + i, k, n)] * a[at(w + j, k, n)];
                error = fmax(error, fabs(sum - update[gproji_update_offset(round_up(u), j) + i]));
            }
    }
    GPROJT_CHECK(u == 0 || update[update_size - 1] == 7.0);
    /* forward: [L1; L2] y = b on the pivots, b2 - L2 y below */
    for (i = 0; i < n; ++i) b[i] = 2.0 * gprojt_uniform(seed) - 1.0;
    for (i = 0; i < w; ++i) z[storage(w, i)] = b[i];
    gproji_panel_forward(rows, w, panel, stride, z);
    for (j = 0; j < w; ++j) {
        b[j] /= a[at(j, j, n)];
        for (i = j + 1; i < w; ++i) b[i] -= a[at(i, j, n)] * b[j];
        error = fmax(error, fabs(b[j] - z[storage(w, j)]));
    }
    for (i = w; i < n; ++i) {
        double sum = 0;
        for (j = 0; j < w; ++j) sum -= a[at(i, j, n)] * b[j];
        error = fmax(error, fabs(sum - z[storage(w, i)]));
    }
    /* backward: L1' x = y - L2' x2 */
    for (i = w; i < n; ++i) z[storage(w, i)] = b[i];
    gproji_panel_backward(rows, w, panel, stride, z);
    for (j = w - 1; j >= 0; --j) {
        for (i = j + 1; i < n; ++i) b[j] -= a[at(i, j, n)] * b[i];
        b[j] /= a[at(j, j, n)];
        error = fmax(error, fabs(b[j] - z[storage(w, j)]));
    }
    if (!(error <= bound)) printf("  w = %d, u = %d: error %g\n", (int)w, (int)u, error);
    GPROJT_CHECK(error <= bound);
    free(a), free(panel), free(inverse), free(update), free(z), free(b);
}

GPROJT_TEST(dense_panels) {
    static const int32_t wide[] = {63, 64, 65, 127, 128, 129, 136, 191, 193, 257, 300};
    uint64_t seed = 1;
    int32_t w, u;
    for (w = 1; w <= 34; ++w)
        for (u = 0; u <= 50; u += w % 3 == 0 ? 1 : 3) check_panel(w, u, &seed);
    for (w = 0; w < (int32_t)(sizeof wide / sizeof wide[0]); ++w)
        for (u = 0; u <= 70; u += 35) check_panel(wide[w], u, &seed);
    check_panel(20, 530, &seed); /* more rows than GPROJI_ROW_BLOCK */
}

/* Every column may be the one that fails; NaN and infinity fail too. */
GPROJT_TEST(dense_failing_pivots) {
    const double bad[] = {-1.0, 0.0, NAN, INFINITY};
    enum {
        W = 140,
        STRIDE = 200
    };
    double *panel = (double *)malloc(sizeof(double) * W * STRIDE), inverse[W];
    int32_t w = W, column, i, kind;
    for (column = 0; column < w; column += 7)
        for (kind = 0; kind < 4; ++kind) {
            int32_t shift = gproji_panel_shift(w);
            gproji_panel job;
            memset(panel, 0, sizeof(double) * W * STRIDE);
            for (i = 0; i < w; ++i) panel[at(i + shift, i, STRIDE)] = i == column ? bad[kind] : 4.0;
            job = panel_of(w + shift, w, panel, STRIDE, inverse, NULL);
            GPROJT_CHECK(gproji_panel_factor(NULL, &job) == column);
        }
    free(panel);
}

/* One tile: C = [C] - A B', and C = (C - A B') L^-T, for every height and depth. */
GPROJT_TEST(dense_tiles) {
    enum {
        MOST = GPROJI_TILE_BLOCKS * GPROJI_BLOCK,
        DEEP = 20,
        B = GPROJI_BLOCK
    };
    static double a[MOST * DEEP], b[B * DEEP], c[MOST * B], was[MOST * B], triangle[MOST * B];
    double inverse[B];
    int32_t blocks, k, i, j, t, mode;
    uint64_t seed = 2;
    for (blocks = 1; blocks <= GPROJI_TILE_BLOCKS; ++blocks)
        for (k = 0; k <= DEEP; ++k)
            for (mode = 0; mode < 2; ++mode) {
                int32_t rows = blocks * B;
                double error = 0;
                for (i = 0; i < MOST * DEEP; ++i) a[i] = gprojt_uniform(&seed);
                for (i = 0; i < B * DEEP; ++i) b[i] = gprojt_uniform(&seed);
                for (i = 0; i < MOST * B; ++i)
                    c[i] = was[i] = gprojt_uniform(&seed), triangle[i] = gprojt_uniform(&seed);
                for (j = 0; j < B; ++j) triangle[j + j * MOST] += 1.0, inverse[j] = 1.0 / triangle[j + j * MOST];
                if (mode == 0)
                    gproji_tile_update(blocks, k, a, MOST, b, B, c, MOST);
                else
                    gproji_tile_solve(blocks, k, a, MOST, b, B, c, MOST, triangle, inverse);
                for (i = 0; i < MOST; ++i)
                    for (j = 0; j < B; ++j) {
                        double sum = was[i + j * MOST];
                        if (i >= rows) { /* no row of the tile: nothing is written there */
                            GPROJT_CHECK(c[i + j * MOST] == was[i + j * MOST]);
                            continue;
                        }
                        for (t = 0; t < k; ++t) sum -= a[i + t * MOST] * b[j + t * B];
                        if (mode == 1) {
                            for (t = 0; t < j; ++t) sum -= was[i + t * MOST] * triangle[j + t * MOST];
                            sum *= inverse[j];
                        }
                        was[i + j * MOST] = sum;
                        error = fmax(error, fabs(sum - c[i + j * MOST]));
                    }
                GPROJT_CHECK(error < 1e-11);
            }
}

GPROJT_TEST(dense_strides) {
    int32_t rows;
    for (rows = 1; rows < 3000; ++rows) {
        int32_t stride = gproji_stride(rows);
        GPROJT_CHECK(stride >= rows && stride % GPROJI_BLOCK == 0 && stride % 64 != 0);
        GPROJT_CHECK((rows + gproji_panel_shift(rows)) % GPROJI_BLOCK == 0);
    }
}

int main(void) {
    GPROJT_RUN(dense_tiles);
    GPROJT_RUN(dense_panels);
    GPROJT_RUN(dense_failing_pivots);
    GPROJT_RUN(dense_strides);
    return gprojt_report();
}
