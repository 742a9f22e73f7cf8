/* test_shape.c - >>form: circular faces, parallelograms, equal areas, volume; and their measures. */
#include "gprojt_form.h"
#include "gprojt_inside.h"

enum {
    TUBE = 5,
    CUBE_SPHERE = 6,
    TORUS = 4
};

/* The largest distance of a face's vertices from the circle through its first three, computed apart from the library. */
static double gprojt_off_circle(const gproj_mesh *mesh, int32_t face) {
    const double *p[64];
    double a[3], b[3], n[3], c[3], t[3], u[3], nn, radius, worst = 0;
    int32_t h = mesh->face_halfedge[face], k, i;
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h]) p[k] = mesh->position + 3 * mesh->origin[h];
    for (i = 0; i < 3; ++i) a[i] = p[0][i] - p[2][i], b[i] = p[1][i] - p[2][i];
    gprojt_cross3(a, b, n);
    nn = gprojt_dot3(n, n);
    /* circumcentre of a triangle: c = p2 + ((|a|^2 b - |b|^2 a) x (a x b)) / (2 |a x b|^2) */
    for (i = 0; i < 3; ++i) t[i] = gprojt_dot3(a, a) * b[i] - gprojt_dot3(b, b) * a[i];
    gprojt_cross3(t, n, u);
    for (i = 0; i < 3; ++i) c[i] = p[2][i] + u[i] / (2 * nn);
    radius = gprojt_far(p[0], c);
    for (k = 3; k < mesh->face_degree[face]; ++k) {
        double d[3];
        gprojt_sub3(p[k], c, d);
        worst = fmax(worst, fmax(fabs(gprojt_length3(d) - radius), fabs(gprojt_dot3(d, n)) / sqrt(nn)));
    }
    return worst;
}

GPROJT_TEST(circular_faces) {
    static const int shapes[] = {1, 2, TORUS, TUBE};
    int i;
    for (i = 0; i < 4; ++i) {
        int shape = shapes[i];
        gproj_mesh *mesh = gprojt_noisy(shape, 6, 0.05, 11);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_result result;
        double worst = 0;
        int32_t f;
        gproj_add_planarity(form, 1);
        GPROJT_CHECK(gproj_add_circularity(form, 1) >= 0);
        GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
        result = gproj_solve(form, 30, NULL);
        for (f = 0; f < mesh->face_count; ++f) worst = fmax(worst, gprojt_off_circle(mesh, f));
        if (result.outcome != GPROJ_CONVERGED || !(worst < 1e-10))
            printf("    shape %d: worst %g; %s\n", shape, worst, result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && worst < 1e-10);
        GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).circularity_max < 1e-9);
        GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).degenerate_edges == 0);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* What a face lacks to be circular does not depend on where in the mesh it is: two of them, and one by itself. */
