/* test_nearest.c - >>loop: the nearest point where the constraints hold, by multipliers. */
#include "gprojt_form.h"
#include "gprojt_inside.h"

static gproj_solve_options gprojt_nearest(void) {
    gproj_solve_options options;
    memset(&options, 0, sizeof options);
    options.nearest = true;
    return options;
}

static gproj_result gprojt_solve_nearest(gproj_system *s, int32_t iterations) {
    gproj_solve_options options = gprojt_nearest();
    return gproj_system_solve(s, iterations, &options);
}

/* -- one point near quadrics, against what is computed otherwise -- */

/* A system of one point at `start`, wished to be at `wish`, with a weight. */
static gproj_system *gprojt_one_point(const double start[3], const double wish[3], double weight) {
    gproj_system *s = gproj_system_create(NULL);
    int32_t group, k;
    gproj_system_add_variables(s, 3, 3, start);
    group = gprojt_add_group(s, "closeness", GPROJ_WISH, weight);
    for (k = 0; k < 3; ++k) gprojt_add_linear(s, group, k, 1, -wish[k], 0);
    return s;
}

/* Adds the row sum (x_k / a_k)^2 - 1, times `sign`. */
static int32_t gprojt_add_ellipsoid(gproj_system *s, gproj_kind kind, const double a[3], double sign) {
    int32_t group = gprojt_add_group(s, "ellipsoid", kind, 1), k;
    gproj_term term[3];
    for (k = 0; k < 3; ++k) term[k] = gprojt_term(k, k, sign / (a[k] * a[k]));
    gproj_system_add_row(s, group, 3, term, -sign, 0);
    return group;
}

/* The point of an ellipsoid nearest to p outside of it: x_k = a_k^2 p_k / (a_k^2 + t) with the t > 0 that puts it on
   the ellipsoid, by bisection. */
static void gprojt_nearest_on_ellipsoid(const double a[3], const double p[3], double out[3]) {
    double low = 0, high = 1e4;
    int i, k;
    for (i = 0; i < 200; ++i) {
        double t = (low + high) / 2, sum = 0;
        for (k = 0; k < 3; ++k) {
            out[k] = a[k] * a[k] * p[k] / (a[k] * a[k] + t);
            sum += (out[k] / a[k]) * (out[k] / a[k]);
        }
        if (sum > 1) {
            low = t;
        } else {
            high = t;
        }
    }
}

GPROJT_TEST(nearest_on_ellipsoids) {
    uint64_t seed = 3;
    int i, k;
    for (i = 0; i < 40; ++i) {
        double a[3], p[3], expected[3];
        gproj_system *s;
        gproj_result result;
        for (k = 0; k < 3; ++k) a[k] = i < 5 ? 1 : 0.5 + 2 * gprojt_uniform(&seed);
        for (k = 0; k < 3; ++k) p[k] = (k == i % 3 ? 2.6 : 0.2) + gprojt_uniform(&seed);
        s = gprojt_one_point(p, p, i % 2 ? 1 : 1e-3);
        gprojt_add_ellipsoid(s, GPROJ_CONSTRAINT, a, 1);
        result = gprojt_solve_nearest(s, 40);
        gprojt_nearest_on_ellipsoid(a, p, expected);
        if (result.outcome != GPROJ_CONVERGED || gprojt_far(gproj_system_values(s), expected) > 1e-6)
            printf("    %d: off by %g; %s\n", i, gprojt_far(gproj_system_values(s), expected), result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.residual <= 1e-13 && result.optimality <= 1e-6);
        GPROJT_CHECK(gprojt_far(gproj_system_values(s), expected) < 1e-6);
        gproj_system_destroy(s);
    }
}

/* What breaks symmetries is a part of the first step, which is short near the ellipsoid. */
GPROJT_TEST(short_first_steps) {
    static const double a[3] = {1, 1, 1}, start[3] = {0, 0, 1.00001};
    gproj_system *s = gprojt_one_point(start, start, 1);
    gprojt_add_ellipsoid(s, GPROJ_CONSTRAINT, a, 1);
    gprojt_solve_nearest(s, 1);
    GPROJT_CHECK(gprojt_far(gproj_system_values(s), start) < 1e-4);
    gproj_system_destroy(s);
}

/* The curve x^2 + y^2 = 1, z = x y + 0.3 x^2 in closed form, scanned for its nearest point. */
static double gprojt_curve_distance(double angle, const double p[3], double q[3]) {
    q[0] = cos(angle), q[1] = sin(angle), q[2] = q[0] * q[1] + 0.3 * q[0] * q[0];
    return gprojt_far(p, q);
}

GPROJT_TEST(nearest_on_two_quadrics) {
    uint64_t seed = 8;
    int i, k;
    for (i = 0; i < 30; ++i) {
        double p[3], q[3], best = 0, angle, step;
        gproj_system *s;
        gproj_result result;
        gproj_term term[3];
        int32_t group;
        for (k = 0; k < 3; ++k) p[k] = 3 * gprojt_uniform(&seed) - 1.5;
        s = gprojt_one_point(p, p, 1);
        group = gprojt_add_group(s, "curve", GPROJ_CONSTRAINT, 1);
        term[0] = gprojt_term(0, 0, 1), term[1] = gprojt_term(1, 1, 1);
        gproj_system_add_row(s, group, 2, term, -1, 0);
        term[0] = gprojt_term(0, 1, 1), term[1] = gprojt_term(0, 0, 0.3), term[2] = gprojt_term(2, -1, -1);
        gproj_system_add_row(s, group, 3, term, 0, 1);
        result = gprojt_solve_nearest(s, 60);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        /* it is a local minimum: no point of the curve beside it is nearer */
        angle = atan2(gproj_system_values(s)[1], gproj_system_values(s)[0]);
        best = gprojt_curve_distance(angle, p, q);
        GPROJT_CHECK(gprojt_far(q, gproj_system_values(s)) < 1e-12);
        for (step = 1e-4; step < 0.02; step *= 2) {
            GPROJT_CHECK(gprojt_curve_distance(angle + step, p, q) >= best - 1e-13);
            GPROJT_CHECK(gprojt_curve_distance(angle - step, p, q) >= best - 1e-13);
        }
        gproj_system_destroy(s);
    }
}

