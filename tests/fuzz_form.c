/* fuzz_form.c - libFuzzer target for forms: bytes choose a small mesh, what must hold, what is wished, and solves.
   make -C tests fuzz FUZZ=form SECONDS=300 */
#define GPROJT_FUZZ "form"
#include "gprojt_fuzz.h"

enum {
    GPROJT_ASKS = 8,
    GPROJT_LIST = 4,
    GPROJT_CURVE = 6
};

/* What a group was asked for, to be measured without the form. */
typedef struct gprojt_ask {
    int what;
    int32_t group, count;
    int32_t vertex[GPROJT_LIST];
    double position[3 * GPROJT_LIST];
    double min, max; /* of lengths, areas, a cost; infinite: none */
    bool partly;     /* some of its elements have other weights */
} gprojt_ask;

typedef struct gprojt_case {
    const uint8_t *data;
    size_t size, at;
    gproj_mesh *mesh, *first; /* as it is, and as it was when the form was made */
    gproj_form *form;
    gproj_surface *surface;
    gproj_curve *curve;
    int32_t curve_count;
    double point[3 * (GPROJT_CURVE + 1)]; /* of the curve, a closed one with its first point at the end */
    gprojt_ask ask[GPROJT_ASKS];
    int asks;
    bool cancel;
    bool beyond; /* a point of the bytes has a coordinate beyond 1e70 */
    gproj_loads loads;
    double *density, *point_load, *forces; /* as many as edges, coordinates, edges */
} gprojt_case;

static int gprojt_byte(gprojt_case *c) { return c->at < c->size ? c->data[c->at++] : 0; }
static int gprojt_choose(gprojt_case *c, int count) { return gprojt_byte(c) % count; }

/* -- the mesh -- */

/* Faces by their corners: mostly no mesh. */
static gprojt_soup gprojt_soup_of_bytes(gprojt_case *c) {
    gprojt_soup s;
    int32_t vertices = 3 + gprojt_choose(c, 10), faces = 1 + gprojt_choose(c, 8), i, f;
    memset(&s, 0, sizeof s);
    for (i = 0; i < vertices; ++i) gprojt_add_vertex(&s, cos(7.0 * i), sin(5.0 * i), cos(3.0 * i * i));
    for (f = 0; f < faces; ++f) {
        int32_t corner[6], degree = 3 + gprojt_choose(c, 4);
        for (i = 0; i < degree; ++i) corner[i] = gprojt_choose(c, vertices);
        gprojt_add_face(&s, degree, corner);
    }
    return s;
}

static void gprojt_place(gprojt_case *c, gproj_mesh *mesh) {
    static const double noises[8] = {0, 1e-3, 0.02, 0.1, 0.1, 0.3, 1, 5}, scales[5] = {1, 1, 1e-3, 1e4, 1e40};
    static const double shifts[4] = {0, 0, 10, 1e5};
    double edge = gproj_mesh_mean_edge_length(mesh), scale, shift;
    int32_t i, way = gprojt_byte(c);
    gprojt_shake(mesh, noises[way % 8] * edge, (uint64_t)gprojt_byte(c));
    if (way & 8) /* two vertices in one place */
        memcpy(mesh->position, mesh->position + 3 * gprojt_choose(c, mesh->vertex_count), 3 * sizeof(double));
    if (way & 16) /* narrow */
        for (i = 0; i < mesh->vertex_count; ++i) mesh->position[3 * i + 1] *= 1e-6;
    for (i = 0; (way & 96) == 96 && i < mesh->vertex_count; ++i) mesh->position[3 * i + 2] = 0; /* flat */
    scale = scales[gprojt_choose(c, 5)], shift = shifts[gprojt_choose(c, 4)] * edge;
    for (i = 0; i < 3 * mesh->vertex_count; ++i) mesh->position[i] = scale * (mesh->position[i] + shift);
}

static gproj_mesh *gprojt_mesh_of_bytes(gprojt_case *c) {
    int kind = gprojt_choose(c, GPROJT_SHAPES + 3);
    gprojt_soup s = kind < GPROJT_SHAPES ? gprojt_shape(kind, 1 + gprojt_choose(c, 3)) : gprojt_soup_of_bytes(c);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gprojt_soup_free(&s);
    if (mesh) gprojt_place(c, mesh);
    return mesh;
}

