/* bench_mesh.h - the meshes of tools/bench: gentle shapes of any size, a little noisy, so that faces are not planar. */
#ifndef BENCH_MESH_H
#define BENCH_MESH_H

#include "bench.h"
#include <math.h>

static inline bench_mesh bench_mesh_of(int32_t vertices, int32_t faces, int64_t corners) {
    bench_mesh mesh;
    mesh.vertex_count = vertices;
    mesh.face_count = faces;
    mesh.position = (double *)bench_take((size_t)vertices, 3 * sizeof(double));
    mesh.degree = (int32_t *)bench_take((size_t)faces, sizeof(int32_t));
    mesh.corner = (int32_t *)bench_take((size_t)corners, sizeof(int32_t));
    return mesh;
}

/* Moves each vertex by at most `amount` along each axis: the same in every run (splitmix64). */
static inline void bench_shake(bench_mesh *mesh, double amount) {
    uint64_t state = 1, z;
    int32_t i;
    for (i = 0; i < 3 * mesh->vertex_count; ++i) {
        z = state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        z ^= z >> 31;
        mesh->position[i] += amount * ((double)(z >> 11) / 4503599627370496.0 - 1);
    }
}

/* Two near numbers with a product near n. */
static inline void bench_split(double n, int32_t *a, int32_t *b) {
    *a = (int32_t)floor(sqrt(n));
    *b = (int32_t)floor(n / *a + 0.5);
}

static inline void bench_set(bench_mesh *mesh, int32_t v, double x, double y, double z) {
    mesh->position[3 * (size_t)v] = x;
    mesh->position[3 * (size_t)v + 1] = y;
    mesh->position[3 * (size_t)v + 2] = z;
}

/* Vertices on the square -1..1, row by row, on a wavy height field or (dome) on the paraboloid that stands under an equal
   load by equal force densities. */
static inline void bench_grid_points(bench_mesh *mesh, int32_t columns, int32_t rows, bool dome) {
    int32_t i, j;
    for (j = 0; j < rows; ++j) {
        for (i = 0; i < columns; ++i) {
            double x = 2.0 * i / (columns - 1) - 1, y = 2.0 * j / (rows - 1) - 1;
            double height = dome ? 0.25 * (2 - x * x - y * y) : 0.2 * sin(2.5 * x) * cos(2 * y) + 0.1 * x * y;
            bench_set(mesh, j * columns + i, x, y, height);
        }
    }
    bench_shake(mesh, (dome ? 0.005 : 0.05) * 2 / columns); /* forces magnify what is out of shape */
}

/* Quads; with `cut`, every third one is cut into two triangles. */
static inline bench_mesh bench_grid(int32_t columns, int32_t rows, bool dome, bool cut) {
    bench_mesh mesh = bench_mesh_of(columns * rows, 2 * (columns - 1) * (rows - 1), 6 * (int64_t)columns * rows);
    int32_t i, j, *corner = mesh.corner, face = 0;
    for (j = 0; j + 1 < rows; ++j) {
        for (i = 0; i + 1 < columns; ++i) {
            int32_t v = j * columns + i;
            bool triangles = cut && (i + 2 * j) % 3 == 0;
            mesh.degree[face++] = triangles ? 3 : 4;
            *corner++ = v, *corner++ = v + 1, *corner++ = v + columns + 1;
            if (triangles) {
                mesh.degree[face++] = 3;
                *corner++ = v, *corner++ = v + columns + 1;
            }
            *corner++ = v + columns;
        }
    }
    mesh.face_count = face;
    bench_grid_points(&mesh, columns, rows, dome);
    return mesh;
}

