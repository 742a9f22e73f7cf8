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

/* Storage row of row i of a panel with w pivots. */
static int32_t storage(int32_t w, int32_t i) { return i + gproji_panel_shift(w); }

/* The place of row i, or of storage row r, and column j in a panel. */
static int64_t place_of_row(gproji_shape shape, int32_t r, int32_t j) {
    return gproji_shape_offset(shape, j + shape.shift) + r;
}
static int64_t place_of(gproji_shape shape, int32_t i, int32_t j) { return place_of_row(shape, i + shape.shift, j); }
/* Entries of a panel. */
static int64_t entries(gproji_shape shape) {
    return gproji_shape_offset(shape, shape.end) + gproji_shape_first(shape, shape.end);
}

/* b becomes y, [L1; L2] y = b on the pivots. Returns the largest difference of z to it and, below, to - L2 y. */
static double forward_error(int32_t n, int32_t w, const double *a, double *b, const double *z) {
    double error = 0;
    int32_t i, j;
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
    return error;
}

/* Factors a panel with w pivots and u rows below, forms the update matrix, solves with it: all against the loops. */
static void check_panel_with(const gproji_kernels *kernels, int32_t w, int32_t u, uint64_t *seed) {
    int32_t n = w + u, update_rows = gproji_round_up(u, GPROJI_BLOCK), rows = storage(w, w) + update_rows, i, j;
    gproji_shape shape = gproji_shape_of(w, u);
    size_t panel_size = (size_t)entries(shape);
    size_t update_size = (size_t)gproji_update_entries(update_rows) + 1;
    double *a = (double *)malloc((size_t)n * (size_t)n * sizeof(double));
    double *panel = (double *)calloc(panel_size, sizeof(double)),
           *inverse = (double *)malloc((size_t)w * sizeof(double));
    double *update = (double *)malloc(update_size * sizeof(double));
    double *z = (double *)calloc((size_t)shape.stride, sizeof(double)),
           *y = (double *)calloc((size_t)shape.stride, sizeof(double));
    double *b = (double *)malloc((size_t)n * sizeof(double)), *x = (double *)malloc((size_t)w * sizeof(double));
    double error = 0, bound = 1e-11;
    gproji_panel job;
    fill_spd(n, a, seed);
    for (j = 0; j < w; ++j)
        for (i = j; i < n; ++i) panel[place_of(shape, i, j)] = a[at(i, j, n)];
    naive_partial(n, w, a);
    job = gproji_make_panel(kernels, w, u, panel, inverse, update);
    job.fresh = u % 3 == 1;
    for (i = 0; i < (int32_t)update_size; ++i) update[i] = job.fresh ? NAN : i % 16;
    GPROJT_CHECK(gproji_panel_factor(NULL, &job) == -1);
    for (j = 0; j < w; ++j) {
        for (i = j; i < n; ++i) error = fmax(error, fabs(panel[place_of(shape, i, j)] - a[at(i, j, n)]));
        for (i = storage(w, n); i < rows; ++i) error = fmax(error, fabs(panel[place_of_row(shape, i, j)]));
    }
    if (u > 0) {
        update[update_size - 1] = 7.0; /* one beyond the end */
        gproji_panel_update(NULL, &job);
        for (j = 0; j < u; ++j)
            for (i = j; i < u; ++i) {
                ptrdiff_t place = gproji_update_offset(update_rows, j) + i;
                double sum = job.fresh ? 0 : (double)(place % 16);
                int32_t k;
                for (k = 0; k < w; ++k) sum -= a[at(w + i, k, n)] * a[at(w + j, k, n)];
                error = fmax(error, fabs(sum - update[place]));
            }
    }
    GPROJT_CHECK(u == 0 || update[update_size - 1] == 7.0);
    /* forward: two right-hand sides at once, then one */
    for (i = 0; i < n; ++i) b[i] = 2.0 * gprojt_uniform(seed) - 1.0;
    for (i = 0; i < w; ++i) z[storage(w, i)] = b[w - 1 - i], y[storage(w, i)] = b[i];
    gproji_panel_forward(&job, z, y);
    for (i = 0; i < w; ++i) x[i] = b[w - 1 - i];
    error = fmax(error, forward_error(n, w, a, x, z));
    memset(z, 0, (size_t)shape.stride * sizeof *z);
    for (i = 0; i < w; ++i) x[i] = z[storage(w, i)] = b[i];
    gproji_panel_forward(&job, z, NULL);
    error = fmax(error, forward_error(n, w, a, x, z));
    error = fmax(error, forward_error(n, w, a, b, y));
    /* backward: L1' x = y - L2' x2 */
    for (i = w; i < n; ++i) z[storage(w, i)] = b[i];
    gproji_panel_backward(&job, u % 2 == 0, z);
    for (j = w - 1; j >= 0; --j) {
        for (i = j + 1; i < n; ++i) b[j] -= a[at(i, j, n)] * b[i];
        b[j] /= a[at(j, j, n)];
        error = fmax(error, fabs(b[j] - z[storage(w, j)]));
    }
    if (!(error <= bound)) printf("  %s, w = %d, u = %d: error %g\n", kernels->name, (int)w, (int)u, error);
    GPROJT_CHECK(error <= bound);
    free(a), free(panel), free(inverse), free(update), free(z), free(y), free(b), free(x);
}

