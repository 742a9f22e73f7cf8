/* grid.h - quads in rows and columns, for the examples.

   Vertex (i, j), i = 0 .. rows, j = 0 .. columns, has the number i (columns + 1) + j and is where `place` puts it. In a
   closed grid column 0 follows the last one: j = 0 .. columns - 1, and the number is i columns + j. Include
   guidedproj.h before this file. */
#ifndef EXAMPLES_GRID_H
#define EXAMPLES_GRID_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static gproj_mesh *make_quads(int32_t rows, int32_t columns, bool closed,
                              void (*place)(int32_t i, int32_t j, double p[3]), gproj_error *error) {
    int32_t across = closed ? columns : columns + 1, faces = 0, i, j;
    double *position = (double *)malloc(3 * sizeof *position * (size_t)((rows + 1) * across));
    int32_t *degree = (int32_t *)malloc(sizeof *degree * (size_t)(rows * columns));
    int32_t *corner = (int32_t *)malloc(4 * sizeof *corner * (size_t)(rows * columns)), *c = corner;
    gproj_mesh *mesh = NULL;
    if (position && degree && corner) {
        for (i = 0; i <= rows; ++i)
            for (j = 0; j < across; ++j) place(i, j, position + 3 * (i * across + j));
        for (i = 0; i < rows; ++i)
            for (j = 0; j < columns; ++j, c += 4) {
                int32_t right = (j + 1) % across;
                degree[faces++] = 4;
                c[0] = i * across + j, c[1] = c[0] + across;
                c[3] = i * across + right, c[2] = c[3] + across;
            }
        mesh = gproj_mesh_create((rows + 1) * across, position, faces, degree, corner, NULL, error);
    } else if (error) {
        memset(error, 0, sizeof *error);
        error->code = GPROJ_ERROR_MEMORY, error->index = -1;
        snprintf(error->message, sizeof error->message, "%s", gproj_code_string(GPROJ_ERROR_MEMORY));
    }
    free(position), free(degree), free(corner);
    return mesh;
}

/* Makes a grid of rows x columns quads. */
static inline gproj_mesh *make_grid(int32_t rows, int32_t columns, void (*place)(int32_t i, int32_t j, double p[3]),
                                    gproj_error *error) {
    return make_quads(rows, columns, false, place, error);
}

/* Makes a grid whose rows are closed rings. */
static inline gproj_mesh *make_rings(int32_t rows, int32_t columns, void (*place)(int32_t i, int32_t j, double p[3]),
                                     gproj_error *error) {
    return make_quads(rows, columns, true, place, error);
}

#endif
