/* page.c - the C side of the interactive page: one mesh, one form and one drag, behind functions that take and give
   numbers. worker.js calls them; texts and arrays go through one block of memory, see page_block.

   Coordinates that go to the page and come from it are relative: (position - centre) / radius of the opened mesh, of its
   vertices with a face. */
#define GPROJ_STATIC
#define GPROJ_NO_STDIO
#include "../../guidedproj.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EXPORT(name) __attribute__((export_name(#name)))
__attribute__((import_module("page"), import_name("now"))) double page_now(void); /* seconds */

/* What must hold and what is wished, in the order of `rules` in page.js. */
typedef enum rule {
    PLANAR,
    CIRCULAR,
    CONICAL,
    EQUAL_LENGTHS,
    EQUILIBRIUM,
    COMPRESSION,
    TENSION,
    FIXED_BOUNDARY,
    FIXED_CORNERS,
    GLIDING,
    LIFTING,
    ORTHOGONAL,
    VOLUME,  /* the weight is a factor: of the opened mesh's volume */
    LONGEST, /* the weight is a factor: edges are at most so many times the opened mesh's mean edge */
    FIXED,   /* the vertices in page.is_fixed, at the places where they were fixed */
    FAIRNESS,
    CLOSENESS,
    REFERENCE,
    TANGENTIAL,
    GAUSS,
    EQUAL_AREAS,
    PARALLELOGRAMS,
    FORCE_FAIRNESS,
    RULES
} rule;

/* What the colours tell, in the order of `colours` in page.js. */
typedef enum tale {
    TELL_PLANARITY,
    TELL_FORCES,
    TELL_BENDS,
    TELL_LENGTHS
} tale;

enum {
    HISTORY = 512
};

static struct {
    gproj_mesh *mesh;
    double *original; /* positions as they were opened: what "fixed" and "close" refer to */
    struct {
        double volume, edge, longest; /* its mean edge and its longest one */
        gproj_surface *surface;       /* made with the form */
    } opened;                         /* the mesh as it was opened */
    gproj_form *form;
    bool stale; /* the form has a number that cannot be changed: it is to be made anew */
    gproj_drag *drag;
    double weight[RULES];
    int32_t group[RULES]; /* -1: the form does not have it yet */
    double number[RULES]; /* the weight with which it was added */
    double *is_fixed;     /* a weight for each vertex: 0 or 1 */
    double *fixed_at;     /* 3 for each vertex */
    double centre[3], radius;
    double residual, handle[3]; /* of a drag: after the last move, and where its handle has been led */
    bool held;                  /* the handle goes no farther */
    double *before;             /* positions before a move */
    gproj_result result;
    struct {
        double epsilon;          /* 0: it follows the residual */
        double history[HISTORY]; /* the residual after each iteration */
        int32_t steps;           /* how many of these there are */
    } course;                    /* of the last solve or release */
    tale tale;
    char sentence[GPROJ_MESSAGE_SIZE];
    void *block;
    size_t block_size;
} page;

/* A handle is held where another vertex would move so much farther than it. */
static const double HELD = 8;

static const gproj_error no_memory = {.code = GPROJ_ERROR_MEMORY, .message = "there is not enough memory"};

static double now(void *user) { return (void)user, page_now(); }
static const gproj_host host = {.clock = {now, NULL}};

/* Copies the sentence of an error; false, so that callers may return it. */
static bool refuse(const char *sentence) {
    size_t size = strlen(sentence);
    memcpy(page.sentence, sentence, size + 1);
    return false;
}

/* The block of memory that arrays and texts go through, with room for `size` bytes; what it held is lost. */
void *EXPORT(page_block) page_block(size_t size) {
    if (size <= page.block_size) return page.block;
    free(page.block);
    page.block = malloc(size);
    page.block_size = page.block ? size : 0;
    return page.block;
}

const char *EXPORT(page_sentence) page_sentence(void) { return page.sentence; }

/* -- meshes -- */

static double distance(const double *a, const double *b) {
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}
static double edge_length(int32_t e) {
    const gproj_mesh *mesh = page.mesh;
    return distance(mesh->position + 3 * mesh->origin[2 * e], mesh->position + 3 * mesh->origin[2 * e + 1]);
}

