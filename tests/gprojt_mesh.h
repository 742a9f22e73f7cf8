/* gprojt_mesh.h - polygon meshes for tests: generators, and a validator of everything gproj_mesh promises. */
#ifndef GPROJT_MESH_H
#define GPROJT_MESH_H

#include "gprojt.h"

/* Polygons with room to grow: what gproj_mesh_create takes. */
typedef struct gprojt_soup {
    int32_t vertex_count, face_count, corner_count;
    double *position;
    int32_t *degree, *corner;
    int32_t vertex_room, face_room, corner_room;
} gprojt_soup;

static inline void *gprojt_room(void *block, int32_t *room, int32_t needed, size_t size) {
    if (needed <= *room) return block;
    *room = 2 * needed + 16;
    block = realloc(block, (size_t)*room * size);
    if (!block) abort();
    return block;
}

static inline int32_t gprojt_add_vertex(gprojt_soup *s, double x, double y, double z) {
    s->position = (double *)gprojt_room(s->position, &s->vertex_room, s->vertex_count + 1, 3 * sizeof(double));
    s->position[3 * s->vertex_count] = x;
    s->position[3 * s->vertex_count + 1] = y;
    s->position[3 * s->vertex_count + 2] = z;
    return s->vertex_count++;
}

static inline void gprojt_add_face(gprojt_soup *s, int32_t degree, const int32_t *corner) {
    s->degree = (int32_t *)gprojt_room(s->degree, &s->face_room, s->face_count + 1, sizeof(int32_t));
    s->corner = (int32_t *)gprojt_room(s->corner, &s->corner_room, s->corner_count + degree, sizeof(int32_t));
    s->degree[s->face_count++] = degree;
    memcpy(s->corner + s->corner_count, corner, (size_t)degree * sizeof(int32_t));
    s->corner_count += degree;
}

/* A face along a strip that winds around ten times: nearly every corner is hidden from most others. */
static inline void gprojt_add_spiral(gprojt_soup *s, int32_t corners) {
    int32_t half = corners / 2, first = s->vertex_count, side, i;
    int32_t *corner = (int32_t *)malloc(2 * (size_t)half * sizeof *corner);
    if (!corner) abort();
    for (side = 0; side < 2; ++side)
        for (i = 0; i < half; ++i) {
            double angle = 20 * 3.141592653589793 * i / half, radius = 1 + 0.1 * angle + 0.2 * side;
            corner[side ? 2 * half - 1 - i : i] = first + side * half + i;
            gprojt_add_vertex(s, radius * cos(angle), radius * sin(angle), 0);
        }
    gprojt_add_face(s, 2 * half, corner);
    free(corner);
}

static inline void gprojt_add_triangle(gprojt_soup *s, int32_t a, int32_t b, int32_t c) {
    int32_t corner[3];
    corner[0] = a, corner[1] = b, corner[2] = c;
    gprojt_add_face(s, 3, corner);
}

static inline void gprojt_add_quad(gprojt_soup *s, int32_t a, int32_t b, int32_t c, int32_t d) {
    int32_t corner[4];
    corner[0] = a, corner[1] = b, corner[2] = c, corner[3] = d;
    gprojt_add_face(s, 4, corner);
}

static inline void gprojt_soup_free(gprojt_soup *s) {
    free(s->position);
    free(s->degree);
    free(s->corner);
    memset(s, 0, sizeof *s);
}

static inline gprojt_soup gprojt_soup_copy(const gprojt_soup *s) {
    gprojt_soup copy;
    int32_t i, c = 0;
    memset(&copy, 0, sizeof copy);
    for (i = 0; i < s->vertex_count; ++i)
        gprojt_add_vertex(&copy, s->position[3 * i], s->position[3 * i + 1], s->position[3 * i + 2]);
    for (i = 0; i < s->face_count; c += s->degree[i++]) gprojt_add_face(&copy, s->degree[i], s->corner + c);
    return copy;
}

static inline gproj_mesh *gprojt_soup_mesh(const gprojt_soup *s, const gproj_host *host, gproj_error *error) {
    return gproj_mesh_create(s->vertex_count, s->position, s->face_count, s->degree, s->corner, host, error);
}

