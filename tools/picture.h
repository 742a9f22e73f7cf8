/* picture.h - a mesh as an SVG picture, for the command line and the examples.

       gprojx_picture_options options = {0};
       options.title = "roof.obj";
       options.face_value = planarity;                          one number a face, coloured on a logarithmic scale
       if (gprojx_picture(file, mesh, &options) != GPROJ_OK) ...

   Faces are painted from back to front. The order comes from comparing, exactly, every two faces that overlap on
   the picture (found by a grid), and a topological order of all these comparisons [after Newell, Newell, Sancha
   1972]; faces that pass through each other, or overlap in a cycle, are cut along each other's planes. All of it is
   done after the perspective map (x, y, depth), which takes planes to planes, so both kinds of view are one.

   Include guidedproj.h before this file. Memory by malloc; no global state; numbers are written without regard to
   the locale. */
#ifndef GPROJX_PICTURE_H
#define GPROJX_PICTURE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "utf8.h"

/* Where the eye stands, in degrees: azimuth from the x axis towards the y axis, elevation above the xy plane. */
typedef struct gprojx_view {
    double azimuth, elevation;
    bool parallel; /* no perspective */
} gprojx_view;

/* All may be 0 or NULL. */
typedef struct gprojx_picture_options {
    const gprojx_view *view;     /* NULL: three-quarter view from the front, above and the right */
    const char *title, *caption; /* UTF-8 */
    const double *original;      /* positions: faces turned over against them, edges collapsed since are marked */
    const double *face_value;    /* face_count numbers; NULL: all faces in one colour */
    const double *face_before;   /* the same before a change, for the legend's histogram */
    const char *legend;          /* what the numbers are */
    double low, high;            /* the scale's ends; both 0: 1e-16 and 1e-1 */
    bool linear;                 /* the scale is linear instead of logarithmic */
    /* edge_count axial forces, the widths and colours of the edges: compression (> 0) blue, tension (< 0) orange */
    const double *edge_value;
    double edge_high; /* the force of the widest edges; 0: the largest of all */
    bool shadow;      /* of the mesh, straight down on the ground: the height of its lowest vertex */
} gprojx_picture_options;

typedef struct gprojx_point { /* of an item's outline */
    double x[3];              /* right and down in the picture, towards the eye; all in pixels */
    int32_t edge;             /* the mesh's edge from here to the next point; -1: a cut */
} gprojx_point;

/* What is painted at once: a whole face, or a piece of one. An outline is star-shaped, as seen, about its centre. */
typedef struct gprojx_item {
    int32_t face, start, count; /* outline: point[start .. start + count - 1] */
    int32_t cuts;               /* how often it was cut; a whole face: 0 */
    bool gone, painted;
    double low[2], high[2], centre[3], area;
    int32_t arc;     /* list of items in front of it */
    int32_t waiting; /* items behind it that are not painted */
    int32_t seen;    /* the last item that was compared with it */
} gprojx_item;

typedef struct gprojx_list { /* a growing array */
    void *data;
    size_t count, capacity;
} gprojx_list;

typedef struct gprojx_link { /* of lists in one array */
    int32_t item, next;
} gprojx_link;

typedef struct gprojx_painter {
    const gproj_mesh *mesh;
    const gprojx_picture_options *options;
    FILE *file;
    bool failed;                                               /* no memory */
    double centre[3], radius, right[3], up[3], toward[3], eye; /* eye: distance in radii; 0: parallel */
    double scale, shift[2];                                    /* from the view plane to pixels */
    double width, height, depth_low, depth_high, line, edge_most;
    gprojx_point *vertex; /* projected vertices */
    bool *turned;         /* of each face */
    bool *crossed;        /* of each face: it crosses itself (a bow-tie) */
    bool *folded;         /* of each edge */
    bool *collapsed;      /* of each edge */
    bool *met;            /* of each edge: one of its faces is painted */
    int32_t turned_count, crossed_count, folded_count, collapsed_count;
    gprojx_list point, item, link, arc, heap, ahead;
    int32_t *cell, columns, lines; /* grid: first link of each cell, or -1 */
    double cell_size;
} gprojx_painter;

static void *gprojx_push(gprojx_painter *p, gprojx_list *list, size_t size, size_t count) {
    if (list->count + count > list->capacity) {
        size_t capacity = (list->count + count) * 2 + 64;
        void *data = capacity < SIZE_MAX / 2 / size ? realloc(list->data, capacity * size) : NULL;
        if (!data) {
            p->failed = true;
            return NULL;
        }
        list->data = data;
        list->capacity = capacity;
    }
    list->count += count;
    return (char *)list->data + (list->count - count) * size;
}

static gprojx_item *gprojx_item_at(const gprojx_painter *p, int32_t i) { return (gprojx_item *)p->item.data + i; }
static gprojx_point *gprojx_outline(const gprojx_painter *p, const gprojx_item *item) {
    return (gprojx_point *)p->point.data + item->start;
}
static double gprojx_dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static double gprojx_clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

/* Twice the signed area of a triangle as seen. */
static double gprojx_area(const double a[3], const double b[3], const double c[3]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* ---- colours ---- */

typedef struct gprojx_colour {
    double r, g, b;
} gprojx_colour;

static gprojx_colour gprojx_mix(gprojx_colour a, gprojx_colour b, double t) {
    gprojx_colour c;
    c.r = a.r + (b.r - a.r) * t, c.g = a.g + (b.g - a.g) * t, c.b = a.b + (b.b - a.b) * t;
    return c;
}

static unsigned gprojx_hex(gprojx_colour c) {
    unsigned r = (unsigned)(gprojx_clamp(c.r, 0, 255) + 0.5), g = (unsigned)(gprojx_clamp(c.g, 0, 255) + 0.5);
    return r << 16 | g << 8 | (unsigned)(gprojx_clamp(c.b, 0, 255) + 0.5);
}

/* The colour map, t in 0..1: from a light glass green through blue to dark purple. Its lightness falls steadily, so it
   reads without colour vision and in print. */
static gprojx_colour gprojx_map(double t) {
    static const gprojx_colour stop[] = {{196, 234, 222}, {146, 214, 204}, {96, 184, 196}, {62, 148, 190},
                                         {64, 102, 172},  {84, 56, 138},   {84, 18, 84}};
    const int last = (int)(sizeof stop / sizeof stop[0]) - 1;
    double at = gprojx_clamp(t, 0, 1) * last;
    int i = at >= last ? last - 1 : (int)at;
    return gprojx_mix(stop[i], stop[i + 1], at - i);
}

/* The colours of forces from small to large: blue and orange are told apart by all kinds of eyes. */
static gprojx_colour gprojx_force_colour(bool tension, double t) {
    static const gprojx_colour pale[2] = {{136, 172, 214}, {250, 186, 120}}, deep[2] = {{6, 38, 100}, {170, 62, 0}};
    return gprojx_mix(pale[tension], deep[tension], gprojx_clamp(t, 0, 1));
}

static void gprojx_scale_ends(const gprojx_picture_options *options, double *low, double *high) {
    bool given = options->low < options->high && (options->linear || options->low > 0);
    *low = given ? options->low : 1e-16;
    *high = given ? options->high : 1e-1;
}

/* Where a value stands on the scale, 0..1. */
static double gprojx_scale_at(const gprojx_picture_options *options, double value) {
    double low, high;
    gprojx_scale_ends(options, &low, &high);
    if (!(value > low)) return 0;
    if (!(value < high)) return 1;
    return options->linear ? (value - low) / (high - low) : log(value / low) / log(high / low);
}

/* ---- view ---- */

static void gprojx_look(gprojx_painter *p) {
    static const gprojx_view usual = {-58, 32, false};
    const gprojx_view *view = p->options->view ? p->options->view : &usual;
    double a = view->azimuth * 0.017453292519943295, e = view->elevation * 0.017453292519943295;
    p->toward[0] = cos(e) * cos(a), p->toward[1] = cos(e) * sin(a), p->toward[2] = sin(e);
    p->right[0] = -sin(a), p->right[1] = cos(a), p->right[2] = 0;
    p->up[0] = -sin(e) * cos(a), p->up[1] = -sin(e) * sin(a), p->up[2] = cos(e);
    p->eye = view->parallel ? 0 : 4.5;
}

/* The middle and the radius of the box of all vertices that faces use. */
static void gprojx_find_box(gprojx_painter *p) {
    const gproj_mesh *mesh = p->mesh;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    int32_t i, k;
    for (i = 0; i < mesh->vertex_count; ++i)
        for (k = 0; k < 3 && mesh->vertex_halfedge[i] >= 0; ++k) {
            double x = mesh->position[3 * i + k];
            if (x < low[k]) low[k] = x;
            if (x > high[k]) high[k] = x;
        }
    for (k = 0; k < 3; ++k) {
        p->centre[k] = low[k] <= high[k] ? low[k] / 2 + high[k] / 2 : 0;
        if (low[k] <= high[k]) p->radius = hypot(p->radius, high[k] / 2 - low[k] / 2);
    }
    if (!(p->radius > 0)) p->radius = 1;
}

/* A point of space in radii about the centre, along right, up, toward. */
static void gprojx_camera(const gprojx_painter *p, const double *position, double out[3]) {
    double d[3];
    int k;
    for (k = 0; k < 3; ++k) d[k] = (position[k] - p->centre[k]) / p->radius;
    out[0] = gprojx_dot(p->right, d), out[1] = gprojx_dot(p->up, d), out[2] = gprojx_dot(p->toward, d);
}

/* Projects all vertices; the picture's size follows from theirs. */
static bool gprojx_project(gprojx_painter *p) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, room[2], size[2];
    int32_t i, k;
    p->vertex = (gprojx_point *)calloc((size_t)p->mesh->vertex_count + 1, sizeof *p->vertex);
    if (!p->vertex) return false;
    for (i = 0; i < p->mesh->vertex_count; ++i) {
        double *x = p->vertex[i].x, w;
        gprojx_camera(p, p->mesh->position + 3 * i, x);
        w = p->eye > 0 ? p->eye / (p->eye - x[2]) : 1;
        x[0] *= w, x[1] *= w;
        if (p->eye > 0) x[2] = p->eye * w;
        for (k = 0; k < 2 && p->mesh->vertex_halfedge[i] >= 0; ++k) {
            if (x[k] < low[k]) low[k] = x[k];
            if (x[k] > high[k]) high[k] = x[k];
        }
    }
    for (k = 0; k < 2; ++k) size[k] = high[k] - low[k] > 1e-9 ? high[k] - low[k] : 1e-9;
    room[0] = 1120;
    room[1] = gprojx_clamp(room[0] * size[1] / size[0], 380, 720);
    p->scale = fmin(room[0] / size[0], room[1] / size[1]);
    p->width = 1200;
    p->height = room[1] + (p->options->face_value && p->options->edge_value ? 250 : 210); /* two scales, or one */
    p->shift[0] = p->width / 2 - p->scale * (low[0] + high[0]) / 2;
    p->shift[1] = 90 + room[1] / 2 + p->scale * (low[1] + high[1]) / 2;
    p->depth_low = INFINITY, p->depth_high = -INFINITY;
    for (i = 0; i < p->mesh->vertex_count; ++i) {
        double *x = p->vertex[i].x;
        x[0] = p->shift[0] + p->scale * x[0], x[1] = p->shift[1] - p->scale * x[1], x[2] *= p->scale;
        if (p->mesh->vertex_halfedge[i] < 0) continue;
        p->depth_low = fmin(p->depth_low, x[2]), p->depth_high = fmax(p->depth_high, x[2]);
    }
    return true;
}

