/* frame_loop.c - a game's frame loop: buffers that a graphics card can draw follow a mesh that is pulled about.

   Flat shading wants a vertex for each corner of each face, with the face's normal. Which corners make triangles and
   edges never changes; positions and normals are written anew in each frame, in place (a game's mapped memory). A host
   that counts shows that 1,000 frames take no memory. Writes frame_start.obj and frame_loop.obj. This is C and C++.

   Build and run:   cc -O2 frame_loop.c -lm -o frame_loop && ./frame_loop
   Prints:          sizes, allocations in 1,000 frames, and that the buffers agree with the mesh */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "grid.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIDE = 20,
    CORNERS = 4 * SIDE * SIDE,
    TRIANGLES = 2 * SIDE * SIDE,
    LINES = 2 * SIDE * (SIDE + 1),
    HANDLE = 8 * (SIDE + 1) + 11,
    FRAMES = 1000
};

static float position[3 * CORNERS], normal[3 * CORNERS];  /* all corners of face 0, of face 1, ... */
static uint32_t triangle[3 * TRIANGLES], line[2 * LINES]; /* corners; counter-clockwise from outside, an edge each */
static long allocations;

static void *take(void *user, size_t size) { return (void)user, ++allocations, malloc(size); }
static void give(void *user, void *block, size_t size) { (void)user, (void)size, free(block); }

static void roof(int32_t i, int32_t j, double p[3]) {
    double x = (double)i / SIDE - 0.5, y = (double)j / SIDE - 0.5;
    p[0] = SIDE * x, p[1] = SIDE * y, p[2] = SIDE * (0.15 * cos(3 * x) + 0.1 * cos(4 * y + x));
}

/* Fills the index buffers, once. Fans are right for convex faces; gproj_edit_triangulate cuts others. */
static void make_indices(const gproj_mesh *mesh) {
    static uint32_t corner_of[2 * LINES]; /* of each half-edge: where it begins */
    uint32_t corner = 0, *t = triangle;
    int32_t f, e, k, h;
    for (f = 0; f < mesh->face_count; ++f)
        for (k = 0, h = mesh->face_halfedge[f]; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
            corner_of[h] = corner++;
            if (k < 2) continue;
            t[0] = corner_of[mesh->face_halfedge[f]], t[1] = corner_of[mesh->prev[h]], t[2] = corner_of[h], t += 3;
        }
    for (e = 0; e < mesh->edge_count; ++e) {
        h = mesh->face[2 * e] >= 0 ? 2 * e : 2 * e + 1; /* the side that has a face */
        line[2 * e] = corner_of[h], line[2 * e + 1] = corner_of[mesh->next[h]];
    }
}

/* Writes positions and normals of the mesh as it is now. */
static void update(const gproj_mesh *mesh) {
    float *p = position, *n = normal;
    int32_t f, k, i, h;
    for (f = 0; f < mesh->face_count; ++f) {
        double area[3], size;
        gproj_mesh_face_area_vector(mesh, f, area);
        size = sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
        for (k = 0, h = mesh->face_halfedge[f]; k < mesh->face_degree[f]; ++k, h = mesh->next[h])
            for (i = 0; i < 3; ++i, ++p, ++n)
                *p = (float)mesh->position[3 * mesh->origin[h] + i], *n = (float)(area[i] / size);
    }
}

/* The largest difference between mesh and buffers: of faces' areas along the normals, of ends of edges. */
static double compare(const gproj_mesh *mesh) {
    double worst = 0;
    int32_t i, k;
    for (i = 0; i < TRIANGLES; i += 2) { /* the two of a quad */
        double area[3], sum = 0;
        gproj_mesh_face_area_vector(mesh, i / 2, area);
        for (k = 3 * i; k < 3 * i + 6; k += 3) {
            const float *a = position + 3 * triangle[k], *b = position + 3 * triangle[k + 1],
                        *c = position + 3 * triangle[k + 2], *n = normal + 3 * triangle[k];
            sum += 0.5 * n[0] * ((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1])) +
                   0.5 * n[1] * ((b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2])) +
                   0.5 * n[2] * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        }
        worst = fmax(worst, fabs(sum - sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2])));
    }
    for (i = 0; i < 6 * LINES; ++i) { /* lines run with the faces */
        int32_t e = i / 6, h = mesh->face[2 * e] >= 0 ? 2 * e : 2 * e + 1, v = mesh->origin[i % 6 < 3 ? h : h ^ 1];
        worst = fmax(worst, fabs(position[3 * line[2 * e + i % 6 / 3] + i % 3] - mesh->position[3 * v + i % 3]));
    }
    return worst;
}

int main(void) {
    gproj_host host = {{take, NULL, give, NULL, 0}, {NULL, NULL}, {NULL, NULL}};
    gproj_mesh *mesh = make_grid(SIDE, SIDE, roof, NULL);
    gproj_form *form = gproj_form_create(mesh, &host);
    int32_t vertex = HANDLE, frame;
    gproj_handles handles = {1, NULL, &vertex, NULL, NULL};
    gproj_drag *drag;
    double from[3], to[3], worst = 0;
    if (!mesh || gproj_mesh_save(mesh, "frame_start.obj", NULL)) return puts("no memory, or no place for the mesh"), 1;
    gproj_add_planarity(form, 1), gproj_add_fixed_corners(form, 1);
    gproj_solve(form, 20, NULL);
    make_indices(mesh);
    drag = gproj_drag_begin(form, &handles, NULL, NULL);
    memcpy(from, mesh->position + 3 * vertex, sizeof from);
    for (allocations = frame = 0; frame < FRAMES; ++frame) { /* the mouse goes round */
        to[0] = from[0], to[1] = from[1] + 0.3 * sin(0.02 * frame), to[2] = from[2] + 0.3 * sin(0.03 * frame);
        gproj_drag_move(drag, to);
        update(mesh);
        worst = fmax(worst, compare(mesh)); /* instead of drawing */
    }
    printf("%d corners, %d triangles, %d lines\n", CORNERS, TRIANGLES, LINES);
    printf("%d frames: %ld allocations, the buffers agree %s\n", FRAMES, allocations,
           worst < 1e-5 ? "to 1e-5" : "badly");
    printf("released: panels flat to 1e-12: %s\n", gproj_drag_end(drag).residual <= 1e-12 ? "yes" : "no");
    gproj_mesh_save(mesh, "frame_loop.obj", NULL);
    return gproj_form_destroy(form), gproj_mesh_destroy(mesh), 0;
}
