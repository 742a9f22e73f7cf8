/* figures_shape.h - Figures 3, 4, 8: fairness under planarity, one boundary and many meshes, parallelograms. */
#ifndef FIGURES_SHAPE_H
#define FIGURES_SHAPE_H

static double length_of(const double *d) { return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]); }

/* The unit normals of all faces. */
static double *face_normals(const gproj_mesh *mesh) {
    double *normal = must_have(malloc(3 * sizeof *normal * (size_t)mesh->face_count));
    int32_t f, k;
    for (f = 0; f < mesh->face_count; ++f) {
        double *n = normal + 3 * f, size;
        gproj_mesh_face_area_vector(mesh, f, n);
        for (k = 0, size = length_of(n); k < 3; ++k) n[k] /= size;
    }
    return normal;
}

/* ---- Figure 3 ---- */

/* The Gauss image: face normals on the unit sphere, joined around each inner vertex. */
static gproj_mesh *make_gauss_image(const gproj_mesh *mesh) {
    double *normal = face_normals(mesh);
    int32_t *degree = must_have(malloc(sizeof *degree * (size_t)mesh->vertex_count)), faces = 0, corners = 0, v, h;
    int32_t *corner = must_have(malloc(sizeof *corner * (size_t)mesh->halfedge_count));
    gproj_error error;
    gproj_mesh *image;
    for (v = 0; v < mesh->vertex_count; ++v) {
        int32_t first = mesh->vertex_halfedge[v], begun = corners;
        if (gproj_mesh_is_boundary_vertex(mesh, v)) continue;
        h = first;
        do corner[corners++] = mesh->face[h], h = mesh->twin[mesh->prev[h]];
        while (h != first);
        degree[faces++] = corners - begun;
    }
    image = must(gproj_mesh_create(mesh->face_count, normal, faces, degree, corner, NULL, &error), &error);
    free(normal), free(degree), free(corner);
    return image;
}

/* For each face the mean area, over its inner vertices, of the Gauss image of the faces around the vertex, in degrees
   squared: the triangles between the normals and their mean. */
static double *gauss_areas(const gproj_mesh *mesh) {
    gproj_mesh *image = make_gauss_image(mesh);
    double *value = must_have(calloc((size_t)mesh->face_count, sizeof *value));
    int32_t *count = must_have(calloc((size_t)mesh->face_count, sizeof *count)), g, h, i, k;
    for (g = 0; g < image->face_count; ++g) {
        double mean[3] = {0, 0, 0}, area = 0;
        for (i = 0, h = image->face_halfedge[g]; i < image->face_degree[g]; ++i, h = image->next[h])
            for (k = 0; k < 3; ++k) mean[k] += image->position[3 * image->origin[h] + k] / image->face_degree[g];
        for (i = 0; i < image->face_degree[g]; ++i, h = image->next[h]) {
            const double *a = image->position + 3 * image->origin[h],
                         *b = image->position + 3 * image->origin[image->next[h]];
            double d[3], e[3], n[3];
            for (k = 0; k < 3; ++k) d[k] = a[k] - mean[k], e[k] = b[k] - mean[k];
            gprojx_cross(d, e, n);
            area += length_of(n) / 2;
        }
        for (i = 0; i < image->face_degree[g]; ++i, h = image->next[h])
            value[image->origin[h]] += area * 3282.8, ++count[image->origin[h]]; /* (180 / pi)^2 */
    }
    for (i = 0; i < mesh->face_count; ++i)
        if (count[i]) value[i] /= count[i];
    free(count);
    gproj_mesh_destroy(image);
    return value;
}

