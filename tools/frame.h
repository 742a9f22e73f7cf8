/* frame.h - linear statics of spatial frames: straight beams with rigid joints, on the sparse Cholesky factorisation.

       gprojx_frame frame;
       if (!gprojx_frame_create(&frame, nodes, beams)) ...           then set every frame.beam[i] (gprojx_beam_between),
       frame.held[6 * v + 2] = true; frame.load[6 * v] = 1e3;        supports and loads at nodes
       if (gprojx_frame_solve(&frame, &error) != GPROJ_OK) ...       displacements in frame.motion, frame.reaction
       state = gprojx_beam_state_of(&frame, i);                      inner forces of a beam
       gprojx_frame_destroy(&frame);

   A node has six degrees of freedom: displacements along and rotations about the global x, y, z. Beams are those of
   Euler and Bernoulli, with St. Venant's torsion, and no shear deformation or warping [Przemieniecki 1968, chapter 5].
   Units are consistent ones, such as N and m. frame_buckling.h goes on from here.

   Include guidedproj.h before this file. Memory by malloc; no global state. */
#ifndef GPROJX_FRAME_H
#define GPROJX_FRAME_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- sections ---- */

static const double gprojx_pi = 3.14159265358979323846;

typedef struct gprojx_section {
    double area;
    double iy, iz;  /* second moments of area about the local axes y and z */
    double torsion; /* St. Venant's constant J */
    double wy, wz;  /* section moduli: I over the distance of the outermost fibre */
    bool round;     /* moments about y and z add up as vectors */
} gprojx_section;

static gprojx_section gprojx_section_moduli(gprojx_section s, double width, double height) {
    s.wy = 2 * s.iy / height, s.wz = 2 * s.iz / width;
    return s;
}

/* A solid rectangle, `height` along the local z. A = w h, Iy = w h^3 / 12, Iz = w^3 h / 12, and for the longer side a
   and the shorter b: J = a b^3 / 3 (1 - 192/pi^5 b/a sum over n = 1, 3, .. of tanh(n pi a / 2b) / n^5) [Timoshenko,
   Goodier 1970, section 109]. */
static gprojx_section gprojx_section_rectangle(double width, double height) {
    gprojx_section s = {0, 0, 0, 0, 0, 0, false};
    double a = fmax(width, height), b = fmin(width, height), sum = 0;
    int n;
    for (n = 1; n < 400; n += 2) sum += tanh(n * gprojx_pi * a / (2 * b)) / pow(n, 5);
    s.area = width * height;
    s.iy = width * pow(height, 3) / 12, s.iz = pow(width, 3) * height / 12;
    s.torsion = a * pow(b, 3) / 3 * (1 - 192 / pow(gprojx_pi, 5) * b / a * sum);
    return gprojx_section_moduli(s, width, height);
}

/* A hollow rectangle with walls of thickness t: A and I are differences of two rectangles, and J = 4 Am^2 t / s with
   the area Am inside the middle line of the walls and its length s [Bredt 1896; Young, Budynas, Roark's Formulas,
   table 10.1]. */
static gprojx_section gprojx_section_box(double width, double height, double thickness) {
    gprojx_section s = gprojx_section_rectangle(width, height);
    double w = width - 2 * thickness, h = height - 2 * thickness, middle_w = width - thickness,
           middle_h = height - thickness;
    s.area -= w * h;
    s.iy -= w * pow(h, 3) / 12, s.iz -= pow(w, 3) * h / 12;
    s.torsion = 2 * pow(middle_w * middle_h, 2) * thickness / (middle_w + middle_h);
    return gprojx_section_moduli(s, width, height);
}

/* A round tube with inner diameter d = D - 2 t (0: a solid circle): A = pi (D^2 - d^2) / 4, I = pi (D^4 - d^4) / 64,
   J = 2 I [Gere, Goodno, Mechanics of Materials, appendix E]. */
static gprojx_section gprojx_section_tube(double diameter, double thickness) {
    gprojx_section s = {0, 0, 0, 0, 0, 0, true};
    double inner = diameter - 2 * thickness;
    s.area = gprojx_pi / 4 * (diameter * diameter - inner * inner);
    s.iy = s.iz = gprojx_pi / 64 * (pow(diameter, 4) - pow(inner, 4));
    s.torsion = 2 * s.iy;
    return gprojx_section_moduli(s, diameter, diameter);
}

