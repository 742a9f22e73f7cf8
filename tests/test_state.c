/* test_state.c - >>state and the frames of >>solve: saved states, and solves that stop and go on. */
#include "gprojt_design.h"
#include "gprojt_inside.h"

/* -- frames -- */

enum {
    GPROJT_ITERATIONS = 16
};

/* A solve of a fresh roof in one go: its positions and result. */
static double *gprojt_at_once(int design, const gproj_solve_options *options, gproj_result *result) {
    gproj_mesh *mesh = gprojt_roof(6, 0.08);
    gproj_form *form = gprojt_design(mesh, design, NULL);
    double *positions;
    *result = gproj_solve(form, GPROJT_ITERATIONS, options);
    positions = gprojt_keep(mesh);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return positions;
}

static gproj_solve_options gprojt_nearest_or_not(int nearest) {
    gproj_solve_options options;
    memset(&options, 0, sizeof options);
    options.nearest = nearest != 0;
    return options;
}

GPROJT_TEST(frames_are_one_solve) {
    int design, nearest;
    for (design = 0; design < GPROJT_DESIGNS; ++design)
        for (nearest = 0; nearest < 2; ++nearest) {
            gproj_solve_options options = gprojt_nearest_or_not(nearest);
            gproj_result whole, result;
            double *expected = gprojt_at_once(design, &options, &whole);
            gproj_mesh *mesh = gprojt_roof(6, 0.08);
            gproj_form *form = gprojt_design(mesh, design, NULL);
            int32_t frames = 0;
            GPROJT_CHECK(!gproj_solve_is_on(form));
            GPROJT_CHECK(gproj_solve_begin(form, GPROJT_ITERATIONS, &options, NULL) && gproj_solve_is_on(form));
            while (gproj_solve_is_on(form) && frames++ < 100) {
                if (frames % 3 == 0) GPROJT_CHECK(gproj_solve_memory(form, NULL) > 0); /* asking changes nothing */
                result = gproj_solve_advance(form, 0);
                GPROJT_CHECK(!gproj_solve_is_on(form) || result.outcome == GPROJ_TIME_OUT);
                GPROJT_CHECK(!gproj_solve_is_on(form) || result.iterations == frames);
            }
            GPROJT_CHECK(result.outcome == whole.outcome && result.iterations == whole.iterations);
            GPROJT_CHECK(strcmp(result.message, whole.message) == 0);
            GPROJT_CHECK(gprojt_unmoved(mesh, expected));
            GPROJT_CHECK(strcmp(gproj_solve_advance(form, 0).message, whole.message) == 0); /* again */
            free(expected);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
}

/* As many iterations as fit: with a clock that goes on by 1 at each reading, an iteration takes 10 or so. */
GPROJT_TEST(frames_have_their_time) {
    gprojt_ticks ticks = {0, 0};
    gproj_host host;
    gproj_mesh *mesh = gprojt_roof(5, 0.08);
    gproj_form *form;
    gproj_solve_options options;
    gproj_result result;
    double before;
    int32_t first, second;
    memset(&host, 0, sizeof host);
    host.clock.now = gprojt_tick, host.clock.user = &ticks;
    form = gprojt_design(mesh, GPROJT_PLANAR, &host);
    memset(&options, 0, sizeof options);
    GPROJT_REQUIRE(gproj_solve_begin(form, 30, NULL, NULL));
    first = gproj_solve_advance(form, 1e-3).iterations; /* one fits always */
    GPROJT_CHECK(first == 1);
    before = ticks.now;
    result = gproj_solve_advance(form, 60);
    second = result.iterations - first;
    GPROJT_CHECK(result.outcome == GPROJ_TIME_OUT && second > 1 && second < 10 && ticks.now - before <= 62);
    GPROJT_CHECK(gproj_solve_advance(form, 1e6).outcome == GPROJ_CONVERGED && !gproj_solve_is_on(form));
    /* a budget of the whole counts the seconds inside of steps */
    gprojt_shake(mesh, 0.05, 3);
    options.time_budget = 40;
    GPROJT_REQUIRE(gproj_solve_begin(form, 30, &options, NULL));
    while (gproj_solve_is_on(form)) {
        result = gproj_solve_advance(form, 0);
        ticks.now += 1000;
    }
    GPROJT_CHECK(result.outcome == GPROJ_TIME_OUT && result.iterations > 1 && result.iterations < 10);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

static bool gprojt_cancel(void *user, gproj_system *system, const gproj_iteration *iteration) {
    (void)system;
    return iteration->number < *(const int32_t *)user;
}

/* INFINITY is no bound, of a frame and of a solve, and needs no clock. */
GPROJT_TEST(frames_without_bound) {
    gproj_mesh *mesh = gprojt_roof(5, 0.08), *other = gprojt_roof(5, 0.08);
    gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL), *at_once = gprojt_design(other, GPROJT_PLANAR, NULL);
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    options.time_budget = INFINITY;
    GPROJT_CHECK(gproj_solve(at_once, 30, &options).outcome == GPROJ_CONVERGED);
    GPROJT_REQUIRE(gproj_solve_begin(form, 30, &options, NULL));
    gproj_solve_advance(form, 0);
    result = gproj_solve_advance(form, INFINITY);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && !gproj_solve_is_on(form));
    GPROJT_CHECK(gprojt_unmoved(mesh, other->position));
    options.time_budget = NAN;
    GPROJT_CHECK(strstr(gproj_solve(form, 30, &options).message, "time budget"));
    options.time_budget = -INFINITY;
    GPROJT_CHECK(strstr(gproj_solve(form, 30, &options).message, "time budget"));
    gproj_form_destroy(form);
    gproj_form_destroy(at_once);
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(other);
}

static bool gprojt_stop_itself(void *user, gproj_system *system, const gproj_iteration *iteration) {
    (void)system, (void)iteration;
    gproj_solve_stop((gproj_form *)user);
    return true;
}

