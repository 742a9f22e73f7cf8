/* fuzz_formats.c - libFuzzer target for the STL and PLY readers and writers (tools/formats.h). The first byte picks the
   format. make -C tests fuzz FUZZ=formats SECONDS=300 */
#define GPROJT_FUZZ "formats"
#include "gprojt_fuzz.h"

#include "../tools/formats.h"

/* The mesh that was written must come back: all of a PLY, the triangles of an STL, of all faces in their order. */
static void gprojt_try_back(gproj_mesh *mesh, gprojx_format format, gprojx_encoding encoding) {
    gprojt_text text;
    gproj_error error;
    gproj_mesh *back;
    memset(&text, 0, sizeof text);
    if (gprojx_mesh_write(mesh, format, encoding, gprojt_text_write, &text, &error) == GPROJ_OK) {
        gprojx_reading reading;
        back = gprojx_mesh_read(text.text, text.size, format, &reading, NULL, &error);
        /* Floats and other rounded numbers may make two corners one. */
        if (format == GPROJX_PLY)
            GPROJT_MUST(back && gprojt_same_mesh(mesh, back));
        else
            GPROJT_MUST(back ? back->face_count + reading.left_out >= mesh->face_count
                             : reading.left_out > 0 || mesh->face_count == 0);
        gproj_mesh_destroy(back);
    } else {
        gprojt_check_error(&error);
        GPROJT_MUST(format == GPROJX_STL);
    }
    free(text.text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gproj_error error;
    gprojx_reading reading;
    gprojx_format format;
    gproj_mesh *mesh;
    if (!size) return 0;
    format = data[0] & 1 ? GPROJX_PLY : GPROJX_STL;
    mesh = gprojx_mesh_read(data + 1, size - 1, format, &reading, NULL, &error);
    GPROJT_MUST((mesh != NULL) == (error.code == GPROJ_OK));
    gprojt_check_error(&error);
    if (!mesh) return 0;
    GPROJT_MUST(!gprojt_validate_mesh(mesh) && (reading.left_out > 0) == (reading.first_left_out >= 0));
    gprojt_try_back(mesh, GPROJX_PLY, (gprojx_encoding)((data[0] >> 1) % 3));
    gprojt_try_back(mesh, GPROJX_STL, data[0] & 8 ? GPROJX_ASCII : GPROJX_LITTLE);
    gproj_mesh_destroy(mesh);
    return 0;
}