/* phi >= 0 inside: points within stay where they are, others come to the surface. */
GPROJT_TEST(nearest_in_a_ball) {
    static const double a[3] = {1, 1.5, 0.7};
    uint64_t seed = 4;
    int i, k;
    for (i = 0; i < 20; ++i) {
        double p[3], expected[3], size = 0;
        gproj_system *s;
        gproj_result result;
        for (k = 0; k < 3; ++k) p[k] = (i % 2 ? 2.4 : 0.5) * a[k] * (0.1 + gprojt_uniform(&seed));
        for (k = 0; k < 3; ++k) size += (p[k] / a[k]) * (p[k] / a[k]);
        s = gprojt_one_point(p, p, 1);
        gprojt_add_ellipsoid(s, GPROJ_BOUND, a, -1);
        result = gprojt_solve_nearest(s, 40);
        memcpy(expected, p, sizeof p);
        if (size > 1) gprojt_nearest_on_ellipsoid(a, p, expected);
        if (gprojt_far(gproj_system_values(s), expected) > 1e-6)
            printf("    %d: off by %g; %s\n", i, gprojt_far(gproj_system_values(s), expected), result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_CHECK(gprojt_far(gproj_system_values(s), expected) < 1e-6);
        gproj_system_destroy(s);
    }
}

/* A bound whose boundary is not where the minimum is lets go: from outside the ball, wished inside. */
GPROJT_TEST(bounds_let_go) {
    static const double a[3] = {1, 1, 1}, start[3] = {3, 1, 0.5}, wish[3] = {0.2, 0.1, -0.3};
    gproj_system *s = gprojt_one_point(start, wish, 1);
    gproj_result result;
    gprojt_add_ellipsoid(s, GPROJ_BOUND, a, -1);
    result = gprojt_solve_nearest(s, 40);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gprojt_far(gproj_system_values(s), wish) < 1e-6);
    gproj_system_destroy(s);
}

/* The point (0, 0) of the parabola y = x^2 / 2 is the nearest one to (0, c) up to c = 1; beyond, it is the farthest one around,
   which no symmetric step leaves. The nearest ones have x^2 = 2 (c - 1). */
GPROJT_TEST(farthest_points_are_left) {
    static const double heights[] = {1.1, 1.5, 2, 10, 100};
    int i;
    for (i = 0; i < 5; ++i) {
        gproj_system *s = gproj_system_create(NULL);
        gproj_term term[2];
        gproj_result result;
        int32_t wish, parabola;
        gproj_system_add_variables(s, 2, 2, NULL);
        wish = gprojt_add_group(s, "wish", GPROJ_WISH, 1);
        gprojt_add_linear(s, wish, 0, 1, 0, 0);
        gprojt_add_linear(s, wish, 1, 1, -heights[i], 0);
        parabola = gprojt_add_group(s, "parabola", GPROJ_CONSTRAINT, 1);
        term[0] = gprojt_term(1, -1, 1), term[1] = gprojt_term(0, 0, -0.5);
        gproj_system_add_row(s, parabola, 2, term, 0, 0);
        result = gprojt_solve_nearest(s, 60);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_NEAR(fabs(gproj_system_values(s)[0]), sqrt(2 * (heights[i] - 1)), 1e-5);
        if (i >= 3) GPROJT_CHECK(result.iterations <= 15); /* where steps with curvature fail at first */
        gproj_system_destroy(s);
    }
}

/* y = -1 and y^2 = 1 depend on each other: multipliers that grew on the way do not hide that (0.5, -1) is the minimum. */
GPROJT_TEST(rows_that_depend_on_each_other) {
    static const double begin[] = {1.8, -0.5, -2, 0.3};
    int i, k;
    for (i = 0; i < 4; ++i)
        for (k = -1; k <= 3; ++k) {
            double start[2] = {0.2, 0}, *x;
            gproj_system *s = gproj_system_create(NULL);
            gproj_term square = gprojt_term(1, 1, 1);
            int32_t wish, rows;
            start[1] = begin[i];
            gproj_system_add_variables(s, 2, 1, start);
            rows = gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
            gprojt_add_linear(s, rows, 1, 1, 1, 0);
            gproj_system_add_row(s, rows, 1, &square, -1, 1);
            wish = gprojt_add_group(s, "wish", GPROJ_WISH, 0.1);
            gprojt_add_linear(s, wish, 0, 1, -0.5, 0);
            gprojt_add_linear(s, wish, 1, 1, -k, 1);
            GPROJT_CHECK(gprojt_solve_nearest(s, 60).outcome == GPROJ_CONVERGED);
            x = gproj_system_values(s);
            GPROJT_CHECK(fabs(x[0] - 0.5) < 1e-6 && fabs(x[1] + 1) < 1e-12);
            gproj_system_destroy(s);
        }
}

/* Large multipliers do not throw a mesh so far that rounding makes a point of it: with equal lengths it ends nearer than what
   a projection finds. */
GPROJT_TEST(slides_stay_in_reach) {
    static const uint64_t seeds[] = {10, 23, 33};
    int32_t trial, nearest, i;
    for (trial = 0; trial < 3; ++trial) {
        gproj_mesh *mesh = gprojt_mesh_of(gprojt_triangle_grid(5, 5));
        double moved[2] = {0, 0}, *before;
        gprojt_bulge(mesh, seeds[trial]);
        before = gprojt_keep(mesh);
        for (nearest = 0; nearest < 2; ++nearest) {
            gproj_form *form = gproj_form_create(mesh, NULL);
            gproj_solve_options options;
            gproj_result result;
            memset(&options, 0, sizeof options);
            options.nearest = nearest != 0;
            gproj_add_equal_lengths(form, 0, NULL, 1);
            result = gproj_solve(form, 60, &options);
            GPROJT_CHECK(result.residual <= result.tolerance && result.spoiled.collapsed_edges == 0);
            for (i = 0; i < mesh->vertex_count; ++i) {
                double d = gprojt_far(mesh->position + 3 * i, before + 3 * i);
                moved[nearest] += d * d;
            }
            gproj_form_destroy(form);
            memcpy(mesh->position, before, 3 * (size_t)mesh->vertex_count * sizeof(double));
        }
        GPROJT_CHECK(moved[1] < moved[0]);
        free(before);
        gproj_mesh_destroy(mesh);
    }
}

/* A row with a global group (low-rank update): the mean of many points is prescribed, closeness wished; they all move by
   the same. */
GPROJT_TEST(global_rows) {
    enum {
        COUNT = 700
    };
    gproj_system *s = gproj_system_create(NULL);
    double x[COUNT];
    gproj_term term[COUNT];
    gproj_group global;
    gproj_result result;
    uint64_t seed = 2;
    int32_t i, group;
    double mean = 0, worst = 0;
    for (i = 0; i < COUNT; ++i) x[i] = gprojt_uniform(&seed), mean += x[i] / COUNT;
    gproj_system_add_variables(s, COUNT, 1, x);
    group = gprojt_add_group(s, "closeness", GPROJ_WISH, 1);
    for (i = 0; i < COUNT; ++i) gprojt_add_linear(s, group, i, 1, -x[i], i);
    memset(&global, 0, sizeof global);
    global.name = "mean", global.global = true, global.schedule = gproj_keep(1);
    group = gproj_system_add_group(s, &global);
    for (i = 0; i < COUNT; ++i) term[i] = gprojt_term(i, -1, 1.0 / COUNT);
    gproj_system_add_row(s, group, COUNT, term, -2, 0);
    result = gprojt_solve_nearest(s, 30);
    for (i = 0; i < COUNT; ++i) worst = fmax(worst, fabs(gproj_system_values(s)[i] - x[i] - (2 - mean)));
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && worst < 1e-6);
    gproj_system_destroy(s);
}

