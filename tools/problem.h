/* problem.h - reads a problem file: what the command line says and more, as JSON.

   From top to bottom: strict JSON with the line of each value; what the sections of a problem may hold; lists of vertices,
   edges and faces; builders, which add a section to a form; handles. Errors say line and key: `12: "rollers": ...`, to
   stand behind the file's name and a colon. Include guidedproj.h before this file. */
#ifndef GPROJX_PROBLEM_H
#define GPROJX_PROBLEM_H

#include "json.h"
#include "readers.h"

enum {
    GPROJX_MOST_VALUES = 4000000, /* in a file: 200 MB */
    GPROJX_MOST_KEYS = 200,       /* in an object: they are compared with each other */
    GPROJX_MOST_DEPTH = 16
};

typedef enum gprojx_json_kind {
    GPROJX_JSON_LITERAL, /* true, false, null */
    GPROJX_JSON_NUMBER,
    GPROJX_JSON_STRING,
    GPROJX_JSON_ARRAY,
    GPROJX_JSON_OBJECT
} gprojx_json_kind;

typedef struct gprojx_value {
    gprojx_json_kind kind;
    int32_t line;        /* from 1 */
    int32_t count, next; /* values inside; the value behind this one in the array or object, -1: none */
    const char *key;     /* in an object, else NULL */
    const char *text;    /* of literals and numbers as it stands, of strings without escapes */
    size_t size;         /* of the text */
    double number;
} gprojx_value;

/* Loads the mesh in a file for a section; NULL: refused, and `user` has said so. */
typedef gproj_mesh *(*gprojx_load_mesh)(void *user, const char *path, int32_t line);

typedef struct gprojx_problem {
    char *text;          /* owned; keys and texts point into it */
    gprojx_value *value; /* parents before what is inside them; value[0] is the whole */
    int32_t count, capacity;
    /* the work */
    gproj_form *form;
    gproj_mesh *mesh;
    const gproj_host *host;
    gprojx_load_mesh load;
    void *user;
    gproj_curve **curve;
    int32_t curve_count;
    int32_t *list; /* room for all vertices, edges or faces */
    bool *mark;    /* likewise */
} gprojx_problem;

static void gprojx_problem_free(gprojx_problem *p) {
    int32_t i;
    for (i = 0; i < p->curve_count; ++i) gproj_curve_destroy(p->curve[i]);
    free(p->curve), free(p->list), free(p->mark), free(p->value), free(p->text);
    memset(p, 0, sizeof *p);
}

/* The first value inside an array or object, and the one behind a value; NULL: there is none. */
static const gprojx_value *gprojx_inside(const gprojx_value *v) { return v->count > 0 ? v + 1 : NULL; }
static const gprojx_value *gprojx_after(const gprojx_problem *p, const gprojx_value *v) {
    return v->next >= 0 ? p->value + v->next : NULL;
}

/* Finds a member of an object; NULL: it has none with this key. */
static const gprojx_value *gprojx_member(const gprojx_problem *p, const gprojx_value *object, const char *key) {
    const gprojx_value *v;
    for (v = gprojx_inside(object); v; v = gprojx_after(p, v))
        if (strcmp(v->key, key) == 0) return v;
    return NULL;
}

/* ---- JSON ---- */

typedef struct gprojx_json_reader {
    gprojx_problem *p;
    char *at, *end;
    int32_t line, depth;
    const char *key; /* the one read last, for sentences */
    gproj_error *error;
} gprojx_json_reader;

static bool gprojx_json_refuse(const gprojx_json_reader *r, const char *sentence) {
    return gprojx_refuse(r->error, GPROJ_ERROR_SYNTAX, "%ld: %s%.60s%s%s", (long)r->line, r->key ? "\"" : "",
                         r->key ? r->key : "", r->key ? "\": " : "", sentence);
}

static void gprojx_json_skip(gprojx_json_reader *r) {
    for (; *r->at == ' ' || *r->at == '\t' || *r->at == '\r' || *r->at == '\n'; ++r->at) r->line += *r->at == '\n';
}

/* Reads the four hexadecimal digits of \uXXXX; -1: they are none. */
static int32_t gprojx_json_hex(const char *text) {
    int32_t code = 0, k;
    for (k = 0; k < 4; ++k) {
        const char *digits = "0123456789abcdef";
        const char *digit = text[k] ? strchr(digits, tolower((unsigned char)text[k])) : NULL;
        if (!digit) return -1;
        code = 16 * code + (int32_t)(digit - digits);
    }
    return code;
}

/* Writes a character as UTF-8; returns the place behind it. */
static char *gprojx_json_put(char *to, int32_t code) {
    int32_t more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static const int32_t first[4] = {0, 0xc0, 0xe0, 0xf0};
    *to++ = (char)(first[more] | code >> 6 * more);
    while (more-- > 0) *to++ = (char)(0x80 | ((code >> 6 * more) & 0x3f));
    return to;
}

/* Reads an escape behind its backslash. */
static bool gprojx_json_escape(gprojx_json_reader *r, char **to) {
    static const char names[] = "\"\\/bfnrt", codes[] = "\"\\/\b\f\n\r\t";
    const char *name = *r->at ? strchr(names, *r->at) : NULL;
    int32_t code, low;
    if (name) {
        *(*to)++ = codes[name - names];
        ++r->at;
        return true;
    }
    code = *r->at == 'u' ? gprojx_json_hex(r->at + 1) : -1;
    if (code <= 0)
        return gprojx_json_refuse(r,
                                  "a backslash in a string begins none of \\\" \\\\ \\/ \\b \\f \\n \\r \\t \\uXXXX");
    r->at += 5;
    if (code >= 0xd800 && code < 0xe000) { /* half of a character beyond 16 bits */
        low = r->at[0] == '\\' && r->at[1] == 'u' ? gprojx_json_hex(r->at + 2) : -1;
        if (code >= 0xdc00 || low < 0xdc00 || low >= 0xe000)
            return gprojx_json_refuse(r, "\\uXXXX in a string is half of a character");
        code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
        r->at += 6;
    }
    *to = gprojx_json_put(*to, code);
    return true;
}

