/* test_bound.c - bounds: rows that must be >= 0, in systems. */
#define GPROJ_STATIC
#include "gprojt_form.h"

static gproj_system *gprojt_system(const gproj_host *host, int32_t count, const double *x) {
    gproj_system *s = gproj_system_create(host);
    gproj_system_add_variables(s, count, 1, x);
    return s;
}

/* The row a'x + c >= 0 of all variables. */
static void gprojt_add_plane(gproj_system *s, int32_t group, int32_t count, const double *a, double c,
                             int32_t element) {
    gproj_term term[1024];
    int32_t k;
    for (k = 0; k < count; ++k) term[k] = gprojt_term(k, -1, a[k]);
    gproj_system_add_row(s, group, count, term, c, element);
}

/* The row (r^2 - |x - c|^2) / (2 r) >= 0 in the plane: x is in the disc. */
static void gprojt_add_disc(gproj_system *s, int32_t group, const double c[2], double r, int32_t element) {
    gproj_term term[4];
    int32_t k;
    for (k = 0; k < 2; ++k) {
        term[k] = gprojt_term(k, k, -0.5 / r);
        term[2 + k] = gprojt_term(k, -1, c[k] / r);
    }
    gproj_system_add_row(s, group, 4, term, (r * r - c[0] * c[0] - c[1] * c[1]) / (2 * r), element);
}

/* -- polytopes: the nearest point by trying every set of faces -- */

enum {
    PLANES = 7
};

typedef struct gprojt_polytope {
    int32_t planes;
    double a[PLANES][3], c[PLANES];
} gprojt_polytope;

/* Random half-spaces that hold a ball about the origin. */
static gprojt_polytope gprojt_random_polytope(uint64_t *seed) {
    gprojt_polytope p;
    int32_t i, k;
    p.planes = 3 + gprojt_below(seed, PLANES - 2);
    for (i = 0; i < p.planes; ++i) {
        double length = 0;
        for (k = 0; k < 3; ++k) {
            p.a[i][k] = 2 * gprojt_uniform(seed) - 1;
            length += p.a[i][k] * p.a[i][k];
        }
        for (k = 0; k < 3; ++k) p.a[i][k] /= sqrt(length);
        p.c[i] = 0.2 + gprojt_uniform(seed);
    }
    return p;
}

static double gprojt_plane_at(const gprojt_polytope *p, int32_t i, const double x[3]) {
    return p->a[i][0] * x[0] + p->a[i][1] * x[1] + p->a[i][2] * x[2] + p->c[i];
}

/* Solves the n x n system m z = b by elimination with pivots; false where it is nearly singular. */
static bool gprojt_solve_small(int32_t n, double m[3][3], double *b) {
    int32_t i, j, k;
    for (i = 0; i < n; ++i) {
        int32_t best = i;
        double swap;
        for (j = i; j < n; ++j)
            if (fabs(m[j][i]) > fabs(m[best][i])) best = j;
        if (fabs(m[best][i]) < 1e-9) return false;
        for (k = 0; k < n; ++k) swap = m[i][k], m[i][k] = m[best][k], m[best][k] = swap;
        swap = b[i], b[i] = b[best], b[best] = swap;
        for (j = i + 1; j < n; ++j) {
            double f = m[j][i] / m[i][i];
            for (k = i; k < n; ++k) m[j][k] -= f * m[i][k];
            b[j] -= f * b[i];
        }
    }
    for (i = n - 1; i >= 0; --i) {
        for (k = i + 1; k < n; ++k) b[i] -= m[i][k] * b[k];
        b[i] /= m[i][i];
    }
    return true;
}

/* The nearest point of the polytope to p, by the conditions of Karush, Kuhn and Tucker: for each set of at most three
   faces the nearest point on all of them; right is the one inside with all multipliers >= 0. */
