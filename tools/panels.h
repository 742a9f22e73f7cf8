/* panels.h - the faces of a mesh laid flat at true size on sheets, to be cut: SVG, DXF (R12) and a table as CSV.

       gprojx_panels *panels = gprojx_panels_create(mesh, NULL, &options, &error);
       if (!panels) puts(error.message);                   a face that is not planar, or larger than a sheet, by name
       if (gprojx_panels_svg(file, panels) != GPROJ_OK) ...
       gprojx_panels_destroy(panels);

   A panel is moved rigidly and shows the side of the face that the mesh's normals show. It bears the face's number;
   along each edge the neighbour's number and the dihedral angle, measured behind the panels: below 180 degrees a ridge,
   above a valley; and at each inner edge a tick in the middle, where the neighbour has one, too. Support strips (the
   faces of gproj_mesh_support) are called S and the edge's number; they bear the numbers of the faces beside them along
   the edge of the mesh, and V and the vertex's number at both ends.

   Include guidedproj.h before this file. Memory by malloc; no global state; numbers are written without regard to the
   locale, those of outlines so that they read back to the same bits. */
#ifndef GPROJX_PANELS_H
#define GPROJX_PANELS_H

#include <float.h>

#include "picture.h"

#define GPROJX_PANEL_FLAT 1e-6 /* a corner's largest distance from the panel's plane, in half the panel's perimeter */

/* Lengths in millimetres. */
typedef struct gprojx_panel_options {
    double width, height; /* of a sheet; 0: one sheet that has room for all */
    double gap;           /* between panels, and at the sheet's border; 0: a twentieth of the mean edge length */
    double scale;         /* millimetres that the mesh's unit is; 0: 1 */
} gprojx_panel_options;

typedef struct gprojx_panel {
    bool strip;            /* face `number` of the support mesh, else of the mesh */
    int32_t number;        /* strips: the edge's, too */
    int32_t first, count;  /* corners; corner k is the face's corner k */
    int32_t sheet;         /* from 0 */
    double area, flatness; /* largest distance from the plane */
    double size[2];        /* bounding rectangle on the sheet */
    double place[2];       /* from the sheet's left upper corner, downwards */
    double label[2], room; /* a point inside, and how far it is from the outline */
} gprojx_panel;

typedef struct gprojx_panels {
    const gproj_mesh *mesh, *support; /* support: may be NULL */
    gprojx_panel_options options;     /* those that were not given are chosen */
    int32_t count, sheet_count;
    gprojx_panel *panel; /* faces in their order, then strips */
    double *corner;      /* x and y of all corners, from the left lower corner of their sheet, y upwards */
    double used;         /* area of all panels over that of the sheets */
} gprojx_panels;

static const gproj_mesh *gprojx_mesh_of(const gprojx_panels *p, const gprojx_panel *panel) {
    return panel->strip ? p->support : p->mesh;
}

/* Makes a unit vector of one of any size, so that products neither overflow nor vanish; 0 stays 0. */
static void gprojx_unit(double v[3]) {
    double size = hypot(hypot(v[0], v[1]), v[2]);
    int k;
    for (k = 0; size > 0 && k < 3; ++k) v[k] /= size;
}

static double gprojx_far2(const double a[2], const double b[2]) { return hypot(b[0] - a[0], b[1] - a[1]); }

/* ---- one panel in its plane ---- */

/* Lays a face into the plane: corner 0 at the origin, the longest side along x. Returns half the perimeter; *flatness
   is a corner's largest distance from the plane, infinite without an area. If it is large, no corner is written. */
static double gprojx_flatten(const gproj_mesh *mesh, int32_t face, double scale, double *corner, double *flatness) {
    int32_t first = mesh->face_halfedge[face], degree = mesh->face_degree[face], h, k;
    const double *start = mesh->position + 3 * (size_t)mesh->origin[first];
    double n[3], x[3] = {0, 0, 0}, y[3], longest = 0, half = 0, size, low = 0, high = 0;
    gproj_mesh_face_area_vector(mesh, face, n);
    size = hypot(hypot(n[0], n[1]), n[2]);
    for (k = 0, h = first; k < degree; ++k, h = mesh->next[h]) {
        double side[3], length;
        gprojx_side(mesh, h, side);
        length = sqrt(gprojx_dot(side, side));
        if (length > longest) longest = length, memcpy(x, side, sizeof x);
        half += scale * length / 2;
    }
    *flatness = INFINITY;
    if (!(scale * scale * size > 1e-12 * half * half)) return half;
    for (k = 0; k < 3; ++k) n[k] /= size;
    for (k = 0, h = first; k < degree; ++k, h = mesh->next[h]) {
        const double *p = mesh->position + 3 * (size_t)mesh->origin[h];
        double z = scale * (n[0] * (p[0] - start[0]) + n[1] * (p[1] - start[1]) + n[2] * (p[2] - start[2]));
        low = fmin(low, z), high = fmax(high, z);
    }
    *flatness = (high - low) / 2;
    if (*flatness > GPROJX_PANEL_FLAT * half) return half;
    size = gprojx_dot(n, x);
    for (k = 0; k < 3; ++k) x[k] -= size * n[k];
    size = sqrt(gprojx_dot(x, x));
    for (k = 0; k < 3; ++k) x[k] /= size;
    gprojx_cross(n, x, y);
    for (h = first; degree > 0; --degree, h = mesh->next[h], corner += 2) {
        const double *p = mesh->position + 3 * (size_t)mesh->origin[h];
        double d[3];
        for (k = 0; k < 3; ++k) d[k] = scale * (p[k] - start[k]);
        corner[0] = gprojx_dot(x, d), corner[1] = gprojx_dot(y, d);
    }
    return half;
}