/* Reads a string in place, from its first quote. */
static bool gprojx_json_text(gprojx_json_reader *r, const char **text, size_t *size) {
    char *to = ++r->at;
    *text = to;
    while (*r->at != '"') {
        size_t bytes = (unsigned char)*r->at < 32 ? 0 : gprojx_utf8_size(r->at);
        if (bytes == 0)
            return gprojx_json_refuse(r, (unsigned char)*r->at < 32
                                             ? "a string has no end, or a control character in it"
                                             : "a string is not UTF-8");
        if (*r->at == '\\') {
            ++r->at;
            if (!gprojx_json_escape(r, &to)) return false;
            continue;
        }
        memmove(to, r->at, bytes);
        to += bytes, r->at += bytes;
    }
    ++r->at; /* `to` is at most the quote: there is room for a NUL */
    *to = 0;
    *size = (size_t)(to - *text);
    return true;
}

/* Reads a number by JSON's grammar, which is narrower than that of other files. */
static bool gprojx_json_digits(gprojx_json_reader *r, gprojx_value *v) {
    char *from = r->at, *at = from + (*from == '-');
    size_t digits = strspn(at, "0123456789");
    bool good = digits > 0 && (at[0] != '0' || digits == 1);
    at += digits;
    if (*at == '.') {
        digits = strspn(++at, "0123456789");
        good = good && digits > 0;
        at += digits;
    }
    if (*at == 'e' || *at == 'E') {
        ++at;
        at += *at == '+' || *at == '-';
        digits = strspn(at, "0123456789");
        good = good && digits > 0;
        at += digits;
    }
    v->kind = GPROJX_JSON_NUMBER;
    v->text = from, v->size = (size_t)(at - from);
    r->at = at;
    return (good && gprojx_read_number(from, v->size, &v->number)) ||
           gprojx_json_refuse(r, "expected a value: a string, a number, true, an array or an object");
}

static bool gprojx_json_literal(gprojx_json_reader *r, gprojx_value *v) {
    static const char *const words[] = {"true", "false", "null"};
    size_t size = strspn(r->at, "abcdefghijklmnopqrstuvwxyz");
    int k;
    for (k = 0; k < 3; ++k)
        if (strlen(words[k]) == size && memcmp(words[k], r->at, size) == 0) {
            v->kind = GPROJX_JSON_LITERAL, v->text = words[k], v->size = size;
            r->at += size;
            return true;
        }
    return gprojx_json_digits(r, v);
}

/* Appends a value; its number, -1 without memory or room. */
static int32_t gprojx_json_append(gprojx_json_reader *r) {
    gprojx_problem *p = r->p;
    if (p->count == GPROJX_MOST_VALUES) return gprojx_json_refuse(r, "the file has more than 4000000 values"), -1;
    if (p->count == p->capacity) {
        int32_t capacity = 2 * p->capacity + 64;
        gprojx_value *moved = (gprojx_value *)realloc(p->value, (size_t)capacity * sizeof *moved);
        if (!moved) return gprojx_refuse(r->error, GPROJ_ERROR_MEMORY, "out of memory"), -1;
        p->value = moved, p->capacity = capacity;
    }
    memset(&p->value[p->count], 0, sizeof *p->value);
    p->value[p->count].line = r->line, p->value[p->count].next = -1;
    return p->count++;
}

/* Reads "KEY": and refuses one that the object has already. */
static bool gprojx_json_key(gprojx_json_reader *r, int32_t object, const char **key) {
    const gprojx_problem *p = r->p;
    size_t size;
    if (*r->at != '"') return gprojx_json_refuse(r, "expected a key in quotes, or }");
    if (!gprojx_json_text(r, key, &size)) return false;
    r->key = *key;
    if (gprojx_member(p, &p->value[object], *key)) return gprojx_json_refuse(r, "the key stands twice in its object");
    if (p->value[object].count == GPROJX_MOST_KEYS) return gprojx_json_refuse(r, "an object has more than 200 keys");
    gprojx_json_skip(r);
    if (*r->at != ':') return gprojx_json_refuse(r, "expected : after the key");
    ++r->at;
    gprojx_json_skip(r);
    return true;
}

static int32_t gprojx_json_value(gprojx_json_reader *r);

/* Reads what stands between the brackets of an array or object. */
static bool gprojx_json_inside(gprojx_json_reader *r, int32_t parent, bool object) {
    const char *key = NULL;
    int32_t before = -1, child;
    char end = object ? '}' : ']';
    ++r->at;
    gprojx_json_skip(r);
    while (*r->at != end || before >= 0) { /* a bracket behind a comma is no value */
        if (object && !gprojx_json_key(r, parent, &key)) return false;
        child = gprojx_json_value(r);
        if (child < 0) return false;
        r->p->value[child].key = key;
        if (before >= 0) r->p->value[before].next = child;
        before = child;
        r->p->value[parent].count++;
        gprojx_json_skip(r);
        if (*r->at == end) break;
        if (*r->at != ',')
            return gprojx_json_refuse(r,
                                      object ? "expected , or } after the value" : "expected , or ] after the value");
        ++r->at;
        gprojx_json_skip(r);
    }
    ++r->at;
    return true;
}