/* A point somewhere at the mesh: a vertex, moved by up to a mean edge. */
static void gprojt_point_of_bytes(gprojt_case *c, double out[3]) {
    double edge = gproj_mesh_mean_edge_length(c->mesh);
    int k;
    memcpy(out, c->mesh->position + 3 * gprojt_choose(c, c->mesh->vertex_count), 3 * sizeof *out);
    for (k = 0; k < 3; ++k) {
        out[k] += edge * (gprojt_byte(c) - 128) / 128;
        c->beyond = c->beyond || fabs(out[k]) > 1e70;
    }
}

static void gprojt_curve_of_bytes(gprojt_case *c) {
    int32_t count = 2 + gprojt_choose(c, GPROJT_CURVE - 1), i;
    bool closed = gprojt_choose(c, 2);
    for (i = 0; i < count; ++i) gprojt_point_of_bytes(c, c->point + 3 * i);
    c->curve = gproj_curve_create(count, c->point, closed, NULL, NULL);
    memcpy(c->point + 3 * count, c->point, 3 * sizeof(double));
    c->curve_count = count + closed;
}

/* -- what is asked for -- */

enum {
    GPROJT_PLANAR,
    GPROJT_FIX,
    GPROJT_FIX_BOUNDARY,
    GPROJT_FIX_CORNERS,
    GPROJT_TARGET,
    GPROJT_GLIDE,
    GPROJT_GLIDE_BOUNDARY,
    GPROJT_CLOSE,
    GPROJT_REFER,
    GPROJT_FAIR,
    GPROJT_FAIR_BOUNDARY,
    GPROJT_FAIR_TANGENTIAL,
    GPROJT_FAIR_GAUSS,
    GPROJT_LENGTHS,
    GPROJT_AREAS,
    GPROJT_COST,
    GPROJT_TOTAL_AREA,
    GPROJT_TOTAL_COST,
    GPROJT_TOTAL_AREA_BOUNDS,
    GPROJT_VOLUME,
    GPROJT_EQUAL_LENGTHS,
    GPROJT_EQUAL_AREAS,
    GPROJT_CIRCULAR,
    GPROJT_CONICAL,
    GPROJT_EQUILIBRIUM,
    GPROJT_COMPRESSION,
    GPROJT_TENSION,
    GPROJT_STRESS,
    GPROJT_FAIR_FORCES,
    GPROJT_OWN,
    GPROJT_WHATS
};

static double gprojt_weight_of_bytes(gprojt_case *c) {
    static const double weights[10] = {1, 1, 1, 0.1, 0.01, 5, 0, 1e-6, 1e6, 1e50};
    return weights[gprojt_choose(c, 10)];
}

/* A global row of one's own: the mean of all x is 0, with as many rows for the squares as the byte says. */
static int32_t gprojt_own_rows(gproj_form *form, int32_t vertices, double weight) {
    gproj_system *s = gproj_form_system(form);
    gproj_term term[3 * 64];
    gproj_group group;
    int32_t number, i, count = vertices < 64 ? vertices : 64;
    memset(&group, 0, sizeof group);
    group.name = "own", group.global = true, group.place = GPROJ_PLACE_VERTEX, group.schedule = gproj_keep(weight);
    number = gproj_system_add_group(s, &group);
    for (i = 0; i < count; ++i) term[i] = gprojt_term(3 * i, -1, 1.0 / count);
    gproj_system_add_row(s, number, count, term, 0, 0);
    for (i = 0; i < count; ++i) term[i] = gprojt_term(3 * i + 1, 3 * i + 1, 1.0 / count);
    gproj_system_add_row(s, number, count, term, -1, 1);
    return number;
}

/* -- forces -- */

static double *gprojt_random_numbers(gprojt_case *c, int32_t count, double size) {
    double *numbers = (double *)malloc(((size_t)count + 1) * sizeof *numbers);
    uint64_t seed = (uint64_t)gprojt_byte(c);
    int32_t i;
    if (!numbers) abort();
    for (i = 0; i < count; ++i) numbers[i] = size * (2 * gprojt_uniform(&seed) - 1);
    return numbers;
}

