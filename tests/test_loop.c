/* test_loop.c - >>loop: known problems, every verdict, schedules, damping, time, memory, the same bits. */
#define GPROJ_STATIC
#include "gprojt_form.h"

/* What the callback sees, and what it is told to do. */
typedef struct gprojt_watch {
    int32_t count, cancel_at, change_at, change_group;
    gproj_schedule change;
    gproj_iteration seen[64];
    double x[64];
    uint64_t allocations[64];
} gprojt_watch;

static bool gprojt_on_iteration(void *user, gproj_system *s, const gproj_iteration *iteration) {
    gprojt_watch *w = (gprojt_watch *)user;
    GPROJT_CHECK(iteration->number == w->count + 1);
    if (w->count == 64) return false;
    w->seen[w->count] = *iteration;
    w->x[w->count] = gproj_system_values(s)[0];
    w->allocations[w->count] = gproj_system_memory(s).allocations;
    w->count++;
    if (w->count == w->change_at) gproj_system_set_schedule(s, w->change_group, w->change);
    return w->count != w->cancel_at;
}

static gproj_solve_options gprojt_watched(gprojt_watch *watch) {
    gproj_solve_options options;
    memset(&options, 0, sizeof options);
    watch->count = 0;
    options.on_iteration = gprojt_on_iteration;
    options.user = watch;
    return options;
}

static gproj_system *gprojt_system(const gproj_host *host, int32_t count, int32_t block, const double *x) {
    gproj_system *s = gproj_system_create(host);
    gproj_system_add_variables(s, count, block, x);
    return s;
}

/* -- known problems -- */

static void gprojt_check_quadratic(const gprojt_watch *w) {
    int32_t n;
    for (n = 1; n < w->count; ++n) {
        double before = w->seen[n - 1].residual;
        if (before < 0.05) GPROJT_CHECK(w->seen[n].residual <= 5 * before * before + 1e-14);
    }
}

GPROJT_TEST(sphere_and_planes) {
    static const double start[3] = {2, 0.1, 0.8};
    gproj_system *s = gprojt_system(NULL, 3, 3, start);
    gproj_term sphere[3], plane[3];
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    int32_t k;
    memset(&watch, 0, sizeof watch);
    for (k = 0; k < 3; ++k) {
        sphere[k] = gprojt_term(k, k, 1);
        plane[k] = gprojt_term(k, -1, k == 2 ? -2 : 1);
    }
    gprojt_add_group(s, "sphere", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "planes", GPROJ_CONSTRAINT, 2);
    gproj_system_add_row(s, 0, 3, sphere, -6, 0);
    gproj_system_add_row(s, 1, 3, plane, 0, 1);
    gprojt_add_linear(s, 1, 2, 1, -1, 2);
    options = gprojt_watched(&watch);
    result = gproj_system_solve(s, 20, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 8 && result.damped == 0);
    GPROJT_CHECK(result.residual <= 1e-13 && result.iterations == watch.count);
    GPROJT_CHECK(strstr(result.message, "all constraints hold to the tolerance") != NULL);
    GPROJT_CHECK(result.spoiled.total == 0 && result.spoiled.place == GPROJ_PLACE_NONE && result.spoiled.element == -1);
    GPROJT_NEAR(gproj_system_values(s)[2], 1, 1e-12);
    GPROJT_NEAR(gproj_system_values(s)[0] + gproj_system_values(s)[1], 2, 1e-12);
    gprojt_check_quadratic(&watch);
    GPROJT_CHECK(watch.seen[0].factorisations == 1 && watch.seen[0].length == 1 && watch.seen[0].epsilon == 1e-3);
    GPROJT_CHECK(watch.seen[watch.count - 1].epsilon == 1e-5); /* it follows the residual */
    GPROJT_CHECK(watch.seen[watch.count - 1].residual == result.residual && watch.seen[0].energy == 0);
    gproj_system_destroy(s);
}

/* Seven equal circles of radius 1/2, six around one, tangent as they should be. */
GPROJT_TEST(circle_packing) {
    gproj_system *s = gprojt_system(NULL, 14, 2, NULL);
    double *x = gproj_system_values(s);
    uint64_t seed = 4;
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    int32_t k;
    memset(&watch, 0, sizeof watch);
    gprojt_add_group(s, "tangency", GPROJ_CONSTRAINT, 1);
    for (k = 1; k < 7; ++k) {
        x[2 * k] = cos(k * 1.0471975511965976) + 0.2 * gprojt_uniform(&seed);
        x[2 * k + 1] = sin(k * 1.0471975511965976) + 0.2 * gprojt_uniform(&seed);
        gprojt_add_distance(s, 0, 0, 2 * k, 2, 1, k);
        if (k > 1) gprojt_add_distance(s, 0, 2 * k - 2, 2 * k, 2, 1, 10 + k);
    }
    options = gprojt_watched(&watch);
    result = gproj_system_solve(s, 20, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 8);
    gprojt_check_quadratic(&watch);
    for (k = 1; k < 7; ++k) GPROJT_NEAR(hypot(x[2 * k] - x[0], x[2 * k + 1] - x[1]), 1, 1e-12);
    GPROJT_NEAR(hypot(x[12] - x[2], x[13] - x[3]), 1, 1e-11); /* the last touches the first, without a row */
    GPROJT_CHECK(gproj_system_check_gradients(s) < 1e-9);
    gproj_system_destroy(s);
}

/* -- verdicts -- */

static gproj_system *gprojt_conflict(void) {
    gproj_system *s = gprojt_system(NULL, 1, 1, NULL);
    gprojt_add_group(s, "zero", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "one", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1, 0, 40);
    gprojt_add_linear(s, 1, 0, 1, -1, 41);
    return s;
}

GPROJT_TEST(stalled_names_both_groups) {
    gproj_system *s = gprojt_conflict();
    gproj_result result = gproj_system_solve(s, 50, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations < 12);
    GPROJT_NEAR(gproj_system_values(s)[0], 0.5, 1e-6);
    GPROJT_NEAR(result.residual, 0.5, 1e-6);
    GPROJT_CHECK(strstr(result.message, "'zero'") && strstr(result.message, "'one'"));
    GPROJT_CHECK(strstr(result.message, "work against each other") && strstr(result.message, ", vertex 4"));
    GPROJT_CHECK(result.worst_element == 40 + result.worst_group);
    gproj_system_destroy(s);
}

GPROJT_TEST(iteration_limit) {
    gproj_system *s = gprojt_conflict();
    gproj_result result = gproj_system_solve(s, 2, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_ITERATION_LIMIT && result.iterations == 2);
    GPROJT_CHECK(!strncmp(
        result.message, "the iterations ran out before all constraints held: 2 iterations, largest residual 0.5", 85));
    GPROJT_CHECK(strstr(result.message, ", vertex 4") &&
                 strstr(result.message, "); allow more iterations, or ask for less"));
    result = gproj_system_solve(s, 0, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_ITERATION_LIMIT && result.iterations == 0 && result.step == 0);
    gproj_system_destroy(s);
}

GPROJT_TEST(converged_without_a_step) {
    static const double x[1] = {3};
    gproj_system *s = gprojt_system(NULL, 1, 1, x);
    gproj_result result;
    gprojt_add_group(s, "three", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1, -3, 0);
    result = gproj_system_solve(s, 9, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations == 0 && result.step == 0);
    result = gproj_system_solve(s, 0, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gproj_system_values(s)[0] == 3);
    gproj_system_destroy(s);
}

GPROJT_TEST(cancelled_keeps_the_state) {
    gproj_system *s = gprojt_conflict();
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    memset(&watch, 0, sizeof watch);
    watch.cancel_at = 2;
    options = gprojt_watched(&watch);
    result = gproj_system_solve(s, 20, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CANCELLED && result.iterations == 2 && watch.count == 2);
    GPROJT_CHECK(strstr(result.message, "cancelled by the caller"));
    GPROJT_CHECK(gproj_system_values(s)[0] == watch.x[1] && result.residual == watch.seen[1].residual);
    gproj_system_destroy(s);
}

static gproj_host gprojt_ticking(gprojt_ticks *ticks) {
    gproj_host host;
    memset(&host, 0, sizeof host);
    memset(ticks, 0, sizeof *ticks);
    host.clock.now = gprojt_tick;
    host.clock.user = ticks;
    return host;
}

static gproj_system *gprojt_slow_system(const gproj_host *host) {
    static const double x[3] = {1, 2, 3};
    gproj_system *s = gprojt_system(host, 3, 3, x);
    gproj_term square = gprojt_term(0, 0, 1);
    gprojt_add_group(s, "square", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "all", GPROJ_CONSTRAINT, 1);
    gproj_system_add_row(s, 0, 1, &square, 0, 0); /* a double root: slow */
    gprojt_add_linear(s, 1, 1, 1, 0, 0);
    return s;
}

GPROJT_TEST(time_out) {
    gprojt_ticks ticks;
    gproj_host host = gprojt_ticking(&ticks);
    gproj_system *s = gprojt_slow_system(&host);
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    options.time_budget = 20;
    result = gproj_system_solve(s, 1000, &options);
    GPROJT_CHECK(result.outcome == GPROJ_TIME_OUT && result.iterations > 0 && result.iterations < 8);
    GPROJT_CHECK(strstr(result.message, "the time budget ran out"));
    GPROJT_CHECK(ticks.now >= 20 && ticks.now < 40);
    gproj_system_destroy(s);
}

GPROJT_TEST(seconds_add_up) {
    gprojt_ticks ticks;
    gproj_host host = gprojt_ticking(&ticks);
    gproj_system *s = gprojt_slow_system(&host);
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    double sum = 0, of_iterations = 0;
    int32_t n, phase;
    memset(&watch, 0, sizeof watch);
    options = gprojt_watched(&watch);
    result = gproj_system_solve(s, 4, &options);
    for (phase = 0; phase < GPROJ_PHASE_COUNT; ++phase) {
        GPROJT_CHECK(result.seconds[phase] > 0);
        sum += result.seconds[phase];
        for (n = 0; n < watch.count; ++n) of_iterations += watch.seen[n].seconds[phase];
    }
    GPROJT_NEAR(sum, ticks.now - 1 - watch.count, 0); /* but the start and the callbacks */
    GPROJT_NEAR(sum - of_iterations, 2, 0);           /* the analysis and the rows before the first step */
    result = gproj_system_solve(s, 1, NULL);
    GPROJT_NEAR(result.seconds[GPROJ_PHASE_ANALYSE], 1, 0); /* one tick: nothing to do */
    gproj_system_destroy(s);
}

/* The state of a solve at its first refresh is that of a solve in which none has begun, with this solve's limit. */
static void gprojt_first_refresh(void *user, gproj_system *s, int32_t group, const gproj_progress *progress) {
    int32_t *seen = (int32_t *)user;
    (void)s, (void)group;
    if (++seen[0] > 1) return;
    seen[1] = progress->iteration, seen[2] = progress->iterations;
}

GPROJT_TEST(first_refreshes) {
    static const double x[1] = {5};
    gproj_system *s = gprojt_system(NULL, 1, 1, x);
    gproj_group group;
    int32_t seen[3], limit;
    memset(&group, 0, sizeof group);
    group.name = "seen", group.schedule = gproj_keep(1);
    group.refresh = gprojt_first_refresh, group.refresh_user = seen;
    gprojt_add_linear(s, gproj_system_add_group(s, &group), 0, 1, 0, 0);
    for (limit = 20; limit > 0; limit -= 10) {
        memset(seen, 0, sizeof seen);
        gproj_system_values(s)[0] = 5;
        gproj_system_solve(s, limit, NULL);
        GPROJT_CHECK(seen[0] > 0 && seen[1] == 0 && seen[2] == limit);
    }
    gproj_system_destroy(s);
}

static void gprojt_bad_refresh(void *user, gproj_system *s, int32_t group, const gproj_progress *progress) {
    (void)progress;
    if (++*(int *)user == 2) gproj_system_set_row(s, group, 99, NULL, 0);
}