/* Reads a value; returns its number, or -1. */
static int32_t gprojx_json_value(gprojx_json_reader *r) {
    int32_t i = gprojx_json_append(r);
    gprojx_value *v = i < 0 ? NULL : &r->p->value[i];
    bool object = *r->at == '{', good;
    if (!v) return -1;
    if (object || *r->at == '[') {
        v->kind = object ? GPROJX_JSON_OBJECT : GPROJX_JSON_ARRAY;
        if (++r->depth > GPROJX_MOST_DEPTH)
            return gprojx_json_refuse(r, "arrays and objects are more than 16 deep"), -1;
        good = gprojx_json_inside(r, i, object); /* which moves the values */
        --r->depth;
    } else if (*r->at == '"') {
        v->kind = GPROJX_JSON_STRING;
        good = gprojx_json_text(r, &v->text, &v->size);
    } else
        good = gprojx_json_literal(r, v);
    return good ? i : -1;
}

/* Reads a text of `size` bytes with a NUL behind it, by malloc, which the problem then owns. */
static bool gprojx_problem_parse(gprojx_problem *p, char *text, size_t size, gproj_error *error) {
    gprojx_json_reader r = {p, text, text + size, 1, 0, NULL, error};
    int32_t i;
    p->text = text;
    if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) r.at += 3; /* a byte order mark */
    gprojx_json_skip(&r);
    if (*r.at != '{') return gprojx_json_refuse(&r, "a problem is a JSON object: { \"KEY\": VALUE, ... }");
    if (gprojx_json_value(&r) < 0) return false;
    r.key = NULL;
    gprojx_json_skip(&r);
    if (r.at != r.end) return gprojx_json_refuse(&r, "there is more behind the last }");
    for (i = 0; i < p->count; ++i) /* only now: the byte behind a number was needed */
        if (p->value[i].kind == GPROJX_JSON_NUMBER) text[p->value[i].text + p->value[i].size - text] = 0;
    return true;
}

/* Writes a value as it was read; objects inside others on a line each. */
static void gprojx_problem_write_value(gprojx_json *j, const gprojx_problem *p, const gprojx_value *v) {
    const gprojx_value *inside;
    bool object = v->kind == GPROJX_JSON_OBJECT;
    if (v->kind == GPROJX_JSON_STRING)
        gprojx_json_string(j, v->key, v->text);
    else if (v->kind == GPROJX_JSON_NUMBER || v->kind == GPROJX_JSON_LITERAL)
        gprojx_json_next(j, v->key), fputs(v->text, j->file);
    else {
        bool row = j->row;
        gprojx_json_open(j, v->key, object ? '{' : '[');
        j->row = row || object || v->count == 0 || v[1].kind != GPROJX_JSON_OBJECT;
        for (inside = gprojx_inside(v); inside; inside = gprojx_after(p, inside))
            gprojx_problem_write_value(j, p, inside);
        gprojx_json_close(j, object ? '}' : ']');
        j->row = row;
    }
}

/* ---- what the sections may hold ---- */

/* Refuses a value: its line, the key of the section, the sentence. */
static bool gprojx_problem_refuse(const gprojx_value *v, const char *section, gproj_error *error, const char *format,
                                  ...) {
    char sentence[300];
    va_list list;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    return gprojx_refuse(error, GPROJ_ERROR_SYNTAX, "%ld: \"%.60s\": %s", (long)v->line, section, sentence);
}

static bool gprojx_is_number(const gprojx_value *v) { return v->kind == GPROJX_JSON_NUMBER; }
static bool gprojx_is_string(const gprojx_value *v) { return v->kind == GPROJX_JSON_STRING && v->size > 0; }
static bool gprojx_is_index(const gprojx_value *v) {
    return gprojx_is_number(v) && v->number >= 0 && v->number <= INT32_MAX && v->number == floor(v->number);
}

/* Are these all entries of an array of `least` or more? */
static bool gprojx_all(const gprojx_problem *p, const gprojx_value *array, int32_t least,
                       bool (*is)(const gprojx_value *v)) {
    const gprojx_value *v;
    if (array->kind != GPROJX_JSON_ARRAY || array->count < least) return false;
    for (v = gprojx_inside(array); v; v = gprojx_after(p, v))
        if (!is(v)) return false;
    return true;
}

/* Finds the kind of rows by its name; -1: there is none. */
static int gprojx_find_kind(const char *name) {
    static const char *const names[] = {"constraint", "wish", "bound"}; /* as in gproj_kind */
    int k;
    for (k = 0; k < 3; ++k)
        if (strcmp(name, names[k]) == 0) return k;
    return -1;
}