static int gprojx_compare_corners(const void *a, const void *b) {
    const double *p = (const double *)a, *q = (const double *)b;
    if (p[0] < q[0] || p[0] > q[0]) return p[0] < q[0] ? -1 : 1;
    return p[1] < q[1] ? -1 : p[1] > q[1];
}

/* Twice the signed area of the triangle a b c. */
static double gprojx_turn(const double a[2], const double b[2], const double c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Writes the convex hull, counter-clockwise, to hull (room for 2 * count points; sorted is as large) by Andrew's
   monotone chain (1979). Returns the number of its points. */
static int32_t gprojx_hull(const double *corner, int32_t count, double *sorted, double *hull) {
    int32_t size = 0, least, pass, i;
    memcpy(sorted, corner, 2 * (size_t)count * sizeof *sorted);
    qsort(sorted, (size_t)count, 2 * sizeof *sorted, gprojx_compare_corners);
    for (pass = 0; pass < 2; ++pass) {
        /* The lower chain from left to right, then the upper one back; the last point of each begins the other. */
        for (i = 0, least = size + 1; i < count; ++i) {
            const double *q = sorted + 2 * (pass ? count - 1 - i : i);
            while (size > least && !(gprojx_turn(hull + 2 * size - 4, hull + 2 * size - 2, q) > 0)) --size;
            memcpy(hull + 2 * size++, q, 2 * sizeof *hull);
        }
        --size;
    }
    return size;
}

typedef struct gprojx_rectangle { /* a bounding rectangle with one side along an edge of the hull */
    double along[2];              /* the side's direction */
    double origin[2];             /* its left lower corner, in `along` and the normal to it */
    double size[2];
} gprojx_rectangle;

/* Finds the rectangle along each edge of the hull by rotating calipers (Toussaint 1983) and keeps the smallest one that
   fits into width x height in one of two positions; if none does, the smallest of all. Returns whether one fits. */
static bool gprojx_find_rectangle(const double *hull, int32_t count, double width, double height,
                                  gprojx_rectangle *best) {
    int32_t extreme[3] = {1, 1, 1}, i, k; /* farthest along the edge, away from it, and back */
    double least = INFINITY;
    bool found = false;
    memset(best, 0, sizeof *best);
    for (i = 0; i < count; ++i) {
        const double *a = hull + 2 * i, *b = hull + 2 * ((i + 1) % count);
        double length = gprojx_far2(a, b), u[2], reach[3];
        gprojx_rectangle box;
        bool fits;
        u[0] = (b[0] - a[0]) / length, u[1] = (b[1] - a[1]) / length;
        for (k = 0; k < 3; ++k) {
            const double d[3][2] = {{u[0], u[1]}, {-u[1], u[0]}, {-u[0], -u[1]}};
            if (k > 0 && extreme[k] < extreme[k - 1]) extreme[k] = extreme[k - 1];
            if (extreme[k] <= i) extreme[k] = i + 1;
            for (;; ++extreme[k]) {
                const double *p = hull + 2 * (extreme[k] % count), *q = hull + 2 * ((extreme[k] + 1) % count);
                reach[k] = d[k][0] * p[0] + d[k][1] * p[1];
                if (!(d[k][0] * q[0] + d[k][1] * q[1] > reach[k])) break;
            }
        }
        memcpy(box.along, u, sizeof u);
        box.origin[0] = -reach[2], box.origin[1] = -u[1] * a[0] + u[0] * a[1];
        box.size[0] = reach[0] + reach[2], box.size[1] = reach[1] - box.origin[1];
        fits = (box.size[0] <= width && box.size[1] <= height) || (box.size[1] <= width && box.size[0] <= height);
        if (found > fits || (found == fits && box.size[0] * box.size[1] >= least)) continue;
        found = fits, least = box.size[0] * box.size[1], *best = box;
    }
    return found;
}

/* Turns the panel so that it lies in the rectangle 0..size, longer side along x if that fits into the width. */
static void gprojx_turn_into(const gprojx_rectangle *box, double width, double *corner, gprojx_panel *panel) {
    bool lies = box->size[0] >= box->size[1];
    int32_t i;
    if (fmax(box->size[0], box->size[1]) > width) lies = !lies;
    panel->size[0] = box->size[!lies], panel->size[1] = box->size[lies];
    for (i = 0; i < panel->count; ++i) {
        double *c = corner + 2 * i;
        double x = box->along[0] * c[0] + box->along[1] * c[1] - box->origin[0];
        double y = -box->along[1] * c[0] + box->along[0] * c[1] - box->origin[1];
        c[0] = lies ? x : box->size[1] - y, c[1] = lies ? y : x;
    }
}

/* The distance from a point to the outline; negative outside. */
static double gprojx_clearance(const double *corner, int32_t count, double x, double y) {
    double nearest = INFINITY;
    bool inside = false;
    int32_t i;
    for (i = 0; i < count; ++i) {
        const double *a = corner + 2 * i, *b = corner + 2 * ((i + 1) % count);
        double u = b[0] - a[0], v = b[1] - a[1], t = (x - a[0]) * u + (y - a[1]) * v, square = u * u + v * v;
        t = gprojx_clamp(square > 0 ? t / square : 0, 0, 1);
        nearest = fmin(nearest, hypot(a[0] + t * u - x, a[1] + t * v - y));
        if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / v * u) inside = !inside;
    }
    return inside ? nearest : -nearest;
}

