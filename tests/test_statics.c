/* test_statics.c - >>statics: equilibrium, bounds on forces, loads, supports; all checked from outside. */
#include "gprojt_form.h"
#include "gprojt_inside.h"

enum {
    QUADS,
    TRIANGLES,
    HYBRID,
    HEXAGONS
};

/* -- meshes -- */

/* A patch of the shape over a square of side `size`, with the height `rise` at its middle and 0 along its boundary. */
static gproj_mesh *gprojt_vault(int shape, int32_t n, double size, double rise) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_shape(shape, n));
    int32_t v;
    for (v = 0; mesh && v < mesh->vertex_count; ++v) {
        double *p = mesh->position + 3 * v, x = 2 * p[0] - 1, y = 2 * p[1] - 1;
        bool boundary = gproj_mesh_is_boundary_vertex(mesh, v);
        p[0] = size / 2 * x;
        p[1] = size / 2 * y;
        p[2] = boundary ? 0 : rise * (1 - x * x) * (1 - y * y);
    }
    return mesh;
}

/* The same over a paraboloid, whose boundary is not plane: with flat faces and a flat fixed boundary all would be flat. */
static gproj_mesh *gprojt_hill(int shape, int32_t n, double size, double rise) {
    gproj_mesh *mesh = gprojt_vault(shape, n, size, rise);
    int32_t v;
    for (v = 0; mesh && v < mesh->vertex_count; ++v) {
        double *p = mesh->position + 3 * v;
        p[2] = rise * (1 - 2 * (p[0] * p[0] + p[1] * p[1]) / (size * size));
    }
    return mesh;
}

typedef struct gprojt_list {
    int32_t count, *item;
} gprojt_list;

static gprojt_list gprojt_boundary(const gproj_mesh *mesh) {
    gprojt_list list;
    int32_t v;
    list.count = 0;
    list.item = (int32_t *)malloc(((size_t)mesh->vertex_count + 1) * sizeof(int32_t));
    if (!list.item) abort();
    for (v = 0; v < mesh->vertex_count; ++v)
        if (mesh->vertex_halfedge[v] >= 0 && gproj_mesh_is_boundary_vertex(mesh, v)) list.item[list.count++] = v;
    return list;
}

static double *gprojt_numbers(int32_t count) {
    double *numbers = (double *)calloc((size_t)count + 1, sizeof *numbers);
    if (!numbers) abort();
    return numbers;
}

static gproj_loads gprojt_no_loads(void) {
    gproj_loads loads;
    memset(&loads, 0, sizeof loads);
    return loads;
}

static gproj_supports gprojt_pins(gprojt_list list) {
    gproj_supports supports;
    supports.count = list.count, supports.vertex = list.item, supports.slides = NULL;
    return supports;
}

/* A form in equilibrium with its boundary pinned and fixed. */
static gproj_form *gprojt_pinned_form(gproj_mesh *mesh, const gproj_host *host, const gproj_loads *loads) {
    gproj_form *form = gproj_form_create(mesh, host);
    gprojt_list list = gprojt_boundary(mesh);
    gproj_supports supports = gprojt_pins(list);
    gproj_add_equilibrium(form, loads, &supports, 1);
    gproj_add_fixed_boundary(form, 1);
    free(list.item);
    return form;
}

/* -- loads and equilibrium computed apart from the library -- */

/* Twice the vectorial area as the sum of triangles about the first corner. */
static void gprojt_double_area(const gproj_mesh *mesh, int32_t face, double out[3]) {
    int32_t first = mesh->face_halfedge[face], h = mesh->next[first], k;
    const double *o = mesh->position + 3 * mesh->origin[first];
    out[0] = out[1] = out[2] = 0;
    for (; mesh->next[h] != first; h = mesh->next[h]) {
        const double *p = mesh->position + 3 * mesh->origin[h], *q = mesh->position + 3 * mesh->origin[mesh->next[h]];
        for (k = 0; k < 3; ++k) {
            int32_t a = (k + 1) % 3, b = (k + 2) % 3;
            out[k] += (p[a] - o[a]) * (q[b] - o[b]) - (p[b] - o[b]) * (q[a] - o[a]);
        }
    }
}

static double *gprojt_true_loads(const gproj_mesh *mesh, const gproj_loads *loads) {
    double *f = gprojt_numbers(3 * mesh->vertex_count);
    int32_t i, h;
    for (i = 0; loads->point_load && i < 3 * mesh->vertex_count; ++i) f[i] = loads->point_load[i];
    for (i = 0; i < mesh->edge_count; ++i) {
        double half =
            0.5 * gprojt_edge_length(mesh, i) * (loads->edge_density ? loads->edge_density[i] : loads->density);
        f[3 * mesh->origin[2 * i] + 2] -= half;
        f[3 * mesh->origin[2 * i + 1] + 2] -= half;
    }
    for (h = 0; h < mesh->halfedge_count; ++h) {
        double a[3];
        if (mesh->face[h] < 0) continue;
        gprojt_double_area(mesh, mesh->face[h], a);
        f[3 * mesh->origin[h] + 2] -=
            0.5 * (loads->area_load * sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) + loads->snow * fabs(a[2])) /
            mesh->face_degree[mesh->face[h]];
    }
    return f;
}

/* f + sum_j w_ij (v_i - v_j), 3 numbers a vertex. */
static double *gprojt_sums(const gproj_mesh *mesh, const double *w, const double *f) {
    double *sum = gprojt_numbers(3 * mesh->vertex_count);
    int32_t h, k;
    for (k = 0; k < 3 * mesh->vertex_count; ++k) sum[k] = f[k];
    for (h = 0; h < mesh->halfedge_count; ++h)
        for (k = 0; k < 3; ++k)
            sum[3 * mesh->origin[h] + k] +=
                w[h / 2] * (mesh->position[3 * mesh->origin[h] + k] - mesh->position[3 * mesh->origin[h ^ 1] + k]);
    return sum;
}

static bool gprojt_listed(const int32_t *list, int32_t count, int32_t item) {
    int32_t i;
    for (i = 0; i < count; ++i)
        if (list[i] == item) return true;
    return false;
}

/* The largest unbalanced force in vertices that are not listed, over the largest load (1 without loads). */
static double gprojt_unbalance(const gproj_mesh *mesh, const double *w, const double *f, const int32_t *pins,
                               int32_t count) {
    static const double zero[3] = {0, 0, 0};
    double *sum = gprojt_sums(mesh, w, f), worst = 0, load = 0;
    int32_t v;
    for (v = 0; v < mesh->vertex_count; ++v) {
        load = fmax(load, gprojt_far(f + 3 * v, zero));
        if (!gprojt_listed(pins, count, v)) worst = fmax(worst, gprojt_far(sum + 3 * v, zero));
    }
    free(sum);
    return load > 0 ? worst / load : worst;
}

/* Checks a solved form with its boundary pinned: the loads are what they should be, every vertex is in equilibrium, and
   loads and reactions balance with their moments. Returns the unbalance. */
static double gprojt_check_balance(gproj_form *form, const gproj_loads *loads, double tolerance) {
    const gproj_mesh *mesh = gprojt_inside_mesh(form);
    int32_t n = 3 * mesh->vertex_count, i, k;
    double *w = gprojt_numbers(mesh->edge_count), *f = gprojt_numbers(n), *r = gprojt_numbers(n);
    double *truth = gprojt_true_loads(mesh, loads), unbalance, size = 0, sum[6] = {0};
    gprojt_list pins = gprojt_boundary(mesh);
    GPROJT_CHECK(gproj_get_forces(form, w, NULL) == GPROJ_OK && gproj_get_loads(form, f, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_get_reactions(form, r, NULL) == GPROJ_OK);
    for (i = 0; i < n; ++i) size = fmax(size, fabs(truth[i]));
    if (size == 0) size = 1;
    for (i = 0; i < n; ++i) GPROJT_NEAR(f[i], truth[i], 1e-12 * size);
    unbalance = gprojt_unbalance(mesh, w, truth, pins.item, pins.count);
    if (!(unbalance <= tolerance)) printf("    unbalance %g\n", unbalance);
    GPROJT_CHECK(unbalance <= tolerance);
    GPROJT_NEAR(gproj_measure_forces(form, NULL).residual, unbalance, 1e-12 + 1e-6 * unbalance);
    for (i = 0; unbalance <= tolerance && i < mesh->vertex_count; ++i) {
        const double *p = mesh->position + 3 * i;
        double both[3];
        for (k = 0; k < 3; ++k) both[k] = r[3 * i + k] + f[3 * i + k];
        for (k = 0; k < 3; ++k) sum[k] += both[k];
        for (k = 0; k < 3; ++k) sum[3 + k] += p[(k + 1) % 3] * both[(k + 2) % 3] - p[(k + 2) % 3] * both[(k + 1) % 3];
    }
    for (k = 0; k < 6; ++k) GPROJT_NEAR(sum[k], 0, mesh->vertex_count * size * (tolerance + 1e-12) * 10);
    free(w), free(f), free(r), free(truth), free(pins.item);
    return unbalance;
}

/* The least and the largest force density of the edges that have one. */
static void gprojt_range(const gproj_form *form, double range[2]) {
    double *w = gprojt_numbers(gprojt_inside_mesh(form)->edge_count);
    gproj_get_forces(form, w, NULL);
    range[0] = HUGE_VAL, range[1] = -HUGE_VAL;
    for (int32_t e = 0; e < gprojt_inside_mesh(form)->edge_count; ++e) {
        if (gprojt_inside_force(form, e) < 0) continue;
        range[0] = fmin(range[0], w[e]);
        range[1] = fmax(range[1], w[e]);
    }
    free(w);
}

/* -- gradients -- */

/* Loads of all kinds, some of them upwards. */
static gproj_loads gprojt_mixed_loads(int mix, double *density, double *point, const gproj_mesh *mesh) {
    gproj_loads loads = gprojt_no_loads();
    uint64_t seed = 5;
    int32_t i;
    for (i = 0; i < mesh->edge_count; ++i) density[i] = gprojt_uniform(&seed);
    for (i = 0; i < 3 * mesh->vertex_count; ++i) point[i] = 2 * gprojt_uniform(&seed) - 1;
    if (mix & 1) loads.density = 0.7;
    if (mix & 2) loads.edge_density = density;
    if (mix & 4) loads.area_load = 1.3;
    if (mix & 8) loads.snow = -0.4;
    if (mix & 16) loads.point_load = point;
    return loads;
}

GPROJT_TEST(gradients) {
    int shape;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        static const uint8_t slides[4] = {0, 1, 6, 7};
        int32_t pins[4] = {0, 3, 4, 7}, e;
        gproj_mesh *mesh = gprojt_noisy(shape, 3, 0.1, 7);
        double *w = gprojt_numbers(mesh->edge_count), *point = gprojt_numbers(3 * mesh->vertex_count);
        double *sections = gprojt_numbers(mesh->edge_count);
        gproj_loads loads = gprojt_mixed_loads(31, w, point, mesh);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_supports supports;
        uint64_t seed = 2;
        supports.count = 4, supports.vertex = pins, supports.slides = slides;
        for (e = 0; e < mesh->edge_count; ++e) sections[e] = 0.5 + gprojt_uniform(&seed);
        GPROJT_CHECK(gproj_add_equilibrium(form, &loads, &supports, 1) >= 0);
        GPROJT_CHECK(gproj_add_compression(form, mesh->edge_count, NULL, 1) >= 0);
        GPROJT_CHECK(gproj_add_tension(form, 4, pins, 1) >= 0);
        GPROJT_CHECK(gproj_add_stress_bounds(form, mesh->edge_count, NULL, sections, -1, 2, 1) >= 0);
        GPROJT_CHECK(gproj_add_force_fairness(form, 1) >= 0);
        for (e = 0; e < mesh->edge_count; ++e) w[e] = 4 * gprojt_uniform(&seed) - 2;
        GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK);
        GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(w), free(point), free(sections);
    }
}

/* The loads in the rows of equilibrium (all forces are 0): the right ones where they were linearised, and with the right
   derivative along a random direction, by central differences of the true loads. */
GPROJT_TEST(load_rows_are_tangent) {
    int shape, mix;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        for (mix = 1; mix < 32; mix += shape ? 3 : 1) {
            int32_t pins[3] = {mix % 2, 2, 5}, i, v, c; /* vertex 0 is free where mix is odd */
            static const uint8_t slides[3] = {0, 3, 4};
            gproj_mesh *mesh = gprojt_noisy(shape, 3, 0.2, 3 + (uint64_t)mix);
            int32_t n = 3 * mesh->vertex_count, group;
            double *w = gprojt_numbers(mesh->edge_count), *point = gprojt_numbers(n), *kept = gprojt_keep(mesh);
            double *d = gprojt_numbers(n), *x, *f[3], *row[2], centre[3], scale, h = 1e-4;
            gproj_loads loads = gprojt_mixed_loads(mix, w, point, mesh);
            gproj_form *form = gproj_form_create(mesh, NULL);
            gproj_supports supports;
            uint64_t seed = 2;
            supports.count = 3, supports.vertex = pins, supports.slides = slides;
            group = gproj_add_equilibrium(form, &loads, &supports, 1);
            GPROJT_REQUIRE(group >= 0);
            gproj_form_units(form, centre, &scale);
            gproj_system_check_gradients(gproj_form_system(form)); /* refreshes the rows */
            x = gproj_system_values(gproj_form_system(form));
            for (i = 0; i < n; ++i) d[i] = (2 * gprojt_uniform(&seed) - 1) / scale;
            f[0] = gprojt_true_loads(mesh, &loads);
            row[0] = gprojt_numbers(n), row[1] = gprojt_numbers(n);
            for (i = 1; i <= 2; ++i) {
                for (v = 0; v < n; ++v) mesh->position[v] = kept[v] + (i == 1 ? h : -h) * d[v];
                f[i] = gprojt_true_loads(mesh, &loads);
            }
            for (i = 0; i < 2; ++i) {
                for (v = 0; v < n; ++v) x[v] += (i ? h : 0) * d[v] * scale;
                for (v = 0, c = 0; v < mesh->vertex_count; ++v)
                    for (int k = 0; k < 3; ++k)
                        if (gprojt_inside_axes(form, v) >> k & 1)
                            row[i][3 * v + k] = gproj_system_row_value(gproj_form_system(form), group, c++, NULL);
            }
            for (v = 0; v < n; ++v) {
                if (!(gprojt_inside_axes(form, v / 3) >> (v % 3) & 1)) continue;
                GPROJT_NEAR(row[0][v], f[0][v], 1e-12);
                GPROJT_NEAR((row[1][v] - row[0][v]) / h, (f[1][v] - f[2][v]) / (2 * h), 2e-6);
            }
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
            free(w), free(point), free(kept), free(d), free(row[0]), free(row[1]);
            for (i = 0; i < 3; ++i) free(f[i]);
        }
    }
}

/* -- force density method: given forces, the positions solve a linear system -- */

/* Solves a z = b for 3 right-hand sides by elimination with pivots; a and b are destroyed, z comes in b. */
static bool gprojt_eliminate(int32_t n, double *a, double *b) {
    int32_t i, j, k;
    for (i = 0; i < n; ++i) {
        int32_t best = i;
        double swap;
        for (j = i + 1; j < n; ++j)
            if (fabs(a[j * n + i]) > fabs(a[best * n + i])) best = j;
        if (!(fabs(a[best * n + i]) > 1e-12)) return false;
        for (k = 0; k < n; ++k) swap = a[i * n + k], a[i * n + k] = a[best * n + k], a[best * n + k] = swap;
        for (k = 0; k < 3; ++k) swap = b[3 * i + k], b[3 * i + k] = b[3 * best + k], b[3 * best + k] = swap;
        for (j = 0; j < n; ++j) {
            double factor = a[j * n + i] / a[i * n + i];
            if (j == i || factor == 0) continue;
            for (k = i; k < n; ++k) a[j * n + k] -= factor * a[i * n + k];
            for (k = 0; k < 3; ++k) b[3 * j + k] -= factor * b[3 * i + k];
        }
    }
    for (i = 0; i < n; ++i)
        for (k = 0; k < 3; ++k) b[3 * i + k] /= a[i * n + i];
    return true;
}

/* Moves the vertices inside so that the densities w and the forces f are in equilibrium (Schek 1974). */
static bool gprojt_force_density_method(gproj_mesh *mesh, const double *w, const double *f) {
    int32_t n = mesh->vertex_count, h, k, v;
    double *a = gprojt_numbers(n * n), *b = gprojt_numbers(3 * n);
    bool solved;
    for (v = 0; v < n; ++v) {
        bool fixed = gproj_mesh_is_boundary_vertex(mesh, v);
        for (k = 0; k < 3; ++k) b[3 * v + k] = fixed ? mesh->position[3 * v + k] : -f[3 * v + k];
        if (fixed) a[v * n + v] = 1;
    }
    for (h = 0; h < mesh->halfedge_count; ++h) {
        v = mesh->origin[h];
        if (gproj_mesh_is_boundary_vertex(mesh, v)) continue;
        a[v * n + v] += w[h / 2];
        a[v * n + mesh->origin[h ^ 1]] -= w[h / 2];
    }
    solved = gprojt_eliminate(n, a, b);
    if (solved) memcpy(mesh->position, b, 3 * (size_t)n * sizeof *b);
    free(a), free(b);
    return solved;
}

/* Fixes the forces where they are: rows y - y0 = 0. */
static void gprojt_freeze_forces(gproj_form *form) {
    int32_t group = gprojt_add_group(gproj_form_system(form), "given forces", GPROJ_CONSTRAINT, 1), e;
    for (e = 0; e < gprojt_inside_mesh(form)->edge_count; ++e) {
        int32_t i = gprojt_inside_force(form, e);
        if (i >= 0)
            gprojt_add_linear(gproj_form_system(form), group, i, 1, -gproj_system_values(gproj_form_system(form))[i],
                              e);
    }
}

