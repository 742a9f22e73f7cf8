/* frame.c - how would the edges of a mesh carry loads as beams with rigid joints? Linear statics and buckling.

       cc -O2 -o frame frame.c -lm -lpthread
       ./frame vault.obj --section tube:0.1,0.005 --forces forces.csv --picture vault.svg

   From top to bottom: the run and its errors; the options; supports, loads and forces of the form; the analysis; the
   picture and the report; the summary; main. frame.h and frame_buckling.h have the mechanics. */
#define _XOPEN_SOURCE 700

#ifndef GPROJI_IMPLEMENTED /* else the library is linked: tests compile it once */
#define GPROJ_STATIC
#define GUIDEDPROJ_IMPLEMENTATION
#endif
#include "../guidedproj.h"

#include "frame_buckling.h"
#include "json.h"
#include "outputs.h"
#include "picture.h"
#include "readers.h"

/* ---- the run ---- */

enum {
    EXIT_USAGE = 2,
    EXIT_REFUSED = 3,
    EXIT_MEMORY = 4
};
enum {
    MOST_SUPPORTS = 64, /* options, not vertices */
    MOST_PIECES = 16,
    MEGABYTES = 1024
};
enum {
    OUTPUT_PICTURE,
    OUTPUT_REPORT,
    OUTPUT_COUNT
};

typedef struct tool_support { /* an option --pinned, --fixed or --roller */
    const char *option, *which;
} tool_support;

typedef struct tool_edge { /* a beam along an edge of the mesh */
    double length;
    double compression;        /* the mean along the beam; < 0: tension */
    double bending, torsion;   /* the largest of either sign */
    double utilisation;        /* largest (|N|/A + M/W) over the yield stress */
    double euler, euler_share; /* pi^2 E min(Iy, Iz) / L^2, and the compression over it (tension: 0) */
    double form_force;         /* compression in the form, in the form's units */
} tool_edge;

/* Axial forces beside those of the form, over the edges that are not held at both ends. */
typedef struct tool_comparison {
    int32_t edges, worst;
    double unit;        /* one unit of the form's forces, in N: the ratio of all loads */
    double correlation; /* Pearson's */
    double largest;     /* force of the form, in N */
    double difference;  /* the largest, over that */
} tool_comparison;

typedef struct tool_extremes {
    int32_t moved, pressed; /* vertices with the largest displacement and reaction */
    int32_t compressed, pulled, bent, twisted, used, near_euler; /* edges */
    int32_t in_tension;                                          /* edges */
    double weight, load[3], reaction[3];                         /* sums: own weight, at vertices, of supports */
} tool_extremes;

typedef struct tool {
    const char *input, *loads, *forces;
    gprojx_output output[OUTPUT_COUNT];
    const char *section_text;
    gprojx_section section;
    gprojx_material material;
    double gravity, scale, mean_edge; /* 0: not given; mean_edge: in metres, instead of the scale */
    int32_t pieces;
    tool_support support[MOST_SUPPORTS + 1]; /* up to the first without `which` */
    bool skip_buckling, quiet, help;

    gproj_mesh *mesh;
    gprojx_frame frame; /* nodes: the vertices, then those inside the edges; beams: `pieces` an edge */
    tool_edge *edge;
    double *form_load; /* 3 a vertex, with --forces */
    double *axial;     /* of each beam, tension > 0 */
    gprojx_buckling buckling;
    tool_comparison comparison;
    tool_extremes extremes;
    int exit_code;
} tool;

/* Prints a failure's sentence and keeps the exit code; every failure passes through here. Returns false. */
static bool fail(tool *t, int exit_code, const char *format, ...) {
    char sentence[8192];
    va_list list;
    if (t->exit_code != 0) return false;
    t->exit_code = exit_code;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    fputs("frame: ", stderr);
    gprojx_print_plain(stderr, sentence);
    fputs(exit_code == EXIT_USAGE ? "\n(frame --help lists all options)\n" : "\n", stderr);
    return false;
}

static bool fail_error(tool *t, const char *path, const char *between, const gproj_error *error) {
    return fail(t, error->code == GPROJ_ERROR_MEMORY ? EXIT_MEMORY : EXIT_REFUSED, "%s%s%s", path, between,
                error->message);
}

static void *take(tool *t, size_t count, size_t size) {
    void *block = calloc(count > 0 ? count : 1, size);
    if (!block) fail(t, EXIT_MEMORY, "out of memory");
    return block;
}

/* ---- options ---- */

/* Reads KIND:SIZE,SIZE,... in metres. */
static bool set_section(tool *t, void *place, const char *name, const char *value) {
    static const struct {
        const char *name;
        int32_t sizes;
    } kinds[] = {{"box:", 3}, {"rectangle:", 2}, {"tube:", 2}, {"circle:", 1}};
    double size[3] = {0, 0, 0};
    size_t length;
    int k;
    (void)place;
    for (k = 0; k < 4 && strncmp(value, kinds[k].name, strlen(kinds[k].name)) != 0; ++k) continue;
    length = k < 4 ? strlen(kinds[k].name) : 0;
    t->section_text = value;
    if (k < 4 && gprojx_read_fields(value + length, strlen(value + length), kinds[k].sizes, size) &&
        fmin(size[0], kinds[k].sizes > 1 ? size[1] : 1) > 0) {
        if (k == 0 && size[2] > 0 && 2 * size[2] <= fmin(size[0], size[1]))
            return t->section = gprojx_section_box(size[0], size[1], size[2]), true;
        if (k == 1) return t->section = gprojx_section_rectangle(size[0], size[1]), true;
        if (k == 2 && 2 * size[1] <= size[0]) return t->section = gprojx_section_tube(size[0], size[1]), true;
        if (k == 3) return t->section = gprojx_section_circle(size[0]), true;
    }
    return fail(
        t, EXIT_USAGE,
        "--%s %s: expected box:W,H,T, rectangle:W,H, tube:D,T or circle:D in metres (T: thickness of the walls)", name,
        value);
}

