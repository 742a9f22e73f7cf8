/* guidedproj.c - form-finding with polygon meshes from the command line.

       cc -O2 -o guidedproj guidedproj.c -lm -lpthread
       ./guidedproj roof.obj -o flat.obj --planar --glide boundary --picture flat.svg

   From top to bottom: the run and its errors; numbers and words; readers of values; files; seams; builders of
   constraints and wishes; the table of options, which names a reader and a builder for each; the command line; the
   problem file; the solve; outputs (mesh, report, picture); the summary; main.

   A new option is a row in the table. Where no reader or builder fits, it has one of its own. */
#define _XOPEN_SOURCE 700

#ifndef GPROJI_IMPLEMENTED /* else the library is linked: tests compile it once */
#define GPROJ_STATIC
#define GUIDEDPROJ_IMPLEMENTATION
#endif
#include "../guidedproj.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "asked.h"
#include "formats.h"
#include "outputs.h"
#include "panels.h"
#include "picture.h"
#include "problem.h"
#include "readers.h"
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
    MOST_OPTIONS = 96,
    MOST_ITERATIONS = 100000,
    MOST_THREADS = 256,
    MOST_MEGABYTES = 1000000,
    MOST_LEVELS = 14,
    MOST_SIDES = 64,
    MOST_REPEATS = 10000, /* of an option in a problem file */
    MOST_DRAGS = 50       /* and releases, for one --move */
};

static const double SAME_PLACE = 1e-6; /* in mean edge lengths */
static const double MOST_WEIGHT = 1e50, MOST_COORDINATE = 1e70;

typedef struct tool_demand { /* what an option that adds to the form was given; each kind sets some members */
    bool given;
    double weight, decay;
    int32_t last;     /* iteration with this weight; 0: a few iterations */
    const char *text; /* a word or a path, `length` bytes */
    size_t length;
    double min, max; /* bounds */
    double amount;   /* volume, area or cost */
    bool factor;     /* `amount` multiplies the input's */
    int32_t line;    /* of the problem file; 0: the command line */
} tool_demand;

typedef struct tool_move {
    int32_t vertex;
    double position[3], weight;
    int32_t line; /* as above */
} tool_move;

typedef struct tool_word { /* an option as it was given, for --write-problem */
    int row;
    const char *value; /* NULL: none */
} tool_word;

typedef struct tool_subdivision {
    int32_t levels; /* 0: none */
    gproj_scheme scheme;
} tool_subdivision;

typedef struct tool_sides { /* numbers of edges */
    int32_t count, edges[MOST_SIDES];
} tool_sides;

enum {
    OUTPUT_MESH,
    OUTPUT_REPORT,
    OUTPUT_PICTURE,
    OUTPUT_FORCES,
    OUTPUT_OFFSET,
    OUTPUT_SUPPORT,
    OUTPUT_PANELS,
    OUTPUT_PANEL_LIST,
    OUTPUT_RESIDUALS,
    OUTPUT_PROBLEM,
    OUTPUT_STATE, /* and an input, where the file exists */
    OUTPUT_COUNT
};

typedef struct tool {
    /* what the command line says */
    const char *input;
    gprojx_output output[OUTPUT_COUNT];
    const char *fill; /* a file with a curve; NULL: the mesh is the input */
    tool_sides sides;
    tool_subdivision subdivision;
    double lift;      /* 0: none */
    const char *cage; /* of the input, which is then not subdivided; NULL: the input is the cage */
    bool welds;       /* else vertices at the same place stay apart */
    double weld;      /* in mean edge lengths */
    gprojx_encoding encoding;
    tool_demand planar, circular, conical, equal_lengths, edge_length, face_area, total_area, cost, volume, equilibrium,
        supports, freed, reference, closeness, equal_areas;
    tool_demand own[MOST_OPTIONS];   /* by row: options that only their builders read */
    double length_price, area_price; /* --cost */
    double density, area_load, snow;
    const char *loads;
    bool loads_given;         /* any of the four */
    tool_demand *fix, *glide; /* room for all words of the command line */
    tool_move *move;
    int32_t *move_group; /* the group of each move in the form; -1: an earlier move has it */
    int32_t fix_count, glide_count, move_count;
    int32_t iterations, threads;
    int32_t part;       /* iterations of this run with --state; 0: any number */
    bool ended;         /* with --state: the solve has */
    gprojx_asked asked; /* the options and files that decide about the solve */
    int32_t file_limit; /* in MB */
    double epsilon, tolerance, time_limit;
    double offset_distance; /* of output[OUTPUT_OFFSET] */
    gprojx_panel_options sheet;
    gprojx_view view;
    const struct tool_colour *colour; /* of the faces in the picture; NULL: planarity */
    const char *title;                /* of the picture; NULL: the name of the output */
    bool diagonals, nearest, plain, allow_spoiled, quiet, help, version;
    bool seen[MOST_OPTIONS]; /* by row */
    tool_word *word;         /* in the order in which they were read */
    int32_t word_count;
    const char *start_forces; /* a file, or a number for all edges */
    const char *problem_path; /* --problem; NULL: none */
    gprojx_problem problem;
    int32_t line; /* of the problem file that is being dealt with, for sentences; 0: none */
    int32_t line_of[MOST_OPTIONS], group_of[MOST_OPTIONS]; /* by row; the group in the form, -1: none or several */

    /* the work */
    gproj_host host;
    gprojx_threads *pool;
    gproj_mesh *mesh, *reference_mesh;
    gproj_mesh *cage_mesh;                 /* whose vertices are handles of the mesh; NULL: no handle needs it */
    gproj_stencil *followers[MOST_LEVELS]; /* by level of the cage, see find_followers; NULL: not needed yet */
    gproj_mesh *offset, *support;
    gproj_offset_measures offset_measures;
    gprojx_panels *panels;
    gprojx_reading reading; /* of the input */
    int32_t seams, welded;  /* boundary vertices at the same place as others: left as they are, merged */
    int32_t collapsed;      /* faces that merging left with fewer than 3 vertices */
    gproj_surface *surface;
    gproj_curve **curve;
    int32_t curve_count;
    gproj_form *form;
    gproj_result result;
    double *original, *planarity_before, *planarity;
    double *shade;                        /* each face's --colour; NULL: planarity colours the faces */
    double *point_load;                   /* --loads */
    double *imbalance_before, *imbalance; /* each face's load that the best forces leave unbalanced */
    double *density_of_edge, *force_in_edge;
    bool *is_support;
    uint8_t *loose;  /* per vertex: 1 if --free names it, 2 if that lets it go; NULL: it is not given */
    uint8_t *slides; /* by vertex: the free axes of rollers; NULL: there are none */
    gproj_forces forces;
    gproj_measures before, after;
    double volume_before;
    gprojx_history history; /* with --report */
    double start, read_seconds, setup_seconds, solve_seconds;
    bool bar; /* the last thing on the terminal is the progress bar */

    int exit_code; /* once something has failed */
} tool;

/* Prints a failure's sentence and keeps the exit code; every failure passes through here. Returns false. */
static bool fail(tool *t, int exit_code, const char *format, ...) {
    char sentence[8192];
    va_list list;
    if (t->exit_code != 0) return false;
    if (t->line > 0 && exit_code == EXIT_USAGE) exit_code = EXIT_REFUSED; /* the problem file is an input */
    t->exit_code = exit_code;
    if (t->bar) fputc('\n', stderr);
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    fputs("guidedproj: ", stderr);
    if (t->line > 0) gprojx_print_plain(stderr, t->problem_path), fprintf(stderr, ":%ld: ", (long)t->line);
    gprojx_print_plain(stderr, sentence);
    fputs(exit_code == EXIT_USAGE ? "\n(guidedproj --help lists all options)\n" : "\n", stderr);
    return false;
}

static bool fail_memory(tool *t) { return fail(t, EXIT_MEMORY, "out of memory"); }

/* Passes on an error of the library about a file; path NULL: about the form. */
static bool fail_library(tool *t, const char *path, const gproj_error *error) {
    int code = error->code == GPROJ_ERROR_MEMORY ? EXIT_MEMORY : EXIT_REFUSED;
    const char *message = error->message[0] ? error->message : gproj_code_string(error->code);
    if (!path) return fail(t, code, "%s", message);
    return fail(t, code, "%s: %s", path, message);
}

