/* test_least_squares.c - >>least-squares: against all sets of held variables, against Lawson and Hanson's method, and by
   the conditions of optimality, evaluated here, for random problems and for forces in meshes. */
#include "gprojt_mesh.h"

/* -- problems -- */

/* Room for a problem of its own: columns are added one after the other. */
typedef struct squares {
    gproj_least_squares p;
    int64_t *start;
    int32_t *row;
    double *value, *b, *lower, *upper, *x;
    int64_t room;
} squares;

static squares squares_of(int32_t rows, int32_t columns, int64_t entries) {
    squares s;
    memset(&s, 0, sizeof s);
    s.room = entries;
    s.start = (int64_t *)calloc((size_t)columns + 1, sizeof(int64_t));
    s.row = (int32_t *)calloc((size_t)entries + 1, sizeof(int32_t));
    s.value = (double *)calloc((size_t)entries + 1, sizeof(double));
    s.b = (double *)calloc((size_t)rows + 1, sizeof(double));
    s.lower = (double *)calloc((size_t)columns + 1, sizeof(double));
    s.upper = (double *)calloc((size_t)columns + 1, sizeof(double));
    s.x = (double *)calloc((size_t)columns + 1, sizeof(double));
    s.p.rows = rows, s.p.columns = columns;
    s.p.start = s.start, s.p.row = s.row, s.p.value = s.value, s.p.b = s.b;
    s.p.lower = s.lower;
    return s;
}

static void squares_free(squares *s) {
    free(s->start), free(s->row), free(s->value), free(s->b), free(s->lower), free(s->upper), free(s->x);
}

/* Random entries and b; bounds: 0 <= x. */
static squares random_squares(int32_t rows, int32_t columns, double density, uint64_t *seed) {
    squares s = squares_of(rows, columns, (int64_t)rows * columns);
    int32_t i, j;
    int64_t at = 0;
    for (j = 0; j < columns; ++j) {
        for (i = 0; i < rows; ++i)
            if (gprojt_uniform(seed) < density) s.row[at] = i, s.value[at++] = 2 * gprojt_uniform(seed) - 1;
        s.start[j + 1] = at;
    }
    for (i = 0; i < rows; ++i) s.b[i] = 2 * gprojt_uniform(seed) - 1;
    return s;
}

/* Bounds of all kinds: none, one, two, equal ones. */
static void random_bounds(squares *s, uint64_t *seed) {
    int32_t j;
    s->p.upper = s->upper;
    for (j = 0; j < s->p.columns; ++j) {
        double middle = 2 * gprojt_uniform(seed) - 1, half = gprojt_uniform(seed);
        int32_t kind = gprojt_below(seed, 6);
        s->lower[j] = kind == 0 || kind == 1 ? -HUGE_VAL : middle - half;
        s->upper[j] = kind == 0 || kind == 2 ? HUGE_VAL : middle + half;
        if (kind == 3) s->upper[j] = s->lower[j] = middle;
    }
}

static double lower_of(const squares *s, int32_t j) { return s->p.lower ? s->p.lower[j] : -HUGE_VAL; }
static double upper_of(const squares *s, int32_t j) { return s->p.upper ? s->p.upper[j] : HUGE_VAL; }

/* g = A'(A x - b) + damping^2 x, in long double where the compiler has it. Returns |A x - b|. */
static double gradient_of(const squares *s, const double *x, double *g) {
    long double *misfit = (long double *)calloc((size_t)s->p.rows + 1, sizeof(long double)), sum = 0;
    int32_t i, j;
    int64_t e;
    for (i = 0; i < s->p.rows; ++i) misfit[i] = -(long double)s->b[i];
    for (j = 0; j < s->p.columns; ++j)
        for (e = s->start[j]; e < s->start[j + 1]; ++e) misfit[s->row[e]] += (long double)s->value[e] * x[j];
    for (j = 0; j < s->p.columns; ++j) {
        long double t = (long double)s->p.damping * s->p.damping * x[j];
        for (e = s->start[j]; e < s->start[j + 1]; ++e) t += s->value[e] * misfit[s->row[e]];
        g[j] = (double)t;
    }
    for (i = 0; i < s->p.rows; ++i) sum += misfit[i] * misfit[i];
    free(misfit);
    return sqrt((double)sum);
}

static double objective_of(const squares *s, const double *x) {
    double *g = (double *)malloc(((size_t)s->p.columns + 1) * sizeof(double)), r = gradient_of(s, x, g), sum = r * r;
    int32_t j;
    for (j = 0; j < s->p.columns; ++j) sum += s->p.damping * s->p.damping * x[j] * x[j];
    free(g);
    return 0.5 * sum;
}

/* The largest violation of optimality; huge where x leaves its bounds. */
static double violation_of(const squares *s, const double *x) {
    double *g = (double *)malloc(((size_t)s->p.columns + 1) * sizeof(double)), worst = 0;
    int32_t j;
    gradient_of(s, x, g);
    for (j = 0; j < s->p.columns; ++j) {
        double l = lower_of(s, j), u = upper_of(s, j);
        if (!(x[j] >= l && x[j] <= u)) worst = 1e300;
        if (l == u || (x[j] == l && g[j] >= 0) || (x[j] == u && g[j] <= 0)) continue;
        if (!(fabs(g[j]) <= worst)) worst = fabs(g[j]);
    }
    free(g);
    return worst;
}

/* gproj_least_squares_result.kkt as it is described, by the definition. */
static double kkt_of(const squares *s, const double *x) {
    int32_t n = s->p.columns, j;
    double *g = (double *)malloc(((size_t)n + 1) * sizeof(double)),
           *near = (double *)malloc(((size_t)s->p.rows + 1) * sizeof(double)), worst = 0, largest = 0;
    int64_t e;
    gradient_of(s, x, g);
    for (j = 0; j < s->p.rows; ++j) near[j] = fabs(s->b[j]);
    for (j = 0; j < n; ++j)
        for (e = s->start[j]; e < s->start[j + 1]; ++e)
            near[s->row[e]] += fabs(s->value[e] * fmin(fmax(0, lower_of(s, j)), upper_of(s, j)));
    for (j = 0; j < n; ++j) {
        double length = s->p.damping * s->p.damping,
               size = length * fabs(fmin(fmax(0, lower_of(s, j)), upper_of(s, j)));
        for (e = s->start[j]; e < s->start[j + 1]; ++e) {
            length += s->value[e] * s->value[e];
            size += fabs(s->value[e]) * near[s->row[e]];
        }
        if (!(length > 0)) continue;
        largest = fmax(largest, size / sqrt(length));
        if ((x[j] <= lower_of(s, j) && g[j] >= 0) || (x[j] >= upper_of(s, j) && g[j] <= 0)) continue;
        worst = fmax(worst, fabs(g[j]) / sqrt(length));
    }
    free(g), free(near);
    return worst / largest;
}

static gproj_least_squares_result solve(squares *s) {
    gproj_least_squares_result result;
    gproj_error error;
    gproj_code code = gproj_solve_least_squares(&s->p, NULL, s->x, &result, &error);
    GPROJT_CHECK(code == GPROJ_OK && error.code == GPROJ_OK && error.message[0] == 0);
    return result;
}

/* Solves, and checks from outside that it is solved. `size`: of the entries of A and b. */
static gproj_least_squares_result check_solved(squares *s, double size) {
    gproj_least_squares_result result = solve(s);
    double *g = (double *)malloc(((size_t)s->p.columns + 1) * sizeof(double)), residual = gradient_of(s, s->x, g);
    int32_t j, at_bounds = 0;
    for (j = 0; j < s->p.columns; ++j) at_bounds += s->x[j] == lower_of(s, j) || s->x[j] == upper_of(s, j);
    GPROJT_CHECK(result.outcome == GPROJ_LEAST_SQUARES_SOLVED);
    GPROJT_CHECK(result.kkt >= 0 && result.kkt <= 1e-10);
    GPROJT_CHECK(violation_of(s, s->x) <= 1e-11 * size * size);
    GPROJT_NEAR(result.residual, residual, 1e-9 * size);
    GPROJT_CHECK(result.at_bounds == at_bounds);
    free(g);
    return result;
}

