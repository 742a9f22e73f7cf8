/* test_schur.c - >>schur: steps by multipliers against a dense solve, when they are taken, and what forms that take them
   must go through. */
#define GPROJ_STATIC
#include "gprojt_design.h"

/* -- the dense matrix of a step -- */

/* sum w^2 g g' + eps^2 E and - sum w^2 phi g. */
typedef struct gprojt_dense {
    int32_t n;
    long double *a, *b; /* n x n, lower triangle; n: the right-hand side, then the solution */
} gprojt_dense;

static void gprojt_dense_add(gprojt_dense *d, const double *gradient, long double w2, long double phi) {
    int32_t i, j;
    for (i = 0; i < d->n; ++i) {
        if (gradient[i] == 0) continue;
        d->b[i] -= w2 * phi * gradient[i];
        for (j = 0; j <= i; ++j) d->a[(size_t)i * (size_t)d->n + (size_t)j] += w2 * gradient[i] * gradient[j];
    }
}

/* Cholesky; what no row holds stays 0. */
static void gprojt_dense_solve(gprojt_dense *d) {
    size_t n = (size_t)d->n, i, j, k;
    for (i = 0; i < n; ++i) {
        long double *row = d->a + i * n;
        for (j = 0; j <= i; ++j) {
            const long double *other = d->a + j * n;
            long double sum = row[j];
            for (k = 0; k < j; ++k) sum -= row[k] * other[k];
            row[j] = j < i ? (other[j] > 0 ? sum / other[j] : 0) : sum > 0 ? sqrtl(sum) : 0;
        }
        for (k = 0; k < i; ++k) d->b[i] -= row[k] * d->b[k];
        d->b[i] = row[i] > 0 ? d->b[i] / row[i] : 0;
    }
    for (i = n; i-- > 0;) {
        for (k = i + 1; k < n; ++k) d->b[i] -= d->a[k * n + i] * d->b[k];
        d->b[i] = d->a[i * n + i] > 0 ? d->b[i] / d->a[i * n + i] : 0;
    }
}

/* The step with `metric` at the vertices and nothing at the normals. Solution: d->b. */
static gprojt_dense gprojt_dense_step(const gproj_form *form, double epsilon, const double *metric) {
    const gproj_system *s = form->system;
    double *gradient = (double *)malloc((size_t)s->variable_count * sizeof *gradient);
    gprojt_dense d;
    int32_t i, r, f;
    d.n = s->variable_count;
    d.a = (long double *)calloc((size_t)d.n * (size_t)d.n, sizeof *d.a);
    d.b = (long double *)calloc((size_t)d.n, sizeof *d.b);
    if (!gradient || !d.a || !d.b) abort();
    for (i = 0; i < d.n; ++i)
        d.a[(size_t)i * (size_t)(d.n + 1)] =
            (long double)epsilon * epsilon * (i < 3 * form->mesh->vertex_count ? metric[i / 3] : 1);
    for (f = 0; f < form->mesh->face_count; ++f)
        for (i = 0; i < 3 && form->normal[f] >= 0; ++i) d.a[(size_t)(form->normal[f] + i) * (size_t)(d.n + 1)] = 0;
    for (i = 0; i < s->group_count; ++i)
        for (r = 0; r < s->group[i].row_count; ++r) {
            long double w = (long double)s->group[i].weight * s->group[i].row[r].weight;
            long double phi = gproj_system_row_value(s, i, r, gradient);
            if (w == 0 || (s->group[i].kind == GPROJ_BOUND && phi >= 0 && !s->group[i].row[r].active)) continue;
            gprojt_dense_add(&d, gradient, w * w, phi);
        }
    gprojt_dense_solve(&d);
    free(gradient);
    return d;
}

/* trace A^-1 of a symmetric 3 x 3 matrix; 0 for nothing. */
static long double gprojt_trace_of_inverse(long double a[3][3]) {
    long double minor[3], det;
    int k;
    for (k = 0; k < 3; ++k) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        minor[k] = a[i][i] * a[j][j] - a[i][j] * a[j][i];
    }
    det = a[0][0] * minor[0] - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
          a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    return det > 0 ? (minor[0] + minor[1] + minor[2]) / det : 0;
}

/* How fast the normal of a face turns: |R^-1|^2, w N = Q R, times the largest of the weights, squared. */
static double gprojt_turning(const gproj_form *form, int32_t face, double *gradient) {
    const gproj_system *s = form->system;
    const gproji_group *g = &s->group[form->planarity];
    long double square[3][3], heaviest = 0;
    int32_t r, i, j;
    memset(square, 0, sizeof square);
    for (r = 0; r < g->row_count; ++r) {
        long double w = (long double)g->weight * g->row[r].weight;
        if (g->row[r].element != face) continue;
        gproj_system_row_value(s, form->planarity, r, gradient);
        for (i = 0; i < 3; ++i)
            for (j = 0; j < 3; ++j)
                square[i][j] += w * w * gradient[form->normal[face] + i] * gradient[form->normal[face] + j];
        if (w > heaviest) heaviest = w;
    }
    return (double)(gprojt_trace_of_inverse(square) * heaviest * heaviest);
}

/* The factors of eps^2 of the vertices. */
static double *gprojt_metric(const gproj_form *form, double epsilon) {
    const gproj_mesh *mesh = form->mesh;
    double *metric = (double *)malloc((size_t)mesh->vertex_count * sizeof *metric);
    double *gradient = (double *)malloc((size_t)form->system->variable_count * sizeof *gradient);
    int32_t v, f, k, h;
    if (!metric || !gradient) abort();
    for (v = 0; v < mesh->vertex_count; ++v) metric[v] = 1;
    for (f = 0; f < mesh->face_count; ++f) {
        double share;
        if (form->normal[f] < 0) continue;
        share = 0.1 * fmin(gprojt_turning(form, f, gradient), 1 / (epsilon * epsilon));
        for (k = 0, h = mesh->face_halfedge[f]; k < mesh->face_degree[f]; ++k, h = mesh->next[h])
            metric[mesh->origin[h]] += share;
    }
    free(gradient);
    return metric;
}

/* -- one step -- */

/* A solve of the form begins: rows and weights are those of its first iteration. */
static void gprojt_begin(gproj_form *form, bool skip_guard) {
    gproj_solve_options options;
    memset(&options, 0, sizeof options);
    options.skip_closeness = true;
    options.skip_guard = skip_guard;
    GPROJT_REQUIRE(gproji_begin_solve(form, 20, &gproji_beginnings[0], &options));
    GPROJT_REQUIRE(gproji_compile(form->system, false) == GPROJ_OK);
    form->system->solving = true;
    gproji_begin_run(&form->solve.loop);
    form->system->solving = false;
}

/* E at a node, from the shares of its multipliers. */
static double gprojt_metric_at(const gproj_system *s, int32_t node) {
    const gproji_schur *d = &s->schur;
    double metric = 1;
    int64_t k;
    for (k = d->w.entry_start[node]; d->turns[node] && k < d->w.entry_start[node + 1]; ++k)
        metric += d->share[d->w.entry[k]];
    return metric;
}

/* Compares one step with the dense one; returns the largest difference over the largest entry. */
static double gprojt_step_error(gproj_form *form, double epsilon) {
    const gproj_system *s = form->system;
    double *metric = gprojt_metric(form, epsilon), worst = 0, largest = 0;
    gprojt_dense d;
    int32_t v, f;
    GPROJT_CHECK(gproji_find_step(&form->solve.loop, epsilon));
    for (v = 0; v < form->mesh->vertex_count; ++v)
        GPROJT_NEAR(gprojt_metric_at(s, s->nodes.of[3 * v]) / metric[v], 1, 1e-9);
    d = gprojt_dense_step(form, epsilon, metric);
    for (v = 0; v < d.n; ++v) {
        GPROJT_CHECK(gproji_is_finite(s->vector.step[v]));
        worst = fmax(worst, fabs(s->vector.step[v] - (double)d.b[v]));
        largest = fmax(largest, fabs((double)d.b[v]));
    }
    for (f = 0; f < form->mesh->face_count; ++f)
        for (v = 0; v < 3 && form->normal[f] >= 0; ++v)
            GPROJT_CHECK(d.b[form->normal[f] + v] != 0 || s->vector.step[form->normal[f] + v] == 0);
    free(metric);
    free(d.a);
    free(d.b);
    return worst / largest;
}

