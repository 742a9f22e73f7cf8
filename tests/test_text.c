/* test_text.c - >>text: reading and writing OBJ and OFF, files, and what is refused with which sentence. */
#if !defined(_WIN32) && !defined(_XOPEN_SOURCE)
#define _XOPEN_SOURCE 700 /* setrlimit */
#endif
#include "gprojt_mesh.h"

#ifndef _WIN32
#include <signal.h>
#include <sys/resource.h>
#endif

static gproj_mesh *gprojt_read_text(const char *text, gproj_error *error) {
    return gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_DETECT, NULL, error);
}

/* -- what is read -- */

GPROJT_TEST(obj_dialects) {
    static const char *const texts[] = {
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
        "v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n",
        "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4",
        "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4\r",
        "\xef\xbb\xbf# comment\n\n  v 0 0 0\n\tv\t1 0 0  \nv 1 1 0 # here\nv 0 1 0\n#f 9 9 9\nf 1 2 3 4",
        "v 0 0 0 1\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0 1 0 0 1\nf 1 2 3 4",
        "mtllib a.mtl\no thing\ng a b\nvt 0 0\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl m\ns off\ns 1\nf "
        "1/1/1 2/1/1 3/1/1 4/1/1",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1//1 2//1 3//1 4//1",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2/2 3/3 4/4",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4/-1/-1 -3//-2 -2/1 -1",
        "v 0 0 0\nv 1 0 \\\n0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\r\n  3 \\\r4",
        "f 1 2 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0", /* the face first */
        "v +0.0e0 0 -0\nv 10e-1 0 0\nv .1e1 1. 0\nv 0 1 0\nf 1 2 3 4\ncurv 1 2\np 1\nxyz ~ ? 4",
        "\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4", /* a byte order mark */
        "\xef\xbb\xbfOFF\n4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
        "OFF\n4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
        "OFF 4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0",
        "# c\nCOFF\r\n4 1\r\n0 0 0 1 1 1 1\r\n1 0 0 1 1 1 1\r\n\r\n1 1 0 1 1 1 1 # c\r\n0 1 0 0 0 0 0\r\n4 0 1 2 3 0.5 "
        "0.5 0.5\r\n",
        "NOFF\n4 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4\n0 1\n2 3",
        "STOFF\n4 1 0\n0 0 0 .5 .5\n1 0 0 .5 .5\n1 1 0 .5 .5\n0 1 0 .5 .5\n4 0 1 2 3",
        "STCNOFF\n4 1 0\n0 0 0 1 2 3 4 5\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\nwhatever"};
    static const char headless[] = "4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    size_t i;
    gproj_error error;
    gproj_mesh *first = gprojt_read_text(texts[0], &error), *mesh;
    GPROJT_REQUIRE(first != NULL);
    GPROJT_CHECK(first->face_count == 1 && first->vertex_count == 4 && first->face_degree[0] == 4);
    for (i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        mesh = gprojt_read_text(texts[i], &error);
        if (!mesh) printf("  text %d: %s\n", (int)i, error.message);
        GPROJT_CHECK(mesh && error.code == GPROJ_OK && error.index == -1 && !error.message[0]);
        if (mesh && i == 13) mesh->position[2] = 0; /* -0 */
        if (mesh && !gprojt_same_mesh(mesh, first)) printf("  text %d differs\n", (int)i);
        GPROJT_CHECK(mesh && gprojt_same_mesh(mesh, first));
        gproj_mesh_destroy(mesh);
    }
    mesh = gproj_mesh_read(headless, strlen(headless), GPROJ_FORMAT_OFF, NULL, &error);
    GPROJT_CHECK(mesh && gprojt_same_mesh(mesh, first)); /* the word OFF may be missing */
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(first);
}