/* Finds where the number goes: the centroid if there is room enough around it, else about the point with the most
   room. Measures the area on the way. */
static void gprojx_find_label(const double *corner, gprojx_panel *panel) {
    double sum[2] = {0, 0}, best[2], step = fmax(panel->size[0], panel->size[1]) / 8, room;
    int32_t i, j, round;
    panel->area = 0, panel->room = -INFINITY;
    for (i = 1; i + 1 < panel->count; ++i) {
        const double *a = corner, *b = corner + 2 * i;
        double area = gprojx_turn(a, b, b + 2) / 2;
        panel->area += area;
        for (j = 0; j < 2; ++j) sum[j] += area * (a[j] + b[j] + b[j + 2]) / 3;
    }
    best[0] = panel->size[0] / 2, best[1] = panel->size[1] / 2;
    for (round = 0; round < 8; ++round, step /= 2) {
        double centre[2];
        int32_t reach = round == 0 ? 4 : 1; /* a grid over the panel, then steps from the best point */
        memcpy(centre, best, sizeof centre);
        for (i = -reach; i <= reach; ++i)
            for (j = -reach; j <= reach; ++j) {
                room = gprojx_clearance(corner, panel->count, centre[0] + i * step, centre[1] + j * step);
                if (room <= panel->room) continue;
                panel->room = room, best[0] = centre[0] + i * step, best[1] = centre[1] + j * step;
            }
    }
    room = gprojx_clearance(corner, panel->count, sum[0] / panel->area, sum[1] / panel->area);
    if (room > 0.7 * panel->room) panel->room = room, best[0] = sum[0] / panel->area, best[1] = sum[1] / panel->area;
    memcpy(panel->label, best, sizeof best);
}

/* ---- on sheets ---- */

typedef struct gprojx_shelf {
    int32_t sheet;
    double top, used; /* from the sheet's top, and from the left */
} gprojx_shelf;

static int gprojx_compare_panels(const void *a, const void *b) {
    const gprojx_panel *p = *(const gprojx_panel *const *)a, *q = *(const gprojx_panel *const *)b;
    if (p->size[1] < q->size[1] || p->size[1] > q->size[1]) return p->size[1] > q->size[1] ? -1 : 1;
    if (p->size[0] < q->size[0] || p->size[0] > q->size[0]) return p->size[0] > q->size[0] ? -1 : 1;
    return p < q ? -1 : p > q;
}

/* Puts panels on shelves, first fit by decreasing height (Coffman, Garey, Johnson, Tarjan 1980), and shelves likewise
   on sheets. `shelf` and `filled` have room for one a panel. */
static void gprojx_fill_sheets(gprojx_panels *p, gprojx_panel **order, gprojx_shelf *shelf, double *filled) {
    const gprojx_panel_options *o = &p->options;
    double narrow = INFINITY, low = INFINITY, height = o->height > 0 ? o->height : INFINITY;
    int32_t shelves = 0, first = 0, first_sheet = 0, s, i;
    for (i = 0; i < p->count; ++i) narrow = fmin(narrow, p->panel[i].size[0]), low = fmin(low, p->panel[i].size[1]);
    for (i = 0; i < p->count; ++i) {
        gprojx_panel *panel = order[i];
        /* Shelves and sheets that are full stay behind, so that many panels do not look at all of them. */
        while (first < shelves && shelf[first].used + narrow + o->gap > o->width) ++first;
        while (first_sheet < p->sheet_count && filled[first_sheet] + low + o->gap > height) ++first_sheet;
        for (s = first; s < shelves && shelf[s].used + panel->size[0] + o->gap > o->width; ++s) continue;
        if (s == shelves) {
            int32_t sheet = first_sheet;
            while (sheet < p->sheet_count && filled[sheet] + panel->size[1] + o->gap > height) ++sheet;
            if (sheet == p->sheet_count) filled[p->sheet_count++] = o->gap;
            shelf[shelves].sheet = sheet, shelf[shelves].top = filled[sheet], shelf[shelves++].used = o->gap;
            filled[sheet] += panel->size[1] + o->gap;
        }
        panel->sheet = shelf[s].sheet;
        panel->place[0] = shelf[s].used, panel->place[1] = shelf[s].top;
        shelf[s].used += panel->size[0] + o->gap;
    }
    if (!(o->height > 0)) p->options.height = p->sheet_count > 0 ? filled[0] : 1;
}

/* Chooses the width of a single sheet: about a square, at least the longest panel. */
static void gprojx_choose_width(gprojx_panels *p) {
    double area = 0, longest = 0, gap = p->options.gap;
    int32_t i;
    for (i = 0; i < p->count; ++i) {
        const gprojx_panel *panel = &p->panel[i];
        area += (panel->size[0] + gap) * (panel->size[1] + gap);
        longest = fmax(longest, panel->size[0]);
    }
    p->options.width = fmax(longest + gap, sqrt(1.1 * area)) + 1.001 * gap;
}

