/* planarize_compare.c - three ways to planar panels: Figure 10 of "Form-finding with Polyhedral Meshes Made Simple".

   A roof of warped quads becomes planar by (A) this library: normals are variables, all equations quadratic; (B) the
   same steps without normals, on the cubic equations det(v2 - v1, v3 - v1, v4 - v1) = 0; (C) local-global projection
   [Bouaziz et al. 2012]: each panel goes to the plane midway between its diagonals, then all vertices at once as near
   to the moved panels as they can, by a constant matrix. Writes planarize_compare.svg (a plot), _start.obj, .obj (A).

   Build and run:   cc -O2 planarize_compare.c -lm -o planarize_compare && ./planarize_compare
   Prints:          after each iteration delta, the largest distance of a panel's diagonals over the mean edge length
                    (1e-09 for less), and sigma, the largest deviation from the first roof over its diameter */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "../tools/plot.h" /* with math.h and stdio.h */

enum { SIDE = 20, POINTS = (SIDE + 1) * (SIDE + 1), QUADS = SIDE * SIDE, STEPS = 12 };

/* Corner k of quad f. */
static const int32_t from_first[4] = {0, SIDE + 1, SIDE + 2, 1};
static int32_t corner(int32_t f, int32_t k) { return f / SIDE * (SIDE + 1) + f % SIDE + from_first[k]; }

static gproj_mesh *make_roof(void) {
    static double position[3 * POINTS];
    static int32_t degree[QUADS], vertex[4 * QUADS], i;
    for (i = 0; i < POINTS; ++i) {
        double *p = position + 3 * i, x = p[0] = i / (SIDE + 1) - 0.5 * SIDE, y = p[1] = i % (SIDE + 1) - 0.5 * SIDE;
        p[2] = 2.2 * cos(0.32 * x) + 1.6 * cos(0.22 * y + 0.004 * x * x) + 0.03 * sin(x + 2 * y);
    }
    for (i = 0; i < 4 * QUADS; ++i) degree[i / 4] = 4, vertex[i] = corner(i / 4, i % 4);
    return gproj_mesh_create(POINTS, position, QUADS, degree, vertex, NULL, NULL);
}

/* (B): the row det + grad'(x - x_n) = 0 of each quad, at the present x_n. e: v2 - v1, v3 - v1, v4 - v1; g: grad. */
static void refresh_cubic(void *user, gproj_system *system, int32_t group, const gproj_progress *progress) {
    const double *x = gproj_system_values(system);
    int32_t f, i, k;
    for (f = 0, (void)user, (void)progress; f < QUADS; ++f) {
        double e[3][3], g[4][3], constant = 0;
        for (i = 0; i < 9; ++i) e[i / 3][i % 3] = x[3 * corner(f, i / 3 + 1) + i % 3] - x[3 * corner(f, 0) + i % 3];
        for (k = 0; k < 3; ++k) {
            for (i = 0; i < 3; ++i) /* at v2, v3, v4: the cross product of the other two of e */
                g[i + 1][k] = e[(i + 1) % 3][(k + 1) % 3] * e[(i + 2) % 3][(k + 2) % 3] -
                              e[(i + 1) % 3][(k + 2) % 3] * e[(i + 2) % 3][(k + 1) % 3];
            g[0][k] = -g[1][k] - g[2][k] - g[3][k], constant += e[0][k] * g[1][k];
            for (i = 0; i < 4; ++i) constant -= g[i][k] * x[3 * corner(f, i) + k];
        }
        gproj_system_set_row(system, group, f, g[0], constant);
    }
}

/* (A), (B): what the roof is like after 0, 1, 2, ... steps, guided by closeness in the first five. */
static void guided_projection(const gproj_mesh *roof, bool cubic, gproj_measures *measures) {
    gproj_group group = {"det", GPROJ_CONSTRAINT, false, GPROJ_PLACE_FACE, gproj_keep(1), refresh_cubic, NULL};
    int32_t steps, number, f, i;
    for (steps = 0; roof && steps <= STEPS; ++steps) {
        gproj_mesh *mesh = gproj_mesh_copy(roof, NULL, NULL);
        gproj_form *form = gproj_form_create(mesh, NULL);
        number = cubic ? gproj_system_add_group(gproj_form_system(form), &group) : gproj_add_planarity(form, 1);
        gproj_set_schedule(form, gproj_add_closeness(form, 1), (gproj_schedule){0.03, 0.3, 5});
        for (f = 0; cubic && f < QUADS; ++f) {
            gproj_term term[12];
            for (i = 0; i < 12; ++i) term[i].i = 3 * corner(f, i / 3) + i % 3, term[i].j = -1, term[i].a = 0;
            gproj_system_add_row(gproj_form_system(form), number, 12, term, 0, f);
        }
        if (steps > 0) gproj_solve(form, steps, NULL);
        if (!cubic) gproj_mesh_save(mesh, steps == 0 ? "planarize_compare_start.obj" : "planarize_compare.obj", NULL);
        measures[steps] = gproj_measure(mesh, roof->position, NULL);
        gproj_form_destroy(form), gproj_mesh_destroy(mesh);
    }
}

