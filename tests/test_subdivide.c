/* test_subdivide.c - >>subdivide: Catmull-Clark and Loop against splines, known masks and values; stencils. */
#include "gprojt_form.h"

enum {
    QUADS = 0,
    TRIANGLES = 1,
    HYBRID = 2,
    TUBE = 5
};

static gproj_mesh *gprojt_random_mesh(gprojt_soup soup, uint64_t seed) {
    gproj_mesh *mesh = gprojt_mesh_of(soup);
    gprojt_shake(mesh, 1, seed);
    return mesh;
}

static gproj_subdivide_options gprojt_levels(gproj_scheme scheme, int32_t levels) {
    gproj_subdivide_options options;
    memset(&options, 0, sizeof options);
    options.scheme = scheme;
    options.levels = levels;
    return options;
}

static gproj_mesh *gprojt_subdivided(const gproj_mesh *mesh, gproj_scheme scheme, int32_t levels,
                                     gproj_stencil **stencil) {
    gproj_subdivide_options options = gprojt_levels(scheme, levels);
    gproj_error error;
    gproj_mesh *fine = gproj_mesh_subdivide(mesh, &options, stencil, NULL, &error);
    if (!fine) printf("  %s\n", error.message);
    return fine;
}

static int32_t gprojt_edge_between(const gproj_mesh *mesh, int32_t a, int32_t b) {
    int32_t h;
    for (h = 0; h < mesh->halfedge_count; ++h)
        if (mesh->origin[h] == a && mesh->origin[h ^ 1] == b) return h / 2;
    return -1;
}

static void gprojt_add_scaled(const gproj_mesh *mesh, int32_t vertex, double scale, double out[3]) {
    int k;
    for (k = 0; k < 3; ++k) out[k] += scale * mesh->position[3 * vertex + k];
}

/* -- limits: where a vertex goes when one subdivides for ever -- */

/* Inside: (n^2 v + 4 sum edges + sum diagonals) / (n (n + 5)) for Catmull-Clark on quads (Halstead, Kass, DeRose 1993);
   ((1 - n w) v + w sum edges), w = 1 / (n + 3 / (8 b)) for Loop's. On a crease (a + 4 v + b) / 6. */
static void gprojt_limit(const gproj_mesh *mesh, gproj_scheme scheme, int32_t v, double out[3]) {
    double n = gproj_mesh_valence(mesh, v), c = 0.375 + 0.25 * cos(2 * acos(-1.0) / n), b = (0.625 - c * c) / n;
    double w = scheme == GPROJ_LOOP ? 1 / (n + 3 / (8 * b)) : 4 / (n * (n + 5));
    int32_t start = mesh->vertex_halfedge[v], h = start;
    out[0] = out[1] = out[2] = 0;
    gprojt_add_scaled(mesh, v, scheme == GPROJ_LOOP ? 1 - n * w : n / (n + 5), out);
    do {
        gprojt_add_scaled(mesh, mesh->origin[h ^ 1], w, out);
        if (scheme == GPROJ_CATMULL_CLARK)
            gprojt_add_scaled(mesh, mesh->origin[mesh->next[mesh->next[h]]], 1 / (n * (n + 5)), out);
        h = mesh->prev[h] ^ 1;
    } while (h != start);
}

static void gprojt_crease_limit(const gproj_mesh *mesh, int32_t before, int32_t v, int32_t after, double out[3]) {
    out[0] = out[1] = out[2] = 0;
    gprojt_add_scaled(mesh, before, 1.0 / 6, out);
    gprojt_add_scaled(mesh, v, 4.0 / 6, out);
    gprojt_add_scaled(mesh, after, 1.0 / 6, out);
}

static void gprojt_boundary_limit(const gproj_mesh *mesh, int32_t v, double out[3]) {
    int32_t h = mesh->vertex_halfedge[v];
    gprojt_crease_limit(mesh, mesh->origin[mesh->prev[h]], v, mesh->origin[h ^ 1], out);
}

/* -- splines, evaluated directly -- */

static void gprojt_cubic_basis(double t, double b[4]) {
    double s = 1 - t;
    b[0] = s * s * s / 6;
    b[1] = (3 * t * t * t - 6 * t * t + 4) / 6;
    b[2] = (3 * s * s * s - 6 * s * s + 4) / 6;
    b[3] = t * t * t / 6;
}

/* Control point (i, j) of a grid of nx by ny quads; beyond its ends those for which the surface has no curvature across
   the boundary: 2 P(0, j) - P(1, j). */
static void gprojt_control(const gproj_mesh *grid, int32_t nx, int32_t ny, int32_t i, int32_t j, double scale,
                           double out[3]) {
    if (i < 0 || i > nx) {
        int32_t end = i < 0 ? 0 : nx, inner = i < 0 ? 1 : nx - 1;
        gprojt_control(grid, nx, ny, end, j, 2 * scale, out);
        gprojt_control(grid, nx, ny, inner, j, -scale, out);
    } else if (j < 0 || j > ny) {
        int32_t end = j < 0 ? 0 : ny, inner = j < 0 ? 1 : ny - 1;
        gprojt_control(grid, nx, ny, i, end, 2 * scale, out);
        gprojt_control(grid, nx, ny, i, inner, -scale, out);
    } else {
        gprojt_add_scaled(grid, j * (nx + 1) + i, scale, out);
    }
}

static void gprojt_bicubic(const gproj_mesh *grid, int32_t nx, int32_t ny, double u, double v, double out[3]) {
    int32_t i = (int32_t)fmin(floor(u), nx - 1), j = (int32_t)fmin(floor(v), ny - 1), k, l;
    double a[4], b[4];
    gprojt_cubic_basis(u - i, a);
    gprojt_cubic_basis(v - j, b);
    out[0] = out[1] = out[2] = 0;
    for (k = 0; k < 4; ++k)
        for (l = 0; l < 4; ++l) gprojt_control(grid, nx, ny, i + k - 1, j + l - 1, a[k] * b[l], out);
}

/* The linear box spline of the directions (1, 0), (0, 1), (1, 1): a hat over six triangles. */
static double gprojt_hat(double x, double y) { return fmax(0, 1 - fmax(fabs(x - y), fmax(fabs(x), fabs(y)))); }

/* The quartic box spline, each direction twice: the convolution of the hat with itself. At multiples of 1/4 the product is
   quadratic in each triangle of the lattice of 1/4, where the midpoints of the edges integrate it exactly. */
static double gprojt_quartic(double x, double y) {
    static const double midpoint[6][2] = {{0.5, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 0.5}, {0.5, 0.5}};
    double sum = 0;
    int i, j, k;
    for (i = -4; i < 4; ++i)
        for (j = -4; j < 4; ++j)
            for (k = 0; k < 6; ++k) {
                double a = 0.25 * (i + midpoint[k][0]), b = 0.25 * (j + midpoint[k][1]);
                sum += gprojt_hat(a, b) * gprojt_hat(x - a, y - b);
            }
    return sum / (6 * 16);
}

/* A point of the cubic B-spline curve of a closed polygon, at t between points i and i + 1; at corners it ends, without
   curvature. */