static bool set_positive(tool *t, void *place, const char *name, const char *value) {
    return (gprojx_read_number(value, strlen(value), (double *)place) && *(double *)place > 0) ||
           fail(t, EXIT_USAGE, "--%s %s: expected a number larger than 0", name, value);
}

static bool set_weight(tool *t, void *place, const char *name, const char *value) {
    return (gprojx_read_number(value, strlen(value), (double *)place) && *(double *)place >= 0) ||
           fail(t, EXIT_USAGE, "--%s %s: expected a number, 0 or larger", name, value);
}

static bool set_pieces(tool *t, void *place, const char *name, const char *value) {
    return gprojx_read_integer(value, strlen(value), 1, MOST_PIECES, (int32_t *)place) ||
           fail(t, EXIT_USAGE, "--%s %s: expected a whole number from 1 to %d", name, value, MOST_PIECES);
}

static bool set_text(tool *t, void *place, const char *name, const char *value) {
    *(const char **)place = value;
    return value[0] || fail(t, EXIT_USAGE, "--%s needs a path", name);
}

static bool set_flag(tool *t, void *place, const char *name, const char *value) {
    (void)t, (void)name, (void)value;
    return *(bool *)place = true;
}

static bool add_support(tool *t, void *place, const char *name, const char *value) {
    int i = 0;
    (void)place;
    while (t->support[i].which) ++i;
    if (i == MOST_SUPPORTS) return fail(t, EXIT_USAGE, "more than %d options say what is held", MOST_SUPPORTS);
    t->support[i].option = name, t->support[i].which = value;
    return true;
}

typedef struct tool_option {
    const char *name, *value, *help; /* value "": none is read */
    bool (*read)(tool *t, void *place, const char *name, const char *value);
    size_t place;
} tool_option;

static const tool_option options[] = {
    {"section", "KIND:SIZES",
     "box:W,H,T  rectangle:W,H  tube:D,T  circle:D in m\n"
     "(box:0.1,0.1,0.005): width along y, height along z, diameter,\nthickness of walls",
     set_section, 0},
    {"young", "E", "Young's modulus in Pa (210e9, steel)", set_positive, offsetof(tool, material.young)},
    {"shear", "G", "shear modulus in Pa (81e9)", set_positive, offsetof(tool, material.shear)},
    {"density", "R", "in kg/m^3 (7850); 0: no own weight", set_weight, offsetof(tool, material.density)},
    {"yield", "S", "the stress in Pa that utilisation 1 means (235e6)", set_positive, offsetof(tool, material.yield)},
    {"gravity", "G", "in m/s^2, downwards along z (9.81)", set_weight, offsetof(tool, gravity)},
    {"scale", "S", "metres in one unit of the mesh (1)", set_positive, offsetof(tool, scale)},
    {"mean-edge", "L", "instead of --scale: the mean edge is L metres long", set_positive, offsetof(tool, mean_edge)},
    {"loads", "FILE", "forces on vertices in N: CSV, lines VERTEX,FX,FY,FZ", set_text, offsetof(tool, loads)},
    {"pinned", "WHICH",
     "vertices that turn, but cannot move. WHICH: boundary, corners,\n"
     "a list such as 0,7,20-29, or a file of such numbers. Without\n"
     "any such option: the supports of --forces, else boundary",
     add_support, 0},
    {"fixed", "WHICH", "vertices that neither move nor turn", add_support, 0},
    {"roller", "WHICH", "vertices that cannot move in z", add_support, 0},
    {"divide", "N",
     "beams an edge (2): with 1 forces and displacements are as\n"
     "exact, but not how an edge buckles between its vertices",
     set_pieces, offsetof(tool, pieces)},
    {"forces", "FILE", "compare with these: the CSV of guidedproj --forces", set_text, offsetof(tool, forces)},
    {"skip-buckling", "", "leave out the load factor", set_flag, offsetof(tool, skip_buckling)},
    {"report", "FILE.json", "everything, for each beam and vertex", set_text,
     offsetof(tool, output[OUTPUT_REPORT].path)},
    {"picture", "FILE.svg", "faces by utilisation, edges by axial force", set_text,
     offsetof(tool, output[OUTPUT_PICTURE].path)},
    {"quiet", "", "print errors only", set_flag, offsetof(tool, quiet)},
    {"help", "", "print this", set_flag, offsetof(tool, help)},
};

enum {
    OPTION_COUNT = (int)(sizeof options / sizeof options[0])
};

static void print_help(void) {
    int i;
    puts("usage: frame MESH.{obj,off} OPTIONS\n\n"
         "Analyses the edges of a mesh as straight beams with rigid joints (Euler and\n"
         "Bernoulli, linear), under their own weight and loads: axial forces, moments,\n"
         "stresses, displacements, reactions, and the factor by which all loads may grow\n"
         "before it buckles. Vertices count from 0, z is up, compression is positive.\n\n"
         "Local frame of an edge: x along it, z the normal of the mesh as far as it is\n"
         "orthogonal to x, y = z cross x. Utilisation: the largest |N|/A + M/W along the\n"
         "edge (M/W added for y and z, of round sections that of the vector) over the\n"
         "yield stress; torsion is told apart.\n");
    for (i = 0; i < OPTION_COUNT; ++i) {
        const char *line = options[i].help;
        int width = printf("  --%s %s", options[i].name, options[i].value);
        for (; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL, width = 0)
            printf("%*s%.*s\n", width < 25 ? 25 - width : 1, "", (int)strcspn(line, "\n"), line);
    }
    puts("\nexamples\n"
         "  guidedproj roof.obj -o vault.obj --equilibrium --compressive --fix boundary \\\n"
         "      --forces forces.csv\n"
         "  frame vault.obj --section tube:0.08,0.004 --picture vault.svg\n"
         "  frame vault.obj --forces forces.csv --fixed boundary --report vault.json\n"
         "  frame vault.obj --scale 0.5 --pinned 0,20 --roller 420-440 --loads snow.csv\n\n"
         "exit status\n"
         "  0 analysed   2 wrong usage   3 input refused, a mechanism, or writing failed\n"
         "  4 out of memory");
}

