/* conical_mesh.c - a hall whose two layers have constant distance: section 3.5 of "Form-finding with Polyhedral Meshes
   Made Simple" (2014).

   A vaulted hall follows a bent street; its surface is rippled, so its quads are warped. Made planar and conical, it has a
   parallel mesh: every panel of it is at the same distance from its panel below, for glass of constant thickness. The
   beams between the two layers are flat and meet in the axes of the nodes. Writes conical_mesh.obj, conical_offset.obj
   and conical_support.obj, one quad a beam.

   Build and run:   cc -O2 conical_mesh.c -lm -o conical_mesh && ./conical_mesh
   Prints:          what holds, and how exactly the layers are parallel */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

enum { LONG = 28, WIDE = 10 };

/* An arch in the planes orthogonal to the street, with ripples that run across the lines of the mesh. */
static gproj_mesh *make_hall(gproj_error *error) {
    static double position[3 * (LONG + 1) * (WIDE + 1)];
    static int32_t degree[LONG * WIDE], corner[4 * LONG * WIDE];
    double x = 0, y = 0, turn = 0;
    int32_t i, j, faces = 0;
    for (i = 0; i <= LONG; ++i) {
        for (j = 0; j <= WIDE; ++j) {
            double *p = position + 3 * (i * (WIDE + 1) + j), angle = 2.4 * j / WIDE - 1.2;
            double ripple = 1 + 0.03 * sin(0.8 * i + 0.9 * j);
            p[0] = x - 5 * ripple * sin(angle) * sin(turn);
            p[1] = y + 5 * ripple * sin(angle) * cos(turn);
            p[2] = 4 * ripple * cos(angle);
        }
        x += cos(turn);
        y += sin(turn);
        turn += 0.1 * sin(0.2 * i);
    }
    for (i = 0; i < LONG; ++i) {
        for (j = 0; j < WIDE; ++j, ++faces) {
            int32_t a = i * (WIDE + 1) + j, *c = corner + 4 * faces;
            degree[faces] = 4;
            c[0] = a, c[1] = a + WIDE + 1, c[2] = a + WIDE + 2, c[3] = a + 1;
        }
    }
    return gproj_mesh_create((LONG + 1) * (WIDE + 1), position, faces, degree, corner, NULL, error);
}

static void say(const char *what, double value) {
    printf("%s  %s\n", what, value <= 1e-9 ? "to 1e-9: yes" : "to 1e-9: no");
}

int main(void) {
    const double distance = 0.4;
    gproj_error error;
    gproj_mesh *mesh = make_hall(&error), *offset, *support;
    gproj_measures before = gproj_measure(mesh, NULL, NULL), after;
    gproj_form *form = gproj_form_create(mesh, NULL);
    gproj_offset_measures between;
    gproj_result result;
    gproj_add_planarity(form, 1);
    gproj_add_conicality(form, 1);
    gproj_add_fairness(form, 0.01);
    gproj_add_closeness(form, 0.03);
    result = gproj_solve(form, 12, NULL);
    offset = gproj_mesh_face_offset(mesh, distance, NULL, &error);
    support = gproj_mesh_support(mesh, offset, NULL, &error);
    if (result.outcome != GPROJ_CONVERGED || !support) return printf("%s; %s\n", result.message, error.message), 1;
    after = gproj_measure(mesh, NULL, NULL);
    between = gproj_measure_offset(mesh, offset);
    printf("before             planar to %.2f, conical to %.2f\n", before.planarity_max, before.conicality_max);
    say("panels planar    ", after.planarity_max);
    say("nodes conical    ", after.conicality_max);
    say("constant distance",
        fmax(distance - between.face_distance_min, between.face_distance_max - distance) / after.mean_edge);
    say("edges parallel   ", between.parallel_max);
    say("beams planar     ", gproj_measure(support, NULL, NULL).planarity_max);
    printf("folded edges       %d, reversed %d\n", (int)after.folded_edges, (int)between.reversed_edges);
    gproj_mesh_save(mesh, "conical_mesh.obj", NULL);
    gproj_mesh_save(offset, "conical_offset.obj", NULL);
    gproj_mesh_save(support, "conical_support.obj", NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(support);
    gproj_mesh_destroy(offset);
    gproj_mesh_destroy(mesh);
    return 0;
}
