/* gprojt_design.h - forms of several kinds, for the tests of what an editor does with them: drags, frames, states. */
#ifndef GPROJT_DESIGN_H
#define GPROJT_DESIGN_H

#include "gprojt_form.h"

enum {
    GPROJT_PLANAR,
    GPROJT_STANDING, /* planar and in equilibrium */
    GPROJT_CIRCULAR,
    GPROJT_GLIDING, /* planar, the boundary on its curve, the volume is kept */
    GPROJT_BOUNDED, /* planar, edges and faces not too small */
    GPROJT_PLAIN,   /* planar, and nothing is wished */
    GPROJT_DESIGNS
};

/* A roof over a square of side n, with quads and, with `noise` mean edges, warped ones. */
static inline gproj_mesh *gprojt_roof(int32_t n, double noise) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(n, n + 1));
    int32_t v;
    if (!mesh) abort();
    for (v = 0; v < mesh->vertex_count; ++v) {
        double *p = mesh->position + 3 * v, x = 2 * p[0] - 1, y = 2 * p[1] - 1;
        p[0] = n * x / 2;
        p[1] = n * y / 2;
        p[2] = 0.25 * n * (1 - 0.6 * x * x - 0.4 * y * y + 0.1 * x * x * y);
    }
    gprojt_shake(mesh, noise, 5);
    return mesh;
}

static inline void gprojt_add_standing(gproj_form *form, const gproj_mesh *mesh) {
    int32_t *pin = (int32_t *)malloc((size_t)mesh->vertex_count * sizeof *pin), v;
    gproj_supports supports;
    gproj_loads loads;
    if (!pin) abort();
    memset(&loads, 0, sizeof loads);
    memset(&supports, 0, sizeof supports);
    loads.density = 2;
    supports.vertex = pin;
    for (v = 0; v < mesh->vertex_count; ++v)
        if (gproj_mesh_is_boundary_vertex(mesh, v)) pin[supports.count++] = v;
    gproj_add_equilibrium(form, &loads, &supports, 1);
    free(pin);
}

/* Adds what must hold in a form of this kind. */
static inline void gprojt_add_design(gproj_form *form, const gproj_mesh *mesh, int design) {
    gproj_add_planarity(form, 1);
    if (design == GPROJT_PLANAR) gproj_add_fixed_corners(form, 1);
    if (design == GPROJT_STANDING) gprojt_add_standing(form, mesh);
    if (design == GPROJT_CIRCULAR) gproj_add_circularity(form, 1);
    if (design == GPROJT_GLIDING) gproj_add_gliding_boundary(form, 1);
    if (design == GPROJT_GLIDING) gproj_add_volume(form, gproj_volume(mesh), 1);
    if (design == GPROJT_BOUNDED) gproj_add_length_bounds(form, mesh->edge_count, NULL, 0.85, 1.4, 1);
    if (design == GPROJT_BOUNDED) gproj_add_area_bounds(form, mesh->face_count, NULL, 0.7, HUGE_VAL, 1);
    if (design != GPROJT_PLAIN) gproj_add_fairness(form, 0.05);
}

static inline gproj_form *gprojt_design(gproj_mesh *mesh, int design, const gproj_host *host) {
    gproj_form *form = gproj_form_create(mesh, host);
    gprojt_add_design(form, mesh, design);
    return form;
}

/* A vertex in the middle of the roof, and one beside it. */
static inline int32_t gprojt_middle(const gproj_mesh *mesh) { return mesh->vertex_count / 2; }

static inline gproj_handles gprojt_vertex_handles(int32_t count, const int32_t *vertex) {
    gproj_handles handles;
    memset(&handles, 0, sizeof handles);
    handles.count = count;
    handles.vertex = vertex;
    return handles;
}

static inline uint8_t *gprojt_save(gproj_form *form, size_t *size) {
    uint8_t *state;
    *size = gproj_state_size(form);
    state = (uint8_t *)malloc(*size + 1);
    if (!state) abort();
    GPROJT_CHECK(gproj_state_save(form, state, *size, NULL) == GPROJ_OK);
    return state;
}

#endif
