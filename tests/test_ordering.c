/* test_ordering.c - >>ordering, >>dissection and the choice between them, on graphs of many kinds: against an elimination
   of sets of bits, separators against the graph, on what meshes cost. */
#define GPROJ_STATIC
#include "gprojt.h"

/* -- graphs, as unions of cliques -- */

typedef struct graph {
    gproji_graph view; /* for the library */
    int32_t total;
    int64_t *start;
    int32_t *adjacent, *weight;
    /* while it is built: cliques */
    int32_t nodes, count, cliques, room, clique_room, *member, *clique_end;
} graph;

static graph graph_of(int32_t nodes) {
    graph g;
    memset(&g, 0, sizeof g);
    g.nodes = nodes;
    return g;
}

static void graph_add(graph *g, int32_t count, const int32_t *member) {
    int32_t k;
    if (g->cliques == g->clique_room) {
        g->clique_room = 2 * g->clique_room + 64;
        g->clique_end = (int32_t *)realloc(g->clique_end, (size_t)g->clique_room * sizeof(int32_t));
    }
    if (g->count + count > g->room) {
        g->room = 2 * g->room + count + 64;
        g->member = (int32_t *)realloc(g->member, (size_t)g->room * sizeof(int32_t));
    }
    for (k = 0; k < count; ++k) g->member[g->count++] = member[k];
    g->clique_end[g->cliques++] = g->count;
}

static void graph_edge(graph *g, int32_t a, int32_t b) {
    int32_t pair[2];
    pair[0] = a, pair[1] = b;
    if (a != b) graph_add(g, 2, pair);
}

/* Adjacency from the cliques; all weights are `weight`. */
static void graph_finish(graph *g, int32_t weight) {
    int32_t n = g->nodes, i, k, c, *of = (int32_t *)malloc(((size_t)g->count + 1) * sizeof(int32_t));
    int32_t *mark = (int32_t *)malloc(((size_t)n + 1) * sizeof(int32_t));
    int64_t *first = (int64_t *)calloc((size_t)n + 2, sizeof(int64_t)), e, count = 0, room = 64;
    for (k = 0; k < g->count; ++k) first[g->member[k] + 2]++;
    for (i = 0; i < n; ++i) first[i + 2] += first[i + 1];
    for (c = 0, k = 0; c < g->cliques; ++c)
        for (; k < g->clique_end[c]; ++k) of[first[g->member[k] + 1]++] = c;
    g->start = (int64_t *)calloc((size_t)n + 1, sizeof(int64_t));
    g->adjacent = (int32_t *)malloc((size_t)room * sizeof(int32_t));
    g->weight = (int32_t *)malloc(((size_t)n + 1) * sizeof(int32_t));
    for (i = 0; i < n; ++i) mark[i] = -1;
    for (i = 0; i < n; ++i) {
        mark[i] = i;
        for (e = first[i]; e < first[i + 1]; ++e)
            for (k = of[e] ? g->clique_end[of[e] - 1] : 0; k < g->clique_end[of[e]]; ++k) {
                if (mark[g->member[k]] == i) continue;
                mark[g->member[k]] = i;
                if (count == room) {
                    room *= 2;
                    g->adjacent = (int32_t *)realloc(g->adjacent, (size_t)room * sizeof(int32_t));
                }
                g->adjacent[count++] = g->member[k];
            }
        g->start[i + 1] = count;
        g->weight[i] = weight;
    }
    free(of), free(mark), free(first), free(g->member), free(g->clique_end);
    g->member = g->clique_end = NULL;
    g->view.nodes = n, g->view.start = g->start, g->view.adjacent = g->adjacent, g->view.weight = g->weight;
}

static void graph_weigh(graph *g) {
    int32_t i;
    for (g->total = 0, i = 0; i < g->nodes; ++i) g->total += g->weight[i];
}

static void graph_free(graph *g) { free(g->start), free(g->adjacent), free(g->weight), memset(g, 0, sizeof *g); }

/* Faces of a grid of nx x ny vertices with 4 corners, wrapped around in x and y or not. */
static void add_quads(graph *g, int32_t nx, int32_t ny, bool wrap_x, bool wrap_y) {
    int32_t x, y, v[4];
    for (y = 0; y < (wrap_y ? ny : ny - 1); ++y)
        for (x = 0; x < (wrap_x ? nx : nx - 1); ++x) {
            v[0] = y * nx + x, v[1] = y * nx + (x + 1) % nx;
            v[2] = (y + 1) % ny * nx + (x + 1) % nx, v[3] = (y + 1) % ny * nx + x;
            graph_add(g, 4, v);
        }
}

static graph quads(int32_t nx, int32_t ny, bool wrap_x, bool wrap_y) {
    graph g = graph_of(nx * ny);
    add_quads(&g, nx, ny, wrap_x, wrap_y);
    graph_finish(&g, 3);
    graph_weigh(&g);
    return g;
}

/* A mesh that stands: beside the vertices a force in each edge, with all that is around the edge's ends. */
static graph statics(int32_t n) {
    graph g = graph_of(3 * n * n);
    int32_t x, y, k, star[9], v = n * n;
    add_quads(&g, n, n, false, false);
    for (y = 1; y < n - 1; ++y)
        for (x = 1; x < n - 1; ++x) {
            static const int32_t step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
            star[0] = y * n + x;
            for (k = 0; k < 4; ++k) {
                int32_t other = star[0] + step[k][0] + n * step[k][1], end = k < 2 ? star[0] : other;
                star[1 + k] = other, star[5 + k] = v + 2 * end + k % 2;
            }
            graph_add(&g, 9, star);
        }
    graph_finish(&g, 3);
    for (k = n * n; k < g.nodes; ++k) g.weight[k] = 1;
    graph_weigh(&g);
    return g;
}

enum {
    EMPTY,
    ONE,
    ISOLATED,
    PATH,
    STAR,
    TREE,
    CLIQUE,
    CLIQUES, /* of 30, not joined */
    RING_OF_CLIQUES,
    BIPARTITE, /* complete, 20 nodes on one side */
    RANDOM,
    RANDOM_DENSE,
    HUB,       /* a grid and a node next to all */
    TWO_GRIDS, /* and nodes without neighbours */
    GRID,
    STRIP,
    TORUS,
    TRIANGLES,
    HEXAGONS,
    CUBES,   /* in space */
    NORMALS, /* a grid and a node for each face */
    FORCES,
    SHUFFLED, /* a torus whose nodes have random numbers, and weights from 1 to 9 */
    KINDS
};