/* Loads of up to about 1 a vertex, or of another size; some vertices are supports, some of these slide. */
static int32_t gprojt_add_equilibrium(gprojt_case *c, gprojt_ask *a, double weight) {
    static const double sizes[5] = {1, 1, 1e3, 1e-20, 1e20};
    double edge = gproj_mesh_mean_edge_length(c->mesh), unit, size = sizes[gprojt_choose(c, 5)];
    uint8_t slides[GPROJT_LIST];
    gproj_supports supports;
    int32_t i, kinds = gprojt_byte(c);
    if (c->form && gprojt_inside_has_forces(c->form)) return -1;
    unit = edge > 0 ? edge : 1;
    free(c->density), free(c->point_load);
    memset(&c->loads, 0, sizeof c->loads);
    c->density = gprojt_random_numbers(c, c->mesh->edge_count, size / unit);
    c->point_load = gprojt_random_numbers(c, 3 * c->mesh->vertex_count, size);
    if (kinds & 1) c->loads.density = size / unit;
    if (kinds & 2) c->loads.area_load = size / (unit * unit);
    if (kinds & 4) c->loads.snow = (kinds & 8 ? -1 : 1) * size / (unit * unit);
    if (kinds & 16) c->loads.edge_density = c->density;
    if (kinds & 32) c->loads.point_load = c->point_load;
    for (i = 0; i < a->count; ++i) slides[i] = (uint8_t)gprojt_choose(c, 8);
    supports.count = a->count, supports.vertex = a->vertex, supports.slides = kinds & 64 ? slides : NULL;
    return gproj_add_equilibrium(c->form, &c->loads, &supports, weight);
}

static int32_t gprojt_add_stress(gprojt_case *c, double weight) {
    static const double mins[4] = {-INFINITY, -1, 0, 0.1}, maxs[4] = {0.1, 1, 100, INFINITY};
    double min = mins[gprojt_choose(c, 4)], max = maxs[gprojt_choose(c, 4)];
    return gproj_add_stress_bounds(c->form, c->mesh->edge_count, NULL, NULL, min, max, weight);
}

/* What is asked of forces; nothing before there are any. */
static int32_t gprojt_ask_of_forces(gprojt_case *c, const gprojt_ask *a, double weight) {
    int32_t edges[GPROJT_LIST], i;
    if (!c->form || !gprojt_inside_has_forces(c->form)) return -1;
    for (i = 0; i < a->count; ++i) edges[i] = c->mesh->edge_count ? gprojt_choose(c, c->mesh->edge_count) : 0;
    if (a->what == GPROJT_STRESS) return gprojt_add_stress(c, weight);
    if (a->what == GPROJT_FAIR_FORCES) return gproj_add_force_fairness(c->form, weight);
    if (a->what == GPROJT_TENSION) return gproj_add_tension(c->form, c->mesh->edge_count ? a->count : 0, edges, weight);
    return gproj_add_compression(c->form, c->mesh->edge_count, NULL, weight);
}

/* What may be asked and given before and after a solve. */
static void gprojt_ask_forces(gprojt_case *c) {
    int32_t n = c->mesh->vertex_count, e;
    double *loads, *residuals;
    gproj_forces m;
    int way = gprojt_byte(c);
    if (!c->form || !gprojt_inside_has_forces(c->form) || gproj_form_error(c->form)->code != GPROJ_OK) return;
    loads = gprojt_random_numbers(c, 3 * n, 1);
    residuals = gprojt_random_numbers(c, n, 1);
    free(c->forces);
    c->forces = gprojt_random_numbers(c, c->mesh->edge_count, way & 4 ? 1e3 : 1);
    if (way & 1 && gproj_find_forces(c->form, c->forces, residuals, NULL) == GPROJ_OK)
        GPROJT_MUST(gprojt_all_finite(c->forces, c->mesh->edge_count) && gprojt_all_finite(residuals, n));
    if (way & 2) gproj_set_forces(c->form, way & 8 ? NULL : c->forces, NULL);
    if (gproj_get_reactions(c->form, loads, NULL) == GPROJ_OK) {
        m = gproj_measure_forces(c->form, NULL);
        GPROJT_MUST(gprojt_all_finite(loads, 3 * n) && m.residual >= 0 && m.residual < HUGE_VAL);
        GPROJT_MUST(m.load_path >= 0 && m.max_reaction >= 0 && m.min_force <= m.max_force);
        GPROJT_MUST(gproj_get_forces(c->form, c->forces, NULL) == GPROJ_OK);
        for (e = 0; e < c->mesh->edge_count; ++e) GPROJT_MUST(fabs(c->forces[e]) < HUGE_VAL);
    }
    free(loads), free(residuals);
}

