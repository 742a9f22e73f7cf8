/* test_frame.c - tools/frame.h and tools/frame_buckling.h: closed forms, symmetries, and orders of refinement. */
#include "gprojt_mesh.h"

#include "../tools/frame_buckling.h"

static const gprojx_material steel = {210e9, 81e9, 7850, 235e6};
static const double up[3] = {0, 0, 1};

/* Cuts the segment from a to b, with the nodes first, between, .., last, into `count` beams. */
static void add_line(gprojx_frame *frame, int32_t *beam, const double *a, const double *b, int32_t count, int32_t first,
                     int32_t between, int32_t last, const gprojx_section *section, const double *load) {
    int32_t i;
    int k;
    for (i = 0; i < count; ++i) {
        double p[3], q[3];
        for (k = 0; k < 3; ++k) {
            p[k] = a[k] + (b[k] - a[k]) * i / count;
            q[k] = a[k] + (b[k] - a[k]) * (i + 1) / count;
        }
        frame->beam[*beam] = gprojx_beam_between(p, q, up, section, &steel);
        frame->beam[*beam].node[0] = i == 0 ? first : between + i - 1;
        frame->beam[*beam].node[1] = i == count - 1 ? last : between + i;
        if (load) memcpy(frame->beam[*beam].load, load, 3 * sizeof *load);
        ++*beam;
    }
}

static void hold(gprojx_frame *frame, int32_t node, const char *motions) {
    for (; *motions; ++motions) frame->held[6 * node + (*motions - '0')] = true;
}

static bool solve(gprojx_frame *frame) {
    gproj_error error;
    gproj_code code = gprojx_frame_solve(frame, &error);
    if (code != GPROJ_OK) printf("  %s\n", error.message);
    return code == GPROJ_OK;
}

/* |a - b| <= bound times the larger of |b| and scale */
static bool near(double a, double b, double scale, double bound) {
    bool good = fabs(a - b) <= bound * fmax(fabs(b), scale);
    if (!good) printf("    %.17g instead of %.17g\n", a, b);
    return good;
}

GPROJT_TEST(frame_sections) {
    gprojx_section s = gprojx_section_rectangle(0.1, 0.2), b = gprojx_section_box(0.1, 0.2, 0.01);
    GPROJT_CHECK(near(s.area, 0.02, 0, 1e-14) && near(s.iy, 0.1 * 0.008 / 12, 0, 1e-14));
    GPROJT_CHECK(near(s.wy, 0.1 * 0.04 / 6, 0, 1e-14) && near(s.wz, 0.01 * 0.2 / 6, 0, 1e-14));
    /* The tables have 0.229 a b^3 for a = 2 b and 0.1406 a^4 for a square. */
    GPROJT_CHECK(near(s.torsion, 0.2287 * 0.2 * 1e-3, 0, 5e-4));
    s = gprojx_section_rectangle(1, 1);
    GPROJT_CHECK(near(s.torsion, 0.140577014955, 0, 1e-9));
    GPROJT_CHECK(near(b.area, 0.02 - 0.08 * 0.18, 0, 1e-13));
    GPROJT_CHECK(near(b.torsion, 4 * pow(0.09 * 0.19, 2) * 0.01 / (2 * 0.28), 0, 1e-13));
    s = gprojx_section_circle(0.2);
    GPROJT_CHECK(near(s.area, gprojx_pi * 0.01, 0, 1e-14) && near(s.iy, gprojx_pi * 1e-4 / 4, 0, 1e-14));
    GPROJT_CHECK(near(s.torsion, 2 * s.iy, 0, 1e-14) && near(s.wy, s.iy / 0.1, 0, 1e-14));
    b = gprojx_section_tube(0.2, 0.01);
    GPROJT_CHECK(near(b.area, gprojx_pi * 0.19 * 0.01, 0, 1e-13) && b.round);
}