GPROJT_TEST(failed_by_an_error_on_the_way) {
    static const double x[1] = {5};
    gproj_system *s = gprojt_system(NULL, 1, 1, x);
    gproj_group group;
    gproj_result result;
    int calls = 0;
    memset(&group, 0, sizeof group);
    group.name = "moving", group.schedule = gproj_keep(1), group.refresh = gprojt_bad_refresh,
    group.refresh_user = &calls;
    gproj_system_add_group(s, &group);
    gprojt_add_linear(s, 0, 0, 1, 0, 0);
    result = gproj_system_solve(s, 9, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_FAILED && strstr(result.message, "no row 99"));
    GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_ERROR_INDEX && gproj_system_error(s)->index == 99);
    gproj_system_destroy(s);
    s = gprojt_system(NULL, 1, 1, x); /* in the first call, which finds that the constraint holds */
    calls = 1;
    gproj_system_add_group(s, &group);
    gprojt_add_linear(s, 0, 0, 1, -5, 0);
    result = gproj_system_solve(s, 9, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_FAILED && strstr(result.message, "no row 99"));
    gproj_system_destroy(s);
    s = gprojt_system(NULL, 1, 1, x);
    calls = 1;
    gproj_system_add_group(s, &group);
    GPROJT_CHECK(gproj_system_check_gradients(s) == HUGE_VAL);
    gproj_system_destroy(s);
}

static bool gprojt_do_wrong_in(void *user, gproj_system *s, const gproj_iteration *iteration) {
    if (iteration->number == *(const int32_t *)user) gproj_system_set_row(s, 0, 99, NULL, 0);
    return true;
}

/* Errors made by a callback end the solve, and not less so after the last iteration. */
GPROJT_TEST(failed_by_an_error_of_a_callback) {
    int32_t nearest, at;
    for (nearest = 0; nearest < 2; ++nearest)
        for (at = 1; at <= 4; ++at) {
            static const double x[2] = {5, 3};
            gproj_system *s = gprojt_system(NULL, 2, 1, x);
            gproj_term square = gprojt_term(0, 0, 1);
            gproj_solve_options options;
            gproj_result result;
            memset(&options, 0, sizeof options);
            options.on_iteration = gprojt_do_wrong_in, options.user = &at, options.nearest = nearest == 1;
            gprojt_add_group(s, "square", GPROJ_CONSTRAINT, 1);
            gprojt_add_group(s, "wish", GPROJ_WISH, 0.1);
            gproj_system_add_row(s, 0, 1, &square, 0, 0); /* a double root: slow */
            gprojt_add_linear(s, 1, 1, 1, 0, 0);
            result = gproj_system_solve(s, 4, &options);
            GPROJT_CHECK(result.outcome == GPROJ_FAILED && strstr(result.message, "no row 99"));
            GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_ERROR_INDEX);
            GPROJT_CHECK(gproj_system_values(s)[0] > 0 && gproj_system_values(s)[0] < 5);
            gproj_system_destroy(s);
        }
}

/* Refuses a number of steps, from the first one on that begins near the minimum. */
typedef struct gprojt_refusing {
    int32_t steps;
    bool near;
} gprojt_refusing;

static bool gprojt_see_optimality(void *user, gproj_system *s, const gproj_iteration *iteration) {
    (void)s;
    ((gprojt_refusing *)user)->near |= iteration->optimality < 1e-2;
    return true;
}

static bool gprojt_refuse_some(void *user, const double *before, const double *after) {
    gprojt_refusing *r = (gprojt_refusing *)user;
    (void)before, (void)after;
    return r->near && r->steps-- > 0;
}

/* x^2 + y^2 = 1 nearest to (3, 4), but steps are refused for a while: first all those with curvature, which are tried first, then
   some without. If no step is left the verdict says so. */
GPROJT_TEST(refused_slides) {
    static const double x[2] = {0, 1};
    static const int32_t refused[] = {0, 1, 17, 18, 19, 30, 1000};
    int32_t k;
    for (k = 0; k < 7; ++k) {
        gproj_system *s = gprojt_system(NULL, 2, 2, x);
        gproj_term square[2] = {{0, 0, 1}, {1, 1, 1}};
        gproj_solve_options options;
        gproji_loop loop;
        gprojt_refusing refusing;
        refusing.steps = refused[k], refusing.near = false;
        memset(&options, 0, sizeof options);
        options.nearest = true, options.on_iteration = gprojt_see_optimality, options.user = &refusing;
        gprojt_add_group(s, "circle", GPROJ_CONSTRAINT, 1);
        gprojt_add_group(s, "wish", GPROJ_WISH, 1);
        gproj_system_add_row(s, 0, 2, square, -1, 0);
        gprojt_add_linear(s, 1, 0, 1, -3, 0);
        gprojt_add_linear(s, 1, 1, 1, -4, 0);
        GPROJT_REQUIRE(gproji_begin_loop(&loop, s, 1, false, 60, &options));
        loop.hooks.refuse = gprojt_refuse_some, loop.hooks.user = &refusing;
        GPROJT_CHECK(gproji_run(&loop, -1) && refusing.near);
        GPROJT_CHECK(loop.result.residual <= loop.result.tolerance);
        if (refused[k] < 1000) {
            GPROJT_CHECK(loop.result.outcome == GPROJ_CONVERGED && refusing.steps < 0);
            GPROJT_NEAR(gproj_system_values(s)[0], 0.6, 1e-6);
            GPROJT_NEAR(gproj_system_values(s)[1], 0.8, 1e-6);
        } else {
            GPROJT_CHECK(loop.result.outcome == GPROJ_STALLED);
            GPROJT_CHECK(
                strstr(loop.result.message, "all constraints hold to the tolerance, and no step serves the wishes"));
        }
        gproj_system_destroy(s);
    }
}

static bool gprojt_see_slopes(void *user, gproj_system *s, const gproj_iteration *iteration) {
    static const double h = 1e-5, along[3][2] = {{1, 0}, {0, 1}, {1, -2}};
    double *steepest = (double *)user, at[4], slope, x[2];
    int32_t i, k;
    (void)iteration;
    for (i = 0; i < 3; ++i) {
        memcpy(s->vector.step, along[i], sizeof along[i]);
        for (k = 0; k < 4; ++k) {
            double t = (k < 2 ? k - 2 : k - 1) * h; /* -2h, -h, h, 2h: differences that are exact for quartics */
            x[0] = s->x[0] + t * along[i][0], x[1] = s->x[1] + t * along[i][1];
            at[k] = gproji_lagrangian(s, x, false).value;
        }
        slope = gproji_lagrangian(s, s->x, true).slope;
        GPROJT_NEAR(slope, (8 * (at[2] - at[1]) - (at[3] - at[0])) / (12 * h), 1e-9 + 1e-9 * fabs(slope));
        *steepest = fmax(*steepest, fabs(slope));
    }
    return true;
}

/* The slope of the augmented Lagrangian is its derivative along a step, with multipliers, a bound that acts, and one that
   does not. */
GPROJT_TEST(slopes_of_slides) {
    static const double start[2] = {-0.3, 1};
    gproj_system *s = gprojt_system(NULL, 2, 2, start);
    gproj_term square[2] = {{0, 0, 1}, {1, 1, 1}};
    gproj_solve_options options;
    double steepest = 0;
    memset(&options, 0, sizeof options);
    options.nearest = true, options.on_iteration = gprojt_see_slopes, options.user = &steepest;
    gprojt_add_group(s, "circle", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "wish", GPROJ_WISH, 1);
    gprojt_add_group(s, "bounds", GPROJ_BOUND, 1);
    gproj_system_add_row(s, 0, 2, square, -1, 0);
    gprojt_add_linear(s, 1, 0, 1, -3, 0);
    gprojt_add_linear(s, 1, 1, 1, -4, 0);
    gprojt_add_linear(s, 2, 0, -1, 0.5, 0); /* x <= 1/2 */
    gprojt_add_linear(s, 2, 1, 1, 5, 1);    /* y >= -5 */
    GPROJT_CHECK(gproj_system_solve(s, 60, &options).outcome == GPROJ_CONVERGED && steepest > 1e-3);
    GPROJT_NEAR(gproj_system_values(s)[0], 0.5, 1e-6);
    gproj_system_destroy(s);
}

/* What a callback may not do: it would pull the arrays from under the solve. */
typedef struct gprojt_meddler {
    int what;
    bool from_refresh;
    long answer;
} gprojt_meddler;

static void gprojt_meddle(gprojt_meddler *m, gproj_system *s) {
    gproj_term term = gprojt_term(0, -1, 1);
    if (m->what == 0) m->answer = gproj_system_add_variables(s, 3000, 3, NULL);
    if (m->what == 1) m->answer = gprojt_add_group(s, "late", GPROJ_CONSTRAINT, 1);
    if (m->what == 2) m->answer = gproj_system_add_row(s, 0, 1, &term, 0, 0);
    if (m->what == 3) m->answer = gproj_system_solve(s, 3, NULL).outcome == GPROJ_FAILED ? -1 : 0;
    if (m->what == 4) m->answer = gproj_system_check_gradients(s) == HUGE_VAL ? -1 : 0;
}

static void gprojt_meddling_refresh(void *user, gproj_system *s, int32_t group, const gproj_progress *progress) {
    (void)progress;
    (void)group;
    if (((gprojt_meddler *)user)->from_refresh) gprojt_meddle((gprojt_meddler *)user, s);
}

static bool gprojt_meddling_iteration(void *user, gproj_system *s, const gproj_iteration *iteration) {
    (void)iteration;
    if (!((gprojt_meddler *)user)->from_refresh) gprojt_meddle((gprojt_meddler *)user, s);
    return true;
}

static void gprojt_check_meddler(gprojt_meddler m) {
    gproj_system *s = gprojt_conflict();
    gproj_solve_options options;
    gproj_result result;
    gproj_group group;
    memset(&options, 0, sizeof options);
    memset(&group, 0, sizeof group);
    options.on_iteration = gprojt_meddling_iteration, options.user = &m;
    group.name = "meddler", group.schedule = gproj_keep(1), group.refresh = gprojt_meddling_refresh,
    group.refresh_user = &m;
    gproj_system_add_group(s, &group);
    result = gproj_system_solve(s, 5, &options);
    GPROJT_CHECK(m.answer == -1 && result.outcome == GPROJ_FAILED && gproj_system_error(s)->code == GPROJ_ERROR_STATE);
    GPROJT_CHECK(strstr(result.message, "during a solve") != NULL && gproj_system_variable_count(s) == 1);
    gproj_system_destroy(s);
}

GPROJT_TEST(callbacks_may_not_rebuild) {
    int i;
    for (i = 0; i < 10; ++i) {
        gprojt_meddler m;
        m.what = i / 2, m.from_refresh = i % 2 != 0, m.answer = 0;
        gprojt_check_meddler(m);
    }
}

/* Numbers that are not finite are never "all constraints hold". */
GPROJT_TEST(values_that_are_no_numbers) {
    static const double bad[2] = {NAN, HUGE_VAL};
    int i;
    for (i = 0; i < 2; ++i) {
        static const double x[2] = {1, 2};
        gproj_system *s = gprojt_system(NULL, 2, 1, x);
        gproj_result result;
        gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 0, 0, 1, 0, 0);
        gprojt_add_linear(s, 0, 1, 1, -2, 1); /* holds */
        gproj_system_values(s)[0] = bad[i];
        result = gproj_system_solve(s, 9, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_FAILED && gproj_system_error(s)->code == GPROJ_ERROR_NUMBER);
        GPROJT_CHECK(gproj_system_error(s)->place == GPROJ_PLACE_VARIABLE && gproj_system_error(s)->index == 0);
        gproj_system_destroy(s);
    }
}

/* Rows that overflow, to infinity or to no number: no step is possible, x stays, and the verdict is not a good one. */
GPROJT_TEST(rows_that_overflow) {
    static const double x[3] = {1e200, 1e200, 2};
    int i;
    for (i = 0; i < 2; ++i) {
        gproj_system *s = gprojt_system(NULL, 3, 1, x);
        gproj_term squares[2] = {{0, 0, 1}, {1, 1, -1}};
        gproj_result result;
        gprojt_add_group(s, "square", GPROJ_CONSTRAINT, 1);
        gproj_system_add_row(s, 0, i + 1, squares, -1, 7);
        gprojt_add_linear(s, 0, 2, 1, -2, 8); /* holds */
        result = gproj_system_solve(s, 9, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.worst_element == 7 && result.residual > 1e300);
        GPROJT_CHECK(gproj_system_group_info(s, 0).max > 1e300 && gproj_system_group_info(s, 0).worst_element == 7);
        GPROJT_CHECK(!memcmp(x, gproj_system_values(s), sizeof x));
        gproj_system_destroy(s);
    }
}

