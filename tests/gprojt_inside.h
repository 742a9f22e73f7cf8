/* gprojt_inside.h - what tests of the public functions see of the library's inside; gprojt_inside.c answers. */
#ifndef GPROJT_INSIDE_H
#define GPROJT_INSIDE_H

#include "../guidedproj.h"

/* How many rows a system keeps out of its matrix, and the matrix's factor. */
int32_t gprojt_inside_wide_rows(const gproj_system *system);
gproj_cholesky_info gprojt_inside_factor(const gproj_system *system);

/* The mesh of a form. */
gproj_mesh *gprojt_inside_mesh(const gproj_form *form);
/* The first variable of a face's normal, of a vertex's axis of a cone, an edge's force density; -1: it has none. */
int32_t gprojt_inside_normal(const gproj_form *form, int32_t face);
int32_t gprojt_inside_cone(const gproj_form *form, int32_t vertex);
int32_t gprojt_inside_force(const gproj_form *form, int32_t edge);
/* Bit k: the forces along axis k balance at this vertex. */
int32_t gprojt_inside_axes(const gproj_form *form, int32_t vertex);
/* The caller's unit of loads in the form's. */
double gprojt_inside_load_scale(const gproj_form *form);

/* Is there equilibrium? The weights of a group and of one of its rows in the last iteration. */
bool gprojt_inside_has_forces(const gproj_form *form);
double gprojt_inside_weight(const gproj_form *form, int32_t group);
double gprojt_inside_row_weight(const gproj_form *form, int32_t group, int32_t row);
/* Is a group the solver's own, a safeguard or a metric, which is in no residual? */
bool gprojt_inside_is_safeguard(const gproj_form *form, int32_t group);

/* How a solve has been watched: how far safeguards yield (0 to 2), the residual when its fall was looked at, the iterations
   then, those after which safeguards yield further, 1 if a step has failed while the metric rested, the part of the merit
   that the last step has left. Written to the form if `set`, else read from it. */
void gprojt_inside_watch(gproj_form *form, bool set, double watched[6]);

/* Fills all that the form keeps of its last solve with nonsense; none is on. */
void gprojt_inside_spoil_solve(gproj_form *form);

/* Do the safeguards of corners refuse a step between these variables? Does the guard of faces? */
bool gprojt_inside_refuses(const gproj_form *form, const double *before, const double *after);
bool gprojt_inside_refuses_turned(const gproj_form *form, const double *before, const double *after);
/* gproji_dihedral at the system's x. */
double gprojt_inside_dihedral(const gproj_form *form, int32_t edge);

/* Is end a of an attempt better than b? */
double gprojt_inside_lack(const gproj_result *result);

/* The volume with these positions above the plane z = height, times scale; its gradient is added (NULL: not). */
double gprojt_inside_volume(const gproj_mesh *mesh, const double *position, double height, double *gradient);

/* gproji_tell_whole. */
void gprojt_inside_tell_whole(gproj_result *result, const char *clause);

/* Wears an edit's marks as nearly 2^31 collapses do. */
void gprojt_inside_wear(gproj_edit *edit);

#endif