static graph irregular(int32_t kind, int32_t n) {
    graph g = graph_of(kind == EMPTY ? 0 : kind == ONE ? 1 : n);
    int32_t k, j, *all = (int32_t *)malloc(((size_t)n + 1) * sizeof(int32_t));
    uint64_t seed = 5;
    for (k = 0; k < n; ++k) all[k] = k;
    for (k = 1; k < n; ++k) {
        if (kind == PATH) graph_edge(&g, k - 1, k);
        if (kind == STAR) graph_edge(&g, 0, k);
        if (kind == TREE) graph_edge(&g, gprojt_below(&seed, k), k);
        if (kind == BIPARTITE)
            for (j = 0; j < 20 && k >= 20; ++j) graph_edge(&g, j, k);
        if (kind == RANDOM || kind == RANDOM_DENSE)
            for (j = 0; j < (kind == RANDOM ? 2 : 20); ++j)
                graph_edge(&g, gprojt_below(&seed, n), gprojt_below(&seed, n));
    }
    if (kind == CLIQUE) graph_add(&g, n, all);
    for (k = 0; (kind == CLIQUES || kind == RING_OF_CLIQUES) && k < n; k += 30) {
        graph_add(&g, gproji_min(30, n - k), all + k);
        if (kind == RING_OF_CLIQUES) graph_edge(&g, k, (k + 30) % n);
    }
    free(all);
    graph_finish(&g, 3);
    graph_weigh(&g);
    return g;
}

static graph of_cubes(int32_t n) {
    graph g = graph_of(n * n * n);
    int32_t v;
    for (v = 0; v < n * n * n; ++v) {
        if (v % n < n - 1) graph_edge(&g, v, v + 1);
        if (v / n % n < n - 1) graph_edge(&g, v, v + n);
        if (v / n / n < n - 1) graph_edge(&g, v, v + n * n);
    }
    graph_finish(&g, 1);
    graph_weigh(&g);
    return g;
}

/* A grid of n x n vertices and more. */
static graph on_grid(int32_t kind, int32_t n) {
    graph g = graph_of(n * n + (kind == HUB ? 1 : kind == TWO_GRIDS ? 10 : kind == NORMALS ? (n - 1) * (n - 1) : 0));
    int32_t x, y, k, v[6];
    if (kind == HUB || kind == NORMALS) add_quads(&g, n, n, false, false);
    if (kind == TWO_GRIDS) add_quads(&g, n, n / 2, false, false);
    for (k = 0; kind == HUB && k < n * n; ++k) graph_edge(&g, k, n * n);
    for (y = 0; y < n - 1; ++y)
        for (x = 0; x < n - 1; ++x) {
            v[0] = y * n + x, v[1] = v[0] + 1, v[2] = v[0] + n + 1, v[3] = v[0] + n;
            if (kind == TRIANGLES) {
                graph_add(&g, 3, v);
                v[1] = v[2], v[2] = v[3];
                graph_add(&g, 3, v);
            }
            v[4] = n * n + y * (n - 1) + x;
            if (kind == NORMALS) graph_add(&g, 5, v);
            if (kind != HEXAGONS || x + 2 >= n || (x + y) % 2) continue;
            v[2] = v[0] + 2, v[4] = v[0] + n + 1, v[5] = v[0] + n + 2;
            graph_add(&g, 6, v);
        }
    graph_finish(&g, 3);
    graph_weigh(&g);
    return g;
}

/* The same graph with other numbers, and weights from 1 to 9. */
static graph shuffled(graph g) {
    graph h = graph_of(g.nodes);
    int32_t i, *name = (int32_t *)malloc(((size_t)g.nodes + 1) * sizeof(int32_t));
    int64_t e;
    uint64_t seed = 9;
    for (i = 0; i < g.nodes; ++i) name[i] = i;
    for (i = g.nodes - 1; i > 0; --i) {
        int32_t other = gprojt_below(&seed, i + 1), t = name[i];
        name[i] = name[other], name[other] = t;
    }
    for (i = 0; i < g.nodes; ++i)
        for (e = g.start[i]; e < g.start[i + 1]; ++e)
            if (g.adjacent[e] > i) graph_edge(&h, name[i], name[g.adjacent[e]]);
    graph_finish(&h, 1);
    for (i = 0; i < h.nodes; ++i) h.weight[i] = 1 + gprojt_below(&seed, 9);
    graph_weigh(&h);
    graph_free(&g), free(name);
    return h;
}

/* A graph of about n nodes. */
static graph make(int32_t kind, int32_t n) {
    int32_t side = (int32_t)sqrt((double)n + 0.5);
    switch (kind) {
    case GRID: return quads(side, side, false, false);
    case STRIP: return quads(n / 4 + 2, 4, false, false);
    case TORUS: return quads(side + 1, side, true, true);
    case CUBES: return of_cubes((int32_t)cbrt((double)n + 0.5));
    case FORCES: return statics((int32_t)sqrt(n / 3.0) + 2);
    case SHUFFLED: return shuffled(quads(side + 1, side, true, true));
    case HUB:
    case TWO_GRIDS:
    case TRIANGLES:
    case HEXAGONS:
    case NORMALS: return on_grid(kind, kind == NORMALS ? (int32_t)sqrt(n / 2.0) + 2 : side + 1);
    default: return irregular(kind, n);
    }
}

/* -- checks -- */

static bool is_permutation(int32_t n, const int32_t *order) {
    unsigned char *seen = (unsigned char *)calloc((size_t)n + 1, 1);
    int32_t k;
    bool good = true;
    for (k = 0; k < n && good; ++k) {
        good = order[k] >= 0 && order[k] < n && !seen[order[k]];
        if (good) seen[order[k]] = 1;
    }
    free(seen);
    return good;
}

/* Sum of (column count)^2 over the variables, by elimination of sets of bits. */
static double naive_flops(const graph *g, const int32_t *order) {
    int32_t n = g->nodes, words = n / 64 + 1, i, j, k, w;
    uint64_t *set = (uint64_t *)calloc((size_t)n * (size_t)words + 1, sizeof(uint64_t));
    uint64_t *alive = (uint64_t *)calloc((size_t)words, sizeof(uint64_t));
    double flops = 0;
    int64_t e;
    for (i = 0; i < n; ++i) {
        alive[i / 64] |= (uint64_t)1 << i % 64;
        for (e = g->start[i]; e < g->start[i + 1]; ++e)
            set[(size_t)i * (size_t)words + (size_t)(g->adjacent[e] / 64)] |= (uint64_t)1 << g->adjacent[e] % 64;
    }
    for (k = 0; k < n; ++k) {
        uint64_t *own = set + (size_t)order[k] * (size_t)words;
        double below = 0;
        alive[order[k] / 64] &= ~((uint64_t)1 << order[k] % 64);
        for (w = 0; w < words; ++w) own[w] &= alive[w];
        for (j = 0; j < n; ++j) {
            uint64_t *other = set + (size_t)j * (size_t)words;
            if (!(own[j / 64] >> j % 64 & 1)) continue;
            below += g->weight[j];
            for (w = 0; w < words; ++w) other[w] |= own[w];
            other[j / 64] &= ~((uint64_t)1 << j % 64);
        }
        for (j = 0; j < g->weight[order[k]]; ++j) flops += (below + j + 1) * (below + j + 1);
    }
    free(set), free(alive);
    return flops;
}

