/* test_cholesky.c - >>ordering, >>symbolic, >>cholesky: against dense matrices, naive elimination, SuiteSparse's AMD.

   Build with -DGPROJT_HAVE_AMD and -lamd to compare the fill with SuiteSparse. */
#define GPROJ_STATIC
#include "gprojt_threads.h"

#if defined(GPROJT_HAVE_AMD) && defined(__has_include)
#if __has_include(<suitesparse/amd.h>)
#include <suitesparse/amd.h>
#define GPROJT_AMD 1
#endif
#endif

/* Less with sanitizers, which are slow, and for each of the kernels. */
enum {
#if defined(GPROJT_SANITIZED) || defined(GPROJT_KERNELS)
    LARGE_SIDE = 158,
    PANELS_STEP = 3
#else
    LARGE_SIDE = 316, /* 100,172 vertices, 600,000 unknowns */
    PANELS_STEP = 1
#endif
};

/* -- matrices -- */

/* One triangle in compressed columns, entries collected in any order. */
typedef struct matrix {
    int32_t n;
    int64_t *start;
    int32_t *row;
    double *value;
    int64_t count, room; /* entries collected so far */
    int32_t *i, *j;
    double *v;
} matrix;

static void matrix_add(matrix *m, int32_t i, int32_t j, double v) {
    if (m->count == m->room) {
        m->room = m->room ? 2 * m->room : 256;
        m->i = (int32_t *)realloc(m->i, (size_t)m->room * sizeof(int32_t));
        m->j = (int32_t *)realloc(m->j, (size_t)m->room * sizeof(int32_t));
        m->v = (double *)realloc(m->v, (size_t)m->room * sizeof(double));
    }
    m->i[m->count] = i, m->j[m->count] = j, m->v[m->count++] = v;
}

/* The collected entries as columns, repetitions and all. */
static void matrix_finish(matrix *m) {
    int64_t p, *next = (int64_t *)calloc((size_t)m->n + 1, sizeof(int64_t));
    int32_t j;
    m->start = (int64_t *)calloc((size_t)m->n + 1, sizeof(int64_t));
    m->row = (int32_t *)malloc(((size_t)m->count + 1) * sizeof(int32_t));
    m->value = (double *)malloc(((size_t)m->count + 1) * sizeof(double));
    for (p = 0; p < m->count; ++p) m->start[m->j[p] + 1]++;
    for (j = 0; j < m->n; ++j) m->start[j + 1] += m->start[j], next[j] = m->start[j];
    for (p = 0; p < m->count; ++p) {
        int64_t to = next[m->j[p]]++;
        m->row[to] = m->i[p], m->value[to] = m->v[p];
    }
    free(next);
}

/* Sums repeated entries and puts all into the lower triangle, so that other programs can read it. */
static void matrix_merge(matrix *m) {
    int64_t p, *seen = (int64_t *)malloc(((size_t)m->n + 1) * sizeof(int64_t)), to = 0, from = 0;
    int32_t j;
    for (p = 0; p < m->count; ++p)
        if (m->i[p] < m->j[p]) {
            int32_t t = m->i[p];
            m->i[p] = m->j[p], m->j[p] = t;
        }
    free(m->start), free(m->row), free(m->value);
    matrix_finish(m);
    for (j = 0; j < m->n; ++j) seen[j] = -1;
    for (j = 0; j < m->n; ++j) {
        int64_t begin = to, end = m->start[j + 1];
        for (p = from; p < end; ++p) {
            int32_t i = m->row[p];
            if (seen[i] >= begin) {
                m->value[seen[i]] += m->value[p];
            } else {
                seen[i] = to;
                m->row[to] = i, m->value[to++] = m->value[p];
            }
        }
        from = end;
        m->start[j] = begin;
        m->start[j + 1] = end;
    }
    m->start[m->n] = to;
    free(seen);
}

static matrix matrix_empty(int32_t n) {
    matrix m;
    memset(&m, 0, sizeof m);
    m.n = n;
    return m;
}

static void matrix_free(matrix *m) {
    free(m->start), free(m->row), free(m->value), free(m->i), free(m->j), free(m->v);
    memset(m, 0, sizeof *m);
}

/* What several steps of a mesh matrix share: the outer product of a row's gradient, lower triangle. */
static void add_outer(matrix *m, int32_t count, const int32_t *variable, const double *g) {
    int32_t a, b;
    for (a = 0; a < count; ++a)
        for (b = 0; b <= a; ++b) {
            bool lower = variable[a] >= variable[b];
            matrix_add(m, lower ? variable[a] : variable[b], lower ? variable[b] : variable[a], g[a] * g[b]);
        }
}

/* Meshes as lists of faces on a grid of nx x ny vertices, closed ones on a torus. */
enum {
    QUADS,
    TRIANGLES,
    HEXAGONS,
    TORUS,
    TORUS_TRIANGLES,
    MESH_KINDS
};

/* Corners of the face at (x, y); 0 where there is none. */
static int32_t mesh_face(int32_t kind, int32_t nx, int32_t ny, int32_t x, int32_t y, int32_t part, int32_t corner[6]) {
    bool wraps = kind == TORUS || kind == TORUS_TRIANGLES;
    int32_t x1 = wraps ? (x + 1) % nx : x + 1, y1 = wraps ? (y + 1) % ny : y + 1;
    if (x1 >= nx || y1 >= ny) return 0;
    if (kind == HEXAGONS) { /* bricks of 3 x 2 vertices, every other row shifted */
        int32_t k;
        if (part > 0 || (x + y) % 2 != 0 || x + 2 >= nx) return 0;
        for (k = 0; k < 3; ++k) corner[k] = y * nx + x + k, corner[3 + k] = y1 * nx + x + 2 - k;
        return 6;
    }
    corner[0] = y * nx + x, corner[1] = y * nx + x1, corner[2] = y1 * nx + x1, corner[3] = y1 * nx + x;
    if (kind == QUADS || kind == TORUS) return part > 0 ? 0 : 4;
    if (part > 1) return 0;
    if (part == 1) corner[1] = corner[2], corner[2] = corner[3];
    return 3;
}

/* Graph Laplacian plus identity; squared: of the second differences. */
static matrix laplacian(int32_t kind, int32_t nx, int32_t ny) {
    matrix m = matrix_empty(nx * ny);
    int32_t x, y, part, e, corner[6];
    for (e = 0; e < m.n; ++e) matrix_add(&m, e, e, 1.0);
    for (y = 0; y < ny; ++y)
        for (x = 0; x < nx; ++x)
            for (part = 0; part < 2; ++part) {
                int32_t degree = mesh_face(kind, nx, ny, x, y, part, corner);
                for (e = 0; e < degree; ++e) {
                    int32_t both[2];
                    double g[2] = {1.0, -1.0};
                    both[0] = corner[e], both[1] = corner[(e + 1) % degree];
                    add_outer(&m, 2, both, g);
                }
            }
    matrix_finish(&m);
    return m;
}

