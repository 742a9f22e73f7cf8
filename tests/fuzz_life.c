/* fuzz_life.c - libFuzzer target for whole lives of forms: bytes choose a mesh and then calls, right and wrong ones, of
   all that is public there: builders, solves, frames, drags, states, true and forged, settings, questions.
   make -C tests fuzz FUZZ=life SECONDS=300 */
#define GPROJT_FUZZ "life"
#include "gprojt_fuzz.h"

enum {
    GPROJT_LIST = 6,
    GPROJT_CALLS = 60
};

typedef struct gprojt_life {
    gprojt_input in;
    gprojt_failing failing;
    gproj_host host;
    gproj_mesh *mesh, *first; /* as it is, and as it was when the form was made */
    gproj_surface *surface;
    gproj_curve *curve;
    gproj_form *form;
    gproj_drag *drag;
    int32_t handles;
    uint8_t *state; /* NULL: none */
    size_t state_size;
    gproj_mesh *saved; /* the positions then */
    int32_t state_groups;
    bool wrong; /* arguments may be wrong */
    gprojt_ticks ticks;
    double numbers[3 * GPROJT_LIST];
    int32_t list[GPROJT_LIST];
} gprojt_life;

static int gprojt_byte(gprojt_life *c) { return gprojt_next(&c->in); }
static bool gprojt_memory_failed(const gprojt_life *c) {
    return c->failing.fail_at > 0 && c->failing.calls >= c->failing.fail_at;
}

/* -- arguments -- */

static double gprojt_weight(gprojt_life *c) {
    static const double weights[10] = {1, 1, 1, 0.1, 0.01, 5, 0, 1e-6, 1e6, 1e50};
    int byte = gprojt_byte(c);
    if (c->wrong && byte >= 240) return byte & 1 ? NAN : -1e60;
    return weights[byte % 10];
}

static int32_t gprojt_element(gprojt_life *c, int32_t count) {
    int byte = gprojt_byte(c);
    if (c->wrong && byte >= 240) return byte == 240 ? INT32_MIN : byte < 248 ? count : -1;
    return count > 0 ? byte % count : 0;
}

/* c->list with elements, seldom none; returns their number. */
static int32_t gprojt_list(gprojt_life *c, int32_t count) {
    int32_t length = gprojt_byte(c) % (GPROJT_LIST + 1), i;
    for (i = 0; i < length; ++i) c->list[i] = gprojt_element(c, count);
    return c->wrong && gprojt_byte(c) >= 250 ? -1 : count ? length : 0;
}

/* The list, or NULL for the first `count`. */
static const int32_t *gprojt_listed(gprojt_life *c, int32_t *count, int32_t have) {
    *count = gprojt_list(c, have);
    if (gprojt_byte(c) & 1) return c->list;
    *count = *count < 0 || gprojt_byte(c) & 1 ? *count : have;
    return NULL;
}

static double gprojt_size_of(gprojt_life *c, double unit) {
    static const double parts[8] = {0, 0.3, 0.7, 0.95, 1, 1.2, 2, 5};
    int byte = gprojt_byte(c);
    if (byte >= 240) return gprojt_next_number(&c->in, c->wrong);
    return parts[byte % 8] * unit;
}

/* Positions at vertices, moved by up to a mean edge; with `wrong` seldom none. */
static const double *gprojt_positions(gprojt_life *c, int32_t count) {
    double edge = gproj_mesh_mean_edge_length(c->first);
    int32_t i;
    for (i = 0; i < 3 * count; ++i) {
        int byte = gprojt_byte(c);
        c->numbers[i] = c->first->position[i % (3 * c->first->vertex_count)] + edge * (byte - 128) / 128;
        if (byte == 255) c->numbers[i] = gprojt_next_number(&c->in, c->wrong);
    }
    return c->wrong && gprojt_byte(c) >= 250 ? NULL : c->numbers;
}