/* -- forms -- */

/* Rings of faces around a polygon of 12 corners: hexagons, quads, triangles, then quads. */
static gprojt_soup gprojt_rosette(void) {
    gprojt_soup s;
    int32_t corner[12], ring, k;
    memset(&s, 0, sizeof s);
    for (ring = 0; ring < 3; ++ring)
        for (k = 0; k < 12; ++k) {
            double angle = 0.5235987755982988 * k, radius = 1.8 + ring;
            gprojt_add_vertex(&s, radius * cos(angle), radius * sin(angle), 0.1 * radius * cos(2 * angle));
        }
    for (k = 0; k < 12; ++k) corner[k] = k;
    gprojt_add_face(&s, 12, corner);
    for (k = 0; k < 12; k += 4) { /* a hexagon, a quad, two triangles */
        int32_t end = (k + 4) % 12;
        corner[0] = k + 2, corner[1] = k + 1, corner[2] = k, corner[3] = k + 12, corner[4] = k + 13, corner[5] = k + 14;
        gprojt_add_face(&s, 6, corner);
        gprojt_add_quad(&s, k + 3, k + 2, k + 14, k + 15);
        gprojt_add_triangle(&s, end, k + 3, k + 15);
        gprojt_add_triangle(&s, end, k + 15, end + 12);
    }
    for (k = 0; k < 12; ++k) gprojt_add_quad(&s, 12 + (k + 1) % 12, 12 + k, 24 + k, 24 + (k + 1) % 12);
    return s;
}

enum {
    GPROJT_QUADS = 0,
    GPROJT_HEXAGONS = 3,
    GPROJT_CLOSED = 6,
    GPROJT_ROSETTE = GPROJT_SHAPES
};

static gproj_mesh *gprojt_warped(int shape, int32_t n, double noise) {
    gproj_mesh *mesh =
        shape == GPROJT_ROSETTE ? gprojt_mesh_of(gprojt_rosette()) : gprojt_mesh_of(gprojt_shape(shape, n));
    if (!mesh) abort();
    gprojt_shake(mesh, noise * gproj_mesh_mean_edge_length(mesh), 77);
    return mesh;
}

/* What a form has besides planarity. */
enum {
    GPROJT_FIXED = 1,
    GPROJT_CLOSE = 2,
    GPROJT_GLIDES = 4,
    GPROJT_GUARDED = 8,
    GPROJT_VOLUME = 16,
    GPROJT_AREA = 32,
    GPROJT_LENGTHS = 64,
    GPROJT_BOUNDS = 128,  /* some violated, some not */
    GPROJT_PART = 256,    /* weights of faces, 0 among them */
    GPROJT_ONE_ROW = 512, /* other weights: 0 for the row of an edge in one face, for two in another, 5 in a third */
    GPROJT_COMMON = 1024, /* variables of its own: edges of one length, vertices on one plane */
    GPROJT_TWICE = 2048,  /* the volume a second time */
    GPROJT_AREAS = 4096,  /* of one size, a variable in rows of the faces: eps^2 is not larger there */
    GPROJT_CORNERS = 8192,
    GPROJT_NOT_FAIR = 16384, /* fairness of weight 0 */
    GPROJT_FAIR = 32768,
    GPROJT_GAUSS = 65536,
    GPROJT_CIRCLES = 131072,
    GPROJT_FORCES = 262144
};

static void gprojt_weigh_faces(gproj_form *form, int32_t planarity) {
    static const int32_t face[6] = {2, 3, 5, 7, 8, 9};
    static const double weight[6] = {0, 2.5, 0.1, 7, 0, 1e-3};
    gproj_set_element_weights(form, planarity, 6, face, weight);
}

/* Row `which` of a face, 0 for |n| = 1. */
static void gprojt_weigh_row(gproj_form *form, int32_t planarity, int32_t face, int32_t which, double weight) {
    int32_t r, count = gproj_form_group_info(form, planarity).rows;
    for (r = 0; r < count; ++r)
        if (form->system->group[planarity].row[r].element == face && which-- == 0)
            gproj_system_set_row_weight(form->system, planarity, r, weight);
}

static void gprojt_build(gproj_form *form, const gproj_mesh *mesh, double weight, int what) {
    static const int32_t edge[6] = {0, 3, 4, 9, 11, 12};
    int32_t planarity = gproj_add_planarity(form, weight);
    double length = gproj_mesh_mean_edge_length(mesh);
    if (what & GPROJT_FIXED) gproj_add_fixed_boundary(form, 1);
    if (what & GPROJT_CLOSE) gproj_add_closeness(form, 0.2);
    if (what & GPROJT_GLIDES) gproj_add_gliding_boundary(form, 0.7);
    if (what & GPROJT_VOLUME) gproj_add_volume(form, 1.1 * gproj_volume(mesh), 1.5);
    if (what & GPROJT_AREA) gproj_add_total_area(form, 30 * length * length, 0.8);
    if (what & GPROJT_LENGTHS) gproj_add_lengths(form, 6, edge, NULL, 0.9);
    if (what & GPROJT_BOUNDS) gproj_add_length_bounds(form, 6, edge, length, 1.05 * length, 0.6);
    if (what & GPROJT_COMMON) gproj_add_equal_lengths(form, 5, edge, 1.2);
    if (what & GPROJT_COMMON) gproj_add_coplanar(form, 6, edge, 1);
    if (what & GPROJT_TWICE) gproj_add_volume(form, 1.1 * gproj_volume(mesh), 1);
    if (what & GPROJT_AREAS) gproj_add_equal_areas(form, 0.7);
    if (what & GPROJT_CORNERS) gproj_add_fixed_corners(form, 1);
    if (what & GPROJT_NOT_FAIR) gproj_add_fairness(form, 0);
    if (what & GPROJT_FAIR) gproj_add_fairness(form, 0.1);
    if (what & GPROJT_GAUSS) gproj_add_gauss_fairness(form, 0.1);
    if (what & GPROJT_CIRCLES) gproj_add_circularity(form, 1);
    if (what & GPROJT_FORCES) gprojt_add_standing(form, mesh);
    if (what & GPROJT_PART) gprojt_weigh_faces(form, planarity);
    if (!(what & GPROJT_ONE_ROW)) return;
    gprojt_weigh_row(form, planarity, 4, 2, 0);
    gprojt_weigh_row(form, planarity, 6, 1, 0);
    gprojt_weigh_row(form, planarity, 6, 3, 0);
    gprojt_weigh_row(form, planarity, 0, 3, 5);
}

typedef struct gprojt_case {
    int shape;
    int32_t n;
    double weight;
    int what;
} gprojt_case;

