/* gprojt_form.h - systems and forms for tests: rows in one line, a clock that counts, noisy meshes, failing
   allocations. */
#ifndef GPROJT_FORM_H
#define GPROJT_FORM_H

#include "gprojt_mesh.h"
#include "gprojt_threads.h"

/* -- rows -- */

static inline gproj_term gprojt_term(int32_t i, int32_t j, double a) {
    gproj_term term;
    term.i = i, term.j = j, term.a = a;
    return term;
}

/* A decay of 0: none; a `last` of 0: as long as wishes guide. */
static inline gproj_schedule gprojt_schedule(double weight, double decay, int32_t last) {
    gproj_schedule schedule = last == 0 ? gproj_guide(weight) : gproj_fade(weight, last);
    if (decay != 0) schedule.decay = decay;
    return schedule;
}

static inline int32_t gprojt_add_group(gproj_system *s, const char *name, gproj_kind kind, double weight) {
    gproj_group group;
    memset(&group, 0, sizeof group);
    group.name = name;
    group.kind = kind;
    group.place = GPROJ_PLACE_VERTEX;
    group.schedule = gproj_keep(weight);
    return gproj_system_add_group(s, &group);
}

/* The row a x_i + c. */
static inline int32_t gprojt_add_linear(gproj_system *s, int32_t group, int32_t i, double a, double c,
                                        int32_t element) {
    gproj_term term = gprojt_term(i, -1, a);
    return gproj_system_add_row(s, group, 1, &term, c, element);
}

/* The row |p - q|^2 - d^2 of the points with first variables p and q. */
static inline int32_t gprojt_add_distance(gproj_system *s, int32_t group, int32_t p, int32_t q, int32_t dimension,
                                          double d, int32_t element) {
    gproj_term term[9];
    int32_t k;
    for (k = 0; k < dimension; ++k) {
        term[3 * k] = gprojt_term(p + k, p + k, 1);
        term[3 * k + 1] = gprojt_term(q + k, q + k, 1);
        term[3 * k + 2] = gprojt_term(p + k, q + k, -2);
    }
    return gproj_system_add_row(s, group, 3 * dimension, term, -d * d, element);
}

static inline gproj_group_info gprojt_info(const gproj_system *s, int32_t group) {
    return gproj_system_group_info(s, group);
}

/* -- forms -- */

/* Gives a state that was changed the checksum of the format: for forgeries. */
static inline void gprojt_seal(uint8_t *state, size_t size) {
    uint64_t hash = 14695981039346656037u;
    size_t end = size - 8, i, k, width;
    for (i = 0; i < end; i += width) {
        uint64_t value = 0;
        width = end - i >= 8 ? 8 : 1;
        for (k = width; k > 0; --k) value = value << 8 | state[i + k - 1];
        hash = (hash ^ value) * 1099511628211u;
        hash ^= hash >> 29;
    }
    for (i = 0; i < 8; ++i) state[end + i] = (uint8_t)(hash >> 8 * i);
}

/* The form's unit of length in the mesh's. */
static inline double gprojt_unit(const gproj_form *form) {
    double centre[3], scale = 0;
    gproj_form_units(form, centre, &scale);
    return 1 / scale;
}

/* -- a clock that goes one second further each time it is read -- */

typedef struct gprojt_ticks {
    double now;
    long reads;
} gprojt_ticks;

static inline double gprojt_tick(void *user) {
    gprojt_ticks *ticks = (gprojt_ticks *)user;
    ticks->reads++;
    return ticks->now += 1;
}

/* -- meshes -- */

static inline gproj_mesh *gprojt_mesh_of(gprojt_soup soup) {
    gproj_error error;
    gproj_mesh *mesh = gprojt_soup_mesh(&soup, NULL, &error);
    if (!mesh) printf("  generator: %s\n", error.message);
    gprojt_soup_free(&soup);
    return mesh;
}

/* Moves every coordinate by at most `size`. */
static inline void gprojt_shake(gproj_mesh *mesh, double size, uint64_t seed) {
    int32_t i;
    for (i = 0; i < 3 * mesh->vertex_count; ++i) mesh->position[i] += size * (2 * gprojt_uniform(&seed) - 1);
}

/* Makes a grid of 5 x 5 a bulge with a twist, and shakes it. */
static inline void gprojt_bulge(gproj_mesh *mesh, uint64_t seed) {
    int32_t i;
    for (i = 0; i < mesh->vertex_count; ++i) {
        double x = mesh->position[3 * i] / 2.5 - 1, y = mesh->position[3 * i + 1] / 2.5 - 1;
        mesh->position[3 * i + 2] = 0.75 * (1 - x * x) * (1 - y * y) + 0.3 * x * y;
    }
    gprojt_shake(mesh, 0.07, seed);
}

