/* fuzz_fill.c - libFuzzer target for gproj_mesh_fill: closed curves with corners and numbers of edges.
   make -C tests fuzz FUZZ=fill SECONDS=300 */
#define GPROJT_FUZZ "fill"
#include "gprojt_fuzz.h"

enum {
    GPROJT_POINTS = 32,
    GPROJT_SIDES = 9
};

/* Mostly a star about a point: a curve that does not meet itself. */
static int32_t gprojt_curve_of_bytes(gprojt_input *in, double *p) {
    int32_t count = gprojt_next_of(in, GPROJT_POINTS + 1), i, k;
    int ways = gprojt_next(in);
    double scale = ways & 1 ? gprojt_next_number(in, true) : 1;
    for (i = 0; i < count; ++i) {
        double angle = 6.283185307179586 * i / count, radius = 1 + gprojt_next(in) / 64.0;
        p[3 * i] = radius * cos(angle), p[3 * i + 1] = radius * sin(angle), p[3 * i + 2] = ways & 2 ? 0 : radius / 4;
        if (ways & 4) p[3 * i] = round(4 * p[3 * i]), p[3 * i + 1] = round(4 * p[3 * i + 1]);
        if (ways & 8) gprojt_next_numbers(in, p + 3 * i, 3, true);
        for (k = 0; k < 3; ++k) p[3 * i + k] *= scale;
    }
    return count;
}

static void gprojt_check_mesh(const gproj_mesh *mesh, const gproj_fill_info *info, const gproj_fill_options *options) {
    int32_t f, v, irregular = 0, boundary = 0;
    GPROJT_MUST(!gprojt_validate_mesh(mesh) && mesh->component_count == 1 && mesh->loop_count == 1);
    GPROJT_MUST(mesh->vertex_count - mesh->edge_count + mesh->face_count == 1 && mesh->reoriented_count == 0);
    GPROJT_MUST(gprojt_all_finite(mesh->position, 3 * mesh->vertex_count));
    for (f = 0; f < mesh->face_count; ++f) GPROJT_MUST(mesh->face_degree[f] == 4);
    for (v = 0; v < mesh->vertex_count; ++v) {
        bool at_boundary = gproj_mesh_is_boundary_vertex(mesh, v);
        boundary += at_boundary;
        GPROJT_MUST(at_boundary == (v < info->boundary_count));
        irregular += !at_boundary && gproj_mesh_valence(mesh, v) != 4;
    }
    GPROJT_MUST(boundary == info->boundary_count && irregular == info->irregular_count);
    GPROJT_MUST(mesh->polyline_count == info->side_count);
    GPROJT_MUST(info->min_angle > 0 && info->min_angle <= 90 && info->max_angle >= 90 && info->max_angle < 180);
    if (options->side_count == info->side_count && !options->keep_points)
        for (f = 0; f < info->side_count; ++f)
            GPROJT_MUST(mesh->polyline_start[f + 1] - mesh->polyline_start[f] == options->subdivisions[f] + 1);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gprojt_input in = {data, size, 0};
    double points[3 * GPROJT_POINTS], around;
    int32_t corners[GPROJT_SIDES], sides[GPROJT_SIDES], i, count;
    gproj_fill_options options;
    gproj_fill_info info;
    gprojt_failing failing;
    gproj_error error;
    gproj_host host;
    gproj_mesh *mesh;
    int fails = gprojt_next(&in), ways = gprojt_next(&in);
    memset(&options, 0, sizeof options);
    memset(&failing, 0, sizeof failing);
    if (fails >= 240) failing.fail_at = 1 + gprojt_next(&in);
    host = gprojt_failing_host(&failing);
    count = gprojt_curve_of_bytes(&in, points);
    options.corners = corners, options.subdivisions = sides;
    if (ways & 1) options.corner_count = gprojt_next_of(&in, GPROJT_SIDES + 1);
    for (i = 0; i < options.corner_count; ++i) {
        int32_t low = i ? corners[i - 1] + 1 : 0;
        corners[i] = ways & 2 ? gprojt_next(&in) - 100 : low + gprojt_next_of(&in, 4);
    }
    if (ways & 4) options.side_count = ways & 128 ? gprojt_next_of(&in, GPROJT_SIDES + 1) : options.corner_count;
    for (i = 0; i < options.side_count; ++i) sides[i] = gprojt_next(&in) % 16 - (ways & 2 ? 2 : -1);
    if (ways & 8) options.edge_length = ways & 2 ? gprojt_next_number(&in, true) : (32 + gprojt_next(&in)) / 64.0;
    /* A long curve with short edges takes its time, and is for tests that measure: at most 200 edges around. */
    for (i = 0, around = 0; i < count; ++i) around += gprojt_far(points + 3 * i, points + 3 * ((i + 1) % count));
    if (options.edge_length > 0 && around / options.edge_length > 200) options.edge_length = around / 200;
    options.keep_points = ways & 16;
    options.rings = gprojt_next_of(&in, 4) - (ways & 2 ? 1 : 0), options.variant = gprojt_next_of(&in, 4);
    mesh = gproj_mesh_fill(count, points, ways & 64 ? NULL : &options, &info, &host, &error);
    GPROJT_MUST((mesh != NULL) == (error.code == GPROJ_OK));
    gprojt_check_error(&error);
    if (mesh) {
        gproj_fill_options none;
        memset(&none, 0, sizeof none);
        gprojt_check_mesh(mesh, &info, ways & 64 ? &none : &options);
    } else {
        GPROJT_MUST(info.boundary_count == 0 && info.side_count == 0 && info.max_angle == 0);
        GPROJT_MUST(error.code != GPROJ_ERROR_MEMORY || failing.fail_at > 0);
    }
    gproj_mesh_destroy(mesh);
    GPROJT_MUST(failing.held == 0 && failing.bytes == 0 && failing.wrong_sizes == 0);
    return 0;
}
