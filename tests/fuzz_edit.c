/* fuzz_edit.c - libFuzzer target for what makes meshes of meshes: edits, duals, subdivision, offsets.
   make -C tests fuzz FUZZ=edit SECONDS=300 */
#define GPROJT_FUZZ "edit"
#include "gprojt_fuzz.h"

/* A number that may be wrong: mostly one of the elements. */
static int32_t gprojt_index(gprojt_input *in, int32_t count) {
    int byte = gprojt_next(in);
    if (byte >= 250) return byte == 250 ? INT32_MAX : byte == 251 ? INT32_MIN : byte == 252 ? count : -1;
    return count > 0 ? byte % count : 0;
}

static double gprojt_parameter(gprojt_input *in) {
    int byte = gprojt_next(in);
    return byte >= 248 ? gprojt_next_number(in, true) : byte / 247.0;
}

/* One change; -1 must leave all as it was. */
static int32_t gprojt_change(gprojt_input *in, gproj_edit *edit, gproj_error *error) {
    int what = gprojt_next(in) % 8;
    int32_t face = gprojt_index(in, edit->face_count), edge = gprojt_index(in, edit->edge_count), a, b;
    switch (what) {
    case 0:
    case 1: return gproj_edit_split_edge(edit, edge, gprojt_parameter(in), error);
    case 2: return gproj_edit_collapse_edge(edit, edge, gprojt_parameter(in), error);
    case 3: return gproj_edit_triangulate(edit, what & gprojt_next(in) ? face : -1, error);
    case 4: return gproj_edit_insert_strip(edit, edge, gprojt_parameter(in), error);
    case 5: return gproj_edit_remove_strip(edit, edge, gprojt_parameter(in), error);
    default:
        a = gprojt_index(in, edit->vertex_count), b = gprojt_index(in, edit->vertex_count);
        if (what == 7 && face >= 0 && face < edit->face_count &&
            edit->face_halfedge[face] >= 0) { /* two of its corners */
            int32_t h = edit->face_halfedge[face], steps;
            for (steps = a & 7; steps > 0; --steps) h = edit->next[h];
            a = edit->origin[h];
            for (steps = 2 + (b & 3); steps > 0; --steps) h = edit->next[h];
            b = edit->origin[h];
        }
        return gproj_edit_split_face(edit, face, a, b, error);
    }
}

/* The edit as a mesh; NULL only without memory. Euler's number and boundary loops are those that splits keep. */
static gproj_mesh *gprojt_see(gproj_edit *edit, const gprojt_failing *failing) {
    gproj_error error;
    gproj_mesh *mesh = gproj_edit_mesh(edit, NULL, &error);

    if (!mesh) {
        fprintf(stderr, "%s\n", error.message);
        GPROJT_MUST(failing->fail_at > 0);
        return NULL;
    }
    GPROJT_MUST(!gprojt_validate_mesh(mesh) && mesh->reoriented_count == 0);
    return mesh;
}

static void gprojt_edit(gprojt_input *in, const gproj_mesh *mesh, const gproj_host *host) {
    const gprojt_failing *failing = gprojt_failing_of(host);
    gproj_edit *edit = gproj_edit_create(mesh, host, NULL);
    gproj_mesh *before = edit ? gprojt_see(edit, failing) : NULL, *after;
    int changes = 1 + gprojt_next(in) % 24;
    gproj_error error;
    if (before) GPROJT_MUST(gprojt_same_mesh(mesh, before));
    for (; before && changes > 0 && edit->face_count < 500; --changes) {
        int32_t answer = gprojt_change(in, edit, &error);
        GPROJT_MUST((answer >= 0) == (error.code == GPROJ_OK));
        if (answer < 0) gprojt_check_error(&error);
        if (answer < 0 && failing->fail_at == 0) GPROJT_MUST(error.code != GPROJ_ERROR_MEMORY);
        after = gprojt_see(edit, failing);
        if (after && answer < 0) GPROJT_MUST(gprojt_same_mesh(before, after));
        if (after) GPROJT_MUST(after->component_count == before->component_count);
        if (after)
            GPROJT_MUST(after->vertex_count - after->edge_count + after->face_count ==
                        before->vertex_count - before->edge_count + before->face_count);
        gproj_mesh_destroy(before);
        before = after;
    }
    gproj_mesh_destroy(before);
    gproj_edit_destroy(edit);
}

