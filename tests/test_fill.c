/* test_fill.c - >>fill: closed curves filled with quads. */
#include "gprojt_form.h"

enum {
    MOST_POINTS = 400,
    MOST_CORNERS = 16
};

/* A closed curve with marked corners, and what is asked of its filling. */
typedef struct gprojt_curve {
    int32_t count, corner_count;
    double point[3 * MOST_POINTS];
    int32_t corner[MOST_CORNERS], edges[MOST_CORNERS];
    bool marked, given; /* corners, edges */
    gproj_fill_options options;
} gprojt_curve;

static void gprojt_add_point(gprojt_curve *c, double x, double y, double z) {
    c->point[3 * c->count] = x, c->point[3 * c->count + 1] = y, c->point[3 * c->count++ + 2] = z;
}

static gproj_fill_options gprojt_options(const gprojt_curve *c) {
    gproj_fill_options options = c->options;
    if (c->marked) options.corner_count = c->corner_count, options.corners = c->corner;
    if (c->given) options.side_count = options.side_count ? options.side_count : c->corner_count;
    if (c->given) options.subdivisions = c->edges;
    return options;
}

static gproj_mesh *gprojt_fill(const gprojt_curve *c, gproj_fill_info *info, gproj_error *error) {
    gproj_fill_options options = gprojt_options(c);
    return gproj_mesh_fill(c->count, c->point, &options, info, NULL, error);
}

/* A polygon without further points; corners are found. */
static gprojt_curve gprojt_polygon(int32_t count, const double *xy) {
    gprojt_curve c;
    int32_t i;
    memset(&c, 0, sizeof c);
    for (i = 0; i < count; ++i) gprojt_add_point(&c, xy[2 * i], xy[2 * i + 1], 0);
    return c;
}

/* `corners` corners on a circle, `points` points for each side, which bulges. */
static gprojt_curve gprojt_rose(int32_t corners, int32_t points, double bulge) {
    gprojt_curve c;
    int32_t i, j;
    memset(&c, 0, sizeof c);
    for (i = 0; i < corners; ++i) {
        double a = 6.283185307179586 * i / corners, b = 6.283185307179586 * (i + 1) / corners;
        c.corner[c.corner_count++] = c.count;
        for (j = 0; j < points; ++j) {
            double t = (double)j / points, h = 4 * bulge * t * (1 - t);
            double x = (1 - t) * cos(a) + t * cos(b), y = (1 - t) * sin(a) + t * sin(b);
            gprojt_add_point(&c, 5 * (x + h * cos(0.5 * (a + b))), 5 * (y + h * sin(0.5 * (a + b))), 0);
        }
    }
    c.marked = true;
    return c;
}

/* A random curve about the origin: kind 0 nearly convex, 1 curved inwards and outwards, 2 wild. It may cross itself. */
static gprojt_curve gprojt_random_curve(uint64_t *state, int32_t corners, int kind) {
    gprojt_curve c;
    double x[MOST_CORNERS + 1] = {0}, y[MOST_CORNERS + 1] = {0}, begin = 6.28 * gprojt_uniform(state);
    int32_t i, j, points = 12;
    memset(&c, 0, sizeof c);
    for (i = 0; i < corners; ++i) {
        double a = begin + 6.283185307179586 * (i + 0.6 * (gprojt_uniform(state) - 0.5)) / corners;
        double r = kind == 0 ? 10 : kind == 1 ? 5 + 10 * gprojt_uniform(state) : 3 + 12 * gprojt_uniform(state);
        x[i] = r * cos(a), y[i] = r * sin(a);
    }
    x[corners] = x[0], y[corners] = y[0];
    for (i = 0; i < corners; ++i) {
        double dx = x[i + 1] - x[i], dy = y[i + 1] - y[i], u = gprojt_uniform(state), out = corners == 2 ? 0.4 : 0;
        double bulge = out + (kind == 0 ? 0.15 * u : (kind == 1 ? 0.5 : 0.9) * (u - 0.5));
        double wave = kind == 2 ? 0.3 * (gprojt_uniform(state) - 0.5) : 0;
        c.corner[c.corner_count++] = c.count;
        for (j = 0; j < points; ++j) {
            double t = (double)j / points, h = 4 * bulge * t * (1 - t) + wave * sin(6.283185307179586 * t);
            gprojt_add_point(&c, x[i] + t * dx + h * dy, y[i] + t * dy - h * dx, 0);
        }
    }
    c.marked = true;
    return c;
}

static double gprojt_curve_length(const gprojt_curve *c, int32_t from, int32_t to) {
    double sum = 0;
    for (; from < to; ++from)
        sum += gprojt_far(c->point + 3 * (from % c->count), c->point + 3 * ((from + 1) % c->count));
    return sum;
}

static double gprojt_curve_side(const gprojt_curve *c, int32_t side) {
    int32_t to = side + 1 < c->corner_count ? c->corner[side + 1] : c->corner[0] + c->count;
    return gprojt_curve_length(c, c->corner[side], to);
}

/* -- what every filling must be -- */

/* Is the boundary the vertices 0, 1, .. in the order of the curve? */
static bool gprojt_boundary_is_first(const gproj_mesh *mesh, int32_t boundary) {
    int32_t v;
    for (v = 0; v < mesh->vertex_count; ++v)
        if (gproj_mesh_is_boundary_vertex(mesh, v) != (v < boundary)) return false;
    for (v = 0; v < boundary; ++v) /* the half-edges of the boundary run against the faces */
        if (mesh->origin[mesh->vertex_halfedge[(v + 1) % boundary] ^ 1] != v) return false;
    return true;
}

/* Sides from corner to corner, with the numbers of edges that were given. */
static bool gprojt_sides_are_right(const gprojt_curve *c, const gproj_mesh *mesh, const gproj_fill_info *info) {
    int32_t side, i, at = 0;
    if (mesh->polyline_count != info->side_count) return false;
    for (side = 0; side < mesh->polyline_count; ++side) {
        const int32_t *line = mesh->polyline_vertex + mesh->polyline_start[side];
        int32_t edges = mesh->polyline_start[side + 1] - mesh->polyline_start[side] - 1;
        if (c->given && !c->options.keep_points && edges != c->edges[side]) return false;
        if (c->marked && memcmp(mesh->position + 3 * line[0], c->point + 3 * c->corner[side], 3 * sizeof(double)) != 0)
            return false;
        for (i = 0; i <= edges; ++i)
            if (line[i] != (at + i) % info->boundary_count) return false;
        at += edges;
    }
    return at == info->boundary_count;
}

/* The largest distance of the boundary from the curve. */
static double gprojt_boundary_distance(const gprojt_curve *c, const gproj_mesh *mesh, int32_t boundary) {
    gproj_curve *curve = gproj_curve_create(c->count, c->point, true, NULL, NULL);
    double worst = 0;
    int32_t v;
    for (v = 0; v < boundary; ++v) worst = fmax(worst, gproj_curve_closest(curve, mesh->position + 3 * v).distance);
    gproj_curve_destroy(curve);
    return worst;
}

/* Does the curve run counter-clockwise, seen from above? */
static bool gprojt_is_left(const gprojt_curve *c) {
    double area = 0;
    int32_t i;
    for (i = 0; i < c->count; ++i) {
        const double *p = c->point + 3 * i, *q = c->point + 3 * ((i + 1) % c->count);
        area += p[0] * q[1] - p[1] * q[0];
    }
    return area > 0;
}

