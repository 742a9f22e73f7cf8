/* test_reference.c - >>hierarchy, >>curve, >>surface: closest points against brute force, odd shapes, memory. */
#define GPROJ_STATIC
#include "gprojt_mesh.h"

static void gprojt_random_point(uint64_t *state, double scale, double p[3]) {
    int k;
    for (k = 0; k < 3; ++k) p[k] = scale * (2 * gprojt_uniform(state) - 1);
}

/* -- an independent closest point: segments by clamping, the inside of triangles by normal equations -- */

static double gprojt_segment_gap(const double a[3], const double b[3], const double p[3]) {
    double ab = 0, t = 0, q[3];
    int k;
    for (k = 0; k < 3; ++k) ab += (b[k] - a[k]) * (b[k] - a[k]), t += (b[k] - a[k]) * (p[k] - a[k]);
    t = ab > 0 ? fmin(fmax(t / ab, 0), 1) : 0;
    for (k = 0; k < 3; ++k) q[k] = t == 1 ? b[k] : a[k] + t * (b[k] - a[k]);
    return gprojt_far(q, p);
}

static double gprojt_triangle_gap(const double a[3], const double b[3], const double c[3], const double p[3]) {
    double u[3], v[3], w[3], uu = 0, uv = 0, vv = 0, uw = 0, vw = 0, s, t, determinant, q[3];
    double best = fmin(gprojt_segment_gap(a, b, p), fmin(gprojt_segment_gap(b, c, p), gprojt_segment_gap(c, a, p)));
    int k;
    for (k = 0; k < 3; ++k) {
        u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = p[k] - a[k];
        uu += u[k] * u[k], uv += u[k] * v[k], vv += v[k] * v[k], uw += u[k] * w[k], vw += v[k] * w[k];
    }
    determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12 * uu * vv)) return best;
    s = (uw * vv - vw * uv) / determinant, t = (vw * uu - uw * uv) / determinant;
    if (s < 0 || t < 0 || s + t > 1) return best;
    for (k = 0; k < 3; ++k) q[k] = a[k] + s * u[k] + t * v[k];
    return fmin(best, gprojt_far(q, p));
}

/* -- curves -- */

static void gprojt_check_curve(const double *x, int32_t count, bool closed, uint64_t *state, int queries,
                               double scale) {
    gproj_error error;
    gproj_curve *curve = gproj_curve_create(count, x, closed, NULL, &error);
    int32_t segments = closed ? count : count - 1, s, first;
    int i, k;
    GPROJT_REQUIRE(curve != NULL && error.code == GPROJ_OK);
    for (i = 0; i < queries; ++i) {
        double p[3], best = HUGE_VAL, d, q[3];
        gproj_curve_hit hit;
        const double *a, *b;
        gprojt_random_point(state, scale, p);
        if (i % 4 == 0) memcpy(p, x + 3 * gprojt_below(state, count), sizeof p); /* on a corner: segments tie */
        for (s = 0, first = 0; s < segments; ++s) {
            d = gprojt_segment_gap(x + 3 * s, x + 3 * ((s + 1) % count), p);
            if (d < best) best = d, first = s;
        }
        hit = gproj_curve_closest(curve, p);
        GPROJT_CHECK(hit.segment >= 0 && hit.segment < segments && hit.parameter >= 0 && hit.parameter <= 1);
        GPROJT_NEAR(hit.distance, best, 1e-13 * scale);
        GPROJT_NEAR(gprojt_far(hit.point, p), hit.distance, 1e-14 * scale);
        if (i % 4 == 0) GPROJT_CHECK(hit.segment == first); /* the lowest segment */
        GPROJT_NEAR(gprojt_length3(hit.tangent), 1, 1e-14);
        a = x + 3 * hit.segment, b = x + 3 * ((hit.segment + 1) % count);
        for (k = 0; k < 3; ++k) q[k] = a[k] + hit.parameter * (b[k] - a[k]);
        GPROJT_NEAR(gprojt_far(q, hit.point), 0, 1e-13 * scale);
        if (gprojt_far(a, b) > 1e-6 * scale) {
            for (k = 0; k < 3; ++k) GPROJT_NEAR(hit.tangent[k], (b[k] - a[k]) / gprojt_far(a, b), 1e-9);
        }
    }
    gproj_curve_destroy(curve);
}

