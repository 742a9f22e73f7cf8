/* test_size.c - >>catalogue: bounds of lengths and areas, total area, cost, and weights of single elements. */
#include "gprojt_form.h"

/* -- sizes, computed here -- */

/* |1/2 sum of (a - o) x (b - o)| over the edges a b of a face, o its first corner. */
static double gprojt_area(const gproj_mesh *mesh, int32_t face) {
    int32_t first = mesh->face_halfedge[face], h, k;
    const double *o = mesh->position + 3 * mesh->origin[first];
    double sum[3] = {0, 0, 0};
    for (h = mesh->next[first]; mesh->next[h] != first; h = mesh->next[h]) {
        double a[3], b[3];
        for (k = 0; k < 3; ++k) {
            a[k] = mesh->position[3 * mesh->origin[h] + k] - o[k];
            b[k] = mesh->position[3 * mesh->origin[mesh->next[h]] + k] - o[k];
        }
        for (k = 0; k < 3; ++k) sum[k] += (a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]) / 2;
    }
    return sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
}

static double gprojt_cost(const gproj_mesh *mesh, double length_price, double area_price) {
    double sum = 0;
    int32_t i;
    for (i = 0; i < mesh->edge_count; ++i) sum += length_price * gprojt_edge_length(mesh, i);
    for (i = 0; i < mesh->face_count; ++i) sum += area_price * gprojt_area(mesh, i);
    return sum;
}

/* The smallest and the largest length (or area). */
static void gprojt_range(const gproj_mesh *mesh, bool areas, double range[2]) {
    int32_t i, count = areas ? mesh->face_count : mesh->edge_count;
    range[0] = HUGE_VAL, range[1] = 0;
    for (i = 0; i < count; ++i) {
        double size = areas ? gprojt_area(mesh, i) : gprojt_edge_length(mesh, i);
        range[0] = fmin(range[0], size), range[1] = fmax(range[1], size);
    }
}

/* -- bounds of lengths and areas -- */

/* Planar faces with lengths or areas in a range that many are out of, on all kinds of meshes. */
GPROJT_TEST(lengths_and_areas_in_a_range) {
    int shape, areas;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        for (areas = 0; areas < 2; ++areas) {
            gproj_mesh *mesh = gprojt_noisy(shape, 5, 0.06, 3);
            gproj_form *form = gproj_form_create(mesh, NULL);
            double before[2], after[2], min, max;
            gproj_result result;
            int32_t group;
            gprojt_range(mesh, areas, before);
            min = before[0] + 0.2 * (before[1] - before[0]), max = before[1] - 0.3 * (before[1] - before[0]);
            gproj_add_planarity(form, 1);
            group = areas ? gproj_add_area_bounds(form, mesh->face_count, NULL, min, max, 1)
                          : gproj_add_length_bounds(form, mesh->edge_count, NULL, min, max, 1);
            GPROJT_CHECK(group >= 0 && gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
            result = gproj_solve(form, 40, NULL);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gproj_form_group_info(form, group).max <= 1e-12);
            if (result.outcome != GPROJ_CONVERGED) printf("  shape %d: %s\n", shape, result.message);
            gprojt_range(mesh, areas, after);
            GPROJT_CHECK(after[0] >= min * (1 - 1e-11) && after[1] <= max * (1 + 1e-11));
            GPROJT_CHECK(after[0] < max && after[1] > min); /* a range, not one value */
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
    }
}