static bool read_command_line(tool *t, int argc, char **argv) {
    bool seen[OPTION_COUNT] = {false};
    int i, k;
    for (i = 1; i < argc && !t->help; ++i) {
        const char *name = argv[i] + 2, *equals = strchr(argv[i], '='), *value = equals ? equals + 1 : NULL;
        size_t size = equals ? (size_t)(equals - name) : strlen(argv[i]) - 2;
        if (argv[i][0] == '-' && argv[i][1] != '-') return fail(t, EXIT_USAGE, "there is no option %s", argv[i]);
        if (argv[i][0] != '-') {
            if (t->input) return fail(t, EXIT_USAGE, "there are two inputs, '%s' and '%s'", t->input, argv[i]);
            t->input = argv[i];
            continue;
        }
        for (k = 0; k < OPTION_COUNT; ++k)
            if (strncmp(name, options[k].name, size) == 0 && !options[k].name[size]) break;
        if (k == OPTION_COUNT) return fail(t, EXIT_USAGE, "there is no option %s", argv[i]);
        if (seen[k] && options[k].read != add_support)
            return fail(t, EXIT_USAGE, "--%s is given twice", options[k].name);
        seen[k] = true;
        if (!options[k].value[0] && value) return fail(t, EXIT_USAGE, "--%s takes no value", options[k].name);
        if (options[k].value[0] && !value) {
            if (++i == argc) return fail(t, EXIT_USAGE, "--%s needs a value: %s", options[k].name, options[k].value);
            value = argv[i];
        }
        if (!options[k].read(t, (char *)t + options[k].place, options[k].name, value)) return false;
    }
    if (t->help) return true;
    if (!t->input) return fail(t, EXIT_USAGE, "no input is given: frame MESH.obj");
    if (t->scale > 0 && t->mean_edge > 0) return fail(t, EXIT_USAGE, "--scale and --mean-edge say the same: give one");
    if (t->scale == 0) t->scale = 1;
    if (t->output[OUTPUT_REPORT].path && !gprojx_has_ending(t->output[OUTPUT_REPORT].path, ".json"))
        return fail(t, EXIT_USAGE, "the report '%s' must end in .json", t->output[OUTPUT_REPORT].path);
    if (t->output[OUTPUT_PICTURE].path && !gprojx_has_ending(t->output[OUTPUT_PICTURE].path, ".svg"))
        return fail(t, EXIT_USAGE, "the picture '%s' must end in .svg", t->output[OUTPUT_PICTURE].path);
    return true;
}

/* ---- supports, loads, forces of the form ---- */

static char *load_text(tool *t, const char *path) {
    gproj_error error;
    size_t length;
    char *text = gprojx_load_file(path, gprojx_any_text, MEGABYTES, &length, &error);
    if (!text) fail_error(t, path, ": ", &error);
    if (text) gprojx_drop_mark(text, &length);
    if (text && strlen(text) < length) fail(t, EXIT_REFUSED, "%s: a zero byte; this is no text", path);
    if (t->exit_code == 0) return text;
    free(text);
    return NULL;
}

/* Marks the vertices of boundary, corners, a list, or a file. */
static bool mark_vertices(tool *t, const tool_support *support, bool *mark) {
    const char *which = support->which;
    gproj_error error;
    bool list = strspn(which, "0123456789,- ") == strlen(which);
    char *text = NULL, where[64];
    int32_t v;
    if (strcmp(which, "boundary") == 0 || strcmp(which, "corners") == 0) {
        gproj_form *form = gproj_form_create(t->mesh, NULL); /* knows the corners */
        for (v = 0; form && v < t->mesh->vertex_count; ++v)
            mark[v] = which[0] == 'b' ? gproj_mesh_is_boundary_vertex(t->mesh, v) : gproj_form_is_corner(form, v);
        gproj_form_destroy(form);
        return form || fail(t, EXIT_MEMORY, "out of memory");
    }
    snprintf(where, sizeof where, "--%s %.40s", support->option, which);
    if (!list) text = load_text(t, which);
    if ((list || text) && !gprojx_mark_list(list ? which : text, t->mesh->vertex_count, mark, &error))
        fail(t, list ? EXIT_USAGE : EXIT_REFUSED, "%s: %s", list ? where : which, error.message);
    free(text);
    return t->exit_code == 0;
}

static bool hold(tool *t, const tool_support *support) {
    bool *mark = (bool *)take(t, (size_t)t->mesh->vertex_count, sizeof *mark);
    int32_t v, k;
    bool any = false;
    if (mark && mark_vertices(t, support, mark)) {
        for (v = 0; v < t->mesh->vertex_count; ++v) {
            any = any || mark[v];
            for (k = 0; mark[v] && k < 6; ++k)
                if (support->option[0] == 'f' || k == 2 || (support->option[0] == 'p' && k < 3))
                    t->frame.held[6 * (size_t)v + (size_t)k] = true;
        }
        if (!any) fail(t, EXIT_USAGE, "--%s %s: this names no vertex of the mesh", support->option, support->which);
    }
    free(mark);
    return t->exit_code == 0;
}

/* Returns the edge between two vertices; -1: none. */
static int32_t edge_between(const gproj_mesh *mesh, int32_t a, int32_t b) {
    int32_t start = mesh->vertex_halfedge[a], h = start;
    do {
        if (h < 0 || mesh->origin[mesh->twin[h]] == b) return h < 0 ? -1 : mesh->edge[h];
        h = mesh->twin[mesh->prev[h]];
    } while (h != start);
    return -1;
}

