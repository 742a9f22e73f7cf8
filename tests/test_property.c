/* test_property.c - >>loop and >>solve on 500 random small problems: half of them have a solution, from which they are made
   and near which they start, half have none by construction. What has none is never called solved; what has one is, in at
   least 98 of 100 cases. */
#include "gprojt_form.h"

enum {
    GPROJT_PROBLEMS = 250, /* of each half */
    GPROJT_ITERATIONS = 200
};

/* In (-1, 1). */
static double gprojt_signed(uint64_t *seed) { return 2 * gprojt_uniform(seed) - 1; }

/* How many of a kind were tried, and how many ended as a success. */
typedef struct gprojt_rate {
    const char *name;
    int32_t tried, solved;
} gprojt_rate;

/* Counts a result, and checks that a success is one: everything finite, and the residual within the tolerance, which is
   not large. */
static void gprojt_count(gprojt_rate *rate, const gproj_result *result, gproj_system *s, uint64_t seed) {
    rate->tried++;
    GPROJT_CHECK(result->outcome != GPROJ_FAILED && result->message[0] != 0 && !strstr(result->message, "nan"));
    if (result->outcome != GPROJ_CONVERGED) {
        if (getenv("GPROJT_VERBOSE"))
            printf("  %s, seed %llu: %s\n", rate->name, (unsigned long long)seed, result->message);
        return;
    }
    rate->solved++;
    GPROJT_CHECK(result->residual <= result->tolerance && result->tolerance <= 1e-8);
    GPROJT_CHECK(gprojt_all_finite(gproj_system_values(s), gproj_system_variable_count(s)));
}

/* -- random rows -- */

typedef struct gprojt_row {
    gproj_term term[8];
    int32_t count;
} gprojt_row;

/* Up to 8 terms in the first `variables` variables; linear only where `degree` is 1. */
static gprojt_row gprojt_random_row(int32_t variables, int32_t degree, uint64_t *seed) {
    gprojt_row row;
    int32_t t;
    row.count = 2 + gprojt_below(seed, 7);
    for (t = 0; t < row.count; ++t) {
        int32_t j = degree > 1 && gprojt_below(seed, 2) ? gprojt_below(seed, variables) : -1;
        row.term[t] = gprojt_term(gprojt_below(seed, variables), j, gprojt_signed(seed));
    }
    return row;
}

static double gprojt_row_at(const gprojt_row *row, const double *x) {
    double sum = 0;
    int32_t t;
    for (t = 0; t < row->count; ++t)
        sum += row->term[t].a * x[row->term[t].i] * (row->term[t].j < 0 ? 1 : x[row->term[t].j]);
    return sum;
}

/* The row that holds at x. */
static void gprojt_add_row_through(gproj_system *s, int32_t group, const gprojt_row *row, const double *x,
                                   double slack) {
    gproj_system_add_row(s, group, row->count, row->term, slack - gprojt_row_at(row, x), 0);
}

/* A system of up to 16 variables that start `noise` away from x. */
static gproj_system *gprojt_start_near(int32_t count, const double *x, double noise, uint64_t *seed) {
    gproj_system *s = gproj_system_create(NULL);
    double start[16];
    int32_t i;
    for (i = 0; i < count; ++i) start[i] = x[i] + noise * gprojt_signed(seed);
    gproj_system_add_variables(s, count, 1, start);
    gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
    gprojt_add_group(s, "bounds", GPROJ_BOUND, 1);
    gprojt_add_group(s, "others", GPROJ_CONSTRAINT, 1);
    return s;
}

static void gprojt_random_point(int32_t count, double *x, uint64_t *seed) {
    int32_t i;
    for (i = 0; i < count; ++i) x[i] = gprojt_signed(seed);
}

/* -- systems with a solution -- */