static gproj_schedule gprojt_schedule_of(gprojt_life *c) {
    static const double decays[4] = {0, 1, 0.5, 0.9};
    double weight = gprojt_weight(c), decay = decays[gprojt_byte(c) % 4];
    int32_t last = gprojt_byte(c) % 8;
    gproj_schedule schedule = last == 0 && !c->wrong ? gproj_guide(weight) : gproj_fade(weight, last);
    if (decay > 0 || c->wrong) schedule.decay = decay;
    return schedule;
}

/* -- what a form can be asked for -- */

static int32_t gprojt_add_statics(gprojt_life *c, double weight) {
    double unit = gproj_mesh_mean_edge_length(c->mesh);
    uint8_t slides[GPROJT_LIST];
    gproj_supports supports;
    gproj_loads loads;
    int32_t i, kinds = gprojt_byte(c);
    memset(&loads, 0, sizeof loads);
    if (kinds & 1) loads.density = gprojt_size_of(c, 1);
    if (kinds & 2) loads.area_load = gprojt_size_of(c, unit);
    if (kinds & 4) loads.snow = gprojt_size_of(c, unit);
    supports.count = gprojt_list(c, c->mesh->vertex_count), supports.vertex = c->list;
    for (i = 0; i < GPROJT_LIST; ++i) slides[i] = (uint8_t)(gprojt_byte(c) % (c->wrong ? 12 : 8));
    supports.slides = kinds & 8 ? slides : NULL;
    return gproj_add_equilibrium(c->form, &loads, kinds & 16 ? NULL : &supports, weight);
}

static int32_t gprojt_add_row(gprojt_life *c, double weight) {
    gproj_system *s = gproj_form_system(c->form);
    gproj_term term[GPROJT_LIST];
    gproj_group group;
    int32_t number, i, terms = gprojt_byte(c) % GPROJT_LIST;
    memset(&group, 0, sizeof group);
    group.name = "own", group.kind = (gproj_kind)(gprojt_byte(c) % 3), group.global = gprojt_byte(c) % 4 == 0;
    group.place = GPROJ_PLACE_VERTEX, group.schedule = gproj_keep(weight);
    number = gproj_system_add_group(s, &group);
    for (i = 0; i < terms; ++i) {
        term[i].i = gprojt_element(c, gproj_system_variable_count(s));
        term[i].j = gprojt_byte(c) & 1 ? -1 : gprojt_element(c, gproj_system_variable_count(s));
        term[i].a = gprojt_next_number(&c->in, c->wrong);
    }
    gproj_system_add_row(s, number, terms, term, gprojt_next_number(&c->in, c->wrong), gprojt_element(c, 100));
    return number;
}

static int32_t gprojt_add_places(gprojt_life *c, int what, double weight) {
    gproj_form *form = c->form;
    int32_t vertices = c->mesh->vertex_count, count;
    switch (what) {
    case 0: return gproj_add_planarity(form, weight);
    case 1: return count = gprojt_list(c, vertices), gproj_add_fixed(form, count, c->list, weight);
    case 2: return gproj_add_fixed_boundary(form, weight);
    case 3: return gproj_add_fixed_corners(form, weight);
    case 4:
        count = gprojt_list(c, vertices);
        return gproj_add_targets(form, count, c->list, gprojt_positions(c, count < 0 ? 0 : count), weight);
    case 5: return count = gprojt_list(c, vertices), gproj_add_gliding(form, c->curve, count, c->list, weight);
    case 6: return gproj_add_gliding_boundary(form, weight);
    case 7: return gproj_add_circularity(form, weight);
    case 8: return gproj_add_conicality(form, weight);
    case 9: return count = gprojt_list(c, vertices), gproj_add_coplanar(form, count, c->list, weight);
    case 10: return count = gprojt_list(c, vertices), gproj_add_collinear(form, count, c->list, weight);
    case 11: return gproj_add_planar_boundary(form, weight);
    case 12: return gproj_add_straight_boundary(form, weight);
    case 13: return gproj_add_orthogonal_boundary(form, weight);
    case 14: return gproj_add_lifting(form, weight);
    case 15: return gproj_add_closeness(form, weight);
    case 16: return gproj_add_reference(form, c->surface, weight);
    case 17: return gproj_add_fairness(form, weight);
    case 18: return gproj_add_boundary_fairness(form, weight);
    case 19: return gproj_add_tangential_fairness(form, weight);
    case 20: return gproj_add_gauss_fairness(form, weight);
    case 21: return gproj_add_parallelograms(form, weight);
    case 22: return gproj_add_equal_areas(form, weight);
    default: return gprojt_add_row(c, weight);
    }
}