/* A tip force and moment on a clamped beam of three pieces in a skew direction: beam theory in the local frame. */
GPROJT_TEST(frame_skew_cantilever) {
    const double a[3] = {0.3, -0.2, 0.1}, b[3] = {1.8, 2.8, 3.1}, force[3] = {700, -400, 900},
                 moment[3] = {50, 80, -30};
    gprojx_section section = gprojx_section_rectangle(0.05, 0.08);
    gprojx_frame frame;
    int32_t beams = 0;
    int k, j;
    double l = 4.5, f[3], m[3], u[3], r[3];
    GPROJT_REQUIRE(gprojx_frame_create(&frame, 4, 3));
    add_line(&frame, &beams, a, b, 3, 0, 1, 3, &section, NULL);
    hold(&frame, 0, "012345");
    memcpy(frame.load + 18, force, sizeof force), memcpy(frame.load + 21, moment, sizeof moment);
    GPROJT_REQUIRE(solve(&frame));
    for (k = 0; k < 3; ++k)
        f[k] = gprojt_dot3(frame.beam[0].axis[k], force), m[k] = gprojt_dot3(frame.beam[0].axis[k], moment);
    {
        double ey = steel.young * section.iy, ez = steel.young * section.iz;
        u[0] = f[0] * l / (steel.young * section.area);
        u[1] = f[1] * l * l * l / (3 * ez) + m[2] * l * l / (2 * ez);
        u[2] = f[2] * l * l * l / (3 * ey) - m[1] * l * l / (2 * ey);
        r[0] = m[0] * l / (steel.shear * section.torsion);
        r[1] = -f[2] * l * l / (2 * ey) + m[1] * l / ey;
        r[2] = f[1] * l * l / (2 * ez) + m[2] * l / ez;
    }
    for (j = 0; j < 3; ++j) {
        double want_u = 0, want_r = 0;
        for (k = 0; k < 3; ++k) want_u += u[k] * frame.beam[0].axis[k][j], want_r += r[k] * frame.beam[0].axis[k][j];
        GPROJT_CHECK(near(frame.motion[18 + j], want_u, gprojt_length3(u), 1e-10));
        GPROJT_CHECK(near(frame.motion[21 + j], want_r, gprojt_length3(r), 1e-10));
        GPROJT_CHECK(near(frame.reaction[j], -force[j], gprojt_length3(force), 1e-12));
    }
    {
        gprojx_beam_state s = gprojx_beam_state_of(&frame, 0);
        GPROJT_CHECK(near(s.axial, f[0], 0, 1e-10) && near(s.torsion, m[0], 0, 1e-10));
        /* A force along z turns the free part about -y: the clamped end has My = m_y - f_z l and Mz = m_z + f_y l. */
        GPROJT_CHECK(near(s.my[0], m[1] - f[2] * l, 0, 1e-10) && near(s.mz[0], m[2] + f[1] * l, 0, 1e-10));
    }
    gprojx_frame_destroy(&frame);
}

/* Moments w L^2/12 at the ends and w L^2/24 in the middle, where the beam hangs by w L^4/384 EI; one beam finds the
   moments, too. Upright, the own weight goes into the axial force. */
GPROJT_TEST(frame_clamped_beam) {
    const double a[3] = {0, 0, 0}, b[3] = {4, 3, 0}, top[3] = {0, 0, 5};
    gprojx_section section = gprojx_section_box(0.1, 0.15, 0.008);
    double w = steel.density * section.area * 9.81, load[3] = {0, 0, -w}, l = 5, out[3], bending, stress;
    gprojx_frame frame;
    int pieces;
    for (pieces = 1; pieces <= 2; ++pieces) {
        int32_t beams = 0;
        gprojx_beam_state s;
        GPROJT_REQUIRE(gprojx_frame_create(&frame, pieces + 1, pieces));
        add_line(&frame, &beams, a, b, pieces, 0, 1, pieces, &section, load);
        hold(&frame, 0, "012345"), hold(&frame, pieces, "012345");
        GPROJT_REQUIRE(solve(&frame));
        if (pieces == 2)
            GPROJT_CHECK(near(frame.motion[8], -w * pow(l, 4) / (384 * steel.young * section.iy), 0, 1e-10));
        s = gprojx_beam_state_of(&frame, 0);
        gprojx_beam_forces_at(&s, 0, out);
        GPROJT_CHECK(near(fabs(out[1]), w * l * l / 12, 0, 1e-10) && fabs(out[2]) < 1e-9 * w);
        gprojx_beam_forces_at(&s, pieces == 1 ? 0.5 : 1, out);
        GPROJT_CHECK(near(fabs(out[1]), w * l * l / 24, 0, 1e-10));
        gprojx_beam_largest(&s, &section, &bending, &stress);
        GPROJT_CHECK(near(bending, w * l * l / 12, 0, 1e-10) && near(stress, bending / section.wy, 0, 1e-10));
        GPROJT_CHECK(near(frame.reaction[2] + frame.reaction[6 * pieces + 2], w * l, 0, 1e-12));
        GPROJT_CHECK(near(frame.reaction[2], w * l / 2, 0, 1e-10));
        gprojx_frame_destroy(&frame);
    }
    {
        int32_t beams = 0;
        gprojx_beam_state s;
        GPROJT_REQUIRE(gprojx_frame_create(&frame, 2, 1));
        add_line(&frame, &beams, a, top, 1, 0, 1, 1, &section, load);
        hold(&frame, 0, "012345");
        GPROJT_REQUIRE(solve(&frame));
        s = gprojx_beam_state_of(&frame, 0);
        gprojx_beam_forces_at(&s, 0, out);
        GPROJT_CHECK(near(out[0], -w * l, 0, 1e-10) && near(frame.reaction[2], w * l, 0, 1e-12));
        gprojx_beam_forces_at(&s, 1, out);
        GPROJT_CHECK(fabs(out[0]) < 1e-10 * w * l);
        GPROJT_CHECK(near(frame.motion[8], -w * l * l / (2 * steel.young * section.area), 0, 1e-10));
        gprojx_frame_destroy(&frame);
    }
}