/* Quadratic equations, fewer than variables. */
static gproj_system *gprojt_equations(uint64_t *seed) {
    int32_t variables = 4 + gprojt_below(seed, 12), rows = 1 + gprojt_below(seed, variables / 2), r;
    double x[16];
    gproj_system *s;
    gprojt_random_point(variables, x, seed);
    s = gprojt_start_near(variables, x, 0.3, seed);
    for (r = 0; r < rows; ++r) {
        gprojt_row row = gprojt_random_row(variables, 2, seed);
        gprojt_add_row_through(s, r % 2 ? 0 : 2, &row, x, 0);
    }
    return s;
}

/* As many linear and quadratic bounds as variables, a third of them without slack, and some equations. */
static gproj_system *gprojt_inequalities(uint64_t *seed) {
    int32_t variables = 4 + gprojt_below(seed, 12), r;
    double x[16];
    gproj_system *s;
    gprojt_random_point(variables, x, seed);
    s = gprojt_start_near(variables, x, 0.3, seed);
    for (r = 0; r < variables; ++r) {
        gprojt_row row = gprojt_random_row(variables, 1 + r % 2, seed);
        gprojt_add_row_through(s, 1, &row, x, r % 3 ? 0.3 * gprojt_uniform(seed) : 0);
    }
    for (r = 0; r < variables / 4; ++r) {
        gprojt_row row = gprojt_random_row(variables, 2, seed);
        gprojt_add_row_through(s, 0, &row, x, 0);
    }
    return s;
}

/* Rods between points in the plane, up to 8, each with one or two of those before. */
static gproj_system *gprojt_linkage(uint64_t *seed) {
    int32_t points = 3 + gprojt_below(seed, 6), p, q, k;
    double x[16];
    gproj_system *s;
    gprojt_random_point(2 * points, x, seed);
    for (p = 0; p < points; ++p) x[2 * p] += 1.5 * p; /* apart from each other */
    s = gprojt_start_near(2 * points, x, 0.2, seed);
    for (p = 1; p < points; ++p)
        for (k = 1; k <= 2 && k <= p; ++k) {
            q = p - k;
            if (k == 2 && gprojt_below(seed, 2)) continue;
            gprojt_add_distance(s, 0, 2 * p, 2 * q, 2, hypot(x[2 * p] - x[2 * q], x[2 * p + 1] - x[2 * q + 1]), p);
        }
    gprojt_add_linear(s, 2, 0, 1, -x[0], 0);
    gprojt_add_linear(s, 2, 1, 1, -x[1], 0);
    return s;
}

/* -- systems without -- */

/* r(x) + c and s(x) + d with r + s + e, where c + d differs from e: linear rows of up to 8 terms. */
static gproj_system *gprojt_contradiction(uint64_t *seed) {
    int32_t variables = 4 + gprojt_below(seed, 12), t;
    double x[16];
    gproj_system *s;
    gprojt_row a = gprojt_random_row(variables, 1, seed), b = gprojt_random_row(variables, 1, seed);
    gproj_term both[16];
    gprojt_random_point(variables, x, seed);
    s = gprojt_start_near(variables, x, 0.3, seed);
    for (t = 0; t < a.count; ++t) both[t] = a.term[t];
    for (t = 0; t < b.count; ++t) both[a.count + t] = b.term[t];
    gprojt_add_row_through(s, 0, &a, x, 0);
    gprojt_add_row_through(s, 2, &b, x, 0);
    gproj_system_add_row(s, gprojt_below(seed, 2) ? 2 : 0, a.count + b.count, both,
                         0.01 + gprojt_uniform(seed) - gprojt_row_at(&a, x) - gprojt_row_at(&b, x), 1);
    return s;
}