/* The largest component of an unbalanced force, computed from positions, forces and loads; beyond rounding. */
static double gprojt_off_balance(const gprojt_case *c) {
    int32_t n = 3 * c->mesh->vertex_count, e, k;
    double *sum = (double *)malloc(((size_t)n + 1) * sizeof *sum),
           *size = (double *)calloc((size_t)n + 1, sizeof *size);
    double *w = (double *)malloc(((size_t)c->mesh->edge_count + 1) * sizeof *w), off = 0;
    if (!sum || !size || !w) abort();
    GPROJT_MUST(gproj_get_loads(c->form, sum, NULL) == GPROJ_OK && gproj_get_forces(c->form, w, NULL) == GPROJ_OK);
    for (e = 0; e < n; ++e) size[e] = fabs(sum[e]);
    for (e = 0; e < c->mesh->edge_count; ++e) {
        for (k = 0; k < 3; ++k) {
            int32_t i = 3 * c->mesh->origin[2 * e] + k, j = 3 * c->mesh->origin[2 * e + 1] + k;
            double force = w[e] * (c->mesh->position[i] - c->mesh->position[j]);
            double about = fabs(w[e]) * (fabs(c->mesh->position[i]) + fabs(c->mesh->position[j]));
            sum[i] += force, sum[j] -= force;
            size[i] += about, size[j] += about;
        }
    }
    for (e = 0; e < n; ++e)
        if (gprojt_inside_axes(c->form, e / 3) >> (e % 3) & 1)
            off = fmax(off, fabs(sum[e]) - 256 * DBL_EPSILON * size[e]);
    free(sum), free(size), free(w);
    return off;
}

static int32_t gprojt_ask_for(gprojt_case *c, gprojt_ask *a, double weight) {
    static const double parts[4] = {0.7, 1, 1.2, 3};
    double part = parts[a->count % 4], total = part * (a->max < INFINITY ? a->max : 1);
    switch (a->what) {
    case GPROJT_PLANAR: return gproj_add_planarity(c->form, weight);
    case GPROJT_FIX: return gproj_add_fixed(c->form, a->count, a->vertex, weight);
    case GPROJT_FIX_BOUNDARY: return gproj_add_fixed_boundary(c->form, weight);
    case GPROJT_FIX_CORNERS: return gproj_add_fixed_corners(c->form, weight);
    case GPROJT_TARGET: return gproj_add_targets(c->form, a->count, a->vertex, a->position, weight);
    case GPROJT_GLIDE: return gproj_add_gliding(c->form, c->curve, a->count, a->vertex, weight);
    case GPROJT_GLIDE_BOUNDARY: return gproj_add_gliding_boundary(c->form, weight);
    case GPROJT_CLOSE: return gproj_add_closeness(c->form, weight);
    case GPROJT_REFER: return gproj_add_reference(c->form, c->surface, weight);
    case GPROJT_FAIR: return gproj_add_fairness(c->form, weight);
    case GPROJT_FAIR_BOUNDARY: return gproj_add_boundary_fairness(c->form, weight);
    case GPROJT_FAIR_TANGENTIAL: return gproj_add_tangential_fairness(c->form, weight);
    case GPROJT_FAIR_GAUSS: return gproj_add_gauss_fairness(c->form, weight);
    case GPROJT_LENGTHS: return gproj_add_length_bounds(c->form, c->mesh->edge_count, NULL, a->min, a->max, weight);
    case GPROJT_AREAS: return gproj_add_area_bounds(c->form, c->mesh->face_count, NULL, a->min, a->max, weight);
    case GPROJT_COST: return gproj_add_cost_bounds(c->form, 1, 0.5, a->min, a->max, weight);
    case GPROJT_TOTAL_AREA: return gproj_add_total_area(c->form, total, weight);
    case GPROJT_TOTAL_COST: return gproj_add_cost(c->form, 0.3, a->count % 2, total, weight);
    case GPROJT_TOTAL_AREA_BOUNDS: return gproj_add_total_area_bounds(c->form, a->min, a->max, weight);
    case GPROJT_VOLUME: return gproj_add_volume(c->form, part * gproj_volume(c->mesh), weight);
    case GPROJT_EQUAL_LENGTHS: return gproj_add_equal_lengths(c->form, c->mesh->edge_count, NULL, weight);
    case GPROJT_EQUAL_AREAS: return gproj_add_equal_areas(c->form, weight);
    case GPROJT_CIRCULAR: return gproj_add_circularity(c->form, weight);
    case GPROJT_CONICAL: return gproj_add_conicality(c->form, weight);
    case GPROJT_EQUILIBRIUM: return gprojt_add_equilibrium(c, a, weight);
    case GPROJT_COMPRESSION:
    case GPROJT_TENSION:
    case GPROJT_STRESS:
    case GPROJT_FAIR_FORCES: return gprojt_ask_of_forces(c, a, weight);
    default: return gprojt_own_rows(c->form, c->mesh->vertex_count, weight);
    }
}