static const gprojt_case gprojt_cases[] = {
    {GPROJT_QUADS, 4, 1, 0},
    {GPROJT_QUADS, 4, 0.3, GPROJT_FIXED},
    {GPROJT_QUADS, 4, 1, GPROJT_CLOSE | GPROJT_GUARDED},
    {GPROJT_QUADS, 4, 1, GPROJT_GLIDES | GPROJT_CLOSE},
    {GPROJT_QUADS, 4, 1, GPROJT_FIXED | GPROJT_VOLUME},
    {GPROJT_QUADS, 4, 0.3, GPROJT_CLOSE | GPROJT_VOLUME | GPROJT_AREA | GPROJT_BOUNDS},
    {GPROJT_QUADS, 4, 1, GPROJT_LENGTHS | GPROJT_BOUNDS | GPROJT_GLIDES},
    {GPROJT_QUADS, 4, 0.3, GPROJT_PART},
    {GPROJT_QUADS, 4, 1, GPROJT_PART | GPROJT_ONE_ROW | GPROJT_CLOSE | GPROJT_GUARDED | GPROJT_AREA},
    {GPROJT_QUADS, 4, 1, GPROJT_ONE_ROW | GPROJT_FIXED},
    {GPROJT_HEXAGONS, 4, 1, 0},
    {GPROJT_HEXAGONS, 3, 0.3, GPROJT_FIXED | GPROJT_GUARDED | GPROJT_ONE_ROW},
    {GPROJT_HEXAGONS, 4, 1, GPROJT_PART | GPROJT_ONE_ROW | GPROJT_VOLUME},
    {GPROJT_ROSETTE, 0, 1, 0},
    {GPROJT_ROSETTE, 0, 0.3, GPROJT_FIXED | GPROJT_CLOSE | GPROJT_GUARDED | GPROJT_VOLUME | GPROJT_AREA},
    {GPROJT_ROSETTE, 0, 1, GPROJT_GLIDES | GPROJT_LENGTHS | GPROJT_PART | GPROJT_ONE_ROW},
    {GPROJT_CLOSED, 2, 1, 0},
    {GPROJT_CLOSED, 2, 1, GPROJT_VOLUME | GPROJT_AREA | GPROJT_ONE_ROW},
    {GPROJT_CLOSED, 2, 0.3, GPROJT_CLOSE | GPROJT_GUARDED | GPROJT_LENGTHS | GPROJT_PART},
    {GPROJT_QUADS, 5, 1, GPROJT_COMMON | GPROJT_FIXED},
    {GPROJT_HEXAGONS, 4, 0.3, GPROJT_COMMON | GPROJT_VOLUME | GPROJT_TWICE},
    {GPROJT_HEXAGONS, 4, 1, GPROJT_AREAS | GPROJT_CLOSE},
    {GPROJT_QUADS, 4, 1, GPROJT_VOLUME | GPROJT_TWICE | GPROJT_FIXED | GPROJT_CLOSE},
    {GPROJT_QUADS, 4, 1, GPROJT_FORCES},
    {GPROJT_QUADS, 5, 0.3, GPROJT_FORCES | GPROJT_CLOSE | GPROJT_GUARDED | GPROJT_ONE_ROW | GPROJT_VOLUME},
};
enum {
    GPROJT_CASES = sizeof gprojt_cases / sizeof gprojt_cases[0]
};

/* The rows of every third face of the guard act. */
static void gprojt_wake_guard(gproj_form *form) {
    gproji_group *g = &form->system->group[gproji_own_group(form, GPROJI_OWN_GUARD)];
    int32_t r, round;
    GPROJT_CHECK(g->weight > 0);
    for (round = 0; round < 2; ++round) {
        for (r = 0; r < g->row_count; r += 3) g->row[r].active = g->row[r].weight > 0;
        if (round == 0) GPROJT_CHECK(gproji_recompile(&form->solve.loop, gproji_wake_guard(form->system)));
    }
    GPROJT_CHECK(!gproji_wake_guard(form->system) && form->system->schur.on);
}

