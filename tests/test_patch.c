/* test_patch.c - >>fill from inside: the patterns for a patch against their equations, against a search of all numbers, and
   the quads that are built from them. */
#define GPROJ_STATIC
#include "gprojt.h"

enum {
    SIDES = GPROJI_PATCH_SIDES,
    MOST_VERTICES = 200
};

/* The next lengths of `sides` sides, from `least` to `most`, like an odometer. */
static bool next_lengths(int32_t sides, int32_t least, int32_t most, int32_t *length) {
    int32_t i;
    for (i = 0; i < sides && ++length[i] > most; ++i) length[i] = least;
    return i < sides;
}

static int32_t sum_of(int32_t count, const int32_t *value) {
    return count > 0 ? *value + sum_of(count - 1, value + 1) : 0;
}

static bool has_all_strips(const gproji_pattern *p) {
    int32_t i;
    for (i = 0; i < p->sides; ++i)
        if (p->strip[i] < 1) return false;
    return true;
}

/* Edges of the core from corner i to corner i + 1: corners at node 0, those right of the path, at the last node, and those
   on its left, back to the first. Rows lie beside side 0. */
static void core_lengths(const gproji_pattern *p, int32_t *core) {
    int32_t column[SIDES + 1] = {0}, at[SIDES + 1], n = 0, i;
    for (i = 0; i < p->edges; ++i) column[i + 1] = column[i] + p->edge[i];
    for (i = 0; i < p->end[0]; ++i) at[n++] = 0;
    for (i = 1; i < p->edges; ++i)
        if (p->below >> (i - 1) & 1) at[n++] = column[i];
    for (i = 0; i < p->end[1]; ++i) at[n++] = column[p->edges];
    for (i = p->edges - 1; i > 0; --i)
        if (!(p->below >> (i - 1) & 1)) at[n++] = column[i];
    at[n] = 0;
    GPROJT_CHECK(n == p->sides);
    for (i = 0; i < p->sides; ++i) core[i] = abs(at[i + 1] - at[i]) + (i == 0 ? 2 * p->rows : 0);
}

/* l_i = core edges + k_(i-1) + k_(i+1), by the pattern's own sides. */
static bool solves(const gproji_pattern *p, const int32_t *length) {
    int32_t core[SIDES], n = p->sides, i;
    core_lengths(p, core);
    for (i = 0; i < n; ++i) {
        if (p->strip[i] < 0 ||
            length[(i + p->first) % n] != core[i] + p->strip[(i + n - 1) % n] + p->strip[(i + 1) % n])
            return false;
    }
    for (i = 0; i < p->edges; ++i)
        if (p->edge[i] < 1) return false;
    return p->rows >= 0;
}

/* The quads are a disk with the loop around it, each side as long as asked. */
static bool is_disk(const gproji_patch *patch, const gproji_pattern *p, const int32_t *length) {
    static unsigned char edge[MOST_VERTICES][MOST_VERTICES]; /* half-edges by their ends */
    int32_t n = patch->vertices, around = 0, edges = 0, boundary = 0, quads = (int32_t)patch->quad.count / 4, i, j;
    size_t q;
    if (n > MOST_VERTICES) return false;
    memset(edge, 0, sizeof edge);
    for (q = 0; q < patch->quad.count; ++q) {
        int32_t a = patch->quad.data[q], b = patch->quad.data[q % 4 == 3 ? q - 3 : q + 1];
        if (a < 0 || b < 0 || a >= n || b >= n || edge[a][b]++) return false;
    }
    for (i = 0; i < n; ++i)
        for (j = 0; j < n; ++j) {
            if (edge[i][j] && !edge[j][i]) ++boundary;
            edges += i < j && (edge[i][j] || edge[j][i]);
        }
    for (i = 0; i < p->sides; ++i) {
        if (patch->edges[i] != length[(i + p->first) % p->sides]) return false;
        around += patch->edges[i];
    }
    if ((int32_t)patch->loop.count != around || boundary != around || n - edges + quads != 1) return false;
    for (i = 0; i < around; ++i) {
        int32_t a = patch->loop.data[i], b = patch->loop.data[(i + 1) % around];
        if (!edge[a][b] || edge[b][a]) return false;
    }
    for (i = 0; i < n; ++i) {
        int32_t faces = 0;
        for (j = 0; j < n; ++j) faces += edge[i][j];
        if (faces != patch->uses[i]) return false;
    }
    return true;
}

