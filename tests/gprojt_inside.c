/* gprojt_inside.c - the library as most tests link it, once compiled, with what they see of its inside. */
#define GUIDEDPROJ_IMPLEMENTATION
#include "gprojt_inside.h"

int32_t gprojt_inside_wide_rows(const gproj_system *system) { return system->wide_count; }
gproj_cholesky_info gprojt_inside_factor(const gproj_system *system) {
    return gproj_cholesky_get_info(system->cholesky);
}

gproj_mesh *gprojt_inside_mesh(const gproj_form *form) { return form->mesh; }
int32_t gprojt_inside_normal(const gproj_form *form, int32_t face) { return form->normal[face]; }
int32_t gprojt_inside_cone(const gproj_form *form, int32_t vertex) { return form->cone[vertex]; }
int32_t gprojt_inside_force(const gproj_form *form, int32_t edge) { return form->statics->force[edge]; }
int32_t gprojt_inside_axes(const gproj_form *form, int32_t vertex) { return form->statics->axes[vertex]; }
double gprojt_inside_load_scale(const gproj_form *form) { return form->statics->load_scale; }

bool gprojt_inside_has_forces(const gproj_form *form) { return form->statics != NULL; }
double gprojt_inside_weight(const gproj_form *form, int32_t group) { return form->system->group[group].weight; }
double gprojt_inside_row_weight(const gproj_form *form, int32_t group, int32_t row) {
    return form->system->group[group].row[row].weight;
}
bool gprojt_inside_is_safeguard(const gproj_form *form, int32_t group) {
    return form->system->group[group].role >= GPROJI_GUARD;
}

void gprojt_inside_spoil_solve(gproj_form *form) {
    memset(&form->solve, 1, sizeof form->solve); /* flags are on, but for: */
    form->solve.on = false;
}

bool gprojt_inside_refuses(const gproj_form *form, const double *before, const double *after) {
    return gproji_refuse_corners((void *)(uintptr_t)form, before, after);
}
bool gprojt_inside_refuses_turned(const gproj_form *form, const double *before, const double *after) {
    return gproji_refuse_turned((void *)(uintptr_t)form, before, after);
}

double gprojt_inside_dihedral(const gproj_form *form, int32_t edge) {
    double sharp, *x = gproj_system_values(form->system);
    return gproji_dihedral(gproji_own_part(form, GPROJI_OWN_CORNERS), x, edge, &sharp);
}

double gprojt_inside_lack(const gproj_result *result) { return gproji_lack(result); }

double gprojt_inside_volume(const gproj_mesh *mesh, const double *position, double height, double *gradient) {
    return gproji_volume(mesh, position, height, gradient, NULL);
}

void gprojt_inside_watch(gproj_form *form, bool set, double watched[6]) {
    gproji_loop *loop = &form->solve.loop;
    if (set) {
        form->system->yield = (gproji_yielding)(int)watched[0];
        loop->watch.fallen = watched[1], loop->watch.seen = (int32_t)watched[2];
        loop->watch.yield_at = (int32_t)watched[3];
        loop->trust.restless = watched[4] > 0, loop->trust.left = watched[5];
    } else {
        watched[0] = form->system->yield;
        watched[1] = loop->watch.fallen, watched[2] = loop->watch.seen;
        watched[3] = loop->watch.yield_at;
        watched[4] = loop->trust.restless, watched[5] = loop->trust.left;
    }
}

void gprojt_inside_tell_whole(gproj_result *result, const char *clause) { gproji_tell_whole(result, clause); }

void gprojt_inside_wear(gproj_edit *edit) { gproji_edit_owner(edit, NULL)->stamp = INT32_MAX - 2; }