/* The smallest sine of a corner of a quad, seen from above, or from below if the curve is clockwise there. */
static double gprojt_least_sine(const gprojt_curve *c, const gproj_mesh *mesh) {
    double least = 1, sign = gprojt_is_left(c) ? 1 : -1;
    int32_t h;
    for (h = 0; h < mesh->halfedge_count; ++h) {
        const double *p = mesh->position + 3 * mesh->origin[h], *q = mesh->position + 3 * mesh->origin[mesh->next[h]],
                     *r = mesh->position + 3 * mesh->origin[mesh->prev[h]];
        double a = q[0] - p[0], b = q[1] - p[1], x = r[0] - p[0], y = r[1] - p[1];
        if (mesh->face[h] >= 0)
            least = fmin(least, sign * (a * y - b * x) / (sqrt(a * a + b * b) * sqrt(x * x + y * y)));
    }
    return least;
}

/* All of it; `most`: the largest valence inside. */
static bool gprojt_filling_is_good(const gprojt_curve *c, const gproj_mesh *mesh, const gproj_fill_info *info,
                                   int32_t most) {
    const char *wrong = gprojt_validate_mesh(mesh);
    int32_t f, v, irregular = 0;
    if (wrong) printf("    %s\n", wrong);
    if (wrong || mesh->loop_count != 1 || mesh->component_count != 1 || mesh->isolated_count || mesh->reoriented_count)
        return false;
    if (mesh->vertex_count - mesh->edge_count + mesh->face_count != 1) return false;
    for (f = 0; f < mesh->face_count; ++f)
        if (mesh->face_degree[f] != 4) return false;
    for (v = info->boundary_count; v < mesh->vertex_count; ++v) {
        int32_t valence = gproj_mesh_valence(mesh, v);
        irregular += valence != 4;
        if (valence < 3 || valence > most || valence < info->min_valence || valence > info->max_valence) return false;
    }
    return irregular == info->irregular_count && gprojt_boundary_is_first(mesh, info->boundary_count) &&
           gprojt_sides_are_right(c, mesh, info) && gprojt_boundary_distance(c, mesh, info->boundary_count) <= 1e-14 &&
           gprojt_least_sine(c, mesh) > 0 && info->min_angle > 0 && info->max_angle < 180;
}

/* -- random curves -- */

/* Numbers of edges by the length of the sides, times 0.7 to 1.3. Returns their sum. */
static int32_t gprojt_random_edges(gprojt_curve *c, double length, uint64_t *state) {
    int32_t side, sum = 0;
    for (side = 0; side < c->corner_count; ++side) {
        double wanted = gprojt_curve_side(c, side) / length * (0.7 + 0.6 * gprojt_uniform(state));
        c->edges[side] = wanted < 1 ? 1 : (int32_t)(wanted + 0.5);
        sum += c->edges[side];
    }
    c->given = true;
    return sum;
}

/* An odd sum is refused, with the number that one side should have. Makes it so. */
static bool gprojt_parity_is_refused(gprojt_curve *c) {
    gproj_error error;
    gproj_mesh *mesh = gprojt_fill(c, NULL, &error);
    int32_t side;
    for (side = 0; side < c->corner_count && c->corner[side] != error.index; ++side) continue;
    if (mesh || error.code != GPROJ_ERROR_ARGUMENT || side == c->corner_count ||
        !strstr(error.message, "quads need an even number; give side ")) {
        gproj_mesh_destroy(mesh);
        return false;
    }
    c->edges[side] = atoi(strstr(strstr(error.message, "give side ") + 10, " ") + 1);
    return true;
}

/* Fills `wanted` random curves. Counts those with valence 6. */
static int32_t gprojt_fill_random(int32_t wanted, int32_t fewest, int32_t most, double length, uint64_t seed) {
    int32_t filled = 0, odd = 0, six = 0, tries;
    uint64_t state = seed;
    for (tries = 0; filled < wanted; ++tries) {
        gprojt_curve c = gprojt_random_curve(&state, fewest + gprojt_below(&state, most - fewest + 1), tries % 3);
        gproj_fill_info info;
        gproj_error error;
        gproj_mesh *mesh;
        bool is_odd = tries % 2 && gprojt_random_edges(&c, length, &state) % 2;
        c.options.edge_length = length;
        mesh = gprojt_fill(&c, &info, &error);
        if (!mesh && strstr(error.message, "meets itself")) continue;
        GPROJT_CHECK((mesh == NULL) == is_odd);
        if (!mesh) {
            ++odd;
            GPROJT_CHECK(gprojt_parity_is_refused(&c));
            mesh = gprojt_fill(&c, &info, &error);
        }
        if (!mesh && strstr(error.message, "with so few edges")) continue;
        if (!mesh) printf("    try %d: %s\n", (int)tries, error.message);
        GPROJT_CHECK(mesh && gprojt_filling_is_good(&c, mesh, &info, 6));
        six += mesh && info.max_valence > 5;
        ++filled;
        gproj_mesh_destroy(mesh);
    }
    GPROJT_CHECK(odd > wanted / 10);
    return six;
}

GPROJT_TEST(random_curves) {
    GPROJT_CHECK(gprojt_fill_random(200, 3, 6, 1.5, 1) == 0);
    GPROJT_CHECK(gprojt_fill_random(60, 2, 6, 4, 2) == 0);
    GPROJT_CHECK(gprojt_fill_random(20, 2, 6, 0.7, 3) == 0);
}

GPROJT_TEST(random_curves_with_many_corners) {
    GPROJT_CHECK(gprojt_fill_random(40, 7, 12, 1.2, 4) == 0);
    GPROJT_CHECK(gprojt_fill_random(40, 7, 12, 3, 5) <= 4);
}

/* A curve that is turned in the plane is filled by the same mesh, turned. */
GPROJT_TEST(fillings_turn_with_their_curves) {
    uint64_t state = 5;
    int32_t filled = 0, tries, i;
    for (tries = 0; tries < 60; ++tries) {
        gprojt_curve c = gprojt_random_curve(&state, 3 + gprojt_below(&state, 6), tries % 3), turned;
        double sine = sin(0.7 + tries), cosine = cos(0.7 + tries), off = 0;
        gproj_mesh *mesh, *other;
        c.options.edge_length = 0.7 + 3 * gprojt_uniform(&state);
        turned = c;
        for (i = 0; i < c.count; ++i) {
            turned.point[3 * i] = cosine * c.point[3 * i] - sine * c.point[3 * i + 1];
            turned.point[3 * i + 1] = sine * c.point[3 * i] + cosine * c.point[3 * i + 1];
        }
        mesh = gprojt_fill(&c, NULL, NULL), other = gprojt_fill(&turned, NULL, NULL);
        GPROJT_REQUIRE((mesh != NULL) == (other != NULL));
        if (!mesh) continue;
        GPROJT_REQUIRE(mesh->vertex_count == other->vertex_count);
        for (i = 0; i < mesh->vertex_count; ++i) {
            const double *p = mesh->position + 3 * i;
            double q[3];
            q[0] = cosine * p[0] - sine * p[1], q[1] = sine * p[0] + cosine * p[1], q[2] = p[2];
            off = fmax(off, gprojt_far(q, other->position + 3 * i));
        }
        GPROJT_NEAR(off, 0, 1e-9);
        ++filled;
        gproj_mesh_destroy(mesh), gproj_mesh_destroy(other);
    }
    GPROJT_CHECK(filled > 30);
}

/* -- any numbers of edges -- */

GPROJT_TEST(any_numbers_of_edges) {
    static const int32_t most[] = {0, 0, 8, 6, 4, 3, 3};
    int32_t sides, i;
    for (sides = 2; sides <= 6; ++sides) {
        gprojt_curve c = gprojt_rose(sides, 6, sides == 2 ? 0.7 : 0.1);
        c.given = true;
        for (i = 0; i < sides; ++i) c.edges[i] = 1;
        do {
            gproj_fill_info info;
            gproj_error error;
            int32_t sum = 0;
            gproj_mesh *mesh = gprojt_fill(&c, &info, &error);
            for (i = 0; i < sides; ++i) sum += c.edges[i];
            GPROJT_CHECK((mesh != NULL) == (sum % 2 == 0 && sum >= 4) || strstr(error.message, "meets itself"));
            if (mesh) GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
            gproj_mesh_destroy(mesh);
            for (i = 0; i < sides && ++c.edges[i] > most[sides]; ++i) c.edges[i] = 1;
        } while (i < sides);
    }
}

