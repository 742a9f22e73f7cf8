/* page.c - the C side of the interactive page: one mesh, one form and one drag, behind functions that take and give
   numbers. worker.js calls them; texts and arrays go through one block of memory, see page_block.

   Coordinates that go to the page and come from it are relative: (position - centre) / radius of the opened mesh. */
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
    FIXED, /* the vertices in page.is_fixed, at the places where they were fixed */
    FAIRNESS,
    CLOSENESS,
    TANGENTIAL,
    EQUAL_AREAS,
    RULES
} rule;

static struct {
    gproj_mesh *mesh;
    double *original; /* positions as they were read: what "fixed" and "close" refer to */
    gproj_form *form;
    gproj_drag *drag;
    double weight[RULES];
    int32_t group[RULES]; /* -1: the form does not have it yet */
    double *is_fixed;     /* a weight for each vertex: 0 or 1 */
    double *fixed_at;     /* 3 for each vertex */
    double centre[3], radius;
    double residual, handle[3]; /* of a drag: after the last move, and where its handle has been led */
    bool held;                  /* the handle goes no farther */
    double *before;             /* positions before a move */
    gproj_result result;
    char sentence[GPROJ_MESSAGE_SIZE];
    void *block;
    size_t block_size;
} page;

/* A handle is held where another vertex would move so much farther than it. */
static const double HELD = 8;

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

/* Takes the place of the mesh before. */
static void adopt(gproj_mesh *mesh, double *original, double *fixed_at, double *before, double *is_fixed) {
    size_t bytes = 3 * sizeof *original * (size_t)mesh->vertex_count;
    double low[3], high[3];
    gproj_drag_cancel(page.drag);
    gproj_form_destroy(page.form);
    gproj_mesh_destroy(page.mesh);
    free(page.original), free(page.is_fixed), free(page.fixed_at), free(page.before);
    page.mesh = mesh, page.original = original, page.is_fixed = is_fixed, page.fixed_at = fixed_at,
    page.before = before;
    page.form = NULL, page.drag = NULL;
    page.weight[FIXED] = 0;
    memset(&page.result, 0, sizeof page.result);
    memcpy(original, mesh->position, bytes);
    memcpy(fixed_at, mesh->position, bytes);
    for (int k = 0; k < 3; ++k) {
        low[k] = high[k] = original[k];
        for (int32_t v = 1; v < mesh->vertex_count; ++v) {
            low[k] = fmin(low[k], original[3 * v + k]);
            high[k] = fmax(high[k], original[3 * v + k]);
        }
        page.centre[k] = (low[k] + high[k]) / 2;
    }
    page.radius = sqrt(pow(high[0] - low[0], 2) + pow(high[1] - low[1], 2) + pow(high[2] - low[2], 2)) / 2;
    if (!(page.radius > 0)) page.radius = 1;
}