GPROJT_TEST(curves_against_brute_force) {
    static const int32_t counts[] = {2, 3, 4, 5, 9, 17, 100, 333};
    uint64_t state = 21;
    size_t c;
    int32_t i;
    double x[3 * 333];
    for (c = 0; c < sizeof counts / sizeof counts[0]; ++c) {
        for (i = 0; i < counts[c]; ++i) gprojt_random_point(&state, 1, x + 3 * i);
        gprojt_check_curve(x, counts[c], false, &state, 800, 1.5);
        gprojt_check_curve(x, counts[c], true, &state, 800, 1.5);
        for (i = 1; i < counts[c]; ++i) { /* every third point repeated */
            if (i % 3 == 0) memcpy(x + 3 * i, x + 3 * i - 3, 3 * sizeof(double));
        }
        gprojt_check_curve(x, counts[c], false, &state, 200, 1.5);
        gprojt_check_curve(x, counts[c], true, &state, 200, 1.5);
        for (i = 0; i < 3 * counts[c]; ++i) x[i] *= 1e-30;
        gprojt_check_curve(x, counts[c], true, &state, 50, 1e-30);
        for (i = 0; i < 3 * counts[c]; ++i) x[i] *= 1e95;
        gprojt_check_curve(x, counts[c], true, &state, 50, 1e65);
    }
    for (i = 0; i < 333; ++i)
        x[3 * i] = i / 4, x[3 * i + 1] = i / 4 % 2, x[3 * i + 2] = 0; /* a zigzag with repetitions */
    gprojt_check_curve(x, 333, false, &state, 500, 100);
}

/* A boundary loop is the closed curve through its vertices from the origin of loop_halfedge on, also if a segment, the
   first one say, has no length. */
GPROJT_TEST(loops_are_closed_curves) {
    static const double round[4][3] = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    int32_t shift, k, face[4] = {0, 1, 2, 3};
    for (shift = 0; shift < 4; ++shift) {
        gprojt_soup soup;
        gproj_mesh *mesh;
        gproj_curve *loop, *curve;
        double point[12];
        int32_t h;
        memset(&soup, 0, sizeof soup);
        for (k = 0; k < 4; ++k)
            gprojt_add_vertex(&soup, round[(k + shift) % 4][0], round[(k + shift) % 4][1], round[(k + shift) % 4][2]);
        gprojt_add_face(&soup, 4, face);
        mesh = gprojt_soup_mesh(&soup, NULL, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        h = mesh->loop_halfedge[0];
        for (k = 0; k < 4; ++k, h = mesh->prev[h])
            memcpy(point + 3 * k, mesh->position + 3 * mesh->origin[h], 3 * sizeof *point);
        loop = gproj_curve_from_loop(mesh, 0, NULL, NULL);
        curve = gproj_curve_create(4, point, true, NULL, NULL);
        GPROJT_REQUIRE(loop && curve);
        for (k = 0; k < 4; ++k) {
            gproj_curve_hit a = gproj_curve_closest(loop, point + 3 * k), b = gproj_curve_closest(curve, point + 3 * k);
            GPROJT_CHECK(a.segment == b.segment && a.parameter == b.parameter && a.distance == 0 && b.distance == 0);
            GPROJT_CHECK(gprojt_far(a.tangent, b.tangent) == 0 && gprojt_far(a.point, b.point) == 0);
        }
        gproj_curve_destroy(loop), gproj_curve_destroy(curve);
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&soup);
    }
}

GPROJT_TEST(curve_details) {
    static const double bend[15] = {0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 2, 0};
    static const double corner[3] = {2, -1, 0}, start[3] = {-3, 0, 1}, middle[3] = {0.25, -1, 0};
    gproj_curve *curve = gproj_curve_create(5, bend, false, NULL, NULL);
    gproj_curve_hit hit;
    double far_away[3] = {HUGE_VAL, 0, 0};
    GPROJT_REQUIRE(curve != NULL);
    hit = gproj_curve_closest(curve, corner); /* the end of segment 1 wins over 2 (a point) and 3 */
    GPROJT_CHECK(hit.segment == 1 && hit.parameter == 1 && hit.tangent[0] == 1 && hit.point[0] == 1);
    hit = gproj_curve_closest(curve, start); /* clamped; segment 0 is a point and has the tangent of segment 1 */
    GPROJT_CHECK(hit.segment == 0 && hit.point[0] == 0 && hit.tangent[0] == 1);
    GPROJT_NEAR(hit.distance, sqrt(10.0), 1e-15);
    hit = gproj_curve_closest(curve, middle);
    GPROJT_CHECK(hit.segment == 1 && hit.parameter == 0.25 && hit.distance == 1);
    hit = gproj_curve_closest(curve, far_away); /* no crash, no search for ever */
    GPROJT_CHECK(hit.segment >= 0 && hit.segment < 4);
    far_away[0] = NAN;
    hit = gproj_curve_closest(curve, far_away);
    GPROJT_CHECK(hit.segment >= 0 && hit.segment < 4);
    gproj_curve_destroy(curve);
    gproj_curve_destroy(NULL);
    /* a closed curve whose first segment has no length takes the tangent of its last */
    curve = gproj_curve_create(4, bend + 3, true, NULL, NULL);
    GPROJT_REQUIRE(curve != NULL);
    gproj_curve_destroy(curve);
    {
        static const double loop[12] = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0};
        curve = gproj_curve_create(4, loop, true, NULL, NULL);
        GPROJT_REQUIRE(curve != NULL);
        hit = gproj_curve_closest(curve, loop);
        GPROJT_CHECK(hit.segment == 0 && hit.distance == 0 && hit.tangent[1] == -1);
        gproj_curve_destroy(curve);
    }
}

/* Segments that are short beside the curve, but no rounding, have directions of their own, wherever the curve is: rounding
   there may be 1e-13, and counts by the curve's extent alone. */