/* Leaves out vertices without a face. */
static inline void gprojt_compact(gprojt_soup *s) {
    int32_t *number = (int32_t *)calloc((size_t)s->vertex_count + 1, sizeof(int32_t)), i, count = 0;
    for (i = 0; i < s->corner_count; ++i) number[s->corner[i]] = 1;
    for (i = 0; i < s->vertex_count; ++i) {
        if (!number[i]) continue;
        memmove(s->position + 3 * count, s->position + 3 * i, 3 * sizeof(double));
        number[i] = count++;
    }
    for (i = 0; i < s->corner_count; ++i) s->corner[i] = number[s->corner[i]];
    s->vertex_count = count;
    free(number);
}

static inline double gprojt_edge_length(const gproj_mesh *mesh, int32_t edge) {
    return gprojt_far(mesh->position + 3 * mesh->origin[2 * edge], mesh->position + 3 * mesh->origin[2 * edge + 1]);
}

/* For gprojt_fail_every_allocation: whether there is a mesh. It has all that was taken from the host, and is destroyed; if
   there is none, memory was missing. */
static inline bool gprojt_mesh_was_made(gproj_mesh *mesh, const gproj_host *host, const gproj_error *error) {
    bool made = mesh != NULL;
    GPROJT_CHECK(made || error->code == GPROJ_ERROR_MEMORY);
    GPROJT_CHECK(!made || gproj_mesh_memory(mesh).used == gprojt_failing_of(host)->bytes);
    gproj_mesh_destroy(mesh);
    return made;
}

/* Whether making a mesh was refused with this error, in a sentence of one line with this piece. */
static inline bool gprojt_mesh_was_refused(const gproj_mesh *mesh, const gproj_error *error, gproj_code code,
                                           gproj_place place, int64_t index, const char *piece) {
    bool right = !mesh && error->code == code && error->place == place && error->index == index &&
                 strstr(error->message, piece) && !strchr(error->message, '\n');
    if (!right)
        printf("  code %d place %d index %ld: %s\n", (int)error->code, (int)error->place, (long)error->index,
               error->message);
    return right;
}

/* -- generators: gentle double-curved shapes -- */

static inline double gprojt_height(double x, double y) { return 0.15 * sin(2 * x) * cos(1.5 * y) + 0.05 * x * y; }

/* (nx + 1)(ny + 1) vertices on the unit square, row by row. */
static inline gprojt_soup gprojt_points(int32_t nx, int32_t ny) {
    gprojt_soup s;
    int32_t i, j;
    memset(&s, 0, sizeof s);
    for (j = 0; j <= ny; ++j) {
        for (i = 0; i <= nx; ++i) {
            double x = (double)i / nx, y = (double)j / ny;
            gprojt_add_vertex(&s, x, y, gprojt_height(3 * x, 3 * y));
        }
    }
    return s;
}

static inline gprojt_soup gprojt_quad_grid(int32_t nx, int32_t ny) {
    gprojt_soup s = gprojt_points(nx, ny);
    int32_t i, j;
    for (j = 0; j < ny; ++j) {
        for (i = 0; i < nx; ++i) {
            int32_t v = j * (nx + 1) + i;
            gprojt_add_quad(&s, v, v + 1, v + nx + 2, v + nx + 1);
        }
    }
    return s;
}

static inline gprojt_soup gprojt_triangle_grid(int32_t nx, int32_t ny) {
    gprojt_soup s = gprojt_points(nx, ny);
    int32_t i, j;
    for (j = 0; j < ny; ++j) {
        for (i = 0; i < nx; ++i) {
            int32_t v = j * (nx + 1) + i;
            gprojt_add_triangle(&s, v, v + 1, v + nx + 2);
            gprojt_add_triangle(&s, v, v + nx + 2, v + nx + 1);
        }
    }
    return s;
}

/* Quads, every third of them cut into two triangles. */
static inline gprojt_soup gprojt_hybrid_grid(int32_t nx, int32_t ny) {
    gprojt_soup s = gprojt_points(nx, ny);
    int32_t i, j;
    for (j = 0; j < ny; ++j) {
        for (i = 0; i < nx; ++i) {
            int32_t v = j * (nx + 1) + i;
            if ((i + 2 * j) % 3 == 0) {
                gprojt_add_triangle(&s, v, v + 1, v + nx + 2);
                gprojt_add_triangle(&s, v, v + nx + 2, v + nx + 1);
            } else {
                gprojt_add_quad(&s, v, v + 1, v + nx + 2, v + nx + 1);
            }
        }
    }
    return s;
}

