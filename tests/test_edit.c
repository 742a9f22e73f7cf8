/* test_edit.c - >>edit: each change of the combinatorics keeps what a mesh promises, or is refused and changes nothing. */
#include "gprojt_mesh.h"

/* -- the edit itself -- */

/* NULL if the arrays of an edit are what the header says, else the promise that is broken. */
static const char *gprojt_validate_edit(const gproj_edit *e) {
    int32_t h, f, v, k, corners = 0, removed = 0;
    for (h = 0; h < 2 * e->edge_count; ++h) {
        GPROJT_VALID((e->origin[h] < 0) == (e->origin[h ^ 1] < 0));
        if (e->origin[h] < 0) continue;
        GPROJT_VALID(e->next[e->prev[h]] == h && e->prev[e->next[h]] == h);
        GPROJT_VALID(e->face[e->next[h]] == e->face[h] && (e->face[h] >= 0 || e->face[h ^ 1] >= 0));
        GPROJT_VALID(e->origin[e->next[h]] == e->origin[h ^ 1] && e->origin[h] != e->origin[h ^ 1]);
        GPROJT_VALID(e->face[h] < 0 || e->face_halfedge[e->face[h]] >= 0);
        GPROJT_VALID(e->vertex_halfedge[e->origin[h]] >= 0);
        if (e->face[h] < 0) GPROJT_VALID(e->vertex_halfedge[e->origin[h]] == h);
        corners += e->face[h] >= 0;
    }
    for (f = 0; f < e->face_count; ++f) {
        if ((h = e->face_halfedge[f]) < 0) continue;
        GPROJT_VALID(e->face_degree[f] >= 3);
        for (k = 0; k < e->face_degree[f]; ++k, h = e->next[h]) GPROJT_VALID(e->face[h] == f);
        GPROJT_VALID(h == e->face_halfedge[f]);
        corners -= e->face_degree[f];
    }
    GPROJT_VALID(corners == 0);
    for (v = 0; v < e->vertex_count; ++v) {
        h = e->vertex_halfedge[v];
        removed += h < 0;
        GPROJT_VALID(h < 0 || e->origin[h] == v);
    }
    GPROJT_VALID(removed < e->vertex_count);
    return NULL;
}

/* A number that changes when anything in the edit does (FNV-1a). */
static uint64_t gprojt_hash(uint64_t hash, const void *data, size_t size) {
    const unsigned char *byte = (const unsigned char *)data;
    size_t i;
    for (i = 0; i < size; ++i) hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}
static uint64_t gprojt_edit_hash(const gproj_edit *e) {
    size_t vertices = (size_t)e->vertex_count, halfedges = 2 * (size_t)e->edge_count, faces = (size_t)e->face_count;
    uint64_t hash = 0xcbf29ce484222325u + vertices + 3 * halfedges + 7 * faces;
    hash = gprojt_hash(hash, e->position, vertices * 3 * sizeof(double));
    hash = gprojt_hash(hash, e->vertex_halfedge, vertices * sizeof(int32_t));
    hash = gprojt_hash(hash, e->face_halfedge, faces * sizeof(int32_t));
    hash = gprojt_hash(hash, e->face_degree, faces * sizeof(int32_t));
    hash = gprojt_hash(hash, e->face_parent, faces * sizeof(int32_t));
    hash = gprojt_hash(hash, e->next, halfedges * sizeof(int32_t));
    hash = gprojt_hash(hash, e->origin, halfedges * sizeof(int32_t));
    return gprojt_hash(hash, e->face, halfedges * sizeof(int32_t));
}

/* The mesh of an edit, and whether it and the maps keep their promises. */
static gproj_mesh *gprojt_edit_mesh(gproj_edit *e) {
    gproj_error error;
    gproj_mesh *mesh = gproj_edit_mesh(e, NULL, &error);
    const char *wrong = gprojt_validate_edit(e);
    int32_t i, k, h, g;
    if (wrong) printf("  edit: %s\n", wrong);
    GPROJT_CHECK(!wrong);
    if (!mesh) printf("  no mesh: %s\n", error.message);
    GPROJT_CHECK(mesh != NULL);
    if (!mesh) return NULL;
    wrong = gprojt_validate_mesh(mesh);
    if (wrong) printf("  mesh: %s\n", wrong);
    GPROJT_CHECK(!wrong && mesh->reoriented_count == 0);
    for (i = 0; i < e->vertex_count; ++i) {
        k = e->vertex_number[i];
        GPROJT_CHECK(k >= 0 && k < mesh->vertex_count && k == e->vertex_number[gproj_edit_vertex(e, i)]);
        if (gproj_edit_vertex(e, i) == i)
            GPROJT_CHECK(!memcmp(mesh->position + 3 * k, e->position + 3 * i, 3 * sizeof(double)));
    }
    for (i = 0; i < e->face_count; ++i) {
        k = e->face_number[i], h = e->face_halfedge[i];
        GPROJT_CHECK((k < 0) == (h < 0));
        if (k < 0) continue;
        g = mesh->face_halfedge[k];
        do { /* corner by corner */
            GPROJT_CHECK(mesh->origin[g] == e->vertex_number[e->origin[h]]);
            GPROJT_CHECK(mesh->edge[g] == e->edge_number[h / 2]);
            h = e->next[h], g = mesh->next[g];
        } while (h != e->face_halfedge[i]);
        GPROJT_CHECK(g == mesh->face_halfedge[k]);
    }
    for (i = 0; i < e->edge_count; ++i) GPROJT_CHECK(e->edge_number[i] >= -1 && e->edge_number[i] < mesh->edge_count);
    return mesh;
}

