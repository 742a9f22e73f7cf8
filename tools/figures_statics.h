/* figures_statics.h - Figures 1, 2, 7, 11, 12, 13: meshes that stand by compression alone. */
#ifndef FIGURES_STATICS_H
#define FIGURES_STATICS_H

/* Equilibrium under these loads by compression alone, supported all along the boundary. */
static void add_statics(plate *p, double density, double area_load) {
    int32_t *support = must_have(malloc(sizeof *support * (size_t)p->mesh->vertex_count)), i;
    gproj_supports supports = {0, support, NULL};
    gproj_loads loads = {0};
    loads.density = density, loads.area_load = area_load;
    for (i = 0; i < p->mesh->vertex_count; ++i)
        if (gproj_mesh_is_boundary_vertex(p->mesh, i)) support[supports.count++] = i;
    gproj_add_equilibrium(p->form, &loads, &supports, 1);
    gproj_add_compression(p->form, p->mesh->edge_count, NULL, 1);
    free(support);
}

/* A subdivided cage, to become planar and to stand under the weight of its members, near its design: with the paper's
   weights. */
static plate stand_near(studio *s, gproj_mesh *mesh, gproj_surface **design, double areas) {
    plate p = begin_plate(s, mesh);
    gproj_error error;
    *design = gproj_surface_create(mesh, NULL, &error);
    gproj_add_planarity(p.form, 1);
    add_statics(&p, 1, 0);
    gproj_add_gliding_boundary(p.form, 1);
    gproj_add_reference(p.form, *design, 0.1);
    if (areas > 0) gproj_add_equal_areas(p.form, areas);
    return p;
}

static void make_figure_2(studio *s) {
    gproj_mesh *cage, *mesh = make_pavilion(&cage);
    gproj_surface *design;
    plate p;
    draw_plain(s, cage, &(look){"2a", "A pavilion around a court: the cage", "what the architect moves", -62, 24});
    p = stand_near(s, mesh, &design, 0.001);
    add_fairness(&p, 1, 0, 0.9, 10); /* the paper's weight 0.9^n; two edges collapse if it fades after 5, as there */
    solve_plate(s, &p, 60, NULL);
    report_plate(s, &p, "2b");
    draw_plain(
        s, p.mesh,
        &(look){"1", "A pavilion around a court", "flat panels, compression alone; arches along diagonals", -30, 12});
    draw_plain(s, p.mesh,
               &(look){"2b", "A pavilion around a court: flat panels", "subdivided, cut along diagonals, made to stand",
                       -62, 24});
    draw_forces(s, &p,
                &(look){"2c", "A pavilion around a court: its forces",
                        "flat panels; under its own weight all members are compressed", -62, 24},
                0);
    end_plate(&p);
    gproj_surface_destroy(design);
    gproj_mesh_destroy(cage);
}

static void make_figure_11(studio *s) {
    gproj_mesh *cage, *mesh = make_stage(&cage);
    gproj_surface *design;
    plate p;
    draw_plain(s, cage, &(look){"11a", "A shell for a stage: the cage", "what the architect moves", 28, 20});
    draw_plain(s, mesh,
               &(look){"11b", "A shell for a stage: subdivided, and cut along diagonals", "not flat yet", 28, 20});
    p = stand_near(s, mesh, &design, 0);
    add_fairness(&p, 0.01, 0.05, 1, 5);
    solve_plate(s, &p, 200, &smoothly);
    report_plate(s, &p, "11c");
    draw_forces(s, &p,
                &(look){"11c", "A shell for a stage: its forces",
                        "flat panels; under its own weight all members are compressed", 28, 20},
                0);
    end_plate(&p);
    gproj_surface_destroy(design);
    gproj_mesh_destroy(cage);
}