/* A sum of squares is negative; beside equations that hold somewhere. */
static gproj_system *gprojt_negative_squares(uint64_t *seed) {
    int32_t variables = 4 + gprojt_below(seed, 12), t;
    double x[16];
    gproj_system *s;
    gprojt_row row = gprojt_random_row(variables, 2, seed);
    gprojt_random_point(variables, x, seed);
    s = gprojt_start_near(variables, x, 0.3, seed);
    if (gprojt_below(seed, 2)) gprojt_add_row_through(s, 2, &row, x, 0);
    row.count = 1 + gprojt_below(seed, 8);
    for (t = 0; t < row.count; ++t) row.term[t] = gprojt_term(t % variables, t % variables, 0.1 + gprojt_uniform(seed));
    gproj_system_add_row(s, 0, row.count, row.term, 0.001 + gprojt_uniform(seed), 1);
    return s;
}

/* A chain between two fixed points that is too short; or a triangle with one side longer than the two others. */
static gproj_system *gprojt_short_chain(uint64_t *seed) {
    int32_t points = 3 + gprojt_below(seed, 5), p;
    bool triangle = gprojt_below(seed, 2) == 0;
    double x[16], last = (points - 1) * (1.01 + gprojt_uniform(seed));
    gproj_system *s;
    gprojt_random_point(2 * points, x, seed);
    s = gprojt_start_near(2 * points, x, 0.1, seed);
    for (p = 1; p < points; ++p) gprojt_add_distance(s, 0, 2 * p, 2 * p - 2, 2, 1, p);
    if (triangle) {
        gprojt_add_distance(s, 0, 0, 2 * points - 2, 2, last, 0);
        return s;
    }
    for (p = 0; p < 2; ++p) {
        gprojt_add_linear(s, 2, p, 1, 0, 0);
        gprojt_add_linear(s, 2, 2 * points - 2 + p, 1, p ? 0 : -last, 1);
    }
    return s;
}

/* Bounds without a number between them: of a linear row in two groups, or of three rows whose sum is bounded. */
static gproj_system *gprojt_empty_bounds(uint64_t *seed) {
    int32_t variables = 4 + gprojt_below(seed, 12), t;
    double x[16], gap = 0.001 + gprojt_uniform(seed);
    gproj_system *s;
    gprojt_row row = gprojt_random_row(variables, 1 + gprojt_below(seed, 2), seed);
    gprojt_random_point(variables, x, seed);
    s = gprojt_start_near(variables, x, 0.3, seed);
    gprojt_add_row_through(s, 1, &row, x, -gap); /* at least what it is at x, and `gap` more */
    gprojt_add_group(s, "at most", GPROJ_BOUND, 1);
    for (t = 0; t < row.count; ++t) row.term[t].a *= -1;
    gprojt_add_row_through(s, gprojt_below(seed, 2) ? 3 : 1, &row, x, 0);
    return s;
}

/* -- meshes -- */

/* A translation surface: its quads are parallelograms, so they are planar. */
static gproj_mesh *gprojt_translation(int32_t nx, int32_t ny, uint64_t *seed) {
    gprojt_soup s;
    double a = 0.3 * gprojt_signed(seed), b = 0.3 * gprojt_signed(seed), c = gprojt_uniform(seed);
    int32_t i, j;
    memset(&s, 0, sizeof s);
    for (j = 0; j <= ny; ++j)
        for (i = 0; i <= nx; ++i)
            gprojt_add_vertex(&s, i + 0.2 * sin(j + c), j + 0.2 * sin(2 * i + c),
                              a * (i - 2) * (i - 2) + b * (j - 2) * (j - 2));
    for (j = 0; j < ny; ++j)
        for (i = 0; i < nx; ++i) {
            int32_t v = j * (nx + 1) + i;
            gprojt_add_quad(&s, v, v + 1, v + nx + 2, v + nx + 1);
        }
    return gprojt_mesh_of(s);
}

