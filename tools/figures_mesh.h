/* figures_mesh.h - the meshes of the figures: like the paper's, which are not public, in kind and size.

   Cages and grids are placed by functions, subdivided, and cut along diagonals of their quads; curves are filled. If a
   mesh cannot be made the program ends. Include guidedproj.h before this file. */
#ifndef FIGURES_MESH_H
#define FIGURES_MESH_H

#include "../examples/grid.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TURN 6.283185307179586

static gproj_mesh *must(gproj_mesh *mesh, const gproj_error *error) {
    if (!mesh) fprintf(stderr, "figures: %s\n", error->message), exit(3);
    return mesh;
}

static void *must_have(void *memory) {
    if (!memory) fputs("figures: out of memory\n", stderr), exit(3);
    return memory;
}

static double *copy_positions(const gproj_mesh *mesh) {
    size_t size = 3 * sizeof(double) * (size_t)(mesh->vertex_count + 1);
    return memcpy(must_have(malloc(size)), mesh->position, size - 3 * sizeof(double));
}

/* ---- grids, cages, cuts ---- */

static gproj_mesh *grid(int32_t rows, int32_t columns, bool closed, void (*place)(int32_t, int32_t, double p[3])) {
    gproj_error error;
    return must(make_quads(rows, columns, closed, place, &error), &error);
}

/* Subdivides the cage by Catmull and Clark's scheme; the cage stays. */
static gproj_mesh *subdivide(const gproj_mesh *cage, int32_t levels) {
    gproj_subdivide_options options = {0};
    gproj_error error;
    options.levels = levels;
    return must(gproj_mesh_subdivide(cage, &options, NULL, NULL, &error), &error);
}

/* The number of edges on the way from the seed to each vertex. */
static int32_t *count_steps(const gproj_mesh *mesh, int32_t seed) {
    int32_t *steps = must_have(malloc(sizeof *steps * (size_t)mesh->vertex_count)), i, n, k, begun = 0, ended = 1;
    int32_t *queue = must_have(malloc(sizeof *queue * (size_t)mesh->vertex_count)), ring[64];
    for (i = 0; i < mesh->vertex_count; ++i) steps[i] = INT32_MAX;
    steps[seed] = 0, queue[0] = seed;
    while (begun < ended) {
        i = queue[begun++];
        n = gproj_mesh_one_ring(mesh, i, ring, 64);
        for (k = 0; k < n && k < 64; ++k)
            if (steps[ring[k]] == INT32_MAX) steps[ring[k]] = steps[i] + 1, queue[ended++] = ring[k];
    }
    free(queue);
    return steps;
}

/* Cuts out the vertices that are fewer than `radius` steps from the seed. In a quad mesh the cut runs along diagonals:
   a quad that loses one corner stays as a triangle, others vanish. Destroys the mesh. */
static gproj_mesh *cut_along_diagonals(gproj_mesh *mesh, int32_t seed, int32_t radius) {
    int32_t *steps = count_steps(mesh, seed), *number = must_have(calloc((size_t)mesh->vertex_count, sizeof *number));
    int32_t *degree = must_have(malloc(sizeof *degree * (size_t)mesh->face_count)), f, h, k, faces = 0, vertices = 0;
    int32_t *corner = must_have(malloc(sizeof *corner * (size_t)mesh->halfedge_count)), corners = 0;
    double *position = must_have(malloc(3 * sizeof *position * (size_t)mesh->vertex_count));
    gproj_error error;
    gproj_mesh *cut;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t kept = 0;
        for (k = 0, h = mesh->face_halfedge[f]; k < mesh->face_degree[f]; ++k, h = mesh->next[h])
            if (steps[mesh->origin[h]] >= radius) corner[corners + kept++] = mesh->origin[h];
        if (kept < 3) continue;
        for (k = corners; k < corners + kept; ++k) number[corner[k]] = 1;
        degree[faces++] = kept, corners += kept;
    }
    for (k = 0; k < mesh->vertex_count; ++k) {
        if (!number[k]) continue;
        memcpy(position + 3 * vertices, mesh->position + 3 * k, 3 * sizeof *position);
        number[k] = vertices++;
    }
    for (k = 0; k < corners; ++k) corner[k] = number[corner[k]];
    cut = must(gproj_mesh_create(vertices, position, faces, degree, corner, NULL, &error), &error);
    free(steps), free(number), free(degree), free(corner), free(position);
    gproj_mesh_destroy(mesh);
    return cut;
}