GPROJT_TEST(force_density_method) {
    int shape, way;
    for (shape = QUADS; shape <= HEXAGONS; ++shape) {
        for (way = 0; way < 2; ++way) { /* uniform compression under a weight; random tension under any forces */
            gproj_mesh *mesh = gprojt_vault(shape, 5, 10, 1), *other = gproj_mesh_copy(mesh, NULL, NULL);
            double *w = gprojt_numbers(mesh->edge_count), *f = gprojt_numbers(3 * mesh->vertex_count);
            gproj_loads loads = gprojt_no_loads();
            uint64_t seed = 8;
            gproj_form *form;
            gproj_result result;
            int32_t i;
            for (i = 0; i < mesh->edge_count; ++i) w[i] = way ? -(1 + gprojt_uniform(&seed)) : 3;
            for (i = 0; i < 3 * mesh->vertex_count; ++i)
                f[i] = way ? 2 * gprojt_uniform(&seed) - 1 : i % 3 == 2 ? -2 : 0;
            loads.point_load = f;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK);
            gprojt_freeze_forces(form);
            result = gproj_solve(form, 20, NULL);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
            GPROJT_REQUIRE(gprojt_force_density_method(other, w, f));
            GPROJT_CHECK(gprojt_largest_move(mesh->position, other->position, mesh->vertex_count) < 1e-10);
            gprojt_check_balance(form, &loads, 1e-11);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
            gproj_mesh_destroy(other);
            free(w), free(f);
        }
    }
}

/* -- shapes that stand and hang -- */

