/* formats.h - STL and PLY, ASCII and binary: for them what gproj_mesh_read and gproj_mesh_write are for OBJ and OFF.

       gproj_mesh *mesh = gprojx_mesh_read(bytes, size, GPROJX_PLY, NULL, NULL, &error);
       if (!mesh) puts(error.message);                                          "line 12: ..." or "byte 3084: ..."
       gprojx_mesh_write(mesh, GPROJX_STL, GPROJX_LITTLE, write, user, &error);

   After 3D Systems' StereoLithography Interface Specification (1988), as written by common programs, and Greg Turk's
   description of PLY (1994). An STL is a soup: each triangle has its own three vertices, which whoever wants joins.

   Include guidedproj.h before this file. Memory by malloc; no global state; numbers whatever the locale. Arrays grow as
   elements appear: counts that a file promises allocate nothing. Floats are taken to be those of IEEE 754. */
#ifndef GPROJX_FORMATS_H
#define GPROJX_FORMATS_H

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum gprojx_format {
    GPROJX_NEITHER,
    GPROJX_STL,
    GPROJX_PLY
} gprojx_format;

typedef enum gprojx_encoding {
    GPROJX_LITTLE,
    GPROJX_BIG, /* PLY only */
    GPROJX_ASCII
} gprojx_encoding;

/* Properties of a file that the mesh does not tell. */
typedef struct gprojx_reading {
    int32_t left_out;       /* triangles of an STL with two corners at exactly one place */
    int32_t first_left_out; /* number of the first, from 0; -1: none */
} gprojx_reading;

/* ---- reading ---- */

typedef struct gprojx_source {
    const unsigned char *bytes;
    size_t size, at;
    long line; /* from 1; 0: the bytes are no text, and errors name the byte */
    gprojx_encoding encoding;
    gproj_error *error;
    bool failed;
    double *position; /* 3 * vertex_count */
    int32_t *degree, *corner;
    size_t vertex_count, face_count, corner_count;
    size_t position_room, degree_room, corner_room;
} gprojx_source;

/* Stops with a sentence that begins with the line, or the byte `at`. Returns false. */
static bool gprojx_refuse_source(gprojx_source *s, gproj_code code, size_t at, const char *format, ...) {
    char sentence[GPROJ_MESSAGE_SIZE - 48];
    va_list list;
    if (s->failed) return false;
    s->failed = true;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    s->error->code = code;
    s->error->place = s->line > 0 ? GPROJ_PLACE_LINE : GPROJ_PLACE_NONE;
    s->error->index = s->line > 0 ? s->line : -1;
    snprintf(s->error->message, sizeof s->error->message, "%s %lu: %s", s->line > 0 ? "line" : "byte",
             s->line > 0 ? (unsigned long)s->line : (unsigned long)at, sentence);
    return false;
}

/* Makes room in *block for `count` items and `more`. */
static bool gprojx_grow(gprojx_source *s, void **block, size_t *room, size_t count, size_t more, size_t size) {
    void *moved;
    if (count + more <= *room) return true;
    *room = 2 * (count + more) + 64;
    moved = *room < (size_t)-1 / 2 / size ? realloc(*block, *room * size) : NULL;
    if (!moved) return gprojx_refuse_source(s, GPROJ_ERROR_MEMORY, s->at, "out of memory");
    *block = moved;
    return true;
}

static bool gprojx_add_corner(gprojx_source *s, int32_t vertex) {
    if (!gprojx_grow(s, (void **)&s->corner, &s->corner_room, s->corner_count, 1, sizeof *s->corner)) return false;
    s->corner[s->corner_count++] = vertex;
    return true;
}

static bool gprojx_add_degree(gprojx_source *s, int32_t degree) {
    if (!gprojx_grow(s, (void **)&s->degree, &s->degree_room, s->face_count, 1, sizeof *s->degree)) return false;
    s->degree[s->face_count++] = degree;
    return true;
}

static bool gprojx_add_vertex(gprojx_source *s, const double p[3]) {
    if (!gprojx_grow(s, (void **)&s->position, &s->position_room, 3 * s->vertex_count, 3, sizeof *s->position))
        return false;
    memcpy(s->position + 3 * s->vertex_count++, p, 3 * sizeof *p);
    return true;
}