static void gprojt_curve(const double *point, const bool *corner, int32_t count, int32_t i, double t, double out[3]) {
    int32_t at[4], k, d;
    double b[4];
    for (k = 0; k < 4; ++k) at[k] = (i + k - 1 + count) % count;
    gprojt_cubic_basis(t, b);
    if (corner[at[1]]) b[1] += 2 * b[0], b[2] -= b[0], b[0] = 0;
    if (corner[at[2]]) b[2] += 2 * b[3], b[1] -= b[3], b[3] = 0;
    for (d = 0; d < 3; ++d) {
        out[d] = 0;
        for (k = 0; k < 4; ++k) out[d] += b[k] * point[3 * at[k] + d];
    }
}

/* The parameters of a fine vertex: what it is of a grid with corners at whole numbers. */
static double *gprojt_parameters(const gproj_stencil *stencil, int32_t nx) {
    double *coarse = (double *)malloc(2 * (size_t)stencil->column_count * sizeof *coarse);
    double *fine = (double *)malloc(2 * (size_t)stencil->row_count * sizeof *fine);
    int32_t i;
    for (i = 0; i < stencil->column_count; ++i) coarse[2 * i] = i % (nx + 1), coarse[2 * i + 1] = i / (nx + 1);
    gproj_stencil_apply(stencil, 2, coarse, fine);
    free(coarse);
    return fine;
}

/* The whole surface of a grid of quads with its boundary is the bicubic spline. */
GPROJT_TEST(catmull_clark_is_the_bicubic_spline) {
    const int32_t nx = 6, ny = 5;
    gproj_mesh *grid = gprojt_random_mesh(gprojt_quad_grid(nx, ny), 1), *fine;
    gproj_stencil *stencil;
    double *parameter, worst = 0, p[3], q[3];
    int32_t v;
    fine = gprojt_subdivided(grid, GPROJ_CATMULL_CLARK, 2, &stencil);
    GPROJT_REQUIRE(fine && fine->vertex_count == (4 * nx + 1) * (4 * ny + 1));
    parameter = gprojt_parameters(stencil, nx);
    for (v = 0; v < fine->vertex_count; ++v) {
        bool end = gproj_mesh_valence(fine, v) == 2;
        GPROJT_NEAR(4 * parameter[2 * v], floor(4 * parameter[2 * v] + 0.5), 1e-13);
        if (gproj_mesh_is_boundary_vertex(fine, v))
            gprojt_boundary_limit(fine, v, p);
        else
            gprojt_limit(fine, GPROJ_CATMULL_CLARK, v, p);
        gprojt_bicubic(grid, nx, ny, parameter[2 * v], parameter[2 * v + 1], q);
        worst = fmax(worst, gprojt_far(end ? fine->position + 3 * v : p, q));
    }
    GPROJT_CHECK(worst < 1e-14);
    free(parameter);
    gproj_stencil_destroy(stencil);
    gproj_mesh_destroy(fine);
    gproj_mesh_destroy(grid);
}

GPROJT_TEST(loop_is_the_quartic_box_spline) {
    const int32_t nx = 6, ny = 5;
    gproj_mesh *grid = gprojt_random_mesh(gprojt_triangle_grid(nx, ny), 2), *fine;
    gproj_stencil *stencil;
    double *parameter, worst = 0;
    int32_t v, k, met = 0;
    GPROJT_NEAR(gprojt_quartic(0, 0), 0.5, 1e-15);
    GPROJT_NEAR(gprojt_quartic(1, 1), 1.0 / 12, 1e-15);
    fine = gprojt_subdivided(grid, GPROJ_LOOP, 2, &stencil);
    GPROJT_REQUIRE(fine && fine->vertex_count == (4 * nx + 1) * (4 * ny + 1));
    parameter = gprojt_parameters(stencil, nx);
    for (v = 0; v < fine->vertex_count; ++v) {
        double x = floor(4 * parameter[2 * v] + 0.5) / 4, y = floor(4 * parameter[2 * v + 1] + 0.5) / 4;
        double p[3], q[3] = {0, 0, 0};
        if (x < 1 || y < 1 || x > nx - 1 || y > ny - 1) continue;
        GPROJT_NEAR(parameter[2 * v], x, 1e-14);
        GPROJT_NEAR(parameter[2 * v + 1], y, 1e-14);
        for (k = 0; k < grid->vertex_count; ++k)
            gprojt_add_scaled(grid, k, gprojt_quartic(x - k % (nx + 1), y - k / (nx + 1)), q);
        gprojt_limit(fine, GPROJ_LOOP, v, p);
        worst = fmax(worst, gprojt_far(p, q));
        ++met;
    }
    GPROJT_CHECK(met == (4 * nx - 7) * (4 * ny - 7));
    GPROJT_CHECK(worst < 1e-14);
    free(parameter);
    gproj_stencil_destroy(stencil);
    gproj_mesh_destroy(fine);
    gproj_mesh_destroy(grid);
}

/* The loop that begins at a boundary half-edge, twice subdivided, against the curve of the coarse one. */
static double gprojt_loop_off_its_curve(const gproj_mesh *mesh, const gproj_mesh *fine, int32_t first) {
    double *point = (double *)malloc(3 * (size_t)mesh->vertex_count * sizeof *point), worst = 0;
    bool *corner = (bool *)malloc((size_t)mesh->vertex_count * sizeof *corner);
    int32_t count = 0, h = first, i, k, v;
    do {
        corner[count] = gproj_mesh_valence(mesh, mesh->origin[h]) == 2;
        memcpy(point + 3 * count++, mesh->position + 3 * mesh->origin[h], 3 * sizeof *point);
        h = mesh->next[h];
    } while (h != first);
    h = fine->vertex_halfedge[mesh->origin[first]];
    for (i = 0; i < count; ++i)
        for (k = 0; k < 4; ++k, h = fine->next[h]) {
            double p[3], q[3];
            v = fine->origin[h];
            gprojt_boundary_limit(fine, v, p);
            if (k == 0 && corner[i]) memcpy(p, fine->position + 3 * v, sizeof p);
            gprojt_curve(point, corner, count, i, k / 4.0, q);
            worst = fmax(worst, gprojt_far(p, q));
        }
    GPROJT_CHECK(h == fine->vertex_halfedge[mesh->origin[first]]);
    free(point);
    free(corner);
    return worst;
}

GPROJT_TEST(boundaries_are_cubic_curves) {
    int shape, met = 0;
    int32_t l;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gproj_scheme scheme = shape == TRIANGLES ? GPROJ_LOOP : GPROJ_CATMULL_CLARK;
        gproj_mesh *mesh = gprojt_random_mesh(gprojt_shape(shape, 4), 3);
        gproj_mesh *fine = gprojt_subdivided(mesh, scheme, 2, NULL);
        for (l = 0; l < mesh->loop_count; ++l, ++met)
            GPROJT_CHECK(gprojt_loop_off_its_curve(mesh, fine, mesh->loop_halfedge[l]) < 1e-14);
        gproj_mesh_destroy(fine);
        gproj_mesh_destroy(mesh);
    }
    GPROJT_CHECK(met == 6);
}

/* -- extraordinary vertices -- */

/* A fan of n faces around vertex 0: triangles, or quads. */
static gproj_mesh *gprojt_fan(int32_t n, bool quads) {
    gprojt_soup s;
    int32_t k, step = quads ? 2 : 1;
    memset(&s, 0, sizeof s);
    for (k = 0; k <= step * n; ++k) gprojt_add_vertex(&s, 0, 0, 0);
    for (k = 0; k < n; ++k) {
        int32_t a = 1 + step * k, b = 1 + step * ((k + 1) % n);
        if (quads)
            gprojt_add_quad(&s, 0, a, a + 1, b);
        else
            gprojt_add_triangle(&s, 0, a, b);
    }
    return gprojt_random_mesh(s, 4);
}