GPROJT_TEST(circles_begin_at_their_faces) {
    static const double quad[4][3] = {{0, 0, 0}, {1, 0, 0.3}, {1.2, 1, 0}, {0, 1, 0.2}};
    double residual[2];
    int32_t k, i, face[4];
    for (k = 0; k < 2; ++k) {
        gprojt_soup soup;
        gproj_mesh *mesh;
        gproj_form *form;
        memset(&soup, 0, sizeof soup);
        for (i = 0; i < 4 * (k + 1); ++i) {
            double away = i < 4 ? 0 : 20;
            face[i % 4] = gprojt_add_vertex(&soup, quad[i % 4][0] + away, quad[i % 4][1], quad[i % 4][2] + away);
            if (i % 4 == 3) gprojt_add_face(&soup, 4, face);
        }
        mesh = gprojt_mesh_of(soup);
        form = gproj_form_create(mesh, NULL);
        gproj_add_circularity(form, 1);
        residual[k] = gproj_solve(form, 0, NULL).residual;
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    GPROJT_CHECK(residual[0] > 0.01);
    GPROJT_NEAR(residual[1], residual[0], 1e-12);
}

GPROJT_TEST(circular_real_meshes) {
    static const char *const names[] = {"eyeye_circular.obj", "formfinding-circular.obj"};
    int i;
    for (i = 0; i < 2; ++i) {
        char path[512];
        gproj_mesh *mesh;
        gproj_form *form;
        gproj_result result;
        double worst = 0;
        int32_t f;
        snprintf(path, sizeof path, "%s/%s", gprojt_data_folder(), names[i]);
        mesh = gproj_mesh_load(path, NULL, NULL);
        if (!mesh) GPROJT_SKIP("the folder of real meshes is not there");
        form = gproj_form_create(mesh, NULL);
        gproj_add_planarity(form, 1);
        gproj_add_circularity(form, 1);
        result = gproj_solve(form, 12, NULL);
        for (f = 0; f < mesh->face_count; ++f) worst = fmax(worst, gprojt_off_circle(mesh, f));
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && worst / gproj_mesh_mean_edge_length(mesh) < 1e-9);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Known volumes: a box, a prism over the plane; and the derivatives against central differences. */
/* Two groups of the same rows act as one: they have their axis points in common. */
GPROJT_TEST(circularity_twice) {
    gproj_mesh *mesh = gprojt_noisy(2, 4, 0.05, 3);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_add_planarity(form, 1);
    GPROJT_CHECK(gproj_add_circularity(form, 1) >= 0);
    GPROJT_CHECK(gproj_add_circularity(form, 0.5) >= 0);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).circularity_max < 1e-9);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(volumes) {
    static const double box[24] = {0, 0, 0, 2, 0, 0, 2, 3, 0, 0, 3, 0, 0, 0, 4, 2, 0, 4, 2, 3, 4, 0, 3, 4};
    static const int32_t degree[6] = {4, 4, 4, 4, 4, 4};
    static const int32_t corner[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    gproj_mesh *closed = gproj_mesh_create(8, box, 6, degree, corner, NULL, NULL);
    gproj_mesh *open = gproj_mesh_create(8, box, 1, degree, corner + 4, NULL, NULL), *mesh[2];
    int i;
    GPROJT_REQUIRE(closed && open);
    GPROJT_NEAR(gproj_volume(closed), 24, 1e-12);
    GPROJT_NEAR(gproj_volume(open), 24, 1e-12);
    GPROJT_CHECK(gproj_volume(NULL) == 0);
    mesh[0] = gprojt_noisy(CUBE_SPHERE, 3, 0.2, 5);
    mesh[1] = gprojt_noisy(0, 4, 0.2, 6);
    for (i = 0; i < 2; ++i) {
        int32_t n = 3 * mesh[i]->vertex_count, k;
        double *gradient = (double *)calloc((size_t)n, sizeof *gradient), *x = mesh[i]->position;
        gprojt_inside_volume(mesh[i], x, 0.5, gradient);
        for (k = 0; k < n; ++k) {
            double kept = x[k], up, down;
            x[k] = kept + 1e-5;
            up = gprojt_inside_volume(mesh[i], x, 0.5, NULL);
            x[k] = kept - 1e-5;
            down = gprojt_inside_volume(mesh[i], x, 0.5, NULL);
            x[k] = kept;
            GPROJT_NEAR(gradient[k] / 6, (up - down) / 2e-5, 1e-8);
        }
        free(gradient);
        gproj_mesh_destroy(mesh[i]);
    }
    gproj_mesh_destroy(closed);
    gproj_mesh_destroy(open);
}

GPROJT_TEST(volume_is_reached) {
    static const int shapes[] = {TORUS, CUBE_SPHERE, 0};
    int i;
    for (i = 0; i < 3; ++i) {
        gproj_mesh *mesh = gprojt_noisy(shapes[i], 6, 0.02, 3);
        double wanted;
        gproj_form *form;
        gproj_result result;
        int32_t v;
        for (v = 0; v < mesh->vertex_count; ++v) mesh->position[3 * v + 2] += 7; /* off the plane z = 0 */
        wanted = 1.2 * gproj_volume(mesh);
        form = gproj_form_create(mesh, NULL);
        gproj_add_planarity(form, 1);
        GPROJT_CHECK(gproj_add_volume(form, wanted, 1) >= 0);
        result = gproj_solve(form, 20, NULL);
        if (result.outcome != GPROJ_CONVERGED) printf("    shape %d: %s\n", shapes[i], result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_NEAR(gproj_volume(mesh) / wanted, 1, 1e-12);
        GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).planarity_max < 1e-12);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Wishes: what they measure becomes better, with planar faces all the same. */
/* Areas that are equal already are so in the rows, too. */
GPROJT_TEST(equal_areas_hold_on_a_grid) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(4, 4));
    gproj_form *form;
    int32_t group, v;
    for (v = 0; v < mesh->vertex_count; ++v) mesh->position[3 * v + 2] = 0;
    form = gproj_form_create(mesh, NULL);
    group = gproj_add_equal_areas(form, 1);
    gproj_solve(form, 0, NULL);
    GPROJT_CHECK(gproj_form_group_info(form, group).rows == 16 && gproj_form_group_info(form, group).max < 1e-14);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(areas_become_more_equal) {
    gproj_mesh *mesh = gprojt_noisy(0, 8, 0.15, 4);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double before = gproj_measure(mesh, NULL, NULL).area_spread, after;
    gproj_result result;
    gproj_add_planarity(form, 1);
    gproj_add_gliding_boundary(form, 1);
    GPROJT_CHECK(gproj_add_equal_areas(form, 0.2) >= 0);
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    result = gproj_solve(form, 20, NULL);
    after = gproj_measure(mesh, NULL, NULL).area_spread;
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && after < 0.7 * before);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

static double gprojt_parallelogram_error(const gproj_mesh *mesh) {
    double sum = 0;
    int32_t f, i;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t a = mesh->face_halfedge[f], b = mesh->next[a], c = mesh->next[b], d = mesh->next[c];
        for (i = 0; i < 3; ++i) {
            double e = mesh->position[3 * mesh->origin[a] + i] - mesh->position[3 * mesh->origin[b] + i] +
                       mesh->position[3 * mesh->origin[c] + i] - mesh->position[3 * mesh->origin[d] + i];
            sum += e * e;
        }
    }
    return sqrt(sum / mesh->face_count);
}

GPROJT_TEST(quads_become_parallelograms) {
    gproj_mesh *mesh = gprojt_noisy(0, 8, 0.1, 4);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double before = gprojt_parallelogram_error(mesh);
    gproj_result result;
    gproj_add_planarity(form, 1);
    gproj_add_fixed_corners(form, 1);
    GPROJT_CHECK(gproj_add_parallelograms(form, 0.02) >= 0);
    result = gproj_solve(form, 20, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gprojt_parallelogram_error(mesh) < 0.6 * before);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A trapezoid is no parallelogram: |v0 - v1 + v2 - v3| is the difference of the parallel sides. By the wish alone it
   becomes one. */
GPROJT_TEST(trapezoids_become_parallelograms) {
    static const double sides[4][3] = {{0, 0, 0}, {2, 0, 0}, {1.5, 1, 0}, {0.5, 1, 0}};
    gprojt_soup soup;
    gproj_mesh *mesh;
    gproj_form *form;
    gproj_solve_options options;
    int32_t corner[4] = {0, 1, 2, 3}, group, k;
    memset(&soup, 0, sizeof soup);
    memset(&options, 0, sizeof options);
    for (k = 0; k < 4; ++k) gprojt_add_vertex(&soup, sides[k][0], sides[k][1], sides[k][2]);
    gprojt_add_face(&soup, 4, corner);
    mesh = gprojt_mesh_of(soup);
    form = gproj_form_create(mesh, NULL);
    group = gproj_add_parallelograms(form, 1);
    gproj_set_schedule(form, group, gprojt_schedule(1, 1, INT32_MAX));
    for (k = 0; k < 3; ++k)
        GPROJT_NEAR(fabs(gproj_system_row_value(gproj_form_system(form), group, k, NULL)) * gprojt_unit(form), k == 0,
                    1e-14);
    options.skip_closeness = true;
    gproj_solve(form, 10, &options);
    GPROJT_CHECK(gprojt_parallelogram_error(mesh) < 1e-6 && gproj_form_group_info(form, group).max < 1e-6);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* The area row's derivatives: what it says at x + d against the area there, to second order. */
GPROJT_TEST(area_rows_are_tangent) {
    gproj_mesh *mesh = gprojt_noisy(CUBE_SPHERE, 3, 0.1, 8);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_system *s = gproj_form_system(form);
    int32_t group = gproj_add_equal_areas(form, 1), f, v;
    double *x = gproj_system_values(s), centre[3], scale;
    uint64_t state = 2;
    gproj_form_units(form, centre, &scale);
    gproj_system_check_gradients(s); /* refreshes the rows */
    for (v = 0; v < 3 * mesh->vertex_count; ++v) x[v] += 1e-4 * (2 * gprojt_uniform(&state) - 1);
    for (v = 0; v < 3 * mesh->vertex_count; ++v) mesh->position[v] = x[v] / scale + centre[v % 3];
    for (f = 0; f < mesh->face_count; ++f) {
        double area[3];
        gproj_mesh_face_area_vector(mesh, f, area);
        GPROJT_NEAR(gproj_system_row_value(s, group, f, NULL) + x[gproj_system_variable_count(s) - 1],
                    gprojt_length3(area) * scale * scale, 1e-7);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Lengths that were changed by noise come back; edges 0 and 5 become what is asked for. */
GPROJT_TEST(lengths) {
    static const int32_t edges[] = {0, 5};
    gproj_mesh *mesh = gprojt_noisy(1, 6, 0.02, 9);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double wanted[2], *kept = (double *)malloc((size_t)mesh->edge_count * sizeof *kept);
    gproj_result result;
    int32_t e;
    GPROJT_REQUIRE(kept);
    for (e = 0; e < mesh->edge_count; ++e) kept[e] = gprojt_edge_length(mesh, e);
    gprojt_shake(mesh, 0.01, 5);
    GPROJT_CHECK(gproj_add_lengths(form, mesh->edge_count, NULL, NULL, 1) >= 0);
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    result = gproj_solve(form, 20, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_NEAR(gprojt_edge_length(mesh, e), kept[e], 1e-12);
    gproj_form_destroy(form);
    form = gproj_form_create(mesh, NULL);
    wanted[0] = 1.1 * kept[0];
    wanted[1] = 0.9 * kept[5];
    gproj_add_lengths(form, 2, edges, wanted, 1);
    result = gproj_solve(form, 12, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    GPROJT_NEAR(gprojt_edge_length(mesh, 0), wanted[0], 1e-12);
    GPROJT_NEAR(gprojt_edge_length(mesh, 5), wanted[1], 1e-12);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(kept);
}

GPROJT_TEST(equal_lengths) {
    gproj_mesh *mesh = gprojt_noisy(0, 6, 0.1, 9);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double length;
    gproj_result result;
    int32_t e;
    GPROJT_CHECK(gproj_add_equal_lengths(form, mesh->edge_count, NULL, 1) >= 0);
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    result = gproj_solve(form, 20, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    length = gprojt_edge_length(mesh, 0);
    GPROJT_CHECK(length > 0.01);
    for (e = 1; e < mesh->edge_count; ++e) GPROJT_NEAR(gprojt_edge_length(mesh, e), length, 1e-11);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Edges that are equal already are so in the rows, too. */
GPROJT_TEST(equal_lengths_hold_on_a_grid) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(4, 4));
    gproj_form *form;
    gproj_result result;
    int32_t v;
    for (v = 0; v < mesh->vertex_count; ++v) mesh->position[3 * v + 2] = 0;
    form = gproj_form_create(mesh, NULL);
    gproj_add_equal_lengths(form, mesh->edge_count, NULL, 1);
    result = gproj_solve(form, 0, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.residual < 1e-14);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(refusals_of_lengths) {
    static const int32_t far[] = {0, 1000000};
    static const double none[] = {0, 1};
    gproj_mesh *mesh = gprojt_noisy(0, 3, 0.1, 1);
    int i;
    for (i = 0; i < 4; ++i) {
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t group = i == 0   ? gproj_add_lengths(form, 2, far, NULL, 1)
                        : i == 1 ? gproj_add_equal_lengths(form, -1, NULL, 1)
                        : i == 2 ? gproj_add_lengths(form, 2, NULL, none, 1)
                                 : gproj_add_equal_lengths(form, mesh->edge_count + 1, NULL, 1);
        GPROJT_CHECK(group == -1);
        GPROJT_CHECK(gproj_form_error(form)->code == (i == 0 ? GPROJ_ERROR_INDEX : GPROJ_ERROR_ARGUMENT));
        GPROJT_CHECK(i % 2 || gproj_form_error(form)->place == GPROJ_PLACE_EDGE);
        gproj_form_destroy(form);
    }
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(refusals) {
    gproj_mesh *mesh = gprojt_noisy(0, 3, 0.1, 1);
    gproj_form *form = gproj_form_create(mesh, NULL);
    GPROJT_CHECK(gproj_add_volume(form, NAN, 1) == -1 && gproj_form_error(form)->code == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(gproj_form_error(form)->place == GPROJ_PLACE_NONE && gproj_form_error(form)->index == -1);
    GPROJT_CHECK(gproj_add_circularity(form, 1) == -1 && gproj_add_parallelograms(form, 1) == -1);
    GPROJT_CHECK(gproj_add_equal_areas(form, 1) == -1 && gproj_add_volume(NULL, 1, 1) == -1);
    GPROJT_CHECK(gproj_add_circularity(NULL, 1) == -1 && gproj_add_equal_areas(NULL, 1) == -1);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

static void gprojt_add_all(gproj_form *form, void *user) {
    gprojt_added(form, gproj_add_planarity(form, 1));
    gprojt_added(form, gproj_add_circularity(form, 1));
    gprojt_added(form, gproj_add_volume(form, 1.1 * gproj_volume((const gproj_mesh *)user), 1));
    gprojt_added(form, gproj_add_equal_areas(form, 0.1));
    gprojt_added(form, gproj_add_parallelograms(form, 0.1));
    gprojt_added(form, gproj_add_lengths(form, 2, NULL, NULL, 1));
    gprojt_added(form, gproj_add_equal_lengths(form, 3, NULL, 1));
}

/* What holds may be spoiled all the same: the verdict says so. */
GPROJT_TEST(spoiled_meshes_are_told) {
    gproj_mesh *mesh = gprojt_noisy(0, 4, 0, 1);
    const int32_t *end = mesh->origin; /* of edge 0 */
    int32_t pair[2], e, k;
    double places[6] = {0, 0, 0, 0, 0, 0}, lengths[64];
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    pair[0] = end[0], pair[1] = end[1];
    gproj_add_targets(form, 2, pair, places, 1);
    result = gproj_solve(form, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && strstr(result.message, "; but the mesh is spoiled: ") &&
                 strstr(result.message, "1 edge collapsed (edge 0, vertices ") && result.spoiled.collapsed_edges == 1);
    result = gproj_solve(form, 5, NULL); /* not in this solve, but in the whole work */
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.spoiled.collapsed_edges == 1 &&
                 strstr(result.message, "1 edge collapsed"));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    mesh = gprojt_noisy(0, 4, 0, 1); /* the caller moves a vertex, and the solve finds that all holds already */
    form = gproj_form_create(mesh, NULL);
    mesh->position[3 * pair[0]] += 9;
    gproj_add_targets(form, 1, pair, mesh->position + 3 * (size_t)pair[0], 1);
    result = gproj_solve(form, 5, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.spoiled.total > 0 && strstr(result.message, "is spoiled"));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    mesh = gprojt_noisy(0, 4, 0, 1);
    form = gproj_form_create(mesh, NULL);
    for (e = 0; e < mesh->edge_count; ++e) lengths[e] = 0.1 * gproj_mesh_mean_edge_length(mesh);
    gproj_add_lengths(form, mesh->edge_count, NULL, lengths, 1);
    result = gproj_solve(form, 60, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && strstr(result.message, "; but the mesh has shrunk to 0.1 of"));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    for (k = 0; k < 2; ++k) { /* smaller as a whole, with an edge without length: a mesh of a tenth has worse to tell */
        double *smaller, size = k ? 0.1 : 0.3;
        mesh = gprojt_noisy(0, 4, 0, 1);
        smaller = gprojt_keep(mesh);
        memcpy(smaller + 3 * pair[0], smaller + 3 * pair[1], 3 * sizeof(double));
        for (e = 0; e < 3 * mesh->vertex_count; ++e) smaller[e] *= size;
        form = gproj_form_create(mesh, NULL);
        gproj_add_targets(form, mesh->vertex_count, NULL, smaller, 1);
        result = gproj_solve(form, 9, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.spoiled.collapsed_edges > 0);
        GPROJT_CHECK((strstr(result.message, "1 edge collapsed (edge 0") != NULL) == (k == 0));
        GPROJT_CHECK((strstr(result.message, "the mesh has shrunk to") != NULL) == (k == 1));
        free(smaller);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(every_allocation_fails_once) {
    gproj_mesh *mesh = gprojt_noisy(CUBE_SPHERE, 2, 0.05, 1);
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_add_all, mesh, 3, NULL) >= 30);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(circularity_twice);
    GPROJT_RUN(circular_faces);
    GPROJT_RUN(circles_begin_at_their_faces);
    GPROJT_RUN(circular_real_meshes);
    GPROJT_RUN(volumes);
    GPROJT_RUN(volume_is_reached);
    GPROJT_RUN(equal_areas_hold_on_a_grid);
    GPROJT_RUN(areas_become_more_equal);
    GPROJT_RUN(quads_become_parallelograms);
    GPROJT_RUN(trapezoids_become_parallelograms);
    GPROJT_RUN(area_rows_are_tangent);
    GPROJT_RUN(lengths);
    GPROJT_RUN(equal_lengths);
    GPROJT_RUN(equal_lengths_hold_on_a_grid);
    GPROJT_RUN(refusals_of_lengths);
    GPROJT_RUN(refusals);
    GPROJT_RUN(spoiled_meshes_are_told);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
