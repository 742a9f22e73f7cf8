/* json.h - writes JSON, for the command lines.

       gprojx_json json = {file, 0, false, false};
       gprojx_json_open(&json, NULL, '{');
       gprojx_json_number(&json, "length", 0.5);
       gprojx_json_close(&json, '}');

   Numbers read back to the same bits, whatever the locale; paths and names that are not UTF-8 stay readable. Include
   guidedproj.h before this file. */
#ifndef GPROJX_JSON_H
#define GPROJX_JSON_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "utf8.h"

typedef struct gprojx_json {
    FILE *file;
    int depth;
    bool comma; /* the open object or array has a member */
    bool row;   /* the open object stands on one line */
} gprojx_json;

/* Begins a member of an object; key NULL: an entry of an array. */
static void gprojx_json_next(gprojx_json *j, const char *key) {
    if (j->comma) fputc(',', j->file);
    if (!j->row)
        fprintf(j->file, "\n%*s", 2 * j->depth, "");
    else if (j->comma)
        fputc(' ', j->file);
    j->comma = true;
    if (key) fprintf(j->file, "\"%s\": ", key);
}

static void gprojx_json_open(gprojx_json *j, const char *key, char bracket) {
    if (j->depth > 0) gprojx_json_next(j, key);
    fputc(bracket, j->file);
    j->depth++;
    j->comma = false;
}

/* Opens an object on one line; objects and arrays inside it are not supported. */
static void gprojx_json_open_row(gprojx_json *j, const char *key) {
    gprojx_json_open(j, key, '{');
    j->row = true;
}

static void gprojx_json_close(gprojx_json *j, char bracket) {
    j->depth--;
    if (!j->row && j->comma) fprintf(j->file, "\n%*s", 2 * j->depth, "");
    fputc(bracket, j->file);
    j->comma = true, j->row = false;
}

/* Writes a number; infinity and NaN, which JSON does not have, become null. */
static void gprojx_json_number(gprojx_json *j, const char *key, double value) {
    char text[GPROJ_NUMBER_SIZE] = "null";
    if (fabs(value) <= 1.7976931348623157e308) gproj_number_write(value, text);
    gprojx_json_next(j, key);
    fputs(text, j->file);
}

static void gprojx_json_integer(gprojx_json *j, const char *key, int64_t value) {
    gprojx_json_next(j, key);
    fprintf(j->file, "%lld", (long long)value);
}

/* Writes a string; bytes that are not UTF-8 (a path may hold any) become question marks. */
static void gprojx_json_string(gprojx_json *j, const char *key, const char *text) {
    size_t size;
    gprojx_json_next(j, key);
    fputc('"', j->file);
    for (; *text; text += size ? size : 1) {
        unsigned char c = (unsigned char)text[0];
        size = gprojx_utf8_size(text);
        if (c == '"' || c == '\\')
            fprintf(j->file, "\\%c", c);
        else if (c < 32 || c == 127)
            fprintf(j->file, "\\u%04x", c);
        else
            fwrite(size ? text : "?", 1, size ? size : 1, j->file);
    }
    fputc('"', j->file);
}

#endif