/* Reads a line that begins with `name`, and then has `count` numbers. */
static bool read_named(const char *line, size_t size, const char *name, int32_t count, double *field) {
    size_t length = strlen(name);
    return size > length && strncmp(line, name, length) == 0 &&
           gprojx_read_fields(line + length, size - length, count, field);
}

/* Reads a line of the forces: edge,I,J,W with the compression W |v_I - v_J|, load,I,FX,FY,FZ or support,I with a
   reaction or without, which holds only where no option says what is held. */
static bool read_force(tool *t, const char *line, size_t size, int32_t number, gproj_error *error) {
    int32_t count = t->mesh->vertex_count, e, k;
    double field[4];
    while (size > 0 && isspace((unsigned char)line[size - 1])) --size;
    if (size == 0 || (number == 1 && strncmp(line, "kind,", 5) == 0)) return true;
    if (read_named(line, size, "edge,", 3, field)) {
        if (!gprojx_check_vertex(field[0], count, number, error) ||
            !gprojx_check_vertex(field[1], count, number, error))
            return false;
        e = edge_between(t->mesh, (int32_t)field[0], (int32_t)field[1]);
        if (e < 0)
            return gprojx_refuse(error, GPROJ_ERROR_INDEX, "line %ld: no edge joins vertices %g and %g", (long)number,
                                 field[0], field[1]);
        t->edge[e].form_force = field[2] * t->edge[e].length / t->scale;
    } else if (read_named(line, size, "load,", 4, field)) {
        if (!gprojx_check_vertex(field[0], count, number, error)) return false;
        memcpy(t->form_load + 3 * (size_t)field[0], field + 1, 3 * sizeof *field);
    } else if (read_named(line, size, "support,", 4, field) || read_named(line, size, "support,", 1, field)) {
        if (!gprojx_check_vertex(field[0], count, number, error)) return false;
        for (k = 0; k < 3 && !t->support[0].which; ++k) t->frame.held[6 * (size_t)field[0] + (size_t)k] = true;
    } else
        return gprojx_refuse(error, GPROJ_ERROR_SYNTAX,
                             "line %ld: expected edge,I,J,W or load,I,FX,FY,FZ or support,I,...", (long)number);
    return true;
}

static bool read_forces(tool *t) {
    char *text = load_text(t, t->forces), *line = text;
    gproj_error error;
    int32_t number = 1;
    t->form_load = (double *)take(t, 3 * (size_t)t->mesh->vertex_count, sizeof *t->form_load);
    for (; t->exit_code == 0 && *line; ++number) {
        size_t size = strcspn(line, "\n");
        if (!read_force(t, line, size, number, &error)) fail_error(t, t->forces, ", ", &error);
        line += size + (line[size] != 0);
    }
    free(text);
    return t->exit_code == 0;
}

static bool read_loads(tool *t) {
    char *text = load_text(t, t->loads);
    double *load = (double *)take(t, 3 * (size_t)t->mesh->vertex_count, sizeof *load);
    gproj_error error;
    int32_t v, k;
    if (text && load && !gprojx_read_loads(text, t->mesh->vertex_count, load, &error))
        fail_error(t, t->loads, ", ", &error);
    for (v = 0; t->exit_code == 0 && v < t->mesh->vertex_count; ++v)
        for (k = 0; k < 3; ++k) {
            t->frame.load[6 * (size_t)v + (size_t)k] = load[3 * (size_t)v + (size_t)k];
            if (fabs(load[3 * (size_t)v + (size_t)k]) > 0 && t->mesh->vertex_halfedge[v] < 0)
                fail(t, EXIT_REFUSED, "%s: vertex %ld bears a load, and no edge ends there", t->loads, (long)v);
        }
    free(text), free(load);
    return t->exit_code == 0;
}

/* ---- the analysis ---- */

/* Sums the area vectors of the faces at an edge: along it the heights of sections stand. */
static void normal_of_edge(const gproj_mesh *mesh, int32_t e, double normal[3]) {
    double area[3];
    int32_t side, k;
    normal[0] = normal[1] = normal[2] = 0;
    for (side = 0; side < 2; ++side) {
        if (mesh->face[2 * e + side] < 0) continue;
        gproj_mesh_face_area_vector(mesh, mesh->face[2 * e + side], area);
        for (k = 0; k < 3; ++k) normal[k] += area[k];
    }
}

/* Makes the beams of an edge; the nodes inside edge e begin at vertex_count + e (pieces - 1). */
static bool make_beams(tool *t, int32_t e) {
    const gproj_mesh *mesh = t->mesh;
    int32_t inside = mesh->vertex_count + e * (t->pieces - 1), piece, k;
    double weight = t->material.density * t->section.area * t->gravity, normal[3], a[3], b[3];
    normal_of_edge(mesh, e, normal);
    for (k = 0; k < 3; ++k) {
        a[k] = t->scale * mesh->position[3 * (size_t)mesh->origin[2 * e] + (size_t)k];
        b[k] = t->scale * mesh->position[3 * (size_t)mesh->origin[2 * e + 1] + (size_t)k];
    }
    t->edge[e].length =
        sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
    if (!(t->edge[e].length > 0))
        return fail(t, EXIT_REFUSED, "%s: the edge between vertices %ld and %ld has no length", t->input,
                    (long)mesh->origin[2 * e], (long)mesh->origin[2 * e + 1]);
    for (piece = 0; piece < t->pieces; ++piece) {
        gprojx_beam *beam = &t->frame.beam[e * t->pieces + piece];
        *beam = gprojx_beam_between(a, b, normal, &t->section, &t->material);
        beam->length = t->edge[e].length / t->pieces;
        beam->node[0] = piece == 0 ? mesh->origin[2 * e] : inside + piece - 1;
        beam->node[1] = piece == t->pieces - 1 ? mesh->origin[2 * e + 1] : inside + piece;
        beam->load[2] = -weight;
    }
    return true;
}