/* Takes the place of the mesh before. */
static void adopt(gproj_mesh *mesh, double *original, double *fixed_at, double *before, double *is_fixed) {
    size_t bytes = 3 * sizeof *original * (size_t)mesh->vertex_count;
    double low[3], high[3];
    gproj_drag_cancel(page.drag);
    gproj_form_destroy(page.form);
    gproj_surface_destroy(page.opened.surface);
    gproj_mesh_destroy(page.mesh);
    free(page.original), free(page.is_fixed), free(page.fixed_at), free(page.before);
    page.mesh = mesh, page.original = original, page.is_fixed = is_fixed, page.fixed_at = fixed_at,
    page.before = before;
    page.form = NULL, page.drag = NULL, page.opened.surface = NULL;
    page.weight[FIXED] = 0;
    page.course.steps = 0;
    memset(&page.result, 0, sizeof page.result);
    memcpy(original, mesh->position, bytes);
    memcpy(fixed_at, mesh->position, bytes);
    for (int k = 0; k < 3; ++k) {
        low[k] = INFINITY, high[k] = -INFINITY;
        for (int32_t v = 0; v < mesh->vertex_count; ++v) {
            if (mesh->vertex_halfedge[v] < 0) continue; /* not seen, and maybe far away */
            low[k] = fmin(low[k], original[3 * v + k]);
            high[k] = fmax(high[k], original[3 * v + k]);
        }
        page.centre[k] = (low[k] + high[k]) / 2;
    }
    page.radius = distance(high, low) / 2;
    if (!(page.radius > 0)) page.radius = 1;
    page.opened.volume = gproj_volume(mesh);
    page.opened.edge = gproj_mesh_mean_edge_length(mesh);
    page.opened.longest = 0;
    for (int32_t e = 0; e < mesh->edge_count; ++e) page.opened.longest = fmax(page.opened.longest, edge_length(e));
}

/* Fills the first closed polyline of a mesh without faces, else its first one, with quads. Corners are found, or `corners`
   points at equal numbers. */
static gproj_mesh *fill(const gproj_mesh *curve, int32_t corners, gproj_error *error) {
    const int32_t *start = curve->polyline_start, *vertex = curve->polyline_vertex;
    int32_t which = 0, count, *corner = NULL, at;
    while (which < curve->polyline_count && vertex[start[which]] != vertex[start[which + 1] - 1]) ++which;
    if (which == curve->polyline_count) which = 0;
    vertex += start[which], count = start[which + 1] - start[which];
    double *point = malloc(3 * sizeof *point * (size_t)(count + 1));
    gproj_fill_options options = {0};
    gproj_mesh *mesh = NULL;
    if (count > 1 && vertex[0] == vertex[count - 1]) --count;
    if (corners > 2 && corners <= count) corner = malloc(sizeof *corner * (size_t)corners);
    for (at = 0; point && at < count; ++at) memcpy(point + 3 * at, curve->position + 3 * vertex[at], 3 * sizeof *point);
    for (at = 0; corner && at < corners; ++at) corner[at] = (int32_t)((int64_t)at * count / corners);
    options.corner_count = corner ? corners : 0, options.corners = corner;
    if (point)
        mesh = gproj_mesh_fill(count, point, &options, NULL, &host, error);
    else
        *error = no_memory;
    free(point), free(corner);
    return mesh;
}

/* Pulls the vertex nearest to the middle up by `height`; the others follow as fairness has it. */
static void lift(gproj_mesh *mesh, double height) {
    double middle[3] = {0, 0, 0}, target[3], least = INFINITY;
    gproj_form *form = gproj_form_create(mesh, &host);
    int32_t nearest = 0;
    for (int32_t v = 0; v < mesh->vertex_count; ++v)
        for (int k = 0; k < 3; ++k) middle[k] += mesh->position[3 * v + k] / mesh->vertex_count;
    for (int32_t v = 0; v < mesh->vertex_count; ++v) {
        double away = distance(mesh->position + 3 * v, middle);
        if (away < least) nearest = v, least = away;
    }
    memcpy(target, mesh->position + 3 * nearest, sizeof target);
    target[2] += height;
    gproj_add_targets(form, 1, &nearest, target, 1);
    gproj_add_fixed_boundary(form, 1);
    gproj_add_fairness(form, 0.3);
    gproj_add_closeness(form, 0.01);
    gproj_solve(form, 10, NULL);
    gproj_form_destroy(form);
}

/* Reads the text in the block; then a curve is filled, the mesh along the diagonals taken, a cage subdivided, a plan
   lifted. */
static gproj_mesh *read(size_t size, int32_t corners, bool diagonals, int32_t levels, double height,
                        gproj_error *error) {
    gproj_mesh *mesh = gproj_mesh_read(page.block, size, GPROJ_FORMAT_DETECT, &host, error);
    if (mesh && mesh->face_count == 0 && mesh->polyline_count > 0) {
        gproj_mesh *filled = fill(mesh, corners, error);
        gproj_mesh_destroy(mesh);
        mesh = filled;
    }
    if (mesh && diagonals) {
        gproj_mesh *along = gproj_mesh_diagonals(mesh, &host, error);
        gproj_mesh_destroy(mesh);
        mesh = along;
    }
    if (mesh && levels > 0) {
        gproj_subdivide_options options = {.levels = levels};
        gproj_mesh *fine = gproj_mesh_subdivide(mesh, &options, NULL, &host, error);
        gproj_mesh_destroy(mesh);
        mesh = fine;
    }
    if (mesh && height > 0) lift(mesh, height);
    return mesh;
}

/* Opens the text of `size` bytes in the block, OBJ or OFF; see read(). False: page_sentence says why, and the mesh
   before stays. */