/* Numbers that no one would choose, also longer than all other sides together. */
GPROJT_TEST(odd_numbers_of_edges) {
    static const int32_t edges[][6] = {
        {60, 2},      {30, 4},          {12, 3, 3},       {40, 1, 5},          {25, 3, 4, 6},           {2, 30, 4, 8},
        {9, 9, 1, 1}, {30, 2, 3, 4, 5}, {3, 3, 20, 3, 3}, {30, 1, 2, 3, 4, 4}, {10, 20, 30, 20, 10, 30}};
    static const int32_t sides[] = {2, 2, 3, 3, 4, 4, 4, 5, 5, 6, 6};
    int32_t i;
    for (i = 0; i < 11; ++i) {
        gprojt_curve c = gprojt_rose(sides[i], 12, sides[i] == 2 ? 0.7 : 0.1);
        gproj_fill_info info;
        gproj_error error;
        gproj_mesh *mesh;
        memcpy(c.edges, edges[i], sizeof edges[i]);
        c.given = true;
        mesh = gprojt_fill(&c, &info, &error);
        if (!mesh) puts(error.message);
        GPROJT_CHECK(mesh && gprojt_filling_is_good(&c, mesh, &info, 5));
        gproj_mesh_destroy(mesh);
    }
}

/* -- shapes whose best mesh is known -- */

GPROJT_TEST(right_angles_give_grids) {
    static const double L[] = {0, 0, 6, 0, 6, 3, 3, 3, 3, 6, 0, 6};
    static const double T[] = {0, 0, 9, 0, 9, 3, 6, 3, 6, 8, 3, 8, 3, 3, 0, 3};
    static const double U[] = {0, 0, 9, 0, 9, 9, 6, 9, 6, 3, 3, 3, 3, 9, 0, 9};
    static const double plus[] = {3, 0, 6, 0, 6, 3, 9, 3, 9, 6, 6, 6, 6, 9, 3, 9, 3, 6, 0, 6, 0, 3, 3, 3};
    static const double box[] = {0, 0, 8, 0, 8, 3, 0, 3};
    static const double *const shape[] = {L, T, U, plus, box};
    static const int32_t corners[] = {6, 8, 8, 12, 4};
    static const double area[] = {27, 42, 63, 45, 24};
    int32_t i, v;
    for (i = 0; i < 5; ++i) {
        gprojt_curve c = gprojt_polygon(corners[i], shape[i]);
        gproj_fill_info info;
        gproj_mesh *mesh;
        c.options.edge_length = 0.5;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 4));
        GPROJT_CHECK(info.irregular_count == 0 && info.side_count == corners[i]);
        GPROJT_CHECK(mesh->face_count == (int32_t)(4 * area[i] + 0.5));
        for (v = 0; v < 3 * mesh->vertex_count; ++v) /* every vertex is at its place of the grid */
            GPROJT_NEAR(mesh->position[v], 0.5 * floor(2 * mesh->position[v] + 0.5), 1e-5);
        gproj_mesh_destroy(mesh);
    }
}

/* n edges on all sides of a regular polygon: one irregular vertex where it can be, in 6 sides two of valence 5. */
GPROJT_TEST(regular_polygons) {
    static const int32_t irregular[] = {0, 0, 2, 1, 0, 1, 2}, valence[] = {0, 0, 3, 3, 4, 5, 5};
    int32_t sides, i, v;
    for (sides = 2; sides <= 6; ++sides) {
        gprojt_curve c = gprojt_rose(sides, 12, sides == 2 ? 0.7 : 0);
        gproj_fill_info info;
        gproj_mesh *mesh;
        for (i = 0; i < sides; ++i) c.edges[i] = 8;
        c.given = true;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
        GPROJT_CHECK(info.irregular_count == irregular[sides] && info.patch_count == 1);
        GPROJT_CHECK(info.min_angle > 40 && info.max_angle < 140);
        for (v = info.boundary_count; v < mesh->vertex_count; ++v) {
            i = gproj_mesh_valence(mesh, v);
            GPROJT_CHECK(i == 4 || i == valence[sides]);
            if (i != 4 && sides % 2) /* the only one is in the middle */
                GPROJT_CHECK(fabs(mesh->position[3 * v]) + fabs(mesh->position[3 * v + 1]) < 1e-3);
        }
        gproj_mesh_destroy(mesh);
    }
}

/* -- corners and sides -- */

GPROJT_TEST(curves_without_corners) {
    int32_t corners;
    for (corners = 0; corners <= 6; ++corners) {
        gprojt_curve c;
        gproj_fill_info info;
        gproj_mesh *mesh;
        int32_t i;
        memset(&c, 0, sizeof c);
        for (i = 0; i < 120; ++i) {
            double t = 6.283185307179586 * i / 120, r = corners == 1 ? 2 * fabs(sin(0.5 * t)) + 0.2 : 2;
            gprojt_add_point(&c, r * cos(t), r * sin(t), 0);
        }
        for (i = 0; i < corners; ++i) c.corner[c.corner_count++] = 120 * i / corners;
        c.marked = corners > 1;
        c.options.edge_length = 0.3;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
        GPROJT_CHECK(info.side_count == (corners > 1 ? corners : 4));
        if (corners == 0) GPROJT_CHECK(info.irregular_count == 4);
        GPROJT_CHECK(info.min_angle > 25 && info.max_angle < 155);
        for (i = 0; i < info.boundary_count && corners != 1; ++i) GPROJT_CHECK(gproj_mesh_valence(mesh, i) >= 3);
        gproj_mesh_destroy(mesh);
    }
}

/* Half a circle, with corners marked on the arc: these get two faces, those at the ends of the diameter one. */
static gprojt_curve gprojt_half_disc(void) {
    gprojt_curve c;
    int32_t i;
    memset(&c, 0, sizeof c);
    for (i = 0; i < 91; ++i) gprojt_add_point(&c, cos(3.141592653589793 * i / 90), sin(3.141592653589793 * i / 90), 0);
    for (i = 0; i < 4; ++i) c.corner[c.corner_count++] = 30 * i;
    c.marked = c.given = true;
    return c;
}

GPROJT_TEST(corners_that_are_flat) {
    gprojt_curve c = gprojt_half_disc();
    gproj_fill_info info;
    gproj_mesh *mesh;
    c.edges[0] = c.edges[2] = 6, c.edges[1] = 8, c.edges[3] = 10;
    mesh = gprojt_fill(&c, &info, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 4));
    GPROJT_CHECK(info.irregular_count == 2);
    GPROJT_CHECK(gproj_mesh_valence(mesh, 0) == 2 && gproj_mesh_valence(mesh, 6) == 3);
    gproj_mesh_destroy(mesh);
}

/* Rectangles with corners amid their sides, which strips cover up to the other side: unit squares fill them. */
GPROJT_TEST(strips_over_flat_corners_may_be_all) {
    static const double one[] = {0, 0, 1, 0, 2, 0, 2, 1, 0, 1}, two[] = {0, 0, 1, 0, 2, 0, 2, 2, 1, 2, 0, 2},
                        three[] = {0, 0, 1, 0, 2, 0, 3, 0, 3, 1, 0, 1};
    static const int32_t edges[3][6] = {{1, 1, 1, 2, 1}, {1, 1, 2, 1, 1, 2}, {1, 1, 1, 1, 3, 1}}, faces[3] = {2, 4, 3};
    int32_t i, k;
    for (i = 0; i < 3; ++i) {
        gprojt_curve c = gprojt_polygon(i == 0 ? 5 : 6, i == 0 ? one : i == 1 ? two : three);
        gproj_fill_info info;
        gproj_mesh *mesh;
        c.marked = c.given = true, c.corner_count = c.count;
        for (k = 0; k < c.count; ++k) c.corner[k] = k, c.edges[k] = edges[i][k];
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 4));
        GPROJT_CHECK(mesh->face_count == faces[i] && info.irregular_count == 0);
        GPROJT_NEAR(info.min_angle, 90, 1e-9);
        GPROJT_NEAR(info.max_angle, 90, 1e-9);
        gproj_mesh_destroy(mesh);
    }
}

