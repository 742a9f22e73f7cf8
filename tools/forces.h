/* forces.h - the picture of a mesh with the forces in its edges, for the examples and for figures.

   Include guidedproj.h before this file. */
#ifndef GPROJX_FORCES_H
#define GPROJX_FORCES_H

#include "picture.h"

/* Axial forces from force densities; `force` may be `densities`. */
static void gprojx_forces_of_densities(const gproj_mesh *mesh, const double *densities, double *force) {
    int32_t e, k;
    for (e = 0; e < mesh->edge_count; ++e) {
        double d[3];
        for (k = 0; k < 3; ++k)
            d[k] = mesh->position[3 * mesh->origin[2 * e] + k] - mesh->position[3 * mesh->origin[2 * e + 1] + k];
        force[e] = densities[e] * sqrt(gprojx_dot(d, d));
    }
}

/* Writes the picture of a mesh with the axial forces of these force densities in its edges to a file; the widest
   edges stand for the force `high` (0: the largest), the view is as in gprojx_view. */
static inline gproj_code gprojx_picture_of_forces(const char *path, const char *title, const gproj_mesh *mesh,
                                                  const double *densities, double high, double azimuth,
                                                  double elevation) {
    gprojx_picture_options options;
    gprojx_view view = {0, 0, false};
    gproj_code code = GPROJ_ERROR_MEMORY;
    double *force = (double *)malloc(((size_t)mesh->edge_count + 1) * sizeof *force);
    FILE *file = force ? fopen(path, "w") : NULL;
    memset(&options, 0, sizeof options);
    view.azimuth = azimuth, view.elevation = elevation;
    options.view = &view;
    options.title = title;
    options.edge_value = force;
    options.edge_high = high;
    if (force) {
        gprojx_forces_of_densities(mesh, densities, force);
        code = file ? gprojx_picture(file, mesh, &options) : GPROJ_ERROR_FILE;
    }
    if (file && fclose(file) != 0 && code == GPROJ_OK) code = GPROJ_ERROR_FILE;
    free(force);
    return code;
}

#endif
