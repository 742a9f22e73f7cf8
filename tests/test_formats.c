/* test_formats.c - STL and PLY of the command line (tools/formats.h): files made by hand, round trips, refusals. */
#include "gprojt_mesh.h"

#include "../tools/formats.h"

static gproj_mesh *gprojt_read(const void *bytes, size_t size, gprojx_format format, gprojx_reading *reading,
                               gproj_error *error) {
    void *exact = malloc(size + 1); /* so that a sanitizer sees the end */
    gproj_mesh *mesh;
    if (!exact) abort();
    memcpy(exact, bytes, size);
    mesh = gprojx_mesh_read(exact, size, format, reading, NULL, error);
    GPROJT_CHECK((mesh != NULL) == (error->code == GPROJ_OK) && (mesh != NULL) == !error->message[0]);
    free(exact);
    return mesh;
}

static gproj_mesh *gprojt_read_text(const char *text, gprojx_format format, gproj_error *error) {
    return gprojt_read(text, strlen(text), format, NULL, error);
}

/* Columns x rows of hills with faces of 3, 4 and 5 corners. */
static gproj_mesh *gprojt_hills(int32_t columns, int32_t rows) {
    gprojt_soup s;
    gproj_mesh *mesh;
    int32_t i, j, across = rows + 1;
    memset(&s, 0, sizeof s);
    for (i = 0; i <= columns; ++i)
        for (j = 0; j <= rows; ++j) gprojt_add_vertex(&s, i / 3.0, j + 0.1 * i, sin(1.1 * i) * cos(0.7 * j));
    for (i = 0; i < columns; ++i)
        for (j = 0; j < rows; ++j) {
            int32_t a = i * across + j, b = a + across;
            if ((i + j) % 3 == 1)
                gprojt_add_triangle(&s, a, b, b + 1), gprojt_add_triangle(&s, a, b + 1, a + 1);
            else if ((i + j) % 3 == 2 && i == 0) {
                int32_t corner[5] = {a, b, b + 1, a + 1, gprojt_add_vertex(&s, -0.2, j + 0.5, 0.1)};
                gprojt_add_face(&s, 5, corner);
            } else
                gprojt_add_quad(&s, a, b, b + 1, a + 1);
        }
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gprojt_soup_free(&s);
    return mesh;
}

static gproj_mesh *gprojt_disc(int32_t corners) { /* one face */
    gprojt_soup s;
    gproj_mesh *mesh;
    int32_t *corner = (int32_t *)malloc((size_t)corners * sizeof *corner), i;
    if (!corner) abort();
    memset(&s, 0, sizeof s);
    for (i = 0; i < corners; ++i)
        corner[i] = gprojt_add_vertex(&s, cos(6.28 * i / corners), sin(6.28 * i / corners), 0);
    gprojt_add_face(&s, corners, corner);
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gprojt_soup_free(&s);
    free(corner);
    return mesh;
}

/* -- PLY -- */

GPROJT_TEST(ply_round_trips) {
    gproj_mesh *meshes[3];
    int m, e;
    meshes[0] = gprojt_hills(7, 5), meshes[1] = gprojt_disc(300), meshes[2] = gprojt_disc(3);
    for (m = 0; m < 3; ++m) {
        for (e = 0; e < 3; ++e) {
            gprojt_text text;
            gproj_error error;
            gproj_mesh *back;
            memset(&text, 0, sizeof text);
            GPROJT_CHECK(gprojx_mesh_write(meshes[m], GPROJX_PLY, (gprojx_encoding)e, gprojt_text_write, &text,
                                           &error) == GPROJ_OK);
            GPROJT_CHECK(gprojx_format_of(text.text, text.size) == GPROJX_PLY);
            back = gprojt_read(text.text, text.size, GPROJX_PLY, NULL, &error);
            GPROJT_CHECK(back && gprojt_same_mesh(meshes[m], back));
            gproj_mesh_destroy(back);
            free(text.text);
        }
        gproj_mesh_destroy(meshes[m]);
    }
}