/* Numbers that are chosen leave a grid inside the strip over them: the diameter has two more than the arc opposite. With
   rings there is no strip, and opposite sides have equal numbers. */
GPROJT_TEST(numbers_allow_for_strips) {
    int32_t rings;
    for (rings = 0; rings < 2; ++rings) {
        gprojt_curve c = gprojt_half_disc();
        gproj_fill_info info;
        gproj_mesh *mesh;
        c.corner[1] = 20, c.corner[2] = 70, c.given = false;
        c.options.edge_length = 0.2, c.options.rings = rings;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, rings ? 5 : 4));
        GPROJT_CHECK(info.irregular_count == (rings ? 4 : 2));
        gproj_mesh_destroy(mesh);
    }
}

GPROJT_TEST(points_of_the_curve_are_kept) {
    gprojt_curve c = gprojt_rose(4, 9, 0.2);
    gproj_fill_info info;
    gproj_error error;
    gproj_mesh *mesh;
    c.options.keep_points = true;
    mesh = gprojt_fill(&c, &info, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 4));
    GPROJT_CHECK(info.boundary_count == c.count);
    GPROJT_CHECK(memcmp(mesh->position, c.point, 3 * (size_t)c.count * sizeof(double)) == 0);
    gproj_mesh_destroy(mesh);
    --c.count;
    mesh = gprojt_fill(&c, &info, &error);
    GPROJT_CHECK(gprojt_mesh_was_refused(mesh, &error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, error.index,
                                         "35 edges together, but quads need an even number; give side "));
    GPROJT_CHECK(strstr(error.message, "(add or leave out a point)"));
}