/* The normal matrix of planarity with face normals as variables: n'n = 1 and n'(v_i - v_j) = 0 for every edge. */
static matrix planarity(int32_t kind, int32_t nx, int32_t ny) {
    int32_t vertices = nx * ny, faces = 0, x, y, part, e, d, corner[6];
    matrix m = matrix_empty(0);
    for (y = 0; y < ny; ++y)
        for (x = 0; x < nx; ++x)
            for (part = 0; part < 2; ++part) {
                int32_t degree = mesh_face(kind, nx, ny, x, y, part, corner), variable[9];
                double n[3], g[9], length;
                if (!degree) continue;
                n[0] = 0.3 * sin(0.31 * x), n[1] = 0.3 * cos(0.23 * y), n[2] = 1.0;
                length = sqrt(gprojt_dot3(n, n));
                for (d = 0; d < 3; ++d) {
                    n[d] /= length;
                    variable[d] = 3 * vertices + 3 * faces + d;
                    g[d] = 2.0 * n[d];
                }
                add_outer(&m, 3, variable, g);
                for (e = 0; e < degree; ++e) {
                    int32_t a = corner[e], b = corner[(e + 1) % degree];
                    for (d = 0; d < 3; ++d) {
                        variable[3 + d] = 3 * a + d, variable[6 + d] = 3 * b + d;
                        g[3 + d] = n[d], g[6 + d] = -n[d];
                    }
                    g[0] = a % nx - b % nx, g[1] = a / nx - b / nx, g[2] = 0.1 * sin((double)(a - b));
                    add_outer(&m, 9, variable, g);
                }
                ++faces;
            }
    m.n = 3 * (vertices + faces);
    for (e = 0; e < m.n; ++e) matrix_add(&m, e, e, 1e-2);
    matrix_finish(&m);
    return m;
}

/* A random pattern; mode: entries below, above, or on both sides of the diagonal. Positive definite by its diagonal. */
static matrix random_matrix(int32_t n, double density, int32_t mode, bool repeated, uint64_t *seed) {
    matrix m = matrix_empty(n);
    int32_t i, j;
    for (j = 0; j < n; ++j)
        for (i = j + 1; i < n; ++i) {
            bool below = mode == 0 || (mode == 2 && gprojt_below(seed, 2));
            double v = 2.0 * gprojt_uniform(seed) - 1.0;
            if (gprojt_uniform(seed) >= density) continue;
            matrix_add(&m, below ? i : j, below ? j : i, v);
            if (repeated && gprojt_below(seed, 4) == 0) matrix_add(&m, below ? i : j, below ? j : i, 0.5);
        }
    for (j = 0; j < n; ++j) {
        double sum = 1.0 + gprojt_uniform(seed);
        int64_t p;
        for (p = 0; p < m.count; ++p)
            if (m.i[p] != m.j[p] && (m.i[p] == j || m.j[p] == j)) sum += fabs(m.v[p]);
        matrix_add(&m, j, j, repeated ? sum / 2 : sum);
        if (repeated) matrix_add(&m, j, j, sum / 2);
    }
    matrix_finish(&m);
    return m;
}

static size_t at(int32_t i, int32_t j, int32_t n) { return (size_t)i + (size_t)j * (size_t)n; }

/* P A P' as a full matrix. */
static double *dense_of(const matrix *m, const int32_t *permutation) {
    double *a = (double *)calloc((size_t)m->n * (size_t)m->n + 1, sizeof(double));
    int32_t *place = (int32_t *)malloc(((size_t)m->n + 1) * sizeof(int32_t)), j;
    int64_t p;
    for (j = 0; j < m->n; ++j) place[permutation[j]] = j;
    for (j = 0; j < m->n; ++j)
        for (p = m->start[j]; p < m->start[j + 1]; ++p) {
            int32_t r = place[m->row[p]], c = place[j];
            a[at(r, c, m->n)] += m->value[p];
            if (r != c) a[at(c, r, m->n)] += m->value[p];
        }
    free(place);
    return a;
}

/* A dense Cholesky factorisation of the lower triangle; returns the failing column or -1. */
static int32_t dense_factor(int32_t n, double *a) {
    int32_t i, j, k;
    for (k = 0; k < n; ++k) {
        if (!(a[at(k, k, n)] > 0)) return k;
        a[at(k, k, n)] = sqrt(a[at(k, k, n)]);
        for (i = k + 1; i < n; ++i) a[at(i, k, n)] /= a[at(k, k, n)];
        for (j = k + 1; j < n; ++j)
            for (i = j; i < n; ++i) a[at(i, j, n)] -= a[at(i, k, n)] * a[at(j, k, n)];
    }
    return -1;
}

static void dense_solve(int32_t n, const double *l, double *x) {
    int32_t i, j;
    for (j = 0; j < n; ++j) {
        x[j] /= l[at(j, j, n)];
        for (i = j + 1; i < n; ++i) x[i] -= l[at(i, j, n)] * x[j];
    }
    for (j = n - 1; j >= 0; --j) {
        for (i = j + 1; i < n; ++i) x[j] -= l[at(i, j, n)] * x[i];
        x[j] /= l[at(j, j, n)];
    }
}

/* Entries of L and flops by boolean elimination. */
static int64_t naive_entries(const matrix *m, const int32_t *permutation, double *flops) {
    int32_t n = m->n, i, j, k;
    unsigned char *a = (unsigned char *)calloc((size_t)n * (size_t)n + 1, 1);
    int32_t *place = (int32_t *)malloc(((size_t)n + 1) * sizeof(int32_t));
    int64_t p, entries = 0;
    *flops = 0;
    for (j = 0; j < n; ++j) place[permutation[j]] = j;
    for (j = 0; j < n; ++j)
        for (p = m->start[j]; p < m->start[j + 1]; ++p)
            a[at(place[m->row[p]], place[j], n)] = a[at(place[j], place[m->row[p]], n)] = 1;
    for (k = 0; k < n; ++k) {
        int64_t count = 1;
        for (i = k + 1; i < n; ++i) count += a[at(i, k, n)];
        entries += count;
        *flops += (double)count * (double)count;
        for (j = k + 1; j < n; ++j)
            if (a[at(j, k, n)])
                for (i = k + 1; i < n; ++i) a[at(i, j, n)] |= a[at(i, k, n)];
    }
    free(a), free(place);
    return entries;
}

static bool is_permutation(int32_t n, const int32_t *permutation) {
    unsigned char *seen = (unsigned char *)calloc((size_t)n + 1, 1);
    int32_t k;
    bool good = true;
    for (k = 0; k < n && good; ++k) {
        good = permutation[k] >= 0 && permutation[k] < n && !seen[permutation[k]];
        if (good) seen[permutation[k]] = 1;
    }
    free(seen);
    return good;
}

static gproj_cholesky_options options_of(gproj_ordering ordering) {
    gproj_cholesky_options options;
    memset(&options, 0, sizeof options);
    options.ordering = ordering;
    return options;
}

static void random_permutation(int32_t n, int32_t *order, uint64_t *seed) {
    int32_t k;
    for (k = 0; k < n; ++k) order[k] = k;
    for (k = n - 1; k > 0; --k) {
        int32_t other = gprojt_below(seed, k + 1), t = order[k];
        order[k] = order[other], order[other] = t;
    }
}

/* The largest |A x - b| for random b, after analysis, factorisation and solution; -1 when one of them fails. */
static double solve_error(gproj_cholesky *c, const matrix *m, const gproj_cholesky_options *options) {
    double *b = (double *)malloc(((size_t)m->n + 1) * sizeof(double)),
           *x = (double *)malloc(((size_t)m->n + 1) * sizeof(double));
    double error = -1;
    int32_t i;
    for (i = 0; i < m->n; ++i) b[i] = sin(1.0 + i);
    if (gproj_cholesky_analyse(c, m->n, m->start, m->row, options) == GPROJ_OK &&
        gproj_cholesky_factor(c, m->value) == GPROJ_FACTORED && gproj_cholesky_solve(c, 1, b, x) == GPROJ_OK)
        error = gproj_cholesky_refine(c, m->start, m->row, m->value, b, x, 0);
    free(b), free(x);
    return error;
}

/* -- against dense matrices -- */