static void gprojt_schedule_of_bytes(gprojt_case *c, int32_t group) {
    static const double decays[4] = {0, 1, 0.5, 0.9};
    double weight = gprojt_weight_of_bytes(c), decay = decays[gprojt_choose(c, 4)];
    int32_t last = gprojt_choose(c, 6);
    gproj_schedule schedule = last == 0   ? gproj_guide(weight)
                              : last == 5 ? gproj_keep(weight)
                                          : gproj_fade(weight, last);
    if (decay > 0) schedule.decay = decay;
    gproj_set_schedule(c->form, group, schedule);
}

static void gprojt_bounds_of_bytes(gprojt_case *c, gprojt_ask *a) {
    static const double mins[4] = {0, 0.3, 0.9, 1}, maxs[4] = {INFINITY, 1, 1.3, 4};
    double edge = gproj_mesh_mean_edge_length(c->mesh), unit = edge;
    if (a->what == GPROJT_AREAS) unit = edge * edge;
    if (a->what == GPROJT_TOTAL_AREA || a->what == GPROJT_TOTAL_AREA_BOUNDS) unit = c->mesh->face_count * edge * edge;
    if (a->what == GPROJT_COST || a->what == GPROJT_TOTAL_COST)
        unit = c->mesh->edge_count * edge + 0.5 * c->mesh->face_count * edge * edge;
    a->min = mins[gprojt_choose(c, 4)] * unit, a->max = maxs[gprojt_choose(c, 4)] * unit;
    if (!(a->max > 0)) a->max = INFINITY; /* a mesh without edges */
}

/* Other weights for some elements of a group. */
static void gprojt_weigh_elements(gprojt_case *c, gprojt_ask *a) {
    static const double weights[5] = {0, 0, 1, 0.5, 1e3};
    int32_t element[GPROJT_LIST], i, count = 1 + gprojt_choose(c, GPROJT_LIST), have;
    gproj_group_info info = gproj_form_group_info(c->form, a->group);
    double weight[GPROJT_LIST];
    have = info.place == GPROJ_PLACE_EDGE ? c->mesh->edge_count : c->mesh->vertex_count;
    if (info.place == GPROJ_PLACE_FACE) have = c->mesh->face_count;
    if (info.place == GPROJ_PLACE_NONE || have == 0) return;
    for (i = 0; i < count; ++i) element[i] = gprojt_choose(c, have), weight[i] = weights[gprojt_choose(c, 5)];
    a->partly = true;
    gproj_set_element_weights(c->form, a->group, count, element, weight);
}

static void gprojt_add_ask(gprojt_case *c) {
    gprojt_ask *a = &c->ask[c->asks];
    double weight;
    bool listed;
    int32_t i;
    memset(a, 0, sizeof *a);
    a->what = gprojt_choose(c, GPROJT_WHATS);
    weight = gprojt_weight_of_bytes(c);
    a->count = gprojt_choose(c, GPROJT_LIST + 1);
    listed =
        a->what == GPROJT_FIX || a->what == GPROJT_TARGET || a->what == GPROJT_GLIDE || a->what == GPROJT_EQUILIBRIUM;
    for (i = 0; listed && i < a->count; ++i) {
        a->vertex[i] = gprojt_choose(c, c->mesh->vertex_count);
        if (a->what == GPROJT_TARGET) gprojt_point_of_bytes(c, a->position + 3 * i);
    }
    if (a->what >= GPROJT_LENGTHS && a->what <= GPROJT_TOTAL_AREA_BOUNDS) gprojt_bounds_of_bytes(c, a);
    if ((a->what == GPROJT_GLIDE && !c->curve) || (a->what == GPROJT_REFER && !c->surface)) return;
    a->group = gprojt_ask_for(c, a, weight);
    if (a->group < 0 && gproj_form_error(c->form)->code == GPROJ_OK) return; /* forces before there are any */
    if (a->group >= 0 && gprojt_choose(c, 4) == 0) gprojt_schedule_of_bytes(c, a->group);
    if (a->group >= 0 && gprojt_choose(c, 8) == 1) gprojt_weigh_elements(c, a);
    c->asks++;
}

