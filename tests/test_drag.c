/* test_drag.c - >>drag: handles, the tangent space, releases; what it promises is checked from outside. */
#include "gprojt_design.h"

/* -- what is dragged -- */

/* A form of a kind whose mesh satisfies everything, and its positions then. */
typedef struct gprojt_stage {
    gproj_mesh *mesh;
    gproj_form *form;
    double *start;
    double edge; /* mean length */
} gprojt_stage;

static gprojt_stage gprojt_set_stage(gproj_mesh *mesh, int design, const gproj_host *host) {
    gprojt_stage stage;
    gproj_result result;
    stage.mesh = mesh;
    stage.form = gprojt_design(mesh, design, host);
    result = gproj_solve(stage.form, 40, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    stage.start = gprojt_keep(mesh);
    stage.edge = gproj_mesh_mean_edge_length(mesh);
    return stage;
}

static void gprojt_clear_stage(gprojt_stage *stage) {
    gproj_form_destroy(stage->form);
    gproj_mesh_destroy(stage->mesh);
    free(stage->start);
}

static gproj_drag *gprojt_grab(const gprojt_stage *stage, int32_t count, const int32_t *vertex) {
    gproj_handles handles = gprojt_vertex_handles(count, vertex);
    gproj_error error;
    gproj_drag *drag = gproj_drag_begin(stage->form, &handles, NULL, &error);
    if (!drag) printf("  %s\n", error.message);
    GPROJT_CHECK(drag && error.code == GPROJ_OK);
    return drag;
}

/* Moves one vertex by (0.3, 0.2, 0.9) * length from where it was. */
static void gprojt_pull(const gprojt_stage *stage, gproj_drag *drag, int32_t v, double length) {
    double p[3];
    p[0] = stage->start[3 * v] + 0.3 * length;
    p[1] = stage->start[3 * v + 1] + 0.2 * length;
    p[2] = stage->start[3 * v + 2] + 0.9 * length;
    GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_OK);
    if (gproj_drag_get_info(drag).behind < 1e-12) GPROJT_CHECK(gprojt_far(stage->mesh->position + 3 * v, p) < 1e-9);
}

/* -- second order -- */

/* How far the mesh is from what must hold, by measures that know nothing of rows. */
static double gprojt_measured_error(const gprojt_stage *stage, int design) {
    gproj_measures m = gproj_measure(stage->mesh, NULL, NULL);
    if (design == GPROJT_STANDING) return gproj_measure_forces(stage->form, NULL).residual;
    return design == GPROJT_CIRCULAR ? m.circularity_max : m.planarity_max;
}

static void gprojt_check_order(int design) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(9, 0.05), design, NULL);
    int32_t v = gprojt_middle(stage.mesh), k;
    gproj_drag *drag = gprojt_grab(&stage, 1, &v);
    double h = 0.5 * stage.edge, residual = 0, measured = 0;
    for (k = 0; drag && k < 8; ++k, h /= 2) {
        double now[2];
        gprojt_pull(&stage, drag, v, h);
        now[0] = gproj_drag_residual(drag);
        now[1] = gprojt_measured_error(&stage, design);
        GPROJT_CHECK(k == 0 || (residual / now[0] > 3.5 && residual / now[0] < 4.5));
        GPROJT_CHECK(k < 3 || (measured / now[1] > 3.5 && measured / now[1] < 4.5));
        residual = now[0];
        measured = now[1];
    }
    GPROJT_CHECK(gproj_drag_get_info(drag).freedom == 3 && gproj_drag_get_info(drag).behind < 1e-9 * stage.edge);
    gprojt_pull(&stage, drag, v, 0.5 * stage.edge);
    GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_measure(stage.mesh, NULL, NULL).planarity_max <= 1e-9);
    GPROJT_CHECK(gprojt_measured_error(&stage, design) <= 1e-9);
    GPROJT_CHECK(gprojt_far(stage.mesh->position + 3 * v, stage.start + 3 * v) > 0.2 * stage.edge);
    gprojt_clear_stage(&stage);
}

GPROJT_TEST(half_a_drag_is_a_quarter_of_the_error) {
    gprojt_check_order(GPROJT_PLANAR);
    gprojt_check_order(GPROJT_STANDING);
    gprojt_check_order(GPROJT_CIRCULAR);
    gprojt_check_order(GPROJT_GLIDING);
}

/* The very first move keeps what dense rows say, too: the volume changes by the square of the drag, though the handle
   takes a part of the roof up. */
GPROJT_TEST(the_first_move_keeps_the_volume) {
    static const double sizes[2] = {1e-3, 2e-3};
    double change[2];
    int k;
    for (k = 0; k < 2; ++k) {
        gproj_mesh *mesh = gprojt_roof(4, 0);
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t v = 0;
        gproj_handles handles = gprojt_vertex_handles(1, &v);
        double before = gproj_volume(mesh), to[3];
        gproj_drag *drag;
        while (gproj_mesh_is_boundary_vertex(mesh, v)) ++v;
        gproj_add_volume(form, before, 1);
        gproj_add_fixed_boundary(form, 1);
        drag = gproj_drag_begin(form, &handles, NULL, NULL);
        GPROJT_REQUIRE(drag);
        memcpy(to, mesh->position + 3 * v, sizeof to);
        to[2] += sizes[k];
        GPROJT_CHECK(gproj_drag_move(drag, to) == GPROJ_OK);
        GPROJT_NEAR(mesh->position[3 * v + 2], to[2], 1e-6 * sizes[k]);
        change[k] = fabs(gproj_volume(mesh) - before);
        GPROJT_CHECK(change[k] < 5 * sizes[k] * sizes[k]); /* without the row about sizes[k] times a cell */
        gproj_drag_cancel(drag);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- the smallest change -- */

typedef struct gprojt_basis {
    int32_t n, count;
    double *vector;
} gprojt_basis;

/* Takes the part of v in the span off v, twice for its digits. */
static void gprojt_take_off(const gprojt_basis *b, double *v) {
    int32_t i, j, pass;
    for (pass = 0; pass < 2; ++pass)
        for (j = 0; j < b->count; ++j) {
            const double *u = b->vector + (size_t)b->n * (size_t)j;
            double sum = 0;
            for (i = 0; i < b->n; ++i) sum += u[i] * v[i];
            for (i = 0; i < b->n; ++i) v[i] -= sum * u[i];
        }
}

static double gprojt_norm(const double *v, int32_t n) {
    double sum = 0;
    int32_t i;
    for (i = 0; i < n; ++i) sum += v[i] * v[i];
    return sqrt(sum);
}

/* The span of the gradients, scaled by D^-1/2, of all rows that must hold, and of the handles' vertices. */
static gprojt_basis gprojt_normal_space(gproj_form *form, const double *scale, int32_t count, const int32_t *vertex) {
    gproj_system *s = gproj_form_system(form);
    gprojt_basis b;
    double *v;
    int32_t g, r, i;
    b.n = gproj_system_variable_count(s), b.count = 0;
    b.vector = (double *)malloc((size_t)b.n * (size_t)(b.n + 1) * sizeof(double));
    if (!b.vector) abort();
    for (g = 0; g <= gproj_system_group_count(s); ++g) {
        int32_t rows = g < gproj_system_group_count(s) ? gproj_system_group_info(s, g).rows : 3 * count;
        if (g < gproj_system_group_count(s) && gproj_system_group_info(s, g).kind != GPROJ_CONSTRAINT) continue;
        for (r = 0; r < rows; ++r) {
            double before, after;
            v = b.vector + (size_t)b.n * (size_t)b.count;
            memset(v, 0, (size_t)b.n * sizeof *v);
            if (g < gproj_system_group_count(s))
                gproj_system_row_value(s, g, r, v);
            else
                v[3 * vertex[r / 3] + r % 3] = 1;
            for (i = 0; i < b.n; ++i) v[i] /= scale[i];
            before = gprojt_norm(v, b.n);
            gprojt_take_off(&b, v);
            after = gprojt_norm(v, b.n);
            if (!(after > 1e-8 * before)) continue;
            for (i = 0; i < b.n; ++i) v[i] /= after;
            b.count++;
        }
    }
    return b;
}

/* The optimality of the smallest change: D dx is a combination of the gradients and of the handles. */
static void gprojt_check_smallest(int design) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(4, 0.05), design, NULL);
    gproj_system *s = gproj_form_system(stage.form);
    int32_t v[2], n = gproj_system_variable_count(s), i;
    double *x = (double *)malloc((size_t)n * sizeof *x), *scale = (double *)malloc((size_t)n * sizeof *scale), size;
    double to[6];
    gprojt_basis basis;
    gproj_drag *drag;
    v[0] = gprojt_middle(stage.mesh), v[1] = v[0] + 1;
    for (i = 0; i < 6; ++i) to[i] = stage.start[3 * v[i / 3] + i % 3];
    drag = gprojt_grab(&stage, 2, v);
    for (i = 0; i < n; ++i) scale[i] = i < 3 * stage.mesh->vertex_count ? 1 : 0.01;
    memcpy(x, gproj_system_values(s), (size_t)n * sizeof *x);
    basis = gprojt_normal_space(stage.form, scale, 2, v); /* at the beginning */
    to[0] += 0.1, to[2] += 0.3, to[4] -= 0.2;
    gproj_drag_move(drag, to);
    for (i = 0; i < n; ++i) x[i] = scale[i] * (gproj_system_values(s)[i] - x[i]);
    size = gprojt_norm(x, n);
    gprojt_take_off(&basis, x);
    GPROJT_CHECK(size > 0.3);
    GPROJT_CHECK(gprojt_norm(x, n) < 1e-5 * size);
    gproj_drag_cancel(drag);
    free(basis.vector), free(x), free(scale);
    gprojt_clear_stage(&stage);
}

GPROJT_TEST(the_change_is_the_smallest) {
    gprojt_check_smallest(GPROJT_PLANAR);
    gprojt_check_smallest(GPROJT_STANDING);
    gprojt_check_smallest(GPROJT_CIRCULAR);
}

/* -- handles -- */

/* Without anything that must hold, points of a cage take their vertices along as a subdivision does: dv = S d. */
GPROJT_TEST(points_of_a_cage) {
    static const int64_t start[] = {0, 3, 5};
    static const int32_t vertex[] = {3, 7, 8, 8, 12};
    static const double weight[] = {0.25, 1, 0.5, 0.5, 0.125}, cage[] = {1, 2, 3, 4, 5, 6};
    static const double moved[] = {1.5, 2, 3.25, 4, 4, 6};
    gproj_mesh *mesh = gprojt_roof(4, 0);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double *before = gprojt_keep(mesh);
    gproj_handles handles;
    gproj_drag *drag;
    int32_t v, c, k;
    int64_t e;
    memset(&handles, 0, sizeof handles);
    handles.count = 2, handles.start = start, handles.vertex = vertex, handles.weight = weight, handles.position = cage;
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    GPROJT_REQUIRE(drag);
    GPROJT_CHECK(gproj_drag_get_info(drag).freedom == 6);
    GPROJT_CHECK(gproj_drag_move(drag, moved) == GPROJ_OK && gproj_drag_get_info(drag).behind < 1e-12);
    for (v = 0; v < mesh->vertex_count; ++v)
        for (c = 0; c < 3; ++c) {
            double d = 0;
            for (k = 0; k < 2; ++k)
                for (e = start[k]; e < start[k + 1]; ++e)
                    if (vertex[e] == v) d += weight[e] * (moved[3 * k + c] - cage[3 * k + c]);
            GPROJT_NEAR(mesh->position[3 * v + c] - before[3 * v + c], d, 1e-12);
        }
    GPROJT_CHECK(gproj_drag_end(drag).outcome != GPROJ_FAILED);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(before);
}