/* Finds the next word of a text, over line ends, and counts those. Returns its length, 0 at the end. */
static size_t gprojx_word(gprojx_source *s, const char **word) {
    size_t end;
    for (; s->at < s->size && isspace(s->bytes[s->at]); ++s->at) {
        bool after_cr = s->at > 0 && s->bytes[s->at - 1] == '\r';
        s->line += s->bytes[s->at] == '\r' || (s->bytes[s->at] == '\n' && !after_cr);
    }
    for (end = s->at; end < s->size && !isspace(s->bytes[end]); ++end) continue;
    *word = (const char *)s->bytes + s->at;
    end -= s->at, s->at += end;
    return end;
}

static bool gprojx_is_word(const char *text, size_t size, const char *word) {
    size_t i;
    if (strlen(word) != size) return false;
    for (i = 0; i < size && tolower((unsigned char)text[i]) == word[i]; ++i) continue;
    return i == size;
}

/* Shows a word in a sentence: its beginning, without control characters. */
static const char *gprojx_shown(const char *word, size_t size, char shown[32]) {
    size_t i, shorter = size < 24 ? size : 24;
    for (i = 0; i < shorter; ++i) shown[i] = word[i] > 32 && word[i] < 127 ? word[i] : '?';
    strcpy(shown + shorter, size > shorter ? "..." : "");
    return shown;
}

static bool gprojx_number(gprojx_source *s, double *value) {
    const char *word;
    char shown[32];
    size_t size = gprojx_word(s, &word);
    if (size > 0 && gproj_number_read(word, size, value) == size) return true;
    if (size == 0)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "the text ends where a number is expected");
    return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "expected a number, not '%s'",
                                gprojx_shown(word, size, shown));
}

static bool gprojx_is_finite(gprojx_source *s, size_t at, double value) {
    return fabs(value) <= 1.7976931348623157e308 ||
           gprojx_refuse_source(s, GPROJ_ERROR_NUMBER, at, "a coordinate is infinite, or not a number");
}

/* ---- STL ---- */

/* Takes a triangle with vertices of its own, unless two of them are at one place: it has no area, and once vertices at
   the same place are joined, it is no triangle. */
static bool gprojx_add_triangle(gprojx_source *s, gprojx_reading *reading, double p[3][3]) {
    int k, same = 0;
    for (k = 0; k < 3; ++k) {
        const double *a = p[k], *b = p[(k + 1) % 3];
        same += !(a[0] < b[0] || a[0] > b[0] || a[1] < b[1] || a[1] > b[1] || a[2] < b[2] || a[2] > b[2]);
    }
    if (same > 0) {
        if (reading->left_out++ == 0) reading->first_left_out = (int32_t)s->face_count;
        return true;
    }
    for (k = 0; k < 3; ++k)
        if (!gprojx_add_corner(s, (int32_t)s->vertex_count) || !gprojx_add_vertex(s, p[k])) return false;
    if (s->vertex_count > INT32_MAX - 3)
        return gprojx_refuse_source(s, GPROJ_ERROR_SIZE, s->at, "more than a mesh can have");
    return gprojx_add_degree(s, 3);
}

static bool gprojx_expect(gprojx_source *s, const char *wanted) {
    const char *word;
    char shown[32];
    size_t size = gprojx_word(s, &word);
    if (gprojx_is_word(word, size, wanted)) return true;
    if (size == 0)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "the text ends where '%s' is expected", wanted);
    return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "expected '%s', not '%s'", wanted,
                                gprojx_shown(word, size, shown));
}

static void gprojx_skip_line(gprojx_source *s) {
    while (s->at < s->size && s->bytes[s->at] != '\n' && s->bytes[s->at] != '\r') ++s->at;
}