static gproj_edit *gprojt_edit_shape(int shape, int32_t n) {
    gprojt_soup s = gprojt_shape(shape, n);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gproj_edit *edit = gproj_edit_create(mesh, NULL, NULL);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
    return edit;
}

static int32_t gprojt_euler(const gproj_mesh *m) {
    return m->vertex_count - m->isolated_count - m->edge_count + m->face_count;
}

/* Is an edge at the boundary? */
static bool gprojt_at_boundary(const gproj_edit *e, int32_t edge) {
    return e->face[2 * edge] < 0 || e->face[2 * edge + 1] < 0;
}

static int32_t gprojt_alive(const gproj_edit *e, gproj_place place) {
    int32_t i, count = 0;
    if (place == GPROJ_PLACE_VERTEX)
        for (i = 0; i < e->vertex_count; ++i) count += e->vertex_halfedge[i] >= 0;
    if (place == GPROJ_PLACE_EDGE)
        for (i = 0; i < e->edge_count; ++i) count += e->origin[2 * i] >= 0;
    if (place == GPROJ_PLACE_FACE)
        for (i = 0; i < e->face_count; ++i) count += e->face_halfedge[i] >= 0;
    return count;
}

/* -- random edits -- */

enum {
    GPROJT_SPLIT_EDGE,
    GPROJT_SPLIT_FACE,
    GPROJT_COLLAPSE,
    GPROJT_INSERT,
    GPROJT_REMOVE,
    GPROJT_TRIANGULATE,
    GPROJT_DUAL,
    GPROJT_EDITS
};

/* An element that is left. */
static int32_t gprojt_some_edge(const gproj_edit *e, uint64_t *state) {
    for (;;) {
        int32_t i = gprojt_below(state, e->edge_count);
        if (e->origin[2 * i] >= 0) return i;
    }
}
static int32_t gprojt_some_face(const gproj_edit *e, uint64_t *state) {
    for (;;) {
        int32_t i = gprojt_below(state, e->face_count);
        if (e->face_halfedge[i] >= 0) return i;
    }
}

/* The mesh of an edit with vertices merged, group[v] the vertex for v: faces lose repeated corners in a row, and vanish with
   fewer than 3. NULL if that is no mesh. */
static gproj_mesh *gprojt_merged(const gproj_edit *e, const int32_t *group) {
    gprojt_soup s;
    gproj_mesh *mesh;
    int32_t f, h, v, k;
    memset(&s, 0, sizeof s);
    for (v = 0; v < e->vertex_count; ++v)
        gprojt_add_vertex(&s, e->position[3 * v], e->position[3 * v + 1], e->position[3 * v + 2]);
    for (f = 0; f < e->face_count; ++f) {
        int32_t *corner, degree = 0;
        if ((h = e->face_halfedge[f]) < 0) continue;
        corner = (int32_t *)malloc((size_t)e->face_degree[f] * sizeof(int32_t));
        for (k = 0; k < e->face_degree[f]; ++k, h = e->next[h]) {
            v = group[e->origin[h]];
            if (v != group[e->origin[e->prev[h]]]) corner[degree++] = v;
        }
        if (degree > 2) gprojt_add_face(&s, degree, corner);
        free(corner);
    }
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gprojt_soup_free(&s);
    return mesh;
}

/* Would merging the ends of edges keep what the mesh is: would it be a mesh, with the same components, boundary loops and
   Euler characteristic, and none of its remaining vertices without a face? */