/* -- oracles -- */

/* Solves the n x n system of a dense symmetric positive semidefinite matrix by Gauss with diagonal pivots; what is
   singular gives 0. Both are overwritten. */
static void dense_solve(int32_t n, double *a, double *b) {
    int32_t i, j, k, *order = (int32_t *)malloc(((size_t)n + 1) * sizeof(int32_t)), rank = 0;
    char *used = (char *)calloc((size_t)n + 1, 1);
    double first = 0;
    for (k = 0; k < n; ++k) {
        int32_t p = -1;
        for (i = 0; i < n; ++i)
            if (!used[i] && (p < 0 || a[i * n + i] > a[p * n + p])) p = i;
        if (k == 0) first = a[p * n + p];
        if (!(a[p * n + p] > 1e-12 * first)) break;
        used[p] = 1, order[rank++] = p;
        for (i = 0; i < n; ++i) {
            double f = a[i * n + p] / a[p * n + p];
            if (used[i]) continue;
            for (j = 0; j < n; ++j) a[i * n + j] -= f * a[p * n + j];
            b[i] -= f * b[p];
        }
    }
    for (i = 0; i < n; ++i)
        if (!used[i]) b[i] = 0;
    for (k = rank - 1; k >= 0; --k) {
        int32_t p = order[k];
        for (i = 0; i < n; ++i) {
            bool later = !used[i];
            for (j = k + 1; j < rank; ++j) later = later || order[j] == i;
            if (later) b[p] -= a[p * n + i] * b[i];
        }
        b[p] /= a[p * n + p];
    }
    free(order), free(used);
}

/* x with the variables of `held` at their values and the others at the minimum. */
static void minimum_with(const squares *s, const char *held, double *x) {
    int32_t n = s->p.columns, m = s->p.rows, i, j, k;
    double *a = (double *)calloc((size_t)m * (size_t)n + 1, sizeof(double)),
           *q = (double *)calloc((size_t)n * (size_t)n + 1, sizeof(double)),
           *c = (double *)calloc((size_t)n + 1, sizeof(double)),
           *rest = (double *)calloc((size_t)m + 1, sizeof(double));
    int64_t e;
    for (j = 0; j < n; ++j)
        for (e = s->start[j]; e < s->start[j + 1]; ++e) a[s->row[e] * n + j] += s->value[e];
    for (i = 0; i < m; ++i)
        for (rest[i] = s->b[i], j = 0; j < n; ++j)
            if (held[j]) rest[i] -= a[i * n + j] * x[j];
    for (j = 0; j < n; ++j) {
        if (held[j]) continue;
        for (i = 0; i < m; ++i) c[j] += a[i * n + j] * rest[i];
        for (k = 0; k < n; ++k)
            for (i = 0; !held[k] && i < m; ++i) q[j * n + k] += a[i * n + j] * a[i * n + k];
        q[j * n + j] += s->p.damping * s->p.damping;
    }
    dense_solve(n, q, c);
    for (j = 0; j < n; ++j)
        if (!held[j]) x[j] = c[j];
    free(a), free(q), free(c), free(rest);
}

/* The smallest objective over all sets of held variables, each at either bound. */
static double brute_force(const squares *s) {
    int32_t n = s->p.columns, j;
    int64_t sets = 1, k;
    double best = HUGE_VAL, x[12];
    for (j = 0; j < n; ++j) sets *= 3;
    for (k = 0; k < sets; ++k) {
        char held[12];
        int64_t rest = k;
        bool good = true;
        for (j = 0; j < n; ++j, rest /= 3) {
            held[j] = rest % 3 != 0;
            x[j] = rest % 3 == 1 ? lower_of(s, j) : rest % 3 == 2 ? upper_of(s, j) : 0;
            good = good && fabs(x[j]) < 1e100;
        }
        if (!good) continue;
        minimum_with(s, held, x);
        for (j = 0; j < n; ++j) good = good && x[j] >= lower_of(s, j) - 1e-13 && x[j] <= upper_of(s, j) + 1e-13;
        if (good && objective_of(s, x) < best) best = objective_of(s, x);
    }
    return best;
}

/* Lawson and Hanson (1974): x >= 0, one variable freed at a time. */
static void lawson_hanson(const squares *s, double *x) {
    int32_t n = s->p.columns, j, round;
    char *held = (char *)malloc((size_t)n + 1);
    double *g = (double *)malloc(((size_t)n + 1) * sizeof(double)),
           *z = (double *)malloc(((size_t)n + 1) * sizeof(double));
    for (j = 0; j < n; ++j) held[j] = 1, x[j] = 0;
    for (round = 0; round < 10 * n; ++round) {
        int32_t best = -1;
        gradient_of(s, x, g);
        for (j = 0; j < n; ++j)
            if (held[j] && g[j] < -1e-12 && (best < 0 || g[j] < g[best])) best = j;
        if (best < 0) break;
        held[best] = 0;
        for (;;) {
            double a = 1;
            for (j = 0; j < n; ++j) z[j] = 0;
            minimum_with(s, held, z);
            for (j = 0; j < n; ++j)
                if (!held[j] && z[j] <= 0 && x[j] / (x[j] - z[j]) < a) a = x[j] / (x[j] - z[j]);
            for (j = 0; j < n; ++j) x[j] += a * (z[j] - x[j]);
            if (a >= 1) break;
            for (j = 0; j < n; ++j)
                if (!held[j] && x[j] < 1e-14) held[j] = 1, x[j] = 0;
        }
    }
    free(held), free(g), free(z);
}

GPROJT_TEST(small_problems_against_all_sets) {
    uint64_t seed = 1;
    int32_t k;
    for (k = 0; k < 400; ++k) {
        int32_t n = 1 + gprojt_below(&seed, 6), m = 1 + gprojt_below(&seed, 9);
        squares s = random_squares(m, n, k % 2 ? 1.0 : 0.5, &seed);
        double wanted;
        random_bounds(&s, &seed);
        s.p.damping = k % 3 == 0 ? 0.3 : 0;
        check_solved(&s, 4);
        wanted = brute_force(&s);
        GPROJT_NEAR(objective_of(&s, s.x), wanted, 1e-12);
        squares_free(&s);
    }
}

GPROJT_TEST(against_lawson_hanson) {
    uint64_t seed = 2;
    int32_t k, j;
    for (k = 0; k < 30; ++k) {
        int32_t n = 25 + gprojt_below(&seed, 10), m = n + gprojt_below(&seed, 20);
        squares s = random_squares(m, n, k % 2 ? 1.0 : 0.4, &seed);
        double x[40], worst = 0;
        if (k % 3 == 0) s.p.damping = 0.1;
        check_solved(&s, 8);
        lawson_hanson(&s, x);
        GPROJT_CHECK(violation_of(&s, x) < 1e-9);
        for (j = 0; j < n; ++j) worst = fmax(worst, fabs(x[j] - s.x[j]));
        GPROJT_CHECK(worst < 1e-7);
        squares_free(&s);
    }
}

/* -- random sparse problems -- */

GPROJT_TEST(sparse_problems) {
    uint64_t seed = 3;
    int32_t k, most = 0;
    for (k = 0; k < 60; ++k) {
        int32_t n = 50 + gprojt_below(&seed, 150), m = 20 + gprojt_below(&seed, 300);
        squares s = random_squares(m, n, 4.0 / m, &seed);
        gproj_least_squares_result r;
        if (k % 2) random_bounds(&s, &seed);
        if (k % 5 == 0) s.p.damping = 1e-3;
        r = check_solved(&s, 10);
        if (r.factorisations > most) most = r.factorisations;
        squares_free(&s);
    }
    GPROJT_CHECK(most <= 25);
}