/* A handle without a position of its own is at the weighted mean of its vertices. */
GPROJT_TEST(handles_at_their_means) {
    static const int64_t start[] = {0, 2};
    static const int32_t vertex[] = {6, 7};
    static const double weight[] = {3, 1};
    gproj_mesh *mesh = gprojt_roof(4, 0);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double *before = gprojt_keep(mesh), mean[3];
    gproj_handles handles;
    gproj_drag *drag;
    int32_t c;
    memset(&handles, 0, sizeof handles);
    handles.count = 1, handles.start = start, handles.vertex = vertex, handles.weight = weight;
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    for (c = 0; c < 3; ++c) mean[c] = (3 * before[18 + c] + before[21 + c]) / 4;
    GPROJT_CHECK(gproj_drag_move(drag, mean) == GPROJ_OK);
    GPROJT_CHECK(gprojt_largest_move(before, mesh->position, mesh->vertex_count) < 1e-12);
    gproj_drag_cancel(drag);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(before);
}

/* The size of a handle's weights only says how far its vertices go along, and handles may come in any order. */
GPROJT_TEST(handles_of_any_size_and_order) {
    static const int64_t start[2][3] = {{0, 2, 4}, {0, 2, 4}};
    static const int32_t vertex[2][4] = {{22, 23, 40, 41}, {40, 41, 22, 23}};
    static const double weight[2][4] = {{1e-3, 5e-4, 0.5, 1}, {0.5, 1, 1e-3, 5e-4}};
    static const double moved[2][6] = {{0, 0, 200, 0, 0, 0.3}, {0, 0, 0.3, 0, 0, 200}}, none[6] = {0};
    double *end = NULL;
    int32_t k;
    for (k = 0; k < 2; ++k) {
        gprojt_stage stage = gprojt_set_stage(gprojt_roof(7, 0.05), GPROJT_PLANAR, NULL);
        gproj_handles handles;
        gproj_drag *drag;
        memset(&handles, 0, sizeof handles);
        handles.count = 2, handles.start = start[k], handles.vertex = vertex[k], handles.weight = weight[k];
        handles.position = none;
        drag = gproj_drag_begin(stage.form, &handles, NULL, NULL);
        GPROJT_REQUIRE(drag);
        GPROJT_CHECK(gproj_drag_get_info(drag).freedom == 6);
        GPROJT_CHECK(gproj_drag_move(drag, moved[k]) == GPROJ_OK);
        GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
        if (k == 0) end = gprojt_keep(stage.mesh);
        GPROJT_CHECK(gprojt_largest_move(end, stage.mesh->position, stage.mesh->vertex_count) < 1e-9);
        GPROJT_CHECK(gprojt_largest_move(end, stage.start, stage.mesh->vertex_count) > 0.05);
        gprojt_clear_stage(&stage);
    }
    free(end);
}

/* What cannot follow stays behind, and does not hold back the others. */
GPROJT_TEST(handles_that_cannot_follow) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(6, 0.05), GPROJT_PLANAR, NULL);
    int32_t v[3], i;
    double to[9];
    gproj_drag *drag;
    v[0] = 0,
    v[1] = v[2] = gprojt_middle(stage.mesh); /* a fixed corner; and one vertex twice goes by both, as S d says */
    drag = gprojt_grab(&stage, 3, v);
    GPROJT_CHECK(gproj_drag_get_info(drag).freedom == 3 && gproj_drag_get_info(drag).handles == 3);
    for (i = 0; i < 9; ++i) to[i] = stage.start[3 * v[i / 3] + i % 3];
    to[2] += 3, to[5] += 0.2, to[8] += 0.4;
    GPROJT_CHECK(gproj_drag_move(drag, to) == GPROJ_OK);
    GPROJT_NEAR(gproj_drag_get_info(drag).behind, 3, 1e-9);
    GPROJT_CHECK(gprojt_far(stage.mesh->position, stage.start) < 1e-9);
    GPROJT_NEAR(stage.mesh->position[3 * v[1] + 2] - stage.start[3 * v[1] + 2], 0.6, 1e-8);
    GPROJT_NEAR(stage.mesh->position[3 * v[1]], stage.start[3 * v[1]], 1e-9);
    gproj_drag_cancel(drag);
    for (i = 0; i < 2; ++i) { /* the verdict tells of those without any freedom */
        drag = gprojt_grab(&stage, 1, v + i);
        gproj_drag_move(drag, to + 3 * i);
        GPROJT_CHECK((gproj_drag_get_info(drag).freedom == 0) == (i == 0));
        GPROJT_CHECK((strstr(gproj_drag_end(drag).message, "leaves them no freedom") != NULL) == (i == 0));
    }
    gprojt_clear_stage(&stage);
}

/* A bound at its limit holds the vertex there; one that is far from it does not, nor does one without weight. */
GPROJT_TEST(bounds_at_their_limit_hold) {
    gproj_mesh *mesh = gprojt_roof(4, 0);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_system *s = gproj_form_system(form);
    int32_t v[2], k, group = gprojt_add_group(s, "height", GPROJ_BOUND, 1);
    double to[6], far[2];
    gproj_drag *drag;
    gproj_handles handles;
    v[0] = 6, v[1] = 13;
    far[0] = 0, far[1] = 0.1;
    for (k = 0; k < 2; ++k)
        gprojt_add_linear(s, group, 3 * v[k] + 2, 1, far[k] - gproj_system_values(s)[3 * v[k] + 2], v[k]);
    gprojt_add_linear(s, group, 3 * v[1] + 2, 1, -gproj_system_values(s)[3 * v[1] + 2], v[1]);
    gproj_system_set_row_weight(s, group, 2, 0);
    handles = gprojt_vertex_handles(2, v);
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    GPROJT_REQUIRE(drag);
    for (k = 0; k < 6; ++k) to[k] = mesh->position[3 * v[k / 3] + k % 3] + 0.25;
    GPROJT_CHECK(gproj_drag_move(drag, to) == GPROJ_OK && gproj_drag_get_info(drag).freedom == 5);
    GPROJT_NEAR(mesh->position[3 * v[0] + 2], to[2] - 0.25, 1e-9);
    GPROJT_NEAR(mesh->position[3 * v[0] + 1], to[1], 1e-9);
    GPROJT_CHECK(gprojt_far(mesh->position + 3 * v[1], to + 3) < 1e-9);
    gproj_drag_cancel(drag);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* -- there and back -- */

static void gprojt_check_return(gprojt_stage *stage, int32_t v) {
    gproj_drag *drag = gprojt_grab(stage, 1, &v);
    gproj_result result;
    int32_t k;
    for (k = 1; k <= 20; ++k) gprojt_pull(stage, drag, v, 0.05 * stage->edge * (k <= 10 ? k : 20 - k));
    result = gproj_drag_end(drag);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.residual <= 1e-9);
    GPROJT_CHECK(gprojt_largest_move(stage->start, stage->mesh->position, stage->mesh->vertex_count) <=
                 0.05 * stage->edge);
    gprojt_clear_stage(stage);
}

GPROJT_TEST(there_and_back) {
    int design;
    for (design = 0; design < GPROJT_DESIGNS; ++design) {
        gprojt_stage stage = gprojt_set_stage(gprojt_roof(8, 0.05), design, NULL);
        gprojt_check_return(&stage, gprojt_middle(stage.mesh));
    }
}

GPROJT_TEST(there_and_back_on_intersection) {
    char path[1024];
    gproj_mesh *mesh;
    gprojt_stage stage;
    snprintf(path, sizeof path, "%s/Intersection.obj", gprojt_data_folder());
    mesh = gproj_mesh_load(path, NULL, NULL);
    if (!mesh) GPROJT_SKIP("no folder of real meshes");
    stage = gprojt_set_stage(mesh, GPROJT_PLANAR, NULL);
    gprojt_check_return(&stage, 800);
}

enum {
#ifdef GPROJT_SANITIZED
    GPROJT_LOOP_ACROSS = 12,
    GPROJT_TOWERS = 3
#else
    GPROJT_LOOP_ACROSS = 58, /* V = 3540 */
    GPROJT_TOWERS = 8
#endif
};

/* A closed loop of moves with releases: every face stays planar, and none folds. */
GPROJT_TEST(a_closed_loop) {
    static const int32_t across = GPROJT_LOOP_ACROSS, moves = 200;
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(across, 0.05), GPROJT_PLANAR, NULL);
    int32_t v = gprojt_middle(stage.mesh) + 3, k;
    double turn = 6.283185307179586 / moves, p[3];
    gproj_drag *drag = NULL;
    gproj_measures m;
    for (k = 1; k <= moves; ++k) {
        if (!drag) drag = gprojt_grab(&stage, 1, &v);
        p[0] = stage.start[3 * v] + 0.6 * stage.edge * sin(turn * k);
        p[1] = stage.start[3 * v + 1] + 0.8 * stage.edge * sin(turn * k);
        p[2] = stage.start[3 * v + 2] + stage.edge * (1 - cos(turn * k));
        GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_OK);
        if (k % 10) continue;
        GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
        drag = NULL;
        m = gproj_measure(stage.mesh, stage.start, NULL);
        GPROJT_CHECK(m.planarity_max <= 1e-9);
        GPROJT_CHECK(m.folded_edges == 0 && m.turned_faces == 0 && m.bow_tie_faces == 0);
        GPROJT_CHECK(gprojt_far(stage.mesh->position + 3 * v, p) < 0.02 * stage.edge);
    }
    m = gproj_measure(stage.mesh, stage.start, NULL);
    GPROJT_CHECK(m.displacement_mean < 0.3);
    gprojt_clear_stage(&stage);
}