/* With all strips, an end with 1, 2, 3 corners has valence 3, 4, 5, nodes between have 5; thick ends are two vertices. */
static bool has_its_valences(const gproji_patch *patch, const gproji_pattern *p) {
    int32_t wanted[9] = {0}, found[9] = {0}, i, k;
    bool outer[MOST_VERTICES] = {false};
    for (i = 0; i < (int32_t)patch->loop.count; ++i) outer[patch->loop.data[i]] = true;
    for (i = 0; i < patch->vertices; ++i)
        if (!outer[i]) ++found[gproji_min(patch->uses[i], 8)];
    if (p->edges == 0) {
        ++wanted[p->sides];
    } else {
        ++wanted[p->end[0] + 2], ++wanted[p->end[1] + 2];
        wanted[5] += p->edges - 1;
    }
    for (k = 3; k < 9; ++k)
        if (k != 4 && found[k] != wanted[k]) return false;
    return true;
}

/* Builds the pattern, in a ring or not; without some strips it may be no disk, which the library then refuses. */
static bool is_built(gproji_heap *heap, gproji_pattern *p, const int32_t *length, bool ring) {
    gproji_patch patch;
    bool right;
    p->ring = ring;
    right = gproji_build_patch(&patch, heap, p, length);
    if (has_all_strips(p)) right = right && is_disk(&patch, p, length) && (ring || has_its_valences(&patch, p));
    gproji_pool_give_all(&patch.pool);
    return right;
}

GPROJT_TEST(patterns_solve_their_equations) {
    static const int32_t least[SIDES + 1] = {0, 0, 1, 1, 1, 1, 2}, most[SIDES + 1] = {0, 0, 9, 7, 5, 4, 4};
    static gproji_candidates c;
    gproji_heap heap = gproji_heap_of(NULL);
    int32_t sides, i, found[SIDES + 1] = {0}, whole = 0, rows = 0;
    for (sides = 2; sides <= SIDES; ++sides) {
        int32_t length[SIDES];
        for (i = 0; i < sides; ++i) length[i] = least[sides];
        do {
            if (sum_of(sides, length) % 2) continue;
            gproji_find_patterns(&c, sides, length);
            for (i = 0; i < c.count; ++i) {
                gproji_pattern *p = &c.pattern[i];
                GPROJT_CHECK(solves(p, length));
                GPROJT_CHECK(i == 0 || p->cost >= p[-1].cost);
                GPROJT_CHECK(is_built(&heap, p, length, false) && is_built(&heap, p, length, true));
                found[sides]++, whole += has_all_strips(p), rows += has_all_strips(p) && p->rows > 0;
            }
        } while (next_lengths(sides, least[sides], most[sides], length));
        GPROJT_CHECK(found[sides] > 50);
    }
    GPROJT_CHECK(heap.account.used == 0);
    GPROJT_CHECK(whole > 500 && rows > 20);
}

/* -- all of them -- */

/* A kind of path without rows, turned so that its corner 0 is at a side of the patch. */
typedef struct kind {
    int32_t first, end[2], edges, below;
} kind;

/* The same path seen from its other end. */
static kind turned(kind k, int32_t sides) {
    kind t = k;
    int32_t j;
    t.end[0] = k.end[1], t.end[1] = k.end[0], t.below = 0, t.first = k.first + k.end[0];
    for (j = 0; j + 1 < k.edges; ++j) {
        if (k.below >> j & 1)
            ++t.first;
        else
            t.below |= 1 << (k.edges - 2 - j);
    }
    t.first %= sides;
    return t;
}

static int32_t times_offered(const gproji_candidates *c, kind k) {
    int32_t i, n = 0;
    for (i = 0; i < c->count; ++i) {
        const gproji_pattern *p = &c->pattern[i];
        n += p->first == k.first && p->end[0] == k.end[0] && p->end[1] == k.end[1] && p->edges == k.edges &&
             p->below == k.below && p->rows == 0;
    }
    return n;
}

/* Does a kind have numbers that solve the equations? All e_j are tried, and strips 0 and 1, which leave one choice for the
   others. */