GPROJT_TEST(domes_stand_by_compression) {
    int shape, mix;
    for (shape = QUADS; shape <= HEXAGONS; ++shape) {
        for (mix = 0; mix < 4; ++mix) {
            gproj_mesh *mesh = gprojt_vault(shape, 7, 10, 2.5);
            gproj_loads loads = gprojt_no_loads();
            gproj_form *form;
            gproj_result result;
            double range[2];
            if (mix == 0 || mix == 3) loads.density = 2;
            if (mix == 1 || mix == 3) loads.area_load = 0.3;
            if (mix == 2 || mix == 3) loads.snow = 5;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            GPROJT_CHECK(gproj_add_compression(form, mesh->edge_count, NULL, 1) >= 0);
            result = gproj_solve(form, 30, NULL);
            if (result.outcome != GPROJ_CONVERGED) printf("    shape %d, loads %d: %s\n", shape, mix, result.message);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
            GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
            gprojt_check_balance(form, &loads, 1e-10);
            gprojt_range(form, range);
            GPROJT_CHECK(range[0] >= -1e-9 * range[1] && range[1] > 0);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
    }
}

GPROJT_TEST(nets_hang_by_tension) {
    int shape, flat;
    for (shape = QUADS; shape <= HEXAGONS; ++shape) {
        for (flat = 0; flat < 2; ++flat) {
            gproj_mesh *mesh = gprojt_vault(shape, 6, 10, flat ? 0 : -2);
            gproj_loads loads = gprojt_no_loads();
            gproj_form *form;
            gproj_result result;
            double range[2], lowest = 0;
            int32_t v;
            loads.density = 1;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            GPROJT_CHECK(gproj_add_tension(form, mesh->edge_count, NULL, 1) >= 0);
            result = gproj_solve(form, 40, NULL);
            if (result.outcome != GPROJ_CONVERGED) printf("    shape %d, flat %d: %s\n", shape, flat, result.message);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
            gprojt_check_balance(form, &loads, 1e-10);
            gprojt_range(form, range);
            for (v = 0; v < mesh->vertex_count; ++v) lowest = fmin(lowest, mesh->position[3 * v + 2]);
            GPROJT_CHECK(range[1] <= -1e-9 * range[0] && range[0] < 0 && lowest < -0.1);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
    }
}

/* -- bars whose forces are known -- */

/* `legs` pinned feet on a circle of radius r, the apex h above (it hangs where h < 0). */
static gproj_mesh *gprojt_tent(int32_t legs, double r, double h) {
    gprojt_soup s;
    int32_t i;
    memset(&s, 0, sizeof s);
    for (i = 0; i < legs; ++i)
        gprojt_add_vertex(&s, r * cos(6.283185307179586 * i / legs), r * sin(6.283185307179586 * i / legs), 0);
    gprojt_add_vertex(&s, 0, 0, h);
    for (i = 0; i < legs; ++i) gprojt_add_triangle(&s, i, (i + 1) % legs, legs);
    return gprojt_mesh_of(s);
}

/* Feet in a circle, a load on the apex: each leg has the density P / (legs h), and the force P / (legs sin). */
GPROJT_TEST(tents) {
    int32_t legs, e, k;
    for (legs = 3; legs < 8; ++legs) {
        for (k = 0; k < 2; ++k) {
            double h = k ? -2 : 1.5, r = 3, load = 12, f[27] = {0}, w[32], residual[9], reaction[27];
            double density = load / (legs * h), length = sqrt(r * r + h * h), close = legs == 3 ? 1e-9 : 5e-3;
            gproj_mesh *mesh = gprojt_tent(legs, r, h);
            gproj_loads loads = gprojt_no_loads();
            gproj_form *form;
            gproj_forces m;
            f[3 * legs + 2] = -load;
            loads.point_load = f;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            GPROJT_CHECK(gproj_find_forces(form, w, residual, NULL) == GPROJ_OK && residual[legs] < 1e-9);
            for (e = 0; e < mesh->edge_count; ++e) {
                bool leg = mesh->origin[2 * e] == legs || mesh->origin[2 * e + 1] == legs;
                GPROJT_NEAR(w[e], leg ? density : 0, legs == 3 ? 1e-9 : 1e-3); /* more legs: one of many solutions */
            }
            GPROJT_CHECK(gproj_get_forces(form, w, NULL) == GPROJ_OK && w[0] == 0);
            gprojt_add_group(gproj_form_system(form), "stay", GPROJ_CONSTRAINT, 1);
            gproj_add_fixed(form, 1, &legs, 1);
            GPROJT_CHECK(gproj_solve(form, 12, NULL).outcome == GPROJ_CONVERGED);
            gproj_get_reactions(form, reaction, NULL);
            GPROJT_NEAR(reaction[2], load / legs, close);
            GPROJT_NEAR(reaction[0], -load / legs / h * r, close); /* the thrust goes out, the support holds it in */
            m = gproj_measure_forces(form, NULL);
            GPROJT_CHECK(m.residual < 1e-11 && m.residual_vertex == legs);
            GPROJT_NEAR(m.min_density, density, close);
            GPROJT_NEAR(m.max_density, density, close);
            GPROJT_NEAR(m.max_force, density * length, close);
            GPROJT_NEAR(m.load_path, fabs(density) * length * length * legs, 9 * close);
            GPROJT_NEAR(m.total_load, load, 1e-9);
            GPROJT_NEAR(m.max_reaction, fabs(density) * length, close);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
    }
}

/* A tripod with any feet under any force: its three densities solve 3 equations, and nothing else does. */
GPROJT_TEST(tripods) {
    uint64_t seed = 4;
    int i, k, e;
    for (i = 0; i < 20; ++i) {
        gproj_mesh *mesh = gprojt_tent(3, 2, 2);
        double f[12] = {0}, w[6], a[9], b[9] = {0};
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        gprojt_shake(mesh, 0.7, 20 + (uint64_t)i);
        for (k = 0; k < 3; ++k) f[9 + k] = 2 * gprojt_uniform(&seed) - 1;
        loads.point_load = f;
        for (k = 0; k < 9; ++k) a[k] = mesh->position[9 + k / 3] - mesh->position[3 * (k % 3) + k / 3];
        for (k = 0; k < 3; ++k) b[3 * k] = -f[9 + k];
        GPROJT_REQUIRE(gprojt_eliminate(3, a, b));
        form = gprojt_pinned_form(mesh, NULL, &loads);
        GPROJT_CHECK(gproj_find_forces(form, w, NULL, NULL) == GPROJ_OK);
        for (e = 0; e < mesh->edge_count; ++e) {
            int32_t foot = mesh->origin[2 * e] + mesh->origin[2 * e + 1] - 3;
            if (mesh->origin[2 * e] == 3 || mesh->origin[2 * e + 1] == 3)
                GPROJT_NEAR(w[e], b[3 * foot], 1e-8 * (1 + fabs(b[3 * foot])));
        }
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- bounds of stresses, fairness of forces -- */

static void gprojt_stress_range(const gproj_form *form, const double *sections, double range[2]) {
    const gproj_mesh *mesh = gprojt_inside_mesh(form);
    double *w = gprojt_numbers(mesh->edge_count);
    int32_t e;
    gproj_get_forces(form, w, NULL);
    range[0] = HUGE_VAL, range[1] = -HUGE_VAL;
    for (e = 0; e < mesh->edge_count; ++e) {
        double stress = w[e] * gprojt_edge_length(mesh, e) / (sections ? sections[e] : 1);
        if (gprojt_inside_force(form, e) < 0) continue;
        range[0] = fmin(range[0], stress);
        range[1] = fmax(range[1], stress);
    }
    free(w);
}

GPROJT_TEST(stresses_stay_within_bounds) {
    int way;
    for (way = 0; way < 4; ++way) { /* above; both; both with sections; below only */
        gproj_mesh *mesh = gprojt_vault(way % 2 ? TRIANGLES : QUADS, 7, 10, 3);
        gproj_loads loads = gprojt_no_loads();
        double *sections = gprojt_numbers(mesh->edge_count), free_range[2], range[2], min, max,
               *kept = gprojt_keep(mesh);
        uint64_t seed = 3;
        gproj_form *form;
        gproj_result result;
        int32_t e;
        for (e = 0; e < mesh->edge_count; ++e) sections[e] = way == 2 ? 0.01 * (1 + 0.5 * gprojt_uniform(&seed)) : 1;
        loads.density = 25;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
        gprojt_stress_range(form, sections, free_range);
        gproj_form_destroy(form);
        gprojt_put_back(mesh, kept);
        form = gprojt_pinned_form(mesh, NULL, &loads);
        max = way == 3 ? INFINITY : 0.9 * free_range[1];
        min = way == 0   ? -INFINITY
              : way == 3 ? free_range[0] + 0.05 * (free_range[1] - free_range[0])
                         : free_range[0] * (free_range[0] < 0 ? 0.9 : 1.1);
        GPROJT_CHECK(gproj_add_stress_bounds(form, mesh->edge_count, NULL, way == 2 ? sections : NULL, min, max, 1) >=
                     0);
        result = gproj_solve(form, 60, NULL);
        gprojt_stress_range(form, sections, range);
        if (result.outcome != GPROJ_CONVERGED)
            printf("    %d: free %g to %g, within %g to %g: %s\n", way, free_range[0], free_range[1], min, max,
                   result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_CHECK(range[0] >= min - 1e-9 * free_range[1] && range[1] <= max + 1e-9 * free_range[1]);
        gprojt_check_balance(form, &loads, 1e-10);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(sections), free(kept);
    }
}

/* A bound of one edge is one row, and holds. */
GPROJT_TEST(stress_bounds_of_some_edges) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 6, 10, 3);
    gproj_loads loads = gprojt_no_loads();
    double *kept = gprojt_keep(mesh), *w = gprojt_numbers(mesh->edge_count), most = 0, section = 0.25;
    gproj_form *form;
    int32_t e, edge = -1, group;
    loads.density = 1;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    gproj_get_forces(form, w, NULL);
    for (e = 0; e < mesh->edge_count; ++e)
        if (w[e] * gprojt_edge_length(mesh, e) > most) most = w[e] * gprojt_edge_length(mesh, e), edge = e;
    gproj_form_destroy(form);
    gprojt_put_back(mesh, kept);
    form = gprojt_pinned_form(mesh, NULL, &loads);
    group = gproj_add_stress_bounds(form, 1, &edge, &section, -INFINITY, 0.9 * most / section, 1);
    GPROJT_CHECK(gproj_form_group_info(form, group).rows == 1);
    GPROJT_CHECK(gproj_solve(form, 60, NULL).outcome == GPROJ_CONVERGED);
    gproj_get_forces(form, w, NULL);
    GPROJT_CHECK(w[edge] * gprojt_edge_length(mesh, edge) <= 0.9 * most + 1e-9 * most);
    gprojt_check_balance(form, &loads, 1e-10);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(kept), free(w);
}

/* The root of the mean squared difference of forces in opposite edges of quads, over the root of their mean square. */
static double gprojt_force_spread(const gproj_form *form) {
    const gproj_mesh *mesh = gprojt_inside_mesh(form);
    double *w = gprojt_numbers(mesh->edge_count), differences = 0, squares = 0;
    int32_t h;
    gproj_get_forces(form, w, NULL);
    for (h = 0; h < mesh->halfedge_count; ++h) {
        int32_t opposite = mesh->next[mesh->next[h]];
        double a = w[h / 2] * gprojt_edge_length(mesh, h / 2);
        double b = w[opposite / 2] * gprojt_edge_length(mesh, opposite / 2);
        if (mesh->face[h] < 0 || gprojt_inside_force(form, h / 2) < 0 || gprojt_inside_force(form, opposite / 2) < 0)
            continue;
        differences += (a - b) * (a - b);
        squares += a * a;
    }
    free(w);
    return sqrt(differences / squares);
}

GPROJT_TEST(fair_forces) {
    double spread[2];
    int fair;
    for (fair = 0; fair < 2; ++fair) {
        gproj_mesh *mesh = gprojt_vault(QUADS, 8, 10, 3);
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        uint64_t seed = 2;
        double *w = gprojt_numbers(mesh->edge_count);
        int32_t e;
        loads.density = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        for (e = 0; e < mesh->edge_count; ++e) w[e] = 3 * (0.7 + 0.6 * gprojt_uniform(&seed));
        gproj_set_forces(form, w, NULL);
        if (fair) GPROJT_CHECK(gproj_add_force_fairness(form, 0.3) >= 0);
        GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
        gprojt_check_balance(form, &loads, 1e-10);
        spread[fair] = gprojt_force_spread(form);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(w);
    }
    if (!(spread[1] < 0.7 * spread[0])) printf("    spread %g, then %g\n", spread[0], spread[1]);
    GPROJT_CHECK(spread[1] < 0.7 * spread[0]);
}

/* -- rollers -- */

/* A support that no face has. */
GPROJT_TEST(supports_of_isolated_vertices) {
    static const double position[15] = {0, 0, 0, 1, 0, 0, 1, 1, 0.2, 0, 1, 0, 5, 5, 5};
    static const int32_t degree[1] = {4}, corner[4] = {0, 1, 2, 3}, pins[3] = {0, 1, 4};
    static const uint8_t slides[3] = {0, 0, 7};
    gproj_mesh *mesh = gproj_mesh_create(5, position, 1, degree, corner, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_loads loads;
    gproj_supports supports;
    GPROJT_REQUIRE(form);
    memset(&loads, 0, sizeof loads);
    loads.area_load = 1;
    supports.count = 3, supports.vertex = pins, supports.slides = slides;
    GPROJT_CHECK(gproj_add_equilibrium(form, &loads, &supports, 1) >= 0);
    GPROJT_CHECK(gproj_form_group_info(form, 0).rows == 6); /* of the free vertex and the two that slide nowhere */
    GPROJT_CHECK(gproj_system_check_gradients(gproj_form_system(form)) < 1e-7);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* A vault on walls along which its supports slide, and pinned at the corners: the edges along the walls are ties. */
GPROJT_TEST(rollers_take_nothing_along_their_slides) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 6, 10, 3);
    gprojt_list walls = gprojt_boundary(mesh);
    uint8_t *slides = (uint8_t *)calloc((size_t)walls.count, 1);
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_supports supports = gprojt_pins(walls);
    double *w = gprojt_numbers(mesh->edge_count), *sum, *f, *r = gprojt_numbers(3 * mesh->vertex_count), worst = 0;
    gproj_result result;
    int32_t i, k, ties = 0;
    GPROJT_REQUIRE(slides);
    for (i = 0; i < walls.count; ++i) {
        const double *p = mesh->position + 3 * walls.item[i];
        slides[i] = gproj_form_is_corner(form, walls.item[i]) ? 0 : fabs(p[0]) > fabs(p[1]) ? 2 : 1;
    }
    supports.slides = slides;
    loads.density = 1;
    GPROJT_CHECK(gproj_add_equilibrium(form, &loads, &supports, 1) >= 0);
    gproj_add_gliding_boundary(form, 1);
    result = gproj_solve(form, 40, NULL);
    if (result.outcome != GPROJ_CONVERGED) printf("    %s\n", result.message);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    gproj_get_forces(form, w, NULL);
    gproj_get_reactions(form, r, NULL);
    f = gprojt_true_loads(mesh, &loads);
    sum = gprojt_sums(mesh, w, f);
    for (i = 0; i < walls.count; ++i)
        for (k = 0; k < 3; ++k)
            if (slides[i] >> k & 1) worst = fmax(worst, fabs(sum[3 * walls.item[i] + k]));
    for (i = 0; i < mesh->vertex_count; ++i)
        for (k = 0; k < 3; ++k) {
            bool inside = !gprojt_listed(walls.item, walls.count, i);
            if (inside) worst = fmax(worst, fabs(sum[3 * i + k]));
            GPROJT_NEAR(r[3 * i + k], -sum[3 * i + k], 1e-9);
        }
    for (i = 0; i < walls.count; ++i)
        if (slides[i]) GPROJT_CHECK(r[3 * walls.item[i] + slides[i] - 1] == 0);
    GPROJT_CHECK(worst < 1e-10);
    for (i = 0; i < mesh->edge_count; ++i) ties += w[i] != 0 && (mesh->face[2 * i] < 0 || mesh->face[2 * i + 1] < 0);
    GPROJT_CHECK(ties > 4 && gproj_measure_forces(form, NULL).residual < 1e-10);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(walls.item), free(slides), free(w), free(sum), free(f), free(r);
}

/* -- units and places -- */

/* The shape that a dome finds when it is given in other units, turned about z and elsewhere; back in the first ones. */
static void gprojt_solve_moved(double length, double force, double turn, double shift, double epsilon, double *out) {
    gproj_mesh *mesh = gprojt_hill(HYBRID, 6, 10, 2.5);
    gproj_loads loads = gprojt_no_loads();
    double c = cos(turn), s = sin(turn);
    gproj_form *form;
    gproj_solve_options options;
    gproj_result result;
    int32_t v, k;
    loads.density = 2 * force / length, loads.snow = 0.5 * force / (length * length);
    loads.area_load = 0.2 * force / (length * length);
    for (v = 0; v < mesh->vertex_count; ++v) {
        double *p = mesh->position + 3 * v, x = p[0];
        p[0] = c * x - s * p[1];
        p[1] = s * x + c * p[1];
        for (k = 0; k < 3; ++k) p[k] = length * (p[k] + shift);
    }
    form = gprojt_pinned_form(mesh, NULL, &loads);
    gproj_add_compression(form, mesh->edge_count, NULL, 1);
    gproj_add_stress_bounds(form, mesh->edge_count, NULL, NULL, -INFINITY, 60 * force, 1);
    gproj_add_planarity(form, 1);
    memset(&options, 0, sizeof options);
    options.epsilon = epsilon;
    result = gproj_solve(form, 30, &options);
    if (result.outcome != GPROJ_CONVERGED) printf("    %g %g %g %g: %s\n", length, force, turn, shift, result.message);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
    gprojt_check_balance(form, &loads, 1e-9);
    for (v = 0; v < mesh->vertex_count; ++v) {
        double *p = mesh->position + 3 * v, x;
        for (k = 0; k < 3; ++k) p[k] = p[k] / length - shift;
        x = p[0];
        out[3 * v] = c * x + s * p[1];
        out[3 * v + 1] = c * p[1] - s * x;
        out[3 * v + 2] = p[2];
    }
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(units_do_not_matter) {
    static const double way[6][4] = {{1, 1e3, 0, 0},      {1e3, 1, 0, 0}, {1e-6, 1e7, 0, 0},
                                     {1e3, 1e-3, 0.7, 3}, {1, 1, 2, 0},   {1, 1, 0, 100}};
    double first[3 * 64], other[3 * 64];
    int i;
    for (i = 0; i < 6; ++i) {
        double off, epsilon = way[i][2] != 0 ? 1e-3 : 0; /* by default it depends on the largest coordinate of rows */
        gprojt_solve_moved(1, 1, 0, 0, epsilon, first);
        gprojt_solve_moved(way[i][0], way[i][1], way[i][2], way[i][3], epsilon, other);
        off = gprojt_largest_move(first, other, 56);
        if (!(off < 1e-8)) printf("    %d: off by %g\n", i, off);
        GPROJT_CHECK(off < 1e-8);
    }
}

/* -- the best forces of a given shape -- */

/* The gradient of the sum of squares for the density of each edge is 0, or points out of the allowed. */
static void gprojt_check_optimal(gproj_form *form, const gproj_loads *loads, int sign) {
    const gproj_mesh *mesh = gprojt_inside_mesh(form);
    double *w = gprojt_numbers(mesh->edge_count), *residual = gprojt_numbers(mesh->vertex_count), *sum, *f, mean = 0;
    double size = 0;
    gprojt_list pins = gprojt_boundary(mesh);
    int32_t v, e, k;
    GPROJT_CHECK(gproj_find_forces(form, w, residual, NULL) == GPROJ_OK);
    f = gprojt_true_loads(mesh, loads);
    sum = gprojt_sums(mesh, w, f);
    for (v = 0; v < mesh->vertex_count; ++v) {
        static const double zero[3] = {0, 0, 0};
        if (gprojt_listed(pins.item, pins.count, v))
            memset(sum + 3 * v, 0, 3 * sizeof *sum);
        else
            mean += gprojt_far(f + 3 * v, zero) / (mesh->vertex_count - pins.count);
    }
    for (v = 0; v < mesh->vertex_count; ++v)
        GPROJT_NEAR(residual[v] * mean, sqrt(gprojt_dot3(sum + 3 * v, sum + 3 * v)), 1e-9 * mean);
    for (e = 0; e < mesh->edge_count; ++e) size = fmax(size, mean * gprojt_edge_length(mesh, e));
    for (e = 0; e < mesh->edge_count; ++e) {
        int32_t i = mesh->origin[2 * e], j = mesh->origin[2 * e + 1];
        double g = 0;
        bool carries = !gprojt_listed(pins.item, pins.count, i) || !gprojt_listed(pins.item, pins.count, j);
        for (k = 0; k < 3; ++k)
            g += (sum[3 * i + k] - sum[3 * j + k]) * (mesh->position[3 * i + k] - mesh->position[3 * j + k]);
        if (!carries) GPROJT_CHECK(w[e] == 0);
        GPROJT_CHECK(sign * w[e] >= 0);
        if (w[e] == 0)
            GPROJT_CHECK(!carries || sign * g >= -1e-8 * size);
        else
            GPROJT_NEAR(g, 0, 1e-8 * size);
    }
    free(w), free(residual), free(sum), free(f), free(pins.item);
}

GPROJT_TEST(best_forces) {
    int shape, sign;
    for (shape = QUADS; shape <= HEXAGONS; ++shape) {
        for (sign = -1; sign <= 1; ++sign) {
            gproj_mesh *mesh = gprojt_vault(shape, 7, 10, sign < 0 ? -3 : 3);
            double *kept;
            gproj_loads loads = gprojt_no_loads();
            gproj_form *form;
            gprojt_shake(mesh, 0.2, 3);
            kept = gprojt_keep(mesh);
            loads.density = 1, loads.snow = 0.2;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            if (sign > 0) gproj_add_compression(form, mesh->edge_count, NULL, 1);
            if (sign < 0) gproj_add_tension(form, mesh->edge_count, NULL, 1);
            gprojt_check_optimal(form, &loads, sign);
            GPROJT_CHECK(gprojt_unmoved(mesh, kept));
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
            free(kept);
        }
    }
}

/* A bound without weight does not count, and one of some edges only for these; a bound of one's own is another matter. */
GPROJT_TEST(best_forces_within_active_bounds) {
    gproj_mesh *mesh = gprojt_vault(TRIANGLES, 4, 10, 3);
    gproj_loads loads = gprojt_no_loads();
    double *w = gprojt_numbers(mesh->edge_count), none = 0;
    int32_t e, group, own, least = -1;
    gproj_form *form;
    gproj_schedule schedule = gproj_keep(0);
    gprojt_shake(mesh, 0.5, 3);
    loads.density = 1;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    own = gprojt_add_group(gproj_form_system(form), "compression", GPROJ_BOUND, 1);
    gprojt_add_linear(gproj_form_system(form), own, 0, 1, 100, 1000000);
    GPROJT_CHECK(gproj_find_forces(form, w, NULL, NULL) == GPROJ_OK);
    for (e = 0; e < mesh->edge_count; ++e)
        if (least < 0 || w[e] < w[least]) least = e;
    GPROJT_REQUIRE(w[least] < -0.1);
    group = gproj_add_compression(form, 1, &least, 1);
    GPROJT_CHECK(group >= 0 && gproj_find_forces(form, w, NULL, NULL) == GPROJ_OK && w[least] >= 0);
    gproj_set_element_weights(form, group, 1, &least, &none);
    GPROJT_CHECK(gproj_find_forces(form, w, NULL, NULL) == GPROJ_OK && w[least] < -0.1);
    none = 1;
    gproj_set_element_weights(form, group, 1, &least, &none);
    GPROJT_CHECK(gproj_find_forces(form, w, NULL, NULL) == GPROJ_OK && w[least] >= 0);
    gproj_set_schedule(form, group, schedule);
    GPROJT_CHECK(gproj_find_forces(form, w, NULL, NULL) == GPROJ_OK && w[least] < -0.1);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(w);
}

/* A row w >= 0 of the caller's bounds the force in its edge, however it is written; rows that say something else, or of
   no edge, do not. */
GPROJT_TEST(bounds_of_ones_own_on_forces) {
    gproj_mesh *mesh = gprojt_vault(TRIANGLES, 4, 10, 3);
    gproj_loads loads = gprojt_no_loads();
    double *w = gprojt_numbers(mesh->edge_count), *kept = gprojt_numbers(mesh->edge_count);
    int32_t e, least = -1, pinned = 0, other = 0, way;
    gprojt_shake(mesh, 0.5, 3);
    loads.density = 1;
    for (way = 0; way < 9; ++way) {
        gproj_form *form = gprojt_pinned_form(mesh, NULL, &loads);
        gproj_system *s = gproj_form_system(form);
        gproj_term term[2];
        gproj_group group;
        double constant = way == 5 ? 0.5 : 0;
        if (way == 0) {
            GPROJT_CHECK(gproj_find_forces(form, kept, NULL, NULL) == GPROJ_OK);
            for (e = 0; e < mesh->edge_count; ++e)
                if (least < 0 || kept[e] < kept[least]) least = e;
            while (gproj_force_variable(form, pinned) >= 0) ++pinned;
            while (other == least || gproj_force_variable(form, other) < 0) ++other;
            GPROJT_REQUIRE(kept[least] < -0.1);
        }
        memset(&group, 0, sizeof group);
        group.name = "own", group.kind = GPROJ_BOUND, group.place = GPROJ_PLACE_EDGE, group.schedule = gproj_keep(1);
        term[0] = gprojt_term(gproj_force_variable(form, least), -1, way == 8 ? 7 : 1);
        term[1] = gprojt_term(gproj_force_variable(form, least), -1, 1);
        if (way == 1) term[0].j = term[0].i;                         /* w^2 >= 0 */
        if (way == 2) term[0].i = 0;                                 /* x >= 0 */
        if (way == 3) term[1].i = 0;                                 /* w + x >= 0 */
        if (way == 4) term[0].i = gproj_force_variable(form, other); /* of another edge */
        gproj_system_add_row(s, gproj_system_add_group(s, &group), way == 3 ? 2 : 1, term, constant,
                             way == 6   ? -1
                             : way == 7 ? pinned
                             : way == 0 ? mesh->edge_count
                                        : least);
        GPROJT_CHECK(gproj_find_forces(form, w, NULL, NULL) == GPROJ_OK);
        if (way == 8) GPROJT_CHECK(w[least] > -1e-9);
        if (way < 8) GPROJT_CHECK(!memcmp(w, kept, (size_t)mesh->edge_count * sizeof *w));
        gproj_form_destroy(form);
    }
    gproj_mesh_destroy(mesh);
    free(w), free(kept);
}

/* Without loads nothing is out of balance, and no force is better than none. */
GPROJT_TEST(no_loads_no_forces) {
    gproj_mesh *mesh = gprojt_vault(TRIANGLES, 4, 10, 3);
    gproj_loads loads = gprojt_no_loads();
    double *w = gprojt_numbers(mesh->edge_count), *d = gprojt_numbers(3 * mesh->vertex_count);
    gproj_form *form = gprojt_pinned_form(mesh, NULL, &loads);
    int32_t i;
    gproj_add_compression(form, 0, NULL, 1);
    for (i = 0; i < mesh->edge_count; ++i) w[i] = 1;
    for (i = 0; i < 3 * mesh->vertex_count; ++i) d[i] = 1;
    GPROJT_CHECK(gproj_find_forces(form, w, NULL, NULL) == GPROJ_OK && gproj_find_imbalance(form, d, NULL) == GPROJ_OK);
    for (i = 0; i < mesh->edge_count; ++i) GPROJT_CHECK(w[i] == 0);
    for (i = 0; i < 3 * mesh->vertex_count; ++i) GPROJT_CHECK(d[i] == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(w), free(d);
}

/* What the force density method finds carries its loads without rest; a flat plate carries nothing. */
GPROJT_TEST(funicular_shapes_and_plates) {
    int shape, flat;
    for (shape = QUADS; shape <= HEXAGONS; ++shape) {
        for (flat = 0; flat < 2; ++flat) {
            gproj_mesh *mesh = gprojt_vault(shape, 6, 10, 0);
            double *w = gprojt_numbers(mesh->edge_count), *f = gprojt_numbers(3 * mesh->vertex_count);
            double *residual = gprojt_numbers(mesh->vertex_count);
            gproj_loads loads = gprojt_no_loads();
            gproj_form *form;
            int32_t i;
            for (i = 0; i < mesh->edge_count; ++i) w[i] = 2;
            for (i = 0; i < mesh->vertex_count; ++i) f[3 * i + 2] = -1;
            if (!flat) GPROJT_REQUIRE(gprojt_force_density_method(mesh, w, f));
            loads.point_load = f;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            gproj_add_compression(form, mesh->edge_count, NULL, 1);
            GPROJT_CHECK(gproj_find_forces(form, w, residual, NULL) == GPROJ_OK);
            for (i = 0; i < mesh->vertex_count; ++i) {
                bool carried = !flat || gproj_mesh_is_boundary_vertex(mesh, i);
                GPROJT_NEAR(residual[i], carried ? 0 : 1, 1e-7);
            }
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
            free(w), free(f), free(residual);
        }
    }
}

/* The verdict names the three vertices whose forces are off most, in a coordinate, the worst last, and by how much. */
static void gprojt_check_unbalanced(const gproj_mesh *mesh, const gproj_result *result, const double *sum,
                                    gprojt_list pins, double unbalance) {
    const char *piece = strstr(result->message, "was found near this shape: vertices ");
    double off[3] = {0, 0, 0}, told = -1;
    int vertex[3] = {-1, -1, -1};
    int32_t v, k;
    GPROJT_REQUIRE(piece != NULL);
    GPROJT_CHECK(
        sscanf(piece, "was found near this shape: vertices %d, %d, %d out of balance by up to %lf of the largest load",
               &vertex[0], &vertex[1], &vertex[2], &told) == 4);
    GPROJT_NEAR(told, unbalance, 3e-3 * unbalance);
    for (k = 0; k < 3; ++k) {
        GPROJT_REQUIRE(vertex[k] >= 0 && vertex[k] < mesh->vertex_count && vertex[k] != vertex[(k + 1) % 3]);
        GPROJT_CHECK(!gprojt_listed(pins.item, pins.count, vertex[k]));
        for (v = 3 * vertex[k]; v < 3 * vertex[k] + 3; ++v) off[k] = fmax(off[k], fabs(sum[v]));
    }
    GPROJT_CHECK(off[0] <= off[1] * (1 + 1e-9) && off[1] <= off[2] * (1 + 1e-9));
    for (v = 0; v < 3 * mesh->vertex_count; ++v)
        if (!gprojt_listed(pins.item, pins.count, v / 3) && v / 3 != vertex[1] && v / 3 != vertex[2])
            GPROJT_CHECK(fabs(sum[v]) <= off[0] * (1 + 1e-9));
}

/* Vertex 0 may be the one that is off most. */
GPROJT_TEST(vertex_0_is_out_of_balance) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 3, 3, 0);
    double *load = gprojt_numbers(3 * mesh->vertex_count), told = 0;
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_loads loads = gprojt_no_loads();
    gproj_supports supports;
    gproj_result result;
    const char *piece;
    int32_t v, vertex[3] = {-1, -1, -1}, last = mesh->vertex_count - 1;
    for (v = 0; v <= last; ++v) load[3 * v + 2] = v == 0 ? -5 : -1 - 0.1 * v;
    memset(&supports, 0, sizeof supports);
    supports.count = 1, supports.vertex = &last;
    loads.point_load = load;
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_fixed(form, 0, NULL, 1);
    result = gproj_solve(form, 5, NULL);
    piece = strstr(result.message, "this shape: vertices ");
    GPROJT_CHECK(piece && sscanf(piece, "this shape: vertices %d, %d, %d out of balance by up to %lf of", &vertex[0],
                                 &vertex[1], &vertex[2], &told) == 4);
    GPROJT_CHECK(vertex[2] == 0 && vertex[1] == last - 1 && vertex[0] == last - 2 && told > 0.9);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(load);
}

GPROJT_TEST(plates_are_infeasible) {
    int shape;
    for (shape = QUADS; shape <= HEXAGONS; ++shape) {
        gproj_mesh *mesh = gprojt_vault(shape, 5, 10, 0);
        double *kept = gprojt_keep(mesh), *w = gprojt_numbers(mesh->edge_count), *f, *sum, unbalance, residual = 0;
        gprojt_list pins = gprojt_boundary(mesh);
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        gproj_result result;
        int32_t v, all[128];
        GPROJT_REQUIRE(mesh->vertex_count <= 128);
        loads.density = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        for (v = 0; v < mesh->vertex_count; ++v) all[v] = v;
        gproj_add_fixed(form, mesh->vertex_count, all, 1);
        result = gproj_solve(form, 30, NULL);
        gproj_get_forces(form, w, NULL);
        f = gprojt_true_loads(mesh, &loads);
        unbalance = gprojt_unbalance(mesh, w, f, pins.item, pins.count);
        /* the residual, from outside: how far a coordinate is off, or a force, in the form's units */
        sum = gprojt_sums(mesh, w, f);
        for (v = 0; v < 3 * mesh->vertex_count; ++v) {
            residual = fmax(residual, fabs(mesh->position[v] - kept[v]) / gprojt_unit(form));
            if (!gprojt_listed(pins.item, pins.count, v / 3))
                residual = fmax(residual, fabs(sum[v]) * gprojt_inside_load_scale(form));
        }
        GPROJT_CHECK(result.outcome != GPROJ_CONVERGED && result.outcome != GPROJ_FAILED && result.residual > 1e-3);
        GPROJT_NEAR(result.residual, residual, 1e-6 * residual);
        gprojt_check_unbalanced(mesh, &result, sum, pins, unbalance);
        GPROJT_NEAR(gproj_measure_forces(form, NULL).residual, unbalance, 1e-9 + 1e-9 * unbalance);
        GPROJT_CHECK(unbalance > 1e-6 && gprojt_all_finite(mesh->position, 3 * mesh->vertex_count));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(kept), free(w), free(f), free(sum), free(pins.item);
    }
}

/* -- the start of forces -- */

/* Forces beyond all numbers are refused by the edge's name, and nothing is written. */
GPROJT_TEST(forces_beyond_all_numbers) {
    gproj_mesh *mesh = gprojt_vault(TRIANGLES, 3, 3, 1);
    double *w = gprojt_numbers(mesh->edge_count), *residuals = gprojt_numbers(mesh->vertex_count);
    double *load = gprojt_numbers(3 * mesh->vertex_count);
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form;
    gproj_forces forces;
    gproj_result result;
    gproj_error error;
    int32_t e, v, carrying = -1;
    loads.density = 1;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    for (e = 0; e < mesh->edge_count; ++e)
        if (gprojt_inside_force(form, e) >= 0) carrying = e;
    for (e = 0; e < mesh->edge_count; ++e) w[e] = 1e308;
    GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK);
    gproj_system_values(gproj_form_system(form))[gproj_force_variable(form, carrying)] = 1e3;
    for (e = 0; e < mesh->edge_count; ++e) w[e] = -1;
    GPROJT_CHECK(gproj_get_forces(form, w, &error) == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.place == GPROJ_PLACE_EDGE && error.index == carrying);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_CHECK(w[e] == -1);
    for (v = 0; v < 3 * mesh->vertex_count; ++v) load[v] = -1;
    GPROJT_CHECK(gproj_get_reactions(form, load, &error) == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.place == GPROJ_PLACE_VERTEX && error.index >= 0);
    for (v = 0; v < 3 * mesh->vertex_count; ++v) GPROJT_CHECK(load[v] == 0);
    forces = gproj_measure_forces(form, &error);
    GPROJT_CHECK(error.code == GPROJ_ERROR_NUMBER && forces.residual_vertex == -1 && forces.max_force == 0);
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
    gproj_form_destroy(form);

    /* a verdict goes without what no number can tell */
    form = gprojt_pinned_form(mesh, NULL, &loads);
    for (e = 0; e < mesh->edge_count; ++e) w[e] = 1e308;
    GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK);
    result = gproj_solve(form, 0, NULL);
    GPROJT_CHECK(strstr(result.message, "out of balance") && !strstr(result.message, "of the largest load"));
    gproj_form_destroy(form);
    for (e = 0; e < mesh->edge_count; ++e) w[e] = -1;

    /* large loads on edges of next to no length */
    for (v = 0; v < 3 * mesh->vertex_count; ++v) mesh->position[v] *= 1e-200, load[v] = v % 3 == 2 ? -1e150 : 0;
    for (v = 0; v < mesh->vertex_count; ++v) residuals[v] = -1;
    loads.density = 0, loads.point_load = load;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    for (e = 0; gprojt_inside_force(form, e) < 0;) ++e;
    GPROJT_CHECK(gproj_find_forces(form, w, residuals, &error) == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.place == GPROJ_PLACE_EDGE && error.index == e && w[0] == -1 && residuals[0] == -1);
    GPROJT_CHECK(gproj_find_forces(form, NULL, residuals, NULL) == GPROJ_OK && residuals[0] >= 0);
    gproj_form_destroy(form);
    free(w), free(residuals), free(load);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(forces_are_kept_and_set) {
    gproj_mesh *mesh = gprojt_vault(TRIANGLES, 6, 10, 3);
    double *w = gprojt_numbers(mesh->edge_count), *again = gprojt_numbers(mesh->edge_count);
    double *kept = gprojt_keep(mesh), *solved, size = 0;
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form;
    gproj_result result;
    uint64_t seed = 3;
    int32_t e;
    loads.density = 1;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    gproj_add_compression(form, mesh->edge_count, NULL, 1);
    GPROJT_CHECK(gproj_get_forces(form, w, NULL) == GPROJ_OK);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_CHECK(w[e] == 0);
    for (e = 0; e < mesh->edge_count; ++e) w[e] = gprojt_inside_force(form, e) < 0 ? 0 : 1e3 * gprojt_uniform(&seed);
    GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK && gproj_get_forces(form, again, NULL) == GPROJ_OK);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_NEAR(again[e], w[e], 1e-12 * 1e3);
    GPROJT_CHECK(gproj_set_forces(form, NULL, NULL) == GPROJ_OK && gproj_get_forces(form, again, NULL) == GPROJ_OK);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_CHECK(again[e] == 0);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    solved = gprojt_keep(mesh);
    gproj_get_forces(form, w, NULL);
    for (e = 0; e < mesh->edge_count; ++e) size = fmax(size, fabs(w[e]));

    /* a second solve goes on from there: nothing is left to do */
    result = gproj_solve(form, 30, NULL);
    gproj_get_forces(form, again, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 1);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_NEAR(again[e], w[e], 1e-10 * size);
    GPROJT_CHECK(gprojt_largest_move(mesh->position, solved, mesh->vertex_count) < 1e-9);

    /* the forces that were found, given to another form of the solved mesh: nothing is left to do either */
    gproj_form_destroy(form);
    form = gprojt_pinned_form(mesh, NULL, &loads);
    gproj_add_compression(form, mesh->edge_count, NULL, 1);
    gproj_set_forces(form, w, NULL);
    result = gproj_solve(form, 30, NULL);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.iterations <= 1);
    gproj_form_destroy(form);

    /* NULL and the first positions: all again */
    gprojt_put_back(mesh, kept);
    form = gprojt_pinned_form(mesh, NULL, &loads);
    gproj_add_compression(form, mesh->edge_count, NULL, 1);
    gproj_solve(form, 30, NULL);
    gprojt_put_back(mesh, kept);
    gproj_set_forces(form, NULL, NULL);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_largest_move(mesh->position, solved, mesh->vertex_count) < 1e-9);
    gproj_get_forces(form, again, NULL);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_NEAR(again[e], w[e], 1e-8 * size);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(w), free(again), free(kept), free(solved);
}