static bool make_frame(tool *t) {
    static const tool_support boundary = {"pinned", "boundary"};
    gproj_error error;
    int32_t e, i;
    bool any = false;
    t->mesh = gproj_mesh_load(t->input, NULL, &error);
    if (!t->mesh && error.code == GPROJ_ERROR_FILE) return fail_error(t, "", "", &error);
    if (!t->mesh) return fail_error(t, t->input, ": ", &error);
    if (t->mean_edge > 0) t->scale = t->mean_edge / gproj_mesh_mean_edge_length(t->mesh);
    if (t->mesh->edge_count == 0) return fail(t, EXIT_REFUSED, "%s: the mesh has no edges", t->input);
    if ((double)t->mesh->vertex_count + (double)t->mesh->edge_count * t->pieces > 1e8)
        return fail(t, EXIT_REFUSED, "%s: the mesh is too large", t->input);
    t->edge = (tool_edge *)take(t, (size_t)t->mesh->edge_count, sizeof *t->edge);
    t->axial = (double *)take(t, (size_t)t->mesh->edge_count * (size_t)t->pieces, sizeof *t->axial);
    if (t->exit_code != 0) return false;
    if (!gprojx_frame_create(&t->frame, t->mesh->vertex_count + t->mesh->edge_count * (t->pieces - 1),
                             t->mesh->edge_count * t->pieces))
        return fail(t, EXIT_MEMORY, "out of memory");
    for (e = 0; e < t->mesh->edge_count; ++e)
        if (!make_beams(t, e)) return false;
    for (i = 0; t->support[i].which; ++i)
        if (!hold(t, &t->support[i])) return false;
    if ((t->forces && !read_forces(t)) || (t->loads && !read_loads(t))) return false;
    for (i = 0; i < 6 * t->mesh->vertex_count; ++i) any |= t->frame.held[i];
    return any || hold(t, &boundary);
}

static void measure_edge(tool *t, int32_t e) {
    tool_edge *edge = &t->edge[e];
    int32_t piece, b;
    for (piece = 0; piece < t->pieces; ++piece) {
        gprojx_beam_state state = gprojx_beam_state_of(&t->frame, b = e * t->pieces + piece);
        double bending, stress;
        gprojx_beam_largest(&state, &t->section, &bending, &stress);
        t->axial[b] = state.axial;
        edge->compression -= state.axial / t->pieces;
        edge->bending = fmax(edge->bending, bending);
        edge->torsion = fmax(edge->torsion, fabs(state.torsion));
        edge->utilisation = fmax(edge->utilisation, stress / t->material.yield);
    }
    edge->euler = pow(gprojx_pi / edge->length, 2) * t->material.young * fmin(t->section.iy, t->section.iz);
    edge->euler_share = fmax(0, edge->compression) / edge->euler;
}

/* Tells whether the vertex is held against all displacements. */
static bool is_held(const tool *t, int32_t vertex) {
    const bool *held = t->frame.held + 6 * (size_t)vertex;
    return held[0] && held[1] && held[2];
}

/* Tells whether the vertex is held against any motion. */
static bool is_support(const tool *t, int32_t vertex) {
    static const bool free_motions[6];
    return memcmp(t->frame.held + 6 * (size_t)vertex, free_motions, sizeof free_motions) != 0;
}

/* Sums the sizes of all loads: of the beams, and at vertices. */
static double sum_of_loads(const tool *t) {
    double sum = 0;
    int32_t e, v;
    for (e = 0; e < t->mesh->edge_count; ++e) sum -= t->edge[e].length * t->frame.beam[e * t->pieces].load[2];
    for (v = 0; v < t->mesh->vertex_count; ++v) sum += gprojx_length3(t->frame.load + 6 * (size_t)v);
    return sum;
}

/* Compares the axial forces with those of the form, over the edges that carry some there. */
static bool compare(tool *t) {
    tool_comparison *c = &t->comparison;
    double of_form = 0, x, y, sum_x = 0, sum_y = 0, xx = 0, xy = 0, yy = 0;
    int32_t e, v;
    for (v = 0; v < t->mesh->vertex_count; ++v) of_form += gprojx_length3(t->form_load + 3 * (size_t)v);
    if (!(of_form > 0)) return fail(t, EXIT_REFUSED, "%s: no lines load,I,FX,FY,FZ with loads", t->forces);
    c->unit = sum_of_loads(t) / of_form;
    for (e = 0; e < t->mesh->edge_count; ++e) {
        if (is_held(t, t->mesh->origin[2 * e]) && is_held(t, t->mesh->origin[2 * e + 1])) continue;
        x = c->unit * t->edge[e].form_force, y = t->edge[e].compression;
        if (fabs(x - y) > c->difference) c->difference = fabs(x - y), c->worst = e;
        c->largest = fmax(c->largest, fabs(x));
        c->edges++, sum_x += x, sum_y += y, xx += x * x, xy += x * y, yy += y * y;
    }
    xx -= sum_x * sum_x / c->edges, xy -= sum_x * sum_y / c->edges, yy -= sum_y * sum_y / c->edges;
    c->correlation = xy / sqrt(xx * yy);
    c->difference /= c->largest;
    return true;
}

/* Returns the edge with the largest number, `sign` times the member of tool_edge at this offset. */
static int32_t largest_edge(const tool *t, size_t place, double sign) {
    int32_t best = 0, e;
    for (e = 1; e < t->mesh->edge_count; ++e)
        if (sign * *(const double *)((const char *)&t->edge[e] + place) >
            sign * *(const double *)((const char *)&t->edge[best] + place))
            best = e;
    return best;
}

static double reaction(const tool *t, int32_t vertex) { return gprojx_length3(t->frame.reaction + 6 * (size_t)vertex); }
static double displacement(const tool *t, int32_t vertex) {
    return gprojx_length3(t->frame.motion + 6 * (size_t)vertex);
}

