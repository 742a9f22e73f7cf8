/* custom_constraint.c - a constraint of your own, given as data.

   The library knows no spheres. A vertex v lies on the sphere with centre c and radius r when
       (v - c)'(v - c) - r^2 = 0,
   which is quadratic, so it can be written down as terms a x_i x_j, b x_i and a constant, in the mesh's units. r may be
   an unknown of its own, too. Together with planar faces it gives a dome of flat quads inscribed in a sphere, of the
   radius that suits it: such faces have a circumcircle, too. Writes custom_constraint_start.obj and
   custom_constraint.obj.

   Build and run:   cc -O2 custom_constraint.c -lm -o custom_constraint && ./custom_constraint
   Prints:          the radius, how far the vertices are from the sphere and the faces from planes, and the gradient check */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "grid.h"

#include <math.h>
#include <stdio.h>

enum { SIDE = 12 };

/* Places vertex (i, j) of a dome, on a grid with curved lines. */
static void dome(int32_t i, int32_t j, double p[3]) {
    double x = 8.0 * i / SIDE - 4, y = 8.0 * j / SIDE - 4;
    p[0] = x + 0.02 * y * y;
    p[1] = y;
    p[2] = 6 - 0.09 * (x * x + y * y);
}

/* Adds one row a vertex, (v'v - 2 c'v + c'c - r^2) / (2 r): so scaled, it is about the distance from the sphere. The
   centre is known; the radius is an unknown of our own, which starts at `radius`. Returns its number. */
static int32_t add_sphere(gproj_form *form, int32_t vertices, const double centre[3], double radius) {
    int32_t group = gproj_add_rows(form, "sphere", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, 1), r, v, k;
    double half = 0.5 / radius;
    r = gproj_form_add_unknowns(form, group, GPROJ_UNIT_LENGTH, 1, &radius, NULL, NULL);
    for (v = 0; v < vertices; ++v) {
        gproj_term term[7];
        double constant = 0;
        for (k = 0; k < 3; ++k) {
            term[2 * k].i = term[2 * k].j = 3 * v + k; /* v'v */
            term[2 * k].a = half;
            term[2 * k + 1].i = 3 * v + k; /* - 2 c'v */
            term[2 * k + 1].j = -1;
            term[2 * k + 1].a = -2 * half * centre[k];
            constant += half * centre[k] * centre[k];
        }
        term[6].i = term[6].j = r; /* - r^2 */
        term[6].a = -half;
        gproj_form_add_row(form, group, 7, term, constant, v);
    }
    return r;
}

int main(void) {
    static const double centre[3] = {0, 0, 0};
    double radius = 6;
    gproj_error error;
    gproj_mesh *mesh = make_grid(SIDE, SIDE, dome, &error);
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_result result;
    double worst = 0;
    int32_t v, unknown;
    gproj_mesh_save(mesh, "custom_constraint_start.obj", NULL);
    gproj_add_planarity(form, 1);
    unknown = add_sphere(form, mesh ? mesh->vertex_count : 0, centre, radius);
    printf("gradients right   %s\n", gproj_system_check_gradients(gproj_form_system(form)) < 1e-7 ? "yes" : "no");
    result = gproj_solve(form, 15, NULL);
    if (result.outcome != GPROJ_CONVERGED) {
        printf("no dome: %s\n", result.message);
        return 1;
    }
    gproj_form_get_unknowns(form, unknown, 1, &radius, NULL);
    for (v = 0; v < mesh->vertex_count; ++v) {
        const double *p = mesh->position + 3 * v;
        double off = fabs(sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - radius);
        if (off > worst) worst = off;
    }
    printf("its radius        %.2f\n", radius);
    printf("vertices on it    %s\n", worst < 1e-11 ? "to 1e-11" : "no");
    printf("faces planar      %s\n", gproj_measure(mesh, NULL, NULL).planarity_max < 1e-12 ? "to 1e-12" : "no");
    gproj_mesh_save(mesh, "custom_constraint.obj", NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return 0;
}
