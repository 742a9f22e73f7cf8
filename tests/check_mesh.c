/* check_mesh.c - what a mesh is like after a change, measured without guidedproj.h.

       cc -O2 -o check_mesh check_mesh.c -lm
       ./check_mesh BEFORE.obj AFTER.obj

   prints one `name value` a line; lengths are in mean edge lengths of the mesh they are about:
       same_connectivity   1: as many vertices, and the same faces in the same order with the same corners
       planarity_before, planarity_after   largest distance of a face's vertices from its least-squares plane
       displacement_mean, displacement_max
       deviation_rms       root mean square displacement / bounding box diagonal of BEFORE
       turned              faces whose vectorial area is against the one before
       folded_before, folded_after   edges whose faces' normals make more than 120 degrees
       boundary            largest distance of a boundary vertex from the boundary polyline of BEFORE
       corners             largest displacement of a boundary corner (one face, or a turn of more than 45 degrees)
   Reads `v` and `f` lines only. Exit: 0 read, 2 not read. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    int vertices, faces, corners;
    double *position; /* 3 per vertex */
    int *start;       /* faces + 1 */
    int *corner;
    double mean_edge;
} mesh;

typedef struct {
    int a, b;    /* a < b */
    int face[2]; /* -1: none */
} edge;

static void *grown(void *block, size_t size) {
    block = realloc(block, size);
    if (!block) exit(2);
    return block;
}

static void read_line(mesh *m, char *line) {
    if (line[0] == 'v' && line[1] == ' ') {
        char *at = line + 2;
        int k;
        m->position = grown(m->position, ((size_t)m->vertices + 1) * 3 * sizeof(double));
        for (k = 0; k < 3; ++k) m->position[3 * m->vertices + k] = strtod(at, &at);
        m->vertices++;
    } else if (line[0] == 'f' && line[1] == ' ') {
        char *word = strtok(line + 2, " \t\r\n");
        for (; word; word = strtok(NULL, " \t\r\n")) {
            int v = atoi(word);
            m->corner = grown(m->corner, ((size_t)m->corners + 1) * sizeof(int));
            m->corner[m->corners++] = v < 0 ? m->vertices + v : v - 1;
        }
        m->faces++;
        m->start = grown(m->start, ((size_t)m->faces + 1) * sizeof(int));
        m->start[m->faces] = m->corners;
    }
}

static mesh read_mesh(const char *path) {
    mesh m = {0, 0, 0, NULL, NULL, NULL, 0};
    FILE *file = fopen(path, "r");
    static char line[1 << 16];
    if (!file) {
        fprintf(stderr, "check_mesh: %s cannot be opened\n", path);
        exit(2);
    }
    m.start = grown(NULL, sizeof(int));
    m.start[0] = 0;
    while (fgets(line, sizeof line, file)) read_line(&m, line);
    fclose(file);
    return m;
}

static int compare_edges(const void *x, const void *y) {
    const edge *e = x, *f = y;
    if (e->a != f->a) return e->a < f->a ? -1 : 1;
    return e->b < f->b ? -1 : e->b > f->b;
}

static edge *find_edges(const mesh *m, int *count) {
    edge *e = grown(NULL, ((size_t)m->corners + 1) * sizeof *e);
    int f, k, n = 0, i;
    for (f = 0; f < m->faces; ++f)
        for (k = m->start[f]; k < m->start[f + 1]; ++k, ++n) {
            int a = m->corner[k], b = m->corner[k + 1 < m->start[f + 1] ? k + 1 : m->start[f]];
            e[n].a = a < b ? a : b, e[n].b = a < b ? b : a, e[n].face[0] = f, e[n].face[1] = -1;
        }
    qsort(e, (size_t)n, sizeof *e, compare_edges);
    for (*count = i = 0; i < n; ++i)
        if (*count > 0 && compare_edges(&e[*count - 1], &e[i]) == 0)
            e[*count - 1].face[1] = e[i].face[0];
        else
            e[(*count)++] = e[i];
    return e;
}