GPROJT_TEST(frames_can_be_left) {
    gproj_mesh *mesh = gprojt_roof(5, 0.08);
    gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
    gproj_solve_options options;
    gproj_error error;
    int32_t last = 3, v = 7, group;
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    double *kept;
    memset(&options, 0, sizeof options);
    GPROJT_CHECK(strstr(gproj_solve_advance(form, 0).message, "nothing is under way"));
    gproj_solve_begin(form, 20, NULL, NULL);
    gproj_solve_advance(form, 0);
    kept = gprojt_keep(mesh);
    gproj_solve_stop(form);
    GPROJT_CHECK(gprojt_unmoved(mesh, kept) && !gproj_solve_is_on(form));
    GPROJT_CHECK(strstr(gproj_solve_advance(form, 0).message, "nothing is under way"));
    gproj_solve_begin(form, 20, NULL, NULL); /* by a solve, by a drag */
    gproj_solve(form, 2, NULL);
    GPROJT_CHECK(!gproj_solve_is_on(form));
    gproj_solve_begin(form, 20, NULL, NULL);
    gproj_drag_cancel(gproj_drag_begin(form, &handles, NULL, &error));
    GPROJT_CHECK(gproj_solve_is_on(form)); /* as before the drag */
    options.on_iteration = gprojt_cancel, options.user = &last;
    gproj_solve_begin(form, 20, &options, NULL);
    while (gproj_solve_is_on(form)) gproj_solve_advance(form, 0);
    GPROJT_CHECK(gproj_solve_advance(form, 0).outcome == GPROJ_CANCELLED &&
                 gproj_solve_advance(form, 0).iterations == 3);
    /* what does not go */
    options.on_iteration = gprojt_stop_itself, options.user = form;
    gproj_solve_begin(form, 20, &options, NULL);
    GPROJT_CHECK(gproj_solve_advance(form, 0).outcome == GPROJ_TIME_OUT && gproj_solve_is_on(form));
    gproj_solve_stop(form);
    GPROJT_CHECK(strstr(gproj_solve_advance(form, -1).message, "must not be negative"));
    GPROJT_CHECK(strstr(gproj_solve_advance(form, 1).message, "a clock"));
    GPROJT_CHECK(strstr(gproj_solve_advance(form, NAN).message, "must not be negative"));
    GPROJT_CHECK(!gproj_solve_begin(form, -1, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(strstr(error.message, "-1 iterations"));
    GPROJT_CHECK(!gproj_solve_begin(form, -1, NULL, NULL) &&
                 strstr(gproj_solve_advance(form, 0).message, "-1 iterations"));
    gproj_solve_begin(form, 20, NULL, NULL);
    group = gproj_add_closeness(form, 0.01);
    GPROJT_CHECK(group >= 0 && strstr(gproj_solve_advance(form, 0).message, "were added") && !gproj_solve_is_on(form));
    GPROJT_CHECK(gproj_solve_begin(form, 20, NULL, NULL) && gproj_solve_advance(form, 0).iterations == 1);
    mesh->position[0] = HUGE_VAL;
    GPROJT_CHECK(!gproj_solve_begin(form, 20, NULL, &error) && gproj_solve_advance(form, 0).outcome == GPROJ_FAILED);
    GPROJT_CHECK(error.code == GPROJ_ERROR_NUMBER && error.place == GPROJ_PLACE_VERTEX && error.index == 0);
    GPROJT_CHECK(!gproj_solve_begin(NULL, 20, NULL, &error) && error.code != GPROJ_OK);
    GPROJT_CHECK(!gproj_solve_begin(NULL, 20, NULL, NULL) && gproj_solve_advance(NULL, 0).outcome == GPROJ_FAILED);
    GPROJT_CHECK(!gproj_solve_is_on(NULL));
    gproj_solve_stop(NULL);
    free(kept);
    gproj_form_destroy(form);
    form = gproj_form_create(NULL, NULL);
    gproj_solve_stop(form); /* a form without a mesh has no system */
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Whatever fails between frames, a loop that steps for as long as a solve is on comes to its end. */
GPROJT_TEST(failures_end_frames) {
    static const double seconds[] = {0.01, -1, NAN, -HUGE_VAL, 0};
    int32_t outside = 99;
    int k;
    for (k = 0; k < 5; ++k) {
        gproj_mesh *mesh = gprojt_roof(5, 0.08);
        gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
        gproj_result result;
        GPROJT_CHECK(gproj_solve_begin(form, 20, NULL, NULL));
        if (k == 4) gproj_add_fixed(form, 1, &outside, 1);
        result = gproj_solve_advance(form, seconds[k]);
        GPROJT_CHECK(result.outcome == GPROJ_FAILED && !gproj_solve_is_on(form));
        GPROJT_CHECK(strstr(result.message, k < 4 ? "need a clock" : "no vertex 99"));
        GPROJT_CHECK(strcmp(gproj_solve_advance(form, 0).message, result.message) == 0); /* again */
        GPROJT_CHECK(gproj_solve_begin(form, 20, NULL, NULL) == (k < 4));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Targets that move between frames are followed. */
GPROJT_TEST(frames_follow_targets) {
    gproj_mesh *mesh = gprojt_roof(6, 0.02);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t v = gprojt_middle(mesh), group, k;
    double to[3];
    memcpy(to, mesh->position + 3 * v, sizeof to);
    gproj_add_planarity(form, 1);
    gproj_add_fixed_corners(form, 1);
    gproj_add_fairness(form, 0.1);
    group = gproj_add_targets(form, 1, &v, to, 1);
    gproj_solve_begin(form, 40, NULL, NULL);
    for (k = 0; k < 10; ++k) {
        to[2] += 0.05;
        gproj_set_targets(form, group, to);
        gproj_solve_advance(form, 0);
    }
    while (gproj_solve_is_on(form)) gproj_solve_advance(form, 0);
    GPROJT_CHECK(gproj_solve_advance(form, 0).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_far(mesh->position + 3 * v, to) < 1e-9);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* The system is solved for itself between two frames, when the constraints hold: the next frame sees where it is now. */
GPROJT_TEST(solved_between_frames) {
    static const int32_t corner = 0;
    int nearest;
    for (nearest = 0; nearest < 2; ++nearest) {
        gproj_solve_options options = gprojt_nearest_or_not(nearest);
        gproj_mesh *mesh = gprojt_roof(6, 0.08);
        gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
        gproj_system *s = gproj_form_system(form);
        gproj_result result;
        double *start = gprojt_keep(mesh);
        int32_t v;
        GPROJT_CHECK(gproj_solve_begin(form, 100, &options, NULL));
        do result = gproj_solve_advance(form, 0);
        while (gproj_solve_is_on(form) && !(result.residual <= result.tolerance && result.optimality <= 1e-6));
        GPROJT_REQUIRE(gproj_solve_is_on(form));
        for (v = 0; v < 3 * mesh->vertex_count; ++v) gproj_system_values(s)[v] += 0.05 * sin(7.0 * v);
        GPROJT_CHECK(gproj_system_solve(s, 2, NULL).residual > 1e-8);
        do result = gproj_solve_advance(form, 0);
        while (gproj_solve_is_on(form));
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.optimality <= 1e-6);
        GPROJT_CHECK(gprojt_far(mesh->position + 3 * corner, start + 3 * corner) < 1e-11);
        GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).planarity_max < 1e-11);
        free(start);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- states -- */

/* Goes on to the end. */
static gproj_result gprojt_go_on(gproj_form *form) {
    gproj_result result;
    do result = gproj_solve_advance(form, 0);
    while (gproj_solve_is_on(form));
    return result;
}

static void gprojt_check_same_form(gproj_form *form, const uint8_t *state, size_t size) {
    size_t now_size;
    uint8_t *now = gprojt_save(form, &now_size);
    GPROJT_CHECK(now_size == size && memcmp(now, state, size) == 0);
    free(now);
}

/* A state from the middle of a solve ends at the same bytes: in the same form, and in a fresh one on another mesh. */
static void gprojt_check_resumed(int design, int nearest, int32_t at) {
    gproj_solve_options options = gprojt_nearest_or_not(nearest);
    gproj_result whole, result;
    double *expected = gprojt_at_once(design, &options, &whole);
    gproj_mesh *mesh = gprojt_roof(6, 0.08), *other = gprojt_roof(6, 0.08);
    gproj_form *form = gprojt_design(mesh, design, NULL), *fresh = gprojt_design(other, design, NULL);
    uint8_t *state;
    size_t size;
    int32_t k;
    gproj_solve_begin(form, GPROJT_ITERATIONS, &options, NULL);
    for (k = 0; k < at && gproj_solve_is_on(form); ++k) gproj_solve_advance(form, 0);
    state = gprojt_save(form, &size);
    for (k = 0; k < 2; ++k) {
        if (k) GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
        if (!gproj_solve_is_on(form)) continue;
        gprojt_check_same_form(form, state, size);
        result = gprojt_go_on(form);
        GPROJT_CHECK(gprojt_unmoved(mesh, expected));
        GPROJT_CHECK(strcmp(result.message, whole.message) == 0 && result.damped == whole.damped);
    }
    gprojt_shake(other, 0.3, 1); /* positions that do not matter */
    GPROJT_CHECK(gproj_state_restore(fresh, state, size, NULL) == GPROJ_OK);
    gprojt_check_same_form(fresh, state, size);
    if (gproj_solve_is_on(fresh)) gprojt_go_on(fresh);
    GPROJT_CHECK(gprojt_unmoved(other, expected));
    free(state), free(expected);
    gproj_form_destroy(form), gproj_form_destroy(fresh);
    gproj_mesh_destroy(mesh), gproj_mesh_destroy(other);
}

GPROJT_TEST(resumed_to_the_same_bytes) {
    int design, nearest;
    int32_t at;
    for (design = 0; design < GPROJT_DESIGNS; ++design)
        for (nearest = 0; nearest < 2; ++nearest)
            for (at = 0; at < GPROJT_ITERATIONS; at += 1 + 2 * (design != GPROJT_GLIDING))
                gprojt_check_resumed(design, nearest, at);
}

/* A form in frames, from the middle of a solve on: nearest in odd ways, smooth in the last two. */
typedef struct gprojt_under_way {
    gproj_mesh *mesh;
    gproj_form *form;
    int32_t fairness, targets; /* groups */
} gprojt_under_way;

enum {
    GPROJT_WAYS = 6
};

static void gprojt_set_out(gprojt_under_way *under, int way) {
    static const int32_t corner[2] = {0, 6};
    gproj_solve_options options = gprojt_nearest_or_not(way % 2);
    int k;
    options.smooth = way >= 4;
    under->mesh = gprojt_roof(6, 0.3);
    under->form = gproj_form_create(under->mesh, NULL);
    gproj_add_planarity(under->form, 1);
    under->fairness = gproj_add_fairness(under->form, 0.2);
    gproj_add_closeness(under->form, 0.1);
    under->targets = gproj_add_targets(under->form, 2, corner, under->mesh->position, 1);
    gproj_solve_begin(under->form, 60, &options, NULL);
    for (k = 0; k < 5; ++k) gproj_solve_advance(under->form, 0);
    GPROJT_CHECK(gproj_solve_is_on(under->form));
}

static void gprojt_check_same_end(gprojt_under_way *a, gprojt_under_way *b) {
    double *expected;
    gproj_result at_once = gprojt_go_on(a->form), result = gprojt_go_on(b->form);
    expected = gprojt_keep(a->mesh);
    GPROJT_CHECK(strcmp(result.message, at_once.message) == 0 && result.iterations == at_once.iterations);
    GPROJT_CHECK(gprojt_unmoved(b->mesh, expected));
    free(expected);
    gproj_form_destroy(a->form), gproj_form_destroy(b->form);
    gproj_mesh_destroy(a->mesh), gproj_mesh_destroy(b->mesh);
}

/* A change that the solve has not seen yet is in a state, too. */
GPROJT_TEST(changes_between_frames_are_saved) {
    int way, k;
    for (way = 0; way < GPROJT_WAYS; ++way) {
        static const double to[6] = {0.1, 0, 1, 6, 0, 2};
        gprojt_under_way under[2];
        uint8_t *state;
        size_t size;
        for (k = 0; k < 2; ++k) {
            gprojt_set_out(&under[k], way);
            if (way / 2 % 2)
                gproj_set_targets(under[k].form, under[k].targets, to);
            else
                gproj_set_schedule(under[k].form, under[k].fairness, gproj_keep(2));
        }
        state = gprojt_save(under[1].form, &size);
        GPROJT_CHECK(gproj_state_restore(under[1].form, state, size, NULL) == GPROJ_OK);
        gprojt_check_same_form(under[1].form, state, size);
        free(state);
        gprojt_check_same_end(&under[0], &under[1]);
    }
}

/* Asking for gradients, and solves of the system that are refused, change nothing of what follows. */
GPROJT_TEST(questions_between_frames) {
    int way;
    for (way = 0; way < 2 * GPROJT_WAYS; ++way) {
        gprojt_under_way under[2];
        gproj_system *s;
        gprojt_set_out(&under[0], way / 2), gprojt_set_out(&under[1], way / 2);
        s = gproj_form_system(under[1].form);
        if (way % 2)
            GPROJT_CHECK(gproj_system_check_gradients(s) < 1e-6);
        else
            GPROJT_CHECK(gproj_system_solve(s, -1, NULL).outcome == GPROJ_FAILED);
        gprojt_check_same_end(&under[0], &under[1]);
    }
}

/* Nothing of the solve before is left in one that is restored. */
GPROJT_TEST(restored_over_another_solve) {
    int way, k;
    for (way = 0; way < GPROJT_WAYS; ++way) {
        gprojt_under_way under[2];
        uint8_t *state;
        size_t size;
        for (k = 0; k < 2; ++k) gprojt_set_out(&under[k], way);
        state = gprojt_save(under[1].form, &size);
        gprojt_inside_spoil_solve(under[1].form);
        GPROJT_CHECK(gproj_state_restore(under[1].form, state, size, NULL) == GPROJ_OK);
        free(state);
        gprojt_check_same_end(&under[0], &under[1]);
    }
}

/* Between solves nothing is under way: where such a state is restored, the end of another solve is not told any more. */
GPROJT_TEST(restored_after_the_end) {
    gproj_mesh *mesh = gprojt_roof(5, 0.08);
    gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
    size_t size;
    uint8_t *state = gprojt_save(form, &size);
    gproj_solve_begin(form, 20, NULL, NULL);
    gprojt_go_on(form);
    GPROJT_CHECK(gproj_solve_advance(form, 0).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK && !gproj_solve_is_on(form));
    GPROJT_CHECK(strstr(gproj_solve_advance(form, 0).message, "nothing is under way"));
    free(state);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A form in frames whose groups are few. */
static void gprojt_set_out_plainly(gprojt_under_way *under, const gproj_solve_options *options,
                                   const gproj_host *host) {
    static const int32_t corner[2] = {0, 6};
    int k;
    under->mesh = gprojt_roof(6, 0.3);
    gprojt_shake(under->mesh, 0.5, 1);
    under->form = gproj_form_create(under->mesh, host);
    gproj_add_planarity(under->form, 1);
    gproj_add_targets(under->form, 2, corner, under->mesh->position, 1);
    gproj_solve_begin(under->form, 20, options, NULL);
    for (k = 0; k < 3; ++k) gproj_solve_advance(under->form, 0);
}

static gproj_drag *gprojt_pull_middle(gproj_form *form) {
    static const double to[3] = {0, 0, 2};
    int32_t vertex = 24;
    gproj_handles handles = gprojt_vertex_handles(1, &vertex);
    gproj_drag *drag = gproj_drag_begin(form, &handles, NULL, NULL);
    GPROJT_CHECK(drag && gproj_drag_move(drag, to) == GPROJ_OK);
    return drag;
}

/* Rows of corners and groups of other solves and drags come in. */
static void gprojt_bring_groups_in(gprojt_under_way *under) {
    gproj_solve_options smooth = gprojt_nearest_or_not(0);
    smooth.smooth = true;
    gprojt_shake(under->mesh, 1.5, 7); /* so that many corners are kept */
    gproj_solve(under->form, 200, &smooth);
    gproj_drag_end(gprojt_pull_middle(under->form));
}

/* Groups and rows of the library that have come in since do not count where a state is restored, or a drag cancelled. */
GPROJT_TEST(restored_where_groups_came_in) {
    int way, k;
    for (way = 0; way < 8; ++way) {
        gproj_solve_options options = gprojt_nearest_or_not(way % 4 == 1 || way % 4 == 3);
        gprojt_under_way under[2];
        uint8_t *state;
        size_t size;
        options.smooth = way % 4 == 2, options.skip_guard = way % 4 == 3;
        for (k = 0; k < 2; ++k) gprojt_set_out_plainly(&under[k], &options, NULL);
        GPROJT_CHECK(gproj_solve_is_on(under[0].form));
        if (way < 4) {
            state = gprojt_save(under[1].form, &size);
            gprojt_bring_groups_in(&under[1]);
            GPROJT_CHECK(gproj_state_restore(under[1].form, state, size, NULL) == GPROJ_OK);
            free(state);
        } else {
            gproj_drag *drag = gprojt_pull_middle(under[1].form);
            GPROJT_CHECK(gproj_drag_release(drag));
            gproj_solve_advance(under[1].form, 0);
            gproj_drag_cancel(drag);
        }
        GPROJT_CHECK(gprojt_go_on(under[0].form).iterations == gprojt_go_on(under[1].form).iterations);
        for (k = 0; k < 3 * under[0].mesh->vertex_count; ++k) /* all but the last digits */
            GPROJT_CHECK(fabs(under[0].mesh->position[k] - under[1].mesh->position[k]) < 1e-7);
        for (k = 0; k < 2; ++k) gproj_form_destroy(under[k].form), gproj_mesh_destroy(under[k].mesh);
    }
}

/* Rows that are taken away mean another analysis: if there is no memory for it the mesh is where it was. */
GPROJT_TEST(restored_without_memory) {
    gproj_solve_options options = gprojt_nearest_or_not(1);
    gproj_code code = GPROJ_ERROR_MEMORY;
    long at;
    for (at = 1; code != GPROJ_OK && at < 1000; at += at < 10 ? 1 : 29) { /* which allocation fails */
        gprojt_failing failing;
        gproj_host host;
        gprojt_under_way under;
        uint8_t *state;
        double *kept;
        size_t size;
        memset(&failing, 0, sizeof failing);
        host = gprojt_failing_host(&failing);
        gprojt_set_out_plainly(&under, &options, &host);
        state = gprojt_save(under.form, &size);
        gprojt_bring_groups_in(&under);
        kept = gprojt_keep(under.mesh);
        failing.fail_at = failing.calls + at;
        code = gproj_state_restore(under.form, state, size, NULL);
        GPROJT_CHECK(code == (failing.calls < failing.fail_at ? GPROJ_OK : GPROJ_ERROR_MEMORY));
        GPROJT_CHECK(code == GPROJ_OK || gprojt_unmoved(under.mesh, kept));
        free(kept), free(state);
        gproj_form_destroy(under.form), gproj_mesh_destroy(under.mesh);
        GPROJT_CHECK(failing.held == 0);
    }
    GPROJT_CHECK(at > 20 && code == GPROJ_OK);
}

/* A state in frames goes on as its first attempt, not as the last of a solve in between, whose steps are bent. */
GPROJT_TEST(resumed_after_attempts) {
    gprojt_under_way under[2];
    gproj_solve_options options = gprojt_nearest_or_not(0);
    uint8_t *state;
    double *start;
    size_t size;
    int32_t edge = 0;
    int k;
    options.smooth = true;
    for (k = 0; k < 2; ++k) {
        under[k].mesh = gprojt_roof(6, 0.08);
        under[k].form = gproj_form_create(under[k].mesh, NULL);
        gprojt_add_standing(under[k].form, under[k].mesh);
        gproj_add_length_bounds(under[k].form, 1, &edge, 9, INFINITY, 1); /* in vain */
        gproj_add_fixed(under[k].form, 2, under[k].mesh->origin, 1);
        start = gprojt_keep(under[k].mesh);
        GPROJT_CHECK(gproj_solve(under[k].form, 200, &options).attempts == 3); /* with all groups from now on */
        gprojt_put_back(under[k].mesh, start);
        free(start);
        gproj_solve_begin(under[k].form, 40, &options, NULL);
        gproj_solve_advance(under[k].form, 0), gproj_solve_advance(under[k].form, 0);
    }
    state = gprojt_save(under[0].form, &size);
    GPROJT_CHECK(gproj_solve(under[1].form, 200, &options).attempts == 3);
    GPROJT_CHECK(gproj_state_restore(under[1].form, state, size, NULL) == GPROJ_OK);
    free(state);
    gprojt_check_same_end(&under[0], &under[1]);
}

/* What the first forces left of the loads is in a state, for the verdict: a shape that hangs is asked to stand. */
GPROJT_TEST(verdicts_are_resumed) {
    gproj_mesh *mesh[2];
    gproj_form *form[2];
    gproj_result result[2];
    uint8_t *state;
    size_t size;
    int32_t k, v;
    for (k = 0; k < 2; ++k) {
        mesh[k] = gprojt_roof(5, 0);
        for (v = 0; v < mesh[k]->vertex_count; ++v) mesh[k]->position[3 * v + 2] *= -1;
        form[k] = gproj_form_create(mesh[k], NULL);
        gprojt_add_standing(form[k], mesh[k]);
        gproj_add_compression(form[k], 0, NULL, 1);
        gproj_add_fixed_boundary(form[k], 1);
    }
    gproj_solve_begin(form[0], 60, NULL, NULL);
    gproj_solve_advance(form[0], 0), gproj_solve_advance(form[0], 0);
    state = gprojt_save(form[0], &size);
    GPROJT_CHECK(gproj_state_restore(form[1], state, size, NULL) == GPROJ_OK);
    for (k = 0; k < 2; ++k) result[k] = gprojt_go_on(form[k]);
    GPROJT_CHECK(strstr(result[0].message, "as it was the shape hung") != NULL);
    GPROJT_CHECK(strcmp(result[0].message, result[1].message) == 0);
    free(state);
    for (k = 0; k < 2; ++k) gproj_form_destroy(form[k]), gproj_mesh_destroy(mesh[k]);
}

/* A flat net that is to stand, with its boundary fixed. */
static gproj_form *gprojt_flat_net(gproj_mesh **mesh) {
    gproj_form *form;
    int32_t v;
    *mesh = gprojt_roof(5, 0);
    for (v = 0; v < (*mesh)->vertex_count; ++v) (*mesh)->position[3 * v + 2] = 0;
    form = gproj_form_create(*mesh, NULL);
    gprojt_add_standing(form, *mesh);
    gproj_add_fixed_boundary(form, 1);
    return form;
}

/* It is bent by uniform forces first, which are guided by a group of their own: fresh forms get it from the state. */
GPROJT_TEST(resumed_with_forces_that_bend) {
    gproj_mesh *mesh[3];
    gproj_form *form[3];
    uint8_t *state;
    size_t size;
    int32_t k;
    for (k = 0; k < 3; ++k) form[k] = gprojt_flat_net(&mesh[k]);
    GPROJT_REQUIRE(gproj_solve_begin(form[0], 20, NULL, NULL));
    for (k = 0; k < 3; ++k) gproj_solve_advance(form[0], 0);
    state = gprojt_save(form[0], &size);
    gproj_solve(form[1], 2, NULL); /* has them already */
    for (k = 0; k < 3; ++k) {
        if (k) GPROJT_CHECK(gproj_state_restore(form[k], state, size, NULL) == GPROJ_OK);
        GPROJT_CHECK(gprojt_go_on(form[k]).outcome == GPROJ_CONVERGED);
        GPROJT_CHECK(gprojt_unmoved(mesh[0], mesh[k]->position));
    }
    GPROJT_CHECK(mesh[0]->position[3 * gprojt_middle(mesh[0]) + 2] > 0.1);
    for (k = 0; k < 3; ++k) {
        gproj_form_destroy(form[k]);
        gproj_mesh_destroy(mesh[k]);
    }
    free(state);
}

/* The nearest flat mesh is spoiled and gets safeguards on the way: as in one go, before they act and after, and when they
   yield at the end because nothing holds with them (the second mesh). */
GPROJT_TEST(resumed_while_it_is_mended) {
    static const int shape[2] = {0, 3};
    int32_t k, i, at;
    for (i = 0; i < 2; ++i) {
        gproj_mesh *mesh = gprojt_noisy(shape[i], 8, 0.06, 5);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_solve_options options = gprojt_nearest_or_not(1);
        double *start = gprojt_keep(mesh), *end;
        gproj_add_planarity(form, 1);
        GPROJT_CHECK(gproj_solve(form, 60, &options).iterations > 45);
        end = gprojt_keep(mesh);
        for (at = 10; at < 60; at += 22) {
            gproj_mesh *other = gprojt_noisy(shape[i], 8, 0.06, 5);
            gproj_form *fresh = gproj_form_create(other, NULL);
            uint8_t *state;
            size_t size;
            gproj_add_planarity(fresh, 1);
            gprojt_put_back(mesh, start);
            GPROJT_REQUIRE(gproj_solve_begin(form, 60, &options, NULL));
            for (k = 0; k < at && gproj_solve_is_on(form); ++k) gproj_solve_advance(form, 0);
            state = gprojt_save(form, &size);
            while (gproj_solve_is_on(form)) gproj_solve_advance(form, 0);
            GPROJT_CHECK(gprojt_unmoved(mesh, end));
            GPROJT_CHECK(gproj_state_restore(fresh, state, size, NULL) == GPROJ_OK);
            gprojt_check_same_form(fresh, state, size);
            while (gproj_solve_is_on(fresh)) gproj_solve_advance(fresh, 0);
            GPROJT_CHECK(gprojt_unmoved(other, end));
            free(state);
            gproj_form_destroy(fresh);
            gproj_mesh_destroy(other);
        }
        free(start), free(end);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Undo and redo: weights, targets, forces and positions are those of the state, and what follows is what followed. */
GPROJT_TEST(undo_and_redo) {
    gproj_mesh *mesh = gprojt_roof(6, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_STANDING, NULL);
    int32_t v = gprojt_middle(mesh), targets, k;
    double to[3], *forces = (double *)malloc((size_t)mesh->edge_count * sizeof *forces), *after[2], weight = 0.5;
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    uint8_t *undo, *redo;
    size_t undo_size, redo_size;
    gproj_drag *drag;
    memcpy(to, mesh->position + 3 * v, sizeof to);
    targets = gproj_add_targets(form, 1, &v, to, 1);
    undo = gprojt_save(form, &undo_size); /* before anything was solved */
    for (k = 0; k < 2; ++k) {
        if (k) GPROJT_CHECK(gproj_state_restore(form, undo, undo_size, NULL) == GPROJ_OK);
        GPROJT_CHECK(gproj_get_forces(form, forces, NULL) == GPROJ_OK && forces[3] == 0);
        to[2] += k ? 0 : 0.3;
        gproj_set_targets(form, targets, to);
        GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
        after[k] = gprojt_keep(mesh);
    }
    GPROJT_CHECK(gprojt_unmoved(mesh, after[0]));
    undo = (uint8_t *)(free(undo), gprojt_save(form, &undo_size));
    gproj_set_schedule(form, targets, gprojt_schedule(0, 0, 0));
    gproj_set_element_weights(form, 0, 1, &v, &weight);
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    GPROJT_REQUIRE(drag);
    to[2] += 0.4;
    gproj_drag_move(drag, to);
    GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
    redo = gprojt_save(form, &redo_size);
    free(after[1]);
    after[1] = gprojt_keep(mesh);
    GPROJT_CHECK(gproj_state_restore(form, undo, undo_size, NULL) == GPROJ_OK && gprojt_unmoved(mesh, after[0]));
    GPROJT_CHECK(gproj_form_group_info(form, targets).schedule.weight == 1);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_state_restore(form, redo, redo_size, NULL) == GPROJ_OK && gprojt_unmoved(mesh, after[1]));
    gprojt_check_same_form(form, redo, redo_size);
    GPROJT_CHECK(gproj_form_group_info(form, targets).schedule.weight == 0);
    free(undo), free(redo), free(after[0]), free(after[1]), free(forces);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* -- states that are none -- */

static void gprojt_check_refused(gproj_form *form, const uint8_t *state, size_t size, gproj_code code,
                                 const char *words) {
    gproj_error error;
    GPROJT_CHECK(gproj_state_restore(form, state, size, &error) == code);
    GPROJT_CHECK(error.code == code && strstr(error.message, words));
    if (!strstr(error.message, words)) printf("  '%s' is not '%s'\n", error.message, words);
}

/* Takes the state of the first of several forms, which fits; it is refused by the others, that differ. */
static uint8_t *gprojt_check_other(gproj_form *form, uint8_t *first, size_t *size) {
    if (first) {
        gprojt_check_refused(form, first, *size, GPROJ_ERROR_ARGUMENT, "another form");
        return first;
    }
    first = gprojt_save(form, size);
    GPROJT_CHECK(gproj_state_restore(form, first, *size, NULL) == GPROJ_OK);
    return first;
}

/* A form in the middle of a solve, and its state. */
static gproj_form *gprojt_form_in_frames(gproj_mesh *mesh, uint8_t **state, size_t *size) {
    gproj_form *form = gprojt_design(mesh, GPROJT_GLIDING, NULL);
    gproj_solve_begin(form, GPROJT_ITERATIONS, NULL, NULL);
    gproj_solve_advance(form, 0);
    *state = gprojt_save(form, size);
    return form;
}

GPROJT_TEST(every_damage_is_seen) {
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    uint8_t *state, *damaged;
    size_t size, i;
    gproj_form *form = gprojt_form_in_frames(mesh, &state, &size);
    damaged = (uint8_t *)malloc(size + 8);
    if (!damaged) abort();
    GPROJT_CHECK(memcmp(state, "gprojstO", 8) == 0); /* as the header and README's "Changes" say */
    for (i = 0; i < size; ++i) {
        memcpy(damaged, state, size);
        damaged[i] ^= (uint8_t)(1 + i % 255);
        GPROJT_CHECK(gproj_state_restore(form, damaged, size, NULL) != GPROJ_OK);
        memcpy(damaged, state, i);
        GPROJT_CHECK(gproj_state_restore(form, damaged, i, NULL) == GPROJ_ERROR_SYNTAX);
    }
    memcpy(damaged, state, size);
    damaged[size] = 0;
    gprojt_check_refused(form, damaged, size + 1, GPROJ_ERROR_SYNTAX, "it says that it has");
    damaged[size / 2] ^= 1;
    gprojt_check_refused(form, damaged, size, GPROJ_ERROR_SYNTAX, "checksum");
    damaged[0] ^= 1;
    gprojt_check_refused(form, damaged, size, GPROJ_ERROR_SYNTAX, "no saved state");
    gprojt_check_refused(form, NULL, 100, GPROJ_ERROR_SYNTAX, "no saved state");
    gprojt_check_same_form(form, state, size);
    free(state), free(damaged);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* States cut short that say so, with a right checksum, end too early; nothing behind them is read, as sanitizers see. */
GPROJT_TEST(states_cut_short) {
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    uint8_t *state;
    size_t size, i, k;
    int32_t group;
    gproj_form *form = gprojt_form_in_frames(mesh, &state, &size);
    gproj_system *system = gproj_form_system(form);
    free(state);
    /* The first byte of a weight is 1, which is no flag where the weight is cut off. */
    for (group = 0; group < gproj_system_group_count(system); ++group)
        gproj_system_set_row_weight(system, group, 0, 1 + DBL_EPSILON);
    state = gprojt_save(form, &size);
    for (i = 33; i < size; ++i) {
        uint8_t *cut = (uint8_t *)malloc(i);
        if (!cut) abort();
        memcpy(cut, state, i);
        for (k = 0; k < 8; ++k) cut[8 + k] = (uint8_t)((uint64_t)i >> 8 * k);
        gprojt_seal(cut, i);
        gprojt_check_refused(form, cut, i, GPROJ_ERROR_SYNTAX, "it ends too early");
        free(cut);
    }
    gprojt_check_same_form(form, state, size);
    free(state);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* States in which one byte is another one, and one too many at the end, are refused without a trace, but for groups of the
   library's own that come in, without a weight: then the form is made anew. */
GPROJT_TEST(refused_states_leave_no_trace) {
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    double *original = gprojt_keep(mesh);
    uint8_t *state, *forged, *again;
    size_t size, longer, size_again, i, k, grown = 0;
    gproj_form *form = gprojt_form_in_frames(mesh, &state, &size);
    longer = size + 1;
    forged = (uint8_t *)malloc(longer);
    if (!forged) abort();
    for (i = 24; i + 8 < size; ++i) {
        memcpy(forged, state, size);
        forged[i]++;
        forged[size - 8] = 0;
        for (k = 0; k < 8; ++k) forged[8 + k] = (uint8_t)((uint64_t)longer >> 8 * k);
        gprojt_seal(forged, longer);
        GPROJT_CHECK(gproj_state_restore(form, forged, longer, NULL) == GPROJ_ERROR_SYNTAX);
        again = gprojt_save(form, &size_again);
        GPROJT_CHECK(size_again > size || (size_again == size && memcmp(state, again, size) == 0));
        free(again);
        if (size_again == size) continue;
        ++grown;
        gproj_form_destroy(form);
        gprojt_put_back(mesh, original);
        form = gprojt_form_in_frames(mesh, &again, &size_again);
        GPROJT_CHECK(size_again == size && memcmp(state, again, size) == 0);
        free(again);
    }
    GPROJT_CHECK(grown < 10);
    free(state), free(forged), free(original);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Forged states with a right checksum are taken or refused, and never do harm: what they hold is in its range. */
GPROJT_TEST(forged_states_do_no_harm) {
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    uint8_t *state, *forged;
    size_t size;
    gproj_form *form = gprojt_form_in_frames(mesh, &state, &size);
    uint64_t random = 7;
    int32_t k, changes, taken = 0, refused = 0;
    forged = (uint8_t *)malloc(size);
    if (!forged) abort();
    memcpy(forged, state, size);
    gprojt_seal(forged, size);
    GPROJT_CHECK(memcmp(forged, state, size) == 0); /* this is the checksum */
    for (k = 0; k < 3000; ++k) {
        memcpy(forged, state, size);
        for (changes = gprojt_below(&random, 4); changes >= 0; --changes)
            forged[24 + gprojt_below(&random, (int32_t)size - 32)] = (uint8_t)gprojt_random(&random);
        gprojt_seal(forged, size);
        if (gproj_state_restore(form, forged, size, NULL) == GPROJ_OK) {
            ++taken;
            if (taken % 20 == 0) gproj_solve_advance(form, 0);
        } else {
            ++refused;
        }
        GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
    }
    GPROJT_CHECK(taken > 100 && refused > 100 && gproj_form_error(form)->code == GPROJ_OK);
    gprojt_check_same_form(form, state, size);
    free(state), free(forged);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* The byte before each group tells whose it is. One that is no group's of the library is refused, wherever it stands. */
GPROJT_TEST(groups_of_nobody_are_refused) {
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    uint8_t *state, *forged;
    size_t size, i;
    gproj_form *form = gprojt_form_in_frames(mesh, &state, &size);
    int32_t refused = 0;
    forged = (uint8_t *)malloc(size);
    if (!forged) abort();
    for (i = 24; i + 8 < size; ++i) {
        gproj_error error;
        memcpy(forged, state, size);
        forged[i] = 200;
        gprojt_seal(forged, size);
        if (gproj_state_restore(form, forged, size, &error) != GPROJ_OK)
            refused += strstr(error.message, "a group is not one of the form") != NULL;
        GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
    }
    GPROJT_CHECK(refused >= gproj_system_group_count(gproj_form_system(form)));
    free(state), free(forged);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A solve in frames ends when something is added, also if the form is saved before the next frame. */
GPROJT_TEST(saving_hides_no_additions) {
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    uint8_t *state;
    size_t size;
    gproj_form *form = gprojt_form_in_frames(mesh, &state, &size);
    gproj_result result;
    free(state);
    GPROJT_CHECK(gproj_solve_is_on(form) && gproj_add_lengths(form, 1, NULL, NULL, 1) >= 0);
    state = gprojt_save(form, &size);
    result = gproj_solve_advance(form, 0);
    GPROJT_CHECK(result.outcome == GPROJ_FAILED && strstr(result.message, "were added since the solve began"));
    GPROJT_CHECK(!gproj_solve_is_on(form));
    free(state);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Takes a forged state: all that follows is finite. A refusal changes neither positions nor variables; it may leave
   groups of the library's own without a weight. False: numbers were so large that the form has an error. */
static bool gprojt_try_forged(gproj_form *form, const uint8_t *forged, const uint8_t *state, size_t size,
                              int32_t taken[2]) {
    gproj_system *system = gproj_form_system(form);
    const gproj_mesh *mesh = gprojt_inside_mesh(form);
    size_t bytes = (size_t)gproj_system_variable_count(system) * sizeof(double);
    double *kept = gprojt_keep(mesh), *variables = (double *)malloc(bytes);
    bool took;
    if (!variables) abort();
    memcpy(variables, gproj_system_values(system), bytes);
    took = gproj_state_restore(form, forged, size, NULL) == GPROJ_OK;
    if (took) {
        gproj_result result = gproj_solve_is_on(form) ? gproj_solve_advance(form, 0) : gproj_solve(form, 2, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_FAILED || gprojt_all_finite(mesh->position, 3 * mesh->vertex_count));
        GPROJT_CHECK(result.outcome != GPROJ_CONVERGED || result.residual <= result.tolerance);
    } else {
        GPROJT_CHECK(gprojt_unmoved(mesh, kept) && !memcmp(variables, gproj_system_values(system), bytes));
    }
    free(kept), free(variables);
    taken[took]++;
    if (gproj_form_error(form)->code != GPROJ_OK) return false;
    GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
    return true;
}

/* Each byte of a small state in turn is 0, 255, one more and one less, with the right checksum; with sanitizers, which
   are slow, each one of the four. */
#ifdef GPROJT_SANITIZED
enum {
    GPROJT_FORGE_STEP = 4
};
#else
enum {
    GPROJT_FORGE_STEP = 1
};
#endif
static void gprojt_forge_each_byte(int design, const gproj_solve_options *options, int32_t steps) {
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    gproj_form *form = gprojt_design(mesh, design, NULL);
    double *original = gprojt_keep(mesh);
    uint8_t *state, *forged;
    size_t size, i;
    int32_t k, taken[2] = {0, 0};
    GPROJT_CHECK(gproj_solve_begin(form, GPROJT_ITERATIONS, options, NULL));
    for (k = 0; k < steps; ++k) gproj_solve_advance(form, 0);
    state = gprojt_save(form, &size);
    forged = (uint8_t *)malloc(size);
    if (!forged) abort();
    for (i = 0; i + 8 < size; ++i)
        for (k = (int32_t)i % GPROJT_FORGE_STEP; k < 4; k += GPROJT_FORGE_STEP) {
            memcpy(forged, state, size);
            forged[i] = (uint8_t)(k == 0 ? 0 : k == 1 ? 255 : k == 2 ? state[i] + 1 : state[i] - 1);
            if (forged[i] == state[i]) continue;
            gprojt_seal(forged, size);
            if (gprojt_try_forged(form, forged, state, size, taken)) continue;
            GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_ERROR_NUMBER);
            gproj_form_destroy(form);
            gprojt_put_back(mesh, original);
            form = gprojt_design(mesh, design, NULL);
            GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
        }
    GPROJT_CHECK(taken[0] > 100 && taken[1] > 100); /* refused, taken */
    free(state), free(forged), free(original);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(each_byte_forged) {
    static const int designs[4] = {GPROJT_BOUNDED, GPROJT_GLIDING, GPROJT_STANDING, GPROJT_PLAIN};
    gproj_solve_options options;
    int way;
    for (way = 0; way < 4; ++way) { /* before the first step, then amid a plain, a nearest and a smooth solve */
        memset(&options, 0, sizeof options);
        options.nearest = way == 2, options.smooth = way == 3;
        gprojt_forge_each_byte(designs[way], &options, way ? 2 : 0);
    }
}

/* A number's bytes in states. */
static void gprojt_bytes_of(double number, uint8_t bytes[8]) {
    uint64_t bits;
    int k;
    memcpy(&bits, &number, 8);
    for (k = 0; k < 8; ++k) bytes[k] = (uint8_t)(bits >> (8 * k));
}

/* A nearest solve's state needs an analysis in a form that has made none; one that is wrong at any place before is refused
   without. */
GPROJT_TEST(wrong_states_are_not_analysed) {
    uint8_t right[8], wrong[8];
    gproj_mesh *mesh = gprojt_roof(3, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
    gproj_solve_options options;
    double mark[2] = {1.7319939418e-9, 0}, *start = gprojt_keep(mesh);
    uint8_t *state;
    size_t size, i;
    int32_t k;
    memset(&options, 0, sizeof options);
    options.nearest = true, options.tolerance = mark[0];
    GPROJT_CHECK(gproj_solve_begin(form, GPROJT_ITERATIONS, &options, NULL));
    for (k = 0; k < 3; ++k) mark[1] = gproj_solve_advance(form, 0).step;
    state = gprojt_save(form, &size);
    gproj_form_destroy(form);
    for (k = 0; k < 3; ++k) { /* the tolerance; the last step; nothing */
        gproj_code code;
        gprojt_put_back(mesh, start);
        form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
        gprojt_bytes_of(-1, wrong), gprojt_bytes_of(mark[k % 2], right);
        for (i = 24; k < 2 && memcmp(state + i, right, 8) != 0; ++i) GPROJT_REQUIRE(i + 8 < size);
        if (k < 2) memcpy(state + i, wrong, 8);
        gprojt_seal(state, size);
        code = gproj_state_restore(form, state, size, NULL);
        GPROJT_CHECK(code == (k == 2 ? GPROJ_OK : GPROJ_ERROR_SYNTAX));
        GPROJT_CHECK((gprojt_inside_factor(gproj_form_system(form)).columns > 0) == (k == 2));
        if (k < 2) memcpy(state + i, right, 8);
        gproj_form_destroy(form);
    }
    free(state), free(start);
    gproj_mesh_destroy(mesh);
}

/* -- ranges: a number that stands once in a state is found by its bits, and replaced -- */

static bool gprojt_takes(gproj_form *form, const uint8_t *state, size_t size, const void *old, const void *other,
                         size_t width) {
    uint8_t *forged = (uint8_t *)malloc(size);
    size_t i, found = 0, times = 0;
    bool took;
    if (!forged) abort();
    memcpy(forged, state, size);
    for (i = 24; i + width + 8 <= size; ++i)
        if (memcmp(state + i, old, width) == 0) found = i, ++times;
    GPROJT_CHECK(times == 1);
    memcpy(forged + found, other, width);
    gprojt_seal(forged, size);
    took = gproj_state_restore(form, forged, size, NULL) == GPROJ_OK;
    GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
    free(forged);
    return took;
}

/* From least to most, both included, and nothing else; infinities as `infinite` says. */
static void gprojt_check_range(gproj_form *form, const uint8_t *state, size_t size, double mark, double least,
                               double most) {
    double wrong[3] = {NAN, HUGE_VAL, -HUGE_VAL}, other;
    int k;
    for (k = 0; k < 3; ++k) GPROJT_CHECK(!gprojt_takes(form, state, size, &mark, &wrong[k], 8));
    GPROJT_CHECK(gprojt_takes(form, state, size, &mark, &least, 8));
    GPROJT_CHECK(gprojt_takes(form, state, size, &mark, &most, 8));
    other = nextafter(least, -HUGE_VAL);
    if (least > -DBL_MAX) GPROJT_CHECK(!gprojt_takes(form, state, size, &mark, &other, 8));
    other = nextafter(most, HUGE_VAL);
    if (most < DBL_MAX) GPROJT_CHECK(!gprojt_takes(form, state, size, &mark, &other, 8));
}

static void gprojt_check_integers(gproj_form *form, const uint8_t *state, size_t size, int32_t mark, int32_t least) {
    int32_t below = least - 1, lowest = INT32_MIN;
    GPROJT_CHECK(gprojt_takes(form, state, size, &mark, &least, 4));
    GPROJT_CHECK(!gprojt_takes(form, state, size, &mark, &below, 4));
    GPROJT_CHECK(!gprojt_takes(form, state, size, &mark, &lowest, 4));
}

/* What is out of the range that the functions accept is not read, whatever the checksum says. Numbers stand in a state as
   in the memory of little-endian machines. */
GPROJT_TEST(numbers_out_of_range) {
    static const double weight = 0.3745401188, decay = 0.9507143064, tolerance = 1.7319939418e-9;
    static const double epsilon = 1.5986584842e-3, budget = 1560.1864044, factor = 0.1559945203, height = 0.5808361216;
    static const double of_row = 0.8661761457, own = 0.6011150117, of_edge = 0.7080725777;
    static const int32_t last = 123456789, iterations = 7654321, one = 1;
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
    int32_t closeness = gproj_add_closeness(form, 1), face = 2, edge = 3, lengths;
    gproj_solve_options options;
    gprojt_ticks ticks = {0, 0};
    gproj_host host;
    uint8_t *state;
    size_t size;
    if (*(const uint8_t *)&one != 1) GPROJT_SKIP("not on big-endian machines");
    memset(&options, 0, sizeof options);
    gproj_set_schedule(form, closeness, gprojt_schedule(weight, decay, last));
    gproj_set_element_weights(form, 0, 1, &face, &factor);
    gproj_system_set_row_weight(gproj_form_system(form), closeness, 3, of_row);
    lengths = gproj_add_lengths(form, 1, &edge, NULL, 1);
    gproj_set_element_weights(form, lengths, 1, &edge, &of_edge);
    gproj_system_set_row_weight(gproj_form_system(form), lengths, 0, own);
    mesh->position[5] = height;
    state = gprojt_save(form, &size);
    gprojt_check_range(form, state, size, weight, 0, 1e50);
    gprojt_check_range(form, state, size, decay, 0, 1);
    gprojt_check_range(form, state, size, of_row, 0, 1e100); /* a product of two weights */
    gprojt_check_range(form, state, size, own, 0, 1e50);
    gprojt_check_range(form, state, size, of_edge, 0, 1e50);
    gprojt_check_range(form, state, size, height, -DBL_MAX, DBL_MAX);
    gprojt_check_integers(form, state, size, last, GPROJ_LAST_GUIDING);
    free(state);
    gproj_form_destroy(form);
    memset(&host, 0, sizeof host);
    host.clock.now = gprojt_tick, host.clock.user = &ticks;
    form = gprojt_design(mesh, GPROJT_PLANAR, &host);
    options.tolerance = tolerance, options.epsilon = epsilon, options.time_budget = budget;
    GPROJT_REQUIRE(gproj_solve_begin(form, iterations, &options, NULL));
    state = gprojt_save(form, &size);
    gprojt_check_range(form, state, size, tolerance, 0, DBL_MAX);
    gprojt_check_range(form, state, size, epsilon, 0, DBL_MAX);
    gprojt_check_range(form, state, size, budget, 0, DBL_MAX);
    gprojt_check_integers(form, state, size, iterations, 0);
    free(state);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Likewise eighths, which have one byte: the one in which two states differ. Which: a group's weight, how it decays, the
   weight of a row. */
GPROJT_TEST(eighths_out_of_range) {
    gproj_mesh *mesh = gprojt_roof(2, 0.05);
    int32_t which, k, byte;
    for (which = 0; which < 3; ++which) {
        gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
        int32_t closeness = gproj_add_closeness(form, 1);
        uint8_t *state[2];
        size_t size[2], i, at = 0, differ = 0;
        for (k = 0; k < 2; ++k) {
            double value = 0.5 + 0.125 * k;
            gproj_set_schedule(form, closeness, gprojt_schedule(which == 0 ? value : 2, which == 1 ? value : 1, 9));
            gproj_system_set_row_weight(gproj_form_system(form), closeness, 3, which == 2 ? value : 1);
            state[k] = gprojt_save(form, &size[k]);
        }
        GPROJT_REQUIRE(size[0] == size[1]);
        for (i = 0; i + 8 < size[0]; ++i)
            if (state[0][i] != state[1][i]) at = i, ++differ;
        GPROJT_CHECK(differ == 1 && state[1][at] - state[0][at] == 1);
        for (byte = 0; byte < 255; ++byte) {
            double value = 0.5 + (byte - state[0][at]) / 8.0;
            uint8_t *forged = state[1];
            forged[at] = (uint8_t)byte;
            gprojt_seal(forged, size[0]);
            GPROJT_CHECK((gproj_state_restore(form, forged, size[0], NULL) == GPROJ_OK) ==
                         (value >= 0 && (which != 1 || value <= 1)));
        }
        free(state[0]), free(state[1]);
        gproj_form_destroy(form);
    }
    gproj_mesh_destroy(mesh);
}

/* -- nothing of later solves stays behind a restore -- */

GPROJT_TEST(solved_again_after_a_restore) {
    gproj_solve_options options[3];
    int design, k, other;
    memset(options, 0, sizeof options);
    options[1].nearest = true, options[2].smooth = true;
    for (design = 0; design < GPROJT_DESIGNS; ++design)
        for (k = 0; k < 3; ++k)
            for (other = 0; other < 3; ++other) {
                gproj_mesh *mesh = gprojt_roof(4, 0.1);
                gproj_form *form = gprojt_design(mesh, design, NULL);
                gproj_result first, second;
                double *end;
                uint8_t *state;
                size_t size;
                gproj_solve(form, 4, &options[other]);
                gprojt_shake(mesh, 0.05, 9);
                gproj_solve(form, 1, &options[k]); /* all groups of the library's own are there */
                state = gprojt_save(form, &size);
                first = gproj_solve(form, 12, &options[k]);
                end = gprojt_keep(mesh);
                gprojt_shake(mesh, 0.2, 3);
                gproj_solve(form, 5, &options[other]);
                GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
                second = gproj_solve(form, 12, &options[k]);
                GPROJT_CHECK(first.outcome == second.outcome && first.iterations == second.iterations);
                GPROJT_CHECK(gprojt_unmoved(mesh, end));
                free(state), free(end);
                gproj_form_destroy(form);
                gproj_mesh_destroy(mesh);
            }
}

/* Safeguards of rough meshes act for many iterations: a fresh form goes on with them, and so does the same form, which
   has more of them at the end. */
GPROJT_TEST(safeguards_go_on) {
    static const double noises[2] = {0.35, 0.7};
    int32_t way, k, at;
    for (way = 0; way < 4; ++way)
        for (at = 1; at < 8; ++at) {
            gproj_mesh *mesh = gprojt_roof(6, noises[way / 2]), *other = gprojt_roof(6, noises[way / 2]);
            gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
            gproj_form *fresh = gprojt_design(other, GPROJT_PLANAR, NULL);
            gproj_solve_options options;
            double *end;
            uint8_t *state;
            size_t size;
            memset(&options, 0, sizeof options);
            options.smooth = way % 2;
            gproj_solve_begin(form, 30, &options, NULL);
            for (k = 0; k < at && gproj_solve_is_on(form); ++k) gproj_solve_advance(form, 0);
            state = gprojt_save(form, &size);
            if (gproj_solve_is_on(form)) gprojt_go_on(form);
            end = gprojt_keep(mesh);
            GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
            if (gproj_solve_is_on(form)) gprojt_go_on(form);
            GPROJT_CHECK(gprojt_largest_move(mesh->position, end, mesh->vertex_count) < 1e-10);
            GPROJT_CHECK(gproj_state_restore(fresh, state, size, NULL) == GPROJ_OK);
            if (gproj_solve_is_on(fresh)) gprojt_go_on(fresh);
            GPROJT_CHECK(gprojt_largest_move(other->position, end, mesh->vertex_count) < 1e-10);
            free(state), free(end);
            gproj_form_destroy(form), gproj_form_destroy(fresh);
            gproj_mesh_destroy(mesh), gproj_mesh_destroy(other);
        }
}

GPROJT_TEST(states_of_others) {
    gproj_mesh *mesh = gprojt_roof(4, 0.05), *moved = gprojt_roof(4, 0.06), *larger = gprojt_roof(5, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_GLIDING, NULL), *other;
    uint8_t *state;
    size_t size;
    int32_t v = 5;
    gproj_solve(form, 5, NULL);
    state = gprojt_save(form, &size);
    other = gprojt_design(moved, GPROJT_GLIDING, NULL);
    gprojt_check_refused(other, state, size, GPROJ_ERROR_ARGUMENT, "another form");
    gproj_form_destroy(other);
    other = gprojt_design(larger, GPROJT_GLIDING, NULL);
    gprojt_check_refused(other, state, size, GPROJ_ERROR_ARGUMENT, "another form");
    gproj_form_destroy(other);
    other = gprojt_design(mesh, GPROJT_BOUNDED, NULL);
    gprojt_check_refused(other, state, size, GPROJ_ERROR_ARGUMENT, "another form");
    gprojt_check_refused(NULL, state, size, GPROJ_ERROR_MEMORY, "there is no object");
    gproj_form_destroy(other);
    gproj_add_fixed(form, 1, &v, 1);
    gprojt_check_refused(form, state, size, GPROJ_ERROR_ARGUMENT, "another form");
    free(state);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh), gproj_mesh_destroy(moved), gproj_mesh_destroy(larger);
}

/* Forms whose only difference is one variable in one term, the first or the second. */
GPROJT_TEST(states_of_other_variables) {
    static const gproj_term terms[3] = {{3, 7, 1}, {4, 7, 1}, {3, 8, 1}};
    gproj_mesh *mesh = gprojt_roof(3, 0.05);
    gproj_form *form[3];
    uint8_t *state;
    size_t size;
    int k;
    for (k = 0; k < 3; ++k) {
        form[k] = gproj_form_create(mesh, NULL);
        GPROJT_CHECK(gproj_form_add_row(form[k], gproj_add_rows(form[k], "own", GPROJ_WISH, GPROJ_PLACE_VERTEX, 1), 1,
                                        &terms[k], 0, 0) == 0);
    }
    state = gprojt_save(form[0], &size);
    GPROJT_CHECK(gproj_state_restore(form[0], state, size, NULL) == GPROJ_OK);
    gprojt_check_refused(form[1], state, size, GPROJ_ERROR_ARGUMENT, "another form");
    gprojt_check_refused(form[2], state, size, GPROJ_ERROR_ARGUMENT, "another form");
    for (k = 0; k < 3; ++k) gproj_form_destroy(form[k]);
    gproj_mesh_destroy(mesh);
    free(state);
}

static void gprojt_leave_rows(void *user, gproj_system *s, int32_t group, const gproj_progress *progress) {
    (void)user, (void)s, (void)group, (void)progress;
}

/* A bump beside a dent of the same size, and the other way round: only the vertices' own coordinates tell the two meshes
   apart. */
GPROJT_TEST(states_of_mirrored_meshes) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(3, 3));
    uint8_t *state = NULL;
    size_t size = 0;
    int32_t way, v;
    for (v = 0; v < mesh->vertex_count; ++v) mesh->position[3 * v + 2] = 0;
    for (way = 0; way < 2; ++way) {
        gproj_form *form;
        mesh->position[3 * 5 + 2] = way ? -0.25 : 0.25;
        mesh->position[3 * 6 + 2] = way ? 0.25 : -0.25;
        form = gproj_form_create(mesh, NULL);
        if (way == 0)
            state = gprojt_save(form, &size);
        else
            gprojt_check_refused(form, state, size, GPROJ_ERROR_ARGUMENT, "another form");
        gproj_form_destroy(form);
    }
    free(state);
    gproj_mesh_destroy(mesh);
}

/* Forms whose only difference is one property of a group, an element, or how terms are shared out among rows. */
GPROJT_TEST(states_of_other_groups) {
    static const struct {
        const char *name;
        gproj_kind kind;
        gproj_place place;
        bool global, refresh;
        int32_t element, terms; /* of the first row; the second has the others of 3 */
    } kinds[] = {{"own", GPROJ_WISH, GPROJ_PLACE_VERTEX, false, false, 0, 1},
                 {"one", GPROJ_WISH, GPROJ_PLACE_VERTEX, false, false, 0, 1},
                 {"own", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, false, false, 0, 1},
                 {"own", GPROJ_WISH, GPROJ_PLACE_FACE, false, false, 0, 1},
                 {"own", GPROJ_WISH, GPROJ_PLACE_VERTEX, true, false, 0, 1},
                 {"own", GPROJ_WISH, GPROJ_PLACE_VERTEX, false, true, 0, 1},
                 {"own", GPROJ_WISH, GPROJ_PLACE_VERTEX, false, false, 1, 1},
                 {"own", GPROJ_WISH, GPROJ_PLACE_VERTEX, false, false, 0, 2}};
    static const gproj_term terms[3] = {{3, -1, 1}, {4, -1, 1}, {8, -1, 1}};
    gproj_mesh *mesh = gprojt_roof(3, 0.05);
    uint8_t *state = NULL;
    size_t size = 0, k;
    for (k = 0; k < sizeof kinds / sizeof kinds[0]; ++k) {
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_system *s = gproj_form_system(form);
        gproj_group group;
        int32_t g;
        memset(&group, 0, sizeof group);
        group.name = kinds[k].name, group.kind = kinds[k].kind, group.place = kinds[k].place;
        group.global = kinds[k].global, group.schedule = gproj_keep(1);
        if (kinds[k].refresh) group.refresh = gprojt_leave_rows;
        g = gproj_system_add_group(s, &group);
        gproj_system_add_row(s, g, kinds[k].terms, terms, 0, kinds[k].element);
        gproj_system_add_row(s, g, 3 - kinds[k].terms, terms + kinds[k].terms, 0, 0);
        state = gprojt_check_other(form, state, &size);
        gproj_form_destroy(form);
    }
    gproj_mesh_destroy(mesh);
    free(state);
}

/* Forms whose only difference is one load. */
GPROJT_TEST(states_of_other_loads) {
    static const int32_t pin[3] = {0, 3, 12};
    gproj_mesh *mesh = gprojt_roof(3, 0.05);
    double *edge = (double *)calloc((size_t)mesh->edge_count, sizeof(double));
    double *point = (double *)calloc(3 * (size_t)mesh->vertex_count, sizeof(double));
    uint8_t *state = NULL;
    size_t size = 0;
    int k;
    for (k = 0; k < 6; ++k) {
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_loads loads;
        gproj_supports supports = {3, pin, NULL};
        memset(&loads, 0, sizeof loads);
        edge[mesh->edge_count - 1] = k == 2, point[3 * mesh->vertex_count - 1] = k == 5 ? -2 : -1;
        loads.density = k == 1, loads.area_load = k == 3, loads.snow = k == 4;
        if (k != 1) loads.edge_density = edge;
        loads.point_load = point;
        GPROJT_CHECK(gproj_add_equilibrium(form, &loads, &supports, 1) >= 0);
        state = gprojt_check_other(form, state, &size);
        gproj_form_destroy(form);
    }
    free(state), free(edge), free(point);
    gproj_mesh_destroy(mesh);
}

/* Restored in the same form, a state needs no further memory: what has been analysed is still right. */
GPROJT_TEST(restored_without_an_analysis) {
    int design;
    for (design = 0; design < GPROJT_DESIGNS; ++design) {
        gproj_mesh *mesh = gprojt_roof(6, 0.08);
        gproj_form *form = gprojt_design(mesh, design, NULL);
        uint64_t allocations;
        uint8_t *state;
        size_t size;
        int32_t k;
        gproj_solve_begin(form, 30, NULL, NULL);
        for (k = 0; k < 3; ++k) gproj_solve_advance(form, 0);
        state = gprojt_save(form, &size);
        gproj_solve_advance(form, 0);
        GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
        allocations = gproj_form_memory(form).allocations;
        gproj_solve_advance(form, 0);
        GPROJT_CHECK(gproj_form_memory(form).allocations == allocations);
        free(state);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(what_cannot_be_saved) {
    gproj_mesh *mesh = gprojt_roof(3, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
    size_t size;
    uint8_t *state = gprojt_save(form, &size);
    gproj_error error;
    GPROJT_CHECK(gproj_state_save(form, state, size - 1, &error) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(strstr(error.message, "see gproj_state_size"));
    GPROJT_CHECK(gproj_state_save(form, NULL, size, &error) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(strstr(error.message, "there is no buffer"));
    GPROJT_CHECK(gproj_state_save(NULL, state, size, &error) == GPROJ_ERROR_MEMORY && gproj_state_size(NULL) == 0);
    mesh->position[5] = HUGE_VAL;
    GPROJT_CHECK(gproj_state_save(form, state, size, &error) == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.place == GPROJ_PLACE_VERTEX && error.index == 1);
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
    free(state);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* An unknown that is no number belongs to no vertex: nothing is saved until it is a number again. */
GPROJT_TEST(unknowns_that_cannot_be_saved) {
    static const double bad[3] = {NAN, HUGE_VAL, -HUGE_VAL};
    gproj_mesh *mesh = gprojt_roof(3, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
    double *x = gproj_system_values(gproj_form_system(form)) + gprojt_inside_normal(form, 2), before = *x;
    size_t size, k;
    uint8_t *state = gprojt_save(form, &size), *again = gprojt_save(form, &size);
    int i;
    for (i = 0; i < 3; ++i) {
        gproj_error error;
        *x = bad[i];
        GPROJT_CHECK(gproj_state_size(form) == size);
        GPROJT_CHECK(gproj_state_save(form, state, size, &error) == GPROJ_ERROR_NUMBER);
        GPROJT_CHECK(error.place == GPROJ_PLACE_NONE && error.index == -1);
        GPROJT_CHECK(strstr(error.message, "state: it cannot be saved: a number is none"));
        for (k = 0; k < size; ++k) GPROJT_CHECK(state[k] == 0);
        GPROJT_CHECK(gproj_state_save(form, state, size, NULL) == GPROJ_ERROR_NUMBER);
        GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
        *x = before;
        GPROJT_CHECK(gproj_state_save(form, state, size, &error) == GPROJ_OK && memcmp(state, again, size) == 0);
    }
    free(state), free(again);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* -- failing allocations: of a state that brings the library's own groups into a fresh form -- */

typedef struct gprojt_saved {
    uint8_t *state;
    size_t size;
    double *end;
} gprojt_saved;

static bool gprojt_use_state(const gproj_host *host, void *user) {
    const gprojt_saved *saved = (const gprojt_saved *)user;
    gproj_mesh *mesh = gprojt_roof(3, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_STANDING, host);
    gproj_error error;
    gproj_code code = gproj_state_restore(form, saved->state, saved->size, &error);
    bool whole = code == GPROJ_OK && gprojt_go_on(form).outcome != GPROJ_FAILED;
    GPROJT_CHECK(code == GPROJ_OK || (code == GPROJ_ERROR_MEMORY && error.code == code));
    GPROJT_CHECK(!whole || gprojt_unmoved(mesh, saved->end));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return whole;
}

GPROJT_TEST(failing_allocations) {
    gproj_mesh *mesh = gprojt_roof(3, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_STANDING, NULL);
    gprojt_saved saved;
    gproj_solve_begin(form, GPROJT_ITERATIONS, NULL, NULL);
    gproj_solve_advance(form, 0);
    saved.state = gprojt_save(form, &saved.size);
    gprojt_go_on(form);
    saved.end = gprojt_keep(mesh);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_state, &saved) > 50);
    free(saved.state), free(saved.end);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(frames_are_one_solve);
    GPROJT_RUN(frames_have_their_time);
    GPROJT_RUN(frames_without_bound);
    GPROJT_RUN(frames_can_be_left);
    GPROJT_RUN(failures_end_frames);
    GPROJT_RUN(frames_follow_targets);
    GPROJT_RUN(solved_between_frames);
    GPROJT_RUN(resumed_to_the_same_bytes);
    GPROJT_RUN(changes_between_frames_are_saved);
    GPROJT_RUN(questions_between_frames);
    GPROJT_RUN(restored_over_another_solve);
    GPROJT_RUN(restored_after_the_end);
    GPROJT_RUN(restored_where_groups_came_in);
    GPROJT_RUN(restored_without_memory);
    GPROJT_RUN(resumed_after_attempts);
    GPROJT_RUN(verdicts_are_resumed);
    GPROJT_RUN(resumed_with_forces_that_bend);
    GPROJT_RUN(resumed_while_it_is_mended);
    GPROJT_RUN(undo_and_redo);
    GPROJT_RUN(every_damage_is_seen);
    GPROJT_RUN(states_cut_short);
    GPROJT_RUN(refused_states_leave_no_trace);
    GPROJT_RUN(forged_states_do_no_harm);
    GPROJT_RUN(groups_of_nobody_are_refused);
    GPROJT_RUN(saving_hides_no_additions);
    GPROJT_RUN(each_byte_forged);
    GPROJT_RUN(wrong_states_are_not_analysed);
    GPROJT_RUN(numbers_out_of_range);
    GPROJT_RUN(eighths_out_of_range);
    GPROJT_RUN(solved_again_after_a_restore);
    GPROJT_RUN(safeguards_go_on);
    GPROJT_RUN(states_of_others);
    GPROJT_RUN(states_of_other_variables);
    GPROJT_RUN(states_of_mirrored_meshes);
    GPROJT_RUN(states_of_other_groups);
    GPROJT_RUN(states_of_other_loads);
    GPROJT_RUN(restored_without_an_analysis);
    GPROJT_RUN(what_cannot_be_saved);
    GPROJT_RUN(unknowns_that_cannot_be_saved);
    GPROJT_RUN(failing_allocations);
    return gprojt_report();
}