/* Reads a facet after the word 'facet'; the normal may be anything, for it follows from the corners. */
static bool gprojx_read_facet(gprojx_source *s, gprojx_reading *reading) {
    double p[3][3];
    const char *word;
    int k, i;
    if (!gprojx_expect(s, "normal")) return false;
    for (k = 0; k < 3; ++k) gprojx_word(s, &word);
    if (!gprojx_expect(s, "outer") || !gprojx_expect(s, "loop")) return false;
    for (k = 0; k < 3; ++k) {
        if (!gprojx_expect(s, "vertex")) return false;
        for (i = 0; i < 3; ++i)
            if (!gprojx_number(s, &p[k][i]) || !gprojx_is_finite(s, s->at, p[k][i])) return false;
    }
    return gprojx_expect(s, "endloop") && gprojx_expect(s, "endfacet") && gprojx_add_triangle(s, reading, p);
}

/* Reads solids, one after the other, each `solid NAME facet ... endsolid NAME`, in small or capital letters. */
static bool gprojx_read_ascii_stl(gprojx_source *s, gprojx_reading *reading) {
    const char *word;
    char shown[32];
    size_t size;
    bool inside = false;
    while ((size = gprojx_word(s, &word)) > 0) {
        if (!inside && gprojx_is_word(word, size, "solid")) {
            inside = true;
            gprojx_skip_line(s);
        } else if (inside && gprojx_is_word(word, size, "endsolid")) {
            inside = false;
            gprojx_skip_line(s);
        } else if (inside && gprojx_is_word(word, size, "facet")) {
            if (!gprojx_read_facet(s, reading)) return false;
        } else
            return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "expected %s, not '%s'",
                                        inside ? "'facet' or 'endsolid'" : "'solid'", gprojx_shown(word, size, shown));
    }
    return !inside || gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "the text ends before 'endsolid'");
}

static uint32_t gprojx_little(const unsigned char *b) {
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static double gprojx_float(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Reads 80 bytes of anything, the number of triangles, and for each 12 floats (the normal, the corners) and 2 bytes. */
static bool gprojx_read_binary_stl(gprojx_source *s, gprojx_reading *reading) {
    uint32_t count, f;
    double p[3][3];
    int k;
    s->line = 0;
    if (s->size < 84)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->size,
                                    "a binary STL has 84 bytes or more; this file ends here");
    count = gprojx_little(s->bytes + 80);
    if ((s->size - 84) / 50 != count || (s->size - 84) % 50 != 0)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, 80, "%lu triangles take %.0f bytes, and the file has %lu",
                                    (unsigned long)count, 84 + 50.0 * count, (unsigned long)s->size);
    for (f = 0; f < count; ++f) {
        s->at = 84 + 50 * (size_t)f + 12;
        for (k = 0; k < 9; ++k, s->at += 4) {
            p[k / 3][k % 3] = gprojx_float(gprojx_little(s->bytes + s->at));
            if (!gprojx_is_finite(s, s->at, p[k / 3][k % 3])) return false;
        }
        if (!gprojx_add_triangle(s, reading, p)) return false;
    }
    return true;
}

static bool gprojx_has_stl_size(const unsigned char *bytes, size_t size) {
    return size >= 84 && (size - 84) % 50 == 0 && (size - 84) / 50 == gprojx_little(bytes + 80);
}

/* Binary files may begin with 'solid', too: their size is what tells. */
static bool gprojx_read_stl(gprojx_source *s, gprojx_reading *reading) {
    bool text = s->size >= 5 && gprojx_is_word((const char *)s->bytes, 5, "solid");
    bool good = text && !gprojx_has_stl_size(s->bytes, s->size) ? gprojx_read_ascii_stl(s, reading)
                                                                : gprojx_read_binary_stl(s, reading);
    return good &&
           (s->face_count > 0 || gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "there is no triangle%s",
                                                      reading->left_out > 0 ? " but those without extent" : ""));
}

/* ---- PLY ---- */

typedef enum gprojx_type {
    GPROJX_INT8,
    GPROJX_UINT8,
    GPROJX_INT16,
    GPROJX_UINT16,
    GPROJX_INT32,
    GPROJX_UINT32,
    GPROJX_FLOAT32,
    GPROJX_FLOAT64,
    GPROJX_TYPE_COUNT
} gprojx_type;

enum {
    GPROJX_MOST_PROPERTIES = 256, /* in a file */
    GPROJX_MOST_ELEMENTS = 32
};

typedef struct gprojx_property {
    gprojx_type type;
    gprojx_type length_type; /* of the number before a list; GPROJX_TYPE_COUNT: no list */
    int role;                /* 0, 1, 2: x, y, z; 3: the corners of a face; -1: passed over */
} gprojx_property;