/* Packs all panels and moves the corners to their places. Returns false without memory. */
static bool gprojx_pack(gprojx_panels *p) {
    size_t room = (size_t)p->count + 1;
    gprojx_panel **order = (gprojx_panel **)malloc(room * sizeof *order);
    gprojx_shelf *shelf = (gprojx_shelf *)malloc(room * sizeof *shelf);
    double *filled = (double *)calloc(room, sizeof *filled), area = 0;
    bool good = order && shelf && filled;
    int32_t i, k;
    if (!(p->options.width > 0)) gprojx_choose_width(p);
    for (i = 0; good && i < p->count; ++i) order[i] = &p->panel[i];
    if (good) qsort(order, (size_t)p->count, sizeof *order, gprojx_compare_panels);
    if (good) gprojx_fill_sheets(p, order, shelf, filled);
    for (i = 0; good && i < p->count; ++i) {
        gprojx_panel *panel = &p->panel[i];
        double up = p->options.height - panel->place[1] - panel->size[1];
        for (k = panel->first; k < panel->first + panel->count; ++k)
            p->corner[2 * k] += panel->place[0], p->corner[2 * k + 1] += up;
        panel->label[0] += panel->place[0], panel->label[1] += up;
        area += panel->area;
    }
    p->used = area / (p->options.width * p->options.height * fmax(1, p->sheet_count));
    free(order), free(shelf), free(filled);
    return good;
}

/* ---- making panels ---- */

/* Names a panel as sentences do. */
static void gprojx_panel_words(const gprojx_panels *p, const gprojx_panel *panel, char words[96]) {
    int32_t h = 2 * panel->number;
    if (panel->strip)
        snprintf(words, 96, "the strip along edge %ld (vertices %ld and %ld)", (long)panel->number,
                 (long)p->mesh->origin[h], (long)p->mesh->origin[h + 1]);
    else
        snprintf(words, 96, "face %ld", (long)panel->number);
}

/* Says why there are no panels. Returns false. */
static bool gprojx_panel_fail(const gprojx_panels *p, const gprojx_panel *panel, const char *reason,
                              gproj_error *error) {
    char words[96];
    gprojx_panel_words(p, panel, words);
    error->code = GPROJ_ERROR_DEGENERATE;
    error->place = panel->strip ? GPROJ_PLACE_EDGE : GPROJ_PLACE_FACE;
    error->index = panel->number;
    snprintf(error->message, sizeof error->message, "%s %s", words, reason);
    return false;
}

/* Lays one panel flat. work: room for 6 * count numbers. */
static bool gprojx_make_panel(const gprojx_panels *p, gprojx_panel *panel, double *work, gproj_error *error) {
    const gproj_mesh *mesh = gprojx_mesh_of(p, panel);
    const gprojx_panel_options *o = &p->options;
    double *corner = p->corner + 2 * (size_t)panel->first, *hull = work + 2 * (size_t)panel->count;
    double width = o->width > 0 ? o->width - 2 * o->gap : INFINITY,
           height = o->height > 0 ? o->height - 2 * o->gap : INFINITY, half;
    char reason[160];
    gprojx_rectangle box;
    half = gprojx_flatten(mesh, panel->number, o->scale, corner, &panel->flatness);
    if (panel->flatness > DBL_MAX) return gprojx_panel_fail(p, panel, "has no area", error);
    if (panel->flatness > GPROJX_PANEL_FLAT * half) {
        snprintf(reason, sizeof reason,
                 "is not planar: it is off its plane by %.1e of half its perimeter, panels by %.0e at most",
                 panel->flatness / half, GPROJX_PANEL_FLAT);
        return gprojx_panel_fail(p, panel, reason, error);
    }
    if (gprojx_is_crossed(mesh, panel->number))
        return gprojx_panel_fail(p, panel, "crosses itself and cannot be cut", error);
    if (!gprojx_find_rectangle(hull, gprojx_hull(corner, panel->count, work, hull), width, height, &box)) {
        snprintf(reason, sizeof reason, "takes %.6g x %.6g mm and the sheet has %.6g x %.6g mm inside its border",
                 fmax(box.size[0], box.size[1]), fmin(box.size[0], box.size[1]), fmax(width, 0), fmax(height, 0));
        return gprojx_panel_fail(p, panel, reason, error);
    }
    gprojx_turn_into(&box, width, corner, panel);
    gprojx_find_label(corner, panel);
    return true;
}

static bool gprojx_make_panels(gprojx_panels *p, gproj_error *error) {
    const gproj_mesh *mesh = p->mesh;
    size_t corners = 0;
    int32_t strips = p->support ? p->support->face_count : 0, most = 4, i;
    double *work;
    bool good = true;
    for (i = 0; i < mesh->face_count; ++i) {
        corners += (size_t)mesh->face_degree[i];
        if (mesh->face_degree[i] > most) most = mesh->face_degree[i];
    }
    corners += 4 * (size_t)strips;
    p->count = mesh->face_count + strips;
    p->panel = (gprojx_panel *)calloc((size_t)p->count + 1, sizeof *p->panel);
    p->corner = (double *)malloc((2 * corners + 1) * sizeof *p->corner);
    work = (double *)malloc(8 * (size_t)most * sizeof *work);
    if (!p->panel || !p->corner || !work || corners > INT32_MAX) {
        error->code = GPROJ_ERROR_MEMORY;
        good = false;
    }
    for (i = 0, corners = 0; good && i < p->count; ++i) {
        gprojx_panel *panel = &p->panel[i];
        panel->strip = i >= mesh->face_count;
        panel->number = panel->strip ? i - mesh->face_count : i;
        panel->first = (int32_t)corners;
        panel->count = gprojx_mesh_of(p, panel)->face_degree[panel->number];
        corners += (size_t)panel->count;
        good = gprojx_make_panel(p, panel, work, error);
    }
    free(work);
    return good;
}

static void gprojx_panels_destroy(gprojx_panels *panels) {
    if (panels) free(panels->panel), free(panels->corner);
    free(panels);
}