/* -- what came of it -- */

/* The distance from a segment, computed in another way than the library does. */
static double gprojt_off_segment(const double *a, const double *b, const double *p) {
    double low = 0, high = 1, q[3];
    int i, k;
    for (i = 0; i < 200; ++i) { /* by ternary search */
        double at[2], far[2];
        int side;
        at[0] = low + (high - low) / 3, at[1] = high - (high - low) / 3;
        for (side = 0; side < 2; ++side) {
            for (k = 0; k < 3; ++k) q[k] = a[k] + at[side] * (b[k] - a[k]) - p[k];
            far[side] = gprojt_dot3(q, q);
        }
        if (far[0] < far[1])
            high = at[1];
        else
            low = at[0];
    }
    for (k = 0; k < 3; ++k) q[k] = a[k] + low * (b[k] - a[k]);
    return fmin(gprojt_far(q, p), fmin(gprojt_far(a, p), gprojt_far(b, p)));
}

static double gprojt_off_loops(const gproj_mesh *first, const double *p) {
    double off = HUGE_VAL;
    int32_t h;
    for (h = 0; h < first->halfedge_count; ++h)
        if (first->face[h] < 0)
            off = fmin(off, gprojt_off_segment(first->position + 3 * first->origin[h],
                                               first->position + 3 * first->origin[first->twin[h]], p));
    return off;
}

static double gprojt_off_points(const gprojt_case *c, const double *p) {
    double off = HUGE_VAL;
    int32_t i;
    for (i = 0; i + 1 < c->curve_count; ++i)
        off = fmin(off, gprojt_off_segment(c->point + 3 * i, c->point + 3 * i + 3, p));
    return off;
}

/* How far the vertices are from where the ask wants them, in the mesh's units. */
static double gprojt_off(const gprojt_case *c, const gprojt_ask *a) {
    double off = 0;
    int32_t v, i;
    for (i = 0; i < a->count; ++i) {
        const double *p = c->mesh->position + 3 * a->vertex[i];
        if (a->what == GPROJT_FIX) off = fmax(off, gprojt_far(p, c->first->position + 3 * a->vertex[i]));
        if (a->what == GPROJT_TARGET) off = fmax(off, gprojt_far(p, a->position + 3 * i));
        if (a->what == GPROJT_GLIDE) off = fmax(off, gprojt_off_points(c, p));
    }
    for (v = 0; v < c->mesh->vertex_count; ++v) {
        const double *p = c->mesh->position + 3 * v;
        double move = gprojt_far(p, c->first->position + 3 * v);
        bool boundary = gproj_mesh_is_boundary_vertex(c->mesh, v), corner = gproj_form_is_corner(c->form, v);
        if (a->what == GPROJT_FIX_BOUNDARY && boundary) off = fmax(off, move);
        if (a->what == GPROJT_FIX_CORNERS && corner) off = fmax(off, move);
        if (a->what == GPROJT_GLIDE_BOUNDARY && boundary)
            off = fmax(off, corner ? move : gprojt_off_loops(c->first, p));
    }
    return off;
}

/* How far edges are from their bounds, as the rows of gproj_add_length_bounds say it, in the mesh's units. */
static double gprojt_off_bounds(const gproj_mesh *mesh, const gprojt_ask *a) {
    double off = 0;
    int32_t e;
    for (e = 0; a->what == GPROJT_LENGTHS && e < mesh->edge_count; ++e) {
        double length = gprojt_edge_length(mesh, e);
        if (a->min > 0) off = fmax(off, (a->min - length) * (a->min + length) / (2 * a->min));
        if (a->max < INFINITY) off = fmax(off, (length - a->max) * (length + a->max) / (2 * a->max));
    }
    return off;
}

/* Asking again may give the same group. */
static bool gprojt_is_partly(const gprojt_case *c, int32_t group) {
    int32_t i;
    for (i = 0; i < c->asks; ++i)
        if (c->ask[i].group == group && c->ask[i].partly) return true;
    return false;
}