typedef struct gprojx_element {
    double count;
    int first, end; /* its properties */
    bool vertices, faces;
} gprojx_element;

typedef struct gprojx_ply {
    gprojx_property property[GPROJX_MOST_PROPERTIES];
    gprojx_element element[GPROJX_MOST_ELEMENTS];
    int property_count, element_count;
    double vertices; /* number of vertices promised */
} gprojx_ply;

static int gprojx_type_size(gprojx_type type) {
    static const int size[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return size[type];
}

static bool gprojx_read_type(gprojx_source *s, gprojx_type *type) {
    static const char *const names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                           {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                           {"float", "float32"}, {"double", "float64"}};
    const char *word;
    char shown[32];
    size_t size = gprojx_word(s, &word);
    int i;
    for (i = 0; i < GPROJX_TYPE_COUNT; ++i)
        if (gprojx_is_word(word, size, names[i][0]) || gprojx_is_word(word, size, names[i][1])) {
            *type = (gprojx_type)i;
            return true;
        }
    return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "there is no type '%s'", gprojx_shown(word, size, shown));
}

/* Reads 'property TYPE NAME' or 'property list TYPE TYPE NAME' after the first word. */
static bool gprojx_read_property(gprojx_source *s, gprojx_ply *ply) {
    gprojx_element *element = ply->element + ply->element_count - 1;
    gprojx_property *property = ply->property + ply->property_count;
    size_t size, before = s->at;
    const char *word;
    if (ply->element_count == 0)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "a property without an element");
    if (ply->property_count == GPROJX_MOST_PROPERTIES)
        return gprojx_refuse_source(s, GPROJ_ERROR_SIZE, s->at, "more than %d properties", GPROJX_MOST_PROPERTIES);
    size = gprojx_word(s, &word);
    property->role = -1;
    property->length_type = GPROJX_TYPE_COUNT;
    if (gprojx_is_word(word, size, "list")) {
        if (!gprojx_read_type(s, &property->length_type)) return false;
        if (property->length_type >= GPROJX_FLOAT32)
            return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "a list's length must be of a whole type");
    } else
        s->at = before;
    if (!gprojx_read_type(s, &property->type)) return false;
    size = gprojx_word(s, &word);
    if (element->vertices && property->length_type == GPROJX_TYPE_COUNT && size == 1 && word[0] >= 'x' &&
        word[0] <= 'z')
        property->role = word[0] - 'x';
    if (element->faces && property->length_type != GPROJX_TYPE_COUNT && property->type < GPROJX_FLOAT32 &&
        (gprojx_is_word(word, size, "vertex_indices") || gprojx_is_word(word, size, "vertex_index")))
        property->role = 3;
    element->end = ++ply->property_count;
    return true;
}

/* Reads 'element NAME COUNT' after the first word. */
static bool gprojx_read_element(gprojx_source *s, gprojx_ply *ply) {
    gprojx_element *element = ply->element + ply->element_count;
    const char *word;
    size_t size;
    if (ply->element_count == GPROJX_MOST_ELEMENTS)
        return gprojx_refuse_source(s, GPROJ_ERROR_SIZE, s->at, "more than %d elements", GPROJX_MOST_ELEMENTS);
    size = gprojx_word(s, &word);
    element->vertices = gprojx_is_word(word, size, "vertex");
    element->faces = gprojx_is_word(word, size, "face");
    element->first = element->end = ply->property_count;
    if (!gprojx_number(s, &element->count)) return false;
    if (!(element->count >= 0) || element->count > 9e15 || floor(element->count) < element->count)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "a count must be a whole number, 0 or larger");
    if (element->vertices && ply->vertices >= 0)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "the vertices are promised twice");
    if (element->vertices) ply->vertices = element->count;
    ply->element_count++;
    return true;
}

static bool gprojx_read_encoding(gprojx_source *s) {
    static const char *const names[] = {"binary_little_endian", "binary_big_endian", "ascii"}; /* by gprojx_encoding */
    const char *word;
    char shown[32];
    size_t size = gprojx_word(s, &word);
    int i;
    for (i = 0; i < 3 && !gprojx_is_word(word, size, names[i]); ++i) continue;
    if (i == 3)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "there is no format '%s'",
                                    gprojx_shown(word, size, shown));
    s->encoding = (gprojx_encoding)i;
    return gprojx_expect(s, "1.0");
}