bool EXPORT(page_open) page_open(size_t size, int32_t corners, bool diagonals, int32_t levels, double height) {
    gproj_error error;
    gproj_mesh *mesh = read(size, corners, diagonals, levels, height, &error);
    double *original, *fixed_at, *before, *is_fixed;
    if (!mesh) return refuse(error.message);
    original = malloc(3 * sizeof *original * (size_t)mesh->vertex_count);
    fixed_at = malloc(3 * sizeof *fixed_at * (size_t)mesh->vertex_count);
    before = malloc(3 * sizeof *before * (size_t)mesh->vertex_count);
    is_fixed = calloc((size_t)mesh->vertex_count, sizeof *is_fixed);
    if (!original || !fixed_at || !before || !is_fixed || mesh->face_count == 0) {
        bool enough = original && fixed_at && before && is_fixed;
        free(original), free(fixed_at), free(before), free(is_fixed);
        gproj_mesh_destroy(mesh);
        return refuse(enough ? "the file has no faces" : gproj_code_string(GPROJ_ERROR_MEMORY));
    }
    adopt(mesh, original, fixed_at, before, is_fixed);
    return true;
}

int32_t EXPORT(page_vertices) page_vertices(void) { return page.mesh->vertex_count; }
int32_t EXPORT(page_edges) page_edges(void) { return page.mesh->edge_count; }
int32_t EXPORT(page_faces) page_faces(void) { return page.mesh->face_count; }

/* Has a face no corner of more than 180 degrees, as seen along its vectorial area? */
static bool is_convex(const gproj_mesh *mesh, int32_t f) {
    int32_t h = mesh->face_halfedge[f];
    double n[3], size;
    gproj_mesh_face_area_vector(mesh, f, n);
    size = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    for (int32_t k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
        const double *a = mesh->position + 3 * mesh->origin[mesh->prev[h]], *b = mesh->position + 3 * mesh->origin[h],
                     *c = mesh->position + 3 * mesh->origin[mesh->next[h]];
        double turn = 0;
        for (int i = 0; i < 3; ++i) {
            int u = (i + 1) % 3, v = (i + 2) % 3;
            turn += n[i] * ((b[u] - a[u]) * (c[v] - b[v]) - (b[v] - a[v]) * (c[u] - b[u]));
        }
        if (turn < -1e-9 * size) return false;
    }
    return true;
}

/* The faces cut into triangles where they are not convex, as far as they can be. NULL: all are convex, or no memory. */
static gproj_edit *cut_faces(const gproj_mesh *mesh) {
    gproj_edit *edit = NULL;
    for (int32_t f = 0; f < mesh->face_count; ++f) {
        if (is_convex(mesh, f)) continue;
        if (!edit) edit = gproj_edit_create(mesh, &host, NULL);
        if (edit) gproj_edit_triangulate(edit, f, NULL);
    }
    return edit;
}

/* Fills the block with pairs of uint32: for each corner of triangles its vertex and its face, then for each edge
   its two ends. A triangle fan for each convex face. Returns the number of triangles, 0 without memory. */
int32_t EXPORT(page_topology) page_topology(void) {
    const gproj_mesh *mesh = page.mesh;
    gproj_edit *edit = cut_faces(mesh);
    const int32_t *first = edit ? edit->face_halfedge : mesh->face_halfedge, *next = edit ? edit->next : mesh->next,
                  *origin = edit ? edit->origin : mesh->origin, *degree = edit ? edit->face_degree : mesh->face_degree;
    int32_t faces = edit ? edit->face_count : mesh->face_count, triangles = 0;
    uint32_t *out;
    for (int32_t f = 0; f < faces; ++f) triangles += degree[f] - 2;
    out = page_block(sizeof *out * 2 * (3 * (size_t)triangles + (size_t)mesh->edge_count));
    for (int32_t f = 0; out && f < faces; ++f) {
        int32_t h = next[first[f]], face = edit ? edit->face_parent[f] : f;
        for (int32_t k = 2; k < degree[f]; ++k, h = next[h]) {
            int32_t corner[3] = {first[f], h, next[h]};
            for (int c = 0; c < 3; ++c) *out++ = (uint32_t)origin[corner[c]], *out++ = (uint32_t)face;
        }
    }
    for (int32_t h = 0; out && h < mesh->halfedge_count; ++h) *out++ = (uint32_t)mesh->origin[h];
    gproj_edit_destroy(edit);
    return out ? triangles : 0;
}

/* The boundary and fixed vertices, one byte each in the block: 1 on the boundary, 2 fixed by hand. */
bool EXPORT(page_marks) page_marks(void) {
    uint8_t *out = page_block((size_t)page.mesh->vertex_count);
    for (int32_t v = 0; out && v < page.mesh->vertex_count; ++v)
        out[v] = (uint8_t)(gproj_mesh_is_boundary_vertex(page.mesh, v) + 2 * (page.is_fixed[v] > 0));
    return out != NULL;
}