/* Whichever way a vertex is dragged, by half an edge: after the release no face has turned over, and the vertex is there. */
GPROJT_TEST(releases_turn_no_face_over) {
    static const int designs[] = {GPROJT_PLANAR, GPROJT_STANDING, GPROJT_CIRCULAR};
    uint64_t random = 11;
    int32_t d, k, c;
    for (d = 0; d < 3; ++d) {
        gprojt_stage stage = gprojt_set_stage(gprojt_roof(9, 0.05), designs[d], NULL);
        for (k = 0; k < 8; ++k) {
            int32_t v = 22 + gprojt_below(&random, stage.mesh->vertex_count - 44);
            gproj_drag *drag = gprojt_grab(&stage, 1, &v);
            double way[3], to[3], length;
            gproj_measures m;
            for (c = 0; c < 3; ++c) way[c] = 2 * gprojt_uniform(&random) - 1;
            length = gprojt_length3(way);
            for (c = 0; c < 3; ++c) to[c] = stage.mesh->position[3 * v + c] + 0.5 * stage.edge * way[c] / length;
            GPROJT_CHECK(gproj_drag_move(drag, to) == GPROJ_OK);
            GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
            m = gproj_measure(stage.mesh, stage.start, NULL);
            GPROJT_CHECK(m.folded_edges == 0 && m.turned_faces == 0 && m.planarity_max <= 1e-9);
            GPROJT_CHECK(gprojt_far(stage.mesh->position + 3 * v, to) < 0.05 * stage.edge);
            gprojt_put_back(stage.mesh, stage.start);
            gproj_solve(stage.form, 20, NULL); /* the forces, too */
        }
        gprojt_clear_stage(&stage);
    }
}

/* A long drag that linearises anew stays near what must hold all the time. */
GPROJT_TEST(a_long_drag) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(8, 0.05), GPROJT_PLANAR, NULL);
    int32_t v = gprojt_middle(stage.mesh), k;
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag_options options;
    gproj_drag *drag;
    gproj_drag_info info;
    uint64_t allocations;
    memset(&options, 0, sizeof options);
    options.residual_bound = 0.01;
    drag = gproj_drag_begin(stage.form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    allocations = gproj_form_memory(stage.form).allocations + gproj_drag_memory(drag).allocations;
    for (k = 1; k <= 40; ++k) {
        gprojt_pull(&stage, drag, v, 0.04 * k * stage.edge);
        GPROJT_CHECK(gproj_drag_residual(drag) <= 0.011);
    }
    info = gproj_drag_get_info(drag);
    GPROJT_CHECK(info.linearisations > 2 && info.linearisations < 40 && info.solves == 6 * info.linearisations);
    GPROJT_CHECK(gproj_form_memory(stage.form).allocations + gproj_drag_memory(drag).allocations == allocations);
    GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
    gprojt_clear_stage(&stage);
}

/* A twisted tower of quads with a waist. */
static gproj_mesh *gprojt_tower(int32_t rows, int32_t around) {
    gprojt_soup s;
    int32_t i, j;
    memset(&s, 0, sizeof s);
    for (i = 0; i <= rows; ++i)
        for (j = 0; j < around; ++j) {
            double h = (double)i / rows, t = (double)j / around, pi = 3.14159265358979, turn = 2 * pi * (t + 0.12 * h);
            double r = 1 + 0.45 * (2 * h - 1) * (2 * h - 1) + 0.12 * cos(4 * pi * t);
            gprojt_add_vertex(&s, r * cos(turn), 0.8 * r * sin(turn), 3.2 * h);
        }
    for (i = 0; i < rows; ++i)
        for (j = 0; j < around; ++j) {
            int32_t a = i * around + j, b = i * around + (j + 1) % around;
            gprojt_add_quad(&s, a, a + around, b + around, b);
        }
    return gprojt_mesh_of(s);
}

/* Drags the middle of a tower that a smooth solve has fitted from places changed by 1e-9. Returns the largest residual. */
static double gprojt_bend_tower(uint64_t seed) {
    gproj_mesh *mesh = gprojt_tower(16, 24);
    gproj_form *form;
    gproj_solve_options solve;
    gproj_drag_options options;
    gproj_handles handles;
    gproj_drag *drag;
    int32_t middle = 8 * 24 + 6, *list = (int32_t *)malloc((size_t)mesh->vertex_count * sizeof *list), v, k;
    double *weight = (double *)malloc((size_t)mesh->vertex_count * sizeof *weight), *start, edge, p[3], residual = 0;
    int64_t ends[2] = {0, 0};
    memset(&options, 0, sizeof options);
    memset(&handles, 0, sizeof handles);
    memset(&solve, 0, sizeof solve);
    gprojt_shake(mesh, 1e-9, seed);
    form = gproj_form_create(mesh, NULL);
    options.residual_bound = 0.02;
    handles.count = 1, handles.start = ends, handles.vertex = list, handles.weight = weight;
    solve.smooth = true;
    gproj_add_planarity(form, 1);
    gproj_add_fixed_boundary(form, 1);
    gproj_add_fairness(form, 0.2);
    GPROJT_CHECK(gproj_solve(form, 60, &solve).outcome == GPROJ_CONVERGED);
    start = gprojt_keep(mesh);
    edge = gproj_mesh_mean_edge_length(mesh);
    handles.position = start + 3 * middle;
    ends[1] = gproj_find_reach(form, middle, 5 * edge, list, weight);
    drag = gproj_drag_begin(form, &handles, &options, NULL);
    if (!drag) abort();
    for (k = 1; k <= 10; ++k) {
        memcpy(p, start + 3 * middle, sizeof p);
        p[0] += 0.25 * k * edge;
        GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_OK);
        residual = fmax(residual, gproj_drag_residual(drag));
        for (v = 0; v < mesh->vertex_count; ++v)
            GPROJT_CHECK(gprojt_far(mesh->position + 3 * v, start + 3 * v) < 5 * edge);
    }
    gproj_drag_cancel(drag);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(list), free(weight), free(start);
    return residual;
}

/* Steps that take the residual off do not lead far away, even where rows nearly depend on each other; and places changed by
   1e-9 lead to the same end. */
GPROJT_TEST(restorations_stay_near) {
    double first = gprojt_bend_tower(1);
    uint64_t seed;
    GPROJT_CHECK(first < 0.04);
    for (seed = 2; seed <= GPROJT_TOWERS; ++seed) GPROJT_NEAR(gprojt_bend_tower(seed), first, 1e-4);
}

/* Two handles that stand against lengths of edges: each move goes only as far as the residual allows, so that none throws the
   mesh apart, and the same place again does not either. */
GPROJT_TEST(handles_against_what_must_hold) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_triangle_grid(5, 5));
    int32_t which[2] = {14, 21}, move, k;
    gproj_handles handles = gprojt_vertex_handles(2, which);
    gproj_drag_options options;
    gproj_form *form;
    gproj_drag *drag;
    double *start, place[6];
    memset(&options, 0, sizeof options);
    options.residual_bound = 0.01;
    gprojt_bulge(mesh, 23);
    start = gprojt_keep(mesh);
    form = gproj_form_create(mesh, NULL);
    gproj_add_lengths(form, 0, NULL, NULL, 1);
    drag = gproj_drag_begin(form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    for (move = 1; move <= 60; ++move) {
        for (k = 0; k < 6; ++k)
            place[k] = start[3 * which[k / 3] + k % 3] + fmin(move / 30.0, 1) * (k % 3 == 2 ? 0.3
                                                                                 : k < 3    ? 0.25
                                                                                            : -0.2);
        GPROJT_CHECK(gproj_drag_move(drag, place) == GPROJ_OK && gproj_drag_residual(drag) <= 1);
    }
    gproj_drag_cancel(drag);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(start);
}

/* What cannot hold is not restored by any step, however it is damped: the handle goes where it is dragged all the same. */
GPROJT_TEST(what_cannot_be_restored) {
    gproj_mesh *mesh = gprojt_roof(5, 0.05);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t v = gprojt_middle(mesh), corner = 0, k;
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag_options options;
    gproj_drag *drag;
    double away[3], p[3], residual;
    memset(&options, 0, sizeof options);
    memcpy(away, mesh->position, sizeof away), away[2] += 0.5;
    gproj_add_planarity(form, 1);
    gproj_add_fixed(form, 1, &corner, 1);
    gproj_add_targets(form, 1, &corner, away, 1);
    GPROJT_CHECK(gproj_solve(form, 40, NULL).outcome != GPROJ_CONVERGED);
    options.residual_bound = 0.01;
    drag = gproj_drag_begin(form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    residual = gproj_drag_residual(drag);
    memcpy(p, mesh->position + 3 * v, sizeof p);
    for (k = 0; k < 3; ++k) {
        p[2] += 0.1;
        GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_OK && gproj_drag_get_info(drag).linearisations == k + 2);
        GPROJT_CHECK(gprojt_far(mesh->position + 3 * v, p) < 1e-9 && gproj_drag_residual(drag) < 1.1 * residual);
    }
    GPROJT_CHECK(residual > 0.2);
    gproj_drag_cancel(drag);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A row with small numbers may ask for a long way: it is not gone, for no vertex moves by more than an edge to take a
   residual off. */
GPROJT_TEST(restorations_by_far_are_not_made) {
    gproj_mesh *mesh = gprojt_roof(5, 0);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t v = gprojt_middle(mesh), group, far = 0;
    double *before = gprojt_keep(mesh), edge = gproj_mesh_mean_edge_length(mesh), p[3];
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag_options options;
    gproj_drag *drag;
    gproj_term term = gprojt_term(3 * far, -1, 0.01);
    memset(&options, 0, sizeof options);
    options.residual_bound = 0.001;
    group = gproj_add_rows(form, "10 edges away", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1);
    gproj_form_add_row(form, group, 1, &term, -0.01 * (mesh->position[3 * far] + 10 * edge), far);
    drag = gproj_drag_begin(form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    memcpy(p, before + 3 * v, sizeof p), p[2] += 0.5 * edge;
    GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_OK && gproj_drag_get_info(drag).linearisations == 2);
    GPROJT_CHECK(gprojt_far(mesh->position + 3 * v, p) < 1e-9);
    GPROJT_CHECK(gprojt_far(mesh->position + 3 * far, before + 3 * far) <= edge);
    gproj_drag_cancel(drag);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(before);
}

/* A handle that jumps to where nothing can be linearised is refused, and the drag goes on as if it had not been. */
GPROJT_TEST(a_wild_move) {
    static const double far[] = {1e5, 1e20, 1e69};
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(6, 0.05), GPROJT_PLANAR, NULL);
    int32_t v = gprojt_middle(stage.mesh), k;
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag_options options;
    gproj_drag *drag;
    double *kept, p[3], behind;
    memset(&options, 0, sizeof options);
    options.residual_bound = 0.01;
    drag = gproj_drag_begin(stage.form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    gprojt_pull(&stage, drag, v, 0.2 * stage.edge);
    kept = gprojt_keep(stage.mesh);
    behind = gproj_drag_get_info(drag).behind;
    for (k = 0; k < 3; ++k) {
        memcpy(p, stage.start + 3 * v, sizeof p);
        p[2] = far[k];
        GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_ERROR_NUMBER);
        GPROJT_CHECK(strstr(gproj_drag_error(drag)->message, "cannot be linearised here"));
        GPROJT_CHECK(gprojt_unmoved(stage.mesh, kept) && gproj_drag_get_info(drag).behind == behind);
        GPROJT_CHECK(gproj_drag_residual(drag) <= 0.011);
    }
    gprojt_pull(&stage, drag, v, 0.3 * stage.edge);
    GPROJT_CHECK(gproj_drag_get_info(drag).behind < 1e-9 && gproj_drag_residual(drag) <= 0.011);
    GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
    free(kept);
    gprojt_clear_stage(&stage);
}

