/* test_limits.c - the largest counts, here with a small index: each limit has a sentence, and spoils nothing. */
#define GPROJ_STATIC
#define GPROJI_INDEX_MAX 300
#include "gprojt_form.h"

static gproj_error gprojt_last;

static bool gprojt_is_size(const char *piece) {
    bool right = gprojt_last.code == GPROJ_ERROR_SIZE && strstr(gprojt_last.message, piece);
    if (!right) printf("  code %d: %s\n", (int)gprojt_last.code, gprojt_last.message);
    return right;
}

/* A mesh of vertices alone; NULL: refused, see gprojt_last. */
static gproj_mesh *gprojt_vertices(int32_t count) {
    gprojt_soup soup;
    gproj_mesh *mesh;
    int32_t i;
    memset(&soup, 0, sizeof soup);
    for (i = 0; i < count; ++i) gprojt_add_vertex(&soup, i, i % 7, i % 3);
    mesh = gprojt_soup_mesh(&soup, NULL, &gprojt_last);
    gprojt_soup_free(&soup);
    return mesh;
}

/* One face with all vertices of a circle. */
static gproj_mesh *gprojt_disc(int32_t degree) {
    gprojt_soup soup;
    gproj_mesh *mesh;
    int32_t corner[200], i;
    memset(&soup, 0, sizeof soup);
    for (i = 0; i < degree; ++i)
        corner[i] = gprojt_add_vertex(&soup, cos(6.283 * i / degree), sin(6.283 * i / degree), 0.01 * (i % 3));
    gprojt_add_face(&soup, degree, corner);
    mesh = gprojt_soup_mesh(&soup, NULL, &gprojt_last);
    gprojt_soup_free(&soup);
    return mesh;
}

/* Without reallocation a block is taken, filled and put in the old one's place, which stays if there is none. */
GPROJT_TEST(blocks_that_are_copied) {
    gprojt_failing counted;
    gproj_host host;
    gproji_heap heap;
    double *block;
    memset(&counted, 0, sizeof counted);
    host = gprojt_failing_host(&counted);
    host.allocator.reallocate = NULL;
    heap = gproji_heap_of(&host);
    block = (double *)gproji_take_zeroed(&heap, 5, sizeof(double));
    GPROJT_REQUIRE(block);
    block[4] = 7;
    counted.fail_at = 2;
    GPROJT_CHECK(!gproji_retake(&heap, block, 5, 125, sizeof(double)) && block[4] == 7 && heap.account.used == 40);
    block = (double *)gproji_retake(&heap, block, 5, 125, sizeof(double));
    GPROJT_REQUIRE(block && block[3] == 0 && block[4] == 7 && heap.account.used == 1000 && counted.bytes == 1000);
    block = (double *)gproji_retake(&heap, block, 125, 5, sizeof(double));
    GPROJT_REQUIRE(block && block[4] == 7 && heap.account.used == 40 && counted.held == 1);
    gproji_give(&heap, block, 5, sizeof(double));
    GPROJT_CHECK(heap.account.used == 0 && heap.account.peak == 1040);
    GPROJT_CHECK(counted.held == 0 && counted.wrong_sizes == 0);
}

/* Bytes that are only added up: of new blocks, up to the largest number. */
GPROJT_TEST(foretold_bytes) {
    gproji_heap heap = gproji_heap_of(NULL);
    char *block = (char *)gproji_take(&heap, 5, 1);
    size_t bytes = 0;
    GPROJT_REQUIRE(block);
    heap.foretold = &bytes;
    GPROJT_CHECK(!gproji_take(&heap, 100, 8) && bytes == 800);
    block[4] = 7;
    block = (char *)gproji_retake(&heap, block, 5, 9, 1); /* one that is there moves */
    GPROJT_REQUIRE(block && block[4] == 7 && bytes == 800 && heap.account.used == 9);
    GPROJT_CHECK(!gproji_take(&heap, SIZE_MAX / 2 / 8, 8) && bytes > SIZE_MAX / 2);
    GPROJT_CHECK(!gproji_take(&heap, SIZE_MAX / 2 / 8, 8) && bytes == SIZE_MAX);
    GPROJT_CHECK(!gproji_take(&heap, 1, 1) && bytes == SIZE_MAX);
    gproji_give(&heap, block, 9, 1);
    GPROJT_CHECK(heap.account.used == 0);
}