/* Hexagons as a wall of bricks, nx in a row, with every other vertex moved to open the angles. */
static inline gprojt_soup gprojt_hexagon_mesh(int32_t nx, int32_t ny) {
    int32_t columns = 2 * nx + 1, i, j, k;
    gprojt_soup s = gprojt_points(columns, ny);
    for (j = 0; j < ny; ++j) {
        for (k = 0; k < nx; ++k) {
            int32_t v, up = columns + 1, corner[6];
            i = 2 * k + (j & 1);
            v = j * up + i;
            corner[0] = v, corner[1] = v + 1, corner[2] = v + 2;
            corner[3] = v + 2 + up, corner[4] = v + 1 + up, corner[5] = v + up;
            gprojt_add_face(&s, 6, corner);
        }
    }
    for (i = 0; i < s.vertex_count; ++i) {
        int32_t row = i / (columns + 1), column = i % (columns + 1);
        s.position[3 * i + 1] += ((row + column) & 1 ? 0.15 : -0.15) / ny;
    }
    gprojt_compact(&s);
    return s;
}

/* A torus of quads: closed, genus 1. */
static inline gprojt_soup gprojt_torus(int32_t around, int32_t across) {
    gprojt_soup s;
    int32_t i, j;
    memset(&s, 0, sizeof s);
    for (i = 0; i < around; ++i) {
        for (j = 0; j < across; ++j) {
            double u = 6.283185307179586 * i / around, v = 6.283185307179586 * j / across, r = 2 + 0.7 * cos(v);
            gprojt_add_vertex(&s, r * cos(u), r * sin(u), 0.7 * sin(v));
        }
    }
    for (i = 0; i < around; ++i) {
        for (j = 0; j < across; ++j) {
            int32_t a = (i + 1) % around, b = (j + 1) % across;
            gprojt_add_quad(&s, i * across + j, a * across + j, a * across + b, i * across + b);
        }
    }
    return s;
}

/* A tube of quads, open at both ends: two boundary loops. */
static inline gprojt_soup gprojt_tube(int32_t around, int32_t along) {
    gprojt_soup s;
    int32_t i, j;
    memset(&s, 0, sizeof s);
    for (j = 0; j <= along; ++j) {
        for (i = 0; i < around; ++i) {
            double u = 6.283185307179586 * i / around, r = 1 + 0.2 * sin(3.0 * j / along);
            gprojt_add_vertex(&s, r * cos(u), r * sin(u), 3.0 * j / along);
        }
    }
    for (j = 0; j < along; ++j) {
        for (i = 0; i < around; ++i) {
            int32_t a = (i + 1) % around;
            gprojt_add_quad(&s, j * around + i, j * around + a, (j + 1) * around + a, (j + 1) * around + i);
        }
    }
    return s;
}

/* A cube with n x n quads a side, blown up to a sphere: closed, eight vertices of valence 3. */
static inline gprojt_soup gprojt_cube_sphere(int32_t n) {
    gprojt_soup s;
    int32_t *number = (int32_t *)malloc((size_t)(n + 1) * (size_t)(n + 1) * (size_t)(n + 1) * sizeof(int32_t));
    int32_t side, i, j, k;
    memset(&s, 0, sizeof s);
    for (i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i) number[i] = -1;
    for (side = 0; side < 6; ++side) {
        for (j = 0; j < n; ++j) {
            for (i = 0; i < n; ++i) {
                int32_t corner[4];
                for (k = 0; k < 4; ++k) {
                    int32_t a = i + (k == 1 || k == 2), b = j + (k >= 2), axis = side / 2, at[3], key;
                    at[axis] = side & 1 ? n : 0;
                    at[(axis + 1) % 3] = side & 1 ? a : b; /* counter-clockwise from outside on both sides */
                    at[(axis + 2) % 3] = side & 1 ? b : a;
                    key = (at[2] * (n + 1) + at[1]) * (n + 1) + at[0];
                    if (number[key] < 0) {
                        double x = 2.0 * at[0] / n - 1, y = 2.0 * at[1] / n - 1, z = 2.0 * at[2] / n - 1;
                        double r = sqrt(x * x + y * y + z * z);
                        number[key] = gprojt_add_vertex(&s, x / r, y / r, z / r);
                    }
                    corner[k] = number[key];
                }
                gprojt_add_face(&s, 4, corner);
            }
        }
    }
    free(number);
    return s;
}

