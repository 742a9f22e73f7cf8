/* test_edit.c - >>edit: each change of the combinatorics keeps what a mesh promises, or is refused and changes nothing.
   */
#include "gprojt_inside.h"
#include "gprojt_mesh.h"

/* -- the edit itself -- */

/* NULL if the arrays of an edit are what the header says, else the promise that is broken. */
static const char *gprojt_validate_edit(const gproj_edit *e) {
    int32_t h, f, v, k, corners = 0;
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
        GPROJT_VALID(h < 0 || e->origin[h] == v);
    }
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

static gproj_edit *gprojt_edit_soup(gprojt_soup s) {
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gproj_edit *edit = gproj_edit_create(mesh, NULL, NULL);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
    return edit;
}

static gproj_edit *gprojt_edit_shape(int shape, int32_t n) { return gprojt_edit_soup(gprojt_shape(shape, n)); }

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

/* The mesh of an edit with vertices merged, group[v] the vertex for v: faces lose repeated corners in a row, and vanish
   with fewer than 3. NULL if that is no mesh. */
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

/* Would merging the ends of edges keep what the mesh is: would it be a mesh, with the same components, boundary loops
   and Euler characteristic, and none of its remaining vertices without a face? */
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

/* What inserting a strip adds: a vertex on each rung; in a quad an edge and a face, in one that is crossed twice a
   vertex, 4 edges and 3 faces; in a triangle where it ends, also with both ends, an edge and a face. Returns how many are
   crossed twice. */
static int32_t gprojt_count_strip(const gproj_edit *e, int32_t edge, int32_t more[3]) {
    int32_t *rung = (int32_t *)malloc((size_t)e->edge_count * sizeof(int32_t)), twice = 0, once = 0, f, k, i;
    int32_t rungs = gprojt_rungs(e, edge, rung);
    for (f = 0; f < e->face_count; ++f) {
        int32_t h = e->face_halfedge[f], sides = 0;
        if (h < 0 || e->face_degree[f] > 4) continue;
        for (k = 0; k < e->face_degree[f]; ++k, h = e->next[h])
            for (i = 0; i < rungs; ++i) sides += rung[i] == h / 2;
        once += sides == 2 || (e->face_degree[f] == 3 && sides == 1);
        twice += sides == 4;
    }
    more[0] = rungs + twice, more[1] = rungs + once + 4 * twice, more[2] = once + 3 * twice;
    free(rung);
    return twice;
}

/* The same vertices, bit for bit, and the same faces up to their numbers and first corners. */
static bool gprojt_same_faces(const gproj_mesh *a, const gproj_mesh *b) {
    int32_t f, h, g, k;
    if (a->vertex_count != b->vertex_count || a->edge_count != b->edge_count || a->face_count != b->face_count ||
        memcmp(a->position, b->position, (size_t)a->vertex_count * 3 * sizeof(double)))
        return false;
    for (f = 0; f < a->face_count; ++f) {
        h = a->face_halfedge[f];
        for (g = 0; g < b->halfedge_count; ++g)
            if (b->origin[g] == a->origin[h] && b->origin[g ^ 1] == a->origin[h ^ 1]) break;
        if (g == b->halfedge_count || b->face[g] < 0 || b->face_degree[b->face[g]] != a->face_degree[f]) return false;
        for (k = 0; k < a->face_degree[f]; ++k, h = a->next[h], g = b->next[g])
            if (a->origin[h] != b->origin[g]) return false;
    }
    return true;
}