/* Columns that are equal, opposite or 0, and columns whose entries are split in two. */
GPROJT_TEST(dependent_columns) {
    uint64_t seed = 4;
    int32_t k, j;
    for (k = 0; k < 40; ++k) {
        int32_t n = 60, m = 40;
        squares s = random_squares(m, n, 0.1, &seed);
        int64_t e;
        for (j = 3; j + 3 < n; j += 6) { /* column j + 1 is +-column j, as far as the entries reach */
            int64_t count = s.start[j + 1] - s.start[j], room = s.start[j + 2] - s.start[j + 1];
            for (e = 0; e < room; ++e) {
                s.row[s.start[j + 1] + e] = s.row[s.start[j] + (count ? e % count : 0)];
                s.value[s.start[j + 1] + e] = e < count ? (j % 4 ? 1 : -1) * s.value[s.start[j] + e] : 0;
            }
        }
        for (e = s.start[8]; e < s.start[9]; ++e) s.value[e] = 0;
        for (e = s.start[10]; e + 1 < s.start[11]; e += 2) s.row[e + 1] = s.row[e];
        if (k % 2) random_bounds(&s, &seed);
        check_solved(&s, 8);
        for (j = 0; j < n; ++j) GPROJT_CHECK(fabs(s.x[j]) < 1e6);
        squares_free(&s);
    }
}

/* Columns of very different lengths; powers of two, so that the scaled problem is the same problem. */
GPROJT_TEST(units) {
    uint64_t seed = 5;
    int32_t k, j;
    for (k = 0; k < 6; ++k) {
        squares s = random_squares(90, 70, 0.06, &seed), t = random_squares(90, 70, 0.06, &seed);
        gproj_least_squares_result r, q;
        int64_t e;
        double factor = ldexp(1, 15 * k - 40), worst = 0;
        memcpy(t.start, s.start, 71 * sizeof(int64_t));
        memcpy(t.row, s.row, (size_t)s.start[70] * sizeof(int32_t));
        for (e = 0; e < s.start[70]; ++e) t.value[e] = s.value[e] * factor;
        for (j = 0; j < 90; ++j) t.b[j] = s.b[j] * 1024;
        r = solve(&s), q = solve(&t);
        GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && q.outcome == r.outcome);
        GPROJT_CHECK(r.factorisations == q.factorisations && r.at_bounds == q.at_bounds);
        for (j = 0; j < 70; ++j) worst = fmax(worst, fabs(t.x[j] * factor / 1024 - s.x[j]) / (1 + fabs(s.x[j])));
        GPROJT_CHECK(worst < 1e-9);
        squares_free(&s), squares_free(&t);
    }
}

/* Columns of the Hilbert matrix: as ill-conditioned as it gets. The verdict must be true, whatever it is. */
GPROJT_TEST(ill_conditioned) {
    int32_t n, i, j;
    for (n = 2; n <= 40; n += 2) {
        squares s = squares_of(n, n, (int64_t)n * n);
        gproj_least_squares_result r;
        for (j = 0; j < n; ++j) {
            for (i = 0; i < n; ++i) s.row[j * n + i] = i, s.value[j * n + i] = 1.0 / (1 + i + j);
            s.start[j + 1] = (int64_t)(j + 1) * n;
        }
        for (i = 0; i < n; ++i) s.b[i] = cos(3.0 * i);
        s.p.lower = n % 4 ? s.lower : NULL;
        r = solve(&s);
        GPROJT_CHECK(r.factorisations <= 80 && r.outcome != GPROJ_LEAST_SQUARES_FAILED);
        GPROJT_CHECK(violation_of(&s, s.x) <= (r.kkt + 1e-12) * 40 * 40);
        if (n % 4) GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED);
        squares_free(&s);
    }
}

/* Nearly dependent columns, with bounds and b of all magnitudes: some of these run out of factorisations. What is said of the
   point then met is true: it is within its bounds, and violates the conditions by kkt. */
GPROJT_TEST(all_factorisations) {
    uint64_t seed = 32;
    int32_t k, i, j, n = 23, m = 36, limits = 0;
    for (k = 0; k < 400; ++k) {
        squares s = squares_of(m, n, (int64_t)m * n);
        gproj_least_squares_result r;
        for (j = 0; j < n; ++j) {
            double middle = (2 * gprojt_uniform(&seed) - 1) * pow(10, 5 * (2 * gprojt_uniform(&seed) - 1));
            for (i = 0; i < m; ++i) s.row[j * m + i] = i, s.value[j * m + i] = 1.0 / (1 + i + j);
            s.start[j + 1] = (int64_t)(j + 1) * m;
            s.lower[j] = j % 4 == 0 ? -HUGE_VAL : middle;
            s.upper[j] = j % 4 == 1 ? HUGE_VAL : middle + pow(10, 9 * (2 * gprojt_uniform(&seed) - 1));
        }
        s.p.upper = s.upper;
        for (i = 0; i < m; ++i) s.b[i] = (2 * gprojt_uniform(&seed) - 1) * pow(10, 5 * (2 * gprojt_uniform(&seed) - 1));
        r = solve(&s);
        for (j = 0; j < n; ++j) GPROJT_CHECK(s.x[j] >= s.lower[j] && s.x[j] <= s.upper[j]);
        GPROJT_CHECK(r.factorisations <= 80 && r.outcome != GPROJ_LEAST_SQUARES_FAILED);
        GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_LIMIT || r.kkt <= 1e-9);
        GPROJT_NEAR(r.kkt, kkt_of(&s, s.x), 1e-2 * r.kkt + 1e-10);
        limits += r.factorisations == 80 && r.outcome == GPROJ_LEAST_SQUARES_LIMIT;
        squares_free(&s);
    }
    GPROJT_CHECK(limits > 0);
}

GPROJT_TEST(damping) {
    uint64_t seed = 6;
    double value[2] = {1, 1}, b[1] = {3}, x[2] = {0, 0}, lower[2] = {-HUGE_VAL, 0};
    int64_t start[3] = {0, 1, 2};
    int32_t row[2] = {0, 0};
    gproj_least_squares p;
    gproj_least_squares_result r;
    squares s = random_squares(30, 50, 0.2, &seed), t;
    memset(&p, 0, sizeof p);
    p.rows = 1, p.columns = 2, p.start = start, p.row = row, p.value = value, p.b = b, p.lower = lower;
    p.damping = 1; /* (1 + 1 + 1) x = 3: both are 1 */
    GPROJT_CHECK(gproj_solve_least_squares(&p, NULL, x, &r, NULL) == GPROJ_OK);
    GPROJT_NEAR(x[0], 1, 1e-15);
    GPROJT_NEAR(x[1], 1, 1e-15);
    GPROJT_NEAR(r.residual, 1, 1e-15);
    p.damping = 0; /* the solution nearest to the start */
    x[0] = 2, x[1] = 3;
    GPROJT_CHECK(gproj_solve_least_squares(&p, NULL, x, &r, NULL) == GPROJ_OK);
    GPROJT_NEAR(x[0], 1, 1e-6);
    GPROJT_NEAR(x[1], 2, 1e-6);
    /* With damping the solution is unique, and the start does not matter. */
    s.p.damping = 0.5;
    t = s;
    check_solved(&s, 8);
    t.x = (double *)malloc(50 * sizeof(double));
    {
        int32_t j;
        for (j = 0; j < 50; ++j) t.x[j] = 10 * gprojt_uniform(&seed) - 5;
        check_solved(&t, 8);
        for (j = 0; j < 50; ++j) GPROJT_NEAR(s.x[j], t.x[j], 1e-12);
    }
    free(t.x);
    squares_free(&s);
}

/* -- bounds -- */