/* Faces that may be anything: mostly not a mesh. */
static inline gprojt_soup gprojt_random_soup(uint64_t *state, int32_t vertices, int32_t faces) {
    gprojt_soup s;
    int32_t f, k;
    memset(&s, 0, sizeof s);
    for (k = 0; k < vertices; ++k)
        gprojt_add_vertex(&s, gprojt_uniform(state), gprojt_uniform(state), gprojt_uniform(state));
    for (f = 0; f < faces; ++f) {
        int32_t corner[6], degree = 3 + gprojt_below(state, 4);
        for (k = 0; k < degree; ++k) corner[k] = gprojt_below(state, vertices);
        gprojt_add_face(&s, degree, corner);
    }
    return s;
}

/* The generators by number, for tests that want them all; NULL name at the end. */
enum {
    GPROJT_SHAPES = 7
};
static inline gprojt_soup gprojt_shape(int index, int32_t n) {
    switch (index) {
    case 0: return gprojt_quad_grid(n, n + 1);
    case 1: return gprojt_triangle_grid(n, n + 2);
    case 2: return gprojt_hybrid_grid(n + 1, n);
    case 3: return gprojt_hexagon_mesh(n, n);
    case 4: return gprojt_torus(n + 3, n + 4);
    case 5: return gprojt_tube(n + 3, n);
    default: return gprojt_cube_sphere(n);
    }
}

/* -- the validator -- */

#define GPROJT_VALID(condition)              \
    do {                                     \
        if (!(condition)) return #condition; \
    } while (0)

/* Everything a half-edge is and where it leads. */
static inline const char *gprojt_validate_halfedges(const gproj_mesh *m) {
    int32_t h;
    GPROJT_VALID(m->halfedge_count == 2 * m->edge_count);
    for (h = 0; h < m->halfedge_count; ++h) {
        GPROJT_VALID(m->twin[h] == (h ^ 1) && m->edge[h] == h / 2);
        GPROJT_VALID(m->origin[h] >= 0 && m->origin[h] < m->vertex_count);
        GPROJT_VALID(m->next[h] >= 0 && m->next[h] < m->halfedge_count);
        GPROJT_VALID(m->prev[h] >= 0 && m->prev[h] < m->halfedge_count);
        GPROJT_VALID(m->next[m->prev[h]] == h && m->prev[m->next[h]] == h);
        GPROJT_VALID(m->face[h] >= -1 && m->face[h] < m->face_count && m->face[m->next[h]] == m->face[h]);
        GPROJT_VALID(m->origin[m->next[h]] == m->origin[h ^ 1] && m->origin[h] != m->origin[h ^ 1]);
        GPROJT_VALID(m->face[h & ~1] >= 0); /* the first half-edge of an edge is a face's */
    }
    return NULL;
}

static inline const char *gprojt_validate_faces(const gproj_mesh *m) {
    int32_t f, h, k, edges = 0;
    int64_t corners = 0;
    for (f = 0; f < m->face_count; ++f) {
        GPROJT_VALID(m->face_degree[f] >= 3);
        h = m->face_halfedge[f];
        for (k = 0; k < m->face_degree[f]; ++k, h = m->next[h]) {
            GPROJT_VALID(m->face[h] == f);
            GPROJT_VALID(k == 0 || h != m->face_halfedge[f]);
            GPROJT_VALID(m->edge[h] <= edges); /* edges are numbered as they appear */
            if (m->edge[h] == edges) ++edges;
        }
        GPROJT_VALID(h == m->face_halfedge[f]);
        corners += m->face_degree[f];
    }
    GPROJT_VALID(edges == m->edge_count);
    for (h = 0; h < m->halfedge_count; ++h) corners -= m->face[h] >= 0;
    GPROJT_VALID(corners == 0);
    return NULL;
}