/* "All constraints hold", in the form's units, to the tolerance and the rounding of the coordinates. */
static void gprojt_check_converged(const gprojt_case *c, const gproj_result *result) {
    double centre[3], scale, size = 1, slack, *planarity, edge = gproj_mesh_mean_edge_length(c->mesh);
    int32_t i, f;
    gproj_form_units(c->form, centre, &scale);
    for (i = 0; i < 3 * c->mesh->vertex_count; ++i)
        size = fmax(size, scale * (fabs(c->mesh->position[i]) + fabs(c->first->position[i])));
    for (i = 0; i < 3 * c->curve_count; ++i) size = fmax(size, scale * fabs(c->point[i]));
    slack = 2 * result->tolerance + 64 * DBL_EPSILON * size;
    for (i = 0; i < c->asks; ++i) { /* a group that has no weight at the end is not asked for */
        if (c->ask[i].group < 0 || !(gprojt_inside_weight(c->form, c->ask[i].group) > 0)) continue;
        if (gprojt_is_partly(c, c->ask[i].group)) continue;
        GPROJT_MUST(scale * gprojt_off(c, &c->ask[i]) <= slack);
        if (c->ask[i].what == GPROJT_EQUILIBRIUM)
            GPROJT_MUST(gprojt_inside_load_scale(c->form) * gprojt_off_balance(c) <= slack * (1 + size));
        GPROJT_MUST(scale * gprojt_off_bounds(c->mesh, &c->ask[i]) <= slack * (1 + size));
        if (c->ask[i].what != GPROJT_PLANAR) continue;
        planarity = (double *)malloc(((size_t)c->mesh->face_count + 1) * sizeof *planarity);
        gproj_measure(c->mesh, NULL, planarity);
        for (f = 0; f < c->mesh->face_count; ++f)
            GPROJT_MUST(scale * (edge > 0 ? edge : 1) * planarity[f] <= slack * pow(c->mesh->face_degree[f], 1.5));
        free(planarity);
    }
}

static bool gprojt_on_form_iteration(void *user, gproj_system *s, const gproj_iteration *iteration) {
    gprojt_case *c = (gprojt_case *)user;
    int what = gprojt_byte(c);
    GPROJT_MUST(iteration->residual >= 0 && iteration->step >= 0 && iteration->step < HUGE_VAL);
    GPROJT_MUST(iteration->length > 0 && iteration->length <= 2 && iteration->factorisations >= 1);
    if (what < 16 && c->asks) gprojt_schedule_of_bytes(c, c->ask[what % c->asks].group);
    if (what == 16) return false;
    return gproj_system_error(s)->code == GPROJ_OK;
}

/* What may be refused: the Gauss image before planarity, vertices and targets that are too far away, and loads on
   vertices without edges. */
static void gprojt_check_refusal(const gprojt_case *c, const gproj_error *error) {
    double centre[3], scale;
    bool known = error->code == GPROJ_ERROR_STATE, beyond = c->beyond;
    int32_t i;
    gproj_form_units(c->form, centre, &scale);
    for (i = 0; i < 3 * c->mesh->vertex_count; ++i)
        beyond = beyond || scale * fabs(c->mesh->position[i] - centre[i % 3]) > 1e20;
    known = known || (beyond && error->code == GPROJ_ERROR_NUMBER);
    known = known || (error->place == GPROJ_PLACE_VERTEX && strstr(error->message, "no edge that could carry it") &&
                      c->mesh->vertex_halfedge[error->index] < 0);
    if (!known) fprintf(stderr, "%s\n", error->message);
    GPROJT_MUST(known);
}