GPROJT_TEST(all_bounds_hold) {
    uint64_t seed = 7;
    squares s = random_squares(40, 30, 0.3, &seed);
    gproj_least_squares_result r;
    int32_t j;
    int64_t e;
    for (e = 0; e < s.start[30]; ++e) s.value[e] = fabs(s.value[e]);
    for (j = 0; j < 40; ++j) s.b[j] = -1;
    r = check_solved(&s, 8); /* pushes all down to 0 */
    GPROJT_CHECK(r.at_bounds == 30);
    for (j = 0; j < 30; ++j) s.x[j] = 2;
    r = check_solved(&s, 8);
    GPROJT_CHECK(r.at_bounds == 30);
    for (j = 0; j < 40; ++j) s.b[j] = 1e3; /* up to 0.001, from below */
    for (j = 0; j < 30; ++j) s.upper[j] = 0.001, s.x[j] = -7;
    s.p.lower = NULL, s.p.upper = s.upper;
    r = check_solved(&s, 1e3);
    GPROJT_CHECK(r.at_bounds == 30);
    squares_free(&s);
}

GPROJT_TEST(fixed_variables) {
    uint64_t seed = 8;
    squares s = random_squares(40, 30, 0.3, &seed);
    gproj_least_squares_result r;
    int32_t j;
    s.p.upper = s.upper;
    for (j = 0; j < 30; ++j) s.lower[j] = s.upper[j] = 0.1 * j - 1;
    r = check_solved(&s, 8); /* all of them: nothing to do */
    GPROJT_CHECK(r.at_bounds == 30 && r.factorisations == 0);
    for (j = 0; j < 30; ++j) GPROJT_CHECK(s.x[j] == s.lower[j]);
    for (j = 0; j < 30; j += 2) s.lower[j] = -HUGE_VAL, s.upper[j] = HUGE_VAL;
    r = check_solved(&s, 8); /* half: one factorisation */
    GPROJT_CHECK(r.at_bounds == 15 && r.factorisations == 1);
    for (j = 0; j < 30; j += 2) s.upper[j] = s.lower[j] = 0, s.upper[j] = DBL_MIN; /* a box without a number inside */
    s.upper[4] = 1;
    check_solved(&s, 8);
    squares_free(&s);
}

/* A variable whose bounds are neighbouring numbers, or very near, is as good as fixed: the problem has the solution that it has
   with the variable fixed, and the variable is exactly within its bounds. */
GPROJT_TEST(bounds_that_are_neighbours) {
    static const double widths[] = {0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5};
    uint64_t seed = 31;
    int32_t k, i, j;
    for (k = 0; k < 60; ++k) {
        squares s = random_squares(20, 20, k % 2 ? 1.0 : 0.4, &seed);
        double at = k % 3 == 0 ? 0 : k % 3 == 1 ? 1 : -0.3, width = widths[k / 3 % 6], residual;
        int32_t narrow = k < 30 ? 1 : 5;
        for (i = 0; k % 4 == 0 && i < 20; ++i) s.b[i] *= 100;
        s.p.upper = s.upper;
        for (j = 0; j < 20; ++j) s.upper[j] = 1;
        for (j = 3; j < 3 + narrow; ++j) {
            s.lower[j] = at + (j - 3), s.upper[j] = s.lower[j] + width;
            if (!(s.upper[j] > s.lower[j])) s.upper[j] = nextafter(s.lower[j], 10);
        }
        residual = check_solved(&s, k % 4 == 0 ? 1000 : 10).residual;
        for (j = 3; j < 3 + narrow; ++j) s.lower[j] = s.upper[j] = s.x[j];
        memset(s.x, 0, 20 * sizeof *s.x);
        GPROJT_NEAR(solve(&s).residual, residual, 1e-11);
        for (j = 3; j < 3 + narrow; ++j) s.lower[j] = s.upper[j] = at + (j - 3);
        GPROJT_NEAR(solve(&s).residual, residual, 1e-11 + 20 * width);
        squares_free(&s);
    }
}

GPROJT_TEST(without_bounds) {
    uint64_t seed = 9;
    squares s = random_squares(40, 30, 0.3, &seed);
    gproj_least_squares_result r;
    int32_t j;
    s.p.lower = NULL;
    r = check_solved(&s, 8);
    GPROJT_CHECK(r.factorisations == 1 && r.at_bounds == 0);
    s.p.lower = s.lower, s.p.upper = s.upper;
    for (j = 0; j < 30; ++j) s.lower[j] = -HUGE_VAL, s.upper[j] = HUGE_VAL, s.x[j] = 0;
    r = check_solved(&s, 8);
    GPROJT_CHECK(r.factorisations == 1 && r.at_bounds == 0);
    squares_free(&s);
}

/* Columns of very different sizes, as x in other units: x = S y, for which all entries and bounds are known. A small column
   must not drown beside a large one. */
GPROJT_TEST(columns_of_all_sizes) {
    uint64_t seed = 23;
    int round;
    for (round = 0; round < 40; ++round) {
        squares s = random_squares(20, 12, 0.5, &seed), t;
        gproj_least_squares_result r, q;
        int32_t j;
        int64_t e;
        random_bounds(&s, &seed);
        t = squares_of(20, 12, s.room);
        memcpy(t.row, s.row, (size_t)s.room * sizeof *s.row);
        memcpy(t.start, s.start, 13 * sizeof *s.start);
        memcpy(t.b, s.b, 20 * sizeof *s.b);
        t.p.upper = t.upper;
        for (j = 0; j < 12; ++j) {
            double scale = ldexp(1, 20 * (gprojt_below(&seed, 5) - 2));
            for (e = s.start[j]; e < s.start[j + 1]; ++e) t.value[e] = s.value[e] * scale;
            t.lower[j] = s.lower[j] / scale, t.upper[j] = s.upper[j] / scale;
        }
        r = check_solved(&s, 8);
        q = solve(&t);
        GPROJT_CHECK(q.outcome == GPROJ_LEAST_SQUARES_SOLVED && q.at_bounds == r.at_bounds);
        GPROJT_NEAR(q.residual, r.residual, 1e-9);
        squares_free(&s), squares_free(&t);
    }
}

/* Entries from 1e-10 to 1e10: what is called solved has a kkt below 1e-9 also where nothing is rounded. */
GPROJT_TEST(rounding_hides_no_violation) {
    uint64_t seed = 4;
    int round, solved = 0;
    for (round = 0; round < 4000; ++round) {
        int32_t columns = 2 + gprojt_below(&seed, 12), rows = columns - 1 + gprojt_below(&seed, 8);
        squares s = random_squares(rows, columns, 0.6, &seed);
        gproj_least_squares_result r;
        int64_t e;
        for (e = 0; e < s.start[columns]; ++e) s.value[e] *= pow(10, 20 * gprojt_uniform(&seed) - 10);
        r = solve(&s);
        solved += r.outcome == GPROJ_LEAST_SQUARES_SOLVED;
        GPROJT_CHECK(r.outcome != GPROJ_LEAST_SQUARES_SOLVED || !(kkt_of(&s, s.x) > 1.001e-9));
        squares_free(&s);
    }
    GPROJT_CHECK(solved > 1000);
}

/* Rows that round by more than another row has in all: SOLVED is not said where that other row is not solved. Cases: large
   rows beside small ones, and entries of the same place whose sum is less than their rounding. */
GPROJT_TEST(cancellation_is_noise) {
    static const double large[5] = {1, 1e4, 1e10, 1e15, 1e20};
    int i, how;
    for (i = 0; i < 5; ++i)
        for (how = 0; how < 3; ++how) {
            squares s = squares_of(2, 2, 6);
            gproj_least_squares_result r;
            double a = large[i];
            s.p.lower = NULL;
            s.b[0] = how == 1 ? a : 1, s.b[1] = 1;
            s.row[0] = 0, s.value[0] = a, s.row[1] = 1, s.value[1] = 1; /* a x + a y = b, x - y = 1 */
            s.row[2] = 0, s.value[2] = a, s.row[3] = 1, s.value[3] = -1;
            s.start[1] = 2, s.start[2] = 4;
            if (how == 2) { /* (a - a + 1) x = 1, y = 1 */
                s.row[1] = s.row[2] = 0, s.value[1] = -a, s.value[2] = 1;
                s.row[3] = 1, s.value[3] = 1;
                s.start[1] = 3;
            }
            r = solve(&s);
            GPROJT_CHECK((r.outcome == GPROJ_LEAST_SQUARES_SOLVED) <= (r.residual <= 1e-6));
            GPROJT_CHECK(i > 1 || r.outcome == GPROJ_LEAST_SQUARES_SOLVED);
            squares_free(&s);
        }
}