static void gprojt_check_case(const gprojt_case *c) {
    gproj_mesh *mesh = gprojt_warped(c->shape, c->n, 0.1);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double error[2];
    gprojt_build(form, mesh, c->weight, c->what);
    gprojt_begin(form, !(c->what & GPROJT_GUARDED));
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
    GPROJT_CHECK(form->system->schur.on);
    if (form->system->schur.on) {
        if (c->what & GPROJT_GUARDED) gprojt_wake_guard(form);
        error[0] = gprojt_step_error(form, 1e-3);
        error[1] = gprojt_step_error(form, 1e-5);
        GPROJT_CHECK(error[0] <= 1e-9);
        GPROJT_CHECK(error[1] <= 1e-5); /* roundings over eps^2 */
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(steps_are_those_of_the_dense_matrix) {
    int i;
    for (i = 0; i < GPROJT_CASES; ++i) gprojt_check_case(&gprojt_cases[i]);
}

/* Elements enough for several tasks: the metric is that of all of them, and the step leaves no gradient. */
GPROJT_TEST(steps_of_many_elements) {
    static const int32_t sizes[2] = {33, 41};
    const double epsilon = 1e-3;
    int32_t round, i, r, v;
    for (round = 0; round < 2; ++round) {
        gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, sizes[round], 0.1);
        gproj_form *form = gproj_form_create(mesh, NULL);
        double *metric, *left, *gradient, worst = 0, largest = 0;
        const gproj_system *s;
        gprojt_build(form, mesh, 1, GPROJT_CLOSE);
        gprojt_begin(form, true);
        s = form->system;
        GPROJT_CHECK(s->schur.on && s->schur.chunks > 1);
        metric = gprojt_metric(form, epsilon);
        GPROJT_CHECK(gproji_find_step(&form->solve.loop, epsilon));
        left = (double *)calloc((size_t)s->variable_count, sizeof *left);
        gradient = (double *)malloc((size_t)s->variable_count * sizeof *gradient);
        if (!left || !gradient) abort();
        for (v = 0; v < 3 * mesh->vertex_count; ++v) {
            GPROJT_NEAR(gprojt_metric_at(s, s->nodes.of[v]) / metric[v / 3], 1, 1e-9);
            left[v] = epsilon * epsilon * metric[v / 3] * s->vector.step[v];
        }
        for (i = 0; i < s->group_count; ++i)
            for (r = 0; r < s->group[i].row_count; ++r) {
                double w = s->group[i].weight * s->group[i].row[r].weight, phi, along = 0;
                if (w == 0) continue;
                phi = gproj_system_row_value(s, i, r, gradient);
                for (v = 0; v < s->variable_count; ++v) along += gradient[v] * s->vector.step[v];
                for (v = 0; v < s->variable_count; ++v) left[v] += w * w * (phi + along) * gradient[v];
                largest = fmax(largest, w * w * fabs(phi));
            }
        for (v = 0; v < s->variable_count; ++v) worst = fmax(worst, fabs(left[v]));
        GPROJT_CHECK(worst <= 1e-12 * largest);
        free(metric), free(left), free(gradient);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- elements that no form has -- */

/* Adds blocks of 1 to 4 variables near 0, `nodes` of them; first[k]: the first one in block k. */
static void gprojt_add_nodes(gproj_system *s, int32_t nodes, int32_t *first, uint64_t *seed) {
    double x[4];
    int32_t k, i;
    for (k = 0; k < nodes; ++k) {
        int32_t size = 1 + gprojt_below(seed, 4);
        for (i = 0; i < size; ++i) x[i] = gprojt_uniform(seed) - 0.5;
        first[k] = gproj_system_add_variables(s, size, size, x);
    }
    first[nodes] = gproj_system_variable_count(s);
}

/* Adds a row with all variables of two of the blocks and, if `local` >= 0, with products by the three local unknowns. */
static void gprojt_add_joining(gproj_system *s, int32_t group, const int32_t *first, int32_t nodes, int32_t local,
                               int32_t element, uint64_t *seed) {
    gproj_term term[16];
    int32_t count = 0, a = gprojt_below(seed, nodes), b = (a + 1 + gprojt_below(seed, nodes - 1)) % nodes, i, k;
    for (i = first[a]; i < first[a + 1]; ++i) term[count++] = gprojt_term(i, -1, gprojt_uniform(seed) - 0.5);
    for (i = first[b]; i < first[b + 1]; ++i) term[count++] = gprojt_term(i, -1, gprojt_uniform(seed) - 0.5);
    for (k = 0; k < 3 && local >= 0; ++k) {
        term[count++] = gprojt_term(local + k, -1, gprojt_uniform(seed) - 0.5);
        term[count++] = gprojt_term(local + k, first[a], gprojt_uniform(seed) - 0.5);
    }
    gproj_system_add_row(s, group, count, term, gprojt_uniform(seed) - 0.5, element);
}

/* Adds three local unknowns, and rows with them. */
static void gprojt_add_local(gproj_system *s, int32_t group, const int32_t *first, int32_t nodes, int32_t rows,
                             uint64_t *seed) {
    double x[3];
    int32_t k, local;
    for (k = 0; k < 3; ++k) x[k] = gprojt_uniform(seed) - 0.5;
    local = gproj_system_add_variables(s, 3, 3, x);
    gproji_set_auxiliary(s, local);
    for (k = 0; k < rows; ++k) gprojt_add_joining(s, group, first, nodes, local, -1, seed);
}

/* One step of the system, of constraints with weight 1, against the dense one with the factors of eps^2 that the step had;
   returns the largest difference. */
static double gprojt_plain_step_error(gproj_system *s, double epsilon) {
    int32_t n = s->variable_count, v, i, r;
    double *before = (double *)malloc((size_t)n * sizeof *before), *after = (double *)malloc((size_t)n * sizeof *after);
    double *gradient = (double *)malloc((size_t)n * sizeof *gradient), worst = 0;
    gproj_solve_options options;
    gprojt_dense d;
    d.n = n;
    d.a = (long double *)calloc((size_t)n * (size_t)n, sizeof *d.a);
    d.b = (long double *)calloc((size_t)n, sizeof *d.b);
    if (!before || !after || !gradient || !d.a || !d.b) abort();
    memset(&options, 0, sizeof options);
    options.epsilon = epsilon, options.skip_damping = true, options.tolerance = 1e-300;
    memcpy(before, s->x, (size_t)n * sizeof *before);
    GPROJT_CHECK(gproj_system_solve(s, 1, &options).iterations == 1);
    memcpy(after, s->x, (size_t)n * sizeof *after);
    memcpy(s->x, before, (size_t)n * sizeof *before);
    for (i = 0; i < s->group_count; ++i)
        for (r = 0; r < s->group[i].row_count; ++r) {
            double phi = gproj_system_row_value(s, i, r, gradient);
            gprojt_dense_add(&d, gradient, 1, phi);
        }
    for (v = 0; v < n; ++v)
        if (!s->blocks.auxiliary[v])
            d.a[(size_t)v * (size_t)n + (size_t)v] +=
                epsilon * epsilon * (s->schur.on ? gprojt_metric_at(s, s->nodes.of[v]) : 1);
    gprojt_dense_solve(&d);
    for (v = 0; v < n; ++v) worst = fmax(worst, fabs(after[v] - before[v] - (double)d.b[v]));
    free(before), free(after), free(gradient), free(d.a), free(d.b);
    return worst;
}

/* 24 nodes of all sizes; group 0 for rows with local unknowns, group 1 for rows of faces, both without rows. */
static gproj_system *gprojt_nodes_and_groups(int32_t first[25], uint64_t *seed) {
    gproj_system *s = gproj_system_create(NULL);
    gproj_group group;
    memset(&group, 0, sizeof group);
    group.name = "on faces", group.place = GPROJ_PLACE_FACE, group.schedule = gproj_keep(1);
    gprojt_add_nodes(s, 24, first, seed);
    gprojt_add_group(s, "local", GPROJ_CONSTRAINT, 1);
    gproj_system_add_group(s, &group);
    return s;
}

/* Local unknowns between nodes of all sizes, rows without any that belong to one face, and rows at one node. */
GPROJT_TEST(elements_of_all_kinds) {
    uint64_t seed = 71;
    int32_t round, k, j, first[25];
    for (round = 0; round < 30; ++round) {
        gproj_system *s = gprojt_nodes_and_groups(first, &seed);
        gprojt_add_group(s, "own", GPROJ_CONSTRAINT, 1);
        for (k = 0; k < 10; ++k) gprojt_add_local(s, 0, first, 24, k == 9 ? 4 : 4 + gprojt_below(&seed, 3), &seed);
        for (k = 0; k < 4; ++k)
            for (j = 0; j < (k < 2 ? 4 : 2); ++j) gprojt_add_joining(s, 1, first, 24, -1, k, &seed);
        for (k = 0; round % 2 && k < 24; k += 2) gprojt_add_linear(s, 2, first[k], 1, -0.1, k);
        GPROJT_CHECK(gprojt_plain_step_error(s, 0.01) < 1e-9);
        GPROJT_CHECK(s->schur.on && s->schur.elements == 14);
        gproj_system_destroy(s);
    }
}

/* Rows of faces, or vertices, whose numbers are none are elements of their own, each. */
GPROJT_TEST(elements_of_numbers_beyond_all_faces) {
    static const int32_t number[6] = {-1, -1, -24, INT32_MIN, INT32_MAX, INT32_MAX};
    uint64_t seed = 74;
    int32_t place, k, first[25];
    for (place = 0; place < 2; ++place) {
        gproj_system *s = gprojt_nodes_and_groups(first, &seed);
        for (k = 0; k < 8; ++k) gprojt_add_local(s, 0, first, 24, 4, &seed);
        for (k = 0; k < 6; ++k) gprojt_add_joining(s, place, first, 24, -1, number[k], &seed);
        GPROJT_CHECK(gprojt_plain_step_error(s, 0.01) < 1e-9);
        GPROJT_CHECK(s->schur.on && s->schur.elements == 8 + 6);
        gproj_system_destroy(s);
    }
}

/* Groups that are switched off after steps by multipliers change no bit of those that follow, whatever is in their rows: at
   nodes, in elements and dense ones. */
GPROJT_TEST(groups_without_weight_may_overflow) {
    double x[2][128];
    int32_t round, i, k, first[25];
    for (round = 0; round < 2; ++round) {
        uint64_t seed = 75;
        gproj_system *s = gprojt_nodes_and_groups(first, &seed);
        gproj_term all[128];
        for (k = 0; k < 8; ++k) gprojt_add_local(s, 0, first, 24, 5, &seed);
        for (k = 0; k < 4; ++k) {
            gproj_group group;
            memset(&group, 0, sizeof group);
            group.name = "off", group.global = k == 2, group.schedule = gproj_keep(1);
            gproj_system_add_group(s, &group);
        }
        for (k = 0; k < first[24]; ++k) all[k] = gprojt_term(k, -1, 0.1);
        gprojt_add_linear(s, 2, first[5], 1, 0, 0);
        gprojt_add_joining(s, 3, first, 24, s->variable_count - 3, 1, &seed); /* to the last element with local unknowns */
        gproj_system_add_row(s, 4, first[24], all, 0, 0);
        gprojt_add_joining(s, 5, first, 24, -1, 1, &seed);
        gproj_system_solve(s, 1, NULL);
        GPROJT_CHECK(s->schur.on);
        for (k = 0; k < first[24]; ++k) s->x[k] = 2;
        for (i = 2; i < 6; ++i) {
            double large[128];
            gproj_system_set_schedule(s, i, gproj_keep(0));
            for (k = 0; k < 128; ++k) large[k] = round * 1e308;
            gproj_system_set_row(s, i, 0, large, round * 1e308);
            GPROJT_CHECK((fabs(gproj_system_row_value(s, i, 0, NULL)) <= DBL_MAX) == (round == 0));
        }
        GPROJT_CHECK(gproj_system_solve(s, 5, NULL).outcome != GPROJ_FAILED && s->schur.on);
        memcpy(x[round], s->x, (size_t)s->variable_count * sizeof(double));
        if (round == 1) GPROJT_CHECK(!memcmp(x[0], x[1], (size_t)s->variable_count * sizeof(double)));
        gproj_system_destroy(s);
    }
}

/* Where an element has no more rows than local unknowns, or rows of faces are many after all, the matrix is the one for all
   variables. */
GPROJT_TEST(not_taken_where_they_do_not_pay) {
    uint64_t seed = 72;
    int32_t few, k, first[25];
    for (few = 0; few < 2; ++few) {
        gproj_system *s = gprojt_nodes_and_groups(first, &seed);
        for (k = 0; k < 8; ++k) gprojt_add_local(s, 0, first, 24, few && k == 5 ? 3 : 4, &seed);
        for (k = 0; !few && k < 100; ++k) gprojt_add_joining(s, 1, first, 24, -1, k, &seed);
        GPROJT_CHECK(gproj_system_solve(s, 40, NULL).outcome == (few ? GPROJ_CONVERGED : GPROJ_STALLED));
        GPROJT_CHECK(!s->schur.on);
        gproj_system_destroy(s);
    }
}

static int32_t gprojt_largest_front(const gproj_system *s) {
    int32_t f, most = 0;
    for (f = 0; f < s->cholesky->symbolic.fronts; ++f) {
        const gproji_front *front = &s->cholesky->symbolic.front[f];
        most = gproji_max(most, front->width + front->below);
    }
    return most;
}

/* Rows that join blocks of 8 at random: the last fronts have hundreds of rows. */
GPROJT_TEST(large_fronts) {
    uint64_t seed = 73;
    gproj_system *s = gproj_system_create(NULL);
    int32_t k, j;
    gproj_system_add_variables(s, 800, 8, NULL);
    gprojt_add_group(s, "joining", GPROJ_CONSTRAINT, 1);
    for (k = 0; k < 640; ++k) {
        gproj_term term[6];
        int32_t a = gprojt_below(&seed, 100), b = (a + 1 + gprojt_below(&seed, 99)) % 100;
        for (j = 0; j < 6; ++j)
            term[j] = gprojt_term(8 * (j % 2 ? a : b) + gprojt_below(&seed, 8), -1, gprojt_uniform(&seed) - 0.5);
        gproj_system_add_row(s, 0, 6, term, gprojt_uniform(&seed) - 0.5, k);
    }
    GPROJT_CHECK(gprojt_plain_step_error(s, 0.1) < 1e-9);
    GPROJT_CHECK(s->schur.on && gprojt_largest_front(s) > 256);
    gproj_system_destroy(s);
}

/* Rows at two of six points, and at two of 250 others, which have four rows each, as most vertices of quads. */
GPROJT_TEST(large_fronts_at_points_with_four_rows) {
    uint64_t seed = 76;
    gproj_system *s = gproj_system_create(NULL);
    int32_t place[1000], k, j;
    for (k = 0; k < 1000; ++k) { /* shuffled */
        j = gprojt_below(&seed, k + 1);
        place[k] = place[j], place[j] = 6 + k / 4;
    }
    gproj_system_add_variables(s, 3 * 256, 3, NULL);
    gprojt_add_group(s, "joining", GPROJ_CONSTRAINT, 1);
    for (k = 0; k < 500; ++k) {
        gproj_term term[6];
        int32_t a = gprojt_below(&seed, 6), b = (a + 1 + gprojt_below(&seed, 5)) % 6;
        for (j = 0; j < 6; ++j)
            term[j] = gprojt_term(3 * (j == 0 ? a : j == 1 ? b : place[2 * k + j % 2]) + gprojt_below(&seed, 3), -1,
                                  gprojt_uniform(&seed) - 0.5);
        gproj_system_add_row(s, 0, 6, term, gprojt_uniform(&seed) - 0.5, k);
    }
    GPROJT_CHECK(gprojt_plain_step_error(s, 0.1) < 1e-9);
    GPROJT_CHECK(s->schur.on && gprojt_largest_front(s) > 256);
    gproj_system_destroy(s);
}

/* -- when they are taken -- */

static bool gprojt_is_on(const gproj_form *form) { return form->system->compiled && form->system->schur.on; }

static int gprojt_takes_multipliers(int what) {
    gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 6, 0.05);
    gproj_form *form = gproj_form_create(mesh, NULL);
    int on;
    gprojt_build(form, mesh, 1, what);
    GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED);
    on = gprojt_is_on(form);
    GPROJT_CHECK(!on || form->system->schur.elements <= mesh->face_count + mesh->vertex_count); /* no rows apart */
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return on;
}

GPROJT_TEST(taken_where_only_constraints_act) {
    static const int with[] = {
        0, GPROJT_CORNERS, GPROJT_CLOSE, GPROJT_VOLUME, GPROJT_GLIDES, GPROJT_NOT_FAIR, GPROJT_FORCES};
    static const int without[] = {GPROJT_FAIR, GPROJT_GAUSS, GPROJT_CIRCLES};
    size_t i;
    for (i = 0; i < sizeof with / sizeof *with; ++i) GPROJT_CHECK(gprojt_takes_multipliers(with[i]) == 1);
    for (i = 0; i < sizeof without / sizeof *without; ++i) GPROJT_CHECK(gprojt_takes_multipliers(without[i]) == 0);
}

/* Solves for the nearest point and drags take the matrix of all variables, others multipliers again, and what has been
   in between leaves no trace. */
GPROJT_TEST(nearest_solves_and_drags_do_without) {
    gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 5, 0.05);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double *start = gprojt_keep(mesh), *end;
    gproj_solve_options nearest;
    gproj_handles handles;
    gproj_drag *drag;
    int32_t vertex = mesh->vertex_count / 2;
    double target[3];
    memset(&nearest, 0, sizeof nearest);
    memset(&handles, 0, sizeof handles);
    nearest.nearest = true;
    handles.count = 1, handles.vertex = &vertex;
    gproj_add_planarity(form, 1);
    gproj_add_fixed_corners(form, 1);
    GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED && gprojt_is_on(form));
    end = gprojt_keep(mesh);
    gprojt_put_back(mesh, start);
    GPROJT_CHECK(gproj_solve(form, 30, &nearest).outcome == GPROJ_CONVERGED && !gprojt_is_on(form));
    gprojt_put_back(mesh, start);
    GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED && gprojt_is_on(form));
    GPROJT_CHECK(gprojt_unmoved(mesh, end));
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    GPROJT_CHECK(drag && !gprojt_is_on(form));
    memcpy(target, mesh->position + 3 * vertex, sizeof target);
    target[2] += 0.1;
    GPROJT_CHECK(gproj_drag_move(drag, target) == GPROJ_OK);
    gproj_drag_cancel(drag);
    gprojt_put_back(mesh, start);
    GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED && gprojt_is_on(form));
    GPROJT_CHECK(gprojt_unmoved(mesh, end));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(start);
    free(end);
}