static void *gprojt_arena_allocate(void *user, size_t size) {
    char **arena = (char **)user, *block = *arena;
    *arena += (size + 15) / 16 * 16;
    return block;
}

/* A host that never takes a block back: a mesh is as it is with any other. */
GPROJT_TEST(arenas) {
    gprojt_soup grid = gprojt_quad_grid(3, 3);
    gproj_mesh *mesh = gprojt_soup_mesh(&grid, NULL, NULL), *other;
    char *room = (char *)malloc(1 << 20), *at = room;
    gproj_host host;
    memset(&host, 0, sizeof host);
    host.allocator.allocate = gprojt_arena_allocate, host.allocator.user = &at;
    other = gprojt_soup_mesh(&grid, &host, &gprojt_last);
    GPROJT_CHECK(mesh && other && gprojt_same_mesh(mesh, other) &&
                 at - room >= (ptrdiff_t)gproj_mesh_memory(other).used);
    gproj_mesh_destroy(other);
    gproj_mesh_destroy(mesh);
    free(room);
    gprojt_soup_free(&grid);
}

GPROJT_TEST(vertices_and_corners) {
    gprojt_soup grid = gprojt_quad_grid(6, 6); /* 144 corners */
    gproj_mesh *mesh = gprojt_vertices(99);
    GPROJT_CHECK(mesh && mesh->vertex_count == 99);
    gproj_mesh_destroy(mesh);
    GPROJT_CHECK(!gprojt_vertices(100) && gprojt_is_size("the mesh has 100 vertices, more than 99"));
    mesh = gprojt_soup_mesh(&grid, NULL, &gprojt_last);
    GPROJT_CHECK(mesh && !gprojt_validate_mesh(mesh));
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&grid);
    grid = gprojt_quad_grid(19, 2); /* 38 faces */
    GPROJT_CHECK(!gprojt_soup_mesh(&grid, NULL, &gprojt_last) && gprojt_last.index == 37 &&
                 gprojt_is_size("up to face 37 have more than 149 corners"));
    gprojt_soup_free(&grid);
}

/* Reads a text and gives all memory back. */
static bool gprojt_reads(const char *text) {
    gprojt_failing counted;
    gproj_host host;
    gproj_mesh *mesh;
    memset(&counted, 0, sizeof counted);
    host = gprojt_failing_host(&counted);
    mesh = gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_DETECT, &host, &gprojt_last);
    gproj_mesh_destroy(mesh);
    GPROJT_CHECK(counted.held == 0);
    return mesh != NULL;
}

/* A text: a head, a line again and again, an end. */
static char *gprojt_text_of(const char *head, int32_t count, const char *line, const char *end) {
    char *text = (char *)malloc(strlen(head) + (size_t)count * strlen(line) + strlen(end) + 1), *at = text;
    if (!text) abort();
    at += sprintf(at, "%s", head);
    while (count-- > 0) at += sprintf(at, "%s", line);
    sprintf(at, "%s", end);
    return text;
}

static bool gprojt_reads_many(const char *head, int32_t count, const char *line, const char *end) {
    char *text = gprojt_text_of(head, count, line, end);
    bool read = gprojt_reads(text);
    free(text);
    return read;
}

GPROJT_TEST(texts) {
    static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    GPROJT_CHECK(gprojt_reads_many("", 99, "v 1 2 3\n", ""));
    GPROJT_CHECK(!gprojt_reads_many("", 100, "v 1 2 3\n", "") && gprojt_last.index == 100 &&
                 gprojt_is_size("more than 99 vertices; split the mesh"));
    GPROJT_CHECK(!gprojt_reads_many(triangle, 100, "f 1 2 3\n", "") && gprojt_last.index == 103 &&
                 gprojt_is_size("the text has too many elements"));
    GPROJT_CHECK(!gprojt_reads("v 0 0 0\nf 1 2 100\n") && gprojt_last.code == GPROJ_ERROR_INDEX &&
                 strstr(gprojt_last.message, "index 100 is larger than any number of vertices can be"));
    GPROJT_CHECK(!gprojt_reads("OFF\n100 0 0\n") && gprojt_is_size("a count of 100 vertices"));
    GPROJT_CHECK(!gprojt_reads("OFF\n3 100 0\n") && gprojt_is_size("a count of 100 faces"));
}