/* The vertices fixed by hand, in the block, as 5 doubles each: number, x, y, z in the mesh's units, and whether that is
   another place than in the file. Returns how many there are. */
int32_t EXPORT(page_pins) page_pins(void) {
    int32_t count = 0, v;
    double *out;
    for (v = 0; v < page.mesh->vertex_count; ++v) count += page.is_fixed[v] > 0;
    out = page_block(5 * sizeof *out * (size_t)(count + 1));
    for (v = 0; out && v < page.mesh->vertex_count; ++v) {
        if (!(page.is_fixed[v] > 0)) continue;
        *out++ = v;
        memcpy(out, page.fixed_at + 3 * v, 3 * sizeof *out);
        out[3] = memcmp(out, page.original + 3 * v, 3 * sizeof *out) != 0;
        out += 4;
    }
    return out ? count : 0;
}

/* Planarity in 0..1, from 1e-4 to 1e-2 mean edge lengths by the logarithm. */
static void tell_planarity(float *face, double *work) {
    gproj_measure_planarity(page.mesh, work, NULL);
    for (int32_t f = 0; f < page.mesh->face_count; ++f)
        face[f] = (float)fmin(1, fmax(0, (log10(fmax(work[f], 1e-9)) + 4) / 2));
}

/* The largest angle with a neighbour, which is the longest edge of the Gauss image at the face's normal; 1: 30
   degrees. */
static void tell_bends(float *face, double *work) {
    const gproj_mesh *mesh = page.mesh;
    const double full = 3.14159265358979 / 6;
    for (int32_t f = 0; f < mesh->face_count; ++f) {
        double *n = work + 3 * f, length;
        gproj_mesh_face_area_vector(mesh, f, n);
        length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; ++k) n[k] /= fmax(length, 1e-300);
        face[f] = 0;
    }
    for (int32_t h = 0; h < mesh->halfedge_count; h += 2) {
        int32_t a = mesh->face[h], b = mesh->face[h + 1];
        if (a < 0 || b < 0) continue;
        double angle = 2 * asin(fmin(1, distance(work + 3 * a, work + 3 * b) / 2));
        face[a] = fmaxf(face[a], (float)fmin(1, angle / full));
        face[b] = fmaxf(face[b], (float)fmin(1, angle / full));
    }
}

/* Axial forces over the largest one, > 0: compression. */
static void tell_forces(float *edge, double *work) {
    double largest = 0;
    int32_t edges = page.mesh->edge_count;
    memset(work, 0, sizeof *work * (size_t)edges);
    if (page.form && page.weight[EQUILIBRIUM] > 0) gproj_get_forces(page.form, work, NULL);
    for (int32_t e = 0; e < edges; ++e) {
        work[e] *= edge_length(e);
        largest = fmax(largest, fabs(work[e]));
    }
    for (int32_t e = 0; e < edges; ++e) edge[e] = (float)(largest > 0 ? work[e] / largest : 0);
}

/* Fills the block with floats: for each vertex x, y, z (relative) and 0; for each face and for each edge a number
   for its colour: faces have 0..1 where planarity or bends are told, edges -1..1 where forces are told, and where
   lengths are told their part of the longest one that is allowed, or was there at first. All others are 0. */
bool EXPORT(page_frame) page_frame(void) {
    const gproj_mesh *mesh = page.mesh;
    size_t vertices = (size_t)mesh->vertex_count, faces = (size_t)mesh->face_count, edges = (size_t)mesh->edge_count;
    size_t floats = 4 * vertices + faces + edges, most = 3 * faces > edges ? 3 * faces : edges;
    float *out = page_block(sizeof *out * floats + sizeof(double) * (most + 1)), *face, *edge;
    double *work;
    if (!out) return false;
    work = (double *)(((uintptr_t)(out + floats) + 7) & ~(uintptr_t)7);
    face = out + 4 * vertices, edge = face + faces;
    memset(face, 0, sizeof *face * (faces + edges));
    for (size_t v = 0; v < vertices; ++v) {
        for (size_t k = 0; k < 3; ++k)
            out[4 * v + k] = (float)((mesh->position[3 * v + k] - page.centre[k]) / page.radius);
        out[4 * v + 3] = 0;
    }
    switch (page.tale) {
    case TELL_PLANARITY: tell_planarity(face, work); break;
    case TELL_BENDS: tell_bends(face, work); break;
    case TELL_FORCES: tell_forces(edge, work); break;
    case TELL_LENGTHS: {
        double full = page.weight[LONGEST] > 0 ? page.weight[LONGEST] * page.opened.edge : page.opened.longest;
        for (size_t e = 0; e < edges; ++e) edge[e] = (float)(edge_length((int32_t)e) / full);
    }
    }
    return true;
}

/* What the colours tell from now on. */
void EXPORT(page_tell) page_tell(int32_t which) { page.tale = (tale)which; }