/* Groups that never have a weight change no byte. */
GPROJT_TEST(idle_groups_change_nothing) {
    double *bytes = NULL;
    int with;
    for (with = 0; with < 2; ++with) {
        gproj_mesh *mesh = gprojt_warped(GPROJT_HEXAGONS, 5, 0.05);
        gproj_form *form = gproj_form_create(mesh, NULL);
        if (with) gproj_add_fairness(form, 0);
        if (with) gproj_add_lengths(form, mesh->edge_count, NULL, NULL, 0);
        gproj_add_planarity(form, 1);
        if (with) gproj_add_gauss_fairness(form, 0);
        if (with) gproj_add_circularity(form, 0);
        gproj_add_volume(form, gproj_volume(mesh), 1);
        if (with) gproj_add_total_area(form, 1, 0);
        GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED && gprojt_is_on(form));
        if (with) GPROJT_CHECK(gprojt_unmoved(mesh, bytes));
        if (!with) bytes = gprojt_keep(mesh);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    free(bytes);
}

/* Gives a group a weight after two iterations. */
typedef struct gprojt_waking {
    int32_t group;
    gproj_schedule schedule;
} gprojt_waking;

static bool gprojt_wake(void *user, gproj_system *s, const gproj_iteration *iteration) {
    const gprojt_waking *waking = (const gprojt_waking *)user;
    if (iteration->number == 2) gproj_system_set_schedule(s, waking->group, waking->schedule);
    return true;
}

GPROJT_TEST(a_callback_gives_a_first_weight) {
    double *bytes = NULL;
    int kind, frames;
    for (kind = 0; kind < 3; ++kind) {
        for (frames = 0; frames < 2; ++frames) {
            gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 6, 0.1);
            gproj_form *form = gproj_form_create(mesh, NULL);
            gproj_solve_options options;
            gprojt_waking waking;
            gproj_result result;
            memset(&options, 0, sizeof options);
            options.on_iteration = frames ? NULL : gprojt_wake;
            options.user = &waking;
            gproj_add_planarity(form, 1);
            waking.group = kind == 0   ? gproj_add_fairness(form, 0)
                           : kind == 1 ? gproj_add_volume(form, 1.02 * gproj_volume(mesh), 0)
                                       : gproj_add_fixed_corners(form, 0);
            waking.schedule = gprojt_schedule(kind == 0 ? 0.1 : 1, 1, kind == 0 ? 9 : 0);
            GPROJT_CHECK(gproj_solve_begin(form, 20, &options, NULL));
            do {
                result = gproj_solve_advance(form, 0);
                GPROJT_CHECK(result.iterations > 2 || gprojt_is_on(form));
                if (frames && result.iterations == 2)
                    gproj_system_set_schedule(gproj_form_system(form), waking.group, waking.schedule);
            } while (gproj_solve_is_on(form));
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations > 3);
            GPROJT_CHECK(gprojt_is_on(form) == (kind > 0));
            if (kind > 0) GPROJT_CHECK(gproj_form_group_info(form, waking.group).max <= 1e-12);
            if (frames) GPROJT_CHECK(gprojt_unmoved(mesh, bytes));
            if (frames) free(bytes);
            if (!frames) bytes = gprojt_keep(mesh);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
    }
}

