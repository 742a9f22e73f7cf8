/* readers.h - reads numbers, lists of vertices, loads and whole files, and prints paths, for the command lines.

   Those that can refuse return false or NULL and say why in `error`, without the name of the file or option. Include
   guidedproj.h before this file. */
#ifndef GPROJX_READERS_H
#define GPROJX_READERS_H

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Keeps an error's sentence; returns false. */
static bool gprojx_refuse(gproj_error *error, gproj_code code, const char *format, ...) {
    va_list list;
    memset(error, 0, sizeof *error);
    error->code = code, error->index = -1;
    va_start(list, format);
    vsnprintf(error->message, sizeof error->message, format, list);
    va_end(list);
    return false;
}

/* ---- words ---- */

/* Prints text on one line: names of files may hold newlines, and control characters (of UTF-8 also U+0080 to U+009F) that
   terminals obey. */
static void gprojx_print_plain(FILE *file, const char *text) {
    for (; *text; ++text) {
        unsigned char c = (unsigned char)*text, after = (unsigned char)text[1];
        bool wide = c == 0xc2 && after >= 0x80 && after < 0xa0;
        fputc(c < 32 || c == 127 || wide ? '?' : c, file);
        text += wide;
    }
}

/* ---- numbers and lists ---- */

/* Reads text[0..size-1], all of which must be one finite number. */
static bool gprojx_read_number(const char *text, size_t size, double *value) {
    return size > 0 && gproj_number_read(text, size, value) == size && fabs(*value) <= 1.7976931348623157e308;
}

/* Reads text[0..size-1], all of which must be a whole number in low..high. */
static bool gprojx_read_integer(const char *text, size_t size, int32_t low, int32_t high, int32_t *value) {
    int64_t sum = 0;
    size_t i;
    for (i = 0; i < size; ++i) {
        if (text[i] < '0' || text[i] > '9') return false;
        if (sum <= INT32_MAX) sum = 10 * sum + (text[i] - '0');
    }
    if (size == 0 || sum < low || sum > high) return false;
    *value = (int32_t)sum;
    return true;
}

/* The line of a place in a text, as the beginning of a sentence; "" where the text is a single line. */
static const char *gprojx_line_at(const char *text, const char *at, char words[32]) {
    long line = 1;
    words[0] = 0;
    if (!strchr(text, '\n')) return words;
    for (; text < at; ++text) line += *text == '\n';
    snprintf(words, 32, "line %ld: ", line);
    return words;
}

/* Marks the vertices of a list I,J,K-L in any layout; comments go from # to the end of the line. */
static bool gprojx_mark_list(const char *text, int32_t vertex_count, bool *mark, gproj_error *error) {
    const char *at = text;
    char line[32];
    for (;;) {
        int32_t range[2], k;
        while (*at == ',' || *at == '#' || isspace((unsigned char)*at)) at += *at == '#' ? strcspn(at, "\r\n") : 1;
        if (!*at) return true;
        for (k = 0; k < 2; ++k) {
            size_t size = strspn(at, "0123456789");
            if (size == 0) {
                size_t word = strcspn(at, ", \t\r\n");
                return gprojx_refuse(error, GPROJ_ERROR_SYNTAX, "%sexpected vertices, such as 0,7,20-29, at '%.*s'",
                                     gprojx_line_at(text, at, line), word < 20 ? (int)word : 20, at);
            }
            if (!gprojx_read_integer(at, size, 0, vertex_count - 1, &range[k]))
                return gprojx_refuse(error, GPROJ_ERROR_INDEX,
                                     "%sthere is no vertex %.*s; the mesh has %ld, counted from 0",
                                     gprojx_line_at(text, at, line), (int)size, at, (long)vertex_count);
            at += size;
            if (k == 0 && *at != '-') range[k = 1] = range[0];
            at += k == 0;
        }
        if (range[1] < range[0])
            return gprojx_refuse(error, GPROJ_ERROR_SYNTAX, "%sthe range %ld-%ld runs backwards",
                                 gprojx_line_at(text, at, line), (long)range[0], (long)range[1]);
        for (k = range[0]; k <= range[1]; ++k) mark[k] = true;
    }
}

/* ---- loads ---- */

/* Recognises a heading: it begins with a letter, and no number stands behind the first comma. */
static bool gprojx_is_heading(const char *line, size_t size) {
    const char *comma = (const char *)memchr(line, ',', size);
    size_t at = comma ? (size_t)(comma - line) + 1 : size;
    while (at < size && isspace((unsigned char)line[at])) ++at;
    return isalpha((unsigned char)line[0]) && (at == size || !strchr("+-.0123456789", line[at]));
}