static gprojx_section gprojx_section_circle(double diameter) { return gprojx_section_tube(diameter, diameter / 2); }

typedef struct gprojx_material {
    double young, shear; /* E and G */
    double density;
    double yield; /* the stress that utilisation 1 means */
} gprojx_material;

/* ---- vectors ---- */

static double gprojx_frame_dot(size_t count, const double *a, const double *b) {
    double sum = 0;
    size_t i;
    for (i = 0; i < count; ++i) sum += a[i] * b[i];
    return sum;
}

static double gprojx_length3(const double a[3]) { return sqrt(gprojx_frame_dot(3, a, a)); }

static void gprojx_cross3(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* ---- one beam ---- */

typedef struct gprojx_beam {
    int32_t node[2];
    double length;
    double axis[3][3];       /* unit vectors of the local frame: x from node[0] to node[1], y, z */
    double ea, eiy, eiz, gj; /* stiffness against stretching, bending about y and z, twisting */
    double load[3];          /* force per length, along the global axes */
} gprojx_beam;

/* A beam from point a to point b, without load and nodes. Local z is `up` without the part along the beam (the height
   of its section stands so), local y = z cross x. If `up` is along the beam, the global axis least along it is taken.
   */
static gprojx_beam gprojx_beam_between(const double a[3], const double b[3], const double up[3],
                                       const gprojx_section *section, const gprojx_material *material) {
    gprojx_beam beam;
    double *x = beam.axis[0], *y = beam.axis[1], *z = beam.axis[2], along;
    int k, least = 0;
    memset(&beam, 0, sizeof beam);
    for (k = 0; k < 3; ++k) x[k] = b[k] - a[k];
    beam.length = gprojx_length3(x);
    for (k = 0; k < 3; ++k) x[k] /= beam.length;
    for (k = 1; k < 3; ++k)
        if (fabs(x[k]) < fabs(x[least])) least = k;
    gprojx_cross3(up, x, y);
    if (!(gprojx_length3(y) > 1e-6 * gprojx_length3(up))) {
        const double other[3] = {least == 0, least == 1, least == 2};
        gprojx_cross3(other, x, y);
    }
    along = gprojx_length3(y);
    for (k = 0; k < 3; ++k) y[k] /= along;
    gprojx_cross3(x, y, z);
    beam.ea = material->young * section->area, beam.gj = material->shear * section->torsion;
    beam.eiy = material->young * section->iy, beam.eiz = material->young * section->iz;
    return beam;
}

/* Modes of a beam's deformation, linear in the 12 motions of its ends (3 displacements, 3 rotations, twice):
   0 the elongation, 1 the twist, 2 and 3 the ends' rotations about y against the chord, 4 and 5 about z, 6 and 7 the
   slope of the chord along z and along y. Rigid motions leave 0 to 5 at zero, translations 6 and 7, too. */
enum {
    GPROJX_MODES = 8
};

static void gprojx_beam_modes(const gprojx_beam *beam, double mode[GPROJX_MODES][12]) {
    const double *x = beam->axis[0], *y = beam->axis[1], *z = beam->axis[2], length = beam->length;
    int k, end;
    memset(mode, 0, GPROJX_MODES * sizeof mode[0]);
    for (k = 0; k < 3; ++k) {
        mode[0][k] = -x[k], mode[0][6 + k] = x[k];
        mode[1][3 + k] = -x[k], mode[1][9 + k] = x[k];
        mode[6][k] = -z[k] / length, mode[6][6 + k] = z[k] / length;
        mode[7][k] = -y[k] / length, mode[7][6 + k] = y[k] / length;
        for (end = 0; end < 2; ++end) {
            /* A rotation about y lowers the slope along z, one about z raises the slope along y. */
            mode[2 + end][k] = mode[6][k], mode[2 + end][6 + k] = mode[6][6 + k];
            mode[4 + end][k] = -mode[7][k], mode[4 + end][6 + k] = -mode[7][6 + k];
            mode[2 + end][6 * end + 3 + k] = y[k];
            mode[4 + end][6 * end + 3 + k] = z[k];
        }
    }
}

/* The elastic energy is half a quadratic form of the modes; d is its matrix. With end rotations a and b a beam bends
   into a cubic, and its ends need the moments EI/L (4 a + 2 b) and EI/L (2 a + 4 b). */
static void gprojx_beam_elasticity(const gprojx_beam *beam, double d[GPROJX_MODES][GPROJX_MODES]) {
    double by = beam->eiy / beam->length, bz = beam->eiz / beam->length;
    memset(d, 0, GPROJX_MODES * sizeof d[0]);
    d[0][0] = beam->ea / beam->length;
    d[1][1] = beam->gj / beam->length;
    d[2][2] = d[3][3] = 4 * by, d[2][3] = d[3][2] = 2 * by;
    d[4][4] = d[5][5] = 4 * bz, d[4][5] = d[5][4] = 2 * bz;
}

/* Work of the axial force N in the slopes w', v' of the bent beam: N/2 times the integral of w'^2 + v'^2, again half a
   quadratic form of the modes. The chord's slope c gives L c^2, end rotations a and b against it L/30 (4 a^2 - 2 a b +
   4 b^2); in the 12 motions it is the usual geometric stiffness [Przemieniecki 1968, chapter 15]. */
static void gprojx_beam_geometry(const gprojx_beam *beam, double force, double d[GPROJX_MODES][GPROJX_MODES]) {
    double chord = force * beam->length, bend = chord / 30;
    int k;
    memset(d, 0, GPROJX_MODES * sizeof d[0]);
    d[6][6] = d[7][7] = chord;
    for (k = 2; k < 6; k += 2) {
        d[k][k] = d[k + 1][k + 1] = 4 * bend;
        d[k][k + 1] = d[k + 1][k] = -bend;
    }
}

/* The 12 x 12 stiffness in global axes, k = mode' d mode. */
static void gprojx_beam_stiffness(const gprojx_beam *beam, double k[12][12]) {
    double mode[GPROJX_MODES][12], d[GPROJX_MODES][GPROJX_MODES];
    int i, j, p, q;
    gprojx_beam_modes(beam, mode);
    gprojx_beam_elasticity(beam, d);
    memset(k, 0, 12 * sizeof k[0]);
    for (p = 0; p < 6; ++p)
        for (q = 0; q < 6; ++q)
            for (i = 0; i < 12 && fabs(d[p][q]) > 0; ++i)
                for (j = 0; j < 12; ++j) k[i][j] += mode[p][i] * d[p][q] * mode[q][j];
}

/* Nodal forces and moments that do the work of the beam's load in all cubic shapes: half of it at each end, and the
   moments x cross q L^2/12 at node[0] and the opposite at node[1]. */
static void gprojx_beam_loads(const gprojx_beam *beam, double load[12]) {
    double moment[3];
    int k;
    gprojx_cross3(beam->axis[0], beam->load, moment);
    for (k = 0; k < 3; ++k) {
        load[k] = load[6 + k] = beam->load[k] * beam->length / 2;
        load[3 + k] = moment[k] * beam->length * beam->length / 12;
        load[9 + k] = -load[3 + k];
    }
}

/* ---- the frame ---- */

typedef struct gprojx_frame {
    int32_t node_count, beam_count;
    gprojx_beam *beam;
    bool *held;       /* 6 a node: motions that a support prevents */
    double *load;     /* 6 a node: forces and moments, without the loads of the beams */
    double *motion;   /* 6 a node: displacements and rotations (radians) */
    double *reaction; /* 6 a node: forces and moments of the supports on the frame; 0 at motions that are not held */
    /* For the solve: */
    gproj_cholesky *cholesky;
    int32_t unknowns;
    int32_t *unknown; /* 6 a node: column of the matrix; -1: held, or no beam ends there */
    int64_t *start;   /* matrix in compressed columns: entries of the beams one by one, then the diagonal once more */
    int32_t *row;
    double *value;
    double *side; /* one number an unknown */
} gprojx_frame;

static void gprojx_frame_destroy(gprojx_frame *frame) {
    gproj_cholesky_destroy(frame->cholesky);
    free(frame->beam), free(frame->held), free(frame->load), free(frame->motion), free(frame->reaction);
    free(frame->unknown), free(frame->start), free(frame->row), free(frame->value), free(frame->side);
    memset(frame, 0, sizeof *frame);
}

/* All arrays are zero; false without memory. */
static bool gprojx_frame_create(gprojx_frame *frame, int32_t nodes, int32_t beams) {
    size_t motions = 6 * (size_t)nodes;
    memset(frame, 0, sizeof *frame);
    frame->node_count = nodes, frame->beam_count = beams;
    frame->beam = (gprojx_beam *)calloc((size_t)beams + 1, sizeof *frame->beam);
    frame->held = (bool *)calloc(motions + 1, sizeof *frame->held);
    frame->load = (double *)calloc(motions + 1, sizeof *frame->load);
    frame->motion = (double *)calloc(motions + 1, sizeof *frame->motion);
    frame->reaction = (double *)calloc(motions + 1, sizeof *frame->reaction);
    frame->unknown = (int32_t *)malloc((motions + 1) * sizeof *frame->unknown);
    frame->cholesky = gproj_cholesky_create(NULL);
    if (frame->beam && frame->held && frame->load && frame->motion && frame->reaction && frame->unknown &&
        frame->cholesky)
        return true;
    gprojx_frame_destroy(frame);
    return false;
}

/* Number of the motion i (0 to 11) of a beam among all motions. */
static size_t gprojx_motion_of(const gprojx_beam *beam, int i) {
    return 6 * (size_t)beam->node[i / 6] + (size_t)(i % 6);
}

/* y = K x for all motions, held or not, beam by beam through the modes: rigid motions cancel in them, not in large
   sums. axial (tension > 0; one number a beam) gives the geometric stiffness instead of the elastic one; NULL:
   elastic. */
static void gprojx_frame_multiply(const gprojx_frame *frame, const double *axial, const double *x, double *y) {
    double mode[GPROJX_MODES][12], d[GPROJX_MODES][GPROJX_MODES], e[GPROJX_MODES], s;
    int32_t b;
    int i, p;
    memset(y, 0, 6 * (size_t)frame->node_count * sizeof *y);
    for (b = 0; b < frame->beam_count; ++b) {
        const gprojx_beam *beam = &frame->beam[b];
        gprojx_beam_modes(beam, mode);
        if (axial)
            gprojx_beam_geometry(beam, axial[b], d);
        else
            gprojx_beam_elasticity(beam, d);
        for (p = 0; p < GPROJX_MODES; ++p)
            for (e[p] = 0, i = 0; i < 12; ++i) e[p] += mode[p][i] * x[gprojx_motion_of(beam, i)];
        for (p = 0; p < GPROJX_MODES; ++p) {
            s = gprojx_frame_dot(GPROJX_MODES, d[p], e);
            for (i = 0; i < 12; ++i) y[gprojx_motion_of(beam, i)] += mode[p][i] * s;
        }
    }
}

/* All loads: those at nodes and those of beams; 6 a node. */
static void gprojx_frame_loads(const gprojx_frame *frame, double *load) {
    double of_beam[12];
    int32_t b;
    int i;
    memcpy(load, frame->load, 6 * (size_t)frame->node_count * sizeof *load);
    for (b = 0; b < frame->beam_count; ++b) {
        gprojx_beam_loads(&frame->beam[b], of_beam);
        for (i = 0; i < 12; ++i) load[gprojx_motion_of(&frame->beam[b], i)] += of_beam[i];
    }
}

/* ---- solving ---- */

/* Numbers the motions that are free and belong to a beam. */
static void gprojx_frame_number(gprojx_frame *frame) {
    size_t motions = 6 * (size_t)frame->node_count, i;
    int32_t b, end, k;
    for (i = 0; i < motions; ++i) frame->unknown[i] = -1;
    for (b = 0; b < frame->beam_count; ++b)
        for (end = 0; end < 2; ++end)
            for (k = 0; k < 6; ++k) frame->unknown[6 * (size_t)frame->beam[b].node[end] + (size_t)k] = 0;
    for (frame->unknowns = 0, i = 0; i < motions; ++i)
        if (frame->unknown[i] == 0) frame->unknown[i] = frame->held[i] ? -1 : frame->unknowns++;
}

/* Puts the entries of all beams into columns; pass 0 counts them, pass 1 writes them. Repeated entries are summed by
   the factorisation. */
static void gprojx_frame_enter(gprojx_frame *frame, int pass, int64_t *next) {
    double k[12][12];
    int32_t b;
    int i, j;
    for (b = 0; b < frame->beam_count; ++b) {
        if (pass == 1) gprojx_beam_stiffness(&frame->beam[b], k);
        for (i = 0; i < 12; ++i)
            for (j = 0; j <= i; ++j) {
                int32_t row = frame->unknown[gprojx_motion_of(&frame->beam[b], i)],
                        column = frame->unknown[gprojx_motion_of(&frame->beam[b], j)];
                if (row < 0 || column < 0) continue;
                if (pass == 1) frame->row[next[column]] = row, frame->value[next[column]] = k[i][j];
                next[column]++;
            }
    }
}

static bool gprojx_frame_assemble(gprojx_frame *frame) {
    int64_t *next;
    int32_t j;
    free(frame->start), free(frame->row), free(frame->value), free(frame->side); /* of an earlier solve */
    frame->row = NULL, frame->value = NULL;
    gprojx_frame_number(frame);
    frame->start = (int64_t *)calloc((size_t)frame->unknowns + 1, sizeof *frame->start);
    frame->side = (double *)calloc((size_t)frame->unknowns + 1, sizeof *frame->side);
    next = (int64_t *)calloc((size_t)frame->unknowns + 1, sizeof *next);
    if (frame->start && next) {
        gprojx_frame_enter(frame, 0, next);
        for (j = 0; j < frame->unknowns; ++j) frame->start[j + 1] = frame->start[j] + next[j] + 1;
        frame->row = (int32_t *)malloc(((size_t)frame->start[frame->unknowns] + 1) * sizeof *frame->row);
        frame->value = (double *)calloc((size_t)frame->start[frame->unknowns] + 1, sizeof *frame->value);
    }
    if (frame->row && frame->value && frame->side) {
        for (j = 0; j < frame->unknowns; ++j) next[j] = frame->start[j];
        gprojx_frame_enter(frame, 1, next);
        for (j = 0; j < frame->unknowns; ++j) frame->row[next[j]] = j; /* the diagonal, for shifts */
    }
    free(next);
    return frame->row && frame->value && frame->side;
}

/* x = A^-1 b with the factor at hand; 6 a node, b is read and x written at unknowns, x is 0 elsewhere. */
static void gprojx_frame_apply_inverse(gprojx_frame *frame, const double *b, double *x) {
    size_t motions = 6 * (size_t)frame->node_count, i;
    for (i = 0; i < motions; ++i)
        if (frame->unknown[i] >= 0) frame->side[frame->unknown[i]] = b[i];
    gproj_cholesky_solve(frame->cholesky, 1, frame->side, frame->side);
    for (i = 0; i < motions; ++i) x[i] = frame->unknown[i] >= 0 ? frame->side[frame->unknown[i]] : 0;
}

/* Entry j of K's diagonal, without a shift. */
static double gprojx_frame_diagonal(const gprojx_frame *frame, int32_t j) {
    double sum = 0;
    int64_t p;
    for (p = frame->start[j]; p < frame->start[j + 1] - 1; ++p)
        if (frame->row[p] == j) sum += frame->value[p];
    return sum;
}

/* Factors K + shift D with the diagonal D of K. */
static gproj_factor_outcome gprojx_frame_factor(gprojx_frame *frame, double shift) {
    int32_t j;
    for (j = 0; j < frame->unknowns; ++j)
        frame->value[frame->start[j + 1] - 1] = shift * gprojx_frame_diagonal(frame, j);
    return gproj_cholesky_factor(frame->cholesky, frame->value);
}

/* The easiest motion, by inverse iteration: x minimises x'K x / x'D x with the diagonal D of K, where translations,
   rotations and their units are alike. Returns the minimum; about 1e-30 for a mechanism, by rounding. x, work: 6 a
   node. */
static double gprojx_frame_easiest(gprojx_frame *frame, double *x, double *work) {
    size_t motions = 6 * (size_t)frame->node_count, i;
    double energy = 0, size = 0;
    int round;
    for (i = 0; i < motions; ++i) x[i] = frame->unknown[i] >= 0 ? sin(1.0 + 1.7 * (double)i) : 0;
    for (round = 0; round < 6; ++round) {
        size = 0;
        for (i = 0; i < motions; ++i) {
            work[i] = frame->unknown[i] >= 0 ? gprojx_frame_diagonal(frame, frame->unknown[i]) * x[i] : 0;
            size += work[i] * x[i];
        }
        if (round == 5) break;
        for (i = 0; i < motions; ++i) work[i] /= sqrt(size);
        gprojx_frame_apply_inverse(frame, work, x);
    }
    gprojx_frame_multiply(frame, NULL, x, work);
    energy = gprojx_frame_dot(motions, x, work);
    return size > 0 ? energy / size : 1;
}

/* Says which node moves the most in x, and how. */
static gproj_code gprojx_frame_name_mechanism(const gprojx_frame *frame, const double *x, gproj_error *error) {
    const char *how = "moves";
    double most = 0, turn = 0, direction[3];
    int32_t v, best = 0, turned = 0;
    for (v = 0; v < frame->node_count; ++v) {
        double moved = gprojx_length3(x + 6 * (size_t)v), rotated = gprojx_length3(x + 6 * (size_t)v + 3);
        if (moved > (1 + 1e-9) * most) most = moved, best = v;
        if (rotated > (1 + 1e-9) * turn) turn = rotated, turned = v;
    }
    if (!(most > 1e-6 * turn * frame->beam[0].length)) how = "turns", best = turned, most = turn;
    x += 6 * (size_t)best + (how[0] == 't' ? 3 : 0);
    for (v = 0; v < 3; ++v) direction[v] = fabs(x[v]) < 5e-3 * most ? 0 : x[v] / most;
    error->code = GPROJ_ERROR_DEGENERATE, error->place = GPROJ_PLACE_VERTEX, error->index = best;
    snprintf(error->message, sizeof error->message,
             "the frame is a mechanism: vertex %ld %s freely %s (%.2g, %.2g, %.2g); hold it by more supports",
             (long)best, how, how[0] == 't' ? "about" : "along", direction[0], direction[1], direction[2]);
    return error->code;
}

/* Factors K, or names the mechanism. */
static gproj_code gprojx_frame_prepare(gprojx_frame *frame, gproj_error *error) {
    const double least = 1e-20; /* of x'K x / x'D x: a cantilever of 10,000 beams has 5e-17 */
    size_t motions = 6 * (size_t)frame->node_count;
    double *x = (double *)calloc(2 * motions + 1, sizeof *x);
    gproj_factor_outcome outcome;
    bool shifted;
    gproj_code code = x && gprojx_frame_assemble(frame)
                          ? gproj_cholesky_analyse(frame->cholesky, frame->unknowns, frame->start, frame->row, NULL)
                          : GPROJ_ERROR_MEMORY;
    if (code == GPROJ_OK && frame->unknowns > 0) {
        /* Rounding decides whether a singular matrix is factored; with a small shift it always is. */
        outcome = gprojx_frame_factor(frame, 0);
        shifted = outcome == GPROJ_NOT_POSITIVE_DEFINITE;
        if (shifted) outcome = gprojx_frame_factor(frame, 1e-10);
        if (outcome == GPROJ_FACTOR_FAILED) {
            code = gproj_cholesky_error(frame->cholesky)->code;
        } else if (outcome == GPROJ_NOT_POSITIVE_DEFINITE) {
            error->code = code = GPROJ_ERROR_NUMBER;
            snprintf(error->message, sizeof error->message, "the stiffness of the frame cannot be factored");
        } else if (!(gprojx_frame_easiest(frame, x, x + motions) > least) || shifted) {
            code = gprojx_frame_name_mechanism(frame, x, error);
        }
    }
    free(x);
    return code;
}

/* Finds displacements and reactions. A mechanism gives GPROJ_ERROR_DEGENERATE and names a node that moves. The factor
   stays, for gprojx_frame_apply_inverse. */
static gproj_code gprojx_frame_solve(gprojx_frame *frame, gproj_error *error) {
    size_t motions = 6 * (size_t)frame->node_count, i;
    double *load = (double *)malloc((3 * motions + 1) * sizeof *load), *rest, *step;
    gproj_code code;
    int round;
    memset(error, 0, sizeof *error);
    error->index = -1;
    code = load ? gprojx_frame_prepare(frame, error) : GPROJ_ERROR_MEMORY;
    if (code == GPROJ_OK) {
        rest = load + motions, step = rest + motions;
        gprojx_frame_loads(frame, load);
        memset(frame->motion, 0, motions * sizeof *frame->motion);
        /* The first round solves, the others refine. */
        for (round = 0; round < 4; ++round) {
            gprojx_frame_multiply(frame, NULL, frame->motion, rest);
            for (i = 0; i < motions; ++i) rest[i] = load[i] - rest[i];
            if (round == 3) break;
            gprojx_frame_apply_inverse(frame, rest, step);
            for (i = 0; i < motions; ++i) frame->motion[i] += step[i];
        }
        for (i = 0; i < motions; ++i) frame->reaction[i] = frame->held[i] ? -rest[i] : 0;
    }
    free(load);
    if (code != GPROJ_OK && error->code == GPROJ_OK) {
        error->code = code;
        snprintf(error->message, sizeof error->message, "%s", gproj_code_string(code));
    }
    return code;
}

/* ---- inner forces ---- */

/* Forces and moments along a beam, in its local frame: they act on the part before the place. */
typedef struct gprojx_beam_state {
    double axial; /* tension > 0; the mean along the beam */
    double torsion;
    double my[2], mz[2]; /* bending moments at both ends */
    double load[3];      /* force per length in local axes */
    double length;
} gprojx_beam_state;

static gprojx_beam_state gprojx_beam_state_of(const gprojx_frame *frame, int32_t b) {
    const gprojx_beam *beam = &frame->beam[b];
    double mode[GPROJX_MODES][12], d[GPROJX_MODES][GPROJX_MODES], e[GPROJX_MODES], s[6], moment;
    gprojx_beam_state state;
    int i, p;
    gprojx_beam_modes(beam, mode);
    gprojx_beam_elasticity(beam, d);
    for (p = 0; p < GPROJX_MODES; ++p)
        for (e[p] = 0, i = 0; i < 12; ++i) e[p] += mode[p][i] * frame->motion[gprojx_motion_of(beam, i)];
    for (p = 0; p < 6; ++p) s[p] = gprojx_frame_dot(GPROJX_MODES, d[p], e);
    for (p = 0; p < 3; ++p) state.load[p] = gprojx_frame_dot(3, beam->axis[p], beam->load);
    state.length = beam->length;
    state.axial = s[0], state.torsion = s[1];
    /* Moments on the ends are those of the modes less the nodal ones that stand for the load. */
    moment = state.load[2] * beam->length * beam->length / 12;
    state.my[0] = -s[2] - moment, state.my[1] = s[3] - moment;
    moment = state.load[1] * beam->length * beam->length / 12;
    state.mz[0] = -s[4] + moment, state.mz[1] = s[5] + moment;
    return state;
}

/* Axial force, My and Mz at the part `at` (0 to 1) of the length. */
static void gprojx_beam_forces_at(const gprojx_beam_state *s, double at, double out[3]) {
    double sag = s->length * s->length * at * (1 - at) / 2;
    out[0] = s->axial + s->load[0] * s->length * (0.5 - at);
    out[1] = (1 - at) * s->my[0] + at * s->my[1] + sag * s->load[2];
    out[2] = (1 - at) * s->mz[0] + at * s->mz[1] - sag * s->load[1];
}

/* Returns the part of the length at which the moment with these end values and the second derivative -load is extreme;
   0 or 1: at an end. */
static double gprojx_beam_extreme(const double end[2], double load, double length) {
    double at = 0.5 + (end[1] - end[0]) / (load * length * length);
    return at > 0 && at < 1 ? at : end[0] * end[0] < end[1] * end[1];
}

/* The largest bending moment along a beam (of the vector of both), and the largest |N|/A + M/W. For round sections
   M/W is that of the vector, for others the sum about both axes. Looks at 16ths of the length and at the extremes
   of My and Mz. */
static void gprojx_beam_largest(const gprojx_beam_state *state, const gprojx_section *section, double *bending,
                                double *stress) {
    double force[3], at;
    int i;
    *bending = *stress = 0;
    for (i = 0; i <= 18; ++i) {
        double moment, part;
        at = i < 17    ? i / 16.0
             : i == 17 ? gprojx_beam_extreme(state->my, state->load[2], state->length)
                       : gprojx_beam_extreme(state->mz, -state->load[1], state->length);
        gprojx_beam_forces_at(state, at, force);
        moment = hypot(force[1], force[2]);
        part = section->round ? moment / section->wy : fabs(force[1]) / section->wy + fabs(force[2]) / section->wz;
        *bending = fmax(*bending, moment);
        *stress = fmax(*stress, fabs(force[0]) / section->area + part);
    }
}

#endif