/* All edges of a side are of equal length along the curve. */
GPROJT_TEST(sides_are_divided_evenly) {
    gprojt_curve c = gprojt_rose(3, 30, 0.15);
    gproj_mesh *mesh;
    int32_t side, i;
    c.options.edge_length = 0.8;
    mesh = gprojt_fill(&c, NULL, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    for (side = 0; side < 3; ++side) {
        const int32_t *line = mesh->polyline_vertex + mesh->polyline_start[side];
        int32_t edges = mesh->polyline_start[side + 1] - mesh->polyline_start[side] - 1;
        double length = gprojt_curve_side(&c, side);
        GPROJT_CHECK(fabs(length / edges - 0.8) < 0.1);
        for (i = 0; i < edges; ++i)
            GPROJT_NEAR(gprojt_far(mesh->position + 3 * line[i], mesh->position + 3 * line[i + 1]), length / edges,
                        5e-3);
    }
    gproj_mesh_destroy(mesh);
}

/* Edges longer than all of a lens or a triangle: 4 quad edges nevertheless, the fewest that there can be; 3 are no number
   that quads can have. */
GPROJT_TEST(four_edges_at_least) {
    int32_t sides;
    for (sides = 2; sides <= 3; ++sides) {
        gprojt_curve c = gprojt_rose(sides, 6, sides == 2 ? 0.7 : 0.1);
        gproj_fill_info info;
        gproj_mesh *mesh;
        c.options.edge_length = 100;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
        GPROJT_CHECK(info.boundary_count == 4 && info.side_count == sides);
        gproj_mesh_destroy(mesh);
    }
}

/* Rings run along the whole boundary, also past corners and where the inside is cut. */
GPROJT_TEST(rings) {
    static const double L[] = {0, 0, 6, 0, 6, 3, 3, 3, 3, 6, 0, 6};
    int32_t i, k, shape;
    for (shape = 0; shape < 2; ++shape) {
        gprojt_curve c = shape ? gprojt_polygon(6, L) : gprojt_rose(4, 12, 0.2);
        gproj_fill_info info;
        gproj_mesh *mesh;
        c.options.edge_length = 0.6;
        c.options.rings = 3;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
        GPROJT_CHECK(info.irregular_count == (shape ? 6 : 4)); /* 3 at each corner, 5 where the L is reflex */
        for (i = 0; i < info.boundary_count; ++i) /* one edge leads inside from each vertex, and on to the next ring */
            for (k = 0; k < 3; ++k) {
                int32_t v = k * info.boundary_count + i, ring[6], n = gproj_mesh_one_ring(mesh, v, ring, 6), next = 0;
                GPROJT_CHECK(n == (k == 0 ? 3 : 4));
                while (next < n && ring[next] != v + info.boundary_count) ++next;
                GPROJT_CHECK(next < n);
            }
        gproj_mesh_destroy(mesh);
    }
}

/* A quad alone has no choice; where it would be bent inwards, another mesh of the same boundary is taken. */
GPROJT_TEST(single_quads) {
    static const double flat[] = {0, 0, 4, 0, 5, 4, 0, 3}, bent[] = {0, 0, 4, 0, 1, 1, 0, 4};
    static const int32_t corner[] = {0, 1, 3};
    gprojt_curve c = gprojt_polygon(4, flat);
    gproj_fill_info info;
    gproj_mesh *mesh;
    c.options.keep_points = true;
    mesh = gprojt_fill(&c, &info, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    GPROJT_CHECK(mesh->face_count == 1 && info.irregular_count == 0 && info.max_valence == 0);
    gproj_mesh_destroy(mesh);
    c = gprojt_polygon(4, bent);
    c.options.keep_points = true;
    memcpy(c.corner, corner, sizeof corner);
    c.corner_count = 3, c.marked = true;
    mesh = gprojt_fill(&c, &info, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
    GPROJT_CHECK(mesh->face_count == 5 && info.irregular_count == 4); /* a cube without one of its faces */
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(variants_differ) {
    gprojt_curve c = gprojt_rose(5, 12, 0.1);
    int32_t i, k, faces[3], irregular[3];
    gproj_mesh *mesh;
    for (i = 0; i < 5; ++i) c.edges[i] = 6 + 2 * (i == 2) + 2 * (i == 3);
    c.given = true;
    for (k = 0; k < 3; ++k) {
        gproj_fill_info info;
        c.options.variant = k;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
        faces[k] = mesh->face_count, irregular[k] = info.irregular_count;
        gproj_mesh_destroy(mesh);
    }
    GPROJT_CHECK(irregular[0] == 1 && irregular[1] >= irregular[0] && irregular[2] >= irregular[1]);
    GPROJT_CHECK(faces[0] != faces[1] || irregular[0] != irregular[1]);
    for (i = 0; i < 3; ++i) { /* the last one that there is, also where the next number would not be one */
        static const int32_t beyond[3] = {1000000, INT32_MAX - 2, INT32_MAX};
        gproj_fill_info info;
        c.options.variant = beyond[i];
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        if (i == 0) faces[0] = mesh->face_count, irregular[0] = info.irregular_count;
        GPROJT_CHECK(mesh->face_count == faces[0] && info.irregular_count == irregular[0]);
        gproj_mesh_destroy(mesh);
    }
}

/* Six edges around a point are among the patterns of a hexagon, and in no filling. */
GPROJT_TEST(hexagons_have_no_vertex_of_valence_6) {
    gprojt_curve c = gprojt_rose(6, 12, 0);
    int32_t i;
    for (i = 0; i < 6; ++i) c.edges[i] = 4;
    c.given = true;
    for (i = 0; i < 20; ++i) {
        gproj_fill_info info;
        gproj_mesh *mesh;
        c.options.variant = i < 19 ? i : 1000;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
        gproj_mesh_destroy(mesh);
    }
}

/* More corners than a patch has: the polygon is cut, though none of them is reflex. */
GPROJT_TEST(many_convex_corners_are_cut) {
    int32_t corners, i;
    for (corners = 7; corners <= 12; ++corners) {
        gprojt_curve c = gprojt_rose(corners, 12, 0);
        gproj_fill_info info;
        gproj_mesh *mesh;
        for (i = 0; i < corners; ++i) c.edges[i] = 6;
        c.given = true;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 5));
        GPROJT_CHECK(info.patch_count > 1);
        gproj_mesh_destroy(mesh);
    }
}

/* A corner that is marked whose angle is that of a side or sharper, ends that are no corners, tips that nearly touch a cut:
   curves that are cut seldom well, or cannot be. */
GPROJT_TEST(awkward_curves) {
    static const struct {
        int32_t points, corners, corner[10];
        bool keeps;
        double xy[32];
    } curve[] = {
        /* the straight way between two tips passes a third one at 1e-9 */
        {10, 10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, true, {-1,  0, 0, -1,   1,    0, 4,  -2, 4,  4,
                                                        0.5, 4, 0, 1e-9, -0.5, 4, -4, 4,  -4, -2}},
        /* a tip of 2 degrees, which no cut may halve */
        {4, 4, {0, 1, 2, 3}, true, {0, 0, 10, -0.2, 9, 0, 10, 0.2}},
        /* 8 corners, all cuts between which are too sharp */
        {8,
         8,
         {0, 1, 2, 3, 4, 5, 6, 7},
         true,
         {100, 0, 0, 1, -0.01, 0.7, -0.02, 0.3, -0.02, 0, -0.02, -0.3, -0.01, -0.7, 0, -1}},
        /* two corners on one side of the cut; on the other one, or none */
        {8,
         2,
         {0, 6},
         false,
         {0.979, 0.549, 0.351, 1.013, -0.109, 0.657, -1.443, 0.258, -0.721, -0.093, -1.245, -2.055, 0.061, -0.518,
          1.265, -0.859}},
        {15, 4, {3, 6, 7, 10}, false, {1.683,  0.355,  0.546,  0.410,  0.657,  1.456,  0.219,  0.834,  -0.131, 0.458,
                                       -0.459, 0.642,  -0.891, 0.452,  -1.100, 0.220,  -0.446, -0.095, -1.409, -1.848,
                                       -0.170, -0.408, 0.115,  -0.682, 1.033,  -1.737, 0.401,  -0.344, 1.835,  -0.379}},
        /* corners that turn back over more than 300 steps */
        {12, 6, {0, 3, 6, 7, 8, 10}, true, {1.67,  0.12,  0.28,  0.30,  0.22,  1.95,  -0.04, 0.47,
                                            -1.11, 1.05,  -0.75, 0.13,  -0.89, -0.12, -1.01, -1.26,
                                            -0.24, -0.64, 0.42,  -1.11, 0.32,  -0.29, 1.93,  -0.79}},
        /* the cheapest way between two corners crosses a tip whose sides are longer than it */
        {10, 8, {1, 2, 3, 4, 5, 6, 7, 8}, true, {5,   0,  12,  9,  0,  4,   -8, 17,  -3, 1,
                                                 -17, -5, -14, -9, -8, -17, 1,  -11, 12, -14}},
    };
    int32_t i;
    for (i = 0; i < (int32_t)(sizeof curve / sizeof *curve); ++i) {
        gprojt_curve c = gprojt_polygon(curve[i].points, curve[i].xy);
        gproj_fill_info info;
        gproj_error error;
        gproj_mesh *mesh;
        memcpy(c.corner, curve[i].corner, sizeof curve[i].corner);
        c.corner_count = curve[i].corners, c.marked = true, c.options.keep_points = curve[i].keeps;
        mesh = gprojt_fill(&c, &info, &error);
        if (!mesh) printf("    curve %d: %s\n", (int)i, error.message);
        GPROJT_CHECK(mesh && gprojt_filling_is_good(&c, mesh, &info, 6));
        gproj_mesh_destroy(mesh);
    }
}

/* Wherever the second corner of a curve with a dent is, also in parts that have no corner. */
GPROJT_TEST(dents_with_a_corner_anywhere) {
    int32_t i, k;
    for (k = 2; k < 60; k += 19) {
        gprojt_curve c;
        gproj_fill_info info;
        gproj_mesh *mesh;
        memset(&c, 0, sizeof c);
        for (i = 0; i < 60; ++i) {
            double t = 6.283185307179586 * i / 60, r = 2 * fabs(sin(t / 2)) + 0.2;
            gprojt_add_point(&c, r * cos(t), r * sin(t), 0);
        }
        c.corner[1] = k, c.corner_count = 2, c.marked = true;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_CHECK(mesh && gprojt_filling_is_good(&c, mesh, &info, 5));
        GPROJT_CHECK(info.patch_count == 2);
        gproj_mesh_destroy(mesh);
    }
}

/* Opposite sides about as long as each other get equal numbers of edges, so that a grid fits between them. */
GPROJT_TEST(opposite_sides_get_equal_numbers) {
    static const double wide[] = {0, 0, 10, 0, 8.5, 6, 1.5, 6}, steep[] = {0, 0, 20, 0, 15, 6, 5, 6};
    int32_t k, turn, i, count[4];
    for (k = 0; k < 2; ++k)
        for (turn = 0; turn < 4; ++turn) {
            double xy[8];
            gprojt_curve c;
            gproj_fill_info info;
            gproj_mesh *mesh;
            for (i = 0; i < 8; ++i) xy[i] = (k ? steep : wide)[(i + 2 * turn) % 8];
            c = gprojt_polygon(4, xy);
            c.options.edge_length = 1;
            mesh = gprojt_fill(&c, &info, NULL);
            GPROJT_REQUIRE(mesh && mesh->polyline_count == 4);
            for (i = 0; i < 4; ++i) count[i] = mesh->polyline_start[i + 1] - mesh->polyline_start[i] - 1;
            GPROJT_CHECK(count[turn % 2 + 1] == count[(turn % 2 + 3) % 4]);     /* the legs */
            GPROJT_CHECK((count[turn % 2] == count[turn % 2 + 2]) == (k == 0)); /* 10 and 7; 20 and 10 */
            GPROJT_CHECK(k || (count[turn % 2] >= 8 && count[turn % 2] <= 9));
            GPROJT_CHECK(k || info.irregular_count == 0);
            for (i = 0; i < 4; ++i) GPROJT_CHECK(k == 0 || fabs(count[i] - gprojt_curve_length(&c, i, i + 1)) <= 1);
            gproj_mesh_destroy(mesh);
        }
}

/* Of all sides with one edge more or less, the one is named whose edges are then nearest to the wanted length. */
GPROJT_TEST(the_best_change_is_named) {
    uint64_t state = 3;
    int32_t tries, less = 0, odd = 0;
    for (tries = 0; tries < 200; ++tries) {
        gprojt_curve c = gprojt_random_curve(&state, 3 + gprojt_below(&state, 4), 0);
        gproj_error error;
        gproj_mesh *mesh;
        int32_t side, by, named = -1, to = 0, given;
        double best = HUGE_VAL, off, named_off = HUGE_VAL;
        c.options.edge_length = 2;
        if (gprojt_random_edges(&c, 2, &state) % 2 == 0) continue;
        mesh = gprojt_fill(&c, NULL, &error);
        GPROJT_CHECK(mesh == NULL);
        gproj_mesh_destroy(mesh);
        if (strstr(error.message, "meets itself")) continue;
        GPROJT_REQUIRE(strstr(error.message, "give side "));
        GPROJT_CHECK(sscanf(strstr(error.message, "give side "), "give side %d %d edges instead of %d", &named, &to,
                            &given) == 3);
        GPROJT_REQUIRE(named >= 0 && named < c.corner_count);
        GPROJT_CHECK(given == c.edges[named] && abs(to - given) == 1 && error.index == c.corner[named]);
        for (side = 0; side < c.corner_count; ++side)
            for (by = -1; by <= 1; by += 2) {
                if (c.edges[side] + by < 1) continue;
                off = fabs(log((c.edges[side] + by) * 2 / gprojt_curve_side(&c, side)));
                best = fmin(best, off);
                if (side == named && c.edges[side] + by == to) named_off = off;
            }
        GPROJT_NEAR(named_off, best, 1e-12);
        less += to < given, ++odd;
    }
    GPROJT_CHECK(less > odd / 5 && less < odd);
}

/* -- in space -- */

/* A curve over another plane than z = 0, in another unit: the same mesh, moved. */
GPROJT_TEST(anywhere_in_space) {
    uint64_t state = 12;
    gprojt_curve c = gprojt_random_curve(&state, 5, 1), moved = c;
    gproj_fill_info info;
    gproj_mesh *a, *b;
    double scale = 1e4, worst = 0;
    int32_t i, k;
    for (i = 0; i < c.count; ++i) c.point[3 * i + 2] = 0.3 * sin(0.2 * i);
    for (i = 0; i < c.count; ++i) { /* a half turn about the diagonal x = z takes (x, y, z) to (z, -y, x) */
        moved.point[3 * i] = scale * c.point[3 * i + 2] + 5, moved.point[3 * i + 1] = -scale * c.point[3 * i + 1];
        moved.point[3 * i + 2] = scale * c.point[3 * i] - 7;
    }
    a = gprojt_fill(&c, NULL, NULL), b = gprojt_fill(&moved, &info, NULL);
    GPROJT_REQUIRE(a && b);
    GPROJT_REQUIRE(a->vertex_count == b->vertex_count && a->face_count == b->face_count);
    GPROJT_CHECK(memcmp(a->origin, b->origin, (size_t)a->halfedge_count * sizeof(int32_t)) == 0);
    for (i = 0; i < a->vertex_count; ++i) {
        const double *p = a->position + 3 * i, *q = b->position + 3 * i;
        double m[3];
        m[0] = (q[2] + 7) / scale, m[1] = -q[1] / scale, m[2] = (q[0] - 5) / scale;
        for (k = 0; k < 3; ++k) worst = fmax(worst, fabs(m[k] - p[k]));
    }
    GPROJT_CHECK(worst < 1e-3); /* as far as the last steps are small */
    GPROJT_CHECK(gprojt_boundary_distance(&moved, b, info.boundary_count) <= 1e-14 * 15 * scale);
    gproj_mesh_destroy(a);
    gproj_mesh_destroy(b);
}

/* Heights inside are means of those around: between those of the curve, and linear where these are. */
GPROJT_TEST(heights_are_harmonic) {
    gprojt_curve c = gprojt_rose(4, 12, 0.2);
    gproj_mesh *mesh;
    int32_t i, k, ring[8];
    for (i = 0; i < c.count; ++i) c.point[3 * i + 2] = 0.4 * sin(12.566370614359172 * i / c.count);
    c.options.edge_length = 0.7;
    mesh = gprojt_fill(&c, NULL, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    GPROJT_CHECK(gprojt_least_sine(&c, mesh) > 0.3);
    for (i = 0; i < mesh->vertex_count; ++i) {
        int32_t valence = gproj_mesh_one_ring(mesh, i, ring, 8);
        double mean = 0;
        if (gproj_mesh_is_boundary_vertex(mesh, i)) continue;
        for (k = 0; k < valence; ++k) mean += mesh->position[3 * ring[k] + 2] / valence;
        GPROJT_NEAR(mesh->position[3 * i + 2], mean, 1e-12);
    }
    gproj_mesh_destroy(mesh);
}

/* Also that of a single vertex inside. */
GPROJT_TEST(a_single_height_is_harmonic) {
    gprojt_curve c = gprojt_rose(4, 2, 0.1);
    gproj_fill_info info;
    gproj_mesh *mesh;
    int32_t i;
    for (i = 0; i < 4; ++i) c.edges[i] = 2, c.point[6 * i + 5] = 1; /* amid each side */
    c.given = true;
    mesh = gprojt_fill(&c, &info, NULL);
    GPROJT_REQUIRE(mesh && mesh->vertex_count == 9 && info.boundary_count == 8);
    GPROJT_NEAR(mesh->position[3 * 8 + 2], 1, 1e-14);
    gproj_mesh_destroy(mesh);
}

/* A clockwise curve gives faces that look down. */
GPROJT_TEST(orientation_is_that_of_the_curve) {
    static const double xy[] = {0, 0, 0, 2, 3, 2, 3, 0};
    gprojt_curve c = gprojt_polygon(4, xy);
    gproj_fill_info info;
    gproj_mesh *mesh;
    double area[3];
    int32_t f;
    c.options.edge_length = 0.5;
    mesh = gprojt_fill(&c, &info, NULL);
    GPROJT_REQUIRE(mesh != NULL);
    for (f = 0; f < mesh->face_count; ++f) {
        gproj_mesh_face_area_vector(mesh, f, area);
        GPROJT_NEAR(area[2], -0.25, 1e-6);
    }
    GPROJT_CHECK(gprojt_boundary_is_first(mesh, info.boundary_count));
    gproj_mesh_destroy(mesh);
}

/* -- what is refused -- */

static bool gprojt_is_refused(const gprojt_curve *c, gproj_code code, gproj_place place, int64_t index,
                              const char *piece) {
    gproj_error error;
    gproj_fill_info info;
    gproj_mesh *mesh = gprojt_fill(c, &info, &error);
    bool right = gprojt_mesh_was_refused(mesh, &error, code, place, index, piece) && info.boundary_count == 0;
    gproj_mesh_destroy(mesh);
    return right;
}

GPROJT_TEST(refusals_of_curves) {
    static const double eight[] = {0, 0, 4, 4, 4, 0, 0, 3}, back[] = {0, 0, 4, 0, 8, 0, 6, 0, 6, 3};
    static const double deep[] = {0, 0, 2, -2, 4, 0, 4, 2, 2, -1, 0, 2};
    static const int32_t deep_corner[] = {0, 2, 3, 5}, deep_edges[] = {1, 1, 2, 2};
    static const double touch[] = {0, 0, 4, 0, 4, 4, 2, 0, 0, 4}, line[] = {0, 0, 1, 1, 2, 2};
    static const double thin[] = {0, 0, 10, -3e-6, 4, -5e-7, 10, 3e-6};
    gprojt_curve c = gprojt_polygon(4, eight);
    gproj_fill_info info;
    gproj_error error;
    gproj_mesh *mesh;
    int32_t i, k;
    GPROJT_CHECK(
        gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, 0, "after point 0 and after point 2"));
    c = gprojt_polygon(5, back);
    GPROJT_CHECK(
        gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, 1, "after point 1 and after point 2"));
    c = gprojt_polygon(5, touch);
    GPROJT_CHECK(
        gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, 0, "after point 0 and after point 2"));
    c = gprojt_polygon(3, line);
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_NONE, -1, "encloses no area"));
    c = gprojt_rose(4, 3, 0); /* an area that no double could hold the square of */
    for (i = 0; i < 3 * c.count; ++i) c.point[i] *= 1e-77;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_NONE, -1, "encloses no area"));
    c = gprojt_polygon(6, deep); /* the top comes down below where the bottom's one edge is */
    memcpy(c.corner, deep_corner, sizeof deep_corner), memcpy(c.edges, deep_edges, sizeof deep_edges);
    c.corner_count = 4, c.marked = c.given = true;
    GPROJT_CHECK(
        gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, 0, "with so few edges side 0 meets side 2"));
    for (k = 0; k < 4; ++k) { /* whichever side comes first */
        gprojt_curve turned = c;
        char expected[80];
        for (i = 0; i < 6; ++i)
            memcpy(turned.point + 3 * i, c.point + 3 * ((i + deep_corner[k]) % 6), 3 * sizeof(double));
        for (i = 0; i < 4; ++i) {
            turned.corner[i] = (deep_corner[(i + k) % 4] - deep_corner[k] + 6) % 6;
            turned.edges[i] = deep_edges[(i + k) % 4];
        }
        snprintf(expected, sizeof expected, "with so few edges side %d meets side %d;", k % 2, k % 2 + 2);
        GPROJT_CHECK(
            gprojt_is_refused(&turned, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, turned.corner[k % 2], expected));
    }
    c.edges[0] = c.edges[3] = 2;
    c.edges[1] = 2;
    mesh = gprojt_fill(&c, &info, NULL);
    GPROJT_CHECK(mesh && gprojt_filling_is_good(&c, mesh, &info, 5));
    gproj_mesh_destroy(mesh);
    c = gprojt_polygon(4, thin); /* a millionth as thick as it is long, and bent */
    for (k = 0; k < 2; ++k) {
        c.options.variant = k ? INT32_MAX : 0;
        GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_NONE, -1, "no filling without a quad"));
    }
    c.count = 2;
    GPROJT_CHECK(
        gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "2 points; it needs at least 3 and"));
    c = gprojt_rose(4, 3, 0);
    memcpy(c.point + 15, c.point + 12, 3 * sizeof(double));
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, 4, "points 4 and 5"));
    c = gprojt_rose(4, 3, 0);
    gprojt_add_point(&c, c.point[0], c.point[1], c.point[2]);
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, 12, "closed without it"));
    c.point[7] = HUGE_VAL;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, 2, "coordinate y of point 2 is inf"));
    GPROJT_CHECK(gprojt_mesh_was_refused(gproj_mesh_fill(5, NULL, NULL, NULL, NULL, &error), &error,
                                         GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "NULL"));
}