/* The analysis with one of the orderings; the order of the nodes, if wanted. */
static gproj_cholesky_info analysed(const graph *g, gproj_ordering ordering, int32_t *order) {
    gproj_cholesky *c = gproj_cholesky_create(NULL);
    gproj_cholesky_info info;
    memset(&info, 0, sizeof info);
    if (!c) return info;
    GPROJT_CHECK(gproji_cholesky_analyse_blocks(c, &g->view, ordering) == GPROJ_OK);
    info = gproj_cholesky_get_info(c);
    if (order && g->nodes > 0) memcpy(order, c->symbolic.order, (size_t)g->nodes * sizeof(int32_t));
    gproj_cholesky_destroy(c);
    return info;
}

/* All kinds of graphs, small: the orders are orders, the flops are as many as the library says, and the best one is never
   worse than minimum degree, which never underestimates what it will cost (and overestimates where there are dense nodes). */
GPROJT_TEST(ordering_of_graphs) {
    static const int32_t size[] = {1, 2, 3, 7, 40, 70, 150, 400, 900};
    gproji_heap heap = gproji_heap_of(NULL);
    int32_t kind, k, o;
    for (kind = 0; kind < KINDS; ++kind)
        for (k = 0; k < (int32_t)(sizeof size / sizeof size[0]); ++k) {
            graph g = make(kind, size[k]);
            int32_t *order = (int32_t *)malloc(((size_t)g.nodes + 1) * sizeof(int32_t));
            double flops[3], bound = 0;
            for (o = GPROJ_ORDERING_BEST; o <= GPROJ_ORDERING_DISSECTION; ++o) {
                gproj_cholesky_info info = analysed(&g, (gproj_ordering)o, order);
                flops[o] = info.flops;
                GPROJT_CHECK(info.columns == g.total);
                GPROJT_CHECK(is_permutation(g.nodes, order));
                GPROJT_NEAR(flops[o] / fmax(naive_flops(&g, order), 1), g.nodes > 0, 1e-9);
            }
            if (kind != STAR && kind != HUB && kind != RANDOM_DENSE)
                GPROJT_CHECK(flops[GPROJ_ORDERING_BEST] <= flops[GPROJ_ORDERING_AMD]);
            GPROJT_CHECK(gproji_amd_order(&heap, &g.view, g.total, order, &bound));
            GPROJT_CHECK(bound >= naive_flops(&g, order) * (1 - 1e-9));
            if (kind != STAR && kind != HUB && kind != RANDOM_DENSE)
                GPROJT_CHECK(bound <= naive_flops(&g, order) * (1 + 1e-9));
            free(order);
            graph_free(&g);
        }
}

/* Layers of about equal width, of which one has many more nodes, or fewer: cuts beside it may leave a side empty. */
static graph layers(uint64_t *seed) {
    int32_t count = 4 + gprojt_below(seed, 30), width = 1 + gprojt_below(seed, 20), heavy = gprojt_below(seed, count);
    int32_t at[40], k, i, j, n = 0;
    graph g;
    for (k = 0; k < count; ++k) {
        at[k] = n;
        n += k == heavy ? 1 + gprojt_below(seed, 12) * width : width + gprojt_below(seed, 3);
    }
    at[count] = n;
    g = graph_of(n);
    for (k = 0; k < count; ++k)
        for (i = at[k]; i < at[k + 1]; ++i) {
            int32_t own = at[k + 1] - at[k], up = k + 1 < count ? at[k + 2] - at[k + 1] : 0;
            for (j = 0; j < 2 && up > 0; ++j) graph_edge(&g, i, at[k + 1] + ((i - at[k]) * up / own + j) % up);
            if (k > 0) graph_edge(&g, i, at[k - 1] + (i - at[k]) * (at[k] - at[k - 1]) / own);
            if (gprojt_below(seed, 4) == 0) graph_edge(&g, i, at[k] + gprojt_below(seed, own));
        }
    graph_finish(&g, 1 + gprojt_below(seed, 3));
    graph_weigh(&g);
    return g;
}

GPROJT_TEST(ordering_of_layers) {
    gproji_heap heap = gproji_heap_of(NULL);
    uint64_t seed = 13;
    int32_t k, order[4000];
    for (k = 0; k < 60; ++k) {
        graph g = layers(&seed);
        double amd = analysed(&g, GPROJ_ORDERING_AMD, NULL).flops, flops;
        GPROJT_REQUIRE(g.nodes <= 4000 && gproji_dissect(&heap, &g.view, g.total, order));
        GPROJT_CHECK(is_permutation(g.nodes, order));
        flops = analysed(&g, GPROJ_ORDERING_DISSECTION, order).flops;
        GPROJT_NEAR(flops / naive_flops(&g, order), 1, 1e-9);
        GPROJT_CHECK(analysed(&g, GPROJ_ORDERING_BEST, NULL).flops <= amd);
        graph_free(&g);
    }
}

/* What dissection costs, over minimum degree, and the better one of both; where dissection is sure to be good, the other
   one is not tried. */
GPROJT_TEST(ordering_of_large_graphs) {
    static const struct {
        int32_t kind, nodes;
        double dissected, best;
    } bound[] = {
        {ISOLATED, 20000, 1.01, 1}, {PATH, 20000, 2.6, 1},        {STAR, 20000, 1.1, 1},
        {TREE, 20000, 2.4, 1},      {CLIQUES, 20000, 1.01, 1},    {RANDOM, 2000, 3, 1},
        {HUB, 10000, 0.8, 0.8},     {TWO_GRIDS, 20000, 0.7, 0.7}, {GRID, 484, 0.9, 1},
        {GRID, 3481, 0.75, 0.75},   {GRID, 10000, 0.5, 0.5},      {GRID, 29929, 0.6, 0.6},
        {STRIP, 20000, 3, 1},       {SHUFFLED, 484, 1.1, 1},      {SHUFFLED, 10000, 0.6, 0.6},
        {TRIANGLES, 10000, 1, 1},   {HEXAGONS, 10000, 1.1, 1.06}, {CUBES, 8000, 0.7, 0.7},
        {NORMALS, 20000, 0.9, 0.9}, {FORCES, 30000, 0.7, 0.7},    {HUB, 1000, 0.7, 0.7},
    };
    int32_t k;
    for (k = 0; k < (int32_t)(sizeof bound / sizeof bound[0]); ++k) {
        graph g = make(bound[k].kind, bound[k].nodes);
        double amd = analysed(&g, GPROJ_ORDERING_AMD, NULL).flops;
        double ratio = analysed(&g, GPROJ_ORDERING_DISSECTION, NULL).flops / amd;
        double best = analysed(&g, GPROJ_ORDERING_BEST, NULL).flops / amd;
        if (!(ratio <= bound[k].dissected && best <= bound[k].best))
            printf("  kind %d, %d nodes: dissected %.3f, best %.3f\n", (int)bound[k].kind, (int)g.nodes, ratio, best);
        GPROJT_CHECK(ratio <= bound[k].dissected);
        GPROJT_CHECK(best <= bound[k].best);
        graph_free(&g);
    }
}