/* A handle that is pulled faster than it can follow stays behind, and one that has jumped too far comes back: what must
   hold is never lost for good. */
GPROJT_TEST(a_fast_drag) {
    static const double path[] = {2, 4, 6, 8, 10, 14, 8, 4, 1000, 20, 4, 6000, 20, 4, 2};
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(10, 0.05), GPROJT_PLANAR, NULL);
    int32_t v = gprojt_middle(stage.mesh), k;
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag_options options;
    gproj_drag *drag;
    memset(&options, 0, sizeof options);
    options.residual_bound = 0.05;
    drag = gproj_drag_begin(stage.form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    for (k = 0; k < (int32_t)(sizeof path / sizeof *path); ++k) {
        gprojt_pull(&stage, drag, v, path[k] * stage.edge);
        GPROJT_CHECK(gproj_drag_residual(drag) <= 1 || path[k] >= 1000);
    }
    GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
    gprojt_clear_stage(&stage);
}

/* To the bit as if it had not been, whether the responses are those of the beginning or later ones. */
GPROJT_TEST(a_wild_move_leaves_no_trace) {
    int way, wild, i;
    for (way = 0; way < 4; ++way) { /* the last two: with vertices that glide along the boundary, to the last digits */
        double *after[2] = {NULL, NULL};
        gproj_drag_info info[2];
        for (wild = 0; wild < 2; ++wild) {
            gprojt_stage stage = gprojt_set_stage(gprojt_roof(6, 0.05), way < 2 ? GPROJT_PLANAR : GPROJT_GLIDING, NULL);
            int32_t v = gprojt_middle(stage.mesh), group;
            gproj_handles handles = gprojt_vertex_handles(1, &v);
            gproj_drag_options options;
            gproj_drag *drag;
            double p[3], before[3];
            memset(&options, 0, sizeof options);
            options.residual_bound = way % 2 ? 0.3 : way ? 1e-5 : 0.01;
            drag = gproj_drag_begin(stage.form, &handles, &options, NULL);
            GPROJT_REQUIRE(drag);
            gprojt_pull(&stage, drag, v, 0.2 * stage.edge);
            GPROJT_CHECK((gproj_drag_get_info(drag).linearisations == 1) == (way % 2 == 1));
            GPROJT_CHECK(gproj_drag_residual(drag) < 1);
            for (group = 0; group < 3; ++group) before[group] = gproj_form_group_info(stage.form, group).max;
            memcpy(p, stage.start + 3 * v, sizeof p);
            p[2] = 1e69;
            if (wild) GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_ERROR_NUMBER);
            for (group = 0; group < 3; ++group)
                GPROJT_NEAR(gproj_form_group_info(stage.form, group).max, before[group], way < 2 ? 0 : 1e-10);
            gprojt_pull(&stage, drag, v, 0.25 * stage.edge);
            after[wild] = gprojt_keep(stage.mesh), info[wild] = gproj_drag_get_info(drag);
            if (wild && way < 2) GPROJT_CHECK(gprojt_unmoved(stage.mesh, after[0]));
            for (i = 0; i < 3 * stage.mesh->vertex_count; ++i) GPROJT_CHECK(fabs(after[wild][i] - after[0][i]) < 1e-10);
            gproj_drag_cancel(drag);
            gprojt_clear_stage(&stage);
        }
        GPROJT_CHECK(info[0].linearisations == info[1].linearisations && info[0].solves == info[1].solves);
        free(after[0]), free(after[1]);
    }
}

static bool gprojt_count_calls(void *user, gproj_system *system, const gproj_iteration *iteration) {
    (void)system, (void)iteration;
    ++*(int32_t *)user;
    return true;
}

/* A drag that is refused for its numbers, or cancelled, amid a solve in frames: this goes on, and calls back. */
GPROJT_TEST(callbacks_outlast_drags) {
    int32_t calls[4], how;
    for (how = 0; how < 4; ++how) {
        gproj_mesh *mesh = gprojt_noisy(0, 4, 0.1, 3);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_system *s = gproj_form_system(form);
        gproj_solve_options options;
        gproj_term term = gprojt_term(5, 6, 1);
        int32_t v = 12, own;
        double a = 1e200;
        gproj_handles handles = gprojt_vertex_handles(1, &v);
        gproj_drag *drag;
        memset(&options, 0, sizeof options);
        options.on_iteration = gprojt_count_calls, options.user = &calls[how];
        gproj_add_planarity(form, 1);
        own = gprojt_add_group(s, "own", GPROJ_CONSTRAINT, 1);
        gproj_system_add_row(s, own, 1, &term, 0, -1);
        calls[how] = 0;
        gproj_solve_begin(form, 20, &options, NULL);
        gproj_solve_advance(form, 0);
        if (how == 1) gproj_system_set_row(s, own, 0, &a, 0); /* cannot be linearised */
        drag = how ? gproj_drag_begin(form, &handles, NULL, NULL) : NULL;
        GPROJT_CHECK((drag != NULL) == (how > 1));
        a = 1;
        gproj_system_set_row(s, own, 0, &a, 0);
        if (how == 3) GPROJT_CHECK(gproj_drag_release(drag));
        if (how == 3) gproj_solve_advance(form, 0);
        gproj_drag_cancel(drag);
        GPROJT_CHECK(gproj_solve_is_on(form));
        while (gproj_solve_is_on(form)) gproj_solve_advance(form, 0);
        GPROJT_CHECK(calls[how] == calls[0] && calls[0] > 2);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- cost, and cancelling -- */

GPROJT_TEST(moves_allocate_nothing) {
    int design;
    for (design = 0; design < GPROJT_DESIGNS; ++design) {
        gprojt_failing failing;
        gproj_host host;
        gprojt_stage stage;
        int32_t v, k;
        long calls;
        gproj_drag *drag;
        gproj_drag_info info;
        memset(&failing, 0, sizeof failing);
        host = gprojt_failing_host(&failing);
        stage = gprojt_set_stage(gprojt_roof(6, 0.05), design, &host);
        v = gprojt_middle(stage.mesh);
        drag = gprojt_grab(&stage, 1, &v);
        calls = failing.calls;
        for (k = 0; k < 5; ++k) gprojt_pull(&stage, drag, v, 0.1 * k);
        gproj_drag_residual(drag);
        GPROJT_CHECK(failing.calls == calls);
        info = gproj_drag_get_info(drag);
        GPROJT_CHECK(info.linearisations == 1 && info.solves == 6);
        gproj_drag_cancel(drag);
        GPROJT_CHECK(failing.calls == calls);
        drag = gprojt_grab(&stage, 1, &v);
        calls = failing.calls;
        gproj_drag_end(drag); /* adds groups */
        GPROJT_CHECK(failing.calls > calls);
        gprojt_clear_stage(&stage);
        GPROJT_CHECK(failing.held == 0);
    }
}

/* After a cancelled drag everything is as if it had not been, to the bit. */
GPROJT_TEST(cancelled_to_the_bit) {
    int design, bounded;
    for (design = 0; design < GPROJT_DESIGNS; ++design)
        for (bounded = 0; bounded < 2; ++bounded) {
            gprojt_stage stage = gprojt_set_stage(gprojt_roof(6, 0.05), design, NULL);
            int32_t v = gprojt_middle(stage.mesh), k;
            gproj_handles handles = gprojt_vertex_handles(1, &v);
            gproj_drag_options options;
            size_t size, size_after;
            uint8_t *before = gprojt_save(stage.form, &size), *after;
            gproj_drag *drag;
            memset(&options, 0, sizeof options);
            options.residual_bound = bounded ? 1e-3 : INFINITY;
            drag = gproj_drag_begin(stage.form, &handles, &options, NULL);
            GPROJT_REQUIRE(drag);
            for (k = 0; k < 5; ++k) gprojt_pull(&stage, drag, v, 0.1 * k);
            GPROJT_CHECK(!gprojt_unmoved(stage.mesh, stage.start));
            gproj_drag_cancel(drag);
            GPROJT_CHECK(gprojt_unmoved(stage.mesh, stage.start));
            after = gprojt_save(stage.form, &size_after);
            GPROJT_CHECK(size == size_after && memcmp(before, after, size) == 0);
            free(before), free(after);
            gprojt_clear_stage(&stage);
        }
}

/* Additions during a drag, and errors of the form, do not keep it from being cancelled: the mesh and the forces are what
   they were. */
GPROJT_TEST(cancelled_after_additions) {
    int32_t v, outside = 99;
    int addition;
    for (addition = 0; addition < 4; ++addition) {
        gprojt_stage stage = gprojt_set_stage(gprojt_roof(5, 0.05), GPROJT_STANDING, NULL);
        gproj_system *s = gproj_form_system(stage.form);
        size_t count = (size_t)gproj_system_variable_count(s), bytes = count * sizeof(double);
        double *x = (double *)malloc(bytes);
        gproj_drag *drag;
        v = gprojt_middle(stage.mesh);
        memcpy(x, gproj_system_values(s), bytes);
        drag = gprojt_grab(&stage, 1, &v);
        gprojt_pull(&stage, drag, v, 0.2);
        if (addition == 0) gproj_add_closeness(stage.form, 1);
        if (addition == 1) gprojt_add_linear(s, 0, 3 * v, 1, 0, v);
        if (addition == 2) gproj_system_add_variables(s, 3, 3, NULL);
        if (addition == 3) gproj_add_fixed(stage.form, 1, &outside, 1);
        GPROJT_CHECK(!gprojt_unmoved(stage.mesh, stage.start));
        gproj_drag_cancel(drag);
        GPROJT_CHECK(gprojt_unmoved(stage.mesh, stage.start));
        GPROJT_CHECK(memcmp(gproj_system_values(s), x, bytes) == 0);
        if (addition == 0) GPROJT_CHECK(gproj_solve(stage.form, 20, NULL).outcome == GPROJ_CONVERGED);
        free(x);
        gprojt_clear_stage(&stage);
    }
}

/* -- misuse -- */

static void gprojt_check_refusal(gproj_form *form, const gproj_handles *handles, const gproj_drag_options *options,
                                 gproj_code code, const char *words) {
    gproj_error error;
    gproj_drag *drag = gproj_drag_begin(form, handles, options, &error);
    GPROJT_CHECK(!drag && error.code == code && strstr(error.message, words));
    GPROJT_CHECK((error.place == GPROJ_PLACE_NONE) == (error.index == -1));
    if (!drag && !strstr(error.message, words)) printf("  '%s' is not '%s'\n", error.message, words);
}

/* The lists of handles may begin anywhere: a column of a stencil is one. */
GPROJT_TEST(lists_that_begin_later) {
    static const int64_t start[] = {2, 4};
    static const int32_t vertex[] = {99999, -1, 12, 13};
    static const double weight[] = {0, 0, 0.25, 0.75}, to[] = {2, 2, 1};
    double *moved[2];
    int32_t k;
    for (k = 0; k < 2; ++k) {
        gproj_mesh *mesh = gprojt_roof(4, 0);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_handles handles;
        gproj_drag *drag;
        size_t size = 3 * (size_t)mesh->vertex_count * sizeof(double);
        int64_t from_zero[] = {0, 2};
        memset(&handles, 0, sizeof handles);
        handles.count = 1;
        handles.start = k ? from_zero : start;
        handles.vertex = k ? vertex + 2 : vertex;
        handles.weight = k ? weight + 2 : weight;
        gproj_add_planarity(form, 1);
        drag = gproj_drag_begin(form, &handles, NULL, NULL);
        GPROJT_REQUIRE(drag && gproj_drag_move(drag, to) == GPROJ_OK);
        moved[k] = (double *)malloc(size);
        memcpy(moved[k], mesh->position, size);
        if (k) GPROJT_CHECK(memcmp(moved[0], moved[1], size) == 0);
        gproj_drag_cancel(drag);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    free(moved[0]), free(moved[1]);
}

GPROJT_TEST(refused) {
    static const int64_t start[] = {0, 1, 0}, beyond[] = {0, 3, 2}, empty[] = {0, 0}, late[] = {-1, 0};
    static const double none[] = {0, 0}, endless[] = {HUGE_VAL, 1};
    static const double astray[] = {0, 0, 0, 0, NAN, 0}, far[] = {0, 0, -1e71};
    static const int32_t outside[] = {3, 99}, before[] = {-3}, two[] = {3, 4};
    gproj_mesh *mesh = gprojt_roof(4, 0);
    gproj_form *form = gproj_form_create(mesh, NULL), *standing;
    gproj_handles handles = gprojt_vertex_handles(2, two);
    gproj_drag_options options;
    gproj_drag *drag;
    memset(&options, 0, sizeof options);
    gprojt_check_refusal(form, NULL, NULL, GPROJ_ERROR_ARGUMENT, "no handles");
    handles.count = 0;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_ARGUMENT, "no handles");
    handles = gprojt_vertex_handles(2, outside);
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_INDEX, "handle 1: there is no vertex 99");
    handles = gprojt_vertex_handles(1, before);
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_INDEX, "handle 0: there is no vertex -3");
    handles.vertex = NULL;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_ARGUMENT, "no handles");
    handles = gprojt_vertex_handles(INT32_MAX, two); /* so many that their products would overflow */
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_ARGUMENT, "no handles");
    handles = gprojt_vertex_handles(2, two);
    handles.start = start;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_ARGUMENT, "the list of handle 1");
    handles.start = beyond; /* no entry is read before all starts are known to ascend */
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_ARGUMENT, "the list of handle 1");
    handles.count = 1;
    handles.start = empty;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_NUMBER, "the weights of handle 0");
    handles.start = late;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_ARGUMENT, "the list of handle 0");
    handles.start = NULL;
    handles.weight = none;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_NUMBER, "the weights of handle 0");
    handles.weight = endless;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_NUMBER, "the weights of handle 0");
    handles.weight = NULL;
    handles.count = 2;
    handles.position = astray;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_NUMBER, "coordinate y of handle 1");
    handles.count = 1;
    handles.position = far;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_NUMBER, "beyond 1e70");
    handles.position = NULL;
    options.residual_bound = -1;
    gprojt_check_refusal(form, &handles, &options, GPROJ_ERROR_ARGUMENT, "a residual bound of -1");
    options.residual_bound = NAN;
    gprojt_check_refusal(form, &handles, &options, GPROJ_ERROR_ARGUMENT, "a residual bound of ");
    gprojt_check_refusal(NULL, &handles, NULL, GPROJ_ERROR_MEMORY, "there is no object");
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
    standing = gprojt_design(mesh, GPROJT_STANDING, NULL);
    gprojt_check_refusal(standing, &handles, NULL, GPROJ_ERROR_STATE, "forces have no values");
    gproj_set_schedule(standing, 1, gproj_keep(0)); /* equilibrium that is not asked for needs none */
    drag = gproj_drag_begin(standing, &handles, NULL, NULL);
    GPROJT_CHECK(drag && !strcmp(gproj_form_group_info(standing, 1).name, "equilibrium"));
    gproj_drag_cancel(drag);
    gproj_form_destroy(standing);
    mesh->position[4] = HUGE_VAL;
    gprojt_check_refusal(form, &handles, NULL, GPROJ_ERROR_NUMBER, "vertex 1");
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A drag may be cancelled although what was added meanwhile has failed, and lacks arrays. */
static bool gprojt_add_amid_a_drag(const gproj_host *host, void *user) {
    gproj_mesh *mesh = gprojt_roof(4, 0);
    gproj_form *form = gproj_form_create(mesh, host);
    int32_t v = 3, k, pins[5] = {0, 1, 2, 3, 4};
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_supports supports;
    gproj_loads loads;
    gproj_drag *drag;
    bool done;
    memset(&loads, 0, sizeof loads);
    memset(&supports, 0, sizeof supports);
    supports.count = 5, supports.vertex = pins;
    gproj_add_planarity(form, 1);
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    k = gproj_add_equilibrium(form, &loads, &supports, 1);
    done = drag && k >= 0;
    GPROJT_CHECK(done || gproj_form_error(form)->code == GPROJ_ERROR_MEMORY || !drag);
    gproj_drag_cancel(drag);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    *(int32_t *)user += !done;
    return done;
}