static bool gprojt_nearest(const gprojt_polytope *p, const double from[3], double out[3]) {
    int32_t set;
    for (set = 0; set < 1 << p->planes; ++set) {
        double m[3][3], z[3];
        int32_t face[3], count = 0, i, j, k;
        bool good = true;
        for (i = 0; i < p->planes && count <= 3; ++i)
            if (set >> i & 1) {
                if (count < 3) face[count] = i;
                ++count;
            }
        if (count > 3) continue;
        for (i = 0; i < count; ++i) {
            for (j = 0; j < count; ++j)
                m[i][j] = p->a[face[i]][0] * p->a[face[j]][0] + p->a[face[i]][1] * p->a[face[j]][1] +
                          p->a[face[i]][2] * p->a[face[j]][2];
            z[i] = -gprojt_plane_at(p, face[i], from);
        }
        if (!gprojt_solve_small(count, m, z)) continue;
        for (k = 0; k < 3; ++k) {
            out[k] = from[k];
            for (i = 0; i < count; ++i) out[k] += z[i] * p->a[face[i]][k];
        }
        for (i = 0; i < count; ++i) good = good && z[i] >= -1e-12;
        for (i = 0; i < p->planes; ++i) good = good && gprojt_plane_at(p, i, out) >= -1e-12;
        if (good) return true;
    }
    return false;
}

/* Steps are the shortest ones, so they lead to the nearest point of a polytope, mostly: not where the rows that act
   have not settled after 3 rounds. */
GPROJT_TEST(nearest_points_of_polytopes) {
    uint64_t seed = 5;
    int32_t i, k, n, outside = 0, exact = 0;
    for (n = 0; n < 300; ++n) {
        gprojt_polytope p = gprojt_random_polytope(&seed);
        double from[3], nearest[3], *x, far;
        gproj_system *s;
        gproj_result result;
        for (k = 0; k < 3; ++k) from[k] = 6 * gprojt_uniform(&seed) - 3;
        s = gprojt_system(NULL, 3, from);
        x = gproj_system_values(s);
        gprojt_add_group(s, "planes", GPROJ_BOUND, 1);
        for (i = 0; i < p.planes; ++i) gprojt_add_plane(s, 0, 3, p.a[i], p.c[i], i);
        result = gproj_system_solve(s, 20, NULL);
        GPROJT_REQUIRE(gprojt_nearest(&p, from, nearest));
        far = gprojt_far(from, nearest);
        outside += far > 0;
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 6);
        for (i = 0; i < p.planes; ++i) GPROJT_CHECK(gprojt_plane_at(&p, i, x) >= -1e-12);
        exact += gprojt_far(x, nearest) <= 1e-4;
        GPROJT_CHECK(gprojt_far(x, from) <= 3 * far + 1e-12);
        if (!(far > 0)) GPROJT_CHECK(result.iterations == 0 && gprojt_far(x, from) == 0);
        gproj_system_destroy(s);
    }
    GPROJT_CHECK(outside > 150 && exact >= 275);
}

/* Inequalities that one point satisfies, half of them just so: whichever sets of rows a step tries, one is found. */
GPROJT_TEST(inequalities_that_can_hold) {
    uint64_t seed = 8;
    int32_t trial, i, k;
    for (trial = 0; trial < 3000; ++trial) {
        int32_t n = 2 + gprojt_below(&seed, 5), rows = 1 + gprojt_below(&seed, 14), group;
        double inside[6], start[6], a[6];
        gproj_system *s;
        for (k = 0; k < n; ++k)
            start[k] = 10 * gprojt_uniform(&seed) - 5, inside[k] = 4 * gprojt_uniform(&seed) - 2;
        s = gprojt_system(NULL, n, start);
        group = gprojt_add_group(s, "inequalities", GPROJ_BOUND, 1);
        for (i = 0; i < rows; ++i) {
            double c = gprojt_below(&seed, 2) ? 0 : 0.1 * gprojt_uniform(&seed);
            for (k = 0; k < n; ++k) {
                a[k] = 2 * gprojt_uniform(&seed) - 1;
                c -= a[k] * inside[k];
            }
            gprojt_add_plane(s, group, n, a, c, i);
        }
        GPROJT_CHECK(gproj_system_solve(s, 100, NULL).outcome == GPROJ_CONVERGED);
        gproj_system_destroy(s);
    }
}