/* Analyses and factors with these options and compares everything with a dense factorisation. */
static void check_against_dense(gproj_cholesky *c, const matrix *m, const gproj_cholesky_options *options) {
    enum {
        RIGHT = 6
    };
    int32_t n = m->n, j, r, failed;
    const int32_t *permutation;
    double *l, flops, error = 0, *b = (double *)calloc((size_t)n * RIGHT + 1, sizeof(double));
    double *x = (double *)malloc(((size_t)n * RIGHT + 1) * sizeof(double)),
           *y = (double *)malloc(((size_t)n + 1) * sizeof(double));
    gproj_cholesky_info info;
    GPROJT_CHECK(gproj_cholesky_analyse(c, n, m->start, m->row, options) == GPROJ_OK);
    permutation = gproj_cholesky_permutation(c);
    info = gproj_cholesky_get_info(c);
    GPROJT_CHECK(is_permutation(n, permutation));
    GPROJT_CHECK(info.exact_entries == naive_entries(m, permutation, &flops));
    GPROJT_CHECK(fabs(info.flops - flops) <= 1e-9 * flops);
    GPROJT_CHECK(info.columns == n && info.factor_entries >= info.exact_entries);
    GPROJT_CHECK(info.factor_bytes >= 8 * (size_t)info.factor_entries);
    if (options->disable_relaxation || options->disable_postorder)
        GPROJT_CHECK(info.factor_entries == info.exact_entries);
    if (options->disable_postorder)
        for (j = 0; j < n; ++j) GPROJT_CHECK(permutation[j] == (options->permutation ? options->permutation[j] : j));
    l = dense_of(m, permutation);
    failed = dense_factor(n, l);
    if (failed >= 0) {
        GPROJT_CHECK(gproj_cholesky_factor(c, m->value) == GPROJ_NOT_POSITIVE_DEFINITE);
        GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column == permutation[failed]);
        GPROJT_CHECK(gproj_cholesky_solve(c, 1, b, x) == GPROJ_ERROR_STATE);
    } else {
        GPROJT_CHECK(gproj_cholesky_factor(c, m->value) == GPROJ_FACTORED);
        GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column == -1);
        for (j = 0; j < n * RIGHT; ++j) b[j] = cos(0.7 * j);
        GPROJT_CHECK(gproj_cholesky_solve(c, RIGHT, b, x) == GPROJ_OK);
        GPROJT_CHECK(gproj_cholesky_solve(c, RIGHT, b, b) == GPROJ_OK); /* in place */
        GPROJT_CHECK(memcmp(b, x, (size_t)n * RIGHT * sizeof(double)) == 0);
        for (r = 0; r < RIGHT; ++r) {
            for (j = 0; j < n; ++j) y[j] = cos(0.7 * (permutation[j] + r * n));
            dense_solve(n, l, y);
            for (j = 0; j < n; ++j) error = fmax(error, fabs(y[j] - x[permutation[j] + r * n]));
        }
        GPROJT_CHECK(error < 1e-9);
    }
    free(l), free(b), free(x), free(y);
}

GPROJT_TEST(cholesky_random_patterns) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    uint64_t seed = 7;
    int32_t trial, order[64];
    for (trial = 0; trial < 1000; ++trial) {
        int32_t n = 1 + gprojt_below(&seed, 60), mode = trial % 3;
        double density = trial % 5 == 0 ? 0.5 : 0.02 + 0.15 * gprojt_uniform(&seed);
        matrix m = random_matrix(n, density, mode, trial % 4 == 0, &seed);
        gproj_cholesky_options options = options_of((gproj_ordering)(trial / 3 % 5));
        options.disable_relaxation = trial % 7 == 0;
        options.disable_postorder = trial % 11 == 0;
        random_permutation(n, order, &seed);
        if (options.ordering == GPROJ_ORDERING_GIVEN) options.permutation = order;
        if (options.ordering <= GPROJ_ORDERING_DISSECTION) options.disable_postorder = false;
        check_against_dense(c, &m, &options);
        if (trial % 6 == 1) { /* a column that makes it indefinite */
            int64_t p = (int64_t)(gprojt_random(&seed) % (uint64_t)m.start[n]);
            m.value[p] = m.value[p] > 0 ? -m.value[p] * 3 - 5 : m.value[p] * 9 - 5;
            check_against_dense(c, &m, &options);
        }
        matrix_free(&m);
    }
    gproj_cholesky_destroy(c);
}

/* Two orders of the same matrix give the same solution. */
GPROJT_TEST(cholesky_orders_agree) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    int32_t kind, i;
    for (kind = 0; kind < MESH_KINDS; ++kind) {
        matrix m = planarity(kind, 12, 11);
        double *x[3], *b = (double *)malloc((size_t)m.n * sizeof(double));
        gproj_cholesky_options options[3];
        int32_t k;
        for (i = 0; i < m.n; ++i) b[i] = sin((double)i);
        for (k = 0; k < 3; ++k) {
            options[k] = options_of(k == 0 ? GPROJ_ORDERING_AMD : GPROJ_ORDERING_NATURAL);
            options[k].disable_postorder = k == 2;
            x[k] = (double *)malloc((size_t)m.n * sizeof(double));
            GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, &options[k]) == GPROJ_OK);
            GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTORED);
            GPROJT_CHECK(gproj_cholesky_solve(c, 1, b, x[k]) == GPROJ_OK);
        }
        for (i = 0; i < m.n; ++i) {
            GPROJT_NEAR(x[0][i], x[1][i], 1e-9);
            GPROJT_NEAR(x[0][i], x[2][i], 1e-9);
        }
        free(x[0]), free(x[1]), free(x[2]), free(b);
        matrix_free(&m);
    }
    gproj_cholesky_destroy(c);
}

/* -- shapes -- */

