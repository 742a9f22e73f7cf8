/* test_system.c - >>system: rows as data, every refusal, and one step against a dense solve of the normal equations. */
#define GPROJ_STATIC
#include "gprojt_form.h"
#include "gprojt_inside.h"

/* -- values and gradients -- */

typedef struct gprojt_hand_row {
    int32_t count;
    gproj_term term[4];
    double constant, value, gradient[3];
} gprojt_hand_row;

/* At x = (1, 2, 3). */
static const gprojt_hand_row gprojt_hand_rows[] = {
    {0, {{0, 0, 0}}, 5, 5, {0, 0, 0}},
    {1, {{2, -1, -4}}, 1, -11, {0, 0, -4}},
    {1, {{1, 1, 3}}, 0, 12, {0, 12, 0}},
    {1, {{0, 2, 2}}, -6, 0, {6, 0, 2}},
    {4, {{0, 1, 2}, {0, 0, 3}, {2, -1, -1}, {1, 0, 1}}, 5, 4 + 3 - 3 + 2 + 5, {2 * 2 + 6 + 2, 2 + 1, -1}},
    {3, {{1, -1, 1}, {1, -1, 1}, {1, -1, -2}}, 0.5, 0.5, {0, 0, 0}},
};
enum {
    GPROJT_HAND_ROWS = sizeof gprojt_hand_rows / sizeof gprojt_hand_rows[0]
};

static gproj_system *gprojt_hand_system(void) {
    static const double x[3] = {1, 2, 3};
    gproj_system *s = gproj_system_create(NULL);
    int32_t r, group;
    gproj_system_add_variables(s, 3, 3, x);
    group = gprojt_add_group(s, "by hand", GPROJ_CONSTRAINT, 1);
    for (r = 0; r < GPROJT_HAND_ROWS; ++r)
        gproj_system_add_row(s, group, gprojt_hand_rows[r].count, gprojt_hand_rows[r].term,
                             gprojt_hand_rows[r].constant, 100 + r);
    return s;
}

GPROJT_TEST(values_and_gradients_by_hand) {
    gproj_system *s = gprojt_hand_system();
    double gradient[3];
    int32_t r, k;
    for (r = 0; r < GPROJT_HAND_ROWS; ++r) {
        const gprojt_hand_row *row = &gprojt_hand_rows[r];
        memset(gradient, 77, sizeof gradient);
        GPROJT_NEAR(gproj_system_row_value(s, 0, r, gradient), row->value, 1e-14);
        GPROJT_NEAR(gproj_system_row_value(s, 0, r, NULL), row->value, 1e-14);
        for (k = 0; k < 3; ++k) GPROJT_NEAR(gradient[k], row->gradient[k], 1e-14);
    }
    GPROJT_CHECK(gproj_system_row_value(s, 0, GPROJT_HAND_ROWS, gradient) == 0);
    GPROJT_CHECK(gproj_system_row_value(s, 0, -1, NULL) == 0);
    GPROJT_CHECK(gproj_system_row_value(s, 1, 0, NULL) == 0);
    GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK);
    gproj_system_destroy(s);
}

GPROJT_TEST(rows_and_weights_are_replaced) {
    static const double coefficients[4] = {1, 1, 1, 1};
    gproj_system *s = gprojt_hand_system();
    GPROJT_CHECK(gproj_system_set_row(s, 0, 4, coefficients, 1) == GPROJ_OK); /* x y + x^2 + z + y x + 1 */
    GPROJT_NEAR(gproj_system_row_value(s, 0, 4, NULL), 2 + 1 + 3 + 2 + 1, 1e-14);
    GPROJT_CHECK(gproj_system_set_row(s, 0, 4, NULL, -8) == GPROJ_OK);
    GPROJT_NEAR(gproj_system_row_value(s, 0, 4, NULL), 0, 1e-14);
    GPROJT_CHECK(gproj_system_set_row(s, 0, 0, NULL, 2) == GPROJ_OK);
    GPROJT_NEAR(gproj_system_row_value(s, 0, 0, NULL), 2, 0);
    /* a row that is left out counts nowhere, the value on demand stays */
    GPROJT_CHECK(gproj_system_set_row_weight(s, 0, 2, 0) == GPROJ_OK);
    GPROJT_CHECK(gproj_system_set_row_weight(s, 0, 1, 0) == GPROJ_OK);
    gproj_system_solve(s, 0, NULL);
    GPROJT_NEAR(gproj_system_group_info(s, 0).max, 2, 1e-14);
    GPROJT_NEAR(gproj_system_row_value(s, 0, 2, NULL), 12, 1e-14);
    gproj_system_destroy(s);
}

/* (x - y)^2 by three terms of 1e16 each, whose plain sum is off by 2; products that are 1 more than doubles, also where
   compilers contract; huge numbers, whose exact products overflow. */
GPROJT_TEST(values_of_large_terms_that_cancel) {
    static const gproj_term square[3] = {{0, 0, 1}, {0, 1, -2}, {1, 1, 1}};
    const double root = ldexp(1, 30) + 1, rounded = root * root; /* 2^60 + 2^31 + 1 */
    const gproj_term product[2] = {{0, 1, 1}, {2, -1, -1}}, linear[2] = {{0, -1, root}, {2, -1, -1}};
    double x[3] = {1e8, 1e8 + 1, rounded};
    gproj_system *s = gproj_system_create(NULL);
    gproj_system_add_variables(s, 3, 1, x);
    gproj_system_add_row(s, gprojt_add_group(s, "square", GPROJ_CONSTRAINT, 1), 3, square, 0, 0);
    GPROJT_CHECK(gproj_system_row_value(s, 0, 0, NULL) == 1);
    gproj_system_values(s)[0] = gproj_system_values(s)[1] = root;
    gproj_system_add_row(s, 0, 2, product, 0, 1);
    gproj_system_add_row(s, 0, 2, linear, 0, 2);
    GPROJT_CHECK(gproj_system_row_value(s, 0, 1, NULL) == 1 && gproj_system_row_value(s, 0, 2, NULL) == 1);
    gproj_system_values(s)[0] = 1e152, gproj_system_values(s)[1] = 0;
    GPROJT_NEAR(gproj_system_row_value(s, 0, 0, NULL) / 1e304, 1, 1e-14);
    gproj_system_values(s)[0] = 1e200;
    GPROJT_CHECK(gproj_system_row_value(s, 0, 0, NULL) == HUGE_VAL);
    gproj_system_destroy(s);
}

GPROJT_TEST(group_info) {
    gproj_system *s = gprojt_hand_system();
    gproj_group_info info = gproj_system_group_info(s, 0);
    double squares = 0;
    char name[48];
    int32_t r;
    GPROJT_CHECK(!strcmp(info.name, "by hand") && info.kind == GPROJ_CONSTRAINT && info.place == GPROJ_PLACE_VERTEX);
    GPROJT_CHECK(info.rows == GPROJT_HAND_ROWS && info.schedule.weight == 1 && info.max == 0);
    GPROJT_CHECK(info.weight == 0);
    gproj_system_solve(s, 0, NULL);
    info = gproj_system_group_info(s, 0);
    for (r = 0; r < GPROJT_HAND_ROWS; ++r) squares += gprojt_hand_rows[r].value * gprojt_hand_rows[r].value;
    GPROJT_NEAR(info.max, 12, 1e-14);
    GPROJT_NEAR(info.rms, sqrt(squares / GPROJT_HAND_ROWS), 1e-13);
    GPROJT_CHECK(info.worst_row == 2 && info.worst_element == 102);
    info = gproj_system_group_info(s, 1);
    GPROJT_CHECK(!strcmp(info.name, "") && info.rows == 0 && info.worst_row == -1 && info.worst_element == -1);
    gprojt_add_group(s, "a name of more than thirty-one characters is cut", GPROJ_WISH, 0.5);
    info = gproj_system_group_info(s, 1);
    GPROJT_CHECK(!strcmp(info.name, "a name of more than thirty-one ") && info.kind == GPROJ_WISH &&
                 info.worst_row == -1);
    GPROJT_CHECK(info.rms == 0 && gproj_system_group_count(s) == 2 && gproj_system_variable_count(s) == 3);
    gprojt_add_group(s, "thirty bytes, and then one of \xe2\x82\xac and more", GPROJ_WISH, 0.5); /* a euro sign */
    GPROJT_CHECK(!strcmp(gproj_system_group_info(s, 2).name, "thirty bytes, and then one of "));
    memset(name, '\x80', sizeof name - 1), name[0] = 'x', name[sizeof name - 1] = 0;
    gprojt_add_group(s, name + 1, GPROJ_WISH, 0.5); /* no character begins anywhere */
    GPROJT_CHECK(!strcmp(gproj_system_group_info(s, 3).name, ""));
    gproj_system_destroy(s);
}

static gproj_term gprojt_random_term(uint64_t *seed, int32_t first, int32_t count) {
    int32_t i = first + gprojt_below(seed, count), j = first + gprojt_below(seed, count), kind = gprojt_below(seed, 3);
    return gprojt_term(i, kind == 0 ? -1 : kind == 1 ? i : j, 4 * gprojt_uniform(seed) - 2);
}