/* A step beyond what a double holds is not taken. */
GPROJT_TEST(steps_that_overflow) {
    static const double x[1] = {1};
    gproj_system *s = gprojt_system(NULL, 1, 1, x);
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    options.epsilon = 1e-150;
    gprojt_add_group(s, "faint", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1e-160, 1e300, 0);
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations == 0 && gproj_system_values(s)[0] == 1);
    gproj_system_destroy(s);
}

/* Undamped steps, too, end where numbers do: x^2 + x + 1e153 = 0 is 0 far beyond them. */
GPROJT_TEST(undamped_steps_that_overflow) {
    static const gproj_term term[2] = {{0, 0, 1}, {0, -1, 1}};
    gproj_system *s = gprojt_system(NULL, 1, 1, NULL);
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    options.skip_damping = true;
    gprojt_add_group(s, "far", GPROJ_CONSTRAINT, 1);
    gproj_system_add_row(s, 0, 2, term, 1e153, 0);
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations == 0);
    GPROJT_CHECK(gproj_system_values(s)[0] == 0 && result.residual == 1e153);
    gproj_system_destroy(s);
}

/* 1e-80 x = 1, by a refresh whose coefficient is beyond all numbers at the solution. */
static void gprojt_overflowing_refresh(void *user, gproj_system *s, int32_t group, const gproj_progress *progress) {
    double coefficient = fabs(gproj_system_values(s)[0]) < 1 ? 1e-80 : HUGE_VAL;
    (void)user, (void)progress;
    gproj_system_set_row(s, group, 0, &coefficient, -1);
}

/* No step is longer than 1e70, so a refresh that has no numbers so far away ends no undamped solve. */
GPROJT_TEST(undamped_steps_to_rows_that_overflow) {
    static const double x[1] = {0};
    gproj_system *s = gprojt_system(NULL, 1, 1, x);
    gproj_group group;
    gproj_solve_options options;
    gproj_result result;
    memset(&group, 0, sizeof group);
    memset(&options, 0, sizeof options);
    options.skip_damping = true, options.epsilon = 1e-90;
    group.name = "far", group.schedule = gproj_keep(1), group.refresh = gprojt_overflowing_refresh;
    gproj_system_add_group(s, &group);
    gprojt_add_linear(s, 0, 0, 1, -1, 0);
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations == 0 && gproj_system_values(s)[0] == 0);
    GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK);
    gproj_system_destroy(s);
}

/* x = 1, by a refresh whose row beyond `edge` has numbers, but no square of one. */
static void gprojt_edge_refresh(void *user, gproj_system *s, int32_t group, const gproj_progress *progress) {
    double coefficient = gproj_system_values(s)[0] > *(const double *)user ? 1e200 : 1;
    (void)progress;
    gproj_system_set_row(s, group, 0, &coefficient, -1);
}

/* A step to where the merit is beyond all numbers is taken back, and tried again with a larger eps: x comes up to that
   place and no further. */
GPROJT_TEST(steps_beyond_all_numbers_are_taken_back) {
    static const double x[1] = {0};
    int undamped;
    for (undamped = 0; undamped < 2; ++undamped) {
        gproj_system *s = gprojt_system(NULL, 1, 1, x);
        gproj_group group;
        gproj_solve_options options;
        gproj_result result;
        double edge = 0.6, end;
        memset(&group, 0, sizeof group);
        memset(&options, 0, sizeof options);
        options.skip_damping = undamped != 0;
        group.name = "edge", group.schedule = gproj_keep(1), group.refresh = gprojt_edge_refresh;
        group.refresh_user = &edge;
        gproj_system_add_group(s, &group);
        gprojt_add_linear(s, 0, 0, 1, -1, 0);
        result = gproj_system_solve(s, 40, &options);
        end = gproj_system_values(s)[0];
        GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.damped > 0 && gproj_system_error(s)->code == GPROJ_OK);
        GPROJT_CHECK(end > 0 && end <= edge);
        GPROJT_NEAR(result.residual, 1 - end, 1e-12);
        gproj_system_destroy(s);
    }
}

/* An undamped solve whose residual falls slowly, by 2 % a step, loses patience; but not where the last of these steps is the one
   that reaches the tolerance. */
GPROJT_TEST(patience_ends_where_constraints_hold) {
    static const double x[1] = {1};
    int32_t reached;
    for (reached = 0; reached < 2; ++reached) {
        gproj_system *s = gprojt_system(NULL, 1, 1, x);
        gproj_solve_options options;
        gproj_result result;
        memset(&options, 0, sizeof options);
        options.skip_damping = true, options.epsilon = 7; /* eps^2 / (1 + eps^2) = 0.98 */
        options.tolerance = pow(0.98, reached ? 5.5 : 6.5);
        gprojt_add_group(s, "slow", GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 0, 0, 1, 0, 0);
        result = gproj_system_solve(s, 50, &options);
        GPROJT_CHECK(result.iterations == 6 && result.outcome == (reached ? GPROJ_CONVERGED : GPROJ_STALLED));
        GPROJT_NEAR(result.residual, pow(0.98, 6), 1e-12);
        gproj_system_destroy(s);
    }
}

/* As long as there is a group that no step can serve there is no step. That it will go is known from its schedule: the
   solve waits for that, in no time, and then does what can be done. */
static void gprojt_check_wait(gproj_kind kind, gproj_schedule schedule, int32_t iterations, gproj_outcome outcome,
                              int32_t last) {
    static const double x[2] = {1, 5};
    int32_t faint; /* in either order */
    for (faint = 0; faint < 2; ++faint) {
        gproj_system *s = gprojt_system(NULL, 2, 1, x);
        gproj_solve_options options;
        gproj_result result;
        memset(&options, 0, sizeof options);
        options.epsilon = 1e-150;
        gprojt_add_group(s, "first", faint == 0 ? kind : GPROJ_CONSTRAINT, 1);
        gprojt_add_group(s, "second", faint == 1 ? kind : GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 1 - faint, 1, 1, -2, 0);
        gprojt_add_linear(s, faint, 0, 1e-160, 1e300, 0); /* see steps_that_overflow */
        gproj_system_set_schedule(s, faint, schedule);
        result = gproj_system_solve(s, iterations, &options);
        GPROJT_CHECK(result.outcome == outcome && result.iterations == last);
        GPROJT_CHECK(gproj_system_values(s)[0] == 1);
        GPROJT_CHECK(gproj_system_values(s)[1] == (outcome == GPROJ_CONVERGED ? 2 : 5));
        gproj_system_destroy(s);
    }
}

/* If the constraints hold already, and no step serves the wishes, there is nothing to be done. */
GPROJT_TEST(wishes_that_no_step_serves) {
    static const double x[2] = {1, 2};
    gproj_system *s = gprojt_system(NULL, 2, 1, x);
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    options.epsilon = 1e-150;
    gprojt_add_group(s, "held", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "faint", GPROJ_WISH, 1);
    gprojt_add_linear(s, 0, 1, 1, -2, 0);
    gprojt_add_linear(s, 1, 0, 1e-160, 1e300, 0);
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations == 0 && result.residual == 0);
    GPROJT_CHECK(gproj_system_values(s)[0] == 1 && gproj_system_values(s)[1] == 2);
    gproj_system_destroy(s);
}

GPROJT_TEST(no_verdict_before_schedules_end) {
    gprojt_check_wait(GPROJ_WISH, gprojt_schedule(1, 0, 3), 9, GPROJ_CONVERGED, 4);
    gprojt_check_wait(GPROJ_WISH, gprojt_schedule(1, 0, 8), 9, GPROJ_CONVERGED, 9);
    gprojt_check_wait(GPROJ_WISH, gprojt_schedule(1, 0, 9), 9, GPROJ_STALLED, 0); /* it does not end in time */
    gprojt_check_wait(GPROJ_WISH, gprojt_schedule(1, 0, 0), 9, GPROJ_STALLED, 0);
    gprojt_check_wait(GPROJ_WISH, gprojt_schedule(1, 1, 1 << 30), INT32_MAX, GPROJ_CONVERGED, (1 << 30) + 1);
    gprojt_check_wait(GPROJ_WISH, gprojt_schedule(1, 0.9, 3), 9, GPROJ_CONVERGED, 4);
    gprojt_check_wait(GPROJ_WISH, gprojt_schedule(1, 0.9, 0), 9, GPROJ_STALLED, 8); /* tried with each weight */
    gprojt_check_wait(GPROJ_CONSTRAINT, gprojt_schedule(1, 0.9, 3), 9, GPROJ_CONVERGED, 4);
    gprojt_check_wait(GPROJ_CONSTRAINT, gprojt_schedule(1, 0.9, 0), 9, GPROJ_STALLED, 0);
}

/* eps^2 that vanishes in floating point leaves a matrix of zeros. */
GPROJT_TEST(not_positive_definite) {
    static const double x[2] = {1, 2};
    gproj_system *s = gprojt_system(NULL, 2, 1, x);
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    options.epsilon = 1e-190;
    gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1, 0, 0);
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations == 0 && gproj_system_values(s)[0] == 1);
    options.epsilon = 1e-155; /* a hundredfold of it will do */
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.damped > 0);
    gproj_system_destroy(s);
}

/* -- damping -- */

static gproj_system *gprojt_square_plus(double start, double c) {
    gproj_system *s = gprojt_system(NULL, 1, 1, &start);
    gproj_term square = gprojt_term(0, 0, 1);
    gprojt_add_group(s, "square", GPROJ_CONSTRAINT, 1);
    gproj_system_add_row(s, 0, 1, &square, c, 3);
    return s;
}

/* x^2 + 1 has no root: Newton's steps leap about, damped ones end at the minimum. */
GPROJT_TEST(steps_that_raise_the_merit_are_damped) {
    gproj_system *s = gprojt_square_plus(0.1, 1);
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    int32_t n;
    memset(&watch, 0, sizeof watch);
    options = gprojt_watched(&watch);
    result = gproj_system_solve(s, 60, &options);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED);
    GPROJT_CHECK(fabs(gproj_system_values(s)[0]) < 0.1);
    for (n = 1; n < watch.count; ++n) GPROJT_CHECK(watch.seen[n].merit <= watch.seen[n - 1].merit);
    GPROJT_CHECK(watch.count == 0 || watch.seen[0].factorisations > 1);
    gproj_system_destroy(s);
    s = gprojt_square_plus(0.1, 1);
    options = gprojt_watched(&watch);
    options.skip_damping = true;
    result = gproj_system_solve(s, 6, &options);
    GPROJT_CHECK(watch.seen[0].merit > 2 && result.damped == 0);
    for (n = 0; n < watch.count; ++n) GPROJT_CHECK(watch.seen[n].factorisations == 1 && watch.seen[n].length == 1);
    gproj_system_destroy(s);
}