/* Looks whether the vertices have an x, a y and a z, once each. */
static bool gprojx_check_vertices(gprojx_source *s, const gprojx_ply *ply) {
    int have[3] = {0, 0, 0}, i;
    for (i = 0; i < ply->property_count; ++i)
        if (ply->property[i].role >= 0 && ply->property[i].role < 3) have[ply->property[i].role]++;
    if (have[0] == 1 && have[1] == 1 && have[2] == 1) return true;
    return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "the vertices must have one x, one y and one z each");
}

/* Reads to the end of the line after end_header: LF, CR LF or CR, whichever ends the first line. */
static bool gprojx_read_header(gprojx_source *s, gprojx_ply *ply) {
    bool format = false, crlf;
    const char *word;
    char shown[32];
    size_t size;
    memset(ply, 0, sizeof *ply);
    ply->vertices = -1;
    if (!gprojx_expect(s, "ply")) return false;
    crlf = s->at + 1 < s->size && s->bytes[s->at] == '\r' && s->bytes[s->at + 1] == '\n';
    for (;;) {
        bool good = true;
        size = gprojx_word(s, &word);
        if (gprojx_is_word(word, size, "end_header")) break;
        if (size == 0) return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "the file ends before 'end_header'");
        if (gprojx_is_word(word, size, "comment") || gprojx_is_word(word, size, "obj_info"))
            gprojx_skip_line(s);
        else if (gprojx_is_word(word, size, "format"))
            good = gprojx_read_encoding(s), format = true;
        else if (gprojx_is_word(word, size, "element"))
            good = gprojx_read_element(s, ply);
        else if (gprojx_is_word(word, size, "property"))
            good = gprojx_read_property(s, ply);
        else
            good = gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "no header of a PLY has a line '%s'",
                                        gprojx_shown(word, size, shown));
        if (!good) return false;
    }
    if (!format) return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->at, "the header names no format");
    if (!gprojx_check_vertices(s, ply)) return false;
    if (s->encoding == GPROJX_ASCII) return true;
    s->at += 1 + (size_t)crlf;
    s->line = 0;
    return true;
}

/* Reads a number of a type: the next word of a text, else the next bytes. */
static bool gprojx_read_value(gprojx_source *s, gprojx_type type, double *value) {
    size_t size = (size_t)gprojx_type_size(type), i;
    uint64_t bits = 0;
    if (s->encoding == GPROJX_ASCII) return gprojx_number(s, value);
    if (s->at > s->size || s->size - s->at < size)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, s->size,
                                    "the file ends before all that its header promises");
    for (i = 0; i < size; ++i) bits = bits << 8 | s->bytes[s->at + (s->encoding == GPROJX_BIG ? i : size - 1 - i)];
    s->at += size;
    switch (type) {
    case GPROJX_FLOAT32: *value = gprojx_float((uint32_t)bits); break;
    case GPROJX_FLOAT64: memcpy(value, &bits, sizeof *value); break;
    case GPROJX_INT8: *value = (double)bits - (bits >> 7 ? 256.0 : 0.0); break;
    case GPROJX_INT16: *value = (double)bits - (bits >> 15 ? 65536.0 : 0.0); break;
    case GPROJX_INT32: *value = (double)bits - (bits >> 31 ? 4294967296.0 : 0.0); break;
    default: *value = (double)bits; break;
    }
    return true;
}

/* Reads a list, and keeps it if it holds the corners of a face. */
static bool gprojx_read_list(gprojx_source *s, const gprojx_ply *ply, const gprojx_property *property) {
    double length, value, i;
    size_t at = s->at;
    if (!gprojx_read_value(s, property->length_type, &length)) return false;
    if (!(length >= 0) || length > 2147483647 || floor(length) < length)
        return gprojx_refuse_source(s, GPROJ_ERROR_SYNTAX, at, "a list cannot have this length");
    for (i = 0; i < length; ++i) {
        at = s->at;
        if (!gprojx_read_value(s, property->type, &value)) return false;
        if (property->role != 3) continue;
        if (!(value >= 0 && value < ply->vertices) || floor(value) < value)
            return gprojx_refuse_source(s, GPROJ_ERROR_INDEX, at,
                                        "there is no vertex %.9g; the file has %.0f, counted from 0", value,
                                        ply->vertices);
        if (!gprojx_add_corner(s, (int32_t)value)) return false;
    }
    return property->role != 3 || gprojx_add_degree(s, (int32_t)length);
}