/* Two triangles over a square, with things in between that are passed over. */
GPROJT_TEST(ply_texts) {
    static const char *const texts[] = {
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n3 0 1 2\n3 0 2 3\n",
        /* CR LF, comments, other names of types, more properties, other elements, the coordinates in another order */
        "ply\r\nformat ascii 1.0\r\ncomment element face 9\r\nobj_info no\r\nelement camera 2\r\nproperty int a\r\n"
        "property list uint8 float64 b\r\nelement vertex 4\r\nproperty uint8 red\r\nproperty float64 z\r\n"
        "property float32 y\r\nproperty list int8 int16 rest\r\nproperty int32 x\r\nelement face 2\r\n"
        "property uint16 flags\r\nproperty list uint32 uint32 vertex_index\r\nproperty list uchar float texcoord\r\n"
        "element nothing 999999999999\r\nelement edge 1\r\nproperty int vertex1\r\nend_header\r\n"
        "7 0\r\n8 2 0.5 1e9\r\n255 0 0 0 0\r\n0 0 0 2 5 6 1\r\n0 .5 1 0 1\r\n0 0 1 1 -3 0\r\n"
        "1 3 0 1 2 6 0 0 1 0 1 1\r\n2 3 0 2 3 0\r\n4\r\n",
        /* the faces first, all on one line */
        "ply format ascii 1.0 element face 2 property list uchar uchar vertex_indices element vertex 4\n"
        "property double x property double y property double z end_header 3 0 1 2 3 0 2 3 0 0 0 1 0 0 1 1 5e-1 0 1 0",
    };
    const char *obj = "v 0 0 0\nv 1 0 0\nv 1 1 .5\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    gproj_mesh *want = gproj_mesh_read(obj, strlen(obj), GPROJ_FORMAT_OBJ, NULL, NULL);
    size_t i;
    for (i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        gproj_error error;
        gproj_mesh *mesh = gprojt_read_text(texts[i], GPROJX_PLY, &error);
        GPROJT_CHECK(mesh && gprojt_same_mesh(mesh, want));
        if (!mesh) printf("    %d: %s\n", (int)i, error.message);
        gproj_mesh_destroy(mesh);
    }
    gproj_mesh_destroy(want);
}

/* Appends a value as a type says. */
static void gprojt_put(gprojt_text *text, int type, bool big, double value) {
    static const int sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    uint64_t bits = (uint64_t)(int64_t)value;
    float narrow = (float)value;
    uint32_t half;
    char byte[8];
    int i;
    memcpy(&half, &narrow, sizeof half);
    if (type == 6) bits = half;
    if (type == 7) memcpy(&bits, &value, sizeof bits);
    for (i = 0; i < sizes[type]; ++i) byte[big ? sizes[type] - 1 - i : i] = (char)(bits >> 8 * i & 255);
    gprojt_text_write(text, byte, (size_t)sizes[type]);
}