static int32_t gprojt_add_sizes(gprojt_life *c, int what, double weight) {
    gproj_form *form = c->form;
    double edge = gproj_mesh_mean_edge_length(c->first), area = edge * edge, normal[3], lengths[GPROJT_LIST], min, max;
    int32_t count, i;
    const int32_t *list = gprojt_listed(c, &count, what == 4 ? c->mesh->face_count : c->mesh->edge_count);
    for (i = 0; i < GPROJT_LIST; ++i) lengths[i] = gprojt_size_of(c, edge);
    gprojt_next_numbers(&c->in, normal, 3, c->wrong);
    min = gprojt_size_of(c, what == 4 ? area : edge), max = gprojt_size_of(c, what == 4 ? area : edge);
    switch (what) {
    case 0: return gproj_add_lengths(form, count, list, list ? lengths : NULL, weight);
    case 1: return gproj_add_equal_lengths(form, count, list, weight);
    case 2: return gproj_add_orthogonal_edges(form, normal, count, list, weight);
    case 3: return gproj_add_length_bounds(form, count, list, min, max, weight);
    case 4: return gproj_add_area_bounds(form, count, list, min, max, weight);
    case 5: return gproj_add_volume(form, gprojt_size_of(c, gproj_volume(c->first)), weight);
    case 6: return gproj_add_total_area(form, min * edge * c->mesh->face_count, weight);
    case 7: return gproj_add_cost(form, lengths[0], lengths[1], min * edge * c->mesh->edge_count, weight);
    case 8: return gproj_add_total_area_bounds(form, min * edge * c->mesh->face_count, max * area, weight);
    case 9: return gproj_add_cost_bounds(form, lengths[0], lengths[1], min, max * c->mesh->edge_count, weight);
    case 10: return gprojt_add_statics(c, weight);
    case 11: return gproj_add_compression(form, count, list, weight);
    case 12: return gproj_add_tension(form, count, list, weight);
    case 13: return gproj_add_stress_bounds(form, count, list, list ? lengths : NULL, -min, max, weight);
    default: return gproj_add_force_fairness(form, weight);
    }
}

/* Adds a group; -1 iff the form has an error then. */
static void gprojt_add(gprojt_life *c) {
    int what = gprojt_byte(c) % 39;
    double weight = gprojt_weight(c);
    int32_t group = what < 24 ? gprojt_add_places(c, what, weight) : gprojt_add_sizes(c, what - 24, weight);
    bool well = gproj_form_error(c->form)->code == GPROJ_OK;
    GPROJT_MUST(well == (group >= 0) || what == 23);
    if (well) GPROJT_MUST(group < gproj_system_group_count(gproj_form_system(c->form)));
}

/* -- verdicts -- */