/* Without constraints it is least squares; with nothing wished, projection; with nothing at all, nothing. */
GPROJT_TEST(one_side_only) {
    static const double a[3] = {1, 2, 1}, start[3] = {1, 1, 1}, wish[3] = {4, 5, 6};
    gproj_system *s = gprojt_one_point(start, wish, 0.1);
    gproj_result result = gprojt_solve_nearest(s, 20);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gprojt_far(gproj_system_values(s), wish) < 1e-6);
    GPROJT_CHECK(result.worst_group == -1);
    gproj_system_destroy(s);
    s = gproj_system_create(NULL);
    gproj_system_add_variables(s, 3, 3, start);
    gprojt_add_ellipsoid(s, GPROJ_CONSTRAINT, a, 1);
    result = gprojt_solve_nearest(s, 20);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.residual <= 1e-13 && result.optimality == 0);
    gproj_system_destroy(s);
    s = gproj_system_create(NULL);
    result = gprojt_solve_nearest(s, 20);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations == 0);
    gproj_system_destroy(s);
}

/* A heavy wish without rows, or without rows that count, does not make the others light. */
GPROJT_TEST(wishes_without_rows) {
    static const double a[3] = {1, 1.5, 0.7}, p[3] = {2, 1.1, 0.9};
    double expected[3];
    int rows;
    gprojt_nearest_on_ellipsoid(a, p, expected);
    for (rows = 0; rows < 2; ++rows) {
        gproj_system *s = gprojt_one_point(a, p, 1);
        int32_t heavy = gprojt_add_group(s, "heavy", GPROJ_WISH, 1e9);
        gproj_result result;
        gprojt_add_ellipsoid(s, GPROJ_CONSTRAINT, a, 1);
        if (rows) gprojt_add_linear(s, heavy, 0, 1, -5, 0);
        if (rows) gproj_system_set_row_weight(s, heavy, 0, 0);
        result = gprojt_solve_nearest(s, 60);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gprojt_far(gproj_system_values(s), expected) < 1e-6);
        gproj_system_destroy(s);
    }
}

/* Only the ratios of the wishes' weights matter, of groups and of rows, and decay and last do not. */
GPROJT_TEST(weights_are_ratios) {
    static const double a[3] = {1, 2, 0.6}, p[3] = {1.5, 1.2, 0.9}, q[3] = {0.3, 2, 1.4};
    double found[5][3];
    int i;
    for (i = 0; i < 5; ++i) {
        double size = i == 1 ? 100 : 1;
        gproj_system *s = gprojt_one_point(p, p, size);
        int32_t second = gprojt_add_group(s, "second", GPROJ_WISH, 0.5 * size), k;
        for (k = 0; k < 3; ++k) gprojt_add_linear(s, second, k, 1, -q[k], 0);
        gprojt_add_ellipsoid(s, GPROJ_CONSTRAINT, a, 1);
        if (i == 2) gproj_system_set_schedule(s, second, gprojt_schedule(0.5, 0.5, 3));
        for (k = 0; i > 2 && k < 3; ++k) { /* the rows' own weights count alike */
            gproj_system_set_row_weight(s, 0, k, i == 3 ? 1e-9 : 1e4);
            gproj_system_set_row_weight(s, second, k, i == 3 ? 1e-9 : 1e4);
        }
        GPROJT_CHECK(gprojt_solve_nearest(s, 40).outcome == GPROJ_CONVERGED);
        memcpy(found[i], gproj_system_values(s), sizeof found[i]);
        gproj_system_destroy(s);
    }
    GPROJT_CHECK(gprojt_far(found[0], found[1]) < 1e-9 && gprojt_far(found[0], found[2]) == 0);
    GPROJT_CHECK(gprojt_far(found[0], found[3]) < 1e-9 && gprojt_far(found[0], found[4]) < 1e-9);
}

/* At the start nothing is gained and the optimality is 1, however large the rows' coefficients are. */
GPROJT_TEST(optimality_has_no_unit) {
    static const double sizes[] = {0.1, 1, 30};
    int i;
    int32_t k;
    for (i = 0; i < 3; ++i) {
        gproj_system *s = gproj_system_create(NULL);
        gproj_system_add_variables(s, 3, 1, NULL);
        gprojt_add_group(s, "wish", GPROJ_WISH, 0.7);
        for (k = 0; k < 3; ++k) gprojt_add_linear(s, 0, k, sizes[i], -1 - k, k);
        gprojt_add_group(s, "constraint", GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 1, 0, 1, -0.5, 0);
        GPROJT_NEAR(gprojt_solve_nearest(s, 0).optimality, 1, 1e-15);
        gproj_system_destroy(s);
    }
}

/* -- meshes -- */

typedef void (*gprojt_asks)(gproj_form *form);

static void gprojt_ask_planar(gproj_form *form) { gproj_add_planarity(form, 1); }
static void gprojt_ask_circular(gproj_form *form) {
    gproj_add_planarity(form, 1);
    gproj_add_circularity(form, 1);
}
static void gprojt_ask_fixed(gproj_form *form) {
    gproj_add_planarity(form, 1);
    gproj_add_fixed_boundary(form, 1);
}
static void gprojt_ask_gliding(gproj_form *form) {
    gproj_add_planarity(form, 1);
    gproj_add_gliding_boundary(form, 1);
}
static double gprojt_wanted_volume;
static void gprojt_ask_volume(gproj_form *form) {
    gproj_add_planarity(form, 1);
    gproj_add_volume(form, gprojt_wanted_volume, 1);
}

/* Solves a copy of the mesh; `positions`: the outcome. */
static gproj_measures gprojt_measure_options(const gproj_mesh *mesh, gprojt_asks ask,
                                             const gproj_solve_options *options, int32_t iterations,
                                             const gproj_host *host, gproj_result *result, double *positions) {
    gproj_error error;
    gproj_mesh *copy = gproj_mesh_copy(mesh, NULL, &error);
    gproj_form *form = gproj_form_create(copy, host);
    gproj_measures measures;
    ask(form);
    *result = gproj_solve(form, iterations, options);
    GPROJT_CHECK(gproj_measure_spoiled(copy, mesh->position).total == result->spoiled.total);
    measures = gproj_measure(copy, mesh->position, NULL);
    if (positions) memcpy(positions, copy->position, 3 * (size_t)copy->vertex_count * sizeof *positions);
    gproj_form_destroy(form);
    gproj_mesh_destroy(copy);
    return measures;
}

/* The same in the usual way or for the nearest one. */
static gproj_measures gprojt_measure_solve(const gproj_mesh *mesh, gprojt_asks ask, bool nearest, int32_t iterations,
                                           const gproj_host *host, gproj_result *result, double *positions) {
    gproj_solve_options options = gprojt_nearest();
    options.nearest = nearest;
    return gprojt_measure_options(mesh, ask, &options, iterations, host, result, positions);
}