static void gprojt_new_coefficients(void *user, gproj_system *system, int32_t group, const gproj_progress *progress) {
    double coefficients[8];
    int32_t r, k;
    (void)progress;
    uint64_t seed = 5;
    ++*(int *)user;
    for (r = 0; r < gproj_system_group_info(system, group).rows; ++r) {
        for (k = 0; k < 8; ++k) coefficients[k] = gprojt_uniform(&seed) * gproj_system_values(system)[0];
        gproj_system_set_row(system, group, r, coefficients, gprojt_uniform(&seed));
    }
}

GPROJT_TEST(gradients_by_finite_differences) {
    gproj_system *s = gproj_system_create(NULL);
    uint64_t seed = 11;
    gproj_group group;
    int refreshes = 0;
    int32_t r, k;
    gproj_system_add_variables(s, 30, 3, NULL);
    for (k = 0; k < 30; ++k) gproj_system_values(s)[k] = 20 * gprojt_uniform(&seed) - 10;
    memset(&group, 0, sizeof group);
    group.name = "random";
    group.schedule = gproj_keep(1);
    group.refresh = gprojt_new_coefficients; /* coefficients that change from call to call are right ones, too */
    group.refresh_user = &refreshes;
    gproj_system_add_group(s, &group);
    gprojt_add_group(s, "without weight", GPROJ_WISH, 0);
    for (r = 0; r < 200; ++r) {
        gproj_term term[8];
        for (k = 0; k < 8; ++k) term[k] = gprojt_random_term(&seed, 0, 30);
        gproj_system_add_row(s, r % 2, 8, term, gprojt_uniform(&seed), r);
    }
    GPROJT_CHECK(gproj_system_check_gradients(s) < 1e-8);
    GPROJT_CHECK(refreshes == 1);
    gproj_system_set_schedule(s, 0, gproj_keep(0)); /* without weight nothing is refreshed, but the rows are checked */
    GPROJT_CHECK(gproj_system_check_gradients(s) < 1e-8 && refreshes == 1);
    for (r = -1; r < 3; r += 3) {
        gproj_group_info info = gproj_system_group_info(s, r); /* there is no such group */
        GPROJT_CHECK(info.rows == 0 && info.worst_row == -1 && info.worst_element == -1 && info.name[0] == 0);
    }
    gproj_system_destroy(s);
    s = gproj_system_create(NULL);
    GPROJT_CHECK(gproj_system_check_gradients(s) == 0); /* nothing is right */
    gproj_system_destroy(s);
}

/* Rows that overflow cannot be checked, and later rows do not make up for it. */
GPROJT_TEST(gradients_that_overflow) {
    static const double x[2] = {1e200, 1};
    gproj_system *s = gproj_system_create(NULL);
    gproj_term square = gprojt_term(0, 0, 1);
    gproj_system_add_variables(s, 2, 1, x);
    gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
    gproj_system_add_row(s, 0, 1, &square, 0, 0);
    gprojt_add_linear(s, 0, 1, 1, 0, 1);
    GPROJT_CHECK(!(gproj_system_check_gradients(s) < 1e-3));
    gproj_system_destroy(s);
}

/* Rows of a group without weight take no part in steps, also if their values and gradients are infinite. */
GPROJT_TEST(rows_without_weight_may_overflow) {
    const gproj_term sum[2] = {{0, -1, 1}, {1, -1, 1}}, product = {0, 1, 1e308};
    static const double x[2] = {10, 20};
    int32_t global;
    for (global = 0; global < 2; ++global) {
        gproj_system *s = gproj_system_create(NULL);
        gproj_group group;
        memset(&group, 0, sizeof group);
        group.name = "without weight", group.global = global == 1;
        gproj_system_add_variables(s, 2, 1, x);
        gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
        gproj_system_add_group(s, &group);
        gprojt_add_linear(s, 0, 0, 1, -7, 0);
        gprojt_add_linear(s, 0, 1, 1, -8, 1);
        gproj_system_add_row(s, 0, 2, sum, -15, 2);
        gproj_system_add_row(s, 1, 1, &product, 0, 0);
        GPROJT_CHECK(gproj_system_solve(s, 5, NULL).outcome == GPROJ_CONVERGED);
        GPROJT_NEAR(gproj_system_values(s)[0], 7, 1e-9);
        GPROJT_NEAR(gproj_system_values(s)[1], 8, 1e-9);
        gproj_system_destroy(s);
    }
}

/* -- refusals -- */

typedef enum gprojt_call {
    GPROJT_BLOCK_0,
    GPROJT_BLOCK_9,
    GPROJT_NO_MULTIPLE,
    GPROJT_NEGATIVE_COUNT,
    GPROJT_TOO_MANY,
    GPROJT_NAN_VALUE,
    GPROJT_NO_GROUP_GIVEN,
    GPROJT_NO_NAME,
    GPROJT_NEGATIVE_WEIGHT,
    GPROJT_NAN_WEIGHT,
    GPROJT_DECAY_2,
    GPROJT_NEGATIVE_LAST,
    GPROJT_ROW_OF_NO_GROUP,
    GPROJT_NEGATIVE_TERMS,
    GPROJT_TERM_I,
    GPROJT_TERM_J,
    GPROJT_NO_TERMS,
    GPROJT_KIND_9,
    GPROJT_PLACE_99,
    GPROJT_NAN_COEFFICIENT,
    GPROJT_INFINITE_CONSTANT,
    GPROJT_SET_NO_ROW,
    GPROJT_SET_ROW_OF_NO_GROUP,
    GPROJT_WEIGHT_OF_NO_ROW,
    GPROJT_NEGATIVE_ROW_WEIGHT,
    GPROJT_INFINITE_ROW_WEIGHT,
    GPROJT_SCHEDULE_OF_NO_GROUP,
    GPROJT_BAD_SCHEDULE,
    GPROJT_TOO_MUCH_WEIGHT,
    GPROJT_TOO_MUCH_ROW_WEIGHT,
    GPROJT_INFINITE_SCHEDULE,
    GPROJT_ZERO_DECAY,
    GPROJT_ZERO_LAST,
    GPROJT_CALLS
} gprojt_call;

static int64_t gprojt_wrong_group(gproj_system *s, double weight, double decay, int32_t last, const char *name,
                                  bool given) {
    gproj_group group;
    memset(&group, 0, sizeof group);
    group.name = name;
    group.schedule = gprojt_schedule(weight, decay, last);
    return gproj_system_add_group(s, given ? &group : NULL);
}