/* A wavy hexagon of 4 edges a side, filled with quads that meet in threes at places, and refined. */
static inline gproj_mesh *gprojt_hexagonal_patch(int32_t levels) {
    gproj_subdivide_options how;
    gproj_mesh *coarse, *mesh;
    double point[72];
    int32_t i;
    for (i = 0; i < 24; ++i) {
        double t = (i % 4) / 4.0, from = 3.14159265358979323846 / 3 * (i / 4), to = from + 3.14159265358979323846 / 3;
        double angle = from + t * (to - from);
        point[3 * i] = 4 * ((1 - t) * cos(from) + t * cos(to));
        point[3 * i + 1] = 4 * ((1 - t) * sin(from) + t * sin(to));
        point[3 * i + 2] = 0.8 * sin(2 * angle + 0.7) + 0.25 * cos(3 * angle);
    }
    coarse = gproj_mesh_fill(24, point, NULL, NULL, NULL, NULL);
    memset(&how, 0, sizeof how);
    how.levels = levels;
    mesh = gproj_mesh_subdivide(coarse, &how, NULL, NULL, NULL);
    gproj_mesh_destroy(coarse);
    return mesh;
}

/* A generated mesh whose noise is `noise` mean edges. */
static inline gproj_mesh *gprojt_noisy(int shape, int32_t n, double noise, uint64_t seed) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_shape(shape, n));
    if (mesh) gprojt_shake(mesh, noise * gproj_mesh_mean_edge_length(mesh), seed);
    return mesh;
}

/* A copy of the positions, whether they are still the same bits, and back to them. */
static inline double *gprojt_keep(const gproj_mesh *mesh) {
    double *copy = (double *)malloc(3 * (size_t)mesh->vertex_count * sizeof *copy);
    if (!copy) abort();
    memcpy(copy, mesh->position, 3 * (size_t)mesh->vertex_count * sizeof *copy);
    return copy;
}

static inline bool gprojt_unmoved(const gproj_mesh *mesh, const double *kept) {
    return !memcmp(kept, mesh->position, 3 * (size_t)mesh->vertex_count * sizeof *kept);
}

static inline void gprojt_put_back(gproj_mesh *mesh, const double *kept) {
    memcpy(mesh->position, kept, 3 * (size_t)mesh->vertex_count * sizeof *kept);
}

/* The largest distance of vertices of two sets of positions. */
static inline double gprojt_largest_move(const double *a, const double *b, int32_t count) {
    double largest = 0;
    int32_t i;
    for (i = 0; i < count; ++i) largest = fmax(largest, gprojt_far(a + 3 * i, b + 3 * i));
    return largest;
}

static inline bool gprojt_all_finite(const double *x, int32_t count) {
    int32_t i;
    for (i = 0; i < count; ++i)
        if (!(fabs(x[i]) < HUGE_VAL)) return false;
    return true;
}

/* What a builder returns: the group, but -1 if the form has an error. */
static inline void gprojt_added(const gproj_form *form, int32_t group) {
    GPROJT_CHECK(gproj_form_error(form)->code == GPROJ_OK ? group >= 0 : group == -1);
}

/* -- failing allocations of forms: gprojt_fail_every_allocation with this, and a gprojt_solve as user -- */

typedef struct gprojt_solve {
    gproj_mesh *mesh;
    void (*build)(gproj_form *form, void *user); /* adds the groups */
    void *user;
    int32_t iterations;
    const gproj_solve_options *options;
} gprojt_solve;

/* Where the memory fails, that is the form's error and the mesh stays as it is; else it is set back. */
static inline bool gprojt_use_form(const gproj_host *host, void *user) {
    const gprojt_solve *solve = (const gprojt_solve *)user;
    gproj_mesh *mesh = solve->mesh;
    double *before = gprojt_keep(mesh);
    gproj_form *form = gproj_form_create(mesh, host);
    gproj_result result;
    bool whole;
    solve->build(form, solve->user);
    result = gproj_solve(form, solve->iterations, solve->options);
    whole = gproj_form_error(form)->code == GPROJ_OK;
    GPROJT_CHECK(whole == (result.outcome != GPROJ_FAILED));
    GPROJT_CHECK(whole || gproj_form_error(form)->code == GPROJ_ERROR_MEMORY);
    GPROJT_CHECK(whole || gprojt_unmoved(mesh, before));
    gprojt_put_back(mesh, before);
    gproj_form_destroy(form);
    free(before);
    return whole;
}

/* One solve of this mesh whose i-th allocation fails, for every i. Returns how many it takes. */
static inline long gprojt_fail_every_allocation_of_solve(gproj_mesh *mesh, void (*build)(gproj_form *form, void *user),
                                                         void *user, int32_t iterations,
                                                         const gproj_solve_options *options) {
    gprojt_solve solve;
    solve.mesh = mesh, solve.build = build, solve.user = user, solve.iterations = iterations, solve.options = options;
    return gprojt_fail_every_allocation(gprojt_use_form, &solve);
}

#endif