/* (C): quad f goes to its plane by d_f; the vertices move by dv, the least sum over all quads of |C_f dv - d_f|^2, and
   of 1e-6 |dv|^2; C_f takes away the mean of the corners. */
static void local_global(const gproj_mesh *roof, gproj_measures *measures) {
    static int64_t start[POINTS + 1];
    static int32_t row[POINTS + 16 * QUADS], v, f, k, entries, steps;
    static double value[POINTS + 16 * QUADS], move[3 * POINTS]; /* move: all x, all y, all z */
    gproj_cholesky *cholesky = gproj_cholesky_create(NULL);
    gproj_mesh *mesh = gproj_mesh_copy(roof, NULL, NULL);
    for (v = 0; v < POINTS; start[++v] = entries)
        for (row[entries] = v, value[entries++] = 1e-6, f = 0; f < 4 * QUADS; ++f)
            for (k = 0; k < 4 && corner(f / 4, f % 4) == v; ++k)
                if ((row[entries] = corner(f / 4, k)) >= v) value[entries++] = k == f % 4 ? 0.75 : -0.25;
    gproj_cholesky_analyse(cholesky, POINTS, start, row, NULL), gproj_cholesky_factor(cholesky, value);
    for (steps = 0; mesh && steps <= STEPS; ++steps) {
        measures[steps] = gproj_measure(mesh, roof->position, NULL);
        for (k = 0; k < 3 * POINTS; ++k) move[k] = 0;
        for (f = 0; f < QUADS; ++f) { /* the vectorial area n is across both diagonals, n'(b - a)/|n| their distance */
            double n[3], *a = mesh->position + 3 * corner(f, 0), *b = mesh->position + 3 * corner(f, 1), t = 0;
            gproj_mesh_face_area_vector(mesh, f, n);
            for (k = 0; k < 3; ++k) t += n[k] * (b[k] - a[k]) / 2 / (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (k = 0; k < 12; ++k) move[k % 3 * POINTS + corner(f, k / 3)] += (k / 3 % 2 ? -t : t) * n[k % 3];
        }
        gproj_cholesky_solve(cholesky, 3, move, move);
        for (k = 0; k < 3 * POINTS; ++k) mesh->position[k] += move[k % 3 * POINTS + k / 3];
    }
    gproj_cholesky_destroy(cholesky), gproj_mesh_destroy(mesh);
}

int main(void) {
    static double delta[3][STEPS + 1];
    const gprojx_curve curve[3] = {{"A: guided projection, normals as variables", "#c0392b", STEPS + 1, delta[0]},
                                   {"B: guided projection, cubic", "#d68910", STEPS + 1, delta[1]},
                                   {"C: local-global projection", "#2471a3", STEPS + 1, delta[2]}};
    static gproj_measures m[3][STEPS + 1];
    gproj_mesh *roof = make_roof();
    FILE *file = fopen("planarize_compare.svg", "w");
    int step, k;
    guided_projection(roof, false, m[0]), guided_projection(roof, true, m[1]), local_global(roof, m[2]);
    puts("    A: delta  sigma      B: delta  sigma      C: delta  sigma");
    for (step = 0; roof && step <= STEPS; ++step)
        for (k = 0; k < 3; ++k) {
            delta[k][step] = m[k][step].diagonal_max;
            if (k == 0) printf("%3d", step);
            printf("   %.1e %.4f%s", fmax(delta[k][step], 1e-9), m[k][step].deviation_max, k == 2 ? "\n" : "  ");
        }
    if (file) gprojx_plot(file, "Distance of the diagonals, in mean edge lengths", 3, curve), fclose(file);
    return gproj_mesh_destroy(roof), roof && file ? 0 : 1;
}