/* Does what is wrong; the system has 6 variables, group 0 with the row x_0. Calls that return a number return -1. */
static int64_t gprojt_do_wrong(gproj_system *s, gprojt_call call) {
    static const gproj_schedule zero_decay = {1, 0, 5}, zero_last = {1, 1, 0};
    static const double values[3] = {1, NAN, 2};
    gproj_term term = gprojt_term(0, -1, 1);
    gproj_group group;
    memset(&group, 0, sizeof group);
    group.name = "wrong";
    switch (call) {
    case GPROJT_BLOCK_0: return gproj_system_add_variables(s, 6, 0, NULL);
    case GPROJT_BLOCK_9: return gproj_system_add_variables(s, 18, 9, NULL);
    case GPROJT_NO_MULTIPLE: return gproj_system_add_variables(s, 7, 3, NULL);
    case GPROJT_NEGATIVE_COUNT: return gproj_system_add_variables(s, -3, 3, NULL);
    case GPROJT_TOO_MANY: return gproj_system_add_variables(s, INT32_MAX / 2, 1, NULL);
    case GPROJT_NAN_VALUE: return gproj_system_add_variables(s, 3, 3, values);
    case GPROJT_NO_GROUP_GIVEN: return gprojt_wrong_group(s, 1, 0, 0, "", false);
    case GPROJT_NO_NAME: return gprojt_wrong_group(s, 1, 0, 0, NULL, true);
    case GPROJT_NEGATIVE_WEIGHT: return gprojt_wrong_group(s, -1, 0, 0, "wrong", true);
    case GPROJT_NAN_WEIGHT: return gprojt_wrong_group(s, NAN, 0, 0, "wrong", true);
    case GPROJT_DECAY_2: return gprojt_wrong_group(s, 1, 2, 0, "wrong", true);
    case GPROJT_NEGATIVE_LAST: return gprojt_wrong_group(s, 1, 1, -2, "wrong", true);
    case GPROJT_ROW_OF_NO_GROUP: return gproj_system_add_row(s, 1, 1, &term, 0, 0);
    case GPROJT_NEGATIVE_TERMS: return gproj_system_add_row(s, 0, -1, &term, 0, 0);
    case GPROJT_TERM_I: term.i = 6; return gproj_system_add_row(s, 0, 1, &term, 0, 0);
    case GPROJT_TERM_J: term.j = -2; return gproj_system_add_row(s, 0, 1, &term, 0, 0);
    case GPROJT_NO_TERMS: return gproj_system_add_row(s, 0, 1, NULL, 0, 0);
    case GPROJT_KIND_9: group.kind = (gproj_kind)9; return gproj_system_add_group(s, &group);
    case GPROJT_PLACE_99: group.place = (gproj_place)99; return gproj_system_add_group(s, &group);
    case GPROJT_NAN_COEFFICIENT: term.a = NAN; return gproj_system_add_row(s, 0, 1, &term, 0, 0);
    case GPROJT_INFINITE_CONSTANT: return gproj_system_add_row(s, 0, 1, &term, HUGE_VAL, 0);
    case GPROJT_SET_NO_ROW: return -(gproj_system_set_row(s, 0, 1, NULL, 0) == GPROJ_ERROR_INDEX);
    case GPROJT_SET_ROW_OF_NO_GROUP: return -(gproj_system_set_row(s, 3, 0, NULL, 0) == GPROJ_ERROR_INDEX);
    case GPROJT_WEIGHT_OF_NO_ROW: return -(gproj_system_set_row_weight(s, 0, -1, 1) == GPROJ_ERROR_INDEX);
    case GPROJT_NEGATIVE_ROW_WEIGHT: return -(gproj_system_set_row_weight(s, 0, 0, -1) == GPROJ_ERROR_ARGUMENT);
    case GPROJT_INFINITE_ROW_WEIGHT: return -(gproj_system_set_row_weight(s, 0, 0, HUGE_VAL) == GPROJ_ERROR_ARGUMENT);
    case GPROJT_SCHEDULE_OF_NO_GROUP:
        return -(gproj_system_set_schedule(s, 1, gprojt_schedule(1, 1, 0)) == GPROJ_ERROR_INDEX);
    case GPROJT_BAD_SCHEDULE:
        return -(gproj_system_set_schedule(s, 0, gprojt_schedule(1, -1, 0)) == GPROJ_ERROR_ARGUMENT);
    case GPROJT_TOO_MUCH_WEIGHT: return gprojt_wrong_group(s, 1.0000001e50, 0, 0, "wrong", true);
    case GPROJT_TOO_MUCH_ROW_WEIGHT:
        return -(gproj_system_set_row_weight(s, 0, 0, 1.0000001e50) == GPROJ_ERROR_ARGUMENT);
    case GPROJT_ZERO_DECAY: return -(gproj_system_set_schedule(s, 0, zero_decay) == GPROJ_ERROR_ARGUMENT);
    case GPROJT_ZERO_LAST: return -(gproj_system_set_schedule(s, 0, zero_last) == GPROJ_ERROR_ARGUMENT);
    default: return -(gproj_system_set_schedule(s, 0, gprojt_schedule(HUGE_VAL, 1, 0)) == GPROJ_ERROR_ARGUMENT);
    }
}

typedef struct gprojt_refusal {
    gproj_code code;
    gproj_place place;
    int64_t index;
    const char *says; /* a part of the sentence */
} gprojt_refusal;

static const gprojt_refusal gprojt_refusals[GPROJT_CALLS] = {
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "6 variables in blocks of 0"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "blocks of 9"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "7 variables in blocks of 3"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "-3 variables"},
    {GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "more than 1073741823 variables"},
    {GPROJ_ERROR_NUMBER, GPROJ_PLACE_VARIABLE, 7, "variable 7 is not a finite number"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_GROUP, 1, "needs a name"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_GROUP, 1, "needs a name"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "'wrong' (weight -1,"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "'wrong' (weight nan,"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "decay 2"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "last -2"},
    {GPROJ_ERROR_INDEX, GPROJ_PLACE_GROUP, 1, "group 1 of 1 groups"},
    {GPROJ_ERROR_INDEX, GPROJ_PLACE_GROUP, 0, "-1 terms"},
    {GPROJ_ERROR_INDEX, GPROJ_PLACE_ROW, 1, "row 1 of group 'rows', term 0: there is no variable 6"},
    {GPROJ_ERROR_INDEX, GPROJ_PLACE_ROW, 1, "no variable -2"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_ROW, 1, "row 1 of group 'rows' has 1 terms, but no list"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_GROUP, 1, "kind 9 must be"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_GROUP, 1, "place 99 a gproj_place"},
    {GPROJ_ERROR_NUMBER, GPROJ_PLACE_ROW, 1, "row 1 of group 'rows' has a coefficient"},
    {GPROJ_ERROR_NUMBER, GPROJ_PLACE_ROW, 1, "not a finite number"},
    {GPROJ_ERROR_INDEX, GPROJ_PLACE_ROW, 1, "no row 1 in group 0"},
    {GPROJ_ERROR_INDEX, GPROJ_PLACE_ROW, 0, "no row 0 in group 3"},
    {GPROJ_ERROR_INDEX, GPROJ_PLACE_ROW, -1, "no row -1 in group 0"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_ROW, 0, "weight -1 for row 0"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_ROW, 0, "weight inf"},
    {GPROJ_ERROR_INDEX, GPROJ_PLACE_GROUP, 1, "no group 1"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "'rows' (weight 1, decay -1, last -1)"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "needs 0 <= weight <= 1e50"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_ROW, 0, "not in 0..1e50"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "'rows' (weight inf"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "weight 1, decay 0, last 5"},
    {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "gproj_keep, gproj_fade"},
};

static gproj_system *gprojt_small_system(void) {
    static const double x[6] = {1, 2, 3, 4, 5, 6};
    gproj_system *s = gproj_system_create(NULL);
    gproj_system_add_variables(s, 6, 3, x);
    gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1, 0, 0);
    return s;
}

/* After an error every call does nothing, and the first error stays. */
static void gprojt_check_stuck(gproj_system *s) {
    gproj_term term = gprojt_term(0, -1, 1);
    gproj_error before = *gproj_system_error(s);
    gproj_result result;
    double x[6];
    memcpy(x, gproj_system_values(s), sizeof x);
    GPROJT_CHECK(gproj_system_add_variables(s, 3, 3, NULL) == -1);
    GPROJT_CHECK(gprojt_add_group(s, "more", GPROJ_WISH, 1) == -1);
    GPROJT_CHECK(gproj_system_add_row(s, 0, 1, &term, 0, 0) == -1);
    GPROJT_CHECK(gproj_system_set_row(s, 0, 0, NULL, 9) == before.code);
    GPROJT_CHECK(gproj_system_set_row_weight(s, 0, 0, 9) == before.code);
    GPROJT_CHECK(gproj_system_set_schedule(s, 0, gprojt_schedule(9, 1, 0)) == before.code);
    GPROJT_CHECK(gproj_system_check_gradients(s) == HUGE_VAL);
    result = gproj_system_solve(s, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_FAILED && !strcmp(result.message, before.message));
    GPROJT_CHECK(!memcmp(x, gproj_system_values(s), sizeof x));
    GPROJT_CHECK(gproj_system_variable_count(s) == 6 && gproj_system_group_count(s) == 1);
    GPROJT_CHECK(gproj_system_group_info(s, 0).rows == 1 && gproj_system_group_info(s, 0).schedule.weight == 1);
    GPROJT_CHECK(gproj_system_row_value(s, 0, 0, NULL) == 1);
    GPROJT_CHECK(!memcmp(&before, gproj_system_error(s), sizeof before));
}

GPROJT_TEST(refusals) {
    int call;
    for (call = 0; call < GPROJT_CALLS; ++call) {
        gproj_system *s = gprojt_small_system();
        const gproj_error *error = gproj_system_error(s);
        const gprojt_refusal *want = &gprojt_refusals[call];
        GPROJT_CHECK(error->code == GPROJ_OK && error->message[0] == 0);
        GPROJT_CHECK(gprojt_do_wrong(s, (gprojt_call)call) == -1);
        if (error->code != want->code || error->place != want->place || error->index != want->index ||
            !strstr(error->message, want->says)) {
            printf("  refusal %d: code %d place %d index %d \"%s\"\n", call, error->code, error->place,
                   (int)error->index, error->message);
            GPROJT_CHECK(!"code, place and sentence");
        }
        gprojt_check_stuck(s);
        gproj_system_destroy(s);
    }
}

