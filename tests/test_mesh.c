/* test_mesh.c - >>mesh: building half-edge meshes from arrays, what they promise, and what is refused. */
#include "gprojt_mesh.h"

static void gprojt_check_valid(const gproj_mesh *mesh, const char *name) {
    const char *wrong = gprojt_validate_mesh(mesh);
    if (wrong) {
        printf("  %s: %s\n", name, wrong);
        gprojt_fail(__FILE__, __LINE__, "valid mesh");
    }
}

GPROJT_TEST(generated_meshes) {
    int shape;
    int32_t n;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        for (n = 1; n < 12; n += 3) {
            gprojt_soup s = gprojt_shape(shape, n);
            gproj_error error;
            gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, &error);
            GPROJT_CHECK(mesh != NULL && error.code == GPROJ_OK);
            if (mesh) {
                int32_t euler = mesh->vertex_count - mesh->edge_count + mesh->face_count;
                gprojt_check_valid(mesh, "generated");
                GPROJT_CHECK(mesh->reoriented_count == 0 && mesh->isolated_count == 0 && mesh->component_count == 1);
                GPROJT_CHECK(mesh->loop_count == (shape < 4 ? 1 : (shape == 5 ? 2 : 0)));
                GPROJT_CHECK(euler == (shape < 4 ? 1 : (shape == 6 ? 2 : 0)));
            }
            gproj_mesh_destroy(mesh);
            gprojt_soup_free(&s);
        }
    }
}