/* A simply supported beam with the load q along local z, or along local y, and the moment 0.1 q L^2 at its end: the
   moment q x (L - x) / 2 + 0.1 q L x is largest at 0.6 L, 0.18 q L^2. Both together add up in a rectangle, and as
   vectors in a circle. */
GPROJT_TEST(frame_largest_moment) {
    const double a[3] = {0, 0, 0}, b[3] = {3, 0, 0};
    double q = 400, m = 0.18 * q * 9, bending, stress, want;
    int kind;
    for (kind = 0; kind < 6; ++kind) {
        bool along_z = kind % 3 != 1, along_y = kind % 3 != 0;
        gprojx_section section = kind < 3 ? gprojx_section_rectangle(0.05, 0.08) : gprojx_section_circle(0.06);
        gprojx_beam_state s;
        gprojx_frame frame;
        int32_t beams = 0;
        double load[3] = {0, 0, 0};
        load[1] = along_y ? -q : 0, load[2] = along_z ? -q : 0;
        GPROJT_REQUIRE(gprojx_frame_create(&frame, 2, 1));
        add_line(&frame, &beams, a, b, 1, 0, 0, 1, &section, load);
        hold(&frame, 0, "0123"), hold(&frame, 1, "12");
        /* A load along -z makes the inner My negative, one along -y makes Mz positive. */
        frame.load[10] = along_z ? -0.1 * q * 9 : 0, frame.load[11] = along_y ? 0.1 * q * 9 : 0;
        GPROJT_REQUIRE(solve(&frame));
        s = gprojx_beam_state_of(&frame, 0);
        gprojx_beam_largest(&s, &section, &bending, &stress);
        want = section.round ? (along_z && along_y ? sqrt(2.0) : 1) / section.wy
                             : (along_z ? 1 / section.wy : 0) + (along_y ? 1 / section.wz : 0);
        GPROJT_CHECK(near(bending, m * (along_z && along_y ? sqrt(2.0) : 1), 0, 1e-10));
        GPROJT_CHECK(near(stress, m * want, 0, 1e-10));
        gprojx_frame_destroy(&frame);
    }
}

/* A portal clamped at its feet, with a load on the beam. By slope and deflection, with the rotation t of the joints
   and their way d inwards (the beam is shortened by its thrust): (4 EI/h + 2 EI/L) t - 6 EI/h^2 d = q L^2/12, and the
   thrust C = (EI/h^2) (6 t - 12 d/h) gives d = C L / 2 EA. */
GPROJT_TEST(frame_portal) {
    const double foot[3] = {0, 0, 0}, left[3] = {0, 0, 3}, right[3] = {6, 0, 3}, other[3] = {6, 0, 0};
    gprojx_section section = gprojx_section_tube(0.2, 0.01);
    double q = 5000, load[3] = {0, 0, -q}, h = 3, l = 6, ei = steel.young * section.iy, ea = steel.young * section.area;
    double flex = l * ei / (2 * ea * h * h), d_of_t = 6 * flex / (1 + 12 * flex / h);
    double t = q * l * l / 12 / (4 * ei / h + 2 * ei / l - 6 * ei / (h * h) * d_of_t), d = d_of_t * t;
    gprojx_frame frame;
    gprojx_beam_state s;
    int32_t beams = 0;
    GPROJT_REQUIRE(gprojx_frame_create(&frame, 4, 3));
    add_line(&frame, &beams, foot, left, 1, 0, 0, 1, &section, NULL);
    add_line(&frame, &beams, left, right, 1, 1, 0, 2, &section, load);
    add_line(&frame, &beams, right, other, 1, 2, 0, 3, &section, NULL);
    hold(&frame, 0, "012345"), hold(&frame, 3, "012345");
    GPROJT_REQUIRE(solve(&frame));
    GPROJT_CHECK(near(frame.motion[6], d, 0, 1e-10) && near(frame.motion[12], -d, 0, 1e-10));
    GPROJT_CHECK(near(frame.motion[10], t, 0, 1e-10)); /* clockwise, seen against y, is positive about y */
    GPROJT_CHECK(near(frame.motion[8], -q * l / 2 * h / ea, 0, 1e-10));
    s = gprojx_beam_state_of(&frame, 1);
    GPROJT_CHECK(near(s.axial, -ei / (h * h) * (6 * t - 12 * d / h), 0, 1e-10));
    GPROJT_CHECK(near(fabs(s.my[0]), fabs(2 * ei / l * t - q * l * l / 12), 0, 1e-10));
    GPROJT_CHECK(near(fabs(frame.reaction[4]), ei / h * (2 * t - 6 * d / h), 0, 1e-10));
    GPROJT_CHECK(near(frame.reaction[2], q * l / 2, 0, 1e-12));
    gprojx_frame_destroy(&frame);
}