GPROJT_TEST(moves_less_than_projection) {
    static const gprojt_asks asks[] = {gprojt_ask_planar, gprojt_ask_circular, gprojt_ask_fixed, gprojt_ask_gliding,
                                       gprojt_ask_volume};
    int shape, i;
    for (i = 0; i < 5; ++i) {
        for (shape = 0; shape < 6; ++shape) {
            gproj_mesh *mesh = gprojt_noisy(shape, 6, 0.06, 5);
            gproj_result plain, nearest;
            gproj_measures before, after;
            gprojt_wanted_volume = 1.05 * gproj_volume(mesh);
            before = gprojt_measure_solve(mesh, asks[i], false, 30, NULL, &plain, NULL);
            after = gprojt_measure_solve(mesh, asks[i], true, 30, NULL, &nearest, NULL);
            if (plain.outcome == GPROJ_CONVERGED) {
                if (nearest.residual > nearest.tolerance || after.deviation_rms > before.deviation_rms * (1 + 1e-9))
                    printf("    shape %d, asked %d: %g, plain %g; %s\n", shape, i, after.deviation_rms,
                           before.deviation_rms, nearest.message);
                GPROJT_CHECK(nearest.residual <= nearest.tolerance);
                GPROJT_CHECK(after.deviation_rms <= before.deviation_rms * (1 + 1e-9));
                GPROJT_CHECK(after.turned_faces <= before.turned_faces);
            }
            gproj_mesh_destroy(mesh);
        }
    }
}

/* Solves a copy of the mesh for the nearest flat one, with this limit. */
static gproj_result gprojt_flatten(const gproj_mesh *mesh, int32_t iterations, bool skip_guard) {
    gproj_solve_options options = gprojt_nearest();
    gproj_result result;
    options.skip_guard = skip_guard;
    gprojt_measure_options(mesh, gprojt_ask_planar, &options, iterations, NULL, &result, NULL);
    return result;
}

/* The nearest flat meshes of these have lost edges. With time enough, and a guard, they are kept whole; there is a minimum
   with whole edges, too. */
GPROJT_TEST(spoiled_meshes_are_mended) {
    static const int32_t size[3] = {8, 12, 12};
    static const double noise[3] = {0.06, 0.12, 0.18};
    int i;
    for (i = 0; i < 3; ++i) {
        gproj_mesh *mesh = gprojt_noisy(0, size[i], noise[i], 5);
        gproj_result little = gprojt_flatten(mesh, 50, false), mended = gprojt_flatten(mesh, 60, false);
        GPROJT_CHECK(little.outcome == GPROJ_CONVERGED && little.spoiled.total > 0);
        GPROJT_CHECK(strstr(little.message, "more than 50 iterations may keep it whole"));
        GPROJT_CHECK(gprojt_flatten(mesh, 60, true).spoiled.total > 0);
        GPROJT_CHECK(mended.outcome == GPROJ_CONVERGED && mended.spoiled.total == 0);
        gproj_mesh_destroy(mesh);
    }
}

/* Safeguards that an earlier solve has added rest in one that does without: it ends as in a form that has none. */
GPROJT_TEST(earlier_safeguards_rest) {
    gproj_mesh *mesh = gprojt_noisy(0, 8, 0.06, 5);
    double *before = gprojt_keep(mesh), *plain;
    gproj_solve_options options = gprojt_nearest();
    gproj_result result[2];
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1);
    options.skip_guard = true;
    result[0] = gproj_solve(form, 50, &options);
    plain = gprojt_keep(mesh);
    gproj_form_destroy(form);
    gprojt_put_back(mesh, before);
    form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1);
    options.skip_guard = false;
    GPROJT_CHECK(gproj_solve(form, 60, &options).spoiled.total == 0);
    gprojt_put_back(mesh, before);
    options.skip_guard = true;
    result[1] = gproj_solve(form, 50, &options);
    GPROJT_CHECK(result[0].outcome == GPROJ_CONVERGED && result[0].spoiled.total > 0);
    GPROJT_CHECK(!strstr(result[0].message, "more than 50 iterations")); /* of no use without safeguards */
    GPROJT_CHECK(result[1].outcome == GPROJ_CONVERGED && result[1].spoiled.total > 0);
    GPROJT_NEAR(gprojt_largest_move(plain, mesh->position, mesh->vertex_count) / gprojt_unit(form), 0, 1e-9);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(before), free(plain);
}

/* Twisted patches with hardly a flat mesh nearby whose edges are whole: the constraints hold in any case, and what is
   lost is less. */
GPROJT_TEST(safeguards_yield_to_constraints) {
    int32_t n;
    for (n = 6; n <= 12; n += 2) {
        gproj_mesh *mesh = gprojt_noisy(3, n, 0.06, 5);
        gproj_result little = gprojt_flatten(mesh, 50, false), mended = gprojt_flatten(mesh, 80, false);
        GPROJT_CHECK(little.residual <= little.tolerance && mended.residual <= mended.tolerance);
        GPROJT_CHECK(mended.spoiled.total < little.spoiled.total);
        gproj_mesh_destroy(mesh);
    }
}

/* The part of g that is orthogonal to all constraint rows at the system's x, over |g|: Gram and Schmidt, twice. */
static double gprojt_projected(gproj_system *s, const double *g) {
    int32_t n = gproj_system_variable_count(s), i, r, k, v, kept = 0, round;
    double *basis = (double *)malloc((size_t)n * (size_t)n * sizeof *basis), *left, size = 0, norm = 0;
    if (!basis) abort();
    left = (double *)malloc((size_t)n * sizeof *left);
    if (!left) abort();
    for (i = 0; i <= gproj_system_group_count(s); ++i) {
        bool last = i == gproj_system_group_count(s);
        gproj_group_info info = gprojt_info(s, last ? 0 : i);
        if (!last && info.kind != GPROJ_CONSTRAINT) continue;
        for (r = 0; r < (last ? 1 : info.rows) && kept < n; ++r) {
            double *row = last ? left : basis + (size_t)n * (size_t)kept, first = 0;
            if (last) {
                memcpy(left, g, (size_t)n * sizeof *left);
            } else {
                gproj_system_row_value(s, i, r, row);
            }
            for (v = 0; v < n; ++v) first += row[v] * row[v];
            for (round = 0; round < 2; ++round) {
                for (k = 0; k < kept; ++k) {
                    const double *q = basis + (size_t)n * (size_t)k;
                    double dot = 0;
                    for (v = 0; v < n; ++v) dot += q[v] * row[v];
                    for (v = 0; v < n; ++v) row[v] -= dot * q[v];
                }
            }
            norm = 0;
            for (v = 0; v < n; ++v) norm += row[v] * row[v];
            if (last || norm < 1e-16 * first) continue;
            for (v = 0; v < n; ++v) row[v] /= sqrt(norm);
            kept++;
        }
    }
    for (v = 0; v < n; ++v) size += g[v] * g[v];
    free(basis);
    free(left);
    return sqrt(norm / size);
}

/* The displacement is orthogonal to the tangent space of the constraints. With more than 50 iterations safeguards would
   act on one of these meshes, too. */