static bool gprojx_is_triple(const gprojx_problem *p, const gprojx_value *v) {
    return v->count == 3 && gprojx_all(p, v, 3, gprojx_is_number);
}
static bool gprojx_is_list(const gprojx_problem *p, const gprojx_value *v) {
    return gprojx_is_string(v) || gprojx_all(p, v, 1, gprojx_is_index);
}
static bool gprojx_is_chains(const gprojx_problem *p, const gprojx_value *v) {
    const gprojx_value *chain;
    if (v->kind != GPROJX_JSON_ARRAY) return gprojx_is_string(v);
    for (chain = gprojx_inside(v); chain; chain = gprojx_after(p, chain))
        if (!gprojx_all(p, chain, 2, gprojx_is_index)) return false;
    return v->count > 0;
}
static bool gprojx_is_points(const gprojx_problem *p, const gprojx_value *v) {
    const gprojx_value *point;
    if (v->kind != GPROJX_JSON_ARRAY || v->count < 2) return false;
    for (point = gprojx_inside(v); point; point = gprojx_after(p, point))
        if (!gprojx_is_triple(p, point)) return false;
    return true;
}
/* Are these terms [FACTOR, "NAME"] or [FACTOR, "NAME", "NAME"]? */
static bool gprojx_is_terms(const gprojx_problem *p, const gprojx_value *v) {
    const gprojx_value *term, *name;
    if (v->kind != GPROJX_JSON_ARRAY || v->count == 0) return false;
    for (term = gprojx_inside(v); term; term = gprojx_after(p, term)) {
        if (term->kind != GPROJX_JSON_ARRAY || term->count < 2 || term->count > 3) return false;
        name = gprojx_inside(term);
        if (!gprojx_is_number(name)) return false;
        while ((name = gprojx_after(p, name)))
            if (!gprojx_is_string(name)) return false;
    }
    return true;
}
static bool gprojx_is_numbers(const gprojx_problem *p, const gprojx_value *v) {
    return gprojx_all(p, v, 1, gprojx_is_number);
}
static bool gprojx_is_any_number(const gprojx_problem *p, const gprojx_value *v) {
    return (void)p, gprojx_is_number(v);
}
static bool gprojx_is_kind(const gprojx_problem *p, const gprojx_value *v) {
    return (void)p, gprojx_is_string(v) && gprojx_find_kind(v->text) >= 0;
}
static bool gprojx_is_flag(const gprojx_problem *p, const gprojx_value *v) {
    return (void)p, v->kind == GPROJX_JSON_LITERAL && v->text[0] != 'n';
}
static bool gprojx_is_name(const gprojx_problem *p, const gprojx_value *v) { return (void)p, gprojx_is_string(v); }
static bool gprojx_is_count(const gprojx_problem *p, const gprojx_value *v) { return (void)p, gprojx_is_index(v); }
static bool gprojx_is_weight(const gprojx_problem *p, const gprojx_value *v) {
    return (void)p, gprojx_is_number(v) && v->number >= 0 && v->number <= 1e50;
}
static bool gprojx_is_positive(const gprojx_problem *p, const gprojx_value *v) {
    return (void)p, gprojx_is_number(v) && v->number > 0;
}
static bool gprojx_is_axes(const gprojx_problem *p, const gprojx_value *v) {
    return (void)p, gprojx_is_string(v) && v->size <= 3 && strspn(v->text, "xyz") == v->size;
}

/* The members of all sections. */
static const struct gprojx_member_rule {
    const char *key, *expected;
    bool (*is)(const gprojx_problem *p, const gprojx_value *v);
} gprojx_members[] = {
    {"vertices", "boundary, corners, a list such as \"0,7,20-29\", or an array of vertices", gprojx_is_list},
    {"edges", "all, boundary, inner, or an array of chains of vertices, such as [[0, 1], [4, 5, 6]]", gprojx_is_chains},
    {"faces", "a list such as \"0,7,20-29\", or an array of faces", gprojx_is_list},
    {"points", "an array of two or more points [X, Y, Z]", gprojx_is_points},
    {"closed", "true or false", gprojx_is_flag},
    {"file", "the path of a file", gprojx_is_name},
    {"polyline", "a number, counted from 0", gprojx_is_count},
    {"weight", "a number from 0 to 1e50", gprojx_is_weight},
    {"length", "a number above 0", gprojx_is_positive},
    {"section", "a number above 0", gprojx_is_positive},
    {"density", "a number of 0 or larger", gprojx_is_weight},
    {"free", "one or more of the letters x, y and z", gprojx_is_axes},
    {"of", "the name of an option", gprojx_is_name},
    {"vertex", "a vertex, counted from 0", gprojx_is_count},
    {"level", "a number of subdivisions, from 0", gprojx_is_count},
    {"by", "[DX, DY, DZ]", gprojx_is_triple},
    {"terms", "an array of terms [FACTOR, \"NAME\"] or [FACTOR, \"NAME\", \"NAME\"]", gprojx_is_terms},
    {"constant", "a number", gprojx_is_any_number},
    {"unknowns", "an array of numbers, where the unknowns start", gprojx_is_numbers},
    {"kind", "constraint, wish or bound", gprojx_is_kind},
};

static bool gprojx_build_curve(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error);
static bool gprojx_build_plane(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error);
static bool gprojx_build_line(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error);
static bool gprojx_build_lengths(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error);
static bool gprojx_build_roller(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error);
static bool gprojx_build_rows(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error);

/* The sections: each is an array of objects with these members, of which those before | are needed. */
static const struct gprojx_section {
    const char *key, *members;
    bool (*build)(gprojx_problem *p, const gprojx_value *item, double weight,
                  gproj_error *error); /* NULL: read elsewhere */
} gprojx_sections[] = {
    {"curves", "vertices | points closed file polyline weight", gprojx_build_curve},
    {"coplanar", "vertices | weight", gprojx_build_plane},
    {"collinear", "vertices | weight", gprojx_build_line},
    {"lengths", "edges | length weight", gprojx_build_lengths},
    {"rollers", "vertices free | weight", gprojx_build_roller},
    {"rows", "terms | vertices constant unknowns kind weight", gprojx_build_rows},
    {"sections", "edges section |", NULL},
    {"densities", "edges density |", NULL},
    {"weights", "of weight | vertices edges faces", NULL},
    {"handles", "vertex by | level", NULL},
    {"pulls", "vertex by | level", NULL},
};

enum {
    GPROJX_SECTION_COUNT = (int)(sizeof gprojx_sections / sizeof gprojx_sections[0])
};

/* Finds a word in a list of words with blanks between them; NULL: it is not there. */
static const char *gprojx_find_word(const char *list, const char *word) {
    size_t size = strlen(word);
    for (; *list; list += strcspn(list, " "), list += *list == ' ')
        if (strncmp(list, word, size) == 0 && (list[size] == ' ' || !list[size])) return list;
    return NULL;
}