/* ---- items ---- */

static int32_t gprojx_add_item(gprojx_painter *p, int32_t face, int32_t count, const gprojx_point *outline,
                               int32_t cuts) {
    size_t start = p->point.count;
    gprojx_point *copy = (gprojx_point *)gprojx_push(p, &p->point, sizeof *copy, (size_t)count);
    gprojx_item *item = copy ? (gprojx_item *)gprojx_push(p, &p->item, sizeof *item, 1) : NULL;
    int32_t i, k;
    if (!item) return -1;
    memcpy(copy, outline, (size_t)count * sizeof *copy);
    memset(item, 0, sizeof *item);
    item->face = face, item->start = (int32_t)start, item->count = count, item->cuts = cuts;
    item->arc = -1, item->seen = -1;
    for (k = 0; k < 2; ++k) item->low[k] = INFINITY, item->high[k] = -INFINITY;
    for (i = 0; i < count; ++i) {
        for (k = 0; k < 2; ++k) {
            item->low[k] = fmin(item->low[k], copy[i].x[k]);
            item->high[k] = fmax(item->high[k], copy[i].x[k]);
        }
        for (k = 0; k < 3; ++k) item->centre[k] += copy[i].x[k] / count;
    }
    for (i = 0; i < count; ++i) item->area += gprojx_area(item->centre, copy[i].x, copy[(i + 1) % count].x) / 2;
    return (int32_t)p->item.count - 1;
}

/* Is the outline star-shaped, as seen, about the mean of its points? */
static bool gprojx_is_star(int32_t count, const gprojx_point *outline) {
    double centre[3] = {0, 0, 0}, most = 0, least = 0;
    int32_t i, k;
    for (i = 0; i < count; ++i)
        for (k = 0; k < 3; ++k) centre[k] += outline[i].x[k] / count;
    for (i = 0; i < count; ++i) {
        double area = gprojx_area(centre, outline[i].x, outline[(i + 1) % count].x);
        most = fmax(most, area), least = fmin(least, area);
    }
    return fmin(most, -least) < 1e-3 || count == 3;
}

/* May corner i of the polygon be cut off? `u` and `v` are the axes of a plane, `sign` the polygon's direction there. */
static bool gprojx_is_ear(const gprojx_point *q, int32_t count, int32_t i, int u, int v, double sign) {
    const double *t[3];
    int32_t j, k;
    t[0] = q[(i + count - 1) % count].x, t[1] = q[i].x, t[2] = q[(i + 1) % count].x;
    if (sign * ((t[1][u] - t[0][u]) * (t[2][v] - t[0][v]) - (t[1][v] - t[0][v]) * (t[2][u] - t[0][u])) <= 0)
        return false;
    for (j = 0; j < count; ++j) {
        bool inside = q[j].x != t[0] && q[j].x != t[1] && q[j].x != t[2];
        for (k = 0; k < 3 && inside; ++k) {
            const double *a = t[k], *b = t[(k + 1) % 3], *x = q[j].x;
            inside = sign * ((b[u] - a[u]) * (x[v] - a[v]) - (b[v] - a[v]) * (x[u] - a[u])) > 0;
        }
        if (inside) return false;
    }
    return true;
}

/* Cuts a face into triangles by its ears, in the coordinate plane that sees it best. Changes q. */
static void gprojx_add_triangles(gprojx_painter *p, int32_t face, int32_t count, gprojx_point *q) {
    double area[3] = {0, 0, 0}, sign;
    int32_t i, k, best = 0;
    for (i = 0; i < count; ++i)
        for (k = 0; k < 3; ++k) {
            int u = (k + 1) % 3, v = (k + 2) % 3;
            const double *a = q[i].x, *b = q[(i + 1) % count].x, *o = q[0].x;
            area[k] += (a[u] - o[u]) * (b[v] - o[v]) - (a[v] - o[v]) * (b[u] - o[u]);
        }
    for (k = 1; k < 3; ++k)
        if (fabs(area[k]) > fabs(area[best])) best = k;
    sign = area[best] < 0 ? -1 : 1;
    while (count >= 3) {
        gprojx_point t[3];
        for (i = 0; i < count - 1 && count > 3; ++i)
            if (gprojx_is_ear(q, count, i, (best + 1) % 3, (best + 2) % 3, sign)) break;
        k = (i + count - 1) % count;
        t[0] = q[k], t[1] = q[i], t[2] = q[(i + 1) % count];
        if (count > 3) t[2].edge = -1;
        gprojx_add_item(p, face, 3, t, 1);
        q[k].edge = -1;
        memmove(q + i, q + i + 1, (size_t)(count - 1 - i) * sizeof *q);
        --count;
    }
}

static void gprojx_add_face(gprojx_painter *p, int32_t face, gprojx_point *q) {
    int32_t h = p->mesh->face_halfedge[face], count = p->mesh->face_degree[face], i;
    for (i = 0; i < count; ++i, h = p->mesh->next[h]) {
        q[i] = p->vertex[p->mesh->origin[h]];
        q[i].edge = p->mesh->edge[h];
        if (!(fabs(q[i].x[0]) < 1e6 && fabs(q[i].x[1]) < 1e6 && fabs(q[i].x[2]) < 1e9)) return; /* not finite */
    }
    if (gprojx_is_star(count, q))
        gprojx_add_item(p, face, count, q, 0);
    else
        gprojx_add_triangles(p, face, count, q);
}

/* Replaces an item by the triangles about its centre. */
static void gprojx_burst(gprojx_painter *p, int32_t index) {
    gprojx_item item = *gprojx_item_at(p, index);
    int32_t i;
    gprojx_item_at(p, index)->gone = true;
    for (i = 0; i < item.count && !p->failed; ++i) {
        gprojx_point t[3];
        memcpy(t[0].x, item.centre, sizeof t[0].x);
        t[0].edge = -1;
        t[1] = gprojx_outline(p, &item)[i];
        t[2] = gprojx_outline(p, &item)[(i + 1) % item.count];
        t[2].edge = -1;
        gprojx_add_item(p, item.face, 3, t, item.cuts + 1);
    }
}