static bool append(void *user, const char *text, size_t size) {
    size_t *used = user;
    if (*used + size > page.block_size) {
        char *more = realloc(page.block, 2 * (*used + size));
        if (!more) return false;
        page.block = more, page.block_size = 2 * (*used + size);
    }
    memcpy((char *)page.block + *used, text, size);
    *used += size;
    return true;
}

/* Writes the mesh as it is to the block; returns the size of the text, 0 without memory. */
size_t EXPORT(page_write) page_write(bool off) {
    size_t used = 0;
    gproj_code code = gproj_mesh_write(page.mesh, off ? GPROJ_FORMAT_OFF : GPROJ_FORMAT_OBJ, append, &used, NULL);
    return code == GPROJ_OK ? used : 0;
}

/* What undo needs, in the block: positions, then force densities, all doubles. Returns their number, 0 without
   memory. */
int32_t EXPORT(page_snapshot) page_snapshot(void) {
    size_t count = 3 * (size_t)page.mesh->vertex_count, edges = (size_t)page.mesh->edge_count;
    double *out = page_block(sizeof *out * (count + edges));
    if (!out) return 0;
    memcpy(out, page.mesh->position, sizeof *out * count);
    memset(out + count, 0, sizeof *out * edges);
    if (page.form) gproj_get_forces(page.form, out + count, NULL);
    return (int32_t)(count + edges);
}

/* Goes back to the snapshot in the block. */
void EXPORT(page_restore) page_restore(void) {
    size_t count = 3 * (size_t)page.mesh->vertex_count;
    const double *in = page.block, *force = in + count;
    bool forces = false;
    gproj_drag_cancel(page.drag);
    page.drag = NULL;
    memcpy(page.mesh->position, in, sizeof *in * count);
    for (int32_t e = 0; e < page.mesh->edge_count; ++e) forces = forces || force[e] != 0;
    if (page.form && page.group[EQUILIBRIUM] >= 0) gproj_set_forces(page.form, forces ? force : NULL, NULL);
}

/* -- what must hold, what is wished -- */

/* A weight, 0: off. */
void EXPORT(page_set) page_set(int32_t which, double weight) {
    bool number = which == VOLUME || which == LONGEST; /* which its group cannot change */
    if (which < 0 || which >= RULES || which == FIXED) return;
    if (number && weight > 0 && page.form && page.group[which] >= 0 && page.number[which] != weight) page.stale = true;
    page.weight[which] = weight;
}

/* The regularisation of the steps of solves; 0: it follows the residual. */
void EXPORT(page_epsilon) page_epsilon(double epsilon) { page.course.epsilon = epsilon; }

/* Fixes a vertex by hand where it is, or frees it. */
void EXPORT(page_fix) page_fix(int32_t vertex, bool fixed) {
    if (vertex < 0 || vertex >= page.mesh->vertex_count) return;
    page.is_fixed[vertex] = fixed;
    memcpy(page.fixed_at + 3 * vertex, page.mesh->position + 3 * vertex, 3 * sizeof *page.fixed_at);
    page.weight[FIXED] = 0;
    for (int32_t v = 0; v < page.mesh->vertex_count; ++v)
        page.weight[FIXED] = fmax(page.weight[FIXED], page.is_fixed[v]);
}

/* Equilibrium under the weight of the panels; the boundary carries, and vertices fixed by hand where there is none. */
static int32_t add_equilibrium(void) {
    const gproj_mesh *mesh = page.mesh;
    gproj_loads loads = {.area_load = 1};
    int32_t *list = malloc(sizeof *list * (size_t)mesh->vertex_count), group = -1;
    gproj_supports supports = {0, list, NULL};
    if (!list) return -1;
    for (int32_t v = 0; v < mesh->vertex_count; ++v)
        if (mesh->loop_count > 0 ? gproj_mesh_is_boundary_vertex(mesh, v) : page.is_fixed[v] > 0)
            list[supports.count++] = v;
    group = gproj_add_equilibrium(page.form, &loads, &supports, 1);
    free(list);
    return group;
}

static int32_t add_fixed(void) {
    int32_t count = page.mesh->vertex_count, *list = malloc(sizeof *list * (size_t)count), group;
    if (!list) return -1;
    for (int32_t v = 0; v < count; ++v) list[v] = v;
    group = gproj_add_targets(page.form, count, list, page.fixed_at, 1);
    free(list);
    return group;
}