GPROJT_TEST(conditions_of_kuhn_and_tucker) {
    static const gprojt_asks asks[] = {gprojt_ask_planar, gprojt_ask_fixed};
    int i, shape;
    for (i = 0; i < 2; ++i) {
        for (shape = 0; shape < 3; ++shape) {
            gproj_mesh *mesh = gprojt_noisy(shape, 4, 0.06, 9);
            gproj_form *form = gproj_form_create(mesh, NULL);
            gproj_solve_options options = gprojt_nearest();
            gproj_result result;
            gproj_system *s = gproj_form_system(form);
            double *before, *g, projected = 0, sum = 0;
            int32_t v, n;
            asks[i](form);
            n = gproj_system_variable_count(s);
            before = (double *)malloc((size_t)n * sizeof *before);
            g = (double *)calloc((size_t)n, sizeof *g);
            if (!before || !g) abort();
            memcpy(before, gproj_system_values(s), (size_t)n * sizeof *before);
            result = gproj_solve(form, 50, &options);
            for (v = 0; v < 3 * mesh->vertex_count; ++v) g[v] = gproj_system_values(s)[v] - before[v];
            for (v = 0; v < n; ++v) sum += g[v] * g[v];
            if (sum > 0) projected = gprojt_projected(s, g);
            if (result.outcome != GPROJ_CONVERGED || projected > 2e-6)
                printf("    shape %d, asked %d: projected %g; %s\n", shape, i, projected, result.message);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.optimality <= 1e-6);
            GPROJT_CHECK(projected <= result.optimality * 1.01 + 1e-9);
            free(before);
            free(g);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
    }
}

/* Many bounds, linear and quadratic, that all hold at `inside`; wished is nearness to somewhere else. */
static gproj_result gprojt_nearest_within(uint64_t *seed) {
    int32_t variables = 2 + gprojt_below(seed, 7), rows = 1 + gprojt_below(seed, 2 * variables), bounds, near, r, k;
    gproj_system *s = gproj_system_create(NULL);
    gproj_result result;
    double inside[8], start[8];
    for (k = 0; k < variables; ++k) inside[k] = 4 * gprojt_uniform(seed) - 2, start[k] = 4 * gprojt_uniform(seed) - 2;
    gproj_system_add_variables(s, variables, 1, start);
    bounds = gprojt_add_group(s, "bounds", GPROJ_BOUND, 1);
    near = gprojt_add_group(s, "near", GPROJ_WISH, 1);
    for (r = 0; r < rows; ++r) {
        gproj_term term[5];
        int32_t terms = 1 + gprojt_below(seed, 5);
        double value = 0;
        for (k = 0; k < terms; ++k) {
            term[k].i = gprojt_below(seed, variables);
            term[k].j = gprojt_below(seed, 2) ? -1 : gprojt_below(seed, variables);
            term[k].a = gprojt_below(seed, 7) - 3;
            value += term[k].a * inside[term[k].i] * (term[k].j < 0 ? 1 : inside[term[k].j]);
        }
        gproj_system_add_row(s, bounds, terms, term, -value, r);
    }
    for (k = 0; k < variables; ++k) gprojt_add_linear(s, near, k, 1, 0.5 - gprojt_uniform(seed) - start[k], k);
    result = gprojt_solve_nearest(s, 100);
    gproj_system_destroy(s);
    return result;
}

/* Sets of bounds that go in circles end a solve hardly ever. */
GPROJT_TEST(bounds_seldom_block) {
    uint64_t seed = 1;
    int count, converged = 0, stalled = 0;
    for (count = 0; count < 500; ++count) {
        gproj_result result = gprojt_nearest_within(&seed);
        converged += result.outcome == GPROJ_CONVERGED;
        stalled += result.outcome == GPROJ_STALLED;
        GPROJT_CHECK(result.outcome != GPROJ_CONVERGED || result.residual <= result.tolerance);
    }
    printf("    %d of %d are at a minimum, %d stalled\n", converged, count, stalled);
    GPROJT_CHECK(converged >= 450 && stalled <= 20);
}

/* What satisfies everything already stays to the bit. */
GPROJT_TEST(nothing_to_do) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_cube_sphere(3)), *flat;
    gproj_result result;
    gproj_error error;
    double *positions = gprojt_keep(mesh);
    gprojt_measure_solve(mesh, gprojt_ask_planar, false, 30, NULL, &result, positions);
    flat = gproj_mesh_copy(mesh, NULL, &error);
    memcpy(flat->position, positions, 3 * (size_t)flat->vertex_count * sizeof *positions);
    gprojt_measure_solve(flat, gprojt_ask_planar, true, 30, NULL, &result, positions);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations == 0);
    GPROJT_CHECK(memcmp(positions, flat->position, 3 * (size_t)flat->vertex_count * sizeof *positions) == 0);
    free(positions);
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(flat);
}

GPROJT_TEST(same_bits_for_all_crews) {
    gproj_mesh *mesh = gprojt_noisy(0, 12, 0.1, 3);
    double *first = gprojt_keep(mesh), *other = gprojt_keep(mesh);
    gproj_result result;
    int i;
    gprojt_measure_solve(mesh, gprojt_ask_planar, true, 20, NULL, &result, first);
    for (i = 0; i < GPROJT_CREWS; ++i) {
        gproj_host host = gprojt_crew(i);
        gprojt_measure_solve(mesh, gprojt_ask_planar, true, 20, &host, &result, other);
        GPROJT_CHECK(memcmp(first, other, 3 * (size_t)mesh->vertex_count * sizeof *first) == 0);
    }
    free(first);
    free(other);
    gproj_mesh_destroy(mesh);
}

typedef struct gprojt_log {
    int count, stop_after;
    uint64_t allocations;
    bool allocated;
    double optimality;
} gprojt_log;

static bool gprojt_note(void *user, gproj_system *s, const gproj_iteration *iteration) {
    gprojt_log *log = (gprojt_log *)user;
    uint64_t allocations = gproj_system_memory(s).allocations;
    if (log->count++ > 0 && allocations != log->allocations) log->allocated = true;
    log->allocations = allocations;
    log->optimality = iteration->optimality;
    return log->count != log->stop_after;
}

/* Few iterations, cancelling, time: the sentence says what holds and what does not. Iterations do not allocate, unless
   safeguards come in, in more than 50. */