/* On a copy: a strip, inserted and removed, leaves everything as it was. */
static bool gprojt_strip_comes_and_goes(gproj_edit *e, int32_t edge, double t) {
    gproj_mesh *before = gproj_edit_mesh(e, NULL, NULL), *after;
    gproj_edit *copy = gproj_edit_create(before, NULL, NULL);
    int32_t strip = gproj_edit_insert_strip(copy, e->edge_number[edge], t, NULL);
    bool same = strip < 0 || gproj_edit_remove_strip(copy, strip, 1, NULL) >= 0;
    after = gproj_edit_mesh(copy, NULL, NULL);
    same = same && after && gprojt_same_faces(before, after);
    gproj_mesh_destroy(before);
    gproj_mesh_destroy(after);
    gproj_edit_destroy(copy);
    return same;
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
        compared = gprojt_below(state, 8) == 0;
        may = compared && gprojt_may_merge(e, 1, &edge);
        result = gproj_edit_collapse_edge(e, edge, t, &error);
        GPROJT_CHECK(!compared || (result >= 0) == may);
        break;
    case GPROJT_INSERT:
        gprojt_count_strip(e, edge, more);
        if (gprojt_below(state, 4) == 0) GPROJT_CHECK(gprojt_strip_comes_and_goes(e, edge, t));
        result = gproj_edit_insert_strip(e, edge, t, &error);
        break;
    case GPROJT_REMOVE:
        rungs = gprojt_rungs(e, edge, rung);
        compared = gprojt_below(state, 4) == 0;
        may = compared && gprojt_may_merge(e, rungs, rung);
        result = gproj_edit_remove_strip(e, edge, t, &error);
        GPROJT_CHECK(result < 0 || result == rungs);
        GPROJT_CHECK(!compared || (result >= 0) == (may && rungs > 1));
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
    if (kind != GPROJT_REMOVE) GPROJT_CHECK(vertices == more[0] && edges == more[1] && faces == more[2]);
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

/* Which edit next: sometimes one that makes a large mesh smaller, or the one that was done least, or any. */
static int gprojt_choose(const gproj_mesh *mesh, const long *done, uint64_t *state) {
    int kind, least = 0;
    if (mesh->face_count > 20 && gprojt_below(state, 4) == 0) return GPROJT_COLLAPSE;
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
        for (step = 0; step < 150 && mesh && mesh->face_count < 40 && !gprojt_failed_checks; ++step) {
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

#ifdef GPROJT_SANITIZED
GPROJT_TEST(ten_thousand_of_each) { gprojt_random_edits(3000, 5); } /* the rest without sanitizers */
#else
GPROJT_TEST(ten_thousand_of_each) { gprojt_random_edits(10000, 5); }
#endif

/* -- splitting, cutting, collapsing -- */

/* A 3 x 2 grid of quads with a polyline along its middle row and round a face, and
   one of points that have no face. */
static gproj_mesh *gprojt_lined_grid(void) {
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\n"
                               "v 0 2 0\nv 1 2 0\nv 2 2 0\nv 3 2 0\nv 9 9 0\nv 9 9 1\n"
                               "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\n"
                               "l 5 6 7 8\nl 7 6 2 3 7\nl 13 14\n";
    return gproj_mesh_read(text, sizeof text - 1, GPROJ_FORMAT_OBJ, NULL, NULL);
}

static bool gprojt_polyline_is(const gproj_mesh *m, int32_t polyline, int32_t count, const int32_t *vertex) {
    int32_t start = m->polyline_start[polyline];
    return m->polyline_start[polyline + 1] - start == count &&
           !memcmp(m->polyline_vertex + start, vertex, (size_t)count * sizeof(int32_t));
}

/* The first edit of the header's text; what survives, and where. */
GPROJT_TEST(splits_and_cuts) {
    gproj_mesh *mesh = gprojt_lined_grid(), *after;
    gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
    int32_t edge = gproj_edit_edge(e, 5, 6), from = e->origin[2 * edge], x, cut;
    static const int32_t row[5] = {4, 5, 14, 6, 7}, ring[6] = {6, 14, 5, 1, 2, 6}, loose[2] = {12, 13};
    GPROJT_CHECK(edge >= 0 && gproj_edit_edge(e, 6, 5) == edge && gproj_edit_edge(e, 0, 5) == -1);
    x = gproj_edit_split_edge(e, edge, from == 5 ? 0.25 : 0.75, NULL);
    GPROJT_CHECK(x == 14 && e->vertex_count == 15 && e->edge_count == mesh->edge_count + 1);
    GPROJT_CHECK(e->position[3 * x] == 1.25 && e->position[3 * x + 1] == 1 && e->position[3 * x + 2] == 0);
    GPROJT_CHECK(e->origin[2 * edge] == from && e->origin[2 * edge + 1] == x &&
                 e->origin[2 * (e->edge_count - 1)] == x);
    cut = gproj_edit_split_face(e, 1, x, 1, NULL); /* 2 3 7 6 of the text, now with a fifth corner */
    GPROJT_CHECK(cut == e->edge_count - 1 && e->origin[2 * cut] == x && e->origin[2 * cut + 1] == 1);
    GPROJT_CHECK(e->face_count == 7 && e->face_parent[6] == 1 && e->face_parent[5] == 5);
    GPROJT_CHECK(e->origin[e->face_halfedge[1]] == 1 && e->face_degree[1] + e->face_degree[6] == 7);
    after = gprojt_edit_mesh(e);
    GPROJT_REQUIRE(after != NULL);
    GPROJT_CHECK(after->vertex_count == 15 && after->isolated_count == 2 && after->polyline_count == 3);
    GPROJT_CHECK(e->vertex_number[6] == 6 && e->vertex_number[x] == 14 && e->face_number[6] == 6);
    GPROJT_CHECK(after->origin[2 * e->edge_number[cut]] == x || after->origin[2 * e->edge_number[cut] + 1] == x);
    GPROJT_CHECK(gprojt_polyline_is(after, 0, 5, row) && gprojt_polyline_is(after, 1, 6, ring) &&
                 gprojt_polyline_is(after, 2, 2, loose));
    gproj_mesh_destroy(after);
    gproj_mesh_destroy(mesh);
    gproj_edit_destroy(e);
}

/* Faces begin at the same corner after any of their edges is split, alone or by a strip that cuts them. */
GPROJT_TEST(first_corners_stay) {
    gproj_mesh *mesh = gprojt_lined_grid();
    int32_t edge, strip, f, first[6];
    for (edge = 0; edge < mesh->edge_count; ++edge)
        for (strip = 0; strip < 2; ++strip) {
            gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
            for (f = 0; f < 6; ++f) first[f] = e->origin[e->face_halfedge[f]];
            if (strip)
                GPROJT_CHECK(gproj_edit_insert_strip(e, edge, 0.5, NULL) >= 0);
            else
                GPROJT_CHECK(gproj_edit_split_edge(e, edge, 0.5, NULL) == 14);
            for (f = 0; f < 6; ++f) GPROJT_CHECK(e->origin[e->face_halfedge[f]] == first[f]);
            gproj_edit_destroy(e);
        }
    gproj_mesh_destroy(mesh);
}

/* Polylines get a vertex for each time that they run along an edge that is split, again and again, and go on along edges. */
GPROJT_TEST(polylines_grow) {
    int32_t strips, i, k;
    for (strips = 0; strips < 2; ++strips) {
        gproj_mesh *mesh = gprojt_lined_grid(), *after;
        gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
        int32_t edge = gproj_edit_edge(e, 5, 6);
        for (i = 0; i < 40; ++i) {
            if (strips)
                edge = gproj_edit_insert_strip(e, edge, 0.5, NULL);
            else
                GPROJT_CHECK(gproj_edit_split_edge(e, edge, 0.5, NULL) == 14 + i);
        }
        after = gprojt_edit_mesh(e);
        GPROJT_REQUIRE(after != NULL);
        GPROJT_CHECK(after->polyline_count == 3 && after->vertex_count == 14 + 40 * (strips ? 3 : 1));
        GPROJT_CHECK(after->polyline_start[1] == 4 + 40); /* the ring has two of the strip's rungs */
        GPROJT_CHECK(after->polyline_start[2] - after->polyline_start[1] == 5 + 40 * (1 + strips));
        for (k = 0; k < 2; ++k)
            for (i = after->polyline_start[k]; i + 1 < after->polyline_start[k + 1]; ++i)
                GPROJT_CHECK(gproj_edit_edge(e, after->polyline_vertex[i], after->polyline_vertex[i + 1]) >= 0);
        gproj_mesh_destroy(after);
        gproj_mesh_destroy(mesh);
        gproj_edit_destroy(e);
    }
}

/* From the end of a polyline to the beginning of the next no polyline runs: an edge there is split without more room for
   them, and an edge along one with it. */
GPROJT_TEST(polylines_have_gaps_between_them) {
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\n"
                               "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nl 1 2\nl 3 4\n";
    gproj_mesh *mesh = gproj_mesh_read(text, sizeof text - 1, GPROJ_FORMAT_OBJ, NULL, NULL), *after;
    gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
    static const int32_t first[2] = {0, 1}, second[3] = {2, 10, 3};
    uint64_t taken;
    gproj_edit_split_edge(e, gproj_edit_edge(e, 5, 6), 0.5, NULL); /* room for as many vertices and edges once more */
    taken = gproj_edit_memory(e).allocations;
    GPROJT_CHECK(gproj_edit_split_edge(e, gproj_edit_edge(e, 1, 2), 0.5, NULL) == 9);
    GPROJT_CHECK(gproj_edit_memory(e).allocations == taken);
    GPROJT_CHECK(gproj_edit_split_edge(e, gproj_edit_edge(e, 2, 3), 0.5, NULL) == 10);
    GPROJT_CHECK(gproj_edit_memory(e).allocations == taken + 1);
    after = gprojt_edit_mesh(e);
    GPROJT_REQUIRE(after && after->polyline_count == 2);
    GPROJT_CHECK(gprojt_polyline_is(after, 0, 2, first) && gprojt_polyline_is(after, 1, 3, second));
    gproj_mesh_destroy(after);
    gproj_mesh_destroy(mesh);
    gproj_edit_destroy(e);
}

GPROJT_TEST(collapses_carry_numbers_on) {
    gproj_mesh *mesh = gprojt_lined_grid(), *after;
    gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
    static const int32_t row[3] = {3, 4, 5}, ring[3] = {4, 1, 4}, loose[2] = {10, 11};
    int32_t edge = gproj_edit_edge(e, 5, 6), triangle, diagonal;
    GPROJT_CHECK(gproj_edit_collapse_edge(e, edge, 0.5, NULL) == 5 && e->position[15] == 1.5);
    GPROJT_CHECK(gproj_edit_vertex(e, 6) == 5 && gproj_edit_vertex(e, 5) == 5 && e->vertex_halfedge[6] == -1);
    GPROJT_CHECK(e->origin[2 * edge] == -1 && e->face_degree[1] == 3 && e->face_degree[4] == 3);
    /* the number of a merged vertex stands for what it was merged into */
    diagonal = gproj_edit_split_face(e, 2, 6, 3, NULL);
    GPROJT_CHECK(diagonal >= 0 && gproj_edit_edge(e, 3, 6) == diagonal && gproj_edit_edge(e, 5, 3) == diagonal);
    triangle = gproj_edit_edge(e, 1, 2);
    GPROJT_CHECK(gproj_edit_collapse_edge(e, triangle, 0.5, NULL) == 1); /* face 1 vanishes: two edges become one */
    GPROJT_CHECK(e->face_halfedge[1] == -1 && gproj_edit_edge(e, 2, 6) == gproj_edit_edge(e, 1, 5));
    after = gprojt_edit_mesh(e);
    GPROJT_REQUIRE(after != NULL);
    GPROJT_CHECK(e->vertex_number[6] == 4 && e->vertex_number[2] == 1 && e->vertex_number[3] == 2 &&
                 e->vertex_number[13] == 11 && after->vertex_count == 12);
    GPROJT_CHECK(e->edge_number[edge] == -1 && e->edge_number[triangle] == -1 && e->face_number[1] == -1 &&
                 e->face_number[2] == 1 && after->face_count == 6 && e->face_parent[6] == 2);
    GPROJT_CHECK(after->polyline_count == 3 && gprojt_polyline_is(after, 0, 3, row) &&
                 gprojt_polyline_is(after, 1, 3, ring) && gprojt_polyline_is(after, 2, 2, loose));
    gproj_mesh_destroy(after);
    /* a polyline of which one vertex is left is left out */
    GPROJT_CHECK(gproj_edit_collapse_edge(e, gproj_edit_edge(e, 1, 5), 1, NULL) == 1);
    after = gprojt_edit_mesh(e);
    GPROJT_CHECK(after && after->polyline_count == 2 && after->vertex_count == 11);
    gproj_mesh_destroy(after);
    gproj_mesh_destroy(mesh);
    gproj_edit_destroy(e);
}

/* Splitting an edge and collapsing its new part, anywhere, gives back the mesh, bit for bit. */
GPROJT_TEST(split_and_collapse_is_nothing) {
    int shape;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gprojt_soup s = gprojt_shape(shape, 3);
        gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL), *after;
        gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
        int32_t edge;
        for (edge = 0; edge < mesh->edge_count; ++edge) {
            int32_t x = gproj_edit_split_edge(e, edge, 0.3, NULL), head = mesh->origin[2 * edge + 1];
            GPROJT_CHECK(x >= mesh->vertex_count && gproj_edit_collapse_edge(e, e->edge_count - 1, 1, NULL) == head);
        }
        after = gprojt_edit_mesh(e);
        GPROJT_CHECK(after && gprojt_same_mesh(mesh, after));
        gproj_mesh_destroy(after);
        gproj_mesh_destroy(mesh);
        gproj_edit_destroy(e);
        gprojt_soup_free(&s);
    }
}

/* An edge that is split or collapsed at one of its ends has that end's coordinates there, bit for bit. */
GPROJT_TEST(ends_of_edges_are_exact) {
    static const double end[3] = {-0.0, 0.1, 1e300};
    int32_t i;
    for (i = 0; i < 4; ++i) {
        gproj_edit *e = gprojt_edit_shape(0, 3);
        int32_t edge = gproj_edit_edge(e, 5, 6), x;
        memcpy(e->position + 3 * e->origin[2 * edge + i % 2], end, sizeof end);
        x = i < 2 ? gproj_edit_split_edge(e, edge, i % 2, NULL) : gproj_edit_collapse_edge(e, edge, i % 2, NULL);
        GPROJT_CHECK(x >= 0 && !memcmp(e->position + 3 * x, end, sizeof end));
        gproj_edit_destroy(e);
    }
}

/* Each edge of each shape, alone: a split leaves the first corners of faces where they were, and so does a collapse, where
   the vertex that is left stands for both ends; a collapsed edge is no more. */
GPROJT_TEST(each_edge_by_itself) {
    int32_t collapsed = 0;
    int shape;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gprojt_soup s = gprojt_shape(shape, 3);
        gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
        int32_t edge, i;
        for (edge = 0; edge < mesh->edge_count; ++edge) {
            gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
            int32_t a = mesh->origin[2 * edge], b = mesh->origin[2 * edge + 1], kept;
            GPROJT_CHECK(gproj_edit_split_edge(e, edge, 0.25, NULL) == mesh->vertex_count);
            for (i = 0; i < mesh->face_count; ++i)
                GPROJT_CHECK(e->origin[e->face_halfedge[i]] == mesh->origin[mesh->face_halfedge[i]]);
            GPROJT_CHECK(gprojt_validate_edit(e) == NULL);
            gproj_edit_destroy(e);
            e = gproj_edit_create(mesh, NULL, NULL);
            kept = gproj_edit_collapse_edge(e, edge, 0.5, NULL);
            if (kept >= 0) {
                GPROJT_CHECK(gproj_edit_vertex(e, a) == kept && gproj_edit_vertex(e, b) == kept);
                for (i = 0; i < mesh->face_count; ++i)
                    if (e->face_halfedge[i] >= 0)
                        GPROJT_CHECK(e->origin[e->face_halfedge[i]] ==
                                     gproj_edit_vertex(e, mesh->origin[mesh->face_halfedge[i]]));
                GPROJT_CHECK(gproj_edit_split_edge(e, edge, 0.5, NULL) == -1);
                GPROJT_CHECK(gproj_edit_collapse_edge(e, edge, 0.5, NULL) == -1);
                GPROJT_CHECK(gprojt_validate_edit(e) == NULL);
                ++collapsed;
            }
            gproj_edit_destroy(e);
        }
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&s);
    }
    GPROJT_CHECK(collapsed > 100);
}