static int32_t add_rule(rule which) {
    gproj_form *form = page.form;
    int32_t edges = page.mesh->edge_count;
    switch (which) {
    case PLANAR: return gproj_add_planarity(form, 1);
    case CIRCULAR: return gproj_add_circularity(form, 1);
    case CONICAL: return gproj_add_conicality(form, 1);
    case EQUAL_LENGTHS: return gproj_add_equal_lengths(form, edges, NULL, 1);
    case EQUILIBRIUM: return add_equilibrium();
    case COMPRESSION: return gproj_add_compression(form, edges, NULL, 1);
    case TENSION: return gproj_add_tension(form, edges, NULL, 1);
    case FIXED_BOUNDARY: return gproj_add_fixed_boundary(form, 1);
    case FIXED_CORNERS: return gproj_add_fixed_corners(form, 1);
    case GLIDING: return gproj_add_gliding_boundary(form, 1);
    case LIFTING: return gproj_add_lifting(form, 1);
    case ORTHOGONAL: return gproj_add_orthogonal_boundary(form, 1);
    case VOLUME: return gproj_add_volume(form, page.weight[VOLUME] * page.opened.volume, 1);
    case LONGEST: return gproj_add_length_bounds(form, edges, NULL, 0, page.weight[LONGEST] * page.opened.edge, 1);
    case FIXED: return add_fixed();
    case FAIRNESS: return gproj_add_fairness(form, 1);
    case CLOSENESS: return gproj_add_closeness(form, 1);
    case REFERENCE: return gproj_add_reference(form, page.opened.surface, 1);
    case TANGENTIAL: return gproj_add_tangential_fairness(form, 1);
    case GAUSS: return gproj_add_gauss_fairness(form, 1);
    case EQUAL_AREAS: return gproj_add_equal_areas(form, 1);
    case PARALLELOGRAMS: return gproj_add_parallelograms(form, 1);
    case FORCE_FAIRNESS: return gproj_add_force_fairness(form, 1);
    case RULES: break;
    }
    return -1;
}

/* Exchanges the mesh's positions with those that it was opened with. */
static void exchange(void) {
    for (int32_t k = 0; k < 3 * page.mesh->vertex_count; ++k) {
        double present = page.mesh->position[k];
        page.mesh->position[k] = page.original[k], page.original[k] = present;
    }
}

/* Makes the form, from the mesh as it was opened; forces of the form before stay. */
static bool renew(void) {
    size_t edges = (size_t)page.mesh->edge_count;
    double *force = calloc(edges + 1, sizeof *force);
    bool forces = false;
    if (!force) return false;
    if (page.form && page.stale) gproj_get_forces(page.form, force, NULL);
    for (size_t e = 0; e < edges; ++e) forces = forces || force[e] != 0;
    gproj_form_destroy(page.form);
    exchange();
    page.form = gproj_form_create(page.mesh, &host);
    if (!page.opened.surface) page.opened.surface = gproj_surface_create(page.mesh, &host, NULL);
    exchange();
    page.stale = false;
    for (int k = 0; k < RULES; ++k) page.group[k] = -1;
    if (forces && page.weight[EQUILIBRIUM] > 0) {
        page.group[EQUILIBRIUM] = add_rule(EQUILIBRIUM);
        gproj_set_forces(page.form, force, NULL);
    }
    free(force);
    return page.form != NULL && page.opened.surface != NULL;
}

/* How much a rule weighs: what must hold always, wishes at first, as the command line has it. */
static gproj_schedule schedule_of(int k) {
    if (k >= FAIRNESS) return gproj_fade(page.weight[k], page.weight[EQUILIBRIUM] > 0 ? 9 : 6);
    return gproj_keep(k == VOLUME || k == LONGEST ? page.weight[k] > 0 : page.weight[k]);
}

/* Gives the form all groups that have a weight, and all groups their weights. A group stays once it is there, so a new
   weight costs nothing; a form that has met an error is made anew. False: the sentence says why. */
static bool prepare(void) {
    if (!page.form || page.stale || gproj_form_error(page.form)->code != GPROJ_OK)
        if (!renew()) return refuse(gproj_code_string(GPROJ_ERROR_MEMORY));
    for (int k = 0; k < RULES; ++k) {
        if (page.weight[k] > 0 && page.group[k] < 0) {
            page.group[k] = add_rule((rule)k);
            page.number[k] = page.weight[k];
            if (page.group[k] < 0 && gproj_form_error(page.form)->code == GPROJ_OK) return refuse(no_memory.message);
        }
        if (page.group[k] >= 0) gproj_set_schedule(page.form, page.group[k], schedule_of(k));
    }
    if (page.group[FIXED] >= 0) {
        gproj_set_targets(page.form, page.group[FIXED], page.fixed_at);
        gproj_set_element_weights(page.form, page.group[FIXED], page.mesh->vertex_count, NULL, page.is_fixed);
    }
    if (gproj_form_error(page.form)->code != GPROJ_OK) return refuse(gproj_form_error(page.form)->message);
    return true;
}

/* -- solves and drags, in frames -- */

/* Begins a solve; page_step goes on with it. False: the sentence says why. */
bool EXPORT(page_solve) page_solve(int32_t iterations) {
    gproj_solve_options options = {.smooth = true, .epsilon = page.course.epsilon};
    gproj_error error;
    memset(&page.result, 0, sizeof page.result);
    page.course.steps = 0;
    if (!prepare()) return false;
    if (gproj_solve_begin(page.form, iterations, &options, &error)) return true;
    return refuse(error.message);
}