/* The limit masks are left eigenvectors of subdivision: they give the same point from every level; and the vertex goes
   there. */
GPROJT_TEST(extraordinary_vertices_have_their_limits) {
    int32_t n, scheme, level, k;
    for (n = 3; n <= 9; ++n)
        for (scheme = 0; scheme < 2; ++scheme) {
            gproj_mesh *mesh = gprojt_fan(n, scheme == 0), *fine;
            double first[3], p[3], before = 0, now;
            gprojt_limit(mesh, (gproj_scheme)scheme, 0, first);
            for (level = 1; level <= 5; ++level) {
                fine = gprojt_subdivided(mesh, (gproj_scheme)scheme, level, NULL);
                GPROJT_CHECK(gproj_mesh_valence(fine, 0) == n);
                gprojt_limit(fine, (gproj_scheme)scheme, 0, p);
                for (k = 0; k < 3; ++k) GPROJT_NEAR(p[k], first[k], 1e-14);
                now = gprojt_far(fine->position, p);
                GPROJT_CHECK(level == 1 || now < 0.9 * before);
                before = now;
                gproj_mesh_destroy(fine);
            }
            gproj_mesh_destroy(mesh);
        }
}

static gproj_mesh *gprojt_octahedron(void) {
    gprojt_soup s;
    int32_t k;
    memset(&s, 0, sizeof s);
    for (k = 0; k < 6; ++k)
        gprojt_add_vertex(&s, k % 3 == 0 ? 1 - k / 3 * 2 : 0, k % 3 == 1 ? 1 - k / 3 * 2 : 0,
                          k % 3 == 2 ? 1 - k / 3 * 2 : 0);
    for (k = 0; k < 8; ++k) {
        int32_t a = k & 1 ? 3 : 0, b = k & 2 ? 4 : 1, c = k & 4 ? 5 : 2, odd = (k ^ k >> 1 ^ k >> 2) & 1;
        gprojt_add_triangle(&s, a, odd ? c : b, odd ? b : c);
    }
    return gprojt_mesh_of(s);
}

static void gprojt_check_point(const gproj_mesh *mesh, int32_t v, double x, double y, double z) {
    double p[3];
    p[0] = x, p[1] = y, p[2] = z;
    GPROJT_NEAR(gprojt_far(mesh->position + 3 * v, p), 0, 1e-15);
}

/* By hand: a cube's corner goes to (Q + 2 R) / 3, the means of its faces' and edges' middles; Loop's b is 31/256 for
   n = 4, 3/16 for n = 3. */