/* A fixed variable mends no row, however large its terms in others are: there is nothing to find, and that is certain. */
GPROJT_TEST(fixed_variables_leave_no_doubt) {
    squares s = squares_of(3, 2, 3);
    gproj_least_squares_result r;
    s.row[0] = 0, s.value[0] = 1e10, s.row[1] = 1, s.value[1] = 1; /* x = 1, in large terms, and x = 3; y = 2 */
    s.row[2] = 2, s.value[2] = 1;
    s.start[1] = 2, s.start[2] = 3;
    s.b[0] = 1e10, s.b[1] = 3, s.b[2] = 2;
    s.p.upper = s.upper;
    s.lower[0] = s.upper[0] = 1, s.upper[1] = 10;
    r = solve(&s);
    GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && s.x[0] == 1);
    GPROJT_NEAR(s.x[1], 2, 1e-10);
    GPROJT_NEAR(r.residual, 2, 1e-10);
    squares_free(&s);
}

/* Entries at one place are summed before anything else: what large ones leave counts, and what they cancel is no rounding. */
GPROJT_TEST(entries_that_cancel) {
    squares s = squares_of(2, 2, 4), t = squares_of(1, 2, 3);
    gproj_least_squares_result r;
    int k;
    s.row[0] = s.row[1] = s.row[2] = 0, s.value[0] = 1e20, s.value[1] = -1e20, s.value[2] = 1; /* x = 1, y = 1e30 */
    s.row[3] = 1, s.value[3] = 1;
    s.start[1] = 3, s.start[2] = 4;
    s.b[0] = 1, s.b[1] = 1e30;
    s.p.upper = s.upper;
    s.upper[0] = s.upper[1] = 1e40;
    r = solve(&s);
    GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && r.at_bounds == 0);
    GPROJT_NEAR(s.x[1], 1e30, 1e15);
    t.value[0] = -8e8, t.value[1] = 8e8, t.value[2] = -0.007, t.start[1] = 2, t.start[2] = 3; /* -0.007 y = 2 */
    t.b[0] = 2;
    t.p.upper = t.upper;
    t.lower[0] = -HUGE_VAL, t.upper[0] = -2, t.lower[1] = -3.7, t.upper[1] = -1.9;
    for (k = 0; k < 2; ++k) {
        t.x[0] = t.x[1] = k ? -2 : 0;
        r = solve(&t);
        GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && t.x[0] == -2 && t.x[1] == -3.7);
    }
    t.value[0] = -3, t.value[1] = 3, t.value[2] = 1, t.upper[0] = t.upper[1] = 1; /* y = 2, at most 1: certain */
    t.lower[0] = t.lower[1] = -HUGE_VAL, t.x[0] = t.x[1] = 0;
    r = solve(&t);
    GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && t.x[1] == 1);
    squares_free(&s), squares_free(&t);
}

/* Many entries at one place cost no more than elsewhere: not their products with each other, which would take minutes. */
GPROJT_TEST(entries_that_repeat) {
    int32_t k, count = 200000;
    squares s = squares_of(2, 2, 2 * count);
    for (k = 0; k < 2 * count; ++k) s.row[k] = k % 2, s.value[k] = k < count ? 1 : k % 4 - 1.5;
    s.start[1] = count, s.start[2] = 2 * count;
    s.b[0] = 3 * (double)count, s.b[1] = 5 * (double)count; /* x / 2 - y / 4, x / 2 + y / 4 */
    GPROJT_CHECK(solve(&s).outcome == GPROJ_LEAST_SQUARES_SOLVED);
    GPROJT_NEAR(s.x[0] / 2 - s.x[1] / 4, 3, 1e-9);
    GPROJT_NEAR(s.x[0] / 2 + s.x[1] / 4, 5, 1e-9);
    squares_free(&s);
}

/* Sums of so many products are rounded by more than the proximity in the matrix: where two columns are multiples of each other
   it may have no factor, and gets a larger one. */
GPROJT_TEST(singular_by_rounding) {
    enum {
        ROWS = 81000
    };
    squares s = squares_of(ROWS, 2, 2 * ROWS);
    double factor;
    int32_t i, again = 0;
    s.start[1] = ROWS, s.start[2] = 2 * ROWS;
    for (i = 0; i < ROWS; ++i) s.row[i] = s.row[ROWS + i] = i, s.value[i] = 0.1, s.b[i] = 1;
    for (factor = 1.3; factor < 100; factor *= 1.2) {
        gproj_least_squares_result r;
        for (i = 0; i < ROWS; ++i) s.value[ROWS + i] = 0.1 * factor;
        s.x[0] = s.x[1] = 0;
        r = solve(&s);
        GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && r.residual <= 1e-9 && r.kkt <= 1e-12);
        again += r.factorisations > 1;
    }
    GPROJT_CHECK(again > 0);
    squares_free(&s);
}

/* x - y = 3 from far along x = y, where the terms' rounding hides the 3: not called solved there, and solved nearby. */
GPROJT_TEST(far_starts) {
    static const double starts[] = {1e12, 1e15, 1e20, 1e50};
    int32_t k;
    for (k = 0; k < 8; ++k) {
        squares s = squares_of(1, 2, 2);
        gproj_least_squares_result r;
        s.value[0] = 1, s.value[1] = -1, s.start[1] = 1, s.start[2] = 2, s.b[0] = 3;
        s.x[0] = s.x[1] = starts[k % 4];
        if (k < 4) s.p.lower = NULL;
        r = solve(&s);
        GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED);
        GPROJT_NEAR(s.x[0] - s.x[1], 3, 1e-9);
        GPROJT_CHECK(fabs(s.x[0]) < 100);
        squares_free(&s);
    }
}

/* a x = a: no digits are left in products of the smallest numbers, and then nothing is called solved. */
GPROJT_TEST(products_that_underflow) {
    static const double sizes[] = {1e50, 1e-100, 1e-150, 1e-155, 1e-160, 1e-165, 1e-200, 1e-300};
    int32_t k;
    for (k = 0; k < 8; ++k) {
        squares s = squares_of(1, 1, 1);
        s.value[0] = s.b[0] = sizes[k], s.start[1] = 1;
        if (solve(&s).outcome == GPROJ_LEAST_SQUARES_SOLVED)
            GPROJT_NEAR(s.x[0], 1, 1e-9);
        else
            GPROJT_CHECK(k > 2);
        squares_free(&s);
    }
}

/* The same problem in the smallest units that still have all digits in all products; in smaller ones, where products are 0, it is
   not said to be solved unless it is. */
GPROJT_TEST(tiny_numbers) {
    int32_t k, unit, i, j;
    for (k = 0; k < 20; ++k) {
        uint64_t seed = 40 + (uint64_t)k;
        squares s = random_squares(20, 20, 1.0, &seed);
        int32_t factorisations = check_solved(&s, 10).factorisations;
        double x[20];
        memcpy(x, s.x, sizeof x);
        for (unit = -480; unit >= -1000; unit -= 260) {
            uint64_t again = 40 + (uint64_t)k;
            squares t = random_squares(20, 20, 1.0, &again);
            gproj_least_squares_result r;
            for (i = 0; i < 20; ++i) t.b[i] = ldexp(t.b[i], unit);
            r = solve(&t);
            GPROJT_CHECK(unit < -480 ||
                         (r.outcome == GPROJ_LEAST_SQUARES_SOLVED && r.factorisations == factorisations));
            for (j = 0; j < 20; ++j) {
                GPROJT_CHECK(t.x[j] >= 0);
                GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_LIMIT || fabs(ldexp(t.x[j], -unit) - x[j]) <= 1e-9);
            }
            squares_free(&t);
        }
        squares_free(&s);
    }
}