/* After 2^31 collapses the marks that each of them leaves begin anew: the same are refused as by a new edit. */
GPROJT_TEST(marks_begin_anew) {
    int shape;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gproj_edit *e = gprojt_edit_shape(shape, 3), *worn = gprojt_edit_shape(shape, 3);
        int32_t edge, collapsed = 0, refused = 0;
        for (edge = 0; edge < e->edge_count; ++edge) {
            int32_t kept = gproj_edit_collapse_edge(e, edge, 0.5, NULL);
            if (edge == 5) gprojt_inside_wear(worn);
            GPROJT_CHECK(gproj_edit_collapse_edge(worn, edge, 0.5, NULL) == kept);
            GPROJT_CHECK(gprojt_edit_hash(worn) == gprojt_edit_hash(e));
            collapsed += kept >= 0, refused += kept < 0;
        }
        GPROJT_CHECK(collapsed > 8 && refused > 8 && gprojt_validate_edit(worn) == NULL);
        gproj_edit_destroy(e);
        gproj_edit_destroy(worn);
    }
}

/* -- strips -- */

/* A strip inserted at each edge that has one and removed again. Quads stay quads. */
GPROJT_TEST(strips_come_and_go) {
    int32_t n, edge, f, strip;
    int shape, inserted = 0;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        for (n = 1; n < 4; ++n) {
            gprojt_soup s = gprojt_shape(shape, n);
            gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL), *after;
            for (edge = 0; edge < mesh->edge_count; ++edge) {
                gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
                strip = gproj_edit_insert_strip(e, edge, 0.75, NULL);
                if (strip >= 0) {
                    GPROJT_CHECK(e->origin[2 * strip + 1] == mesh->origin[2 * edge + 1]);
                    for (f = 0; f < e->face_count; ++f) GPROJT_CHECK(e->face_degree[f] == 4 || shape < 4);
                    after = gprojt_edit_mesh(e);
                    GPROJT_CHECK(after && after->face_count > mesh->face_count);
                    gproj_mesh_destroy(after);
                    GPROJT_CHECK(gproj_edit_remove_strip(e, strip, 1, NULL) > 1);
                    ++inserted;
                }
                GPROJT_CHECK(strip >= 0 || (shape > 0 && shape < 4));
                after = gprojt_edit_mesh(e);
                GPROJT_CHECK(after && gprojt_same_faces(mesh, after));
                gproj_mesh_destroy(after);
                gproj_edit_destroy(e);
            }
            gproj_mesh_destroy(mesh);
            gprojt_soup_free(&s);
        }
    }
    GPROJT_CHECK(inserted > 300);
}

/* Collapses a quad along its diagonal: the strips through it change partners, and all faces stay quads. */
static bool gprojt_collapse_quad(gproj_edit *e, int32_t face, int32_t corner) {
    int32_t h = e->face_halfedge[face], k, diagonal;
    for (k = 0; k < corner; ++k) h = e->next[h];
    diagonal = gproj_edit_split_face(e, face, e->origin[h], e->origin[e->next[e->next[h]]], NULL);
    if (diagonal < 0) return false;
    return gproj_edit_collapse_edge(e, diagonal, 0.5, NULL) >= 0;
}

/* Where a strip crosses itself quads are cut in four, and all goes back. */
/* A ring of three quads closed by a triangle, at which the strip begins and ends: it becomes a triangle and a quad, from
   either side, as often as one likes, and again a triangle. */
GPROJT_TEST(strips_that_begin_and_end_at_a_triangle) {
    int side, k;
    for (side = 0; side < 2; ++side) {
        static const double p[7][3] = {{1, 0, 0}, {0, 1, 0},   {-1, -1, 0}, {3, 0, 0},
                                       {0, 3, 0}, {-3, -3, 0}, {3, -2, 0}};
        static const int32_t quad[3][4] = {{0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 6, 0}};
        gprojt_soup s;
        gproj_mesh *before, *after;
        gproj_edit *e;
        int32_t rung, strip[3], f;
        memset(&s, 0, sizeof s);
        for (k = 0; k < 7; ++k) gprojt_add_vertex(&s, p[k][0], p[k][1], p[k][2]);
        for (k = 0; k < 3; ++k) gprojt_add_face(&s, 4, quad[k]);
        gprojt_add_triangle(&s, 0, 6, 3);
        e = gprojt_edit_soup(s);
        GPROJT_REQUIRE(e != NULL);
        before = gprojt_edit_mesh(e);
        rung = gproj_edit_edge(e, 0, 3);
        for (k = 0; k < 3; ++k) {
            strip[k] = rung = gproj_edit_insert_strip(e, rung, side ? 0.3 : 0.7, NULL);
            GPROJT_CHECK(rung >= 0 && e->face_count == 8 + 4 * k);
            for (f = 0; f < e->face_count; ++f) GPROJT_CHECK(e->face_degree[f] == (f == 3 ? 3 : 4));
        }
        while (k-- > 0) GPROJT_CHECK(gproj_edit_remove_strip(e, strip[k], 1, NULL) >= 0);
        after = gprojt_edit_mesh(e);
        GPROJT_CHECK(after && gprojt_same_faces(before, after));
        gproj_mesh_destroy(before), gproj_mesh_destroy(after);
        gproj_edit_destroy(e);
    }
}

GPROJT_TEST(strips_that_cross_themselves) {
    uint64_t state = 11;
    int round, crossed = 0;
    for (round = 0; round < 60; ++round) {
        gproj_edit *e = gprojt_edit_shape(round % 2 ? 6 : 0, 4);
        int32_t k, edge, strip, f, twice, more[3];
        gproj_mesh *mesh, *after;
        bool quads = true;
        for (k = 0; k < 8 && quads; ++k)
            quads = gprojt_collapse_quad(e, gprojt_some_face(e, &state), gprojt_below(&state, 2));
        mesh = gprojt_edit_mesh(e);
        for (edge = 0; quads && mesh && edge < mesh->edge_count; ++edge) {
            gproj_edit *cut = gproj_edit_create(mesh, NULL, NULL);
            twice = gprojt_count_strip(cut, edge, more);
            strip = gproj_edit_insert_strip(cut, edge, 0.4, NULL);
            GPROJT_CHECK(strip >= 0 && cut->face_count == mesh->face_count + more[2] &&
                         cut->vertex_count == mesh->vertex_count + more[0]);
            for (f = 0; f < cut->face_count; ++f) GPROJT_CHECK(cut->face_degree[f] == 4);
            if (twice && strip >= 0) {
                ++crossed;
                GPROJT_CHECK(gproj_edit_remove_strip(cut, strip, 1, NULL) >= 0);
                after = gprojt_edit_mesh(cut);
                GPROJT_CHECK(after && gprojt_same_faces(mesh, after));
                gproj_mesh_destroy(after);
            }
            gproj_edit_destroy(cut);
        }
        gproj_mesh_destroy(mesh);
        gproj_edit_destroy(e);
    }
    GPROJT_CHECK(crossed > 100);
}