GPROJT_TEST(obj_polylines) {
    gproj_error error;
    gproj_mesh *mesh = gprojt_read_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\nl 1/1 2/2 -1 1\nl 3 4\nv 5 5 5\n", &error);
    GPROJT_REQUIRE(mesh != NULL);
    GPROJT_CHECK(!gprojt_validate_mesh(mesh));
    GPROJT_CHECK(mesh->polyline_count == 3 && mesh->isolated_count == 4 && mesh->face_count == 0);
    GPROJT_CHECK(mesh->polyline_start[1] == 3 && mesh->polyline_start[2] == 7 && mesh->polyline_start[3] == 9);
    GPROJT_CHECK(mesh->polyline_vertex[5] == 2 && mesh->polyline_vertex[6] == 0 && mesh->polyline_vertex[8] == 3);
    gproj_mesh_destroy(mesh);
}

/* -- what is refused -- */

typedef struct gprojt_bad_text {
    const char *text;
    gproj_code code;
    gproj_place place;
    int64_t index;
    const char *piece; /* of the sentence */
} gprojt_bad_text;

#define GPROJT_SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
static const gprojt_bad_text gprojt_bad_texts[] = {
    {"", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "empty"},
    {"\n# nothing\n\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "no vertex"},
    {"hello\nworld\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "is it an OBJ or OFF text?"},
    {"v 0 0 0\nv 1 0\nf 1 2 3\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 2, "line 2: a vertex with 2 numbers"},
    {"v 0 0 0\nv\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 2, "line 2: a vertex with 0 numbers"},
    {"v 0 0 0 0 0\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "with 5 numbers"},
    {"v 0 0 0 0 0 0 0 0 0 0\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "more than 7 numbers"},
    {"v 0,5 1 2\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "'0,5' is not a number; write decimals with a point"},
    {"# a\r\n# b\r\nv 1 \\\r\n2x 3\r\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 4, "line 4: '2x' is not a number"},
    {"v 1 2 averyveryverylongwordindeed\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "'averyveryverylongwordind...'"},
    {"v 1 2 \x01\xff\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "'\?\?' is not"},
    {"v 1 2 1.#QNAN\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "'1.#QNAN'"},
    {"v 0 0 0\nv nan 0 0\n", GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 1, "line 2: coordinate x of vertex 1 is nan"},
    {"v 0 0 0\nv 0 1e999 0\n", GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 1, "line 2: coordinate y of vertex 1 is inf"},
    {"v 0 0 0\n\nv 0 0 -1e99\n", GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 1,
     "line 3: coordinate z of vertex 1 is -1e+99"},
    {GPROJT_SQUARE "f 0 1 2\n", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 5, "line 5: index 0"},
    {GPROJT_SQUARE "f 1 2 3\nf 1 3 5\n", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 6, "line 6: index 5, but the text has 4"},
    {GPROJT_SQUARE "f -5 2 3\n", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 5, "index -5, but only 4 vertices stand above"},
    {GPROJT_SQUARE "f 1 2 99999999999999999999\n", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 5, "larger than any number"},
    {GPROJT_SQUARE "f 1 2 -99999999999999999999\n", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 5, "vertices stand above"},
    {GPROJT_SQUARE "f 1 2 3.5\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 5, "'3.5' is not a vertex index"},
    {GPROJT_SQUARE "f 1 2 3/x\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 5, "'3/x' is not a vertex index"},
    {GPROJT_SQUARE "f 1 2 /3\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 5, "'/3' is not"},
    {GPROJT_SQUARE "f a b c\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 5, "'a' is not a vertex index"},
    {GPROJT_SQUARE "f 1 2 3\\", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 5, "'3\\' is not"}, /* goes on nowhere */
    {GPROJT_SQUARE "f 1-2 3 4\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 5, "'1-2' is not a vertex index"},
    {GPROJT_SQUARE "f 1 2 -\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 5, "'-' is not"},
    {GPROJT_SQUARE "f\n", GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_LINE, 5, "a face with 0 corners"},
    {GPROJT_SQUARE "f 1 2 \\\n\n", GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_LINE, 5, "line 5: a face with 2 corners"},
    {GPROJT_SQUARE "l 1\n", GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_LINE, 5, "a polyline with 1 points"},
    {GPROJT_SQUARE "l 1 2\nl 3 7\n", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 6, "line 6: index 7"},
    {GPROJT_SQUARE "l 1 b\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 5, "'b' is not"},
    {GPROJT_SQUARE "f 1 2 3\nf 1 2 2\n", GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_FACE, 1,
     "line 6: face 1 names vertex 1 twice"},
    {GPROJT_SQUARE "v 2 2 2\nf 1 2 3\nf 1 2 4\n# fin\nf 2 1 5\n", GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, 2,
     "line 9: edge 0-1 has 3 faces (0, 1 and 2)"},
    {GPROJT_SQUARE "v 2 2 2\nf 1 2 3\nf 1 4 5\n", GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_VERTEX, 0,
     "line 1: the faces at vertex 0"},
    {"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\nf 1 2 3\nf 2 3 4\nf 3 4 5\nf 4 5 1\nf 5 1 2\n",
     GPROJ_ERROR_NON_ORIENTABLE, GPROJ_PLACE_FACE, 2, "line 8: faces 2 and 3 cannot agree"},
    {"OFF", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "cut off"},
    {"OFFER\n4 1 2\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "is it an OBJ or OFF text?"},
    {"SOFF\n4 1 2\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "is it an OBJ or OFF text?"},
    {"SXOFF\n4 1 2\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "is it an OBJ or OFF text?"},
    {"OFF\n4", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 2, "after 1 of 2 counts"},
    {"OFF\nx 1 2", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 2, "'x' is not a whole number"},
    {"OFF\n-4 1 2", GPROJ_ERROR_SIZE, GPROJ_PLACE_LINE, 2, "a count of -4 vertices"},
    {"OFF\n4 99999999999 2", GPROJ_ERROR_SIZE, GPROJ_PLACE_LINE, 2, "a count of 99999999999 faces"},
    {"OFF\n400000000 300000000 0\n0 0 0\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 4, "after 1 of 400000000 vertices"},
    {"OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 7, "after 1 of 2 faces"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 6, "after 0 of 1 faces"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1000000 0 1", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 6, "after 0 of 1 faces"},
    {"OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 3,
     "line 3: a vertex with 2 numbers"},
    {"OFF\n3 1 0\n0 0 z\n1 0 0\n0 1 0\n3 0 1 2", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 3, "'z' is not a number"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 6,
     "index 3, but the vertices are 0 to 2"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 6,
     "index 3, but the vertices are 0 to 2; they seem to be counted from 1"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 1 2 4", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 6, "vertices are 0 to 2"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1", GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 6, "index -1"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 q", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 6, "'q' is not"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1", GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_LINE, 6, "a face with 2 corners"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-5 0 1", GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_LINE, 6, "a face with -5 corners"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-4294967293 0 1 2", GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_LINE, 6,
     "a face with -4294967293 corners"}, /* no int32_t, which would be 3 */
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3/1 0 1 2", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 6,
     "'3/1' is not a whole number"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n\ninf 1 0\n3 0 1 2", GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 2, "line 6: coordinate x"},
    {"OFF\n0 0 0\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "no vertex"},
    {"OFF BINARY\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "binary OFF"},
    {"4OFF\n1 0 0\n0 0 0 1\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 2, "another dimension"},
    {"nOFF\n3\n1 0 0\n0 0 0 1\n", GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 2, "another dimension"}};

GPROJT_TEST(refused_texts) {
    size_t i;
    for (i = 0; i < sizeof gprojt_bad_texts / sizeof gprojt_bad_texts[0]; ++i) {
        const gprojt_bad_text *bad = &gprojt_bad_texts[i];
        gproj_error error;
        gprojt_failing counting;
        gproj_host host;
        gproj_mesh *mesh;
        memset(&counting, 0, sizeof counting);
        host = gprojt_failing_host(&counting);
        mesh = gproj_mesh_read(bad->text, strlen(bad->text), GPROJ_FORMAT_DETECT, &host, &error);
        if (!gprojt_mesh_was_refused(mesh, &error, bad->code, bad->place, bad->index, bad->piece))
            gprojt_fail(__FILE__, __LINE__, bad->piece);
        GPROJT_CHECK(counting.held == 0 && counting.wrong_sizes == 0);
        GPROJT_CHECK(!gproj_mesh_read(bad->text, strlen(bad->text), GPROJ_FORMAT_DETECT, NULL, NULL));
    }
}

/* What is neither OBJ nor OFF is told by name; what is OBJ, however it begins, is read. */
GPROJT_TEST(other_formats) {
    static const char *const texts[][2] = {{"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "an STL file"},
                                           {"ply\nformat ascii 1.0\nelement vertex 3\n", "a PLY file"},
                                           {"{\"asset\": {\"version\": \"2.0\"}}\n", "glTF"},
                                           {"glTF\002", "a glTF file"},
                                           {"ISO-10303-21;\nHEADER;\n#1=POINT();\n", "a STEP file"},
                                           {"<?xml version=\"1.0\"?>\n<COLLADA>\n", "Collada"}};
    static const char solid[] = "solid\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    static const char wrong[] = "solid\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n";
    char stl[84 + 2 * 50];
    gproj_error error;
    gproj_mesh *mesh;
    size_t i;
    for (i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        mesh = gprojt_read_text(texts[i][0], &error);
        GPROJT_CHECK(gprojt_mesh_was_refused(mesh, &error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, texts[i][1]) &&
                     strstr(error.message, "write it as OBJ"));
        GPROJT_CHECK(!gprojt_read_text(texts[i][0], NULL));
    }
    memset(stl, 0, sizeof stl);
    stl[80] = 2;
    mesh = gproj_mesh_read(stl, sizeof stl, GPROJ_FORMAT_DETECT, NULL, &error);
    GPROJT_CHECK(gprojt_mesh_was_refused(mesh, &error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "binary STL"));
    for (i = 0; i < 2; ++i) { /* without triangles, and with so many that their number has three bytes */
        size_t size = i ? 84 + 70000 * 50 : 84;
        char *large = (char *)calloc(1, size);
        if (!large) abort();
        if (i) large[80] = 70000 % 256, large[81] = 70000 / 256 % 256, large[82] = 1;
        mesh = gproj_mesh_read(large, size, GPROJ_FORMAT_DETECT, NULL, &error);
        GPROJT_CHECK(gprojt_mesh_was_refused(mesh, &error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1, "binary STL"));
        free(large);
    }
    mesh = gproj_mesh_read(stl, sizeof stl - 1, GPROJ_FORMAT_DETECT, NULL, &error);
    GPROJT_CHECK(gprojt_mesh_was_refused(mesh, &error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, 1, "a zero byte"));
    mesh = gprojt_read_text(solid, &error);
    GPROJT_CHECK(mesh && mesh->face_count == 1);
    gproj_mesh_destroy(mesh);
    mesh = gprojt_read_text(wrong, &error); /* what is wrong in an OBJ stays what is told */
    GPROJT_CHECK(gprojt_mesh_was_refused(mesh, &error, GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, 5, "line 5: index 9"));
}

GPROJT_TEST(refused_arguments) {
    gproj_error error;
    GPROJT_CHECK(!gproj_mesh_read(NULL, 5, GPROJ_FORMAT_OBJ, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_read(NULL, 0, GPROJ_FORMAT_OBJ, NULL, &error) && error.code == GPROJ_ERROR_SYNTAX);
    GPROJT_CHECK(!gproj_mesh_read("v", 1, (gproj_format)7, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_read("x\nv 0 0 0\n\0\n", 12, GPROJ_FORMAT_DETECT, NULL, &error));
    GPROJT_CHECK(error.code == GPROJ_ERROR_SYNTAX && error.place == GPROJ_PLACE_LINE && error.index == 3);
    GPROJT_CHECK(!gproj_mesh_read("abc", 3, GPROJ_FORMAT_OFF, NULL, &error) &&
                 strstr(error.message, "'abc' where an OFF"));
    GPROJT_CHECK(!gproj_mesh_read(" \n", 2, GPROJ_FORMAT_OFF, NULL, &error) && error.code == GPROJ_ERROR_SYNTAX &&
                 strstr(error.message, "after 0 of 2 counts"));
    GPROJT_CHECK(!gproj_mesh_load(NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_mesh_save(NULL, "a.obj", &error) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_mesh_write(NULL, GPROJ_FORMAT_OBJ, gprojt_text_write, NULL, NULL) == GPROJ_ERROR_ARGUMENT);
}

/* -- there and back -- */

static void gprojt_check_round_trip(const gproj_mesh *mesh, gproj_format format, const char *name) {
    gprojt_text text, again;
    gproj_error error;
    gproj_mesh *back;
    memset(&text, 0, sizeof text);
    memset(&again, 0, sizeof again);
    GPROJT_CHECK(gproj_mesh_write(mesh, format, gprojt_text_write, &text, NULL) == GPROJ_OK);
    back = gproj_mesh_read(text.text, text.size, GPROJ_FORMAT_DETECT, NULL, &error);
    if (!back) printf("  %s: %s\n", name, error.message);
    GPROJT_CHECK(back && back->reoriented_count == 0);
    if (back && (format == GPROJ_FORMAT_OBJ || !mesh->polyline_count)) GPROJT_CHECK(gprojt_same_mesh(back, mesh));
    if (back) {
        GPROJT_CHECK(gproj_mesh_write(back, format, gprojt_text_write, &again, NULL) == GPROJ_OK);
        GPROJT_CHECK(again.size == text.size && !memcmp(again.text, text.text, text.size));
    }
    gproj_mesh_destroy(back);
    free(text.text);
    free(again.text);
}

GPROJT_TEST(round_trips) {
    uint64_t state = 11;
    int shape, i;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gprojt_soup s = gprojt_shape(shape, 7);
        gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
        for (i = 0; i < 3 * mesh->vertex_count; ++i)
            mesh->position[i] *= ldexp(1 + gprojt_uniform(&state), gprojt_below(&state, 200) - 100);
        mesh->position[4] = -0.0;
        gprojt_check_round_trip(mesh, GPROJ_FORMAT_OBJ, "OBJ");
        gprojt_check_round_trip(mesh, GPROJ_FORMAT_OFF, "OFF");
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&s);
    }
    {
        gproj_mesh *mesh = gprojt_read_text(GPROJT_SQUARE "v 9 9 9\nl 1 5 3 1\nf 4 3 2 1\nl 5 2\n", NULL);
        GPROJT_REQUIRE(mesh != NULL);
        gprojt_check_round_trip(mesh, GPROJ_FORMAT_OBJ, "polylines");
        gprojt_check_round_trip(mesh, GPROJ_FORMAT_OFF, "polylines");
        gproj_mesh_destroy(mesh);
    }
    for (i = 0; i < GPROJT_REAL_MESHES; ++i) {
        gproj_mesh *mesh = gprojt_load_real_mesh(i, NULL, NULL);
        if (mesh) gprojt_check_round_trip(mesh, i & 1 ? GPROJ_FORMAT_OFF : GPROJ_FORMAT_OBJ, gprojt_real_mesh(i));
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(writer_failures) {
    gprojt_soup s = gprojt_quad_grid(30, 30);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL), *lines;
    gproj_error error;
    gprojt_text text;
    long stop;
    memset(&text, 0, sizeof text);
    for (stop = 0; stop < 1000; ++stop) gprojt_text_write(&text, "v 0 0 0\nl -1 1\n", 15);
    lines = gproj_mesh_read(text.text, text.size, GPROJ_FORMAT_OBJ, NULL,
                            NULL); /* 8890 bytes of vertices, as many of lines */
    GPROJT_REQUIRE(lines && lines->polyline_count == 1000);
    for (stop = 1; stop < 5; ++stop) {
        text.calls = 0, text.stop_at = stop;
        GPROJT_CHECK(gproj_mesh_write(lines, GPROJ_FORMAT_OBJ, gprojt_text_write, &text, &error) == GPROJ_ERROR_FILE);
        GPROJT_CHECK(text.calls == stop);
    }
    gproj_mesh_destroy(lines);
    for (stop = 1; stop < 5; ++stop) {
        text.calls = 0, text.stop_at = stop;
        GPROJT_CHECK(gproj_mesh_write(mesh, GPROJ_FORMAT_OBJ, gprojt_text_write, &text, &error) == GPROJ_ERROR_FILE);
        GPROJT_CHECK(error.code == GPROJ_ERROR_FILE && strstr(error.message, "has stopped"));
        GPROJT_CHECK(text.calls == stop); /* not called again */
    }
    GPROJT_CHECK(gproj_mesh_write(mesh, GPROJ_FORMAT_DETECT, gprojt_text_write, &text, &error) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(strstr(error.message, "neither OBJ nor OFF"));
    GPROJT_CHECK(gproj_mesh_write(mesh, GPROJ_FORMAT_OBJ, NULL, &text, NULL) == GPROJ_ERROR_ARGUMENT);
    mesh->position[7] = NAN;
    text.calls = 0;
    GPROJT_CHECK(gproj_mesh_write(mesh, GPROJ_FORMAT_OBJ, gprojt_text_write, &text, &error) == GPROJ_ERROR_NUMBER &&
                 !text.calls);
    GPROJT_CHECK(error.place == GPROJ_PLACE_VERTEX && error.index == 2);
    free(text.text);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

/* -- files -- */

static void gprojt_put_file(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    if (file) {
        fwrite(text, 1, strlen(text), file);
        fclose(file);
    }
}

GPROJT_TEST(files) {
    static const char *const paths[] = {"gprojt_text.obj", "gprojt_text.off", "gprojt_text.OBJ"};
    gprojt_soup s = gprojt_hexagon_mesh(9, 8);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL), *back;
    gproj_error error;
    char path[6000], longest[GPROJ_MESSAGE_SIZE];
    int i;
    for (i = 0; i < 3; ++i) {
        gprojt_put_file(paths[i], "old");
        GPROJT_CHECK(gproj_mesh_save(mesh, paths[i], &error) == GPROJ_OK && error.code == GPROJ_OK);
        back = gproj_mesh_load(paths[i], NULL, &error);
        GPROJT_CHECK(back && gprojt_same_mesh(back, mesh));
        gproj_mesh_destroy(back);
    }
    /* an old file stays when the mesh cannot be written */
    mesh->position[5] = HUGE_VAL;
    GPROJT_CHECK(gproj_mesh_save(mesh, paths[0], &error) == GPROJ_ERROR_NUMBER && error.place == GPROJ_PLACE_VERTEX &&
                 error.index == 1);
    mesh->position[5] = 0;
    back = gproj_mesh_load(paths[0], NULL, &error);
    GPROJT_CHECK(back != NULL);
    gproj_mesh_destroy(back);
    /* another ending: by the first word */
    remove("gprojt_text.txt");
    GPROJT_CHECK(rename(paths[1], "gprojt_text.txt") == 0);
    back = gproj_mesh_load("gprojt_text.txt", NULL, &error);
    GPROJT_CHECK(back && back->face_count == mesh->face_count);
    gproj_mesh_destroy(back);
    remove("gprojt_text.txt");
    /* places that are not there */
    GPROJT_CHECK(!gproj_mesh_load("no_such_file.obj", NULL, &error) && error.code == GPROJ_ERROR_FILE &&
                 strstr(error.message, "no_such_file.obj"));
    GPROJT_CHECK(gproj_mesh_save(mesh, "no_such_folder/a.obj", &error) == GPROJ_ERROR_FILE &&
                 strstr(error.message, "no_such_folder"));
    GPROJT_CHECK(gproj_mesh_save(mesh, "a.stl", &error) == GPROJ_ERROR_ARGUMENT &&
                 strstr(error.message, ".obj or .off"));
    GPROJT_CHECK(gproj_mesh_save(mesh, "obj", &error) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_mesh_save(mesh, "aobj", &error) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_mesh_save(mesh, "aoff", &error) == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_mesh_save(mesh, NULL, &error) == GPROJ_ERROR_ARGUMENT && strstr(error.message, "path to save"));
    GPROJT_CHECK(!gproj_mesh_load(".", NULL, &error) && error.code == GPROJ_ERROR_FILE); /* a folder */
    GPROJT_CHECK(!gproj_mesh_load("a\nb.obj", NULL, &error) && strstr(error.message, "a?b.obj"));
    GPROJT_CHECK(!gproj_mesh_load("a\x7f"
                                  "b.obj",
                                  NULL, &error) &&
                 strstr(error.message, "'a?b.obj'"));
    for (i = 0; i < 200; ++i) memcpy(path + 2 * i, "\xc3\xa4", 2);
    for (i = 0; i < 2; ++i) {
        memcpy(path + 400, i ? ".obj" : "x.obj", i ? 5 : 6);
        GPROJT_CHECK(!gproj_mesh_load(path, NULL, &error) &&
                     strstr(error.message, "'...\xc3\xa4\xc3\xa4") == error.message);
    }
    memset(path, '\x80', sizeof path - 1), path[sizeof path - 1] = 0; /* no character begins anywhere */
    GPROJT_CHECK(!gproj_mesh_load(path + sizeof path - 400, NULL, &error) && strchr(error.message, '\x80') == NULL);
    memset(path, 'x', sizeof path);
    memcpy(path + sizeof path - 8, "\xc3\xa4.obj", 7);
    for (i = 0; i < 2; ++i) { /* a long path; cut to its end, at a whole character */
        const char *tail = path + sizeof path - 8 - 120 - i;
        GPROJT_CHECK(!gproj_mesh_load(tail, NULL, &error) && error.code == GPROJ_ERROR_FILE);
        strcpy(longest, error.message);
        GPROJT_CHECK(strstr(longest, ".obj' cannot be opened") != NULL);
    }
    path[sizeof path - 1] = 0;
    GPROJT_CHECK(gproj_mesh_save(mesh, path, &error) == GPROJ_ERROR_FILE && strstr(error.message, "too long"));
    GPROJT_CHECK(strstr(error.message, "'...x") != NULL);
    for (i = 0; i < 3; ++i) remove(paths[i]);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

GPROJT_TEST(full_disk) { /* the old file stays, the new one is taken away */
#ifdef _WIN32
    GPROJT_SKIP("no limit of file sizes here");
#else
    gprojt_soup s = gprojt_quad_grid(40, 40);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    struct rlimit limit, small;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    gproj_error error;
    gprojt_put_file("gprojt_full.obj", "v 1 2 3\n");
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0) {
        gproj_mesh *old;
        small = limit;
        small.rlim_cur = 10000;
        fflush(stdout);
        GPROJT_CHECK(setrlimit(RLIMIT_FSIZE, &small) == 0);
        GPROJT_CHECK(gproj_mesh_save(mesh, "gprojt_full.obj", &error) == GPROJ_ERROR_FILE);
        GPROJT_CHECK(setrlimit(RLIMIT_FSIZE, &limit) == 0);
        GPROJT_CHECK(strstr(error.message, "is the disk full?") != NULL);
        old = gproj_mesh_load("gprojt_full.obj", NULL, &error);
        GPROJT_CHECK(old && old->vertex_count == 1 && old->position[2] == 3);
        gproj_mesh_destroy(old);
    }
    signal(SIGXFSZ, handler);
    remove("gprojt_full.obj");
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
#endif
}

/* -- memory, noise, mutations -- */

/* `user`: a text, or the name of a file that ends in .obj. */
static bool gprojt_make_from_text(const gproj_host *host, void *user) {
    const char *text = (const char *)user, *end = strrchr(text, '.');
    bool is_file = end && !strcmp(end, ".obj");
    gproj_error error;
    gproj_mesh *mesh = is_file ? gproj_mesh_load(text, host, &error)
                               : gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_DETECT, host, &error);
    return gprojt_mesh_was_made(mesh, host, &error);
}

GPROJT_TEST(every_allocation_fails_once) {
    char obj[] = GPROJT_SQUARE "v 5 5 5\nf 1 2 3\nf 1 3 4\nl 1 5 1\nl 2 5\n";
    char off[] = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n", file[] = "gprojt_alloc.obj";
    gprojt_put_file(file, obj);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_make_from_text, obj) >= 20);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_make_from_text, off) >= 20);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_make_from_text, file) >= 20);
    remove(file);
}

/* Reads a text that may be anything: a valid mesh or a sentence comes back. The text ends where its memory ends. */
static void gprojt_read_anything(const char *text, size_t size, gproj_format format) {
    gproj_error error;
    char *exact = (char *)malloc(size + 1);
    gproj_mesh *mesh;
    memcpy(exact + 1, text, size); /* + 1: an address that is not aligned */
    mesh = gproj_mesh_read(exact + 1, size, format, NULL, &error);
    GPROJT_CHECK((mesh != NULL) == (error.code == GPROJ_OK) && (mesh || error.message[0]));
    if (mesh) GPROJT_CHECK(!gprojt_validate_mesh(mesh));
    gproj_mesh_destroy(mesh);
    free(exact);
}

GPROJT_TEST(ten_megabytes_of_noise) {
    size_t size = 10 * 1000 * 1000, i;
    uint64_t state = 9;
    char *noise = (char *)malloc(size);
    static const char letters[] = "0123456789 .-e\nvf/l#\\";
    int kind;
    for (kind = 0; kind < 4; ++kind) {
        for (i = 0; i < size; ++i) {
            uint64_t r = gprojt_random(&state);
            noise[i] = kind == 0 ? (char)r : (kind == 1 ? (char)(1 + r % 255) : letters[r % (sizeof letters - 1)]);
        }
        if (kind == 3) memset(noise, '7', size), memcpy(noise, "v 1 ", 4); /* one number of ten million digits */
        gprojt_read_anything(noise, size, kind == 2 ? GPROJ_FORMAT_OBJ : GPROJ_FORMAT_DETECT);
    }
    free(noise);
}

GPROJT_TEST(mutated_texts) {
    uint64_t state = 8;
    int shape, round, k;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gprojt_soup s = gprojt_shape(shape, 3);
        gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
        for (round = 0; round < 2000; ++round) {
            gprojt_text text;
            gproj_format format = round & 1 ? GPROJ_FORMAT_OBJ : GPROJ_FORMAT_OFF;
            memset(&text, 0, sizeof text);
            gproj_mesh_write(mesh, format, gprojt_text_write, &text, NULL);
            for (k = 1 + gprojt_below(&state, 4); k > 0; --k) {
                size_t at = (size_t)gprojt_below(&state, (int32_t)text.size);
                static const char likely[] = "0123456789 -./\n\r\\#vfleOF";
                text.text[at] =
                    k & 1 ? likely[gprojt_below(&state, (int32_t)sizeof likely - 1)] : (char)gprojt_random(&state);
            }
            if (round % 7 == 0) text.size = (size_t)gprojt_below(&state, (int32_t)text.size);
            gprojt_read_anything(text.text, text.size, round % 3 ? GPROJ_FORMAT_DETECT : format);
            free(text.text);
        }
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&s);
    }
}

int main(void) {
    GPROJT_RUN(obj_dialects);
    GPROJT_RUN(obj_polylines);
    GPROJT_RUN(refused_texts);
    GPROJT_RUN(other_formats);
    GPROJT_RUN(refused_arguments);
    GPROJT_RUN(round_trips);
    GPROJT_RUN(writer_failures);
    GPROJT_RUN(files);
    GPROJT_RUN(full_disk);
    GPROJT_RUN(every_allocation_fails_once);
    GPROJT_RUN(ten_megabytes_of_noise);
    GPROJT_RUN(mutated_texts);
    return gprojt_report();
}