GPROJT_TEST(values_by_hand) {
    static const double box[24] = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
    static const int32_t degree[6] = {4, 4, 4, 4, 4, 4};
    static const int32_t corner[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    gproj_mesh *cube = gproj_mesh_create(8, box, 6, degree, corner, NULL, NULL), *fine;
    gproj_mesh *eight = gprojt_octahedron();
    int32_t e;
    fine = gproj_mesh_subdivide(cube, NULL, NULL, NULL, NULL);
    GPROJT_REQUIRE(fine && eight);
    gprojt_check_point(fine, 6, 5.0 / 9, 5.0 / 9, 5.0 / 9);
    gprojt_check_point(fine, 8 + gprojt_edge_between(cube, 2, 6), 0.75, 0.75, 0);
    gprojt_check_point(fine, 8 + 12 + 1, 0, 0, 1);
    GPROJT_CHECK(fine->vertex_count == 26 && fine->face_count == 24 && fine->edge_count == 48);
    /* face 1 is 4 5 6 7: its corner 1 gives the quad of 5, the edge 5-6, the face, the edge 4-5 */
    e = fine->face_halfedge[4 * 1 + 1];
    GPROJT_CHECK(fine->origin[e] == 5 && fine->origin[e ^ 1] == 8 + gprojt_edge_between(cube, 5, 6));
    GPROJT_CHECK(fine->origin[fine->next[fine->next[e]]] == 8 + 12 + 1);
    GPROJT_CHECK(fine->origin[fine->prev[e]] == 8 + gprojt_edge_between(cube, 4, 5));
    gproj_mesh_destroy(fine);
    fine = gprojt_subdivided(eight, GPROJ_LOOP, 1, NULL);
    gprojt_check_point(fine, 2, 0, 0, 1 - 4 * 31.0 / 256);
    gprojt_check_point(fine, 6 + gprojt_edge_between(eight, 0, 1), 3.0 / 8, 3.0 / 8, 0);
    GPROJT_CHECK(fine->vertex_count == 18 && fine->face_count == 32 && fine->edge_count == 48);
    /* face 0 is 0 1 2: first its corners' triangles, then that of its edges */
    e = fine->face_halfedge[1];
    GPROJT_CHECK(fine->origin[e] == 1 && fine->origin[e ^ 1] == 6 + gprojt_edge_between(eight, 1, 2));
    GPROJT_CHECK(fine->origin[fine->prev[e]] == 6 + gprojt_edge_between(eight, 0, 1));
    GPROJT_CHECK(fine->origin[fine->face_halfedge[3]] == 6 + gprojt_edge_between(eight, 0, 1));
    gproj_mesh_destroy(fine);
    gproj_mesh_destroy(cube);
    gproj_mesh_destroy(eight);
}

/* -- any mesh -- */

static int32_t gprojt_euler(const gproj_mesh *m) { return m->vertex_count - m->edge_count + m->face_count; }

/* A stencil's rows: ascending columns, positive weights that sum to 1. */
static void gprojt_check_stencil(const gproj_stencil *s) {
    int32_t i;
    int64_t k;
    bool right = s->start[0] == 0;
    double worst = 0;
    for (i = 0; i < s->row_count; ++i) {
        double sum = 0;
        right = right && s->start[i] < s->start[i + 1];
        for (k = s->start[i]; k < s->start[i + 1]; ++k) {
            sum += s->weight[k];
            right = right && s->weight[k] > 0 && s->column[k] >= 0 && s->column[k] < s->column_count;
            right = right && (k == s->start[i] || s->column[k] > s->column[k - 1]);
        }
        worst = fmax(worst, fabs(sum - 1));
    }
    GPROJT_CHECK(right);
    GPROJT_CHECK(worst < 1e-14);
}

static void gprojt_check_levels(const gproj_mesh *mesh, gproj_scheme scheme) {
    int32_t level, corners = 0, f, v;
    for (f = 0; f < mesh->face_count; ++f) corners += mesh->face_degree[f];
    for (level = 1; level <= 3; ++level) {
        gproj_stencil *stencil;
        gproj_mesh *fine = gprojt_subdivided(mesh, scheme, level, &stencil);
        double *image;
        const char *wrong;
        GPROJT_REQUIRE(fine);
        wrong = gprojt_validate_mesh(fine);
        if (wrong) printf("    %s\n", wrong);
        GPROJT_CHECK(!wrong && fine->reoriented_count == 0);
        GPROJT_CHECK(gprojt_euler(fine) == gprojt_euler(mesh) && fine->component_count == mesh->component_count);
        GPROJT_CHECK(fine->loop_count == mesh->loop_count && fine->isolated_count == mesh->isolated_count);
        GPROJT_CHECK(fine->face_count == (scheme == GPROJ_LOOP ? 4 * mesh->face_count : corners) << (2 * (level - 1)));
        for (f = 0; f < fine->face_count; ++f) GPROJT_CHECK(fine->face_degree[f] == (scheme == GPROJ_LOOP ? 3 : 4));
        for (v = 0; v < mesh->vertex_count; ++v)
            GPROJT_CHECK(gproj_mesh_valence(fine, v) == gproj_mesh_valence(mesh, v));
        GPROJT_CHECK(stencil->row_count == fine->vertex_count && stencil->column_count == mesh->vertex_count);
        gprojt_check_stencil(stencil);
        image = (double *)malloc(3 * (size_t)fine->vertex_count * sizeof *image);
        gproj_stencil_apply(stencil, 3, mesh->position, image);
        GPROJT_CHECK(gprojt_largest_move(image, fine->position, fine->vertex_count) < 1e-14);
        GPROJT_CHECK(level > 1 || gprojt_unmoved(fine, image));
        free(image);
        gproj_stencil_destroy(stencil);
        gproj_mesh_destroy(fine);
    }
}

GPROJT_TEST(all_meshes_become_finer) {
    int shape;
    for (shape = 0; shape < GPROJT_SHAPES; ++shape) {
        gproj_mesh *mesh = gprojt_random_mesh(gprojt_shape(shape, 3), 5);
        gprojt_check_levels(mesh, GPROJ_CATMULL_CLARK);
        if (shape == TRIANGLES) gprojt_check_levels(mesh, GPROJ_LOOP);
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(real_meshes_become_finer) {
    int i, loops = 0;
    for (i = 0; i < GPROJT_REAL_MESHES; ++i) {
        gproj_mesh *mesh = gprojt_load_real_mesh(i, NULL, NULL), *fine;
        gproj_scheme scheme = GPROJ_LOOP;
        int32_t f;
        if (!mesh) GPROJT_SKIP("the folder of real meshes is not there");
        for (f = 0; f < mesh->face_count; ++f)
            if (mesh->face_degree[f] != 3) scheme = GPROJ_CATMULL_CLARK;
        loops += scheme == GPROJ_LOOP;
        fine = gprojt_subdivided(mesh, scheme, 1, NULL);
        GPROJT_REQUIRE(fine);
        GPROJT_CHECK(!gprojt_validate_mesh(fine) && gprojt_euler(fine) == gprojt_euler(mesh));
        gproj_mesh_destroy(fine);
        gproj_mesh_destroy(mesh);
    }
    GPROJT_CHECK(loops >= 1);
}

/* Vertices with two edges inside a mesh, a mesh of one face, one without faces. */
GPROJT_TEST(unusual_meshes) {
    gprojt_soup pillow, leaf, one;
    gproj_mesh *mesh[4];
    int i;
    int32_t pentagon[5] = {0, 1, 2, 3, 4};
    memset(&pillow, 0, sizeof pillow), memset(&leaf, 0, sizeof leaf), memset(&one, 0, sizeof one);
    for (i = 0; i < 5; ++i) {
        if (i < 3) gprojt_add_vertex(&pillow, 0, 0, 0);
        gprojt_add_vertex(&leaf, 0, 0, 0);
        gprojt_add_vertex(&one, 0, 0, 0);
    }
    gprojt_add_triangle(&pillow, 0, 1, 2), gprojt_add_triangle(&pillow, 0, 2, 1);
    gprojt_add_quad(&leaf, 0, 1, 2, 3), gprojt_add_quad(&leaf, 2, 1, 0, 4);
    gprojt_add_face(&one, 5, pentagon);
    mesh[0] = gprojt_random_mesh(pillow, 6), mesh[1] = gprojt_random_mesh(leaf, 7);
    mesh[2] = gprojt_random_mesh(one, 8), mesh[3] = gprojt_random_mesh(gprojt_quad_grid(1, 1), 9);
    for (i = 0; i < 4; ++i) {
        gprojt_check_levels(mesh[i], GPROJ_CATMULL_CLARK);
        gproj_mesh_destroy(mesh[i]);
    }
    mesh[0] = gproj_mesh_create(2, (const double[6]){1, 2, 3, 4, 5, 6}, 0, NULL, NULL, NULL, NULL);
    mesh[1] = gprojt_subdivided(mesh[0], GPROJ_LOOP, 14, NULL);
    GPROJT_REQUIRE(mesh[1] && mesh[1]->vertex_count == 2 && mesh[1]->isolated_count == 2);
    GPROJT_CHECK(gprojt_unmoved(mesh[1], mesh[0]->position));
    gproj_mesh_destroy(mesh[0]);
    gproj_mesh_destroy(mesh[1]);
}

/* An affine map before or after is the same. */
GPROJT_TEST(affine_maps_go_through) {
    static const double map[3][4] = {{2, 0.3, -1, 5}, {0.1, -1.5, 0.4, -7}, {1, 0.2, 0.7, 11}};
    int shape, scheme;
    int32_t i, k;
    for (shape = 1; shape <= HYBRID; ++shape)
        for (scheme = 0; scheme <= (shape == TRIANGLES); ++scheme) {
            gproj_mesh *mesh = gprojt_random_mesh(gprojt_shape(shape, 4), 10),
                       *image = gproj_mesh_copy(mesh, NULL, NULL);
            gproj_mesh *fine = gprojt_subdivided(mesh, (gproj_scheme)scheme, 2, NULL), *other;
            for (i = 0; i < mesh->vertex_count; ++i)
                for (k = 0; k < 3; ++k)
                    image->position[3 * i + k] = gprojt_dot3(map[k], mesh->position + 3 * i) + map[k][3];
            other = gprojt_subdivided(image, (gproj_scheme)scheme, 2, NULL);
            for (i = 0; i < fine->vertex_count; ++i)
                for (k = 0; k < 3; ++k)
                    GPROJT_NEAR(other->position[3 * i + k], gprojt_dot3(map[k], fine->position + 3 * i) + map[k][3],
                                5e-14);
            gproj_mesh_destroy(other);
            gproj_mesh_destroy(fine);
            gproj_mesh_destroy(image);
            gproj_mesh_destroy(mesh);
        }
}

/* The largest distance of a vertex, with x y z turned into y z x and z mirrored, from the nearest one. */
static double gprojt_asymmetry(const gproj_mesh *mesh) {
    double worst = 0;
    int32_t i, j;
    for (i = 0; i < mesh->vertex_count; ++i) {
        const double *p = mesh->position + 3 * i;
        double image[3], nearest = HUGE_VAL;
        image[0] = p[1], image[1] = p[2], image[2] = -p[0];
        for (j = 0; j < mesh->vertex_count; ++j) nearest = fmin(nearest, gprojt_far(image, mesh->position + 3 * j));
        worst = fmax(worst, nearest);
    }
    return worst;
}

GPROJT_TEST(symmetry_stays) {
    gproj_mesh *mesh[2], *fine;
    int i;
    mesh[0] = gprojt_mesh_of(gprojt_cube_sphere(2)), mesh[1] = gprojt_octahedron();
    for (i = 0; i < 2; ++i) {
        fine = gprojt_subdivided(mesh[i], i ? GPROJ_LOOP : GPROJ_CATMULL_CLARK, 2, NULL);
        GPROJT_CHECK(gprojt_asymmetry(mesh[i]) < 1e-15 && gprojt_asymmetry(fine) < 1e-15);
        gproj_mesh_destroy(fine);
        gproj_mesh_destroy(mesh[i]);
    }
}

/* -- stencils -- */

static bool gprojt_same_stencil(const gproj_stencil *a, const gproj_stencil *b) {
    size_t rows = (size_t)a->row_count + 1, entries = (size_t)a->start[a->row_count];
    return a->row_count == b->row_count && a->column_count == b->column_count &&
           !memcmp(a->start, b->start, rows * sizeof *a->start) &&
           !memcmp(a->column, b->column, entries * sizeof *a->column) &&
           !memcmp(a->weight, b->weight, entries * sizeof *a->weight);
}

/* Between any two levels, by one call or by products; creases and corners go on in all of them. */
GPROJT_TEST(stencils_compose) {
    static const double sharpness[3] = {1.3, 3, INFINITY};
    int32_t scheme;
    for (scheme = 0; scheme < 2; ++scheme) {
        gproj_mesh *mesh = gprojt_random_mesh(gprojt_shape(scheme ? TRIANGLES : HYBRID, 4), 11), *fine[4];
        gproj_subdivide_options options = gprojt_levels((gproj_scheme)scheme, 1);
        gproj_stencil *whole[4], *step[4], *product, *wrong;
        gproj_error error;
        int32_t creases[3] = {9, 17, 30}, corner = 7, level;
        options.crease_count = 3, options.creases = creases, options.sharpness = sharpness;
        options.corner_count = 1, options.corners = &corner;
        for (level = 1; level <= 3; ++level) {
            gproj_mesh *again;
            options.levels = level, options.stencil_level = 0;
            fine[level] = gproj_mesh_subdivide(mesh, &options, &whole[level], NULL, NULL);
            options.stencil_level = level - 1;
            again = gproj_mesh_subdivide(mesh, &options, &step[level], NULL, NULL);
            GPROJT_REQUIRE(fine[level] && again && gprojt_same_mesh(fine[level], again));
            gprojt_check_stencil(whole[level]);
            gprojt_check_stencil(step[level]);
            gproj_mesh_destroy(again);
        }
        GPROJT_CHECK(gprojt_same_stencil(whole[1], step[1]));
        product = gproj_stencil_multiply(step[2], step[1], NULL, NULL);
        GPROJT_CHECK(gprojt_same_stencil(product, whole[2]));
        gproj_stencil_destroy(product);
        product = gproj_stencil_multiply(step[3], whole[2], NULL, NULL);
        GPROJT_CHECK(gprojt_same_stencil(product, whole[3]));
        gproj_stencil_destroy(product);
        /* a step takes the positions of its level to the next, to the last bit */
        for (level = 1; level < 3; ++level) {
            double *image = (double *)malloc(3 * (size_t)fine[level + 1]->vertex_count * sizeof *image);
            gproj_stencil_apply(step[level + 1], 3, fine[level]->position, image);
            GPROJT_CHECK(gprojt_unmoved(fine[level + 1], image));
            free(image);
        }
        GPROJT_CHECK(!memcmp(fine[3]->position + 3 * corner, mesh->position + 3 * corner, 3 * sizeof(double)));
        wrong = gproj_stencil_multiply(step[1], step[2], NULL, &error);
        GPROJT_CHECK(!wrong && error.code == GPROJ_ERROR_ARGUMENT && strstr(error.message, "give the fine one first"));
        for (level = 0; level < 2; ++level) {
            wrong = gproj_stencil_multiply(level ? step[1] : NULL, level ? NULL : step[1], NULL, &error);
            GPROJT_CHECK(!wrong && error.code == GPROJ_ERROR_ARGUMENT && strstr(error.message, "is NULL"));
        }
        for (level = 1; level <= 3; ++level) {
            gproj_mesh_destroy(fine[level]);
            gproj_stencil_destroy(whole[level]);
            gproj_stencil_destroy(step[level]);
        }
        gproj_mesh_destroy(mesh);
    }
}

/* A handle: what a coarse vertex moves is its row of the transposed matrix. */
GPROJT_TEST(handles_move_what_they_should) {
    gproj_mesh *mesh = gprojt_random_mesh(gprojt_hybrid_grid(4, 3), 12), *fine, *moved;
    gproj_stencil *stencil, *handles, *twice;
    const double d[3] = {0.3, -0.2, 0.9};
    int32_t handle = 6, i;
    int64_t k;
    fine = gprojt_subdivided(mesh, GPROJ_CATMULL_CLARK, 2, &stencil);
    handles = gproj_stencil_transpose(stencil, NULL, NULL);
    twice = gproj_stencil_transpose(handles, NULL, NULL);
    GPROJT_REQUIRE(fine && handles && twice);
    GPROJT_CHECK(gprojt_same_stencil(stencil, twice));
    GPROJT_CHECK(handles->row_count == mesh->vertex_count && handles->column_count == fine->vertex_count);
    for (k = handles->start[handle]; k < handles->start[handle + 1]; ++k)
        for (i = 0; i < 3; ++i) fine->position[3 * handles->column[k] + i] += handles->weight[k] * d[i];
    for (i = 0; i < 3; ++i) mesh->position[3 * handle + i] += d[i];
    moved = gprojt_subdivided(mesh, GPROJ_CATMULL_CLARK, 2, NULL);
    GPROJT_CHECK(gprojt_largest_move(moved->position, fine->position, fine->vertex_count) < 1e-14);
    GPROJT_CHECK(gproj_stencil_memory(stencil).used > 0 && gproj_stencil_memory(NULL).used == 0);
    gproj_stencil_apply(NULL, 3, NULL, NULL);
    gproj_stencil_apply(stencil, 3, NULL, fine->position);
    gproj_stencil_apply(stencil, 3, mesh->position, NULL);
    gproj_stencil_destroy(NULL);
    gproj_stencil_destroy(stencil);
    gproj_stencil_destroy(handles);
    gproj_stencil_destroy(twice);
    gproj_mesh_destroy(moved);
    gproj_mesh_destroy(fine);
    gproj_mesh_destroy(mesh);
}

/* -- creases and corners -- */

/* The edges of row j of a grid. */
static void gprojt_row_edges(const gproj_mesh *grid, int32_t nx, int32_t j, int32_t *edges) {
    int32_t i;
    for (i = 0; i < nx; ++i) edges[i] = gprojt_edge_between(grid, j * (nx + 1) + i, j * (nx + 1) + i + 1);
}

/* A crease through the whole grid is the cubic curve of its points, and parts the grid in two, as a boundary would. */
GPROJT_TEST(sharp_creases_are_cubic_curves) {
    enum {
        NX = 5,
        NY = 4,
        ROW = 2
    };
    const int32_t ends[2] = {ROW * (NX + 1), ROW * (NX + 1) + NX};
    int32_t scheme, edges[NX], i, k, v;
    for (scheme = 0; scheme < 2; ++scheme) {
        gproj_mesh *grid = gprojt_random_mesh(scheme ? gprojt_triangle_grid(NX, NY) : gprojt_quad_grid(NX, NY), 13);
        gproj_subdivide_options options = gprojt_levels((gproj_scheme)scheme, 2);
        gproj_mesh *fine, *half, *fine_half;
        gproj_stencil *stencil;
        const double *point = grid->position + 3 * ROW * (NX + 1);
        double *parameter, p[3], q[3];
        bool end[NX + 1] = {true};
        int32_t on[4 * NX + 1];
        end[NX] = true;
        gprojt_row_edges(grid, NX, ROW, edges);
        options.crease_count = NX, options.creases = edges;
        fine = gproj_mesh_subdivide(grid, &options, &stencil, NULL, NULL);
        parameter = gprojt_parameters(stencil, NX);
        for (i = 0; i <= 4 * NX; ++i) on[i] = -1;
        for (v = 0; v < fine->vertex_count; ++v) {
            k = (int32_t)floor(4 * parameter[2 * v] + 0.5);
            if (fabs(parameter[2 * v + 1] - ROW) < 1e-14) on[k] = v;
        }
        for (i = 0; i <= 4 * NX; ++i) {
            GPROJT_REQUIRE(on[i] >= 0);
            memcpy(p, fine->position + 3 * on[i], sizeof p);
            if (i > 0 && i < 4 * NX) gprojt_crease_limit(fine, on[i - 1], on[i], on[i + 1], p);
            gprojt_curve(point, end, NX + 1, i < 4 * NX ? i / 4 : NX - 1, i < 4 * NX ? i % 4 / 4.0 : 1, q);
            GPROJT_CHECK(gprojt_far(p, q) < 1e-14);
        }
        /* the lower half alone: rows 0 .. ROW come first, and have the same vertices */
        half = gprojt_mesh_of(scheme ? gprojt_triangle_grid(NX, ROW) : gprojt_quad_grid(NX, ROW));
        memcpy(half->position, grid->position, 3 * (size_t)half->vertex_count * sizeof(double));
        options.crease_count = 0;
        options.corner_count = 2, options.corners = ends; /* three edges were sharp there */
        fine_half = gproj_mesh_subdivide(half, &options, NULL, NULL, NULL);
        for (v = 0; v < fine_half->vertex_count; ++v) {
            double nearest = HUGE_VAL;
            for (i = 0; i < fine->vertex_count; ++i)
                nearest = fmin(nearest, gprojt_far(fine->position + 3 * i, fine_half->position + 3 * v));
            GPROJT_CHECK(nearest < 1e-14);
        }
        free(parameter);
        gproj_stencil_destroy(stencil);
        gproj_mesh_destroy(fine_half);
        gproj_mesh_destroy(half);
        gproj_mesh_destroy(fine);
        gproj_mesh_destroy(grid);
    }
}

/* `levels` levels of the grid with a crease of this sharpness along row 2. */
static gproj_mesh *gprojt_creased(const gproj_mesh *grid, int32_t nx, double sharp, int32_t levels) {
    gproj_subdivide_options options = gprojt_levels(GPROJ_CATMULL_CLARK, levels);
    int32_t edges[16], i;
    double sharpness[16];
    gprojt_row_edges(grid, nx, 2, edges);
    for (i = 0; i < nx; ++i) sharpness[i] = sharp;
    options.crease_count = nx, options.creases = edges, options.sharpness = sharpness;
    return gproj_mesh_subdivide(grid, &options, NULL, NULL, NULL);
}

/* A crease of sharpness s is sharp for s levels, then smooth; between whole numbers it is between them. */
GPROJT_TEST(creases_become_smooth) {
    const int32_t nx = 4;
    gproj_mesh *grid = gprojt_random_mesh(gprojt_quad_grid(nx, 4), 14), *one, *two, *other;
    double worst = 0, turn = 0;
    int32_t i;
    one = gprojt_creased(grid, nx, 1, 1), two = gprojt_creased(grid, nx, INFINITY, 1);
    GPROJT_CHECK(gprojt_same_mesh(one, two));
    gproj_mesh_destroy(two);
    two = gprojt_subdivided(one, GPROJ_CATMULL_CLARK, 1, NULL);
    other = gprojt_creased(grid, nx, 1, 2);
    GPROJT_CHECK(gprojt_same_mesh(two, other));
    gproj_mesh_destroy(other);
    other = gprojt_creased(grid, nx, 2, 2);
    GPROJT_CHECK(!gprojt_unmoved(other, two->position));
    gproj_mesh_destroy(two);
    two = gprojt_creased(grid, nx, INFINITY, 2);
    GPROJT_CHECK(gprojt_same_mesh(two, other));
    gproj_mesh_destroy(two);
    gproj_mesh_destroy(other);
    gproj_mesh_destroy(one);
    one = gprojt_creased(grid, nx, 0, 1), two = gprojt_creased(grid, nx, 1, 1),
    other = gprojt_creased(grid, nx, 0.3, 1);
    for (i = 0; i < 3 * one->vertex_count; ++i) {
        double between = 0.7 * one->position[i] + 0.3 * two->position[i];
        worst = fmax(worst, fabs(other->position[i] - between));
        turn = fmax(turn, fabs(one->position[i] - two->position[i]));
    }
    GPROJT_CHECK(worst < 1e-15 && turn > 0.05);
    gproj_mesh_destroy(other);
    other = gprojt_subdivided(grid, GPROJ_CATMULL_CLARK, 1, NULL);
    GPROJT_CHECK(gprojt_same_mesh(one, other));
    gproj_mesh_destroy(one);
    gproj_mesh_destroy(two);
    gproj_mesh_destroy(other);
    gproj_mesh_destroy(grid);
}

/* One sharp edge at a vertex changes the edge, not the vertex; three make it a corner; two of different sharpness are a
   crease as long as both last, and where one ends, both rules have their share. */
GPROJT_TEST(creases_meet) {
    const int32_t nx = 4, middle = 2 * 5 + 2;
    gproj_mesh *grid = gprojt_random_mesh(gprojt_quad_grid(nx, 4), 15), *smooth, *fine;
    gproj_subdivide_options options = gprojt_levels(GPROJ_CATMULL_CLARK, 1);
    int32_t edges[4], k, pass;
    double sharpness[4] = {INFINITY, INFINITY, INFINITY, 0};
    const double *p = grid->position;
    edges[0] = gprojt_edge_between(grid, middle, middle - 1), edges[1] = gprojt_edge_between(grid, middle, middle + 1);
    edges[2] = gprojt_edge_between(grid, middle, middle + nx + 1), edges[3] = edges[1];
    smooth = gproj_mesh_subdivide(grid, NULL, NULL, NULL, NULL);
    options.creases = edges, options.sharpness = sharpness;
    for (options.crease_count = 1; options.crease_count <= 4; ++options.crease_count) {
        fine = gproj_mesh_subdivide(grid, &options, NULL, NULL, NULL);
        for (k = 0; k < 3; ++k) {
            double a = p[3 * (middle - 1) + k], v = p[3 * middle + k], b = p[3 * (middle + 1) + k];
            double wanted = options.crease_count == 1   ? smooth->position[3 * middle + k]
                            : options.crease_count == 2 ? (a + 6 * v + b) / 8
                                                        : v;
            GPROJT_NEAR(fine->position[3 * middle + k], wanted, 1e-15);
            GPROJT_NEAR(fine->position[3 * (25 + edges[0]) + k], (a + v) / 2, 1e-15);
        }
        gproj_mesh_destroy(fine);
    }
    options.crease_count = 2;
    for (pass = 0; pass < 2; ++pass) {
        /* a crease of which one edge ends with 1/4, the other goes on; one that ends with the mean of 1 and 1/2 */
        double sharp = pass ? 0.75 : 0.25;
        sharpness[0] = pass ? 1 : INFINITY, sharpness[1] = pass ? 0.5 : 0.25;
        fine = gproj_mesh_subdivide(grid, &options, NULL, NULL, NULL);
        for (k = 0; k < 3; ++k) {
            double crease = (p[3 * (middle - 1) + k] + 6 * p[3 * middle + k] + p[3 * (middle + 1) + k]) / 8;
            double wanted = sharp * crease + (1 - sharp) * smooth->position[3 * middle + k];
            GPROJT_NEAR(fine->position[3 * middle + k], wanted, 1e-15);
        }
        gproj_mesh_destroy(fine);
    }
    gproj_mesh_destroy(smooth);
    gproj_mesh_destroy(grid);
}

GPROJT_TEST(corners_stay_or_become_round) {
    const int32_t nx = 3, chosen[2] = {5, 3};
    gproj_mesh *grid = gprojt_random_mesh(gprojt_quad_grid(nx, 3), 16), *fine;
    gproj_subdivide_options options = gprojt_levels(GPROJ_CATMULL_CLARK, 2);
    const double *p = grid->position;
    int32_t k;
    fine = gproj_mesh_subdivide(grid, &options, NULL, NULL, NULL);
    GPROJT_CHECK(!memcmp(fine->position, p, 3 * sizeof *p) && !memcmp(fine->position + 9, p + 9, 3 * sizeof *p));
    GPROJT_CHECK(memcmp(fine->position + 15, p + 15, 3 * sizeof *p) != 0);
    gproj_mesh_destroy(fine);
    options.round_corners = true, options.levels = 1;
    options.corner_count = 2, options.corners = chosen;
    fine = gproj_mesh_subdivide(grid, &options, NULL, NULL, NULL);
    for (k = 0; k < 3; ++k) GPROJT_NEAR(fine->position[k], (p[3 + k] + 6 * p[k] + p[3 * (nx + 1) + k]) / 8, 1e-15);
    GPROJT_CHECK(!memcmp(fine->position + 9, p + 9, 3 * sizeof *p));
    GPROJT_CHECK(!memcmp(fine->position + 15, p + 15, 3 * sizeof *p));
    gproj_mesh_destroy(fine);
    options.corners = NULL, options.crease_count = grid->edge_count; /* the first ones: vertices 0 and 1; all edges */
    fine = gproj_mesh_subdivide(grid, &options, NULL, NULL, NULL);
    GPROJT_CHECK(!memcmp(fine->position, p, 6 * sizeof *p) && memcmp(fine->position + 9, p + 9, 3 * sizeof *p) != 0);
    GPROJT_CHECK(!memcmp(fine->position + 15, p + 15, 3 * sizeof *p)); /* four sharp edges */
    gproj_mesh_destroy(fine);
    gproj_mesh_destroy(grid);
}

/* -- polylines -- */

GPROJT_TEST(polylines_are_refined) {
    static const char text[] =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 7 7 7\nv 8 8 8\nf 1 2 3 4\nl 1 2 3 1\nl 5 6 5\nl 4 5\n";
    gproj_mesh *mesh = gproj_mesh_read(text, sizeof text - 1, GPROJ_FORMAT_OBJ, NULL, NULL), *fine;
    const int32_t *start, *p;
    GPROJT_REQUIRE(mesh);
    fine = gprojt_subdivided(mesh, GPROJ_CATMULL_CLARK, 2, NULL);
    GPROJT_REQUIRE(fine && !gprojt_validate_mesh(fine) && fine->polyline_count == 3);
    start = fine->polyline_start, p = fine->polyline_vertex;
    /* two edges became four each; the diagonal 3 1 is no edge; what is between vertices without a face stays */
    GPROJT_CHECK(start[1] == 10 && start[2] == 13 && start[3] == 15);
    GPROJT_CHECK(p[0] == 0 && p[4] == 1 && p[8] == 2 && p[9] == 0);
    GPROJT_CHECK(p[2] == 6 + gprojt_edge_between(mesh, 0, 1) && p[6] == 6 + gprojt_edge_between(mesh, 1, 2));
    GPROJT_CHECK(gprojt_edge_between(fine, p[0], p[1]) >= 0 && gprojt_edge_between(fine, p[7], p[8]) >= 0);
    GPROJT_CHECK(p[10] == 4 && p[11] == 5 && p[12] == 4 && p[13] == 3 && p[14] == 4);
    GPROJT_CHECK(!memcmp(fine->position + 12, mesh->position + 12, 6 * sizeof(double)) && fine->isolated_count == 2);
    gproj_mesh_destroy(fine);
    gproj_mesh_destroy(mesh);
}

/* -- refusals and memory -- */

static void gprojt_refused(const gproj_mesh *mesh, const gproj_subdivide_options *options, gproj_code code,
                           gproj_place place, int64_t index, const char *piece) {
    gproj_error error;
    gproj_stencil *stencil = (gproj_stencil *)&error;
    gprojt_failing failing;
    gproj_host host;
    gproj_mesh *fine;
    memset(&failing, 0, sizeof failing);
    host = gprojt_failing_host(&failing);
    fine = gproj_mesh_subdivide(mesh, options, &stencil, &host, &error);
    GPROJT_CHECK(gprojt_mesh_was_refused(fine, &error, code, place, index, piece));
    GPROJT_CHECK(!stencil && failing.calls == 0); /* before memory is taken */
}

GPROJT_TEST(refusals) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_hybrid_grid(4, 3)), *pillow;
    gproj_subdivide_options options = gprojt_levels(GPROJ_CATMULL_CLARK, 1), none = options;
    int32_t edges[2] = {3, 99}, corners[2] = {2, -1};
    double sharpness[2] = {1, -1};
    gprojt_soup s;
    int i;
    gprojt_refused(NULL, NULL, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "NULL");
    options.scheme = (gproj_scheme)7;
    gprojt_refused(mesh, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "no scheme 7");
    options = none, options.levels = -1;
    gprojt_refused(mesh, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "-1 levels; take 1 to 14");
    options.levels = 15;
    gprojt_refused(mesh, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "15 levels");
    options.levels = 14;
    gprojt_refused(mesh, &options, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "level 13 would have");
    options = none, options.stencil_level = 1;
    gprojt_refused(mesh, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "from level 1 to level 1");
    options.stencil_level = -1;
    gprojt_refused(mesh, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "from level -1 to level 1");
    options = none, options.scheme = GPROJ_LOOP;
    gprojt_refused(mesh, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_FACE, 2, "face 2 has 4 corners");
    options = none, options.creases = edges, options.crease_count = 2;
    gprojt_refused(mesh, &options, GPROJ_ERROR_INDEX, GPROJ_PLACE_EDGE, 99, "crease 1 is edge 99");
    edges[1] = -1;
    gprojt_refused(mesh, &options, GPROJ_ERROR_INDEX, GPROJ_PLACE_EDGE, -1, "crease 1 is edge -1");
    edges[1] = mesh->edge_count; /* one beyond the last */
    gprojt_refused(mesh, &options, GPROJ_ERROR_INDEX, GPROJ_PLACE_EDGE, mesh->edge_count, "crease 1 is edge");
    edges[1] = 5, options.sharpness = sharpness;
    gprojt_refused(mesh, &options, GPROJ_ERROR_NUMBER, GPROJ_PLACE_EDGE, 5, "sharpness of edge 5 is -1");
    sharpness[1] = NAN;
    gprojt_refused(mesh, &options, GPROJ_ERROR_NUMBER, GPROJ_PLACE_EDGE, 5, "sharpness of edge 5 is");
    options = none, options.corners = corners, options.corner_count = 2;
    gprojt_refused(mesh, &options, GPROJ_ERROR_INDEX, GPROJ_PLACE_VERTEX, -1, "corner 1 is vertex -1");
    corners[1] = mesh->vertex_count;
    gprojt_refused(mesh, &options, GPROJ_ERROR_INDEX, GPROJ_PLACE_VERTEX, mesh->vertex_count, "corner 1 is vertex 20");
    options = none, options.corner_count = -1;
    gprojt_refused(mesh, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "0 creases and -1 corners");
    options = none, options.crease_count = -3;
    gprojt_refused(mesh, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "-3 creases");
    mesh->position[7] = NAN;
    gprojt_refused(mesh, NULL, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 2, "coordinate y of vertex 2");
    memset(&s, 0, sizeof s);
    for (i = 0; i < 3; ++i) gprojt_add_vertex(&s, i, i * i, 0);
    gprojt_add_triangle(&s, 0, 1, 2), gprojt_add_triangle(&s, 2, 1, 0);
    pillow = gprojt_mesh_of(s);
    options = none, options.scheme = GPROJ_LOOP;
    gprojt_refused(pillow, &options, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, 0, "the same three corners");
    gproj_mesh_destroy(pillow);
    memset(&s, 0, sizeof s); /* a triangle with two sides of a quad: the quad is refused */
    for (i = 0; i < 4; ++i) gprojt_add_vertex(&s, i, i * i, 0);
    gprojt_add_triangle(&s, 0, 1, 2), gprojt_add_quad(&s, 2, 1, 0, 3);
    pillow = gprojt_mesh_of(s);
    gprojt_refused(pillow, &options, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_FACE, 1, "face 1 has 4 corners");
    GPROJT_CHECK(!gproj_stencil_transpose(NULL, NULL, NULL) && !gproj_stencil_multiply(NULL, NULL, NULL, NULL));
    gproj_mesh_destroy(pillow);
    gproj_mesh_destroy(mesh);
}

/* What is too large is refused by the counts of the levels, for each of them. */
GPROJT_TEST(sizes_are_refused) {
    enum {
        TURNS = 70000
    };
    static const char mesh_text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nl";
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(2, 2));
    gproj_subdivide_options options = gprojt_levels(GPROJ_CATMULL_CLARK, 13);
    gprojt_text text;
    int32_t i;
    gprojt_refused(mesh, &options, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "level 13 would have 268468225 vertices");
    gproj_mesh_destroy(mesh);
    memset(&text, 0, sizeof text);
    gprojt_text_write(&text, mesh_text, sizeof mesh_text - 1);
    for (i = 0; i < TURNS; ++i) gprojt_text_write(&text, " 1 2", 4);
    mesh = gproj_mesh_read(text.text, text.size, GPROJ_FORMAT_OBJ, NULL, NULL);
    free(text.text);
    GPROJT_REQUIRE(mesh);
    options.levels = 14;
    gprojt_refused(mesh, &options, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "2293760000 in polylines");
    gproj_mesh_destroy(mesh);
}