GPROJT_TEST(short_segments_far_away) {
    int axis, closed, side;
    for (axis = 0; axis < 3; ++axis)
        for (closed = 0; closed < 2; ++closed)
            for (side = -1; side < 2; side += 2) {
                double point[12] = {0}, turn;
                gproj_curve *curve;
                gproj_curve_hit hit;
                int k;
                for (k = 0; k < 4; ++k) point[3 * k + axis] = side * 1000;
                point[3 + (axis + 1) % 3] = 1;
                point[6 + (axis + 1) % 3] = 1, point[6 + (axis + 2) % 3] = 1e-12;
                point[9 + (axis + 1) % 3] = 0.5, point[9 + (axis + 2) % 3] = 0.5;
                curve = gproj_curve_create(4, point, closed != 0, NULL, NULL);
                GPROJT_REQUIRE(curve != NULL);
                hit = gproj_curve_closest(curve, point + 6);
                turn = hit.segment == 1 ? hit.tangent[(axis + 2) % 3] : 0;
                GPROJT_NEAR(turn, 1, 1e-12);
                gproj_curve_destroy(curve);
            }
}

/* A point far across the plane of a triangle may be beyond the ends of all three sides, by rounding: a walk from side to
   side ends all the same. */
GPROJT_TEST(walks_around_closed_curves_end) {
    uint64_t random = 3;
    int32_t round, around = 0;
    for (round = 0; round < 2000; ++round) {
        double x[9], u[3], v[3], p[3];
        bool forward = true, backward = true;
        gproj_curve *curve;
        int32_t k;
        for (k = 0; k < 3; ++k) gprojt_random_point(&random, 1, x + 3 * k);
        gprojt_sub3(x + 3, x, u);
        gprojt_sub3(x + 6, x, v);
        gprojt_cross3(u, v, p);
        for (k = 0; k < 3; ++k) p[k] *= 1e18;
        curve = gproj_curve_create(3, x, true, NULL, NULL);
        GPROJT_REQUIRE(curve);
        for (k = 0; k < 3; ++k) {
            int32_t end = gproji_walk(curve, k, p);
            GPROJT_CHECK(end >= 0 && end < 3);
            forward = forward && gproji_along(curve, k, p, true) > 0;
            backward = backward && gproji_along(curve, k, p, false) < 0;
        }
        around += forward || backward;
        gproj_curve_destroy(curve);
    }
    GPROJT_CHECK(around > 10); /* of these the test is */
}

