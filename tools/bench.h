/* bench.h - what the parts of tools/bench share: meshes and rows as plain arrays, our solver and CHOLMOD behind a few
   functions each.

   bench_ours.c is compiled three times and knows the library's insides; bench_cholmod.c knows CHOLMOD and OpenBLAS;
   bench.c knows neither. */
#ifndef BENCH_H
#define BENCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Polygons: what gproj_mesh_create takes. */
typedef struct bench_mesh {
    int32_t vertex_count, face_count;
    double *position;
    int32_t *degree, *corner;
} bench_mesh;

/* What is asked of a mesh, besides planarity. */
typedef enum bench_task {
    BENCH_PLANARITY,
    BENCH_STATICS,  /* equilibrium with the boundary fixed and supporting */
    BENCH_FAIRNESS, /* fairness that stays on */
    BENCH_VOLUME,   /* one global row */
    BENCH_DEFAULT   /* planarity by a default solve: smooth, with damping and safeguards */
} bench_task;

/* The phases of an iteration, of any solver. */
enum {
    BENCH_REFRESH,
    BENCH_ASSEMBLE,
    BENCH_FACTOR,
    BENCH_SOLVE,
    BENCH_PHASES
};

/* The regularisation in every step: the systems are sum w^2 g g' + eps^2 D. */
#define BENCH_EPSILON 1e-3

/* Rows phi + g'dx = 0 of weight w, linearised: row r has the gradients gradient[start[r]..start[r+1]-1] by the variables
   `variable`, ascending. */
typedef struct bench_rows {
    int32_t variables, rows;
    double *regularisation; /* of each variable, what is added to the diagonal */
    int64_t *start;
    int32_t *variable;
    double *gradient, *phi, *weight2;
} bench_rows;

/* What one solver says of a system. */
typedef struct bench_facts {
    int32_t vertices, unknowns;
    double entries;       /* of L, without padding */
    double flops;         /* of one factorisation: the sum of squared column counts */
    double part_seconds;  /* of set-up: ours, making a form and its rows; CHOLMOD's, pattern and places */
    double setup_seconds; /* all that comes before the first iteration, but for the mesh; CHOLMOD's without the rows */
    double rows_bytes;    /* the rows alone: ours as quadratic equations, CHOLMOD's linearised */
    double peak_bytes;    /* ours with rows, CHOLMOD's without */
} bench_facts;

/* After an iteration of ours: its times, and the step that it took. */
typedef struct bench_step {
    int32_t number, variables;
    double seconds[BENCH_PHASES];
    const double *dx;
    double largest; /* |dx| */
    bool guided;    /* default: the smooth metric acted */
    bool once;      /* one factorisation */
} bench_step;

/* False: that was enough. */
typedef bool (*bench_visit)(void *user, const bench_step *step);

typedef struct bench_form bench_form;

/* One build of our solver. `create` makes a mesh, a form and its rows; `solve` goes back to where it began and takes
   steps, or none, which is set-up only; `factor`, after a solve with steps, factors the last one's matrix once more,
   without right-hand sides, and returns the seconds, infinite where it fails; `rows`, in a visit: the rows from which
   the next step will come (the arrays are made at the first call). `load` reads a mesh from a file. Times are
   processor times; with `workers` >= 1, that many threads, they are wall times. */
typedef struct bench_solver {
    bool (*load)(const char *path, bench_mesh *mesh);
    bench_form *(*create)(const bench_mesh *mesh, bench_task task, int32_t workers);
    void (*destroy)(bench_form *form);
    bool (*solve)(bench_form *form, int32_t iterations, bench_visit visit, void *user);
    double (*factor)(bench_form *form);
    void (*rows)(bench_form *form, bench_rows *rows);
    bench_facts (*facts)(const bench_form *form);
} bench_solver;

extern const bench_solver bench_simd, bench_cblas, bench_scalar;

typedef struct bench_cholmod bench_cholmod;

/* Pattern and analysis; NULL where there is no memory. */
bench_cholmod *bench_cholmod_create(const bench_rows *rows);
void bench_cholmod_destroy(bench_cholmod *c);
/* One step: assembly, factorisation, solution. dx: rows->variables numbers. */
bool bench_cholmod_step(bench_cholmod *c, const bench_rows *rows, double seconds[BENCH_PHASES], double *dx);
/* Iterative refinement of a solution, one round with longer residuals: what dx should have been. */
bool bench_cholmod_refine(bench_cholmod *c, const bench_rows *rows, double *dx);
bench_facts bench_cholmod_facts(const bench_cholmod *c);

/* dgemm's best rate over several sizes, in flops a second. */
double bench_dgemm_peak(void);

/* What runs here. */
typedef struct bench_machine {
    char processor[128], compiler[64], cholmod[32], openblas[128], kernels[32];
    double peak; /* bench_dgemm_peak */
} bench_machine;
bench_machine bench_this_machine(void);

static inline double bench_clock(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Processor time of all threads, which other programs on the same core leave alone; and what a clock on the wall says, for
   several threads. */
static inline double bench_now(void) { return bench_clock(CLOCK_PROCESS_CPUTIME_ID); }
static inline double bench_wall(void) { return bench_clock(CLOCK_MONOTONIC); }

/* Memory, or the end. */
static inline void *bench_take(size_t count, size_t size) {
    void *block = calloc(count ? count : 1, size);
    if (block) return block;
    fputs("bench: out of memory\n", stderr);
    exit(2);
}

static inline void bench_mesh_free(bench_mesh *mesh) {
    free(mesh->position);
    free(mesh->degree);
    free(mesh->corner);
    memset(mesh, 0, sizeof *mesh);
}

static inline void bench_rows_free(bench_rows *rows) {
    free(rows->start);
    free(rows->regularisation);
    free(rows->variable);
    free(rows->gradient);
    free(rows->phi);
    free(rows->weight2);
    memset(rows, 0, sizeof *rows);
}

#endif