/* A strip is cut at the parameter, in one direction along all of it. */
GPROJT_TEST(strips_are_cut_where_asked) {
    gprojt_soup s = gprojt_quad_grid(3, 2);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
    int32_t edge = gproj_edit_edge(e, 4, 5), from = mesh->origin[2 * edge], v;
    double x = from == 4 ? 0.25 : 0.75;
    GPROJT_CHECK(gproj_edit_insert_strip(e, edge, x, NULL) >= 0 && e->vertex_count == 15 && e->face_count == 8);
    for (v = 12; v < 15; ++v) GPROJT_NEAR(e->position[3 * v], 0.25 / 3, 1e-15);
    for (v = 12; v < 15 && (edge = gproj_edit_edge(e, 4, v)) < 0; ++v) {
    }
    GPROJT_CHECK(gproj_edit_remove_strip(e, edge, 0.5, NULL) == 3); /* between x = 0 and 0.25 / 3 */
    for (v = 0; v < 12; v += 4) GPROJT_NEAR(e->position[3 * v], 0.125 / 3, 1e-15);
    gproj_edit_destroy(e);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

/* -- triangles -- */

/* A polygon in a plane of its own: corners (x, y) to x u + y v. Signed areas of triangles are measured along u x v. */
static gproj_edit *gprojt_polygon_edit(int32_t count, const double *xy) {
    static const double u[3] = {0.6, 0, 0.8}, v[3] = {0, 1, 0};
    double *position = (double *)malloc((size_t)count * 3 * sizeof(double));
    int32_t *corner = (int32_t *)malloc((size_t)count * sizeof(int32_t)), i, k;
    gproj_mesh *mesh;
    gproj_edit *edit;
    for (i = 0; i < count; ++i) {
        for (k = 0; k < 3; ++k) position[3 * i + k] = xy[2 * i] * u[k] + xy[2 * i + 1] * v[k];
        corner[i] = i;
    }
    mesh = gproj_mesh_create(count, position, 1, &count, corner, NULL, NULL);
    edit = gproj_edit_create(mesh, NULL, NULL);
    gproj_mesh_destroy(mesh);
    free(position);
    free(corner);
    return edit;
}

/* Cut into triangles, none turned over, with the same total area. Returns the least of 2 area / (sum of squared sides).
   */
static double gprojt_check_triangles(gproj_edit *e) {
    gproj_mesh *before = gprojt_edit_mesh(e), *after;
    double whole[3], area[3], sum = 0, least = 1, size;
    int32_t f, h;
    gproj_mesh_face_area_vector(before, 0, whole);
    size = gprojt_length3(whole);
    GPROJT_CHECK(gproj_edit_triangulate(e, 0, NULL) == before->face_degree[0] - 3);
    after = gprojt_edit_mesh(e);
    for (f = 0; f < after->face_count; ++f) {
        double squares = 0, along;
        gproj_mesh_face_area_vector(after, f, area);
        along = gprojt_dot3(area, whole) / size;
        GPROJT_CHECK(after->face_degree[f] == 3 && along > 0);
        sum += gprojt_length3(area);
        h = after->face_halfedge[f];
        do {
            double d[3];
            gprojt_sub3(after->position + 3 * after->origin[h], after->position + 3 * after->origin[h ^ 1], d);
            squares += gprojt_dot3(d, d);
            h = after->next[h];
        } while (h != after->face_halfedge[f]);
        if (2 * along / squares < least) least = 2 * along / squares;
    }
    GPROJT_NEAR(sum, size, 1e-12 * size);
    gproj_mesh_destroy(before);
    gproj_mesh_destroy(after);
    return least;
}

GPROJT_TEST(polygons_that_are_not_convex) {
    uint64_t state = 2;
    int32_t n, i;
    int round;
    for (round = 0; round < 200; ++round) { /* stars with random radii */
        double xy[400];
        gproj_edit *e;
        n = 4 + gprojt_below(&state, round % 20 ? 30 : 190);
        for (i = 0; i < n; ++i) {
            double angle = 6.283185307179586 * (i + 0.5 * gprojt_uniform(&state)) / n, r = 0.2 + gprojt_uniform(&state);
            xy[2 * i] = r * cos(angle), xy[2 * i + 1] = r * sin(angle);
        }
        e = gprojt_polygon_edit(n, xy);
        gprojt_check_triangles(e);
        gproj_edit_destroy(e);
    }
}

/* A comb of `teeth` teeth, a spiral, and a dart. */
GPROJT_TEST(combs_spirals_darts) {
    static const double dart[8] = {0, 0, 2, 0, 0.5, 0.5, 0, 2};
    double *xy = (double *)malloc(2 * 1700 * sizeof(double));
    gproj_edit *e;
    int32_t i, teeth, n = 0;
    for (teeth = 2; teeth < 501; teeth = 5 * teeth + 90) {
        n = 0;
        for (i = 0; i < teeth; ++i) {
            xy[2 * n] = 2 * i, xy[2 * n++ + 1] = 0;
            xy[2 * n] = 2 * i + 0.5, xy[2 * n++ + 1] = -8;
            xy[2 * n] = 2 * i + 1, xy[2 * n++ + 1] = 0.1 * (i & 1);
        }
        xy[2 * n] = 2 * teeth - 1, xy[2 * n++ + 1] = 1;
        xy[2 * n] = 0, xy[2 * n++ + 1] = 1;
        e = gprojt_polygon_edit(n, xy);
        gprojt_check_triangles(e);
        gproj_edit_destroy(e);
    }
    for (i = 0, n = 300; i < n; ++i) { /* out along a spiral and back beside it */
        double along = i < n / 2 ? i : n - 1 - i, r = along + (i < n / 2 ? 1.0 : 9.0), angle = 0.15 * along;
        xy[2 * i] = r * cos(angle), xy[2 * i + 1] = r * sin(angle);
    }
    e = gprojt_polygon_edit(n, xy);
    gprojt_check_triangles(e);
    gproj_edit_destroy(e);
    e = gprojt_polygon_edit(4, dart); /* the one diagonal that is inside */
    gprojt_check_triangles(e);
    GPROJT_CHECK(gproj_edit_edge(e, 0, 2) >= 0 && gproj_edit_edge(e, 1, 3) < 0);
    gproj_edit_destroy(e);
    free(xy);
}

/* A face of very many corners, each with its own triangle: work that grew with the square would take minutes. */
GPROJT_TEST(a_face_of_very_many_corners) {
    enum {
        MANY = 150000
    };
    double *xy = (double *)malloc(2 * MANY * sizeof(double));
    gproj_edit *e;
    int32_t i;
    for (i = 0; i < MANY; ++i)
        xy[2 * i] = cos(6.283185307179586 * i / MANY), xy[2 * i + 1] = sin(6.283185307179586 * i / MANY);
    e = gprojt_polygon_edit(MANY, xy);
    gprojt_check_triangles(e);
    gproj_edit_destroy(e);
    free(xy);
}

/* Very many quads around a vertex, each with a diagonal that might be an edge of it: likewise. */
GPROJT_TEST(a_vertex_of_very_many_faces) {
    enum {
        MANY = 100000
    };
    double *x = (double *)calloc(3 * (2 * MANY + 1), sizeof(double));
    int32_t *corner = (int32_t *)malloc(5 * MANY * sizeof(int32_t)), *degree = corner + 4 * MANY, i;
    gproj_mesh *mesh;
    gproj_edit *e;
    for (i = 0; i < 2 * MANY; ++i) {
        x[3 * i + 3] = cos(3.141592653589793 * i / MANY), x[3 * i + 4] = sin(3.141592653589793 * i / MANY);
        corner[2 * i] = i % 2 ? i + 1 : 0, corner[2 * i + 1] = i % 2 ? (i + 1) % (2 * MANY) + 1 : i + 1;
        degree[i / 2] = 4;
    }
    mesh = gproj_mesh_create(2 * MANY + 1, x, MANY, degree, corner, NULL, NULL);
    e = gproj_edit_create(mesh, NULL, NULL);
    GPROJT_CHECK(e && gproj_edit_triangulate(e, -1, NULL) == MANY);
    for (i = 0; e && i < MANY; ++i) /* from the vertex to the opposite corners, not across */
        GPROJT_CHECK(gproj_edit_edge(e, 0, 2 * i + 1) >= 0 && gproj_edit_edge(e, 2 * i + 2, 0) >= 0);
    gproj_edit_destroy(e);
    gproj_mesh_destroy(mesh);
    free(corner);
    free(x);
}

/* All triangulations of small convex polygons, by brute force: none is better. */
static double gprojt_cost(const double *xy, int32_t a, int32_t b, int32_t c) {
    double ux = xy[2 * b] - xy[2 * a], uy = xy[2 * b + 1] - xy[2 * a + 1], vx = xy[2 * c] - xy[2 * b],
           vy = xy[2 * c + 1] - xy[2 * b + 1];
    return (ux * ux + uy * uy + vx * vx + vy * vy + (ux + vx) * (ux + vx) + (uy + vy) * (uy + vy)) /
           (ux * vy - uy * vx);
}
static double gprojt_least_cost(const double *xy, int32_t first, int32_t last) {
    double least = HUGE_VAL;
    int32_t k;
    if (last < first + 2) return 0;
    for (k = first + 1; k < last; ++k) {
        double sum = gprojt_cost(xy, first, k, last) + gprojt_least_cost(xy, first, k) + gprojt_least_cost(xy, k, last);
        if (sum < least) least = sum;
    }
    return least;
}
GPROJT_TEST(triangles_are_the_best) {
    uint64_t state = 8;
    int round;
    for (round = 0; round < 50; ++round) {
        double xy[16], sum = 0;
        int32_t n = 4 + round % 5, i, f, h;
        gproj_edit *e;
        for (i = 0; i < n; ++i) {
            double angle = 6.283185307179586 * (i + 0.8 * gprojt_uniform(&state)) / n;
            xy[2 * i] = 3 * cos(angle), xy[2 * i + 1] = sin(angle);
        }
        e = gprojt_polygon_edit(n, xy);
        gprojt_check_triangles(e);
        for (f = 0; f < e->face_count; ++f) {
            h = e->face_halfedge[f];
            sum += gprojt_cost(xy, e->origin[h], e->origin[e->next[h]], e->origin[e->prev[h]]);
        }
        GPROJT_NEAR(sum, gprojt_least_cost(xy, 0, n - 1), 1e-9 * sum);
        gproj_edit_destroy(e);
    }
}

/* Polygons that cross themselves need triangles turned over: cost 1 / x with x = 2 area / (a^2 + b^2 + c^2) goes on below
   1e-6 by its tangent, so that the least turned are taken. */
static double gprojt_turned_cost(const double *xy, int32_t a, int32_t b, int32_t c) {
    double x = 1 / gprojt_cost(xy, a, b, c), least = 1e-6;
    return x >= least ? 1 / x : 1 / least - (x - least) / (least * least);
}
static double gprojt_least_turned_cost(const double *xy, int32_t first, int32_t last) {
    double least = last < first + 2 ? 0 : HUGE_VAL;
    int32_t k;
    for (k = first + 1; k < last; ++k)
        least = fmin(least, gprojt_turned_cost(xy, first, k, last) + gprojt_least_turned_cost(xy, first, k) +
                                gprojt_least_turned_cost(xy, k, last));
    return least;
}
GPROJT_TEST(triangles_are_turned_least) {
    uint64_t state = 5;
    int32_t round, turned = 0;
    for (round = 0; round < 60; ++round) {
        double xy[16], sum = 0, area = 0, sign;
        int32_t n = 5 + round % 4, i, f, h;
        gproj_edit *e;
        for (i = 0; i < 2 * n; ++i) xy[i] = gprojt_uniform(&state);
        for (i = 0; i < n; ++i) area += xy[2 * i] * xy[2 * ((i + 1) % n) + 1] - xy[2 * ((i + 1) % n)] * xy[2 * i + 1];
        if (fabs(area) < 0.1) continue;
        e = gprojt_polygon_edit(n, xy);
        GPROJT_CHECK(gproj_edit_triangulate(e, -1, NULL) == n - 3);
        sign = area < 0 ? -1 : 1; /* seen from where it turns left */
        for (i = 0; i < n; ++i) xy[2 * i] *= sign;
        for (f = 0; f < e->face_count; ++f) {
            h = e->face_halfedge[f];
            sum += gprojt_turned_cost(xy, e->origin[h], e->origin[e->next[h]], e->origin[e->prev[h]]);
        }
        GPROJT_NEAR(sum, gprojt_least_turned_cost(xy, 0, n - 1), 1e-9 * sum);
        turned += sum > 1e6;
        gproj_edit_destroy(e);
    }
    GPROJT_CHECK(turned > 20);
}

/* The torus of 7 vertices (Moebius 1861): each two have an edge, so a face that was joined from its triangles can only
   be cut as it was. */
GPROJT_TEST(diagonals_that_are_edges) {
    double position[21];
    int32_t degree[14], corner[42], faces, corners, i, k, join;
    gproj_mesh *mesh;
    gproj_edit *e;
    gproj_error error;
    for (i = 0; i < 7; ++i) position[3 * i] = i, position[3 * i + 1] = i * i % 5, position[3 * i + 2] = i * i * i % 7;
    for (join = 0; join < 7; ++join) {
        faces = corners = 0;
        for (i = 0; i < 7; ++i) { /* triangles i, i+1, i+3 and i, i+3, i+2; those of `join` make a quad */
            int32_t quad[4];
            quad[0] = i, quad[1] = (i + 1) % 7, quad[2] = (i + 3) % 7, quad[3] = (i + 2) % 7;
            if (i == join) {
                for (k = 0; k < 4; ++k) corner[corners++] = quad[k];
                degree[faces++] = 4;
                continue;
            }
            corner[corners++] = quad[0], corner[corners++] = quad[1], corner[corners++] = quad[2];
            corner[corners++] = quad[0], corner[corners++] = quad[2], corner[corners++] = quad[3];
            degree[faces++] = 3, degree[faces++] = 3;
        }
        mesh = gproj_mesh_create(7, position, faces, degree, corner, NULL, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        e = gproj_edit_create(mesh, NULL, NULL);
        GPROJT_CHECK(gproj_edit_edge(e, join, (join + 3) % 7) == -1);
        GPROJT_CHECK(gproj_edit_triangulate(e, -1, &error) == 1 && gproj_edit_edge(e, join, (join + 3) % 7) >= 0);
        gproj_mesh_destroy(mesh);
        mesh = gprojt_edit_mesh(e);
        GPROJT_CHECK(mesh && mesh->face_count == 14 && mesh->edge_count == 21);
        gproj_mesh_destroy(mesh);
        gproj_edit_destroy(e);
    }
}

/* A face without area, whose every other ear is a triangle already: it is cut where it can be. */
GPROJT_TEST(every_other_ear_is_an_edge) {
    gprojt_soup s;
    gproj_error error;
    int32_t i, face[200];
    gproj_mesh *mesh;
    gproj_edit *e;
    memset(&s, 0, sizeof s);
    for (i = 0; i < 200; ++i) face[i] = gprojt_add_vertex(&s, i, 0, 0);
    gprojt_add_face(&s, 200, face);
    for (i = 1; i < 200; i += 2) gprojt_add_triangle(&s, (i + 2) % 200, (i + 1) % 200, i);
    e = gprojt_edit_soup(s);
    GPROJT_REQUIRE(e != NULL);
    GPROJT_CHECK(gproj_edit_triangulate(e, -1, &error) == 197);
    mesh = gprojt_edit_mesh(e);
    GPROJT_CHECK(mesh && mesh->face_count == 298 && mesh->edge_count == 300 + 197);
    gproj_mesh_destroy(mesh);
    gproj_edit_destroy(e);
}

/* Faces squeezed to a strip, with few corners and with many: no triangle is turned over, however thin it is. */
GPROJT_TEST(thin_faces) {
    uint64_t state = 77;
    int trial;
    for (trial = 0; trial < 400; ++trial) {
        int32_t n = trial % 4 == 3 ? 150 + gprojt_below(&state, 60) : 4 + gprojt_below(&state, 9), face[210], i;
        double thin = pow(10, -(double)(trial % 9)), area[3];
        gprojt_soup s;
        gproj_mesh *mesh;
        gproj_edit *e;
        memset(&s, 0, sizeof s);
        if (n > 100) thin = fmax(thin, 1e-4);
        for (i = 0; i < n; ++i) { /* seen from the middle, corners come in order */
            double u = 2 * acos(-1.0) * i / n, r = 0.2 + gprojt_uniform(&state);
            face[i] = gprojt_add_vertex(&s, r * cos(u), thin * r * sin(u), 0);
        }
        gprojt_add_face(&s, n, face);
        e = gprojt_edit_soup(s);
        GPROJT_REQUIRE(e != NULL);
        GPROJT_CHECK(gproj_edit_triangulate(e, -1, NULL) == n - 3);
        mesh = gprojt_edit_mesh(e);
        for (i = 0; mesh && i < mesh->face_count; ++i) {
            gproj_mesh_face_area_vector(mesh, i, area);
            GPROJT_CHECK(area[2] > -1e-15 * thin);
        }
        gproj_mesh_destroy(mesh);
        gproj_edit_destroy(e);
    }
}

/* Positions whose squares are beyond all numbers, though the area is not: triangles all the same. */
GPROJT_TEST(triangles_of_the_largest_size) {
    double scale;
    for (scale = 0.5e154; scale < 1.4e154; scale += 0.02e154) {
        static const int32_t corner[] = {0, 1, 2, 3, 4, 5, 6};
        gprojt_soup s;
        gproj_error error;
        gproj_mesh *mesh;
        gproj_edit *e;
        int32_t i;
        memset(&s, 0, sizeof s);
        gprojt_add_vertex(&s, 0, 0, 0);
        for (i = 0; i < 6; ++i) gprojt_add_vertex(&s, cos(1.0472 * i), sin(1.0472 * i), 0);
        gprojt_add_face(&s, 7, corner);
        e = gprojt_edit_soup(s);
        for (i = 0; i < 21; ++i) e->position[i] *= scale;
        GPROJT_CHECK(gproj_edit_triangulate(e, 0, &error) == 4);
        for (i = 0; i < 21; ++i) e->position[i] /= scale;
        mesh = gprojt_edit_mesh(e);
        GPROJT_CHECK(mesh && mesh->face_count == 5);
        gproj_mesh_destroy(mesh);
        gproj_edit_destroy(e);
    }
}

/* -- the dual -- */

GPROJT_TEST(dual_of_the_dual) {
    int shape;
    int32_t n, v, h, k;
    for (shape = 4; shape < GPROJT_SHAPES; shape += 2) { /* closed */
        for (n = 1; n < 5; ++n) {
            gprojt_soup s = gprojt_shape(shape, n);
            gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL), *dual, *again;
            int32_t *face = (int32_t *)malloc((size_t)mesh->vertex_count * sizeof(int32_t));
            dual = gproj_mesh_dual(mesh, face, NULL, NULL);
            again = gproj_mesh_dual(dual, NULL, NULL, NULL);
            GPROJT_CHECK(dual && again && !gprojt_validate_mesh(dual) && !gprojt_validate_mesh(again));
            GPROJT_CHECK(dual->vertex_count == mesh->face_count && dual->face_count == mesh->vertex_count &&
                         dual->edge_count == mesh->edge_count && dual->reoriented_count == 0);
            for (v = 0; v < mesh->vertex_count; ++v)
                GPROJT_CHECK(face[v] == v && dual->face_degree[v] == gproj_mesh_valence(mesh, v));
            memcpy(again->position, mesh->position, (size_t)mesh->vertex_count * 3 * sizeof(double));
            GPROJT_CHECK(gprojt_same_faces(mesh, again));
            for (v = 0; v < dual->vertex_count; ++v) { /* the mean of the corners, on the same side */
                double mean[3] = {0, 0, 0};
                for (h = mesh->face_halfedge[v], k = 0; k < mesh->face_degree[v]; ++k, h = mesh->next[h]) {
                    const double *x = mesh->position + 3 * mesh->origin[h];
                    mean[0] += x[0], mean[1] += x[1], mean[2] += x[2];
                }
                for (k = 0; k < 3; ++k) GPROJT_NEAR(dual->position[3 * v + k], mean[k] / mesh->face_degree[v], 1e-15);
            }
            gproj_mesh_destroy(mesh);
            gproj_mesh_destroy(dual);
            gproj_mesh_destroy(again);
            gprojt_soup_free(&s);
            free(face);
        }
    }
}

/* At the boundary the dual ends where the mesh does. */
GPROJT_TEST(the_dual_names_the_vertices_given) {
    gprojt_soup s = gprojt_quad_grid(4, 4);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL);
    gproj_error error;
    gprojt_soup_free(&s);
    mesh->position[3 * 12 + 1] = NAN;
    GPROJT_CHECK(!gproj_mesh_dual(mesh, NULL, NULL, &error) && error.code == GPROJ_ERROR_NUMBER);
    GPROJT_CHECK(error.place == GPROJ_PLACE_VERTEX && error.index == 12);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(dual_with_boundary) {
    gprojt_soup s = gprojt_quad_grid(4, 3);
    gproj_mesh *mesh, *dual;
    int shape, v, k;
    for (v = 0; v < s.vertex_count; ++v) s.position[3 * v + 2] = 0;
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    dual = gproj_mesh_dual(mesh, NULL, NULL, NULL);
    GPROJT_REQUIRE(dual != NULL);
    GPROJT_CHECK(dual->face_count == 20 && dual->vertex_count == 12 + 14 + 4 && dual->loop_count == 1);
    for (k = 0; k < dual->face_count; ++k) GPROJT_CHECK(dual->face_degree[k] == 4);
    for (k = 0; k < 4; ++k) /* the corners of the grid stay */
        for (v = 0; v < 3; ++v)
            GPROJT_CHECK(dual->position[3 * (26 + k) + v] == mesh->position[3 * (k % 2 * 4 + k / 2 * 15) + v]);
    gproj_mesh_destroy(dual);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        s = gprojt_shape(shape, 4);
        mesh = gprojt_soup_mesh(&s, NULL, NULL);
        dual = gproj_mesh_dual(mesh, NULL, NULL, NULL);
        GPROJT_CHECK(dual && !gprojt_validate_mesh(dual) && dual->loop_count == mesh->loop_count &&
                     dual->face_count == mesh->vertex_count && gprojt_euler(dual) == gprojt_euler(mesh));
        for (v = 0; v < dual->face_count; ++v) { /* the vertex's side: normals agree */
            double a[3], b[3] = {0, 0, 0}, n[3];
            int32_t h = mesh->vertex_halfedge[v];
            gproj_mesh_face_area_vector(dual, v, a);
            do {
                if (mesh->face[h] >= 0) gproj_mesh_face_area_vector(mesh, mesh->face[h], n);
                if (mesh->face[h] >= 0) b[0] += n[0], b[1] += n[1], b[2] += n[2];
                h = mesh->prev[h] ^ 1;
            } while (h != mesh->vertex_halfedge[v]);
            GPROJT_CHECK(gprojt_dot3(a, b) > 0.8 * gprojt_length3(a) * gprojt_length3(b));
        }
        gproj_mesh_destroy(dual);
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&s);
    }
    /* polylines of points without a face go with them */
    mesh = gprojt_lined_grid();
    dual = gproj_mesh_dual(mesh, NULL, NULL, NULL);
    GPROJT_CHECK(dual && !gprojt_validate_mesh(dual) && dual->polyline_count == 1 && dual->isolated_count == 2);
    GPROJT_CHECK(dual && !memcmp(dual->position + 3 * (dual->vertex_count - 2), mesh->position + 36, 48));
    gproj_mesh_destroy(dual);
    gproj_mesh_destroy(mesh);
}