GPROJT_TEST(cancelled_after_a_failed_addition) {
    int32_t failed = 0;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_add_amid_a_drag, &failed) > 50 && failed > 50);
}

/* Additions amid a drag: no variables are none, which the drag does not notice; the system may be solved meanwhile; rows in a
   release make it end, and when it is cancelled the schedules are those before it. */
GPROJT_TEST(additions_amid_a_drag) {
    gproj_mesh *mesh = gprojt_noisy(0, 4, 0.05, 3);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_system *s = gproj_form_system(form);
    int32_t v = 12, fairness, k;
    double to[3];
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag_options options;
    gproj_drag *drag;
    memset(&options, 0, sizeof options);
    options.residual_bound = 1;
    gproj_add_planarity(form, 1);
    fairness = gproj_add_fairness(form, 0.2);
    gproj_solve(form, 20, NULL);
    drag = gproj_drag_begin(form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    GPROJT_CHECK(gproj_system_add_variables(s, 0, 1, NULL) >= 0);
    GPROJT_CHECK(gproj_drag_residual(drag) < 1e-9);
    gproj_system_solve(s, 3, NULL); /* by multipliers: another matrix */
    memcpy(to, mesh->position + 3 * v, sizeof to);
    to[2] += 0.3 * gprojt_unit(form);
    GPROJT_CHECK(gproj_drag_move(drag, to) == GPROJ_OK && gproj_drag_residual(drag) < 1);
    GPROJT_CHECK(gproj_drag_release(drag));
    gproj_solve_advance(form, 0);
    gproj_add_fixed_boundary(form, 1);
    gproj_drag_cancel(drag);
    GPROJT_CHECK(gproj_form_group_info(form, fairness).schedule.weight == 0.2);
    for (k = 0; k < gproj_system_group_count(s); ++k)
        if (!strcmp(gproj_form_group_info(form, k).name, "drag handles"))
            GPROJT_CHECK(gproj_form_group_info(form, k).schedule.weight == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Beside a solve that is on no drag begins, and no state is restored, though a callback asks for it. */
typedef struct gprojt_asker {
    gproj_form *form;
    uint8_t *state;
    size_t size;
    int32_t vertex, asked;
} gprojt_asker;

static bool gprojt_ask_in_solve(void *user, gproj_system *system, const gproj_iteration *iteration) {
    gprojt_asker *asker = (gprojt_asker *)user;
    gproj_handles handles = gprojt_vertex_handles(1, &asker->vertex);
    gproj_error error;
    (void)system, (void)iteration;
    gprojt_check_refusal(asker->form, &handles, NULL, GPROJ_ERROR_STATE, "a solve or another drag is under way");
    GPROJT_CHECK(gproj_state_restore(asker->form, asker->state, asker->size, &error) == GPROJ_ERROR_STATE);
    GPROJT_CHECK(strstr(error.message, "a solve or a drag is under way"));
    asker->asked++;
    return true;
}

GPROJT_TEST(refused_in_a_solve) {
    gproj_mesh *mesh = gprojt_roof(5, 0.05);
    gproj_form *form = gprojt_design(mesh, GPROJT_PLANAR, NULL);
    gproj_solve_options options;
    gprojt_asker asker;
    memset(&options, 0, sizeof options);
    asker.form = form, asker.vertex = gprojt_middle(mesh), asker.asked = 0;
    asker.state = gprojt_save(form, &asker.size);
    options.on_iteration = gprojt_ask_in_solve, options.user = &asker;
    GPROJT_CHECK(gproj_solve(form, 40, &options).outcome == GPROJ_CONVERGED && asker.asked > 1);
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
    free(asker.state);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Start values of unknowns that are none when a drag begins: there is no drag, and the mesh stays. */
static void gprojt_start_badly(void *user, const gproj_mesh *mesh, int32_t first, int32_t count, double *values) {
    (void)mesh, (void)first, (void)count;
    if (*(const bool *)user) values[0] = NAN;
}

GPROJT_TEST(unknowns_without_start) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(4, 0.05), GPROJT_PLANAR, NULL);
    int32_t v = gprojt_middle(stage.mesh), group;
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    double one = 1;
    bool bad = false;
    group = gproj_add_rows(stage.form, "mine", GPROJ_WISH, GPROJ_PLACE_NONE, 1);
    gproj_form_add_unknowns(stage.form, group, GPROJ_UNIT_LENGTH, 1, &one, gprojt_start_badly, &bad);
    gproj_drag_cancel(gprojt_grab(&stage, 1, &v));
    bad = true;
    gprojt_check_refusal(stage.form, &handles, NULL, GPROJ_ERROR_NUMBER, "mine: the start value of unknown");
    GPROJT_CHECK(gprojt_unmoved(stage.mesh, stage.start) && gproj_form_error(stage.form)->code == GPROJ_ERROR_NUMBER);
    gprojt_clear_stage(&stage);
}

/* A refresh of the caller's that fails during a move: this move is undone, the error told, and nothing moves any more. */
static void gprojt_refresh_badly(void *user, gproj_system *system, int32_t group, const gproj_progress *progress) {
    (void)group, (void)progress;
    if (*(const bool *)user) gproj_system_add_variables(system, 1, 1, NULL);
}

GPROJT_TEST(refreshes_that_fail_in_a_move) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(4, 0.05), GPROJT_PLANAR, NULL);
    int32_t v = gprojt_middle(stage.mesh);
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag_options options;
    gproj_group group;
    gproj_drag *drag;
    double *kept, p[3];
    bool bad = false;
    memset(&options, 0, sizeof options);
    memset(&group, 0, sizeof group);
    group.name = "mine", group.schedule = gproj_keep(1), group.refresh = gprojt_refresh_badly,
    group.refresh_user = &bad;
    gprojt_add_linear(gproj_form_system(stage.form), gproj_system_add_group(gproj_form_system(stage.form), &group), 0,
                      0, 0, -1);
    options.residual_bound = 1e-9;
    drag = gproj_drag_begin(stage.form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    gprojt_pull(&stage, drag, v, 0.1 * stage.edge);
    kept = gprojt_keep(stage.mesh);
    bad = true;
    memcpy(p, stage.start + 3 * v, sizeof p);
    p[2] += 0.3;
    GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_ERROR_STATE && gproj_drag_error(drag)->code == GPROJ_ERROR_STATE);
    GPROJT_CHECK(gprojt_unmoved(stage.mesh, kept) && gproj_drag_get_info(drag).freedom == 0);
    GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_FAILED && gprojt_unmoved(stage.mesh, stage.start));
    free(kept);
    gprojt_clear_stage(&stage);
}