/* A coefficient that is not a number is refused however it comes. */
GPROJT_TEST(refuses_nan_in_set_row) {
    static const double coefficient = NAN;
    gproj_system *s = gprojt_small_system();
    GPROJT_CHECK(gproj_system_set_row(s, 0, 0, NULL, NAN) == GPROJ_ERROR_NUMBER);
    gproj_system_destroy(s);
    s = gprojt_small_system();
    GPROJT_CHECK(gproj_system_set_row(s, 0, 0, &coefficient, 0) == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(gproj_system_error(s)->place == GPROJ_PLACE_ROW && gproj_system_error(s)->index == 0);
    gproj_system_destroy(s);
}

/* Options of a solve that mean nothing: the call fails, says why and does nothing; the system goes on as if it had not
   been. */
GPROJT_TEST(wrong_options_are_of_the_call) {
    static const struct {
        int32_t iterations;
        double tolerance, epsilon, budget;
        const char *says;
    } wrong[10] = {
        {-1, 0, 0, 0, "-1 iterations"},       {INT32_MIN, 0, 0, 0, "-2147483648 iterations"},
        {1, NAN, 0, 0, "tolerance nan"},      {1, -1e-9, 0, 0, "tolerance -1e-09"},
        {1, HUGE_VAL, 0, 0, "tolerance inf"}, {1, 0, -1, 0, "epsilon -1"},
        {1, 0, NAN, 0, "epsilon nan"},        {1, 0, 0, -5, "time budget -5"},
        {1, 0, 0, NAN, "time budget nan"},    {1, 0, 0, 5, "needs a clock in the host"},
    };
    gproj_system *s = gprojt_small_system();
    gproj_result result;
    int i;
    for (i = 0; i < 10; ++i) {
        gproj_solve_options options;
        double x[6];
        memset(&options, 0, sizeof options);
        memcpy(x, gproj_system_values(s), sizeof x);
        options.tolerance = wrong[i].tolerance, options.epsilon = wrong[i].epsilon;
        options.time_budget = wrong[i].budget;
        result = gproj_system_solve(s, wrong[i].iterations, &options);
        if (!strstr(result.message, wrong[i].says)) printf("  %d: %s\n", i, result.message);
        GPROJT_CHECK(strstr(result.message, wrong[i].says) != NULL);
        GPROJT_CHECK(result.outcome == GPROJ_FAILED && result.iterations == 0 && result.worst_group == -1 &&
                     result.worst_element == -1);
        GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK && gproj_system_error(s)->message[0] == 0);
        GPROJT_CHECK(!memcmp(x, gproj_system_values(s), sizeof x));
        GPROJT_CHECK(gprojt_add_linear(s, 0, i % 6, 1, 0, i) == i + 1); /* still open */
        if (i % 3) continue;
        result = gproj_system_solve(s, 9, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gproj_system_error(s)->code == GPROJ_OK);
    }
    gproj_system_destroy(s);
}

/* The largest weight that is allowed, on a group and on a row: no overflow, and the row holds. */
GPROJT_TEST(the_largest_weights) {
    gproj_system *s = gprojt_small_system();
    gproj_result result;
    int i;
    for (i = 0; i < 3; ++i) {
        if (i != 1) GPROJT_CHECK(gproj_system_set_schedule(s, 0, gprojt_schedule(1e50, 0, 0)) == GPROJ_OK);
        if (i >= 1) GPROJT_CHECK(gproj_system_set_row_weight(s, 0, 0, 1e50) == GPROJ_OK);
        gproj_system_values(s)[0] = 7;
        result = gproj_system_solve(s, 20, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gproj_system_error(s)->code == GPROJ_OK);
        GPROJT_NEAR(gproj_system_values(s)[0], 0, 1e-13);
        gproj_system_set_schedule(s, 0, gprojt_schedule(1, 0, 0));
    }
    gproj_system_destroy(s);
}

/* What was told of a group is a copy: it outlives more groups, and the system. */
GPROJT_TEST(group_info_is_a_copy) {
    gproj_system *s = gprojt_small_system();
    gproj_group_info info = gproj_system_group_info(s, 0);
    char name[40] = "changes";
    int i;
    for (i = 0; i < 200; ++i) {
        gprojt_add_group(s, name, GPROJ_WISH, 1);
        name[0] = 'x'; /* copied, too */
    }
    GPROJT_CHECK(!strcmp(gproj_system_group_info(s, 1).name, "changes"));
    GPROJT_CHECK(!strcmp(gproj_system_group_info(s, 2).name, "xhanges"));
    gproj_system_destroy(s);
    GPROJT_CHECK(!strcmp(info.name, "rows") && sizeof info.name == GPROJ_NAME_SIZE);
}

GPROJT_TEST(no_object) {
    gproj_memory memory = gproj_system_memory(NULL);
    GPROJT_CHECK(gproj_system_error(NULL)->code == GPROJ_ERROR_MEMORY && gproj_system_error(NULL)->message[0]);
    GPROJT_CHECK(memory.used == 0 && memory.peak == 0 && memory.allocations == 0);
    GPROJT_CHECK(gproj_system_add_variables(NULL, 3, 3, NULL) == -1);
    GPROJT_CHECK(gproj_system_variable_count(NULL) == 0 && gproj_system_values(NULL) == NULL);
    GPROJT_CHECK(gprojt_add_group(NULL, "none", GPROJ_WISH, 1) == -1 && gproj_system_group_count(NULL) == 0);
    GPROJT_CHECK(gproj_system_group_info(NULL, 0).worst_row == -1);
    GPROJT_CHECK(gproj_system_set_schedule(NULL, 0, gprojt_schedule(1, 1, 1)) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_system_add_row(NULL, 0, 0, NULL, 0, 0) == -1);
    GPROJT_CHECK(gproj_system_set_row(NULL, 0, 0, NULL, 0) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_system_set_row_weight(NULL, 0, 0, 1) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_system_row_value(NULL, 0, 0, NULL) == 0);
    GPROJT_CHECK(gproj_system_check_gradients(NULL) == HUGE_VAL);
    GPROJT_CHECK(gproj_system_solve(NULL, 3, NULL).outcome == GPROJ_FAILED);
    gproj_system_destroy(NULL);
}

/* -- one step against a dense solve -- */

enum {
    GPROJT_ROW_TERMS = 8
};

/* The test's own copy of a system, independent of the library's. */
typedef struct gprojt_twin_row {
    int32_t group, count;
    gproj_term *term;
    double constant, weight;
} gprojt_twin_row;

typedef struct gprojt_twin {
    gproj_system *system;
    int32_t n, rows, groups;
    double *x;
    gprojt_twin_row *row;
    gproj_kind kind[16];
    double weight[16]; /* in the first iteration */
    double residual, merit, energy;
} gprojt_twin;

static void gprojt_twin_variables(gprojt_twin *t, int32_t count, int32_t block, uint64_t *seed) {
    int32_t i;
    t->x = (double *)realloc(t->x, (size_t)(t->n + count + 1) * sizeof(double));
    for (i = 0; i < count; ++i) t->x[t->n + i] = 2 * gprojt_uniform(seed) - 1;
    GPROJT_CHECK(gproj_system_add_variables(t->system, count, block, t->x + t->n) == t->n);
    t->n += count;
}

static void gprojt_twin_group(gprojt_twin *t, gproj_kind kind, bool global, double weight, double decay) {
    gproj_group group;
    memset(&group, 0, sizeof group);
    group.name = "group";
    group.kind = kind;
    group.global = global;
    group.schedule = gprojt_schedule(weight, decay, 0);
    t->kind[t->groups] = kind;
    t->weight[t->groups] = decay > 0 ? weight * decay : weight;
    GPROJT_CHECK(gproj_system_add_group(t->system, &group) == t->groups);
    t->groups++;
}

static void gprojt_twin_add(gprojt_twin *t, int32_t group, int32_t count, const gproj_term *term, double constant,
                            double weight) {
    gprojt_twin_row *row;
    int32_t number;
    t->row = (gprojt_twin_row *)realloc(t->row, (size_t)(t->rows + 1) * sizeof *t->row);
    row = &t->row[t->rows++];
    row->group = group, row->count = count, row->constant = constant, row->weight = weight;
    row->term = (gproj_term *)malloc((size_t)(count + 1) * sizeof *term);
    if (count) memcpy(row->term, term, (size_t)count * sizeof *term);
    number = gproj_system_add_row(t->system, group, count, term, constant, t->rows);
    if (weight != 1) gproj_system_set_row_weight(t->system, group, number, weight);
}

static void gprojt_twin_free(gprojt_twin *t) {
    int32_t r;
    for (r = 0; r < t->rows; ++r) free(t->row[r].term);
    free(t->row);
    free(t->x);
    gproj_system_destroy(t->system);
    memset(t, 0, sizeof *t);
}

static double gprojt_twin_phi(const gprojt_twin_row *row, const double *x, double *gradient) {
    double phi = row->constant;
    int32_t k;
    for (k = 0; k < row->count; ++k) {
        const gproj_term *m = &row->term[k];
        phi += m->a * x[m->i] * (m->j < 0 ? 1 : x[m->j]);
        if (gradient && m->j < 0) gradient[m->i] += m->a;
        if (gradient && m->j >= 0) gradient[m->i] += m->a * x[m->j], gradient[m->j] += m->a * x[m->i];
    }
    return phi;
}

/* Solves M d = b by Cholesky's method, densely, in place. */
static void gprojt_dense_solve(int32_t n, double *m, double *b) {
    int32_t i, j, k;
    for (i = 0; i < n; ++i)
        for (j = 0; j <= i; ++j) {
            double sum = m[i * n + j];
            for (k = 0; k < j; ++k) sum -= m[i * n + k] * m[j * n + k];
            m[i * n + j] = i == j ? sqrt(sum) : sum / m[j * n + j];
        }
    for (i = 0; i < n; ++i) {
        for (k = 0; k < i; ++k) b[i] -= m[i * n + k] * b[k];
        b[i] /= m[i * n + i];
    }
    for (i = n - 1; i >= 0; --i) {
        for (k = i + 1; k < n; ++k) b[i] -= m[k * n + i] * b[k];
        b[i] /= m[i * n + i];
    }
}