/* Refuses members that the section does not have or that are of another kind. */
static bool gprojx_check_member(const gprojx_problem *p, const struct gprojx_section *section, const gprojx_value *v,
                                gproj_error *error) {
    size_t k;
    if (!gprojx_find_word(section->members, v->key) || strcmp(v->key, "|") == 0)
        return gprojx_problem_refuse(v, section->key, error, "there is no key \"%.60s\" here; it has: %s", v->key,
                                     section->members);
    for (k = 0; strcmp(gprojx_members[k].key, v->key) != 0; ++k) continue;
    return gprojx_members[k].is(p, v) ||
           gprojx_problem_refuse(v, section->key, error, "\"%s\": expected %s", v->key, gprojx_members[k].expected);
}

/* Refuses a section that is not as gprojx_sections says. */
static bool gprojx_check_section(const gprojx_problem *p, const struct gprojx_section *section,
                                 const gprojx_value *array, gproj_error *error) {
    const gprojx_value *item, *v;
    size_t k;
    if (array->kind != GPROJX_JSON_ARRAY)
        return gprojx_problem_refuse(array, section->key, error, "expected an array of objects");
    for (item = gprojx_inside(array); item; item = gprojx_after(p, item)) {
        const char *optional = strchr(section->members, '|');
        if (item->kind != GPROJX_JSON_OBJECT)
            return gprojx_problem_refuse(item, section->key, error, "expected an array of objects");
        for (v = gprojx_inside(item); v; v = gprojx_after(p, v))
            if (!gprojx_check_member(p, section, v, error)) return false;
        for (k = 0; k < sizeof gprojx_members / sizeof gprojx_members[0]; ++k) {
            const char *word = gprojx_find_word(section->members, gprojx_members[k].key);
            if (word && word < optional && !gprojx_member(p, item, gprojx_members[k].key))
                return gprojx_problem_refuse(item, section->key, error, "\"%s\" is missing", gprojx_members[k].key);
        }
    }
    return true;
}

/* Finds the rules of a section; NULL: there is none of this name. */
static const struct gprojx_section *gprojx_find_section(const char *key) {
    int k;
    for (k = 0; k < GPROJX_SECTION_COUNT; ++k)
        if (strcmp(gprojx_sections[k].key, key) == 0) return &gprojx_sections[k];
    return NULL;
}

/* ---- lists ---- */

/* Makes room for lists of the mesh's elements. */
static bool gprojx_problem_begin(gprojx_problem *p, gproj_mesh *mesh, gproj_form *form, gproj_error *error) {
    size_t most = (size_t)mesh->vertex_count + (size_t)mesh->edge_count + (size_t)mesh->face_count;
    p->mesh = mesh, p->form = form;
    p->list = (int32_t *)calloc(most + 1, sizeof *p->list);
    p->mark = (bool *)calloc(most + 1, sizeof *p->mark);
    return (p->list && p->mark) || gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
}

/* Marks vertices, or faces, whose `name` is for sentences. */
static bool gprojx_mark_elements(gprojx_problem *p, const gprojx_value *v, const char *section, const char *name,
                                 int32_t count, gproj_error *error) {
    const gprojx_value *entry;
    gproj_error why;
    bool vertices = strcmp(name, "vertex") == 0, boundary, corners;
    int32_t i;
    if (v->kind == GPROJX_JSON_ARRAY) {
        for (entry = gprojx_inside(v); entry; entry = gprojx_after(p, entry)) {
            if (entry->number >= count)
                return gprojx_problem_refuse(entry, section, error,
                                             "there is no %s %s; the mesh has %ld, counted from 0", name, entry->text,
                                             (long)count);
            p->mark[(int32_t)entry->number] = true;
        }
        return true;
    }
    boundary = vertices && strcmp(v->text, "boundary") == 0, corners = vertices && strcmp(v->text, "corners") == 0;
    if (!boundary && !corners)
        return gprojx_mark_list(v->text, count, p->mark, &why) ||
               gprojx_problem_refuse(v, section, error, "\"%s\": %s", v->key, why.message);
    for (i = 0; i < count; ++i)
        p->mark[i] = boundary ? gproj_mesh_is_boundary_vertex(p->mesh, i) : gproj_form_is_corner(p->form, i);
    return true;
}

static bool gprojx_is_vertex(const gproj_mesh *mesh, double number) {
    return number >= 0 && number < mesh->vertex_count && number == floor(number);
}

/* Finds the edge between two vertices; -1: there is none. */
static int32_t gprojx_edge_between(const gproj_mesh *mesh, int32_t a, int32_t b) {
    int32_t start = mesh->vertex_halfedge[a], h = start;
    if (start < 0) return -1;
    do {
        if (mesh->origin[mesh->twin[h]] == b) return h / 2;
        h = mesh->twin[mesh->prev[h]];
    } while (h != start);
    return -1;
}

/* Marks the edges of a chain of vertices. */
static bool gprojx_mark_chain(gprojx_problem *p, const gprojx_value *chain, const char *section, gproj_error *error) {
    const gprojx_value *v;
    int32_t before = -1, vertex, edge;
    for (v = gprojx_inside(chain); v; v = gprojx_after(p, v), before = vertex) {
        if (v->number >= p->mesh->vertex_count)
            return gprojx_problem_refuse(v, section, error, "there is no vertex %s; the mesh has %ld, counted from 0",
                                         v->text, (long)p->mesh->vertex_count);
        vertex = (int32_t)v->number;
        edge = before < 0 ? -1 : gprojx_edge_between(p->mesh, before, vertex);
        if (before >= 0 && edge < 0)
            return gprojx_problem_refuse(v, section, error, "there is no edge between the vertices %ld and %ld",
                                         (long)before, (long)vertex);
        if (edge >= 0) p->mark[edge] = true;
    }
    return true;
}

