/* test_boundary.c - >>catalogue: vertices on unknown planes and lines, boundaries between corners, right angles,
   lifting. */
#include "gprojt_form.h"

enum {
    SIDE = 8,
    TUBE = 5,
    CUBE_SPHERE = 6
};

/* SIDE x SIDE quads with noise of so many mean edges. */
static gproj_mesh *gprojt_square(double noise, uint64_t seed) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(SIDE, SIDE));
    if (mesh) gprojt_shake(mesh, noise * gproj_mesh_mean_edge_length(mesh), seed);
    return mesh;
}

/* The vertices of side `side` of the grid of SIDE x SIDE quads, corners included. */
static void gprojt_side(int side, int32_t vertex[SIDE + 1]) {
    int32_t k, line = SIDE + 1;
    for (k = 0; k <= SIDE; ++k)
        vertex[k] = side == 0 ? k : side == 1 ? SIDE * line + k : side == 2 ? k * line : k * line + SIDE;
}

/* The largest distance of points from the line through the first and the last of them. */
static double gprojt_off_line(const gproj_mesh *mesh, int32_t count, const int32_t *vertex) {
    const double *a = mesh->position + 3 * vertex[0], *b = mesh->position + 3 * vertex[count - 1];
    double along[3], d[3], c[3], worst = 0;
    int32_t k;
    gprojt_sub3(b, a, along);
    for (k = 1; k < count - 1; ++k) {
        gprojt_sub3(mesh->position + 3 * vertex[k], a, d);
        gprojt_cross3(d, along, c);
        worst = fmax(worst, gprojt_length3(c) / gprojt_length3(along));
    }
    return worst;
}

/* The largest volume that 4 points span, over the cube of the distance of the first and the last. */
static double gprojt_off_plane(const gproj_mesh *mesh, int32_t count, const int32_t *vertex) {
    const double *x = mesh->position, *a = x + 3 * vertex[0];
    double size = gprojt_far(a, x + 3 * vertex[count - 1]), u[3], v[3], w[3], n[3], worst = 0;
    int32_t i, j, k;
    for (i = 1; i < count; ++i) {
        for (j = 1; j < i; ++j) {
            gprojt_sub3(x + 3 * vertex[i], a, u);
            gprojt_sub3(x + 3 * vertex[j], a, v);
            gprojt_cross3(u, v, n);
            for (k = 1; k < j; ++k) {
                gprojt_sub3(x + 3 * vertex[k], a, w);
                worst = fmax(worst, fabs(gprojt_dot3(n, w)) / (size * size * size));
            }
        }
    }
    return worst;
}