static double distance(const double *a, const double *b) {
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void area_vector(const mesh *m, int f, double *area) {
    const double *o = m->position + 3 * m->corner[m->start[f]];
    int k, i;
    area[0] = area[1] = area[2] = 0;
    for (k = m->start[f] + 1; k + 1 < m->start[f + 1]; ++k) {
        double u[3], v[3];
        for (i = 0; i < 3; ++i) {
            u[i] = m->position[3 * m->corner[k] + i] - o[i];
            v[i] = m->position[3 * m->corner[k + 1] + i] - o[i];
        }
        area[0] += (u[1] * v[2] - u[2] * v[1]) / 2;
        area[1] += (u[2] * v[0] - u[0] * v[2]) / 2;
        area[2] += (u[0] * v[1] - u[1] * v[0]) / 2;
    }
}

/* The normal of the least-squares plane: the eigenvector of the smallest eigenvalue, by Jacobi rotations. */
static void plane_normal(double a[3][3], double *normal) {
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    int sweep, p, q, i, least = 0;
    for (sweep = 0; sweep < 60; ++sweep)
        for (p = 0; p < 2; ++p)
            for (q = p + 1; q < 3; ++q) {
                double theta, t, c, s;
                if (fabs(a[p][q]) < 1e-300) continue;
                theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
                c = 1 / sqrt(t * t + 1), s = t * c;
                for (i = 0; i < 3; ++i) {
                    double x = a[i][p], y = a[i][q];
                    a[i][p] = c * x - s * y, a[i][q] = s * x + c * y;
                }
                for (i = 0; i < 3; ++i) {
                    double x = a[p][i], y = a[q][i];
                    a[p][i] = c * x - s * y, a[q][i] = s * x + c * y;
                }
                for (i = 0; i < 3; ++i) {
                    double x = v[i][p], y = v[i][q];
                    v[i][p] = c * x - s * y, v[i][q] = s * x + c * y;
                }
            }
    for (i = 1; i < 3; ++i)
        if (a[i][i] < a[least][least]) least = i;
    for (i = 0; i < 3; ++i) normal[i] = v[i][least];
}

static double planarity(const mesh *m) {
    double worst = 0;
    int f, k, i, j;
    for (f = 0; f < m->faces; ++f) {
        double middle[3] = {0, 0, 0}, a[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, normal[3];
        int degree = m->start[f + 1] - m->start[f];
        for (k = m->start[f]; k < m->start[f + 1]; ++k)
            for (i = 0; i < 3; ++i) middle[i] += m->position[3 * m->corner[k] + i] / degree;
        for (k = m->start[f]; k < m->start[f + 1]; ++k)
            for (i = 0; i < 3; ++i)
                for (j = 0; j < 3; ++j)
                    a[i][j] += (m->position[3 * m->corner[k] + i] - middle[i]) *
                               (m->position[3 * m->corner[k] + j] - middle[j]);
        plane_normal(a, normal);
        for (k = m->start[f]; k < m->start[f + 1]; ++k) {
            double d[3];
            for (i = 0; i < 3; ++i) d[i] = m->position[3 * m->corner[k] + i] - middle[i];
            worst = fmax(worst, fabs(dot(d, normal)));
        }
    }
    return worst / m->mean_edge;
}

static int folded(const mesh *m, const edge *e, int edges) {
    int i, count = 0;
    for (i = 0; i < edges; ++i) {
        double a[3], b[3];
        if (e[i].face[1] < 0) continue;
        area_vector(m, e[i].face[0], a);
        area_vector(m, e[i].face[1], b);
        count += dot(a, b) < -0.5 * sqrt(dot(a, a) * dot(b, b));
    }
    return count;
}

static double segment_distance(const double *x, const double *a, const double *b) {
    double u[3], d[3], t, q[3];
    int i;
    for (i = 0; i < 3; ++i) u[i] = b[i] - a[i], d[i] = x[i] - a[i];
    t = dot(u, u) > 0 ? dot(d, u) / dot(u, u) : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    for (i = 0; i < 3; ++i) q[i] = a[i] + t * u[i];
    return distance(x, q);
}

static void check_boundary(const mesh *m, const mesh *n, const edge *e, int edges) {
    int *faces = calloc((size_t)m->vertices + 1, sizeof *faces),
        *mate = grown(NULL, (2 * (size_t)m->vertices + 2) * sizeof *mate);
    double away = 0, moved = 0;
    int i, k, j;
    if (!faces) exit(2);
    for (i = 0; i < 2 * m->vertices; ++i) mate[i] = -1;
    for (i = 0; i < m->corners; ++i) faces[m->corner[i]]++;
    for (i = 0; i < edges; ++i)
        for (k = 0; k < 2 && e[i].face[1] < 0; ++k) {
            int v = k ? e[i].b : e[i].a;
            mate[2 * v + (mate[2 * v] >= 0)] = k ? e[i].a : e[i].b;
        }
    for (i = 0; i < m->vertices; ++i) {
        double best = INFINITY, u[3], w[3];
        const double *x = m->position + 3 * i;
        if (mate[2 * i] < 0) continue;
        for (j = 0; j < edges; ++j)
            if (e[j].face[1] < 0)
                best = fmin(best,
                            segment_distance(n->position + 3 * i, m->position + 3 * e[j].a, m->position + 3 * e[j].b));
        away = fmax(away, best);
        for (k = 0; k < 3; ++k) {
            u[k] = x[k] - m->position[3 * mate[2 * i] + k];
            w[k] = m->position[3 * mate[2 * i + 1] + k] - x[k];
        }
        if (faces[i] == 1 || dot(u, w) < 0.70710678118654752 * sqrt(dot(u, u) * dot(w, w)))
            moved = fmax(moved, distance(x, n->position + 3 * i));
    }
    printf("boundary %.3e\ncorners %.3e\n", away / m->mean_edge, moved / m->mean_edge);
    free(faces), free(mate);
}

static double mean_edge(const mesh *m, const edge *e, int edges) {
    double sum = 0;
    int i;
    for (i = 0; i < edges; ++i) sum += distance(m->position + 3 * e[i].a, m->position + 3 * e[i].b);
    return edges > 0 ? sum / edges : 1;
}

int main(int argc, char **argv) {
    mesh m, n;
    edge *e;
    int edges, same, i, k, turned = 0;
    double sum = 0, square = 0, most = 0, low[3] = {INFINITY, INFINITY, INFINITY},
           high[3] = {-INFINITY, -INFINITY, -INFINITY};
    if (argc != 3) return 2;
    m = read_mesh(argv[1]), n = read_mesh(argv[2]);
    same = m.vertices == n.vertices && m.faces == n.faces && m.corners == n.corners &&
           memcmp(m.start, n.start, ((size_t)m.faces + 1) * sizeof(int)) == 0 &&
           (m.corners == 0 || memcmp(m.corner, n.corner, (size_t)m.corners * sizeof(int)) == 0);
    printf("same_connectivity %d\n", same);
    if (!same) return 0;
    e = find_edges(&m, &edges);
    m.mean_edge = mean_edge(&m, e, edges), n.mean_edge = mean_edge(&n, e, edges);
    printf("planarity_before %.3e\nplanarity_after %.3e\n", planarity(&m), planarity(&n));
    for (i = 0; i < m.vertices; ++i) {
        double d = distance(m.position + 3 * i, n.position + 3 * i);
        sum += d, square += d * d, most = fmax(most, d);
        for (k = 0; k < 3; ++k) {
            low[k] = fmin(low[k], m.position[3 * i + k]);
            high[k] = fmax(high[k], m.position[3 * i + k]);
        }
    }
    printf("displacement_mean %.6e\ndisplacement_max %.6e\n", sum / m.vertices / m.mean_edge, most / m.mean_edge);
    printf("deviation_rms %.6e\n", sqrt(square / m.vertices) / distance(low, high));
    for (i = 0; i < m.faces; ++i) {
        double a[3], b[3];
        area_vector(&m, i, a), area_vector(&n, i, b);
        turned += dot(a, b) < 0;
    }
    printf("turned %d\nfolded_before %d\nfolded_after %d\n", turned, folded(&m, e, edges), folded(&n, e, edges));
    check_boundary(&m, &n, e, edges);
    free(e);
    free(m.position), free(m.start), free(m.corner), free(n.position), free(n.start), free(n.corner);
    return 0;
}