static void gprojt_subdivide(gprojt_input *in, const gproj_mesh *mesh, const gproj_host *host) {
    gproj_subdivide_options options;
    gproj_stencil *stencil = NULL;
    gproj_error error;
    gproj_mesh *fine;
    double *p;
    memset(&options, 0, sizeof options);
    options.scheme = (gproj_scheme)(gprojt_next(in) % 3),
    options.levels = gprojt_next(in) % 4 - (gprojt_next(in) > 250);
    fine = gproj_mesh_subdivide(mesh, &options, &stencil, host, &error);
    GPROJT_MUST((fine != NULL) == (error.code == GPROJ_OK) && (fine != NULL) == (stencil != NULL));
    if (fine) {
        GPROJT_MUST(!gprojt_validate_mesh(fine) && stencil->row_count == fine->vertex_count);
        p = (double *)malloc(3 * (size_t)fine->vertex_count * sizeof *p);
        if (!p) abort();
        gproj_stencil_apply(stencil, 3, mesh->position, p);
        GPROJT_MUST(gprojt_largest_move(p, fine->position, fine->vertex_count) <=
                    1e-12 * (1 + gprojt_length3(mesh->position)) * 1e3 * fine->vertex_count);
        free(p);
    }
    gproj_stencil_destroy(stencil);
    gproj_mesh_destroy(fine);
}

/* Those that are made of a mesh in one call. */
static void gprojt_derive(gprojt_input *in, const gproj_mesh *mesh, const gproj_host *host) {
    double distance = gprojt_next_number(in, true);
    int what = gprojt_next(in) % 4;
    gproj_error error;
    gproj_mesh *made = what == 0   ? gproj_mesh_dual(mesh, NULL, host, &error)
                       : what == 1 ? gproj_mesh_vertex_offset(mesh, distance, host, &error)
                       : what == 3 ? gproj_mesh_diagonals(mesh, host, &error)
                                   : gproj_mesh_face_offset(mesh, distance, host, &error),
               *panels;
    GPROJT_MUST((made != NULL) == (error.code == GPROJ_OK));
    gprojt_check_error(&error);
    if (made) GPROJT_MUST(!gprojt_validate_mesh(made) && gprojt_all_finite(made->position, 3 * made->vertex_count));
    if (made && (what == 1 || what == 2)) {
        gproj_offset_measures m = gproj_measure_offset(mesh, made);
        GPROJT_MUST(made->face_count == mesh->face_count && m.vertex_distance_max >= m.vertex_distance_min);
        panels = gproj_mesh_support(mesh, made, host, &error);
        GPROJT_MUST((panels != NULL) == (error.code == GPROJ_OK));
        if (panels) GPROJT_MUST(panels->face_count == mesh->edge_count && !gprojt_validate_mesh(panels));
        gproj_mesh_destroy(panels);
    }
    gproj_mesh_destroy(made);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gprojt_input in = {data, size, 0};
    gprojt_failing failing;
    gproj_host host;
    gproj_mesh *mesh;
    int fails = gprojt_next(&in), shape = gprojt_next(&in) % GPROJT_SHAPES, what = gprojt_next(&in) % 4;
    memset(&failing, 0, sizeof failing);
    if (fails >= 240) failing.fail_at = 1 + gprojt_next(&in) % 64;
    host = gprojt_failing_host(&failing);
    mesh = gprojt_mesh_of(gprojt_shape(shape, 1 + gprojt_next_of(&in, 3)));
    if (!mesh) return -1;
    gprojt_shake(mesh, gprojt_next(&in) / 256.0 * gproj_mesh_mean_edge_length(mesh), 1);
    if (what < 2) gprojt_edit(&in, mesh, &host);
    if (what == 2) gprojt_subdivide(&in, mesh, &host);
    if (what == 3) gprojt_derive(&in, mesh, &host);
    gproj_mesh_destroy(mesh);
    GPROJT_MUST(failing.held == 0 && failing.bytes == 0 && failing.wrong_sizes == 0);
    return 0;
}
