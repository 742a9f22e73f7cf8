/* drag.c - pulling a vertex of a roof of flat panels: the panels stay flat (Section 2).

   Planarises a roof of 3,364 quads, takes hold of a vertex, and moves it by up to half an edge. The error of the panels
   grows with the square of the way only; the release takes it away. Then a point of a coarse cage is moved, which takes a
   whole region along. Writes drag_start.obj, drag_before.obj (flat panels), drag_vertex.obj and drag_cage.obj.

   Build and run:   cc -O2 drag.c -lm -o drag && ./drag          (./drag time: what a begin and the moves cost)
   Prints:          for each move its length, the largest error, and the error over the squared length */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "grid.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum {
    SIDE = 58,
    ACROSS = SIDE + 1,
    MIDDLE = 20 * ACROSS + 26,
    REACH = 8
};

static double seconds(void *user) {
    (void)user;
    return (double)clock() / CLOCKS_PER_SEC;
}

static void roof(int32_t i, int32_t j, double p[3]) {
    double x = (double)i / SIDE - 0.5, y = (double)j / SIDE - 0.5;
    p[0] = SIDE * x;
    p[1] = SIDE * y;
    p[2] = SIDE * (0.12 * cos(5 * x) + 0.08 * cos(4 * y + 2 * x * x));
}

/* Drags the handle up by `way` mean edges in 5 moves, and releases it. */
static gproj_result drag_up(gproj_form *form, gproj_mesh *mesh, const gproj_handles *handles, double way,
                            double iteration) {
    double begun = seconds(NULL), moving, edge = gproj_mesh_mean_edge_length(mesh), at[3], to[3];
    gproj_drag *drag = gproj_drag_begin(form, handles, NULL, NULL);
    int move, again, repeated = iteration > 0 ? 200 : 1;
    gproj_result result;
    if (iteration > 0) printf("    begin: %.2f iterations\n", (seconds(NULL) - begun) / iteration);
    memcpy(at, handles->position, sizeof at);
    memcpy(to, at, sizeof to);
    for (move = 5; move > 0; --move) { /* the longest first: what comes before a move does not matter */
        double length = way * move / 5, residual;
        to[2] = at[2] + length * edge;
        moving = seconds(NULL);
        for (again = 0; again < repeated; ++again) gproj_drag_move(drag, to);
        moving = (seconds(NULL) - moving) / repeated;
        residual = gproj_drag_residual(drag);
        printf("    moved by %.2f edges: error %.2e = %.3f length^2", length, residual, residual / length / length);
        if (iteration > 0) printf(", an iteration / %.0f", iteration / moving);
        printf("\n");
    }
    to[2] = at[2] + way * edge;
    gproj_drag_move(drag, to);
    result = gproj_drag_end(drag);
    printf("    released: %s, folded edges: %d\n",
           result.residual <= 1e-12 ? "all panels flat to 1e-12" : result.message,
           (int)gproj_measure(mesh, NULL, NULL).folded_edges);
    return result;
}

int main(int count, char **argument) { /* any argument: times, too */
    static int64_t start[2];
    static int32_t region[(2 * REACH + 1) * (2 * REACH + 1)];
    static double weight[(2 * REACH + 1) * (2 * REACH + 1)];
    int32_t vertex = MIDDLE, i, j, n = 0;
    double iteration = 0; /* seconds of one */
    gproj_host host = {{NULL, NULL, NULL, NULL, 0}, {NULL, NULL}, {seconds, NULL}};
    gproj_mesh *mesh = make_grid(SIDE, SIDE, roof, NULL);
    gproj_form *form = gproj_form_create(mesh, &host);
    gproj_handles handles = {1, NULL, &vertex, NULL, NULL};
    gproj_result result;

    if (!mesh) return puts(gproj_code_string(GPROJ_ERROR_MEMORY)), 1;
    gproj_mesh_save(mesh, "drag_start.obj", NULL);
    gproj_add_planarity(form, 1);
    gproj_add_fixed_corners(form, 1);
    gproj_add_fairness(form, 0.01);
    result = gproj_solve(form, 20, NULL);
    for (i = 1; count > 1 && argument && i < GPROJ_PHASE_COUNT; ++i) iteration += result.seconds[i] / result.iterations;
    gproj_mesh_save(mesh, "drag_before.obj", NULL);

    printf("a vertex of %d\n", (int)mesh->vertex_count);
    handles.position = mesh->position + 3 * vertex;
    result = drag_up(form, mesh, &handles, 0.5, iteration);
    gproj_mesh_save(mesh, "drag_vertex.obj", NULL);

    for (i = -REACH; i <= REACH; ++i) /* a cubic B-spline's weights would do, too */
        for (j = -REACH; j <= REACH; ++j, start[1] = ++n) {
            region[n] = MIDDLE + i * ACROSS + j;
            weight[n] = pow((1 - i * i / (double)(REACH * REACH)) * (1 - j * j / (double)(REACH * REACH)), 2);
        }
    handles.start = start, handles.vertex = region, handles.weight = weight;
    handles.position = mesh->position + 3 * MIDDLE;
    printf("a point of a cage, with %d of them\n", n);
    result = drag_up(form, mesh, &handles, 2, iteration);
    gproj_mesh_save(mesh, "drag_cage.obj", NULL);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    return result.outcome != GPROJ_CONVERGED;
}