GPROJT_TEST(subdivision) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(4, 4)), *fine;
    gproj_subdivide_options options;
    memset(&options, 0, sizeof options);
    options.levels = 1;
    GPROJT_CHECK(!gproj_mesh_subdivide(mesh, &options, NULL, NULL, &gprojt_last) &&
                 gprojt_is_size("level 1 would have 81 vertices, 64 faces"));
    gproj_mesh_destroy(mesh);
    mesh = gprojt_mesh_of(gprojt_quad_grid(3, 3));
    fine = gproj_mesh_subdivide(mesh, &options, NULL, NULL, &gprojt_last);
    GPROJT_CHECK(fine && fine->vertex_count == 49);
    gproj_mesh_destroy(fine);
    gproj_mesh_destroy(mesh);
}

GPROJT_TEST(dual_and_diagonals) {
    int32_t n;
    for (n = 3; n < 5; ++n) { /* 4 * 24 + 3 * 16 and 4 * 31 + 3 * 20 corners; 149 are the most */
        gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(n, 3)), *made;
        made = gproj_mesh_dual(mesh, NULL, NULL, &gprojt_last);
        GPROJT_CHECK(n == 3 ? made != NULL : !made && gprojt_is_size("could have 184 corners of faces, and 149 are"));
        gproj_mesh_destroy(made);
        made = gproj_mesh_diagonals(mesh, NULL, &gprojt_last);
        GPROJT_CHECK(n == 3 ? made != NULL : !made && gprojt_is_size("could have 184 corners of faces, and 149 are"));
        gproj_mesh_destroy(made);
        gproj_mesh_destroy(mesh);
    }
}

/* Splits an edge again and again until it is refused; the edit is then a mesh as it was. */
static int32_t gprojt_split_to_the_end(gproj_edit *edit) {
    gproj_mesh *before, *after;
    int32_t splits = 0;
    while (gproj_edit_split_edge(edit, 0, 0.9, &gprojt_last) >= 0) splits++;
    before = gproj_edit_mesh(edit, NULL, NULL);
    GPROJT_CHECK(gproj_edit_split_edge(edit, 0, 0.9, NULL) < 0);
    after = gproj_edit_mesh(edit, NULL, NULL);
    GPROJT_CHECK(before && after && !gprojt_validate_mesh(after) && gprojt_same_mesh(before, after));
    gproj_mesh_destroy(before);
    gproj_mesh_destroy(after);
    return splits;
}

GPROJT_TEST(edits) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(2, 2)); /* 9 vertices, 12 edges */
    gproj_edit *edit = gproj_edit_create(mesh, NULL, NULL);
    char *text;
    GPROJT_CHECK(gprojt_split_to_the_end(edit) == 62 && gprojt_is_size("more than 99 vertices or 74 edges"));
    gproj_edit_destroy(edit);
    gproj_mesh_destroy(mesh);
    /* Vertices beside the faces count, too: 95 and 4 more. */
    text = gprojt_text_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 92, "v 1 2 3\n", "");
    mesh = gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_OBJ, NULL, NULL);
    free(text);
    edit = gproj_edit_create(mesh, NULL, NULL);
    GPROJT_CHECK(gprojt_split_to_the_end(edit) == 4 && gprojt_is_size("more than 99 vertices or 74 edges"));
    gproj_edit_destroy(edit);
    gproj_mesh_destroy(mesh);
    /* A polyline that goes along an edge 70 times each way, and has room for 9 more vertices. */
    text = gprojt_text_of("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl", 70, " 1 2", " 1\n");
    mesh = gproj_mesh_read(text, strlen(text), GPROJ_FORMAT_OBJ, NULL, NULL);
    free(text);
    edit = gproj_edit_create(mesh, NULL, NULL);
    GPROJT_CHECK(gproj_edit_split_edge(edit, 0, 0.5, &gprojt_last) < 0 &&
                 gprojt_is_size("the polylines would have more than 150 vertices"));
    GPROJT_CHECK(gproj_edit_split_edge(edit, 1, 0.5, &gprojt_last) == 3);
    gproj_edit_destroy(edit);
    gproj_mesh_destroy(mesh);
}