GPROJT_TEST(boundaries_between_corners) {
    int straight;
    for (straight = 0; straight < 2; ++straight) {
        gproj_mesh *mesh = gprojt_square(0.05, 3);
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t vertex[SIDE + 1], group, side;
        gproj_result result;
        gproj_add_planarity(form, 1);
        group = straight ? gproj_add_straight_boundary(form, 1) : gproj_add_planar_boundary(form, 1);
        GPROJT_CHECK(group >= 0);
        GPROJT_CHECK(gproj_form_group_info(form, group).rows == 4 * (straight ? 2 * (SIDE + 1) + 3 : SIDE + 1 + 1));
        GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
        gprojt_side(0, vertex);
        GPROJT_CHECK(gprojt_off_plane(mesh, SIDE + 1, vertex) > 1e-6);
        result = gproj_solve(form, 20, NULL);
        if (result.outcome != GPROJ_CONVERGED) printf("    straight %d: %s\n", straight, result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        for (side = 0; side < 4; ++side) {
            gprojt_side(side, vertex);
            GPROJT_CHECK(gprojt_off_plane(mesh, SIDE + 1, vertex) < 1e-12);
            if (straight) GPROJT_CHECK(gprojt_off_line(mesh, SIDE + 1, vertex) < 1e-12);
        }
        GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).planarity_max < 1e-12);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* A tube has two boundary loops without corners: each becomes planar as a whole, and cannot be straight. */
GPROJT_TEST(loops_without_corners) {
    gproj_mesh *mesh = gprojt_noisy(TUBE, 12, 0.02, 4);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t vertex[256], count, loop, corners = 0;
    gproj_result result;
    GPROJT_REQUIRE(mesh->loop_count == 2);
    for (loop = 0; loop < mesh->vertex_count; ++loop) corners += gproj_form_is_corner(form, loop);
    GPROJT_REQUIRE(corners == 0);
    gproj_add_planarity(form, 1);
    gproj_add_planar_boundary(form, 1);
    result = gproj_solve(form, 20, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    for (loop = 0; loop < 2; ++loop) {
        int32_t h = mesh->loop_halfedge[loop];
        for (count = 0; count == 0 || h != mesh->loop_halfedge[loop]; h = mesh->next[h])
            vertex[count++] = mesh->origin[h];
        GPROJT_CHECK(gprojt_off_plane(mesh, count, vertex) < 1e-10);
    }
    GPROJT_CHECK(gproj_add_straight_boundary(form, 1) == -1);
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_form_error(form)->place == GPROJ_PLACE_VERTEX);
    GPROJT_CHECK(strstr(gproj_form_error(form)->message, "has 0 corners") != NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    mesh = gprojt_noisy(CUBE_SPHERE, 3, 0.05, 4); /* closed: nothing to do */
    form = gproj_form_create(mesh, NULL);
    GPROJT_CHECK(gproj_form_group_info(form, gproj_add_straight_boundary(form, 1)).rows == 0);
    GPROJT_CHECK(gproj_form_group_info(form, gproj_add_planar_boundary(form, 1)).rows == 0);
    GPROJT_CHECK(gproj_form_group_info(form, gproj_add_orthogonal_boundary(form, 1)).rows == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A diagonal of the grid becomes straight, a row of it planar; far from the origin, and once more after a rotation. */
GPROJT_TEST(chosen_vertices) {
    gproj_mesh *mesh = gprojt_square(0.1, 5);
    int32_t diagonal[SIDE + 1], row[SIDE + 1], k, v, planar, straight;
    gproj_form *form;
    gproj_result result;
    int round;
    for (k = 0; k <= SIDE; ++k) diagonal[k] = k * (SIDE + 2), row[k] = 4 * (SIDE + 1) + k;
    for (v = 0; v < mesh->vertex_count; ++v) mesh->position[3 * v] += 100;
    form = gproj_form_create(mesh, NULL);
    straight = gproj_add_collinear(form, SIDE + 1, diagonal, 1);
    planar = gproj_add_coplanar(form, SIDE + 1, row, 1);
    GPROJT_CHECK(gproj_form_group_info(form, straight).rows == 2 * (SIDE + 1) + 3);
    GPROJT_CHECK(gproj_form_group_info(form, planar).rows == SIDE + 1 + 1);
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    for (round = 0; round < 2; ++round) {
        result = gproj_solve(form, 12, NULL);
        if (result.outcome != GPROJ_CONVERGED) printf("    round %d: %s\n", round, result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_CHECK(gprojt_off_line(mesh, SIDE + 1, diagonal) < 1e-12);
        GPROJT_CHECK(gprojt_off_plane(mesh, SIDE + 1, row) < 1e-12);
        for (v = 0; v < mesh->vertex_count; ++v) { /* a quarter turn about the x axis, and new noise */
            double *p = mesh->position + 3 * v, y = p[1];
            p[1] = -p[2], p[2] = y;
        }
        gprojt_shake(mesh, 0.02, 7);
        GPROJT_CHECK(gprojt_off_line(mesh, SIDE + 1, diagonal) > 1e-4);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A plane and a line leave the middle of their vertices, wherever vertex 0 is: all are lifted with three of them. */
GPROJT_TEST(planes_are_lifted) {
    int lines;
    for (lines = 0; lines < 2; ++lines) {
        gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(2, 2));
        int32_t all[9], v, count = lines ? 3 : 9;
        static const int32_t lifted[3] = {0, 8, 2};
        double target[9];
        gproj_form *form;
        gproj_result result;
        for (v = 0; v < 9; ++v) { /* vertex 0 has the y and z of the middle */
            double *p = mesh->position + 3 * v;
            all[v] = lines ? 4 * v : v;
            p[0] = v % 3 + v / 3, p[1] = v % 3 - v / 3, p[2] = 0;
        }
        form = gproj_form_create(mesh, NULL);
        for (v = 0; v < 3; ++v)
            memcpy(target + 3 * v, mesh->position + 3 * lifted[v], 3 * sizeof(double)), target[3 * v + 2] = 1;
        gproj_add_targets(form, lines ? 2 : 3, lifted, target, 1);
        GPROJT_CHECK((lines ? gproj_add_collinear(form, count, all, 1) : gproj_add_coplanar(form, count, all, 1)) >= 0);
        result = gproj_solve(form, 50, NULL);
        if (result.outcome != GPROJ_CONVERGED) printf("    %d: %s\n", lines, result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        for (v = 0; v < count; ++v) GPROJT_NEAR(mesh->position[3 * all[v] + 2], 1, 1e-9);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Points that are on a plane or line already stay; sets too small to say anything, doubled vertices and weight 0 do no
   harm. */
GPROJT_TEST(special_sets) {
    static const int32_t few[] = {0, 5, 40}, doubled[] = {3, 3, 3, 3, 12, 12, 21};
    gproj_mesh *mesh = gprojt_square(0.1, 5);
    double *before = gprojt_keep(mesh);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t all[2 * (SIDE + 1)], k, group;
    gproj_result result;
    GPROJT_CHECK(gproj_form_group_info(form, gproj_add_coplanar(form, 3, few, 1)).rows == 0);
    GPROJT_CHECK(gproj_form_group_info(form, gproj_add_collinear(form, 2, few, 1)).rows == 0);
    GPROJT_CHECK(gproj_form_group_info(form, gproj_add_coplanar(form, 0, few, 1)).rows == 0);
    for (k = 0; k < 2 * (SIDE + 1); ++k) all[k] = k;
    group = gproj_add_coplanar(form, 2 * (SIDE + 1), all, 0);
    result = gproj_solve(form, 5, NULL);
    GPROJT_CHECK(gprojt_largest_move(mesh->position, before, mesh->vertex_count) < 1e-12);
    GPROJT_CHECK(gproj_form_group_info(form, group).max > 1e-3);
    gproj_add_coplanar(form, 7, doubled, 1); /* three places: any plane through them */
    result = gproj_solve(form, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_largest_move(mesh->position, before, mesh->vertex_count) < 1e-9);
    gproj_form_destroy(form);
    free(before);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(edges_orthogonal_to_a_plane) {
    static const double normal[3] = {1, 2, 20};
    static const int32_t edges[] = {3, 10, 41};
    gproj_mesh *mesh = gprojt_square(0.1, 6);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    int k;
    GPROJT_CHECK(gproj_add_orthogonal_edges(form, normal, 3, edges, 1) >= 0);
    GPROJT_CHECK(gproj_add_orthogonal_edges(form, normal, 1, NULL, 1) >= 0);
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    result = gproj_solve(form, 12, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    for (k = 0; k < 4; ++k) {
        int32_t edge = k < 3 ? edges[k] : 0;
        double d[3], c[3];
        gprojt_sub3(mesh->position + 3 * mesh->origin[2 * edge + 1], mesh->position + 3 * mesh->origin[2 * edge], d);
        gprojt_cross3(d, normal, c);
        GPROJT_CHECK(gprojt_length3(c) < 1e-12);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* An edge that is to be upright says nothing of vertices that it does not have. */
GPROJT_TEST(only_the_ends_of_edges_move) {
    static const double up[3] = {0, 0, 1};
    static const int32_t edge = 41;
    gproj_mesh *mesh = gprojt_square(0.1, 6);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double *before = gprojt_keep(mesh);
    int32_t a = mesh->origin[2 * edge], b = mesh->origin[2 * edge + 1], v;
    gproj_add_orthogonal_edges(form, up, 1, &edge, 1);
    GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED);
    for (v = 0; v < mesh->vertex_count; ++v)
        GPROJT_CHECK((gprojt_far(mesh->position + 3 * v, before + 3 * v) > 1e-12) == (v == a || v == b));
    free(before);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Only its direction counts: with lengths whose squares are beyond all numbers the solve has the same bits. */
GPROJT_TEST(normals_of_any_length) {
    double places[3][3 * (SIDE + 1) * (SIDE + 1)];
    int k;
    for (k = 0; k < 3; ++k) {
        const double length = ldexp(1, 660 * (k - 1)), normal[3] = {length, 2 * length, 20 * length};
        gproj_mesh *mesh = gprojt_square(0.1, 6);
        gproj_form *form = gproj_form_create(mesh, NULL);
        GPROJT_CHECK(gproj_add_orthogonal_edges(form, normal, 5, NULL, 1) >= 0);
        GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED);
        memcpy(places[k], mesh->position, sizeof places[k]);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    GPROJT_CHECK(!memcmp(places[0], places[1], sizeof places[1]));
    GPROJT_CHECK(!memcmp(places[2], places[1], sizeof places[1]));
}

/* At every boundary vertex of the grid but the corners, by numbers of the grid. */
GPROJT_TEST(boundary_at_right_angles) {
    gproj_mesh *mesh = gprojt_square(0.05, 6);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double before = 0, after;
    gproj_result result;
    int round;
    gproj_add_planarity(form, 1);
    GPROJT_CHECK(gproj_form_group_info(form, gproj_add_orthogonal_boundary(form, 1)).rows == 4 * (SIDE - 1));
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    for (round = 0; round < 2; ++round) {
        int32_t outer[SIDE + 1], side, k;
        for (side = 0, after = 0; side < 4; ++side) {
            int32_t inwards = side == 0 ? SIDE + 1 : side == 1 ? -SIDE - 1 : side == 2 ? 1 : -1;
            gprojt_side(side, outer);
            for (k = 1; k < SIDE; ++k) {
                const double *x = mesh->position;
                double t[3], b[3];
                gprojt_sub3(x + 3 * (outer[k] + inwards), x + 3 * outer[k], t);
                gprojt_sub3(x + 3 * outer[k + 1], x + 3 * outer[k - 1], b);
                after = fmax(after, fabs(gprojt_dot3(t, b)) / gprojt_length3(t) / gprojt_length3(b));
            }
        }
        if (round == 0) before = after;
        if (round == 0) result = gproj_solve(form, 12, NULL);
    }
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(before > 0.01 && after < 1e-12);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Under planarity the plan stays where it was; the heights change. */
GPROJT_TEST(lifting) {
    gproj_mesh *mesh = gprojt_square(0.1, 8);
    double *before = gprojt_keep(mesh), plan = 0, height = 0;
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    int32_t v;
    gproj_add_planarity(form, 1);
    GPROJT_CHECK(gproj_form_group_info(form, gproj_add_lifting(form, 1)).rows == 2 * mesh->vertex_count);
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    result = gproj_solve(form, 12, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    for (v = 0; v < 3 * mesh->vertex_count; ++v) {
        double moved = fabs(mesh->position[v] - before[v]);
        if (v % 3 == 2) height = fmax(height, moved);
        if (v % 3 != 2) plan = fmax(plan, moved);
    }
    GPROJT_CHECK(plan < 1e-13 && height > 1e-3);
    GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).planarity_max < 1e-12);
    gproj_form_destroy(form);
    free(before);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(refusals) {
    static const int32_t far[] = {0, 1, 2, 1000000};
    static const double zero[3] = {0, 0, 0}, none[3] = {0, 0, NAN}, up[3] = {0, 0, 1}, endless[3] = {0, INFINITY, 1};
    gproj_mesh *mesh = gprojt_noisy(0, 3, 0.1, 1);
    int i;
    for (i = 0; i < 9; ++i) {
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t group = i == 0   ? gproj_add_coplanar(form, 4, far, 1)
                        : i == 1 ? gproj_add_collinear(form, 4, far, 1)
                        : i == 2 ? gproj_add_coplanar(form, 10000, NULL, 1)
                        : i == 3 ? gproj_add_collinear(form, -1, far, 1)
                        : i == 4 ? gproj_add_orthogonal_edges(form, zero, 1, NULL, 1)
                        : i == 5 ? gproj_add_orthogonal_edges(form, NULL, 1, NULL, 1)
                        : i == 6 ? gproj_add_orthogonal_edges(form, none, 1, NULL, 1)
                        : i == 8 ? gproj_add_orthogonal_edges(form, endless, 1, NULL, 1)
                                 : gproj_add_orthogonal_edges(form, up, 4, far, 1);
        bool index = i < 2 || i == 7;
        GPROJT_CHECK(group == -1);
        GPROJT_CHECK(gproj_form_error(form)->code == (index ? GPROJ_ERROR_INDEX : GPROJ_ERROR_ARGUMENT));
        GPROJT_CHECK(gproj_add_lifting(form, 1) == -1 && gproj_add_orthogonal_boundary(form, 1) == -1);
        GPROJT_CHECK(gproj_add_planar_boundary(form, 1) == -1 && gproj_add_straight_boundary(form, 1) == -1);
        gproj_form_destroy(form);
    }
    GPROJT_CHECK(gproj_add_coplanar(NULL, 0, NULL, 1) == -1 && gproj_add_collinear(NULL, 0, NULL, 1) == -1);
    GPROJT_CHECK(gproj_add_planar_boundary(NULL, 1) == -1 && gproj_add_straight_boundary(NULL, 1) == -1);
    GPROJT_CHECK(gproj_add_orthogonal_edges(NULL, up, 0, NULL, 1) == -1);
    GPROJT_CHECK(gproj_add_orthogonal_boundary(NULL, 1) == -1 && gproj_add_lifting(NULL, 1) == -1);
    gproj_mesh_destroy(mesh);
}

static void gprojt_add_all(gproj_form *form, void *user) {
    static const int32_t vertices[] = {0, 5, 10, 15}, edges[] = {1};
    static const double up[3] = {0, 0, 1};
    (void)user;
    gprojt_added(form, gproj_add_coplanar(form, 4, vertices, 1));
    gprojt_added(form, gproj_add_collinear(form, 4, vertices, 1));
    gprojt_added(form, gproj_add_planar_boundary(form, 1));
    gprojt_added(form, gproj_add_straight_boundary(form, 1));
    gprojt_added(form, gproj_add_orthogonal_edges(form, up, 1, edges, 1));
    gprojt_added(form, gproj_add_orthogonal_boundary(form, 1));
    gprojt_added(form, gproj_add_lifting(form, 1));
}

static void gprojt_add_planes(gproj_form *form, void *user) {
    (void)user;
    gproj_add_planar_boundary(form, 1);
}

GPROJT_TEST(every_allocation_fails_once) {
    gproj_mesh *mesh = gprojt_noisy(0, 3, 0.05, 1);
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_add_all, NULL, 3, NULL) >= 20);
    gproj_mesh_destroy(mesh);
    mesh = gprojt_noisy(TUBE, 9, 0.02, 1); /* two loops without corners */
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_add_planes, NULL, 3, NULL) >= 20);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(boundaries_between_corners);
    GPROJT_RUN(loops_without_corners);
    GPROJT_RUN(chosen_vertices);
    GPROJT_RUN(planes_are_lifted);
    GPROJT_RUN(special_sets);
    GPROJT_RUN(edges_orthogonal_to_a_plane);
    GPROJT_RUN(only_the_ends_of_edges_move);
    GPROJT_RUN(normals_of_any_length);
    GPROJT_RUN(boundary_at_right_angles);
    GPROJT_RUN(lifting);
    GPROJT_RUN(refusals);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