static inline const char *gprojt_validate_vertices(const gproj_mesh *m) {
    int32_t *count = (int32_t *)calloc(2 * (size_t)m->vertex_count + 1, sizeof(int32_t)), v, h, isolated = 0;
    int32_t *first = count + m->vertex_count;
    const char *wrong = NULL;
    for (h = m->halfedge_count - 1; h >= 0; --h) count[m->origin[h]]++, first[m->origin[h]] = h;
    for (v = 0; v < m->vertex_count && !wrong; ++v) {
        int32_t ring[64], valence = gproj_mesh_one_ring(m, v, ring, 64), k, start = m->vertex_halfedge[v];
        if (valence != count[v] || valence != gproj_mesh_valence(m, v)) wrong = "valence = number of edges";
        if (start < 0) {
            ++isolated;
            if (valence) wrong = "isolated vertices have no edges";
            continue;
        }
        if (m->origin[start] != v) wrong = "vertex_halfedge goes out";
        if (gproj_mesh_is_boundary_vertex(m, v) != (m->face[start] < 0))
            wrong = "boundary vertices start at the boundary";
        h = start;
        for (k = 0; k < valence; ++k, h = m->prev[h] ^ 1) {
            if (k > 0 && (h == start || m->face[h] < 0)) wrong = "one boundary half-edge, one fan";
        }
        if (h != start) wrong = "the fan closes";
        if (m->face[start] >= 0 && start != first[v]) wrong = "vertex_halfedge is the first that goes out";
        for (k = 0; k < (valence > 64 ? 63 : valence); ++k) { /* ring: from the first to the last along the faces */
            int32_t last = k + 1 == valence, following = ring[last ? 0 : k + 1];
            int32_t i = start, found = 0;
            do { /* some face at v has ... following -> ... in counter-clockwise order: v, ring[k], ..., following */
                if (m->origin[i ^ 1] == ring[k] && m->face[i] >= 0 && m->origin[m->prev[i]] == following) found = 1;
                i = m->prev[i] ^ 1;
            } while (i != start);
            if (!found && !(last && m->face[start] < 0)) wrong = "one-ring neighbours share a face, in order";
            if (last && m->face[start] < 0 && ring[k] != m->origin[start ^ 1])
                wrong = "the boundary half-edge is the last";
        }
    }
    if (isolated != m->isolated_count) wrong = "isolated_count";
    free(count);
    return wrong;
}

static inline const char *gprojt_validate_loops(const gproj_mesh *m) {
    int32_t l, h, boundary = 0, in_loops = 0;
    for (h = 0; h < m->halfedge_count; ++h) boundary += m->face[h] < 0;
    for (l = 0; l < m->loop_count; ++l) {
        GPROJT_VALID(l == 0 || m->loop_halfedge[l] > m->loop_halfedge[l - 1]);
        h = m->loop_halfedge[l];
        do {
            GPROJT_VALID(m->face[h] == -1 && m->vertex_halfedge[m->origin[h]] == h);
            GPROJT_VALID(++in_loops <= boundary);
            h = m->next[h];
        } while (h != m->loop_halfedge[l]);
    }
    GPROJT_VALID(in_loops == boundary);
    return NULL;
}

/* Components by joining vertices along edges. */
static inline const char *gprojt_validate_components(const gproj_mesh *m) {
    int32_t *up = (int32_t *)malloc(((size_t)m->vertex_count + 1) * sizeof(int32_t)), i, count;
    for (i = 0; i < m->vertex_count; ++i) up[i] = i;
    count = m->vertex_count - m->isolated_count;
    for (i = 0; i < m->halfedge_count; i += 2) {
        int32_t a = m->origin[i], b = m->origin[i + 1];
        while (up[a] != a) a = up[a] = up[up[a]];
        while (up[b] != b) b = up[b] = up[up[b]];
        if (a != b) up[a] = b, --count;
    }
    free(up);
    return count == m->component_count ? NULL : "component_count";
}

static inline const char *gprojt_validate_polylines(const gproj_mesh *m) {
    int32_t p, i;
    GPROJT_VALID(m->polyline_start[0] == 0);
    for (p = 0; p < m->polyline_count; ++p) {
        GPROJT_VALID(m->polyline_start[p + 1] >= m->polyline_start[p] + 2);
        for (i = m->polyline_start[p]; i < m->polyline_start[p + 1]; ++i) {
            GPROJT_VALID(m->polyline_vertex[i] >= 0 && m->polyline_vertex[i] < m->vertex_count);
        }
    }
    return NULL;
}