static int32_t nearest_vertex(const gproj_mesh *mesh, double x, double y, double z) {
    int32_t i, best = 0;
    double least = INFINITY;
    for (i = 0; i < mesh->vertex_count; ++i) {
        const double *p = mesh->position + 3 * i;
        double away = hypot(hypot(p[0] - x, p[1] - y), p[2] - z);
        if (away < least) least = away, best = i;
    }
    return best;
}

/* Cuts at several vertices of the mesh. */
static gproj_mesh *cut_all(gproj_mesh *mesh, int32_t count, const int32_t *seed, const int32_t *radius) {
    double place[8][3];
    int32_t k;
    for (k = 0; k < count; ++k) memcpy(place[k], mesh->position + 3 * seed[k], sizeof place[k]);
    for (k = 0; k < count; ++k)
        mesh = cut_along_diagonals(mesh, nearest_vertex(mesh, place[k][0], place[k][1], place[k][2]), radius[k]);
    return mesh;
}

/* A noise of -0.5 .. 0.5 that is the same everywhere. */
static double noise(int32_t i) {
    uint32_t bits = (uint32_t)i * 2654435761u + 12345u;
    bits ^= bits >> 15, bits *= 2246822519u, bits ^= bits >> 13, bits *= 3266489917u, bits ^= bits >> 16;
    return bits / 4294967296.0 - 0.5;
}

/* ---- Figures 1 and 2: a pavilion around a court ---- */

enum {
    PAVILION_AROUND = 10
};

static void pavilion_cage(int32_t i, int32_t j, double p[3]) {
    static const double radius[4] = {2.7, 0.9, 6.6, 9.8}, height[4] = {0, 4.6, 7.6, 0};
    double turn = TURN * (j + 0.5) / PAVILION_AROUND;
    p[0] = 1.2 * radius[i] * cos(turn), p[1] = radius[i] * sin(turn), p[2] = height[i];
}

/* Four arches of 8 steps around, two doors of 3 to the court: 25 * 80 - 4 * 64 - 2 * 9 = 1726 vertices. */
static gproj_mesh *make_pavilion(gproj_mesh **cage) {
    static const int32_t radius[] = {8, 8, 8, 8, 3, 3};
    int32_t seed[6], k;
    gproj_mesh *mesh;
    *cage = grid(3, PAVILION_AROUND, true, pavilion_cage);
    mesh = subdivide(*cage, 3);
    for (k = 0; k < 4; ++k) seed[k] = nearest_vertex(mesh, 11.8 * cos(TURN / 4 * k), 9.8 * sin(TURN / 4 * k), 0);
    seed[4] = nearest_vertex(mesh, 2, 2, 0), seed[5] = nearest_vertex(mesh, -2, -2, 0);
    return cut_all(mesh, 6, seed, radius);
}

/* ---- Figure 11: a shell for a stage ---- */

static void stage_cage(int32_t i, int32_t j, double p[3]) {
    double x = i / 6.0 * 2 - 1, y = j / 5.0 * 2 - 1;
    p[0] = 11 * x * sqrt(1 - 0.35 * y * y), p[1] = 9 * y * sqrt(1 - 0.35 * x * x);
    p[2] = 6.5 * (1 - pow(x, 4)) * (1 - pow(y, 4));
    if (i == 6) p[2] = 3.4 * (1 - y * y);
}

/* Four corners cut by 4 steps, a door of 2: 25 * 21 - 4 * 10 - 4 = 481 vertices. */
static gproj_mesh *make_stage(gproj_mesh **cage) {
    static const int32_t radius[5] = {4, 4, 4, 4, 2};
    int32_t seed[5] = {0, 5, 36, 41, 0};
    gproj_mesh *mesh;
    *cage = grid(6, 5, false, stage_cage);
    mesh = subdivide(*cage, 2);
    seed[4] = nearest_vertex(mesh, -11, 0, 0);
    return cut_all(mesh, 5, seed, radius);
}

/* ---- Figure 3: a carpet of triangles and quads ---- */

enum {
    CARPET_LONG = 44,
    CARPET_WIDE = 39
};