/* All types of coordinates, of lists' lengths and of corners, in both orders of bytes. */
GPROJT_TEST(ply_binaries) {
    static const char *const names[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
    static const double point[4][3] = {{0, 0, 1}, {100, 0, 2}, {100, 7, 3}, {0, 5, 127}};
    int type, index, big, i, k;
    for (type = 0; type < 8; ++type)
        for (index = 0; index < 6; ++index)
            for (big = 0; big < 2; ++big) {
                double sign = type == 1 || type == 3 || type == 5 ? 1 : -1; /* of a type without signs */
                gprojt_text text;
                gproj_error error;
                gproj_mesh *mesh;
                char head[400];
                memset(&text, 0, sizeof text);
                snprintf(head, sizeof head,
                         "ply%s\nformat binary_%s_endian 1.0\nelement vertex 4\nproperty %s x\nproperty %s y\n"
                         "property ushort more\nproperty %s z\nelement face 1\nproperty list %s %s vertex_indices\n"
                         "property double more\nend_header%s\n",
                         index % 2 ? "\r" : "", big ? "big" : "little", names[type], names[type], names[type],
                         names[(index + 3) % 6], names[index], index % 2 ? "\r" : "");
                gprojt_text_write(&text, head, strlen(head));
                for (i = 0; i < 4; ++i)
                    for (k = 0; k < 4; ++k)
                        gprojt_put(&text, k == 2 ? 3 : type, big != 0, k == 2 ? 999 : sign * point[i][k == 3 ? 2 : k]);
                gprojt_put(&text, (index + 3) % 6, big != 0, 4);
                for (i = 0; i < 4; ++i) gprojt_put(&text, index, big != 0, i);
                gprojt_put(&text, 7, big != 0, 3.25);
                mesh = gprojt_read(text.text, text.size, GPROJX_PLY, NULL, &error);
                GPROJT_CHECK(mesh && mesh->vertex_count == 4 && mesh->face_count == 1 && mesh->face_degree[0] == 4);
                for (i = 0; mesh && i < 12; ++i) GPROJT_NEAR(mesh->position[i], sign * point[i / 3][i % 3], 0);
                gproj_mesh_destroy(mesh);
                mesh = gprojt_read(text.text, text.size - 1, GPROJX_PLY, NULL, &error);
                GPROJT_CHECK(!mesh && strstr(error.message, "ends before all that its header promises"));
                free(text.text);
            }
}

#define GPROJT_XYZ "property float x\nproperty float y\nproperty float z\n"
GPROJT_TEST(ply_refusals) {
    static const struct {
        const char *text, *part;
    } wrong[] = {
        {"", "line 1: the text ends where 'ply' is expected"},
        {"plx\n", "line 1: expected 'ply', not 'plx'"},
        {"ply\nformat ascii 1.0\n", "line 3: the file ends before 'end_header'"},
        {"ply\nformat binary 1.0\n", "line 2: there is no format 'binary'"},
        {"ply\nformat ascii 2.0\n", "line 2: expected '1.0'"},
        {"ply\nelement vertex 1\n" GPROJT_XYZ "end_header\n0 0 0\n", "names no format"},
        {"ply\nformat ascii 1.0\nproperty float x\n", "line 3: a property without an element"},
        {"ply\nformat ascii 1.0\nelement vertex -1\n", "line 3: a count must be"},
        {"ply\nformat ascii 1.0\nelement vertex 1.5\n", "line 3: a count must be"},
        {"ply\nformat ascii 1.0\nelement vertex many\n", "line 3: expected a number, not 'many'"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nelement vertex 1\n", "line 4: the vertices are promised twice"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n", "line 4: there is no type 'real'"},
        {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int a\n", "line 4: a list's length"},
        {"ply\nformat ascii 1.0\nvertices 3\n", "line 3: no header of a PLY has a line 'vertices'"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
         "line 5: the vertices must have"},
        {"ply\nformat ascii 1.0\nelement face 0\nend_header\n", "line 4: the vertices must have"},
        {"ply\nformat ascii 1.0\nelement vertex 2\n" GPROJT_XYZ "end_header\n0 0 0\n0 zero 0\n",
         "line 9: expected a number, not 'zero'"},
        {"ply\nformat ascii 1.0\nelement vertex 2\n" GPROJT_XYZ "end_header\n0 0 0\n0 nan 0\n",
         "line 9: a coordinate is infinite, or not a number"},
        {"ply\nformat ascii 1.0\nelement vertex 2\n" GPROJT_XYZ "end_header\n0 0 0\n0 0",
         "the text ends where a number"},
        {"ply\nformat ascii 1.0\nelement vertex 9000000000\n" GPROJT_XYZ "end_header\n", "more vertices than"},
        {"ply\nformat ascii 1.0\nelement vertex 3\n" GPROJT_XYZ
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0\n\n3 0 1 3\n",
         "line 12: there is no vertex 3; the file has 3, counted from 0"},
        {"ply\nformat ascii 1.0\nelement vertex 3\n" GPROJT_XYZ
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0\n-3 0 1 2\n",
         "line 11: a list cannot have this length"},
        {"ply\nformat ascii 1.0\nelement vertex 3\n" GPROJT_XYZ
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0\n2 0 1\n",
         "face 0"},
        {"ply\nformat binary_little_endian 1.0\nelement vertex 1\n" GPROJT_XYZ "end_header\n",
         "byte 115: the file ends"},
        {"ply\nformat binary_big_endian 1.0\nelement vertex 1\n" GPROJT_XYZ "end_header\n\x7f\x80",
         "byte 114: the file ends"},
    };
    char many[8192] = "ply\nformat ascii 1.0\nelement vertex 1\n";
    gproj_error error;
    size_t i;
    for (i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        gproj_mesh *mesh = gprojt_read_text(wrong[i].text, GPROJX_PLY, &error);
        GPROJT_CHECK(!mesh && strstr(error.message, wrong[i].part));
        if (!strstr(error.message, wrong[i].part)) printf("    %d: %s\n", (int)i, error.message);
        gproj_mesh_destroy(mesh);
    }
    for (i = 0; i < 300; ++i) strcat(many, "property char a\n");
    GPROJT_CHECK(!gprojt_read_text(many, GPROJX_PLY, &error) && strstr(error.message, "line 260: more than 256 prop"));
    many[21] = 0;
    for (i = 0; i < 40; ++i) strcat(many, "element a 0\n");
    GPROJT_CHECK(!gprojt_read_text(many, GPROJX_PLY, &error) &&
                 strstr(error.message, "line 35: more than 32 elements"));
}

/* -- STL -- */

#define GPROJT_FACET(a, b, c) \
    "facet normal 0 0 1\n outer loop\n  vertex " a "\n  vertex " b "\n  vertex " c "\n endloop\nendfacet\n"

GPROJT_TEST(stl_texts) {
    gprojx_reading reading;
    gproj_error error;
    const char *text = "solid a roof facet\n" GPROJT_FACET("0 0 0", "1 0 0", "0 1 0") /* two solids, one in capitals */
        GPROJT_FACET("0 0 0", "1 0 0",
                     "0 0 -0.0") "endsolid a roof\n\nSOLID\nFACET NORMAL -nan(ind) nan 0\nOUTER LOOP\r\n"
                                 "VERTEX 1 0 0 VERTEX 1 1 .25e1 VERTEX 0 1 0\nENDLOOP ENDFACET\n" GPROJT_FACET(
                                     "2 2 2", "2 2 2", "2 2 2") "ENDSOLID";
    static const double want[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 2.5}, {0, 1, 0}};
    gproj_mesh *mesh = gprojt_read(text, strlen(text), GPROJX_STL, &reading, &error);
    int32_t i;
    GPROJT_REQUIRE(mesh && mesh->vertex_count == 6 && mesh->face_count == 2 && mesh->component_count == 2);
    for (i = 0; i < 18; ++i) GPROJT_NEAR(mesh->position[i], want[i / 3][i % 3], 0);
    GPROJT_CHECK(reading.left_out == 2 && reading.first_left_out == 1);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(stl_refusals) {
    static const struct {
        const char *text, *part;
    } wrong[] = {
        {"solid", "line 1: the text ends before 'endsolid'"},
        {"solid\nendsolid\n", "there is no triangle"},
        {"solid\n" GPROJT_FACET("0 0 0", "0 0 0", "1 1 1") "endsolid", "no triangle but those without extent"},
        {"solid\n" GPROJT_FACET("0 0 0", "1 0 0", "1 1 1"), "line 9: the text ends before 'endsolid'"},
        {"solid\n" GPROJT_FACET("0 0 0", "1 0 0", "1 1 inf") "endsolid\n", "line 6: a coordinate is infinite"},
        {"solid\n" GPROJT_FACET("0 0 0", "1 0 0", "1 1") "endsolid\n", "line 7: expected a number, not 'endloop'"},
        {"solid\n" GPROJT_FACET("0 0 0", "1 0 0", "1 1 1 1") "endsolid\n", "line 6: expected 'endloop', not '1'"},
        {"solid\nfacet\n", "line 3: the text ends where 'normal' is expected"},
        {"solid\nfaucet\n", "line 2: expected 'facet' or 'endsolid', not 'faucet'"},
        {"solid\nendsolid\n" GPROJT_FACET("0 0 0", "1 0 0", "1 1 1"), "line 3: expected 'solid', not 'facet'"},
        {"a text that is something else", "byte 29: a binary STL has 84 bytes or more"},
        {"a longer text that is something else and has more than 84 bytes, so that it may be binary or not",
         "byte 80: 1646290274 triangles take"},
    };
    size_t i;
    for (i = 0; i < sizeof wrong / sizeof wrong[0]; ++i) {
        gproj_error error;
        gproj_mesh *mesh = gprojt_read_text(wrong[i].text, GPROJX_STL, &error);
        GPROJT_CHECK(!mesh && strstr(error.message, wrong[i].part));
        if (!strstr(error.message, wrong[i].part)) printf("    %d: %s\n", (int)i, error.message);
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(stl_binaries) {
    static const double corners[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1.5, -2}, {5, 5, 5, 6, 5, 5, 5, 6, 1e30}};
    static const char *const heads[] = {"solid", "anything"};
    int h, i, k;
    for (h = 0; h < 2; ++h) {
        gprojt_text text;
        gproj_error error;
        gproj_mesh *mesh;
        char head[80] = "";
        memset(&text, 0, sizeof text);
        strcpy(head, heads[h]);
        gprojt_text_write(&text, head, 80);
        gprojt_put(&text, 5, false, 2);
        for (i = 0; i < 2; ++i) {
            for (k = 0; k < 3; ++k) gprojt_put(&text, 6, false, HUGE_VAL); /* a normal that is not looked at */
            for (k = 0; k < 9; ++k) gprojt_put(&text, 6, false, corners[i][k]);
            gprojt_put(&text, 3, false, 65535);
        }
        GPROJT_CHECK(gprojx_format_of(text.text, text.size) == GPROJX_STL);
        mesh = gprojt_read(text.text, text.size, GPROJX_STL, NULL, &error);
        GPROJT_REQUIRE(mesh && mesh->vertex_count == 6 && mesh->face_count == 2);
        for (i = 0; i < 18; ++i) GPROJT_NEAR(mesh->position[i], (float)corners[i / 9][i % 9], 0);
        gproj_mesh_destroy(mesh);
        GPROJT_CHECK(!gprojt_read(text.text, text.size - 1, GPROJX_STL, NULL, &error));
        if (h == 1) GPROJT_CHECK(strstr(error.message, "byte 80: 2 triangles take 184 bytes, and the file has 183"));
        memcpy(text.text + 84 + 50 + 12 + 8, "\0\0\xc0\x7f", 4);
        GPROJT_CHECK(!gprojt_read(text.text, text.size, GPROJX_STL, NULL, &error));
        GPROJT_CHECK(strstr(error.message, "byte 154: a coordinate is infinite, or not a number"));
        free(text.text);
    }
}

/* Of all faces triangles, at the same places: exactly in a text, as floats in a binary file. */
GPROJT_TEST(stl_round_trips) {
    gproj_mesh *mesh = gprojt_hills(6, 7);
    double area = gproj_measure(mesh, NULL, NULL).area, volume = gproj_volume(mesh);
    int32_t triangles = mesh->halfedge_count, i, f;
    int e;
    for (i = 0; i < mesh->halfedge_count; ++i) triangles -= mesh->face[i] < 0;
    triangles -= 2 * mesh->face_count;
    for (e = 0; e < 3; e += 2) {
        gprojt_text text;
        gproj_error error;
        gproj_mesh *back;
        memset(&text, 0, sizeof text);
        GPROJT_CHECK(gprojx_mesh_write(mesh, GPROJX_STL, (gprojx_encoding)e, gprojt_text_write, &text, &error) ==
                     GPROJ_OK);
        GPROJT_CHECK(gprojx_format_of(text.text, text.size) == GPROJX_STL);
        back = gprojt_read(text.text, text.size, GPROJX_STL, NULL, &error);
        GPROJT_REQUIRE(back && back->face_count == triangles && back->vertex_count == 3 * triangles);
        GPROJT_CHECK(gproj_measure(back, NULL, NULL).area > 0.99 * area && fabs(gproj_volume(back) - volume) < 0.5);
        for (i = 0; i < back->vertex_count; ++i) {
            double nearest = HUGE_VAL;
            for (f = 0; f < mesh->vertex_count; ++f)
                nearest = fmin(nearest, gprojt_far(back->position + 3 * i, mesh->position + 3 * f));
            GPROJT_NEAR(nearest, 0, e == GPROJX_ASCII ? 0 : 1e-6);
        }
        gproj_mesh_destroy(back);
        free(text.text);
    }
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(writers_refuse) {
    gproj_mesh *mesh = gprojt_hills(2, 2);
    gproj_error error;
    gprojt_text text;
    int format;
    GPROJT_CHECK(gprojx_mesh_write(mesh, GPROJX_STL, GPROJX_BIG, gprojt_text_write, NULL, &error) != GPROJ_OK);
    GPROJT_CHECK(strstr(error.message, "little-endian"));
    for (format = GPROJX_STL; format <= GPROJX_PLY; ++format) {
        memset(&text, 0, sizeof text);
        text.stop_at = 5;
        GPROJT_CHECK(gprojx_mesh_write(mesh, (gprojx_format)format, GPROJX_ASCII, gprojt_text_write, &text, &error) ==
                     GPROJ_ERROR_FILE);
        GPROJT_CHECK(text.calls == 5); /* not asked again */
        free(text.text);
    }
    mesh->position[7] = -1e39;
    memset(&text, 0, sizeof text);
    GPROJT_CHECK(gprojx_mesh_write(mesh, GPROJX_STL, GPROJX_LITTLE, gprojt_text_write, &text, &error) ==
                 GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.place == GPROJ_PLACE_VERTEX && error.index == 2 && strstr(error.message, "vertex 2"));
    GPROJT_CHECK(gprojx_mesh_write(mesh, GPROJX_STL, GPROJX_ASCII, gprojt_text_write, &text, &error) == GPROJ_OK);
    free(text.text);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(formats_by_content) {
    static const char *const neither[] = {"",     "p", "ply", "plywood x", "solid", "solids x", "v 0 0 0\nf 1 2 3\n",
                                          "OFF 0"};
    size_t i;
    for (i = 0; i < sizeof neither / sizeof neither[0]; ++i)
        GPROJT_CHECK(gprojx_format_of(neither[i], strlen(neither[i])) == GPROJX_NEITHER);
    GPROJT_CHECK(gprojx_format_of("ply\n", 4) == GPROJX_PLY && gprojx_format_of("solid \n", 7) == GPROJX_STL);
}

int main(void) {
    GPROJT_RUN(ply_round_trips);
    GPROJT_RUN(ply_texts);
    GPROJT_RUN(ply_binaries);
    GPROJT_RUN(ply_refusals);
    GPROJT_RUN(stl_texts);
    GPROJT_RUN(stl_refusals);
    GPROJT_RUN(stl_binaries);
    GPROJT_RUN(stl_round_trips);
    GPROJT_RUN(writers_refuse);
    GPROJT_RUN(formats_by_content);
    return gprojt_report();
}