static bool gprojt_may_merge(gproj_edit *e, int32_t count, const int32_t *edge) {
    int32_t *group = (int32_t *)malloc((size_t)e->vertex_count * sizeof(int32_t)), i, k, left = 0;
    gproj_mesh *before = gproj_edit_mesh(e, NULL, NULL), *after;
    bool may;
    for (i = 0; i < e->vertex_count; ++i) group[i] = i;
    for (k = 0; k < count; ++k) {
        int32_t a = group[e->origin[2 * edge[k]]], b = group[e->origin[2 * edge[k] + 1]];
        for (i = 0; i < e->vertex_count; ++i)
            if (group[i] == b) group[i] = a;
    }
    after = gprojt_merged(e, group);
    for (i = 0; i < e->vertex_count; ++i) left += group[i] == i && e->vertex_halfedge[i] >= 0;
    may = after && after->reoriented_count == 0 && after->vertex_count - after->isolated_count == left &&
          gprojt_euler(before) == gprojt_euler(after) && before->loop_count == after->loop_count &&
          before->component_count == after->component_count;
    gproj_mesh_destroy(before);
    gproj_mesh_destroy(after);
    free(group);
    return may;
}

/* The rungs of the strip of an edge, found in another way: opposite edges of quads belong together. */
static int32_t gprojt_rungs(const gproj_edit *e, int32_t edge, int32_t *rung) {
    int32_t count = 1, at, k;
    rung[0] = edge;
    for (at = 0; at < count; ++at) {
        for (k = 0; k < 2; ++k) {
            int32_t h = 2 * rung[at] + k, i, other;
            if (e->face[h] < 0 || e->face_degree[e->face[h]] != 4) continue;
            other = e->next[e->next[h]] / 2;
            for (i = 0; i < count && rung[i] != other; ++i) {
            }
            if (i == count) rung[count++] = other;
        }
    }
    return count;
}

/* One edit; false when it was refused. The numbers of elements change as theory says. */
static bool gprojt_random_edit(gproj_edit *e, int kind, uint64_t *state) {
    int32_t vertices = gprojt_alive(e, GPROJ_PLACE_VERTEX), edges = gprojt_alive(e, GPROJ_PLACE_EDGE);
    int32_t faces = gprojt_alive(e, GPROJ_PLACE_FACE), edge = gprojt_some_edge(e, state), f = -1, h, k, result = -1;
    int32_t more[3] = {0, 0, 0}; /* vertices, edges, faces */
    uint64_t before = gprojt_edit_hash(e);
    double t = gprojt_uniform(state);
    gproj_error error;
    int32_t rung[1000], rungs;
    bool may, compared;
    switch (kind) {
    case GPROJT_SPLIT_EDGE:
        result = gproj_edit_split_edge(e, edge, t, &error);
        more[0] = more[1] = 1;
        break;
    case GPROJT_SPLIT_FACE:
        for (k = 0; k < 10; ++k) {
            f = gprojt_some_face(e, state);
            if (e->face_degree[f] > 3) break;
        }
        h = e->face_halfedge[f];
        for (k = gprojt_below(state, e->face_degree[f]); k > 0; --k) h = e->next[h];
        for (k = 2 + gprojt_below(state, e->face_degree[f] - 2), edge = h; k > 0; --k) edge = e->next[edge];
        result = gproj_edit_split_face(e, f, e->origin[h], e->origin[edge], &error);
        more[1] = more[2] = 1;
        break;
    case GPROJT_COLLAPSE:
        for (k = 0; k < 2; ++k) more[2] -= e->face[2 * edge + k] >= 0 && e->face_degree[e->face[2 * edge + k]] == 3;
        more[0] = -1, more[1] = more[2] - 1;
        compared = gprojt_below(state, 4) == 0;
        may = compared && gprojt_may_merge(e, 1, &edge);
        result = gproj_edit_collapse_edge(e, edge, t, &error);
        GPROJT_CHECK(!compared || (result >= 0) == may);
        break;
    case GPROJT_INSERT: result = gproj_edit_insert_strip(e, edge, t, &error); break;
    case GPROJT_REMOVE:
        rungs = gprojt_rungs(e, edge, rung);
        may = gprojt_may_merge(e, rungs, rung);
        result = gproj_edit_remove_strip(e, edge, t, &error);
        GPROJT_CHECK(result < 0 || result == rungs);
        GPROJT_CHECK((result >= 0) == (may && rungs > 1));
        break;
    default:
        f = gprojt_below(state, 20) ? gprojt_some_face(e, state) : -1;
        result = gproj_edit_triangulate(e, f, &error);
        more[1] = more[2] = result;
        break;
    }
    GPROJT_CHECK((result < 0) == (error.code != GPROJ_OK) && (result < 0) == (error.message[0] != 0));
    if (result < 0) {
        GPROJT_CHECK(error.index >= 0 && gprojt_edit_hash(e) == before);
        return false;
    }
    vertices = gprojt_alive(e, GPROJ_PLACE_VERTEX) - vertices, edges = gprojt_alive(e, GPROJ_PLACE_EDGE) - edges;
    faces = gprojt_alive(e, GPROJ_PLACE_FACE) - faces;
    GPROJT_CHECK(vertices - edges + faces == 0);
    if (kind != GPROJT_INSERT && kind != GPROJT_REMOVE)
        GPROJT_CHECK(vertices == more[0] && edges == more[1] && faces == more[2]);
    return true;
}