GPROJT_TEST(cholesky_special_shapes) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    gproj_cholesky_options amd = options_of(GPROJ_ORDERING_AMD);
    static const int64_t none[] = {0};
    static const int64_t empty[] = {0, 0, 0, 0}, two[] = {0, 1, 2};
    static const int32_t rows[] = {0, 1, 1};
    static const double ones[] = {1, 1};
    gproj_cholesky_options given = options_of(GPROJ_ORDERING_GIVEN);
    double x[3] = {1, 2, 3};
    int32_t i, shape;
    gproj_cholesky_info info;
    /* n = 0 */
    GPROJT_CHECK(gproj_cholesky_analyse(c, 0, NULL, NULL, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_factor(c, NULL) == GPROJ_FACTORED);
    GPROJT_CHECK(gproj_cholesky_solve(c, 1, NULL, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 0, none, NULL, &amd) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_refine(c, none, NULL, NULL, NULL, NULL, 2) == HUGE_VAL);
    GPROJT_CHECK(gproj_cholesky_factor(c, NULL) == GPROJ_FACTORED);
    GPROJT_CHECK(gproj_cholesky_refine(c, none, NULL, NULL, NULL, NULL, 2) == 0);
    /* what is no number is told, also before finite ones */
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, two, rows, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_factor(c, ones) == GPROJ_FACTORED);
    for (i = 0; i < 2; ++i) {
        double b[2] = {1, 1}, y[2] = {1, 1};
        y[i] = sqrt(-1.0);
        GPROJT_CHECK(gproj_cholesky_refine(c, two, rows, ones, b, y, 0) == HUGE_VAL);
    }
    /* a wrong permutation is named */
    given.permutation = rows;
    GPROJT_CHECK(gproj_cholesky_analyse(c, 3, empty, NULL, &given) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(strstr(gproj_cholesky_error(c)->message, "entry 2 is 1, as an earlier one is") != NULL);
    for (i = 0; i < 2; ++i) {
        const int32_t none_such[3] = {2, i ? 3 : -1, 0};
        given.permutation = none_such;
        GPROJT_CHECK(gproj_cholesky_analyse(c, 3, empty, NULL, &given) == GPROJ_ERROR_ARGUMENT);
        GPROJT_CHECK(strstr(gproj_cholesky_error(c)->message,
                            i ? "entry 1 is 3, which is no column" : "entry 1 is -1, which is no column") != NULL);
        GPROJT_CHECK(gproj_cholesky_error(c)->place == GPROJ_PLACE_COLUMN && gproj_cholesky_error(c)->index == 1);
    }
    /* empty columns: zero matrix */
    GPROJT_CHECK(gproj_cholesky_analyse(c, 3, empty, NULL, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_factor(c, NULL) == GPROJ_NOT_POSITIVE_DEFINITE);
    GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column == gproj_cholesky_permutation(c)[0]);
    GPROJT_CHECK(gproj_cholesky_solve(c, 1, x, x) == GPROJ_ERROR_STATE);
    for (shape = 0; shape < 6; ++shape) {
        int32_t n = shape == 0 ? 1 : 400;
        matrix m = matrix_empty(n);
        for (i = 0; i < n; ++i) matrix_add(&m, i, i, 2000.0 + i);
        for (i = 1; i < n; ++i) {
            if (shape == 1) matrix_add(&m, i, 0, 1.0);                    /* arrow whose head comes first */
            if (shape == 2 && i < n - 1) matrix_add(&m, n - 1, i, 1.0);   /* and last */
            if (shape == 3 && i % 20 != 0) matrix_add(&m, i, i - 1, 1.0); /* 20 separate chains */
            if (shape == 4) {                                             /* 5 dense rows and a chain */
                int32_t k;
                for (k = 0; k < 5; ++k)
                    if (i > 80 * k) matrix_add(&m, i, 80 * k, 1.0);
                if ((i - 1) % 80 != 0) matrix_add(&m, i, i - 1, 1.0);
            }
            if (shape == 5) { /* full */
                int32_t k;
                for (k = 0; k < i; ++k) matrix_add(&m, i, k, 1.0);
            }
        }
        matrix_finish(&m);
        GPROJT_CHECK(solve_error(c, &m, NULL) >= 0);
        GPROJT_CHECK(solve_error(c, &m, NULL) < 1e-9);
        info = gproj_cholesky_get_info(c);
        if (shape == 1 || shape == 2) GPROJT_CHECK(info.exact_entries <= 2 * n - 1);
        if (shape == 3) GPROJT_CHECK(info.exact_entries == 2 * n - 20);
        if (shape == 4) GPROJT_CHECK(info.exact_entries < 8 * n);
        if (shape == 5) GPROJT_CHECK(info.supernodes == 1 && info.exact_entries == (int64_t)n * (n + 1) / 2);
        check_against_dense(c, &m, &amd);
        matrix_free(&m);
    }
    gproj_cholesky_destroy(c);
}

/* -- the ordering -- */

#ifdef GPROJT_AMD
/* 20 matrices of meshes. */
static matrix mesh_matrix(int32_t number) {
    int32_t kind = number % MESH_KINDS, size = number / MESH_KINDS;
    if (size == 0) return laplacian(kind, 40, 37);
    if (size == 1) return laplacian(kind, 90, 83);
    if (size == 2) return planarity(kind, 20, 17);
    return planarity(kind, 45, 41);
}
#endif

GPROJT_TEST(ordering_fill_against_suitesparse) {
#ifdef GPROJT_AMD
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    int32_t number, j;
    double worst = 0, product = 1, gain = 1, best;
    for (number = 0; number < 20; ++number) {
        matrix m = mesh_matrix(number);
        gproj_cholesky_options given = options_of(GPROJ_ORDERING_GIVEN), amd = options_of(GPROJ_ORDERING_AMD);
        int32_t *start = (int32_t *)malloc(((size_t)m.n + 1) * sizeof(int32_t)),
                *order = (int32_t *)malloc((size_t)m.n * sizeof(int32_t));
        int64_t ours, theirs;
        double ratio;
        matrix_merge(&m);
        GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, NULL) == GPROJ_OK);
        GPROJT_CHECK(is_permutation(m.n, gproj_cholesky_permutation(c)));
        best = gproj_cholesky_get_info(c).flops;
        GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, &amd) == GPROJ_OK);
        ours = gproj_cholesky_get_info(c).exact_entries;
        gain *= best / gproj_cholesky_get_info(c).flops;
        GPROJT_CHECK(best <= gproj_cholesky_get_info(c).flops);
        for (j = 0; j <= m.n; ++j) start[j] = (int32_t)m.start[j];
        GPROJT_CHECK(amd_order(m.n, start, m.row, order, NULL, NULL) >= 0);
        given.permutation = order;
        GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, &given) == GPROJ_OK);
        theirs = gproj_cholesky_get_info(c).exact_entries;
        ratio = (double)ours / (double)theirs;
        if (ratio > 1.1) printf("  matrix %d, n = %d: %.3f times the fill\n", (int)number, (int)m.n, ratio);
        GPROJT_CHECK(ratio <= 1.1);
        worst = fmax(worst, ratio), product *= ratio;
        free(start), free(order);
        matrix_free(&m);
    }
    printf("  fill / SuiteSparse AMD's: mean %.3f, worst %.3f\n", pow(product, 1.0 / 20), worst);
    printf("  flops / with minimum degree alone: mean %.3f\n", pow(gain, 1.0 / 20));
    gproj_cholesky_destroy(c);
#else
    GPROJT_SKIP("SuiteSparse's AMD is not there (Debian: libsuitesparse-dev)");
#endif
}

/* The nodes of a planarity matrix are found: the three coordinates of a vertex or normal stay together. */
GPROJT_TEST(ordering_keeps_blocks) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    matrix m = planarity(QUADS, 10, 10);
    const int32_t *permutation;
    int32_t k;
    GPROJT_REQUIRE(gproj_cholesky_analyse(c, m.n, m.start, m.row, NULL) == GPROJ_OK);
    permutation = gproj_cholesky_permutation(c);
    for (k = 0; k < m.n; k += 3)
        GPROJT_CHECK(permutation[k] % 3 == 0 && permutation[k + 1] == permutation[k] + 1 &&
                     permutation[k + 2] == permutation[k] + 2);
    gproj_cholesky_destroy(c);
    matrix_free(&m);
}