/* A node next to all that is the heaviest one, too, goes last and counts for nothing before. */
GPROJT_TEST(ordering_of_heavy_hubs) {
    graph g = make(HUB, 3600);
    int32_t *order = (int32_t *)malloc((size_t)g.nodes * sizeof(int32_t));
    gproji_heap heap = gproji_heap_of(NULL);
    double amd;
    g.weight[g.nodes - 1] = 8;
    graph_weigh(&g);
    GPROJT_REQUIRE(gproji_dissect(&heap, &g.view, g.total, order));
    GPROJT_CHECK(order[g.nodes - 1] == g.nodes - 1);
    amd = analysed(&g, GPROJ_ORDERING_AMD, NULL).flops;
    GPROJT_CHECK(analysed(&g, GPROJ_ORDERING_DISSECTION, NULL).flops < amd);
    free(order);
    graph_free(&g);
}

/* Leaves around a heavy node: the sums from which column counts come are beyond 32 bits, the counts are not. */
GPROJT_TEST(counts_of_heavy_stars) {
    enum {
        LEAVES = 1000,
        HEAVY = 4000000
    };
    graph g = graph_of(LEAVES + 1);
    double w = HEAVY;
    gproj_cholesky_info a;
    int32_t k;
    for (k = 0; k < LEAVES; ++k) graph_edge(&g, k, LEAVES);
    graph_finish(&g, 1);
    g.weight[LEAVES] = HEAVY;
    graph_weigh(&g);
    a = analysed(&g, GPROJ_ORDERING_NATURAL, NULL);
    GPROJT_NEAR(a.flops, LEAVES * (w + 1) * (w + 1) + w * (w + 1) * (2 * w + 1) / 6, 1e-12 * a.flops);
    graph_free(&g);
}

/* In units of the cube of a side's variables, a grid's factorisation takes about 17, whatever its size (George 1973: 20
   with cuts along the axes), that of a torus, whose first cut needs two lines, less than three times as many. */
GPROJT_TEST(ordering_of_grids) {
    static const int32_t size[] = {40, 80, 160};
    int32_t k;
    for (k = 0; k < 3; ++k) {
        graph open = quads(size[k], size[k], false, false), closed = quads(size[k], size[k], true, true);
        double unit = 27.0 * size[k] * size[k] * size[k];
        double a = analysed(&open, GPROJ_ORDERING_DISSECTION, NULL).flops / unit;
        double b = analysed(&closed, GPROJ_ORDERING_DISSECTION, NULL).flops / unit;
        printf("  %d x %d: %.1f n^3, closed %.1f n^3\n", (int)size[k], (int)size[k], a, b);
        GPROJT_CHECK(a < 18 && b < 50);
        graph_free(&open), graph_free(&closed);
    }
}

/* -- inside a dissection -- */

/* No node of a part that waits is next to another part's; its halo is what else is next to it, and it is complete. */
static void check_parts(const gproji_nd *nd, int32_t *part_of) {
    int32_t p, i, k;
    int64_t e;
    for (i = 0; i < nd->graph->nodes; ++i) part_of[i] = -1;
    for (p = 0; p < nd->parts; ++p)
        for (i = 0; i < nd->stack[p].nodes; ++i) part_of[nd->copy[nd->stack[p].copy].name[nd->stack[p].first + i]] = p;
    for (p = 0; p < nd->parts; ++p) {
        const gproji_nd_nodes *c = &nd->copy[nd->stack[p].copy];
        for (i = nd->stack[p].first; i < nd->stack[p].first + nd->stack[p].nodes; ++i) {
            int32_t name = c->name[i], inner = 0, outer = 0;
            for (e = nd->graph->start[name]; e < nd->graph->start[name + 1]; ++e) {
                int32_t other = nd->graph->adjacent[e];
                if (nd->kind[other] != GPROJI_ND_KEPT) continue;
                GPROJT_CHECK(part_of[other] == p || part_of[other] < 0);
                if (part_of[other] == p)
                    ++inner;
                else
                    ++outer;
            }
            GPROJT_CHECK(c->inner[i] == inner && c->outer[i] == outer && c->weight[i] == nd->graph->weight[name]);
            for (k = 0; k < inner + outer; ++k) {
                int32_t to = c->adjacent[c->from[i] + k];
                GPROJT_CHECK(part_of[k < inner ? c->name[nd->stack[p].first + to] : to] == (k < inner ? p : -1));
            }
        }
    }
}

/* Begins a dissection, whose memory end_dissection gives back. */
static bool begin_dissection(gproji_nd *nd, gproji_pool *pool, gproji_heap *heap, const graph *g) {
    *heap = gproji_heap_of(NULL);
    memset(nd, 0, sizeof *nd);
    nd->heap = heap, nd->graph = &g->view;
    gproji_pool_start(pool, heap);
    return gproji_nd_begin(nd, pool, g->total);
}

static void end_dissection(gproji_nd *nd, gproji_pool *pool, gproji_heap *heap) {
    gproji_give(heap, nd->band.block, nd->band.block_size, 1);
    gproji_pool_give_all(pool);
    GPROJT_CHECK(heap->account.used == 0);
}