/* A part of a surface of revolution: its quads are planar and have circumcircles. */
static gproj_mesh *gprojt_turned(int32_t nx, int32_t ny, uint64_t *seed) {
    gprojt_soup s;
    double bend = 0.3 + gprojt_uniform(seed), step = 0.2 + 0.1 * gprojt_uniform(seed);
    int32_t i, j;
    memset(&s, 0, sizeof s);
    for (j = 0; j <= ny; ++j)
        for (i = 0; i <= nx; ++i) {
            double r = 4 + bend * cos(0.8 * j);
            gprojt_add_vertex(&s, r * cos(step * i), r * sin(step * i), 0.9 * j);
        }
    for (j = 0; j < ny; ++j)
        for (i = 0; i < nx; ++i) {
            int32_t v = j * (nx + 1) + i;
            gprojt_add_quad(&s, v, v + 1, v + nx + 2, v + nx + 1);
        }
    return gprojt_mesh_of(s);
}

/* Moves the vertices, but for those of the boundary where these are to stay. */
static void gprojt_disturb(gproj_mesh *mesh, double size, bool inside, uint64_t *seed) {
    int32_t v, k;
    for (v = 0; v < mesh->vertex_count; ++v)
        for (k = 0; k < 3; ++k) {
            double move = size * gprojt_signed(seed);
            if (!inside || !gproj_mesh_is_boundary_vertex(mesh, v)) mesh->position[3 * v + k] += move;
        }
}

static double *gprojt_lengths(const gproj_mesh *mesh) {
    double *length = (double *)malloc((size_t)mesh->edge_count * sizeof *length);
    int32_t e;
    for (e = 0; e < mesh->edge_count; ++e) length[e] = gprojt_edge_length(mesh, e);
    return length;
}

/* The loads that these forces balance; NULL densities: random ones, compression. */
static double *gprojt_balanced_loads(const gproj_mesh *mesh, uint64_t *seed) {
    double *load = (double *)calloc(3 * (size_t)mesh->vertex_count, sizeof *load);
    int32_t e, k;
    for (e = 0; e < mesh->edge_count; ++e) {
        int32_t i = mesh->origin[2 * e], j = mesh->origin[2 * e + 1];
        double w = 0.3 + gprojt_uniform(seed);
        for (k = 0; k < 3; ++k) {
            double f = w * (mesh->position[3 * i + k] - mesh->position[3 * j + k]);
            load[3 * i + k] -= f;
            load[3 * j + k] += f;
        }
    }
    return load;
}

/* Equilibrium at all inner vertices under these loads. */
static void gprojt_add_balance(gproj_form *form, const gproj_mesh *mesh, const double *load) {
    int32_t vertex[64], v, count = 0;
    gproj_loads loads;
    gproj_supports supports;
    memset(&loads, 0, sizeof loads);
    memset(&supports, 0, sizeof supports);
    for (v = 0; v < mesh->vertex_count; ++v)
        if (gproj_mesh_is_boundary_vertex(mesh, v)) vertex[count++] = v;
    loads.point_load = load;
    supports.count = count, supports.vertex = vertex;
    gproj_add_equilibrium(form, &loads, &supports, 1);
}