/* The same input gives the same order. */
GPROJT_TEST(ordering_is_deterministic) {
    gproj_cholesky *a = gproj_cholesky_create(NULL), *b = gproj_cholesky_create(NULL);
    matrix m = planarity(HEXAGONS, 30, 30);
    GPROJT_CHECK(gproj_cholesky_analyse(a, m.n, m.start, m.row, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_analyse(b, m.n, m.start, m.row, NULL) == GPROJ_OK);
    GPROJT_CHECK(memcmp(gproj_cholesky_permutation(a), gproj_cholesky_permutation(b), (size_t)m.n * sizeof(int32_t)) ==
                 0);
    gproj_cholesky_destroy(a), gproj_cholesky_destroy(b);
    matrix_free(&m);
}

/* -- analysis by blocks, the door of the system section -- */

enum {
    NODES = 120
};

typedef struct block_matrix {
    const matrix *matrix;
    const gproj_cholesky *cholesky;
    const int32_t *node_of; /* the node of each variable */
} block_matrix;

/* A gproji_load: the entries whose earlier node is a pivot of the front. */
static void load_blocks(void *user, int32_t front, const gproji_panel *panel, int32_t from, int32_t to) {
    const block_matrix *blocks = (const block_matrix *)user;
    const matrix *m = blocks->matrix;
    const gproji_symbolic *sy = &blocks->cholesky->symbolic;
    int32_t at[8 * NODES], k, j, node[2];
    int64_t p;
    gproji_map_rows(blocks->cholesky, front, blocks->cholesky->permutation, at);
    for (j = 0; j < m->n; ++j)
        for (p = m->start[j]; p < m->start[j + 1]; ++p) {
            int32_t variable[2], row[2];
            variable[0] = m->row[p], variable[1] = j;
            for (k = 0; k < 2; ++k) node[k] = blocks->node_of[variable[k]];
            k = sy->position[node[0]] < sy->position[node[1]] ? 0 : 1;
            if (sy->front_of[sy->position[node[k]]] != front) continue;
            for (k = 0; k < 2; ++k) row[k] = at[variable[k]];
            k = row[0] < row[1] ? 0 : 1;
            if (row[k] < from || row[k] >= to) continue;
            gproji_panel_column(panel, row[k])[row[1 - k]] += m->value[p];
        }
}

GPROJT_TEST(cholesky_blocks) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    uint64_t seed = 11;
    int32_t trial;
    for (trial = 0; trial < 30; ++trial) {
        int32_t size[NODES], first[NODES + 1], node_of[8 * NODES], i, j, a, b, n,
            *adjacent = (int32_t *)malloc(NODES * NODES * sizeof(int32_t));
        int64_t start[NODES + 1], count = 0;
        unsigned char linked[NODES][NODES];
        matrix m;
        block_matrix blocks;
        double *x, *y;
        gproji_graph graph;
        memset(linked, 0, sizeof linked);
        for (i = 0, first[0] = 0; i < NODES; ++i)
            size[i] = 1 + gprojt_below(&seed, 8), first[i + 1] = first[i] + size[i];
        n = first[NODES];
        for (i = 0; i < NODES; ++i)
            for (j = first[i]; j < first[i + 1]; ++j) node_of[j] = i;
        for (i = 0; i < 2 * NODES; ++i) {
            a = gprojt_below(&seed, NODES), b = gprojt_below(&seed, trial % 2 ? NODES : 10) + a - 5;
            b = b < 0 ? 0 : b % NODES;
            if (a != b) linked[a][b] = linked[b][a] = 1;
        }
        for (i = 0; i < NODES; ++i) {
            start[i] = count;
            for (j = 0; j < NODES; ++j)
                if (linked[i][j]) adjacent[count++] = j;
        }
        start[NODES] = count;
        graph.nodes = NODES, graph.start = start, graph.adjacent = adjacent, graph.weight = size;
        GPROJT_CHECK(gproji_cholesky_analyse_blocks(c, &graph, GPROJ_ORDERING_BEST) == GPROJ_OK);
        GPROJT_REQUIRE(gproji_cholesky_take_numeric(c));
        m = matrix_empty(n);
        for (i = 0; i < NODES; ++i)
            for (j = 0; j <= i; ++j)
                for (a = 0; a < size[i] && (i == j || linked[i][j]); ++a)
                    for (b = 0; b < (i == j ? a + 1 : size[j]); ++b)
                        matrix_add(&m, first[i] + a, first[j] + b, i == j && a == b ? 200.0 : gprojt_uniform(&seed));
        matrix_finish(&m);
        blocks.matrix = &m, blocks.cholesky = c, blocks.node_of = node_of;
        y = (double *)malloc((size_t)n * 3 * sizeof(double)), x = (double *)malloc((size_t)n * 3 * sizeof(double));
        for (i = 0; i < 3 * n; ++i) y[i] = sin((double)i);
        GPROJT_CHECK(gproji_cholesky_factor_with(c, load_blocks, &blocks, 2, y) == GPROJ_FACTORED);
        gproji_cholesky_descend(c, x); /* right-hand sides known before the factorisation */
        GPROJT_CHECK(gproj_cholesky_solve(c, 1, y + 2 * n, x + 2 * n) == GPROJ_OK);
        for (i = 0; i < 3; ++i)
            GPROJT_CHECK(gproj_cholesky_refine(c, m.start, m.row, m.value, y + i * n, x + i * n, 0) < 1e-11);
        GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTOR_FAILED); /* there is no pattern in columns */
        free(x), free(y), free(adjacent);
        matrix_free(&m);
    }
    gproj_cholesky_destroy(c);
}

/* -- factorisation -- */

GPROJT_TEST(cholesky_refactor_without_allocation) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    matrix m = planarity(TRIANGLES, 20, 20);
    double *x = (double *)malloc((size_t)m.n * 9 * sizeof(double)),
           *b = (double *)malloc((size_t)m.n * 9 * sizeof(double));
    uint64_t before;
    int32_t round, i;
    for (i = 0; i < 9 * m.n; ++i) b[i] = cos((double)i);
    GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTORED);
    before = gproj_cholesky_memory(c).allocations;
    for (round = 1; round < 4; ++round) {
        for (i = 0; i < m.n; ++i) m.value[m.start[i]] *= 1.0 + 0.0 * round;
        for (i = 0; i < (int32_t)m.start[m.n]; ++i) m.value[i] *= 2.0;
        GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTORED);
        GPROJT_CHECK(gproj_cholesky_solve(c, 9, b, x) == GPROJ_OK);
        GPROJT_CHECK(gproj_cholesky_refine(c, m.start, m.row, m.value, b, x, 1) < 1e-11);
    }
    GPROJT_CHECK(gproj_cholesky_memory(c).allocations == before);
    free(x), free(b);
    matrix_free(&m);
    gproj_cholesky_destroy(c);
}

GPROJT_TEST(cholesky_refine_improves) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    matrix m = laplacian(QUADS, 30, 30);
    double *x = (double *)calloc((size_t)m.n, sizeof(double)), *b = (double *)malloc((size_t)m.n * sizeof(double)),
           first, last;
    int64_t p;
    int32_t i;
    for (i = 0; i < m.n; ++i) b[i] = cos((double)i);
    GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, NULL) == GPROJ_OK);
    for (p = 0; p < m.start[m.n]; ++p) m.value[p] *= 1.001; /* the factor of another matrix close by */
    GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTORED);
    for (p = 0; p < m.start[m.n]; ++p) m.value[p] /= 1.001;
    first = gproj_cholesky_refine(c, m.start, m.row, m.value, b, x, 0);
    GPROJT_CHECK(first > 0.9 && first <= 1.0); /* of x = 0: max |b| */
    last = gproj_cholesky_refine(c, m.start, m.row, m.value, b, x, 1);
    GPROJT_CHECK(last < 2e-3 && last > 1e-9);
    last = gproj_cholesky_refine(c, m.start, m.row, m.value, b, x, 5);
    GPROJT_CHECK(last < 1e-14);
    free(x), free(b);
    matrix_free(&m);
    gproj_cholesky_destroy(c);
}

GPROJT_TEST(cholesky_not_positive_definite) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    matrix m = planarity(QUADS, 40, 40);
    const double bad[] = {-1e9, NAN, INFINITY, -INFINITY};
    double *x = (double *)calloc((size_t)m.n, sizeof(double));
    int32_t k, column;
    int64_t p, diagonal = -1;
    matrix_merge(&m);
    GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, NULL) == GPROJ_OK);
    for (column = 5; column < m.n; column += m.n / 7)
        for (k = 0; k < 4; ++k) {
            double was;
            for (p = m.start[column]; p < m.start[column + 1]; ++p)
                if (m.row[p] == column) diagonal = p;
            was = m.value[diagonal];
            m.value[diagonal] = bad[k];
            GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_NOT_POSITIVE_DEFINITE);
            GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column == column);
            GPROJT_CHECK(gproj_cholesky_error(c)->code == GPROJ_OK);
            GPROJT_CHECK(gproj_cholesky_solve(c, 1, x, x) == GPROJ_ERROR_STATE);
            GPROJT_CHECK(gproj_cholesky_refine(c, m.start, m.row, m.value, x, x, 1) == HUGE_VAL);
            m.value[diagonal] = was;
            GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTORED);
            GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column == -1);
        }
    /* NaN off the diagonal is found too */
    for (p = m.start[7]; m.row[p] == 7; ++p) {
    }
    m.value[p] = NAN;
    GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_NOT_POSITIVE_DEFINITE);
    GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column >= 0);
    GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column == -1); /* nothing is factored yet */
    free(x);
    matrix_free(&m);
    gproj_cholesky_destroy(c);
}