static bool gprojx_mark_edges(gprojx_problem *p, const gprojx_value *v, const char *section, gproj_error *error) {
    bool all, boundary;
    const gprojx_value *chain;
    int32_t e;
    if (v->kind == GPROJX_JSON_ARRAY) {
        for (chain = gprojx_inside(v); chain; chain = gprojx_after(p, chain))
            if (!gprojx_mark_chain(p, chain, section, error)) return false;
        return true;
    }
    all = strcmp(v->text, "all") == 0, boundary = strcmp(v->text, "boundary") == 0;
    if (!all && !boundary && strcmp(v->text, "inner") != 0)
        return gprojx_problem_refuse(v, section, error,
                                     "\"edges\": expected all, boundary, inner or an array of chains");
    for (e = 0; e < p->mesh->edge_count; ++e)
        p->mark[e] = all || boundary == (p->mesh->face[2 * e] < 0 || p->mesh->face[2 * e + 1] < 0);
    return true;
}

/* Lists the vertices, edges or faces that an item of a section names, ascending; returns their count, or -1: nothing may
   be asked of none. */
static int32_t gprojx_take_list(gprojx_problem *p, const gprojx_value *item, const char *key, const char *section,
                                gproj_error *error) {
    const gprojx_value *v = gprojx_member(p, item, key);
    bool edges = key[0] == 'e', faces = key[0] == 'f';
    int32_t count = edges ? p->mesh->edge_count : faces ? p->mesh->face_count : p->mesh->vertex_count, listed = 0, i;
    memset(p->mark, 0, (size_t)count * sizeof *p->mark);
    if (edges ? !gprojx_mark_edges(p, v, section, error)
              : !gprojx_mark_elements(p, v, section, faces ? "face" : "vertex", count, error))
        return -1;
    for (i = 0; i < count; ++i)
        if (p->mark[i]) p->list[listed++] = i;
    if (listed > 0) return listed;
    gprojx_problem_refuse(item, section, error, "\"%s\" names none of this mesh", key);
    return -1;
}

/* ---- builders ---- */

/* Makes the curve of an item: points, or a polyline or boundary loop of a file. */
static gproj_curve *gprojx_make_curve(gprojx_problem *p, const gprojx_value *item, gproj_error *error) {
    const gprojx_value *points = gprojx_member(p, item, "points"), *closed = gprojx_member(p, item, "closed"), *v, *x;
    const gprojx_value *file = gprojx_member(p, item, "file"), *polyline = gprojx_member(p, item, "polyline");
    gproj_curve *curve = NULL;
    gproj_mesh *mesh;
    int32_t which = polyline ? (int32_t)polyline->number : 0, count;
    if (file) {
        mesh = p->load(p->user, file->text, file->line);
        if (!mesh) return NULL;
        count = mesh->polyline_count > 0 ? mesh->polyline_count : mesh->loop_count;
        if (which >= count)
            gprojx_problem_refuse(polyline ? polyline : file, "curves", error, "%.100s has %ld curves, counted from 0",
                                  file->text, (long)count);
        else
            curve = mesh->polyline_count > 0 ? gproj_curve_from_polyline(mesh, which, p->host, error)
                                             : gproj_curve_from_loop(mesh, which, p->host, error);
        gproj_mesh_destroy(mesh);
    } else {
        double *point = (double *)malloc(3 * (size_t)points->count * sizeof *point), *to = point;
        for (v = gprojx_inside(points); point && v; v = gprojx_after(p, v))
            for (x = gprojx_inside(v); x; x = gprojx_after(p, x)) *to++ = x->number;
        if (point)
            curve = gproj_curve_create(points->count, point, closed && closed->text[0] == 't', p->host, error);
        else
            gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
        free(point);
    }
    return curve;
}

static bool gprojx_build_curve(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error) {
    bool points = gprojx_member(p, item, "points"), file = gprojx_member(p, item, "file");
    gproj_curve **more, *curve;
    gproj_error why;
    int32_t count;
    memset(&why, 0, sizeof why);
    if (points == file) return gprojx_problem_refuse(item, "curves", error, "expected either \"points\" or a \"file\"");
    if (points ? gprojx_member(p, item, "polyline") != NULL : gprojx_member(p, item, "closed") != NULL)
        return gprojx_problem_refuse(item, "curves", error,
                                     "\"closed\" is for \"points\", \"polyline\" for a \"file\"");
    more = (gproj_curve **)realloc(p->curve, (size_t)(p->curve_count + 1) * sizeof(gproj_curve *));
    if (!more) return gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
    p->curve = more;
    curve = gprojx_make_curve(p, item, &why);
    if (!curve && why.code == GPROJ_ERROR_MEMORY) return gprojx_refuse(error, why.code, "out of memory");
    if (!curve && isdigit((unsigned char)why.message[0]))
        return *error = why, false; /* a refusal of ours, with its line */
    if (!curve) return gprojx_problem_refuse(item, "curves", error, "%s", why.message);
    p->curve[p->curve_count++] = curve;
    count = gprojx_take_list(p, item, "vertices", "curves", error);
    if (count > 0 && weight > 0) gproj_add_gliding(p->form, curve, count, p->list, weight);
    return count >= 0;
}

static bool gprojx_build_plane(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error) {
    int32_t count = gprojx_take_list(p, item, "vertices", "coplanar", error);
    if (count > 0 && weight > 0) gproj_add_coplanar(p->form, count, p->list, weight);
    return count >= 0;
}

static bool gprojx_build_line(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error) {
    int32_t count = gprojx_take_list(p, item, "vertices", "collinear", error);
    if (count > 0 && weight > 0) gproj_add_collinear(p->form, count, p->list, weight);
    return count >= 0;
}