typedef struct gprojt_opening {
    int32_t planarity;
    int32_t before, after; /* multipliers; 0: none */
} gprojt_opening;

static int32_t gprojt_multipliers(const gproj_system *s) { return s->schur.on ? s->schur.first[s->schur.elements] : 0; }

/* One edge's row counts twice from the third iteration on. */
static bool gprojt_open(void *user, gproj_system *s, const gproj_iteration *iteration) {
    static const double twice[6] = {2, 2, 2, -2, -2, -2};
    gprojt_opening *opening = (gprojt_opening *)user;
    if (iteration->number == 2) {
        opening->before = gprojt_multipliers(s);
        GPROJT_CHECK(gproj_system_set_row(s, opening->planarity, 1, twice, 0) == GPROJ_OK);
    }
    if (iteration->number == 3) opening->after = gprojt_multipliers(s);
    return true;
}

/* Rows that closed until a callback changes one: their faces have one multiplier more then. */
GPROJT_TEST(a_callback_opens_rows) {
    static const int shapes[] = {GPROJT_QUADS, GPROJT_HEXAGONS};
    int k;
    for (k = 0; k < 2; ++k) {
        gproj_mesh *mesh = gprojt_warped(shapes[k], 6, 0.1);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_solve_options options;
        gprojt_opening opening;
        memset(&options, 0, sizeof options);
        memset(&opening, 0, sizeof opening);
        options.on_iteration = gprojt_open;
        options.user = &opening;
        opening.planarity = gproj_add_planarity(form, 1);
        GPROJT_CHECK(gproj_solve(form, 20, &options).outcome == GPROJ_CONVERGED);
        GPROJT_CHECK(opening.before > 0 && opening.after == opening.before + mesh->face_count);
        GPROJT_CHECK(gproj_form_group_info(form, opening.planarity).max <= 1e-12);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* A mesh of quads whose guard acts in the first iteration. */
static gproj_mesh *gprojt_crooked(void) { return gprojt_warped(GPROJT_QUADS, 8, 0.35); }

/* How many rows of the guard have multipliers. */
static int32_t gprojt_guarded(const gproj_form *form) {
    const gproji_group *g = &form->system->group[gproji_own_group(form, GPROJI_OWN_GUARD)];
    int32_t r, count = 0;
    for (r = 0; r < g->row_count; ++r) count += !g->row[r].dormant;
    return count;
}

/* Rows of the guard get their multipliers where one acts, and then the steps are those of a form in which all had them
   from the beginning; in frames they are the same. */
GPROJT_TEST(the_guard_waits_until_it_acts) {
    gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 4, 0.05), *crooked[3];
    gproj_form *form = gproj_form_create(mesh, NULL), *forms[3];
    gproj_result result;
    int k;
    gproj_add_planarity(form, 1);
    GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED && gprojt_is_on(form));
    GPROJT_CHECK(gprojt_guarded(form) == 0);
    for (k = 0; k < 3; ++k) {
        crooked[k] = gprojt_crooked();
        forms[k] = gproj_form_create(crooked[k], NULL);
        gproj_add_planarity(forms[k], 1);
    }
    GPROJT_CHECK(gproj_solve(forms[0], 20, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_guarded(forms[0]) > 0 && gprojt_guarded(forms[0]) < crooked[0]->face_count / 2);
    GPROJT_REQUIRE(gproj_solve_begin(forms[1], 20, NULL, NULL));
    do result = gproj_solve_advance(forms[1], 0);
    while (gproj_solve_is_on(forms[1]));
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gprojt_guarded(forms[1]) == gprojt_guarded(forms[0]));
    GPROJT_CHECK(gprojt_unmoved(crooked[0], crooked[1]->position));
    gproj_solve(forms[2], 0, NULL); /* adds the guard */
    for (k = 0; k < crooked[2]->face_count; ++k)
        forms[2]->system->group[gproji_own_group(forms[2], GPROJI_OWN_GUARD)].row[k].dormant = false;
    gproji_system_forget(forms[2]->system);
    GPROJT_CHECK(gproj_solve(forms[2], 20, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_largest_move(crooked[0]->position, crooked[2]->position, crooked[0]->vertex_count) <= 1e-9);
    for (k = 0; k < 3; ++k) {
        GPROJT_CHECK(gprojt_is_on(forms[k]));
        gproj_form_destroy(forms[k]);
        gproj_mesh_destroy(crooked[k]);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A group that loses its weight, and gets it again, costs no analysis. */
GPROJT_TEST(weights_of_0_need_no_analysis) {
    int kind;
    for (kind = 0; kind < 3; ++kind) {
        gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 6, 0.1);
        gproj_form *form = gproj_form_create(mesh, NULL);
        uint64_t allocations;
        int32_t group, k;
        gproj_add_planarity(form, 1);
        group = kind == 0   ? gproj_add_fairness(form, 0.1)
                : kind == 1 ? gproj_add_closeness(form, 0.1)
                            : gproj_add_volume(form, gproj_volume(mesh), 1);
        gproj_add_fixed_corners(form, 1);
        GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED);
        gproj_set_schedule(form, group, gprojt_schedule(0, 1, 0));
        gprojt_shake(mesh, 0.01, 3);
        GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED); /* with the default closeness */
        allocations = gproj_form_memory(form).allocations;
        for (k = 0; k < 4; ++k) {
            gproj_set_schedule(form, group, gprojt_schedule(k % 2 ? 0.1 : 0, 1, 0));
            gprojt_shake(mesh, 0.01, 5);
            GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED);
            GPROJT_CHECK(gprojt_is_on(form) == (kind > 0));
        }
        GPROJT_CHECK(gproj_form_memory(form).allocations == allocations);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- threads, memory, states -- */

static double *gprojt_positions_by(int shape, int32_t n, int threads, gproj_iteration *last) {
    gproj_mesh *mesh = gprojt_warped(shape, n, 0.05);
    double *positions;
    gproj_form *form;
    gproj_host host;
    memset(&host, 0, sizeof host);
    host.parallel.run = gprojt_run_threads;
    host.parallel.user = &threads;
    form = gproj_form_create(mesh, &host);
    gproj_add_planarity(form, 1);
    gproj_add_volume(form, 1.01 * gproj_volume(mesh), 1);
    gproj_add_fixed_corners(form, 1);
    last->residual = gproj_solve(form, 3, NULL).residual;
    GPROJT_CHECK(gprojt_is_on(form) && form->system->schur.chunks > 1);
    positions = gprojt_keep(mesh);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return positions;
}

GPROJT_TEST(same_bytes_on_any_number_of_threads) {
    static const int threads[3] = {2, 3, 7};
    static const int shape[2] = {GPROJT_QUADS, GPROJT_HEXAGONS};
    int i, k;
    for (i = 0; i < 2; ++i) {
        gproj_iteration one, many;
        gproj_mesh *mesh = gprojt_warped(shape[i], 40, 0);
        double *expected = gprojt_positions_by(shape[i], 40, 1, &one);
        for (k = 0; k < 3; ++k) {
            double *positions = gprojt_positions_by(shape[i], 40, threads[k], &many);
            GPROJT_CHECK(!memcmp(expected, positions, 3 * (size_t)mesh->vertex_count * sizeof *expected));
            GPROJT_CHECK(one.residual == many.residual);
            free(positions);
        }
        free(expected);
        gproj_mesh_destroy(mesh);
    }
}

/* With a wide row, and fixed ones; perhaps one more group, with a weight from the third iteration on. */
typedef struct gprojt_many {
    const gproj_mesh *mesh;
    bool wakes;
    gprojt_waking waking;
} gprojt_many;

static void gprojt_build_planar(gproj_form *form, void *user) {
    (void)user;
    gproj_add_planarity(form, 1);
}

static void gprojt_build_many(gproj_form *form, void *user) {
    gprojt_many *many = (gprojt_many *)user;
    gprojt_build(form, many->mesh, 1, GPROJT_CLOSE | GPROJT_VOLUME | GPROJT_BOUNDS | GPROJT_PART);
    gproj_add_fixed_corners(form, 1);
    if (!many->wakes) return;
    many->waking.group = gproj_add_lengths(form, 5, NULL, NULL, 0);
    many->waking.schedule = gprojt_schedule(1, 1, 0);
}

typedef struct gprojt_account {
    uint64_t first, last;
    int32_t iterations;
} gprojt_account;

static bool gprojt_count_allocations(void *user, gproj_system *s, const gproj_iteration *iteration) {
    gprojt_account *account = (gprojt_account *)user;
    account->last = gproj_system_memory(s).allocations;
    if (iteration->number == 1) account->first = account->last;
    account->iterations = iteration->number;
    return true;
}

GPROJT_TEST(no_allocation_after_the_first_iteration) {
    gproj_mesh *mesh = gprojt_warped(GPROJT_ROSETTE, 0, 0.1);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_solve_options options;
    gprojt_account account;
    gprojt_many many;
    int k;
    memset(&options, 0, sizeof options);
    memset(&account, 0, sizeof account);
    options.on_iteration = gprojt_count_allocations;
    options.user = &account;
    memset(&many, 0, sizeof many);
    many.mesh = mesh;
    gprojt_build_many(form, &many);
    for (k = 0; k < 2; ++k) {
        uint64_t before = account.last;
        gproj_solve(form, 12, &options);
        GPROJT_CHECK(gprojt_is_on(form) && account.iterations > 3 && account.last == account.first);
        GPROJT_CHECK(k == 0 || account.last == before);
        gprojt_shake(mesh, 0.05, 9);
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A drag after steps by multipliers: it needs the matrix for all variables, and so another analysis. */
static bool gprojt_drag_after(const gproj_host *host, void *user) {
    gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 5, 0.05);
    gproj_form *form = gproj_form_create(mesh, host);
    bool whole = false;
    (void)user;
    if (form) gprojt_build(form, mesh, 1, 0);
    if (form && gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED) {
        int32_t v = gprojt_middle(mesh), k;
        gproj_handles handles = gprojt_vertex_handles(1, &v);
        double to[3];
        gproj_error error;
        gproj_drag *drag;
        GPROJT_CHECK(gprojt_is_on(form));
        drag = gproj_drag_begin(form, &handles, NULL, &error);
        GPROJT_CHECK(drag || error.code == GPROJ_ERROR_MEMORY);
        for (k = 0; k < 3; ++k) to[k] = mesh->position[3 * v + k] + (k == 2 ? 0.1 : 0);
        whole = drag && gproj_drag_move(drag, to) == GPROJ_OK;
        if (whole) GPROJT_NEAR(mesh->position[3 * v + 2], to[2], 1e-9);
        if (drag) whole = gproj_drag_end(drag).outcome != GPROJ_FAILED && whole;
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return whole;
}

GPROJT_TEST(drags_after_multipliers_without_memory) {
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_drag_after, NULL) >= 100);
}

GPROJT_TEST(every_allocation_may_fail) {
    gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 4, 0.05);
    gproj_solve_options options;
    gprojt_many many;
    long calls;
    memset(&options, 0, sizeof options);
    memset(&many, 0, sizeof many);
    options.on_iteration = gprojt_wake;
    options.user = &many.waking;
    many.mesh = mesh;
    calls = gprojt_fail_every_allocation_of_solve(mesh, gprojt_build_many, &many, 3, NULL);
    GPROJT_CHECK(calls > 50);
    many.wakes = true; /* two analyses */
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_build_many, &many, 4, &options) > calls + 50);
    gproj_mesh_destroy(mesh);
    mesh = gprojt_warped(GPROJT_QUADS, 4, 0.05);
    calls = gprojt_fail_every_allocation_of_solve(mesh, gprojt_build_planar, NULL, 2, NULL);
    gproj_mesh_destroy(mesh);
    mesh = gprojt_crooked(); /* the guard acts: two analyses */
    GPROJT_CHECK(gprojt_fail_every_allocation_of_solve(mesh, gprojt_build_planar, NULL, 2, NULL) > calls + 50);
    gproj_mesh_destroy(mesh);
}