/* Whichever of a move's refreshes it is that fails, also where the move has led too far and goes on from the mesh before the
   drag: the move is undone, and in the end the mesh is as before. */
typedef struct gprojt_fuse {
    int32_t calls, fail_at; /* 0: never */
} gprojt_fuse;

static void gprojt_refresh_once_badly(void *user, gproj_system *system, int32_t group, const gproj_progress *progress) {
    gprojt_fuse *fuse = (gprojt_fuse *)user;
    (void)group, (void)progress;
    if (++fuse->calls == fuse->fail_at) gproj_system_add_variables(system, 1, 1, NULL);
}

GPROJT_TEST(any_refresh_of_a_move_may_fail) {
    int32_t fail, most = 1;
    for (fail = 0; fail <= most; ++fail) {
        gprojt_stage stage = gprojt_set_stage(gprojt_roof(4, 0.05), GPROJT_PLANAR, NULL);
        gproj_system *system = gproj_form_system(stage.form);
        int32_t v = gprojt_middle(stage.mesh);
        gproj_handles handles = gprojt_vertex_handles(1, &v);
        gproj_drag_options options;
        gprojt_fuse fuse = {0, 0};
        gproj_group group;
        gproj_drag *drag;
        double *kept, p[3];
        memset(&options, 0, sizeof options);
        memset(&group, 0, sizeof group);
        group.name = "mine", group.schedule = gproj_keep(1);
        group.refresh = gprojt_refresh_once_badly, group.refresh_user = &fuse;
        gprojt_add_linear(system, gproj_system_add_group(system, &group), 0, 0, 0, -1);
        options.residual_bound = 1e-9;
        drag = gproj_drag_begin(stage.form, &handles, &options, NULL);
        GPROJT_REQUIRE(drag);
        gprojt_pull(&stage, drag, v, 0.1 * stage.edge);
        kept = gprojt_keep(stage.mesh);
        memcpy(p, stage.start + 3 * v, sizeof p);
        p[2] += 1000 * stage.edge;
        fuse.calls = 0, fuse.fail_at = fail;
        GPROJT_CHECK(gproj_drag_move(drag, p) == (fail ? GPROJ_ERROR_STATE : GPROJ_OK));
        GPROJT_CHECK(gproj_drag_error(drag)->code == (fail ? GPROJ_ERROR_STATE : GPROJ_OK));
        GPROJT_CHECK(gprojt_unmoved(stage.mesh, kept) == (fail > 0));
        if (!fail) { /* also one that is asked for */
            most = fuse.calls, fuse.fail_at = most + 1;
            GPROJT_CHECK(gproj_drag_residual(drag) == HUGE_VAL);
            GPROJT_CHECK(gproj_drag_error(drag)->code == GPROJ_ERROR_STATE);
        }
        GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_FAILED && gprojt_unmoved(stage.mesh, stage.start));
        free(kept);
        gprojt_clear_stage(&stage);
    }
    GPROJT_CHECK(most > 2);
}

/* A row that is harmless below a height of the dragged vertex, and has a coefficient beyond all measure above it. */
typedef struct gprojt_ceiling {
    int32_t coordinate;
    double most;
} gprojt_ceiling;

static void gprojt_refresh_ceiling(void *user, gproj_system *system, int32_t group, const gproj_progress *progress) {
    const gprojt_ceiling *ceiling = (const gprojt_ceiling *)user;
    double a = gproj_system_values(system)[ceiling->coordinate] > ceiling->most ? 1e200 : 1;
    (void)progress;
    gproj_system_set_row(system, group, 0, &a, 0);
}

/* A move that cannot be made changes nothing of what comes after it: back at the handle's place the mesh is where it was,
   with what it lacked to be planar. */
GPROJT_TEST(moves_that_are_undone) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(4, 0.05), GPROJT_PLANAR, NULL);
    gproj_system *system = gproj_form_system(stage.form);
    int32_t v = gprojt_middle(stage.mesh);
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gprojt_ceiling ceiling;
    gproj_drag_options options;
    gproj_group group;
    gproj_drag *drag;
    double *kept, p[3], residual, bound;
    memset(&options, 0, sizeof options);
    memset(&group, 0, sizeof group);
    ceiling.coordinate = 3 * v + 2, ceiling.most = HUGE_VAL;
    group.name = "ceiling", group.schedule = gproj_keep(1);
    group.refresh = gprojt_refresh_ceiling, group.refresh_user = &ceiling;
    gprojt_add_linear(system, gproj_system_add_group(system, &group), gproj_system_add_variables(system, 1, 1, NULL), 1,
                      0, -1);
    options.residual_bound = bound = 0.02;
    drag = gproj_drag_begin(stage.form, &handles, &options, NULL);
    GPROJT_REQUIRE(drag);
    gprojt_pull(&stage, drag, v, 0.1 * stage.edge);
    kept = gprojt_keep(stage.mesh);
    residual = gproj_drag_residual(drag);
    GPROJT_CHECK(residual > 0.05 * bound && residual < bound && gproj_drag_get_info(drag).linearisations == 1);
    ceiling.most = gproj_system_values(system)[3 * v + 2] + 0.1;
    memcpy(p, stage.start + 3 * v, sizeof p);
    p[2] += 4 * stage.edge;
    GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_ERROR_NUMBER && gprojt_unmoved(stage.mesh, kept));
    GPROJT_CHECK(gproj_drag_get_info(drag).freedom == 3);
    gprojt_pull(&stage, drag, v, 0.1 * stage.edge);
    GPROJT_CHECK(gprojt_largest_move(stage.mesh->position, kept, stage.mesh->vertex_count) < 1e-11);
    GPROJT_NEAR(gproj_drag_residual(drag), residual, 1e-11);
    gproj_drag_cancel(drag);
    free(kept);
    gprojt_clear_stage(&stage);
}

GPROJT_TEST(misused) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(5, 0.05), GPROJT_PLANAR, NULL);
    int32_t v = gprojt_middle(stage.mesh);
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag *drag = gprojt_grab(&stage, 1, &v);
    size_t size;
    uint8_t *state = gprojt_save(stage.form, &size);
    gproj_error error;
    double p[3];
    memcpy(p, stage.start + 3 * v, sizeof p);
    gprojt_check_refusal(stage.form, &handles, NULL, GPROJ_ERROR_STATE, "another drag is under way");
    GPROJT_CHECK(strstr(gproj_solve(stage.form, 5, NULL).message, "a drag is under way"));
    GPROJT_CHECK(!gproj_solve_begin(stage.form, 5, NULL, &error) && error.code == GPROJ_ERROR_STATE);
    GPROJT_CHECK(strstr(gproj_solve_advance(stage.form, 0).message, "a drag is under way"));
    GPROJT_CHECK(gproj_state_restore(stage.form, state, size, &error) == GPROJ_ERROR_STATE);
    GPROJT_CHECK(strstr(error.message, "a drag is under way"));
    p[1] = HUGE_VAL;
    GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(strstr(gproj_drag_error(drag)->message, "handle 0"));
    p[1] = -1e100;
    GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(strstr(gproj_drag_error(drag)->message, "beyond 1e70"));
    GPROJT_CHECK(gproj_drag_move(drag, NULL) == GPROJ_ERROR_ARGUMENT);
    gprojt_pull(&stage, drag, v, 0.1); /* that was no harm */
    gproj_add_fairness(stage.form, 0.1);
    memcpy(p, stage.start + 3 * v, sizeof p);
    GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_ERROR_STATE);
    GPROJT_CHECK(strstr(gproj_drag_error(drag)->message, "rows were added"));
    GPROJT_CHECK(gproj_drag_residual(drag) == HUGE_VAL);
    GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_drag_end(NULL).outcome == GPROJ_FAILED);
    GPROJT_CHECK(gproj_drag_move(NULL, p) == GPROJ_ERROR_ARGUMENT && gproj_drag_residual(NULL) == 0);
    GPROJT_CHECK(gproj_drag_get_info(NULL).handles == 0 && gproj_drag_memory(NULL).used == 0);
    GPROJT_CHECK(gproj_drag_error(NULL)->code != GPROJ_OK);
    gproj_drag_cancel(NULL);
    memcpy(stage.start, stage.mesh->position, 3 * (size_t)stage.mesh->vertex_count * sizeof *stage.start);
    drag = gprojt_grab(&stage, 1, &v);
    gprojt_pull(&stage, drag, v, 0.1);
    gproj_add_fairness(stage.form, 0.1);
    gproj_drag_cancel(drag); /* the mesh at least is as before */
    GPROJT_CHECK(
        memcmp(stage.start, stage.mesh->position, 3 * (size_t)stage.mesh->vertex_count * sizeof *stage.start) == 0);
    free(state);
    gprojt_clear_stage(&stage);
}

/* A release that is at its limit says what goes on, and that does: Newton's method goes an eighth of the way to z^8 = 0
   in a step. */
GPROJT_TEST(releases_that_need_longer) {
    static const double one[4] = {1, 1, 1, 1};
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(4, 0.05), GPROJT_PLAIN, NULL);
    gproj_system *s = gproj_form_system(stage.form);
    int32_t v = gprojt_middle(stage.mesh), z = gproj_system_add_variables(s, 4, 1, one), k;
    int32_t group = gprojt_add_group(s, "root", GPROJ_CONSTRAINT, 1);
    gproj_term term[2];
    gproj_drag *drag;
    gproj_result result;
    double dragged[75], residual;
    for (k = 0; k < 3; ++k) {
        term[0] = gprojt_term(z + k + 1, -1, 1), term[1] = gprojt_term(z + k, z + k, -1);
        gproj_system_add_row(s, group, 2, term, 0, -1);
    }
    gprojt_add_linear(s, group, z + 3, 1e6, 0, -1);
    drag = gprojt_grab(&stage, 1, &v);
    gprojt_pull(&stage, drag, v, 0.1);
    result = gproj_drag_end(drag);
    residual = result.residual;
    GPROJT_CHECK(result.outcome == GPROJ_ITERATION_LIMIT);
    GPROJT_CHECK(strstr(result.message, "; gproj_solve goes on from here") != NULL);
    memcpy(dragged, stage.mesh->position, sizeof dragged);
    result = gproj_solve(stage.form, 100, NULL);
    GPROJT_CHECK(result.residual < 0.5 * residual && gprojt_far(dragged + 3 * v, stage.start + 3 * v) > 0.05);
    for (k = 0; k < 75; ++k) GPROJT_NEAR(stage.mesh->position[k], dragged[k], 1e-9);
    gprojt_clear_stage(&stage);
}