/* A point that must be in several discs; where two of them have nothing in common, the truth. */
GPROJT_TEST(discs) {
    static const double centre[3][2] = {{0, 0}, {1.5, 0}, {0.7, 1.4}}, apart[2][2] = {{0, 0}, {5, 0}};
    int32_t i, n;
    uint64_t seed = 9;
    for (n = 0; n < 50; ++n) {
        double from[2], *x;
        gproj_system *s;
        gproj_result result;
        from[0] = 20 * gprojt_uniform(&seed) - 10, from[1] = 20 * gprojt_uniform(&seed) - 10;
        s = gprojt_system(NULL, 2, from);
        x = gproj_system_values(s);
        gprojt_add_group(s, "discs", GPROJ_BOUND, 1);
        for (i = 0; i < 3; ++i) gprojt_add_disc(s, 0, centre[i], 1, i);
        result = gproj_system_solve(s, 30, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 10);
        for (i = 0; i < 3; ++i) GPROJT_CHECK(hypot(x[0] - centre[i][0], x[1] - centre[i][1]) <= 1 + 1e-12);
        gproj_system_destroy(s);
        if (n % 2) from[1] = 0;
        s = gprojt_system(NULL, 2, from);
        x = gproj_system_values(s);
        gprojt_add_group(s, "left", GPROJ_BOUND, 1);
        gprojt_add_group(s, "right", GPROJ_BOUND, 1);
        for (i = 0; i < 2; ++i) gprojt_add_disc(s, i, apart[i], 1, 70 + i);
        result = gproj_system_solve(s, 100, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_STALLED && strstr(result.message, "'left'") != NULL);
        GPROJT_CHECK(strstr(result.message, "work against each other") && strstr(result.message, ", vertex 7"));
        GPROJT_CHECK(result.residual >= (2.5 * 2.5 - 1) / 2 - 1e-9 && result.residual < 5);
        if (n % 2) GPROJT_NEAR(x[0], 2.5, 1e-2);
        if (n % 2) GPROJT_NEAR(result.residual, (2.5 * 2.5 - 1) / 2, 2e-2);
        gproj_system_destroy(s);
    }
}

/* A box without an inside, in one group. */
GPROJT_TEST(empty_box) {
    static const double x[2] = {7, -7};
    gproj_system *s = gprojt_system(NULL, 2, x);
    gproj_result result;
    gprojt_add_group(s, "box", GPROJ_BOUND, 1);
    gprojt_add_linear(s, 0, 0, 1, -1, 10); /* x >= 1 */
    gprojt_add_linear(s, 0, 0, -1, 0, 11); /* x <= 0 */
    gprojt_add_linear(s, 0, 1, 1, -3, 12); /* y >= 3 */
    result = gproj_system_solve(s, 50, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && strstr(result.message, "(box, vertex 1"));
    GPROJT_NEAR(result.residual, 0.5, 1e-6);
    GPROJT_NEAR(gproj_system_values(s)[0], 0.5, 1e-6);
    GPROJT_NEAR(gproj_system_values(s)[1], 3, 1e-12);
    GPROJT_CHECK(result.worst_element == 10 || result.worst_element == 11);
    gproj_system_destroy(s);
}