static bool gprojx_build_lengths(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error) {
    const gprojx_value *length = gprojx_member(p, item, "length");
    int32_t count = gprojx_take_list(p, item, "edges", "lengths", error), i;
    double *of_edge = count > 0 && length ? (double *)malloc((size_t)count * sizeof *of_edge) : NULL;
    if (count > 0 && length && !of_edge) return gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
    for (i = 0; of_edge && i < count; ++i) of_edge[i] = length->number;
    if (count > 0 && weight > 0) gproj_add_lengths(p->form, count, p->list, of_edge, weight);
    free(of_edge);
    return count >= 0;
}

/* Reads the axes of a word such as xy: 1 for x, 2 for y, 4 for z. */
static uint8_t gprojx_axes(const char *word) {
    return (uint8_t)((strchr(word, 'x') ? 1 : 0) + (strchr(word, 'y') ? 2 : 0) + (strchr(word, 'z') ? 4 : 0));
}

/* Holds the coordinates of rollers that are not free: v_c - p_c = 0. */
static bool gprojx_build_roller(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error) {
    uint8_t axes = gprojx_axes(gprojx_member(p, item, "free")->text);
    int32_t count = gprojx_take_list(p, item, "vertices", "rollers", error), group, i, c;
    if (count <= 0 || weight <= 0 || axes == 7) return count >= 0;
    group = gproj_add_rows(p->form, "rollers", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, weight);
    for (i = 0; i < count; ++i)
        for (c = 0; c < 3; ++c) {
            gproj_term term;
            memset(&term, 0, sizeof term);
            term.i = 3 * p->list[i] + c, term.j = -1, term.a = 1;
            if (!(axes >> c & 1)) gproj_form_add_row(p->form, group, 1, &term, -p->mesh->position[term.i], p->list[i]);
        }
    return true;
}

/* Reads a name in a term of rows: x, y, z of the row's vertex (-1: it has none), x7 of vertex 7, u0 the first of the
   rows' unknowns. Returns the number of the variable, or -1. */
static int32_t gprojx_variable(const gprojx_problem *p, const gprojx_value *name, int32_t vertex, int32_t unknown,
                               int32_t unknowns) {
    int32_t axis = name->text[0] - 'x', number = vertex;
    bool coordinate = axis >= 0 && axis < 3;
    if (!coordinate && name->text[0] != 'u') return -1;
    if ((!coordinate || name->size > 1) &&
        !gprojx_read_integer(name->text + 1, name->size - 1, 0, (coordinate ? p->mesh->vertex_count : unknowns) - 1,
                             &number))
        return -1;
    return !coordinate ? unknown + number : number < 0 ? -1 : 3 * number + axis;
}

/* Adds one row of an item of "rows", for a vertex or (-1) for none. */
static bool gprojx_build_row(gprojx_problem *p, const gprojx_value *item, int32_t group, int32_t vertex,
                             int32_t unknown, gproj_term *term, gproj_error *error) {
    const gprojx_value *terms = gprojx_member(p, item, "terms"), *constant = gprojx_member(p, item, "constant");
    const gprojx_value *unknowns = gprojx_member(p, item, "unknowns"), *from, *name;
    int32_t count = 0;
    for (from = gprojx_inside(terms); from; from = gprojx_after(p, from), ++count) {
        int32_t variable[2] = {-1, -1}, k = 0;
        term[count].a = gprojx_inside(from)->number;
        for (name = gprojx_after(p, gprojx_inside(from)); name; name = gprojx_after(p, name)) {
            variable[k] = gprojx_variable(p, name, vertex, unknown, unknowns ? unknowns->count : 0);
            if (variable[k++] < 0)
                return gprojx_problem_refuse(name, "rows", error,
                                             "there is no \"%.60s\"; expected x, y or z (with \"vertices\"), x7 of "
                                             "vertex 7, or u0 of the \"unknowns\"",
                                             name->text);
        }
        term[count].i = variable[0], term[count].j = variable[1];
    }
    gproj_form_add_row(p->form, group, count, term, constant ? constant->number : 0, vertex);
    return true;
}

/* Adds rows of quadratic terms: one for each vertex, or a single one. See gproj_form_add_row. */
static bool gprojx_build_rows(gprojx_problem *p, const gprojx_value *item, double weight, gproj_error *error) {
    const gprojx_value *unknowns = gprojx_member(p, item, "unknowns"), *kind = gprojx_member(p, item, "kind"), *v;
    bool placed = gprojx_member(p, item, "vertices") != NULL, good = true;
    int32_t count = placed ? gprojx_take_list(p, item, "vertices", "rows", error) : 1, group, unknown = -1, i;
    gproj_term *term;
    if (count <= 0 || weight <= 0) return count >= 0;
    group = gproj_add_rows(p->form, "rows", kind ? (gproj_kind)gprojx_find_kind(kind->text) : GPROJ_CONSTRAINT,
                           placed ? GPROJ_PLACE_VERTEX : GPROJ_PLACE_NONE, weight);
    for (v = unknowns ? gprojx_inside(unknowns) : NULL; v; v = gprojx_after(p, v)) {
        int32_t number = gproj_form_add_unknowns(p->form, group, GPROJ_UNIT_LENGTH, 1, &v->number, NULL, NULL);
        if (unknown < 0) unknown = number;
    }
    if (unknowns && unknown < 0) return true; /* the form says why */
    term = (gproj_term *)malloc((size_t)gprojx_member(p, item, "terms")->count * sizeof *term);
    if (!term) return gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
    for (i = 0; good && i < count; ++i)
        good = gprojx_build_row(p, item, group, placed ? p->list[i] : -1, unknown, term, error);
    free(term);
    return good;
}