/* depth = d[0] + d[1] x + d[2] y through a triangle; false where it is seen from the side. */
static bool gprojx_plane(const double a[3], const double b[3], const double c[3], double d[3]) {
    double area = gprojx_area(a, b, c);
    if (fabs(area) < 1e-4) return false;
    d[1] = ((b[2] - a[2]) * (c[1] - a[1]) - (c[2] - a[2]) * (b[1] - a[1])) / area;
    d[2] = ((c[2] - a[2]) * (b[0] - a[0]) - (b[2] - a[2]) * (c[0] - a[0])) / area;
    d[0] = a[2] - d[1] * a[0] - d[2] * a[1];
    return true;
}

/* Replaces an item by its parts before and behind a plane. Whole faces, which may be warped, are cut into triangles
   first. False where all of it is on one side. */
static bool gprojx_cut(gprojx_painter *p, int32_t index, const double d[3]) {
    enum {
        MOST = 16
    };
    gprojx_item item = *gprojx_item_at(p, index);
    gprojx_point part[2][MOST + 2];
    int32_t count[2] = {0, 0}, i;
    if (item.cuts > 8 || p->item.count > 4 * (size_t)p->mesh->face_count + 20000) return false;
    if (item.cuts == 0 && item.count > 3) {
        gprojx_burst(p, index);
        return true;
    }
    if (item.count > MOST) return false;
    for (i = 0; i < item.count; ++i) {
        gprojx_point a = gprojx_outline(p, &item)[i], b = gprojx_outline(p, &item)[(i + 1) % item.count], c = a;
        double s = a.x[2] - d[0] - d[1] * a.x[0] - d[2] * a.x[1], t = b.x[2] - d[0] - d[1] * b.x[0] - d[2] * b.x[1];
        int32_t side = s > 0, k;
        part[side][count[side]++] = a;
        if ((s > 0) == (t > 0)) continue;
        for (k = 0; k < 3; ++k) c.x[k] = a.x[k] + (b.x[k] - a.x[k]) * (s / (s - t));
        part[!side][count[!side]++] = c;
        c.edge = -1; /* this part goes on along the cut */
        part[side][count[side]++] = c;
    }
    if (count[0] < 3 || count[1] < 3) return false;
    gprojx_item_at(p, index)->gone = true;
    for (i = 0; i < 2; ++i) gprojx_add_item(p, item.face, count[i], part[i], item.cuts + 1);
    return true;
}

/* ---- which of two items is in front ---- */

typedef struct gprojx_overlap {
    double volume;            /* integral of depth(a) - depth(b) over what they both cover */
    double nearest, farthest; /* the largest and the smallest of depth(a) - depth(b) there */
    double plane[3];          /* of a triangle of b that a passes through */
    bool crossing;
} gprojx_overlap;

/* Adds what two triangles have in common: clips the first by the sides of the second (Sutherland, Hodgman 1974). */
static void gprojx_overlap_add(const double *const a[3], const double *const b[3], gprojx_overlap *sum) {
    double part[2][9][2], plane_a[3], plane_b[3], sign, area = 0, near = -INFINITY, far = INFINITY;
    int count = 3, now = 0, side, i;
    if (!gprojx_plane(a[0], a[1], a[2], plane_a) || !gprojx_plane(b[0], b[1], b[2], plane_b)) return;
    sign = gprojx_area(b[0], b[1], b[2]) < 0 ? -1 : 1;
    for (i = 0; i < 3; ++i) part[0][i][0] = a[i][0], part[0][i][1] = a[i][1];
    for (side = 0; side < 3 && count > 2; ++side, now = !now) {
        const double *u = b[side], *v = b[(side + 1) % 3];
        int kept = 0;
        for (i = 0; i < count; ++i) {
            const double *x = part[now][i], *y = part[now][(i + 1) % count];
            double s = sign * ((v[0] - u[0]) * (x[1] - u[1]) - (v[1] - u[1]) * (x[0] - u[0]));
            double t = sign * ((v[0] - u[0]) * (y[1] - u[1]) - (v[1] - u[1]) * (y[0] - u[0]));
            if (s >= 0) memcpy(part[!now][kept++], x, 2 * sizeof *x);
            if ((s >= 0) == (t >= 0)) continue;
            part[!now][kept][0] = x[0] + (y[0] - x[0]) * (s / (s - t));
            part[!now][kept++][1] = x[1] + (y[1] - x[1]) * (s / (s - t));
        }
        count = kept;
    }
    for (i = 0; i < count; ++i) {
        const double *x = part[now][i];
        double difference =
            plane_a[0] - plane_b[0] + (plane_a[1] - plane_b[1]) * x[0] + (plane_a[2] - plane_b[2]) * x[1];
        near = fmax(near, difference), far = fmin(far, difference);
        if (i + 2 < count) {
            const double *o = part[now][0], *y = part[now][i + 1], *z = part[now][i + 2];
            double piece = fabs((y[0] - o[0]) * (z[1] - o[1]) - (y[1] - o[1]) * (z[0] - o[0])) / 2;
            double mx = (o[0] + y[0] + z[0]) / 3, my = (o[1] + y[1] + z[1]) / 3;
            area += piece;
            sum->volume +=
                piece * (plane_a[0] - plane_b[0] + (plane_a[1] - plane_b[1]) * mx + (plane_a[2] - plane_b[2]) * my);
        }
    }
    if (area < 0.05) return;
    sum->nearest = fmax(sum->nearest, near), sum->farthest = fmin(sum->farthest, far);
    if (area < 1 || near < 0.5 || far > -0.5 || sum->crossing) return;
    sum->crossing = true;
    memcpy(sum->plane, plane_b, sizeof plane_b);
}

/* Does one side of a have all of these points outside? (Convex neighbours end here.) */
static bool gprojx_separated(const gprojx_painter *p, const gprojx_item *a, int32_t count, const gprojx_point *r) {
    const gprojx_point *q = gprojx_outline(p, a);
    double sign = a->area < 0 ? -1 : 1;
    int32_t i, j;
    for (i = 0; i < a->count; ++i) {
        const double *u = q[i].x, *v = q[(i + 1) % a->count].x;
        double room = 1e-3 * (fabs(v[0] - u[0]) + fabs(v[1] - u[1])); /* a thousandth of a pixel */
        for (j = 0; j < a->count; ++j)
            if (sign * gprojx_area(u, v, q[j].x) < -room) break;
        if (j < a->count) continue; /* not a side of a's hull */
        for (j = 0; j < count; ++j)
            if (sign * gprojx_area(u, v, r[j].x) > room) break;
        if (j == count) return true;
    }
    return false;
}

static gprojx_overlap gprojx_compare(const gprojx_painter *p, const gprojx_item *a, const gprojx_item *b) {
    gprojx_overlap sum = {0, -INFINITY, INFINITY, {0, 0, 0}, false};
    const gprojx_point *q = gprojx_outline(p, a), *r = gprojx_outline(p, b);
    int32_t i, j;
    int k;
    for (k = 0; k < 2; ++k)
        if (a->low[k] >= b->high[k] || b->low[k] >= a->high[k]) return sum;
    if (gprojx_separated(p, a, b->count, r) || gprojx_separated(p, b, a->count, q)) return sum;
    for (i = 0; i < a->count; ++i)
        for (j = 0; j < b->count; ++j) {
            const double *s[3], *t[3];
            s[0] = a->centre, s[1] = q[i].x, s[2] = q[(i + 1) % a->count].x;
            t[0] = b->centre, t[1] = r[j].x, t[2] = r[(j + 1) % b->count].x;
            gprojx_overlap_add(s, t, &sum);
        }
    return sum;
}

/* ---- the order ---- */

static void gprojx_cells(const gprojx_painter *p, const gprojx_item *item, int32_t range[4]) {
    int32_t k, most[2];
    most[0] = p->columns - 1, most[1] = p->lines - 1;
    for (k = 0; k < 2; ++k) {
        range[2 * k] = (int32_t)gprojx_clamp(item->low[k] / p->cell_size, 0, most[k]);
        range[2 * k + 1] = (int32_t)gprojx_clamp(item->high[k] / p->cell_size, 0, most[k]);
    }
}

/* Is nothing of an item in this cell of its range? Long thin ones miss most. The cells at the border have no end. */
static bool gprojx_misses(const gprojx_painter *p, const gprojx_item *item, int32_t x, int32_t y) {
    gprojx_point corner[4];
    int k;
    if (x == 0 || y == 0 || x == p->columns - 1 || y == p->lines - 1) return false;
    for (k = 0; k < 4; ++k) {
        corner[k].x[0] = (x + k % 2) * p->cell_size;
        corner[k].x[1] = (y + k / 2) * p->cell_size;
    }
    return gprojx_separated(p, item, 4, corner);
}