/* ---- a space frame without symmetry ---- */

/* The edges of a wavy grid of quads, rotated by `turn` (columns: images of the axes), as beams with their own weight.
   The first row is clamped. */
static bool grid_frame(gprojx_frame *frame, const double turn[3][3], const gprojx_section *section) {
    gprojt_soup soup = gprojt_quad_grid(6, 5);
    gproj_error error;
    gproj_mesh *mesh = gprojt_soup_mesh(&soup, NULL, &error);
    double weight = steel.density * section->area * 9.81;
    int32_t e, v;
    int k, j;
    if (!mesh || !gprojx_frame_create(frame, mesh->vertex_count, mesh->edge_count)) return false;
    for (v = 0; v < mesh->vertex_count; ++v) {
        double p[3];
        memcpy(p, mesh->position + 3 * v, sizeof p);
        for (k = 0; k < 3; ++k) mesh->position[3 * v + k] = gprojt_dot3(turn[k], p);
    }
    for (e = 0; e < mesh->edge_count; ++e) {
        int32_t a = mesh->origin[2 * e], b = mesh->origin[2 * e + 1];
        double z[3];
        for (k = 0; k < 3; ++k) z[k] = turn[k][2];
        frame->beam[e] = gprojx_beam_between(mesh->position + 3 * a, mesh->position + 3 * b, z, section, &steel);
        frame->beam[e].node[0] = a, frame->beam[e].node[1] = b;
        for (k = 0; k < 3; ++k) frame->beam[e].load[k] = -weight * z[k];
    }
    for (v = 0; v < 7; ++v)
        for (j = 0; j < 6; ++j) frame->held[6 * v + j] = true;
    gproj_mesh_destroy(mesh);
    gprojt_soup_free(&soup);
    return true;
}