/* Reads one vertex, face or other thing. */
static bool gprojx_read_item(gprojx_source *s, const gprojx_ply *ply, const gprojx_element *element) {
    double p[3] = {0, 0, 0}, value;
    int i;
    for (i = element->first; i < element->end; ++i) {
        const gprojx_property *property = &ply->property[i];
        size_t at = s->at;
        if (property->length_type != GPROJX_TYPE_COUNT) {
            if (!gprojx_read_list(s, ply, property)) return false;
            continue;
        }
        if (!gprojx_read_value(s, property->type, &value)) return false;
        if (property->role < 0) continue;
        p[property->role] = value;
        if (!gprojx_is_finite(s, at, value)) return false;
    }
    return !element->vertices || gprojx_add_vertex(s, p);
}

static bool gprojx_read_ply(gprojx_source *s) {
    gprojx_ply ply;
    int e;
    double i;
    if (!gprojx_read_header(s, &ply)) return false;
    if (ply.vertices > INT32_MAX)
        return gprojx_refuse_source(s, GPROJ_ERROR_SIZE, s->at, "more vertices than a mesh can have");
    for (e = 0; e < ply.element_count; ++e) {
        const gprojx_element *element = &ply.element[e];
        if (element->first == element->end) continue; /* nothing is written of these, whatever their number */
        for (i = 0; i < element->count; ++i)
            if (!gprojx_read_item(s, &ply, element)) return false;
    }
    if (s->face_count > INT32_MAX || s->corner_count > INT32_MAX)
        return gprojx_refuse_source(s, GPROJ_ERROR_SIZE, s->at, "more faces than a mesh can have");
    return true;
}

/* Tells STL and PLY by the first word, binary STL by the size that it promises. */
static gprojx_format gprojx_format_of(const void *bytes, size_t size) {
    const char *text = (const char *)bytes;
    if (size >= 4 && memcmp(text, "ply", 3) == 0 && isspace((unsigned char)text[3])) return GPROJX_PLY;
    if (size >= 6 && gprojx_is_word(text, 5, "solid") && isspace((unsigned char)text[5])) return GPROJX_STL;
    return gprojx_has_stl_size((const unsigned char *)bytes, size) ? GPROJX_STL : GPROJX_NEITHER;
}

/* Reads a mesh. Of a PLY: vertices' x, y, z and faces' vertex_indices (or vertex_index); other properties and elements
   are passed over. Of an STL: triangles with vertices of their own; those with two corners at one place are left out
   and counted in *reading (may be NULL). Errors name the line or the byte, those of the mesh the element. */
static gproj_mesh *gprojx_mesh_read(const void *bytes, size_t size, gprojx_format format, gprojx_reading *reading,
                                    const gproj_host *host, gproj_error *error) {
    gprojx_source source;
    gprojx_reading unread;
    gproj_mesh *mesh = NULL;
    if (!reading) reading = &unread;
    reading->left_out = 0, reading->first_left_out = -1;
    memset(&source, 0, sizeof source);
    memset(error, 0, sizeof *error);
    error->index = -1;
    source.bytes = (const unsigned char *)bytes, source.size = size, source.line = 1;
    source.error = error;
    if (format == GPROJX_PLY ? gprojx_read_ply(&source) : gprojx_read_stl(&source, reading))
        mesh = gproj_mesh_create((int32_t)source.vertex_count, source.position, (int32_t)source.face_count,
                                 source.degree, source.corner, host, error);
    free(source.position), free(source.degree), free(source.corner);
    return mesh;
}

/* ---- writing ---- */

typedef struct gprojx_sink {
    gproj_write write;
    void *user;
    gprojx_encoding encoding;
    bool failed; /* the caller's function refused a piece */
} gprojx_sink;