GPROJT_TEST(honest_verdicts) {
    gproj_mesh *mesh = gprojt_noisy(0, 10, 0.25, 7);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_solve_options options = gprojt_nearest();
    gprojt_log log;
    gproj_result result;
    double *start = gprojt_keep(mesh);
    int32_t n;
    memset(&log, 0, sizeof log);
    gproj_add_planarity(form, 1);
    options.on_iteration = gprojt_note;
    options.user = &log;
    for (n = 0; n < 14; ++n) {
        gprojt_put_back(mesh, start);
        result = gproj_solve(form, n, &options);
        if (result.outcome == GPROJ_CONVERGED) {
            GPROJT_CHECK(result.optimality <= 1e-6 && result.residual <= result.tolerance);
        } else {
            GPROJT_CHECK(result.outcome == GPROJ_ITERATION_LIMIT && strstr(result.message, "more iterations"));
            GPROJT_CHECK(strstr(result.message, "projected gradient") != NULL);
        }
        GPROJT_CHECK((strstr(result.message, "all constraints hold") != NULL) == (result.residual <= result.tolerance));
        GPROJT_CHECK(n == 0 || result.optimality == log.optimality);
    }
    memset(&log, 0, sizeof log);
    gprojt_put_back(mesh, start);
    log.stop_after = 3;
    result = gproj_solve(form, 30, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CANCELLED && result.iterations == 3 && !log.allocated);
    memset(&log, 0, sizeof log);
    gprojt_put_back(mesh, start);
    result = gproj_solve(form, 50, &options);
    GPROJT_CHECK(result.residual <= result.tolerance && !log.allocated && log.count > 5);
    memset(&log, 0, sizeof log);
    gprojt_put_back(mesh, start);
    result = gproj_solve(form, 60, &options);
    GPROJT_CHECK(result.residual <= result.tolerance && result.spoiled.total == 0 && log.allocated);
    /* afterwards the usual solve is as ever */
    gprojt_put_back(mesh, start);
    options.nearest = false;
    result = gproj_solve(form, 20, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.optimality == 0);
    free(start);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* x_2 = 0 and (x_0^2 - 2)^2 + x_1^2 small: the constraint holds at once, and the wishes take a while. */
static gproj_system *gprojt_well(const gproj_host *host, double weight) {
    static const double x[3] = {5, 3, 1};
    gproj_system *s = gproj_system_create(host);
    gproj_term square = gprojt_term(0, 0, 1);
    gproj_system_add_variables(s, 3, 3, x);
    gprojt_add_group(s, "plane", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "well", GPROJ_WISH, weight);
    gprojt_add_linear(s, 0, 2, 1, 0, 0);
    gproj_system_add_row(s, 1, 1, &square, -2, 0);
    gprojt_add_linear(s, 1, 1, 1, 0, 1);
    return s;
}

static double gprojt_second(void *user) { return ++*(double *)user; }

typedef struct gprojt_meddling {
    int32_t at;
    double coefficient, constant; /* of the row x_1 then */
    bool go_on;
} gprojt_meddling;

static bool gprojt_meddle(void *user, gproj_system *s, const gproj_iteration *iteration) {
    const gprojt_meddling *m = (const gprojt_meddling *)user;
    if (iteration->number != m->at) return true;
    if (m->go_on) gproj_system_set_row(s, 1, 1, &m->coefficient, m->constant);
    return m->go_on;
}

/* If the constraints hold this is said first, and then how the solve ended. */
GPROJT_TEST(sentences_where_constraints_hold) {
    gproj_solve_options options = gprojt_nearest();
    gprojt_meddling meddling = {3, 0, 0, false};
    double now = 0;
    gproj_host host;
    gproj_system *s = gprojt_well(NULL, 1);
    gproj_result result;
    options.on_iteration = gprojt_meddle, options.user = &meddling;
    result = gproj_system_solve(s, 60, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CANCELLED && result.iterations == 3);
    GPROJT_CHECK(
        strstr(result.message, "all constraints hold to the tolerance, cancelled by the caller: 3 iterations") != NULL);
    gproj_system_destroy(s);
    memset(&host, 0, sizeof host);
    host.clock.now = gprojt_second, host.clock.user = &now;
    s = gprojt_well(&host, 1);
    options = gprojt_nearest();
    options.time_budget = 15;
    result = gproj_system_solve(s, 60, &options);
    GPROJT_CHECK(result.outcome == GPROJ_TIME_OUT && result.iterations > 0 && result.residual <= result.tolerance);
    GPROJT_CHECK(strstr(result.message, "but the time budget ran out before a minimum of the wishes") != NULL);
    options = gprojt_nearest();
    result = gproj_system_solve(s, 60, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(strstr(result.message, "all constraints hold to the tolerance, at a minimum of the wishes: ") != NULL);
    gproj_system_destroy(s);
}

/* Wishes that the callback changes on the way are those that count; one that no step can serve ends the solve. */
GPROJT_TEST(wishes_that_change_on_the_way) {
    gprojt_meddling meddling = {0, 1, -7, true};
    int32_t k;
    for (meddling.at = 1; meddling.at < 6; ++meddling.at) {
        gproj_system *s = gprojt_well(NULL, 1);
        gproj_solve_options options = gprojt_nearest();
        gproj_result result;
        options.on_iteration = gprojt_meddle, options.user = &meddling;
        result = gproj_system_solve(s, 60, &options);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_NEAR(gproj_system_values(s)[0], sqrt(2), 1e-5);
        GPROJT_NEAR(gproj_system_values(s)[1], 7, 1e-5);
        GPROJT_NEAR(gproj_system_values(s)[2], 0, 1e-13);
        gproj_system_destroy(s);
    }
    for (k = 0; k < 2; ++k) {
        gprojt_meddling faint = {3, k ? 1e-160 : 1e30, 1e300, true};
        gproj_system *s = gprojt_well(NULL, 1);
        gproj_solve_options options = gprojt_nearest();
        gproj_result result;
        options.on_iteration = gprojt_meddle, options.user = &faint, options.epsilon = 1e-150;
        result = gproj_system_solve(s, 60, &options);
        GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations == 3);
        GPROJT_CHECK(fabs(gproj_system_values(s)[0]) < 10 && fabs(gproj_system_values(s)[1]) < 10);
        gproj_system_destroy(s);
    }
}

typedef struct gprojt_kinds {
    double x[3];
    bool tangential; /* at the last refresh */
    int32_t straight;
} gprojt_kinds;

static void gprojt_see_kind(void *user, gproj_system *s, int32_t group, const gproj_progress *progress) {
    gprojt_kinds *kinds = (gprojt_kinds *)user;
    const double *x = gproj_system_values(s);
    (void)group;
    if (!progress->tangential && memcmp(kinds->x, x, sizeof kinds->x) != 0) {
        GPROJT_CHECK(!kinds->tangential);
        ++kinds->straight;
    }
    memcpy(kinds->x, x, sizeof kinds->x);
    kinds->tangential = progress->tangential;
}

/* Before a step that does not follow the constraints rows are refreshed for such a step. */
GPROJT_TEST(refreshes_know_the_step_that_follows) {
    static const double start[3] = {0.2, 0.3, 2}, wish[3] = {3, 1, 1}, a[3] = {1, 2, 0.5};
    gproj_system *s = gprojt_one_point(start, wish, 1);
    gprojt_kinds kinds;
    gproj_group plane;
    memset(&plane, 0, sizeof plane);
    memcpy(kinds.x, start, sizeof start);
    kinds.straight = 0, kinds.tangential = false;
    plane.name = "plane", plane.schedule = gproj_keep(1);
    plane.refresh = gprojt_see_kind, plane.refresh_user = &kinds;
    gprojt_add_ellipsoid(s, GPROJ_CONSTRAINT, a, 1);
    gprojt_add_linear(s, gproj_system_add_group(s, &plane), 2, 1, 0, 0);
    GPROJT_CHECK(gprojt_solve_nearest(s, 60).outcome == GPROJ_CONVERGED && kinds.straight > 0 && kinds.tangential);
    gproj_system_destroy(s);
}

/* Wishes without weight ask for nothing, and neither do rows without weight, be they bounds. */
GPROJT_TEST(without_weight) {
    gproj_system *s = gprojt_well(NULL, 0);
    gproj_result result = gprojt_solve_nearest(s, 30);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.optimality == 0);
    GPROJT_NEAR(gproj_system_values(s)[0], 5, 0.1);
    GPROJT_NEAR(gproj_system_values(s)[2], 0, 1e-13);
    gproj_system_destroy(s);
    {
        static const double ball[3] = {1, 1, 1}, wish[3] = {0.9, 1.2, 0};
        int32_t k, i, bounds;
        for (k = 0; k < 10; ++k) {
            double start[3];
            for (i = 0; i < 3; ++i) start[i] = 0.1 * k * wish[i] + (i == 2 ? 0.3 : 0);
            s = gprojt_one_point(start, wish, 1);
            bounds = gprojt_add_ellipsoid(s, GPROJ_BOUND, ball, -1);
            gprojt_add_linear(s, bounds, 0, -1, 0.1, 1); /* x_0 <= 0.1 */
            gprojt_add_linear(s, 0, 0, 1, 100, 1);       /* far off */
            gproj_system_set_row_weight(s, bounds, 1, 0);
            gproj_system_set_row_weight(s, 0, 3, 0);
            result = gprojt_solve_nearest(s, 60);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
            GPROJT_NEAR(gproj_system_values(s)[0], 0.6, 1e-5);
            GPROJT_NEAR(gproj_system_values(s)[1], 0.8, 1e-5);
            GPROJT_NEAR(gproj_system_values(s)[2], 0, 1e-5);
            gproj_system_destroy(s);
        }
    }
}

