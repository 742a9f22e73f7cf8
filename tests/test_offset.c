/* test_offset.c - >>offset, and the conicality of >>form: conical meshes, parallel meshes at constant distance. */
#include "gprojt_form.h"
#include "gprojt_inside.h"

enum {
    GRID = 0,
    TRIANGLES = 1,
    HEXAGONS = 3,
    TORUS = 4,
    TUBE = 5,
    CUBE_SPHERE = 6
};

/* A moulding surface: an arch that follows a bent road in the planes orthogonal to it. Its lines are lines of curvature,
   so the mesh is nearly circular and nearly conical. */
static gproj_mesh *gprojt_moulding(int32_t along, int32_t across, double noise, uint64_t seed) {
    gprojt_soup s;
    double x = 0, y = 0, turn = 0;
    int32_t i, j;
    gproj_mesh *mesh;
    memset(&s, 0, sizeof s);
    for (i = 0; i <= along; ++i) {
        for (j = 0; j <= across; ++j) {
            double v = 2.2 * j / across - 1.1, r = 5 * sin(v), z = 4 * cos(v);
            gprojt_add_vertex(&s, x - r * sin(turn), y + r * cos(turn), z);
        }
        x += cos(turn);
        y += sin(turn);
        turn += 0.05 + 0.04 * sin(0.3 * i);
    }
    for (i = 0; i < along; ++i)
        for (j = 0; j < across; ++j) {
            int32_t a = i * (across + 1) + j;
            gprojt_add_quad(&s, a, a + across + 1, a + across + 2, a + 1);
        }
    mesh = gprojt_mesh_of(s);
    if (mesh) gprojt_shake(mesh, noise, seed);
    return mesh;
}

/* A surface of revolution with planar trapezoids: circular and conical to rounding. */
static gproj_mesh *gprojt_revolution(int32_t around, int32_t along) {
    gprojt_soup s;
    int32_t i, j;
    memset(&s, 0, sizeof s);
    for (j = 0; j <= along; ++j)
        for (i = 0; i < around; ++i) {
            double u = 6.283185307179586 * i / around, r = 2 + 0.5 * sin(0.9 * j);
            gprojt_add_vertex(&s, r * cos(u), r * sin(u), 0.6 * j);
        }
    for (j = 0; j < along; ++j)
        for (i = 0; i < around; ++i) {
            int32_t a = (i + 1) % around;
            gprojt_add_quad(&s, j * around + i, j * around + a, (j + 1) * around + a, (j + 1) * around + i);
        }
    return gprojt_mesh_of(s);
}

/* What is asked of a mesh: planar, and circular or conical. */
static gproj_result gprojt_shape_it(gproj_mesh *mesh, bool circular, bool conical, int32_t iterations) {
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    gproj_add_planarity(form, 1);
    if (circular) gproj_add_circularity(form, 1);
    if (conical) gproj_add_conicality(form, 1);
    result = gproj_solve(form, iterations, NULL);
    gproj_form_destroy(form);
    return result;
}

/* -- conicality -- */

/* The angle of the face on the left of a half-edge at its origin. */
static double gprojt_corner_angle(const gproj_mesh *mesh, int32_t h) {
    const double *p = mesh->position + 3 * mesh->origin[h], *a = mesh->position + 3 * mesh->origin[mesh->next[h]],
                 *b = mesh->position + 3 * mesh->origin[mesh->prev[h]];
    double u[3], v[3], w[3];
    int32_t i;
    for (i = 0; i < 3; ++i) u[i] = a[i] - p[i], v[i] = b[i] - p[i];
    gprojt_cross3(u, v, w);
    return atan2(gprojt_length3(w), gprojt_dot3(u, v));
}

/* A vertex of valence 4 is conical where the angles of its faces have w1 + w3 = w2 + w4 (Wang, Wallner, Liu 2007). The
   largest difference of the two sums over the mesh. */
static double gprojt_angle_balance(const gproj_mesh *mesh) {
    double worst = 0;
    int32_t v, k;
    for (v = 0; v < mesh->vertex_count; ++v) {
        int32_t h = mesh->vertex_halfedge[v];
        double sum = 0;
        if (gproj_mesh_is_boundary_vertex(mesh, v) || gproj_mesh_valence(mesh, v) != 4) continue;
        for (k = 0; k < 4; ++k, h = mesh->prev[h] ^ 1) sum += (k % 2 ? -1 : 1) * gprojt_corner_angle(mesh, h);
        worst = fmax(worst, fabs(sum));
    }
    return worst;
}

GPROJT_TEST(conical_meshes) {
    int i;
    for (i = 0; i < 5; ++i) {
        gproj_mesh *mesh = i == 0   ? gprojt_moulding(20, 10, 0.1, 3)
                           : i == 1 ? gprojt_noisy(TORUS, 8, 0.05, 4)
                           : i == 2 ? gprojt_noisy(CUBE_SPHERE, 5, 0.03, 5)
                           : i == 3 ? gprojt_noisy(TUBE, 6, 0.05, 6)
                                    : gprojt_noisy(TRIANGLES, 4, 0.02, 7);
        gproj_result result = gprojt_shape_it(mesh, false, true, 20);
        gproj_measures m = gproj_measure(mesh, NULL, NULL);
        if (result.outcome != GPROJ_CONVERGED) printf("    mesh %d: %s\n", i, result.message);
        GPROJT_CHECK(i == 4 || result.outcome == GPROJ_CONVERGED);
        if (result.outcome == GPROJ_CONVERGED) {
            GPROJT_CHECK(m.conicality_max < 1e-10 && m.planarity_max < 1e-12);
            GPROJT_CHECK(gprojt_angle_balance(mesh) < 1e-10);
            GPROJT_CHECK(m.degenerate_edges == 0 && m.turned_faces == 0);
        }
        gproj_mesh_destroy(mesh);
    }
}

/* Neighbouring faces that are coplanar must not satisfy the rows with any angles. */
GPROJT_TEST(conical_where_a_direction_is_flat) {
    gproj_mesh *mesh = gprojt_moulding(24, 8, 0.1, 8);
    int32_t i;
    for (i = 0; i < mesh->vertex_count; ++i) mesh->position[3 * i + 2] += 0.2 * sin(0.7 * (i / 9) + 0.5 * (i % 9));
    GPROJT_CHECK(gprojt_angle_balance(mesh) > 0.1);
    GPROJT_CHECK(gprojt_shape_it(mesh, false, true, 12).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_angle_balance(mesh) < 1e-11);
    gproj_mesh_destroy(mesh);
}