/* A form with a fairness that has a weight, or had one in an earlier solve. */
enum {
    GPROJT_NEVER,
    GPROJT_ONCE,
    GPROJT_UNTOUCHED, /* made, and nothing else */
    GPROJT_OPENED,    /* the row of an edge counts twice: the rows of its face add up to something */
    GPROJT_PASTS
};

static gproj_form *gprojt_form_with_past(gproj_mesh *mesh, int past) {
    gproj_form *form = gproj_form_create(mesh, NULL);
    static const double twice[6] = {2, 2, 2, -2, -2, -2};
    int32_t planarity, fairness = gproj_add_fairness(form, past == GPROJT_ONCE ? 0.1 : 0);
    double *before = gprojt_keep(mesh);
    planarity = gproj_add_planarity(form, 1);
    gproj_add_gliding_boundary(form, 1);
    gproj_add_volume(form, 1.01 * gproj_volume(mesh), 1);
    if (past == GPROJT_OPENED) gproj_system_set_row(gproj_form_system(form), planarity, 1, twice, 0);
    if (past != GPROJT_UNTOUCHED) gproj_solve(form, 3, NULL);
    if (past == GPROJT_ONCE) gproj_set_schedule(form, fairness, gprojt_schedule(0, 1, 0));
    gprojt_put_back(mesh, before);
    free(before);
    return form;
}

/* Have both forms their groups in the same order? The library adds its own when they are first needed. */
static bool gprojt_same_order(const gproj_form *a, const gproj_form *b) {
    const gproj_system *s = a->system, *t = b->system;
    bool same = s->group_count == t->group_count;
    int32_t i;
    for (i = 0; same && i < s->group_count; ++i) same = strcmp(s->group[i].name, t->group[i].name) == 0;
    return same;
}

/* Is the mesh where the positions are: to the bit, unless the matrix of all variables was added up in another order? */
static bool gprojt_followed(const gproj_form *form, const gproj_form *other) {
    const gproj_mesh *mesh = form->mesh;
    const double *position = other->mesh->position;
    if (gprojt_is_on(form) || gprojt_same_order(form, other)) return gprojt_unmoved(mesh, position);
    return gprojt_largest_move(mesh->position, position, mesh->vertex_count) <= 1e-8;
}

/* A state after three frames goes on in another form as in its own. */
static void gprojt_check_restored(int past, int other_past, bool nearest) {
    gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 5, 0.05), *other_mesh = gprojt_warped(GPROJT_QUADS, 5, 0.05);
    gproj_form *form = gprojt_form_with_past(mesh, past), *other = gprojt_form_with_past(other_mesh, other_past);
    gproj_solve_options options;
    gproj_result result;
    size_t size;
    void *state;
    int k;
    memset(&options, 0, sizeof options);
    options.nearest = nearest;
    gproj_solve_begin(form, 20, &options, NULL);
    for (k = 0; k < 3; ++k) gproj_solve_advance(form, 0);
    size = gproj_state_size(form);
    state = malloc(size);
    GPROJT_CHECK(gproj_state_save(form, state, size, NULL) == GPROJ_OK);
    do result = gproj_solve_advance(form, 0);
    while (gproj_solve_is_on(form));
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_is_on(form) == (past != GPROJT_ONCE && !nearest));
    GPROJT_CHECK(gproj_state_restore(other, state, size, NULL) == GPROJ_OK);
    do result = gproj_solve_advance(other, 0);
    while (gproj_solve_is_on(other));
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && gprojt_is_on(other) == gprojt_is_on(form));
    GPROJT_CHECK(gprojt_followed(form, other));
    gprojt_shake(mesh, 0.01, 4);
    gprojt_shake(other_mesh, 0.01, 4);
    GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == gproj_solve(other, 12, NULL).outcome);
    GPROJT_CHECK(gprojt_followed(form, other) && gprojt_is_on(other) == gprojt_is_on(form));
    free(state);
    gproj_form_destroy(form);
    gproj_form_destroy(other);
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(other_mesh);
}