/* Lays the faces flat and, if `support` is not NULL, the faces of that mesh, made from this one by gproj_mesh_support.
   Both meshes must outlive the panels. Returns NULL if a panel is not planar to GPROJX_PANEL_FLAT, crosses itself or is
   larger than a sheet (GPROJ_ERROR_DEGENERATE), or without memory. `error` must be there. */
static gprojx_panels *gprojx_panels_create(const gproj_mesh *mesh, const gproj_mesh *support,
                                           const gprojx_panel_options *options, gproj_error *error) {
    gprojx_panels *p = (gprojx_panels *)calloc(1, sizeof *p);
    memset(error, 0, sizeof *error);
    if (p) {
        p->mesh = mesh, p->support = support, p->options = *options;
        if (!(p->options.scale > 0)) p->options.scale = 1;
        if (!(p->options.gap > 0)) p->options.gap = 0.05 * p->options.scale * gproj_mesh_mean_edge_length(mesh);
        if (gprojx_make_panels(p, error) && gprojx_pack(p)) return p;
    }
    if (error->code == GPROJ_OK) error->code = GPROJ_ERROR_MEMORY;
    gprojx_panels_destroy(p);
    return NULL;
}

/* ---- marks: the same in SVG and DXF ---- */

/* The dihedral angle at a half-edge behind the two faces, in degrees; the mesh's boundary: 0. */
static double gprojx_dihedral(const gproj_mesh *mesh, int32_t h) {
    double a[3], b[3], c[3], side[3], sine, cosine;
    if (mesh->face[h] < 0 || mesh->face[mesh->twin[h]] < 0) return 0;
    gproj_mesh_face_area_vector(mesh, mesh->face[h], a);
    gproj_mesh_face_area_vector(mesh, mesh->face[mesh->twin[h]], b);
    gprojx_side(mesh, h, side);
    gprojx_unit(a), gprojx_unit(b), gprojx_unit(side);
    gprojx_cross(a, b, c);
    sine = gprojx_dot(c, side), cosine = gprojx_dot(a, b);
    return 180 - 57.29577951308232 * atan2(sine, cosine);
}

/* Writes the words along the edge from corner k; `degree_sign` follows an angle. Returns their shown length. */
static int gprojx_edge_words(const gprojx_panels *p, const gprojx_panel *panel, int32_t k, int32_t h,
                             const char *degree_sign, char words[80]) {
    const gproj_mesh *mesh = p->mesh;
    char angle[GPROJ_NUMBER_SIZE];
    words[0] = 0;
    if (!panel->strip && mesh->face[mesh->twin[h]] >= 0) {
        gproj_number_write(floor(10 * gprojx_dihedral(mesh, h) + 0.5) / 10, angle);
        snprintf(words, 80, "%ld: %s%s", (long)mesh->face[mesh->twin[h]], angle, degree_sign);
        return (int)(strlen(words) - strlen(degree_sign)) + 1;
    }
    if (panel->strip && k == 0) {
        int32_t left = mesh->face[2 * panel->number], right = mesh->face[2 * panel->number + 1];
        if (left >= 0 && right >= 0)
            snprintf(words, 80, "%ld | %ld", (long)left, (long)right);
        else
            snprintf(words, 80, "%ld", (long)(left < 0 ? right : left));
    } else if (panel->strip && k % 2)
        snprintf(words, 80, "V%ld", (long)mesh->origin[2 * panel->number + (k == 1)]);
    return (int)strlen(words);
}

typedef struct gprojx_mark {
    char words[80];
    double at[2], height, angle; /* the middle of the words; radians */
    bool tick;
    double line[4]; /* from x y to x y */
} gprojx_mark;

enum {
    GPROJX_LETTER = 62 /* percent of the height: how wide letters are */
};

/* The number in the middle, underlined, so that 6 and 9 differ. */
static gprojx_mark gprojx_number_mark(const gprojx_panel *panel) {
    gprojx_mark mark;
    double wide;
    memset(&mark, 0, sizeof mark);
    snprintf(mark.words, sizeof mark.words, "%s%ld", panel->strip ? "S" : "", (long)panel->number);
    wide = 0.01 * GPROJX_LETTER * (double)strlen(mark.words);
    mark.height = fmin(0.5, 1.1 / wide) * panel->room;
    memcpy(mark.at, panel->label, sizeof mark.at);
    mark.tick = true;
    mark.line[0] = mark.at[0] - wide / 2 * mark.height, mark.line[2] = mark.at[0] + wide / 2 * mark.height;
    mark.line[1] = mark.line[3] = mark.at[1] - 0.7 * mark.height;
    return mark;
}

/* The words along the edge from corner k to the next, inside, legible from below or from the right. */
static gprojx_mark gprojx_edge_mark(const gprojx_panels *p, const gprojx_panel *panel, int32_t k, int32_t h,
                                    const char *degree_sign) {
    const double *a = p->corner + 2 * (size_t)(panel->first + k),
                 *b = p->corner + 2 * (size_t)(panel->first + (k + 1) % panel->count);
    double length = gprojx_far2(a, b), in[2], middle[2];
    gprojx_mark mark;
    int letters, i;
    memset(&mark, 0, sizeof mark);
    letters = gprojx_edge_words(p, panel, k, h, degree_sign, mark.words);
    if (letters == 0 || !(length > 0)) return mark;
    mark.height = fmin((panel->strip ? 0.35 : 0.2) * panel->room, 0.75 * length / (0.01 * GPROJX_LETTER * letters));
    in[0] = -(b[1] - a[1]) / length, in[1] = (b[0] - a[0]) / length;
    for (i = 0; i < 2; ++i) {
        middle[i] = (a[i] + b[i]) / 2;
        mark.at[i] = middle[i] + 1.1 * mark.height * in[i];
        mark.line[i] = middle[i], mark.line[i + 2] = middle[i] + 0.35 * mark.height * in[i];
    }
    mark.tick = !panel->strip;
    mark.angle = atan2(b[1] - a[1], b[0] - a[0]);
    if (mark.angle > 1.5709 || mark.angle < -1.5707)
        mark.angle += mark.angle > 0 ? -3.14159265358979312 : 3.14159265358979312;
    return mark;
}