/* dx of (sum w^2 g g' + eps^2 I) dx = - sum w^2 phi g; n numbers to be freed. */
static double *gprojt_twin_step(const gprojt_twin *t, double epsilon) {
    size_t n = (size_t)t->n, i, j;
    double *m = (double *)calloc(n * n + 1, sizeof *m), *b = (double *)calloc(n + 1, sizeof *b);
    double *g = (double *)malloc((n + 1) * sizeof *g);
    int32_t r;
    for (i = 0; i < n; ++i) m[i * n + i] = epsilon * epsilon;
    for (r = 0; r < t->rows; ++r) {
        const gprojt_twin_row *row = &t->row[r];
        double w2 = pow(t->weight[row->group] * row->weight, 2), phi;
        memset(g, 0, n * sizeof *g);
        phi = gprojt_twin_phi(row, t->x, g);
        for (i = 0; i < n; ++i) {
            if (g[i] == 0) continue;
            b[i] -= w2 * phi * g[i];
            for (j = 0; j < n; ++j) m[i * n + j] += w2 * g[i] * g[j];
        }
    }
    gprojt_dense_solve(t->n, m, b);
    free(m);
    free(g);
    return b;
}

/* Residual, merit and energy at x. */
static void gprojt_twin_stand(gprojt_twin *t, const double *x) {
    int32_t r;
    t->residual = t->merit = t->energy = 0;
    for (r = 0; r < t->rows; ++r) {
        const gprojt_twin_row *row = &t->row[r];
        double w = t->weight[row->group] * row->weight, phi = fabs(gprojt_twin_phi(row, x, NULL));
        if (!(w > 0)) continue;
        t->merit += w * w * phi * phi;
        if (t->kind[row->group] == GPROJ_WISH)
            t->energy += w * w * phi * phi;
        else
            t->residual = fmax(t->residual, phi);
    }
}

static bool gprojt_note_iteration(void *user, gproj_system *system, const gproj_iteration *iteration) {
    (void)system;
    *(gproj_iteration *)user = *iteration;
    return true;
}

/* One plain step of the library against the dense one, to `bound` of the step. */
static void gprojt_check_step_bound(gprojt_twin *t, double epsilon, double bound) {
    gproj_solve_options options;
    gproj_iteration iteration;
    gproj_result result;
    double *step = gprojt_twin_step(t, epsilon), largest = 0, difference = 0;
    const double *x;
    int32_t i;
    memset(&options, 0, sizeof options);
    memset(&iteration, 0, sizeof iteration);
    options.epsilon = epsilon, options.skip_damping = true, options.tolerance = 1e-300;
    options.on_iteration = gprojt_note_iteration, options.user = &iteration;
    result = gproj_system_solve(t->system, 1, &options);
    x = gproj_system_values(t->system);
    for (i = 0; i < t->n; ++i) {
        largest = fmax(largest, fabs(step[i]));
        difference = fmax(difference, fabs(x[i] - (t->x[i] + step[i])));
    }
    free(step);
    GPROJT_NEAR(difference, 0, bound * fmax(largest, 1e-6));
    if (result.iterations == 0) {
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && largest == 0);
        return;
    }
    gprojt_twin_stand(t, x);
    GPROJT_CHECK(iteration.number == 1 && iteration.factorisations == 1 && iteration.length == 1 &&
                 iteration.epsilon == epsilon);
    GPROJT_NEAR(iteration.step, largest, bound * fmax(largest, 1e-6));
    GPROJT_NEAR(iteration.residual, t->residual, 1e-12 * (1 + t->residual));
    GPROJT_NEAR(iteration.merit, t->merit, 1e-12 * (1 + t->merit));
    GPROJT_NEAR(iteration.energy, t->energy, 1e-12 * (1 + t->energy));
    GPROJT_NEAR(result.residual, t->residual, 1e-12 * (1 + t->residual));
}

static void gprojt_check_step(gprojt_twin *t, double epsilon) { gprojt_check_step_bound(t, epsilon, 1e-9); }

/* Blocks of all sizes, some of whose variables never meet; groups of all kinds; rows over a window of the variables. */
static gprojt_twin gprojt_random_twin(uint64_t *seed) {
    gprojt_twin t;
    int32_t parts = 1 + gprojt_below(seed, 5), groups = 1 + gprojt_below(seed, 5), rows = gprojt_below(seed, 40), r, k;
    static const double row_weights[6] = {1, 1, 1, 0, 0.5, 3};
    memset(&t, 0, sizeof t);
    t.system = gproj_system_create(NULL);
    while (parts-- > 0) {
        int32_t block = 1 + gprojt_below(seed, 8);
        gprojt_twin_variables(&t, block * (1 + gprojt_below(seed, 5)), block, seed);
    }
    for (k = 0; k < groups; ++k)
        gprojt_twin_group(&t, gprojt_below(seed, 3) ? GPROJ_CONSTRAINT : GPROJ_WISH, gprojt_below(seed, 5) == 0,
                          gprojt_below(seed, 6) ? 0.2 + 2 * gprojt_uniform(seed) : 0, gprojt_below(seed, 2) * 0.7);
    for (r = 0; r < rows; ++r) {
        gproj_term term[GPROJT_ROW_TERMS];
        int32_t window = 1 + gprojt_below(seed, 9), first, count = gprojt_below(seed, GPROJT_ROW_TERMS + 1);
        if (window > t.n) window = t.n;
        first = gprojt_below(seed, t.n - window + 1);
        for (k = 0; k < count; ++k) term[k] = gprojt_random_term(seed, first, window);
        gprojt_twin_add(&t, gprojt_below(seed, groups), count, term, 2 * gprojt_uniform(seed) - 1,
                        row_weights[gprojt_below(seed, 6)]);
    }
    return t;
}

GPROJT_TEST(steps_of_random_systems) {
    uint64_t seed = 2014;
    int i;
    for (i = 0; i < 600; ++i) {
        gprojt_twin t = gprojt_random_twin(&seed);
        gprojt_check_step(&t, 0.02 + gprojt_uniform(&seed));
        gprojt_twin_free(&t);
    }
}

/* Stiffer ones, by the error that their condition allows. */
GPROJT_TEST(steps_with_small_epsilon) {
    uint64_t seed = 99;
    int i;
    for (i = 0; i < 100; ++i) {
        gprojt_twin t = gprojt_random_twin(&seed);
        gprojt_check_step_bound(&t, 1e-3, 1e-6);
        gprojt_twin_free(&t);
    }
}

/* A chain of rows over n variables and `wide` rows over all of them: by the group's word, or because they are long. */
static gprojt_twin gprojt_wide_twin(int32_t n, int32_t wide, bool by_word, uint64_t *seed) {
    gprojt_twin t;
    gproj_term *term = (gproj_term *)malloc((size_t)n * sizeof *term);
    int32_t r, k;
    memset(&t, 0, sizeof t);
    t.system = gproj_system_create(NULL);
    gprojt_twin_variables(&t, n, 3, seed);
    gprojt_twin_group(&t, GPROJ_CONSTRAINT, false, 1, 0);
    gprojt_twin_group(&t, GPROJ_CONSTRAINT, by_word, 0.5, 0);
    for (r = 0; r + 4 < n; ++r) {
        for (k = 0; k < 4; ++k) term[k] = gprojt_random_term(seed, r, 5);
        gprojt_twin_add(&t, 0, 4, term, gprojt_uniform(seed), 1);
    }
    for (r = 0; r < wide; ++r) {
        for (k = 0; k < n; ++k)
            term[k] = gprojt_term((k + r) % n, k % 3 == 0 ? (k + 1) % n : -1, 2 * gprojt_uniform(seed) - 1);
        gprojt_twin_add(&t, 1, n, term, gprojt_uniform(seed), r == 3 ? 0 : r == 4 ? 2 : 1);
    }
    free(term);
    return t;
}

GPROJT_TEST(steps_with_wide_rows) {
    uint64_t seed = 3;
    int i;
    for (i = 0; i < 4; ++i) {
        gprojt_twin t = gprojt_wide_twin(i == 0 ? 528 : 60, i == 0 ? 2 : 7 * i - 6, i > 0, &seed);
        GPROJT_CHECK(gproj_system_error(t.system)->code == GPROJ_OK);
        gprojt_check_step(&t, 0.1);
        gprojt_twin_free(&t);
    }
}