static bool is_solvable(kind k, int32_t sides, const int32_t *length) {
    gproji_pattern p;
    int32_t most = 1, core[SIDES], first, second, i;
    memset(&p, 0, sizeof p);
    p.sides = sides, p.first = k.first, p.end[0] = k.end[0], p.end[1] = k.end[1], p.edges = k.edges, p.below = k.below;
    for (i = 0; i < sides; ++i) most = gproji_max(most, length[i]); /* nothing is longer than a side */
    for (i = 0; i < p.edges; ++i) p.edge[i] = 1;
    do {
        core_lengths(&p, core);
        for (first = 0; first <= most; ++first)
            for (second = 0; second <= most; ++second) {
                p.strip[0] = first, p.strip[1] = second;
                for (i = 1; i + 1 < sides; ++i)
                    p.strip[i + 1] = length[(i + k.first) % sides] - core[i] - p.strip[i - 1];
                if (solves(&p, length)) return true;
            }
    } while (next_lengths(p.edges, 1, most, p.edge));
    return false;
}

GPROJT_TEST(all_patterns_are_found) {
    static const int32_t longest[SIDES + 1] = {0, 0, 0, 6, 4, 3, 2};
    static gproji_candidates c;
    int32_t sides, solvable = 0;
    for (sides = 3; sides <= SIDES; ++sides) {
        int32_t length[SIDES] = {1, 1, 1, 1, 1, 1};
        do {
            kind k;
            if (sum_of(sides, length) % 2) continue;
            gproji_find_patterns(&c, sides, length);
            for (k.end[0] = 1; k.end[0] <= 3; k.end[0] += 2)
                for (k.end[1] = k.end[0]; k.end[1] <= 3; k.end[1] += 2) {
                    k.edges = sides - k.end[0] - k.end[1] + 1;
                    if (k.edges < 1 || k.edges > 3) continue;
                    for (k.first = 0; k.first < sides; ++k.first)
                        for (k.below = 0; k.below < 1 << (k.edges - 1); ++k.below) {
                            kind t = turned(k, sides);
                            bool self = memcmp(&t, &k, sizeof k) == 0, can = is_solvable(k, sides, length);
                            int32_t n = times_offered(&c, k);
                            if (!self && k.end[0] == k.end[1]) n += times_offered(&c, t);
                            if (n != can)
                                printf("  %d sides %d %d %d %d %d %d: ends %d %d, below %d, first %d: %d not %d\n",
                                       (int)sides, (int)length[0], (int)length[1], (int)length[2], (int)length[3],
                                       (int)length[4], (int)length[5], (int)k.end[0], (int)k.end[1], (int)k.below,
                                       (int)k.first, (int)n, (int)can);
                            GPROJT_CHECK(n == can);
                            solvable += can;
                        }
                }
        } while (next_lengths(sides, 1, longest[sides], length));
    }
    GPROJT_CHECK(solvable > 300);
}

/* The path with rows, strips 1 and n - 1 as thin as can be, is found with all strips whenever there is one. */
static bool has_rows(int32_t sides, int32_t first, const int32_t *length, int32_t least) {
    gproji_pattern p;
    int32_t i, sum;
    memset(&p, 0, sizeof p);
    p.sides = sides, p.first = first, p.end[0] = p.end[1] = 1, p.edges = sides - 1;
    for (i = 0; i < sides; ++i) p.strip[i] = least;
    do {
        for (i = 1, sum = 0; i < sides; ++i) { /* the edges of side i are those of the path, from its end */
            int32_t edge = length[(i + first) % sides] - p.strip[i - 1] - p.strip[(i + 1) % sides];
            p.edge[sides - 1 - i] = edge, sum += edge;
        }
        p.rows = (length[first] - sum - p.strip[sides - 1] - p.strip[1]) / 2;
        if (solves(&p, length)) return true;
        for (i = 0; i < sides; ++i) {
            if (i == 1 || i == sides - 1) continue;
            if (++p.strip[i] <= 4) break;
            p.strip[i] = least;
        }
    } while (i < sides);
    return false;
}

GPROJT_TEST(patterns_with_rows_are_found) {
    static const int32_t longest[SIDES + 1] = {0, 0, 12, 8, 4, 4, 3};
    static gproji_candidates c;
    int32_t sides, i, first, with = 0;
    for (sides = 2; sides <= SIDES; ++sides) {
        int32_t length[SIDES] = {1, 1, 1, 1, 1, 1};
        do {
            if (sum_of(sides, length) % 2) continue;
            gproji_find_patterns(&c, sides, length);
            for (first = 0; first < sides; ++first) {
                bool found = false;
                if (sides == 2 && length[first] < length[1 - first]) continue;
                for (i = 0; i < c.count; ++i)
                    found |= c.pattern[i].first == first && c.pattern[i].edges == sides - 1 &&
                             c.pattern[i].end[0] == 1 && has_all_strips(&c.pattern[i]);
                if (has_rows(sides, first, length, 1)) {
                    if (!found)
                        printf("  %d sides %d %d %d %d, first %d\n", (int)sides, (int)length[0], (int)length[1],
                               (int)length[2], (int)length[3], (int)first);
                    GPROJT_CHECK(found);
                    ++with;
                }
            }
        } while (next_lengths(sides, 1, longest[sides], length));
    }
    GPROJT_CHECK(with > 100);
}

