/* guidedproj.c - form-finding with polygon meshes from the command line.

       cc -O2 -o guidedproj guidedproj.c -lm -lpthread
       ./guidedproj roof.obj -o flat.obj --planar --glide boundary --picture flat.svg

   From top to bottom: the run and its errors; numbers and words; one reader for each kind of value; the table of
   options; the command line; files; the form; progress; outputs (mesh, report, picture); main. */
#define _XOPEN_SOURCE 700

#define GPROJ_STATIC
#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "picture.h"
#include "report.h"
#include "threads.h"

#ifdef GPROJ_VERSION
#define TOOL_VERSION GPROJ_VERSION
#else
#define TOOL_VERSION "0.1"
#endif

/* ---- the run ---- */

enum {
    EXIT_REACHED = 0,
    EXIT_NOT_REACHED = 1,
    EXIT_USAGE = 2,
    EXIT_REFUSED = 3,
    EXIT_MEMORY = 4
};
enum {
    MOST_OPTIONS = 64,
    MOST_ITERATIONS = 100000,
    MOST_THREADS = 256,
    MOST_LEVELS = 14,
    MOST_SIDES = 64,
    MOST_DRAGS = 50 /* and releases, for one --move */
};

static const double SAME_PLACE = 1e-6; /* in mean edge lengths */

typedef struct tool_weight { /* a weight with its schedule; last 0: a few iterations */
    bool given;
    double weight, decay;
    int32_t last;
} tool_weight;

typedef struct tool_word { /* the value of --fix, --glide, --reference: a word or a path, and a weight */
    const char *text;
    size_t length;
    tool_weight weight;
} tool_word;

typedef struct tool_volume { /* an absolute one, or a factor of the input's */
    bool given, factor;
    double value;
} tool_volume;

typedef struct tool_range { /* at least and at most; 0: no bound */
    bool given;
    double min, max, weight;
} tool_range;

typedef struct tool_move {
    int32_t vertex;
    double position[3], weight;
} tool_move;

typedef struct tool_subdivision {
    int32_t levels; /* 0: none */
    gproj_scheme scheme;
} tool_subdivision;

typedef struct tool_sides { /* numbers of edges */
    int32_t count, edges[MOST_SIDES];
} tool_sides;

typedef struct tool_output {
    const char *path;
    char *target;    /* the path without symbolic links */
    char *temporary; /* beside the target; NULL before it is written, and for devices and pipes */
    bool device;     /* exists and is no regular file: written directly */
} tool_output;

enum {
    OUTPUT_MESH,
    OUTPUT_REPORT,
    OUTPUT_PICTURE,
    OUTPUT_FORCES,
    OUTPUT_OFFSET,
    OUTPUT_SUPPORT,
    OUTPUT_STATE, /* and an input, where the file exists */
    OUTPUT_COUNT
};

typedef struct tool {
    /* what the command line says */
    const char *input;
    tool_output output[OUTPUT_COUNT];
    const char *fill; /* a file with a curve; NULL: the mesh is the input */
    tool_sides sides;
    tool_subdivision subdivision;
    double lift; /* 0: none */
    double weld; /* in mean edge lengths; 0: vertices at the same place stay apart */
    tool_weight planar, circular, conical, planar_boundary, straight_boundary, orthogonal_boundary, lifting, closeness,
        fairness, boundary_fairness, tangential, gauss, parallelograms, equal_areas;
    tool_weight equal_lengths;
    tool_range edge_length, face_area;
    tool_volume volume, total_area, cost;
    double length_price, area_price;
    tool_weight equilibrium, compressive, tensile, force_fairness;
    tool_range stress;
    double density, area_load, snow;
    const char *loads;
    bool loads_given; /* any of them */
    tool_word supports;
    tool_word *fix, *glide; /* as many as the command line has words, at most */
    tool_move *move;
    int32_t *move_group; /* for each of `move`: its group in the form, -1: none of its own */
    int32_t fix_count, glide_count, move_count;
    tool_word reference;
    int32_t iterations, threads;
    double epsilon, tolerance, time_limit;
    double offset_distance; /* of output[OUTPUT_OFFSET] */
    gprojx_view view;
    const struct tool_colour *colour; /* what colours the faces of the picture; NULL: planarity */
    bool nearest, allow_spoiled, view_given, quiet, help, version;
    bool seen[MOST_OPTIONS];

    /* the work */
    gproj_host host;
    gprojx_threads *pool;
    gproj_mesh *mesh, *reference_mesh;
    gproj_mesh *offset, *support;
    gproj_offset_measures offset_measures;
    int32_t seams, welded; /* boundary vertices at the same place as others: left as they are, merged */
    gproj_surface *surface;
    gproj_curve **curve;
    int32_t curve_count;
    gproj_form *form;
    gproj_result result;
    double *original, *planarity_before, *planarity;
    double *shade;                        /* of each face, what colours it; NULL: its planarity */
    double *point_load;                   /* of --loads */
    double *imbalance_before, *imbalance; /* of faces: what the best forces leave unbalanced */
    double *density_of_edge, *force_in_edge;
    bool *is_support;
    gproj_forces forces;
    gproj_measures before, after;
    double volume_before;
    gprojx_history history; /* with --report */
    double start, read_seconds, setup_seconds, solve_seconds;
    bool bar; /* the last thing on the terminal is the progress bar */

    int exit_code; /* once something has failed */
} tool;

/* Every failure of the tool passes through here: one sentence, and the exit code. Returns false. */
static bool fail(tool *t, int exit_code, const char *format, ...) {
    va_list list;
    if (t->exit_code != 0) return false;
    t->exit_code = exit_code;
    if (t->bar) fputc('\n', stderr);
    fputs("guidedproj: ", stderr);
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fputs(exit_code == EXIT_USAGE ? "\n(guidedproj --help lists all options)\n" : "\n", stderr);
    return false;
}

static bool fail_memory(tool *t) { return fail(t, EXIT_MEMORY, "out of memory"); }

/* An error of the library about a file, or about the form where `path` is NULL. */
static bool fail_library(tool *t, const char *path, const gproj_error *error) {
    int code = error->code == GPROJ_ERROR_MEMORY ? EXIT_MEMORY : EXIT_REFUSED;
    const char *message = error->message[0] ? error->message : gproj_code_string(error->code);
    if (!path || strstr(message, path)) return fail(t, code, "%s", message);
    return fail(t, code, "%s: %s", path, message);
}

static void *take(tool *t, size_t count, size_t size) {
    void *block = calloc(count > 0 ? count : 1, size);
    if (!block) fail_memory(t);
    return block;
}

