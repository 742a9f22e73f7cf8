/* fuzz_text.c - libFuzzer target for the OBJ and OFF readers. The first byte picks the format.
   make -C tests fuzz FUZZ=text SECONDS=300 */
#define GPROJT_FUZZ "text"
#include "gprojt_fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gproj_error error;
    gproj_mesh *mesh, *back;
    gprojt_text text;
    gproj_format format;
    if (!size) return 0;
    format = (gproj_format)(data[0] % 3);
    mesh = gproj_mesh_read((const char *)data + 1, size - 1, format, NULL, &error);
    if ((mesh != NULL) != (error.code == GPROJ_OK)) abort();
    if (!mesh) {
        gprojt_check_error(&error);
        return 0;
    }
    if (gprojt_validate_mesh(mesh)) abort();
    memset(&text, 0, sizeof text);
    format = data[0] & 64 && !mesh->polyline_count ? GPROJ_FORMAT_OFF : GPROJ_FORMAT_OBJ;
    if (gproj_mesh_write(mesh, format, gprojt_text_write, &text, NULL)) abort();
    back = gproj_mesh_read(text.text, text.size, GPROJ_FORMAT_DETECT, NULL, &error);
    if (!back || !gprojt_same_mesh(mesh, back)) abort();
    gproj_mesh_destroy(back);
    gproj_mesh_destroy(mesh);
    free(text.text);
    return 0;
}