/* A start so far away that the squares of the wishes are beyond all numbers: no step is known to be good, and none is taken. */
GPROJT_TEST(wishes_beyond_all_numbers) {
    static const double start[3] = {1e200, -1e200, 3}, wish[3] = {1, 2, 3};
    gproj_system *s = gprojt_one_point(start, wish, 1);
    gproj_result result;
    gprojt_add_group(s, "plane", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 1, 2, 1, 0, 0);
    result = gprojt_solve_nearest(s, 0);
    GPROJT_CHECK(result.outcome == GPROJ_ITERATION_LIMIT && !(result.optimality < 1e300));
    result = gprojt_solve_nearest(s, 60);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations == 0 && result.residual == 3);
    GPROJT_CHECK(!memcmp(gproj_system_values(s), start, sizeof start));
    gproj_system_destroy(s);
}

/* A wish that stays on does not keep the constraints from holding, and is served better than by guiding alone. */
GPROJT_TEST(wishes_stay_on) {
    gproj_result result[2];
    double energy[2];
    int i;
    for (i = 0; i < 2; ++i) {
        gproj_mesh *mesh = gprojt_noisy(0, 8, 0.05, 4);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_solve_options options = gprojt_nearest();
        int32_t fairness;
        options.nearest = i == 1;
        gproj_add_planarity(form, 1);
        gproj_add_fixed_boundary(form, 1);
        fairness = gproj_add_fairness(form, 0.2);
        result[i] = gproj_solve(form, 60, &options);
        gproj_set_schedule(form, fairness, gprojt_schedule(1, 1, INT32_MAX));
        gproj_system_check_gradients(gproj_form_system(form));
        energy[i] = 0;
        {
            int32_t r, rows = gproj_form_group_info(form, fairness).rows;
            for (r = 0; r < rows; ++r) {
                double phi = gproj_system_row_value(gproj_form_system(form), fairness, r, NULL);
                energy[i] += phi * phi;
            }
        }
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    if (!(energy[1] < energy[0])) printf("    energies %g %g; %s\n", energy[0], energy[1], result[1].message);
    GPROJT_CHECK(result[1].residual <= result[1].tolerance && energy[1] < energy[0]);
}

/* Closeness defines "near" if nothing else is wished; it rests in a nearest solve that is to do without, or has a wish. */
GPROJT_TEST(closeness_rests_where_it_is_not_wanted) {
    gproj_mesh *mesh = gprojt_noisy(0, 4, 0.05, 4);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_solve_options options = gprojt_nearest();
    int round, group = -1;
    gproj_add_planarity(form, 1);
    for (round = 0; round < 4; ++round) {
        options.skip_closeness = round == 1;
        if (round == 3) gproj_add_fairness(form, 0.1);
        GPROJT_CHECK(gproj_solve(form, 30, &options).outcome != GPROJ_FAILED);
        for (group = 0; strcmp(gproj_form_group_info(form, group).name, "closeness") != 0;) ++group;
        GPROJT_CHECK(gproj_form_group_info(form, group).schedule.weight == (round % 2 ? 0 : 1));
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* The square or the triangle of the next test, turned about the x-axis by `angle` degrees and made smaller, in the form's
   unit; the normal of a square turns with it. */
static void gprojt_place_face(const gproj_form *form, const gproj_mesh *mesh, int32_t face, double angle, double size,
                              double *values) {
    double c = cos(angle * acos(-1.0) / 180), s = sin(angle * acos(-1.0) / 180), centre[3], scale;
    int32_t normal = gprojt_inside_normal(form, face), h = mesh->face_halfedge[face], k;
    gproj_form_units(form, centre, &scale);
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h]) {
        const double *p = mesh->position + 3 * mesh->origin[h];
        double *to = values + 3 * mesh->origin[h];
        to[0] = (size * p[0] - centre[0]) * scale;
        to[1] = (c * p[1] - centre[1]) * scale;
        to[2] = (s * p[1] - centre[2]) * scale;
    }
    if (normal >= 0) values[normal] = 0, values[normal + 1] = -s, values[normal + 2] = c;
}

/* A step is refused that takes three quarters of a face's area, seen along its normal before or along the one when the solve
   began; faces without area are let go, and a solve may do without the guard. */
GPROJT_TEST(steps_that_turn_faces_are_refused) {
    static const struct {
        double angle[2], size[2]; /* before the step, after it */
        bool refused[2];          /* for a square; for a triangle, which has the first normal only */
    } step[10] = {{{0, 0}, {1, 0.26}, {false, false}}, {{0, 0}, {1, 0.24}, {true, true}},
                  {{0, 0}, {1, -1}, {true, true}},     {{0, 0}, {0.5, 0.13}, {false, false}},
                  {{0, 0}, {0.5, 0.12}, {true, true}}, {{0, 75}, {1, 1}, {false, false}},
                  {{0, 76}, {1, 1}, {true, true}},     {{60, 82}, {1, 1}, {false, false}},
                  {{60, 84}, {1, 1}, {true, true}},    {{-60, 20}, {1, 1}, {true, false}}};
    static const double target[3] = {0, 0, 1};
    static const int32_t corner = 0;
    gprojt_soup soup = gprojt_quad_grid(1, 1);
    gproj_solve_options options = gprojt_nearest();
    double values[2][64];
    gproj_system *system;
    gproj_mesh *mesh;
    gproj_form *form;
    int32_t v, face, end, i, on;
    for (v = 0; v < 4; ++v) soup.position[3 * v + 2] = 0;
    for (v = 0; v < 6; ++v) gprojt_add_vertex(&soup, v % 3 - 1.0, v < 3 && v != 1 ? 1 : 0, 0);
    gprojt_add_triangle(&soup, 4, 5, 6);
    gprojt_add_triangle(&soup, 7, 8, 9); /* in a line */
    mesh = gprojt_mesh_of(soup);
    form = gproj_form_create(mesh, NULL);
    system = gproj_form_system(form);
    gproj_add_planarity(form, 1);
    gproj_add_targets(form, 1, &corner, target, 1); /* something to do */
    GPROJT_REQUIRE(gproj_system_variable_count(system) <= 64);
    for (on = 1; on >= 0; --on) {
        options.skip_guard = !on;
        GPROJT_REQUIRE(gproj_solve_begin(form, 10, &options, NULL));
        for (i = 0; i < 10; ++i)
            for (face = 0; face < 3; ++face) {
                bool refused = on && face < 2 && step[i].refused[face];
                for (end = 0; end < 2; ++end) {
                    memcpy(values[end], gproj_system_values(system),
                           (size_t)gproj_system_variable_count(system) * sizeof(double));
                    gprojt_place_face(form, mesh, face, step[i].angle[end], step[i].size[end], values[end]);
                }
                GPROJT_CHECK(gprojt_inside_refuses_turned(form, values[0], values[1]) == refused);
            }
        gproj_solve_stop(form);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A face without area cannot lose any: it does not refuse the steps of the others. */
GPROJT_TEST(faces_without_area) {
    gproj_mesh *mesh = gprojt_noisy(0, 5, 0.05, 4);
    gproj_solve_options options = gprojt_nearest();
    int32_t face = 12, h = mesh->face_halfedge[face], k, c;
    gproj_form *form;
    for (k = 1; k < 4; ++k) /* all corners in one point */
        for (c = 0, h = mesh->next[h]; c < 3; ++c)
            mesh->position[3 * mesh->origin[h] + c] = mesh->position[3 * mesh->origin[mesh->prev[h]] + c];
    form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1);
    GPROJT_CHECK(gproj_solve(form, 60, &options).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).planarity_max < 1e-9);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* The meshes and the figures of other tools, where the folder is there. */
GPROJT_TEST(real_meshes) {
    static const struct {
        const char *name;
        double rms;
    } known[] = {{"Intersection", 7.6e-4},   {"botanic-garden", 1.25e-3}, {"M2_eq_quad2", 4.3e-3}, {"heart", 7.6e-3},
                 {"eyeye_circular", 3.6e-3}, {"tubemesh", 5.2e-3},        {"YasIsland", 7.4e-6},   {"hypar", 7.8e-2}};
    int i;
    for (i = 0; i < 8; ++i) {
        char path[512];
        gproj_mesh *mesh;
        gproj_measures m;
        gproj_result result;
        snprintf(path, sizeof path, "%s/%s.obj", gprojt_data_folder(), known[i].name);
        mesh = gproj_mesh_load(path, NULL, NULL);
        if (!mesh) GPROJT_SKIP("the folder of real meshes is not there");
#ifdef GPROJT_SANITIZED
        if (mesh->vertex_count > 300) { /* the others take their time */
            gproj_mesh_destroy(mesh);
            continue;
        }
#endif
        m = gprojt_measure_solve(mesh, gprojt_ask_planar, true, 30, NULL, &result, NULL);
        if (m.deviation_rms > known[i].rms || m.planarity_max > 1e-12 || m.turned_faces > 0)
            printf("    %s: rms %g, planarity %g, %d turned\n", known[i].name, m.deviation_rms, m.planarity_max,
                   m.turned_faces);
        GPROJT_CHECK(m.deviation_rms <= known[i].rms && m.planarity_max <= 1e-12 && m.turned_faces == 0);
        gproj_mesh_destroy(mesh);
    }
}

/* Where a direction has hardly any curvature no matrix shows a minimum: it is taken for one when slides lower nothing. */
GPROJT_TEST(flat_minima_are_accepted) {
    gproj_solve_options options = gprojt_nearest();
    gproj_result result;
    gproj_form *form;
    gproj_mesh *mesh;
    char path[512];
#ifdef GPROJT_SANITIZED
    GPROJT_SKIP("a large mesh is for plain builds");
#endif
    snprintf(path, sizeof path, "%s/botanic-garden.obj", gprojt_data_folder());
    mesh = gproj_mesh_load(path, NULL, NULL);
    if (!mesh) GPROJT_SKIP("the folder of real meshes is not there");
    form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1), gproj_add_gliding_boundary(form, 1);
    result = gproj_solve(form, 200, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.optimality <= 1e-6 && result.iterations < 190);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

static void gprojt_add_planarity(gproj_form *form, void *user) {
    (void)user;
    gproj_add_planarity(form, 1);
}

GPROJT_TEST(every_allocation_fails_once) {
    gproj_mesh *mesh = gprojt_noisy(0, 3, 0.05, 5);
    gproj_solve_options options = gprojt_nearest();
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_add_planarity, NULL, 30, &options) >= 30);
    gproj_mesh_destroy(mesh);
}