/* Visits the marks of a panel: mark -1 is the number, mark k belongs to the edge from corner k, with half-edge *h,
   which begins with the panel's first half-edge. */
static gprojx_mark gprojx_next_mark(const gprojx_panels *p, const gprojx_panel *panel, int32_t k, int32_t *h,
                                    const char *degree_sign) {
    gprojx_mark mark;
    if (k < 0) return gprojx_number_mark(panel);
    mark = gprojx_edge_mark(p, panel, k, *h, degree_sign);
    *h = gprojx_mesh_of(p, panel)->next[*h];
    return mark;
}

static int32_t gprojx_first_halfedge(const gprojx_panels *p, const gprojx_panel *panel) {
    return gprojx_mesh_of(p, panel)->face_halfedge[panel->number];
}

/* Sheets stand in rows, about as many in a row as rows. `corner`: the left upper corner of a sheet, y downwards. */
static void gprojx_sheet_place(const gprojx_panels *p, int32_t sheet, double corner[2]) {
    int32_t across = (int32_t)ceil(sqrt((double)p->sheet_count));
    double apart = 0.1 * fmin(p->options.width, p->options.height);
    if (across < 1) across = 1;
    corner[0] = (p->options.width + apart) * (sheet % across);
    corner[1] = (p->options.height + apart) * (sheet / across);
}

/* ---- numbers ---- */

static void gprojx_put_exact(FILE *file, const char *before, double x) {
    char text[GPROJ_NUMBER_SIZE];
    gproj_number_write(x, text);
    fputs(before, file), fputs(text, file);
}

/* For places of marks: rounds to the seventh digit of the sheet's size. */
static double gprojx_rounded(const gprojx_panels *p, double x) {
    double digits = 6 - floor(log10(fmax(p->options.width, p->options.height)));
    double ten = pow(10, fabs(digits));
    return digits >= 0 ? floor(x * ten + 0.5) / ten : floor(x / ten + 0.5) * ten;
}

static void gprojx_put_rounded(FILE *file, const gprojx_panels *p, const char *before, double x) {
    gprojx_put_exact(file, before, gprojx_rounded(p, x));
}

/* ---- SVG: y downwards ---- */

static void gprojx_svg_mark(FILE *file, const gprojx_panels *p, const gprojx_mark *mark) {
    double high = p->options.height;
    if (mark->tick) {
        gprojx_put_rounded(file, p, "<path stroke=\"#00f\" d=\"M", mark->line[0]);
        gprojx_put_rounded(file, p, " ", high - mark->line[1]);
        gprojx_put_rounded(file, p, "L", mark->line[2]);
        gprojx_put_rounded(file, p, " ", high - mark->line[3]);
        fputs("\"/>\n", file);
    }
    gprojx_put_rounded(file, p, "<text transform=\"translate(", mark->at[0]);
    gprojx_put_rounded(file, p, " ", high - mark->at[1]);
    gprojx_put_exact(file, ") rotate(", floor(-1e3 * 57.29577951308232 * mark->angle + 0.5) / 1e3);
    gprojx_put_rounded(file, p, ")\" font-size=\"", mark->height);
    gprojx_put_rounded(file, p, "\" y=\"", 0.36 * mark->height);
    fputs("\">", file);
    gprojx_put_text(file, mark->words);
    fputs("</text>\n", file);
}

static void gprojx_svg_panel(FILE *file, const gprojx_panels *p, const gprojx_panel *panel) {
    int32_t h = gprojx_first_halfedge(p, panel), k;
    fprintf(file, "<g id=\"panel-%s%ld\">\n<polygon stroke=\"#f00\" points=\"", panel->strip ? "S" : "",
            (long)panel->number);
    for (k = 0; k < panel->count; ++k) {
        const double *c = p->corner + 2 * (size_t)(panel->first + k);
        gprojx_put_exact(file, k ? " " : "", c[0]);
        gprojx_put_exact(file, ",", p->options.height - c[1]);
    }
    fputs("\"/>\n", file);
    for (k = -1; k < panel->count; ++k) {
        gprojx_mark mark = gprojx_next_mark(p, panel, k, &h, "\xc2\xb0");
        if (mark.words[0]) gprojx_svg_mark(file, p, &mark);
    }
    fputs("</g>\n", file);
}

/* Lists the panels of each sheet, for writers that go sheet by sheet: next[i] follows panel i, first[s] begins; -1
   ends. */
static bool gprojx_list_sheets(const gprojx_panels *p, int32_t **first, int32_t **next) {
    int32_t i;
    *first = (int32_t *)malloc(((size_t)p->sheet_count + 1) * sizeof **first);
    *next = (int32_t *)malloc(((size_t)p->count + 1) * sizeof **next);
    if (!*first || !*next) return false;
    for (i = 0; i < p->sheet_count; ++i) (*first)[i] = -1;
    for (i = p->count - 1; i >= 0; --i) (*next)[i] = (*first)[p->panel[i].sheet], (*first)[p->panel[i].sheet] = i;
    return true;
}