/* Least squares with variables >= 0: a wish that stays on against many bounds; right by Karush, Kuhn and Tucker. */
GPROJT_TEST(least_squares_of_positive_numbers) {
    enum {
        N = 40
    };
    uint64_t seed = 31;
    int32_t i, j, n;
    for (n = 0; n < 10; ++n) {
        double a[N][N], b[N], gradient[N], *x;
        gproj_system *s = gprojt_system(NULL, N, NULL);
        int32_t zeros = 0;
        x = gproj_system_values(s);
        gprojt_add_group(s, "positive", GPROJ_BOUND, 1);
        gprojt_add_group(s, "fit", GPROJ_WISH, 1e-3);
        gproj_system_set_schedule(s, 1, gprojt_schedule(1e-3, 1, 1000));
        for (i = 0; i < N; ++i) {
            x[i] = 2 * gprojt_uniform(&seed) - 1;
            gprojt_add_linear(s, 0, i, 1, 0, i);
            for (j = 0; j < N; ++j) a[i][j] = (i == j) + 0.1 * (2 * gprojt_uniform(&seed) - 1);
            b[i] = 2 * gprojt_uniform(&seed) - 1;
            gprojt_add_plane(s, 1, N, a[i], -b[i], i);
        }
        gproj_system_solve(s, 60, NULL);
        memset(gradient, 0, sizeof gradient);
        for (i = 0; i < N; ++i) {
            double r = -b[i];
            for (j = 0; j < N; ++j) r += a[i][j] * x[j];
            for (j = 0; j < N; ++j) gradient[j] += a[i][j] * r;
        }
        for (i = 0; i < N; ++i) {
            GPROJT_CHECK(x[i] >= -1e-5 && gradient[i] >= -1e-4 && fabs(x[i] * gradient[i]) <= 1e-4);
            zeros += fabs(x[i]) < 1e-5;
        }
        GPROJT_CHECK(zeros > N / 5 && zeros < 4 * N / 5);
        gproj_system_destroy(s);
    }
}

/* -- bounds with constraints and wishes -- */

/* A circle, a wish to be at its right, and a bound that keeps from there. */
static gproj_system *gprojt_circle_and_bound(const gproj_host *host, double bound, bool with) {
    static const double x[2] = {0.3, 0.8};
    gproj_system *s = gprojt_system(host, 2, x);
    gproj_term circle[2];
    circle[0] = gprojt_term(0, 0, 0.5), circle[1] = gprojt_term(1, 1, 0.5);
    gprojt_add_group(s, "circle", GPROJ_CONSTRAINT, 1);
    gproj_system_add_row(s, 0, 2, circle, -0.5, 0);
    gprojt_add_group(s, "right", GPROJ_WISH, 0.1);
    gproj_system_set_schedule(s, 1, gprojt_schedule(0.1, 1, 8));
    gprojt_add_linear(s, 1, 0, 1, -1, 0);
    gprojt_add_linear(s, 1, 1, 1, 0, 0);
    if (with) gprojt_add_group(s, "left enough", GPROJ_BOUND, 1);
    if (with) gprojt_add_linear(s, 2, 0, -1, bound, 4);
    return s;
}

GPROJT_TEST(bounds_meet_constraints) {
    gproj_system *s = gprojt_circle_and_bound(NULL, 0.6, true);
    gproj_result result = gproj_system_solve(s, 20, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.damped > 0);
    GPROJT_NEAR(gproj_system_values(s)[0], 0.6, 1e-3); /* the wish drew it to the bound */
    GPROJT_CHECK(gproj_system_values(s)[0] <= 0.6 + 1e-13);
    GPROJT_NEAR(hypot(gproj_system_values(s)[0], gproj_system_values(s)[1]), 1, 1e-13);
    GPROJT_CHECK(gprojt_info(s, 2).max <= 1e-13 && gproj_system_check_gradients(s) < 1e-9);
    gproj_system_destroy(s);
}

/* Bounds that nothing reaches change no bit. */
GPROJT_TEST(distant_bounds_do_nothing) {
    gproj_system *with = gprojt_circle_and_bound(NULL, 50, true), *without = gprojt_circle_and_bound(NULL, 50, false);
    gproj_result a = gproj_system_solve(with, 20, NULL), b = gproj_system_solve(without, 20, NULL);
    GPROJT_CHECK(a.outcome == GPROJ_CONVERGED && a.iterations == b.iterations && a.damped == b.damped);
    GPROJT_CHECK(a.residual <= b.residual && b.residual <= a.residual);
    GPROJT_CHECK(!memcmp(gproj_system_values(with), gproj_system_values(without), 2 * sizeof(double)));
    gproj_system_destroy(with);
    gproj_system_destroy(without);
}

/* The tangent of a convex row says "violated" long before the row does: |x| >= 0.01 on the way from 1 to 0.1, and to a
   place where it just holds. */