static double now(void *user) {
    struct timespec time;
    (void)user;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* ---- numbers and words ---- */

static bool same_word(const char *text, size_t size, const char *word) {
    return strlen(word) == size && memcmp(text, word, size) == 0;
}

/* All of text[0..size-1] is one finite number. */
static bool read_number(const char *text, size_t size, double *value) {
    return size > 0 && gproj_number_read(text, size, value) == size && fabs(*value) <= 1.7976931348623157e308;
}

/* All of text[0..size-1] is a whole number in low..high. */
static bool read_integer(const char *text, size_t size, int32_t low, int32_t high, int32_t *value) {
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

/* W[*DECAY][:N] */
static bool read_schedule(const char *text, size_t size, tool_weight *weight) {
    const char *colon = (const char *)memchr(text, ':', size), *star;
    tool_weight read = {true, 1, 1, 0};
    size_t body = colon ? (size_t)(colon - text) : size, first;
    if (colon && !read_integer(colon + 1, size - body - 1, 1, INT32_MAX, &read.last)) return false;
    star = (const char *)memchr(text, '*', body);
    first = star ? (size_t)(star - text) : body;
    if (!read_number(text, first, &read.weight) || read.weight < 0) return false;
    if (star && !read_number(star + 1, body - first - 1, &read.decay)) return false;
    if (read.decay <= 0 || read.decay > 1) return false;
    *weight = read;
    return true;
}

/* WORD[=W[*DECAY][:N]], cut at the last '=' where a weight follows it. */
static tool_word split_word(const char *text, double usual_weight) {
    const char *equals = strrchr(text, '=');
    tool_word word;
    word.text = text;
    word.length = strlen(text);
    word.weight.given = true, word.weight.weight = usual_weight, word.weight.decay = 1, word.weight.last = 0;
    if (equals && read_schedule(equals + 1, strlen(equals + 1), &word.weight)) word.length = (size_t)(equals - text);
    return word;
}

/* The number of edits (insert, delete, replace, swap neighbours) that turn one word into another. */
static int edit_distance(const char *a, size_t size, const char *b) {
    enum {
        MOST = 24
    };
    int d[MOST + 1][MOST + 1] = {{0}}, rows = (int)size, columns = (int)strlen(b), i, j;
    if (rows > MOST || columns > MOST) return MOST;
    for (i = 0; i <= rows; ++i)
        for (j = 0; j <= columns; ++j) {
            int best;
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            best = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            if (d[i - 1][j] + 1 < best) best = d[i - 1][j] + 1;
            if (d[i][j - 1] + 1 < best) best = d[i][j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && d[i - 2][j - 2] + 1 < best)
                best = d[i - 2][j - 2] + 1;
            d[i][j] = best;
        }
    return d[rows][columns];
}

enum {
    HINT_SIZE = 48
};

/* "; did you mean WORD?" where one of the words, which end with NULL, is like this one; else "". */
static const char *did_you_mean(const char *text, size_t size, const char *const *words, char hint[HINT_SIZE]) {
    int best = 3; /* edits that are no typing error any more */
    hint[0] = 0;
    for (; *words; ++words) {
        int distance = edit_distance(text, size, *words);
        if (distance >= best || 2 * distance > (int)size) continue;
        best = distance;
        snprintf(hint, HINT_SIZE, "; did you mean %s?", *words);
    }
    return hint;
}

/* ---- readers of values: `place` is the option's member of the tool ---- */

static bool set_flag(tool *t, void *place, const char *name, const char *value) {
    (void)t, (void)name, (void)value;
    *(bool *)place = true;
    return true;
}

static bool set_path(tool *t, void *place, const char *name, const char *value) {
    if (!value[0]) return fail(t, EXIT_USAGE, "--%s needs a path", name);
    ((tool_output *)place)->path = value;
    return true;
}

/* DISTANCE,FILE */
static bool set_offset(tool *t, void *place, const char *name, const char *value) {
    const char *comma = strchr(value, ',');
    ((tool_output *)place)->path = comma ? comma + 1 : NULL;
    if (comma && comma[1] && read_number(value, (size_t)(comma - value), &t->offset_distance) &&
        fabs(t->offset_distance) > 0)
        return true;
    return fail(t, EXIT_USAGE,
                "--%s %s: expected DISTANCE,FILE: a distance other than 0, and where to write (as in "
                "0.3,offset.obj)",
                name, value);
}

/* What must hold: a constant weight. */
static bool set_must(tool *t, void *place, const char *name, const char *value) {
    tool_weight *weight = (tool_weight *)place;
    weight->given = true, weight->weight = 1;
    if (value && (!read_number(value, strlen(value), &weight->weight) || weight->weight < 0))
        return fail(t, EXIT_USAGE, "--%s=%s: the weight must be a number, 0 or larger", name, value);
    return true;
}

static bool set_wish(tool *t, void *place, const char *name, const char *value) {
    if (read_schedule(value, strlen(value), (tool_weight *)place)) return true;
    return fail(
        t, EXIT_USAGE,
        "--%s %s: expected W[*DECAY][:N] with a weight W of 0 or larger, a DECAY above 0 and at most 1, and a last "
        "iteration N of 1 or larger (as in '0.2*0.9:6')",
        name, value);
}

/* A wish whose value may be left out: then it has weight 1. */
static bool set_wish_or_one(tool *t, void *place, const char *name, const char *value) {
    return set_wish(t, place, name, value ? value : "1");
}

/* V, or xF. */
static bool read_volume(const char *text, tool_volume *volume) {
    volume->given = true;
    volume->factor = text[0] == 'x';
    return read_number(text + volume->factor, strlen(text + volume->factor), &volume->value);
}

static bool set_volume(tool *t, void *place, const char *name, const char *value) {
    if (read_volume(value, (tool_volume *)place)) return true;
    return fail(t, EXIT_USAGE, "--%s %s: expected a volume, or x and a factor of the input's volume (as in x1.2)", name,
                value);
}

static bool set_total_area(tool *t, void *place, const char *name, const char *value) {
    tool_volume *area = (tool_volume *)place;
    if (read_volume(value, area) && area->value > 0) return true;
    return fail(t, EXIT_USAGE, "--%s %s: expected an area above 0, or x and a factor of the input's area (as in x1.2)",
                name, value);
}

/* MIN,MAX[=W]; what is left out stays as it is. */
static bool read_range(const char *value, tool_range *range) {
    tool_word word = split_word(value, 1);
    const char *comma = (const char *)memchr(word.text, ',', word.length);
    size_t first = comma ? (size_t)(comma - word.text) : 0, rest = comma ? word.length - first - 1 : 0;
    range->given = true;
    range->weight = word.weight.weight;
    return first + rest > 0 && !(word.weight.decay < 1) && word.weight.last == 0 &&
           (first == 0 || read_number(word.text, first, &range->min)) &&
           (rest == 0 || read_number(comma + 1, rest, &range->max)) &&
           (first == 0 || rest == 0 || range->min <= range->max);
}

/* Of lengths and areas: 0 is no bound. */
static bool set_range(tool *t, void *place, const char *name, const char *value) {
    tool_range *range = (tool_range *)place;
    const char *comma = strchr(value, ',');
    bool bounded = comma && comma[1] && comma[1] != '=';
    if (read_range(value, range) && range->min >= 0 && range->max >= 0 && (!bounded || range->max > 0)) return true;
    return fail(t, EXIT_USAGE, "--%s %s: expected MIN,MAX or MIN, or ,MAX with 0 <= MIN <= MAX", name, value);
}

/* Of stresses, of either sign. */
static bool set_stress(tool *t, void *place, const char *name, const char *value) {
    tool_range *range = (tool_range *)place;
    range->min = -HUGE_VAL, range->max = HUGE_VAL;
    if (read_range(value, range)) return true;
    return fail(t, EXIT_USAGE, "--%s %s: expected MIN,MAX or MIN, or ,MAX with MIN <= MAX", name, value);
}

/* LENGTHPRICE,AREAPRICE,MAX or ...,xF */
static bool set_cost(tool *t, void *place, const char *name, const char *value) {
    const char *first = strchr(value, ','), *second = first ? strchr(first + 1, ',') : NULL;
    tool_volume *cost = (tool_volume *)place;
    if (second && read_number(value, (size_t)(first - value), &t->length_price) &&
        read_number(first + 1, (size_t)(second - first - 1), &t->area_price) && read_volume(second + 1, cost) &&
        t->length_price >= 0 && t->area_price >= 0 && t->length_price + t->area_price > 0 && cost->value > 0)
        return true;
    return fail(t, EXIT_USAGE,
                "--%s %s: expected LENGTHPRICE,AREAPRICE,MAX: prices of 0 or larger, not both 0, and the largest cost, "
                "or x and a factor of the input's cost (as in 1,2,x0.9)",
                name, value);
}

static bool set_load(tool *t, void *place, const char *name, const char *value) {
    t->loads_given = true;
    if (read_number(value, strlen(value), (double *)place)) return true;
    return fail(t, EXIT_USAGE, "--%s %s: expected a number", name, value);
}

static bool set_loads_file(tool *t, void *place, const char *name, const char *value) {
    t->loads_given = true;
    if (!value[0]) return fail(t, EXIT_USAGE, "--%s needs a path", name);
    *(const char **)place = value;
    return true;
}

static bool set_supports(tool *t, void *place, const char *name, const char *value) {
    (void)t, (void)name;
    ((tool_word *)place)->text = value;
    ((tool_word *)place)->length = strlen(value);
    return true;
}

static bool set_positive(tool *t, void *place, const char *name, const char *value) {
    if (read_number(value, strlen(value), (double *)place) && *(double *)place > 0) return true;
    return fail(t, EXIT_USAGE, "--%s %s: expected a number larger than 0", name, value);
}

static bool set_iterations(tool *t, void *place, const char *name, const char *value) {
    if (read_integer(value, strlen(value), 1, MOST_ITERATIONS, (int32_t *)place)) return true;
    return fail(t, EXIT_USAGE, "--%s %s: expected a whole number from 1 to %d", name, value, MOST_ITERATIONS);
}

static bool set_subdivision(tool *t, void *place, const char *name, const char *value) {
    tool_subdivision *subdivision = (tool_subdivision *)place;
    size_t size = strcspn(value, ",");
    const char *rest = value + size;
    if (!read_integer(value, size, 1, MOST_LEVELS, &subdivision->levels) || (*rest && strcmp(rest, ",loop") != 0))
        return fail(t, EXIT_USAGE, "--%s %s: expected a whole number from 1 to %d, with ,loop for triangles", name,
                    value, MOST_LEVELS);
    subdivision->scheme = *rest ? GPROJ_LOOP : GPROJ_CATMULL_CLARK;
    return true;
}

static bool set_sides(tool *t, void *place, const char *name, const char *value) {
    tool_sides *sides = (tool_sides *)place;
    const char *at = value;
    for (;; ++at) {
        size_t size = strcspn(at, ",");
        if (sides->count == MOST_SIDES || !read_integer(at, size, 1, 100000, &sides->edges[sides->count]))
            return fail(t, EXIT_USAGE, "--%s %s: expected N,N,...: a number of edges for each side", name, value);
        sides->count++;
        at += size;
        if (!*at) return true;
    }
}

static bool set_lift(tool *t, void *place, const char *name, const char *value) {
    double *lift = (double *)place;
    if (read_number(value, strlen(value), lift) && fabs(*lift) > 0 && fabs(*lift) <= 1e50) return true;
    return fail(t, EXIT_USAGE, "--%s %s: expected a height, not 0, of at most 1e50", name, value);
}

static bool set_weld(tool *t, void *place, const char *name, const char *value) {
    double *weld = (double *)place;
    *weld = SAME_PLACE;
    if (!value || (read_number(value, strlen(value), weld) && *weld > 0 && *weld <= 1)) return true;
    return fail(t, EXIT_USAGE, "--%s=%s: expected a distance in mean edge lengths, above 0 and at most 1", name, value);
}

static bool set_threads(tool *t, void *place, const char *name, const char *value) {
    int32_t *threads = (int32_t *)place;
    if (!read_integer(value, strlen(value), 0, MOST_THREADS, threads))
        return fail(t, EXIT_USAGE, "--%s %s: expected a whole number from 0 to %d", name, value, MOST_THREADS);
    if (*threads == 0) {
        long cores = sysconf(_SC_NPROCESSORS_ONLN);
        *threads = cores < 1 ? 1 : cores > MOST_THREADS ? MOST_THREADS : (int32_t)cores;
    }
    return true;
}

static bool add_word(tool *t, tool_word *words, int32_t *count, const char *name, const char *value) {
    tool_word word = split_word(value, 1);
    if (word.length == 0) return fail(t, EXIT_USAGE, "--%s: expected a word, a list or a file before the weight", name);
    if (word.weight.decay < 1 || word.weight.last > 0)
        return fail(t, EXIT_USAGE, "--%s %s: what must hold has a constant weight", name, value);
    words[(*count)++] = word;
    return true;
}

static bool add_fix(tool *t, void *place, const char *name, const char *value) {
    (void)place;
    return add_word(t, t->fix, &t->fix_count, name, value);
}

static bool add_glide(tool *t, void *place, const char *name, const char *value) {
    (void)place;
    return add_word(t, t->glide, &t->glide_count, name, value);
}

static bool set_reference(tool *t, void *place, const char *name, const char *value) {
    *(tool_word *)place = split_word(value, 0.1);
    return ((tool_word *)place)->length > 0 || fail(t, EXIT_USAGE, "--%s: expected a mesh file", name);
}

/* I,X,Y,Z[=W] */
static bool add_move(tool *t, void *place, const char *name, const char *value) {
    tool_word word = split_word(value, 1);
    tool_move *move = &t->move[t->move_count];
    const char *at = word.text, *end = word.text + word.length, *comma;
    int32_t k, i;
    (void)place;
    for (k = 0; k < 4; ++k, at = comma + (comma < end)) {
        bool good;
        comma = (const char *)memchr(at, ',', (size_t)(end - at));
        if (!comma) comma = end;
        good = k == 0 ? read_integer(at, (size_t)(comma - at), 0, INT32_MAX - 1, &move->vertex)
                      : read_number(at, (size_t)(comma - at), &move->position[k - 1]);
        if (!good || (comma < end) != (k < 3) || word.weight.decay < 1 || word.weight.last > 0)
            return fail(t, EXIT_USAGE, "--%s %s: expected I,X,Y,Z: a vertex and the three coordinates of its new place",
                        name, value);
    }
    move->weight = word.weight.weight;
    for (i = 0; i < t->move_count; ++i)
        if (t->move[i].vertex == move->vertex)
            return fail(t, EXIT_USAGE, "--%s: vertex %ld is moved twice", name, (long)move->vertex);
    t->move_count++;
    return true;
}

/* A name, or AZIMUTH,ELEVATION in degrees. */
static bool set_view(tool *t, void *place, const char *name, const char *value) {
    static const struct {
        const char *name;
        gprojx_view view;
    } views[] = {{"iso", {-58, 32, false}}, {"top", {-90, 90, true}}, {"bottom", {-90, -90, true}},
                 {"front", {-90, 0, true}}, {"back", {90, 0, true}},  {"side", {0, 0, true}},
                 {"right", {0, 0, true}},   {"left", {180, 0, true}}};
    gprojx_view *view = (gprojx_view *)place;
    const char *comma = strchr(value, ',');
    size_t i;
    t->view_given = true;
    for (i = 0; i < sizeof views / sizeof views[0]; ++i)
        if (strcmp(value, views[i].name) == 0) {
            *view = views[i].view;
            return true;
        }
    view->parallel = false;
    if (comma && read_number(value, (size_t)(comma - value), &view->azimuth) &&
        read_number(comma + 1, strlen(comma + 1), &view->elevation) && fabs(view->azimuth) <= 3600 &&
        fabs(view->elevation) <= 90)
        return true;
    return fail(t, EXIT_USAGE,
                "--%s %s: expected iso, top, bottom, front, back, left, right, side, or AZIMUTH,ELEVATION in degrees",
                name, value);
}

/* ---- what colours the faces of a picture ---- */

typedef struct tool_colour {
    const char *name, *legend;
    double high; /* the end of its linear scale, which begins at 0 */
    double (*value)(const tool *t, int32_t face);
} tool_colour;

/* The area of a face over the mean of all. */
static double area_of_face(const tool *t, int32_t face) {
    double a[3];
    gproj_mesh_face_area_vector(t->mesh, face, a);
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * t->mesh->face_count / t->after.area;
}

/* |v1 - v2 + v3 - v4| of a quad, in mean edge lengths; other faces: 0. */
static double skew_of_face(const tool *t, int32_t face) {
    const int32_t *next = t->mesh->next, *origin = t->mesh->origin;
    int32_t h = t->mesh->face_halfedge[face], k;
    double sum[3] = {0, 0, 0};
    if (t->mesh->face_degree[face] != 4) return 0;
    for (k = 0; k < 4; ++k, h = next[h]) {
        const double *p = t->mesh->position + 3 * (size_t)origin[h], sign = k % 2 ? -1 : 1;
        sum[0] += sign * p[0], sum[1] += sign * p[1], sum[2] += sign * p[2];
    }
    return sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / t->after.mean_edge;
}

/* The angle between two vectors, in degrees. */
static double angle_between(const double a[3], const double b[3]) {
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return 57.29577951308232 * atan2(sqrt(x * x + y * y + z * z), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* The largest angle between the normals of a face and of a face beside it. */
static double bend_of_face(const tool *t, int32_t face) {
    int32_t h = t->mesh->face_halfedge[face], k;
    double a[3], b[3], largest = 0;
    gproj_mesh_face_area_vector(t->mesh, face, a);
    for (k = 0; k < t->mesh->face_degree[face]; ++k, h = t->mesh->next[h]) {
        int32_t beside = t->mesh->face[t->mesh->twin[h]];
        if (beside < 0) continue;
        gproj_mesh_face_area_vector(t->mesh, beside, b);
        largest = fmax(largest, angle_between(a, b));
    }
    return largest;
}

static const tool_colour colours[] = {
    {"planarity", "planarity of the faces, in mean edge lengths", 0, NULL},
    {"area", "areas of the faces; 1: their mean", 2, area_of_face},
    {"parallelogram", "quads against parallelograms: |v1 - v2 + v3 - v4| in mean edge lengths", 0.25, skew_of_face},
    {"bend", "largest angle between normals of a face and one beside it, in degrees", 40, bend_of_face},
};

static bool set_colour(tool *t, void *place, const char *name, const char *value) {
    static const char *const words[] = {"planarity", "area", "parallelogram", "bend", NULL};
    char hint[HINT_SIZE];
    size_t i;
    for (i = 0; i < sizeof colours / sizeof colours[0]; ++i)
        if (strcmp(value, colours[i].name) == 0) {
            *(const tool_colour **)place = &colours[i];
            return true;
        }
    return fail(t, EXIT_USAGE, "--%s %s: expected planarity, area, parallelogram or bend%s", name, value,
                did_you_mean(value, strlen(value), words, hint));
}

/* ---- the table of options ---- */

typedef struct tool_option {
    char letter; /* 'o' for -o; 0: none */
    const char *name;
    const char *value; /* its syntax: "" none, "[=W]" may be left out, else needed */
    bool repeatable;
    const char *help;
    const char *section; /* a heading above this option; NULL: none */
    bool (*read)(tool *t, void *place, const char *name, const char *value);
    size_t place; /* offset in tool, for `read` */
} tool_option;

#define PLACE(member) offsetof(tool, member)

static const tool_option options[] = {
    {'o', "output", "FILE", false, "the result, .obj or .off (needed)", "files", set_path, PLACE(output[OUTPUT_MESH])},

    {0, "fill", "CURVE", false,
     "instead of INPUT: quads fill the curve in this OBJ file: its first closed polyline, else its boundary, else its "
     "first polyline, closed, else all "
     "its vertices. The boundary's vertices come first",
     "where it begins", set_path, PLACE(fill)},
    {0, "sides", "N,N,...", false,
     "the numbers of edges of the curve's sides, from corner to corner (by its mean edge if left out)", NULL, set_sides,
     PLACE(sides)},
    {0, "subdivide", "N[,loop]", false,
     "the input is a cage: N times each face becomes quads about its middle (Catmull and Clark), with ,loop each "
     "triangle four (Loop). The cage's vertices keep their numbers",
     NULL, set_subdivision, PLACE(subdivision)},
    {0, "weld", "[=TOL]", false,
     "boundary vertices at the same place, within TOL mean edge lengths (1e-6), become one: seams are closed. Vertices "
     "are "
     "numbered anew, and polylines left out",
     NULL, set_weld, PLACE(weld)},
    {0, "lift", "HEIGHT", false,
     "the vertex farthest from the boundary is pulled up by HEIGHT, and the mesh follows smoothly", NULL, set_lift,
     PLACE(lift)},
    {0, "state", "FILE", false,
     "where FILE exists, the work goes on from there: it was written with the same input and options. At the end the "
     "state is written to it. With --time-limit or --iterations long work can be done in parts",
     NULL, set_path, PLACE(output[OUTPUT_STATE])},

    {0, "planar", "[=W]", false, "all faces are planar", "what must hold (weight W: 1 if left out)", set_must,
     PLACE(planar)},
    {0, "circular", "[=W]", false, "faces have a circumcircle (with --planar)", NULL, set_must, PLACE(circular)},
    {0, "conical", "[=W]", false, "the faces around a vertex touch a cone (with --planar)", NULL, set_must,
     PLACE(conical)},
    {0, "equal-lengths", "[=W]", false, "all edges have the same length", NULL, set_must, PLACE(equal_lengths)},
    {0, "edge-length", "MIN,MAX[=W]", false, "edges are at least MIN and at most MAX long; one may be left out", NULL,
     set_range, PLACE(edge_length)},
    {0, "face-area", "MIN,MAX[=W]", false, "face areas are at least MIN and at most MAX; one may be left out", NULL,
     set_range, PLACE(face_area)},
    {0, "total-area", "A", false, "the area of all faces is A, or xF: F times the input's", NULL, set_total_area,
     PLACE(total_area)},
    {0, "cost", "CL,CA,MAX", false,
     "CL times the length of all edges and CA times the area of all faces cost at most MAX, or xF: F times the input's",
     NULL, set_cost, PLACE(cost)},
    {0, "planar-boundary", "[=W]", false, "each part of the boundary between corners lies in a plane of its own", NULL,
     set_must, PLACE(planar_boundary)},
    {0, "straight-boundary", "[=W]", false, "the boundary is straight between its corners", NULL, set_must,
     PLACE(straight_boundary)},
    {0, "orthogonal-boundary", "[=W]", false, "inner edges meet the boundary at right angles", NULL, set_must,
     PLACE(orthogonal_boundary)},
    {0, "lifting", "[=W]", false, "vertices keep their x and y and move in z only", NULL, set_must, PLACE(lifting)},
    {0, "volume", "V", false,
     "the enclosed volume (with a boundary: the volume over the plane z = 0) is V, or xF: F times the input's", NULL,
     set_volume, PLACE(volume)},
    {0, "fix", "WHICH[=W]", true,
     "vertices stay where they are. WHICH: boundary, corners, a list such as 0,7,20-29, or a file of such numbers",
     NULL, add_fix, 0},
    {0, "glide", "WHERE[=W]", true,
     "boundary vertices stay on a curve. WHERE: boundary (each on its own boundary polyline; corners stay), or an OBJ "
     "file "
     "with polylines (else its boundary loops are taken)",
     NULL, add_glide, 0},
    {0, "move", "I,X,Y,Z[=W]", true,
     "vertex I goes to X,Y,Z: it is dragged there, while what must hold goes on holding, and stays. It is then free of "
     "--fix and --glide",
     NULL, add_move, 0},

    {0, "equilibrium", "[=W]", false, "forces in the edges balance the loads at all vertices without support (z is up)",
     "statics", set_must, PLACE(equilibrium)},
    {0, "compressive", "[=W]", false, "edges carry compression only", NULL, set_must, PLACE(compressive)},
    {0, "tensile", "[=W]", false, "edges carry tension only", NULL, set_must, PLACE(tensile)},
    {0, "stress", "MIN,MAX[=W]", false,
     "axial forces (compression > 0) are at least MIN and at most MAX; one may be left out, 0 is a bound", NULL,
     set_stress, PLACE(stress)},
    {0, "supports", "WHICH", false,
     "where forces go to the ground: boundary (if left out), corners, a list or a file, as in --fix. This does not "
     "hold "
     "them in place: without --fix or --glide of the same vertices they move",
     NULL, set_supports, PLACE(supports)},
    {0, "density", "R", false, "each edge weighs R times its length (1 where no load is given)", NULL, set_load,
     PLACE(density)},
    {0, "area-load", "Q", false, "each face weighs Q times its area", NULL, set_load, PLACE(area_load)},
    {0, "snow", "Q", false, "each face bears Q times its plan area", NULL, set_load, PLACE(snow)},
    {0, "loads", "FILE", false, "forces on vertices: CSV with the lines VERTEX,FX,FY,FZ", NULL, set_loads_file,
     PLACE(loads)},
    {0, "force-fairness", "[=W]", false, "opposite edges of quads carry equal forces (a wish; W: 1 if left out)", NULL,
     set_wish_or_one, PLACE(force_fairness)},

    {0, "reference", "FILE[=W]", false, "stay near the surface of this mesh (W: 0.1 if left out)",
     "what is wished (W, or W*DECAY:N: weight W*DECAY^n in iteration n up to N, then off; N: 6, with "
     "--equilibrium 9, if left out)",
     set_reference, PLACE(reference)},
    {0, "closeness", "W", false,
     "stay near the original places; --closeness 0: the plain projection, whose steps are neither smooth nor guided",
     NULL, set_wish, PLACE(closeness)},
    {0, "fairness", "W", false, "smooth polylines of edges", NULL, set_wish, PLACE(fairness)},
    {0, "boundary-fairness", "W", false, "smooth boundary", NULL, set_wish, PLACE(boundary_fairness)},
    {0, "tangential", "W", false, "smooth polylines, as seen along the surface's normals", NULL, set_wish,
     PLACE(tangential)},
    {0, "gauss", "W", false, "smooth Gauss image: face normals change evenly", NULL, set_wish, PLACE(gauss)},
    {0, "parallelograms", "[=W]", false, "quads are like parallelograms (W: 1 if left out)", NULL, set_wish_or_one,
     PLACE(parallelograms)},
    {0, "equal-areas", "[=W]", false, "faces have equal areas (W: 1 if left out)", NULL, set_wish_or_one,
     PLACE(equal_areas)},

    {0, "nearest", "", false,
     "end at the nearest mesh that satisfies everything; where something is wished, at the one that serves the wishes "
     "best: they keep their weights W to the end",
     "how", set_flag, PLACE(nearest)},
    {0, "iterations", "N", false, "at most so many (200, most take about 10; with --nearest 30)", NULL, set_iterations,
     PLACE(iterations)},
    {0, "tolerance", "T", false, "what must hold holds to this, in mean edge lengths (1e-13)", NULL, set_positive,
     PLACE(tolerance)},
    {0, "epsilon", "E", false, "constant regularisation of the steps (follows the residual, 1e-5 to 1e-3)", NULL,
     set_positive, PLACE(epsilon)},
    {0, "time-limit", "SECONDS", false, "stop after the iteration that passes this", NULL, set_positive,
     PLACE(time_limit)},
    {0, "allow-spoiled", "", false,
     "exit status 0 where all holds, though faces turned over, crossed or collapsed, or edges folded, collapsed or "
     "became "
     "spikes (1 otherwise: see the sentence)",
     NULL, set_flag, PLACE(allow_spoiled)},
    {0, "threads", "N", false, "work with N threads (1); 0: one per core. The result does not depend on it", NULL,
     set_threads, PLACE(threads)},

    {0, "report", "FILE", false, "JSON: counts, every iteration, verdict, measures, seconds", "out", set_path,
     PLACE(output[OUTPUT_REPORT])},
    {0, "forces", "FILE", false,
     "CSV: lines edge,I,J,W with the force W(v_I - v_J) on I (W > 0: compression), load,I,FX,FY,FZ and support,I", NULL,
     set_path, PLACE(output[OUTPUT_FORCES])},
    {0, "picture", "FILE", false,
     "SVG: the result, its faces in the colours of --colour; with --equilibrium also forces as widths of edges "
     "(compression blue, tension red), and "
     "without --planar coloured by how far the faces are from standing by themselves",
     NULL, set_path, PLACE(output[OUTPUT_PICTURE])},
    {0, "view", "VIEW", false,
     "of the picture: iso, top, bottom, front, back, left, right, or AZIMUTH,ELEVATION in degrees (-58,32)", NULL,
     set_view, PLACE(view)},
    {0, "colour", "WHAT", false, "of the faces in the picture, by planarity, area, parallelogram or bend", NULL,
     set_colour, PLACE(colour)},
    {0, "offset", "DISTANCE,FILE", false,
     "the parallel mesh at this distance, .obj or .off: of the vertices with --circular alone, else of the faces "
     "(exact "
     "with --conical)",
     NULL, set_offset, PLACE(output[OUTPUT_OFFSET])},
    {0, "support", "FILE", false, "the panels between the mesh and its --offset, .obj or .off: one quad an edge", NULL,
     set_path, PLACE(output[OUTPUT_SUPPORT])},
    {0, "quiet", "", false, "print errors only", NULL, set_flag, PLACE(quiet)},
    {'h', "help", "", false, "print this", NULL, set_flag, PLACE(help)},
    {0, "version", "", false, "print the version", NULL, set_flag, PLACE(version)},
};

enum {
    OPTION_COUNT = (int)(sizeof options / sizeof options[0])
};

typedef char tool_seen_has_room[(int)OPTION_COUNT <= (int)MOST_OPTIONS ? 1 : -1];

/* Prints words from column `indent` on, broken before column 80; the cursor stands in column `at`. */
static void print_wrapped(const char *text, int at, int indent) {
    while (*text) {
        int size = (int)strcspn(text, " ");
        if (at > indent && at + 1 + size > 79) {
            fputc('\n', stdout);
            at = 0;
        }
        if (at < indent)
            printf("%*s", indent - at, ""), at = indent;
        else if (at > indent)
            fputc(' ', stdout), ++at;
        printf("%.*s", size, text);
        at += size;
        text += size + (text[size] == ' ');
    }
    fputc('\n', stdout);
}

static void print_help(void) {
    int i;
    puts("usage: guidedproj INPUT.{obj,off} -o OUTPUT.{obj,off} OPTIONS\n\n"
         "Moves the vertices of a polygon mesh so that what must hold holds to machine\n"
         "precision, guided by what is wished. Vertices count from 0.");
    for (i = 0; i < OPTION_COUNT; ++i) {
        const tool_option *option = &options[i];
        char head[64];
        int size;
        if (option->section) {
            fputc('\n', stdout);
            print_wrapped(option->section, 0, 0);
        }
        size = snprintf(head, sizeof head, "  %c%c%s--%s%s%s", option->letter ? '-' : ' ',
                        option->letter ? option->letter : ' ', option->letter ? ", " : "  ", option->name,
                        option->value[0] && option->value[0] != '[' ? " " : "", option->value);
        fputs(head, stdout);
        if (size > 28) {
            fputc('\n', stdout);
            size = 0;
        }
        print_wrapped(option->help, size, 29);
    }
    puts("\nexamples\n"
         "  guidedproj roof.obj -o flat.obj --planar --picture flat.svg\n"
         "  guidedproj roof.obj -o fair.obj --planar --glide boundary \\\n"
         "      --reference roof.obj=0.1 --fairness '0.2*0.9' --report fair.json\n"
         "  guidedproj roof.obj -o lifted.obj --planar --fix corners --move 220,0,0,5\n\n"
         "exit status\n"
         "  0 all that must hold holds to the tolerance, and the mesh is not spoiled: no\n"
         "  face turned over, no new bow-tie or fold, nothing collapsed, no spike, against\n"
         "  where the work began   1 it is not so (the output is written, sentence and\n"
         "  report say why; --allow-spoiled: what must hold is enough)   2 wrong usage, or\n"
         "  an output that cannot be written   3 input refused, or writing failed   4 out\n"
         "  of memory. After 2, 3 and 4 no output is touched. With --nearest 0 does not\n"
         "  say that a minimum was reached: the sentence and the report do.");
}

/* ---- the command line ---- */

static const tool_option *find_option(const char *name, size_t size) {
    int i;
    for (i = 0; i < OPTION_COUNT; ++i)
        if (same_word(name, size, options[i].name)) return &options[i];
    return NULL;
}

/* `word` is the whole argument, `name` the option in it. */
static bool fail_unknown(tool *t, const char *word, const char *name, size_t size) {
    int i, best = -1, least = size < 5 ? 2 : 3; /* two edits, in a short name one, make a typing error */
    for (i = 0; i < OPTION_COUNT; ++i) {
        const char *known = options[i].name;
        int distance = edit_distance(name, size, known);
        if (size >= 3 && strncmp(name, known, size) == 0) distance = 1; /* cut short */
        if (distance < least) best = i, least = distance;
    }
    if (best < 0) return fail(t, EXIT_USAGE, "there is no option %.*s", (int)(name + size - word), word);
    return fail(t, EXIT_USAGE, "there is no option %.*s; did you mean --%s?", (int)(name + size - word), word,
                options[best].name);
}

/* Reads the option at argv[*i] and, where it stands apart, its value. */
static bool read_option(tool *t, int argc, char **argv, int *i) {
    const char *word = argv[*i], *name = word + (word[1] == '-' ? 2 : 1), *equals = strchr(name, '=');
    size_t size = equals ? (size_t)(equals - name) : strlen(name);
    const tool_option *option = word[1] == '-' ? find_option(name, size) : NULL;
    const char *value = equals ? equals + 1 : NULL;
    int k;
    for (k = 0; k < OPTION_COUNT && word[1] != '-'; ++k)
        if (size == 1 && options[k].letter == name[0]) option = &options[k];
    if (!option) return fail_unknown(t, word, name, size);
    if (t->seen[option - options] && !option->repeatable)
        return fail(t, EXIT_USAGE, "--%s is given twice", option->name);
    t->seen[option - options] = true;
    if (value && !option->value[0]) return fail(t, EXIT_USAGE, "--%s takes no value", option->name);
    if (!value && option->value[0] && option->value[0] != '[') {
        if (*i + 1 >= argc || strncmp(argv[*i + 1], "--", 2) == 0)
            return fail(t, EXIT_USAGE, "--%s needs a value: --%s %s", option->name, option->name, option->value);
        value = argv[++*i];
    }
    return option->read(t, (char *)t + option->place, option->name, value);
}

static bool read_input_name(tool *t, const char *word, const char *before) {
    double number;
    if (!word[0]) return fail(t, EXIT_USAGE, "the input's name is empty");
    if (read_number(word, strlen(word), &number) && before && strncmp(before, "--", 2) == 0)
        return fail(t, EXIT_USAGE, "'%s' stands alone; a weight is written %s=%s", word, before, word);
    if (t->input) return fail(t, EXIT_USAGE, "there are two inputs, '%s' and '%s'; one is needed", t->input, word);
    if (strcmp(word, "-") == 0) return fail(t, EXIT_USAGE, "the input must be a file; there is no reading from a pipe");
    t->input = word;
    return true;
}

static bool has_ending(const char *path, const char *ending) {
    size_t size = strlen(path), length = strlen(ending), i;
    if (size <= length) return false;
    for (i = 0; i < length; ++i)
        if (tolower((unsigned char)path[size - length + i]) != ending[i]) return false;
    return true;
}

static bool anything_asked(const tool *t) {
    return t->planar.given || t->fix_count > 0 || t->glide_count > 0 || t->move_count > 0 || t->reference.text ||
           t->closeness.weight > 0 || t->fairness.given || t->boundary_fairness.given || t->tangential.given ||
           t->gauss.given || t->circular.given || t->conical.given || t->volume.given || t->parallelograms.given ||
           t->equal_areas.given || t->equal_lengths.given || t->edge_length.given || t->face_area.given ||
           t->total_area.given || t->cost.given || t->equilibrium.given || t->planar_boundary.given ||
           t->straight_boundary.given || t->orthogonal_boundary.given || t->lifting.given || t->fill ||
           t->subdivision.levels > 0 || fabs(t->lift) > 0;
}

static bool anything_wished(const tool *t) {
    return t->reference.text || t->closeness.weight > 0 || t->fairness.weight > 0 || t->boundary_fairness.weight > 0 ||
           t->tangential.weight > 0 || t->gauss.weight > 0 || t->parallelograms.weight > 0 ||
           t->equal_areas.weight > 0 || t->force_fairness.weight > 0;
}

/* The first given option that means nothing without forces; NULL: none. */
static const char *first_about_forces(const tool *t) {
    static const char *const names[] = {"compressive", "tensile", "stress", "supports",       "density",
                                        "area-load",   "snow",    "loads",  "force-fairness", "forces"};
    size_t i;
    for (i = 0; i < sizeof names / sizeof names[0]; ++i)
        if (t->seen[find_option(names[i], strlen(names[i])) - options]) return names[i];
    return NULL;
}

static bool check_options(tool *t) {
    const char *output = t->output[OUTPUT_MESH].path;
    if (t->iterations == 0) t->iterations = t->nearest ? 30 : 200;
    int i;
    if (t->fill && t->input)
        return fail(t, EXIT_USAGE, "there are an input, '%s', and --fill %s; one is needed", t->input, t->fill);
    if (t->sides.count > 0 && !t->fill)
        return fail(t, EXIT_USAGE, "--sides are those of a curve: add --fill CURVE.obj");
    if (t->fill) t->input = t->fill;
    if (!t->input) return fail(t, EXIT_USAGE, "no input is given: guidedproj INPUT.obj -o OUTPUT.obj --planar");
    if (!output) return fail(t, EXIT_USAGE, "no output is given: add -o OUTPUT.obj");
    if (!has_ending(output, ".obj") && !has_ending(output, ".off"))
        return fail(t, EXIT_USAGE, "the output '%s' must end in .obj or .off", output);
    if (!anything_asked(t))
        return fail(t, EXIT_USAGE,
                    "nothing is asked for: add what must hold (such as --planar) or what is wished (such as "
                    "--fairness 0.2)");
    if (t->view_given && !t->output[OUTPUT_PICTURE].path)
        return fail(t, EXIT_USAGE, "--view is for a picture: add --picture FILE.svg");
    if (t->colour && !t->output[OUTPUT_PICTURE].path)
        return fail(t, EXIT_USAGE, "--colour is for a picture: add --picture FILE.svg");
    if (t->output[OUTPUT_PICTURE].path && !has_ending(t->output[OUTPUT_PICTURE].path, ".svg"))
        return fail(t, EXIT_USAGE, "the picture '%s' must end in .svg", t->output[OUTPUT_PICTURE].path);
    if (t->output[OUTPUT_REPORT].path && strcmp(t->output[OUTPUT_REPORT].path, "-") == 0)
        return fail(t, EXIT_USAGE, "--report writes to a file: give its name");
    if (!t->equilibrium.given && first_about_forces(t))
        return fail(t, EXIT_USAGE,
                    "--%s is about forces: add --equilibrium (the edges then bear their own weight, or what --density, "
                    "--area-load, --snow and --loads say; supports are at the boundary, or where --supports says)",
                    first_about_forces(t));
    if (t->output[OUTPUT_FORCES].path && strcmp(t->output[OUTPUT_FORCES].path, "-") == 0)
        return fail(t, EXIT_USAGE, "--forces writes to a file: give its name");
    if (t->output[OUTPUT_STATE].path && strcmp(t->output[OUTPUT_STATE].path, "-") == 0)
        return fail(t, EXIT_USAGE, "--state is a file: give its name");
    if (t->output[OUTPUT_SUPPORT].path && !t->output[OUTPUT_OFFSET].path)
        return fail(t, EXIT_USAGE, "--support is between the mesh and its offset: add --offset DISTANCE,FILE.obj");
    for (i = OUTPUT_OFFSET; i <= OUTPUT_SUPPORT; ++i) {
        output = t->output[i].path;
        if (output && !has_ending(output, ".obj") && !has_ending(output, ".off"))
            return fail(t, EXIT_USAGE, "the output '%s' must end in .obj or .off", output);
    }
    if (t->conical.weight > 0 && !(t->planar.weight > 0))
        return fail(t, EXIT_USAGE, "--conical needs the normals of planar faces: add --planar");
    if (t->nearest && t->closeness.given && t->closeness.weight <= 0 && !anything_wished(t))
        return fail(t, EXIT_USAGE, "--nearest has nothing to be near to: leave out --closeness 0, or wish something");
    if (t->gauss.given && !t->planar.given)
        return fail(t, EXIT_USAGE, "--gauss needs the normals of planar faces: add --planar");
    return true;
}

static bool read_command_line(tool *t, int argc, char **argv) {
    bool plain = false; /* after "--" */
    int i;
    t->fix = (tool_word *)take(t, (size_t)argc, sizeof *t->fix);
    t->glide = (tool_word *)take(t, (size_t)argc, sizeof *t->glide);
    t->move = (tool_move *)take(t, (size_t)argc, sizeof *t->move);
    t->move_group = (int32_t *)take(t, (size_t)argc, sizeof *t->move_group);
    if (!t->fix || !t->glide || !t->move || !t->move_group) return false;
    for (i = 1; i < argc && !t->help && !t->version; ++i) {
        if (!plain && strcmp(argv[i], "--") == 0)
            plain = true;
        else if (!plain && argv[i][0] == '-' && argv[i][1]) {
            if (!read_option(t, argc, argv, &i)) return false;
        } else if (!read_input_name(t, argv[i], i > 1 && !plain ? argv[i - 1] : NULL))
            return false;
    }
    return t->help || t->version || check_options(t);
}

/* ---- files ---- */

static char *join(tool *t, const char *a, const char *b, const char *c) {
    char *path = (char *)take(t, strlen(a) + strlen(b) + strlen(c) + 1, 1);
    if (path) strcat(strcat(strcpy(path, a), b), c);
    return path;
}

/* Finds where an output really goes, and refuses before the work starts what could not be written after it. */
static bool prepare_output(tool *t, tool_output *output) {
    const char *slash = strrchr(output->path, '/');
    struct stat info;
    char *folder, *real;
    bool writable;
    folder = join(t, output->path, "", "");
    if (!folder) return false;
    if (slash)
        folder[slash == output->path ? 1 : slash - output->path] = 0;
    else
        strcpy(folder, "."); /* a path has at least one character */
    output->target = realpath(output->path, NULL);
    if (output->target) { /* it exists */
        slash = strrchr(output->target, '/');
        free(folder);
        folder = join(t, output->target, "", "");
        if (!folder) return false;
        folder[slash == output->target ? 1 : slash - output->target] = 0;
        if (stat(output->target, &info) == 0 && S_ISDIR(info.st_mode)) {
            free(folder);
            return fail(t, EXIT_USAGE, "the output '%s' is a folder", output->path);
        }
        output->device = !S_ISREG(info.st_mode);
    } else {
        real = realpath(folder, NULL);
        if (!real) {
            fail(t, EXIT_USAGE, "the output '%s' cannot be written: there is no folder '%s'", output->path, folder);
            free(folder);
            return false;
        }
        output->target = join(t, real, strcmp(real, "/") == 0 ? "" : "/", slash ? slash + 1 : output->path);
        free(real);
    }
    writable = output->device ? access(output->target, W_OK) == 0 : access(folder, W_OK | X_OK) == 0;
    free(folder);
    if (!output->target) return false;
    if (!writable) return fail(t, EXIT_USAGE, "the output '%s' cannot be written: %s", output->path, strerror(errno));
    return true;
}

/* Refuses to write over a file that this run reads. */
static bool keep_apart(tool *t, const tool_output *output, const char *path, size_t size) {
    char *copy = (char *)take(t, size + 1, 1), *real;
    bool same;
    if (!copy) return false;
    memcpy(copy, path, size);
    real = realpath(copy, NULL);
    same = real && !output->device && strcmp(real, output->target) == 0;
    free(real);
    if (same) fail(t, EXIT_USAGE, "the output '%s' would overwrite the input '%s'", output->path, copy);
    free(copy);
    return !same;
}

static bool prepare_outputs(tool *t) {
    int32_t i, j;
    for (i = 0; i < OUTPUT_COUNT; ++i) {
        tool_output *output = &t->output[i];
        if (!output->path) continue;
        if (!prepare_output(t, output)) return false;
        for (j = 0; j < i; ++j)
            if (t->output[j].target && strcmp(t->output[j].target, output->target) == 0)
                return fail(t, EXIT_USAGE, "two outputs have the same path '%s'", output->path);
        if (i != OUTPUT_MESH && !keep_apart(t, output, t->input, strlen(t->input))) return false;
        for (j = 0; i != OUTPUT_MESH && j < t->fix_count; ++j)
            if (!keep_apart(t, output, t->fix[j].text, t->fix[j].length)) return false;
        for (j = 0; i != OUTPUT_MESH && j < t->glide_count; ++j)
            if (!keep_apart(t, output, t->glide[j].text, t->glide[j].length)) return false;
        if (i != OUTPUT_MESH && t->loads && !keep_apart(t, output, t->loads, strlen(t->loads))) return false;
        if (i != OUTPUT_MESH && t->supports.text && !keep_apart(t, output, t->supports.text, t->supports.length))
            return false;
        if (i != OUTPUT_MESH && t->reference.text && !keep_apart(t, output, t->reference.text, t->reference.length))
            return false;
    }
    return true;
}

/* The ending of files that other programs can convert; "" for others. */
static const char *foreign_ending(const char *path) {
    static const char *const endings[] = {".stl", ".ply", ".gltf", ".glb", ".step", ".stp", ".iges", ".igs",
                                          ".fbx", ".dae", ".3ds",  ".3mf", ".3dm",  ".dxf", ".dwg",  ".skp",
                                          ".ifc", ".x3d", ".wrl",  ".usd", ".usdz", ".vtk", ".blend"};
    size_t i;
    for (i = 0; i < sizeof endings / sizeof endings[0]; ++i)
        if (has_ending(path, endings[i])) return endings[i];
    return "";
}

static gproj_mesh *load(tool *t, const char *path, size_t size) {
    gproj_error error;
    gproj_mesh *mesh;
    char *copy = (char *)take(t, size + 1, 1);
    if (!copy) return NULL;
    memcpy(copy, path, size);
    mesh = gproj_mesh_load(copy, &t->host, &error);
    if (!mesh && error.code == GPROJ_ERROR_SYNTAX && *foreign_ending(copy) && !strstr(error.message, "as OBJ"))
        fail(t, EXIT_REFUSED,
             "%s: a %s file, and only OBJ and OFF are read: write it as OBJ, for example by Blender, "
             "MeshLab or assimp (%s)",
             copy, foreign_ending(copy), error.message);
    if (!mesh) fail_library(t, copy, &error);
    free(copy);
    return mesh;
}

/* The whole of a file, with a NUL behind it. length: of it without that NUL; may be NULL. */
static char *load_file(tool *t, const char *path, size_t *length) {
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    size_t size = 0, capacity = 0, got = 0;
    if (!file) {
        fail(t, EXIT_REFUSED, "%s: %s", path, strerror(errno));
        return NULL;
    }
    do {
        size += got;
        if (size + 1 >= capacity) {
            char *more = (char *)realloc(text, capacity = 2 * capacity + 4096);
            if (!more) break;
            text = more;
        }
        got = fread(text + size, 1, capacity - size - 1, file);
    } while (got > 0);
    if (got > 0 || ferror(file)) {
        if (got > 0)
            fail_memory(t);
        else
            fail(t, EXIT_REFUSED, "%s: %s", path, strerror(errno));
        free(text);
        text = NULL;
    } else if (text) {
        text[size] = 0;
        if (length) *length = size;
    } else
        fail_memory(t);
    fclose(file);
    return text;
}

/* The first closed polyline in a file, where there is none and no boundary the first one; -1: there is none. (The sides
   of a filled curve are polylines, and none of them is closed.) */
static int32_t curve_polyline(const gproj_mesh *file) {
    int32_t k;
    for (k = 0; k < file->polyline_count; ++k)
        if (file->polyline_vertex[file->polyline_start[k]] == file->polyline_vertex[file->polyline_start[k + 1] - 1])
            return k;
    return file->polyline_count > 0 && file->loop_count == 0 ? 0 : -1;
}

/* Makes curves of a mesh's polylines, else of its boundary loops; the mesh's own loops for `loops`. */
static bool add_curves(tool *t, const gproj_mesh *mesh, bool loops, const char *path) {
    int32_t count = loops || mesh->polyline_count == 0 ? mesh->loop_count : mesh->polyline_count, i;
    gproj_curve **more =
        (gproj_curve **)realloc(t->curve, (size_t)(t->curve_count + count + 1) * sizeof(gproj_curve *));
    gproj_error error;
    if (!more) return fail_memory(t);
    t->curve = more;
    if (count == 0) return fail(t, EXIT_REFUSED, "%s: there is no curve: neither polylines nor a boundary", path);
    for (i = 0; i < count; ++i) {
        gproj_curve *curve = loops || mesh->polyline_count == 0 ? gproj_curve_from_loop(mesh, i, &t->host, &error)
                                                                : gproj_curve_from_polyline(mesh, i, &t->host, &error);
        if (!curve) return fail_library(t, path, &error);
        t->curve[t->curve_count++] = curve;
    }
    return true;
}

/* The curve of first..last-1 that is nearest to a point. */
static int32_t nearest_curve(const tool *t, int32_t first, int32_t last, const double *point, double *distance) {
    int32_t i, best = first;
    *distance = INFINITY;
    for (i = first; i < last; ++i) {
        double d = gproj_curve_closest(t->curve[i], point).distance;
        if (d < *distance) *distance = d, best = i;
    }
    return best;
}

/* The points of the curve in a file: of a polyline, its first boundary loop, or all vertices. Their number. */
static int32_t take_curve(const gproj_mesh *file, double *point) {
    int32_t count = 0, k, first, h, polyline = curve_polyline(file);
    if (polyline >= 0) {
        const int32_t *vertex = file->polyline_vertex + file->polyline_start[polyline];
        count = file->polyline_start[polyline + 1] - file->polyline_start[polyline];
        count -= count > 1 && vertex[0] == vertex[count - 1];
        for (k = 0; k < count; ++k) memcpy(point + 3 * k, file->position + 3 * (size_t)vertex[k], 3 * sizeof *point);
    } else if (file->loop_count > 0) { /* backwards: a loop runs against the faces */
        for (h = first = file->loop_halfedge[0]; h != first || count == 0; h = file->prev[h])
            memcpy(point + 3 * count++, file->position + 3 * (size_t)file->origin[h], 3 * sizeof *point);
    } else if (file->face_count == 0) {
        count = file->vertex_count;
        memcpy(point, file->position, 3 * (size_t)count * sizeof *point);
    }
    return count;
}

static bool fill_curve(tool *t) {
    gproj_fill_options options;
    gproj_error error;
    gproj_mesh *file = load(t, t->fill, strlen(t->fill));
    double *point;
    int32_t count;
    if (!file) return false;
    point =
        (double *)take(t, 3 * (size_t)(file->vertex_count + file->polyline_start[file->polyline_count]), sizeof *point);
    if (point) {
        memset(&options, 0, sizeof options);
        options.side_count = t->sides.count;
        options.subdivisions = t->sides.edges;
        count = take_curve(file, point);
        t->mesh = gproj_mesh_fill(count, point, &options, NULL, &t->host, &error);
        if (!t->mesh && count == 0)
            fail(t, EXIT_REFUSED, "%s: there is no curve: neither polylines nor a boundary", t->fill);
        else if (!t->mesh)
            fail_library(t, t->fill, &error);
    }
    free(point);
    gproj_mesh_destroy(file);
    return t->mesh != NULL;
}

static bool subdivide(tool *t) {
    gproj_subdivide_options options;
    gproj_error error;
    gproj_mesh *coarse = t->mesh;
    memset(&options, 0, sizeof options);
    options.levels = t->subdivision.levels;
    options.scheme = t->subdivision.scheme;
    t->mesh = gproj_mesh_subdivide(coarse, &options, NULL, &t->host, &error);
    gproj_mesh_destroy(coarse);
    return t->mesh || fail_library(t, t->input, &error);
}

/* The vertex inside that is farthest from the boundary, whose loops are the curves from `first` on; -1: there is none. */
static int32_t innermost_vertex(const tool *t, int32_t first) {
    int32_t best = -1, v;
    double farthest = 0, distance;
    for (v = 0; v < t->mesh->vertex_count; ++v) {
        if (t->mesh->vertex_halfedge[v] < 0 || gproj_mesh_is_boundary_vertex(t->mesh, v)) continue;
        nearest_curve(t, first, t->curve_count, t->mesh->position + 3 * (size_t)v, &distance);
        if (distance > farthest && distance < INFINITY) farthest = distance, best = v;
    }
    return best;
}

/* An auxiliary projection: one vertex goes up, the boundary stays, and fairness guides the others. Closeness only decides
   what fairness leaves open; what has to hold is linear, so few iterations do. */
static bool lift(tool *t) {
    int32_t first = t->curve_count, vertex = -1;
    gproj_form *form;
    gproj_result result;
    double target[3];
    if (t->mesh->loop_count > 0 && !add_curves(t, t->mesh, true, t->input)) return false;
    if (t->mesh->loop_count > 0) vertex = innermost_vertex(t, first);
    if (vertex < 0) return fail(t, EXIT_REFUSED, "%s: --lift needs a boundary, and vertices inside", t->input);
    memcpy(target, t->mesh->position + 3 * (size_t)vertex, sizeof target);
    target[2] += t->lift;
    form = gproj_form_create(t->mesh, &t->host);
    if (!form) return fail_memory(t);
    gproj_add_targets(form, 1, &vertex, target, 1);
    gproj_add_fixed_boundary(form, 1);
    gproj_add_fairness(form, 0.3);
    gproj_add_closeness(form, 0.01);
    result = gproj_solve(form, 10, NULL);
    if (result.outcome == GPROJ_FAILED) fail_library(t, NULL, gproj_form_error(form));
    gproj_form_destroy(form);
    return t->exit_code == 0;
}

/* ---- seams ---- */

typedef struct tool_projected { /* a boundary vertex, along a line that no usual mesh is orthogonal to */
    double along;
    int32_t vertex;
} tool_projected;

static int compare_projected(const void *a, const void *b) {
    const tool_projected *p = (const tool_projected *)a, *q = (const tool_projected *)b;
    if (p->along < q->along || p->along > q->along) return p->along < q->along ? -1 : 1;
    return p->vertex < q->vertex ? -1 : 1;
}

/* The smallest vertex that this one is the same as. */
static int32_t same_as(int32_t *same, int32_t vertex) {
    while (same[vertex] != vertex) vertex = same[vertex] = same[same[vertex]];
    return vertex;
}

static bool are_joined(const gproj_mesh *mesh, int32_t a, int32_t b) {
    int32_t start = mesh->vertex_halfedge[a], h = start;
    do {
        if (mesh->origin[mesh->twin[h]] == b) return true;
        h = mesh->twin[mesh->prev[h]];
    } while (h != start);
    return false;
}

/* Finds boundary vertices within `distance` of each other that no edge joins. same, vertex_count entries: of each vertex
   the smallest one at its place. Returns how many are not that; -1 without memory. */
static int32_t find_seams(tool *t, double distance, int32_t *same) {
    static const double direction[3] = {0.5466, 0.6131, 0.5704}; /* a little longer than 1 */
    const gproj_mesh *mesh = t->mesh;
    tool_projected *list = (tool_projected *)take(t, (size_t)mesh->vertex_count, sizeof *list);
    int32_t count = 0, merged = 0, i, j;
    if (!list) return -1;
    for (i = 0; i < mesh->vertex_count; ++i) {
        const double *p = mesh->position + 3 * (size_t)i;
        same[i] = i;
        if (mesh->vertex_halfedge[i] < 0 || !gproj_mesh_is_boundary_vertex(mesh, i)) continue;
        list[count].along = direction[0] * p[0] + direction[1] * p[1] + direction[2] * p[2];
        list[count++].vertex = i;
    }
    qsort(list, (size_t)count, sizeof *list, compare_projected);
    for (i = 0; i < count; ++i)
        for (j = i - 1; j >= 0 && list[i].along - list[j].along <= 1.1 * distance; --j) {
            int32_t a = list[i].vertex, b = list[j].vertex, r, s;
            const double *p = mesh->position + 3 * (size_t)a, *q = mesh->position + 3 * (size_t)b;
            if (hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]) > distance || are_joined(mesh, a, b)) continue;
            r = same_as(same, a), s = same_as(same, b);
            same[r > s ? r : s] = r > s ? s : r;
        }
    for (i = 0; i < mesh->vertex_count; ++i) merged += same_as(same, i) != i;
    free(list);
    return merged;
}

/* The mesh with vertices that are the same made one; `merged` of them go. */
static bool weld(tool *t, int32_t *same, int32_t merged) {
    gproj_mesh *old = t->mesh;
    size_t vertices = (size_t)old->vertex_count, at = 0;
    double *position = (double *)take(t, 3 * vertices, sizeof *position);
    int32_t *number = (int32_t *)take(t, vertices, sizeof *number);
    int32_t *corner = (int32_t *)take(t, (size_t)old->halfedge_count, sizeof *corner), count = 0, i, k;
    gproj_error error;
    for (i = 0; position && number && corner && i < old->vertex_count; ++i) {
        if (same_as(same, i) != i) continue;
        memcpy(position + 3 * (size_t)count, old->position + 3 * (size_t)i, 3 * sizeof *position);
        number[i] = count++;
    }
    for (i = 0; position && number && corner && i < old->face_count; ++i) {
        int32_t h = old->face_halfedge[i];
        for (k = 0; k < old->face_degree[i]; ++k, h = old->next[h])
            corner[at++] = number[same_as(same, old->origin[h])];
    }
    if (t->exit_code == 0) {
        t->mesh = gproj_mesh_create(count, position, old->face_count, old->face_degree, corner, &t->host, &error);
        if (!t->mesh && error.code == GPROJ_ERROR_MEMORY)
            fail_memory(t);
        else if (!t->mesh)
            fail(t, EXIT_REFUSED, "%s: after --weld: %s", t->input, error.message);
        gproj_mesh_destroy(old);
        t->welded = merged;
    }
    free(position), free(number), free(corner);
    return t->exit_code == 0;
}

/* Merges boundary vertices at the same place with --weld; else counts them. */
static bool treat_seams(tool *t) {
    int32_t *same = (int32_t *)take(t, (size_t)t->mesh->vertex_count, sizeof *same);
    double edge = gproj_mesh_mean_edge_length(t->mesh);
    int32_t merged = same ? find_seams(t, (t->weld > 0 ? t->weld : SAME_PLACE) * edge, same) : -1;
    bool good = merged >= 0;
    if (good && t->weld > 0 && merged > 0)
        good = weld(t, same, merged);
    else if (good)
        t->seams = merged;
    free(same);
    return good;
}

/* The mesh from which the work begins. */
static bool make_mesh(tool *t) {
    if (t->fill) {
        if (!fill_curve(t)) return false;
    } else {
        t->mesh = load(t, t->input, strlen(t->input));
        if (!t->mesh) return false;
        if (t->mesh->face_count == 0) return fail(t, EXIT_REFUSED, "%s: the mesh has no faces", t->input);
        if (!treat_seams(t)) return false;
    }
    if (t->subdivision.levels > 0 && !subdivide(t)) return false;
    return fabs(t->lift) <= 0 || lift(t);
}

static bool read_mesh(tool *t) {
    int32_t i;
    if (!make_mesh(t)) return false;
    t->original = (double *)take(t, 3 * (size_t)t->mesh->vertex_count, sizeof *t->original);
    t->planarity_before = (double *)take(t, (size_t)t->mesh->face_count, sizeof *t->planarity);
    t->planarity = (double *)take(t, (size_t)t->mesh->face_count, sizeof *t->planarity);
    if (t->colour && t->colour->value) t->shade = (double *)take(t, (size_t)t->mesh->face_count, sizeof *t->shade);
    if (!t->original || !t->planarity_before || !t->planarity || t->exit_code != 0) return false;
    memcpy(t->original, t->mesh->position, 3 * (size_t)t->mesh->vertex_count * sizeof *t->original);
    t->before = gproj_measure(t->mesh, t->original, t->planarity_before);
    t->volume_before = gproj_volume(t->mesh);
    for (i = 0; i < t->move_count; ++i)
        if (t->move[i].vertex >= t->mesh->vertex_count)
            return fail(t, EXIT_USAGE, "--move: there is no vertex %ld; the mesh has %ld, counted from 0",
                        (long)t->move[i].vertex, (long)t->mesh->vertex_count);
    return true;
}

/* ---- the form ---- */

static bool is_moved(const tool *t, int32_t vertex) {
    int32_t i;
    for (i = 0; i < t->move_count; ++i)
        if (t->move[i].vertex == vertex && t->move[i].weight > 0) return true;
    return false;
}

/* Marks the vertices of a list I,J,K-L in any layout; comments go from # to the end of the line. `where` names it. */
static bool mark_list(tool *t, const char *text, const char *where, int exit_code, bool *mark) {
    const char *at = text;
    while (*at) {
        int32_t range[2], k;
        size_t size = strspn(at, "0123456789");
        if (*at == '#') {
            at += strcspn(at, "\n");
            continue;
        }
        if (*at == ',' || isspace((unsigned char)*at)) {
            ++at;
            continue;
        }
        for (k = 0; k < 2; ++k) {
            if (size == 0 || !read_integer(at, size, 0, t->mesh->vertex_count - 1, &range[k])) {
                if (size == 0)
                    return fail(t, exit_code, "%s: expected vertices, such as 0,7,20-29, at '%.12s'", where, at);
                return fail(t, exit_code, "%s: there is no vertex %.*s; the mesh has %ld, counted from 0", where,
                            (int)size, at, (long)t->mesh->vertex_count);
            }
            at += size;
            if (k == 0 && *at != '-') range[k = 1] = range[0];
            if (k == 0) size = strspn(++at, "0123456789");
        }
        if (range[1] < range[0])
            return fail(t, exit_code, "%s: the range %ld-%ld runs backwards", where, (long)range[0], (long)range[1]);
        for (k = range[0]; k <= range[1]; ++k) mark[k] = true;
    }
    return true;
}

/* Fails where the value of an option is neither a word nor a file. `what`: what it may be. */
static bool must_exist(tool *t, const char *option, const char *name, const char *what, const char *const *words) {
    char hint[HINT_SIZE];
    if (access(name, F_OK) == 0) return true;
    return fail(t, strpbrk(name, "./") ? EXIT_REFUSED : EXIT_USAGE, "%s %s: there is no such file; expected %s%s",
                option, name, what, did_you_mean(name, strlen(name), words, hint));
}

/* The vertices that the value of an option names. */
static bool mark_vertices(tool *t, const char *option, const tool_word *word, bool *mark) {
    static const char *const words[] = {"boundary", "corners", NULL};
    bool boundary = same_word(word->text, word->length, "boundary"),
         corners = same_word(word->text, word->length, "corners");
    char *name = (char *)take(t, word->length + 1, 1), *text;
    bool good = name != NULL;
    int32_t i;
    if (!name) return false;
    memcpy(name, word->text, word->length);
    if (boundary || corners) {
        for (i = 0; i < t->mesh->vertex_count; ++i)
            mark[i] = boundary ? gproj_mesh_is_boundary_vertex(t->mesh, i) : gproj_form_is_corner(t->form, i);
    } else if (strspn(name, "0123456789,- ") == word->length) {
        good = mark_list(t, name, option, EXIT_USAGE, mark);
    } else {
        good = must_exist(t, option, name,
                          "boundary, corners, a list of vertices such as 0,7,20-29, or a file of such numbers", words);
        text = good ? load_file(t, name, NULL) : NULL;
        good = text && mark_list(t, text, name, EXIT_REFUSED, mark);
        free(text);
    }
    free(name);
    return good;
}

/* The marked vertices that no --move takes, as a list; returns their number. */
static int32_t gather(const tool *t, const bool *mark, int32_t *list) {
    int32_t i, count = 0;
    for (i = 0; i < t->mesh->vertex_count; ++i)
        if (mark[i] && !is_moved(t, i)) list[count++] = i;
    return count;
}

static bool add_fixed(tool *t, const tool_word *word) {
    size_t vertices = (size_t)t->mesh->vertex_count;
    bool *mark = (bool *)take(t, vertices, sizeof *mark);
    int32_t *list = (int32_t *)take(t, vertices, sizeof *list), count;
    bool good = mark && list && mark_vertices(t, "--fix", word, mark);
    if (good && word->weight.weight > 0) {
        count = gather(t, mark, list);
        if (count > 0) gproj_add_fixed(t->form, count, list, word->weight.weight);
    }
    free(mark), free(list);
    return good;
}

/* One group for each weight. */
static bool add_moves(tool *t) {
    int32_t *vertex = (int32_t *)take(t, (size_t)t->move_count, sizeof *vertex), i, j;
    double *place = (double *)take(t, 3 * (size_t)t->move_count, sizeof *place);
    for (i = 0; vertex && place && i < t->move_count; ++i) {
        int32_t count = 0, earlier = 0;
        for (j = 0; j < t->move_count; ++j) {
            if (t->move[j].weight < t->move[i].weight || t->move[j].weight > t->move[i].weight) continue;
            earlier += j < i;
            vertex[count] = t->move[j].vertex;
            memcpy(place + 3 * count++, t->move[j].position, sizeof t->move[j].position);
        }
        t->move_group[i] = earlier > 0 || t->move[i].weight <= 0
                               ? -1
                               : gproj_add_targets(t->form, count, vertex, place, t->move[i].weight);
    }
    free(vertex), free(place);
    return t->exit_code == 0;
}

/* Every boundary vertex glides along the nearest of the curves from `first` on; corners that lie on it stay. */
static bool glide_along(tool *t, int32_t first, double weight) {
    size_t vertices = (size_t)t->mesh->vertex_count;
    int32_t *owner = (int32_t *)take(t, vertices, sizeof *owner), *list = (int32_t *)take(t, vertices, sizeof *list);
    int32_t i, c, count, stays = t->curve_count; /* the owner of corners that stay */
    bool good = owner && list;
    for (i = 0; good && i < t->mesh->vertex_count; ++i) {
        double distance;
        owner[i] = -1;
        if (!gproj_mesh_is_boundary_vertex(t->mesh, i) || is_moved(t, i)) continue;
        owner[i] = nearest_curve(t, first, t->curve_count, t->original + 3 * i, &distance);
        if (gproj_form_is_corner(t->form, i) && distance <= 1e-6 * t->before.mean_edge) owner[i] = stays;
    }
    for (c = first; good && c <= stays; ++c) {
        for (count = i = 0; i < t->mesh->vertex_count; ++i)
            if (owner[i] == c) list[count++] = i;
        if (count == 0) continue;
        if (c == stays)
            gproj_add_fixed(t->form, count, list, weight);
        else
            gproj_add_gliding(t->form, t->curve[c], count, list, weight);
    }
    free(owner), free(list);
    return good;
}

static bool add_gliding(tool *t, const tool_word *word) {
    int32_t first = t->curve_count, i;
    bool moved = false, good;
    if (same_word(word->text, word->length, "boundary")) {
        if (t->mesh->loop_count == 0)
            return fail(t, EXIT_USAGE, "--glide boundary: the mesh is closed and has no boundary");
        for (i = 0; i < t->move_count; ++i) moved |= gproj_mesh_is_boundary_vertex(t->mesh, t->move[i].vertex);
        if (!moved) {
            if (word->weight.weight > 0) gproj_add_gliding_boundary(t->form, word->weight.weight);
            return true;
        }
        good = add_curves(t, t->mesh, true, t->input);
    } else {
        static const char *const words[] = {"boundary", NULL};
        char *name = (char *)take(t, word->length + 1, 1);
        gproj_mesh *mesh = NULL;
        if (name) memcpy(name, word->text, word->length);
        if (name && must_exist(t, "--glide", name, "boundary, or an OBJ file with polylines", words))
            mesh = load(t, word->text, word->length);
        free(name);
        good = mesh && add_curves(t, mesh, false, word->text);
        gproj_mesh_destroy(mesh);
    }
    if (!good || word->weight.weight <= 0) return good;
    return glide_along(t, first, word->weight.weight);
}

/* A wish with its schedule. The first few iterations where no last one is given; all with --nearest. */
static void add_wish(tool *t, const tool_weight *weight, int32_t group) {
    gproj_schedule schedule;
    schedule.weight = weight->weight;
    schedule.decay = weight->decay;
    schedule.last = weight->last > 0 ? weight->last : t->equilibrium.weight > 0 ? 9 : 6;
    if (weight->last == 0 && schedule.last > t->iterations / 2)
        schedule.last = t->iterations > 1 ? t->iterations / 2 : 1;
    if (t->nearest) schedule.decay = 0, schedule.last = 0;
    if (group >= 0) gproj_set_schedule(t->form, group, schedule);
}

static bool add_reference(tool *t) {
    gproj_error error;
    t->reference_mesh = load(t, t->reference.text, t->reference.length);
    if (!t->reference_mesh) return false;
    t->surface = gproj_surface_create(t->reference_mesh, &t->host, &error);
    if (!t->surface) return fail_library(t, t->reference.text, &error);
    if (t->reference.weight.weight > 0)
        add_wish(t, &t->reference.weight, gproj_add_reference(t->form, t->surface, t->reference.weight.weight));
    return true;
}

static void add_energies(tool *t) {
    gproj_form *form = t->form;
    if (t->closeness.weight > 0) add_wish(t, &t->closeness, gproj_add_closeness(form, t->closeness.weight));
    if (t->fairness.weight > 0) add_wish(t, &t->fairness, gproj_add_fairness(form, t->fairness.weight));
    if (t->boundary_fairness.weight > 0)
        add_wish(t, &t->boundary_fairness, gproj_add_boundary_fairness(form, t->boundary_fairness.weight));
    if (t->tangential.weight > 0)
        add_wish(t, &t->tangential, gproj_add_tangential_fairness(form, t->tangential.weight));
    if (t->gauss.weight > 0) add_wish(t, &t->gauss, gproj_add_gauss_fairness(form, t->gauss.weight));
    if (t->parallelograms.weight > 0)
        add_wish(t, &t->parallelograms, gproj_add_parallelograms(form, t->parallelograms.weight));
    if (t->equal_areas.weight > 0) add_wish(t, &t->equal_areas, gproj_add_equal_areas(form, t->equal_areas.weight));
}

/* What a measure costs. */
static double cost_of(const tool *t, const gproj_measures *m) {
    return t->length_price * m->length + t->area_price * m->area;
}

/* The value that is asked for, where the input has `have`. */
static double value_of(const tool_volume *volume, double have) {
    return volume->factor ? volume->value * have : volume->value;
}

static void add_sizes(tool *t) {
    gproj_form *form = t->form;
    const tool_range *length = &t->edge_length, *area = &t->face_area;
    int32_t edges = t->mesh->edge_count, faces = t->mesh->face_count;
    if (t->equal_lengths.weight > 0) gproj_add_equal_lengths(form, edges, NULL, t->equal_lengths.weight);
    if (length->weight > 0) gproj_add_length_bounds(form, edges, NULL, length->min, length->max, length->weight);
    if (area->weight > 0) gproj_add_area_bounds(form, faces, NULL, area->min, area->max, area->weight);
    if (t->total_area.given) gproj_add_total_area(form, value_of(&t->total_area, t->before.area), 1);
    if (t->cost.given)
        gproj_add_cost_bounds(form, t->length_price, t->area_price, 0, value_of(&t->cost, cost_of(t, &t->before)), 1);
    if (t->volume.given) gproj_add_volume(form, value_of(&t->volume, gproj_volume(t->mesh)), 1);
}

/* A heading: words, and no number behind the first comma. */
static bool is_heading(const char *line, size_t size) {
    const char *comma = (const char *)memchr(line, ',', size);
    size_t at = comma ? (size_t)(comma - line) + 1 : size;
    while (at < size && isspace((unsigned char)line[at])) ++at;
    return isalpha((unsigned char)line[0]) && (at == size || !strchr("+-.0123456789", line[at]));
}

/* One line VERTEX,FX,FY,FZ; empty lines, comments after # and a heading in the first line are passed over. */
static bool read_load(tool *t, const char *line, size_t size, int32_t number) {
    double field[4];
    size_t at = 0, end;
    int32_t k;
    for (end = 0; end < size && line[end] != '#'; ++end) continue;
    while (end > 0 && isspace((unsigned char)line[end - 1])) --end;
    if (end == 0 || (number == 1 && is_heading(line, end))) return true;
    for (k = 0; k < 4; ++k) {
        const char *comma = (const char *)memchr(line + at, ',', end - at);
        size_t length = comma ? (size_t)(comma - line) - at : end - at;
        size_t next = at + length + 1;
        while (length > 0 && isspace((unsigned char)line[at])) ++at, --length;
        while (length > 0 && isspace((unsigned char)line[at + length - 1])) --length;
        if ((k < 3) != (comma != NULL) || !read_number(line + at, length, &field[k])) break;
        at = next;
    }
    if (k < 4) return fail(t, EXIT_REFUSED, "%s, line %ld: expected VERTEX,FX,FY,FZ", t->loads, (long)number);
    if (!(field[0] >= 0) || field[0] >= t->mesh->vertex_count || field[0] != floor(field[0]))
        return fail(t, EXIT_REFUSED, "%s, line %ld: there is no vertex %g; the mesh has %ld, counted from 0", t->loads,
                    (long)number, field[0], (long)t->mesh->vertex_count);
    for (k = 0; k < 3; ++k) t->point_load[3 * (size_t)field[0] + (size_t)k] += field[k + 1];
    return true;
}

static bool read_loads(tool *t) {
    char *text = load_file(t, t->loads, NULL), *line = text;
    int32_t number = 1;
    bool good = text != NULL;
    if (text && strncmp(text, "\xef\xbb\xbf", 3) == 0) line += 3; /* a byte order mark */
    t->point_load = (double *)take(t, 3 * (size_t)t->mesh->vertex_count, sizeof *t->point_load);
    good = good && t->point_load;
    for (; good && *line; ++number) {
        size_t size = strcspn(line, "\n");
        good = read_load(t, line, size, number);
        line += size + (line[size] != 0);
    }
    free(text);
    return good;
}

static bool add_equilibrium(tool *t) {
    static const tool_word boundary = {"boundary", 8, {false, 0, 0, 0}};
    size_t vertices = (size_t)t->mesh->vertex_count;
    int32_t *list = (int32_t *)take(t, vertices, sizeof *list), i;
    gproj_loads loads;
    gproj_supports supports;
    bool good;
    memset(&loads, 0, sizeof loads);
    memset(&supports, 0, sizeof supports);
    t->is_support = (bool *)take(t, vertices, sizeof *t->is_support);
    good = list && t->is_support && (!t->loads || read_loads(t)) &&
           mark_vertices(t, "--supports", t->supports.text ? &t->supports : &boundary, t->is_support);
    if (good) {
        for (i = 0; i < t->mesh->vertex_count; ++i)
            if (t->is_support[i]) list[supports.count++] = i;
        if (supports.count == 0)
            good = fail(t, EXIT_USAGE, "%s",
                        t->supports.text ? "--supports names no vertex"
                                         : "there is no support: the mesh has no boundary, so name some by --supports");
    }
    if (good) {
        supports.vertex = list;
        loads.density = t->loads_given ? t->density : 1;
        loads.area_load = t->area_load;
        loads.snow = t->snow;
        loads.point_load = t->point_load;
        gproj_add_equilibrium(t->form, &loads, &supports, t->equilibrium.weight);
    }
    free(list);
    return good;
}

static bool add_statics(tool *t) {
    int32_t edges = t->mesh->edge_count;
    if (!t->equilibrium.given) return true;
    if (!add_equilibrium(t)) return false;
    if (t->compressive.weight > 0) gproj_add_compression(t->form, edges, NULL, t->compressive.weight);
    if (t->tensile.weight > 0) gproj_add_tension(t->form, edges, NULL, t->tensile.weight);
    if (t->stress.given)
        gproj_add_stress_bounds(t->form, edges, NULL, NULL, t->stress.min, t->stress.max, t->stress.weight);
    if (t->force_fairness.weight > 0)
        add_wish(t, &t->force_fairness, gproj_add_force_fairness(t->form, t->force_fairness.weight));
    return true;
}

/* What the best forces leave unbalanced, as a mean over the corners of each face. */
static bool measure_imbalance(tool *t, double *of_faces) {
    const gproj_mesh *mesh = t->mesh;
    double *residual = (double *)take(t, (size_t)mesh->vertex_count, sizeof *residual);
    int32_t f, k;
    bool good = residual && gproj_find_forces(t->form, NULL, residual) == GPROJ_OK;
    for (f = 0; good && f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        of_faces[f] = 0;
        for (k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h])
            of_faces[f] += residual[mesh->origin[h]] / mesh->face_degree[f];
    }
    free(residual);
    return good || fail_library(t, NULL, gproj_form_error(t->form));
}

/* The groups stand in the form in the order of the table, whatever their order on the command line. */
static bool build_form(tool *t) {
    int32_t i;
    t->form = gproj_form_create(t->mesh, &t->host);
    if (!t->form) return fail_memory(t);
    if (t->planar.weight > 0) gproj_add_planarity(t->form, t->planar.weight);
    if (t->circular.weight > 0) gproj_add_circularity(t->form, t->circular.weight);
    if (t->planar_boundary.weight > 0) gproj_add_planar_boundary(t->form, t->planar_boundary.weight);
    if (t->straight_boundary.weight > 0) gproj_add_straight_boundary(t->form, t->straight_boundary.weight);
    if (t->orthogonal_boundary.weight > 0) gproj_add_orthogonal_boundary(t->form, t->orthogonal_boundary.weight);
    if (t->lifting.weight > 0) gproj_add_lifting(t->form, t->lifting.weight);
    if (!add_statics(t)) return false;
    if (t->conical.weight > 0) gproj_add_conicality(t->form, t->conical.weight);
    add_sizes(t);
    for (i = 0; i < t->fix_count; ++i)
        if (!add_fixed(t, &t->fix[i])) return false;
    for (i = 0; i < t->glide_count; ++i)
        if (!add_gliding(t, &t->glide[i])) return false;
    if (!add_moves(t)) return false;
    if (t->reference.text && !add_reference(t)) return false;
    add_energies(t);
    if (gproj_form_error(t->form)->code != GPROJ_OK) return fail_library(t, NULL, gproj_form_error(t->form));
    return true;
}

/* ---- progress ---- */

static void show_progress(tool *t, const gproj_iteration *iteration) {
    enum {
        WIDTH = 24
    };
    double seconds = 0;
    int i;
    if (t->quiet) return;
    for (i = 0; i < GPROJ_PHASE_COUNT; ++i) seconds += iteration->seconds[i];
    if (isatty(2)) {
        int full = (int)((int64_t)WIDTH * iteration->number / t->iterations);
        fputs("\r[", stderr);
        for (i = 0; i < WIDTH; ++i) fputc(i < full ? '#' : '.', stderr);
        fprintf(stderr, "] %ld/%ld  residual %.1e ", (long)iteration->number, (long)t->iterations, iteration->residual);
        t->bar = true;
    } else
        fprintf(stderr, "iteration %ld: residual %.2e, step %.2e, energy %.2e, %.1f ms\n", (long)iteration->number,
                iteration->residual, iteration->step, iteration->energy, 1e3 * seconds);
    fflush(stderr);
}

static bool on_iteration(void *user, gproj_system *system, const gproj_iteration *iteration) {
    tool *t = (tool *)user;
    show_progress(t, iteration);
    if (!t->history.probe || t->history.record_count >= t->iterations) return true;
    return gprojx_history_keep(&t->history, t->form, system, iteration) || fail_memory(t);
}

static bool measure_forces(tool *t) {
    const gproj_mesh *mesh = t->mesh;
    int32_t e, k;
    t->density_of_edge = (double *)take(t, (size_t)mesh->edge_count, sizeof *t->density_of_edge);
    t->force_in_edge = (double *)take(t, (size_t)mesh->edge_count, sizeof *t->force_in_edge);
    t->imbalance = (double *)take(t, (size_t)mesh->face_count, sizeof *t->imbalance);
    if (!t->density_of_edge || !t->force_in_edge || !t->imbalance) return false;
    gproj_get_forces(t->form, t->density_of_edge);
    for (e = 0; e < mesh->edge_count; ++e) {
        const double *a = mesh->position + 3 * (size_t)mesh->origin[2 * e],
                     *b = mesh->position + 3 * (size_t)mesh->origin[2 * e + 1];
        double square = 0;
        for (k = 0; k < 3; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
        t->force_in_edge[e] = t->density_of_edge[e] * sqrt(square);
    }
    t->forces = gproj_measure_forces(t->form);
    if (t->imbalance_before && !measure_imbalance(t, t->imbalance)) return false;
    return gproj_form_error(t->form)->code == GPROJ_OK || fail_library(t, NULL, gproj_form_error(t->form));
}

/* Switches the targets of --move off or on. */
static void switch_moves(tool *t, bool on) {
    int32_t i;
    for (i = 0; i < t->move_count; ++i) {
        gproj_schedule schedule = {0, 0, 0};
        if (on) schedule.weight = t->move[i].weight;
        if (t->move_group[i] >= 0) gproj_set_schedule(t->form, t->move_group[i], schedule);
    }
}

/* Where the moved vertices are at the part `part` of their way, 0 to 1. */
static void place_handles(const tool *t, double part, double *position) {
    int32_t i, k;
    for (i = 0; i < t->move_count; ++i)
        for (k = 0; k < 3; ++k) {
            double from = t->original[3 * (size_t)t->move[i].vertex + (size_t)k];
            position[3 * i + k] = from + part * (t->move[i].position[k] - from);
        }
}

/* One drag and its release. */
static bool drag_to(tool *t, const gproj_handles *handles, const double *position) {
    gproj_error error;
    gproj_result result;
    gproj_drag *work = gproj_drag_begin(t->form, handles, NULL, &error);
    if (!work) return fail_library(t, NULL, &error);
    if (gproj_drag_move(work, position) != GPROJ_OK) {
        fail_library(t, NULL, gproj_drag_error(work));
        gproj_drag_cancel(work);
        return false;
    }
    result = gproj_drag_end(work);
    return result.outcome != GPROJ_FAILED || fail_library(t, NULL, gproj_form_error(t->form));
}

/* Drags the moved vertices to their places, an edge at a time, with a release each. Forces have no tangent space before
   their first solve: with --equilibrium vertices are not dragged. */
static bool drag(tool *t) {
    gproj_handles handles;
    int32_t *vertex = (int32_t *)take(t, (size_t)t->move_count, sizeof *vertex), i, count;
    double *position = (double *)take(t, 3 * (size_t)t->move_count, sizeof *position), farthest = 0;
    bool good = vertex && position;
    for (i = 0; good && i < t->move_count; ++i) {
        const tool_move *move = &t->move[i];
        const double *p = t->original + 3 * (size_t)move->vertex;
        vertex[i] = move->vertex;
        farthest =
            fmax(farthest, hypot(hypot(move->position[0] - p[0], move->position[1] - p[1]), move->position[2] - p[2]));
    }
    memset(&handles, 0, sizeof handles);
    handles.count = t->move_count, handles.vertex = vertex;
    count = (int32_t)fmin(MOST_DRAGS, ceil(farthest / t->before.mean_edge));
    switch_moves(t, false);
    for (i = 1; good && i <= count; ++i) {
        place_handles(t, (double)i / count, position);
        good = drag_to(t, &handles, position);
    }
    switch_moves(t, true);
    free(vertex), free(position);
    return good;
}

/* The state in the file of --state, where there is one. */
static bool restore(tool *t) {
    const tool_output *state = &t->output[OUTPUT_STATE];
    gproj_error error;
    size_t size;
    char *bytes;
    if (access(state->target, F_OK) != 0) return true;
    bytes = load_file(t, state->path, &size);
    if (bytes && gproj_state_restore(t->form, bytes, size, &error) != GPROJ_OK) fail_library(t, state->path, &error);
    free(bytes);
    return t->exit_code == 0;
}

/* The solve, from a saved state or from the beginning, an iteration at a time: where it is broken off it can go on. */
static bool solve_in_parts(tool *t, const gproj_solve_options *how) {
    double begin = now(NULL), limit = how->time_budget;
    gproj_solve_options options = *how;
    options.time_budget = 0;
    gproj_step_begin(t->form, t->iterations, &options);
    if (!restore(t)) return false;
    if (!gproj_step_is_on(t->form)) gproj_step_begin(t->form, t->iterations, &options);
    do {
        t->result = gproj_step(t->form, 0);
    } while (gproj_step_is_on(t->form) && (limit <= 0 || now(NULL) - begin < limit));
    return true;
}

/* What is done besides the solve for the pictures and the report. */
static bool prepare_records(tool *t) {
    gproj_error error;
    if (t->output[OUTPUT_REPORT].path) {
        t->history.probe = gproj_mesh_copy(t->mesh, &t->host, &error);
        if (!t->history.probe) return fail_library(t, NULL, &error);
    }
    if (t->equilibrium.given && t->output[OUTPUT_PICTURE].path && !t->planar.given) {
        t->imbalance_before = (double *)take(t, (size_t)t->mesh->face_count, sizeof *t->imbalance_before);
        if (!t->imbalance_before || !measure_imbalance(t, t->imbalance_before)) return false;
    }
    return true;
}

static bool solve(tool *t) {
    bool dragged = t->move_count > 0 && !t->equilibrium.given;
    gproj_solve_options how;
    double begin = now(NULL);
    int32_t i;
    memset(&how, 0, sizeof how);
    how.tolerance = t->tolerance;
    how.epsilon = t->epsilon;
    how.time_budget = t->time_limit;
    how.skip_closeness = (t->closeness.given && t->closeness.weight <= 0) || (dragged && !t->nearest);
    how.smooth = !how.skip_closeness && !t->nearest;
    how.nearest = t->nearest;
    how.on_iteration = on_iteration;
    how.user = t;
    if (!prepare_records(t) || (dragged && !drag(t))) return false;
    if (!t->output[OUTPUT_STATE].path)
        t->result = gproj_solve(t->form, t->iterations, &how);
    else if (!solve_in_parts(t, &how))
        return false;
    t->solve_seconds = now(NULL) - begin;
    if (t->bar) fputc('\n', stderr);
    t->bar = false;
    if (t->exit_code != 0) return false; /* the callback ran out of memory */
    if (t->result.outcome == GPROJ_FAILED) return fail_library(t, NULL, gproj_form_error(t->form));
    t->after = gproj_measure(t->mesh, t->original, t->planarity);
    for (i = 0; t->shade && i < t->mesh->face_count; ++i) t->shade[i] = t->colour->value(t, i);
    return !t->equilibrium.given || measure_forces(t);
}

/* ---- the offset ---- */

/* The vertices keep the distance where only the faces' circles were asked for, else the faces do. */
static bool is_vertex_offset(const tool *t) { return t->circular.weight > 0 && !(t->conical.weight > 0); }

static bool make_offset(tool *t) {
    gproj_error error;
    if (!t->output[OUTPUT_OFFSET].path) return true;
    t->offset = is_vertex_offset(t) ? gproj_mesh_vertex_offset(t->mesh, t->offset_distance, &t->host, &error)
                                    : gproj_mesh_face_offset(t->mesh, t->offset_distance, &t->host, &error);
    if (!t->offset) return fail_library(t, t->output[OUTPUT_OFFSET].path, &error);
    t->offset_measures = gproj_measure_offset(t->mesh, t->offset);
    if (!t->output[OUTPUT_SUPPORT].path) return true;
    t->support = gproj_mesh_support(t->mesh, t->offset, &t->host, &error);
    return t->support || fail_library(t, t->output[OUTPUT_SUPPORT].path, &error);
}

/* How far the distances are from the one that was asked for. */
static double offset_error(const tool *t) {
    const gproj_offset_measures *m = &t->offset_measures;
    double wanted = t->offset_distance, least = m->face_distance_min, most = m->face_distance_max;
    if (is_vertex_offset(t)) wanted = fabs(wanted), least = m->vertex_distance_min, most = m->vertex_distance_max;
    return fmax(fabs(least - wanted), fabs(most - wanted));
}

/* ---- the verdict and the report ---- */

/* Tells whether what must hold holds; sentence and report tell how near a nearest mesh came to a minimum. */
static bool is_exact(const tool *t) {
    return t->result.outcome == GPROJ_CONVERGED ||
           (t->nearest && t->result.worst_group >= 0 && t->result.residual <= t->result.tolerance);
}

static int verdict_code(const tool *t) {
    bool sound = t->allow_spoiled || t->result.spoiled.total == 0;
    return is_exact(t) && sound ? EXIT_REACHED : EXIT_NOT_REACHED;
}

static gproj_code write_report(tool *t, FILE *file) {
    gprojx_report report;
    memset(&report, 0, sizeof report);
    report.version = TOOL_VERSION, report.input = t->input, report.output = t->output[OUTPUT_MESH].path;
    report.mesh = t->mesh, report.form = t->form;
    report.history = &t->history;
    report.result = &t->result;
    report.nearest = t->nearest;
    report.exit_code = verdict_code(t);
    report.before = t->before, report.after = t->after;
    report.volume_before = t->volume_before, report.volume = gproj_volume(t->mesh);
    report.priced = t->cost.given;
    report.cost_before = cost_of(t, &t->before), report.cost = cost_of(t, &t->after);
    report.forces = t->equilibrium.given ? &t->forces : NULL;
    report.offset = t->offset ? &t->offset_measures : NULL;
    report.offset_kind = is_vertex_offset(t) ? "vertices" : "faces";
    report.offset_distance = t->offset_distance;
    report.reading = t->read_seconds, report.set_up = t->setup_seconds, report.solving = t->solve_seconds;
    report.total = now(NULL) - t->start;
    return gprojx_report_write(file, &report);
}

/* ---- the other outputs ---- */

static const char *file_name(const char *path) { return strrchr(path, '/') ? strrchr(path, '/') + 1 : path; }

/* What colours the faces: what --colour says; else imbalance, where that was found; else planarity. */
static void choose_colours(const tool *t, gprojx_picture_options *picture) {
    bool moved = t->result.iterations > 0;
    picture->legend = "planarity of the faces, in mean edge lengths";
    picture->face_value = t->planarity;
    picture->face_before = moved ? t->planarity_before : NULL;
    if (t->shade) {
        picture->legend = t->colour->legend;
        picture->face_value = t->shade;
        picture->face_before = NULL;
        picture->linear = true;
        picture->high = t->colour->high;
    } else if (t->imbalance_before && !t->colour) {
        picture->legend = "load that the best forces cannot balance, over the mean load";
        picture->face_value = t->imbalance;
        picture->face_before = t->imbalance_before;
    }
}

static gproj_code write_picture(tool *t, FILE *file) {
    gprojx_picture_options picture;
    char caption[160];
    int length;
    memset(&picture, 0, sizeof picture);
    length = snprintf(caption, sizeof caption, "%ld vertices, %ld faces \xc2\xb7 ", (long)t->mesh->vertex_count,
                      (long)t->mesh->face_count);
    if (t->imbalance_before)
        snprintf(caption + length, sizeof caption - (size_t)length, "equilibrium to %.1e of the largest load",
                 t->forces.residual);
    else if (t->result.iterations > 0)
        snprintf(caption + length, sizeof caption - (size_t)length, "planarity %.1e \xe2\x86\x92 %.1e",
                 t->before.planarity_max, t->after.planarity_max);
    else
        snprintf(caption + length, sizeof caption - (size_t)length, "planarity %.1e", t->after.planarity_max);
    length = (int)strlen(caption);
    if (t->equilibrium.given && !t->imbalance_before)
        snprintf(caption + length, sizeof caption - (size_t)length, " \xc2\xb7 equilibrium to %.1e of the largest load",
                 t->forces.residual);
    picture.title = file_name(t->output[OUTPUT_MESH].path);
    picture.caption = caption;
    picture.view = t->view_given ? &t->view : NULL;
    picture.original = t->original;
    if (t->equilibrium.given) picture.edge_value = t->force_in_edge;
    choose_colours(t, &picture);
    return gprojx_picture(file, t->mesh, &picture);
}

/* Numbers that read back to the same bits, whatever the locale. */
static void write_number(FILE *file, double value, char after) {
    char text[GPROJ_NUMBER_SIZE];
    gproj_number_write(value, text);
    fputs(text, file);
    fputc(after, file);
}

static gproj_code write_forces(tool *t, FILE *file) {
    const gproj_mesh *mesh = t->mesh;
    double *load = (double *)take(t, 3 * (size_t)mesh->vertex_count, sizeof *load);
    int32_t i;
    if (!load) return GPROJ_ERROR_MEMORY;
    gproj_get_loads(t->form, load);
    fputs("kind,i,j or fx,w or fy,fz\n", file);
    for (i = 0; i < mesh->edge_count; ++i) {
        fprintf(file, "edge,%ld,%ld,", (long)mesh->origin[2 * i], (long)mesh->origin[2 * i + 1]);
        write_number(file, t->density_of_edge[i], '\n');
    }
    for (i = 0; i < mesh->vertex_count; ++i) {
        fprintf(file, "load,%ld,", (long)i);
        write_number(file, load[3 * (size_t)i], ',');
        write_number(file, load[3 * (size_t)i + 1], ',');
        write_number(file, load[3 * (size_t)i + 2], '\n');
    }
    for (i = 0; i < mesh->vertex_count; ++i)
        if (t->is_support[i]) fprintf(file, "support,%ld\n", (long)i);
    free(load);
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

static bool write_piece(void *user, const char *text, size_t size) {
    return fwrite(text, 1, size, (FILE *)user) == size;
}

static gproj_code write_as(const gproj_mesh *mesh, const char *path, FILE *file) {
    gproj_format format = has_ending(path, ".off") ? GPROJ_FORMAT_OFF : GPROJ_FORMAT_OBJ;
    return gproj_mesh_write(mesh, format, write_piece, file);
}

static gproj_code write_mesh(tool *t, FILE *file) { return write_as(t->mesh, t->output[OUTPUT_MESH].path, file); }

static gproj_code write_offset(tool *t, FILE *file) { return write_as(t->offset, t->output[OUTPUT_OFFSET].path, file); }

static gproj_code write_support(tool *t, FILE *file) {
    return write_as(t->support, t->output[OUTPUT_SUPPORT].path, file);
}

/* Opens a new file beside the target, with the mode of an old one there. */
static gproj_code write_state(tool *t, FILE *file) {
    size_t size = gproj_state_size(t->form);
    void *bytes = malloc(size ? size : 1);
    gproj_code code = bytes ? gproj_state_save(t->form, bytes, size, NULL) : GPROJ_ERROR_MEMORY;
    if (code == GPROJ_OK && fwrite(bytes, 1, size, file) != size) code = GPROJ_ERROR_FILE;
    free(bytes);
    return code;
}

static FILE *open_temporary(tool *t, tool_output *output) {
    char ending[48];
    struct stat info;
    int descriptor;
    if (output->device) return fopen(output->target, "w");
    snprintf(ending, sizeof ending, ".%ld.tmp", (long)getpid());
    output->temporary = join(t, output->target, ending, "");
    if (!output->temporary) return NULL;
    descriptor = open(output->temporary, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (descriptor < 0) {
        free(output->temporary); /* not ours */
        output->temporary = NULL;
        return NULL;
    }
    if (stat(output->target, &info) == 0 && fchmod(descriptor, info.st_mode & 0777) != 0)
        errno = 0; /* as it is, then */
    return fdopen(descriptor, "w");
}

static bool write_output(tool *t, tool_output *output, gproj_code (*write)(tool *t, FILE *file)) {
    FILE *file;
    gproj_code code;
    int closed;
    if (!output->path) return true;
    errno = 0;
    file = open_temporary(t, output);
    if (!file) return fail(t, EXIT_REFUSED, "the output '%s' cannot be written: %s", output->path, strerror(errno));
    code = write(t, file);
    closed = fclose(file);
    if (code == GPROJ_ERROR_MEMORY) return fail_memory(t);
    if (code != GPROJ_OK || closed != 0)
        return fail(t, EXIT_REFUSED, "the output '%s' cannot be written: %s", output->path,
                    errno ? strerror(errno) : gproj_code_string(code));
    return true;
}

/* All outputs are complete beside their places before the first is put there. */
static bool write_outputs(tool *t) {
    int32_t i;
    if (!write_output(t, &t->output[OUTPUT_PICTURE], write_picture) ||
        !write_output(t, &t->output[OUTPUT_FORCES], write_forces) ||
        !write_output(t, &t->output[OUTPUT_MESH], write_mesh) ||
        !write_output(t, &t->output[OUTPUT_OFFSET], write_offset) ||
        !write_output(t, &t->output[OUTPUT_SUPPORT], write_support) ||
        !write_output(t, &t->output[OUTPUT_STATE], write_state) ||
        !write_output(t, &t->output[OUTPUT_REPORT], write_report))
        return false;
    for (i = 0; i < OUTPUT_COUNT; ++i) {
        tool_output *output = &t->output[i];
        if (!output->temporary) continue;
        if (rename(output->temporary, output->target) != 0)
            return fail(t, EXIT_REFUSED, "the output '%s' cannot be written: %s", output->path, strerror(errno));
        free(output->temporary);
        output->temporary = NULL;
    }
    return true;
}

static void print_mesh(const tool *t) {
    const gproj_mesh *mesh = t->mesh;
    int32_t degree, shown = 0;
    printf("%s: %ld vertices, %ld edges, %ld faces (", file_name(t->input), (long)mesh->vertex_count,
           (long)mesh->edge_count, (long)mesh->face_count);
    for (degree = gprojx_next_degree(mesh, 0); degree > 0 && shown < 6; degree = gprojx_next_degree(mesh, degree), ++shown)
        printf("%s%ld of %ld sides", shown ? ", " : "", (long)gprojx_count_degree(mesh, degree), (long)degree);
    printf("%s), %ld boundary loop%s\n", degree > 0 ? ", ..." : "", (long)mesh->loop_count,
           mesh->loop_count == 1 ? "" : "s");
    if (mesh->reoriented_count > 0)
        printf("note: %ld faces were turned round to agree with their neighbours\n", (long)mesh->reoriented_count);
    if (t->welded > 0)
        printf("note: %ld boundary vertices were merged with others at the same place; vertices are numbered anew\n",
               (long)t->welded);
    if (t->seams > 0)
        printf("note: %ld boundary vertices are at the same place as others: the seams there are open, and their sides "
               "may "
               "come apart; --weld closes them\n",
               (long)t->seams);
    if (mesh->isolated_count > 0) printf("note: %ld vertices belong to no face\n", (long)mesh->isolated_count);
}

static void print_offset(const tool *t) {
    const gproj_offset_measures *m = &t->offset_measures;
    printf("offset        %s at distance %g to %.2e, edges parallel to %.2e, supports planar to %.2e (mean edge "
           "lengths)\n",
           is_vertex_offset(t) ? "vertices" : "faces", t->offset_distance, offset_error(t) / t->after.mean_edge,
           m->parallel_max, m->support_planarity_max);
    if (m->reversed_edges > 0)
        printf("note: %ld edges of the offset run backwards: the distance is larger than a radius of curvature\n",
               (long)m->reversed_edges);
}

/* How far the supports went. */
static double support_movement(const tool *t) {
    double most = 0;
    int32_t v, k;
    for (v = 0; v < t->mesh->vertex_count; ++v) {
        double square = 0;
        for (k = 0; t->is_support[v] && k < 3; ++k) {
            double d = t->mesh->position[3 * (size_t)v + (size_t)k] - t->original[3 * (size_t)v + (size_t)k];
            square += d * d;
        }
        if (square > most) most = square;
    }
    return sqrt(most);
}

/* The measures that some options ask for. */
static void print_asked(const tool *t) {
    const gproj_measures *b = &t->before, *a = &t->after;
    double moved = t->equilibrium.given ? support_movement(t) : 0;
    if (moved > 1e-9 * b->mean_edge) printf("supports      moved by up to %.3g; --fix or --glide holds them\n", moved);
    if (t->edge_length.given || t->equal_lengths.given)
        printf("lengths       %.6g to %.6g -> %.6g to %.6g\n", b->min_edge, b->max_edge, a->min_edge, a->max_edge);
    if (t->face_area.given || t->equal_areas.given)
        printf("face areas    %.6g to %.6g -> %.6g to %.6g\n", b->min_face_area, b->max_face_area, a->min_face_area,
               a->max_face_area);
    if (t->volume.given) printf("volume        %.6g -> %.6g\n", t->volume_before, gproj_volume(t->mesh));
    if (t->total_area.given) printf("total area    %.6g -> %.6g\n", b->area, a->area);
    if (t->cost.given) printf("cost          %.6g -> %.6g\n", cost_of(t, b), cost_of(t, a));
}

static void print_summary(const tool *t) {
    const gproj_measures *b = &t->before, *a = &t->after;
    print_mesh(t);
    printf("%s\n", t->result.message);
    if (is_exact(t) && verdict_code(t) != EXIT_REACHED)
        puts("note: exit status 1, for the mesh is spoiled; --allow-spoiled accepts it");
    printf("planarity     %.2e -> %.2e largest, %.2e -> %.2e mean (mean edge lengths)\n", b->planarity_max,
           a->planarity_max, b->planarity_mean, a->planarity_mean);
    if (t->equilibrium.given)
        printf("equilibrium   to %.1e of the largest load, force densities %.3g to %.3g, load path %.4g\n",
               t->forces.residual, t->forces.min_density, t->forces.max_density, t->forces.load_path);
    if (t->circular.given)
        printf("circularity   %.2e -> %.2e largest (mean edge lengths)\n", b->circularity_max, a->circularity_max);
    if (t->conical.given)
        printf("conicality    %.2e -> %.2e largest (radians)\n", b->conicality_max, a->conicality_max);
    if (t->offset) print_offset(t);
    printf("displacement  %.3g mean edge lengths on average, at most %.3g of the bounding-box diagonal\n",
           a->displacement_mean, a->deviation_max);
    print_asked(t);
    printf("faces         %ld turned over, %ld -> %ld bow-ties, %ld collapsed\n", (long)a->turned_faces,
           (long)b->bow_tie_faces, (long)a->bow_tie_faces, (long)t->result.spoiled.collapsed_faces);
    printf("edges         %ld -> %ld folded, %ld collapsed, %ld spikes\n", (long)b->folded_edges, (long)a->folded_edges,
           (long)t->result.spoiled.collapsed_edges, (long)t->result.spoiled.spikes);
    printf("seconds       %.3f, of these %.3f for %ld iteration%s\n", now(NULL) - t->start, t->solve_seconds,
           (long)t->result.iterations, t->result.iterations == 1 ? "" : "s");
}

/* ---- main ---- */

static bool start_threads(tool *t) {
    t->host.clock.now = now;
    if (t->threads < 2) return true;
    t->pool = gprojx_threads_create(t->threads);
    if (!t->pool) return fail(t, EXIT_MEMORY, "%ld threads cannot be had", (long)t->threads);
    t->host.parallel = gprojx_threads_hook(t->pool);
    return true;
}

static bool run(tool *t) {
    double mark;
    if (!prepare_outputs(t) || !start_threads(t) || !read_mesh(t)) return false;
    mark = now(NULL);
    t->read_seconds = mark - t->start;
    if (!build_form(t)) return false;
    t->setup_seconds = now(NULL) - mark;
    if (!solve(t) || !make_offset(t) || !write_outputs(t)) return false;
    if (!t->quiet) print_summary(t);
    return true;
}

static void clean_up(tool *t) {
    int32_t i;
    for (i = 0; i < OUTPUT_COUNT; ++i) {
        if (t->output[i].temporary) unlink(t->output[i].temporary);
        free(t->output[i].temporary), free(t->output[i].target);
    }
    gproj_form_destroy(t->form);
    for (i = 0; i < t->curve_count; ++i) gproj_curve_destroy(t->curve[i]);
    gproj_surface_destroy(t->surface);
    gproj_mesh_destroy(t->offset), gproj_mesh_destroy(t->support);
    gproj_mesh_destroy(t->reference_mesh), gproj_mesh_destroy(t->mesh);
    gprojx_threads_destroy(t->pool);
    free(t->curve), free(t->fix), free(t->glide), free(t->move), free(t->move_group);
    free(t->point_load), free(t->is_support), free(t->density_of_edge), free(t->force_in_edge);
    free(t->imbalance_before), free(t->imbalance);
    free(t->original), free(t->planarity_before), free(t->planarity), free(t->shade);
    gprojx_history_free(&t->history);
}

int main(int argc, char **argv) {
    tool t;
    int exit_code;
    memset(&t, 0, sizeof t);
    t.start = now(NULL);
    t.threads = 1;
    if (read_command_line(&t, argc, argv)) {
        if (t.help)
            print_help();
        else if (t.version)
            puts("guidedproj " TOOL_VERSION);
        else if (run(&t))
            t.exit_code = verdict_code(&t);
    }
    exit_code = t.exit_code;
    clean_up(&t);
    return exit_code;
}