static void gprojt_solve_once(gprojt_case *c, bool memory_fails) {
    static const double tolerances[8] = {0, 0, 0, 1e-9, 1e-3, 0.4, -1, NAN}, epsilons[5] = {0, 0, 1e-3, 1, 1e-7};
    int32_t iterations = gprojt_choose(c, 7), n = 3 * c->mesh->vertex_count;
    double *before = gprojt_keep(c->mesh);
    gproj_solve_options options;
    gproj_result result;
    bool wrong;
    int flags = gprojt_byte(c);
    memset(&options, 0, sizeof options);
    options.tolerance = tolerances[gprojt_choose(c, 8)];
    options.epsilon = epsilons[gprojt_choose(c, 5)];
    options.skip_damping = flags & 1, options.skip_closeness = flags & 2, options.skip_guard = flags & 4;
    options.nearest = flags & 16, options.smooth = flags & 32;
    if (flags & 8) options.on_iteration = gprojt_on_form_iteration, options.user = c;
    if (flags == 255) options.time_budget = 1; /* without a clock */
    wrong = !(options.tolerance >= 0) || options.time_budget > 0;
    result = gproj_solve(c->form, iterations, &options);
    GPROJT_MUST(gprojt_all_finite(c->mesh->position, n));
    if (options.nearest && options.smooth) iterations *= 4; /* smooth attempts may follow */
    GPROJT_MUST(result.iterations >= 0 && result.iterations <= iterations && result.damped <= result.iterations);
    GPROJT_MUST(result.message[0] && strlen(result.message) < GPROJ_MESSAGE_SIZE && !strchr(result.message, '\n'));
    if (result.outcome == GPROJ_FAILED) {
        GPROJT_MUST(wrong || gproj_form_error(c->form)->code != GPROJ_OK);
        GPROJT_MUST(!memcmp(before, c->mesh->position, (size_t)n * sizeof *before));
    } else {
        GPROJT_MUST(!wrong && gproj_form_error(c->form)->code == GPROJ_OK && !strstr(result.message, "nan"));
        GPROJT_MUST(result.residual >= 0 && result.step >= 0 && result.step < HUGE_VAL);
    }
    if (!memory_fails && gproj_form_error(c->form)->code != GPROJ_OK)
        gprojt_check_refusal(c, gproj_form_error(c->form));
    GPROJT_MUST(result.outcome != GPROJ_CONVERGED || (result.residual <= result.tolerance));
    if (result.outcome == GPROJ_CONVERGED) gprojt_check_converged(c, &result);
    free(before);
}

/* Vertices and handles are moved for the next solve. */
static void gprojt_move_on(gprojt_case *c) {
    int32_t i, k, moves = gprojt_choose(c, 4);
    for (i = 0; i < moves; ++i) {
        double p[3];
        gprojt_point_of_bytes(c, p);
        memcpy(c->mesh->position + 3 * gprojt_choose(c, c->mesh->vertex_count), p, sizeof p);
    }
    for (i = 0; i < c->asks; ++i) {
        gprojt_ask *a = &c->ask[i];
        if (a->group < 0 || a->what != GPROJT_TARGET || gprojt_choose(c, 2)) continue;
        for (k = 0; k < a->count; ++k) gprojt_point_of_bytes(c, a->position + 3 * k);
        gproj_set_targets(c->form, a->group, a->position);
    }
    if (c->asks && gprojt_choose(c, 3) == 0) gprojt_schedule_of_bytes(c, c->ask[gprojt_choose(c, c->asks)].group);
    if (c->asks < GPROJT_ASKS && gprojt_choose(c, 4) == 0) gprojt_add_ask(c);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gprojt_failing failing;
    gproj_host host;
    gprojt_case c;
    int fails, asks, solves;
    memset(&c, 0, sizeof c);
    memset(&failing, 0, sizeof failing);
    c.data = data, c.size = size;
    c.mesh = gprojt_mesh_of_bytes(&c);
    if (!c.mesh) return -1;
    c.first = gproj_mesh_copy(c.mesh, NULL, NULL);
    c.surface = gproj_surface_create(c.mesh, NULL, NULL);
    gprojt_curve_of_bytes(&c);
    fails = gprojt_byte(&c);
    if (fails >= 224) failing.fail_at = 1 + 2 * (fails - 224) + gprojt_byte(&c);
    host = gprojt_failing_host(&failing);
    c.form = gproj_form_create(c.mesh, &host);
    for (asks = 1 + gprojt_choose(&c, GPROJT_ASKS - 1); asks > 0; --asks) gprojt_add_ask(&c);
    for (solves = 1 + gprojt_choose(&c, 3); c.form && solves > 0; --solves) {
        gprojt_ask_forces(&c);
        gprojt_solve_once(&c, failing.fail_at > 0);
        gprojt_ask_forces(&c);
        gprojt_move_on(&c);
    }
    gproj_form_destroy(c.form);
    GPROJT_MUST(failing.held == 0 && failing.bytes == 0 && failing.wrong_sizes == 0);
    gproj_curve_destroy(c.curve);
    gproj_surface_destroy(c.surface);
    gproj_mesh_destroy(c.first);
    gproj_mesh_destroy(c.mesh);
    free(c.density), free(c.point_load), free(c.forces);
    return 0;
}