GPROJT_TEST(tangents_of_convex_rows) {
    static const double x[2] = {1, 0}, places[2] = {0.1, 0.0101};
    gproj_term square[2];
    int32_t i, k;
    for (k = 0; k < 2; ++k) square[k] = gprojt_term(k, k, 50);
    for (i = 0; i < 2; ++i) {
        gproj_system *s = gprojt_system(NULL, 2, x);
        gproj_result result;
        gprojt_add_group(s, "away", GPROJ_BOUND, 1);
        gproj_system_add_row(s, 0, 2, square, -0.005, 0);
        gprojt_add_group(s, "place", GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 1, 0, 1, -places[i], 0);
        result = gproj_system_solve(s, 9, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.damped == 0);
        GPROJT_NEAR(gproj_system_values(s)[0], places[i], 1e-13);
        gproj_system_destroy(s);
    }
}

static bool gprojt_see_first(void *user, gproj_system *s, const gproj_iteration *iteration) {
    (void)s;
    if (iteration->number == 1) *(int32_t *)user = iteration->factorisations;
    return true;
}

/* A row that bends away from its tangent waits for the next step, where its linearisation tells that it is violated: from
   the border of a disc the first step goes along the tangent, found once. */
GPROJT_TEST(tangents_of_concave_rows) {
    static const double x[2] = {1, 0}, centre[2] = {0, 0};
    gproj_system *s = gprojt_system(NULL, 2, x);
    gproj_solve_options options;
    gproj_result result;
    int32_t first = 0;
    memset(&options, 0, sizeof options);
    options.on_iteration = gprojt_see_first, options.user = &first;
    gprojt_add_group(s, "disc", GPROJ_BOUND, 1);
    gprojt_add_disc(s, 0, centre, 1, 0);
    gprojt_add_group(s, "height", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 1, 1, 1, -0.6, 0);
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations > 1 && first == 1);
    GPROJT_NEAR(gproj_system_values(s)[0], 0.8, 1e-3);
    GPROJT_NEAR(gproj_system_values(s)[1], 0.6, 1e-12);
    gproj_system_destroy(s);
}

/* A bound lets go of what it has held: first the wish draws against it, then away. */
static bool gprojt_turn_round(void *user, gproj_system *s, const gproj_iteration *iteration) {
    (void)user;
    if (iteration->number == 4) {
        GPROJT_NEAR(gproj_system_values(s)[0], 0, 1e-3);
        gproj_system_set_row(s, 1, 0, NULL, 3);
    }
    return true;
}

GPROJT_TEST(bounds_let_go) {
    static const double x[1] = {-1};
    gproj_system *s = gprojt_system(NULL, 1, x);
    gproj_solve_options options;
    memset(&options, 0, sizeof options);
    options.on_iteration = gprojt_turn_round;
    gprojt_add_group(s, "not positive", GPROJ_BOUND, 1);
    gprojt_add_group(s, "wish", GPROJ_WISH, 0.01);
    gproj_system_set_schedule(s, 1, gprojt_schedule(0.01, 1, 100));
    gprojt_add_linear(s, 0, 0, -1, 0, 0);
    gprojt_add_linear(s, 1, 0, 1, -2, 0);
    gproj_system_solve(s, 9, &options);
    GPROJT_NEAR(gproj_system_values(s)[0], -3, 1e-3);
    gproj_system_destroy(s);
}

/* One row of 700 variables, and one that is global: both are kept out of the matrix. */
GPROJT_TEST(wide_bounds) {
    enum {
        N = 700
    };
    double ones[N];
    int32_t i, kind;
    for (i = 0; i < N; ++i) ones[i] = 1;
    for (kind = 0; kind < 3; ++kind) {
        gproj_system *s = gprojt_system(NULL, N, NULL);
        gproj_group group;
        gproj_result result;
        memset(&group, 0, sizeof group);
        group.name = "sum", group.kind = GPROJ_BOUND, group.global = kind == 1, group.schedule = gproj_keep(1);
        gproj_system_add_group(s, &group);
        gprojt_add_plane(s, 0, N, ones, -N, 0);                   /* sum >= N */
        if (kind == 2) gprojt_add_plane(s, 0, N, ones, 5 * N, 1); /* holds everywhere near */
        gprojt_add_group(s, "first", GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 1, 0, 1, -3, 0);
        result = gproj_system_solve(s, 9, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 4);
        for (i = 1; i < N; ++i) GPROJT_NEAR(gproj_system_values(s)[i], (N - 3.0) / (N - 1), 1e-6);
        gproj_system_values(s)[1] = 9; /* more than enough: nothing to do */
        result = gproj_system_solve(s, 9, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations == 0);
        gproj_system_destroy(s);
    }
}