static void carpet(int32_t i, int32_t j, double p[3]) {
    double x = i, y = j - 0.5 * CARPET_WIDE;
    p[0] = x, p[1] = y + 0.05 * y * cos(TURN * x / 60);
    p[2] = 2.6 * sin(0.16 * x) - 0.012 * y * y + 1.8 * sin(0.11 * y + 0.08 * x);
}

static void restless_carpet(int32_t i, int32_t j, double p[3]) {
    carpet(i, j, p);
    if (i > 0 && j > 0 && i < CARPET_LONG && j < CARPET_WIDE) p[2] += 0.5 * noise(64 * i + j);
}

/* Four corners cut by 5, 4, 3 and 2 steps: 45 * 40 - 15 - 10 - 6 - 3 = 1766 vertices. */
static gproj_mesh *make_carpet(bool restless) {
    static const int32_t corner[4] = {0, CARPET_WIDE, CARPET_LONG * (CARPET_WIDE + 1),
                                      CARPET_LONG * (CARPET_WIDE + 1) + CARPET_WIDE};
    static const int32_t radius[4] = {5, 4, 3, 2};
    gproj_mesh *mesh = cut_all(grid(CARPET_LONG, CARPET_WIDE, false, restless ? restless_carpet : carpet), 4, corner,
                               radius),
               *mixed;
    gproj_edit *edit = gproj_edit_create(mesh, NULL, NULL);
    int32_t f, faces;
    for (f = 0, faces = mesh->face_count; f < faces; ++f)
        if ((int32_t)(mesh->position[3 * mesh->origin[mesh->face_halfedge[f]]] + 0.5) % 3 == 1)
            gproj_edit_triangulate(edit, f, NULL);
    mixed = must_have(gproj_edit_mesh(edit, NULL, NULL));
    gproj_edit_destroy(edit), gproj_mesh_destroy(mesh);
    return mixed;
}

/* ---- Figures 4 and 13: curves that are filled ---- */

enum {
    CURVE_POINTS = 720
};

static void make_curve(double *curve) {
    int32_t i;
    for (i = 0; i < CURVE_POINTS; ++i) {
        double turn = TURN * i / CURVE_POINTS, r = 10 + 1.5 * cos(3 * turn) + 1.2 * sin(turn);
        curve[3 * i] = r * cos(turn), curve[3 * i + 1] = r * sin(turn), curve[3 * i + 2] = 0;
    }
}

/* Fills the curve with quads; these of its points are corners. */
static gproj_mesh *fill_curve(int32_t corners, const int32_t *corner, double edge) {
    static double curve[3 * CURVE_POINTS];
    gproj_fill_options options = {0};
    gproj_error error;
    make_curve(curve);
    options.corner_count = corners, options.corners = corner;
    options.edge_length = edge;
    return must(gproj_mesh_fill(CURVE_POINTS, curve, &options, NULL, NULL, &error), &error);
}

enum {
    BEAN_LONG = 25,
    BEAN_WIDE = 10,
    BEAN_AROUND = 2 * (BEAN_LONG + BEAN_WIDE),
    BEAN_RINGS = 11
};

/* A bean filled with rings around a grid: 70 * 11 + 26 * 11 = 1056 vertices, the boundary first. */
static gproj_mesh *make_bean(void) {
    static const int32_t corner[] = {0, BEAN_LONG, BEAN_LONG + BEAN_WIDE, 2 * BEAN_LONG + BEAN_WIDE};
    double curve[3 * BEAN_AROUND] = {0};
    gproj_fill_options options = {0};
    gproj_error error;
    int32_t j;
    for (j = 0; j < BEAN_AROUND; ++j) {
        double turn = TURN * (j - BEAN_LONG - 0.5 * BEAN_WIDE) / BEAN_AROUND;
        turn += 0.12 * sin(2 * turn); /* about equal distances */
        curve[3 * j] = 14 * cos(turn), curve[3 * j + 1] = 8 * sin(turn) - 1.5 * cos(2 * turn);
    }
    options.corner_count = 4, options.corners = corner;
    options.rings = BEAN_RINGS;
    options.keep_points = true;
    return must(gproj_mesh_fill(BEAN_AROUND, curve, &options, NULL, NULL, &error), &error);
}

/* ---- Figure 7: a dome over a court ---- */

enum {
    COURT = 28 /* steps along the diagonals of the court */
};

