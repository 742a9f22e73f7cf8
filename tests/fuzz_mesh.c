/* fuzz_mesh.c - libFuzzer target for the mesh builder, surfaces and curves: bytes become faces.
   make -C tests fuzz FUZZ=mesh SECONDS=300 */
#define GPROJT_FUZZ "mesh"
#include "gprojt_fuzz.h"

static void gprojt_try_references(const gproj_mesh *mesh) {
    static const double points[3][3] = {{0, 0, 0}, {1, 2, 3}, {-5, 1e3, 0.25}};
    gproj_error error;
    gproj_surface *surface = gproj_surface_create(mesh, NULL, &error);
    int i, k;
    if ((surface != NULL) != (mesh->face_count > 0)) abort();
    for (i = 0; surface && i < 3; ++i) {
        gproj_surface_hit hit = gproj_surface_closest(surface, points[i]);
        if (hit.face < 0 || hit.face >= mesh->face_count || !(fabs(gprojt_length3(hit.normal) - 1) < 1e-12)) abort();
        for (k = 0; k < 3; ++k) {
            if (!(fabs(hit.point[k]) < HUGE_VAL)) abort();
        }
    }
    gproj_surface_destroy(surface);
    for (k = 0; k < mesh->loop_count && k < 4; ++k) {
        gproj_curve *curve = gproj_curve_from_loop(mesh, k, NULL, &error);
        if (!curve && error.code != GPROJ_ERROR_DEGENERATE) abort();
        for (i = 0; curve && i < 3; ++i) {
            gproj_curve_hit hit = gproj_curve_closest(curve, points[i]);
            if (!(fabs(gprojt_length3(hit.tangent) - 1) < 1e-12) || !(hit.parameter >= 0 && hit.parameter <= 1))
                abort();
        }
        gproj_curve_destroy(curve);
    }
}

/* The first byte: the number of vertices and a way to place them; then faces of 1 + byte % 8 corners, a byte each. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gprojt_soup s;
    gproj_error error;
    gproj_mesh *mesh;
    size_t at = 1;
    int32_t vertices, i;
    if (!size) return 0;
    memset(&s, 0, sizeof s);
    vertices = data[0] % 64;
    for (i = 0; i < vertices; ++i) {
        double x = i, scale = data[0] & 128 ? 1e69 : 1;
        if (data[0] & 64)
            gprojt_add_vertex(&s, x / 4, 0, 0);
        else
            gprojt_add_vertex(&s, cos(7 * x) * scale, sin(5 * x) * scale, cos(3 * x * x) * scale);
    }
    while (at < size) {
        int32_t corner[8], degree = 1 + data[at++] % 8;
        for (i = 0; i < degree; ++i) corner[i] = at < size ? (int32_t)(int8_t)data[at++] : i;
        gprojt_add_face(&s, degree, corner);
    }
    mesh = gprojt_soup_mesh(&s, NULL, &error);
    if ((mesh != NULL) != (error.code == GPROJ_OK)) abort();
    gprojt_check_error(&error);
    if (mesh) {
        gproj_mesh *copy = gproj_mesh_copy(mesh, NULL, NULL);
        if (gprojt_validate_mesh(mesh) || !copy || !gprojt_same_mesh(mesh, copy)) abort();
        gproj_mesh_destroy(copy);
        gprojt_try_references(mesh);
    }
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
    return 0;
}