GPROJT_TEST(corners_follow_the_input) {
    gprojt_soup s = gprojt_hybrid_grid(5, 4);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    int32_t f, k, c = 0;
    GPROJT_REQUIRE(mesh != NULL);
    for (f = 0; f < s.face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        GPROJT_CHECK(mesh->face_degree[f] == s.degree[f]);
        for (k = 0; k < s.degree[f]; ++k, h = mesh->next[h]) GPROJT_CHECK(mesh->origin[h] == s.corner[c++]);
    }
    GPROJT_CHECK(!memcmp(mesh->position, s.position, (size_t)s.vertex_count * 3 * sizeof(double)));
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

GPROJT_TEST(one_rings) {
    gprojt_soup s = gprojt_quad_grid(2, 2); /* 6 7 8 / 3 4 5 / 0 1 2 */
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    int32_t ring[8], start;
    static const int32_t round[4] = {5, 7, 3, 1};
    GPROJT_REQUIRE(mesh != NULL);
    GPROJT_CHECK(gproj_mesh_one_ring(mesh, 4, ring, 8) == 4);
    for (start = 0; start < 4 && round[start] != ring[0]; ++start) {
    }
    GPROJT_REQUIRE(start < 4);
    GPROJT_CHECK(ring[1] == round[(start + 1) % 4] && ring[2] == round[(start + 2) % 4] &&
                 ring[3] == round[(start + 3) % 4]);
    GPROJT_CHECK(!gproj_mesh_is_boundary_vertex(mesh, 4) && gproj_mesh_is_boundary_vertex(mesh, 1));
    /* boundary: from the first to the last along the faces, counter-clockwise */
    GPROJT_CHECK(gproj_mesh_one_ring(mesh, 1, ring, 8) == 3 && ring[0] == 2 && ring[1] == 4 && ring[2] == 0);
    GPROJT_CHECK(gproj_mesh_one_ring(mesh, 0, ring, 8) == 2 && ring[0] == 1 && ring[1] == 3);
    /* capacity */
    ring[1] = -7;
    GPROJT_CHECK(gproj_mesh_one_ring(mesh, 4, ring, 1) == 4 && ring[1] == -7);
    GPROJT_CHECK(gproj_mesh_one_ring(mesh, 4, NULL, 0) == 4 && gproj_mesh_valence(mesh, 8) == 2);
    GPROJT_CHECK(gproj_mesh_valence(mesh, -1) == 0 && gproj_mesh_valence(mesh, 9) == 0);
    GPROJT_CHECK(!gproj_mesh_is_boundary_vertex(mesh, -1) && !gproj_mesh_is_boundary_vertex(mesh, 9));
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

GPROJT_TEST(flipped_faces_are_turned) {
    uint64_t state = 4;
    int round, shape;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gprojt_soup s = gprojt_shape(shape, 6);
        gproj_mesh *good = gprojt_soup_mesh(&s, NULL, NULL), *mesh, *again;
        for (round = 0; round < 5; ++round) {
            gprojt_soup flipped = gprojt_soup_copy(&s);
            int32_t f, c = 0, k, count = 0;
            for (f = 0; f < s.face_count; c += s.degree[f++]) {
                if (f == 0 || gprojt_below(&state, 3)) continue;
                for (k = 1; k < s.degree[f]; ++k) flipped.corner[c + k] = s.corner[c + s.degree[f] - k];
                ++count;
            }
            mesh = gprojt_soup_mesh(&flipped, NULL, NULL);
            GPROJT_CHECK(mesh != NULL && mesh->reoriented_count == count);
            if (mesh) {
                gprojt_check_valid(mesh, "flipped");
                GPROJT_CHECK(gprojt_same_mesh(mesh, good)); /* the first corner stays, so all is as it was */
                again = gproj_mesh_copy(mesh, NULL, NULL);
                GPROJT_CHECK(again && gprojt_same_mesh(mesh, again));
                gproj_mesh_destroy(again);
            }
            gproj_mesh_destroy(mesh);
            gprojt_soup_free(&flipped);
        }
        gproj_mesh_destroy(good);
        gprojt_soup_free(&s);
    }
}

GPROJT_TEST(odd_but_accepted) {
    gprojt_soup s;
    gproj_mesh *mesh;
    memset(&s, 0, sizeof s);
    /* only vertices */
    gprojt_add_vertex(&s, 0, 0, 0);
    gprojt_add_vertex(&s, 0, 0, 0);
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    gprojt_check_valid(mesh, "only vertices");
    GPROJT_CHECK(mesh->isolated_count == 2 && mesh->component_count == 0 && gproj_mesh_mean_edge_length(mesh) == 0);
    gproj_mesh_destroy(mesh);
    /* a triangle without extent, one without an area, duplicate coordinates, an isolated vertex, two components */
    gprojt_add_vertex(&s, 0, 0, 0);
    gprojt_add_vertex(&s, 1, 0, 0);
    gprojt_add_vertex(&s, 2, 0, 0);
    gprojt_add_vertex(&s, 3, 0, 0);
    gprojt_add_vertex(&s, 9, 9, 9);
    gprojt_add_triangle(&s, 0, 1, 2);
    gprojt_add_triangle(&s, 5, 4, 3);
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    gprojt_check_valid(mesh, "degenerate");
    GPROJT_CHECK(mesh->component_count == 2 && mesh->loop_count == 2 && mesh->isolated_count == 1);
    GPROJT_NEAR(gproj_mesh_mean_edge_length(mesh), 4.0 / 6, 1e-15);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
    /* two faces back to back: a closed pillow */
    s = gprojt_points(1, 1);
    gprojt_add_quad(&s, 0, 1, 3, 2);
    gprojt_add_quad(&s, 0, 1, 3, 2);
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    gprojt_check_valid(mesh, "pillow");
    GPROJT_CHECK(mesh->loop_count == 0 && mesh->reoriented_count == 1 && mesh->edge_count == 4);
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(NULL);
    gprojt_soup_free(&s);
}

GPROJT_TEST(areas_and_lengths) {
    gprojt_soup s = gprojt_points(2, 2);
    static const int32_t ring[8] = {0, 1, 2, 5, 8, 7, 6, 3};
    gproj_mesh *mesh;
    double area[3];
    int32_t i;
    for (i = 0; i < 9; ++i) s.position[3 * i] += 1e6, s.position[3 * i + 2] = 5; /* far away, flat */
    gprojt_add_face(&s, 8, ring);
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    gproj_mesh_face_area_vector(mesh, 0, area);
    GPROJT_NEAR(area[0], 0, 0);
    GPROJT_NEAR(area[2], 1, 1e-9);
    gproj_mesh_face_area_vector(mesh, 1, area);
    GPROJT_CHECK(area[2] == 0);
    GPROJT_NEAR(gproj_mesh_mean_edge_length(mesh), 0.5, 1e-9);
    GPROJT_CHECK(mesh->isolated_count == 1);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

/* NULL answers as an index out of range does. */
GPROJT_TEST(nothing_is_asked) {
    gprojt_soup s = gprojt_quad_grid(2, 2);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    int32_t ring[4] = {7, 7, 7, 7}, i;
    double area[3] = {1, 1, 1};
    GPROJT_REQUIRE(mesh != NULL);
    GPROJT_CHECK(gproj_mesh_valence(NULL, 0) == 0 && gproj_mesh_valence(mesh, -1) == 0);
    GPROJT_CHECK(gproj_mesh_valence(mesh, mesh->vertex_count) == 0);
    GPROJT_CHECK(gproj_mesh_one_ring(NULL, 0, ring, 4) == 0 && gproj_mesh_one_ring(mesh, 99, ring, 4) == 0);
    GPROJT_CHECK(gproj_mesh_one_ring(mesh, 4, NULL, 4) == 4 && gproj_mesh_one_ring(mesh, 4, ring, -1) == 4);
    GPROJT_CHECK(ring[0] == 7);
    GPROJT_CHECK(!gproj_mesh_is_boundary_vertex(NULL, 0) && !gproj_mesh_is_boundary_vertex(mesh, -1));
    gproj_mesh_face_area_vector(NULL, 0, area);
    GPROJT_CHECK(area[0] == 0 && area[1] == 0 && area[2] == 0);
    for (i = 0; i < 2; ++i) {
        area[2] = 1;
        gproj_mesh_face_area_vector(mesh, i ? mesh->face_count : -1, area);
        GPROJT_CHECK(area[2] == 0);
    }
    gproj_mesh_face_area_vector(mesh, 0, NULL);
    GPROJT_CHECK(gproj_mesh_mean_edge_length(NULL) == 0);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

/* One refused array each: code, place, index and a piece of the sentence. */
static void gprojt_refused(const gprojt_soup *s, gproj_code code, gproj_place place, int64_t index, const char *piece) {
    gproj_error error;
    gprojt_failing counting;
    gproj_host host;
    gproj_mesh *mesh;
    memset(&counting, 0, sizeof counting);
    host = gprojt_failing_host(&counting);
    mesh = gprojt_soup_mesh(s, &host, &error);
    if (!gprojt_mesh_was_refused(mesh, &error, code, place, index, piece)) gprojt_fail(__FILE__, __LINE__, piece);
    GPROJT_CHECK(counting.held == 0 && counting.wrong_sizes == 0);
    GPROJT_CHECK(gprojt_soup_mesh(s, NULL, NULL) == NULL);
}

GPROJT_TEST(refused_arrays) {
    gprojt_soup s = gprojt_quad_grid(3, 3), t;
    gproj_error error;
    int32_t i, corner[5];
#define GPROJT_FRESH t = gprojt_soup_copy(&s)
#define GPROJT_DONE gprojt_soup_free(&t)
    GPROJT_FRESH;
    t.corner[9] = -1;
    gprojt_refused(&t, GPROJ_ERROR_INDEX, GPROJ_PLACE_FACE, 2, "face 2 names vertex -1");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.corner[9] = 16;
    gprojt_refused(&t, GPROJ_ERROR_INDEX, GPROJ_PLACE_FACE, 2, "vertices are 0 to 15");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.corner[9] = INT32_MAX;
    gprojt_refused(&t, GPROJ_ERROR_INDEX, GPROJ_PLACE_FACE, 2, "vertex 2147483647");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.degree[4] = 2;
    gprojt_refused(&t, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_FACE, 4, "face 4 has 2 corners");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.degree[4] = -5;
    gprojt_refused(&t, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_FACE, 4, "face 4 has -5 corners");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.degree[4] = INT32_MAX;
    gprojt_refused(&t, GPROJ_ERROR_SIZE, GPROJ_PLACE_FACE, 4, "split the mesh");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.corner[5] = t.corner[7];
    gprojt_refused(&t, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_FACE, 1, "twice");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.position[3 * 7 + 1] = NAN;
    gprojt_refused(&t, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 7, "coordinate y of vertex 7 is nan");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.position[3 * 8 + 2] = -HUGE_VAL;
    gprojt_refused(&t, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 8, "coordinate z of vertex 8 is -inf");
    GPROJT_DONE;
    GPROJT_FRESH;
    t.position[3 * 8] = 1e200;
    gprojt_refused(&t, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 8, "1e+200, beyond");
    GPROJT_DONE;
    GPROJT_FRESH;
    gprojt_add_triangle(&t, 5, 6, gprojt_add_vertex(&t, 0, 0, 1)); /* a fin on an inner edge */
    gprojt_refused(&t, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, 9, "edge 5-6 has 3 faces (1, 4 and 9)");
    gprojt_add_triangle(&t, 6, 5, gprojt_add_vertex(&t, 0, 0, 2));
    gprojt_refused(&t, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, 9, "edge 5-6 has 4 faces (1, 4, 9, ...)");
    GPROJT_DONE;
    GPROJT_FRESH;
    gprojt_add_quad(&t, 5, 6, 10, 9); /* an inner face twice */
    gprojt_refused(&t, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, 9, "edge 5-6");
    GPROJT_DONE;
    GPROJT_FRESH; /* a boundary vertex with two fans */
    i = gprojt_add_vertex(&t, 0, 0, 1);
    gprojt_add_triangle(&t, 0, i, gprojt_add_vertex(&t, 0, 0, 2));
    gprojt_refused(&t, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_VERTEX, 0, "vertex 0 form more than one fan");
    GPROJT_DONE;
    GPROJT_FRESH; /* an inner vertex with a second, closed fan: the tip of a cone */
    i = gprojt_add_vertex(&t, 0, 0, 1), gprojt_add_vertex(&t, 1, 0, 1), gprojt_add_vertex(&t, 0, 1, 1);
    gprojt_add_triangle(&t, 5, i, i + 1), gprojt_add_triangle(&t, 5, i + 1, i + 2),
        gprojt_add_triangle(&t, 5, i + 2, i);
    gprojt_refused(&t, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_VERTEX, 5, "vertex 5 form");
    GPROJT_DONE;
    GPROJT_FRESH; /* an inner vertex and an open fan */
    i = gprojt_add_vertex(&t, 0, 0, 1), gprojt_add_vertex(&t, 1, 0, 1);
    gprojt_add_triangle(&t, 5, i, i + 1);
    gprojt_refused(&t, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_VERTEX, 5, "vertex 5 form");
    GPROJT_DONE;
    /* a Möbius strip of five quads */
    memset(&t, 0, sizeof t);
    for (i = 0; i < 10; ++i) gprojt_add_vertex(&t, i, i & 1, 0);
    for (i = 0; i < 8; i += 2) gprojt_add_quad(&t, i, i + 2, i + 3, i + 1);
    gprojt_add_quad(&t, 8, 1, 0, 9);
    gprojt_refused(&t, GPROJ_ERROR_NON_ORIENTABLE, GPROJ_PLACE_FACE, 3, "outer side");
    GPROJT_DONE;
    /* the projective plane: six vertices, ten triangles */
    {
        static const int32_t plane[30] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 1,
                                          1, 2, 4, 2, 3, 5, 3, 4, 1, 4, 5, 2, 5, 1, 3};
        memset(&t, 0, sizeof t);
        for (i = 0; i < 6; ++i) gprojt_add_vertex(&t, i, i * i, 0);
        for (i = 0; i < 30; i += 3) gprojt_add_face(&t, 3, plane + i);
        gproj_mesh_destroy(gprojt_soup_mesh(&t, NULL, &error));
        GPROJT_CHECK(error.code == GPROJ_ERROR_NON_ORIENTABLE && error.place == GPROJ_PLACE_FACE);
        GPROJT_DONE;
    }
    /* arguments */
    for (i = 0; i < 5; ++i) corner[i] = i;
    GPROJT_CHECK(!gproj_mesh_create(0, s.position, 0, NULL, NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_create(-1, s.position, 0, NULL, NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_create(5, s.position, -1, NULL, NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_create(5, NULL, 0, NULL, NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_create(5, s.position, 1, NULL, corner, NULL, &error) &&
                 error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_create(5, s.position, 1, corner, NULL, NULL, &error) &&
                 error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_create(INT32_MAX, s.position, 0, NULL, NULL, NULL, &error) &&
                 error.code == GPROJ_ERROR_SIZE);
    GPROJT_CHECK(!gproj_mesh_copy(NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_mesh_memory(NULL).used == 0);
    gprojt_soup_free(&s);
}

GPROJT_TEST(random_faces) { /* whatever is accepted is a mesh */
    uint64_t state = 6;
    int i, accepted = 0;
    for (i = 0; i < 20000; ++i) {
        gprojt_soup s = gprojt_random_soup(&state, 4 + gprojt_below(&state, 30), 1 + gprojt_below(&state, 5));
        gproj_error error;
        gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, &error);
        GPROJT_CHECK((mesh != NULL) == (error.code == GPROJ_OK) && (mesh || error.message[0]));
        if (mesh) gprojt_check_valid(mesh, "random"), ++accepted;
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&s);
    }
    GPROJT_CHECK(accepted > 1000);
}

GPROJT_TEST(huge_valence) { /* a fan of 200,000 triangles about one vertex, and one face with 300,000 corners */
    gprojt_soup s;
    gproj_mesh *mesh;
    int32_t i, n = 200000, *corner = (int32_t *)malloc(300000 * sizeof(int32_t));
    memset(&s, 0, sizeof s);
    for (i = 0; i <= n; ++i) gprojt_add_vertex(&s, cos(i * 1e-5), sin(i * 1e-5), 0);
    for (i = 0; i < n - 1; ++i) gprojt_add_triangle(&s, n, i, i + 1);
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    GPROJT_CHECK(mesh && gproj_mesh_valence(mesh, n) == n);
    if (mesh) GPROJT_CHECK(!gprojt_validate_halfedges(mesh) && !gprojt_validate_loops(mesh));
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
    for (i = 0; i < 300000; ++i) corner[i] = gprojt_add_vertex(&s, cos(i * 2e-5), sin(i * 2e-5), 0);
    gprojt_add_face(&s, 300000, corner);
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    GPROJT_CHECK(mesh && mesh->loop_count == 1 && mesh->edge_count == 300000);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
    free(corner);
}

static bool gprojt_make_mesh(const gproj_host *host, void *user) {
    gproj_error error;
    gproj_mesh *mesh = gprojt_soup_mesh((const gprojt_soup *)user, host, &error);
    GPROJT_CHECK(!mesh || gproj_mesh_memory(mesh).allocations == (uint64_t)gprojt_failing_of(host)->calls);
    return gprojt_mesh_was_made(mesh, host, &error);
}

static bool gprojt_make_copy(const gproj_host *host, void *user) {
    const gproj_mesh *mesh = (const gproj_mesh *)user;
    gproj_error error;
    gproj_mesh *copy = gproj_mesh_copy(mesh, host, &error);
    GPROJT_CHECK(!copy || gprojt_same_mesh(copy, mesh));
    return gprojt_mesh_was_made(copy, host, &error);
}

/* The layouts of the mesh data: one bit each. */
enum {
    GPROJT_UNIFORM = 1,
    GPROJT_FLOATS = 2,
    GPROJT_STRIDE = 4,
    GPROJT_SHORTS = 8,
    GPROJT_LAYOUTS = 16
};

/* A soup in a layout: `buffer` gets the positions, which floats hold exactly, `index` the short corners. */
static gproj_mesh_data gprojt_lay_out(const gprojt_soup *s, int layout, char *buffer, uint16_t *index) {
    size_t size = layout & GPROJT_FLOATS ? sizeof(float) : sizeof(double);
    size_t stride = layout & GPROJT_STRIDE ? 5 * size + 3 : 3 * size; /* also at odd addresses */
    gproj_mesh_data data;
    int32_t i, k;
    memset(&data, 0, sizeof data);
    memset(buffer, 0x7f, (size_t)s->vertex_count * 48);
    for (i = 0; i < s->vertex_count; ++i)
        for (k = 0; k < 3; ++k) {
            float number = (float)s->position[3 * i + k];
            char *to = buffer + (size_t)i * stride + (size_t)k * size;
            memcpy(to, layout & GPROJT_FLOATS ? (void *)&number : (void *)&s->position[3 * i + k], size);
        }
    for (i = 0; i < s->corner_count; ++i) index[i] = (uint16_t)s->corner[i];
    data.vertex_count = s->vertex_count, data.face_count = s->face_count;
    if (layout & GPROJT_FLOATS)
        data.float_position = (const float *)(void *)buffer;
    else
        data.position = (const double *)(void *)buffer;
    data.position_stride = layout & GPROJT_STRIDE ? stride : 0;
    data.face_degree = layout & GPROJT_UNIFORM ? NULL : s->degree;
    data.degree = layout & GPROJT_UNIFORM ? s->degree[0] : 0;
    data.face_vertex = layout & GPROJT_SHORTS ? NULL : s->corner;
    data.short_face_vertex = layout & GPROJT_SHORTS ? index : NULL;
    return data;
}

/* Triangles, quads, faces of several degrees: each layout gives the mesh of the plain one. */
GPROJT_TEST(layouts) {
    int kind, layout;
    for (kind = 0; kind < 3; ++kind) {
        gprojt_soup s = kind == 0   ? gprojt_triangle_grid(4, 3)
                        : kind == 1 ? gprojt_quad_grid(4, 3)
                                    : gprojt_hybrid_grid(4, 3);
        gproj_mesh *plain;
        char *buffer = (char *)malloc((size_t)s.vertex_count * 48);
        uint16_t *index = (uint16_t *)malloc((size_t)s.corner_count * sizeof *index);
        int32_t i, f;
        bool uniform = true;
        GPROJT_REQUIRE(buffer && index);
        for (i = 0; i < 3 * s.vertex_count; ++i) s.position[i] = (float)s.position[i];
        for (f = 0; f < s.face_count; ++f) uniform = uniform && s.degree[f] == s.degree[0];
        GPROJT_CHECK(uniform == (kind < 2));
        plain = gprojt_soup_mesh(&s, NULL, NULL);
        for (layout = 0; layout < GPROJT_LAYOUTS; ++layout) {
            gproj_mesh_data data = gprojt_lay_out(&s, layout, buffer, index);
            gproj_error error;
            gproj_mesh *mesh;
            if (!uniform && layout & GPROJT_UNIFORM) continue;
            mesh = gproj_mesh_from_data(&data, NULL, &error);
            GPROJT_CHECK(mesh && error.code == GPROJ_OK && gprojt_same_mesh(mesh, plain));
            gproj_mesh_destroy(mesh);
        }
        gproj_mesh_destroy(plain);
        free(buffer), free(index);
        gprojt_soup_free(&s);
    }
}

static void gprojt_refused_data(const gproj_mesh_data *data, gproj_code code, gproj_place place, int64_t index,
                                const char *says) {
    gproj_error error;
    GPROJT_CHECK(!gproj_mesh_from_data(data, NULL, &error) && error.code == code && error.place == place);
    GPROJT_CHECK(error.index == index && strstr(error.message, says));
    if (!strstr(error.message, says)) printf("    %s\n", error.message);
    GPROJT_CHECK(!gproj_mesh_from_data(data, NULL, NULL));
}

GPROJT_TEST(refused_layouts) {
    float position[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    double exact[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    uint16_t corner[6] = {0, 1, 2, 0, 2, 3};
    int32_t plain[6] = {0, 1, 2, 0, 2, 3}, degree[2] = {3, -1};
    gproj_mesh_data good, data;
    gproj_mesh *mesh;
    memset(&good, 0, sizeof good);
    good.vertex_count = 4, good.float_position = position;
    good.face_count = 2, good.degree = 3, good.short_face_vertex = corner;
    mesh = gproj_mesh_from_data(&good, NULL, NULL);
    GPROJT_CHECK(mesh && mesh->face_count == 2 && mesh->edge_count == 5);
    gproj_mesh_destroy(mesh);
    gprojt_refused_data(NULL, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "there are none");
    data = good, data.vertex_count = 800000000; /* no array is read so far */
    gprojt_refused_data(&data, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "800000000 vertices, more than");
    data = good, data.face_count = -1;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "a mesh of -1 faces");
    data = good, data.float_position = NULL;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "not both");
    data = good, data.position = exact;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "not both");
    data = good, data.position_stride = 8;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "position_stride");
    data = good, data.short_face_vertex = NULL;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "either face_vertex or");
    data = good, data.face_vertex = plain;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "either face_vertex or");
    data = good, data.degree = 0;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "either face_degree or degree");
    data = good, data.degree = 2;
    gprojt_refused_data(&data, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_FACE, 0, "face 0 has 2 corners");
    data = good, data.face_degree = degree;
    gprojt_refused_data(&data, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_FACE, 1, "face 1 has -1 corners");
    data = good, data.vertex_count = 0;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "at least one vertex");
    data = good, data.face_count = -1;
    gprojt_refused_data(&data, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "-1 faces");
    corner[4] = 4;
    gprojt_refused_data(&good, GPROJ_ERROR_INDEX, GPROJ_PLACE_FACE, 1, "face 1 names vertex 4");
    corner[4] = 2, position[7] = NAN;
    gprojt_refused_data(&good, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 2, "vertex 2");
    data = good, data.vertex_count = 2, data.face_count = 0, data.short_face_vertex = NULL;
    mesh = gproj_mesh_from_data(&data, NULL, NULL); /* vertices alone */
    GPROJT_CHECK(mesh && mesh->isolated_count == 2);
    gproj_mesh_destroy(mesh);
}