static void gprojx_send(gprojx_sink *sink, const void *bytes, size_t size) {
    if (!sink->failed && !sink->write(sink->user, (const char *)bytes, size)) sink->failed = true;
}
static void gprojx_send_text(gprojx_sink *sink, const char *text) { gprojx_send(sink, text, strlen(text)); }

/* Sends the lower `size` bytes. */
static void gprojx_send_bits(gprojx_sink *sink, uint64_t bits, int size) {
    unsigned char byte[8];
    int i;
    for (i = 0; i < size; ++i)
        byte[sink->encoding == GPROJX_BIG ? size - 1 - i : i] = (unsigned char)(bits >> 8 * i & 255);
    gprojx_send(sink, byte, (size_t)size);
}

static void gprojx_send_float(gprojx_sink *sink, double value) {
    float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    gprojx_send_bits(sink, bits, 4);
}

/* Sends x y z as text. */
static void gprojx_send_point(gprojx_sink *sink, const char *before, const double p[3]) {
    char text[GPROJ_NUMBER_SIZE];
    int k;
    gprojx_send_text(sink, before);
    for (k = 0; k < 3; ++k) {
        gproj_number_write(p[k], text);
        gprojx_send_text(sink, text), gprojx_send_text(sink, k < 2 ? " " : "\n");
    }
}

/* Sends a triangle. The unit normal is 0 without an area. */
static void gprojx_send_triangle(gprojx_sink *sink, const gproj_mesh *mesh, int32_t face) {
    int32_t h = mesh->face_halfedge[face];
    double normal[3], length;
    int k, i;
    gproj_mesh_face_area_vector(mesh, face, normal);
    length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (k = 0; k < 3; ++k) normal[k] = length > 0 && length < HUGE_VAL ? normal[k] / length : 0;
    if (sink->encoding == GPROJX_ASCII) {
        gprojx_send_point(sink, "facet normal ", normal);
        gprojx_send_text(sink, "outer loop\n");
    } else
        for (k = 0; k < 3; ++k) gprojx_send_float(sink, normal[k]);
    for (i = 0; i < 3; ++i, h = mesh->next[h]) {
        const double *p = mesh->position + 3 * (size_t)mesh->origin[h];
        if (sink->encoding == GPROJX_ASCII)
            gprojx_send_point(sink, "vertex ", p);
        else
            for (k = 0; k < 3; ++k) gprojx_send_float(sink, p[k]);
    }
    if (sink->encoding == GPROJX_ASCII)
        gprojx_send_text(sink, "endloop\nendfacet\n");
    else
        gprojx_send_bits(sink, 0, 2);
}

static void gprojx_send_stl(gprojx_sink *sink, const gproj_mesh *mesh) {
    char head[80] = "binary STL, as of guidedproj"; /* not `solid`, by which readers know the text */
    int32_t f;
    if (sink->encoding == GPROJX_ASCII)
        gprojx_send_text(sink, "solid mesh\n");
    else {
        gprojx_send(sink, head, sizeof head);
        gprojx_send_bits(sink, (uint32_t)mesh->face_count, 4);
    }
    for (f = 0; f < mesh->face_count; ++f) gprojx_send_triangle(sink, mesh, f);
    if (sink->encoding == GPROJX_ASCII) gprojx_send_text(sink, "endsolid mesh\n");
}

static void gprojx_send_whole(gprojx_sink *sink, int32_t value, int size, const char *after) {
    char text[32];
    snprintf(text, sizeof text, "%ld%s", (long)value, after);
    if (sink->encoding == GPROJX_ASCII)
        gprojx_send_text(sink, text);
    else
        gprojx_send_bits(sink, (uint32_t)value, size);
}

