/* test_rows.c - >>catalogue: rows and unknowns of the caller's, residuals by element, edge midpoints on a sphere. */
#include "gprojt_design.h"
#include "gprojt_form.h"
#include "gprojt_inside.h"

/* A bumpy cap, moved and scaled: position = shift + size * p. */
static gproj_mesh *gprojt_cap(int32_t n, double size, const double shift[3]) {
    gproj_mesh *mesh = gprojt_roof(n, 0.02);
    int32_t i;
    for (i = 0; i < 3 * mesh->vertex_count; ++i) mesh->position[i] = shift[i % 3] + size * mesh->position[i];
    return mesh;
}

/* The row (|v - c|^2 - r^2) / (2 radius), c and r being three unknowns and one; or with r < 0 the number `radius`. */
static int32_t gprojt_add_ball_row(gproj_form *form, int32_t group, int32_t vertex, int32_t c, int32_t r,
                                   double radius) {
    gproj_term term[10];
    double half = 0.5 / radius;
    int32_t k;
    for (k = 0; k < 3; ++k) {
        term[3 * k] = gprojt_term(3 * vertex + k, 3 * vertex + k, half);
        term[3 * k + 1] = gprojt_term(3 * vertex + k, c + k, -2 * half);
        term[3 * k + 2] = gprojt_term(c + k, c + k, half);
    }
    term[9] = gprojt_term(r, r, -half);
    return gproj_form_add_row(form, group, r < 0 ? 9 : 10, term, r < 0 ? -radius * half * radius : 0, vertex);
}

/* All vertices on one sphere with unknown centre and radius. Returns the group; *first: the unknowns. */
static int32_t gprojt_add_ball(gproj_form *form, const gproj_mesh *mesh, double size, const double shift[3],
                               gproj_start start, void *user, int32_t *first) {
    int32_t group = gproj_add_rows(form, "ball", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1), v, r;
    double centre[3] = {0, 0, -5}, radius = 8 * size;
    int32_t k;
    for (k = 0; k < 3; ++k) centre[k] = shift[k] + size * centre[k];
    *first = gproj_form_add_unknowns(form, group, GPROJ_UNIT_POINT, 3, centre, start, user);
    r = gproj_form_add_unknowns(form, group, GPROJ_UNIT_LENGTH, 1, &radius, NULL, NULL);
    for (v = 0; v < mesh->vertex_count; ++v)
        GPROJT_CHECK(gprojt_add_ball_row(form, group, v, *first, r, 8 * size) == v);
    return group;
}

/* The largest distance of a vertex from the sphere, in the mesh's units. */
static double gprojt_off_ball(const gproj_mesh *mesh, const double ball[4]) {
    double worst = 0;
    int32_t v;
    for (v = 0; v < mesh->vertex_count; ++v)
        worst = fmax(worst, fabs(gprojt_far(mesh->position + 3 * v, ball) - ball[3]));
    return worst;
}