static bool gprojt_make_from_data(const gproj_host *host, void *user) {
    gproj_error error;
    return gprojt_mesh_was_made(gproj_mesh_from_data((const gproj_mesh_data *)user, host, &error), host, &error);
}

GPROJT_TEST(every_allocation_fails_once) {
    gprojt_soup s = gprojt_tube(7, 3), flipped = gprojt_soup_copy(&s);
    gproj_mesh_data data;
    gproj_mesh *mesh;
    int32_t k = flipped.corner[41];
    flipped.corner[41] = flipped.corner[43], flipped.corner[43] = k;
    mesh = gprojt_soup_mesh(&flipped, NULL, NULL);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_make_mesh, &flipped) >= 10);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_make_copy, mesh) >= 6);
    memset(&data, 0, sizeof data);
    data.vertex_count = s.vertex_count, data.position = s.position;
    data.face_count = s.face_count, data.face_degree = s.degree, data.face_vertex = s.corner;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_make_from_data, &data) >= 10);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&flipped);
    gprojt_soup_free(&s);
}

GPROJT_TEST(a_limit_of_memory) {
    gprojt_soup s = gprojt_tube(7, 3);
    gproj_error error;
    gproj_host host;
    memset(&host, 0, sizeof host);
    host.allocator.limit = 3000;
    GPROJT_CHECK(!gprojt_soup_mesh(&s, &host, &error) && error.code == GPROJ_ERROR_MEMORY);
    gprojt_soup_free(&s);
}