/* Narrow and wide rows in one group, in every order: wide ones first, last, side by side, alone between narrow ones. */
GPROJT_TEST(steps_with_wide_rows_among_narrow_ones) {
    static const char *const orders[6] = {"nwn", "wnwwnnw", "nnnww", "wwnnn", "nwnwnwnwn", "wn"};
    uint64_t seed = 17;
    int i, k;
    for (i = 0; i < 12; ++i) {
        const int32_t n = 3 * 180;
        gprojt_twin t;
        gproj_term term[3 * 180];
        const char *order = orders[i / 2];
        memset(&t, 0, sizeof t);
        t.system = gproj_system_create(NULL);
        gprojt_twin_variables(&t, n, 3, &seed);
        gprojt_twin_group(&t, GPROJ_CONSTRAINT, false, 1, 0);
        gprojt_twin_group(&t, GPROJ_WISH, false, 0.4, 0);
        for (; *order; ++order) {
            int32_t rows = *order == 'w' || i % 2 ? 1 : 60, r;
            for (r = 0; r < rows; ++r) {
                int32_t first = gprojt_below(&seed, n - 12), count = *order == 'w' ? 513 + gprojt_below(&seed, 27) : 4;
                for (k = 0; k < count; ++k)
                    term[k] = *order == 'w' ? gprojt_term((first + k) % n, -1, gprojt_uniform(&seed) - 0.5)
                                            : gprojt_random_term(&seed, first, 12);
                gprojt_twin_add(&t, 0, count, term, gprojt_uniform(&seed), 1);
                if (i % 3 == 0) gprojt_twin_add(&t, 1, count, term, gprojt_uniform(&seed), r % 4 ? 1 : 0);
            }
        }
        GPROJT_CHECK(gproj_system_error(t.system)->code == GPROJ_OK && gprojt_info(t.system, 0).rows >= 2);
        gprojt_check_step(&t, 0.1);
        gprojt_twin_free(&t);
    }
}

/* How well one plain step holds its equations, sum w^2 g (phi + g'dx) + eps^2 dx = 0, over their largest term; here
   with long doubles. */
static double gprojt_imbalance(gprojt_twin *t, double epsilon) {
    size_t n = (size_t)t->n, i;
    long double *sum = (long double *)calloc(n + 1, sizeof *sum);
    double *g = (double *)calloc(n + 1, sizeof *g), left = 0, size = 0;
    const double *x = gproj_system_values(t->system);
    gproj_solve_options options;
    int32_t r;
    memset(&options, 0, sizeof options);
    options.epsilon = epsilon, options.skip_damping = true, options.tolerance = 1e-300;
    GPROJT_CHECK(gproj_system_solve(t->system, 1, &options).iterations == 1);
    for (i = 0; i < n; ++i) sum[i] = (long double)epsilon * epsilon * ((long double)x[i] - t->x[i]);
    for (r = 0; r < t->rows; ++r) {
        long double w2 = powl((long double)t->weight[t->row[r].group] * t->row[r].weight, 2), ahead;
        memset(g, 0, n * sizeof *g);
        ahead = gprojt_twin_phi(&t->row[r], t->x, g);
        size = fmax(size, (double)fabsl(w2 * ahead));
        for (i = 0; i < n; ++i) ahead += g[i] * ((long double)x[i] - t->x[i]);
        for (i = 0; i < n; ++i) sum[i] += w2 * ahead * g[i];
    }
    for (i = 0; i < n; ++i) left = fmax(left, (double)fabsl(sum[i]));
    free(g);
    free(sum);
    return left / size;
}

/* Free directions in the narrow rows, where eps^2 alone stands in the matrix, and long rows that pull along them. */
GPROJT_TEST(steps_with_wide_rows_hold_their_equations) {
    static const double epsilons[3] = {1e-3, 1e-4, 1e-5};
    uint64_t seed = 6;
    int i;
    for (i = 0; i < 9; ++i) {
        gprojt_twin t = gprojt_wide_twin(i < 3 ? 600 : 90, i < 3 ? 2 : i - 1, i >= 3, &seed);
        double off = gprojt_imbalance(&t, epsilons[i % 3]);
        if (!(off < 1e-8)) printf("  %d variables, eps %g: %g\n", t.n, epsilons[i % 3], off);
        GPROJT_CHECK(off < 1e-8);
        gprojt_twin_free(&t);
    }
}

/* One step of n variables: 2 (x_i - 1) for even i, and w (sum x_i^2 - n), `copies` times. The matrix is a diagonal and
   a row's square, so the step is known; here with long doubles. Returns its error over the largest. */
static double gprojt_global_step(int32_t n, int32_t copies, double weight, double epsilon, uint64_t seed) {
    gproj_system *s = gproj_system_create(NULL);
    gproj_term *term = (gproj_term *)malloc((size_t)n * sizeof *term);
    double *x = (double *)calloc((size_t)n, sizeof *x), difference = 0, largest = 0;
    long double phi = -n, gdg = 0, gdr = 0, m, s2 = (long double)weight * weight * copies;
    gproj_solve_options options;
    gproj_group group;
    int32_t i;
    memset(&options, 0, sizeof options);
    memset(&group, 0, sizeof group);
    for (i = 0; i < n; ++i) x[i] = 0.5 + gprojt_uniform(&seed), term[i] = gprojt_term(i, i, 1);
    gproj_system_add_variables(s, n, 1, x);
    gprojt_add_group(s, "half", GPROJ_CONSTRAINT, 2);
    group.name = "sphere", group.global = true, group.schedule = gproj_keep(weight);
    gproj_system_add_group(s, &group);
    for (i = 0; i < n; i += 2) gprojt_add_linear(s, 0, i, 1, -1, i);
    for (i = 0; i < copies; ++i) gproj_system_add_row(s, 1, n, term, -n, i);
    for (i = 0; i < n; ++i) {
        long double d = (long double)epsilon * epsilon + (i % 2 ? 0 : 4), g = 2 * (long double)x[i];
        long double r = i % 2 ? 0 : 4 * ((long double)x[i] - 1);
        phi += (long double)x[i] * x[i], gdg += g * g / d, gdr += g * r / d;
    }
    m = (phi - gdr) / (1 + s2 * gdg);
    options.epsilon = epsilon, options.skip_damping = true, options.tolerance = 1e-300;
    GPROJT_CHECK(gproj_system_solve(s, 1, &options).iterations == 1);
    for (i = 0; i < n; ++i) {
        long double d = (long double)epsilon * epsilon + (i % 2 ? 0 : 4), g = 2 * (long double)x[i];
        long double r = i % 2 ? 0 : 4 * ((long double)x[i] - 1), step = -(r + s2 * m * g) / d;
        largest = fmax(largest, (double)fabsl(step));
        difference = fmax(difference, (double)fabsl(gproj_system_values(s)[i] - x[i] - step));
    }
    free(x);
    free(term);
    gproj_system_destroy(s);
    return difference / largest;
}

/* x_i = 0 and one global row, c'x = 1 in variables that follow each other, with `weight`. */
static gproj_system *gprojt_flat_system(int32_t n, const double *c, double weight) {
    gproj_system *s = gproj_system_create(NULL);
    gproj_term *term = (gproj_term *)malloc((size_t)n * sizeof *term);
    gproj_group group;
    int32_t i;
    memset(&group, 0, sizeof group);
    group.name = "plane", group.global = true, group.schedule = gproj_keep(1);
    gproj_system_add_variables(s, n + 1, 1, NULL);
    gprojt_add_group(s, "nought", GPROJ_CONSTRAINT, 1);
    gproj_system_add_group(s, &group);
    for (i = 0; i <= n; ++i) gprojt_add_linear(s, 0, i, 1, 0, i);
    for (i = 0; i < n; ++i) term[i] = gprojt_term(i + 1, -1, c[i]);
    gproj_system_add_row(s, 1, n, term, -1, 0);
    gproj_system_set_row_weight(s, 1, 0, weight);
    free(term);
    return s;
}

/* At the minimum of |x|^2 + w^2 (c'x - 1)^2 stands x = w^2 c / (1 + w^2 c'c). */
static double gprojt_flat_error(gproj_system *s, int32_t n, const double *c, double weight) {
    double w2 = weight * weight, square = 0, error = 0;
    int32_t i;
    for (i = 0; i < n; ++i) square += c[i] * c[i];
    for (i = 0; i < n; ++i) error = fmax(error, fabs(gproj_system_values(s)[i + 1] - w2 * c[i] / (1 + w2 * square)));
    return error;
}

/* Solved as it is, and with other coefficients and weights after a first solve. */
GPROJT_TEST(coefficients_of_global_rows_may_change) {
    enum {
        N = 700
    };
    static const double before[3] = {1, 0, 2}, weights[3] = {1, 0.5, 0};
    double c[N], other[N];
    int32_t i, k, m;
    uint64_t seed = 3;
    for (i = 0; i < N; ++i) c[i] = gprojt_uniform(&seed) - 0.5, other[i] = gprojt_uniform(&seed);
    for (k = 0; k < 3; ++k)
        for (m = 0; m < 3; ++m) {
            gproj_system *s = gprojt_flat_system(N, other, before[k]);
            gproj_system_solve(s, 40, NULL);
            GPROJT_CHECK(gprojt_flat_error(s, N, other, before[k]) < 1e-9);
            gproj_system_set_row_weight(s, 1, 0, 0);
            gproj_system_set_row(s, 1, 0, c, -1);
            gproj_system_solve(s, 2, NULL);
            gproj_system_set_row_weight(s, 1, 0, weights[m]);
            gproj_system_solve(s, 40, NULL);
            GPROJT_CHECK(gprojt_flat_error(s, N, c, weights[m]) < 1e-9);
            GPROJT_CHECK(gproj_system_check_gradients(s) < 1e-8);
            gproj_system_destroy(s);
        }
}