GPROJT_TEST(a_ball_in_any_units) {
    static const double sizes[] = {1, 1000, 1e-3}, shifts[][3] = {{0, 0, 0}, {7e3, -2e3, 50}, {1, 2, 3}};
    double first[4] = {0, 0, 0, 0};
    int32_t i, k, at;
    for (i = 0; i < 3; ++i) {
        gproj_mesh *mesh = gprojt_cap(6, sizes[i], shifts[i]);
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t group = gprojt_add_ball(form, mesh, sizes[i], shifts[i], NULL, NULL, &at);
        double ball[4], unit = gproj_mesh_mean_edge_length(mesh);
        gproj_result result;
        /* The third mesh is 3,000 sizes away from the origin: terms of its rows cancel, and differences show that. */
        GPROJT_CHECK(group >= 0);
        GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < (i < 2 ? 1e-9 : 1e-7));
        result = gproj_solve(form, 25, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_CHECK(gproj_form_get_unknowns(form, at, 4, ball, NULL) == GPROJ_OK);
        GPROJT_CHECK(gprojt_off_ball(mesh, ball) < 1e-9 * unit);
        /* The same ball in all units. */
        for (k = 0; k < 3; ++k) ball[k] = (ball[k] - shifts[i][k]) / sizes[i];
        ball[3] /= sizes[i];
        for (k = 0; k < 4; ++k) {
            if (i > 0) GPROJT_NEAR(ball[k], first[k], 1e-7);
            first[k] = ball[k];
        }
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* A height of 5 is 5 in the mesh's units, whatever the form does inside; so is a fixed radius. */
GPROJT_TEST(numbers_are_in_the_units_of_the_mesh) {
    static const double shift[3] = {100, 200, 4};
    gproj_mesh *mesh = gprojt_cap(5, 3, shift);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t group = gproj_add_rows(form, "height 5", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1), v;
    int32_t other = gproj_add_rows(form, "distance", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1);
    for (v = 0; v < mesh->vertex_count; v += 2) {
        gproj_term z = gprojt_term(3 * v + 2, -1, 1);
        GPROJT_CHECK(gproj_form_add_row(form, group, 1, &z, -5, v) == v / 2);
    }
    { /* vertex 1 is 2.5 away from the point (101, 201, 5) */
        static const double p[3] = {101, 201, 5};
        gproj_term term[6];
        double constant = -2.5 * 2.5;
        int32_t k;
        for (k = 0; k < 3; ++k) {
            term[2 * k] = gprojt_term(3 + k, 3 + k, 1 / 5.0);
            term[2 * k + 1] = gprojt_term(3 + k, -1, -2 * p[k] / 5);
            constant += p[k] * p[k];
        }
        gproj_form_add_row(form, other, 6, term, constant / 5, 1);
        GPROJT_CHECK(gproj_solve(form, 25, NULL).outcome == GPROJ_CONVERGED);
        GPROJT_NEAR(gprojt_far(mesh->position + 3, p), 2.5, 1e-10);
    }
    for (v = 0; v < mesh->vertex_count; v += 2) GPROJT_NEAR(mesh->position[3 * v + 2], 5, 1e-11);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A product of a coordinate far from the origin and an unknown that is no length. */
GPROJT_TEST(products_of_units) {
    static const double shift[3] = {100, 200, 4}, start = 3;
    gproj_mesh *mesh = gprojt_cap(5, 3, shift);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t group = gproj_add_rows(form, "product", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1), u;
    gproj_term product;
    double factor;
    u = gproj_form_add_unknowns(form, group, GPROJ_UNIT_NUMBER, 1, &start, NULL, NULL);
    product = gprojt_term(0, u, 1);
    gproj_form_add_row(form, group, 1, &product, -330, 0); /* x_0 u = 330 */
    product = gprojt_term(u, 3, 1);
    gproj_form_add_row(form, group, 1, &product, -333, 1); /* u x_1 = 333 */
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_form_get_unknowns(form, u, 1, &factor, NULL) == GPROJ_OK);
    GPROJT_NEAR(mesh->position[0] * factor, 330, 1e-9);
    GPROJT_NEAR(mesh->position[3] * factor, 333, 1e-9);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

typedef struct gprojt_starts {
    int32_t calls;
    bool bad;
} gprojt_starts;

static void gprojt_start_ball(void *user, const gproj_mesh *mesh, int32_t first, int32_t count, double *values) {
    gprojt_starts *starts = (gprojt_starts *)user;
    GPROJT_CHECK(first >= 3 * mesh->vertex_count && count == 3);
    starts->calls++;
    values[2] = starts->bad ? NAN : -5.25;
}

/* A solve does not depend on those before it: unknowns begin where they should. */
GPROJT_TEST(unknowns_start_anew) {
    static const double none[3] = {0, 0, 0};
    gproj_mesh *mesh = gprojt_cap(5, 1, none);
    size_t bytes = 3 * (size_t)mesh->vertex_count * sizeof(double);
    double *begin = (double *)malloc(bytes), *end = (double *)malloc(bytes), ball[2][4];
    gproj_form *form = gproj_form_create(mesh, NULL);
    gprojt_starts starts = {0, false};
    int32_t at, round;
    memcpy(begin, mesh->position, bytes);
    gprojt_add_ball(form, mesh, 1, none, gprojt_start_ball, &starts, &at);
    GPROJT_CHECK(starts.calls > 0);
    for (round = 0; round < 2; ++round) {
        int32_t calls = starts.calls;
        memcpy(mesh->position, begin, bytes);
        GPROJT_CHECK(gproj_solve(form, 25, NULL).outcome == GPROJ_CONVERGED && starts.calls == calls + 1);
        gproj_form_get_unknowns(form, at, 4, ball[round], NULL);
        if (round == 0) memcpy(end, mesh->position, bytes);
    }
    GPROJT_CHECK(memcmp(end, mesh->position, bytes) == 0 && memcmp(ball[0], ball[1], sizeof ball[0]) == 0);
    starts.bad = true;
    GPROJT_CHECK(gproj_solve(form, 25, NULL).outcome == GPROJ_FAILED);
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_ERROR_NUMBER && gproj_form_error(form)->index == at + 2);
    GPROJT_CHECK(strstr(gproj_form_error(form)->message, "ball") != NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(begin);
    free(end);
}

typedef struct gprojt_meddler {
    gproj_form *form;
    int32_t group, what;
    bool on;
} gprojt_meddler;

static void gprojt_meddle(void *user, const gproj_mesh *mesh, int32_t first, int32_t count, double *values) {
    const gprojt_meddler *m = (const gprojt_meddler *)user;
    gproj_term z = gprojt_term(2, -1, 1);
    (void)mesh, (void)first, (void)count;
    if (!m->on) return;
    if (m->what == 0) GPROJT_CHECK(gproj_solve(m->form, 3, NULL).outcome == GPROJ_FAILED);
    if (m->what == 1)
        GPROJT_CHECK(gproj_form_add_unknowns(m->form, m->group, GPROJ_UNIT_LENGTH, 1, values, NULL, NULL) == -1);
    if (m->what == 2) GPROJT_CHECK(gproj_form_add_row(m->form, m->group, 1, &z, 0, 0) == -1);
}

/* A callback that changes the form, or solves it, is refused. */
GPROJT_TEST(meddling_start_values) {
    static const double none[3] = {0, 0, 0}, one = 1;
    int32_t what;
    for (what = 0; what < 3; ++what) {
        gproj_mesh *mesh = gprojt_cap(3, 1, none);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gprojt_meddler m = {form, 0, what, false};
        double worst[64];
        m.group = gproj_add_rows(form, "mine", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1);
        gproj_form_add_unknowns(form, m.group, GPROJ_UNIT_LENGTH, 1, &one, gprojt_meddle, &m);
        GPROJT_CHECK(gproj_form_residuals(form, m.group, worst, NULL) == GPROJ_ERROR_STATE);
        m.on = true;
        GPROJT_CHECK(gproj_solve(form, 3, NULL).outcome == GPROJ_FAILED);
        GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_ERROR_STATE);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* States keep unknowns, and drags hold rows of one's own. */
GPROJT_TEST(states_and_drags_know_unknowns) {
    static const double none[3] = {0, 0, 0};
    gproj_mesh *mesh = gprojt_cap(5, 1, none);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t at, vertex = gprojt_middle(mesh);
    double solved[4], ball[4], position[3];
    gproj_handles handles = gprojt_vertex_handles(1, &vertex);
    gproj_drag *drag;
    uint8_t *state;
    size_t size;
    gprojt_add_ball(form, mesh, 1, none, NULL, NULL, &at);
    gproj_solve(form, 25, NULL);
    gproj_form_get_unknowns(form, at, 4, solved, NULL);
    state = gprojt_save(form, &size);
    mesh->position[2] += 0.3;
    gproj_solve(form, 25, NULL);
    GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
    gproj_form_get_unknowns(form, at, 4, ball, NULL);
    GPROJT_CHECK(memcmp(ball, solved, sizeof ball) == 0 && gprojt_off_ball(mesh, ball) < 1e-9);
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    GPROJT_REQUIRE(drag != NULL);
    memcpy(position, mesh->position + 3 * vertex, sizeof position);
    position[2] += 0.05;
    GPROJT_CHECK(gproj_drag_move(drag, position) == GPROJ_OK);
    GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
    gproj_form_get_unknowns(form, at, 4, ball, NULL);
    GPROJT_CHECK(gprojt_off_ball(mesh, ball) < 1e-9);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(state);
}

/* Residuals by element are those that the rows have. */
GPROJT_TEST(residuals_by_element) {
    static const double shift[3] = {10, 20, 30};
    gproj_mesh *mesh = gprojt_cap(5, 2, shift);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_solve_options options;
    double *vertex = (double *)calloc((size_t)mesh->vertex_count, sizeof(double));
    double *face = (double *)calloc((size_t)mesh->face_count, sizeof(double)), worst = 0, ball[4], unit;
    int32_t at, group = gprojt_add_ball(form, mesh, 2, shift, NULL, NULL, &at), i, planar;
    planar = gproj_add_planarity(form, 1);
    memset(&options, 0, sizeof options);
    options.skip_closeness = true;
    gproj_solve(form, 1, &options);
    unit = 1 / gprojt_unit(form);
    gproj_form_get_unknowns(form, at, 4, ball, NULL);
    GPROJT_CHECK(gproj_form_residuals(form, group, vertex, NULL) == GPROJ_OK);
    for (i = 0; i < mesh->vertex_count; ++i) {
        double far = gprojt_far(mesh->position + 3 * i, ball), phi = fabs(far * far - ball[3] * ball[3]) / 32;
        GPROJT_NEAR(vertex[i], phi * unit, 1e-9);
        worst = fmax(worst, vertex[i]);
    }
    GPROJT_NEAR(worst, gproj_form_group_info(form, group).max, 1e-15);
    GPROJT_CHECK(gproj_form_residuals(form, planar, face, NULL) == GPROJ_OK);
    for (worst = 0, i = 0; i < mesh->face_count; ++i) worst = fmax(worst, face[i]);
    GPROJT_CHECK(worst == gproj_form_group_info(form, planar).max && worst > 0);
    GPROJT_CHECK(gproj_form_residuals(form, 99, face, NULL) == GPROJ_ERROR_INDEX);
    GPROJT_CHECK(gproj_form_residuals(form, -1, face, NULL) == GPROJ_ERROR_INDEX);
    GPROJT_CHECK(gproj_form_residuals(NULL, 0, face, NULL) == GPROJ_ERROR_ARGUMENT);
    {
        gproj_error error;
        double kept = ball[0];
        group = gproj_add_rows(form, "of all", GPROJ_WISH, GPROJ_PLACE_NONE, 1);
        GPROJT_CHECK(gproj_form_residuals(form, planar, face, &error) == GPROJ_ERROR_STATE); /* something was added */
        GPROJT_CHECK(gproj_form_residuals(form, group, face, &error) == GPROJ_ERROR_ARGUMENT && error.message[0]);
        GPROJT_CHECK(gproj_form_get_unknowns(form, at + 3, 2, ball, &error) == GPROJ_ERROR_INDEX && ball[0] == kept);
    }
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(vertex);
    free(face);
}

/* Rows of no element, rows without weight and rows beyond all numbers, where residuals are asked for and weights given. The
   system takes any number for an element; those that the mesh does not have are none of its elements. */
GPROJT_TEST(residuals_by_edge) {
    static const double p[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, wanted[3] = {1, 2, 0.5};
    static const int32_t degree = 4, corner[4] = {0, 1, 2, 3};
    gproj_mesh *mesh = gproj_mesh_create(4, p, 1, &degree, corner, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t group = gproj_add_lengths(form, 3, NULL, wanted, 1);
    double edge[4] = {9, 9, 9, 9};
    gproj_solve(form, 0, NULL);
    GPROJT_CHECK(gproj_form_residuals(form, group, edge, NULL) == GPROJ_OK);
    GPROJT_CHECK(fabs(edge[0]) < 1e-15 && edge[3] == 0); /* (l^2 - d^2) / (2 d), and no row */
    GPROJT_NEAR(edge[1], 0.75, 1e-15);
    GPROJT_NEAR(edge[2], 0.75, 1e-15);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(rows_of_no_element) {
    static const double none[3] = {0, 0, 0};
    static const int32_t elements[] = {-1, 1000000, 2, 3, 5};
    gproj_mesh *mesh = gprojt_cap(4, 1, none);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_system *system = gproj_form_system(form);
    gproj_solve_options options;
    double *vertex = (double *)calloc((size_t)mesh->vertex_count, sizeof(double)), weight[2] = {0, 3};
    gproj_group heights;
    int32_t group, k, some[2] = {3, 2};
    memset(&heights, 0, sizeof heights);
    heights.name = "heights", heights.place = GPROJ_PLACE_VERTEX, heights.schedule = gproj_keep(1);
    group = gproj_system_add_group(system, &heights);
    for (k = 0; k < 5; ++k) {
        gproj_term z = gprojt_term(3 * k + 2, k == 4 ? 14 : -1, k == 4 ? DBL_MAX : 1);
        GPROJT_CHECK(gproj_system_add_row(system, group, 1, &z, k == 4 ? DBL_MAX : -50, elements[k]) == k);
    }
    GPROJT_CHECK(gproj_set_element_weights(form, group, 2, some, weight) == GPROJ_OK);
    for (k = 0; k < 5; ++k) GPROJT_CHECK(gprojt_inside_row_weight(form, group, k) == (k == 2 ? 3 : k == 3 ? 0 : 1));
    memset(&options, 0, sizeof options);
    options.skip_closeness = true;
    gproj_solve(form, 0, &options);
    GPROJT_CHECK(gproj_form_residuals(form, group, vertex, NULL) == GPROJ_OK);
    for (k = 0; k < mesh->vertex_count; ++k)
        GPROJT_CHECK(vertex[k] == (k == 2 ? 50 - gproj_system_values(system)[8] : k == 5 ? HUGE_VAL : 0));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(vertex);
}

/* Rows that come after their group's elements have weights: they begin with a weight of 1, and the others keep theirs. */
GPROJT_TEST(rows_after_weights_of_elements) {
    static const double none[3] = {0, 0, 0};
    gproj_mesh *mesh = gprojt_cap(6, 1, none);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t group = gproj_add_rows(form, "heights", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1), v, round;
    double *weight = (double *)calloc((size_t)mesh->vertex_count, sizeof(double));
    for (v = 0; v < mesh->vertex_count; ++v) weight[v] = v % 3;
    for (v = 0; v < mesh->vertex_count; ++v) {
        gproj_term z = gprojt_term(3 * v + 2, -1, 1);
        gproj_form_add_row(form, group, 1, &z, -0.01 * v, v);
        if (v == 4) GPROJT_CHECK(gproj_set_element_weights(form, group, v, NULL, weight) == GPROJ_OK);
    }
    for (v = 0; v < mesh->vertex_count; ++v)
        GPROJT_CHECK(gprojt_inside_row_weight(form, group, v) == (v < 4 ? weight[v] : 1));
    for (round = 0; round < 2; ++round) {
        double before = mesh->position[2];
        GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED);
        for (v = 0; v < mesh->vertex_count; ++v)
            if (round ? weight[v] > 0 : v != 0 && v != 3) GPROJT_NEAR(mesh->position[3 * v + 2], 0.01 * v, 1e-11);
        GPROJT_CHECK(fabs(mesh->position[2] - before) < 1e-3);
        for (v = 0; v < mesh->vertex_count; ++v) mesh->position[3 * v + 2] += 0.1;
        GPROJT_CHECK(gproj_set_element_weights(form, group, 0, NULL, weight) == GPROJ_OK);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(weight);
}

/* The same after a solve, for which rows have given spare room back: weights keep theirs, and have too little later on if
   that is not seen. */
GPROJT_TEST(rows_after_weights_and_a_solve) {
    static const double none[3] = {0, 0, 0};
    int32_t first;
    for (first = 3; first < 40; first += 4) {
        gproj_mesh *mesh = gprojt_cap(6, 1, none);
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t group = gproj_add_rows(form, "heights", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1), r, vertex = 1;
        double weight = 2;
        for (r = 0; r < 100; ++r) {
            gproj_term z = gprojt_term(3 * (r % mesh->vertex_count) + 2, -1, 1);
            gproj_form_add_row(form, group, 1, &z, -0.01 * (r % mesh->vertex_count), r % mesh->vertex_count);
            if (r != first) continue;
            GPROJT_CHECK(gproj_set_element_weights(form, group, 1, &vertex, &weight) == GPROJ_OK);
            GPROJT_CHECK(gproj_solve(form, 9, NULL).outcome == GPROJ_CONVERGED);
        }
        for (r = 0; r < 100; ++r) GPROJT_CHECK(gprojt_inside_row_weight(form, group, r) == (r == 1 ? 2 : 1));
        GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Each wrong call says what is wrong. */
GPROJT_TEST(wrong_rows_are_refused) {
    static const double none[3] = {0, 0, 0}, values[4] = {0, 0, 0, 1e300};
    static const char *const words[] = {"neither",   "neither",    "neither",    "none of",      "none of",
                                        "3 each",    "1 or more",  "1 or more",  "beyond 1e70",  "1e50",
                                        "finite",    "gproj_kind", "gproj_kind", "no vertex",    "neither",
                                        "-1 terms",  "or no list", "none of",    "no vertex -2", "gproj_kind",
                                        "1 or more", "1 or more",  "gproj_kind", "gproj_kind",   "has no place"};
    int32_t i;
    for (i = 0; i < 25; ++i) {
        gproj_mesh *mesh = gprojt_cap(4, 1, none);
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t planar = gproj_add_planarity(form, 1), got;
        gproj_kind kind = i == 11 ? (gproj_kind)7 : i == 19 ? (gproj_kind)-1 : GPROJ_CONSTRAINT;
        gproj_place place = i == 12   ? GPROJ_PLACE_ROW
                            : i == 22 ? (gproj_place)-1
                            : i == 24 ? GPROJ_PLACE_NONE
                                      : GPROJ_PLACE_VERTEX;
        int32_t group = gproj_add_rows(form, "mine", kind, i == 23 ? (gproj_place)99 : place, i == 9 ? -1 : 1);
        gproj_term term = gprojt_term(0, -1, i == 10 ? INFINITY : 1);
        if (i == 0) term.i = -1;
        if (i == 1) term.i = 3 * mesh->vertex_count; /* a normal: the library's */
        if (i == 2) term.j = INT32_MAX;
        if (i == 14) term.j = -2;
        got = i < 3     ? gproj_form_add_row(form, group, 1, &term, 0, 0)
              : i == 3  ? gproj_form_add_row(form, planar, 1, &term, 0, 0)
              : i == 4  ? gproj_form_add_unknowns(form, 77, GPROJ_UNIT_NUMBER, 1, values, NULL, NULL)
              : i == 5  ? gproj_form_add_unknowns(form, group, GPROJ_UNIT_POINT, 2, values, NULL, NULL)
              : i == 6  ? gproj_form_add_unknowns(form, group, GPROJ_UNIT_NUMBER, 0, values, NULL, NULL)
              : i == 7  ? gproj_form_add_unknowns(form, group, GPROJ_UNIT_NUMBER, 1, NULL, NULL, NULL)
              : i == 8  ? gproj_form_add_unknowns(form, group, GPROJ_UNIT_NUMBER, 4, values, NULL, NULL)
              : i == 17 ? gproj_form_add_row(form, -1, 1, &term, 0, 0)
              : i == 18 ? gproj_form_add_row(form, group, 1, &term, 0, -2)
              : i == 20 ? gproj_form_add_unknowns(form, group, (gproj_unit)-1, 1, values, NULL, NULL)
              : i == 21 ? gproj_form_add_unknowns(form, group, (gproj_unit)9, 1, values, NULL, NULL)
              : i == 9 || i == 11 || i == 12 || i == 19 || i == 22 || i == 23 ? group
              : i == 15 ? gproj_form_add_row(form, group, -1, &term, 0, 0)
              : i == 16 ? gproj_form_add_row(form, group, 1, NULL, 0, 0)
              : i == 13 ? gproj_form_add_row(form, group, 1, &term, 0, mesh->vertex_count)
                        : gproj_form_add_row(form, group, 1, &term, 0, 0);
        if (!strstr(gproj_form_error(form)->message, words[i]))
            printf("  %d: %s\n", i, gproj_form_error(form)->message);
        GPROJT_CHECK(got == -1 && strstr(gproj_form_error(form)->message, words[i]) != NULL);
        if (i == 15 || i == 16)
            GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_ERROR_ARGUMENT &&
                         gproj_form_error(form)->place == GPROJ_PLACE_GROUP && gproj_form_error(form)->index == group);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(unknowns_refused) {
    static const double none[3] = {0, 0, 0};
    gproj_mesh *mesh = gprojt_cap(4, 1, none);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double value[2];
    gproj_error error;
    GPROJT_CHECK(gproj_form_get_unknowns(NULL, 0, 1, value, &error) == GPROJ_ERROR_ARGUMENT && error.index == -1);
    GPROJT_CHECK(gproj_form_get_unknowns(form, 0, 1, NULL, &error) == GPROJ_ERROR_ARGUMENT && error.index == -1);
    GPROJT_CHECK(gproj_form_get_unknowns(form, 0, -1, value, &error) == GPROJ_ERROR_ARGUMENT && error.index == -1);
    GPROJT_CHECK(gproj_form_get_unknowns(form, -1, 1, value, &error) == GPROJ_ERROR_INDEX);
    GPROJT_CHECK(gproj_form_get_unknowns(form, 3 * mesh->vertex_count - 1, 2, value, &error) == GPROJ_ERROR_INDEX &&
                 error.place == GPROJ_PLACE_VARIABLE && error.index == 3 * mesh->vertex_count);
    GPROJT_CHECK(gproj_form_get_unknowns(form, 0, 2, value, NULL) == GPROJ_OK &&
                 gproj_form_error(form)->code == GPROJ_OK);
    GPROJT_NEAR(value[1], mesh->position[1], 1e-12);
    GPROJT_CHECK(gproj_form_get_unknowns(form, INT32_MAX, 2, value, &error) == GPROJ_ERROR_INDEX);
    GPROJT_CHECK(gproj_form_residuals(form, 0, NULL, &error) == GPROJ_ERROR_ARGUMENT);
    gproj_add_planarity(form, NAN); /* what a form after an error is asked is answered by this error, the first one */
    GPROJT_CHECK(gproj_add_rows(form, "mine", (gproj_kind)99, GPROJ_PLACE_NONE, 1) == -1);
    GPROJT_CHECK(strstr(gproj_form_error(form)->message, "planarity"));
    GPROJT_CHECK(gproj_form_get_unknowns(form, 0, 2, value, &error) == gproj_form_error(form)->code);
    GPROJT_CHECK(!strcmp(error.message, gproj_form_error(form)->message));
    GPROJT_CHECK(gproj_form_residuals(form, 0, value, &error) == gproj_form_error(form)->code);
    GPROJT_CHECK(!strcmp(error.message, gproj_form_error(form)->message));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Groups without a name are "rows"; those with unknowns have their own each, also in states. */
GPROJT_TEST(groups_have_their_own_unknowns) {
    static const double none[3] = {0, 0, 0}, start[2][2] = {{3, 4}, {5, 6}};
    gproj_mesh *mesh = gprojt_cap(4, 1, none);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t group[2], at[2], k, round;
    uint8_t *state = NULL;
    size_t size = 0;
    double value[2];
    for (k = 0; k < 2; ++k) {
        group[k] = gproj_add_rows(form, NULL, GPROJ_WISH, GPROJ_PLACE_NONE, 1);
        at[k] =
            gproj_form_add_unknowns(form, group[k], k ? GPROJ_UNIT_NUMBER : GPROJ_UNIT_LENGTH, 2, start[k], NULL, NULL);
        GPROJT_CHECK(!strcmp(gproj_form_group_info(form, group[k]).name, "rows"));
    }
    for (k = 0; k < 2; ++k) { /* the sum of the first unknowns is 10, the difference 0: both are 5 */
        gproj_term term[2] = {gprojt_term(at[0], -1, 1), gprojt_term(at[1], -1, k ? -1 : 1)};
        GPROJT_CHECK(gproj_form_add_row(form, group[k], 2, term, k ? 0 : -10, -1) == 0);
    }
    for (round = 0; round < 3; ++round) {
        GPROJT_CHECK(gproj_solve(form, round < 2 ? 40 * round : 0, NULL).outcome != GPROJ_FAILED);
        if (round == 0) state = gprojt_save(form, &size);
        if (round == 2) GPROJT_CHECK(gproj_state_restore(form, state, size, NULL) == GPROJ_OK);
        for (k = 0; k < 2; ++k) {
            GPROJT_CHECK(gproj_form_get_unknowns(form, at[k], 2, value, NULL) == GPROJ_OK);
            GPROJT_NEAR(value[0], round == 1 ? 5 : start[k][0], 1e-6);
            GPROJT_NEAR(value[1], start[k][1], 1e-12);
        }
    }
    free(state);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A row without terms is a number, which holds only if it is 0. */
GPROJT_TEST(rows_without_terms) {
    static const double shift[3] = {1, 2, 3};
    double number;
    for (number = 0; number < 3; number += 2) {
        gproj_mesh *mesh = gprojt_cap(4, 5, shift);
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t group = gproj_add_rows(form, "mine", GPROJ_CONSTRAINT, GPROJ_PLACE_NONE, 1);
        gproj_result result;
        GPROJT_CHECK(gproj_form_add_row(form, group, 0, NULL, number, -1) == 0);
        result = gproj_solve(form, 10, NULL);
        GPROJT_CHECK((result.outcome == GPROJ_CONVERGED) == (number == 0));
        GPROJT_NEAR(result.residual, number / gprojt_unit(form), 1e-15);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* A start value in range, but not in the form's units: 1e60 is 1e360 mean edges, beyond all numbers. */
GPROJT_TEST(start_values_beyond_the_units) {
    static const double none[3] = {0, 0, 0}, far = 1e60;
    gproj_mesh *mesh = gprojt_cap(4, 1e-300, none);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t group = gproj_add_rows(form, "mine", GPROJ_CONSTRAINT, GPROJ_PLACE_NONE, 1);
    GPROJT_CHECK(gproj_form_add_unknowns(form, group, GPROJ_UNIT_NUMBER, 1, &far, NULL, NULL) >= 0);
    GPROJT_CHECK(gproj_form_add_unknowns(form, group, GPROJ_UNIT_LENGTH, 1, &far, NULL, NULL) == -1);
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_ERROR_NUMBER && strstr(gproj_form_error(form)->message, "mine"));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Where there is a sphere already, it is found at the start: of edges that all touch one, as those of an octahedron do, and
   of a pyramid's that do not. */
GPROJT_TEST(midspheres_begin_at_their_place) {
    static const int32_t degree[8] = {3, 3, 3, 3, 3, 3, 3, 3};
    static const int32_t corner[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    int32_t i, bent;
    for (bent = 0; bent < 2; ++bent) {
        double position[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
        gproj_mesh *mesh;
        gproj_form *form;
        gproj_result result;
        if (bent) position[2] = 0.7;
        for (i = 0; i < 18; ++i) position[i] = 3 * position[i] + 5 * (i % 3);
        mesh = gproj_mesh_create(6, position, 8, degree, corner, NULL, NULL);
        form = gproj_form_create(mesh, NULL);
        GPROJT_CHECK(gproj_add_midsphere(form, mesh->edge_count, NULL, 1) >= 0);
        result = gproj_solve(form, 0, NULL);
        GPROJT_CHECK(bent ? result.residual > 1e-3 : result.residual < 1e-12);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Of midpoints in a plane there are many spheres: the one around their centre is chosen, in this plane. */
GPROJT_TEST(flat_midspheres_begin_in_their_plane) {
    int32_t face;
    for (face = 0; face < 12; ++face) { /* of a cube, then of a box */
        gprojt_soup soup = gprojt_cube_sphere(1);
        gproj_mesh *mesh = gprojt_soup_mesh(&soup, NULL, NULL);
        gproj_form *form;
        int32_t edge[4], h = mesh->face_halfedge[face % 6], sphere = 3 * mesh->vertex_count, i, k;
        double centre[3] = {0, 0, 0};
        for (i = 0; i < 3 * mesh->vertex_count; ++i) mesh->position[i] *= face < 6 ? 1 : 1 + i % 3;
        form = gproj_form_create(mesh, NULL);
        for (i = 0; i < 4; ++i, h = mesh->next[h]) {
            edge[i] = h / 2;
            for (k = 0; k < 3; ++k) centre[k] += mesh->position[3 * mesh->origin[h] + k] / 4;
        }
        GPROJT_CHECK(gproj_add_midsphere(form, 4, edge, 1) >= 0);
        for (k = 0; k < 3; ++k)
            GPROJT_NEAR(gproj_system_values(gproj_form_system(form))[sphere + k] * gprojt_unit(form), centre[k], 1e-6);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&soup);
    }
}

/* The midpoints' sphere, checked apart from the library; on a real sphere it is that one. */
GPROJT_TEST(edge_midpoints_on_a_sphere) {
    gprojt_soup soup = gprojt_cube_sphere(3);
    gproj_mesh *mesh = gprojt_soup_mesh(&soup, NULL, NULL);
    gproj_form *form;
    double centre[3] = {0, 0, 0}, least = INFINITY, most = 0;
    uint64_t seed = 5;
    int32_t i, e;
    for (i = 0; i < 3 * mesh->vertex_count; ++i)
        mesh->position[i] = 40 + 3 * (mesh->position[i] + 0.02 * gprojt_uniform(&seed));
    form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1);
    GPROJT_CHECK(gproj_add_midsphere(form, mesh->edge_count, NULL, 1) >= 0);
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-8);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    /* Four midpoints give the sphere by Cramer's rule: 2 (m_k - m_0)'c = m_k'm_k - m_0'm_0. */
    {
        static const int32_t pick[4] = {0, 17, 40, 71};
        double m[4][3], d[3][3], side[3], n[3], det;
        for (i = 0; i < 4; ++i) {
            const double *a = mesh->position + 3 * mesh->origin[2 * pick[i]];
            const double *b = mesh->position + 3 * mesh->origin[2 * pick[i] + 1];
            for (e = 0; e < 3; ++e) m[i][e] = (a[e] + b[e]) / 2 - 40;
        }
        for (i = 0; i < 3; ++i) {
            gprojt_sub3(m[i + 1], m[0], d[i]);
            side[i] = (gprojt_dot3(m[i + 1], m[i + 1]) - gprojt_dot3(m[0], m[0])) / 2;
        }
        gprojt_cross3(d[1], d[2], n);
        det = gprojt_dot3(d[0], n);
        for (i = 0; i < 3; ++i) {
            gprojt_cross3(d[(i + 1) % 3], d[(i + 2) % 3], n);
            for (e = 0; e < 3; ++e) centre[e] += side[i] * n[e] / det;
        }
    }
    for (e = 0; e < mesh->edge_count; ++e) {
        const double *a = mesh->position + 3 * mesh->origin[2 * e], *b = mesh->position + 3 * mesh->origin[2 * e + 1];
        double m[3];
        for (i = 0; i < 3; ++i) m[i] = (a[i] + b[i]) / 2 - 40;
        least = fmin(least, gprojt_far(m, centre)), most = fmax(most, gprojt_far(m, centre));
    }
    GPROJT_CHECK(most - least < 1e-9 * most && least > 2 && most < 3.2);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&soup);
}

static void gprojt_add_own(gproj_form *form, void *user) {
    double ball[4] = {0, 0, -3, 5}, weight = 2;
    int32_t group = gproj_add_rows(form, "ball", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1), at, r, vertex = 0;
    (void)user;
    at = gproj_form_add_unknowns(form, group, GPROJ_UNIT_POINT, 3, ball, NULL, NULL);
    r = gproj_form_add_unknowns(form, group, GPROJ_UNIT_LENGTH, 1, ball + 3, NULL, NULL);
    gprojt_add_ball_row(form, group, 0, at, r, 5);
    gproj_set_element_weights(form, group, 1, &vertex, &weight);
    for (vertex = 1; vertex < 9; ++vertex) gprojt_add_ball_row(form, group, vertex, at, r, 5);
    gproj_add_midsphere(form, 3, NULL, 1);
}

/* The library's groups, also those that solves and drags add, and the ones of gproj_add_rows, whose rows are in the mesh's
   units, take no rows through the system. */
GPROJT_TEST(groups_of_forms_take_no_rows_of_the_system) {
    int32_t group, groups = 1;
    for (group = 0; group < groups; ++group) {
        static const gproj_term x = {0, -1, 1};
        static const int32_t held = 0;
        gproj_handles handles;
        gproj_mesh *mesh = gprojt_noisy(0, 3, 0.05, 1);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_system *s = gproj_form_system(form);
        gproj_solve_options options;
        gproj_drag *drag;
        char name[GPROJ_NAME_SIZE + 2];
        int32_t own;
        memset(&options, 0, sizeof options), memset(&handles, 0, sizeof handles);
        options.smooth = true;
        handles.count = 1, handles.vertex = &held;
        gproj_add_planarity(form, 1);
        gproj_add_volume(form, gproj_volume(mesh), 1);
        gproj_add_fairness(form, 0.1);
        gproj_add_rows(form, "mine", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1);
        own = gprojt_add_group(s, "own", GPROJ_CONSTRAINT, 1);
        gproj_solve(form, 30, &options);
        drag = gproj_drag_begin(form, &handles, NULL, NULL);
        gproj_drag_release(drag);
        gproj_solve_stop(form);
        GPROJT_REQUIRE(drag && gproj_form_error(form)->code == GPROJ_OK);
        groups = gproj_system_group_count(s);
        snprintf(name, sizeof name, "'%s'", gproj_form_group_info(form, group).name);
        GPROJT_CHECK((gproj_system_add_row(s, group, 1, &x, 0, -1) >= 0) == (group == own));
        GPROJT_CHECK(gproj_form_error(form)->code == (group == own ? GPROJ_OK : GPROJ_ERROR_ARGUMENT));
        if (group != own) GPROJT_CHECK(strstr(gproj_form_error(form)->message, name) != NULL);
        gproj_drag_cancel(drag);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    GPROJT_CHECK(groups >= 8);
}

GPROJT_TEST(every_allocation_fails_once) {
    gproj_mesh *mesh = gprojt_noisy(0, 3, 0.05, 1);
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_add_own, NULL, 3, NULL) >= 20);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(a_ball_in_any_units);
    GPROJT_RUN(numbers_are_in_the_units_of_the_mesh);
    GPROJT_RUN(products_of_units);
    GPROJT_RUN(unknowns_start_anew);
    GPROJT_RUN(meddling_start_values);
    GPROJT_RUN(states_and_drags_know_unknowns);
    GPROJT_RUN(residuals_by_element);
    GPROJT_RUN(residuals_by_edge);
    GPROJT_RUN(rows_of_no_element);
    GPROJT_RUN(rows_after_weights_of_elements);
    GPROJT_RUN(rows_after_weights_and_a_solve);
    GPROJT_RUN(wrong_rows_are_refused);
    GPROJT_RUN(unknowns_refused);
    GPROJT_RUN(groups_have_their_own_unknowns);
    GPROJT_RUN(rows_without_terms);
    GPROJT_RUN(start_values_beyond_the_units);
    GPROJT_RUN(midspheres_begin_at_their_place);
    GPROJT_RUN(flat_midspheres_begin_in_their_plane);
    GPROJT_RUN(edge_midpoints_on_a_sphere);
    GPROJT_RUN(groups_of_forms_take_no_rows_of_the_system);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