/* NULL if the mesh keeps all its promises, else the one that it breaks. */
static inline const char *gprojt_validate_mesh(const gproj_mesh *m) {
    const char *wrong;
    GPROJT_VALID(m->vertex_count > 0 && m->face_count >= 0 && m->loop_count >= 0);
    if ((wrong = gprojt_validate_halfedges(m)) != NULL) return wrong;
    if ((wrong = gprojt_validate_faces(m)) != NULL) return wrong;
    if ((wrong = gprojt_validate_vertices(m)) != NULL) return wrong;
    if ((wrong = gprojt_validate_loops(m)) != NULL) return wrong;
    if ((wrong = gprojt_validate_components(m)) != NULL) return wrong;
    return gprojt_validate_polylines(m);
}

/* The same connectivity, numbering and bits of the positions. */
static inline bool gprojt_same_mesh(const gproj_mesh *a, const gproj_mesh *b) {
    size_t n = (size_t)a->halfedge_count * sizeof(int32_t);
    return a->vertex_count == b->vertex_count && a->face_count == b->face_count && a->edge_count == b->edge_count &&
           a->loop_count == b->loop_count && a->component_count == b->component_count &&
           a->isolated_count == b->isolated_count && a->polyline_count == b->polyline_count &&
           !memcmp(a->position, b->position, (size_t)a->vertex_count * 3 * sizeof(double)) &&
           !memcmp(a->vertex_halfedge, b->vertex_halfedge, (size_t)a->vertex_count * sizeof(int32_t)) &&
           !memcmp(a->face_halfedge, b->face_halfedge, (size_t)a->face_count * sizeof(int32_t)) &&
           !memcmp(a->face_degree, b->face_degree, (size_t)a->face_count * sizeof(int32_t)) &&
           !memcmp(a->loop_halfedge, b->loop_halfedge, (size_t)a->loop_count * sizeof(int32_t)) &&
           !memcmp(a->next, b->next, n) && !memcmp(a->prev, b->prev, n) && !memcmp(a->origin, b->origin, n) &&
           !memcmp(a->face, b->face, n) && !memcmp(a->twin, b->twin, n) && !memcmp(a->edge, b->edge, n) &&
           !memcmp(a->polyline_start, b->polyline_start, ((size_t)a->polyline_count + 1) * sizeof(int32_t)) &&
           !memcmp(a->polyline_vertex, b->polyline_vertex,
                   (size_t)a->polyline_start[a->polyline_count] * sizeof(int32_t));
}

/* A growing text, to be filled by gproj_mesh_write. */
typedef struct gprojt_text {
    char *text;
    size_t size, room;
    long calls, stop_at; /* the call that says no; 0: none */
} gprojt_text;

static inline bool gprojt_text_write(void *user, const char *text, size_t size) {
    gprojt_text *t = (gprojt_text *)user;
    if (++t->calls == t->stop_at) return false;
    if (t->size + size > t->room) {
        t->room = 2 * (t->size + size);
        t->text = (char *)realloc(t->text, t->room);
        if (!t->text) abort();
    }
    memcpy(t->text + t->size, text, size);
    t->size += size;
    return true;
}

/* Names of the real meshes; the folder may be missing. */
enum {
    GPROJT_REAL_MESHES = 14
};
static inline const char *gprojt_real_mesh(int index) {
    static const char *const names[GPROJT_REAL_MESHES] = {"6-sub-lifted",
                                                          "Intersection",
                                                          "M2_eq_quad2",
                                                          "YasIsland",
                                                          "botanic-garden",
                                                          "eyeye_circular",
                                                          "formfinding-circular",
                                                          "free_negshell",
                                                          "heart",
                                                          "hexagonalminimal",
                                                          "hypar",
                                                          "quad_dome",
                                                          "tri_dome",
                                                          "tubemesh"};
    return names[index];
}

static inline gproj_mesh *gprojt_load_real_mesh(int index, const gproj_host *host, gproj_error *error) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.obj", gprojt_data_folder(), gprojt_real_mesh(index));
    return gproj_mesh_load(path, host, error);
}

#endif