static void find_extremes(tool *t) {
    tool_extremes *x = &t->extremes;
    int32_t e, v, k;
    double most;
    x->compressed = largest_edge(t, offsetof(tool_edge, compression), 1);
    x->pulled = largest_edge(t, offsetof(tool_edge, compression), -1);
    x->bent = largest_edge(t, offsetof(tool_edge, bending), 1);
    x->twisted = largest_edge(t, offsetof(tool_edge, torsion), 1);
    x->used = largest_edge(t, offsetof(tool_edge, utilisation), 1);
    x->near_euler = largest_edge(t, offsetof(tool_edge, euler_share), 1);
    most = fmax(fabs(t->edge[x->compressed].compression), fabs(t->edge[x->pulled].compression));
    for (e = 0; e < t->mesh->edge_count; ++e) {
        x->in_tension +=
            t->edge[e].compression < -1e-9 * most; /* less is rounding: beams between supports carry none */
        x->weight -= t->edge[e].length * t->frame.beam[e * t->pieces].load[2];
    }
    for (v = 0; v < t->mesh->vertex_count; ++v) {
        if (displacement(t, v) > displacement(t, x->moved)) x->moved = v;
        if (reaction(t, v) > reaction(t, x->pressed)) x->pressed = v;
        for (k = 0; k < 3; ++k) {
            x->load[k] += t->frame.load[6 * (size_t)v + (size_t)k];
            x->reaction[k] += t->frame.reaction[6 * (size_t)v + (size_t)k];
        }
    }
}

static bool analyse(tool *t) {
    gproj_error error;
    int32_t e;
    if (!(sum_of_loads(t) > 0))
        return fail(t, EXIT_USAGE, "nothing loads the frame: neither --density and --gravity nor --loads");
    if (gprojx_frame_solve(&t->frame, &error) != GPROJ_OK) return fail_error(t, t->input, ": ", &error);
    if (!(gprojx_frame_dot(6 * (size_t)t->frame.node_count, t->frame.motion, t->frame.motion) < 1e200) ||
        !(gprojx_frame_dot(6 * (size_t)t->frame.node_count, t->frame.reaction, t->frame.reaction) < 1e200))
        return fail(t, EXIT_REFUSED, "%s: displacements or reactions beyond 1e100: wrong units?", t->input);
    for (e = 0; e < t->mesh->edge_count; ++e) measure_edge(t, e);
    find_extremes(t);
    if (t->forces && !compare(t)) return false;
    if (!t->skip_buckling && gprojx_frame_buckle(&t->frame, t->axial, &t->buckling) != GPROJ_OK)
        return fail(t, EXIT_MEMORY, "out of memory");
    return true;
}

/* ---- picture and report ---- */

static const char *file_name(const char *path) { return strrchr(path, '/') ? strrchr(path, '/') + 1 : path; }

/* Returns the end of a scale of four parts with round ends, at least `high`. */
static double round_scale(double high) {
    double part = high / 4, size = pow(10, floor(log10(part)));
    return 4 * size * (part < 3 * size ? ceil(2 * part / size) / 2 : ceil(part / size));
}

/* Colours faces by the largest utilisation around them, and edges by their axial force in kN. */
static gproj_code draw(tool *t, FILE *file) {
    const gproj_mesh *mesh = t->mesh;
    double *used = (double *)take(t, (size_t)mesh->face_count, sizeof *used), high = 0;
    double *force = (double *)take(t, (size_t)mesh->edge_count, sizeof *force);
    gprojx_picture_options picture;
    gproj_code code = GPROJ_ERROR_MEMORY;
    char title[160], caption[160];
    int32_t f, k, e;
    memset(&picture, 0, sizeof picture);
    for (f = 0; used && f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        for (k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h])
            used[f] = fmax(used[f], 100 * t->edge[mesh->edge[h]].utilisation);
        high = fmax(high, used[f]);
    }
    for (e = 0; force && e < mesh->edge_count; ++e) force[e] = t->edge[e].compression / 1000;
    snprintf(title, sizeof title, "%.120s: utilisation of the beams", file_name(t->input));
    snprintf(caption, sizeof caption, "%.60s m \xc2\xb7 at most %.3g %% of %.4g MPa \xc2\xb7 edges: axial forces in kN",
             t->section_text, high, t->material.yield / 1e6);
    picture.title = title, picture.caption = caption;
    picture.legend = "largest stress around each face, % of the yield stress";
    picture.face_value = used, picture.edge_value = force;
    picture.linear = true;
    picture.high = high > 0 ? round_scale(high) : 1;
    if (used && force) code = gprojx_picture(file, mesh, &picture);
    free(used), free(force);
    return code;
}

static void report_sums(tool *t, gprojx_json *j) {
    static const char *const keys[] = {"load_x", "load_y", "load_z", "reaction_x", "reaction_y", "reaction_z"};
    const tool_extremes *x = &t->extremes;
    int k;
    gprojx_json_open(j, "totals", '{');
    gprojx_json_number(j, "weight", x->weight);
    for (k = 0; k < 6; ++k) gprojx_json_number(j, keys[k], k < 3 ? x->load[k] : x->reaction[k - 3]);
    gprojx_json_number(j, "max_displacement", displacement(t, x->moved));
    gprojx_json_integer(j, "max_displacement_vertex", x->moved);
    gprojx_json_number(j, "max_reaction", reaction(t, x->pressed));
    gprojx_json_integer(j, "max_reaction_vertex", x->pressed);
    gprojx_json_integer(j, "edges_in_tension", x->in_tension);
    gprojx_json_number(j, "max_compression", t->edge[x->compressed].compression);
    gprojx_json_number(j, "max_tension", -t->edge[x->pulled].compression);
    gprojx_json_number(j, "max_bending", t->edge[x->bent].bending);
    gprojx_json_number(j, "max_torsion", t->edge[x->twisted].torsion);
    gprojx_json_number(j, "max_utilisation", t->edge[x->used].utilisation);
    gprojx_json_number(j, "max_euler_share", t->edge[x->near_euler].euler_share);
    gprojx_json_close(j, '}');
}