/* A honeycomb: `columns` x `rows` hexagons as a wall of bricks, every other vertex moved to open the angles. */
static inline bench_mesh bench_honeycomb(int32_t columns, int32_t rows) {
    int32_t wide = 2 * columns + 2, vertices = wide * (rows + 1), i, j, k, count = 0;
    bench_mesh mesh = bench_mesh_of(vertices, columns * rows, 6 * (int64_t)columns * rows);
    int32_t *number = (int32_t *)bench_take((size_t)vertices, sizeof *number), *corner = mesh.corner;
    for (j = 0; j < rows; ++j) {
        for (i = 0; i < columns; ++i) {
            int32_t v = j * wide + 2 * i + (j & 1);
            mesh.degree[j * columns + i] = 6;
            for (k = 0; k < 3; ++k) *corner++ = v + k;
            for (k = 2; k >= 0; --k) *corner++ = v + wide + k;
        }
    }
    bench_grid_points(&mesh, wide, rows + 1, false);
    for (i = 0; i < vertices; ++i)
        mesh.position[3 * (size_t)i + 1] += (i / wide + i % wide) & 1 ? 0.3 / rows : -0.3 / rows;
    /* Leave out the vertices without a face. */
    for (i = 0; i < 6 * columns * rows; ++i) number[mesh.corner[i]] = 1;
    for (i = 0; i < vertices; ++i) {
        if (!number[i]) continue;
        memmove(mesh.position + 3 * (size_t)count, mesh.position + 3 * (size_t)i, 3 * sizeof(double));
        number[i] = count++;
    }
    for (i = 0; i < 6 * columns * rows; ++i) mesh.corner[i] = number[mesh.corner[i]];
    mesh.vertex_count = count;
    free(number);
    return mesh;
}

/* The number of the vertex at `at` on the surface of the cube 0..n, in the order of first use; `number`: 6 (n + 1)^2
   entries by side, as far as known -1. Points on edges of the cube belong to several sides: the lowest one counts. */
static inline int32_t bench_cube_vertex(bench_mesh *mesh, int32_t *number, int32_t n, const int32_t at[3]) {
    int32_t axis, side, key;
    double x = 2.0 * at[0] / n - 1, y = 2.0 * at[1] / n - 1, z = 2.0 * at[2] / n - 1, r = sqrt(x * x + y * y + z * z);
    for (axis = 0; at[axis] != 0 && at[axis] != n; ++axis) continue;
    side = 2 * axis + (at[axis] == n);
    key = (side * (n + 1) + at[(axis + 1) % 3]) * (n + 1) + at[(axis + 2) % 3];
    if (number[key] < 0) {
        number[key] = mesh->vertex_count++;
        bench_set(mesh, number[key], x / r, y / r, z / r);
    }
    return number[key];
}

/* A cube with n x n quads a side, blown up to a sphere: closed, eight vertices of valence 3. */
static inline bench_mesh bench_cube_sphere(int32_t n) {
    bench_mesh mesh = bench_mesh_of(6 * n * n + 2, 6 * n * n, 24 * (int64_t)n * n);
    int32_t *number = (int32_t *)bench_take(6 * (size_t)(n + 1) * (size_t)(n + 1), sizeof *number);
    int32_t side, i, j, k, *corner = mesh.corner;
    mesh.vertex_count = 0;
    for (i = 0; i < 6 * (n + 1) * (n + 1); ++i) number[i] = -1;
    for (side = 0; side < 6; ++side) {
        for (j = 0; j < n; ++j) {
            for (i = 0; i < n; ++i) {
                mesh.degree[side * n * n + j * n + i] = 4;
                for (k = 0; k < 4; ++k) {
                    int32_t a = i + (k == 1 || k == 2), b = j + (k >= 2), axis = side / 2, at[3];
                    at[axis] = side & 1 ? n : 0;
                    at[(axis + 1) % 3] = side & 1 ? a : b; /* counter-clockwise from outside on both sides */
                    at[(axis + 2) % 3] = side & 1 ? b : a;
                    *corner++ = bench_cube_vertex(&mesh, number, n, at);
                }
            }
        }
    }
    free(number);
    bench_shake(&mesh, 0.05 * 1.5 / n);
    return mesh;
}

/* -- by the number of vertices, nearly -- */

static inline bench_mesh bench_quads(int32_t vertices, bool dome, bool cut) {
    int32_t columns, rows;
    bench_split(vertices, &columns, &rows);
    return bench_grid(columns, rows, dome, cut);
}

static inline bench_mesh bench_hexagons(int32_t vertices) {
    int32_t columns, rows;
    bench_split(vertices / 2.0, &columns, &rows);
    return bench_honeycomb(columns > 2 ? columns - 1 : 1, rows > 2 ? rows - 1 : 1);
}

static inline bench_mesh bench_closed(int32_t vertices) {
    return bench_cube_sphere((int32_t)floor(sqrt((vertices - 2) / 6.0) + 0.5));
}

#endif