GPROJT_TEST(curve_errors) {
    double x[9] = {1, 2, 3, 1, 2, 3, 1, 2, 3};
    const char *text;
    gproj_mesh *mesh;
    gproj_error error;
    int32_t i;
    GPROJT_CHECK(!gproj_curve_create(3, x, false, NULL, &error) && error.code == GPROJ_ERROR_DEGENERATE);
    GPROJT_CHECK(strstr(error.message, "all 3 points") != NULL);
    GPROJT_CHECK(!gproj_curve_create(3, x, true, NULL, &error) && error.code == GPROJ_ERROR_DEGENERATE);
    GPROJT_CHECK(strstr(error.message, "all 3 points") != NULL);
    x[4] = NAN;
    GPROJT_CHECK(!gproj_curve_create(3, x, true, NULL, &error) && error.code == GPROJ_ERROR_NUMBER && error.index == 1);
    GPROJT_CHECK(!gproj_curve_create(1, x, false, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_curve_create(-3, x, false, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_curve_create(3, NULL, false, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_curve_create(INT32_MAX, x, false, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_curve_from_loop(NULL, 0, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_curve_from_polyline(NULL, 0, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nl 1 2 3\nl 3 2\n";
    mesh = gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_OBJ, NULL, NULL);
    GPROJT_REQUIRE(mesh && mesh->loop_count == 1 && mesh->polyline_count == 2);
    for (i = -1; i < 4; ++i) {
        gproj_curve *loop = gproj_curve_from_loop(mesh, i, NULL, &error), *line;
        GPROJT_CHECK((loop != NULL) == (i == 0));
        GPROJT_CHECK(loop || (error.code == GPROJ_ERROR_ARGUMENT && strstr(error.message, "that has 1 of them")));
        line = gproj_curve_from_polyline(mesh, i, NULL, &error);
        GPROJT_CHECK((line != NULL) == (i == 0 || i == 1));
        GPROJT_CHECK(line || (error.code == GPROJ_ERROR_ARGUMENT && strstr(error.message, "that has 2 of them")));
        gproj_curve_destroy(loop);
        gproj_curve_destroy(line);
    }
    gproj_mesh_destroy(mesh);
    GPROJT_CHECK(!gproj_surface_create(NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
}

GPROJT_TEST(nothing_is_near_nothing) {
    static const double x[6] = {1, 2, 3, 4, 5, 6};
    gprojt_soup s = gprojt_quad_grid(2, 2);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gproj_curve *curve = gproj_curve_create(2, x, false, NULL, NULL);
    gproj_surface *surface = gproj_surface_create(mesh, NULL, NULL);
    int32_t i;
    GPROJT_REQUIRE(curve && surface);
    for (i = 0; i < 3; ++i) { /* no object, no point, neither */
        gproj_curve_hit c = gproj_curve_closest(i == 1 ? curve : NULL, i == 0 ? x : NULL);
        gproj_surface_hit f = gproj_surface_closest(i == 1 ? surface : NULL, i == 0 ? x : NULL);
        GPROJT_CHECK(c.segment == -1 && c.distance > DBL_MAX && c.parameter == 0 && c.point[0] == 0 &&
                     c.tangent[2] == 0);
        GPROJT_CHECK(f.face == -1 && f.distance > DBL_MAX && f.point[0] == 0 && f.normal[2] == 0);
    }
    gproj_curve_destroy(NULL);
    gproj_surface_destroy(NULL);
    gproj_curve_destroy(curve);
    gproj_surface_destroy(surface);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

GPROJT_TEST(curves_from_meshes) {
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nf 1 2 3 4\nl 1 3 5\nl 1 2 3 1\nl 5 5\n";
    gproj_error error;
    gproj_mesh *mesh = gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_OBJ, NULL, &error);
    gproj_curve *curve;
    gproj_curve_hit hit;
    static const double below[3] = {0.5, -1, 0}, diagonal[3] = {0.4, 0.5, 0};
    const double none[3] = {NAN, 0, 0};
    GPROJT_REQUIRE(mesh != NULL);
    curve = gproj_curve_create(2, mesh->position, false, NULL, NULL);
    GPROJT_REQUIRE(curve != NULL);
    GPROJT_CHECK(gproj_curve_closest(curve, none).segment == 0); /* as good as any, but one that there is */
    gproj_curve_destroy(curve);
    curve = gproj_curve_from_loop(mesh, 0, NULL, &error);
    GPROJT_REQUIRE(curve != NULL);
    hit = gproj_curve_closest(curve, below);
    GPROJT_CHECK(hit.distance == 1 && hit.tangent[0] == 1); /* in the direction of the face's edge 0-1 */
    gproj_curve_destroy(curve);
    curve = gproj_curve_from_polyline(mesh, 0, NULL, &error);
    GPROJT_REQUIRE(curve != NULL);
    GPROJT_CHECK(curve->segment_count == 2);
    gproj_curve_destroy(curve);
    curve = gproj_curve_from_polyline(mesh, 1, NULL, &error);
    GPROJT_REQUIRE(curve != NULL);
    hit = gproj_curve_closest(curve, diagonal);
    GPROJT_CHECK(hit.segment == 2);
    gproj_curve_destroy(curve);
    GPROJT_CHECK(!gproj_curve_from_polyline(mesh, 2, NULL, &error) && error.code == GPROJ_ERROR_DEGENERATE);
    GPROJT_CHECK(!gproj_curve_from_polyline(mesh, 3, NULL, &error) &&
                 strstr(error.message, "polyline 3 of a mesh that has 3"));
    mesh->polyline_count = 1; /* whatever stands in the arrays behind the last one */
    GPROJT_CHECK(!gproj_curve_from_polyline(mesh, 1, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    mesh->polyline_count = 3;
    GPROJT_CHECK(!gproj_curve_from_loop(mesh, -1, NULL, &error) && strstr(error.message, "boundary loop -1"));
    mesh->position[4] = NAN;
    GPROJT_CHECK(!gproj_curve_from_loop(mesh, 0, NULL, &error) && error.code == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.index == 1 && strstr(error.message, "of vertex 1 ")); /* not where it is on the curve */
    GPROJT_CHECK(!gproj_surface_create(mesh, NULL, &error) && error.code == GPROJ_ERROR_NUMBER && error.index == 1);
    mesh->position[4] = 0, mesh->position[3 * 4 + 2] = HUGE_VAL;
    GPROJT_CHECK(!gproj_curve_from_polyline(mesh, 0, NULL, &error) && error.code == GPROJ_ERROR_NUMBER &&
                 error.place == GPROJ_PLACE_VERTEX && error.index == 4 && strstr(error.message, "z of vertex 4 "));
    gproj_mesh_destroy(mesh);
}

/* -- surfaces -- */

static void gprojt_check_surface(const gproj_mesh *mesh, uint64_t *state, int queries, double scale) {
    gproj_error error;
    gproj_surface *surface = gproj_surface_create(mesh, NULL, &error);
    int i, k;
    int32_t t, count = 0;
    for (t = 0; t < mesh->face_count; ++t) count += mesh->face_degree[t] - 2;
    GPROJT_REQUIRE(surface != NULL && surface->triangle_count == count);
    for (i = 0; i < queries; ++i) {
        double p[3], best = HUGE_VAL, at_face = HUGE_VAL;
        gproj_surface_hit hit;
        gprojt_random_point(state, scale, p);
        if (i % 5 == 0) memcpy(p, mesh->position + 3 * gprojt_below(state, mesh->vertex_count), sizeof p);
        hit = gproj_surface_closest(surface, p);
        for (t = 0; t < count; ++t) {
            const int32_t *v = surface->triangle + 3 * t;
            double d =
                gprojt_triangle_gap(mesh->position + 3 * v[0], mesh->position + 3 * v[1], mesh->position + 3 * v[2], p);
            if (d < best) best = d;
            if (surface->triangle_face[t] == hit.face && d < at_face) at_face = d;
        }
        GPROJT_NEAR(hit.distance, best, 1e-11 * scale);
        GPROJT_NEAR(at_face, best, 1e-11 * scale);
        GPROJT_NEAR(gprojt_far(hit.point, p), hit.distance, 1e-14 * scale);
        GPROJT_NEAR(gprojt_length3(hit.normal), 1, 1e-14);
        for (k = 0; k < 3; ++k) GPROJT_CHECK(isfinite(hit.point[k]));
    }
    gproj_surface_destroy(surface);
}

GPROJT_TEST(surfaces_against_brute_force) {
    uint64_t state = 31;
    int shape, i;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gprojt_soup s = gprojt_shape(shape, 6);
        gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
        gprojt_check_surface(mesh, &state, 1000, 3);
        for (i = 0; i < mesh->vertex_count; ++i) { /* a third of the vertices fall together, a third on a line */
            if (i % 3 == 0) memset(mesh->position + 3 * i, 0, 3 * sizeof(double));
            if (i % 3 == 1) mesh->position[3 * i + 1] = mesh->position[3 * i + 2] = 0;
        }
        gprojt_check_surface(mesh, &state, 300, 3);
        for (i = 0; i < mesh->vertex_count; ++i)
            mesh->position[3 * i + 1] = mesh->position[3 * i + 2] = 0; /* all on one */
        gprojt_check_surface(mesh, &state, 50, 3);
        memset(mesh->position, 0, (size_t)mesh->vertex_count * 3 * sizeof(double)); /* all in one point */
        gprojt_check_surface(mesh, &state, 20, 3);
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&s);
    }
}

GPROJT_TEST(needles) { /* triangles a million times longer than wide */
    uint64_t state = 33;
    int round, k;
    for (round = 0; round < 300; ++round) {
        double x[3][3], p[3];
        const double *corner[3];
        double out[3], weight[3], d, width = pow(10, -1 - round % 16);
        gprojt_random_point(&state, 1, x[0]);
        gprojt_random_point(&state, 1, x[1]);
        for (k = 0; k < 3; ++k) x[2][k] = 0.5 * (x[0][k] + x[1][k]) + width * (gprojt_uniform(&state) - 0.5);
        gprojt_random_point(&state, 1, p);
        for (k = 0; k < 3; ++k) corner[k] = x[k];
        d = sqrt(gproji_closest_on_triangle(corner, p, out, weight));
        GPROJT_NEAR(d, gprojt_triangle_gap(x[0], x[1], x[2], p), 3e-6);
        GPROJT_NEAR(weight[0] + weight[1] + weight[2], 1, 1e-14);
        for (k = 0; k < 3; ++k) {
            GPROJT_CHECK(weight[k] >= 0);
            GPROJT_NEAR(weight[0] * x[0][k] + weight[1] * x[1][k] + weight[2] * x[2][k], out[k], 1e-14);
        }
    }
}

/* Over the middle of a triangle, far away from it, the projection is the nearest point; and so it is of a needle. */
GPROJT_TEST(far_above_triangles) {
    double wide;
    int32_t k;
    for (wide = 1; wide > 1e-7; wide *= 0.1) {
        double x[3][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, p[3] = {0.5, 0, 0}, out[3], weight[3];
        const double *corner[3];
        x[2][1] = 3 * wide, p[1] = wide;
        for (k = 0; k < 3; ++k) corner[k] = x[k];
        for (p[2] = 1e-3; p[2] < 1e5; p[2] *= 1e3) {
            GPROJT_NEAR(sqrt(gproji_closest_on_triangle(corner, p, out, weight)), p[2], 1e-12 * p[2]);
            GPROJT_CHECK(fabs(out[0] - 0.5) + fabs(out[1] - wide) + fabs(out[2]) < 1e-12 * fmax(p[2], 1) / wide);
            GPROJT_NEAR(weight[2], 1.0 / 3, 1e-12 * fmax(p[2], 1) / wide);
        }
    }
}

/* Over the top of a pyramid the normal is the axis, and over a ridge it stays in the plane of symmetry, though the
   triangles' normals do neither. */
GPROJT_TEST(normals_of_a_pyramid) {
    static const double corner[5][3] = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, 1}};
    static const double above[3] = {0, 0, 2}, ridge[3] = {0.5, 0.5, 0.75};
    gprojt_soup soup;
    gproj_mesh *mesh;
    gproj_surface *surface;
    gproj_surface_hit hit;
    int32_t k;
    memset(&soup, 0, sizeof soup);
    for (k = 0; k < 5; ++k) gprojt_add_vertex(&soup, corner[k][0], corner[k][1], corner[k][2]);
    for (k = 0; k < 4; ++k) {
        int32_t face[3];
        face[0] = k, face[1] = (k + 1) % 4, face[2] = 4;
        gprojt_add_face(&soup, 3, face);
    }
    mesh = gprojt_soup_mesh(&soup, NULL, NULL);
    surface = gproj_surface_create(mesh, NULL, NULL);
    GPROJT_REQUIRE(surface != NULL);
    hit = gproj_surface_closest(surface, above);
    GPROJT_NEAR(hit.distance, 1, 1e-15);
    GPROJT_NEAR(hit.normal[2], 1, 1e-14);
    hit = gproj_surface_closest(surface, ridge);
    GPROJT_NEAR(hit.normal[0], hit.normal[1], 1e-14);
    GPROJT_CHECK(hit.normal[0] > 0.05 && hit.normal[2] > 0.5);
    gproj_surface_destroy(surface);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&soup);
}

GPROJT_TEST(smooth_normals) { /* on a sphere the interpolated normal is the radius, nearly */
    gprojt_soup s = gprojt_cube_sphere(16);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gproj_surface *surface = gproj_surface_create(mesh, NULL, NULL);
    uint64_t state = 35;
    int i;
    GPROJT_REQUIRE(surface != NULL);
    for (i = 0; i < 2000; ++i) {
        double p[3], r;
        gproj_surface_hit hit;
        gprojt_random_point(&state, 1, p);
        r = gprojt_length3(p);
        if (r < 0.3) continue;
        hit = gproj_surface_closest(surface, p);
        GPROJT_CHECK((hit.normal[0] * p[0] + hit.normal[1] * p[1] + hit.normal[2] * p[2]) / r > 0.99);
        GPROJT_NEAR(gprojt_length3(hit.point), 1, 0.01);
    }
    gproj_surface_destroy(surface);
    gproj_surface_destroy(NULL);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

/* The triangles cover the soup's face, no more and no less; frees the soup. */
static void gprojt_check_cover(gprojt_soup *s) {
    gproj_mesh *mesh = gprojt_soup_mesh(s, NULL, NULL);
    gproj_surface *surface = gproj_surface_create(mesh, NULL, NULL);
    double area[3], sum = 0;
    int32_t t;
    GPROJT_REQUIRE(surface != NULL);
    gproj_mesh_face_area_vector(mesh, 0, area);
    for (t = 0; t < surface->triangle_count; ++t) {
        const int32_t *v = surface->triangle + 3 * t;
        double a[3], b[3], c[3];
        gprojt_sub3(s->position + 3 * v[1], s->position + 3 * v[0], a);
        gprojt_sub3(s->position + 3 * v[2], s->position + 3 * v[0], b);
        gprojt_cross3(a, b, c);
        sum += 0.5 * gprojt_length3(c);
    }
    GPROJT_NEAR(sum, gprojt_length3(area), 1e-8 * sum);
    gproj_surface_destroy(surface);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(s);
}

GPROJT_TEST(faces_that_are_not_convex) { /* star-shaped faces, quads with a notch, and spirals */
    static const double notched[4][2] = {{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}};
    uint64_t state = 37;
    int round;
    for (round = 0; round < 400; ++round) {
        gprojt_soup s;
        int32_t n = 4 + gprojt_below(&state, round % 10 ? 20 : 400), i, corner[512];
        double tilt = gprojt_uniform(&state);
        memset(&s, 0, sizeof s);
        for (i = 0; i < n; ++i) {
            double angle = 6.283185307179586 * i / n, r = 0.2 + gprojt_uniform(&state);
            corner[i] = gprojt_add_vertex(&s, r * cos(angle), r * sin(angle), tilt * r * cos(angle));
        }
        gprojt_add_face(&s, n, corner);
        gprojt_check_cover(&s);
    }
    for (round = 0; round < 4; ++round) { /* from each corner on */
        gprojt_soup s;
        int32_t i, corner[4];
        memset(&s, 0, sizeof s);
        for (i = 0; i < 4; ++i) corner[(i + round) % 4] = gprojt_add_vertex(&s, notched[i][0], notched[i][1], 0);
        gprojt_add_face(&s, 4, corner);
        gprojt_check_cover(&s);
    }
    for (round = 200; round <= 1360; round += 290) {
        gprojt_soup s;
        memset(&s, 0, sizeof s);
        gprojt_add_spiral(&s, round);
        gprojt_check_cover(&s);
    }
}

/* Convex faces are fans about their first corner, whatever was cut before; stars that go around twice turn left as well,
   but are none. */
GPROJT_TEST(convex_faces_are_fans) {
    gprojt_soup s;
    gproj_mesh *mesh;
    gproj_surface *surface;
    int32_t degree, around, corner[9], first[9], f, i, k, at = 0;
    bool fan, star[9];
    memset(&s, 0, sizeof s);
    for (degree = 9; degree >= 4; --degree)
        for (around = 1; around <= 1 + degree % 2; ++around) {
            for (i = 0; i < degree; ++i) {
                double angle = 6.283185307179586 * around * i / degree;
                corner[i] = gprojt_add_vertex(&s, 3 * cos(angle), sin(angle), 0);
            }
            first[s.face_count] = corner[0], star[s.face_count] = around > 1;
            gprojt_add_face(&s, degree, corner);
        }
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    surface = gproj_surface_create(mesh, NULL, NULL);
    GPROJT_REQUIRE(surface != NULL);
    for (f = 0; f < mesh->face_count; ++f) {
        for (i = 0, fan = true; i < mesh->face_degree[f] - 2; ++i, ++at)
            for (k = 0; k < 3; ++k) fan &= surface->triangle[3 * at + k] == first[f] + (k ? i + k : 0);
        GPROJT_CHECK(fan == !star[f]);
    }
    GPROJT_CHECK(at == surface->triangle_count);
    gproj_surface_destroy(surface);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

GPROJT_TEST(large_faces_take_linear_time) { /* a comb and a crossing star with 20,000 corners each */
    int kind;
    for (kind = 0; kind < 2; ++kind) {
        gprojt_soup s;
        gproj_mesh *mesh;
        gproj_surface *surface;
        int32_t i, n = 20000, *corner = (int32_t *)malloc((size_t)n * sizeof(int32_t));
        static const double p[3] = {0.5, 0.5, 3};
        memset(&s, 0, sizeof s);
        for (i = 0; i < n; ++i) {
            double angle = 6.283185307179586 * ((double)i * 7919 / n);
            if (kind)
                corner[i] = gprojt_add_vertex(&s, cos(angle), sin(angle), 0);
            else
                corner[i] = gprojt_add_vertex(&s, (double)i / n, i == 0 || i == n - 1 ? -2 : (i & 1 ? 1 : 0), 0);
        }
        gprojt_add_face(&s, n, corner);
        mesh = gprojt_soup_mesh(&s, NULL, NULL);
        surface = gproj_surface_create(mesh, NULL, NULL);
        GPROJT_REQUIRE(surface != NULL);
        GPROJT_CHECK(surface->triangle_count == n - 2 && gproj_surface_closest(surface, p).face == 0);
        gproj_surface_destroy(surface);
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&s);
        free(corner);
    }
}

/* Cuts the soup's face into triangles and frees the soup. Returns how many corners were looked at. */
static int64_t gprojt_looks(gprojt_soup *s) {
    gproj_mesh *mesh = gprojt_soup_mesh(s, NULL, NULL);
    gproji_heap heap = gproji_heap_of(NULL);
    gproji_pool pool;
    gproji_polygon polygon;
    int32_t n = s->vertex_count;
    memset(&polygon, 0, sizeof polygon);
    gproji_pool_start(&pool, &heap);
    if (mesh && gproji_polygon_take(&polygon, &pool, n)) {
        gproji_polygon_set(&polygon, mesh, 0);
        GPROJT_CHECK(gproji_cut_ears(&polygon, 1, 3, NULL) >= 0 && polygon.ears == n - 3);
    } else
        GPROJT_CHECK(false);
    gproji_pool_give_all(&pool);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(s);
    return 2048 * (int64_t)n - polygon.budget;
}

/* A circle with a notch takes a few looks a corner; a comb and corners along a line take all that there are, and no more.
   In a thin arc only corners at its ends are ears, and yet no other is tried more than three times. */
GPROJT_TEST(looks_at_corners_are_counted) {
    static const int32_t count[4] = {3000, 9200, 4600, 1360};
    int kind;
    for (kind = 0; kind < 4; ++kind) {
        int32_t n = count[kind], half = n / 2, i, *corner = (int32_t *)malloc((size_t)n * sizeof(int32_t));
        int64_t looks, all = 2048 * (int64_t)n;
        gprojt_soup s;
        memset(&s, 0, sizeof s);
        for (i = 0; i < n; ++i) {
            double x = i, y = 0, angle = 6.283185307179586 * i / n, r = i == half ? 0.5 : 1;
            if (kind == 1) y = i == 0 || i == n - 1 ? -2 * n : i & 1 ? n : 0;
            if (kind == 2 && i >= half) x = n - i - 0.5;
            if (kind == 3) angle = 5.0 * (i < half ? i : n - 1 - i) / half, r = i < half ? 1 : 1 - 1e-5;
            if (kind == 0 || kind == 3) x = r * cos(angle), y = r * sin(angle);
            corner[i] = gprojt_add_vertex(&s, x, y, 0);
        }
        gprojt_add_face(&s, n, corner);
        free(corner);
        looks = gprojt_looks(&s);
        if (kind == 0) GPROJT_CHECK(looks < 3 * n);
        if (kind == 1 || kind == 2) GPROJT_CHECK(looks >= all && looks < all + 2 * n);
        if (kind == 3) GPROJT_CHECK(looks < n + 3 * (int64_t)n * half);
    }
}

/* Boxes hold their items and nothing more: 8 segments along a line, 4 on each side. */
GPROJT_TEST(boxes_are_tight) {
    double point[27] = {0};
    gproj_curve *curve;
    int32_t i;
    for (i = 0; i < 9; ++i) point[3 * i] = i;
    curve = gproj_curve_create(9, point, false, NULL, NULL);
    GPROJT_REQUIRE(curve != NULL && curve->tree.node_count == 3);
    for (i = 0; i < 3; ++i) {
        const gproji_node *node = &curve->tree.node[i];
        GPROJT_CHECK(node->low[0] == (i == 2 ? 4 : 0) && node->high[0] == (i == 1 ? 4 : 8));
        GPROJT_CHECK(node->low[1] == 0 && node->high[1] == 0 && node->low[2] == 0 && node->high[2] == 0);
    }
    gproj_curve_destroy(curve);
}

GPROJT_TEST(hierarchy_of_equal_items) { /* thousands of segments in one place: depth stays small, the lowest wins */
    int32_t n = 50000, i;
    double *x = (double *)calloc(3 * (size_t)n, sizeof(double));
    static const double p[3] = {0.25, 1, 0};
    gproj_curve *curve;
    for (i = 0; i < n; ++i) x[3 * i] = i & 1;
    curve = gproj_curve_create(n, x, false, NULL, NULL);
    GPROJT_REQUIRE(curve != NULL);
    GPROJT_CHECK(gproj_curve_closest(curve, p).segment == 0 && gproj_curve_closest(curve, p).distance == 1);
    GPROJT_CHECK(curve->tree.node_count <= n);
    gproj_curve_destroy(curve);
    free(x);
}

/* Curves and surfaces of a mesh, or curves of its polyline. */
typedef struct gprojt_made {
    const gproj_mesh *mesh;
    int kind;
} gprojt_made;

static bool gprojt_make(const gproj_host *host, void *user) {
    const gprojt_made *what = (const gprojt_made *)user;
    const gproj_mesh *mesh = what->mesh;
    gproj_error error;
    gproj_curve *curve = NULL;
    gproj_surface *surface = NULL;
    bool made;
    if (what->kind == 0) curve = gproj_curve_create(mesh->vertex_count, mesh->position, true, host, &error);
    if (what->kind == 1) curve = gproj_curve_from_loop(mesh, 0, host, &error);
    if (what->kind == 2) curve = gproj_curve_from_polyline(mesh, 0, host, &error);
    if (what->kind == 3) surface = gproj_surface_create(mesh, host, &error);
    made = curve || surface;
    GPROJT_CHECK(made || error.code == GPROJ_ERROR_MEMORY);
    gproj_curve_destroy(curve);
    gproj_surface_destroy(surface);
    return made;
}

GPROJT_TEST(every_allocation_fails_once) {
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n";
    gprojt_soup s = gprojt_hexagon_mesh(4, 4);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL), *line;
    gprojt_made what;
    line = gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_OBJ, NULL, NULL);
    for (what.kind = 0; what.kind < 4; ++what.kind) {
        what.mesh = what.kind == 2 ? line : mesh;
        GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_make, &what) >= 10);
    }
    gproj_mesh_destroy(line);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

GPROJT_TEST(real_meshes) {
    uint64_t state = 39;
    int i, found = 0;
    for (i = 0; i < GPROJT_REAL_MESHES; ++i) {
        gproj_mesh *mesh = gprojt_load_real_mesh(i, NULL, NULL);
        double extent = 0;
        int32_t k, c = 0;
        if (!mesh) continue;
        for (k = 0; k < 3 * mesh->vertex_count; ++k) extent = fmax(extent, fabs(mesh->position[k]));
        gprojt_check_surface(mesh, &state, 60, extent);
        for (k = 0; k < mesh->loop_count; ++k) {
            gproj_curve *curve = gproj_curve_from_loop(mesh, k, NULL, NULL);
            GPROJT_CHECK(curve != NULL);
            if (curve) c += curve->segment_count;
            gproj_curve_destroy(curve);
        }
        for (k = 0; k < mesh->halfedge_count; ++k) c -= mesh->face[k] < 0;
        GPROJT_CHECK(c == 0);
        gproj_mesh_destroy(mesh);
        ++found;
    }
    if (!found) GPROJT_SKIP("the folder of real meshes is not there (GPROJ_DATA)");
}

int main(void) {
    GPROJT_RUN(curves_against_brute_force);
    GPROJT_RUN(loops_are_closed_curves);
    GPROJT_RUN(curve_details);
    GPROJT_RUN(short_segments_far_away);
    GPROJT_RUN(walks_around_closed_curves_end);
    GPROJT_RUN(curve_errors);
    GPROJT_RUN(nothing_is_near_nothing);
    GPROJT_RUN(curves_from_meshes);
    GPROJT_RUN(surfaces_against_brute_force);
    GPROJT_RUN(needles);
    GPROJT_RUN(far_above_triangles);
    GPROJT_RUN(normals_of_a_pyramid);
    GPROJT_RUN(smooth_normals);
    GPROJT_RUN(faces_that_are_not_convex);
    GPROJT_RUN(convex_faces_are_fans);
    GPROJT_RUN(large_faces_take_linear_time);
    GPROJT_RUN(looks_at_corners_are_counted);
    GPROJT_RUN(boxes_are_tight);
    GPROJT_RUN(hierarchy_of_equal_items);
    GPROJT_RUN(every_allocation_fails_once);
    GPROJT_RUN(real_meshes);
    return gprojt_report();
}