/* A circle of points: 99 may be vertices. */
GPROJT_TEST(curves) {
    gproj_fill_options options;
    double points[300];
    gproj_mesh *mesh;
    int32_t i;
    for (i = 0; i < 100; ++i)
        points[3 * i] = cos(0.0628 * i), points[3 * i + 1] = sin(0.0628 * i), points[3 * i + 2] = 0;
    memset(&options, 0, sizeof options);
    options.edge_length = 0.7;
    mesh = gproj_mesh_fill(99, points, &options, NULL, NULL, &gprojt_last);
    GPROJT_CHECK(mesh && !gprojt_validate_mesh(mesh));
    gproj_mesh_destroy(mesh);
    mesh = gproj_mesh_fill(100, points, &options, NULL, NULL, &gprojt_last);
    GPROJT_CHECK(!mesh && gprojt_last.code == GPROJ_ERROR_ARGUMENT &&
                 strstr(gprojt_last.message, "a closed curve of 100 points; it needs at least 3 and at most 99"));
}

GPROJT_TEST(supports) {
    gproj_mesh *mesh = gprojt_mesh_of(gprojt_quad_grid(3, 3)), *one; /* 24 edges */
    gproj_mesh *support = gproj_mesh_support(mesh, mesh, NULL, &gprojt_last);
    GPROJT_CHECK(support && !gprojt_validate_mesh(support));
    gproj_mesh_destroy(support);
    gproj_mesh_destroy(mesh);
    one = gprojt_disc(25);
    GPROJT_CHECK(!gproj_mesh_support(one, one, NULL, &gprojt_last) &&
                 gprojt_is_size("the support of 25 edges has too many vertices"));
    gproj_mesh_destroy(one);
}

GPROJT_TEST(matrices) {
    static int64_t start[302];
    static const int32_t row[1] = {0};
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    gproj_cholesky_options options;
    int32_t path[200], order[76], j, n;
    gproj_least_squares problem;
    double x[301] = {0};
    GPROJT_CHECK(gproj_cholesky_analyse(c, 236, start, row, NULL) == GPROJ_OK);
    GPROJT_CHECK(gproj_cholesky_analyse(c, 237, start, row, NULL) == GPROJ_ERROR_SIZE);
    gprojt_last = *gproj_cholesky_error(c);
    GPROJT_CHECK(gprojt_is_size("a matrix cannot have 237 columns"));
    /* Dissection, whose coordinates are sums of distances, is for 75 nodes here; beyond it is minimum degree. */
    memset(&options, 0, sizeof options);
    for (n = 75; n <= 76; ++n) {
        bool same;
        for (j = 0; j < n; ++j) path[j] = j < n - 1 ? j + 1 : j, start[j + 1] = j + 1;
        options.ordering = GPROJ_ORDERING_DISSECTION;
        GPROJT_REQUIRE(gproj_cholesky_analyse(c, n, start, path, &options) == GPROJ_OK);
        memcpy(order, gproj_cholesky_permutation(c), (size_t)n * sizeof *order);
        options.ordering = GPROJ_ORDERING_AMD;
        GPROJT_REQUIRE(gproj_cholesky_analyse(c, n, start, path, &options) == GPROJ_OK);
        same = memcmp(order, gproj_cholesky_permutation(c), (size_t)n * sizeof *order) == 0;
        GPROJT_CHECK(same == (n > 75));
    }
    /* Other orders have no such limit: a hub that is eliminated first leaves all others adjacent. */
    for (j = 0; j < 200; ++j) path[j] = j, start[j + 1] = 200;
    options.ordering = GPROJ_ORDERING_NATURAL;
    GPROJT_CHECK(gproj_cholesky_analyse(c, 200, start, path, &options) == GPROJ_OK &&
                 gproj_cholesky_get_info(c).exact_entries == 200 * 201 / 2);
    gproj_cholesky_destroy(c);
    memset(start, 0, sizeof start);
    memset(&problem, 0, sizeof problem);
    problem.start = start, problem.row = row, problem.b = x;
    problem.rows = 1, problem.columns = 237;
    GPROJT_CHECK(gproj_solve_least_squares(&problem, NULL, x, NULL, &gprojt_last) &&
                 gprojt_is_size("1 rows and 237 columns"));
    problem.rows = 300, problem.columns = 1;
    GPROJT_CHECK(gproj_solve_least_squares(&problem, NULL, x, NULL, &gprojt_last) &&
                 gprojt_is_size("300 rows and 1 columns"));
}