static bool gprojt_use_subdivision(const gproj_host *host, void *user) {
    gproj_subdivide_options options = gprojt_levels(GPROJ_CATMULL_CLARK, 3);
    gproj_error error;
    gproj_stencil *stencil, *handles = NULL;
    gproj_mesh *fine;
    bool whole;
    options.crease_count = 3, options.corner_count = 2;
    fine = gproj_mesh_subdivide((const gproj_mesh *)user, &options, &stencil, host, &error);
    GPROJT_CHECK(!fine == !stencil);
    if (fine) {
        GPROJT_CHECK(gproj_mesh_memory(fine).used + gproj_stencil_memory(stencil).used ==
                     gprojt_failing_of(host)->bytes);
        handles = gproj_stencil_transpose(stencil, host, &error);
    }
    whole = handles != NULL;
    GPROJT_CHECK(whole || error.code == GPROJ_ERROR_MEMORY);
    gproj_stencil_destroy(handles);
    gproj_stencil_destroy(stencil);
    gproj_mesh_destroy(fine);
    return whole;
}

/* A closed prism: n quads between two faces of n corners, which make long rows. */
static gproj_mesh *gprojt_prism(int32_t n) {
    gprojt_soup s;
    int32_t ring[2][16], k;
    memset(&s, 0, sizeof s);
    for (k = 0; k < n; ++k) {
        ring[0][n - 1 - k] = gprojt_add_vertex(&s, 0, 0, 0);
        ring[1][k] = gprojt_add_vertex(&s, 0, 0, 0);
    }
    for (k = 0; k < n; ++k) gprojt_add_quad(&s, 2 * k, 2 * ((k + 1) % n), 2 * ((k + 1) % n) + 1, 2 * k + 1);
    gprojt_add_face(&s, n, ring[0]), gprojt_add_face(&s, n, ring[1]);
    return gprojt_random_mesh(s, 17);
}