/* Each row that must hold does, asked for one by one; where vertices are is judged in fuzz_form.c. */
static void gprojt_check_holds(const gprojt_life *c, const gproj_result *result) {
    gproj_system *s = gproj_form_system(c->form);
    int32_t g, r, k, n = gproj_system_variable_count(s);
    double *gradient = (double *)malloc(((size_t)n + 1) * sizeof *gradient), *x = gproj_system_values(s);
    if (!gradient) abort();
    for (g = 0; g < gproj_system_group_count(s); ++g) {
        gproj_group_info info = gproj_system_group_info(s, g);
        if (info.kind == GPROJ_WISH || !(gprojt_inside_weight(c->form, g) > 0)) continue;
        if (gprojt_inside_is_safeguard(c->form, g)) continue; /* with a coarse tolerance it may still act at the end */
        for (r = 0; r < info.rows; ++r) {
            double phi = gproj_system_row_value(s, g, r, gradient), size = fabs(phi);
            if (!(gprojt_inside_row_weight(c->form, g, r) > 0)) continue;
            for (k = 0; k < n; ++k) size += fabs(gradient[k] * x[k]);
            if (info.kind == GPROJ_BOUND && phi > 0) phi = 0;
            GPROJT_MUST(fabs(phi) <= result->tolerance + 16 * DBL_EPSILON * size);
        }
    }
    free(gradient);
}

static void gprojt_check_result(gprojt_life *c, const gproj_result *result, const double *before, bool options_wrong) {
    int32_t n = 3 * c->mesh->vertex_count;
    GPROJT_MUST(result->message[0] && strlen(result->message) < GPROJ_MESSAGE_SIZE && !strchr(result->message, '\n'));
    if (result->outcome == GPROJ_FAILED) {
        GPROJT_MUST(options_wrong || gproj_form_error(c->form)->code != GPROJ_OK);
        if (before) GPROJT_MUST(!memcmp(before, c->mesh->position, (size_t)n * sizeof *before));
        return;
    }
    GPROJT_MUST(gproj_form_error(c->form)->code == GPROJ_OK && gprojt_all_finite(c->mesh->position, n));
    GPROJT_MUST(result->residual >= 0 && result->step >= 0 && result->step < HUGE_VAL);
    GPROJT_MUST(!strstr(result->message, "nan"));
    if (result->outcome != GPROJ_CONVERGED) return;
    GPROJT_MUST(result->residual <= result->tolerance);
    gprojt_check_holds(c, result);
}

static gproj_solve_options gprojt_options(gprojt_life *c, bool *wrong) {
    static const double tolerances[8] = {0, 0, 0, 0, 1e-9, 1e-3, -1, NAN}, epsilons[6] = {0, 0, 1e-3, 1, 1e-7, -1};
    gproj_solve_options options;
    int flags = gprojt_byte(c);
    memset(&options, 0, sizeof options);
    options.tolerance = tolerances[gprojt_byte(c) % (c->wrong ? 8 : 6)];
    options.epsilon = epsilons[gprojt_byte(c) % (c->wrong ? 6 : 5)];
    options.skip_damping = flags & 1, options.skip_closeness = flags & 2, options.skip_guard = flags & 4;
    options.nearest = flags & 16, options.smooth = flags & 32;
    if (flags & 64) options.time_budget = c->wrong && flags & 128 ? -1 : 50;
    *wrong = c->wrong;
    return options;
}

static void gprojt_solve_it(gprojt_life *c) {
    bool wrong;
    gproj_solve_options options = gprojt_options(c, &wrong);
    double *before = gprojt_keep(c->mesh);
    gproj_result result = gproj_solve(c->form, gprojt_byte(c) % 8 - (c->wrong ? 1 : 0), &options);
    gprojt_check_result(c, &result, before, wrong || c->drag);
    free(before);
}

static void gprojt_frames(gprojt_life *c) {
    bool wrong;
    gproj_solve_options options = gprojt_options(c, &wrong);
    gproj_result result;
    switch (gprojt_byte(c) % 4) {
    case 0:
        if (!gproj_solve_begin(c->form, gprojt_byte(c) % 12, &options, NULL))
            GPROJT_MUST(wrong || c->drag || gproj_form_error(c->form)->code != GPROJ_OK);
        break;
    case 1: gproj_solve_stop(c->form); break;
    case 2: gproj_solve_memory(c->form, NULL); /* fall through */
    default:
        result = gproj_solve_advance(c->form, gprojt_byte(c) % 4 * 5 - (c->wrong ? 5 : 0));
        if (result.outcome == GPROJ_FAILED) GPROJT_MUST(!gproj_solve_is_on(c->form));
        if (result.outcome != GPROJ_CONVERGED) break; /* the verdict may be old, of other weights and targets */
        GPROJT_MUST(result.residual <= result.tolerance);
    }
}