/* After a release that has not met what must hold: a solve without wishes goes on from there. */
static bool go_on(void) {
    gproj_solve_options options = {.smooth = true};
    if (page.result.outcome != GPROJ_ITERATION_LIMIT && page.result.outcome != GPROJ_STALLED) return false;
    for (int k = FAIRNESS; k < RULES; ++k) /* prepare() puts them on again */
        if (page.group[k] >= 0) gproj_set_schedule(page.form, page.group[k], gproj_keep(0));
    page.result.iterations = 0;
    return gproj_solve_begin(page.form, 60, &options, NULL);
}

/* Goes on for `seconds`, and one iteration at least, with the solve or the release that is on. Returns whether
   there is more to do; at the end the sentence is the verdict. */
bool EXPORT(page_step) page_step(double seconds) {
    double begun = page_now();
    while (gproj_solve_is_on(page.form)) {
        int32_t before = page.result.iterations;
        page.result = gproj_solve_advance(page.form, 0);
        if (page.result.iterations != before && page.course.steps < HISTORY) /* else the verdict alone was due */
            page.course.history[page.course.steps++] = page.result.residual;
        if (page_now() - begun >= seconds) break;
    }
    if (gproj_solve_is_on(page.form)) return true;
    if (page.drag) {
        page.result = gproj_drag_end(page.drag);
        page.drag = NULL;
        if (go_on()) return true;
    }
    refuse(page.result.message);
    return false;
}

/* Grabs a vertex with those within `reach`, relative. False: the sentence says why. */
bool EXPORT(page_grab) page_grab(int32_t vertex, double reach) {
    size_t vertices = (size_t)page.mesh->vertex_count;
    /* Closeness keeps a loose boundary in order at the release, too. */
    gproj_drag_options options = {.residual_bound = 0.01, .keep_wishes = page.weight[CLOSENESS] > 0};
    gproj_error error;
    int64_t start[2] = {0, 0};
    int32_t *list = malloc(sizeof *list * vertices);
    double *weight = malloc(sizeof *weight * vertices);
    page.residual = 0;
    if (!list || !weight) refuse(no_memory.message);
    if (list && weight && vertex >= 0 && vertex < page.mesh->vertex_count && prepare()) {
        gproj_handles handles = {1, start, list, weight, page.mesh->position + 3 * vertex};
        start[1] = gproj_find_reach(page.form, vertex, reach * page.radius, list, weight);
        page.drag = gproj_drag_begin(page.form, &handles, &options, &error);
        if (!page.drag) refuse(error.message);
        memcpy(page.handle, page.mesh->position + 3 * vertex, sizeof page.handle);
        page.held = false;
    }
    free(list), free(weight);
    return page.drag != NULL;
}

/* Leads the handle on by `way` along the unit vector `along`. Returns how far the vertex that moved most has
   moved; < 0: the sentence says why that was refused. */
static double lead(const double along[3], double way) {
    const gproj_mesh *mesh = page.mesh;
    double to[3], most = 0;
    memcpy(page.before, mesh->position, 3 * sizeof *page.before * (size_t)mesh->vertex_count);
    for (int k = 0; k < 3; ++k) to[k] = page.handle[k] + way * along[k];
    if (gproj_drag_move(page.drag, to) != GPROJ_OK) {
        refuse(gproj_drag_error(page.drag)->message);
        return -1;
    }
    memcpy(page.handle, to, sizeof to);
    for (int32_t v = 0; v < mesh->vertex_count; ++v)
        most = fmax(most, distance(mesh->position + 3 * v, page.before + 3 * v));
    return most;
}

/* What page_move says. */
enum {
    REFUSED,
    THERE,
    ON_THE_WAY
};

/* Moves the grabbed vertex towards a place, relative, for about a tenth of a second. The error grows with the
   square of what vertices move, so none moves by more than a quarter of an edge at once. A short probe tells how far
   the others would: where the handle hardly yields they would fly, and it is held. */
int32_t EXPORT(page_move) page_move(double x, double y, double z) {
    const double relative[3] = {x, y, z}, edge = gproj_mesh_mean_edge_length(page.mesh), begun = page_now();
    int again = 0;
    if (!page.drag) return REFUSED;
    page.held = false;
    while (page_now() - begun < 0.1) {
        int32_t linearised = gproj_drag_get_info(page.drag).linearisations;
        double along[3], way = 0, probe, most;
        for (int k = 0; k < 3; ++k) along[k] = relative[k] * page.radius + page.centre[k] - page.handle[k];
        for (int k = 0; k < 3; ++k) way += along[k] * along[k];
        way = sqrt(way);
        if (way <= 1e-9 * edge) { /* a move to where it is takes the error off */
            if (page.residual <= 0.03 || ++again > 5) return THERE;
            if (lead(along, 0) < 0) return REFUSED;
            page.residual = gproj_drag_residual(page.drag);
            continue;
        }
        for (int k = 0; k < 3; ++k) along[k] /= way;
        probe = fmin(way, 1e-3 * edge);
        most = lead(along, probe);
        if (most < 0) return REFUSED;
        if (gproj_drag_get_info(page.drag).linearisations == linearised) {
            page.held = most > HELD * probe;
            if (page.held && lead(along, -probe) < 0) return REFUSED;
            if (!page.held && way > probe &&
                lead(along, fmin(way - probe, 0.25 * edge * probe / fmax(most, 1e-6 * probe))) < 0)
                return REFUSED;
        }
        page.residual = gproj_drag_residual(page.drag);
        if (page.held) return THERE;
    }
    return ON_THE_WAY;
}