/* The kernels of this processor, one kind after the other. */
#define FOR_ALL_KERNELS for (kind = 0; (kernels = gproji_kernels_of(kind)) != NULL; ++kind)

static void check_panel(int32_t w, int32_t u, uint64_t *seed) {
    const gproji_kernels *kernels;
    int32_t kind;
    FOR_ALL_KERNELS check_panel_with(kernels, w, u, seed);
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
        W = 140
    };
    const gproji_shape shape = gproji_shape_of(W, 0);
    const size_t size = (size_t)entries(shape) * sizeof(double);
    double *panel = (double *)malloc(size), inverse[W];
    const gproji_kernels *kernels;
    int32_t column, i, kind, b;
    FOR_ALL_KERNELS for (column = 0; column < W; column += 7) for (b = 0; b < 4; ++b) {
        gproji_panel job = gproji_make_panel(kernels, W, 0, panel, inverse, NULL);
        memset(panel, 0, size);
        for (i = 0; i < W; ++i) panel[place_of(shape, i, i)] = i == column ? bad[b] : 4.0;
        GPROJT_CHECK(gproji_panel_factor(NULL, &job) == column);
    }
    free(panel);
}

/* Where column t begins, with a stride that falls after `left` columns and then after each block. */
static size_t begin_of(int32_t t, int32_t stride, int32_t left) {
    size_t place = 0;
    for (; t > 0; --t, --left) {
        if (left == 1) left += GPROJI_BLOCK, stride -= GPROJI_BLOCK;
        place += (size_t)stride;
    }
    return place;
}

/* C -= A B', C = - A B', and X = (C - A B') L^-T, for tiles of every height and depth, and with every number of missing
   columns. */
static void check_tiles(const gproji_kernels *kernels, uint64_t *seed) {
    enum {
        MOST = 64,
        DEEP = 20,
        WIDE = 8,
        STRIDE = MOST + 4 * WIDE
    };
    static double a[STRIDE * DEEP], b[STRIDE * DEEP], c[MOST * WIDE], was[MOST * WIDE], triangle[MOST * WIDE];
    const int32_t B = kernels->block;
    double inverse[WIDE];
    int32_t blocks, k, i, j, t, skip; /* skip < 0: an update */
    for (blocks = 1; blocks <= MOST / B; ++blocks)
        for (k = 0; k <= DEEP; ++k)
            for (skip = -1; skip < (k == 0 ? B : 1); ++skip) {
                int32_t rows = blocks * B, columns = B - gproji_max(skip, 0), first = B - columns;
                int32_t left = k % 3 ? 1 + (k + blocks) % GPROJI_BLOCK : INT32_MAX;
                bool fresh = skip < 0 && (k + blocks) % 2;
                double error = 0;
                for (i = 0; i < STRIDE * DEEP; ++i) a[i] = gprojt_uniform(seed), b[i] = gprojt_uniform(seed);
                for (i = 0; i < MOST * WIDE; ++i)
                    c[i] = was[i] = gprojt_uniform(seed), triangle[i] = gprojt_uniform(seed);
                for (j = 0; j < columns; ++j) triangle[at(first + j, j, MOST)] += 1.0;
                for (j = 0; j < columns; ++j) inverse[j] = 1.0 / triangle[at(first + j, j, MOST)];
                for (i = 0; fresh && i < rows; ++i)
                    for (j = 0; j < B; ++j) was[at(i, j, MOST)] = 0, c[at(i, j, MOST)] = NAN; /* not read */
                if (skip < 0)
                    kernels->update(rows, k, a, b, STRIDE, left, c, MOST, fresh);
                else
                    kernels->solve(rows, k, a, b, STRIDE, left, c, MOST, triangle, inverse, skip);
                for (i = 0; i < MOST; ++i)
                    for (j = 0; j < WIDE; ++j) {
                        double sum = was[at(i, j, MOST)];
                        if (i >= rows || j >= columns) { /* not in the tile: nothing is written there */
                            GPROJT_CHECK(c[at(i, j, MOST)] == sum);
                            continue;
                        }
                        for (t = 0; t < k; ++t) {
                            size_t column = begin_of(t, STRIDE, left);
                            sum -= a[column + (size_t)i] * b[column + (size_t)j];
                        }
                        if (skip >= 0) {
                            for (t = 0; t < j; ++t) sum -= was[at(i, t, MOST)] * triangle[at(first + j, t, MOST)];
                            sum *= inverse[j];
                        }
                        was[at(i, j, MOST)] = sum;
                        error = fmax(error, fabs(sum - c[at(i, j, MOST)]));
                    }
                GPROJT_CHECK(error < 1e-11);
            }
}