/* -- drags -- */

static void gprojt_drag_it(gprojt_life *c) {
    int32_t n = 3 * c->mesh->vertex_count;
    double *before = gprojt_keep(c->mesh);
    gproj_result result;
    gproj_error error;
    if (!c->drag) {
        gproj_drag_options options;
        gproj_handles handles;
        memset(&handles, 0, sizeof handles);
        memset(&options, 0, sizeof options);
        handles.count = c->handles = gprojt_list(c, c->mesh->vertex_count), handles.vertex = c->list;
        if (gprojt_byte(c) & 1) options.residual_bound = gprojt_size_of(c, 0.1);
        options.keep_wishes = gprojt_byte(c) & 1;
        c->drag = gproj_drag_begin(c->form, &handles, &options, &error);
        GPROJT_MUST((c->drag != NULL) == (error.code == GPROJ_OK));
        gprojt_check_error(&error);
        GPROJT_MUST(gprojt_unmoved(c->mesh, before));
    } else if (gprojt_byte(c) % 4) {
        const double *to = gprojt_positions(c, c->handles);
        gproj_code code = gproj_drag_move(c->drag, to);
        if (code != GPROJ_OK) GPROJT_MUST(gprojt_unmoved(c->mesh, before));
        if (code == GPROJ_OK) GPROJT_MUST(gprojt_all_finite(c->mesh->position, n));
        GPROJT_MUST(gproj_drag_residual(c->drag) >= 0 && gproj_drag_get_info(c->drag).freedom <= 3 * c->handles);
    } else if (gprojt_byte(c) & 1) {
        result = gproj_drag_end(c->drag);
        c->drag = NULL;
        gprojt_check_result(c, &result, NULL, true);
    } else {
        gproj_drag_cancel(c->drag);
        c->drag = NULL;
    }
    free(before);
}

/* -- states -- */

static void gprojt_save_it(gprojt_life *c) {
    size_t size = gproj_state_size(c->form);
    uint8_t *state = (uint8_t *)malloc(size + 1);
    gproj_error error;
    if (!state) abort();
    GPROJT_MUST((size == 0) == (gproj_form_error(c->form)->code != GPROJ_OK));
    if (gproj_state_save(c->form, state, size, &error) == GPROJ_OK) {
        free(c->state);
        c->state = state, c->state_size = size;
        c->state_groups = gproj_system_group_count(gproj_form_system(c->form));
        gproj_mesh_destroy(c->saved);
        c->saved = gproj_mesh_copy(c->mesh, NULL, NULL);
        if (!c->saved) abort();
    } else {
        free(state);
    }
}

/* Back to the state, or to a forgery of it. */
static void gprojt_restore_it(gprojt_life *c) {
    uint8_t *forged = (uint8_t *)malloc(c->state_size + 1);
    double *before = gprojt_keep(c->mesh);
    int changes = gprojt_byte(c) % 4;
    gproj_error error;
    gproj_code code;
    bool finite;
    if (!forged) abort();
    if (c->state) memcpy(forged, c->state, c->state_size);
    for (; c->state && c->wrong && changes > 0; --changes) {
        int32_t at = gprojt_next_of(&c->in, (int32_t)c->state_size - 8);
        forged[at] = (uint8_t)gprojt_byte(c);
        gprojt_seal(forged, c->state_size);
    }
    code = gproj_state_restore(c->form, c->state ? forged : NULL, c->state_size, &error);
    finite = gprojt_all_finite(c->mesh->position, 3 * c->mesh->vertex_count);
    GPROJT_MUST(code == error.code);
    gprojt_check_error(&error);
    if (code != GPROJ_OK) GPROJT_MUST(gprojt_unmoved(c->mesh, before));
    if (code == GPROJ_OK) GPROJT_MUST(finite && c->state);
    if (code == GPROJ_OK && !c->wrong) GPROJT_MUST(gprojt_unmoved(c->mesh, c->saved->position));
    free(forged), free(before);
}

