/* subdivision_design.c - a roof from a coarse cage, which stays its handle: Figures 2 and 11 of "Form-finding with
   Polyhedral Meshes Made Simple" (2014).

   A cage of 24 quads, a hall that branches in two, is subdivided twice. Then its panels become planar, near the smooth
   surface, while the boundary glides on its curves. The design goes on with handles on two levels: a vertex of the cage
   takes a whole gate with it, a vertex of the level between only a part of an edge. The fine mesh follows by the
   stencils, and becomes planar again. Writes subdivision_cage.obj, subdivision_design.obj and subdivision_moved.obj.

   Build and run:   cc -O2 subdivision_design.c -lm -o subdivision_design && ./subdivision_design
   Prints:          for each design how far the panels are from planar, before and after, and how far they moved */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include <math.h>
#include <stdio.h>

enum { VERTICES = 37, SPANS = 6, FACES = 4 * SPANS, ARCH = 5 };

/* Arches of five points, from the ground to the ground. */
static const double points[3 * VERTICES] = {
    -10, -4,  0, -10.6, -3.6,  3.4, -11.5, 0,  5.8, -10.6, 3.6,  3.4, -10, 4,    0, /* 0: the gate of the hall */
    -5,  -4,  0, -5,    -3.3,  3.0, -5,    0,  4.4, -5,    3.3,  3.0, -5,  4,    0, /* 5 */
    0,   -5,  0, 0,     -4,    3.2, 1,     0,  4.6, 0,     4,    3.2, 0,   5,    0, /* 10: where it branches */
    4,   0,   0, 3.2,   0,     2.8,                                                 /* 15: between the branches */
    4,   -8,  0, 4.4,   -7,    2.9, 5.3,   -5, 4,   6.2,   -3,   2.9, 6.6, -2,   0, /* 17: the left branch */
    7,   -11, 0, 7.8,   -10.2, 3.2, 9.4,   -8, 5,   10.4,  -5.8, 3.2, 10,  -4.6, 0, /* 22: and its gate */
    6.6, 2,   0, 6.2,   3,     2.9, 5.3,   5,  4,   4.4,   7,    2.9, 4,   8,    0, /* 27: the right branch */
    10,  4.6, 0, 10.4,  5.8,   3.2, 9.4,   8,  5,   7.8,   10.2, 3.2, 7,   11,   0};
static const int32_t arches[2 * SPANS][ARCH] = {
    {0, 1, 2, 3, 4},      {5, 6, 7, 8, 9},      {5, 6, 7, 8, 9},      {10, 11, 12, 13, 14},
    {10, 11, 12, 16, 15}, {17, 18, 19, 20, 21}, {17, 18, 19, 20, 21}, {22, 23, 24, 25, 26},
    {15, 16, 12, 13, 14}, {27, 28, 29, 30, 31}, {27, 28, 29, 30, 31}, {32, 33, 34, 35, 36}};

static gproj_mesh *make_cage(gproj_error *error) {
    int32_t degree[FACES], corner[4 * FACES], *c = corner, s, k;
    for (s = 0; s < SPANS; ++s)
        for (k = 0; k + 1 < ARCH; ++k, c += 4) {
            const int32_t *a = arches[2 * s] + k, *b = arches[2 * s + 1] + k;
            c[0] = a[0], c[1] = b[0], c[2] = b[1], c[3] = a[1];
            degree[4 * s + k] = 4;
        }
    return gproj_mesh_create(VERTICES, points, FACES, degree, corner, NULL, error);
}

/* Makes the panels planar, near the surface as it is, and prints how that went. */
static bool make_planar(gproj_mesh *mesh, const char *name) {
    gproj_surface *surface = gproj_surface_create(mesh, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    double before = gproj_measure(mesh, NULL, NULL).planarity_max, off = 0;
    gproj_measures after;
    gproj_result result;
    int32_t v;
    gproj_add_planarity(form, 1);
    gproj_add_gliding_boundary(form, 1);
    gproj_add_reference(form, surface, 0.1);
    gproj_add_fairness(form, 0.02);
    gproj_add_tangential_fairness(form, 0.05);
    result = gproj_solve(form, 30, NULL);
    gproj_form_destroy(form);
    if (result.outcome != GPROJ_CONVERGED) return puts(result.message), false;
    for (v = 0; v < mesh->vertex_count; ++v)
        off = fmax(off, gproj_surface_closest(surface, mesh->position + 3 * v).distance);
    gproj_surface_destroy(surface);
    after = gproj_measure(mesh, NULL, NULL);
    printf("%-22s off planar by %.3f mean edge lengths\n", name, before);
    printf("  is planar            %s\n", after.planarity_max <= 1e-12 ? "to 1e-12 mean edge lengths" : "no");
    printf("  off the design by    %.2f mean edge lengths at most\n", off / after.mean_edge);
    printf("  folded or crossed    %d\n", (int)(after.folded_edges + after.bow_tie_faces));
    return true;
}

/* Moves a handle: fine += stencil * (d at the handle, 0 elsewhere). Returns how many vertices follow. */
static int move(gproj_mesh *fine, const gproj_stencil *stencil, int32_t handle, const double d[3]) {
    gproj_stencil *handles = gproj_stencil_transpose(stencil, NULL, NULL);
    int64_t k;
    int i;
    if (!handles) return 0;
    for (k = handles->start[handle]; k < handles->start[handle + 1]; ++k)
        for (i = 0; i < 3; ++i) fine->position[3 * handles->column[k] + i] += handles->weight[k] * d[i];
    i = (int)(handles->start[handle + 1] - handles->start[handle]);
    gproj_stencil_destroy(handles);
    return i;
}

int main(void) {
    const double lift[3] = {-2, 0, 2}, bend[3] = {0.5, -0.7, 0.3};
    gproj_subdivide_options options = {0};
    gproj_stencil *from_cage, *from_middle;
    gproj_error error;
    gproj_mesh *cage = make_cage(&error), *fine, *other;
    int many, few;
    if (!cage) return puts(error.message), 1;
    options.levels = 2;
    fine = gproj_mesh_subdivide(cage, &options, &from_cage, NULL, &error);
    options.stencil_level = 1; /* the same mesh, with its stencil from the level between */
    other = gproj_mesh_subdivide(cage, &options, &from_middle, NULL, &error);
    if (!fine || !other) return puts(error.message), 1;
    gproj_mesh_save(cage, "subdivision_cage.obj", NULL);
    printf("a cage of %d quads becomes %d panels\n", (int)cage->face_count, (int)fine->face_count);
    if (!make_planar(fine, "the subdivided cage")) return 1;
    gproj_mesh_save(fine, "subdivision_design.obj", NULL);
    many = move(fine, from_cage, 2, lift);  /* the top of the hall's gate */
    few = move(fine, from_middle, 24, bend); /* the top of a branch's gate: the cage's vertices keep their numbers */
    printf("handles: a vertex of the cage moves %d vertices, one of the level between %d\n", many, few);
    if (!make_planar(fine, "after moving handles")) return 1;
    gproj_mesh_save(fine, "subdivision_moved.obj", NULL);
    gproj_stencil_destroy(from_cage), gproj_stencil_destroy(from_middle);
    gproj_mesh_destroy(cage), gproj_mesh_destroy(other), gproj_mesh_destroy(fine);
    return 0;
}