/* At a double root Newton halves; the lengthened step reaches it, from where all constraints nearly hold. */
GPROJT_TEST(steps_are_lengthened_near_singular_points) {
    gproj_system *s = gprojt_square_plus(0.09, 0);
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    int32_t n, first = -1;
    memset(&watch, 0, sizeof watch);
    options = gprojt_watched(&watch);
    options.tolerance = 2.5e-11; /* nearer to the root the gradient 2 x is less than eps */
    result = gproj_system_solve(s, 60, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 2); /* halving takes 14 */
    GPROJT_CHECK(watch.seen[0].length > 1.3 && watch.seen[0].length <= 2 && watch.seen[0].residual < 1e-6);
    gproj_system_destroy(s);
    s = gprojt_square_plus(1, 0); /* from afar: full steps until the residual is 1e-2, then a longer one */
    options = gprojt_watched(&watch);
    options.tolerance = 2.5e-11;
    result = gproj_system_solve(s, 60, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 6);
    for (n = 0; first < 0 && n < watch.count; ++n) {
        double before = n ? watch.seen[n - 1].residual : 1;
        GPROJT_CHECK((watch.seen[n].length == 1) == (before > 1e-2));
        if (watch.seen[n].length > 1) first = n;
    }
    GPROJT_CHECK(first > 0 && watch.seen[first].length >= 1.3);
    gproj_system_destroy(s);
    s = gprojt_square_plus(0.09, 0); /* a wish that is on keeps steps at their length */
    gprojt_add_group(s, "wish", GPROJ_WISH, 1e-5);
    gprojt_add_linear(s, 1, 0, 1, 0, 0);
    options = gprojt_watched(&watch);
    options.tolerance = 1e-12;
    gproj_system_solve(s, 4, &options);
    for (n = 0; n < watch.count; ++n) GPROJT_CHECK(watch.seen[n].length == 1);
    GPROJT_CHECK(watch.count > 1);
    gproj_system_destroy(s);
}

/* A simple root is reached by full steps alone: nothing is gained by longer ones. */
GPROJT_TEST(steps_are_not_lengthened_without_need) {
    gproj_system *s = gprojt_square_plus(1.004, -1);
    gprojt_watch watch;
    gproj_solve_options options;
    int32_t n;
    memset(&watch, 0, sizeof watch);
    options = gprojt_watched(&watch);
    GPROJT_CHECK(gproj_system_solve(s, 20, &options).outcome == GPROJ_CONVERGED);
    for (n = 0; n < watch.count; ++n) GPROJT_CHECK(watch.seen[n].length == 1 && watch.seen[n].factorisations == 1);
    gproj_system_destroy(s);
}

/* A full step that raises the merit, by much or by little, with a wish or without: it is shortened to where the merit
   is smallest, here the root. */
GPROJT_TEST(wild_steps_are_shortened_to_the_smallest_merit) {
    static const double starts[4] = {0.2, 0.4, -0.3, -0.42};
    int i;
    for (i = 0; i < 8; ++i) {
        double x = starts[i / 2], full = x + (1 - x * x) / (2 * x), reached;
        gproj_system *s = gprojt_square_plus(x, -1);
        gprojt_watch watch;
        gproj_solve_options options;
        gproj_result result;
        memset(&watch, 0, sizeof watch);
        GPROJT_CHECK(fabs(full * full - 1) > 1 - x * x);
        if (i % 2) {
            gprojt_add_group(s, "wish", GPROJ_WISH, 1e-4);
            gprojt_add_linear(s, 1, 0, 1, 0, 0);
            gproj_system_set_schedule(s, 1, gprojt_schedule(1e-4, 1, 3));
        }
        options = gprojt_watched(&watch);
        options.epsilon = 1e-5;
        result = gproj_system_solve(s, 30, &options);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.damped >= 1);
        GPROJT_CHECK(watch.seen[0].length < 1 && watch.seen[0].factorisations == 1);
        reached = x + watch.seen[0].length * (full - x);
        GPROJT_NEAR(fabs(reached), 1, 1e-6);
        GPROJT_NEAR(watch.x[0], reached, 1e-6);
        GPROJT_CHECK(watch.seen[0].merit < 1e-7);
        if (i % 2 == 0) GPROJT_CHECK(watch.seen[0].merit < 1e-24); /* the minimum to rounding */
        GPROJT_CHECK((watch.seen[0].energy > 0) == (i % 2 == 1) && watch.seen[watch.count - 1].energy == 0);
        gproj_system_destroy(s);
    }
}

/* Where the whole line rises, or falls only within a twentieth of the step, a larger eps finds another one. */
GPROJT_TEST(a_larger_epsilon_where_no_length_is_good) {
    gproj_system *s = gprojt_square_plus(0.01, -1); /* the full step goes to 50 */
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    int32_t n;
    memset(&watch, 0, sizeof watch);
    gprojt_add_group(s, "wish", GPROJ_WISH, 1e-4);
    gprojt_add_linear(s, 1, 0, 1, 0, 0);
    options = gprojt_watched(&watch);
    gproj_system_set_schedule(s, 1, gprojt_schedule(1e-4, 1, 3));
    result = gproj_system_solve(s, 40, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.damped >= 1);
    GPROJT_CHECK(watch.seen[0].factorisations > 1 && watch.seen[0].epsilon > 9 * gproji_epsilon_max);
    for (n = 0; n < watch.count; ++n) {
        double before = n ? watch.seen[n - 1].merit : 1;
        GPROJT_CHECK(watch.seen[n].merit <= before || before < 1e-15);
    }
    gproj_system_destroy(s);
}

/* A triangle in the plane that shall have edges of length 1, at (offset, offset), a little away from that. */
static gproj_system *gprojt_triangle(double offset, uint64_t seed) {
    static const double at[6] = {0.1, 0.2, 1.3, 0.1, 0.3, 1.1};
    double x[6];
    gproj_system *s;
    int32_t k;
    for (k = 0; k < 6; ++k) x[k] = offset + at[k] + 0.3 * gprojt_uniform(&seed);
    s = gprojt_system(NULL, 6, 2, x);
    gprojt_add_group(s, "lengths", GPROJ_CONSTRAINT, 1);
    for (k = 0; k < 3; ++k) gprojt_add_distance(s, 0, 2 * k, 2 * (k + 1) % 6, 2, 1, k);
    return s;
}

/* Far from the origin the terms of a length cancel, and its rounding is large beside what short steps change. */
GPROJT_TEST(rounding_of_large_terms_damps_no_step) {
    uint64_t seed;
    for (seed = 1; seed <= 10; ++seed) {
        gproj_system *s = gprojt_triangle(1e7, seed);
        gproj_result result = gproj_system_solve(s, 20, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.damped == 0 && result.iterations <= 6);
        gproj_system_destroy(s);
    }
}

/* Long after the minimum of constraints and wishes is reached, where a step changes the merit by less than its rounding,
   steps are found at once and go on becoming shorter. */
GPROJT_TEST(steps_at_a_minimum_are_not_damped) {
    uint64_t seed;
    for (seed = 1; seed <= 10; ++seed) {
        gproj_system *s = gprojt_triangle(0, seed);
        gproj_result result;
        gprojt_watch watch;
        gproj_solve_options options;
        int32_t k;
        gprojt_add_group(s, "wish", GPROJ_WISH, 0.3);
        for (k = 0; k < 6; ++k) gprojt_add_linear(s, 1, k, 1, -0.3 * k, k);
        gproj_system_set_schedule(s, 1, gprojt_schedule(0.3, 0, 50));
        memset(&watch, 0, sizeof watch);
        options = gprojt_watched(&watch);
        result = gproj_system_solve(s, 60, &options);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.damped == 0 && result.iterations <= 55);
        GPROJT_CHECK(watch.seen[39].residual > 1e-3 && watch.seen[39].step < 1e-12);
        gproj_system_destroy(s);
    }
}

static gproji_course gprojt_course(const double c[5]) {
    gproji_course course;
    memset(&course, 0, sizeof course);
    memcpy(course.c, c, sizeof course.c);
    return course;
}

static double gprojt_minimise(const double c[5], double low, double high) {
    gproji_course course = gprojt_course(c);
    return gproji_minimise_merit(&course, low, high);
}

static double gprojt_merit(const double c[5], double t) {
    gproji_course course = gprojt_course(c);
    return gproji_merit_at(&course, t);
}

static double gprojt_merit_slope(const double c[5], double t) {
    gproji_course course = gprojt_course(c);
    return gproji_merit_slope(&course, t);
}

/* The minimum along a line: no sample is lower, and the slope vanishes there to rounding. */
GPROJT_TEST(quartics_are_minimised) {
    static const double wells[5] = {1.0 / 3, 0.05, 0.7071067811865476, 1.2345678901234567, 1.9999};
    uint64_t seed = 77;
    int i, k;
    for (i = 0; i < 5; ++i) { /* (t - a)^2, and (t^2 - a^2)^2 */
        double a = wells[i], parabola[5] = {0, 0, 1, 0, 0}, well[5] = {0, 0, 0, 0, 1};
        parabola[0] = a * a, parabola[1] = -2 * a;
        well[0] = a * a * a * a, well[2] = -2 * a * a;
        GPROJT_NEAR(gprojt_minimise(parabola, 0.05, 2), a, 4e-16);
        GPROJT_NEAR(gprojt_minimise(well, 0.05, 2), a, 4e-15);
        GPROJT_NEAR(gprojt_minimise(parabola, 0.05, 1), fmin(a, 1), 4e-16);
    }
    for (i = 0; i < 500; ++i) { /* sums of squares of quadratics, as merits are */
        double c[5] = {0, 0, 0, 0, 0}, low = i % 2 ? 0.05 : 0.1, high = i % 2 ? 1 : 2, t, least = HUGE_VAL;
        for (k = 0; k < 3; ++k) {
            double p = 2 * gprojt_uniform(&seed) - 1, h = 4 * gprojt_uniform(&seed) - 2,
                   q = 4 * gprojt_uniform(&seed) - 2;
            c[0] += p * p, c[1] += 2 * p * h, c[2] += h * h + 2 * p * q, c[3] += 2 * h * q, c[4] += q * q;
        }
        t = gprojt_minimise(c, low, high);
        GPROJT_CHECK(t >= low && t <= high);
        for (k = 0; k <= 4000; ++k) least = fmin(least, gprojt_merit(c, low + k * (high - low) / 4000));
        GPROJT_CHECK(gprojt_merit(c, t) <= least + 1e-14);
        if (t > low && t < high) GPROJT_NEAR(gprojt_merit_slope(c, t), 0, 1e-13);
    }
}

/* -- schedules -- */

/* A conflict that keeps the loop going, and in group 2 a row that is always 1: its energy is the weight squared. */
static gproj_system *gprojt_scheduled(gproj_schedule schedule) {
    gproj_system *s = gprojt_conflict();
    gprojt_add_group(s, "wish", GPROJ_WISH, 1);
    gproj_system_add_row(s, 2, 0, NULL, 1, 0);
    gproj_system_set_schedule(s, 2, schedule);
    return s;
}

static void gprojt_check_energies(gproj_schedule schedule, int32_t iterations, int32_t change_at,
                                  gproj_schedule change) {
    gproj_system *s = gprojt_scheduled(schedule);
    gprojt_watch watch;
    gproj_solve_options options;
    int32_t n;
    memset(&watch, 0, sizeof watch);
    watch.change_at = change_at, watch.change = change, watch.change_group = 2;
    options = gprojt_watched(&watch);
    gproj_system_solve(s, iterations, &options);
    GPROJT_CHECK(watch.count == iterations);
    for (n = 1; n <= watch.count; ++n) {
        gproj_schedule now = change_at > 0 && n > change_at ? change : schedule;
        double weight = now.weight * (now.decay > 0 ? pow(now.decay, n) : 1);
        if (now.last > 0 && n > now.last) weight = 0;
        GPROJT_NEAR(watch.seen[n - 1].energy, weight * weight, 1e-15);
        if (n == watch.count) GPROJT_NEAR(gproj_system_group_info(s, 2).weight, weight, 1e-15);
    }
    gproj_system_destroy(s);
}

GPROJT_TEST(schedules) {
    gproj_schedule none = gprojt_schedule(0, 0, 0);
    gprojt_check_energies(gprojt_schedule(0.5, 0, 0), 9, 0, none);
    gprojt_check_energies(gprojt_schedule(0.5, 1, 4), 8, 0, none);
    gprojt_check_energies(gprojt_schedule(0.2, 0.9, 5), 9, 0, none);
    gprojt_check_energies(gprojt_schedule(2, 0.5, INT32_MAX), 20, 0, none);
    gprojt_check_energies(gprojt_schedule(0.5, 0, 0), 6, 3, gprojt_schedule(0.25, 0, 0)); /* from the callback */
    gprojt_check_energies(gprojt_schedule(0.5, 0.5, 2), 9, 4, gprojt_schedule(1, 0.5, 6));
}