/* -- settings and questions -- */

static void gprojt_set(gprojt_life *c) {
    int32_t groups = gproj_system_group_count(gproj_form_system(c->form)), group = gprojt_element(c, groups), count, i;
    double weights[GPROJT_LIST], *densities;
    bool well = gproj_form_error(c->form)->code == GPROJ_OK;
    switch (gprojt_byte(c) % 5) {
    case 0: gproj_set_schedule(c->form, group, gprojt_schedule_of(c)); break;
    case 1:
        for (i = 0; i < GPROJT_LIST; ++i) weights[i] = gprojt_weight(c);
        count = gprojt_list(c, 4);
        if (group >= groups && !c->wrong) break;
        if (!c->wrong && gproj_form_group_info(c->form, group).place == GPROJ_PLACE_NONE) break;
        gproj_set_element_weights(c->form, group, count, c->list, weights);
        break;
    case 2:
        for (i = 0; i < groups && strcmp(gproj_form_group_info(c->form, i).name, "targets") != 0; ++i) continue;
        if (i == groups || gproj_form_group_info(c->form, i).rows > 3 * GPROJT_LIST) break;
        gproj_set_targets(c->form, i, gprojt_positions(c, GPROJT_LIST));
        break;
    case 3:
        densities = (double *)malloc((size_t)(c->mesh->edge_count + 1) * sizeof *densities);
        if (!densities) abort();
        gprojt_next_numbers(&c->in, densities, c->mesh->edge_count, c->wrong);
        if (well && gprojt_inside_has_forces(c->form))
            gproj_set_forces(c->form, gprojt_byte(c) & 1 ? densities : NULL, NULL);
        free(densities);
        break;
    default:
        i = gprojt_next_of(&c->in, 3 * c->mesh->vertex_count);
        c->mesh->position[i] = c->first->position[i] + gprojt_next_number(&c->in, c->wrong);
    }
}

static void gprojt_ask(gprojt_life *c) {
    int32_t vertices = c->mesh->vertex_count, edges = c->mesh->edge_count;
    double *numbers = (double *)malloc((size_t)(3 * vertices + edges + 1) * sizeof *numbers);
    gproj_measures m;
    if (!numbers) abort();
    switch (gprojt_byte(c) % 4) {
    case 0:
        m = gproj_measure(c->mesh, c->first->position, NULL);
        GPROJT_MUST(m.min_edge <= m.max_edge || edges == 0 || !gprojt_all_finite(c->mesh->position, 3 * vertices));
        break;
    case 1:
        if (!gprojt_inside_has_forces(c->form)) break;
        if (gproj_get_forces(c->form, numbers, NULL) == GPROJ_OK) GPROJT_MUST(gprojt_all_finite(numbers, edges));
        gproj_get_reactions(c->form, numbers, NULL);
        gproj_get_loads(c->form, numbers, NULL);
        gproj_measure_forces(c->form, NULL);
        break;
    case 2:
        if (!gprojt_inside_has_forces(c->form)) break;
        if (gproj_find_forces(c->form, numbers, NULL, NULL) == GPROJ_OK) GPROJT_MUST(gprojt_all_finite(numbers, edges));
        if (gproj_find_imbalance(c->form, numbers, NULL) == GPROJ_OK)
            GPROJT_MUST(gprojt_all_finite(numbers, 3 * vertices));
        break;
    default: gproj_form_group_info(c->form, gprojt_byte(c) - 10); break;
    }
    free(numbers);
}

/* -- lives -- */