GPROJT_TEST(real_meshes) {
    int i, found = 0;
    for (i = 0; i < GPROJT_REAL_MESHES; ++i) {
        gproj_error error;
        gproj_mesh *mesh = gprojt_load_real_mesh(i, NULL, &error);
        if (!mesh && error.code == GPROJ_ERROR_FILE) continue;
        GPROJT_CHECK(mesh != NULL);
        if (!mesh)
            printf("  %s: %s\n", gprojt_real_mesh(i), error.message);
        else
            gprojt_check_valid(mesh, gprojt_real_mesh(i));
        gproj_mesh_destroy(mesh);
        ++found;
    }
    if (!found) GPROJT_SKIP("the folder of real meshes is not there (GPROJ_DATA)");
}

int main(void) {
    GPROJT_RUN(generated_meshes);
    GPROJT_RUN(corners_follow_the_input);
    GPROJT_RUN(one_rings);
    GPROJT_RUN(flipped_faces_are_turned);
    GPROJT_RUN(odd_but_accepted);
    GPROJT_RUN(areas_and_lengths);
    GPROJT_RUN(nothing_is_asked);
    GPROJT_RUN(refused_arrays);
    GPROJT_RUN(random_faces);
    GPROJT_RUN(huge_valence);
    GPROJT_RUN(layouts);
    GPROJT_RUN(refused_layouts);
    GPROJT_RUN(every_allocation_fails_once);
    GPROJT_RUN(a_limit_of_memory);
    GPROJT_RUN(real_meshes);
    return gprojt_report();
}