GPROJT_TEST(dissection_separates) {
    static const int32_t kinds[] = {GRID, TORUS, HEXAGONS, SHUFFLED, TWO_GRIDS, RANDOM, FORCES, CUBES};
    int32_t k;
    for (k = 0; k < (int32_t)(sizeof kinds / sizeof kinds[0]); ++k) {
        graph g = make(kinds[k], 1200);
        gproji_heap heap;
        int32_t *part_of = (int32_t *)malloc(((size_t)g.nodes + 1) * sizeof(int32_t)), cuts = 0;
        gproji_pool pool;
        gproji_nd nd;
        GPROJT_REQUIRE(begin_dissection(&nd, &pool, &heap, &g));
        while (nd.parts > 0) {
            int32_t before = nd.parts;
            check_parts(&nd, part_of);
            gproji_nd_next(&nd);
            GPROJT_REQUIRE(!nd.failed);
            cuts += nd.parts > before;
        }
        GPROJT_CHECK(cuts > 4 || kinds[k] == RANDOM);
        end_dissection(&nd, &pool, &heap);
        free(part_of), graph_free(&g);
    }
}

/* -- inside a part: against plain searches -- */

/* The parts of a dissection are opened here as gproji_nd_next does, but not cut. */
static void open_part(gproji_nd *nd, const gproji_nd_part *part) {
    const gproji_nd_nodes *c = &nd->copy[part->copy];
    gproji_nd_nodes *here = &nd->here;
    gproji_nd_halo *halo = &nd->halo;
    int32_t i, k, at;
    *here = *c;
    here->name += part->first, here->weight += part->first, here->from += part->first, here->inner += part->first;
    here->outer += part->first, here->x += part->first, here->y += part->first;
    nd->nodes = part->nodes, nd->weight = 0;
    halo->boundaries = halo->count = 0, halo->weight = 0;
    for (i = 0; i < part->nodes; ++i) {
        int32_t *list = here->adjacent + here->from[i] + here->inner[i];
        nd->weight += here->weight[i];
        if (here->outer[i]) halo->boundary[halo->boundaries++] = i;
        for (k = 0; k < here->outer[i]; ++k) {
            for (at = 0; at < halo->count && halo->name[at] != list[k];) ++at;
            if (at == halo->count) {
                halo->name[halo->count++] = list[k];
                halo->weight += nd->graph->weight[list[k]];
            }
            list[k] = at;
        }
    }
}

/* Gives the neighbours in the halo their names again. */
static void close_part(gproji_nd *nd) {
    int32_t i, k;
    for (i = 0; i < nd->nodes; ++i)
        for (k = 0; k < nd->here.outer[i]; ++k) {
            int32_t *name = &nd->here.adjacent[nd->here.from[i] + nd->here.inner[i] + k];
            *name = nd->halo.name[*name];
        }
}

/* Weights by sides: of nodes (2: the separator), and of the halo next to sides 0 and 1. False if sides 0 and 1 touch. */
static bool weigh_sides(const gproji_nd *nd, const unsigned char *side, double weight[3], double beside[2]) {
    int32_t i, k, s;
    weight[0] = weight[1] = weight[2] = beside[0] = beside[1] = 0;
    for (i = 0; i < nd->nodes; ++i) {
        weight[side[i]] += nd->here.weight[i];
        for (k = 0; k < nd->here.inner[i]; ++k)
            if (side[i] + side[nd->here.adjacent[nd->here.from[i] + k]] == 1) return false;
    }
    for (s = 0; s < 2; ++s) {
        unsigned char *seen = (unsigned char *)calloc((size_t)nd->halo.count + 1, 1);
        for (i = 0; i < nd->nodes; ++i)
            for (k = 0; k < nd->here.outer[i] && side[i] == s; ++k) {
                int32_t at = nd->here.adjacent[nd->here.from[i] + nd->here.inner[i] + k];
                if (!seen[at]) beside[s] += nd->graph->weight[nd->halo.name[at]];
                seen[at] = 1;
            }
        free(seen);
    }
    return true;
}

/* One more unit of flow from the source to the sink, on a matrix of residual capacities. */
static bool augment(int32_t states, int32_t *room, int32_t *from, int32_t *queue) {
    int32_t head = 0, tail = 0, a, b;
    for (a = 0; a < states; ++a) from[a] = -1;
    queue[tail++] = 0, from[0] = 0;
    while (head < tail && from[1] < 0)
        for (a = queue[head++], b = 0; b < states; ++b)
            if (from[b] < 0 && room[a * states + b] > 0) from[b] = a, queue[tail++] = b;
    if (from[1] < 0) return false;
    for (b = 1; b != 0; b = a) a = from[b], room[a * states + b]--, room[b * states + a]++;
    return true;
}

/* The least weight of nodes in the band that separate its ends, in units: the largest flow. */
static int32_t largest_flow(const gproji_band *band) {
    int32_t states = 2 + 2 * band->nodes, i, c, flow = 0, enough = 1 << 20;
    int32_t *room = (int32_t *)calloc((size_t)states * (size_t)states, sizeof(int32_t));
    int32_t *from = (int32_t *)malloc(2 * (size_t)states * sizeof(int32_t));
    for (i = 0; i < band->nodes; ++i) {
        int32_t in = 2 + 2 * i, out = in + 1;
        room[in * states + out] = band->capacity[i];
        if (band->ends[i] & GPROJI_BAND_SOURCE) room[in] = enough;
        if (band->ends[i] & GPROJI_BAND_SINK) room[out * states + 1] = enough;
        for (c = band->start[i]; c < band->start[i + 1]; ++c) room[out * states + 2 + 2 * band->to[c]] = enough;
    }
    while (augment(states, room, from, from + states)) ++flow;
    free(room), free(from);
    return flow;
}

/* A random network, in one block of zeros: nodes at the source, nodes at the sink, capacities from 1 to 3. */
static gproji_band random_band(uint64_t *seed, int32_t *block) {
    gproji_band band;
    int32_t n = 3 + gprojt_below(seed, 20), arcs = n + gprojt_below(seed, 3 * n), i, k, e = 0;
    static bool near[32][32];
    memset(&band, 0, sizeof band), memset(near, 0, sizeof near), memset(block, 0, 4000 * sizeof *block);
    for (k = 0; k < arcs; ++k) {
        int32_t a = gprojt_below(seed, n), b = gprojt_below(seed, n);
        near[a][b] = near[b][a] = a != b;
    }
    band.nodes = n;
    band.start = block, band.capacity = block + 100, band.load = block + 200, band.level = block + 300;
    band.turn = block + 400, band.queue = block + 500, band.to = block + 900;
    band.ends = (unsigned char *)(block + 3000), band.mark = band.ends + 100;
    band.out = band.ends + 200, band.in = band.ends + 1500;
    for (i = 0; i < n; ++i) {
        band.start[i] = e;
        for (k = 0; k < n; ++k)
            if (near[i][k]) band.to[e++] = k;
        band.capacity[i] = 1 + gprojt_below(seed, 3);
        if (i < 1 + n / 6) band.ends[i] |= GPROJI_BAND_SOURCE;
        if (i >= n - 1 - n / 6) band.ends[i] |= GPROJI_BAND_SINK;
    }
    band.start[n] = e;
    return band;
}