/* Reads exactly `count` numbers between commas; blanks around them do not matter. */
static bool gprojx_read_fields(const char *line, size_t size, int32_t count, double *field) {
    size_t at = 0;
    int32_t k;
    for (k = 0; k < count; ++k) {
        const char *comma = (const char *)memchr(line + at, ',', size - at);
        size_t length = comma ? (size_t)(comma - line) - at : size - at;
        size_t next = at + length + 1;
        while (length > 0 && isspace((unsigned char)line[at])) ++at, --length;
        while (length > 0 && isspace((unsigned char)line[at + length - 1])) --length;
        if ((k < count - 1) != (comma != NULL) || !gprojx_read_number(line + at, length, &field[k])) return false;
        at = next;
    }
    return true;
}

/* Refuses numbers that are no vertex; `number` is that of the line. */
static bool gprojx_check_vertex(double vertex, int32_t vertex_count, int32_t number, gproj_error *error) {
    return (vertex >= 0 && vertex < vertex_count && vertex == floor(vertex)) ||
           gprojx_refuse(error, GPROJ_ERROR_INDEX, "line %ld: there is no vertex %g; the mesh has %ld, counted from 0",
                         (long)number, vertex, (long)vertex_count);
}

/* Reads a line VERTEX,FX,FY,FZ; skips empty lines, comments after # and a heading in the first line. */
static bool gprojx_read_load(const char *line, size_t size, int32_t number, int32_t vertex_count, double *load,
                             bool *any, gproj_error *error) {
    double field[4];
    size_t end;
    int32_t k;
    for (end = 0; end < size && line[end] != '#'; ++end) continue;
    while (end > 0 && isspace((unsigned char)line[end - 1])) --end;
    if (end == 0 || (number == 1 && gprojx_is_heading(line, end))) return true;
    if (!gprojx_read_fields(line, end, 4, field))
        return gprojx_refuse(error, GPROJ_ERROR_SYNTAX, "line %ld: expected VERTEX,FX,FY,FZ", (long)number);
    if (!gprojx_check_vertex(field[0], vertex_count, number, error)) return false;
    for (k = 0; k < 3; ++k) load[3 * (size_t)field[0] + (size_t)k] += field[k + 1];
    return *any = true;
}

/* Adds the forces of a CSV text, one at least, to load, 3 * vertex_count numbers. */
static bool gprojx_read_loads(const char *text, int32_t vertex_count, double *load, gproj_error *error) {
    const char *line = text;
    int32_t number = 1;
    bool good = true, any = false;
    for (; good && *line; ++number) {
        size_t size = strcspn(line, "\n");
        good = gprojx_read_load(line, size, number, vertex_count, load, &any, error);
        line += size + (line[size] != 0);
    }
    if (good && !any) return gprojx_refuse(error, GPROJ_ERROR_SYNTAX, "line 1: there are no loads in it");
    return good;
}

/* ---- files ---- */

/* Does a path end so, in capitals or not, behind a name? */
static bool gprojx_has_ending(const char *path, const char *ending) {
    size_t size = strlen(path), length = strlen(ending), i;
    if (size <= length) return false;
    for (i = 0; i < length; ++i)
        if (tolower((unsigned char)path[size - length + i]) != ending[i]) return false;
    return true;
}

/* Does a file with these first bytes go on as a text? */
typedef bool (*gprojx_is_text)(const void *bytes, size_t size);

/* Takes off the byte order mark that some editors put before a text. */
static void gprojx_drop_mark(char *text, size_t *length) {
    if (strncmp(text, "\xef\xbb\xbf", 3) != 0) return;
    *length -= 3;
    memmove(text, text + 3, *length + 1);
}

static bool gprojx_any_text(const void *bytes, size_t size) { return (void)bytes, (void)size, true; }

/* Returns a file of at most `megabytes` with a NUL behind it, by malloc; `length` does not count that. A text (NULL: it is
   none) is read up to the first zero byte, which no text has: devices give such bytes without end. */
static char *gprojx_load_file(const char *path, gprojx_is_text is_text, int32_t megabytes, size_t *length,
                              gproj_error *error) {
    FILE *file = fopen(path, "rb");
    size_t size = 0, capacity = 0, got = 0, most = (size_t)megabytes << 20;
    char *bytes = NULL;
    bool more = file != NULL, good = more;
    if (!file) gprojx_refuse(error, GPROJ_ERROR_FILE, "%s", strerror(errno));
    while (more) {
        if (size + 1 >= capacity) {
            char *moved = (char *)realloc(bytes, capacity = 2 * capacity + 4096);
            if (!moved) {
                good = gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
                break;
            }
            bytes = moved;
        }
        got = fread(bytes + size, 1, capacity - size - 1, file);
        if (is_text && !is_text(bytes, size + got)) is_text = NULL;
        more = got > 0 && !(is_text && memchr(bytes + size, 0, got));
        size += got;
        bytes[size] = 0;
        if (ferror(file)) more = good = gprojx_refuse(error, GPROJ_ERROR_FILE, "%s", strerror(errno));
        if (size > most)
            more = good = gprojx_refuse(error, GPROJ_ERROR_SIZE, "more than %ld MB, or without end", (long)megabytes);
    }
    if (file) fclose(file);
    *length = size;
    if (good) return bytes;
    free(bytes);
    return NULL;
}

#endif