GPROJT_TEST(every_allocation_fails_once) {
    static const char text[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 3\nf 1 2 3 4\nf 3 2 5\nl 1 2 3 1\n";
    gproj_mesh *mesh = gproj_mesh_read(text, sizeof text - 1, GPROJ_FORMAT_OBJ, NULL, NULL);
    GPROJT_REQUIRE(mesh);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_subdivision, mesh) >= 60);
    gproj_mesh_destroy(mesh);
    mesh = gprojt_prism(16);
    gprojt_check_levels(mesh, GPROJ_CATMULL_CLARK);
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_use_subdivision, mesh) >= 60);
    gproj_mesh_destroy(mesh);
}

int main(void) {
    GPROJT_RUN(catmull_clark_is_the_bicubic_spline);
    GPROJT_RUN(loop_is_the_quartic_box_spline);
    GPROJT_RUN(boundaries_are_cubic_curves);
    GPROJT_RUN(extraordinary_vertices_have_their_limits);
    GPROJT_RUN(values_by_hand);
    GPROJT_RUN(all_meshes_become_finer);
    GPROJT_RUN(real_meshes_become_finer);
    GPROJT_RUN(unusual_meshes);
    GPROJT_RUN(affine_maps_go_through);
    GPROJT_RUN(symmetry_stays);
    GPROJT_RUN(stencils_compose);
    GPROJT_RUN(handles_move_what_they_should);
    GPROJT_RUN(sharp_creases_are_cubic_curves);
    GPROJT_RUN(creases_become_smooth);
    GPROJT_RUN(creases_meet);
    GPROJT_RUN(corners_stay_or_become_round);
    GPROJT_RUN(polylines_are_refined);
    GPROJT_RUN(refusals);
    GPROJT_RUN(sizes_are_refused);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