/* -- what is reported -- */

GPROJT_TEST(violations_are_what_counts) {
    static const double x[3] = {5, -2, 1};
    gproj_system *s = gprojt_system(NULL, 3, x);
    gproj_group_info info;
    gproj_result result;
    gprojt_add_group(s, "positive", GPROJ_BOUND, 2);
    for (int32_t i = 0; i < 3; ++i) gprojt_add_linear(s, 0, i, 1, 0, 20 + i);
    result = gproj_system_solve(s, 0, NULL);
    info = gprojt_info(s, 0);
    GPROJT_CHECK(result.outcome == GPROJ_ITERATION_LIMIT && info.kind == GPROJ_BOUND && info.worst_element == 21);
    GPROJT_NEAR(result.residual, 2, 0);
    GPROJT_NEAR(info.max, 2, 0);
    GPROJT_NEAR(info.rms, 2 / sqrt(3.0), 1e-15);
    GPROJT_NEAR(gproj_system_row_value(s, 0, 0, NULL), 5, 0); /* the row itself says phi */
    gproj_system_set_row_weight(s, 0, 1, 0);
    result = gproj_system_solve(s, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations == 0 && gprojt_info(s, 0).max <= 0);
    gproj_system_set_row_weight(s, 0, 1, 1);
    gproj_system_set_schedule(s, 0, gprojt_schedule(0, 1, 0));
    result = gproj_system_solve(s, 5, NULL);
    GPROJT_CHECK(result.worst_group == -1 && gproj_system_values(s)[1] == -2); /* switched off: nothing must hold */
    gproj_system_destroy(s);
}

/* Rows that overflow are never a bound that holds. */
GPROJT_TEST(bounds_that_are_no_numbers) {
    static const double x[2] = {1e200, 1e200};
    gproj_term squares[2] = {{0, 0, 1}, {1, 1, -1}};
    gproj_system *s = gprojt_system(NULL, 2, x);
    gproj_result result;
    gprojt_add_group(s, "square", GPROJ_BOUND, 1);
    gproj_system_add_row(s, 0, 2, squares, 1, 7);
    result = gproj_system_solve(s, 9, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.worst_element == 7 && result.residual > 1e300);
    gproj_system_destroy(s);
}

/* The merit along a step with hinges: no sample is lower than its minimum, and its slope is that of its values. */
GPROJT_TEST(merits_with_hinges_are_minimised) {
    uint64_t seed = 78;
    int32_t n, k;
    for (n = 0; n < 500; ++n) {
        gproji_hinge hinge[6];
        gproji_course m;
        double t, least = HUGE_VAL, high = n % 2 ? 1 : 2;
        memset(&m, 0, sizeof m);
        for (k = 0; k < 6; ++k) {
            hinge[k].w2 = gprojt_uniform(&seed), hinge[k].phi = 2 * gprojt_uniform(&seed) - 1;
            hinge[k].h = 4 * gprojt_uniform(&seed) - 2, hinge[k].q = 2 * gprojt_uniform(&seed) - 1;
        }
        m.c[0] = hinge[0].w2 * hinge[0].phi * hinge[0].phi; /* w^2 (phi + t h + t^2 q)^2, whatever its sign */
        m.c[1] = hinge[0].w2 * 2 * hinge[0].phi * hinge[0].h;
        m.c[2] = hinge[0].w2 * (hinge[0].h * hinge[0].h + 2 * hinge[0].phi * hinge[0].q);
        m.c[3] = hinge[0].w2 * 2 * hinge[0].h * hinge[0].q;
        m.c[4] = hinge[0].w2 * hinge[0].q * hinge[0].q;
        m.hinge = hinge + 1, m.count = 5;
        t = gproji_minimise_merit(&m, 0.05, high);
        for (k = 0; k <= 4000; ++k) least = fmin(least, gproji_merit_at(&m, 0.05 + k * (high - 0.05) / 4000));
        GPROJT_CHECK(t >= 0.05 && t <= high && gproji_merit_at(&m, t) <= least + 1e-4 * (1 + least));
        if (t > 0.05 && t < high) GPROJT_NEAR(gproji_merit_slope(&m, t), 0, 1e-12);
        for (k = 0; k < 20; ++k) {
            double at = 2 * gprojt_uniform(&seed),
                   slope = (gproji_merit_at(&m, at + 1e-6) - gproji_merit_at(&m, at - 1e-6)) / 2e-6;
            GPROJT_NEAR(gproji_merit_slope(&m, at), slope, 1e-4);
        }
    }
}