GPROJT_TEST(states_go_on_in_forms_with_another_past) {
    int past, other;
    for (past = 0; past < GPROJT_PASTS; ++past)
        for (other = 0; other < GPROJT_PASTS; ++other) {
            gprojt_check_restored(past, other, false);
            gprojt_check_restored(past, other, true);
        }
}

/* Between the frames of a nearest solve a group may get its first weight, and the system may be solved; then the
   multipliers of the frames begin anew. */
GPROJT_TEST(frames_of_nearest_solves_may_be_disturbed) {
    int what;
    for (what = 0; what < 2; ++what) {
        gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 5, 0.05);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_solve_options options;
        gproj_result result;
        int32_t group, size, frames = 0;
        memset(&options, 0, sizeof options);
        options.nearest = true;
        gproj_add_planarity(form, 1);
        group = gproj_add_fairness(form, 0);
        gproj_solve_begin(form, 40, &options, NULL);
        do {
            result = gproj_solve_advance(form, 0);
            if (++frames != 5) continue;
            if (what == 0) gproj_set_schedule(form, group, gprojt_schedule(0.1, 1, 0));
            if (what == 1) gproj_system_solve(gproj_form_system(form), 1, NULL);
            size = (int32_t)gproj_state_size(form);
            GPROJT_CHECK(size > 0);
        } while (gproj_solve_is_on(form));
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations > 5);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- faces that are none -- */

enum {
    GPROJT_COLLINEAR,
    GPROJT_NEARLY, /* collinear */
    GPROJT_EQUAL,  /* two vertices */
    GPROJT_POINT,
    GPROJT_BOW_TIE,
    GPROJT_FLIPPED,
    GPROJT_BADS
};

/* Spoils the face whose first corner is in the middle of the mesh. */
static void gprojt_spoil(gproj_mesh *mesh, int bad) {
    int32_t h = mesh->face_halfedge[mesh->face_count / 2], k;
    double *p[4], swap[3];
    for (k = 0; k < 4; ++k, h = mesh->next[h]) p[k] = mesh->position + 3 * mesh->origin[h];
    memcpy(swap, p[1], sizeof swap);
    for (k = 0; k < 3; ++k) {
        double d = p[1][k] - p[0][k];
        if (bad == GPROJT_COLLINEAR || bad == GPROJT_NEARLY) {
            double off = bad == GPROJT_NEARLY ? 1e-9 * (k + 1) : 0;
            p[2][k] = p[0][k] + 2 * d + off * k, p[3][k] = p[0][k] + 3 * d - off;
        }
        if (bad == GPROJT_EQUAL) p[1][k] = p[0][k];
        if (bad == GPROJT_POINT) p[1][k] = p[2][k] = p[3][k] = p[0][k];
        if (bad == GPROJT_BOW_TIE) p[1][k] = p[2][k], p[2][k] = swap[k];
        if (bad == GPROJT_FLIPPED) p[2][k] = p[0][k] - 0.7 * (p[2][k] - p[0][k]);
    }
}

static bool gprojt_look_for_nan(void *user, gproj_system *s, const gproj_iteration *iteration) {
    GPROJT_CHECK(gprojt_all_finite(gproj_system_values(s), gproj_system_variable_count(s)));
    GPROJT_CHECK(iteration->step <= DBL_MAX && iteration->residual <= DBL_MAX && iteration->merit <= DBL_MAX);
    ++*(int *)user;
    return true;
}

GPROJT_TEST(bad_faces) {
    static const double epsilon[4] = {1e-3, 1e-5, 1e-8, 1e-12};
    int bad, fixed, k;
    for (bad = 0; bad < GPROJT_BADS; ++bad)
        for (fixed = 0; fixed < 2; ++fixed) {
            gproj_mesh *mesh = gprojt_warped(GPROJT_QUADS, 4, 0.05);
            gproj_form *form;
            gproj_solve_options options;
            gproj_result result;
            int calls = 0;
            memset(&options, 0, sizeof options);
            options.on_iteration = gprojt_look_for_nan;
            options.user = &calls;
            gprojt_spoil(mesh, bad);
            form = gproj_form_create(mesh, NULL);
            gproj_add_planarity(form, 1);
            if (fixed) gproj_add_fixed_corners(form, 1);
            if (fixed) gproj_add_volume(form, 1, 1);
            gprojt_begin(form, false);
            for (k = 0; k < 4; ++k) {
                GPROJT_CHECK(gprojt_is_on(form) && gproji_find_step(&form->solve.loop, epsilon[k]));
                GPROJT_CHECK(gprojt_all_finite(form->system->vector.step, form->system->variable_count));
            }
            if (bad >= GPROJT_EQUAL && bad != GPROJT_POINT) GPROJT_CHECK(gprojt_step_error(form, 1e-3) <= 1e-9);
            result = gproj_solve(form, 20, &options);
            GPROJT_CHECK(result.outcome != GPROJ_FAILED && result.message[0] && calls > 0);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
}

/* A face on a fixed line has rows of two kinds for a normal of three components. */
GPROJT_TEST(faces_on_fixed_lines) {
    int i, j, k;
    for (i = 0; i < 12; ++i) {
        gproj_mesh *mesh = gprojt_noisy(GPROJT_QUADS, 4, 0.1, (uint64_t)i);
        int32_t vertex[4], h = mesh->face_halfedge[9];
        double direction[3], length = gproj_mesh_mean_edge_length(mesh);
        gproj_solve_options options;
        gproj_form *form;
        uint64_t seed = (uint64_t)i;
        memset(&options, 0, sizeof options);
        options.skip_guard = true;
        for (j = 0; j < 3; ++j) direction[j] = 0.3 * length * (i % 3 ? gprojt_uniform(&seed) - 0.5 : j == 2 ? 1 : 1e-3);
        for (k = 0; k < 4; ++k, h = mesh->next[h])
            for (j = 0, vertex[k] = mesh->origin[h]; j < 3; ++j)
                mesh->position[3 * vertex[k] + j] = mesh->position[3 * vertex[0] + j] + k * direction[j];
        form = gproj_form_create(mesh, NULL);
        gproj_add_planarity(form, 1);
        gproj_add_fixed(form, 4, vertex, 1);
        GPROJT_CHECK(gproj_solve(form, 30, &options).outcome == GPROJ_CONVERGED && gprojt_is_on(form));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

int main(void) {
    GPROJT_RUN(steps_are_those_of_the_dense_matrix);
    GPROJT_RUN(steps_of_many_elements);
    GPROJT_RUN(elements_of_all_kinds);
    GPROJT_RUN(groups_without_weight_may_overflow);
    GPROJT_RUN(elements_of_numbers_beyond_all_faces);
    GPROJT_RUN(not_taken_where_they_do_not_pay);
    GPROJT_RUN(large_fronts);
    GPROJT_RUN(large_fronts_at_points_with_four_rows);
    GPROJT_RUN(taken_where_only_constraints_act);
    GPROJT_RUN(nearest_solves_and_drags_do_without);
    GPROJT_RUN(idle_groups_change_nothing);
    GPROJT_RUN(a_callback_gives_a_first_weight);
    GPROJT_RUN(a_callback_opens_rows);
    GPROJT_RUN(the_guard_waits_until_it_acts);
    GPROJT_RUN(weights_of_0_need_no_analysis);
    GPROJT_RUN(same_bytes_on_any_number_of_threads);
    GPROJT_RUN(no_allocation_after_the_first_iteration);
    GPROJT_RUN(every_allocation_may_fail);
    GPROJT_RUN(drags_after_multipliers_without_memory);
    GPROJT_RUN(states_go_on_in_forms_with_another_past);
    GPROJT_RUN(frames_of_nearest_solves_may_be_disturbed);
    GPROJT_RUN(bad_faces);
    GPROJT_RUN(faces_on_fixed_lines);
    return gprojt_report();
}