static bool fail_output(tool *t, int exit_code, const gprojx_output *output, const gproj_error *error) {
    if (error->code == GPROJ_ERROR_MEMORY) return fail_memory(t);
    return fail(t, exit_code, "the output '%s' %s", output->path, error->message);
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

/* Reads W[*DECAY][:N]; leaves the demand alone if that fails. */
static bool read_schedule(const char *text, size_t size, tool_demand *demand) {
    const char *colon = (const char *)memchr(text, ':', size), *star;
    double weight, decay = 1;
    int32_t last = 0;
    size_t body = colon ? (size_t)(colon - text) : size, first;
    if (colon && !gprojx_read_integer(colon + 1, size - body - 1, 1, INT32_MAX, &last)) return false;
    star = (const char *)memchr(text, '*', body);
    first = star ? (size_t)(star - text) : body;
    if (!gprojx_read_number(text, first, &weight) || weight < 0 || weight > MOST_WEIGHT) return false;
    if (star && !gprojx_read_number(star + 1, body - first - 1, &decay)) return false;
    if (decay <= 0 || decay > 1) return false;
    demand->given = true;
    demand->weight = weight, demand->decay = decay, demand->last = last;
    return true;
}

/* Reads WORD[=W[*DECAY][:N]], cut at the last '=' if a weight follows it. */
static tool_demand split_word(const char *text, double usual_weight) {
    const char *equals = strrchr(text, '=');
    tool_demand word;
    memset(&word, 0, sizeof word);
    word.given = true;
    word.text = text;
    word.length = strlen(text);
    word.weight = usual_weight, word.decay = 1;
    if (equals && read_schedule(equals + 1, strlen(equals + 1), &word)) word.length = (size_t)(equals - text);
    return word;
}

static bool has_constant_weight(const tool_demand *demand) { return demand->decay >= 1 && demand->last == 0; }

/* Counts the edits (insert, delete, replace, swap neighbours) that turn one word into another [Damerau 1964]. */
static int edit_distance(const char *a, size_t size, const char *b) {
    enum {
        MOST = 24
    };
    /* d[i][j]: between the first i letters of a and the first j of b. */
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

/* Returns "; did you mean WORD?" if one of the words (NULL at the end) is like this one, else "". */
static const char *did_you_mean(const char *text, size_t size, const char *const *words, char hint[HINT_SIZE]) {
    int best = 3; /* edits: too many for a typing error */
    hint[0] = 0;
    for (; *words; ++words) {
        int distance = edit_distance(text, size, *words);
        if (distance >= best || 2 * distance > (int)size) continue;
        best = distance;
        snprintf(hint, HINT_SIZE, "; did you mean %s?", *words);
    }
    return hint;
}

/* ---- readers of values: `place` is the member of the tool that an option sets ---- */

static bool fail_value(tool *t, const char *name, const char *value, const char *expected) {
    return fail(t, EXIT_USAGE, "--%s %s: expected %s", name, value, expected);
}

static bool set_flag(tool *t, void *place, const char *name, const char *value) {
    (void)t, (void)name, (void)value;
    *(bool *)place = true;
    return true;
}

static bool set_path(tool *t, void *place, const char *name, const char *value) {
    *(const char **)place = value;
    return value[0] || fail(t, EXIT_USAGE, "--%s needs a path", name);
}

static bool set_output(tool *t, void *place, const char *name, const char *value) {
    return set_path(t, &((gprojx_output *)place)->path, name, value);
}

static bool set_text(tool *t, void *place, const char *name, const char *value) {
    (void)t, (void)name;
    *(const char **)place = value;
    return true;
}

/* Reads DISTANCE,FILE. */
static bool set_offset(tool *t, void *place, const char *name, const char *value) {
    const char *comma = strchr(value, ',');
    ((gprojx_output *)place)->path = comma ? comma + 1 : NULL;
    return (comma && comma[1] && gprojx_read_number(value, (size_t)(comma - value), &t->offset_distance) &&
            fabs(t->offset_distance) > 0) ||
           fail_value(t, name, value,
                      "DISTANCE,FILE: a distance other than 0, and where to write (as in 0.3,offset.obj)");
}

/* Reads the constant weight of what must hold: 1 if it is left out. */
static bool set_must(tool *t, void *place, const char *name, const char *value) {
    tool_demand *demand = (tool_demand *)place;
    demand->given = true, demand->weight = 1;
    return !value ||
           (gprojx_read_number(value, strlen(value), &demand->weight) && demand->weight >= 0 &&
            demand->weight <= MOST_WEIGHT) ||
           fail(t, EXIT_USAGE, "--%s=%s: the weight must be a number from 0 to 1e50", name, value);
}

/* Reads a wish's schedule: weight 1 if it is left out. */
static bool set_wish(tool *t, void *place, const char *name, const char *value) {
    if (!value) value = "1";
    return read_schedule(value, strlen(value), (tool_demand *)place) ||
           fail_value(t, name, value,
                      "W[*DECAY][:N] with a weight W from 0 to 1e50, a DECAY above 0 and at most 1, and a last "
                      "iteration N of 1 or larger (as in '0.2*0.9:6')");
}

/* Reads V, or xF. */
static bool read_amount(const char *text, tool_demand *demand) {
    demand->given = true, demand->weight = 1;
    demand->factor = text[0] == 'x';
    return gprojx_read_number(text + demand->factor, strlen(text + demand->factor), &demand->amount);
}

static bool set_volume(tool *t, void *place, const char *name, const char *value) {
    return read_amount(value, (tool_demand *)place) ||
           fail_value(t, name, value, "a volume, or x and a factor of the input's volume (as in x1.2)");
}

static bool set_total_area(tool *t, void *place, const char *name, const char *value) {
    tool_demand *area = (tool_demand *)place;
    return (read_amount(value, area) && area->amount > 0) ||
           fail_value(t, name, value, "an area above 0, or x and a factor of the input's area (as in x1.2)");
}

/* Reads MIN,MAX[=W]; a bound that is left out stays as it is. */
static bool read_range(const char *value, tool_demand *range) {
    tool_demand word = split_word(value, 1);
    const char *comma = (const char *)memchr(word.text, ',', word.length);
    size_t first = comma ? (size_t)(comma - word.text) : 0, rest = comma ? word.length - first - 1 : 0;
    word.min = range->min, word.max = range->max;
    *range = word;
    return first + rest > 0 && has_constant_weight(range) &&
           (first == 0 || gprojx_read_number(word.text, first, &range->min)) &&
           (rest == 0 || gprojx_read_number(comma + 1, rest, &range->max)) &&
           (first == 0 || rest == 0 || range->min <= range->max);
}

/* Reads bounds of lengths and areas, which are never negative. */
static bool set_range(tool *t, void *place, const char *name, const char *value) {
    tool_demand *range = (tool_demand *)place;
    range->min = 0, range->max = HUGE_VAL;
    return (read_range(value, range) && range->min >= 0 && range->max > 0) ||
           fail_value(
               t, name, value,
               "MIN,MAX or MIN, or ,MAX with 0 <= MIN <= MAX, MAX above 0, and maybe =W, a weight from 0 to 1e50");
}

/* Reads bounds of stresses, of either sign. */
static bool set_stress(tool *t, void *place, const char *name, const char *value) {
    tool_demand *range = (tool_demand *)place;
    range->min = -HUGE_VAL, range->max = HUGE_VAL;
    return read_range(value, range) ||
           fail_value(t, name, value, "MIN,MAX or MIN, or ,MAX with MIN <= MAX, and maybe =W, a weight from 0 to 1e50");
}

/* Reads LENGTHPRICE,AREAPRICE,MAX; MAX may be xF. */
static bool set_cost(tool *t, void *place, const char *name, const char *value) {
    const char *first = strchr(value, ','), *second = first ? strchr(first + 1, ',') : NULL;
    tool_demand *cost = (tool_demand *)place;
    if (second && gprojx_read_number(value, (size_t)(first - value), &t->length_price) &&
        gprojx_read_number(first + 1, (size_t)(second - first - 1), &t->area_price) && read_amount(second + 1, cost) &&
        t->length_price >= 0 && t->area_price >= 0 && t->length_price + t->area_price > 0 && cost->amount > 0)
        return true;
    return fail_value(t, name, value,
                      "LENGTHPRICE,AREAPRICE,MAX: prices of 0 or larger, not both 0, and the largest cost, or x and a "
                      "factor of the input's cost (as in 1,2,x0.9)");
}

static bool set_load(tool *t, void *place, const char *name, const char *value) {
    t->loads_given = true;
    return gprojx_read_number(value, strlen(value), (double *)place) || fail_value(t, name, value, "a number");
}

static bool set_loads_file(tool *t, void *place, const char *name, const char *value) {
    t->loads_given = true;
    return set_path(t, place, name, value);
}

static bool set_vertices(tool *t, void *place, const char *name, const char *value) {
    (void)t, (void)name;
    ((tool_demand *)place)->text = value;
    ((tool_demand *)place)->length = strlen(value);
    return true;
}

static bool set_positive(tool *t, void *place, const char *name, const char *value) {
    return (gprojx_read_number(value, strlen(value), (double *)place) && *(double *)place > 0) ||
           fail_value(t, name, value, "a number larger than 0");
}

/* Reads WIDTH,HEIGHT[,GAP] in millimetres. */
static bool set_sheet(tool *t, void *place, const char *name, const char *value) {
    gprojx_panel_options *sheet = (gprojx_panel_options *)place;
    double *number[3] = {&sheet->width, &sheet->height, &sheet->gap};
    const char *at = value;
    int k;
    for (k = 0; k < 3; ++k, ++at) {
        size_t size = strcspn(at, ",");
        if (!gprojx_read_number(at, size, number[k]) || !(*number[k] > 0) || *number[k] > 1e9) break;
        at += size;
        if (!*at && k >= 1 && 2 * sheet->gap < fmin(sheet->width, sheet->height)) return true;
        if (!*at) break;
    }
    return fail_value(t, name, value,
                      "WIDTH,HEIGHT or WIDTH,HEIGHT,GAP in millimetres, above 0 and at most 1e9, with a gap below half "
                      "of both");
}

static bool set_panel_scale(tool *t, void *place, const char *name, const char *value) {
    double *scale = (double *)place;
    return (gprojx_read_number(value, strlen(value), scale) && *scale >= 1e-9 && *scale <= 1e9) ||
           fail_value(t, name, value, "the millimetres that a unit of the mesh is (1e-9 to 1e9)");
}

static bool read_count(tool *t, int32_t *count, const char *name, const char *value, int32_t low, int32_t high) {
    return gprojx_read_integer(value, strlen(value), low, high, count) ||
           fail(t, EXIT_USAGE, "--%s %s: expected a whole number from %d to %d", name, value, (int)low, (int)high);
}

static bool set_iterations(tool *t, void *place, const char *name, const char *value) {
    return read_count(t, (int32_t *)place, name, value, 1, MOST_ITERATIONS);
}

static bool set_threads(tool *t, void *place, const char *name, const char *value) {
    int32_t *threads = (int32_t *)place;
    if (!read_count(t, threads, name, value, 0, MOST_THREADS)) return false;
    if (*threads == 0) *threads = (int32_t)fmax(1, fmin(MOST_THREADS, (double)sysconf(_SC_NPROCESSORS_ONLN)));
    return true;
}

static bool set_file_limit(tool *t, void *place, const char *name, const char *value) {
    return read_count(t, (int32_t *)place, name, value, 1, MOST_MEGABYTES);
}

static bool set_subdivision(tool *t, void *place, const char *name, const char *value) {
    tool_subdivision *subdivision = (tool_subdivision *)place;
    size_t size = strcspn(value, ",");
    bool loop = strcmp(value + size, ",loop") == 0;
    subdivision->scheme = loop ? GPROJ_LOOP : GPROJ_CATMULL_CLARK;
    return (gprojx_read_integer(value, size, 1, MOST_LEVELS, &subdivision->levels) && (loop || !value[size])) ||
           fail(t, EXIT_USAGE, "--%s %s: expected a whole number from 1 to %d, with ,loop for triangles", name, value,
                MOST_LEVELS);
}

static bool set_sides(tool *t, void *place, const char *name, const char *value) {
    tool_sides *sides = (tool_sides *)place;
    const char *at = value;
    for (;; ++at) {
        size_t size = strcspn(at, ",");
        if (sides->count == MOST_SIDES || !gprojx_read_integer(at, size, 1, 100000, &sides->edges[sides->count]))
            return fail_value(t, name, value, "N,N,...: a number of edges for each side");
        sides->count++;
        at += size;
        if (!*at) return true;
    }
}

static bool set_encoding(tool *t, void *place, const char *name, const char *value) {
    static const char *const words[] = {"little", "big", "ascii", NULL}; /* as in gprojx_encoding */
    char hint[HINT_SIZE];
    int i;
    for (i = 0; words[i]; ++i)
        if (strcmp(value, words[i]) == 0) {
            *(gprojx_encoding *)place = (gprojx_encoding)i;
            return true;
        }
    return fail(t, EXIT_USAGE, "--%s %s: expected little, big or ascii%s", name, value,
                did_you_mean(value, strlen(value), words, hint));
}

static bool set_lift(tool *t, void *place, const char *name, const char *value) {
    double *lift = (double *)place;
    return (gprojx_read_number(value, strlen(value), lift) && fabs(*lift) > 0 && fabs(*lift) <= 1e50) ||
           fail_value(t, name, value, "a height, not 0, of at most 1e50");
}

static bool set_weld(tool *t, void *place, const char *name, const char *value) {
    double *weld = (double *)place;
    *weld = SAME_PLACE;
    t->welds = true;
    return !value || (gprojx_read_number(value, strlen(value), weld) && *weld >= 0 && *weld <= 1) ||
           fail(t, EXIT_USAGE, "--%s=%s: expected a distance in mean edge lengths, from 0 to 1", name, value);
}

static bool add_word(tool *t, tool_demand *words, int32_t *count, const char *name, const char *value) {
    tool_demand word = split_word(value, 1);
    if (word.length == 0) return fail(t, EXIT_USAGE, "--%s: expected a word, a list or a file before the weight", name);
    if (!has_constant_weight(&word))
        return fail(t, EXIT_USAGE, "--%s %s: what must hold has a constant weight", name, value);
    word.line = t->line;
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
    *(tool_demand *)place = split_word(value, 0.1);
    return ((tool_demand *)place)->length > 0 || fail(t, EXIT_USAGE, "--%s: expected a mesh file", name);
}

/* Reads I,X,Y,Z[=W]. */
static bool add_move(tool *t, void *place, const char *name, const char *value) {
    tool_demand word = split_word(value, 1);
    tool_move *move = &t->move[t->move_count];
    const char *at = word.text, *end = word.text + word.length, *comma;
    int32_t k, i;
    (void)place;
    for (k = 0; k < 4; ++k, at = comma + (comma < end)) {
        bool good;
        comma = (const char *)memchr(at, ',', (size_t)(end - at));
        if (!comma) comma = end;
        good = k == 0 ? gprojx_read_integer(at, (size_t)(comma - at), 0, INT32_MAX - 1, &move->vertex)
                      : gprojx_read_number(at, (size_t)(comma - at), &move->position[k - 1]);
        if (!good || (comma < end) != (k < 3) || !has_constant_weight(&word) ||
            (k > 0 && fabs(move->position[k - 1]) > MOST_COORDINATE))
            return fail_value(
                t, name, value,
                "I,X,Y,Z: a vertex and the three coordinates, up to 1e70, of its new place, and maybe =W, a "
                "weight from 0 to 1e50");
    }
    move->weight = word.weight, move->line = t->line;
    for (i = 0; i < t->move_count; ++i)
        if (t->move[i].vertex == move->vertex)
            return fail(t, EXIT_USAGE, "--%s: vertex %ld is moved twice", name, (long)move->vertex);
    t->move_count++;
    return true;
}

/* Reads a name, or AZIMUTH,ELEVATION in degrees. */
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
    for (i = 0; i < sizeof views / sizeof views[0]; ++i)
        if (strcmp(value, views[i].name) == 0) {
            *view = views[i].view;
            return true;
        }
    return (comma && gprojx_read_number(value, (size_t)(comma - value), &view->azimuth) &&
            gprojx_read_number(comma + 1, strlen(comma + 1), &view->elevation) && fabs(view->azimuth) <= 3600 &&
            fabs(view->elevation) <= 90) ||
           fail_value(t, name, value,
                      "iso, top, bottom, front, back, left, right, side, or AZIMUTH,ELEVATION in degrees");
}

/* ---- colours of faces in a picture ---- */

typedef struct tool_colour {
    const char *name, *legend;
    double high; /* the linear scale goes from 0 to this */
    double (*value)(const tool *t, int32_t face);
} tool_colour;

/* A face's area over the mean area. */
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

/* The angle between two unit vectors, in degrees. */
static double angle_between(const double a[3], const double b[3]) {
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return 57.29577951308232 * atan2(sqrt(x * x + y * y + z * z), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* The largest angle between the normals of a face and of a face beside it. */
static double bend_of_face(const tool *t, int32_t face) {
    int32_t h = t->mesh->face_halfedge[face], k;
    double a[3], b[3], largest = 0;
    gproj_mesh_face_area_vector(t->mesh, face, a);
    gprojx_unit(a);
    for (k = 0; k < t->mesh->face_degree[face]; ++k, h = t->mesh->next[h]) {
        int32_t beside = t->mesh->face[t->mesh->twin[h]];
        if (beside < 0) continue;
        gproj_mesh_face_area_vector(t->mesh, beside, b);
        gprojx_unit(b);
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
    const char *words[sizeof colours / sizeof colours[0] + 1] = {NULL};
    char hint[HINT_SIZE];
    size_t i;
    for (i = 0; i < sizeof colours / sizeof colours[0]; ++i) {
        words[i] = colours[i].name;
        if (strcmp(value, words[i]) != 0) continue;
        *(const tool_colour **)place = &colours[i];
        return true;
    }
    return fail(t, EXIT_USAGE, "--%s %s: expected planarity, area, parallelogram or bend%s", name, value,
                did_you_mean(value, strlen(value), words, hint));
}

/* ---- files ---- */

/* Tells whether an output goes to the file of this name. */
static bool goes_to(tool *t, const gprojx_output *output, const char *path, size_t size) {
    char *copy = (char *)take(t, size + 1, 1), *real;
    bool same;
    if (!copy) return false;
    memcpy(copy, path, size);
    real = realpath(copy, NULL);
    same = real && !output->device && strcmp(real, output->target) == 0;
    free(real), free(copy);
    return same;
}

/* Refuses to write over a file that this run reads. */
static bool keep_apart(tool *t, const gprojx_output *output, const char *path, size_t size) {
    if (goes_to(t, output, path, size))
        fail(t, EXIT_USAGE, "the output '%s' would overwrite the input '%.*s'", output->path, (int)size, path);
    return t->exit_code == 0;
}

static bool keep_problem_apart(tool *t, const gprojx_output *output) {
    int32_t i;
    if (t->problem_path && !keep_apart(t, output, t->problem_path, strlen(t->problem_path))) return false;
    if (t->start_forces && !keep_apart(t, output, t->start_forces, strlen(t->start_forces))) return false;
    if (t->cage && !keep_apart(t, output, t->cage, strlen(t->cage))) return false;
    for (i = 0; i < t->problem.count; ++i) {
        const gprojx_value *v = &t->problem.value[i];
        if (v->key && strcmp(v->key, "file") == 0 && !keep_apart(t, output, v->text, v->size)) return false;
    }
    return true;
}

static bool prepare_outputs(tool *t) {
    gproj_error error;
    int32_t i, j;
    for (i = 0; i < OUTPUT_COUNT; ++i) {
        gprojx_output *output = &t->output[i];
        if (!output->path) continue;
        if (!gprojx_output_prepare(output, &error)) return fail_output(t, EXIT_USAGE, output, &error);
        if (i == OUTPUT_STATE && output->device)
            return fail(t, EXIT_USAGE,
                        "--state %s is a device or a pipe: a state is written to a file and read from it",
                        output->path);
        for (j = 0; j < i; ++j)
            if (t->output[j].target && strcmp(t->output[j].target, output->target) == 0)
                return fail(t, EXIT_USAGE, "two outputs have the same path '%s'", output->path);
        if (!keep_problem_apart(t, output)) return false;
        /* Only the mesh that comes in may be replaced, by the one that goes out. */
        if (i == OUTPUT_MESH && !t->fill && goes_to(t, output, t->input, strlen(t->input))) continue;
        if (!keep_apart(t, output, t->input, strlen(t->input))) return false;
        for (j = 0; j < t->fix_count; ++j)
            if (!keep_apart(t, output, t->fix[j].text, t->fix[j].length)) return false;
        for (j = 0; j < t->glide_count; ++j)
            if (!keep_apart(t, output, t->glide[j].text, t->glide[j].length)) return false;
        if (t->loads && !keep_apart(t, output, t->loads, strlen(t->loads))) return false;
        if (t->supports.text && !keep_apart(t, output, t->supports.text, t->supports.length)) return false;
        if (t->freed.text && !keep_apart(t, output, t->freed.text, t->freed.length)) return false;
        if (t->reference.text && !keep_apart(t, output, t->reference.text, t->reference.length)) return false;
    }
    return true;
}

/* Recognises the ending of a file that other programs can convert; "" for others. */
static const char *foreign_ending(const char *path) {
    static const char *const endings[] = {".gltf", ".glb", ".step", ".stp", ".iges", ".igs", ".fbx",
                                          ".dae",  ".3ds", ".3mf",  ".3dm", ".dxf",  ".dwg", ".skp",
                                          ".ifc",  ".x3d", ".wrl",  ".usd", ".usdz", ".vtk", ".blend"};
    size_t i;
    for (i = 0; i < sizeof endings / sizeof endings[0]; ++i)
        if (gprojx_has_ending(path, endings[i])) return endings[i];
    return "";
}

/* Copies text[0..size-1], with a NUL behind it. */
static char *copy_text(tool *t, const char *text, size_t size) {
    char *copy = (char *)take(t, size + 1, 1);
    if (copy) memcpy(copy, text, size);
    return copy;
}

static bool is_obj_or_off(const void *bytes, size_t size) { return gprojx_format_of(bytes, size) == GPROJX_NEITHER; }

/* Passes on an error of gprojx_load_file. */
static bool fail_file(tool *t, const char *path, const gproj_error *error) {
    if (error->code == GPROJ_ERROR_MEMORY) return fail_memory(t);
    return fail(t, EXIT_REFUSED, "%s: %s%s", path, error->message,
                error->code == GPROJ_ERROR_SIZE ? "; --file-limit sets how much is read" : "");
}

/* See gprojx_load_file. */
static char *load_file(tool *t, const char *path, gprojx_is_text is_text, size_t *length) {
    gproj_error error;
    char *bytes = gprojx_load_file(path, is_text, t->file_limit, length, &error);
    if (!bytes) fail_file(t, path, &error);
    if (bytes && !gprojx_asked_add_file(&t->asked, path, bytes, *length)) {
        fail_memory(t);
        free(bytes);
        bytes = NULL;
    }
    return bytes;
}

/* A text that is no mesh. */
static char *load_text(tool *t, const char *path) {
    size_t length;
    char *text = load_file(t, path, gprojx_any_text, &length);
    if (text) gprojx_drop_mark(text, &length);
    if (!text || strlen(text) == length) return text;
    fail(t, EXIT_REFUSED, "%s: a zero byte; this is a device, a binary file or UTF-16, not a text", path);
    free(text);
    return NULL;
}

/* Tells the formats that the library leaves to formats.h by the ending. */
static gprojx_format format_named(const char *path) {
    return gprojx_has_ending(path, ".stl") ? GPROJX_STL : gprojx_has_ending(path, ".ply") ? GPROJX_PLY : GPROJX_NEITHER;
}

/* Reads a file with the format of the ending, else of the first word. */
static char *load_mesh_file(tool *t, const char *path, gprojx_format *format, size_t *size) {
    bool named = gprojx_has_ending(path, ".obj") || gprojx_has_ending(path, ".off");
    char *bytes;
    *format = format_named(path);
    bytes = load_file(t, path, *format != GPROJX_NEITHER ? NULL : named ? gprojx_any_text : is_obj_or_off, size);
    if (bytes && *format == GPROJX_NEITHER && !named) *format = gprojx_format_of(bytes, *size);
    return bytes;
}

/* Loads the mesh at path[0..size-1]. reading: NULL, or of an STL what was left out. */
static gproj_mesh *load(tool *t, const char *path, size_t size, gprojx_reading *reading) {
    gproj_error error;
    gproj_mesh *mesh = NULL;
    gprojx_format foreign;
    size_t length;
    char *copy = copy_text(t, path, size), *text;
    if (!copy) return NULL;
    text = load_mesh_file(t, copy, &foreign, &length);
    if (text && foreign != GPROJX_NEITHER) {
        mesh = gprojx_mesh_read(text, length, foreign, reading, &t->host, &error);
    } else if (text) {
        gproj_format format = gprojx_has_ending(copy, ".obj")   ? GPROJ_FORMAT_OBJ
                              : gprojx_has_ending(copy, ".off") ? GPROJ_FORMAT_OFF
                                                                : GPROJ_FORMAT_DETECT;
        mesh = gproj_mesh_read(text, length, format, &t->host, &error);
        if (!mesh && error.code == GPROJ_ERROR_SYNTAX && *foreign_ending(copy) && !strstr(error.message, "as OBJ"))
            fail(t, EXIT_REFUSED,
                 "%s: a %s file, and only OBJ, OFF, STL and PLY are read: write it as one of these, for example by "
                 "Blender, MeshLab or assimp (%s)",
                 copy, foreign_ending(copy), error.message);
        if (!mesh && gprojx_format_of(text, length) != GPROJX_NEITHER)
            fail(t, EXIT_REFUSED, "%s: this is %s file: its name must end in %s, or in none of .obj and .off", copy,
                 gprojx_format_of(text, length) == GPROJX_PLY ? "a PLY" : "an STL",
                 gprojx_format_of(text, length) == GPROJX_PLY ? ".ply" : ".stl");
    }
    if (text && !mesh) fail_library(t, copy, &error);
    free(text), free(copy);
    return mesh;
}

/* Finds the first closed polyline in a file, else, if there is no boundary, the first one; -1: there is none. (Sides of
   a filled curve are polylines, and none of them is closed.) */
static int32_t curve_polyline(const gproj_mesh *file) {
    int32_t k;
    for (k = 0; k < file->polyline_count; ++k)
        if (file->polyline_vertex[file->polyline_start[k]] == file->polyline_vertex[file->polyline_start[k + 1] - 1])
            return k;
    return file->polyline_count > 0 && file->loop_count == 0 ? 0 : -1;
}

/* Makes curves of a mesh's polylines, else (or for `loops`) of its boundary loops. */
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

/* Finds the curve of first..last-1 that is nearest to a point. */
static int32_t nearest_curve(const tool *t, int32_t first, int32_t last, const double *point, double *distance) {
    int32_t i, best = first;
    *distance = INFINITY;
    for (i = first; i < last; ++i) {
        double d = gproj_curve_closest(t->curve[i], point).distance;
        if (d < *distance) *distance = d, best = i;
    }
    return best;
}

/* Copies the points of the curve in a file: a polyline, the first boundary loop, or all vertices. Returns how many. */
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
    const gproj_fill_options options = {.side_count = t->sides.count, .subdivisions = t->sides.edges};
    gproj_error error;
    gproj_mesh *file = load(t, t->fill, strlen(t->fill), NULL);
    double *point;
    int32_t count;
    if (!file) return false;
    point =
        (double *)take(t, 3 * (size_t)(file->vertex_count + file->polyline_start[file->polyline_count]), sizeof *point);
    if (point) {
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

static bool fail_problem(tool *t, const gproj_error *error) {
    if (error->code == GPROJ_ERROR_MEMORY) return fail_memory(t);
    return fail(t, EXIT_REFUSED, "%s:%s", t->problem_path, error->message);
}

/* Has the problem file this section? */
static const gprojx_value *problem_section(const tool *t, const char *key) {
    return t->problem.count > 0 ? gprojx_member(&t->problem, t->problem.value, key) : NULL;
}

/* Finds the followers of the vertices of a level of the cage, once: a row for each, with its weights in the mesh. */
static const gproj_stencil *find_followers(tool *t, int32_t level) {
    const gproj_subdivide_options options = {
        .levels = t->subdivision.levels, .scheme = t->subdivision.scheme, .stencil_level = level};
    gproj_error error;
    gproj_stencil *stencil = NULL;
    gproj_mesh *mesh;
    if (t->followers[level]) return t->followers[level];
    mesh = gproj_mesh_subdivide(t->cage_mesh, &options, &stencil, &t->host, &error);
    if (mesh) t->followers[level] = gproj_stencil_transpose(stencil, &t->host, &error);
    if (!t->followers[level]) fail_library(t, t->cage ? t->cage : t->input, &error);
    gproj_stencil_destroy(stencil);
    gproj_mesh_destroy(mesh);
    return t->followers[level];
}

typedef struct tool_hold { /* on a vertex of the cage, of a level between, or of the mesh */
    int32_t vertex;
    int64_t start[2];
    gproj_handles handles; /* one, with the followers of this vertex, or with itself; points into the above */
    double by[3];
} tool_hold;

/* Takes hold of the vertex of an item of "handles" or "pulls". */
static bool take_hold(tool *t, const gprojx_value *item, const char *section, tool_hold *hold) {
    const gprojx_handle handle = gprojx_read_handle(&t->problem, item);
    const gproj_stencil *followers = NULL;
    gproj_error error;
    memset(hold, 0, sizeof *hold);
    memcpy(hold->by, handle.by, sizeof hold->by);
    hold->vertex = handle.vertex;
    hold->start[1] = 1;
    hold->handles.count = 1, hold->handles.start = hold->start, hold->handles.vertex = &hold->vertex;
    if (handle.level < t->subdivision.levels && !(followers = find_followers(t, handle.level))) return false;
    if (!gprojx_check_handle(&t->problem, item, section, followers ? followers->row_count : t->mesh->vertex_count,
                             &error))
        return fail_problem(t, &error);
    if (!followers) return true;
    memcpy(hold->start, followers->start + handle.vertex, sizeof hold->start);
    hold->handles.vertex = followers->column, hold->handles.weight = followers->weight;
    return true;
}

/* Refuses pulls of vertices that there are not, before the work begins. */
static bool check_pulls(tool *t) {
    const gprojx_value *array = problem_section(t, "pulls"), *item;
    tool_hold hold;
    for (item = array ? gprojx_inside(array) : NULL; item; item = gprojx_after(&t->problem, item))
        if (!take_hold(t, item, "pulls", &hold)) return false;
    return true;
}

/* Moves the mesh by the handles of its cage. */
static bool follow_handles(tool *t) {
    const gprojx_value *array = problem_section(t, "handles"), *item;
    tool_hold hold;
    int64_t k;
    int c;
    for (item = array ? gprojx_inside(array) : NULL; item; item = gprojx_after(&t->problem, item)) {
        if (!take_hold(t, item, "handles", &hold)) return false;
        for (k = hold.start[0]; k < hold.start[1]; ++k) {
            double *p = t->mesh->position + 3 * (size_t)hold.handles.vertex[k];
            for (c = 0; c < 3; ++c) p[c] += (hold.handles.weight ? hold.handles.weight[k] : 1) * hold.by[c];
        }
    }
    return true;
}

/* Reads the cage that the input came of, and moves the input by its handles. */
static bool follow_cage(tool *t) {
    const gproj_subdivide_options options = {.levels = t->subdivision.levels, .scheme = t->subdivision.scheme};
    gproj_error error;
    gproj_mesh *fine;
    t->cage_mesh = load(t, t->cage, strlen(t->cage), NULL);
    if (!t->cage_mesh) return false;
    fine = gproj_mesh_subdivide(t->cage_mesh, &options, NULL, &t->host, &error);
    if (!fine) return fail_library(t, t->cage, &error);
    if (fine->vertex_count != t->mesh->vertex_count || fine->face_count != t->mesh->face_count)
        fail(t, EXIT_REFUSED, "%s: subdivided, this cage has %ld vertices and %ld faces, and the input %ld and %ld",
             t->cage, (long)fine->vertex_count, (long)fine->face_count, (long)t->mesh->vertex_count,
             (long)t->mesh->face_count);
    gproj_mesh_destroy(fine);
    return t->exit_code == 0 && follow_handles(t);
}

/* Subdivides at once, or with handles a level at a time: the vertices of each level are pulled before the next. */
static bool subdivide(tool *t) {
    bool pulled = problem_section(t, "handles") != NULL;
    const gproj_subdivide_options options = {.levels = pulled ? 1 : t->subdivision.levels,
                                             .scheme = t->subdivision.scheme};
    int32_t level, last = pulled ? t->subdivision.levels : 1;
    gproj_error error;
    if (problem_section(t, "pulls") && !(t->cage_mesh = gproj_mesh_copy(t->mesh, &t->host, &error)))
        return fail_library(t, t->input, &error);
    for (level = 0; level <= last; ++level) {
        gproj_mesh *coarse = t->mesh;
        if (pulled && !gprojx_move_handles(&t->problem, coarse, level, &error)) return fail_problem(t, &error);
        if (level == last) break;
        t->mesh = gproj_mesh_subdivide(coarse, &options, NULL, &t->host, &error);
        gproj_mesh_destroy(coarse);
        if (!t->mesh) return fail_library(t, t->input, &error);
    }
    return true;
}

/* Finds the vertex inside that is farthest from the boundary (curves `first` and after); -1: there is none. */
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

/* Projects once before the solve: one vertex goes up, the boundary stays, fairness guides the others, and closeness
   decides between shapes that are equally fair. The constraints are linear: a few iterations are enough. */
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
    if (result.outcome == GPROJ_FAILED)
        fail_library(t, NULL, gproj_form_error(form));
    else if (result.outcome != GPROJ_CONVERGED)
        fail(t, EXIT_REFUSED, "%s: --lift %g cannot be done: %s", t->input, t->lift, result.message);
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

/* Finds the smallest vertex at the place of this one, and shortens the way to it (union-find, halving paths). */
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

/* Finds boundary vertices that are within `distance` and that no edge joins. same, vertex_count entries: the smallest
   vertex at the place of each. Returns how many have a smaller one; -1 without memory. */
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
    /* Vertices within `distance` are as near along the direction: only neighbours in the sorted list are compared. */
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

/* Writes a face's corners by their numbers, without repeated neighbours. Returns their count; 0 if fewer than 3. */
static int32_t weld_face(const gproj_mesh *mesh, int32_t face, int32_t *same, const int32_t *number, int32_t *corner) {
    int32_t h = mesh->face_halfedge[face], count = 0, k;
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h]) {
        corner[count] = number[same_as(same, mesh->origin[h])];
        count += count == 0 || corner[count] != corner[count - 1];
    }
    while (count > 1 && corner[count - 1] == corner[0]) --count;
    return count < 3 ? 0 : count;
}

/* Makes one vertex of those at the same place; `merged` of them go, and faces that are then none. */
static bool weld(tool *t, int32_t *same, int32_t merged) {
    gproj_mesh *old = t->mesh;
    size_t vertices = (size_t)old->vertex_count, at = 0;
    double *position = (double *)take(t, 3 * vertices, sizeof *position);
    int32_t *number = (int32_t *)take(t, vertices, sizeof *number);
    int32_t *degree = (int32_t *)take(t, (size_t)old->face_count, sizeof *degree);
    int32_t *corner = (int32_t *)take(t, (size_t)old->halfedge_count, sizeof *corner), count = 0, faces = 0, i;
    gproj_error error;
    /* Vertices that stay are numbered anew, in their order; faces then speak of these numbers. */
    for (i = 0; t->exit_code == 0 && i < old->vertex_count; ++i) {
        if (same_as(same, i) != i) continue;
        memcpy(position + 3 * (size_t)count, old->position + 3 * (size_t)i, 3 * sizeof *position);
        number[i] = count++;
    }
    for (i = 0; t->exit_code == 0 && i < old->face_count; ++i) {
        degree[faces] = weld_face(old, i, same, number, corner + at);
        at += (size_t)degree[faces], faces += degree[faces] > 0;
    }
    if (t->exit_code == 0) {
        t->mesh = gproj_mesh_create(count, position, faces, degree, corner, &t->host, &error);
        if (!t->mesh && error.code == GPROJ_ERROR_MEMORY)
            fail_memory(t);
        else if (!t->mesh)
            fail(t, EXIT_REFUSED, "%s: after --weld: %s", t->input, error.message);
        t->collapsed = old->face_count - faces;
        gproj_mesh_destroy(old);
        t->welded = merged;
    }
    free(position), free(number), free(degree), free(corner);
    return t->exit_code == 0;
}

/* With --weld merges boundary vertices at the same place, else counts them. */
static bool treat_seams(tool *t) {
    int32_t *same = (int32_t *)take(t, (size_t)t->mesh->vertex_count, sizeof *same);
    double edge = gproj_mesh_mean_edge_length(t->mesh);
    int32_t merged = same ? find_seams(t, (t->welds ? t->weld : SAME_PLACE) * edge, same) : -1;
    bool good = merged >= 0;
    if (good && t->welds && merged > 0)
        good = weld(t, same, merged);
    else if (good)
        t->seams = merged;
    free(same);
    return good;
}

/* Makes the mesh along the diagonals. */
static bool take_diagonals(tool *t) {
    gproj_error error;
    gproj_mesh *old = t->mesh;
    t->mesh = gproj_mesh_diagonals(old, &t->host, &error);
    gproj_mesh_destroy(old);
    return t->mesh || fail_library(t, t->input, &error);
}

/* Makes the mesh from which the work begins. */
static bool make_mesh(tool *t) {
    if (t->fill) {
        if (!fill_curve(t)) return false;
    } else {
        t->mesh = load(t, t->input, strlen(t->input), &t->reading);
        if (!t->mesh) return false;
        if (t->mesh->face_count == 0) return fail(t, EXIT_REFUSED, "%s: the mesh has no faces", t->input);
        if (!treat_seams(t)) return false;
    }
    if (t->diagonals && !take_diagonals(t)) return false;
    if (t->subdivision.levels > 0 && !(t->cage ? follow_cage(t) : subdivide(t))) return false;
    return check_pulls(t) && (fabs(t->lift) <= 0 || lift(t));
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
    for (i = 0; i < t->move_count; ++i) {
        t->line = t->move[i].line;
        if (t->move[i].vertex >= t->mesh->vertex_count)
            return fail(t, EXIT_USAGE, "--move: there is no vertex %ld; the mesh has %ld, counted from 0",
                        (long)t->move[i].vertex, (long)t->mesh->vertex_count);
    }
    t->line = 0;
    return true;
}

/* ---- builders: each adds what an option asks for to the form ---- */

/* Do --fix and --glide leave this vertex out? */
static bool is_free(tool *t, int32_t vertex) {
    int32_t i;
    if (t->loose && t->loose[vertex]) return t->loose[vertex] = 2, true;
    for (i = 0; i < t->move_count; ++i)
        if (t->move[i].vertex == vertex && t->move[i].weight > 0) return true;
    return false;
}

/* Marks the vertices of a list; `where` names it. */
static bool mark_list(tool *t, const char *text, const char *where, int exit_code, bool *mark) {
    gproj_error error;
    return gprojx_mark_list(text, t->mesh->vertex_count, mark, &error) ||
           fail(t, exit_code, "%s: %s", where, error.message);
}

/* Fails if the value of an option is neither a word nor a file. expected: both, for the sentence. */
static bool must_exist(tool *t, const char *option, const char *name, const char *expected, const char *const *words) {
    char hint[HINT_SIZE];
    if (access(name, F_OK) == 0) return true;
    return fail(t, strpbrk(name, "./") ? EXIT_REFUSED : EXIT_USAGE, "%s %s: there is no such file; expected %s%s",
                option, name, expected, did_you_mean(name, strlen(name), words, hint));
}

/* What names vertices, for sentences. */
#define MARKS "boundary, corners, a list of vertices such as 0,7,20-29, or a file of such numbers"

/* Marks the vertices that the value of an option names; `given`: the option takes a weight, too. */
static bool mark_vertices(tool *t, const char *option, const tool_demand *word, bool *mark) {
    static const char *const words[] = {"boundary", "corners", NULL};
    bool boundary = same_word(word->text, word->length, "boundary"),
         corners = same_word(word->text, word->length, "corners");
    char *name = copy_text(t, word->text, word->length), *text;
    bool good = name != NULL;
    int32_t i;
    if (!name) return false;
    if (boundary || corners) {
        for (i = 0; i < t->mesh->vertex_count; ++i)
            mark[i] = boundary ? gproj_mesh_is_boundary_vertex(t->mesh, i) : gproj_form_is_corner(t->form, i);
    } else if (strspn(name, "0123456789,- ") == word->length) {
        good = mark_list(t, name, option, EXIT_USAGE, mark);
    } else {
        good =
            must_exist(t, option, name, word->given ? MARKS ", and maybe =W, a weight from 0 to 1e50" : MARKS, words);
        text = good ? load_text(t, name) : NULL;
        good = text && mark_list(t, text, name, EXIT_REFUSED, mark);
        free(text);
    }
    free(name);
    return good;
}

/* Notes which vertices --fix and --glide are to leave out. */
static int32_t add_loose(tool *t, const tool_demand *demand) {
    size_t vertices = (size_t)t->mesh->vertex_count, i;
    bool *mark = (bool *)take(t, vertices, sizeof *mark);
    t->loose = (uint8_t *)take(t, vertices, sizeof *t->loose);
    if (mark && t->loose && mark_vertices(t, "--free", demand, mark))
        for (i = 0; i < vertices; ++i) t->loose[i] = mark[i];
    free(mark);
    return -1;
}

/* Fails if --free names a vertex that is in no --fix and --glide, or none at all. */
static bool check_loose(tool *t) {
    int32_t i;
    bool any = false;
    for (i = 0; i < t->mesh->vertex_count; ++i) {
        any = any || t->loose[i];
        if (t->loose[i] == 1) return fail(t, EXIT_USAGE, "--free: vertex %ld is held by no --fix and --glide", (long)i);
    }
    return any || fail(t, EXIT_USAGE, "--free: this names no vertex");
}

/* Adds one group for each --fix, without vertices that are free. */
static int32_t add_fixed(tool *t, const tool_demand *none) {
    size_t vertices = (size_t)t->mesh->vertex_count;
    bool *mark = (bool *)take(t, vertices, sizeof *mark);
    int32_t *list = (int32_t *)take(t, vertices, sizeof *list), count, i, k;
    (void)none;
    for (k = 0; mark && list && k < t->fix_count; ++k) {
        memset(mark, 0, vertices * sizeof *mark);
        t->line = t->fix[k].line;
        if (!mark_vertices(t, "--fix", &t->fix[k], mark)) break;
        for (i = 0; i < t->mesh->vertex_count && !mark[i];) ++i;
        if (i == t->mesh->vertex_count && t->fix[k].weight > 0) {
            bool corners = same_word(t->fix[k].text, t->fix[k].length, "corners");
            bool boundary = corners || same_word(t->fix[k].text, t->fix[k].length, "boundary");
            fail(t, EXIT_USAGE, "--fix %.*s: %s", (int)t->fix[k].length, t->fix[k].text,
                 boundary && t->mesh->loop_count == 0 ? "the mesh is closed and has no boundary"
                 : corners                            ? "the boundary has no corners"
                                                      : "this names no vertex");
            break;
        }
        for (count = i = 0; i < t->mesh->vertex_count; ++i)
            if (mark[i] && !is_free(t, i)) list[count++] = i;
        if (count == 0 && t->loose && t->fix[k].weight > 0) {
            fail(t, EXIT_USAGE, "--fix %.*s: --free lets all of these go", (int)t->fix[k].length, t->fix[k].text);
            break;
        }
        if (count > 0 && t->fix[k].weight > 0) gproj_add_fixed(t->form, count, list, t->fix[k].weight);
    }
    free(mark), free(list);
    return -1;
}

/* Adds one group for each weight of a --move. */
static int32_t add_moves(tool *t, const tool_demand *none) {
    int32_t *vertex = (int32_t *)take(t, (size_t)t->move_count, sizeof *vertex), i, j;
    double *place = (double *)take(t, 3 * (size_t)t->move_count, sizeof *place);
    (void)none;
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
    return -1;
}

/* Lets every boundary vertex glide along the nearest of the curves from `first` on; corners on it stay. */
static bool glide_along(tool *t, int32_t first, double weight) {
    size_t vertices = (size_t)t->mesh->vertex_count;
    int32_t *owner = (int32_t *)take(t, vertices, sizeof *owner), *list = (int32_t *)take(t, vertices, sizeof *list);
    int32_t i, c, count, stays = t->curve_count; /* the owner of corners that stay */
    bool good = owner && list;
    for (i = 0; good && i < t->mesh->vertex_count; ++i) {
        double distance;
        owner[i] = -1;
        if (!gproj_mesh_is_boundary_vertex(t->mesh, i) || is_free(t, i)) continue;
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

static bool add_gliding(tool *t, const tool_demand *word) {
    int32_t first = t->curve_count, i;
    bool all = true, good;
    if (same_word(word->text, word->length, "boundary")) {
        if (t->mesh->loop_count == 0)
            return fail(t, EXIT_USAGE, "--glide boundary: the mesh is closed and has no boundary");
        for (i = 0; i < t->mesh->vertex_count; ++i)
            if (gproj_mesh_is_boundary_vertex(t->mesh, i) && is_free(t, i)) all = false;
        if (all) {
            if (word->weight > 0) gproj_add_gliding_boundary(t->form, word->weight);
            return true;
        }
        good = add_curves(t, t->mesh, true, t->input);
    } else {
        static const char *const words[] = {"boundary", NULL};
        char *name = copy_text(t, word->text, word->length);
        gproj_mesh *mesh = NULL;
        if (name && must_exist(t, "--glide", name,
                               "boundary, or an OBJ file with polylines, and maybe =W, a weight from 0 to 1e50", words))
            mesh = load(t, word->text, word->length, NULL);
        free(name);
        good = mesh && add_curves(t, mesh, false, word->text);
        gproj_mesh_destroy(mesh);
    }
    if (!good || word->weight <= 0) return good;
    return glide_along(t, first, word->weight);
}

static int32_t add_all_gliding(tool *t, const tool_demand *none) {
    int32_t i;
    (void)none;
    for (i = 0; i < t->glide_count; ++i) {
        t->line = t->glide[i].line;
        if (!add_gliding(t, &t->glide[i])) break;
    }
    return -1;
}

static int32_t add_reference(tool *t, const tool_demand *demand) {
    static const char *const words[] = {"input", NULL};
    bool input = same_word(demand->text, demand->length, "input");
    gproj_error error;
    char *name = input ? NULL : copy_text(t, demand->text, demand->length);
    if (name && must_exist(t, "--reference", name,
                           "input, or the file of a mesh, and maybe =W, a weight from 0 to 1e50 or W*DECAY:N", words))
        t->reference_mesh = load(t, name, demand->length, NULL);
    free(name);
    if (!input && !t->reference_mesh) return -1;
    t->surface = gproj_surface_create(input ? t->mesh : t->reference_mesh, &t->host, &error);
    if (!t->surface) fail_library(t, demand->text, &error);
    return t->surface && demand->weight > 0 ? gproj_add_reference(t->form, t->surface, demand->weight) : -1;
}

static int32_t add_edge_length(tool *t, const tool_demand *demand) {
    if (demand->weight <= 0) return -1;
    return gproj_add_length_bounds(t->form, t->mesh->edge_count, NULL, demand->min, demand->max, demand->weight);
}

static int32_t add_face_area(tool *t, const tool_demand *demand) {
    if (demand->weight <= 0) return -1;
    return gproj_add_area_bounds(t->form, t->mesh->face_count, NULL, demand->min, demand->max, demand->weight);
}

static double cost_of(const tool *t, const gproj_measures *m) {
    return t->length_price * m->length + t->area_price * m->area;
}

/* The amount that a demand means, if the input has `have`. */
static double amount_of(const tool_demand *demand, double have) {
    return demand->factor ? demand->amount * have : demand->amount;
}

static int32_t add_total_area(tool *t, const tool_demand *demand) {
    return gproj_add_total_area(t->form, amount_of(demand, t->before.area), 1);
}

static int32_t add_cost(tool *t, const tool_demand *demand) {
    double most = amount_of(demand, cost_of(t, &t->before));
    return gproj_add_cost_bounds(t->form, t->length_price, t->area_price, 0, most, 1);
}

static int32_t add_volume(tool *t, const tool_demand *demand) {
    return gproj_add_volume(t->form, amount_of(demand, gproj_volume(t->mesh)), 1);
}

static bool read_loads(tool *t) {
    char *text = load_text(t, t->loads);
    gproj_error error;
    bool good;
    t->point_load = (double *)take(t, 3 * (size_t)t->mesh->vertex_count, sizeof *t->point_load);
    good = text && t->point_load;
    if (good && !gprojx_read_loads(text, t->mesh->vertex_count, t->point_load, &error))
        good = fail(t, EXIT_REFUSED, "%s, %s", t->loads, error.message);
    free(text);
    return good;
}

/* Marks the supports: those of --supports, or the boundary, and the rollers. */
static bool mark_supports(tool *t) {
    const tool_demand boundary = split_word("boundary", 1);
    gproj_error error;
    if (!mark_vertices(t, "--supports", t->supports.text ? &t->supports : &boundary, t->is_support)) return false;
    if (!problem_section(t, "rollers")) return true;
    t->slides = (uint8_t *)take(t, (size_t)t->mesh->vertex_count, sizeof *t->slides);
    return t->slides &&
           (gprojx_problem_rollers(&t->problem, t->is_support, t->slides, &error) || fail_problem(t, &error));
}

/* Makes an array with a number for each edge: `usual`, or what a section of the problem says. NULL: there is none, or
   the run has failed. */
static double *edge_numbers(tool *t, const char *section, const char *key, double usual) {
    double *of_edge =
        problem_section(t, section) ? (double *)take(t, (size_t)t->mesh->edge_count, sizeof *of_edge) : NULL;
    gproj_error error;
    int32_t e;
    for (e = 0; of_edge && e < t->mesh->edge_count; ++e) of_edge[e] = usual;
    if (of_edge && !gprojx_problem_edges(&t->problem, section, key, of_edge, &error)) fail_problem(t, &error);
    return of_edge;
}

static int32_t add_equilibrium(tool *t, const tool_demand *demand) {
    size_t vertices = (size_t)t->mesh->vertex_count;
    int32_t *list = (int32_t *)take(t, vertices, sizeof *list), i, group = -1;
    uint8_t *slides = (uint8_t *)take(t, vertices, sizeof *slides);
    double density = t->loads_given ? t->density : 1;
    double *densities = edge_numbers(t, "densities", "density", density);
    gproj_supports supports = {.vertex = list};
    t->is_support = (bool *)take(t, vertices, sizeof *t->is_support);
    if (list && slides && t->is_support && t->exit_code == 0 && (!t->loads || read_loads(t)) && mark_supports(t)) {
        const gproj_loads loads = {.density = density,
                                   .edge_density = densities,
                                   .area_load = t->area_load,
                                   .snow = t->snow,
                                   .point_load = t->point_load};
        for (i = 0; i < t->mesh->vertex_count; ++i)
            if (t->is_support[i]) slides[supports.count] = t->slides ? t->slides[i] : 0, list[supports.count++] = i;
        if (t->slides) supports.slides = slides;
        if (supports.count == 0)
            fail(t, EXIT_USAGE, "%s",
                 t->supports.text && t->mesh->loop_count > 0
                     ? "--supports names no vertex"
                     : "there is no support: the mesh has no boundary, so name some by --supports");
        else
            group = gproj_add_equilibrium(t->form, &loads, &supports, demand->weight);
    }
    free(list), free(slides), free(densities);
    return group;
}

static int32_t add_stress(tool *t, const tool_demand *demand) {
    double *sections = edge_numbers(t, "sections", "section", 1);
    int32_t group = -1;
    if (t->exit_code == 0)
        group = gproj_add_stress_bounds(t->form, t->mesh->edge_count, NULL, sections, demand->min, demand->max,
                                        demand->weight);
    free(sections);
    return group;
}

/* ---- the table of options ---- */

typedef enum tool_kind {
    SETTING,
    BEGINNING, /* changes the mesh before the solve */
    HARD,      /* must hold */
    SOFT       /* is wished, until the schedule ends */
} tool_kind;

typedef enum tool_stage { /* the order in which options are added to the form; within a stage, that of the table */
    NO_STAGE,             /* adds nothing */
    SHAPES,
    STATICS,
    SIZES,
    WISHES,
    STAGE_COUNT
} tool_stage;

typedef struct tool_need { /* an option that must be given too, and the sentence that asks for it */
    size_t place;
    const char *why;
} tool_need;

typedef struct tool_option {
    const char *name;
    const char *value; /* syntax: "" none, "[=W]" may be left out, else needed */
    const char *help;
    bool (*read)(tool *t, void *place, const char *name, const char *value);
    size_t place; /* offset of the member of tool that `read` sets; 0: tool.own[row] */
    tool_kind kind;
    tool_stage stage;
    /* One of these adds it to the form and returns the group: the first two if the weight is above 0, with all edges,
       the third for any weight (-1: there is no group; t->exit_code tells of errors). */
    int32_t (*build)(gproj_form *form, double weight);
    int32_t (*build_edges)(gproj_form *form, int32_t count, const int32_t *edges, double weight);
    int32_t (*add)(tool *t, const tool_demand *demand);
    const tool_need *needs;
    bool repeatable;
    bool of_boundary;    /* asks for nothing of a closed mesh */
    char letter;         /* 'o' for -o; 0: none */
    const char *section; /* a heading above this option; NULL: none */
} tool_option;

#define PLACE(member) offsetof(tool, member)
#define SETS(member) .place = PLACE(member)

static const tool_need a_curve = {PLACE(fill), "are those of a curve: add --fill CURVE.obj"};
static const tool_need a_subdivision = {PLACE(subdivision), "is subdivided to the input: add --subdivide N"};
static const tool_need a_picture = {PLACE(output[OUTPUT_PICTURE]), "is for a picture: add --picture FILE.svg"};
static const tool_need an_offset = {PLACE(output[OUTPUT_OFFSET]),
                                    "is between the mesh and its offset: add --offset DISTANCE,FILE.obj"};
static const tool_need panels = {PLACE(output[OUTPUT_PANELS]), "is about panels: add --panels FILE.svg or FILE.dxf"};
static const tool_need normals = {PLACE(planar), "needs the normals of planar faces: add --planar"};
static const tool_need statics = {
    PLACE(equilibrium),
    "is about forces: add --equilibrium (the edges then bear their own weight, or what --density, --area-load, --snow "
    "and --loads say; supports are at the boundary, or where --supports says)"};

/* --help shows the rows as they stand here. */
static const tool_option options[] = {
    {"output", "FILE", "the result, .obj, .off, .stl or .ply (needed)", set_output, SETS(output[OUTPUT_MESH]),
     .letter = 'o', .section = "files"},
    {"encoding", "WORD",
     "of .stl and .ply outputs: little (binary, little-endian, if left out), big (PLY only) or ascii. PLY keeps "
     "all digits, binary STL those of floats; STL has triangles only",
     set_encoding, SETS(encoding)},
    {"file-limit", "MB", "files are read up to this size (1024)", set_file_limit, SETS(file_limit)},

    {"problem", "FILE",
     "JSON: the options as keys without dashes (\"planar\": true, \"fix\": [\"corners\", \"3,4\"]; \"input\": the "
     "INPUT), which the command line takes the place of, and sections for more: see README",
     set_path, SETS(problem_path)},
    {"write-problem", "FILE", "what the command line and --problem mean, as a --problem", set_output,
     SETS(output[OUTPUT_PROBLEM])},

    {"fill", "CURVE",
     "instead of INPUT: quads fill the curve in this OBJ file: its first closed polyline, else its boundary, else its "
     "first polyline, closed, else all its vertices. The boundary's vertices come first",
     set_path, SETS(fill), .kind = BEGINNING, .section = "where it begins"},
    {"sides", "N,N,...",
     "the numbers of edges of the curve's sides, from corner to corner (by its mean edge if left out)", set_sides,
     SETS(sides), .needs = &a_curve},
    {"diagonals", "",
     "the mesh along the diagonals: a vertex amid each edge, a face for each face and for each vertex; for meshes "
     "whose edges follow the asymptotic directions of a saddle-shaped surface, in which faces cannot become flat",
     set_flag, SETS(diagonals), .kind = BEGINNING},
    {"subdivide", "N[,loop]",
     "the input is a cage: N times each face becomes quads about its middle (Catmull and Clark), with ,loop each "
     "triangle four (Loop). The cage's vertices keep their numbers",
     set_subdivision, SETS(subdivision), .kind = BEGINNING},
    {"cage", "FILE",
     "the input came of this cage by --subdivide, and has been shaped since: it is not subdivided again, and handles "
     "of the cage's vertices (in a problem file) move it as it is",
     set_path, SETS(cage), .kind = BEGINNING, .needs = &a_subdivision},
    {"weld", "[=TOL]",
     "boundary vertices at the same place, within TOL mean edge lengths (1e-6; 0: exactly), become one: seams are "
     "closed, and the triangles of an STL joined. Vertices are numbered anew, and polylines left out",
     set_weld, SETS(weld)},
    {"lift", "HEIGHT", "the vertex farthest from the boundary is pulled up by HEIGHT, and the mesh follows smoothly",
     set_lift, SETS(lift), .kind = BEGINNING},
    {"state", "FILE",
     "where FILE exists, the work goes on from there: it was written with the same input and options, but for "
     "outputs, --time-limit, --iterations and --threads. At the end the state is written to it. With --time-limit or "
     "--iterations, then those of this run, long work can be done in parts: exit status 1, and the outcome "
     "\"time out\" in --report, until it has ended. Then further runs take no step and give the same verdict. Such "
     "work "
     "is one attempt; without --state others may follow one that ends badly",
     set_output, SETS(output[OUTPUT_STATE])},

    {"planar", "[=W]", "all faces are planar", set_must, PLACE(planar), HARD, SHAPES, .build = gproj_add_planarity,
     .section = "what must hold (weight W: 1 if left out)"},
    {"circular", "[=W]", "faces have a circumcircle (with --planar)", set_must, PLACE(circular), HARD, SHAPES,
     .build = gproj_add_circularity},
    {"conical", "[=W]", "the faces around a vertex touch a cone (with --planar)", set_must, PLACE(conical), HARD, SIZES,
     .build = gproj_add_conicality},
    {"equal-lengths", "[=W]", "all edges have the same length", set_must, PLACE(equal_lengths), HARD, SIZES,
     .build_edges = gproj_add_equal_lengths},
    {"midsphere", "[=W]", "the midpoints of all edges are on one sphere", set_must, 0, HARD, SHAPES,
     .build_edges = gproj_add_midsphere},
    {"edge-length", "MIN,MAX[=W]", "edges are at least MIN and at most MAX long; one may be left out", set_range,
     PLACE(edge_length), HARD, SIZES, .add = add_edge_length},
    {"face-area", "MIN,MAX[=W]", "face areas are at least MIN and at most MAX; one may be left out", set_range,
     PLACE(face_area), HARD, SIZES, .add = add_face_area},
    {"total-area", "A", "the area of all faces is A, or xF: F times that of the mesh as the solve begins",
     set_total_area, PLACE(total_area), HARD, SIZES, .add = add_total_area},
    {"cost", "CL,CA,MAX",
     "CL times the length of all edges and CA times the area of all faces cost at most MAX, or xF: F times as much as "
     "when the solve begins",
     set_cost, PLACE(cost), HARD, SIZES, .add = add_cost},
    {"planar-boundary", "[=W]", "each part of the boundary between corners lies in a plane of its own", set_must, 0,
     HARD, SHAPES, .build = gproj_add_planar_boundary, .of_boundary = true},
    {"straight-boundary", "[=W]", "the boundary is straight between its corners", set_must, 0, HARD, SHAPES,
     .build = gproj_add_straight_boundary, .of_boundary = true},
    {"orthogonal-boundary", "[=W]", "inner edges meet the boundary at right angles", set_must, 0, HARD, SHAPES,
     .build = gproj_add_orthogonal_boundary, .of_boundary = true},
    {"lifting", "[=W]", "vertices keep their x and y and move in z only", set_must, 0, HARD, SHAPES,
     .build = gproj_add_lifting},
    {"volume", "V",
     "the enclosed volume (with a boundary: the volume over the plane z = 0) is V, or xF: F times that of the mesh as "
     "the solve begins",
     set_volume, PLACE(volume), HARD, SIZES, .add = add_volume},
    {"free", "WHICH", "vertices that --fix and --glide leave out, free to go anywhere. WHICH: as in --fix",
     set_vertices, SETS(freed), .stage = SIZES, .add = add_loose},
    {"fix", "WHICH[=W]",
     "vertices stay where they are. WHICH: boundary, corners, a list such as 0,7,20-29, or a file of such numbers",
     add_fix, 0, HARD, SIZES, .add = add_fixed, .repeatable = true},
    {"glide", "WHERE[=W]",
     "boundary vertices stay on a curve. WHERE: boundary (each on its own boundary polyline; corners stay), or an OBJ "
     "file with polylines (else its boundary loops are taken)",
     add_glide, 0, HARD, SIZES, .add = add_all_gliding, .repeatable = true},
    {"move", "I,X,Y,Z[=W]",
     "vertex I goes to X,Y,Z: it is dragged there, while what must hold goes on holding (pulled, with --equilibrium or "
     "--plain), and stays. It is then free of --fix and --glide",
     add_move, 0, HARD, SIZES, .add = add_moves, .repeatable = true},

    {"equilibrium", "[=W]", "forces in the edges balance the loads at all vertices without support (z is up)", set_must,
     PLACE(equilibrium), HARD, STATICS, .add = add_equilibrium, .section = "statics"},
    {"compressive", "[=W]", "edges carry compression only", set_must, 0, HARD, STATICS,
     .build_edges = gproj_add_compression, .needs = &statics},
    {"tensile", "[=W]", "edges carry tension only", set_must, 0, HARD, STATICS, .build_edges = gproj_add_tension,
     .needs = &statics},
    {"stress", "MIN,MAX[=W]",
     "axial forces (compression > 0) are at least MIN and at most MAX; one may be left out, 0 is a bound", set_stress,
     0, HARD, STATICS, .add = add_stress, .needs = &statics},
    {"supports", "WHICH",
     "where forces go to the ground: boundary (if left out), corners, a list or a file, as in --fix. This does not "
     "hold them in place: without --fix or --glide of the same vertices they move",
     set_vertices, SETS(supports), .needs = &statics},
    {"density", "R", "each edge weighs R times its length (1 where no load is given)", set_load, SETS(density),
     .needs = &statics},
    {"area-load", "Q", "each face weighs Q times its area", set_load, SETS(area_load), .needs = &statics},
    {"snow", "Q", "each face bears Q times its plan area", set_load, SETS(snow), .needs = &statics},
    {"loads", "FILE", "forces on vertices: CSV with the lines VERTEX,FX,FY,FZ", set_loads_file, SETS(loads),
     .needs = &statics},
    {"start-forces", "FILE",
     "the forces start from those of the edges in this file, as --forces writes it, or W: from W times the length in "
     "all edges",
     set_path, SETS(start_forces), .needs = &statics},
    {"force-fairness", "[=W]", "opposite edges of quads carry equal forces (a wish; W: 1 if left out)", set_wish, 0,
     SOFT, STATICS, .build = gproj_add_force_fairness, .needs = &statics},

    {"reference", "FILE[=W]",
     "stay near the surface of this mesh, or of the one that the work begins with: input (W: 0.1 if left out)",
     set_reference, PLACE(reference), SOFT, WISHES, .add = add_reference,
     .section = "what is wished (W, or W*DECAY:N: weight W*DECAY^n in iteration n up to N, then off; N: 6, with "
                "--equilibrium 9, if left out)"},
    {"closeness", "W",
     "stay near the original places; --closeness 0: the plain projection, whose steps are neither smooth nor guided",
     set_wish, PLACE(closeness), SOFT, WISHES, .build = gproj_add_closeness},
    {"fairness", "W", "smooth polylines of edges", set_wish, 0, SOFT, WISHES, .build = gproj_add_fairness},
    {"boundary-fairness", "W", "smooth boundary", set_wish, 0, SOFT, WISHES, .build = gproj_add_boundary_fairness,
     .of_boundary = true},
    {"tangential", "W", "smooth polylines, as seen along the surface's normals", set_wish, 0, SOFT, WISHES,
     .build = gproj_add_tangential_fairness},
    {"gauss", "W", "smooth Gauss image: face normals change evenly", set_wish, 0, SOFT, WISHES,
     .build = gproj_add_gauss_fairness, .needs = &normals},
    {"parallelograms", "[=W]", "quads are like parallelograms (W: 1 if left out)", set_wish, 0, SOFT, WISHES,
     .build = gproj_add_parallelograms},
    {"equal-areas", "[=W]", "faces have equal areas (W: 1 if left out)", set_wish, PLACE(equal_areas), SOFT, WISHES,
     .build = gproj_add_equal_areas},

    {"nearest", "",
     "end at the nearest mesh that satisfies everything; where something is wished, at the one that serves the wishes "
     "best: they keep their weights W to the end. If none is found on a whole mesh, they only guide, as without it",
     set_flag, SETS(nearest), .section = "how"},
    {"plain", "",
     "steps as gproj_solve takes them without options: not smooth, wishes without N guide for half of the iterations, "
     "and --move pulls without a drag",
     set_flag, SETS(plain)},
    {"iterations", "N",
     "at most so many (300, most take about 10; with --plain 20, with --nearest 60, and up to three times as many "
     "more where none is found)",
     set_iterations, SETS(iterations)},
    {"tolerance", "T", "what must hold holds to this, in mean edge lengths (1e-13)", set_positive, SETS(tolerance)},
    {"epsilon", "E", "constant regularisation of the steps (follows the residual, 1e-5 to 1e-3)", set_positive,
     SETS(epsilon)},
    {"time-limit", "SECONDS", "stop after the iteration that passes this", set_positive, SETS(time_limit)},
    {"allow-spoiled", "",
     "exit status 0 where all holds, though faces turned over, crossed or collapsed, or edges folded, collapsed or "
     "became spikes (1 otherwise: see the sentence)",
     set_flag, SETS(allow_spoiled)},
    {"threads", "N", "work with N threads (1); 0: one per core. The result does not depend on it", set_threads,
     SETS(threads)},

    {"report", "FILE", "JSON: counts, every iteration, verdict, measures, seconds", set_output,
     SETS(output[OUTPUT_REPORT]), .section = "out"},
    {"forces", "FILE",
     "CSV: lines edge,I,J,W with the force W(v_I - v_J) on I (W > 0: compression), load,I,FX,FY,FZ and "
     "support,I,RX,RY,RZ with the reaction",
     set_output, SETS(output[OUTPUT_FORCES]), .needs = &statics},
    {"residuals", "FILE",
     "CSV: group,place,element,residual, what each vertex, edge and face lacks (mean edge lengths)", set_output,
     SETS(output[OUTPUT_RESIDUALS])},
    {"picture", "FILE",
     "SVG: the result, its faces in the colours of --colour; with --equilibrium also forces as widths of edges "
     "(compression blue, tension orange), and without --planar coloured by how far the faces are from standing by "
     "themselves",
     set_output, SETS(output[OUTPUT_PICTURE])},
    {"view", "VIEW",
     "of the picture: iso, top, bottom, front, back, left, right (or side), or AZIMUTH,ELEVATION in degrees (-58,32)",
     set_view, SETS(view), .needs = &a_picture},
    {"colour", "WHAT", "of the faces in the picture, by planarity, area, parallelogram or bend", set_colour,
     SETS(colour), .needs = &a_picture},
    {"title", "TEXT", "of the picture (the name of the output)", set_text, SETS(title), .needs = &a_picture},
    {"offset", "DISTANCE,FILE",
     "the parallel mesh at this distance, in a format as the output's: of the vertices with --circular alone, else of "
     "the faces "
     "(exact with --conical)",
     set_offset, SETS(output[OUTPUT_OFFSET])},
    {"support", "FILE", "the panels between the mesh and its --offset, in a format as the output's: one quad an edge",
     set_output, SETS(output[OUTPUT_SUPPORT]), .needs = &an_offset},
    {"panels", "FILE",
     "the faces laid flat at true size on sheets, to be cut, .svg or .dxf (R12), in millimetres: each with its "
     "number and, along the edges, the neighbours' numbers and dihedral angles, measured behind (below 180 degrees"
     " a ridge, above a valley). With --support also its panels (S and the edge's number). Refused, by name, where"
     " a panel is not planar to 1e-6 of half its perimeter",
     set_output, SETS(output[OUTPUT_PANELS])},
    {"panel-list", "FILE", "CSV: the panels' areas and sizes, their edges' lengths and dihedral angles", set_output,
     SETS(output[OUTPUT_PANEL_LIST]), .needs = &panels},
    {"sheet", "W,H[,GAP]",
     "of the panels: width and height in mm, and the gap between panels and at the border (a twentieth of the mean"
     " edge). If left out, one sheet holds all",
     set_sheet, SETS(sheet), .needs = &panels},
    {"panel-scale", "S", "millimetres that a unit of the mesh is (1; 1000 for a mesh in metres)", set_panel_scale,
     SETS(sheet.scale), .needs = &panels},
    {"quiet", "", "print errors only", set_flag, SETS(quiet)},
    {"help", "", "print this", set_flag, SETS(help), .letter = 'h'},
    {"version", "", "print the version", set_flag, SETS(version)},
};

enum {
    OPTION_COUNT = (int)(sizeof options / sizeof options[0])
};

typedef char tool_has_room_for_options[(int)OPTION_COUNT <= (int)MOST_OPTIONS ? 1 : -1];

/* Points to the member of the tool that this row sets. */
static void *place_of(tool *t, int row) {
    return options[row].place ? (void *)((char *)t + options[row].place) : &t->own[row];
}

/* Finds out whether the option with this member of the tool is on the command line. */
static bool is_given(const tool *t, size_t place) {
    int i;
    for (i = 0; i < OPTION_COUNT; ++i)
        if (t->seen[i] && options[i].place == place) return true;
    return false;
}

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
    puts("usage: guidedproj INPUT.{obj,off,stl,ply} -o OUTPUT.{obj,off,stl,ply} OPTIONS\n\n"
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
         "  of memory. After 2, 3 and 4 no output is touched, unless only printing failed\n"
         "  (3). With --nearest 0 does not say that a minimum was reached: the sentence\n"
         "  and the report do.");
}

/* ---- the command line ---- */

/* Finds the option that a mistyped name means; -1: none is like it. */
static int similar_option(const char *name, size_t size) {
    int i, best = -1, least = size < 5 ? 2 : 3; /* two edits, in a short name one, make a typing error */
    for (i = 0; i < OPTION_COUNT; ++i) {
        const char *known = options[i].name;
        int distance = edit_distance(name, size, known);
        if (size >= 3 && strncmp(name, known, size) == 0) distance = 1;              /* cut short */
        if (size >= 5 && strncmp(name, known, 4) == 0 && distance > 2) distance = 2; /* another ending */
        if (distance < least) best = i, least = distance;
    }
    return best;
}

/* Finds the row of an option; -1: there is none of this name. */
static int find_option(const char *name) {
    int i = 0;
    while (i < OPTION_COUNT && strcmp(options[i].name, name) != 0) ++i;
    return i < OPTION_COUNT ? i : -1;
}

/* `word` is the whole argument, `name` the option in it. */
static bool fail_unknown(tool *t, const char *word, const char *name, size_t size) {
    int best = similar_option(name, size);
    if (best < 0)
        return fail(t, EXIT_USAGE, "there is no option %.*s; --help lists them", (int)(name + size - word), word);
    return fail(t, EXIT_USAGE, "there is no option %.*s; did you mean --%s?", (int)(name + size - word), word,
                options[best].name);
}

/* Tells whether the solve depends on the option in a row: not outputs, nor when it stops. */
static bool is_for_the_solve(int row) {
    const tool_option *option = &options[row];
    if (option->read == set_output) return false;
    return option->kind != SETTING || option->needs == &statics || option->needs == &a_curve ||
           option->place == PLACE(weld) || option->place == PLACE(freed) || option->place == PLACE(nearest) ||
           option->place == PLACE(plain) || option->place == PLACE(tolerance) || option->place == PLACE(epsilon);
}

/* Notes an option on which the solve depends, as it was given. */
static bool ask(tool *t, const tool_option *option, const char *value) {
    size_t size = strlen(option->name) + (value ? strlen(value) : 0) + 4;
    const char *between = option->value[0] == '[' ? "=" : " ";
    char *text = (char *)take(t, size, 1);
    bool good;
    if (!text) return false;
    snprintf(text, size, "--%s%s%s", option->name, value ? between : "", value ? value : "");
    good = gprojx_asked_add(&t->asked, text, NULL) || fail_memory(t);
    free(text);
    return good;
}

/* Keeps the value (NULL: none) of the option in a row, and sets what it means. */
static bool give(tool *t, int row, const char *value) {
    const tool_option *option = &options[row];
    if (is_for_the_solve(row) && !ask(t, option, value)) return false;
    t->seen[row] = true;
    t->line_of[row] = t->line;
    t->word[t->word_count].row = row;
    t->word[t->word_count++].value = value;
    return option->read(t, place_of(t, row), option->name, value);
}

/* Reads the option at argv[*i], and the value behind it. */
static bool read_option(tool *t, int argc, char **argv, int *i) {
    const char *word = argv[*i], *name = word + (word[1] == '-' ? 2 : 1), *equals = strchr(name, '=');
    size_t size = equals ? (size_t)(equals - name) : strlen(name);
    const tool_option *option = NULL;
    const char *value = equals ? equals + 1 : NULL;
    int k;
    /* A word after --, which may be followed by =VALUE, or one letter after -. */
    for (k = 0; k < OPTION_COUNT; ++k)
        if (word[1] == '-' ? same_word(name, size, options[k].name) : size == 1 && options[k].letter == name[0])
            option = &options[k];
    if (!option) return fail_unknown(t, word, name, size);
    if (t->seen[option - options] && !option->repeatable)
        return fail(t, EXIT_USAGE, "--%s is given twice", option->name);
    if (value && !option->value[0]) return fail(t, EXIT_USAGE, "--%s takes no value", option->name);
    if (!value && option->value[0] && option->value[0] != '[') {
        if (*i + 1 >= argc || strncmp(argv[*i + 1], "--", 2) == 0)
            return fail(t, EXIT_USAGE, "--%s needs a value: --%s %s", option->name, option->name, option->value);
        value = argv[++*i];
    }
    return give(t, (int)(option - options), value);
}

static bool read_input_name(tool *t, const char *word, const char *before) {
    double number;
    if (!word[0]) return fail(t, EXIT_USAGE, "the input's name is empty");
    if (gprojx_read_number(word, strlen(word), &number) && before && strncmp(before, "--", 2) == 0)
        return fail(t, EXIT_USAGE, "'%s' stands alone; a weight is written %s=%s", word, before, word);
    if (t->input) return fail(t, EXIT_USAGE, "there are two inputs, '%s' and '%s'; one is needed", t->input, word);
    if (strcmp(word, "-") == 0) return fail(t, EXIT_USAGE, "the input must be a file; there is no reading from a pipe");
    t->input = word;
    return true;
}

/* Finds out whether there is something to do; --closeness 0 alone asks for nothing. */
static bool anything_asked(const tool *t) {
    int i;
    for (i = 0; i < GPROJX_SECTION_COUNT; ++i)
        if (gprojx_sections[i].build && problem_section(t, gprojx_sections[i].key)) return true;
    for (i = 0; i < OPTION_COUNT; ++i)
        if (t->seen[i] && options[i].kind != SETTING &&
            (options[i].place != PLACE(closeness) || t->closeness.weight > 0))
            return true;
    return false;
}

static bool anything_wished(tool *t) {
    const gprojx_value *rows = problem_section(t, "rows"), *item, *kind;
    int i;
    for (item = rows ? gprojx_inside(rows) : NULL; item; item = gprojx_after(&t->problem, item)) {
        kind = gprojx_member(&t->problem, item, "kind");
        if (kind && gprojx_find_kind(kind->text) == GPROJ_WISH) return true;
    }
    for (i = 0; i < OPTION_COUNT; ++i)
        if (t->seen[i] && options[i].kind == SOFT && ((tool_demand *)place_of(t, i))->weight > 0) return true;
    return false;
}

/* Refuses options that mean nothing without another one. */
static bool check_needs(tool *t) {
    int i;
    for (i = 0; i < OPTION_COUNT; ++i) {
        t->line = t->line_of[i];
        if (t->seen[i] && options[i].needs &&
            (!is_given(t, options[i].needs->place) || (options[i].needs == &normals && !(t->planar.weight > 0))))
            return fail(t, EXIT_USAGE, "--%s %s", options[i].name, options[i].needs->why);
    }
    t->line = 0;
    return true;
}

/* Refuses the name of an output that does not end like its formats, or is none of a file. */
static bool check_output(tool *t, int output, const char *option) {
    static const struct {
        const char *what, *endings; /* each of 4 letters; NULL: any */
    } rules[OUTPUT_COUNT] = {[OUTPUT_MESH] = {"output", ".obj, .off, .stl or .ply"},
                             [OUTPUT_OFFSET] = {"output", ".obj, .off, .stl or .ply"},
                             [OUTPUT_SUPPORT] = {"output", ".obj, .off, .stl or .ply"},
                             [OUTPUT_PICTURE] = {"picture", ".svg"},
                             [OUTPUT_PANELS] = {"panels", ".svg or .dxf"},
                             [OUTPUT_PANEL_LIST] = {"list of panels", ".csv"}};
    const char *path = t->output[output].path, *at = rules[output].endings;
    char ending[5] = "";
    if (!at) return strcmp(path, "-") != 0 || fail(t, EXIT_USAGE, "--%s writes to a file: give its name", option);
    for (at = strchr(at, '.'); at; at = strchr(at + 1, '.')) {
        memcpy(ending, at, 4);
        if (gprojx_has_ending(path, ending)) break;
    }
    if (!at) return fail(t, EXIT_USAGE, "the %s '%s' must end in %s", rules[output].what, path, rules[output].endings);
    return t->encoding != GPROJX_BIG || strcmp(ending, ".stl") != 0 ||
           fail(t, EXIT_USAGE, "--encoding big is not for STL: '%s'", path);
}

static bool check_outputs(tool *t) {
    int i, k;
    for (i = 0; i < OPTION_COUNT; ++i)
        for (k = 0; k < OUTPUT_COUNT; ++k) {
            t->line = t->line_of[i];
            if (t->seen[i] && place_of(t, i) == &t->output[k] && !check_output(t, k, options[i].name)) return false;
        }
    t->line = 0;
    return true;
}

static bool is_foreign(const tool *t, int output) {
    return t->output[output].path && format_named(t->output[output].path) != GPROJX_NEITHER;
}

/* Refuses handles on levels that there are not. */
static bool check_levels(tool *t, const char *section) {
    const gprojx_value *array = problem_section(t, section), *item, *level;
    for (item = array ? gprojx_inside(array) : NULL; item; item = gprojx_after(&t->problem, item)) {
        level = gprojx_member(&t->problem, item, "level");
        t->line = item->line;
        if (level && level->number > t->subdivision.levels)
            return fail(t, EXIT_REFUSED, "\"%s\": there is no level %s; the last is %ld", section, level->text,
                        (long)t->subdivision.levels);
    }
    t->line = 0;
    return true;
}

/* Refuses sections of the problem that mean nothing without an option. */
static bool check_sections(tool *t) {
    static const struct {
        const char *section, *option;
    } needs[] = {{"densities", "equilibrium"}, {"sections", "stress"}, {"handles", "subdivide"}};
    const gprojx_value *array;
    size_t k;
    for (k = 0; k < sizeof needs / sizeof needs[0]; ++k) {
        array = problem_section(t, needs[k].section);
        t->line = array ? array->line : 0;
        if (array && !t->seen[find_option(needs[k].option)])
            return fail(t, EXIT_REFUSED, "\"%s\" needs the key \"%s\"", needs[k].section, needs[k].option);
    }
    array = t->output[OUTPUT_STATE].path ? problem_section(t, "pulls") : NULL;
    t->line = array ? array->line : 0;
    if (array) return fail(t, EXIT_REFUSED, "\"pulls\" come after the solve that --state keeps: leave out one of them");
    return check_levels(t, "handles") && check_levels(t, "pulls");
}

/* Refuses words that JSON cannot keep. */
static bool check_written_problem(tool *t) {
    int32_t i;
    for (i = -1; t->output[OUTPUT_PROBLEM].path && i < t->word_count; ++i) {
        const char *text = i < 0 ? t->input : t->word[i].value;
        for (; text && *text; text += gprojx_utf8_size(text))
            if (gprojx_utf8_size(text) == 0)
                return fail(t, EXIT_USAGE, "--write-problem: '%s' is not UTF-8", i < 0 ? t->input : t->word[i].value);
    }
    return true;
}

/* Lets the sentence that follows name the line of the option with this member of the tool. */
static void blame(tool *t, size_t place) {
    int i;
    for (i = 0; i < OPTION_COUNT; ++i)
        if (options[i].place == place) t->line = t->line_of[i];
}

static bool check_options(tool *t) {
    int32_t usual = t->nearest ? 60 : t->plain ? 20 : 300;
    if (t->output[OUTPUT_STATE].path) { /* the solve has the usual limit, of which this run takes a part */
        t->part = t->iterations;
        t->iterations = t->part > usual ? t->part : usual;
    }
    if (t->iterations == 0) t->iterations = usual;
    if (t->fill && t->input)
        return fail(t, EXIT_USAGE, "there are an input, '%s', and --fill %s; one is needed", t->input, t->fill);
    if (t->fill && t->welds)
        return blame(t, PLACE(weld)), fail(t, EXIT_USAGE, "--weld is for an input; what --fill makes has no seams");
    if (t->fill) t->input = t->fill;
    if (!t->input) return fail(t, EXIT_USAGE, "no input is given: guidedproj INPUT.obj -o OUTPUT.obj --planar");
    if (!t->output[OUTPUT_MESH].path) return fail(t, EXIT_USAGE, "no output is given: add -o OUTPUT.obj");
    if (!anything_asked(t))
        return fail(t, EXIT_USAGE,
                    "nothing is asked for: add what must hold (such as --planar) or what is wished (such as "
                    "--fairness 0.2)");
    if (!check_needs(t) || !check_sections(t) || !check_written_problem(t) || !check_outputs(t)) return false;
    if (is_given(t, PLACE(encoding)) && !is_foreign(t, OUTPUT_MESH) && !is_foreign(t, OUTPUT_OFFSET) &&
        !is_foreign(t, OUTPUT_SUPPORT))
        return blame(t, PLACE(encoding)), fail(t, EXIT_USAGE, "--encoding is for outputs that end in .stl or .ply");
    if (t->conical.weight > 0 && !(t->planar.weight > 0))
        return blame(t, PLACE(conical)),
               fail(t, EXIT_USAGE, "--conical needs the normals of planar faces: add --planar");
    if (t->circular.weight > 0 && !(t->planar.weight > 0))
        return blame(t, PLACE(circular)),
               fail(t, EXIT_USAGE, "--circular is for planar faces, others would only be on spheres: add --planar");
    if (t->nearest && t->closeness.given && t->closeness.weight <= 0 && !anything_wished(t))
        return blame(t, PLACE(closeness)),
               fail(t, EXIT_USAGE, "--nearest has nothing to be near to: leave out --closeness 0, or wish something");
    return true;
}

/* ---- the problem file ---- */

/* Reads the value of an option's key: a string or a number as the option's value, true for none. */
static bool give_value(tool *t, int row, const gprojx_value *v) {
    const char *syntax = options[row].value;
    bool without = syntax[0] == 0 || syntax[0] == '[';
    t->line = v->line;
    if (v->kind == GPROJX_JSON_LITERAL && v->text[0] == 't' && without) return give(t, row, NULL);
    if ((v->kind == GPROJX_JSON_STRING || v->kind == GPROJX_JSON_NUMBER) && syntax[0]) return give(t, row, v->text);
    if (syntax[0] == '[') /* [=W] */
        return fail(t, EXIT_REFUSED, "\"%s\": expected true, or a string or number %.*s", options[row].name,
                    (int)strlen(syntax) - 3, syntax + 2);
    return fail(t, EXIT_REFUSED, "\"%s\": expected %s%s", options[row].name, without ? "true" : "a string or number ",
                syntax);
}

/* Reads a key that is an option's name; the command line takes the place of it. */
static bool read_key(tool *t, int row, const gprojx_value *v) {
    const gprojx_value *inside;
    if (t->seen[row]) return true;
    if (v->kind != GPROJX_JSON_ARRAY || !options[row].repeatable) return give_value(t, row, v);
    for (inside = gprojx_inside(v); inside; inside = gprojx_after(&t->problem, inside))
        if (!give_value(t, row, inside)) return false;
    return true;
}

/* Makes room for the words of the problem behind those of the command line. */
static bool grow_words(tool *t, size_t room) {
    const gprojx_value *v;
    void *fix, *glide, *move, *group, *word;
    for (v = gprojx_inside(t->problem.value); v; v = gprojx_after(&t->problem, v)) {
        int row = find_option(v->key);
        bool repeats = row >= 0 && options[row].repeatable && v->kind == GPROJX_JSON_ARRAY;
        t->line = v->line;
        if (repeats && v->count > MOST_REPEATS)
            return fail(t, EXIT_REFUSED, "\"%s\" has more than %d values", v->key, (int)MOST_REPEATS);
        room += 1 + (repeats ? (size_t)v->count : 0);
    }
    if ((fix = realloc(t->fix, room * sizeof *t->fix))) t->fix = (tool_demand *)fix;
    if ((glide = realloc(t->glide, room * sizeof *t->glide))) t->glide = (tool_demand *)glide;
    if ((move = realloc(t->move, room * sizeof *t->move))) t->move = (tool_move *)move;
    if ((group = realloc(t->move_group, room * sizeof *t->move_group))) t->move_group = (int32_t *)group;
    if ((word = realloc(t->word, room * sizeof *t->word))) t->word = (tool_word *)word;
    return (fix && glide && move && group && word) || fail_memory(t);
}

static gproj_mesh *load_for_problem(void *user, const char *path, int32_t line) {
    tool *t = (tool *)user;
    gproj_mesh *mesh;
    t->line = line;
    mesh = load(t, path, strlen(path), NULL);
    t->line = 0;
    return mesh;
}

/* Tells whether the option in a row is for the command line alone. */
static bool is_for_command_line(int row) {
    size_t place = options[row].place;
    return place == PLACE(problem_path) || place == PLACE(output[OUTPUT_PROBLEM]) || place == PLACE(help) ||
           place == PLACE(version);
}

static bool read_problem_key(tool *t, const gprojx_value *v) {
    const struct gprojx_section *section = gprojx_find_section(v->key);
    gproj_error error;
    int row = find_option(v->key), similar;
    t->line = v->line;
    if (section) {
        t->line = 0; /* the sentence has one */
        return gprojx_check_section(&t->problem, section, v, &error) || fail_problem(t, &error);
    }
    if (strcmp(v->key, "input") == 0) {
        if (v->kind != GPROJX_JSON_STRING) return fail(t, EXIT_REFUSED, "\"input\": expected the path of a mesh");
        return t->input || read_input_name(t, v->text, NULL);
    }
    if (row >= 0 && !is_for_command_line(row)) return read_key(t, row, v);
    similar = row < 0 ? similar_option(v->key, strlen(v->key)) : -1;
    return fail(t, EXIT_REFUSED, "there is no key \"%.60s\"%s%s%s", v->key, similar < 0 ? "" : "; did you mean \"",
                similar < 0 ? "" : options[similar].name, similar < 0 ? "" : "\"?");
}

static void write_sections(const tool *t, gprojx_json *j) {
    int i;
    for (i = 0; i < GPROJX_SECTION_COUNT; ++i) {
        const gprojx_value *section = problem_section(t, gprojx_sections[i].key);
        if (section) gprojx_problem_write_value(j, &t->problem, section);
    }
}

/* Notes the sections of the problem, on which the solve depends, wherever they stand in the file. */
static bool ask_sections(tool *t) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    gprojx_json j = {file, 0, false, false};
    bool good;
    if (!file) return fail_memory(t);
    write_sections(t, &j);
    good = !ferror(file);
    good = fclose(file) == 0 && good;
    good = good && (size == 0 || gprojx_asked_add_file(&t->asked, t->problem_path, text, size));
    free(text);
    return good || fail_memory(t);
}

/* Reads the file of --problem. room: words that the command line has at most. */
static bool read_problem(tool *t, size_t room) {
    const gprojx_value *v;
    gproj_error error;
    size_t length;
    char *text = gprojx_load_file(t->problem_path, gprojx_any_text, t->file_limit, &length, &error);
    if (!text) return fail_file(t, t->problem_path, &error);
    t->problem.host = &t->host, t->problem.load = load_for_problem, t->problem.user = t;
    if (!gprojx_problem_parse(&t->problem, text, length, &error)) return fail_problem(t, &error);
    if (!grow_words(t, room)) return false;
    for (v = gprojx_inside(t->problem.value); v; v = gprojx_after(&t->problem, v))
        if (!read_problem_key(t, v)) return false;
    t->line = 0;
    return ask_sections(t);
}

/* Writes the words of an option as the value of its key. */
static void write_key(const tool *t, gprojx_json *j, int row) {
    int32_t i;
    bool repeatable = options[row].repeatable;
    if (repeatable) gprojx_json_open(j, options[row].name, '[');
    for (i = 0; i < t->word_count; ++i) {
        if (t->word[i].row != row) continue;
        if (t->word[i].value)
            gprojx_json_string(j, repeatable ? NULL : options[row].name, t->word[i].value);
        else
            gprojx_json_next(j, options[row].name), fputs("true", j->file);
    }
    if (repeatable) gprojx_json_close(j, ']');
}

static gproj_code write_problem(tool *t, FILE *file) {
    gprojx_json j = {file, 0, false, false};
    int i;
    gprojx_json_open(&j, NULL, '{');
    if (!t->fill) gprojx_json_string(&j, "input", t->input);
    for (i = 0; i < OPTION_COUNT; ++i)
        if (t->seen[i] && !is_for_command_line(i)) write_key(t, &j, i);
    write_sections(t, &j);
    gprojx_json_close(&j, '}');
    fputc('\n', file);
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

static bool read_command_line(tool *t, int argc, char **argv) {
    bool plain = false; /* after "--" */
    size_t room = (size_t)argc + 1;
    int i;
    t->fix = (tool_demand *)take(t, room, sizeof *t->fix);
    t->glide = (tool_demand *)take(t, room, sizeof *t->glide);
    t->move = (tool_move *)take(t, room, sizeof *t->move);
    t->move_group = (int32_t *)take(t, room, sizeof *t->move_group);
    t->word = (tool_word *)take(t, room, sizeof *t->word);
    if (!t->fix || !t->glide || !t->move || !t->move_group || !t->word) return false;
    for (i = 1; i < argc && !t->help && !t->version; ++i) {
        if (!plain && strcmp(argv[i], "--") == 0)
            plain = true;
        else if (!plain && argv[i][0] == '-' && argv[i][1]) {
            if (!read_option(t, argc, argv, &i)) return false;
        } else if (!read_input_name(t, argv[i], i > 1 && !plain ? argv[i - 1] : NULL))
            return false;
    }
    if (t->help || t->version) return true;
    return (!t->problem_path || read_problem(t, room)) && check_options(t);
}

/* ---- the form ---- */

/* Schedules a wish: --nearest keeps it on, --plain leaves its end to the library; else it ends after a few iterations,
   at most half of all. */
static void schedule_wish(tool *t, const tool_demand *demand, int32_t group) {
    gproj_schedule schedule;
    schedule.weight = demand->weight;
    schedule.decay = demand->decay;
    schedule.last = demand->last > 0 ? demand->last : t->plain ? GPROJ_LAST_GUIDING : t->equilibrium.weight > 0 ? 9 : 6;
    if (demand->last == 0 && schedule.last > t->iterations / 2)
        schedule.last = t->iterations > 1 ? t->iterations / 2 : 1;
    gproj_set_schedule(t->form, group, t->nearest ? gproj_keep(demand->weight) : schedule);
}

/* Adds what the option of this row asks for. */
static bool add_option(tool *t, int row) {
    const tool_option *option = &options[row];
    const tool_demand *demand = (const tool_demand *)place_of(t, row);
    int32_t group = -1;
    if (!option->add && demand->weight > 0 && t->mesh->loop_count == 0 && option->of_boundary)
        return fail(t, EXIT_USAGE, "--%s: the mesh is closed and has no boundary", option->name);
    if (option->add)
        group = option->add(t, demand);
    else if (demand->weight > 0)
        group = option->build ? option->build(t->form, demand->weight)
                              : option->build_edges(t->form, t->mesh->edge_count, NULL, demand->weight);
    t->group_of[row] = group;
    if (option->kind == SOFT && group >= 0) schedule_wish(t, demand, group);
    return t->exit_code == 0;
}

/* Tells whether a line of a file of --forces is about something other than an edge. */
static bool is_beside_edges(const char *line, size_t size) {
    static const char *const words[] = {"kind,", "load,", "support,", "#"};
    size_t i;
    for (i = 0; i < sizeof words / sizeof words[0]; ++i)
        if (strncmp(line, words[i], strlen(words[i])) == 0) return true;
    return strspn(line, " \t") >= size;
}

/* Reads the lines edge,I,J,W of a file of --forces; edges that it does not name keep their number. */
static bool read_forces(tool *t, const char *text, double *density) {
    const char *line = text;
    long number = 1, found = 0;
    for (; *line; ++number) {
        size_t size = strcspn(line, "\r\n");
        double field[3];
        int32_t edge = -1;
        if (strncmp(line, "edge,", 5) == 0) {
            bool good = gprojx_read_fields(line + 5, size - 5, 3, field);
            if (!good) return fail(t, EXIT_REFUSED, "%s:%ld: expected edge,I,J,W", t->start_forces, number);
            if (gprojx_is_vertex(t->mesh, field[0]) && gprojx_is_vertex(t->mesh, field[1]))
                edge = gprojx_edge_between(t->mesh, (int32_t)field[0], (int32_t)field[1]);
            if (edge < 0)
                return fail(t, EXIT_REFUSED, "%s:%ld: there is no edge between the vertices %g and %g", t->start_forces,
                            number, field[0], field[1]);
            density[edge] = field[2];
            ++found;
        } else if (!is_beside_edges(line, size))
            return fail(t, EXIT_REFUSED, "%s:%ld: expected edge,I,J,W, or a line load,... or support,...",
                        t->start_forces, number);
        line += strcspn(line, "\n");
        line += *line != 0;
    }
    return found > 0 || fail(t, EXIT_REFUSED, "%s: no line edge,I,J,W", t->start_forces);
}

/* Lets the forces start from the number of --start-forces, or from those in this file; edges that it does not name have
   none. */
static bool start_from_forces(tool *t) {
    double *density = (double *)take(t, (size_t)t->mesh->edge_count, sizeof *density), all;
    bool same = gprojx_read_number(t->start_forces, strlen(t->start_forces), &all), good = density != NULL;
    char *text = same ? NULL : load_text(t, t->start_forces);
    gproj_error error;
    int32_t e;
    for (e = 0; good && same && e < t->mesh->edge_count; ++e) density[e] = all;
    if (good && !same) good = text && read_forces(t, text, density);
    if (good && gproj_set_forces(t->form, density, &error) != GPROJ_OK) fail_library(t, t->start_forces, &error);
    free(text), free(density);
    return t->exit_code == 0;
}

/* Sets the weights by element that the problem gives to options. */
static bool set_weights(tool *t) {
    const gprojx_value *array = problem_section(t, "weights"), *item;
    gproj_error error;
    for (item = array ? gprojx_inside(array) : NULL; item; item = gprojx_after(&t->problem, item)) {
        const char *of = gprojx_member(&t->problem, item, "of")->text;
        int row = find_option(of);
        t->line = item->line;
        if (row < 0 || !t->seen[row])
            return fail(t, EXIT_REFUSED, "\"weights\" of \"%.60s\": the problem has no such key", of);
        t->line = 0;
        if (!gprojx_problem_weigh(&t->problem, item, t->group_of[row], &error)) return fail_problem(t, &error);
    }
    return true;
}

/* Adds the options that were given, stage by stage in the order of the table, whatever theirs on the command line; then
   the sections of the problem. */
static bool build_form(tool *t) {
    gproj_error error;
    int stage, i;
    t->form = gproj_form_create(t->mesh, &t->host);
    if (!t->form) return fail_memory(t);
    for (i = 0; i < OPTION_COUNT; ++i) t->group_of[i] = -1;
    if (t->problem_path && !gprojx_problem_begin(&t->problem, t->mesh, t->form, &error)) return fail_problem(t, &error);
    for (stage = NO_STAGE + 1; stage < STAGE_COUNT; ++stage)
        for (i = 0; i < OPTION_COUNT; ++i) {
            t->line = t->line_of[i];
            if (t->seen[i] && (int)options[i].stage == stage && !add_option(t, i)) return false;
        }
    t->line = 0;
    if (t->loose && !check_loose(t)) return false;
    if (gproj_form_error(t->form)->code != GPROJ_OK) return fail_library(t, NULL, gproj_form_error(t->form));
    if (t->problem_path && !gprojx_problem_build(&t->problem, &error)) return fail_problem(t, &error);
    return set_weights(t) && (!t->start_forces || start_from_forces(t));
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
        bool later = iteration->number > t->iterations; /* attempts after --nearest, with three times as many */
        int64_t limit = (int64_t)t->iterations * (later ? 4 : 1);
        int full = (int)(WIDTH * iteration->number / limit);
        fputs("\r[", stderr);
        for (i = 0; i < WIDTH; ++i) fputc(i < full ? '#' : '.', stderr);
        fprintf(stderr, "] %ld/%ld  residual %.1e ", (long)iteration->number, (long)limit, iteration->residual);
        t->bar = true;
    } else
        fprintf(stderr, "iteration %ld: residual %.2e, step %.2e, energy %.2e, %.1f ms\n", (long)iteration->number,
                iteration->residual, iteration->step, iteration->energy, 1e3 * seconds);
    fflush(stderr);
}

static bool on_iteration(void *user, gproj_system *system, const gproj_iteration *iteration) {
    tool *t = (tool *)user;
    show_progress(t, iteration);
    if (!t->history.probe) return true;
    return gprojx_history_keep(&t->history, t->form, system, iteration) || fail_memory(t);
}

/* Measures the load that the best forces leave unbalanced, as a mean over the corners of each face. */
static bool measure_imbalance(tool *t, double *of_faces) {
    const gproj_mesh *mesh = t->mesh;
    double *residual = (double *)take(t, (size_t)mesh->vertex_count, sizeof *residual);
    gproj_error error = {GPROJ_OK};
    int32_t f, k;
    bool good = residual && gproj_find_forces(t->form, NULL, residual, &error) == GPROJ_OK;
    for (f = 0; good && f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        of_faces[f] = 0;
        for (k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h])
            of_faces[f] += residual[mesh->origin[h]] / mesh->face_degree[f];
    }
    free(residual);
    return good || t->exit_code != 0 || fail_library(t, NULL, &error);
}

static bool measure_forces(tool *t) {
    const gproj_mesh *mesh = t->mesh;
    gproj_error error;
    int32_t e, k;
    t->density_of_edge = (double *)take(t, (size_t)mesh->edge_count, sizeof *t->density_of_edge);
    t->force_in_edge = (double *)take(t, (size_t)mesh->edge_count, sizeof *t->force_in_edge);
    t->imbalance = (double *)take(t, (size_t)mesh->face_count, sizeof *t->imbalance);
    if (!t->density_of_edge || !t->force_in_edge || !t->imbalance) return false;
    if (gproj_get_forces(t->form, t->density_of_edge, &error)) return fail_library(t, NULL, &error);
    for (e = 0; e < mesh->edge_count; ++e) {
        const double *a = mesh->position + 3 * (size_t)mesh->origin[2 * e],
                     *b = mesh->position + 3 * (size_t)mesh->origin[2 * e + 1];
        double square = 0;
        for (k = 0; k < 3; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
        t->force_in_edge[e] = t->density_of_edge[e] * sqrt(square);
    }
    t->forces = gproj_measure_forces(t->form, &error);
    if (error.code) return fail_library(t, NULL, &error);
    if (t->imbalance_before && !measure_imbalance(t, t->imbalance)) return false;
    return gproj_form_error(t->form)->code == GPROJ_OK || fail_library(t, NULL, gproj_form_error(t->form));
}

/* Tells whether all constraints hold; sentence and report tell how near a nearest mesh came to a minimum, or that time ran
   out while wishes guided. With --state it is to go on then. */
static bool is_exact(const tool *t) {
    bool enough = t->nearest || (t->result.outcome == GPROJ_TIME_OUT && !t->output[OUTPUT_STATE].path);
    return t->result.outcome == GPROJ_CONVERGED ||
           (enough && t->result.worst_group >= 0 && t->result.residual <= t->result.tolerance);
}

/* Switches the targets of --move off or on. */
static void switch_moves(tool *t, bool on) {
    int32_t i;
    for (i = 0; i < t->move_count; ++i) {
        double weight = on ? t->move[i].weight : 0;
        if (t->move_group[i] >= 0) gproj_set_schedule(t->form, t->move_group[i], gproj_keep(weight));
    }
}

/* Drags the handles to their positions, and releases them: the result is that of the release. */
static bool drag_to(tool *t, const gproj_handles *handles, const double *position) {
    gproj_error error;
    gproj_drag *work = gproj_drag_begin(t->form, handles, NULL, &error);
    if (!work) return fail_library(t, NULL, &error);
    if (gproj_drag_move(work, position) != GPROJ_OK) {
        fail_library(t, NULL, gproj_drag_error(work));
        gproj_drag_cancel(work);
        return false;
    }
    t->result = gproj_drag_end(work);
    return t->result.outcome != GPROJ_FAILED || fail_library(t, NULL, gproj_form_error(t->form));
}

/* Is there a --move with a weight? */
static bool moves_anything(const tool *t) {
    int32_t i = 0;
    while (i < t->move_count && !(t->move[i].weight > 0)) ++i;
    return i < t->move_count;
}

/* Drags the moved vertices to their places, an edge at a time, with a release each. Forces have no tangent space before
   their first solve: with --equilibrium vertices are not dragged. What the time does not reach is left to the solve. */
static bool drag(tool *t, double begin) {
    int32_t *vertex = (int32_t *)take(t, (size_t)t->move_count, sizeof *vertex), i, k, count;
    gproj_handles handles = {.vertex = vertex};
    double *position = (double *)take(t, 3 * (size_t)t->move_count, sizeof *position), farthest = 0;
    const tool_move **which = (const tool_move **)take(t, (size_t)t->move_count, sizeof *which);
    bool good = vertex && position && which;
    for (i = 0; good && i < t->move_count; ++i) {
        const tool_move *move = &t->move[i];
        const double *p = t->original + 3 * (size_t)move->vertex;
        if (!(move->weight > 0)) continue;
        which[handles.count] = move;
        vertex[handles.count++] = move->vertex;
        farthest =
            fmax(farthest, hypot(hypot(move->position[0] - p[0], move->position[1] - p[1]), move->position[2] - p[2]));
    }
    count = (int32_t)fmin(MOST_DRAGS, ceil(farthest / t->before.mean_edge));
    /* Targets would pull at the vertices that the drag leads; they act again in the solve. */
    switch_moves(t, false);
    for (i = 1; good && i <= count && (t->time_limit <= 0 || now(NULL) - begin < t->time_limit); ++i) {
        for (k = 0; k < 3 * handles.count; ++k) {
            const tool_move *move = which[k / 3];
            double from = t->original[3 * (size_t)move->vertex + (size_t)(k % 3)];
            position[k] = from + (double)i / count * (move->position[k % 3] - from);
        }
        good = drag_to(t, &handles, position);
    }
    switch_moves(t, true);
    free(vertex), free(position), free(which);
    return good;
}

/* Drags vertices of the mesh or of its cage after the solve, one after the other, with a release each, as long as
   all holds. */
static bool pull(tool *t) {
    static const double here[3] = {0, 0, 0}; /* so that a place is a displacement */
    const gprojx_value *array = problem_section(t, "pulls"), *item;
    tool_hold hold;
    for (item = array ? gprojx_inside(array) : NULL; item && is_exact(t); item = gprojx_after(&t->problem, item)) {
        if (!take_hold(t, item, "pulls", &hold)) return false;
        hold.handles.position = here;
        t->line = item->line;
        if (!drag_to(t, &hold.handles, hold.by)) return false;
        t->line = 0;
    }
    return true;
}

/* Writes a number that reads back to the same bits, whatever the locale. */
static void write_number(FILE *file, double value, char after) {
    char text[GPROJ_NUMBER_SIZE];
    gproj_number_write(value, text);
    fputs(text, file);
    fputc(after, file);
}

/* A verdict as text, for a state whose solve has ended: numbers, the sentence and a NUL. The seconds are not kept. */
enum {
    VERDICT_NUMBERS = 18
};

/* -1 stands for what is infinite or not a number; none of the numbers is negative otherwise, but for indices. */
static double plain_number(double x) { return x <= DBL_MAX ? x : -1; }

static bool write_verdict(const gproj_result *r, FILE *file) {
    const gproj_spoiled *s = &r->spoiled;
    const double number[VERDICT_NUMBERS] = {r->outcome,
                                            r->iterations,
                                            r->damped,
                                            r->attempts,
                                            plain_number(r->residual),
                                            plain_number(r->tolerance),
                                            plain_number(r->step),
                                            plain_number(r->optimality),
                                            r->worst_group,
                                            r->worst_element,
                                            s->turned,
                                            s->crossed,
                                            s->folded,
                                            s->collapsed_edges,
                                            s->collapsed_faces,
                                            s->spikes,
                                            s->place,
                                            s->element};
    int i;
    for (i = 0; i < VERDICT_NUMBERS; ++i) write_number(file, number[i], i < VERDICT_NUMBERS - 1 ? ',' : '\n');
    return fputs(r->message, file) >= 0 && fputc(0, file) == 0;
}

/* Reads a verdict from bytes, `room` of them. Returns its length; 0: there is none. */
static size_t read_verdict(const char *text, size_t room, gproj_result *r) {
    const char *end = (const char *)memchr(text, 0, room), *line = end ? strchr(text, '\n') : NULL;
    gproj_spoiled *s = &r->spoiled;
    double number[VERDICT_NUMBERS];
    int i;
    memset(r, 0, sizeof *r);
    if (!line || !gprojx_read_fields(text, (size_t)(line - text), VERDICT_NUMBERS, number)) return 0;
    for (i = 0; i < VERDICT_NUMBERS; ++i) {
        bool real = i >= 4 && i < 8;
        if (!real && !(fabs(number[i]) <= INT32_MAX)) return 0;
        if (real && number[i] < 0) number[i] = HUGE_VAL;
    }
    if (number[0] < GPROJ_CONVERGED || number[0] > GPROJ_FAILED) return 0;
    r->outcome = (gproj_outcome)number[0];
    r->iterations = (int32_t)number[1], r->damped = (int32_t)number[2], r->attempts = (int32_t)number[3];
    r->residual = number[4], r->tolerance = number[5], r->step = number[6], r->optimality = number[7];
    r->worst_group = (int32_t)number[8], r->worst_element = (int32_t)number[9];
    s->turned = (int32_t)number[10], s->crossed = (int32_t)number[11], s->folded = (int32_t)number[12];
    s->collapsed_edges = (int32_t)number[13], s->collapsed_faces = (int32_t)number[14];
    s->spikes = (int32_t)number[15], s->place = (gproj_place)number[16], s->element = (int32_t)number[17];
    s->total = s->turned + s->crossed + s->folded + s->collapsed_edges + s->collapsed_faces + s->spikes;
    snprintf(r->message, sizeof r->message, "%s", line + 1);
    return (size_t)(end + 1 - text);
}

/* Tells whether there is a state to go on from. */
static bool has_state(const tool *t) {
    return t->output[OUTPUT_STATE].path && access(t->output[OUTPUT_STATE].target, F_OK) == 0;
}

/* Goes on from the state in the file of --state, if there is one. The library's state has the targets and bounds of then,
   and how the solve was begun: others are refused. */
static bool restore(tool *t) {
    const char *path = t->output[OUTPUT_STATE].path;
    char words[1024];
    gproj_error error;
    size_t size, start;
    uint8_t *bytes;
    if (!has_state(t)) return true;
    bytes = (uint8_t *)gprojx_load_file(path, NULL, t->file_limit, &size, &error);
    if (!bytes) return fail_file(t, path, &error);
    start = gprojx_asked_compare(&t->asked, bytes, size, words, sizeof words);
    if (start == 0)
        fail(t, EXIT_REFUSED, "%s: this is no state of this version of guidedproj, or not a whole one", path);
    else if (words[0])
        fail(t, EXIT_REFUSED,
             "%s: this state was written %s; only outputs, --time-limit, --iterations and --threads may change. Remove "
             "it to begin anew",
             path, words);
    else {
        size_t length = start < size ? read_verdict((const char *)bytes + start, size - start, &t->result) : 0;
        t->ended = length > 0;
        if (length == 0 && start < size) length = 1; /* a NUL only */
        if (gproj_state_restore(t->form, bytes + start + length, size - start - length, &error) != GPROJ_OK)
            fail_library(t, path, &error);
    }
    free(bytes);
    return t->exit_code == 0;
}

/* Solves from a saved state or from the beginning, an iteration at a time, so that a later run can go on; a solve that has
   ended stays as it is. */
static bool solve_in_parts(tool *t, const gproj_solve_options *how, double begin) {
    double limit = how->time_budget;
    gproj_solve_options options = *how;
    int32_t done = 0;
    options.time_budget = 0;
    gproj_solve_begin(t->form, t->iterations, &options, NULL);
    if (!restore(t)) return false;
    if (t->ended) { /* evaluates what residuals and report tell of groups */
        const gproj_result verdict = t->result;
        const gproj_solve_options still = {.skip_closeness = true, .skip_guard = true};
        t->result = gproj_solve(t->form, 0, &still);
        if (t->result.outcome != GPROJ_FAILED) t->result = verdict;
        return true;
    }
    do {
        t->result = gproj_solve_advance(t->form, 0);
    } while (gproj_solve_is_on(t->form) && ++done != t->part && (limit <= 0 || now(NULL) - begin < limit));
    t->ended = !gproj_solve_is_on(t->form);
    if (!t->ended && done == t->part) { /* the library's sentence blames the time */
        char *message = t->result.message, copy[sizeof t->result.message];
        const char *rest = strchr(message, ':');
        snprintf(copy, sizeof copy, "the iterations of this run are done%s", rest ? rest : "");
        memcpy(message, copy, sizeof copy);
    }
    return true;
}

/* Prepares what the report and the picture compare with. */
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
    bool dragged = moves_anything(t) && !t->equilibrium.given && !t->plain;
    bool unguided = (t->closeness.given && t->closeness.weight <= 0) || (dragged && !t->nearest);
    const gproj_solve_options how = {.tolerance = t->tolerance,
                                     .epsilon = t->epsilon,
                                     .time_budget = t->time_limit,
                                     .skip_closeness = unguided,
                                     .smooth = !unguided && !t->plain,
                                     .nearest = t->nearest,
                                     .on_iteration = on_iteration,
                                     .user = t};
    double begin = now(NULL);
    int32_t i;
    if (!prepare_records(t) || (dragged && !has_state(t) && !drag(t, begin))) return false;
    if (!t->output[OUTPUT_STATE].path)
        t->result = gproj_solve(t->form, t->iterations, &how);
    else if (!solve_in_parts(t, &how, begin))
        return false;
    if (t->bar) fputc('\n', stderr);
    t->bar = false;
    if (t->exit_code != 0) return false; /* the callback ran out of memory */
    if (t->result.outcome == GPROJ_FAILED) return fail_library(t, NULL, gproj_form_error(t->form));
    if (!pull(t)) return false;
    t->solve_seconds = now(NULL) - begin;
    t->after = gproj_measure(t->mesh, t->original, t->planarity);
    for (i = 0; t->shade && i < t->mesh->face_count; ++i) t->shade[i] = t->colour->value(t, i);
    return !t->equilibrium.given || measure_forces(t);
}

/* ---- the offset ---- */

/* Tells which elements keep the distance: the vertices if only circles of faces were asked for, else the faces. */
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

/* Where the solve has not reached what must hold, panels may be impossible: the other outputs are written all the same. */
static bool make_panels(tool *t) {
    gproj_error error;
    const char *path = t->output[OUTPUT_PANELS].path;
    if (!path) return true;
    t->panels = gprojx_panels_create(t->mesh, t->support, &t->sheet, &error);
    if (t->panels || is_exact(t) || error.code == GPROJ_ERROR_MEMORY) return t->panels || fail_library(t, path, &error);
    fputs("guidedproj: ", stderr);
    gprojx_print_plain(stderr, path);
    fprintf(stderr, " is not written%s: %s\n",
            access(t->output[OUTPUT_PANELS].target, F_OK) == 0 ? ", and what is there belongs to an earlier mesh" : "",
            error.message);
    t->output[OUTPUT_PANELS].path = t->output[OUTPUT_PANEL_LIST].path = NULL;
    return true;
}

/* The largest difference between a distance and the one that was asked for. */
static double offset_error(const tool *t) {
    const gproj_offset_measures *m = &t->offset_measures;
    double wanted = t->offset_distance, least = m->face_distance_min, most = m->face_distance_max;
    if (is_vertex_offset(t)) wanted = fabs(wanted), least = m->vertex_distance_min, most = m->vertex_distance_max;
    return fmax(fabs(least - wanted), fabs(most - wanted));
}

/* ---- the verdict and the report ---- */

static int verdict_code(const tool *t) {
    bool sound = t->allow_spoiled || t->result.spoiled.total == 0;
    return is_exact(t) && sound ? EXIT_REACHED : EXIT_NOT_REACHED;
}

static gproj_code write_report(tool *t, FILE *file) {
    const double cost[2] = {cost_of(t, &t->before), cost_of(t, &t->after)};
    gprojx_report report;
    memset(&report, 0, sizeof report);
    report.version = TOOL_VERSION, report.input = t->input, report.output = t->output[OUTPUT_MESH].path;
    report.mesh = t->mesh, report.form = t->form, report.history = &t->history;
    report.result = &t->result, report.nearest = t->nearest, report.exit_code = verdict_code(t);
    report.before = &t->before, report.after = &t->after;
    report.volume_before = t->volume_before, report.volume = gproj_volume(t->mesh);
    report.cost = t->cost.given ? cost : NULL;
    report.forces = t->equilibrium.given ? &t->forces : NULL;
    report.offset = t->offset ? &t->offset_measures : NULL;
    report.offset_kind = is_vertex_offset(t) ? "vertices" : "faces", report.offset_distance = t->offset_distance;
    report.reading = t->read_seconds, report.set_up = t->setup_seconds, report.solving = t->solve_seconds;
    report.total = now(NULL) - t->start;
    return gprojx_report_write(file, &report);
}

/* ---- the other outputs ---- */

static const char *file_name(const char *path) { return strrchr(path, '/') ? strrchr(path, '/') + 1 : path; }

/* Colours the faces by --colour, else by the imbalance if there are forces alone, else by planarity. */
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
    picture.title = t->title ? t->title : file_name(t->output[OUTPUT_MESH].path);
    picture.caption = caption;
    picture.view = is_given(t, PLACE(view)) ? &t->view : NULL;
    picture.original = t->original;
    if (t->equilibrium.given) picture.edge_value = t->force_in_edge;
    choose_colours(t, &picture);
    return gprojx_picture(file, t->mesh, &picture);
}

/* Writes the line KIND,I,X,Y,Z. */
static void write_vector(FILE *file, const char *kind, int32_t vertex, const double vector[3]) {
    fprintf(file, "%s,%ld,", kind, (long)vertex);
    write_number(file, vector[0], ',');
    write_number(file, vector[1], ',');
    write_number(file, vector[2], '\n');
}

static gproj_code write_forces(tool *t, FILE *file) {
    const gproj_mesh *mesh = t->mesh;
    double *vector = (double *)take(t, 3 * (size_t)mesh->vertex_count, sizeof *vector);
    int32_t i;
    if (!vector) return GPROJ_ERROR_MEMORY;
    fputs("kind,i,j or fx,w or fy,fz\n", file);
    for (i = 0; i < mesh->edge_count; ++i) {
        fprintf(file, "edge,%ld,%ld,", (long)mesh->origin[2 * i], (long)mesh->origin[2 * i + 1]);
        write_number(file, t->density_of_edge[i], '\n');
    }
    gproj_get_loads(t->form, vector, NULL);
    for (i = 0; i < mesh->vertex_count; ++i) write_vector(file, "load", i, vector + 3 * (size_t)i);
    gproj_get_reactions(t->form, vector, NULL);
    for (i = 0; i < mesh->vertex_count; ++i)
        if (t->is_support[i]) write_vector(file, "support", i, vector + 3 * (size_t)i);
    free(vector);
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

/* Writes what elements lack in each group whose rows belong to elements; those that lack nothing are left out. */
static gproj_code write_residuals(tool *t, FILE *file) {
    static const char *const names[] = {"vertex", "edge", "face"};
    const int32_t counts[] = {t->mesh->vertex_count, t->mesh->edge_count, t->mesh->face_count};
    int32_t groups = gproj_system_group_count(gproj_form_system(t->form)), g, i;
    double *residual = (double *)take(t, (size_t)counts[0] + (size_t)counts[1] + (size_t)counts[2], sizeof *residual);
    if (!residual) return GPROJ_ERROR_MEMORY;
    fputs("group,place,element,residual\n", file);
    for (g = 0; g < groups; ++g) {
        gproj_group_info info = gproj_form_group_info(t->form, g);
        int32_t kind = (int32_t)info.place - (int32_t)GPROJ_PLACE_VERTEX;
        if (kind < 0 || kind > 2 || gproj_form_residuals(t->form, g, residual, NULL) != GPROJ_OK) continue;
        for (i = 0; i < counts[kind]; ++i) {
            if (!(residual[i] > 0)) continue;
            fprintf(file, "%s,%s,%ld,", info.name, names[kind], (long)i);
            write_number(file, residual[i], '\n');
        }
    }
    free(residual);
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

static bool write_piece(void *user, const char *text, size_t size) {
    return fwrite(text, 1, size, (FILE *)user) == size;
}

static gproj_code write_as(tool *t, gproj_mesh *mesh, int output, FILE *file) {
    const char *path = t->output[output].path;
    gprojx_format foreign = format_named(path);
    gproj_error error;
    gproj_code code;
    if (foreign == GPROJX_NEITHER)
        return gproj_mesh_write(mesh, gprojx_has_ending(path, ".off") ? GPROJ_FORMAT_OFF : GPROJ_FORMAT_OBJ,
                                write_piece, file, NULL);
    code = gprojx_mesh_write(mesh, foreign, t->encoding, write_piece, file, &error);
    if (code != GPROJ_OK && code != GPROJ_ERROR_FILE) fail_library(t, path, &error);
    return code;
}

static gproj_code write_mesh(tool *t, FILE *file) { return write_as(t, t->mesh, OUTPUT_MESH, file); }

static gproj_code write_offset(tool *t, FILE *file) { return write_as(t, t->offset, OUTPUT_OFFSET, file); }

static gproj_code write_support(tool *t, FILE *file) { return write_as(t, t->support, OUTPUT_SUPPORT, file); }

static gproj_code write_panels(tool *t, FILE *file) {
    bool dxf = gprojx_has_ending(t->output[OUTPUT_PANELS].path, ".dxf");
    return dxf ? gprojx_panels_dxf(file, t->panels) : gprojx_panels_svg(file, t->panels);
}

static gproj_code write_panel_list(tool *t, FILE *file) { return gprojx_panels_csv(file, t->panels); }

/* What was asked for, the verdict if there is one, and the library's state. */
static gproj_code write_state(tool *t, FILE *file) {
    size_t size = gproj_state_size(t->form);
    uint8_t *bytes = (uint8_t *)malloc(size);
    gproj_code code = bytes ? gproj_state_save(t->form, bytes, size, NULL) : GPROJ_ERROR_MEMORY;
    if (code == GPROJ_OK &&
        (!gprojx_asked_write(&t->asked, file) || !(t->ended ? write_verdict(&t->result, file) : fputc(0, file) == 0) ||
         fwrite(bytes, 1, size, file) != size))
        code = GPROJ_ERROR_FILE;
    free(bytes);
    return code;
}

/* ---- outputs in their places ---- */

static bool write_output(tool *t, gprojx_output *output, gproj_code (*write)(tool *t, FILE *file)) {
    gproj_error error;
    FILE *file;
    if (!output->path) return true;
    file = gprojx_output_open(output, &error);
    return (file && gprojx_output_close(output, file, write(t, file), &error)) ||
           fail_output(t, EXIT_REFUSED, output, &error);
}

/* All outputs are complete on the disk before the first is put in its place. */
static bool write_outputs(tool *t) {
    gproj_error error;
    if (!write_output(t, &t->output[OUTPUT_PICTURE], write_picture) ||
        !write_output(t, &t->output[OUTPUT_FORCES], write_forces) ||
        !write_output(t, &t->output[OUTPUT_MESH], write_mesh) ||
        !write_output(t, &t->output[OUTPUT_OFFSET], write_offset) ||
        !write_output(t, &t->output[OUTPUT_SUPPORT], write_support) ||
        !write_output(t, &t->output[OUTPUT_PANELS], write_panels) ||
        !write_output(t, &t->output[OUTPUT_PANEL_LIST], write_panel_list) ||
        !write_output(t, &t->output[OUTPUT_RESIDUALS], write_residuals) ||
        !write_output(t, &t->output[OUTPUT_PROBLEM], write_problem) ||
        !write_output(t, &t->output[OUTPUT_STATE], write_state) ||
        !write_output(t, &t->output[OUTPUT_REPORT], write_report))
        return false;
    return gprojx_outputs_place(t->output, OUTPUT_COUNT, &error) ||
           fail_output(t, EXIT_REFUSED, &t->output[error.index], &error);
}

/* What was printed must have arrived, too. */
static bool finish_printing(tool *t) {
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout)) return true;
    return fail(t, EXIT_REFUSED, "standard output cannot be written: %s", strerror(errno ? errno : EIO));
}

static void print_mesh(const tool *t) {
    const gproj_mesh *mesh = t->mesh;
    int32_t degree, shown = 0;
    gprojx_print_plain(stdout, file_name(t->input));
    printf(": %ld vertices, %ld edges, %ld faces (", (long)mesh->vertex_count, (long)mesh->edge_count,
           (long)mesh->face_count);
    for (degree = gprojx_next_degree(mesh, 0); degree > 0 && shown < 6;
         degree = gprojx_next_degree(mesh, degree), ++shown)
        printf("%s%ld of %ld sides", shown ? ", " : "", (long)gprojx_count_degree(mesh, degree), (long)degree);
    printf("%s), %ld boundary loop%s\n", degree > 0 ? ", ..." : "", (long)mesh->loop_count,
           mesh->loop_count == 1 ? "" : "s");
    if (mesh->reoriented_count > 0)
        printf("note: %ld faces were turned round to agree with their neighbours\n", (long)mesh->reoriented_count);
    if (t->reading.left_out > 0)
        printf("note: %ld triangles with two corners at one place were left out, the first before face %ld\n",
               (long)t->reading.left_out, (long)t->reading.first_left_out);
    if (t->before.degenerate_faces > 0) printf("note: %ld faces have no area\n", (long)t->before.degenerate_faces);
    if (t->collapsed > 0)
        printf("note: %ld faces had fewer than 3 corners left after merging, and were left out\n", (long)t->collapsed);
    if (t->welded > 0)
        printf("note: %ld boundary vertices were merged with others at the same place; vertices are numbered anew\n",
               (long)t->welded);
    if (t->seams > 0)
        printf("note: %ld boundary vertices are at the same place as others: the seams there are open, and their "
               "sides may come apart; --weld closes them\n",
               (long)t->seams);
    if (mesh->isolated_count > 0)
        printf("note: %ld %s to no face\n", (long)mesh->isolated_count,
               mesh->isolated_count == 1 ? "vertex belongs" : "vertices belong");
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

static void print_panels(const tool *t) {
    const gprojx_panels *p = t->panels;
    printf("panels        %ld on %ld sheet%s of %.6g x %.6g mm, %.0f %% covered\n", (long)p->count,
           (long)p->sheet_count, p->sheet_count == 1 ? "" : "s", p->options.width, p->options.height, 100 * p->used);
}

/* The largest distance that a support moved. */
static double support_movement(const tool *t) {
    double most = 0;
    int32_t v, k;
    for (v = 0; v < t->mesh->vertex_count; ++v) {
        double square = 0;
        for (k = 0; t->is_support[v] && !(t->slides && t->slides[v]) && k < 3; ++k) {
            double d = t->mesh->position[3 * (size_t)v + (size_t)k] - t->original[3 * (size_t)v + (size_t)k];
            square += d * d;
        }
        if (square > most) most = square;
    }
    return sqrt(most);
}

/* Prints measures that belong to single options. */
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
    if (is_exact(t) && t->result.outcome == GPROJ_TIME_OUT)
        puts("note: all that must hold holds; the time ran out while wishes or closeness guided");
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
    if (t->panels) print_panels(t);
    printf("displacement  %.3g mean edge lengths on average, at most %.3g", a->displacement_mean, a->displacement_max);
    if (a->displacement_vertex >= 0) printf(" (vertex %ld)", (long)a->displacement_vertex);
    putchar('\n');
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
    gprojx_hold_signals(true); /* they are for the main thread */
    t->pool = gprojx_threads_create(t->threads);
    gprojx_hold_signals(false);
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
    if (!solve(t) || !make_offset(t) || !make_panels(t) || !write_outputs(t)) return false;
    if (!t->quiet) print_summary(t);
    return finish_printing(t);
}

static void clean_up(tool *t) {
    int32_t i;
    gprojx_outputs_discard(t->output, OUTPUT_COUNT, "guidedproj");
    gproj_form_destroy(t->form);
    for (i = 0; i < t->curve_count; ++i) gproj_curve_destroy(t->curve[i]);
    gproj_surface_destroy(t->surface);
    gprojx_panels_destroy(t->panels);
    gproj_mesh_destroy(t->offset), gproj_mesh_destroy(t->support);
    gproj_mesh_destroy(t->reference_mesh), gproj_mesh_destroy(t->cage_mesh), gproj_mesh_destroy(t->mesh);
    for (i = 0; i < MOST_LEVELS; ++i) gproj_stencil_destroy(t->followers[i]);
    gprojx_threads_destroy(t->pool);
    free(t->curve), free(t->fix), free(t->glide), free(t->move), free(t->move_group);
    free(t->point_load), free(t->is_support), free(t->loose), free(t->density_of_edge), free(t->force_in_edge);
    free(t->imbalance_before), free(t->imbalance);
    free(t->original), free(t->planarity_before), free(t->planarity), free(t->shade);
    gprojx_history_free(&t->history);
    gprojx_problem_free(&t->problem); /* which texts of options point into */
    free(t->word), free(t->slides);
    gprojx_asked_free(&t->asked);
}

int main(int argc, char **argv) {
    tool t;
    int exit_code;
    memset(&t, 0, sizeof t);
    t.start = now(NULL);
    t.threads = 1;
    t.file_limit = 1024;
    gprojx_watch_signals(t.output, OUTPUT_COUNT);
    if (read_command_line(&t, argc, argv)) {
        if (t.help)
            print_help(), finish_printing(&t);
        else if (t.version)
            puts("guidedproj " TOOL_VERSION), finish_printing(&t);
        else if (run(&t))
            t.exit_code = verdict_code(&t);
    }
    exit_code = t.exit_code;
    clean_up(&t);
    return exit_code;
}