/* A system of `count` variables that may each be eliminated alone, and an empty group. */
static gproj_system *gprojt_system_of(int32_t count, int32_t *group) {
    gproj_system *s = gproj_system_create(NULL);
    gproj_system_add_variables(s, count, 1, NULL);
    *group = gprojt_add_group(s, "rows", GPROJ_CONSTRAINT, 1);
    return s;
}

/* Is the system refused, and as it was? */
static bool gprojt_stays(gproj_system *s, int32_t variables, int32_t group, int32_t rows, const char *piece) {
    gprojt_last = *gproj_system_error(s);
    return gprojt_is_size(piece) && gproj_system_variable_count(s) == variables && gprojt_info(s, group).rows == rows;
}

GPROJT_TEST(variables) {
    gproj_mesh *mesh = gprojt_vertices(51);
    gproj_form *form;
    int32_t group;
    gproj_system *s = gprojt_system_of(150, &group);
    GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK);
    GPROJT_CHECK(gproj_system_add_variables(s, 1, 1, NULL) == -1);
    GPROJT_CHECK(gprojt_stays(s, 150, group, 0, "more than 150 variables"));
    gproj_system_destroy(s);
    form = gproj_form_create(mesh, NULL);
    gprojt_last = *gproj_form_error(form);
    GPROJT_CHECK(gprojt_is_size("more than 150 variables"));
    GPROJT_CHECK(gproj_solve(form, 3, NULL).outcome == GPROJ_FAILED);
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
    /* Normals of faces are variables, too: 147 for the vertices, 108 for the faces. */
    mesh = gprojt_mesh_of(gprojt_quad_grid(6, 6));
    form = gproj_form_create(mesh, NULL);
    GPROJT_CHECK(gproj_add_planarity(form, 1) == -1);
    gprojt_last = *gproj_form_error(form);
    GPROJT_CHECK(gprojt_is_size("more than 150 variables"));
    gproj_form_destroy(form);
    gproj_mesh_destroy(mesh);
}

/* Smooth solves number corners, edges and bends together: 7 for each edge. */
GPROJT_TEST(corners) {
    int32_t n;
    for (n = 3; n <= 4; ++n) { /* 33 and 43 edges */
        gproj_mesh *mesh = gprojt_mesh_of(gprojt_triangle_grid(3, n));
        gproj_form *form = gproj_form_create(mesh, NULL);
        gproj_solve_options options;
        memset(&options, 0, sizeof options);
        options.smooth = true;
        gproj_add_planarity(form, 1);
        GPROJT_CHECK((gproj_solve(form, 3, &options).outcome == GPROJ_FAILED) == (n == 4));
        gprojt_last = *gproj_form_error(form);
        GPROJT_CHECK(n == 3 || gprojt_is_size("at most 42 edges, and the mesh has 43"));
        gproj_form_destroy(form);
        gproj_mesh_destroy(mesh);
    }
}

/* Adds a row with x_first + ... + x_(first + count - 1), or the same terms twice. */
static int32_t gprojt_add_sum(gproj_system *s, int32_t group, int32_t first, int32_t count, int32_t times) {
    gproj_term term[200];
    int32_t t;
    for (t = 0; t < count * times; ++t) term[t] = gprojt_term(first + t % count, -1, 1.0 / times);
    return gproj_system_add_row(s, group, count * times, term, -1, first); /* each an element of its own */
}