GPROJT_TEST(refusals_of_options) {
    const gprojt_curve good = gprojt_rose(4, 3, 0.1);
    gprojt_curve c = good;
    int32_t i;
    c.corner[2] = 3;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, 3, "ascending order"));
    c.corner[2] = 12;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_INDEX, GPROJ_PLACE_VERTEX, 12, "the points are 0 to 11"));
    c = good, c.corner[0] = -1;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_INDEX, GPROJ_PLACE_VERTEX, -1, "corner 0 is point -1"));
    c = good, c.corner_count = 1;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "1 corners; give at least 2"));
    c = good, c.marked = false, c.options.corner_count = 3;
    GPROJT_CHECK(
        gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "3 corners in an array that is NULL"));
    c.options.corner_count = -1;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "-1 corners; give at least 2"));
    c = good, c.options.variant = -1;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "variant"));
    c = good, c.options.rings = -1;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "-1 rings"));
    c.options.rings = 1025;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "1025 rings; give 0 to 1024"));
    c = good, c.options.edge_length = -1;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1, "edge length is -1"));
    c.options.edge_length = INFINITY;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1, "edge length is inf"));
    c.options.edge_length = 1e-9;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_SIZE, GPROJ_PLACE_VERTEX, 3, "use longer edges"));
    c = good;
    c.given = true;
    for (i = 0; i < 4; ++i) c.edges[i] = 3;
    c.edges[1] = 0;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, 3, "side 1 is to have 0 edges"));
    c.edges[1] = INT32_MAX; /* and 3 before, whose sum is no int32_t */
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_SIZE, GPROJ_PLACE_VERTEX, 3, "up to side 1 have more than 16384"));
    c.edges[1] = 2;
    GPROJT_CHECK(
        gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, 3, "give side 1 3 edges instead of 2"));
    c.options.side_count = 3;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "but the curve has 4"));
    c = good, c.options.side_count = 4;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "4 sides by a NULL array"));
    c = gprojt_rose(2, 6, 0.7);
    c.edges[0] = c.edges[1] = 1;
    c.given = true;
    GPROJT_CHECK(gprojt_is_refused(&c, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, 0, "at least 4"));
}