/* Draws the Gauss image as seen along the mean normal, with circles for each ten degrees from there. */
static void draw_gauss_image(studio *s, const gproj_mesh *mesh, const char *name, const char *title) {
    const double scale = 620;
    double *normal = face_normals(mesh), mean[3] = {0, 0, 0}, side[3], up[3], size;
    FILE *file = open_picture(s, name);
    int32_t e, f, k;
    for (f = 0; f < 3 * mesh->face_count; ++f) mean[f % 3] += normal[f];
    for (k = 0, size = length_of(mean); k < 3; ++k) mean[k] /= size;
    gprojx_cross(mean, (double[3]){1, 0, 0}, side), gprojx_cross(side, mean, up);
    for (k = 0, size = length_of(side); k < 3; ++k) side[k] /= size, up[k] /= size;
    if (file) {
        fprintf(file,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1200 1100\" width=\"1200\" height=\"1100\" "
                "font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" fill=\"#222\">\n<title>%s</title>\n"
                "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n<text x=\"40\" y=\"46\" font-size=\"24\" "
                "font-weight=\"bold\">%s</text>\n<text x=\"40\" y=\"70\" font-size=\"15\" fill=\"#555\">%ld normals, "
                "joined where "
                "panels share an edge \xc2\xb7 circles for each 10 degrees</text>\n",
                title, title, (long)mesh->face_count);
        for (k = 10; k <= 50; k += 10)
            fprintf(file, "<circle fill=\"none\" stroke=\"#ccd\" cx=\"600\" cy=\"590\" r=\"%.0f\"/>\n",
                    scale * sin(k * TURN / 360));
        fputs("<path fill=\"none\" stroke=\"#0b4f8a\" stroke-width=\".7\" d=\"", file);
        for (e = 0; e < mesh->edge_count; ++e)
            for (k = 0; k < 2 && mesh->face[2 * e] >= 0 && mesh->face[2 * e + 1] >= 0; ++k) {
                const double *n = normal + 3 * mesh->face[2 * e + k];
                fprintf(file, "%c%.0f %.0f", k ? 'L' : 'M', 600 + scale * gprojx_dot(n, side),
                        590 - scale * gprojx_dot(n, up));
            }
        fputs("\"/>\n</svg>\n", file);
        close_file(s, file, ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK);
    }
    free(normal);
}

static void draw_gauss(studio *s, const gproj_mesh *mesh, const look *look, const char *image_name,
                       const char *image_title) {
    double *value = gauss_areas(mesh);
    draw_values(s, mesh, look, value, "area of the Gauss image around a vertex, in square degrees", 200);
    draw_gauss_image(s, mesh, image_name, image_title);
    free(value);
}

/* Makes it fair with the paper's weights for this number of iterations, then exact. */
static void fair_carpet(studio *s, const plate *restless, const gproj_surface *surface, int32_t last, const look *look,
                        const char *image_name, const char *image_title) {
    plate p = copy_plate(s, restless);
    gproj_add_planarity(p.form, 1);
    gproj_add_gliding_boundary(p.form, 1);
    gproj_set_schedule(p.form, gproj_add_reference(p.form, surface, 0.1), gproj_fade(0.1, last));
    gproj_set_schedule(p.form, gproj_add_tangential_fairness(p.form, 0.002), gproj_fade(0.002, last));
    gproj_set_schedule(p.form, gproj_add_gauss_fairness(p.form, 0.002), gproj_fade(0.002, last));
    solve_plate(s, &p, 200, &smoothly);
    report_plate(s, &p, look->name);
    draw_gauss(s, p.mesh, look, image_name, image_title);
    end_plate(&p);
}

static void make_figure_3(studio *s) {
    plate p = begin_plate(s, make_carpet(true));
    gproj_error error;
    gproj_mesh *calm = make_carpet(false);
    gproj_surface *surface = gproj_surface_create(calm, NULL, &error);
    gproj_add_planarity(p.form, 1);
    gproj_add_gliding_boundary(p.form, 1);
    solve_plate(s, &p, 60, NULL);
    report_plate(s, &p, "3a");
    draw_plain(s, p.mesh, &(look){"3a", "A restless carpet of triangles and quads", "flat panels", -58, 38});
    draw_gauss(s, p.mesh, &(look){"3b", "The restless carpet", "flat panels", -58, 38}, "3f",
               "Gauss image of the restless carpet");
    fair_carpet(s, &p, surface, 2, &(look){"3c", "Fair for 2 iterations", "flat panels", -58, 38}, "3g",
                "Gauss image after 2 iterations of fairness");
    fair_carpet(s, &p, surface, 5, &(look){"3d", "Fair for 5 iterations", "flat panels", -58, 38}, "3h",
                "Gauss image after 5 iterations of fairness");
    end_plate(&p);
    gproj_surface_destroy(surface);
    gproj_mesh_destroy(calm);
}