/* Vertices between two faces have no dual face: mostly removes them. */
static void gprojt_remove_vertices_of_two(gproj_edit *e) {
    int32_t v, h;
    for (v = 0; v < e->vertex_count; ++v) {
        h = e->vertex_halfedge[v];
        if (h >= 0 && e->face[h] >= 0 && (e->prev[e->prev[h] ^ 1] ^ 1) == h)
            gproj_edit_collapse_edge(e, h / 2, h & 1, NULL);
    }
}

/* The edit goes on with the dual of its mesh; false when it was refused. */
static bool gprojt_go_on_with_dual(gproj_edit **e) {
    gproj_error error;
    gproj_mesh *mesh, *dual;
    const char *wrong;
    gprojt_remove_vertices_of_two(*e);
    mesh = gprojt_edit_mesh(*e);
    dual = mesh ? gproj_mesh_dual(mesh, NULL, NULL, &error) : NULL;
    wrong = dual ? gprojt_validate_mesh(dual) : NULL;
    GPROJT_CHECK(!wrong && (dual || error.place == GPROJ_PLACE_FACE));
    if (dual) {
        GPROJT_CHECK(gprojt_euler(dual) == gprojt_euler(mesh) && dual->loop_count == mesh->loop_count &&
                     dual->component_count == mesh->component_count);
        gproj_edit_destroy(*e);
        *e = gproj_edit_create(dual, NULL, NULL);
    }
    gproj_mesh_destroy(mesh);
    gproj_mesh_destroy(dual);
    return dual != NULL;
}

/* Which edit next: one that makes a large mesh smaller, or the one that was done least, or any. */
static int gprojt_choose(const gproj_mesh *mesh, const long *done, uint64_t *state) {
    int kind, least = 0;
    if (mesh->face_count > 25 && gprojt_below(state, 2)) return GPROJT_COLLAPSE;
    for (kind = 1; kind < GPROJT_EDITS; ++kind)
        if (done[kind] < done[least]) least = kind;
    return gprojt_below(state, 2) ? least : gprojt_below(state, GPROJT_EDITS);
}

/* Each edit `wanted` times, on all shapes in turn. */
static void gprojt_random_edits(long wanted, uint64_t state) {
    long done[GPROJT_EDITS] = {0}, tried[GPROJT_EDITS] = {0}, least = 0;
    int shape = 0, kind;
    while (least < wanted && !gprojt_failed_checks) {
        gproj_edit *e = gprojt_edit_shape(shape, 2 + gprojt_below(&state, 2));
        gproj_mesh *mesh = gprojt_edit_mesh(e), *after;
        int step;
        for (step = 0; step < 150 && mesh && mesh->face_count < 50 && !gprojt_failed_checks; ++step) {
            kind = gprojt_choose(mesh, done, &state);
            tried[kind]++;
            if (!(kind == GPROJT_DUAL ? gprojt_go_on_with_dual(&e) : gprojt_random_edit(e, kind, &state))) continue;
            done[kind]++;
            after = gprojt_edit_mesh(e);
            if (after) {
                GPROJT_CHECK(gprojt_euler(after) == gprojt_euler(mesh) && after->loop_count == mesh->loop_count &&
                             after->component_count == mesh->component_count);
            }
            gproj_mesh_destroy(mesh);
            mesh = after;
        }
        gproj_mesh_destroy(mesh);
        gproj_edit_destroy(e);
        shape = (shape + 1) % GPROJT_SHAPES;
        least = done[0];
        for (kind = 1; kind < GPROJT_EDITS; ++kind) least = done[kind] < least ? done[kind] : least;
    }
    if (getenv("GPROJT_VERBOSE"))
        for (kind = 0; kind < GPROJT_EDITS; ++kind) printf("  edit %d: %ld of %ld\n", kind, done[kind], tried[kind]);
}

GPROJT_TEST(ten_thousand_of_each) { gprojt_random_edits(10000, 5); }

int main(void) {
    GPROJT_RUN(ten_thousand_of_each);
    return gprojt_report();
}