/* -- what is told -- */

/* The angles at the quads' corners of a flat mesh, in degrees, from the sides' lengths by the law of cosines (none of 180
   or more occurs). */
GPROJT_TEST(angles_are_told) {
    uint64_t state = 12;
    int k;
    for (k = 0; k < 12; ++k) {
        gprojt_curve c = gprojt_random_curve(&state, 3 + k % 4, 0);
        gproj_fill_info info;
        double least = 180, most = 0;
        gproj_mesh *mesh;
        int32_t i, h;
        for (i = 0; i < c.count; ++i) c.point[3 * i + 2] = 0;
        mesh = gprojt_fill(&c, &info, NULL);
        if (!mesh) continue;
        for (h = 0; h < mesh->halfedge_count; ++h) {
            const double *a = mesh->position + 3 * mesh->origin[mesh->prev[h]],
                         *b = mesh->position + 3 * mesh->origin[h];
            const double *d = mesh->position + 3 * mesh->origin[mesh->next[h]];
            double p = gprojt_far(a, b), q = gprojt_far(b, d), r = gprojt_far(a, d), angle;
            if (mesh->face[h] < 0) continue;
            angle = acos(fmin(fmax((p * p + q * q - r * r) / (2 * p * q), -1), 1)) * 180 / acos(-1.0);
            least = fmin(least, angle), most = fmax(most, angle);
        }
        GPROJT_NEAR(info.min_angle, least, 1e-4);
        GPROJT_NEAR(info.max_angle, most, 1e-4);
        gproj_mesh_destroy(mesh);
    }
}

/* A long oval without corners gets four, wherever its points begin and however many of them are at the ends. */
GPROJT_TEST(ovals_have_four_sides) {
    const double pi = acos(-1.0);
    int32_t at_end, first, i;
    for (at_end = 6; at_end < 10; ++at_end)
        for (first = 0; first < 2 * at_end; ++first) {
            gprojt_curve c;
            gproj_fill_info info;
            gproj_mesh *mesh;
            memset(&c, 0, sizeof c);
            for (i = 0; i < 2 * at_end; ++i) {
                int32_t k = (i + first) % (2 * at_end);
                double angle = pi * (k % at_end) / (at_end - 1) + (k < at_end ? -pi / 2 : pi / 2);
                gprojt_add_point(&c, (k < at_end ? 50 : -50) + cos(angle), sin(angle), 0);
            }
            mesh = gprojt_fill(&c, &info, NULL);
            GPROJT_REQUIRE(mesh != NULL);
            GPROJT_CHECK(info.side_count == 4 && mesh->polyline_count == 4);
            gproj_mesh_destroy(mesh);
        }
}

/* Which corner comes first does not matter to what is found inside. */
GPROJT_TEST(any_side_may_be_first) {
    static const int32_t edges[3][6] = {{2, 6, 4, 5, 3}, {1, 3, 2, 6, 4}, {7, 2, 3, 1, 5}};
    int k, shift, i;
    for (k = 0; k < 3; ++k) {
        int32_t irregular = -1;
        for (shift = 0; shift < 5; ++shift) {
            gprojt_curve c = gprojt_rose(5, 4, 0);
            gproj_fill_info info;
            gproj_mesh *mesh;
            for (i = 0; i < 5; ++i) c.edges[i] = edges[k][(i + shift) % 5];
            c.given = true;
            mesh = gprojt_fill(&c, &info, NULL);
            GPROJT_REQUIRE(mesh != NULL);
            if (irregular < 0) irregular = info.irregular_count;
            GPROJT_CHECK(info.irregular_count == irregular);
            gproj_mesh_destroy(mesh);
        }
    }
}