/* ---- Figure 4 ---- */

/* Pulls the vertex nearest to (x, y) by this vector: an auxiliary projection, in which fairness guides the others. */
static void lift_fairly(studio *s, plate *p, double height) {
    int32_t v = nearest_vertex(p->mesh, 0, 0, 0);
    double target[3] = {0, 0, height};
    gproj_add_targets(p->form, 1, &v, target, 1);
    gproj_add_fixed_boundary(p->form, 1);
    gproj_add_fairness(p->form, 0.3);
    gproj_add_closeness(p->form, 0.01);
    solve_plate(s, p, 20, NULL);
    renew_form(s, p);
}

static void add_flat_panels(plate *p) {
    gproj_add_planarity(p->form, 1);
    gproj_add_gliding_boundary(p->form, 1);
}

/* Moves the vertices nearest to these places by these vectors; panels stay planar. */
static plate pull(studio *s, const plate *from, int32_t count, const double (*place)[2], const double (*by)[3],
                  double fair) {
    plate p = copy_plate(s, from);
    double target[12];
    int32_t vertex[4], i, k;
    for (i = 0; i < count; ++i)
        for (vertex[i] = nearest_vertex(p.mesh, place[i][0], place[i][1], 4), k = 0; k < 3; ++k)
            target[3 * i + k] = p.mesh->position[3 * vertex[i] + k] + by[i][k];
    add_flat_panels(&p);
    gproj_add_targets(p.form, count, vertex, target, 1);
    if (fair > 0) gproj_add_fairness(p.form, fair);
    solve_plate(s, &p, 200, &smoothly);
    return p;
}

/* Parts e to h, from the mesh with four corners. */
static void deform_figure_4(studio *s, const plate *smooth) {
    static const double place[2][2] = {{-2, -3}, {3, 3}}, up[2][3] = {{0, 0, 1.2}, {0, 0, 0.8}},
                        aside[1][3] = {{3, 2.5, 0}};
    static const double middle[1][2] = {{0, 0}};
    plate e = pull(s, smooth, 2, place, up, 0), f = pull(s, smooth, 1, middle, aside, 0.2),
          g = pull(s, &f, 2, place, up, 0);
    plate h = copy_plate(s, &g);
    report_plate(s, &e, "4e"), report_plate(s, &f, "4f"), report_plate(s, &g, "4g");
    draw_plain(s, e.mesh, &(look){"4e", "Dragged: sharp features", "flat panels", -60, 40});
    draw_plain(s, f.mesh, &(look){"4f", "Dragged: skewed", "flat panels", -60, 40});
    draw_plain(s, g.mesh, &(look){"4g", "Dragged: sharp and skewed", "flat panels", -60, 40});
    add_flat_panels(&h);
    add_statics(&h, 0, 1);
    gproj_add_fairness(h.form, 0.02);
    solve_plate(s, &h, 200, &smoothly);
    report_plate(s, &h, "4h");
    draw_forces(s, &h,
                &(look){"4h", "The last one, made to stand: a dome again", "flat panels, compression alone", -60, 40},
                0);
    end_plate(&e), end_plate(&f), end_plate(&g), end_plate(&h);
}