/* Opens the text of `size` bytes in the block, OBJ or OFF. False: page_sentence says why, and the mesh before stays. */
bool EXPORT(page_open) page_open(size_t size) {
    gproj_error error;
    gproj_mesh *mesh = gproj_mesh_read(page.block, size, GPROJ_FORMAT_DETECT, &host, &error);
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

/* Fills the block with pairs of uint32: for each corner of triangles its vertex and its face, then for each edge its two
   ends. A triangle fan for each face. Returns the number of triangles, 0 without memory. */
int32_t EXPORT(page_topology) page_topology(void) {
    const gproj_mesh *mesh = page.mesh;
    int32_t triangles = 0;
    uint32_t *out;
    for (int32_t f = 0; f < mesh->face_count; ++f) triangles += mesh->face_degree[f] - 2;
    out = page_block(sizeof *out * 2 * (3 * (size_t)triangles + (size_t)mesh->edge_count));
    if (!out) return 0;
    for (int32_t f = 0; f < mesh->face_count; ++f) {
        int32_t first = mesh->face_halfedge[f], h = mesh->next[first];
        for (int32_t k = 2; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
            int32_t corner[3] = {first, h, mesh->next[h]};
            for (int c = 0; c < 3; ++c) *out++ = (uint32_t)mesh->origin[corner[c]], *out++ = (uint32_t)f;
        }
    }
    for (int32_t h = 0; h < mesh->halfedge_count; ++h) *out++ = (uint32_t)mesh->origin[h];
    return triangles;
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

/* Fills the block with floats: for each vertex x, y, z (relative) and 0; for each face its planarity in mean edge lengths;
   for each edge its axial force over the largest one, > 0: compression. */
bool EXPORT(page_frame) page_frame(void) {
    const gproj_mesh *mesh = page.mesh;
    size_t vertices = (size_t)mesh->vertex_count, faces = (size_t)mesh->face_count, edges = (size_t)mesh->edge_count;
    size_t most = faces > edges ? faces : edges;
    float *out = page_block(sizeof *out * (4 * vertices + faces + edges) + sizeof(double) * (most + 1));
    double *work, largest = 0;
    if (!out) return false;
    work = (double *)(((uintptr_t)(out + 4 * vertices + faces + edges) + 7) & ~(uintptr_t)7);
    for (size_t v = 0; v < vertices; ++v) {
        for (size_t k = 0; k < 3; ++k)
            out[4 * v + k] = (float)((mesh->position[3 * v + k] - page.centre[k]) / page.radius);
        out[4 * v + 3] = 0;
    }
    gproj_measure_planarity(mesh, work, NULL);
    for (size_t f = 0; f < faces; ++f) out[4 * vertices + f] = (float)work[f];
    memset(work, 0, sizeof *work * edges);
    if (page.form && page.weight[EQUILIBRIUM] > 0) gproj_get_forces(page.form, work, NULL);
    for (size_t e = 0; e < edges; ++e) {
        const double *a = mesh->position + 3 * mesh->origin[2 * e], *b = mesh->position + 3 * mesh->origin[2 * e + 1];
        work[e] *= sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
        largest = fmax(largest, fabs(work[e]));
    }
    for (size_t e = 0; e < edges; ++e) out[4 * vertices + faces + e] = (float)(largest > 0 ? work[e] / largest : 0);
    return true;
}

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

/* What undo needs, in the block: positions, then force densities, all doubles. Returns their number, 0 without memory. */
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

void EXPORT(page_set) page_set(int32_t which, double weight) {
    if (which >= 0 && which < RULES) page.weight[which] = weight;
}

/* Fixes a vertex by hand where it is, or frees it. */
void EXPORT(page_fix) page_fix(int32_t vertex, bool fixed) {
    if (vertex < 0 || vertex >= page.mesh->vertex_count) return;
    page.is_fixed[vertex] = fixed;
    memcpy(page.fixed_at + 3 * vertex, page.mesh->position + 3 * vertex, 3 * sizeof *page.fixed_at);
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
    case FIXED: return add_fixed();
    case FAIRNESS: return gproj_add_fairness(form, 1);
    case CLOSENESS: return gproj_add_closeness(form, 1);
    case TANGENTIAL: return gproj_add_tangential_fairness(form, 1);
    case EQUAL_AREAS: return gproj_add_equal_areas(form, 1);
    case RULES: break;
    }
    return -1;
}

/* Gives the form all groups that have a weight, and all groups their weights. A group stays once it is there, so a new
   weight costs nothing; a form that has met an error is made anew. False: the sentence says why. */
static bool prepare(void) {
    size_t bytes = 3 * sizeof(double) * (size_t)page.mesh->vertex_count;
    if (page.form && gproj_form_error(page.form)->code != GPROJ_OK) {
        gproj_form_destroy(page.form);
        page.form = NULL;
    }
    if (!page.form) { /* from the mesh as it was read */
        double *present = malloc(bytes);
        if (!present) return refuse(gproj_code_string(GPROJ_ERROR_MEMORY));
        memcpy(present, page.mesh->position, bytes);
        memcpy(page.mesh->position, page.original, bytes);
        page.form = gproj_form_create(page.mesh, &host);
        memcpy(page.mesh->position, present, bytes);
        free(present);
        if (!page.form) return refuse(gproj_code_string(GPROJ_ERROR_MEMORY));
        for (int k = 0; k < RULES; ++k) page.group[k] = -1;
    }
    for (int k = 0; k < RULES; ++k) {
        int32_t last = page.weight[EQUILIBRIUM] > 0 ? 9 : 6; /* of wishes, as the command line has it */
        gproj_schedule schedule = k < FAIRNESS ? gproj_keep(page.weight[k]) : gproj_fade(page.weight[k], last);
        if (page.weight[k] > 0 && page.group[k] < 0) page.group[k] = add_rule((rule)k);
        if (page.group[k] >= 0) gproj_set_schedule(page.form, page.group[k], schedule);
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
    gproj_solve_options options = {.smooth = true};
    gproj_error error;
    memset(&page.result, 0, sizeof page.result);
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
    return gproj_solve_begin(page.form, 60, &options, NULL);
}

/* Goes on for `seconds` with the solve or the release that is on. Returns whether there is more to do; at the end the
   sentence is the verdict. */
bool EXPORT(page_step) page_step(double seconds) {
    if (gproj_solve_is_on(page.form)) page.result = gproj_solve_advance(page.form, seconds);
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

/* Leads the handle on by `way` along the unit vector `along`. Returns how far the vertex that moved most has moved; < 0: the
   sentence says why that was refused. */
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
    for (int32_t v = 0; v < mesh->vertex_count; ++v) {
        double d[3];
        for (int k = 0; k < 3; ++k) d[k] = mesh->position[3 * v + k] - page.before[3 * v + k];
        most = fmax(most, sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
    }
    return most;
}

/* What page_move says. */
enum {
    REFUSED,
    THERE,
    ON_THE_WAY
};

/* Moves the grabbed vertex towards a place, relative, for about a tenth of a second. The error grows with the square of what
   vertices move, so none moves by more than a quarter of an edge at once. A short probe tells how far the others would: where
   the handle hardly yields they would fly, and it is held. */
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

/* Lets go: page_step goes on with the release. */
bool EXPORT(page_release) page_release(void) { return gproj_drag_release(page.drag); }

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

/* The middle of the element that the verdict names, relative, in the block as 3 doubles: the worst one where something does
   not hold, else the first one that is spoiled. False: it names none. */
bool EXPORT(page_named) page_named(void) {
    const gproj_mesh *mesh = page.mesh;
    const gproj_result *r = &page.result;
    double *out = page_block(3 * sizeof *out), *p = mesh->position;
    gproj_place place = r->spoiled.place;
    int32_t element = r->spoiled.element;
    if (!out || !page.form) return false;
    if (r->outcome != GPROJ_CONVERGED && r->worst_group >= 0)
        place = gproj_form_group_info(page.form, r->worst_group).place, element = r->worst_element;
    if (element < 0) return false;
    memset(out, 0, 3 * sizeof *out);
    if (place == GPROJ_PLACE_VERTEX && element < mesh->vertex_count) {
        for (int k = 0; k < 3; ++k) out[k] = p[3 * element + k];
    } else if (place == GPROJ_PLACE_EDGE && element < mesh->edge_count) {
        for (int k = 0; k < 3; ++k)
            out[k] = (p[3 * mesh->origin[2 * element] + k] + p[3 * mesh->origin[2 * element + 1] + k]) / 2;
    } else if (place == GPROJ_PLACE_FACE && element < mesh->face_count) {
        int32_t h = mesh->face_halfedge[element], degree = mesh->face_degree[element];
        for (int32_t c = 0; c < degree; ++c, h = mesh->next[h])
            for (int k = 0; k < 3; ++k) out[k] += p[3 * mesh->origin[h] + k] / degree;
    } else {
        return false;
    }
    for (int k = 0; k < 3; ++k) out[k] = (out[k] - page.centre[k]) / page.radius;
    return true;
}

/* The relative reach of `rings` mean edges. */
double EXPORT(page_reach) page_reach(double rings) {
    return rings * gproj_mesh_mean_edge_length(page.mesh) / page.radius;
}