/* Solves, counts, and destroys both. */
static void gprojt_finish(gproj_mesh *mesh, gproj_form *form, gprojt_rate *rate, uint64_t seed) {
    gproj_result result = gproj_solve(form, GPROJT_ITERATIONS, NULL);
    gprojt_count(rate, &result, gproj_form_system(form), seed);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

enum {
    GPROJT_FLAT,    /* planar faces, the boundary fixed */
    GPROJT_LENGTHS, /* planar faces, up to half of the edges of given lengths */
    GPROJT_CIRCLES, /* planar faces with circumcircles */
    GPROJT_FORCES,  /* equilibrium under given loads, the boundary fixed */
    GPROJT_THRUST,  /* the same by compression */
    GPROJT_MESHES
};

/* What is asked for holds before the mesh is disturbed. */
static void gprojt_feasible_mesh(int32_t kind, uint64_t *seed, gprojt_rate *rate) {
    uint64_t begin = *seed;
    int32_t nx = 2 + gprojt_below(seed, 4), ny = 2 + gprojt_below(seed, 4);
    gproj_mesh *mesh = kind == GPROJT_CIRCLES ? gprojt_turned(nx, ny, seed) : gprojt_translation(nx, ny, seed);
    bool forces = kind >= GPROJT_FORCES;
    double *length = gprojt_lengths(mesh), *load;
    gproj_form *form;
    if (forces) gprojt_disturb(mesh, 0.2, true, seed); /* any shape */
    load = gprojt_balanced_loads(mesh, seed);
    gprojt_disturb(mesh, forces || kind == GPROJT_FLAT ? 0.1 : 0.05, forces || kind == GPROJT_FLAT, seed);
    form = gproj_form_create(mesh, NULL);
    if (!forces) gproj_add_planarity(form, 1);
    if (forces || kind == GPROJT_FLAT) gproj_add_fixed_boundary(form, 1);
    if (kind == GPROJT_LENGTHS) gproj_add_lengths(form, 1 + gprojt_below(seed, mesh->edge_count / 2), NULL, length, 1);
    if (kind == GPROJT_CIRCLES) gproj_add_circularity(form, 1);
    if (forces) gprojt_add_balance(form, mesh, load);
    if (kind == GPROJT_THRUST) gproj_add_compression(form, mesh->edge_count, NULL, 1);
    gprojt_finish(mesh, form, rate, begin);
    free(length), free(load);
}

enum {
    GPROJT_FIXED_FACES,   /* a strip with all vertices fixed, one of them beside the planes */
    GPROJT_OPEN_POLYGON,  /* a side of a face is longer than the others together */
    GPROJT_LENGTH_BOUNDS, /* at least more than at most */
    GPROJT_FIXED_LENGTHS, /* both ends fixed, and another length */
    GPROJT_FLAT_LOADS,    /* a flat mesh, all fixed, with loads across */
    GPROJT_WRONG_MESHES
};

static void gprojt_infeasible_mesh(int32_t kind, uint64_t *seed, gprojt_rate *rate) {
    uint64_t begin = *seed;
    bool strip = kind == GPROJT_FIXED_FACES;
    int32_t nx = 2 + gprojt_below(seed, 4), ny = strip ? 1 : 2 + gprojt_below(seed, 4), edges[4], h, i;
    gproj_mesh *mesh = gprojt_translation(nx, ny, seed);
    double *load = (double *)calloc(3 * (size_t)mesh->vertex_count, sizeof *load);
    double lengths[4] = {1, 1, 1, 3.03}, off = 0.01 + gprojt_uniform(seed);
    gproj_form *form;
    if (strip) mesh->position[3 * gprojt_below(seed, mesh->vertex_count) + 2] += off;
    for (i = 0; kind == GPROJT_FLAT_LOADS && i < mesh->vertex_count; ++i) mesh->position[3 * i + 2] = 0;
    form = gproj_form_create(mesh, NULL);
    if (kind != GPROJT_FLAT_LOADS) gproj_add_planarity(form, 1);
    if (strip) gproj_add_fixed_boundary(form, 1);
    h = mesh->face_halfedge[gprojt_below(seed, mesh->face_count)];
    for (i = 0; i < 4; ++i, h = mesh->next[h]) edges[i] = h / 2;
    lengths[3] += off;
    if (kind == GPROJT_OPEN_POLYGON) gproj_add_lengths(form, 4, edges, lengths, 1);
    if (kind == GPROJT_LENGTH_BOUNDS) {
        gproj_add_length_bounds(form, mesh->edge_count, NULL, 1 + off, HUGE_VAL, 1);
        gproj_add_length_bounds(form, 4, edges, 0, 1, 1);
    }
    if (kind == GPROJT_FIXED_LENGTHS) {
        lengths[0] = (1 + off) * gprojt_edge_length(mesh, edges[0]);
        gproj_add_lengths(form, 1, edges, lengths, 1);
    }
    if (kind == GPROJT_FIXED_LENGTHS || kind == GPROJT_FLAT_LOADS) {
        int32_t all[64];
        for (i = 0; i < mesh->vertex_count; ++i) all[i] = i;
        gproj_add_fixed(form, mesh->vertex_count, all, 1);
    }
    for (i = 0; i < mesh->vertex_count; ++i) load[3 * i + 2] = -off;
    if (kind == GPROJT_FLAT_LOADS) gprojt_add_balance(form, mesh, load);
    gprojt_finish(mesh, form, rate, begin);
    free(load);
}

/* -- the two halves -- */

typedef gproj_system *(*gprojt_maker)(uint64_t *seed);

static void gprojt_solve_system(gprojt_maker make, uint64_t *seed, gprojt_rate *rate) {
    uint64_t begin = *seed;
    gproj_system *s = make(seed);
    gproj_result result = gproj_system_solve(s, GPROJT_ITERATIONS, NULL);
    gprojt_count(rate, &result, s, begin);
    gproj_system_destroy(s);
}

GPROJT_TEST(what_has_a_solution_is_solved) {
    static const gprojt_maker makers[3] = {gprojt_equations, gprojt_inequalities, gprojt_linkage};
    gprojt_rate rate[3 + GPROJT_MESHES] = {
        {"equations", 0, 0},           {"inequalities", 0, 0}, {"linkages", 0, 0},    {"planar, fixed boundary", 0, 0},
        {"planar with lengths", 0, 0}, {"circular", 0, 0},     {"equilibrium", 0, 0}, {"compression", 0, 0}};
    uint64_t seed = 1;
    int32_t i, kind, solved = 0;
    for (i = 0; i < GPROJT_PROBLEMS; ++i) {
        kind = i % (3 + GPROJT_MESHES);
        if (kind < 3)
            gprojt_solve_system(makers[kind], &seed, &rate[kind]);
        else
            gprojt_feasible_mesh(kind - 3, &seed, &rate[kind]);
    }
    for (kind = 0; kind < 3 + GPROJT_MESHES; ++kind) {
        solved += rate[kind].solved;
        if (rate[kind].solved < rate[kind].tried)
            printf("  %s: %d of %d solved\n", rate[kind].name, (int)rate[kind].solved, (int)rate[kind].tried);
    }
    GPROJT_CHECK(solved >= 0.98 * GPROJT_PROBLEMS);
}

GPROJT_TEST(what_has_no_solution_is_not) {
    static const gprojt_maker makers[4] = {gprojt_contradiction, gprojt_negative_squares, gprojt_short_chain,
                                           gprojt_empty_bounds};
    gprojt_rate rate[4 + GPROJT_WRONG_MESHES] = {
        {"contradictions", 0, 0}, {"negative squares", 0, 0}, {"short chains", 0, 0},
        {"empty bounds", 0, 0},   {"fixed faces", 0, 0},      {"open polygons", 0, 0},
        {"length bounds", 0, 0},  {"fixed lengths", 0, 0},    {"flat loads", 0, 0}};
    uint64_t seed = 2;
    int32_t i, kind;
    for (i = 0; i < GPROJT_PROBLEMS; ++i) {
        kind = i % (4 + GPROJT_WRONG_MESHES);
        if (kind < 4)
            gprojt_solve_system(makers[kind], &seed, &rate[kind]);
        else
            gprojt_infeasible_mesh(kind - 4, &seed, &rate[kind]);
    }
    for (kind = 0; kind < 4 + GPROJT_WRONG_MESHES; ++kind) {
        if (rate[kind].solved)
            printf("  %s: %d of %d called solved\n", rate[kind].name, (int)rate[kind].solved, (int)rate[kind].tried);
        GPROJT_CHECK(rate[kind].solved == 0);
    }
}

int main(void) {
    GPROJT_RUN(what_has_a_solution_is_solved);
    GPROJT_RUN(what_has_no_solution_is_not);
    return gprojt_report();
}