/* Quads whose diagonals are parallel to the walls. */
static void court(int32_t i, int32_t j, double p[3]) {
    double x = 2.0 * (i + j) / COURT - 2, y = 2.0 * (j - i) / COURT;
    p[0] = 14 * x, p[1] = 10 * y, p[2] = 6 * cos(TURN / 4 * x) * cos(TURN / 4 * y);
}

/* A grid that stands on its corner, cut by the walls along diagonals. */
static gproj_mesh *make_court(void) {
    static const int32_t corner[4] = {0, COURT, COURT * (COURT + 1), COURT * (COURT + 1) + COURT};
    static const int32_t radius[4] = {COURT / 2, COURT / 2, COURT / 2, COURT / 2};
    return cut_all(grid(COURT, COURT, false, court), 4, corner, radius);
}

/* ---- Figure 8: a canopy on five feet ---- */

static gproj_mesh *make_star(void) {
    double position[3 * 11] = {0, 0, 5};
    int32_t degree[5] = {4, 4, 4, 4, 4}, corner[20], s;
    gproj_error error;
    for (s = 0; s < 5; ++s) {
        double *side = position + 3 * (1 + 2 * s), *foot = side + 3, turn = TURN * s / 5;
        side[0] = 10 * cos(turn), side[1] = 10 * sin(turn), side[2] = 3.2;
        foot[0] = 15 * cos(turn + TURN / 10), foot[1] = 15 * sin(turn + TURN / 10), foot[2] = -3.4;
        corner[4 * s] = 0, corner[4 * s + 1] = 1 + 2 * s;
        corner[4 * s + 2] = 2 + 2 * s, corner[4 * s + 3] = 1 + 2 * ((s + 1) % 5);
    }
    return must(gproj_mesh_create(11, position, 5, degree, corner, NULL, &error), &error);
}

/* Each foot is a diagonal: 1 + 5 * 16 * 17 - 5 * 45 = 1136 vertices. */
static gproj_mesh *make_canopy(void) {
    static const int32_t foot[5] = {2, 4, 6, 8, 10}, radius[5] = {9, 9, 9, 9, 9};
    gproj_mesh *cage = make_star(), *mesh = cut_all(subdivide(cage, 4), 5, foot, radius);
    gproj_mesh_destroy(cage);
    return mesh;
}

/* ---- Figure 12: a horn of triangles ---- */

enum {
    HORN_ALONG = 19,
    HORN_AROUND = 26
};

/* A tube with a wide foot and a wide mouth; every second ring is turned by half a step. */
static void horn(int32_t i, int32_t j, double p[3]) {
    double t = (double)i / HORN_ALONG, bend = 0.22 * TURN * t, radius = 1.35 + 1.8 * (t - 0.5) * (t - 0.5);
    double turn = TURN * (j + 0.5 * (i % 2)) / HORN_AROUND, out = 3.1 - radius * cos(turn);
    p[0] = -out * cos(bend), p[1] = radius * sin(turn), p[2] = out * sin(bend);
}

/* 20 rings of 26: 520 vertices; quads are cut by their shorter diagonals. */
static gproj_mesh *make_horn(void) {
    gproj_mesh *mesh = grid(HORN_ALONG, HORN_AROUND, true, horn), *triangles;
    gproj_edit *edit = gproj_edit_create(mesh, NULL, NULL);
    gproj_edit_triangulate(edit, -1, NULL);
    triangles = must_have(gproj_edit_mesh(edit, NULL, NULL));
    gproj_edit_destroy(edit), gproj_mesh_destroy(mesh);
    return triangles;
}

/* ---- dragging and convergence ---- */

enum {
    ROOF = 70 /* 71 * 71 = 5041 vertices */
};

static void roof(int32_t i, int32_t j, double p[3]) {
    double x = (double)i / ROOF - 0.5, y = (double)j / ROOF - 0.5;
    p[0] = ROOF * x, p[1] = ROOF * y;
    p[2] = ROOF * (0.12 * cos(5 * x) + 0.08 * cos(4 * y + 2 * x * x));
}

/* 32 x 12 quads: 384 faces. */
static void dented(int32_t i, int32_t j, double p[3]) {
    double turn = 4.7 * i / 32 + 0.8, z = 0.45 * j, radius = 1.2 + 0.08 * z * z + 0.05 * sin(0.9 * j + 1.1 * i);
    p[0] = radius * cos(turn), p[1] = radius * sin(turn), p[2] = z;
}

#endif