static void gprojt_count_refresh(void *user, gproj_system *s, int32_t group, const gproj_progress *progress) {
    (void)progress;
    (void)s;
    (void)group;
    ++*(int *)user;
}

/* A constraint is switched off and on again by the callback. */
GPROJT_TEST(a_group_goes_and_comes_back) {
    gproj_system *s = gprojt_conflict();
    gproj_group group;
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    int calls = 0, before;
    memset(&group, 0, sizeof group);
    group.name = "watched", group.schedule = gproj_keep(1), group.refresh = gprojt_count_refresh,
    group.refresh_user = &calls;
    gproj_system_add_group(s, &group);
    memset(&watch, 0, sizeof watch);
    gproj_system_set_schedule(s, 0, gprojt_schedule(0, 0, 0));
    gproj_system_set_schedule(s, 2, gprojt_schedule(0, 0, 0));
    options = gprojt_watched(&watch);
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.worst_group == 1 && calls == 0);
    GPROJT_NEAR(gproj_system_values(s)[0], 1, 1e-12);
    gproj_system_set_schedule(s, 0, gprojt_schedule(1, 0, 0));
    gproj_system_set_schedule(s, 1, gprojt_schedule(1, 0, 2));
    watch.change_at = 3, watch.change = gprojt_schedule(1, 0, 0), watch.change_group = 2;
    options = gprojt_watched(&watch);
    options.tolerance = 1e-300; /* do not stop when x is near 0 */
    result = gproj_system_solve(s, 5, &options);
    GPROJT_CHECK(result.iterations >= 4 && watch.seen[1].residual > 0.4 && watch.seen[2].residual < 1e-4);
    GPROJT_CHECK(result.worst_group == 0 && calls >= 2);
    before = calls; /* an off group that comes back is refreshed before its first step */
    gproj_system_set_schedule(s, 2, gprojt_schedule(1, 0, 1));
    options = gprojt_watched(&watch);
    watch.change_at = 0;
    gproj_system_solve(s, 1, &options);
    GPROJT_CHECK(calls == before + 2);
    before = calls; /* one that stays off asks for no refresh of the others */
    gproj_system_set_schedule(s, 0, gprojt_schedule(0, 0, 0));
    options = gprojt_watched(&watch);
    gproj_system_solve(s, 1, &options);
    GPROJT_CHECK(calls == before + 2);
    gproj_system_destroy(s);
}

/* -- the rest of the report -- */

GPROJT_TEST(epsilon_given_and_followed) {
    gproj_system *s = gprojt_square_plus(1, -4);
    gprojt_watch watch;
    gproj_solve_options options;
    int32_t n;
    memset(&watch, 0, sizeof watch);
    options = gprojt_watched(&watch);
    options.epsilon = 0.25;
    gproj_system_solve(s, 5, &options);
    for (n = 0; n < watch.count; ++n) GPROJT_CHECK(watch.seen[n].epsilon == 0.25);
    gproj_system_destroy(s);
    s = gprojt_square_plus(1, -4);
    options = gprojt_watched(&watch);
    gproj_system_solve(s, 20, &options);
    GPROJT_CHECK(watch.seen[0].epsilon == 1e-3);
    for (n = 1; n < watch.count; ++n)
        GPROJT_NEAR(watch.seen[n].epsilon, fmin(fmax(0.3 * sqrt(watch.seen[n - 1].merit), 1e-5), 1e-3), 1e-15);
    gproj_system_destroy(s);
}

GPROJT_TEST(tolerance_follows_the_size_of_x) {
    static const double x[1] = {1e6 + 0.3};
    gproj_system *s = gprojt_system(NULL, 1, 1, x);
    gproj_solve_options options;
    gproj_result result;
    gprojt_add_group(s, "far", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1.0 / 3, -1e6 / 3, 0);
    result = gproj_system_solve(s, 9, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.residual < 2e-9);
    GPROJT_NEAR(result.tolerance, 8 * DBL_EPSILON * 1e6, 1e-14); /* at the x of the end, not at the one of the start */
    gproj_system_values(s)[0] = 1e6 + 0.3;
    memset(&options, 0, sizeof options);
    options.tolerance = 0.2;
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations == 0 && result.tolerance == 0.2);
    gproj_system_set_row(s, 0, 0, NULL, -1); /* from 1e6 to 3: the tolerance shrinks on the way */
    result = gproj_system_solve(s, 30, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.tolerance == 1e-13 && result.residual <= 1e-13);
    GPROJT_NEAR(gproj_system_values(s)[0], 3, 1e-12);
    gproj_system_set_row(s, 0, 0, NULL, -1e6); /* and grows */
    result = gproj_system_solve(s, 30, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    GPROJT_NEAR(result.tolerance, 8 * DBL_EPSILON * 3e6, 1e-14);
    gproj_system_set_schedule(s, 0, gprojt_schedule(0, 0, 0));
    GPROJT_NEAR(gproj_system_solve(s, 3, NULL).tolerance, 8 * DBL_EPSILON * 3e6, 1e-14); /* nothing must hold */
    gproj_system_destroy(s);
}

/* A variable far away raises no tolerance where no row that must hold has it, or only one that puts it there; and there is
   an upper limit. */
GPROJT_TEST(tolerance_has_an_upper_limit) {
    static const double far[3] = {1e14, 1e155, -1e300};
    int i, how;
    for (i = 0; i < 3; ++i)
        for (how = 0; how < 5; ++how) {
            double x[2] = {2, 0};
            gproj_system *s;
            gproj_result result;
            gproj_term square = gprojt_term(0, 0, 1), product = gprojt_term(0, 1, 1);
            x[1] = far[i];
            s = gprojt_system(NULL, 2, 1, x);
            gprojt_add_group(s, "square", GPROJ_CONSTRAINT, 1);
            gprojt_add_group(s, "place", how == 1 ? GPROJ_WISH : GPROJ_CONSTRAINT, 1);
            gproj_system_add_row(s, 0, 1, &square, -1, 0);
            if (how == 1 || how == 2) gprojt_add_linear(s, 1, 1, 1, -far[i], 0);
            if (how == 3) gproj_system_add_row(s, 1, 1, &product, 0, 0);
            if (how == 4) gprojt_add_linear(s, 0, 1, 1, -far[i], 0); /* after another row of its group */
            result = gproj_system_solve(s, 30, NULL);
            GPROJT_CHECK(result.tolerance == (how == 3 && result.outcome != GPROJ_CONVERGED ? 1e-8 : 1e-13));
            GPROJT_CHECK((result.outcome == GPROJ_CONVERGED) == (how != 3));
            GPROJT_CHECK(result.outcome != GPROJ_CONVERGED || fabs(gproj_system_values(s)[0] - 1) < 1e-12);
            gproj_system_destroy(s);
        }
}

/* Rows with large gradients, as those of equilibrium with large forces, can only hold to the rounding of their terms. */
GPROJT_TEST(tolerance_knows_large_terms) {
    double a;
    for (a = 1e4; a < 1e9; a *= 10) {
        static const double x[1] = {0.3};
        gproj_system *s = gprojt_system(NULL, 1, 1, x);
        gproj_result result;
        gprojt_add_group(s, "stiff", GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 0, 0, a, -a / 3, 0);
        gprojt_add_linear(s, 0, 0, 1.1 * a, -1.1 * a / 3, 0);
        result = gproj_system_solve(s, 30, NULL);
        GPROJT_CHECK((result.outcome == GPROJ_CONVERGED) == (result.residual <= 1e-11));
        GPROJT_CHECK(result.tolerance >= 1e-13 && result.tolerance <= 1e-11);
        GPROJT_CHECK(result.tolerance == 1e-13 || result.tolerance <= 4 * DBL_EPSILON * a);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED || strstr(result.message, "; rounding of such large numbers"));
        gproj_system_set_row(s, 0, 1, NULL, -1.1 * a / 3 + 1e-9 * a); /* what is more than rounding is told from it */
        GPROJT_CHECK(gproj_system_solve(s, 30, NULL).outcome == GPROJ_STALLED);
        gproj_system_destroy(s);
    }
}

/* A global row has one residual for many terms: the roundings of its linear terms count; products of variables, which count in
   no other row either, do not. */