/* With five sides it may have to do without some strips, which is found then where strips that grow evenly do: in three
   quarters of all cases with up to 6 edges on a side. */
GPROJT_TEST(patterns_without_strips_are_found) {
    static gproji_candidates c;
    int32_t length[SIDES] = {1, 1, 1, 1, 1, 1}, i, first, all = 0, found = 0;
    do {
        if (sum_of(5, length) % 2) continue;
        gproji_find_patterns(&c, 5, length);
        for (first = 0; first < 5; ++first) {
            bool some = false;
            if (!has_rows(5, first, length, 1) && !has_rows(5, first, length, 0)) continue;
            for (i = 0; i < c.count; ++i)
                some |= c.pattern[i].first == first && c.pattern[i].edges == 4 && c.pattern[i].end[0] == 1;
            ++all, found += some;
        }
    } while (next_lengths(5, 1, 6, length));
    GPROJT_CHECK(all > 2000 && found > 0.74 * all);
}

/* In a path with rows the thinnest strips grow first: one that is thinner by two has edges of one beside it, where it could
   not grow. */
GPROJT_TEST(strips_of_paths_with_rows_are_even) {
    static const int32_t longest[SIDES + 1] = {0, 0, 1, 9, 7, 6, 5};
    static gproji_candidates c;
    int32_t sides, i, j, k, even = 0;
    for (sides = 4; sides <= SIDES; ++sides) {
        int32_t length[SIDES] = {1, 1, 1, 1, 1, 1};
        do {
            if (sum_of(sides, length) % 2) continue;
            gproji_find_patterns(&c, sides, length);
            for (k = 0; k < c.count; ++k) {
                const gproji_pattern *p = &c.pattern[k];
                if (p->edges != sides - 1 || p->end[0] != 1 || p->below || p->rows > 0) continue;
                for (i = 0; i < sides; ++i)
                    for (j = 0; j < sides; ++j) {
                        int32_t before = (j + sides - 1) % sides, after = (j + 1) % sides;
                        bool stuck = (before > 0 && p->edge[sides - 1 - before] < 2) ||
                                     (after > 0 && p->edge[sides - 1 - after] < 2);
                        if (i == 1 || i == sides - 1 || j == 1 || j == sides - 1 || p->strip[i] < p->strip[j] + 2)
                            continue;
                        GPROJT_CHECK(stuck);
                        ++even;
                    }
            }
        } while (next_lengths(sides, 1, longest[sides], length));
    }
    GPROJT_CHECK(even > 0);
}

/* Irregular vertices are far from the boundary and from each other: between two sides of n edges they divide the length
   into three parts. */
GPROJT_TEST(irregular_vertices_are_apart) {
    static gproji_candidates c;
    int32_t n, i, length[2];
    for (n = 8; n <= 40; ++n) {
        length[0] = length[1] = n;
        gproji_find_patterns(&c, 2, length);
        for (i = 0; i < c.count && c.pattern[i].edges != 1;) ++i;
        GPROJT_REQUIRE(i < c.count);
        GPROJT_CHECK(c.pattern[i].strip[0] == c.pattern[i].strip[1] && abs(c.pattern[i].strip[0] - n / 3) <= 1);
        GPROJT_CHECK(abs(c.pattern[i].edge[0] - n / 3) <= 2);
    }
}

/* -- distortion -- */

/* (|a|^2 + |b|^2 + lambda (1 + D^2)) / (2 X) with X = (D + sqrt(D^2 + epsilon^2)) / 2, as it is written. */
static double distortion(const double z[4], double epsilon) {
    double d = z[0] * z[3] - z[1] * z[2], x = (d + sqrt(d * d + epsilon * epsilon)) / 2;
    return (z[0] * z[0] + z[1] * z[1] + z[2] * z[2] + z[3] * z[3] + GPROJI_AREA_WEIGHT * (1 + d * d)) / (2 * x);
}