/* Flows of the largest size, which keep to capacities and arcs, and lose nothing on the way. */
GPROJT_TEST(dissection_flows) {
    static int32_t block[4000];
    uint64_t seed = 2;
    int32_t tries, i, c, k;
    for (tries = 0; tries < 2000; ++tries) {
        gproji_band band = random_band(&seed, block);
        int32_t flow = 0;
        while (gproji_band_augment(&band)) continue;
        for (i = 0; i < band.nodes; ++i) {
            int32_t in = 0, out = 0;
            GPROJT_CHECK(band.load[i] >= 0 && band.load[i] <= band.capacity[i]);
            for (c = band.start[i]; c < band.start[i + 1]; ++c) {
                for (k = band.start[band.to[c]]; band.to[k] != i;) ++k;
                GPROJT_CHECK(band.out[c] == band.in[k]);
                in += band.in[c], out += band.out[c];
            }
            GPROJT_CHECK(band.ends[i] & GPROJI_BAND_SOURCE ? in <= band.load[i] : in == band.load[i]);
            GPROJT_CHECK(band.ends[i] & GPROJI_BAND_SINK ? out <= band.load[i] : out == band.load[i]);
            flow += band.load[i] - in;
        }
        GPROJT_CHECK(flow == largest_flow(&band));
    }
}

/* Whole units, exact if they are few. */
GPROJT_TEST(dissection_capacities) {
    int32_t divisor, largest, weight;
    for (divisor = 1; divisor < 40; ++divisor)
        for (largest = divisor; largest < 900; largest += divisor)
            for (weight = divisor; weight <= largest; weight += divisor) {
                int32_t units = gproji_band_capacity(weight, divisor, largest);
                if (largest <= GPROJI_BAND_UNITS * divisor)
                    GPROJT_CHECK(units * divisor == weight);
                else
                    GPROJT_CHECK(units >= 1 && units <= GPROJI_BAND_UNITS &&
                                 fabs(units - (double)weight * GPROJI_BAND_UNITS / largest) <= 1);
            }
}

/* The cut that was chosen: its weights are those counted here, and no separator in its band is lighter. */
static void check_cut(gproji_nd *nd, gproji_nd_cut *cut, unsigned char *side) {
    bool exact = nd->nodes >= GPROJI_ND_EXACT || nd->nodes > nd->kept / 2;
    double below = 0, low = 0, high = 0, weight[3] = {0, 0, 0}, beside[2], cost;
    int32_t i, k, units = 0;
    for (i = 0; i < nd->nodes; ++i) {
        bool lower = cut->coordinate[i] < cut->at, meets = false;
        for (k = 0; k < nd->here.inner[i]; ++k)
            meets |= (cut->coordinate[nd->here.adjacent[nd->here.from[i] + k]] < cut->at) != lower;
        below += lower ? nd->here.weight[i] : 0;
        *(lower ? &low : &high) += meets ? nd->here.weight[i] : 0;
    }
    GPROJT_NEAR(cut->below, below, 0);
    if (exact) {
        double s = fmin(low, high);
        GPROJT_NEAR(cut->separator, s, 0);
        for (i = 0; i < nd->nodes; ++i) side[i] = cut->coordinate[i] >= cut->at;
        for (i = 0; i < nd->halo.count; ++i) nd->number[i] = 0; /* sides next to the halo, as bits */
        beside[0] = beside[1] = 0;
        for (i = 0; i < nd->halo.boundaries; ++i) {
            int32_t v = nd->halo.boundary[i];
            for (k = 0; k < nd->here.outer[v]; ++k)
                nd->number[nd->here.adjacent[nd->here.from[v] + nd->here.inner[v] + k]] |= 1 << side[v];
        }
        for (i = 0; i < nd->halo.count; ++i)
            for (k = 0; k < 2; ++k)
                if (nd->number[i] >> k & 1) beside[k] += nd->graph->weight[nd->halo.name[i]];
        GPROJT_NEAR(cut->cost, gproji_nd_cost(nd, below - s / 2, nd->weight - below - s / 2, s, beside), 0);
    }
    cost = gproji_nd_separate(nd, cut, side);
    GPROJT_CHECK(cost < HUGE_VAL && weigh_sides(nd, side, weight, beside));
    GPROJT_NEAR(cost, gproji_nd_cost(nd, weight[0], weight[1], weight[2], beside), 0);
    for (i = 0; i < nd->band.nodes; ++i)
        if (side[nd->band.id[i]] == 2) units += nd->band.capacity[i];
    if (nd->band.nodes < 120) GPROJT_CHECK(units == largest_flow(&nd->band));
}

GPROJT_TEST(dissection_weighs_and_separates) {
    static const int32_t kinds[] = {GRID, TORUS, TRIANGLES, HEXAGONS, SHUFFLED, FORCES, STRIP};
    int32_t k, cuts = 0, small = 0;
    for (k = 0; k < (int32_t)(sizeof kinds / sizeof kinds[0]); ++k) {
        graph g = make(kinds[k], 1500);
        gproji_heap heap;
        unsigned char *side = (unsigned char *)malloc((size_t)g.nodes);
        gproji_pool pool;
        gproji_nd nd;
        GPROJT_REQUIRE(begin_dissection(&nd, &pool, &heap, &g));
        while (nd.parts > 0) {
            const gproji_nd_part part = nd.stack[nd.parts - 1];
            gproji_nd_cut cut = {HUGE_VAL, 0, 0, 0, 0, 0, NULL, NULL};
            if (part.nodes > GPROJI_ND_LEAF) {
                open_part(&nd, &part);
                if (gproji_nd_find_cut(&nd, &cut) == nd.nodes && cut.cost < HUGE_VAL) {
                    check_cut(&nd, &cut, side);
                    ++cuts, small += nd.band.nodes < 120;
                }
                close_part(&nd);
            }
            gproji_nd_next(&nd);
        }
        end_dissection(&nd, &pool, &heap);
        free(side), graph_free(&g);
    }
    GPROJT_CHECK(cuts > 100 && small > 50);
}