GPROJT_TEST(tolerance_of_global_rows) {
    int32_t k, large;
    for (large = 0; large < 2; ++large) {
        double x[20];
        gproj_system *s;
        gproj_group group;
        gproj_term term[21];
        gproj_result result;
        memset(&group, 0, sizeof group);
        group.name = "global", group.global = true, group.schedule = gproj_keep(1);
        for (k = 0; k < 20; ++k) x[k] = 0.1 * k - 1, term[k] = gprojt_term(k, (k + large) % 20, 1);
        term[20] = gprojt_term(3, -1, large ? 1e3 : 1);
        s = gprojt_system(NULL, 20, 1, x);
        gproj_system_add_group(s, &group);
        gproj_system_add_row(s, 0, 21, term, -1, 0);
        result = gproj_system_solve(s, 30, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_NEAR(result.tolerance, large ? 16e3 * DBL_EPSILON * fabs(gproj_system_values(s)[3]) : 1e-13, 1e-13);
        GPROJT_NEAR(gproj_system_row_value(s, 0, 0, NULL), 0, result.tolerance);
        gproj_system_destroy(s);
    }
}

/* Neither a wish nor a row without weight makes the tolerance of what must hold larger. */
GPROJT_TEST(tolerance_of_rows_that_need_not_hold) {
    static const double x[2] = {1, 1};
    int32_t k;
    for (k = 0; k < 3; ++k) {
        gproj_system *s = gprojt_square_plus(1, -2);
        gproj_group group;
        gproj_term term = gprojt_term(1, -1, 1e6);
        gproj_result result;
        gproj_system_add_variables(s, 2, 1, x);
        memset(&group, 0, sizeof group);
        group.name = "global", group.global = true, group.schedule = gproj_keep(1);
        group.kind = k == 0 ? GPROJ_WISH : GPROJ_CONSTRAINT;
        gproj_system_add_group(s, &group);
        gproj_system_add_row(s, 1, 1, &term, -1e6, 0);
        if (k == 1) gproj_system_set_row_weight(s, 1, 0, 0);
        result = gproj_system_solve(s, 30, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_NEAR(result.tolerance, k == 2 ? 16e6 * DBL_EPSILON : 1e-13, 1e-15);
        gproj_system_destroy(s);
    }
}

GPROJT_TEST(wishes_alone) {
    static const double x[2] = {5, -5};
    gproj_system *s = gprojt_system(NULL, 2, 1, x);
    gproj_result result;
    gprojt_add_group(s, "wish", GPROJ_WISH, 0.1);
    gprojt_add_linear(s, 0, 0, 1, -1, 0);
    gprojt_add_linear(s, 0, 0, 1, -2, 0);
    result = gproj_system_solve(s, 40, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.worst_group == -1 && result.worst_element == -1);
    {
        char sentence[GPROJ_MESSAGE_SIZE];
        snprintf(sentence, sizeof sentence, "there is nothing that must hold; %d iterations towards the wishes",
                 result.iterations);
        GPROJT_CHECK(result.iterations > 1 && !strcmp(result.message, sentence));
    }
    GPROJT_NEAR(gproj_system_values(s)[0], 1.5, 1e-9);
    GPROJT_CHECK(gproj_system_values(s)[1] == -5);
    gproj_system_destroy(s);
}

GPROJT_TEST(words_for_every_place) {
    static const gproj_place places[] = {GPROJ_PLACE_VERTEX,   GPROJ_PLACE_EDGE, GPROJ_PLACE_FACE,
                                         GPROJ_PLACE_VARIABLE, GPROJ_PLACE_ROW,  GPROJ_PLACE_NONE};
    static const char *const words[] = {
        "largest residual 1 (pull, vertex 17)",  "largest residual 1 (pull, edge 17)",
        "largest residual 1 (pull, face 17)",    "largest residual 1 (pull, variable 17)",
        "largest residual 1 (pull, element 17)", "largest residual 1 (pull)"};
    int i;
    for (i = 0; i < 6; ++i) {
        gproj_system *s = gprojt_system(NULL, 1, 1, NULL);
        gproj_group group;
        memset(&group, 0, sizeof group);
        group.name = "pull", group.place = places[i], group.schedule = gproj_keep(1);
        gproj_system_add_group(s, &group);
        gprojt_add_linear(s, 0, 0, 1, -1, 17);
        GPROJT_CHECK(strstr(gproj_system_solve(s, 0, NULL).message, words[i]) != NULL);
        gproj_system_destroy(s);
    }
}

/* The sentences in full. */
GPROJT_TEST(sentences) {
    static const double x[2] = {3, 5};
    gproj_system *s = gprojt_system(NULL, 2, 1, x);
    gprojt_watch watch;
    gproj_solve_options options;
    gproj_result result;
    GPROJT_CHECK(!strcmp(gproj_system_solve(s, 0, NULL).message,
                         "there is nothing that must hold; 0 iterations towards the wishes"));
    gprojt_add_group(s, "pull", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1, -1, 4);
    result = gproj_system_solve(s, 0, NULL);
    GPROJT_CHECK(!strcmp(result.message, "the iterations ran out before all constraints held: 0 iterations, largest "
                                         "residual 2 (pull, vertex 4); allow more iterations, or ask for less"));
    memset(&watch, 0, sizeof watch);
    watch.cancel_at = 1;
    options = gprojt_watched(&watch);
    options.epsilon = 1; /* half of the way */
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(!strcmp(result.message, "cancelled by the caller: 1 iteration, largest residual 1 (pull, vertex 4)"));
    gproj_system_values(s)[0] = 1;
    result = gproj_system_solve(s, 9, NULL);
    GPROJT_CHECK(!strcmp(result.message,
                         "all constraints hold to the tolerance: 0 iterations, largest residual 0 (pull, vertex 4)"));
    gproj_system_destroy(s);
    s = gprojt_conflict();
    result = gproj_system_solve(s, 50, NULL);
    GPROJT_CHECK(!strncmp(result.message, "no step makes the constraints hold better: ", 43));
    GPROJT_CHECK(strstr(result.message, "; 'zero' and 'one' work against each other") ||
                 strstr(result.message, "; 'one' and 'zero' work against each other"));
    gproj_system_destroy(s);
}

/* What coordinates with nine digits may lack is no conflict: the sentence tells the tolerance that accepts it, and it does. */
GPROJT_TEST(conflicts_of_the_last_digits) {
    static const double x[1] = {0.5};
    int i;
    for (i = 0; i < 3; ++i) {
        double apart = i == 0 ? 6e-12 : i == 1 ? 1.9e-9 : 2.1e-9;
        gproj_system *s = gprojt_system(NULL, 1, 1, x);
        gproj_solve_options options;
        gproj_result result;
        gprojt_add_group(s, "zero", GPROJ_CONSTRAINT, 1);
        gprojt_add_group(s, "more", GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 0, 0, 1, 0, 0);
        gprojt_add_linear(s, 1, 0, 1, -apart, 0);
        result = gproj_system_solve(s, 50, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_STALLED);
        GPROJT_CHECK((strstr(result.message, "work against each other") != NULL) == (i == 2));
        if (i < 2) {
            GPROJT_CHECK(strstr(result.message,
                                i == 0
                                    ? "; coordinates of nine digits leave as much: a tolerance of 1e-11 would accept it"
                                    : "a tolerance of 1e-09 would accept it"));
            memset(&options, 0, sizeof options);
            options.tolerance = i == 0 ? 1e-11 : 1e-9;
            GPROJT_CHECK(gproj_system_solve(s, 50, &options).outcome == GPROJ_CONVERGED);
        }
        gproj_system_destroy(s);
    }
}

/* One group alone conflicts with nothing: x^2 + 1 = 0, and three points whose distances violate the triangle inequality. */
GPROJT_TEST(one_group_is_no_conflict) {
    static const double x[6] = {0, 0, 1, 0, 0.5, 0.3};
    int i;
    for (i = 0; i < 2; ++i) {
        gproj_system *s = gprojt_system(NULL, 6, 2, x);
        gproj_term square = gprojt_term(0, 0, 1);
        gproj_result result;
        gprojt_add_group(s, "alone", GPROJ_CONSTRAINT, 1);
        if (i == 0) gproj_system_add_row(s, 0, 1, &square, 1, 3);
        if (i == 1) {
            gprojt_add_distance(s, 0, 0, 2, 2, 3, 3);
            gprojt_add_distance(s, 0, 0, 4, 2, 1, 4);
            gprojt_add_distance(s, 0, 2, 4, 2, 1, 5);
        }
        result = gproj_system_solve(s, 400, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.residual > 0.1);
        GPROJT_CHECK(strstr(result.message, "; 'alone' is stuck at a minimum of its residual: begin elsewhere"));
        GPROJT_CHECK(!strstr(result.message, "against") && !strstr(result.message, "conflict"));
        gproj_system_destroy(s);
    }
}

/* A wish that never fades is named, and no iterations are promised to help; but not where constraints contradict each
   other anyway, nor where it fades by itself. */
GPROJT_TEST(a_wish_that_never_fades) {
    int i;
    for (i = 0; i < 4; ++i) {
        gproj_system *s = gprojt_system(NULL, 2, 1, NULL);
        gproj_solve_options options;
        gproj_result result;
        memset(&options, 0, sizeof options);
        gprojt_add_group(s, "one", GPROJ_CONSTRAINT, 1);
        gprojt_add_group(s, "stay", GPROJ_WISH, 0.5);
        gprojt_add_group(s, "two", GPROJ_CONSTRAINT, i == 1 ? 1 : 0);
        gprojt_add_linear(s, 0, 0, 1, -1, 4);
        gprojt_add_linear(s, 1, 0, 1, 0, 5);
        gprojt_add_linear(s, 2, 0, 1, -2, 6);
        gproj_system_set_schedule(s, 1, gprojt_schedule(0.05, i == 2 ? 0.5 : 1, INT32_MAX));
        options.nearest = i == 3;
        result = gproj_system_solve(s, i == 2 ? 3 : 50, &options);
        GPROJT_CHECK((result.outcome == GPROJ_CONVERGED) == (i == 3));
        GPROJT_CHECK((strstr(result.message, "as long as the wish 'stay' acts they cannot hold exactly") != NULL) ==
                     (i == 0));
        GPROJT_CHECK((strstr(result.message, "work against each other") != NULL) == (i == 1));
        GPROJT_CHECK((strstr(result.message, "allow more iterations") != NULL) == (i == 2));
        gproj_system_destroy(s);
    }
}

/* Where wishes have to end, those that would act in the last iteration fade earlier, and act less until then. */
GPROJT_TEST(wishes_up_to_the_last_iteration_fade) {
    static const int32_t last[3] = {49, 50, INT32_MAX};
    gproji_loop loop;
    gproji_group wish;
    int32_t k;
    memset(&loop, 0, sizeof loop);
    memset(&wish, 0, sizeof wish);
    loop.iterations = 50, loop.wishes.last = 25, loop.wishes.fading = 0.25;
    wish.kind = GPROJ_WISH;
    for (k = 0; k < 3; ++k) {
        wish.schedule = gprojt_schedule(2, 0, last[k]);
        GPROJT_CHECK(gproji_weight_in(&loop, &wish, 25) == (k > 0 ? 0.5 : 2));
        GPROJT_CHECK(gproji_weight_in(&loop, &wish, 26) == (k > 0 ? 0 : 2));
    }
}

/* What a weight below epsilon cannot do is not called a conflict. */
GPROJT_TEST(weights_below_epsilon) {
    static const double weights[3] = {1e-9, 1e-6, 1e-4}, epsilons[3] = {0, 1e-5, 1e-2};
    int i;
    for (i = 0; i < 3; ++i) {
        gproj_system *s = gprojt_system(NULL, 1, 1, NULL);
        gproj_solve_options options;
        gproj_result result;
        memset(&options, 0, sizeof options);
        options.epsilon = epsilons[i];
        gprojt_add_group(s, "weak", GPROJ_CONSTRAINT, weights[i]);
        gprojt_add_linear(s, 0, 0, 1, -1, 4);
        result = gproj_system_solve(s, 30, &options);
        GPROJT_CHECK(result.outcome == GPROJ_STALLED || result.outcome == GPROJ_ITERATION_LIMIT);
        GPROJT_CHECK(strstr(result.message, " of 'weak' is too small beside the regularisation ") != NULL);
        gproj_system_destroy(s);
    }
}

/* -- groups with a role in steps -- */

/* A group of a role that forms give to theirs. */
static int32_t gprojt_add_role(gproj_system *s, const char *name, gproj_kind kind, gproji_role role) {
    int32_t group = gprojt_add_group(s, name, kind, 1);
    gproji_declare_role(s, group, role);
    return group;
}

/* The row x_i in the group that measures steps, times a. */
static void gprojt_measure(gproj_system *s, int32_t group, int32_t i, double a) {
    gproj_term term = gprojt_term(i, -1, a);
    gproji_add_row(s, group, 1, &term, 0, 0);
}

/* After a good step: the stiffness before, how the step went, and the stiffness then. */
typedef struct gprojt_stiffness {
    double before, agreement, length;
    int32_t wary;
    bool failed, restless;
    double left, merit, residual, after;
} gprojt_stiffness;

GPROJT_TEST(stiffness_of_the_next_step) {
    static const gprojt_stiffness cases[] = {
        /* the better the linearised rows were, the less of it; more after a short step; a metric that comes back is not weak */
        {1, 0.95, 1, 0, false, false, 0, 1, 1, 0.1},
        {1, 0.7, 1, 0, false, false, 0, 1, 1, 0.3},
        {1, 0.3, 1, 0, false, false, 0, 1, 1, 0.7},
        {1, 0.2, 1, 0, false, false, 0, 1, 1, 2},
        {1, 0.95, 0.5, 0, false, false, 0, 1, 1, 2},
        {20, 0.95, 0.5, 0, false, false, 0, 1, 1, 30},
        {1, 0.95, 1, 2, false, false, 0, 1, 1, 0.5},
        {1, 0.95, 1, 0, true, false, 0, 1, 1, 1},
        {0, 0.95, 0.5, 0, false, false, 0, 1e-6, 1e-3, 0.01},
        /* it rests when the merit is small; not where that is large */
        {0.05, 0.95, 1, 0, false, false, 0, 1e-6, 1e-3, 0},
        {0.05, 0.95, 1, 0, false, false, 0, 1, 1, 0.01},
        {0, 0.95, 1, 0, false, false, 0, 1e-6, 1e-3, 0},
        /* a short step at the end does not call it back */
        {0, 0.95, 0.5, 0, false, false, 0, 1e-20, 1e-10, 0},
        {0.004, 0.95, 0.5, 0, false, false, 0, 1e-20, 1e-10, 0},
        /* once it has rested in vain it fades slowly, while steps leave much of the merit, and rests in the end */
        {0.05, 0.95, 1, 0, false, true, 0.5, 1e-6, 1e-3, 0.005},
        {0.05, 0.95, 1, 0, false, true, 0.05, 1e-6, 1e-3, 0},
        {5e-6, 0.95, 1, 0, false, true, 0.5, 1e-6, 1e-3, 0},
    };
    size_t k;
    for (k = 0; k < sizeof cases / sizeof cases[0]; ++k) {
        const gprojt_stiffness *c = &cases[k];
        gproj_system *s = gprojt_system(NULL, 2, 1, NULL);
        gproji_loop loop;
        gprojt_add_group(s, "row", GPROJ_CONSTRAINT, 1);
        gprojt_add_role(s, "metric", GPROJ_WISH, GPROJI_METRIC);
        gprojt_add_linear(s, 0, 0, 1, -1, 0);
        gprojt_measure(s, 1, 1, 1);
        GPROJT_REQUIRE(gproji_begin_loop(&loop, s, 1, false, 20, NULL) && loop.stiff &&
                       gproji_compile(s, false) == GPROJ_OK);
        s->solving = true;
        gproji_begin_run(&loop);
        gproji_stiffen(&loop, c->before);
        loop.iteration.length = c->length;
        loop.trust.agreement = c->agreement, loop.trust.wary = c->wary, loop.trust.failed = c->failed;
        loop.trust.restless = c->restless, loop.trust.left = c->left;
        loop.standing.merit = c->merit, loop.standing.energy = 0, loop.standing.residual = c->residual;
        gproji_adapt_stiffness(&loop);
        s->solving = false;
        GPROJT_NEAR(s->stiffness, c->after, 1e-15);
        GPROJT_NEAR(s->group[1].weight, c->after, 1e-15);
        gproj_system_destroy(s);
    }
}

/* A chain of six points, 1.5 from each other along the x axis, which are to be 1 apart. */
static gproj_system *gprojt_chain(const gproj_host *host) {
    gproj_system *s = gproj_system_create(host);
    double x[18];
    int32_t k;
    if (!s) return NULL;
    for (k = 0; k < 18; ++k) x[k] = k % 3 ? 0.1 * (k % 4) : 0.5 * k;
    gproj_system_add_variables(s, 18, 3, x);
    gprojt_add_group(s, "chain", GPROJ_CONSTRAINT, 1);
    for (k = 0; k < 5; ++k) gprojt_add_distance(s, 0, 3 * k, 3 * k + 3, 3, 1, k);
    return s;
}

/* Steps begin stiff, and the metric rests at the end. They are found by multipliers all the time, as the metric's rows, which
   have a single variable each, are no elements. */
GPROJT_TEST(metrics_rest_at_the_end) {
    gproj_system *s = gprojt_chain(NULL);
    gproj_result result;
    int32_t k, i;
    gprojt_add_role(s, "metric", GPROJ_WISH, GPROJI_METRIC);
    for (k = 0; k < 18; ++k) gprojt_measure(s, 1, k, 0.1);
    result = gproj_system_solve(s, 60, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations > 1);
    GPROJT_CHECK(s->schur.on && s->stiffness == 0);
    for (k = 0; k < 5; ++k) {
        const double *a = gproj_system_values(s) + 3 * k;
        double square = 0;
        for (i = 0; i < 3; ++i) square += (a[i + 3] - a[i]) * (a[i + 3] - a[i]);
        GPROJT_NEAR(square, 1, 1e-12);
    }
    gproj_system_destroy(s);
}

/* Below a residual at which rounding decides, attempts that fail do not make steps stiffer, which is no help. */
GPROJT_TEST(no_stiffness_at_the_end) {
    static const double x[2] = {0, 2};
    static const gproj_term term[2] = {{0, 0, 1e40}, {0, -1, 1}};
    int32_t far;
    for (far = 0; far < 2; ++far) {
        gproj_system *s = gprojt_system(NULL, 2, 1, x);
        gproj_result result;
        gprojt_add_group(s, "held", GPROJ_CONSTRAINT, 1);
        gprojt_add_group(s, "far", GPROJ_WISH, 1);
        gprojt_add_role(s, "metric", GPROJ_WISH, GPROJI_METRIC);
        gprojt_add_linear(s, 0, 1, 1, far ? -3 : -2 - 1e-8, 0);
        gproj_system_add_row(s, 1, 2, term, 1e60, 0); /* 1e160 at the end of the step */
        gprojt_measure(s, 2, 1, 1);
        result = gproj_system_solve(s, 9, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations == 0);
        GPROJT_CHECK(far ? s->stiffness > 1 : s->stiffness == 1);
        GPROJT_CHECK(gproj_system_values(s)[0] == 0 && gproj_system_values(s)[1] == 2);
        gproj_system_destroy(s);
    }
}

/* Steps that overflow are tried again with a larger eps: stiffness is no help in directions without it. */
GPROJT_TEST(no_stiffness_where_steps_overflow) {
    static const double x[2] = {1, 2};
    gproj_system *s = gprojt_system(NULL, 2, 1, x);
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    options.epsilon = 1e-150;
    gprojt_add_group(s, "faint", GPROJ_CONSTRAINT, 1);
    gprojt_add_role(s, "metric", GPROJ_WISH, GPROJI_METRIC);
    gprojt_add_linear(s, 0, 0, 1e-160, 1e300, 0); /* see steps_that_overflow */
    gprojt_measure(s, 1, 1, 1);
    result = gproj_system_solve(s, 9, &options);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.iterations == 0 && s->stiffness == 1);
    GPROJT_CHECK(gproj_system_values(s)[0] == 1 && gproj_system_values(s)[1] == 2);
    gproj_system_destroy(s);
}

/* Safeguards give way before a solve ends for lack of progress: twice, and then their weight is gone. */
GPROJT_TEST(safeguards_give_way) {
    int32_t safe, last[2];
    for (safe = 0; safe < 2; ++safe) {
        gproj_system *s = gprojt_conflict();
        int32_t group = gprojt_add_group(s, "safe", GPROJ_BOUND, 1);
        gproj_result result;
        gprojt_add_linear(s, group, 0, 1, 10, 0);
        gproji_declare_role(s, group, safe ? GPROJI_SAFEGUARD : GPROJI_ORDINARY); /* which takes no rows of callers */
        result = gproj_system_solve(s, 200, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_STALLED);
        GPROJT_CHECK(s->yield == (safe ? GPROJI_YIELD_LAST : GPROJI_YIELD_SLOWLY));
        GPROJT_CHECK(gproj_system_group_info(s, group).schedule.weight == (safe ? 0 : 1));
        last[safe] = result.iterations;
        gproj_system_destroy(s);
    }
    GPROJT_CHECK(last[1] > last[0] && last[1] < 200);
}

/* Safeguards are made for what there is: one that is violated by rounding at the start does not act in the first step, which
   it would hold back, one that is violated by more does until the step is found again. */
GPROJT_TEST(rounding_chooses_no_safeguards) {
    static const double start[1] = {0}, phi[5] = {1e-8, 5e-10, 0, -5e-10, -1e-8};
    int32_t k;
    for (k = 0; k < 5; ++k) {
        gproj_system *s = gprojt_system(NULL, 1, 1, start);
        gproj_solve_options options;
        gprojt_watch watch;
        int32_t group;
        memset(&watch, 0, sizeof watch);
        options = gprojt_watched(&watch);
        gprojt_add_group(s, "one", GPROJ_CONSTRAINT, 1);
        group = gprojt_add_group(s, "safe", GPROJ_BOUND, 1);
        gprojt_add_linear(s, 0, 0, 1, -1, 0);
        gprojt_add_linear(s, group, 0, 1, phi[k], 0);
        gproji_declare_role(s, group, GPROJI_SAFEGUARD);
        GPROJT_CHECK(gproj_system_solve(s, 9, &options).outcome == GPROJ_CONVERGED);
        GPROJT_CHECK(watch.seen[0].factorisations == (k < 4 ? 1 : 2));
        gproj_system_destroy(s);
    }
}

/* A guard's row that is violated at the start gets a multiplier at once. */
static bool gprojt_wake_at_the_start(const gproj_host *host, void *user) {
    static const gproj_term sum[2] = {{0, -1, 1}, {15, -1, 1}};
    gproj_system *s = gprojt_chain(host);
    gproj_result result;
    int32_t group;
    (void)user;
    if (!s) return false;
    group = gprojt_add_group(s, "guard", GPROJ_BOUND, 1);
    if (group >= 0) gproji_declare_role(s, group, GPROJI_GUARD);
    if (group >= 0) gproji_add_row(s, group, 2, sum, -9, -1); /* x_0 + x_5 >= 9, which are 7.5 */
    result = gproj_system_solve(s, 30, NULL);
    if (result.outcome == GPROJ_FAILED) {
        GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_ERROR_MEMORY);
    } else {
        const double *x = gproj_system_values(s);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && s->schur.on && !s->group[1].row[0].dormant);
        GPROJT_CHECK(x[0] + x[15] > 8.9);
    }
    gproj_system_destroy(s);
    return result.outcome != GPROJ_FAILED;
}