GPROJT_TEST(distortion_and_its_derivatives) {
    uint64_t seed = 7;
    int32_t round, i, j, turned = 0;
    for (round = 0; round < 200; ++round) {
        double z[4], g[4], h[4][4], epsilon = round % 4 ? 0.1 + gprojt_uniform(&seed) : 0, d, value, step = 1e-6;
        for (i = 0; i < 4; ++i) z[i] = 3 * gprojt_uniform(&seed) - 1.5;
        d = z[0] * z[3] - z[1] * z[2];
        if (fabs(d) < 0.05 || (epsilon == 0 && d < 0)) continue;
        value = gproji_corner_distortion(z, epsilon, g, h);
        turned += d < 0;
        GPROJT_NEAR(value, distortion(z, epsilon), 1e-9 * value);
        GPROJT_NEAR(gproji_corner_distortion(z, epsilon, NULL, NULL), value, 0);
        for (i = 0; i < 4; ++i) {
            double up[4], down[4], slope;
            memcpy(up, z, sizeof up), memcpy(down, z, sizeof down);
            up[i] += step, down[i] -= step;
            slope = (distortion(up, epsilon) - distortion(down, epsilon)) / (2 * step);
            GPROJT_NEAR(g[i], slope, 1e-4 * (1 + value));
            for (j = 0; j < 4; ++j) GPROJT_NEAR(h[i][j], h[j][i], 1e-12 * fabs(h[i][i]));
        }
        for (j = 0; j < 20; ++j) { /* the convex part is positive definite */
            double v[4], sum = 0;
            int32_t k;
            for (i = 0; i < 4; ++i) v[i] = gprojt_uniform(&seed) - 0.5;
            for (i = 0; i < 4; ++i)
                for (k = 0; k < 4; ++k) sum += v[i] * h[i][k] * v[k];
            GPROJT_CHECK(sum > 0);
        }
    }
    GPROJT_CHECK(turned > 20);
}

/* On which side of the line a b is c? Is c on the segment? */
static int32_t side_of(const double *xy, int32_t a, int32_t b, int32_t c) {
    double turn = (xy[2 * b] - xy[2 * a]) * (xy[2 * c + 1] - xy[2 * a + 1]) -
                  (xy[2 * b + 1] - xy[2 * a + 1]) * (xy[2 * c] - xy[2 * a]);
    return (turn > 0) - (turn < 0);
}
static bool is_on(const double *xy, int32_t a, int32_t b, int32_t c) {
    return side_of(xy, a, b, c) == 0 && (xy[2 * c] - xy[2 * a]) * (xy[2 * c] - xy[2 * b]) <= 0 &&
           (xy[2 * c + 1] - xy[2 * a + 1]) * (xy[2 * c + 1] - xy[2 * b + 1]) <= 0;
}

/* Segments between the points of a small grid, also without length, meet as they should: at an end of one on the other, or
   where each has its ends on both sides of the other one. */
GPROJT_TEST(segments_meet) {
    enum {
        N = 4
    };
    double xy[2 * N * N];
    int32_t i, a, b, c, d;
    for (i = 0; i < N * N; ++i) xy[2 * i] = i % N, xy[2 * i + 1] = i / N;
    for (a = 0; a < N * N; ++a)
        for (b = 0; b < N * N; ++b)
            for (c = 0; c < N * N; ++c)
                for (d = 0; d < N * N; ++d) {
                    bool touch = is_on(xy, a, b, c) || is_on(xy, a, b, d) || is_on(xy, c, d, a) || is_on(xy, c, d, b);
                    bool cross = side_of(xy, a, b, c) * side_of(xy, a, b, d) < 0 &&
                                 side_of(xy, c, d, a) * side_of(xy, c, d, b) < 0;
                    GPROJT_CHECK(gproji_segments_meet(xy, a, b, c, d) == (touch || cross));
                }
}

int main(void) {
    GPROJT_RUN(segments_meet);
    GPROJT_RUN(distortion_and_its_derivatives);
    GPROJT_RUN(patterns_solve_their_equations);
    GPROJT_RUN(all_patterns_are_found);
    GPROJT_RUN(patterns_with_rows_are_found);
    GPROJT_RUN(patterns_without_strips_are_found);
    GPROJT_RUN(strips_of_paths_with_rows_are_even);
    GPROJT_RUN(irregular_vertices_are_apart);
    return gprojt_report();
}