/* -- the mesh along the diagonals -- */

/* Vertices of valence 4, amid the edges; faces around faces and around vertices, on their sides. */
GPROJT_TEST(diagonals_of_shapes) {
    int shape, k;
    int32_t e, f, h, v, n;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gprojt_soup s = gprojt_shape(shape, 4);
        gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL), *along = gproj_mesh_diagonals(mesh, NULL, NULL);
        int32_t kept = mesh->edge_count;
        GPROJT_REQUIRE(along != NULL);
        GPROJT_CHECK(!gprojt_validate_mesh(along) && gprojt_euler(along) == gprojt_euler(mesh));
        GPROJT_CHECK(along->loop_count == mesh->loop_count && along->reoriented_count == 0);
        GPROJT_CHECK(along->face_count == mesh->face_count + mesh->vertex_count);
        for (e = 0; e < mesh->edge_count; ++e) {
            const double *a = mesh->position + 3 * mesh->origin[2 * e], *b = mesh->position + 3 * mesh->origin[2 * e + 1];
            for (k = 0; k < 3; ++k) GPROJT_NEAR(along->position[3 * e + k], (a[k] + b[k]) / 2, 1e-15);
            if (mesh->face[2 * e + 1] >= 0) GPROJT_CHECK(gproj_mesh_valence(along, e) == 4);
        }
        for (f = 0; f < mesh->face_count; ++f) { /* the midpoints of the sides, in their order */
            GPROJT_CHECK(along->face_degree[f] == mesh->face_degree[f]);
            for (h = mesh->face_halfedge[f], n = along->face_halfedge[f], k = 0; k < mesh->face_degree[f]; ++k) {
                GPROJT_CHECK(along->origin[n] == h / 2);
                h = mesh->next[h], n = along->next[n];
            }
        }
        for (v = 0; v < mesh->vertex_count; ++v) { /* the midpoints of its edges, and the vertex if it is a corner */
            bool corner = gproj_mesh_is_boundary_vertex(mesh, v) && gproj_mesh_valence(mesh, v) == 2;
            n = along->face_halfedge[mesh->face_count + v];
            GPROJT_CHECK(along->face_degree[mesh->face_count + v] >= gproj_mesh_valence(mesh, v) + corner);
            for (k = 0; k < gproj_mesh_valence(mesh, v); ++k, n = along->next[n]) {
                e = along->origin[n];
                GPROJT_CHECK(e < mesh->edge_count && (mesh->origin[2 * e] == v || mesh->origin[2 * e + 1] == v));
            }
            if (k == along->face_degree[mesh->face_count + v]) continue;
            GPROJT_CHECK(k + 1 == along->face_degree[mesh->face_count + v] && along->origin[n] == kept++);
            GPROJT_CHECK(!memcmp(along->position + 3 * along->origin[n], mesh->position + 3 * v, 3 * sizeof(double)));
        }
        GPROJT_CHECK(along->vertex_count == kept);
        gproj_mesh_destroy(along);
        gproj_mesh_destroy(mesh);
        gprojt_soup_free(&s);
    }
}