/* Numbers beyond all measure are no tangent space; a form that has met an error is not dragged on. */
GPROJT_TEST(what_cannot_be_linearised) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(4, 0.05), GPROJT_PLANAR, NULL);
    gproj_system *s;
    int32_t v = gprojt_middle(stage.mesh), outside = 99, group;
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    gproj_drag *drag = gprojt_grab(&stage, 1, &v);
    gproj_add_fixed(stage.form, 1, &outside, 1);
    GPROJT_CHECK(gproj_drag_move(drag, stage.start) == GPROJ_ERROR_INDEX);
    GPROJT_CHECK(strstr(gproj_drag_error(drag)->message, "no vertex 99"));
    GPROJT_CHECK(strstr(gproj_drag_end(drag).message, "no vertex 99"));
    gprojt_clear_stage(&stage);
    stage = gprojt_set_stage(gprojt_roof(4, 0.05), GPROJT_PLANAR, NULL);
    s = gproj_form_system(stage.form);
    group = gprojt_add_group(s, "huge", GPROJ_CONSTRAINT, 1);
    gprojt_add_linear(s, group, 3 * v, 1e200, 0, 0);
    gprojt_check_refusal(stage.form, &handles, NULL, GPROJ_ERROR_NUMBER, "cannot be linearised");
    GPROJT_CHECK(gprojt_unmoved(stage.mesh, stage.start) && gproj_form_error(stage.form)->code == GPROJ_OK);
    gprojt_clear_stage(&stage);
}

/* The form's own wishes are put back after a release, and guide during it where that is asked for. */
GPROJT_TEST(wishes_at_the_release) {
    double far[2];
    int keep;
    for (keep = 0; keep < 2; ++keep) {
        gproj_mesh *mesh = gprojt_roof(6, 0);
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t v = gprojt_middle(mesh), closeness = gproj_add_closeness(form, 5);
        gproj_handles handles = gprojt_vertex_handles(1, &v);
        gproj_drag_options options;
        gproj_drag *drag;
        double *start = gprojt_keep(mesh), p[3];
        memset(&options, 0, sizeof options);
        options.keep_wishes = keep;
        drag = gproj_drag_begin(form, &handles, &options, NULL);
        memcpy(p, start + 3 * v, sizeof p);
        p[2] += 1;
        gproj_drag_move(drag, p);
        gproj_drag_end(drag);
        far[keep] = gprojt_far(mesh->position + 3 * v, start + 3 * v);
        GPROJT_CHECK(gproj_form_group_info(form, closeness).schedule.weight == 5);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(start);
    }
    GPROJT_CHECK(far[0] > 0.95 && far[1] < 0.3);
}

/* -- releases in frames -- */

/* Frames give the bytes of one gproj_drag_end, also where it takes the iterations that are left. */
GPROJT_TEST(releases_in_frames) {
    int design, frames;
    for (design = 0; design < GPROJT_DESIGNS; ++design) {
        size_t size = 0, more;
        uint8_t *wanted = NULL, *state;
        gproj_result result, first;
        memset(&first, 0, sizeof first);
        for (frames = 0; frames < 3; ++frames) {
            gprojt_stage stage = gprojt_set_stage(gprojt_roof(6, 0.05), design, NULL);
            int32_t v = gprojt_middle(stage.mesh), k;
            gproj_drag *drag = gprojt_grab(&stage, 1, &v);
            gprojt_pull(&stage, drag, v, 0.4);
            if (frames > 0) {
                GPROJT_CHECK(gproj_drag_release(drag) && gproj_solve_is_on(stage.form));
                GPROJT_CHECK(gprojt_unmoved(stage.mesh, stage.start));
                for (k = 0; gproj_solve_is_on(stage.form) && (frames == 1 || k < 2); ++k)
                    gproj_solve_advance(stage.form, 0);
                GPROJT_CHECK(gproj_solve_is_on(stage.form) == (frames == 2) && k > 1);
            }
            result = gproj_drag_end(drag);
            GPROJT_CHECK(strstr(gproj_solve_advance(stage.form, 0).message, "nothing is under way"));
            state = gprojt_save(stage.form, &more);
            if (frames == 0) {
                wanted = state, size = more, first = result;
            } else {
                GPROJT_CHECK(size == more && memcmp(wanted, state, size) == 0);
                GPROJT_CHECK(result.outcome == first.outcome && result.iterations == first.iterations);
                GPROJT_CHECK(result.residual == first.residual && strcmp(result.message, first.message) == 0);
                free(state);
            }
            gprojt_clear_stage(&stage);
        }
        free(wanted);
    }
}

/* Another solve is refused during a release, which ends where it is, and tells after how many iterations. */
GPROJT_TEST(releases_end_with_other_solves) {
    int way;
    for (way = 0; way < 3; ++way) {
        gprojt_stage stage = gprojt_set_stage(gprojt_roof(6, 0.05), GPROJT_PLANAR, NULL);
        int32_t v = gprojt_middle(stage.mesh);
        gproj_drag *drag = gprojt_grab(&stage, 1, &v);
        gproj_solve_options options;
        gproj_result result;
        gproj_error error;
        double *now;
        memset(&options, 0, sizeof options);
        options.smooth = way == 1;
        gprojt_pull(&stage, drag, v, 0.4);
        GPROJT_CHECK(gproj_drag_release(drag));
        gproj_solve_advance(stage.form, 0);
        if (way > 0) gproj_solve_advance(stage.form, 0);
        now = gprojt_keep(stage.mesh);
        if (way < 2) {
            result = gproj_solve(stage.form, 10, &options);
            GPROJT_CHECK(result.outcome == GPROJ_FAILED && result.attempts == 0);
        } else {
            GPROJT_CHECK(!gproj_solve_begin(stage.form, 10, NULL, &error) && error.code == GPROJ_ERROR_STATE);
        }
        GPROJT_CHECK(!gproj_solve_is_on(stage.form));
        result = gproj_drag_end(drag);
        GPROJT_CHECK(result.outcome == GPROJ_CANCELLED && result.iterations == (way ? 2 : 1) && result.residual > 0);
        GPROJT_CHECK(strstr(result.message, way ? "after 2 iterations, " : "after 1 iteration, "));
        GPROJT_CHECK(gprojt_unmoved(stage.mesh, now));
        free(now);
        gprojt_clear_stage(&stage);
    }
}

/* A release that has ended is neither stopped nor refused any more. */
GPROJT_TEST(releases_that_have_ended) {
    gprojt_stage stage = gprojt_set_stage(gprojt_roof(6, 0.05), GPROJT_PLANAR, NULL);
    int32_t v = gprojt_middle(stage.mesh);
    gproj_drag *drag = gprojt_grab(&stage, 1, &v);
    gproj_result verdict, result;
    gprojt_pull(&stage, drag, v, 0.4);
    GPROJT_CHECK(gproj_drag_release(drag));
    do verdict = gproj_solve_advance(stage.form, 0);
    while (gproj_solve_is_on(stage.form));
    gproj_solve_stop(stage.form);
    GPROJT_CHECK(gproj_solve(stage.form, 10, NULL).outcome == GPROJ_FAILED);
    result = gproj_drag_end(drag);
    GPROJT_CHECK(result.outcome == verdict.outcome && strcmp(result.message, verdict.message) == 0);
    gprojt_clear_stage(&stage);
}

/* A release may be cancelled, and stopped; the wishes have their weights again afterwards. */
GPROJT_TEST(releases_cancelled_and_stopped) {
    int stopped;
    for (stopped = 0; stopped < 2; ++stopped) {
        gprojt_stage stage = gprojt_set_stage(gprojt_roof(6, 0.05), GPROJT_PLANAR, NULL);
        int32_t v = gprojt_middle(stage.mesh), wish = gproj_add_closeness(stage.form, 5);
        gproj_drag *drag = gprojt_grab(&stage, 1, &v);
        gproj_schedule none = {0, 0, 0};
        double p[3] = {0, 0, 0}, *now;
        gprojt_pull(&stage, drag, v, 0.4);
        GPROJT_CHECK(gproj_drag_release(drag) && !gproj_drag_release(drag));
        GPROJT_CHECK(gproj_form_group_info(stage.form, wish).schedule.weight == 0);
        gproj_solve_advance(stage.form, 0);
        gproj_solve_advance(stage.form, 0);
        GPROJT_CHECK(!gprojt_unmoved(stage.mesh, stage.start));
        GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_ERROR_STATE);
        GPROJT_CHECK(strstr(gproj_drag_error(drag)->message, "have been released"));
        now = gprojt_keep(stage.mesh);
        if (stopped) gproj_solve_stop(stage.form);
        if (stopped) GPROJT_CHECK(gproj_drag_end(drag).outcome == GPROJ_CANCELLED);
        if (!stopped) gproj_drag_cancel(drag);
        GPROJT_CHECK(!gproj_solve_is_on(stage.form) && gprojt_unmoved(stage.mesh, stopped ? now : stage.start));
        GPROJT_CHECK(gproj_form_group_info(stage.form, wish).schedule.weight == 5);
        gproj_set_schedule(stage.form, wish, none);
        GPROJT_CHECK(gproj_solve(stage.form, 40, NULL).outcome == GPROJ_CONVERGED);
        free(now);
        gprojt_clear_stage(&stage);
    }
    GPROJT_CHECK(!gproj_drag_release(NULL));
}

/* -- reach -- */

