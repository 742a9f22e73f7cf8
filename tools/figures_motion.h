/* figures_motion.h - the convergence inset of Section 4, and a drag of a large mesh (Section 2). */
#ifndef FIGURES_MOTION_H
#define FIGURES_MOTION_H

enum {
    MOST_STEPS = 64
};

/* Measures of the mesh after each iteration; 0: at the beginning. */
typedef struct watch {
    gproj_form *form;
    gproj_mesh *probe; /* a copy of the mesh */
    int count;
    double planarity[MOST_STEPS], circularity[MOST_STEPS];
} watch;

static void note_measures(watch *w) {
    gproj_measures measures = gproj_measure(w->probe, NULL, NULL);
    if (w->count == MOST_STEPS) return;
    w->planarity[w->count] = measures.planarity_max;
    w->circularity[w->count++] = measures.circularity_max;
}

static bool note_iteration(void *user, gproj_system *system, const gproj_iteration *iteration) {
    watch *w = (watch *)user;
    const double *x = gproj_system_values(system);
    double centre[3], scale;
    int32_t i;
    (void)iteration;
    gproj_form_units(w->form, centre, &scale);
    for (i = 0; i < 3 * w->probe->vertex_count; ++i) w->probe->position[i] = x[i] / scale + centre[i % 3];
    note_measures(w);
    return true;
}

static void solve_watched(studio *s, plate *p, watch *w) {
    gproj_solve_options options = {0};
    gproj_error error;
    memset(w, 0, sizeof *w);
    w->form = p->form;
    w->probe = must(gproj_mesh_copy(p->mesh, NULL, &error), &error);
    note_measures(w);
    options.on_iteration = note_iteration, options.user = w;
    options.smooth = true;
    solve_plate(s, p, 200, &options);
    gproj_mesh_destroy(w->probe);
}

static plate planar_roof(studio *s, watch *w) {
    plate p = begin_plate(s, grid(ROOF, ROOF, false, roof));
    gproj_add_planarity(p.form, 1);
    gproj_add_fixed_corners(p.form, 1);
    solve_watched(s, &p, w);
    return p;
}

static void make_inset(studio *s) {
    static watch roofed, funnel;
    plate p = planar_roof(s, &roofed), q = begin_plate(s, grid(32, 12, false, dented));
    FILE *file = open_picture(s, "inset");
    report_plate(s, &p, "inseta");
    gproj_add_planarity(q.form, 1);
    gproj_add_circularity(q.form, 1);
    add_fairness(&q, 0.02, 0, 1, 5);
    solve_watched(s, &q, &funnel);
    report_plate(s, &q, "insetb");
    if (file) {
        const gprojx_curve curve[3] = {
            {"a roof of 4,900 quads: planarity", "#d55e00", roofed.count, roofed.planarity},
            {"a funnel of 384 quads: planarity", "#0072b2", funnel.count, funnel.planarity},
            {"a funnel of 384 quads: circularity", "#56b4e9", funnel.count, funnel.circularity}};
        close_file(s, file, gprojx_plot(file, "Flat and circular panels: the worst one, in mean edges", 3, curve));
    }
    end_plate(&p), end_plate(&q);
}

/* ---- the drag ---- */

static void draw_drag(studio *s, const plate *p) {
    double *moved = must_have(calloc((size_t)p->mesh->face_count, sizeof *moved));
    double edge = gproj_mesh_mean_edge_length(p->mesh), most = 0;
    int32_t h, k;
    for (h = 0; h < p->mesh->halfedge_count; ++h) {
        int32_t v = p->mesh->origin[h], f = p->mesh->face[h];
        double d[3];
        for (k = 0; k < 3; ++k) d[k] = p->mesh->position[3 * v + k] - p->before[3 * v + k];
        if (f >= 0) moved[f] += length_of(d) / edge / p->mesh->face_degree[f];
    }
    for (k = 0; k < p->mesh->face_count; ++k) most = fmax(most, moved[k]);
    draw_values(s, p->mesh,
                &(look){"drag", "One vertex pulled up: the roof follows, its panels stay flat", "flat panels", -58, 34},
                moved, "how far a panel has moved, in mean edges", ceil(most));
    free(moved);
}

static void make_drag(studio *s) {
    static watch roofed;
    plate roof = planar_roof(s, &roofed), p = copy_plate(s, &roof);
    int32_t *vertex = must_have(malloc(sizeof *vertex * (size_t)p.mesh->vertex_count)), move;
    double *weight = must_have(malloc(sizeof *weight * (size_t)p.mesh->vertex_count)), to[3], begun, begin, moves;
    int64_t start[2] = {0, 0};
    gproj_handles handles = {1, start, vertex, weight, to};
    gproj_drag *drag;
    gproj_error error;
    gproj_add_planarity(p.form, 1);
    gproj_add_fixed_corners(p.form, 1);
    solve_plate(s, &p, 10, NULL); /* holds already */
    start[1] = gproj_find_reach(p.form, 24 * (ROOF + 1) + 44, 14, vertex, weight);
    memcpy(to, p.mesh->position + 3 * vertex[0], sizeof to);
    begun = s->host.clock.now(s->host.clock.user);
    drag = gproj_drag_begin(p.form, &handles, NULL, &error);
    if (!drag) fprintf(stderr, "figures: %s\n", error.message), exit(3);
    begin = s->host.clock.now(s->host.clock.user);
    for (move = 0; move < 100; ++move) to[2] += 0.03, gproj_drag_move(drag, to);
    moves = s->host.clock.now(s->host.clock.user);
    p.result = gproj_drag_end(drag);
    p.iterations = p.result.iterations;
    p.seconds = s->host.clock.now(s->host.clock.user) - moves;
    report_plate(s, &p, "drag");
    if (!s->json)
        printf("       begin %.3f s, a move %.2f ms, then the release\n", begin - begun, 10 * (moves - begin));
    draw_drag(s, &p);
    free(vertex), free(weight);
    end_plate(&p), end_plate(&roof);
}

#endif