static void gprojx_add_arc(gprojx_painter *p, int32_t behind, int32_t front) {
    gprojx_link *arc = (gprojx_link *)gprojx_push(p, &p->arc, sizeof *arc, 1);
    if (!arc) return;
    arc->item = front;
    arc->next = gprojx_item_at(p, behind)->arc;
    gprojx_item_at(p, behind)->arc = (int32_t)p->arc.count - 1;
    gprojx_item_at(p, front)->waiting++;
}

/* Compares an item with those in one cell and notes the order in p->ahead: neighbours in front as i, behind as ~i.
   False when the item was cut instead. */
static bool gprojx_meet_cell(gprojx_painter *p, int32_t index, int32_t cell) {
    int32_t l;
    for (l = p->cell[cell]; l >= 0; l = ((gprojx_link *)p->link.data)[l].next) {
        int32_t other = ((gprojx_link *)p->link.data)[l].item;
        gprojx_item *b = gprojx_item_at(p, other);
        gprojx_overlap overlap;
        int32_t *note;
        if (b->gone || b->painted || b->seen == index) continue;
        b->seen = index;
        overlap = gprojx_compare(p, gprojx_item_at(p, index), b);
        if (overlap.crossing && gprojx_cut(p, index, overlap.plane)) return false;
        if (!(overlap.nearest >= overlap.farthest) || overlap.volume == 0) continue;
        note = (int32_t *)gprojx_push(p, &p->ahead, sizeof *note, 1);
        if (note) *note = overlap.volume > 0 ? ~other : other;
    }
    return true;
}

/* Enters an item into the grid, with arcs to and from those that are there. Parts that it is cut into are at the end
   of the items, and the caller comes to them. */
static void gprojx_enter(gprojx_painter *p, int32_t index) {
    int32_t range[4], x, y;
    size_t i;
    gprojx_cells(p, gprojx_item_at(p, index), range);
    p->ahead.count = 0;
    for (y = range[2]; y <= range[3]; ++y)
        for (x = range[0]; x <= range[1]; ++x)
            if (p->failed ||
                (!gprojx_misses(p, gprojx_item_at(p, index), x, y) && !gprojx_meet_cell(p, index, y * p->columns + x)))
                return;
    for (i = 0; i < p->ahead.count && !p->failed; ++i) {
        int32_t other = ((int32_t *)p->ahead.data)[i];
        if (other >= 0)
            gprojx_add_arc(p, index, other);
        else
            gprojx_add_arc(p, ~other, index);
    }
    for (y = range[2]; y <= range[3]; ++y)
        for (x = range[0]; x <= range[1]; ++x) {
            gprojx_link *link;
            if (gprojx_misses(p, gprojx_item_at(p, index), x, y)) continue;
            link = (gprojx_link *)gprojx_push(p, &p->link, sizeof *link, 1);
            if (!link) return;
            link->item = index;
            link->next = p->cell[y * p->columns + x];
            p->cell[y * p->columns + x] = (int32_t)p->link.count - 1;
        }
}

static bool gprojx_make_grid(gprojx_painter *p) {
    double area = 100 + p->width * p->height / (double)(p->mesh->face_count + 1);
    int32_t i;
    p->cell_size = gprojx_clamp(sqrt(area), 4, 200);
    p->columns = (int32_t)(p->width / p->cell_size) + 1;
    p->lines = (int32_t)(p->height / p->cell_size) + 1;
    p->cell = (int32_t *)malloc((size_t)(p->columns * p->lines) * sizeof *p->cell);
    for (i = 0; p->cell && i < p->columns * p->lines; ++i) p->cell[i] = -1;
    return p->cell != NULL;
}

/* A heap with the farthest item on top. */
static bool gprojx_farther(const gprojx_painter *p, int32_t a, int32_t b) {
    double x = gprojx_item_at(p, a)->centre[2], y = gprojx_item_at(p, b)->centre[2];
    return x < y || (x == y && a < b);
}

static void gprojx_heap_add(gprojx_painter *p, int32_t item) {
    int32_t *heap, i, up;
    if (!gprojx_push(p, &p->heap, sizeof *heap, 1)) return;
    heap = (int32_t *)p->heap.data;
    for (i = (int32_t)p->heap.count - 1; i > 0 && gprojx_farther(p, item, heap[up = (i - 1) / 2]); i = up)
        heap[i] = heap[up];
    heap[i] = item;
}

static int32_t gprojx_heap_take(gprojx_painter *p) {
    int32_t *heap = (int32_t *)p->heap.data, top = heap[0], count = (int32_t)--p->heap.count, last = heap[count];
    int32_t i = 0, down;
    for (; (down = 2 * i + 1) < count; i = down) {
        if (down + 1 < count && gprojx_farther(p, heap[down + 1], heap[down])) ++down;
        if (!gprojx_farther(p, heap[down], last)) break;
        heap[i] = heap[down];
    }
    heap[i] = last;
    return top;
}

/* The items in front of one that is painted or gone need no longer wait for it. */
static void gprojx_release(gprojx_painter *p, int32_t index) {
    int32_t a;
    for (a = gprojx_item_at(p, index)->arc; a >= 0; a = ((gprojx_link *)p->arc.data)[a].next) {
        int32_t front = ((gprojx_link *)p->arc.data)[a].item;
        gprojx_item *item = gprojx_item_at(p, front);
        if (--item->waiting == 0 && !item->gone && !item->painted) gprojx_heap_add(p, front);
    }
}

/* Items that wait for each other in a cycle: cuts one of them by the plane of the one behind it. Walks from item to
   item behind until one comes again. Returns false where none can be cut; *farthest is then one to paint anyway. */
static bool gprojx_open_cycle(gprojx_painter *p, int32_t *farthest) {
    int32_t count = (int32_t)p->item.count, i, at = -1, *behind = (int32_t *)malloc((size_t)count * sizeof *behind);
    bool cut = false;
    if (!behind) {
        p->failed = true;
        return false;
    }
    *farthest = -1;
    for (i = 0; i < count; ++i) behind[i] = -1;
    for (i = 0; i < count; ++i) {
        int32_t a = gprojx_item_at(p, i)->arc;
        if (gprojx_item_at(p, i)->gone || gprojx_item_at(p, i)->painted) continue;
        at = i;
        for (; a >= 0; a = ((gprojx_link *)p->arc.data)[a].next) behind[((gprojx_link *)p->arc.data)[a].item] = i;
    }
    for (i = 0; i < count && at >= 0; ++i) at = behind[at] >= 0 ? behind[at] : at;
    for (i = 0; i < 1000 && at >= 0 && !cut; ++i, at = behind[at]) { /* round the cycle */
        const gprojx_item *b = behind[at] >= 0 ? gprojx_item_at(p, behind[at]) : NULL;
        double plane[3];
        if (*farthest < 0 || gprojx_farther(p, at, *farthest)) *farthest = at;
        if (b && gprojx_plane(b->centre, gprojx_outline(p, b)[0].x, gprojx_outline(p, b)[1].x, plane))
            cut = gprojx_cut(p, at, plane);
        if (cut) *farthest = at;
    }
    free(behind);
    return cut;
}

static void gprojx_paint(gprojx_painter *p, int32_t index);

static void gprojx_paint_one(gprojx_painter *p, int32_t index) {
    gprojx_item_at(p, index)->painted = true;
    gprojx_paint(p, index);
    gprojx_release(p, index);
}

/* Enters the items from `first` on, and those that they are cut into; what waits for nothing may then be painted. */
static void gprojx_enter_from(gprojx_painter *p, int32_t first) {
    int32_t i;
    for (i = first; i < (int32_t)p->item.count && !p->failed; ++i) gprojx_enter(p, i);
    for (i = first; i < (int32_t)p->item.count && !p->failed; ++i)
        if (!gprojx_item_at(p, i)->gone && gprojx_item_at(p, i)->waiting == 0) gprojx_heap_add(p, i);
}

static void gprojx_paint_all(gprojx_painter *p) {
    int32_t cycles = 0, at = 0;
    gprojx_enter_from(p, 0);
    while (!p->failed && at >= 0) {
        while (p->heap.count > 0 && !p->failed) {
            int32_t index = gprojx_heap_take(p);
            const gprojx_item *item = gprojx_item_at(p, index);
            /* It may wait again: for the parts of an item that was cut after it came here. */
            if (!item->painted && !item->gone && item->waiting == 0) gprojx_paint_one(p, index);
        }
        if (p->failed) return;
        if (++cycles < 500 + p->mesh->face_count / 10) {
            int32_t first = (int32_t)p->item.count;
            if (gprojx_open_cycle(p, &at)) {
                gprojx_release(p, at);
                gprojx_enter_from(p, first);
            } else if (at >= 0)
                gprojx_paint_one(p, at);
        } else {
            for (at = (int32_t)p->item.count - 1; at >= 0; --at)
                if (!gprojx_item_at(p, at)->painted && !gprojx_item_at(p, at)->gone) break;
            if (at >= 0) gprojx_paint_one(p, at);
        }
    }
}