/* On a plane grid with edges of length 1 the distance is |di| + |dj|. */
GPROJT_TEST(handles_with_reach) {
    enum {
        SIDE = 9,
        COUNT = SIDE * SIDE
    };
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(SIDE - 1, SIDE - 1));
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t list[COUNT], count, k, middle = COUNT / 2, near = 0, v;
    double weight[COUNT], before = 0;
    for (v = 0; v < COUNT; ++v)
        mesh->position[3 * v] = v / SIDE, mesh->position[3 * v + 1] = v % SIDE, mesh->position[3 * v + 2] = 0;
    count = gproj_find_reach(form, middle, 3, list, weight);
    GPROJT_CHECK(list[0] == middle && weight[0] == 1);
    for (k = 0; k < count; ++k) {
        double d = abs(list[k] / SIDE - middle / SIDE) + abs(list[k] % SIDE - middle % SIDE), t = d / 3;
        GPROJT_CHECK(d < 3 && d >= before && fabs(weight[k] - (1 - t * t) * (1 - t * t)) < 1e-12);
        before = d;
    }
    for (v = 0; v < COUNT; ++v) near += abs(v / SIDE - middle / SIDE) + abs(v % SIDE - middle % SIDE) < 3;
    GPROJT_CHECK(count == near && count == 13);
    GPROJT_CHECK(gproj_find_reach(form, 0, 2.5, list, weight) == 6); /* a corner */
    GPROJT_CHECK(gproj_find_reach(form, 4, 1e9, list, weight) == COUNT);
    GPROJT_CHECK(gproj_find_reach(form, middle, 0, list, weight) == 1 && list[0] == middle && weight[0] == 1);
    GPROJT_CHECK(gproj_find_reach(form, middle, -1, list, weight) == 1);
    GPROJT_CHECK(gproj_find_reach(form, COUNT, 3, list, weight) == 0 &&
                 gproj_find_reach(form, -1, 3, list, weight) == 0);
    GPROJT_CHECK(gproj_find_reach(form, middle, 3, NULL, weight) == 0);
    GPROJT_CHECK(gproj_find_reach(NULL, middle, 3, list, weight) == 0);
    GPROJT_CHECK(gproj_find_reach(form, middle, 3, list, NULL) == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    { /* a vertex without faces reaches itself */
        gprojt_soup soup = gprojt_quad_grid(2, 2);
        v = gprojt_add_vertex(&soup, 0.1, 0.1, 0);
        mesh = gprojt_mesh_of(soup);
        form = gproj_form_create(mesh, NULL);
        GPROJT_CHECK(gproj_find_reach(form, v, 9, list, weight) == 1 && list[0] == v && weight[0] == 1);
        GPROJT_CHECK(gproj_find_reach(form, 0, 9, list, weight) == 9);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Weights that add up to nothing have no mean: such a handle begins at the origin, and its vertices go apart. */
GPROJT_TEST(handles_of_differences) {
    static const int64_t start[2] = {0, 2};
    static const double weight[2] = {1, -1}, to[3] = {0.1, 0, 0.25};
    gproj_mesh *mesh = gprojt_roof(4, 0.05);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t pair[2] = {3, 17}, v, c;
    double *before = gprojt_keep(mesh);
    gproj_handles handles;
    gproj_drag *drag;
    memset(&handles, 0, sizeof handles);
    handles.count = 1, handles.start = start, handles.vertex = pair, handles.weight = weight;
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    GPROJT_REQUIRE(drag && gproj_drag_move(drag, to) == GPROJ_OK);
    for (v = 0; v < mesh->vertex_count; ++v)
        for (c = 0; c < 3; ++c)
            GPROJT_NEAR(mesh->position[3 * v + c] - before[3 * v + c], v == 3 ? to[c] : v == 17 ? -to[c] : 0, 1e-12);
    gproj_drag_cancel(drag);
    GPROJT_CHECK(gprojt_unmoved(mesh, before));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(before);
}

/* -- failing allocations -- */

static bool gprojt_use_drag(const gproj_host *host, void *user) {
    gproj_mesh *mesh = gprojt_roof(3, 0.02);
    gproj_form *form = gprojt_design(mesh, *(const int *)user, host);
    double *before = NULL;
    int32_t v = gprojt_middle(mesh), list[64];
    gproj_handles handles = gprojt_vertex_handles(1, &v);
    double weight[64];
    gproj_error error;
    gproj_drag *drag;
    bool whole = gproj_solve(form, 20, NULL).outcome != GPROJ_FAILED;
    if (whole) {
        before = gprojt_keep(mesh);
        drag = gproj_drag_begin(form, &handles, NULL, &error);
        whole = drag != NULL;
        GPROJT_CHECK(whole || (error.code == GPROJ_ERROR_MEMORY && gprojt_unmoved(mesh, before)));
        if (drag) whole = gproj_find_reach(form, v, 1e9, list, weight) > 0;
        if (drag) gproj_drag_move(drag, mesh->position);
        if (drag) GPROJT_CHECK(gproj_drag_release(drag) == (gproj_form_error(form)->code == GPROJ_OK));
        if (drag) whole = gproj_drag_end(drag).outcome != GPROJ_FAILED;
        GPROJT_CHECK(whole || gprojt_unmoved(mesh, before));
    }
    GPROJT_CHECK(whole || gproj_form_error(form)->code == GPROJ_ERROR_MEMORY || error.code == GPROJ_ERROR_MEMORY);
    free(before);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return whole;
}

GPROJT_TEST(failing_allocations) {
    int design = GPROJT_GLIDING;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_drag, &design) > 50);
    design = GPROJT_STANDING;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_drag, &design) > 50);
    design = GPROJT_PLANAR; /* solved by multipliers, so that the drag needs another analysis */
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_drag, &design) > 50);
}

/* A solve of the form's system during a drag leaves another matrix, so that a move that linearises needs memory. Without it the
   move is undone: where only the factor's memory fails the drag goes on, else its end, too, puts the mesh back. */
GPROJT_TEST(moves_without_memory) {
    long fail;
    int32_t undone = 0, ended = 0;
    for (fail = 1;; ++fail) {
        gproj_mesh *mesh = gprojt_roof(3, 0.02);
        gprojt_failing failing = {0, 0, 0, 0, 0, 0};
        gproj_host host = gprojt_failing_host(&failing);
        gproj_form *form = gprojt_design(mesh, GPROJT_PLAIN, &host);
        int32_t v = gprojt_middle(mesh);
        gproj_handles handles = gprojt_vertex_handles(1, &v);
        gproj_drag_options options;
        double *before, *kept, p[3];
        bool whole, ready;
        gproj_drag *drag;
        memset(&options, 0, sizeof options);
        options.residual_bound = 1e-12;
        GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED);
        before = gprojt_keep(mesh);
        drag = gproj_drag_begin(form, &handles, &options, NULL);
        GPROJT_REQUIRE(drag);
        memcpy(p, mesh->position + 3 * v, sizeof p);
        p[0] += 0.1, p[2] += 0.2;
        GPROJT_CHECK(gproj_drag_move(drag, p) == GPROJ_OK && !gprojt_unmoved(mesh, before));
        kept = gprojt_keep(mesh);
        gproj_system_solve(gproj_form_system(form), 1, NULL);
        failing.fail_at = failing.calls + fail;
        p[2] += 0.2;
        whole = gproj_drag_move(drag, p) == GPROJ_OK;
        GPROJT_CHECK(whole == (failing.calls < failing.fail_at) && whole == !gprojt_unmoved(mesh, kept));
        GPROJT_CHECK(gproj_drag_error(drag)->code == (whole ? GPROJ_OK : GPROJ_ERROR_MEMORY));
        failing.fail_at = 0;
        ready = gproj_form_error(form)->code == GPROJ_OK;
        GPROJT_CHECK(ready || gproj_form_error(form)->code == GPROJ_ERROR_MEMORY);
        undone += !whole && ready, ended += !whole && !ready;
        GPROJT_CHECK(gproj_drag_move(drag, p) == (ready ? GPROJ_OK : GPROJ_ERROR_MEMORY));
        GPROJT_CHECK(ready == !gprojt_unmoved(mesh, kept));
        GPROJT_CHECK(gproj_drag_end(drag).outcome == (ready ? GPROJ_CONVERGED : GPROJ_FAILED));
        GPROJT_CHECK(ready == !gprojt_unmoved(mesh, before));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        GPROJT_CHECK(failing.held == 0 && failing.bytes == 0 && failing.wrong_sizes == 0);
        free(before), free(kept);
        if (whole) break;
    }
    GPROJT_CHECK(undone > 0 && ended > 0);
}

/* The same bits on any number of threads. */
GPROJT_TEST(same_bits_for_all_workers) {
    double *first = NULL;
    int crew;
    for (crew = 0; crew < GPROJT_CREWS; ++crew) {
        gproj_host host = gprojt_crew(crew);
        gprojt_stage stage = gprojt_set_stage(gprojt_roof(12, 0.05), GPROJT_PLANAR, &host);
        int32_t v = gprojt_middle(stage.mesh);
        gproj_drag *drag = gprojt_grab(&stage, 1, &v);
        gprojt_pull(&stage, drag, v, 0.3);
        gproj_drag_end(drag);
        if (!first) first = gprojt_keep(stage.mesh);
        GPROJT_CHECK(gprojt_unmoved(stage.mesh, first));
        gprojt_clear_stage(&stage);
    }
    free(first);
}

int main(void) {
    GPROJT_RUN(half_a_drag_is_a_quarter_of_the_error);
    GPROJT_RUN(the_first_move_keeps_the_volume);
    GPROJT_RUN(the_change_is_the_smallest);
    GPROJT_RUN(points_of_a_cage);
    GPROJT_RUN(handles_at_their_means);
    GPROJT_RUN(handles_of_any_size_and_order);
    GPROJT_RUN(handles_that_cannot_follow);
    GPROJT_RUN(bounds_at_their_limit_hold);
    GPROJT_RUN(there_and_back);
    GPROJT_RUN(there_and_back_on_intersection);
    GPROJT_RUN(a_closed_loop);
    GPROJT_RUN(releases_turn_no_face_over);
    GPROJT_RUN(a_long_drag);
    GPROJT_RUN(restorations_stay_near);
    GPROJT_RUN(handles_against_what_must_hold);
    GPROJT_RUN(what_cannot_be_restored);
    GPROJT_RUN(restorations_by_far_are_not_made);
    GPROJT_RUN(a_wild_move);
    GPROJT_RUN(a_fast_drag);
    GPROJT_RUN(a_wild_move_leaves_no_trace);
    GPROJT_RUN(callbacks_outlast_drags);
    GPROJT_RUN(moves_allocate_nothing);
    GPROJT_RUN(cancelled_to_the_bit);
    GPROJT_RUN(cancelled_after_additions);
    GPROJT_RUN(lists_that_begin_later);
    GPROJT_RUN(refused);
    GPROJT_RUN(cancelled_after_a_failed_addition);
    GPROJT_RUN(additions_amid_a_drag);
    GPROJT_RUN(refused_in_a_solve);
    GPROJT_RUN(unknowns_without_start);
    GPROJT_RUN(refreshes_that_fail_in_a_move);
    GPROJT_RUN(any_refresh_of_a_move_may_fail);
    GPROJT_RUN(moves_that_are_undone);
    GPROJT_RUN(misused);
    GPROJT_RUN(releases_that_need_longer);
    GPROJT_RUN(what_cannot_be_linearised);
    GPROJT_RUN(wishes_at_the_release);
    GPROJT_RUN(releases_in_frames);
    GPROJT_RUN(releases_end_with_other_solves);
    GPROJT_RUN(releases_that_have_ended);
    GPROJT_RUN(releases_cancelled_and_stopped);
    GPROJT_RUN(handles_with_reach);
    GPROJT_RUN(handles_of_differences);
    GPROJT_RUN(failing_allocations);
    GPROJT_RUN(moves_without_memory);
    GPROJT_RUN(same_bits_for_all_workers);
    return gprojt_report();
}
