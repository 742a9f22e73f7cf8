/* thrust_network.c - a self-supporting mesh that is no height field: Figure 12 of "Form-finding with Polyhedral Meshes
   Made Simple" (2014).

   A horn of triangles rises from a ring on the ground and bends over to an upright mouth, so that its underside
   overhangs. Its edges carry a load by face area through compression alone, between two rings of supports. Fairness
   and tangential fairness guide with the paper's weights. Writes thrust_start.obj, thrust_network.obj and .svg (edges
   by their force).

   Build and run:   cc -O2 thrust_network.c -lm -o thrust_network && ./thrust_network
   Prints:          does every vertex stand, is every edge compressed, how much of the horn looks down */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "../tools/forces.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { AROUND = 36, ALONG = 16, RINGS = ALONG + 1 };

/* A torus-like tube with a wide foot and a wide mouth; every second ring is turned by half a step. */
static gproj_mesh *make_horn(gproj_error *error) {
    static double position[3 * RINGS * AROUND];
    static int32_t degree[2 * ALONG * AROUND], corner[6 * ALONG * AROUND];
    const double pi = 3.14159265358979;
    int32_t i, j, f = 0;
    for (i = 0; i < RINGS; ++i) {
        double t = (double)i / ALONG, bend = 0.44 * pi * t, radius = 1.35 + 1.8 * (t - 0.5) * (t - 0.5);
        for (j = 0; j < AROUND; ++j) {
            double turn = 2 * pi * (j + 0.5 * (i % 2)) / AROUND, *p = position + 3 * (i * AROUND + j);
            double out = 3.1 - radius * cos(turn);
            p[0] = -out * cos(bend);
            p[1] = radius * sin(turn);
            p[2] = out * sin(bend);
        }
    }
    for (i = 0; i < ALONG; ++i)
        for (j = 0; j < AROUND; ++j) {
            int32_t k = (j + 1) % AROUND, a = i * AROUND, b = a + AROUND, odd = i % 2;
            int32_t ring[6] = {a + j, b + (odd ? k : j), b + (odd ? j : (j + AROUND - 1) % AROUND), 0, 0, 0};
            ring[3] = a + j, ring[4] = a + k, ring[5] = b + (odd ? k : j);
            memcpy(corner + 3 * f, ring, sizeof ring);
            degree[f] = degree[f + 1] = 3;
            f += 2;
        }
    return gproj_mesh_create(RINGS * AROUND, position, f, degree, corner, NULL, error);
}

int main(void) {
    static int32_t support[2 * AROUND];
    static double density[6 * ALONG * AROUND];
    gproj_schedule wish = gproj_guide(0.05);
    gproj_loads loads = {0};
    gproj_supports supports = {2 * AROUND, support, NULL};
    gproj_error error;
    gproj_mesh *mesh = make_horn(&error);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_forces forces;
    gproj_result result;
    double area = 0, down = 0;
    int32_t i;
    if (!mesh) return puts(error.message), 1;
    gproj_mesh_save(mesh, "thrust_start.obj", NULL);
    wish.decay = 0.9;
    for (i = 0; i < AROUND; ++i) support[i] = i, support[AROUND + i] = ALONG * AROUND + i;
    loads.area_load = 1;
    gproj_add_equilibrium(form, &loads, &supports, 1);
    gproj_add_compression(form, mesh->edge_count, NULL, 1);
    gproj_add_fixed_boundary(form, 1);
    gproj_set_schedule(form, gproj_add_fairness(form, wish.weight), wish);
    gproj_set_schedule(form, gproj_add_tangential_fairness(form, wish.weight), wish);
    result = gproj_solve(form, 12, NULL);
    if (result.outcome != GPROJ_CONVERGED) return puts(result.message), 1;
    forces = gproj_measure_forces(form, NULL);
    for (i = 0; i < mesh->face_count; ++i) {
        double a[3];
        gproj_mesh_face_area_vector(mesh, i, a);
        area += sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        if (a[2] < 0) down += sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    }
    printf("every vertex stands     %s\n", forces.residual <= 1e-9 ? "to 1e-9 of its load" : "no");
    printf("compression alone       %s\n", forces.min_density >= -1e-9 * forces.max_density ? "yes" : "no");
    printf("overhang                %.0f %% of the area looks down\n", 100 * down / area);
    printf("load                    %.0f\n", forces.total_load);
    printf("largest force           %.0f %% of it\n", 100 * forces.max_force / forces.total_load);
    printf("folded edges            %d\n", (int)gproj_measure(mesh, NULL, NULL).folded_edges);
    gproj_get_forces(form, density, NULL);
    gproj_mesh_save(mesh, "thrust_network.obj", NULL);
    gprojx_picture_of_forces("thrust_network.svg", "A horn that stands by compression alone", mesh, density, 0, -52,
                             14);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return 0;
}