GPROJT_TEST(rows_and_terms) {
    int32_t group, r;
    gproj_system *s = gprojt_system_of(100, &group);
    for (r = 0; r < 299; ++r) gprojt_add_linear(s, group, r % 100, 1, -1, r);
    GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK);
    GPROJT_CHECK(gprojt_add_linear(s, group, 0, 1, 0, r) == -1);
    GPROJT_CHECK(gprojt_stays(s, 100, group, 299, "group 'rows' has too many rows or terms"));
    gproj_system_destroy(s);
    /* 600 terms, which name 6 variables; 600 variables named. */
    s = gprojt_system_of(100, &group);
    for (r = 0; r < 6; ++r) gprojt_add_sum(s, group, r, 1, 100);
    GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK && gprojt_add_sum(s, group, 0, 1, 1) == -1);
    GPROJT_CHECK(gprojt_stays(s, 100, group, 6, "group 'rows' has too many rows or terms"));
    gproj_system_destroy(s);
    /* 300 terms, which name 600 variables. */
    s = gprojt_system_of(100, &group);
    for (r = 0; r <= 150; ++r) {
        gproj_term term[2] = {gprojt_term(0, 1, 1), gprojt_term(2, 3, 1)};
        GPROJT_CHECK(gproj_system_add_row(s, group, 2, term, -1, r) == (r < 150 ? r : -1));
    }
    GPROJT_CHECK(gprojt_stays(s, 100, group, 150, "group 'rows' has too many rows or terms"));
    gproj_system_destroy(s);
    s = gprojt_system_of(100, &group);
    for (r = 0; r < 6; ++r) gprojt_add_sum(s, group, 0, 100, 1);
    GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK && gproj_system_solve(s, 9, NULL).outcome == GPROJ_CONVERGED);
    GPROJT_CHECK(gprojt_add_sum(s, group, 0, 1, 1) == -1);
    GPROJT_CHECK(gprojt_stays(s, 100, group, 6, "group 'rows' has too many rows or terms"));
    gproj_system_destroy(s);
}

/* Rows that are too many together are refused by the solve, which leaves x as it was. */
GPROJT_TEST(rows_together) {
    int32_t kind;
    for (kind = 0; kind < 2; ++kind) {
        int32_t group, other, r;
        gproj_system *s = gprojt_system_of(150, &group);
        gproj_solve_options options;
        memset(&options, 0, sizeof options);
        options.nearest = kind == 1; /* else by multipliers */
        other = gprojt_add_group(s, "others", GPROJ_CONSTRAINT, 1);
        for (r = 0; r < 14; ++r) gprojt_add_sum(s, r % 2 ? group : other, 7 * r, 50, 1);
        GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK);
        GPROJT_CHECK(gproj_system_solve(s, 9, &options).outcome == GPROJ_FAILED);
        GPROJT_CHECK(gprojt_stays(s, 150, group, 7, "the groups have too many rows or terms together"));
        for (r = 0; r < 150; ++r) GPROJT_CHECK(gproj_system_values(s)[r] == 0);
        gproj_system_destroy(s);
    }
    { /* 601 rows, but few terms */
        int32_t group, r;
        gproj_system *s = gprojt_system_of(150, &group);
        gprojt_add_group(s, "others", GPROJ_CONSTRAINT, 1);
        gprojt_add_group(s, "more", GPROJ_CONSTRAINT, 1);
        for (r = 0; r < 601; ++r) gproj_system_add_row(s, r % 3, 0, NULL, 0, r);
        gprojt_add_linear(s, 1, 7, 1, -1, 0);
        GPROJT_CHECK(gproj_system_error(s)->code == GPROJ_OK);
        GPROJT_CHECK(gproj_system_solve(s, 9, NULL).outcome == GPROJ_FAILED);
        GPROJT_CHECK(gprojt_stays(s, 150, group, 201, "the groups have too many rows or terms together"));
        GPROJT_CHECK(gproj_system_values(s)[7] == 0);
        gproj_system_destroy(s);
    }
}