static bool has_kernels(const char *name) {
    const gproji_kernels *kernels;
    int32_t kind;
    FOR_ALL_KERNELS if (!strcmp(kernels->name, name)) return true;
    return false;
}

/* Vector units that the compiler's own question finds are used, and no others. */
GPROJT_TEST(dense_units_of_this_processor) {
#if GPROJI_CHOICE && defined(__GNUC__)
    GPROJT_CHECK(has_kernels("AVX-512") == (__builtin_cpu_supports("avx512f") != 0));
#ifdef GPROJI_KIND_AVX2
    GPROJT_CHECK(has_kernels("AVX2") == (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")));
#endif
#endif
}

GPROJT_TEST(dense_tiles) {
    const gproji_kernels *kernels;
    uint64_t seed = 2;
    int32_t kind;
    FOR_ALL_KERNELS {
        printf("  kernels: %s\n", kernels->name);
        check_tiles(kernels, &seed);
    }
    GPROJT_CHECK(kind > 0);
}

/* Row i, column j <= i of what a panel and its update matrix hold together. */
static double *entry_of(const gproji_panel *panel, double *values, int32_t i, int32_t j) {
    int32_t w = panel->w;
    if (j < w) return values + place_of(panel->shape, i, j);
    return panel->update + gproji_update_offset(panel->update_rows, j - w) + (i - w);
}

/* Adds a child's update matrix with `below` rows, that go to ascending random rows of a parent in groups of up to `most`
   rows, which stay together; and nothing else is touched. */
static void check_add(const gproji_kernels *kernels, int32_t w, int32_t u, int32_t below, int32_t most,
                      uint64_t *seed) {
    gproji_shape shape = gproji_shape_of(w, u);
    int32_t n = w + u, rows = gproji_round_up(below, GPROJI_BLOCK);
    int32_t child_w = 5, groups = 0, i, j, left = n - below, next = 0;
    size_t panel_size = (size_t)entries(shape),
           update_size = (size_t)gproji_update_entries(gproji_round_up(u, GPROJI_BLOCK));
    double *values = (double *)calloc(panel_size + 1, sizeof(double));
    double *update = (double *)calloc(update_size + 1, sizeof(double)), kept = 0;
    double *child = (double *)malloc(((size_t)gproji_update_entries(rows) + 1) * sizeof(double));
    int32_t *group = (int32_t *)malloc(sizeof(int32_t) * (size_t)(2 * below + 2)), *to = group + below + 1;
    int32_t *row_to = (int32_t *)malloc(sizeof(int32_t) * (size_t)(below + 1));
    gproji_piece *piece = (gproji_piece *)malloc(sizeof(gproji_piece) * (size_t)(2 * below + below / GPROJI_BLOCK + 2));
    gproji_panel panel = gproji_make_panel(kernels, w, u, values, NULL, update);
    int32_t pieces;
    for (i = 0; i < below; i = next) {
        int32_t gap = gproji_min(left, (int32_t)(gprojt_uniform(seed) * 4)), k;
        int32_t before = n - left - (below - i) + gap; /* the parent's row */
        left -= gap;
        next = gproji_min(below, i + 1 + (int32_t)(gprojt_uniform(seed) * most));
        if (before < w) next = gproji_min(next, i + w - before); /* a group is a pivot's or not */
        group[groups] = storage(child_w, child_w) + i, to[groups++] = storage(w, before);
        for (k = i; k < next; ++k) row_to[k] = before + k - i;
    }
    for (i = 0; i < (int32_t)gproji_update_entries(rows); ++i) child[i] = 1.0 + gprojt_uniform(seed);
    pieces = gproji_find_pieces(kernels, groups, group, storage(child_w, child_w), below, to, storage(w, w), piece);
    GPROJT_CHECK(pieces <= 2 * groups + below / GPROJI_BLOCK + 2);
    for (i = 0; i < storage(w, w); i += GPROJI_BLOCK)
        gproji_add_columns(&panel, piece, pieces, child, rows, i, i + GPROJI_BLOCK);
    for (i = 0; i < u; i += GPROJI_STRIP)
        gproji_add_columns(&panel, piece, pieces, child, rows, storage(w, w) + i,
                           gproji_min(storage(w, w) + i + GPROJI_STRIP, storage(w, n)));
    for (j = 0; j < below; ++j)
        for (i = j; i < below; ++i) {
            double *entry = entry_of(&panel, values, row_to[i], row_to[j]);
            GPROJT_CHECK(*entry == child[gproji_update_offset(rows, j) + i]);
            *entry = 0;
        }
    for (j = 0; j < n; ++j)
        for (i = j; i < n; ++i) kept += fabs(*entry_of(&panel, values, i, j));
    GPROJT_CHECK(kept == 0);
    free(values), free(update), free(child), free(group), free(row_to), free(piece);
}

GPROJT_TEST(dense_add) {
    const gproji_kernels *kernels;
    uint64_t seed = 3;
    int32_t kind, below, most;
    FOR_ALL_KERNELS for (most = 1; most < 30; most += 1 + most / 2) for (below = 1; below < 150;
                                                                         below += 1 + below / 4) {
        check_add(kernels, 1 + below % 29, below + 3 * most, below, most, &seed);
        check_add(kernels, 60, below, below, most, &seed);
        check_add(kernels, 60, 3 * below, 3 * below, 100, &seed); /* long runs of pieces without gaps */
    }
}

/* Pieces without gaps tell how many follow, as far as their number has two bytes. */
GPROJT_TEST(dense_runs_of_pieces) {
    enum {
        BELOW = 600000
    };
    const gproji_kernels *kernels;
    int32_t at = 0, to = 0, kind, k;
    FOR_ALL_KERNELS {
        size_t most = (size_t)2 * 1 + BELOW / GPROJI_BLOCK + 2;
        gproji_piece *piece = (gproji_piece *)malloc(most * sizeof *piece);
        int32_t count = gproji_find_pieces(kernels, 1, &at, 0, BELOW, &to, BELOW, piece), rows = 0;
        for (k = 0; k < count; ++k) {
            GPROJT_CHECK(piece[k].from == rows && piece[k].to == rows);
            GPROJT_CHECK(!kernels->spreads || (piece[k].run > 0 && k + piece[k].run <= count));
            rows += piece[k].rows;
        }
        GPROJT_CHECK(rows == BELOW && (size_t)count <= most);
        free(piece);
    }
}

/* A group that begins where the one before has ended, in the child and in the parent, goes on in its piece. */
GPROJT_TEST(dense_groups_without_gaps_are_one) {
    const gproji_kernels *kernels;
    int32_t at[100], to[100], kind, k;
    for (k = 0; k < 100; ++k) at[k] = k, to[k] = 11 + k;
    FOR_ALL_KERNELS {
        gproji_piece one[40], many[300];
        int32_t count = gproji_find_pieces(kernels, 1, at, 0, 100, to, 48, one);
        GPROJT_REQUIRE(gproji_find_pieces(kernels, 100, at, 0, 100, to, 48, many) == count);
        for (k = 0; k < count; ++k)
            GPROJT_CHECK(one[k].from == many[k].from && one[k].to == many[k].to && one[k].rows == many[k].rows &&
                         one[k].mask == many[k].mask && one[k].run == many[k].run);
    }
}

/* The columns of a panel follow each other, each from the first row of its block on; together eliminated ones have the
   stride that kernels are told. */
GPROJT_TEST(dense_columns_of_panels) {
    int32_t w, below, j, next, first_of = 0, chunk = 0, left = 0;
    for (w = 1; w < 900; w += 1 + w / 40)
        for (below = 0; below < 90; below += 13) {
            gproji_shape shape = gproji_shape_of(w, below);
            gproji_panel panel = gproji_make_panel(gproji_kernels_of(0), w, below, NULL, NULL, NULL);
            int64_t end = 0;
            for (j = 0, next = 0; j < w; ++j) {
                int32_t at = storage(w, j), stride = gproji_shape_stride(shape, at), first = shape.stride - stride;
                GPROJT_CHECK(first >= 0 && first <= at && stride % GPROJI_BLOCK == 0 && at >= storage(w, 0));
                GPROJT_CHECK(place_of_row(shape, first, j) == end);
                end += stride;
                if (j == next) /* a chunk */
                    chunk = gproji_shape_stride(shape, at), left = gproji_shape_left(shape, at), first_of = j,
                    next = gproji_next_chunk(&panel, j);
                GPROJT_CHECK(place_of_row(shape, shape.stride, j) == place_of_row(shape, shape.stride, first_of) +
                                                                         (int64_t)begin_of(j - first_of, chunk, left));
            }
            GPROJT_CHECK(entries(shape) == end && shape.stride >= storage(w, w) + below);
            GPROJT_CHECK((w + shape.shift) % GPROJI_BLOCK == 0 && (shape.last < 0 || shape.stride % 64 != 0));
        }
}

/* -- 3 x 3 -- */

/* (a + shift trace(a) I) x = b for sums of squares, and no answer for matrices that are not positive definite: also for
   sums of too few squares, here of integers, so that nothing is rounded. */
GPROJT_TEST(symmetric_3x3) {
    static const double indefinite[7][6] = {{0, 0, 0, 0, 0, 0},  {1, 2, 0, 1, 0, 1}, {1, 0, 0, 1, 2, 1},
                                            {-1, 0, 0, 1, 0, 1}, {1, 2, 0, 4, 0, 1}, {1, 0, 0, 1, 0, 0},
                                            {1, 1, 1, 2, 3, 5}};
    double e[3], b[3], x[3], shift;
    uint64_t seed = 6;
    int32_t round, i, k;
    for (round = 0; round < 50; ++round) {
        double a[6] = {0}, trace;
        for (k = 0; k < 4; ++k) {
            for (i = 0; i < 3; ++i) e[i] = 2 * gprojt_uniform(&seed) - 1;
            gproji_add_square3(e, a);
        }
        for (i = 0; i < 3; ++i) b[i] = 2 * gprojt_uniform(&seed) - 1;
        shift = round % 2 * gprojt_uniform(&seed);
        trace = shift * (a[0] + a[3] + a[5]);
        GPROJT_REQUIRE(gproji_solve_square3(a, shift, b, x));
        GPROJT_NEAR((a[0] + trace) * x[0] + a[1] * x[1] + a[2] * x[2], b[0], 1e-9);
        GPROJT_NEAR(a[1] * x[0] + (a[3] + trace) * x[1] + a[4] * x[2], b[1], 1e-9);
        GPROJT_NEAR(a[2] * x[0] + a[4] * x[1] + (a[5] + trace) * x[2], b[2], 1e-9);
    }
    for (k = 0; k < 7; ++k) GPROJT_CHECK(!gproji_solve_square3(indefinite[k], 0, b, x));
}

int main(void) {
    GPROJT_RUN(symmetric_3x3);
    GPROJT_RUN(dense_units_of_this_processor);
    GPROJT_RUN(dense_tiles);
    GPROJT_RUN(dense_panels);
    GPROJT_RUN(dense_failing_pivots);
    GPROJT_RUN(dense_add);
    GPROJT_RUN(dense_runs_of_pieces);
    GPROJT_RUN(dense_groups_without_gaps_are_one);
    GPROJT_RUN(dense_columns_of_panels);
    return gprojt_report();
}