/* Adds the items of all sections that build rows. */
static bool gprojx_problem_build(gprojx_problem *p, gproj_error *error) {
    const gprojx_value *array, *item, *weight;
    int k;
    for (k = 0; k < GPROJX_SECTION_COUNT; ++k) {
        array = gprojx_sections[k].build ? gprojx_member(p, p->value, gprojx_sections[k].key) : NULL;
        for (item = array ? gprojx_inside(array) : NULL; item; item = gprojx_after(p, item)) {
            weight = gprojx_member(p, item, "weight");
            if (!gprojx_sections[k].build(p, item, weight ? weight->number : 1, error)) return false;
            if (gproj_form_error(p->form)->code == GPROJ_ERROR_MEMORY)
                return gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
            if (gproj_form_error(p->form)->code != GPROJ_OK)
                return gprojx_problem_refuse(item, gprojx_sections[k].key, error, "%s",
                                             gproj_form_error(p->form)->message);
        }
    }
    return true;
}

/* Writes the values that a section gives to edges, the later item where two name one; other edges keep theirs. */
static bool gprojx_problem_edges(gprojx_problem *p, const char *section, const char *key, double *of_edge,
                                 gproj_error *error) {
    const gprojx_value *array = gprojx_member(p, p->value, section), *item;
    for (item = array ? gprojx_inside(array) : NULL; item; item = gprojx_after(p, item)) {
        int32_t count = gprojx_take_list(p, item, "edges", section, error), i;
        for (i = 0; i < count; ++i) of_edge[p->list[i]] = gprojx_member(p, item, key)->number;
        if (count < 0) return false;
    }
    return true;
}

/* Marks the rollers among the supports, and the axes along which they slide. Two arrays of vertex_count entries. */
static bool gprojx_problem_rollers(gprojx_problem *p, bool *is_support, uint8_t *slides, gproj_error *error) {
    const gprojx_value *array = gprojx_member(p, p->value, "rollers"), *item;
    for (item = array ? gprojx_inside(array) : NULL; item; item = gprojx_after(p, item)) {
        int32_t count = gprojx_take_list(p, item, "vertices", "rollers", error), i;
        for (i = 0; i < count; ++i) {
            is_support[p->list[i]] = true;
            slides[p->list[i]] = gprojx_axes(gprojx_member(p, item, "free")->text);
        }
        if (count < 0) return false;
    }
    return true;
}

/* Sets the weights of one item of "weights" in a group. */
static bool gprojx_problem_weigh(gprojx_problem *p, const gprojx_value *item, int32_t group, gproj_error *error) {
    gproj_place place = group >= 0 ? gproj_form_group_info(p->form, group).place : GPROJ_PLACE_NONE;
    const char *of = gprojx_member(p, item, "of")->text, *key;
    double *weight;
    int32_t count, i;
    bool good;
    key = place == GPROJ_PLACE_VERTEX ? "vertices"
          : place == GPROJ_PLACE_EDGE ? "edges"
          : place == GPROJ_PLACE_FACE ? "faces"
                                      : NULL;
    if (!key) return gprojx_problem_refuse(item, "weights", error, "\"%.60s\" has no weights by element", of);
    for (i = 0; i < 3; ++i) {
        const char *other = i == 0 ? "vertices" : i == 1 ? "edges" : "faces";
        if ((gprojx_member(p, item, other) != NULL) != (strcmp(other, key) == 0))
            return gprojx_problem_refuse(item, "weights", error, "\"%.60s\" has weights for \"%s\" and no others", of,
                                         key);
    }
    count = gprojx_take_list(p, item, key, "weights", error);
    weight = count > 0 ? (double *)malloc((size_t)count * sizeof *weight) : NULL;
    for (i = 0; weight && i < count; ++i) weight[i] = gprojx_member(p, item, "weight")->number;
    good = count <= 0 || (weight && gproj_set_element_weights(p->form, group, count, p->list, weight) == GPROJ_OK);
    free(weight);
    if (count < 0) return false;
    return good || gprojx_problem_refuse(item, "weights", error, "%s", gproj_form_error(p->form)->message);
}

/* ---- handles and pulls ---- */

typedef struct gprojx_handle {
    int32_t level, vertex;
    double by[3];
} gprojx_handle;

/* Reads an item of "handles" or "pulls". */
static gprojx_handle gprojx_read_handle(const gprojx_problem *p, const gprojx_value *item) {
    const gprojx_value *level = gprojx_member(p, item, "level"), *x;
    gprojx_handle handle;
    double *by = handle.by;
    handle.level = level ? (int32_t)level->number : 0;
    handle.vertex = (int32_t)gprojx_member(p, item, "vertex")->number;
    for (x = gprojx_inside(gprojx_member(p, item, "by")); x; x = gprojx_after(p, x)) *by++ = x->number;
    return handle;
}

/* Refuses a handle of a vertex that its level does not have. */
static bool gprojx_check_handle(const gprojx_problem *p, const gprojx_value *item, const char *section,
                                int32_t vertex_count, gproj_error *error) {
    gprojx_handle handle = gprojx_read_handle(p, item);
    return handle.vertex < vertex_count ||
           gprojx_problem_refuse(gprojx_member(p, item, "vertex"), section, error,
                                 "there is no vertex %ld on level %ld; it has %ld, counted from 0", (long)handle.vertex,
                                 (long)handle.level, (long)vertex_count);
}

/* Moves vertices of a mesh after `level` subdivisions by the handles of this level. */
static bool gprojx_move_handles(const gprojx_problem *p, gproj_mesh *mesh, int32_t level, gproj_error *error) {
    const gprojx_value *array = gprojx_member(p, p->value, "handles"), *item;
    int k;
    for (item = array ? gprojx_inside(array) : NULL; item; item = gprojx_after(p, item)) {
        gprojx_handle handle = gprojx_read_handle(p, item);
        if (handle.level != level) continue;
        if (!gprojx_check_handle(p, item, "handles", mesh->vertex_count, error)) return false;
        for (k = 0; k < 3; ++k) mesh->position[3 * (size_t)handle.vertex + (size_t)k] += handle.by[k];
    }
    return true;
}

#endif