/* +-1e50 are bounds like others, and a variable without a bound may go beyond them. */
GPROJT_TEST(unbounded_means_unbounded) {
    squares s = squares_of(3, 3, 3);
    gproj_least_squares_result r;
    int32_t j;
    s.p.upper = s.upper;
    for (j = 0; j < 3; ++j) s.row[j] = j, s.value[j] = 1e-20, s.start[j + 1] = j + 1, s.b[j] = j == 1 ? -1e40 : 1e40;
    s.lower[0] = -HUGE_VAL, s.upper[0] = HUGE_VAL; /* 1e60 */
    s.lower[1] = -1e50, s.upper[1] = 1e50;         /* would be -1e60 */
    s.lower[2] = -1e50, s.upper[2] = HUGE_VAL;
    r = solve(&s);
    GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && r.at_bounds == 1);
    GPROJT_NEAR(s.x[0], 1e60, 1e48);
    GPROJT_CHECK(s.x[1] == -1e50);
    GPROJT_NEAR(s.x[2], 1e60, 1e48);
    squares_free(&s);
}

GPROJT_TEST(empty) {
    squares s = squares_of(3, 0, 0), t = squares_of(0, 3, 0);
    gproj_least_squares_result r;
    s.b[0] = 3, s.b[1] = 4;
    r = solve(&s);
    GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && r.residual == 5 && r.factorisations == 0);
    s.p.start = NULL, s.p.row = NULL, s.p.value = NULL, s.p.lower = NULL;
    GPROJT_CHECK(gproj_solve_least_squares(&s.p, NULL, NULL, NULL, NULL) == GPROJ_OK);
    t.x[0] = -1, t.x[1] = 2;
    t.p.row = NULL, t.p.value = NULL, t.p.b = NULL;
    r = solve(&t);
    GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && r.residual == 0 && r.at_bounds == 2);
    GPROJT_CHECK(t.x[0] == 0 && t.x[1] == 2 && t.x[2] == 0);
    t.p.damping = 1;
    r = solve(&t);
    GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && t.x[0] == 0 && fabs(t.x[1]) < 1e-15 && t.x[2] == 0);
    squares_free(&s), squares_free(&t);
}

/* -- forces in meshes -- */

/* A mesh with supported boundary: a column for each edge with an unsupported end, three rows for each unsupported
   vertex, sum w (v_i - v_j) + load_i = 0, with a unit load downwards at each. */
static squares forces_of(const gproj_mesh *mesh) {
    int32_t *number = (int32_t *)malloc((size_t)mesh->vertex_count * sizeof(int32_t)), v, e, d, side, unsupported = 0;
    int64_t at = 0;
    squares s;
    for (v = 0; v < mesh->vertex_count; ++v) number[v] = gproj_mesh_is_boundary_vertex(mesh, v) ? -1 : unsupported++;
    s = squares_of(3 * unsupported, mesh->edge_count, 6 * (int64_t)mesh->edge_count);
    s.p.columns = 0;
    for (e = 0; e < mesh->edge_count; ++e) {
        int64_t begin = at;
        for (side = 0; side < 2; ++side) {
            int32_t i = mesh->origin[2 * e + side], j = mesh->origin[2 * e + 1 - side];
            for (d = 0; number[i] >= 0 && d < 3; ++d) {
                s.row[at] = 3 * number[i] + d;
                s.value[at++] = mesh->position[3 * i + d] - mesh->position[3 * j + d];
            }
        }
        if (at > begin) s.start[++s.p.columns] = at;
    }
    for (v = 0; v < unsupported; ++v) s.b[3 * v + 2] = 1;
    free(number);
    return s;
}

enum {
    DOME,
    WAVE,
    FLAT,
    SADDLE,
    SHELL
};

/* A quad or triangle mesh over a square of side n, so that its edges are about 1 long. */
static squares roof(int32_t kind, int32_t n, bool triangles, double noise, uint64_t seed) {
    gprojt_soup soup = triangles ? gprojt_triangle_grid(n, n) : gprojt_quad_grid(n, n);
    gproj_mesh *mesh;
    squares s;
    int32_t v, d;
    for (v = 0; v < soup.vertex_count; ++v) {
        double *p = soup.position + 3 * v, x = 2 * p[0] - 1, y = 2 * p[1] - 1;
        p[0] *= n, p[1] *= n;
        if (kind == DOME) p[2] = 0.3 * n * (2 - x * x - y * y);
        if (kind == WAVE) p[2] *= n;
        if (kind == FLAT) p[2] = 0;
        if (kind == SHELL) p[2] = 0.02 * n * (2 - x * x - y * y);
        if (kind == SADDLE) p[2] = 0.2 * n * (x * x - y * y);
        for (d = 0; d < 3; ++d) p[d] += noise * (gprojt_uniform(&seed) - 0.5);
    }
    mesh = gprojt_soup_mesh(&soup, NULL, NULL);
    s = forces_of(mesh);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&soup);
    return s;
}

GPROJT_TEST(roofs) {
    static const int32_t sizes[3] = {5, 10, 25};
    int32_t k, kind, j;
    for (k = 0; k < 3; ++k)
        for (kind = DOME; kind <= SADDLE; ++kind)
            for (j = 0; j < 4; ++j) {
                squares s = roof(kind, sizes[k], j % 2 == 1, j < 2 ? 0 : 0.3, 11);
                gproj_least_squares_result r = check_solved(&s, 50);
                GPROJT_CHECK(r.factorisations <= (kind == WAVE ? 30 : 20));
                if (kind == DOME && j < 2) { /* stands, by its whole net */
                    GPROJT_CHECK(r.residual < 1e-9);
                    GPROJT_CHECK(r.at_bounds == 0);
                }
                if (kind == FLAT && j < 2) GPROJT_CHECK(r.at_bounds == s.p.columns && r.residual > 1);
                squares_free(&s);
            }
}

/* 10,000 vertices. */
GPROJT_TEST(large_roofs) {
#if defined(GPROJT_SANITIZED) || defined(GPROJT_COVERAGE) || defined(GPROJT_KERNELS)
    GPROJT_SKIP("large meshes are for plain builds");
#else
    static const int32_t kinds[4] = {DOME, WAVE, FLAT, SADDLE};
    int32_t k, j;
    for (k = 0; k < 4; ++k)
        for (j = 0; j < 2; ++j) {
            squares s = roof(kinds[k], 99, j == 1, k == 0 || k == 3 ? 0.05 : 0.3, 12);
            gproj_least_squares_result r = check_solved(&s, 200);
            GPROJT_CHECK(r.factorisations <= (kinds[k] == DOME || kinds[k] == SADDLE ? 20 : 30));
            GPROJT_CHECK(r.at_bounds > 50);
            squares_free(&s);
        }
#endif
}

/* Compression in shallow shells with uneven loads: columns depend on others to all but a few digits, so that exchanges lead
   nowhere for long. Where no solution is found, the result still is the best point met, near a solution; never the start. */
GPROJT_TEST(shallow_shells) {
#if defined(GPROJT_SANITIZED) || defined(GPROJT_COVERAGE) || defined(GPROJT_KERNELS)
    GPROJT_SKIP("large meshes are for plain builds");
#else
    int32_t size, i, solved = 0;
    for (size = 39; size <= 119; size += 20) {
        uint64_t seed = 21;
        squares s = roof(SHELL, size, true, 0, 1);
        gproj_least_squares_result r;
        double load = 0;
        for (i = 0; i < s.p.rows; ++i) s.b[i] *= 1 + gprojt_uniform(&seed), load += s.b[i] * s.b[i];
        r = solve(&s);
        GPROJT_CHECK(r.kkt <= 1e-6 && r.residual <= 0.01 * sqrt(load));
        GPROJT_NEAR(r.kkt, kkt_of(&s, s.x), 1e-2 * r.kkt + 1e-10);
        solved += r.outcome == GPROJ_LEAST_SQUARES_SOLVED;
        squares_free(&s);
    }
    GPROJT_CHECK(solved >= 3);
#endif
}