static void gprojx_send_ply(gprojx_sink *sink, const gproj_mesh *mesh) {
    static const char *const formats[] = {"binary_little_endian", "binary_big_endian", "ascii"};
    char head[400];
    int32_t most = 0, i, k;
    for (i = 0; i < mesh->face_count; ++i)
        if (mesh->face_degree[i] > most) most = mesh->face_degree[i];
    snprintf(head, sizeof head,
             "ply\nformat %s 1.0\nelement vertex %ld\nproperty double x\nproperty double y\nproperty double z\n"
             "element face %ld\nproperty list %s int vertex_indices\nend_header\n",
             formats[sink->encoding], (long)mesh->vertex_count, (long)mesh->face_count, most < 256 ? "uchar" : "uint");
    gprojx_send_text(sink, head);
    for (i = 0; i < mesh->vertex_count; ++i) {
        const double *p = mesh->position + 3 * (size_t)i;
        uint64_t bits;
        if (sink->encoding == GPROJX_ASCII)
            gprojx_send_point(sink, "", p);
        else
            for (k = 0; k < 3; ++k) memcpy(&bits, &p[k], sizeof bits), gprojx_send_bits(sink, bits, 8);
    }
    for (i = 0; i < mesh->face_count; ++i) {
        int32_t h = mesh->face_halfedge[i], degree = mesh->face_degree[i];
        gprojx_send_whole(sink, degree, most < 256 ? 1 : 4, "");
        for (k = 0; k < degree; ++k, h = mesh->next[h]) {
            if (sink->encoding == GPROJX_ASCII) gprojx_send_text(sink, " ");
            gprojx_send_whole(sink, mesh->origin[h], 4, "");
        }
        if (sink->encoding == GPROJX_ASCII) gprojx_send_text(sink, "\n");
    }
}

static gproj_code gprojx_refuse_writing(gproj_error *error, gproj_place place, int32_t index, const char *format) {
    error->code = place == GPROJ_PLACE_NONE ? GPROJ_ERROR_ARGUMENT : GPROJ_ERROR_NUMBER;
    error->place = place, error->index = index;
    snprintf(error->message, sizeof error->message, format, (long)index);
    return error->code;
}

/* Makes a mesh of triangles for an STL, or returns the mesh itself. */
static gproj_mesh *gprojx_triangles(gproj_mesh *mesh, gproj_error *error) {
    gproj_mesh *triangles = NULL;
    gproj_edit *edit;
    int32_t f;
    for (f = 0; f < mesh->face_count && mesh->face_degree[f] == 3; ++f) continue;
    if (f == mesh->face_count) return mesh;
    edit = gproj_edit_create(mesh, NULL, error);
    if (edit && gproj_edit_triangulate(edit, -1, error) >= 0) triangles = gproj_edit_mesh(edit, NULL, error);
    gproj_edit_destroy(edit);
    return triangles;
}

/* Writes a mesh; not its polylines. PLY has doubles that read back to the same bits. STL has triangles (other faces are
   cut as by gproj_edit_triangulate), in binary form as floats and little-endian only. Returns GPROJ_ERROR_FILE if
   `write` returns false, and refuses vertices beyond the range of floats. */
static gproj_code gprojx_mesh_write(gproj_mesh *mesh, gprojx_format format, gprojx_encoding encoding, gproj_write write,
                                    void *user, gproj_error *error) {
    gprojx_sink sink = {write, user, encoding, false};
    gproj_mesh *triangles;
    int32_t i;
    memset(error, 0, sizeof *error);
    error->index = -1;
    if (format == GPROJX_PLY) {
        gprojx_send_ply(&sink, mesh);
    } else {
        if (encoding == GPROJX_BIG)
            return gprojx_refuse_writing(error, GPROJ_PLACE_NONE, -1, "binary STL is little-endian");
        for (i = 0; encoding == GPROJX_LITTLE && i < 3 * mesh->vertex_count; ++i)
            if (!(fabs(mesh->position[i]) <= FLT_MAX))
                return gprojx_refuse_writing(error, GPROJ_PLACE_VERTEX, i / 3,
                                             "vertex %ld is beyond the floats of a binary STL");
        triangles = gprojx_triangles(mesh, error);
        if (!triangles) return error->code;
        gprojx_send_stl(&sink, triangles);
        if (triangles != mesh) gproj_mesh_destroy(triangles);
    }
    if (!sink.failed) return GPROJ_OK;
    error->code = GPROJ_ERROR_FILE;
    snprintf(error->message, sizeof error->message, "%s", gproj_code_string(GPROJ_ERROR_FILE));
    return GPROJ_ERROR_FILE;
}

#endif