static void report_lists(tool *t, gprojx_json *j) {
    static const char *const keys[] = {"ux", "uy", "uz", "rx", "ry", "rz", "fx", "fy", "fz", "mx", "my", "mz"};
    int32_t e, v, k;
    gprojx_json_open(j, "edges", '[');
    for (e = 0; e < t->mesh->edge_count; ++e) {
        gprojx_json_open_row(j, NULL);
        gprojx_json_integer(j, "i", t->mesh->origin[2 * e]), gprojx_json_integer(j, "j", t->mesh->origin[2 * e + 1]);
        gprojx_json_number(j, "length", t->edge[e].length);
        gprojx_json_number(j, "compression", t->edge[e].compression);
        gprojx_json_number(j, "bending", t->edge[e].bending);
        gprojx_json_number(j, "torsion", t->edge[e].torsion);
        gprojx_json_number(j, "utilisation", t->edge[e].utilisation);
        gprojx_json_number(j, "euler_load", t->edge[e].euler);
        gprojx_json_number(j, "euler_share", t->edge[e].euler_share);
        if (t->forces) gprojx_json_number(j, "form_force", t->comparison.unit * t->edge[e].form_force);
        gprojx_json_close(j, '}');
    }
    gprojx_json_close(j, ']');
    gprojx_json_open(j, "vertices", '[');
    for (v = 0; v < t->mesh->vertex_count; ++v) {
        gprojx_json_open_row(j, NULL);
        for (k = 0; k < 6; ++k) gprojx_json_number(j, keys[k], t->frame.motion[6 * (size_t)v + (size_t)k]);
        for (k = 6; k < 12 && is_support(t, v); ++k)
            gprojx_json_number(j, keys[k], t->frame.reaction[6 * (size_t)v + (size_t)k - 6]);
        gprojx_json_close(j, '}');
    }
    gprojx_json_close(j, ']');
}

static gproj_code write_report(tool *t, FILE *file) {
    gprojx_json json = {file, 0, false, false}, *j = &json;
    const gprojx_section *s = &t->section;
    int k;
    gprojx_json_open(j, NULL, '{');
    gprojx_json_string(j, "version", GPROJ_VERSION);
    gprojx_json_string(j, "input", t->input);
    gprojx_json_integer(j, "beams_an_edge", t->pieces);
    gprojx_json_number(j, "scale", t->scale);
    gprojx_json_open(j, "section", '{');
    gprojx_json_string(j, "kind", t->section_text);
    gprojx_json_number(j, "area", s->area);
    gprojx_json_number(j, "iy", s->iy), gprojx_json_number(j, "iz", s->iz);
    gprojx_json_number(j, "torsion", s->torsion);
    gprojx_json_number(j, "wy", s->wy), gprojx_json_number(j, "wz", s->wz);
    gprojx_json_close(j, '}');
    gprojx_json_open_row(j, "material");
    gprojx_json_number(j, "young", t->material.young), gprojx_json_number(j, "shear", t->material.shear);
    gprojx_json_number(j, "density", t->material.density), gprojx_json_number(j, "yield", t->material.yield);
    gprojx_json_close(j, '}');
    report_sums(t, j);
    if (t->forces) {
        gprojx_json_open_row(j, "form");
        gprojx_json_integer(j, "edges", t->comparison.edges);
        gprojx_json_number(j, "unit", t->comparison.unit);
        gprojx_json_number(j, "correlation", t->comparison.correlation);
        gprojx_json_number(j, "max_force", t->comparison.largest);
        gprojx_json_number(j, "max_difference", t->comparison.difference);
        gprojx_json_close(j, '}');
    }
    if (!t->skip_buckling) gprojx_json_open(j, "buckling", '[');
    for (k = 0; k < GPROJX_WANTED && !t->skip_buckling; ++k) {
        gprojx_json_open_row(j, NULL);
        gprojx_json_number(j, "factor", t->buckling.factor[k]);
        gprojx_json_number(j, "residual", t->buckling.residual[k]);
        gprojx_json_close(j, '}');
    }
    if (!t->skip_buckling) gprojx_json_close(j, ']');
    report_lists(t, j);
    gprojx_json_close(j, '}');
    fputc('\n', file);
    return GPROJ_OK;
}

static bool fail_output(tool *t, const gprojx_output *output, const gproj_error *error) {
    return fail(t, error->code == GPROJ_ERROR_MEMORY ? EXIT_MEMORY : EXIT_REFUSED, "the output '%s' %s", output->path,
                error->message);
}

/* Refuses to write over a file that this run reads. */
static bool keep_apart(tool *t, const gprojx_output *output, const char *path) {
    char *real = path && !output->device ? realpath(path, NULL) : NULL;
    bool same = real && strcmp(real, output->target) == 0;
    free(real);
    return !same || fail(t, EXIT_USAGE, "the output '%s' would overwrite the input '%s'", output->path, path);
}

static bool prepare_outputs(tool *t) {
    gproj_error error;
    int i, k;
    for (i = 0; i < OUTPUT_COUNT; ++i) {
        gprojx_output *output = &t->output[i];
        if (!output->path) continue;
        if (!gprojx_output_prepare(output, &error)) return fail_output(t, output, &error);
        if (!keep_apart(t, output, t->input) || !keep_apart(t, output, t->loads) || !keep_apart(t, output, t->forces))
            return false;
        for (k = 0; t->support[k].which; ++k)
            if (!keep_apart(t, output, t->support[k].which)) return false;
    }
    return true;
}

/* All outputs are complete on the disk before the first is put in its place. */
static bool write_outputs(tool *t) {
    static gproj_code (*const write[OUTPUT_COUNT])(tool * t, FILE * file) = {draw, write_report};
    gproj_error error;
    int i;
    for (i = 0; i < OUTPUT_COUNT; ++i) {
        gprojx_output *output = &t->output[i];
        FILE *file = output->path ? gprojx_output_open(output, &error) : NULL;
        if (output->path && !(file && gprojx_output_close(output, file, write[i](t, file), &error)))
            return fail_output(t, output, &error);
    }
    return gprojx_outputs_place(t->output, OUTPUT_COUNT, &error) || fail_output(t, &t->output[error.index], &error);
}

