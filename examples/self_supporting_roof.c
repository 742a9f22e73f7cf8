/* self_supporting_roof.c - planar panels that stand by compression alone: Figures 1, 2 and 11 of "Form-finding with
   Polyhedral Meshes Made Simple" (2014).

   A canopy of quads on one flared foot, which overhangs its own foot: no height field. The boundary glides on its
   curves, foot and scalloped rim, and is supported there; panels become planar, edges carry the load of the panels
   through compression alone. Reference is the design, with the wishes and weights of the paper. Writes
   self_supporting_start.obj, self_supporting_roof.obj and .svg (edges by their force).

   Build and run:   cc -O2 self_supporting_roof.c -lm -o self_supporting_roof && ./self_supporting_roof
   Prints:          how planar, does it stand, how far the design moved */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "../tools/forces.h"
#include "grid.h"

#include <math.h>
#include <stdio.h>

enum { AROUND = 50, ALONG = 18, RINGS = ALONG + 1 };

/* Places vertex j of ring i: a trumpet with a foot, and a rim with five high arches. */
static void canopy(int32_t i, int32_t j, double p[3]) {
    double t = (double)i / ALONG, turn = 2 * 3.14159265358979 * j / AROUND;
    double r = 2.3 - 4.2 * t + 6.6 * t * t, z = 4.2 * sin(2.2 * t);
    p[0] = 1.15 * r * cos(turn);
    p[1] = r * sin(turn);
    p[2] = z + 0.4 * t * t * t * cos(5 * turn);
}

int main(void) {
    static int32_t support[2 * AROUND];
    static double density[2 * RINGS * AROUND];
    gproj_loads loads = {0};
    gproj_supports supports = {2 * AROUND, support, NULL};
    gproj_schedule fair = {1, 0.9, 10};
    gproj_error error;
    gproj_mesh *mesh = make_rings(ALONG, AROUND, canopy, &error), *start = gproj_mesh_copy(mesh, NULL, NULL);
    gproj_surface *design = gproj_surface_create(mesh, NULL, NULL);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_forces forces;
    gproj_measures measures;
    gproj_result result;
    int32_t i;
    if (!mesh) return puts(error.message), 1;
    if (!start) return puts(gproj_code_string(GPROJ_ERROR_MEMORY)), 1;
    gproj_mesh_save(mesh, "self_supporting_start.obj", NULL);
    for (i = 0; i < AROUND; ++i) support[i] = i, support[AROUND + i] = ALONG * AROUND + i;
    loads.area_load = 1;
    gproj_add_planarity(form, 1);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_compression(form, mesh->edge_count, NULL, 1);
    gproj_add_gliding_boundary(form, 1);
    gproj_add_reference(form, design, 0.1);
    gproj_set_schedule(form, gproj_add_fairness(form, 1), fair);
    gproj_add_equal_areas(form, 0.001);
    result = gproj_solve(form, 24, NULL);
    if (result.outcome != GPROJ_CONVERGED) return puts(result.message), 1;
    forces = gproj_measure_forces(form, NULL);
    measures = gproj_measure(mesh, start->position, NULL);
    printf("panels planar           %s\n", measures.planarity_max <= 1e-12 ? "to 1e-12 mean edge lengths" : "no");
    printf("every vertex stands     %s\n", forces.residual <= 1e-9 ? "to 1e-9 of its load" : "no");
    printf("compression alone       %s\n", forces.min_density >= -1e-9 * forces.max_density ? "yes" : "no");
    printf("largest force           %.0f %% of the load\n", 100 * forces.max_force / forces.total_load);
    printf("the design moved by     %.0f %% of its size at most\n", 100 * measures.deviation_max);
    printf("folded edges            %d\n", (int)measures.folded_edges);
    gproj_get_forces(form, density, NULL);
    gproj_mesh_save(mesh, "self_supporting_roof.obj", NULL);
    gprojx_picture_of_forces("self_supporting_roof.svg", "A canopy on a flared foot", mesh, density, 0, -58, 14);
    gproj_form_destroy(form);
    gproj_surface_destroy(design);
    gproj_mesh_destroy(start);
    gproj_mesh_destroy(mesh);
    return 0;
}
