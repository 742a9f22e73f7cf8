/* figures_picture.h - the pictures of the figures. Include figures_run.h before this file. */
#ifndef FIGURES_PICTURE_H
#define FIGURES_PICTURE_H

/* A picture: its name, its title, and the view in degrees (see gprojx_view). */
typedef struct look {
    const char *name;  /* of the file: figure_NAME.svg */
    const char *title; /* says what is seen */
    const char *note;  /* the caption after the counts of vertices and panels */
    double azimuth, elevation;
} look;

/* Draws the mesh, coloured as `options` say. */
static void draw(studio *s, const gproj_mesh *mesh, const look *look, gprojx_picture_options options) {
    gprojx_view view = {0, 0, false};
    char caption[400];
    FILE *file = open_picture(s, look->name);
    if (!file) return;
    view.azimuth = look->azimuth, view.elevation = look->elevation;
    snprintf(caption, sizeof caption, "%ld vertices, %ld panels \xc2\xb7 %s", (long)mesh->vertex_count,
             (long)mesh->face_count, look->note);
    options.shadow = true;
    options.view = &view, options.title = look->title, options.caption = caption;
    close_file(s, file, gprojx_picture(file, mesh, &options));
}

static void draw_plain(studio *s, const gproj_mesh *mesh, const look *look) {
    static const gprojx_picture_options none;
    draw(s, mesh, look, none);
}

/* Colours the faces by these numbers on a linear scale from 0 to `high`. */
static void draw_values(studio *s, const gproj_mesh *mesh, const look *look, const double *value, const char *legend,
                        double high) {
    gprojx_picture_options options = {0};
    options.face_value = value, options.legend = legend;
    options.high = high, options.linear = true;
    draw(s, mesh, look, options);
}

/* Draws the axial forces in the edges; the widest stand for the force `high`, 0: the largest. */
static void draw_forces(studio *s, const plate *p, const look *look, double high) {
    gprojx_picture_options options = {0};
    double *force = must_have(calloc((size_t)p->mesh->edge_count, sizeof *force));
    gproj_get_forces(p->form, force, NULL);
    gprojx_forces_of_densities(p->mesh, force, force);
    options.edge_value = force, options.edge_high = high;
    draw(s, p->mesh, look, options);
    free(force);
}

#endif