/* A roof over a court: with force fairness, and with bounds as in another roof. */
static plate roof_a_court(studio *s, double volume, double force_fairness, const plate *like) {
    plate p = begin_plate(s, make_court());
    gproj_add_planarity(p.form, 1);
    add_statics(&p, 0, 1);
    gproj_add_gliding_boundary(p.form, 1);
    gproj_add_volume(p.form, volume, 1);
    gproj_add_fairness(p.form, 0.02);
    gproj_add_closeness(p.form, 0.02);
    if (force_fairness > 0) gproj_add_force_fairness(p.form, force_fairness);
    if (like) {
        gproj_measures most = gproj_measure(like->mesh, NULL, NULL);
        gproj_add_length_bounds(p.form, p.mesh->edge_count, NULL, 0, most.max_edge, 1);
        gproj_add_area_bounds(p.form, p.mesh->face_count, NULL, 0, most.max_face_area, 1);
    }
    solve_plate(s, &p, 40, NULL);
    return p;
}

static void make_figure_7(studio *s) {
    plate a = roof_a_court(s, 1350, 0, NULL), b = roof_a_court(s, 1350, 0.05, NULL),
          c = roof_a_court(s, 1.2 * 1350, 0, &a);
    const double most = gproj_measure_forces(a.form, NULL).max_force;
    char note[80];
    snprintf(note, sizeof note, "flat panels; with force fairness the largest is %.0f %% smaller",
             100 * (1 - gproj_measure_forces(b.form, NULL).max_force / most));
    report_plate(s, &a, "7a"), report_plate(s, &b, "7b"), report_plate(s, &c, "7c");
    draw_forces(s, &a, &(look){"7a", "A roof over a court", "flat panels; all members are compressed", -62, 28}, most);
    draw_forces(s, &b, &(look){"7b", "A roof over a court: forces evened out", note, -62, 28}, most);
    draw_forces(s, &c,
                &(look){"7c", "A roof over a court: a fifth more volume",
                        "flat panels; no edge longer, no panel larger than in (a)", -62, 28},
                most);
    end_plate(&a), end_plate(&b), end_plate(&c);
}

static void make_figure_12(studio *s) {
    plate p = begin_plate(s, make_horn());
    add_statics(&p, 0, 1);
    gproj_add_fixed_boundary(p.form, 1);
    add_fairness(&p, 0.05, 0.05, 0.9, 10);
    solve_plate(s, &p, 60, NULL);
    report_plate(s, &p, "12");
    draw_forces(
        s, &p,
        &(look){"12", "A horn that stands: no height field", "a load by area; all members are compressed", -52, 14}, 0);
    end_plate(&p);
}

/* What both steps share: a load by area, and forces to begin with. */
static void add_standing(plate *p, const double *density) {
    add_statics(p, 0, 1);
    gproj_add_gliding_boundary(p->form, 1);
    gproj_set_forces(p->form, density, NULL);
}

/* A flat net is lifted until it stands; then its panels become planar, its edges orthogonal to the ground curve. */
static void make_figure_13(studio *s) {
    plate p = begin_plate(s, make_bean());
    double *density = must_have(malloc(sizeof *density * (size_t)p.mesh->edge_count));
    gproj_solve_options lift = {0};
    int32_t e;
    for (e = 0; e < p.mesh->edge_count; ++e) density[e] = 3; /* in plan, equal forces are in equilibrium */
    add_standing(&p, density);
    gproj_add_lifting(p.form, 1);
    lift.skip_closeness = true;
    lift.tolerance = 1e-10, lift.epsilon = 1e-6; /* lifting and equilibrium in plan depend on each other */
    solve_plate(s, &p, 20, &lift);
    gproj_get_forces(p.form, density, NULL);
    renew_form(s, &p);
    add_standing(&p, density);
    gproj_add_planarity(p.form, 1);
    gproj_add_orthogonal_boundary(p.form, 1);
    add_fairness(&p, 0, 0.05, 0.95, 10);
    solve_plate(s, &p, 60, NULL);
    report_plate(s, &p, "13");
    draw_forces(s, &p,
                &(look){"13", "A greenhouse: a flat net, lifted until it stands",
                        "flat panels; all members are compressed", -62, 28},
                0);
    free(density);
    end_plate(&p);
}

#endif