/* Also where rows are added on the way, because the mesh is spoiled. */
GPROJT_TEST(mended_without_memory) {
    gproj_mesh *mesh = gprojt_noisy(0, 3, 0.4, 7);
    gproj_solve_options options = gprojt_nearest();
    GPROJT_CHECK(gprojt_flatten(mesh, 50, false).spoiled.total > 0);
    GPROJT_CHECK(gprojt_flatten(mesh, 60, false).spoiled.total == 0);
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_add_planarity, NULL, 60, &options) >= 30);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(nearest_on_ellipsoids);
    GPROJT_RUN(short_first_steps);
    GPROJT_RUN(nearest_on_two_quadrics);
    GPROJT_RUN(nearest_in_a_ball);
    GPROJT_RUN(bounds_let_go);
    GPROJT_RUN(farthest_points_are_left);
    GPROJT_RUN(rows_that_depend_on_each_other);
    GPROJT_RUN(slides_stay_in_reach);
    GPROJT_RUN(global_rows);
    GPROJT_RUN(one_side_only);
    GPROJT_RUN(wishes_without_rows);
    GPROJT_RUN(weights_are_ratios);
    GPROJT_RUN(optimality_has_no_unit);
    GPROJT_RUN(moves_less_than_projection);
    GPROJT_RUN(spoiled_meshes_are_mended);
    GPROJT_RUN(earlier_safeguards_rest);
    GPROJT_RUN(safeguards_yield_to_constraints);
    GPROJT_RUN(conditions_of_kuhn_and_tucker);
    GPROJT_RUN(bounds_seldom_block);
    GPROJT_RUN(nothing_to_do);
    GPROJT_RUN(same_bits_for_all_crews);
    GPROJT_RUN(honest_verdicts);
    GPROJT_RUN(sentences_where_constraints_hold);
    GPROJT_RUN(wishes_that_change_on_the_way);
    GPROJT_RUN(refreshes_know_the_step_that_follows);
    GPROJT_RUN(without_weight);
    GPROJT_RUN(wishes_beyond_all_numbers);
    GPROJT_RUN(wishes_stay_on);
    GPROJT_RUN(closeness_rests_where_it_is_not_wanted);
    GPROJT_RUN(steps_that_turn_faces_are_refused);
    GPROJT_RUN(faces_without_area);
    GPROJT_RUN(real_meshes);
    GPROJT_RUN(flat_minima_are_accepted);
    GPROJT_RUN(every_allocation_fails_once);
    GPROJT_RUN(mended_without_memory);
    return gprojt_report();
}