GPROJT_TEST(steps_with_global_rows_are_precise) {
    static const int32_t copies[4] = {1, 2, 3, 8}, sizes[3] = {10, 1000, 10000};
    static const double epsilons[3] = {1e-3, 1e-4, 1e-5}, weights[3] = {0.01, 0.5, 1e3};
    int i, k, e, w;
    for (i = 0; i < 3; ++i)
        for (k = 0; k < 4; ++k)
            for (e = 0; e < 3; ++e)
                for (w = 0; w < 3; ++w) {
                    double off = gprojt_global_step(sizes[i], copies[k], weights[w], epsilons[e], (uint64_t)(5 + i));
                    if (!(off < 1e-8))
                        printf("  %d variables, %d copies of weight %g, eps %g: %g of the step\n", sizes[i], copies[k],
                               weights[w], epsilons[e], off);
                    GPROJT_CHECK(off < 1e-8);
                }
}

/* The sphere in 10000 dimensions is reached to rounding, also when it is asked for three times. */
GPROJT_TEST(a_sphere_of_10000_dimensions) {
    const int32_t n = 10000;
    int copies;
    for (copies = 1; copies <= 3; copies += 2) {
        gproj_system *s = gproj_system_create(NULL);
        gproj_term *term = (gproj_term *)malloc((size_t)n * sizeof *term);
        gproj_solve_options options;
        gproj_result result;
        gproj_group group;
        uint64_t seed = 12;
        double sum = 0;
        int32_t i;
        memset(&options, 0, sizeof options);
        memset(&group, 0, sizeof group);
        group.name = "sphere", group.global = true, group.schedule = gproj_keep(1);
        gproj_system_add_variables(s, n, 1, NULL);
        gproj_system_add_group(s, &group);
        for (i = 0; i < n; ++i) {
            term[i] = gprojt_term(i, i, 1);
            gproj_system_values(s)[i] = 2 * gprojt_uniform(&seed);
        }
        for (i = 0; i < copies; ++i) gproj_system_add_row(s, 0, n, term, -n, i);
        options.tolerance = 1e-9; /* the sum of 10000 numbers has an error of about 1e-11 */
        result = gproj_system_solve(s, 12, &options);
        for (i = 0; i < n; ++i) sum += gproj_system_values(s)[i] * gproj_system_values(s)[i];
        if (result.outcome != GPROJ_CONVERGED) printf("  %d copies: %s\n", copies, result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 6 && result.damped == 0);
        GPROJT_NEAR(sum, n, 1e-8);
        free(term);
        gproj_system_destroy(s);
    }
}

GPROJT_TEST(wide_rows_stay_out_of_the_matrix) {
    uint64_t seed = 3;
    gprojt_twin t = gprojt_wide_twin(600, 3, false, &seed); /* 600 variables: by their length */
    gproj_cholesky_info info;
    gprojt_check_step_bound(&t, 1e-3, 1e-7);
    info = gprojt_inside_factor(t.system);
    GPROJT_CHECK(info.columns == 600 && info.factor_entries < 600 * 40);
    gprojt_twin_free(&t);
}

/* Points along a chain, whose coordinates have rows of their own: the matrix is three bands. A row at each point with all of its
   coordinates makes one band of blocks. A column of L has one entry below the diagonal, or the rest of its block and the next. */
GPROJT_TEST(coordinates_without_a_common_row_are_apart) {
    enum {
        POINTS = 30
    };
    int32_t i, k, common;
    for (common = 0; common < 2; ++common) {
        gproj_system *s = gproj_system_create(NULL);
        gproj_system_add_variables(s, 3 * POINTS, 3, NULL);
        gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
        for (i = 0; i < 3 * POINTS; ++i) {
            gproj_term term[3] = {{i, -1, 1}, {i + 3, -1, -1}};
            gprojt_add_linear(s, 0, i, 1, -1, i);
            if (i + 3 < 3 * POINTS) gproj_system_add_row(s, 0, 2, term, 0, i);
            for (k = 0; k < 3; ++k) term[k] = gprojt_term(i + k, -1, 1);
            if (common && i % 3 == 0) gproj_system_add_row(s, 0, 3, term, -3, i);
        }
        GPROJT_CHECK(gproj_system_solve(s, 5, NULL).outcome == GPROJ_CONVERGED);
        for (i = 0; i < 3 * POINTS; ++i) GPROJT_NEAR(gproj_system_values(s)[i], 1, 1e-9);
        GPROJT_CHECK(gprojt_inside_factor(s).exact_entries ==
                     (common ? 6 * POINTS + 9 * (POINTS - 1) : 3 * (POINTS + POINTS - 1)));
        gproj_system_destroy(s);
    }
}

/* Nothing but wide rows: the matrix is eps^2 I. */
GPROJT_TEST(steps_with_wide_rows_only) {
    uint64_t seed = 8;
    gprojt_twin t;
    gproj_term term[12];
    int32_t r, k;
    memset(&t, 0, sizeof t);
    t.system = gproj_system_create(NULL);
    gprojt_twin_variables(&t, 12, 4, &seed);
    gprojt_twin_group(&t, GPROJ_CONSTRAINT, true, 1, 0);
    for (r = 0; r < 5; ++r) {
        for (k = 0; k < 12; ++k) term[k] = gprojt_term(k, -1, gprojt_uniform(&seed));
        gprojt_twin_add(&t, 0, 12, term, 1, 1);
    }
    gprojt_check_step(&t, 0.05);
    gprojt_twin_free(&t);
}

GPROJT_TEST(empty_systems) {
    static const double x[2] = {3, 4}, large = 1e200;
    gproj_system *s = gproj_system_create(NULL);
    gproj_result result = gproj_system_solve(s, 5, NULL); /* no variables, no rows */
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.worst_group == -1 && result.iterations == 0);
    GPROJT_CHECK(gproj_system_add_variables(s, 0, 3, NULL) == 0);
    gprojt_add_group(s, "constant", GPROJ_CONSTRAINT, 1); /* no variables, a row without terms that cannot hold */
    gproj_system_add_row(s, 0, 0, NULL, 2, 7);
    GPROJT_CHECK(s->group[0].term && s->group[0].local.variable); /* nothing is added to NULL */
    result = gproj_system_solve(s, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED || result.outcome == GPROJ_ITERATION_LIMIT);
    GPROJT_CHECK(result.residual == 2 && result.worst_group == 0 && result.worst_element == 7);
    gproj_system_set_row(s, 0, 0, NULL, large); /* whose square is no number, so that there is no step either */
    result = gproj_system_solve(s, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED && result.residual == large && result.iterations == 0);
    gproj_system_destroy(s);
    s = gproj_system_create(NULL); /* variables in no row stay where they are */
    gproj_system_add_variables(s, 2, 1, x);
    result = gproj_system_solve(s, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    gprojt_add_group(s, "x", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1, -1, 0);
    result = gproj_system_solve(s, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations > 0);
    GPROJT_NEAR(gproj_system_values(s)[0], 1, 1e-13);
    GPROJT_CHECK(gproj_system_values(s)[1] == 4);
    gproj_system_destroy(s);
}

/* Rows, groups and variables added between solves are seen by the next one. */
GPROJT_TEST(grows_between_solves) {
    uint64_t seed = 21;
    int i;
    gprojt_twin t = gprojt_random_twin(&seed);
    for (i = 0; i < 12; ++i) {
        gproj_term term[3];
        int32_t k;
        gprojt_check_step(&t, 0.3);
        memcpy(t.x, gproj_system_values(t.system), (size_t)t.n * sizeof *t.x);
        if (i % 3 == 0) gprojt_twin_variables(&t, 4, 2, &seed);
        if (i % 4 == 1) gprojt_twin_group(&t, GPROJ_CONSTRAINT, i % 8 == 1, 1, 0);
        for (k = 0; k < 3; ++k) term[k] = gprojt_random_term(&seed, 0, t.n);
        if (i % 3 != 1) gprojt_twin_add(&t, t.groups - 1, 3, term, 0.5, 1);
    }
    gprojt_check_step(&t, 0.3);
    gprojt_twin_free(&t);
}

/* Rows as builders place them, before a solve and after it: rows with a like one's terms share them, others do not. x_i - x_j
   = 1 along a chain, and twice that where rows are not like the first. */
static void gprojt_place_chain(gproj_system *s, int32_t first, int32_t last) {
    static const gproj_term one[2] = {{0, -1, -1}, {1, -1, 1}}, two[2] = {{0, -1, -2}, {1, -1, 2}};
    int32_t i;
    for (i = first; i < last; ++i) {
        int32_t *local = gproji_add_placed_rows(s, 0, 0, 1, 2, i % 3 == 2 ? two : one, 2, i % 3 == 2 ? -2 : -1, i);
        if (!local) return;
        local[i % 2] = i, local[1 - i % 2] = i + 1; /* in both orders */
    }
}