/* ---- marks ---- */

static double gprojx_angle_cosine(const double a[3], const double b[3]) {
    double size = sqrt(gprojx_dot(a, a)) * sqrt(gprojx_dot(b, b));
    return size > 0 ? gprojx_dot(a, b) / size : 1;
}

static void gprojx_area_of(const gproj_mesh *mesh, const double *position, int32_t face, double area[3]) {
    int32_t h = mesh->face_halfedge[face], i, k;
    const double *o = position + 3 * mesh->origin[h];
    area[0] = area[1] = area[2] = 0;
    for (i = 0; i < mesh->face_degree[face]; ++i, h = mesh->next[h]) {
        const double *a = position + 3 * mesh->origin[h], *b = position + 3 * mesh->origin[mesh->next[h]];
        for (k = 0; k < 3; ++k) {
            int u = (k + 1) % 3, v = (k + 2) % 3;
            area[k] += ((a[u] - o[u]) * (b[v] - o[v]) - (a[v] - o[v]) * (b[u] - o[u])) / 2;
        }
    }
}

static void gprojx_cross(const double a[3], const double b[3], double out[3]) {
    int k;
    for (k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* The side of a face from the origin of a half-edge. */
static void gprojx_side(const gproj_mesh *mesh, int32_t h, double side[3]) {
    const double *a = mesh->position + 3 * mesh->origin[h], *b = mesh->position + 3 * mesh->origin[mesh->next[h]];
    int k;
    for (k = 0; k < 3; ++k) side[k] = b[k] - a[k];
}

/* On which sides of the line through half-edge g, as seen along n, are the ends of half-edge h? Their product. */
static double gprojx_sides(const gproj_mesh *mesh, int32_t g, int32_t h, const double n[3]) {
    const double *o = mesh->position + 3 * mesh->origin[g];
    int32_t end[2];
    double line[3], across[3], product = 1;
    int i, k;
    gprojx_side(mesh, g, line);
    gprojx_cross(n, line, across);
    end[0] = mesh->origin[h], end[1] = mesh->origin[mesh->next[h]];
    for (i = 0; i < 2; ++i) {
        double d[3];
        for (k = 0; k < 3; ++k) d[k] = mesh->position[3 * end[i] + k] - o[k];
        product *= gprojx_dot(across, d) / (gprojx_dot(line, line) + 1e-300);
    }
    return product;
}

/* Does a face cross itself? Seen along the largest product of two of its sides: a bow-tie may have no vectorial area. */
static bool gprojx_is_crossed(const gproj_mesh *mesh, int32_t face) {
    int32_t first = mesh->face_halfedge[face], degree = mesh->face_degree[face], g, h, i, j;
    double n[3] = {0, 0, 0}, a[3], b[3], c[3];
    for (i = 0, g = first; i < degree; ++i, g = mesh->next[g])
        for (j = i + 1, h = mesh->next[g]; j < degree; ++j, h = mesh->next[h]) {
            gprojx_side(mesh, g, a), gprojx_side(mesh, h, b);
            gprojx_cross(a, b, c);
            if (gprojx_dot(c, c) > gprojx_dot(n, n)) memcpy(n, c, sizeof n);
        }
    for (i = 0, g = first; i + 2 < degree; ++i, g = mesh->next[g])
        for (j = i + 2, h = mesh->next[mesh->next[g]]; j < degree; ++j, h = mesh->next[h])
            if (mesh->next[h] != g && gprojx_sides(mesh, g, h, n) < 0 && gprojx_sides(mesh, h, g, n) < 0) return true;
    return false;
}

static double gprojx_length(const double *position, const gproj_mesh *mesh, int32_t edge) {
    const double *a = position + 3 * mesh->origin[2 * edge], *b = position + 3 * mesh->origin[2 * edge + 1];
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Edges that have less than a tenth of their length and of the mean length in the original. */
static void gprojx_find_collapsed(gprojx_painter *p) {
    const double *original = p->options->original;
    double mean = 0;
    int32_t i;
    for (i = 0; original && i < p->mesh->edge_count; ++i)
        mean += gprojx_length(original, p->mesh, i) / p->mesh->edge_count;
    for (i = 0; original && i < p->mesh->edge_count; ++i) {
        double now = gprojx_length(p->mesh->position, p->mesh, i);
        p->collapsed[i] = now < 0.1 * mean && now < 0.1 * gprojx_length(original, p->mesh, i);
        p->collapsed_count += p->collapsed[i];
    }
}

/* Faces turned over against the original or crossing themselves, edges with more than 120 degrees between the normals or
   collapsed. */
static bool gprojx_find_marks(gprojx_painter *p) {
    const gproj_mesh *mesh = p->mesh;
    int32_t i;
    p->turned = (bool *)calloc((size_t)mesh->face_count + 1, sizeof *p->turned);
    p->crossed = (bool *)calloc((size_t)mesh->face_count + 1, sizeof *p->crossed);
    p->folded = (bool *)calloc((size_t)mesh->edge_count + 1, sizeof *p->folded);
    p->collapsed = (bool *)calloc((size_t)mesh->edge_count + 1, sizeof *p->collapsed);
    p->met = (bool *)calloc((size_t)mesh->edge_count + 1, sizeof *p->met);
    if (!p->turned || !p->crossed || !p->folded || !p->collapsed || !p->met) return false;
    for (i = 0; i < mesh->face_count; ++i) {
        p->crossed[i] = gprojx_is_crossed(mesh, i);
        p->crossed_count += p->crossed[i];
    }
    for (i = 0; i < mesh->face_count && p->options->original; ++i) {
        double before[3], after[3];
        gprojx_area_of(mesh, p->options->original, i, before);
        gprojx_area_of(mesh, mesh->position, i, after);
        p->turned[i] = gprojx_dot(before, after) < 0;
        p->turned_count += p->turned[i];
    }
    for (i = 0; i < mesh->edge_count; ++i) {
        double a[3], b[3];
        if (mesh->face[2 * i] < 0 || mesh->face[2 * i + 1] < 0) continue;
        gprojx_area_of(mesh, mesh->position, mesh->face[2 * i], a);
        gprojx_area_of(mesh, mesh->position, mesh->face[2 * i + 1], b);
        p->folded[i] = gprojx_angle_cosine(a, b) < -0.5;
        p->folded_count += p->folded[i];
    }
    gprojx_find_collapsed(p);
    return true;
}

/* ---- SVG ---- */

/* Hundredths of a pixel as text, with no more digits than needed: -1234 gives "-12.34", 50 gives ".5". */
static void gprojx_put(FILE *file, long hundredths) {
    long size = hundredths < 0 ? -hundredths : hundredths;
    if (hundredths < 0) fputc('-', file);
    if (size >= 100 || size == 0) fprintf(file, "%ld", size / 100);
    if (size % 10)
        fprintf(file, ".%02ld", size % 100);
    else if (size % 100)
        fprintf(file, ".%ld", size % 100 / 10);
}

/* Not finite: 0. */
static long gprojx_hundredths(double x) { return fabs(x) < 1e6 ? lround(x * 100) : 0; }

static void gprojx_put_number(FILE *file, double x) { gprojx_put(file, gprojx_hundredths(x)); }

/* name="x" */
static void gprojx_put_attribute(FILE *file, const char *name, double x) {
    fprintf(file, " %s=\"", name);
    gprojx_put_number(file, x);
    fputc('"', file);
}

/* Text with the characters that XML reserves, without control characters, and with ? for bytes that are not UTF-8 and
   for U+FFFE and U+FFFF, which XML does not have. */
static void gprojx_put_text(FILE *file, const char *text) {
    size_t size;
    for (; *text; text += size ? size : 1) {
        size = gprojx_utf8_size(text);
        if (*text == '&')
            fputs("&amp;", file);
        else if (*text == '<')
            fputs("&lt;", file);
        else if (*text == '>')
            fputs("&gt;", file);
        else if (size == 0 || memcmp(text, "\xef\xbf\xbe", size) == 0 || memcmp(text, "\xef\xbf\xbf", size) == 0)
            fputc('?', file);
        else if ((unsigned char)*text >= 32)
            fwrite(text, 1, size, file);
    }
}

/* d="M... l..." through the points, closed or not; steps are differences of rounded places, so no error adds up. */
static void gprojx_put_path(FILE *file, const gprojx_point *point, int32_t count, bool closed) {
    long x = 0, y = 0;
    int32_t i;
    fputs(" d=\"M", file);
    for (i = 0; i < count; ++i) {
        long u = gprojx_hundredths(point[i].x[0]), v = gprojx_hundredths(point[i].x[1]);
        if (i == 1)
            fputc('l', file);
        else if (i > 1 && u - x >= 0)
            fputc(' ', file);
        gprojx_put(file, u - x);
        if (v - y >= 0) fputc(' ', file);
        gprojx_put(file, v - y);
        x = u, y = v;
    }
    fputs(closed ? "z\"" : "\"", file);
}

/* The face's own colour, lit by a lamp above the eye's left shoulder, and paler far away. */
static gprojx_colour gprojx_face_colour(const gprojx_painter *p, const gprojx_item *item) {
    static const gprojx_colour plain = {178, 214, 218}, turned = {230, 110, 40}, crossed = {242, 194, 0},
                               white = {255, 255, 255}, black = {10, 30, 78};
    static const double lamp[3] = {-0.40, 0.60, 0.69};
    const double *value = p->options->face_value;
    gprojx_colour colour = value ? gprojx_map(gprojx_scale_at(p->options, value[item->face])) : plain;
    double world[3], n[3], size, light, far = 0;
    if (p->turned[item->face]) colour = turned;
    if (p->crossed[item->face]) colour = crossed;
    gprojx_area_of(p->mesh, p->mesh->position, item->face, world);
    n[0] = gprojx_dot(world, p->right), n[1] = gprojx_dot(world, p->up), n[2] = gprojx_dot(world, p->toward);
    size = sqrt(gprojx_dot(n, n));
    light = size > 0 ? gprojx_dot(n, lamp) / size : 0.5;
    if (n[2] < 0) light = -light; /* both sides are lit alike */
    colour = light < 0.75 ? gprojx_mix(colour, black, 0.46 * (0.75 - gprojx_clamp(light, -0.25, 1)))
                          : gprojx_mix(colour, white, 1.6 * (light - 0.75));
    if (p->depth_high > p->depth_low) far = (p->depth_high - item->centre[2]) / (p->depth_high - p->depth_low);
    return gprojx_mix(colour, white, 0.16 * gprojx_clamp(far, 0, 1));
}

enum {
    GPROJX_EDGE_LEVELS = 20
};

/* The height of a face over one of its edges, as seen: how much room there is for the edge's line. */
static double gprojx_room(const gprojx_painter *p, int32_t face, int32_t edge) {
    const double *a = p->vertex[p->mesh->origin[2 * edge]].x, *b = p->vertex[p->mesh->origin[2 * edge + 1]].x;
    int32_t h = p->mesh->face_halfedge[face], first = h;
    double area = 0, length = hypot(a[0] - b[0], a[1] - b[1]);
    for (h = p->mesh->next[h]; p->mesh->next[h] != first; h = p->mesh->next[h])
        area += gprojx_area(p->vertex[p->mesh->origin[first]].x, p->vertex[p->mesh->origin[h]].x,
                            p->vertex[p->mesh->origin[p->mesh->next[h]]].x);
    return fabs(area) / 2 / (length + 1e-9);
}

/* The width of an edge with this part of the largest force. */
static double gprojx_edge_width(const gprojx_painter *p, double level) {
    return p->line * (0.6 + 4.6 * level / GPROJX_EDGE_LEVELS);
}

/* Begins the line of an edge by its force: at most a third of the height of its faces, where these are narrow. */
static void gprojx_begin_force(const gprojx_painter *p, int32_t edge) {
    double value = p->options->edge_value[edge], share = gprojx_clamp(fabs(value) / p->edge_most, 0, 1),
           room = INFINITY;
    int level = (int)floor(sqrt(share) * GPROJX_EDGE_LEVELS + 0.5), k;
    for (k = 0; k < 2; ++k)
        if (p->mesh->face[2 * edge + k] >= 0) room = fmin(room, gprojx_room(p, p->mesh->face[2 * edge + k], edge));
    fprintf(p->file, "<path class=\"%c%d\"", value < -1e-9 * p->edge_most ? 't' : 'p', level);
    if (room / 3 >= gprojx_edge_width(p, level)) return;
    fputs(" style=\"stroke-width:", p->file);
    gprojx_put_number(p->file, fmax(0.1 * floor(room / 0.3), 0.2));
    fputc('"', p->file);
}

/* Is this edge of the boundary without force, as between two supports? It is drawn as in pictures without forces. */
static bool gprojx_is_idle(const gprojx_painter *p, int32_t edge) {
    bool outer = p->mesh->face[2 * edge] < 0 || p->mesh->face[2 * edge + 1] < 0;
    return outer && fabs(p->options->edge_value[edge]) <= 1e-9 * p->edge_most;
}

/* An edge of two faces waits for the second of them, to be painted over both. Pieces of faces that are cut do not wait. */
static bool gprojx_waits(const gprojx_painter *p, const gprojx_item *item, int32_t edge) {
    bool second = p->met[edge];
    p->met[edge] = true;
    return !second && item->cuts == 0 && p->mesh->face[2 * edge] >= 0 && p->mesh->face[2 * edge + 1] >= 0;
}

/* Edges that stand out are lines of their own, above the face. */
static void gprojx_paint_edges(gprojx_painter *p, const gprojx_item *item) {
    const gprojx_point *outline = gprojx_outline(p, item);
    int32_t i;
    for (i = 0; i < item->count; ++i) {
        gprojx_point side[2];
        int32_t e = outline[i].edge;
        if (e < 0) continue;
        side[0] = outline[i], side[1] = outline[(i + 1) % item->count];
        if (p->edge_most > 0 && !gprojx_is_idle(p, e)) {
            if (gprojx_waits(p, item, e)) continue;
            gprojx_begin_force(p, e);
        } else if (p->folded[e])
            fputs("<path class=\"f\"", p->file);
        else if (p->mesh->face[2 * e] < 0 || p->mesh->face[2 * e + 1] < 0)
            fputs("<path class=\"b\"", p->file);
        else if (item->cuts > 0)
            fputs("<path class=\"e\"", p->file);
        else
            continue; /* painted with its face */
        gprojx_put_path(p->file, side, 2, false);
        fputs("/>\n", p->file);
    }
}

/* The size of value that makes the widest edges; 0: no values. */
static double gprojx_edge_most(const gprojx_painter *p) {
    double most = 0;
    int32_t i;
    if (p->options->edge_value && p->options->edge_high > 0) return p->options->edge_high;
    for (i = 0; i < p->mesh->edge_count && p->options->edge_value; ++i) {
        double size = fabs(p->options->edge_value[i]);
        if (size > most && size < INFINITY) most = size;
    }
    return most;
}

/* The width of lines around a narrow face: a part of its width, as seen. */
static double gprojx_thin_line(const gprojx_painter *p, const gprojx_item *item) {
    const gprojx_point *q = gprojx_outline(p, item);
    double longest = 1e-9;
    int32_t i;
    for (i = 0; i < item->count; ++i) {
        const double *a = q[i].x, *b = q[(i + 1) % item->count].x;
        longest = fmax(longest, hypot(a[0] - b[0], a[1] - b[1]));
    }
    return fmax(0.02 * floor(5 * fabs(item->area) / longest), 0.1);
}

static void gprojx_paint(gprojx_painter *p, int32_t index) {
    gprojx_item item = *gprojx_item_at(p, index);
    unsigned colour = gprojx_hex(gprojx_face_colour(p, &item));
    fputs("<path", p->file);
    gprojx_put_path(p->file, gprojx_outline(p, &item), item.count, true);
    fprintf(p->file, " fill=\"#%06x\"", colour);
    if (item.cuts > 0 || p->edge_most > 0)
        fprintf(p->file, " stroke=\"#%06x\" stroke-width=\".5\"", colour); /* no seam to the next piece */
    else if (gprojx_thin_line(p, &item) < p->line) {
        fputs(" stroke-width=\"", p->file);
        gprojx_put_number(p->file, gprojx_thin_line(p, &item));
        fputc('"', p->file);
    }
    fputs("/>\n", p->file);
    gprojx_paint_edges(p, &item);
}

static void gprojx_put_words(FILE *file, double x, double y, int size, const char *more, const char *text) {
    fputs("<text", file);
    gprojx_put_attribute(file, "x", x);
    gprojx_put_attribute(file, "y", y);
    fprintf(file, " font-size=\"%d\"%s>", size, more);
    gprojx_put_text(file, text);
    fputs("</text>\n", file);
}

/* How the values are spread along the scale: filled columns, or a line. The root of the count is the height. */
static void gprojx_put_histogram(gprojx_painter *p, const double *value, double x, double y, double width, bool line) {
    enum {
        BINS = 60
    };
    double count[BINS] = {0}, most = 0;
    int32_t i;
    for (i = 0; i < p->mesh->face_count; ++i)
        if (p->mesh->face_degree[i] > 3 || p->options->linear)
            count[(int)gprojx_clamp(gprojx_scale_at(p->options, value[i]) * BINS, 0, BINS - 1)] += 1;
    for (i = 0; i < BINS; ++i) most = fmax(most, count[i]);
    if (most <= 0) return;
    fputs(line ? "<path fill=\"none\" stroke=\"#888\" stroke-width=\"1.2\" d=\"M" : "<path fill=\"#444\" d=\"M",
          p->file);
    gprojx_put_number(p->file, x);
    fputc(' ', p->file);
    gprojx_put_number(p->file, y);
    for (i = 0; i < BINS; ++i) {
        fputc('V', p->file);
        gprojx_put_number(p->file, y - 34 * sqrt(count[i] / most));
        fputc('H', p->file);
        gprojx_put_number(p->file, x + width * (i + 1) / BINS);
    }
    fputc('V', p->file);
    gprojx_put_number(p->file, y);
    fputs("\"/>\n", p->file);
}

static void gprojx_put_tick(gprojx_painter *p, double at, double y, double value, int exponent) {
    fputs("<path stroke=\"#333\"", p->file);
    {
        gprojx_point tick[2] = {{{0, 0, 0}, -1}, {{0, 0, 0}, -1}};
        tick[0].x[0] = tick[1].x[0] = at;
        tick[0].x[1] = y, tick[1].x[1] = y + 5;
        gprojx_put_path(p->file, tick, 2, false);
    }
    fputs("/>\n<text text-anchor=\"middle\" font-size=\"13\"", p->file);
    gprojx_put_attribute(p->file, "x", at);
    gprojx_put_attribute(p->file, "y", y + 20);
    if (!p->options->linear) {
        fprintf(p->file, ">10<tspan dy=\"-5\" font-size=\"10\">%s%d</tspan></text>\n",
                exponent < 0 ? "\xe2\x88\x92" : "", abs(exponent));
    } else {
        char text[32], *comma;
        snprintf(text, sizeof text, "%.3g", value);
        comma = strchr(text, ',');
        if (comma) *comma = '.';
        fprintf(p->file, ">%s</text>\n", text);
    }
}

static void gprojx_put_scale(gprojx_painter *p, double x, double y, double width) {
    double low, high;
    int i, first, last;
    gprojx_scale_ends(p->options, &low, &high);
    fputs("<defs><linearGradient id=\"scale\">", p->file);
    for (i = 0; i <= 12; ++i) {
        fputs("<stop", p->file);
        gprojx_put_attribute(p->file, "offset", i / 12.0);
        fprintf(p->file, " stop-color=\"#%06x\"/>", gprojx_hex(gprojx_map(i / 12.0)));
    }
    fputs("</linearGradient></defs>\n<rect fill=\"url(#scale)\" stroke=\"#333\" stroke-width=\".6\" height=\"14\"",
          p->file);
    gprojx_put_attribute(p->file, "x", x);
    gprojx_put_attribute(p->file, "y", y);
    gprojx_put_attribute(p->file, "width", width);
    fputs("/>\n", p->file);
    if (p->options->linear) {
        for (i = 0; i <= 4; ++i) gprojx_put_tick(p, x + width * i / 4, y + 14, low + (high - low) * i / 4, 0);
        return;
    }
    first = (int)ceil(log10(low) - 1e-9), last = (int)floor(log10(high) + 1e-9);
    for (i = last; i >= first; i -= last - first > 6 ? 3 : 1)
        gprojx_put_tick(p, x + width * gprojx_scale_at(p->options, pow(10, i)), y + 14, 0, i);
}

/* One side of the scale of forces, from 0 to that of the widest edges: samples of the lines, mirrored for tension. */
static void gprojx_put_forces(gprojx_painter *p, double x, double y, double width, bool tension) {
    int level;
    for (level = 0; level < GPROJX_EDGE_LEVELS; ++level) {
        double t = (level + 0.5) / GPROJX_EDGE_LEVELS, high = gprojx_edge_width(p, sqrt(t) * GPROJX_EDGE_LEVELS);
        double left =
            tension ? x + width * (1 - (level + 1.0) / GPROJX_EDGE_LEVELS) : x + width * level / GPROJX_EDGE_LEVELS;
        fprintf(p->file, "<rect fill=\"#%06x\"", gprojx_hex(gprojx_force_colour(tension, sqrt(t))));
        gprojx_put_attribute(p->file, "x", left);
        gprojx_put_attribute(p->file, "y", y - high);
        gprojx_put_attribute(p->file, "width", width / GPROJX_EDGE_LEVELS + 0.2);
        gprojx_put_attribute(p->file, "height", 2 * high);
        fputs("/>\n", p->file);
    }
}

/* A number below the scale of forces. */
static void gprojx_put_force(gprojx_painter *p, double x, double y, double force) {
    char text[32], *comma;
    snprintf(text, sizeof text, "%.3g", force);
    comma = strchr(text, ',');
    if (comma) *comma = '.';
    gprojx_put_words(p->file, x, y, 13, " text-anchor=\"middle\"", text);
}

/* The scale of forces, twice as wide as the lines: tension, if there is any, left of 0, compression right of it. */
static void gprojx_put_force_scale(gprojx_painter *p, double x, double y) {
    const double width = 200;
    bool tension = false, compression = false;
    int32_t e;
    for (e = 0; e < p->mesh->edge_count; ++e) {
        if (p->options->edge_value[e] < -1e-3 * p->edge_most) tension = true;
        if (p->options->edge_value[e] > 1e-3 * p->edge_most) compression = true;
    }
    if (tension) {
        gprojx_put_forces(p, x, y, width, true);
        gprojx_put_force(p, x + 8, y + 26, -p->edge_most);
        gprojx_put_words(p->file, x, y - 14, 14, "", compression ? "tension" : "axial forces: tension alone");
        x += width;
    }
    gprojx_put_force(p, x, y + 26, 0);
    if (tension && !compression) return;
    gprojx_put_forces(p, x, y, width, false);
    gprojx_put_force(p, x + width / 2, y + 26, p->edge_most / 2);
    gprojx_put_force(p, x + width, y + 26, p->edge_most);
    gprojx_put_words(p->file, x + (tension ? width / 2 : 0), y - 14, 14, "",
                     tension ? "compression" : "axial forces: compression alone");
}

/* A line of the legend: how many there are, and right of it a sample of this height, so that the words end inside the
   picture in any font. */
static void gprojx_put_mark(gprojx_painter *p, double y, double height, int32_t count, const char *shape,
                            const char *one, const char *many) {
    const double x = p->width - 62;
    char text[96];
    snprintf(text, sizeof text, "%ld %s", (long)count, count == 1 ? one : many);
    fputs("<path", p->file);
    {
        gprojx_point sample[4] = {{{0, 0, 0}, -1}, {{0, 0, 0}, -1}, {{0, 0, 0}, -1}, {{0, 0, 0}, -1}};
        sample[0].x[0] = sample[3].x[0] = x, sample[1].x[0] = sample[2].x[0] = x + 22;
        sample[0].x[1] = sample[1].x[1] = y - height / 2, sample[2].x[1] = sample[3].x[1] = y + height / 2;
        gprojx_put_path(p->file, sample, 4, true);
    }
    fprintf(p->file, " %s/>\n", shape);
    gprojx_put_words(p->file, x - 8, y + 5, 14, " text-anchor=\"end\"", text);
}

static void gprojx_put_legend(gprojx_painter *p) {
    const double x = 40, width = 480, y = p->height - 52;
    if (p->options->face_value) {
        if (p->options->face_before) gprojx_put_histogram(p, p->options->face_before, x, y, width, true);
        gprojx_put_histogram(p, p->options->face_value, x, y, width, false);
        gprojx_put_scale(p, x, y, width);
        gprojx_put_words(p->file, x + width + 24, y + 12, 14, "", p->options->legend ? p->options->legend : "");
        if (p->options->face_before)
            gprojx_put_words(p->file, x + width + 24, y - 8, 13, " fill=\"#777\"",
                             "faces along the scale: now (dark), before (line)");
    }
    if (p->edge_most > 0)
        gprojx_put_force_scale(p, p->options->face_value ? x + width + 24 : x, p->options->face_value ? y - 58 : y);
    if (p->turned_count > 0)
        gprojx_put_mark(p, y + 8, 10, p->turned_count, "fill=\"#e66e28\" stroke=\"#222\"", "face turned over",
                        "faces turned over");
    if (p->folded_count > 0)
        gprojx_put_mark(p, y - 14, 0, p->folded_count, "stroke=\"#d4002a\" stroke-width=\"2.5\"", "folded edge",
                        "folded edges");
    if (p->crossed_count > 0)
        gprojx_put_mark(p, y - 36, 10, p->crossed_count, "fill=\"#f2c200\" stroke=\"#222\"", "bow-tie: crosses itself",
                        "bow-ties: cross themselves");
    if (p->collapsed_count > 0)
        gprojx_put_mark(p, y - 58, 10, p->collapsed_count, "fill=\"none\" stroke=\"#d4002a\"",
                        "collapsed edge (ringed)", "collapsed edges (ringed)");
}

/* The mean length of an edge as seen gives the width of lines. */
static void gprojx_choose_line(gprojx_painter *p) {
    double sum = 0;
    int32_t i;
    for (i = 0; i < p->mesh->edge_count; ++i) {
        const double *a = p->vertex[p->mesh->origin[2 * i]].x, *b = p->vertex[p->mesh->origin[2 * i + 1]].x;
        double length = hypot(a[0] - b[0], a[1] - b[1]);
        if (length < 1e6) sum += length;
    }
    p->line = gprojx_clamp(p->mesh->edge_count > 0 ? 0.035 * sum / p->mesh->edge_count : 1, 0.12, 1.1);
}

/* The styles of edges by value: p0.. of positive, t0.. of negative ones, from thin and pale to wide and deep. */
static void gprojx_put_edge_styles(gprojx_painter *p) {
    int sign, level;
    fputs("<style>", p->file);
    for (sign = 0; sign < 2; ++sign)
        for (level = 0; level <= GPROJX_EDGE_LEVELS; ++level) {
            fprintf(p->file, ".%c%d{fill:none;stroke:#%06x;stroke-width:", sign ? 't' : 'p', level,
                    gprojx_hex(gprojx_force_colour(sign, (double)level / GPROJX_EDGE_LEVELS)));
            gprojx_put_number(p->file, gprojx_edge_width(p, level));
            fputs("}", p->file);
        }
    fputs("</style>\n", p->file);
}

static void gprojx_put_head(gprojx_painter *p) {
    fputs("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ", p->file);
    gprojx_put_number(p->file, p->width);
    fputc(' ', p->file);
    gprojx_put_number(p->file, floor(p->height));
    fputc('"', p->file);
    gprojx_put_attribute(p->file, "width", p->width);
    gprojx_put_attribute(p->file, "height", floor(p->height));
    fputs(" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" fill=\"#222\">\n", p->file);
    if (p->options->title) {
        fputs("<title>", p->file);
        gprojx_put_text(p->file, p->options->title);
        fputs("</title>\n", p->file);
    }
    fputs("<style>.m{stroke:#22304a;stroke-linejoin:round;stroke-linecap:round}.e,.b,.f{fill:none}.b{stroke:#10182c}"
          ".f{stroke:#d4002a}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
          p->file);
    if (p->options->title) gprojx_put_words(p->file, 40, 46, 24, " font-weight=\"bold\"", p->options->title);
    if (p->options->caption) gprojx_put_words(p->file, 40, 70, 15, " fill=\"#555\"", p->options->caption);
    fputs("<style>.m{stroke-width:", p->file);
    gprojx_put_number(p->file, p->line);
    fputs("}.b{stroke-width:", p->file);
    gprojx_put_number(p->file, 2.2 * p->line);
    fputs("}.f{stroke-width:", p->file);
    gprojx_put_number(p->file, fmax(3 * p->line, 1.6));
    fputs("}</style>\n", p->file);
    if (p->edge_most > 0) gprojx_put_edge_styles(p);
}

/* A face once more, above all. */
static void gprojx_put_face_mark(gprojx_painter *p, int32_t face, const char *style, gprojx_point *corner) {
    int32_t h = p->mesh->face_halfedge[face], k;
    for (k = 0; k < p->mesh->face_degree[face]; ++k, h = p->mesh->next[h]) corner[k] = p->vertex[p->mesh->origin[h]];
    fprintf(p->file, "<path %s", style);
    gprojx_put_path(p->file, corner, p->mesh->face_degree[face], true);
    fputs("/>\n", p->file);
}

/* Marked faces and edges once more above all, so that none is hidden. `corner` has room for any face. A collapsed edge is
   too short to be seen: a ring stands around it. */
static void gprojx_put_marks(gprojx_painter *p, gprojx_point *corner) {
    int32_t i, k;
    if (p->turned_count + p->crossed_count + p->folded_count + p->collapsed_count == 0) return;
    fputs("<g fill=\"none\" stroke-opacity=\".6\" stroke-linejoin=\"round\">\n", p->file);
    for (i = 0; i < p->mesh->face_count; ++i) {
        if (p->turned[i])
            gprojx_put_face_mark(p, i, "stroke=\"#c2410c\" fill=\"#e66e28\" fill-opacity=\".25\"", corner);
        if (p->crossed[i])
            gprojx_put_face_mark(p, i, "stroke=\"#8a6d00\" fill=\"#f2c200\" fill-opacity=\".4\"", corner);
    }
    for (i = 0; i < p->mesh->edge_count; ++i) {
        if (!p->folded[i] && !p->collapsed[i]) continue;
        for (k = 0; k < 2; ++k) corner[k] = p->vertex[p->mesh->origin[2 * i + k]];
        if (p->folded[i]) {
            fputs("<path stroke=\"#d4002a\" stroke-dasharray=\"4 3\"", p->file);
            gprojx_put_path(p->file, corner, 2, false);
            fputs("/>\n", p->file);
        }
        if (p->collapsed[i]) {
            fputs("<circle stroke=\"#d4002a\" stroke-width=\"2\" r=\"7\"", p->file);
            gprojx_put_attribute(p->file, "cx", (corner[0].x[0] + corner[1].x[0]) / 2);
            gprojx_put_attribute(p->file, "cy", (corner[0].x[1] + corner[1].x[1]) / 2);
            fputs("/>\n", p->file);
        }
    }
    fputs("</g>\n", p->file);
}

/* The shadow: all faces, projected to the ground, as one path in whole pixels. */
static void gprojx_put_shadow(gprojx_painter *p) {
    const gproj_mesh *mesh = p->mesh;
    double ground = INFINITY;
    int32_t i, k;
    for (i = 0; i < mesh->vertex_count; ++i)
        if (mesh->vertex_halfedge[i] >= 0) ground = fmin(ground, mesh->position[3 * i + 2]);
    fputs("<path fill=\"#e6eaee\" d=\"", p->file);
    for (i = 0; i < mesh->face_count; ++i) {
        double area[3];
        int32_t h = mesh->face_halfedge[i];
        gprojx_area_of(mesh, mesh->position, i, area);
        for (k = 0; k < mesh->face_degree[i]; ++k, h = area[2] < 0 ? mesh->prev[h] : mesh->next[h]) {
            double foot[3], x[3], w;
            memcpy(foot, mesh->position + 3 * mesh->origin[h], sizeof foot);
            foot[2] = ground;
            gprojx_camera(p, foot, x);
            w = p->scale * (p->eye > 0 ? p->eye / (p->eye - x[2]) : 1);
            fprintf(p->file, "%c%.0f %.0f", k ? 'L' : 'M', p->shift[0] + w * x[0], p->shift[1] - w * x[1]);
        }
        fputc('z', p->file);
    }
    fputs("\"/>\n", p->file);
}

static gproj_code gprojx_draw(gprojx_painter *p) {
    gprojx_point *corner;
    int32_t i, most = 3;
    gprojx_look(p);
    gprojx_find_box(p);
    if (!gprojx_project(p) || !gprojx_find_marks(p) || !gprojx_make_grid(p)) return GPROJ_ERROR_MEMORY;
    gprojx_choose_line(p);
    p->edge_most = gprojx_edge_most(p);
    for (i = 0; i < p->mesh->face_count; ++i)
        if (p->mesh->face_degree[i] > most) most = p->mesh->face_degree[i];
    corner = (gprojx_point *)malloc((size_t)most * sizeof *corner);
    for (i = 0; corner && i < p->mesh->face_count && !p->failed; ++i) gprojx_add_face(p, i, corner);
    if (!corner || p->failed) {
        free(corner);
        return GPROJ_ERROR_MEMORY;
    }
    gprojx_put_head(p);
    if (p->options->shadow) gprojx_put_shadow(p);
    fputs("<g class=\"m\">\n", p->file);
    gprojx_paint_all(p);
    fputs("</g>\n", p->file);
    gprojx_put_marks(p, corner);
    free(corner);
    gprojx_put_legend(p);
    fputs("</svg>\n", p->file);
    if (p->failed) return GPROJ_ERROR_MEMORY;
    return ferror(p->file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

/* Writes the picture. Returns GPROJ_OK, GPROJ_ERROR_MEMORY or GPROJ_ERROR_FILE; after an error the file is not
   complete. `options` may be NULL. */
static gproj_code gprojx_picture(FILE *file, const gproj_mesh *mesh, const gprojx_picture_options *options) {
    static const gprojx_picture_options none;
    gprojx_painter painter;
    gproj_code code;
    memset(&painter, 0, sizeof painter);
    painter.mesh = mesh;
    painter.options = options ? options : &none;
    painter.file = file;
    code = gprojx_draw(&painter);
    free(painter.vertex), free(painter.cell);
    free(painter.turned), free(painter.crossed), free(painter.folded), free(painter.collapsed), free(painter.met);
    free(painter.point.data), free(painter.item.data), free(painter.link.data), free(painter.arc.data);
    free(painter.heap.data), free(painter.ahead.data);
    return code;
}

#endif