GPROJT_TEST(guards_wake_without_memory) {
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_wake_at_the_start, NULL) >= 30);
}

/* -- what a callback changes -- */

/* Does `what` after iteration `at`. */
typedef struct gprojt_change {
    int32_t at, what;
    double constant;
} gprojt_change;

enum {
    GPROJT_CHANGE_ROW,
    GPROJT_CHANGE_ROW_WEIGHT,
    GPROJT_CHANGE_SCHEDULE,
    GPROJT_CHANGES
};

static bool gprojt_change_something(void *user, gproj_system *s, const gproj_iteration *iteration) {
    const gprojt_change *c = (const gprojt_change *)user;
    if (iteration->number != c->at) return true;
    if (c->what == GPROJT_CHANGE_ROW) gproj_system_set_row(s, 1, 0, NULL, c->constant);
    if (c->what == GPROJT_CHANGE_ROW_WEIGHT) gproj_system_set_row_weight(s, 1, 0, 1);
    if (c->what == GPROJT_CHANGE_SCHEDULE) gproj_system_set_schedule(s, 1, gprojt_schedule(1, 0, 0));
    return true;
}

/* x_0 = 1 at once, and a second row x_1 = 7 that holds as `what` leaves it, until the callback changes that. */
static gproj_system *gprojt_changing(int what) {
    static const double x[2] = {0, 0};
    gproj_system *s = gprojt_system(NULL, 2, 1, x);
    gprojt_add_group(s, "first", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "second", GPROJ_CONSTRAINT, what == GPROJT_CHANGE_SCHEDULE ? 0 : 1);
    gprojt_add_linear(s, 0, 0, 1, -1, 0);
    gprojt_add_linear(s, 1, 1, 1, what == GPROJT_CHANGE_ROW ? 0 : -7, 1);
    if (what == GPROJT_CHANGE_ROW_WEIGHT) gproj_system_set_row_weight(s, 1, 0, 0);
    return s;
}

/* "All constraints hold" is said of the rows as the callback left them: when iterations go on, and after the last. */
GPROJT_TEST(changes_of_a_callback_are_judged) {
    int what, at, limit;
    for (what = 0; what < GPROJT_CHANGES; ++what) {
        for (at = 1; at <= 3; ++at) {
            for (limit = at; limit <= 20; limit += 20 - at) {
                gproj_system *s = gprojt_changing(what);
                gprojt_change change;
                gproj_solve_options options;
                gproj_result result;
                double off;
                memset(&options, 0, sizeof options);
                change.at = at, change.what = what, change.constant = -7;
                options.on_iteration = gprojt_change_something, options.user = &change;
                options.epsilon = 1e-3;
                options.tolerance = at == 1 ? 0 : 1e-10; /* eps^2 of the way is left in each step: 1, 1e-6, 1e-12 */
                result = gproj_system_solve(s, limit, &options);
                off = fmax(fabs(gproj_system_values(s)[0] - 1),
                           result.iterations >= at ? fabs(gproj_system_values(s)[1] - 7) : 0);
                if ((result.outcome == GPROJ_CONVERGED) != (off <= result.tolerance) ||
                    fabs(result.residual - off) > 1e-12) {
                    printf("  change %d after iteration %d of %d: %s, but %g\n", what, at, limit, result.message, off);
                    GPROJT_CHECK(!"judged as it is");
                }
                if (at == 1) GPROJT_CHECK((result.outcome == GPROJ_CONVERGED) == (limit > at));
                gproj_system_destroy(s);
            }
        }
    }
}

/* The loop is about to stop because nothing helps, and then the callback takes the conflict away. */
static bool gprojt_make_peace(void *user, gproj_system *s, const gproj_iteration *iteration) {
    if (iteration->number == *(const int32_t *)user) gproj_system_set_row(s, 1, 0, NULL, 0);
    return true;
}