/* Small parts with halos: at each step the node of least degree, by weights and halo included, the first of equal ones. */
GPROJT_TEST(dissection_orders_leaves) {
    int32_t tries, n, i, j, k;
    uint64_t seed = 4;
    for (tries = 0; tries < 60; ++tries) {
        int32_t nodes = 2 + gprojt_below(&seed, GPROJI_ND_LEAF - 1), halos = gprojt_below(&seed, 150);
        graph g = graph_of(nodes + halos);
        static bool near[GPROJI_ND_LEAF + 150][GPROJI_ND_LEAF + 150];
        int32_t *part_of, order[GPROJI_ND_LEAF], edges = 3 * nodes;
        gproji_heap heap;
        gproji_pool pool;
        gproji_nd nd;
        gproji_nd_part part;
        bool alive[GPROJI_ND_LEAF];
        memset(near, 0, sizeof near);
        for (k = 0; k < edges; ++k) {
            i = gprojt_below(&seed, nodes), j = gprojt_below(&seed, nodes + halos);
            graph_edge(&g, i, j);
            near[i][j] = near[j][i] = i != j;
        }
        n = g.nodes;
        graph_finish(&g, 1);
        /* All weigh 3, or 3 and 4, where bits 0 and 1 are one plane, or anything. */
        for (i = 0; i < n; ++i)
            g.weight[i] = tries % 3 < 2 ? 3 + gprojt_below(&seed, 1 + tries % 3) : 1 + gprojt_below(&seed, 300);
        graph_weigh(&g);
        GPROJT_REQUIRE(begin_dissection(&nd, &pool, &heap, &g));
        /* The part is the first `nodes`, in the order of their names. */
        part_of = nd.copy[0].name;
        for (i = 0; i < nodes; ++i) {
            int64_t e;
            part_of[i] = i, nd.copy[0].weight[i] = g.weight[i], nd.copy[0].from[i] = g.start[i];
            nd.copy[0].inner[i] = nd.copy[0].outer[i] = 0;
            for (e = g.start[i]; e < g.start[i + 1]; ++e)
                if (g.adjacent[e] < nodes) nd.copy[0].adjacent[g.start[i] + nd.copy[0].inner[i]++] = g.adjacent[e];
            for (e = g.start[i]; e < g.start[i + 1]; ++e)
                if (g.adjacent[e] >= nodes)
                    nd.copy[0].adjacent[g.start[i] + nd.copy[0].inner[i] + nd.copy[0].outer[i]++] = g.adjacent[e];
        }
        memset(&part, 0, sizeof part);
        part.nodes = nodes;
        nd.stack[0] = part, nd.parts = 1, nd.kept = nodes, nd.unit = 1;
        gproji_nd_next(&nd);
        GPROJT_CHECK(nd.parts == 0 && is_permutation(nodes, nd.order));
        memcpy(order, nd.order, (size_t)nodes * sizeof *order);
        for (i = 0; i < nodes; ++i) alive[i] = true;
        for (k = 0; k < nodes; ++k) {
            int32_t best = -1;
            int64_t least = INT64_MAX;
            for (i = 0; i < nodes; ++i) {
                int64_t degree = 0;
                for (j = 0; j < n; ++j) degree += alive[i] && near[i][j] && (j >= nodes || alive[j]) ? g.weight[j] : 0;
                if (alive[i] && degree < least) least = degree, best = i;
            }
            GPROJT_CHECK(order[k] == best);
            alive[best] = false;
            for (i = 0; i < nodes; ++i)
                for (j = 0; j < n && near[best][i]; ++j) near[i][j] |= j != i && near[best][j];
        }
        end_dissection(&nd, &pool, &heap);
        graph_free(&g);
    }
}

/* The estimate solves its recursion: a separator of weight s = c sqrt(n) with the halo's rows, then twice a half. */
GPROJT_TEST(dissection_estimates) {
    gproji_nd nd;
    double n, h;
    memset(&nd, 0, sizeof nd);
    for (nd.unit = 0.5; nd.unit < 5; nd.unit *= 2)
        for (n = 100; n < 1e6; n *= 10)
            for (h = 0; h < 10 * nd.unit * sqrt(n); h += nd.unit * sqrt(n)) {
                double s = nd.unit * sqrt(n), own = s * h * h + s * s * h + s * s * s / 3;
                GPROJT_NEAR((own + 2 * gproji_nd_rest(&nd, n / 2, h / 2 + s)) / gproji_nd_rest(&nd, n, h), 1, 0.01);
            }
}

/* The first separator of a strip crosses it once; where a line of nodes is lighter, there. */
GPROJT_TEST(dissection_finds_smallest_separators) {
    int32_t width, light;
    for (width = 3; width < 12; ++width)
        for (light = 0; light < 2; ++light) {
            graph g = quads(60, width, false, false);
            int32_t *order = (int32_t *)malloc((size_t)g.nodes * sizeof(int32_t)), k, y;
            gproji_heap heap = gproji_heap_of(NULL);
            for (k = 0; k < g.nodes; ++k) g.weight[k] = light && k % 60 == 27 + width / 4 ? 2 : 3;
            graph_weigh(&g);
            GPROJT_REQUIRE(gproji_dissect(&heap, &g.view, g.total, order));
            for (k = g.nodes - width; k < g.nodes; ++k) {
                y = order[k] % 60;
                GPROJT_CHECK(light ? y == 27 + width / 4 : y >= 15 && y < 45);
            }
            free(order), graph_free(&g);
        }
}

/* Normals come first; forces come with the first of their two vertices. */
GPROJT_TEST(dissection_leaves_out) {
    enum {
        SIDE = 20,
        VERTICES = SIDE * SIDE,
        FACES = (SIDE - 1) * (SIDE - 1)
    };
    graph g = on_grid(NORMALS, SIDE);
    int32_t *order = (int32_t *)malloc((size_t)3 * VERTICES * sizeof(int32_t)), k, normals = 0;
    gproji_heap heap = gproji_heap_of(NULL);
    gproji_condensation condensed;
    GPROJT_REQUIRE(gproji_condense(&condensed, &heap, &g.view));
    GPROJT_CHECK(condensed.count == FACES && condensed.rest.nodes == VERTICES);
    for (k = 0; k < FACES; ++k) normals += condensed.first[k] >= VERTICES;
    GPROJT_CHECK(normals >= FACES - 4); /* a corner of the grid has no more neighbours than the normal there */
    gproji_pool_give_all(&condensed.pool);
    graph_free(&g);
    g = statics(SIDE);
    GPROJT_REQUIRE(gproji_dissect(&heap, &g.view, g.total, order));
    GPROJT_CHECK(is_permutation(g.nodes, order));
    for (k = 0; k < g.nodes; ++k) {
        int32_t edge = order[k] - VERTICES, next = k, from = edge / 2, to = from + (edge % 2 ? SIDE : 1);
        if (edge < 0 || from % SIDE < 3 || from % SIDE > SIDE - 4 || from / SIDE < 3 || from / SIDE > SIDE - 4)
            continue;
        while (order[next] >= VERTICES) ++next; /* other forces that go with the same vertex */
        GPROJT_CHECK(order[next] == from || order[next] == to);
        for (next = 0; next < k; ++next) GPROJT_CHECK(order[next] != from && order[next] != to);
    }
    free(order), graph_free(&g);
}