static void gprojt_begin_form(gprojt_life *c) {
    memcpy(c->mesh->position, c->first->position, 3 * (size_t)c->mesh->vertex_count * sizeof(double));
    c->form = gproj_form_create(c->mesh, &c->host);
    free(c->state);
    c->state = NULL, c->state_size = 0;
}

static void gprojt_end_form(gprojt_life *c) {
    if (c->drag) gproj_drag_cancel(c->drag);
    c->drag = NULL;
    gproj_form_destroy(c->form);
    c->form = NULL;
    GPROJT_MUST(c->failing.held == 0 && c->failing.bytes == 0 && c->failing.wrong_sizes == 0);
}

/* After an error nothing is done, and nothing is written. */
static void gprojt_check_sticky(gprojt_life *c) {
    double *before = gprojt_keep(c->mesh);
    gproj_error error = *gproj_form_error(c->form);
    gprojt_check_error(&error);
    GPROJT_MUST(error.code != GPROJ_ERROR_MEMORY || gprojt_memory_failed(c));
    GPROJT_MUST(gproj_add_planarity(c->form, 1) == -1 && gproj_state_size(c->form) == 0);
    GPROJT_MUST(gproj_solve(c->form, 3, NULL).outcome == GPROJ_FAILED && !gproj_solve_is_on(c->form));
    GPROJT_MUST(gprojt_unmoved(c->mesh, before) && !strcmp(error.message, gproj_form_error(c->form)->message));
    free(before);
}

static void gprojt_live(gprojt_life *c) {
    int calls;
    gprojt_begin_form(c);
    for (calls = 0; c->form && calls < GPROJT_CALLS && c->in.at < c->in.size; ++calls) {
        int what = gprojt_byte(c);
        c->wrong = what >= 192;
        switch (what % 16) {
        case 0:
        case 1:
        case 2:
        case 3: gprojt_add(c); break;
        case 4:
        case 5: gprojt_solve_it(c); break;
        case 6:
        case 7: gprojt_frames(c); break;
        case 8:
        case 9: gprojt_drag_it(c); break;
        case 10: gprojt_save_it(c); break;
        case 11:
        case 12: gprojt_restore_it(c); break;
        case 13:
        case 14: gprojt_set(c); break;
        default: gprojt_ask(c); break;
        }
        if (gproj_form_error(c->form)->code == GPROJ_OK) continue;
        if (c->drag) gproj_drag_cancel(c->drag);
        c->drag = NULL;
        gprojt_check_sticky(c);
        gprojt_end_form(c);
        gprojt_begin_form(c);
    }
    gprojt_end_form(c);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gprojt_life c;
    int fails, shape, n;
    memset(&c, 0, sizeof c);
    c.in.data = data, c.in.size = size;
    fails = gprojt_byte(&c), shape = gprojt_byte(&c) % GPROJT_SHAPES, n = 1 + gprojt_byte(&c) % 3;
    c.mesh = gprojt_mesh_of(gprojt_shape(shape, n));
    if (!c.mesh) return -1;
    gprojt_shake(c.mesh, gprojt_byte(&c) / 512.0 * gproj_mesh_mean_edge_length(c.mesh), 1);
    c.first = gproj_mesh_copy(c.mesh, NULL, NULL);
    c.surface = gproj_surface_create(c.mesh, NULL, NULL);
    c.curve =
        gproj_curve_create(c.mesh->vertex_count < 4 ? c.mesh->vertex_count : 4, c.mesh->position, true, NULL, NULL);
    if (fails >= 240) c.failing.fail_at = 1 + gprojt_next_of(&c.in, 1024);
    c.host = gprojt_failing_host(&c.failing);
    c.host.clock.now = gprojt_tick, c.host.clock.user = &c.ticks;
    gprojt_live(&c);
    gproj_curve_destroy(c.curve);
    gproj_surface_destroy(c.surface);
    gproj_mesh_destroy(c.first);
    gproj_mesh_destroy(c.saved);
    gproj_mesh_destroy(c.mesh);
    free(c.state);
    return 0;
}