/* A pivot below DBL_MIN, whose inverse may overflow, fails where it stands, not in the next column (0 times infinity). */
GPROJT_TEST(cholesky_names_a_tiny_pivot) {
    static const int64_t start[4] = {0, 2, 4, 5};
    static const int32_t row[5] = {0, 1, 1, 2, 2};
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    gproj_cholesky_options options = {GPROJ_ORDERING_NATURAL, NULL, false, false};
    int32_t k;
    GPROJT_CHECK(gproj_cholesky_analyse(c, 3, start, row, &options) == GPROJ_OK);
    for (k = 0; k < 3; ++k) {
        double values[5] = {1, 0, 1, 0, 1};
        values[2 * k] = 1e-310;
        GPROJT_CHECK(gproj_cholesky_factor(c, values) == GPROJ_NOT_POSITIVE_DEFINITE);
        GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column == k);
        values[2 * k] = 1e-305;
        GPROJT_CHECK(gproj_cholesky_factor(c, values) == GPROJ_FACTORED);
    }
    gproj_cholesky_destroy(c);
}

/* Two grids whose columns alternate, in their order as it stands: tasks go through one grid, then through the other. Of
   failing columns in both the first one is named, whichever grid it is in. */
GPROJT_TEST(cholesky_names_the_first_failing_column) {
    enum {
        SIDE = 70
    };
    matrix m = matrix_empty(2 * SIDE * SIDE);
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    gproj_cholesky_options natural = options_of(GPROJ_ORDERING_NATURAL);
    int32_t v, k;
    for (v = 0; v < m.n; ++v) {
        matrix_add(&m, v, v, 5);
        if (v / 2 % SIDE < SIDE - 1) matrix_add(&m, v + 2, v, -1);
        if (v / 2 / SIDE < SIDE - 1) matrix_add(&m, v + 2 * SIDE, v, -1);
    }
    matrix_finish(&m);
    natural.disable_postorder = true;
    GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, &natural) == GPROJ_OK);
    GPROJT_CHECK(c->symbolic.tasks >= 4);
    GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTORED);
    for (k = 0; k < 2; ++k) {
        int32_t first = 40 + k, second = 61 - k;
        m.value[m.start[first]] = m.value[m.start[second]] = -5;
        GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_NOT_POSITIVE_DEFINITE);
        GPROJT_CHECK(gproj_cholesky_get_info(c).failed_column == first);
        m.value[m.start[first]] = m.value[m.start[second]] = 5;
    }
    matrix_free(&m);
    gproj_cholesky_destroy(c);
}

/* -- threads -- */

/* The solution with a host that runs tasks its way, and with these kernels; the first unknown of a failing matrix in
   *failed. */
static double *solution_with(const gproj_host *host, const gproji_kernels *kernels, const matrix *m, int32_t *failed) {
    gproj_cholesky *c;
    double *x = (double *)malloc((size_t)m->n * sizeof(double)), was, was_half;
    int32_t i;
    c = gproj_cholesky_create(host);
    c->kernels = kernels;
    GPROJT_CHECK(strcmp(gproj_cholesky_get_info(c).kernels, kernels->name) == 0);
    for (i = 0; i < m->n; ++i) x[i] = sin(0.1 * i);
    GPROJT_CHECK(gproj_cholesky_analyse(c, m->n, m->start, m->row, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_factor(c, m->value) == GPROJ_FACTORED);
    GPROJT_CHECK(gproj_cholesky_solve(c, 1, x, x) == GPROJ_OK);
    /* two columns fail: the one that is eliminated first is named */
    was = m->value[m->start[0]], was_half = m->value[m->start[m->n / 2]];
    m->value[m->start[0]] = m->value[m->start[m->n / 2]] = -1e9;
    GPROJT_CHECK(gproj_cholesky_factor(c, m->value) == GPROJ_NOT_POSITIVE_DEFINITE);
    *failed = gproj_cholesky_get_info(c).failed_column;
    m->value[m->start[0]] = was, m->value[m->start[m->n / 2]] = was_half;
    GPROJT_CHECK(c->symbolic.tasks > 4);
    gproj_cholesky_destroy(c);
    return x;
}

/* Each kind of kernels gives the same bits for any workers, and all kinds the same solution. */
GPROJT_TEST(cholesky_same_bits_for_any_workers) {
    matrix m = planarity(TORUS, 50, 50);
    double *first[8] = {NULL}; /* of each kind */
    const gproji_kernels *kernels;
    int32_t k, kind, failed = -1, other, j;
    matrix_merge(&m);
    for (j = 0; j < m.n; ++j) { /* the diagonal first in every column */
        int64_t p = m.start[j];
        double v;
        while (m.row[p] != j) ++p;
        v = m.value[p];
        m.value[p] = m.value[m.start[j]], m.row[p] = m.row[m.start[j]];
        m.value[m.start[j]] = v, m.row[m.start[j]] = j;
    }
    for (kind = 0; (kernels = gproji_kernels_of(kind)) != NULL; ++kind)
        for (k = 0; k < GPROJT_CREWS; ++k) {
            gproj_host host = gprojt_crew(k);
            double *x = solution_with(&host, kernels, &m, &other);
            if (kind == 0 && k == 0) failed = other;
            GPROJT_CHECK(failed == other);
            if (k == 0) {
                first[kind] = x;
                for (j = 0; j < m.n; ++j) GPROJT_NEAR(x[j], first[0][j], 1e-9);
                continue;
            }
            GPROJT_CHECK(memcmp(first[kind], x, (size_t)m.n * sizeof(double)) == 0);
            free(x);
        }
    for (k = 0; k < kind; ++k) free(first[k]);
    matrix_free(&m);
}

/* -- the memory of panels and update matrices: the same with all kernels -- */

#ifndef GPROJT_KERNELS

/* What owns each entry of the memory: nothing (0), the panel of front f (f + 1), its update matrix (- f - 1). */
typedef struct ownership {
    const gproji_symbolic *sy;
    int32_t *owner;
    int64_t wrong; /* entries that had another owner than they should */
    int64_t held, most;
} ownership;

static void change_owner(ownership *o, int64_t first, int64_t count, int32_t from, int32_t to) {
    int64_t i;
    for (i = first; i < first + count; ++i) {
        o->wrong += o->owner[i] != from;
        o->owner[i] = to;
    }
    o->held += to ? count : -count;
    if (o->held > o->most) o->most = o->held;
}

/* A front begins: its panel and its update matrix must be nobody's. */
static void begin_front(ownership *o, int32_t f) {
    const gproji_front *front = &o->sy->front[f];
    change_owner(o, front->panel, front->entries, 0, f + 1);
    change_owner(o, front->update, gproji_update_entries(front->update_rows), 0, -f - 1);
}

/* A front ends: its children's update matrices must still be theirs. */
static void end_front(ownership *o, int32_t f) {
    const gproji_front *front = o->sy->front;
    int32_t c;
    for (c = front[f].child; c >= 0; c = front[c].sibling)
        change_owner(o, front[c].update, gproji_update_entries(front[c].update_rows), -c - 1, 0);
}

/* The tasks from `first` on side by side. */
static void change_owners_of(ownership *o, int32_t first, int32_t end) {
    const gproji_symbolic *sy = o->sy;
    int32_t k, g, busy = 1;
    for (k = 0; busy; ++k) {
        busy = 0;
        for (g = first; g < end; ++g)
            if (sy->task_start[g] + k < sy->task_start[g + 1]) {
                begin_front(o, sy->schedule[sy->task_start[g] + k]);
                busy = 1;
            }
        for (g = first; g < end; ++g)
            if (sy->task_start[g] + k < sy->task_start[g + 1]) end_front(o, sy->schedule[sy->task_start[g] + k]);
    }
}

/* Goes through all fronts, the tasks one after the other or all of a stage side by side. */
static void change_owners(ownership *o, bool concurrent) {
    const gproji_symbolic *sy = o->sy;
    int32_t k;
    for (k = 0; concurrent && k < GPROJI_TASK_LEVELS; ++k)
        change_owners_of(o, sy->level_start[k], sy->level_start[k + 1]);
    for (k = concurrent ? sy->task_start[sy->tasks] : 0; k < sy->fronts; ++k) {
        begin_front(o, sy->schedule[k]);
        end_front(o, sy->schedule[k]);
    }
    for (k = 0; k < sy->fronts; ++k) change_owner(o, sy->front[k].panel, sy->front[k].entries, k + 1, 0);
}

/* Nothing is ever where something else is still needed; and one worker needs little more memory than what there is at
   once. Several need more, the most where tasks are small. */
GPROJT_TEST(cholesky_panels_and_updates_share_memory) {
    gproj_cholesky_options options = options_of(GPROJ_ORDERING_BEST);
    int32_t number, concurrent, second = 0; /* tasks of the second stage */
    for (number = 0; number < 8 * MESH_KINDS; number += PANELS_STEP) {
        bool large = (number & 4) != 0;
        matrix m = (number & 1 ? planarity : laplacian)(number / 8, large ? 80 : 40, large ? 75 : 37);
        options.disable_postorder = (number & 2) != 0;
        for (concurrent = 0; concurrent < 2; ++concurrent) {
            gproj_host host = gprojt_crew(concurrent);
            gproj_cholesky *c = gproj_cholesky_create(&host);
            int64_t size;
            ownership o;
            memset(&o, 0, sizeof o);
            GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, &options) == GPROJ_OK);
            o.sy = &c->symbolic;
            second += o.sy->level_start[2] - o.sy->level_start[1];
            size = o.sy->values_size + o.sy->work_size;
            o.owner = (int32_t *)calloc((size_t)size, sizeof *o.owner);
            change_owners(&o, concurrent == 1);
            GPROJT_CHECK(o.wrong == 0 && o.held == 0);
            GPROJT_CHECK(size <= o.most / 4 * (!concurrent ? 5 : large ? 6 : 7));
            free(o.owner);
            gproj_cholesky_destroy(c);
        }
        matrix_free(&m);
    }
    GPROJT_CHECK(second * PANELS_STEP > 20);
}