/* A grid's rim are its 4 (n - 1) nodes on the boundary; closed meshes have none, also if there is a light node in each edge. */
GPROJT_TEST(rims_of_meshes) {
    enum {
        N = 30
    };
    graph g = quads(N, N, false, false);
    int32_t x, y, k, v = N * N;
    GPROJT_NEAR(gproji_rim(&g.view), 16.0 * (N - 1) * (N - 1) / v, 1e-12);
    graph_free(&g);
    g = quads(N, N, true, true);
    GPROJT_CHECK(gproji_rim(&g.view) == 0);
    graph_free(&g);
    g = graph_of(3 * v);
    add_quads(&g, N, N, true, true);
    for (y = 0; y < N; ++y)
        for (x = 0; x < N; ++x)
            for (k = 0; k < 2; ++k) {
                int32_t edge[3] = {y * N + x, 0, v + 2 * (y * N + x) + k};
                edge[1] = k ? (y + 1) % N * N + x : y * N + (x + 1) % N;
                graph_add(&g, 3, edge);
            }
    graph_finish(&g, 3);
    for (k = v; k < g.nodes; ++k) g.weight[k] = 1;
    graph_weigh(&g);
    GPROJT_CHECK(gproji_rim(&g.view) == 0);
    graph_free(&g);
}

/* -- memory, determinism -- */

static bool dissect_with(const gproj_host *host, void *user) {
    const graph *g = (const graph *)user;
    gproji_heap heap = gproji_heap_of(host);
    int32_t *order = (int32_t *)malloc((size_t)g->nodes * sizeof(int32_t));
    bool done = gproji_dissect(&heap, &g->view, g->total, order);
    if (done) GPROJT_CHECK(is_permutation(g->nodes, order));
    GPROJT_CHECK(heap.account.used == 0);
    free(order);
    return done;
}

/* The whole analysis, by the better ordering: memory is all that may be missing. */
static bool analyse_with(const gproj_host *host, void *user) {
    const graph *g = (const graph *)user;
    gproj_cholesky *c = gproj_cholesky_create(host);
    gproj_code code = GPROJ_ERROR_MEMORY;
    if (c) code = gproji_cholesky_analyse_blocks(c, &g->view, GPROJ_ORDERING_BEST);
    GPROJT_CHECK(code == GPROJ_OK || code == GPROJ_ERROR_MEMORY);
    if (code == GPROJ_OK) GPROJT_CHECK(is_permutation(g->nodes, c->symbolic.order));
    gproj_cholesky_destroy(c);
    return code == GPROJ_OK;
}

/* Grids of n x n nodes, each joined to the next by an edge. */
static graph chain(int32_t grids, int32_t n) {
    graph g = graph_of(grids * n * n);
    int32_t v;
    for (v = 0; v < g.nodes; ++v) {
        if (v % n < n - 1) graph_edge(&g, v, v + 1);
        if (v / n % n < n - 1) graph_edge(&g, v, v + n);
        if (v % (n * n) == n * n - 1 && v + 1 < g.nodes) graph_edge(&g, v, v + 1);
    }
    graph_finish(&g, 3);
    graph_weigh(&g);
    return g;
}

GPROJT_TEST(ordering_every_allocation_fails) {
    graph g = make(GRID, 900);
    GPROJT_CHECK(gprojt_fail_every_allocation(dissect_with, &g) >= 36);
    graph_free(&g);
    g = chain(16, 12); /* the first cuts are small, so that memory for others is taken later */
    GPROJT_CHECK(gprojt_fail_every_allocation(dissect_with, &g) >= 36);
    graph_free(&g);
    g = make(RANDOM_DENSE, 300); /* without a separator */
    GPROJT_CHECK(gprojt_fail_every_allocation(dissect_with, &g) >= 50);
    graph_free(&g);
    g = make(GRID, 2500); /* dissected at once, by the forecast */
    GPROJT_CHECK(gprojt_fail_every_allocation(analyse_with, &g) >= 36);
    graph_free(&g);
    g = make(RANDOM, 700); /* after minimum degree, which takes many flops */
    GPROJT_CHECK(gprojt_fail_every_allocation(analyse_with, &g) >= 36);
    graph_free(&g);
}

/* A host whose memory is never zero by itself. */
static void *soiled(void *user, size_t size) {
    void *block = malloc(size);
    if (block) memset(block, *(const unsigned char *)user, size);
    return block;
}
static void release(void *user, void *block, size_t size) {
    (void)user, (void)size;
    free(block);
}

/* The same input gives the same order, whatever was in memory before. */
GPROJT_TEST(ordering_is_deterministic) {
    int32_t kind;
    for (kind = 0; kind < KINDS; ++kind) {
        graph g = make(kind, 1500);
        size_t bytes = (size_t)g.nodes * sizeof(int32_t);
        int32_t *order[3], k;
        for (k = 0; k < 3; ++k) {
            static unsigned char soil[3] = {0, 0xff, 0x5a};
            gproj_host host;
            gproji_heap heap;
            memset(&host, 0, sizeof host);
            host.allocator.allocate = soiled, host.allocator.release = release, host.allocator.user = &soil[k];
            heap = gproji_heap_of(&host);
            order[k] = (int32_t *)malloc(bytes + 4);
            GPROJT_REQUIRE(gproji_dissect(&heap, &g.view, g.total, order[k]));
            GPROJT_CHECK(memcmp(order[0], order[k], bytes) == 0);
        }
        free(order[0]), free(order[1]), free(order[2]);
        graph_free(&g);
    }
}

int main(void) {
    GPROJT_RUN(ordering_of_graphs);
    GPROJT_RUN(ordering_of_layers);
    GPROJT_RUN(ordering_of_large_graphs);
    GPROJT_RUN(ordering_of_heavy_hubs);
    GPROJT_RUN(counts_of_heavy_stars);
    GPROJT_RUN(ordering_of_grids);
    GPROJT_RUN(dissection_separates);
    GPROJT_RUN(dissection_flows);
    GPROJT_RUN(dissection_capacities);
    GPROJT_RUN(dissection_weighs_and_separates);
    GPROJT_RUN(dissection_orders_leaves);
    GPROJT_RUN(dissection_estimates);
    GPROJT_RUN(dissection_finds_smallest_separators);
    GPROJT_RUN(dissection_leaves_out);
    GPROJT_RUN(rims_of_meshes);
    GPROJT_RUN(ordering_every_allocation_fails);
    GPROJT_RUN(ordering_is_deterministic);
    return gprojt_report();
}