/* Where a vertex is flat its normals say nothing about angles: the verdict names it, and only there. */
GPROJT_TEST(flat_vertices_are_no_cones) {
    int i;
    for (i = 0; i < 3; ++i) {
        gproj_mesh *mesh = i == 2 ? gprojt_moulding(20, 10, 0.1, 3) : gprojt_mesh_of(gprojt_quad_grid(5, 5));
        gproj_result result;
        int32_t v;
        for (v = 0; v < mesh->vertex_count && i < 2; ++v) mesh->position[3 * v + 2] = 0;
        if (i == 0) mesh->position[3 * 14] += 0.05; /* of valence 4: no right angles any more */
        result = gprojt_shape_it(mesh, false, true, 20);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_CHECK((strstr(result.message, " the angles do not add up as on a cone") != NULL) == (i == 0));
        GPROJT_CHECK(i > 0 || strstr(result.message, "; but around 2 vertices, flat or folded,"));

        gproj_mesh_destroy(mesh);
    }
}

/* The rows against the determinant that they linearise, to second order; and their derivatives. */
GPROJT_TEST(conicality_rows_are_tangent) {
    gproj_mesh *mesh = gprojt_moulding(4, 4, 0.1, 2);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_system *s = gproj_form_system(form);
    int32_t group, v, row = 0, n;
    double *x, size = 1e-4;
    uint64_t state = 2;
    gproj_add_planarity(form, 1);
    group = gproj_add_conicality(form, 1);
    GPROJT_REQUIRE(group >= 0);
    x = gproj_system_values(s);
    n = gproj_system_variable_count(s);
    GPROJT_CHECK(n == 3 * (mesh->vertex_count + mesh->face_count + 9)); /* 9 interior vertices */
    GPROJT_CHECK(gproj_system_check_gradients(s) < 1e-7);               /* refreshes the rows */
    double *before = (double *)malloc((size_t)n * sizeof *before);
    memcpy(before, x, (size_t)n * sizeof *before);
    for (v = 0; v < n; ++v) x[v] += size * (2 * gprojt_uniform(&state) - 1);
    for (v = 0; v < mesh->vertex_count; ++v) {
        int32_t start = mesh->vertex_halfedge[v], h = start;
        const double *a = x + gprojt_inside_cone(form, v);
        if (gprojt_inside_cone(form, v) < 0) continue;
        GPROJT_NEAR(gproj_system_row_value(s, group, row++, NULL), gprojt_dot3(a, a) - 1, 1e-12);
        do {
            double e[3], m[3], frozen[3], cross[3];
            const double *p = x + 3 * v, *q = x + 3 * mesh->origin[h ^ 1];
            const double *f = x + gprojt_inside_normal(form, mesh->face[h]),
                         *g = x + gprojt_inside_normal(form, mesh->face[h ^ 1]);
            int32_t i;
            for (i = 0; i < 3; ++i) e[i] = q[i] - p[i], m[i] = f[i] + g[i];
            gprojt_sub3(before + 3 * mesh->origin[h ^ 1], before + 3 * v, frozen);
            gprojt_cross3(e, m, cross);
            GPROJT_NEAR(gproj_system_row_value(s, group, row++, NULL),
                        gprojt_dot3(a, cross) / (2 * gprojt_length3(frozen)), 30 * size * size);
            h = mesh->prev[h] ^ 1;
        } while (h != start);
    }
    GPROJT_CHECK(row == gprojt_info(s, group).rows);
    free(before);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* The largest difference of the angles of four normals with an axis. */
static double gprojt_angle_range(const double n[4][3], const double axis[3]) {
    double least = 10, most = 0;
    int32_t k;
    for (k = 0; k < 4; ++k) {
        double angle = acos(gprojt_dot3(n[k], axis) / gprojt_length3(axis));
        least = fmin(least, angle);
        most = fmax(most, angle);
    }
    return most - least;
}

/* Pyramids: over a rhombus and over a kite they touch a cone; over others the measure is compared with the best of many
   axes. */
GPROJT_TEST(conicality_is_measured) {
    static const double base[4][4] = {{1, 2, 1, 2}, {1, 2, 3, 2}, {1, 2, 2, 0.6}, {1, 3, 0.7, 1.2}};
    static const int32_t degree[4] = {3, 3, 3, 3}, corner[12] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1};
    int32_t i, k;
    for (i = 0; i < 4; ++i) {
        const double *b = base[i];
        double p[15] = {0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, n[4][3], best = 10, u, v, measured;
        gproj_mesh *mesh;
        p[3] = b[0], p[7] = b[1], p[9] = -b[2], p[13] = -b[3];
        mesh = gproj_mesh_create(5, p, 4, degree, corner, NULL, NULL);
        for (k = 0; k < 4; ++k) {
            double length;
            gproj_mesh_face_area_vector(mesh, k, n[k]);
            length = gprojt_length3(n[k]);
            n[k][0] /= length, n[k][1] /= length, n[k][2] /= length;
        }
        for (u = -1; u <= 1; u += 0.004)
            for (v = -1; v <= 1; v += 0.004) {
                double axis[3];
                axis[0] = u, axis[1] = v, axis[2] = 1;
                best = fmin(best, gprojt_angle_range((const double(*)[3])n, axis));
            }
        measured = gproj_measure(mesh, NULL, NULL).conicality_max;
        if (i < 2)
            GPROJT_CHECK(measured < 1e-14 && best < 0.01);
        else
            GPROJT_CHECK(best > 0.005 && measured > 0.7 * best && measured < 1.5 * best);
        gproj_mesh_destroy(mesh);
    }
    { /* at a boundary, where two edges have one face only: four of six faces of a pyramid */
        gprojt_soup soup;
        gproj_mesh *mesh;
        memset(&soup, 0, sizeof soup);
        gprojt_add_vertex(&soup, 0, 0, 1);
        for (k = 0; k < 5; ++k) gprojt_add_vertex(&soup, cos(k * acos(-1.0) / 3), sin(k * acos(-1.0) / 3), 0);
        for (k = 1; k < 5; ++k) gprojt_add_triangle(&soup, 0, k, k + 1);
        mesh = gprojt_mesh_of(soup);
        GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).conicality_max < 1e-12);
        gproj_mesh_destroy(mesh);
    }
    for (k = 3; k < 9; ++k) {
        gproj_mesh *mesh = gprojt_revolution(k, 4);
        GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).conicality_max < 1e-12);
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(conicality_begins_anew) {
    gproj_mesh *mesh = gprojt_moulding(10, 6, 0.1, 5);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    int32_t i;
    gproj_add_planarity(form, 1);
    gproj_add_conicality(form, 1);
    for (i = 0; i < 3; ++i) {
        result = gproj_solve(form, 16, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gprojt_angle_balance(mesh) < 1e-11);
        for (int32_t k = 0; k < mesh->vertex_count; ++k) { /* upside down */
            mesh->position[3 * k + 1] *= -1;
            mesh->position[3 * k + 2] *= -1;
        }
        gprojt_shake(mesh, 0.05, 9);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(conicality_refusals_and_weight_0) {
    gproj_mesh *mesh = gprojt_moulding(4, 4, 0.1, 5);
    gproj_form *form = gproj_form_create(mesh, NULL), *plain = gproj_form_create(mesh, NULL);
    double *start = gprojt_keep(mesh), *end;
    GPROJT_CHECK(gproj_add_conicality(NULL, 1) == -1);
    GPROJT_CHECK(gproj_add_conicality(form, 1) == -1 && gproj_form_error(form)->code == GPROJ_ERROR_STATE);
    gproj_form_destroy(form);
    gproj_add_planarity(plain, 1);
    gproj_solve(plain, 10, NULL);
    end = gprojt_keep(mesh);
    gprojt_put_back(mesh, start);
    form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1);
    GPROJT_CHECK(gproj_add_conicality(form, 0) >= 0);
    GPROJT_CHECK(gproj_solve(form, 10, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_largest_move(end, mesh->position, mesh->vertex_count) < 1e-9);
    gproj_form_destroy(form);
    gproj_form_destroy(plain);
    gproj_mesh_destroy(mesh);
    free(start);
    free(end);
}

/* Asked for twice there are two groups of rows, but one axis per vertex. */
GPROJT_TEST(conicality_twice) {
    gproj_mesh *mesh = gprojt_moulding(5, 4, 0.1, 5);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t group[2], variables;
    gproj_add_planarity(form, 1);
    group[0] = gproj_add_conicality(form, 1);
    variables = gproj_system_variable_count(gproj_form_system(form));
    group[1] = gproj_add_conicality(form, 0.5);
    GPROJT_CHECK(group[0] >= 0 && group[1] > group[0]);
    GPROJT_CHECK(gproj_form_group_info(form, group[0]).rows == gproj_form_group_info(form, group[1]).rows);
    GPROJT_CHECK(gproj_system_variable_count(gproj_form_system(form)) == variables);
    GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED && gprojt_angle_balance(mesh) < 1e-11);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* At a vertex of the boundary with four faces, too: four quads around vertex 0, over half a turn. Their normals are on a
   circle then, so in a plane. */
GPROJT_TEST(cones_at_the_boundary) {
    gprojt_soup soup;
    gproj_mesh *mesh;
    gproj_form *form;
    double n[4][3], d[3][3], across[3];
    int32_t group, k, f;
    memset(&soup, 0, sizeof soup);
    gprojt_add_vertex(&soup, 0, 0, 1);
    for (k = 0; k < 9; ++k) { /* ends of edges at vertex 0, and corners between them */
        double u = 3.141592653589793 * k / 8, r = k % 2 ? 1.5 : 1;
        gprojt_add_vertex(&soup, r * cos(u), r * sin(u), k % 2 ? 0.2 : 0.5 + 0.03 * k);
    }
    for (k = 0; k < 4; ++k) gprojt_add_quad(&soup, 0, 2 * k + 1, 2 * k + 2, 2 * k + 3);
    mesh = gprojt_mesh_of(soup);
    form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1);
    group = gproj_add_conicality(form, 1);
    GPROJT_CHECK(gproj_form_group_info(form, group).rows == 1 + 3); /* a row for each edge between two faces */
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    GPROJT_CHECK(gproj_solve(form, 40, NULL).outcome == GPROJ_CONVERGED);
    for (f = 0; f < 4; ++f) {
        double length;
        gproj_mesh_face_area_vector(mesh, f, n[f]);
        length = gprojt_length3(n[f]);
        for (k = 0; k < 3; ++k) n[f][k] /= length;
    }
    for (k = 0; k < 3; ++k) gprojt_sub3(n[k + 1], n[0], d[k]);
    gprojt_cross3(d[0], d[1], across);
    GPROJT_CHECK(gprojt_length3(across) > 0.01);
    GPROJT_NEAR(gprojt_dot3(across, d[2]), 0, 1e-11);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Five planes around a vertex touch a cone, with equal angles or not: an odd number is no reason for doubt. */
GPROJT_TEST(cones_of_five_faces) {
    int odd;
    for (odd = 0; odd < 2; ++odd) {
        gprojt_soup soup;
        gproj_mesh *mesh;
        gproj_form *form;
        gproj_result result;
        int32_t k;
        memset(&soup, 0, sizeof soup);
        gprojt_add_vertex(&soup, 0, 0, 1);
        for (k = 0; k < 5; ++k) {
            double u = 6.283185307179586 * (k + (odd ? 0.1 * sin(k) : 0)) / 5;
            gprojt_add_vertex(&soup, cos(u), sin(u), 0);
        }
        for (k = 0; k < 5; ++k) gprojt_add_triangle(&soup, 0, 1 + k, 1 + (k + 1) % 5);
        mesh = gprojt_mesh_of(soup);
        form = gproj_form_create(mesh, NULL);
        gproj_add_planarity(form, 1);
        GPROJT_CHECK(gproj_form_group_info(form, gproj_add_conicality(form, 1)).rows == 1 + 5);
        result = gproj_solve(form, 40, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gproj_measure(mesh, NULL, NULL).conicality_max < 1e-9);
        GPROJT_CHECK(!strstr(result.message, "do not add up"));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- offsets -- */

/* The largest sine of the angle between an edge and its offset, times the offset's length. */
static double gprojt_across(const gproj_mesh *a, const gproj_mesh *b) {
    double worst = 0;
    int32_t e, i;
    for (e = 0; e < a->edge_count; ++e) {
        double u[3], v[3], w[3];
        for (i = 0; i < 3; ++i) {
            u[i] = a->position[3 * a->origin[2 * e + 1] + i] - a->position[3 * a->origin[2 * e] + i];
            v[i] = b->position[3 * a->origin[2 * e + 1] + i] - b->position[3 * a->origin[2 * e] + i];
        }
        gprojt_cross3(u, v, w);
        worst = fmax(worst, gprojt_length3(w) / gprojt_length3(u));
    }
    return worst;
}

/* The point on three planes n_k'x = h_k by Cramer's rule. */
static void gprojt_three_planes(const double n[3][3], const double h[3], double out[3]) {
    double c[3], determinant;
    int32_t k, i;
    gprojt_cross3(n[1], n[2], c);
    determinant = gprojt_dot3(n[0], c);
    for (i = 0; i < 3; ++i) out[i] = 0;
    for (k = 0; k < 3; ++k) {
        gprojt_cross3(n[(k + 1) % 3], n[(k + 2) % 3], c);
        for (i = 0; i < 3; ++i) out[i] += h[k] * c[i] / determinant;
    }
}

/* The largest distance of an interior vertex of the offset from the point on three of the moved planes. */
static double gprojt_off_planes(const gproj_mesh *mesh, const gproj_mesh *offset, double distance) {
    double worst = 0;
    int32_t v, k;
    for (v = 0; v < mesh->vertex_count; ++v) {
        int32_t h = mesh->vertex_halfedge[v];
        double n[3][3], height[3], point[3];
        if (gproj_mesh_is_boundary_vertex(mesh, v)) continue;
        for (k = 0; k < 3; ++k, h = mesh->prev[h] ^ 1) {
            double length;
            gproj_mesh_face_area_vector(mesh, mesh->face[h], n[k]);
            length = gprojt_length3(n[k]);
            n[k][0] /= length, n[k][1] /= length, n[k][2] /= length;
            height[k] = gprojt_dot3(n[k], mesh->position + 3 * v) + distance;
        }
        gprojt_three_planes((const double(*)[3])n, height, point);
        worst = fmax(worst, gprojt_far(point, offset->position + 3 * v));
    }
    return worst;
}

GPROJT_TEST(face_offsets_of_conical_meshes) {
    int i;
    for (i = 0; i < 4; ++i) {
        gproj_mesh *mesh = i == 0   ? gprojt_moulding(20, 10, 0.1, 3)
                           : i == 1 ? gprojt_revolution(12, 6)
                           : i == 2 ? gprojt_noisy(CUBE_SPHERE, 4, 0.03, 5)
                                    : gprojt_noisy(TORUS, 8, 0.03, 4);
        double edge = gproj_mesh_mean_edge_length(mesh), distance = (i % 2 ? -0.3 : 0.3) * edge;
        gproj_mesh *offset, *support;
        gproj_offset_measures m;
        GPROJT_CHECK(gprojt_shape_it(mesh, false, true, 12).outcome == GPROJ_CONVERGED);
        offset = gproj_mesh_face_offset(mesh, distance, NULL, NULL);
        GPROJT_REQUIRE(offset && gprojt_validate_mesh(offset) == NULL);
        m = gproj_measure_offset(mesh, offset);
        GPROJT_NEAR(m.face_distance_min, distance, 1e-11 * edge);
        GPROJT_NEAR(m.face_distance_max, distance, 1e-11 * edge);
        GPROJT_CHECK(m.parallel_max < 1e-10 && m.support_planarity_max < 1e-10 && m.reversed_edges == 0);
        GPROJT_CHECK(m.vertex_distance_min >= fabs(distance) * (1 - 1e-12));
        GPROJT_CHECK(gprojt_across(mesh, offset) < 1e-10 * edge);
        GPROJT_CHECK(gprojt_off_planes(mesh, offset, distance) < 1e-9 * edge);
        support = gproj_mesh_support(mesh, offset, NULL, NULL);
        GPROJT_REQUIRE(support);
        GPROJT_CHECK(gproj_measure(support, NULL, NULL).planarity_max < 1e-10);
        GPROJT_CHECK(gproj_measure(offset, NULL, NULL).conicality_max < 1e-9);
        gproj_mesh_destroy(support);
        gproj_mesh_destroy(offset);
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(vertex_offsets_of_circular_meshes) {
    int i;
    for (i = 0; i < 4; ++i) {
        gproj_mesh *mesh = i == 0   ? gprojt_moulding(20, 10, 0.1, 3)
                           : i == 1 ? gprojt_revolution(12, 6)
                           : i == 2 ? gprojt_moulding(9, 8, 0.2, 5)
                                    : gprojt_revolution(9, 5);
        double edge = gproj_mesh_mean_edge_length(mesh), distance = (i % 2 ? -0.3 : 0.3) * edge;
        gproj_mesh *offset;
        gproj_offset_measures m;
        int32_t v;
        GPROJT_CHECK(gprojt_shape_it(mesh, true, false, 16).outcome == GPROJ_CONVERGED);
        offset = gproj_mesh_vertex_offset(mesh, distance, NULL, NULL);
        GPROJT_REQUIRE(offset && gprojt_validate_mesh(offset) == NULL);
        m = gproj_measure_offset(mesh, offset);
        for (v = 0; v < mesh->vertex_count; ++v)
            GPROJT_NEAR(gprojt_far(mesh->position + 3 * v, offset->position + 3 * v), fabs(distance), 1e-14 * edge);
        GPROJT_CHECK(m.parallel_max < 1e-10 && m.support_planarity_max < 1e-10);
        GPROJT_CHECK(gprojt_across(mesh, offset) < 1e-10 * edge);
        GPROJT_CHECK(m.face_distance_min * distance > 0 && m.face_distance_max * distance > 0);
        gproj_mesh_destroy(offset);
        gproj_mesh_destroy(mesh);
    }
}

/* Vertices on a sphere, triangles among the faces: only the radius closes around them, whatever the normals say. */
GPROJT_TEST(vertex_offsets_of_inscribed_meshes) {
    static const int shapes[3] = {GRID, TRIANGLES, HEXAGONS};
    static const double centre[3] = {0.4, 0.3, -0.5};
    int i;
    for (i = 0; i < 3; ++i) {
        gproj_mesh *mesh = gprojt_noisy(shapes[i], 5, 0.05, 4), *offset;
        int32_t v, k;
        for (v = 0; v < mesh->vertex_count; ++v) {
            double *p = mesh->position + 3 * v, d = gprojt_far(p, centre);
            for (k = 0; k < 3; ++k) p[k] = centre[k] + 2 * (p[k] - centre[k]) / d;
        }
        offset = gproj_mesh_vertex_offset(mesh, 0.25, NULL, NULL);
        GPROJT_REQUIRE(offset);
        for (v = 0; shapes[i] == TRIANGLES && v < mesh->vertex_count; ++v)
            for (k = 0; k < 3; ++k)
                GPROJT_NEAR(offset->position[3 * v + k] - centre[k], 1.125 * (mesh->position[3 * v + k] - centre[k]),
                            1e-8);
        GPROJT_CHECK(gproj_measure_offset(mesh, offset).parallel_max < 1e-8);
        gproj_mesh_destroy(offset);
        gproj_mesh_destroy(mesh);
    }
}

/* The folder of real meshes. */
GPROJT_TEST(real_circular_meshes) {
    static const int which[] = {5, 6};
    int i;
    for (i = 0; i < 2; ++i) {
        gproj_mesh *mesh = gprojt_load_real_mesh(which[i], NULL, NULL), *offset;
        gproj_offset_measures m;
        double distance;
        if (!mesh) GPROJT_SKIP("the folder of real meshes is not there");
        distance = 0.3 * gproj_mesh_mean_edge_length(mesh);
        GPROJT_CHECK(gprojt_shape_it(mesh, true, false, 12).outcome == GPROJ_CONVERGED);
        offset = gproj_mesh_vertex_offset(mesh, distance, NULL, NULL);
        m = gproj_measure_offset(mesh, offset);
        GPROJT_NEAR(m.vertex_distance_min, distance, 1e-12 * distance);
        GPROJT_NEAR(m.vertex_distance_max, distance, 1e-12 * distance);
        GPROJT_CHECK(m.parallel_max < 1e-10 && m.support_planarity_max < 1e-10);
        gproj_mesh_destroy(offset);
        gproj_mesh_destroy(mesh);
    }
}

/* Meshes that have no exact offset get one all the same, and the measures say how far off it is. */
GPROJT_TEST(inexact_offsets_are_told) {
    static const int shapes[] = {GRID, TRIANGLES, HEXAGONS, TORUS};
    int i;
    for (i = 0; i < 4; ++i) {
        gproj_mesh *mesh = gprojt_noisy(shapes[i], 6, 0.05, 9);
        double d = 0.2 * gproj_mesh_mean_edge_length(mesh);
        gproj_mesh *by_vertex = gproj_mesh_vertex_offset(mesh, d, NULL, NULL);
        gproj_mesh *by_face = gproj_mesh_face_offset(mesh, d, NULL, NULL);
        gproj_offset_measures m;
        GPROJT_REQUIRE(by_vertex && by_face);
        GPROJT_CHECK(gprojt_all_finite(by_vertex->position, 3 * mesh->vertex_count));
        GPROJT_CHECK(gprojt_all_finite(by_face->position, 3 * mesh->vertex_count));
        m = gproj_measure_offset(mesh, by_vertex);
        GPROJT_NEAR(m.vertex_distance_min, d, 1e-13);
        GPROJT_NEAR(m.vertex_distance_max, d, 1e-13);
        GPROJT_CHECK(m.parallel_max > 1e-4 && m.parallel_max < 1);
        m = gproj_measure_offset(mesh, by_face);
        GPROJT_CHECK(m.face_distance_max - m.face_distance_min > 1e-6 * d);
        gproj_mesh_destroy(by_vertex);
        gproj_mesh_destroy(by_face);
        gproj_mesh_destroy(mesh);
    }
}

/* out += P d, the part of d across an edge; sign -1: out -= P d. */
static void gprojt_add_across(const gproj_mesh *mesh, int32_t edge, const double d[3], double sign, double out[3]) {
    double along[3], length2, part;
    int32_t k;
    gprojt_sub3(mesh->position + 3 * mesh->origin[2 * edge + 1], mesh->position + 3 * mesh->origin[2 * edge], along);
    length2 = gprojt_dot3(along, along), part = gprojt_dot3(along, d) / length2;
    for (k = 0; k < 3; ++k) out[k] += sign * (d[k] - part * along[k]);
}

/* Face offsets of any mesh, by what they minimise: with x the field, n the faces' unit normals and P across an edge, the
   gradient of sum (n'x - 1)^2 + sum |P (x_j - x_i)|^2 over inner edges is 0; that of the same sum over boundary edges is
   0 in the plane of a corner's one face, or along the one edge between two faces. */
GPROJT_TEST(face_offsets_are_least) {
    static const int shapes[5] = {GRID, TRIANGLES, HEXAGONS, TORUS, CUBE_SPHERE};
    const double distance = 0.125;
    int i;
    for (i = 0; i < 5; ++i) {
        gproj_mesh *mesh = gprojt_noisy(shapes[i], 4, 0.08, 6), *offset;
        double *x = gprojt_keep(mesh), *slope[2], *normal;
        int32_t v, k, e, f, h, bound = 0;
        slope[0] = (double *)calloc(3 * (size_t)mesh->vertex_count, sizeof(double));
        slope[1] = (double *)calloc(3 * (size_t)mesh->vertex_count, sizeof(double));
        normal = (double *)calloc(3 * (size_t)mesh->face_count, sizeof(double));
        if (!slope[0] || !slope[1] || !normal) abort();
        offset = gproj_mesh_face_offset(mesh, distance, NULL, NULL);
        GPROJT_REQUIRE(offset);
        for (v = 0; v < 3 * mesh->vertex_count; ++v) x[v] = (offset->position[v] - mesh->position[v]) / distance;
        for (f = 0; f < mesh->face_count; ++f) {
            double *n = normal + 3 * f, area[3], length;
            for (k = 0, h = mesh->face_halfedge[f]; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
                gprojt_cross3(mesh->position + 3 * mesh->origin[h], mesh->position + 3 * mesh->origin[mesh->next[h]],
                              area);
                for (v = 0; v < 3; ++v) n[v] += area[v];
            }
            length = gprojt_length3(n);
            for (v = 0; v < 3; ++v) n[v] /= length;
            for (k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h])
                for (v = 0; v < 3; ++v)
                    slope[0][3 * mesh->origin[h] + v] += (gprojt_dot3(n, x + 3 * mesh->origin[h]) - 1) * n[v];
        }
        for (e = 0; e < mesh->edge_count; ++e) {
            int32_t a = mesh->origin[2 * e], b = mesh->origin[2 * e + 1];
            double *of = slope[mesh->face[2 * e + 1] < 0], d[3];
            gprojt_sub3(x + 3 * b, x + 3 * a, d);
            gprojt_add_across(mesh, e, d, 1, of + 3 * b);
            gprojt_add_across(mesh, e, d, -1, of + 3 * a);
        }
        for (v = 0; v < mesh->vertex_count; ++v) {
            double *s = slope[1] + 3 * v, left[3] = {0, 0, 0};
            int32_t start = mesh->vertex_halfedge[v], valence = gproj_mesh_valence(mesh, v);
            bool outer = gproj_mesh_is_boundary_vertex(mesh, v);
            /* A face that is not flat is not along its edges, which a vertex between two has moved along. */
            if (!outer || valence != 3 || shapes[i] == TRIANGLES)
                GPROJT_NEAR(gprojt_length3(slope[0] + 3 * v), 0, 1e-9);
            if (!outer || valence > 3) continue;
            h = mesh->next[mesh->twin[start]]; /* the first with a face */
            if (valence == 2) {
                const double *n = normal + 3 * mesh->face[h];
                for (k = 0; k < 3; ++k) left[k] = s[k] - gprojt_dot3(n, s) * n[k];
                GPROJT_NEAR(gprojt_length3(left), 0, 1e-9);
            } else {
                for (h = start; mesh->face[h | 1] < 0;) h = mesh->next[mesh->twin[h]];
                gprojt_add_across(mesh, h / 2, s, 1, left);
                GPROJT_NEAR(gprojt_dot3(s, s), gprojt_dot3(left, left), 1e-15);
            }
            ++bound;
        }
        GPROJT_CHECK((bound > 3) == (i < 3));
        free(slope[0]), free(slope[1]), free(normal), free(x);
        gproj_mesh_destroy(offset);
        gproj_mesh_destroy(mesh);
    }
}

/* Crumpled meshes, and meshes that are one point or a line: everything stays finite. */
GPROJT_TEST(meshes_without_shape) {
    int i;
    for (i = 0; i < 3 * GPROJT_SHAPES; ++i) {
        gproj_mesh *mesh = gprojt_noisy(i % GPROJT_SHAPES, 3, 2, 3), *a, *b;
        int32_t k, kind = i / GPROJT_SHAPES, n = 3 * mesh->vertex_count;
        for (k = 0; k < n; ++k)
            if (kind == 2 || (kind == 1 && k % 3)) mesh->position[k] = 1;
        a = gproj_mesh_vertex_offset(mesh, 0.1, NULL, NULL);
        b = gproj_mesh_face_offset(mesh, 0.1, NULL, NULL);
        GPROJT_REQUIRE(a && b);
        GPROJT_CHECK(gprojt_all_finite(a->position, n) && gprojt_all_finite(b->position, n));
        GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).conicality_max <= 3.2);
        GPROJT_CHECK(gproj_measure_offset(mesh, b).parallel_max >= 0);
        gprojt_shape_it(mesh, false, true, 3);
        GPROJT_CHECK(gprojt_all_finite(mesh->position, n));
        gproj_mesh_destroy(a);
        gproj_mesh_destroy(b);
        gproj_mesh_destroy(mesh);
    }
}

/* A flat mesh, with a vertex of its own and a second component: offsets are translations along the normals. */
GPROJT_TEST(flat_pieces) {
    static const double p[] = {0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0, 3, 1, 0, 9, 9, 9, 0, 0, 5, 0, 1, 5, 0, 0, 6};
    static const int32_t degree[] = {4, 3, 3}, corner[] = {0, 1, 2, 3, 1, 4, 2, 6, 7, 8};
    gproj_mesh *mesh = gproj_mesh_create(9, p, 3, degree, corner, NULL, NULL), *offset;
    int i, v;
    GPROJT_REQUIRE(mesh);
    for (i = 0; i < 2; ++i) {
        offset = i ? gproj_mesh_face_offset(mesh, 0.5, NULL, NULL) : gproj_mesh_vertex_offset(mesh, 0.5, NULL, NULL);
        GPROJT_REQUIRE(offset);
        GPROJT_CHECK(memcmp(offset->position + 15, p + 15, 3 * sizeof *p) == 0);
        for (v = 0; v < 9; ++v) {
            if (v == 5) continue;
            GPROJT_NEAR(offset->position[3 * v], p[3 * v] + (v > 5 ? 0.5 : 0), 1e-15);
            GPROJT_NEAR(offset->position[3 * v + 1], p[3 * v + 1], 1e-15);
            GPROJT_NEAR(offset->position[3 * v + 2], p[3 * v + 2] + (v < 5 ? 0.5 : 0), 1e-15);
        }
        gproj_mesh_destroy(offset);
    }
    gproj_mesh_destroy(mesh);
}

/* What is circular but for a little noise has the offset that it had without: the noise does not choose a direction. */
GPROJT_TEST(vertex_offsets_do_not_follow_noise) {
    static const double square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const int32_t degree = 4, corner[] = {0, 1, 2, 3};
    uint64_t seed = 3;
    int32_t round, i;
    for (round = 0; round < 40; ++round) {
        double p[12], noise = round % 2 ? 1e-7 : 2e-6;
        gproj_mesh *mesh, *offset;
        for (i = 0; i < 12; ++i) p[i] = square[i] + noise * (2 * gprojt_uniform(&seed) - 1);
        mesh = gproj_mesh_create(4, p, 1, &degree, corner, NULL, NULL);
        GPROJT_REQUIRE(mesh);
        offset = gproj_mesh_vertex_offset(mesh, 0.5, NULL, NULL);
        GPROJT_REQUIRE(offset);
        for (i = 0; i < 12; ++i) GPROJT_NEAR(offset->position[i], square[i] + 0.5 * (i % 3 == 2), 10 * noise);
        gproj_mesh_destroy(offset);
        gproj_mesh_destroy(mesh);
    }
}

/* The direction in which a skew quad's edges stay parallel is across its normal: all vertices go to the normal's side all
   the same. */
GPROJT_TEST(vertex_offsets_of_skew_quads) {
    static const int32_t degree = 4, corner[] = {0, 1, 2, 3};
    int32_t i, v;
    for (i = 1; i < 5; ++i) {
        double h = 0.2 * i, p[] = {0, 0, 0, 1, 0, 0.2 * i, 1, 1, 0, 0, 1, 0.2 * i};
        gproj_mesh *mesh = gproj_mesh_create(4, p, 1, &degree, corner, NULL, NULL);
        gproj_mesh *offset = gproj_mesh_vertex_offset(mesh, h, NULL, NULL);
        GPROJT_REQUIRE(offset);
        for (v = 0; v < 4; ++v) {
            GPROJT_CHECK(offset->position[3 * v + 2] > p[3 * v + 2] + 0.1 * h);
            GPROJT_NEAR(gprojt_far(offset->position + 3 * v, p + 3 * v), h, 1e-14);
        }
        gproj_mesh_destroy(offset);
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(offsets_scale_with_the_mesh) {
    gproj_mesh *mesh = gprojt_moulding(8, 6, 0.1, 4), *large, *a, *b;
    int32_t i, k;
    gprojt_shape_it(mesh, false, true, 12);
    large = gproj_mesh_copy(mesh, NULL, NULL);
    for (i = 0; i < 3 * mesh->vertex_count; ++i) large->position[i] *= 1000;
    for (k = 0; k < 2; ++k) {
        a = k ? gproj_mesh_face_offset(mesh, 0.3, NULL, NULL) : gproj_mesh_vertex_offset(mesh, 0.3, NULL, NULL);
        b = k ? gproj_mesh_face_offset(large, 300, NULL, NULL) : gproj_mesh_vertex_offset(large, 300, NULL, NULL);
        for (i = 0; i < 3 * mesh->vertex_count; ++i) GPROJT_NEAR(b->position[i] / 1000, a->position[i], 1e-9);
        gproj_mesh_destroy(a);
        gproj_mesh_destroy(b);
    }
    gproj_mesh_destroy(large);
    gproj_mesh_destroy(mesh);
}

/* -- measures, supports, refusals -- */

GPROJT_TEST(offsets_are_measured) {
    gproj_mesh *mesh = gprojt_noisy(CUBE_SPHERE, 4, 0, 1), *moved = gproj_mesh_copy(mesh, NULL, NULL);
    double edge = gproj_mesh_mean_edge_length(mesh);
    gproj_offset_measures m;
    int32_t i, h;
    for (i = 0; i < mesh->vertex_count; ++i) moved->position[3 * i] += 0.25; /* a translation */
    m = gproj_measure_offset(mesh, moved);
    GPROJT_CHECK(m.parallel_max < 1e-15 && m.support_planarity_max < 1e-15 && m.reversed_edges == 0);
    GPROJT_NEAR(m.vertex_distance_min, 0.25, 1e-15);
    GPROJT_NEAR(m.vertex_distance_max, 0.25, 1e-15);
    GPROJT_CHECK(m.face_distance_max > 0.2 && m.face_distance_max <= 0.25);
    GPROJT_NEAR(m.face_distance_min, -m.face_distance_max, 1e-14);
    for (i = 0; i < 3 * mesh->vertex_count; ++i) moved->position[i] = -2 * mesh->position[i];
    m = gproj_measure_offset(mesh, moved);
    GPROJT_CHECK(m.reversed_edges == mesh->edge_count && m.parallel_max < 1e-14);
    memcpy(moved->position, mesh->position, 3 * (size_t)mesh->vertex_count * sizeof(double));
    h = mesh->vertex_halfedge[7];
    for (i = 0; i < 3; ++i) /* one vertex out of the way, along an edge and across others */
        moved->position[3 * 7 + i] += 0.1 * (mesh->position[3 * mesh->origin[h ^ 1] + i] - mesh->position[3 * 7 + i]);
    m = gproj_measure_offset(mesh, moved);
    GPROJT_CHECK(m.vertex_distance_min <= 0 && m.vertex_distance_max > 0.05 * edge && m.parallel_max > 0.05);
    GPROJT_CHECK(m.parallel_max < 0.2);
    gproj_mesh_destroy(moved);
    gproj_mesh_destroy(mesh);
}

/* A vertex without faces, wherever it is, has no distance. */
GPROJT_TEST(offsets_of_stray_vertices_are_not_measured) {
    gprojt_soup soup = gprojt_quad_grid(3, 3);
    gproj_offset_measures m;
    gproj_mesh *mesh, *moved;
    int32_t stray = gprojt_add_vertex(&soup, 7, 7, 7), i;
    mesh = gprojt_mesh_of(soup);
    moved = gproj_mesh_copy(mesh, NULL, NULL);
    for (i = 0; i < mesh->vertex_count; ++i) moved->position[3 * i + 2] += i == stray ? 100 : 0.25;
    m = gproj_measure_offset(mesh, moved);
    GPROJT_NEAR(m.vertex_distance_min, 0.25, 1e-15);
    GPROJT_NEAR(m.vertex_distance_max, 0.25, 1e-15);
    gproj_mesh_destroy(moved);
    gproj_mesh_destroy(mesh);
}

/* One triangle: what lies behind its boundary is no face, which would be seen from the other side. */
GPROJT_TEST(faces_are_measured_and_no_holes) {
    static const double p[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const int32_t degree[] = {3}, corner[] = {0, 1, 2};
    gproj_mesh *mesh = gproj_mesh_create(3, p, 1, degree, corner, NULL, NULL);
    gproj_mesh *moved = gproj_mesh_copy(mesh, NULL, NULL);
    gproj_offset_measures m;
    int32_t i;
    GPROJT_REQUIRE(mesh && moved);
    for (i = 0; i < 3; ++i) moved->position[3 * i + 2] = 0.25;
    m = gproj_measure_offset(mesh, moved);
    GPROJT_NEAR(m.face_distance_min, 0.25, 1e-15);
    GPROJT_NEAR(m.face_distance_max, 0.25, 1e-15);
    gproj_mesh_destroy(moved);
    gproj_mesh_destroy(mesh);
}

/* Meshes of equally many vertices and half-edges, but of other edges, with other numbers of the vertices, or with a face
   in the place of a hole, are no offsets of each other. */
GPROJT_TEST(meshes_of_other_faces_are_no_offsets) {
    static const double p[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 1};
    static const int32_t degree[] = {3, 3, 3, 3, 4},
                         corner[][6] = {{0, 1, 2, 0, 2, 3}, {0, 1, 3, 1, 2, 3}, {1, 2, 3, 1, 3, 0}};
    static const int32_t roof[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 3, 2, 1, 0};
    int i;
    for (i = 0; i < 3; ++i) { /* the other diagonal of a quad, twice; a pyramid with and without its base */
        gproj_mesh *a = i == 2 ? gproj_mesh_create(5, p, 4, degree, roof, NULL, NULL)
                               : gproj_mesh_create(4, p, 2, degree, corner[0], NULL, NULL);
        gproj_mesh *b = i == 2 ? gproj_mesh_create(5, p, 5, degree, roof, NULL, NULL)
                               : gproj_mesh_create(4, p, 2, degree, corner[i + 1], NULL, NULL);
        gproj_mesh *other = gproj_mesh_create(5, p, 2, degree, corner[0], NULL, NULL);
        GPROJT_REQUIRE(a && b && other && a->vertex_count == b->vertex_count && a->edge_count == b->edge_count);
        GPROJT_CHECK(!gproj_mesh_support(a, b, NULL, NULL) && !gproj_mesh_support(a, other, NULL, NULL));
        GPROJT_CHECK(gproj_measure_offset(a, b).parallel_max == HUGE_VAL);
        GPROJT_CHECK(gproj_measure_offset(a, a).parallel_max < 1e-15);
        gproj_mesh_destroy(a), gproj_mesh_destroy(b), gproj_mesh_destroy(other);
    }
}

/* A vertex whose only face has no area stays where it is, but for edges to others that move. */
GPROJT_TEST(faces_without_area_stay) {
    gprojt_soup s;
    gproj_mesh *mesh, *offset;
    int32_t v;
    memset(&s, 0, sizeof s);
    for (v = 0; v < 4; ++v) gprojt_add_vertex(&s, v == 1 || v == 2, v > 1, 0);
    for (v = 0; v < 3; ++v) gprojt_add_vertex(&s, 5 + v, 0, 0); /* along a line */
    gprojt_add_quad(&s, 0, 1, 2, 3);
    gprojt_add_triangle(&s, 4, 5, 6);
    mesh = gprojt_mesh_of(s);
    offset = gproj_mesh_face_offset(mesh, 0.5, NULL, NULL);
    GPROJT_REQUIRE(offset != NULL);
    for (v = 0; v < 7; ++v) GPROJT_NEAR(offset->position[3 * v + 2], v < 4 ? 0.5 : 0, 1e-12);
    gproj_mesh_destroy(offset);
    gproj_mesh_destroy(mesh);
    memset(&s, 0, sizeof s);
    for (v = 0; v < 4; ++v) gprojt_add_vertex(&s, v == 1 || v == 2, v > 1, 0);
    gprojt_add_vertex(&s, 0.5, 0, 0); /* amid side 0-1 */
    gprojt_add_quad(&s, 0, 1, 2, 3);
    gprojt_add_triangle(&s, 1, 0, 4);
    mesh = gprojt_mesh_of(s);
    offset = gproj_mesh_face_offset(mesh, 0.5, NULL, NULL);
    GPROJT_REQUIRE(offset != NULL);
    for (v = 0; v < 5; ++v) GPROJT_NEAR(offset->position[3 * v + 2], 0.5, 1e-12);
    gproj_mesh_destroy(offset);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(supports) {
    gproj_mesh *mesh = gprojt_noisy(HEXAGONS, 4, 0.05, 1), *offset = gproj_mesh_copy(mesh, NULL, NULL), *support;
    int32_t e, i;
    for (i = 0; i < mesh->vertex_count; ++i) offset->position[3 * i + 2] += 0.1;
    support = gproj_mesh_support(mesh, offset, NULL, NULL);
    GPROJT_REQUIRE(support && gprojt_validate_mesh(support) == NULL);
    GPROJT_CHECK(support->vertex_count == 4 * mesh->edge_count && support->face_count == mesh->edge_count);
    for (e = 0; e < mesh->edge_count; ++e) {
        int32_t a = mesh->origin[2 * e], b = mesh->origin[2 * e + 1], want[4], k, h = support->face_halfedge[e];
        want[0] = want[3] = a, want[1] = want[2] = b;
        for (k = 0; k < 4; ++k, h = support->next[h]) {
            const gproj_mesh *from = k < 2 ? mesh : offset;
            GPROJT_CHECK(support->origin[h] == 4 * e + k);
            GPROJT_CHECK(gprojt_far(support->position + 12 * e + 3 * k, from->position + 3 * want[k]) <= 0);
        }
    }
    gproj_mesh_destroy(support);
    gproj_mesh_destroy(offset);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(refusals) {
    gproj_mesh *mesh = gprojt_noisy(GRID, 3, 0.1, 1), *other = gprojt_noisy(TORUS, 3, 0.1, 1);
    gproj_mesh *offset = gproj_mesh_face_offset(mesh, 0.1, NULL, NULL);
    gproj_error error;
    GPROJT_REQUIRE(offset != NULL);
    GPROJT_CHECK(!gproj_mesh_vertex_offset(NULL, 1, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(strstr(error.message, "NULL") != NULL);
    GPROJT_CHECK(!gproj_mesh_face_offset(NULL, 1, NULL, NULL));
    GPROJT_CHECK(!gproj_mesh_face_offset(mesh, NAN, NULL, &error) && error.code == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(strstr(error.message, "distance") != NULL);
    GPROJT_CHECK(error.place == GPROJ_PLACE_NONE && error.index == -1); /* of no element */
    GPROJT_CHECK(!gproj_mesh_vertex_offset(mesh, INFINITY, NULL, &error) && error.code == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(!gproj_mesh_vertex_offset(mesh, 1e300, NULL, &error) && error.code == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(!gproj_mesh_support(mesh, other, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_support(NULL, other, NULL, &error) && !gproj_mesh_support(mesh, NULL, NULL, NULL));
    GPROJT_CHECK(gproj_measure_offset(mesh, other).parallel_max == HUGE_VAL);
    GPROJT_CHECK(gproj_measure_offset(NULL, NULL).face_distance_max == HUGE_VAL);
    mesh->position[4] = NAN;
    GPROJT_CHECK(!gproj_mesh_face_offset(mesh, 1, NULL, &error) && error.code == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.place == GPROJ_PLACE_VERTEX && error.index == 1);
    GPROJT_CHECK(!gproj_mesh_support(mesh, offset, NULL, &error) && error.code == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.place == GPROJ_PLACE_VERTEX && error.index == 1); /* the mesh's, not the support's */
    mesh->position[4] = 0, offset->position[3] = INFINITY;
    GPROJT_CHECK(!gproj_mesh_support(mesh, offset, NULL, &error) && error.index == 1);
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(other);
    gproj_mesh_destroy(offset);
}

static bool gprojt_use_offsets(const gproj_host *host, void *user) {
    gproj_mesh *mesh = (gproj_mesh *)user, *a = gproj_mesh_vertex_offset(mesh, 0.1, host, NULL);
    gproj_mesh *b = gproj_mesh_face_offset(mesh, 0.1, host, NULL);
    gproj_mesh *support = gproj_mesh_support(mesh, a ? a : b, host, NULL);
    int missing = !a + !b + !support;
    GPROJT_CHECK(missing <= 1);
    gproj_mesh_destroy(a);
    gproj_mesh_destroy(b);
    gproj_mesh_destroy(support);
    return missing == 0;
}

static void gprojt_add_conicality(gproj_form *form, void *user) {
    (void)user;
    gprojt_added(form, gproj_add_planarity(form, 1));
    gprojt_added(form, gproj_add_conicality(form, 1));
}

GPROJT_TEST(every_allocation_fails_once) {
    gproj_mesh *mesh = gprojt_noisy(CUBE_SPHERE, 2, 0.02, 1);
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_add_conicality, NULL, 2, NULL) >= 20);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_offsets, mesh) >= 10);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(conical_meshes);
    GPROJT_RUN(conical_where_a_direction_is_flat);
    GPROJT_RUN(flat_vertices_are_no_cones);
    GPROJT_RUN(conicality_rows_are_tangent);
    GPROJT_RUN(conicality_is_measured);
    GPROJT_RUN(conicality_begins_anew);
    GPROJT_RUN(conicality_refusals_and_weight_0);
    GPROJT_RUN(conicality_twice);
    GPROJT_RUN(cones_at_the_boundary);
    GPROJT_RUN(cones_of_five_faces);
    GPROJT_RUN(face_offsets_of_conical_meshes);
    GPROJT_RUN(vertex_offsets_of_circular_meshes);
    GPROJT_RUN(vertex_offsets_of_inscribed_meshes);
    GPROJT_RUN(real_circular_meshes);
    GPROJT_RUN(inexact_offsets_are_told);
    GPROJT_RUN(face_offsets_are_least);
    GPROJT_RUN(meshes_without_shape);
    GPROJT_RUN(flat_pieces);
    GPROJT_RUN(vertex_offsets_do_not_follow_noise);
    GPROJT_RUN(vertex_offsets_of_skew_quads);
    GPROJT_RUN(offsets_scale_with_the_mesh);
    GPROJT_RUN(offsets_are_measured);
    GPROJT_RUN(offsets_of_stray_vertices_are_not_measured);
    GPROJT_RUN(faces_are_measured_and_no_holes);
    GPROJT_RUN(meshes_of_other_faces_are_no_offsets);
    GPROJT_RUN(faces_without_area_stay);
    GPROJT_RUN(supports);
    GPROJT_RUN(refusals);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