/* The variables of forces, for rows of the caller's: with the form's units they are the densities; pinned edges have none. */
GPROJT_TEST(forces_are_variables) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 4, 10, 3);
    gproj_loads loads = gprojt_no_loads();
    double *w = gprojt_numbers(mesh->edge_count), unit = 0;
    gproj_form *form;
    int32_t e, with = 0;
    GPROJT_CHECK(gproj_force_variable(NULL, 0) == -1);
    form = gproj_form_create(mesh, NULL);
    GPROJT_CHECK(gproj_force_variable(form, 0) == -1); /* no forces yet */
    gproj_form_destroy(form);
    loads.density = 1;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    gproj_solve(form, 10, NULL);
    GPROJT_CHECK(gproj_get_forces(form, w, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_force_variable(form, -1) == -1 && gproj_force_variable(form, mesh->edge_count) == -1);
    for (e = 0; e < mesh->edge_count; ++e) {
        int32_t variable = gproj_force_variable(form, e);
        bool pinned = gproj_mesh_is_boundary_vertex(mesh, mesh->origin[2 * e]) &&
                      gproj_mesh_is_boundary_vertex(mesh, mesh->origin[2 * e + 1]);
        GPROJT_CHECK((variable >= 0) == !pinned);
        if (variable < 0) continue;
        if (with++ == 0) unit = w[e] / gproj_system_values(gproj_form_system(form))[variable];
        GPROJT_NEAR(w[e], unit * gproj_system_values(gproj_form_system(form))[variable], 1e-12 * fabs(w[e]));
    }
    GPROJT_CHECK(with > 10);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(w);
}

/* Of two parts without supports the verdict names the first, by the first vertex. */
GPROJT_TEST(parts_without_support_are_named) {
    gprojt_soup soup;
    gproj_mesh *mesh;
    gproj_form *form;
    gproj_supports supports;
    gproj_loads loads = gprojt_no_loads();
    double load[36];
    int32_t part, k, pin = 8;
    memset(&soup, 0, sizeof soup);
    memset(&supports, 0, sizeof supports);
    for (part = 0; part < 3; ++part) {
        int32_t face[4];
        for (k = 0; k < 4; ++k) {
            gprojt_add_vertex(&soup, 3 * part + (k == 1 || k == 2), k > 1, 0);
            face[k] = 4 * part + k;
        }
        gprojt_add_face(&soup, 4, face);
    }
    mesh = gprojt_mesh_of(soup);
    loads.density = 1, supports.count = 1, supports.vertex = &pin;
    form = gproj_form_create(mesh, NULL);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_fixed_boundary(form, 1);
    GPROJT_CHECK(strstr(gproj_solve(form, 10, NULL).message, "the part of the mesh with vertex 0 has no support"));
    gproj_form_destroy(form);
    /* A part without loads, or with loads that balance, needs none: the third one is named. */
    memset(load, 0, sizeof load);
    load[3 * 4] = 1, load[3 * 5] = -1, load[3 * 11] = 1;
    loads.density = 0, loads.point_load = load, supports.count = 0;
    form = gproj_form_create(mesh, NULL);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_fixed_boundary(form, 1);
    GPROJT_CHECK(strstr(gproj_solve(form, 10, NULL).message, "the part of the mesh with vertex 8 has no support"));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    /* The vertex from which the first half-edge goes belongs to its part, too, here without a boundary. */
    mesh = gprojt_mesh_of(gprojt_cube_sphere(1));
    pin = mesh->origin[0];
    GPROJT_CHECK(mesh->vertex_halfedge[pin] == 0);
    memset(load, 0, sizeof load);
    load[3 * pin + 2] = -1;
    for (supports.count = 0; supports.count < 2; ++supports.count) {
        gproj_result result;
        form = gproj_form_create(mesh, NULL);
        gproj_add_equilibrium(form, &loads, &supports, 1);
        result = gproj_solve(form, 10, NULL);
        GPROJT_CHECK((strstr(result.message, "has no support") != NULL) == (supports.count == 0));
        gproj_form_destroy(form);
    }
    gproj_mesh_destroy(mesh);
}

/* Forces that were set, no others, measured term by term; the octahedron's first vertex is a support that has the first
   half-edge, as any other may have. */