GPROJT_TEST(real_meshes) {
    int32_t k;
    gproj_error error;
    for (k = 0; k < GPROJT_REAL_MESHES; ++k) {
        gproj_mesh *mesh = gprojt_load_real_mesh(k, NULL, &error);
        squares s;
        gproj_least_squares_result r;
        double length = 0;
        int32_t i;
        if (!mesh) GPROJT_SKIP("no folder of real meshes");
        for (i = 0; i < mesh->edge_count; ++i) length += gprojt_edge_length(mesh, i) / mesh->edge_count;
        for (i = 0; i < 3 * mesh->vertex_count; ++i) mesh->position[i] /= length;
        s = forces_of(mesh);
        r = check_solved(&s, 100);
        GPROJT_CHECK(r.factorisations <= 20);
        gproj_mesh_destroy(mesh);
        squares_free(&s);
    }
}

/* The solution as start costs nothing; after a small change of b the neighbourhood is enough. */
GPROJT_TEST(starts) {
    squares s = roof(WAVE, 20, false, 0.2, 13);
    gproj_least_squares_result r = check_solved(&s, 50), q;
    double *x = (double *)malloc((size_t)s.p.columns * sizeof(double));
    int32_t i;
    memcpy(x, s.x, (size_t)s.p.columns * sizeof(double));
    q = check_solved(&s, 50);
    GPROJT_CHECK(q.factorisations == 0 && q.residual == r.residual && q.at_bounds == r.at_bounds);
    GPROJT_CHECK(!memcmp(x, s.x, (size_t)s.p.columns * sizeof(double)));
    for (i = 0; i < s.p.rows; ++i) s.b[i] *= 1.0001;
    q = check_solved(&s, 50);
    GPROJT_CHECK(q.factorisations == 1);
    for (i = 0; i < s.p.columns; ++i) s.x[i] = 1e6 * (i % 3) - 1e5; /* a senseless one */
    q = check_solved(&s, 50);
    GPROJT_CHECK(q.factorisations == r.factorisations);
    free(x);
    squares_free(&s);
}

/* A start near the solution, but off the bounds that it should be at, is no worse than none; nor is one that is further off than
   numbers reach. */
GPROJT_TEST(starts_beside_the_bounds) {
    int32_t k, i;
    for (k = 0; k < 10; ++k) {
        squares s = roof(WAVE, 10, k % 2 == 1, 0.2, 50 + (uint64_t)k);
        double residual = check_solved(&s, 50).residual;
        for (i = 0; i < s.p.columns; ++i) s.x[i] += 1e-6 * (1 + i % 3);
        GPROJT_NEAR(check_solved(&s, 50).residual, residual, 1e-9);
        squares_free(&s);
    }
    {
        squares s = squares_of(2, 2, 2);
        s.row[1] = 1, s.value[0] = s.value[1] = 1, s.start[1] = 1, s.start[2] = 2;
        s.b[0] = 1e-290, s.b[1] = -1e-290;
        s.x[0] = s.x[1] = 1e50;
        check_solved(&s, 1e-150);
        GPROJT_NEAR(s.x[0], 1e-290, 1e-304);
        GPROJT_CHECK(s.x[1] == 0);
        squares_free(&s);
    }
}

GPROJT_TEST(deterministic) {
    int32_t k;
    for (k = 0; k < 2; ++k) {
        squares s = roof(SADDLE, 15, k == 1, 0.1, 14), t = roof(SADDLE, 15, k == 1, 0.1, 14);
        gproj_least_squares_result r = solve(&s), q = solve(&t);
        GPROJT_CHECK(r.factorisations == q.factorisations && r.kkt == q.kkt && r.residual == q.residual);
        GPROJT_CHECK(!memcmp(s.x, t.x, (size_t)s.p.columns * sizeof(double)));
        squares_free(&s), squares_free(&t);
    }
}

/* -- failures -- */

/* Fails with this code, leaves x as it is, and says so. */
static void check_refused(const gproj_least_squares *p, double *x, gproj_code wanted, gproj_place place,
                          int64_t index) {
    gproj_least_squares_result r;
    gproj_error error;
    double before = x ? x[0] : 0;
    GPROJT_CHECK(gproj_solve_least_squares(p, NULL, x, &r, &error) == wanted);
    GPROJT_CHECK(error.code == wanted && error.place == place && error.index == index && error.message[0]);
    GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_FAILED && r.factorisations == 0);
    GPROJT_CHECK(gproj_solve_least_squares(p, NULL, x, NULL, NULL) == wanted);
    if (x) GPROJT_CHECK(memcmp(&before, x, sizeof before) == 0);
}

GPROJT_TEST(bad_arguments) {
    uint64_t seed = 15;
    squares s = random_squares(10, 8, 0.5, &seed);
    gproj_least_squares p = s.p;
    volatile double zero = 0;
    double nan = zero / zero, infinity = HUGE_VAL;
    gproj_error error;
    s.x[0] = 0.25;
    check_refused(NULL, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1);
    check_refused(&p, NULL, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1);
    p.columns = -1, check_refused(&p, s.x, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1), p = s.p;
    p.rows = -1, check_refused(&p, s.x, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1), p = s.p;
    p.columns = INT32_MAX, check_refused(&p, s.x, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1), p = s.p;
    p.start = NULL, check_refused(&p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1), p = s.p;
    p.row = NULL, check_refused(&p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1), p = s.p;
    p.value = NULL, check_refused(&p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1), p = s.p;
    p.b = NULL, check_refused(&p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1), p = s.p;
    p.damping = -1, check_refused(&p, s.x, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1), p = s.p;
    p.damping = nan, check_refused(&p, s.x, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1), p = s.p;
    p.damping = infinity, check_refused(&p, s.x, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1), p = s.p;
    p.damping = 1e60, gproj_solve_least_squares(&p, NULL, s.x, NULL, &error), p = s.p;
    GPROJT_CHECK(error.code == GPROJ_ERROR_NUMBER && strstr(error.message, "1e+60, not 0 to 1e50"));
    p.rows = 3, check_refused(&p, s.x, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, 0), p = s.p;
    s.b[4] = nan, check_refused(&p, s.x, GPROJ_ERROR_NUMBER, GPROJ_PLACE_ROW, 4), s.b[4] = 1;
    s.b[4] = 1e60, check_refused(&p, s.x, GPROJ_ERROR_NUMBER, GPROJ_PLACE_ROW, 4), s.b[4] = 1;
    s.x[3] = infinity, check_refused(&p, s.x, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VARIABLE, 3), s.x[3] = 1;
    s.value[s.start[2]] = nan, check_refused(&p, s.x, GPROJ_ERROR_NUMBER, GPROJ_PLACE_COLUMN, 2),
    s.value[s.start[2]] = 1;
    s.row[s.start[2]] = -1, check_refused(&p, s.x, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, 2), s.row[s.start[2]] = 1;
    s.start[0] = 1, check_refused(&p, s.x, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, 0), s.start[0] = 0;
    s.start[5] = 0, check_refused(&p, s.x, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, 4);
    s.start[1] = 1000000; /* no entry is read before all starts are known to ascend */
    check_refused(&p, s.x, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, 1);
    squares_free(&s);
}