#endif

/* -- errors -- */

GPROJT_TEST(cholesky_arguments) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    static const int64_t start[] = {0, 2, 3}, backwards[] = {0, 2, 1}, late[] = {1, 2, 3},
                         huge[] = {0, 1, INT64_MAX / 2};
    static const int32_t row[] = {0, 1, 1}, outside[] = {0, 2, 1}, negative[] = {0, 1, -1}, twice[] = {0, 0},
                         beyond[] = {0, 2};
    static const double value[] = {2, 1, 2};
    double x[2] = {3, 3};
    gproj_cholesky_options given = options_of(GPROJ_ORDERING_GIVEN);
    GPROJT_CHECK(gproj_cholesky_error(c)->code == GPROJ_OK && gproj_cholesky_error(c)->index == -1);
    GPROJT_CHECK(gproj_cholesky_factor(c, value) == GPROJ_FACTOR_FAILED);
    GPROJT_CHECK(gproj_cholesky_error(c)->code == GPROJ_ERROR_STATE);
    GPROJT_CHECK(gproj_cholesky_solve(c, 1, x, x) == GPROJ_ERROR_STATE);
    GPROJT_CHECK(gproj_cholesky_analyse(c, -1, start, row, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_analyse(c, INT32_MAX, start, row, NULL) == GPROJ_ERROR_SIZE);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, NULL, row, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, start, NULL, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, late, row, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, huge, row, NULL) == GPROJ_ERROR_SIZE);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, backwards, row, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_error(c)->place == GPROJ_PLACE_COLUMN && gproj_cholesky_error(c)->index == 1);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, start, outside, NULL) == GPROJ_ERROR_INDEX);
    GPROJT_CHECK(strstr(gproj_cholesky_error(c)->message, "column 0 has an entry in row 2, which is not in 0..1") !=
                 NULL);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, start, negative, NULL) == GPROJ_ERROR_INDEX);
    GPROJT_CHECK(gproj_cholesky_error(c)->index == 1);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, start, row, &given) == GPROJ_ERROR_ARGUMENT);
    given.permutation = twice;
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, start, row, &given) == GPROJ_ERROR_ARGUMENT);
    given.permutation = beyond;
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, start, row, &given) == GPROJ_ERROR_ARGUMENT);
    given.ordering = (gproj_ordering)17;
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, start, row, &given) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(strstr(gproj_cholesky_error(c)->message, "ordering 17"));
    GPROJT_CHECK(gproj_cholesky_permutation(c) == NULL);
    GPROJT_CHECK(gproj_cholesky_get_info(c).columns == 0);
    /* and after all that it works */
    GPROJT_CHECK(gproj_cholesky_analyse(c, 2, start, row, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_error(c)->code == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_factor(c, NULL) == GPROJ_FACTOR_FAILED);
    GPROJT_CHECK(gproj_cholesky_factor(c, value) == GPROJ_FACTORED);
    GPROJT_CHECK(gproj_cholesky_solve(c, -1, x, x) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_solve(c, 1, NULL, x) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_solve(c, 1, x, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_refine(c, start, row, NULL, x, x, 1) == HUGE_VAL);
    GPROJT_CHECK(gproj_cholesky_refine(c, NULL, row, value, x, x, 1) == HUGE_VAL);
    GPROJT_CHECK(gproj_cholesky_refine(c, start, NULL, value, x, x, 1) == HUGE_VAL);
    GPROJT_CHECK(gproj_cholesky_refine(c, start, row, value, NULL, x, 1) == HUGE_VAL);
    GPROJT_CHECK(gproj_cholesky_refine(c, start, row, value, x, NULL, 1) == HUGE_VAL);
    GPROJT_CHECK(gproj_cholesky_error(c)->code == GPROJ_ERROR_ARGUMENT && x[0] == 3 && x[1] == 3);
    GPROJT_CHECK(gproj_cholesky_solve(c, 0, NULL, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_solve(c, 1, x, x) == GPROJ_OK);
    GPROJT_NEAR(x[0], 1, 1e-15);
    GPROJT_NEAR(x[1], 1, 1e-15);
    gproj_cholesky_destroy(c);
    /* no object */
    gproj_cholesky_destroy(NULL);
    GPROJT_CHECK(gproj_cholesky_analyse(NULL, 2, start, row, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_factor(NULL, value) == GPROJ_FACTOR_FAILED);
    GPROJT_CHECK(gproj_cholesky_solve(NULL, 1, x, x) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_refine(NULL, start, row, value, x, x, 1) == HUGE_VAL);
    GPROJT_CHECK(gproj_cholesky_error(NULL)->code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_cholesky_permutation(NULL) == NULL);
    GPROJT_CHECK(gproj_cholesky_memory(NULL).used == 0);
    GPROJT_CHECK(gproj_cholesky_get_info(NULL).failed_column == -1);
}

/* Sizes that do not fit: refused, and the object lives on. */
GPROJT_TEST(cholesky_sizes) {
    static const int32_t wide[] = {60000, 1};
    static const int64_t alone[] = {0, 0, 0};
    static const int32_t nothing[] = {0};
    static const gproji_graph two = {2, alone, nothing, wide}, one = {1, alone, nothing, wide + 1};
    gproj_host host;
    gproj_cholesky *c;
    int32_t step;
    memset(&host, 0, sizeof host);
    host.allocator.limit = (size_t)100 << 20;
    c = gproj_cholesky_create(&host);
    GPROJT_CHECK(gproji_cholesky_analyse_blocks(c, &two, GPROJ_ORDERING_BEST) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_get_info(c).factor_entries == (int64_t)60000 * 60001 / 2 + 1);
    GPROJT_CHECK(!gproji_cholesky_take_numeric(c)); /* 29 GB */
    GPROJT_CHECK(gproj_cholesky_error(c)->code == GPROJ_ERROR_MEMORY);
    GPROJT_CHECK(gproji_cholesky_analyse_blocks(c, &one, GPROJ_ORDERING_BEST) == GPROJ_OK);
    GPROJT_CHECK(gproji_cholesky_take_numeric(c));
    gproj_cholesky_destroy(c);
    memset(&host, 0, sizeof host);
    for (step = 2; step < 12; ++step) { /* an analysis by blocks without memory */
        gprojt_failing f;
        memset(&f, 0, sizeof f);
        f.fail_at = step;
        host = gprojt_failing_host(&f);
        c = gproj_cholesky_create(&host);
        GPROJT_CHECK(gproji_cholesky_analyse_blocks(c, &two, GPROJ_ORDERING_BEST) == GPROJ_ERROR_MEMORY);
        GPROJT_CHECK(gproji_cholesky_analyse_blocks(c, &two, GPROJ_ORDERING_BEST) == GPROJ_OK);
        gproj_cholesky_destroy(c);
        GPROJT_CHECK(f.held == 0);
    }
}

typedef struct factoring {
    matrix m;
    gproj_cholesky_options options;
} factoring;

static bool factor_with(const gproj_host *host, void *user) {
    const factoring *f = (const factoring *)user;
    gproj_cholesky *c = gproj_cholesky_create(host);
    gproj_factor_outcome outcome = GPROJ_FACTOR_FAILED;
    gproj_code code;
    if (!c) return false;
    code = gproj_cholesky_analyse(c, f->m.n, f->m.start, f->m.row, &f->options);
    GPROJT_CHECK(code == gproj_cholesky_error(c)->code);
    if (code == GPROJ_OK) outcome = gproj_cholesky_factor(c, f->m.value);
    GPROJT_CHECK(outcome == GPROJ_FACTORED ||
                 (outcome == GPROJ_FACTOR_FAILED && gproj_cholesky_error(c)->code == GPROJ_ERROR_MEMORY));
    if (outcome == GPROJ_FACTOR_FAILED) /* the next try has memory */
        GPROJT_CHECK(solve_error(c, &f->m, &f->options) >= 0 && solve_error(c, &f->m, &f->options) < 1e-9);
    GPROJT_CHECK(gproj_cholesky_memory(c).used == gprojt_failing_of(host)->bytes);
    gproj_cholesky_destroy(c);
    return outcome == GPROJ_FACTORED;
}

/* The first factorisation takes the memory that the analysis has foretold, but for a few small arrays, and for the scatter runs,
   of which grids have many: these are there since the analysis. */
GPROJT_TEST(cholesky_memory_is_foretold) {
    int32_t band, j, i;
    for (band = 0; band < 300; band = 4 * band + (band == 0)) {
        gproj_cholesky *c = gproj_cholesky_create(NULL);
        gproj_cholesky_info info;
        matrix m;
        size_t before, taken, told, runs;
        memset(&m, 0, sizeof m);
        m.n = 160;
        for (j = 0; j < m.n; ++j)
            for (i = j; i < m.n && i <= j + band; ++i) matrix_add(&m, i, j, i == j ? 200 : 1);
        matrix_finish(&m);
        if (band == 0) matrix_free(&m), m = laplacian(QUADS, 40, 30);
        GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, NULL) == GPROJ_OK);
        info = gproj_cholesky_get_info(c);
        before = gproj_cholesky_memory(c).used;
        GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTORED);
        taken = gproj_cholesky_memory(c).used - before;
        runs = sizeof(gproji_piece) * (size_t)c->piece_start[c->symbolic.fronts];
        told = info.factor_bytes + info.work_bytes - runs; /* arrays begin at cache lines, and are listed */
        GPROJT_CHECK(told <= taken && taken <= told + 1000 && (band > 0 || runs > 2000));
        gproj_cholesky_destroy(c);
        matrix_free(&m);
    }
}

