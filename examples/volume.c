/* volume.c - growth by a prescribed volume: Figure 5 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

   A closed mesh of quads, a house of blocks with wings and a tower, grows on its footprint: in each step it encloses
   exactly the volume that is asked for, up to 1.6 times the first, and all panels are planar. Fairness rounds it on
   the way, closeness keeps its parts. Writes volume_blocks.obj (before) and volume.obj.

   Build and run:   cc -O2 volume.c -lm -o volume && ./volume
   Prints:          the volume reached in each step, how exactly it holds, and how planar the panels are */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LONG = 16, WIDE = 14, HIGH = 9, NODES = (LONG + 1) * (WIDE + 1) * (HIGH + 1) };

/* Is the cell inside the house: a nave, wings across it, and a tower where they meet? */
static bool inside(const int cell[3]) {
    bool nave = cell[1] >= 5 && cell[1] < 9, wing = cell[0] >= 8 && cell[0] < 12;
    if (cell[0] < 0 || cell[0] >= LONG || cell[1] < 0 || cell[1] >= WIDE || cell[2] < 0) return false;
    return cell[2] < (nave && wing ? HIGH : nave || wing ? 4 : 0);
}

/* The surface of all cells inside: one quad between each cell inside and each one outside. */
static gproj_mesh *make_blocks(gproj_error *error) {
    static double position[3 * NODES];
    static int32_t number[NODES], degree[6 * NODES], corner[24 * NODES];
    int32_t vertices = 0, faces = 0;
    int cell[3], axis, side, k;
    for (k = 0; k < NODES; ++k) number[k] = -1;
    for (cell[0] = 0; cell[0] < LONG; ++cell[0])
        for (cell[1] = 0; cell[1] < WIDE; ++cell[1])
            for (cell[2] = 0; cell[2] < HIGH; ++cell[2])
                for (axis = 0; axis < 6 && inside(cell); ++axis) {
                    int next[3], a = axis / 2, b = (a + 1) % 3, c = (a + 2) % 3;
                    side = axis % 2; /* the face of the cell towards +a or -a */
                    memcpy(next, cell, sizeof next);
                    next[a] += side ? 1 : -1;
                    if (inside(next)) continue;
                    for (k = 0; k < 4; ++k) {
                        int node[3], at, turn = side ? k : 3 - k;
                        memcpy(node, cell, sizeof node);
                        node[a] += side, node[b] += turn == 1 || turn == 2, node[c] += turn >= 2;
                        at = (node[0] * (WIDE + 1) + node[1]) * (HIGH + 1) + node[2];
                        if (number[at] < 0) {
                            int i;
                            number[at] = vertices++;
                            for (i = 0; i < 3; ++i) position[3 * number[at] + i] = node[i];
                        }
                        corner[4 * faces + k] = number[at];
                    }
                    degree[faces++] = 4;
                }
    return gproj_mesh_create(vertices, position, faces, degree, corner, NULL, error);
}

/* One step of growth: planar panels, the floor in its place, this volume; fairness and closeness on the way. */
static gproj_result grow(gproj_mesh *mesh, double volume) {
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t floor[NODES], count = 0, v;
    gproj_result result;
    for (v = 0; v < mesh->vertex_count; ++v)
        if (mesh->position[3 * v + 2] < 1e-9) floor[count++] = v;
    gproj_add_planarity(form, 1);
    gproj_add_volume(form, volume, 1);
    gproj_add_fixed(form, count, floor, 1);
    gproj_add_closeness(form, 0.1);
    gproj_add_fairness(form, 0.12);
    result = gproj_solve(form, 20, NULL);
    gproj_form_destroy(form);
    return result;
}

int main(void) {
    gproj_error error;
    gproj_mesh *mesh = make_blocks(&error);
    double start, worst = 0;
    gproj_measures measures;
    int step;
    if (!mesh) return puts(error.message), 1;
    gproj_mesh_save(mesh, "volume_blocks.obj", NULL);
    start = gproj_volume(mesh);
    printf("a house of %d panels, volume %.0f\n", (int)mesh->face_count, start);
    for (step = 1; step <= 6; ++step) {
        double wanted = start * (1 + 0.1 * step);
        gproj_result result = grow(mesh, wanted);
        double off = fabs(gproj_volume(mesh) - wanted) / wanted;
        if (result.outcome != GPROJ_CONVERGED) return puts(result.message), 1;
        printf("grown to %.2f times the volume\n", gproj_volume(mesh) / start);
        if (off > worst) worst = off;
    }
    measures = gproj_measure(mesh, NULL, NULL);
    printf("volume held        %s\n", worst <= 1e-10 ? "to 1e-10" : "no");
    printf("panels planar      %s\n", measures.planarity_max <= 1e-9 ? "to 1e-9 mean edge lengths" : "no");
    printf("folded edges       %d\n", (int)measures.folded_edges);
    gproj_mesh_save(mesh, "volume.obj", NULL);
    gproj_mesh_destroy(mesh);
    return 0;
}