/* The course of a step is the merit of the system at its points. */
GPROJT_TEST(the_course_is_the_merit) {
    gproj_system *s = gprojt_circle_and_bound(NULL, 0.35, true);
    gproji_loop loop;
    gproji_course m;
    int32_t k;
    memset(&loop, 0, sizeof loop);
    loop.system = s;
    GPROJT_REQUIRE(gproji_compile(s, false) == GPROJ_OK);
    gproji_set_weights(&loop, 1);
    gproji_linearise(&loop);
    memcpy(s->vector.saved, s->x, 2 * sizeof(double));
    s->vector.step[0] = 0.9, s->vector.step[1] = -0.7;
    gproji_take_step(s, 1);
    gproji_merit_along(s, &m);
    GPROJT_CHECK(m.count == 1);
    for (k = 0; k <= 20; ++k) {
        gproji_take_step(s, k * 0.1);
        gproji_evaluate(s);
        GPROJT_NEAR(gproji_take_standing(s).merit, gproji_merit_at(&m, k * 0.1), 1e-14);
    }
    gproj_system_destroy(s);
}

/* -- memory, workers -- */

/* Points in a row that push each other: |p_i - p_j| >= 1 for near ones, inside a disc. */
static gproj_system *gprojt_crowd(const gproj_host *host, int32_t count) {
    gproj_system *s = gproj_system_create(host);
    gproj_term term[8];
    double *x;
    uint64_t seed = 3;
    int32_t i, j, k;
    gproj_system_add_variables(s, 2 * count, 2, NULL);
    gprojt_add_group(s, "apart", GPROJ_BOUND, 1);
    gprojt_add_group(s, "inside", GPROJ_BOUND, 1);
    if (gproj_system_error(s)->code) return s;
    x = gproj_system_values(s);
    for (i = 0; i < 2 * count; ++i) x[i] = gprojt_uniform(&seed) * sqrt(count) * 1.5;
    for (i = 0; i < count; ++i) {
        for (j = i + 1; j < count; ++j) {
            for (k = 0; k < 2; ++k) {
                term[3 * k] = gprojt_term(2 * i + k, 2 * i + k, 0.5);
                term[3 * k + 1] = gprojt_term(2 * j + k, 2 * j + k, 0.5);
                term[3 * k + 2] = gprojt_term(2 * i + k, 2 * j + k, -1);
            }
            gproj_system_add_row(s, 0, 6, term, -0.5, i);
        }
        for (k = 0; k < 2; ++k) term[k] = gprojt_term(2 * i + k, 2 * i + k, -0.5 / count);
        gproj_system_add_row(s, 1, 2, term, 2, i);
    }
    return s;
}