GPROJT_TEST(cholesky_every_allocation_fails) {
    factoring f;
    int32_t *order;
    uint64_t seed = 3;
    f.m = planarity(QUADS, 6, 6);
    order = (int32_t *)malloc((size_t)f.m.n * sizeof(int32_t));
    random_permutation(f.m.n, order, &seed);
    f.options = options_of(GPROJ_ORDERING_AMD);
    GPROJT_CHECK(gprojt_fail_every_allocation(factor_with, &f) >= 25);
    f.options = options_of(GPROJ_ORDERING_DISSECTION);
    GPROJT_CHECK(gprojt_fail_every_allocation(factor_with, &f) >= 45);
    f.options = options_of(GPROJ_ORDERING_GIVEN);
    f.options.permutation = order;
    GPROJT_CHECK(gprojt_fail_every_allocation(factor_with, &f) >= 25);
    free(order);
    matrix_free(&f.m);
#if !defined(GPROJT_SANITIZED) && !defined(GPROJT_KERNELS)
    f.m = laplacian(TORUS, 60, 50); /* large enough to be cut */
    f.options = options_of(GPROJ_ORDERING_DISSECTION);
    GPROJT_CHECK(gprojt_fail_every_allocation(factor_with, &f) >= 55);
    matrix_free(&f.m);
#endif
}

/* -- size -- */

GPROJT_TEST(cholesky_large) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    matrix m = planarity(QUADS, LARGE_SIDE + 1, LARGE_SIDE);
    double *b, *x;
    int32_t i;
    matrix_merge(&m);
    b = (double *)malloc((size_t)m.n * sizeof(double)), x = (double *)malloc((size_t)m.n * sizeof(double));
    for (i = 0; i < m.n; ++i) b[i] = sin(0.01 * i);
    GPROJT_CHECK(gproj_cholesky_analyse(c, m.n, m.start, m.row, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_factor(c, m.value) == GPROJ_FACTORED);
    GPROJT_CHECK(gproj_cholesky_solve(c, 1, b, x) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_refine(c, m.start, m.row, m.value, b, x, 0) < 1e-9);
    free(b), free(x);
    matrix_free(&m);
    gproj_cholesky_destroy(c);
}

int main(void) {
    GPROJT_RUN(cholesky_random_patterns);
    GPROJT_RUN(cholesky_orders_agree);
    GPROJT_RUN(cholesky_special_shapes);
    GPROJT_RUN(ordering_fill_against_suitesparse);
    GPROJT_RUN(ordering_keeps_blocks);
    GPROJT_RUN(ordering_is_deterministic);
    GPROJT_RUN(cholesky_blocks);
    GPROJT_RUN(cholesky_refactor_without_allocation);
    GPROJT_RUN(cholesky_refine_improves);
    GPROJT_RUN(cholesky_not_positive_definite);
    GPROJT_RUN(cholesky_names_a_tiny_pivot);
    GPROJT_RUN(cholesky_names_the_first_failing_column);
    GPROJT_RUN(cholesky_same_bits_for_any_workers);
#ifndef GPROJT_KERNELS
    GPROJT_RUN(cholesky_panels_and_updates_share_memory);
#endif
    GPROJT_RUN(cholesky_arguments);
    GPROJT_RUN(cholesky_sizes);
    GPROJT_RUN(cholesky_memory_is_foretold);
    GPROJT_RUN(cholesky_every_allocation_fails);
    GPROJT_RUN(cholesky_large);
    return gprojt_report();
}