/* A hyperbolic paraboloid's straight lines: no quad between them is flat, all between their midpoints are. Polylines of
   vertices that stay go with them. */
GPROJT_TEST(diagonals_of_straight_lines_are_flat) {
    gprojt_soup s = gprojt_quad_grid(6, 5);
    gproj_mesh *mesh, *along;
    gproj_error error;
    int32_t v;
    for (v = 0; v < s.vertex_count; ++v) s.position[3 * v + 2] = s.position[3 * v] * s.position[3 * v + 1];
    mesh = gprojt_soup_mesh(&s, NULL, NULL);
    along = gproj_mesh_diagonals(mesh, NULL, NULL);
    GPROJT_REQUIRE(mesh && along);
    GPROJT_CHECK(gproj_measure(mesh, NULL, NULL).planarity_max > 0.01);
    GPROJT_CHECK(gproj_measure(along, NULL, NULL).planarity_max < 1e-14);
    GPROJT_CHECK(along->vertex_count == 6 * 6 + 7 * 5 + 4 && along->face_count == 30 + 42);
    mesh->position[3 * 7] = INFINITY;
    GPROJT_CHECK(gprojt_mesh_was_refused(gproj_mesh_diagonals(mesh, NULL, &error), &error, GPROJ_ERROR_NUMBER,
                                         GPROJ_PLACE_VERTEX, 7, "vertex 7"));
    GPROJT_CHECK(!gproj_mesh_diagonals(NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    gproj_mesh_destroy(along);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
    mesh = gprojt_lined_grid();
    along = gproj_mesh_diagonals(mesh, NULL, NULL);
    GPROJT_CHECK(along && !gprojt_validate_mesh(along) && along->polyline_count == 1 && along->isolated_count == 2);
    GPROJT_CHECK(along && !memcmp(along->position + 3 * (along->vertex_count - 2), mesh->position + 36, 48));
    gproj_mesh_destroy(along);
    gproj_mesh_destroy(mesh);
}

/* A mesh of vertices alone is edited into itself, and is its dual. */
GPROJT_TEST(nothing_but_vertices) {
    static const double position[6] = {0, 1, 2, 3, 4, 5};
    gproj_mesh *mesh = gproj_mesh_create(2, position, 0, NULL, NULL, NULL, NULL), *after, *dual;
    gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
    int32_t face[2] = {7, 7};
    GPROJT_CHECK(gproj_edit_triangulate(e, -1, NULL) == 0 && gproj_edit_edge(e, 0, 1) == -1);
    GPROJT_CHECK(gproj_edit_split_edge(e, 0, 0.5, NULL) == -1);
    after = gprojt_edit_mesh(e);
    dual = gproj_mesh_dual(mesh, face, NULL, NULL);
    GPROJT_CHECK(after && gprojt_same_mesh(mesh, after) && dual && gprojt_same_mesh(mesh, dual));
    GPROJT_CHECK(face[0] == -1 && face[1] == -1);
    gproj_mesh_destroy(after);
    gproj_mesh_destroy(dual);
    gproj_mesh_destroy(mesh);
    gproj_edit_destroy(e);
}

/* -- large ones -- */

/* Thousands of edits in one go: a grid loses nine vertices of ten, its shortest edges first, more or less. */
GPROJT_TEST(a_large_mesh_made_small) {
    gprojt_soup s = gprojt_hybrid_grid(100, 100);
    gproj_mesh *mesh = gprojt_soup_mesh(&s, NULL, NULL), *after;
    gproj_edit *e = gproj_edit_create(mesh, NULL, NULL);
    int32_t edge, collapsed = 0;
    double length;
    for (length = 0.012; length < 0.1; length *= 1.3) {
        for (edge = 0; edge < mesh->edge_count; ++edge) {
            int32_t h = 2 * edge;
            if (e->origin[h] < 0 || gprojt_at_boundary(e, edge)) continue;
            if (gprojt_far(e->position + 3 * e->origin[h], e->position + 3 * e->origin[h ^ 1]) > length) continue;
            collapsed += gproj_edit_collapse_edge(e, edge, 0.5, NULL) >= 0;
        }
    }
    GPROJT_CHECK(collapsed > 8500);
    after = gprojt_edit_mesh(e);
    GPROJT_CHECK(after && after->vertex_count == mesh->vertex_count - collapsed && after->loop_count == 1 &&
                 gprojt_euler(after) == 1);
    gproj_mesh_destroy(after);
    gproj_edit_destroy(e);
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&s);
}

/* -- refusals -- */

static bool gprojt_refused(int32_t result, const gproj_error *error, gproj_code code, gproj_place place, int64_t index,
                           const char *piece) {
    const char *noun = place == GPROJ_PLACE_EDGE ? "edge" : place == GPROJ_PLACE_FACE ? "face" : "vertex";
    char name[32];
    bool right = result == -1 && error->code == code && error->place == place && error->index == index &&
                 strstr(error->message, piece) && !strchr(error->message, '\n');
    snprintf(name, sizeof name, "%s %ld", noun, (long)index);
    right = right && (place == GPROJ_PLACE_NONE || strstr(error->message, name));
    if (!right)
        printf("  result %d code %d place %d index %ld: %s\n", result, (int)error->code, (int)error->place,
               (long)error->index, error->message);
    return right;
}
#define GPROJT_REFUSED(call, code, place, index, piece) \
    GPROJT_CHECK(gprojt_refused(call, &error, GPROJ_ERROR_##code, GPROJ_PLACE_##place, index, piece))

GPROJT_TEST(arguments_are_checked) {
    gproj_edit *e = gprojt_edit_shape(0, 3); /* 3 x 4 quads */
    gproj_error error;
    int32_t edge = gproj_edit_edge(e, 5, 6), face = e->face[2 * edge];
    uint64_t before = gprojt_edit_hash(e);
    GPROJT_REFUSED(gproj_edit_split_edge(e, -1, 0.5, &error), INDEX, EDGE, -1, "edge -1 does not exist");
    GPROJT_REFUSED(gproj_edit_split_edge(e, e->edge_count, 0.5, &error), INDEX, EDGE, 31, "they are 0 to 30");
    GPROJT_REFUSED(gproj_edit_split_edge(e, edge, 1.5, &error), ARGUMENT, EDGE, edge, "1.5");
    GPROJT_REFUSED(gproj_edit_collapse_edge(e, edge, (double)NAN, &error), ARGUMENT, EDGE, edge, "not from 0 to 1");
    GPROJT_REFUSED(gproj_edit_insert_strip(e, edge, -0.1, &error), ARGUMENT, EDGE, edge, "not from 0 to 1");
    GPROJT_REFUSED(gproj_edit_remove_strip(e, 99, 0.5, &error), INDEX, EDGE, 99, "edge 99 does not exist");
    GPROJT_REFUSED(gproj_edit_split_face(e, 12, 0, 1, &error), INDEX, FACE, 12, "face 12 does not exist");
    GPROJT_REFUSED(gproj_edit_split_face(e, face, 5, 20, &error), INDEX, VERTEX, 20, "vertex 20 does not exist");
    GPROJT_REFUSED(gproj_edit_split_face(e, face, 19, 5, &error), ARGUMENT, FACE, face, "no corner at vertex 19");
    GPROJT_REFUSED(gproj_edit_split_face(e, face, 5, 19, &error), ARGUMENT, FACE, face, "no corner at vertex 19");
    GPROJT_REFUSED(gproj_edit_split_face(e, face, 5, 5, &error), ARGUMENT, FACE, face, "to itself");
    GPROJT_REFUSED(gproj_edit_split_face(e, face, 5, 6, &error), NON_MANIFOLD, FACE, face, "have an edge already");
    GPROJT_REFUSED(gproj_edit_triangulate(e, -2, &error), INDEX, FACE, -2, "face -2 does not exist");
    GPROJT_CHECK(gprojt_edit_hash(e) == before);
    GPROJT_CHECK(gproj_edit_vertex(e, 20) == -1 && gproj_edit_vertex(e, -1) == -1 && gproj_edit_edge(e, 0, 20) == -1);
    /* removed elements */
    GPROJT_CHECK(gproj_edit_collapse_edge(e, edge, 0, NULL) == 5);
    GPROJT_REFUSED(gproj_edit_split_edge(e, edge, 0.5, &error), INDEX, EDGE, edge, "is no more");
    GPROJT_CHECK(e->face_degree[face] == 3 &&
                 gproj_edit_collapse_edge(e, e->next[e->face_halfedge[face]] / 2, 0, NULL) >= 0);
    GPROJT_REFUSED(gproj_edit_triangulate(e, face, &error), INDEX, FACE, face, "is no more");
    /* no edit, no mesh */
    GPROJT_REFUSED(gproj_edit_triangulate(NULL, -1, &error), ARGUMENT, NONE, -1, "the edit is NULL");
    GPROJT_CHECK(gproj_edit_split_edge(NULL, 0, 0.5, NULL) == -1 && gproj_edit_split_face(NULL, 0, 0, 2, NULL) == -1);
    GPROJT_CHECK(gproj_edit_collapse_edge(NULL, 0, 0.5, NULL) == -1 && gproj_edit_edge(NULL, 0, 1) == -1);
    GPROJT_CHECK(gproj_edit_insert_strip(NULL, 0, 0.5, NULL) == -1 &&
                 gproj_edit_remove_strip(NULL, 0, 0.5, NULL) == -1);
    GPROJT_CHECK(!gproj_edit_mesh(NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_edit_create(NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(!gproj_mesh_dual(NULL, NULL, NULL, &error) && error.code == GPROJ_ERROR_ARGUMENT);
    GPROJT_CHECK(gproj_edit_memory(NULL).used == 0 && gproj_edit_memory(e).used > 0);
    gproj_edit_destroy(NULL);
    /* positions that no mesh has; the edit goes on */
    e->position[7] = HUGE_VAL;
    GPROJT_CHECK(gproj_edit_triangulate(e, e->face[e->vertex_halfedge[2] ^ 1], &error) == 1);
    GPROJT_CHECK(!gproj_edit_mesh(e, NULL, &error) && error.code == GPROJ_ERROR_NUMBER && !e->vertex_number);
    e->position[7] = 0, e->position[3 * 19] = HUGE_VAL; /* vertices before it are merged */
    GPROJT_CHECK(!gproj_edit_mesh(e, NULL, &error) && error.place == GPROJ_PLACE_VERTEX && error.index == 19 &&
                 strstr(error.message, "x of vertex 19 "));
    e->position[3 * 19] = 0;
    gproj_mesh_destroy(gprojt_edit_mesh(e));
    gproj_edit_destroy(e);
}

static gproj_edit *gprojt_edit_of(int32_t vertices, int32_t faces, const int32_t *degree, const int32_t *corner) {
    double position[60] = {0};
    gproj_mesh *mesh;
    gproj_edit *e;
    int32_t i;
    for (i = 0; i < 3 * vertices; ++i) position[i] = sin(1.0 + i);
    mesh = gproj_mesh_create(vertices, position, faces, degree, corner, NULL, NULL);
    e = gproj_edit_create(mesh, NULL, NULL);
    GPROJT_CHECK(e != NULL);
    gproj_mesh_destroy(mesh);
    return e;
}

GPROJT_TEST(what_would_be_no_mesh_is_refused) {
    static const int32_t three[8] = {3, 3, 3, 3, 3, 3, 3, 3}, quads[4] = {4, 4, 4, 4}, mixed[4] = {4, 5, 5, 3};
    static const int32_t pillow[8] = {0, 1, 2, 3, 0, 3, 2, 1}, bag[6] = {0, 1, 2, 0, 2, 1};
    static const int32_t bridge[8] = {0, 1, 2, 3, 3, 2, 4, 5};
    static const int32_t prism[12] = {0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5};
    static const int32_t crossed[17] = {0, 1, 2, 3, 4, 1, 3, 2, 0, 4, 3, 1, 0, 2, 1, 4, 2};
    gproj_error error;
    gproj_mesh *mesh;
    gproj_edit *e;
    int32_t edge, other;
    /* a triangle alone, and two back to back */
    e = gprojt_edit_of(3, 1, three, bag);
    GPROJT_REFUSED(gproj_edit_collapse_edge(e, 0, 0.5, &error), NON_MANIFOLD, EDGE, 0, "face 0 would vanish");
    GPROJT_REFUSED(gproj_edit_insert_strip(e, 0, 0.5, &error), ARGUMENT, EDGE, 0, "no quad at either side");
    GPROJT_CHECK(gproj_edit_triangulate(e, -1, NULL) == 0);
    gproj_edit_destroy(e);
    e = gprojt_edit_of(3, 2, three, bag);
    GPROJT_REFUSED(gproj_edit_collapse_edge(e, 1, 0.5, &error), NON_MANIFOLD, EDGE, 1, "would vanish");
    mesh = gprojt_edit_mesh(e);
    GPROJT_CHECK(gprojt_mesh_was_refused(gproj_mesh_dual(mesh, NULL, NULL, &error), &error, GPROJ_ERROR_NON_MANIFOLD,
                                         GPROJ_PLACE_FACE, 0, "faces 0 and 1 have more than one edge in common"));
    GPROJT_CHECK(gprojt_mesh_was_refused(gproj_mesh_diagonals(mesh, NULL, &error), &error, GPROJ_ERROR_NON_MANIFOLD,
                                         GPROJ_PLACE_VERTEX, 0, "inner vertex 0 has two edges"));
    gproj_mesh_destroy(mesh);
    gproj_edit_destroy(e);
    /* two quads back to back: strips of two quads */
    e = gprojt_edit_of(4, 2, quads, pillow);
    for (edge = 0; edge < e->edge_count; ++edge) { /* the quads' other common edge is the opposite one */
        char piece[80];
        snprintf(piece, sizeof piece, "edge %d: its two quads have edge %d in common, too", (int)edge,
                 (int)e->next[e->next[2 * edge]] / 2);
        GPROJT_REFUSED(gproj_edit_insert_strip(e, edge, 0.5, &error), NON_MANIFOLD, EDGE, edge, piece);
    }
    GPROJT_CHECK(gproj_edit_remove_strip(e, 0, 0.5, &error) == -1 &&
                 strstr(error.message, "the strip of edge 0 stays: "));
    GPROJT_CHECK(gproj_edit_triangulate(e, -1, &error) == 2); /* with different diagonals: a tetrahedron */
    gproj_mesh_destroy(gprojt_edit_mesh(e));
    gproj_edit_destroy(e);
    /* from boundary to boundary, and a grid of one row along itself */
    e = gprojt_edit_of(6, 2, quads, bridge);
    edge = gproj_edit_edge(e, 2, 3);
    GPROJT_REFUSED(gproj_edit_collapse_edge(e, edge, 0.5, &error), NON_MANIFOLD, EDGE, edge,
                   "from boundary to boundary");
    GPROJT_CHECK(gproj_edit_remove_strip(e, edge, 0.5, NULL) == -1 &&
                 gproj_edit_remove_strip(e, edge, 0.5, &error) == -1 && strstr(error.message, "stays"));
    GPROJT_CHECK(gproj_edit_remove_strip(e, gproj_edit_edge(e, 0, 3), 0.5, NULL) == 2);
    gproj_edit_destroy(e);
    /* round a prism without lids */
    e = gprojt_edit_of(6, 3, quads, prism);
    edge = gproj_edit_edge(e, 0, 1);
    GPROJT_REFUSED(gproj_edit_collapse_edge(e, edge, 0.5, &error), NON_MANIFOLD, EDGE, edge, "to vertex 2");
    gproj_edit_destroy(e);
    /* both ends are corners of another face */
    e = gprojt_edit_shape(0, 3);
    edge = gproj_edit_edge(e, 5, 6);
    GPROJT_CHECK(gproj_edit_split_edge(e, edge, 0.5, NULL) == 20);
    other = e->face[2 * edge + 1];
    edge = gproj_edit_split_face(e, e->face[2 * edge], 5, 6, NULL);
    GPROJT_REFUSED(gproj_edit_collapse_edge(e, edge, 0.5, &error), NON_MANIFOLD, EDGE, edge, "are corners of face");
    GPROJT_CHECK(e->face_degree[other] == 5);
    gproj_edit_destroy(e);
    /* a quad whose two diagonals are edges elsewhere: then no face is cut */
    e = gprojt_edit_of(5, 4, mixed, crossed);
    GPROJT_REFUSED(gproj_edit_triangulate(e, 0, &error), NON_MANIFOLD, FACE, 0, "its diagonals are edges already");
    GPROJT_REFUSED(gproj_edit_triangulate(e, -1, &error), NON_MANIFOLD, FACE, 0, "its diagonals are edges already");
    GPROJT_CHECK(e->face_count == 4);
    gproj_edit_destroy(e);
}

GPROJT_TEST(spirals_turn_no_triangle_over) {
    int32_t corners;
    for (corners = 140; corners <= 1340; corners += 400) {
        gprojt_soup s;
        gproj_mesh *mesh;
        gproj_edit *e;
        double whole[3], part[3], sum = 0;
        int32_t f;
        memset(&s, 0, sizeof s);
        gprojt_add_spiral(&s, corners);
        mesh = gprojt_soup_mesh(&s, NULL, NULL);
        gproj_mesh_face_area_vector(mesh, 0, whole);
        gproj_mesh_destroy(mesh);
        e = gprojt_edit_soup(s);
        GPROJT_REQUIRE(e != NULL);
        GPROJT_CHECK(gproj_edit_triangulate(e, 0, NULL) == corners - 3);
        mesh = gprojt_edit_mesh(e);
        for (f = 0; f < mesh->face_count; ++f) gproj_mesh_face_area_vector(mesh, f, part), sum += gprojt_length3(part);
        GPROJT_NEAR(sum, gprojt_length3(whole), 1e-9 * sum);
        gproj_mesh_destroy(mesh);
        gproj_edit_destroy(e);
    }
}

/* A face with n corners, and around it a cone of quads i + 1, i, i + 2 and the apex, which have all the diagonals that cut
   off a corner: no triangle can be the first. */
GPROJT_TEST(ears_that_are_edges) {
    static const int32_t sizes[] = {5, 8, 128, 129, 131, 400};
    int32_t k, i, n;
    for (k = 0; k < 6; ++k) {
        gprojt_soup s;
        gproj_error error;
        int32_t face[400];
        uint64_t before;
        gproj_edit *e;
        memset(&s, 0, sizeof s);
        n = sizes[k];
        for (i = 0; i < n; ++i) {
            double angle = 6.283185307179586 * i / n;
            face[i] = gprojt_add_vertex(&s, cos(angle), sin(angle), 0.1 * sin(5 * angle));
        }
        gprojt_add_vertex(&s, 0, 0, -1);
        gprojt_add_face(&s, n, face);
        for (i = 0; i < n; ++i) gprojt_add_quad(&s, (i + 1) % n, i, (i + 2) % n, n);
        e = gprojt_edit_soup(s);
        GPROJT_REQUIRE(e && gproj_edit_edge(e, 0, 2) >= 0 && gproj_edit_edge(e, n - 1, 1) >= 0);
        before = gprojt_edit_hash(e);
        GPROJT_REFUSED(gproj_edit_triangulate(e, 0, &error), NON_MANIFOLD, FACE, 0, "its diagonals are edges already");
        GPROJT_CHECK(gprojt_edit_hash(e) == before);
        gproj_edit_destroy(e);
    }
}

/* -- memory -- */

static bool gprojt_use_edit(const gproj_host *host, void *user) {
    const gproj_mesh *mesh = (const gproj_mesh *)user;
    gproj_error error;
    gproj_edit *e = gproj_edit_create(mesh, host, &error);
    uint64_t before = 0;
    gproj_mesh *made;
    int step;
    bool whole;
    if (!e) {
        GPROJT_CHECK(error.code == GPROJ_ERROR_MEMORY);
        return false;
    }
    GPROJT_CHECK(gproj_edit_memory(e).used == gprojt_failing_of(host)->bytes);
    for (step = 0, whole = true; step < 5 && whole; ++step) {
        before = gprojt_edit_hash(e);
        if (step == 0) whole = gproj_edit_split_edge(e, gproj_edit_edge(e, 5, 6), 0.5, &error) >= 0;
        if (step == 1) whole = gproj_edit_split_face(e, 1, 14, 1, &error) >= 0;
        if (step == 2) whole = gproj_edit_insert_strip(e, gproj_edit_edge(e, 4, 8), 0.5, &error) >= 0;
        if (step == 3) whole = gproj_edit_remove_strip(e, gproj_edit_edge(e, 0, 1), 0.5, &error) >= 0;
        if (step == 4) whole = gproj_edit_triangulate(e, -1, &error) >= 0;
    }
    if (!whole) GPROJT_CHECK(error.code == GPROJ_ERROR_MEMORY && gprojt_edit_hash(e) == before);
    if (whole) {
        made = gproj_edit_mesh(e, host, &error);
        whole = made && e->vertex_number;
        GPROJT_CHECK(whole || (error.code == GPROJ_ERROR_MEMORY && !e->vertex_number));
        gproj_mesh_destroy(made);
    }
    GPROJT_CHECK(!gprojt_validate_edit(e));
    GPROJT_CHECK(gproj_edit_memory(e).used == gprojt_failing_of(host)->bytes);
    gproj_edit_destroy(e);
    return whole;
}

static bool gprojt_use_dual(const gproj_host *host, void *user) {
    gproj_error error;
    gproj_mesh *dual = gproj_mesh_dual((const gproj_mesh *)user, NULL, host, &error);
    return gprojt_mesh_was_made(dual, host, &error);
}

static bool gprojt_use_diagonals(const gproj_host *host, void *user) {
    gproj_error error;
    gproj_mesh *along = gproj_mesh_diagonals((const gproj_mesh *)user, host, &error);
    return gprojt_mesh_was_made(along, host, &error);
}

GPROJT_TEST(every_allocation_fails_once) {
    gproj_mesh *mesh = gprojt_lined_grid();
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_diagonals, mesh) >= 20);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_edit, mesh) >= 50);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_dual, mesh) >= 20);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(ten_thousand_of_each);
    GPROJT_RUN(splits_and_cuts);
    GPROJT_RUN(first_corners_stay);
    GPROJT_RUN(polylines_grow);
    GPROJT_RUN(polylines_have_gaps_between_them);
    GPROJT_RUN(collapses_carry_numbers_on);
    GPROJT_RUN(split_and_collapse_is_nothing);
    GPROJT_RUN(ends_of_edges_are_exact);
    GPROJT_RUN(each_edge_by_itself);
    GPROJT_RUN(marks_begin_anew);
    GPROJT_RUN(strips_come_and_go);
    GPROJT_RUN(strips_that_begin_and_end_at_a_triangle);
    GPROJT_RUN(strips_that_cross_themselves);
    GPROJT_RUN(strips_are_cut_where_asked);
    GPROJT_RUN(polygons_that_are_not_convex);
    GPROJT_RUN(combs_spirals_darts);
    GPROJT_RUN(a_face_of_very_many_corners);
    GPROJT_RUN(a_vertex_of_very_many_faces);
    GPROJT_RUN(triangles_are_the_best);
    GPROJT_RUN(triangles_are_turned_least);
    GPROJT_RUN(diagonals_that_are_edges);
    GPROJT_RUN(every_other_ear_is_an_edge);
    GPROJT_RUN(thin_faces);
    GPROJT_RUN(triangles_of_the_largest_size);
    GPROJT_RUN(dual_of_the_dual);
    GPROJT_RUN(the_dual_names_the_vertices_given);
    GPROJT_RUN(diagonals_of_shapes);
    GPROJT_RUN(diagonals_of_straight_lines_are_flat);
    GPROJT_RUN(dual_with_boundary);
    GPROJT_RUN(nothing_but_vertices);
    GPROJT_RUN(a_large_mesh_made_small);
    GPROJT_RUN(arguments_are_checked);
    GPROJT_RUN(what_would_be_no_mesh_is_refused);
    GPROJT_RUN(spirals_turn_no_triangle_over);
    GPROJT_RUN(ears_that_are_edges);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