/* ---- the summary ---- */

/* Prints a quantity with the prefix k, M or G that it asks for, or m. */
static const char *amount(double value, const char *unit, char text[32]) {
    static const struct {
        double size;
        const char *prefix;
    } prefixes[] = {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}};
    int k;
    for (k = 0; k < 4 && fabs(value) < prefixes[k].size; ++k) continue;
    if (!(fabs(value) > 0)) k = 3;
    snprintf(text, 32, "%.4g %s%s", value / prefixes[k].size, prefixes[k].prefix, unit);
    return text;
}

static void print_edge(const tool *t, const char *name, double value, const char *unit, int32_t e) {
    char text[32];
    printf("%-14sat most %s, between vertices %ld and %ld\n", name, amount(value, unit, text),
           (long)t->mesh->origin[2 * e], (long)t->mesh->origin[2 * e + 1]);
}

static void print_buckling(const tool *t) {
    const gprojx_buckling *b = &t->buckling;
    if (t->skip_buckling) return;
    if (!(b->factor[0] < INFINITY))
        puts("buckling      never under these loads, however large");
    else if (!b->converged)
        printf("buckling      no factor found in %d rounds; the last was %.6g, to %.0e of it\n", GPROJX_ROUNDS,
               b->factor[0], b->residual[0]);
    else
        printf(
            "buckling      if all loads are %.6g times as large (exact to %.0e of it); the next factors are %.6g and "
            "%.6g\n",
            b->factor[0], b->residual[0], b->factor[1], b->factor[2]);
}

static void print_comparison(const tool *t) {
    const tool_comparison *c = &t->comparison;
    char unit[32];
    if (!isfinite(c->correlation))
        puts("form          axial forces here or in the form are the same in all edges: no correlation");
    else
        printf(
            "form          axial forces correlate by %.4f with those of the form; the largest difference is %.3g %% of "
            "the largest, between vertices %ld and %ld (1 is %s)\n",
            c->correlation, 100 * c->difference, (long)t->mesh->origin[2 * c->worst],
            (long)t->mesh->origin[2 * c->worst + 1], amount(c->unit, "N", unit));
}

static void print_summary(const tool *t) {
    const tool_extremes *x = &t->extremes;
    int32_t supports = 0, v, k;
    char a[32], b[32];
    double sum = 0, difference = 0;
    for (v = 0; v < t->mesh->vertex_count; ++v) supports += is_support(t, v);
    for (k = 0; k < 3; ++k) {
        double load = x->load[k] - (k == 2 ? x->weight : 0);
        sum += load * load, difference += pow(load + x->reaction[k], 2);
    }
    gprojx_print_plain(stdout, file_name(t->input));
    printf(": %ld vertices, %ld edges as beams of %s m, %ld supports\n", (long)t->mesh->vertex_count,
           (long)t->mesh->edge_count, t->section_text, (long)supports);
    printf("loads         own weight %s, at vertices %s in all\n", amount(x->weight, "N", a),
           amount(gprojx_length3(x->load), "N", b));
    printf("reactions     at most %s, at vertex %ld; their sum is that of the loads to %.0e\n",
           amount(reaction(t, x->pressed), "N", a), (long)x->pressed, sum > 0 ? sqrt(difference / sum) : 0);
    printf("displacement  at most %s, at vertex %ld\n", amount(displacement(t, x->moved), "m", a), (long)x->moved);
    printf("axial forces  %s compression to %s tension; %ld edges in tension\n",
           amount(t->edge[x->compressed].compression, "N", a), amount(fmax(0, -t->edge[x->pulled].compression), "N", b),
           (long)x->in_tension);
    print_edge(t, "bending", t->edge[x->bent].bending, "N m", x->bent);
    print_edge(t, "torsion", t->edge[x->twisted].torsion, "N m", x->twisted);
    printf("utilisation   at most %.3g %% of the yield stress %s, between vertices %ld and %ld\n",
           100 * t->edge[x->used].utilisation, amount(t->material.yield, "Pa", a), (long)t->mesh->origin[2 * x->used],
           (long)t->mesh->origin[2 * x->used + 1]);
    printf("Euler loads   at most %.3g %% of an edge's own is reached, between vertices %ld and %ld\n",
           100 * t->edge[x->near_euler].euler_share, (long)t->mesh->origin[2 * x->near_euler],
           (long)t->mesh->origin[2 * x->near_euler + 1]);
    if (t->forces) print_comparison(t);
    print_buckling(t);
}

/* ---- main ---- */

int main(int argc, char **argv) {
    tool t;
    memset(&t, 0, sizeof t);
    t.section = gprojx_section_box(0.1, 0.1, 0.005), t.section_text = "box:0.1,0.1,0.005";
    t.material.young = 210e9, t.material.shear = 81e9, t.material.density = 7850, t.material.yield = 235e6;
    t.gravity = 9.81, t.pieces = 2;
    gprojx_watch_signals(t.output, OUTPUT_COUNT);
    if (read_command_line(&t, argc, argv)) {
        if (t.help)
            print_help();
        else if (prepare_outputs(&t) && make_frame(&t) && analyse(&t) && write_outputs(&t) && !t.quiet)
            print_summary(&t);
        if ((fflush(stdout) != 0 || ferror(stdout)) && t.exit_code == 0)
            fail(&t, EXIT_REFUSED, "standard output cannot be written");
    }
    gprojx_outputs_discard(t.output, OUTPUT_COUNT, "frame");
    gprojx_frame_destroy(&t.frame);
    gproj_mesh_destroy(t.mesh);
    free(t.edge), free(t.axial), free(t.form_load), free(t.buckling.shape);
    return t.exit_code;
}