/* Rows with the same terms: each gets its own when numbers are set, and copies where their variables are sorted. */
GPROJT_TEST(terms_in_common) {
    gproj_term term[310];
    double numbers[310];
    int32_t group, k, r, t, *local;
    for (t = 0; t < 310; ++t) term[t] = gprojt_term(t % 2, -1, 1), numbers[t] = 1;
    for (k = 0; k < 2; ++k) {
        gproj_system *s = gprojt_system_of(100, &group);
        for (r = 0; r < 3; ++r) {
            local = gproji_add_placed_rows(s, group, 0, 1, 310, term, 2, 0, r);
            GPROJT_REQUIRE(local);
            local[0] = r % 2, local[1] = 1 - r % 2;
        }
        GPROJT_CHECK((k ? gproji_compile(s, true) : gproj_system_set_row(s, group, 1, numbers, 0)) == GPROJ_ERROR_SIZE);
        GPROJT_CHECK(gprojt_stays(s, 100, group, 3, "group 'rows' has too many rows or terms"));
        gproj_system_values(s)[0] = 1;
        for (r = 0; r < 3; ++r) GPROJT_CHECK(gproj_system_row_value(s, group, r, NULL) == 155);
        gproj_system_destroy(s);
    }
}

/* Blocks beyond all memory, or a limit, are refused before the host is asked, and others stay. */
GPROJT_TEST(blocks) {
    int limited;
    for (limited = 0; limited < 2; ++limited) {
        gprojt_failing counted;
        gproj_host host;
        gproji_heap heap;
        gproji_pool pool;
        double *block;
        size_t size;
        memset(&counted, 0, sizeof counted);
        host = gprojt_failing_host(&counted);
        host.allocator.limit = limited ? 1000 : 0;
        heap = gproji_heap_of(&host);
        block = (double *)gproji_take_zeroed(&heap, 5, sizeof(double));
        GPROJT_REQUIRE(block && heap.account.used == 40);
        for (size = 1; size <= 4096; size *= 4) {
            GPROJT_CHECK(!gproji_take(&heap, SIZE_MAX / 2 / size + 1, size));
            GPROJT_CHECK(!gproji_take_zeroed(&heap, SIZE_MAX / size, size));
        }
        GPROJT_CHECK(!gproji_retake(&heap, block, 5, SIZE_MAX / 8, sizeof(double)));
        GPROJT_CHECK(!gproji_retake(&heap, block, 5, SIZE_MAX / 8 + 2, sizeof(double))); /* the product wraps around */
        GPROJT_CHECK(!limited || !gproji_retake(&heap, block, 5, 126, sizeof(double)));
        GPROJT_CHECK(!limited || !gproji_take(&heap, 961, 1));
        GPROJT_CHECK(counted.calls == 1 && heap.account.used == 40);
        heap.account.used += SIZE_MAX / 2; /* bytes held that leave no room for more */
        GPROJT_CHECK(!gproji_take(&heap, 1, 1) && counted.calls == 1);
        heap.account.used = 40;
        gproji_pool_start(&pool, &heap);
        for (size = 1; size <= 4096; size *= 4) {
            GPROJT_CHECK(!gproji_pool_take(&pool, -1, size) && pool.failed);
            gproji_pool_give_all(&pool);
            GPROJT_CHECK(!gproji_pool_take(&pool, INT64_MAX, size) && pool.failed);
            gproji_pool_give_all(&pool);
        }
        GPROJT_CHECK(counted.calls == 1 && heap.account.used == 40 && !pool.failed);
        block = (double *)gproji_retake(&heap, block, 5, 125, sizeof(double));
        GPROJT_REQUIRE(block && heap.account.used == 1000 && block[0] == 0 && block[4] == 0);
        gproji_give(&heap, block, 125, sizeof(double));
        GPROJT_CHECK(heap.account.used == 0 && heap.account.peak == 1000);
        GPROJT_CHECK(counted.held == 0 && counted.wrong_sizes == 0);
    }
}

int main(void) {
    GPROJT_RUN(blocks);
    GPROJT_RUN(blocks_that_are_copied);
    GPROJT_RUN(foretold_bytes);
    GPROJT_RUN(arenas);
    GPROJT_RUN(vertices_and_corners);
    GPROJT_RUN(texts);
    GPROJT_RUN(subdivision);
    GPROJT_RUN(dual_and_diagonals);
    GPROJT_RUN(edits);
    GPROJT_RUN(curves);
    GPROJT_RUN(supports);
    GPROJT_RUN(matrices);
    GPROJT_RUN(variables);
    GPROJT_RUN(corners);
    GPROJT_RUN(rows_and_terms);
    GPROJT_RUN(rows_together);
    GPROJT_RUN(terms_in_common);
    return gprojt_report();
}