/* Only some edges, with one bound; only some faces. The others go where they like. */
GPROJT_TEST(some_edges_and_faces) {
    static const int32_t some[] = {3, 11, 12};
    gproj_mesh *mesh = gprojt_noisy(0, 5, 0.05, 3);
    double edge = gproj_mesh_mean_edge_length(mesh);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    int32_t k, length, area;
    length = gproj_add_length_bounds(form, 3, some, 0, 0.7 * edge, 1);
    area = gproj_add_area_bounds(form, 3, some, 1.2 * edge * edge, INFINITY, 1);
    GPROJT_CHECK(gproj_form_group_info(form, length).rows == 3 && gproj_form_group_info(form, area).rows == 3);
    GPROJT_CHECK(gproj_form_group_info(form, length).kind == GPROJ_BOUND);
    result = gproj_solve(form, 30, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    for (k = 0; k < 3; ++k) {
        GPROJT_NEAR(gprojt_edge_length(mesh, some[k]), 0.7 * edge, 1e-3 * edge);
        GPROJT_CHECK(gprojt_edge_length(mesh, some[k]) <= 0.7 * edge * (1 + 1e-12));
        GPROJT_CHECK(gprojt_area(mesh, some[k]) >= 1.2 * edge * edge * (1 - 1e-12));
    }
    GPROJT_CHECK(gprojt_edge_length(mesh, 20) > 0.7 * edge);
    gproj_form_destroy(form);
    form = gproj_form_create(mesh, NULL);
    length = gproj_add_length_bounds(form, mesh->edge_count, NULL, 0, INFINITY, 1); /* no bounds: no rows */
    area = gproj_add_area_bounds(form, mesh->face_count, NULL, -INFINITY, INFINITY, 1);
    GPROJT_CHECK(length == 0 && area == 1 && gproj_form_group_info(form, length).rows == 0);
    GPROJT_CHECK(gproj_form_group_info(form, area).rows == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Bounds that hold already change nothing: the mesh's bytes stay. */
GPROJT_TEST(bounds_that_hold_already) {
    gproj_mesh *mesh = gprojt_noisy(2, 5, 0.1, 3);
    double *before = gprojt_keep(mesh), edge = gproj_mesh_mean_edge_length(mesh);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    options.skip_closeness = true;
    gproj_add_length_bounds(form, mesh->edge_count, NULL, 1e-3 * edge, 100 * edge, 1);
    gproj_add_area_bounds(form, mesh->face_count, NULL, 1e-6 * edge * edge, 1e4 * edge * edge, 1);
    gproj_add_total_area_bounds(form, 1e-3 * gprojt_cost(mesh, 0, 1), 10 * gprojt_cost(mesh, 0, 1), 1);
    gproj_add_cost_bounds(form, 2, 3, 0, 1.001 * gprojt_cost(mesh, 2, 3), 1);
    result = gproj_solve(form, 20, &options);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations == 0);
    GPROJT_CHECK(gprojt_unmoved(mesh, before));
    free(before);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Edges at least as long as they cannot be where their ends are held. */
GPROJT_TEST(the_verdict_names_the_edge) {
    gproj_mesh *mesh = gprojt_noisy(0, 4, 0.05, 3);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double longest[2];
    gproj_result result;
    gproj_add_fixed_boundary(form, 3);
    gprojt_range(mesh, false, longest);
    gproj_add_length_bounds(form, mesh->edge_count, NULL, 0, 0.3 * longest[1], 1);
    result = gproj_solve(form, 40, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_STALLED || result.outcome == GPROJ_ITERATION_LIMIT);
    GPROJT_CHECK(strstr(result.message, "(length bounds, edge ") != NULL && result.residual > 0.01);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* The same model in other units gives the same shape. */
GPROJT_TEST(bounds_in_other_units) {
    gproj_mesh *mesh = gprojt_noisy(0, 5, 0.1, 3), *large = gproj_mesh_copy(mesh, NULL, NULL);
    gproj_mesh *both[2];
    double unit[2] = {1, 1024}, edge = gproj_mesh_mean_edge_length(mesh), cost;
    int32_t i, k;
    cost = 0.95 * gprojt_cost(mesh, 1, 2);
    for (i = 0; i < 3 * mesh->vertex_count; ++i) large->position[i] *= 1024;
    both[0] = mesh, both[1] = large;
    for (k = 0; k < 2; ++k) {
        gproj_form *form = gproj_form_create(both[k], NULL);
        double area = edge * edge * unit[k] * unit[k];
        gproj_add_planarity(form, 1);
        gproj_add_length_bounds(form, mesh->edge_count, NULL, 0.8 * edge * unit[k], 1.1 * edge * unit[k], 1);
        gproj_add_area_bounds(form, mesh->face_count, NULL, 0.6 * area, INFINITY, 1);
        gproj_add_cost_bounds(form, 1, 2 / unit[k], 0, cost * unit[k], 1);
        GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
        gproj_form_destroy(form);
    }
    for (i = 0; i < 3 * mesh->vertex_count; ++i) large->position[i] /= 1024;
    GPROJT_CHECK(gprojt_largest_move(mesh->position, large->position, mesh->vertex_count) < 1e-9 * edge);
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(large);
}

/* -- totals -- */

GPROJT_TEST(total_area_and_cost_are_reached) {
    int shape, kind;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        for (kind = 0; kind < 4; ++kind) {
            gproj_mesh *mesh = gprojt_noisy(shape, 4, 0.03, 3);
            gproj_form *form = gproj_form_create(mesh, NULL);
            double price[2], before, wanted;
            gproj_result result;
            price[0] = kind < 2 ? 0 : 2.5, price[1] = kind < 2 ? 1 : 0.5;
            before = gprojt_cost(mesh, price[0], price[1]);
            wanted = kind % 2 ? 0.9 * before : 1.1 * before;
            gproj_add_planarity(form, 1);
            if (kind == 0) gproj_add_total_area(form, wanted, 1);
            if (kind == 1) gproj_add_total_area_bounds(form, 0, wanted, 1);
            if (kind == 2) gproj_add_cost(form, price[0], price[1], wanted, 1);
            if (kind == 3) gproj_add_cost_bounds(form, price[0], price[1], 0.5 * wanted, wanted, 1);
            result = gproj_solve(form, 30, NULL);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 12);
            GPROJT_NEAR(gprojt_cost(mesh, price[0], price[1]) / wanted, 1, kind % 2 ? 1e-3 : 1e-11);
            GPROJT_CHECK(kind % 2 == 0 || gprojt_cost(mesh, price[0], price[1]) <= wanted * (1 + 1e-11));
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
    }
}

/* The global rows are tangent to what they stand for: at x + d they say what the sizes there say, to second order. */
GPROJT_TEST(global_rows_are_tangent) {
    gproj_mesh *mesh = gprojt_noisy(2, 5, 0.1, 8);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_system *s = gproj_form_system(form);
    double *x = gproj_system_values(s), centre[3], scale, start[3], cost = gprojt_cost(mesh, 3, 2);
    double area = gprojt_cost(mesh, 0, 1), face = area / mesh->face_count, size = sqrt(area);
    uint64_t state = 2;
    int32_t v, f;
    gproj_add_total_area(form, area, 1);
    gproj_add_cost_bounds(form, 3, 2, 0.9 * cost, 1.2 * cost, 1);
    gproj_add_area_bounds(form, mesh->face_count, NULL, 0.5 * face, 2 * face, 1);
    gproj_form_units(form, centre, &scale);
    GPROJT_CHECK(gproj_system_check_gradients(s) < 1e-7); /* and refreshes the rows */
    start[0] = gproj_system_row_value(s, 0, 0, NULL);
    GPROJT_NEAR(start[0], 0, 1e-13);
    start[1] = gproj_system_row_value(s, 1, 0, NULL);
    start[2] = gproj_system_row_value(s, 1, 1, NULL);
    GPROJT_NEAR(start[1] / start[2], 0.1 / 0.2, 1e-12);
    for (v = 0; v < 3 * mesh->vertex_count; ++v) x[v] += 1e-4 * (2 * gprojt_uniform(&state) - 1);
    for (v = 0; v < 3 * mesh->vertex_count; ++v) mesh->position[v] = x[v] / scale + centre[v % 3];
    GPROJT_NEAR(gproj_system_row_value(s, 0, 0, NULL), (gprojt_cost(mesh, 0, 1) - area) / (2 * size) * scale, 1e-7);
    /* start[1] is 0.1 cost / unit */
    GPROJT_NEAR(gproj_system_row_value(s, 1, 0, NULL), (gprojt_cost(mesh, 3, 2) - 0.9 * cost) * start[1] / (0.1 * cost),
                1e-7);
    GPROJT_NEAR(gproj_system_row_value(s, 1, 0, NULL) + gproj_system_row_value(s, 1, 1, NULL), start[1] + start[2],
                1e-12);
    for (f = 0; f < mesh->face_count; ++f) {
        double now = gprojt_area(mesh, f);
        GPROJT_NEAR(gproj_system_row_value(s, 2, 2 * f, NULL), (now - 0.5 * face) / (2 * sqrt(0.5 * face)) * scale,
                    1e-7);
        GPROJT_NEAR(gproj_system_row_value(s, 2, 2 * f + 1, NULL), (2 * face - now) / (2 * sqrt(2 * face)) * scale,
                    1e-7);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(measured_length_and_area) {
    gproj_mesh *mesh = gprojt_noisy(2, 5, 0.1, 8);
    gproj_measures m = gproj_measure(mesh, NULL, NULL);
    GPROJT_NEAR(m.length, gprojt_cost(mesh, 1, 0), 1e-11);
    GPROJT_NEAR(m.length, m.mean_edge * mesh->edge_count, 1e-11);
    GPROJT_NEAR(m.area, gprojt_cost(mesh, 0, 1), 1e-11);
    gproj_mesh_destroy(mesh);
}

/* What keeps a mesh from shrinking to a point: at least, not at most. */
GPROJT_TEST(bounds_hold_from_below) {
    static const char nothing[] = "nothing holds the mesh";
    int i;
    for (i = 0; i < 8; ++i) {
        gproj_mesh *mesh = gprojt_noisy(0, 4, 0.03, 3);
        gproj_form *form = gproj_form_create(mesh, NULL);
        double edge = gproj_mesh_mean_edge_length(mesh), min = i % 2 ? 0.5 : 0, max = i % 2 ? INFINITY : 50;
        gproj_result result;
        gproj_add_fairness(form, 0.01);
        if (i / 2 == 0) gproj_add_length_bounds(form, mesh->edge_count, NULL, min * edge, max * edge, 1);
        if (i / 2 == 1) gproj_add_area_bounds(form, mesh->face_count, NULL, min * edge * edge, max * edge * edge, 1);
        if (i / 2 == 2) gproj_add_total_area_bounds(form, min, max * 1e3, 1);
        if (i / 2 == 3) gproj_add_cost_bounds(form, 1, 0, min, max * 1e3, 1);
        result = gproj_solve(form, 6, NULL);
        GPROJT_CHECK((strstr(result.message, nothing) == NULL) == (i % 2 == 1));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- weights of elements -- */

/* Lengths that hold for every second edge only, then for all. */
GPROJT_TEST(elements_are_switched) {
    gproj_mesh *mesh = gprojt_noisy(0, 5, 0.05, 9);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double *kept = (double *)malloc((size_t)mesh->edge_count * sizeof *kept);
    double *weights = (double *)malloc((size_t)mesh->edge_count * sizeof *weights);
    gproj_result result;
    int32_t group = gproj_add_lengths(form, mesh->edge_count, NULL, NULL, 1), e, off = 0;
    GPROJT_REQUIRE(kept && weights);
    for (e = 0; e < mesh->edge_count; ++e) kept[e] = gprojt_edge_length(mesh, e), weights[e] = e % 2;
    gprojt_shake(mesh, 0.02, 5);
    GPROJT_CHECK(gproj_set_element_weights(form, group, 0, &e, NULL) == GPROJ_OK);      /* none */
    GPROJT_CHECK(gproj_set_element_weights(form, group, 0, NULL, weights) == GPROJ_OK); /* all */
    result = gproj_solve(form, 20, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    for (e = 0; e < mesh->edge_count; ++e) {
        if (e % 2) GPROJT_NEAR(gprojt_edge_length(mesh, e), kept[e], 1e-12);
        off += fabs(gprojt_edge_length(mesh, e) - kept[e]) > 1e-4;
    }
    GPROJT_CHECK(off > mesh->edge_count / 3);
    for (e = 0; e < mesh->edge_count; e += 2) {
        double one = 1;
        gproj_set_element_weights(form, group, 1, &e, &one);
    }
    result = gproj_solve(form, 20, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_NEAR(gprojt_edge_length(mesh, e), kept[e], 1e-12);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(kept);
    free(weights);
}

/* A weight times the group's: the group with weight 2 and all elements 3 is the group with weight 6. */
GPROJT_TEST(element_weights_multiply) {
    gproj_mesh *mesh[2];
    double three[2000];
    int32_t i, k;
    for (i = 0; i < 2000; ++i) three[i] = 3;
    for (k = 0; k < 2; ++k) {
        gproj_form *form;
        int32_t closeness;
        mesh[k] = gprojt_noisy(0, 5, 0.1, 9);
        form = gproj_form_create(mesh[k], NULL);
        gproj_add_planarity(form, 1);
        closeness = gproj_add_closeness(form, k ? 0.02 : 0.06);
        if (k) gproj_set_element_weights(form, closeness, mesh[k]->vertex_count, NULL, three);
        gproj_solve(form, 7, NULL);
        gproj_form_destroy(form);
    }
    GPROJT_CHECK(gprojt_largest_move(mesh[0]->position, mesh[1]->position, mesh[0]->vertex_count) < 1e-7);
    gproj_mesh_destroy(mesh[0]);
    gproj_mesh_destroy(mesh[1]);
}

/* Vertices that are let off their curve leave it, and the pins at the ends of segments stay where they should. */
GPROJT_TEST(gliding_vertices_are_let_off) {
    gproj_mesh *mesh = gprojt_noisy(0, 6, 0.1, 9), *first = gproj_mesh_copy(mesh, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_curve *loop = gproj_curve_from_loop(first, 0, NULL, NULL);
    int32_t group = gproj_add_gliding_boundary(form, 1), v, off = 0;
    double none = 0, one = 1;
    gproj_add_planarity(form, 1);
    gproj_add_fairness(form, 0.3);
    for (v = 0; v < mesh->vertex_count; v += 2) gproj_set_element_weights(form, group, 1, &v, &none);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    for (v = 0; v < mesh->vertex_count; ++v) {
        double distance = gproj_curve_closest(loop, mesh->position + 3 * v).distance;
        if (!gproj_mesh_is_boundary_vertex(mesh, v)) continue;
        if (v % 2) GPROJT_CHECK(distance < 1e-11);
        off += distance > 1e-3;
    }
    GPROJT_CHECK(off > 2);
    for (v = 0; v < mesh->vertex_count; v += 2) gproj_set_element_weights(form, group, 1, &v, &one);
    memcpy(mesh->position, first->position, 3 * (size_t)mesh->vertex_count * sizeof(double));
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    for (v = 0; v < mesh->vertex_count; ++v)
        if (gproj_mesh_is_boundary_vertex(mesh, v))
            GPROJT_CHECK(gproj_curve_closest(loop, mesh->position + 3 * v).distance < 1e-11);
    gproj_curve_destroy(loop);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(first);
}

/* Planar faces but two; bounds of areas but one. */
GPROJT_TEST(faces_are_let_off) {
    static const int32_t faces[2] = {6, 13};
    static const double none[2] = {0, 0};
    gproj_mesh *mesh = gprojt_noisy(0, 5, 0.1, 9);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double *planarity = (double *)malloc((size_t)mesh->face_count * sizeof *planarity), range[2];
    int32_t f, group = gproj_add_planarity(form, 1), areas;
    GPROJT_REQUIRE(planarity);
    gprojt_range(mesh, true, range);
    areas = gproj_add_area_bounds(form, mesh->face_count, NULL, 0, 0.8 * range[1], 1);
    gproj_set_element_weights(form, group, 2, faces, none);
    gproj_set_element_weights(form, areas, 2, faces, none);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    gproj_measure(mesh, NULL, planarity);
    for (f = 0; f < mesh->face_count; ++f) {
        bool off = f == faces[0] || f == faces[1];
        GPROJT_CHECK(off ? planarity[f] > 1e-4 : planarity[f] < 1e-12);
        GPROJT_CHECK(off || gprojt_area(mesh, f) <= 0.8 * range[1] * (1 + 1e-11));
    }
    free(planarity);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Two groups of edges, each with a common length of its own. */
GPROJT_TEST(two_groups_of_equal_lengths) {
    gproj_mesh *mesh = gprojt_noisy(0, 6, 0.05, 9);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t *along = (int32_t *)malloc((size_t)mesh->edge_count * sizeof *along), count[2] = {0, 0}, e, k;
    double length[2];
    GPROJT_REQUIRE(along);
    for (k = 0; k < 2; ++k) { /* edges along x, edges along y */
        for (e = 0; e < mesh->edge_count; ++e) {
            const double *p = mesh->position + 3 * mesh->origin[2 * e],
                         *q = mesh->position + 3 * mesh->origin[2 * e + 1];
            if ((fabs(p[0] - q[0]) > fabs(p[1] - q[1])) == (k == 0)) along[count[k]++] = e;
        }
        gproj_add_equal_lengths(form, count[k], along, 1);
    }
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    for (k = 0; k < 2; ++k) length[k] = gproj_system_values(gproj_form_system(form))[3 * mesh->vertex_count + k];
    GPROJT_CHECK(count[0] > 0 && count[1] > 0 && fabs(length[0] - length[1]) > 1e-4);
    free(along);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* -- refusals, memory -- */

GPROJT_TEST(refusals) {
    static const int32_t far[] = {0, 1000000}, below[] = {-1};
    static const double weights[] = {1, -1}, good[] = {1, 1};
    gproj_mesh *mesh = gprojt_noisy(0, 3, 0.1, 1);
    int i;
    for (i = 0; i < 27; ++i) {
        gproj_form *form = gproj_form_create(mesh, NULL);
        int32_t lengths = gproj_add_lengths(form, 2, NULL, NULL, 1), total = gproj_add_total_area(form, 1, 1);
        long group = 0;
        gproj_code code = GPROJ_ERROR_ARGUMENT;
        if (i == 0) group = gproj_add_length_bounds(form, 2, far, 1, 2, 1), code = GPROJ_ERROR_INDEX;
        if (i == 1) group = gproj_add_length_bounds(form, -1, NULL, 1, 2, 1);
        if (i == 2) group = gproj_add_length_bounds(form, 2, NULL, 2, 1, 1);
        if (i == 3) group = gproj_add_length_bounds(form, 2, NULL, -1, 1, 1);
        if (i == 4) group = gproj_add_length_bounds(form, 2, NULL, NAN, 1, 1);
        if (i == 5) group = gproj_add_length_bounds(form, 2, NULL, 0, NAN, 1);
        if (i == 6) group = gproj_add_length_bounds(form, 2, NULL, INFINITY, INFINITY, 1);
        if (i == 7) group = gproj_add_area_bounds(form, 1, below, 1, 2, 1), code = GPROJ_ERROR_INDEX;
        if (i == 8) group = gproj_add_area_bounds(form, mesh->face_count + 1, NULL, 1, 2, 1);
        if (i == 9) group = gproj_add_area_bounds(form, 1, NULL, 1, -2, 1);
        if (i == 10) group = gproj_add_total_area(form, 0, 1);
        if (i == 11) group = gproj_add_total_area(form, INFINITY, 1);
        if (i == 12) group = gproj_add_total_area_bounds(form, 3, 2, 1);
        if (i == 13) group = gproj_add_cost(form, 0, 0, 1, 1);
        if (i == 14) group = gproj_add_cost(form, -1, 2, 1, 1);
        if (i == 15) group = gproj_add_cost_bounds(form, NAN, 2, 1, 2, 1);
        if (i == 16) group = gproj_add_cost_bounds(form, INFINITY, 2, 1, 2, 1);
        if (i == 17) group = gproj_add_cost(form, 1, 1, NAN, 1);
        if (i == 18) group = -(gproj_set_element_weights(form, lengths, 2, far, good) == GPROJ_ERROR_INDEX);
        if (i == 19) group = -(gproj_set_element_weights(form, lengths, 2, NULL, weights) == GPROJ_ERROR_ARGUMENT);
        if (i == 20) group = -(gproj_set_element_weights(form, total, 1, NULL, good) == GPROJ_ERROR_ARGUMENT);
        if (i == 21) group = -(gproj_set_element_weights(form, 99, 1, NULL, good) == GPROJ_ERROR_INDEX);
        if (i == 22) group = -(gproj_set_element_weights(form, lengths, 1, NULL, NULL) == GPROJ_ERROR_ARGUMENT);
        if (i == 23) group = -(gproj_set_element_weights(form, lengths, -1, NULL, good) == GPROJ_ERROR_ARGUMENT);
        if (i == 24) group = gproj_add_length_bounds(form, 2, NULL, 1, 0, 1);
        if (i == 25) group = gproj_add_area_bounds(form, 2, NULL, -INFINITY, 0, 1);
        if (i == 26) group = gproj_add_total_area_bounds(form, -INFINITY, -INFINITY, 1);
        if (i == 18 || i == 21) code = GPROJ_ERROR_INDEX;
        GPROJT_CHECK(group == -1 && gproj_form_error(form)->code == code);
        if (i == 20) GPROJT_CHECK(strstr(gproj_form_error(form)->message, "belong to the whole mesh"));
        if (i == 2 || i == 4 || i == 24) GPROJT_CHECK(strstr(gproj_form_error(form)->message, "length bounds: min = "));
        if (group != -1 || gproj_form_error(form)->code != code)
            printf("  %d: %ld, %s\n", i, group, gproj_form_error(form)->message);
        GPROJT_CHECK(gproj_add_length_bounds(form, 1, NULL, 1, 2, 1) == -1); /* after an error: nothing */
        GPROJT_CHECK(gproj_add_area_bounds(form, 1, NULL, 1, 2, 1) == -1 && gproj_add_cost(form, 1, 1, 1, 1) == -1);
        GPROJT_CHECK(gproj_set_element_weights(form, lengths, 1, NULL, good) == code);
        gproj_form_destroy(form);
    }
    GPROJT_CHECK(gproj_add_length_bounds(NULL, 0, NULL, 1, 2, 1) == -1);
    GPROJT_CHECK(gproj_add_area_bounds(NULL, 0, NULL, 1, 2, 1) == -1 && gproj_add_total_area(NULL, 1, 1) == -1);
    GPROJT_CHECK(gproj_add_cost(NULL, 1, 1, 1, 1) == -1 && gproj_add_cost_bounds(NULL, 1, 1, 1, 2, 1) == -1);
    GPROJT_CHECK(gproj_set_element_weights(NULL, 0, 0, NULL, NULL) == GPROJ_ERROR_ARGUMENT);
    gproj_mesh_destroy(mesh);
}

/* Groups of weight 0 do nothing. */
GPROJT_TEST(without_weight) {
    gproj_mesh *mesh = gprojt_noisy(0, 4, 0.1, 3), *other = gproj_mesh_copy(mesh, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL), *plain = gproj_form_create(other, NULL);
    gproj_result a, b;
    gproj_add_planarity(form, 1);
    gproj_add_length_bounds(form, mesh->edge_count, NULL, 3, 4, 0);
    gproj_add_area_bounds(form, mesh->face_count, NULL, 3, 4, 0);
    gproj_add_total_area(form, 100, 0);
    gproj_add_cost_bounds(form, 1, 1, 0, 1, 0);
    gproj_add_planarity(plain, 1);
    a = gproj_solve(form, 12, NULL), b = gproj_solve(plain, 12, NULL);
    GPROJT_CHECK(a.outcome == GPROJ_CONVERGED && a.iterations == b.iterations && a.damped == b.damped);
    GPROJT_CHECK(gprojt_largest_move(mesh->position, other->position, mesh->vertex_count) < 1e-11);
    gproj_form_destroy(form);
    gproj_form_destroy(plain);
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(other);
}

GPROJT_TEST(same_bytes_on_any_number_of_threads) {
    double *first = NULL;
    int crew;
    for (crew = 0; crew < GPROJT_CREWS; ++crew) {
        gproj_host host = gprojt_crew(crew);
        gproj_mesh *mesh = gprojt_noisy(0, 12, 0.1, 3);
        gproj_form *form = gproj_form_create(mesh, &host);
        double edge = gproj_mesh_mean_edge_length(mesh);
        gproj_add_planarity(form, 1);
        gproj_add_length_bounds(form, mesh->edge_count, NULL, 0.9 * edge, 1.05 * edge, 1);
        gproj_add_cost_bounds(form, 1, 1, 0, 0.97 * gprojt_cost(mesh, 1, 1), 1);
        gproj_solve(form, 8, NULL);
        if (!first) first = gprojt_keep(mesh);
        GPROJT_CHECK(gprojt_unmoved(mesh, first));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    free(first);
}

static void gprojt_add_all(gproj_form *form, void *user) {
    static const double weights[3] = {1, 0, 2};
    const gproj_mesh *mesh = (const gproj_mesh *)user;
    gprojt_added(form, gproj_add_planarity(form, 1));
    gproj_set_element_weights(form, gproj_add_length_bounds(form, 6, NULL, 0.9, 1.1, 1), 3, NULL, weights);
    gprojt_added(form, gproj_add_area_bounds(form, 3, NULL, 0.9, 1.1, 1));
    gprojt_added(form, gproj_add_total_area(form, 1.1 * gprojt_cost(mesh, 0, 1), 1));
    gprojt_added(form, gproj_add_cost_bounds(form, 1, 1, 0, gprojt_cost(mesh, 1, 1), 1));
}

GPROJT_TEST(every_allocation_fails_once) {
    gproj_mesh *mesh = gprojt_noisy(0, 2, 0.05, 1);
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_add_all, mesh, 3, NULL) >= 30);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(lengths_and_areas_in_a_range);
    GPROJT_RUN(some_edges_and_faces);
    GPROJT_RUN(bounds_that_hold_already);
    GPROJT_RUN(the_verdict_names_the_edge);
    GPROJT_RUN(bounds_in_other_units);
    GPROJT_RUN(total_area_and_cost_are_reached);
    GPROJT_RUN(global_rows_are_tangent);
    GPROJT_RUN(measured_length_and_area);
    GPROJT_RUN(bounds_hold_from_below);
    GPROJT_RUN(elements_are_switched);
    GPROJT_RUN(element_weights_multiply);
    GPROJT_RUN(gliding_vertices_are_let_off);
    GPROJT_RUN(faces_are_let_off);
    GPROJT_RUN(two_groups_of_equal_lengths);
    GPROJT_RUN(refusals);
    GPROJT_RUN(without_weight);
    GPROJT_RUN(same_bytes_on_any_number_of_threads);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
