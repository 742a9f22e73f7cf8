/* sparse_solver.c - the sparse Cholesky factorisation alone, without any mesh.

   Solves Poisson's equation -u_xx - u_yy = f on the unit square with u = 0 at its border, by the five-point
   differences on a grid of 100 x 100 inner points. The right-hand side belongs to u = sin(pi x) sin(2 pi y), so the
   error can be told. The pattern is analysed once; then a second matrix, -u_xx - u_yy + 100 u, is factored without a
   new analysis and without any allocation.

   Build and run:   cc -O2 sparse_solver.c -lm -o sparse_solver && ./sparse_solver
   Prints:          the size of the matrix and its factor, and the error of both solutions */
#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

#include <math.h>
#include <stdio.h>

enum {
    SIDE = 100,
    N = SIDE * SIDE
};
static const double PI = 3.14159265358979323846;

/* The lower triangle in compressed columns: in column (x, y) the point itself, its right and its upper neighbour. */
static int64_t start[N + 1];
static int32_t row[3 * N];
static double value[3 * N], right[N], solution[N];

static void make_matrix(double mass) {
    double h = 1.0 / (SIDE + 1);
    int64_t entries = 0;
    int32_t x, y, j = 0;
    for (y = 0; y < SIDE; ++y) {
        for (x = 0; x < SIDE; ++x, ++j) {
            start[j] = entries;
            row[entries] = j, value[entries++] = 4.0 / (h * h) + mass;
            if (x + 1 < SIDE) row[entries] = j + 1, value[entries++] = -1.0 / (h * h);
            if (y + 1 < SIDE) row[entries] = j + SIDE, value[entries++] = -1.0 / (h * h);
        }
    }
    start[N] = entries;
}

static double exact(int32_t j) {
    return sin(PI * (j % SIDE + 1) / (SIDE + 1)) * sin(2 * PI * (j / SIDE + 1) / (SIDE + 1));
}

/* Factors the matrix at hand, solves for the right-hand side of the exact solution, and tells the largest error. */
static int solve(gproj_cholesky *cholesky, double mass) {
    double error = 0;
    int32_t j;
    make_matrix(mass);
    for (j = 0; j < N; ++j) right[j] = (5 * PI * PI + mass) * exact(j);
    if (gproj_cholesky_factor(cholesky, value) != GPROJ_FACTORED) return 0;
    if (gproj_cholesky_solve(cholesky, 1, right, solution) != GPROJ_OK) return 0;
    for (j = 0; j < N; ++j) error = fmax(error, fabs(solution[j] - exact(j)));
    printf("-u_xx - u_yy + %3.0f u = f: largest error %.2e\n", mass, error);
    return 1;
}

int main(void) {
    gproj_cholesky *cholesky = gproj_cholesky_create(NULL);
    gproj_cholesky_info info;
    uint64_t allocations;
    int good;
    if (!cholesky) return 1;
    make_matrix(0);
    if (gproj_cholesky_analyse(cholesky, N, start, row, NULL) != GPROJ_OK) {
        printf("%s\n", gproj_cholesky_error(cholesky)->message);
        gproj_cholesky_destroy(cholesky);
        return 1;
    }
    info = gproj_cholesky_get_info(cholesky);
    printf("%d unknowns, %d entries in the matrix, %d in its factor\n", (int)info.columns, (int)start[N],
           (int)info.exact_entries);
    good = solve(cholesky, 0);
    allocations = gproj_cholesky_memory(cholesky).allocations;
    good = good && solve(cholesky, 100);
    printf("allocations after the first solution: %d\n",
           (int)(gproj_cholesky_memory(cholesky).allocations - allocations));
    gproj_cholesky_destroy(cholesky);
    return !good;
}