/* Writes the panels as SVG in millimetres: outlines red (to cut), ticks and underlines blue (to mark), words black (to
   engrave), borders of the sheets grey (not to be cut); a group a sheet, and in it a group a panel. */
static gproj_code gprojx_panels_svg(FILE *file, const gprojx_panels *p) {
    double most[2] = {0, 0}, thin = fmin(0.1, 0.1 * p->options.gap), at[2];
    int32_t *first = NULL, *next = NULL, s, i;
    bool good = gprojx_list_sheets(p, &first, &next);
    for (s = 0; s < p->sheet_count; ++s) {
        gprojx_sheet_place(p, s, at);
        most[0] = fmax(most[0], at[0] + p->options.width), most[1] = fmax(most[1], at[1] + p->options.height);
    }
    gprojx_put_exact(file, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", most[0]);
    gprojx_put_exact(file, "mm\" height=\"", most[1]);
    gprojx_put_exact(file, "mm\" viewBox=\"0 0 ", most[0]);
    gprojx_put_exact(file, " ", most[1]);
    gprojx_put_exact(file, "\" fill=\"none\" stroke-width=\"", thin);
    fputs("\">\n<style>text{fill:#000;stroke:none;text-anchor:middle;font-family:Helvetica,Arial,'DejaVu "
          "Sans',sans-serif}</style>\n",
          file);
    for (s = 0; good && s < p->sheet_count; ++s) {
        gprojx_sheet_place(p, s, at);
        fprintf(file, "<g id=\"sheet-%ld\"", (long)s + 1);
        gprojx_put_exact(file, " transform=\"translate(", at[0]);
        gprojx_put_exact(file, " ", at[1]);
        gprojx_put_exact(file, ")\">\n<rect stroke=\"#999\" width=\"", p->options.width);
        gprojx_put_exact(file, "\" height=\"", p->options.height);
        fputs("\"/>\n", file);
        for (i = first[s]; i >= 0; i = next[i]) gprojx_svg_panel(file, p, &p->panel[i]);
        fputs("</g>\n", file);
    }
    fputs("</svg>\n", file);
    free(first), free(next);
    return !good ? GPROJ_ERROR_MEMORY : ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

/* ---- DXF, release 12: groups of a code and a value, y upwards ---- */

static void gprojx_dxf(FILE *file, int code, const char *value) { fprintf(file, "%3d\n%s\n", code, value); }

static void gprojx_dxf_number(FILE *file, int code, double value) {
    char text[GPROJ_NUMBER_SIZE];
    gproj_number_write(value, text);
    gprojx_dxf(file, code, text);
}

/* A point: the codes are 10, 20, 30 and so on from `code`. */
static void gprojx_dxf_point(FILE *file, int code, double x, double y) {
    gprojx_dxf_number(file, code, x), gprojx_dxf_number(file, code + 10, y), gprojx_dxf(file, code + 20, "0");
}

/* A closed polygon. at: what is added to the corners. */
static void gprojx_dxf_polygon(FILE *file, const char *layer, const double *corner, int32_t count, const double at[2]) {
    int32_t k;
    gprojx_dxf(file, 0, "POLYLINE"), gprojx_dxf(file, 8, layer);
    gprojx_dxf(file, 66, "1"), gprojx_dxf_point(file, 10, 0, 0), gprojx_dxf(file, 70, "1");
    for (k = 0; k < count; ++k) {
        gprojx_dxf(file, 0, "VERTEX"), gprojx_dxf(file, 8, layer);
        gprojx_dxf_point(file, 10, at[0] + corner[2 * k], at[1] + corner[2 * k + 1]);
    }
    gprojx_dxf(file, 0, "SEQEND"), gprojx_dxf(file, 8, layer);
}

static void gprojx_dxf_mark(FILE *file, const gprojx_panels *p, const gprojx_mark *mark, const double at[2]) {
    double x = gprojx_rounded(p, at[0] + mark->at[0]), y = gprojx_rounded(p, at[1] + mark->at[1]);
    if (mark->tick) {
        gprojx_dxf(file, 0, "LINE"), gprojx_dxf(file, 8, "MARKS");
        gprojx_dxf_point(file, 10, gprojx_rounded(p, at[0] + mark->line[0]), gprojx_rounded(p, at[1] + mark->line[1]));
        gprojx_dxf_point(file, 11, gprojx_rounded(p, at[0] + mark->line[2]), gprojx_rounded(p, at[1] + mark->line[3]));
    }
    gprojx_dxf(file, 0, "TEXT"), gprojx_dxf(file, 8, "TEXT");
    gprojx_dxf_point(file, 10, x, y);
    gprojx_dxf_number(file, 40, mark->height * 0.73); /* capitals, where SVG has the whole line */
    gprojx_dxf(file, 1, mark->words);
    gprojx_dxf_number(file, 50, floor(1e3 * 57.29577951308232 * mark->angle + 0.5) / 1e3);
    gprojx_dxf(file, 72, "1"); /* centred at this point, in both directions */
    gprojx_dxf_point(file, 11, x, y);
    gprojx_dxf(file, 73, "2");
}

static void gprojx_dxf_head(FILE *file) {
    static const char *const layers[][2] = {{"SHEETS", "8"}, {"CUT", "1"}, {"MARKS", "5"}, {"TEXT", "7"}};
    int i;
    gprojx_dxf(file, 0, "SECTION"), gprojx_dxf(file, 2, "HEADER");
    gprojx_dxf(file, 9, "$ACADVER"), gprojx_dxf(file, 1, "AC1009");
    gprojx_dxf(file, 0, "ENDSEC");
    gprojx_dxf(file, 0, "SECTION"), gprojx_dxf(file, 2, "TABLES");
    gprojx_dxf(file, 0, "TABLE"), gprojx_dxf(file, 2, "LAYER"), gprojx_dxf(file, 70, "4");
    for (i = 0; i < 4; ++i) {
        gprojx_dxf(file, 0, "LAYER"), gprojx_dxf(file, 2, layers[i][0]), gprojx_dxf(file, 70, "0");
        gprojx_dxf(file, 62, layers[i][1]), gprojx_dxf(file, 6, "CONTINUOUS");
    }
    gprojx_dxf(file, 0, "ENDTAB"), gprojx_dxf(file, 0, "ENDSEC");
    gprojx_dxf(file, 0, "SECTION"), gprojx_dxf(file, 2, "ENTITIES");
}

/* Writes the panels as DXF: layers CUT (closed polylines), MARKS (lines), TEXT, and SHEETS (borders, not to be cut).
   Release 12 has no units: a unit is a millimetre. */
static gproj_code gprojx_panels_dxf(FILE *file, const gprojx_panels *p) {
    double border[8] = {0, 0, 0, 0, 0, 0, 0, 0}, at[2];
    int32_t i, k;
    border[2] = border[4] = p->options.width, border[5] = border[7] = p->options.height;
    gprojx_dxf_head(file);
    for (i = 0; i < p->sheet_count; ++i) {
        gprojx_sheet_place(p, i, at);
        at[1] = -at[1];
        gprojx_dxf_polygon(file, "SHEETS", border, 4, at);
    }
    for (i = 0; i < p->count; ++i) {
        const gprojx_panel *panel = &p->panel[i];
        int32_t h = gprojx_first_halfedge(p, panel);
        gprojx_sheet_place(p, panel->sheet, at);
        at[1] = -at[1];
        gprojx_dxf_polygon(file, "CUT", p->corner + 2 * (size_t)panel->first, panel->count, at);
        for (k = -1; k < panel->count; ++k) {
            gprojx_mark mark = gprojx_next_mark(p, panel, k, &h, "%%d");
            if (mark.words[0]) gprojx_dxf_mark(file, p, &mark, at);
        }
    }
    gprojx_dxf(file, 0, "ENDSEC"), gprojx_dxf(file, 0, "EOF");
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

/* ---- the table ---- */

/* Writes the end of an edge; those of the offset have a prime. */
static void gprojx_csv_vertex(FILE *file, const gprojx_panels *p, const gprojx_panel *panel, int32_t k, int32_t h) {
    if (panel->strip)
        fprintf(file, ",%ld%s", (long)p->mesh->origin[2 * panel->number + (k == 1 || k == 2)], k >= 2 ? "'" : "");
    else
        fprintf(file, ",%ld", (long)p->mesh->origin[h]);
}

static void gprojx_csv_edge(FILE *file, const gprojx_panels *p, const gprojx_panel *panel, int32_t k, int32_t h) {
    const gproj_mesh *mesh = gprojx_mesh_of(p, panel);
    int32_t beside = panel->strip ? -1 : mesh->face[mesh->twin[h]], after = (k + 1) % panel->count;
    const double *corner = p->corner + 2 * (size_t)panel->first;
    fprintf(file, "edge,%s%ld", panel->strip ? "S" : "", (long)panel->number);
    gprojx_csv_vertex(file, p, panel, k, h);
    gprojx_csv_vertex(file, p, panel, after, mesh->next[h]);
    if (panel->strip && k == 0) {
        char words[80];
        gprojx_edge_words(p, panel, k, h, "", words);
        fprintf(file, ",%s", words);
    } else if (beside >= 0)
        fprintf(file, ",%ld", (long)beside);
    else
        fputc(',', file);
    gprojx_put_exact(file, ",", gprojx_far2(corner + 2 * k, corner + 2 * after));
    if (beside >= 0)
        gprojx_put_exact(file, ",", gprojx_dihedral(mesh, h));
    else
        fputc(',', file);
    fputc('\n', file);
}

/* Writes a table: a line for each panel and for each edge of it, as the first line says. Sheets count from 1. */
static gproj_code gprojx_panels_csv(FILE *file, const gprojx_panels *p) {
    int32_t i, k, h;
    fputs("kind,panel,sheet or from,corners or to,area or neighbour,perimeter or length,width or angle,height,"
          "off its plane\n",
          file);
    for (i = 0; i < p->count; ++i) {
        const gprojx_panel *panel = &p->panel[i];
        const double *corner = p->corner + 2 * (size_t)panel->first;
        double around = 0;
        for (k = 0; k < panel->count; ++k) around += gprojx_far2(corner + 2 * k, corner + 2 * ((k + 1) % panel->count));
        fprintf(file, "panel,%s%ld,%ld,%ld", panel->strip ? "S" : "", (long)panel->number, (long)panel->sheet + 1,
                (long)panel->count);
        gprojx_put_exact(file, ",", panel->area), gprojx_put_exact(file, ",", around);
        gprojx_put_exact(file, ",", panel->size[0]), gprojx_put_exact(file, ",", panel->size[1]);
        gprojx_put_exact(file, ",", panel->flatness);
        fputc('\n', file);
        for (k = 0, h = gprojx_first_halfedge(p, panel); k < panel->count; ++k, h = gprojx_mesh_of(p, panel)->next[h])
            gprojx_csv_edge(file, p, panel, k, h);
    }
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

#endif