GPROJT_TEST(forces_measured_one_by_one) {
    static const double corner[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const int32_t face[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    static const int32_t pins[3] = {0, 1, 5};
    gprojt_soup soup;
    gproj_mesh *mesh;
    gproj_form *form;
    gproj_forces m;
    gproj_supports supports = {3, pins, NULL};
    gproj_loads loads = gprojt_no_loads();
    double w[12], load[18], sum[18], reaction[18], path = 0, most = 0, largest = 0, force[2] = {HUGE_VAL, -HUGE_VAL};
    double density[2] = {HUGE_VAL, -HUGE_VAL}, held = 0, down = 0;
    int32_t k, c, e, worst = -1;
    memset(&soup, 0, sizeof soup);
    for (k = 0; k < 6; ++k) gprojt_add_vertex(&soup, corner[k][0], 1.5 * corner[k][1], 2 * corner[k][2]);
    for (k = 0; k < 8; ++k) gprojt_add_face(&soup, 3, face[k]);
    mesh = gprojt_mesh_of(soup);
    for (k = 0; k < 18; ++k) load[k] = (k % 3 == 0 ? 3 + k : 0.01 * k) / 64; /* all below 1, mostly along x */
    loads.point_load = load;
    form = gproj_form_create(mesh, NULL);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    for (e = 0; e < 12; ++e) w[e] = gprojt_inside_force(form, e) < 0 ? 0 : (2 + 0.25 * (5 * e % 12)) / 64;
    GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK && gproj_get_reactions(form, reaction, NULL) == GPROJ_OK);
    memcpy(sum, load, sizeof sum);
    for (e = 0; e < 12; ++e) {
        int32_t i = mesh->origin[2 * e], j = mesh->origin[2 * e + 1];
        double length = gprojt_far(mesh->position + 3 * i, mesh->position + 3 * j);
        for (c = 0; c < 3; ++c) {
            double part = w[e] * (mesh->position[3 * i + c] - mesh->position[3 * j + c]);
            sum[3 * i + c] += part, sum[3 * j + c] -= part;
        }
        path += w[e] * length * length;
        if (w[e] == 0) continue; /* between two pins */
        density[0] = fmin(density[0], w[e]), density[1] = fmax(density[1], w[e]);
        force[0] = fmin(force[0], w[e] * length), force[1] = fmax(force[1], w[e] * length);
    }
    for (k = 0; k < 6; ++k) {
        bool pinned = k < 2 || k == 5;
        for (c = 0; c < 3; ++c) GPROJT_NEAR(reaction[3 * k + c], pinned ? -sum[3 * k + c] : 0, 1e-12);
        if (pinned) held = fmax(held, gprojt_length3(sum + 3 * k));
        if (!pinned && gprojt_length3(sum + 3 * k) > most) most = gprojt_length3(sum + 3 * k), worst = k;
        largest = fmax(largest, gprojt_length3(load + 3 * k)); /* of all loads */
        down -= load[3 * k + 2];
    }
    m = gproj_measure_forces(form, NULL);
    GPROJT_NEAR(m.min_density, density[0], 1e-12);
    GPROJT_NEAR(m.max_density, density[1], 1e-12);
    GPROJT_NEAR(m.min_force, force[0], 1e-12);
    GPROJT_NEAR(m.max_force, force[1], 1e-12);
    GPROJT_NEAR(m.load_path, path, 1e-11);
    GPROJT_NEAR(m.residual, most / largest, 1e-12);
    GPROJT_NEAR(m.total_load, down, 1e-12);
    GPROJT_NEAR(m.max_reaction, held, 1e-12);
    GPROJT_CHECK(m.residual_vertex == worst);
    gproj_form_destroy(form);
    /* Nothing to balance: the first vertex without support stands for all. */
    loads.point_load = NULL;
    form = gproj_form_create(mesh, NULL);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    m = gproj_measure_forces(form, NULL);
    GPROJT_CHECK(m.residual == 0 && m.residual_vertex == 2 && m.max_reaction == 0 && m.total_load == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* The weight of the group that draws forces to their start in iteration n: 0.3^n alone, up to the fifth; beside
   wishes 0.3 as long as they guide; none where the shape carries its loads. */
GPROJT_TEST(guidance_of_forces_fades) {
    int kind;
    for (kind = 0; kind < 3; ++kind) {
        gproj_mesh *mesh = gprojt_vault(QUADS, 5, 10, kind == 2 ? 3 : 0);
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        int32_t n, group;
        loads.area_load = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        if (kind == 1) gproj_add_fairness(form, 0.01);
        GPROJT_REQUIRE(gproj_solve_begin(form, 18, NULL, NULL));
        for (group = 0; group < gproj_system_group_count(gproj_form_system(form)); ++group)
            if (!strcmp(gproj_form_group_info(form, group).name, "force guidance")) break;
        GPROJT_CHECK((group < gproj_system_group_count(gproj_form_system(form))) == (kind < 2));
        for (n = 1; kind < 2 && n <= 12 && gproj_solve_is_on(form); ++n) {
            gproj_solve_advance(form, 0);
            GPROJT_NEAR(gprojt_inside_weight(form, group),
                        kind == 1 ? (n <= 9 ? 0.3 : 0)
                        : n <= 5  ? pow(0.3, n)
                                  : 0,
                        1e-15);
        }
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* A rough tolerance is a tolerance: what is left may be a visible part of the loads. */
GPROJT_TEST(rough_tolerances_are_met) {
    static const double tolerances[4] = {1e-3, 3e-3, 1e-2, 3e-2};
    int32_t i, rough = 0;
    for (i = 0; i < 4; ++i) {
        gproj_mesh *mesh = gprojt_hill(QUADS, 6, 10, 3);
        gproj_loads loads = gprojt_no_loads();
        gproj_solve_options options;
        gproj_form *form;
        gproj_result result;
        memset(&options, 0, sizeof options);
        options.tolerance = tolerances[i];
        loads.area_load = 1;
        gprojt_shake(mesh, 0.3, 5);
        form = gprojt_pinned_form(mesh, NULL, &loads);
        gproj_add_compression(form, mesh->edge_count, NULL, 1);
        gproj_add_planarity(form, 1);
        result = gproj_solve(form, 20, &options);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && result.residual <= tolerances[i]);
        rough += gproj_measure_forces(form, NULL).residual > 1e-3;
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    GPROJT_CHECK(rough > 0);
}

/* Forces of any size are a start: none at all, tiny, and as large as numbers are. */
GPROJT_TEST(forces_of_any_size_are_set) {
    static const double sizes[] = {0, 1e-300, 1e-12, 1e12, 1e200, 1e300};
    int i;
    for (i = 0; i < 6; ++i) {
        gproj_mesh *mesh = gprojt_vault(QUADS, 4, 10, 3);
        double *w = gprojt_numbers(mesh->edge_count);
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        gproj_result result;
        int32_t e;
        loads.density = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        for (e = 0; e < mesh->edge_count; ++e) w[e] = sizes[i];
        GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK);
        gproj_get_forces(form, w, NULL);
        for (e = 0; e < mesh->edge_count; ++e)
            if (gprojt_inside_force(form, e) >= 0) GPROJT_NEAR(w[e], sizes[i], 1e-12 * sizes[i]);
        result = gproj_solve(form, 5, NULL);
        GPROJT_CHECK(gprojt_all_finite(mesh->position, 3 * mesh->vertex_count));
        if (result.outcome == GPROJ_FAILED) printf("    size %g: %s\n", sizes[i], result.message);
        GPROJT_CHECK(result.outcome != GPROJ_FAILED && !strstr(result.message, "nan"));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(w);
    }
}

/* Beside loads whose squares overflow, too. */
GPROJT_TEST(forces_are_set_beside_huge_loads) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 4, 10, 3);
    double *w = gprojt_numbers(mesh->edge_count);
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form;
    int32_t e;
    loads.density = 1e300;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    for (e = 0; e < mesh->edge_count; ++e) w[e] = 3 + e;
    GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK && gproj_get_forces(form, w, NULL) == GPROJ_OK);
    for (e = 0; e < mesh->edge_count; ++e)
        if (gprojt_inside_force(form, e) >= 0) GPROJT_NEAR(w[e], 3 + e, 1e-12 * (3 + e));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(w);
}

/* Forces that have values are not drawn to anything in the next solve, nor are forces in a nearest one. */
GPROJT_TEST(guidance_of_forces_is_for_their_start) {
    int nearest;
    for (nearest = 0; nearest < 2; ++nearest) {
        gproj_mesh *mesh = gprojt_vault(QUADS, 5, 10, 0); /* a plate: the first forces are uniform */
        gproj_loads loads = gprojt_no_loads();
        gproj_solve_options options;
        gproj_form *form;
        int32_t group = 0, count;
        memset(&options, 0, sizeof options);
        loads.area_load = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        options.nearest = nearest;
        GPROJT_CHECK(gproj_solve(form, 20, &options).outcome != GPROJ_FAILED);
        count = gproj_system_group_count(gproj_form_system(form));
        while (group < count && strcmp(gproj_form_group_info(form, group).name, "force guidance")) ++group;
        GPROJT_CHECK((group < count) == !nearest);
        if (!nearest) GPROJT_CHECK(gproj_form_group_info(form, group).schedule.weight > 0);
        GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome != GPROJ_FAILED);
        if (!nearest) GPROJT_CHECK(gproj_form_group_info(form, group).schedule.weight == 0);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Equilibrium that has no weight is not missed, whatever else does not hold. */
GPROJT_TEST(equilibrium_that_is_off_is_not_missed) {
    int on;
    for (on = 0; on < 2; ++on) {
        gproj_mesh *mesh = gprojt_vault(QUADS, 4, 10, 0);
        gproj_loads loads = gprojt_no_loads();
        double length = 30;
        gproj_form *form;
        gproj_result result;
        loads.area_load = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        gproj_add_fixed(form, 0, NULL, 1);
        gproj_add_lengths(form, 1, NULL, &length, 1);
        gproj_set_schedule(form, 0, gproj_keep(on));
        result = gproj_solve(form, 20, NULL);
        GPROJT_CHECK(result.outcome != GPROJ_CONVERGED && strstr(result.message, "'lengths'"));
        GPROJT_CHECK((strstr(result.message, "equilibrium was found") != NULL) == on);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- what cannot be -- */

/* What gproj_find_imbalance gives is a proof: loads do work along it, and no allowed force does the opposite. */
GPROJT_TEST(imbalance_is_a_proof) {
    int sign, shape;
    for (sign = -1; sign <= 1; sign += 2)
        for (shape = 0; shape < 2; ++shape) {
            gproj_mesh *mesh = gprojt_vault(shape ? QUADS : TRIANGLES, 5, 10, shape ? 0.5 : -2 * sign);
            gproj_loads loads = gprojt_no_loads();
            gprojt_list pins = gprojt_boundary(mesh);
            double *d = gprojt_numbers(3 * mesh->vertex_count), *f, work = 0, size = 0;
            gproj_form *form;
            int32_t e, k;
            gprojt_shake(mesh, 0.3, 4);
            loads.snow = 1;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            if (sign > 0) gproj_add_compression(form, mesh->edge_count, NULL, 1);
            if (sign < 0) gproj_add_tension(form, mesh->edge_count, NULL, 1);
            GPROJT_CHECK(gproj_find_imbalance(form, d, NULL) == GPROJ_OK);
            f = gprojt_true_loads(mesh, &loads);
            for (k = 0; k < 3 * mesh->vertex_count; ++k) {
                if (gprojt_listed(pins.item, pins.count, k / 3)) GPROJT_CHECK(d[k] == 0);
                work += f[k] * d[k];
                size += fabs(f[k]) * fabs(d[k]);
            }
            GPROJT_CHECK(work > 1e-3 * size && size > 0);
            for (e = 0; e < mesh->edge_count; ++e) {
                int32_t i = mesh->origin[2 * e], j = mesh->origin[2 * e + 1];
                double along = 0;
                for (k = 0; k < 3; ++k)
                    along += (mesh->position[3 * i + k] - mesh->position[3 * j + k]) * (d[3 * i + k] - d[3 * j + k]);
                GPROJT_CHECK(sign * along >= -1e-8);
            }
            GPROJT_CHECK(gproj_find_imbalance(form, NULL, NULL) == GPROJ_ERROR_ARGUMENT);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
            free(d), free(f), free(pins.item);
        }
    GPROJT_CHECK(gproj_find_imbalance(NULL, NULL, NULL) == GPROJ_ERROR_ARGUMENT);
}

/* The verdict of a vault under its weight: faces flat or not, some signs, everything fixed or only the boundary, pinned or
   not. */
static gproj_result gprojt_verdict(double rise, bool planar, int sign, bool all, bool pinned) {
    gproj_mesh *mesh = gprojt_hill(QUADS, 4, 8, rise);
    gproj_loads loads = gprojt_no_loads();
    gprojt_list pins = gprojt_boundary(mesh);
    gproj_form *form;
    gproj_supports supports;
    gproj_result result;
    int32_t *list = (int32_t *)malloc((size_t)mesh->vertex_count * sizeof *list), v;
    if (!list) abort();
    for (v = 0; v < mesh->vertex_count; ++v) list[v] = v;
    loads.density = 1;
    if (planar) gprojt_shake(mesh, 0.1, 2); /* a hill's quads are flat */
    form = gproj_form_create(mesh, NULL);
    supports = gprojt_pins(pins);
    if (!pinned) supports.count = 0;
    if (planar) gproj_add_planarity(form, 1);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    if (sign != -1) gproj_add_compression(form, mesh->edge_count, NULL, 1);
    if (sign != 1) gproj_add_tension(form, mesh->edge_count, NULL, 1);
    if (all) gproj_add_fixed(form, mesh->vertex_count, list, 1);
    if (!all) gproj_add_fixed_boundary(form, 1);
    result = gproj_solve(form, 40, NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(list), free(pins.item);
    return result;
}

GPROJT_TEST(obstacles_are_named) {
    gproj_result result = gprojt_verdict(2, true, 1, true, true);
    GPROJT_CHECK(result.outcome != GPROJ_CONVERGED && strstr(result.message, "cannot become flat, because "));
    result = gprojt_verdict(2, false, 1, true, true);
    GPROJT_CHECK(result.outcome == GPROJ_CONVERGED || strstr(result.message, "all vertices are fixed"));
    result = gprojt_verdict(2, false, 0, false, true);
    GPROJT_CHECK(result.outcome != GPROJ_CONVERGED && strstr(result.message, "is to have both signs"));
    result = gprojt_verdict(2, false, 1, false, false);
    GPROJT_CHECK(result.outcome != GPROJ_CONVERGED && strstr(result.message, "has no support"));
}

/* What contradicts on one edge: signs, also by rows of the caller's (dense ones in the last way) and by bounds of stresses.
   What has no weight does not, nor bounds that both signs satisfy, or no force at all, nor those of lengths. */
GPROJT_TEST(contradictions_are_named) {
    int way;
    for (way = 0; way < 13; ++way) {
        gproj_mesh *mesh = gprojt_hill(QUADS, 4, 8, 0);
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        gproj_group group;
        gproj_result result;
        gproj_term term;
        const double off = 0;
        int32_t edge = mesh->edge_count / 2, own, inside = 0;
        loads.density = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads); /* a plate, which is fixed, and carries nothing */
        gproj_add_fixed(form, 0, NULL, 1);
        while (gproj_force_variable(form, edge) < 0) ++edge;
        while (gproj_force_variable(form, inside) < 0) ++inside;
        memset(&group, 0, sizeof group);
        group.name = "own", group.kind = GPROJ_BOUND, group.place = GPROJ_PLACE_EDGE, group.schedule = gproj_keep(1);
        group.global = way == 10;
        term = gprojt_term(gproj_force_variable(form, edge), -1, -1);
        gproj_add_length_bounds(form, 0, NULL, 0.01, INFINITY, 1);
        if (way != 9 && way != 11) gproj_add_compression(form, 1, &edge, 1);
        if (way == 0) gproj_add_tension(form, 1, &edge, 1);
        if (way == 1 || way == 10) own = gproj_system_add_group(gproj_form_system(form), &group);
        if (way == 1 || way == 10) gproj_system_add_row(gproj_form_system(form), own, 1, &term, 0, edge);
        if (way == 2) gproj_add_stress_bounds(form, 1, &edge, NULL, -INFINITY, -1, 1);
        if (way == 3) gproj_add_stress_bounds(form, 1, &edge, NULL, -INFINITY, -1, 0);
        if (way == 4) gproj_add_stress_bounds(form, 1, &edge, NULL, -1, 1, 1);
        if (way == 5) gproj_add_tension(form, 1, &edge, 0);
        if (way == 6) gproj_set_element_weights(form, gproj_add_tension(form, 1, &edge, 1), 1, &edge, &off);
        if (way == 7) gproj_add_tension(form, 1, &inside, 1);
        if (way == 8) gproj_add_stress_bounds(form, 1, &edge, NULL, 1, 2, 1);
        if (way == 9) gproj_add_tension(form, 1, &edge, 1), gproj_add_stress_bounds(form, 1, &edge, NULL, 1, 2, 1);
        if (way == 11) gproj_add_tension(form, 1, &edge, 1), gproj_add_stress_bounds(form, 1, &edge, NULL, 0, 2, 1);
        if (way == 12) gproj_add_stress_bounds(form, 1, &edge, NULL, -2, 0, 1);
        result = gproj_solve(form, 20, NULL);
        GPROJT_CHECK(result.outcome != GPROJ_CONVERGED && gproj_form_error(form)->code == GPROJ_OK);
        GPROJT_CHECK((strstr(result.message, "is to have both signs") != NULL) == (way < 3 || way == 9 || way == 10));
        if (strstr(result.message, "is to have both signs")) {
            char words[32];
            snprintf(words, sizeof words, "; edge %d is to have both", (int)edge);
            GPROJT_CHECK(strstr(result.message, words) != NULL);
        }
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Edge 0 may contradict as well as any other. */
GPROJT_TEST(the_first_edge_may_contradict) {
    gproj_mesh *mesh = gprojt_hill(QUADS, 4, 8, 0);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_loads loads = gprojt_no_loads();
    gproj_supports supports = {1, NULL, NULL};
    int32_t edge = 0, pin = mesh->vertex_count - 1;
    loads.density = 1, supports.vertex = &pin;
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_fixed_boundary(form, 1);
    gproj_add_compression(form, 1, &edge, 1);
    gproj_add_tension(form, 1, &edge, 1);
    GPROJT_CHECK(strstr(gproj_solve(form, 0, NULL).message, "; edge 0 is to have both signs") != NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Where equilibrium is not asked for, at vertices whose weight is 0, nothing is out of balance, however small the loads are
   beside the tolerance. */
GPROJT_TEST(vertices_without_weight_carry_nothing) {
    int way;
    for (way = 0; way < 3; ++way) {
        bool on = way == 1;
        gproj_mesh *mesh = gprojt_hill(QUADS, 4, 8, 0); /* a plate */
        gproj_loads loads = gprojt_no_loads();
        double *weight = gprojt_numbers(mesh->vertex_count);
        gproj_solve_options options;
        gproj_form *form;
        gproj_result result;
        int32_t v;
        memset(&options, 0, sizeof options);
        if (way == 2) options.tolerance = 1;
        loads.density = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        gproj_add_fixed(form, 0, NULL, 1);
        for (v = 0; v < mesh->vertex_count; ++v) weight[v] = on;
        if (way == 2) gproj_solve(form, 0, NULL); /* what was out of balance then */
        gproj_set_element_weights(form, 0, 0, NULL, weight);
        result = gproj_solve(form, 20, &options);
        GPROJT_CHECK((result.outcome == GPROJ_CONVERGED) == !on);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(weight);
    }
}

/* A shape that is turned over to stand, or to hang, is told. */
GPROJT_TEST(overturned_shapes_are_told) {
    int up, sign;
    for (up = -1; up <= 1; up += 2)
        for (sign = -1; sign <= 1; sign += 2) {
            gproj_result result = gprojt_verdict(2.0 * up, false, sign, false, true);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
            GPROJT_CHECK((strstr(result.message, "turned over") != NULL) == (up != sign));
            if (up != sign) { /* by what either kind of force would have left: the first one less */
                const char *left = strstr(result.message, "would have left ");
                double one = 1, other = 0;
                GPROJT_CHECK(strstr(result.message, up < 0 ? "the shape hung" : "the shape stood") != NULL);
                GPROJT_CHECK(left && sscanf(left, "would have left %lf of its loads, %*s %lf, so", &one, &other) == 2);
                GPROJT_CHECK(other > 0.9 && one < 0.5 * other);
            }
        }
}

/* The forces that were asked for tell which: also by bounds of the caller's, and where a few edges bear the other sign.
   The next solve, in which equilibrium is off, is not guided by forces, and nothing is turned over. */
GPROJT_TEST(overturned_shapes_are_told_by_their_forces) {
    int way;
    for (way = 0; way < 2; ++way) {
        gproj_mesh *mesh = gprojt_hill(QUADS, 6, 12, way ? 2 : -2);
        gproj_loads loads = gprojt_no_loads();
        int32_t count = 0, *carrying = (int32_t *)malloc((size_t)mesh->edge_count * sizeof *carrying), e, g, groups;
        gproj_form *form;
        gproj_system *s;
        gproj_result result;
        if (!carrying) abort();
        loads.density = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        s = gproj_form_system(form);
        for (e = 0; e < mesh->edge_count; ++e)
            if (gproj_force_variable(form, e) >= 0) carrying[count++] = e;
        if (way == 0) {
            gproj_group push;
            memset(&push, 0, sizeof push);
            push.name = "push", push.kind = GPROJ_BOUND, push.place = GPROJ_PLACE_EDGE;
            push.schedule = gproj_keep(1);
            g = gproj_system_add_group(s, &push);
            for (e = 0; e < count; ++e)
                gprojt_add_linear(s, g, gproj_force_variable(form, carrying[e]), 1, 0, carrying[e]);
        } else {
            gproj_add_tension(form, count - 1, carrying, 1);
            gproj_add_compression(form, 1, carrying + count - 1, 1);
        }
        result = gproj_solve(form, 60, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        GPROJT_CHECK(strstr(result.message, way ? "the shape stood: compression" : "the shape hung: tension") != NULL);
        gproj_set_schedule(form, 0, gproj_keep(0));
        result = gproj_solve(form, 60, NULL);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && !strstr(result.message, "turned over"));
        groups = gproj_system_group_count(s);
        for (g = 0; g < groups; ++g) {
            gproj_group_info info = gproj_system_group_info(s, g);
            if (strcmp(info.name, "force guidance") == 0) GPROJT_CHECK(info.schedule.weight == 0);
        }
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(carrying);
    }
}

/* Equilibrium that holds to the caller's tolerance is found, whatever else does not hold. */
GPROJT_TEST(equilibrium_within_the_tolerance_is_found) {
    int strict;
    for (strict = 0; strict < 2; ++strict) {
        gproj_mesh *mesh = gprojt_hill(QUADS, 4, 8, 2);
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        gproj_solve_options options;
        gproj_result result;
        gproj_group_info info;
        double to[3];
        int32_t corner = 0, k;
        memset(&options, 0, sizeof options);
        options.tolerance = strict ? 0 : 0.2;
        loads.density = 1;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        for (k = 0; k < 3; ++k) to[k] = mesh->position[k] + (k == 2 ? 2 : 0);
        gproj_add_targets(form, 1, &corner, to, 1); /* it is fixed as well */
        result = gproj_solve(form, 1, &options);
        info = gproj_form_group_info(form, 0);
        GPROJT_CHECK(result.outcome == GPROJ_ITERATION_LIMIT && info.max > 1e-9 && info.max < 0.2);
        GPROJT_CHECK((strstr(result.message, "equilibrium was found") != NULL) == strict);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Where forces of one sign carry weights, vertices that stood outside of all supports as seen from above cannot stay there:
   the farthest is told, and how far. The last four solves are broken off early: half of the edges bound twice, one bound without
   weight, nothing to carry outside, supports that move in. */
GPROJT_TEST(overhangs_are_told) {
    enum { COMPRESSION, TENSION, FREE_EDGE, WIND, ALL_AROUND, TWICE, WEIGHTLESS, UNLOADED, MOVED, CASES };
    int k;
    for (k = 0; k < CASES; ++k) {
        gproj_mesh *mesh = gprojt_hill(QUADS, 8, 8, k == TENSION ? -2 : 2);
        double *load = gprojt_numbers(3 * mesh->vertex_count), *to = gprojt_numbers(3 * mesh->vertex_count);
        double unit = gproj_mesh_mean_edge_length(mesh), by = 0;
        int32_t *edge = (int32_t *)calloc((size_t)mesh->edge_count, sizeof *edge), vertex = -1, i, count = 0, group;
        double *before = gprojt_keep(mesh);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gprojt_list list = gprojt_boundary(mesh);
        gproj_loads loads = gprojt_no_loads();
        gproj_supports supports;
        gproj_solve_options options;
        gproj_result result;
        const char *told;
        for (i = 0; i < mesh->vertex_count; ++i) load[3 * i + 2] = k == UNLOADED && before[3 * i] > -1.9 ? 0 : -1;
        for (i = 0; i < mesh->edge_count; ++i) edge[i] = k == TWICE ? i / 2 : i;
        for (i = 0; i < list.count; ++i) /* a quarter of the plan, -4 <= x <= -2 */
            if (k == ALL_AROUND || k == MOVED || before[3 * list.item[i]] < -1.9) list.item[count++] = list.item[i];
        list.count = count;
        supports = gprojt_pins(list);
        if (k == WIND) load[3 * mesh->origin[0]] = 0.01;
        loads.point_load = load;
        memset(&options, 0, sizeof options);
        options.smooth = true;
        gproj_add_equilibrium(form, &loads, &supports, 1);
        for (i = 0; i < 3 * list.count; ++i) to[i] = before[3 * list.item[i / 3] + i % 3] * (k == MOVED ? 0.3 : 1);
        gproj_add_targets(form, list.count, list.item, to, 1);
        if (k == TENSION)
            group = gproj_add_tension(form, 0, NULL, 1);
        else
            group = gproj_add_compression(form, mesh->edge_count - (k == FREE_EDGE), edge, 1);
        if (k == WEIGHTLESS) gproj_system_set_row_weight(gproj_form_system(form), group, 0, 0);
        result = gproj_solve(form, k < TWICE ? 100 : 1, &options);
        GPROJT_CHECK(k < TWICE || strstr(result.message, "equilibrium was found"));
        told = strstr(result.message, "alone keeps all vertices between the supports as seen from above, but vertex");
        GPROJT_CHECK((told != NULL) == (k == COMPRESSION || k == TENSION));
        if (told && sscanf(strstr(told, "vertex "), "vertex %d was %lf mean", &vertex, &by) == 2) {
            GPROJT_NEAR(by, (before[3 * vertex] + 2) / unit, 0.01);
            GPROJT_NEAR(before[3 * vertex], 4, 1e-12);
            GPROJT_CHECK(strstr(result.message, k == TENSION ? "; tension alone" : "; compression alone") != NULL);
            GPROJT_CHECK(strstr(result.message, k == TENSION ? "or allow compression" : "or allow tension") != NULL);
        }
        GPROJT_CHECK(!told || vertex >= 0);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(list.item), free(load), free(edge), free(before), free(to);
    }
}

/* A plate that rises to carry has not been turned over: it would not have hung either. */
GPROJT_TEST(rising_plates_are_not_overturned) {
    int sign;
    for (sign = -1; sign <= 1; sign += 2) {
        gproj_result result = gprojt_verdict(0, false, sign, false, true);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED && !strstr(result.message, "turned over"));
    }
}

/* The verdict on a shape that is turned over tells how much of the loads tension and compression would have left, as
   gproj_find_forces does: here a hill that carries by one of them, but for its middle, which is pushed in. */
GPROJT_TEST(loads_that_either_sign_leaves_are_told) {
    int up, sign;
    for (up = -1; up <= 1; up += 2) {
        gproj_mesh *mesh = gprojt_hill(QUADS, 6, 12, 3.0 * up);
        double told[2] = {0, 0}, *left = gprojt_numbers(mesh->vertex_count);
        double *load = gprojt_numbers(3 * mesh->vertex_count), *before;
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        gproj_result result;
        const char *text;
        int32_t v;
        for (v = 0; v < mesh->vertex_count; ++v)
            if (mesh->position[3 * v + 2] * up > 2.9) mesh->position[3 * v + 2] = 0;
        for (v = 0; v < mesh->vertex_count; ++v) load[3 * v + 2] = -1;
        before = gprojt_keep(mesh);
        loads.point_load = load;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        if (up > 0) gproj_add_tension(form, mesh->edge_count, NULL, 1);
        if (up < 0) gproj_add_compression(form, mesh->edge_count, NULL, 1);
        result = gproj_solve(form, 60, NULL);
        text = strstr(result.message, "would have left ");
        GPROJT_CHECK(text && sscanf(text, "would have left %lf of its loads, %*s %lf, so", &told[0], &told[1]) == 2);
        gproj_form_destroy(form);
        gprojt_put_back(mesh, before);
        for (sign = 0; sign < 2; ++sign) { /* the other one, that asked for */
            double sum = 0;
            int32_t free_vertices = 0;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            if ((up > 0) == (sign == 0))
                gproj_add_compression(form, mesh->edge_count, NULL, 1);
            else
                gproj_add_tension(form, mesh->edge_count, NULL, 1);
            GPROJT_CHECK(gproj_find_forces(form, NULL, left, NULL) == GPROJ_OK);
            for (v = 0; v < mesh->vertex_count; ++v) {
                sum += left[v] * left[v];
                free_vertices += !gproj_mesh_is_boundary_vertex(mesh, v);
            }
            GPROJT_NEAR(told[sign], sqrt(sum / free_vertices), 0.01);
            gproj_form_destroy(form);
        }
        gproj_mesh_destroy(mesh);
        free(left), free(load), free(before);
    }
}

/* -- with planar faces -- */

GPROJT_TEST(planar_faces_and_compression) {
    int shape, load;
    for (shape = QUADS; shape <= HYBRID; ++shape) {
        for (load = 0; load < 2; ++load) {
            gproj_mesh *mesh = gprojt_hill(shape, 8, 10, 3);
            double *kept = gprojt_keep(mesh), range[2];
            gproj_loads loads = gprojt_no_loads();
            gproj_form *form;
            gproj_result result;
            gproj_measures m;
            loads.density = 1, loads.area_load = load;
            form = gprojt_pinned_form(mesh, NULL, &loads);
            gproj_add_compression(form, mesh->edge_count, NULL, 1);
            gproj_add_planarity(form, 1);
            result = gproj_solve(form, 20, NULL);
            if (result.outcome != GPROJ_CONVERGED) printf("    shape %d: %s\n", shape, result.message);
            GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
            gprojt_check_balance(form, &loads, 1e-10);
            gprojt_range(form, range);
            GPROJT_CHECK(range[0] >= -1e-9 * range[1]);
            m = gproj_measure(mesh, kept, NULL);
            GPROJT_CHECK(m.planarity_max < 1e-12 && m.turned_faces == 0);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
            free(kept);
        }
    }
}

/* -- groups on and off -- */

GPROJT_TEST(weights_switch_groups_off_and_on) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 6, 10, 3);
    gprojt_list pins = gprojt_boundary(mesh);
    gproj_supports supports = gprojt_pins(pins);
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form = gproj_form_create(mesh, NULL);
    double *kept = gprojt_keep(mesh), *w = gprojt_numbers(mesh->edge_count), range[2];
    gproj_schedule on = gproj_guide(1), off = gproj_keep(0);
    int32_t equilibrium, compression, stress, e;
    loads.density = 1;
    equilibrium = gproj_add_equilibrium(form, &loads, &supports, 0);
    compression = gproj_add_compression(form, mesh->edge_count, NULL, 0);
    stress = gproj_add_stress_bounds(form, mesh->edge_count, NULL, NULL, 1000, 2000, 0);
    gproj_add_force_fairness(form, 0);
    gproj_add_fixed_boundary(form, 1);
    GPROJT_CHECK(equilibrium >= 0 && compression >= 0 && stress >= 0);
    /* off: nothing moves, there are no forces */
    GPROJT_CHECK(gproj_solve(form, 9, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_largest_move(kept, mesh->position, mesh->vertex_count) < 1e-12);
    gproj_get_forces(form, w, NULL);
    for (e = 0; e < mesh->edge_count; ++e) GPROJT_CHECK(w[e] == 0);
    /* equilibrium, then compression as well */
    gproj_set_schedule(form, equilibrium, on);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    gprojt_check_balance(form, &loads, 1e-10);
    gproj_set_schedule(form, compression, on);
    GPROJT_CHECK(gproj_solve(form, 30, NULL).outcome == GPROJ_CONVERGED);
    gprojt_check_balance(form, &loads, 1e-10);
    gprojt_range(form, range);
    GPROJT_CHECK(range[0] >= -1e-9 * range[1]);
    /* stresses that this load cannot give, and off again */
    gproj_set_schedule(form, stress, on);
    GPROJT_CHECK(gproj_solve(form, 10, NULL).outcome != GPROJ_CONVERGED);
    gproj_set_schedule(form, stress, off);
    gproj_set_schedule(form, equilibrium, off);
    gproj_set_schedule(form, compression, off);
    gprojt_put_back(mesh, kept);
    GPROJT_CHECK(gproj_solve(form, 9, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_largest_move(kept, mesh->position, mesh->vertex_count) < 1e-9);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(pins.item), free(kept), free(w);
}

static bool gprojt_switch_on(void *user, gproj_system *s, const gproj_iteration *iteration) {
    gproj_schedule on = gproj_guide(1);
    if (iteration->number == 2) gproj_system_set_schedule(s, *(const int32_t *)user, on);
    return true;
}

/* Equilibrium that gets its weight on the way has forces, too. */
GPROJT_TEST(equilibrium_on_the_way) {
    gproj_mesh *mesh = gprojt_vault(TRIANGLES, 5, 10, 3);
    gprojt_list pins = gprojt_boundary(mesh);
    gproj_supports supports = gprojt_pins(pins);
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_solve_options options;
    int32_t group, v;
    for (v = 0; v < mesh->vertex_count; ++v) mesh->position[3 * v + 2] += 1;
    memset(&options, 0, sizeof options);
    loads.density = 1;
    group = gproj_add_equilibrium(form, &loads, &supports, 0);
    gproj_add_fixed_boundary(form, 1);
    options.on_iteration = gprojt_switch_on, options.user = &group;
    GPROJT_CHECK(gproj_solve(form, 60, &options).outcome == GPROJ_CONVERGED);
    gprojt_check_balance(form, &loads, 1e-9);
    GPROJT_CHECK(gprojt_all_finite(mesh->position, 3 * mesh->vertex_count));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(pins.item);
}

/* -- borders -- */

/* A square of nine quads and two vertices without faces. */
GPROJT_TEST(isolated_vertices) {
    gprojt_soup soup = gprojt_quad_grid(3, 3);
    gproj_mesh *mesh;
    double f[3 * 18] = {0}, residual[18], reaction[3 * 18];
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form;
    gproj_forces m;
    int32_t v;
    gprojt_add_vertex(&soup, 5, 5, 5);
    gprojt_add_vertex(&soup, 6, 5, 5);
    mesh = gprojt_mesh_of(soup);
    GPROJT_REQUIRE(mesh && mesh->isolated_count == 2 && mesh->vertex_count == 18);
    for (v = 0; v < mesh->vertex_count; ++v) f[3 * v + 2] = v < 16 ? -1 : 0;
    loads.point_load = f, loads.snow = 1, loads.density = 1;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    GPROJT_CHECK(gproj_find_forces(form, NULL, residual, NULL) == GPROJ_OK && residual[16] == 0);
    GPROJT_CHECK(gproj_solve(form, 40, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_get_reactions(form, reaction, NULL) == GPROJ_OK && reaction[3 * 16 + 2] == 0);
    m = gproj_measure_forces(form, NULL);
    GPROJT_CHECK(m.residual < 1e-10 && m.residual_vertex < 16);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(supports_only) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 3, 10, 2);
    gprojt_list all;
    gproj_supports supports;
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form = gproj_form_create(mesh, NULL);
    double *w = gprojt_numbers(mesh->edge_count), *f, *r = gprojt_numbers(3 * mesh->vertex_count),
           *kept = gprojt_keep(mesh);
    gproj_forces m;
    int32_t v;
    all.count = mesh->vertex_count;
    all.item = (int32_t *)malloc((size_t)all.count * sizeof *all.item);
    GPROJT_REQUIRE(all.item);
    for (v = 0; v < all.count; ++v) all.item[v] = v;
    supports = gprojt_pins(all);
    loads.density = 1;
    GPROJT_CHECK(gproj_add_equilibrium(form, &loads, &supports, 1) >= 0);
    GPROJT_CHECK(gproj_add_compression(form, mesh->edge_count, NULL, 1) >= 0);
    GPROJT_CHECK(gproj_add_stress_bounds(form, mesh->edge_count, NULL, NULL, 0, 1, 1) >= 0);
    GPROJT_CHECK(gproj_add_force_fairness(form, 1) >= 0);
    GPROJT_CHECK(gproj_find_forces(form, w, r, NULL) == GPROJ_OK && w[0] == 0 && r[0] == 0);
    for (v = 0; v < mesh->edge_count; ++v) w[v] = 5; /* which no edge bears */
    GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK && gprojt_inside_load_scale(form) > 0);
    GPROJT_CHECK(gproj_get_forces(form, w, NULL) == GPROJ_OK && w[0] == 0);
    GPROJT_CHECK(gproj_solve(form, 9, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_largest_move(kept, mesh->position, mesh->vertex_count) < 1e-12);
    GPROJT_CHECK(gproj_get_reactions(form, r, NULL) == GPROJ_OK);
    f = gprojt_true_loads(mesh, &loads);
    for (v = 0; v < 3 * mesh->vertex_count; ++v) GPROJT_NEAR(r[v], -f[v], 1e-12);
    m = gproj_measure_forces(form, NULL);
    GPROJT_CHECK(m.residual == 0 && m.residual_vertex == -1 && m.max_force == 0 && m.load_path == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(all.item), free(w), free(f), free(r), free(kept);
}

/* No supports at all: what is free to fall has no equilibrium, and without loads it has. */
GPROJT_TEST(no_supports) {
    int loaded;
    for (loaded = 0; loaded < 2; ++loaded) {
        gproj_mesh *mesh = gprojt_noisy(GPROJT_SHAPES - 1, 3, 0.02, 3);
        gproj_loads loads = gprojt_no_loads();
        gproj_supports supports = {0, NULL, NULL};
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_result result;
        double *f = gprojt_numbers(3 * mesh->vertex_count);
        if (loaded) f[2] = -1;
        loads.point_load = f;
        GPROJT_CHECK(gproj_add_equilibrium(form, &loads, &supports, 1) >= 0);
        gproj_add_closeness(form, 0.1);
        result = gproj_solve(form, 20, NULL);
        GPROJT_CHECK(result.outcome != GPROJ_FAILED && gprojt_all_finite(mesh->position, 3 * mesh->vertex_count));
        if (loaded) GPROJT_CHECK(result.outcome != GPROJ_CONVERGED);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(f);
    }
}

/* A cable net without loads between fixed rails, saddled: it is prestressed, not slack. */
GPROJT_TEST(prestressed_net) {
    int shape;
    for (shape = QUADS; shape <= HYBRID; ++shape) {
        gproj_mesh *mesh = gprojt_vault(shape, 6, 10, 0);
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        gproj_result result;
        double range[2];
        int32_t v;
        for (v = 0; v < mesh->vertex_count; ++v)
            mesh->position[3 * v + 2] = 0.06 * mesh->position[3 * v] * mesh->position[3 * v] -
                                        0.06 * mesh->position[3 * v + 1] * mesh->position[3 * v + 1];
        gprojt_shake(mesh, 0.05, 2);
        form = gprojt_pinned_form(mesh, NULL, &loads);
        gproj_add_tension(form, mesh->edge_count, NULL, 1);
        result = gproj_solve(form, 30, NULL);
        if (result.outcome != GPROJ_CONVERGED) printf("    shape %d: %s\n", shape, result.message);
        GPROJT_CHECK(result.outcome == GPROJ_CONVERGED);
        gprojt_range(form, range);
        GPROJT_CHECK(range[0] < 0 && range[1] <= -1e-9 * range[0]);
        gprojt_check_balance(form, &loads, 1e-10 * fmax(1, fabs(range[0])));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* -- refusals -- */

static gproj_form *gprojt_form_with_equilibrium(gproj_mesh *mesh) {
    gproj_loads loads = gprojt_no_loads();
    loads.density = 1;
    return gprojt_pinned_form(mesh, NULL, &loads);
}

static void gprojt_check_refused(gproj_form *form, bool refused, gproj_code code, gproj_place place, int64_t index) {
    const gproj_error *error = gproj_form_error(form);
    if (error->code != code || error->place != place || error->index != index)
        printf("    %d %d %d: %s\n", (int)error->code, (int)error->place, (int)error->index, error->message);
    GPROJT_CHECK(refused && error->code == code && error->place == place && error->index == index);
    GPROJT_CHECK(error->message[0] && !strchr(error->message, '\n'));
    GPROJT_CHECK(gproj_solve(form, 3, NULL).outcome == GPROJ_FAILED);
    gproj_form_destroy(form);
}

GPROJT_TEST(refusals_of_equilibrium) {
    gproj_mesh *mesh = gprojt_noisy(QUADS, 3, 0.1, 1);
    double *density = gprojt_numbers(mesh->edge_count), *point = gprojt_numbers(3 * mesh->vertex_count);
    static const int32_t far[2] = {0, 1000}, near[2] = {0, 1};
    gproj_supports supports = {2, near, NULL};
    int i;
    density[7] = NAN, point[3 * 5 + 1] = INFINITY;
    for (i = 0; i < 9; ++i) {
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_loads loads = gprojt_no_loads();
        gproj_supports s = supports;
        gproj_place place = i == 4 ? GPROJ_PLACE_EDGE : i == 5 || i == 6 ? GPROJ_PLACE_VERTEX : GPROJ_PLACE_NONE;
        gproj_code code = i == 4 || i == 5 ? GPROJ_ERROR_NUMBER : i == 6 ? GPROJ_ERROR_INDEX : GPROJ_ERROR_ARGUMENT;
        if (i == 1) loads.density = NAN;
        if (i == 2) loads.area_load = INFINITY;
        if (i == 3) loads.snow = -INFINITY;
        if (i == 4) loads.edge_density = density;
        if (i == 5) loads.point_load = point;
        if (i == 6) s.vertex = far;
        if (i == 7) s.count = -1;
        if (i == 8) s.vertex = NULL;
        gprojt_check_refused(form, gproj_add_equilibrium(form, i ? &loads : NULL, &s, 1) == -1, code, place,
                             i == 4   ? 7
                             : i == 5 ? 5
                             : i == 6 ? 1000
                                      : -1);
    }
    {
        static const uint8_t slides[3] = {0, 7, 8};
        static const int32_t pins[3] = {0, 1, 2};
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_loads loads = gprojt_no_loads();
        gproj_supports sliding = {3, pins, slides};
        gprojt_check_refused(form, gproj_add_equilibrium(form, &loads, &sliding, 1) == -1, GPROJ_ERROR_ARGUMENT,
                             GPROJ_PLACE_VERTEX, 2);
        form = gproj_form_create(mesh, NULL);
        gprojt_check_refused(form, gproj_add_equilibrium(form, &loads, NULL, 1) == -1, GPROJ_ERROR_ARGUMENT,
                             GPROJ_PLACE_NONE, -1);
        form = gprojt_form_with_equilibrium(mesh);
        gprojt_check_refused(form, gproj_add_equilibrium(form, &loads, &supports, 1) == -1, GPROJ_ERROR_STATE,
                             GPROJ_PLACE_NONE, -1);
        form = gproj_form_create(mesh, NULL);
        gprojt_check_refused(form, gproj_add_equilibrium(form, &loads, &supports, -1) == -1, GPROJ_ERROR_ARGUMENT,
                             GPROJ_PLACE_NONE, -1);
        form = gprojt_form_with_equilibrium(mesh);
        gprojt_check_refused(form, gproj_add_compression(form, 1, NULL, -1) == -1, GPROJ_ERROR_ARGUMENT,
                             GPROJ_PLACE_NONE, -1);
    }
    gproj_mesh_destroy(mesh);
    free(density), free(point);
}

/* What loads a vertex without edges can balance is nothing, unless it is a support. */
GPROJT_TEST(loads_that_nothing_carries) {
    gprojt_soup soup;
    gproj_mesh *mesh;
    double *point;
    int32_t pins[5] = {0, 1, 2, 3, 4}, k, axis;
    gproj_supports supports = {4, pins, NULL};
    memset(&soup, 0, sizeof soup);
    for (k = 0; k < 5; ++k) gprojt_add_vertex(&soup, k % 2, k / 2 % 2, 0); /* the last one is alone */
    gprojt_add_triangle(&soup, 0, 1, 2), gprojt_add_triangle(&soup, 2, 1, 3);
    mesh = gprojt_soup_mesh(&soup, NULL, NULL);
    point = gprojt_numbers(3 * mesh->vertex_count);
    for (k = 0, axis = 2; axis >= 0; axis -= k == 2, k = (k + 1) % 3) {
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_loads loads = gprojt_no_loads();
        memset(point, 0, 15 * sizeof *point);
        point[12 + axis] = k ? -1 : 0, loads.point_load = point, supports.count = k == 1 ? 4 : 5;
        if (k == 1)
            gprojt_check_refused(form, gproj_add_equilibrium(form, &loads, &supports, 1) == -1, GPROJ_ERROR_ARGUMENT,
                                 GPROJ_PLACE_VERTEX, 4);
        else {
            GPROJT_CHECK(gproj_add_equilibrium(form, &loads, &supports, 1) >= 0);
            gproj_form_destroy(form);
        }
    }
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&soup);
    free(point);
}

enum {
    GPROJT_SET_FORCES,
    GPROJT_FIND_FORCES,
    GPROJT_FIND_IMBALANCE,
    GPROJT_GET_LOADS,
    GPROJT_GET_REACTIONS,
    GPROJT_MEASURE_FORCES,
    GPROJT_QUESTIONS
};
static const char *const gprojt_question_names[GPROJT_QUESTIONS] = {
    "set forces: ", "find forces: ", "find imbalance: ", "get loads: ", "get reactions: ", "measure forces: "};

static gproj_code gprojt_ask_form(gproj_form *form, int question, double *w, gproj_error *error) {
    gproj_code code = error ? error->code : GPROJ_OK;
    switch (question) {
    case GPROJT_SET_FORCES: return gproj_set_forces(form, w, error);
    case GPROJT_FIND_FORCES: return gproj_find_forces(form, w, NULL, error);
    case GPROJT_FIND_IMBALANCE: return gproj_find_imbalance(form, w, error);
    case GPROJT_GET_LOADS: return gproj_get_loads(form, w, error);
    case GPROJT_GET_REACTIONS: return gproj_get_reactions(form, w, error);
    default:
        if (gproj_measure_forces(form, error).residual_vertex < 0) code = error ? error->code : GPROJ_ERROR_STATE;
        return code;
    }
}

/* A refused question says why, and the form does not know of it. */
static void gprojt_check_question(gproj_form *form, int question, double *w, gproj_code code, gproj_place place,
                                  int64_t index, const char *says) {
    gproj_error error;
    GPROJT_CHECK(gprojt_ask_form(form, question, w, &error) == code);
    GPROJT_CHECK(error.code == code && error.place == place && error.index == index && strstr(error.message, says));
    if (!strstr(error.message, says)) printf("    question %d: %s\n", question, error.message);
    if (question != GPROJT_MEASURE_FORCES) GPROJT_CHECK(gprojt_ask_form(form, question, w, NULL) == code);
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
}

/* Equilibrium that lacks memory has no group, whose refresh would count on all rows. */
static bool gprojt_half_built(const gproj_host *host, void *user) {
    gproj_mesh *mesh = gprojt_noisy(QUADS, 4, 0.1, 1);
    gproj_form *form = gproj_form_create(mesh, host);
    gproj_system *s = gproj_form_system(form);
    gproj_loads loads = gprojt_no_loads();
    static const int32_t pins[4] = {0, 4, 20, 24};
    gproj_supports supports = {4, pins, NULL};
    bool done;
    (void)user;
    loads.area_load = 1;
    done = gproj_add_equilibrium(form, &loads, &supports, 1) >= 0;
    if (!done && s && gproj_system_error(s)->code == GPROJ_OK) gproj_system_solve(s, 2, NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return done;
}

GPROJT_TEST(half_built_equilibrium) { GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_half_built, NULL) > 20); }

/* Forces that are set, or taken away, between frames are those of the next step. */
GPROJT_TEST(forces_set_between_frames) {
    int how, seen, k;
    int32_t v = 12;
    gproj_handles handles = {1, NULL, &v, NULL, NULL};
    for (how = 0; how < 2; ++how) {
        double *after = NULL;
        for (seen = 0; seen < 2; ++seen) {
            gproj_drag *drag;
            gproj_mesh *mesh = gprojt_noisy(QUADS, 4, 0.1, 1);
            gproj_form *form = gprojt_form_with_equilibrium(mesh);
            double *w = gprojt_numbers(mesh->edge_count);
            int32_t closeness = gproj_add_closeness(form, 0.1), e;
            gproj_solve_begin(form, 12, NULL, NULL);
            for (k = 0; k < 3; ++k) gproj_solve_advance(form, 0);
            GPROJT_CHECK(gproj_solve_is_on(form) && gproj_get_forces(form, w, NULL) == GPROJ_OK);
            for (e = 0; e < mesh->edge_count; ++e) w[e] *= 3;
            GPROJT_CHECK(gproj_set_forces(form, how ? NULL : w, NULL) == GPROJ_OK);
            if (seen) gproj_set_schedule(form, closeness, gproj_guide(0.1)); /* as it was: rows are seen again */
            gproj_solve_advance(form, 0);
            if (seen) GPROJT_CHECK(gprojt_unmoved(mesh, after));
            else after = gprojt_keep(mesh);
            while (gproj_solve_is_on(form)) gproj_solve_advance(form, 0);
            drag = gproj_drag_begin(form, &handles, NULL, NULL); /* the forces have values */
            GPROJT_CHECK(drag != NULL);
            gproj_drag_cancel(drag);
            free(w);
            gproj_form_destroy(form);
            gproj_mesh_destroy(mesh);
        }
        free(after);
    }
}

/* Forces that are refused between frames change nothing of what follows, where rows that are seen anew would. */
GPROJT_TEST(forces_refused_between_frames) {
    double *after = NULL;
    int refused, k;
    for (refused = 0; refused < 2; ++refused) {
        gproj_mesh *mesh = gprojt_noisy(QUADS, 4, 0.1, 1);
        gproj_form *form = gprojt_form_with_equilibrium(mesh);
        double *w = gprojt_numbers(mesh->edge_count);
        gproj_add_planarity(form, 1);
        gproj_solve_begin(form, 40, NULL, NULL);
        for (k = 0; k < 5; ++k) gproj_solve_advance(form, 0);
        for (k = 0; k < mesh->edge_count; ++k) w[k] = NAN;
        if (refused) GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_ERROR_NUMBER);
        while (gproj_solve_is_on(form)) gproj_solve_advance(form, 0);
        if (refused) GPROJT_CHECK(gprojt_unmoved(mesh, after));
        else after = gprojt_keep(mesh);
        free(w);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    free(after);
}

/* A solve that is refused for its options has found no forces. */
GPROJT_TEST(refused_solves_start_no_forces) {
    gproj_mesh *mesh = gprojt_noisy(QUADS, 4, 0.1, 1);
    gproj_form *form = gprojt_form_with_equilibrium(mesh);
    int32_t v = 12;
    gproj_handles handles = {1, NULL, &v, NULL, NULL};
    gproj_error error;
    GPROJT_CHECK(gproj_solve(form, -1, NULL).outcome == GPROJ_FAILED && gproj_form_error(form)->code == GPROJ_OK);
    GPROJT_CHECK(!gproj_drag_begin(form, &handles, NULL, &error) && strstr(error.message, "forces have no values"));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(refused_questions_leave_the_form) {
    gproj_mesh *mesh = gprojt_noisy(QUADS, 3, 0.1, 1);
    double *w = gprojt_numbers(3 * mesh->vertex_count + mesh->edge_count), *kept, *again, x = mesh->position[5];
    gproj_form *form = gprojt_form_with_equilibrium(mesh);
    gproj_error error;
    int32_t e, inner = 0;
    kept = gprojt_numbers(mesh->edge_count), again = gprojt_numbers(mesh->edge_count);
    GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_get_forces(form, kept, &error) == GPROJ_OK && error.code == GPROJ_OK && error.message[0] == 0);
    while (inner < mesh->edge_count && kept[inner] == 0) ++inner;
    /* 1. Numbers that are none: the forces are as they were. */
    for (e = 0; e < mesh->edge_count; ++e) w[e] = 1;
    w[inner] = NAN;
    gprojt_check_question(form, GPROJT_SET_FORCES, w, GPROJ_ERROR_NUMBER, GPROJ_PLACE_EDGE, inner,
                          "the density of edge");
    gproj_get_forces(form, again, NULL);
    GPROJT_CHECK(memcmp(again, kept, (size_t)mesh->edge_count * sizeof *kept) == 0);
    /* 2. A position that is none: also before a drag. */
    mesh->position[5] = INFINITY;
    gprojt_check_question(form, GPROJT_FIND_FORCES, w, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 1, "vertex 1");
    gprojt_check_question(form, GPROJT_FIND_IMBALANCE, w, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 1, "vertex 1");
    gprojt_check_question(form, GPROJT_GET_LOADS, w, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 1, "vertex 1");
    {
        int32_t v = 5;
        gproj_handles handles = {1, NULL, &v, NULL, NULL};
        GPROJT_CHECK(!gproj_drag_begin(form, &handles, NULL, &error) && error.code == GPROJ_ERROR_NUMBER);
        GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
    }
    mesh->position[5] = x;
    /* 3. No array, no form. */
    gprojt_check_question(form, GPROJT_FIND_IMBALANCE, NULL, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "no array");
    gprojt_check_question(form, GPROJT_GET_LOADS, NULL, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "no array");
    gprojt_check_question(form, GPROJT_GET_REACTIONS, NULL, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                          "get reactions: there is no array");
    GPROJT_CHECK(gproj_get_forces(form, NULL, &error) == GPROJ_ERROR_ARGUMENT && strstr(error.message, "no array"));
    for (e = 0; e < GPROJT_QUESTIONS; ++e)
        GPROJT_CHECK(gprojt_ask_form(NULL, e, w, &error) == GPROJ_ERROR_ARGUMENT && strstr(error.message, "no form"));
    /* 4. The form goes on. */
    GPROJT_CHECK(gproj_solve(form, 20, NULL).outcome == GPROJ_CONVERGED);
    /* 5. After an error of the form questions tell it. */
    gproj_add_planarity(form, -1);
    for (e = 0; e < GPROJT_QUESTIONS; ++e)
        GPROJT_CHECK(gprojt_ask_form(form, e, w, &error) == gproj_form_error(form)->code &&
                     strcmp(error.message, gproj_form_error(form)->message) == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(w), free(kept), free(again);
}

GPROJT_TEST(refusals_without_equilibrium) {
    gproj_mesh *mesh = gprojt_noisy(QUADS, 3, 0.1, 1);
    double *w = gprojt_numbers(3 * mesh->vertex_count + mesh->edge_count);
    int i;
    for (i = 0; i < 4; ++i) {
        gproj_form *form = gproj_form_create(mesh, NULL);
        bool refused = i == 0   ? gproj_add_compression(form, 1, NULL, 1) == -1
                       : i == 1 ? gproj_add_tension(form, 1, NULL, 1) == -1
                       : i == 2 ? gproj_add_stress_bounds(form, 1, NULL, NULL, 0, 1, 1) == -1
                                : gproj_add_force_fairness(form, 1) == -1;
        gprojt_check_refused(form, refused, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1);
    }
    {
        gproj_form *form = gproj_form_create(mesh, NULL);
        w[0] = 1;
        GPROJT_CHECK(gproj_get_forces(form, w, NULL) == GPROJ_OK && w[0] == 0);
        for (i = 0; i < GPROJT_QUESTIONS; ++i) {
            gprojt_check_question(form, i, w, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1, "gproj_add_equilibrium before");
            gprojt_check_question(form, i, w, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1, gprojt_question_names[i]);
        }
        gproj_form_destroy(form);
    }
    gproj_mesh_destroy(mesh);
    free(w);
}

GPROJT_TEST(refusals_of_bounds) {
    static const int32_t far[2] = {0, 100000}, some[2] = {3, 7};
    static const double none[2] = {1, 0}, infinite[2] = {INFINITY, 1};
    gproj_mesh *mesh = gprojt_noisy(QUADS, 3, 0.1, 1);
    int i;
    for (i = 0; i < 13; ++i) {
        gproj_form *form = gprojt_form_with_equilibrium(mesh);
        bool refused = false, edge = i < 2 || i == 5 || i == 6 || i == 10 || i == 12;
        int64_t index = i < 2 || i == 10 ? 100000 : i == 5 ? 1 : i == 6 ? 0 : i == 12 ? 7 : -1;
        gproj_code code = i < 2 || i == 10 ? GPROJ_ERROR_INDEX : GPROJ_ERROR_ARGUMENT;
        if (i == 0) refused = gproj_add_compression(form, 2, far, 1) == -1;
        if (i == 1) refused = gproj_add_tension(form, 2, far, 1) == -1;
        if (i == 2) refused = gproj_add_compression(form, -1, far, 1) == -1;
        if (i == 3) refused = gproj_add_tension(form, mesh->edge_count + 1, NULL, 1) == -1;
        if (i == 4) refused = gproj_add_stress_bounds(form, 2, NULL, NULL, 2, 1, 1) == -1;
        if (i == 5) refused = gproj_add_stress_bounds(form, 2, NULL, none, 0, 1, 1) == -1;
        if (i == 6) refused = gproj_add_stress_bounds(form, 2, NULL, infinite, 0, 1, 1) == -1;
        if (i == 7) refused = gproj_add_stress_bounds(form, 2, NULL, NULL, NAN, 1, 1) == -1;
        if (i == 8) refused = gproj_add_stress_bounds(form, 2, NULL, NULL, INFINITY, INFINITY, 1) == -1;
        if (i == 9) refused = gproj_add_stress_bounds(form, 2, NULL, NULL, -INFINITY, -INFINITY, 1) == -1;
        if (i == 10) refused = gproj_add_stress_bounds(form, 2, far, NULL, 0, 1, 1) == -1;
        if (i == 11) refused = gproj_add_stress_bounds(form, -2, far, NULL, 0, 1, 1) == -1;
        if (i == 12) refused = gproj_add_stress_bounds(form, 2, some, none, 0, 1, 1) == -1;
        if (!refused || gproj_form_error(form)->code != code) printf("    refusal %d\n", i);
        gprojt_check_refused(form, refused, code, edge ? GPROJ_PLACE_EDGE : GPROJ_PLACE_NONE, index);
    }
    gproj_mesh_destroy(mesh);
}

/* A vertex that was put too far away leaves no loads to be measured, nor to scale given forces by. */
GPROJT_TEST(questions_need_positions) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 4, 4, 1);
    double *w = gprojt_numbers(mesh->edge_count), *kept = gprojt_numbers(mesh->edge_count);
    int32_t v = mesh->vertex_count / 2, e;
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form;
    gproj_forces forces;
    gproj_error error;
    loads.density = 1;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    GPROJT_CHECK(gproj_solve(form, 60, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_get_forces(form, kept, NULL) == GPROJ_OK);
    mesh->position[3 * v] = 1e21;
    forces = gproj_measure_forces(form, &error);
    GPROJT_CHECK(error.code == GPROJ_ERROR_NUMBER && error.place == GPROJ_PLACE_VERTEX && error.index == v);
    GPROJT_CHECK(forces.residual_vertex == -1 && forces.total_load == 0 && forces.max_force == 0);
    for (e = 0; e < mesh->edge_count; ++e) w[e] = 1;
    GPROJT_CHECK(gproj_set_forces(form, w, &error) == GPROJ_ERROR_NUMBER && error.index == v);
    GPROJT_CHECK(gproj_get_forces(form, w, NULL) == GPROJ_OK);
    GPROJT_CHECK(memcmp(w, kept, (size_t)mesh->edge_count * sizeof *w) == 0);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(w), free(kept);
}

GPROJT_TEST(no_form) {
    gproj_loads loads = gprojt_no_loads();
    gproj_supports supports = {0, NULL, NULL};
    double w[3];
    GPROJT_CHECK(gproj_add_equilibrium(NULL, &loads, &supports, 1) == -1 &&
                 gproj_add_compression(NULL, 0, NULL, 1) == -1);
    GPROJT_CHECK(gproj_add_tension(NULL, 0, NULL, 1) == -1 && gproj_add_force_fairness(NULL, 1) == -1);
    GPROJT_CHECK(gproj_add_stress_bounds(NULL, 0, NULL, NULL, 0, 1, 1) == -1);
    GPROJT_CHECK(gproj_get_forces(NULL, w, NULL) == GPROJ_ERROR_ARGUMENT &&
                 gproj_set_forces(NULL, w, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_get_loads(NULL, w, NULL) == GPROJ_ERROR_ARGUMENT &&
                 gproj_get_reactions(NULL, w, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_find_forces(NULL, w, w, NULL) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_measure_forces(NULL, NULL).residual_vertex == -1);
}

/* -- memory, workers -- */

static bool gprojt_use_forces(const gproj_host *host, void *user) {
    gproj_mesh *mesh = (gproj_mesh *)user;
    double *before = gprojt_keep(mesh), *w = gprojt_numbers(mesh->edge_count),
           *f = gprojt_numbers(3 * mesh->vertex_count);
    double *density = gprojt_numbers(mesh->edge_count), *r = gprojt_numbers(3 * mesh->vertex_count);
    const gprojt_failing *failing = gprojt_failing_of(host);
    gproj_loads loads = gprojt_no_loads();
    gproj_form *form;
    gproj_result result;
    gproj_error error;
    bool found, whole;
    int32_t i, none = 0, carrying = 0;
    for (i = 0; i < mesh->vertex_count; ++i) f[3 * i + 2] = -1;
    for (i = 0; i < mesh->edge_count; ++i) density[i] = 1;
    loads.edge_density = density, loads.point_load = f, loads.snow = 1, loads.area_load = 1;
    form = gprojt_pinned_form(mesh, host, &loads);
    for (i = 0; i < mesh->edge_count; ++i) carrying += gproj_force_variable(form, i) >= 0;
    GPROJT_CHECK(carrying > 0 || !form || gproj_form_error(form)->code == GPROJ_ERROR_MEMORY);
    gprojt_added(form, gproj_add_compression(form, mesh->edge_count, NULL, 1));
    gprojt_added(form, gproj_add_tension(form, 0, &none, 1));
    gprojt_added(form, gproj_add_stress_bounds(form, mesh->edge_count, NULL, density, -1000, 1000, 1));
    gprojt_added(form, gproj_add_force_fairness(form, 0.1));
    found = gproj_find_forces(form, w, NULL, &error) == GPROJ_OK;
    GPROJT_CHECK(found || !form || error.code == GPROJ_ERROR_MEMORY);
    if (form) gproj_get_reactions(form, r, NULL);
    result = gproj_solve(form, 3, NULL);
    if (form) gproj_get_reactions(form, r, NULL);
    whole = gproj_measure_forces(form, NULL).residual_vertex >= 0;
    GPROJT_CHECK(whole || !form || gproj_form_error(form)->code == GPROJ_ERROR_MEMORY);
    GPROJT_CHECK(!whole || found || result.outcome != GPROJ_FAILED); /* without memory for the question it is solved */
    whole = whole && found;
    GPROJT_CHECK(whole || !found || result.outcome == GPROJ_FAILED || failing->calls == failing->fail_at);
    if (result.outcome == GPROJ_FAILED) GPROJT_CHECK(gprojt_unmoved(mesh, before));
    gprojt_put_back(mesh, before);
    gproj_form_destroy(form);
    free(before), free(w), free(f), free(density), free(r);
    return whole;
}

GPROJT_TEST(every_allocation_fails_once) {
    gproj_mesh *mesh = gprojt_vault(HYBRID, 3, 10, 0); /* flat: with guidance of forces */
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_forces, mesh) >= 60);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(same_bits_for_all_workers) {
    double *first[2] = {NULL, NULL};
    int crew;
    for (crew = 0; crew < GPROJT_CREWS; ++crew) {
        gproj_host host = gprojt_crew(crew);
        gproj_mesh *mesh = gprojt_vault(QUADS, 9, 10, 3);
        double *w = gprojt_numbers(mesh->edge_count);
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form;
        loads.density = 1, loads.snow = 1;
        form = gprojt_pinned_form(mesh, &host, &loads);
        gproj_add_compression(form, mesh->edge_count, NULL, 1);
        gproj_add_planarity(form, 1);
        gproj_solve(form, 8, NULL);
        gproj_get_forces(form, w, NULL);
        if (crew == 0) first[0] = gprojt_keep(mesh), first[1] = w;
        GPROJT_CHECK(gprojt_unmoved(mesh, first[0]));
        GPROJT_CHECK(!memcmp(first[1], w, (size_t)mesh->edge_count * sizeof *w));
        if (crew) free(w);
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
    free(first[0]), free(first[1]);
}

/* Supports that may move, and circular faces: a point satisfies everything, but its loads are nothing. */
GPROJT_TEST(a_point_is_no_equilibrium) {
    int wish, each;
    for (wish = 0, each = 0; each < 4; each += wish, wish = !wish) { /* density of all edges, of each; area load, snow */
        gproj_mesh *mesh = gprojt_vault(QUADS, 6, 2, 0.6);
        double *density = gprojt_numbers(mesh->edge_count);
        int32_t corner[4], count = 0, v;
        gproj_supports supports = {0, NULL, NULL};
        gproj_loads loads = gprojt_no_loads();
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_result result;
        for (v = 0; v < mesh->vertex_count && count < 4; ++v)
            if (gproj_form_is_corner(form, v)) corner[count++] = v;
        supports.count = count, supports.vertex = corner;
        loads.density = each < 2, loads.area_load = each == 2, loads.snow = each == 3;
        for (v = mesh->edge_count / 8; v < mesh->edge_count; ++v) density[v] = 1;
        if (each == 1) loads.edge_density = density;
        gproj_add_equilibrium(form, &loads, &supports, 1);
        if (wish) gproj_add_fairness(form, 0.3);
        if (!wish) gproj_add_fixed_corners(form, 1);
        result = gproj_solve(form, 25, NULL);
        GPROJT_CHECK((result.outcome == GPROJ_CONVERGED) == !wish);
        GPROJT_CHECK(wish ||
                     gproj_measure_forces(form, NULL).residual < 1e-9); /* a point has no loads to be balanced */
        GPROJT_CHECK(wish == (strstr(result.message, "shrunk to a point") != NULL));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(density);
    }
}

/* Forces beside which the loads are nothing are no equilibrium, however small the rows are. */
GPROJT_TEST(huge_forces_are_no_equilibrium) {
    gproj_mesh *mesh = gprojt_vault(QUADS, 6, 2, 0.6);
    gproj_loads loads = gprojt_no_loads();
    double *w = gprojt_numbers(mesh->edge_count);
    gproj_form *form;
    int32_t e;
    loads.density = 1;
    form = gprojt_pinned_form(mesh, NULL, &loads);
    for (e = 0; e < mesh->edge_count; ++e) w[e] = 1e100;
    GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_solve(form, 40, NULL).outcome != GPROJ_CONVERGED);
    GPROJT_CHECK(gproj_set_forces(form, NULL, NULL) == GPROJ_OK);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(w);
}

/* Where the mesh shrinks to a point, because nothing supports it, the verdict says so; not where one vertex does. */
GPROJT_TEST(meshes_without_support) {
    int smooth;
    for (smooth = 0; smooth < 3; ++smooth) {
        gproj_mesh *mesh = gprojt_vault(QUADS, 6, 2, 0.6);
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_loads loads = gprojt_no_loads();
        gproj_supports none;
        gproj_solve_options options;
        gproj_result result;
        int32_t first = 0;
        memset(&none, 0, sizeof none);
        memset(&options, 0, sizeof options);
        loads.density = 1, options.smooth = smooth % 2;
        none.count = smooth / 2, none.vertex = &first;
        gproj_add_equilibrium(form, &loads, &none, 1);
        if (smooth == 2) gproj_add_fixed_boundary(form, 1);
        result = gproj_solve(form, 100, &options);
        GPROJT_CHECK(result.outcome != GPROJ_CONVERGED);
        GPROJT_CHECK((strstr(result.message, "has no support that could carry its loads") != NULL) == (smooth < 2));
        GPROJT_CHECK((strstr(result.message, "spoiled as well") != NULL) == (result.spoiled.total > 0));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Where all edges weigh 0 there are no loads that could have vanished, whatever their common density would be; nor without
   any loads, where forces are balanced by the tolerance alone. */
GPROJT_TEST(no_loads_have_not_vanished) {
    int way;
    for (way = 0; way < 2; ++way) {
        gproj_mesh *mesh = gprojt_vault(QUADS, 4, 2, 0.6);
        double *w = gprojt_numbers(mesh->edge_count);
        gproj_loads loads = gprojt_no_loads();
        gproj_solve_options options;
        gproj_form *form;
        int32_t e;
        memset(&options, 0, sizeof options);
        loads.density = 1;
        if (way == 0) loads.edge_density = w;
        if (way == 1) loads.density = 0, options.tolerance = 2;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        for (e = 0; e < mesh->edge_count; ++e) w[e] = 1;
        if (way == 1) GPROJT_CHECK(gproj_set_forces(form, w, NULL) == GPROJ_OK);
        GPROJT_CHECK(gproj_solve(form, way ? 0 : 20, &options).outcome == GPROJ_CONVERGED);
        GPROJT_CHECK((gproj_measure_forces(form, NULL).residual > 1e-9) == (way == 1));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(w);
    }
}

/* Loads far from 1 are found forces for; those whose squares overflow are refused, by the solve as well. */
GPROJT_TEST(loads_of_any_size) {
    static const double size[] = {1, 1e-100, 1e100, 1e200};
    int i;
    for (i = 0; i < 4; ++i) {
        gproj_mesh *mesh = gprojt_vault(TRIANGLES, 5, 10, 3);
        gproj_loads loads = gprojt_no_loads();
        double *w = gprojt_numbers(mesh->edge_count);
        bool refused = i == 3;
        gproj_form *form;
        loads.density = size[i];
        form = gprojt_pinned_form(mesh, NULL, &loads);
        GPROJT_CHECK(gproj_find_forces(form, w, NULL, NULL) == (refused ? GPROJ_ERROR_NUMBER : GPROJ_OK));
        GPROJT_CHECK(gproj_solve(form, 25, NULL).outcome == (refused ? GPROJ_FAILED : GPROJ_CONVERGED));
        GPROJT_CHECK(refused == (strstr(gproj_form_error(form)->message, "too large") != NULL));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        mesh = gprojt_vault(TRIANGLES, 5, 10, 3);
        form = gprojt_pinned_form(mesh, NULL, &loads);
        GPROJT_CHECK(gproj_solve(form, 25, NULL).outcome == (refused ? GPROJ_FAILED : GPROJ_CONVERGED));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
        free(w);
    }
}

/* Loads of which one is beyond all numbers are not told: the first such vertex is named, and the loads are 0. */
GPROJT_TEST(loads_beyond_all_numbers) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_shape(QUADS, 3));
    double *density = gprojt_numbers(mesh->edge_count), *told = gprojt_numbers(3 * mesh->vertex_count);
    gproj_loads loads = gprojt_no_loads();
    int32_t e = mesh->edge_count / 2, k, vertex, kind;
    vertex = mesh->origin[2 * e] < mesh->origin[2 * e + 1] ? mesh->origin[2 * e] : mesh->origin[2 * e + 1];
    for (k = 0; k < 3 * mesh->vertex_count; ++k) mesh->position[k] *= 1e10;
    density[e] = 1e300;
    loads.edge_density = density;
    for (kind = 0; kind < 3; ++kind) { /* an edge, faces, snow: all vertices have a face */
        gproj_form *form;
        gproj_error error;
        loads.edge_density = kind == 0 ? density : NULL;
        loads.area_load = kind == 1 ? 1e300 : 0, loads.snow = kind == 2 ? 1e300 : 0;
        form = gprojt_pinned_form(mesh, NULL, &loads);
        GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
        for (k = 0; k < 3 * mesh->vertex_count; ++k) told[k] = 7;
        GPROJT_CHECK(gproj_get_loads(form, told, &error) == GPROJ_ERROR_NUMBER);
        GPROJT_CHECK(error.place == GPROJ_PLACE_VERTEX && error.index == (kind == 0 ? vertex : 0));
        GPROJT_CHECK(strstr(error.message, "beyond all numbers; use a larger unit of force"));
        for (k = 0; k < 3 * mesh->vertex_count; ++k) GPROJT_CHECK(told[k] == 0);
        GPROJT_CHECK(gproj_get_loads(form, told, NULL) == GPROJ_ERROR_NUMBER);
        GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK);
        gproj_form_destroy(form);
    }
    gproj_mesh_destroy(mesh);
    free(density), free(told);
}

/* Loads too large for their mean are refused even if a slide takes them: nothing is told then. */
GPROJT_TEST(loads_too_large_tell_nothing) {
    static const uint8_t slides[2] = {1, 0};
    static const int32_t pins[2] = {0, 5};
    gproj_mesh *mesh = gprojt_hill(TRIANGLES, 3, 10, 2);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_supports supports = {2, pins, slides};
    gproj_loads loads = gprojt_no_loads();
    double *load = gprojt_numbers(3 * mesh->vertex_count), *answer = gprojt_numbers(3 * mesh->vertex_count);
    gproj_error error;
    load[2] = -1e200;
    loads.point_load = load;
    gproj_add_equilibrium(form, &loads, &supports, 1);
    answer[0] = answer[mesh->vertex_count - 1] = 7;
    GPROJT_CHECK(gproj_find_forces(form, NULL, answer, &error) == GPROJ_ERROR_NUMBER && answer[0] == 7);
    GPROJT_CHECK(strstr(error.message, "too large") && answer[mesh->vertex_count - 1] == 7);
    GPROJT_CHECK(gproj_find_imbalance(form, answer, &error) == GPROJ_ERROR_NUMBER && answer[0] == 7);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    free(load), free(answer);
}

int main(void) {
    GPROJT_RUN(gradients);
    GPROJT_RUN(load_rows_are_tangent);
    GPROJT_RUN(force_density_method);
    GPROJT_RUN(domes_stand_by_compression);
    GPROJT_RUN(nets_hang_by_tension);
    GPROJT_RUN(tents);
    GPROJT_RUN(tripods);
    GPROJT_RUN(stresses_stay_within_bounds);
    GPROJT_RUN(stress_bounds_of_some_edges);
    GPROJT_RUN(fair_forces);
    GPROJT_RUN(supports_of_isolated_vertices);
    GPROJT_RUN(rollers_take_nothing_along_their_slides);
    GPROJT_RUN(units_do_not_matter);
    GPROJT_RUN(best_forces);
    GPROJT_RUN(best_forces_within_active_bounds);
    GPROJT_RUN(bounds_of_ones_own_on_forces);
    GPROJT_RUN(no_loads_no_forces);
    GPROJT_RUN(funicular_shapes_and_plates);
    GPROJT_RUN(vertex_0_is_out_of_balance);
    GPROJT_RUN(plates_are_infeasible);
    GPROJT_RUN(forces_beyond_all_numbers);
    GPROJT_RUN(forces_are_kept_and_set);
    GPROJT_RUN(forces_are_variables);
    GPROJT_RUN(parts_without_support_are_named);
    GPROJT_RUN(forces_measured_one_by_one);
    GPROJT_RUN(guidance_of_forces_fades);
    GPROJT_RUN(rough_tolerances_are_met);
    GPROJT_RUN(forces_of_any_size_are_set);
    GPROJT_RUN(forces_are_set_beside_huge_loads);
    GPROJT_RUN(guidance_of_forces_is_for_their_start);
    GPROJT_RUN(equilibrium_that_is_off_is_not_missed);
    GPROJT_RUN(imbalance_is_a_proof);
    GPROJT_RUN(obstacles_are_named);
    GPROJT_RUN(contradictions_are_named);
    GPROJT_RUN(the_first_edge_may_contradict);
    GPROJT_RUN(vertices_without_weight_carry_nothing);
    GPROJT_RUN(overturned_shapes_are_told);
    GPROJT_RUN(overturned_shapes_are_told_by_their_forces);
    GPROJT_RUN(equilibrium_within_the_tolerance_is_found);
    GPROJT_RUN(overhangs_are_told);
    GPROJT_RUN(rising_plates_are_not_overturned);
    GPROJT_RUN(loads_that_either_sign_leaves_are_told);
    GPROJT_RUN(planar_faces_and_compression);
    GPROJT_RUN(weights_switch_groups_off_and_on);
    GPROJT_RUN(equilibrium_on_the_way);
    GPROJT_RUN(isolated_vertices);
    GPROJT_RUN(supports_only);
    GPROJT_RUN(no_supports);
    GPROJT_RUN(prestressed_net);
    GPROJT_RUN(a_point_is_no_equilibrium);
    GPROJT_RUN(huge_forces_are_no_equilibrium);
    GPROJT_RUN(meshes_without_support);
    GPROJT_RUN(no_loads_have_not_vanished);
    GPROJT_RUN(loads_of_any_size);
    GPROJT_RUN(loads_beyond_all_numbers);
    GPROJT_RUN(loads_too_large_tell_nothing);
    GPROJT_RUN(refusals_of_equilibrium);
    GPROJT_RUN(loads_that_nothing_carries);
    GPROJT_RUN(forces_set_between_frames);
    GPROJT_RUN(forces_refused_between_frames);
    GPROJT_RUN(refused_solves_start_no_forces);
    GPROJT_RUN(half_built_equilibrium);
    GPROJT_RUN(refused_questions_leave_the_form);
    GPROJT_RUN(refusals_without_equilibrium);
    GPROJT_RUN(refusals_of_bounds);
    GPROJT_RUN(questions_need_positions);
    GPROJT_RUN(no_form);
    GPROJT_RUN(every_allocation_fails_once);
    GPROJT_RUN(same_bits_for_all_workers);
    return gprojt_report();
}