static const double straight[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/* Three displacements and three rotations of the whole need no force. */
GPROJT_TEST(frame_rigid_motions) {
    gprojx_section section = gprojx_section_rectangle(0.02, 0.03);
    gprojt_soup soup = gprojt_quad_grid(6, 5);
    gprojx_frame frame;
    double *x, *y, scale;
    int mode, k;
    int32_t v;
    GPROJT_REQUIRE(grid_frame(&frame, straight, &section));
    x = (double *)calloc(12 * (size_t)frame.node_count, sizeof *x);
    y = x + 6 * frame.node_count;
    scale = frame.beam[0].ea / frame.beam[0].length;
    for (mode = 0; mode < 6; ++mode) {
        for (v = 0; v < frame.node_count; ++v) {
            double unit[3] = {mode % 3 == 0, mode % 3 == 1, mode % 3 == 2}, moved[3];
            gprojt_cross3(unit, soup.position + 3 * v, moved);
            for (k = 0; k < 3; ++k) {
                x[6 * v + k] = mode < 3 ? unit[k] : moved[k];
                x[6 * v + 3 + k] = mode < 3 ? 0 : unit[k];
            }
        }
        gprojx_frame_multiply(&frame, NULL, x, y);
        for (v = 0; v < 6 * frame.node_count; ++v) GPROJT_CHECK(fabs(y[v]) <= 1e-13 * scale);
    }
    free(x);
    gprojt_soup_free(&soup);
    gprojx_frame_destroy(&frame);
}

/* The matrix that is factored is the product that refines, and symmetric. */
GPROJT_TEST(frame_stiffness_matrix) {
    gprojx_section section = gprojx_section_rectangle(0.02, 0.03);
    gprojx_frame frame;
    double k[12][12], x[12] = {0}, y[12];
    int i, j;
    const double a[3] = {0.1, 0.2, 0.3}, b[3] = {1, -0.5, 0.8};
    int32_t beams = 0;
    GPROJT_REQUIRE(gprojx_frame_create(&frame, 2, 1));
    add_line(&frame, &beams, a, b, 1, 0, 0, 1, &section, NULL);
    gprojx_beam_stiffness(&frame.beam[0], k);
    for (i = 0; i < 12; ++i) {
        x[i] = 1;
        gprojx_frame_multiply(&frame, NULL, x, y);
        for (j = 0; j < 12; ++j)
            GPROJT_CHECK(fabs(y[j] - k[j][i]) <= 1e-15 * frame.beam[0].ea &&
                         fabs(k[i][j] - k[j][i]) <= 1e-15 * frame.beam[0].ea);
        x[i] = 0;
    }
    gprojx_frame_destroy(&frame);
}

/* The work of loads 1 in displacements 2 is that of loads 2 in displacements 1. */
GPROJT_TEST(frame_reciprocity) {
    gprojx_section section = gprojx_section_box(0.02, 0.03, 0.002);
    gprojx_frame one, two;
    uint64_t seed = 7;
    int32_t i, n;
    double a = 0, b = 0;
    GPROJT_REQUIRE(grid_frame(&one, straight, &section) && grid_frame(&two, straight, &section));
    n = 6 * one.node_count;
    for (i = 0; i < one.beam_count; ++i)
        memset(one.beam[i].load, 0, sizeof one.beam[i].load), memset(two.beam[i].load, 0, sizeof two.beam[i].load);
    for (i = 0; i < n; ++i) {
        one.load[i] = gprojt_uniform(&seed) - 0.3, two.load[i] = gprojt_uniform(&seed) - 0.6;
    }
    GPROJT_REQUIRE(solve(&one) && solve(&two));
    for (i = 0; i < n; ++i) a += one.load[i] * two.motion[i], b += two.load[i] * one.motion[i];
    GPROJT_CHECK(near(a, b, 0, 1e-10));
    gprojx_frame_destroy(&one), gprojx_frame_destroy(&two);
}

/* A frame may be solved again, with other loads and supports. */
GPROJT_TEST(frame_again) {
    gprojx_section section = gprojx_section_rectangle(0.02, 0.03);
    gprojx_frame frame;
    double before, after;
    int32_t v, last;
    GPROJT_REQUIRE(grid_frame(&frame, straight, &section) && solve(&frame));
    last = 6 * (frame.node_count - 1);
    before = frame.motion[last + 2];
    for (v = 0; v < frame.beam_count; ++v) frame.beam[v].load[2] *= 2;
    GPROJT_REQUIRE(solve(&frame));
    GPROJT_CHECK(near(frame.motion[last + 2], 2 * before, 0, 1e-10));
    hold(&frame, frame.node_count - 1, "012");
    GPROJT_REQUIRE(solve(&frame));
    after = frame.reaction[last + 2];
    GPROJT_CHECK(fabs(frame.motion[last + 2]) <= 0 && after > 0);
    gprojx_frame_destroy(&frame);
}

/* A rotated frame moves as before, rotated; supports bear the weight. */
GPROJT_TEST(frame_rotation) {
    gprojx_section section = gprojx_section_rectangle(0.02, 0.03);
    double c = cos(0.7), s = sin(0.7), p = cos(-1.2), q = sin(-1.2);
    const double turn[3][3] = {{c, -s * p, s * q}, {s, c * p, -c * q}, {0, q, p}};
    gprojx_frame plain, turned;
    double weight = 0, sum[3] = {0, 0, 0}, most = 0;
    int32_t v, i;
    int k;
    GPROJT_REQUIRE(grid_frame(&plain, straight, &section) && grid_frame(&turned, turn, &section));
    GPROJT_REQUIRE(solve(&plain) && solve(&turned));
    for (v = 0; v < plain.node_count; ++v) most = fmax(most, gprojt_length3(plain.motion + 6 * v));
    for (v = 0; v < 2 * plain.node_count; ++v)
        for (k = 0; k < 3; ++k)
            GPROJT_CHECK(near(turned.motion[3 * v + k], gprojt_dot3(turn[k], plain.motion + 3 * v), most, 1e-10));
    for (i = 0; i < plain.beam_count; ++i) {
        gprojx_beam_state a = gprojx_beam_state_of(&plain, i), b = gprojx_beam_state_of(&turned, i);
        double m = -plain.beam[0].load[2];
        weight += m * plain.beam[i].length;
        GPROJT_CHECK(near(b.axial, a.axial, m, 1e-10) && near(b.my[0], a.my[0], m, 1e-10));
    }
    for (v = 0; v < plain.node_count; ++v)
        for (k = 0; k < 3; ++k) sum[k] += plain.reaction[6 * v + k];
    GPROJT_CHECK(near(sum[2], weight, 0, 1e-12) && fabs(sum[0]) + fabs(sum[1]) < 1e-12 * weight);
    gprojx_frame_destroy(&plain), gprojx_frame_destroy(&turned);
}

/* Without supports, with rollers alone, and with a beam that turns about itself: the sentence names a vertex. */
GPROJT_TEST(frame_mechanisms) {
    gprojx_section section = gprojx_section_rectangle(0.02, 0.03);
    const double a[3] = {0, 0, 0}, b[3] = {1, 2, 0};
    gprojx_frame frame;
    gproj_error error;
    int32_t beams = 0, v;
    int turn;
    for (turn = 0; turn < 24; ++turn) { /* rounding lets some of these be factored */
        double c = cos(turn), d = sin(turn);
        const double turned[3][3] = {{c, -d * d, d * c}, {d, c * d, -c * c}, {0, c, d}};
        GPROJT_REQUIRE(grid_frame(&frame, turned, &section));
        for (v = 0; v < 6 * frame.node_count; ++v) frame.held[v] = turn % 2 == 0 && v % 6 == 2;
        GPROJT_CHECK(gprojx_frame_solve(&frame, &error) == GPROJ_ERROR_DEGENERATE && strstr(error.message, "vertex "));
        gprojx_frame_destroy(&frame);
    }
    GPROJT_REQUIRE(grid_frame(&frame, straight, &section));
    for (v = 0; v < 6 * frame.node_count; ++v) frame.held[v] = v % 6 == 2;
    GPROJT_CHECK(gprojx_frame_solve(&frame, &error) == GPROJ_ERROR_DEGENERATE &&
                 strstr(error.message, "moves freely along"));
    gprojx_frame_destroy(&frame);
    GPROJT_REQUIRE(gprojx_frame_create(&frame, 2, 1));
    add_line(&frame, &beams, a, b, 1, 0, 0, 1, &section, NULL);
    hold(&frame, 0, "012"), hold(&frame, 1, "012");
    GPROJT_CHECK(gprojx_frame_solve(&frame, &error) == GPROJ_ERROR_DEGENERATE &&
                 strstr(error.message, "turns freely about"));
    GPROJT_CHECK(error.index == 0 && error.place == GPROJ_PLACE_VERTEX);
    gprojx_frame_destroy(&frame);
}

/* ---- orders of refinement ---- */

/* The largest moment in a parabolic arch, clamped or with two hinges, with a load q along its span, drawn by `count`
   beams. */
static double arch_moment(int32_t count, bool clamped) {
    gprojx_section section = {1e6, 1e-2, 1e-2, 1e-2, 1, 1, false}; /* hardly any compression */
    double span = 10, rise = 4, q = 1000, most = 0, bending, stress;
    gprojx_frame frame;
    int32_t i;
    if (!gprojx_frame_create(&frame, count + 1, count)) return NAN;
    for (i = 0; i < count; ++i) {
        double a[3] = {span * i / count, 0, 0}, b[3] = {span * (i + 1) / count, 0, 0};
        a[2] = 4 * rise * i / count * (count - i) / count, b[2] = 4 * rise * (i + 1) / count * (count - i - 1) / count;
        frame.beam[i] = gprojx_beam_between(a, b, up, &section, &steel);
        frame.beam[i].node[0] = i, frame.beam[i].node[1] = i + 1;
        frame.beam[i].load[2] = -q * (b[0] - a[0]) / frame.beam[i].length;
    }
    hold(&frame, 0, clamped ? "012345" : "012"), hold(&frame, count, clamped ? "012345" : "012");
    for (i = 0; i <= count; ++i) frame.held[6 * i + 1] = true; /* the arch stays in a plane */
    frame.held[3] = true;
    if (!solve(&frame)) most = NAN;
    for (i = 0; i < count; ++i) {
        gprojx_beam_state s = gprojx_beam_state_of(&frame, i);
        gprojx_beam_largest(&s, &section, &bending, &stress);
        most = fmax(most, bending);
    }
    gprojx_frame_destroy(&frame);
    return most;
}

/* A parabola is the shape of thrust: moments vanish with order 2. Clamped, they are exactly those of the pieces alone,
   q h^2/12; hinges release this moment at the ends, which bends the whole arch a little. */
GPROJT_TEST(frame_parabolic_arch) {
    int32_t count;
    int clamped;
    for (clamped = 0; clamped < 2; ++clamped) {
        double previous = arch_moment(8, clamped), moment, order;
        for (count = 16; count <= 128; count *= 2, previous = moment) {
            moment = arch_moment(count, clamped);
            order = log2(previous / moment);
            printf("  %s arch of %d beams: moment %.3e of q L^2, order %.4f\n", clamped ? "clamped" : "hinged",
                   (int)count, moment / 1e5, order);
            GPROJT_CHECK(fabs(order - 2) < (clamped ? 1e-3 : 0.1));
            if (clamped) GPROJT_CHECK(near(moment, 1e5 / count / count / 12, 0, 1e-3));
        }
    }
}

/* The smallest load factor of a column of `count` beams under the load 1, over pi^2 EI / L^2; lower and upper: the
   held motions. The column stands upright, pressed along itself, and is softer about the local z. */
static double column_factor(int32_t count, bool clamped, bool top_clamped, bool top_guided) {
    gprojx_section section = gprojx_section_rectangle(0.03, 0.05);
    const double a[3] = {0, 0, 0}, b[3] = {0, 0, 3};
    double axial[64], factor;
    gprojx_buckling buckling;
    gprojx_frame frame;
    int32_t beams = 0, i;
    if (!gprojx_frame_create(&frame, count + 1, count)) return NAN;
    add_line(&frame, &beams, a, b, count, 0, 1, count, &section, NULL);
    hold(&frame, 0, clamped ? "012345" : "0125");
    if (top_guided) hold(&frame, count, "01");
    if (top_clamped) hold(&frame, count, "34");
    frame.load[6 * count + 2] = -1;
    if (!solve(&frame)) return NAN;
    for (i = 0; i < count; ++i) axial[i] = gprojx_beam_state_of(&frame, i).axial;
    GPROJT_CHECK(near(axial[0], -1, 0, 1e-10));
    GPROJT_CHECK(gprojx_frame_buckle(&frame, axial, &buckling) == GPROJ_OK && buckling.converged);
    GPROJT_CHECK(buckling.residual[0] <= 1e-8 && buckling.shape);
    factor = buckling.factor[0] * 9 / (gprojx_pi * gprojx_pi * steel.young * section.iz);
    free(buckling.shape);
    gprojx_frame_destroy(&frame);
    return factor;
}

static void check_column(const char *name, double exact, bool clamped, bool top_clamped, bool top_guided) {
    double previous = column_factor(4, clamped, top_clamped, top_guided) - exact, error, order;
    int32_t count;
    for (count = 8; count <= 32; count *= 2, previous = error) {
        error = column_factor(count, clamped, top_clamped, top_guided) - exact;
        order = log2(previous / error);
        printf("  %s column of %d beams: relative error %.2e, order %.3f\n", name, (int)count, error / exact, order);
        GPROJT_CHECK(fabs(order - 4) < 0.15 && error > 0);
    }
    GPROJT_CHECK(fabs(error) < 1e-5 * exact);
}

/* Euler's columns: the factors converge to 1, 1/4, 2.0457.. (the smallest root of tan x = x is 4.4934..) and 4 from
   above, with order 4. */
GPROJT_TEST(frame_euler_columns) {
    double root = 4.493409457909064;
    check_column("pinned", 1, false, false, true);
    check_column("free", 0.25, true, false, false);
    check_column("propped", root * root / (gprojx_pi * gprojx_pi), true, false, true);
    check_column("clamped", 4, true, true, true);
}

/* A square column has two equal factors, and a ring of four columns on one frame nearly equal ones; a pulled column
   beside a pressed one has negative factors that are smaller: only the positive count. */
GPROJT_TEST(frame_buckling_clusters) {
    gprojx_section section = gprojx_section_box(0.04, 0.04, 0.003);
    const double foot[2][3] = {{0, 0, 0}, {5, 0, 0}}, top[2][3] = {{0, 0, 3}, {5, 0, 3}};
    double axial[16], euler = gprojx_pi * gprojx_pi * steel.young * section.iy / 9;
    gprojx_buckling buckling;
    gprojx_frame frame;
    int32_t beams = 0, i;
    GPROJT_REQUIRE(gprojx_frame_create(&frame, 18, 16));
    for (i = 0; i < 2; ++i) {
        add_line(&frame, &beams, foot[i], top[i], 8, 9 * i, 9 * i + 1, 9 * i + 8, &section, NULL);
        hold(&frame, 9 * i, "0125"), hold(&frame, 9 * i + 8, "01");
        frame.load[6 * (9 * i + 8) + 2] = i == 0 ? -1 : 100;
    }
    GPROJT_REQUIRE(solve(&frame));
    for (i = 0; i < 16; ++i) axial[i] = gprojx_beam_state_of(&frame, i).axial;
    GPROJT_REQUIRE(gprojx_frame_buckle(&frame, axial, &buckling) == GPROJ_OK);
    GPROJT_CHECK(buckling.converged && near(buckling.factor[0], euler, 0, 1e-4));
    GPROJT_CHECK(near(buckling.factor[1], buckling.factor[0], 0, 1e-10));
    GPROJT_CHECK(near(buckling.factor[2], 4 * euler, 0, 1e-3) && near(buckling.factor[3], buckling.factor[2], 0, 1e-8));
    free(buckling.shape);
    for (i = 0; i < 16; ++i) axial[i] = fabs(axial[i]);
    GPROJT_REQUIRE(gprojx_frame_buckle(&frame, axial, &buckling) == GPROJ_OK);
    GPROJT_CHECK(buckling.converged && !buckling.shape && buckling.factor[0] > 1e300);
    gprojx_frame_destroy(&frame);
}

/* One beam, clamped below and guided above, has two ways to buckle, by end rotations: 30 EI / L^2. There are no other
   factors. */
GPROJT_TEST(frame_buckling_few) {
    gprojx_section section = gprojx_section_rectangle(0.03, 0.05);
    const double a[3] = {0, 0, 0}, b[3] = {0, 0, 3};
    double axial = -1;
    gprojx_buckling buckling;
    gprojx_frame frame;
    int32_t beams = 0;
    GPROJT_REQUIRE(gprojx_frame_create(&frame, 2, 1));
    add_line(&frame, &beams, a, b, 1, 0, 0, 1, &section, NULL);
    hold(&frame, 0, "012345"), hold(&frame, 1, "01");
    GPROJT_REQUIRE(solve(&frame) && gprojx_frame_buckle(&frame, &axial, &buckling) == GPROJ_OK);
    GPROJT_CHECK(buckling.converged && near(buckling.factor[0], 30 * steel.young * section.iz / 9, 0, 1e-10));
    GPROJT_CHECK(near(buckling.factor[1], 30 * steel.young * section.iy / 9, 0, 1e-10));
    GPROJT_CHECK(isinf(buckling.factor[2]) && isinf(buckling.factor[3]));
    free(buckling.shape);
    gprojx_frame_destroy(&frame);
}

/* The shape of a frame with all kinds of forces and the factor make K x + f G x vanish; twice the forces give half the
   factor. */
GPROJT_TEST(frame_buckling_shape) {
    gprojx_section section = gprojx_section_rectangle(0.02, 0.03);
    gprojx_buckling one, two;
    gprojx_frame frame;
    double *axial, *kx, *gx, most = 0, rest = 0;
    int32_t i, n;
    GPROJT_REQUIRE(grid_frame(&frame, straight, &section) && solve(&frame));
    n = 6 * frame.node_count;
    axial = (double *)calloc((size_t)frame.beam_count + 2 * (size_t)n, sizeof *axial);
    kx = axial + frame.beam_count, gx = kx + n;
    for (i = 0; i < frame.beam_count; ++i) axial[i] = gprojx_beam_state_of(&frame, i).axial;
    GPROJT_REQUIRE(gprojx_frame_buckle(&frame, axial, &one) == GPROJ_OK && one.converged && one.shape);
    gprojx_frame_multiply(&frame, NULL, one.shape, kx);
    gprojx_frame_multiply(&frame, axial, one.shape, gx);
    for (i = 0; i < n; ++i) {
        if (frame.held[i]) continue;
        most = fmax(most, fabs(kx[i])), rest = fmax(rest, fabs(kx[i] + one.factor[0] * gx[i]));
    }
    GPROJT_CHECK(rest < 1e-6 * most && one.factor[0] > 0);
    for (i = 0; i < frame.beam_count; ++i) axial[i] *= 2;
    GPROJT_REQUIRE(gprojx_frame_buckle(&frame, axial, &two) == GPROJ_OK && two.converged);
    for (i = 0; i < GPROJX_WANTED; ++i) GPROJT_CHECK(near(two.factor[i], one.factor[i] / 2, 0, 1e-10));
    free(one.shape), free(two.shape), free(axial);
    gprojx_frame_destroy(&frame);
}

int main(void) {
    GPROJT_RUN(frame_sections);
    GPROJT_RUN(frame_skew_cantilever);
    GPROJT_RUN(frame_clamped_beam);
    GPROJT_RUN(frame_largest_moment);
    GPROJT_RUN(frame_portal);
    GPROJT_RUN(frame_rigid_motions);
    GPROJT_RUN(frame_stiffness_matrix);
    GPROJT_RUN(frame_reciprocity);
    GPROJT_RUN(frame_again);
    GPROJT_RUN(frame_rotation);
    GPROJT_RUN(frame_mechanisms);
    GPROJT_RUN(frame_parabolic_arch);
    GPROJT_RUN(frame_euler_columns);
    GPROJT_RUN(frame_buckling_clusters);
    GPROJT_RUN(frame_buckling_few);
    GPROJT_RUN(frame_buckling_shape);
    return gprojt_report();
}