/* Does the grabbed vertex stay behind? */
bool EXPORT(page_held) page_held(void) {
    return page.held || gproj_drag_get_info(page.drag).behind > gproj_mesh_mean_edge_length(page.mesh) / 2;
}

/* Ends a drag where nothing must hold: a release would only fair what was led. */
static void leave(void) {
    size_t bytes = 3 * sizeof *page.before * (size_t)page.mesh->vertex_count;
    memcpy(page.before, page.mesh->position, bytes);
    gproj_drag_cancel(page.drag);
    page.drag = NULL;
    memcpy(page.mesh->position, page.before, bytes);
    memset(&page.result, 0, sizeof page.result);
    page.result.worst_group = -1;
    strcpy(page.result.message, "nothing must hold: the vertices stay where they were led");
}

/* Lets go: page_step goes on with the release. */
bool EXPORT(page_release) page_release(void) {
    page.course.steps = page.result.iterations = 0;
    for (int k = 0; k < FAIRNESS; ++k)
        if (page.weight[k] > 0) return gproj_drag_release(page.drag);
    leave();
    return true;
}

/* Ends what is on: a drag and its release go back to where they began, a solve stays where it is. */
void EXPORT(page_stop) page_stop(void) {
    if (page.drag) gproj_drag_cancel(page.drag);
    page.drag = NULL;
    gproj_solve_stop(page.form);
}

/* -- how it stands -- */

int32_t EXPORT(page_outcome) page_outcome(void) { return (int32_t)page.result.outcome; }
int32_t EXPORT(page_iterations) page_iterations(void) { return page.result.iterations; }
double EXPORT(page_residual) page_residual(void) { return page.drag ? page.residual : page.result.residual; }
int32_t EXPORT(page_spoiled) page_spoiled(void) { return page.result.spoiled.total; }

/* The residuals after the iterations of the last solve or release, page_steps numbers. */
const double *EXPORT(page_history) page_history(void) { return page.course.history; }
int32_t EXPORT(page_steps) page_steps(void) { return page.course.steps; }

/* The middle of an edge or a face, or a vertex, relative. False: there is no such element. */
static bool find_middle(gproj_place place, int32_t element, double out[3]) {
    const gproj_mesh *mesh = page.mesh;
    int32_t counts[] = {mesh->vertex_count, mesh->edge_count, mesh->face_count}, first, corners = 1;
    int kind = place == GPROJ_PLACE_VERTEX ? 0 : place == GPROJ_PLACE_EDGE ? 1 : place == GPROJ_PLACE_FACE ? 2 : -1;
    if (kind < 0 || element < 0 || element >= counts[kind]) return false;
    memset(out, 0, 3 * sizeof *out);
    first = kind == 2 ? mesh->face_halfedge[element] : 2 * element;
    if (kind == 1) corners = 2;
    if (kind == 2) corners = mesh->face_degree[element];
    for (int32_t c = 0, h = first; c < corners; ++c, h = kind == 2 ? mesh->next[h] : h + 1)
        for (int k = 0; k < 3; ++k) out[k] += mesh->position[3 * (kind == 0 ? element : mesh->origin[h]) + k] / corners;
    for (int k = 0; k < 3; ++k) out[k] = (out[k] - page.centre[k]) / page.radius;
    return true;
}

/* The element that the verdict names, in the block as 5 doubles: its middle, relative, what it is (0 vertex, 1
   edge, 2 face) and its number. That is the worst one, or, where all holds, the first one that is spoiled. False: it
   names none. */
bool EXPORT(page_named) page_named(void) {
    const gproj_result *r = &page.result;
    double *out = page_block(5 * sizeof *out);
    gproj_place place = r->spoiled.place;
    int32_t element = r->spoiled.element;
    if (!out || !page.form) return false;
    if (r->outcome != GPROJ_CONVERGED || r->spoiled.total == 0) {
        if (r->worst_group < 0) return false;
        place = gproj_form_group_info(page.form, r->worst_group).place, element = r->worst_element;
    }
    out[3] = place == GPROJ_PLACE_VERTEX ? 0 : place == GPROJ_PLACE_EDGE ? 1 : 2;
    out[4] = element;
    return find_middle(place, element, out);
}

/* The relative reach of `rings` mean edges. */
double EXPORT(page_reach) page_reach(double rings) {
    return rings * gproj_mesh_mean_edge_length(page.mesh) / page.radius;
}

/* The mean edge of the mesh as it was opened, in its own units. */
double EXPORT(page_mean_edge) page_mean_edge(void) { return page.opened.edge; }