static bool gprojt_use_placed_rows(const gproj_host *host, void *user) {
    static const double half[2] = {-0.5, 0.5};
    gproj_system *s = gproj_system_create(host);
    bool right;
    int32_t i;
    (void)user;
    if (!s) return false;
    gproj_system_add_variables(s, 20, 1, NULL);
    gprojt_add_group(s, "chain", GPROJ_CONSTRAINT, 1);
    gprojt_place_chain(s, 0, 9);
    gproj_system_solve(s, 5, NULL);
    gprojt_place_chain(s, 9, 19);
    gproj_system_add_row(s, 0, 0, NULL, 0, 0);
    gproj_system_set_row(s, 0, 4, half, -0.5); /* the same equation, in terms of its own */
    right = gproj_system_solve(s, 5, NULL).outcome == GPROJ_CONVERGED;
    for (i = 0; right && i < 19; ++i) {
        const double *x = gproj_system_values(s);
        GPROJT_NEAR(x[i + 1] - x[i], i % 2 ? -1 : 1, 1e-12);
    }
    GPROJT_CHECK(right || gproj_system_error(s)->code == GPROJ_ERROR_MEMORY);
    gproj_system_destroy(s);
    return right;
}

GPROJT_TEST(placed_rows) {
    GPROJT_CHECK(gprojt_use_placed_rows(NULL, NULL));
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_placed_rows, NULL) >= 20);
}

/* Rows of two variables that share their terms still do when they are sorted by the order of elimination: those that are sorted
   already have these terms, all others the same copy. Neither depends on an order before: rows with one variable and all others
   make that the last one. */
GPROJT_TEST(sorted_rows_share_terms) {
    static const gproj_term two[2] = {{0, -1, -1}, {1, -1, 1}};
    int32_t hub, i, way;
    for (hub = 0; hub < 20; ++hub) {
        gproj_system *s = gproj_system_create(NULL);
        gproj_system_add_variables(s, 20, 1, NULL);
        gprojt_add_group(s, "chain", GPROJ_CONSTRAINT, 1);
        gprojt_add_group(s, "others", GPROJ_CONSTRAINT, 1);
        gprojt_add_linear(s, 1, 0, 1, -5, 0);
        for (i = 0; i < 19; ++i)
            for (way = 0; way < 2; ++way) { /* each difference from both ends */
                int32_t *local = gproji_add_placed_rows(s, 0, 0, 1, 2, two, 2, way ? 1 : -1, i);
                GPROJT_REQUIRE(local);
                local[way] = i, local[1 - way] = i + 1;
            }
        for (way = 0; way < 2; ++way) {
            for (i = 0; i < 20; ++i) gproj_system_values(s)[i] = 0;
            GPROJT_CHECK(gproj_system_solve(s, 20, NULL).outcome == GPROJ_CONVERGED && !s->schur.on);
            for (i = 0; i < 20; ++i) GPROJT_NEAR(gproj_system_values(s)[i], 5 + i, 1e-9);
            GPROJT_CHECK(s->group[0].term_count == 4);
            for (i = 0; way == 0 && i < 20; ++i) {
                const gproj_term term[2] = {{hub, -1, 1}, {i, -1, -1}};
                gproj_system_add_row(s, 1, 2, term, i - hub, i);
            }
        }
        gproj_system_destroy(s);
    }
}

/* -- memory -- */

/* Every way of taking memory; true when nothing failed. */
static bool gprojt_use_system(const gproj_host *host, void *user) {
    gproj_system *s = gproj_system_create(host);
    gproj_result result;
    gproj_group group;
    uint64_t seed = 5;
    bool right;
    int32_t i, k, row;
    (void)user;
    if (!s) return false;
    memset(&group, 0, sizeof group);
    group.name = "global", group.global = true, group.schedule = gproj_keep(1);
    gproj_system_add_variables(s, 24, 3, NULL);
    for (i = 0; i < 24 && gproj_system_values(s); ++i) gproj_system_values(s)[i] = gprojt_uniform(&seed);
    gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
    gproj_system_add_group(s, &group);
    for (i = 0; i + 6 <= 24; i += 3) gprojt_add_distance(s, 0, i, i + 3, 3, 1, i);
    for (i = 0; i < 2; ++i) {
        gproj_term term[24];
        for (k = 0; k < 24; ++k) term[k] = gprojt_term(k, -1, gprojt_uniform(&seed));
        row = gproj_system_add_row(s, 1, 24, term, -1, i);
        GPROJT_CHECK(row == (gproj_system_error(s)->code ? -1 : i));
    }
    gproj_system_check_gradients(s);
    result = gproj_system_solve(s, 20, NULL);
    right = gproj_system_error(s)->code == GPROJ_OK;
    GPROJT_CHECK(right == (result.outcome != GPROJ_FAILED));
    GPROJT_CHECK(right || gproj_system_error(s)->code == GPROJ_ERROR_MEMORY);
    GPROJT_CHECK(!right || result.outcome == GPROJ_CONVERGED);
    gproj_system_destroy(s);
    return right;
}

GPROJT_TEST(every_allocation_fails_once) { GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_system, NULL) >= 20); }

GPROJT_TEST(memory_is_accounted_and_limited) {
    gprojt_failing failing;
    gproj_host host;
    gproj_system *s;
    memset(&failing, 0, sizeof failing);
    host = gprojt_failing_host(&failing);
    s = gproj_system_create(&host);
    gproj_system_add_variables(s, 300, 3, NULL);
    gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, 0, 0, 1, -1, 0);
    gproj_system_solve(s, 3, NULL);
    GPROJT_CHECK(gproj_system_memory(s).used == failing.bytes);
    GPROJT_CHECK(gproj_system_memory(s).peak >= failing.bytes);
    GPROJT_CHECK(gproj_system_memory(s).allocations == (uint64_t)failing.calls);
    gproj_system_destroy(s);
    GPROJT_CHECK(failing.held == 0);
    host.allocator.limit = 20000;
    s = gproj_system_create(&host);
    GPROJT_REQUIRE(s != NULL);
    GPROJT_CHECK(gproj_system_add_variables(s, 30000, 3, NULL) == -1);
    GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_ERROR_MEMORY);
    gproj_system_destroy(s);
    GPROJT_CHECK(failing.held == 0);
}

/* A row takes room for the variables that it names, each once: two numbers are 8 bytes, 1001 are 4 KB. */
GPROJT_TEST(room_for_named_variables) {
    enum {
        TERMS = 1000
    };
    gproj_term terms[TERMS];
    size_t used[2];
    int32_t k, t;
    for (k = 0; k < 2; ++k) {
        gproj_system *s = gproj_system_create(NULL);
        gproj_system_add_variables(s, TERMS + 1, 1, NULL);
        gprojt_add_group(s, "products", GPROJ_CONSTRAINT, 1);
        for (t = 0; t < TERMS; ++t) terms[t] = gprojt_term(k * t, k * t + 1, 1);
        GPROJT_CHECK(gproj_system_add_row(s, 0, TERMS, terms, 0, 0) == 0);
        used[k] = gproj_system_memory(s).used;
        gproj_system_destroy(s);
    }
    GPROJT_CHECK(used[0] + (TERMS - 10) * sizeof(int32_t) <= used[1]);
}

int main(void) {
    GPROJT_RUN(values_and_gradients_by_hand);
    GPROJT_RUN(values_of_large_terms_that_cancel);
    GPROJT_RUN(rows_and_weights_are_replaced);
    GPROJT_RUN(group_info);
    GPROJT_RUN(gradients_by_finite_differences);
    GPROJT_RUN(gradients_that_overflow);
    GPROJT_RUN(rows_without_weight_may_overflow);
    GPROJT_RUN(refusals);
    GPROJT_RUN(refuses_nan_in_set_row);
    GPROJT_RUN(wrong_options_are_of_the_call);
    GPROJT_RUN(the_largest_weights);
    GPROJT_RUN(group_info_is_a_copy);
    GPROJT_RUN(no_object);
    GPROJT_RUN(steps_of_random_systems);
    GPROJT_RUN(steps_with_small_epsilon);
    GPROJT_RUN(steps_with_wide_rows);
    GPROJT_RUN(steps_with_wide_rows_among_narrow_ones);
    GPROJT_RUN(steps_with_wide_rows_hold_their_equations);
    GPROJT_RUN(coefficients_of_global_rows_may_change);
    GPROJT_RUN(steps_with_global_rows_are_precise);
    GPROJT_RUN(a_sphere_of_10000_dimensions);
    GPROJT_RUN(wide_rows_stay_out_of_the_matrix);
    GPROJT_RUN(coordinates_without_a_common_row_are_apart);
    GPROJT_RUN(steps_with_wide_rows_only);
    GPROJT_RUN(empty_systems);
    GPROJT_RUN(grows_between_solves);
    GPROJT_RUN(placed_rows);
    GPROJT_RUN(sorted_rows_share_terms);
    GPROJT_RUN(every_allocation_fails_once);
    GPROJT_RUN(memory_is_accounted_and_limited);
    GPROJT_RUN(room_for_named_variables);
    return gprojt_report();
}