GPROJT_TEST(bad_bounds) {
    uint64_t seed = 16;
    squares s = random_squares(10, 8, 0.5, &seed);
    volatile double zero = 0;
    double nan = zero / zero, infinity = HUGE_VAL;
    gproj_error error;
    int32_t j;
    s.p.upper = s.upper;
    for (j = 0; j < 8; ++j) s.upper[j] = 1;
    s.upper[3] = -0.5, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 3), s.upper[3] = 1;
    s.upper[3] = nan, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 3), s.upper[3] = 1;
    s.upper[3] = -infinity, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 3), s.upper[3] = 1;
    s.upper[3] = -1e70, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 3), s.upper[3] = 1;
    s.lower[6] = infinity, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 6), s.lower[6] = 0;
    s.lower[6] = 1e70, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 6), s.lower[6] = 0;
    s.lower[6] = -nan, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 6), s.lower[6] = 0;
    s.lower[5] = -1e60, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 5), s.lower[5] = 0;
    s.upper[5] = 1e60, check_refused(&s.p, s.x, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, 5), s.upper[5] = 1;
    s.upper[2] = -0.5;
    gproj_solve_least_squares(&s.p, NULL, s.x, NULL, &error);
    GPROJT_CHECK(strstr(error.message, "lower[2] = 0 is above upper[2] = -0.5"));
    s.upper[2] = nan;
    gproj_solve_least_squares(&s.p, NULL, s.x, NULL, &error);
    GPROJT_CHECK(strstr(error.message, "upper[2] is ") && strstr(error.message, "or INFINITY for none"));
    s.lower[2] = 1e60; /* and of two wrong ones the first is told */
    gproj_solve_least_squares(&s.p, NULL, s.x, NULL, &error);
    GPROJT_CHECK(strstr(error.message, "lower[2] is 1e+60, but") && strstr(error.message, "or -INFINITY for none"));
    s.lower[2] = 0, s.upper[2] = 1;
    check_solved(&s, 8);
    squares_free(&s);
}

static bool solve_with(const gproj_host *host, void *user) {
    squares *s = (squares *)user;
    gproj_error error;
    gproj_least_squares_result r;
    gproj_code code;
    s->x[0] = 0.125, s->x[1] = -3;
    code = gproj_solve_least_squares(&s->p, host, s->x, &r, &error);
    if (code == GPROJ_OK) {
        GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED);
        GPROJT_CHECK(r.memory.used > 0 && r.factor_bytes > 0 && r.work_bytes > 0);
    } else {
        GPROJT_CHECK(code == GPROJ_ERROR_MEMORY && error.code == GPROJ_ERROR_MEMORY && error.message[0]);
        GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_FAILED && s->x[0] == 0.125 && s->x[1] == -3);
    }
    return code == GPROJ_OK;
}

/* The solution of a problem almost like it is the start, and nobody asks for the error. */
static bool solve_from_near(const gproj_host *host, void *user) {
    squares *s = (squares *)user;
    gproj_least_squares_result r;
    int32_t j;
    gproj_code code;
    for (j = 0; j < s->p.columns; ++j) s->x[j] = s->upper[j];
    code = gproj_solve_least_squares(&s->p, host, s->x, &r, NULL);
    if (code == GPROJ_OK) {
        GPROJT_CHECK(r.outcome == GPROJ_LEAST_SQUARES_SOLVED && r.factorisations == 1);
    } else {
        GPROJT_CHECK(code == GPROJ_ERROR_MEMORY && r.outcome == GPROJ_LEAST_SQUARES_FAILED);
        GPROJT_CHECK(memcmp(s->x, s->upper, (size_t)s->p.columns * sizeof(double)) == 0);
    }
    return code == GPROJ_OK;
}

/* A residual whose square is too small for a double. */
GPROJT_TEST(tiny_residuals) {
    static const int64_t start[2] = {0, 2};
    static const int32_t row[2] = {0, 1};
    static const double value[2] = {1, 1}, b[2] = {1e-170, -1e-170};
    gproj_least_squares problem;
    gproj_least_squares_result result;
    double x = 0;
    memset(&problem, 0, sizeof problem);
    problem.rows = 2, problem.columns = 1, problem.start = start, problem.row = row, problem.value = value, problem.b = b;
    GPROJT_CHECK(gproj_solve_least_squares(&problem, NULL, &x, &result, NULL) == GPROJ_OK);
    GPROJT_CHECK(result.outcome == GPROJ_LEAST_SQUARES_SOLVED && x == 0);
    GPROJT_NEAR(result.residual / 1e-170, sqrt(2.0), 1e-12);
}

/* All memory is the host's. */
GPROJT_TEST(memory_of_the_host) {
    uint64_t seed = 6;
    squares s = random_squares(2000, 2, 1, &seed); /* whose factor is nothing beside the rows */
    gproj_least_squares_result r;
    gprojt_failing failing;
    gproj_host host;
    memset(&failing, 0, sizeof failing);
    host = gprojt_failing_host(&failing);
    GPROJT_CHECK(gproj_solve_least_squares(&s.p, &host, s.x, &r, NULL) == GPROJ_OK);
    GPROJT_CHECK(r.memory.peak > 30000 && failing.peak >= r.memory.peak && failing.held == 0);
    squares_free(&s);
}

GPROJT_TEST(failing_allocations) {
    squares s = roof(SADDLE, 6, true, 0.2, 17);
    int32_t i;
    GPROJT_CHECK(gprojt_fail_every_allocation(solve_with, &s) >= 10);
    solve(&s);
    memcpy(s.upper, s.x, (size_t)s.p.columns * sizeof(double));
    for (i = 0; i < s.p.rows; ++i) s.b[i] *= 1.0001;
    GPROJT_CHECK(gprojt_fail_every_allocation(solve_from_near, &s) >= 10);
    squares_free(&s);
    s = squares_of(2, 2, 4); /* two entries at the same place: they are summed in arrays of their own */
    s.row[2] = s.row[3] = 1, s.value[0] = s.value[1] = s.value[2] = s.value[3] = 1;
    s.start[1] = 3, s.start[2] = 4;
    s.b[0] = 4, s.b[1] = 7;
    GPROJT_CHECK(gprojt_fail_every_allocation(solve_with, &s) >= 10);
    GPROJT_NEAR(s.x[0], 2, 1e-10);
    GPROJT_NEAR(s.x[1], 5, 1e-10);
    squares_free(&s);
}

int main(void) {
    GPROJT_RUN(small_problems_against_all_sets);
    GPROJT_RUN(against_lawson_hanson);
    GPROJT_RUN(sparse_problems);
    GPROJT_RUN(dependent_columns);
    GPROJT_RUN(units);
    GPROJT_RUN(ill_conditioned);
    GPROJT_RUN(all_factorisations);
    GPROJT_RUN(damping);
    GPROJT_RUN(all_bounds_hold);
    GPROJT_RUN(fixed_variables);
    GPROJT_RUN(bounds_that_are_neighbours);
    GPROJT_RUN(without_bounds);
    GPROJT_RUN(columns_of_all_sizes);
    GPROJT_RUN(rounding_hides_no_violation);
    GPROJT_RUN(cancellation_is_noise);
    GPROJT_RUN(fixed_variables_leave_no_doubt);
    GPROJT_RUN(entries_that_cancel);
    GPROJT_RUN(entries_that_repeat);
    GPROJT_RUN(singular_by_rounding);
    GPROJT_RUN(far_starts);
    GPROJT_RUN(products_that_underflow);
    GPROJT_RUN(tiny_numbers);
    GPROJT_RUN(unbounded_means_unbounded);
    GPROJT_RUN(empty);
    GPROJT_RUN(roofs);
    GPROJT_RUN(large_roofs);
    GPROJT_RUN(shallow_shells);
    GPROJT_RUN(real_meshes);
    GPROJT_RUN(starts);
    GPROJT_RUN(starts_beside_the_bounds);
    GPROJT_RUN(deterministic);
    GPROJT_RUN(bad_arguments);
    GPROJT_RUN(bad_bounds);
    GPROJT_RUN(tiny_residuals);
    GPROJT_RUN(memory_of_the_host);
    GPROJT_RUN(failing_allocations);
    return gprojt_report();
}