/* Two of 1,500 random curves whose fillings are untangled only by steps that are shorter than Newton's. */
GPROJT_TEST(curves_that_need_short_steps) {
    uint64_t state = 5;
    int32_t tries, filled = 0;
    for (tries = 0; tries <= 1490; ++tries) {
        gprojt_curve c = gprojt_random_curve(&state, 2 + gprojt_below(&state, 8), tries % 3);
        gproj_fill_info info;
        gproj_mesh *mesh;
        if (tries != 1130 && tries != 1490) continue;
        c.options.edge_length = 0.7;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_CHECK(mesh && gprojt_filling_is_good(&c, mesh, &info, 6));
        gproj_mesh_destroy(mesh);
        ++filled;
    }
    GPROJT_CHECK(filled == 2);
}

/* Seven corners where nothing can be cut, because the curve is so thin that cuts would run along it: the one that turns
   least, 0 at first, becomes a place on a side, whichever is the first. */
GPROJT_TEST(the_flattest_corner_is_none) {
    int32_t shift, i, vertices = 0;
    for (shift = 0; shift < 7; ++shift) {
        gprojt_curve c = gprojt_rose(7, 1, 0);
        gproj_fill_info info;
        gproj_mesh *mesh;
        for (i = 0; i < 7; ++i) {
            double angle = 6.283185307179586 * ((i + shift) % 7) / 7 + 1.7;
            c.point[3 * i] = cos(angle), c.point[3 * i + 1] = 4e-4 * sin(angle), c.edges[i] = 2;
        }
        c.given = true;
        mesh = gprojt_fill(&c, &info, NULL);
        GPROJT_REQUIRE(mesh != NULL);
        GPROJT_CHECK(gprojt_filling_is_good(&c, mesh, &info, 6) && info.patch_count == 1);
        if (shift == 0) vertices = mesh->vertex_count;
        GPROJT_CHECK(mesh->vertex_count == vertices);
        gproj_mesh_destroy(mesh);
    }
}

/* Arms of a star that meet in next to nothing, and four edges for all of it: each filling has quads turned over. */
GPROJT_TEST(a_star_with_four_edges_is_none) {
    gprojt_curve c;
    gproj_fill_info info;
    gproj_error error;
    gproj_mesh *mesh;
    int32_t i;
    memset(&c, 0, sizeof c);
    for (i = 0; i < 6; ++i) {
        double angle = 6.283185307179586 * i / 6, r = i % 2 ? 5 : 0.2;
        gprojt_add_point(&c, r * cos(angle), r * sin(angle), 0);
    }
    c.marked = true, c.corner_count = 2, c.corner[0] = 1, c.corner[1] = 3;
    c.options.edge_length = 100;
    mesh = gprojt_fill(&c, &info, &error);
    GPROJT_CHECK(gprojt_mesh_was_refused(mesh, &error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_NONE, -1, "turned over"));
    c.corner_count = 3, c.corner[2] = 5; /* with the third arm's end it can be filled */
    mesh = gprojt_fill(&c, &info, &error);
    GPROJT_CHECK(mesh && gprojt_filling_is_good(&c, mesh, &info, 6));
    gproj_mesh_destroy(mesh);
}

/* -- memory -- */

static bool gprojt_fill_with(const gproj_host *host, void *user) {
    const gprojt_curve *c = (const gprojt_curve *)user;
    gproj_fill_options options = gprojt_options(c);
    gproj_error error;
    gproj_fill_info info, none;
    gproj_mesh *mesh;
    memset(&none, 0, sizeof none);
    memset(&info, 255, sizeof info);
    mesh = gproj_mesh_fill(c->count, c->point, &options, &info, host, &error);
    GPROJT_CHECK((mesh != NULL) == (memcmp(&info, &none, sizeof none) != 0));
    return gprojt_mesh_was_made(mesh, host, &error);
}

GPROJT_TEST(every_allocation_fails_once) {
    static const double L[] = {0, 0, 6, 0, 6, 3, 3, 3, 3, 6, 0, 6};
    static const double stairs[] = {0, 0, 6, 0, 6, 1, 5, 1, 5, 2, 4, 2, 4, 3, 3, 3, 3, 4, 2, 4, 2, 5, 1, 5, 1, 6, 0, 6};
    gprojt_curve c = gprojt_polygon(6, L);
    c.options.edge_length = 1.5;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c.options.edge_length = 0.75; /* longer lists, which grow elsewhere */
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c.options.edge_length = 1.2; /* along a cut */
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c.options.edge_length = 1.5, c.options.variant = 1; /* a second pattern, when one is found already */
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c = gprojt_rose(4, 8, 0.1); /* a pattern with rows */
    c.edges[0] = 14, c.edges[1] = 3, c.edges[2] = 2, c.edges[3] = 3;
    c.given = true;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c = gprojt_rose(3, 4, 0.1);
    c.edges[0] = 4, c.edges[1] = 2, c.edges[2] = 2;
    c.given = true;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c = gprojt_polygon(14, stairs); /* many corners, sides and cuts */
    c.options.edge_length = 1.3;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c = gprojt_polygon(6, L);
    c.options.edge_length = 1.5, c.options.rings = 2;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c = gprojt_half_disc(); /* a strip over flat corners */
    c.edges[0] = c.edges[1] = 4, c.edges[2] = 5, c.edges[3] = 3;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c.edges[0] = c.edges[2] = 3, c.edges[1] = 6, c.edges[3] = 8; /* with which the list of quads grows */
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
    c = gprojt_rose(12, 2, 0); /* a circle whose corners are found */
    c.marked = false;
    GPROJT_CHECK(gprojt_fail_every_allocation(gprojt_fill_with, &c) > 100);
}

int main(void) {
    GPROJT_RUN(random_curves);
    GPROJT_RUN(random_curves_with_many_corners);
    GPROJT_RUN(fillings_turn_with_their_curves);
    GPROJT_RUN(any_numbers_of_edges);
    GPROJT_RUN(odd_numbers_of_edges);
    GPROJT_RUN(right_angles_give_grids);
    GPROJT_RUN(regular_polygons);
    GPROJT_RUN(curves_without_corners);
    GPROJT_RUN(corners_that_are_flat);
    GPROJT_RUN(strips_over_flat_corners_may_be_all);
    GPROJT_RUN(numbers_allow_for_strips);
    GPROJT_RUN(points_of_the_curve_are_kept);
    GPROJT_RUN(sides_are_divided_evenly);
    GPROJT_RUN(four_edges_at_least);
    GPROJT_RUN(rings);
    GPROJT_RUN(single_quads);
    GPROJT_RUN(variants_differ);
    GPROJT_RUN(hexagons_have_no_vertex_of_valence_6);
    GPROJT_RUN(many_convex_corners_are_cut);
    GPROJT_RUN(awkward_curves);
    GPROJT_RUN(dents_with_a_corner_anywhere);
    GPROJT_RUN(opposite_sides_get_equal_numbers);
    GPROJT_RUN(the_best_change_is_named);
    GPROJT_RUN(anywhere_in_space);
    GPROJT_RUN(heights_are_harmonic);
    GPROJT_RUN(a_single_height_is_harmonic);
    GPROJT_RUN(orientation_is_that_of_the_curve);
    GPROJT_RUN(angles_are_told);
    GPROJT_RUN(ovals_have_four_sides);
    GPROJT_RUN(any_side_may_be_first);
    GPROJT_RUN(refusals_of_curves);
    GPROJT_RUN(refusals_of_options);
    GPROJT_RUN(curves_that_need_short_steps);
    GPROJT_RUN(the_flattest_corner_is_none);
    GPROJT_RUN(a_star_with_four_edges_is_none);
    GPROJT_RUN(every_allocation_fails_once);
    return gprojt_report();
}