static void make_figure_4(studio *s) {
    static const int32_t three[] = {120, 360, 600}, four[] = {0, 180, 360, 540}, five[] = {0, 144, 288, 432, 576};
    static const int32_t *const corner[3] = {three, four, five};
    static const look looks[3] = {{"4b", "One boundary, filled from 3 corners", "flat panels", -60, 40},
                                  {"4c", "One boundary, filled from 4 corners", "flat panels", -60, 40},
                                  {"4d", "One boundary, filled from 5 corners", "flat panels", -60, 40}};
    int32_t k;
    for (k = 0; k < 3; ++k) {
        plate p = begin_plate(s, fill_curve(3 + k, corner[k], 0.9));
        if (k == 1) draw_plain(s, p.mesh, &(look){"4a", "The boundary, filled with quads", "on the ground", -60, 40});
        lift_fairly(s, &p, 5);
        add_flat_panels(&p);
        gproj_add_fairness(p.form, 0.3);
        gproj_add_closeness(p.form, 0.05);
        solve_plate(s, &p, 200, &smoothly);
        report_plate(s, &p, looks[k].name);
        draw_plain(s, p.mesh, &looks[k]);
        if (k == 1) deform_figure_4(s, &p);
        end_plate(&p);
    }
}

/* ---- Figure 8 ---- */

static double *skewness(const gproj_mesh *mesh) {
    double *value = must_have(malloc(sizeof *value * (size_t)mesh->face_count)),
           edge = gproj_mesh_mean_edge_length(mesh);
    int32_t f, k;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        double d[3] = {0, 0, 0};
        for (k = 0; k < 12; ++k) {
            d[k % 3] += (k / 3 % 2 ? -1 : 1) * mesh->position[3 * mesh->origin[h] + k % 3];
            if (k % 3 == 2) h = mesh->next[h];
        }
        value[f] = mesh->face_degree[f] == 4 ? length_of(d) / edge : 0;
    }
    return value;
}

/* The feet stay: the vertices of triangles on the boundary, where the cage was cut. */
static void fix_feet(plate *p) {
    int32_t foot[128], count = 0, v;
    for (v = 0; v < p->mesh->vertex_count && count < 128; ++v) {
        int32_t h = p->mesh->vertex_halfedge[v], at_triangle = 0, first = h;
        if (!gproj_mesh_is_boundary_vertex(p->mesh, v)) continue;
        do {
            at_triangle += p->mesh->face[h] >= 0 && p->mesh->face_degree[p->mesh->face[h]] == 3;
            h = p->mesh->next[p->mesh->twin[h]];
        } while (h != first);
        if (at_triangle > 0) foot[count++] = v;
    }
    gproj_add_fixed(p->form, count, foot, 1);
}

/* A canopy near no shape, on its feet, with this weight of the wish for parallelograms. */
static void make_canopy_like(studio *s, double parallelograms, const look *look) {
    plate p = begin_plate(s, make_canopy());
    double *value;
    gproj_add_planarity(p.form, 1);
    fix_feet(&p);
    if (parallelograms > 0)
        gproj_set_schedule(p.form, gproj_add_parallelograms(p.form, 1), gproj_fade(parallelograms, 5));
    add_fairness(&p, 0.01, 0, 1, 5);
    solve_plate(s, &p, 60, NULL);
    report_plate(s, &p, look->name);
    value = skewness(p.mesh);
    draw_values(s, p.mesh, look, value, "off a parallelogram by |v1 - v2 + v3 - v4|, in mean edges", 0.2);
    free(value);
    end_plate(&p);
}

static void make_figure_8(studio *s) {
    make_canopy_like(s, 0, &(look){"8a", "A canopy on five feet", "flat panels, fairness alone", -80, 40});
    make_canopy_like(s, 0.01,
                     &(look){"8b", "A canopy whose panels like to be parallelograms",
                             "flat panels, the paper's weight 0.01", -80, 40});
    make_canopy_like(s, 0.1,
                     &(look){"8c", "Panels that insist on parallelograms: ridges emerge",
                             "flat panels, ten times the paper's weight", -80, 40});
}

#endif