GPROJT_TEST(changes_of_a_callback_come_before_stalling) {
    int32_t at, stalls;
    gproj_system *s = gprojt_conflict();
    stalls = gproj_system_solve(s, 50, NULL).iterations;
    gproj_system_destroy(s);
    GPROJT_CHECK(stalls > 1);
    for (at = 1; at <= stalls; ++at) {
        gproj_solve_options options;
        gproj_result result;
        memset(&options, 0, sizeof options);
        options.on_iteration = gprojt_make_peace, options.user = &at;
        s = gprojt_conflict();
        result = gproj_system_solve(s, 50, &options);
        if (result.outcome != GPROJ_CONVERGED) printf("  after iteration %d of %d: %s\n", at, stalls, result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        gproj_system_destroy(s);
    }
}

/* As many iterations as can be asked for. */
GPROJT_TEST(int32_max_iterations) {
    static const double start[1] = {5};
    gproj_solve_options options;
    gproj_result result;
    gproj_system *s = gprojt_conflict();
    GPROJT_CHECK(gproj_system_solve(s, INT32_MAX, NULL).outcome == GPROJ_STALLED);
    gproj_system_destroy(s);
    s = gprojt_square_plus(3, -4);
    GPROJT_CHECK(gproj_system_solve(s, INT32_MAX, NULL).outcome == GPROJ_CONVERGED);
    memset(&options, 0, sizeof options);
    options.nearest = true, gproj_system_values(s)[0] = 3;
    GPROJT_CHECK(gproj_system_solve(s, INT32_MAX, &options).outcome == GPROJ_CONVERGED);
    gproj_system_destroy(s);
    s = gprojt_system(NULL, 1, 1, start); /* a wish for ever */
    gprojt_add_group(s, "wish", GPROJ_WISH, 0.1);
    gprojt_add_linear(s, 0, 0, 1, -1, 0);
    gproj_system_set_schedule(s, 0, gprojt_schedule(0.1, 1, INT32_MAX));
    GPROJT_CHECK(gproj_system_solve(s, INT32_MAX, NULL).outcome == GPROJ_CONVERGED);
    gproj_system_destroy(s);
    s = gprojt_square_plus(5, -4); /* begins in the last iterations, after a wish that no step serves */
    gproj_system_add_variables(s, 1, 1, NULL);
    gprojt_add_linear(s, gprojt_add_group(s, "faint", GPROJ_WISH, 1), 1, 1e-160, 1e300, 0);
    gproj_system_set_schedule(s, 1, gprojt_schedule(1, 1, INT32_MAX - 4));
    options.nearest = false, options.epsilon = 1e-150;
    result = gproj_system_solve(s, INT32_MAX, &options);
    GPROJT_CHECK(result.outcome == GPROJ_ITERATION_LIMIT && result.iterations == INT32_MAX);
    gproj_system_destroy(s);
}

/* -- memory and workers -- */

/* Chains of rods between points in space, closed by a wish; enough rows for several tasks. */
static gproj_system *gprojt_rods(const gproj_host *host, int32_t points) {
    gproj_system *s = gprojt_system(host, 3 * points, 3, NULL);
    double *x = gproj_system_values(s);
    gproj_group group;
    uint64_t seed = 6;
    int32_t i, k;
    for (i = 0; i < points; ++i)
        for (k = 0; k < 3; ++k) x[3 * i + k] = (k == 0 ? i % 100 : k == 1 ? i / 100 : 0) + 0.2 * gprojt_uniform(&seed);
    memset(&group, 0, sizeof group);
    group.name = "centre", group.global = true, group.schedule = gproj_keep(1);
    gprojt_add_group(s, "rods", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "close", GPROJ_WISH, 0.05);
    gproj_system_add_group(s, &group);
    gproj_system_set_schedule(s, 1, gprojt_schedule(0.05, 0.5, 4));
    for (i = 0; i < points; ++i) {
        if (i % 100 < 99) gprojt_add_distance(s, 0, 3 * i, 3 * i + 3, 3, 1, i);
        if (i + 100 < points) gprojt_add_distance(s, 0, 3 * i, 3 * i + 300, 3, 1.0, i);
        for (k = 0; k < 3; ++k) gprojt_add_linear(s, 1, 3 * i + k, 1, -x[3 * i + k], i);
    }
    for (k = 0; k < 3; ++k) {
        gproj_term *term = (gproj_term *)malloc((size_t)points * sizeof *term);
        for (i = 0; i < points; ++i) term[i] = gprojt_term(3 * i + k, -1, 1.0 / points);
        gproj_system_add_row(s, 2, points, term, 0, k);
        free(term);
    }
    return s;
}

GPROJT_TEST(no_allocation_after_the_first_iteration) {
    gproj_system *s = gprojt_rods(NULL, 300);
    gprojt_watch watch;
    gproj_solve_options options;
    uint64_t before;
    int32_t n;
    memset(&watch, 0, sizeof watch);
    options = gprojt_watched(&watch);
    gproj_system_solve(s, 20, &options);
    GPROJT_REQUIRE(watch.count > 3);
    for (n = 1; n < watch.count; ++n) GPROJT_CHECK(watch.allocations[n] == watch.allocations[0]);
    before = gproj_system_memory(s).allocations;
    GPROJT_CHECK(before == watch.allocations[0]);
    gproj_system_set_schedule(s, 0, gprojt_schedule(0.7, 0, 0)); /* other weights, constants, values: no new analysis */
    gproj_system_set_schedule(s, 1, gprojt_schedule(0, 0, 0));
    gproj_system_set_row(s, 2, 0, NULL, -3);
    gproj_system_set_row_weight(s, 0, 5, 0);
    gproj_system_values(s)[0] += 0.1;
    gproj_system_solve(s, 20, NULL);
    GPROJT_CHECK(gproj_system_memory(s).allocations == before);
    gproj_system_destroy(s);
}

GPROJT_TEST(same_bits_for_all_workers) {
    double *first = NULL;
    gproj_result first_result;
    int32_t n = 0;
    int run;
    memset(&first_result, 0, sizeof first_result);
    for (run = 0; run <= GPROJT_CREWS; ++run) { /* one worker twice */
        gproj_host host = gprojt_crew(run % GPROJT_CREWS);
        gproj_system *s = gprojt_rods(&host, 1500);
        gproj_result result = gproj_system_solve(s, 6, NULL);
        n = gproj_system_variable_count(s);
        GPROJT_CHECK(gproj_system_group_info(s, 0).rows > 2048);
        if (run == 0) {
            first_result = result;
            first = (double *)malloc((size_t)n * sizeof *first);
            memcpy(first, gproj_system_values(s), (size_t)n * sizeof *first);
        }
        GPROJT_CHECK(!memcmp(first, gproj_system_values(s), (size_t)n * sizeof *first));
        GPROJT_CHECK(!memcmp(&first_result.residual, &result.residual, sizeof(double)) &&
                     first_result.step == result.step);
        GPROJT_CHECK(!strcmp(first_result.message, result.message));
        gproj_system_destroy(s);
    }
    free(first);
}

/* A metric that has rested while the rows were compiled measures steps again: its rows are linearised when it comes back. */
GPROJT_TEST(metric_comes_back) {
    static const double start[2] = {3, 1};
    gproj_system *s = gprojt_system(NULL, 2, 1, start);
    gproj_term product = gprojt_term(0, 1, 1);
    gproji_course course;
    gproji_loop loop;
    uint64_t allocations;
    double value;
    int32_t i;
    gprojt_add_group(s, "product", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "metric", GPROJ_WISH, 0.1);
    gproji_declare_role(s, 1, GPROJI_METRIC);
    gproj_system_add_row(s, 0, 1, &product, -2, 0);
    for (i = 0; i < 2; ++i) gprojt_measure(s, 1, i, 1);
    GPROJT_CHECK(gproji_begin_loop(&loop, s, 1, false, 10, NULL) && loop.stiff);
    GPROJT_CHECK(gproji_compile(s, false) == GPROJ_OK);
    gproji_begin_run(&loop);
    gproji_stiffen(&loop, 0);
    GPROJT_CHECK(s->group[1].weight == 0);
    gproji_system_forget(s);
    GPROJT_CHECK(gproji_compile(s, false) == GPROJ_OK);
    for (i = 0; i < 2; ++i) s->group[1].local.gradient[i] = HUGE_VAL; /* whatever memory had */
    gproji_see_rows(&loop);
    allocations = gproj_system_memory(s).allocations;
    gproji_stiffen(&loop, 0.5);
    GPROJT_CHECK(s->group[1].weight == 0.05 && gproj_system_memory(s).allocations == allocations);
    GPROJT_CHECK(s->group[1].local.gradient[0] == 1 && s->group[1].local.gradient[1] == 1);
    GPROJT_CHECK(gproji_find_step(&loop, 1e-3) && gproji_take_step(s, 0) == 0);
    value = (3 + s->vector.step[0]) * (1 + s->vector.step[1]) - 2;
    gproji_merit_along(s, &course); /* it measures the step, and has no part in the merit along it */
    GPROJT_NEAR(gproji_merit_at(&course, 1), value * value, 1e-14);
    gproj_system_destroy(s);
}

int main(void) {
    GPROJT_RUN(sphere_and_planes);
    GPROJT_RUN(circle_packing);
    GPROJT_RUN(stalled_names_both_groups);
    GPROJT_RUN(iteration_limit);
    GPROJT_RUN(converged_without_a_step);
    GPROJT_RUN(cancelled_keeps_the_state);
    GPROJT_RUN(time_out);
    GPROJT_RUN(seconds_add_up);
    GPROJT_RUN(first_refreshes);
    GPROJT_RUN(failed_by_an_error_on_the_way);
    GPROJT_RUN(failed_by_an_error_of_a_callback);
    GPROJT_RUN(refused_slides);
    GPROJT_RUN(slopes_of_slides);
    GPROJT_RUN(callbacks_may_not_rebuild);
    GPROJT_RUN(values_that_are_no_numbers);
    GPROJT_RUN(rows_that_overflow);
    GPROJT_RUN(steps_that_overflow);
    GPROJT_RUN(undamped_steps_that_overflow);
    GPROJT_RUN(undamped_steps_to_rows_that_overflow);
    GPROJT_RUN(steps_beyond_all_numbers_are_taken_back);
    GPROJT_RUN(patience_ends_where_constraints_hold);
    GPROJT_RUN(no_verdict_before_schedules_end);
    GPROJT_RUN(wishes_that_no_step_serves);
    GPROJT_RUN(not_positive_definite);
    GPROJT_RUN(steps_that_raise_the_merit_are_damped);
    GPROJT_RUN(steps_are_lengthened_near_singular_points);
    GPROJT_RUN(steps_are_not_lengthened_without_need);
    GPROJT_RUN(wild_steps_are_shortened_to_the_smallest_merit);
    GPROJT_RUN(a_larger_epsilon_where_no_length_is_good);
    GPROJT_RUN(rounding_of_large_terms_damps_no_step);
    GPROJT_RUN(steps_at_a_minimum_are_not_damped);
    GPROJT_RUN(quartics_are_minimised);
    GPROJT_RUN(schedules);
    GPROJT_RUN(a_group_goes_and_comes_back);
    GPROJT_RUN(epsilon_given_and_followed);
    GPROJT_RUN(tolerance_follows_the_size_of_x);
    GPROJT_RUN(tolerance_has_an_upper_limit);
    GPROJT_RUN(tolerance_knows_large_terms);
    GPROJT_RUN(tolerance_of_global_rows);
    GPROJT_RUN(tolerance_of_rows_that_need_not_hold);
    GPROJT_RUN(wishes_alone);
    GPROJT_RUN(words_for_every_place);
    GPROJT_RUN(sentences);
    GPROJT_RUN(conflicts_of_the_last_digits);
    GPROJT_RUN(one_group_is_no_conflict);
    GPROJT_RUN(a_wish_that_never_fades);
    GPROJT_RUN(wishes_up_to_the_last_iteration_fade);
    GPROJT_RUN(weights_below_epsilon);
    GPROJT_RUN(stiffness_of_the_next_step);
    GPROJT_RUN(metrics_rest_at_the_end);
    GPROJT_RUN(no_stiffness_at_the_end);
    GPROJT_RUN(no_stiffness_where_steps_overflow);
    GPROJT_RUN(safeguards_give_way);
    GPROJT_RUN(rounding_chooses_no_safeguards);
    GPROJT_RUN(guards_wake_without_memory);
    GPROJT_RUN(changes_of_a_callback_are_judged);
    GPROJT_RUN(changes_of_a_callback_come_before_stalling);
    GPROJT_RUN(int32_max_iterations);
    GPROJT_RUN(no_allocation_after_the_first_iteration);
    GPROJT_RUN(same_bits_for_all_workers);
    GPROJT_RUN(metric_comes_back);
    return gprojt_report();
}