GPROJT_TEST(a_crowd_finds_room) {
    gproj_system *s = gprojt_crowd(NULL, 60);
    const double *x = gproj_system_values(s);
    gproj_result result = gproj_system_solve(s, 100, NULL);
    int32_t i, j;
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gproj_system_check_gradients(s) < 1e-9);
    for (i = 0; i < 60; ++i) {
        GPROJT_CHECK(hypot(x[2 * i], x[2 * i + 1]) <= sqrt(4.0 * 60) + 1e-9);
        for (j = i + 1; j < 60; ++j) GPROJT_CHECK(hypot(x[2 * i] - x[2 * j], x[2 * i + 1] - x[2 * j + 1]) >= 1 - 1e-9);
    }
    gproj_system_destroy(s);
}

GPROJT_TEST(same_bits_for_all_workers) {
    double first[160];
    int crew;
    for (crew = 0; crew < GPROJT_CREWS; ++crew) {
        gproj_host host = gprojt_crew(crew);
        gproj_system *s = gprojt_crowd(&host, 80);
        gproj_system_solve(s, 12, NULL);
        if (crew == 0) memcpy(first, gproj_system_values(s), sizeof first);
        GPROJT_CHECK(!memcmp(first, gproj_system_values(s), sizeof first));
        gproj_system_destroy(s);
    }
}

/* A second solve from the same start gives the same bits: nothing of the first remains. */
GPROJT_TEST(same_bits_in_a_second_solve) {
    gproj_system *s = gprojt_crowd(NULL, 30);
    double start[60], first[60];
    memcpy(start, gproj_system_values(s), sizeof start);
    gproj_system_solve(s, 7, NULL);
    memcpy(first, gproj_system_values(s), sizeof first);
    memcpy(gproj_system_values(s), start, sizeof start);
    gproj_system_solve(s, 7, NULL);
    GPROJT_CHECK(!memcmp(first, gproj_system_values(s), sizeof first));
    gproj_system_destroy(s);
}

static bool gprojt_count_allocations(void *user, gproj_system *s, const gproj_iteration *iteration) {
    uint64_t *allocations = (uint64_t *)user;
    if (iteration->number > 1) GPROJT_CHECK(gproj_system_memory(s).allocations == *allocations);
    *allocations = gproj_system_memory(s).allocations;
    return true;
}

GPROJT_TEST(no_allocation_after_the_first_iteration) {
    gproj_system *s = gprojt_crowd(NULL, 30);
    uint64_t allocations = 0;
    gproj_solve_options options;
    memset(&options, 0, sizeof options);
    options.on_iteration = gprojt_count_allocations, options.user = &allocations;
    GPROJT_CHECK(gproj_system_solve(s, 20, &options).iterations > 2);
    gproj_system_destroy(s);
}

static bool gprojt_use_crowd(const gproj_host *host, void *user) {
    gproj_system *s = gprojt_crowd(host, 6);
    bool whole = gproj_system_solve(s, 3, NULL).outcome != GPROJ_FAILED;
    (void)user;
    gproj_system_destroy(s);
    return whole;
}

GPROJT_TEST(every_allocation_fails_once) { GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_crowd, NULL) >= 20); }

int main(void) {
    GPROJT_RUN(nearest_points_of_polytopes);
    GPROJT_RUN(inequalities_that_can_hold);
    GPROJT_RUN(discs);
    GPROJT_RUN(empty_box);
    GPROJT_RUN(least_squares_of_positive_numbers);
    GPROJT_RUN(bounds_meet_constraints);
    GPROJT_RUN(distant_bounds_do_nothing);
    GPROJT_RUN(tangents_of_convex_rows);
    GPROJT_RUN(tangents_of_concave_rows);
    GPROJT_RUN(bounds_let_go);
    GPROJT_RUN(wide_bounds);
    GPROJT_RUN(violations_are_what_counts);
    GPROJT_RUN(bounds_that_are_no_numbers);
    GPROJT_RUN(merits_with_hinges_are_minimised);
    GPROJT_RUN(the_course_is_the_merit);
    GPROJT_RUN(a_crowd_finds_room);
    GPROJT_RUN(same_bits_for_all_workers);
    GPROJT_RUN(same_bits_in_a_second_solve);
    GPROJT_RUN(no_allocation_after_the_first_iteration);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
