/* guidedproj.h - v0.1 - form-finding with polygon meshes by guided projection
   Single-header C99 (and C++11) library; no dependencies but libc and libm. MIT licence or public domain, see LICENSE.

   WHAT IT DOES
     Take a polygon mesh and say what must hold (flat or circular panels, conical nodes, static equilibrium, compression
     only, bounds on forces, lengths and areas, boundaries on curves, fixed vertices, a volume, constraints of your own)
     and what is wished (fairness, closeness). In about ten Newton-like steps the mesh satisfies all of it together to
     machine precision, and you get an honest verdict: what holds, how exactly, and where it does not.
     Its parts can be used alone: half-edge meshes with OBJ and OFF, subdivision, changes of their combinatorics, closed
     curves filled with quads, closest points, a sparse Cholesky factorisation, least squares with bounds, and
     projection onto any system of quadratic equations and inequalities.

   WHAT IT DOES NOT DO
     - draw, or remesh by itself: solving moves vertices and keeps the combinatorics as they are (to change them see
       also >>api-edit, >>api-subdivide and >>api-fill);
     - find global minima: wishes guide the way to a mesh that satisfies the constraints; on demand it is the nearest
       one or the one that serves the wishes best (gproj_solve_options.nearest), but among its neighbours only;
     - invent freedom: constraints that contradict each other end with a verdict that says so, not with a mesh;
     - treat meshes that are no orientable manifolds: they are refused with a sentence that names the place.

   A FIRST PROGRAM (put this into one C or C++ file of your program, and plain #includes into the others)

     #define GUIDEDPROJ_IMPLEMENTATION
     #include "guidedproj.h"
     #include <stdio.h>

     int main(void) {
         gproj_mesh *mesh = gproj_mesh_load("roof.obj", NULL, NULL);
         gproj_form *form = gproj_form_create(mesh, NULL);
         gproj_result result;
         gproj_add_planarity(form, 1.0);      // each returns the number of its group;
         gproj_add_fixed_boundary(form, 1.0); // after an error they do nothing:
         gproj_add_fairness(form, 0.2);       // one check, at the solve, is enough
         result = gproj_solve(form, 20, NULL);
         printf("%s\n", result.message);
         if (result.outcome != GPROJ_FAILED) gproj_mesh_save(mesh, "flat_panels.obj", NULL);
         gproj_form_destroy(form);
         gproj_mesh_destroy(mesh);
         return result.outcome == GPROJ_CONVERGED ? 0 : 1;
     }

   A CONSTRAINT OF YOUR OWN is rows of terms a x_i x_j and b x_i with a constant: "vertex v has height h" is as follows;
   with GPROJ_BOUND the row must be >= 0, so it says "at least h" (for "at most", change the signs of all terms and of
   the constant)

     double centre[3], scale;
     gproj_group group = {"height", GPROJ_CONSTRAINT, false, GPROJ_PLACE_VERTEX, {1, 0, 0}, NULL, NULL};
     gproj_system *system = gproj_form_system(form);
     int32_t number = gproj_system_add_group(system, &group);
     gproj_term z = {3 * v + 2, -1, 1.0};             // 1.0 * z of vertex v, in the form's units:
     gproj_form_units(form, centre, &scale);          // internal = (position - centre) * scale
     gproj_system_add_row(system, number, 1, &z, -(h - centre[2]) * scale, v);

   WORDS   A wish is what guides: fairness, closeness. Wishes fade after half of the iterations, so that what must hold
     can hold exactly: constraints, which are equations, and bounds, which are inequalities. A group is a set of rows of
     one kind with a common weight. Residuals of a form are in mean edge lengths.

   CONTENTS (search for the tag)
     the interface
       >>api-host       memory, threads, clock
       >>api-error      codes, places, sentences
       >>api-number     numbers as text, whatever the locale
       >>api-cholesky   sparse Cholesky factorisation, usable by itself
       >>api-least-squares  linear least squares with bounds, usable by itself
       >>api-system     quadratic equations and guided projection, without meshes
       >>api-mesh       half-edge meshes, OBJ and OFF
       >>api-edit       changes of a mesh's combinatorics
       >>api-subdivide  subdivision, and how fine meshes follow their cages
       >>api-reference  curves and surfaces with closest points
       >>api-measure    planarity, deviation, folds, statistics
       >>api-offset     parallel meshes at constant distance, supports
       >>api-fill       meshes of quads from closed curves
       >>api-form       form-finding: a mesh, what must hold, what is wished
       >>api-statics    forces in the edges of a form
     the implementation: each section uses only earlier ones
       >>platform       compiler differences
       >>number         decimal text to binary and back
       >>memory         allocation with accounts
       >>error          one door for all failures
       >>parallel       the host's threads
       >>vector         3-vectors
       >>kernels        tiles in registers, for each kind of vector unit
       >>dense          panels and update matrices
       >>ordering       condensation, minimum degree
       >>dissection     nested dissection
       >>symbolic       elimination tree, column counts, supernodes
       >>cholesky       multifrontal factorisation, solves
       >>least-squares  linear least squares with bounds
       >>system         rows, groups, the matrix of the normal equations
       >>loop           steps, damping, verdict
       >>mesh           half-edges from polygons
       >>text           OBJ and OFF
       >>subdivide      subdivision by stencils
       >>hierarchy      bounding boxes
       >>curve          polylines
       >>surface        reference surfaces
       >>edit           changes of the combinatorics
       >>measure        what a mesh is like
       >>offset         parallel meshes and what is between them
       >>fill           closed curves filled with quads
       >>form           a mesh and its system
       >>catalogue      the constraints and wishes
       >>statics        equilibrium, bounds on forces, their start
       >>guard          faces must not turn over
       >>solve          solving a form

   SWITCHES (define before the #include)
     GUIDEDPROJ_IMPLEMENTATION  in exactly one file: also compile the implementation
     GPROJ_STATIC               all functions are static, with the implementation, wherever it is defined
     GPROJ_NO_STDIO             no functions that open files, no <stdio.h>
     GPROJ_NO_SIMD              plain scalar kernels, no vector extensions of the compiler; without it, on x86-64 with
                                gcc and clang, the processor is asked for AVX2 and AVX-512 (not with gcc for Windows:
                                there, as for other processors, the compiler's options decide, such as -mavx2 -mfma)
     GPROJ_USE_CBLAS            dense kernels by a CBLAS (link one, such as OpenBLAS)
     GPROJ_ASSERT(condition)    your own assert, for the library's internal invariants

   MEMORY   Each object takes its memory from the allocator of its gproj_host, counts it, and gives it all back when it
     is destroyed. There are no globals. Iterations after the first allocate nothing. Every allocation may fail: the
     call returns an error and nothing leaks.

   THREADS  The library starts none. Give a parallel-for in gproj_host to share the work. Different objects may be used
     by different threads at the same time; one object by one thread at a time. Reading an object that no one changes is
     always safe.

   DETERMINISM  The same input gives the same bytes on the same processor and build: on any number of threads, in any
     run. Other compilers, processors with other vector units (the same program chooses its kernels by them, see
     gproj_cholesky_info) and GPROJ_USE_CBLAS may differ in the last digits. GPROJ_NO_SIMD leaves only the compiler.

   ERRORS   See >>api-error: code, place, sentence. Objects that are built up keep their first error, so one check is
     enough. Misuse that only a programmer can cause is reported like everything else.

   REFERENCES
     Tang, Sun, Gomes, Wallner, Pottmann: Form-finding with Polyhedral Meshes Made Simple. ACM Trans. Graph. 33(4),
     2014. Others stand in the sections that are based on them. */
#ifndef GUIDEDPROJ_H
#define GUIDEDPROJ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define GPROJ_VERSION "0.1"

/* Every public function is declared with GPROJ_API. In static mode (GPROJ_STATIC, defined before an inclusion) the
   translation unit has its own private copy of the implementation and exports nothing. */
#if defined(GPROJ_STATIC) && !defined(GUIDEDPROJ_IMPLEMENTATION)
#define GUIDEDPROJ_IMPLEMENTATION
#endif
#if defined(GPROJ_STATIC) && (defined(__GNUC__) || defined(__clang__) || defined(__TINYC__))
#define GPROJ_API __attribute__((unused)) static
#elif defined(GPROJ_STATIC)
#define GPROJ_API static
#else
#define GPROJ_API extern
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------------------
   >>api-host   What the library asks of the program around it: memory, threads, a clock.

   A gproj_host is given when an object is created and copied into it. NULL or {0} means: malloc, one thread,
   no clock. Nothing is ever process-wide; two objects may have two hosts. */

/* Memory. A NULL `allocate` means malloc/realloc/free. All three get `user` and the sizes in bytes; memory must
   be aligned for any type. `reallocate` and `release` may be NULL when `allocate` is not: the library then
   copies, or never gives back (an arena). `limit` > 0: an object that would hold more than `limit` bytes fails
   with GPROJ_ERROR_MEMORY instead. */
typedef struct gproj_allocator {
    void *(*allocate)(void *user, size_t size);
    void *(*reallocate)(void *user, void *block, size_t old_size, size_t new_size);
    void (*release)(void *user, void *block, size_t size);
    void *user;
    size_t limit;
} gproj_allocator;

/* Threads. `run` calls task(data, index) once for each index in 0..count-1, in any order, on any threads, and
   returns when all calls have returned. NULL: a plain loop. How work is cut into tasks depends on the problem
   alone, and so do the results, bit for bit: neither the number of threads nor their speed matters. */
typedef void (*gproj_task)(void *data, int32_t index);
typedef struct gproj_parallel {
    void (*run)(void *user, int32_t count, gproj_task task, void *data);
    void *user;
} gproj_parallel;

/* A monotonic clock in seconds, for time budgets and for the seconds in reports. NULL: time is not measured
   (all seconds are 0) and a time budget is an error. */
typedef struct gproj_clock {
    double (*now)(void *user);
    void *user;
} gproj_clock;

typedef struct gproj_host {
    gproj_allocator allocator;
    gproj_parallel parallel;
    gproj_clock clock;
} gproj_host;

/* What an object holds, in bytes, and how many allocations and reallocations it has asked for so far. */
typedef struct gproj_memory {
    size_t used;
    size_t peak;
    uint64_t allocations;
} gproj_memory;

/* ------------------------------------------------------------------------------------------------------------
   >>api-error   Failures: a code, a place in your terms, a sentence.

   Functions that create an object take a `gproj_error *` (may be NULL) and return NULL on failure. Objects that
   are built up by many calls (gproj_system, gproj_form) keep their first error: later calls do nothing and
   return -1, so one check at the end is enough. "Not converged" and "not positive definite" are outcomes, not
   errors. */
#define GPROJ_CODES(X)                                              \
    X(OK, "no error")                                               \
    X(ERROR_MEMORY, "out of memory")                                \
    X(ERROR_ARGUMENT, "an argument is out of its range")            \
    X(ERROR_FILE, "a file could not be read or written")            \
    X(ERROR_SYNTAX, "a text is not what its format says")           \
    X(ERROR_NUMBER, "a number is infinite or not a number")         \
    X(ERROR_INDEX, "an index is out of its range")                  \
    X(ERROR_DEGENERATE, "an element is repeated or has no extent")  \
    X(ERROR_NON_MANIFOLD, "a mesh is not a manifold")               \
    X(ERROR_NON_ORIENTABLE, "a mesh has no consistent orientation") \
    X(ERROR_SIZE, "a count is too large")                           \
    X(ERROR_STATE, "a call came before the one it depends on")

typedef enum gproj_code {
#define GPROJ_X(name, sentence) GPROJ_##name,
    GPROJ_CODES(GPROJ_X)
#undef GPROJ_X
    GPROJ_CODE_FORCE_INT = 0x7fffffff
} gproj_code;

/* What the index of an error, of a row or of a group's worst row counts. */
typedef enum gproj_place {
    GPROJ_PLACE_NONE,
    GPROJ_PLACE_VERTEX,
    GPROJ_PLACE_EDGE,
    GPROJ_PLACE_FACE,
    GPROJ_PLACE_LINE, /* of a text, from 1 */
    GPROJ_PLACE_VARIABLE,
    GPROJ_PLACE_GROUP,
    GPROJ_PLACE_ROW,
    GPROJ_PLACE_COLUMN,
    GPROJ_PLACE_FORCE_INT = 0x7fffffff
} gproj_place;

enum {
    GPROJ_MESSAGE_SIZE = 512
};

typedef struct gproj_error {
    gproj_code code;
    gproj_place place;
    int64_t index;                    /* from 0 (lines: from 1); -1 where there is none */
    char message[GPROJ_MESSAGE_SIZE]; /* one sentence, UTF-8, without a newline; "" for GPROJ_OK */
} gproj_error;

/* The general sentence of a code ("out of memory"), a constant string. */
GPROJ_API const char *gproj_code_string(gproj_code code);

/* ------------------------------------------------------------------------------------------------------------
   >>api-number   Numbers as text, whatever the locale. */

enum {
    GPROJ_NUMBER_SIZE = 32
};

/* Reads a decimal number ([+-]digits[.digits][e[+-]digits], also "inf" and "nan" in any case, so that readers
   can refuse them by name) from text[0..size-1], correctly rounded. Returns the number of characters used, 0
   where there is no number. Numbers too large become infinite. */
GPROJ_API size_t gproj_number_read(const char *text, size_t size, double *value);

/* Writes the shortest decimal text that reads back to the same bits, with a final NUL; returns its length. */
GPROJ_API size_t gproj_number_write(double value, char text[GPROJ_NUMBER_SIZE]);

/* ------------------------------------------------------------------------------------------------------------
   >>api-cholesky   Sparse Cholesky factorisation P A P' = L L' of symmetric positive definite matrices.

   Usable by itself. Analyse a pattern once, then factor any number of matrices that have this pattern; neither
   the second and later gproj_cholesky_factor nor gproj_cholesky_solve allocates. One object is used by one
   thread at a time. */
typedef struct gproj_cholesky gproj_cholesky;

typedef enum gproj_ordering {
    GPROJ_ORDERING_BEST,       /* the better of the next two, if dissection is likely to pay in four factorisations */
    GPROJ_ORDERING_AMD,        /* approximate minimum degree */
    GPROJ_ORDERING_DISSECTION, /* light nodes first, then nested dissection by the smallest separators near the middle */
    GPROJ_ORDERING_GIVEN,      /* `permutation` of the options */
    GPROJ_ORDERING_NATURAL,    /* as the matrix stands */
    GPROJ_ORDERING_FORCE_INT = 0x7fffffff
} gproj_ordering;

typedef struct gproj_cholesky_options {
    gproj_ordering ordering;
    const int32_t *permutation; /* n entries: permutation[k] = column of A that becomes column k of L */
    bool disable_relaxation;    /* keep fundamental supernodes: less fill, slower */
    bool disable_postorder;     /* keep the given order exactly; supernodes become small */
} gproj_cholesky_options;

/* What an analysis predicts and a factorisation has done. */
typedef struct gproj_cholesky_info {
    int32_t columns;        /* n */
    int32_t supernodes;     /* after relaxation */
    int64_t factor_entries; /* entries of L, lower triangle with diagonal, zeros of relaxed supernodes included */
    int64_t exact_entries;  /* the same without relaxation */
    double flops;           /* of one factorisation: sum of (column count)^2 over the columns of exact L */
    size_t factor_bytes;    /* memory for the values of L */
    size_t work_bytes;      /* memory for the work arrays of factor and solve */
    int32_t failed_column;  /* of A, where the last factorisation met a pivot that is not > 0; else -1 */
    const char *kernels;    /* the vector units that are used: "AVX-512", "AVX2", "vectors of two", "scalar" */
} gproj_cholesky_info;

typedef enum gproj_factor_outcome {
    GPROJ_FACTORED,
    GPROJ_NOT_POSITIVE_DEFINITE, /* see failed_column; there is no factor to solve with */
    GPROJ_FACTOR_FAILED,         /* an error: see gproj_cholesky_error */
    GPROJ_FACTOR_OUTCOME_FORCE_INT = 0x7fffffff
} gproj_factor_outcome;

/* `host` may be NULL. NULL only when there is no memory. */
GPROJ_API gproj_cholesky *gproj_cholesky_create(const gproj_host *host);
GPROJ_API void gproj_cholesky_destroy(gproj_cholesky *cholesky);
GPROJ_API const gproj_error *gproj_cholesky_error(const gproj_cholesky *cholesky);
GPROJ_API gproj_memory gproj_cholesky_memory(const gproj_cholesky *cholesky);

/* Analyses the pattern of an n x n symmetric matrix in compressed columns: rows row[start[j]..start[j+1]-1] in
   column j (start: n+1 entries, start[0] = 0), in any order. Each entry off the diagonal stands once, in the
   lower or in the upper triangle (all in one of the two, or mixed); diagonal entries may be left out (then 0).
   Repeated entries are summed. `options` may be NULL. The arrays are not needed after the call. */
GPROJ_API gproj_code gproj_cholesky_analyse(gproj_cholesky *cholesky, int32_t n, const int64_t *start,
                                            const int32_t *row, const gproj_cholesky_options *options);

/* Factors the matrix with these values, in the order of `row` at the analysis. */
GPROJ_API gproj_factor_outcome gproj_cholesky_factor(gproj_cholesky *cholesky, const double *values);

/* Solves A X = B for `count` right-hand sides, each of n contiguous numbers. x may be b. */
GPROJ_API gproj_code gproj_cholesky_solve(gproj_cholesky *cholesky, int32_t count, const double *b, double *x);

/* Iterative refinement: improves x by `steps` rounds of x += A^-1 (b - A x), one right-hand side. A is given by
   the arrays of the analysis and the values of the factorisation. Returns the largest |b - A x| at the end. */
GPROJ_API double gproj_cholesky_refine(gproj_cholesky *cholesky, const int64_t *start, const int32_t *row,
                                       const double *values, const double *b, double *x, int32_t steps);

GPROJ_API gproj_cholesky_info gproj_cholesky_get_info(const gproj_cholesky *cholesky);

/* The permutation in use (n entries, owned by the object): see gproj_cholesky_options.permutation. */
GPROJ_API const int32_t *gproj_cholesky_permutation(const gproj_cholesky *cholesky);

/* ------------------------------------------------------------------------------------------------------------
   >>api-least-squares   Sparse linear least squares with bounds, usable by itself.

       minimise  1/2 |A x - b|^2 + 1/2 damping^2 |x|^2   subject to  lower <= x <= upper

   For example the forces of a mesh that stands by compression alone: one variable x_e >= 0 for each edge, three rows
   for each vertex without support. A may have dependent columns; where the solution is then not unique, one that is
   in the middle of the possible ones, or near the start, is found. */
typedef struct gproj_least_squares {
    int32_t rows, columns;
    const int64_t *start; /* columns + 1: column j has the entries start[j]..start[j+1]-1; start[0] = 0 */
    const int32_t *row;   /* of each entry, in any order; entries of the same place are summed */
    const double *value;  /* of each entry; |value| <= 1e50 */
    const double *b;      /* rows; |b| <= 1e50 */
    const double *lower;  /* columns; NULL: none. -inf, or less than -1e50: no bound for this variable */
    const double *upper;  /* columns; NULL: none. lower = upper fixes a variable */
    double damping;       /* >= 0, in the units of the entries of A; makes the solution unique */
} gproj_least_squares;

typedef enum gproj_least_squares_outcome {
    GPROJ_LEAST_SQUARES_SOLVED, /* kkt is at the level of rounding, at any rate below 1e-9 */
    GPROJ_LEAST_SQUARES_LIMIT,  /* factorisations or digits ran out; x is the best point met, see kkt */
    GPROJ_LEAST_SQUARES_FAILED, /* an error; x is unchanged */
    GPROJ_LEAST_SQUARES_OUTCOME_FORCE_INT = 0x7fffffff
} gproj_least_squares_outcome;

typedef struct gproj_least_squares_result {
    gproj_least_squares_outcome outcome;
    int32_t factorisations;
    int32_t at_bounds; /* variables that are equal to a bound */
    double residual;   /* |A x - b|, Euclidean */
    /* Optimality (Karush, Kuhn, Tucker): x is within its bounds, exactly, and the gradient g = A'(A x - b) + damping^2 x
       is 0 where x is between its bounds, >= 0 at a lower and <= 0 at an upper bound. This is the largest violation,
       divided by the largest entry of |A|'(|b| + |A||y|) + damping^2 |y|, where y is the point within the bounds that
       is nearest to 0. */
    double kkt;
    gproj_memory memory; /* without that of the factorisation: see factor_bytes, work_bytes */
    size_t factor_bytes; /* see gproj_cholesky_info */
    size_t work_bytes;
} gproj_least_squares_result;

/* Solves the problem. x, `columns` numbers: where to start; at the end the solution. A start of zeros is good. A start
   that is nearly right, and equal to the bounds it should be at, makes it faster; one with kkt > 1 is replaced by
   zeros. `host`, `result` and `error` may be NULL. The work are factorisations of a matrix with the pattern of A'A, so
   a row of A must not have very many entries. Usual are 5 to 20; up to 30 where most bounds matter and the residual
   stays large; there are never more than 80. Where A has dependent columns and damping is 0, nothing is added to the
   problem: 1e-12 of the diagonal of A'A stands in the matrix of each step, but not in the conditions that the solution
   satisfies. Returns GPROJ_OK also for GPROJ_LEAST_SQUARES_LIMIT. Errors: GPROJ_ERROR_ARGUMENT, _INDEX, _NUMBER, _SIZE
   for what is wrong with the problem, GPROJ_ERROR_MEMORY. */
GPROJ_API gproj_code gproj_solve_least_squares(const gproj_least_squares *problem, const gproj_host *host, double *x,
                                               gproj_least_squares_result *result, gproj_error *error);

/* ------------------------------------------------------------------------------------------------------------
   >>api-system   Systems of quadratic equations and their guided projection.

   Variables x, and rows
       phi(x) = sum_t a_t x_i(t) x_j(t) + sum_t b_t x_i(t) + c                                  (paper, eq. 1)
   in groups. A group of kind GPROJ_CONSTRAINT must hold: phi = 0. A group of kind GPROJ_BOUND must hold, too, but
   phi >= 0 is enough. A group of kind GPROJ_WISH guides: the sum of its phi^2 should be small, and it fades so that
   the constraints can be met exactly. A group's weight multiplies its rows, so it enters squared. One step from x
   solves                                                                                       (paper, eq. 3)
       (sum w^2 g g' + eps^2 I) dx = - sum w^2 phi(x) g,    g = grad phi(x),
   over all rows; it is Newton's method on the constraints, led by the wishes. Nothing here knows of meshes.

   The row of a bound counts by its violation, min(phi, 0), in residual and merit. It has a part in the sums where it is
   violated; and where a step would violate it, the step is found again with it, and without rows that would only hold
   the step back (phi + g'dx > 0), at most 3 times. So bounds cost further factorisations in some
   iterations, and nothing where they are far from being reached. */
typedef struct gproj_system gproj_system;

typedef enum gproj_kind {
    GPROJ_CONSTRAINT, /* phi = 0 must hold */
    GPROJ_WISH,       /* phi = 0 is wished */
    GPROJ_BOUND,      /* phi >= 0 must hold */
    GPROJ_KIND_FORCE_INT = 0x7fffffff
} gproj_kind;

/* The weight in iteration n = 1, 2, ...: weight * decay^n for n <= last, then 0. A decay of 0 means 1 (no decay). A
   last of 0 means for ever; but a form's wishes (gproj_solve) then end after half of the iterations. So {w} is the
   constant weight w. Needs 0 <= weight <= 1e50, 0 <= decay <= 1,
   last >= 0. */
typedef struct gproj_schedule {
    double weight;
    double decay;
    int32_t last;
} gproj_schedule;

/* One term of a row: a x_i x_j, or a x_i where j is -1. i = j gives a x_i^2. */
typedef struct gproj_term {
    int32_t i, j;
    double a;
} gproj_term;

/* Called before each iteration for groups whose rows depend on x in another way than quadratic (closest points, tangent
   frames): reads x, and replaces its rows by gproj_system_set_row. Must not add anything to the system. */
typedef void (*gproj_refresh)(void *user, gproj_system *system, int32_t group);

enum {
    GPROJ_NAME_SIZE = 32 /* of a group's name, with the final NUL */
};

typedef struct gproj_group {
    const char *name; /* for reports, e.g. "planarity"; copied, cut to GPROJ_NAME_SIZE */
    gproj_kind kind;
    /* Few rows with many variables each (a volume): kept out of the sparse matrix and handled by a low-rank update,
       which costs half a solve more per row. */
    bool global;
    gproj_place place; /* what the element numbers of its rows count */
    gproj_schedule schedule;
    gproj_refresh refresh; /* NULL: the rows are as they were added */
    void *refresh_user;
} gproj_group;

/* The state of a group at the current x, in the units of its rows, without weights. phi stands for min(phi, 0) in a
   bound: how far it is violated. */
typedef struct gproj_group_info {
    char name[GPROJ_NAME_SIZE];
    gproj_kind kind;
    gproj_place place;
    gproj_schedule schedule;
    int32_t rows;
    double max;            /* largest |phi| */
    double rms;            /* root of the mean of phi^2 */
    int32_t worst_row;     /* where the largest is; -1 without rows */
    int32_t worst_element; /* the element number of that row */
} gproj_group_info;

typedef enum gproj_phase {
    GPROJ_PHASE_ANALYSE,  /* pattern, ordering, symbolic factorisation: once */
    GPROJ_PHASE_REFRESH,  /* refresh callbacks, evaluation of rows */
    GPROJ_PHASE_ASSEMBLE, /* right-hand sides */
    GPROJ_PHASE_FACTOR,   /* the matrix, front by front, its factor, and half of the solution */
    GPROJ_PHASE_SOLVE,
    GPROJ_PHASE_COUNT,
    GPROJ_PHASE_FORCE_INT = 0x7fffffff
} gproj_phase;

#define GPROJ_OUTCOMES(X)                                                                        \
    X(CONVERGED, "all constraints hold to the tolerance")                                        \
    X(ITERATION_LIMIT, "the iterations ran out before all constraints held")                     \
    X(STALLED, "no step makes the constraints hold better: they conflict, or this is a minimum") \
    X(CANCELLED, "cancelled by the caller")                                                      \
    X(TIME_OUT, "the time budget ran out")                                                       \
    X(FAILED, "not started or broken off by an error")

typedef enum gproj_outcome {
#define GPROJ_X(name, sentence) GPROJ_##name,
    GPROJ_OUTCOMES(GPROJ_X)
#undef GPROJ_X
    GPROJ_OUTCOME_FORCE_INT = 0x7fffffff
} gproj_outcome;

/* What one iteration did; given to the callback after it. */
typedef struct gproj_iteration {
    int32_t number;    /* from 1 */
    double residual;   /* largest |phi| of all rows that must hold with weight > 0, after the step */
    double merit;      /* sum of w^2 phi^2 over what must hold and wishes, after the step */
    double energy;     /* the wishes' part of it */
    double step;       /* largest |dx| */
    double epsilon;    /* the regularisation used */
    double length;     /* the part of the step that was taken: 1, or another where the merit asked for it */
    int32_t attempts;  /* factorisations: 1, or more where the step was damped, guarded or met bounds */
    double optimality; /* nearest: see gproj_result */
    double seconds[GPROJ_PHASE_COUNT]; /* of this iteration */
} gproj_iteration;

/* Called after each iteration; groups may be read (gproj_system_group_info) and weights changed. Return false to
   stop with GPROJ_CANCELLED; x then stays as it is after this iteration. */
typedef bool (*gproj_on_iteration)(void *user, gproj_system *system, const gproj_iteration *iteration);

typedef struct gproj_solve_options {
    /* The constraints hold when every |phi| <= tolerance; 0 means 1e-13, or what rounding allows where that is more: 8
       roundings of the largest |x|, and in a global row sum_t a_t x_t 16 of sum_t |a_t x_t|. */
    double tolerance;
    double epsilon;     /* > 0: this regularisation in every step; 0: it follows the residual (1e-5 .. 1e-3,
                           less where steps fall short near the end) */
    double time_budget; /* seconds by the host's clock; 0 means none */
    gproj_on_iteration on_iteration; /* may be NULL */
    void *user;
    bool skip_damping;   /* take every full step, whatever it does (the paper's plain iteration) */
    bool skip_closeness; /* gproj_solve only: no default guidance where no wish guides */
    bool skip_guard;     /* gproj_solve only: do not keep planar faces from turning over */
    /* End at the point nearest to the wishes: a minimum of sum w^2 phi^2 over the wishes among all x where holds what
       must hold (a local minimum, as found from here). Wishes keep the weights of their schedules to the end: decay and
       last do not apply, only the weights' ratios matter, and nothing is biased. gproj_solve adds closeness to where it
       begins where nothing is wished: it ends at the mesh nearest to that. Wants about 30 iterations. Converged means
       here that the constraints hold and gproj_result.optimality <= 1e-6, at a minimum. */
    bool nearest;
} gproj_solve_options;

typedef struct gproj_result {
    gproj_outcome outcome;
    int32_t iterations; /* steps taken */
    int32_t damped;     /* of these, steps that were damped, shortened, guarded or met bounds */
    double residual;    /* largest |phi| of all rows that must hold with weight > 0 */
    double tolerance;   /* what it was compared with */
    double step;        /* largest |dx| of the last step */
    /* nearest: norm of the gradient of the wishes' sum w^2 phi^2, projected to the tangent space of what must hold, over
       the norm without projection: 0 at a minimum, 1 where nothing has been gained. Else 0. */
    double optimality;
    int32_t worst_group; /* where that residual is; -1 where nothing must hold */
    int32_t worst_element;
    double seconds[GPROJ_PHASE_COUNT];
    char message[GPROJ_MESSAGE_SIZE]; /* the verdict in a sentence, with the worst row by name; of a form also what else
                                         has happened: edges that collapsed, a mesh that shrank */
} gproj_result;

GPROJ_API gproj_system *gproj_system_create(const gproj_host *host);
GPROJ_API void gproj_system_destroy(gproj_system *system);
GPROJ_API const gproj_error *gproj_system_error(const gproj_system *system);
GPROJ_API gproj_memory gproj_system_memory(const gproj_system *system);

/* Appends count variables with these start values (NULL: zeros), in blocks of `block` (1 to 8; count is a multiple
   of it): the coordinates of one point, say. A block's variables stay together in the matrix when some row
   couples them. Returns the number of the first variable, -1 after an error. */
GPROJ_API int32_t gproj_system_add_variables(gproj_system *system, int32_t count, int32_t block, const double *values);
GPROJ_API int32_t gproj_system_variable_count(const gproj_system *system);
/* The variables, to read and to write; valid until variables are added. */
GPROJ_API double *gproj_system_values(gproj_system *system);

/* Adds an empty group; returns its number, from 0. */
GPROJ_API int32_t gproj_system_add_group(gproj_system *system, const gproj_group *group);
GPROJ_API int32_t gproj_system_group_count(const gproj_system *system);
GPROJ_API gproj_group_info gproj_system_group_info(const gproj_system *system, int32_t group);
/* A new weight needs no new analysis; 0 switches a group off. */
GPROJ_API gproj_code gproj_system_set_schedule(gproj_system *system, int32_t group, gproj_schedule schedule);

/* Adds a row of `count` terms and the constant c; `element` is what it belongs to (the face, say), for reports.
   Returns its number within the group. Rows added after a solve make the next solve analyse anew. */
GPROJ_API int32_t gproj_system_add_row(gproj_system *system, int32_t group, int32_t count, const gproj_term *terms,
                                       double constant, int32_t element);
/* Replaces the coefficients (in the order of the row's terms; NULL: as they are) and the constant of a row. */
GPROJ_API gproj_code gproj_system_set_row(gproj_system *system, int32_t group, int32_t row, const double *coefficients,
                                          double constant);
/* The weight of one row, times its group's; 1 when it is added, 0 leaves it out. */
GPROJ_API gproj_code gproj_system_set_row_weight(gproj_system *system, int32_t group, int32_t row, double weight);
/* phi of one row at the current x; with `gradient` (as long as the variables, may be NULL) its dense gradient. */
GPROJ_API double gproj_system_row_value(const gproj_system *system, int32_t group, int32_t row, double *gradient);

/* Compares every gradient with central differences of the values; returns the largest difference found, relative
   to the largest entry of that row's gradient and at least 1. About 1e-9 is right, 1e-3 is a wrong gradient. */
GPROJ_API double gproj_system_check_gradients(gproj_system *system);

/* Takes at most `iterations` steps. `options` may be NULL. */
GPROJ_API gproj_result gproj_system_solve(gproj_system *system, int32_t iterations, const gproj_solve_options *options);

/* ------------------------------------------------------------------------------------------------------------
   >>api-mesh   Half-edge meshes of any polygons.

   Orientable 2-manifolds, with or without boundary, any number of components and holes, faces of degree >= 3
   (convex or not), isolated vertices allowed. Every edge has two half-edges; at the boundary one of them has
   face -1, and those of a boundary loop are linked by next/prev in the direction opposite to the faces.

   All arrays are owned by the mesh and read-only but for `position`, which you may change at any time.
   Corner k of face f is the half-edge that follows face_halfedge[f] k times, in the order of the input. */
typedef struct gproj_mesh {
    int32_t vertex_count;
    int32_t face_count;
    int32_t edge_count;
    int32_t halfedge_count;   /* 2 * edge_count: half-edges 2e and 2e + 1 are the two of edge e */
    int32_t loop_count;       /* boundary loops */
    int32_t component_count;  /* connected components, isolated vertices not counted */
    int32_t isolated_count;   /* vertices without a face */
    int32_t reoriented_count; /* faces turned round so that all of a component agree */

    double *position;               /* 3 * vertex_count: x y z of each vertex */
    const int32_t *vertex_halfedge; /* an outgoing half-edge; at the boundary the one with face -1; -1: isolated */
    const int32_t *face_halfedge;   /* the half-edge at the face's first corner */
    const int32_t *face_degree;     /* number of corners */
    const int32_t *loop_halfedge;   /* a half-edge with face -1 of each boundary loop */

    const int32_t *twin; /* of each half-edge h: the opposite one, h ^ 1 */
    const int32_t *next; /* the following one in the same face or boundary loop */
    const int32_t *prev;
    const int32_t *origin; /* the vertex where it starts */
    const int32_t *face;   /* the face on its left, or -1 */
    const int32_t *edge;   /* h / 2 */

    int32_t polyline_count;         /* polylines `l` of an OBJ file, by vertices of the mesh (often isolated ones) */
    const int32_t *polyline_start;  /* polyline_count + 1 entries into polyline_vertex */
    const int32_t *polyline_vertex; /* a closed polyline repeats its first vertex at its end */
} gproj_mesh;

/* Builds a mesh of at least one vertex: positions 3 * vertex_count, none beyond 1e70; face_degree one entry a face,
   face_vertex the corners of all faces one after the other, from 0. The arrays are copied. Refuses, naming the
   element: indices out of range, a face with fewer than 3 or with repeated vertices, coordinates that are not finite,
   edges with more than two faces, vertices whose faces form more than one fan, components without a consistent
   orientation (the first face of a component gives it; faces against it are turned round and counted). */
GPROJ_API gproj_mesh *gproj_mesh_create(int32_t vertex_count, const double *position, int32_t face_count,
                                        const int32_t *face_degree, const int32_t *face_vertex, const gproj_host *host,
                                        gproj_error *error);
GPROJ_API gproj_mesh *gproj_mesh_copy(const gproj_mesh *mesh, const gproj_host *host, gproj_error *error);
GPROJ_API void gproj_mesh_destroy(gproj_mesh *mesh);
GPROJ_API gproj_memory gproj_mesh_memory(const gproj_mesh *mesh);

/* The number of edges at a vertex. */
GPROJ_API int32_t gproj_mesh_valence(const gproj_mesh *mesh, int32_t vertex);
GPROJ_API bool gproj_mesh_is_boundary_vertex(const gproj_mesh *mesh, int32_t vertex);
/* The neighbours of a vertex in cyclic order, counter-clockwise seen from outside (at the boundary from the first to
   the last along the faces). Writes at most `capacity` of them, returns the valence. */
GPROJ_API int32_t gproj_mesh_one_ring(const gproj_mesh *mesh, int32_t vertex, int32_t *neighbours, int32_t capacity);
/* The vectorial area of a face: 1/2 sum v_i x v_(i+1); its length is the area of a planar face. */
GPROJ_API void gproj_mesh_face_area_vector(const gproj_mesh *mesh, int32_t face, double area[3]);
/* The mean length of all edges; 0 without edges. */
GPROJ_API double gproj_mesh_mean_edge_length(const gproj_mesh *mesh);

typedef enum gproj_format {
    GPROJ_FORMAT_DETECT, /* reading: by the first word; files: by the name's ending */
    GPROJ_FORMAT_OBJ,
    GPROJ_FORMAT_OFF,
    GPROJ_FORMAT_FORCE_INT = 0x7fffffff
} gproj_format;

/* Reads a mesh from a text. OBJ: v, f (also negative indices and v/vt/vn), l; comments, CRLF and continued lines;
   g, o, s, usemtl, mtllib, vt, vn and unknown words are passed over. OFF: OFF, COFF, NOFF, STOFF with their extra
   numbers passed over. */
GPROJ_API gproj_mesh *gproj_mesh_read(const char *text, size_t size, gproj_format format, const gproj_host *host,
                                      gproj_error *error);

/* Receives a piece of text; returns false to stop (then the writer returns GPROJ_ERROR_FILE). */
typedef bool (*gproj_write)(void *user, const char *text, size_t size);
/* Writes the mesh with vertices, faces and corners in their order and numbers that read back to the same bits. OFF has
   no polylines. */
GPROJ_API gproj_code gproj_mesh_write(const gproj_mesh *mesh, gproj_format format, gproj_write write, void *user);

#ifndef GPROJ_NO_STDIO
/* Reads a file; the format by the name's ending, or by the first word where that is neither .obj nor .off. */
GPROJ_API gproj_mesh *gproj_mesh_load(const char *path, const gproj_host *host, gproj_error *error);
/* Writes to a new file beside `path` and renames it, so an old file at `path` is lost only when the new one is
   complete. The format follows the ending: .obj or .off. */
GPROJ_API gproj_code gproj_mesh_save(const gproj_mesh *mesh, const char *path, gproj_error *error);
#endif

/* ------------------------------------------------------------------------------------------------------------
   >>api-edit   Changes of a mesh's combinatorics: edges split and collapsed, faces cut, strips of quads, the dual.

   The combinatorics of a gproj_mesh are fixed. A gproj_edit is a copy of them that can be changed, each change in time
   that depends on its surroundings alone; gproj_edit_mesh makes a mesh of what has become of it, at any time and as
   often as wanted, and says where each element has gone:

       gproj_edit *edit = gproj_edit_create(mesh, NULL, NULL);
       int32_t v = gproj_edit_split_edge(edit, 17, 0.5, NULL);       // vertex v in the middle of edge 17
       gproj_edit_split_face(edit, 4, v, 23, NULL);                  // from there across face 4 to vertex 23
       gproj_mesh *after = gproj_edit_mesh(edit, NULL, NULL);
       handle = edit->vertex_number[handle];                         // a vertex of `mesh`, or v, in `after`
       gproj_edit_destroy(edit);

   NUMBERS  Vertices, edges and faces of the mesh keep their numbers in the edit, whatever is done; new elements get the
   following ones, and numbers of removed ones are not given again. The number of a vertex or edge that was merged into
   another one stands for that one, in all functions here; of the two the lower number stays.
   REFUSALS  After each change the edit is an orientable manifold of the kind that gproj_mesh_create accepts. A change
   that would end that is refused: it returns -1, with an error that names the element, and the edit is as it was, as it
   is when there is no memory. A refusal has no consequences for later changes. `error` may be NULL.
   POLYLINES  Those of the mesh go with their vertices. Where one runs along an edge that is split, it gets the new
   vertex. */

/* Read-only but for `position`. The arrays move when the edit grows: do not keep their addresses. They are like those
   of gproj_mesh, with gaps: a removed edge e has origin[2 * e] = -1, a removed face face_halfedge -1, a vertex that was
   merged into another one, like one without a face, vertex_halfedge -1. The twin of half-edge h is h ^ 1, its edge
   h / 2. */
typedef struct gproj_edit {
    int32_t vertex_count; /* numbers given so far, those of removed elements included */
    int32_t edge_count;
    int32_t face_count;

    double *position;               /* 3 * vertex_count */
    const int32_t *vertex_halfedge; /* an outgoing half-edge; at the boundary the one with face -1 */
    const int32_t *face_halfedge;   /* the half-edge at the face's first corner */
    const int32_t *face_degree;     /* number of corners */
    const int32_t *face_parent;     /* the face of the first mesh of which this one is a part */

    const int32_t *next; /* of each of the 2 * edge_count half-edges, as in gproj_mesh */
    const int32_t *prev;
    const int32_t *origin;
    const int32_t *face;

    /* Numbers in the mesh that gproj_edit_mesh made last, one for each number that the edit had given then: for merged
       elements that of what they were merged into, -1 where nothing is left. NULL before. */
    const int32_t *vertex_number;
    const int32_t *edge_number;
    const int32_t *face_number;
} gproj_edit;

/* The mesh is copied. */
GPROJ_API gproj_edit *gproj_edit_create(const gproj_mesh *mesh, const gproj_host *host, gproj_error *error);
GPROJ_API void gproj_edit_destroy(gproj_edit *edit);
GPROJ_API gproj_memory gproj_edit_memory(const gproj_edit *edit);

/* A mesh of what the edit is now, its elements in the order of their numbers (edges in that of all meshes: as they
   appear along the faces), and the maps of numbers. Polylines lose repeated vertices; one of which a single vertex is
   left is left out. Refused are only positions that were set to what gproj_mesh_create refuses. */
GPROJ_API gproj_mesh *gproj_edit_mesh(gproj_edit *edit, const gproj_host *host, gproj_error *error);

/* The vertex that this number stands for: itself, or what it was merged into; -1 out of range. */
GPROJ_API int32_t gproj_edit_vertex(gproj_edit *edit, int32_t vertex);
/* The edge between two vertices; -1: none. */
GPROJ_API int32_t gproj_edit_edge(gproj_edit *edit, int32_t vertex, int32_t other);

/* Splits an edge at (1 - t) v_i + t v_j, 0 <= t <= 1, where half-edge 2 * edge goes from i to j. Its faces get one
   corner more. `edge` is then the part at i; the new edge, the last one, goes from the new vertex to j. Returns the new
   vertex. */
GPROJ_API int32_t gproj_edit_split_edge(gproj_edit *edit, int32_t edge, double t, gproj_error *error);

/* Cuts a face by a diagonal between two of its corners. `face` is then the part with its first corner; the other part
   is the last face. Refused where the corners have an edge already. Returns the new edge. */
GPROJ_API int32_t gproj_edit_split_face(gproj_edit *edit, int32_t face, int32_t vertex, int32_t other,
                                        gproj_error *error);

/* Merges the two ends of an edge into one vertex, at (1 - t) v_i + t v_j, 0 <= t <= 1, where half-edge 2 * edge goes
   from i to j. Its faces lose a corner; of a triangle the other two edges become one. Refused where the mesh would be
   pinched or folded onto itself: both ends have an edge to a vertex that is not the third of a triangle at the edge, or
   are corners of a face without being neighbours there, or are at the boundary and the edge is not; and where a
   component would vanish. (This is the link condition of Dey, Edelsbrunner, Guha, Nekhayev 1999, for polygons.) Returns
   the vertex. */
GPROJ_API int32_t gproj_edit_collapse_edge(gproj_edit *edit, int32_t edge, double t, gproj_error *error);

/* Cuts faces into triangles by diagonals: `face`, or all faces if it is -1. Of all ways to do so, one is taken whose
   triangles are not turned over in the plane orthogonal to the face's vectorial area (if there is one: the face may be
   non-convex, but must not cross itself there), and among these the one with the best triangles: the sum of (a^2 + b^2
   + c^2) / area is least (Klincsek 1980). From faces of more than 128 corners ears are cut first until 128 are left
   (Meisters 1975). Refused where each way needs a diagonal that is an edge already. Returns the number of new faces. */
GPROJ_API int32_t gproj_edit_triangulate(gproj_edit *edit, int32_t face, gproj_error *error);

/* The strip of an edge (polychord) are the quads that are reached from the edge by going on across the opposite edge,
   both ways, until the strip closes, the boundary is met, or a face that is no quad. The edges across it are its rungs;
   all can be given the same direction. A strip may cross itself: such a quad belongs to it twice.

   Inserts a strip beside the one of an edge: all rungs are split at (1 - t) v_i + t v_j, 0 <= t <= 1, in the direction
   in which half-edge 2 * edge goes from i to j, and the quads cut in two, where the strip crosses itself in four. Quads
   stay quads; at the ends of the strip triangles are cut in two, and faces with 5 or more corners get one more. Refused
   where no quad is at the edge, and where a closed strip has two quads only. Returns the new part of the edge, from the
   new vertex to j: a rung of the new strip. */
GPROJ_API int32_t gproj_edit_insert_strip(gproj_edit *edit, int32_t edge, double t, gproj_error *error);

/* Removes the strip of an edge: all rungs are collapsed to (1 - t) v_i + t v_j in that direction (Daniels, Silva,
   Shepherd, Cohen 2008). Quads beside it stay quads; other faces at its ends lose a corner, and triangles there vanish.
   Refused where the mesh would be pinched or folded onto itself, as for a single edge. Takes time in the size of the
   mesh. After gproj_edit_insert_strip, with the edge that it returned and t = 1, all is as it was, but for the numbers
   of faces. Returns the number of rungs. */
GPROJ_API int32_t gproj_edit_remove_strip(gproj_edit *edit, int32_t edge, double t, gproj_error *error);

/* The dual mesh: vertex f is the mean of the corners of face f, and each vertex with faces, in their order, becomes a
   face whose corners are the faces around it. At the boundary it ends where the mesh does: after those of the faces
   come, in their order, the midpoints of the boundary edges, which are corners of the dual faces of their two vertices;
   then the corners of the boundary (gproj_form_is_corner), each in its own dual face; then vertices without a face,
   which stay as they are. So the dual of a rectangular grid of quads is one. Polylines stay where all of their vertices
   do. `vertex_face`: vertex_count numbers to be filled with the dual face of each vertex, -1 for those without a face;
   may be NULL. The dual of the dual of a closed mesh has the combinatorics of the mesh. Refused where two faces have
   more than one edge in common, for their vertices would have two edges. */
GPROJ_API gproj_mesh *gproj_mesh_dual(const gproj_mesh *mesh, int32_t *vertex_face, const gproj_host *host,
                                      gproj_error *error);

/* ------------------------------------------------------------------------------------------------------------
   >>api-subdivide   Subdivision: smooth fine meshes from coarse cages, and how they follow their cages.

   The finer mesh of a level has a vertex for each vertex and each edge of the mesh, and with Catmull and Clark's scheme
   one for each face: vertex v stays vertex v, the one of edge e is vertex_count + e, the one of face f is vertex_count +
   edge_count + f. Its faces follow the corners of the mesh's faces, in their order and orientation. Corner k of face f,
   at the vertex v between the edges e (to the next vertex) and d (from the one before), gives
       Catmull-Clark   the quad      v, e, f, d    which is face (corners of the faces before f) + k
       Loop            the triangle  v, e, d       which is face 4 f + k; face 4 f + 3 are the three edges' vertices
   Several levels are this, repeated. Vertices without a face stay. Edges of the mesh that belong to one of its polylines
   are refined in it, the rest of the polyline is kept.

   Where the vertices go (S sharp edges meet at v, boundary edges among them; n edges; all weights are > 0):
       face            mean of its corners
       edge i-j        Catmull-Clark: (i + j + f + g) / 4, with its faces' vertices f, g;
                       Loop: (3 i + 3 j + a + b) / 8, with the third corners a, b;   sharp: (i + j) / 2
       vertex, S < 2   Catmull-Clark: (n - 2)/n v + sum (neighbours + faces' vertices) / n^2;
                       Loop: (1 - n b) v + b sum (neighbours), b = (5/8 - (3/8 + cos(2 pi / n) / 4)^2) / n
       vertex, S = 2   (i + 6 v + j) / 8, with the other ends of the sharp edges: a cubic B-spline curve
       vertex, S > 2   v, as for corners
   A crease of sharpness s is sharp for s levels; then it is smooth. In the last one, of 0 < s < 1, its edges and vertices
   are s times the sharp ones + (1 - s) times the smooth ones, s the mean of the edges at the vertex that become smooth
   there (DeRose, Kass, Truong 1998). At the boundary the surface ends in the cubic B-spline curves of the boundary. */
typedef enum gproj_scheme {
    GPROJ_CATMULL_CLARK, /* any polygons to quads; bicubic B-splines where all vertices have 4 quads */
    GPROJ_LOOP,          /* triangles to triangles; quartic box splines where all vertices have 6 */
    GPROJ_SCHEME_FORCE_INT = 0x7fffffff
} gproj_scheme;

typedef struct gproj_subdivide_options {
    gproj_scheme scheme;
    int32_t levels;        /* 1 to 14; 0 means 1 */
    int32_t stencil_level; /* the stencil leads from this level, 0 (the mesh) to levels - 1, to the last one */
    /* Edges that are sharp (NULL: the first `crease_count` ones), and how sharp: >= 0, INFINITY for always; NULL: all are
       always. Of an edge that is named twice the larger sharpness counts. Boundary edges are always sharp. */
    int32_t crease_count;
    const int32_t *creases;
    const double *sharpness;
    /* Vertices that stay where they are (NULL: the first `corner_count` ones). Boundary vertices with one face do so as
       well, unless round_corners. */
    int32_t corner_count;
    const int32_t *corners;
    bool round_corners;
} gproj_subdivide_options;

/* A sparse matrix by rows: the fine positions are it times the coarse ones. Row i is the vertex i of the finer mesh, with
   the weights weight[k] > 0 of the coarse vertices column[k], k = start[i]..start[i + 1] - 1, in ascending order; their
   sum is 1. So coarse vertices are handles of the finer mesh. A row has the vertices of all faces around: about 6 entries
   for one level of a quad mesh, 16 for many; but for each corner of a face of many corners it has as many. All arrays
   are owned by the stencil. */
typedef struct gproj_stencil {
    int32_t row_count;
    int32_t column_count;
    const int64_t *start; /* row_count + 1 */
    const int32_t *column;
    const double *weight;
} gproj_stencil;

/* The mesh after some levels of subdivision. `options` may be NULL: one level of Catmull and Clark's scheme. `stencil` may
   be NULL, else it receives the stencil that leads to the new mesh, to be destroyed by the caller; NULL on failure. Of
   one level it gives the same positions to the last bit, of several up to rounding. For handles on several levels take
   the meshes of 1, 2, ... levels, and for each the stencil from the level before, with stencil_level.
   Refuses: GPROJ_ERROR_INDEX and _NUMBER for edges, vertices and sharpness out of range; for Loop's scheme
   GPROJ_ERROR_ARGUMENT where a face is no triangle, and _NON_MANIFOLD where two faces have the same three corners;
   GPROJ_ERROR_SIZE, before memory is taken, where a level would have more than a mesh can. */
GPROJ_API gproj_mesh *gproj_mesh_subdivide(const gproj_mesh *mesh, const gproj_subdivide_options *options,
                                           gproj_stencil **stencil, const gproj_host *host, gproj_error *error);

GPROJ_API void gproj_stencil_destroy(gproj_stencil *stencil);
GPROJ_API gproj_memory gproj_stencil_memory(const gproj_stencil *stencil);
/* fine = stencil * coarse, for any data with `size` numbers a vertex: 3 for positions. coarse: size * column_count
   numbers, fine: size * row_count others. */
GPROJ_API void gproj_stencil_apply(const gproj_stencil *stencil, int32_t size, const double *coarse, double *fine);
/* The stencil that leads through both: fine * coarse, where the columns of `fine` are the rows of `coarse`. */
GPROJ_API gproj_stencil *gproj_stencil_multiply(const gproj_stencil *fine, const gproj_stencil *coarse,
                                                const gproj_host *host, gproj_error *error);
/* The transposed matrix: row j is what coarse vertex j moves. When that moves by d, fine vertex column[k] moves by
   weight[k] * d. Its rows do not sum to 1. */
GPROJ_API gproj_stencil *gproj_stencil_transpose(const gproj_stencil *stencil, const gproj_host *host,
                                                 gproj_error *error);

/* ------------------------------------------------------------------------------------------------------------
   >>api-reference   Curves and surfaces to stay close to. Both are copies: the mesh they come from may change. */
typedef struct gproj_curve gproj_curve;
typedef struct gproj_surface gproj_surface;

typedef struct gproj_curve_hit {
    double point[3];   /* the closest point of the curve */
    double tangent[3]; /* unit; of the segment on which the point lies */
    double distance;
    int32_t segment;  /* from point[segment] to the next one */
    double parameter; /* 0..1 within the segment */
} gproj_curve_hit;

typedef struct gproj_surface_hit {
    double point[3];
    double normal[3]; /* unit; vertex normals interpolated at the point */
    double distance;
    int32_t face; /* of the mesh that the surface was made from */
} gproj_surface_hit;

/* A polyline through `count` >= 2 points (3 * count numbers); closed: with a segment from the last to the first. */
GPROJ_API gproj_curve *gproj_curve_create(int32_t count, const double *points, bool closed, const gproj_host *host,
                                          gproj_error *error);
/* Boundary loop `loop` of a mesh as a closed curve, in the direction of the faces' edges, from the origin of
   loop_halfedge[loop]. */
GPROJ_API gproj_curve *gproj_curve_from_loop(const gproj_mesh *mesh, int32_t loop, const gproj_host *host,
                                             gproj_error *error);
/* Polyline `polyline` of a mesh; closed where its last vertex is its first. */
GPROJ_API gproj_curve *gproj_curve_from_polyline(const gproj_mesh *mesh, int32_t polyline, const gproj_host *host,
                                                 gproj_error *error);
GPROJ_API void gproj_curve_destroy(gproj_curve *curve);
GPROJ_API gproj_curve_hit gproj_curve_closest(const gproj_curve *curve, const double point[3]);

/* The mesh's faces, cut into triangles. Refused where the mesh has no faces. */
GPROJ_API gproj_surface *gproj_surface_create(const gproj_mesh *mesh, const gproj_host *host, gproj_error *error);
GPROJ_API void gproj_surface_destroy(gproj_surface *surface);
GPROJ_API gproj_surface_hit gproj_surface_closest(const gproj_surface *surface, const double point[3]);

/* ------------------------------------------------------------------------------------------------------------
   >>api-measure   What a mesh is like. */
typedef struct gproj_measures {
    double mean_edge, min_edge, max_edge;
    double length;                             /* of all edges */
    double area, min_face_area, max_face_area; /* lengths of vectorial areas */
    /* Of a face: the largest distance of its vertices from their least-squares plane, in mean edge lengths of the
       mesh. */
    double planarity_max, planarity_mean;
    int32_t planarity_face; /* where the largest is; -1 without faces */
    double circularity_max; /* of faces with more than 3 sides: largest difference of the distances of a face's vertices
                               from its circumcentre, in mean edge lengths */
    double area_spread;     /* standard deviation of the face areas over their mean */
    double diagonal_max;    /* quads: distance of the lines through the diagonals, in mean edge lengths */
    /* Of vertices where 4 or more faces meet: the largest difference of the angles of the faces' normals with the axis
       that is nearest to the bisecting planes of neighbouring faces, in radians. */
    double conicality_max;
    double deviation_max, deviation_rms; /* |v - v_original| / bounding box diagonal of the original */
    double displacement_mean;            /* mean |v - v_original| in mean edge lengths of the original */
    int32_t turned_faces;                /* vectorial area against the one of the original face */
    int32_t folded_edges;                /* the two faces' normals make more than 120 degrees */
    int32_t bow_tie_faces;               /* the polygon crosses itself, seen along the normal of its plane */
    int32_t degenerate_faces;            /* vectorial area below 1e-12 of the squared mean edge */
    int32_t collapsed_edges;             /* not longer than 1e-6 mean edges */
    /* Sum over interior vertices of the area of the Gauss image of the vertex star: the spherical polygon of its face
       normals, as a sum of triangle areas about its mean. */
    double gauss_variation;
} gproj_measures;

/* `original`: the positions to compare with, 3 * vertex_count; NULL: no comparison (those members are 0).
   `planarity`: face_count numbers to be filled; may be NULL. */
GPROJ_API gproj_measures gproj_measure(const gproj_mesh *mesh, const double *original, double *planarity);
/* The volume that a closed mesh encloses, or between a mesh with boundary and the plane z = 0: see gproj_add_volume. */
GPROJ_API double gproj_volume(const gproj_mesh *mesh);

/* ------------------------------------------------------------------------------------------------------------
   >>api-offset   Parallel meshes at constant distance, and the support structure between them.

   Two meshes are parallel when corresponding edges are; then the quads between corresponding edges are planar (Pottmann,
   Liu, Wallner, Bobenko, Wang 2007). Circular meshes have a parallel mesh with its vertices at constant distance,
   conical meshes one with its faces at constant distance. Any mesh is taken; how exact the outcome is, gproj_measure_offset
   tells. Distances are in the mesh's units, positive on the side of the faces' normals. */

/* A mesh whose vertices are v + distance * m, |m| = 1: m at one vertex, mirrored along each edge in the plane
   orthogonal to the edge, gives m at all of them. The distance is exact always; edges are parallel where going round
   closes: in a mesh without holes and handles whose faces are planar, circular, of even numbers of sides and without
   doubled vertices, whatever m is at the first vertex. It is chosen so that m goes along the normals of the vertices,
   and with holes, handles and odd faces, as far as that keeps the normals, among those for which going round closes
   best. Vertices without a face stay. */
GPROJ_API gproj_mesh *gproj_mesh_vertex_offset(const gproj_mesh *mesh, double distance, const gproj_host *host,
                                               gproj_error *error);
/* A mesh whose faces are the faces moved by `distance` along their normals: vertices v + distance * x, where n_k'x = 1
   for the normals n_k of the faces around the vertex. Exact for conical meshes, where x = a / cos(angle) with the axis
   a of the vertex, and then edges between two faces are parallel; for others in the least-squares sense. At the
   boundary n_1'x = n_2'x = 1 of two faces, or the one n'x = 1, leaves freedom: it goes to the edges of the boundary,
   which become as parallel as they can. Vertices without a face stay. */
GPROJ_API gproj_mesh *gproj_mesh_face_offset(const gproj_mesh *mesh, double distance, const gproj_host *host,
                                             gproj_error *error);
/* The panels between a mesh and its offset: face e is the quad v_i v_j o_j o_i of edge e with half-edge 2e from i to j.
   More than two of them meet at a node's axis, which no manifold mesh has: so each quad has its own four vertices,
   4e .. 4e + 3, in this order. Refused where the meshes do not have the same faces. */
GPROJ_API gproj_mesh *gproj_mesh_support(const gproj_mesh *mesh, const gproj_mesh *offset, const gproj_host *host,
                                         gproj_error *error);

typedef struct gproj_offset_measures {
    /* n_k'(o_i - v_i) for all corners i of all faces k, in the mesh's units. The normal is that of the vectorial area. */
    double face_distance_min, face_distance_max;
    double vertex_distance_min, vertex_distance_max; /* |o_i - v_i|, of vertices with a face, in the mesh's units */
    /* Of an offset edge: the largest part of o_j - o_i across the edge v_j - v_i; and of the quads of gproj_mesh_support,
       the largest distance of o_j from the plane through v_i, v_j and o_i; both in mean edge lengths of the mesh. */
    double parallel_max, support_planarity_max;
    int32_t reversed_edges; /* they run against their edges: the distance is larger than a radius of curvature */
} gproj_offset_measures;

/* Distances and parallel_max are infinite where there is no mesh, or where the two do not have the same faces. */
GPROJ_API gproj_offset_measures gproj_measure_offset(const gproj_mesh *mesh, const gproj_mesh *offset);

/* ------------------------------------------------------------------------------------------------------------
   >>api-fill   From a closed curve to a mesh of quads that fills it.

   The boundary of the mesh is the curve: its sides run from corner to corner, each cut into a number of edges. Any
   numbers can be filled whose sum is even and at least 4: the boundary of a mesh of quads has an even number of edges.
   Inside, vertices have valence 4 but for a few of valence 3 and 5. They depend on the numbers: equal ones on opposite
   sides of 4 give a grid, 3 and 5 sides with numbers that go together one irregular vertex, others a few more.

   The combinatorics is found where the curve is seen along the normal of its vectorial area; so seen it must not meet
   itself. There no quad is turned over, nor has it a corner of 180 degrees or more. The heights over that plane are
   those of the curve at the boundary, and harmonic inside: each vertex is at the mean height of its neighbours. */
typedef struct gproj_fill_options {
    int32_t corner_count;        /* 0: where the curve turns by more than 45 degrees (see gproj_form_is_corner) */
    const int32_t *corners;      /* numbers of points, ascending */
    int32_t side_count;          /* as many as corners; 0: numbers of edges follow from edge_length */
    const int32_t *subdivisions; /* edges of side j, from corner j to the next, of equal lengths along the curve */
    double edge_length;          /* wanted, in the curve's units; 0: the mean distance of neighbouring points */
    bool keep_points;            /* the points of the curve are the vertices of the boundary, whatever is wanted */
    int32_t rings;               /* rows of quads that run around along the whole boundary */
    int32_t variant; /* 0: the fewest irregular vertices; 1, 2, ..: other combinatorics, while there are any */
} gproj_fill_options;

/* What has been made. */
typedef struct gproj_fill_info {
    int32_t boundary_count;  /* vertices 0 to boundary_count - 1 are the boundary, in the order of the curve */
    int32_t side_count;      /* polylines of the mesh: side j from its first to its last vertex */
    int32_t patch_count;     /* patches of at most 6 sides that the curve was cut into */
    int32_t irregular_count; /* inner vertices whose valence is not 4 */
    int32_t min_valence;     /* of inner vertices; 0 where there are none */
    int32_t max_valence;
    double min_angle; /* of the quads' corners, in degrees, seen along the normal */
    double max_angle;
} gproj_fill_info;

/* Fills the closed curve through `count` >= 3 points (3 * count numbers; the last is joined to the first). Vertex 0 is
   the first corner. The corners of the mesh are exactly points of the curve, the other vertices of its boundary are on
   its segments. Counter-clockwise curves give faces that look up. The polylines of the mesh are its sides; a curve with
   fewer than 2 corners is given 4 at about equal distances, from its corner or its first point.
   A corner has one face; one of more than 165 degrees inside has two, and so have all where there are rings. Corners of
   more than 195 degrees are ends of cuts through the inside, and so are others where there are more than 6: to where the
   cut is short, its angles are good, and the patches need few irregular vertices. Valence 6 is taken where this leaves
   nothing better.
   `options`, `info`, `host` and `error` may be NULL; without a mesh `info` is all 0. Refused, naming the point (of a
   side: the first one): curves that meet themselves or enclose no area, corners out of order, numbers of edges below 1 or
   with an odd sum, with what to change, and curves for which no filling was found. */
GPROJ_API gproj_mesh *gproj_mesh_fill(int32_t count, const double *points, const gproj_fill_options *options,
                                      gproj_fill_info *info, const gproj_host *host, gproj_error *error);

/* ------------------------------------------------------------------------------------------------------------
   >>api-form   A mesh, what must hold and what is wished: form-finding.

   gproj_form_create reads the mesh's positions; gproj_solve writes them back. Inside, the mesh is moved and scaled
   so that its mean edge is 1: weights, tolerances and residuals are in mean edge lengths, and a model in mm gives
   the shape of the same model in km. Every gproj_add_... appends a group of rows to the form's system and
   returns its number (-1 after an error); after an error they do nothing, so check once, at the solve.
   Weights: 1 for what must hold. Wishes fade by default after half of the iterations of the solve (schedule
   with last = 0), because a wish that stays on biases the constraints; set a schedule to say otherwise. */
typedef struct gproj_form gproj_form;

/* The form keeps a pointer to the mesh, which must outlive it. A NULL mesh gives a form whose error says so. */
GPROJ_API gproj_form *gproj_form_create(gproj_mesh *mesh, const gproj_host *host);
GPROJ_API void gproj_form_destroy(gproj_form *form); /* NULL does nothing, as with all destroy functions */
GPROJ_API const gproj_error *gproj_form_error(const gproj_form *form);
GPROJ_API gproj_memory gproj_form_memory(const gproj_form *form);
/* The system underneath, for rows of your own. Variables 3i, 3i+1, 3i+2 are vertex i in the form's units:
   internal = (position - centre) * scale. */
GPROJ_API gproj_system *gproj_form_system(gproj_form *form);
GPROJ_API void gproj_form_units(const gproj_form *form, double centre[3], double *scale);

/* -- what must hold -- */

/* Faces with more than 3 sides are planar: a unit normal n_k per face as variables, n_k'n_k = 1, and
   n_k'(v_i - v_j) = 0 for every edge of the face (paper 3.1). */
GPROJ_API int32_t gproj_add_planarity(gproj_form *form, double weight);
/* These vertices stay where they were at gproj_form_create: v_i = p_i, 3 rows each. */
GPROJ_API int32_t gproj_add_fixed(gproj_form *form, int32_t count, const int32_t *vertices, double weight);
GPROJ_API int32_t gproj_add_fixed_boundary(gproj_form *form, double weight);
/* The corners of the boundary: see gproj_form_is_corner. */
GPROJ_API int32_t gproj_add_fixed_corners(gproj_form *form, double weight);
/* Handles: vertices[k] goes to positions[3k..3k+2] (in the mesh's units). Move them by gproj_set_targets. */
GPROJ_API int32_t gproj_add_targets(gproj_form *form, int32_t count, const int32_t *vertices, const double *positions,
                                    double weight);
GPROJ_API gproj_code gproj_set_targets(gproj_form *form, int32_t group, const double *positions);
/* The vertices stay on the curve. 3 rows each, anew in each iteration: u'(v_i - p) = 0, w'(v_i - p) = 0 put v_i on the
   line through the closest segment (u, w orthogonal to it, p on it; paper 3.3), and, with weight only where v_i would
   leave the curve's end or the segments around a corner, t'(v_i - p) = 0 pins it there (t along the segment). Vertices
   walk from segment to segment, and settle on one after the wishes have faded. The curve must outlive the form. */
GPROJ_API int32_t gproj_add_gliding(gproj_form *form, const gproj_curve *curve, int32_t count, const int32_t *vertices,
                                    double weight);
/* Every boundary vertex glides along the original of its boundary loop; corners stay. */
GPROJ_API int32_t gproj_add_gliding_boundary(gproj_form *form, double weight);

/* Faces with more than 3 sides have a circumcircle: with planar faces (gproj_add_planarity as well), there is a point
   c_k on the axis of the circle with (v_j - v_i)'((v_i + v_j)/2 - c_k) = 0 for every edge (paper 3.5). c_k are
   variables that start at the circumcentre. Without planarity the vertices only lie on a sphere about c_k.
   A face with a doubled vertex is circular, too: a mesh far from circular may lose short edges (collapsed_edges of
   gproj_measure). */
GPROJ_API int32_t gproj_add_circularity(gproj_form *form, double weight);
/* The planes of the faces around a vertex touch a common cone: their unit normals n_i make one angle with its axis a_v,
   a_v'(n_i - n_(i+1)) = 0 and a_v'a_v = 1 (paper 3.5; Liu et al. 2006). The rows say that the axis is in the bisecting
   planes of neighbouring faces, det(a_v, e, n_i + n_(i+1)) / (2 |e|) = 0 with the edge e between them, linearised anew
   in each iteration: the same where the faces differ, and what an offset needs where they are coplanar. Rows for the
   vertices where 4 or more faces meet; three planes always touch a cone. a_v are variables that start at the axis
   nearest to the bisecting planes. Needs the normals of planar faces: call gproj_add_planarity before. */
GPROJ_API int32_t gproj_add_conicality(gproj_form *form, double weight);
/* These edges (half-edges 2e, 2e + 1 of the mesh; edges NULL: the first `count` ones) have the lengths lengths[k] > 0,
   in the mesh's units: (|v_i - v_j|^2 - l^2) / (2 l) = 0. NULL lengths: those of gproj_form_create. */
GPROJ_API int32_t gproj_add_lengths(gproj_form *form, int32_t count, const int32_t *edges, const double *lengths,
                                    double weight);
/* These edges have one common, unknown length L, a variable: |v_i - v_j|^2 / 2 - L^2 / 2 = 0. For several groups of
   edges, each with its own length, call it several times. */
GPROJ_API int32_t gproj_add_equal_lengths(gproj_form *form, int32_t count, const int32_t *edges, double weight);
/* These vertices are on one unknown plane: n'(v_i - m) = d with n'n = 1, n and d variables that start at the
   least-squares plane, m the mean of the originals. Nothing for 3 vertices and fewer. */
GPROJ_API int32_t gproj_add_coplanar(gproj_form *form, int32_t count, const int32_t *vertices, double weight);
/* These vertices are on one unknown line: on two unknown planes with orthogonal normals. Nothing for 2 vertices and
   fewer. */
GPROJ_API int32_t gproj_add_collinear(gproj_form *form, int32_t count, const int32_t *vertices, double weight);
/* Each part of the boundary from corner to corner (gproj_form_is_corner), both with it, is on one unknown plane; a loop
   without corners as a whole. */
GPROJ_API int32_t gproj_add_planar_boundary(gproj_form *form, double weight);
/* Each part of the boundary from corner to corner is straight. Refuses loops with fewer than 3 corners. Where faces are
   planar quads, all those along a straight part lie in one plane. */
GPROJ_API int32_t gproj_add_straight_boundary(gproj_form *form, double weight);
/* These edges (NULL: the first `count` ones) are orthogonal to the planes with this normal, of any length > 0:
   u'(v_j - v_i) = 0 and w'(v_j - v_i) = 0 with u, w orthogonal to the normal. */
GPROJ_API int32_t gproj_add_orthogonal_edges(gproj_form *form, const double normal[3], int32_t count,
                                             const int32_t *edges, double weight);
/* At every boundary vertex b with one inner edge bt, corners apart, that edge is orthogonal to the boundary, to the
   line through the neighbours p and q: (t - b)'(q - p) / 2 = 0 (paper, Figure 13: right angles at the ground). */
GPROJ_API int32_t gproj_add_orthogonal_boundary(gproj_form *form, double weight);
/* All vertices keep the x and y of their originals and move in z only (paper, Figure 13: lifting a flat mesh). */
GPROJ_API int32_t gproj_add_lifting(gproj_form *form, double weight);
/* The volume V(v) = volume, in the mesh's units cubed: the enclosed volume of a closed mesh (outward normals:
   positive), and of a mesh with boundary the signed volume between it and the plane z = 0. Faces count as fans of
   triangles from their first corner, which is exact for planar ones. One global row, linearised anew in each
   iteration: (V(v) - volume) / (area of the mesh). See gproj_volume. */
GPROJ_API int32_t gproj_add_volume(gproj_form *form, double volume, double weight);
/* The sum of the face areas |a_k| (vectorial areas) is `area`, in the mesh's units squared. One global row, linearised
   anew in each iteration, and as all rows below in mean edge lengths: the side of a square with this area. */
GPROJ_API int32_t gproj_add_total_area(gproj_form *form, double area, double weight);
/* length_price * (length of all edges) + area_price * (area of all faces) = cost. Prices per unit of the mesh's lengths
   and areas, >= 0 and not both 0. One global row, as above. (1, 0) prescribes the length of all edges. */
GPROJ_API int32_t gproj_add_cost(gproj_form *form, double length_price, double area_price, double cost, double weight);

/* Bounds (GPROJ_BOUND): something is at least min and at most max, in the mesh's units. A min of 0 means no lower bound,
   a max of 0 or INFINITY no upper one.

   Lengths of these edges (as for gproj_add_lengths):
       (|v_i - v_j|^2 - min^2) / (2 min) >= 0,    (max^2 - |v_i - v_j|^2) / (2 max) >= 0. */
GPROJ_API int32_t gproj_add_length_bounds(gproj_form *form, int32_t count, const int32_t *edges, double min, double max,
                                          double weight);
/* Areas |a_k| of these faces (faces NULL: the first `count` ones), linearised anew in each iteration:
       (|a_k| - min) / (2 sqrt(min)) >= 0,    (max - |a_k|) / (2 sqrt(max)) >= 0. */
GPROJ_API int32_t gproj_add_area_bounds(gproj_form *form, int32_t count, const int32_t *faces, double min, double max,
                                        double weight);
/* The area of all faces, and the cost: see gproj_add_total_area and gproj_add_cost. */
GPROJ_API int32_t gproj_add_total_area_bounds(gproj_form *form, double min, double max, double weight);
GPROJ_API int32_t gproj_add_cost_bounds(gproj_form *form, double length_price, double area_price, double min,
                                        double max, double weight);

/* -- what is wished -- */

/* Closeness to the original: v_i = p_i. */
GPROJ_API int32_t gproj_add_closeness(gproj_form *form, double weight);
/* Closeness to a reference surface: v_i on the tangent plane at its closest point, 1 row each. The surface must
   outlive the form. */
GPROJ_API int32_t gproj_add_reference(gproj_form *form, const gproj_surface *surface, double weight);
/* Fairness: v = (w1 + w3)/2 and v = (w2 + w4)/2 at interior vertices of valence 4, v = mean of its neighbours at
   others; at the boundary v = (u + w)/2 along the boundary, nothing at corners (paper 3.2). */
GPROJ_API int32_t gproj_add_fairness(gproj_form *form, double weight);
/* The boundary's part of it alone. */
GPROJ_API int32_t gproj_add_boundary_fairness(gproj_form *form, double weight);
/* The same differences as gproj_add_fairness at interior vertices, projected to a tangent plane that is estimated anew
   in each iteration. */
GPROJ_API int32_t gproj_add_tangential_fairness(gproj_form *form, double weight);
/* Fairness of the Gauss image: the differences of face normals with those of the neighbouring faces, projected to the
   plane orthogonal to the normal. */
GPROJ_API int32_t gproj_add_gauss_fairness(gproj_form *form, double weight);

/* Quads are parallelograms: v_1 - v_2 + v_3 - v_4 = 0 (paper, Figure 8). */
GPROJ_API int32_t gproj_add_parallelograms(gproj_form *form, double weight);
/* All faces have the same, unknown area: |a_k| = A, a_k the vectorial area; linearised anew in each iteration (paper
   3.5). */
GPROJ_API int32_t gproj_add_equal_areas(gproj_form *form, double weight);

/* Weight, decay and last iteration of a group; {w, 1, INT32_MAX} keeps a wish on to the end. */
GPROJ_API gproj_code gproj_set_schedule(gproj_form *form, int32_t group, gproj_schedule schedule);
/* Weights for parts of a group: the rows of elements[k] (vertices, edges or faces, as the group's place says; elements
   NULL: the first `count` ones) get the weight weights[k] in 0..1e50, times the group's. 0 switches them off, 1 on
   again. Others stay as they are; elements without rows in this group are passed over. So a closeness or a reference
   has a weight for each vertex, and any constraint may hold for some elements only. Needs no new analysis. */
GPROJ_API gproj_code gproj_set_element_weights(gproj_form *form, int32_t group, int32_t count, const int32_t *elements,
                                               const double *weights);
GPROJ_API gproj_group_info gproj_form_group_info(const gproj_form *form, int32_t group);

/* Is the boundary vertex a corner: only one face there, or the boundary turns by more than 45 degrees. */
GPROJ_API bool gproj_form_is_corner(const gproj_form *form, int32_t vertex);

/* -- solving -- */

/* Begins from the mesh's positions as they are, takes at most `iterations` steps and writes the positions back: a
   second call goes on from where the first ended, or from where you have moved the vertices to. The system's values of
   vertices, normals and axes are overwritten at the beginning; variables of your own keep theirs. "The original" of
   fixed vertices, gliding boundaries and closeness stays that of gproj_form_create. Where no wish guides, closeness to
   the original with weight 0.03 * 0.3^n, n <= 5, is added (options: skip_closeness). After an error nothing is
   written.

   With planar faces there is a guard as well (options: skip_guard): while the wishes guide and two iterations longer, a
   face that is about to turn over gets a row that asks for 0.4 of its area. It appears as the group "guard", acts on
   the steps only, and has no part in residual and verdict. It helps; what has turned all the same is counted by
   gproj_measure.

   For the mesh that is nearest to the one at the beginning, or the one that serves the wishes best, set
   gproj_solve_options.nearest and allow 30 iterations. There the guard lasts almost to the end and asks for 0.1 of a
   face's area, and a step that would take most of a face's area is shortened. */
GPROJ_API gproj_result gproj_solve(gproj_form *form, int32_t iterations, const gproj_solve_options *options);

/* ------------------------------------------------------------------------------------------------------------
   >>api-statics   Forces in the edges of a form: equilibrium, compression only, stresses, supports and reactions.

   Every edge v_i v_j has a force density w_ij, a variable: it pushes v_i by w_ij (v_i - v_j) and v_j by the opposite, so
   w > 0 is compression and w |v_i - v_j| the axial force. In every vertex without support
       sum_j w_ij (v_i - v_j) + f_i = 0                     (paper 3.1; with loads that point down, along -z)
   f_i is the load on the vertex. Units are the caller's: lengths as in the mesh, loads in any unit of force, and forces
   come out in that one. Inside, both are normalised, so units do not change the shape. Edges between two pinned
   supports have no force: it would be undetermined. */

/* Loads follow the shape: they are linearised anew in each iteration. */
typedef struct gproj_loads {
    double density;             /* weight per length of every edge (rho A); half of it loads each end */
    const double *edge_density; /* edge_count numbers instead; NULL: `density` for all */
    double area_load;           /* down, per area of each face: an equal part on each of its corners */
    double snow;                /* down, per area of each face's projection to the ground */
    const double *point_load;   /* 3 * vertex_count: a force on each vertex; NULL: none */
} gproj_loads;

/* `count` vertices are supports. slides[k]: the axes along which support k slides freely and gives no reaction (a
   roller), the sum of 1 for x, 2 for y, 4 for z; NULL: none, all are pinned. A support takes forces; whether it stays
   where it is, is another matter: see gproj_add_fixed and gproj_add_gliding_boundary. */
typedef struct gproj_supports {
    int32_t count;
    const int32_t *vertex;
    const uint8_t *slides;
} gproj_supports;

/* Equilibrium at all vertices that are not pinned, once for a form; the arrays are copied. At the first solve the
   forces start from the solution of gproj_find_forces; where that leaves more than three quarters of the loads, from
   uniform forces that bend it first. Later solves go on from the forces they find. */
GPROJ_API int32_t gproj_add_equilibrium(gproj_form *form, const gproj_loads *loads, const gproj_supports *supports,
                                        double weight);
/* Only compression, w >= 0, or only tension, w <= 0, in these edges (edges NULL: the first `count` ones, so edge_count
   and NULL are all). These and the next two need gproj_add_equilibrium before. */
GPROJ_API int32_t gproj_add_compression(gproj_form *form, int32_t count, const int32_t *edges, double weight);
GPROJ_API int32_t gproj_add_tension(gproj_form *form, int32_t count, const int32_t *edges, double weight);
/* The stress of these edges is bounded: min <= w l / A <= max, l the length, A = sections[k] > 0 (paper 3.1); NULL
   sections: A = 1, bounds of the force. min = -INFINITY or max = INFINITY: no bound on that side. */
GPROJ_API int32_t gproj_add_stress_bounds(gproj_form *form, int32_t count, const int32_t *edges, const double *sections,
                                          double min, double max, double weight);
/* A wish: opposite edges of each quad carry the same force, l_ij w_ij - l_kl w_kl = 0 (paper 3.5). */
GPROJ_API int32_t gproj_add_force_fairness(gproj_form *form, double weight);

/* The force densities of all edges, edge_count numbers; zeros before the first solve and without equilibrium. */
GPROJ_API gproj_code gproj_get_forces(const gproj_form *form, double *densities);
/* Sets them as the start of the next solve; NULL: the next solve finds its own start. */
GPROJ_API gproj_code gproj_set_forces(gproj_form *form, const double *densities);
/* The variable of an edge's force in the form's system, for rows of your own: the density in the form's units, which
   are chosen at the first solve so that the mean square is 1. -1: the edge has none. */
GPROJ_API int32_t gproj_force_variable(const gproj_form *form, int32_t edge);
/* The loads on the mesh as it is now, 3 * vertex_count numbers. */
GPROJ_API gproj_code gproj_get_loads(const gproj_form *form, double *loads);
/* What the supports give, 3 * vertex_count numbers: -(sum_j w_ij (v_i - v_j) + f_i), 0 along axes without support. */
GPROJ_API gproj_code gproj_get_reactions(const gproj_form *form, double *reactions);

/* How self-supporting is the mesh as it is? The forces that balance its loads best: densities (edge_count numbers, may
   be NULL) minimise the sum of |sum_j w_ij (v_i - v_j) + f_i|^2, among those that the active gproj_add_compression and
   gproj_add_tension allow; residuals (vertex_count numbers, may be NULL): what is left in each vertex, over the mean
   load. Changes nothing. */
GPROJ_API gproj_code gproj_find_forces(gproj_form *form, double *densities, double *residuals);

typedef struct gproj_forces {
    double residual; /* largest |sum_j w_ij (v_i - v_j) + f_i| over vertices without support, over the largest |f_i| */
    int32_t residual_vertex;
    double min_density, max_density;
    double min_force, max_force; /* w l: > 0 compression */
    double load_path;            /* sum of |w| l^2 */
    double total_load;           /* sum of the loads' downward parts */
    double max_reaction;
} gproj_forces;

/* The mesh as it is, with the forces of the last solve. */
GPROJ_API gproj_forces gproj_measure_forces(gproj_form *form);

#ifdef __cplusplus
}
#endif

#endif /* GUIDEDPROJ_H */

/* ------------------------------ stop here if you only want the API ------------------------------ */

#ifdef GUIDEDPROJ_IMPLEMENTATION
#ifndef GPROJI_IMPLEMENTED
#define GPROJI_IMPLEMENTED

/* ============================================================================================================
   >>platform   Compiler differences, and nothing else. Uses no other section. */

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#ifndef GPROJ_NO_STDIO
#include <stdio.h>
#endif
#ifdef GPROJ_USE_CBLAS
#include <cblas.h>
#endif

#ifndef GPROJ_ASSERT
#include <assert.h>
#define GPROJ_ASSERT(condition) assert(condition)
#endif

#if defined(__GNUC__) || defined(__clang__) || defined(__TINYC__)
#define GPROJI_INTERNAL __attribute__((unused)) static
#else
#define GPROJI_INTERNAL static
#endif

#if defined(__GNUC__) || defined(__clang__)
#define GPROJI_INLINE __attribute__((unused)) static inline
#define GPROJI_NOINLINE __attribute__((noinline))
#else
#define GPROJI_INLINE static inline
#define GPROJI_NOINLINE
#endif

#if defined(__cplusplus)
#define GPROJI_RESTRICT
#else
#define GPROJI_RESTRICT restrict
#endif

/* Begins to bring the cache line of an address into the cache. gcc takes a function that does only this for one without
   effect, and drops calls of it: such a function is always inlined. */
#if defined(__GNUC__) || defined(__clang__)
#define GPROJI_PREFETCH(address) __builtin_prefetch(address)
#define GPROJI_INLINED __attribute__((unused, always_inline)) static inline
#else
#define GPROJI_PREFETCH(address) ((void)(address))
#define GPROJI_INLINED GPROJI_INLINE
#endif

/* Vector extensions of gcc and clang; every other compiler, and GPROJ_NO_SIMD, takes the scalar path; so does
   arithmetic in registers of more than double precision (x87). */
#if !defined(GPROJ_NO_SIMD) && (defined(__GNUC__) || defined(__clang__)) && !defined(__TINYC__) && \
    !(defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD == 2)
#define GPROJI_SIMD 1
#else
#define GPROJI_SIMD 0
#endif

/* May code for vector units be compiled that the compiler's target lacks? On x86-64; but gcc for Windows does not align
   long vectors on the stack (its bug 54412), and clang's headers for Microsoft's compiler leave out what the target
   lacks. */
#if GPROJI_SIMD && defined(__x86_64__) && !defined(_MSC_VER) && \
    (defined(__clang__) || !(defined(_WIN32) || defined(__CYGWIN__)))
#define GPROJI_CHOICE 1
#else
#define GPROJI_CHOICE 0
#endif
#if GPROJI_CHOICE
#include <cpuid.h>
#endif
#if GPROJI_CHOICE || (GPROJI_SIMD && defined(__AVX512F__))
#include <immintrin.h>
#endif

GPROJI_INLINE int32_t gproji_min(int32_t a, int32_t b) { return a < b ? a : b; }
GPROJI_INLINE int32_t gproji_max(int32_t a, int32_t b) { return a > b ? a : b; }
GPROJI_INLINE double gproji_fmin(double a, double b) { return a < b ? a : b; }
GPROJI_INLINE double gproji_fmax(double a, double b) { return a > b ? a : b; }
/* False for infinities and NaN, also under -ffast-math, where isfinite may be folded to true. */
GPROJI_INLINE bool gproji_is_finite(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return ((bits >> 52) & 0x7ff) != 0x7ff;
}
/* ============================================================================================================
   >>number   Numbers as decimal text, exactly and whatever the locale. Uses platform.

   Reading: digits up to 19 with small powers of ten go through one exact 128-bit product or quotient; everything
   else through exact big integers. Both end in a 64-bit significand with a sticky bit, which is rounded once, to
   nearest even, in integers: no floating-point operation takes part, so excess precision, rounding modes and
   flushed denormals do not matter.
   Writing: Steele and White 1990, in the form of Burger and Dybvig 1996: with v = R/S and half-gaps M/S to the
   neighbouring doubles, digits are produced until what is left is inside the gap.
   Invariant: a gproji_big has no leading zero limb; zero has count 0. */

/* 768 digits and a sticky one decide every double; 10^1100 = 5^1100 2^1100, and 5^1100 has 80 limbs. */
enum {
    GPROJI_BIG_LIMBS = 96,
    GPROJI_DIGITS_MAX = 800
};

typedef struct gproji_big {
    int32_t count;
    uint32_t limb[GPROJI_BIG_LIMBS]; /* least significant first */
} gproji_big;

GPROJI_INLINE int32_t gproji_bit_length(uint64_t x) {
    int32_t length = 0, step;
    for (step = 32; step; step >>= 1) {
        if (x >> step) {
            x >>= step;
            length += step;
        }
    }
    return length + (x ? 1 : 0);
}

GPROJI_INTERNAL void gproji_big_set(gproji_big *a, uint64_t value) {
    a->limb[0] = (uint32_t)value;
    a->limb[1] = (uint32_t)(value >> 32);
    a->count = a->limb[1] ? 2 : (a->limb[0] ? 1 : 0);
}

GPROJI_INTERNAL int32_t gproji_big_bits(const gproji_big *a) {
    return a->count ? 32 * (a->count - 1) + gproji_bit_length(a->limb[a->count - 1]) : 0;
}

/* a = a * factor + addend */
GPROJI_INTERNAL void gproji_big_multiply(gproji_big *a, uint32_t factor, uint32_t addend) {
    uint64_t carry = addend;
    int32_t i;
    for (i = 0; i < a->count; ++i) {
        carry += (uint64_t)a->limb[i] * factor;
        a->limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry) a->limb[a->count++] = (uint32_t)carry;
}

GPROJI_INTERNAL void gproji_big_multiply_power5(gproji_big *a, int32_t power) {
    for (; power >= 13; power -= 13) gproji_big_multiply(a, 1220703125u, 0);
    for (; power > 0; --power) gproji_big_multiply(a, 5, 0);
}

/* a = a * 2^bits */
GPROJI_INTERNAL void gproji_big_shift(gproji_big *a, int32_t bits) {
    int32_t limbs = bits / 32, i;
    bits %= 32;
    if (!a->count) return;
    if (bits) gproji_big_multiply(a, (uint32_t)1 << bits, 0);
    if (!limbs) return;
    memmove(a->limb + limbs, a->limb, (size_t)a->count * sizeof a->limb[0]);
    for (i = 0; i < limbs; ++i) a->limb[i] = 0;
    a->count += limbs;
}

/* The sign of a - b. */
GPROJI_INTERNAL int32_t gproji_big_compare(const gproji_big *a, const gproji_big *b) {
    int32_t i;
    if (a->count != b->count) return a->count < b->count ? -1 : 1;
    for (i = a->count - 1; i >= 0; --i) {
        if (a->limb[i] != b->limb[i]) return a->limb[i] < b->limb[i] ? -1 : 1;
    }
    return 0;
}

/* The sign of a + 2^shift b - c, shift 0 or 1. */
GPROJI_INTERNAL int32_t gproji_big_compare_sum(const gproji_big *a, const gproji_big *b, int32_t shift,
                                               const gproji_big *c) {
    gproji_big sum;
    uint64_t carry = 0;
    int32_t count = gproji_max(a->count, b->count), i;
    if (count < c->count - 1) return -1;
    for (i = 0; i < count; ++i) {
        if (i < a->count) carry += a->limb[i];
        if (i < b->count) carry += (uint64_t)b->limb[i] << shift;
        sum.limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    sum.count = count;
    if (carry) sum.limb[sum.count++] = (uint32_t)carry;
    return gproji_big_compare(&sum, c);
}

/* r = r mod s; returns floor(r / s). Needs r < 2^32 s and the highest bit of s's highest limb set (Knuth 1969, 4.3.1,
   algorithm D, one quotient digit: the estimate from the leading limbs is at most 2 too large). */
GPROJI_INTERNAL uint32_t gproji_big_divide(gproji_big *r, const gproji_big *s) {
    int32_t n = s->count, i;
    uint64_t q, product, carry = 0, borrow = 0, top;
    for (i = r->count; i <= n; ++i) r->limb[i] = 0;
    top = ((uint64_t)r->limb[n] << 32) | r->limb[n - 1];
    q = top / s->limb[n - 1];
    if (q > 0xffffffffu) q = 0xffffffffu;
    if (q) {
        for (i = 0; i <= n; ++i) { /* r -= q s, modulo 2^(32 (n + 1)) */
            product = carry + (i < n ? q * s->limb[i] : 0);
            carry = product >> 32;
            top = (uint64_t)r->limb[i] - (uint32_t)product - borrow;
            r->limb[i] = (uint32_t)top;
            borrow = (top >> 32) & 1;
        }
        while (borrow) { /* q was too large: r += s until it wraps back */
            --q;
            carry = 0;
            for (i = 0; i <= n; ++i) {
                carry += (uint64_t)r->limb[i] + (i < n ? s->limb[i] : 0);
                r->limb[i] = (uint32_t)carry;
                carry >>= 32;
            }
            if (carry) borrow = 0;
        }
    }
    r->count = n;
    while (r->count && !r->limb[r->count - 1]) --r->count;
    return (uint32_t)q;
}

GPROJI_INLINE double gproji_double_of_bits(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* (m + s) 2^exponent rounded to nearest even, where m has its highest bit set and 0 < s < 1 if sticky, else s = 0.
   Returns the bits of the double. */
GPROJI_INTERNAL uint64_t gproji_round_significand(uint64_t m, int32_t exponent, bool sticky) {
    int32_t drop = 11; /* bits of m below the last one kept */
    uint64_t kept, rest, half;
    if (exponent + 63 > 1023) return (uint64_t)0x7ff << 52;
    if (-1074 - exponent > drop) drop = -1074 - exponent;
    if (drop > 64) return 0;
    kept = drop == 64 ? 0 : m >> drop;
    rest = drop == 64 ? m : m & (((uint64_t)1 << drop) - 1);
    half = (uint64_t)1 << (drop - 1);
    if (drop == 11) kept += (uint64_t)(exponent + 63 + 1022) << 52; /* the leading bit of m adds the missing 1 */
    if (rest > half || (rest == half && (sticky || (kept & 1)))) kept++;
    return kept;
}

/* high 2^64 + low = a b */
GPROJI_INLINE uint64_t gproji_multiply_64(uint64_t a, uint64_t b, uint64_t *low) {
    uint64_t a0 = a & 0xffffffffu, a1 = a >> 32, b0 = b & 0xffffffffu, b1 = b >> 32;
    uint64_t p00 = a0 * b0, p01 = a0 * b1, p10 = a1 * b0;
    uint64_t middle = (p00 >> 32) + (p01 & 0xffffffffu) + (p10 & 0xffffffffu);
    *low = (middle << 32) | (p00 & 0xffffffffu);
    return a1 * b1 + (p01 >> 32) + (p10 >> 32) + (middle >> 32);
}

/* floor((high 2^64 + low) / d) for high < d, with d's highest bit set; two digits of 32 bits (Knuth 1969, 4.3.1). */
GPROJI_INTERNAL uint64_t gproji_divide_128(uint64_t high, uint64_t low, uint64_t d, uint64_t *remainder) {
    uint64_t d1 = d >> 32, d0 = d & 0xffffffffu, q = 0, estimate, rest, next;
    int32_t step;
    for (step = 0; step < 2; ++step) {
        next = step ? low & 0xffffffffu : low >> 32;
        estimate = high / d1;
        rest = high % d1;
        while (estimate >> 32 || estimate * d0 > ((rest << 32) | next)) {
            --estimate;
            rest += d1;
            if (rest >> 32) break;
        }
        high = ((high << 32) | next) - estimate * d; /* modulo 2^64; the true value is below d */
        q = (q << 32) | estimate;
    }
    *remainder = high;
    return q;
}

GPROJI_INLINE uint64_t gproji_power5_64(int32_t power) {
    uint64_t p = 1, base = 5;
    for (; power; power >>= 1) {
        if (power & 1) p *= base;
        base *= base; /* wraps after the last use for powers up to 27 */
    }
    return p;
}

/* The double nearest to w 10^power for w > 0 and |power| <= 27, where 5^|power| has 64 bits. */
GPROJI_INTERNAL uint64_t gproji_read_short(uint64_t w, int32_t power) {
    int32_t shift = 64 - gproji_bit_length(w), shift5;
    uint64_t five = gproji_power5_64(power < 0 ? -power : power), high, low;
    w <<= shift;
    shift5 = 64 - gproji_bit_length(five);
    five <<= shift5;
    if (power >= 0) { /* w 5^p, with 127 or 128 bits */
        high = gproji_multiply_64(w, five, &low);
        power += 64 - shift - shift5;
        if (!(high >> 63)) {
            high = (high << 1) | (low >> 63);
            low <<= 1;
            --power;
        }
        return gproji_round_significand(high, power, low != 0);
    }
    power += shift5 - shift - 64; /* w 2^64 / 5^p, halved where that would have 65 bits */
    if (w >= five) {
        high = gproji_divide_128(w >> 1, w << 63, five, &low);
        ++power;
    } else {
        high = gproji_divide_128(w, 0, five, &low);
    }
    return gproji_round_significand(high, power, low != 0);
}

/* The double nearest to 0.d1d2... 10^point, for `count` <= GPROJI_DIGITS_MAX digits of which the first is not 0. */
GPROJI_INTERNAL uint64_t gproji_read_long(const uint8_t *digit, int32_t count, int64_t point) {
    gproji_big a, b;
    uint64_t m;
    int32_t power, exponent, bits_a, bits_b, i;
    if (point > 310) return (uint64_t)0x7ff << 52; /* >= 10^310 */
    if (point < -330) return 0;
    /* 1. The value is a 10^power with an integer a, so a 2^power times or over b = 5^|power|. */
    gproji_big_set(&a, 0);
    for (i = 0; i < count; ++i) gproji_big_multiply(&a, 10, digit[i]);
    power = (int32_t)point - count;
    exponent = power;
    gproji_big_set(&b, 1);
    gproji_big_multiply_power5(power < 0 ? &b : &a, power < 0 ? -power : power);
    /* 2. Scale by powers of two: a and b get the same length, a whole number of limbs, and 1/2 <= a / b < 1. */
    bits_a = gproji_big_bits(&a);
    bits_b = gproji_big_bits(&b);
    i = (gproji_max(bits_a, bits_b) + 31) / 32 * 32;
    gproji_big_shift(&a, i - bits_a);
    gproji_big_shift(&b, i - bits_b);
    exponent += bits_a - bits_b;
    if (gproji_big_compare(&a, &b) >= 0) { /* doubling b would spoil its leading bit: subtract b for the leading 1 */
        gproji_big_divide(&a, &b);
        gproji_big_shift(&a, 31);
        m = (uint64_t)1 << 63 | (uint64_t)gproji_big_divide(&a, &b) << 32;
        exponent -= 63;
    } else {
        gproji_big_shift(&a, 32);
        m = (uint64_t)gproji_big_divide(&a, &b) << 32;
        exponent -= 64;
    }
    /* 3. The second half of the 64 bits, and whether anything is left. */
    gproji_big_shift(&a, 32);
    m |= gproji_big_divide(&a, &b);
    return gproji_round_significand(m, exponent, a.count != 0);
}

GPROJI_INLINE bool gproji_is_digit(char c) { return c >= '0' && c <= '9'; }

/* Does the text begin with this lower-case word, in any case? */
GPROJI_INTERNAL bool gproji_begins_with(const char *text, size_t size, const char *word) {
    size_t i;
    for (i = 0; word[i]; ++i) {
        if (i >= size || (text[i] != word[i] && text[i] != word[i] - 'a' + 'A')) return false;
    }
    return true;
}

/* What stands in a decimal text: 0.d1d2... 10^point, the digits without leading zeros. */
typedef struct gproji_decimal {
    uint8_t digit[GPROJI_DIGITS_MAX]; /* values 0..9 */
    int32_t count;
    uint64_t first; /* the first 19 digits as an integer */
    int64_t point;
    bool any;      /* there was a digit, maybe 0 */
    bool fraction; /* the decimal point has been seen */
} gproji_decimal;

GPROJI_INLINE void gproji_decimal_push(gproji_decimal *decimal, uint8_t digit) {
    decimal->any = true;
    if (!decimal->count && !digit) {
        if (decimal->fraction) --decimal->point;
        return;
    }
    if (!decimal->fraction) ++decimal->point;
    if (decimal->count < 19) decimal->first = decimal->first * 10 + digit;
    if (decimal->count < GPROJI_DIGITS_MAX) {
        decimal->digit[decimal->count++] = digit;
    } else if (digit) {
        decimal->digit[GPROJI_DIGITS_MAX - 1] |= 1; /* not 0, whatever follows: it can only break ties */
    }
}

/* Reads [e[+-]digits] at text[at..] and adds it to point; returns the position behind it, or `at`. */
GPROJI_INTERNAL size_t gproji_read_exponent(const char *text, size_t size, size_t at, int64_t *point) {
    size_t i = at;
    int64_t exponent = 0;
    bool negative = false;
    if (i >= size || (text[i] != 'e' && text[i] != 'E')) return at;
    ++i;
    if (i < size && (text[i] == '+' || text[i] == '-')) negative = text[i++] == '-';
    if (i >= size || !gproji_is_digit(text[i])) return at;
    for (; i < size && gproji_is_digit(text[i]); ++i) {
        if (exponent < INT64_C(100000000000000000)) exponent = exponent * 10 + (text[i] - '0');
    }
    *point += negative ? -exponent : exponent;
    return i;
}

GPROJ_API size_t gproj_number_read(const char *text, size_t size, double *value) {
    gproji_decimal decimal;
    size_t i = 0;
    uint64_t sign = 0, bits = 0;
    if (!text || !value) return 0;
    if (i < size && (text[i] == '+' || text[i] == '-')) sign = (uint64_t)(text[i++] == '-') << 63;
    if (gproji_begins_with(text + i, size - i, "inf") || gproji_begins_with(text + i, size - i, "nan")) {
        bool nan = text[i] == 'n' || text[i] == 'N';
        *value = gproji_double_of_bits(sign | (uint64_t)(nan ? 0xfff : 0xffe) << 51);
        return i + (gproji_begins_with(text + i, size - i, "infinity") ? 8 : 3);
    }
    decimal.count = 0, decimal.first = 0, decimal.point = 0, decimal.any = false, decimal.fraction = false;
    for (; i < size; ++i) {
        if (gproji_is_digit(text[i]))
            gproji_decimal_push(&decimal, (uint8_t)(text[i] - '0'));
        else if (text[i] == '.' && !decimal.fraction)
            decimal.fraction = true;
        else
            break;
    }
    if (!decimal.any) return 0;
    i = gproji_read_exponent(text, size, i, &decimal.point);
    if (decimal.count) {
        int64_t power = decimal.point - decimal.count;
        bool is_short = decimal.count <= 19 && power >= -27 && power <= 27;
        bits = is_short ? gproji_read_short(decimal.first, (int32_t)power)
                        : gproji_read_long(decimal.digit, decimal.count, decimal.point);
    }
    *value = gproji_double_of_bits(sign | bits);
    return i;
}

/* floor(log10(2^b)) for |b| < 1100; 1292913986 = floor(2^32 log10(2)). */
GPROJI_INLINE int32_t gproji_log10_of_power2(int32_t b) {
    int64_t product = (int64_t)b * 1292913986;
    return product >= 0 ? (int32_t)(product / INT64_C(4294967296)) : -(int32_t)((-product) / INT64_C(4294967296)) - 1;
}

/* The digits of v = fraction 2^exponent > 0: v is about 0.d1d2... 10^point. limit = 0: the fewest that round to v, the
   nearest to v among those; else `limit` of them, correctly rounded. Returns their number. */
GPROJI_INTERNAL int32_t gproji_write_digits(uint64_t fraction, int32_t exponent, int32_t limit, char digit[20],
                                            int32_t *point) {
    gproji_big r, s, m;
    int32_t up = fraction == (uint64_t)1 << 52 && exponent > -1074; /* the gap below is half of the gap above */
    int32_t k = gproji_log10_of_power2(exponent + gproji_bit_length(fraction) - 1) + 1;
    int32_t two_m = gproji_max(exponent, 0) + gproji_max(-k, 0);
    int32_t two_s = 1 + up + gproji_max(-exponent, 0) + gproji_max(k, 0);
    int32_t common = gproji_min(two_m, two_s), count = 0, side;
    bool even = !(fraction & 1), low = false, high = false;
    /* 1. v / 10^k = r / s in [0.1, 10); the gap to the next double is 2 (m / s) 2^up above and 2 m / s below. */
    gproji_big_set(&r, fraction);
    gproji_big_set(&s, 1);
    gproji_big_set(&m, 1);
    gproji_big_multiply_power5(&s, gproji_max(k, 0));
    gproji_big_multiply_power5(&r, gproji_max(-k, 0));
    gproji_big_multiply_power5(&m, gproji_max(-k, 0));
    two_m -= common, two_s -= common;
    side = (32 - (gproji_big_bits(&s) + two_s) % 32) % 32; /* fills the highest limb of s */
    gproji_big_shift(&s, two_s + side);
    gproji_big_shift(&r, two_m + 1 + up + side);
    gproji_big_shift(&m, two_m + side);
    /* 2. Is it in [1, 10) already (for the shortest text: once rounded up)? */
    side = limit ? gproji_big_compare(&r, &s) : gproji_big_compare_sum(&r, &m, up, &s);
    *point = k + 1;
    if (side < 0 || (side == 0 && !limit && !even)) {
        *point = k;
        gproji_big_multiply(&r, 10, 0);
        gproji_big_multiply(&m, 10, 0);
    }
    /* 3. Digit by digit. */
    for (;;) {
        digit[count++] = (char)('0' + (int)gproji_big_divide(&r, &s));
        if (limit) {
            if (count == limit) break;
        } else {
            int32_t below = gproji_big_compare(&r, &m), above = gproji_big_compare_sum(&r, &m, up, &s);
            low = below < 0 || (below == 0 && even);
            high = above > 0 || (above == 0 && even);
            if (low || high) break;
            gproji_big_multiply(&m, 10, 0);
        }
        gproji_big_multiply(&r, 10, 0);
    }
    /* 4. The last digit: up if more than half is left, or half and that makes it even. */
    side = gproji_big_compare_sum(&r, &r, 0, &s);
    if (high && !low) side = 1;
    if (low && !high) side = -1;
    if (side > 0 || (side == 0 && (digit[count - 1] & 1))) {
        int32_t i = count - 1;
        while (i >= 0 && digit[i] == '9') digit[i--] = '0';
        if (i < 0) {
            digit[0] = '1';
            ++*point;
        } else {
            ++digit[i];
        }
    }
    while (count > 1 && digit[count - 1] == '0') --count;
    return count;
}

/* Lays digits out as printf's %g does: with an exponent where it is below -4 or not below `precision`. */
GPROJI_INTERNAL size_t gproji_layout_digits(const char *digit, int32_t count, int32_t point, int32_t precision,
                                            char *text) {
    int32_t exponent = point - 1, i;
    char *at = text;
    if (exponent < -4 || exponent >= precision) {
        *at++ = digit[0];
        if (count > 1) *at++ = '.';
        for (i = 1; i < count; ++i) *at++ = digit[i];
        *at++ = 'e';
        *at++ = exponent < 0 ? '-' : '+';
        if (exponent < 0) exponent = -exponent;
        if (exponent >= 100) *at++ = (char)('0' + exponent / 100);
        *at++ = (char)('0' + exponent / 10 % 10);
        *at++ = (char)('0' + exponent % 10);
    } else {
        if (point <= 0) *at++ = '0', *at++ = '.';
        for (i = point; i < 0; ++i) *at++ = '0';
        for (i = 0; i < count; ++i) {
            if (i == point && i > 0) *at++ = '.';
            *at++ = digit[i];
        }
        for (; i < point; ++i) *at++ = '0';
    }
    *at = 0;
    return (size_t)(at - text);
}

/* digits = 0: the shortest text that reads back to the same bits; 1..17: rounded to that many significant digits. */
GPROJI_INTERNAL size_t gproji_number_write_digits(double value, int32_t digits, char text[GPROJ_NUMBER_SIZE]) {
    char digit[20];
    uint64_t bits, fraction;
    int32_t exponent, count, point;
    size_t sign = 0;
    memcpy(&bits, &value, sizeof bits);
    exponent = (int32_t)((bits >> 52) & 0x7ff);
    fraction = bits & (((uint64_t)1 << 52) - 1);
    if (exponent == 0x7ff && fraction) {
        memcpy(text, "nan", 4);
        return 3;
    }
    if (bits >> 63) text[sign++] = '-';
    if (exponent == 0x7ff) {
        memcpy(text + sign, "inf", 4);
        return sign + 3;
    }
    if (!exponent && !fraction) {
        memcpy(text + sign, "0", 2);
        return sign + 1;
    }
    if (exponent) fraction |= (uint64_t)1 << 52;
    exponent = exponent ? exponent - 1075 : -1074;
    count = gproji_write_digits(fraction, exponent, digits, digit, &point);
    return sign + gproji_layout_digits(digit, count, point, digits ? digits : 17, text + sign);
}

GPROJ_API size_t gproj_number_write(double value, char text[GPROJ_NUMBER_SIZE]) {
    return gproji_number_write_digits(value, 0, text);
}

/* ============================================================================================================
   >>memory   The host's allocator with accounts. Uses platform.

   Every object has one gproji_heap and takes all its memory from it; parts of an object use their owner's heap.
   Sizes are counts times element sizes, checked for overflow here and nowhere else. A block is given back with
   the same count and size it was taken with. A count of 0 gives a valid block. */
typedef struct gproji_heap {
    gproj_allocator hook;
    gproj_memory account;
} gproji_heap;

GPROJI_INTERNAL void *gproji_malloc(void *user, size_t size) {
    (void)user;
    return malloc(size);
}

GPROJI_INTERNAL void *gproji_realloc(void *user, void *block, size_t old_size, size_t new_size) {
    (void)user;
    (void)old_size;
    return realloc(block, new_size);
}

GPROJI_INTERNAL void gproji_free(void *user, void *block, size_t size) {
    (void)user;
    (void)size;
    free(block);
}

GPROJI_INTERNAL gproji_heap gproji_heap_of(const gproj_host *host) {
    gproji_heap heap;
    memset(&heap, 0, sizeof heap);
    if (host) heap.hook = host->allocator;
    if (!heap.hook.allocate) {
        heap.hook.allocate = gproji_malloc;
        heap.hook.reallocate = gproji_realloc;
        heap.hook.release = gproji_free;
    }
    return heap;
}

/* count * size, at least 1; SIZE_MAX where that overflows (no allocator grants it: see gproji_grant). */
GPROJI_INTERNAL size_t gproji_bytes(size_t count, size_t size) {
    if (count > (SIZE_MAX / 2) / size) return SIZE_MAX;
    return count ? count * size : size;
}

/* May the heap hold `more` bytes in place of `less` of those it has? */
GPROJI_INTERNAL bool gproji_grant(const gproji_heap *heap, size_t less, size_t more) {
    size_t held = heap->account.used - less;
    if (more > SIZE_MAX / 2 || held > SIZE_MAX / 2) return false;
    return heap->hook.limit == 0 || held + more <= heap->hook.limit;
}

GPROJI_INTERNAL void gproji_account(gproji_heap *heap, size_t less, size_t more) {
    heap->account.used = heap->account.used - less + more;
    if (heap->account.used > heap->account.peak) heap->account.peak = heap->account.used;
}

/* NULL when there is no memory. The contents are undefined. */
GPROJI_INTERNAL void *gproji_take(gproji_heap *heap, size_t count, size_t size) {
    size_t bytes = gproji_bytes(count, size);
    void *block;
    heap->account.allocations++;
    if (!gproji_grant(heap, 0, bytes)) return NULL;
    block = heap->hook.allocate(heap->hook.user, bytes);
    if (block) gproji_account(heap, 0, bytes);
    return block;
}

GPROJI_INTERNAL void *gproji_take_zeroed(gproji_heap *heap, size_t count, size_t size) {
    void *block = gproji_take(heap, count, size);
    if (block) memset(block, 0, count * size);
    return block;
}

/* Gives a block back; NULL is allowed. */
GPROJI_INTERNAL void gproji_give(gproji_heap *heap, void *block, size_t count, size_t size) {
    size_t bytes = gproji_bytes(count, size);
    if (!block) return;
    gproji_account(heap, bytes, 0);
    if (heap->hook.release) heap->hook.release(heap->hook.user, block, bytes);
}

/* Changes a block's count and keeps what fits; `block` may be NULL with old_count 0. On failure returns NULL and the
   old block stays as it is. */
GPROJI_INTERNAL void *gproji_retake(gproji_heap *heap, void *block, size_t old_count, size_t new_count, size_t size) {
    size_t old_bytes = gproji_bytes(old_count, size), new_bytes = gproji_bytes(new_count, size);
    void *moved;
    if (!block) return gproji_take(heap, new_count, size);
    if (!heap->hook.reallocate) {
        moved = gproji_take(heap, new_count, size);
        if (!moved) return NULL;
        memcpy(moved, block, old_bytes < new_bytes ? old_bytes : new_bytes);
        gproji_give(heap, block, old_count, size);
        return moved;
    }
    heap->account.allocations++;
    if (!gproji_grant(heap, old_bytes, new_bytes)) return NULL;
    moved = heap->hook.reallocate(heap->hook.user, block, old_bytes, new_bytes);
    if (moved) gproji_account(heap, old_bytes, new_bytes);
    return moved;
}

/* Makes room in a growing array: *block has *capacity elements, `needed` are wanted. Doubles, so that n additions cost
   O(n). False when there is no memory; the array is then unchanged. */
GPROJI_INTERNAL bool gproji_reserve(gproji_heap *heap, void **block, size_t *capacity, size_t needed, size_t size) {
    size_t wanted = *capacity < 8 ? 8 : *capacity * 2;
    void *moved;
    if (needed <= *capacity) return true;
    if (wanted < needed) wanted = needed;
    moved = gproji_retake(heap, *block, *block ? *capacity : 0, wanted, size);
    if (!moved) return false;
    *block = moved;
    *capacity = wanted;
    return true;
}

/* An object's own memory: its struct is taken from the heap that it then carries. The heap's struct must be the
   object's first member. */
GPROJI_INTERNAL void *gproji_create_object(const gproj_host *host, size_t size) {
    gproji_heap heap = gproji_heap_of(host);
    void *object = gproji_take_zeroed(&heap, 1, size);
    if (object) memcpy(object, &heap, sizeof heap);
    return object;
}

GPROJI_INTERNAL void gproji_destroy_object(void *object, size_t size) {
    gproji_heap heap;
    memcpy(&heap, object, sizeof heap);
    gproji_give(&heap, object, 1, size);
}

/* The accounts of an object and its parts, added up. The peak is that of the parts, as if they came together. */
GPROJI_INTERNAL void gproji_add_memory(gproj_memory *sum, gproj_memory part) {
    sum->used += part.used;
    sum->peak += part.peak;
    sum->allocations += part.allocations;
}

/* -- pools -- */

/* A pool holds the blocks of one piece of work, all given back by one call. */
enum {
    GPROJI_POOL_BLOCKS = 48
};
typedef struct gproji_pool {
    gproji_heap *heap;
    int32_t count;
    void *block[GPROJI_POOL_BLOCKS];
    size_t bytes[GPROJI_POOL_BLOCKS];
} gproji_pool;

GPROJI_INTERNAL void gproji_pool_start(gproji_pool *pool, gproji_heap *heap) {
    pool->heap = heap;
    pool->count = 0;
}

GPROJI_INTERNAL void gproji_pool_give_all(gproji_pool *pool) {
    while (pool->count > 0) {
        pool->count--;
        gproji_give(pool->heap, pool->block[pool->count], pool->bytes[pool->count], 1);
    }
}

/* NULL when there is no memory, also where the count is negative or too large for the address space. */
GPROJI_INTERNAL void *gproji_pool_take(gproji_pool *pool, int64_t count, size_t size) {
    size_t bytes;
    void *block;
    GPROJ_ASSERT(pool->count < GPROJI_POOL_BLOCKS);
    if (count < 0 || (uint64_t)count > SIZE_MAX / 2 / size) return NULL;
    bytes = gproji_bytes((size_t)count, size);
    block = gproji_take(pool->heap, bytes, 1);
    if (!block) return NULL;
    pool->block[pool->count] = block;
    pool->bytes[pool->count++] = bytes;
    return block;
}

GPROJI_INTERNAL void *gproji_pool_take_zeroed(gproji_pool *pool, int64_t count, size_t size) {
    void *block = gproji_pool_take(pool, count, size);
    if (block) memset(block, 0, pool->bytes[pool->count - 1]);
    return block;
}

/* ============================================================================================================
   >>error   One door for all failures. Uses platform, number. */

GPROJ_API const char *gproj_code_string(gproj_code code) {
    static const char *const sentences[] = {
#define GPROJ_X(name, sentence) sentence,
        GPROJ_CODES(GPROJ_X)
#undef GPROJ_X
    };
    int32_t index = (int32_t)code, count = (int32_t)(sizeof sentences / sizeof sentences[0]);
    return index >= 0 && index < count ? sentences[index] : "unknown error";
}

/* Appends to a text that stays NUL-terminated; what does not fit is cut. Returns the new length. */
GPROJI_INTERNAL size_t gproji_append(char *text, size_t size, size_t length, const char *piece, size_t piece_length) {
    size_t room = size - 1 - length;
    if (piece_length > room) piece_length = room;
    memcpy(text + length, piece, piece_length);
    text[length + piece_length] = 0;
    return length + piece_length;
}

GPROJI_INTERNAL size_t gproji_append_integer(char *text, size_t size, size_t length, int64_t value) {
    char digits[24];
    size_t at = sizeof digits;
    uint64_t rest = value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
    do {
        digits[--at] = (char)('0' + rest % 10);
        rest /= 10;
    } while (rest);
    if (value < 0) digits[--at] = '-';
    return gproji_append(text, size, length, digits + at, sizeof digits - at);
}

/* Writes a sentence: %s text, %d int32_t, %l int64_t, %g double with 3 digits, %% the sign. No locale, no stdio. */
GPROJI_INTERNAL void gproji_format_list(char *text, size_t size, const char *format, va_list list) {
    size_t length = 0;
    text[0] = 0;
    for (; *format; ++format) {
        if (*format != '%') {
            length = gproji_append(text, size, length, format, 1);
            continue;
        }
        ++format;
        switch (*format) {
        case 's': {
            const char *piece = va_arg(list, const char *);
            length = gproji_append(text, size, length, piece, strlen(piece));
            break;
        }
        case 'd': length = gproji_append_integer(text, size, length, va_arg(list, int32_t)); break;
        case 'l': length = gproji_append_integer(text, size, length, va_arg(list, int64_t)); break;
        case 'g': {
            char number[GPROJ_NUMBER_SIZE];
            size_t digits = gproji_number_write_digits(va_arg(list, double), 3, number);
            length = gproji_append(text, size, length, number, digits);
            break;
        }
        default: length = gproji_append(text, size, length, format, 1); break;
        }
    }
}

GPROJI_INTERNAL void gproji_format(char *text, size_t size, const char *format, ...) {
    va_list list;
    va_start(list, format);
    gproji_format_list(text, size, format, list);
    va_end(list);
}

/* Every failure of the library passes through here: a place for a breakpoint. The first error stays. `error` may be
   NULL. Returns the code. */
GPROJI_INTERNAL gproj_code gproji_fail(gproj_error *error, gproj_code code, gproj_place place, int64_t index,
                                       const char *format, ...) {
    va_list list;
    if (!error || error->code != GPROJ_OK) return code;
    error->code = code;
    error->place = place;
    error->index = index;
    va_start(list, format);
    gproji_format_list(error->message, sizeof error->message, format, list);
    va_end(list);
    return code;
}

GPROJI_INTERNAL gproj_code gproji_fail_memory(gproj_error *error) {
    return gproji_fail(error, GPROJ_ERROR_MEMORY, GPROJ_PLACE_NONE, -1, "out of memory");
}

GPROJI_INTERNAL void gproji_error_clear(gproj_error *error) {
    if (!error) return;
    memset(error, 0, sizeof *error);
    error->index = -1;
}

/* ============================================================================================================
   >>parallel   The host's threads. Uses platform. */

GPROJI_INTERNAL void gproji_for(const gproj_parallel *parallel, int32_t count, gproj_task task, void *data) {
    int32_t i;
    if (parallel->run && count > 1) {
        parallel->run(parallel->user, count, task, data);
        return;
    }
    for (i = 0; i < count; ++i) task(data, i);
}

/* The first item of chunk `chunk` when `items` are cut into `chunks`; chunk `chunks` gives the end. */
GPROJI_INTERNAL int32_t gproji_chunk_start(int32_t items, int32_t chunks, int32_t chunk) {
    return (int32_t)((int64_t)items * chunk / chunks);
}

/* ============================================================================================================
   >>vector   3-vectors and symmetric 3x3 matrices. Uses platform. */

GPROJI_INLINE void gproji_copy3(const double a[3], double out[3]) { out[0] = a[0], out[1] = a[1], out[2] = a[2]; }
GPROJI_INLINE void gproji_set3(double x, double y, double z, double out[3]) { out[0] = x, out[1] = y, out[2] = z; }
GPROJI_INLINE void gproji_sub3(const double a[3], const double b[3], double out[3]) {
    out[0] = a[0] - b[0], out[1] = a[1] - b[1], out[2] = a[2] - b[2];
}
/* out += s a */
GPROJI_INLINE void gproji_add_scaled3(double s, const double a[3], double out[3]) {
    out[0] += s * a[0], out[1] += s * a[1], out[2] += s * a[2];
}
GPROJI_INLINE double gproji_dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
GPROJI_INLINE double gproji_length3(const double a[3]) { return sqrt(gproji_dot3(a, a)); }
GPROJI_INLINE double gproji_distance3(const double a[3], const double b[3]) {
    double d[3];
    gproji_sub3(a, b, d);
    return gproji_length3(d);
}
GPROJI_INLINE void gproji_cross3(const double a[3], const double b[3], double out[3]) {
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    out[0] = x, out[1] = y, out[2] = z;
}
/* Makes a vector unit; a vector too short to have a direction becomes `fallback`. False then. */
GPROJI_INTERNAL bool gproji_normalise3(double a[3], const double fallback[3]) {
    double length = gproji_length3(a);
    if (!(length > 1e-150)) {
        gproji_copy3(fallback, a);
        return false;
    }
    a[0] /= length, a[1] /= length, a[2] /= length;
    return true;
}

/* Two unit vectors that complete a unit vector n to a right-handed orthonormal basis u, v, n. They are a continuous
   function of n away from n = -e_z (Frisvad 2012, in the form of Duff et al. 2017 without its jump at n_z = 0 being
   of any consequence here: all users are invariant under rotations in the plane of u and v). */
GPROJI_INTERNAL void gproji_tangents3(const double n[3], double u[3], double v[3]) {
    double sign = n[2] < 0 ? -1.0 : 1.0, a = -1.0 / (sign + n[2]), b = n[0] * n[1] * a;
    gproji_set3(1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0], u);
    gproji_set3(b, sign + n[1] * n[1] * a, -n[1], v);
}

GPROJI_INTERNAL double gproji_dot(const double *a, const double *b, size_t count) {
    double sum = 0;
    size_t i;
    for (i = 0; i < count; ++i) sum += a[i] * b[i];
    return sum;
}

/* A sum with twice the digits (Dekker 1971): high + low. Under -ffast-math it has the usual ones. */
typedef struct gproji_sum {
    double high, low;
} gproji_sum;

GPROJI_INLINE void gproji_sum_add(gproji_sum *s, double x) {
    double total = s->high + x, part = total - s->high;
    s->low += (s->high - (total - part)) + (x - part);
    s->high = total;
}

/* += a b, for |a|, |b| < 1e100. */
GPROJI_INLINE void gproji_sum_add_product(gproji_sum *s, double a, double b) {
    double p = a * b, ca = 134217729.0 * a, cb = 134217729.0 * b; /* 2^27 + 1 splits a double into halves */
    double ah = ca - (ca - a), al = a - ah, bh = cb - (cb - b), bl = b - bh;
    s->low += ((ah * bh - p) + ah * bl + al * bh) + al * bl;
    gproji_sum_add(s, p);
}

GPROJI_INLINE double gproji_sum_value(const gproji_sum *s) { return s->high + s->low; }

/* ============================================================================================================
   >>kernels   Small tiles kept in registers, once for each kind of vector unit. Uses platform.

   Matrices are column-major. A tile is one to three times `block` rows by `block` columns; it stays in registers while
   the product of two strips is subtracted from it (Goto, van de Geijn 2008). No kernel needs a masked edge: see >>dense
   for how matrices are padded. A tile of diagonal entries may begin with `skip` < block columns that do not exist: its
   first column in memory is number `skip`, so that pivot j always stands in row j. The rows of such columns are 0.

   The text of the kernels is macros, compiled for each kind of unit: L numbers in a vector, B = `block`. In the scalar
   kind a vector is a double. A kind's kernels stand in a constant table. On x86-64, where compilers build for the
   oldest processor unless told otherwise, several kinds are compiled and gproji_kernels_of asks the processor, once for
   an object; elsewhere the compiler's target decides.

   Invariant: an entry is computed by the same operations in the same order in tiles of all heights. */

/* Some rows of a matrix, from row `from` on, and where they go in another one. Without gaps: to row `to` and the
   following. With gaps: to those of the 8 rows from `to` on, a multiple of 8, whose bit in `mask` is set. */
typedef struct gproji_piece {
    int32_t from, rows, to;
    uint32_t mask;
} gproji_piece;

typedef struct gproji_kernels {
    const char *name;
    int32_t block;
    int32_t tile_rows; /* of the tallest tile */
    bool spreads;      /* the pieces of `add` have gaps */
    /* C -= A B': `rows` rows (a multiple of block) by block columns; A has k columns and the rows of C, B has k columns
       and block rows. */
    void (*update)(int32_t rows, int32_t k, const double *a, ptrdiff_t lda, const double *b, ptrdiff_t ldb, double *c,
                   ptrdiff_t ldc);
    /* C = (C - A B') L^-T in the same way, with the tile L on the diagonal (stride ldc like C) and the inverses of its
       diagonal. C, L and the inverses begin with column `skip`; where that is not 0, k = 0. */
    void (*solve)(int32_t rows, int32_t k, const double *a, ptrdiff_t lda, const double *b, ptrdiff_t ldb, double *c,
                  ptrdiff_t ldc, const double *triangle, const double *inverse, int32_t skip);
    /* Cholesky of a tile on the diagonal, in place. Writes the inverses of the diagonal. Returns -1, or the first
       column (from 0 for `skip`) whose pivot is not > 0 (also NaN; an infinite one counts as that). */
    int32_t (*factor)(double *tile, ptrdiff_t stride, double *inverse, int32_t skip);
    /* One column block of the solutions of L y = b and L' x = y: z[0..block) become the unknowns, and go into, or
       come from, the other rows up to `rows` (a multiple of block). */
    void (*forward)(int32_t rows, const double *l, ptrdiff_t stride, const double *inverse, int32_t skip, double *z);
    void (*backward)(int32_t rows, const double *l, ptrdiff_t stride, const double *inverse, int32_t skip, double *z);
    /* Adds columns of which only the lower triangle counts: those that belong to the rows first..last-1 (counted from
       0) of piece[0], all their rows from there on in piece[0..count). `source` points to row 0 of the first column,
       `target` to row 0 of the column that belongs to row piece[0].to. */
    void (*add)(const gproji_piece *piece, int32_t count, int32_t first, int32_t last, const double *source,
                ptrdiff_t source_stride, double *target, ptrdiff_t target_stride);
} gproji_kernels;

/* The kinds that are compiled, the best first, and when this processor has them. GPROJI_BLOCK is the multiple to which
   matrices are padded: in x86-64 the same for all kinds. */
#if !GPROJI_SIMD || (defined(__i386__) && !defined(__SSE2_MATH__)) /* x87 has no vectors */
#define GPROJI_KINDS(X) X(scalar, true)
#define GPROJI_KIND_SCALAR
#elif defined(__x86_64__) && defined(__AVX512F__)
#define GPROJI_KINDS(X) X(avx512, true)
#define GPROJI_KIND_AVX512
#elif defined(__x86_64__) && defined(__AVX2__) && defined(__FMA__) && GPROJI_CHOICE
#define GPROJI_KINDS(X) X(avx512, units.avx512) X(avx2, true)
#define GPROJI_KIND_AVX512
#define GPROJI_KIND_AVX2
#elif defined(__x86_64__) && defined(__AVX2__) && defined(__FMA__)
#define GPROJI_KINDS(X) X(avx2, true)
#define GPROJI_KIND_AVX2
#elif GPROJI_CHOICE
#define GPROJI_KINDS(X) X(avx512, units.avx512) X(avx2, units.avx2) X(two, true)
#define GPROJI_KIND_AVX512
#define GPROJI_KIND_AVX2
#define GPROJI_KIND_TWO
#else
#define GPROJI_KINDS(X) X(two, true)
#define GPROJI_KIND_TWO
#endif
#if GPROJI_SIMD && defined(__x86_64__)
#define GPROJI_BLOCK 8
#else
#define GPROJI_BLOCK 4
#endif

/* Vectors, and the same in memory: aligned like a double only. */
typedef double gproji_lanes_1, gproji_lanes_at_1;
#if GPROJI_SIMD
typedef double gproji_lanes_2 __attribute__((vector_size(16)));
typedef double gproji_lanes_4 __attribute__((vector_size(32)));
typedef double gproji_lanes_8 __attribute__((vector_size(64)));
typedef double gproji_lanes_at_2 __attribute__((vector_size(16), aligned(8), may_alias));
typedef double gproji_lanes_at_4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef double gproji_lanes_at_8 __attribute__((vector_size(64), aligned(8), may_alias));
#endif

/* A kernel is compiled for its kind of unit, never inlined elsewhere, and may fuse multiplication and addition. It
   begins with GPROJI_BEGIN, which says what a vector is. */
#if defined(__clang__)
#define GPROJI_KERNEL(target) __attribute__((noinline, unused GPROJI_TARGET_##target)) static
#define GPROJI_TARGET_avx512 , target("avx512f,avx2,fma"), min_vector_width(512)
#define GPROJI_FUSE _Pragma("clang fp contract(fast)")
#elif GPROJI_SIMD
#define GPROJI_KERNEL(target) \
    __attribute__((noinline, unused, optimize("fp-contract=fast") GPROJI_TARGET_##target)) static
#define GPROJI_TARGET_avx512 , target("avx512f,avx2,fma")
#define GPROJI_FUSE
#else
#define GPROJI_KERNEL(target) GPROJI_INTERNAL
#define GPROJI_FUSE
#endif
#define GPROJI_TARGET_avx2 , target("avx2,fma")
#define GPROJI_TARGET_two
#define GPROJI_TARGET_scalar
/* clang-format off */
#define GPROJI_BEGIN(L)                                                                                                \
    GPROJI_FUSE                                                                                                        \
    typedef gproji_lanes_##L lanes;                                                                                    \
    typedef gproji_lanes_at_##L lanes_at;                                                                              \
    enum { LANES = L };
#define GPROJI_LOAD(p) (*(const lanes_at *)(const void *)(p))
#define GPROJI_STORE(p, v) (*(lanes_at *)(void *)(p) = (v))

/* The loops over a tile are written out, because compilers keep it in registers only when every element of it is a
   variable of its own: tile_r_j is vector r of column j. Vectors 0..T-1 of column j: */
#define GPROJI_ROWS_1(X, j) X(0, j)
#define GPROJI_ROWS_2(X, j) X(0, j) X(1, j)
#define GPROJI_ROWS_3(X, j) X(0, j) X(1, j) X(2, j)
#define GPROJI_ROWS_4(X, j) X(0, j) X(1, j) X(2, j) X(3, j)
#define GPROJI_PAIRS_1(X, i, j) X(0, i, j)
#define GPROJI_PAIRS_2(X, i, j) X(0, i, j) X(1, i, j)
#define GPROJI_PAIRS_3(X, i, j) X(0, i, j) X(1, i, j) X(2, i, j)
#define GPROJI_PAIRS_4(X, i, j) X(0, i, j) X(1, i, j) X(2, i, j) X(3, i, j)

/* all columns; all that exist; the order of a forward substitution, in which S(j) finishes column j and E(i, j) takes
   it from column i; and that of a backward one */
#define GPROJI_COLUMNS_4(R, X) R(X, 0) R(X, 1) R(X, 2) R(X, 3)
#define GPROJI_COLUMNS_8(R, X) GPROJI_COLUMNS_4(R, X) R(X, 4) R(X, 5) R(X, 6) R(X, 7)
#define GPROJI_EXISTS(j, text) if (skip <= (j)) { text }
#define GPROJI_EXISTING_4(R, X)                                                                                        \
    GPROJI_EXISTS(0, R(X, 0)) GPROJI_EXISTS(1, R(X, 1)) GPROJI_EXISTS(2, R(X, 2)) GPROJI_EXISTS(3, R(X, 3))
#define GPROJI_EXISTING_8(R, X) GPROJI_EXISTING_4(R, X)                                                                \
    GPROJI_EXISTS(4, R(X, 4)) GPROJI_EXISTS(5, R(X, 5)) GPROJI_EXISTS(6, R(X, 6)) GPROJI_EXISTS(7, R(X, 7))
#define GPROJI_FORWARD_4(R, P, S, E)                                                                                   \
    GPROJI_EXISTS(0, R(S, 0) P(E, 1, 0) P(E, 2, 0) P(E, 3, 0)) GPROJI_EXISTS(1, R(S, 1) P(E, 2, 1) P(E, 3, 1))         \
    GPROJI_EXISTS(2, R(S, 2) P(E, 3, 2)) R(S, 3)
#define GPROJI_FORWARD_8(R, P, S, E)                                                                                   \
    GPROJI_EXISTS(0, R(S, 0) P(E, 1, 0) P(E, 2, 0) P(E, 3, 0) P(E, 4, 0) P(E, 5, 0) P(E, 6, 0) P(E, 7, 0))             \
    GPROJI_EXISTS(1, R(S, 1) P(E, 2, 1) P(E, 3, 1) P(E, 4, 1) P(E, 5, 1) P(E, 6, 1) P(E, 7, 1))                        \
    GPROJI_EXISTS(2, R(S, 2) P(E, 3, 2) P(E, 4, 2) P(E, 5, 2) P(E, 6, 2) P(E, 7, 2))                                   \
    GPROJI_EXISTS(3, R(S, 3) P(E, 4, 3) P(E, 5, 3) P(E, 6, 3) P(E, 7, 3))                                              \
    GPROJI_EXISTS(4, R(S, 4) P(E, 5, 4) P(E, 6, 4) P(E, 7, 4)) GPROJI_EXISTS(5, R(S, 5) P(E, 6, 5) P(E, 7, 5))         \
    GPROJI_EXISTS(6, R(S, 6) P(E, 7, 6)) R(S, 7)
#define GPROJI_BACKWARD_4(R, P, S, E)                                                                                  \
    GPROJI_EXISTS(3, R(S, 3) P(E, 2, 3) P(E, 1, 3) P(E, 0, 3)) GPROJI_EXISTS(2, R(S, 2) P(E, 1, 2) P(E, 0, 2))         \
    GPROJI_EXISTS(1, R(S, 1) P(E, 0, 1)) GPROJI_EXISTS(0, R(S, 0))
#define GPROJI_BACKWARD_8(R, P, S, E)                                                                                  \
    R(S, 7) P(E, 6, 7) P(E, 5, 7) P(E, 4, 7) P(E, 3, 7) P(E, 2, 7) P(E, 1, 7) P(E, 0, 7)                               \
    GPROJI_EXISTS(6, R(S, 6) P(E, 5, 6) P(E, 4, 6) P(E, 3, 6) P(E, 2, 6) P(E, 1, 6) P(E, 0, 6))                        \
    GPROJI_EXISTS(5, R(S, 5) P(E, 4, 5) P(E, 3, 5) P(E, 2, 5) P(E, 1, 5) P(E, 0, 5))                                   \
    GPROJI_EXISTS(4, R(S, 4) P(E, 3, 4) P(E, 2, 4) P(E, 1, 4) P(E, 0, 4)) GPROJI_BACKWARD_4(R, P, S, E)

#define GPROJI_TILE_DECLARE(r, j) lanes tile_##r##_##j = zero;
#define GPROJI_TILE_LOAD_A(r, j) const lanes a_##r = GPROJI_LOAD(a + (r) * LANES);
#define GPROJI_TILE_MULTIPLY(r, j) tile_##r##_##j -= a_##r * b[j];
#define GPROJI_TILE_ADD(r, j) tile_##r##_##j += GPROJI_LOAD(c + (r) * LANES + ((j) - skip) * ldc);
#define GPROJI_TILE_PUT(r, j) GPROJI_STORE(c + (r) * LANES + ((j) - skip) * ldc, tile_##r##_##j);
#define GPROJI_TILE_SCALE(r, j) tile_##r##_##j *= inverse[(j) - skip];
#define GPROJI_TILE_ELIMINATE(r, i, j) tile_##r##_##i -= tile_##r##_##j * triangle[(i) + ((j) - skip) * ldc];

/* A tile of T vectors by B columns: see `update` and `solve`. */
#define GPROJI_DEFINE_TILE(kind, L, B, T)                                                                              \
    GPROJI_KERNEL(kind) void gproji_update_##T##_##kind(int32_t k, const double *a, ptrdiff_t lda, const double *b,    \
                                                        ptrdiff_t ldb, double *c, ptrdiff_t ldc) {                     \
        GPROJI_BEGIN(L)                                                                                                \
        enum { skip = 0 };                                                                                             \
        const lanes zero = {0};                                                                                        \
        GPROJI_COLUMNS_##B(GPROJI_ROWS_##T, GPROJI_TILE_DECLARE)                                                       \
        for (; k > 0; --k, a += lda, b += ldb) {                                                                       \
            GPROJI_ROWS_##T(GPROJI_TILE_LOAD_A, 0)                                                                     \
            GPROJI_COLUMNS_##B(GPROJI_ROWS_##T, GPROJI_TILE_MULTIPLY)                                                  \
        }                                                                                                              \
        GPROJI_COLUMNS_##B(GPROJI_ROWS_##T, GPROJI_TILE_ADD)                                                           \
        GPROJI_COLUMNS_##B(GPROJI_ROWS_##T, GPROJI_TILE_PUT)                                                           \
    }                                                                                                                  \
    GPROJI_KERNEL(kind) void gproji_solve_##T##_##kind(                                                                \
        int32_t k, const double *a, ptrdiff_t lda, const double *b, ptrdiff_t ldb, double *c, ptrdiff_t ldc,           \
        const double *triangle, const double *inverse, int32_t skip) {                                                 \
        GPROJI_BEGIN(L)                                                                                                \
        const lanes zero = {0};                                                                                        \
        GPROJI_COLUMNS_##B(GPROJI_ROWS_##T, GPROJI_TILE_DECLARE)                                                       \
        for (; k > 0; --k, a += lda, b += ldb) {                                                                       \
            GPROJI_ROWS_##T(GPROJI_TILE_LOAD_A, 0)                                                                     \
            GPROJI_COLUMNS_##B(GPROJI_ROWS_##T, GPROJI_TILE_MULTIPLY)                                                  \
        }                                                                                                              \
        GPROJI_EXISTING_##B(GPROJI_ROWS_##T, GPROJI_TILE_ADD)                                                          \
        GPROJI_FORWARD_##B(GPROJI_ROWS_##T, GPROJI_PAIRS_##T, GPROJI_TILE_SCALE, GPROJI_TILE_ELIMINATE)                \
        GPROJI_EXISTING_##B(GPROJI_ROWS_##T, GPROJI_TILE_PUT)                                                          \
    }

/* See `factor`. The pivots come from a chain as short as possible, 1 / pivot -> factor -> next pivot; the square roots
   are beside it. */
#define GPROJI_DEFINE_FACTOR(kind, L, B)                                                                               \
    GPROJI_KERNEL(kind) int32_t gproji_factor_##kind(double *tile, ptrdiff_t stride, double *inverse, int32_t skip) {  \
        GPROJI_BEGIN(L)                                                                                                \
        double *column = tile, pivot = tile[skip];                                                                     \
        int32_t j, k, r;                                                                                               \
        for (j = skip; j < B; ++j, column += stride) {                                                                 \
            double *later = column + stride, reciprocal, root, scale;                                                  \
            if (!(pivot > 0) || !gproji_is_finite(pivot)) return j - skip;                                             \
            reciprocal = 1.0 / pivot, root = sqrt(pivot), scale = 1.0 / root;                                          \
            if (j + 1 < B) pivot = later[j + 1] - column[j + 1] * (column[j + 1] * reciprocal);                        \
            for (k = j + 1; k < B; ++k, later += stride) {                                                             \
                const double factor = column[k] * reciprocal;                                                          \
                for (r = 0; r < B; r += LANES) {                                                                       \
                    const lanes rest = GPROJI_LOAD(later + r) - GPROJI_LOAD(column + r) * factor;                      \
                    GPROJI_STORE(later + r, rest);                                                                     \
                }                                                                                                      \
            }                                                                                                          \
            for (r = 0; r < B; r += LANES) GPROJI_STORE(column + r, GPROJI_LOAD(column + r) * scale);                  \
            column[j] = root;                                                                                          \
            inverse[j - skip] = scale;                                                                                 \
        }                                                                                                              \
        return -1;                                                                                                     \
    }

/* One right-hand side: z_j is row j of the column block, l_j column j, sum_j its product with the other rows. */
#define GPROJI_ONE_ROW(X, j) X(j)
#define GPROJI_ONE_PAIR(X, i, j) X(i, j)
#define GPROJI_Z_TAKE(j) double z_##j = z[j]; const double *l_##j = l + gproji_max((j) - skip, 0) * stride;
#define GPROJI_Z_SCALE(j) z_##j *= inverse[(j) - skip]; z[j] = z_##j;
#define GPROJI_Z_FORWARD(i, j) z_##i -= z_##j * l_##j[i];
#define GPROJI_Z_BACKWARD(i, j) z_##i -= z_##j * l_##i[j];
#define GPROJI_Z_SUM(j) lanes sum_##j = zero;
#define GPROJI_Z_SPREAD(j) sum -= GPROJI_LOAD(l_##j + r) * z_##j;
#define GPROJI_Z_GATHER(j) sum_##j += GPROJI_LOAD(l_##j + r) * right;
#define GPROJI_Z_TOTAL_1(j) z_##j -= sum_##j;
#define GPROJI_Z_TOTAL_2(j) z_##j -= sum_##j[0] + sum_##j[1];
#define GPROJI_Z_TOTAL_4(j) z_##j -= (sum_##j[0] + sum_##j[2]) + (sum_##j[1] + sum_##j[3]);
#define GPROJI_Z_TOTAL_8(j)                                                                                            \
    z_##j -= ((sum_##j[0] + sum_##j[4]) + (sum_##j[2] + sum_##j[6])) +                                                 \
             ((sum_##j[1] + sum_##j[5]) + (sum_##j[3] + sum_##j[7]));

/* See `forward` and `backward`. A column that does not exist is the first one once more, times 0. */
#define GPROJI_DEFINE_SOLUTIONS(kind, L, B)                                                                            \
    GPROJI_KERNEL(kind) void gproji_forward_##kind(int32_t rows, const double *l, ptrdiff_t stride,                    \
                                                   const double *inverse, int32_t skip, double *z) {                   \
        GPROJI_BEGIN(L)                                                                                                \
        int32_t r;                                                                                                     \
        GPROJI_COLUMNS_##B(GPROJI_ONE_ROW, GPROJI_Z_TAKE)                                                              \
        GPROJI_FORWARD_##B(GPROJI_ONE_ROW, GPROJI_ONE_PAIR, GPROJI_Z_SCALE, GPROJI_Z_FORWARD)                          \
        for (r = B; r < rows; r += LANES) {                                                                            \
            lanes sum = GPROJI_LOAD(z + r);                                                                            \
            GPROJI_COLUMNS_##B(GPROJI_ONE_ROW, GPROJI_Z_SPREAD)                                                        \
            GPROJI_STORE(z + r, sum);                                                                                  \
        }                                                                                                              \
    }                                                                                                                  \
    GPROJI_KERNEL(kind) void gproji_backward_##kind(int32_t rows, const double *l, ptrdiff_t stride,                   \
                                                    const double *inverse, int32_t skip, double *z) {                  \
        GPROJI_BEGIN(L)                                                                                                \
        const lanes zero = {0};                                                                                        \
        int32_t r;                                                                                                     \
        GPROJI_COLUMNS_##B(GPROJI_ONE_ROW, GPROJI_Z_TAKE)                                                              \
        GPROJI_COLUMNS_##B(GPROJI_ONE_ROW, GPROJI_Z_SUM)                                                               \
        for (r = B; r < rows; r += LANES) {                                                                            \
            const lanes right = GPROJI_LOAD(z + r);                                                                    \
            GPROJI_COLUMNS_##B(GPROJI_ONE_ROW, GPROJI_Z_GATHER)                                                        \
        }                                                                                                              \
        GPROJI_COLUMNS_##B(GPROJI_ONE_ROW, GPROJI_Z_TOTAL_##L)                                                         \
        GPROJI_BACKWARD_##B(GPROJI_ONE_ROW, GPROJI_ONE_PAIR, GPROJI_Z_SCALE, GPROJI_Z_BACKWARD)                        \
    }

/* See `add`; pieces have no gaps. */
#define GPROJI_DEFINE_ADD(kind, L)                                                                                     \
    GPROJI_KERNEL(kind) void gproji_add_##kind(const gproji_piece *piece, int32_t count, int32_t first, int32_t last,  \
                                               const double *source, ptrdiff_t source_stride, double *target,          \
                                               ptrdiff_t target_stride) {                                              \
        GPROJI_BEGIN(L)                                                                                                \
        for (; first < last; ++first, source += source_stride) {                                                       \
            double *column = target + first * target_stride;                                                           \
            int32_t r = first, k;                                                                                      \
            for (k = 0; k < count; ++k, r = 0) {                                                                       \
                const double *s = source + piece[k].from;                                                              \
                double *d = column + piece[k].to;                                                                      \
                for (; r + LANES <= piece[k].rows; r += LANES) {                                                       \
                    const lanes sum = GPROJI_LOAD(d + r) + GPROJI_LOAD(s + r);                                         \
                    GPROJI_STORE(d + r, sum);                                                                          \
                }                                                                                                      \
                for (; r < piece[k].rows; ++r) d[r] += s[r];                                                           \
            }                                                                                                          \
        }                                                                                                              \
    }

/* A kind whose tiles have SMALL, MIDDLE or TALL vectors (which may be the same): first tall ones, then what is left. */
#define GPROJI_DEFINE_KIND(kind, name, L, B, SMALL, MIDDLE, TALL)                                                      \
    GPROJI_KERNEL(kind) void gproji_update_##kind(int32_t rows, int32_t k, const double *a, ptrdiff_t lda,             \
                                                  const double *b, ptrdiff_t ldb, double *c, ptrdiff_t ldc) {          \
        for (; rows >= TALL * L; rows -= TALL * L, a += TALL * L, c += TALL * L)                                       \
            gproji_update_##TALL##_##kind(k, a, lda, b, ldb, c, ldc);                                                  \
        if (rows == MIDDLE * L)                                                                                        \
            gproji_update_##MIDDLE##_##kind(k, a, lda, b, ldb, c, ldc);                                                \
        else if (rows == SMALL * L)                                                                                    \
            gproji_update_##SMALL##_##kind(k, a, lda, b, ldb, c, ldc);                                                 \
    }                                                                                                                  \
    GPROJI_KERNEL(kind) void gproji_solve_##kind(int32_t rows, int32_t k, const double *a, ptrdiff_t lda,              \
                                                 const double *b, ptrdiff_t ldb, double *c, ptrdiff_t ldc,             \
                                                 const double *triangle, const double *inverse, int32_t skip) {        \
        for (; rows >= TALL * L; rows -= TALL * L, a += TALL * L, c += TALL * L)                                       \
            gproji_solve_##TALL##_##kind(k, a, lda, b, ldb, c, ldc, triangle, inverse, skip);                          \
        if (rows == MIDDLE * L)                                                                                        \
            gproji_solve_##MIDDLE##_##kind(k, a, lda, b, ldb, c, ldc, triangle, inverse, skip);                        \
        else if (rows == SMALL * L)                                                                                    \
            gproji_solve_##SMALL##_##kind(k, a, lda, b, ldb, c, ldc, triangle, inverse, skip);                         \
    }                                                                                                                  \
    GPROJI_DEFINE_FACTOR(kind, L, B)                                                                                   \
    GPROJI_DEFINE_SOLUTIONS(kind, L, B)                                                                                \
    static const gproji_kernels gproji_kernels_##kind = {                                                              \
        name, B, TALL * L, L == 8, gproji_update_##kind, gproji_solve_##kind, gproji_factor_##kind,                    \
        gproji_forward_##kind, gproji_backward_##kind, gproji_add_##kind};

#ifdef GPROJI_KIND_AVX512
/* See `add`; pieces with gaps: the rows of a piece are spread over a vector. */
#define GPROJI_ADD_SPREAD(d, s, mask)                                                                                  \
    _mm512_storeu_pd(d, _mm512_add_pd(_mm512_loadu_pd(d), _mm512_maskz_expandloadu_pd((__mmask8)(mask), s)))
GPROJI_KERNEL(avx512) void gproji_add_avx512(const gproji_piece *piece, int32_t count, int32_t first, int32_t last,
                                             const double *source, ptrdiff_t source_stride, double *target,
                                             ptrdiff_t target_stride) {
    uint32_t mask = piece->mask;
    int32_t i, k;
    for (i = 0; i < first; ++i) mask &= mask - 1;
    for (; i < last; ++i, mask &= mask - 1, source += source_stride) {
        double *column = target + __builtin_ctz(mask) * target_stride;
        GPROJI_ADD_SPREAD(column + piece->to, source + piece->from + i, mask);
        for (k = 1; k < count; ++k) GPROJI_ADD_SPREAD(column + piece[k].to, source + piece[k].from, piece[k].mask);
    }
}
#endif

#ifdef GPROJI_KIND_SCALAR
GPROJI_DEFINE_TILE(scalar, 1, 4, 4)
GPROJI_DEFINE_ADD(scalar, 1)
GPROJI_DEFINE_KIND(scalar, "scalar", 1, 4, 4, 4, 4)
#endif
#ifdef GPROJI_KIND_TWO
GPROJI_DEFINE_TILE(two, 2, 4, 2)
GPROJI_DEFINE_ADD(two, 2)
#ifdef __aarch64__ /* has registers for more */
GPROJI_DEFINE_TILE(two, 2, 4, 4)
GPROJI_DEFINE_KIND(two, "vectors of two", 2, 4, 2, 4, 4)
#else
GPROJI_DEFINE_KIND(two, "vectors of two", 2, 4, 2, 2, 2)
#endif
#endif
#ifdef GPROJI_KIND_AVX2
GPROJI_DEFINE_TILE(avx2, 4, 4, 1)
GPROJI_DEFINE_TILE(avx2, 4, 4, 2)
GPROJI_DEFINE_TILE(avx2, 4, 4, 3)
GPROJI_DEFINE_ADD(avx2, 4)
GPROJI_DEFINE_KIND(avx2, "AVX2", 4, 4, 1, 2, 3)
#endif
#ifdef GPROJI_KIND_AVX512
GPROJI_DEFINE_TILE(avx512, 8, 8, 1)
GPROJI_DEFINE_TILE(avx512, 8, 8, 2)
GPROJI_DEFINE_TILE(avx512, 8, 8, 3)
GPROJI_DEFINE_KIND(avx512, "AVX-512", 8, 8, 1, 2, 3)
#endif
/* clang-format on */

#if GPROJI_CHOICE
/* The vector units of this processor whose registers the operating system keeps. */
typedef struct gproji_units {
    bool avx2, avx512;
} gproji_units;

GPROJI_INTERNAL gproji_units gproji_find_units(void) {
    gproji_units units = {false, false};
    unsigned a, b, c, d, kept, high;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_OSXSAVE) || !(c & bit_FMA)) return units;
    __asm__ __volatile__("xgetbv" : "=a"(kept), "=d"(high) : "c"(0));
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return units;
    units.avx2 = (b & bit_AVX2) && (kept & 0x06) == 0x06;      /* xmm, ymm */
    units.avx512 = (b & bit_AVX512F) && (kept & 0xe6) == 0xe6; /* and masks, zmm */
    return units;
}
#endif

/* Kernels that this processor can run: index 0 the best, then the others; NULL where there are no more. */
GPROJI_INTERNAL const gproji_kernels *gproji_kernels_of(int32_t index) {
#if GPROJI_CHOICE
    const gproji_units units = gproji_find_units();
    (void)units;
#endif
#define GPROJI_X(kind, have) \
    if (have && index-- == 0) return &gproji_kernels_##kind;
    GPROJI_KINDS(GPROJI_X)
#undef GPROJI_X
    return NULL;
}

/* ============================================================================================================
   >>dense   Dense parts of the Cholesky factorisation: panels, update matrices. Uses platform, parallel, kernels.

   All matrices are column-major. A front's panel has w pivot columns and its rows in "storage rows": first q empty
   ones, then the w pivot rows, then the rows below, padded by empty rows. q is chosen so that the rows below begin at
   a multiple of GPROJI_BLOCK, and the pivots are cut into column blocks at the same places: block t has the storage
   rows [t B, t B + B), where B is the kernels' block, which divides GPROJI_BLOCK, and its columns (the first block may
   have fewer than B). Pivot j stands in storage row j + q. Strides are multiples of B, so every tile is whole and
   aligned: what kernels compute in empty rows is zero, and what they write above the diagonal of a diagonal tile is
   never read.

   The parts of a large panel's work that do not depend on each other may run on several threads. Invariant: every entry
   is computed by the same operations in the same order however the work is cut, so that results are the same bits. */
enum {
    GPROJI_CHUNK = 128,     /* columns eliminated together in a wide panel: a tile's strips then stay in the L1 cache */
    GPROJI_STRIP = 48,      /* columns of an update matrix that are stored with the same rows; a multiple of B */
    GPROJI_TASK_ROWS = 120, /* rows of a panel that are solved by one task; a multiple of all tiles */
    GPROJI_ROW_BLOCK = 480  /* rows of a strip of tiles: with GPROJI_CHUNK columns they stay in the L2 cache */
};

/* The number of pieces of `size` that cover `all`. */
GPROJI_INLINE int32_t gproji_pieces(int32_t all, int32_t size) { return (all + size - 1) / size; }

/* The next multiple of `size`, a power of 2. */
GPROJI_INLINE int32_t gproji_round_up(int32_t all, int32_t size) { return (all + size - 1) & -size; }

/* The number of empty rows before the pivots of a panel with w pivots. */
GPROJI_INLINE int32_t gproji_panel_shift(int32_t w) { return gproji_round_up(w, GPROJI_BLOCK) - w; }

/* A stride of at least `rows`: a multiple of B, and none that maps whole columns to the same few lines of a cache. */
GPROJI_INTERNAL int32_t gproji_stride(int32_t rows) {
    int32_t stride = gproji_round_up(rows, GPROJI_BLOCK);
    return stride % 64 == 0 ? stride + GPROJI_BLOCK : stride;
}

/* Update matrices are symmetric and keep little more than their lower triangle: strips of GPROJI_STRIP columns, one
   after the other, each with the rows from its first column on. A matrix has `rows` rows, a multiple of B. */

/* The stride of the strip that holds a column. */
GPROJI_INLINE ptrdiff_t gproji_update_stride(int32_t rows, int32_t column) {
    return rows - column / GPROJI_STRIP * GPROJI_STRIP;
}

/* Row r of a column is at this offset + r; r is at least the strip's first column. */
GPROJI_INLINE ptrdiff_t gproji_update_offset(int32_t rows, int32_t column) {
    ptrdiff_t strip = column / GPROJI_STRIP, first = strip * GPROJI_STRIP;
    ptrdiff_t before = first * rows - first * (first - GPROJI_STRIP) / 2;
    return before + (column - first) * (rows - first) - first;
}

/* The number of entries. */
GPROJI_INTERNAL int64_t gproji_update_entries(int32_t rows) {
    int64_t first = rows / GPROJI_STRIP * GPROJI_STRIP, rest = rows - first;
    return first * rows - first * (first - GPROJI_STRIP) / 2 + rest * rest;
}

/* A panel at work: w pivot columns in storage rows [0, rows), a multiple of the kernels' block B; columns [first, last)
   are being eliminated as a chunk, after the effect of all columns before `first` has been taken off. Both bounds are
   ends of column blocks (or 0). Where B is less than GPROJI_BLOCK, whole empty blocks of rows are left out: `shift` < B
   empty rows stay. */
typedef struct gproji_panel {
    const gproji_kernels *kernels;
    int32_t w, shift, rows;
    int32_t first, last;
    int32_t stride;
    int32_t update_rows; /* of the update matrix */
    double *values;
    double *inverse; /* w: inverses of the diagonal of L */
    double *update;  /* the update matrix */
} gproji_panel;

GPROJI_INTERNAL gproji_panel gproji_make_panel(const gproji_kernels *kernels, int32_t w, int32_t below, int32_t stride,
                                               double *values, double *inverse, double *update) {
    gproji_panel panel;
    int32_t block = kernels->block;
    panel.kernels = kernels;
    panel.w = w, panel.shift = gproji_round_up(w, block) - w;
    panel.rows = panel.shift + w + gproji_round_up(below, block);
    panel.first = panel.last = 0;
    panel.stride = stride, panel.update_rows = gproji_round_up(below, GPROJI_BLOCK);
    panel.values = values + gproji_panel_shift(w) - panel.shift, panel.inverse = inverse, panel.update = update;
    return panel;
}

GPROJI_INLINE double *gproji_panel_at(const gproji_panel *panel, int32_t row, int32_t column) {
    return panel->values + row + (ptrdiff_t)column * panel->stride;
}

/* The column of the pivot, or of the row below the pivots, that stands in storage row `at`: its entry in storage row
   r >= at is the r-th. */
GPROJI_INLINE double *gproji_panel_column(const gproji_panel *panel, int32_t at) {
    int32_t shift = gproji_panel_shift(panel->w), pivot_end = panel->w + shift;
    if (at < pivot_end) return gproji_panel_at(panel, panel->shift - shift, at - shift);
    return panel->update - pivot_end + gproji_update_offset(panel->update_rows, at - pivot_end);
}

/* A strip of C -= A B': `columns` columns (a multiple of the block) whose diagonal begins at its corner, `rows` rows. A
   has k columns and the strip's rows; B is the upper end of A. */
GPROJI_INTERNAL void gproji_strip_update(const gproji_kernels *kernels, int32_t rows, int32_t columns, int32_t k,
                                         const double *a, ptrdiff_t lda, double *c, ptrdiff_t ldc) {
    int32_t begin, column;
    for (begin = 0; begin < rows; begin += GPROJI_ROW_BLOCK) {
        int32_t end = gproji_min(rows, begin + GPROJI_ROW_BLOCK);
        for (column = 0; column < gproji_min(columns, end); column += kernels->block) {
            int32_t row = gproji_max(begin, column);
            kernels->update(end - row, k, a + row, lda, a + column, lda, c + row + column * ldc, ldc);
        }
    }
}

/* Strip `index` of the update matrix: U -= L2 L2', where L2 stands below the pivots. A task. */
GPROJI_INTERNAL void gproji_update_task(void *data, int32_t index) {
    const gproji_panel *panel = (const gproji_panel *)data;
    int32_t pivot_end = panel->w + panel->shift, below = panel->rows - pivot_end;
    int32_t column = index * GPROJI_STRIP, rows = below - column, stride = panel->update_rows - column, first, last;
    double *strip = panel->update + gproji_update_offset(panel->update_rows, column) + column;
    for (first = 0; first < panel->w; first = last) {
        last = panel->w - first <= GPROJI_CHUNK + GPROJI_CHUNK / 2 ? panel->w : first + GPROJI_CHUNK;
        gproji_strip_update(panel->kernels, rows, gproji_min(GPROJI_STRIP, rows), last - first,
                            gproji_panel_at(panel, pivot_end + column, first), panel->stride, strip, stride);
    }
}

/* Strip `index` of the pivot columns after a chunk: takes off the chunk's effect. A task. */
GPROJI_INTERNAL void gproji_trailing_task(void *data, int32_t index) {
    const gproji_panel *panel = (const gproji_panel *)data;
    int32_t column = panel->last + index * GPROJI_STRIP, row = column + panel->shift;
    gproji_strip_update(panel->kernels, panel->rows - row, gproji_min(GPROJI_STRIP, panel->w - column),
                        panel->last - panel->first, gproji_panel_at(panel, row, panel->first), panel->stride,
                        gproji_panel_at(panel, row, column), panel->stride);
}

/* The column block with the first column `start` in `rows` rows from `row` on: C = (C - A B') L^-T. */
GPROJI_INLINE void gproji_block_solve(const gproji_panel *panel, int32_t start, int32_t row, int32_t rows) {
    int32_t skip = start == 0 ? panel->shift : 0, at = start == 0 ? 0 : start + panel->shift;
    panel->kernels->solve(rows, start - panel->first, gproji_panel_at(panel, row, panel->first), panel->stride,
                          gproji_panel_at(panel, at, panel->first), panel->stride, gproji_panel_at(panel, row, start),
                          panel->stride, gproji_panel_at(panel, at, start), panel->inverse + start, skip);
}

/* The first column of the block after the one that begins with column `start`. */
GPROJI_INLINE int32_t gproji_next_block(const gproji_panel *panel, int32_t start) {
    return start + panel->kernels->block - (start == 0 ? panel->shift : 0);
}

/* A chunk's columns in some of the rows below its pivots, tile by tile. A task. */
GPROJI_INTERNAL void gproji_solve_task(void *data, int32_t index) {
    const gproji_panel *panel = (const gproji_panel *)data;
    int32_t tile = panel->kernels->tile_rows, row = panel->last + panel->shift + index * GPROJI_TASK_ROWS;
    int32_t end = gproji_min(panel->rows, row + GPROJI_TASK_ROWS), start;
    for (; row < end; row += tile)
        for (start = panel->first; start < panel->last; start = gproji_next_block(panel, start))
            gproji_block_solve(panel, start, row, gproji_min(tile, end - row));
}

/* The chunk's pivot rows, column block by column block. Returns -1 or the failing column. */
GPROJI_INTERNAL int32_t gproji_chunk_pivots(const gproji_panel *panel) {
    const gproji_kernels *kernels = panel->kernels;
    int32_t block = kernels->block, shift = panel->shift, end = panel->last + shift, stride = panel->stride;
    int32_t start, failed;
    for (start = panel->first; start < panel->last; start = gproji_next_block(panel, start)) {
        int32_t at = start == 0 ? 0 : start + shift, k = start - panel->first; /* at: the block's first storage row */
        const double *strip = gproji_panel_at(panel, at, panel->first);
        double *corner = gproji_panel_at(panel, at, start);
        if (k > 0) kernels->update(block, k, strip, stride, strip, stride, corner, stride);
        failed = kernels->factor(corner, stride, panel->inverse + start, start == 0 ? shift : 0);
        if (failed >= 0) return start + failed;
        gproji_block_solve(panel, start, at + block, end - at - block);
    }
    return -1;
}

/* Runs tasks on the host's threads where they are given and the work, in flops, is worth it. */
GPROJI_INTERNAL void gproji_run_tasks(const gproj_parallel *parallel, double flops, int32_t count, gproj_task task,
                                      void *data) {
    int32_t i;
    if (parallel && flops > 4e6) {
        gproji_for(parallel, count, task, data);
        return;
    }
    for (i = 0; i < count; ++i) task(data, i);
}

/* The rows of a child's update matrix in its parent's panel. Group k of `groups` has the child's rows from at[k] - base
   on, up to those of the next group or the `below`-th, and goes to the parent's storage rows from to[k] on. A piece's
   columns have the same stride in the parent: none reaches beyond the parent's pivots, which end at storage row
   `pivot_end`, or beyond a strip of its update matrix. piece: 2 groups + below / 8 + 2 entries are enough. Returns
   their number. */
GPROJI_INTERNAL int32_t gproji_find_pieces(const gproji_kernels *kernels, int32_t groups, const int32_t *at,
                                           int32_t base, int32_t below, const int32_t *to, int32_t pivot_end,
                                           gproji_piece *piece) {
    gproji_piece *now = piece;
    int32_t k, row, count = 0, end = INT32_MIN; /* end: of the parent's rows that fit into the piece at hand */
    for (k = 0; k < groups; ++k) {
        int32_t next = k + 1 < groups ? at[k + 1] - base : below;
        for (row = at[k] - base; row < next; ++row) {
            int32_t target = to[k] + row - (at[k] - base);
            if (target >= end || (!kernels->spreads && target != now->to + now->rows)) {
                now = piece + count++;
                now->from = row, now->rows = 0, now->mask = 0;
                now->to = kernels->spreads ? target - target % 8 : target;
                if (kernels->spreads)
                    end = now->to + 8;
                else if (target < pivot_end)
                    end = pivot_end;
                else
                    end = target + GPROJI_STRIP - (target - pivot_end) % GPROJI_STRIP;
            }
            now->rows++;
            now->mask |= 1u << ((target - now->to) & 31);
        }
    }
    return count;
}

/* A child's update matrix with `rows` rows on its way to its parent. */
typedef struct gproji_addition {
    const gproji_panel *panel; /* the parent's */
    const gproji_piece *piece;
    int32_t pieces;
    const double *update;
    int32_t rows;
} gproji_addition;

/* Adds strip `index` of a child's update matrix to its parent's panel and update matrix. Different columns go to
   different columns. A task. */
GPROJI_INTERNAL void gproji_add_task(void *data, int32_t index) {
    const gproji_addition *add = (const gproji_addition *)data;
    const gproji_panel *panel = add->panel;
    int32_t shift = gproji_panel_shift(panel->w), pivot_end = shift + panel->w, k;
    int32_t begin = index * GPROJI_STRIP, end = begin + GPROJI_STRIP;
    for (k = 0; k < add->pieces; ++k) {
        const gproji_piece *piece = add->piece + k;
        int32_t first = gproji_max(0, begin - piece->from), last = gproji_min(piece->rows, end - piece->from);
        const double *source = add->update + gproji_update_offset(add->rows, piece->from + first);
        ptrdiff_t stride = panel->stride;
        double *target;
        if (first >= last) continue;
        if (piece->to < pivot_end) { /* the panel has no columns, and maybe no rows, for its first rows */
            target = gproji_panel_at(panel, panel->shift - shift, piece->to - shift);
        } else {
            stride = gproji_update_stride(panel->update_rows, piece->to - pivot_end);
            target = panel->update + gproji_update_offset(panel->update_rows, piece->to - pivot_end) - pivot_end;
        }
        panel->kernels->add(piece, add->pieces - k, first, last, source, gproji_update_stride(add->rows, begin), target,
                            stride);
    }
}

#ifdef GPROJ_USE_CBLAS
/* By a BLAS: our own kernels factor the pivot rows of a chunk, all else is dtrsm, dsyrk and dgemm; threads are the
   BLAS's own business. */
GPROJI_INTERNAL void gproji_chunk_finish(const gproj_parallel *parallel, gproji_panel *panel) {
    int32_t first = panel->first, last = panel->last, stride = panel->stride;
    double *pivots = gproji_panel_at(panel, first + panel->shift, first);
    double *below = gproji_panel_at(panel, last + panel->shift, first);
    double *later = gproji_panel_at(panel, last + panel->shift, last);
    int32_t more = panel->w - last, under = panel->rows - panel->w - panel->shift, width = last - first;
    (void)parallel;
    if (more + under > 0)
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, more + under, width, 1.0, pivots,
                    stride, below, stride);
    if (more == 0) return;
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, more, width, -1.0, below, stride, 1.0, later, stride);
    if (under > 0)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, under, more, width, -1.0, below + more, stride, below,
                    stride, 1.0, later + more, stride);
}

GPROJI_INTERNAL void gproji_panel_update(const gproj_parallel *parallel, gproji_panel *panel) {
    int32_t pivot_end = panel->w + panel->shift, below = panel->rows - pivot_end, first, next;
    (void)parallel;
    for (first = 0; first < below; first = next) {
        double *strip = panel->update + gproji_update_offset(panel->update_rows, first) + first;
        const double *l2 = gproji_panel_at(panel, pivot_end + first, 0);
        int32_t rows = below - first, columns = gproji_min(GPROJI_STRIP, rows), ldc = panel->update_rows - first;
        next = first + columns;
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, columns, panel->w, -1.0, l2, panel->stride, 1.0, strip,
                    ldc);
        if (rows > columns)
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows - columns, columns, panel->w, -1.0, l2 + columns,
                        panel->stride, l2, panel->stride, 1.0, strip + columns, ldc);
    }
}
#else
/* After its pivots: a chunk's rows below, and its effect on the pivot columns after it. */
GPROJI_INTERNAL void gproji_chunk_finish(const gproj_parallel *parallel, gproji_panel *panel) {
    int32_t under = panel->rows - panel->last - panel->shift, later = panel->w - panel->last;
    double width = panel->last - panel->first;
    gproji_run_tasks(parallel, width * width * under, gproji_pieces(under, GPROJI_TASK_ROWS), gproji_solve_task, panel);
    gproji_run_tasks(parallel, 2 * width * under * later, gproji_pieces(later, GPROJI_STRIP), gproji_trailing_task,
                     panel);
}

/* The effect of a factored panel on its update matrix. */
GPROJI_INTERNAL void gproji_panel_update(const gproj_parallel *parallel, gproji_panel *panel) {
    int32_t below = panel->rows - panel->w - panel->shift;
    gproji_run_tasks(parallel, (double)below * below * panel->w, gproji_pieces(below, GPROJI_STRIP), gproji_update_task,
                     panel);
}
#endif

/* Factors a panel in place. Returns -1 or the first column whose pivot is not > 0. parallel: NULL within a task. */
GPROJI_INTERNAL int32_t gproji_panel_factor(const gproj_parallel *parallel, gproji_panel *panel) {
    for (panel->last = 0; panel->last < panel->w;) {
        int32_t failed;
        panel->first = panel->last;
        panel->last = gproji_min(panel->w, panel->first + GPROJI_CHUNK - (panel->first ? 0 : panel->shift));
        failed = gproji_chunk_pivots(panel);
        if (failed >= 0) return failed;
        gproji_chunk_finish(parallel, panel);
    }
    return -1;
}

/* z = L^-1 z on all storage rows of a panel: the pivots' part becomes the solution, the part below (0 on entry) minus
   what it takes from the rows below. */
GPROJI_INTERNAL void gproji_panel_forward(const gproji_panel *panel, double *z) {
    int32_t start, shift = panel->shift;
    z += gproji_panel_shift(panel->w) - shift;
    for (start = 0; start < panel->w; start = gproji_next_block(panel, start)) {
        int32_t skip = start == 0 ? shift : 0, at = start == 0 ? 0 : start + shift;
        panel->kernels->forward(panel->rows - at, gproji_panel_at(panel, at, start), panel->stride,
                                panel->inverse + start, skip, z + at);
    }
}

/* z = L^-T z on all storage rows of a panel, where the part below is known. */
GPROJI_INTERNAL void gproji_panel_backward(const gproji_panel *panel, double *z) {
    int32_t start, shift = panel->shift, block = panel->kernels->block, at = panel->w + shift - block;
    z += gproji_panel_shift(panel->w) - shift;
    for (; at >= 0; at -= block) {
        int32_t skip = at == 0 ? shift : 0;
        start = at == 0 ? 0 : at - shift;
        panel->kernels->backward(panel->rows - at, gproji_panel_at(panel, at, start), panel->stride,
                                 panel->inverse + start, skip, z + at);
    }
}

/* ============================================================================================================
   >>ordering   The order of elimination: graphs of nodes, condensation, minimum degree. Uses platform, memory.

   A node is a group of variables that stay together; its weight is their number. All degrees and counts here are in
   variables. The minimum degree ordering is written after Amestoy, Davis, Duff, "An approximate minimum degree
   ordering algorithm" (1996): quotient graph, element absorption (also aggressive), approximate external degrees,
   mass elimination, supervariables found by hashing (Ashcraft 1995), dense rows put last. It is deterministic: ties
   are broken by the order in which nodes reach a degree list. */

/* A symmetric graph without loops: the neighbours of node i are adjacent[start[i]..start[i+1]-1], each once, and i is
   a neighbour of each of them. */
typedef struct gproji_graph {
    int32_t nodes;
    const int64_t *start;
    const int32_t *adjacent;
    const int32_t *weight;
} gproji_graph;

/* sum over the columns of a front, or of a node, of (column count)^2 */
GPROJI_INTERNAL double gproji_front_flops(double width, double below) {
    return width * below * below + width * (width + 1.0) * below + width * (width + 1.0) * (2.0 * width + 1.0) / 6.0;
}

/* The state of the elimination. Each of the graph's nodes is, at any time, one of
     variable  (weight > 0)   not yet eliminated, standing for `weight` matrix variables; its list in `space` has first
                              `elements[i]` elements, then variables, `length[i]` altogether
     element   (kind ELEMENT) a pivot; its list holds the variables of its column of L that are not yet eliminated
     gone      (kind GONE)    a variable absorbed by another one or by an element, or an element absorbed by a later one
     dense     (kind DENSE)   put last, never looked at
   While a new element is formed, the weight of its variables is negated. */
enum {
    GPROJI_AMD_VARIABLE,
    GPROJI_AMD_ELEMENT,
    GPROJI_AMD_GONE,
    GPROJI_AMD_DENSE
};

typedef struct gproji_amd {
    int32_t nodes;
    int32_t total;  /* weight of all nodes that are not dense */
    int32_t left;   /* of it, not yet eliminated */
    int32_t lowest; /* no variable has a smaller degree */
    double flops; /* of what is eliminated: sum of (column count)^2; the dense nodes are taken for neighbours of all */
    int64_t free; /* space[free..size-1] is unused */
    int64_t size;
    int64_t stamp;       /* marks below it are old */
    int32_t *space;      /* size: all lists */
    int64_t *list;       /* nodes: where the list begins */
    int32_t *length;     /* nodes */
    int32_t *elements;   /* nodes: of a variable, the elements at the head of its list */
    int32_t *weight;     /* nodes */
    int32_t *degree;     /* nodes: variable: bound of the external degree; element: weight of its list */
    unsigned char *kind; /* nodes */
    int64_t *mark;       /* nodes: elements: stamp + weight of what lies outside the new element; else marks */
    int32_t *head;       /* buckets: first variable of a degree, or -1; used for hash values while comparing */
    int32_t buckets;     /* total + 1 */
    int32_t *next;       /* nodes: in a degree list, in a hash list */
    int32_t *previous;   /* nodes: in a degree list; while comparing, the hash value */
    int32_t *hash_head;  /* nodes: first variable with a hash value, or -1 */
    int32_t *tail;       /* nodes: last node of the chain that a representative has absorbed */
    int32_t *chain;      /* nodes: next node of that chain, or -1 */
} gproji_amd;

GPROJI_INTERNAL void gproji_amd_list_add(gproji_amd *amd, int32_t i) {
    int32_t d = amd->degree[i], first = amd->head[d];
    amd->next[i] = first;
    amd->previous[i] = -1;
    if (first >= 0) amd->previous[first] = i;
    amd->head[d] = i;
    if (d < amd->lowest) amd->lowest = d;
}

GPROJI_INTERNAL void gproji_amd_list_remove(gproji_amd *amd, int32_t i) {
    int32_t before = amd->previous[i], after = amd->next[i];
    if (after >= 0) amd->previous[after] = before;
    if (before >= 0)
        amd->next[before] = after;
    else
        amd->head[amd->degree[i]] = after;
}

/* Node j, with all that it has absorbed, is from now on eliminated right after what `i` has absorbed. */
GPROJI_INTERNAL void gproji_amd_absorb(gproji_amd *amd, int32_t i, int32_t j) {
    amd->chain[amd->tail[i]] = j;
    amd->tail[i] = amd->tail[j];
    amd->weight[j] = 0;
    amd->kind[j] = GPROJI_AMD_GONE;
}

/* Moves all living lists to the front of the space. The first entry of a list lends its place to the node's number
   (as -1 - i), so that a sweep over the space meets the lists in their order. */
GPROJI_INTERNAL void gproji_amd_compact(gproji_amd *amd) {
    int64_t from, to = 0;
    int32_t i, k;
    for (i = 0; i < amd->nodes; ++i) {
        if (amd->kind[i] == GPROJI_AMD_GONE || amd->length[i] == 0) continue;
        from = amd->list[i];
        amd->list[i] = amd->space[from];
        amd->space[from] = -1 - i;
    }
    for (from = 0; from < amd->free;) {
        if (amd->space[from] >= 0) {
            ++from;
            continue;
        }
        i = -1 - amd->space[from];
        amd->space[to] = (int32_t)amd->list[i];
        amd->list[i] = to++;
        ++from;
        for (k = 1; k < amd->length[i]; ++k) amd->space[to++] = amd->space[from++];
    }
    amd->free = to;
}

/* Takes the variables of a list into the new element, whose list is being written at `free`. */
GPROJI_INTERNAL void gproji_amd_gather(gproji_amd *amd, int32_t pivot, const int32_t *from, int32_t count) {
    int32_t k;
    for (k = 0; k < count; ++k) {
        int32_t i = from[k], weight = amd->weight[i];
        if (weight <= 0 || amd->kind[i] != GPROJI_AMD_VARIABLE) continue; /* gone, or already in the new element */
        amd->weight[i] = -weight;
        amd->degree[pivot] += weight;
        amd->space[amd->free++] = i;
        gproji_amd_list_remove(amd, i);
    }
}

/* Forms the element of a pivot: L_p = (A_p u union of L_e for all its elements e) \ p. The elements are absorbed. */
GPROJI_INTERNAL void gproji_amd_form_element(gproji_amd *amd, int32_t pivot) {
    int32_t k, own = amd->length[pivot], heads = amd->elements[pivot];
    int64_t needed = own - heads, begin;
    for (k = 0; k < heads; ++k) needed += amd->length[amd->space[amd->list[pivot] + k]];
    if (needed > amd->left) needed = amd->left; /* each variable at most once */
    if (amd->free + needed > amd->size) gproji_amd_compact(amd);
    GPROJ_ASSERT(amd->free + needed <= amd->size);
    begin = amd->free;
    amd->degree[pivot] = 0;
    amd->weight[pivot] = -amd->weight[pivot]; /* not to be gathered */
    for (k = 0; k < heads; ++k) {
        int32_t e = amd->space[amd->list[pivot] + k];
        gproji_amd_gather(amd, pivot, amd->space + amd->list[e], amd->length[e]);
        amd->kind[e] = GPROJI_AMD_GONE;
    }
    gproji_amd_gather(amd, pivot, amd->space + amd->list[pivot] + heads, own - heads);
    amd->weight[pivot] = -amd->weight[pivot];
    amd->kind[pivot] = GPROJI_AMD_ELEMENT;
    amd->list[pivot] = begin;
    amd->length[pivot] = (int32_t)(amd->free - begin);
    amd->elements[pivot] = 0;
}

/* For every element e that shares variables with the new one: mark[e] - stamp = weight of L_e \ L_p. */
GPROJI_INTERNAL void gproji_amd_scan(gproji_amd *amd, int32_t pivot) {
    const int32_t *element = amd->space + amd->list[pivot];
    int32_t k, j;
    amd->stamp += (int64_t)amd->total + 1;
    for (k = 0; k < amd->length[pivot]; ++k) {
        int32_t i = element[k], weight = -amd->weight[i];
        const int32_t *list = amd->space + amd->list[i];
        for (j = 0; j < amd->elements[i]; ++j) {
            int32_t e = list[j];
            if (amd->kind[e] != GPROJI_AMD_ELEMENT) continue;
            if (amd->mark[e] < amd->stamp) amd->mark[e] = amd->stamp + amd->degree[e];
            amd->mark[e] -= weight;
        }
    }
}

/* Rewrites the list of variable i of the new element: its other elements, with the new one in front, then the variables
   not reached by the new element. Sets its degree bound without the new element's part, and returns its hash value;
   -1 when the variable has nothing outside the new element (then it can be eliminated with the pivot). */
GPROJI_INTERNAL int32_t gproji_amd_prune(gproji_amd *amd, int32_t pivot, int32_t i) {
    int32_t *list = amd->space + amd->list[i];
    int32_t k, to = 0, heads = amd->elements[i], own = amd->length[i], moved;
    int64_t degree = 0;
    uint32_t hash = 0;
    for (k = 0; k < heads; ++k) {
        int32_t e = list[k];
        int64_t outside;
        if (amd->kind[e] != GPROJI_AMD_ELEMENT) continue;
        outside = amd->mark[e] - amd->stamp;
        if (outside > 0) {
            degree += outside;
            hash += (uint32_t)e;
            list[to++] = e;
        } else {
            amd->kind[e] = GPROJI_AMD_GONE; /* L_e lies in L_p: aggressive absorption */
        }
    }
    heads = to;
    for (k = amd->elements[i]; k < own; ++k) {
        int32_t j = list[k];
        if (amd->kind[j] != GPROJI_AMD_VARIABLE || amd->weight[j] <= 0) continue; /* gone, or in the new element */
        degree += amd->weight[j];
        hash += (uint32_t)j;
        list[to++] = j;
    }
    if (degree == 0) return -1;
    /* the new element takes the first place: at least one entry has gone (the pivot, or an element it absorbed) */
    GPROJ_ASSERT(to < own);
    moved = list[heads];
    if (to > heads) list[to] = moved;
    if (heads > 0) list[heads] = list[0];
    list[0] = pivot;
    amd->elements[i] = heads + 1;
    amd->length[i] = to + 1;
    if (degree < amd->degree[i]) amd->degree[i] = (int32_t)degree;
    hash += (uint32_t)pivot;
    return (int32_t)(hash % (uint32_t)amd->nodes);
}

/* Have variables i and j the same elements and neighbours? Those of i are marked by the stamp. */
GPROJI_INTERNAL bool gproji_amd_same(const gproji_amd *amd, int32_t i, int32_t j) {
    const int32_t *list = amd->space + amd->list[j];
    int32_t k;
    if (amd->length[i] != amd->length[j] || amd->elements[i] != amd->elements[j]) return false;
    for (k = 1; k < amd->length[j]; ++k)
        if (amd->mark[list[k]] != amd->stamp) return false;
    return true;
}

/* Merges the variables of one hash list that cannot be told apart. */
GPROJI_INTERNAL void gproji_amd_merge(gproji_amd *amd, int32_t first) {
    int32_t i, j, before, k;
    for (i = first; i >= 0 && amd->next[i] >= 0; i = amd->next[i]) {
        amd->stamp++;
        for (k = 1; k < amd->length[i]; ++k) amd->mark[amd->space[amd->list[i] + k]] = amd->stamp;
        for (before = i, j = amd->next[i]; j >= 0; j = amd->next[j]) {
            if (gproji_amd_same(amd, i, j)) {
                amd->weight[i] += amd->weight[j]; /* both negative */
                gproji_amd_absorb(amd, i, j);
                amd->next[before] = amd->next[j];
            } else {
                before = j;
            }
        }
    }
}

/* Eliminates one pivot: forms its element and brings all its variables up to date. */
GPROJI_INTERNAL void gproji_amd_eliminate(gproji_amd *amd, int32_t pivot) {
    int32_t k, to = 0, *element;
    amd->left -= amd->weight[pivot];
    gproji_amd_form_element(amd, pivot);
    element = amd->space + amd->list[pivot];
    gproji_amd_scan(amd, pivot);
    for (k = 0; k < amd->length[pivot]; ++k) {
        int32_t i = element[k], hash = gproji_amd_prune(amd, pivot, i);
        if (hash < 0) { /* mass elimination */
            int32_t weight = -amd->weight[i];
            amd->left -= weight;
            amd->degree[pivot] -= weight;
            amd->weight[pivot] += weight;
            gproji_amd_absorb(amd, pivot, i);
            continue;
        }
        amd->previous[i] = hash;
        amd->next[i] = amd->hash_head[hash];
        amd->hash_head[hash] = i;
    }
    amd->stamp += (int64_t)amd->total + 1;
    for (k = 0; k < amd->length[pivot]; ++k) { /* supervariables; empties the hash lists */
        int32_t i = element[k], first;
        if (amd->weight[i] == 0) continue;
        first = amd->hash_head[amd->previous[i]];
        amd->hash_head[amd->previous[i]] = -1;
        if (first >= 0) gproji_amd_merge(amd, first);
    }
    for (k = 0; k < amd->length[pivot]; ++k) { /* final degrees; what was absorbed leaves the element's list */
        int32_t i = element[k], weight = -amd->weight[i];
        int64_t degree;
        if (weight == 0) continue;
        amd->weight[i] = weight;
        degree = (int64_t)amd->degree[i] + amd->degree[pivot] - weight;
        if (degree > amd->left - weight) degree = amd->left - weight;
        amd->degree[i] = (int32_t)degree;
        gproji_amd_list_add(amd, i);
        element[to++] = i;
    }
    if (amd->list[pivot] + amd->length[pivot] == amd->free) amd->free = amd->list[pivot] + to;
    amd->length[pivot] = to;
    if (to == 0) amd->kind[pivot] = GPROJI_AMD_GONE;
    amd->flops += gproji_front_flops(amd->weight[pivot], (double)amd->degree[pivot] + amd->buckets - 1 - amd->total);
}

GPROJI_INTERNAL bool gproji_amd_take(gproji_amd *amd, gproji_pool *pool, const gproji_graph *graph) {
    int64_t n = graph->nodes;
    amd->size = graph->start[n] + n + 1; /* one new element always fits after a compaction */
    amd->space = (int32_t *)gproji_pool_take(pool, amd->size, sizeof(int32_t));
    amd->list = (int64_t *)gproji_pool_take(pool, n, sizeof(int64_t));
    amd->length = (int32_t *)gproji_pool_take(pool, n, sizeof(int32_t));
    amd->elements = (int32_t *)gproji_pool_take_zeroed(pool, n, sizeof(int32_t));
    amd->weight = (int32_t *)gproji_pool_take(pool, n, sizeof(int32_t));
    amd->degree = (int32_t *)gproji_pool_take(pool, n, sizeof(int32_t));
    amd->kind = (unsigned char *)gproji_pool_take_zeroed(pool, n, 1);
    amd->mark = (int64_t *)gproji_pool_take_zeroed(pool, n, sizeof(int64_t));
    amd->head = (int32_t *)gproji_pool_take(pool, amd->buckets, sizeof(int32_t));
    amd->next = (int32_t *)gproji_pool_take(pool, n, sizeof(int32_t));
    amd->previous = (int32_t *)gproji_pool_take(pool, n, sizeof(int32_t));
    amd->hash_head = (int32_t *)gproji_pool_take(pool, n, sizeof(int32_t));
    amd->tail = (int32_t *)gproji_pool_take(pool, n, sizeof(int32_t));
    amd->chain = (int32_t *)gproji_pool_take(pool, n, sizeof(int32_t));
    return amd->space && amd->list && amd->length && amd->elements && amd->weight && amd->degree && amd->kind &&
           amd->mark && amd->head && amd->next && amd->previous && amd->hash_head && amd->tail && amd->chain;
}

/* The weight of a node's neighbours. */
GPROJI_INTERNAL int64_t gproji_graph_degree(const gproji_graph *graph, int32_t node) {
    int64_t k, degree = 0;
    for (k = graph->start[node]; k < graph->start[node + 1]; ++k) degree += graph->weight[graph->adjacent[k]];
    return degree;
}

/* Dense nodes have more than 10 sqrt(n) variables next to them. They are put last without looking at them: they would
   make every degree and distance meaningless and the search slow. */
GPROJI_INTERNAL double gproji_dense_degree(int32_t total) { return gproji_fmax(16.0, 10.0 * sqrt((double)total)); }

/* Fills the lists with all nodes that are not dense. */
GPROJI_INTERNAL void gproji_amd_start(gproji_amd *amd, const gproji_graph *graph) {
    double dense = gproji_dense_degree(amd->buckets - 1);
    int32_t i;
    int64_t k;
    amd->stamp = 1;
    amd->lowest = 0;
    for (i = 0; i < amd->buckets; ++i) amd->head[i] = -1;
    for (i = 0; i < amd->nodes; ++i) {
        amd->hash_head[i] = -1;
        amd->tail[i] = i;
        amd->chain[i] = -1;
        amd->weight[i] = graph->weight[i];
        if ((double)gproji_graph_degree(graph, i) > dense) amd->kind[i] = GPROJI_AMD_DENSE;
    }
    for (i = 0; i < amd->nodes; ++i) {
        int32_t degree = 0;
        amd->list[i] = amd->free;
        amd->length[i] = 0;
        if (amd->kind[i] == GPROJI_AMD_DENSE) continue;
        amd->total += amd->weight[i];
        for (k = graph->start[i]; k < graph->start[i + 1]; ++k) {
            int32_t j = graph->adjacent[k];
            if (amd->kind[j] == GPROJI_AMD_DENSE) continue;
            amd->space[amd->free++] = j;
            degree += amd->weight[j];
        }
        amd->length[i] = (int32_t)(amd->free - amd->list[i]);
        amd->degree[i] = degree;
    }
    amd->left = amd->total;
    for (i = amd->nodes - 1; i >= 0; --i)
        if (amd->kind[i] == GPROJI_AMD_VARIABLE) gproji_amd_list_add(amd, i);
    amd->lowest = 0;
}

/* Writes the order (nodes entries: the node that is eliminated k-th) and, unless NULL, how many flops a factorisation
   takes at most: exactly so many without dense nodes. `total` is the weight of all nodes. False when there is no
   memory. */
GPROJI_INTERNAL bool gproji_amd_order(gproji_heap *heap, const gproji_graph *graph, int32_t total, int32_t *order,
                                      double *flops) {
    gproji_pool pool;
    gproji_amd amd;
    int32_t i, count = 0;
    gproji_pool_start(&pool, heap);
    memset(&amd, 0, sizeof amd);
    amd.nodes = graph->nodes;
    amd.buckets = total + 1;
    if (!gproji_amd_take(&amd, &pool, graph)) {
        gproji_pool_give_all(&pool);
        return false;
    }
    gproji_amd_start(&amd, graph);
    while (amd.left > 0) {
        int32_t pivot, member;
        while (amd.head[amd.lowest] < 0) amd.lowest++;
        pivot = amd.head[amd.lowest];
        gproji_amd_list_remove(&amd, pivot);
        gproji_amd_eliminate(&amd, pivot);
        for (member = pivot; member >= 0; member = amd.chain[member]) order[count++] = member;
    }
    for (i = 0; i < graph->nodes; ++i)
        if (amd.kind[i] == GPROJI_AMD_DENSE) order[count++] = i;
    GPROJ_ASSERT(count == graph->nodes);
    if (flops) *flops = amd.flops + gproji_front_flops((double)total - amd.total, 0);
    gproji_pool_give_all(&pool);
    return true;
}

/* -- condensation -- */

enum {
    GPROJI_CONDENSED_DEGREE = 21 /* weight of the neighbours of a node that is condensed */
};

/* A graph without some of its nodes. */
typedef struct gproji_condensation {
    gproji_pool pool;
    gproji_graph rest;
    int32_t count;   /* nodes that are eliminated first */
    int32_t *first;  /* all nodes: those, then the others, as `rest` numbers them */
    int32_t *number; /* all nodes: place in `first` */
} gproji_condensation;

/* Chooses nodes with at least 3 light neighbours, no two of them adjacent, the lightest first: the normals of faces,
   say. (Chains and trees are left to the minimum degree ordering, which orders them without fill.) */
GPROJI_INTERNAL bool gproji_choose_condensed(gproji_condensation *x, const gproji_graph *graph) {
    int32_t n = graph->nodes, i, k, d, start[GPROJI_CONDENSED_DEGREE + 3], *degree, *sorted;
    int64_t e;
    unsigned char *taken = (unsigned char *)gproji_pool_take_zeroed(&x->pool, n, 1); /* chosen, or next to one */
    degree = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    sorted = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    x->first = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    x->number = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    if (!taken || !degree || !sorted || !x->first || !x->number) return false;
    memset(start, 0, sizeof start);
    for (i = 0; i < n; ++i) {
        int64_t weight = graph->start[i + 1] - graph->start[i] < 3 ? GPROJI_CONDENSED_DEGREE + 1 : 0;
        for (e = graph->start[i]; e < graph->start[i + 1] && weight <= GPROJI_CONDENSED_DEGREE; ++e)
            weight += graph->weight[graph->adjacent[e]];
        degree[i] = (int32_t)(weight <= GPROJI_CONDENSED_DEGREE ? weight : GPROJI_CONDENSED_DEGREE + 1);
        start[degree[i] + 1]++;
    }
    for (d = 0; d <= GPROJI_CONDENSED_DEGREE + 1; ++d) start[d + 1] += start[d];
    for (i = 0; i < n; ++i) sorted[start[degree[i]]++] = i;
    for (k = 0; k < n && degree[sorted[k]] <= GPROJI_CONDENSED_DEGREE; ++k) {
        i = sorted[k];
        if (taken[i]) continue;
        for (e = graph->start[i]; e < graph->start[i + 1]; ++e) taken[graph->adjacent[e]] = 1;
        x->first[x->count++] = i;
    }
    for (i = 0; i < n; ++i) x->number[i] = -1;
    for (k = 0; k < x->count; ++k) x->number[x->first[k]] = k;
    for (i = 0, k = x->count; i < n; ++i)
        if (x->number[i] < 0) x->first[k] = i, x->number[i] = k++;
    return true;
}

/* Writes the neighbours of node i in the graph that is left to `to` and returns their number; mark: of all nodes. */
GPROJI_INTERNAL int64_t gproji_condensed_neighbours(const gproji_condensation *x, const gproji_graph *graph, int32_t i,
                                                    int32_t *mark, int32_t *to) {
    int64_t e, f, count = 0;
    mark[i] = i;
    for (e = graph->start[i]; e < graph->start[i + 1]; ++e) {
        int32_t j = graph->adjacent[e];
        int64_t from = x->number[j] < x->count ? graph->start[j] : e,
                end = x->number[j] < x->count ? graph->start[j + 1] : e + 1;
        for (f = from; f < end; ++f) { /* those of a condensed node, or the node itself */
            int32_t other = graph->adjacent[f];
            if (mark[other] == i) continue;
            mark[other] = i;
            to[count++] = x->number[other] - x->count;
        }
    }
    return count;
}

/* The graph without a first set of nodes, whose elimination is taken into account: the neighbours of each of them have
   become adjacent. This is one round of the multiple minimum degree ordering (Liu 1985). What remains is half the size
   where normals have gone, and shows the mesh. False when there is no memory. */
GPROJI_INTERNAL bool gproji_condense(gproji_condensation *x, gproji_heap *heap, const gproji_graph *graph) {
    int32_t i, k, left, *mark, *adjacent, *weight;
    int64_t *start, room = 0, e;
    memset(x, 0, sizeof *x);
    gproji_pool_start(&x->pool, heap);
    if (!gproji_choose_condensed(x, graph)) return false;
    left = graph->nodes - x->count;
    for (k = x->count; k < graph->nodes; ++k)
        for (e = graph->start[x->first[k]]; e < graph->start[x->first[k] + 1]; ++e) {
            int32_t j = graph->adjacent[e];
            room += x->number[j] < x->count ? graph->start[j + 1] - graph->start[j] : 1;
        }
    start = (int64_t *)gproji_pool_take(&x->pool, (int64_t)left + 1, sizeof(int64_t));
    adjacent = (int32_t *)gproji_pool_take(&x->pool, room, sizeof(int32_t));
    weight = (int32_t *)gproji_pool_take(&x->pool, left, sizeof(int32_t));
    mark = (int32_t *)gproji_pool_take(&x->pool, graph->nodes, sizeof(int32_t));
    if (!start || !adjacent || !weight || !mark) return false;
    for (i = 0; i < graph->nodes; ++i) mark[i] = -1;
    start[0] = 0;
    for (k = 0; k < left; ++k) {
        i = x->first[x->count + k];
        weight[k] = graph->weight[i];
        start[k + 1] = start[k] + gproji_condensed_neighbours(x, graph, i, mark, adjacent + start[k]);
    }
    x->rest.nodes = left, x->rest.start = start, x->rest.adjacent = adjacent, x->rest.weight = weight;
    return true;
}

/* ============================================================================================================
   >>dissection   The order of elimination by nested dissection. Uses platform, memory, ordering.

   A separator is a set of nodes without which the rest falls into two sides that are not adjacent. It is eliminated
   after both sides, and they are dissected in turn (George 1973). All that is known is the graph. Of each part:
     coordinates  From a node a at its rim and the node b farthest from it, x = d_a - d_b in steps along the graph; from
                  c, far from both, and d, far from all, y = d_c - d_d. On a grid whose faces' corners are all adjacent
                  these are its diagonals, and x + y, x - y are its axes. The four are the directions to cut in.
     cut          The best of some thresholds of the four. A side's cost is estimated from its weight and that of its
                  halo, the separators next to it, which become rows of all its fronts.
     separator    The smallest set of nodes of a band about the threshold that keeps the band's two rims apart: minimum
                  cut, maximum flow (Menger 1927; Ford, Fulkerson 1956; augmentation by rounds of depth-first searches as
                  in Pothen, Fan 1990). It straightens what distances leave ragged. Of the smallest sets those next to
                  the two rims and the one next to the threshold are compared.
   Small parts are ordered by exact minimum degree, halo included, with sets of bits.

   Two kinds of nodes are not dissected. Dense ones (see gproji_dense_degree) come last. Light ones come right before the
   first of their hosts, where they cause no fill: the forces in edges. A host is a heavier neighbour that has all their
   neighbours. */

enum {
    GPROJI_ND_LEAF = 64,   /* nodes of a part that is not cut any more: bits of a word */
    GPROJI_ND_HALO = 192,  /* nodes of its halo that count for the degrees */
    GPROJI_ND_WORDS = 4,   /* for both */
    GPROJI_ND_STACK = 40,  /* parts that wait: the smaller of two is always taken first */
    GPROJI_ND_STARTS = 8,  /* coordinates that are tried for the first cut */
    GPROJI_ND_ROUNDS = 200 /* of searches for a flow; no mesh needs more than some ten */
};

/* A part that is still to be ordered: nodes first..first+nodes-1 of one of the two copies of the graph. */
typedef struct gproji_nd_part {
    int32_t first;
    int32_t nodes;
    int32_t place; /* its first place in the order */
    int32_t copy;
} gproji_nd_part;

/* A copy of the graph, its nodes sorted by parts. A part's two sides are written into the other copy, at the part's own
   places: so no part is in the way of another one. */
typedef struct gproji_nd_nodes {
    int32_t *name;     /* the node in the graph that is dissected */
    int32_t *weight;   /* its weight */
    int64_t *from;     /* its neighbours begin at adjacent[from]: */
    int32_t *inner;    /* so many in the same part, by their numbers in it, */
    int32_t *outer;    /* then so many in the halo, by name (while the part is at work, by number in the halo) */
    int32_t *adjacent; /* not by node: as many as in the graph */
} gproji_nd_nodes;

/* A cut of a part: nodes with position < at, and the others. */
typedef struct gproji_nd_cut {
    double cost;
    int32_t axis;
    int32_t at;
    int32_t range;  /* positions are 0..range-1 */
    double below;   /* weight of the nodes with position < at */
    int32_t weight; /* of a separator, not yet the smallest */
} gproji_nd_cut;

/* A network for the flow through a band of nodes. Each node i has an entry, state 2 i, and an exit, state 2 i + 1; what
   passes between them is at most its weight. Arcs lead from the exit to the entries of its neighbours, without limit. */
typedef struct gproji_band {
    int32_t nodes;
    int32_t *id;         /* nodes: number in the part */
    int32_t *start;      /* nodes + 1: its arcs are start[i]..start[i + 1] - 1 */
    int32_t *weight;     /* nodes */
    int32_t *through;    /* nodes: flow from entry to exit */
    int32_t *turn;       /* states: the next step to try; see gproji_band_step */
    int32_t *queue;      /* states; also the path that is looked for */
    int32_t *to;         /* arcs: the neighbour */
    int32_t *mate;       /* arcs: the same arc the other way */
    int32_t *flow;       /* arcs */
    unsigned char *ends; /* nodes: GPROJI_BAND_SOURCE, _SINK: has neighbours on that side of the band */
    unsigned char *mark; /* states: GPROJI_BAND_... */
    void *block;         /* all of these arrays */
    size_t block_size;
} gproji_band;

enum {
    GPROJI_BAND_SOURCE = 1, /* reached from the source: also, being seen in a search */
    GPROJI_BAND_SINK = 2,   /* reaches the sink */
    GPROJI_BAND_MIDDLE = 4  /* reached from the source and from all below the cut that does not reach the sink */
};

typedef struct gproji_nd {
    const gproji_graph *graph;
    gproji_heap *heap;
    bool failed;         /* there was no memory */
    double unit;         /* sqrt(mean weight of a node): a separator of n nodes of a mesh has about sqrt(n) */
    unsigned char *kind; /* nodes: GPROJI_ND_KEPT, ... */
    int32_t light;       /* how many are light */
    int32_t kept;        /* nodes that are dissected */
    int32_t *order;      /* kept: the result */
    gproji_nd_nodes copy[2];
    gproji_nd_part stack[GPROJI_ND_STACK];
    int32_t parts;
    /* the part at work; arrays have room for all nodes */
    gproji_nd_nodes here; /* its nodes alone */
    int32_t nodes;
    double weight, halo_weight;
    int32_t rims, *rim;              /* its nodes with neighbours in the halo */
    int32_t halos, *halo;            /* names */
    int32_t *halo_of;                /* by name: number in the halo, if halo[..] says so */
    int32_t *halo_least, *halo_most; /* positions of a halo node's neighbours; or, in halo_least, the sides it is at */
    int32_t *distance[4], *queue;    /* coordinates: x takes the place of the first, y of the third */
    int32_t *number;                 /* in the band or in a side */
    int32_t *position, *best_position;
    unsigned char *side; /* 0, 1; 2: separator */
    /* by position; how much more there is than at the position before */
    int32_t *sum, *best_sum;       /* but these: the weight of the nodes at a position */
    int32_t *low, *high;           /* of nodes below a threshold next to others above it, and the other way round */
    int32_t *halo_low, *halo_high; /* of halo nodes next to nodes below; taken off: next to nodes above */
    unsigned char *near;           /* 1: near a threshold, 3: a threshold */
    gproji_band band;
} gproji_nd;

enum {
    GPROJI_ND_KEPT,
    GPROJI_ND_LIGHT,
    GPROJI_ND_DENSE,
    GPROJI_ND_PLACED
};

/* Arrays with an entry for each node, or position, and one more for the end of the positions. */
GPROJI_INTERNAL bool gproji_nd_take(gproji_nd *nd, gproji_pool *pool) {
    int64_t n = nd->graph->nodes, arcs = nd->graph->start[n];
    int32_t **all[26], i, k = 0;
    for (i = 0; i < 2; ++i) {
        gproji_nd_nodes *c = &nd->copy[i];
        all[k++] = &c->name, all[k++] = &c->weight, all[k++] = &c->inner, all[k++] = &c->outer;
        c->from = (int64_t *)gproji_pool_take(pool, n, sizeof(int64_t));
        c->adjacent = (int32_t *)gproji_pool_take(pool, arcs, sizeof(int32_t));
        if (!c->from || !c->adjacent) return false;
    }
    for (i = 0; i < 4; ++i) all[k++] = &nd->distance[i];
    all[k++] = &nd->queue, all[k++] = &nd->number, all[k++] = &nd->order, all[k++] = &nd->rim;
    all[k++] = &nd->halo_least, all[k++] = &nd->halo_most;
    all[k++] = &nd->position, all[k++] = &nd->best_position, all[k++] = &nd->sum, all[k++] = &nd->best_sum;
    all[k++] = &nd->low, all[k++] = &nd->high, all[k++] = &nd->halo_low, all[k++] = &nd->halo_high;
    GPROJ_ASSERT(k == (int32_t)(sizeof all / sizeof all[0]));
    for (i = 0; i < k; ++i) {
        *all[i] = (int32_t *)gproji_pool_take(pool, n + 1, sizeof(int32_t));
        if (!*all[i]) return false;
    }
    nd->halo = (int32_t *)gproji_pool_take_zeroed(pool, n, sizeof(int32_t));
    nd->halo_of = (int32_t *)gproji_pool_take_zeroed(pool, n, sizeof(int32_t));
    nd->kind = (unsigned char *)gproji_pool_take_zeroed(pool, n, 1);
    nd->side = (unsigned char *)gproji_pool_take(pool, n, 1);
    nd->near = (unsigned char *)gproji_pool_take(pool, n + 1, 1);
    return nd->halo && nd->halo_of && nd->kind && nd->side && nd->near;
}

/* -- nodes that are not dissected -- */

/* Has b all neighbours of a, and a itself? mark: b where its neighbours, and itself, are. */
GPROJI_INTERNAL bool gproji_nd_hosts(const gproji_graph *graph, const int32_t *mark, int32_t b, int32_t a) {
    int64_t e;
    for (e = graph->start[a]; e < graph->start[a + 1]; ++e)
        if (mark[graph->adjacent[e]] != b) return false;
    return true;
}

GPROJI_INTERNAL void gproji_nd_mark_neighbours(const gproji_graph *graph, int32_t *mark, int32_t b) {
    int64_t e;
    if (mark[b] == b) return;
    mark[b] = b;
    for (e = graph->start[b]; e < graph->start[b + 1]; ++e) mark[graph->adjacent[e]] = b;
}

/* Finds the nodes that are not dissected. A light node's heaviest host is kept: hosts of hosts are hosts. */
GPROJI_INTERNAL void gproji_nd_sort_out(gproji_nd *nd, int32_t total) {
    const gproji_graph *graph = nd->graph;
    double dense = gproji_dense_degree(total);
    int32_t a, b, *mark = nd->number;
    int64_t e;
    for (a = 0; a < graph->nodes; ++a) {
        mark[a] = -1;
        if ((double)gproji_graph_degree(graph, a) > dense) nd->kind[a] = GPROJI_ND_DENSE;
    }
    for (b = 0; b < graph->nodes; ++b) {
        if (nd->kind[b] == GPROJI_ND_DENSE) continue;
        for (e = graph->start[b]; e < graph->start[b + 1]; ++e) {
            a = graph->adjacent[e];
            if (nd->kind[a] != GPROJI_ND_KEPT || graph->weight[a] >= graph->weight[b]) continue;
            gproji_nd_mark_neighbours(graph, mark, b);
            if (!gproji_nd_hosts(graph, mark, b, a)) continue;
            nd->kind[a] = GPROJI_ND_LIGHT;
            nd->light++;
        }
    }
}

/* The order of all nodes from that of the kept ones. A light node is taken with its first host. */
GPROJI_INTERNAL void gproji_nd_put_back(gproji_nd *nd, int32_t *order) {
    const gproji_graph *graph = nd->graph;
    int32_t a, b, k, count = 0, *mark = nd->number;
    int64_t e;
    for (b = 0; b < graph->nodes; ++b) mark[b] = -1;
    for (k = 0; k < nd->kept; ++k) {
        b = nd->order[k];
        for (e = graph->start[b]; nd->light > 0 && e < graph->start[b + 1]; ++e) {
            a = graph->adjacent[e];
            if (nd->kind[a] != GPROJI_ND_LIGHT) continue;
            gproji_nd_mark_neighbours(graph, mark, b);
            if (!gproji_nd_hosts(graph, mark, b, a)) continue;
            nd->kind[a] = GPROJI_ND_PLACED;
            order[count++] = a;
        }
        order[count++] = b;
    }
    for (b = 0; b < graph->nodes; ++b)
        if (nd->kind[b] == GPROJI_ND_DENSE) order[count++] = b;
    GPROJ_ASSERT(count == graph->nodes);
}

/* -- parts -- */

/* The first part: all kept nodes, in the order of breadth-first searches, so that neighbours are near each other in
   memory. */
GPROJI_INTERNAL void gproji_nd_begin(gproji_nd *nd) {
    const gproji_graph *graph = nd->graph;
    gproji_nd_nodes *c = &nd->copy[0];
    int32_t root, i, head = 0, tail = 0, *number = nd->number;
    int64_t e, to = 0;
    double weight = 0;
    for (i = 0; i < graph->nodes; ++i) number[i] = -1;
    for (root = 0; root < graph->nodes; ++root) {
        if (nd->kind[root] != GPROJI_ND_KEPT || number[root] >= 0) continue;
        number[root] = tail, c->name[tail++] = root;
        while (head < tail) {
            int32_t at = c->name[head++];
            for (e = graph->start[at]; e < graph->start[at + 1]; ++e) {
                i = graph->adjacent[e];
                if (nd->kind[i] == GPROJI_ND_KEPT && number[i] < 0) number[i] = tail, c->name[tail++] = i;
            }
        }
    }
    for (i = 0; i < tail; ++i) {
        int32_t at = c->name[i];
        weight += c->weight[i] = graph->weight[at];
        c->from[i] = to;
        for (e = graph->start[at]; e < graph->start[at + 1]; ++e)
            if (nd->kind[graph->adjacent[e]] == GPROJI_ND_KEPT) c->adjacent[to++] = number[graph->adjacent[e]];
        c->inner[i] = (int32_t)(to - c->from[i]);
        c->outer[i] = 0;
    }
    nd->kept = tail;
    nd->unit = tail > 0 ? sqrt(weight / tail) : 1;
    memset(&nd->stack[0], 0, sizeof nd->stack[0]);
    nd->stack[0].nodes = tail;
    nd->parts = tail > 0;
}

/* Makes a part the one at work: its nodes, their weight and its halo. */
GPROJI_INTERNAL void gproji_nd_enter(gproji_nd *nd, const gproji_nd_part *part) {
    const gproji_nd_nodes *c = &nd->copy[part->copy];
    gproji_nd_nodes *here = &nd->here;
    int32_t i, k;
    here->name = c->name + part->first, here->weight = c->weight + part->first, here->from = c->from + part->first;
    here->inner = c->inner + part->first, here->outer = c->outer + part->first;
    here->adjacent = c->adjacent;
    nd->nodes = part->nodes;
    nd->rims = nd->halos = 0;
    nd->weight = nd->halo_weight = 0;
    for (i = 0; i < nd->nodes; ++i) {
        int32_t *list = here->adjacent + here->from[i] + here->inner[i];
        nd->weight += here->weight[i];
        if (here->outer[i] > 0) nd->rim[nd->rims++] = i;
        for (k = 0; k < here->outer[i]; ++k) {
            int32_t name = list[k], at = nd->halo_of[name];
            if (at >= nd->halos || nd->halo[at] != name) {
                at = nd->halo_of[name] = nd->halos++;
                nd->halo[at] = name;
                nd->halo_weight += nd->graph->weight[name];
            }
            list[k] = at;
        }
    }
}

GPROJI_INTERNAL void gproji_nd_wait(gproji_nd *nd, int32_t first, int32_t nodes, int32_t place, int32_t copy) {
    gproji_nd_part *part = &nd->stack[nd->parts++];
    GPROJ_ASSERT(nd->parts <= GPROJI_ND_STACK);
    part->first = first, part->nodes = nodes, part->place = place, part->copy = copy;
}

/* Writes the nodes of one side into the other copy, from node `to` on and with arcs from `e` on. Returns where the arcs
   end. */
GPROJI_INTERNAL int64_t gproji_nd_copy_side(gproji_nd *nd, gproji_nd_nodes *b, int32_t side, int32_t to, int64_t e) {
    const gproji_nd_nodes *a = &nd->here;
    int32_t i;
    for (i = 0; i < nd->nodes; ++i) {
        const int32_t *list, *end;
        int32_t all, *in, *out;
        if (nd->side[i] != side) continue;
        list = a->adjacent + a->from[i], end = list + a->inner[i];
        all = a->inner[i] + a->outer[i];
        in = b->adjacent + e, out = in + all;
        b->name[to] = a->name[i], b->weight[to] = a->weight[i];
        b->from[to] = e;
        for (; list < end; ++list) {
            if (nd->side[*list] == 2)
                *--out = a->name[*list];
            else
                *in++ = nd->number[*list];
        }
        b->inner[to] = (int32_t)(in - (b->adjacent + e));
        b->outer[to] = all - b->inner[to];
        for (end += a->outer[i]; list < end; ++list) *in++ = nd->halo[*list];
        e += all;
        to++;
    }
    return e;
}

/* Divides the part by `side`: the separator gets its last places, the sides become parts. */
GPROJI_INTERNAL void gproji_nd_divide(gproji_nd *nd, const gproji_nd_part *part) {
    gproji_nd_nodes *other = &nd->copy[!part->copy];
    int32_t i, count[3] = {0, 0, 0}, at, small;
    int64_t e;
    for (i = 0; i < nd->nodes; ++i) nd->number[i] = count[nd->side[i]]++;
    for (i = 0, at = part->place + count[0] + count[1]; i < nd->nodes; ++i)
        if (nd->side[i] == 2) nd->order[at++] = nd->here.name[i];
    e = gproji_nd_copy_side(nd, other, 0, part->first, nd->here.from[0]);
    gproji_nd_copy_side(nd, other, 1, part->first + count[0], e);
    small = count[1] < count[0];
    for (i = 0; i < 2; ++i) {
        int32_t side = i ? small : !small, skip = side ? count[0] : 0;
        gproji_nd_wait(nd, part->first + skip, count[side], part->place + skip, !part->copy);
    }
}

/* -- coordinates -- */

/* Breadth-first search from a root over nodes without distance (-1). The queue has `tail` nodes before; returns how many
   afterwards. */
GPROJI_INTERNAL int32_t gproji_nd_spread(gproji_nd *nd, int32_t root, int32_t *distance, int32_t tail) {
    const int32_t *inner = nd->here.inner, *adjacent = nd->here.adjacent;
    const int64_t *from = nd->here.from;
    int32_t *queue = nd->queue, head = tail;
    distance[root] = 0;
    queue[tail++] = root;
    while (head < tail) {
        int32_t at = queue[head++], next = distance[at] + 1;
        const int32_t *list = adjacent + from[at], *end = list + inner[at];
        for (; list < end; ++list) {
            if (distance[*list] >= 0) continue;
            distance[*list] = next;
            queue[tail++] = *list;
        }
    }
    return tail;
}

/* The distances of all nodes from one of them. Returns how many it reaches. */
GPROJI_INTERNAL int32_t gproji_nd_search(gproji_nd *nd, int32_t root, int32_t *distance) {
    int32_t i;
    for (i = 0; i < nd->nodes; ++i) distance[i] = -1;
    return gproji_nd_spread(nd, root, distance, 0);
}

/* The node with the largest value; among equals one with few neighbours. */
GPROJI_INTERNAL int32_t gproji_nd_most(const gproji_nd *nd, const int32_t *value) {
    const int32_t *inner = nd->here.inner;
    int32_t i, best = 0;
    for (i = 1; i < nd->nodes; ++i)
        if (value[i] > value[best] || (value[i] == value[best] && inner[i] < inner[best])) best = i;
    return best;
}

/* The node that a search has reached last, or another one as far that has fewer neighbours, which is a corner. */
GPROJI_INTERNAL int32_t gproji_nd_last(const gproji_nd *nd, const int32_t *distance) {
    const int32_t *inner = nd->here.inner;
    int32_t k = nd->nodes - 1, best = nd->queue[k];
    for (; k >= 0 && distance[nd->queue[k]] == distance[best]; --k)
        if (inner[nd->queue[k]] < inner[best]) best = nd->queue[k];
    return best;
}

/* Coordinates from distances, the first ones from node `start`, or from one at the rim if that is 0. Returns how many
   nodes a search reaches; when these are not all, there are none. */
GPROJI_INTERNAL int32_t gproji_nd_coordinates(gproji_nd *nd, int32_t start) {
    int32_t *const *d = nd->distance, *value = nd->position;
    int32_t i, reached = gproji_nd_search(nd, start, d[0]);
    if (reached < nd->nodes) return reached;
    if (start == 0) gproji_nd_search(nd, gproji_nd_last(nd, d[0]), d[0]);
    gproji_nd_search(nd, gproji_nd_last(nd, d[0]), d[1]);
    for (i = 0; i < nd->nodes; ++i) value[i] = d[0][i] + d[1][i];
    gproji_nd_search(nd, gproji_nd_most(nd, value), d[2]);
    for (i = 0; i < nd->nodes; ++i) value[i] += 2 * d[2][i];
    gproji_nd_search(nd, gproji_nd_most(nd, value), d[3]);
    for (i = 0; i < nd->nodes; ++i) d[0][i] -= d[1][i], d[2][i] -= d[3][i];
    return reached;
}

/* Sides of a part that is not connected, after a search that has reached `end` nodes: the components one after the other
   up to half of the nodes, the last one only if it does not end the part. */
GPROJI_INTERNAL void gproji_nd_split_components(gproji_nd *nd, int32_t end) {
    int32_t k, root = 0, before = end;
    while (end < nd->nodes - end) {
        while (nd->distance[0][root] >= 0) ++root;
        before = end;
        end = gproji_nd_spread(nd, root, nd->distance[0], end);
    }
    if (end == nd->nodes) end = before;
    for (k = 0; k < nd->nodes; ++k) nd->side[k] = 1;
    for (k = 0; k < end; ++k) nd->side[nd->queue[k]] = 0;
}

/* -- cuts -- */

/* What the elimination of a part is thought to cost in flops: the solution of
     f(n, h) = s h^2 + s^2 h + s^3 / 3 + 2 f(n / 2, h / 2 + s),  s = c sqrt(n),
   which is its separator's front, with the halo's rows, and twice a half. */
GPROJI_INTERNAL double gproji_nd_rest(const gproji_nd *nd, double n, double h) {
    double c = nd->unit, r = sqrt(n);
    return c * (30.4 * c * c * n * r + 6.38 * c * n * h + 1.55 * r * h * h);
}

/* The same for a part with these weights of its sides and its separator, and of the sides' halos without it. */
GPROJI_INTERNAL double gproji_nd_cost(const gproji_nd *nd, const double weight[3], const double halo[2]) {
    double s = weight[2], h = nd->halo_weight;
    if (weight[0] <= 0 || weight[1] <= 0 || s > weight[0] + weight[1]) return HUGE_VAL;
    return s * (h * h + s * h + s * s / 3) + gproji_nd_rest(nd, weight[0], halo[0] + s) +
           gproji_nd_rest(nd, weight[1], halo[1] + s);
}

/* In a direction, 0 to 3: neighbours differ by at most that much. */
GPROJI_INTERNAL int32_t gproji_nd_jump(int32_t axis) { return axis < 2 ? 2 : 4; }

/* Positions of all nodes along x, y, x + y, x - y, counted from 0, not more of them than nodes. Returns how many. */
GPROJI_INTERNAL int32_t gproji_nd_project(const gproji_nd *nd, int32_t axis, int32_t *position) {
    static const signed char factor[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    int32_t fx = factor[axis][0], fy = factor[axis][1], i, least = INT32_MAX, most = INT32_MIN, shift = 0;
    for (i = 0; i < nd->nodes; ++i) {
        int32_t p = fx * nd->distance[0][i] + fy * nd->distance[2][i];
        position[i] = p;
        if (p < least) least = p;
        if (p > most) most = p;
    }
    while ((most - least) >> shift >= nd->nodes) ++shift;
    for (i = 0; i < nd->nodes; ++i) position[i] = (position[i] - least) >> shift;
    return ((most - least) >> shift) + 1;
}

/* Chooses thresholds that leave 0.3 to 0.7 of the weight below, some tenth apart, and marks the positions near them. */
GPROJI_INTERNAL void gproji_nd_choose_thresholds(gproji_nd *nd, int32_t range, int32_t jump) {
    double below = 0, next = 0.3 * nd->weight;
    int32_t t, r;
    memset(nd->near, 0, (size_t)range + 1);
    for (t = 1; t < range; ++t) {
        below += nd->sum[t - 1];
        if (below < next || below > 0.7 * nd->weight) continue;
        next = below + 0.1 * nd->weight;
        for (r = t > jump ? t - jump : 0; r < t + jump && r < range; ++r) nd->near[r] |= 1;
        nd->near[t] = 3;
    }
}

/* For all thresholds at once, what has neighbours across: in the part, ... */
GPROJI_INTERNAL void gproji_nd_count_inner(gproji_nd *nd, const int32_t *position) {
    const int32_t *adjacent = nd->here.adjacent;
    int32_t i, *low = nd->low, *high = nd->high;
    for (i = 0; i < nd->nodes; ++i) {
        int32_t p = position[i], least = p, most = p, w = nd->here.weight[i];
        const int32_t *list = adjacent + nd->here.from[i], *end = list + nd->here.inner[i];
        if (!nd->near[p]) continue;
        for (; list < end; ++list) {
            int32_t q = position[*list];
            if (q < least) least = q;
            if (q > most) most = q;
        }
        low[p + 1] += w, low[most + 1] -= w;
        high[least + 1] += w, high[p + 1] -= w;
    }
}

/* ... and in the halo. */
GPROJI_INTERNAL void gproji_nd_count_halo(gproji_nd *nd, const int32_t *position) {
    int32_t k, *least = nd->halo_least, *most = nd->halo_most;
    for (k = 0; k < nd->halos; ++k) least[k] = INT32_MAX, most[k] = -1;
    for (k = 0; k < nd->rims; ++k) {
        int32_t i = nd->rim[k], p = position[i];
        const int32_t *list = nd->here.adjacent + nd->here.from[i] + nd->here.inner[i], *end = list + nd->here.outer[i];
        for (; list < end; ++list) {
            if (p < least[*list]) least[*list] = p;
            if (p > most[*list]) most[*list] = p;
        }
    }
    for (k = 0; k < nd->halos; ++k) {
        int32_t w = nd->graph->weight[nd->halo[k]];
        nd->halo_low[least[k] + 1] += w;
        nd->halo_high[most[k] + 1] += w;
    }
}

/* Tries thresholds in one direction; one that beats `best` takes its place, with positions and sums. */
GPROJI_INTERNAL void gproji_nd_try(gproji_nd *nd, int32_t axis, gproji_nd_cut *best) {
    int32_t *position = nd->position, *sum = nd->sum, range = gproji_nd_project(nd, axis, position), i, t;
    double below = 0, low = 0, high = 0, halo[2];
    size_t bytes = ((size_t)range + 1) * sizeof(int32_t);
    bool better = false;
    memset(sum, 0, bytes);
    memset(nd->low, 0, bytes), memset(nd->high, 0, bytes);
    memset(nd->halo_low, 0, bytes), memset(nd->halo_high, 0, bytes);
    for (i = 0; i < nd->nodes; ++i) sum[position[i]] += nd->here.weight[i];
    gproji_nd_choose_thresholds(nd, range, gproji_nd_jump(axis));
    gproji_nd_count_inner(nd, position);
    gproji_nd_count_halo(nd, position);
    halo[0] = 0, halo[1] = nd->halo_weight;
    for (t = 1; t < range; ++t) {
        double weight[3], cost;
        below += sum[t - 1];
        low += nd->low[t], high += nd->high[t];
        halo[0] += nd->halo_low[t], halo[1] -= nd->halo_high[t];
        if (nd->near[t] != 3) continue;
        weight[0] = below, weight[1] = nd->weight - below, weight[2] = low < high ? low : high;
        weight[low < high ? 0 : 1] -= weight[2];
        cost = gproji_nd_cost(nd, weight, halo);
        if (cost >= best->cost) continue;
        best->cost = cost, best->axis = axis, best->at = t, best->range = range, best->below = below;
        best->weight = (int32_t)weight[2];
        better = true;
    }
    if (!better) return;
    nd->position = nd->best_position, nd->best_position = position;
    nd->sum = nd->best_sum, nd->best_sum = sum;
}

/* -- the smallest separator in a band -- */

/* The band of a cut: positions from[0]..from[1]-1, of the weight of a dozen separators, but not more than a quarter of
   the part's; and each rim keeps about a quarter of the weight behind it. */
GPROJI_INTERNAL void gproji_nd_band_limits(const gproji_nd *nd, const gproji_nd_cut *cut, int32_t from[2]) {
    const int32_t *sum = nd->best_sum;
    int32_t low = cut->at > 1 ? cut->at - 1 : cut->at, high = cut->at < cut->range - 1 ? cut->at + 1 : cut->at, i;
    double most = gproji_fmin(12.0 * cut->weight, 0.25 * nd->weight), band = 0, below = 0, above;
    for (i = 0; i < low; ++i) below += sum[i];
    for (; i < high; ++i) band += sum[i];
    above = nd->weight - below - band;
    for (;;) {
        bool down = below > above;
        int32_t more;
        if (down ? low <= 1 : high >= cut->range - 1) break;
        more = sum[down ? low - 1 : high];
        if (band + more > most || (down ? below : above) - more < 0.24 * nd->weight) break;
        band += more;
        if (down)
            below -= more, --low;
        else
            above -= more, ++high;
    }
    from[0] = low, from[1] = high;
}

/* Is node i in the band? So are nodes below it with neighbours above it. */
GPROJI_INTERNAL bool gproji_nd_in_band(const gproji_nd *nd, const gproji_nd_cut *cut, const int32_t from[2],
                                       int32_t i) {
    const int32_t *position = nd->best_position, *list = nd->here.adjacent + nd->here.from[i];
    const int32_t *end = list + nd->here.inner[i];
    if (position[i] >= from[0]) return position[i] < from[1];
    if (position[i] < from[0] - gproji_nd_jump(cut->axis)) return false;
    for (; list < end; ++list)
        if (position[*list] >= from[1]) return true;
    return false;
}

GPROJI_INTERNAL bool gproji_band_take(gproji_heap *heap, gproji_band *band, int64_t nodes, int64_t arcs) {
    size_t ints = (size_t)nodes * 8 + 1 + (size_t)arcs * 3;
    int32_t *at;
    if (!gproji_reserve(heap, &band->block, &band->block_size, ints * sizeof(int32_t) + (size_t)nodes * 3, 1))
        return false;
    at = (int32_t *)band->block;
    band->id = at, at += nodes;
    band->start = at, at += nodes + 1;
    band->weight = at, at += nodes;
    band->through = at, at += nodes;
    band->turn = at, at += 2 * nodes;
    band->queue = at, at += 2 * nodes;
    band->to = at, at += arcs;
    band->mate = at, at += arcs;
    band->flow = at, at += arcs;
    band->ends = (unsigned char *)at;
    band->mark = band->ends + nodes;
    return true;
}

/* The arcs of band node i from number e on, those that lead upwards first: a search then goes ahead first. Returns where
   they end. */
GPROJI_INTERNAL int32_t gproji_nd_band_arcs(gproji_nd *nd, const int32_t from[2], int32_t i, int32_t e) {
    gproji_band *band = &nd->band;
    const int32_t *position = nd->best_position, v = band->id[i], *list = nd->here.adjacent + nd->here.from[v];
    const int32_t *end = list + nd->here.inner[v];
    int32_t stop = e + nd->here.inner[v], back = stop, k;
    band->start[i] = e;
    for (; list < end; ++list) {
        int32_t u = nd->number[*list];
        if (u < 0)
            band->ends[i] |= position[*list] < from[0] ? GPROJI_BAND_SOURCE : GPROJI_BAND_SINK;
        else if (position[*list] > position[v])
            band->to[e++] = u;
        else
            band->to[--back] = u;
    }
    while (back < stop) band->to[e++] = band->to[back++];
    for (k = band->start[i]; k < e; ++k) {
        int32_t u = band->to[k], mate = u < i ? band->start[u] : k;
        band->flow[k] = 0;
        if (u >= i) continue;
        while (band->to[mate] != i) ++mate;
        band->mate[k] = mate, band->mate[mate] = k;
    }
    return e;
}

/* Builds the network. False where there is no memory, or there are more arcs than numbers for them. */
GPROJI_INTERNAL bool gproji_nd_build_band(gproji_nd *nd, const gproji_nd_cut *cut, const int32_t from[2]) {
    gproji_band *band = &nd->band;
    int32_t i, nodes = 0, e = 0;
    int64_t arcs = 0;
    for (i = 0; i < nd->nodes; ++i) {
        nd->number[i] = -1;
        if (!gproji_nd_in_band(nd, cut, from, i)) continue;
        nd->number[i] = nodes;
        nd->queue[nodes++] = i;
        arcs += nd->here.inner[i];
    }
    if (arcs > INT32_MAX) return false;
    if (!gproji_band_take(nd->heap, band, nodes, arcs)) {
        nd->failed = true;
        return false;
    }
    band->nodes = nodes;
    memcpy(band->id, nd->queue, (size_t)nodes * sizeof(int32_t));
    memset(band->ends, 0, (size_t)nodes);
    for (i = 0; i < nodes; ++i) {
        band->weight[i] = nd->here.weight[band->id[i]];
        band->through[i] = 0;
        e = gproji_nd_band_arcs(nd, from, i, e);
    }
    band->start[nodes] = e;
    return true;
}

/* How much more can flow from state s by its step c, and where to: along an arc, or backwards against the flow of one;
   or to the node's other state, which is the step before its arcs and the one behind them. `back`: how much can come from
   there. */
GPROJI_INTERNAL int32_t gproji_band_step(const gproji_band *band, int32_t s, int32_t c, bool back, int32_t *to) {
    int32_t v = s >> 1;
    bool leaves = ((s & 1) != 0) != back; /* at an exit ahead, or at an entry back */
    if (c < band->start[v] || c == band->start[v + 1]) {
        *to = s ^ 1;
        return leaves ? band->through[v] : band->weight[v] - band->through[v];
    }
    *to = 2 * band->to[c] + !(s & 1);
    if (leaves) return INT32_MAX;
    return band->flow[back ? c : band->mate[c]];
}

/* The end of a state's steps. Along arcs nothing can go back from an entry, or come back to an exit, without flow. */
GPROJI_INTERNAL int32_t gproji_band_end(const gproji_band *band, int32_t s, bool back) {
    int32_t v = s >> 1;
    if (((s & 1) != 0) == back && band->through[v] == 0) return band->start[v];
    return band->start[v + 1];
}

/* Looks for a path from a state to the sink over states not yet seen. Returns its last index in the queue, or -1. */
GPROJI_INTERNAL int32_t gproji_band_find_path(gproji_band *band, int32_t source) {
    int32_t *path = band->queue, *turn = band->turn, depth = 0;
    path[0] = source;
    band->mark[source] = GPROJI_BAND_SOURCE;
    while (depth >= 0) {
        int32_t s = path[depth], end = gproji_band_end(band, s, false) + (s & 1), next = -1;
        if ((s & 1) && (band->ends[s >> 1] & GPROJI_BAND_SINK)) return depth;
        for (; turn[s] < end; ++turn[s])
            if (gproji_band_step(band, s, turn[s], false, &next) > 0 && !band->mark[next]) break;
        if (turn[s] < end) {
            band->mark[next] = GPROJI_BAND_SOURCE;
            path[++depth] = next;
        } else {
            --depth;
        }
    }
    return -1;
}

/* Sends as much as possible along the path; its states may be seen again. */
GPROJI_INTERNAL void gproji_band_push(gproji_band *band, int32_t depth) {
    const int32_t *path = band->queue;
    int32_t k, amount = INT32_MAX, to;
    for (k = 0; k < depth; ++k) {
        int32_t room = gproji_band_step(band, path[k], band->turn[path[k]], false, &to);
        if (room < amount) amount = room;
    }
    for (k = 0; k < depth; ++k) {
        int32_t s = path[k], c = band->turn[s];
        if ((path[k + 1] ^ s) == 1)
            band->through[s >> 1] += s & 1 ? -amount : amount;
        else if (s & 1)
            band->flow[c] += amount;
        else
            band->flow[band->mate[c]] -= amount;
        band->mark[s] = 0;
    }
    band->mark[path[depth]] = 0;
}

/* A round: paths from all sources, none through states from which the sink was not reached before. False when there was
   none; then all that is reached from the source is marked. */
GPROJI_INTERNAL bool gproji_band_round(gproji_band *band) {
    int32_t i, depth;
    bool found = false;
    memset(band->mark, 0, 2 * (size_t)band->nodes);
    for (i = 0; i < band->nodes; ++i) {
        band->turn[2 * i] = band->start[i] - 1; /* at an entry the own exit first, at an exit the own entry last */
        band->turn[2 * i + 1] = band->start[i];
    }
    for (i = 0; i < band->nodes; ++i) {
        if (!(band->ends[i] & GPROJI_BAND_SOURCE)) continue;
        while (!band->mark[2 * i] && (depth = gproji_band_find_path(band, 2 * i)) >= 0) {
            gproji_band_push(band, depth);
            found = true;
        }
    }
    return found;
}

/* Marks what the states in the queue reach, or what reaches them. */
GPROJI_INTERNAL void gproji_band_spread(gproji_band *band, int32_t tail, unsigned char mark, bool back) {
    int32_t head = 0, c, to;
    while (head < tail) {
        int32_t s = band->queue[head++], end = gproji_band_end(band, s, back);
        for (c = band->start[s >> 1] - 1; c < end; ++c) {
            if (gproji_band_step(band, s, c, back, &to) <= 0 || (band->mark[to] & mark)) continue;
            band->mark[to] |= mark;
            band->queue[tail++] = to;
        }
    }
}

/* Marks for the cuts next to the sink and next to the threshold. Returns how many cuts there are: 1 when all are one. */
GPROJI_INTERNAL int32_t gproji_nd_mark_cuts(gproji_nd *nd, const gproji_nd_cut *cut) {
    gproji_band *band = &nd->band;
    int32_t i, tail = 0, states = 2 * band->nodes, open = 0;
    for (i = 0; i < band->nodes; ++i) {
        if (!(band->ends[i] & GPROJI_BAND_SINK)) continue;
        band->mark[2 * i + 1] |= GPROJI_BAND_SINK;
        band->queue[tail++] = 2 * i + 1;
    }
    gproji_band_spread(band, tail, GPROJI_BAND_SINK, true);
    for (i = tail = 0; i < states; ++i) {
        bool below = nd->best_position[band->id[i >> 1]] < cut->at;
        if (!band->mark[i]) ++open;
        if ((band->mark[i] & GPROJI_BAND_SOURCE) || (below && !band->mark[i])) {
            band->mark[i] |= GPROJI_BAND_MIDDLE;
            band->queue[tail++] = i;
        }
    }
    if (open > 0) gproji_band_spread(band, tail, GPROJI_BAND_MIDDLE, false);
    return open > 0 ? 3 : 1;
}

/* The side of a band node by one of the cuts: above when the lower side does not reach its entry, separator when it does
   not reach its exit. */
GPROJI_INTERNAL int32_t gproji_band_side(const gproji_band *band, int32_t i, unsigned char mark) {
    bool in = (band->mark[2 * i] & mark) != 0, out = (band->mark[2 * i + 1] & mark) != 0;
    if (mark == GPROJI_BAND_SINK) in = !in, out = !out;
    return out ? 0 : in ? 2 : 1;
}

/* The side of any node of the part. */
GPROJI_INTERNAL int32_t gproji_nd_side(const gproji_nd *nd, const int32_t from[2], int32_t i, unsigned char mark) {
    if (nd->number[i] >= 0) return gproji_band_side(&nd->band, nd->number[i], mark);
    return nd->best_position[i] >= from[1];
}

/* What the part costs when cut there. */
GPROJI_INTERNAL double gproji_nd_measure(gproji_nd *nd, const gproji_nd_cut *cut, const int32_t from[2],
                                         unsigned char mark) {
    double weight[3] = {0, 0, 0}, halo[2] = {0, 0};
    const gproji_band *band = &nd->band;
    int32_t i, k;
    for (i = 0; i < from[0]; ++i) weight[0] += nd->best_sum[i];
    for (i = from[1]; i < cut->range; ++i) weight[1] += nd->best_sum[i];
    for (i = 0; i < band->nodes; ++i) {
        weight[gproji_band_side(band, i, mark)] += band->weight[i];
        if (nd->best_position[band->id[i]] < from[0]) weight[0] -= band->weight[i]; /* counted among those below */
    }
    for (k = 0; k < nd->halos; ++k) nd->halo_least[k] = 0;
    for (k = 0; k < nd->rims; ++k) {
        int32_t v = nd->rim[k], side = gproji_nd_side(nd, from, v, mark);
        const int32_t *list = nd->here.adjacent + nd->here.from[v] + nd->here.inner[v], *end = list + nd->here.outer[v];
        if (side == 2) continue;
        for (; list < end; ++list) nd->halo_least[*list] |= 1 << side;
    }
    for (k = 0; k < nd->halos; ++k) {
        if (nd->halo_least[k] & 1) halo[0] += nd->graph->weight[nd->halo[k]];
        if (nd->halo_least[k] & 2) halo[1] += nd->graph->weight[nd->halo[k]];
    }
    return gproji_nd_cost(nd, weight, halo);
}

/* Finds the separator of a cut: `side`. False where there is none, or no memory. */
GPROJI_INTERNAL bool gproji_nd_separate(gproji_nd *nd, const gproji_nd_cut *cut) {
    static const unsigned char marks[3] = {GPROJI_BAND_MIDDLE, GPROJI_BAND_SOURCE, GPROJI_BAND_SINK};
    int32_t from[2], i, cuts, rounds = 0, use = 0;
    double best;
    gproji_nd_band_limits(nd, cut, from);
    if (!gproji_nd_build_band(nd, cut, from)) return false;
    while (gproji_band_round(&nd->band))
        if (++rounds == GPROJI_ND_ROUNDS) return false;
    cuts = gproji_nd_mark_cuts(nd, cut);
    best = gproji_nd_measure(nd, cut, from, marks[0]);
    for (i = 1; i < cuts; ++i) {
        double cost = gproji_nd_measure(nd, cut, from, marks[i]);
        if (cost < best) best = cost, use = i;
    }
    for (i = 0; i < nd->nodes; ++i) nd->side[i] = (unsigned char)gproji_nd_side(nd, from, i, marks[use]);
    return best < HUGE_VAL;
}

/* -- parts that are not cut any more -- */

/* A small part: sets of neighbours as bits; first those of its own nodes, then of its halo's. `plane` p has the nodes
   whose weights contain unit[p]. */
typedef struct gproji_nd_leaf {
    int32_t words, planes;
    uint64_t set[GPROJI_ND_LEAF][GPROJI_ND_WORDS];
    uint64_t plane[32][GPROJI_ND_WORDS];
    int32_t unit[32];
    int32_t degree[GPROJI_ND_LEAF];
} gproji_nd_leaf;

/* How many bits are set. */
GPROJI_INTERNAL int32_t gproji_bits(uint64_t x) {
    x -= (x >> 1) & 0x5555555555555555u;
    x = (x & 0x3333333333333333u) + ((x >> 2) & 0x3333333333333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fu;
    return (int32_t)((x * 0x0101010101010101u) >> 56);
}

/* The number of the lowest bit of x > 0. */
GPROJI_INTERNAL int32_t gproji_lowest_bit(uint64_t x) { return gproji_bits((x & (~x + 1)) - 1); }

GPROJI_INTERNAL int32_t gproji_nd_leaf_degree(const gproji_nd_leaf *leaf, const uint64_t *set) {
    int32_t degree = 0, p, k;
    for (p = 0; p < leaf->planes; ++p) {
        int32_t count = 0;
        for (k = 0; k < leaf->words; ++k) count += gproji_bits(set[k] & leaf->plane[p][k]);
        degree += count * leaf->unit[p];
    }
    return degree;
}

/* The planes of the weights; equal ones are one. */
GPROJI_INTERNAL void gproji_nd_leaf_weigh(const gproji_nd *nd, gproji_nd_leaf *leaf, int32_t halos) {
    int32_t bit, i, all = 0, p = 0;
    for (i = 0; i < nd->nodes; ++i) all |= nd->here.weight[i];
    for (i = 0; i < halos; ++i) all |= nd->graph->weight[nd->halo[i]];
    for (bit = 0; bit < 31; ++bit) {
        uint64_t *plane = leaf->plane[p];
        if (!(all >> bit & 1)) continue;
        memset(plane, 0, sizeof leaf->plane[0]);
        for (i = 0; i < nd->nodes; ++i) plane[0] |= (uint64_t)(nd->here.weight[i] >> bit & 1) << i;
        for (i = 0; i < halos; ++i)
            plane[1 + i / 64] |= (uint64_t)(nd->graph->weight[nd->halo[i]] >> bit & 1) << i % 64;
        if (p > 0 && memcmp(plane, leaf->plane[p - 1], sizeof leaf->plane[0]) == 0)
            leaf->unit[p - 1] += (int32_t)1 << bit;
        else
            leaf->unit[p++] = (int32_t)1 << bit;
    }
    leaf->planes = p;
}

GPROJI_INTERNAL void gproji_nd_leaf_start(const gproji_nd *nd, gproji_nd_leaf *leaf) {
    int32_t i, halos = gproji_min(nd->halos, GPROJI_ND_HALO);
    leaf->words = 1 + (halos + 63) / 64;
    gproji_nd_leaf_weigh(nd, leaf, halos);
    memset(leaf->set, 0, (size_t)nd->nodes * sizeof leaf->set[0]);
    for (i = 0; i < nd->nodes; ++i) {
        const int32_t *list = nd->here.adjacent + nd->here.from[i], *end = list + nd->here.inner[i];
        uint64_t *set = leaf->set[i];
        for (; list < end; ++list) set[0] |= (uint64_t)1 << *list;
        for (end += nd->here.outer[i]; list < end; ++list)
            if (*list < halos) set[1 + *list / 64] |= (uint64_t)1 << *list % 64;
        leaf->degree[i] = gproji_nd_leaf_degree(leaf, set);
    }
}

/* Orders a small part by minimum degree. */
GPROJI_INTERNAL void gproji_nd_order_leaf(gproji_nd *nd, int32_t place) {
    gproji_nd_leaf leaf;
    uint64_t alive = ~(uint64_t)0 >> (64 - nd->nodes), todo;
    int32_t i, k;
    gproji_nd_leaf_start(nd, &leaf);
    while (alive) {
        int32_t pivot = 0;
        for (i = 1; i < nd->nodes; ++i)
            if (leaf.degree[i] < leaf.degree[pivot]) pivot = i;
        nd->order[place++] = nd->here.name[pivot];
        leaf.degree[pivot] = INT32_MAX;
        alive &= ~((uint64_t)1 << pivot);
        for (todo = leaf.set[pivot][0] & alive; todo; todo &= todo - 1) {
            uint64_t *set;
            i = gproji_lowest_bit(todo);
            set = leaf.set[i];
            for (k = 0; k < leaf.words; ++k) set[k] |= leaf.set[pivot][k];
            set[0] &= alive & ~((uint64_t)1 << i);
            leaf.degree[i] = gproji_nd_leaf_degree(&leaf, set);
        }
    }
}

/* Orders a part without a good separator by approximate minimum degree. */
GPROJI_INTERNAL void gproji_nd_order_whole(gproji_nd *nd, int32_t place) {
    const gproji_nd_nodes *here = &nd->here;
    int64_t *start, to = 0;
    int32_t *adjacent, *order, i, k;
    gproji_graph graph;
    gproji_pool pool;
    gproji_pool_start(&pool, nd->heap);
    for (i = 0; i < nd->nodes; ++i) to += here->inner[i];
    start = (int64_t *)gproji_pool_take(&pool, (int64_t)nd->nodes + 1, sizeof(int64_t));
    adjacent = (int32_t *)gproji_pool_take(&pool, to, sizeof(int32_t));
    order = (int32_t *)gproji_pool_take(&pool, nd->nodes, sizeof(int32_t));
    if (start && adjacent && order) {
        for (i = 0, to = 0; i < nd->nodes; ++i) {
            start[i] = to;
            for (k = 0; k < here->inner[i]; ++k) adjacent[to++] = here->adjacent[here->from[i] + k];
        }
        start[nd->nodes] = to;
        graph.nodes = nd->nodes, graph.start = start, graph.adjacent = adjacent, graph.weight = here->weight;
        if (!gproji_amd_order(nd->heap, &graph, (int32_t)nd->weight, order, NULL)) nd->failed = true;
        for (i = 0; i < nd->nodes && !nd->failed; ++i) nd->order[place + i] = here->name[order[i]];
    } else {
        nd->failed = true;
    }
    gproji_pool_give_all(&pool);
}

/* Finds the best cut of the part at work. Where that of the largest part, on which most depends, is far from the middle,
   other coordinates are tried: closed meshes have no rim, and some nodes are better starts than others. Returns how many
   nodes are connected; when these are not all, there is no cut. */
GPROJI_INTERNAL int32_t gproji_nd_find_cut(gproji_nd *nd, gproji_nd_cut *best) {
    int32_t starts = nd->nodes > nd->kept / 2 ? GPROJI_ND_STARTS : 1, k, axis, reached = 0;
    memset(best, 0, sizeof *best);
    best->cost = HUGE_VAL;
    for (k = 0; k < starts; ++k) {
        reached = gproji_nd_coordinates(nd, (int32_t)((int64_t)nd->nodes * k / starts));
        if (reached < nd->nodes) break;
        for (axis = 0; axis < 4; ++axis) gproji_nd_try(nd, axis, best);
        if (best->below > 0.4 * nd->weight && best->below < 0.6 * nd->weight) break;
    }
    return reached;
}

/* Orders the part on top of the stack or cuts it. */
GPROJI_INTERNAL void gproji_nd_next(gproji_nd *nd) {
    gproji_nd_part part = nd->stack[--nd->parts];
    gproji_nd_cut best;
    int32_t reached;
    gproji_nd_enter(nd, &part);
    if (part.nodes <= GPROJI_ND_LEAF) {
        gproji_nd_order_leaf(nd, part.place);
        return;
    }
    reached = gproji_nd_find_cut(nd, &best);
    if (reached < part.nodes) {
        gproji_nd_split_components(nd, reached);
        gproji_nd_divide(nd, &part);
        return;
    }
    if (best.cost < HUGE_VAL && gproji_nd_separate(nd, &best)) {
        gproji_nd_divide(nd, &part);
    } else {
        gproji_nd_order_whole(nd, part.place);
    }
}

/* Finds the order (nodes entries: the node that is eliminated k-th). `total` is the weight of all nodes, which are fewer
   than 2^29. False when there is no memory. */
GPROJI_INTERNAL bool gproji_dissect(gproji_heap *heap, const gproji_graph *graph, int32_t total, int32_t *order) {
    gproji_pool pool;
    gproji_nd nd;
    gproji_pool_start(&pool, heap);
    memset(&nd, 0, sizeof nd);
    nd.heap = heap;
    nd.graph = graph;
    nd.failed = !gproji_nd_take(&nd, &pool);
    if (!nd.failed) {
        gproji_nd_sort_out(&nd, total);
        gproji_nd_begin(&nd);
    }
    while (nd.parts > 0 && !nd.failed) gproji_nd_next(&nd);
    if (!nd.failed) gproji_nd_put_back(&nd, order);
    gproji_give(heap, nd.band.block, nd.band.block_size, 1);
    gproji_pool_give_all(&pool);
    return !nd.failed;
}

/* ============================================================================================================
   >>symbolic   What a factorisation will look like, from the graph alone. Uses platform, memory, dense, ordering,
   dissection.

   Works on the graph of nodes; counts, flops and offsets are in variables. In this order: elimination tree (Liu 1986),
   postorder, column counts (Gilbert, Ng, Peyton 1994), supernodes and their relaxation (Ashcraft, Grimes 1989), row
   structures, then the layout of the multifrontal method (Duff, Reid 1983; Liu 1992): where each front's panel is in
   the factor, where its update matrix is in the work memory, and which fronts make up a task.

   A "place" is a node's position in the order of elimination; its variables have consecutive columns of L. A front
   (supernode) has `width` pivot columns, consecutive in L, and `below` rows under them, which belong to `row_nodes`
   whole nodes with ascending places. Invariants: a front's parent has a larger number and holds the front's first row
   node among its pivots; all rows of a front are pivots or rows of its parent. */
typedef struct gproji_front {
    int64_t panel;  /* where its panel begins in the values of L */
    int64_t update; /* where its update matrix begins in the work memory */
    int64_t rows;   /* its row nodes are row_node[rows..rows+row_nodes-1] */
    int64_t side;   /* `below` rows of all fronts before it: where it keeps its part of a right-hand side */
    int32_t row_nodes;
    int32_t first_place, end_place; /* its pivot nodes */
    int32_t first;                  /* its first column of L */
    int32_t width;
    int32_t below;
    int32_t stride;      /* of its panel, which has as many storage rows: see >>dense */
    int32_t update_rows; /* `below`, rounded up: the rows of its update matrix */
    int32_t parent;      /* -1: none */
    int32_t child;       /* first child, or -1 */
    int32_t sibling;     /* next child of the same parent, or -1 */
    int32_t depth;       /* 0 without parent */
} gproji_front;

typedef struct gproji_symbolic {
    int32_t columns;
    int32_t nodes;
    int32_t fronts;
    int32_t tasks;         /* independent tasks; the fronts on top of them are one more group */
    int32_t *order;        /* nodes: the node at each place */
    int32_t *place;        /* nodes: the place of each node */
    int32_t *column;       /* nodes + 1: the first column of L of the node at each place */
    int32_t *front_of;     /* nodes: the front of each place */
    gproji_front *front;   /* fronts */
    int32_t *row_node;     /* row nodes of all fronts: their places */
    int32_t *row_at;       /* for each of them, its first storage row in the front's panel */
    int32_t *relative;     /* for each of them, its first storage row in the parent's panel */
    int32_t *schedule;     /* fronts: those of task 0 in order, of task 1, ..., those on top */
    int32_t *task_start;   /* tasks + 2: where the groups begin in `schedule` */
    int64_t *pieces_start; /* tasks + 2: where the groups' room for pieces begins */
    int64_t work_size;     /* doubles for all update matrices */
    int64_t values_size;   /* doubles for all panels */
    int64_t side_size;     /* `below` rows of all fronts */
    int64_t factor_entries, exact_entries;
    int32_t most_rows; /* storage rows of the largest panel */
    double flops;
} gproji_symbolic;

enum {
    GPROJI_TASK_SHARE = 24
}; /* a task has at most about this part of all flops */

/* Arrays of the analysis that are not kept; all have `nodes` entries and are indexed by place or supernode. */
typedef struct gproji_analysis {
    const gproji_graph *graph;
    gproji_symbolic *out;
    gproji_pool *keep;      /* for what is kept */
    gproji_pool pool;       /* for what is not */
    int32_t *parent;        /* elimination tree, by place; -1: root */
    int32_t *count;         /* weight of a place's column of L, its own weight included */
    int32_t *rows;          /* the same in nodes */
    int32_t *a, *b, *c, *d; /* of several uses */
    /* supernodes */
    int32_t supernodes;
    int32_t *head, *tail; /* first and last place of the chain of its nodes */
    int32_t *chain;       /* by place: next place of the same supernode, or -1 */
    int32_t *width, *below, *below_nodes;
    int32_t *super_parent, *child, *sibling;
} gproji_analysis;

GPROJI_INTERNAL bool gproji_analysis_take(gproji_analysis *an) {
    int64_t n = an->graph->nodes;
    int32_t **all[16];
    int32_t i;
    all[0] = &an->parent, all[1] = &an->count, all[2] = &an->rows, all[3] = &an->a;
    all[4] = &an->b, all[5] = &an->c, all[6] = &an->d, all[7] = &an->head;
    all[8] = &an->tail, all[9] = &an->chain, all[10] = &an->width, all[11] = &an->below;
    all[12] = &an->below_nodes, all[13] = &an->super_parent, all[14] = &an->child, all[15] = &an->sibling;
    for (i = 0; i < 16; ++i) {
        *all[i] = (int32_t *)gproji_pool_take(&an->pool, n, sizeof(int32_t));
        if (!*all[i]) return false;
    }
    return true;
}

GPROJI_INTERNAL void gproji_invert(int32_t count, const int32_t *order, int32_t *place) {
    int32_t k;
    for (k = 0; k < count; ++k) place[order[k]] = k;
}

/* parent[k] = min { i > k : L_ik != 0 }. ancestor: work, shortcuts towards the root. */
GPROJI_INTERNAL void gproji_elimination_tree(const gproji_graph *graph, const int32_t *order, const int32_t *place,
                                             int32_t *parent, int32_t *ancestor) {
    int32_t k, i, above;
    int64_t e;
    for (k = 0; k < graph->nodes; ++k) {
        parent[k] = ancestor[k] = -1;
        for (e = graph->start[order[k]]; e < graph->start[order[k] + 1]; ++e) {
            for (i = place[graph->adjacent[e]]; i >= 0 && i < k; i = above) {
                above = ancestor[i];
                ancestor[i] = k;
                if (above < 0) parent[i] = k;
            }
        }
    }
}

/* Lists of children of a forest, ascending. Returns the first root; the roots are siblings. */
GPROJI_INTERNAL int32_t gproji_children(int32_t count, const int32_t *parent, int32_t *child, int32_t *sibling) {
    int32_t k, roots = -1;
    for (k = 0; k < count; ++k) child[k] = -1;
    for (k = count - 1; k >= 0; --k) {
        int32_t *list = parent[k] < 0 ? &roots : &child[parent[k]];
        sibling[k] = *list;
        *list = k;
    }
    return roots;
}

/* sequence[k] = the k-th node in postorder of the forest given by its lists of children, which are used up. */
GPROJI_INTERNAL void gproji_postorder(int32_t roots, const int32_t *parent, int32_t *child, const int32_t *sibling,
                                      int32_t *sequence) {
    int32_t count = 0, root;
    for (root = roots; root >= 0; root = sibling[root]) {
        int32_t at = root;
        for (;;) {
            while (child[at] >= 0) { /* down to a leaf */
                int32_t down = child[at];
                child[at] = sibling[down];
                at = down;
            }
            sequence[count++] = at;
            if (at == root) break;
            at = parent[at];
        }
    }
}

/* Renumbers places by the postorder of the elimination tree: every subtree gets consecutive places. */
GPROJI_INTERNAL void gproji_apply_postorder(gproji_analysis *an) {
    gproji_symbolic *out = an->out;
    int32_t n = out->nodes, k, *sequence = an->c, *renamed = an->d;
    int32_t roots = gproji_children(n, an->parent, an->a, an->b);
    gproji_postorder(roots, an->parent, an->a, an->b, sequence);
    gproji_invert(n, sequence, renamed);
    for (k = 0; k < n; ++k) {
        int32_t up = an->parent[sequence[k]];
        an->a[k] = out->order[sequence[k]];
        an->b[k] = up < 0 ? -1 : renamed[up];
    }
    memcpy(out->order, an->a, (size_t)n * sizeof(int32_t));
    memcpy(an->parent, an->b, (size_t)n * sizeof(int32_t));
    gproji_invert(n, out->order, out->place);
}

/* The last node of the path from i to the root that `ancestor` leads to; shortens the path. */
GPROJI_INTERNAL int32_t gproji_find(int32_t *ancestor, int32_t i) {
    int32_t root = i, next;
    while (ancestor[root] != root) root = ancestor[root];
    for (; ancestor[i] != root; i = next) {
        next = ancestor[i];
        ancestor[i] = root;
    }
    return root;
}

/* Column counts of a postordered tree (Gilbert, Ng, Peyton 1994). Row i of L is a subtree of the elimination tree with
   root i; its weight is added at its leaves, taken off where two of its branches meet and above its root, so that sums
   over subtrees give each column what its rows weigh. */
GPROJI_INTERNAL void gproji_column_counts(gproji_analysis *an) {
    const gproji_graph *graph = an->graph;
    const int32_t *order = an->out->order, *place = an->out->place;
    int32_t n = graph->nodes, k;
    int32_t *first = an->a;    /* first place of the subtree of each place */
    int32_t *last = an->b;     /* last leaf met of each row's subtree, or -1 */
    int32_t *ancestor = an->c; /* see gproji_find */
    int64_t e;
    for (k = 0; k < n; ++k) first[k] = last[k] = -1, ancestor[k] = k, an->count[k] = an->rows[k] = 0;
    for (k = 0; k < n; ++k) {
        int32_t i;
        if (first[k] < 0) an->count[k] = graph->weight[order[k]], an->rows[k] = 1; /* a leaf of its own row */
        for (i = k; i >= 0 && first[i] < 0; i = an->parent[i]) first[i] = k;
    }
    for (k = 0; k < n; ++k) {
        int32_t own = graph->weight[order[k]], up = an->parent[k];
        if (up >= 0) an->count[up] -= own, an->rows[up] -= 1;
        for (e = graph->start[order[k]]; e < graph->start[order[k] + 1]; ++e) {
            int32_t i = place[graph->adjacent[e]], weight, meet;
            if (i <= k || first[k] <= last[i]) continue; /* k is no leaf of the subtree of row i */
            weight = graph->weight[order[i]];
            an->count[k] += weight, an->rows[k] += 1;
            if (last[i] >= 0) {
                meet = gproji_find(ancestor, last[i]);
                an->count[meet] -= weight, an->rows[meet] -= 1;
            }
            last[i] = k;
        }
        if (up >= 0) ancestor[k] = up;
    }
    for (k = 0; k < n; ++k) {
        int32_t up = an->parent[k];
        if (up >= 0) an->count[up] += an->count[k], an->rows[up] += an->rows[k];
    }
}

/* The same for any numbering, by walking along the subtree of every row: O(entries of L). */
GPROJI_INTERNAL void gproji_column_counts_by_rows(gproji_analysis *an) {
    const gproji_graph *graph = an->graph;
    int32_t n = graph->nodes, i, k, *mark = an->a;
    int64_t e;
    for (i = 0; i < n; ++i) {
        int32_t node = an->out->order[i];
        mark[i] = i;
        an->count[i] = graph->weight[node], an->rows[i] = 1;
        for (e = graph->start[node]; e < graph->start[node + 1]; ++e) {
            k = an->out->place[graph->adjacent[e]];
            for (; k < i && mark[k] != i; k = an->parent[k]) {
                mark[k] = i;
                an->count[k] += graph->weight[node], an->rows[k] += 1;
            }
        }
    }
}

/* Cuts the places into chains k, k + 1, ... of columns with the same rows below: the supernodes without zeros. */
GPROJI_INTERNAL void gproji_find_supernodes(gproji_analysis *an) {
    int32_t n = an->graph->nodes, k, s = -1, *super_of = an->a;
    for (k = 0; k < n; ++k) {
        int32_t weight = an->graph->weight[an->out->order[k]];
        bool joins = k > 0 && an->parent[k - 1] == k && an->rows[k - 1] == an->rows[k] + 1;
        an->chain[k] = -1;
        if (joins) {
            an->chain[k - 1] = k;
        } else {
            ++s;
            an->head[s] = k;
            an->width[s] = 0;
        }
        an->tail[s] = k;
        an->width[s] += weight;
        an->below[s] = an->count[k] - weight;
        an->below_nodes[s] = an->rows[k] - 1;
        super_of[k] = s;
    }
    an->supernodes = s + 1;
    for (s = 0; s < an->supernodes; ++s) {
        int32_t up = an->parent[an->tail[s]];
        an->super_parent[s] = up < 0 ? -1 : super_of[up];
    }
}

/* What a front costs, in units of about a processor cycle: a fixed part, arithmetic, its panel, its update matrix
   (written once, added to the parent once). Wide panels compute faster. Fitted to measurements; only the choice of
   supernodes depends on it. */
GPROJI_INTERNAL double gproji_front_cost(double width, double below) {
    double rows = width + below;
    double flops = width * (below * rows + width * width / 3.0);
    return 200.0 + flops / 30.0 + 2.0 * width * rows + 20.0 * width + 0.7 * below * below + 4.0 * below;
}

/* Keeps the supernodes that are not joined to their parent, numbered anew in the same order. joined: 0 or 1 for each on
   entry; work. */
GPROJI_INTERNAL void gproji_keep_supernodes(gproji_analysis *an, int32_t *joined) {
    int32_t s, kept = 0, *host = an->c, *number = an->d; /* host: the supernode that s is now part of */
    for (s = an->supernodes - 1; s >= 0; --s) host[s] = joined[s] ? host[an->super_parent[s]] : s;
    for (s = 0; s < an->supernodes; ++s) {
        number[s] = kept;
        if (!joined[s]) kept++;
    }
    for (s = 0; s < an->supernodes; ++s) {
        int32_t up = an->super_parent[s], to = number[s];
        if (joined[s]) continue; /* to <= s: what is overwritten has been moved already */
        an->super_parent[to] = up < 0 ? -1 : number[host[up]];
        an->head[to] = an->head[s], an->tail[to] = an->tail[s];
        an->width[to] = an->width[s], an->below[to] = an->below[s], an->below_nodes[to] = an->below_nodes[s];
    }
    an->supernodes = kept;
}

/* Joins children to their parents where that is cheaper, although it puts zeros into the factor. Parents come after
   their children, so p's children are final when p's turn comes; the children of a joined child become p's. */
GPROJI_INTERNAL void gproji_relax_supernodes(gproji_analysis *an) {
    int32_t p, *joined = an->b; /* is the supernode part of another one */
    for (p = 0; p < an->supernodes; ++p) an->child[p] = -1, joined[p] = 0;
    for (p = 0; p < an->supernodes; ++p) {
        int32_t *link = &an->child[p];
        double cost = gproji_front_cost(an->width[p], an->below[p]);
        while (*link >= 0) {
            int32_t c = *link, width = an->width[p] + an->width[c];
            double both = gproji_front_cost(width, an->below[p]);
            if (both > cost + gproji_front_cost(an->width[c], an->below[c])) {
                link = &an->sibling[c];
                continue;
            }
            cost = both;
            joined[c] = 1;
            an->width[p] = width;
            an->chain[an->tail[c]] = an->head[p];
            an->head[p] = an->head[c];
            if (an->child[c] >= 0) { /* its children take its place in the list */
                int32_t *end = &an->child[c];
                *link = an->child[c];
                while (*end >= 0) end = &an->sibling[*end];
                *end = an->sibling[c];
            } else {
                *link = an->sibling[c];
            }
        }
        if (an->super_parent[p] >= 0) {
            an->sibling[p] = an->child[an->super_parent[p]];
            an->child[an->super_parent[p]] = p;
        }
    }
    gproji_keep_supernodes(an, joined);
}

/* Turns the supernodes into fronts: in postorder of their tree, and the places with them, unless `keep_order`. */
GPROJI_INTERNAL bool gproji_make_fronts(gproji_analysis *an, bool keep_order) {
    gproji_symbolic *out = an->out;
    int32_t n = out->nodes, count = an->supernodes, k, f, at = 0, column = 0;
    int32_t *sequence = an->a, *number = an->b, *order = an->c;
    int32_t roots = gproji_children(count, an->super_parent, an->child, an->sibling);
    gproji_postorder(roots, an->super_parent, an->child, an->sibling, sequence);
    if (keep_order)
        for (k = 0; k < count; ++k) sequence[k] = k;
    gproji_invert(count, sequence, number);
    out->fronts = count;
    out->front = (gproji_front *)gproji_pool_take_zeroed(an->keep, count, sizeof(gproji_front));
    if (!out->front) return false;
    for (f = 0; f < count; ++f) {
        int32_t s = sequence[f], up = an->super_parent[s];
        gproji_front *front = &out->front[f];
        front->first_place = at;
        front->first = column;
        front->width = an->width[s];
        front->below = an->below[s];
        front->row_nodes = an->below_nodes[s];
        front->parent = up < 0 ? -1 : number[up];
        for (k = an->head[s]; k >= 0; k = an->chain[k]) {
            order[at] = out->order[k];
            out->front_of[at] = f;
            out->column[at] = column;
            column += an->graph->weight[order[at++]];
        }
        front->end_place = at;
        GPROJ_ASSERT(column == front->first + front->width);
    }
    out->column[n] = column;
    memcpy(out->order, order, (size_t)n * sizeof(int32_t));
    gproji_invert(n, out->order, out->place);
    return true;
}

/* The rows of every front: row i belongs to all fronts on the paths from its entries in A up to its own front. Going
   through the rows in ascending order leaves every list sorted. */
GPROJI_INTERNAL bool gproji_find_rows(gproji_analysis *an) {
    gproji_symbolic *out = an->out;
    const gproji_graph *graph = an->graph;
    int32_t f, i, *filled = an->a, *mark = an->b;
    int64_t total = 0, e, r;
    for (f = 0; f < out->fronts; ++f) {
        out->front[f].rows = total;
        total += out->front[f].row_nodes;
        filled[f] = 0, mark[f] = -1;
    }
    out->row_node = (int32_t *)gproji_pool_take(an->keep, total, sizeof(int32_t));
    out->row_at = (int32_t *)gproji_pool_take(an->keep, total, sizeof(int32_t));
    out->relative = (int32_t *)gproji_pool_take(an->keep, total, sizeof(int32_t));
    if (!out->row_node || !out->row_at || !out->relative) return false;
    for (i = 0; i < out->nodes; ++i) {
        int32_t node = out->order[i], own = out->front_of[i];
        for (e = graph->start[node]; e < graph->start[node + 1]; ++e) {
            int32_t k = out->place[graph->adjacent[e]];
            if (k >= i) continue;
            for (f = out->front_of[k]; f != own && mark[f] != i; f = out->front[f].parent) {
                gproji_front *front = &out->front[f];
                mark[f] = i;
                GPROJ_ASSERT(filled[f] < front->row_nodes);
                out->row_node[front->rows + filled[f]++] = i;
            }
        }
    }
    for (f = 0; f < out->fronts; ++f) {
        const gproji_front *front = &out->front[f];
        int32_t at = front->width + gproji_panel_shift(front->width);
        GPROJ_ASSERT(filled[f] == front->row_nodes);
        for (r = front->rows; r < front->rows + front->row_nodes; ++r) {
            out->row_at[r] = at;
            at += graph->weight[out->order[out->row_node[r]]];
        }
    }
    return true;
}

/* Where the rows of every front stand in its parent's panel: both lists are sorted. */
GPROJI_INTERNAL void gproji_find_relative(gproji_symbolic *out) {
    int32_t f;
    for (f = 0; f < out->fronts; ++f) {
        const gproji_front *front = &out->front[f], *parent;
        int64_t r = front->rows, end = r + front->row_nodes, q;
        if (front->parent < 0) continue;
        parent = &out->front[front->parent];
        for (; r < end && out->row_node[r] < parent->end_place; ++r)
            out->relative[r] = out->column[out->row_node[r]] - parent->first + gproji_panel_shift(parent->width);
        for (q = parent->rows; r < end; ++r) {
            while (out->row_node[q] != out->row_node[r]) ++q;
            out->relative[r] = out->row_at[q];
        }
    }
}

/* Strides, offsets and children of the fronts; sums. */
GPROJI_INTERNAL void gproji_place_panels(gproji_symbolic *out) {
    int32_t f;
    for (f = 0; f < out->fronts; ++f) out->front[f].child = out->front[f].sibling = -1;
    for (f = out->fronts - 1; f >= 0; --f) {
        gproji_front *front = &out->front[f];
        if (front->parent < 0) continue;
        front->depth = out->front[front->parent].depth + 1;
        front->sibling = out->front[front->parent].child;
        out->front[front->parent].child = f;
    }
    for (f = 0; f < out->fronts; ++f) {
        gproji_front *front = &out->front[f];
        int64_t w = front->width;
        front->stride = gproji_stride(gproji_panel_shift(front->width) + front->width + front->below);
        front->update_rows = gproji_round_up(front->below, GPROJI_BLOCK);
        front->panel = out->values_size;
        front->side = out->side_size;
        out->values_size += w * front->stride;
        out->side_size += front->below;
        out->factor_entries += w * (w + 1) / 2 + w * front->below;
        out->most_rows = gproji_max(out->most_rows, front->stride);
    }
}

/* The fronts in an order in which children come before parents and subtrees are consecutive. */
GPROJI_INTERNAL void gproji_front_sequence(gproji_analysis *an, int32_t *sequence) {
    gproji_symbolic *out = an->out;
    int32_t f, roots, *parent = an->b;
    for (f = 0; f < out->fronts; ++f) parent[f] = out->front[f].parent;
    roots = gproji_children(out->fronts, parent, an->child, an->sibling);
    gproji_postorder(roots, parent, an->child, an->sibling, sequence);
}

/* Groups the fronts: whole subtrees with at most a share of all flops go into tasks, small ones together; what lies
   above them is the last group. Small problems are one task. group: fronts entries. */
GPROJI_INTERNAL bool gproji_make_tasks(gproji_analysis *an, const int32_t *sequence, int32_t *group) {
    gproji_symbolic *out = an->out;
    double *flops, sum = 0, filled = 0, share;
    int32_t f, k, tasks = 0, *top = an->d;
    flops = (double *)gproji_pool_take(&an->pool, out->fronts, sizeof(double));
    if (!flops) return false;
    for (f = 0; f < out->fronts; ++f) {
        flops[f] = gproji_front_flops(out->front[f].width, out->front[f].below);
        sum += flops[f];
    }
    share = sum > 2e7 ? sum / (double)GPROJI_TASK_SHARE : sum * 2;
    for (f = 0; f < out->fronts; ++f)
        if (out->front[f].parent >= 0) flops[out->front[f].parent] += flops[f];
    for (f = 0; f < out->fronts; ++f) top[f] = flops[f] > share;
    for (k = 0; k < out->fronts; ++k) {
        int32_t parent;
        f = sequence[k];
        if (top[f]) continue;
        group[f] = tasks;
        parent = out->front[f].parent;
        if (parent >= 0 && !top[parent]) continue;
        filled += flops[f]; /* a whole subtree is complete */
        if (filled > share / 2) tasks++, filled = 0;
    }
    if (filled > 0) tasks++;
    for (f = 0; f < out->fronts; ++f)
        if (top[f]) group[f] = tasks;
    out->tasks = tasks;
    return true;
}

/* `schedule` and `task_start` from the groups. */
GPROJI_INTERNAL bool gproji_make_schedule(gproji_analysis *an, const int32_t *sequence, const int32_t *group) {
    gproji_symbolic *out = an->out;
    int32_t k, g;
    out->schedule = (int32_t *)gproji_pool_take(an->keep, out->fronts, sizeof(int32_t));
    out->task_start = (int32_t *)gproji_pool_take_zeroed(an->keep, out->tasks + 3, sizeof(int32_t));
    out->pieces_start = (int64_t *)gproji_pool_take_zeroed(an->keep, out->tasks + 2, sizeof(int64_t));
    if (!out->schedule || !out->task_start || !out->pieces_start) return false;
    for (k = 0; k < out->fronts; ++k) out->task_start[group[k] + 2]++;
    for (g = 0; g <= out->tasks; ++g) out->task_start[g + 2] += out->task_start[g + 1];
    for (k = 0; k < out->fronts; ++k) out->schedule[out->task_start[group[sequence[k]] + 1]++] = sequence[k];
    return true;
}

/* The update matrices of one group, from `base` on in the work memory. Fronts of even depth stack theirs from the lower
   end, those of odd depth from the upper end: a front's matrix is thus never on the same stack as its children's, which
   it needs until its own is finished, and they are on top of theirs. Matrices that another group consumes stay.
   Returns the end of the group's memory. */
GPROJI_INTERNAL int64_t gproji_stack_updates(gproji_symbolic *out, const int32_t *group, int32_t g, int64_t base) {
    int64_t top[2] = {0, 0}, most = 0;
    int32_t k, c, pass;
    for (pass = 0; pass < 2; ++pass) { /* the first pass finds the size */
        top[0] = top[1] = 0;
        for (k = out->task_start[g]; k < out->task_start[g + 1]; ++k) {
            gproji_front *front = &out->front[out->schedule[k]];
            int32_t side = front->depth & 1;
            int64_t size = gproji_update_entries(front->update_rows);
            front->update = side ? base + most - top[side] - size : base + top[side];
            top[side] += size;
            if (pass == 0 && top[0] + top[1] > most) most = top[0] + top[1];
            for (c = front->child; c >= 0; c = out->front[c].sibling)
                if (group[c] == g) top[!side] -= gproji_update_entries(out->front[c].update_rows);
        }
    }
    return base + most;
}

GPROJI_INTERNAL bool gproji_layout(gproji_analysis *an) {
    gproji_symbolic *out = an->out;
    int32_t *sequence = an->a, *group = an->c, g, k;
    gproji_place_panels(out);
    gproji_front_sequence(an, sequence);
    if (!gproji_make_tasks(an, sequence, group) || !gproji_make_schedule(an, sequence, group)) return false;
    for (g = 0; g <= out->tasks; ++g) {
        int32_t most = 0;
        out->work_size = gproji_stack_updates(out, group, g, out->work_size);
        for (k = out->task_start[g]; k < out->task_start[g + 1]; ++k) {
            int32_t c = out->front[out->schedule[k]].child;
            for (; c >= 0; c = out->front[c].sibling)
                most = gproji_max(most, 2 * out->front[c].row_nodes + out->front[c].below / 8 + 2);
        }
        out->pieces_start[g + 1] = out->pieces_start[g] + most;
    }
    return true;
}

/* Entries and flops of the factor without any zeros of relaxed supernodes. */
GPROJI_INTERNAL void gproji_sum_counts(gproji_analysis *an) {
    gproji_symbolic *out = an->out;
    int32_t k;
    out->exact_entries = 0;
    out->flops = 0;
    for (k = 0; k < out->nodes; ++k) {
        int64_t w = an->graph->weight[out->order[k]], below = an->count[k] - w;
        out->exact_entries += w * (w + 1) / 2 + w * below;
        out->flops += gproji_front_flops((double)w, (double)below);
    }
}

/* Elimination tree, column counts and their sums for the order in `out`, which becomes a postorder of the tree unless
   `keep_order`. */
GPROJI_INTERNAL void gproji_count_factor(gproji_analysis *an, bool keep_order) {
    gproji_symbolic *out = an->out;
    gproji_invert(out->nodes, out->order, out->place);
    gproji_elimination_tree(an->graph, out->order, out->place, an->parent, an->a);
    if (keep_order) {
        gproji_column_counts_by_rows(an);
    } else {
        gproji_apply_postorder(an);
        gproji_column_counts(an);
    }
    gproji_sum_counts(an);
}

enum {
    GPROJI_DISSECT_FLOPS = 25000,       /* per node; see gproji_best_order */
    GPROJI_DISSECT_MOST = INT32_MAX / 4 /* nodes; coordinates are sums of distances */
};

/* Condensed nodes, then the others by dissection. */
GPROJI_INTERNAL bool gproji_dissected_order(gproji_analysis *an) {
    gproji_heap *heap = an->keep->heap;
    gproji_condensation condensed;
    int32_t *order = an->out->order, *rest, k, total = an->out->columns;
    bool done = gproji_condense(&condensed, heap, an->graph);
    for (k = 0; done && k < condensed.count; ++k) {
        order[k] = condensed.first[k];
        total -= an->graph->weight[order[k]];
    }
    rest = order + condensed.count;
    done = done && gproji_dissect(heap, &condensed.rest, total, rest);
    for (k = 0; done && k < condensed.rest.nodes; ++k) rest[k] = condensed.first[condensed.count + rest[k]];
    gproji_pool_give_all(&condensed.pool);
    return done;
}

/* The better one of minimum degree and dissection, counted. Dissection takes five times as long, half a microsecond for
   each node, and spares a fifth of the flops: it is tried where that pays within about four factorisations. */
GPROJI_INTERNAL bool gproji_best_order(gproji_analysis *an, bool keep_order) {
    gproji_symbolic *out = an->out;
    int32_t *order = (int32_t *)gproji_pool_take(&an->pool, out->nodes, sizeof(int32_t));
    double flops;
    if (!order || !gproji_amd_order(an->keep->heap, an->graph, out->columns, order, &flops)) return false;
    if (flops > (double)GPROJI_DISSECT_FLOPS * out->nodes && out->nodes <= GPROJI_DISSECT_MOST) {
        if (!gproji_dissected_order(an)) return false;
        gproji_count_factor(an, keep_order);
        if (out->flops < flops) return true;
    }
    if (out->nodes > 0) memcpy(out->order, order, (size_t)out->nodes * sizeof(int32_t));
    gproji_count_factor(an, keep_order);
    return true;
}

/* The order of elimination asked for, its tree and its counts. permutation: of nodes. */
GPROJI_INTERNAL bool gproji_choose_order(gproji_analysis *an, const gproj_cholesky_options *options,
                                         const int32_t *permutation) {
    gproji_symbolic *out = an->out;
    gproj_ordering ordering = options->ordering;
    int32_t k;
    if (ordering == GPROJ_ORDERING_BEST) return gproji_best_order(an, options->disable_postorder);
    if (ordering == GPROJ_ORDERING_DISSECTION && out->nodes > GPROJI_DISSECT_MOST) ordering = GPROJ_ORDERING_AMD;
    if (ordering == GPROJ_ORDERING_DISSECTION) {
        if (!gproji_dissected_order(an)) return false;
    } else if (ordering == GPROJ_ORDERING_AMD) {
        if (!gproji_amd_order(an->keep->heap, an->graph, out->columns, out->order, NULL)) return false;
    } else {
        for (k = 0; k < out->nodes; ++k) out->order[k] = ordering == GPROJ_ORDERING_GIVEN ? permutation[k] : k;
    }
    gproji_count_factor(an, options->disable_postorder);
    return true;
}

GPROJI_INTERNAL bool gproji_analyse_steps(gproji_analysis *an, const gproj_cholesky_options *options,
                                          const int32_t *permutation) {
    gproji_symbolic *out = an->out;
    out->order = (int32_t *)gproji_pool_take(an->keep, out->nodes, sizeof(int32_t));
    out->place = (int32_t *)gproji_pool_take(an->keep, out->nodes, sizeof(int32_t));
    out->column = (int32_t *)gproji_pool_take(an->keep, (int64_t)out->nodes + 1, sizeof(int32_t));
    out->front_of = (int32_t *)gproji_pool_take(an->keep, out->nodes, sizeof(int32_t));
    if (!out->order || !out->place || !out->column || !out->front_of) return false;
    if (!gproji_analysis_take(an) || !gproji_choose_order(an, options, permutation)) return false;
    gproji_find_supernodes(an);
    if (!options->disable_relaxation && !options->disable_postorder) gproji_relax_supernodes(an);
    if (!gproji_make_fronts(an, options->disable_postorder) || !gproji_find_rows(an)) return false;
    gproji_find_relative(out);
    return gproji_layout(an);
}

/* Analyses a graph whose nodes weigh `columns` altogether. permutation: of the nodes, for GPROJ_ORDERING_GIVEN. All
   that `out` holds is taken from the pool. False when there is no memory. */
GPROJI_INTERNAL bool gproji_analyse(gproji_pool *keep, const gproji_graph *graph, int32_t columns,
                                    const gproj_cholesky_options *options, const int32_t *permutation,
                                    gproji_symbolic *out) {
    gproji_analysis an;
    bool done;
    memset(&an, 0, sizeof an);
    memset(out, 0, sizeof *out);
    an.graph = graph;
    an.out = out;
    an.keep = keep;
    gproji_pool_start(&an.pool, keep->heap);
    out->columns = columns;
    out->nodes = graph->nodes;
    done = gproji_analyse_steps(&an, options, permutation);
    gproji_pool_give_all(&an.pool);
    return done;
}

/* ============================================================================================================
   >>cholesky   The sparse Cholesky factorisation P A P' = L L'. Uses platform, memory, error, parallel, kernels,
   dense, ordering, symbolic.

   Multifrontal (Duff, Reid 1983; Liu 1992). A front's pivot columns stand in the factor itself, its update matrix on a
   stack. Both are cleared, A's values and the children's update matrices are added, the pivots are eliminated and their
   effect on the rows below is taken off. All that happens while the front is in the cache; right-hand sides that are
   known then take part.

   Threads: whole subtrees are tasks; the few large fronts above them come one after the other, and the work inside each
   of them is cut into strips. Both depend on the matrix alone. A solution goes up and down the same tasks: a front adds
   to its parent's part of a right-hand side, not to a common vector.

   A matrix in compressed columns is first compressed: columns with the same entries become one node. The system section
   gives its nodes itself and adds its values to each front when it is asked (gproji_load).

   Invariants: all memory of the numerical part is taken at once, before the first factorisation; a front's update
   matrix has its place in it from the analysis on, so tasks share nothing but read-only data. */
enum {
    GPROJI_SOLVE_BATCH = 4,   /* right-hand sides solved together at most */
    GPROJI_CACHED = 1 << 16,  /* a factor with no more values than that stays in the L2 cache */
    GPROJI_PREFETCHED = 2048, /* values of a panel that are fetched ahead; the processor finds the rest by itself */
    GPROJI_CACHE_LINE = 8     /* values */
};

/* Adds the matrix's values that belong to a front to its cleared panel and update matrix (see gproji_panel_column). Each
   value once, in a front that has both of its variables. Called from several threads. */
typedef void (*gproji_load)(void *user, int32_t front, const gproji_panel *panel);

struct gproj_cholesky {
    gproji_heap own;
    gproj_parallel parallel;
    gproj_error error;
    bool analysed;
    bool factored;
    int32_t failed_column;
    gproji_pool kept;    /* what the analysis has made */
    gproji_pool numeric; /* what factorisation and solution need */
    const gproji_kernels *kernels;
    gproji_symbolic symbolic;
    int32_t *permutation; /* columns: the column of A at each column of L */
    /* A matrix in compressed columns; NULL for an analysis by blocks. Its entries in the order of the fronts: */
    int64_t entries;
    int64_t *entry;       /* entries: the number of each in the caller's arrays */
    int64_t *target;      /* entries: where its value goes in L */
    int64_t *entry_start; /* fronts + 1: where each front's entries begin */
    const double *source; /* during gproj_cholesky_factor: the values of A */

    gproji_load load; /* during a factorisation */
    void *load_user;
    int32_t batch; /* right-hand sides that there is room for, at most GPROJI_SOLVE_BATCH */
    int32_t sides; /* those at work */

    double *values;       /* symbolic.values_size: all panels */
    double *work;         /* symbolic.work_size: all update matrices */
    double *inverse;      /* columns: the inverses of the diagonal of L */
    gproji_piece *pieces; /* of a child, for each group of fronts */
    int32_t *failed;      /* tasks + 1: the column of L where the group failed, or -1 */
    double *solution;     /* columns * batch: right-hand sides in the order of L */
    double *side;         /* symbolic.side_size * batch: what fronts take off the rows below their pivots */
    double *rows;         /* (tasks + 1) * symbolic.most_rows: one front's part of a right-hand side, for each group */
};

/* -- life -- */

GPROJI_INTERNAL void gproji_cholesky_forget(gproj_cholesky *c) {
    gproji_pool_give_all(&c->numeric);
    gproji_pool_give_all(&c->kept);
    memset(&c->symbolic, 0, sizeof c->symbolic);
    c->analysed = c->factored = false;
    c->failed_column = -1;
    c->permutation = NULL;
    c->entry = c->target = c->entry_start = NULL;
    c->source = NULL;
    c->entries = 0;
    c->values = NULL;
    c->batch = GPROJI_SOLVE_BATCH;
}

GPROJ_API gproj_cholesky *gproj_cholesky_create(const gproj_host *host) {
    gproj_cholesky *c = (gproj_cholesky *)gproji_create_object(host, sizeof *c);
    if (!c) return NULL;
    if (host) c->parallel = host->parallel;
    c->kernels = gproji_kernels_of(0);
    gproji_error_clear(&c->error);
    gproji_pool_start(&c->kept, &c->own);
    gproji_pool_start(&c->numeric, &c->own);
    c->failed_column = -1;
    return c;
}

GPROJ_API void gproj_cholesky_destroy(gproj_cholesky *cholesky) {
    if (!cholesky) return;
    gproji_cholesky_forget(cholesky);
    gproji_destroy_object(cholesky, sizeof *cholesky);
}

GPROJ_API const gproj_error *gproj_cholesky_error(const gproj_cholesky *cholesky) {
    static const gproj_error none = {GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "there is no Cholesky object"};
    return cholesky ? &cholesky->error : &none;
}

GPROJ_API gproj_memory gproj_cholesky_memory(const gproj_cholesky *cholesky) {
    gproj_memory memory;
    memset(&memory, 0, sizeof memory);
    return cholesky ? cholesky->own.account : memory;
}

GPROJ_API const int32_t *gproj_cholesky_permutation(const gproj_cholesky *cholesky) {
    return cholesky ? cholesky->permutation : NULL;
}

/* A number of bytes, also where the address space cannot hold it. */
GPROJI_INTERNAL size_t gproji_size_of(double bytes) {
    return bytes < (double)(SIZE_MAX / 2) ? (size_t)bytes : SIZE_MAX / 2;
}

GPROJ_API gproj_cholesky_info gproj_cholesky_get_info(const gproj_cholesky *cholesky) {
    gproj_cholesky_info info;
    const gproji_symbolic *sy;
    double work;
    memset(&info, 0, sizeof info);
    info.failed_column = -1;
    info.kernels = cholesky ? cholesky->kernels->name : "";
    if (!cholesky || !cholesky->analysed) return info;
    sy = &cholesky->symbolic;
    info.columns = sy->columns;
    info.supernodes = sy->fronts;
    info.factor_entries = sy->factor_entries;
    info.exact_entries = sy->exact_entries;
    info.flops = sy->flops;
    info.factor_bytes = gproji_size_of(8.0 * (double)sy->values_size);
    work = (double)sy->work_size + (double)cholesky->batch * ((double)sy->side_size + sy->columns) + sy->columns +
           (sy->tasks + 1.0) * sy->most_rows + 2.0 * (double)sy->pieces_start[sy->tasks + 1]; /* a piece: 2 numbers */
    info.work_bytes = gproji_size_of(8.0 * work);
    info.failed_column = cholesky->failed_column;
    return info;
}

/* -- analysis -- */

/* The order of L's columns: the members of the nodes, node by node. member[member_start[i]..] are the columns of A in
   node i. */
GPROJI_INTERNAL bool gproji_cholesky_permute(gproj_cholesky *c, const int32_t *member_start, const int32_t *member) {
    const gproji_symbolic *sy = &c->symbolic;
    int32_t k, i, at = 0;
    c->permutation = (int32_t *)gproji_pool_take(&c->kept, sy->columns, sizeof(int32_t));
    if (!c->permutation) return false;
    for (k = 0; k < sy->nodes; ++k)
        for (i = member_start[sy->order[k]]; i < member_start[sy->order[k] + 1]; ++i)
            c->permutation[at++] = member ? member[i] : i;
    return true;
}

/* The storage rows of a front in its panel: at[variable] for the variables that have one. */
GPROJI_INTERNAL void gproji_map_variables(const gproj_cholesky *c, int32_t f, int32_t *at) {
    const gproji_symbolic *sy = &c->symbolic;
    const gproji_front *front = &sy->front[f];
    int32_t shift = gproji_panel_shift(front->width) - front->first, k;
    int64_t r;
    for (k = front->first; k < front->first + front->width; ++k) at[c->permutation[k]] = k + shift;
    for (r = front->rows; r < front->rows + front->row_nodes; ++r) {
        const int32_t *column = sy->column + sy->row_node[r];
        for (k = column[0]; k < column[1]; ++k) at[c->permutation[k]] = sy->row_at[r] + k - column[0];
    }
}

/* An analysis by blocks, for the system: `node_count` nodes, node i being node_size[i] >= 1 consecutive variables, and
   their graph (see gproji_graph). The options' permutation is one of the nodes. */
GPROJI_INTERNAL gproj_code gproji_cholesky_analyse_blocks(gproj_cholesky *c, int32_t node_count,
                                                          const int32_t *node_size, const int64_t *adjacency_start,
                                                          const int32_t *adjacency,
                                                          const gproj_cholesky_options *options) {
    gproj_cholesky_options choice;
    gproji_graph graph;
    int32_t i, *start, columns = 0;
    bool done = false;
    memset(&choice, 0, sizeof choice);
    if (options) choice = *options;
    gproji_cholesky_forget(c);
    gproji_error_clear(&c->error);
    for (i = 0; i < node_count; ++i) {
        if (node_size[i] > INT32_MAX - 64 - columns)
            return gproji_fail(&c->error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "more than 2^31 variables");
        columns += node_size[i];
    }
    graph.nodes = node_count, graph.start = adjacency_start, graph.adjacent = adjacency, graph.weight = node_size;
    start = (int32_t *)gproji_take(&c->own, (size_t)node_count + 1, sizeof(int32_t));
    if (start) {
        start[0] = 0;
        for (i = 0; i < node_count; ++i) start[i + 1] = start[i] + node_size[i];
        done = gproji_analyse(&c->kept, &graph, columns, &choice, choice.permutation, &c->symbolic) &&
               gproji_cholesky_permute(c, start, NULL);
    }
    gproji_give(&c->own, start, (size_t)node_count + 1, sizeof(int32_t));
    if (!done) {
        gproji_cholesky_forget(c);
        return gproji_fail_memory(&c->error);
    }
    c->analysed = true;
    return GPROJ_OK;
}

/* Are the arrays a matrix in compressed columns? */
GPROJI_INTERNAL gproj_code gproji_cholesky_check(gproj_cholesky *c, int32_t n, const int64_t *start,
                                                 const int32_t *row) {
    int32_t j;
    int64_t p;
    if (n < 0 || n > INT32_MAX - 64)
        return gproji_fail(&c->error, n < 0 ? GPROJ_ERROR_ARGUMENT : GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1,
                           "a matrix cannot have %d columns", n);
    if (n == 0) return GPROJ_OK;
    if (!start)
        return gproji_fail(&c->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the column starts are missing");
    if (start[0] != 0)
        return gproji_fail(&c->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_COLUMN, 0,
                           "the first column starts at %l, not 0", start[0]);
    for (j = 0; j < n; ++j)
        if (start[j + 1] < start[j])
            return gproji_fail(&c->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_COLUMN, j,
                               "column %d ends before it starts", j);
    if (start[n] > INT64_MAX / 64)
        return gproji_fail(&c->error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "%l entries are too many", start[n]);
    if (!row && start[n] > 0)
        return gproji_fail(&c->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the row indices are missing");
    for (j = 0; j < n; ++j)
        for (p = start[j]; p < start[j + 1]; ++p)
            if (row[p] < 0 || row[p] >= n)
                return gproji_fail(&c->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, j,
                                   "column %d has an entry in row %d, which is not in 0..%d", j, row[p], n - 1);
    return GPROJ_OK;
}

/* A matrix in compressed columns on its way to a graph of nodes. */
typedef struct gproji_compression {
    gproji_pool pool;
    int32_t n;
    int64_t *start;     /* n + 1: neighbours of the columns, */
    int32_t *neighbour; /* without the diagonal and without repetition */
    uint32_t *hash;     /* n: sum over the column and its neighbours */
    int32_t *mark;      /* n */
    int32_t *node_of;   /* n: the node of each column, or -1 */
    int32_t nodes;
    int32_t *member_start; /* nodes + 1 */
    int32_t *member;       /* n: the columns of each node */
    int32_t *weight;       /* nodes */
    int64_t *node_start;   /* nodes + 1: the graph of the nodes */
    int32_t *adjacent;
    int32_t *order;      /* n: the order given, or NULL */
    int32_t *node_order; /* nodes: the same for the nodes */
} gproji_compression;

/* Both triangles of the pattern without repeated entries. */
GPROJI_INTERNAL bool gproji_compression_graph(gproji_compression *x, const int64_t *start, const int32_t *row) {
    int32_t n = x->n, j;
    int64_t p, q, to = 0;
    x->start = (int64_t *)gproji_pool_take_zeroed(&x->pool, (int64_t)n + 2, sizeof(int64_t));
    x->neighbour = (int32_t *)gproji_pool_take(&x->pool, 2 * (n ? start[n] : 0), sizeof(int32_t));
    x->hash = (uint32_t *)gproji_pool_take(&x->pool, n, sizeof(uint32_t));
    x->mark = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    if (!x->start || !x->neighbour || !x->hash || !x->mark) return false;
    for (j = 0; j < n; ++j)
        for (p = start[j]; p < start[j + 1]; ++p)
            if (row[p] != j) x->start[j + 2]++, x->start[row[p] + 2]++;
    for (j = 0; j < n; ++j) x->start[j + 2] += x->start[j + 1];
    for (j = 0; j < n; ++j) {
        for (p = start[j]; p < start[j + 1]; ++p) {
            if (row[p] == j) continue;
            x->neighbour[x->start[j + 1]++] = row[p];
            x->neighbour[x->start[row[p] + 1]++] = j;
        }
        x->mark[j] = -1;
    }
    for (j = 0, p = 0; j < n; ++j) { /* repeated entries leave */
        int64_t end = x->start[j + 1];
        x->start[j] = to;
        x->hash[j] = (uint32_t)j * 2654435761u;
        for (q = p; q < end; ++q) {
            int32_t i = x->neighbour[q];
            if (x->mark[i] == j) continue;
            x->mark[i] = j;
            x->hash[j] += (uint32_t)i * 2654435761u;
            x->neighbour[to++] = i;
        }
        p = end;
    }
    x->start[n] = to;
    return true;
}

/* Has column i, a neighbour of the marked column j, the same neighbours? */
GPROJI_INTERNAL bool gproji_compression_same(const gproji_compression *x, int32_t j, int32_t i) {
    int64_t p;
    if (x->hash[i] != x->hash[j] || x->start[i + 1] - x->start[i] != x->start[j + 1] - x->start[j]) return false;
    for (p = x->start[i]; p < x->start[i + 1]; ++p)
        if (x->mark[x->neighbour[p]] != j) return false;
    return x->mark[i] == j;
}

GPROJI_INTERNAL void gproji_compression_mark(gproji_compression *x, int32_t j) {
    int64_t p;
    x->mark[j] = j;
    for (p = x->start[j]; p < x->start[j + 1]; ++p) x->mark[x->neighbour[p]] = j;
}

/* Finds the nodes: in a given order, runs of columns with the same neighbours; else all such columns. */
GPROJI_INTERNAL void gproji_compression_nodes(gproji_compression *x) {
    int32_t j, k, first = -1, at = 0;
    int64_t p;
    for (j = 0; j < x->n; ++j) x->mark[j] = x->node_of[j] = -1;
    for (k = 0; k < x->n; ++k) {
        j = x->order ? x->order[k] : k;
        if (x->node_of[j] >= 0) continue;
        if (x->order && first >= 0 && gproji_compression_same(x, first, j)) {
            x->node_of[j] = x->nodes - 1;
            x->member[at++] = j;
            continue;
        }
        first = j;
        x->member_start[x->nodes] = at;
        x->node_of[j] = x->nodes++;
        x->member[at++] = j;
        gproji_compression_mark(x, j);
        if (x->order) continue;
        for (p = x->start[j]; p < x->start[j + 1]; ++p) {
            int32_t i = x->neighbour[p];
            if (x->node_of[i] >= 0 || !gproji_compression_same(x, j, i)) continue;
            x->node_of[i] = x->nodes - 1;
            x->member[at++] = i;
        }
    }
    x->member_start[x->nodes] = at;
}

/* The graph of the nodes, from the neighbours of their first members. */
GPROJI_INTERNAL bool gproji_compression_compress(gproji_compression *x) {
    int32_t n = x->n, k, i;
    int64_t p, to = 0;
    x->node_of = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    x->member = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    x->member_start = (int32_t *)gproji_pool_take(&x->pool, (int64_t)n + 1, sizeof(int32_t));
    x->weight = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    x->node_order = (int32_t *)gproji_pool_take(&x->pool, n, sizeof(int32_t));
    x->node_start = (int64_t *)gproji_pool_take(&x->pool, (int64_t)n + 1, sizeof(int64_t));
    if (!x->node_of || !x->member || !x->member_start || !x->weight || !x->node_order || !x->node_start) return false;
    gproji_compression_nodes(x);
    x->adjacent = (int32_t *)gproji_pool_take(&x->pool, x->start[n], sizeof(int32_t));
    if (!x->adjacent) return false;
    for (k = 0; k < x->n; ++k) x->mark[k] = -1;
    for (k = 0; k < x->nodes; ++k) {
        int32_t column = x->member[x->member_start[k]];
        x->weight[k] = x->member_start[k + 1] - x->member_start[k];
        x->node_order[k] = k; /* nodes are numbered in the order given */
        x->node_start[k] = to;
        for (p = x->start[column]; p < x->start[column + 1]; ++p) {
            i = x->node_of[x->neighbour[p]];
            if (i == k || x->mark[i] == k) continue;
            x->mark[i] = k;
            x->adjacent[to++] = i;
        }
    }
    x->node_start[x->nodes] = to;
    return true;
}

/* mark: n entries of work. */
GPROJI_INTERNAL bool gproji_is_permutation(int32_t n, const int32_t *permutation, int32_t *mark) {
    int32_t k;
    for (k = 0; k < n; ++k) mark[k] = 0;
    for (k = 0; k < n; ++k) {
        if (permutation[k] < 0 || permutation[k] >= n || mark[permutation[k]]) return false;
        mark[permutation[k]] = 1;
    }
    return true;
}

/* The front that holds entry (i, j), by columns of A: that of the one eliminated first. */
GPROJI_INTERNAL int32_t gproji_front_of_entry(const gproj_cholesky *c, const gproji_compression *x, int32_t i,
                                              int32_t j) {
    const int32_t *place = c->symbolic.place;
    return c->symbolic.front_of[gproji_min(place[x->node_of[i]], place[x->node_of[j]])];
}

/* Sorts the entries by the front that holds them: `entry` and `entry_start`; `target` gets the two columns of L, the
   smaller one + 2^32 times the larger one. */
GPROJI_INTERNAL bool gproji_cholesky_sort_entries(gproj_cholesky *c, gproji_compression *x, const int64_t *start,
                                                  const int32_t *row) {
    int32_t fronts = c->symbolic.fronts, f, j, *place = x->mark; /* columns of A: their column of L */
    int64_t p;
    c->entry = (int64_t *)gproji_pool_take(&c->kept, c->entries, sizeof(int64_t));
    c->target = (int64_t *)gproji_pool_take(&c->kept, c->entries, sizeof(int64_t));
    c->entry_start = (int64_t *)gproji_pool_take_zeroed(&c->kept, (int64_t)fronts + 2, sizeof(int64_t));
    if (!c->entry || !c->target || !c->entry_start) return false;
    gproji_invert(x->n, c->permutation, place);
    for (j = 0; j < x->n; ++j)
        for (p = start[j]; p < start[j + 1]; ++p) c->entry_start[gproji_front_of_entry(c, x, row[p], j) + 2]++;
    for (f = 0; f < fronts; ++f) c->entry_start[f + 2] += c->entry_start[f + 1];
    for (j = 0; j < x->n; ++j)
        for (p = start[j]; p < start[j + 1]; ++p) {
            int32_t a = place[j], b = place[row[p]];
            int64_t at = c->entry_start[gproji_front_of_entry(c, x, row[p], j) + 1]++;
            c->entry[at] = p;
            c->target[at] = gproji_min(a, b) | (int64_t)gproji_max(a, b) << 32;
        }
    return true;
}

/* Turns the columns in `target` into places in the values of L. */
GPROJI_INTERNAL void gproji_cholesky_find_targets(gproj_cholesky *c, gproji_compression *x) {
    const gproji_symbolic *sy = &c->symbolic;
    int32_t *position = x->node_order; /* nodes, by place: first storage row in the front at hand */
    int32_t f;
    int64_t r;
    for (f = 0; f < sy->fronts; ++f) {
        const gproji_front *front = &sy->front[f];
        for (r = front->rows; r < front->rows + front->row_nodes; ++r) position[sy->row_node[r]] = sy->row_at[r];
        for (r = c->entry_start[f]; r < c->entry_start[f + 1]; ++r) {
            int32_t early = (int32_t)(c->target[r] & INT32_MAX), late = (int32_t)(c->target[r] >> 32), at, place;
            if (late < front->first + front->width) {
                at = late - front->first + gproji_panel_shift(front->width);
            } else {
                place = sy->place[x->node_of[c->permutation[late]]];
                at = position[place] + late - sy->column[place];
            }
            c->target[r] = front->panel + (int64_t)(early - front->first) * front->stride + at;
        }
    }
}

/* The steps of an analysis between taking and giving back its memory. */
GPROJI_INTERNAL gproj_code gproji_cholesky_analyse_steps(gproj_cholesky *c, gproji_compression *x, const int64_t *start,
                                                         const int32_t *row, const gproj_cholesky_options *choice) {
    gproji_graph graph;
    int32_t k;
    if (!gproji_compression_graph(x, start, row)) return gproji_fail_memory(&c->error);
    if (choice->ordering == GPROJ_ORDERING_GIVEN || choice->ordering == GPROJ_ORDERING_NATURAL) {
        x->order = (int32_t *)gproji_pool_take(&x->pool, x->n, sizeof(int32_t));
        if (!x->order) return gproji_fail_memory(&c->error);
        for (k = 0; k < x->n; ++k) x->order[k] = k;
    }
    if (choice->ordering == GPROJ_ORDERING_GIVEN && x->n > 0) {
        if (!choice->permutation || !gproji_is_permutation(x->n, choice->permutation, x->mark))
            return gproji_fail(&c->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                               "the order given is no permutation");
        memcpy(x->order, choice->permutation, (size_t)x->n * sizeof(int32_t));
    }
    if (!gproji_compression_compress(x)) return gproji_fail_memory(&c->error);
    graph.nodes = x->nodes, graph.start = x->node_start, graph.adjacent = x->adjacent, graph.weight = x->weight;
    if (!gproji_analyse(&c->kept, &graph, x->n, choice, x->node_order, &c->symbolic) ||
        !gproji_cholesky_permute(c, x->member_start, x->member) || !gproji_cholesky_sort_entries(c, x, start, row))
        return gproji_fail_memory(&c->error);
    gproji_cholesky_find_targets(c, x);
    return GPROJ_OK;
}

GPROJ_API gproj_code gproj_cholesky_analyse(gproj_cholesky *cholesky, int32_t n, const int64_t *start,
                                            const int32_t *row, const gproj_cholesky_options *options) {
    gproj_cholesky_options choice;
    gproji_compression compression;
    gproj_code code;
    if (!cholesky) return GPROJ_ERROR_ARGUMENT;
    gproji_cholesky_forget(cholesky);
    gproji_error_clear(&cholesky->error);
    code = gproji_cholesky_check(cholesky, n, start, row);
    if (code != GPROJ_OK) return code;
    memset(&choice, 0, sizeof choice);
    if (options) choice = *options;
    memset(&compression, 0, sizeof compression);
    compression.n = n;
    gproji_pool_start(&compression.pool, &cholesky->own);
    cholesky->entries = n ? start[n] : 0;
    code = gproji_cholesky_analyse_steps(cholesky, &compression, start, row, &choice);
    gproji_pool_give_all(&compression.pool);
    if (code != GPROJ_OK)
        gproji_cholesky_forget(cholesky);
    else
        cholesky->analysed = true;
    return code;
}

/* -- factorisation -- */

/* `count` doubles that begin at a cache line. */
GPROJI_INTERNAL double *gproji_take_aligned(gproji_pool *pool, int64_t count) {
    char *block = (char *)gproji_pool_take(pool, count + 8, sizeof(double));
    return block ? (double *)(void *)(block + (64 - (uintptr_t)block % 64) % 64) : NULL;
}

/* Takes the memory of the numerical part, once for an analysis. */
GPROJI_INTERNAL bool gproji_cholesky_take_numeric(gproj_cholesky *c) {
    const gproji_symbolic *sy = &c->symbolic;
    int64_t groups = (int64_t)sy->tasks + 1;
    if (c->values) return true;
    c->work = gproji_take_aligned(&c->numeric, sy->work_size);
    c->inverse = gproji_take_aligned(&c->numeric, sy->columns);
    c->rows = gproji_take_aligned(&c->numeric, groups * sy->most_rows);
    c->solution = gproji_take_aligned(&c->numeric, (int64_t)sy->columns * c->batch);
    c->side = gproji_take_aligned(&c->numeric, sy->side_size * c->batch);
    c->pieces = (gproji_piece *)gproji_pool_take(&c->numeric, sy->pieces_start[groups], sizeof(gproji_piece));
    c->failed = (int32_t *)gproji_pool_take(&c->numeric, groups, sizeof(int32_t));
    c->values = gproji_take_aligned(&c->numeric, sy->values_size);
    if (c->work && c->inverse && c->rows && c->solution && c->side && c->pieces && c->failed && c->values) return true;
    gproji_pool_give_all(&c->numeric);
    c->values = NULL;
    gproji_fail_memory(&c->error);
    return false;
}

/* Adds the children's update matrices to the front's pivot columns and to its own update matrix. */
GPROJI_INTERNAL void gproji_add_children(const gproj_cholesky *c, const gproji_front *front, const gproji_panel *panel,
                                         const gproj_parallel *parallel, gproji_piece *pieces) {
    const gproji_symbolic *sy = &c->symbolic;
    int32_t i;
    for (i = front->child; i >= 0; i = sy->front[i].sibling) {
        const gproji_front *child = &sy->front[i];
        gproji_addition add;
        double rows = child->below;
        add.panel = panel, add.piece = pieces, add.update = c->work + child->update, add.rows = child->update_rows;
        add.pieces = gproji_find_pieces(
            c->kernels, child->row_nodes, sy->row_at + child->rows, child->width + gproji_panel_shift(child->width),
            child->below, sy->relative + child->rows, front->width + gproji_panel_shift(front->width), pieces);
        gproji_run_tasks(parallel, 20 * rows * rows, gproji_pieces(child->below, GPROJI_STRIP), gproji_add_task, &add);
    }
}

/* Adds A's values to a front, where A is in compressed columns. */
GPROJI_INTERNAL void gproji_load_columns(void *user, int32_t f, const gproji_panel *panel) {
    const gproj_cholesky *c = (const gproj_cholesky *)user;
    int64_t r;
    (void)panel;
    for (r = c->entry_start[f]; r < c->entry_start[f + 1]; ++r) c->values[c->target[r]] += c->source[c->entry[r]];
}

GPROJI_INTERNAL gproji_panel gproji_front_panel(const gproj_cholesky *c, const gproji_front *front) {
    return gproji_make_panel(c->kernels, front->width, front->below, front->stride, c->values + front->panel,
                             c->inverse + front->first, c->work + front->update);
}

/* Begins to bring the panel of the front that comes next into the cache: of many small ones, each would wait for its
   first entries. */
GPROJI_INLINED void gproji_prefetch_front(const gproj_cholesky *c, int32_t f) {
    const gproji_front *front = &c->symbolic.front[f];
    int64_t size = (int64_t)front->width * front->stride, i;
    if (c->symbolic.values_size <= GPROJI_CACHED) return;
    if (size > GPROJI_PREFETCHED) size = GPROJI_PREFETCHED;
    for (i = 0; i < size; i += GPROJI_CACHE_LINE) GPROJI_PREFETCH(c->values + front->panel + i);
}

/* Eliminates one front. Returns -1 or the failing column of L. parallel: NULL within a task. */
GPROJI_INTERNAL int32_t gproji_factor_front(gproj_cholesky *c, int32_t f, const gproj_parallel *parallel,
                                            gproji_piece *pieces) {
    const gproji_front *front = &c->symbolic.front[f];
    gproji_panel panel = gproji_front_panel(c, front);
    int32_t failed;
    memset(c->values + front->panel, 0, (size_t)front->width * (size_t)front->stride * sizeof(double));
    memset(panel.update, 0, (size_t)gproji_update_entries(front->update_rows) * sizeof(double));
    c->load(c->load_user, f, &panel);
    gproji_add_children(c, front, &panel, parallel, pieces);
    failed = gproji_panel_factor(parallel, &panel);
    if (failed >= 0) return front->first + failed;
    if (front->below > 0) gproji_panel_update(parallel, &panel);
    return -1;
}

/* -- right-hand sides -- */

GPROJI_INLINE double *gproji_front_side(const gproj_cholesky *c, const gproji_front *front, int32_t side) {
    return c->side + front->side * c->batch + (int64_t)side * front->below;
}

/* What the children take off the front's rows, added to its storage rows z. */
GPROJI_INTERNAL void gproji_add_sides(const gproj_cholesky *c, const gproji_front *front, int32_t side, double *z) {
    const gproji_symbolic *sy = &c->symbolic;
    int32_t f, i;
    for (f = front->child; f >= 0; f = sy->front[f].sibling) {
        const gproji_front *child = &sy->front[f];
        const double *from = gproji_front_side(c, child, side), *end = from + child->below;
        const int32_t *relative = sy->relative + child->rows, *at = sy->row_at + child->rows;
        for (; from < end; from += i, ++relative, ++at) {
            int32_t count =
                at + 1 < sy->row_at + child->rows + child->row_nodes ? at[1] - at[0] : (int32_t)(end - from);
            for (i = 0; i < count; ++i) z[*relative + i] += from[i];
        }
    }
}

/* Sets the storage rows of z to 0, and its pivot rows to the front's part of x. */
GPROJI_INTERNAL void gproji_start_rows(const gproji_front *front, const double *x, double *z) {
    int32_t shift = gproji_panel_shift(front->width);
    memset(z, 0, (size_t)(shift + front->width + front->update_rows) * sizeof(double));
    memcpy(z + shift, x + front->first, (size_t)front->width * sizeof(double));
}

/* One front of L y = b; z: work. */
GPROJI_INTERNAL void gproji_forward_front(const gproj_cholesky *c, const gproji_front *front, int32_t side, double *z) {
    double *x = c->solution + (size_t)side * (size_t)c->symbolic.columns, *pivots;
    gproji_panel panel = gproji_front_panel(c, front);
    pivots = z + gproji_panel_shift(front->width);
    gproji_start_rows(front, x, z);
    gproji_add_sides(c, front, side, z);
    gproji_panel_forward(&panel, z);
    memcpy(x + front->first, pivots, (size_t)front->width * sizeof(double));
    memcpy(gproji_front_side(c, front, side), pivots + front->width, (size_t)front->below * sizeof(double));
}

/* One front of L' x = y. */
GPROJI_INTERNAL void gproji_backward_front(const gproj_cholesky *c, const gproji_front *front, int32_t side,
                                           double *z) {
    const gproji_symbolic *sy = &c->symbolic;
    double *x = c->solution + (size_t)side * (size_t)sy->columns, *pivots, *to;
    const int32_t *node = sy->row_node + front->rows;
    int32_t i, k;
    gproji_panel panel = gproji_front_panel(c, front);
    pivots = z + gproji_panel_shift(front->width);
    gproji_start_rows(front, x, z);
    for (k = 0, to = pivots + front->width; k < front->row_nodes; ++k)
        for (i = sy->column[node[k]]; i < sy->column[node[k] + 1]; ++i) *to++ = x[i];
    gproji_panel_backward(&panel, z);
    memcpy(x + front->first, pivots, (size_t)front->width * sizeof(double));
}

/* The fronts of one group, up or down. A panel is read once, and is still in the cache for the second and later
   right-hand sides. Tasks. */
GPROJI_INTERNAL void gproji_forward_group(void *data, int32_t group) {
    const gproj_cholesky *c = (const gproj_cholesky *)data;
    const gproji_symbolic *sy = &c->symbolic;
    double *z = c->rows + (size_t)group * (size_t)sy->most_rows;
    int32_t k, side;
    for (k = sy->task_start[group]; k < sy->task_start[group + 1]; ++k) {
        if (k + 1 < sy->task_start[group + 1]) gproji_prefetch_front(c, sy->schedule[k + 1]);
        for (side = 0; side < c->sides; ++side) gproji_forward_front(c, &sy->front[sy->schedule[k]], side, z);
    }
}

GPROJI_INTERNAL void gproji_backward_group(void *data, int32_t group) {
    const gproj_cholesky *c = (const gproj_cholesky *)data;
    const gproji_symbolic *sy = &c->symbolic;
    double *z = c->rows + (size_t)group * (size_t)sy->most_rows;
    int32_t k, side;
    for (k = sy->task_start[group + 1] - 1; k >= sy->task_start[group]; --k) {
        if (k > sy->task_start[group]) gproji_prefetch_front(c, sy->schedule[k - 1]);
        for (side = 0; side < c->sides; ++side) gproji_backward_front(c, &sy->front[sy->schedule[k]], side, z);
    }
}

/* Takes up to c->batch right-hand sides in the order of L. */
GPROJI_INTERNAL void gproji_cholesky_take_sides(gproj_cholesky *c, int32_t count, const double *b) {
    size_t n = (size_t)c->symbolic.columns, i;
    int32_t r;
    c->sides = count;
    for (r = 0; r < count; ++r)
        for (i = 0; i < n; ++i) c->solution[(size_t)r * n + i] = b[(size_t)r * n + (size_t)c->permutation[i]];
}

/* From L y = b, solved already, to x. */
GPROJI_INTERNAL void gproji_cholesky_finish(gproj_cholesky *c, double *x) {
    const gproji_symbolic *sy = &c->symbolic;
    size_t n = (size_t)sy->columns, i;
    int32_t r;
    gproji_backward_group(c, sy->tasks);
    gproji_for(&c->parallel, sy->tasks, gproji_backward_group, c);
    for (r = 0; r < c->sides; ++r)
        for (i = 0; i < n; ++i) x[(size_t)r * n + (size_t)c->permutation[i]] = c->solution[(size_t)r * n + i];
}

/* Solves L y = b for up to c->batch right-hand sides; y stays in c->solution, in the order of L. */
GPROJI_INTERNAL void gproji_cholesky_start(gproj_cholesky *c, int32_t count, const double *b) {
    gproji_cholesky_take_sides(c, count, b);
    gproji_for(&c->parallel, c->symbolic.tasks, gproji_forward_group, c);
    gproji_forward_group(c, c->symbolic.tasks);
}

/* Solves for up to c->batch right-hand sides. */
GPROJI_INTERNAL void gproji_cholesky_solve_batch(gproj_cholesky *c, int32_t count, const double *b, double *x) {
    gproji_cholesky_start(c, count, b);
    gproji_cholesky_finish(c, x);
}

/* L y = b for any number of right-hand sides, y in the order of L; may be in place. */
GPROJI_INTERNAL void gproji_cholesky_forward(gproj_cholesky *c, int32_t count, const double *b, double *y) {
    size_t n = (size_t)c->symbolic.columns;
    int32_t r, sides;
    for (r = 0; r < count; r += sides) {
        sides = gproji_min(count - r, c->batch);
        gproji_cholesky_start(c, sides, b + (size_t)r * n);
        memcpy(y + (size_t)r * n, c->solution, (size_t)sides * n * sizeof *y);
    }
}

/* L' x = y for one right-hand side in the order of L; may be in place. */
GPROJI_INTERNAL void gproji_cholesky_backward(gproj_cholesky *c, const double *y, double *x) {
    memcpy(c->solution, y, (size_t)c->symbolic.columns * sizeof *y);
    c->sides = 1;
    gproji_cholesky_finish(c, x);
}

/* -- all fronts -- */

/* Eliminates the fronts of one group, a task's or those on top, and takes the right-hand sides along. */
GPROJI_INTERNAL void gproji_factor_group(void *data, int32_t group) {
    gproj_cholesky *c = (gproj_cholesky *)data;
    const gproji_symbolic *sy = &c->symbolic;
    double *z = c->rows + (size_t)group * (size_t)sy->most_rows;
    gproji_piece *pieces = c->pieces + sy->pieces_start[group];
    const gproj_parallel *parallel = group == sy->tasks ? &c->parallel : NULL;
    int32_t k, side, failed = -1;
    for (k = sy->task_start[group]; k < sy->task_start[group + 1] && failed < 0; ++k) {
        if (k + 1 < sy->task_start[group + 1]) gproji_prefetch_front(c, sy->schedule[k + 1]);
        failed = gproji_factor_front(c, sy->schedule[k], parallel, pieces);
        for (side = 0; failed < 0 && side < c->sides; ++side)
            gproji_forward_front(c, &sy->front[sy->schedule[k]], side, z);
    }
    c->failed[group] = failed;
}

/* Factors the matrix that `load` adds to the fronts, and solves L y = b for up to c->batch right-hand sides:
   gproji_cholesky_finish gives their solutions. All memory has been taken. */
GPROJI_INTERNAL gproj_factor_outcome gproji_cholesky_factor_with(gproj_cholesky *c, gproji_load load, void *user,
                                                                 int32_t sides, const double *b) {
    const gproji_symbolic *sy = &c->symbolic;
    int32_t g, failed = -1;
    GPROJ_ASSERT(c->analysed && c->values);
    c->factored = false;
    c->load = load;
    c->load_user = user;
    gproji_cholesky_take_sides(c, sides, b);
    gproji_for(&c->parallel, sy->tasks, gproji_factor_group, c);
    for (g = 0; g < sy->tasks; ++g)
        if (c->failed[g] >= 0 && (failed < 0 || c->failed[g] < failed)) failed = c->failed[g];
    if (failed < 0) {
        gproji_factor_group(c, sy->tasks);
        failed = c->failed[sy->tasks];
    }
    c->failed_column = failed < 0 ? -1 : c->permutation[failed];
    c->factored = failed < 0;
    return c->factored ? GPROJ_FACTORED : GPROJ_NOT_POSITIVE_DEFINITE;
}

GPROJ_API gproj_factor_outcome gproj_cholesky_factor(gproj_cholesky *cholesky, const double *values) {
    gproj_cholesky *c = cholesky;
    if (!c) return GPROJ_FACTOR_FAILED;
    gproji_error_clear(&c->error);
    if (!c->analysed || (c->symbolic.columns > 0 && !c->target)) {
        gproji_fail(&c->error, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1, "factor: there is no analysis of a matrix");
        return GPROJ_FACTOR_FAILED;
    }
    if (!values && c->entries > 0) {
        gproji_fail(&c->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "factor: the values are missing");
        return GPROJ_FACTOR_FAILED;
    }
    if (!gproji_cholesky_take_numeric(c)) return GPROJ_FACTOR_FAILED;
    c->source = values;
    return gproji_cholesky_factor_with(c, gproji_load_columns, c, 0, NULL);
}

/* -- solution -- */

GPROJ_API gproj_code gproj_cholesky_solve(gproj_cholesky *cholesky, int32_t count, const double *b, double *x) {
    gproj_cholesky *c = cholesky;
    int32_t r;
    if (!c) return GPROJ_ERROR_ARGUMENT;
    gproji_error_clear(&c->error);
    if (!c->factored)
        return gproji_fail(&c->error, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1,
                           "solve: there is no factor to solve with");
    if (count < 0 || (count > 0 && c->symbolic.columns > 0 && (!b || !x)))
        return gproji_fail(&c->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                           "solve: %d right-hand sides, or an array is missing", count);
    if (c->symbolic.columns == 0) return GPROJ_OK;
    for (r = 0; r < count; r += c->batch) {
        size_t offset = (size_t)r * (size_t)c->symbolic.columns;
        gproji_cholesky_solve_batch(c, gproji_min(count - r, c->batch), b + offset, x + offset);
    }
    return GPROJ_OK;
}

/* residual = b - A x; returns its largest absolute value. */
GPROJI_INTERNAL double gproji_cholesky_residual(int32_t n, const int64_t *start, const int32_t *row,
                                                const double *values, const double *b, const double *x,
                                                double *residual) {
    double largest = 0;
    int32_t j;
    int64_t p;
    for (j = 0; j < n; ++j) residual[j] = b[j];
    for (j = 0; j < n; ++j)
        for (p = start[j]; p < start[j + 1]; ++p) {
            residual[row[p]] -= values[p] * x[j];
            if (row[p] != j) residual[j] -= values[p] * x[row[p]];
        }
    for (j = 0; j < n; ++j)
        if (!(fabs(residual[j]) <= largest)) largest = fabs(residual[j]);
    return largest;
}

GPROJ_API double gproj_cholesky_refine(gproj_cholesky *cholesky, const int64_t *start, const int32_t *row,
                                       const double *values, const double *b, double *x, int32_t steps) {
    gproj_cholesky *c = cholesky;
    int32_t n, j, step;
    double *residual, largest;
    if (!c) return HUGE_VAL;
    gproji_error_clear(&c->error);
    n = c->symbolic.columns;
    if (!c->factored) {
        gproji_fail(&c->error, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1, "refine: there is no factor to solve with");
        return HUGE_VAL;
    }
    if (n == 0) return 0;
    if (!start || !row || !values || !b || !x) {
        gproji_fail(&c->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "refine: an array is missing");
        return HUGE_VAL;
    }
    GPROJ_ASSERT(c->batch > 1);
    residual = c->solution + n; /* the solution of one right-hand side uses only the first n */
    largest = gproji_cholesky_residual(n, start, row, values, b, x, residual);
    for (step = 0; step < steps; ++step) {
        gproji_cholesky_solve_batch(c, 1, residual, residual);
        for (j = 0; j < n; ++j) x[j] += residual[j];
        largest = gproji_cholesky_residual(n, start, row, values, b, x, residual);
    }
    return largest;
}

/* ============================================================================================================
   >>least-squares   Sparse linear least squares with bounds. Uses platform, memory, error, cholesky.

   An interior-point method finds which variables are at their bounds; then Newton steps on the others, with exchanges
   of the few that were mistaken, make it exact. All matrices are
       A'A + damping^2 I + D + a diagonal of the method,
   so one pattern is analysed once. D is 1e-12 times the diagonal, and only in the matrix, never in the gradient: each
   step is a step of the proximal point method (Rockafellar 1976), which solves the undamped problem, also where A'A is
   singular; dependent columns stay near where they come from instead of being driven to a corner.

   The interior-point method is Mehrotra's (1992) with the correctors of Gondzio (1996) and equal steps for x and the
   multipliers. Each finite bound is a pair of a slack s > 0 and a multiplier z > 0, sought with s z = 0. For the
   displacement of x
       (A'A + damping^2 I + D + sum z/s) dx = -(g - sum +-z) + sum +-t/s,   s dz + z ds = t,
   + for lower and - for upper bounds, g the gradient, t the target of the step. Exchanges are those of block principal
   pivoting (Portugal, Judice, Vicente 1994), used only as long as each round halves the number of mistakes; when it
   does not, the interior-point method goes on and its next guess is better. So the method cannot cycle, and a limit of
   factorisations ends it in any case. */
enum {
    GPROJI_SQUARES_LIMIT = 80,  /* factorisations */
    GPROJI_SQUARES_ROUNDS = 12, /* of exchanges, one factorisation each */
    GPROJI_SQUARES_CORRECTORS = 3
};

/* Bounds and numbers beyond it are none. Its powers and products stay finite. */
#define GPROJI_SQUARES_HUGE 1e50

enum {
    GPROJI_VARIABLE_FREE,
    GPROJI_VARIABLE_LOWER, /* held at its lower bound */
    GPROJI_VARIABLE_UPPER,
    GPROJI_VARIABLE_FIXED /* its bounds are equal */
};

/* A direction of the interior-point method. */
typedef struct gproji_direction {
    double *x;      /* columns: dx */
    double *target; /* pairs: t */
    double *dual;   /* pairs: dz */
    double reach;   /* the longest step that keeps slacks and multipliers >= 0, cut at 10 */
} gproji_direction;

typedef struct gproji_squares {
    const gproj_least_squares *problem;
    gproji_heap heap;
    gproji_pool pool;
    gproj_cholesky *cholesky;
    gproj_error *error;
    gproj_code code; /* other than GPROJ_OK ends everything */
    int32_t factorisations;
    int32_t columns;
    double damping;   /* squared */
    double proximity; /* D = proximity * diagonal */

    int64_t *row_start; /* rows + 1: A by rows */
    int32_t *row_column;
    double *row_value;
    int64_t *start; /* columns + 1: lower triangle of A'A, the diagonal first */
    int32_t *row;
    double *product; /* A'A */
    double *matrix;  /* what is factored */

    /* columns: */
    double *lower, *upper;
    double *diagonal; /* of A'A + damping^2 I; the largest where it is 0 */
    double *barrier;  /* what the method adds to the diagonal */
    double *gradient; /* at the last point of gproji_squares_gradient */
    double *x;        /* the interior point */
    double *trial, *step, *best;
    unsigned char *state;
    /* rows: */
    double *misfit;    /* A x - b */
    double *magnitude; /* |A||x| + |b| */

    double noise; /* rounding errors of the last gradient */
    double scale; /* of kkt */
    double best_kkt;

    int32_t pairs; /* finite bounds of variables that are not fixed */
    int32_t *variable;
    double *sign, *slack, *dual;
    gproji_direction direction, other;
} gproji_squares;

/* -- the problem -- */

GPROJI_INTERNAL bool gproji_squares_finite(double x) { return gproji_is_finite(x) && fabs(x) <= GPROJI_SQUARES_HUGE; }

GPROJI_INTERNAL gproj_code gproji_squares_check_entries(const gproj_least_squares *p, gproj_error *error) {
    int32_t j;
    int64_t e;
    if (p->start[0] != 0)
        return gproji_fail(error, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, 0, "least squares: start[0] is not 0");
    for (j = 0; j < p->columns; ++j) {
        if (p->start[j + 1] < p->start[j])
            return gproji_fail(error, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, j,
                               "least squares: column %d ends before it starts", j);
        if (p->start[j + 1] > p->start[j] && (!p->row || !p->value))
            return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                               "least squares: the rows or the values of the entries are missing");
        for (e = p->start[j]; e < p->start[j + 1]; ++e) {
            if (p->row[e] < 0 || p->row[e] >= p->rows)
                return gproji_fail(error, GPROJ_ERROR_INDEX, GPROJ_PLACE_COLUMN, j,
                                   "least squares: column %d has an entry in row %d of %d rows", j, p->row[e], p->rows);
            if (!gproji_squares_finite(p->value[e]))
                return gproji_fail(error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_COLUMN, j,
                                   "least squares: a value of column %d is not a number or beyond 1e50", j);
        }
    }
    return GPROJ_OK;
}

GPROJI_INTERNAL gproj_code gproji_squares_check(const gproj_least_squares *p, const double *x, gproj_error *error) {
    int32_t i;
    if (!p) return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "least squares: there is no problem");
    if (p->rows < 0 || p->columns < 0 || p->columns == INT32_MAX || p->rows == INT32_MAX)
        return gproji_fail(error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "least squares: %d rows and %d columns",
                           p->rows, p->columns);
    if ((p->columns > 0 && (!x || !p->start)) || (p->rows > 0 && !p->b))
        return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "least squares: an array is missing");
    if (!gproji_squares_finite(p->damping) || p->damping < 0)
        return gproji_fail(error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1,
                           "least squares: the damping is negative or not a number");
    for (i = 0; i < p->rows; ++i)
        if (!gproji_squares_finite(p->b[i]))
            return gproji_fail(error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_ROW, i,
                               "least squares: b is not a number or beyond 1e50 in row %d", i);
    for (i = 0; i < p->columns; ++i)
        if (!gproji_squares_finite(x[i]))
            return gproji_fail(error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VARIABLE, i,
                               "least squares: the start of variable %d is not a number or beyond 1e50", i);
    return p->columns > 0 ? gproji_squares_check_entries(p, error) : GPROJ_OK;
}

/* A bound as a number that is never infinite: `none`, -HUGE or HUGE, where there is no bound. False for NaN and for a
   bound on the wrong side. Infinities are told by their bits: comparisons may be compiled for finite numbers only. */
GPROJI_INTERNAL bool gproji_squares_bound(const double *bound, int32_t j, double none, double *out) {
    uint64_t bits;
    *out = none;
    if (!bound) return true;
    memcpy(&bits, &bound[j], sizeof bits);
    if (!gproji_is_finite(bound[j])) return (bits << 12) == 0 && ((bits >> 63) != 0) == (none < 0);
    if (fabs(bound[j]) <= GPROJI_SQUARES_HUGE) *out = bound[j];
    return *out == bound[j] || (bound[j] < 0) == (none < 0);
}

GPROJI_INTERNAL void gproji_squares_set_bounds(gproji_squares *s) {
    const gproj_least_squares *p = s->problem;
    int32_t j;
    s->pairs = 0;
    for (j = 0; j < s->columns && s->code == GPROJ_OK; ++j) {
        bool good = gproji_squares_bound(p->lower, j, -GPROJI_SQUARES_HUGE, &s->lower[j]);
        good = gproji_squares_bound(p->upper, j, GPROJI_SQUARES_HUGE, &s->upper[j]) && good;
        if (!good || s->lower[j] > s->upper[j])
            s->code = gproji_fail(s->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VARIABLE, j,
                                  "least squares: variable %d has no number between its bounds", j);
        s->state[j] = s->lower[j] < s->upper[j] ? GPROJI_VARIABLE_FREE : GPROJI_VARIABLE_FIXED;
        if (s->state[j] == GPROJI_VARIABLE_FIXED) continue;
        if (s->lower[j] > -GPROJI_SQUARES_HUGE) s->variable[s->pairs] = j, s->sign[s->pairs++] = 1;
        if (s->upper[j] < GPROJI_SQUARES_HUGE) s->variable[s->pairs] = j, s->sign[s->pairs++] = -1;
    }
}

GPROJI_INTERNAL double gproji_squares_clip(const gproji_squares *s, int32_t j, double x) {
    return gproji_fmin(gproji_fmax(x, s->lower[j]), s->upper[j]);
}

/* -- the matrix -- */

/* A by rows. */
GPROJI_INTERNAL void gproji_squares_transpose(gproji_squares *s) {
    const gproj_least_squares *p = s->problem;
    int32_t i, j;
    int64_t e;
    for (e = 0; e < p->start[s->columns]; ++e) s->row_start[p->row[e] + 1]++;
    for (i = 0; i < p->rows; ++i) s->row_start[i + 1] += s->row_start[i];
    for (j = 0; j < s->columns; ++j)
        for (e = p->start[j]; e < p->start[j + 1]; ++e) {
            int64_t to = s->row_start[p->row[e]]++;
            s->row_column[to] = j, s->row_value[to] = p->value[e];
        }
    for (i = p->rows; i > 0; --i) s->row_start[i] = s->row_start[i - 1];
    s->row_start[0] = 0;
}

/* Column j of the lower triangle of A'A from entry `at` on; without `product` only its pattern is counted. mark:
   columns entries, each less than any `at` from now on. Returns where the column ends. */
GPROJI_INTERNAL int64_t gproji_squares_column(gproji_squares *s, int32_t j, int64_t at, int64_t *mark) {
    const gproj_least_squares *p = s->problem;
    int64_t begin = at, e, f;
    mark[j] = at++;
    if (s->product) s->row[begin] = j, s->product[begin] = 0;
    for (e = p->start[j]; e < p->start[j + 1]; ++e)
        for (f = s->row_start[p->row[e]]; f < s->row_start[p->row[e] + 1]; ++f) {
            int32_t i = s->row_column[f];
            if (i < j) continue;
            if (mark[i] < begin) {
                mark[i] = at++;
                if (s->product) s->row[mark[i]] = i, s->product[mark[i]] = 0;
            }
            if (s->product) s->product[mark[i]] += p->value[e] * s->row_value[f];
        }
    return at;
}

GPROJI_INTERNAL void gproji_squares_columns(gproji_squares *s, int64_t *mark) {
    int32_t j;
    for (j = 0; j < s->columns; ++j) mark[j] = -1;
    s->start[0] = 0;
    for (j = 0; j < s->columns; ++j) s->start[j + 1] = gproji_squares_column(s, j, s->start[j], mark);
}

GPROJI_INTERNAL void gproji_squares_set_diagonal(gproji_squares *s) {
    double largest = 0;
    int32_t j;
    for (j = 0; j < s->columns; ++j) {
        s->diagonal[j] = s->product[s->start[j]] + s->damping;
        largest = gproji_fmax(largest, s->diagonal[j]);
    }
    if (!(largest > DBL_MIN)) largest = 1;
    for (j = 0; j < s->columns; ++j)
        if (!(s->diagonal[j] > 1e-60 * largest)) s->diagonal[j] = largest;
}

/* A'A and the analysis of its pattern. */
GPROJI_INTERNAL void gproji_squares_assemble(gproji_squares *s) {
    int64_t *mark = (int64_t *)gproji_take(&s->heap, (size_t)s->columns, sizeof(int64_t)), entries;
    bool good = mark != NULL;
    if (good) {
        gproji_squares_transpose(s);
        gproji_squares_columns(s, mark);
        entries = s->start[s->columns];
        s->row = (int32_t *)gproji_pool_take(&s->pool, entries, sizeof(int32_t));
        s->matrix = (double *)gproji_pool_take(&s->pool, entries, sizeof(double));
        s->product = (double *)gproji_pool_take(&s->pool, entries, sizeof(double));
        good = s->row && s->matrix && s->product;
        if (good) gproji_squares_columns(s, mark);
        gproji_give(&s->heap, mark, (size_t)s->columns, sizeof(int64_t));
    }
    if (!good) {
        s->code = gproji_fail_memory(s->error);
        return;
    }
    gproji_squares_set_diagonal(s);
    s->code = gproj_cholesky_analyse(s->cholesky, s->columns, s->start, s->row, NULL);
    if (s->code != GPROJ_OK && s->error) *s->error = *gproj_cholesky_error(s->cholesky);
}

/* The matrix of the free variables, with the barrier on its diagonal; the others become rows of the identity. */
GPROJI_INTERNAL void gproji_squares_fill(gproji_squares *s) {
    int32_t j;
    int64_t e;
    for (j = 0; j < s->columns; ++j) {
        bool held = s->state[j] != GPROJI_VARIABLE_FREE;
        e = s->start[j];
        s->matrix[e] =
            held ? s->diagonal[j] : s->product[e] + s->damping + s->proximity * s->diagonal[j] + s->barrier[j];
        while (++e < s->start[j + 1])
            s->matrix[e] = held || s->state[s->row[e]] != GPROJI_VARIABLE_FREE ? 0 : s->product[e];
    }
}

/* Factors the matrix. A matrix that is singular to rounding gets more on its diagonal. False: no factor, because of an
   error or of the limit. */
GPROJI_INTERNAL bool gproji_squares_factor(gproji_squares *s) {
    while (s->factorisations < GPROJI_SQUARES_LIMIT && s->proximity < 1e-3) {
        gproj_factor_outcome outcome;
        gproji_squares_fill(s);
        s->factorisations++;
        outcome = gproj_cholesky_factor(s->cholesky, s->matrix);
        if (outcome == GPROJ_FACTORED) return true;
        if (outcome == GPROJ_FACTOR_FAILED) {
            if (s->error) *s->error = *gproj_cholesky_error(s->cholesky);
            s->code = gproj_cholesky_error(s->cholesky)->code;
            return false;
        }
        s->proximity *= 100;
    }
    return false;
}

/* -- gradients -- */

/* misfit = A x - b, magnitude = |A||x| + |b| */
GPROJI_INTERNAL void gproji_squares_misfit(gproji_squares *s, const double *x) {
    const gproj_least_squares *p = s->problem;
    int32_t i, j;
    int64_t e;
    for (i = 0; i < p->rows; ++i) s->misfit[i] = -p->b[i], s->magnitude[i] = fabs(p->b[i]);
    for (j = 0; j < s->columns; ++j)
        for (e = p->start[j]; e < p->start[j + 1]; ++e) {
            double term = p->value[e] * x[j];
            s->misfit[p->row[e]] += term;
            s->magnitude[p->row[e]] += fabs(term);
        }
}

/* gradient = A'(A x - b) + damping^2 x. Returns the largest entry of the same sums of absolute values. */
GPROJI_INTERNAL double gproji_squares_gradient(gproji_squares *s, const double *x) {
    const gproj_least_squares *p = s->problem;
    double largest = 0;
    int32_t j;
    int64_t e;
    gproji_squares_misfit(s, x);
    for (j = 0; j < s->columns; ++j) {
        double sum = s->damping * x[j], size = fabs(sum);
        for (e = p->start[j]; e < p->start[j + 1]; ++e) {
            sum += p->value[e] * s->misfit[p->row[e]];
            size += fabs(p->value[e]) * s->magnitude[p->row[e]];
        }
        s->gradient[j] = sum;
        largest = gproji_fmax(largest, size);
    }
    s->noise = 16 * DBL_EPSILON * largest;
    return largest;
}

/* What the gradient at variable j lacks to that of a solution, x being within the bounds. */
GPROJI_INTERNAL double gproji_squares_violation(const gproji_squares *s, int32_t j, double x) {
    double g = s->gradient[j];
    if (x <= s->lower[j] && g >= 0) return 0;
    if (x >= s->upper[j] && g <= 0) return 0;
    return s->state[j] == GPROJI_VARIABLE_FIXED ? 0 : fabs(g);
}

/* Judges trial, which is within the bounds, and keeps it if it is the best so far. True: it is a solution. */
GPROJI_INTERNAL bool gproji_squares_judge(gproji_squares *s) {
    double largest = 0, kkt;
    int32_t j;
    gproji_squares_gradient(s, s->trial);
    for (j = 0; j < s->columns; ++j) largest = gproji_fmax(largest, gproji_squares_violation(s, j, s->trial[j]));
    kkt = largest / s->scale;
    if (gproji_is_finite(kkt) && kkt < s->best_kkt) {
        memcpy(s->best, s->trial, (size_t)s->columns * sizeof(double));
        s->best_kkt = kkt;
    }
    return largest <= gproji_fmax(s->noise, DBL_EPSILON * s->scale);
}

/* -- Newton steps and exchanges -- */

/* step = the displacement that makes the gradient 0 at the free variables. Returns its largest entry there. */
GPROJI_INTERNAL double gproji_squares_newton(gproji_squares *s) {
    double largest = 0;
    int32_t j;
    for (j = 0; j < s->columns; ++j) {
        s->step[j] = s->state[j] == GPROJI_VARIABLE_FREE ? -s->gradient[j] : 0;
        largest = gproji_fmax(largest, fabs(s->step[j]));
    }
    gproj_cholesky_solve(s->cholesky, 1, s->step, s->step);
    return largest;
}

/* Moves the free variables of trial to the minimum, by Newton steps with one factor; more than one because of the
   proximity in the matrix, and of rounding. Leaves the gradient there. */
GPROJI_INTERNAL void gproji_squares_minimise(gproji_squares *s) {
    double before = HUGE_VAL, now;
    int32_t round, j;
    for (round = 0; round < 6; ++round) {
        gproji_squares_gradient(s, s->trial);
        now = gproji_squares_newton(s);
        if (now <= 0.1 * s->noise || (round > 1 && now > 0.5 * before)) return;
        before = now;
        for (j = 0; j < s->columns; ++j) s->trial[j] += s->step[j];
    }
    gproji_squares_gradient(s, s->trial);
}

/* Holds the free variables of trial that have left their bounds, frees those held against the gradient, and returns
   their number. */
GPROJI_INTERNAL int32_t gproji_squares_exchange(gproji_squares *s) {
    int32_t count = 0, j;
    for (j = 0; j < s->columns; ++j) {
        unsigned char old = s->state[j];
        double g = s->gradient[j];
        if (old == GPROJI_VARIABLE_FREE && s->trial[j] < s->lower[j]) s->state[j] = GPROJI_VARIABLE_LOWER;
        if (old == GPROJI_VARIABLE_FREE && s->trial[j] > s->upper[j]) s->state[j] = GPROJI_VARIABLE_UPPER;
        if (old == GPROJI_VARIABLE_LOWER && g < -s->noise) s->state[j] = GPROJI_VARIABLE_FREE;
        if (old == GPROJI_VARIABLE_UPPER && g > s->noise) s->state[j] = GPROJI_VARIABLE_FREE;
        count += old != s->state[j];
        s->trial[j] = gproji_squares_clip(s, j, s->trial[j]);
    }
    return count;
}

/* From trial and the states: minimises, exchanges, and goes on while there are half as many exchanges as before. True:
   best is a solution. */
GPROJI_INTERNAL bool gproji_squares_polish(gproji_squares *s, int32_t rounds) {
    int32_t round, before = INT32_MAX, count, j;
    for (j = 0; j < s->columns; ++j) s->barrier[j] = 0;
    for (round = 0; round < rounds; ++round) {
        if (!gproji_squares_factor(s)) return false;
        gproji_squares_minimise(s);
        count = gproji_squares_exchange(s);
        if (gproji_squares_judge(s)) return true;
        if (count == 0 || count > before / 2 + 2) return false;
        before = count;
    }
    return false;
}

/* -- the interior-point method -- */

/* How many variables are free again. */
GPROJI_INTERNAL int32_t gproji_squares_free_all(gproji_squares *s) {
    int32_t j, count = 0;
    for (j = 0; j < s->columns; ++j) {
        if (s->state[j] == GPROJI_VARIABLE_FIXED) continue;
        s->state[j] = GPROJI_VARIABLE_FREE;
        ++count;
    }
    return count;
}

GPROJI_INTERNAL double gproji_squares_slack(const gproji_squares *s, int32_t pair) {
    int32_t j = s->variable[pair];
    return s->sign[pair] > 0 ? s->x[j] - s->lower[j] : s->upper[j] - s->x[j];
}

/* Moves x by the shift away from its bounds: all variables alike, so that a state of equal forces stays one, but no
   further than a quarter of the way between two bounds. */
GPROJI_INTERNAL void gproji_squares_move_inside(gproji_squares *s, double shift) {
    int32_t j;
    for (j = 0; j < s->columns; ++j) {
        bool below = s->lower[j] > -GPROJI_SQUARES_HUGE, above = s->upper[j] < GPROJI_SQUARES_HUGE;
        double margin = shift / sqrt(s->diagonal[j]);
        if (s->state[j] == GPROJI_VARIABLE_FIXED) continue;
        if (below && above) {
            margin = gproji_fmin(margin, 0.25 * (s->upper[j] - s->lower[j]));
            s->x[j] = gproji_fmax(gproji_fmin(s->x[j], s->upper[j] - margin), s->lower[j] + margin);
        } else if (below) {
            s->x[j] += margin;
        } else if (above) {
            s->x[j] -= margin;
        }
    }
}

/* x within the bounds, near the solution without bounds of a problem with much damping. Slacks and multipliers are
   chosen in units in which the columns of A have length 1. */
GPROJI_INTERNAL bool gproji_squares_interior(gproji_squares *s) {
    double violation = 0, size = 0, force = 0, shift;
    int32_t j, c;
    for (j = 0; j < s->columns; ++j) s->barrier[j] = 1e-3 * s->diagonal[j];
    if (!gproji_squares_factor(s)) return false;
    gproji_squares_gradient(s, s->x);
    for (j = 0; j < s->columns; ++j)
        if (s->state[j] == GPROJI_VARIABLE_FREE)
            force = gproji_fmax(force, fabs(s->gradient[j]) / sqrt(s->diagonal[j]));
    gproji_squares_newton(s);
    for (j = 0; j < s->columns; ++j) s->x[j] += s->step[j];
    for (c = 0; c < s->pairs; ++c) {
        double slack = gproji_squares_slack(s, c) * sqrt(s->diagonal[s->variable[c]]);
        violation = gproji_fmax(violation, -slack);
        size = gproji_fmax(size, gproji_fmin(fabs(slack), 1e3 * force));
    }
    shift = gproji_fmax(1.5 * violation + 1e-3 * size, 1e-3 * force);
    if (!(shift > 0) || !gproji_is_finite(shift)) return false;
    gproji_squares_move_inside(s, shift);
    for (c = 0; c < s->pairs; ++c) {
        s->slack[c] = gproji_squares_slack(s, c);
        s->dual[c] = 0.1 * force * sqrt(s->diagonal[s->variable[c]]);
        if (!(s->slack[c] > 0)) return false; /* bounds that are neighbours as numbers */
    }
    return true;
}

/* barrier = sum z/s */
GPROJI_INTERNAL void gproji_squares_set_barrier(gproji_squares *s) {
    int32_t j, c;
    for (j = 0; j < s->columns; ++j) s->barrier[j] = 0;
    for (c = 0; c < s->pairs; ++c) s->barrier[s->variable[c]] += s->dual[c] / s->slack[c];
}

/* gradient = g - sum +-z: what the multipliers do not hold. Returns its largest entry relative to scale. */
GPROJI_INTERNAL double gproji_squares_imbalance(gproji_squares *s) {
    double largest = 0;
    int32_t j, c;
    gproji_squares_gradient(s, s->x);
    for (c = 0; c < s->pairs; ++c) s->gradient[s->variable[c]] -= s->sign[c] * s->dual[c];
    for (j = 0; j < s->columns; ++j)
        if (s->state[j] == GPROJI_VARIABLE_FREE) largest = gproji_fmax(largest, fabs(s->gradient[j]));
    return largest / s->scale;
}

/* The mean of (s + a ds)(z + a dz). */
GPROJI_INTERNAL double gproji_squares_mean(const gproji_squares *s, const gproji_direction *d, double a) {
    double sum = 0;
    int32_t c;
    for (c = 0; c < s->pairs; ++c) {
        double ds = a > 0 ? a * s->sign[c] * d->x[s->variable[c]] : 0, dz = a > 0 ? a * d->dual[c] : 0;
        sum += (s->slack[c] + ds) * (s->dual[c] + dz);
    }
    return sum / s->pairs;
}

/* The direction towards d->target, with the factor and the imbalance in `gradient`. */
GPROJI_INTERNAL void gproji_squares_direct(gproji_squares *s, gproji_direction *d) {
    int32_t j, c;
    for (j = 0; j < s->columns; ++j) d->x[j] = s->state[j] == GPROJI_VARIABLE_FREE ? -s->gradient[j] : 0;
    for (c = 0; c < s->pairs; ++c) d->x[s->variable[c]] += s->sign[c] * d->target[c] / s->slack[c];
    gproj_cholesky_solve(s->cholesky, 1, d->x, d->x);
    d->reach = 10;
    for (c = 0; c < s->pairs; ++c) {
        double ds = s->sign[c] * d->x[s->variable[c]];
        d->dual[c] = (d->target[c] - s->dual[c] * ds) / s->slack[c];
        if (-ds * d->reach > s->slack[c]) d->reach = s->slack[c] / -ds;
        if (-d->dual[c] * d->reach > s->dual[c]) d->reach = s->dual[c] / -d->dual[c];
    }
}

/* Mehrotra's predictor and corrector. Returns the product s z that the corrector aims at. */
GPROJI_INTERNAL double gproji_squares_predict(gproji_squares *s) {
    gproji_direction *d = &s->direction;
    double mean = gproji_squares_mean(s, d, 0), ratio, aim;
    int32_t c;
    for (c = 0; c < s->pairs; ++c) d->target[c] = -s->slack[c] * s->dual[c];
    gproji_squares_direct(s, d);
    ratio = gproji_squares_mean(s, d, gproji_fmin(d->reach, 1)) / mean;
    aim = 0.1 * ratio * ratio * mean;
    for (c = 0; c < s->pairs; ++c) d->target[c] += aim - s->sign[c] * d->x[s->variable[c]] * d->dual[c];
    gproji_squares_direct(s, d);
    return aim;
}

/* Gondzio's correctors: targets for the products that a longer step would leave too far from the aim. Each costs a
   solve, and saves factorisations. */
GPROJI_INTERNAL void gproji_squares_correct(gproji_squares *s, double aim) {
    int32_t round, c;
    for (round = 0; round < GPROJI_SQUARES_CORRECTORS && s->direction.reach < 1.005; ++round) {
        gproji_direction *d = &s->direction, *other = &s->other, swap;
        double a = gproji_fmin(1, d->reach + 0.1);
        for (c = 0; c < s->pairs; ++c) {
            double ds = s->sign[c] * d->x[s->variable[c]];
            double product = (s->slack[c] + a * ds) * (s->dual[c] + a * d->dual[c]), change = 0;
            if (product < 0.1 * aim) change = 0.1 * aim - product;
            if (product > 10 * aim) change = gproji_fmax(10 * aim - product, -10 * aim);
            other->target[c] = d->target[c] + change;
        }
        gproji_squares_direct(s, other);
        if (!(other->reach >= d->reach + 0.01)) return;
        swap = *d, *d = *other, *other = swap;
    }
}

/* One step. False: there is no step that is a number, or it is too short to count. */
GPROJI_INTERNAL bool gproji_squares_advance(gproji_squares *s) {
    gproji_direction *d = &s->direction;
    double a;
    int32_t j, c;
    gproji_squares_set_barrier(s);
    if (!gproji_squares_factor(s)) return false;
    gproji_squares_correct(s, gproji_squares_predict(s));
    a = gproji_fmin(1, 0.995 * d->reach);
    for (j = 0; j < s->columns; ++j)
        if (!gproji_is_finite(d->x[j])) return false;
    for (c = 0; c < s->pairs; ++c)
        if (!gproji_is_finite(d->dual[c])) return false;
    for (j = 0; j < s->columns; ++j) s->x[j] += a * d->x[j];
    for (c = 0; c < s->pairs; ++c) {
        s->slack[c] += a * s->sign[c] * d->x[s->variable[c]];
        s->dual[c] += a * d->dual[c];
    }
    return a > 1e-6;
}

/* The share of bounds of which it is not clear whether they are reached. */
GPROJI_INTERNAL double gproji_squares_doubt(const gproji_squares *s) {
    int32_t c, count = 0;
    for (c = 0; c < s->pairs; ++c) {
        double slack = s->slack[c] * s->diagonal[s->variable[c]];
        count += slack > 1e-2 * s->dual[c] && slack < 1e2 * s->dual[c];
    }
    return (double)count / s->pairs;
}

/* trial and states as the interior point suggests; it stays as it is. */
GPROJI_INTERNAL void gproji_squares_guess(gproji_squares *s) {
    int32_t c, j;
    for (j = 0; j < s->columns; ++j) s->trial[j] = gproji_squares_clip(s, j, s->x[j]);
    for (c = 0; c < s->pairs; ++c) {
        j = s->variable[c];
        if (s->slack[c] * s->diagonal[j] > s->dual[c]) continue;
        s->state[j] = s->sign[c] > 0 ? GPROJI_VARIABLE_LOWER : GPROJI_VARIABLE_UPPER;
        s->trial[j] = s->sign[c] > 0 ? s->lower[j] : s->upper[j];
    }
}

/* From s->x: the interior-point method, with a polish whenever it seems to know the bounds. */
GPROJI_INTERNAL bool gproji_squares_iterate(gproji_squares *s) {
    double tolerance = 1e-4, doubt = 0.02, first = 0;
    bool moves = true;
    if (!gproji_squares_interior(s)) return false;
    while (s->code == GPROJ_OK && s->factorisations < GPROJI_SQUARES_LIMIT) {
        double imbalance = gproji_squares_imbalance(s), gap = gproji_squares_mean(s, &s->direction, 0);
        bool last = !moves || gap <= 1e-22 * first, clear;
        if (first <= 0) first = gap;
        clear = gproji_squares_doubt(s) <= doubt || gap <= 1e-5 * tolerance * first;
        if (last || (imbalance <= tolerance && gap <= tolerance * first && clear)) {
            gproji_squares_guess(s);
            if (gproji_squares_polish(s, GPROJI_SQUARES_ROUNDS)) return true;
            gproji_squares_free_all(s);
            if (last) return false;
            tolerance *= 1e-2, doubt *= 0.1;
            gproji_squares_imbalance(s);
        }
        moves = gproji_squares_advance(s);
    }
    return false;
}

/* -- the solution -- */

GPROJI_INTERNAL bool gproji_squares_take(gproji_squares *s) {
    const gproj_least_squares *p = s->problem;
    int64_t n = s->columns, m = p->rows, entries = n ? p->start[n] : 0, at = 0;
    double *space, **part[18];
    int32_t k, count = 0;
    s->row_start = (int64_t *)gproji_pool_take_zeroed(&s->pool, m + 1, sizeof(int64_t));
    s->row_column = (int32_t *)gproji_pool_take(&s->pool, entries, sizeof(int32_t));
    s->row_value = (double *)gproji_pool_take(&s->pool, entries, sizeof(double));
    s->start = (int64_t *)gproji_pool_take(&s->pool, n + 1, sizeof(int64_t));
    s->variable = (int32_t *)gproji_pool_take(&s->pool, 2 * n, sizeof(int32_t));
    s->state = (unsigned char *)gproji_pool_take(&s->pool, n, 1);
    space = (double *)gproji_pool_take(&s->pool, 11 * n + 14 * n + 2 * m, sizeof(double));
    if (!s->row_start || !s->row_column || !s->row_value || !s->start || !s->variable || !s->state || !space)
        return false;
    part[count++] = &s->lower, part[count++] = &s->upper, part[count++] = &s->diagonal, part[count++] = &s->barrier;
    part[count++] = &s->gradient, part[count++] = &s->x, part[count++] = &s->trial, part[count++] = &s->step;
    part[count++] = &s->best, part[count++] = &s->direction.x, part[count++] = &s->other.x;
    for (k = 0; k < count; ++k, at += n) *part[k] = space + at;
    part[0] = &s->sign, part[1] = &s->slack, part[2] = &s->dual, part[3] = &s->direction.target;
    part[4] = &s->direction.dual, part[5] = &s->other.target, part[6] = &s->other.dual;
    for (k = 0; k < 7; ++k, at += 2 * n) *part[k] = space + at;
    s->misfit = space + at, s->magnitude = space + at + m;
    return true;
}

/* Judges a first candidate, x or 0, moved between the bounds. */
GPROJI_INTERNAL bool gproji_squares_propose(gproji_squares *s, const double *x) {
    int32_t j;
    for (j = 0; j < s->columns; ++j) s->trial[j] = s->x[j] = s->best[j] = gproji_squares_clip(s, j, x ? x[j] : 0);
    s->best_kkt = HUGE_VAL;
    return gproji_squares_judge(s);
}

/* scale, and the start as the first candidate; 0 where the start is worse than that. True: it is a solution. */
GPROJI_INTERNAL bool gproji_squares_begin(gproji_squares *s, const double *x) {
    int32_t j;
    for (j = 0; j < s->columns; ++j) s->trial[j] = gproji_squares_clip(s, j, 0);
    s->scale = gproji_squares_gradient(s, s->trial);
    if (!(s->scale > 0)) s->scale = 1;
    if (gproji_squares_propose(s, x)) return true;
    return s->best_kkt > 1 && gproji_squares_propose(s, NULL);
}

/* The start may know which bounds hold. */
GPROJI_INTERNAL bool gproji_squares_try_start(gproji_squares *s) {
    int32_t j;
    if (s->best_kkt > 1e-3) return false;
    for (j = 0; j < s->columns; ++j) {
        double x = s->trial[j];
        if (s->state[j] == GPROJI_VARIABLE_FIXED || gproji_squares_violation(s, j, x) > 0) continue;
        if (x <= s->lower[j]) s->state[j] = GPROJI_VARIABLE_LOWER;
        if (x >= s->upper[j]) s->state[j] = GPROJI_VARIABLE_UPPER;
    }
    return gproji_squares_polish(s, GPROJI_SQUARES_ROUNDS);
}

/* From the start, in the order of cost: the start itself, its neighbours, the minimum without bounds, the method. */
GPROJI_INTERNAL void gproji_squares_solve(gproji_squares *s, const double *x) {
    if (gproji_squares_begin(s, x) || gproji_squares_try_start(s)) return;
    if (s->code != GPROJ_OK || gproji_squares_free_all(s) == 0) return;
    memcpy(s->trial, s->x, (size_t)s->columns * sizeof(double));
    if (gproji_squares_polish(s, 1) || s->code != GPROJ_OK || s->pairs == 0) return;
    gproji_squares_free_all(s);
    gproji_squares_iterate(s);
}

GPROJI_INTERNAL void gproji_squares_report(gproji_squares *s, gproj_least_squares_result *result) {
    double sum = 0;
    int32_t i, j;
    gproj_cholesky_info info = gproj_cholesky_get_info(s->cholesky);
    gproji_squares_misfit(s, s->best);
    for (i = 0; i < s->problem->rows; ++i) sum += s->misfit[i] * s->misfit[i];
    for (j = 0; j < s->columns; ++j) result->at_bounds += s->best[j] <= s->lower[j] || s->best[j] >= s->upper[j];
    result->outcome = s->best_kkt <= 1e-9 ? GPROJ_LEAST_SQUARES_SOLVED : GPROJ_LEAST_SQUARES_LIMIT;
    result->factorisations = s->factorisations;
    result->residual = sqrt(sum);
    result->kkt = s->best_kkt;
    result->memory = s->heap.account;
    result->factor_bytes = info.factor_bytes;
    result->work_bytes = info.work_bytes;
}

GPROJI_INTERNAL void gproji_squares_run(gproji_squares *s, const gproj_host *host, double *x,
                                        gproj_least_squares_result *result) {
    s->cholesky = gproj_cholesky_create(host);
    if (!s->cholesky || !gproji_squares_take(s)) {
        s->code = gproji_fail_memory(s->error);
        return;
    }
    gproji_squares_set_bounds(s);
    if (s->code == GPROJ_OK && s->columns > 0) gproji_squares_assemble(s);
    if (s->code == GPROJ_OK) gproji_squares_solve(s, x);
    if (s->code != GPROJ_OK) return;
    gproji_squares_report(s, result);
    if (s->columns > 0) memcpy(x, s->best, (size_t)s->columns * sizeof(double));
}

GPROJ_API gproj_code gproj_solve_least_squares(const gproj_least_squares *problem, const gproj_host *host, double *x,
                                               gproj_least_squares_result *result, gproj_error *error) {
    gproj_least_squares_result unused;
    gproji_squares s;
    if (!result) result = &unused;
    memset(result, 0, sizeof *result);
    result->outcome = GPROJ_LEAST_SQUARES_FAILED;
    gproji_error_clear(error);
    memset(&s, 0, sizeof s);
    s.code = gproji_squares_check(problem, x, error);
    if (s.code != GPROJ_OK) return s.code;
    s.problem = problem, s.error = error;
    s.columns = problem->columns;
    s.damping = problem->damping * problem->damping;
    s.proximity = 1e-12;
    s.heap = gproji_heap_of(host);
    gproji_pool_start(&s.pool, &s.heap);
    gproji_squares_run(&s, host, x, result);
    gproj_cholesky_destroy(s.cholesky);
    gproji_pool_give_all(&s.pool);
    return s.code;
}

/* ============================================================================================================
   >>system   Variables, groups of quadratic rows, and the matrix of their normal equations. Uses platform, memory,
   error, parallel, dense, symbolic, cholesky.

   Based on Tang, Sun, Gomes, Wallner, Pottmann: Form-finding with Polyhedral Meshes Made Simple (2014), section 3.

   Rows come in any order and are kept as they were given, group by group. Before a solve they are compiled once:
   - variables are joined to nodes: a block whose variables meet in some row is one node, else each is its own;
   - every row gets its variables ("locals"), belongs to the front of the node that is eliminated first, and knows the
     storage rows of its locals in that front; they are in ascending order of these;
   so that an iteration evaluates rows into local gradients, and each front takes the outer products of its rows when the
   factorisation comes to it, without a search and without an allocation.

   Invariant: `compiled` is true exactly while all compiled arrays agree with the rows; adding a variable, a group or
   a row ends it. Coefficients, constants and weights may change freely. */

enum {
    GPROJI_BLOCK_MAX = 8,        /* variables of a block */
    GPROJI_WIDE_ROW = 512,       /* a row with more variables than this is treated as a global one */
    GPROJI_ROWS_PER_TASK = 2048, /* of the evaluation */
    GPROJI_ROWS_AHEAD = 16       /* see gproji_expect_rows */
};

/* Row r of a group has the terms term[row[r].term .. row[r + 1].term - 1], and likewise for the other starts; the array
   has one more entry than there are rows. */
typedef struct gproji_row {
    int64_t term;
    int64_t local; /* compiled: its variables and its gradient */
    double constant;
    double weight; /* times the group's; 0: the row is left out of everything */
    double phi;    /* the value at the last evaluation */
    int32_t element;
    bool wide;   /* compiled: kept out of the matrix */
    bool active; /* acts on the next step: it has a weight, and is no bound that the step keeps anyway */
} gproji_row;

/* What a row's weight is the product of, in a group whose elements have weights. */
typedef struct gproji_share {
    double own;    /* what the row itself asks for */
    double factor; /* the weight of its element */
} gproji_share;

/* Nearest: y of a row that must hold, and what a step adds to it. */
typedef struct gproji_multiplier {
    double y, rise;
} gproji_multiplier;

typedef struct gproji_group {
    char name[GPROJ_NAME_SIZE];
    gproj_kind kind;
    gproj_place place;
    bool global;
    gproj_schedule schedule;
    gproj_refresh refresh;
    void *refresh_user;
    double weight; /* in the present iteration */
    bool guard;    /* a bound that acts on the steps only: no part of merit, residual and verdict */
    double slack;  /* of the guard: a step may violate its rows by so much */

    int32_t row_count;
    gproji_row *row;
    gproj_term *term;
    gproji_share *share; /* of each row; NULL: all factors are 1 */
    size_t row_capacity, term_capacity, share_capacity;

    bool placed;             /* i and j of its terms are not variables but places among the locals of their row */
    int32_t *local_variable; /* of every row, one row after the other */
    int32_t *local_at;       /* the storage rows of a narrow row's locals in its front, ascending */
    double *local_gradient;  /* at the last evaluation */
    size_t local_count;
    gproji_multiplier *multiplier; /* of each row; NULL before a solve for the nearest point */
} gproji_group;

typedef struct gproji_row_name {
    int32_t group, row;
} gproji_row_name;

/* Nearest: is x no good, seen from s->saved? */
typedef bool (*gproji_refuse_step)(void *user, const gproj_system *system);

/* A bound's row along a step: w^2 min(0, phi + t h + t^2 q)^2 is its part of the merit. */
typedef struct gproji_hinge {
    double w2, phi, h, q;
} gproji_hinge;

struct gproj_system {
    gproji_heap own;
    gproj_error error;
    gproj_host host;
    gproj_cholesky *cholesky;

    int32_t variable_count;
    int32_t default_last; /* in this solve: the last iteration of wishes whose schedule names none; 0: for ever */
    int32_t late;         /* iterations since the wishes have faded, or since half of all; refreshes may settle then */
    bool sliding;         /* nearest: away from the start, where faces may become small */
    gproji_refuse_step refuse_step; /* NULL: none is refused */
    void *refuse_user;
    double rounding; /* what rounding in the value of a row may be; 0: as little as can be */
    double *x;
    int32_t *block; /* of each variable, the first variable of its block */
    size_t x_capacity, block_capacity;

    gproji_group *group;
    int32_t group_count;
    size_t group_capacity;

    bool changed; /* a row got other numbers, or a group another schedule, since the last evaluation */
    bool solving; /* a solve is under way: refreshes and callbacks may change numbers, but add nothing */
    bool compiled;
    int32_t compiled_variables; /* the size of the arrays below */
    int32_t node_count, wide_count;
    int32_t *node;              /* of each variable */
    int32_t *node_first;        /* first variable of each node, and the end: node_count + 1 (taken: variables + 1) */
    int64_t *front_start;       /* the rows of front f are front_row[front_start[f] .. front_start[f + 1] - 1] */
    gproji_row_name *front_row; /* all narrow rows */
    size_t front_count, front_row_count, front_row_room;
    double *gradient;    /* sum w^2 phi grad phi; the right-hand side is its negative */
    double *step;        /* dx: the first column of `sides` */
    double *saved;       /* x before the step */
    double *sum;         /* nearest: of the steps of a slide; NULL before */
    double *residual;    /* with wide rows: work of refinement */
    double *balance;     /* the same */
    double *sides;       /* 1 + wide_count columns: the right-hand sides -gradient and U of a step, then it and Y */
    double *wide_matrix; /* wide_count x wide_count: I + Y'Y and its Cholesky factor */
    double *wide_vector; /* wide_count */
    size_t wide_taken;   /* wide_count when the three were taken */
    gproji_hinge *hinge; /* the bounds' rows that a step may violate */
    size_t hinge_taken;  /* as many as all bounds have rows */
};

/* -- life and building -- */

GPROJ_API gproj_system *gproj_system_create(const gproj_host *host) {
    gproj_system *s = (gproj_system *)gproji_create_object(host, sizeof(gproj_system));
    if (!s) return NULL;
    gproji_error_clear(&s->error);
    if (host) s->host = *host;
    s->cholesky = gproj_cholesky_create(host);
    if (!s->cholesky) {
        gproji_destroy_object(s, sizeof *s);
        return NULL;
    }
    return s;
}

/* Lets a group's terms name variables again. */
GPROJI_INTERNAL void gproji_unplace_terms(gproji_group *g) {
    int32_t r;
    int64_t t;
    for (r = 0; r < g->row_count; ++r)
        for (t = g->row[r].term; t < g->row[r + 1].term; ++t) {
            const int32_t *variable = g->local_variable + g->row[r].local;
            g->term[t].i = variable[g->term[t].i];
            if (g->term[t].j >= 0) g->term[t].j = variable[g->term[t].j];
        }
    g->placed = false;
}

/* Gives back what compilation made of a group. */
GPROJI_INTERNAL void gproji_group_forget(gproji_heap *heap, gproji_group *g) {
    if (g->placed) gproji_unplace_terms(g);
    gproji_give(heap, g->local_variable, g->local_count, sizeof *g->local_variable);
    gproji_give(heap, g->local_gradient, g->local_count, sizeof *g->local_gradient);
    gproji_give(heap, g->local_at, g->local_count, sizeof *g->local_at);
    gproji_give(heap, g->multiplier, (size_t)g->row_count, sizeof *g->multiplier);
    g->local_variable = NULL;
    g->local_gradient = NULL;
    g->local_at = NULL;
    g->multiplier = NULL;
}

/* Ends the compiled state and gives its memory back. */
GPROJI_INTERNAL void gproji_system_forget(gproj_system *s) {
    size_t n = (size_t)s->compiled_variables;
    int32_t i;
    for (i = 0; i < s->group_count; ++i) gproji_group_forget(&s->own, &s->group[i]);
    gproji_give(&s->own, s->node, n, sizeof *s->node);
    gproji_give(&s->own, s->node_first, n + 1, sizeof *s->node_first);
    gproji_give(&s->own, s->front_start, s->front_count + 2, sizeof *s->front_start);
    gproji_give(&s->own, s->front_row, s->front_row_room, sizeof *s->front_row);
    gproji_give(&s->own, s->gradient, n, sizeof *s->gradient);
    gproji_give(&s->own, s->saved, n, sizeof *s->saved);
    gproji_give(&s->own, s->sum, n, sizeof *s->sum);
    gproji_give(&s->own, s->residual, n, sizeof *s->residual);
    gproji_give(&s->own, s->balance, n, sizeof *s->balance);
    gproji_give(&s->own, s->sides, (s->wide_taken + 1) * n, sizeof *s->sides);
    gproji_give(&s->own, s->wide_matrix, s->wide_taken * s->wide_taken, sizeof *s->wide_matrix);
    gproji_give(&s->own, s->wide_vector, s->wide_taken, sizeof *s->wide_vector);
    gproji_give(&s->own, s->hinge, s->hinge_taken, sizeof *s->hinge);
    s->node = s->node_first = NULL;
    s->front_start = NULL;
    s->front_row = NULL;
    s->gradient = s->step = s->saved = s->sum = s->residual = s->balance = NULL;
    s->sides = s->wide_matrix = s->wide_vector = NULL;
    s->hinge = NULL;
    s->wide_taken = s->hinge_taken = 0;
    s->compiled = false;
}

GPROJ_API void gproj_system_destroy(gproj_system *s) {
    int32_t i;
    if (!s) return;
    for (i = 0; i < s->group_count; ++i) s->group[i].placed = false; /* nobody reads its terms any more */
    gproji_system_forget(s);
    for (i = 0; i < s->group_count; ++i) {
        gproji_give(&s->own, s->group[i].row, s->group[i].row_capacity, sizeof *s->group[i].row);
        gproji_give(&s->own, s->group[i].share, s->group[i].share_capacity, sizeof *s->group[i].share);
        gproji_give(&s->own, s->group[i].term, s->group[i].term_capacity, sizeof *s->group[i].term);
    }
    gproji_give(&s->own, s->group, s->group_capacity, sizeof *s->group);
    gproji_give(&s->own, s->x, s->x_capacity, sizeof *s->x);
    gproji_give(&s->own, s->block, s->block_capacity, sizeof *s->block);
    gproj_cholesky_destroy(s->cholesky);
    gproji_destroy_object(s, sizeof *s);
}

/* The error that stands for an object which could not be made. */
GPROJI_INTERNAL const gproj_error *gproji_no_object(void) {
    static const gproj_error error = {GPROJ_ERROR_MEMORY, GPROJ_PLACE_NONE, -1,
                                      "there is no object: creating it failed"};
    return &error;
}

GPROJ_API const gproj_error *gproj_system_error(const gproj_system *s) { return s ? &s->error : gproji_no_object(); }

GPROJI_INTERNAL bool gproji_system_ready(const gproj_system *s) { return s && s->error.code == GPROJ_OK; }

/* May the caller add something, or start a solve? */
GPROJI_INTERNAL bool gproji_system_is_open(gproj_system *s) {
    if (!gproji_system_ready(s)) return false;
    if (!s->solving) return true;
    gproji_fail(&s->error, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1,
                "during a solve nothing can be added or started: add groups before it, with weight 0");
    return false;
}

GPROJ_API gproj_memory gproj_system_memory(const gproj_system *s) {
    gproj_memory sum;
    memset(&sum, 0, sizeof sum);
    if (!s) return sum;
    gproji_add_memory(&sum, s->own.account);
    gproji_add_memory(&sum, gproj_cholesky_memory(s->cholesky));
    return sum;
}

/* Makes room for so many more variables. */
GPROJI_INTERNAL bool gproji_reserve_variables(gproj_system *s, size_t count) {
    size_t wanted = (size_t)s->variable_count + count;
    void *x = s->x, *block = s->block;
    bool enough = gproji_reserve(&s->own, &x, &s->x_capacity, wanted, sizeof *s->x);
    s->x = (double *)x;
    enough = enough && gproji_reserve(&s->own, &block, &s->block_capacity, wanted, sizeof *s->block);
    s->block = (int32_t *)block;
    return enough;
}

GPROJ_API int32_t gproj_system_add_variables(gproj_system *s, int32_t count, int32_t block, const double *values) {
    int32_t first, i;
    if (!gproji_system_is_open(s)) return -1;
    if (block < 1 || block > GPROJI_BLOCK_MAX || count < 0 || count % block != 0) {
        gproji_fail(&s->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "%d variables in blocks of %d: blocks have 1 to 8 variables and the count is a multiple", count,
                    block);
        return -1;
    }
    if (count > INT32_MAX / 2 - s->variable_count) {
        gproji_fail(&s->error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "more variables than 32-bit numbers can count");
        return -1;
    }
    for (i = 0; values && i < count; ++i) {
        if (gproji_is_finite(values[i])) continue;
        gproji_fail(&s->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VARIABLE, s->variable_count + i,
                    "the start value of variable %d is not a finite number", s->variable_count + i);
        return -1;
    }
    first = s->variable_count;
    if (!gproji_reserve_variables(s, (size_t)count)) {
        gproji_fail_memory(&s->error);
        return -1;
    }
    for (i = 0; i < count; ++i) {
        s->x[first + i] = values ? values[i] : 0.0;
        s->block[first + i] = first + i - i % block;
    }
    gproji_system_forget(s);
    s->variable_count += count;
    return first;
}

GPROJ_API int32_t gproj_system_variable_count(const gproj_system *s) { return s ? s->variable_count : 0; }
GPROJ_API double *gproj_system_values(gproj_system *s) { return s ? s->x : NULL; }
GPROJ_API int32_t gproj_system_group_count(const gproj_system *s) { return s ? s->group_count : 0; }

GPROJI_INTERNAL bool gproji_schedule_is_valid(gproj_schedule schedule) {
    return schedule.weight >= 0 && schedule.weight <= 1e50 && schedule.decay >= 0 && schedule.decay <= 1 &&
           schedule.last >= 0;
}

GPROJI_INTERNAL gproj_code gproji_fail_schedule(gproj_system *s, const char *name, gproj_schedule schedule) {
    return gproji_fail(&s->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                       "the schedule of group '%s' (weight %g, decay %g, last %d) needs 0 <= weight <= 1e50, 0 <= "
                       "decay <= 1, last >= 0",
                       name, schedule.weight, schedule.decay, schedule.last);
}

GPROJ_API int32_t gproj_system_add_group(gproj_system *s, const gproj_group *group) {
    gproji_group *g;
    void *groups;
    size_t length;
    bool enough;
    if (!gproji_system_is_open(s)) return -1;
    if (!group || !group->name) {
        gproji_fail(&s->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_GROUP, s->group_count, "a group needs a name");
        return -1;
    }
    if (!gproji_schedule_is_valid(group->schedule)) {
        gproji_fail_schedule(s, group->name, group->schedule);
        return -1;
    }
    groups = s->group;
    enough = gproji_reserve(&s->own, &groups, &s->group_capacity, (size_t)s->group_count + 1, sizeof *s->group);
    s->group = (gproji_group *)groups;
    if (!enough) {
        gproji_fail_memory(&s->error);
        return -1;
    }
    g = &s->group[s->group_count];
    memset(g, 0, sizeof *g);
    {
        void *rows = NULL;
        if (!gproji_reserve(&s->own, &rows, &g->row_capacity, 1, sizeof *g->row)) {
            gproji_fail_memory(&s->error);
            return -1;
        }
        g->row = (gproji_row *)rows;
        memset(&g->row[0], 0, sizeof g->row[0]);
    }
    length = strlen(group->name);
    if (length >= GPROJ_NAME_SIZE) length = GPROJ_NAME_SIZE - 1;
    memcpy(g->name, group->name, length);
    g->kind = group->kind;
    g->place = group->place;
    g->global = group->global;
    g->schedule = group->schedule;
    g->refresh = group->refresh;
    g->refresh_user = group->refresh_user;
    gproji_system_forget(s);
    return s->group_count++;
}

GPROJI_INTERNAL bool gproji_system_has_group(const gproj_system *s, int32_t group) {
    return s && group >= 0 && group < s->group_count;
}

/* What counts of phi: of a bound its violation, else all. What is no number stays none. */
GPROJI_INLINE double gproji_counted(const gproji_group *g, double phi) {
    return g->kind == GPROJ_BOUND && phi >= 0 ? 0 : phi;
}

GPROJ_API gproj_group_info gproj_system_group_info(const gproj_system *s, int32_t group) {
    gproj_group_info info;
    const gproji_group *g;
    double sum = 0;
    int32_t r;
    memset(&info, 0, sizeof info);
    info.worst_row = info.worst_element = -1;
    if (!gproji_system_has_group(s, group)) return info;
    g = &s->group[group];
    memcpy(info.name, g->name, sizeof info.name);
    info.kind = g->kind;
    info.place = g->place;
    info.schedule = g->schedule;
    info.rows = g->row_count;
    for (r = 0; r < g->row_count; ++r) {
        double phi = fabs(gproji_counted(g, g->row[r].phi));
        if (!(phi <= DBL_MAX)) phi = HUGE_VAL;
        sum += phi * phi;
        if (info.worst_row >= 0 && !(phi > info.max)) continue;
        info.max = phi;
        info.worst_row = r;
        info.worst_element = g->row[r].element;
    }
    if (g->row_count) info.rms = sqrt(sum / g->row_count);
    return info;
}

GPROJ_API gproj_code gproj_system_set_schedule(gproj_system *s, int32_t group, gproj_schedule schedule) {
    if (!s) return GPROJ_ERROR_ARGUMENT;
    if (s->error.code) return s->error.code;
    if (!gproji_system_has_group(s, group))
        return gproji_fail(&s->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_GROUP, group, "there is no group %d", group);
    if (!gproji_schedule_is_valid(schedule)) return gproji_fail_schedule(s, s->group[group].name, schedule);
    s->group[group].schedule = schedule;
    s->changed = true;
    return GPROJ_OK;
}

/* Refuses terms that are no terms of this system. */
GPROJI_INTERNAL bool gproji_terms_are_valid(gproj_system *s, const gproji_group *g, int32_t count,
                                            const gproj_term *terms, double constant) {
    int32_t t;
    bool finite = gproji_is_finite(constant);
    for (t = 0; t < count; ++t) {
        if (terms[t].i < 0 || terms[t].i >= s->variable_count || terms[t].j < -1 || terms[t].j >= s->variable_count) {
            gproji_fail(&s->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_ROW, g->row_count,
                        "row %d of group '%s', term %d: there is no variable %d or %d", g->row_count, g->name, t,
                        terms[t].i, terms[t].j);
            return false;
        }
        finite = finite && gproji_is_finite(terms[t].a);
    }
    if (!finite)
        gproji_fail(&s->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_ROW, g->row_count,
                    "row %d of group '%s' has a coefficient that is not a finite number", g->row_count, g->name);
    return finite;
}

/* Makes room for so many more rows and terms. */
GPROJI_INTERNAL bool gproji_reserve_rows(gproj_system *s, gproji_group *g, size_t rows, size_t terms) {
    size_t wanted = (size_t)g->row_count + rows + 1; /* with the one that ends them */
    void *row = g->row, *term = g->term, *share = g->share;
    bool enough = gproji_reserve(&s->own, &row, &g->row_capacity, wanted, sizeof *g->row);
    g->row = (gproji_row *)row;
    enough = enough && gproji_reserve(&s->own, &term, &g->term_capacity, (size_t)g->row[g->row_count].term + terms,
                                      sizeof *g->term);
    g->term = (gproj_term *)term;
    enough = enough && (!share || gproji_reserve(&s->own, &share, &g->share_capacity, wanted, sizeof *g->share));
    g->share = (gproji_share *)share;
    return enough;
}

GPROJ_API int32_t gproj_system_add_row(gproj_system *s, int32_t group, int32_t count, const gproj_term *terms,
                                       double constant, int32_t element) {
    gproji_group *g;
    gproji_row *row;
    if (!gproji_system_is_open(s)) return -1;
    if (!gproji_system_has_group(s, group) || count < 0) {
        gproji_fail(&s->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_GROUP, group,
                    "a row of %d terms for group %d of %d groups", count, group, s->group_count);
        return -1;
    }
    g = &s->group[group];
    if (!gproji_terms_are_valid(s, g, count, terms, constant)) return -1;
    if (g->row_count == INT32_MAX - 1) {
        gproji_fail(&s->error, GPROJ_ERROR_SIZE, GPROJ_PLACE_GROUP, group, "group '%s' has too many rows", g->name);
        return -1;
    }
    if (s->compiled) gproji_system_forget(s);
    if (!gproji_reserve_rows(s, g, 1, (size_t)count)) {
        gproji_fail_memory(&s->error);
        return -1;
    }
    row = &g->row[g->row_count];
    row->constant = constant;
    row->weight = 1;
    row->element = element;
    if (g->share) g->share[g->row_count].own = g->share[g->row_count].factor = 1;
    if (count) memcpy(g->term + row->term, terms, (size_t)count * sizeof *terms);
    memset(row + 1, 0, sizeof row[1]);
    row[1].term = row->term + count;
    return g->row_count++;
}

GPROJI_INTERNAL bool gproji_system_has_row(const gproj_system *s, int32_t group, int32_t row) {
    return gproji_system_has_group(s, group) && row >= 0 && row < s->group[group].row_count;
}

GPROJ_API gproj_code gproj_system_set_row(gproj_system *s, int32_t group, int32_t row, const double *coefficients,
                                          double constant) {
    gproji_group *g;
    int64_t t, count;
    bool finite;
    if (!s) return GPROJ_ERROR_ARGUMENT;
    if (s->error.code) return s->error.code;
    if (!gproji_system_has_row(s, group, row))
        return gproji_fail(&s->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_ROW, row, "there is no row %d in group %d", row,
                           group);
    g = &s->group[group];
    count = g->row[row + 1].term - g->row[row].term;
    finite = gproji_is_finite(constant);
    for (t = 0; coefficients && t < count; ++t) finite = finite && gproji_is_finite(coefficients[t]);
    if (!finite)
        return gproji_fail(&s->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_ROW, row,
                           "row %d of group '%s' was given a coefficient that is not a finite number", row, g->name);
    for (t = 0; coefficients && t < count; ++t) g->term[g->row[row].term + t].a = coefficients[t];
    g->row[row].constant = constant;
    s->changed = true;
    return GPROJ_OK;
}

GPROJ_API gproj_code gproj_system_set_row_weight(gproj_system *s, int32_t group, int32_t row, double weight) {
    gproji_group *g;
    if (!s) return GPROJ_ERROR_ARGUMENT;
    if (s->error.code) return s->error.code;
    if (!gproji_system_has_row(s, group, row) || !(weight >= 0 && weight <= 1e50))
        return gproji_fail(&s->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_ROW, row,
                           "weight %g for row %d of group %d: there is no such row, or the weight is not in 0..1e50",
                           weight, row, group);
    g = &s->group[group];
    g->row[row].weight = weight;
    if (g->share) {
        g->share[row].own = weight;
        g->row[row].weight *= g->share[row].factor;
    }
    s->changed = true;
    return GPROJ_OK;
}

/* The weight of a row, without that of its element. */
GPROJI_INLINE double gproji_own_weight(const gproji_group *g, int32_t row) {
    return g->share ? g->share[row].own : g->row[row].weight;
}

/* Lets the group's elements have weights: all 1. */
GPROJI_INTERNAL bool gproji_share_weights(gproj_system *s, gproji_group *g) {
    int32_t r;
    if (g->share) return true;
    g->share = (gproji_share *)gproji_take(&s->own, g->row_capacity, sizeof *g->share);
    if (!g->share) return false;
    g->share_capacity = g->row_capacity;
    for (r = 0; r < g->row_count; ++r) g->share[r].own = g->row[r].weight, g->share[r].factor = 1;
    return true;
}

/* The variable that i or j of a row's term stands for; -1 for a j that is -1. */
GPROJI_INLINE int32_t gproji_variable_of(const gproji_group *g, const gproji_row *row, int32_t i) {
    return g->placed && i >= 0 ? g->local_variable[row->local + i] : i;
}

/* phi at x. variable: the variables that the terms' i and j stand for; NULL: i and j themselves. */
GPROJI_INLINED double gproji_terms_value(const gproji_group *g, const gproji_row *row, const double *x,
                                         const int32_t *variable) {
    const gproj_term *term = g->term + row->term, *end = g->term + row[1].term;
    double phi = row->constant;
    for (; term < end; ++term) {
        double value = term->a * x[variable ? variable[term->i] : term->i];
        phi += term->j < 0 ? value : value * x[variable ? variable[term->j] : term->j];
    }
    return phi;
}

/* phi at x, whether compiled or not. */
GPROJI_INTERNAL double gproji_row_value(const gproji_group *g, int32_t r, const double *x) {
    const gproji_row *row = &g->row[r];
    return g->placed ? gproji_terms_value(g, row, x, g->local_variable + row->local)
                     : gproji_terms_value(g, row, x, NULL);
}

/* gradient += grad phi at x, whether compiled or not. */
GPROJI_INTERNAL void gproji_row_gradient(const gproji_group *g, int32_t r, const double *x, double *gradient) {
    const gproji_row *row = &g->row[r];
    int64_t t;
    for (t = row->term; t < row[1].term; ++t) {
        double a = g->term[t].a;
        int32_t i = gproji_variable_of(g, row, g->term[t].i), j = gproji_variable_of(g, row, g->term[t].j);
        gradient[i] += j < 0 ? a : a * x[j];
        if (j >= 0) gradient[j] += a * x[i];
    }
}

GPROJ_API double gproj_system_row_value(const gproj_system *s, int32_t group, int32_t row, double *gradient) {
    if (!gproji_system_has_row(s, group, row)) return 0;
    if (gradient) {
        memset(gradient, 0, (size_t)s->variable_count * sizeof *gradient);
        gproji_row_gradient(&s->group[group], row, s->x, gradient);
    }
    return gproji_row_value(&s->group[group], row, s->x);
}

/* -- compilation -- */

/* Marks on a variable: the row that named it last; and, on the first of a block, the row that met the block last. */
typedef struct gproji_named {
    int32_t row, block;
} gproji_named;

/* Appends a variable to the `count` locals of row r, unless the row has named it already. */
GPROJI_INLINE int32_t gproji_name_local(gproji_named *named, int32_t r, int32_t variable, int32_t *local,
                                        int32_t count) {
    if (named[variable].row == r) return count;
    named[variable].row = r;
    local[count] = variable;
    return count + 1;
}

/* The variables of a row, in the order in which its terms name them; returns how many they are. */
GPROJI_INTERNAL int32_t gproji_name_locals(const gproji_group *g, int32_t r, gproji_named *named, int32_t *local) {
    int32_t count = 0;
    int64_t t;
    for (t = g->row[r].term; t < g->row[r + 1].term; ++t) {
        count = gproji_name_local(named, r, g->term[t].i, local, count);
        if (g->term[t].j >= 0) count = gproji_name_local(named, r, g->term[t].j, local, count);
    }
    return count;
}

/* Notes the blocks of which a narrow row has more than one variable: coupled[first of block]. */
GPROJI_INTERNAL void gproji_couple_blocks(const gproj_system *s, int32_t r, gproji_named *named, int32_t count,
                                          const int32_t *local, int32_t *coupled) {
    int32_t i;
    for (i = 0; i < count; ++i) {
        int32_t block = s->block[local[i]];
        if (named[block].block == r) coupled[block] = 1;
        named[block].block = r;
    }
}

/* Step 1: the variables of all rows; which rows are wide; which blocks are coupled, for which `node` serves as marks. */
GPROJI_INTERNAL bool gproji_compile_locals(gproj_system *s, gproji_group *g, gproji_named *named) {
    size_t most = 2 * (size_t)g->row[g->row_count].term;
    int64_t filled = 0;
    int32_t r, v, count;
    void *trimmed;
    g->local_variable = (int32_t *)gproji_take(&s->own, most, sizeof *g->local_variable);
    g->local_count = most;
    if (!g->local_variable) return false;
    for (v = 0; v < s->variable_count; ++v) named[v].row = named[v].block = -1;
    for (r = 0; r < g->row_count; ++r) {
        gproji_row *row = &g->row[r];
        row->local = filled;
        count = gproji_name_locals(g, r, named, g->local_variable + filled);
        row->wide = g->global || count > GPROJI_WIDE_ROW;
        s->wide_count += row->wide;
        if (!row->wide) gproji_couple_blocks(s, r, named, count, g->local_variable + filled, s->node);
        filled += count;
    }
    g->row[g->row_count].local = filled;
    trimmed = gproji_retake(&s->own, g->local_variable, most, (size_t)filled, sizeof *g->local_variable);
    if (!trimmed) return false;
    g->local_variable = (int32_t *)trimmed;
    g->local_count = (size_t)filled;
    return true;
}

/* Step 2: joins the variables of coupled blocks to nodes. `node` has the marks of step 1. */
GPROJI_INTERNAL void gproji_compile_nodes(gproj_system *s) {
    const int32_t *coupled = s->node;
    int32_t i, v;
    s->node_count = 0;
    for (v = 0; v < s->variable_count; ++v)
        if (v == s->block[v] || !coupled[s->block[v]]) s->node_first[s->node_count++] = v;
    s->node_first[s->node_count] = s->variable_count;
    for (i = 0; i < s->node_count; ++i)
        for (v = s->node_first[i]; v < s->node_first[i + 1]; ++v) s->node[v] = i;
}

/* The nodes that meet in narrow rows, and the rows of each node: the incidence that gives the graph. */
typedef struct gproji_incidence {
    int32_t node_count;
    int64_t row_count;
    size_t row_room, entry_room, node_entry_room;
    int64_t *row_start;  /* row_count + 1 */
    int32_t *row_node;   /* nodes of each row */
    int64_t *node_start; /* node_count + 1 */
    int64_t *node_row;   /* rows of each node */
} gproji_incidence;

GPROJI_INTERNAL void gproji_incidence_give(gproji_heap *heap, gproji_incidence *in) {
    gproji_give(heap, in->row_start, in->row_room, sizeof *in->row_start);
    gproji_give(heap, in->row_node, in->entry_room, sizeof *in->row_node);
    gproji_give(heap, in->node_start, (size_t)in->node_count + 1, sizeof *in->node_start);
    gproji_give(heap, in->node_row, in->node_entry_room, sizeof *in->node_row);
}

/* The nodes of each row, without rows that join nothing: those of one node, or with the nodes of the row before.
   mark: node_count entries. */
GPROJI_INTERNAL void gproji_incidence_scan(const gproj_system *s, gproji_incidence *in, int64_t *mark) {
    int32_t i, r, v;
    int64_t l, entries = 0, before = 0; /* where the nodes of the row before begin */
    for (v = 0; v < s->node_count; ++v) mark[v] = -1;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; r < g->row_count; ++r) {
            int64_t begin = entries;
            if (g->row[r].wide) continue;
            for (l = g->row[r].local; l < g->row[r + 1].local; ++l) {
                int32_t node = s->node[g->local_variable[l]];
                if (mark[node] == begin) continue;
                mark[node] = begin;
                in->row_node[entries++] = node;
            }
            if (entries - begin < 2 ||
                (entries - begin == begin - before && memcmp(in->row_node + begin, in->row_node + before,
                                                             (size_t)(entries - begin) * sizeof(int32_t)) == 0)) {
                for (l = begin; l < entries; ++l) mark[in->row_node[l]] = -1;
                entries = begin;
                continue;
            }
            in->row_start[in->row_count++] = before = begin;
        }
    }
    in->row_start[in->row_count] = entries;
}

GPROJI_INTERNAL bool gproji_incidence_take(gproj_system *s, gproji_incidence *in, int64_t *mark) {
    int64_t r, e;
    int32_t v, i;
    in->node_count = s->node_count;
    in->row_room = 1;
    for (i = 0; i < s->group_count; ++i) {
        in->row_room += (size_t)s->group[i].row_count;
        in->entry_room += s->group[i].local_count;
    }
    in->row_start = (int64_t *)gproji_take(&s->own, in->row_room, sizeof *in->row_start);
    in->row_node = (int32_t *)gproji_take(&s->own, in->entry_room, sizeof *in->row_node);
    in->node_start = (int64_t *)gproji_take_zeroed(&s->own, (size_t)in->node_count + 1, sizeof *in->node_start);
    if (!in->row_start || !in->row_node || !in->node_start) return false;
    gproji_incidence_scan(s, in, mark);
    in->node_entry_room = (size_t)in->row_start[in->row_count];
    in->node_row = (int64_t *)gproji_take(&s->own, in->node_entry_room, sizeof *in->node_row);
    if (!in->node_row) return false;
    /* transpose: count, sum up, fill backwards */
    for (e = 0; e < in->row_start[in->row_count]; ++e) in->node_start[in->row_node[e]]++;
    for (v = 1; v <= in->node_count; ++v) in->node_start[v] += in->node_start[v - 1];
    for (r = in->row_count - 1; r >= 0; --r)
        for (e = in->row_start[r]; e < in->row_start[r + 1]; ++e) in->node_row[--in->node_start[in->row_node[e]]] = r;
    return true;
}

/* The graph of the nodes: two are adjacent when they meet in a narrow row. */
typedef struct gproji_meetings {
    int64_t *start;    /* node_count + 1 */
    int32_t *adjacent; /* of all nodes */
    int32_t *size;     /* variables of each node */
    size_t room;       /* of `adjacent` */
} gproji_meetings;

/* The graph from the incidence. mark: node_count entries. */
GPROJI_INTERNAL bool gproji_find_meetings(gproj_system *s, const gproji_incidence *in, int64_t *mark,
                                          gproji_meetings *graph) {
    int64_t filled = 0, e, f;
    int32_t v;
    for (v = 0; v < s->node_count; ++v) mark[v] = -1;
    for (v = 0; v < s->node_count; ++v) {
        size_t most = (size_t)filled; /* with all of the node's rows, as if they had nothing in common */
        void *room = graph->adjacent;
        bool enough;
        for (e = in->node_start[v]; e < in->node_start[v + 1]; ++e)
            most += (size_t)(in->row_start[in->node_row[e] + 1] - in->row_start[in->node_row[e]]);
        enough = gproji_reserve(&s->own, &room, &graph->room, most, sizeof *graph->adjacent);
        graph->adjacent = (int32_t *)room;
        if (!enough) return false;
        graph->start[v] = filled;
        graph->size[v] = s->node_first[v + 1] - s->node_first[v];
        mark[v] = v;
        for (e = in->node_start[v]; e < in->node_start[v + 1]; ++e)
            for (f = in->row_start[in->node_row[e]]; f < in->row_start[in->node_row[e] + 1]; ++f) {
                int32_t other = in->row_node[f];
                if (mark[other] == v) continue;
                mark[other] = v;
                graph->adjacent[filled++] = other;
            }
    }
    graph->start[s->node_count] = filled;
    return true;
}

/* Step 3: the graph of the nodes. */
GPROJI_INTERNAL bool gproji_compile_graph(gproj_system *s, gproji_meetings *graph) {
    gproji_incidence in;
    size_t nodes = (size_t)s->node_count;
    int64_t *mark = (int64_t *)gproji_take(&s->own, nodes, sizeof *mark);
    bool done;
    memset(&in, 0, sizeof in);
    graph->start = (int64_t *)gproji_take(&s->own, nodes + 1, sizeof *graph->start);
    graph->size = (int32_t *)gproji_take(&s->own, nodes, sizeof *graph->size);
    done = mark && graph->start && graph->size && gproji_incidence_take(s, &in, mark) &&
           gproji_find_meetings(s, &in, mark, graph);
    gproji_incidence_give(&s->own, &in);
    gproji_give(&s->own, mark, nodes, sizeof *mark);
    return done;
}

/* Step 4: its analysis for the factorisation. */
GPROJI_INTERNAL gproj_code gproji_compile_analysis(gproj_system *s) {
    gproj_code code = GPROJ_ERROR_MEMORY;
    gproji_meetings graph;
    size_t nodes = (size_t)s->node_count;
    memset(&graph, 0, sizeof graph);
    if (gproji_compile_graph(s, &graph))
        code =
            gproji_cholesky_analyse_blocks(s->cholesky, s->node_count, graph.size, graph.start, graph.adjacent, NULL);
    gproji_give(&s->own, graph.start, nodes + 1, sizeof *graph.start);
    gproji_give(&s->own, graph.size, nodes, sizeof *graph.size);
    gproji_give(&s->own, graph.adjacent, graph.room, sizeof *graph.adjacent);
    return code;
}

/* A front's rows come from all over the memory: asks for those that follow the k-th, with their variables or with their
   gradients. */
GPROJI_INLINED void gproji_expect_rows(const gproj_system *s, int64_t k, bool placing) {
    if (k + GPROJI_ROWS_AHEAD < (int64_t)s->front_row_count) {
        gproji_row_name far_one = s->front_row[k + GPROJI_ROWS_AHEAD];
        gproji_row_name near_one = s->front_row[k + GPROJI_ROWS_AHEAD / 2];
        const gproji_group *g = &s->group[near_one.group];
        const gproji_row *row = &s->group[far_one.group].row[far_one.row], *next = &g->row[near_one.row];
        GPROJI_PREFETCH(row);
        GPROJI_PREFETCH(row + 1);
        GPROJI_PREFETCH(g->local_at + next->local);
        GPROJI_PREFETCH(placing ? (const void *)(g->local_variable + next->local) : g->local_gradient + next->local);
        if (!placing) GPROJI_PREFETCH(g->local_gradient + next->local + 8);
    }
}

/* Step 5: all that the fronts need. */

/* What the places of all rows are found with. */
typedef struct gproji_placing {
    int32_t *column; /* of each variable, its column of L */
    int32_t
        *where; /* of each variable of a row, its place among the locals; of each node, its storage row in a front */
    int32_t *front; /* of all rows, group by group, the front; -1: none */
    size_t rows;
} gproji_placing;

/* Sorts a narrow row's variables by their columns. By insertion: rows are short, and their terms name the variables of a
   node in order. */
GPROJI_INTERNAL void gproji_sort_locals(const int32_t *column, int32_t count, int32_t *local) {
    int32_t key[GPROJI_WIDE_ROW], i, j;
    for (i = 0; i < count; ++i) {
        int32_t variable = local[i], own = column[variable];
        for (j = i; j > 0 && key[j - 1] > own; --j) key[j] = key[j - 1], local[j] = local[j - 1];
        key[j] = own;
        local[j] = variable;
    }
}

/* Lets the terms of a row name places among its locals. */
GPROJI_INTERNAL void gproji_place_terms(gproji_group *g, const gproji_row *row, int32_t *where) {
    const int32_t *local = g->local_variable + row->local;
    int32_t count = (int32_t)(row[1].local - row->local), i;
    int64_t t;
    for (i = 0; i < count; ++i) where[local[i]] = i;
    for (t = row->term; t < row[1].term; ++t) {
        g->term[t].i = where[g->term[t].i];
        if (g->term[t].j >= 0) g->term[t].j = where[g->term[t].j];
    }
}

/* Gives the locals of a group's rows their order. front: of each row, the front of the variable that is eliminated
   first; -1 where there is none. */
GPROJI_INTERNAL void gproji_place_group(gproj_system *s, gproji_group *g, const gproji_placing *placing,
                                        int32_t *front) {
    const gproji_symbolic *sy = &s->cholesky->symbolic;
    int32_t r;
    for (r = 0; r < g->row_count; ++r) {
        const gproji_row *row = &g->row[r];
        int32_t *local = g->local_variable + row->local;
        int32_t count = (int32_t)(row[1].local - row->local);
        if (!row->wide) gproji_sort_locals(placing->column, count, local);
        front[r] = row->wide || count == 0 ? -1 : sy->front_of[sy->place[s->node[local[0]]]];
        gproji_place_terms(g, row, placing->where);
    }
    g->placed = true;
}

/* Sorts the narrow rows by their fronts: front_start has been cleared. */
GPROJI_INTERNAL void gproji_sort_rows(gproj_system *s, const int32_t *front) {
    int64_t *start = s->front_start, row = 0;
    int32_t i, r, f;
    for (i = 0; i < s->group_count; ++i)
        for (r = 0; r < s->group[i].row_count; ++r, ++row)
            if (front[row] >= 0) start[front[row] + 2]++;
    for (f = 0; f < (int32_t)s->front_count; ++f) start[f + 2] += start[f + 1];
    for (row = 0, i = 0; i < s->group_count; ++i)
        for (r = 0; r < s->group[i].row_count; ++r, ++row) {
            if (front[row] < 0) continue;
            s->front_row[start[front[row] + 1]].group = i;
            s->front_row[start[front[row] + 1]++].row = r;
        }
    s->front_row_count = (size_t)start[s->front_count];
}

/* The storage rows of all narrow rows' locals, front by front. at: work, of each variable. */
GPROJI_INTERNAL void gproji_place_locals(gproj_system *s, int32_t *at) {
    int32_t f;
    int64_t k, l;
    for (f = 0; f < (int32_t)s->front_count; ++f) {
        if (s->front_start[f] < s->front_start[f + 1]) gproji_map_variables(s->cholesky, f, at);
        for (k = s->front_start[f]; k < s->front_start[f + 1]; ++k) {
            gproji_group *g = &s->group[s->front_row[k].group];
            const gproji_row *row = &g->row[s->front_row[k].row];
            gproji_expect_rows(s, k, true);
            for (l = row->local; l < row[1].local; ++l) g->local_at[l] = at[g->local_variable[l]];
        }
    }
}

GPROJI_INTERNAL bool gproji_take_placing(gproj_system *s, gproji_placing *placing) {
    const int32_t *permutation = s->cholesky->permutation;
    size_t n = (size_t)s->variable_count;
    int32_t i;
    placing->column = (int32_t *)gproji_take(&s->own, n, sizeof *placing->column);
    placing->where = (int32_t *)gproji_take(&s->own, n, sizeof *placing->where);
    placing->front = (int32_t *)gproji_take(&s->own, placing->rows, sizeof *placing->front);
    if (!placing->column || !placing->where || !placing->front) return false;
    gproji_invert(s->variable_count, permutation, placing->column);
    for (i = 0; i < s->group_count; ++i) {
        gproji_group *g = &s->group[i];
        g->local_at = (int32_t *)gproji_take(&s->own, g->local_count, sizeof *g->local_at);
        if (!g->local_at) return false;
    }
    s->front_count = (size_t)s->cholesky->symbolic.fronts;
    s->front_row_room = placing->rows;
    s->front_start = (int64_t *)gproji_take_zeroed(&s->own, s->front_count + 2, sizeof *s->front_start);
    s->front_row = (gproji_row_name *)gproji_take(&s->own, s->front_row_room, sizeof *s->front_row);
    return s->front_start && s->front_row;
}

/* Places of all rows in their fronts. */
GPROJI_INTERNAL bool gproji_compile_places(gproj_system *s) {
    gproji_placing placing;
    size_t n = (size_t)s->variable_count, row = 0;
    int32_t i;
    bool done;
    memset(&placing, 0, sizeof placing);
    for (i = 0; i < s->group_count; ++i) placing.rows += (size_t)s->group[i].row_count;
    done = gproji_take_placing(s, &placing);
    for (i = 0; done && i < s->group_count; ++i) {
        gproji_place_group(s, &s->group[i], &placing, placing.front + row);
        row += (size_t)s->group[i].row_count;
    }
    if (done) {
        gproji_sort_rows(s, placing.front);
        gproji_place_locals(s, placing.where);
    }
    gproji_give(&s->own, placing.column, n, sizeof *placing.column);
    gproji_give(&s->own, placing.where, n, sizeof *placing.where);
    gproji_give(&s->own, placing.front, placing.rows, sizeof *placing.front);
    return done;
}

/* Step 6: what iterations need. */
GPROJI_INTERNAL bool gproji_take_compiled_arrays(gproj_system *s) {
    size_t n = (size_t)s->variable_count;
    int32_t i;
    for (i = 0; i < s->group_count; ++i) {
        gproji_group *g = &s->group[i];
        g->local_gradient = (double *)gproji_take(&s->own, g->local_count, sizeof *g->local_gradient);
        if (!g->local_gradient) return false;
    }
    s->gradient = (double *)gproji_take(&s->own, n, sizeof *s->gradient);
    s->saved = (double *)gproji_take(&s->own, n, sizeof *s->saved);
    return s->gradient && s->saved;
}

GPROJI_INTERNAL bool gproji_take_wide_arrays(gproj_system *s) {
    size_t k = (size_t)s->wide_count, n = (size_t)s->variable_count;
    if (n > 0 && k + 1 > SIZE_MAX / 2 / sizeof(double) / n) return false;
    s->wide_taken = k;
    s->sides = s->step = (double *)gproji_take(&s->own, (k + 1) * n, sizeof *s->sides);
    s->wide_matrix = (double *)gproji_take(&s->own, k * k, sizeof *s->wide_matrix);
    s->wide_vector = (double *)gproji_take(&s->own, k, sizeof *s->wide_vector);
    if (!s->sides || !s->wide_matrix || !s->wide_vector) return false;
    if (k == 0) return true;
    s->residual = (double *)gproji_take(&s->own, n, sizeof *s->residual);
    s->balance = (double *)gproji_take(&s->own, n, sizeof *s->balance);
    return s->residual && s->balance;
}

GPROJI_INTERNAL bool gproji_take_hinges(gproj_system *s) {
    int32_t i;
    for (i = 0; i < s->group_count; ++i)
        if (s->group[i].kind == GPROJ_BOUND) s->hinge_taken += (size_t)s->group[i].row_count;
    s->hinge = (gproji_hinge *)gproji_take(&s->own, s->hinge_taken, sizeof *s->hinge);
    return s->hinge != NULL;
}

/* Gives back the room that has been kept for further rows. */
GPROJI_INTERNAL bool gproji_trim_rows(gproj_system *s, gproji_group *g) {
    size_t rows = (size_t)g->row_count + 1, terms = (size_t)g->row[g->row_count].term;
    void *row = gproji_retake(&s->own, g->row, g->row_capacity, rows, sizeof *g->row), *term;
    if (!row) return false;
    g->row = (gproji_row *)row;
    g->row_capacity = rows;
    term = gproji_retake(&s->own, g->term, g->term_capacity, terms, sizeof *g->term);
    if (!term) return false;
    g->term = (gproj_term *)term;
    g->term_capacity = terms;
    return true;
}

/* Steps 1 and 2. */
GPROJI_INTERNAL bool gproji_compile_variables(gproj_system *s) {
    size_t n = (size_t)s->variable_count;
    gproji_named *named = (gproji_named *)gproji_take(&s->own, n, sizeof *named);
    bool done;
    int32_t i;
    s->compiled_variables = s->variable_count;
    s->wide_count = 0;
    s->node = (int32_t *)gproji_take_zeroed(&s->own, n, sizeof *s->node);
    s->node_first = (int32_t *)gproji_take(&s->own, n + 1, sizeof *s->node_first);
    done = named && s->node && s->node_first;
    for (i = 0; done && i < s->group_count; ++i)
        done = gproji_trim_rows(s, &s->group[i]) && gproji_compile_locals(s, &s->group[i], named);
    if (done) gproji_compile_nodes(s);
    gproji_give(&s->own, named, n, sizeof *named);
    return done;
}

/* All steps. */
GPROJI_INTERNAL gproj_code gproji_compile_steps(gproj_system *s) {
    gproj_code code;
    if (!gproji_compile_variables(s)) return GPROJ_ERROR_MEMORY;
    code = gproji_compile_analysis(s);
    if (code) return code;
    s->cholesky->batch = gproji_min(s->wide_count + 1, GPROJI_SOLVE_BATCH);
    if (!gproji_compile_places(s) || !gproji_take_compiled_arrays(s) || !gproji_take_wide_arrays(s) ||
        !gproji_take_hinges(s) || !gproji_cholesky_take_numeric(s->cholesky))
        return GPROJ_ERROR_MEMORY;
    return GPROJ_OK;
}

/* Makes the rows ready for iterations; nothing to do when they are. */
GPROJI_INTERNAL gproj_code gproji_compile(gproj_system *s) {
    gproj_code code;
    if (s->compiled) return GPROJ_OK;
    code = gproji_compile_steps(s);
    if (code == GPROJ_OK) {
        s->compiled = true;
        return code;
    }
    gproji_system_forget(s);
    if (gproj_cholesky_error(s->cholesky)->code != GPROJ_OK) {
        const gproj_error *error = gproj_cholesky_error(s->cholesky);
        return gproji_fail(&s->error, error->code, error->place, error->index, "%s", error->message);
    }
    return gproji_fail_memory(&s->error);
}

/* -- evaluation -- */

typedef struct gproji_evaluation {
    gproji_group *group;
    const double *x;
    double rounding; /* rows whose rounding may be larger than this are added up with more digits */
    int32_t chunks;
} gproji_evaluation;

/* phi with twice the digits; the products of three factors have only their first two so exactly, which is what counts
   where large terms cancel. */
GPROJI_INTERNAL double gproji_row_value_precisely(const gproji_group *g, const gproji_row *row, const double *x) {
    const int32_t *variable = g->local_variable + row->local;
    gproji_sum sum = {0, 0};
    int64_t t;
    sum.high = row->constant;
    for (t = row->term; t < row[1].term; ++t) {
        const gproj_term *term = &g->term[t];
        gproji_sum product = {0, 0};
        gproji_sum_add_product(&product, term->a, x[variable[term->i]]);
        if (term->j < 0) {
            gproji_sum_add(&sum, product.high);
            sum.low += product.low;
        } else {
            gproji_sum_add_product(&sum, product.high, x[variable[term->j]]);
            sum.low += product.low * x[variable[term->j]];
        }
    }
    return gproji_sum_value(&sum);
}

/* phi of a row at x; `size` becomes the sum of its terms' absolute values, and grad phi is added to `gradient`. */
GPROJI_INLINE double gproji_linearise_row(const gproji_group *g, const gproji_row *row, const double *x,
                                          double *gradient, double *size) {
    const int32_t *variable = g->local_variable + row->local;
    double phi = row->constant, sum = fabs(row->constant);
    int64_t t;
    for (t = row->term; t < row[1].term; ++t) {
        const gproj_term *term = &g->term[t];
        double value = term->a * x[variable[term->i]], other;
        if (term->j < 0) {
            gradient[term->i] += term->a;
        } else {
            other = x[variable[term->j]];
            gradient[term->i] += term->a * other;
            gradient[term->j] += value;
            value *= other;
        }
        phi += value;
        sum += fabs(value);
    }
    *size = sum;
    return phi;
}

/* phi and grad phi of one chunk of a group's rows; rows without weight get zeros. Rows of bounds act where they are
   violated, or where they did in the last step (gproji_switch_bounds lets them go again). */
GPROJI_INTERNAL void gproji_evaluate_chunk(void *data, int32_t chunk) {
    const gproji_evaluation *e = (const gproji_evaluation *)data;
    gproji_group *g = e->group;
    int32_t r = gproji_chunk_start(g->row_count, e->chunks, chunk),
            end = gproji_chunk_start(g->row_count, e->chunks, chunk + 1);
    for (; r < end; ++r) {
        gproji_row *row = &g->row[r];
        double *gradient = g->local_gradient + row->local, phi, size;
        memset(gradient, 0, (size_t)(row[1].local - row->local) * sizeof *gradient);
        row->phi = 0;
        if (!(row->weight > 0)) row->active = false;
        if (!(row->weight > 0)) continue;
        phi = gproji_linearise_row(g, row, e->x, gradient, &size);
        if (size * DBL_EPSILON > e->rounding && size < 1e50) phi = gproji_row_value_precisely(g, row, e->x);
        row->phi = phi;
        row->active = g->kind != GPROJ_BOUND || !(phi >= 0) || (row->active && !g->guard);
    }
}

/* The values and gradients of all rows at the current x. */
GPROJI_INTERNAL void gproji_evaluate(gproj_system *s) {
    int32_t i;
    s->changed = false;
    for (i = 0; i < s->group_count; ++i) {
        gproji_evaluation e;
        if (s->group[i].guard && !(s->group[i].weight > 0)) continue;
        e.group = &s->group[i];
        e.x = s->x;
        e.rounding = s->rounding;
        e.chunks = e.group->row_count / GPROJI_ROWS_PER_TASK + 1;
        gproji_for(&s->host.parallel, e.chunks, gproji_evaluate_chunk, &e);
    }
}

/* Lets the groups with a weight re-linearise their rows at the current x. */
GPROJI_INTERNAL void gproji_refresh_groups(gproj_system *s) {
    int32_t i;
    for (i = 0; i < s->group_count; ++i)
        if (s->group[i].refresh && s->group[i].weight > 0) s->group[i].refresh(s->group[i].refresh_user, s, i);
}

/* The weight of a row in this iteration, squared. */
GPROJI_INLINE double gproji_weight2(const gproji_group *g, const gproji_row *row) {
    return g->weight * g->weight * row->weight * row->weight;
}

/* gradient' v over the locals of a row. */
GPROJI_INTERNAL double gproji_row_times(const gproji_group *g, const gproji_row *row, const double *v) {
    double sum = 0;
    int64_t l;
    for (l = row->local; l < row[1].local; ++l) sum += g->local_gradient[l] * v[g->local_variable[l]];
    return sum;
}

/* out += scale * gradient */
GPROJI_INTERNAL void gproji_row_add(const gproji_group *g, const gproji_row *row, double scale, double *out) {
    int64_t l;
    for (l = row->local; l < row[1].local; ++l) out[g->local_variable[l]] += scale * g->local_gradient[l];
}

/* gradient = sum w^2 phi grad phi over narrow rows that act: half the gradient of their part of the merit. */
GPROJI_INTERNAL void gproji_merit_gradient(gproj_system *s) {
    int32_t i, r;
    memset(s->gradient, 0, (size_t)s->variable_count * sizeof *s->gradient);
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->weight > 0 && r < g->row_count; ++r) {
            const gproji_row *row = &g->row[r];
            if (!row->wide && row->active) gproji_row_add(g, row, gproji_weight2(g, row) * row->phi, s->gradient);
        }
    }
}

/* -- the matrix -- */

/* What a front is to load: A = sum w^2 g g' + eps^2 I over the narrow rows that act, and, nearest, their curvature:
   w^2 y (Hessian of phi) with the multipliers y of what must hold, and y = phi of wishes. */
typedef struct gproji_loading {
    const gproj_system *system;
    double epsilon;
    bool curved;
} gproji_loading;

/* w^2 g g', lower triangle */
GPROJI_INTERNAL void gproji_load_square(const gproji_group *g, const gproji_row *row, const gproji_panel *panel) {
    const double *gradient = g->local_gradient + row->local;
    const int32_t *at = g->local_at + row->local;
    int32_t count = (int32_t)(row[1].local - row->local), p, q;
    double w2 = gproji_weight2(g, row);
    for (q = 0; q < count; ++q) {
        double *column = gproji_panel_column(panel, at[q]), scale = w2 * gradient[q];
        for (p = q; p < count; ++p) column[at[p]] += scale * gradient[p];
    }
}

/* w^2 y (Hessian of phi), lower triangle */
GPROJI_INTERNAL void gproji_load_curvature(const gproji_group *g, const gproji_row *row, const gproji_panel *panel) {
    const int32_t *at = g->local_at + row->local;
    double y = g->kind == GPROJ_WISH ? row->phi : g->multiplier[row - g->row].y, w2y = gproji_weight2(g, row) * y;
    int64_t t;
    for (t = row->term; t < row[1].term; ++t) {
        int32_t i = g->term[t].i, j = g->term[t].j;
        if (j < 0) continue;
        gproji_panel_column(panel, at[gproji_min(i, j)])[at[gproji_max(i, j)]] += (i == j ? 2 : 1) * w2y * g->term[t].a;
    }
}

/* See gproji_load. */
GPROJI_INTERNAL void gproji_load_front(void *user, int32_t front, const gproji_panel *panel) {
    const gproji_loading *loading = (const gproji_loading *)user;
    const gproj_system *s = loading->system;
    int32_t j;
    int64_t k;
    for (k = s->front_start[front]; k < s->front_start[front + 1]; ++k) {
        const gproji_group *g = &s->group[s->front_row[k].group];
        const gproji_row *row = &g->row[s->front_row[k].row];
        gproji_expect_rows(s, k, false);
        if (!(g->weight > 0) || !row->active) continue;
        gproji_load_square(g, row, panel);
        if (loading->curved) gproji_load_curvature(g, row, panel);
    }
    for (j = 0; j < panel->w; ++j) *gproji_panel_at(panel, j + panel->shift, j) += loading->epsilon * loading->epsilon;
}

/* Factors A; right-hand sides as for gproji_cholesky_factor_with. */
GPROJI_INTERNAL bool gproji_factor_matrix(gproj_system *s, double epsilon, bool curved, int32_t sides,
                                          const double *b) {
    gproji_loading loading;
    loading.system = s, loading.epsilon = epsilon, loading.curved = curved;
    return gproji_cholesky_factor_with(s->cholesky, gproji_load_front, &loading, sides, b) == GPROJ_FACTORED;
}

/* out = A v, A = sum w^2 g g' + eps^2 I over narrow rows that act. */
GPROJI_INTERNAL void gproji_matrix_times(const gproj_system *s, double epsilon, const double *v, double *out) {
    int32_t i, r;
    for (i = 0; i < s->variable_count; ++i) out[i] = epsilon * epsilon * v[i];
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->weight > 0 && r < g->row_count; ++r) {
            const gproji_row *row = &g->row[r];
            if (!row->wide && row->active)
                gproji_row_add(g, row, gproji_weight2(g, row) * gproji_row_times(g, row, v), out);
        }
    }
}

/* -- wide rows -- */

/* With wide rows the matrix is A + U U', U = (w g_1, w g_2, ...), and the step solves
       A dx + U m = -gradient,    m = w phi + U'dx
   (Sherman, Morrison, Woodbury, arranged so that w phi never passes through A^-1, where eps^2 would blow it up). From
   an approximation dx, at first 0, with A = L L', Y = L^-1 U and z = L^-1 (-gradient - A dx), a better one is
       dx + L'^-1 (z - Y m),    (I + Y'Y) m = w phi + U'dx + Y'z,
   so that U costs half a solution. */

/* The parts of a step that may cancel to it without a check: see gproji_refine_step. */
static const double gproji_parts_most = 1e3;

/* Calls `visit` for the wide rows that act in a fixed order; returns how many there are. */
typedef void (*gproji_visit_wide)(gproj_system *s, const gproji_group *g, const gproji_row *row, int32_t index);

GPROJI_INTERNAL int32_t gproji_for_wide_rows(gproj_system *s, gproji_visit_wide visit) {
    int32_t i, r, index = 0;
    if (s->wide_count == 0) return 0;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->weight > 0 && r < g->row_count; ++r)
            if (g->row[r].wide && g->row[r].active) visit(s, g, &g->row[r], index++);
    }
    return index;
}

/* Column `index` of U, or of Y. */
GPROJI_INLINE double *gproji_wide_side(const gproj_system *s, int32_t index) {
    return s->sides + (int64_t)s->variable_count * (index + 1);
}

GPROJI_INTERNAL void gproji_wide_column(gproj_system *s, const gproji_group *g, const gproji_row *row, int32_t index) {
    double *column = gproji_wide_side(s, index);
    memset(column, 0, (size_t)s->variable_count * sizeof *column);
    gproji_row_add(g, row, sqrt(gproji_weight2(g, row)), column);
}

/* w phi */
GPROJI_INTERNAL void gproji_wide_value(gproj_system *s, const gproji_group *g, const gproji_row *row, int32_t index) {
    s->wide_vector[index] = sqrt(gproji_weight2(g, row)) * row->phi;
}

/* w phi + U'dx */
GPROJI_INTERNAL void gproji_wide_ahead(gproj_system *s, const gproji_group *g, const gproji_row *row, int32_t index) {
    s->wide_vector[index] = sqrt(gproji_weight2(g, row)) * (row->phi + gproji_row_times(g, row, s->step));
}

/* Factors the small matrix in place by rows: L L' = M. It is I plus a positive semidefinite matrix, so no pivot is less
   than 1; where rounding says so (rows that depend on each other), the pivot is what rounding lets be known. */
GPROJI_INTERNAL void gproji_wide_factor(double *m, int32_t n, int32_t stride) {
    int32_t i, j, k;
    for (i = 0; i < n; ++i) {
        double *row = m + (int64_t)i * stride, least = gproji_fmax(1, 8 * DBL_EPSILON * row[i]);
        for (j = 0; j <= i; ++j) {
            const double *other = m + (int64_t)j * stride;
            double sum = row[j];
            for (k = 0; k < j; ++k) sum -= row[k] * other[k];
            row[j] = i == j ? sqrt(gproji_fmax(sum, least)) : sum / other[j];
        }
    }
}

GPROJI_INTERNAL void gproji_wide_solve(const double *m, int32_t n, int32_t stride, double *b) {
    int32_t i, k;
    for (i = 0; i < n; ++i) {
        for (k = 0; k < i; ++k) b[i] -= m[(int64_t)i * stride + k] * b[k];
        b[i] /= m[(int64_t)i * stride + i];
    }
    for (i = n - 1; i >= 0; --i) {
        for (k = i + 1; k < n; ++k) b[i] -= m[(int64_t)k * stride + i] * b[k];
        b[i] /= m[(int64_t)i * stride + i];
    }
}

/* a'b; four sums, so that none has to wait for the one before. */
GPROJI_INTERNAL double gproji_wide_dot(int64_t count, const double *a, const double *b) {
    double sum[4] = {0, 0, 0, 0};
    int64_t i, k;
    for (i = 0; i + 4 <= count; i += 4)
        for (k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
    for (; i < count; ++i) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* I + Y'Y, factored. `wide`: columns of Y. */
GPROJI_INTERNAL void gproji_wide_products(gproj_system *s, int32_t wide) {
    int32_t i, k;
    for (i = 0; i < wide; ++i)
        for (k = 0; k <= i; ++k)
            s->wide_matrix[(int64_t)i * s->wide_count + k] =
                gproji_wide_dot(s->variable_count, gproji_wide_side(s, i), gproji_wide_side(s, k)) + (k == i);
    gproji_wide_factor(s->wide_matrix, wide, s->wide_count);
}

/* z becomes z - Y m; wide_vector: m without Y'z. Returns |z| + sum |Y_k m_k| over |z - Y m|. */
GPROJI_INTERNAL double gproji_wide_correct(gproj_system *s, int32_t wide, double *z) {
    int64_t n = s->variable_count, i;
    double parts = sqrt(gproji_wide_dot(n, z, z));
    int32_t k;
    for (k = 0; k < wide; ++k) s->wide_vector[k] += gproji_wide_dot(n, gproji_wide_side(s, k), z);
    gproji_wide_solve(s->wide_matrix, wide, s->wide_count, s->wide_vector);
    for (k = 0; k < wide; ++k) {
        const double *side = gproji_wide_side(s, k);
        double m = s->wide_vector[k];
        for (i = 0; i < n; ++i) z[i] -= m * side[i];
        parts += fabs(m) * sqrt(gproji_wide_dot(n, side, side));
    }
    return parts / gproji_fmax(sqrt(gproji_wide_dot(n, z, z)), DBL_MIN);
}

/* The right-hand sides of a step: -gradient, and U. Returns the number of wide rows. */
GPROJI_INTERNAL int32_t gproji_step_sides(gproj_system *s) {
    int32_t v;
    for (v = 0; v < s->variable_count; ++v) s->step[v] = -s->gradient[v];
    return gproji_for_wide_rows(s, gproji_wide_column);
}

/* The step from its right-hand sides, of which the factorisation has made z and Y already if it has taken them along.
   Returns how large the parts of L'dx are to it. */
GPROJI_INTERNAL double gproji_finish_step(gproj_system *s, int32_t wide, bool taken) {
    gproj_cholesky *c = s->cholesky;
    double parts = 1;
    if (taken && wide == 0) {
        gproji_cholesky_finish(c, s->step);
        return parts;
    }
    if (taken)
        memcpy(s->sides, c->solution, ((size_t)wide + 1) * (size_t)s->variable_count * sizeof *s->sides);
    else
        gproji_cholesky_forward(c, wide + 1, s->sides, s->sides);
    if (wide > 0) {
        gproji_wide_products(s, wide);
        gproji_for_wide_rows(s, gproji_wide_value);
        parts = gproji_wide_correct(s, wide, s->step);
    }
    gproji_cholesky_backward(c, s->step, s->step);
    return parts;
}

/* The step with the factor of A. */
GPROJI_INTERNAL void gproji_solve_step(gproj_system *s) { gproji_finish_step(s, gproji_step_sides(s), false); }

/* balance += U m at this step. */
GPROJI_INTERNAL void gproji_wide_pull(gproj_system *s, const gproji_group *g, const gproji_row *row, int32_t index) {
    (void)index;
    gproji_row_add(g, row, gproji_weight2(g, row) * (row->phi + gproji_row_times(g, row, s->step)), s->balance);
}

/* residual = -gradient - A dx. Does U m balance it, as it should? `epsilon`: that of A. */
GPROJI_INTERNAL bool gproji_is_balanced(gproj_system *s, double epsilon) {
    double left = 0, size = 0;
    int32_t v;
    gproji_matrix_times(s, epsilon, s->step, s->residual);
    memset(s->balance, 0, (size_t)s->variable_count * sizeof *s->balance);
    gproji_for_wide_rows(s, gproji_wide_pull);
    for (v = 0; v < s->variable_count; ++v) {
        s->residual[v] = -s->gradient[v] - s->residual[v];
        left = gproji_fmax(left, fabs(s->residual[v] - s->balance[v]));
        size = gproji_fmax(size, fabs(s->gradient[v]) + fabs(s->balance[v]));
    }
    return left <= 1e-9 * size;
}

/* Iterative refinement of the step, at most `rounds` times, until the equations hold to 9 digits. To see whether they do
   costs a product with all rows, and is left out where the answer is known. `parts`: what z and the Y_k m_k are to their
   sum z - Y m = L'dx. Triangular solves are backward stable: z misses its equation by some roundings of |L||z|, Y_k by
   as many of |L||Y_k|, and m, whose matrix is made of the same Y, misses its own by roundings of |Y||Y m|. So the step
   misses its equations by `parts` times what one without wide rows would, by some roundings of |L||L'dx|, which is not
   looked at either; besides that by roundings of |U U'||dx|, as U'dx has them, however exact dx is. What must be looked
   at are large parts that cancel: wide rows that say what narrow ones say already, or other wide ones. */
GPROJI_INTERNAL void gproji_refine_step(gproj_system *s, int32_t wide, double epsilon, double parts, int32_t rounds) {
    int32_t v;
    if (wide == 0 || parts <= gproji_parts_most) return;
    while (rounds-- > 0 && !gproji_is_balanced(s, epsilon)) {
        gproji_for_wide_rows(s, gproji_wide_ahead);
        gproji_cholesky_forward(s->cholesky, 1, s->residual, s->residual);
        gproji_wide_correct(s, wide, s->residual);
        gproji_cholesky_backward(s->cholesky, s->residual, s->residual);
        for (v = 0; v < s->variable_count; ++v) s->step[v] += s->residual[v];
    }
}

/* ============================================================================================================
   >>loop   Guided projection: steps with damping until the constraints hold, and the verdict. Uses platform, error,
   parallel, system.

   Based on Tang et al. (2014), section 3.3, solved for dx instead of x. The regularisation eps follows the residual, so
   that the first steps are calm and the last ones quadratic; it stays above 1e-5, because a smaller one lets rounding
   grow along the directions that the constraints leave free. The rows are quadratic, so along a step dx the merit
       M(t) = sum w^2 phi(x + t dx)^2    (constraints and wishes with their weights in this iteration)
   is a polynomial of degree 4 in t that is known exactly from phi(x), grad phi(x)'dx and phi(x + dx). A step that would
   raise it is shortened to the t of smallest merit; where no t lowers it, the step is found again with a larger eps, as
   in the method of Levenberg (1944) and Marquardt (1963). Near the end and without wishes, a step along which the merit
   goes on falling beyond t = 1 is lengthened: at singular points of the constraints Newton's steps are half of what is
   needed.

   With bounds the linearised problem is to make sum w^2 (phi + g'dx)^2 + eps^2 |dx|^2 small, where a bound's row counts
   only as far as phi + g'dx < 0. Newton's method for it is to find the step with a guess of the rows that act, and again
   with those that are violated by it (Hintermueller, Ito, Kunisch: The primal-dual active set strategy as a semismooth
   Newton method, 2003). The first guess is what is violated at x and what acted on the last step. The merit is then
   piecewise of degree 4 with a continuous slope. */

static const double gproji_epsilon_min = 1e-5, gproji_epsilon_max = 1e-3, gproji_epsilon_least = 1e-8;
/* A step may violate bounds by so much of the largest residual: they act on the next one then. */
static const double gproji_bound_slack = 0.01;
enum {
    GPROJI_ATTEMPTS = 8,     /* steps with different eps in one iteration */
    GPROJI_BOUND_ROUNDS = 3, /* how often each is found again where it meets bounds */
    GPROJI_PATIENCE = 5,     /* iterations without progress before the loop stops */
    GPROJI_REFINEMENTS = 3,  /* rounds at most for systems with wide rows */
    GPROJI_LINE_SAMPLES = 40
};

/* Where the rows stand: sums over all groups with their present weights. */
typedef struct gproji_standing {
    double merit;    /* sum w^2 phi^2 */
    double energy;   /* the wishes' part of it */
    double residual; /* largest |phi| of what must hold, with weight > 0 */
    int32_t group;   /* where that is; -1 where nothing must */
    int32_t row;
} gproji_standing;

/* What a solve carries along. */
typedef struct gproji_loop {
    gproj_system *system;
    gproj_solve_options options;
    double tolerance;
    double started, lap; /* clock readings */
    gproj_result result;
    gproj_iteration iteration;
    gproji_standing standing;
    double epsilon_least; /* the least that follows the residual: gproji_epsilon_min, smaller where steps fall short */
    double shift;         /* nearest: of the last slide with curvature, times s^2 */
    bool minimum;         /* nearest: the last slide had all curvature and a positive definite matrix without a shift */
} gproji_loop;

/* The terms of a row, to change their coefficients in place; for what they name see gproji_variable_of. */
GPROJI_INTERNAL gproj_term *gproji_row_terms(gproj_system *s, int32_t group, int32_t row, int32_t *count) {
    gproji_group *g = &s->group[group];
    *count = (int32_t)(g->row[row + 1].term - g->row[row].term);
    return g->term + g->row[row].term;
}

GPROJI_INTERNAL const char *gproji_place_word(gproj_place place) {
    switch (place) {
    case GPROJ_PLACE_VERTEX: return "vertex";
    case GPROJ_PLACE_EDGE: return "edge";
    case GPROJ_PLACE_FACE: return "face";
    case GPROJ_PLACE_VARIABLE: return "variable";
    default: return "element";
    }
}

GPROJI_INTERNAL const char *gproji_outcome_string(gproj_outcome outcome) {
    static const char *const sentences[] = {
#define GPROJ_X(name, sentence) sentence,
        GPROJ_OUTCOMES(GPROJ_X)
#undef GPROJ_X
    };
    return sentences[outcome];
}

GPROJI_INTERNAL double gproji_now(const gproj_system *s) {
    return s->host.clock.now ? s->host.clock.now(s->host.clock.user) : 0;
}

/* Books the time since the last call to a phase. */
GPROJI_INTERNAL void gproji_lap(gproji_loop *loop, gproj_phase phase) {
    double now = gproji_now(loop->system);
    loop->iteration.seconds[phase] += now - loop->lap;
    loop->result.seconds[phase] += now - loop->lap;
    loop->lap = now;
}

/* The weight of a group in iteration n. */
GPROJI_INTERNAL double gproji_weight_in(const gproj_system *s, const gproji_group *g, int32_t n) {
    int32_t last = g->schedule.last;
    if (last == 0 && g->kind == GPROJ_WISH) last = s->default_last;
    if (last > 0 && n > last) return 0;
    return g->schedule.weight * (g->schedule.decay > 0 ? pow(g->schedule.decay, (double)n) : 1);
}

/* Sets the weights of iteration n; true when a group came back that had none before. */
GPROJI_INTERNAL bool gproji_set_weights(gproj_system *s, int32_t n) {
    bool back = false;
    int32_t i;
    for (i = 0; i < s->group_count; ++i) {
        double weight = gproji_weight_in(s, &s->group[i], n);
        back = back || (s->group[i].weight == 0 && weight > 0);
        s->group[i].weight = weight;
    }
    return back;
}

/* Does the group count in merit and residual? */
GPROJI_INTERNAL bool gproji_group_counts(const gproji_group *g) { return g->weight > 0 && !g->guard; }

GPROJI_INTERNAL bool gproji_wishes_are_on(const gproj_system *s) {
    int32_t i;
    for (i = 0; i < s->group_count; ++i)
        if (gproji_group_counts(&s->group[i]) && s->group[i].kind == GPROJ_WISH && s->group[i].row_count > 0)
            return true;
    return false;
}

/* Of a group that counts: must it hold? */
GPROJI_INTERNAL bool gproji_must_hold(const gproji_group *g) { return gproji_group_counts(g) && g->kind != GPROJ_WISH; }

GPROJI_INTERNAL gproji_standing gproji_take_standing(const gproj_system *s) {
    gproji_standing standing;
    int32_t i, r;
    memset(&standing, 0, sizeof standing);
    standing.group = standing.row = -1;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        double sum = 0;
        if (!gproji_group_counts(g)) continue;
        for (r = 0; r < g->row_count; ++r) {
            double phi = fabs(gproji_counted(g, g->row[r].phi));
            if (!(phi <= DBL_MAX)) phi = HUGE_VAL; /* not a number: as bad as can be, never overlooked */
            sum += gproji_weight2(g, &g->row[r]) * phi * phi;
            if (g->kind == GPROJ_WISH || (standing.group >= 0 && phi <= standing.residual)) continue;
            standing.residual = phi;
            standing.group = i;
            standing.row = r;
        }
        standing.merit += sum;
        if (g->kind == GPROJ_WISH) standing.energy += sum;
    }
    return standing;
}

/* By how much rounding may change the value of a linear row. */
GPROJI_INTERNAL double gproji_row_rounding(const gproji_group *g, int32_t row, const double *x) {
    double sum = 0;
    int64_t t;
    for (t = g->row[row].term; t < g->row[row + 1].term; ++t)
        if (g->term[t].j < 0) sum += fabs(g->term[t].a * x[gproji_variable_of(g, &g->row[row], g->term[t].i)]);
    return 16 * DBL_EPSILON * sum;
}

/* The caller's tolerance, or what rounding allows at this x. */
GPROJI_INTERNAL double gproji_tolerance_at(const gproji_loop *loop) {
    const gproj_system *s = loop->system;
    double largest = 0, tolerance;
    int32_t v, i, r;
    if (loop->options.tolerance > 0) return loop->options.tolerance;
    for (v = 0; v < s->variable_count; ++v) largest = gproji_fmax(largest, fabs(s->x[v]));
    tolerance = gproji_fmax(1e-13, 8 * DBL_EPSILON * largest);
    for (i = 0; i < s->group_count; ++i)
        for (r = 0; s->group[i].global && s->group[i].weight > 0 && r < s->group[i].row_count; ++r)
            tolerance = gproji_fmax(tolerance, gproji_row_rounding(&s->group[i], r, s->x));
    return tolerance;
}

/* Rows, gradients and standing at the current x. */
GPROJI_INTERNAL void gproji_linearise(gproji_loop *loop) {
    gproji_refresh_groups(loop->system);
    loop->tolerance = gproji_tolerance_at(loop);
    loop->system->rounding = loop->tolerance;
    gproji_evaluate(loop->system);
    loop->standing = gproji_take_standing(loop->system);
    gproji_lap(loop, GPROJ_PHASE_REFRESH);
}

/* Solves for the step dx with this eps. False when the matrix is not positive definite in floating point. */
GPROJI_INTERNAL bool gproji_find_step(gproji_loop *loop, double epsilon) {
    gproj_system *s = loop->system;
    int32_t wide;
    bool fused, factored;
    gproji_merit_gradient(s);
    wide = gproji_step_sides(s);
    fused = wide < s->cholesky->batch;
    gproji_lap(loop, GPROJ_PHASE_ASSEMBLE);
    factored = gproji_factor_matrix(s, epsilon, false, fused ? wide + 1 : 0, s->sides);
    loop->iteration.attempts++;
    gproji_lap(loop, GPROJ_PHASE_FACTOR);
    if (!factored) return false;
    gproji_refine_step(s, wide, epsilon, gproji_finish_step(s, wide, fused), GPROJI_REFINEMENTS);
    gproji_lap(loop, GPROJ_PHASE_SOLVE);
    return true;
}

/* x = saved + t dx; returns the largest |t dx|, infinite where it is not a number. */
GPROJI_INTERNAL double gproji_take_step(gproj_system *s, double t) {
    double largest = 0;
    int32_t v;
    for (v = 0; v < s->variable_count; ++v) {
        double d = fabs(t * s->step[v]);
        if (!(d <= DBL_MAX)) return HUGE_VAL;
        if (d > largest) largest = d;
        s->x[v] = s->saved[v] + t * s->step[v];
    }
    return largest;
}

GPROJI_INTERNAL void gproji_step_back(gproj_system *s) {
    if (s->variable_count) memcpy(s->x, s->saved, (size_t)s->variable_count * sizeof *s->x);
}

/* The merit along a step: c[0] + c[1] t + ... + c[4] t^4 + sum w^2 min(0, phi + t h + t^2 q)^2 over the hinges. */
typedef struct gproji_course {
    double c[5];
    int64_t count;
    const gproji_hinge *hinge;
} gproji_course;

/* w^2 (phi + t h + t^2 q)^2 */
GPROJI_INTERNAL void gproji_add_quartic(const gproji_hinge *row, double c[5]) {
    double w2 = row->w2, phi = row->phi, h = row->h, q = row->q;
    c[0] += w2 * phi * phi;
    c[1] += w2 * 2 * phi * h;
    c[2] += w2 * (h * h + 2 * phi * q);
    c[3] += w2 * 2 * h * q;
    c[4] += w2 * q * q;
}

/* M(t) along dx, for x = saved + dx and rows linearised at `saved`: phi(saved + t dx) = phi + t h + t^2 q with
   h = grad phi'dx, q = phi(saved + dx) - phi - h. Of the bounds' rows those that a t <= 2 may violate. */
GPROJI_INTERNAL void gproji_merit_along(const gproj_system *s, gproji_course *m) {
    int32_t i, r;
    memset(m, 0, sizeof *m);
    m->hinge = s->hinge;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->weight > 0 && r < g->row_count; ++r) {
            const gproji_row *row = &g->row[r];
            gproji_hinge along;
            along.w2 = gproji_weight2(g, row);
            if (!(along.w2 > 0) || (g->guard && !row->active)) continue;
            along.phi = row->phi;
            along.h = gproji_row_times(g, row, s->step);
            along.q = gproji_row_value(g, r, s->x) - along.phi - along.h;
            if (g->kind != GPROJ_BOUND) {
                gproji_add_quartic(&along, m->c);
            } else if (!(along.phi + 2 * gproji_fmin(along.h, 0) + 4 * gproji_fmin(along.q, 0) >= 0)) {
                s->hinge[m->count++] = along;
            }
        }
    }
}

GPROJI_INTERNAL double gproji_merit_at(const gproji_course *m, double t) {
    const double *c = m->c;
    double sum = c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * c[4])));
    int64_t i;
    for (i = 0; i < m->count; ++i) {
        const gproji_hinge *row = &m->hinge[i];
        double phi = row->phi + t * (row->h + t * row->q);
        if (!(phi >= 0)) sum += row->w2 * phi * phi;
    }
    return sum;
}

GPROJI_INTERNAL double gproji_merit_slope(const gproji_course *m, double t) {
    const double *c = m->c;
    double sum = c[1] + t * (2 * c[2] + t * (3 * c[3] + t * 4 * c[4]));
    int64_t i;
    for (i = 0; i < m->count; ++i) {
        const gproji_hinge *row = &m->hinge[i];
        double phi = row->phi + t * (row->h + t * row->q);
        if (!(phi >= 0)) sum += row->w2 * 2 * phi * (row->h + 2 * t * row->q);
    }
    return sum;
}

/* The t in [low, high] with the smallest merit: the best of evenly spaced samples, then bisection for the root of the
   slope beside it. (Comparing values would find t to half the digits only.) */
GPROJI_INTERNAL double gproji_minimise_merit(const gproji_course *m, double low, double high) {
    double spacing = (high - low) / (double)GPROJI_LINE_SAMPLES, best = low, least = gproji_merit_at(m, low);
    int32_t i;
    for (i = 1; i <= GPROJI_LINE_SAMPLES; ++i) {
        double merit = gproji_merit_at(m, low + i * spacing);
        if (!(merit < least)) continue;
        best = low + i * spacing;
        least = merit;
    }
    low = gproji_fmax(low, best - spacing);
    high = gproji_fmin(high, best + spacing);
    if (gproji_merit_slope(m, low) >= 0) return low;
    if (gproji_merit_slope(m, high) <= 0) return high;
    for (i = 0; i < 60; ++i) {
        double middle = low + (high - low) / 2;
        if (gproji_merit_slope(m, middle) < 0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* The part of the step to take, from the merit along it; 0: none, the step is no good. */
GPROJI_INTERNAL double gproji_step_length(const gproji_loop *loop) {
    gproji_course merit;
    double none, full, t;
    if (loop->options.skip_damping || loop->standing.residual <= 1e-9) return 1; /* near the end rounding decides */
    gproji_merit_along(loop->system, &merit);
    none = gproji_merit_at(&merit, 0), full = gproji_merit_at(&merit, 1);
    if (!(full <= DBL_MAX)) return 0;
    if (full > none) {
        t = gproji_minimise_merit(&merit, 0.05, 1);
        return gproji_merit_at(&merit, t) < none ? t : 0;
    }
    if (gproji_wishes_are_on(loop->system) || loop->standing.residual > 1e-2) return 1;
    t = gproji_minimise_merit(&merit, 0.1, 2);
    return t >= 1.3 ? t : 1;
}

/* Lets the bounds' rows act where they are violated at the present x, and nowhere else. */
GPROJI_INTERNAL void gproji_start_bounds(gproj_system *s) {
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->kind == GPROJ_BOUND && r < g->row_count; ++r) g->row[r].active = !(g->row[r].phi >= 0);
    }
}

/* Should the row of a bound act on this step? Yes where the step would violate it by more than `slack`, in itself and
   linearised (of a convex row the tangent alone would say so too early); where it acts already, as long as it does not
   hold the step back. The guard looks where the full step leads, and keeps its rows. */
GPROJI_INTERNAL bool gproji_should_act(const gproj_system *s, const gproji_group *g, int32_t r, double slack) {
    const gproji_row *row = &g->row[r];
    double ahead;
    if (!(row->weight > 0)) return false;
    if (g->guard) return row->active || gproji_row_value(g, r, s->x) < -g->slack;
    ahead = row->phi + gproji_row_times(g, row, s->step);
    return row->active ? ahead < 0 : ahead < -slack && gproji_row_value(g, r, s->x) < -slack;
}

/* Switches rows of bounds on and off by the step that was found; true: it must be found again. The guard has its say
   in the first round only. */
GPROJI_INTERNAL bool gproji_switch_bounds(const gproji_loop *loop, int32_t round) {
    const gproj_system *s = loop->system;
    double slack = gproji_fmax(loop->tolerance, gproji_bound_slack * loop->standing.residual);
    bool changed = false;
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        if (g->kind != GPROJ_BOUND || !(g->weight > 0) || (g->guard && round > 0)) continue;
        for (r = 0; r < g->row_count; ++r) {
            bool active = gproji_should_act(s, g, r, slack);
            changed = changed || active != g->row[r].active;
            g->row[r].active = active;
        }
    }
    return changed;
}

/* Finds the full step with this eps, again where it meets bounds, and goes there. False: there is none. */
GPROJI_INTERNAL bool gproji_find_bounded_step(gproji_loop *loop, double epsilon) {
    int32_t round = 0;
    do {
        if (!gproji_find_step(loop, epsilon)) return false;
        loop->iteration.step = gproji_take_step(loop->system, 1);
        if (!(loop->iteration.step <= DBL_MAX)) return false;
    } while (round < GPROJI_BOUND_ROUNDS && gproji_switch_bounds(loop, round++));
    return true;
}

/* Finds a step with this eps and takes it if it is good; x is then the new one, else the old. */
GPROJI_INTERNAL bool gproji_try_step(gproji_loop *loop, double epsilon) {
    gproj_system *s = loop->system;
    loop->iteration.epsilon = epsilon;
    if (!gproji_find_bounded_step(loop, epsilon)) {
        gproji_step_back(s);
        return false;
    }
    loop->iteration.length = gproji_step_length(loop);
    if (loop->iteration.length != 1) loop->iteration.step = gproji_take_step(s, loop->iteration.length);
    gproji_lap(loop, GPROJ_PHASE_REFRESH);
    return loop->iteration.length > 0;
}

/* The eps that belongs to how far things are from holding: three tenths of the norm of all phi, which does not depend
   on the directions of the axes, as the largest of them would. */
GPROJI_INTERNAL double gproji_epsilon_of(const gproji_standing *standing) {
    return 0.3 * sqrt(gproji_fmax(0, standing->merit - standing->energy));
}

/* One iteration from a linearised x to the next. False when no attempt was good; x is then as before. */
GPROJI_INTERNAL bool gproji_iterate(gproji_loop *loop) {
    gproj_system *s = loop->system;
    double epsilon = loop->options.epsilon;
    int32_t attempt;
    if (!(epsilon > 0))
        epsilon = gproji_fmin(gproji_fmax(gproji_epsilon_of(&loop->standing), loop->epsilon_least), gproji_epsilon_max);
    if (s->variable_count) memcpy(s->saved, s->x, (size_t)s->variable_count * sizeof *s->x);
    loop->iteration.attempts = 0;
    for (attempt = 0; attempt < GPROJI_ATTEMPTS; ++attempt, epsilon *= 10) {
        double before = loop->standing.residual;
        bool stepped = gproji_try_step(loop, epsilon);
        if (stepped) gproji_linearise(loop);
        if (stepped && loop->standing.merit <= DBL_MAX) {
            if (!gproji_wishes_are_on(s) && before < gproji_epsilon_max && loop->standing.residual > 0.5 * before)
                loop->epsilon_least = gproji_fmax(0.1 * loop->epsilon_least, gproji_epsilon_least);
            return true;
        }
        if (stepped) { /* beyond all numbers */
            gproji_step_back(s);
            gproji_linearise(loop);
        }
        gproji_start_bounds(s);
    }
    return false;
}

GPROJI_INTERNAL void gproji_report_iteration(gproji_loop *loop, int32_t number) {
    loop->iteration.number = number;
    loop->iteration.residual = loop->standing.residual;
    loop->iteration.merit = loop->standing.merit;
    loop->iteration.energy = loop->standing.energy;
    loop->result.iterations = number;
    loop->result.damped += loop->iteration.attempts > 1 || loop->iteration.length < 1;
    loop->result.step = loop->iteration.step;
}

/* Do the constraints hold? */
GPROJI_INTERNAL bool gproji_holds(const gproji_loop *loop) { return loop->standing.residual <= loop->tolerance; }

/* Do the constraints hold, with nothing left to be wished for? */
GPROJI_INTERNAL bool gproji_has_converged(const gproji_loop *loop) {
    if (!gproji_holds(loop)) return false;
    if (!gproji_wishes_are_on(loop->system)) return true;
    return loop->result.iterations > 0 && loop->result.step <= loop->tolerance;
}

GPROJI_INTERNAL bool gproji_is_out_of_time(const gproji_loop *loop) {
    return loop->options.time_budget > 0 && !(gproji_now(loop->system) - loop->started < loop->options.time_budget);
}

/* What comes before iteration n: its weights, and rows that they or the caller have changed. */
GPROJI_INTERNAL void gproji_begin_iteration(gproji_loop *loop, int32_t n, int32_t half) {
    gproj_system *s = loop->system;
    memset(loop->iteration.seconds, 0, sizeof loop->iteration.seconds);
    if (gproji_set_weights(s, n)) gproji_linearise(loop);
    s->late = gproji_wishes_are_on(s) && n <= half ? 0 : s->late + 1;
    loop->standing = gproji_take_standing(s);
}

/* The caller's turn; its time belongs to no phase. False: stop. */
GPROJI_INTERNAL bool gproji_call_back(gproji_loop *loop) {
    bool go_on = true;
    if (loop->options.on_iteration)
        go_on = loop->options.on_iteration(loop->options.user, loop->system, &loop->iteration);
    loop->lap = gproji_now(loop->system);
    return go_on;
}

/* What the callback has changed counts before anything is judged. Returns whether there was something. */
GPROJI_INTERNAL bool gproji_see_changes(gproji_loop *loop) {
    if (!loop->system->changed) return false;
    gproji_set_weights(loop->system, loop->result.iterations);
    gproji_linearise(loop);
    return true;
}

/* Is this clearly better than that: by a tenth in the largest residual, or by two fifths in the sum of squares? */
GPROJI_INTERNAL bool gproji_is_better(const gproji_standing *a, const gproji_standing *b) {
    return a->residual < 0.9 * b->residual || a->merit < 0.6 * b->merit;
}

/* The iterations; returns how they ended. */
GPROJI_INTERNAL gproj_outcome gproji_run_loop(gproji_loop *loop, int32_t iterations) {
    gproj_system *s = loop->system;
    gproji_standing best;
    int32_t half = iterations / 2 + iterations % 2, waited = 0;
    s->late = 0;
    best.residual = best.merit = HUGE_VAL;
    gproji_set_weights(s, 1);
    gproji_linearise(loop);
    gproji_start_bounds(s);
    while (loop->result.iterations < iterations) {
        gproji_begin_iteration(loop, loop->result.iterations + 1, half);
        if (s->error.code != GPROJ_OK) return GPROJ_FAILED;
        if (gproji_has_converged(loop)) return GPROJ_CONVERGED;
        if (gproji_is_out_of_time(loop)) return GPROJ_TIME_OUT;
        if (!gproji_iterate(loop)) return gproji_holds(loop) ? GPROJ_CONVERGED : GPROJ_STALLED;
        gproji_report_iteration(loop, loop->result.iterations + 1);
        if (!gproji_call_back(loop)) return GPROJ_CANCELLED;
        if (gproji_see_changes(loop)) best.residual = best.merit = HUGE_VAL;
        waited = gproji_is_better(&loop->standing, &best) || gproji_wishes_are_on(s) ? 0 : waited + 1;
        if (waited == 0) best = loop->standing;
        if (waited >= GPROJI_PATIENCE && !gproji_holds(loop)) return GPROJ_STALLED;
    }
    return s->error.code != GPROJ_OK ? GPROJ_FAILED : gproji_holds(loop) ? GPROJ_CONVERGED : GPROJ_ITERATION_LIMIT;
}

/* The other group that must hold with the largest residual above the tolerance; -1: none. */
GPROJI_INTERNAL int32_t gproji_second_group(const gproji_loop *loop) {
    const gproj_system *s = loop->system;
    double largest = loop->tolerance;
    int32_t g, second = -1;
    for (g = 0; g < s->group_count; ++g) {
        double max = gproj_system_group_info(s, g).max;
        if (g == loop->standing.group || !gproji_must_hold(&s->group[g]) || max <= largest) continue;
        largest = max;
        second = g;
    }
    return second;
}

/* The verdict in a sentence: what happened, where it is worst, what fights, what to do. */
GPROJI_INTERNAL void gproji_write_verdict(gproji_loop *loop) {
    gproj_result *r = &loop->result;
    const gproj_system *s = loop->system;
    const gproji_standing *standing = &loop->standing;
    const gproji_group *g = standing->group >= 0 ? &s->group[standing->group] : NULL;
    const char *plural = r->iterations == 1 ? "" : "s", *more = "";
    int32_t second = gproji_second_group(loop);
    char fight[3 * GPROJ_NAME_SIZE], element[GPROJ_NAME_SIZE];
    r->tolerance = loop->tolerance;
    r->residual = standing->residual;
    r->worst_group = standing->group;
    r->worst_element = g ? g->row[standing->row].element : -1;
    if (!g) {
        gproji_format(r->message, sizeof r->message,
                      "there is nothing that must hold; %d iteration%s towards the wishes", r->iterations, plural);
        return;
    }
    if (r->outcome == GPROJ_ITERATION_LIMIT) more = "; allow more iterations, or ask for less";
    if (r->outcome == GPROJ_STALLED && second >= 0) {
        gproji_format(fight, sizeof fight, "; '%s' and '%s' work against each other", g->name, s->group[second].name);
        more = fight;
    }
    element[0] = 0;
    if (g->place != GPROJ_PLACE_NONE)
        gproji_format(element, sizeof element, ", %s %d", gproji_place_word(g->place), r->worst_element);
    gproji_format(r->message, sizeof r->message, "%s: %d iteration%s, largest residual %g (%s%s)%s",
                  gproji_outcome_string(r->outcome), r->iterations, plural, r->residual, g->name, element, more);
}

/* A result that carries an error's sentence. */
GPROJI_INTERNAL gproj_result gproji_failed_result(const gproj_error *error) {
    gproj_result result;
    memset(&result, 0, sizeof result);
    result.outcome = GPROJ_FAILED;
    result.worst_group = result.worst_element = -1;
    gproji_format(result.message, sizeof result.message, "%s", error->message);
    return result;
}

/* Refuses start values that are not finite: the caller may have written them. */
GPROJI_INTERNAL bool gproji_values_are_valid(gproj_system *s) {
    int32_t v;
    for (v = 0; v < s->variable_count; ++v) {
        if (gproji_is_finite(s->x[v])) continue;
        gproji_fail(&s->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VARIABLE, v, "solve: variable %d is not a finite number",
                    v);
        return false;
    }
    return true;
}

/* Refuses options that mean nothing; that is an error of the call, not of the system. */
GPROJI_INTERNAL bool gproji_options_are_valid(const gproj_system *s, int32_t iterations, const gproj_solve_options *o,
                                              gproj_error *error) {
    bool numbers = gproji_is_finite(o->tolerance) && gproji_is_finite(o->epsilon) && gproji_is_finite(o->time_budget);
    if (iterations >= 0 && numbers && o->tolerance >= 0 && o->epsilon >= 0 && o->time_budget >= 0 &&
        (o->time_budget == 0 || s->host.clock.now))
        return true;
    gproji_fail(
        error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
        "solve: %d iterations, tolerance %g, epsilon %g, time budget %g: none may be negative, and a time budget "
        "needs a clock in the host",
        iterations, o->tolerance, o->epsilon, o->time_budget);
    return false;
}

/* -- the nearest point -- */

/* With options.nearest the loop minimises the wishes on the set where everything holds that must. It looks for x and
   multipliers y of the rows that must hold with
       s^2 sum_wishes w^2 phi g + sum_others w^2 y g = 0,    phi = 0    (bounds: phi >= 0, y <= 0, y phi = 0)        (1)
   by the method of multipliers (Hestenes 1969; Powell 1969; Bertsekas: Constrained Optimization and Lagrange Multiplier
   Methods, 1982). A slide from x along that set:
   - the step minimises the model s^2 |wishes|^2 + |phi + G dx + y|^2 of the augmented Lagrangian; y += phi + G dx, and
     again with the same factor until G dx = -phi;
   - near a solution (small optimality) the matrix also has the curvature sum w^2 y (Hessian of phi), as in Newton's
     method for (1), and a shift of the diagonal where it is not positive definite. Farther away Gauss and Newton's
     matrix is calmer. Rows that a refresh linearises have no curvature that is known here;
   - bounds act by the signs of their multipliers, and are switched by the step that was found;
   - x + t dx is led back to phi = 0 by steps orthogonal to that set, with the same factor;
   - t is the largest of 1, 1/2, ... that lowers the augmented Lagrangian and turns no face over.
   The first iteration is a guided projection and the last ones are plain projections, so that everything holds however
   far the slides came. A small s keeps x close to the set, a large one lets a step go farther. */

static const double gproji_nearest_scale = 0.03;    /* s, for the wish with the largest weight */
static const double gproji_nearest_epsilon = 3e-5;  /* the smallest eps: as in other steps it follows the residual */
static const double gproji_nearest_optimal = 1e-6;  /* enough for convergence */
static const double gproji_nearest_curved = 0.3;    /* below this optimality the matrix has its curvature */
static const double gproji_nearest_shift = 0.1;     /* the first shift, times s^2 */
static const double gproji_nearest_flat = 0.01;     /* a minimum's matrix is positive definite with this shift */
static const double gproji_nearest_symmetry = 1e-3; /* the last guided step's part that breaks symmetries */
enum {
    GPROJI_NEAREST_GUIDED = 1,   /* iterations at the beginning */
    GPROJI_NEAREST_RESTORE = 5,  /* iterations at the end */
    GPROJI_NEAREST_ATTEMPTS = 6, /* factorisations with curvature, before those without */
    GPROJI_NEAREST_ROUNDS = 12,  /* multipliers with one factorisation */
    GPROJI_NEAREST_HALVES = 5,   /* lengths of a step */
    GPROJI_NEAREST_RETRACT = 3   /* steps back to the constraints */
};

/* The weights of slides: wishes keep theirs, whatever their schedules say, scaled so that the largest is `scale`. */
GPROJI_INTERNAL void gproji_set_nearest_weights(gproj_system *s, double scale) {
    double largest = 0;
    int32_t i;
    s->sliding = scale == gproji_nearest_scale;
    for (i = 0; i < s->group_count; ++i)
        if (s->group[i].kind == GPROJ_WISH) largest = gproji_fmax(largest, s->group[i].schedule.weight);
    for (i = 0; i < s->group_count; ++i) {
        gproji_group *g = &s->group[i];
        g->weight = g->schedule.weight;
        if (g->guard && !s->sliding) g->weight = 0;
        if (g->kind == GPROJ_WISH && largest > 0) g->weight *= scale / largest;
    }
}

/* All multipliers are 0. */
GPROJI_INTERNAL bool gproji_start_multipliers(gproj_system *s) {
    int32_t i;
    if (!s->sum) s->sum = (double *)gproji_take(&s->own, (size_t)s->variable_count, sizeof *s->sum);
    if (!s->sum) return false;
    for (i = 0; i < s->group_count; ++i) {
        gproji_group *g = &s->group[i];
        size_t rows = (size_t)g->row_count;
        if (!g->multiplier) g->multiplier = (gproji_multiplier *)gproji_take(&s->own, rows, sizeof *g->multiplier);
        if (!g->multiplier) return false;
        memset(g->multiplier, 0, rows * sizeof *g->multiplier);
    }
    return true;
}

/* Does the row have a multiplier now? */
GPROJI_INTERNAL bool gproji_is_multiplied(const gproji_group *g, const gproji_row *row) {
    return g->kind != GPROJ_WISH && g->weight > 0 && row->weight > 0;
}

/* Before the first solve of a slide: phi + y in place of phi. Rows without a weight forget their multipliers, and so do
   bounds that do not act: their multipliers fall to 0. */
GPROJI_INTERNAL void gproji_add_multipliers(gproj_system *s) {
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i) {
        gproji_group *g = &s->group[i];
        for (r = 0; r < g->row_count; ++r) {
            gproji_row *row = &g->row[r];
            gproji_multiplier *multiplier = &g->multiplier[r];
            if (!gproji_is_multiplied(g, row)) multiplier->y = 0;
            multiplier->rise = row->active ? 0 : -multiplier->y;
            row->phi += multiplier->y;
        }
    }
}

/* After a solve: phi becomes what the model leaves of a constraint, phi + G dx, and y rises by it; wishes are served.
   Returns the sum of w^2 phi^2. */
GPROJI_INTERNAL double gproji_raise_multipliers(gproj_system *s, bool first) {
    double sum = 0;
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i) {
        gproji_group *g = &s->group[i];
        for (r = 0; g->weight > 0 && r < g->row_count; ++r) {
            gproji_row *row = &g->row[r];
            if (!row->active || !gproji_is_multiplied(g, row)) {
                row->phi = 0;
                continue;
            }
            row->phi += gproji_row_times(g, row, s->step) - (first ? g->multiplier[r].y : 0);
            g->multiplier[r].rise += row->phi;
            sum += gproji_weight2(g, row) * row->phi * row->phi;
        }
    }
    return sum;
}

/* Solves for dx and the rise of the multipliers, from rows linearised at x. False when the matrix is not positive
   definite; rows are to be evaluated again after that. */
GPROJI_INTERNAL bool gproji_find_slide(gproji_loop *loop, bool curved, double shift) {
    gproj_system *s = loop->system;
    double *sum = s->sum, first = 0, left = HUGE_VAL;
    int32_t round, v;
    bool factored;
    double follows = gproji_epsilon_max;
    if (curved) follows = gproji_fmin(gproji_fmax(loop->standing.residual, gproji_nearest_epsilon), follows);
    loop->iteration.epsilon = sqrt(follows * follows + gproji_nearest_scale * gproji_nearest_scale * shift);
    gproji_add_multipliers(s);
    gproji_lap(loop, GPROJ_PHASE_ASSEMBLE);
    factored = gproji_factor_matrix(s, loop->iteration.epsilon, curved, 0, NULL);
    loop->iteration.attempts++;
    gproji_lap(loop, GPROJ_PHASE_FACTOR);
    if (!factored) return false;
    memset(sum, 0, (size_t)s->variable_count * sizeof *sum);
    for (round = 0; round < GPROJI_NEAREST_ROUNDS && left > 1e-12 * first; ++round) {
        gproji_merit_gradient(s);
        gproji_solve_step(s);
        for (v = 0; v < s->variable_count; ++v) sum[v] += s->step[v];
        left = gproji_raise_multipliers(s, round == 0);
        if (round == 0) first = left;
    }
    memcpy(s->step, sum, (size_t)s->variable_count * sizeof *sum);
    gproji_lap(loop, GPROJ_PHASE_SOLVE);
    return true;
}

/* Lets bounds act that the model's step would violate, and lets those go whose multipliers would hold the step back
   (y > 0). True: the step must be found again. */
GPROJI_INTERNAL bool gproji_switch_multiplied_bounds(gproj_system *s) {
    bool changed = false;
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->kind == GPROJ_BOUND && r < g->row_count; ++r) {
            gproji_row *row = &g->row[r];
            bool active = false;
            if (gproji_is_multiplied(g, row)) {
                double phi = gproji_row_value(g, r, s->saved) + gproji_row_times(g, row, s->step);
                active = row->active ? g->multiplier[r].y + g->multiplier[r].rise < 0 : !g->guard && phi < -1e-12;
            }
            changed = changed || active != row->active;
            row->active = active;
        }
    }
    return changed;
}

/* Bounds act first where they are violated or have a multiplier. */
GPROJI_INTERNAL void gproji_start_multiplied_bounds(gproj_system *s) {
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->kind == GPROJ_BOUND && r < g->row_count; ++r) {
            gproji_row *row = &g->row[r];
            row->active = gproji_is_multiplied(g, row) && row->phi + g->multiplier[r].y < 0;
        }
    }
}

/* Multipliers of bounds are not positive: what is left of them. */
GPROJI_INTERNAL void gproji_limit_multipliers(gproj_system *s) {
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i)
        for (r = 0; s->group[i].kind == GPROJ_BOUND && r < s->group[i].row_count; ++r) {
            gproji_multiplier *multiplier = &s->group[i].multiplier[r];
            multiplier->rise = gproji_fmin(multiplier->rise, -multiplier->y);
        }
}

/* The rows at x again, with the bounds that act as they are. */
GPROJI_INTERNAL void gproji_evaluate_slide(gproj_system *s) {
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i)
        for (r = 0; s->group[i].weight > 0 && r < s->group[i].row_count; ++r)
            if (s->group[i].row[r].weight > 0) s->group[i].row[r].phi = gproji_row_value(&s->group[i], r, s->x);
}

/* Finds a slide, again where it meets bounds. */
GPROJI_INTERNAL bool gproji_find_bounded_slide(gproji_loop *loop, bool curved, double shift) {
    gproj_system *s = loop->system;
    int32_t round;
    gproji_start_multiplied_bounds(s);
    for (round = 0; gproji_find_slide(loop, curved, shift); ++round) {
        bool again = gproji_switch_multiplied_bounds(s);
        if (!again || round == GPROJI_BOUND_ROUNDS) {
            gproji_limit_multipliers(s);
            return true;
        }
        gproji_evaluate_slide(s);
    }
    return false;
}

/* The augmented Lagrangian sum w^2 (phi^2 + 2 y phi) at x with the risen multipliers, and its slope along the step if
   x is where rows were linearised. A bound's row adds -w^2 y^2 where phi > -y. */
GPROJI_INTERNAL double gproji_lagrangian(const gproj_system *s, const double *x, double *slope) {
    double value = 0;
    int32_t i, r;
    if (slope) *slope = 0;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->weight > 0 && r < g->row_count; ++r) {
            const gproji_row *row = &g->row[r];
            double w2 = gproji_weight2(g, row), y = g->multiplier[r].y + g->multiplier[r].rise, phi;
            if (!(w2 > 0)) continue;
            phi = gproji_row_value(g, r, x);
            if (g->kind == GPROJ_BOUND && phi + y >= 0) {
                value -= w2 * y * y;
                continue;
            }
            value += w2 * phi * (phi + 2 * y);
            if (slope) *slope += 2 * w2 * (phi + y) * gproji_row_times(g, row, s->step);
        }
    }
    return value;
}

/* phi of what must hold and acts at x, without gradients; 0 for other rows. Returns the sum of w^2 phi^2. */
GPROJI_INTERNAL double gproji_evaluate_constraints(gproj_system *s) {
    double sum = 0;
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i) {
        gproji_group *g = &s->group[i];
        for (r = 0; g->weight > 0 && r < g->row_count; ++r) {
            gproji_row *row = &g->row[r];
            row->phi = 0;
            if (row->active && gproji_is_multiplied(g, row)) row->phi = gproji_counted(g, gproji_row_value(g, r, s->x));
            sum += gproji_weight2(g, row) * row->phi * row->phi;
        }
    }
    return sum;
}

/* Leads x back to what must hold with the factor and the gradients of the slide, as long as that works. */
GPROJI_INTERNAL void gproji_retract(gproj_system *s) {
    double before = HUGE_VAL, now = gproji_evaluate_constraints(s);
    int32_t k, v;
    for (k = 0; k < GPROJI_NEAREST_RETRACT && now < 0.5 * before; ++k) {
        before = now;
        gproji_merit_gradient(s);
        gproji_solve_step(s);
        for (v = 0; v < s->variable_count; ++v) s->x[v] += s->step[v];
        now = gproji_evaluate_constraints(s);
        for (v = 0; !(now <= before) && v < s->variable_count; ++v) s->x[v] -= s->step[v];
    }
    memcpy(s->step, s->sum, (size_t)s->variable_count * sizeof *s->step);
}

/* Takes the longest part of the step that lowers the augmented Lagrangian, at least 1/2^(halves - 1) of it. False: none
   does, x is as before. */
GPROJI_INTERNAL bool gproji_take_slide(gproji_loop *loop, int32_t halves) {
    gproj_system *s = loop->system;
    double slope, before = gproji_lagrangian(s, s->saved, &slope), after, t = 1;
    int32_t i, r;
    for (; halves > 0; --halves, t /= 2) {
        loop->iteration.step = gproji_take_step(s, t);
        if (!(loop->iteration.step <= DBL_MAX)) break;
        gproji_retract(s);
        after = gproji_lagrangian(s, s->x, NULL);
        if (!(after <= DBL_MAX)) continue;
        if (loop->iteration.step > 1e-7 && after > before + 0.1 * t * slope) continue; /* below, rounding decides */
        if (s->refuse_step && s->refuse_step(s->refuse_user, s)) continue;
        loop->iteration.length = t;
        for (i = 0; i < s->group_count; ++i)
            for (r = 0; r < s->group[i].row_count; ++r)
                s->group[i].multiplier[r].y += t * s->group[i].multiplier[r].rise;
        return true;
    }
    gproji_step_back(s);
    return false;
}

/* The first shift to try after a slide that had this one. */
GPROJI_INTERNAL void gproji_next_shift(gproji_loop *loop, double shift) {
    loop->shift = shift;
    if (loop->iteration.length == 1) loop->shift = shift < gproji_nearest_flat ? 0 : shift / 3;
    if (loop->iteration.length < 0.5) loop->shift = 1.5 * shift;
}

/* One slide from a linearised x. False when no attempt was good; x is then as before. */
GPROJI_INTERNAL bool gproji_slide(gproji_loop *loop) {
    gproj_system *s = loop->system;
    bool curved = loop->iteration.optimality < gproji_nearest_curved;
    double shift = curved ? loop->shift : 0;
    if (s->variable_count) memcpy(s->saved, s->x, (size_t)s->variable_count * sizeof *s->x);
    for (loop->iteration.attempts = 0; loop->iteration.attempts < GPROJI_NEAREST_ATTEMPTS + 4;) {
        if (gproji_find_bounded_slide(loop, curved, shift) &&
            gproji_take_slide(loop, curved ? 3 : GPROJI_NEAREST_HALVES)) {
            loop->minimum = curved && shift <= gproji_nearest_flat;
            if (curved) gproji_next_shift(loop, shift);
            gproji_lap(loop, GPROJ_PHASE_SOLVE);
            return true;
        }
        gproji_lap(loop, GPROJ_PHASE_SOLVE);
        gproji_evaluate(s);
        shift = gproji_fmax(3 * shift, gproji_nearest_shift);
        if (curved && loop->iteration.attempts == GPROJI_NEAREST_ATTEMPTS) {
            loop->shift = shift;
            curved = false;
            shift = 0;
        }
    }
    return false;
}

/* How far (1) is from holding at x, for y as it is: the norm of the left side over that of its wishes' part, row by
   row. The smallest over all y would be the norm of the gradient projected to the tangent space of what must hold. */
GPROJI_INTERNAL double gproji_optimality(gproj_system *s) {
    double wishes = 0, left = 0;
    int64_t l;
    int32_t i, r, rows = 0;
    memset(s->gradient, 0, (size_t)s->variable_count * sizeof *s->gradient);
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; g->weight > 0 && r < g->row_count; ++r) {
            const gproji_row *row = &g->row[r];
            bool wish = g->kind == GPROJ_WISH;
            double pull = gproji_weight2(g, row) * (wish ? row->phi : g->multiplier[r].y);
            gproji_row_add(g, row, pull, s->gradient);
            rows += wish;
            for (l = row->local; wish && l < row[1].local; ++l)
                wishes += pull * pull * g->local_gradient[l] * g->local_gradient[l];
        }
    }
    for (i = 0; i < s->variable_count; ++i) left += s->gradient[i] * s->gradient[i];
    if (rows == 0) return 0;
    if (!(left <= DBL_MAX) || !(wishes <= DBL_MAX)) return HUGE_VAL;
    return sqrt(left / gproji_fmax(wishes, 1e-12 * gproji_nearest_scale * gproji_nearest_scale * gproji_nearest_scale *
                                               gproji_nearest_scale * (1 + (double)rows)));
}

/* Rows, standing and optimality at x with the weights of slides; energies as the schedules weigh them. */
GPROJI_INTERNAL void gproji_see_nearest(gproji_loop *loop) {
    gproj_system *s = loop->system;
    double factor = 1;
    int32_t i;
    gproji_set_nearest_weights(s, gproji_nearest_scale);
    gproji_linearise(loop);
    loop->iteration.optimality = loop->result.optimality = gproji_optimality(s);
    for (i = 0; i < s->group_count; ++i)
        if (s->group[i].kind == GPROJ_WISH && s->group[i].weight > 0)
            factor = s->group[i].schedule.weight / s->group[i].weight;
    loop->standing.merit += loop->standing.energy * (factor * factor - 1);
    loop->standing.energy *= factor * factor;
}

/* Moves x by at most `size`, to and fro in an order without symmetry, always the same: symmetric meshes would stay on a
   saddle, where a symmetric step cannot leave it. */
GPROJI_INTERNAL void gproji_break_symmetry(gproj_system *s, double size) {
    uint32_t state = 1;
    int32_t v;
    for (v = 0; v < s->variable_count; ++v) {
        state = state * 1664525u + 1013904223u;
        s->x[v] += size * ((double)(state >> 8) / 8388608.0 - 1);
    }
}

/* Iteration n of a nearest solve that slides until `last`. False: nothing can be done. */
GPROJI_INTERNAL bool gproji_iterate_nearest(gproji_loop *loop, int32_t n, int32_t guided, int32_t last) {
    gproj_system *s = loop->system;
    int32_t i;
    if (n > guided && n <= last && gproji_slide(loop)) return true;
    if (n > guided && gproji_holds(loop)) return false;
    gproji_set_nearest_weights(s, n <= guided ? 0.999 * gproji_nearest_scale : 0);
    for (i = 0; i < s->group_count; ++i)
        if (s->group[i].guard && n <= guided) s->group[i].weight = gproji_weight_in(s, &s->group[i], n);
    gproji_linearise(loop);
    if (!gproji_iterate(loop)) return false;
    if (n == guided) gproji_break_symmetry(s, gproji_nearest_symmetry * loop->iteration.step);
    return true;
}

/* Do the constraints hold at a minimum of the wishes? */
GPROJI_INTERNAL bool gproji_is_nearest(const gproji_loop *loop) {
    double optimality = loop->iteration.optimality;
    return gproji_holds(loop) && (optimality == 0 || (loop->minimum && optimality <= gproji_nearest_optimal));
}

/* The iterations; returns how they ended. */
GPROJI_INTERNAL gproj_outcome gproji_run_nearest(gproji_loop *loop, int32_t iterations) {
    gproj_system *s = loop->system;
    int32_t half = iterations / 2 + iterations % 2, n;
    int32_t guided = gproji_min(GPROJI_NEAREST_GUIDED, (iterations + 2) / 3);
    int32_t last = iterations - gproji_min(GPROJI_NEAREST_RESTORE, iterations / 3);
    s->late = 0;
    if (!gproji_start_multipliers(s)) {
        gproji_fail_memory(&s->error);
        return GPROJ_FAILED;
    }
    gproji_see_nearest(loop);
    gproji_start_bounds(s);
    for (n = 1; n <= iterations; ++n) {
        if (s->error.code != GPROJ_OK) return GPROJ_FAILED;
        if (gproji_is_nearest(loop)) return GPROJ_CONVERGED;
        if (gproji_is_out_of_time(loop)) return GPROJ_TIME_OUT;
        memset(loop->iteration.seconds, 0, sizeof loop->iteration.seconds);
        s->late = n <= half ? 0 : s->late + 1;
        if (!gproji_iterate_nearest(loop, n, guided, last)) return n > last ? GPROJ_ITERATION_LIMIT : GPROJ_STALLED;
        gproji_see_nearest(loop);
        gproji_report_iteration(loop, n);
        if (!gproji_call_back(loop)) return GPROJ_CANCELLED;
        if (s->changed) gproji_see_nearest(loop);
    }
    if (s->error.code != GPROJ_OK) return GPROJ_FAILED;
    return gproji_is_nearest(loop) ? GPROJ_CONVERGED : GPROJ_ITERATION_LIMIT;
}

/* The verdict's sentence where the constraints hold, and how near the nearest is. */
GPROJI_INTERNAL void gproji_write_nearest_verdict(gproji_loop *loop) {
    gproj_result *r = &loop->result;
    const char *plural = r->iterations == 1 ? "" : "s", *more = "";
    char figure[64];
    if (!gproji_holds(loop) || r->worst_group < 0) {
        gproji_format(figure, sizeof figure, "; projected gradient of the wishes %g", r->optimality);
        gproji_append(r->message, sizeof r->message, strlen(r->message), figure, strlen(figure));
        return;
    }
    if (r->outcome == GPROJ_CONVERGED) more = ", at a minimum of the wishes";
    if (r->outcome == GPROJ_ITERATION_LIMIT) more = ", but more iterations would serve the wishes better";
    if (r->outcome == GPROJ_STALLED) more = ", and no step serves the wishes better";
    if (r->outcome == GPROJ_CANCELLED) more = ", cancelled by the caller";
    if (r->outcome == GPROJ_TIME_OUT) more = ", but the time budget ran out before a minimum of the wishes";
    gproji_format(r->message, sizeof r->message,
                  "%s%s: %d iteration%s, largest residual %g (%s), projected gradient of the wishes %g",
                  gproji_outcome_string(GPROJ_CONVERGED), more, r->iterations, plural, r->residual,
                  loop->system->group[r->worst_group].name, r->optimality);
}

GPROJ_API gproj_result gproj_system_solve(gproj_system *s, int32_t iterations, const gproj_solve_options *options) {
    gproji_loop loop;
    gproj_error refused;
    if (!gproji_system_is_open(s)) return gproji_failed_result(gproj_system_error(s));
    memset(&loop, 0, sizeof loop);
    loop.system = s;
    if (options) loop.options = *options;
    gproji_error_clear(&refused);
    if (!gproji_options_are_valid(s, iterations, &loop.options, &refused)) return gproji_failed_result(&refused);
    if (!gproji_values_are_valid(s)) return gproji_failed_result(&s->error);
    loop.epsilon_least = gproji_epsilon_min;
    loop.started = loop.lap = gproji_now(s);
    if (gproji_compile(s) != GPROJ_OK) return gproji_failed_result(&s->error);
    gproji_lap(&loop, GPROJ_PHASE_ANALYSE);
    s->solving = true;
    loop.result.outcome =
        loop.options.nearest ? gproji_run_nearest(&loop, iterations) : gproji_run_loop(&loop, iterations);
    s->solving = s->sliding = false;
    if (s->error.code != GPROJ_OK) return gproji_failed_result(&s->error);
    gproji_write_verdict(&loop);
    if (loop.options.nearest) gproji_write_nearest_verdict(&loop);
    return loop.result;
}

/* The v-th of the variables that a row names, two a term; -1 where a linear term has no second one. */
GPROJI_INLINE int32_t gproji_named_variable(const gproji_group *g, int32_t r, int64_t v) {
    return gproji_variable_of(g, &g->row[r], v % 2 ? g->term[v / 2].j : g->term[v / 2].i);
}

/* The largest difference of a row's gradient and central differences, relative to its largest entry and at least 1.
   `gradient`: work, one number a variable, zeros on entry and on exit. */
GPROJI_INTERNAL double gproji_check_row(gproj_system *s, const gproji_group *g, int32_t r, double *gradient) {
    int64_t first = 2 * g->row[r].term, end = 2 * g->row[r + 1].term, k;
    double size = 1, worst = 0;
    gproji_row_gradient(g, r, s->x, gradient);
    for (k = first; k < end; ++k) {
        int32_t v = gproji_named_variable(g, r, k);
        if (v >= 0) size = gproji_fmax(size, fabs(gradient[v]));
    }
    for (k = first; k < end; ++k) {
        int32_t v = gproji_named_variable(g, r, k);
        double x, h, up, down, difference;
        if (v < 0) continue;
        x = s->x[v];
        h = 1e-5 * gproji_fmax(1, fabs(x));
        s->x[v] = x + h;
        up = gproji_row_value(g, r, s->x);
        s->x[v] = x - h;
        down = gproji_row_value(g, r, s->x);
        s->x[v] = x;
        difference = fabs((up - down) / (2 * h) - gradient[v]) / size;
        worst = difference <= DBL_MAX ? gproji_fmax(worst, difference) : HUGE_VAL;
    }
    for (k = first; k < end; ++k)
        if (gproji_named_variable(g, r, k) >= 0) gradient[gproji_named_variable(g, r, k)] = 0;
    return worst;
}

GPROJ_API double gproj_system_check_gradients(gproj_system *s) {
    double worst = 0, *gradient;
    int32_t i, r;
    size_t n;
    if (!gproji_system_is_open(s)) return HUGE_VAL;
    n = (size_t)s->variable_count;
    gradient = (double *)gproji_take_zeroed(&s->own, n, sizeof *gradient);
    if (!gradient) {
        gproji_fail_memory(&s->error);
        return HUGE_VAL;
    }
    s->solving = true;
    gproji_set_weights(s, 1);
    gproji_refresh_groups(s);
    s->solving = false;
    for (i = 0; i < s->group_count; ++i)
        for (r = 0; r < s->group[i].row_count; ++r)
            worst = gproji_fmax(worst, gproji_check_row(s, &s->group[i], r, gradient));
    gproji_give(&s->own, gradient, n, sizeof *gradient);
    return s->error.code == GPROJ_OK ? worst : HUGE_VAL;
}
/* ============================================================================================================
   >>mesh   Half-edge meshes of any polygons. Uses platform, memory, error, vector.

   The half-edge structure is Mantyla's (1988) in the array form that is usual today: half-edges 2e and 2e + 1 are
   twins, edges are numbered as they first appear along the faces. Equal edges are found by counting sort on their
   smaller vertex and a table of the larger one: linear time and no hashing, so the result depends on the input
   alone. A mesh is built in steps, each a function below: check, match, orient, link, fans, loops.
   Invariants of a finished mesh: twin[h] = h ^ 1; next and prev are inverse permutations that keep `face`;
   origin[next[h]] = origin[twin[h]]; at most one outgoing half-edge of a vertex has face -1, and if there is one it
   is vertex_halfedge; the faces of a vertex form one fan. */

/* Coordinates beyond this are refused, so that squared areas do not overflow. */
#define GPROJI_COORDINATE_MAX 1e70
/* 3 * vertices and 2 * (corners of all faces) must be int32_t. */
enum {
    GPROJI_VERTICES_MAX = INT32_MAX / 3 - 1,
    GPROJI_CORNERS_MAX = INT32_MAX / 2 - 1
};

/* The owner of a gproj_mesh. The arrays are those that `mesh` shows read-only; their lengths follow from its counts. */
typedef struct gproji_mesh_object {
    gproji_heap heap; /* first: see gproji_create_object */
    gproj_mesh mesh;
    int32_t *vertex_halfedge;
    int32_t *face_halfedge;
    int32_t *face_degree;
    int32_t *loop_halfedge;
    int32_t *halfedge; /* 6 * halfedge_count: twin, next, prev, origin, face, edge one after the other */
    int32_t *polyline_start;
    int32_t *polyline_vertex;
} gproji_mesh_object;

GPROJI_INLINE gproji_mesh_object *gproji_mesh_owner(gproj_mesh *mesh) {
    return (gproji_mesh_object *)(void *)((char *)mesh - offsetof(gproji_mesh_object, mesh));
}

/* Polygons as they come: the builder's input. */
typedef struct gproji_soup {
    int32_t vertex_count;
    int32_t face_count;
    int32_t corner_count;
    const double *position;
    const int32_t *face_degree;
    const int32_t *face_vertex;
} gproji_soup;

/* The work arrays of the builder, all given back before it returns. */
typedef struct gproji_mesh_work {
    int32_t *corner_vertex; /* corner_count: face_vertex, with faces turned round where they were against the others */
    int32_t *corner_face;   /* corner_count: the face of each corner */
    int32_t *corner_next;   /* corner_count: the next corner of the same face */
    int32_t *corner_edge;   /* corner_count: the edge from this corner's vertex to the next one's */
    int32_t *corner_order;  /* corner_count: the corners sorted by the smaller vertex of their edge; later a queue */
    int32_t *edge_corner;   /* 2 * corner_count: the corners of each edge, the second -1 at the boundary */
    int32_t *face_start;    /* face_count + 1: the first corner of each face */
    int32_t *face_state;    /* face_count: -1 not reached, 0 as it came, 1 to be turned round */
    int32_t *mark;          /* vertex_count: the last element that touched a vertex, -1 at the start of each step */
    int32_t *slot; /* vertex_count + 1: counters and starts of the counting sort, then edges by larger vertex */
} gproji_mesh_work;

GPROJI_INTERNAL void gproji_mesh_work_give(gproji_heap *heap, gproji_mesh_work *work, const gproji_soup *soup) {
    size_t corners = (size_t)soup->corner_count, faces = (size_t)soup->face_count,
           vertices = (size_t)soup->vertex_count;
    gproji_give(heap, work->corner_vertex, corners, sizeof(int32_t));
    gproji_give(heap, work->corner_face, corners, sizeof(int32_t));
    gproji_give(heap, work->corner_next, corners, sizeof(int32_t));
    gproji_give(heap, work->corner_edge, corners, sizeof(int32_t));
    gproji_give(heap, work->corner_order, corners, sizeof(int32_t));
    gproji_give(heap, work->edge_corner, corners, 2 * sizeof(int32_t));
    gproji_give(heap, work->face_start, faces + 1, sizeof(int32_t));
    gproji_give(heap, work->face_state, faces, sizeof(int32_t));
    gproji_give(heap, work->mark, vertices, sizeof(int32_t));
    gproji_give(heap, work->slot, vertices + 1, sizeof(int32_t));
    memset(work, 0, sizeof *work);
}

/* False when there is no memory; what was taken is given back by gproji_mesh_work_give. */
GPROJI_INTERNAL bool gproji_mesh_work_take(gproji_heap *heap, gproji_mesh_work *work, const gproji_soup *soup) {
    size_t corners = (size_t)soup->corner_count, faces = (size_t)soup->face_count,
           vertices = (size_t)soup->vertex_count;
    memset(work, 0, sizeof *work);
    return (work->corner_vertex = (int32_t *)gproji_take(heap, corners, sizeof(int32_t))) != NULL &&
           (work->corner_face = (int32_t *)gproji_take(heap, corners, sizeof(int32_t))) != NULL &&
           (work->corner_next = (int32_t *)gproji_take(heap, corners, sizeof(int32_t))) != NULL &&
           (work->corner_edge = (int32_t *)gproji_take(heap, corners, sizeof(int32_t))) != NULL &&
           (work->corner_order = (int32_t *)gproji_take(heap, corners, sizeof(int32_t))) != NULL &&
           (work->edge_corner = (int32_t *)gproji_take(heap, corners, 2 * sizeof(int32_t))) != NULL &&
           (work->face_start = (int32_t *)gproji_take(heap, faces + 1, sizeof(int32_t))) != NULL &&
           (work->face_state = (int32_t *)gproji_take(heap, faces, sizeof(int32_t))) != NULL &&
           (work->mark = (int32_t *)gproji_take(heap, vertices, sizeof(int32_t))) != NULL &&
           (work->slot = (int32_t *)gproji_take(heap, vertices + 1, sizeof(int32_t))) != NULL;
}

GPROJI_INLINE void gproji_fill(int32_t *array, int32_t count, int32_t value) {
    int32_t i;
    for (i = 0; i < count; ++i) array[i] = value;
}

/* -- the checks -- */

GPROJI_INTERNAL gproj_code gproji_check_positions(int32_t count, const double *position, const char *what,
                                                  gproj_error *error) {
    int32_t i, k;
    for (i = 0; i < count; ++i) {
        for (k = 0; k < 3; ++k) {
            double x = position[3 * i + k];
            const char *axis = k == 0 ? "x" : (k == 1 ? "y" : "z");
            if (!gproji_is_finite(x)) {
                return gproji_fail(error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, i,
                                   "coordinate %s of %s %d is %g; give it a finite value", axis, what, i, x);
            }
            if (x > GPROJI_COORDINATE_MAX || x < -GPROJI_COORDINATE_MAX) {
                return gproji_fail(error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, i,
                                   "coordinate %s of %s %d is %g, beyond 1e70; use a larger unit of length", axis, what,
                                   i, x);
            }
        }
    }
    return GPROJ_OK;
}

/* Degrees and their sum, before any corner is read. Sets corner_count. */
GPROJI_INTERNAL gproj_code gproji_check_degrees(gproji_soup *soup, gproj_error *error) {
    int64_t sum = 0;
    int32_t f;
    for (f = 0; f < soup->face_count; ++f) {
        if (soup->face_degree[f] < 3) {
            return gproji_fail(error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_FACE, f,
                               "face %d has %d corners; a face needs at least 3", f, soup->face_degree[f]);
        }
        sum += soup->face_degree[f];
        if (sum > GPROJI_CORNERS_MAX) {
            return gproji_fail(error, GPROJ_ERROR_SIZE, GPROJ_PLACE_FACE, f,
                               "the faces up to face %d have more than %d corners; split the mesh", f,
                               (int32_t)GPROJI_CORNERS_MAX);
        }
    }
    soup->corner_count = (int32_t)sum;
    return GPROJ_OK;
}

/* Indices in range, no vertex twice in a face; fills the corner arrays. */
GPROJI_INTERNAL gproj_code gproji_mesh_read_corners(const gproji_soup *soup, gproji_mesh_work *work,
                                                    gproj_error *error) {
    int32_t f, k, c = 0;
    gproji_fill(work->mark, soup->vertex_count, -1);
    for (f = 0; f < soup->face_count; ++f) {
        work->face_start[f] = c;
        for (k = 0; k < soup->face_degree[f]; ++k, ++c) {
            int32_t v = soup->face_vertex[c];
            if (v < 0 || v >= soup->vertex_count) {
                return gproji_fail(error, GPROJ_ERROR_INDEX, GPROJ_PLACE_FACE, f,
                                   "face %d names vertex %d, but the vertices are 0 to %d", f, v,
                                   soup->vertex_count - 1);
            }
            if (work->mark[v] == f) {
                return gproji_fail(error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_FACE, f,
                                   "face %d names vertex %d twice; name each corner once, or split the face there", f,
                                   v);
            }
            work->mark[v] = f;
            work->corner_vertex[c] = v;
            work->corner_face[c] = f;
            work->corner_next[c] = c + 1;
        }
        work->corner_next[c - 1] = work->face_start[f];
    }
    work->face_start[soup->face_count] = c;
    return GPROJ_OK;
}

/* -- edges -- */

GPROJI_INLINE int32_t gproji_corner_head(const gproji_mesh_work *work, int32_t c) {
    return work->corner_vertex[work->corner_next[c]];
}

GPROJI_INTERNAL gproj_code gproji_fail_edge(const gproji_soup *soup, const gproji_mesh_work *work, int32_t corner,
                                            gproj_error *error) {
    int32_t a = work->corner_vertex[corner], b = gproji_corner_head(work, corner), faces[3] = {0, 0, 0}, count = 0, c;
    for (c = 0; c < soup->corner_count; ++c) {
        int32_t u = work->corner_vertex[c], v = gproji_corner_head(work, c);
        if ((u != a || v != b) && (u != b || v != a)) continue;
        if (count < 3) faces[count] = work->corner_face[c];
        ++count;
    }
    return gproji_fail(
        error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, faces[2],
        "edge %d-%d has %d faces (%d, %d%s %d%s); split the mesh there or remove faces until two are left",
        gproji_min(a, b), gproji_max(a, b), count, faces[0], faces[1], count > 3 ? "," : " and", faces[2],
        count > 3 ? ", ..." : "");
}

/* Sorts the corners by the smaller vertex of their edge, keeping their order within a vertex (counting sort). On return
   slot[v]..slot[v + 1] - 1 are the places of v in corner_order. */
GPROJI_INTERNAL void gproji_mesh_sort_corners(const gproji_soup *soup, gproji_mesh_work *work) {
    int32_t c, v, sum = 0, count;
    memset(work->slot, 0, ((size_t)soup->vertex_count + 1) * sizeof(int32_t));
    for (c = 0; c < soup->corner_count; ++c) {
        work->slot[gproji_min(work->corner_vertex[c], gproji_corner_head(work, c))]++;
    }
    for (v = 0; v <= soup->vertex_count; ++v) {
        count = work->slot[v];
        work->slot[v] = sum;
        sum += count;
    }
    for (c = 0; c < soup->corner_count; ++c) {
        work->corner_order[work->slot[gproji_min(work->corner_vertex[c], gproji_corner_head(work, c))]++] = c;
    }
}

/* Numbers the edges in the order in which they first appear along the faces: fills corner_edge and edge_corner. */
GPROJI_INTERNAL gproj_code gproji_mesh_match(const gproji_soup *soup, gproji_mesh_work *work, int32_t *edge_count,
                                             gproj_error *error) {
    int32_t i, c, edges = 0, third = -1;
    gproji_mesh_sort_corners(soup, work);
    /* 1. corner_edge[c] = the first corner with the same two vertices. slot[b] is that corner for the edge a-b while
       the corners of the smaller vertex a are passed, which mark[b] = a says. */
    gproji_fill(work->mark, soup->vertex_count, -1);
    for (i = 0; i < soup->corner_count; ++i) {
        int32_t u, v, a, b;
        c = work->corner_order[i];
        u = work->corner_vertex[c], v = gproji_corner_head(work, c);
        a = gproji_min(u, v), b = gproji_max(u, v);
        if (work->mark[b] != a) {
            work->mark[b] = a;
            work->slot[b] = c;
        }
        work->corner_edge[c] = work->slot[b];
    }
    /* 2. Number those in order, and give the others their edge. */
    for (c = 0; c < soup->corner_count; ++c) {
        int32_t first = work->corner_edge[c], e;
        if (first == c) {
            work->corner_edge[c] = edges;
            work->edge_corner[2 * edges] = c;
            work->edge_corner[2 * edges + 1] = -1;
            ++edges;
            continue;
        }
        e = work->corner_edge[first];
        work->corner_edge[c] = e;
        if (work->edge_corner[2 * e + 1] < 0)
            work->edge_corner[2 * e + 1] = c;
        else if (third < 0)
            third = c;
    }
    *edge_count = edges;
    return third < 0 ? GPROJ_OK : gproji_fail_edge(soup, work, third, error);
}

/* -- orientation -- */

/* Reaches all faces of the first face's component and decides which must be turned round. `queue` has room for all
   faces. */
GPROJI_INTERNAL gproj_code gproji_mesh_orient_component(gproji_mesh_work *work, int32_t first, int32_t *queue,
                                                        gproj_error *error) {
    int32_t head = 0, tail = 0, c;
    queue[tail++] = first;
    work->face_state[first] = 0;
    while (head < tail) {
        int32_t f = queue[head++];
        for (c = work->face_start[f]; c < work->face_start[f + 1]; ++c) {
            int32_t e = work->corner_edge[c], other = work->edge_corner[2 * e], g, state;
            if (other == c) other = work->edge_corner[2 * e + 1];
            if (other < 0) continue;
            g = work->corner_face[other];
            /* neighbours agree when they run along their edge in opposite directions */
            state = work->face_state[f] ^ (work->corner_vertex[other] == work->corner_vertex[c] ? 1 : 0);
            if (work->face_state[g] < 0) {
                work->face_state[g] = state;
                queue[tail++] = g;
            } else if (work->face_state[g] != state) {
                return gproji_fail(error, GPROJ_ERROR_NON_ORIENTABLE, GPROJ_PLACE_FACE, g,
                                   "faces %d and %d cannot agree on an outer side at their edge %d-%d, as on a Moebius "
                                   "strip; cut the mesh open there",
                                   gproji_min(f, g), gproji_max(f, g), work->corner_vertex[c],
                                   gproji_corner_head(work, c));
            }
        }
    }
    return GPROJ_OK;
}

/* Turns a face's corners round; the first one stays. */
GPROJI_INTERNAL void gproji_mesh_turn_face(gproji_mesh_work *work, int32_t f) {
    int32_t i = work->face_start[f] + 1, j = work->face_start[f + 1] - 1, v;
    for (; i < j; ++i, --j) {
        v = work->corner_vertex[i];
        work->corner_vertex[i] = work->corner_vertex[j];
        work->corner_vertex[j] = v;
    }
}

/* Makes all faces of each component agree with its first one. Turned faces change the order of the corners, so the
   edges must then be matched again. */
GPROJI_INTERNAL gproj_code gproji_mesh_orient(const gproji_soup *soup, gproji_mesh_work *work, gproj_mesh *mesh,
                                              gproj_error *error) {
    int32_t f;
    gproj_code code;
    gproji_fill(work->face_state, soup->face_count, -1);
    for (f = 0; f < soup->face_count; ++f) {
        if (work->face_state[f] >= 0) continue;
        code = gproji_mesh_orient_component(work, f, work->corner_order, error);
        if (code) return code;
        mesh->component_count++;
    }
    for (f = 0; f < soup->face_count; ++f) {
        if (!work->face_state[f]) continue;
        gproji_mesh_turn_face(work, f);
        mesh->reoriented_count++;
    }
    return GPROJ_OK;
}

/* -- half-edges -- */

/* Takes the arrays that last; false when there is no memory. */
GPROJI_INTERNAL bool gproji_mesh_take(gproji_mesh_object *object) {
    gproj_mesh *mesh = &object->mesh;
    size_t vertices = (size_t)mesh->vertex_count, faces = (size_t)mesh->face_count;
    mesh->position = (double *)gproji_take(&object->heap, vertices, 3 * sizeof(double));
    object->vertex_halfedge = (int32_t *)gproji_take(&object->heap, vertices, sizeof(int32_t));
    object->face_halfedge = (int32_t *)gproji_take(&object->heap, faces, sizeof(int32_t));
    object->face_degree = (int32_t *)gproji_take(&object->heap, faces, sizeof(int32_t));
    object->halfedge = (int32_t *)gproji_take(&object->heap, (size_t)mesh->halfedge_count, 6 * sizeof(int32_t));
    return mesh->position && object->vertex_halfedge && object->face_halfedge && object->face_degree &&
           object->halfedge;
}

/* Shows the owner's arrays in the public struct. */
GPROJI_INTERNAL void gproji_mesh_publish(gproji_mesh_object *object) {
    gproj_mesh *mesh = &object->mesh;
    size_t n = (size_t)mesh->halfedge_count;
    mesh->vertex_halfedge = object->vertex_halfedge;
    mesh->face_halfedge = object->face_halfedge;
    mesh->face_degree = object->face_degree;
    mesh->loop_halfedge = object->loop_halfedge;
    mesh->twin = object->halfedge;
    mesh->next = object->halfedge + n;
    mesh->prev = object->halfedge + 2 * n;
    mesh->origin = object->halfedge + 3 * n;
    mesh->face = object->halfedge + 4 * n;
    mesh->edge = object->halfedge + 5 * n;
    mesh->polyline_start = object->polyline_start;
    mesh->polyline_vertex = object->polyline_vertex;
}

/* The half-edge of corner c: the even one where the edge appeared first. */
GPROJI_INLINE int32_t gproji_corner_halfedge(const gproji_mesh_work *work, int32_t c) {
    int32_t e = work->corner_edge[c];
    return work->edge_corner[2 * e] == c ? 2 * e : 2 * e + 1;
}

/* Fills twin, origin, face, edge, and next and prev within faces. Boundary half-edges get next = prev = -1. */
GPROJI_INTERNAL void gproji_mesh_link_faces(gproji_mesh_object *object, const gproji_mesh_work *work) {
    const gproj_mesh *mesh = &object->mesh;
    int32_t n = mesh->halfedge_count, h, f, c;
    int32_t *twin = object->halfedge, *next = twin + n, *prev = next + n, *origin = prev + n, *face = origin + n,
            *edge = face + n;
    for (h = 0; h < n; ++h) {
        twin[h] = h ^ 1;
        edge[h] = h / 2;
        next[h] = prev[h] = face[h] = -1;
    }
    for (f = 0; f < mesh->face_count; ++f) {
        object->face_degree[f] = work->face_start[f + 1] - work->face_start[f];
        object->face_halfedge[f] = gproji_corner_halfedge(work, work->face_start[f]);
        for (c = work->face_start[f]; c < work->face_start[f + 1]; ++c) {
            int32_t following = gproji_corner_halfedge(work, work->corner_next[c]);
            h = gproji_corner_halfedge(work, c);
            next[h] = following;
            prev[following] = h;
            face[h] = f;
            origin[h] = work->corner_vertex[c];
            origin[h ^ 1] = gproji_corner_head(work, c); /* written again by the face on the other side, if any */
        }
    }
}

GPROJI_INTERNAL gproj_code gproji_fail_fans(int32_t vertex, gproj_error *error) {
    return gproji_fail(
        error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_VERTEX, vertex,
        "the faces at vertex %d form more than one fan, as where two cones touch; give each fan a vertex "
        "of its own",
        vertex);
}

/* Chooses vertex_halfedge: the boundary half-edge, else the first outgoing one. Links the boundary. A second outgoing
   boundary half-edge is a second fan. */
GPROJI_INTERNAL gproj_code gproji_mesh_link_boundary(gproji_mesh_object *object, gproj_error *error) {
    const gproj_mesh *mesh = &object->mesh;
    int32_t n = mesh->halfedge_count, h;
    int32_t *next = object->halfedge + n, *prev = next + n, *out = object->vertex_halfedge;
    const int32_t *origin = prev + n, *face = origin + n;
    gproji_fill(out, mesh->vertex_count, -1);
    for (h = 0; h < n; ++h) {
        int32_t v = origin[h];
        if (out[v] < 0) {
            out[v] = h;
        } else if (face[h] < 0) {
            if (face[out[v]] < 0) return gproji_fail_fans(v, error);
            out[v] = h;
        }
    }
    for (h = 0; h < n; ++h) {
        if (face[h] >= 0) continue;
        next[h] = out[origin[h ^ 1]];
        prev[next[h]] = h;
    }
    return GPROJ_OK;
}

/* The outgoing half-edge that follows h around its origin, counter-clockwise. */
GPROJI_INLINE int32_t gproji_rotate(const gproj_mesh *mesh, int32_t h) { return mesh->prev[h] ^ 1; }

/* All outgoing half-edges of a vertex are met by rotating: else there are several fans. `outgoing` has an entry a
   vertex. */
GPROJI_INTERNAL gproj_code gproji_mesh_check_fans(gproj_mesh *mesh, int32_t *outgoing, gproj_error *error) {
    int32_t v, h;
    memset(outgoing, 0, (size_t)mesh->vertex_count * sizeof(int32_t));
    for (h = 0; h < mesh->halfedge_count; ++h) outgoing[mesh->origin[h]]++;
    for (v = 0; v < mesh->vertex_count; ++v) {
        int32_t start = mesh->vertex_halfedge[v], met = 0;
        if (start < 0) {
            mesh->isolated_count++;
            continue;
        }
        h = start;
        do {
            ++met;
            h = gproji_rotate(mesh, h);
        } while (h != start);
        if (met != outgoing[v]) return gproji_fail_fans(v, error);
    }
    return GPROJ_OK;
}

/* Passes through the boundary loops in the order of their lowest half-edges; writes one of each to `loop` unless that
   is NULL. `seen` has an entry a vertex: a vertex is in one loop at most. Returns their number. */
GPROJI_INTERNAL int32_t gproji_mesh_loops(const gproj_mesh *mesh, int32_t *seen, int32_t *loop) {
    int32_t h, i, count = 0;
    gproji_fill(seen, mesh->vertex_count, 0);
    for (h = 0; h < mesh->halfedge_count; ++h) {
        if (mesh->face[h] >= 0 || seen[mesh->origin[h]]) continue;
        for (i = h; !seen[mesh->origin[i]]; i = mesh->next[i]) seen[mesh->origin[i]] = 1;
        if (loop) loop[count] = h;
        ++count;
    }
    return count;
}

/* -- building -- */

/* From matched and oriented corners to the finished mesh. */
GPROJI_INTERNAL gproj_code gproji_mesh_finish(gproji_mesh_object *object, const gproji_soup *soup,
                                              gproji_mesh_work *work, gproj_error *error) {
    gproj_mesh *mesh = &object->mesh;
    gproj_code code;
    if (!gproji_mesh_take(object)) return gproji_fail_memory(error);
    memcpy(mesh->position, soup->position, (size_t)soup->vertex_count * 3 * sizeof(double));
    gproji_mesh_link_faces(object, work);
    code = gproji_mesh_link_boundary(object, error);
    if (code) return code;
    gproji_mesh_publish(object);
    code = gproji_mesh_check_fans(mesh, work->mark, error);
    if (code) return code;
    mesh->loop_count = gproji_mesh_loops(mesh, work->mark, NULL);
    object->loop_halfedge = (int32_t *)gproji_take(&object->heap, (size_t)mesh->loop_count, sizeof(int32_t));
    if (!object->loop_halfedge) return gproji_fail_memory(error);
    gproji_mesh_loops(mesh, work->mark, object->loop_halfedge);
    gproji_mesh_publish(object);
    return GPROJ_OK;
}

GPROJI_INTERNAL gproj_code gproji_mesh_connect(gproji_mesh_object *object, const gproji_soup *soup,
                                               gproji_mesh_work *work, gproj_error *error) {
    gproj_mesh *mesh = &object->mesh;
    gproj_code code = gproji_mesh_read_corners(soup, work, error);
    if (!code) code = gproji_mesh_match(soup, work, &mesh->edge_count, error);
    if (!code) code = gproji_mesh_orient(soup, work, mesh, error);
    if (!code && mesh->reoriented_count) code = gproji_mesh_match(soup, work, &mesh->edge_count, error);
    mesh->halfedge_count = 2 * mesh->edge_count;
    return code ? code : gproji_mesh_finish(object, soup, work, error);
}

/* Builds the mesh of an object that has none yet. After a failure the object can only be destroyed. */
GPROJI_INTERNAL gproj_code gproji_mesh_build(gproji_mesh_object *object, gproji_soup *soup, gproj_error *error) {
    gproji_mesh_work work;
    gproj_code code;
    if (soup->vertex_count > GPROJI_VERTICES_MAX) {
        return gproji_fail(error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1,
                           "the mesh has %d vertices, more than %d; split it", soup->vertex_count,
                           (int32_t)GPROJI_VERTICES_MAX);
    }
    code = gproji_check_degrees(soup, error);
    if (!code) code = gproji_check_positions(soup->vertex_count, soup->position, "vertex", error);
    if (code) return code;
    object->mesh.vertex_count = soup->vertex_count;
    object->mesh.face_count = soup->face_count;
    code = gproji_mesh_work_take(&object->heap, &work, soup) ? gproji_mesh_connect(object, soup, &work, error)
                                                             : gproji_fail_memory(error);
    gproji_mesh_work_give(&object->heap, &work, soup);
    return code;
}

GPROJ_API void gproj_mesh_destroy(gproj_mesh *mesh) {
    gproji_mesh_object *object;
    gproji_heap *heap;
    size_t vertices, faces;
    if (!mesh) return;
    object = gproji_mesh_owner(mesh);
    heap = &object->heap;
    vertices = (size_t)mesh->vertex_count, faces = (size_t)mesh->face_count;
    if (object->polyline_start) {
        size_t corners = (size_t)object->polyline_start[mesh->polyline_count];
        gproji_give(heap, object->polyline_vertex, corners, sizeof(int32_t));
        gproji_give(heap, object->polyline_start, (size_t)mesh->polyline_count + 1, sizeof(int32_t));
    }
    gproji_give(heap, mesh->position, vertices, 3 * sizeof(double));
    gproji_give(heap, object->vertex_halfedge, vertices, sizeof(int32_t));
    gproji_give(heap, object->face_halfedge, faces, sizeof(int32_t));
    gproji_give(heap, object->face_degree, faces, sizeof(int32_t));
    gproji_give(heap, object->loop_halfedge, (size_t)mesh->loop_count, sizeof(int32_t));
    gproji_give(heap, object->halfedge, (size_t)mesh->halfedge_count, 6 * sizeof(int32_t));
    gproji_destroy_object(object, sizeof *object);
}

/* Stores polylines: `start` has count + 1 entries, start[0] = 0. */
GPROJI_INTERNAL gproj_code gproji_mesh_set_polylines(gproji_mesh_object *object, int32_t count, const int32_t *start,
                                                     const int32_t *vertex, gproj_error *error) {
    size_t total = count ? (size_t)start[count] : 0;
    object->polyline_vertex = (int32_t *)gproji_take(&object->heap, total, sizeof(int32_t));
    if (!object->polyline_vertex) return gproji_fail_memory(error);
    object->polyline_start = (int32_t *)gproji_take(&object->heap, (size_t)count + 1, sizeof(int32_t));
    if (!object->polyline_start) {
        gproji_give(&object->heap, object->polyline_vertex, total, sizeof(int32_t));
        object->polyline_vertex = NULL;
        return gproji_fail_memory(error);
    }
    object->mesh.polyline_count = count;
    object->polyline_start[0] = 0;
    if (count) {
        memcpy(object->polyline_start, start, ((size_t)count + 1) * sizeof(int32_t));
        memcpy(object->polyline_vertex, vertex, total * sizeof(int32_t));
    }
    gproji_mesh_publish(object);
    return GPROJ_OK;
}

/* The end of every function that makes a mesh: the mesh, or NULL and nothing kept. */
GPROJI_INTERNAL gproj_mesh *gproji_mesh_done(gproji_mesh_object *object, gproj_code code) {
    if (!code) return &object->mesh;
    gproj_mesh_destroy(&object->mesh);
    return NULL;
}

GPROJI_INTERNAL gproji_mesh_object *gproji_mesh_begin(const gproj_host *host, gproj_error *error) {
    gproji_mesh_object *object = (gproji_mesh_object *)gproji_create_object(host, sizeof(gproji_mesh_object));
    gproji_error_clear(error);
    if (!object) gproji_fail_memory(error);
    return object;
}

GPROJ_API gproj_mesh *gproj_mesh_create(int32_t vertex_count, const double *position, int32_t face_count,
                                        const int32_t *face_degree, const int32_t *face_vertex, const gproj_host *host,
                                        gproj_error *error) {
    gproji_soup soup;
    gproji_mesh_object *object;
    gproj_code code;
    gproji_error_clear(error);
    if (vertex_count < 1 || face_count < 0) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "a mesh of %d vertices and %d faces; it needs at least one vertex", vertex_count, face_count);
        return NULL;
    }
    if (!position || (face_count && (!face_degree || !face_vertex))) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "an array of the mesh is NULL");
        return NULL;
    }
    soup.vertex_count = vertex_count, soup.face_count = face_count, soup.corner_count = 0;
    soup.position = position, soup.face_degree = face_degree, soup.face_vertex = face_vertex;
    object = gproji_mesh_begin(host, error);
    if (!object) return NULL;
    code = gproji_mesh_build(object, &soup, error);
    if (!code) code = gproji_mesh_set_polylines(object, 0, NULL, NULL, error);
    return gproji_mesh_done(object, code);
}

GPROJ_API gproj_mesh *gproj_mesh_copy(const gproj_mesh *mesh, const gproj_host *host, gproj_error *error) {
    gproji_mesh_object *object;
    gproj_mesh *copy;
    gproj_code code = GPROJ_OK;
    size_t vertices, faces;
    gproji_error_clear(error);
    if (!mesh) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the mesh to copy is NULL");
        return NULL;
    }
    object = gproji_mesh_begin(host, error);
    if (!object) return NULL;
    copy = &object->mesh;
    *copy = *mesh;
    copy->polyline_count = 0; /* set below, when there is memory for them */
    vertices = (size_t)mesh->vertex_count, faces = (size_t)mesh->face_count;
    object->loop_halfedge = (int32_t *)gproji_take(&object->heap, (size_t)mesh->loop_count, sizeof(int32_t));
    if (!gproji_mesh_take(object) || !object->loop_halfedge) code = gproji_fail_memory(error);
    if (!code) {
        code =
            gproji_mesh_set_polylines(object, mesh->polyline_count, mesh->polyline_start, mesh->polyline_vertex, error);
    }
    if (!code) {
        memcpy(copy->position, mesh->position, vertices * 3 * sizeof(double));
        memcpy(object->vertex_halfedge, mesh->vertex_halfedge, vertices * sizeof(int32_t));
        memcpy(object->face_halfedge, mesh->face_halfedge, faces * sizeof(int32_t));
        memcpy(object->face_degree, mesh->face_degree, faces * sizeof(int32_t));
        memcpy(object->loop_halfedge, mesh->loop_halfedge, (size_t)mesh->loop_count * sizeof(int32_t));
        memcpy(object->halfedge, mesh->twin, (size_t)mesh->halfedge_count * 6 * sizeof(int32_t));
    }
    return gproji_mesh_done(object, code);
}

GPROJ_API gproj_memory gproj_mesh_memory(const gproj_mesh *mesh) {
    gproj_memory none;
    memset(&none, 0, sizeof none);
    if (!mesh) return none;
    return ((const gproji_mesh_object *)(const void *)((const char *)mesh - offsetof(gproji_mesh_object, mesh)))
        ->heap.account;
}

/* -- questions -- */

GPROJ_API bool gproj_mesh_is_boundary_vertex(const gproj_mesh *mesh, int32_t vertex) {
    if (vertex < 0 || vertex >= mesh->vertex_count || mesh->vertex_halfedge[vertex] < 0) return false;
    return mesh->face[mesh->vertex_halfedge[vertex]] < 0;
}

GPROJ_API int32_t gproj_mesh_one_ring(const gproj_mesh *mesh, int32_t vertex, int32_t *neighbours, int32_t capacity) {
    int32_t valence = 0, start, h;
    if (vertex < 0 || vertex >= mesh->vertex_count || mesh->vertex_halfedge[vertex] < 0) return 0;
    start = mesh->vertex_halfedge[vertex];
    /* the outgoing boundary half-edge is the last of its vertex: its left side is outside */
    if (mesh->face[start] < 0) start = gproji_rotate(mesh, start);
    h = start;
    do {
        if (neighbours && valence < capacity) neighbours[valence] = mesh->origin[h ^ 1];
        ++valence;
        h = gproji_rotate(mesh, h);
    } while (h != start);
    return valence;
}

GPROJ_API int32_t gproj_mesh_valence(const gproj_mesh *mesh, int32_t vertex) {
    return gproj_mesh_one_ring(mesh, vertex, NULL, 0);
}

/* See gproj_form_is_corner; with other positions. The half-edges with face -1 that leave and enter a boundary vertex
   are h and prev[h]. */
GPROJI_INTERNAL bool gproji_is_corner(const gproj_mesh *mesh, const double *position, int32_t vertex) {
    static const double none[3] = {0, 0, 0};
    const double *p;
    double in[3], out[3];
    int32_t h;
    if (!gproj_mesh_is_boundary_vertex(mesh, vertex)) return false;
    if (gproj_mesh_valence(mesh, vertex) == 2) return true;
    h = mesh->vertex_halfedge[vertex];
    p = position + 3 * (size_t)vertex;
    gproji_sub3(p, position + 3 * (size_t)mesh->origin[mesh->prev[h]], in);
    gproji_sub3(position + 3 * (size_t)mesh->origin[h ^ 1], p, out);
    if (!gproji_normalise3(in, none) || !gproji_normalise3(out, none)) return false;
    return gproji_dot3(in, out) < 0.70710678118654752; /* cos 45 degrees */
}

/* The vectorial area of a face with other positions: 1/2 sum (v_i - v_0) x (v_(i+1) - v_0), the same sum as in the
   interface, without cancellation far from the coordinates' origin. */
GPROJI_INTERNAL void gproji_area_vector(const gproj_mesh *mesh, const double *position, int32_t face, double area[3]) {
    int32_t start = mesh->face_halfedge[face], h;
    const double *base = position + 3 * (size_t)mesh->origin[start];
    double a[3], b[3], cross[3];
    gproji_set3(0, 0, 0, area);
    for (h = mesh->next[start]; mesh->next[h] != start; h = mesh->next[h]) {
        gproji_sub3(position + 3 * (size_t)mesh->origin[h], base, a);
        gproji_sub3(position + 3 * (size_t)mesh->origin[mesh->next[h]], base, b);
        gproji_cross3(a, b, cross);
        gproji_add_scaled3(0.5, cross, area);
    }
}

GPROJ_API void gproj_mesh_face_area_vector(const gproj_mesh *mesh, int32_t face, double area[3]) {
    gproji_set3(0, 0, 0, area);
    if (face >= 0 && face < mesh->face_count) gproji_area_vector(mesh, mesh->position, face, area);
}

/* The mean edge length with other positions; 0 without edges. */
GPROJI_INTERNAL double gproji_mean_edge(const gproj_mesh *mesh, const double *position) {
    double sum = 0;
    int32_t h;
    for (h = 0; h < mesh->halfedge_count; h += 2)
        sum += gproji_distance3(position + 3 * (size_t)mesh->origin[h], position + 3 * (size_t)mesh->origin[h + 1]);
    return mesh->edge_count ? sum / mesh->edge_count : 0;
}

GPROJ_API double gproj_mesh_mean_edge_length(const gproj_mesh *mesh) { return gproji_mean_edge(mesh, mesh->position); }
/* ============================================================================================================
   >>text   Meshes as OBJ and OFF texts. Uses platform, memory, error, number, mesh.

   Based on the Wavefront Advanced Visualizer manual, appendix B1 (OBJ) and the Geomview manual, section 4.2.5 (OFF).
   Both readers go once through the text and gather polygons, with the line of each vertex and face, so that the mesh
   builder's complaints can name the line too. Nothing is allocated because a text promises it: arrays grow as the
   elements appear.
   Invariant: the scanner never reads text[size] or beyond; `line` is the line of the character at `at`. */

/* A growing array of integers. */
typedef struct gproji_ints {
    int32_t *data;
    size_t count, capacity;
} gproji_ints;

typedef struct gproji_reader {
    const char *text;
    size_t size, at;
    int32_t line;     /* from 1 */
    const char *word; /* the last word scanned, not NUL-terminated */
    size_t word_size;
    gproji_heap *heap;
    gproj_error *error;
    double *position; /* 3 * vertex_count, room for 3 * position_capacity */
    size_t vertex_count, position_capacity;
    gproji_ints vertex_line, face_line, face_degree;
    gproji_ints face_vertex; /* OBJ: as far as the text says, checked against the vertex count at the end */
    gproji_ints polyline_start, polyline_vertex, polyline_line;
} gproji_reader;

/* -- words and lines -- */

GPROJI_INLINE bool gproji_is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
GPROJI_INLINE bool gproji_is_line_end(char c) { return c == '\n' || c == '\r'; }

/* Steps over CR, LF or CR LF at `at`. */
GPROJI_INLINE void gproji_skip_line_end(gproji_reader *reader) {
    char c = reader->text[reader->at++];
    if (c == '\r' && reader->at < reader->size && reader->text[reader->at] == '\n') reader->at++;
    if (reader->line < INT32_MAX) reader->line++;
}

/* Is there a backslash with a line end behind it at position i: the line goes on? */
GPROJI_INLINE bool gproji_is_continuation(const gproji_reader *reader, size_t i) {
    return reader->text[i] == '\\' && i + 1 < reader->size && gproji_is_line_end(reader->text[i + 1]);
}

/* The next word of the line; false at the line's end, where a comment counts as the end. */
GPROJI_INTERNAL bool gproji_next_word(gproji_reader *reader) {
    size_t end;
    while (reader->at < reader->size) {
        if (gproji_is_blank(reader->text[reader->at])) {
            reader->at++;
        } else if (gproji_is_continuation(reader, reader->at)) {
            reader->at++;
            gproji_skip_line_end(reader);
        } else {
            break;
        }
    }
    if (reader->at >= reader->size || gproji_is_line_end(reader->text[reader->at]) || reader->text[reader->at] == '#') {
        return false;
    }
    for (end = reader->at; end < reader->size; ++end) {
        char c = reader->text[end];
        if (gproji_is_blank(c) || gproji_is_line_end(c) || gproji_is_continuation(reader, end)) break;
    }
    reader->word = reader->text + reader->at;
    reader->word_size = end - reader->at;
    reader->at = end;
    return true;
}

/* Goes to the beginning of the next line; false at the end of the text. */
GPROJI_INTERNAL bool gproji_next_line(gproji_reader *reader) {
    while (reader->at < reader->size && !gproji_is_line_end(reader->text[reader->at])) reader->at++;
    if (reader->at >= reader->size) return false;
    gproji_skip_line_end(reader);
    return true;
}

/* The next word of the text, over line ends and comments; false at the end of the text. */
GPROJI_INTERNAL bool gproji_next_word_anywhere(gproji_reader *reader) {
    while (!gproji_next_word(reader)) {
        if (!gproji_next_line(reader)) return false;
    }
    return true;
}

GPROJI_INTERNAL bool gproji_word_is(const gproji_reader *reader, const char *text) {
    return reader->word_size == strlen(text) && !memcmp(reader->word, text, reader->word_size);
}

/* The word for a sentence: printable, and cut if it is long. */
enum {
    GPROJI_QUOTE_SIZE = 32
};
GPROJI_INTERNAL const char *gproji_quote(const gproji_reader *reader, char quote[GPROJI_QUOTE_SIZE]) {
    size_t length = reader->word_size < 24 ? reader->word_size : 24, i;
    for (i = 0; i < length; ++i) {
        char c = reader->word[i];
        quote[i] = c > ' ' && c <= '~' ? c : '?';
    }
    memcpy(quote + length, "...", 4);
    if (length == reader->word_size) quote[length] = 0;
    return quote;
}

/* -- numbers and indices -- */

/* The word as a number. */
GPROJI_INTERNAL gproj_code gproji_word_number(gproji_reader *reader, double *value) {
    char quote[GPROJI_QUOTE_SIZE];
    size_t used = gproj_number_read(reader->word, reader->word_size, value);
    if (used && used == reader->word_size) return GPROJ_OK;
    return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, reader->line,
                       "line %d: '%s' is not a number%s", reader->line, gproji_quote(reader, quote),
                       used && reader->word[used] == ',' ? "; write decimals with a point, not a comma" : "");
}

/* The word as an integer, clamped to +-10^12; with `slashes`, what follows a '/' (texture, normal) is passed over. */
GPROJI_INTERNAL gproj_code gproji_word_index(gproji_reader *reader, bool slashes, int64_t *value) {
    const char *word = reader->word;
    char quote[GPROJI_QUOTE_SIZE];
    size_t i = 0, digits;
    bool negative = word[0] == '-';
    if (word[0] == '-' || word[0] == '+') ++i;
    *value = 0;
    for (digits = i; i < reader->word_size && gproji_is_digit(word[i]); ++i) {
        if (*value < INT64_C(100000000000)) *value = *value * 10 + (word[i] - '0');
    }
    if (i > digits && (i == reader->word_size || (slashes && word[i] == '/'))) {
        if (negative) *value = -*value;
        while (i < reader->word_size && (gproji_is_digit(word[i]) || word[i] == '/' || word[i] == '-')) ++i;
        if (i == reader->word_size) return GPROJ_OK;
    }
    return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, reader->line, "line %d: '%s' is not %s",
                       reader->line, gproji_quote(reader, quote),
                       slashes ? "a vertex index (such as 7, -1 or 7/1/3)" : "a whole number");
}

/* Appends to a growing array. */
GPROJI_INTERNAL gproj_code gproji_push(gproji_reader *reader, gproji_ints *ints, int32_t value) {
    void *block = ints->data;
    if (ints->count >= ints->capacity) {
        if (ints->count >= INT32_MAX - 1) {
            return gproji_fail(reader->error, GPROJ_ERROR_SIZE, GPROJ_PLACE_LINE, reader->line,
                               "line %d: the text has too many elements; split the mesh", reader->line);
        }
        if (!gproji_reserve(reader->heap, &block, &ints->capacity, ints->count + 1, sizeof(int32_t))) {
            return gproji_fail_memory(reader->error);
        }
        ints->data = (int32_t *)block;
    }
    ints->data[ints->count++] = value;
    return GPROJ_OK;
}

GPROJI_INTERNAL gproj_code gproji_push_vertex(gproji_reader *reader, const double x[3], int32_t line) {
    void *block = reader->position;
    if (reader->vertex_count >= (size_t)GPROJI_VERTICES_MAX) {
        return gproji_fail(reader->error, GPROJ_ERROR_SIZE, GPROJ_PLACE_LINE, line,
                           "line %d: more than %d vertices; split the mesh", line, (int32_t)GPROJI_VERTICES_MAX);
    }
    if (!gproji_reserve(reader->heap, &block, &reader->position_capacity, reader->vertex_count + 1,
                        3 * sizeof(double))) {
        return gproji_fail_memory(reader->error);
    }
    reader->position = (double *)block;
    gproji_copy3(x, reader->position + 3 * reader->vertex_count);
    reader->vertex_count++;
    return gproji_push(reader, &reader->vertex_line, line);
}

/* -- OBJ -- */

/* v x y z, maybe with a weight, a colour or both, which are passed over. */
GPROJI_INTERNAL gproj_code gproji_obj_vertex(gproji_reader *reader) {
    double number, x[3] = {0, 0, 0};
    int32_t count = 0, line = reader->line;
    gproj_code code;
    while (gproji_next_word(reader)) {
        code = gproji_word_number(reader, &number);
        if (code) return code;
        if (count < 3) x[count] = number;
        if (count < 8) ++count;
    }
    if (count != 3 && count != 4 && count != 6 && count != 7) {
        return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, line,
                           "line %d: a vertex with %s%d numbers; write 'v x y z'", line, count == 8 ? "more than " : "",
                           count == 8 ? 7 : count);
    }
    return gproji_push_vertex(reader, x, line);
}

/* The indices of an f or l line, from 0, into `ints`; *count is their number. Positive ones may point forward, so they
   are compared with the vertex count at the end. */
GPROJI_INTERNAL gproj_code gproji_obj_indices(gproji_reader *reader, gproji_ints *ints, int32_t *count) {
    int64_t index, vertices = (int64_t)reader->vertex_count;
    gproj_code code;
    *count = 0;
    while (gproji_next_word(reader)) {
        code = gproji_word_index(reader, true, &index);
        if (code) return code;
        if (index == 0) {
            return gproji_fail(reader->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, reader->line,
                               "line %d: index 0; the vertices of an OBJ text count from 1", reader->line);
        }
        if (index < 0 && index + vertices < 0) {
            return gproji_fail(reader->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, reader->line,
                               "line %d: index %l, but only %l vertices stand above", reader->line, index, vertices);
        }
        index = index < 0 ? index + vertices : index - 1;
        if (index >= GPROJI_VERTICES_MAX) {
            return gproji_fail(reader->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, reader->line,
                               "line %d: index %l is larger than any number of vertices can be", reader->line,
                               index + 1);
        }
        code = gproji_push(reader, ints, (int32_t)index);
        if (code) return code;
        ++*count;
    }
    return GPROJ_OK;
}

GPROJI_INTERNAL gproj_code gproji_fail_corners(gproji_reader *reader, int32_t count, int32_t line) {
    return gproji_fail(reader->error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_LINE, line,
                       "line %d: a face with %d corners; a face needs at least 3", line, count);
}

GPROJI_INTERNAL gproj_code gproji_push_face(gproji_reader *reader, int32_t degree, int32_t line) {
    gproj_code code = gproji_push(reader, &reader->face_degree, degree);
    return code ? code : gproji_push(reader, &reader->face_line, line);
}

GPROJI_INTERNAL gproj_code gproji_obj_face(gproji_reader *reader) {
    int32_t count, line = reader->line;
    gproj_code code = gproji_obj_indices(reader, &reader->face_vertex, &count);
    if (code) return code;
    return count < 3 ? gproji_fail_corners(reader, count, line) : gproji_push_face(reader, count, line);
}

GPROJI_INTERNAL gproj_code gproji_obj_polyline(gproji_reader *reader) {
    int32_t count, line = reader->line;
    gproj_code code = gproji_obj_indices(reader, &reader->polyline_vertex, &count);
    if (!code && count < 2) {
        code = gproji_fail(reader->error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_LINE, line,
                           "line %d: a polyline with %d points; it needs at least 2", line, count);
    }
    if (!code) code = gproji_push(reader, &reader->polyline_start, (int32_t)reader->polyline_vertex.count);
    return code ? code : gproji_push(reader, &reader->polyline_line, line);
}

/* Are all indices of the elements, of which each has degree[i] or ends at start[i], below the vertex count? */
GPROJI_INTERNAL gproj_code gproji_obj_check_indices(gproji_reader *reader, const gproji_ints *ints,
                                                    const gproji_ints *line, const int32_t *degree,
                                                    const int32_t *end) {
    size_t e, c = 0;
    for (e = 0; e < line->count; ++e) {
        size_t stop = degree ? c + (size_t)degree[e] : (size_t)end[e + 1];
        for (; c < stop; ++c) {
            if ((size_t)ints->data[c] < reader->vertex_count) continue;
            return gproji_fail(reader->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, line->data[e],
                               "line %d: index %d, but the text has %d vertices", line->data[e], ints->data[c] + 1,
                               (int32_t)reader->vertex_count);
        }
    }
    return GPROJ_OK;
}

GPROJI_INTERNAL gproj_code gproji_read_obj(gproji_reader *reader) {
    gproj_code code = gproji_push(reader, &reader->polyline_start, 0);
    bool more = true;
    while (more && !code) {
        if (gproji_next_word(reader)) {
            if (gproji_word_is(reader, "v"))
                code = gproji_obj_vertex(reader);
            else if (gproji_word_is(reader, "f"))
                code = gproji_obj_face(reader);
            else if (gproji_word_is(reader, "l"))
                code = gproji_obj_polyline(reader);
        }
        more = gproji_next_line(reader);
    }
    if (!code) {
        code =
            gproji_obj_check_indices(reader, &reader->face_vertex, &reader->face_line, reader->face_degree.data, NULL);
    }
    if (!code) {
        code = gproji_obj_check_indices(reader, &reader->polyline_vertex, &reader->polyline_line, NULL,
                                        reader->polyline_start.data);
    }
    return code;
}

/* -- OFF -- */

/* Is the word [ST][C][N][4][n]OFF? The 4 and the n (other dimensions than 3) set *plain to false. */
GPROJI_INTERNAL bool gproji_is_off_word(const gproji_reader *reader, bool *plain) {
    const char *word = reader->word;
    size_t size = reader->word_size, i = 0;
    *plain = true;
    if (size - i > 2 && word[i] == 'S' && word[i + 1] == 'T') i += 2;
    if (size - i > 1 && word[i] == 'C') ++i;
    if (size - i > 1 && word[i] == 'N') ++i;
    if (size - i > 1 && word[i] == '4') ++i, *plain = false;
    if (size - i > 1 && word[i] == 'n') ++i, *plain = false;
    return size - i == 3 && !memcmp(word + i, "OFF", 3);
}

GPROJI_INTERNAL gproj_code gproji_fail_cut_off(gproji_reader *reader, int64_t count, int64_t of, const char *what) {
    return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, reader->line,
                       "line %d: the text ends after %l of %l %s; it seems to be cut off", reader->line, count, of,
                       what);
}

/* The header up to the counts of vertices and faces. */
GPROJI_INTERNAL gproj_code gproji_off_header(gproji_reader *reader, int64_t count[2]) {
    char quote[GPROJI_QUOTE_SIZE];
    bool plain, have_word = gproji_next_word_anywhere(reader);
    int32_t k;
    gproj_code code;
    if (have_word && gproji_is_off_word(reader, &plain)) {
        have_word = gproji_next_word_anywhere(reader);
        if (!plain || (have_word && gproji_word_is(reader, "BINARY"))) {
            return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, reader->line,
                               "line %d: %s; save it as plain OFF", reader->line,
                               plain ? "a binary OFF file" : "an OFF file of another dimension than 3");
        }
    } else if (have_word && !gproji_is_digit(reader->word[0])) {
        return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, reader->line,
                           "line %d: '%s' where an OFF text says OFF", reader->line, gproji_quote(reader, quote));
    }
    for (k = 0; k < 2; ++k, have_word = gproji_next_word_anywhere(reader)) {
        if (!have_word) return gproji_fail_cut_off(reader, k, 2, "counts");
        code = gproji_word_index(reader, false, &count[k]);
        if (code) return code;
        if (count[k] < 0 || count[k] > GPROJI_VERTICES_MAX) {
            return gproji_fail(reader->error, GPROJ_ERROR_SIZE, GPROJ_PLACE_LINE, reader->line,
                               "line %d: a count of %l %s", reader->line, count[k], k ? "faces" : "vertices");
        }
        if (k == 1) break;
    }
    gproji_next_line(reader); /* the count of edges is not needed */
    return GPROJ_OK;
}

/* One line: x y z; colours, normals and texture coordinates behind them are passed over. */
GPROJI_INTERNAL gproj_code gproji_off_vertex(gproji_reader *reader) {
    double x[3];
    int32_t k, line = reader->line;
    gproj_code code;
    for (k = 0; k < 3; ++k) {
        if (k && !gproji_next_word(reader)) {
            return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, line,
                               "line %d: a vertex with %d numbers; write x y z on one line", line, k);
        }
        code = gproji_word_number(reader, &x[k]);
        if (code) return code;
    }
    gproji_next_line(reader);
    return gproji_push_vertex(reader, x, line);
}

/* degree, then the corners; colours behind them are passed over. */
GPROJI_INTERNAL gproj_code gproji_off_face(gproji_reader *reader, int64_t face, int64_t faces) {
    int64_t degree, index, k;
    int32_t line = reader->line;
    gproj_code code = gproji_word_index(reader, false, &degree);
    if (code) return code;
    if (degree < 3) return gproji_fail_corners(reader, (int32_t)(degree < -9 ? -9 : degree), line);
    for (k = 0; k < degree; ++k) {
        if (!gproji_next_word_anywhere(reader)) return gproji_fail_cut_off(reader, face, faces, "faces");
        code = gproji_word_index(reader, false, &index);
        if (code) return code;
        if (index < 0 || index >= (int64_t)reader->vertex_count) {
            return gproji_fail(reader->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_LINE, reader->line,
                               "line %d: index %l, but the vertices are 0 to %l", reader->line, index,
                               (int64_t)reader->vertex_count - 1);
        }
        code = gproji_push(reader, &reader->face_vertex, (int32_t)index);
        if (code) return code;
    }
    gproji_next_line(reader);
    return gproji_push_face(reader, (int32_t)degree, line);
}

GPROJI_INTERNAL gproj_code gproji_read_off(gproji_reader *reader) {
    int64_t count[2] = {0, 0}, i;
    gproj_code code = gproji_off_header(reader, count);
    for (i = 0; i < count[0] && !code; ++i) {
        code = gproji_next_word_anywhere(reader) ? gproji_off_vertex(reader)
                                                 : gproji_fail_cut_off(reader, i, count[0], "vertices");
    }
    for (i = 0; i < count[1] && !code; ++i) {
        code = gproji_next_word_anywhere(reader) ? gproji_off_face(reader, i, count[1])
                                                 : gproji_fail_cut_off(reader, i, count[1], "faces");
    }
    return code;
}

/* -- reading -- */

/* A zero byte is never in a text: a binary file, or one in UTF-16. */
GPROJI_INTERNAL gproj_code gproji_check_text(gproji_reader *reader) {
    const char *zero = reader->size ? (const char *)memchr(reader->text, 0, reader->size) : NULL;
    if (!reader->size) {
        return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1,
                           "the text is empty; it needs at least one vertex");
    }
    if (!zero) return GPROJ_OK;
    while (reader->text + reader->at < zero) {
        if (gproji_is_line_end(reader->text[reader->at]))
            gproji_skip_line_end(reader);
        else
            reader->at++;
    }
    return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_LINE, reader->line,
                       "line %d: a zero byte; this is a binary file or UTF-16, not an OBJ or OFF text", reader->line);
}

/* By the first word: [ST][C][N]OFF or OBJ. */
GPROJI_INTERNAL gproj_format gproji_detect_format(const gproji_reader *reader) {
    gproji_reader look = *reader;
    bool plain;
    return gproji_next_word_anywhere(&look) && gproji_is_off_word(&look, &plain) ? GPROJ_FORMAT_OFF : GPROJ_FORMAT_OBJ;
}

/* Puts "line 203: " in front of the mesh builder's sentence about a vertex or face. */
GPROJI_INTERNAL void gproji_add_line(const gproji_reader *reader) {
    gproj_error *error = reader->error;
    const gproji_ints *lines = &reader->face_line;
    char message[GPROJ_MESSAGE_SIZE];
    if (!error) return;
    if (error->place == GPROJ_PLACE_VERTEX)
        lines = &reader->vertex_line;
    else if (error->place != GPROJ_PLACE_FACE)
        return;
    if (error->index < 0 || (size_t)error->index >= lines->count) return;
    gproji_format(message, sizeof message, "line %d: %s", lines->data[error->index], error->message);
    memcpy(error->message, message, sizeof message);
}

/* From what the text said to the mesh. */
GPROJI_INTERNAL gproj_code gproji_reader_build(const gproji_reader *reader, gproji_mesh_object *object) {
    gproji_soup soup;
    gproj_code code;
    if (!reader->vertex_count) {
        return gproji_fail(reader->error, GPROJ_ERROR_SYNTAX, GPROJ_PLACE_NONE, -1,
                           "the text has no vertex; is it an OBJ or OFF text?");
    }
    soup.vertex_count = (int32_t)reader->vertex_count, soup.position = reader->position;
    soup.face_count = (int32_t)reader->face_degree.count, soup.corner_count = 0;
    soup.face_degree = reader->face_degree.data, soup.face_vertex = reader->face_vertex.data;
    code = gproji_mesh_build(object, &soup, reader->error);
    if (code) {
        gproji_add_line(reader);
        return code;
    }
    return gproji_mesh_set_polylines(object, (int32_t)reader->polyline_line.count, reader->polyline_start.data,
                                     reader->polyline_vertex.data, reader->error);
}

GPROJI_INTERNAL void gproji_ints_give(gproji_heap *heap, gproji_ints *ints) {
    gproji_give(heap, ints->data, ints->capacity, sizeof(int32_t));
}

/* Reads a text into an object that has no mesh yet, and takes all work memory from it. */
GPROJI_INTERNAL gproj_code gproji_mesh_read_into(gproji_mesh_object *object, const char *text, size_t size,
                                                 gproj_format format, gproj_error *error) {
    gproji_reader reader;
    gproj_code code;
    memset(&reader, 0, sizeof reader);
    reader.text = text, reader.size = size, reader.line = 1;
    reader.heap = &object->heap, reader.error = error;
    code = gproji_check_text(&reader);
    if (size >= 3 && !memcmp(text, "\xef\xbb\xbf", 3)) reader.at = 3; /* byte order mark */
    if (!code) {
        if (format == GPROJ_FORMAT_DETECT) format = gproji_detect_format(&reader);
        code = format == GPROJ_FORMAT_OFF ? gproji_read_off(&reader) : gproji_read_obj(&reader);
    }
    if (!code) code = gproji_reader_build(&reader, object);
    gproji_give(reader.heap, reader.position, reader.position_capacity, 3 * sizeof(double));
    gproji_ints_give(reader.heap, &reader.vertex_line);
    gproji_ints_give(reader.heap, &reader.face_line);
    gproji_ints_give(reader.heap, &reader.face_degree);
    gproji_ints_give(reader.heap, &reader.face_vertex);
    gproji_ints_give(reader.heap, &reader.polyline_start);
    gproji_ints_give(reader.heap, &reader.polyline_vertex);
    gproji_ints_give(reader.heap, &reader.polyline_line);
    return code;
}

GPROJ_API gproj_mesh *gproj_mesh_read(const char *text, size_t size, gproj_format format, const gproj_host *host,
                                      gproj_error *error) {
    gproji_mesh_object *object;
    gproji_error_clear(error);
    if ((!text && size) || format < GPROJ_FORMAT_DETECT || format > GPROJ_FORMAT_OFF) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    text ? "unknown text format" : "the text is NULL");
        return NULL;
    }
    object = gproji_mesh_begin(host, error);
    return object ? gproji_mesh_done(object, gproji_mesh_read_into(object, text, size, format, error)) : NULL;
}

/* -- writing -- */

typedef struct gproji_writer {
    gproj_write write;
    void *user;
    bool failed;
    size_t length;
    char buffer[4096];
} gproji_writer;

GPROJI_INTERNAL void gproji_flush(gproji_writer *writer) {
    if (writer->length && !writer->failed && !writer->write(writer->user, writer->buffer, writer->length)) {
        writer->failed = true;
    }
    writer->length = 0;
}

/* Room for a word of up to GPROJ_NUMBER_SIZE characters. */
GPROJI_INLINE char *gproji_room(gproji_writer *writer) {
    if (writer->length + GPROJ_NUMBER_SIZE > sizeof writer->buffer) gproji_flush(writer);
    return writer->buffer + writer->length;
}

GPROJI_INLINE void gproji_put(gproji_writer *writer, const char *text) {
    size_t length = strlen(text);
    memcpy(gproji_room(writer), text, length);
    writer->length += length;
}

GPROJI_INTERNAL void gproji_put_integer(gproji_writer *writer, int32_t value) {
    char text[GPROJ_NUMBER_SIZE];
    gproji_append_integer(text, sizeof text, 0, value);
    gproji_put(writer, text);
}

GPROJI_INTERNAL void gproji_put_position(gproji_writer *writer, const double x[3]) {
    int32_t k;
    for (k = 0; k < 3; ++k) {
        writer->length += gproj_number_write(x[k], gproji_room(writer));
        gproji_put(writer, k < 2 ? " " : "\n");
    }
}

/* The corners of all faces; `base` is 1 for OBJ. */
GPROJI_INTERNAL void gproji_put_faces(gproji_writer *writer, const gproj_mesh *mesh, bool off) {
    int32_t f, h;
    for (f = 0; f < mesh->face_count && !writer->failed; ++f) {
        if (off)
            gproji_put_integer(writer, mesh->face_degree[f]);
        else
            gproji_put(writer, "f");
        h = mesh->face_halfedge[f];
        do {
            gproji_put(writer, " ");
            gproji_put_integer(writer, mesh->origin[h] + (off ? 0 : 1));
            h = mesh->next[h];
        } while (h != mesh->face_halfedge[f]);
        gproji_put(writer, "\n");
    }
}

GPROJI_INTERNAL void gproji_put_polylines(gproji_writer *writer, const gproj_mesh *mesh) {
    int32_t p, i;
    for (p = 0; p < mesh->polyline_count && !writer->failed; ++p) {
        gproji_put(writer, "l");
        for (i = mesh->polyline_start[p]; i < mesh->polyline_start[p + 1]; ++i) {
            gproji_put(writer, " ");
            gproji_put_integer(writer, mesh->polyline_vertex[i] + 1);
        }
        gproji_put(writer, "\n");
    }
}

/* After the arguments have been checked. */
GPROJI_INTERNAL gproj_code gproji_write_mesh(const gproj_mesh *mesh, gproj_format format, gproj_write write,
                                             void *user) {
    gproji_writer writer;
    bool off = format == GPROJ_FORMAT_OFF;
    int32_t v;
    writer.write = write, writer.user = user, writer.failed = false, writer.length = 0;
    if (off) {
        gproji_put(&writer, "OFF\n");
        gproji_put_integer(&writer, mesh->vertex_count);
        gproji_put(&writer, " ");
        gproji_put_integer(&writer, mesh->face_count);
        gproji_put(&writer, " ");
        gproji_put_integer(&writer, mesh->edge_count);
        gproji_put(&writer, "\n");
    }
    for (v = 0; v < mesh->vertex_count && !writer.failed; ++v) {
        if (!off) gproji_put(&writer, "v ");
        gproji_put_position(&writer, mesh->position + 3 * v);
    }
    gproji_put_faces(&writer, mesh, off);
    if (!off) gproji_put_polylines(&writer, mesh);
    gproji_flush(&writer);
    return writer.failed ? GPROJ_ERROR_FILE : GPROJ_OK;
}

GPROJ_API gproj_code gproj_mesh_write(const gproj_mesh *mesh, gproj_format format, gproj_write write, void *user) {
    if (!mesh || !write || (format != GPROJ_FORMAT_OBJ && format != GPROJ_FORMAT_OFF)) return GPROJ_ERROR_ARGUMENT;
    if (gproji_check_positions(mesh->vertex_count, mesh->position, "vertex", NULL)) return GPROJ_ERROR_NUMBER;
    return gproji_write_mesh(mesh, format, write, user);
}

/* -- files -- */
#ifndef GPROJ_NO_STDIO

/* A path for a sentence: its end, if it is long; no control characters. */
enum {
    GPROJI_PATH_QUOTE_SIZE = 132,
    GPROJI_PATH_MAX = 4096
};
GPROJI_INTERNAL const char *gproji_quote_path(const char *path, char quote[GPROJI_PATH_QUOTE_SIZE]) {
    size_t length = strlen(path), start = 0, at = 0;
    if (length > GPROJI_PATH_QUOTE_SIZE - 4) {
        start = length - (GPROJI_PATH_QUOTE_SIZE - 4);
        while (((unsigned char)path[start] & 0xc0) == 0x80) ++start; /* begin with a whole UTF-8 character */
        memcpy(quote, "...", 3);
        at = 3;
    }
    for (; start < length; ++start) {
        unsigned char c = (unsigned char)path[start];
        quote[at++] = c < 32 || c == 127 ? '?' : path[start];
    }
    quote[at] = 0;
    return quote;
}

/* By the ending, in any case; DETECT where it is neither .obj nor .off. */
GPROJI_INTERNAL gproj_format gproji_format_of_path(const char *path) {
    size_t length = strlen(path);
    if (length < 4) return GPROJ_FORMAT_DETECT;
    if (gproji_begins_with(path + length - 3, 3, "obj") && path[length - 4] == '.') return GPROJ_FORMAT_OBJ;
    if (gproji_begins_with(path + length - 3, 3, "off") && path[length - 4] == '.') return GPROJ_FORMAT_OFF;
    return GPROJ_FORMAT_DETECT;
}

/* Reads what is left of a file; *text has room for *capacity characters. */
GPROJI_INTERNAL gproj_code gproji_read_file(FILE *file, const char *path, gproji_heap *heap, void **text,
                                            size_t *capacity, size_t *size, gproj_error *error) {
    char quote[GPROJI_PATH_QUOTE_SIZE];
    size_t got;
    do {
        if (*size >= *capacity && !gproji_reserve(heap, text, capacity, *size + 65536, 1)) {
            return gproji_fail(error, GPROJ_ERROR_MEMORY, GPROJ_PLACE_NONE, -1,
                               "'%s' is too large for the memory after %l bytes", gproji_quote_path(path, quote),
                               (int64_t)*size);
        }
        got = fread((char *)*text + *size, 1, *capacity - *size, file);
        *size += got;
    } while (got);
    if (!ferror(file)) return GPROJ_OK;
    return gproji_fail(error, GPROJ_ERROR_FILE, GPROJ_PLACE_NONE, -1,
                       "'%s' cannot be read; is it a folder, or the disk damaged?", gproji_quote_path(path, quote));
}

GPROJI_INTERNAL gproj_code gproji_load_into(gproji_mesh_object *object, const char *path, gproj_error *error) {
    char quote[GPROJI_PATH_QUOTE_SIZE];
    void *text = NULL;
    size_t capacity = 0, size = 0;
    gproj_code code;
    FILE *file = fopen(path, "rb");
    if (!file) {
        return gproji_fail(error, GPROJ_ERROR_FILE, GPROJ_PLACE_NONE, -1,
                           "'%s' cannot be opened; does it exist, and may you read it?",
                           gproji_quote_path(path, quote));
    }
    code = gproji_read_file(file, path, &object->heap, &text, &capacity, &size, error);
    fclose(file);
    if (!code) code = gproji_mesh_read_into(object, (const char *)text, size, gproji_format_of_path(path), error);
    gproji_give(&object->heap, text, capacity, 1);
    return code;
}

GPROJ_API gproj_mesh *gproj_mesh_load(const char *path, const gproj_host *host, gproj_error *error) {
    gproji_mesh_object *object;
    gproji_error_clear(error);
    if (!path) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the path to load from is NULL");
        return NULL;
    }
    object = gproji_mesh_begin(host, error);
    return object ? gproji_mesh_done(object, gproji_load_into(object, path, error)) : NULL;
}

GPROJI_INTERNAL bool gproji_write_to_file(void *user, const char *text, size_t size) {
    return fwrite(text, 1, size, (FILE *)user) == size;
}

/* Moves a complete new file over an old one. */
GPROJI_INTERNAL bool gproji_replace_file(const char *from, const char *to) {
#ifdef _WIN32
    remove(to); /* rename does not replace there; nothing is lost when it fails, the new file has all */
#endif
    return rename(from, to) == 0;
}

/* The complete file is written and closed before the old one is touched. */
GPROJI_INTERNAL gproj_code gproji_save_through(const gproj_mesh *mesh, const char *path, const char *temporary,
                                               gproj_error *error) {
    char quote[GPROJI_PATH_QUOTE_SIZE];
    bool complete;
    FILE *file = fopen(temporary, "wb");
    if (!file) {
        return gproji_fail(error, GPROJ_ERROR_FILE, GPROJ_PLACE_NONE, -1,
                           "no file can be made beside '%s'; does the folder exist, and may you write there?",
                           gproji_quote_path(path, quote));
    }
    complete = gproji_write_mesh(mesh, gproji_format_of_path(path), gproji_write_to_file, file) == GPROJ_OK;
    if (fclose(file)) complete = false;
    if (!complete) {
        remove(temporary);
        return gproji_fail(error, GPROJ_ERROR_FILE, GPROJ_PLACE_NONE, -1, "'%s' was not written; is the disk full?",
                           gproji_quote_path(path, quote));
    }
    if (gproji_replace_file(temporary, path)) return GPROJ_OK;
    remove(temporary);
    return gproji_fail(error, GPROJ_ERROR_FILE, GPROJ_PLACE_NONE, -1,
                       "'%s' cannot be replaced; is it a folder, or open elsewhere?", gproji_quote_path(path, quote));
}

GPROJ_API gproj_code gproj_mesh_save(const gproj_mesh *mesh, const char *path, gproj_error *error) {
    static const char suffix[] = ".gproj-new";
    char temporary[GPROJI_PATH_MAX], quote[GPROJI_PATH_QUOTE_SIZE];
    gproj_code code;
    gproji_error_clear(error);
    if (!mesh || !path) {
        return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the %s to save is NULL",
                           mesh ? "path" : "mesh");
    }
    if (strlen(path) + sizeof suffix > sizeof temporary) {
        return gproji_fail(error, GPROJ_ERROR_FILE, GPROJ_PLACE_NONE, -1, "'%s' is too long a path",
                           gproji_quote_path(path, quote));
    }
    if (gproji_format_of_path(path) == GPROJ_FORMAT_DETECT) {
        return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                           "'%s' says no format; let the name end with .obj or .off", gproji_quote_path(path, quote));
    }
    code = gproji_check_positions(mesh->vertex_count, mesh->position, "vertex", error);
    if (code) return code;
    memcpy(temporary, path, strlen(path));
    memcpy(temporary + strlen(path), suffix, sizeof suffix);
    return gproji_save_through(mesh, path, temporary, error);
}

#endif /* GPROJ_NO_STDIO */

/* ============================================================================================================
   >>subdivide   Subdivision by stencils. Uses platform, memory, error, mesh.

   Based on Catmull, Clark: Recursively generated B-spline surfaces on arbitrary topological meshes (1978); Loop: Smooth
   subdivision surfaces based on triangles (1987); Nasri: Polyhedral subdivision methods for free-form surfaces (1987)
   for boundaries; Hoppe et al.: Piecewise smooth surface reconstruction (1994) for creases and corners; DeRose, Kass,
   Truong: Subdivision surfaces in character animation (1998) for creases that end. Products and transposition of
   matrices are Gustavson's (1978).

   A level is its stencil, made row by row from the rules of the interface; the positions are the stencil times the
   coarse ones, and the faces go to the mesh builder as any others do.
   Invariant: boundary edges are sharp, on all levels; their sharpness outlasts them. */

enum {
    GPROJI_LEVELS_MAX = 14,              /* a triangle's 3 corners become 3 * 4^14; 3 * 4^15 are more than a mesh has */
    GPROJI_SHARP = 2 * GPROJI_LEVELS_MAX /* stands for infinite sharpness: more than 1 is left on all levels */
};

/* The owner of a gproj_stencil; its arrays are those that `stencil` shows read-only. */
typedef struct gproji_stencil_object {
    gproji_heap heap; /* first: see gproji_create_object */
    gproj_stencil stencil;
    int64_t *start;
    int32_t *column;
    double *weight;
    size_t column_capacity, weight_capacity;
} gproji_stencil_object;

GPROJI_INLINE gproji_stencil_object *gproji_stencil_owner(gproj_stencil *stencil) {
    return (gproji_stencil_object *)(void *)((char *)stencil - offsetof(gproji_stencil_object, stencil));
}

GPROJ_API void gproj_stencil_destroy(gproj_stencil *stencil) {
    gproji_stencil_object *object;
    if (!stencil) return;
    object = gproji_stencil_owner(stencil);
    gproji_give(&object->heap, object->start, (size_t)stencil->row_count + 1, sizeof *object->start);
    gproji_give(&object->heap, object->column, object->column_capacity, sizeof *object->column);
    gproji_give(&object->heap, object->weight, object->weight_capacity, sizeof *object->weight);
    gproji_destroy_object(object, sizeof *object);
}

GPROJ_API gproj_memory gproj_stencil_memory(const gproj_stencil *stencil) {
    gproj_memory none;
    memset(&none, 0, sizeof none);
    if (!stencil) return none;
    return ((const gproji_stencil_object *)(const void *)((const char *)stencil -
                                                          offsetof(gproji_stencil_object, stencil)))
        ->heap.account;
}

/* Makes room for `entries` entries; false when there is no memory. */
GPROJI_INTERNAL bool gproji_stencil_reserve(gproji_stencil_object *object, size_t entries) {
    void *column = object->column, *weight = object->weight;
    bool enough = gproji_reserve(&object->heap, &column, &object->column_capacity, entries, sizeof(int32_t)) &&
                  gproji_reserve(&object->heap, &weight, &object->weight_capacity, entries, sizeof(double));
    object->stencil.column = object->column = (int32_t *)column;
    object->stencil.weight = object->weight = (double *)weight;
    return enough;
}

/* A stencil of zeros with room for `entries` entries; NULL when there is no memory. */
GPROJI_INTERNAL gproj_stencil *gproji_stencil_begin(int32_t rows, int32_t columns, size_t entries,
                                                    const gproj_host *host) {
    gproji_stencil_object *object = (gproji_stencil_object *)gproji_create_object(host, sizeof *object);
    gproj_stencil *stencil;
    if (!object) return NULL;
    stencil = &object->stencil;
    stencil->row_count = rows, stencil->column_count = columns;
    stencil->start = object->start = (int64_t *)gproji_take_zeroed(&object->heap, (size_t)rows + 1, sizeof(int64_t));
    if (object->start && gproji_stencil_reserve(object, entries)) return stencil;
    gproj_stencil_destroy(stencil);
    return NULL;
}

/* The transposed matrix, with its columns in ascending order; NULL when there is no memory. */
GPROJI_INTERNAL gproj_stencil *gproji_transposed(const gproj_stencil *stencil, const gproj_host *host) {
    int64_t k, entries = stencil->start[stencil->row_count], sum = 0, count;
    gproj_stencil *out = gproji_stencil_begin(stencil->column_count, stencil->row_count, (size_t)entries, host);
    gproji_stencil_object *object;
    int32_t i;
    if (!out) return NULL;
    object = gproji_stencil_owner(out);
    /* start[j] counts, then is where row j begins, then, as row j fills, where it ends; which is start[j + 1] */
    for (k = 0; k < entries; ++k) object->start[stencil->column[k]]++;
    for (i = 0; i <= out->row_count; ++i) {
        count = object->start[i];
        object->start[i] = sum;
        sum += count;
    }
    for (i = 0; i < stencil->row_count; ++i) {
        for (k = stencil->start[i]; k < stencil->start[i + 1]; ++k) {
            int64_t to = object->start[stencil->column[k]]++;
            object->column[to] = i;
            object->weight[to] = stencil->weight[k];
        }
    }
    memmove(object->start + 1, object->start, (size_t)out->row_count * sizeof *object->start);
    object->start[0] = 0;
    return out;
}

GPROJ_API void gproj_stencil_apply(const gproj_stencil *stencil, int32_t size, const double *coarse, double *fine) {
    int32_t i, d;
    int64_t k;
    for (i = 0; stencil && i < stencil->row_count; ++i) {
        for (d = 0; d < size; ++d) {
            double sum = 0;
            for (k = stencil->start[i]; k < stencil->start[i + 1]; ++k)
                sum += stencil->weight[k] * coarse[(size_t)size * (size_t)stencil->column[k] + (size_t)d];
            *fine++ = sum;
        }
    }
}

/* -- rows -- */

/* A stencil that is made row by row. Memory that is missing is noticed at the end. */
typedef struct gproji_rows {
    gproji_heap *heap; /* of `place` */
    const gproj_host *host;
    gproj_stencil *stencil; /* NULL: no memory */
    int32_t column_count;
    int32_t row;    /* the one that is being made */
    int64_t count;  /* of all entries so far */
    int64_t *place; /* of each column, its entry in this row; one of an earlier row, or -1: it has none */
} gproji_rows;

GPROJI_INTERNAL void gproji_rows_drop(gproji_rows *rows) {
    gproj_stencil_destroy(rows->stencil);
    rows->stencil = NULL;
}

GPROJI_INTERNAL void gproji_rows_begin(gproji_rows *rows, int32_t row_count, int32_t column_count, gproji_heap *heap,
                                       const gproj_host *host) {
    int32_t j;
    rows->heap = heap, rows->host = host;
    rows->column_count = column_count, rows->row = 0, rows->count = 0;
    rows->place = (int64_t *)gproji_take(heap, (size_t)column_count, sizeof *rows->place);
    rows->stencil = gproji_stencil_begin(row_count, column_count, 8 * (size_t)row_count, host);
    if (!rows->place) gproji_rows_drop(rows);
    for (j = 0; rows->place && j < column_count; ++j) rows->place[j] = -1;
}

/* Adds a weight to an entry of the row. */
GPROJI_INTERNAL void gproji_rows_add(gproji_rows *rows, int32_t column, double weight) {
    gproji_stencil_object *object;
    if (!rows->stencil) return;
    object = gproji_stencil_owner(rows->stencil);
    if (rows->place[column] < object->start[rows->row]) {
        if (!gproji_stencil_reserve(object, (size_t)rows->count + 1)) {
            gproji_rows_drop(rows);
            return;
        }
        object->column[rows->count] = column;
        object->weight[rows->count] = 0;
        rows->place[column] = rows->count++;
    }
    object->weight[rows->place[column]] += weight;
}

GPROJI_INTERNAL void gproji_rows_next(gproji_rows *rows) {
    rows->row++;
    if (rows->stencil) gproji_stencil_owner(rows->stencil)->start[rows->row] = rows->count;
}

/* The finished stencil with its columns in ascending order: the transposed of the transposed. NULL without memory. */
GPROJI_INTERNAL gproj_stencil *gproji_rows_end(gproji_rows *rows, gproj_error *error) {
    gproj_stencil *turned = NULL, *sorted = NULL;
    gproji_give(rows->heap, rows->place, (size_t)rows->column_count, sizeof *rows->place);
    if (rows->stencil) turned = gproji_transposed(rows->stencil, rows->host);
    gproji_rows_drop(rows);
    if (turned) sorted = gproji_transposed(turned, rows->host);
    gproj_stencil_destroy(turned);
    if (!sorted) gproji_fail_memory(error);
    return sorted;
}

/* -- the rules -- */

/* The mesh of a level and what the rules need besides it. */
typedef struct gproji_level {
    const gproj_mesh *mesh;
    gproj_scheme scheme;
    double *sharpness;  /* of each edge, > 1 at the boundary */
    const bool *corner; /* of the vertices of the first level: it stays. Later vertices are no corners */
    int32_t corner_count;
} gproji_level;

/* The mean of a face's corners. */
GPROJI_INTERNAL void gproji_add_face_rule(const gproj_mesh *mesh, int32_t face, double share, gproji_rows *rows) {
    int32_t h = mesh->face_halfedge[face], k;
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h])
        gproji_rows_add(rows, mesh->origin[h], share / mesh->face_degree[face]);
}

/* An edge: the smooth rule and the sharp one, blended by its sharpness. */
GPROJI_INTERNAL void gproji_add_edge_rule(const gproji_level *level, int32_t edge, gproji_rows *rows) {
    const gproj_mesh *mesh = level->mesh;
    bool loop = level->scheme == GPROJ_LOOP;
    double sharp = gproji_fmin(level->sharpness[edge], 1), smooth = 1 - sharp;
    double end = sharp / 2 + smooth * (loop ? 0.375 : 0.25);
    int32_t h;
    for (h = 2 * edge; h <= 2 * edge + 1; ++h) gproji_rows_add(rows, mesh->origin[h], end);
    for (h = 2 * edge; smooth > 0 && h <= 2 * edge + 1; ++h) {
        if (loop)
            gproji_rows_add(rows, mesh->origin[mesh->prev[h]], smooth / 8);
        else
            gproji_add_face_rule(mesh, mesh->face[h], smooth / 4, rows);
    }
}

/* A vertex without a corner or crease, inside. */
GPROJI_INTERNAL void gproji_add_smooth_rule(const gproji_level *level, int32_t vertex, double share,
                                            gproji_rows *rows) {
    const gproj_mesh *mesh = level->mesh;
    int32_t start = mesh->vertex_halfedge[vertex], h = start;
    double n = gproj_mesh_valence(mesh, vertex), ring;
    if (level->scheme == GPROJ_LOOP) {
        double c = 0.375 + 0.25 * cos(6.283185307179586 / n);
        ring = share * (0.625 - c * c) / n;
        gproji_rows_add(rows, vertex, share - n * ring);
    } else {
        ring = share / (n * n);
        gproji_rows_add(rows, vertex, share * (n - 2) / n);
    }
    do {
        gproji_rows_add(rows, mesh->origin[h ^ 1], ring);
        if (level->scheme != GPROJ_LOOP) gproji_add_face_rule(mesh, mesh->face[h], ring, rows);
        h = gproji_rotate(mesh, h);
    } while (h != start);
}

/* A vertex whose edges of more than this sharpness are sharp: smooth, on a crease, or a corner. */
GPROJI_INTERNAL void gproji_add_vertex_rule(const gproji_level *level, int32_t vertex, double least, double share,
                                            gproji_rows *rows) {
    const gproj_mesh *mesh = level->mesh;
    int32_t start = mesh->vertex_halfedge[vertex], h = start, end[2] = {0, 0}, sharp = 0;
    do {
        if (level->sharpness[h / 2] > least) {
            if (sharp < 2) end[sharp] = mesh->origin[h ^ 1];
            ++sharp;
        }
        h = gproji_rotate(mesh, h);
    } while (h != start);
    if (sharp < 2) {
        gproji_add_smooth_rule(level, vertex, share, rows);
    } else if (sharp == 2) {
        gproji_rows_add(rows, end[0], 0.125 * share);
        gproji_rows_add(rows, vertex, 0.75 * share);
        gproji_rows_add(rows, end[1], 0.125 * share);
    } else {
        gproji_rows_add(rows, vertex, share);
    }
}

/* The mean sharpness of the edges at a vertex that are sharp on this level and smooth on the next; 1 without any. */
GPROJI_INTERNAL double gproji_ending_sharpness(const gproji_level *level, int32_t vertex) {
    int32_t start = level->mesh->vertex_halfedge[vertex], h = start, count = 0;
    double sum = 0;
    do {
        double s = level->sharpness[h / 2];
        if (s > 0 && s <= 1) sum += s, ++count;
        h = gproji_rotate(level->mesh, h);
    } while (h != start);
    return count ? sum / count : 1;
}

GPROJI_INTERNAL void gproji_add_vertex_row(const gproji_level *level, int32_t vertex, gproji_rows *rows) {
    double now;
    if (level->mesh->vertex_halfedge[vertex] < 0 || (vertex < level->corner_count && level->corner[vertex])) {
        gproji_rows_add(rows, vertex, 1);
        return;
    }
    now = gproji_ending_sharpness(level, vertex);
    gproji_add_vertex_rule(level, vertex, 0, now, rows);
    if (now < 1) gproji_add_vertex_rule(level, vertex, 1, 1 - now, rows);
}

/* -- one level -- */

/* How large a level is. */
typedef struct gproji_counts {
    int64_t vertices, edges, faces, corners;
    int64_t polyline_vertices; /* at most: if all polylines run along edges */
} gproji_counts;

GPROJI_INTERNAL gproji_counts gproji_count(const gproj_mesh *mesh) {
    gproji_counts counts = {0, 0, 0, 0, 0};
    int32_t f;
    counts.vertices = mesh->vertex_count;
    counts.edges = mesh->edge_count;
    counts.faces = mesh->face_count;
    for (f = 0; f < mesh->face_count; ++f) counts.corners += mesh->face_degree[f];
    counts.polyline_vertices = mesh->polyline_start[mesh->polyline_count];
    return counts;
}

GPROJI_INTERNAL gproji_counts gproji_count_next(gproji_counts counts, gproj_scheme scheme) {
    gproji_counts next;
    next.vertices = counts.vertices + counts.edges + (scheme == GPROJ_LOOP ? 0 : counts.faces);
    next.edges = 2 * counts.edges + counts.corners;
    next.faces = scheme == GPROJ_LOOP ? 4 * counts.faces : counts.corners;
    next.corners = 4 * counts.corners;
    next.polyline_vertices = 2 * counts.polyline_vertices;
    return next;
}

GPROJI_INTERNAL gproj_stencil *gproji_level_stencil(const gproji_level *level, gproji_heap *heap,
                                                    const gproj_host *host, gproj_error *error) {
    const gproj_mesh *mesh = level->mesh;
    gproji_rows rows;
    int32_t i;
    gproji_counts next = gproji_count_next(gproji_count(mesh), level->scheme);
    gproji_rows_begin(&rows, (int32_t)next.vertices, mesh->vertex_count, heap, host);
    for (i = 0; rows.stencil && i < mesh->vertex_count; ++i, gproji_rows_next(&rows))
        gproji_add_vertex_row(level, i, &rows);
    for (i = 0; rows.stencil && i < mesh->edge_count; ++i, gproji_rows_next(&rows))
        gproji_add_edge_rule(level, i, &rows);
    for (i = 0; rows.stencil && level->scheme != GPROJ_LOOP && i < mesh->face_count; ++i, gproji_rows_next(&rows))
        gproji_add_face_rule(mesh, i, 1, &rows);
    return gproji_rows_end(&rows, error);
}

/* The faces of the next level: their degrees and corners, one after the other. */
GPROJI_INTERNAL void gproji_level_faces(const gproji_level *level, int32_t *degree, int32_t *corner) {
    const gproj_mesh *mesh = level->mesh;
    int32_t f, k, edges = mesh->vertex_count, faces = edges + mesh->edge_count;
    bool loop = level->scheme == GPROJ_LOOP;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        for (k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
            *corner++ = mesh->origin[h];
            *corner++ = edges + h / 2;
            if (!loop) *corner++ = faces + f;
            *corner++ = edges + mesh->prev[h] / 2;
            *degree++ = loop ? 3 : 4;
        }
        if (!loop) continue;
        for (k = 0; k < 3; ++k, h = mesh->next[h]) *corner++ = edges + h / 2;
        *degree++ = 3;
    }
}

/* The half-edge from vertex a to vertex b; -1: they have no edge. */
GPROJI_INTERNAL int32_t gproji_halfedge_between(const gproj_mesh *mesh, int32_t a, int32_t b) {
    int32_t start = mesh->vertex_halfedge[a], h = start;
    if (start < 0) return -1;
    do {
        if (mesh->origin[h ^ 1] == b) return h;
        h = gproji_rotate(mesh, h);
    } while (h != start);
    return -1;
}

/* The polylines of the next level: `start`, polyline_count + 1 entries, and `vertex`, unless that is NULL. Returns the
   number of their vertices. */
GPROJI_INTERNAL int32_t gproji_level_polylines(const gproj_mesh *mesh, int32_t *start, int32_t *vertex) {
    int32_t p, i, h, count = 0;
    for (p = 0; p < mesh->polyline_count; ++p) {
        start[p] = count;
        for (i = mesh->polyline_start[p]; i < mesh->polyline_start[p + 1]; ++i) {
            int32_t v = mesh->polyline_vertex[i];
            bool last = i + 1 == mesh->polyline_start[p + 1];
            if (vertex) vertex[count] = v;
            ++count;
            h = last ? -1 : gproji_halfedge_between(mesh, v, mesh->polyline_vertex[i + 1]);
            if (h < 0) continue;
            if (vertex) vertex[count] = mesh->vertex_count + h / 2;
            ++count;
        }
    }
    start[p] = count;
    return count;
}

GPROJI_INTERNAL gproj_code gproji_set_level_polylines(gproji_mesh_object *object, const gproj_mesh *mesh,
                                                      gproji_heap *heap, gproj_error *error) {
    size_t starts = (size_t)mesh->polyline_count + 1, vertices = 0;
    int32_t *start = (int32_t *)gproji_take(heap, starts, sizeof *start), *vertex = NULL;
    gproj_code code;
    if (start) {
        vertices = (size_t)gproji_level_polylines(mesh, start, NULL);
        vertex = (int32_t *)gproji_take(heap, vertices, sizeof *vertex);
    }
    if (vertex) {
        gproji_level_polylines(mesh, start, vertex);
        code = gproji_mesh_set_polylines(object, mesh->polyline_count, start, vertex, error);
    } else {
        code = gproji_fail_memory(error);
    }
    gproji_give(heap, vertex, vertices, sizeof *vertex);
    gproji_give(heap, start, starts, sizeof *start);
    return code;
}

/* The mesh of the next level. */
GPROJI_INTERNAL gproj_mesh *gproji_level_mesh(const gproji_level *level, const gproj_stencil *stencil,
                                              gproji_heap *heap, const gproj_host *host, gproj_error *error) {
    gproji_counts next = gproji_count_next(gproji_count(level->mesh), level->scheme);
    size_t vertices = (size_t)next.vertices, faces = (size_t)next.faces, corners = (size_t)next.corners;
    gproji_mesh_object *object = gproji_mesh_begin(host, error);
    double *position = (double *)gproji_take(heap, vertices, 3 * sizeof *position);
    int32_t *degree = (int32_t *)gproji_take(heap, faces, sizeof *degree);
    int32_t *corner = (int32_t *)gproji_take(heap, corners, sizeof *corner);
    gproj_code code = GPROJ_ERROR_MEMORY;
    if (object && position && degree && corner) {
        gproji_soup soup;
        gproj_stencil_apply(stencil, 3, level->mesh->position, position);
        gproji_level_faces(level, degree, corner);
        soup.vertex_count = (int32_t)next.vertices, soup.face_count = (int32_t)next.faces, soup.corner_count = 0;
        soup.position = position, soup.face_degree = degree, soup.face_vertex = corner;
        code = gproji_mesh_build(object, &soup, error);
        if (!code) code = gproji_set_level_polylines(object, level->mesh, heap, error);
    } else {
        gproji_fail_memory(error);
    }
    gproji_give(heap, position, vertices, 3 * sizeof *position);
    gproji_give(heap, degree, faces, sizeof *degree);
    gproji_give(heap, corner, corners, sizeof *corner);
    return object ? gproji_mesh_done(object, code) : NULL;
}

/* What is left of the sharpness on the next level: of each half of an edge one less, of new edges nothing. Each coarse
   corner's face there begins with the halves of two edges, the last one and the first one of its corner. */
GPROJI_INTERNAL void gproji_level_creases(const gproji_level *level, const gproj_mesh *fine, double *sharpness) {
    const gproj_mesh *mesh = level->mesh;
    int32_t f, k, e, at = 0;
    for (e = 0; e < fine->edge_count; ++e) sharpness[e] = 0;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        for (k = 0; k < mesh->face_degree[f]; ++k, ++at, h = mesh->next[h]) {
            int32_t half = fine->face_halfedge[at];
            sharpness[half / 2] = gproji_fmax(level->sharpness[h / 2] - 1, 0);
            sharpness[fine->prev[half] / 2] = gproji_fmax(level->sharpness[mesh->prev[h] / 2] - 1, 0);
        }
        if (level->scheme == GPROJ_LOOP) ++at; /* the face in the middle */
    }
}

/* -- the stencil's functions -- */

GPROJ_API gproj_stencil *gproj_stencil_transpose(const gproj_stencil *stencil, const gproj_host *host,
                                                 gproj_error *error) {
    gproj_stencil *transposed;
    gproji_error_clear(error);
    if (!stencil) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the stencil to transpose is NULL");
        return NULL;
    }
    transposed = gproji_transposed(stencil, host);
    if (!transposed) gproji_fail_memory(error);
    return transposed;
}

GPROJ_API gproj_stencil *gproj_stencil_multiply(const gproj_stencil *fine, const gproj_stencil *coarse,
                                                const gproj_host *host, gproj_error *error) {
    gproji_heap heap = gproji_heap_of(host);
    gproji_rows rows;
    int64_t k, l;
    int32_t i;
    gproji_error_clear(error);
    if (!fine || !coarse) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "a stencil to multiply is NULL");
        return NULL;
    }
    if (fine->column_count != coarse->row_count) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "the fine stencil starts from %d vertices, but the coarse one leads to %d; give the fine one first",
                    fine->column_count, coarse->row_count);
        return NULL;
    }
    gproji_rows_begin(&rows, fine->row_count, coarse->column_count, &heap, host);
    for (i = 0; rows.stencil && i < fine->row_count; ++i, gproji_rows_next(&rows)) {
        for (k = fine->start[i]; k < fine->start[i + 1]; ++k) {
            int32_t middle = fine->column[k];
            for (l = coarse->start[middle]; l < coarse->start[middle + 1]; ++l)
                gproji_rows_add(&rows, coarse->column[l], fine->weight[k] * coarse->weight[l]);
        }
    }
    return gproji_rows_end(&rows, error);
}

/* -- all levels -- */

/* The state between two levels. Meshes and stencils have their own memory. */
typedef struct gproji_subdivision {
    gproji_heap heap; /* of the work arrays */
    const gproj_host *host;
    gproj_error *error;
    const gproj_subdivide_options *options;
    gproji_level level;
    bool *corner;           /* of each vertex of the first mesh */
    gproj_mesh *own;        /* the level's mesh, unless it is the caller's */
    gproj_stencil *stencil; /* from level stencil_level to this one; NULL: none is wanted, or not yet */
} gproji_subdivision;

GPROJI_INTERNAL gproj_code gproji_check_level_counts(const gproj_mesh *mesh, const gproj_subdivide_options *options,
                                                     gproj_error *error) {
    gproji_counts counts = gproji_count(mesh);
    int32_t level;
    for (level = 1; level <= options->levels; ++level) {
        counts = gproji_count_next(counts, options->scheme);
        if (counts.vertices > GPROJI_VERTICES_MAX || counts.corners > GPROJI_CORNERS_MAX ||
            counts.polyline_vertices > INT32_MAX) {
            return gproji_fail(
                error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1,
                "subdivide: level %d would have %l vertices, %l faces and up to %l in polylines, more than a mesh "
                "can have; take fewer levels",
                level, counts.vertices, counts.faces, counts.polyline_vertices);
        }
    }
    return GPROJ_OK;
}

/* Loop's scheme takes triangles, no two of them with the same corners: those of the next level would share edges. */
GPROJI_INTERNAL gproj_code gproji_check_triangles(const gproj_mesh *mesh, gproj_error *error) {
    int32_t f;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f], other = mesh->face[h ^ 1];
        if (mesh->face_degree[f] != 3) {
            return gproji_fail(
                error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_FACE, f,
                "subdivide: face %d has %d corners, but Loop's scheme takes triangles; use Catmull-Clark, "
                "or cut the faces into triangles",
                f, mesh->face_degree[f]);
        }
        if (other >= 0 && mesh->origin[mesh->prev[h]] == mesh->origin[mesh->prev[h ^ 1]]) {
            return gproji_fail(
                error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, f,
                "subdivide: faces %d and %d have the same three corners, and their finer faces would share "
                "edges; use Catmull-Clark, or remove them",
                f, other);
        }
    }
    return GPROJ_OK;
}

/* The sharpness of a crease of the options, at most GPROJI_SHARP; < 0 where it is no such number. */
GPROJI_INTERNAL double gproji_crease_sharpness(const gproj_subdivide_options *options, int32_t crease) {
    double x = GPROJI_SHARP;
    uint64_t bits;
    if (options->sharpness) x = options->sharpness[crease];
    memcpy(&bits, &x, sizeof bits);
    if (bits == UINT64_C(0x7ff0000000000000)) return GPROJI_SHARP; /* infinite */
    return gproji_is_finite(x) ? gproji_fmin(x, GPROJI_SHARP) : -1;
}

GPROJI_INTERNAL gproj_code gproji_check_creases(const gproj_mesh *mesh, const gproj_subdivide_options *options,
                                                gproj_error *error) {
    int32_t k;
    if (options->crease_count < 0 || options->corner_count < 0) {
        return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "subdivide: %d creases and %d corners",
                           options->crease_count, options->corner_count);
    }
    for (k = 0; k < options->crease_count; ++k) {
        int32_t e = options->creases ? options->creases[k] : k;
        if (e < 0 || e >= mesh->edge_count) {
            return gproji_fail(error, GPROJ_ERROR_INDEX, GPROJ_PLACE_EDGE, e,
                               "subdivide: crease %d is edge %d, but the mesh has %d edges, counted from 0", k, e,
                               mesh->edge_count);
        }
        if (gproji_crease_sharpness(options, k) < 0) {
            return gproji_fail(error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_EDGE, e,
                               "subdivide: the sharpness of edge %d is %g; give 0 (smooth) to INFINITY (sharp)", e,
                               options->sharpness[k]);
        }
    }
    for (k = 0; k < options->corner_count; ++k) {
        int32_t v = options->corners ? options->corners[k] : k;
        if (v >= 0 && v < mesh->vertex_count) continue;
        return gproji_fail(error, GPROJ_ERROR_INDEX, GPROJ_PLACE_VERTEX, v,
                           "subdivide: corner %d is vertex %d, but the mesh has %d vertices, counted from 0", k, v,
                           mesh->vertex_count);
    }
    return GPROJ_OK;
}

GPROJI_INTERNAL gproj_code gproji_check_subdivision(const gproj_mesh *mesh, const gproj_subdivide_options *options,
                                                    gproj_error *error) {
    gproj_code code;
    if (options->scheme != GPROJ_CATMULL_CLARK && options->scheme != GPROJ_LOOP) {
        return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "subdivide: there is no scheme %d",
                           (int32_t)options->scheme);
    }
    if (options->levels < 1 || options->levels > GPROJI_LEVELS_MAX) {
        return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                           "subdivide: %d levels; take 1 to %d (0 means 1)", options->levels,
                           (int32_t)GPROJI_LEVELS_MAX);
    }
    if (options->stencil_level < 0 || options->stencil_level >= options->levels) {
        return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                           "subdivide: a stencil from level %d to level %d; take 0 to %d", options->stencil_level,
                           options->levels, options->levels - 1);
    }
    code = gproji_check_positions(mesh->vertex_count, mesh->position, "vertex", error);
    if (!code && options->scheme == GPROJ_LOOP) code = gproji_check_triangles(mesh, error);
    if (!code) code = gproji_check_creases(mesh, options, error);
    return code ? code : gproji_check_level_counts(mesh, options, error);
}

/* The first level: corners, and the sharpness of the edges. */
GPROJI_INTERNAL gproj_code gproji_subdivision_begin(gproji_subdivision *s, const gproj_mesh *mesh) {
    const gproj_subdivide_options *options = s->options;
    double *sharpness = (double *)gproji_take(&s->heap, (size_t)mesh->edge_count, sizeof *sharpness);
    int32_t k;
    s->level.mesh = mesh, s->level.scheme = options->scheme, s->level.sharpness = sharpness;
    s->level.corner_count = mesh->vertex_count;
    s->level.corner = s->corner = (bool *)gproji_take_zeroed(&s->heap, (size_t)mesh->vertex_count, sizeof *s->corner);
    if (!sharpness || !s->corner) return gproji_fail_memory(s->error);
    for (k = 0; k < mesh->edge_count; ++k)
        sharpness[k] = mesh->face[2 * k] < 0 || mesh->face[2 * k + 1] < 0 ? GPROJI_SHARP : 0;
    for (k = 0; k < options->crease_count; ++k) {
        double *edge = sharpness + (options->creases ? options->creases[k] : k);
        *edge = gproji_fmax(*edge, gproji_crease_sharpness(options, k));
    }
    for (k = 0; k < options->corner_count; ++k) s->corner[options->corners ? options->corners[k] : k] = true;
    for (k = 0; k < mesh->vertex_count && !options->round_corners; ++k)
        if (gproj_mesh_is_boundary_vertex(mesh, k) && gproj_mesh_valence(mesh, k) == 2) s->corner[k] = true;
    return GPROJ_OK;
}

/* Takes a level's stencil into that of all levels; it is given away. */
GPROJI_INTERNAL gproj_code gproji_take_stencil(gproji_subdivision *s, gproj_stencil *step) {
    gproj_stencil *both = step;
    if (s->stencil) {
        both = gproj_stencil_multiply(step, s->stencil, s->host, s->error);
        gproj_stencil_destroy(step);
        gproj_stencil_destroy(s->stencil);
    }
    s->stencil = both;
    return both ? GPROJ_OK : GPROJ_ERROR_MEMORY;
}

/* From a level to the next one. */
GPROJI_INTERNAL gproj_code gproji_subdivision_next(gproji_subdivision *s, bool keep_stencil) {
    gproji_level *level = &s->level;
    gproj_code code = GPROJ_ERROR_MEMORY;
    gproj_stencil *step = gproji_level_stencil(level, &s->heap, s->host, s->error);
    gproj_mesh *fine = step ? gproji_level_mesh(level, step, &s->heap, s->host, s->error) : NULL;
    double *sharpness = NULL;
    if (fine) {
        sharpness = (double *)gproji_take(&s->heap, (size_t)fine->edge_count, sizeof *sharpness);
        code = sharpness ? GPROJ_OK : gproji_fail_memory(s->error);
    }
    if (code) {
        gproj_mesh_destroy(fine);
        gproj_stencil_destroy(step);
        return code;
    }
    gproji_level_creases(level, fine, sharpness);
    gproji_give(&s->heap, level->sharpness, (size_t)level->mesh->edge_count, sizeof *level->sharpness);
    gproj_mesh_destroy(s->own);
    level->sharpness = sharpness;
    level->mesh = s->own = fine;
    if (keep_stencil) return gproji_take_stencil(s, step);
    gproj_stencil_destroy(step);
    return GPROJ_OK;
}

GPROJ_API gproj_mesh *gproj_mesh_subdivide(const gproj_mesh *mesh, const gproj_subdivide_options *options,
                                           gproj_stencil **stencil, const gproj_host *host, gproj_error *error) {
    gproj_subdivide_options given;
    gproji_subdivision s;
    gproj_code code;
    int32_t level;
    gproji_error_clear(error);
    if (stencil) *stencil = NULL;
    if (!mesh) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the mesh to subdivide is NULL");
        return NULL;
    }
    memset(&given, 0, sizeof given);
    if (options) given = *options;
    if (given.levels == 0) given.levels = 1;
    if (gproji_check_subdivision(mesh, &given, error)) return NULL;
    memset(&s, 0, sizeof s);
    s.heap = gproji_heap_of(host);
    s.host = host, s.error = error, s.options = &given;
    code = gproji_subdivision_begin(&s, mesh);
    for (level = 0; !code && level < given.levels; ++level)
        code = gproji_subdivision_next(&s, stencil && level >= given.stencil_level);
    gproji_give(&s.heap, s.corner, (size_t)mesh->vertex_count, sizeof *s.corner);
    gproji_give(&s.heap, s.level.sharpness, (size_t)s.level.mesh->edge_count, sizeof *s.level.sharpness);
    if (code) {
        gproj_mesh_destroy(s.own);
        gproj_stencil_destroy(s.stencil);
        return NULL;
    }
    if (stencil) *stencil = s.stencil;
    return s.own;
}

/* ============================================================================================================
   >>hierarchy   Closest items by a hierarchy of bounding boxes. Uses platform, memory, vector.

   A binary tree of axis-parallel boxes over items 0..n-1 (segments, triangles), split at the median of the box centres
   along the longest axis of the node's centres, down to leaves of at most four items; searched depth first, the nearer
   child first (Goldsmith and Salmon 1987; Ericson 2005, chapter 6). Building sorts the items once along each axis and
   then only splits sorted lists, so it takes O(n log n) steps for any input and gives the same tree on any machine.
   Invariants: nodes stand in preorder, so the left child of node i is i + 1; a node covers the items
   item[begin..end-1]; the halves differ by one item at most, so no path is longer than 32 nodes. */
typedef struct gproji_node {
    double low[3], high[3];
    int32_t begin, end;
    int32_t right; /* the right child, -1 in a leaf */
} gproji_node;

typedef struct gproji_hierarchy {
    int32_t item_count, node_count;
    int32_t *item;     /* item_count: a permutation of the items */
    gproji_node *node; /* room for item_count */
} gproji_hierarchy;

enum {
    GPROJI_LEAF_ITEMS = 4,
    GPROJI_TREE_DEPTH = 64
};

/* The box of an item; its squared distance from a point. */
typedef void (*gproji_item_box)(const void *user, int32_t item, double low[3], double high[3]);
typedef double (*gproji_item_distance)(const void *user, int32_t item, const double point[3]);

/* -- building -- */

typedef struct gproji_hierarchy_work {
    double *box;       /* 6 * item_count: low and high of each item */
    int32_t *order[3]; /* item_count each: the items by centre along x, y, z (then by number), within every node */
    int32_t *spare;    /* item_count: scratch of sorting and splitting */
    uint8_t *left;     /* item_count: 1 where an item goes to the left child of the node at hand */
} gproji_hierarchy_work;

/* Twice the centre. */
GPROJI_INLINE double gproji_box_centre(const gproji_hierarchy_work *work, int32_t item, int32_t axis) {
    return work->box[6 * (size_t)item + (size_t)axis] + work->box[6 * (size_t)item + 3 + (size_t)axis];
}

/* Sorts order[axis] by merging runs of 1, 2, 4, ... items; equal centres stay in the order of the items. */
GPROJI_INTERNAL void gproji_sort_axis(gproji_hierarchy_work *work, int32_t count, int32_t axis) {
    int32_t *from = work->order[axis], *to = work->spare, *swap;
    int64_t width, begin;
    int32_t i;
    for (i = 0; i < count; ++i) from[i] = i;
    for (width = 1; width < count; width *= 2) {
        for (begin = 0; begin < count; begin += 2 * width) {
            int64_t middle = begin + width < count ? begin + width : count;
            int64_t end = begin + 2 * width < count ? begin + 2 * width : count, a = begin, b = middle, out;
            for (out = begin; out < end; ++out) {
                bool take_b = a == middle || (b < end && gproji_box_centre(work, from[b], axis) <
                                                             gproji_box_centre(work, from[a], axis));
                to[out] = take_b ? from[b++] : from[a++];
            }
        }
        swap = from, from = to, to = swap;
    }
    work->order[axis] = from;
    work->spare = to;
}

/* Moves the items with left = 1 to the front of list[begin..end-1], both parts keeping their order. */
GPROJI_INTERNAL void gproji_split_list(const gproji_hierarchy_work *work, int32_t *list, int32_t begin, int32_t end) {
    int32_t i, front = begin, back = 0;
    for (i = begin; i < end; ++i) {
        if (work->left[list[i]])
            list[front++] = list[i];
        else
            work->spare[back++] = list[i];
    }
    memcpy(list + front, work->spare, (size_t)back * sizeof list[0]);
}

/* The node's box, and the axis along which the centres of its items spread most. */
GPROJI_INTERNAL int32_t gproji_bound_node(const gproji_hierarchy_work *work, gproji_node *node) {
    int32_t axis, widest = 0, i;
    double spread[3];
    for (axis = 0; axis < 3; ++axis) {
        const int32_t *list = work->order[axis];
        spread[axis] =
            gproji_box_centre(work, list[node->end - 1], axis) - gproji_box_centre(work, list[node->begin], axis);
        node->low[axis] = DBL_MAX, node->high[axis] = -DBL_MAX;
        for (i = node->begin; i < node->end; ++i) {
            const double *box = work->box + 6 * (size_t)list[i] + axis;
            node->low[axis] = gproji_fmin(node->low[axis], box[0]);
            node->high[axis] = gproji_fmax(node->high[axis], box[3]);
        }
        if (spread[axis] > spread[widest]) widest = axis;
    }
    return widest;
}

/* Builds the nodes in preorder with an explicit stack of the right children still to be made. */
GPROJI_INTERNAL void gproji_grow_hierarchy(gproji_hierarchy *tree, gproji_hierarchy_work *work) {
    int32_t stack_begin[GPROJI_TREE_DEPTH], stack_end[GPROJI_TREE_DEPTH], stack_parent[GPROJI_TREE_DEPTH], depth = 0;
    int32_t begin = 0, end = tree->item_count, parent = -1;
    for (;;) {
        gproji_node *node = &tree->node[tree->node_count];
        int32_t axis, other, middle, i;
        if (parent >= 0) tree->node[parent].right = tree->node_count;
        tree->node_count++;
        node->begin = begin, node->end = end, node->right = -1;
        axis = gproji_bound_node(work, node);
        if (end - begin > GPROJI_LEAF_ITEMS) {
            middle = begin + (end - begin) / 2;
            for (i = begin; i < end; ++i) work->left[work->order[axis][i]] = i < middle;
            for (other = 0; other < 3; ++other) {
                if (other != axis) gproji_split_list(work, work->order[other], begin, end);
            }
            stack_begin[depth] = middle, stack_end[depth] = end, stack_parent[depth] = tree->node_count - 1;
            ++depth;
            end = middle, parent = -1;
        } else if (depth) {
            --depth;
            begin = stack_begin[depth], end = stack_end[depth], parent = stack_parent[depth];
        } else {
            break;
        }
    }
}

GPROJI_INTERNAL void gproji_hierarchy_give(gproji_heap *heap, gproji_hierarchy *tree) {
    gproji_give(heap, tree->item, (size_t)tree->item_count, sizeof(int32_t));
    gproji_give(heap, tree->node, (size_t)tree->item_count, sizeof(gproji_node));
    tree->item = NULL, tree->node = NULL;
}

/* False when there is no memory. Needs count >= 1. */
GPROJI_INTERNAL bool gproji_hierarchy_build(gproji_heap *heap, gproji_hierarchy *tree, int32_t count,
                                            gproji_item_box item_box, const void *user) {
    gproji_hierarchy_work work;
    size_t n = (size_t)count;
    int32_t i, axis;
    bool complete = true;
    memset(tree, 0, sizeof *tree);
    memset(&work, 0, sizeof work);
    tree->item_count = count;
    tree->item = (int32_t *)gproji_take(heap, n, sizeof(int32_t));
    tree->node = (gproji_node *)gproji_take(heap, n, sizeof(gproji_node));
    work.box = (double *)gproji_take(heap, n, 6 * sizeof(double));
    work.spare = (int32_t *)gproji_take(heap, n, sizeof(int32_t));
    work.left = (uint8_t *)gproji_take(heap, n, sizeof(uint8_t));
    for (axis = 0; axis < 3; ++axis) {
        work.order[axis] = (int32_t *)gproji_take(heap, n, sizeof(int32_t));
        if (!work.order[axis]) complete = false;
    }
    complete = complete && tree->item && tree->node && work.box && work.spare && work.left;
    if (complete) {
        for (i = 0; i < count; ++i) item_box(user, i, work.box + 6 * (size_t)i, work.box + 6 * (size_t)i + 3);
        for (axis = 0; axis < 3; ++axis) gproji_sort_axis(&work, count, axis);
        gproji_grow_hierarchy(tree, &work);
        memcpy(tree->item, work.order[0], n * sizeof(int32_t));
    }
    for (axis = 0; axis < 3; ++axis) gproji_give(heap, work.order[axis], n, sizeof(int32_t));
    gproji_give(heap, work.left, n, sizeof(uint8_t));
    gproji_give(heap, work.spare, n, sizeof(int32_t));
    gproji_give(heap, work.box, n, 6 * sizeof(double));
    if (!complete) gproji_hierarchy_give(heap, tree);
    return complete;
}

/* -- searching -- */

/* The squared distance of a point from a node's box, made smaller by more than its own rounding error, so that an item
   that is as near as another one is looked at. */
GPROJI_INLINE double gproji_box_distance(const gproji_node *node, const double point[3]) {
    double sum = 0;
    int32_t axis;
    for (axis = 0; axis < 3; ++axis) {
        double below = node->low[axis] - point[axis], above = point[axis] - node->high[axis];
        double d = gproji_fmax(gproji_fmax(below, above), 0.0);
        sum += d * d;
    }
    return sum * (1 - 1e-13);
}

/* The item nearest to a point; among equally near ones that with the lowest number. */
GPROJI_INTERNAL int32_t gproji_hierarchy_closest(const gproji_hierarchy *tree, const double point[3],
                                                 gproji_item_distance distance, const void *user) {
    int32_t stack_node[GPROJI_TREE_DEPTH], depth = 0, best_item = -1, i;
    double stack_distance[GPROJI_TREE_DEPTH], best = DBL_MAX, here = 0;
    int32_t at = 0;
    for (;;) {
        const gproji_node *node = &tree->node[at];
        if (here <= best && node->right >= 0) {
            int32_t near_child = at + 1, far_child = node->right;
            double near_distance = gproji_box_distance(&tree->node[near_child], point);
            double far_distance = gproji_box_distance(&tree->node[far_child], point);
            if (far_distance < near_distance) {
                double d = near_distance;
                near_distance = far_distance, far_distance = d;
                far_child = near_child, near_child = node->right;
            }
            stack_node[depth] = far_child, stack_distance[depth] = far_distance;
            ++depth;
            at = near_child, here = near_distance;
            continue;
        }
        for (i = node->begin; i < node->end && here <= best && node->right < 0; ++i) {
            double d = distance(user, tree->item[i], point);
            if (d < best || (d <= best && (best_item < 0 || tree->item[i] < best_item))) {
                best = d;
                best_item = tree->item[i];
            }
        }
        if (!depth) break;
        --depth;
        at = stack_node[depth], here = stack_distance[depth];
    }
    return best_item < 0 ? 0 : best_item; /* a point that is not finite is not near to anything */
}

/* ============================================================================================================
   >>curve   Polylines and their closest points. Uses platform, memory, error, vector, mesh, hierarchy.

   Invariants: segment s runs from point s to point s + 1 (a closed curve repeats its first point at its end); every
   tangent is a unit vector, also that of a segment without length, which has the tangent of the segment before it. */
struct gproj_curve {
    gproji_heap heap; /* first: see gproji_create_object */
    int32_t segment_count;
    double *point;         /* 3 * (segment_count + 1) */
    double *tangent;       /* 3 * segment_count */
    gproji_hierarchy tree; /* over the segments */
};

/* The point a + t (b - a), 0 <= t <= 1, nearest to p, into `out`; returns t. A point that is not finite gives t = 0. */
GPROJI_INTERNAL double gproji_closest_on_segment(const double a[3], const double b[3], const double p[3],
                                                 double out[3]) {
    double ab[3], ap[3], square, t;
    gproji_sub3(b, a, ab);
    gproji_sub3(p, a, ap);
    square = gproji_dot3(ab, ab);
    t = square > 0 ? gproji_dot3(ab, ap) / square : 0;
    if (t >= 1) {
        gproji_copy3(b, out); /* exactly, so that neighbouring segments agree on their common point */
        return 1;
    }
    if (!(t > 0)) t = 0;
    gproji_copy3(a, out);
    gproji_add_scaled3(t, ab, out);
    return t;
}

GPROJI_INLINE double gproji_square_distance3(const double a[3], const double b[3]) {
    double d[3];
    gproji_sub3(a, b, d);
    return gproji_dot3(d, d);
}

GPROJI_INTERNAL void gproji_segment_box(const void *user, int32_t item, double low[3], double high[3]) {
    const double *a = ((const gproj_curve *)user)->point + 3 * (size_t)item, *b = a + 3;
    int32_t k;
    for (k = 0; k < 3; ++k) {
        low[k] = gproji_fmin(a[k], b[k]);
        high[k] = gproji_fmax(a[k], b[k]);
    }
}

GPROJI_INTERNAL double gproji_segment_distance(const void *user, int32_t item, const double point[3]) {
    const double *a = ((const gproj_curve *)user)->point + 3 * (size_t)item;
    double out[3];
    gproji_closest_on_segment(a, a + 3, point, out);
    return gproji_square_distance3(out, point);
}

/* Directions of all segments. Those shorter than 1e-14 of the curve's extent have none of their own and take over that
   of the segment before (an open curve's first ones: of the first segment that has one). False where none has. */
GPROJI_INTERNAL bool gproji_curve_tangents(gproj_curve *curve, bool closed) {
    const double zero[3] = {0, 0, 0};
    double extent = 0, last[3] = {0, 0, 0}, *t;
    int32_t s, k, from = -1;
    for (s = 0; s <= curve->segment_count; ++s) {
        for (k = 0; k < 3; ++k)
            extent = gproji_fmax(extent, fabs(curve->point[3 * (size_t)s + (size_t)k] - curve->point[k]));
    }
    for (s = 0; s < curve->segment_count; ++s) {
        t = curve->tangent + 3 * (size_t)s;
        gproji_sub3(curve->point + 3 * (size_t)s + 3, curve->point + 3 * (size_t)s, t);
        if (gproji_length3(t) <= 1e-14 * extent)
            gproji_set3(0, 0, 0, t);
        else
            gproji_normalise3(t, zero);
        if (gproji_dot3(t, t) > 0 && (closed || from < 0)) from = s;
    }
    if (from < 0) return false;
    gproji_copy3(curve->tangent + 3 * (size_t)from, last);
    for (s = 0; s < curve->segment_count; ++s) {
        t = curve->tangent + 3 * (size_t)s;
        if (gproji_dot3(t, t) > 0)
            gproji_copy3(t, last);
        else
            gproji_copy3(last, t);
    }
    return true;
}

GPROJ_API void gproj_curve_destroy(gproj_curve *curve) {
    if (!curve) return;
    gproji_hierarchy_give(&curve->heap, &curve->tree);
    gproji_give(&curve->heap, curve->tangent, (size_t)curve->segment_count, 3 * sizeof(double));
    gproji_give(&curve->heap, curve->point, (size_t)curve->segment_count + 1, 3 * sizeof(double));
    gproji_destroy_object(curve, sizeof *curve);
}

/* A curve with room for its points, which the caller fills in before gproji_curve_finish. NULL without memory. */
GPROJI_INTERNAL gproj_curve *gproji_curve_begin(int32_t segment_count, const gproj_host *host, gproj_error *error) {
    gproj_curve *curve = (gproj_curve *)gproji_create_object(host, sizeof(gproj_curve));
    if (curve) {
        curve->segment_count = segment_count;
        curve->point = (double *)gproji_take(&curve->heap, (size_t)segment_count + 1, 3 * sizeof(double));
        curve->tangent = (double *)gproji_take(&curve->heap, (size_t)segment_count, 3 * sizeof(double));
        if (curve->point && curve->tangent) return curve;
        gproj_curve_destroy(curve);
    }
    gproji_fail_memory(error);
    return NULL;
}

/* Checks the points and builds the rest; on failure destroys the curve and returns NULL. */
GPROJI_INTERNAL gproj_curve *gproji_curve_finish(gproj_curve *curve, bool closed, gproj_error *error) {
    gproj_code code = gproji_check_positions(curve->segment_count + 1, curve->point, "point", error);
    if (!code && !gproji_curve_tangents(curve, closed)) {
        code = gproji_fail(error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_NONE, -1,
                           "all %d points of the curve are the same; it needs two different ones",
                           curve->segment_count + (closed ? 0 : 1));
    }
    if (!code && !gproji_hierarchy_build(&curve->heap, &curve->tree, curve->segment_count, gproji_segment_box, curve)) {
        code = gproji_fail_memory(error);
    }
    if (!code) return curve;
    gproj_curve_destroy(curve);
    return NULL;
}

GPROJ_API gproj_curve *gproj_curve_create(int32_t count, const double *points, bool closed, const gproj_host *host,
                                          gproj_error *error) {
    gproj_curve *curve;
    gproji_error_clear(error);
    if (count < 2 || count > GPROJI_VERTICES_MAX || !points) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    points ? "a curve of %d points; it needs at least 2" : "the points of the curve are NULL", count);
        return NULL;
    }
    curve = gproji_curve_begin(closed ? count : count - 1, host, error);
    if (!curve) return NULL;
    memcpy(curve->point, points, (size_t)count * 3 * sizeof(double));
    if (closed) gproji_copy3(points, curve->point + 3 * (size_t)count);
    return gproji_curve_finish(curve, closed, error);
}

GPROJ_API gproj_curve *gproj_curve_from_loop(const gproj_mesh *mesh, int32_t loop, const gproj_host *host,
                                             gproj_error *error) {
    gproj_curve *curve;
    int32_t start, h, count = 0;
    gproji_error_clear(error);
    if (!mesh || loop < 0 || loop >= mesh->loop_count) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    mesh ? "boundary loop %d of a mesh that has %d of them" : "the mesh of the boundary loop is NULL",
                    loop, mesh ? mesh->loop_count : 0);
        return NULL;
    }
    start = mesh->loop_halfedge[loop];
    h = start;
    do {
        ++count;
        h = mesh->prev[h];
    } while (h != start);
    curve = gproji_curve_begin(count, host, error);
    if (!curve) return NULL;
    for (count = 0; count <= curve->segment_count; ++count, h = mesh->prev[h]) { /* against the boundary half-edges */
        gproji_copy3(mesh->position + 3 * (size_t)mesh->origin[h], curve->point + 3 * (size_t)count);
    }
    return gproji_curve_finish(curve, true, error);
}

GPROJ_API gproj_curve *gproj_curve_from_polyline(const gproj_mesh *mesh, int32_t polyline, const gproj_host *host,
                                                 gproj_error *error) {
    gproj_curve *curve;
    const int32_t *vertex;
    int32_t segments, i;
    gproji_error_clear(error);
    if (!mesh || polyline < 0 || polyline >= mesh->polyline_count) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    mesh ? "polyline %d of a mesh that has %d of them" : "the mesh of the polyline is NULL", polyline,
                    mesh ? mesh->polyline_count : 0);
        return NULL;
    }
    vertex = mesh->polyline_vertex + mesh->polyline_start[polyline];
    segments = mesh->polyline_start[polyline + 1] - mesh->polyline_start[polyline] - 1;
    curve = gproji_curve_begin(segments, host, error);
    if (!curve) return NULL;
    for (i = 0; i <= segments; ++i) {
        gproji_copy3(mesh->position + 3 * (size_t)vertex[i], curve->point + 3 * (size_t)i);
    }
    return gproji_curve_finish(curve, vertex[0] == vertex[segments], error);
}

GPROJ_API gproj_curve_hit gproj_curve_closest(const gproj_curve *curve, const double point[3]) {
    gproj_curve_hit hit;
    const double *a;
    hit.segment = gproji_hierarchy_closest(&curve->tree, point, gproji_segment_distance, curve);
    a = curve->point + 3 * (size_t)hit.segment;
    hit.parameter = gproji_closest_on_segment(a, a + 3, point, hit.point);
    gproji_copy3(curve->tangent + 3 * (size_t)hit.segment, hit.tangent);
    hit.distance = gproji_distance3(hit.point, point);
    return hit;
}

/* ============================================================================================================
   >>surface   Polygon meshes as reference surfaces. Uses platform, memory, error, vector, mesh, hierarchy, curve.

   Faces are cut into triangles: convex ones into a fan about their first corner, others by cutting ears (Meisters
   1975) in the plane orthogonal to their vectorial area. The cut depends on geometry only where a face is clearly not
   convex, so a moved or scaled mesh is cut in the same way. The normal at a point is interpolated from vertex normals,
   which are means of face normals weighted by the angles of the corners (Thuermer and Wuethrich 1998).
   Invariant: the triangles of a face stand together, in the order of the faces. */
struct gproj_surface {
    gproji_heap heap; /* first: see gproji_create_object */
    int32_t vertex_count, triangle_count;
    double *position;       /* 3 * vertex_count */
    double *normal;         /* 3 * vertex_count: unit, or 0 where no face gives one */
    int32_t *triangle;      /* 3 * triangle_count: vertices */
    int32_t *triangle_face; /* triangle_count */
    gproji_hierarchy tree;  /* over the triangles */
};

/* -- cutting faces -- */

/* Work on one face: its corners in its plane, as a ring from which ears are cut. */
typedef struct gproji_polygon {
    double *xy;       /* 2 * capacity: corners relative to the first, in the plane orthogonal to the vectorial area */
    int32_t *vertex;  /* capacity: their vertices */
    int32_t *next;    /* capacity: the ring of the corners that are left */
    int32_t *prev;    /* capacity */
    int32_t capacity; /* the largest degree of a face */
    int32_t count;
    double tolerance; /* areas below it count as zero */
} gproji_polygon;

/* Twice the area of the triangle of corners a, b, c, positive when counter-clockwise. */
GPROJI_INLINE double gproji_turn(const gproji_polygon *polygon, int32_t a, int32_t b, int32_t c) {
    const double *p = polygon->xy + 2 * (size_t)a, *q = polygon->xy + 2 * (size_t)b, *r = polygon->xy + 2 * (size_t)c;
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

GPROJI_INTERNAL void gproji_polygon_set(gproji_polygon *polygon, const gproj_mesh *mesh, int32_t face) {
    const double up[3] = {0, 0, 1};
    double n[3], u[3], v[3], d[3], extent = 0;
    const double *first;
    int32_t h = mesh->face_halfedge[face], i;
    gproj_mesh_face_area_vector(mesh, face, n);
    gproji_normalise3(n, up);
    gproji_tangents3(n, u, v);
    first = mesh->position + 3 * (size_t)mesh->origin[h];
    polygon->count = mesh->face_degree[face];
    for (i = 0; i < polygon->count; ++i, h = mesh->next[h]) {
        gproji_sub3(mesh->position + 3 * (size_t)mesh->origin[h], first, d);
        polygon->xy[2 * (size_t)i] = gproji_dot3(d, u);
        polygon->xy[2 * (size_t)i + 1] = gproji_dot3(d, v);
        polygon->vertex[i] = mesh->origin[h];
        polygon->next[i] = i + 1 < polygon->count ? i + 1 : 0;
        polygon->prev[i] = i > 0 ? i - 1 : polygon->count - 1;
        extent = gproji_fmax(extent, gproji_dot3(d, d));
    }
    polygon->tolerance = 1e-9 * extent;
}

/* Every corner turns left, and the fan about the first one has no triangle that is turned over. */
GPROJI_INTERNAL bool gproji_polygon_is_convex(const gproji_polygon *polygon) {
    int32_t i;
    for (i = 0; i < polygon->count; ++i) {
        if (gproji_turn(polygon, polygon->prev[i], i, polygon->next[i]) < -polygon->tolerance) return false;
        if (i > 0 && i + 1 < polygon->count && gproji_turn(polygon, 0, i, i + 1) < -polygon->tolerance) return false;
    }
    return true;
}

/* Is corner b an ear: it turns left and no other corner is in the triangle a b c? Only corners that turn right can be
   in it. Takes each corner looked at from the budget. */
GPROJI_INTERNAL bool gproji_is_ear(const gproji_polygon *polygon, int32_t b, int64_t *budget) {
    int32_t a = polygon->prev[b], c = polygon->next[b], i;
    if (gproji_turn(polygon, a, b, c) <= polygon->tolerance) return false;
    for (i = polygon->next[c]; i != a; i = polygon->next[i]) {
        --*budget;
        if (gproji_turn(polygon, polygon->prev[i], i, polygon->next[i]) > 0) continue;
        if (gproji_turn(polygon, a, b, i) >= 0 && gproji_turn(polygon, b, c, i) >= 0 &&
            gproji_turn(polygon, c, a, i) >= 0) {
            return false;
        }
    }
    return true;
}

/* Appends the triangle of three corners. */
GPROJI_INLINE void gproji_cut(gproj_surface *surface, const gproji_polygon *polygon, int32_t face, int32_t a, int32_t b,
                              int32_t c) {
    int32_t *triangle = surface->triangle + 3 * (size_t)surface->triangle_count;
    triangle[0] = polygon->vertex[a], triangle[1] = polygon->vertex[b], triangle[2] = polygon->vertex[c];
    surface->triangle_face[surface->triangle_count++] = face;
}

/* Cuts ears until three corners are left. A corner where no ear is left (a face that crosses itself), or where the
   budget of 512 looks a corner is used up (so that the time is linear in the mesh), is cut off all the same. */
GPROJI_INTERNAL void gproji_cut_ears(gproj_surface *surface, gproji_polygon *polygon, int32_t face) {
    int64_t budget = 512 * (int64_t)polygon->count;
    int32_t left = polygon->count, b = 1, refused = 0;
    while (left > 3) {
        int32_t a = polygon->prev[b], c = polygon->next[b];
        if (refused < left && budget > 0 && !gproji_is_ear(polygon, b, &budget)) {
            ++refused;
            b = c;
            continue;
        }
        gproji_cut(surface, polygon, face, a, b, c);
        polygon->next[a] = c, polygon->prev[c] = a;
        --left, refused = 0;
        b = c;
    }
    gproji_cut(surface, polygon, face, polygon->prev[b], b, polygon->next[b]);
}

GPROJI_INTERNAL void gproji_cut_face(gproj_surface *surface, gproji_polygon *polygon, const gproj_mesh *mesh,
                                     int32_t face) {
    int32_t i;
    gproji_polygon_set(polygon, mesh, face);
    if (polygon->count > 3 && !gproji_polygon_is_convex(polygon)) {
        gproji_cut_ears(surface, polygon, face);
        return;
    }
    for (i = 1; i + 1 < polygon->count; ++i) gproji_cut(surface, polygon, face, 0, i, i + 1);
}

GPROJI_INTERNAL bool gproji_cut_faces(gproj_surface *surface, const gproj_mesh *mesh) {
    gproji_polygon polygon;
    gproji_heap *heap = &surface->heap;
    size_t capacity;
    int32_t f;
    bool complete;
    memset(&polygon, 0, sizeof polygon);
    for (f = 0; f < mesh->face_count; ++f) polygon.capacity = gproji_max(polygon.capacity, mesh->face_degree[f]);
    capacity = (size_t)polygon.capacity;
    polygon.xy = (double *)gproji_take(heap, capacity, 2 * sizeof(double));
    polygon.vertex = (int32_t *)gproji_take(heap, capacity, sizeof(int32_t));
    polygon.next = (int32_t *)gproji_take(heap, capacity, sizeof(int32_t));
    polygon.prev = (int32_t *)gproji_take(heap, capacity, sizeof(int32_t));
    complete = polygon.xy && polygon.vertex && polygon.next && polygon.prev;
    surface->triangle_count = 0;
    for (f = 0; f < mesh->face_count && complete; ++f) gproji_cut_face(surface, &polygon, mesh, f);
    gproji_give(heap, polygon.prev, capacity, sizeof(int32_t));
    gproji_give(heap, polygon.next, capacity, sizeof(int32_t));
    gproji_give(heap, polygon.vertex, capacity, sizeof(int32_t));
    gproji_give(heap, polygon.xy, capacity, 2 * sizeof(double));
    return complete;
}

/* -- normals -- */

/* The angle between the edges from b to a and from b to c; 0 where one has no length. */
GPROJI_INTERNAL double gproji_angle3(const double a[3], const double b[3], const double c[3]) {
    double u[3], v[3], w[3];
    gproji_sub3(a, b, u);
    gproji_sub3(c, b, v);
    gproji_cross3(u, v, w);
    return atan2(gproji_length3(w), gproji_dot3(u, v));
}

GPROJI_INTERNAL void gproji_surface_normals(gproj_surface *surface, const gproj_mesh *mesh) {
    const double zero[3] = {0, 0, 0};
    const double *x = mesh->position;
    double n[3];
    int32_t f, h, v;
    memset(surface->normal, 0, (size_t)surface->vertex_count * 3 * sizeof(double));
    for (f = 0; f < mesh->face_count; ++f) {
        gproj_mesh_face_area_vector(mesh, f, n);
        if (!gproji_normalise3(n, zero)) continue;
        h = mesh->face_halfedge[f];
        do {
            v = mesh->origin[h];
            gproji_add_scaled3(gproji_angle3(x + 3 * (size_t)mesh->origin[mesh->prev[h]], x + 3 * (size_t)v,
                                             x + 3 * (size_t)mesh->origin[mesh->next[h]]),
                               n, surface->normal + 3 * (size_t)v);
            h = mesh->next[h];
        } while (h != mesh->face_halfedge[f]);
    }
    for (v = 0; v < surface->vertex_count; ++v) gproji_normalise3(surface->normal + 3 * (size_t)v, zero);
}

/* -- closest points -- */

/* Barycentric coordinates of the orthogonal projection of p to the plane of a triangle: true where it falls inside.
   *sure: the triangle is no needle and p not far away, so that the signs of coordinates beyond 1e-9 can be trusted.
   False, and not sure, for triangles without area. */
GPROJI_INTERNAL bool gproji_project_to_triangle(const double *const corner[3], const double p[3], double weight[3],
                                                bool *sure) {
    double ab[3], ac[3], ap[3], n[3], w[3], square, scale;
    gproji_sub3(corner[1], corner[0], ab);
    gproji_sub3(corner[2], corner[0], ac);
    gproji_sub3(p, corner[0], ap);
    gproji_cross3(ab, ac, n);
    square = gproji_dot3(n, n);
    scale = gproji_fmax(gproji_dot3(ab, ab), gproji_dot3(ac, ac));
    *sure = square > 1e-8 * scale * scale && gproji_dot3(ap, ap) < 1e4 * scale;
    if (!(square > 1e-28 * scale * scale)) return false;
    gproji_cross3(ap, ac, w);
    weight[1] = gproji_dot3(w, n) / square;
    gproji_cross3(ab, ap, w);
    weight[2] = gproji_dot3(w, n) / square;
    weight[0] = 1 - weight[1] - weight[2];
    return weight[0] > 0 && weight[1] > 0 && weight[2] > 0;
}

/* corner[0] + w1 (corner[1] - corner[0]) + w2 (corner[2] - corner[0]) */
GPROJI_INLINE void gproji_triangle_point(const double *const corner[3], const double weight[3], double out[3]) {
    int32_t k;
    for (k = 0; k < 3; ++k) {
        out[k] = corner[0][k] + weight[1] * (corner[1][k] - corner[0][k]) + weight[2] * (corner[2][k] - corner[0][k]);
    }
}

/* The point of a triangle nearest to p: the projection to its plane if that is inside; else on an edge that separates
   the projection from the triangle. Of needles, and of triangles that are points, all candidates are compared. Returns
   the squared distance. */
GPROJI_INTERNAL double gproji_closest_on_triangle(const double *const corner[3], const double p[3], double out[3],
                                                  double weight[3]) {
    double best = DBL_MAX, q[3], w[3] = {0, 0, 0}, d, t;
    int32_t k;
    bool sure, inside = gproji_project_to_triangle(corner, p, w, &sure);
    if (inside)
        gproji_copy3(w, weight);
    else
        gproji_set3(1, 0, 0, weight);
    gproji_triangle_point(corner, weight, out);
    if (inside) best = gproji_square_distance3(out, p);
    if (inside && sure) return best;
    for (k = 0; k < 3; ++k) {
        int32_t following = k < 2 ? k + 1 : 0, opposite = k > 0 ? k - 1 : 2;
        if (sure && w[opposite] > 1e-9) continue;
        t = gproji_closest_on_segment(corner[k], corner[following], p, q);
        d = gproji_square_distance3(q, p);
        if (!(d < best)) continue;
        best = d;
        gproji_copy3(q, out);
        gproji_set3(0, 0, 0, weight);
        weight[k] = 1 - t;
        weight[following] = t;
    }
    return best;
}

GPROJI_INLINE void gproji_triangle_corners(const gproj_surface *surface, int32_t item, const double *corner[3]) {
    int32_t k;
    for (k = 0; k < 3; ++k) {
        corner[k] = surface->position + 3 * (size_t)surface->triangle[3 * (size_t)item + (size_t)k];
    }
}

GPROJI_INTERNAL void gproji_triangle_box(const void *user, int32_t item, double low[3], double high[3]) {
    const double *corner[3];
    int32_t k;
    gproji_triangle_corners((const gproj_surface *)user, item, corner);
    for (k = 0; k < 3; ++k) {
        low[k] = gproji_fmin(gproji_fmin(corner[0][k], corner[1][k]), corner[2][k]);
        high[k] = gproji_fmax(gproji_fmax(corner[0][k], corner[1][k]), corner[2][k]);
    }
}

GPROJI_INTERNAL double gproji_triangle_distance(const void *user, int32_t item, const double point[3]) {
    const double *corner[3];
    double out[3], weight[3];
    gproji_triangle_corners((const gproj_surface *)user, item, corner);
    return gproji_closest_on_triangle(corner, point, out, weight);
}

/* The unit normal at a point of a triangle: interpolated; that of the triangle where the vertex normals cancel; up
   where the triangle has none either. */
GPROJI_INTERNAL void gproji_surface_normal(const gproj_surface *surface, int32_t item, const double weight[3],
                                           double normal[3]) {
    const double up[3] = {0, 0, 1};
    const double *corner[3];
    double ab[3], ac[3];
    int32_t k;
    gproji_set3(0, 0, 0, normal);
    for (k = 0; k < 3; ++k) {
        const double *n = surface->normal + 3 * (size_t)surface->triangle[3 * (size_t)item + (size_t)k];
        gproji_add_scaled3(weight[k], n, normal);
    }
    if (gproji_dot3(normal, normal) > 1e-12) {
        gproji_normalise3(normal, up);
        return;
    }
    gproji_triangle_corners(surface, item, corner);
    gproji_sub3(corner[1], corner[0], ab);
    gproji_sub3(corner[2], corner[0], ac);
    gproji_cross3(ab, ac, normal);
    gproji_normalise3(normal, up);
}

/* -- the object -- */

/* The triangles of all faces: a face of degree d has d - 2. */
GPROJI_INTERNAL int32_t gproji_count_triangles(const gproj_mesh *mesh) {
    int32_t f, count = 0;
    for (f = 0; f < mesh->face_count; ++f) count += mesh->face_degree[f] - 2;
    return count;
}

GPROJ_API void gproj_surface_destroy(gproj_surface *surface) {
    size_t vertices, triangles;
    if (!surface) return;
    vertices = (size_t)surface->vertex_count, triangles = (size_t)surface->triangle_count;
    gproji_hierarchy_give(&surface->heap, &surface->tree);
    gproji_give(&surface->heap, surface->triangle_face, triangles, sizeof(int32_t));
    gproji_give(&surface->heap, surface->triangle, triangles, 3 * sizeof(int32_t));
    gproji_give(&surface->heap, surface->normal, vertices, 3 * sizeof(double));
    gproji_give(&surface->heap, surface->position, vertices, 3 * sizeof(double));
    gproji_destroy_object(surface, sizeof *surface);
}

/* Everything but the checks; false when there is no memory. */
GPROJI_INTERNAL bool gproji_surface_fill(gproj_surface *surface, const gproj_mesh *mesh) {
    size_t vertices = (size_t)mesh->vertex_count, triangles = (size_t)gproji_count_triangles(mesh);
    int32_t triangle_count = (int32_t)triangles;
    surface->vertex_count = mesh->vertex_count;
    surface->triangle_count = triangle_count;
    surface->position = (double *)gproji_take(&surface->heap, vertices, 3 * sizeof(double));
    surface->normal = (double *)gproji_take(&surface->heap, vertices, 3 * sizeof(double));
    surface->triangle = (int32_t *)gproji_take(&surface->heap, triangles, 3 * sizeof(int32_t));
    surface->triangle_face = (int32_t *)gproji_take(&surface->heap, triangles, sizeof(int32_t));
    if (!surface->position || !surface->normal || !surface->triangle || !surface->triangle_face) return false;
    memcpy(surface->position, mesh->position, vertices * 3 * sizeof(double));
    gproji_surface_normals(surface, mesh);
    if (!gproji_cut_faces(surface, mesh)) {
        surface->triangle_count = triangle_count; /* the size with which the arrays are given back */
        return false;
    }
    return gproji_hierarchy_build(&surface->heap, &surface->tree, triangle_count, gproji_triangle_box, surface);
}

GPROJ_API gproj_surface *gproj_surface_create(const gproj_mesh *mesh, const gproj_host *host, gproj_error *error) {
    gproj_surface *surface;
    gproji_error_clear(error);
    if (!mesh || !mesh->face_count) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    mesh ? "the mesh of the surface has no faces" : "the mesh of the surface is NULL");
        return NULL;
    }
    if (gproji_check_positions(mesh->vertex_count, mesh->position, "vertex", error)) return NULL;
    surface = (gproj_surface *)gproji_create_object(host, sizeof(gproj_surface));
    if (!surface || !gproji_surface_fill(surface, mesh)) {
        gproji_fail_memory(error);
        gproj_surface_destroy(surface);
        return NULL;
    }
    return surface;
}

GPROJ_API gproj_surface_hit gproj_surface_closest(const gproj_surface *surface, const double point[3]) {
    gproj_surface_hit hit;
    const double *corner[3];
    double weight[3];
    int32_t item = gproji_hierarchy_closest(&surface->tree, point, gproji_triangle_distance, surface);
    gproji_triangle_corners(surface, item, corner);
    gproji_closest_on_triangle(corner, point, hit.point, weight);
    gproji_surface_normal(surface, item, weight, hit.normal);
    hit.distance = gproji_distance3(hit.point, point);
    hit.face = surface->triangle_face[item];
    return hit;
}

/* ============================================================================================================
   >>edit   Changes of the combinatorics of a mesh. Uses platform, memory, error, vector, mesh,
   surface (polygons).

   Three operators do all the work: an edge is split, a face is cut, an edge is collapsed; Mantyla (1988) calls them
   Euler operators. Each has a part that checks, a part that makes room, and a part that cannot fail. Strips and
   triangulations are sequences of them; those that may be refused midway work with a copy to go back to.
   Invariants: those of >>mesh for the elements that are left, but for the order of edges. vertex_into and edge_into
   lead to lower numbers. A removed edge has origin -1 at both half-edges, a removed face the half-edge -1. */
typedef enum gproji_edit_kind {
    GPROJI_EDIT_VERTEX,
    GPROJI_EDIT_HALFEDGE,
    GPROJI_EDIT_EDGE,
    GPROJI_EDIT_FACE,
    GPROJI_EDIT_KINDS
} gproji_edit_kind;

/* How many integers an element has: each is an array below. */
static const int32_t gproji_edit_rows[GPROJI_EDIT_KINDS] = {4, 4, 1, 4};

/* The state of an edit: what a copy to go back to must have. */
typedef struct gproji_edit_store {
    int32_t count[GPROJI_EDIT_KINDS];
    int32_t room[GPROJI_EDIT_KINDS];
    int32_t *block[GPROJI_EDIT_KINDS]; /* rows * room integers: the arrays below, one after the other */
    double *position;                  /* 3 * room of vertices */
    int32_t polyline_count;
    int32_t polyline_room;
    int32_t *polyline_start;  /* polyline_count + 1 */
    int32_t *polyline_vertex; /* polyline_room: merged vertices already stand for what they were merged into */

    int32_t *vertex_halfedge;
    int32_t *vertex_into; /* itself, or what it was merged into */
    int32_t *vertex_mark; /* the last stamp that met it */
    int32_t *on_polyline; /* is it a vertex of a polyline? */
    int32_t *next, *prev, *origin, *face;
    int32_t *edge_into; /* itself, what it was merged into, or -1: collapsed */
    int32_t *face_halfedge, *face_degree, *face_parent;
    int32_t *face_mark;
} gproji_edit_store;

/* The owner of a gproj_edit. */
typedef struct gproji_edit_object {
    gproji_heap heap; /* first: see gproji_create_object */
    gproj_edit edit;
    gproj_mesh view; /* the same arrays for the functions of >>mesh that go round a vertex or a face */
    gproji_edit_store now;
    int32_t *number[GPROJI_EDIT_KINDS]; /* of vertices, edges, faces in the last mesh made; NULL for half-edges */
    int32_t number_count[GPROJI_EDIT_KINDS];
    int32_t stamp;
} gproji_edit_object;

/* -- memory -- */

/* The arrays within the blocks. */
GPROJI_INTERNAL void gproji_edit_point(gproji_edit_store *s) {
    size_t vertices = (size_t)s->room[GPROJI_EDIT_VERTEX], halfedges = (size_t)s->room[GPROJI_EDIT_HALFEDGE],
           faces = (size_t)s->room[GPROJI_EDIT_FACE];
    s->vertex_halfedge = s->block[GPROJI_EDIT_VERTEX];
    s->vertex_into = s->vertex_halfedge + vertices;
    s->vertex_mark = s->vertex_into + vertices;
    s->on_polyline = s->vertex_mark + vertices;
    s->next = s->block[GPROJI_EDIT_HALFEDGE];
    s->prev = s->next + halfedges;
    s->origin = s->prev + halfedges;
    s->face = s->origin + halfedges;
    s->edge_into = s->block[GPROJI_EDIT_EDGE];
    s->face_halfedge = s->block[GPROJI_EDIT_FACE];
    s->face_degree = s->face_halfedge + faces;
    s->face_parent = s->face_degree + faces;
    s->face_mark = s->face_parent + faces;
}

/* Shows the arrays in the public struct and in the view. */
GPROJI_INTERNAL void gproji_edit_publish(gproji_edit_object *object) {
    gproji_edit_store *s = &object->now;
    gproj_edit *edit = &object->edit;
    gproj_mesh *view = &object->view;
    gproji_edit_point(s);
    edit->vertex_count = view->vertex_count = s->count[GPROJI_EDIT_VERTEX];
    edit->edge_count = view->edge_count = s->count[GPROJI_EDIT_EDGE];
    edit->face_count = view->face_count = s->count[GPROJI_EDIT_FACE];
    edit->position = view->position = s->position;
    edit->vertex_halfedge = view->vertex_halfedge = s->vertex_halfedge;
    edit->face_halfedge = view->face_halfedge = s->face_halfedge;
    edit->face_degree = view->face_degree = s->face_degree;
    edit->face_parent = s->face_parent;
    edit->next = view->next = s->next;
    edit->prev = view->prev = s->prev;
    edit->origin = view->origin = s->origin;
    edit->face = view->face = s->face;
    edit->vertex_number = object->number[GPROJI_EDIT_VERTEX];
    edit->edge_number = object->number[GPROJI_EDIT_EDGE];
    edit->face_number = object->number[GPROJI_EDIT_FACE];
}

GPROJI_INTERNAL void gproji_edit_give(gproji_heap *heap, gproji_edit_store *s) {
    int32_t kind;
    for (kind = 0; kind < GPROJI_EDIT_KINDS; ++kind)
        gproji_give(heap, s->block[kind], (size_t)s->room[kind], (size_t)gproji_edit_rows[kind] * sizeof(int32_t));
    gproji_give(heap, s->position, (size_t)s->room[GPROJI_EDIT_VERTEX], 3 * sizeof(double));
    gproji_give(heap, s->polyline_start, (size_t)s->polyline_count + 1, sizeof(int32_t));
    gproji_give(heap, s->polyline_vertex, (size_t)s->polyline_room, sizeof(int32_t));
}

/* Takes the arrays for the counts and rooms of a store; after a failure what there is can be given back. */
GPROJI_INTERNAL bool gproji_edit_take(gproji_heap *heap, gproji_edit_store *s) {
    bool complete = true;
    int32_t kind;
    for (kind = 0; kind < GPROJI_EDIT_KINDS; ++kind) {
        size_t size = (size_t)gproji_edit_rows[kind] * sizeof(int32_t);
        s->block[kind] = (int32_t *)gproji_take_zeroed(heap, (size_t)s->room[kind], size);
        complete = complete && s->block[kind];
    }
    s->position = (double *)gproji_take(heap, (size_t)s->room[GPROJI_EDIT_VERTEX], 3 * sizeof(double));
    s->polyline_start = (int32_t *)gproji_take(heap, (size_t)s->polyline_count + 1, sizeof(int32_t));
    s->polyline_vertex = (int32_t *)gproji_take(heap, (size_t)s->polyline_room, sizeof(int32_t));
    if (!complete || !s->position || !s->polyline_start || !s->polyline_vertex) return false;
    gproji_edit_point(s);
    return true;
}

/* A copy to go back to; false when there is no memory. */
GPROJI_INTERNAL bool gproji_edit_save(gproji_edit_object *object, gproji_edit_store *copy) {
    const gproji_edit_store *s = &object->now;
    int32_t kind;
    *copy = *s;
    if (!gproji_edit_take(&object->heap, copy)) {
        gproji_edit_give(&object->heap, copy);
        return false;
    }
    for (kind = 0; kind < GPROJI_EDIT_KINDS; ++kind)
        memcpy(copy->block[kind], s->block[kind],
               (size_t)gproji_edit_rows[kind] * (size_t)s->room[kind] * sizeof(int32_t));
    memcpy(copy->position, s->position, (size_t)s->count[GPROJI_EDIT_VERTEX] * 3 * sizeof(double));
    memcpy(copy->polyline_start, s->polyline_start, ((size_t)s->polyline_count + 1) * sizeof(int32_t));
    memcpy(copy->polyline_vertex, s->polyline_vertex, (size_t)s->polyline_room * sizeof(int32_t));
    return true;
}

/* The end of what began with gproji_edit_save: back to the copy after an error. Returns the error. */
GPROJI_INTERNAL gproj_code gproji_edit_settle(gproji_edit_object *object, gproji_edit_store *copy, gproj_code code) {
    gproji_edit_give(&object->heap, code ? &object->now : copy);
    if (code) object->now = *copy;
    gproji_edit_publish(object);
    return code;
}

/* Makes room for `more` elements of a kind, at least doubling it. */
GPROJI_INTERNAL bool gproji_edit_grow(gproji_edit_object *object, int32_t kind, int32_t more) {
    gproji_edit_store *s = &object->now;
    int32_t rows = gproji_edit_rows[kind], old_room = s->room[kind], room, r, *block;
    int32_t needed = s->count[kind] + more;
    double *position = NULL;
    if (needed <= old_room) return true;
    room = needed < INT32_MAX / 2 ? gproji_max(needed, 2 * old_room) : needed;
    block = (int32_t *)gproji_take_zeroed(&object->heap, (size_t)room, (size_t)rows * sizeof(int32_t));
    if (!block) return false;
    if (kind == GPROJI_EDIT_VERTEX) {
        position =
            (double *)gproji_retake(&object->heap, s->position, (size_t)old_room, (size_t)room, 3 * sizeof(double));
        if (!position) {
            gproji_give(&object->heap, block, (size_t)room, (size_t)rows * sizeof(int32_t));
            return false;
        }
        s->position = position;
    }
    for (r = 0; r < rows; ++r)
        memcpy(block + (size_t)r * (size_t)room, s->block[kind] + (size_t)r * (size_t)old_room,
               (size_t)s->count[kind] * sizeof(int32_t));
    gproji_give(&object->heap, s->block[kind], (size_t)old_room, (size_t)rows * sizeof(int32_t));
    s->block[kind] = block;
    s->room[kind] = room;
    gproji_edit_publish(object);
    return true;
}

/* Makes room for new elements, so that those who add them cannot fail. */
GPROJI_INTERNAL gproj_code gproji_edit_reserve(gproji_edit_object *object, int64_t vertices, int64_t edges,
                                               int64_t faces, gproj_error *error) {
    const int32_t *count = object->now.count;
    if (count[GPROJI_EDIT_VERTEX] + vertices > GPROJI_VERTICES_MAX ||
        count[GPROJI_EDIT_EDGE] + edges > GPROJI_CORNERS_MAX / 2) {
        return gproji_fail(error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1,
                           "the edit would have more than %d vertices or %d edges; go on with gproj_edit_mesh",
                           (int32_t)GPROJI_VERTICES_MAX, (int32_t)GPROJI_CORNERS_MAX / 2);
    }
    if (!gproji_edit_grow(object, GPROJI_EDIT_VERTEX, (int32_t)vertices) ||
        !gproji_edit_grow(object, GPROJI_EDIT_HALFEDGE, (int32_t)(2 * edges)) ||
        !gproji_edit_grow(object, GPROJI_EDIT_EDGE, (int32_t)edges) ||
        !gproji_edit_grow(object, GPROJI_EDIT_FACE, (int32_t)faces)) {
        return gproji_fail_memory(error);
    }
    return GPROJ_OK;
}

/* -- elements -- */

GPROJI_INTERNAL int32_t gproji_edit_add_vertex(gproji_edit_store *s) {
    int32_t v = s->count[GPROJI_EDIT_VERTEX]++;
    s->vertex_into[v] = v;
    return v;
}

/* Its half-edges are 2e and 2e + 1. */
GPROJI_INTERNAL int32_t gproji_edit_add_edge(gproji_edit_store *s) {
    int32_t e = s->count[GPROJI_EDIT_EDGE]++;
    s->count[GPROJI_EDIT_HALFEDGE] += 2;
    s->edge_into[e] = e;
    return e;
}

/* A part of face `whole`. */
GPROJI_INTERNAL int32_t gproji_edit_add_face(gproji_edit_store *s, int32_t whole) {
    int32_t f = s->count[GPROJI_EDIT_FACE]++;
    s->face_parent[f] = s->face_parent[whole];
    return f;
}

/* What a number stands for, by the chain of merges, which is shortened on the way; -1: nothing. */
GPROJI_INTERNAL int32_t gproji_edit_root(int32_t *into, int32_t number) {
    while (number >= 0 && into[number] != number) {
        if (into[number] >= 0) into[number] = into[into[number]];
        number = into[number];
    }
    return number;
}

GPROJI_INLINE void gproji_edit_link(gproji_edit_store *s, int32_t h, int32_t following) {
    s->next[h] = following;
    s->prev[following] = h;
}

/* Chooses vertex_halfedge, given an outgoing half-edge. */
GPROJI_INTERNAL void gproji_edit_anchor(gproji_edit_object *object, int32_t outgoing) {
    gproji_edit_store *s = &object->now;
    int32_t h = outgoing;
    while (s->face[h] >= 0) {
        h = gproji_rotate(&object->view, h);
        if (h == outgoing) break;
    }
    s->vertex_halfedge[s->origin[h]] = h;
}

/* The half-edge of a face that starts at a vertex; -1: it is no corner. */
GPROJI_INTERNAL int32_t gproji_edit_corner(const gproji_edit_store *s, int32_t face, int32_t vertex) {
    int32_t start = s->face_halfedge[face], h = start;
    do {
        if (s->origin[h] == vertex) return h;
        h = s->next[h];
    } while (h != start);
    return -1;
}

/* The half-edge from vertex a to vertex b; -1: none. */
GPROJI_INTERNAL int32_t gproji_edit_joined(const gproji_edit_object *object, int32_t a, int32_t b) {
    const gproj_mesh *view = &object->view;
    int32_t start = view->vertex_halfedge[a], h = start;
    if (start < 0) return -1;
    do {
        if (view->origin[h ^ 1] == b) return h;
        h = gproji_rotate(view, h);
    } while (h != start);
    return -1;
}

/* A new stamp for marks, greater than all that are in use. */
GPROJI_INTERNAL int32_t gproji_edit_stamp(gproji_edit_object *object) {
    gproji_edit_store *s = &object->now;
    if (object->stamp == INT32_MAX) {
        gproji_fill(s->vertex_mark, s->count[GPROJI_EDIT_VERTEX], 0);
        gproji_fill(s->face_mark, s->count[GPROJI_EDIT_FACE], 0);
        object->stamp = 0;
    }
    return ++object->stamp;
}

/* out = (1 - t) v_a + t v_b, bit for bit one of them at t = 0 and 1. `out` may be one of them. */
GPROJI_INTERNAL void gproji_edit_between(const gproji_edit_store *s, int32_t a, int32_t b, double t, int32_t out) {
    const double *p = s->position + 3 * (size_t)a, *q = s->position + 3 * (size_t)b;
    double *x = s->position + 3 * (size_t)out;
    int32_t k;
    if (t <= 0 || t >= 1) {
        gproji_copy3(t <= 0 ? p : q, x);
        return;
    }
    for (k = 0; k < 3; ++k) x[k] = p[k] + t * (q[k] - p[k]);
}

/* -- what calls give -- */

GPROJI_INTERNAL gproji_edit_object *gproji_edit_owner(gproj_edit *edit, gproj_error *error) {
    gproji_error_clear(error);
    if (!edit) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the edit is NULL");
        return NULL;
    }
    return (gproji_edit_object *)(void *)((char *)edit - offsetof(gproji_edit_object, edit));
}

/* Is a number in the range of its kind? */
GPROJI_INTERNAL bool gproji_edit_has(const gproji_edit_object *object, gproji_edit_kind kind, const char *what,
                                     gproj_place place, int32_t number, gproj_error *error) {
    int32_t count = object->now.count[kind];
    if (number >= 0 && number < count) return true;
    gproji_fail(error, GPROJ_ERROR_INDEX, place, number, "%s %d does not exist: they are 0 to %d", what, number,
                count - 1);
    return false;
}

/* Half-edge 2e of the edge e that a number stands for; -1 and an error where there is none. */
GPROJI_INTERNAL int32_t gproji_edit_given_edge(gproji_edit_object *object, int32_t edge, double t, gproj_error *error) {
    int32_t root;
    if (!gproji_edit_has(object, GPROJI_EDIT_EDGE, "edge", GPROJ_PLACE_EDGE, edge, error)) return -1;
    root = gproji_edit_root(object->now.edge_into, edge);
    if (root < 0) {
        gproji_fail(error, GPROJ_ERROR_INDEX, GPROJ_PLACE_EDGE, edge, "edge %d is no more: it was collapsed", edge);
        return -1;
    }
    if (!(t >= 0 && t <= 1)) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_EDGE, edge,
                    "the parameter %g on edge %d is not from 0 to 1", t, edge);
        return -1;
    }
    return 2 * root;
}

GPROJI_INTERNAL bool gproji_edit_given_face(const gproji_edit_object *object, int32_t face, gproj_error *error) {
    if (!gproji_edit_has(object, GPROJI_EDIT_FACE, "face", GPROJ_PLACE_FACE, face, error)) return false;
    if (object->now.face_halfedge[face] >= 0) return true;
    gproji_fail(error, GPROJ_ERROR_INDEX, GPROJ_PLACE_FACE, face, "face %d is no more: it has vanished", face);
    return false;
}

/* The half-edge of a face at the corner that a vertex number stands for; -1 and an error where there is none. */
GPROJI_INTERNAL int32_t gproji_edit_given_corner(gproji_edit_object *object, int32_t face, int32_t vertex,
                                                 gproj_error *error) {
    int32_t h;
    if (!gproji_edit_has(object, GPROJI_EDIT_VERTEX, "vertex", GPROJ_PLACE_VERTEX, vertex, error)) return -1;
    h = gproji_edit_corner(&object->now, face, gproji_edit_root(object->now.vertex_into, vertex));
    if (h < 0)
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_FACE, face, "face %d has no corner at vertex %d", face,
                    vertex);
    return h;
}

/* -- polylines -- */

/* Do vertices at `i` and `i + 1` of the polylines run along the edge between a and b? */
GPROJI_INLINE bool gproji_polyline_runs(const gproji_edit_store *s, int32_t i, int32_t a, int32_t b) {
    int32_t u = s->polyline_vertex[i], v = s->polyline_vertex[i + 1];
    return (u == a && v == b) || (u == b && v == a);
}

/* How often polylines run along a half-edge's edge. */
GPROJI_INTERNAL int32_t gproji_polyline_count_runs(const gproji_edit_store *s, int32_t h) {
    int32_t a = s->origin[h], b = s->origin[h ^ 1], p, i, count = 0;
    if (!s->on_polyline[a] || !s->on_polyline[b]) return 0;
    for (p = 0; p < s->polyline_count; ++p)
        for (i = s->polyline_start[p]; i + 1 < s->polyline_start[p + 1]; ++i) count += gproji_polyline_runs(s, i, a, b);
    return count;
}

/* Makes room for `more` vertices of polylines. */
GPROJI_INTERNAL gproj_code gproji_polyline_reserve(gproji_edit_object *object, int64_t more, gproj_error *error) {
    gproji_edit_store *s = &object->now;
    int64_t needed = s->polyline_start[s->polyline_count] + more;
    int32_t *moved, room;
    if (needed <= s->polyline_room) return GPROJ_OK;
    if (needed > INT32_MAX / 2) {
        return gproji_fail(error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1,
                           "the polylines would have more than %d vertices", (int32_t)INT32_MAX / 2);
    }
    room = 2 * (int32_t)needed;
    moved = (int32_t *)gproji_retake(&object->heap, s->polyline_vertex, (size_t)s->polyline_room, (size_t)room,
                                     sizeof(int32_t));
    if (!moved) return gproji_fail_memory(error);
    s->polyline_vertex = moved;
    s->polyline_room = room;
    return GPROJ_OK;
}

/* Puts vertex x, new between a and b, into polylines that run along their edge. There is room. */
GPROJI_INTERNAL void gproji_polyline_split(gproji_edit_store *s, int32_t a, int32_t b, int32_t x) {
    int32_t p, q, i;
    if (!s->on_polyline[a] || !s->on_polyline[b]) return;
    for (p = 0; p < s->polyline_count; ++p) {
        for (i = s->polyline_start[p]; i + 1 < s->polyline_start[p + 1]; ++i) {
            int32_t *place = s->polyline_vertex + i + 1;
            if (!gproji_polyline_runs(s, i, a, b)) continue;
            memmove(place + 1, place, (size_t)(s->polyline_start[s->polyline_count] - i - 1) * sizeof(int32_t));
            *place = x;
            s->on_polyline[x] = 1;
            for (q = p + 1; q <= s->polyline_count; ++q) s->polyline_start[q]++;
            ++i;
        }
    }
}

GPROJI_INTERNAL void gproji_polyline_merge(gproji_edit_store *s, int32_t gone, int32_t kept) {
    int32_t i;
    if (!s->on_polyline[gone]) return;
    s->on_polyline[kept] = 1;
    for (i = 0; i < s->polyline_start[s->polyline_count]; ++i)
        if (s->polyline_vertex[i] == gone) s->polyline_vertex[i] = kept;
}

/* -- the three operators; there is room -- */

/* Splits the edge of half-edge h at parameter t from its origin. h ends at the new vertex; the half-edge from there on,
   of the new edge, is returned. */
GPROJI_INTERNAL int32_t gproji_edit_split(gproji_edit_object *object, int32_t h, double t) {
    gproji_edit_store *s = &object->now;
    int32_t g = h ^ 1, a = s->origin[h], b = s->origin[g], x = gproji_edit_add_vertex(s);
    int32_t onward = 2 * gproji_edit_add_edge(s) + (h & 1), back = onward ^ 1;
    gproji_edit_between(s, a, b, t, x);
    s->origin[onward] = s->origin[g] = x;
    s->origin[back] = b;
    s->face[onward] = s->face[h];
    s->face[back] = s->face[g];
    gproji_edit_link(s, onward, s->next[h]);
    gproji_edit_link(s, h, onward);
    gproji_edit_link(s, s->prev[g], back);
    gproji_edit_link(s, back, g);
    if (s->face[h] >= 0) s->face_degree[s->face[h]]++;
    if (s->face[g] >= 0) s->face_degree[s->face[g]]++;
    if (s->face[g] >= 0 && s->face_halfedge[s->face[g]] == g) s->face_halfedge[s->face[g]] = back;
    if (s->vertex_halfedge[b] == g) s->vertex_halfedge[b] = back;
    s->vertex_halfedge[x] = s->face[g] < 0 ? g : onward;
    gproji_polyline_split(s, a, b, x);
    gproji_edit_publish(object);
    return onward;
}

/* Cuts a face between the origins of two of its half-edges. Returns the half-edge from the first to the second origin:
   it is in the part with `to`, its twin in the part with `from`. */
GPROJI_INTERNAL int32_t gproji_edit_cut(gproji_edit_object *object, int32_t from, int32_t to) {
    gproji_edit_store *s = &object->now;
    int32_t whole = s->face[from], d = 2 * gproji_edit_add_edge(s), o = d + 1, part = gproji_edit_add_face(s, whole);
    int32_t before_from = s->prev[from], before_to = s->prev[to], h, start, count = 0;
    bool first = false; /* is the first corner of the whole in the part with `from`? */
    s->origin[d] = s->origin[from];
    s->origin[o] = s->origin[to];
    gproji_edit_link(s, before_from, d);
    gproji_edit_link(s, d, to);
    gproji_edit_link(s, before_to, o);
    gproji_edit_link(s, o, from);
    for (h = from; h != o; h = s->next[h]) first = first || h == s->face_halfedge[whole];
    s->face[d] = s->face[o] = whole;
    start = h = first ? d : o;
    do {
        s->face[h] = part;
        ++count;
        h = s->next[h];
    } while (h != start);
    s->face_halfedge[part] = start;
    s->face_degree[part] = count;
    s->face_degree[whole] += 2 - count;
    gproji_edit_publish(object);
    return d;
}

/* Half-edge h takes the place of half-edge `other`, which has the same ends, and their edges become one, that of h. */
GPROJI_INTERNAL void gproji_edit_replace(gproji_edit_store *s, int32_t h, int32_t other) {
    int32_t f = s->face[other];
    gproji_edit_link(s, s->prev[other], h);
    gproji_edit_link(s, h, s->next[other]);
    s->face[h] = f;
    if (f >= 0 && s->face_halfedge[f] == other) s->face_halfedge[f] = h;
    s->origin[other] = s->origin[other ^ 1] = -1;
    s->edge_into[other / 2] = h / 2;
}

/* Takes half-edge h, whose edge has been collapsed, out of its face or boundary loop. Of a triangle two half-edges are
   left, whose edges become one. Returns an outgoing half-edge of the vertex, and at *apex one of the third vertex of
   the triangle, or -1. */
GPROJI_INTERNAL int32_t gproji_edit_unlink(gproji_edit_store *s, int32_t h, int32_t *apex) {
    int32_t f = s->face[h], x = s->next[h], y = s->prev[h];
    *apex = -1;
    gproji_edit_link(s, y, x);
    if (f < 0) return x;
    if (s->face_halfedge[f] == h) s->face_halfedge[f] = x;
    if (--s->face_degree[f] > 2) return x;
    s->face_halfedge[f] = -1;
    if (x < y) {
        gproji_edit_replace(s, x, y ^ 1);
        *apex = x ^ 1;
        return x;
    }
    gproji_edit_replace(s, y, x ^ 1);
    *apex = y;
    return y ^ 1;
}

/* Collapses the edge of half-edge h to parameter t from its origin, after gproji_check_collapse. Returns the vertex. */
GPROJI_INTERNAL int32_t gproji_edit_collapse(gproji_edit_object *object, int32_t h, double t) {
    gproji_edit_store *s = &object->now;
    int32_t a = s->origin[h], b = s->origin[h ^ 1], kept = gproji_min(a, b), gone = gproji_max(a, b);
    int32_t start = gone == a ? h : h ^ 1, i = start, outgoing, apex[2];
    gproji_edit_between(s, a, b, t, kept);
    do {
        s->origin[i] = kept;
        i = gproji_rotate(&object->view, i);
    } while (i != start);
    gproji_edit_unlink(s, h, &apex[0]);
    outgoing = gproji_edit_unlink(s, h ^ 1, &apex[1]);
    s->origin[h] = s->origin[h ^ 1] = -1;
    s->edge_into[h / 2] = -1;
    s->vertex_into[gone] = kept;
    s->vertex_halfedge[gone] = -1;
    gproji_edit_anchor(object, outgoing);
    for (i = 0; i < 2; ++i)
        if (apex[i] >= 0) gproji_edit_anchor(object, apex[i]);
    gproji_polyline_merge(s, gone, kept);
    return kept;
}

/* -- may an edge be collapsed? -- */

GPROJI_INTERNAL bool gproji_is_triangle(const gproji_edit_store *s, int32_t h) {
    return s->face[h] >= 0 && s->face_degree[s->face[h]] == 3;
}

/* A triangle at half-edge h would become an edge without a face. */
GPROJI_INTERNAL gproj_code gproji_check_vanishing(const gproji_edit_store *s, int32_t h, gproj_error *error) {
    int32_t x, y;
    if (!gproji_is_triangle(s, h)) return GPROJ_OK;
    x = s->face[s->next[h] ^ 1], y = s->face[s->prev[h] ^ 1];
    if (x != y || (x >= 0 && x != s->face[h ^ 1])) return GPROJ_OK;
    return gproji_fail(error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_EDGE, h / 2,
                       "edge %d cannot be collapsed: face %d would vanish, and no other would be left at its edges",
                       h / 2, s->face[h]);
}

/* Marks the neighbours of the origin of h, and its faces. */
GPROJI_INTERNAL int32_t gproji_edit_mark_star(gproji_edit_object *object, int32_t h) {
    gproji_edit_store *s = &object->now;
    int32_t stamp = gproji_edit_stamp(object), i = h;
    do {
        s->vertex_mark[s->origin[i ^ 1]] = stamp;
        if (s->face[i] >= 0) s->face_mark[s->face[i]] = stamp;
        i = gproji_rotate(&object->view, i);
    } while (i != h);
    return stamp;
}

/* The ends of h have no neighbour in common but the third vertices of triangles at h, and no face but those at h. */
GPROJI_INTERNAL gproj_code gproji_check_link(gproji_edit_object *object, int32_t h, gproj_error *error) {
    const gproji_edit_store *s = &object->now;
    int32_t g = h ^ 1, stamp = gproji_edit_mark_star(object, h), i;
    int32_t left = gproji_is_triangle(s, h) ? s->origin[s->prev[h]] : -1;
    int32_t right = gproji_is_triangle(s, g) ? s->origin[s->prev[g]] : -1;
    for (i = gproji_rotate(&object->view, g); i != g; i = gproji_rotate(&object->view, i)) {
        int32_t v = s->origin[i ^ 1], f = s->face[i];
        if (s->vertex_mark[v] == stamp && v != left && v != right) {
            return gproji_fail(error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_EDGE, h / 2,
                               "edge %d cannot be collapsed: vertices %d and %d have both an edge to vertex %d, and no "
                               "triangle is between",
                               h / 2, s->origin[h], s->origin[g], v);
        }
        if (f >= 0 && s->face_mark[f] == stamp && f != s->face[h] && f != s->face[g]) {
            return gproji_fail(error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_EDGE, h / 2,
                               "edge %d cannot be collapsed: vertices %d and %d are corners of face %d, too", h / 2,
                               s->origin[h], s->origin[g], f);
        }
    }
    return GPROJ_OK;
}

GPROJI_INTERNAL gproj_code gproji_check_collapse(gproji_edit_object *object, int32_t h, gproj_error *error) {
    const gproji_edit_store *s = &object->now;
    int32_t a = s->origin[h], b = s->origin[h ^ 1];
    gproj_code code = gproji_check_vanishing(s, h, error);
    if (!code) code = gproji_check_vanishing(s, h ^ 1, error);
    if (code) return code;
    if (s->face[h] >= 0 && s->face[h ^ 1] >= 0 && gproj_mesh_is_boundary_vertex(&object->view, a) &&
        gproj_mesh_is_boundary_vertex(&object->view, b)) {
        return gproji_fail(
            error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_EDGE, h / 2,
            "edge %d cannot be collapsed: it goes from boundary to boundary, from vertex %d to vertex %d, "
            "and the mesh would be pinched there",
            h / 2, a, b);
    }
    return gproji_check_link(object, h, error);
}

/* -- life -- */

GPROJI_INTERNAL void gproji_edit_load(gproji_edit_object *object, const gproj_mesh *mesh) {
    gproji_edit_store *s = &object->now;
    size_t vertices = (size_t)mesh->vertex_count, halfedges = (size_t)mesh->halfedge_count,
           faces = (size_t)mesh->face_count;
    int32_t i;
    memcpy(s->position, mesh->position, vertices * 3 * sizeof(double));
    memcpy(s->vertex_halfedge, mesh->vertex_halfedge, vertices * sizeof(int32_t));
    memcpy(s->next, mesh->next, halfedges * sizeof(int32_t));
    memcpy(s->prev, mesh->prev, halfedges * sizeof(int32_t));
    memcpy(s->origin, mesh->origin, halfedges * sizeof(int32_t));
    memcpy(s->face, mesh->face, halfedges * sizeof(int32_t));
    memcpy(s->face_halfedge, mesh->face_halfedge, faces * sizeof(int32_t));
    memcpy(s->face_degree, mesh->face_degree, faces * sizeof(int32_t));
    memcpy(s->polyline_start, mesh->polyline_start, ((size_t)s->polyline_count + 1) * sizeof(int32_t));
    memcpy(s->polyline_vertex, mesh->polyline_vertex, (size_t)s->polyline_room * sizeof(int32_t));
    for (i = 0; i < mesh->vertex_count; ++i) s->vertex_into[i] = i;
    for (i = 0; i < mesh->edge_count; ++i) s->edge_into[i] = i;
    for (i = 0; i < mesh->face_count; ++i) s->face_parent[i] = i;
    for (i = 0; i < s->polyline_room; ++i) s->on_polyline[s->polyline_vertex[i]] = 1;
}

GPROJ_API void gproj_edit_destroy(gproj_edit *edit) {
    gproji_edit_object *object = edit ? gproji_edit_owner(edit, NULL) : NULL;
    int32_t kind;
    if (!object) return;
    gproji_edit_give(&object->heap, &object->now);
    for (kind = 0; kind < GPROJI_EDIT_KINDS; ++kind)
        gproji_give(&object->heap, object->number[kind], (size_t)object->number_count[kind], sizeof(int32_t));
    gproji_destroy_object(object, sizeof *object);
}

GPROJ_API gproj_edit *gproj_edit_create(const gproj_mesh *mesh, const gproj_host *host, gproj_error *error) {
    gproji_edit_object *object;
    gproji_edit_store *s;
    int32_t kind;
    gproji_error_clear(error);
    if (!mesh) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the mesh to edit is NULL");
        return NULL;
    }
    object = (gproji_edit_object *)gproji_create_object(host, sizeof *object);
    if (!object) {
        gproji_fail_memory(error);
        return NULL;
    }
    s = &object->now;
    s->count[GPROJI_EDIT_VERTEX] = mesh->vertex_count, s->count[GPROJI_EDIT_HALFEDGE] = mesh->halfedge_count;
    s->count[GPROJI_EDIT_EDGE] = mesh->edge_count, s->count[GPROJI_EDIT_FACE] = mesh->face_count;
    for (kind = 0; kind < GPROJI_EDIT_KINDS; ++kind) s->room[kind] = s->count[kind];
    s->polyline_count = mesh->polyline_count;
    s->polyline_room = mesh->polyline_start[mesh->polyline_count];
    if (!gproji_edit_take(&object->heap, s)) {
        gproji_fail_memory(error);
        gproj_edit_destroy(&object->edit);
        return NULL;
    }
    gproji_edit_load(object, mesh);
    gproji_edit_publish(object);
    return &object->edit;
}

GPROJ_API gproj_memory gproj_edit_memory(const gproj_edit *edit) {
    gproj_memory none;
    memset(&none, 0, sizeof none);
    if (!edit) return none;
    return ((const gproji_edit_object *)(const void *)((const char *)edit - offsetof(gproji_edit_object, edit)))
        ->heap.account;
}

/* -- from an edit to a mesh -- */

/* What gproj_edit_mesh works with: all arrays as large as they can become. */
typedef struct gproji_edit_out {
    int32_t *number[GPROJI_EDIT_KINDS];
    gproji_soup soup;
    double *position;
    int32_t *degree, *corner;
    int32_t polyline_count, *start, *vertex;
} gproji_edit_out;

/* False when there is no memory. The numbers stay with the edit if all goes well: see gproji_edit_keep_numbers. */
GPROJI_INTERNAL bool gproji_edit_out_take(gproji_edit_object *object, gproji_pool *pool, gproji_edit_out *out) {
    const gproji_edit_store *s = &object->now;
    bool complete = true;
    int32_t kind;
    memset(out, 0, sizeof *out);
    for (kind = 0; kind < GPROJI_EDIT_KINDS; ++kind) {
        if (kind == GPROJI_EDIT_HALFEDGE) continue;
        out->number[kind] = (int32_t *)gproji_take(&object->heap, (size_t)s->count[kind], sizeof(int32_t));
        complete = complete && out->number[kind];
    }
    out->position = (double *)gproji_pool_take(pool, s->count[GPROJI_EDIT_VERTEX], 3 * sizeof(double));
    out->degree = (int32_t *)gproji_pool_take(pool, s->count[GPROJI_EDIT_FACE], sizeof(int32_t));
    out->corner = (int32_t *)gproji_pool_take(pool, s->count[GPROJI_EDIT_HALFEDGE], sizeof(int32_t));
    out->start = (int32_t *)gproji_pool_take(pool, (int64_t)s->polyline_count + 1, sizeof(int32_t));
    out->vertex = (int32_t *)gproji_pool_take(pool, s->polyline_room, sizeof(int32_t));
    return complete && out->position && out->degree && out->corner && out->start && out->vertex;
}

/* Numbers the vertices and faces that are left, and writes them down as polygons. */
GPROJI_INTERNAL void gproji_edit_write_soup(const gproji_edit_store *s, gproji_edit_out *out) {
    gproji_soup *soup = &out->soup;
    int32_t *vertex = out->number[GPROJI_EDIT_VERTEX], *face = out->number[GPROJI_EDIT_FACE];
    int32_t v, f, h, k, corners = 0;
    for (v = 0; v < s->count[GPROJI_EDIT_VERTEX]; ++v) {
        vertex[v] = s->vertex_into[v] == v ? soup->vertex_count : vertex[s->vertex_into[v]];
        if (s->vertex_into[v] != v) continue;
        memcpy(out->position + 3 * (size_t)soup->vertex_count++, s->position + 3 * (size_t)v, 3 * sizeof(double));
    }
    for (f = 0; f < s->count[GPROJI_EDIT_FACE]; ++f) {
        h = s->face_halfedge[f];
        face[f] = h < 0 ? -1 : soup->face_count;
        if (h < 0) continue;
        out->degree[soup->face_count++] = s->face_degree[f];
        for (k = 0; k < s->face_degree[f]; ++k, h = s->next[h]) out->corner[corners++] = vertex[s->origin[h]];
    }
    soup->position = out->position;
    soup->face_degree = out->degree;
    soup->face_vertex = out->corner;
}

/* Writes down the polylines in new numbers, without repeated vertices, and those with at least two. */
GPROJI_INTERNAL void gproji_edit_write_polylines(const gproji_edit_store *s, gproji_edit_out *out) {
    int32_t p, i, begin, end = 0;
    out->start[0] = 0;
    for (p = 0; p < s->polyline_count; ++p) {
        begin = end;
        for (i = s->polyline_start[p]; i < s->polyline_start[p + 1]; ++i) {
            int32_t v = out->number[GPROJI_EDIT_VERTEX][s->polyline_vertex[i]];
            if (end == begin || out->vertex[end - 1] != v) out->vertex[end++] = v;
        }
        if (end < begin + 2) {
            end = begin;
            continue;
        }
        out->start[++out->polyline_count] = end;
    }
}

/* Edges have the numbers that the mesh gave them. */
GPROJI_INTERNAL void gproji_edit_number_edges(const gproji_edit_store *s, const gproj_mesh *mesh,
                                              gproji_edit_out *out) {
    int32_t *edge = out->number[GPROJI_EDIT_EDGE], f, e, h, k, i;
    for (f = 0; f < s->count[GPROJI_EDIT_FACE]; ++f) {
        if (s->face_halfedge[f] < 0) continue;
        h = s->face_halfedge[f], k = mesh->face_halfedge[out->number[GPROJI_EDIT_FACE][f]];
        for (i = 0; i < s->face_degree[f]; ++i, h = s->next[h], k = mesh->next[k]) edge[h / 2] = k / 2;
    }
    for (e = 0; e < s->count[GPROJI_EDIT_EDGE]; ++e)
        if (s->edge_into[e] != e) edge[e] = s->edge_into[e] < 0 ? -1 : edge[s->edge_into[e]];
}

/* The new maps of numbers for the old ones. */
GPROJI_INTERNAL void gproji_edit_keep_numbers(gproji_edit_object *object, gproji_edit_out *out) {
    int32_t kind;
    for (kind = 0; kind < GPROJI_EDIT_KINDS; ++kind) {
        gproji_give(&object->heap, object->number[kind], (size_t)object->number_count[kind], sizeof(int32_t));
        object->number[kind] = out->number[kind];
        object->number_count[kind] = object->now.count[kind];
        out->number[kind] = NULL;
    }
    gproji_edit_publish(object);
}

GPROJ_API gproj_mesh *gproj_edit_mesh(gproj_edit *edit, const gproj_host *host, gproj_error *error) {
    gproji_edit_object *object = gproji_edit_owner(edit, error);
    gproji_mesh_object *made;
    gproji_edit_out out;
    gproji_pool pool;
    gproj_code code;
    int32_t kind;
    if (!object) return NULL;
    made = gproji_mesh_begin(host, error);
    if (!made) return NULL;
    gproji_pool_start(&pool, &object->heap);
    code = gproji_edit_out_take(object, &pool, &out) ? GPROJ_OK : gproji_fail_memory(error);
    if (!code) {
        gproji_edit_write_soup(&object->now, &out);
        gproji_edit_write_polylines(&object->now, &out);
        code = gproji_mesh_build(made, &out.soup, error);
    }
    if (!code) code = gproji_mesh_set_polylines(made, out.polyline_count, out.start, out.vertex, error);
    if (!code) {
        gproji_edit_number_edges(&object->now, &made->mesh, &out);
        gproji_edit_keep_numbers(object, &out);
    }
    for (kind = 0; kind < GPROJI_EDIT_KINDS; ++kind)
        gproji_give(&object->heap, out.number[kind], (size_t)object->now.count[kind], sizeof(int32_t));
    gproji_pool_give_all(&pool);
    return gproji_mesh_done(made, code);
}

/* -- edges and faces -- */

GPROJ_API int32_t gproj_edit_vertex(gproj_edit *edit, int32_t vertex) {
    gproji_edit_object *object = gproji_edit_owner(edit, NULL);
    if (!object || vertex < 0 || vertex >= edit->vertex_count) return -1;
    return gproji_edit_root(object->now.vertex_into, vertex);
}

GPROJ_API int32_t gproj_edit_edge(gproj_edit *edit, int32_t vertex, int32_t other) {
    gproji_edit_object *object = gproji_edit_owner(edit, NULL);
    int32_t a = gproj_edit_vertex(edit, vertex), b = gproj_edit_vertex(edit, other), h;
    h = a < 0 || b < 0 ? -1 : gproji_edit_joined(object, a, b);
    return h < 0 ? -1 : h / 2;
}

GPROJ_API int32_t gproj_edit_split_edge(gproj_edit *edit, int32_t edge, double t, gproj_error *error) {
    gproji_edit_object *object = gproji_edit_owner(edit, error);
    int32_t h = object ? gproji_edit_given_edge(object, edge, t, error) : -1;
    if (h < 0 || gproji_edit_reserve(object, 1, 1, 0, error) ||
        gproji_polyline_reserve(object, gproji_polyline_count_runs(&object->now, h), error)) {
        return -1;
    }
    return object->now.origin[gproji_edit_split(object, h, t)];
}

GPROJ_API int32_t gproj_edit_split_face(gproj_edit *edit, int32_t face, int32_t vertex, int32_t other,
                                        gproj_error *error) {
    gproji_edit_object *object = gproji_edit_owner(edit, error);
    int32_t from, to;
    if (!object || !gproji_edit_given_face(object, face, error)) return -1;
    from = gproji_edit_given_corner(object, face, vertex, error);
    to = from < 0 ? -1 : gproji_edit_given_corner(object, face, other, error);
    if (to < 0) return -1;
    if (from == to) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_FACE, face,
                    "face %d cannot be cut from vertex %d to itself", face, vertex);
        return -1;
    }
    if (gproji_edit_joined(object, object->now.origin[from], object->now.origin[to]) >= 0) {
        gproji_fail(error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, face,
                    "face %d cannot be cut between vertices %d and %d: they have an edge already", face, vertex, other);
        return -1;
    }
    return gproji_edit_reserve(object, 0, 1, 1, error) ? -1 : gproji_edit_cut(object, from, to) / 2;
}

GPROJ_API int32_t gproj_edit_collapse_edge(gproj_edit *edit, int32_t edge, double t, gproj_error *error) {
    gproji_edit_object *object = gproji_edit_owner(edit, error);
    int32_t h = object ? gproji_edit_given_edge(object, edge, t, error) : -1;
    return h < 0 || gproji_check_collapse(object, h, error) ? -1 : gproji_edit_collapse(object, h, t);
}

/* -- triangles -- */

enum {
    GPROJI_KLINCSEK_MAX = 128 /* corners of a polygon for which all triangulations are compared: O(n^3) */
};

/* The work of cutting faces into triangles. */
typedef struct gproji_triangulation {
    gproji_polygon polygon;
    int32_t *halfedge; /* polygon.capacity: from each corner on, in the part of the face that is left */
    int32_t *ear;      /* 2 * polygon.capacity: the corners before and after each ear, in the order of cutting */
    int32_t ear_count;
    int32_t ring[GPROJI_KLINCSEK_MAX]; /* the corners that are left for the comparison */
    int32_t ring_count;
    double *least; /* ring_count^2: the least sum for the part of the ring from i to j */
    int32_t *apex; /* ring_count^2: the third corner of the triangle at i and j for which it is least */
} gproji_triangulation;

/* For faces of at most `degree` corners. False when there is no memory. */
GPROJI_INTERNAL bool gproji_triangulation_take(gproji_pool *pool, gproji_triangulation *work, int32_t degree) {
    int64_t side = gproji_min(degree, GPROJI_KLINCSEK_MAX);
    memset(work, 0, sizeof *work);
    work->polygon.capacity = degree;
    work->polygon.xy = (double *)gproji_pool_take(pool, degree, 2 * sizeof(double));
    work->polygon.vertex = (int32_t *)gproji_pool_take(pool, degree, sizeof(int32_t));
    work->polygon.next = (int32_t *)gproji_pool_take(pool, degree, sizeof(int32_t));
    work->polygon.prev = (int32_t *)gproji_pool_take(pool, degree, sizeof(int32_t));
    work->halfedge = (int32_t *)gproji_pool_take(pool, degree, sizeof(int32_t));
    work->ear = (int32_t *)gproji_pool_take(pool, degree, 2 * sizeof(int32_t));
    work->least = (double *)gproji_pool_take(pool, side * side, sizeof(double));
    work->apex = (int32_t *)gproji_pool_take(pool, side * side, sizeof(int32_t));
    return work->polygon.xy && work->polygon.vertex && work->polygon.next && work->polygon.prev && work->halfedge &&
           work->ear && work->least && work->apex;
}

GPROJI_INLINE bool gproji_corners_joined(const gproji_edit_object *object, const gproji_polygon *polygon, int32_t a,
                                         int32_t b) {
    return gproji_edit_joined(object, polygon->vertex[a], polygon->vertex[b]) >= 0;
}

/* Cuts ears from a large polygon, as gproji_cut_ears does, until it is small enough. Where no corner is an ear any
   more, any whose neighbours have no edge yet is taken; false where there is none. */
GPROJI_INTERNAL bool gproji_plan_ears(const gproji_edit_object *object, gproji_triangulation *work) {
    gproji_polygon *polygon = &work->polygon;
    int64_t budget = 512 * (int64_t)polygon->count;
    int32_t left = polygon->count, b = 0, refused = 0, i;
    bool any = false;
    work->ear_count = 0;
    while (left > GPROJI_KLINCSEK_MAX) {
        int32_t a = polygon->prev[b], c = polygon->next[b];
        any = any || refused >= left || budget <= 0;
        if (refused >= 2 * left) return false;
        if (gproji_corners_joined(object, polygon, a, c) || (!any && !gproji_is_ear(polygon, b, &budget))) {
            ++refused;
            b = c;
            continue;
        }
        work->ear[2 * work->ear_count] = a, work->ear[2 * work->ear_count + 1] = c;
        ++work->ear_count;
        polygon->next[a] = c, polygon->prev[c] = a;
        --left, refused = 0;
        any = false;
        b = c;
    }
    for (i = 0; i < left; ++i, b = polygon->next[b]) work->ring[i] = b;
    work->ring_count = left;
    return true;
}

/* What a triangle costs: 1 / x with x = 2 area / (a^2 + b^2 + c^2), which is sqrt(1/12) where all sides are equal; for
   x near 0 and for triangles that are turned over, the tangent of that at 1e-6. */
GPROJI_INTERNAL double gproji_triangle_cost(const gproji_polygon *polygon, int32_t a, int32_t b, int32_t c) {
    const double least = 1e-6;
    const double *p = polygon->xy + 2 * (size_t)a, *q = polygon->xy + 2 * (size_t)b, *r = polygon->xy + 2 * (size_t)c;
    double ux = q[0] - p[0], uy = q[1] - p[1], vx = r[0] - q[0], vy = r[1] - q[1], wx = p[0] - r[0], wy = p[1] - r[1];
    double squares = ux * ux + uy * uy + vx * vx + vy * vy + wx * wx + wy * wy;
    double x = squares > 0 ? gproji_turn(polygon, a, b, c) / squares : 0;
    if (!(x > -1)) x = -1; /* a position is not finite */
    return x >= least ? 1 / x : (2 - x / least) / least;
}

/* The triangulation of the ring with the least sum of costs, from small parts to the whole (Klincsek 1980). False where
   each needs a diagonal that is an edge already. */
GPROJI_INTERNAL bool gproji_plan_ring(const gproji_edit_object *object, gproji_triangulation *work) {
    int32_t n = work->ring_count, gap, i, j, k;
    for (i = 0; i + 1 < n; ++i) work->least[i * n + i + 1] = 0;
    for (gap = 2; gap < n; ++gap) {
        for (i = 0; i + gap < n; ++i) {
            double *least = &work->least[i * n + i + gap];
            j = i + gap;
            *least = HUGE_VAL;
            work->apex[i * n + j] = -1;
            if (gap < n - 1 && gproji_corners_joined(object, &work->polygon, work->ring[i], work->ring[j])) continue;
            for (k = i + 1; k < j; ++k) {
                double sum = work->least[i * n + k] + work->least[k * n + j];
                if (!(sum < *least)) continue;
                sum += gproji_triangle_cost(&work->polygon, work->ring[i], work->ring[k], work->ring[j]);
                if (!(sum < *least)) continue;
                *least = sum;
                work->apex[i * n + j] = k;
            }
        }
    }
    return work->apex[n - 1] >= 0;
}

/* Decides on the diagonals of a face. Nothing is changed. */
GPROJI_INTERNAL gproj_code gproji_plan_triangles(gproji_edit_object *object, gproji_triangulation *work, int32_t face,
                                                 gproj_error *error) {
    int32_t h = object->now.face_halfedge[face], i;
    gproji_polygon_set(&work->polygon, &object->view, face);
    for (i = 0; i < work->polygon.count; ++i, h = object->now.next[h]) work->halfedge[i] = h;
    if (gproji_plan_ears(object, work) && gproji_plan_ring(object, work)) return GPROJ_OK;
    return gproji_fail(error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, face,
                       "face %d cannot be cut into triangles: its diagonals are edges already", face);
}

/* Cuts a face as planned; there is room. */
GPROJI_INTERNAL void gproji_cut_triangles(gproji_edit_object *object, gproji_triangulation *work) {
    int32_t *halfedge = work->halfedge, n = work->ring_count, stack[2 * GPROJI_KLINCSEK_MAX], depth = 0, i;
    for (i = 0; i < work->ear_count; ++i) {
        int32_t a = work->ear[2 * i], c = work->ear[2 * i + 1];
        halfedge[a] = gproji_edit_cut(object, halfedge[a], halfedge[c]);
    }
    stack[depth++] = 0, stack[depth++] = n - 1; /* parts of the ring, from a corner to a corner, one face each */
    while (depth) {
        int32_t last = stack[--depth], first = stack[--depth], apex = work->apex[first * n + last];
        int32_t from = halfedge[work->ring[first]], middle = halfedge[work->ring[apex]],
                closing = object->now.prev[from];
        if (apex > first + 1) {
            gproji_edit_cut(object, from, middle);
            stack[depth++] = first, stack[depth++] = apex;
        }
        if (last > apex + 1) {
            gproji_edit_cut(object, middle, closing);
            stack[depth++] = apex, stack[depth++] = last;
        }
    }
}

/* Cuts one face. */
GPROJI_INTERNAL gproj_code gproji_triangulate_face(gproji_edit_object *object, gproji_triangulation *work, int32_t face,
                                                   gproj_error *error) {
    gproj_code code = gproji_plan_triangles(object, work, face, error);
    if (!code) gproji_cut_triangles(object, work);
    return code;
}

/* Cuts all faces, or none where one cannot be cut. */
GPROJI_INTERNAL gproj_code gproji_triangulate_all(gproji_edit_object *object, gproji_triangulation *work,
                                                  gproj_error *error) {
    gproji_edit_store copy;
    gproj_code code = GPROJ_OK;
    int32_t f, count = object->now.count[GPROJI_EDIT_FACE];
    if (!gproji_edit_save(object, &copy)) return gproji_fail_memory(error);
    for (f = 0; f < count && !code; ++f)
        if (object->now.face_halfedge[f] >= 0 && object->now.face_degree[f] > 3)
            code = gproji_triangulate_face(object, work, f, error);
    return gproji_edit_settle(object, &copy, code);
}

GPROJ_API int32_t gproj_edit_triangulate(gproj_edit *edit, int32_t face, gproj_error *error) {
    gproji_edit_object *object = gproji_edit_owner(edit, error);
    gproji_triangulation work;
    gproji_pool pool;
    gproj_code code;
    int64_t cuts = 0;
    int32_t f, first = face, last = face, degree = 3;
    if (!object || (face != -1 && !gproji_edit_given_face(object, face, error))) return -1;
    if (face == -1) first = 0, last = edit->face_count - 1;
    for (f = first; f <= last; ++f) {
        if (edit->face_halfedge[f] < 0) continue;
        degree = gproji_max(degree, edit->face_degree[f]);
        cuts += edit->face_degree[f] - 3;
    }
    if (!cuts) return 0;
    gproji_pool_start(&pool, &object->heap);
    code = gproji_edit_reserve(object, 0, cuts, cuts, error);
    if (!code && !gproji_triangulation_take(&pool, &work, degree)) code = gproji_fail_memory(error);
    if (!code)
        code = face == -1 ? gproji_triangulate_all(object, &work, error)
                          : gproji_triangulate_face(object, &work, face, error);
    gproji_pool_give_all(&pool);
    return code ? -1 : (int32_t)cuts;
}

/* -- strips -- */

/* The rungs of a strip, as half-edges of one direction, in order. */
typedef struct gproji_strip {
    int32_t count;
    int32_t given; /* the place of the half-edge that the walk began with */
    bool closed;   /* is there a quad between the last and the first? */
    int32_t *rung; /* count */
    int32_t *side; /* count: the origins of the rungs */
} gproji_strip;

GPROJI_INLINE bool gproji_is_quad(const gproji_edit_store *s, int32_t h) {
    return s->face[h] >= 0 && s->face_degree[s->face[h]] == 4;
}

/* The rung after h, across the quad at its left; -1 where there is none. */
GPROJI_INLINE int32_t gproji_strip_next(const gproji_edit_store *s, int32_t h) {
    return gproji_is_quad(s, h) ? s->next[s->next[h]] ^ 1 : -1;
}

/* The first rung of the strip of half-edge h: h itself where the strip is closed. */
GPROJI_INTERNAL int32_t gproji_strip_first(const gproji_edit_store *s, int32_t h) {
    int32_t g = h;
    while (gproji_is_quad(s, g ^ 1)) {
        g = s->next[s->next[g ^ 1]];
        if (g == h) break;
    }
    return g;
}

/* Walks along the strip of half-edge h. */
GPROJI_INTERNAL gproj_code gproji_strip_take(const gproji_edit_store *s, gproji_pool *pool, int32_t h,
                                             gproji_strip *strip, gproj_error *error) {
    int32_t first = gproji_strip_first(s, h), g, i;
    memset(strip, 0, sizeof *strip);
    g = first;
    do {
        ++strip->count;
        g = gproji_strip_next(s, g);
    } while (g >= 0 && g != first);
    strip->closed = g == first;
    if (strip->count == 1) {
        return gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_EDGE, h / 2, "edge %d has no quad at either side",
                           h / 2);
    }
    strip->rung = (int32_t *)gproji_pool_take(pool, strip->count, sizeof(int32_t));
    strip->side = (int32_t *)gproji_pool_take(pool, strip->count, sizeof(int32_t));
    if (!strip->rung || !strip->side) return gproji_fail_memory(error);
    for (i = 0, g = first; i < strip->count; ++i, g = gproji_strip_next(s, g)) {
        if (g == h) strip->given = i;
        strip->rung[i] = g;
        strip->side[i] = s->origin[g];
    }
    return GPROJ_OK;
}

/* Checks, and room for gproji_strip_insert: all rungs are split, all quads cut, and each quad that is crossed twice has
   one more vertex, edge, and cut. */
GPROJI_INTERNAL gproj_code gproji_strip_reserve(gproji_edit_object *object, const gproji_strip *strip,
                                                gproj_error *error) {
    int64_t count = strip->count, runs = 0;
    int32_t i, e = strip->rung[0] / 2;
    gproj_code code;
    if (strip->closed && count == 2) {
        return gproji_fail(error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_EDGE, e,
                           "no strip can be inserted at edge %d: its two quads have edge %d in common, too, and there "
                           "would be two edges between the new vertices",
                           e, strip->rung[1] / 2);
    }
    code = gproji_edit_reserve(object, 2 * count, 4 * count, 2 * count, error);
    for (i = 0; i < strip->count; ++i) runs += gproji_polyline_count_runs(&object->now, strip->rung[i]);
    return code ? code : gproji_polyline_reserve(object, runs, error);
}

/* Cuts a quad from the origin x of half-edge `from` to vertex y of the opposite rung. Where it has been cut by the
   strip already, from side to side, that cut is split at t and met there. */
GPROJI_INTERNAL void gproji_strip_cross(gproji_edit_object *object, int32_t from, int32_t y, double t) {
    gproji_edit_store *s = &object->now;
    int32_t to = gproji_edit_corner(s, s->face[from], y), cut;
    if (to < 0) {
        cut = s->next[s->next[from]]; /* from x: to the end of the rung, to the cut, along it */
        gproji_edit_cut(object, from, gproji_edit_split(object, cut, 1 - t));
        from = cut ^ 1;
        to = gproji_edit_corner(s, s->face[from], y);
    }
    gproji_edit_cut(object, from, to);
}

/* Where a strip ends at a triangle, which has got a fourth corner at the origin of half-edge h, it is cut into two: as a
   quad it would lead on. */
GPROJI_INTERNAL void gproji_strip_end(gproji_edit_object *object, int32_t h) {
    const gproji_edit_store *s = &object->now;
    if (gproji_is_quad(s, h)) gproji_edit_cut(object, h, s->next[s->next[h]]);
}

/* Splits the rungs and cuts the quads of a strip; there is room. Rungs become the half-edges from new vertices on. */
GPROJI_INTERNAL void gproji_strip_insert(gproji_edit_object *object, gproji_strip *strip, double t) {
    const gproji_edit_store *s = &object->now;
    int32_t i, last = strip->count - 1;
    for (i = 0; i <= last; ++i) strip->rung[i] = gproji_edit_split(object, strip->rung[i], t);
    if (!strip->closed) {
        gproji_strip_end(object, s->next[strip->rung[0] ^ 1]);
        gproji_strip_end(object, strip->rung[last]);
    }
    for (i = 0; i < last; ++i) gproji_strip_cross(object, strip->rung[i], s->origin[strip->rung[i + 1]], t);
    if (strip->closed) gproji_strip_cross(object, strip->rung[last], s->origin[strip->rung[0]], t);
}

GPROJ_API int32_t gproj_edit_insert_strip(gproj_edit *edit, int32_t edge, double t, gproj_error *error) {
    gproji_edit_object *object = gproji_edit_owner(edit, error);
    int32_t h = object ? gproji_edit_given_edge(object, edge, t, error) : -1;
    gproji_strip strip;
    gproji_pool pool;
    gproj_code code;
    if (h < 0) return -1;
    gproji_pool_start(&pool, &object->heap);
    code = gproji_strip_take(&object->now, &pool, h, &strip, error);
    if (!code) code = gproji_strip_reserve(object, &strip, error);
    if (!code) {
        gproji_strip_insert(object, &strip, t);
        h = strip.rung[strip.given];
    }
    gproji_pool_give_all(&pool);
    return code ? -1 : h / 2;
}

/* Collapses the rung in place i of a strip, if that may be. One that was merged into another, where the strip crosses
   itself, is gone with that. */
GPROJI_INTERNAL gproj_code gproji_strip_collapse_rung(gproji_edit_object *object, const gproji_strip *strip, int32_t i,
                                                      double t, gproj_error *error) {
    gproji_edit_store *s = &object->now;
    int32_t e = gproji_edit_root(s->edge_into, strip->rung[i] / 2), h;
    gproj_code code;
    if (e < 0) return GPROJ_OK;
    h = s->origin[2 * e] == gproji_edit_root(s->vertex_into, strip->side[i]) ? 2 * e : 2 * e + 1;
    code = gproji_check_collapse(object, h, error);
    if (!code) gproji_edit_collapse(object, h, t);
    return code;
}

/* Collapses the rungs of a strip one by one; those that are refused again, after the others, as long as that helps. */
GPROJI_INTERNAL gproj_code gproji_strip_collapse(gproji_edit_object *object, gproji_strip *strip, double t,
                                                 gproj_error *error) {
    int32_t left = strip->count, tried, i;
    gproj_code code, refusal;
    do {
        tried = left;
        left = 0;
        refusal = GPROJ_OK;
        gproji_error_clear(error);
        for (i = 0; i < tried; ++i) {
            code = gproji_strip_collapse_rung(object, strip, i, t, error);
            if (!code) continue;
            refusal = code;
            strip->rung[left] = strip->rung[i];
            strip->side[left++] = strip->side[i];
        }
    } while (left && left < tried);
    return refusal;
}

/* Says why a strip stays: `error` has why one of its rungs does. */
GPROJI_INTERNAL void gproji_tell_strip(int32_t edge, gproj_error *error) {
    char message[GPROJ_MESSAGE_SIZE];
    if (!error) return;
    gproji_format(message, sizeof message, "the strip of edge %d stays: %s", edge, error->message);
    memcpy(error->message, message, sizeof message);
}

GPROJ_API int32_t gproj_edit_remove_strip(gproj_edit *edit, int32_t edge, double t, gproj_error *error) {
    gproji_edit_object *object = gproji_edit_owner(edit, error);
    int32_t h = object ? gproji_edit_given_edge(object, edge, t, error) : -1;
    gproji_edit_store copy;
    gproji_strip strip;
    gproji_pool pool;
    gproj_code code;
    if (h < 0) return -1;
    gproji_pool_start(&pool, &object->heap);
    code = gproji_strip_take(&object->now, &pool, h, &strip, error);
    if (!code && !gproji_edit_save(object, &copy)) code = gproji_fail_memory(error);
    if (!code) {
        code = gproji_edit_settle(object, &copy, gproji_strip_collapse(object, &strip, t, error));
        if (code) gproji_tell_strip(edge, error);
    }
    gproji_pool_give_all(&pool);
    return code ? -1 : strip.count;
}

/* -- the dual -- */

/* The work of gproj_mesh_dual, with room for all that a dual can have: each half-edge of a face gives a corner, each
   vertex of the boundary two or three more. */
typedef struct gproji_dual {
    gproji_soup soup;
    double *position;
    int32_t *degree, *corner;
    int32_t *vertex;   /* vertex_count: the number of a vertex that is in the dual, too, or -1 */
    int32_t *midpoint; /* edge_count: the vertex in the middle of a boundary edge, or -1 */
    int32_t *seen;     /* face_count: the last face that met it as a neighbour */
    int32_t *start, *polyline;
    int32_t polyline_count;
} gproji_dual;

/* False when there is no memory. */
GPROJI_INTERNAL bool gproji_dual_take(gproji_pool *pool, const gproj_mesh *mesh, gproji_dual *dual) {
    int64_t vertices = mesh->vertex_count, edges = mesh->edge_count, faces = mesh->face_count;
    memset(dual, 0, sizeof *dual);
    dual->position = (double *)gproji_pool_take(pool, faces + edges + vertices, 3 * sizeof(double));
    dual->corner = (int32_t *)gproji_pool_take(pool, 2 * edges + 3 * vertices, sizeof(int32_t));
    dual->degree = (int32_t *)gproji_pool_take(pool, vertices, sizeof(int32_t));
    dual->vertex = (int32_t *)gproji_pool_take(pool, vertices, sizeof(int32_t));
    dual->midpoint = (int32_t *)gproji_pool_take(pool, edges, sizeof(int32_t));
    dual->seen = (int32_t *)gproji_pool_take(pool, faces, sizeof(int32_t));
    dual->start = (int32_t *)gproji_pool_take(pool, (int64_t)mesh->polyline_count + 1, sizeof(int32_t));
    dual->polyline = (int32_t *)gproji_pool_take(pool, mesh->polyline_start[mesh->polyline_count], sizeof(int32_t));
    return dual->position && dual->corner && dual->degree && dual->vertex && dual->midpoint && dual->seen &&
           dual->start && dual->polyline;
}

/* No two faces have two edges in common. */
GPROJI_INTERNAL gproj_code gproji_check_dual(const gproj_mesh *mesh, gproji_dual *dual, gproj_error *error) {
    int32_t f, k, h, g;
    gproji_fill(dual->seen, mesh->face_count, -1);
    for (f = 0; f < mesh->face_count; ++f) {
        for (k = 0, h = mesh->face_halfedge[f]; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
            g = mesh->face[h ^ 1];
            if (g < 0) continue;
            if (dual->seen[g] == f) {
                return gproji_fail(error, GPROJ_ERROR_NON_MANIFOLD, GPROJ_PLACE_FACE, f,
                                   "there is no dual: faces %d and %d have more than one edge in common", f, g);
            }
            dual->seen[g] = f;
        }
    }
    return GPROJ_OK;
}

/* A new vertex of the dual, at the mean of the origins of `count` half-edges, h and those that follow it. */
GPROJI_INTERNAL int32_t gproji_dual_add(const gproj_mesh *mesh, gproji_dual *dual, int32_t h, int32_t count) {
    int32_t number = dual->soup.vertex_count++, k;
    double *x = dual->position + 3 * (size_t)number;
    gproji_set3(0, 0, 0, x);
    for (k = 0; k < count; ++k, h = mesh->next[h])
        gproji_add_scaled3(1.0 / count, mesh->position + 3 * (size_t)mesh->origin[h], x);
    return number;
}

/* A vertex that is in the dual, too, gets its number there. */
GPROJI_INTERNAL void gproji_dual_keep(const gproj_mesh *mesh, gproji_dual *dual, int32_t vertex) {
    int32_t number = dual->soup.vertex_count++;
    gproji_copy3(mesh->position + 3 * (size_t)vertex, dual->position + 3 * (size_t)number);
    dual->vertex[vertex] = number;
}

GPROJI_INTERNAL void gproji_dual_vertices_of(const gproj_mesh *mesh, gproji_dual *dual) {
    int32_t f, e, v;
    for (f = 0; f < mesh->face_count; ++f) gproji_dual_add(mesh, dual, mesh->face_halfedge[f], mesh->face_degree[f]);
    for (e = 0; e < mesh->edge_count; ++e)
        dual->midpoint[e] = mesh->face[2 * e + 1] < 0 ? gproji_dual_add(mesh, dual, 2 * e, 2) : -1;
    gproji_fill(dual->vertex, mesh->vertex_count, -1);
    for (v = 0; v < mesh->vertex_count; ++v)
        if (gproji_is_corner(mesh, mesh->position, v)) gproji_dual_keep(mesh, dual, v);
    for (v = 0; v < mesh->vertex_count; ++v)
        if (mesh->vertex_halfedge[v] < 0) gproji_dual_keep(mesh, dual, v);
}

/* The face of a vertex that has faces: those around it; at the boundary the middle of an edge, the faces, the middle of
   the other edge, and the vertex if it is a corner. */
GPROJI_INTERNAL void gproji_dual_face(const gproj_mesh *mesh, gproji_dual *dual, int32_t vertex) {
    gproji_soup *soup = &dual->soup;
    int32_t last = mesh->vertex_halfedge[vertex], h, begin = soup->corner_count;
    bool boundary = mesh->face[last] < 0;
    h = boundary ? gproji_rotate(mesh, last) : last;
    if (boundary) dual->corner[soup->corner_count++] = dual->midpoint[h / 2];
    do {
        dual->corner[soup->corner_count++] = mesh->face[h];
        h = gproji_rotate(mesh, h);
    } while (h != last);
    if (boundary) dual->corner[soup->corner_count++] = dual->midpoint[last / 2];
    if (dual->vertex[vertex] >= 0) dual->corner[soup->corner_count++] = dual->vertex[vertex];
    dual->degree[soup->face_count++] = soup->corner_count - begin;
}

/* Polylines all of whose vertices are in the dual. */
GPROJI_INTERNAL void gproji_dual_polylines(const gproj_mesh *mesh, gproji_dual *dual) {
    int32_t p, i, begin, end = 0;
    dual->start[0] = 0;
    for (p = 0; p < mesh->polyline_count; ++p) {
        bool whole = true;
        begin = end;
        for (i = mesh->polyline_start[p]; i < mesh->polyline_start[p + 1]; ++i) {
            int32_t v = dual->vertex[mesh->polyline_vertex[i]];
            whole = whole && v >= 0;
            dual->polyline[end++] = v;
        }
        if (whole)
            dual->start[++dual->polyline_count] = end;
        else
            end = begin;
    }
}

GPROJI_INTERNAL gproj_code gproji_dual_build(const gproj_mesh *mesh, gproji_dual *dual, int32_t *vertex_face,
                                             gproji_mesh_object *made, gproj_error *error) {
    gproj_code code = gproji_check_dual(mesh, dual, error);
    int32_t v;
    if (code) return code;
    gproji_dual_vertices_of(mesh, dual);
    for (v = 0; v < mesh->vertex_count; ++v) {
        bool isolated = mesh->vertex_halfedge[v] < 0;
        if (vertex_face) vertex_face[v] = isolated ? -1 : dual->soup.face_count;
        if (!isolated) gproji_dual_face(mesh, dual, v);
    }
    gproji_dual_polylines(mesh, dual);
    dual->soup.position = dual->position;
    dual->soup.face_degree = dual->degree;
    dual->soup.face_vertex = dual->corner;
    code = gproji_mesh_build(made, &dual->soup, error);
    return code ? code : gproji_mesh_set_polylines(made, dual->polyline_count, dual->start, dual->polyline, error);
}

GPROJ_API gproj_mesh *gproj_mesh_dual(const gproj_mesh *mesh, int32_t *vertex_face, const gproj_host *host,
                                      gproj_error *error) {
    gproji_mesh_object *made;
    gproji_dual dual;
    gproji_pool pool;
    gproj_code code;
    gproji_error_clear(error);
    if (!mesh) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "the mesh is NULL");
        return NULL;
    }
    made = gproji_mesh_begin(host, error);
    if (!made) return NULL;
    gproji_pool_start(&pool, &made->heap);
    code = gproji_dual_take(&pool, mesh, &dual) ? gproji_dual_build(mesh, &dual, vertex_face, made, error)
                                                : gproji_fail_memory(error);
    gproji_pool_give_all(&pool);
    return gproji_mesh_done(made, code);
}

/* ============================================================================================================
   >>measure   What a mesh is like: planarity, folds, deviation, statistics. Uses platform, vector, mesh.

   The least-squares plane of a face is the plane through the mean of its vertices that is orthogonal to the direction
   in which they scatter least; eigenvectors by Jacobi's method (1846). */

/* Rotates rows and columns p, q of the symmetric matrix m so that m[p][q] = 0, and the columns of v along. */
GPROJI_INTERNAL void gproji_jacobi_rotate(double m[3][3], double v[3][3], int32_t p, int32_t q) {
    double theta, t, c, s;
    int32_t k;
    if (m[p][q] == 0) return;
    theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
    t = (theta < 0 ? -1.0 : 1.0) / (fabs(theta) + sqrt(theta * theta + 1));
    c = 1 / sqrt(t * t + 1);
    s = t * c;
    for (k = 0; k < 3; ++k) {
        double kp = m[k][p], kq = m[k][q];
        m[k][p] = c * kp - s * kq;
        m[k][q] = s * kp + c * kq;
    }
    for (k = 0; k < 3; ++k) {
        double pk = m[p][k], qk = m[q][k];
        m[p][k] = c * pk - s * qk;
        m[q][k] = s * pk + c * qk;
    }
    for (k = 0; k < 3; ++k) {
        double kp = v[k][p], kq = v[k][q];
        v[k][p] = c * kp - s * kq;
        v[k][q] = s * kp + c * kq;
    }
}

/* The unit eigenvector of the largest eigenvalue of a symmetric 3x3 matrix (destroyed). */
GPROJI_INTERNAL void gproji_largest_eigenvector3(double m[3][3], double out[3]) {
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    int32_t sweep, largest = 0, k;
    for (sweep = 0; sweep < 12; ++sweep) {
        gproji_jacobi_rotate(m, v, 0, 1);
        gproji_jacobi_rotate(m, v, 0, 2);
        gproji_jacobi_rotate(m, v, 1, 2);
    }
    for (k = 1; k < 3; ++k)
        if (m[k][k] > m[largest][largest]) largest = k;
    for (k = 0; k < 3; ++k) out[k] = v[k][largest];
}

GPROJI_INTERNAL const double *gproji_corner_position(const gproj_mesh *mesh, int32_t halfedge) {
    return mesh->position + 3 * (size_t)mesh->origin[halfedge];
}

GPROJI_INTERNAL void gproji_face_mean(const gproj_mesh *mesh, int32_t face, double mean[3]) {
    int32_t h = mesh->face_halfedge[face], k;
    gproji_set3(0, 0, 0, mean);
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h])
        gproji_add_scaled3(1.0 / mesh->face_degree[face], gproji_corner_position(mesh, h), mean);
}

/* The least-squares plane of a face: the mean of its vertices and a unit normal. Its directions are found one after the
   other, the longest first and then, from the points without their part along it, the one across: so a narrow face has
   its normal to rounding, too, where the eigenvectors of its scatter matrix would have half the digits. */
GPROJI_INTERNAL void gproji_face_plane(const gproj_mesh *mesh, int32_t face, double mean[3], double normal[3]) {
    double scatter[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, d[3], along[3], u[3], v[3], uu = 0, uv = 0, vv = 0, angle;
    int32_t h = mesh->face_halfedge[face], degree = mesh->face_degree[face], k, i, j;
    gproji_face_mean(mesh, face, mean);
    for (k = 0; k < degree; ++k, h = mesh->next[h]) {
        gproji_sub3(gproji_corner_position(mesh, h), mean, d);
        for (i = 0; i < 3; ++i)
            for (j = 0; j < 3; ++j) scatter[i][j] += d[i] * d[j];
    }
    gproji_largest_eigenvector3(scatter, along);
    gproji_tangents3(along, u, v);
    for (k = 0; k < degree; ++k, h = mesh->next[h]) {
        gproji_sub3(gproji_corner_position(mesh, h), mean, d);
        uu += gproji_dot3(d, u) * gproji_dot3(d, u);
        uv += gproji_dot3(d, u) * gproji_dot3(d, v);
        vv += gproji_dot3(d, v) * gproji_dot3(d, v);
    }
    angle = 0.5 * atan2(2 * uv, uu - vv); /* of the direction across, in the basis u, v */
    for (k = 0; k < 3; ++k) normal[k] = cos(angle) * v[k] - sin(angle) * u[k];
}

/* The largest distance of a face's vertices from its least-squares plane, in the mesh's units. */
GPROJI_INTERNAL double gproji_face_planarity(const gproj_mesh *mesh, int32_t face, const double mean[3],
                                             const double normal[3]) {
    double d[3], worst = 0;
    int32_t h = mesh->face_halfedge[face], k;
    for (k = 0; mesh->face_degree[face] > 3 && k < mesh->face_degree[face]; ++k, h = mesh->next[h]) {
        gproji_sub3(gproji_corner_position(mesh, h), mean, d);
        worst = gproji_fmax(worst, fabs(gproji_dot3(normal, d)));
    }
    return worst;
}

/* The point in the plane of a face that is, in the least-squares sense, on the perpendicular bisectors of all its
   edges: with d = c - mean, sum e e'd = sum e e'(midpoint - mean) over the edges e, in the plane's coordinates. False
   where the face has no such point (its edges are parallel). */
GPROJI_INTERNAL bool gproji_circumcentre(const gproj_mesh *mesh, const double *position, int32_t face,
                                         const double mean[3], const double normal[3], double out[3]) {
    double u[3], v[3], e[3], m[3], uu = 0, uv = 0, vv = 0, bu = 0, bv = 0, determinant, along, eu, ev;
    int32_t h = mesh->face_halfedge[face], k, i;
    gproji_tangents3(normal, u, v);
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h]) {
        const double *a = position + 3 * (size_t)mesh->origin[h],
                     *b = position + 3 * (size_t)mesh->origin[mesh->next[h]];
        gproji_sub3(b, a, e);
        for (i = 0; i < 3; ++i) m[i] = (a[i] + b[i]) / 2 - mean[i];
        eu = gproji_dot3(e, u);
        ev = gproji_dot3(e, v);
        along = eu * gproji_dot3(m, u) + ev * gproji_dot3(m, v);
        uu += eu * eu, uv += eu * ev, vv += ev * ev;
        bu += eu * along, bv += ev * along;
    }
    gproji_copy3(mean, out);
    determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12 * (uu + vv) * (uu + vv))) return false;
    gproji_add_scaled3((bu * vv - bv * uv) / determinant, u, out);
    gproji_add_scaled3((bv * uu - bu * uv) / determinant, v, out);
    return true;
}

/* The largest difference of the distances of a face's vertices from its circumcentre; infinite without one. */
GPROJI_INTERNAL double gproji_face_circularity(const gproj_mesh *mesh, int32_t face, const double mean[3],
                                               const double normal[3]) {
    double centre[3], least = HUGE_VAL, most = 0;
    int32_t h = mesh->face_halfedge[face], k;
    if (mesh->face_degree[face] == 3) return 0;
    if (!gproji_circumcentre(mesh, mesh->position, face, mean, normal, centre)) return HUGE_VAL;
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h]) {
        double distance = gproji_distance3(gproji_corner_position(mesh, h), centre);
        least = gproji_fmin(least, distance);
        most = gproji_fmax(most, distance);
    }
    return most - least;
}

/* The unit normal of a face with other positions, along its vectorial area; 0 where that is 0. */
GPROJI_INTERNAL void gproji_unit_normal(const gproj_mesh *mesh, const double *position, int32_t face, double out[3]) {
    static const double none[3] = {0, 0, 0};
    gproji_area_vector(mesh, position, face, out);
    gproji_normalise3(out, none);
}

/* The bisecting plane of the two faces at a half-edge: its unit normal b is along e x (n_f + n_g), e the unit vector of
   the edge, n the unit normals. False at the boundary. */
GPROJI_INTERNAL bool gproji_bisecting_plane(const gproj_mesh *mesh, const double *position, int32_t halfedge,
                                            double b[3]) {
    static const double none[3] = {0, 0, 0};
    double e[3], other[3];
    if (mesh->face[halfedge] < 0 || mesh->face[halfedge ^ 1] < 0) return false;
    gproji_sub3(position + 3 * (size_t)mesh->origin[halfedge ^ 1], position + 3 * (size_t)mesh->origin[halfedge], e);
    gproji_normalise3(e, none);
    gproji_unit_normal(mesh, position, mesh->face[halfedge], b);
    gproji_unit_normal(mesh, position, mesh->face[halfedge ^ 1], other);
    gproji_add_scaled3(1, other, b);
    gproji_cross3(e, b, b);
    gproji_normalise3(b, none);
    return true;
}

/* The mean unit normal of the faces around a vertex; e_z where they have none. Returns the number of faces. */
GPROJI_INTERNAL int32_t gproji_mean_normal(const gproj_mesh *mesh, const double *position, int32_t vertex,
                                           double out[3]) {
    static const double up[3] = {0, 0, 1};
    int32_t start = mesh->vertex_halfedge[vertex], h = start, count = 0;
    double n[3];
    gproji_copy3(up, out);
    if (start < 0) return 0;
    gproji_set3(0, 0, 0, out);
    do {
        if (mesh->face[h] >= 0) {
            gproji_unit_normal(mesh, position, mesh->face[h], n);
            gproji_add_scaled3(1, n, out);
            ++count;
        }
        h = gproji_rotate(mesh, h);
    } while (h != start);
    gproji_normalise3(out, up);
    return count;
}

/* The axis of the cone that the planes around a vertex touch: it is in the bisecting planes of all edges. The unit
   vector along m + t with b'(m + t) = 0 for their normals b in the least-squares sense, m the mean normal, t orthogonal
   to it and, with fewer than two bisecting planes, as short as can be. Returns the number of faces. */
GPROJI_INTERNAL int32_t gproji_cone_axis(const gproj_mesh *mesh, const double *position, int32_t vertex,
                                         double axis[3]) {
    int32_t count = gproji_mean_normal(mesh, position, vertex, axis), start = mesh->vertex_halfedge[vertex], h = start;
    double b[3], u[3], v[3], uu = 0, uv = 0, vv = 0, um = 0, vm = 0, ridge, determinant, t[2];
    if (count < 3) return count;
    gproji_tangents3(axis, u, v);
    do {
        if (gproji_bisecting_plane(mesh, position, h, b)) {
            double bu = gproji_dot3(b, u), bv = gproji_dot3(b, v), bm = gproji_dot3(b, axis);
            uu += bu * bu, uv += bu * bv, vv += bv * bv;
            um -= bu * bm, vm -= bv * bm;
        }
        h = gproji_rotate(mesh, h);
    } while (h != start);
    ridge = 1e-14 * (uu + vv);
    uu += ridge, vv += ridge;
    determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return count;
    t[0] = (um * vv - vm * uv) / determinant;
    t[1] = (vm * uu - um * uv) / determinant;
    gproji_add_scaled3(t[0], u, axis);
    gproji_add_scaled3(t[1], v, axis);
    gproji_normalise3(axis, axis);
    return count;
}

/* The largest difference of the angles between the normals of the faces around a vertex and their best axis; 0 where
   fewer than four meet. */
GPROJI_INTERNAL double gproji_vertex_conicality(const gproj_mesh *mesh, int32_t vertex) {
    double axis[3], n[3], cross[3], least = HUGE_VAL, most = 0;
    int32_t start = mesh->vertex_halfedge[vertex], h = start;
    if (gproji_cone_axis(mesh, mesh->position, vertex, axis) < 4) return 0;
    do {
        if (mesh->face[h] >= 0) {
            double angle;
            gproji_unit_normal(mesh, mesh->position, mesh->face[h], n);
            gproji_cross3(n, axis, cross);
            angle = atan2(gproji_length3(cross), gproji_dot3(n, axis));
            least = gproji_fmin(least, angle);
            most = gproji_fmax(most, angle);
        }
        h = gproji_rotate(mesh, h);
    } while (h != start);
    return most - least;
}

/* The distance of the two lines through the diagonals of a quad, in the mesh's units: the volume of the diagonals and
   the vector that joins them over the area they span. */
GPROJI_INTERNAL double gproji_diagonal_distance(const gproj_mesh *mesh, int32_t face) {
    int32_t a = mesh->face_halfedge[face], b = mesh->next[a], c = mesh->next[b], d = mesh->next[c];
    double first[3], second[3], joining[3], normal[3], length;
    gproji_sub3(gproji_corner_position(mesh, c), gproji_corner_position(mesh, a), first);
    gproji_sub3(gproji_corner_position(mesh, d), gproji_corner_position(mesh, b), second);
    gproji_sub3(gproji_corner_position(mesh, b), gproji_corner_position(mesh, a), joining);
    gproji_cross3(first, second, normal);
    length = gproji_length3(normal);
    return length > 0 ? fabs(gproji_dot3(normal, joining)) / length : 0;
}

/* Twice the signed area of the triangle a b c seen along `axis`. */
GPROJI_INTERNAL double gproji_seen_area(const double a[3], const double b[3], const double c[3], const double axis[3]) {
    double u[3], v[3], n[3];
    gproji_sub3(b, a, u);
    gproji_sub3(c, a, v);
    gproji_cross3(u, v, n);
    return gproji_dot3(n, axis);
}

/* Are a and b of different signs, both clear of rounding? */
GPROJI_INTERNAL bool gproji_are_opposite(double a, double b, double rounding) {
    return (a > rounding && b < -rounding) || (a < -rounding && b > rounding);
}

/* Do the segments of half-edges g and h cross properly, seen along the unit vector `axis`? */
GPROJI_INTERNAL bool gproji_sides_cross(const gproj_mesh *mesh, int32_t g, int32_t h, const double axis[3]) {
    const double *a = gproji_corner_position(mesh, g), *b = gproji_corner_position(mesh, mesh->next[g]);
    const double *c = gproji_corner_position(mesh, h), *d = gproji_corner_position(mesh, mesh->next[h]);
    double rounding = 1e-12 * gproji_distance3(a, b) * gproji_distance3(c, d);
    return gproji_are_opposite(gproji_seen_area(a, b, c, axis), gproji_seen_area(a, b, d, axis), rounding) &&
           gproji_are_opposite(gproji_seen_area(c, d, a, axis), gproji_seen_area(c, d, b, axis), rounding);
}

/* Does a side of the face cross another, seen along the normal of its least-squares plane? Its vectorial area would not
   do: a symmetric bow-tie has none. */
GPROJI_INTERNAL bool gproji_is_bow_tie(const gproj_mesh *mesh, int32_t face, const double axis[3]) {
    int32_t degree = mesh->face_degree[face], g = mesh->face_halfedge[face], h, i, j;
    for (i = 0; i + 2 < degree; ++i, g = mesh->next[g]) {
        h = mesh->next[mesh->next[g]];
        for (j = i + 2; j < degree; ++j, h = mesh->next[h])
            if (mesh->next[h] != g && gproji_sides_cross(mesh, g, h, axis)) return true;
    }
    return false;
}

/* Do the normals of an edge's two faces make more than 120 degrees? */
GPROJI_INTERNAL bool gproji_is_folded(const gproj_mesh *mesh, int32_t edge) {
    static const double none[3] = {0, 0, 0};
    int32_t left = mesh->face[2 * edge], right = mesh->face[2 * edge + 1];
    double a[3], b[3];
    if (left < 0 || right < 0) return false;
    gproji_area_vector(mesh, mesh->position, left, a);
    gproji_area_vector(mesh, mesh->position, right, b);
    return gproji_normalise3(a, none) && gproji_normalise3(b, none) && gproji_dot3(a, b) < -0.5;
}

GPROJI_INTERNAL void gproji_measure_edges(const gproj_mesh *mesh, gproj_measures *m) {
    int32_t e;
    m->mean_edge = gproji_mean_edge(mesh, mesh->position);
    for (e = 0; e < mesh->edge_count; ++e) {
        double length = gproji_distance3(gproji_corner_position(mesh, 2 * e), gproji_corner_position(mesh, 2 * e + 1));
        if (e == 0 || length < m->min_edge) m->min_edge = length;
        if (length > m->max_edge) m->max_edge = length;
        m->length += length;
        m->collapsed_edges += length <= 1e-6 * m->mean_edge;
        m->folded_edges += gproji_is_folded(mesh, e);
    }
}

GPROJI_INTERNAL void gproji_measure_faces(const gproj_mesh *mesh, double *planarity, gproj_measures *m) {
    double unit = m->mean_edge > 0 ? m->mean_edge : 1, squares = 0, mean_area;
    int32_t f;
    m->planarity_face = mesh->face_count ? 0 : -1;
    for (f = 0; f < mesh->face_count; ++f) {
        double area_vector[3], mean[3], normal[3], area, flatness;
        gproji_area_vector(mesh, mesh->position, f, area_vector);
        gproji_face_plane(mesh, f, mean, normal);
        flatness = gproji_face_planarity(mesh, f, mean, normal) / unit;
        area = gproji_length3(area_vector);
        m->area += area;
        squares += area * area;
        m->circularity_max = gproji_fmax(m->circularity_max, gproji_face_circularity(mesh, f, mean, normal) / unit);
        if (f == 0 || area < m->min_face_area) m->min_face_area = area;
        if (area > m->max_face_area) m->max_face_area = area;
        m->degenerate_faces += area < 1e-12 * unit * unit;
        m->bow_tie_faces += gproji_is_bow_tie(mesh, f, normal);
        m->planarity_mean += flatness / mesh->face_count;
        if (flatness > m->planarity_max) {
            m->planarity_max = flatness;
            m->planarity_face = f;
        }
        if (mesh->face_degree[f] == 4)
            m->diagonal_max = gproji_fmax(m->diagonal_max, gproji_diagonal_distance(mesh, f) / unit);
        if (planarity) planarity[f] = flatness;
    }
    mean_area = mesh->face_count ? m->area / mesh->face_count : 0;
    if (mean_area > 0)
        m->area_spread = sqrt(gproji_fmax(0, squares / mesh->face_count - mean_area * mean_area)) / mean_area;
}

/* The area of the spherical polygon of the normals around an interior vertex, as a fan of plane triangles about their
   mean; 0 at the boundary. */
GPROJI_INTERNAL double gproji_gauss_area(const gproj_mesh *mesh, int32_t vertex) {
    int32_t start = mesh->vertex_halfedge[vertex], h = start, count = 0;
    double mean[3] = {0, 0, 0}, previous[3], n[3], a[3], b[3], area[3], sum = 0;
    static const double none[3] = {0, 0, 0};
    if (start < 0 || mesh->face[start] < 0) return 0;
    do {
        gproji_area_vector(mesh, mesh->position, mesh->face[h], previous);
        gproji_normalise3(previous, none);
        gproji_add_scaled3(1, previous, mean);
        count++;
        h = mesh->twin[mesh->prev[h]];
    } while (h != start);
    mean[0] /= count, mean[1] /= count, mean[2] /= count;
    do { /* `previous` begins as the normal of the last face */
        gproji_area_vector(mesh, mesh->position, mesh->face[h], n);
        gproji_normalise3(n, none);
        gproji_sub3(previous, mean, a);
        gproji_sub3(n, mean, b);
        gproji_cross3(a, b, area);
        sum += 0.5 * gproji_length3(area);
        gproji_copy3(n, previous);
        h = mesh->twin[mesh->prev[h]];
    } while (h != start);
    return sum;
}

/* The volume of one triangle of the mesh: a closed mesh, the tetrahedron with the origin, det(a, b, c) / 6; else the
   prism over the plane z = -height, its area seen from above times its mean height. With `gradient` (9 numbers: of a,
   b, c) the derivatives times `scale` are added to it. */
GPROJI_INTERNAL double gproji_triangle_volume(const double *const corner[3], bool closed, double height, double scale,
                                              double *const gradient[3]) {
    double cross[3], seen, mean;
    int32_t k;
    if (closed) {
        for (k = 0; gradient && k < 3; ++k) {
            gproji_cross3(corner[(k + 1) % 3], corner[(k + 2) % 3], cross);
            gproji_add_scaled3(scale / 6, cross, gradient[k]);
        }
        gproji_cross3(corner[1], corner[2], cross);
        return gproji_dot3(corner[0], cross) / 6;
    }
    seen = 0;
    mean = height + (corner[0][2] + corner[1][2] + corner[2][2]) / 3;
    for (k = 0; k < 3; ++k) {
        const double *a = corner[k], *b = corner[(k + 1) % 3], *c = corner[(k + 2) % 3];
        seen += (a[0] * b[1] - a[1] * b[0]) / 2;
        if (!gradient) continue;
        gradient[k][0] += scale * mean * (b[1] - c[1]) / 2;
        gradient[k][1] += scale * mean * (c[0] - b[0]) / 2;
    }
    for (k = 0; gradient && k < 3; ++k) gradient[k][2] += scale * seen / 3;
    return seen * mean;
}

/* The volume of a mesh with other positions (see gproj_add_volume), the plane at z = -height; adds `scale` times its
   derivatives to `gradient`, 3 numbers a vertex, unless that is NULL. */
GPROJI_INTERNAL double gproji_volume(const gproj_mesh *mesh, const double *position, double height, double scale,
                                     double *gradient) {
    bool closed = mesh->loop_count == 0;
    double sum = 0, *slope[3];
    const double *corner[3];
    int32_t f, k, h;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t start = mesh->face_halfedge[f];
        for (h = mesh->next[start]; mesh->next[h] != start; h = mesh->next[h]) {
            size_t vertex[3];
            vertex[0] = (size_t)mesh->origin[start];
            vertex[1] = (size_t)mesh->origin[h];
            vertex[2] = (size_t)mesh->origin[mesh->next[h]];
            for (k = 0; k < 3; ++k) {
                corner[k] = position + 3 * vertex[k];
                slope[k] = gradient ? gradient + 3 * vertex[k] : NULL;
            }
            sum += gproji_triangle_volume(corner, closed, height, scale, gradient ? slope : NULL);
        }
    }
    return sum;
}

GPROJ_API double gproj_volume(const gproj_mesh *mesh) {
    return mesh ? gproji_volume(mesh, mesh->position, 0, 1, NULL) : 0;
}

GPROJI_INTERNAL double gproji_box_diagonal(const double *position, int32_t count) {
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    int32_t v, k;
    for (v = 0; v < count; ++v) {
        for (k = 0; k < 3; ++k) {
            double x = position[3 * (size_t)v + (size_t)k];
            if (v == 0 || x < low[k]) low[k] = x;
            if (v == 0 || x > high[k]) high[k] = x;
        }
    }
    return gproji_distance3(low, high);
}

GPROJI_INTERNAL void gproji_measure_change(const gproj_mesh *mesh, const double *original, gproj_measures *m) {
    double diagonal = gproji_box_diagonal(original, mesh->vertex_count), edge = gproji_mean_edge(mesh, original);
    double sum = 0, squares = 0, before[3], now[3];
    int32_t v, f;
    if (!(diagonal > 0)) diagonal = 1;
    if (!(edge > 0)) edge = 1;
    for (v = 0; v < mesh->vertex_count; ++v) {
        double d = gproji_distance3(mesh->position + 3 * (size_t)v, original + 3 * (size_t)v);
        sum += d;
        squares += d * d;
        m->deviation_max = gproji_fmax(m->deviation_max, d / diagonal);
    }
    if (mesh->vertex_count) {
        m->deviation_rms = sqrt(squares / mesh->vertex_count) / diagonal;
        m->displacement_mean = sum / mesh->vertex_count / edge;
    }
    for (f = 0; f < mesh->face_count; ++f) {
        gproji_area_vector(mesh, original, f, before);
        gproji_area_vector(mesh, mesh->position, f, now);
        m->turned_faces += gproji_dot3(before, now) < 0;
    }
}

GPROJ_API gproj_measures gproj_measure(const gproj_mesh *mesh, const double *original, double *planarity) {
    gproj_measures m;
    int32_t v;
    memset(&m, 0, sizeof m);
    m.planarity_face = -1;
    if (!mesh) return m;
    gproji_measure_edges(mesh, &m);
    gproji_measure_faces(mesh, planarity, &m);
    for (v = 0; v < mesh->vertex_count; ++v) {
        m.gauss_variation += gproji_gauss_area(mesh, v);
        m.conicality_max = gproji_fmax(m.conicality_max, gproji_vertex_conicality(mesh, v));
    }
    if (original) gproji_measure_change(mesh, original, &m);
    return m;
}

/* ============================================================================================================
   >>offset   Parallel meshes at constant distance, and what is between them. Uses platform, memory, error, vector, mesh,
   measure.

   Based on Pottmann, Liu, Wallner, Bobenko, Wang: Geometry of multi-layer freeform structures for architecture (2007),
   and Liu, Pottmann, Wallner, Yang, Wang: Geometric modeling with conical meshes and developable surfaces (2006).
   An offset is the mesh with vertices v + distance * x; a first part finds the field x, 3 numbers a vertex. */

/* -- the field of a vertex offset -- */

/* The work of gproji_vertex_field: all arrays 9 numbers or 1 entry a vertex. */
typedef struct gproji_mirrors {
    double *image;  /* 3x3, by rows: the product of reflections that leads from the first vertex of the component */
    int32_t *queue; /* the vertices of the component, in the order in which they are reached */
    bool *reached;
    int32_t first, last; /* the component's part of the queue */
} gproji_mirrors;

/* The unit vector of an edge from the origin of a half-edge; 0 without length. */
GPROJI_INTERNAL void gproji_edge_direction(const gproj_mesh *mesh, int32_t halfedge, double out[3]) {
    static const double none[3] = {0, 0, 0};
    gproji_sub3(gproji_corner_position(mesh, halfedge ^ 1), gproji_corner_position(mesh, halfedge), out);
    gproji_normalise3(out, none);
}

/* `out` = the 3x3 matrix `in`, mirrored in the plane orthogonal to the half-edge: (I - 2 e e') in. */
GPROJI_INTERNAL void gproji_mirror(const gproj_mesh *mesh, int32_t halfedge, const double in[9], double out[9]) {
    double e[3];
    int32_t i, j;
    gproji_edge_direction(mesh, halfedge, e);
    for (j = 0; j < 3; ++j) {
        double along = e[0] * in[j] + e[1] * in[3 + j] + e[2] * in[6 + j];
        for (i = 0; i < 3; ++i) out[3 * i + j] = in[3 * i + j] - 2 * along * e[i];
    }
}

/* Reaches the component of a vertex, breadth first. */
GPROJI_INTERNAL void gproji_reach(const gproj_mesh *mesh, int32_t vertex, gproji_mirrors *work) {
    double *image = work->image + 9 * (size_t)vertex;
    int32_t at;
    memset(image, 0, 9 * sizeof *image);
    image[0] = image[4] = image[8] = 1;
    work->first = work->last;
    work->queue[work->last++] = vertex;
    work->reached[vertex] = true;
    for (at = work->first; at < work->last; ++at) {
        int32_t start = mesh->vertex_halfedge[work->queue[at]], h = start;
        do {
            int32_t next = mesh->origin[h ^ 1];
            if (!work->reached[next]) {
                gproji_mirror(mesh, h, work->image + 9 * (size_t)work->queue[at], work->image + 9 * (size_t)next);
                work->reached[next] = true;
                work->queue[work->last++] = next;
            }
            h = gproji_rotate(mesh, h);
        } while (h != start);
    }
}

/* The mean of D'D over the edges of the component, D = image_j - mirror(image_i): m at the first vertex closes along an
   edge where D m = 0. And the sum of image'n over its vertices, n the unit normal there: m goes along it best. */
GPROJI_INTERNAL void gproji_closing(const gproj_mesh *mesh, const gproji_mirrors *work, double closing[3][3],
                                    double wanted[3]) {
    int32_t at, edges = 0, i, j, k;
    memset(closing, 0, 9 * sizeof closing[0][0]);
    gproji_set3(0, 0, 0, wanted);
    for (at = work->first; at < work->last; ++at) {
        int32_t vertex = work->queue[at], start = mesh->vertex_halfedge[vertex], h = start;
        const double *image = work->image + 9 * (size_t)vertex;
        double normal[3];
        gproji_mean_normal(mesh, mesh->position, vertex, normal);
        for (i = 0; i < 3; ++i) gproji_add_scaled3(normal[i], image + 3 * i, wanted);
        do {
            const double *other = work->image + 9 * (size_t)mesh->origin[h ^ 1];
            double d[9];
            gproji_mirror(mesh, h, image, d);
            for (i = 0; i < 9; ++i) d[i] = other[i] - d[i];
            for (i = 0; i < 3; ++i)
                for (j = 0; j < 3; ++j)
                    for (k = 0; k < 3; ++k) closing[i][j] += d[3 * k + i] * d[3 * k + j];
            ++edges;
            h = gproji_rotate(mesh, h);
        } while (h != start);
    }
    for (i = 0; i < 3; ++i)
        for (j = 0; j < 3; ++j) closing[i][j] /= edges;
}

/* The unit vector m for the first vertex: `wanted` without its parts in principal directions of `closing` (destroyed)
   in which the mesh does not close as well as it can; all of it where hardly half would be left. */
GPROJI_INTERNAL void gproji_best_start(double closing[3][3], const double wanted[3], double m[3]) {
    static const double up[3] = {0, 0, 1};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, least, column[3];
    int32_t sweep, k, best = 0;
    for (sweep = 0; sweep < 12; ++sweep) {
        gproji_jacobi_rotate(closing, v, 0, 1);
        gproji_jacobi_rotate(closing, v, 0, 2);
        gproji_jacobi_rotate(closing, v, 1, 2);
    }
    for (k = 1; k < 3; ++k)
        if (closing[k][k] < closing[best][best]) best = k;
    least = gproji_fmax(closing[best][best], 0);
    gproji_set3(0, 0, 0, m);
    for (k = 0; k < 3; ++k) {
        if (closing[k][k] > 10 * least + 1e-10) continue;
        gproji_set3(v[0][k], v[1][k], v[2][k], column);
        gproji_add_scaled3(gproji_dot3(column, wanted), column, m);
    }
    if (gproji_length3(m) < 0.5 * gproji_length3(wanted)) gproji_copy3(wanted, m);
    gproji_normalise3(m, up);
}

GPROJI_INTERNAL bool gproji_vertex_field(gproji_heap *heap, const gproj_mesh *mesh, double *x) {
    static const double none[3] = {0, 0, 0};
    size_t vertices = (size_t)mesh->vertex_count;
    gproji_mirrors work;
    int32_t v, at;
    work.first = work.last = 0;
    work.image = (double *)gproji_take(heap, 9 * vertices, sizeof *work.image);
    work.queue = (int32_t *)gproji_take(heap, vertices, sizeof *work.queue);
    work.reached = (bool *)gproji_take_zeroed(heap, vertices, sizeof *work.reached);
    for (v = 0; work.image && work.queue && work.reached && v < mesh->vertex_count; ++v) {
        double closing[3][3], wanted[3], m[3];
        if (work.reached[v] || mesh->vertex_halfedge[v] < 0) continue;
        gproji_reach(mesh, v, &work);
        gproji_closing(mesh, &work, closing, wanted);
        gproji_best_start(closing, wanted, m);
        for (at = work.first; at < work.last; ++at) {
            const double *image = work.image + 9 * (size_t)work.queue[at];
            double *out = x + 3 * (size_t)work.queue[at];
            gproji_set3(gproji_dot3(image, m), gproji_dot3(image + 3, m), gproji_dot3(image + 6, m), out);
            gproji_normalise3(out, none);
        }
    }
    gproji_give(heap, work.image, 9 * vertices, sizeof *work.image);
    gproji_give(heap, work.queue, vertices, sizeof *work.queue);
    gproji_give(heap, work.reached, vertices, sizeof *work.reached);
    return work.image && work.queue && work.reached;
}

/* -- the field of a face offset -- */

/* Conjugate gradients (Hestenes, Stiefel 1952) on normal equations, from x to the minimum that is nearest to it; in two
   stages. First sum (n_k'x_v - 1)^2 over the corners v of the faces k + sum |P (x_j - x_i)|^2 over the edges between
   two faces, P the projection across the edge: for a conical mesh the minimum is 0, and x is there already but for
   edges between faces that are nearly coplanar. Then sum |P (x_j - x_i)|^2 over the edges of the boundary, where x
   moves only as the distances of the faces allow: along the one edge between two faces, or in the plane of the only
   face. */
typedef struct gproji_parallels {
    const gproj_mesh *mesh;
    bool boundary;     /* the second stage */
    double *normal;    /* 3 a face, unit */
    double *direction; /* 3 an edge, unit */
    double *slope;     /* 3 a vertex: minus half the gradient at x */
    double *step;      /* 3 a vertex */
    double *image;     /* 3 a vertex: the matrix times the step */
} gproji_parallels;

enum {
    GPROJI_PARALLEL_ROUNDS = 2,
    GPROJI_PARALLEL_STEPS = 1000
};

/* out += n (n'x - distance) for the corners of the faces. */
GPROJI_INTERNAL void gproji_apply_distances(const gproji_parallels *p, const double *x, double distance, double *out) {
    const gproj_mesh *mesh = p->mesh;
    int32_t f, h, k;
    for (f = 0; f < mesh->face_count; ++f) {
        const double *n = p->normal + 3 * (size_t)f;
        h = mesh->face_halfedge[f];
        for (k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
            size_t v = 3 * (size_t)mesh->origin[h];
            gproji_add_scaled3(gproji_dot3(n, x + v) - distance, n, out + v);
        }
    }
}

/* What a vertex of the second stage cannot do is taken from `out`. */
GPROJI_INTERNAL void gproji_keep_distances(const gproji_parallels *p, double *out) {
    const gproj_mesh *mesh = p->mesh;
    int32_t v;
    for (v = 0; v < mesh->vertex_count; ++v, out += 3) {
        int32_t valence = gproj_mesh_valence(mesh, v), h;
        if (valence > 3 || !gproj_mesh_is_boundary_vertex(mesh, v)) {
            gproji_set3(0, 0, 0, out);
            continue;
        }
        h = gproji_rotate(mesh,
                          mesh->vertex_halfedge[v]); /* with the first face on its left; on its right the second */
        if (valence == 2) {
            const double *n = p->normal + 3 * (size_t)mesh->face[h];
            gproji_add_scaled3(-gproji_dot3(n, out), n, out);
        } else {
            const double *e = p->direction + 3 * (size_t)mesh->edge[gproji_rotate(mesh, h)];
            double along = gproji_dot3(e, out);
            gproji_set3(along * e[0], along * e[1], along * e[2], out);
        }
    }
}

/* out = A x - distance * b: A the matrix of the normal equations, b its right-hand side. */
GPROJI_INTERNAL void gproji_apply_parallels(const gproji_parallels *p, const double *x, double distance, double *out) {
    const gproj_mesh *mesh = p->mesh;
    int32_t e;
    memset(out, 0, 3 * (size_t)mesh->vertex_count * sizeof *out);
    if (!p->boundary) gproji_apply_distances(p, x, distance, out);
    for (e = 0; e < mesh->edge_count; ++e) {
        const double *direction = p->direction + 3 * (size_t)e;
        size_t i = 3 * (size_t)mesh->origin[2 * e], j = 3 * (size_t)mesh->origin[2 * e + 1];
        double d[3];
        if ((mesh->face[2 * e + 1] < 0) != p->boundary) continue; /* half-edge 2e always has a face */
        gproji_sub3(x + j, x + i, d);
        gproji_add_scaled3(-gproji_dot3(d, direction), direction, d);
        gproji_add_scaled3(1, d, out + j);
        gproji_add_scaled3(-1, d, out + i);
    }
    if (p->boundary) gproji_keep_distances(p, out);
}

/* One round, until the slope is a small part of what it was. */
GPROJI_INTERNAL void gproji_descend_parallels(gproji_parallels *p, double *x) {
    size_t count = 3 * (size_t)p->mesh->vertex_count, i;
    double square, before, start, curvature;
    int32_t n;
    gproji_apply_parallels(p, x, 1, p->slope);
    for (i = 0; i < count; ++i) p->step[i] = p->slope[i] = -p->slope[i];
    start = square = gproji_dot(p->slope, p->slope, count);
    for (n = 0; n < GPROJI_PARALLEL_STEPS && square > 1e-26 * start && square > 1e-30 * (double)count; ++n) {
        gproji_apply_parallels(p, p->step, 0, p->image);
        curvature = gproji_dot(p->step, p->image, count);
        if (!(curvature > 0)) return;
        for (i = 0; i < count; ++i) {
            x[i] += square / curvature * p->step[i];
            p->slope[i] -= square / curvature * p->image[i];
        }
        before = square;
        square = gproji_dot(p->slope, p->slope, count);
        for (i = 0; i < count; ++i) p->step[i] = p->slope[i] + square / before * p->step[i];
    }
}

/* Where it begins: each vertex for itself, x = a / cos(angle) with the axis a of its cone. */
GPROJI_INTERNAL void gproji_start_parallels(const gproji_parallels *p, double *x) {
    const gproj_mesh *mesh = p->mesh;
    int32_t v;
    for (v = 0; v < mesh->vertex_count; ++v) {
        int32_t start = mesh->vertex_halfedge[v], h = start, count;
        double axis[3], cosine = 0;
        gproji_set3(0, 0, 0, x + 3 * (size_t)v);
        count = gproji_cone_axis(mesh, mesh->position, v, axis);
        if (count == 0) continue;
        do {
            if (mesh->face[h] >= 0) cosine += gproji_dot3(p->normal + 3 * (size_t)mesh->face[h], axis) / count;
            h = gproji_rotate(mesh, h);
        } while (h != start);
        gproji_add_scaled3(1 / gproji_fmax(cosine, 0.01), axis, x + 3 * (size_t)v);
    }
}

GPROJI_INTERNAL bool gproji_face_field(gproji_heap *heap, const gproj_mesh *mesh, double *x) {
    size_t faces = 3 * (size_t)mesh->face_count, edges = 3 * (size_t)mesh->edge_count,
           count = 3 * (size_t)mesh->vertex_count;
    gproji_parallels p;
    bool taken;
    int32_t i;
    p.mesh = mesh;
    p.normal = (double *)gproji_take(heap, faces, sizeof *p.normal);
    p.direction = (double *)gproji_take(heap, edges, sizeof *p.direction);
    p.slope = (double *)gproji_take(heap, count, sizeof *p.slope);
    p.step = (double *)gproji_take(heap, count, sizeof *p.step);
    p.image = (double *)gproji_take(heap, count, sizeof *p.image);
    taken = p.normal && p.direction && p.slope && p.step && p.image;
    if (taken) {
        for (i = 0; i < mesh->face_count; ++i) gproji_unit_normal(mesh, mesh->position, i, p.normal + 3 * (size_t)i);
        for (i = 0; i < mesh->edge_count; ++i) gproji_edge_direction(mesh, 2 * i, p.direction + 3 * (size_t)i);
        gproji_start_parallels(&p, x);
        p.boundary = false;
        for (i = 0; i < GPROJI_PARALLEL_ROUNDS; ++i) gproji_descend_parallels(&p, x);
        p.boundary = true;
        for (i = 0; i < GPROJI_PARALLEL_ROUNDS; ++i) gproji_descend_parallels(&p, x);
    }
    gproji_give(heap, p.normal, faces, sizeof *p.normal);
    gproji_give(heap, p.direction, edges, sizeof *p.direction);
    gproji_give(heap, p.slope, count, sizeof *p.slope);
    gproji_give(heap, p.step, count, sizeof *p.step);
    gproji_give(heap, p.image, count, sizeof *p.image);
    return taken;
}

/* -- the meshes -- */

typedef bool (*gproji_field)(gproji_heap *heap, const gproj_mesh *mesh, double *x);

/* The mesh with vertices v + distance * x. */
GPROJI_INTERNAL gproj_mesh *gproji_offset(const gproj_mesh *mesh, double distance, gproji_field field,
                                          const gproj_host *host, gproj_error *error) {
    gproj_mesh *offset;
    gproji_heap *heap;
    gproj_code code;
    size_t count, i;
    double *x;
    gproji_error_clear(error);
    if (!mesh || !gproji_is_finite(distance)) {
        gproji_fail(error, mesh ? GPROJ_ERROR_NUMBER : GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    mesh ? "the distance of the offset is not a finite number" : "the mesh to offset is NULL");
        return NULL;
    }
    if (gproji_check_positions(mesh->vertex_count, mesh->position, "vertex", error)) return NULL;
    offset = gproj_mesh_copy(mesh, host, error);
    if (!offset) return NULL;
    heap = &gproji_mesh_owner(offset)->heap;
    count = 3 * (size_t)mesh->vertex_count;
    x = (double *)gproji_take_zeroed(heap, count, sizeof *x);
    code = x && field(heap, mesh, x) ? GPROJ_OK : gproji_fail_memory(error);
    for (i = 0; !code && i < count; ++i) offset->position[i] += distance * x[i];
    gproji_give(heap, x, count, sizeof *x);
    if (!code) code = gproji_check_positions(mesh->vertex_count, offset->position, "offset vertex", error);
    if (!code) return offset;
    gproj_mesh_destroy(offset);
    return NULL;
}

GPROJ_API gproj_mesh *gproj_mesh_vertex_offset(const gproj_mesh *mesh, double distance, const gproj_host *host,
                                               gproj_error *error) {
    return gproji_offset(mesh, distance, gproji_vertex_field, host, error);
}

GPROJ_API gproj_mesh *gproj_mesh_face_offset(const gproj_mesh *mesh, double distance, const gproj_host *host,
                                             gproj_error *error) {
    return gproji_offset(mesh, distance, gproji_face_field, host, error);
}

/* Do the two meshes have the same vertices, half-edges and faces, by their numbers? */
GPROJI_INTERNAL bool gproji_correspond(const gproj_mesh *a, const gproj_mesh *b) {
    size_t bytes;
    if (!a || !b || a->vertex_count != b->vertex_count || a->face_count != b->face_count ||
        a->halfedge_count != b->halfedge_count)
        return false;
    bytes = (size_t)a->halfedge_count * sizeof *a->origin;
    return memcmp(a->origin, b->origin, bytes) == 0 && memcmp(a->face, b->face, bytes) == 0;
}

/* The four corners of the panel of an edge: v_i v_j o_j o_i. */
GPROJI_INTERNAL void gproji_support_quad(const gproj_mesh *mesh, const gproj_mesh *offset, int32_t edge,
                                         double out[12]) {
    gproji_copy3(gproji_corner_position(mesh, 2 * edge), out);
    gproji_copy3(gproji_corner_position(mesh, 2 * edge + 1), out + 3);
    gproji_copy3(gproji_corner_position(offset, 2 * edge + 1), out + 6);
    gproji_copy3(gproji_corner_position(offset, 2 * edge), out + 9);
}

GPROJ_API gproj_mesh *gproj_mesh_support(const gproj_mesh *mesh, const gproj_mesh *offset, const gproj_host *host,
                                         gproj_error *error) {
    gproji_heap heap = gproji_heap_of(host);
    gproj_mesh *support = NULL;
    double *position;
    int32_t *degree, *corner, e;
    size_t edges;
    gproji_error_clear(error);
    if (!gproji_correspond(mesh, offset)) {
        gproji_fail(error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "a support structure is between a mesh and its offset: there are not two meshes of the same faces");
        return NULL;
    }
    if (mesh->edge_count > GPROJI_VERTICES_MAX / 4) {
        gproji_fail(error, GPROJ_ERROR_SIZE, GPROJ_PLACE_NONE, -1, "the support of %d edges has too many vertices",
                    mesh->edge_count);
        return NULL;
    }
    edges = (size_t)mesh->edge_count;
    position = (double *)gproji_take(&heap, 12 * edges, sizeof *position);
    degree = (int32_t *)gproji_take(&heap, edges, sizeof *degree);
    corner = (int32_t *)gproji_take(&heap, 4 * edges, sizeof *corner);
    if (position && degree && corner) {
        for (e = 0; e < mesh->edge_count; ++e) {
            gproji_support_quad(mesh, offset, e, position + 12 * (size_t)e);
            degree[e] = 4;
        }
        for (e = 0; e < 4 * mesh->edge_count; ++e) corner[e] = e;
        support = gproj_mesh_create(4 * mesh->edge_count, position, mesh->edge_count, degree, corner, host, error);
    } else {
        gproji_fail_memory(error);
    }
    gproji_give(&heap, position, 12 * edges, sizeof *position);
    gproji_give(&heap, degree, edges, sizeof *degree);
    gproji_give(&heap, corner, 4 * edges, sizeof *corner);
    return support;
}

/* -- how exact they are -- */

GPROJI_INTERNAL void gproji_widen(double value, double *least, double *most) {
    *least = gproji_fmin(*least, value);
    *most = gproji_fmax(*most, value);
}

/* How far the offset of an edge is from parallel, and its panel from planar: c = o_j - o_i without its part along the
   edge e, and the part of c along the normal e x (o_i - v_i) of the panel. */
GPROJI_INTERNAL void gproji_measure_edge_offset(const gproj_mesh *mesh, const gproj_mesh *offset, int32_t edge,
                                                double unit, gproj_offset_measures *m) {
    static const double none[3] = {0, 0, 0};
    double e[3], c[3], normal[3], along;
    gproji_edge_direction(mesh, 2 * edge, e);
    gproji_sub3(gproji_corner_position(offset, 2 * edge + 1), gproji_corner_position(offset, 2 * edge), c);
    along = gproji_dot3(e, c);
    m->reversed_edges += along < 0;
    gproji_add_scaled3(-along, e, c);
    m->parallel_max = gproji_fmax(m->parallel_max, gproji_length3(c) / unit);
    gproji_sub3(gproji_corner_position(offset, 2 * edge), gproji_corner_position(mesh, 2 * edge), normal);
    gproji_cross3(e, normal, normal);
    gproji_normalise3(normal, none);
    m->support_planarity_max = gproji_fmax(m->support_planarity_max, fabs(gproji_dot3(normal, c)) / unit);
}

GPROJ_API gproj_offset_measures gproj_measure_offset(const gproj_mesh *mesh, const gproj_mesh *offset) {
    gproj_offset_measures m;
    double unit, d[3], n[3];
    int32_t f, v, e, k, h;
    memset(&m, 0, sizeof m);
    m.face_distance_min = m.vertex_distance_min = HUGE_VAL;
    m.face_distance_max = -HUGE_VAL;
    if (!gproji_correspond(mesh, offset)) {
        m.face_distance_max = m.vertex_distance_max = m.parallel_max = m.support_planarity_max = HUGE_VAL;
        return m;
    }
    unit = gproji_mean_edge(mesh, mesh->position);
    if (!(unit > 0)) unit = 1;
    for (f = 0; f < mesh->face_count; ++f) {
        gproji_unit_normal(mesh, mesh->position, f, n);
        h = mesh->face_halfedge[f];
        for (k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
            gproji_sub3(gproji_corner_position(offset, h), gproji_corner_position(mesh, h), d);
            gproji_widen(gproji_dot3(n, d), &m.face_distance_min, &m.face_distance_max);
        }
    }
    for (v = 0; v < mesh->vertex_count; ++v)
        if (mesh->vertex_halfedge[v] >= 0)
            gproji_widen(gproji_distance3(offset->position + 3 * (size_t)v, mesh->position + 3 * (size_t)v),
                         &m.vertex_distance_min, &m.vertex_distance_max);
    for (e = 0; e < mesh->edge_count; ++e) gproji_measure_edge_offset(mesh, offset, e, unit, &m);
    return m;
}

/* ============================================================================================================
   >>fill   Filling a closed curve with quads. Uses platform, memory, error, vector, cholesky, mesh,
   text (growing arrays), hierarchy.

   A patch has 2 to 6 sides with given numbers of edges. Its combinatorics is built from inside to outside, by
   patterns in the manner of Takayama, Panozzo, Sorkine-Hornung (2014): a core, then strips along the sides. Where
   theirs is a table, our core is one family: a path of n nodes, 1 to 3 corners of the patch at each of its ends and
   one at each node between, on either side of the path. Edge j of the path stands for e_j >= 1 edges, and the path
   may be thickened to w rows of quads; a point with all corners is a path, too. A strip along side i adds 1 to the
   numbers of sides i - 1 and i + 1. So the numbers of edges l_i are linear in e_j, w and the numbers k_i >= 0 of
   strips:
       l_i = (edges of the core from corner i to corner i + 1) + k_(i-1) + k_(i+1).
   With all k_i >= 1 an end with 1, 2, 3 corners becomes a vertex of valence 3, 4, 5, and a node between of valence 5.
   For up to three e_j all solutions are tried. The path with one corner at each node and w rows has a solution for
   nearly all l; where a strip is missing or an end is bare, the patch is put into a ring of quads around its whole
   boundary, and the strip of quads in such a ring fills any even number of edges.

   Positions: patches are filled harmonically, then all inner vertices minimise the shape distortion of the corners of
   all quads with a regularisation that lets inverted corners turn back (Garanzha, Kaporin, Kudryavtseva, Protais,
   Ray, Sokolov 2021), by Newton steps with the convex part of the Hessian. */
enum {
    GPROJI_PATCH_SIDES = 6,
    GPROJI_PATH_EDGES = 5,
    GPROJI_CANDIDATES = 40,    /* more than there are kinds of patterns */
    GPROJI_TRIED_PAIRS = 120,  /* two e_j, or */
    GPROJI_TRIED_TRIPLES = 24, /* three are tried up to this */
    GPROJI_UNTANGLE_STEPS = 300,
    GPROJI_FILL_TRIES = 8,
    GPROJI_FILL_RINGS = 1 << 10,
    GPROJI_FILL_EDGES = 1 << 14, /* of the boundary, at most */
    GPROJI_QUAD_ENTRIES = 36     /* the lower triangle of a symmetric 8x8 matrix */
};

#define GPROJI_REFLEX 3.403392041388943 /* 195 degrees: corners beyond are cut */
#define GPROJI_FLAT 2.879793265790644   /* 165 degrees: corners beyond get two faces */
#define GPROJI_OBTUSE 2.356194490192345 /* 135 degrees: at the ends of a cut, corners below */
#define GPROJI_RIGHT 1.570796326794897

typedef struct gproji_pattern {
    int32_t sides;
    int32_t first;                     /* the pattern's corner 0 is the patch's corner `first` */
    int32_t end[2];                    /* corners at the ends of the path; a point: all at end 0 */
    int32_t edges;                     /* of the path; 0: a point. Nodes between are edges - 1 */
    int32_t below;                     /* bit j: the corner of node j + 1 is on the right of the path */
    int32_t edge[GPROJI_PATH_EDGES];   /* e_j */
    int32_t rows;                      /* w; > 0 only where no corner is on the right of the path */
    int32_t strip[GPROJI_PATCH_SIDES]; /* k_i */
    int32_t flat;                      /* bit i: corner i of the pattern gets two faces, see gproji_inner_lengths */
    bool ring;                         /* all corners get two faces: a ring of quads around the patch */
    bool bare;                         /* one strip of quads in a ring, whatever the sides are */
    double cost;
} gproji_pattern;

/* A patch under construction. Vertices and quads have local numbers. */
typedef struct gproji_patch {
    gproji_heap *heap;
    int32_t sides;
    int32_t edges[GPROJI_PATCH_SIDES]; /* edges now */
    int32_t *side[GPROJI_PATCH_SIDES]; /* length + 1 vertices: of the sides as they are now, both ends included */
    int32_t *block;                    /* memory of all sides */
    size_t block_size;
    gproji_ints quad; /* 4 vertices each */
    gproji_ints loop; /* the finished boundary from corner 0 of the pattern */
    gproji_ints uses; /* faces at each vertex */
    int32_t vertices;
} gproji_patch;

typedef struct gproji_filling {
    gproji_heap *heap;
    const gproj_host *host;
    gproj_error *error;
    gproj_fill_options options;
    int32_t count; /* of the points */
    const double *points;
    double *seen; /* 2 * count: the points in the plane */
    double normal[3], across[3], up[3];
    double edge_length; /* wanted */
    int32_t sides;
    gproji_ints corner;  /* points; sides of them */
    gproji_ints start;   /* sides + 1: the first vertex of each side */
    int32_t boundary;    /* vertices of the boundary */
    double *border;      /* 3 * boundary: their positions */
    gproji_ints polygon; /* patches, one after the other: 2 * vertex + (is it a corner of the patch) */
    gproji_ints patch;   /* ends of the patches in `polygon` */
    gproji_ints quad;    /* 4 vertices each */
    double *flat;        /* 2 * vertices, in the plane */
    size_t flat_capacity;
    int32_t vertices;
    int32_t curve_vertices; /* those of the boundary, and of rings along it, come first */
    int32_t cut_vertices;   /* then those of cuts */
    int32_t leaves;         /* patches that were filled */
} gproji_filling;

GPROJI_INTERNAL bool gproji_ints_add(gproji_heap *heap, gproji_ints *ints, int32_t value) {
    void *block = ints->data;
    if (ints->count >= INT32_MAX - 1) return false;
    if (!gproji_reserve(heap, &block, &ints->capacity, ints->count + 1, sizeof(int32_t))) return false;
    ints->data = (int32_t *)block;
    ints->data[ints->count++] = value;
    return true;
}

GPROJI_INTERNAL bool gproji_ints_add4(gproji_heap *heap, gproji_ints *ints, int32_t a, int32_t b, int32_t c,
                                      int32_t d) {
    return gproji_ints_add(heap, ints, a) && gproji_ints_add(heap, ints, b) && gproji_ints_add(heap, ints, c) &&
           gproji_ints_add(heap, ints, d);
}

/* -- patterns: their equations -- */

/* The length of the closed walk around the core, and where on it the corners are: from the first end down the rows,
   along the right of the path, up the rows, and back along its left. */
GPROJI_INTERNAL int32_t gproji_core_corners(const gproji_pattern *p, int32_t at[GPROJI_PATCH_SIDES]) {
    int32_t column[GPROJI_PATH_EDGES + 1], nodes = p->edges + 1, all, i, n = 0;
    column[0] = 0;
    for (i = 0; i < p->edges; ++i) column[i + 1] = column[i] + p->edge[i];
    all = column[nodes - 1];
    for (i = 0; i < p->end[0]; ++i) at[n++] = 0;
    for (i = 1; i + 1 < nodes; ++i)
        if (p->below >> (i - 1) & 1) at[n++] = p->rows + column[i];
    for (i = 0; i < p->end[1]; ++i) at[n++] = 2 * p->rows + all;
    for (i = nodes - 2; i > 0; --i)
        if (!(p->below >> (i - 1) & 1)) at[n++] = 2 * p->rows + 2 * all - column[i];
    return 2 * p->rows + 2 * all;
}

/* The core's vertex at a place of the walk. Vertices are numbered by rows, from below. */
GPROJI_INTERNAL int32_t gproji_core_vertex(int32_t rows, int32_t all, int32_t place) {
    int32_t around = 2 * (rows + all);
    if (around == 0) return 0;
    place %= around;
    if (place < rows) return (rows - place) * (all + 1);
    if (place <= rows + all) return place - rows;
    if (place <= 2 * rows + all) return (place - rows - all) * (all + 1) + all;
    return rows * (all + 1) + around - place;
}

/* The strips k with rest_i = k_(i-1) + k_(i+1): over the cycles of sides i, i + 2, .. False where there are none. */
GPROJI_INTERNAL bool gproji_find_strips(int32_t sides, const int32_t *rest, int32_t *strip) {
    int32_t first, i, n, length = sides % 2 ? sides : sides / 2, cycles = sides % 2 ? 1 : 2, value, start;
    for (first = 0; first < cycles; ++first) {
        for (value = 0, n = 0, i = first; n < length; ++n, i = (i + 2) % sides) value = rest[(i + 1) % sides] - value;
        /* once around, k_first becomes value - k_first (odd) or value + k_first (even) */
        if (length % 2 ? value % 2 != 0 : value != 0) return false;
        start = length % 2 ? value / 2 : rest[(first + 1) % sides] / 2;
        for (n = 0, i = first; n < length; ++n, i = (i + 2) % sides) {
            if (start < 0) return false;
            strip[i] = start;
            start = rest[(i + 1) % sides] - start;
        }
    }
    return true;
}

/* Irregular vertices count most, then the distances between them and from them to the boundary. */
GPROJI_INTERNAL double gproji_pattern_cost(const gproji_pattern *p) {
    double cost = 0;
    int32_t i;
    if (p->edges == 0)
        cost += 4 * (p->sides > 4 ? p->sides - 4 : 4 - p->sides) + (p->sides == 6 ? 8 : 0);
    else
        cost += 4 * ((p->end[0] != 2) + (p->end[1] != 2) + p->edges - 1);
    for (i = 0; i < p->sides; ++i) cost += p->strip[i] > 0 ? 1.0 / p->strip[i] : 3;
    for (i = 0; i < p->edges; ++i) cost += 1.0 / p->edge[i];
    return cost + (p->rows > 0 ? 1 : 0);
}

/* Candidates, at most one of each kind and rotation, in the order of their costs. */
typedef struct gproji_candidates {
    const int32_t *length; /* of the patch's sides */
    int32_t count;
    gproji_pattern pattern[GPROJI_CANDIDATES];
} gproji_candidates;

GPROJI_INTERNAL bool gproji_same_kind(const gproji_pattern *a, const gproji_pattern *b) {
    return a->first == b->first && a->end[0] == b->end[0] && a->edges == b->edges && a->below == b->below &&
           (a->rows > 0) == (b->rows > 0);
}

GPROJI_INTERNAL void gproji_offer(gproji_candidates *c, const gproji_pattern *p) {
    int32_t i;
    for (i = 0; i < c->count && !gproji_same_kind(&c->pattern[i], p); ++i) continue;
    if (i < c->count && c->pattern[i].cost <= p->cost) return;
    GPROJ_ASSERT(i < GPROJI_CANDIDATES);
    c->count += i == c->count;
    for (; i > 0 && c->pattern[i - 1].cost > p->cost; --i) c->pattern[i] = c->pattern[i - 1];
    c->pattern[i] = *p;
}

/* What the core leaves of the sides for the strips. False where it needs more than there is. */
GPROJI_INTERNAL bool gproji_rest(const gproji_candidates *c, const gproji_pattern *p, int32_t *rest) {
    int32_t at[GPROJI_PATCH_SIDES], around = gproji_core_corners(p, at), i;
    for (i = 0; i < p->sides; ++i) {
        int32_t to = i + 1 < p->sides ? at[i + 1] : at[0] + around;
        rest[i] = c->length[(i + p->first) % p->sides] - (to - at[i]);
        if (rest[i] < 0) return false;
    }
    return true;
}

/* All e_j of one kind of path without rows. */
GPROJI_INTERNAL void gproji_try_edges(gproji_candidates *c, gproji_pattern *p, int32_t most) {
    int32_t rest[GPROJI_PATCH_SIDES], i = 0;
    for (i = 0; i < p->edges; ++i) p->edge[i] = 1;
    do {
        if (gproji_rest(c, p, rest) && gproji_find_strips(p->sides, rest, p->strip)) {
            p->cost = gproji_pattern_cost(p);
            gproji_offer(c, p);
        }
        for (i = 0; i < p->edges && ++p->edge[i] > most; ++i) p->edge[i] = 1;
    } while (i < p->edges);
}

/* The path with a corner at each node and rows: sides 1, 2, .. have one e_j each, side 0 their sum and 2 w. So
   e_j = l - k - k, and w = (l_0 - l_1 - l_2 - ..) / 2 + the sum of the k_i but for i = 1 and n - 1 (with two sides:
   + k_0 - k_1). These strips grow evenly until w >= 0. */
GPROJI_INTERNAL bool gproji_try_rows(gproji_candidates *c, gproji_pattern *p, int32_t least) {
    int32_t n = p->sides, rest[GPROJI_PATCH_SIDES], i, best, side;
    p->end[0] = p->end[1] = 1;
    p->edges = n - 1;
    p->below = 0;
    p->rows = c->length[p->first];
    for (i = 1; i < n; ++i) p->rows -= c->length[(i + p->first) % n];
    p->rows /= 2;
    for (i = 0; i < n; ++i) {
        p->strip[i] = least;
        p->rows += i != 1 && i != n - 1 ? least : n == 2 ? -least : 0;
        rest[i] = c->length[(i + p->first) % n] - 2 * least;
        if (i > 0 && rest[i] < 1) return false;
    }
    while (p->rows < 0) {
        for (best = -1, i = 0; i < n; ++i) {
            int32_t before = (i + n - 1) % n, after = (i + 1) % n, least_rest = before == after ? 3 : 2;
            if (i == 1 || i == n - 1) continue;
            if ((before > 0 && rest[before] < least_rest) || (after > 0 && rest[after] < least_rest)) continue;
            if (best < 0 || p->strip[i] < p->strip[best]) best = i;
        }
        if (best < 0) return false;
        ++p->strip[best], ++p->rows;
        --rest[(best + n - 1) % n], --rest[(best + 1) % n];
    }
    for (side = 1; side < n; ++side) p->edge[n - 1 - side] = rest[side];
    p->cost = gproji_pattern_cost(p);
    gproji_offer(c, p);
    return true;
}

/* A path with equal ends, seen from its other end, is a path of the same kind: is that one tried instead? */
GPROJI_INTERNAL bool gproji_is_turned_kind(const gproji_pattern *p) {
    int32_t below = 0, first = p->first + p->end[0], j, nodes = p->edges - 1;
    for (j = 0; j < nodes; ++j) {
        bool right = (p->below >> j & 1) != 0;
        first += right;
        if (!right) below |= 1 << (nodes - 1 - j);
    }
    first %= p->sides;
    return p->end[0] == p->end[1] && (below < p->below || (below == p->below && first < p->first));
}

/* All kinds of patterns for a patch. */
GPROJI_INTERNAL void gproji_find_patterns(gproji_candidates *c, int32_t sides, const int32_t *length) {
    static const int32_t tried[4] = {0, INT32_MAX, GPROJI_TRIED_PAIRS, GPROJI_TRIED_TRIPLES};
    int32_t most = length[0], a, b, below, i;
    gproji_pattern p;
    memset(&p, 0, sizeof p);
    c->length = length;
    c->count = 0;
    for (i = 1; i < sides; ++i) most = gproji_max(most, length[i]);
    p.sides = sides;
    p.end[0] = sides;
    gproji_try_edges(c, &p, 0);
    if (sides == 4 && length[0] == length[2] && length[1] == length[3]) { /* a grid: a path along one side */
        p.end[0] = p.end[1] = 2, p.edges = 1, p.edge[0] = length[1], p.strip[1] = length[0];
        p.strip[0] = p.strip[2] = p.strip[3] = 0;
        p.cost = -1;
        gproji_offer(c, &p);
    }
    for (p.first = 0; p.first < sides; ++p.first) {
        for (a = 1; a <= 3; a += 2)
            for (b = a; b <= 3; b += 2) {
                p.edges = sides - a - b + 1;
                if (p.edges < 1 || p.edges > 3) continue;
                p.end[0] = a, p.end[1] = b, p.rows = 0;
                for (below = 0; below < 1 << (p.edges - 1); ++below) {
                    p.below = below;
                    if (gproji_is_turned_kind(&p)) continue;
                    gproji_try_edges(c, &p, gproji_min(most, tried[p.edges]));
                }
            }
        if (sides == 2 && length[p.first] < most) continue; /* seen from the other side it is of the same kind */
        if (!gproji_try_rows(c, &p, 1)) gproji_try_rows(c, &p, 0);
    }
}

/* -- patterns: their quads -- */

GPROJI_INTERNAL bool gproji_patch_take(gproji_patch *patch, gproji_heap *heap, int32_t sides, const int32_t *length) {
    size_t at = 0;
    int32_t i;
    memset(patch, 0, sizeof *patch);
    patch->heap = heap;
    patch->sides = sides;
    for (i = 0; i < sides; ++i) patch->block_size += (size_t)length[i] + 1;
    patch->block = (int32_t *)gproji_take(heap, patch->block_size, sizeof(int32_t));
    for (i = 0; patch->block && i < sides; ++i) {
        patch->side[i] = patch->block + at;
        at += (size_t)length[i] + 1;
    }
    return patch->block != NULL;
}

GPROJI_INTERNAL void gproji_patch_give(gproji_patch *patch) {
    gproji_give(patch->heap, patch->block, patch->block_size, sizeof(int32_t));
    gproji_ints_give(patch->heap, &patch->quad);
    gproji_ints_give(patch->heap, &patch->loop);
    gproji_ints_give(patch->heap, &patch->uses);
}

/* The core and its sides. */
GPROJI_INTERNAL bool gproji_build_core(gproji_patch *patch, const gproji_pattern *p, const int32_t *length) {
    int32_t at[GPROJI_PATCH_SIDES + 1], all = 0, i, j, rows = p->rows;
    for (i = 0; i < p->edges; ++i) all += p->edge[i];
    if (p->bare)
        for (at[0] = i = 0; i < p->sides; ++i) at[i + 1] = at[i] + length[(i + p->first) % p->sides];
    else
        at[p->sides] = gproji_core_corners(p, at) + at[0];
    for (i = 0; i < p->sides; ++i) {
        patch->edges[i] = at[i + 1] - at[i];
        for (j = 0; j <= patch->edges[i]; ++j) patch->side[i][j] = gproji_core_vertex(rows, all, at[i] + j);
    }
    patch->vertices = (rows + 1) * (all + 1);
    for (i = 0; i < rows; ++i)
        for (j = 0; j < all; ++j) {
            int32_t v = i * (all + 1) + j;
            if (!gproji_ints_add4(patch->heap, &patch->quad, v, v + 1, v + all + 2, v + all + 1)) return false;
        }
    return true;
}

GPROJI_INTERNAL bool gproji_is_flat(int32_t flat, int32_t sides, int32_t corner) { return flat >> corner % sides & 1; }

/* Does a strip run from corner i to the next corner that is not flat, over flat ones between? Sets that corner. */
GPROJI_INTERNAL bool gproji_has_long_strip(int32_t flat, int32_t sides, int32_t i, int32_t *to) {
    *to = i + 1;
    if (gproji_is_flat(flat, sides, i) || !gproji_is_flat(flat, sides, i + 1)) return false;
    while (gproji_is_flat(flat, sides, *to)) ++*to;
    return true;
}

/* The numbers of edges inside of the outermost strips, which cover the flat corners: each from one corner that is not
   flat to the next. False where there are not two such corners, or a side is too short. */
GPROJI_INTERNAL bool gproji_inner_lengths(int32_t sides, int32_t flat, const int32_t *length, int32_t *inner) {
    int32_t i, to, sharp = 0;
    for (i = 0; i < sides; ++i) inner[i] = length[i], sharp += !gproji_is_flat(flat, sides, i);
    if (sharp < 2) return false;
    for (i = 0; i < sides; ++i)
        if (gproji_has_long_strip(flat, sides, i, &to)) --inner[(i + sides - 1) % sides], --inner[to % sides];
    for (i = 0; i < sides; ++i)
        if (inner[i] < 1) return false;
    return true;
}

/* A strip of quads along sides i to to - 1 (numbers may go on beyond the last): new sides outside of them, and one edge
   more for both neighbours. */
GPROJI_INTERNAL bool gproji_add_strip(gproji_patch *patch, int32_t i, int32_t to) {
    int32_t before = (i + patch->sides - 1) % patch->sides, after = to % patch->sides, j, side;
    int32_t outer = patch->vertices;
    for (side = i; side < to; ++side) {
        int32_t *s = patch->side[side % patch->sides], n = patch->edges[side % patch->sides];
        for (j = 0; j < n; ++j)
            if (!gproji_ints_add4(patch->heap, &patch->quad, outer + j, outer + j + 1, s[j + 1], s[j])) return false;
        outer += n;
    }
    patch->side[before][++patch->edges[before]] = patch->vertices;
    memmove(patch->side[after] + 1, patch->side[after], (size_t)(++patch->edges[after]) * sizeof(int32_t));
    patch->side[after][0] = outer;
    for (side = i; side < to; ++side)
        for (j = 0, outer = patch->vertices; j <= patch->edges[side % patch->sides]; ++j) {
            patch->side[side % patch->sides][j] = outer + j;
            if (j == patch->edges[side % patch->sides]) patch->vertices = outer + j;
        }
    ++patch->vertices;
    return true;
}

/* The boundary as a loop, in a ring of quads if so wanted. */
GPROJI_INTERNAL bool gproji_close_patch(gproji_patch *patch, bool ring) {
    int32_t i, j, n;
    for (i = 0; i < patch->sides; ++i)
        for (j = 0; j < patch->edges[i]; ++j)
            if (!gproji_ints_add(patch->heap, &patch->loop, patch->side[i][j])) return false;
    n = (int32_t)patch->loop.count;
    for (i = 0; ring && i < n; ++i) {
        int32_t next = i + 1 < n ? i + 1 : 0, *loop = patch->loop.data, v = patch->vertices;
        if (!gproji_ints_add4(patch->heap, &patch->quad, v + i, v + next, loop[next], loop[i])) return false;
    }
    for (i = 0; ring && i < n; ++i) patch->loop.data[i] = patch->vertices++;
    return true;
}

GPROJI_INTERNAL bool gproji_build_patch(gproji_patch *patch, const gproji_pattern *p, const int32_t *length) {
    int32_t i, k;
    size_t q;
    if (!gproji_build_core(patch, p, length)) return false;
    for (i = 0; i < p->sides && !p->bare; ++i)
        for (k = 0; k < p->strip[i]; ++k)
            if (!gproji_add_strip(patch, i, i + 1)) return false;
    for (i = 0; i < p->sides && p->flat; ++i)
        if (gproji_has_long_strip(p->flat, p->sides, i, &k) && !gproji_add_strip(patch, i, k)) return false;
    if (!gproji_close_patch(patch, p->ring)) return false;
    for (i = 0; i < patch->vertices; ++i)
        if (!gproji_ints_add(patch->heap, &patch->uses, 0)) return false;
    for (q = 0; q < patch->quad.count; ++q) ++patch->uses.data[patch->quad.data[q]];
    return true;
}

/* -- the plane -- */

/* Twice the area of the triangle of points i, j, k of an array xy, positive when counter-clockwise. */
GPROJI_INTERNAL double gproji_turn2(const double *xy, int32_t i, int32_t j, int32_t k) {
    const double *p = xy + 2 * (size_t)i, *q = xy + 2 * (size_t)j, *r = xy + 2 * (size_t)k;
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

GPROJI_INTERNAL double gproji_distance2(const double *xy, int32_t i, int32_t j) {
    double x = xy[2 * (size_t)j] - xy[2 * (size_t)i], y = xy[2 * (size_t)j + 1] - xy[2 * (size_t)i + 1];
    return sqrt(x * x + y * y);
}

/* Do the segments a b and c d have a common point? */
GPROJI_INTERNAL bool gproji_segments_meet(const double *xy, int32_t a, int32_t b, int32_t c, int32_t d) {
    const double *p = xy + 2 * (size_t)a, *q = xy + 2 * (size_t)b, *r = xy + 2 * (size_t)c, *s = xy + 2 * (size_t)d;
    double abc, abd, cda, cdb;
    int32_t k;
    for (k = 0; k < 2; ++k)
        if (gproji_fmax(p[k], q[k]) < gproji_fmin(r[k], s[k]) || gproji_fmax(r[k], s[k]) < gproji_fmin(p[k], q[k]))
            return false;
    abc = gproji_turn2(xy, a, b, c), abd = gproji_turn2(xy, a, b, d);
    cda = gproji_turn2(xy, c, d, a), cdb = gproji_turn2(xy, c, d, b);
    return !((abc > 0 && abd > 0) || (abc < 0 && abd < 0) || (cda > 0 && cdb > 0) || (cda < 0 && cdb < 0));
}

/* Do the sides i, i + 1 and j, j + 1 of a closed polygon meet where they should not? Neighbours: do they fold back? */
GPROJI_INTERNAL bool gproji_polygon_meets(const double *xy, int32_t count, int32_t i, int32_t j) {
    int32_t b = (i + 1) % count, d = (j + 1) % count;
    if (b == j || d == i) {
        int32_t at = b == j ? b : i, from = b == j ? i : j, to = b == j ? d : b;
        const double *p = xy + 2 * (size_t)at, *q = xy + 2 * (size_t)from, *r = xy + 2 * (size_t)to;
        double along = (q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1]);
        return along >= 0 && fabs(gproji_turn2(xy, at, from, to)) <= 1e-12 * along;
    }
    return gproji_segments_meet(xy, i, b, j, d);
}

/* A closed polygon. */
typedef struct gproji_loop2 {
    const double *xy;
    int32_t count;
} gproji_loop2;

GPROJI_INTERNAL void gproji_loop_box(const void *user, int32_t item, double low[3], double high[3]) {
    const gproji_loop2 *loop = (const gproji_loop2 *)user;
    const double *p = loop->xy + 2 * (size_t)item, *q = loop->xy + 2 * (size_t)((item + 1) % loop->count);
    gproji_set3(gproji_fmin(p[0], q[0]), gproji_fmin(p[1], q[1]), 0, low);
    gproji_set3(gproji_fmax(p[0], q[0]), gproji_fmax(p[1], q[1]), 0, high);
}

/* The lowest side after side i that meets it; the number of sides where there is none. */
GPROJI_INTERNAL int32_t gproji_find_meeting(const gproji_loop2 *loop, const gproji_hierarchy *tree, int32_t i) {
    int32_t stack[GPROJI_TREE_DEPTH], depth = 1, found = loop->count, k;
    double low[3], high[3];
    gproji_loop_box(loop, i, low, high);
    stack[0] = 0;
    while (depth > 0) {
        int32_t at = stack[--depth];
        const gproji_node *node = &tree->node[at];
        if (node->low[0] > high[0] || node->high[0] < low[0] || node->low[1] > high[1] || node->high[1] < low[1])
            continue;
        if (node->right >= 0) {
            stack[depth++] = node->right;
            stack[depth++] = at + 1;
            continue;
        }
        for (k = node->begin; k < node->end; ++k) {
            int32_t j = tree->item[k];
            if (j > i && j < found && gproji_polygon_meets(loop->xy, loop->count, i, j)) found = j;
        }
    }
    return found;
}

/* The first two sides of a closed polygon that meet; first = count where it is simple. False: no memory. */
GPROJI_INTERNAL bool gproji_find_crossing(gproji_heap *heap, const double *xy, int32_t count, int32_t *first,
                                          int32_t *second) {
    gproji_hierarchy tree;
    gproji_loop2 loop;
    loop.xy = xy, loop.count = count;
    if (!gproji_hierarchy_build(heap, &tree, count, gproji_loop_box, &loop)) return false;
    for (*first = 0; *first < count; ++*first) {
        *second = gproji_find_meeting(&loop, &tree, *first);
        if (*second < count) break;
    }
    gproji_hierarchy_give(heap, &tree);
    return true;
}

/* The angle from the direction p q to the direction p r, counter-clockwise, 0 to 2 pi. */
GPROJI_INTERNAL double gproji_inner_angle(const double *xy, int32_t p, int32_t q, int32_t r) {
    const double *a = xy + 2 * (size_t)p, *b = xy + 2 * (size_t)q, *c = xy + 2 * (size_t)r;
    double u[2], v[2], angle;
    u[0] = b[0] - a[0], u[1] = b[1] - a[1], v[0] = c[0] - a[0], v[1] = c[1] - a[1];
    angle = atan2(u[0] * v[1] - u[1] * v[0], u[0] * v[0] + u[1] * v[1]);
    return angle < 0 ? angle + 6.283185307179586 : angle;
}

/* -- the curve -- */

/* The plane of the vectorial area, with which the curve runs counter-clockwise. Writes the points as seen there. */
GPROJI_INTERNAL gproj_code gproji_see_curve(gproji_filling *f) {
    static const double none[3] = {0, 0, 0};
    double a[3], b[3], cross[3], extent = 0;
    int32_t i;
    gproji_set3(0, 0, 0, f->normal);
    for (i = 1; i < f->count; ++i) {
        gproji_sub3(f->points + 3 * (size_t)i, f->points, a);
        extent = gproji_fmax(extent, gproji_dot3(a, a));
        if (i + 1 == f->count) break;
        gproji_sub3(f->points + 3 * (size_t)i + 3, f->points, b);
        gproji_cross3(a, b, cross);
        gproji_add_scaled3(0.5, cross, f->normal);
    }
    if (gproji_length3(f->normal) <= 1e-9 * extent || !gproji_normalise3(f->normal, none))
        return gproji_fail(f->error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_NONE, -1,
                           "the curve encloses no area; it must not run back along itself");
    gproji_tangents3(f->normal, f->across, f->up);
    for (i = 0; i < f->count; ++i) {
        gproji_sub3(f->points + 3 * (size_t)i, f->points, a);
        f->seen[2 * i] = gproji_dot3(a, f->across), f->seen[2 * i + 1] = gproji_dot3(a, f->up);
    }
    return GPROJ_OK;
}

GPROJI_INTERNAL gproj_code gproji_check_curve(gproji_filling *f) {
    gproj_code code;
    int32_t i, j;
    if (f->count < 3 || f->count > GPROJI_VERTICES_MAX || !f->points)
        return gproji_fail(f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                           f->points ? "a closed curve of %d points; it needs at least 3"
                                     : "the points of the curve are NULL",
                           f->count);
    code = gproji_check_positions(f->count, f->points, "point", f->error);
    if (code) return code;
    for (i = 0; i < f->count; ++i) {
        j = i + 1 < f->count ? i + 1 : 0;
        if (!(gproji_distance3(f->points + 3 * (size_t)i, f->points + 3 * (size_t)j) > 0))
            return gproji_fail(f->error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, i,
                               "points %d and %d of the curve are the same; leave one out%s", i, j,
                               j == 0 ? " (the curve is closed without it)" : "");
    }
    f->seen = (double *)gproji_take(f->heap, (size_t)f->count, 2 * sizeof(double));
    if (!f->seen) return gproji_fail_memory(f->error);
    code = gproji_see_curve(f);
    if (code) return code;
    if (!gproji_find_crossing(f->heap, f->seen, f->count, &i, &j)) return gproji_fail_memory(f->error);
    if (i == f->count) return GPROJ_OK;
    return gproji_fail(f->error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, i,
                       "the curve meets itself, as seen along its normal, after point %d and after point %d; only "
                       "simple curves can be filled",
                       i, j);
}

/* Does the curve turn by more than 45 degrees at a point (see gproj_form_is_corner)? */
GPROJI_INTERNAL bool gproji_turns(const gproji_filling *f, int32_t i) {
    static const double none[3] = {0, 0, 0};
    const double *p = f->points + 3 * (size_t)i;
    double in[3], out[3];
    gproji_sub3(p, f->points + 3 * (size_t)((i + f->count - 1) % f->count), in);
    gproji_sub3(f->points + 3 * (size_t)((i + 1) % f->count), p, out);
    gproji_normalise3(in, none);
    gproji_normalise3(out, none);
    return gproji_dot3(in, out) < 0.70710678118654752;
}

/* The length of the curve from point i to point j > i (modulo the number of points). */
GPROJI_INTERNAL double gproji_length_between(const gproji_filling *f, int32_t i, int32_t j) {
    double sum = 0;
    for (; i < j; ++i)
        sum += gproji_distance3(f->points + 3 * (size_t)(i % f->count), f->points + 3 * (size_t)((i + 1) % f->count));
    return sum;
}

/* Four corners at about equal distances, the first one where the only corner is, or the first point. */
GPROJI_INTERNAL bool gproji_make_corners(gproji_filling *f) {
    int32_t from = f->corner.count ? f->corner.data[0] : 0, n = 1, i;
    double all = gproji_length_between(f, from, from + f->count), at = 0;
    f->corner.count = 0;
    if (!gproji_ints_add(f->heap, &f->corner, from)) return false;
    for (i = from; i + 1 < from + f->count && n < 4; ++i) {
        double step = gproji_length_between(f, i, i + 1);
        at += step;
        if (at + step / 2 >= all * n / 4 || from + f->count - 2 - i < 4 - n) {
            if (!gproji_ints_add(f->heap, &f->corner, (i + 1) % f->count)) return false;
            ++n;
        }
    }
    return true;
}

GPROJI_INTERNAL gproj_code gproji_find_corners(gproji_filling *f) {
    const gproj_fill_options *o = &f->options;
    int32_t i;
    bool taken = true;
    if (o->corner_count < 0 || o->corner_count == 1 || (o->corner_count > 0 && !o->corners))
        return gproji_fail(f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                           "%d corners%s; give at least 2, or none to have them found", o->corner_count,
                           o->corner_count > 1 ? " in an array that is NULL" : "");
    if (o->rings < 0 || o->rings > GPROJI_FILL_RINGS)
        return gproji_fail(f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "%d rings; give 0 to %d", o->rings,
                           (int32_t)GPROJI_FILL_RINGS);
    if (o->variant < 0)
        return gproji_fail(f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "variant %d; the first is 0",
                           o->variant);
    for (i = 0; i < o->corner_count && taken; ++i) {
        int32_t c = o->corners[i], before = i > 0 ? o->corners[i - 1] : -1;
        if (c < 0 || c >= f->count)
            return gproji_fail(f->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_VERTEX, c,
                               "corner %d is point %d, but the points are 0 to %d", i, c, f->count - 1);
        if (c <= before)
            return gproji_fail(f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, c,
                               "corner %d is point %d, after point %d; list corners in ascending order, each once", i,
                               c, before);
        taken = gproji_ints_add(f->heap, &f->corner, c);
    }
    for (i = 0; i < f->count && o->corner_count == 0 && taken; ++i)
        if (gproji_turns(f, i)) taken = gproji_ints_add(f->heap, &f->corner, i);
    if (taken && f->corner.count < 2) taken = gproji_make_corners(f);
    f->sides = (int32_t)f->corner.count;
    if (taken && o->side_count != 0 && (o->side_count != f->sides || !o->subdivisions))
        return gproji_fail(f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                           "numbers of edges are given for %d sides%s, but the curve has %d", o->side_count,
                           o->subdivisions ? "" : " by a NULL array", f->sides);
    return taken ? GPROJ_OK : gproji_fail_memory(f->error);
}

/* The points of side j: from the first to the last, counted on beyond the end of the array. */
GPROJI_INTERNAL void gproji_side_points(const gproji_filling *f, int32_t side, int32_t *from, int32_t *to) {
    *from = f->corner.data[side];
    *to = side + 1 < f->sides ? f->corner.data[side + 1] : f->corner.data[0];
    if (*to <= *from) *to += f->count;
}

GPROJI_INTERNAL double gproji_side_length(const gproji_filling *f, int32_t side) {
    int32_t from, to;
    gproji_side_points(f, side, &from, &to);
    return gproji_length_between(f, from, to);
}

/* Which side bears one edge more (+1) or less (-1) best, by its edge length? */
GPROJI_INTERNAL int32_t gproji_best_change(const gproji_filling *f, const int32_t *edges, int32_t *change) {
    int32_t side, best = 0;
    double least = HUGE_VAL;
    for (side = 0; side < f->sides; ++side) {
        double wanted = gproji_side_length(f, side) / f->edge_length;
        int32_t by = edges[side] > 1 && wanted < edges[side] ? -1 : 1;
        double off = fabs(log((edges[side] + by) / wanted));
        if (off < least) least = off, best = side, *change = by;
    }
    return best;
}

/* The edges that strips over nearly flat corners take from the sides: see gproji_inner_lengths. */
GPROJI_INTERNAL void gproji_strip_edges(const gproji_filling *f, int32_t *taken) {
    int32_t side, flat = 0, many[GPROJI_PATCH_SIDES];
    for (side = 0; side < f->sides; ++side) {
        int32_t c = f->corner.data[side];
        bool is_flat = gproji_inner_angle(f->seen, c, (c + 1) % f->count, (c + f->count - 1) % f->count) > GPROJI_FLAT;
        if (is_flat) flat |= 1 << side;
        many[side] = 3; /* more than are taken */
    }
    if (!gproji_inner_lengths(f->sides, flat, many, taken)) memcpy(taken, many, sizeof many);
    for (side = 0; side < f->sides; ++side) taken[side] = many[side] - taken[side];
}

/* Numbers of edges by the wanted edge length: such that a grid fits inside of 4 sides if opposite ones are of about
   the same length. */
GPROJI_INTERNAL void gproji_choose_edges(const gproji_filling *f, int32_t *edges) {
    int32_t side, sum = 0, change = 0, longest = 0, taken[GPROJI_PATCH_SIDES] = {0};
    if (f->sides == 4 && f->options.rings == 0) gproji_strip_edges(f, taken);
    for (side = 0; side < f->sides; ++side) {
        double length = gproji_fmin(gproji_side_length(f, side) / f->edge_length, GPROJI_FILL_EDGES), other;
        int32_t opposite = (side + 2) % 4;
        edges[side] = gproji_max(1, (int32_t)(length + 0.5));
        if (f->sides == 4) {
            other = gproji_fmin(gproji_side_length(f, opposite) / f->edge_length, GPROJI_FILL_EDGES);
            if (length < 1.7 * other && other < 1.7 * length)
                edges[side] = gproji_max(1, (int32_t)(0.5 * (length + other - (taken[side] + taken[opposite])) + 0.5)) +
                              taken[side];
        }
        sum = gproji_min(sum + edges[side], GPROJI_FILL_EDGES + 1);
        if (edges[side] > edges[longest]) longest = side;
    }
    if (sum > GPROJI_FILL_EDGES) return;
    if (sum % 2) {
        side = gproji_best_change(f, edges, &change);
        edges[side] += change, sum += change;
    }
    if (sum < 4) edges[longest] += 4 - sum;
}

GPROJI_INTERNAL gproj_code gproji_check_edges(gproji_filling *f, const int32_t *edges) {
    int32_t side, sum = 0, change = 0;
    for (side = 0; side < f->sides; ++side) {
        if (edges[side] < 1)
            return gproji_fail(f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, f->corner.data[side],
                               "side %d is to have %d edges; each side needs at least 1", side, edges[side]);
        if (edges[side] > GPROJI_FILL_EDGES || (sum += edges[side]) > GPROJI_FILL_EDGES)
            return gproji_fail(f->error, GPROJ_ERROR_SIZE, GPROJ_PLACE_VERTEX, f->corner.data[side],
                               "the sides up to side %d have more than %d edges; use longer edges", side,
                               (int32_t)GPROJI_FILL_EDGES);
    }
    if (sum % 2) {
        side = gproji_best_change(f, edges, &change);
        return gproji_fail(
            f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, f->corner.data[side],
            "the sides have %d edges together, but quads need an even number; give side %d %d edges instead "
            "of %d%s",
            sum, side, edges[side] + change, edges[side], f->options.keep_points ? " (add or leave out a point)" : "");
    }
    if (sum < 4)
        return gproji_fail(f->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, f->corner.data[0],
                           "the sides have %d edges together; quads need at least 4", sum);
    f->boundary = sum;
    return GPROJ_OK;
}

/* The number of edges of each side, checked, into `start`, summed up. */
GPROJI_INTERNAL gproj_code gproji_divide_sides(gproji_filling *f) {
    int32_t side, from, to, *edges;
    gproj_code code;
    f->edge_length = f->options.edge_length;
    if (!(f->edge_length >= 0) || !gproji_is_finite(f->edge_length))
        return gproji_fail(f->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1,
                           "the wanted edge length is %g; it must be positive, or 0 for the mean of the curve",
                           f->edge_length);
    if (f->edge_length == 0) f->edge_length = gproji_length_between(f, 0, f->count) / f->count;
    if (!gproji_ints_add(f->heap, &f->start, 0)) return gproji_fail_memory(f->error);
    for (side = 0; side < f->sides; ++side) {
        int32_t n = !f->options.keep_points && f->options.side_count ? f->options.subdivisions[side] : 0;
        gproji_side_points(f, side, &from, &to);
        if (!gproji_ints_add(f->heap, &f->start, f->options.keep_points ? to - from : n))
            return gproji_fail_memory(f->error);
    }
    edges = f->start.data + 1;
    if (!f->options.keep_points && !f->options.side_count) gproji_choose_edges(f, edges);
    code = gproji_check_edges(f, edges);
    for (side = 0; side < f->sides && !code; ++side) f->start.data[side + 1] += f->start.data[side];
    return code;
}

/* The vertices of a side but its last: `edges` equal pieces of its length, or its points. */
GPROJI_INTERNAL void gproji_divide_side(const gproji_filling *f, int32_t side, double *out) {
    int32_t edges = f->start.data[side + 1] - f->start.data[side], from, to, i, j;
    double all, before = 0, step;
    gproji_side_points(f, side, &from, &to);
    all = gproji_length_between(f, from, to);
    step = gproji_length_between(f, from, from + 1);
    for (i = from, j = 0; j < edges; ++j, out += 3) {
        const double *p, *q;
        double at = all * j / edges, t, d[3];
        while (i + 1 < to && at >= before + step) {
            before += step, ++i;
            step = gproji_length_between(f, i, i + 1);
        }
        if (f->options.keep_points) i = from + j, at = before;
        p = f->points + 3 * (size_t)(i % f->count), q = f->points + 3 * (size_t)((i + 1) % f->count);
        t = (at - before) / step;
        gproji_copy3(t > 1 - 1e-9 ? q : p, out);
        if (t <= 1e-9 || t > 1 - 1e-9) continue; /* a point of the curve */
        gproji_sub3(q, p, d);
        gproji_add_scaled3(t, d, out);
    }
}

GPROJI_INTERNAL bool gproji_add_flat(gproji_filling *f, double x, double y) {
    void *block = f->flat;
    if (!gproji_reserve(f->heap, &block, &f->flat_capacity, (size_t)f->vertices + 1, 2 * sizeof(double))) return false;
    f->flat = (double *)block;
    f->flat[2 * (size_t)f->vertices] = x;
    f->flat[2 * (size_t)f->vertices + 1] = y;
    ++f->vertices;
    return true;
}

/* The side of the edge that begins at a vertex of the boundary. */
GPROJI_INTERNAL int32_t gproji_side_of(const gproji_filling *f, int32_t vertex) {
    int32_t side = 0;
    while (f->start.data[side + 1] <= vertex) ++side;
    return side;
}

/* The vertices of the boundary, and the first patch: all of it. */
GPROJI_INTERNAL gproj_code gproji_divide_curve(gproji_filling *f) {
    gproj_code code = gproji_find_corners(f);
    int32_t side, i, j;
    if (!code) code = gproji_divide_sides(f);
    if (code) return code;
    f->border = (double *)gproji_take(f->heap, (size_t)f->boundary, 3 * sizeof(double));
    if (!f->border) return gproji_fail_memory(f->error);
    for (side = 0; side < f->sides; ++side) gproji_divide_side(f, side, f->border + 3 * (size_t)f->start.data[side]);
    for (side = 0, i = 0; i < f->boundary; ++i) {
        double d[3];
        bool corner = i == f->start.data[side];
        side += corner;
        gproji_sub3(f->border + 3 * (size_t)i, f->points, d);
        if (!gproji_add_flat(f, gproji_dot3(d, f->across), gproji_dot3(d, f->up)) ||
            !gproji_ints_add(f->heap, &f->polygon, 2 * i + corner))
            return gproji_fail_memory(f->error);
    }
    if (!gproji_ints_add(f->heap, &f->patch, f->boundary)) return gproji_fail_memory(f->error);
    if (!gproji_find_crossing(f->heap, f->flat, f->boundary, &i, &j)) return gproji_fail_memory(f->error);
    if (i == f->boundary) return GPROJ_OK;
    i = gproji_side_of(f, i), j = gproji_side_of(f, j);
    return gproji_fail(f->error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_VERTEX, f->corner.data[i],
                       "with so few edges side %d meets side %d; divide them finer", i, j);
}

/* -- cuts -- */

/* A cut through a polygon of the filling: from its place i to its place j. */
typedef struct gproji_cut_line {
    int32_t i, j;
    int32_t edges;
    double cost;
} gproji_cut_line;

/* A patch: `count` entries of f->polygon. */
typedef struct gproji_outline {
    const gproji_filling *f;
    int32_t *entry;
    int32_t count;
    double edge; /* mean edge length */
} gproji_outline;

GPROJI_INLINE int32_t gproji_outline_vertex(const gproji_outline *o, int32_t i) { return o->entry[i % o->count] >> 1; }

GPROJI_INTERNAL double gproji_outline_angle(const gproji_outline *o, int32_t i) {
    return gproji_inner_angle(o->f->flat, gproji_outline_vertex(o, i), gproji_outline_vertex(o, i + 1),
                              gproji_outline_vertex(o, i + o->count - 1));
}

GPROJI_INTERNAL int32_t gproji_outline_corners(const gproji_outline *o, int32_t from, int32_t to) {
    int32_t i, n = 0;
    for (i = from; i < to; ++i) n += o->entry[i % o->count] & 1;
    return n;
}

/* How far the angle is from 1, 2 or 3 right angles, as a part of it, squared. */
GPROJI_INTERNAL double gproji_angle_cost(double angle) {
    int32_t n = gproji_max(1, (int32_t)(angle / GPROJI_RIGHT + 0.5));
    double off = angle / n / GPROJI_RIGHT - 1;
    return off * off;
}

/* Is the cut inside, and how near does it pass other vertices? Its cost for that, or infinity. */
GPROJI_INTERNAL double gproji_clearance_cost(const gproji_outline *o, int32_t i, int32_t j) {
    const double *xy = o->f->flat;
    int32_t a = gproji_outline_vertex(o, i), b = gproji_outline_vertex(o, j), k;
    double length = gproji_distance2(xy, a, b), nearest = 0.7 * o->edge;
    for (k = 0; k < o->count; ++k) {
        int32_t p = gproji_outline_vertex(o, k), q = gproji_outline_vertex(o, k + 1);
        double along, off;
        if (p == a || p == b) continue;
        if (q != a && q != b && gproji_segments_meet(xy, a, b, p, q)) return HUGE_VAL;
        along = ((xy[2 * p] - xy[2 * a]) * (xy[2 * b] - xy[2 * a]) +
                 (xy[2 * p + 1] - xy[2 * a + 1]) * (xy[2 * b + 1] - xy[2 * a + 1])) /
                length;
        off = fabs(gproji_turn2(xy, a, b, p)) / length;
        if (along > 0 && along < length) nearest = gproji_fmin(nearest, off);
    }
    return nearest > 1e-6 * o->edge ? 1 - nearest / (0.7 * o->edge) : HUGE_VAL;
}

/* What is to be expected of a patch with these sides: least for grids, and for one irregular vertex; more where short
   sides leave no room for others. */
GPROJI_INTERNAL double gproji_sides_cost(int32_t sides, const int32_t *length) {
    static const double cost[GPROJI_PATCH_SIDES + 1] = {3, 2, 0.6, 0.3, 0.3, 0.3, 0.6};
    int32_t strip[GPROJI_PATCH_SIDES], i, least = length[0], off;
    for (i = 1; i < sides; ++i) least = gproji_min(least, length[i]);
    if (sides == 4) {
        off = abs(length[0] - length[2]) + abs(length[1] - length[3]);
        return off == 0 ? 0 : 0.3 + 0.03 * off + (least < 3 ? 0.6 : 0);
    }
    if (sides % 2 && sides > 1 && gproji_find_strips(sides, length, strip)) {
        for (i = 0; i < sides && strip[i] > 0; ++i) continue;
        if (i == sides) return 0.2;
    }
    return cost[sides] + (least < 3 ? 0.6 : 0);
}

/* The same of a part of the outline from place i to place j, closed by a cut whose ends are corners or not. Parts
   that are to be cut again: best if the angles allow grids alone, 4 corners and one more for each reflex one. */
GPROJI_INTERNAL double gproji_part_cost(const gproji_outline *o, int32_t i, int32_t j, int32_t edges, bool first,
                                        bool last) {
    int32_t n = gproji_outline_corners(o, i + 1, j) + first + last, k, side = 0, length[GPROJI_PATCH_SIDES] = {0};
    int32_t reflex = 0;
    if (j - i + edges < 4) return HUGE_VAL;
    for (k = i + 1; k < j; ++k) reflex += (o->entry[k % o->count] & 1) && gproji_outline_angle(o, k) > GPROJI_REFLEX;
    if (reflex > 0) return 0.3 * abs(n - 2 * reflex - 4) + 0.1 * reflex;
    if (n > GPROJI_PATCH_SIDES) return 0.6 * (n - GPROJI_PATCH_SIDES + 1);
    if (n < 2) return gproji_sides_cost(n, length);
    for (k = i; k < j; ++k) { /* side 0 is the one before the first corner, and after the last */
        side += k == i ? first : o->entry[k % o->count] & 1;
        ++length[side % n];
    }
    length[(side + last) % n] += edges;
    return gproji_sides_cost(n, length);
}

/* Costs of cuts from place i to place j, with numbers of edges of the right parity. */
GPROJI_INTERNAL void gproji_try_cut(const gproji_outline *o, int32_t i, int32_t j, gproji_cut_line *best) {
    const double *xy = o->f->flat;
    int32_t a = gproji_outline_vertex(o, i), b = gproji_outline_vertex(o, j), edges, wanted, end;
    double at[2][2], length = gproji_distance2(xy, a, b), cost = 0;
    bool corner[2][2];
    at[0][0] = gproji_inner_angle(xy, a, gproji_outline_vertex(o, i + 1), b); /* in the part from i to j */
    at[0][1] = gproji_outline_angle(o, i) - at[0][0];
    at[1][0] = gproji_inner_angle(xy, b, a, gproji_outline_vertex(o, j + o->count - 1));
    at[1][1] = gproji_outline_angle(o, j) - at[1][0];
    for (end = 0; end < 4; ++end) {
        double angle = at[end / 2][end % 2];
        if (!(angle > 0.1)) return;
        corner[end / 2][end % 2] = angle < GPROJI_OBTUSE;
        cost += gproji_angle_cost(angle);
    }
    cost += 0.02 * length / o->edge;
    if (a >= o->f->curve_vertices || b >= o->f->curve_vertices) cost += 0.5; /* three patches would meet inside */
    if (cost >= best->cost) return;
    cost += gproji_clearance_cost(o, i, j);
    if (!(cost < best->cost)) return;
    wanted = (int32_t)(length / o->edge + 0.5);
    for (edges = gproji_max(1, wanted - 3); edges <= wanted + 3; ++edges) {
        double off = log(edges * o->edge / length), all;
        if ((j - i + edges) % 2) continue;
        all = cost + 2 * off * off + gproji_part_cost(o, i, j, edges, corner[0][0], corner[1][0]) +
              gproji_part_cost(o, j, i + o->count, edges, corner[1][1], corner[0][1]);
        if (all < best->cost) best->i = i, best->j = j, best->edges = edges, best->cost = all;
    }
}

/* The best cut from a corner that is reflex, or from any where there are more than 6; cost infinite: none. */
GPROJI_INTERNAL gproji_cut_line gproji_find_cut(const gproji_outline *o) {
    gproji_cut_line best = {0, 0, 0, HUGE_VAL};
    bool many = gproji_outline_corners(o, 0, o->count) > GPROJI_PATCH_SIDES, reflex = false;
    int32_t i, j, pass;
    for (i = 0; i < o->count; ++i) reflex |= (o->entry[i] & 1) && gproji_outline_angle(o, i) > GPROJI_REFLEX;
    if (!reflex && !many) return best;
    for (pass = 0; pass < 2 && !(best.cost < HUGE_VAL); ++pass)
        for (i = 0; i < o->count; ++i) {
            if (!(o->entry[i] & 1) || (reflex && pass == 0 && gproji_outline_angle(o, i) <= GPROJI_REFLEX)) continue;
            for (j = 0; j < o->count; ++j) {
                int32_t apart = j > i ? j - i : i - j;
                if (apart > 1 && apart + 1 < o->count) gproji_try_cut(o, gproji_min(i, j), gproji_max(i, j), &best);
            }
        }
    return best;
}

/* Appends one side of a cut: places i to j, then the cut's inner vertices, first + 0, .., forward or backward. */
GPROJI_INTERNAL bool gproji_add_part(gproji_filling *f, int32_t start, int32_t count, int32_t i, int32_t j,
                                     int32_t first, int32_t inner, bool forward) {
    int32_t k, from = (int32_t)f->polygon.count, to, end;
    for (k = i; k <= j; ++k)
        if (!gproji_ints_add(f->heap, &f->polygon, f->polygon.data[start + k % count])) return false;
    to = (int32_t)f->polygon.count - 1;
    for (k = 0; k < inner; ++k)
        if (!gproji_ints_add(f->heap, &f->polygon, 2 * (first + (forward ? k : inner - 1 - k)))) return false;
    if (!gproji_ints_add(f->heap, &f->patch, (int32_t)f->polygon.count)) return false;
    for (end = 0; end < 2; ++end) { /* corners of the part by their angles */
        int32_t at = end ? to : from;
        gproji_outline o;
        o.f = f, o.entry = f->polygon.data + from, o.count = (int32_t)f->polygon.count - from, o.edge = 0;
        f->polygon.data[at] &= ~1;
        f->polygon.data[at] |= gproji_outline_angle(&o, at - from) < GPROJI_OBTUSE;
    }
    return true;
}

GPROJI_INTERNAL bool gproji_make_cut(gproji_filling *f, int32_t start, int32_t count, const gproji_cut_line *cut) {
    int32_t a = f->polygon.data[start + cut->i] >> 1, b = f->polygon.data[start + cut->j] >> 1, first = f->vertices, k;
    for (k = 1; k < cut->edges; ++k) { /* from j to i */
        double t = (double)k / cut->edges;
        if (!gproji_add_flat(f, (1 - t) * f->flat[2 * b] + t * f->flat[2 * a],
                             (1 - t) * f->flat[2 * b + 1] + t * f->flat[2 * a + 1]))
            return false;
    }
    return gproji_add_part(f, start, count, cut->i, cut->j, first, cut->edges - 1, true) &&
           gproji_add_part(f, start, count, cut->j, cut->i + count, first, cut->edges - 1, false);
}

/* -- patches -- */

/* The patch's corners as places in its outline, at most 6 of them: where there are more, those that turn least are
   left out; where there are fewer than 2, places in between are taken. `flat`: the bits of those that are flat. */
GPROJI_INTERNAL int32_t gproji_patch_corners(gproji_outline *o, int32_t place[GPROJI_PATCH_SIDES], int32_t *flat) {
    int32_t n = gproji_outline_corners(o, 0, o->count), i, k;
    for (; n > GPROJI_PATCH_SIDES; --n) {
        int32_t flattest = -1;
        for (i = 0; i < o->count; ++i)
            if ((o->entry[i] & 1) && (flattest < 0 || gproji_outline_angle(o, i) > gproji_outline_angle(o, flattest)))
                flattest = i;
        o->entry[flattest] &= ~1;
    }
    for (i = 0; n < 2 && i < o->count; ++i)
        if (o->entry[i] & 1) break;
    for (k = 0; n < 2 && k < 4; ++k) o->entry[(i + o->count * k / 4) % o->count] |= 1;
    for (*flat = 0, k = 0, i = 0; i < o->count; ++i) {
        if (!(o->entry[i] & 1)) continue;
        if (o->f->options.rings == 0 && gproji_outline_angle(o, i) > GPROJI_FLAT) *flat |= 1 << k;
        place[k++] = i;
    }
    return k;
}

/* Is it a disk whose inner vertices have valence 3 to 5, with 1 or 2 faces at corners and 2 at other vertices of the
   boundary, or 3 where these are on the curve or a ring along it? `at`: the place of the pattern's first corner.
   Destroys `uses`. */
GPROJI_INTERNAL bool gproji_patch_is_good(gproji_patch *patch, const gproji_outline *o, int32_t at) {
    int32_t i, side, from = at, *uses = patch->uses.data;
    for (side = 0; side < patch->sides; ++side)
        for (i = 0; i < patch->edges[side]; ++i, ++at) {
            int32_t v = patch->loop.data[at - from], most = gproji_outline_vertex(o, at) < o->f->curve_vertices ? 3 : 2;
            if (uses[v] < (i > 0 ? 2 : 1) || uses[v] > (i > 0 ? most : 2)) return false;
            uses[v] = -1; /* twice on the boundary is not good */
        }
    for (i = 0; i < patch->vertices; ++i)
        if (uses[i] >= 0 && (uses[i] < 3 || uses[i] > 5)) return false;
    return true;
}

/* Copies a finished patch into the filling. */
GPROJI_INTERNAL bool gproji_join_patch(gproji_filling *f, const gproji_outline *o, int32_t from, gproji_patch *patch) {
    int32_t *number = patch->uses.data, i, n = (int32_t)patch->loop.count;
    size_t q;
    double x = 0, y = 0;
    for (i = 0; i < patch->vertices; ++i) number[i] = -1;
    for (i = 0; i < n; ++i) {
        int32_t v = gproji_outline_vertex(o, from + i);
        number[patch->loop.data[i]] = v;
        x += f->flat[2 * v] / n, y += f->flat[2 * v + 1] / n;
    }
    for (i = 0; i < patch->vertices; ++i) {
        if (number[i] >= 0) continue;
        number[i] = f->vertices;
        if (!gproji_add_flat(f, x, y)) return false;
    }
    for (q = 0; q < patch->quad.count; ++q)
        if (!gproji_ints_add(f->heap, &f->quad, number[patch->quad.data[q]])) return false;
    return true;
}

/* Tries a pattern. 1: the patch is built and good; 0: it is not; -1: no memory. Give the patch back in any case. */
GPROJI_INTERNAL int32_t gproji_try_pattern(gproji_filling *f, gproji_patch *patch, const gproji_outline *o,
                                           const int32_t *place, const gproji_pattern *p, const int32_t *length) {
    int32_t turned[GPROJI_PATCH_SIDES], i;
    for (i = 0; i < p->sides; ++i) turned[i] = length[(i + p->first) % p->sides];
    if (!gproji_patch_take(patch, f->heap, p->sides, turned) || !gproji_build_patch(patch, p, length)) return -1;
    return gproji_patch_is_good(patch, o, place[p->first]);
}

/* The pattern wanted: of those that are good the `variant`-th, with flat corners under long strips, or else in a
   ring; at last a ring around one strip. -1: no memory. */
GPROJI_INTERNAL int32_t gproji_choose_pattern(gproji_filling *f, gproji_candidates *c, const gproji_outline *o,
                                              int32_t sides, const int32_t *place, const int32_t *length, int32_t flat,
                                              gproji_pattern *chosen) {
    int32_t inner[GPROJI_PATCH_SIDES], good = 0, i, k, ring, sum = 0;
    memset(chosen, 0, sizeof *chosen);
    for (ring = !gproji_inner_lengths(sides, flat, length, inner); ring < 2; ++ring) {
        gproji_find_patterns(c, sides, ring ? length : inner);
        for (i = 0; i < c->count && good <= f->options.variant; ++i) {
            gproji_pattern *p = &c->pattern[i];
            gproji_patch patch;
            int32_t outcome;
            p->ring = ring != 0;
            for (k = 0; k < sides && !ring; ++k)
                if (gproji_is_flat(flat, sides, k + p->first)) p->flat |= 1 << k;
            outcome = gproji_try_pattern(f, &patch, o, place, p, length);
            gproji_patch_give(&patch);
            if (outcome < 0) return -1;
            if (outcome > 0) *chosen = *p, ++good;
        }
    }
    if (good > 0) return 1;
    for (i = 0; i < sides; ++i) sum += length[i];
    chosen->sides = sides;
    chosen->edges = chosen->rows = 1;
    chosen->edge[0] = sum / 2 - 1;
    chosen->bare = chosen->ring = true;
    return 1;
}

GPROJI_INTERNAL bool gproji_fill_patch(gproji_filling *f, gproji_outline *o, gproji_candidates *c) {
    int32_t place[GPROJI_PATCH_SIDES], length[GPROJI_PATCH_SIDES], flat, i;
    int32_t sides = gproji_patch_corners(o, place, &flat);
    gproji_pattern p;
    gproji_patch patch;
    bool done;
    for (i = 0; i < sides; ++i) length[i] = (i + 1 < sides ? place[i + 1] : place[0] + o->count) - place[i];
    if (gproji_choose_pattern(f, c, o, sides, place, length, flat, &p) < 0) return false;
    done = gproji_try_pattern(f, &patch, o, place, &p, length) >= 0 && gproji_join_patch(f, o, place[p.first], &patch);
    gproji_patch_give(&patch);
    ++f->leaves;
    return done;
}

/* The rings wanted, and what they leave as the first patch. Its outline is near the boundary as yet. */
GPROJI_INTERNAL bool gproji_add_rings(gproji_filling *f) {
    int32_t n = f->boundary, ring, i;
    for (ring = 1; ring <= f->options.rings; ++ring)
        for (i = 0; i < n; ++i) {
            int32_t next = (i + 1) % n, before = (i + n - 1) % n, outer = (ring - 1) * n, inner = ring * n;
            double x = f->flat[2 * next] - f->flat[2 * before], y = f->flat[2 * next + 1] - f->flat[2 * before + 1];
            double depth = 0.2 * ring / f->options.rings / sqrt(x * x + y * y);
            depth *= gproji_fmin(gproji_distance2(f->flat, i, next), gproji_distance2(f->flat, i, before));
            if (!gproji_add_flat(f, f->flat[2 * i] - depth * y, f->flat[2 * i + 1] + depth * x) ||
                !gproji_ints_add4(f->heap, &f->quad, outer + i, outer + next, inner + next, inner + i))
                return false;
        }
    f->curve_vertices = f->vertices;
    for (i = 0; i < n; ++i) f->polygon.data[i] = 2 * (f->vertices - n + i) + (f->polygon.data[i] & 1);
    return true;
}

/* Cuts the outline into patches, then fills them: vertices of cuts come before those inside of patches. */
GPROJI_INTERNAL gproj_code gproji_fill_patches(gproji_filling *f, gproji_candidates *c) {
    size_t at;
    int32_t stage, start, k;
    for (stage = 0; stage < 2; ++stage) {
        for (at = 0, start = 0; at < f->patch.count; start = abs(f->patch.data[at++])) {
            gproji_outline o;
            gproji_cut_line cut;
            if (stage == 1 && f->patch.data[at] < 0) continue; /* it has been cut */
            o.f = f, o.entry = f->polygon.data + start, o.count = f->patch.data[at] - start, o.edge = 0;
            for (k = 0; k < o.count; ++k)
                o.edge +=
                    gproji_distance2(f->flat, gproji_outline_vertex(&o, k), gproji_outline_vertex(&o, k + 1)) / o.count;
            if (stage == 1) {
                if (!gproji_fill_patch(f, &o, c)) return gproji_fail_memory(f->error);
                continue;
            }
            cut = gproji_find_cut(&o);
            if (!(cut.cost < HUGE_VAL)) continue;
            if (!gproji_make_cut(f, start, o.count, &cut)) return gproji_fail_memory(f->error);
            f->patch.data[at] = -f->patch.data[at];
        }
        if (stage == 0) f->cut_vertices = f->vertices;
    }
    return GPROJ_OK;
}

/* -- positions -- */

/* A symmetric matrix given by pairs of unknowns, repeated ones summed, and its factorisation. */
typedef struct gproji_pairs {
    gproji_pool pool;
    gproj_cholesky *cholesky;
    int32_t unknowns;
    int64_t count;
    int32_t *pair;  /* 2 * count: unknowns, negative: there is none */
    int64_t *start; /* unknowns + 1 */
    int32_t *row;
    int64_t *place; /* count: of each pair in `row` and `value`; -1: nowhere */
    double *value;
} gproji_pairs;

GPROJI_INTERNAL bool gproji_pairs_take(gproji_pairs *m, gproji_filling *f, int32_t unknowns, int64_t count) {
    memset(m, 0, sizeof *m);
    gproji_pool_start(&m->pool, f->heap);
    m->unknowns = unknowns;
    m->count = count;
    m->pair = (int32_t *)gproji_pool_take(&m->pool, 2 * count, sizeof *m->pair);
    m->start = (int64_t *)gproji_pool_take_zeroed(&m->pool, (int64_t)unknowns + 2, sizeof *m->start);
    m->row = (int32_t *)gproji_pool_take(&m->pool, count, sizeof *m->row);
    m->place = (int64_t *)gproji_pool_take(&m->pool, count, sizeof *m->place);
    m->value = (double *)gproji_pool_take(&m->pool, count, sizeof *m->value);
    m->cholesky = gproj_cholesky_create(f->host);
    return m->pair && m->start && m->row && m->place && m->value && m->cholesky;
}

GPROJI_INTERNAL void gproji_pairs_give(gproji_pairs *m) {
    gproj_cholesky_destroy(m->cholesky);
    gproji_pool_give_all(&m->pool);
}

/* Sorts the pairs by columns and analyses the pattern. */
GPROJI_INTERNAL bool gproji_pairs_analyse(gproji_pairs *m) {
    int64_t e;
    int32_t i;
    for (e = 0; e < m->count; ++e) {
        int32_t column = gproji_min(m->pair[2 * e], m->pair[2 * e + 1]);
        if (column >= 0) ++m->start[column + 2];
    }
    for (i = 2; i <= m->unknowns; ++i) m->start[i] += m->start[i - 1];
    for (e = 0; e < m->count; ++e) { /* start[column + 1] moves from the column's beginning to its end */
        int32_t column = gproji_min(m->pair[2 * e], m->pair[2 * e + 1]);
        m->place[e] = -1;
        if (column < 0) continue;
        m->place[e] = m->start[column + 1]++;
        m->row[m->place[e]] = gproji_max(m->pair[2 * e], m->pair[2 * e + 1]);
    }
    return gproj_cholesky_analyse(m->cholesky, m->unknowns, m->start, m->row, NULL) == GPROJ_OK;
}

GPROJI_INLINE int32_t gproji_quad_next(int32_t corner) { return corner % 4 == 3 ? corner - 3 : corner + 1; }
GPROJI_INLINE int32_t gproji_quad_previous(int32_t corner) { return corner % 4 == 0 ? corner + 3 : corner - 1; }

/* The Laplace equation: each vertex from `fixed` on is the mean of its neighbours. `field` has `fields` numbers a
   vertex; `side` first the right-hand sides, then the solutions, one after the other. */
GPROJI_INTERNAL bool gproji_harmonic_system(const gproji_filling *f, gproji_pairs *m, int32_t fixed, int32_t fields,
                                            const double *field, double *side) {
    int32_t n = (int32_t)f->quad.count, i, k, end;
    for (i = 0; i < n; ++i) {
        int32_t a = f->quad.data[i], b = f->quad.data[gproji_quad_next(i)], *pair = m->pair + 6 * (size_t)i;
        pair[0] = pair[1] = pair[4] = a - fixed;
        pair[2] = pair[3] = pair[5] = b - fixed;
        for (end = 0; end < 2; ++end)
            for (k = 0; k < fields; ++k) {
                int32_t inner = end ? a : b, outer = end ? b : a;
                if (inner >= fixed && outer < fixed)
                    side[(size_t)k * (size_t)m->unknowns + (size_t)(inner - fixed)] += field[outer * fields + k];
            }
    }
    if (!gproji_pairs_analyse(m)) return false;
    for (i = 0; i < 3 * n; ++i)
        if (m->place[i] >= 0) m->value[m->place[i]] = i % 3 == 2 ? -1 : 1;
    return gproj_cholesky_factor(m->cholesky, m->value) == GPROJ_FACTORED &&
           gproj_cholesky_solve(m->cholesky, fields, side, side) == GPROJ_OK;
}

/* Sets the fields of the vertices from `fixed` on. */
GPROJI_INTERNAL gproj_code gproji_fill_harmonically(gproji_filling *f, int32_t fixed, int32_t fields, double *field) {
    int32_t unknowns = f->vertices - fixed, i, k;
    gproji_pairs m;
    double *side = NULL;
    bool done;
    if (unknowns == 0) return GPROJ_OK;
    done = gproji_pairs_take(&m, f, unknowns, 3 * (int64_t)f->quad.count);
    if (done) side = (double *)gproji_pool_take_zeroed(&m.pool, (int64_t)fields * unknowns, sizeof *side);
    done = side && gproji_harmonic_system(f, &m, fixed, fields, field, side);
    for (i = 0; done && i < unknowns; ++i)
        for (k = 0; k < fields; ++k)
            field[(size_t)(i + fixed) * (size_t)fields + (size_t)k] = side[(size_t)k * (size_t)unknowns + (size_t)i];
    gproji_pairs_give(&m);
    return done ? GPROJ_OK : gproji_fail_memory(f->error);
}

/* The distortion of the mesh in the plane. For a corner at p with neighbours q and r of a quad of wanted edge s, with
   a = (q - p) / s, b = (r - p) / s and D = det(a, b):
       (|a|^2 + |b|^2 + lambda (1 + D^2)) / (2 X),  X = (D + sqrt(D^2 + epsilon^2)) / 2,
   least for a square of edge s and, where epsilon = 0, infinite at D = 0. */
typedef struct gproji_untangling {
    gproji_filling *f;
    gproji_pairs m;
    double *edge;     /* of each quad: s */
    double *gradient; /* 2 a vertex that moves */
    double *step;
    double *start; /* flat positions before a step */
    double epsilon;
    double least; /* D of the worst corner, at the last evaluation */
    bool failed;  /* no memory to factor */
} gproji_untangling;

#define GPROJI_AREA_WEIGHT 0.3 /* lambda */

/* The corner's derivatives by (a, b): value, gradient[4], and the convex part of the Hessian, that of y'y / (2 X)
   with X linearised, y = (a, b, sqrt(lambda) D, sqrt(lambda)). */
GPROJI_INTERNAL double gproji_corner_distortion(const double z[4], double epsilon, double gradient[4],
                                                double hessian[4][4]) {
    double d = z[0] * z[3] - z[1] * z[2], root = sqrt(d * d + epsilon * epsilon), x, bend, square, value, slope;
    double turn[4], weight = GPROJI_AREA_WEIGHT;
    int32_t i, j;
    x = d > 0 ? 0.5 * (d + root) : 0.5 * epsilon * epsilon / (root - d); /* without cancellation */
    square = z[0] * z[0] + z[1] * z[1] + z[2] * z[2] + z[3] * z[3];
    value = 0.5 * (square + weight * (1 + d * d)) / x;
    if (!gradient) return value;
    bend = 1 / root; /* X' / X */
    slope = weight * d / x - value * bend;
    turn[0] = z[3], turn[1] = -z[2], turn[2] = -z[1], turn[3] = z[0];
    for (i = 0; i < 4; ++i) gradient[i] = z[i] / x + slope * turn[i];
    for (i = 0; i < 4; ++i)
        for (j = 0; j < 4; ++j) {
            double across = square * bend * bend + weight * ((1 - bend * d) * (1 - bend * d) + bend * bend);
            hessian[i][j] = ((i == j) - bend * (z[i] * turn[j] + turn[i] * z[j]) + across * turn[i] * turn[j]) / x;
        }
    return value;
}

GPROJI_INTERNAL void gproji_corner_edges(const gproji_untangling *u, int32_t corner, double z[4]) {
    const int32_t *quad = u->f->quad.data;
    const double *p = u->f->flat + 2 * (size_t)quad[corner],
                 *q = u->f->flat + 2 * (size_t)quad[gproji_quad_next(corner)],
                 *r = u->f->flat + 2 * (size_t)quad[gproji_quad_previous(corner)];
    double s = u->edge[corner / 4];
    z[0] = (q[0] - p[0]) / s, z[1] = (q[1] - p[1]) / s, z[2] = (r[0] - p[0]) / s, z[3] = (r[1] - p[1]) / s;
}

/* The sum over all corners, and the worst D. */
GPROJI_INTERNAL double gproji_distortion(gproji_untangling *u) {
    int32_t n = (int32_t)u->f->quad.count, c;
    double sum = 0, z[4];
    u->least = HUGE_VAL;
    for (c = 0; c < n; ++c) {
        gproji_corner_edges(u, c, z);
        u->least = gproji_fmin(u->least, z[0] * z[3] - z[1] * z[2]);
        sum += gproji_corner_distortion(z, u->epsilon, NULL, NULL);
    }
    return sum;
}

/* Adds one quad's gradient and Hessian: 8 numbers, x and y of its vertices. */
GPROJI_INTERNAL void gproji_add_quad(gproji_untangling *u, int32_t quad) {
    double gradient[8] = {0}, hessian[8][8] = {{0}}, z[4], g[4], h[4][4], s = u->edge[quad];
    int32_t corner, i, j, k = 0;
    for (corner = 0; corner < 4; ++corner) { /* z = (q, r - p, p) / s: each of them in two places */
        int32_t p = corner, ends[2], a, b;
        ends[0] = (corner + 1) % 4, ends[1] = (corner + 3) % 4;
        gproji_corner_edges(u, 4 * quad + corner, z);
        gproji_corner_distortion(z, u->epsilon, g, h);
        for (i = 0; i < 4; ++i) {
            a = 2 * ends[i / 2] + i % 2;
            gradient[a] += g[i] / s, gradient[2 * p + i % 2] -= g[i] / s;
            for (j = 0; j < 4; ++j) {
                double value = h[i][j] / (s * s);
                b = 2 * ends[j / 2] + j % 2;
                hessian[a][b] += value, hessian[a][2 * p + j % 2] -= value;
                hessian[2 * p + i % 2][b] -= value, hessian[2 * p + i % 2][2 * p + j % 2] += value;
            }
        }
    }
    for (i = 0; i < 8; ++i) {
        int32_t v = u->f->quad.data[4 * quad + i / 2] - u->f->boundary;
        if (v >= 0) u->gradient[2 * v + i % 2] += gradient[i];
        for (j = 0; j <= i; ++j, ++k) {
            int64_t place = u->m.place[GPROJI_QUAD_ENTRIES * (int64_t)quad + k];
            if (place >= 0) u->m.value[place] = hessian[i][j];
        }
    }
}

/* A step of Newton's method, shortened until the distortion is less. False where it gains less than this part of it. */
GPROJI_INTERNAL bool gproji_untangle_step(gproji_untangling *u, double part) {
    gproji_filling *f = u->f;
    size_t n = 2 * (size_t)(f->vertices - f->boundary), i;
    double *moving = f->flat + 2 * (size_t)f->boundary, before, slope, length = 1;
    int32_t q, quads = (int32_t)f->quad.count / 4, halvings;
    gproj_factor_outcome outcome;
    memset(u->gradient, 0, n * sizeof *u->gradient);
    for (q = 0; q < quads; ++q) gproji_add_quad(u, q);
    outcome = gproj_cholesky_factor(u->m.cholesky, u->m.value);
    u->failed = outcome == GPROJ_FACTOR_FAILED;
    if (outcome != GPROJ_FACTORED) return false;
    gproj_cholesky_solve(u->m.cholesky, 1, u->gradient, u->step);
    before = gproji_distortion(u);
    slope = gproji_dot(u->gradient, u->step, n);
    memcpy(u->start, moving, n * sizeof *moving);
    for (halvings = 0; halvings < 40; ++halvings, length *= 0.5) {
        for (i = 0; i < n; ++i) moving[i] = u->start[i] - length * u->step[i];
        if (gproji_distortion(u) <= before - 1e-4 * length * slope) return slope > part * before;
    }
    memcpy(moving, u->start, n * sizeof *moving);
    gproji_distortion(u);
    return false;
}

/* The wanted edge of each quad: that of the boundary, harmonic inside. */
GPROJI_INTERNAL gproj_code gproji_find_sizes(gproji_untangling *u) {
    gproji_filling *f = u->f;
    int32_t i, quads = (int32_t)f->quad.count / 4;
    double *size = u->start; /* has room for it */
    gproj_code code;
    for (i = 0; i < f->boundary; ++i)
        size[i] = 0.5 * (gproji_distance2(f->flat, i, (i + 1) % f->boundary) +
                         gproji_distance2(f->flat, i, (i + f->boundary - 1) % f->boundary));
    code = gproji_fill_harmonically(f, f->boundary, 1, size);
    for (i = 0; i < quads && !code; ++i) {
        const int32_t *v = f->quad.data + 4 * (size_t)i;
        u->edge[i] = 0.25 * (size[v[0]] + size[v[1]] + size[v[2]] + size[v[3]]);
    }
    return code;
}

GPROJI_INTERNAL gproj_code gproji_untangle(gproji_filling *f, gproji_untangling *u) {
    int32_t quads = (int32_t)f->quad.count / 4, q, i, j, n;
    gproj_code code = gproji_find_sizes(u);
    if (code) return code;
    for (q = 0, n = 0; q < quads; ++q)
        for (i = 0; i < 8; ++i)
            for (j = 0; j <= i; ++j, ++n) {
                int32_t a = f->quad.data[4 * q + i / 2] - f->boundary, b = f->quad.data[4 * q + j / 2] - f->boundary;
                u->m.pair[2 * (int64_t)n] = a < 0 ? -1 : 2 * a + i % 2;
                u->m.pair[2 * (int64_t)n + 1] = b < 0 ? -1 : 2 * b + j % 2;
            }
    if (!gproji_pairs_analyse(&u->m)) return gproji_fail_memory(f->error);
    u->epsilon = 1;
    for (i = 0; i < GPROJI_UNTANGLE_STEPS; ++i) { /* along the minima for ever smaller epsilon */
        if (gproji_untangle_step(u, u->epsilon > 0 ? 1e-2 : 1e-6)) continue;
        if (u->failed) return gproji_fail_memory(f->error);
        if (u->epsilon == 0 || (u->least <= 0 && u->epsilon < 1e-6)) break;
        u->epsilon = u->least > 10 * u->epsilon ? 0 : 0.3 * u->epsilon;
    }
    return GPROJ_OK;
}

/* Do all corners of all quads turn left? */
GPROJI_INTERNAL bool gproji_is_untangled(const gproji_filling *f) {
    int32_t n = (int32_t)f->quad.count, i;
    for (i = 0; i < n; ++i)
        if (!(gproji_turn2(f->flat, f->quad.data[i], f->quad.data[gproji_quad_next(i)],
                           f->quad.data[gproji_quad_previous(i)]) > 0))
            return false;
    return true;
}

GPROJI_INTERNAL gproj_code gproji_place_vertices(gproji_filling *f) {
    int32_t unknowns = 2 * (f->vertices - f->boundary);
    gproj_code code = gproji_fill_harmonically(f, f->cut_vertices, 2, f->flat);
    gproji_untangling u;
    memset(&u, 0, sizeof u);
    u.f = f;
    if (code || unknowns == 0) return code;
    if (gproji_pairs_take(&u.m, f, unknowns, GPROJI_QUAD_ENTRIES * (int64_t)(f->quad.count / 4))) {
        u.edge = (double *)gproji_pool_take(&u.m.pool, (int64_t)f->quad.count / 4, sizeof *u.edge);
        u.gradient = (double *)gproji_pool_take(&u.m.pool, unknowns, sizeof *u.gradient);
        u.step = (double *)gproji_pool_take(&u.m.pool, unknowns, sizeof *u.step);
        u.start = (double *)gproji_pool_take(&u.m.pool, 2 * (int64_t)f->vertices, sizeof *u.start);
    }
    code = u.edge && u.gradient && u.step && u.start ? gproji_untangle(f, &u) : gproji_fail_memory(f->error);
    gproji_pairs_give(&u.m);
    return code;
}

/* -- the mesh -- */

/* Positions in space: the curve at the boundary; inside those of the plane, with harmonic heights. */
GPROJI_INTERNAL gproj_code gproji_lift_vertices(gproji_filling *f, double *height, double *position) {
    int32_t v;
    gproj_code code;
    for (v = 0; v < f->boundary; ++v) {
        double d[3];
        gproji_sub3(f->border + 3 * (size_t)v, f->points, d);
        height[v] = gproji_dot3(d, f->normal);
    }
    code = gproji_fill_harmonically(f, f->boundary, 1, height);
    memcpy(position, f->border, 3 * (size_t)f->boundary * sizeof *position);
    for (v = f->boundary; v < f->vertices && !code; ++v) {
        double *out = position + 3 * (size_t)v;
        gproji_copy3(f->points, out);
        gproji_add_scaled3(f->flat[2 * (size_t)v], f->across, out);
        gproji_add_scaled3(f->flat[2 * (size_t)v + 1], f->up, out);
        gproji_add_scaled3(height[v], f->normal, out);
    }
    return code;
}

GPROJI_INTERNAL gproj_code gproji_build_filling(gproji_filling *f, gproji_mesh_object *object) {
    int32_t faces = (int32_t)f->quad.count / 4, side, i;
    gproji_ints line = {NULL, 0, 0}, start = {NULL, 0, 0};
    gproji_soup soup;
    gproji_pool pool;
    double *height, *position;
    int32_t *degree;
    bool taken;
    gproj_code code;
    gproji_pool_start(&pool, f->heap);
    height = (double *)gproji_pool_take(&pool, f->vertices, sizeof *height);
    position = (double *)gproji_pool_take(&pool, 3 * (int64_t)f->vertices, sizeof *position);
    degree = (int32_t *)gproji_pool_take(&pool, faces, sizeof *degree);
    taken = height && position && degree && gproji_ints_add(f->heap, &start, 0);
    for (side = 0; taken && side < f->sides; ++side) {
        for (i = f->start.data[side]; taken && i <= f->start.data[side + 1]; ++i)
            taken = gproji_ints_add(f->heap, &line, i % f->boundary);
        taken = taken && gproji_ints_add(f->heap, &start, (int32_t)line.count);
    }
    code = taken ? gproji_lift_vertices(f, height, position) : gproji_fail_memory(f->error);
    if (!code) {
        gproji_fill(degree, faces, 4);
        soup.vertex_count = f->vertices, soup.face_count = faces, soup.corner_count = 0;
        soup.position = position, soup.face_degree = degree, soup.face_vertex = f->quad.data;
        code = gproji_mesh_build(object, &soup, f->error);
    }
    if (!code) code = gproji_mesh_set_polylines(object, f->sides, start.data, line.data, f->error);
    gproji_ints_give(f->heap, &line);
    gproji_ints_give(f->heap, &start);
    gproji_pool_give_all(&pool);
    return code;
}

GPROJI_INTERNAL void gproji_describe_filling(const gproji_filling *f, const gproj_mesh *mesh, gproj_fill_info *info) {
    int32_t i, n = (int32_t)f->quad.count;
    info->boundary_count = f->boundary;
    info->side_count = f->sides;
    info->patch_count = f->leaves;
    for (i = f->boundary; i < f->vertices; ++i) {
        int32_t valence = gproj_mesh_valence(mesh, i);
        info->irregular_count += valence != 4;
        info->min_valence = i == f->boundary ? valence : gproji_min(info->min_valence, valence);
        info->max_valence = gproji_max(info->max_valence, valence);
    }
    for (i = 0; i < n; ++i) {
        double angle = gproji_inner_angle(f->flat, f->quad.data[i], f->quad.data[gproji_quad_next(i)],
                                          f->quad.data[gproji_quad_previous(i)]) *
                       57.29577951308232;
        if (i == 0 || angle < info->min_angle) info->min_angle = angle;
        if (i == 0 || angle > info->max_angle) info->max_angle = angle;
    }
}

/* The largest valence inside. */
GPROJI_INTERNAL gproj_code gproji_find_valence(gproji_filling *f, int32_t *most) {
    int32_t *count = (int32_t *)gproji_take_zeroed(f->heap, (size_t)f->vertices, sizeof *count);
    size_t i;
    if (!count) return gproji_fail_memory(f->error);
    for (*most = 0, i = 0; i < f->quad.count; ++i)
        if (f->quad.data[i] >= f->boundary) *most = gproji_max(*most, ++count[f->quad.data[i]]);
    gproji_give(f->heap, count, (size_t)f->vertices, sizeof *count);
    return GPROJ_OK;
}

/* The combinatorics wanted, or one of the next where its valences are large, or its quads cannot all be turned the
   right way up. Sets whether it is good. */
GPROJI_INTERNAL gproj_code gproji_try_filling(gproji_filling *f, gproji_candidates *c, int32_t valence, bool *good) {
    int32_t most = 0;
    gproj_code code;
    f->polygon.count = (size_t)f->boundary;
    f->patch.count = 1;
    f->patch.data[0] = f->boundary;
    f->quad.count = 0;
    f->vertices = f->boundary;
    f->leaves = 0;
    *good = false;
    code = gproji_add_rings(f) ? gproji_fill_patches(f, c) : gproji_fail_memory(f->error);
    if (!code) code = gproji_find_valence(f, &most);
    if (code || most > valence) return code;
    code = gproji_place_vertices(f);
    *good = gproji_is_untangled(f);
    return code;
}

GPROJI_INTERNAL gproj_code gproji_fill_outline(gproji_filling *f, gproji_candidates *c) {
    static const int32_t valence[3] = {5, 6, INT32_MAX};
    int32_t variant = f->options.variant, pass, tries;
    for (pass = 0; pass < 3; ++pass)
        for (tries = 0; tries < GPROJI_FILL_TRIES && variant < INT32_MAX - tries; ++tries) {
            bool good;
            gproj_code code;
            f->options.variant = variant + tries;
            code = gproji_try_filling(f, c, valence[pass], &good);
            if (code || good) return code;
        }
    return gproji_fail(f->error, GPROJ_ERROR_DEGENERATE, GPROJ_PLACE_NONE, -1,
                       "no filling without a quad turned over was found; divide the sides finer or mark other corners");
}

GPROJI_INTERNAL gproj_code gproji_fill_curve(gproji_filling *f, gproji_mesh_object *object, gproj_fill_info *info) {
    gproji_candidates *c;
    gproj_code code = gproji_check_curve(f);
    if (!code) code = gproji_divide_curve(f);
    if (code) return code;
    c = (gproji_candidates *)gproji_take(f->heap, 1, sizeof *c);
    code = c ? gproji_fill_outline(f, c) : gproji_fail_memory(f->error);
    gproji_give(f->heap, c, 1, sizeof *c);
    if (!code) code = gproji_build_filling(f, object);
    if (!code) gproji_describe_filling(f, &object->mesh, info);
    return code;
}

GPROJ_API gproj_mesh *gproj_mesh_fill(int32_t count, const double *points, const gproj_fill_options *options,
                                      gproj_fill_info *info, const gproj_host *host, gproj_error *error) {
    gproji_mesh_object *object = gproji_mesh_begin(host, error);
    gproji_filling f;
    gproj_fill_info found;
    gproj_code code;
    if (!object) return NULL;
    memset(&f, 0, sizeof f);
    memset(&found, 0, sizeof found);
    f.heap = &object->heap, f.host = host, f.error = error;
    f.count = count, f.points = points;
    if (options) f.options = *options;
    code = gproji_fill_curve(&f, object, &found);
    gproji_give(f.heap, f.seen, (size_t)f.count, 2 * sizeof(double));
    gproji_give(f.heap, f.border, (size_t)f.boundary, 3 * sizeof(double));
    gproji_give(f.heap, f.flat, f.flat_capacity, 2 * sizeof(double));
    gproji_ints_give(f.heap, &f.corner);
    gproji_ints_give(f.heap, &f.start);
    gproji_ints_give(f.heap, &f.polygon);
    gproji_ints_give(f.heap, &f.patch);
    gproji_ints_give(f.heap, &f.quad);
    if (info) *info = found;
    return gproji_mesh_done(object, code);
}

/* ============================================================================================================
   >>form   A mesh and its system: life, units, and what all builders share. Uses all earlier sections.

   Based on Tang et al. (2014), sections 3.1 to 3.4.

   The form works in its own units: internal = (position - centre) * scale, mean edge length 1. Vertex i has the
   variables 3i..3i+2; face normals come behind them when a group asks for them. Groups whose rows change from
   iteration to iteration have a gproji_part with what their refresh needs; a part never moves, so that the system
   may keep pointers to it. */

typedef struct gproji_part {
    struct gproji_part *next;
    struct gproj_form *form;
    int32_t group;
    int32_t count;                /* of `vertex` and, for curves, of `curve_of` */
    int32_t capacity;             /* of `vertex` */
    int32_t *vertex;              /* the vertices (Gauss image: faces) that its rows belong to */
    const gproj_surface *surface; /* the caller's, in the mesh's units */
    const gproj_curve *curve;     /* the caller's, in the mesh's units; or NULL: */
    int32_t curve_count;          /* curves of its own, in internal units */
    gproj_curve **own_curve;
    int32_t *curve_of; /* of each vertex, its own curve; -1: it stays where it was */
    double target;     /* the volume, internal units */
    double *gradient;  /* of the volume or cost: 3 numbers a vertex of the mesh */
    double bound[2];   /* at least and at most, internal units (stresses: the caller's); 0 and infinite: none */
    double price[2];   /* of lengths and areas in internal units */
    double unit;       /* of the cost: by how much it changes per mean edge length of the mesh's size */
    int32_t *segment;  /* of each vertex, the segment it glides on; -1: to be found */
    double *factor;    /* capacity numbers: of each row of stress bounds, +A or -A */
    int32_t planes;    /* 1: vertices on an unknown plane; 2: on a line, which is two; 0: none of it */
    int32_t *plane;    /* of each vertex (`capacity`), the first variable of its plane or planes; -1: none */
} gproji_part;

/* What the section statics keeps for a form. */
typedef struct gproji_statics {
    gproj_loads loads; /* its arrays are the two below */
    double *edge_density, *point_load;
    uint8_t *axes;      /* of each vertex: the axes along which it is in equilibrium; 0: pinned */
    int32_t *force;     /* of each edge, the variable of its force; -1: none */
    int32_t *first_row; /* of each vertex, in the group of equilibrium */
    int64_t *load_start;
    int32_t *load_vertex;
    double *work;      /* 3 numbers a vertex */
    double load_scale; /* loads inside = loads in internal lengths * load_scale */
    int32_t group;     /* of equilibrium */
    int32_t guidance;  /* the group that draws the forces to their start; -1: none yet */
    bool started;      /* the forces have values */
} gproji_statics;

struct gproj_form {
    gproji_heap own;
    gproj_error error;
    gproj_host host;
    gproj_mesh *mesh;
    gproj_system *system;
    double centre[3], scale;
    double *original; /* 3 * vertex_count, internal units, at gproj_form_create */
    int32_t *normal;  /* of each face, the first of the 3 variables of its normal; -1: none */
    int32_t *axis;    /* of each face, the first variable of its axis point; -1: none; NULL: no face has one */
    int32_t *cone;    /* of each vertex, the first variable of its cone's axis; -1: none; NULL: no vertex has one */
    double *area;     /* work: the vectorial area of each face */
    int32_t *ring;    /* work: the neighbours of one vertex or face, as many as the largest valence or degree */
    int32_t ring_size;
    int32_t closeness;       /* the group of the default guidance; -1: none yet */
    int32_t planarity;       /* the group of the planar faces; -1: none */
    gproji_part *guard;      /* the faces that are kept from turning over; NULL: none yet */
    double *guard_area;      /* of each of them, its vectorial area when the solve began: 3 numbers */
    bool guard_on;           /* in this solve */
    gproji_statics *statics; /* NULL: no forces */
    gproji_part *part;
};

/* -- life -- */

GPROJI_INTERNAL void gproji_part_give(gproj_form *form, gproji_part *part) {
    int32_t i;
    for (i = 0; part->own_curve && i < part->curve_count; ++i) gproj_curve_destroy(part->own_curve[i]);
    gproji_give(&form->own, part->own_curve, (size_t)part->curve_count, sizeof *part->own_curve);
    gproji_give(&form->own, part->curve_of, (size_t)part->count, sizeof *part->curve_of);
    gproji_give(&form->own, part->gradient, 3 * (size_t)form->mesh->vertex_count, sizeof *part->gradient);
    gproji_give(&form->own, part->segment, (size_t)part->count, sizeof *part->segment);
    gproji_give(&form->own, part->factor, (size_t)part->capacity, sizeof *part->factor);
    gproji_give(&form->own, part->plane, (size_t)part->capacity, sizeof *part->plane);
    gproji_give(&form->own, part->vertex, (size_t)part->capacity, sizeof *part->vertex);
    gproji_give(&form->own, part, 1, sizeof *part);
}

GPROJI_INTERNAL void gproji_statics_give(gproj_form *form) {
    gproji_statics *s = form->statics;
    size_t vertices = (size_t)form->mesh->vertex_count, edges = (size_t)form->mesh->edge_count;
    gproji_give(&form->own, s->edge_density, edges, sizeof *s->edge_density);
    gproji_give(&form->own, s->point_load, 3 * vertices, sizeof *s->point_load);
    gproji_give(&form->own, s->load_vertex, s->load_start ? (size_t)s->load_start[vertices] : 0,
                sizeof *s->load_vertex);
    gproji_give(&form->own, s->axes, vertices, sizeof *s->axes);
    gproji_give(&form->own, s->force, edges, sizeof *s->force);
    gproji_give(&form->own, s->first_row, vertices, sizeof *s->first_row);
    gproji_give(&form->own, s->load_start, vertices + 1, sizeof *s->load_start);
    gproji_give(&form->own, s->work, 3 * vertices, sizeof *s->work);
    gproji_give(&form->own, s, 1, sizeof *s);
}

GPROJ_API void gproj_form_destroy(gproj_form *form) {
    if (!form) return;
    if (form->statics) gproji_statics_give(form);
    if (form->guard)
        gproji_give(&form->own, form->guard_area, 3 * (size_t)form->guard->count, sizeof *form->guard_area);
    while (form->part) {
        gproji_part *next = form->part->next;
        gproji_part_give(form, form->part);
        form->part = next;
    }
    if (form->mesh) {
        gproji_give(&form->own, form->original, 3 * (size_t)form->mesh->vertex_count, sizeof *form->original);
        gproji_give(&form->own, form->normal, (size_t)form->mesh->face_count, sizeof *form->normal);
        gproji_give(&form->own, form->axis, (size_t)form->mesh->face_count, sizeof *form->axis);
        gproji_give(&form->own, form->cone, (size_t)form->mesh->vertex_count, sizeof *form->cone);
        gproji_give(&form->own, form->area, 3 * (size_t)form->mesh->face_count, sizeof *form->area);
        gproji_give(&form->own, form->ring, (size_t)form->ring_size, sizeof *form->ring);
    }
    gproj_system_destroy(form->system);
    gproji_destroy_object(form, sizeof *form);
}

/* The mean of the bounding box's corners, and the scale that makes the mean edge 1. */
GPROJI_INTERNAL void gproji_form_measure_units(gproj_form *form) {
    const gproj_mesh *mesh = form->mesh;
    double edge = gproj_mesh_mean_edge_length(mesh), low, high;
    int32_t v, k;
    for (k = 0; k < 3; ++k) {
        low = high = mesh->vertex_count ? mesh->position[k] : 0;
        for (v = 1; v < mesh->vertex_count; ++v) {
            low = gproji_fmin(low, mesh->position[3 * (size_t)v + (size_t)k]);
            high = gproji_fmax(high, mesh->position[3 * (size_t)v + (size_t)k]);
        }
        form->centre[k] = low + (high - low) / 2;
    }
    form->scale = edge > 0 ? 1 / edge : 1;
}

GPROJI_INTERNAL void gproji_to_internal(const gproj_form *form, const double position[3], double out[3]) {
    gproji_sub3(position, form->centre, out);
    out[0] *= form->scale, out[1] *= form->scale, out[2] *= form->scale;
}

GPROJI_INTERNAL void gproji_from_internal(const gproj_form *form, const double x[3], double out[3]) {
    int32_t k;
    for (k = 0; k < 3; ++k) out[k] = form->centre[k] + x[k] / form->scale;
}

GPROJI_INTERNAL int32_t gproji_largest_ring(const gproj_mesh *mesh) {
    int32_t largest = 1, i;
    for (i = 0; i < mesh->vertex_count; ++i) largest = gproji_max(largest, gproj_mesh_valence(mesh, i));
    for (i = 0; i < mesh->face_count; ++i) largest = gproji_max(largest, mesh->face_degree[i]);
    return largest;
}

/* Refuses coordinates that are not finite: the caller may have written them. */
GPROJI_INTERNAL bool gproji_positions_are_finite(gproj_form *form) {
    int32_t i;
    for (i = 0; i < form->mesh->vertex_count; ++i) {
        const double *p = form->mesh->position + 3 * (size_t)i;
        if (gproji_is_finite(p[0]) && gproji_is_finite(p[1]) && gproji_is_finite(p[2])) continue;
        gproji_fail(&form->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, i,
                    "a coordinate of vertex %d is not a finite number", i);
        return false;
    }
    return true;
}

/* The rest of gproj_form_create, when the form itself is there. */
GPROJI_INTERNAL gproj_code gproji_form_begin(gproj_form *form) {
    gproj_mesh *mesh = form->mesh;
    int32_t i;
    if (!mesh)
        return gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                           "there is no mesh: reading or building it failed, see its error");
    form->ring_size = gproji_largest_ring(mesh);
    form->original = (double *)gproji_take(&form->own, 3 * (size_t)mesh->vertex_count, sizeof *form->original);
    form->normal = (int32_t *)gproji_take(&form->own, (size_t)mesh->face_count, sizeof *form->normal);
    form->area = (double *)gproji_take(&form->own, 3 * (size_t)mesh->face_count, sizeof *form->area);
    form->ring = (int32_t *)gproji_take(&form->own, (size_t)form->ring_size, sizeof *form->ring);
    form->system = gproj_system_create(&form->host);
    if (!form->original || !form->normal || !form->area || !form->ring || !form->system)
        return gproji_fail_memory(&form->error);
    if (!gproji_positions_are_finite(form)) return form->error.code;
    gproji_form_measure_units(form);
    for (i = 0; i < mesh->vertex_count; ++i)
        gproji_to_internal(form, mesh->position + 3 * (size_t)i, form->original + 3 * (size_t)i);
    for (i = 0; i < mesh->face_count; ++i) form->normal[i] = -1;
    gproj_system_add_variables(form->system, 3 * mesh->vertex_count, 3, form->original);
    return GPROJ_OK;
}

GPROJ_API gproj_form *gproj_form_create(gproj_mesh *mesh, const gproj_host *host) {
    gproj_form *form = (gproj_form *)gproji_create_object(host, sizeof(gproj_form));
    if (!form) return NULL;
    gproji_error_clear(&form->error);
    if (host) form->host = *host;
    form->mesh = mesh;
    form->scale = 1;
    form->closeness = form->planarity = -1;
    gproji_form_begin(form);
    return form;
}

/* The form's own error, or its system's. */
GPROJ_API const gproj_error *gproj_form_error(const gproj_form *form) {
    if (!form) return gproji_no_object();
    if (form->error.code != GPROJ_OK || !form->system) return &form->error;
    return gproj_system_error(form->system);
}

GPROJI_INTERNAL bool gproji_form_ready(const gproj_form *form) { return gproj_form_error(form)->code == GPROJ_OK; }

GPROJ_API gproj_memory gproj_form_memory(const gproj_form *form) {
    const gproji_part *part;
    gproj_memory sum;
    int32_t i;
    memset(&sum, 0, sizeof sum);
    if (!form) return sum;
    gproji_add_memory(&sum, form->own.account);
    gproji_add_memory(&sum, gproj_system_memory(form->system));
    for (part = form->part; part; part = part->next)
        for (i = 0; part->own_curve && i < part->curve_count; ++i)
            if (part->own_curve[i]) gproji_add_memory(&sum, part->own_curve[i]->heap.account);
    return sum;
}

GPROJ_API gproj_system *gproj_form_system(gproj_form *form) { return form ? form->system : NULL; }

GPROJ_API void gproj_form_units(const gproj_form *form, double centre[3], double *scale) {
    gproji_set3(0, 0, 0, centre);
    *scale = 1;
    if (!form) return;
    gproji_copy3(form->centre, centre);
    *scale = form->scale;
}

/* -- what the builders share -- */

GPROJI_INTERNAL int32_t gproji_new_group(gproj_form *form, const char *name, gproj_kind kind, gproj_place place,
                                         double weight, gproj_refresh refresh, void *user) {
    gproj_group group;
    memset(&group, 0, sizeof group);
    group.name = name;
    group.kind = kind;
    group.place = place;
    group.schedule.weight = weight;
    group.refresh = refresh;
    group.refresh_user = user;
    return gproj_system_add_group(form->system, &group);
}

/* The same for global rows, which belong to the whole mesh. */
GPROJI_INTERNAL int32_t gproji_new_global_group(gproj_form *form, const char *name, gproj_kind kind, double weight,
                                                gproj_refresh refresh, void *user) {
    int32_t group = gproji_new_group(form, name, kind, GPROJ_PLACE_NONE, weight, refresh, user);
    if (group >= 0) form->system->group[group].global = true;
    return group;
}

/* A part for `count` vertices or faces that the caller then fills in; NULL after an error. */
GPROJI_INTERNAL gproji_part *gproji_new_part(gproj_form *form, int32_t count) {
    gproji_part *part;
    if (!gproji_form_ready(form)) return NULL;
    part = (gproji_part *)gproji_take_zeroed(&form->own, 1, sizeof *part);
    if (part) part->vertex = (int32_t *)gproji_take(&form->own, (size_t)count, sizeof *part->vertex);
    if (!part || !part->vertex) {
        gproji_give(&form->own, part, 1, sizeof *part);
        gproji_fail_memory(&form->error);
        return NULL;
    }
    part->form = form;
    part->count = part->capacity = count;
    part->next = form->part;
    form->part = part;
    return part;
}

GPROJI_INTERNAL void gproji_set_term(gproj_term *term, int32_t i, int32_t j, double a) {
    term->i = i;
    term->j = j;
    term->a = a;
}

/* Room for what a builder is about to add, or for a little more: a group that grows row by row is moved many times. */
GPROJI_INTERNAL void gproji_expect_group(gproj_form *form, int32_t group, size_t variables, size_t rows, size_t terms) {
    gproj_system *s = form->system;
    if (group >= 0 &&
        !(gproji_reserve_variables(s, variables) && gproji_reserve_rows(s, &s->group[group], rows, terms)))
        gproji_fail_memory(&s->error);
}

/* Refuses vertex numbers out of range. */
GPROJI_INTERNAL bool gproji_vertices_are_valid(gproj_form *form, const char *name, int32_t count,
                                               const int32_t *vertices) {
    int32_t i;
    for (i = 0; i < count; ++i) {
        if (vertices[i] >= 0 && vertices[i] < form->mesh->vertex_count) continue;
        gproji_fail(&form->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_VERTEX, vertices[i],
                    "%s: there is no vertex %d (the mesh has %d, counted from 0)", name, vertices[i],
                    form->mesh->vertex_count);
        return false;
    }
    return true;
}

/* Copies the caller's list of vertices to a new part; NULL after an error. */
GPROJI_INTERNAL gproji_part *gproji_new_vertex_part(gproj_form *form, const char *name, int32_t count,
                                                    const int32_t *vertices) {
    gproji_part *part;
    if (!gproji_form_ready(form)) return NULL;
    if (count < 0 || (count > 0 && !vertices)) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "%s: the list of %d vertices is no list",
                    name, count);
        return NULL;
    }
    if (!gproji_vertices_are_valid(form, name, count, vertices)) return NULL;
    part = gproji_new_part(form, count);
    if (part && count) memcpy(part->vertex, vertices, (size_t)count * sizeof *vertices);
    return part;
}

typedef bool (*gproji_select)(const gproj_form *form, int32_t vertex);

/* A new part with the vertices that `select` takes. */
GPROJI_INTERNAL gproji_part *gproji_new_selected_part(gproj_form *form, gproji_select select) {
    gproji_part *part;
    int32_t v, count = 0;
    if (!gproji_form_ready(form)) return NULL;
    for (v = 0; v < form->mesh->vertex_count; ++v) count += select(form, v);
    part = gproji_new_part(form, count);
    if (!part) return NULL;
    for (v = 0, count = 0; v < form->mesh->vertex_count; ++v)
        if (select(form, v)) part->vertex[count++] = v;
    return part;
}

GPROJI_INTERNAL bool gproji_select_all(const gproj_form *form, int32_t vertex) {
    (void)form;
    (void)vertex;
    return true;
}

GPROJI_INTERNAL bool gproji_select_boundary(const gproj_form *form, int32_t vertex) {
    return gproj_mesh_is_boundary_vertex(form->mesh, vertex);
}

GPROJ_API bool gproj_form_is_corner(const gproj_form *form, int32_t vertex) {
    return form && form->mesh && form->original && gproji_is_corner(form->mesh, form->original, vertex);
}

GPROJI_INTERNAL bool gproji_select_corner(const gproj_form *form, int32_t vertex) {
    return gproj_form_is_corner(form, vertex);
}

GPROJI_INTERNAL bool gproji_select_gliding(const gproj_form *form, int32_t vertex) {
    return gproji_select_boundary(form, vertex) && !gproj_form_is_corner(form, vertex);
}

/* ============================================================================================================
   >>catalogue   The constraints and wishes of a form, one builder each. Uses all earlier sections.

   Based on Tang et al. (2014), sections 3.1, 3.2 and 3.5. Each builder appends variables and rows to the form's system;
   those whose rows change with x have a refresh beside them. */

/* -- points: fixed vertices, handles, closeness -- */

/* Rows x - p = 0 for the three coordinates of each vertex of the part; p = targets[3k..] in the mesh's units, or NULL:
   the original place. */
GPROJI_INTERNAL int32_t gproji_add_points(gproj_form *form, gproji_part *part, const char *name, gproj_kind kind,
                                          const double *targets, double weight) {
    int32_t i, k, group;
    if (!part) return -1;
    group = part->group = gproji_new_group(form, name, kind, GPROJ_PLACE_VERTEX, weight, NULL, NULL);
    gproji_expect_group(form, group, 0, 3 * (size_t)part->count, 3 * (size_t)part->count);
    for (i = 0; i < part->count; ++i) {
        double p[3];
        gproji_copy3(form->original + 3 * (size_t)part->vertex[i], p);
        if (targets) gproji_to_internal(form, targets + 3 * (size_t)i, p);
        for (k = 0; k < 3; ++k) {
            gproj_term term;
            gproji_set_term(&term, 3 * part->vertex[i] + k, -1, 1);
            gproj_system_add_row(form->system, group, 1, &term, -p[k], part->vertex[i]);
        }
    }
    return gproji_form_ready(form) ? group : -1;
}

GPROJ_API int32_t gproj_add_fixed(gproj_form *form, int32_t count, const int32_t *vertices, double weight) {
    return gproji_add_points(form, gproji_new_vertex_part(form, "fixed vertices", count, vertices), "fixed vertices",
                             GPROJ_CONSTRAINT, NULL, weight);
}

GPROJ_API int32_t gproj_add_fixed_boundary(gproj_form *form, double weight) {
    return gproji_add_points(form, gproji_new_selected_part(form, gproji_select_boundary), "fixed boundary",
                             GPROJ_CONSTRAINT, NULL, weight);
}

GPROJ_API int32_t gproj_add_fixed_corners(gproj_form *form, double weight) {
    return gproji_add_points(form, gproji_new_selected_part(form, gproji_select_corner), "fixed corners",
                             GPROJ_CONSTRAINT, NULL, weight);
}

GPROJ_API int32_t gproj_add_targets(gproj_form *form, int32_t count, const int32_t *vertices, const double *positions,
                                    double weight) {
    gproji_part *part = gproji_new_vertex_part(form, "targets", count, vertices);
    if (part && count > 0 && !positions) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "targets: there are no positions");
        return -1;
    }
    return gproji_add_points(form, part, "targets", GPROJ_CONSTRAINT, positions, weight);
}

GPROJ_API gproj_code gproj_set_targets(gproj_form *form, int32_t group, const double *positions) {
    const gproji_part *part;
    int32_t i, k;
    if (!gproji_form_ready(form)) return gproj_form_error(form)->code;
    for (part = form->part; part; part = part->next)
        if (part->group == group && strcmp(gproj_system_group_info(form->system, group).name, "targets") == 0) break;
    if (!part || !positions)
        return gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_GROUP, group,
                           "group %d has no targets, or there are no positions", group);
    for (i = 0; i < part->count; ++i) {
        double p[3];
        gproji_to_internal(form, positions + 3 * (size_t)i, p);
        for (k = 0; k < 3; ++k) gproj_system_set_row(form->system, group, 3 * i + k, NULL, -p[k]);
    }
    return gproj_form_error(form)->code;
}

GPROJ_API int32_t gproj_add_closeness(gproj_form *form, double weight) {
    return gproji_add_points(form, gproji_new_selected_part(form, gproji_select_all), "closeness", GPROJ_WISH, NULL,
                             weight);
}

/* -- planar faces -- */

/* form->area at the system's x. */
GPROJI_INTERNAL void gproji_update_areas(gproj_form *form) {
    int32_t f;
    for (f = 0; f < form->mesh->face_count; ++f)
        gproji_area_vector(form->mesh, gproj_system_values(form->system), f, form->area + 3 * (size_t)f);
}

/* The unit sum of form->area over the faces around a vertex; e_z where that has no direction. */
GPROJI_INTERNAL void gproji_vertex_normal(const gproj_form *form, int32_t vertex, double out[3]) {
    static const double up[3] = {0, 0, 1};
    const gproj_mesh *mesh = form->mesh;
    int32_t start = mesh->vertex_halfedge[vertex], h = start;
    gproji_set3(0, 0, 0, out);
    do {
        if (mesh->face[h] >= 0) gproji_add_scaled3(1, form->area + 3 * (size_t)mesh->face[h], out);
        h = mesh->next[mesh->twin[h]];
    } while (h != start);
    gproji_normalise3(out, up);
}

/* The unit vector of form->area of a face; where it has none, the normal at its first vertex. */
GPROJI_INTERNAL void gproji_face_normal(const gproj_form *form, int32_t face, double out[3]) {
    static const double none[3] = {0, 0, 0};
    gproji_copy3(form->area + 3 * (size_t)face, out);
    if (gproji_length3(out) > 1e-12) {
        gproji_normalise3(out, none);
    } else {
        gproji_vertex_normal(form, form->mesh->origin[form->mesh->face_halfedge[face]], out);
    }
}

/* Gives the face a normal as variables n with the rows n'n = 1 and n'(v_i - v_j) = 0 for every edge. */
GPROJI_INTERNAL void gproji_add_normal(gproj_form *form, int32_t group, int32_t face) {
    const gproj_mesh *mesh = form->mesh;
    int32_t h = mesh->face_halfedge[face], n, c, k;
    double normal[3];
    gproj_term term[6];
    gproji_face_normal(form, face, normal);
    n = gproj_system_add_variables(form->system, 3, 3, normal);
    if (n < 0) return;
    form->normal[face] = n;
    for (k = 0; k < 3; ++k) gproji_set_term(&term[k], n + k, n + k, 1);
    gproj_system_add_row(form->system, group, 3, term, -1, face);
    for (c = 0; c < mesh->face_degree[face]; ++c, h = mesh->next[h]) {
        int32_t i = 3 * mesh->origin[h], j = 3 * mesh->origin[mesh->next[h]];
        for (k = 0; k < 3; ++k) {
            gproji_set_term(&term[k], n + k, i + k, 1);
            gproji_set_term(&term[3 + k], n + k, j + k, -1);
        }
        gproj_system_add_row(form->system, group, 6, term, 0, face);
    }
}

/* Room for the normals of all faces that have none yet. */
GPROJI_INTERNAL void gproji_expect_normals(gproj_form *form, int32_t group) {
    size_t faces = 0, corners = 0;
    int32_t f;
    for (f = 0; f < form->mesh->face_count; ++f)
        if (form->mesh->face_degree[f] > 3 && form->normal[f] < 0)
            ++faces, corners += (size_t)form->mesh->face_degree[f];
    gproji_expect_group(form, group, 3 * faces, faces + corners, 3 * faces + 6 * corners);
}

GPROJ_API int32_t gproj_add_planarity(gproj_form *form, double weight) {
    gproj_schedule schedule = {weight, 0, 0};
    int32_t group, f;
    if (!gproji_form_ready(form)) return -1;
    if (form->planarity >= 0) { /* there already: a new weight for it */
        gproj_system_set_schedule(form->system, form->planarity, schedule);
        return gproji_form_ready(form) ? form->planarity : -1;
    }
    group = gproji_new_group(form, "planarity", GPROJ_CONSTRAINT, GPROJ_PLACE_FACE, weight, NULL, NULL);
    gproji_update_areas(form);
    gproji_expect_normals(form, group);
    for (f = 0; f < form->mesh->face_count && gproji_form_ready(form); ++f)
        if (form->mesh->face_degree[f] > 3 && form->normal[f] < 0) gproji_add_normal(form, group, f);
    form->planarity = group;
    return gproji_form_ready(form) ? group : -1;
}

/* -- curves and surfaces -- */

/* How far p is along segment `segment` from its start, minus the segment's length if `from_end`. */
GPROJI_INTERNAL double gproji_along(const gproj_curve *curve, int32_t segment, const double p[3], bool from_end) {
    double d[3];
    gproji_sub3(p, curve->point + 3 * ((size_t)segment + from_end), d);
    return gproji_dot3(d, curve->tangent + 3 * (size_t)segment);
}

/* The segment after or before; -1 at an open end. */
GPROJI_INTERNAL int32_t gproji_next_segment(const gproj_curve *curve, int32_t segment, int32_t direction) {
    bool closed = memcmp(curve->point, curve->point + 3 * (size_t)curve->segment_count, 3 * sizeof(double)) == 0;
    segment += direction;
    if (segment >= 0 && segment < curve->segment_count) return segment;
    if (!closed) return -1;
    return segment < 0 ? curve->segment_count - 1 : 0;
}

/* Walks from a segment to the one on which p has its foot. Where p is in the wedge outside a vertex of the polyline,
   with its foot on neither side, it stays. */
GPROJI_INTERNAL int32_t gproji_walk(const gproj_curve *curve, int32_t segment, const double p[3]) {
    int32_t direction = gproji_along(curve, segment, p, true) > 0 ? 1 : -1, steps;
    for (steps = 0; steps < curve->segment_count; ++steps) {
        bool forward = direction > 0;
        double beyond = gproji_along(curve, segment, p, forward);
        int32_t next = gproji_next_segment(curve, segment, direction);
        if ((forward ? beyond <= 0 : beyond >= 0) || next < 0) break;
        beyond = gproji_along(curve, next, p, !forward);
        if (forward ? beyond < 0 : beyond > 0) break;
        segment = next;
    }
    return segment;
}

/* The three rows of a gliding vertex: it is on the line of its segment (2 rows orthogonal to the tangent), and, with
   weight only when it is pinned, at `end`. Everything in internal units. */
GPROJI_INTERNAL void gproji_set_gliding(gproj_system *system, int32_t group, int32_t first, const double tangent[3],
                                        const double end[3], bool pinned) {
    double basis[3][3];
    int32_t k;
    gproji_tangents3(tangent, basis[0], basis[1]);
    gproji_copy3(tangent, basis[2]);
    for (k = 0; k < 3; ++k) gproj_system_set_row(system, group, first + k, basis[k], -gproji_dot3(basis[k], end));
    gproj_system_set_row_weight(system, group, first + 2, pinned);
}

/* Does vertex i of a gliding part stay where it was? */
GPROJI_INTERNAL bool gproji_stays(const gproji_part *part, int32_t i) {
    return part->curve_of && part->curve_of[i] < 0;
}

/* Each vertex keeps to the line of a segment and walks to its neighbours. Late in the solve it stays on its segment,
   and is pinned to an end that it would leave: so it cannot hop between two segments for ever. */
GPROJI_INTERNAL void gproji_refresh_gliding(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    bool settled = system->late >= 2;
    int32_t i;
    for (i = 0; i < part->count; ++i) {
        const gproj_curve *curve = part->curve;
        const double *tangent;
        double p[3], end[3];
        bool after, before;
        if (gproji_stays(part, i)) continue;
        if (!curve) curve = part->own_curve[part->curve_of[i]];
        gproji_copy3(gproj_system_values(system) + 3 * (size_t)part->vertex[i], p);
        if (part->curve) gproji_from_internal(part->form, p, p);
        if (part->segment[i] < 0) {
            part->segment[i] = gproj_curve_closest(curve, p).segment;
        } else if (!settled) {
            part->segment[i] = gproji_walk(curve, part->segment[i], p);
        } else if (gproji_own_weight(&system->group[group], 3 * i + 2) > 0) {
            continue;
        }
        after = gproji_along(curve, part->segment[i], p, true) > 0;
        before = gproji_along(curve, part->segment[i], p, false) < 0;
        tangent = curve->tangent + 3 * (size_t)part->segment[i];
        gproji_copy3(curve->point + 3 * ((size_t)part->segment[i] + after), end);
        if (part->curve) gproji_to_internal(part->form, end, end);
        gproji_set_gliding(system, group, 3 * i, tangent, end, after || before);
    }
}

/* All vertices look for their segments anew. */
GPROJI_INTERNAL void gproji_restart_gliding(gproj_form *form) {
    gproji_part *part;
    int32_t i;
    for (part = form->part; part; part = part->next) {
        for (i = 0; part->segment && i < part->count; ++i) {
            if (gproji_stays(part, i)) continue;
            part->segment[i] = -1;
            gproj_system_set_row_weight(form->system, part->group, 3 * i + 2, 0);
        }
    }
}

GPROJI_INTERNAL int32_t gproji_add_gliding_part(gproj_form *form, gproji_part *part, const char *name, double weight) {
    static const double axis[3] = {1, 0, 0};
    int32_t i, k, c;
    part->segment = (int32_t *)gproji_take(&form->own, (size_t)part->count, sizeof *part->segment);
    if (!part->segment) {
        gproji_fail_memory(&form->error);
        return -1;
    }
    part->group =
        gproji_new_group(form, name, GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, weight, gproji_refresh_gliding, part);
    for (i = 0; i < part->count; ++i) {
        const double *place = form->original + 3 * (size_t)part->vertex[i];
        gproj_term term[3];
        part->segment[i] = -1;
        for (c = 0; c < 3; ++c) gproji_set_term(&term[c], 3 * part->vertex[i] + c, -1, 0);
        for (k = 0; k < 3; ++k) gproj_system_add_row(form->system, part->group, 3, term, 0, part->vertex[i]);
        if (gproji_form_ready(form))
            gproji_set_gliding(form->system, part->group, 3 * i, axis, place, gproji_stays(part, i));
    }
    return gproji_form_ready(form) ? part->group : -1;
}

GPROJ_API int32_t gproj_add_gliding(gproj_form *form, const gproj_curve *curve, int32_t count, const int32_t *vertices,
                                    double weight) {
    gproji_part *part = gproji_new_vertex_part(form, "gliding", count, vertices);
    if (!part) return -1;
    if (!curve) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "gliding: there is no curve");
        return -1;
    }
    part->curve = curve;
    return gproji_add_gliding_part(form, part, "gliding", weight);
}

/* The boundary loops of the original as curves in internal units. A loop without extent gives NULL. `points`: work, 3
   numbers a vertex of the mesh. */
GPROJI_INTERNAL bool gproji_take_loop_curves(gproj_form *form, gproji_part *part, double *points) {
    const gproj_mesh *mesh = form->mesh;
    int32_t l;
    for (l = 0; l < mesh->loop_count; ++l) {
        int32_t h = mesh->loop_halfedge[l], count = 0;
        gproj_error error;
        gproji_error_clear(&error);
        do {
            gproji_copy3(form->original + 3 * (size_t)mesh->origin[h], points + 3 * (size_t)count++);
            h = mesh->next[h];
        } while (h != mesh->loop_halfedge[l]);
        part->own_curve[l] = gproj_curve_create(count, points, true, &form->host, &error);
        if (part->own_curve[l] || error.code == GPROJ_ERROR_DEGENERATE) continue;
        gproji_fail(&form->error, error.code, error.place, error.index, "%s", error.message);
        return false;
    }
    return true;
}

/* The curve of each vertex of the part, -1 for those that stay: corners, and loops without extent. `loop_of`: work, one
   entry a vertex of the mesh. */
GPROJI_INTERNAL void gproji_assign_loops(const gproj_form *form, gproji_part *part, int32_t *loop_of) {
    const gproj_mesh *mesh = form->mesh;
    int32_t l, i;
    for (l = 0; l < mesh->loop_count; ++l) {
        int32_t h = mesh->loop_halfedge[l];
        do {
            loop_of[mesh->origin[h]] = part->own_curve[l] ? l : -1;
            h = mesh->next[h];
        } while (h != mesh->loop_halfedge[l]);
    }
    for (i = 0; i < part->count; ++i)
        part->curve_of[i] = gproj_form_is_corner(form, part->vertex[i]) ? -1 : loop_of[part->vertex[i]];
}

GPROJ_API int32_t gproj_add_gliding_boundary(gproj_form *form, double weight) {
    gproji_part *part = gproji_new_selected_part(form, gproji_select_boundary);
    size_t vertices;
    int32_t *loop_of;
    double *points;
    bool done = false;
    if (!part) return -1;
    vertices = (size_t)form->mesh->vertex_count;
    part->curve_count = form->mesh->loop_count;
    part->own_curve =
        (gproj_curve **)gproji_take_zeroed(&form->own, (size_t)part->curve_count, sizeof *part->own_curve);
    part->curve_of = (int32_t *)gproji_take(&form->own, (size_t)part->count, sizeof *part->curve_of);
    loop_of = (int32_t *)gproji_take(&form->own, vertices, sizeof *loop_of);
    points = (double *)gproji_take(&form->own, 3 * vertices, sizeof *points);
    if (part->own_curve && part->curve_of && loop_of && points) {
        done = gproji_take_loop_curves(form, part, points);
        if (done) gproji_assign_loops(form, part, loop_of);
    } else {
        gproji_fail_memory(&form->error);
    }
    gproji_give(&form->own, loop_of, vertices, sizeof *loop_of);
    gproji_give(&form->own, points, 3 * vertices, sizeof *points);
    return done ? gproji_add_gliding_part(form, part, "gliding boundary", weight) : -1;
}

/* The row n'(v - p) = 0 for each vertex: p the closest point of the surface, n its normal there. */
GPROJI_INTERNAL void gproji_refresh_reference(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    const double *x = gproj_system_values(system);
    int32_t i;
    for (i = 0; i < part->count; ++i) {
        double point[3];
        gproj_surface_hit hit;
        gproji_from_internal(part->form, x + 3 * (size_t)part->vertex[i], point);
        hit = gproj_surface_closest(part->surface, point);
        gproji_to_internal(part->form, hit.point, point);
        gproj_system_set_row(system, group, i, hit.normal, -gproji_dot3(hit.normal, point));
    }
}

GPROJ_API int32_t gproj_add_reference(gproj_form *form, const gproj_surface *surface, double weight) {
    gproji_part *part = gproji_new_selected_part(form, gproji_select_all);
    int32_t i, c;
    if (!part) return -1;
    if (!surface) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "reference: there is no surface");
        return -1;
    }
    part->surface = surface;
    part->group =
        gproji_new_group(form, "reference", GPROJ_WISH, GPROJ_PLACE_VERTEX, weight, gproji_refresh_reference, part);
    for (i = 0; i < part->count; ++i) {
        gproj_term term[3];
        for (c = 0; c < 3; ++c) gproji_set_term(&term[c], 3 * part->vertex[i] + c, -1, 0);
        gproj_system_add_row(form->system, part->group, 3, term, 0, part->vertex[i]);
    }
    return gproji_form_ready(form) ? part->group : -1;
}

/* -- fairness -- */

/* One second difference: centre - sum of `neighbour` / count, of points (vertices or normals) given by their first
   variables. */
typedef struct gproji_difference {
    int32_t centre;
    int32_t count;
    const int32_t *neighbour;
} gproji_difference;

/* The three rows of a difference, one a coordinate. `term`: room for count + 1 terms. */
GPROJI_INTERNAL void gproji_add_difference(gproj_form *form, int32_t group, const gproji_difference *d, int32_t element,
                                           gproj_term *term) {
    int32_t k, i;
    for (k = 0; k < 3; ++k) {
        gproji_set_term(&term[0], d->centre + k, -1, 1);
        for (i = 0; i < d->count; ++i) gproji_set_term(&term[i + 1], d->neighbour[i] + k, -1, -1.0 / d->count);
        gproj_system_add_row(form->system, group, d->count + 1, term, 0, element);
    }
}

/* The same seen in a tangent plane: two rows whose coefficients the refresh fills in. `term`: 3 (count + 1). */
GPROJI_INTERNAL void gproji_add_tangential_difference(gproj_form *form, int32_t group, const gproji_difference *d,
                                                      int32_t element, gproj_term *term) {
    int32_t k, i;
    for (i = 0; i <= d->count; ++i)
        for (k = 0; k < 3; ++k)
            gproji_set_term(&term[3 * i + k], (i == 0 ? d->centre : d->neighbour[i - 1]) + k, -1, 0);
    for (k = 0; k < 2; ++k) gproj_system_add_row(form->system, group, 3 * (d->count + 1), term, 0, element);
}

typedef void (*gproji_add_one_difference)(gproj_form *form, int32_t group, const gproji_difference *d, int32_t element,
                                          gproj_term *term);

/* The differences of a point with its cyclic neighbours: opposite pairs where there are four, else the mean of all
   (paper 3.2). Returns how many differences there are. */
GPROJI_INTERNAL int32_t gproji_add_ring_differences(gproj_form *form, int32_t group, int32_t centre, int32_t *ring,
                                                    int32_t count, int32_t element, gproj_term *term,
                                                    gproji_add_one_difference add) {
    gproji_difference d;
    int32_t pairs[4];
    d.centre = centre;
    d.count = count;
    d.neighbour = ring;
    if (count == 4) {
        pairs[0] = ring[0], pairs[1] = ring[2], pairs[2] = ring[1], pairs[3] = ring[3];
        d.count = 2;
        d.neighbour = pairs;
        add(form, group, &d, element, term);
        d.neighbour = pairs + 2;
    }
    add(form, group, &d, element, term);
    return count == 4 ? 2 : 1;
}

/* Room for the terms of the largest difference of this mesh. */
GPROJI_INTERNAL gproj_term *gproji_take_terms(gproj_form *form) {
    gproj_term *term = (gproj_term *)gproji_take(&form->own, 3 * ((size_t)form->ring_size + 1), sizeof *term);
    if (!term) gproji_fail_memory(&form->error);
    return term;
}

GPROJI_INTERNAL void gproji_give_terms(gproj_form *form, gproj_term *term) {
    gproji_give(&form->own, term, 3 * ((size_t)form->ring_size + 1), sizeof *term);
}

/* The neighbours of an interior vertex by their first variables; 0 for other vertices. */
GPROJI_INTERNAL int32_t gproji_vertex_ring(gproj_form *form, int32_t vertex) {
    int32_t count, i;
    if (form->mesh->vertex_halfedge[vertex] < 0 || gproj_mesh_is_boundary_vertex(form->mesh, vertex)) return 0;
    count = gproj_mesh_one_ring(form->mesh, vertex, form->ring, form->ring_size);
    for (i = 0; i < count; ++i) form->ring[i] *= 3;
    return count;
}

GPROJI_INTERNAL void gproji_add_boundary_differences(gproj_form *form, int32_t group, gproj_term *term) {
    const gproj_mesh *mesh = form->mesh;
    int32_t v;
    for (v = 0; v < mesh->vertex_count; ++v) {
        gproji_difference d;
        int32_t pair[2], h;
        if (!gproji_select_gliding(form, v)) continue;
        h = mesh->vertex_halfedge[v];
        pair[0] = 3 * mesh->origin[mesh->prev[h]];
        pair[1] = 3 * mesh->origin[mesh->twin[h]];
        d.centre = 3 * v;
        d.count = 2;
        d.neighbour = pair;
        gproji_add_difference(form, group, &d, v, term);
    }
}

GPROJ_API int32_t gproj_add_boundary_fairness(gproj_form *form, double weight) {
    gproj_term *term;
    int32_t group;
    if (!gproji_form_ready(form)) return -1;
    group = gproji_new_group(form, "boundary fairness", GPROJ_WISH, GPROJ_PLACE_VERTEX, weight, NULL, NULL);
    term = gproji_take_terms(form);
    if (!term) return -1;
    gproji_add_boundary_differences(form, group, term);
    gproji_give_terms(form, term);
    return gproji_form_ready(form) ? group : -1;
}

GPROJ_API int32_t gproj_add_fairness(gproj_form *form, double weight) {
    gproj_term *term;
    int32_t group, v;
    size_t vertices;
    if (!gproji_form_ready(form)) return -1;
    vertices = (size_t)form->mesh->vertex_count;
    group = gproji_new_group(form, "fairness", GPROJ_WISH, GPROJ_PLACE_VERTEX, weight, NULL, NULL);
    gproji_expect_group(form, group, 0, 6 * vertices, 3 * (2 * (size_t)form->mesh->edge_count + 2 * vertices));
    term = gproji_take_terms(form);
    if (!term) return -1;
    for (v = 0; v < form->mesh->vertex_count; ++v) {
        int32_t count = gproji_vertex_ring(form, v);
        if (count) gproji_add_ring_differences(form, group, 3 * v, form->ring, count, v, term, gproji_add_difference);
    }
    gproji_add_boundary_differences(form, group, term);
    gproji_give_terms(form, term);
    return gproji_form_ready(form) ? group : -1;
}

/* Fills in rows `row` and `row` + 1: u' and w' of a difference, u, w spanning the plane orthogonal to `normal`. */
GPROJI_INTERNAL void gproji_refresh_difference(gproj_system *system, int32_t group, int32_t row,
                                               const double normal[3]) {
    double basis[2][3];
    int32_t i, k, c;
    gproji_tangents3(normal, basis[0], basis[1]);
    for (k = 0; k < 2; ++k) {
        int32_t terms;
        gproj_term *term = gproji_row_terms(system, group, row + k, &terms);
        int32_t count = terms / 3 - 1; /* neighbours */
        for (i = 0; i <= count; ++i)
            for (c = 0; c < 3; ++c) term[3 * i + c].a = basis[k][c] * (i == 0 ? 1.0 : -1.0 / count);
    }
}

/* One part for differences in tangent planes: part->vertex names the vertex or face of each. */
GPROJI_INTERNAL void gproji_note_differences(gproji_part *part, int32_t element, int32_t count) {
    while (count-- > 0) part->vertex[part->count++] = element;
}

GPROJI_INTERNAL void gproji_refresh_tangential(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    double normal[3] = {0, 0, 1};
    int32_t i;
    gproji_update_areas(part->form);
    for (i = 0; i < part->count; ++i) {
        if (i == 0 || part->vertex[i] != part->vertex[i - 1]) gproji_vertex_normal(part->form, part->vertex[i], normal);
        gproji_refresh_difference(system, group, 2 * i, normal);
    }
}

GPROJ_API int32_t gproj_add_tangential_fairness(gproj_form *form, double weight) {
    gproji_part *part;
    gproj_term *term;
    int32_t v;
    if (!form || !gproji_form_ready(form)) return -1;
    part = gproji_new_part(form, 2 * form->mesh->vertex_count);
    term = part ? gproji_take_terms(form) : NULL;
    if (!term) return -1;
    part->count = 0;
    part->group = gproji_new_group(form, "tangential fairness", GPROJ_WISH, GPROJ_PLACE_VERTEX, weight,
                                   gproji_refresh_tangential, part);
    for (v = 0; v < form->mesh->vertex_count; ++v) {
        int32_t count = gproji_vertex_ring(form, v);
        if (count == 0) continue;
        count = gproji_add_ring_differences(form, part->group, 3 * v, form->ring, count, v, term,
                                            gproji_add_tangential_difference);
        gproji_note_differences(part, v, count);
    }
    gproji_give_terms(form, term);
    return gproji_form_ready(form) ? part->group : -1;
}

GPROJI_INTERNAL void gproji_refresh_gauss(void *user, gproj_system *system, int32_t group) {
    static const double up[3] = {0, 0, 1};
    const gproji_part *part = (const gproji_part *)user;
    int32_t i;
    for (i = 0; i < part->count; ++i) {
        double normal[3];
        gproji_copy3(gproj_system_values(system) + part->form->normal[part->vertex[i]], normal);
        gproji_normalise3(normal, up);
        gproji_refresh_difference(system, group, 2 * i, normal);
    }
}

/* The differences of face `face` in the Gauss image: with all its neighbours where they all exist, else with opposite
   neighbours of a quad. Returns how many there are. */
GPROJI_INTERNAL int32_t gproji_add_gauss_differences(gproj_form *form, int32_t group, int32_t face, gproj_term *term) {
    const gproj_mesh *mesh = form->mesh;
    int32_t h = mesh->face_halfedge[face], degree = mesh->face_degree[face], count = 0, k, added = 0;
    for (k = 0; k < degree; ++k, h = mesh->next[h]) {
        int32_t neighbour = mesh->face[mesh->twin[h]];
        form->ring[k] = neighbour < 0 ? -1 : form->normal[neighbour];
        count += neighbour >= 0;
    }
    if (count == degree)
        return gproji_add_ring_differences(form, group, form->normal[face], form->ring, degree, face, term,
                                           gproji_add_tangential_difference);
    for (k = 0; degree == 4 && k < 2; ++k) {
        gproji_difference d;
        int32_t pair[2];
        pair[0] = form->ring[k];
        pair[1] = form->ring[k + 2];
        if (pair[0] < 0 || pair[1] < 0) continue;
        d.centre = form->normal[face];
        d.count = 2;
        d.neighbour = pair;
        gproji_add_tangential_difference(form, group, &d, face, term);
        added++;
    }
    return added;
}

/* Triangles have no normals as variables until something needs them. Other faces get theirs from the planarity. */
GPROJI_INTERNAL bool gproji_add_missing_normals(gproj_form *form, const char *name) {
    int32_t f, group = -1;
    gproji_update_areas(form);
    for (f = 0; f < form->mesh->face_count && gproji_form_ready(form); ++f) {
        if (form->normal[f] >= 0) continue;
        if (form->mesh->face_degree[f] > 3) {
            gproji_fail(&form->error, GPROJ_ERROR_STATE, GPROJ_PLACE_FACE, f,
                        "%s needs the normals of planar faces: call gproj_add_planarity before", name);
            return false;
        }
        if (group < 0)
            group = gproji_new_group(form, "triangle normals", GPROJ_CONSTRAINT, GPROJ_PLACE_FACE, 1, NULL, NULL);
        gproji_add_normal(form, group, f);
    }
    return gproji_form_ready(form);
}

GPROJ_API int32_t gproj_add_gauss_fairness(gproj_form *form, double weight) {
    gproji_part *part;
    gproj_term *term;
    int32_t f;
    if (!form || !gproji_form_ready(form) || !gproji_add_missing_normals(form, "Gauss image fairness")) return -1;
    part = gproji_new_part(form, 2 * form->mesh->face_count);
    term = part ? gproji_take_terms(form) : NULL;
    if (!term) return -1;
    part->count = 0;
    part->group = gproji_new_group(form, "Gauss image fairness", GPROJ_WISH, GPROJ_PLACE_FACE, weight,
                                   gproji_refresh_gauss, part);
    for (f = 0; f < form->mesh->face_count; ++f)
        gproji_note_differences(part, f, gproji_add_gauss_differences(form, part->group, f, term));
    gproji_give_terms(form, term);
    return gproji_form_ready(form) ? part->group : -1;
}

GPROJ_API gproj_code gproj_set_schedule(gproj_form *form, int32_t group, gproj_schedule schedule) {
    if (!form) return GPROJ_ERROR_ARGUMENT;
    if (!gproji_form_ready(form)) return gproj_form_error(form)->code;
    return gproj_system_set_schedule(form->system, group, schedule);
}

GPROJ_API gproj_group_info gproj_form_group_info(const gproj_form *form, int32_t group) {
    return gproj_system_group_info(form ? form->system : NULL, group);
}

/* How many elements of this kind the mesh has; 0 for what is no part of a mesh. */
GPROJI_INTERNAL int32_t gproji_element_count(const gproj_mesh *mesh, gproj_place place) {
    switch (place) {
    case GPROJ_PLACE_VERTEX: return mesh->vertex_count;
    case GPROJ_PLACE_EDGE: return mesh->edge_count;
    case GPROJ_PLACE_FACE: return mesh->face_count;
    default: return 0;
    }
}

/* Refuses lists of elements and weights that do not fit the group. */
GPROJI_INTERNAL bool gproji_element_weights_are_valid(gproj_form *form, int32_t group, int32_t count,
                                                      const int32_t *elements, const double *weights) {
    gproj_group_info info = gproj_system_group_info(form->system, group);
    int32_t have = gproji_element_count(form->mesh, info.place), k;
    if (!gproji_system_has_group(form->system, group)) {
        gproji_fail(&form->error, GPROJ_ERROR_INDEX, GPROJ_PLACE_GROUP, group,
                    "element weights: there is no group %d (the form has %d)", group, form->system->group_count);
        return false;
    }
    if (count < 0 || (count > 0 && !weights) || (!elements && count > have)) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_GROUP, group,
                    "element weights: %d of the %d elements of group '%s', or no weights", count, have, info.name);
        return false;
    }
    for (k = 0; k < count; ++k) {
        int32_t element = elements ? elements[k] : k;
        if (element < 0 || element >= have)
            gproji_fail(&form->error, GPROJ_ERROR_INDEX, info.place, element,
                        "element weights: there is no %s %d (the mesh has %d, counted from 0)",
                        gproji_place_word(info.place), element, have);
        else if (!(weights[k] >= 0 && weights[k] <= 1e50))
            gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, info.place, element,
                        "element weights: the weight %g of %s %d in group '%s' is not in 0..1e50", weights[k],
                        gproji_place_word(info.place), element, info.name);
        if (form->error.code != GPROJ_OK) return false;
    }
    return true;
}

GPROJ_API gproj_code gproj_set_element_weights(gproj_form *form, int32_t group, int32_t count, const int32_t *elements,
                                               const double *weights) {
    int32_t have, k;
    double *of; /* of each element the new weight; -1: as it was */
    gproji_group *g;
    if (!form) return GPROJ_ERROR_ARGUMENT;
    if (!gproji_form_ready(form)) return gproj_form_error(form)->code;
    if (!gproji_element_weights_are_valid(form, group, count, elements, weights)) return form->error.code;
    g = &form->system->group[group];
    have = gproji_element_count(form->mesh, g->place);
    of = (double *)gproji_take(&form->own, (size_t)have, sizeof *of);
    if (!of || !gproji_share_weights(form->system, g)) {
        gproji_give(&form->own, of, (size_t)have, sizeof *of);
        return gproji_fail_memory(&form->error);
    }
    for (k = 0; k < have; ++k) of[k] = -1;
    for (k = 0; k < count; ++k) of[elements ? elements[k] : k] = weights[k];
    for (k = 0; k < g->row_count; ++k) {
        gproji_row *row = &g->row[k];
        if (row->element < 0 || row->element >= have || of[row->element] < 0) continue;
        g->share[k].factor = of[row->element];
        row->weight = g->share[k].own * g->share[k].factor;
    }
    gproji_give(&form->own, of, (size_t)have, sizeof *of);
    form->system->changed = true;
    return GPROJ_OK;
}

/* -- lengths of edges -- */

/* Refuses lists that are no elements (edges, faces) of the mesh, which has `have` of them. */
GPROJI_INTERNAL bool gproji_elements_are_valid(gproj_form *form, const char *name, gproj_place place, int32_t have,
                                               int32_t count, const int32_t *elements) {
    const char *word = gproji_place_word(place);
    int32_t i;
    if (count < 0 || (!elements && count > have)) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "%s: %d %ss of %d", name, count, word,
                    have);
        return false;
    }
    for (i = 0; elements && i < count; ++i) {
        if (elements[i] >= 0 && elements[i] < have) continue;
        gproji_fail(&form->error, GPROJ_ERROR_INDEX, place, elements[i],
                    "%s: there is no %s %d (the mesh has %d, counted from 0)", name, word, elements[i], have);
        return false;
    }
    return true;
}

GPROJI_INTERNAL bool gproji_edges_are_valid(gproj_form *form, const char *name, int32_t count, const int32_t *edges) {
    return gproji_elements_are_valid(form, name, GPROJ_PLACE_EDGE, form->mesh->edge_count, count, edges);
}

GPROJI_INTERNAL bool gproji_faces_are_valid(gproj_form *form, const char *name, int32_t count, const int32_t *faces) {
    return gproji_elements_are_valid(form, name, GPROJ_PLACE_FACE, form->mesh->face_count, count, faces);
}

/* The terms of scale |v_i - v_j|^2 for the ends of an edge: 9 of them. */
GPROJI_INTERNAL void gproji_set_length_terms(const gproj_mesh *mesh, int32_t edge, double scale, gproj_term *term) {
    int32_t i = 3 * mesh->origin[2 * edge], j = 3 * mesh->origin[2 * edge + 1], k;
    for (k = 0; k < 3; ++k) {
        gproji_set_term(&term[3 * k], i + k, i + k, scale);
        gproji_set_term(&term[3 * k + 1], j + k, j + k, scale);
        gproji_set_term(&term[3 * k + 2], i + k, j + k, -2 * scale);
    }
}

/* The length of an edge of the original, in internal units. */
GPROJI_INTERNAL double gproji_original_length(const gproj_form *form, int32_t edge) {
    const int32_t *origin = form->mesh->origin + 2 * (size_t)edge;
    return gproji_distance3(form->original + 3 * (size_t)origin[0], form->original + 3 * (size_t)origin[1]);
}

GPROJ_API int32_t gproj_add_lengths(gproj_form *form, int32_t count, const int32_t *edges, const double *lengths,
                                    double weight) {
    int32_t group, k;
    if (!gproji_form_ready(form) || !gproji_edges_are_valid(form, "lengths", count, edges)) return -1;
    group = gproji_new_group(form, "lengths", GPROJ_CONSTRAINT, GPROJ_PLACE_EDGE, weight, NULL, NULL);
    for (k = 0; k < count && gproji_form_ready(form); ++k) {
        int32_t edge = edges ? edges[k] : k;
        double length = lengths ? lengths[k] * form->scale : gproji_original_length(form, edge);
        gproj_term term[9];
        if (!(length > 0) || !gproji_is_finite(length)) {
            gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_EDGE, edge,
                        "lengths: edge %d would have the length %g, which is not > 0", edge, length / form->scale);
            return -1;
        }
        gproji_set_length_terms(form->mesh, edge, 0.5 / length, term);
        gproj_system_add_row(form->system, group, 9, term, -length / 2, edge);
    }
    return gproji_form_ready(form) ? group : -1;
}

GPROJ_API int32_t gproj_add_equal_lengths(gproj_form *form, int32_t count, const int32_t *edges, double weight) {
    int32_t group, common, k;
    double mean = 0;
    if (!gproji_form_ready(form) || !gproji_edges_are_valid(form, "equal lengths", count, edges)) return -1;
    for (k = 0; k < count; ++k) mean += gproji_original_length(form, edges ? edges[k] : k) / count;
    common = gproj_system_add_variables(form->system, 1, 1, &mean);
    group = gproji_new_group(form, "equal lengths", GPROJ_CONSTRAINT, GPROJ_PLACE_EDGE, weight, NULL, NULL);
    for (k = 0; k < count && gproji_form_ready(form); ++k) {
        int32_t edge = edges ? edges[k] : k;
        gproj_term term[10];
        gproji_set_length_terms(form->mesh, edge, 0.5, term);
        gproji_set_term(&term[9], common, common, -0.5);
        gproj_system_add_row(form->system, group, 10, term, 0, edge);
    }
    return gproji_form_ready(form) ? group : -1;
}

/* -- vertices on unknown planes and lines -- */

/* The mean of points x[3 v] for `count` vertices v, and unit vectors along, across, flat in the directions in which
   they scatter most, less and least. */
GPROJI_INTERNAL void gproji_fit_points(const double *x, int32_t count, const int32_t *vertices, double mean[3],
                                       double along[3], double across[3], double flat[3]) {
    double scatter[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, d[3], u[3], v[3], uu = 0, uv = 0, vv = 0, angle;
    int32_t k, i, j;
    gproji_set3(0, 0, 0, mean);
    for (k = 0; k < count; ++k) gproji_add_scaled3(1.0 / count, x + 3 * (size_t)vertices[k], mean);
    for (k = 0; k < count; ++k) {
        gproji_sub3(x + 3 * (size_t)vertices[k], mean, d);
        for (i = 0; i < 3; ++i)
            for (j = 0; j < 3; ++j) scatter[i][j] += d[i] * d[j];
    }
    gproji_largest_eigenvector3(scatter, along);
    gproji_tangents3(along, u, v);
    for (k = 0; k < count; ++k) {
        gproji_sub3(x + 3 * (size_t)vertices[k], mean, d);
        uu += gproji_dot3(d, u) * gproji_dot3(d, u);
        uv += gproji_dot3(d, u) * gproji_dot3(d, v);
        vv += gproji_dot3(d, v) * gproji_dot3(d, v);
    }
    angle = 0.5 * atan2(2 * uv, uu - vv);
    for (k = 0; k < 3; ++k) {
        across[k] = cos(angle) * u[k] + sin(angle) * v[k];
        flat[k] = cos(angle) * v[k] - sin(angle) * u[k];
    }
}

/* The mean of the originals of `count` vertices. */
GPROJI_INTERNAL void gproji_original_mean(const gproj_form *form, int32_t count, const int32_t *vertices,
                                          double mean[3]) {
    int32_t k;
    gproji_set3(0, 0, 0, mean);
    for (k = 0; k < count; ++k) gproji_add_scaled3(1.0 / count, form->original + 3 * (size_t)vertices[k], mean);
}

/* The planes n'(v - m) = d through the points x[3 v] of these vertices that fit best, 4 numbers each: n, d; m is the
   mean of their originals. One plane, or two at right angles whose line fits best. */
GPROJI_INTERNAL void gproji_fit_planes(const gproj_form *form, int32_t planes, int32_t count, const int32_t *vertices,
                                       double plane[8]) {
    const double *x = gproj_system_values(form->system);
    double mean[3], middle[3], along[3], across[3], flat[3];
    int32_t p;
    gproji_fit_points(x, count, vertices, mean, along, across, flat);
    gproji_original_mean(form, count, vertices, middle);
    gproji_sub3(mean, middle, mean);
    for (p = 0; p < planes; ++p) {
        gproji_copy3(p ? across : flat, plane + 4 * p);
        plane[4 * p + 3] = gproji_dot3(plane + 4 * p, mean);
    }
}

/* The rows n_p'n_q = 1 or 0 of the planes whose variables begin at `first`. */
GPROJI_INTERNAL void gproji_add_plane_normals(gproj_form *form, int32_t group, int32_t planes, int32_t first,
                                              int32_t vertex) {
    int32_t p, q, k;
    for (p = 0; p < planes; ++p) {
        for (q = 0; q <= p; ++q) {
            gproj_term term[3];
            for (k = 0; k < 3; ++k) gproji_set_term(&term[k], first + 4 * q + k, first + 4 * p + k, 1);
            gproj_system_add_row(form->system, group, 3, term, p == q ? -1 : 0, vertex);
        }
    }
}

/* The vertices from..part->count-1 of the part get their plane or planes: variables, and the rows n'(v - m) - d = 0.
   Those of a set too small to leave a plane, or a line, get none. */
GPROJI_INTERNAL void gproji_add_plane_set(gproj_form *form, gproji_part *part, int32_t from) {
    const int32_t *vertex = part->vertex + from;
    int32_t count = part->count - from, first = -1, i, p, k;
    double plane[8], middle[3];
    if (count > (part->planes == 1 ? 3 : 2)) {
        gproji_fit_planes(form, part->planes, count, vertex, plane);
        gproji_original_mean(form, count, vertex, middle);
        first = gproj_system_add_variables(form->system, 4 * part->planes, 4, plane);
    }
    for (i = 0; i < count; ++i) part->plane[from + i] = first;
    if (first < 0) return;
    gproji_add_plane_normals(form, part->group, part->planes, first, vertex[0]);
    for (i = 0; i < count; ++i) {
        for (p = 0; p < part->planes; ++p) {
            gproj_term term[7];
            for (k = 0; k < 3; ++k) {
                gproji_set_term(&term[2 * k], 3 * vertex[i] + k, first + 4 * p + k, 1);
                gproji_set_term(&term[2 * k + 1], first + 4 * p + k, -1, -middle[k]);
            }
            gproji_set_term(&term[6], first + 4 * p + 3, -1, -1);
            gproj_system_add_row(form->system, part->group, 7, term, 0, vertex[i]);
        }
    }
}

/* Planes and lines begin a solve where they fit the vertices best. */
GPROJI_INTERNAL void gproji_restart_planes(gproj_form *form) {
    gproji_part *part;
    int32_t from, to;
    for (part = form->part; part; part = part->next) {
        for (from = 0; part->plane && from < part->count; from = to) {
            double plane[8];
            for (to = from + 1; to < part->count && part->plane[to] == part->plane[from]; ++to) continue;
            if (part->plane[from] < 0) continue;
            gproji_fit_planes(form, part->planes, to - from, part->vertex + from, plane);
            memcpy(gproj_system_values(form->system) + part->plane[from], plane,
                   4 * (size_t)part->planes * sizeof *plane);
        }
    }
}

/* Makes a part one of planes (1) or lines (2) with a group that has no rows yet. */
GPROJI_INTERNAL bool gproji_begin_planes(gproj_form *form, gproji_part *part, int32_t planes, const char *name,
                                         double weight) {
    if (!part) return false;
    part->plane = (int32_t *)gproji_take(&form->own, (size_t)part->capacity, sizeof *part->plane);
    if (!part->plane) {
        gproji_fail_memory(&form->error);
        return false;
    }
    part->planes = planes;
    part->group = gproji_new_group(form, name, GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, weight, NULL, NULL);
    return gproji_form_ready(form);
}

GPROJ_API int32_t gproj_add_coplanar(gproj_form *form, int32_t count, const int32_t *vertices, double weight) {
    gproji_part *part = gproji_new_vertex_part(form, "coplanar", count, vertices);
    if (!gproji_begin_planes(form, part, 1, "coplanar", weight)) return -1;
    gproji_add_plane_set(form, part, 0);
    return gproji_form_ready(form) ? part->group : -1;
}

GPROJ_API int32_t gproj_add_collinear(gproj_form *form, int32_t count, const int32_t *vertices, double weight) {
    gproji_part *part = gproji_new_vertex_part(form, "collinear", count, vertices);
    if (!gproji_begin_planes(form, part, 2, "collinear", weight)) return -1;
    gproji_add_plane_set(form, part, 0);
    return gproji_form_ready(form) ? part->group : -1;
}

/* The corners of a boundary loop; with any, *start becomes the half-edge that leaves one of them. */
GPROJI_INTERNAL int32_t gproji_loop_corners(const gproj_form *form, int32_t loop, int32_t *start) {
    const gproj_mesh *mesh = form->mesh;
    int32_t h = mesh->loop_halfedge[loop], corners = 0;
    *start = h;
    do {
        if (gproj_form_is_corner(form, mesh->origin[h])) *start = h, ++corners;
        h = mesh->next[h];
    } while (h != mesh->loop_halfedge[loop]);
    return corners;
}

/* The sets of a boundary loop: from corner to corner, or the whole loop where there is none. */
GPROJI_INTERNAL void gproji_add_loop_sets(gproj_form *form, gproji_part *part, int32_t loop) {
    const gproj_mesh *mesh = form->mesh;
    int32_t start, corners = gproji_loop_corners(form, loop, &start), h = start, from = part->count;
    if (part->planes == 2 && corners < 3) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_VERTEX, mesh->origin[h],
                    "straight boundary: the boundary through vertex %d has %d corners, and needs 3 to be straight "
                    "between them",
                    mesh->origin[h], corners);
        return;
    }
    do {
        part->vertex[part->count++] = mesh->origin[h];
        h = mesh->next[h];
        if (corners > 0 && gproj_form_is_corner(form, mesh->origin[h])) {
            part->vertex[part->count++] = mesh->origin[h];
            gproji_add_plane_set(form, part, from);
            from = part->count;
        }
    } while (h != start);
    if (corners == 0) gproji_add_plane_set(form, part, from);
}

GPROJI_INTERNAL int32_t gproji_add_boundary_sets(gproj_form *form, int32_t planes, const char *name, double weight) {
    gproji_part *part;
    int32_t v, most = 0, loop;
    if (!gproji_form_ready(form)) return -1;
    for (v = 0; v < form->mesh->vertex_count; ++v)
        most += gproji_select_boundary(form, v) + gproj_form_is_corner(form, v);
    part = gproji_new_part(form, most);
    if (!gproji_begin_planes(form, part, planes, name, weight)) return -1;
    part->count = 0;
    for (loop = 0; loop < form->mesh->loop_count && gproji_form_ready(form); ++loop)
        gproji_add_loop_sets(form, part, loop);
    return gproji_form_ready(form) ? part->group : -1;
}

GPROJ_API int32_t gproj_add_planar_boundary(gproj_form *form, double weight) {
    return gproji_add_boundary_sets(form, 1, "planar boundary", weight);
}

GPROJ_API int32_t gproj_add_straight_boundary(gproj_form *form, double weight) {
    return gproji_add_boundary_sets(form, 2, "straight boundary", weight);
}

/* -- directions of edges, lifting -- */

GPROJ_API int32_t gproj_add_orthogonal_edges(gproj_form *form, const double normal[3], int32_t count,
                                             const int32_t *edges, double weight) {
    static const double none[3] = {0, 0, 0};
    double n[3] = {0, 0, 0}, across[2][3];
    int32_t group, i, k, c;
    if (!gproji_form_ready(form) || !gproji_edges_are_valid(form, "orthogonal edges", count, edges)) return -1;
    if (normal) gproji_copy3(normal, n);
    if (!gproji_normalise3(n, none) || !gproji_is_finite(gproji_length3(n))) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "orthogonal edges: the normal has no direction");
        return -1;
    }
    gproji_tangents3(n, across[0], across[1]);
    group = gproji_new_group(form, "orthogonal edges", GPROJ_CONSTRAINT, GPROJ_PLACE_EDGE, weight, NULL, NULL);
    for (i = 0; i < 2 * count && gproji_form_ready(form); ++i) {
        int32_t edge = edges ? edges[i / 2] : i / 2;
        gproj_term term[6];
        for (k = 0; k < 2; ++k)
            for (c = 0; c < 3; ++c)
                gproji_set_term(&term[3 * k + c], 3 * form->mesh->origin[2 * edge + k] + c, -1,
                                k ? across[i % 2][c] : -across[i % 2][c]);
        gproj_system_add_row(form->system, group, 6, term, 0, edge);
    }
    return gproji_form_ready(form) ? group : -1;
}

GPROJ_API int32_t gproj_add_orthogonal_boundary(gproj_form *form, double weight) {
    int32_t group, v, k, ring[3];
    if (!gproji_form_ready(form)) return -1;
    group = gproji_new_group(form, "orthogonal boundary", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, weight, NULL, NULL);
    for (v = 0; v < form->mesh->vertex_count && gproji_form_ready(form); ++v) {
        gproj_term term[12]; /* ring: along the boundary the first and the last */
        if (!gproji_select_gliding(form, v) || gproj_mesh_one_ring(form->mesh, v, ring, 3) != 3) continue;
        for (k = 0; k < 3; ++k) {
            gproji_set_term(&term[4 * k], 3 * ring[1] + k, 3 * ring[2] + k, 0.5);
            gproji_set_term(&term[4 * k + 1], 3 * ring[1] + k, 3 * ring[0] + k, -0.5);
            gproji_set_term(&term[4 * k + 2], 3 * v + k, 3 * ring[2] + k, -0.5);
            gproji_set_term(&term[4 * k + 3], 3 * v + k, 3 * ring[0] + k, 0.5);
        }
        gproj_system_add_row(form->system, group, 12, term, 0, v);
    }
    return gproji_form_ready(form) ? group : -1;
}

GPROJ_API int32_t gproj_add_lifting(gproj_form *form, double weight) {
    int32_t group, i;
    if (!gproji_form_ready(form)) return -1;
    group = gproji_new_group(form, "lifting", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, weight, NULL, NULL);
    for (i = 0; i < 3 * form->mesh->vertex_count && gproji_form_ready(form); ++i) {
        gproj_term term;
        if (i % 3 == 2) continue;
        gproji_set_term(&term, i, -1, 1);
        gproj_system_add_row(form->system, group, 1, &term, -form->original[i], i / 3);
    }
    return gproji_form_ready(form) ? group : -1;
}

/* -- shapes of faces, areas, volume -- */

/* Where the axis points of circular faces start: the circumcentre at the system's x, else the mean. */
GPROJI_INTERNAL void gproji_start_axis_point(const gproj_form *form, int32_t face, double out[3]) {
    const gproj_mesh *mesh = form->mesh;
    const double *x = gproj_system_values(form->system);
    double mean[3] = {0, 0, 0}, normal[3];
    int32_t h = mesh->face_halfedge[face], k;
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h])
        gproji_add_scaled3(1.0 / mesh->face_degree[face], x + 3 * (size_t)mesh->origin[h], mean);
    gproji_face_normal(form, face, normal);
    gproji_circumcentre(mesh, x, face, mean, normal, out);
}

/* The row |v_j|^2/2 - |v_i|^2/2 - c'(v_j - v_i) = 0 of an edge, c the variables from `axis` on. */
GPROJI_INTERNAL void gproji_add_axis_row(gproj_form *form, int32_t group, int32_t face, int32_t axis,
                                         int32_t halfedge) {
    const gproj_mesh *mesh = form->mesh;
    int32_t i = 3 * mesh->origin[halfedge], j = 3 * mesh->origin[mesh->next[halfedge]], k;
    gproj_term term[12];
    for (k = 0; k < 3; ++k) {
        gproji_set_term(&term[4 * k], j + k, j + k, 0.5);
        gproji_set_term(&term[4 * k + 1], i + k, i + k, -0.5);
        gproji_set_term(&term[4 * k + 2], axis + k, j + k, -1);
        gproji_set_term(&term[4 * k + 3], axis + k, i + k, 1);
    }
    gproj_system_add_row(form->system, group, 12, term, 0, face);
}

GPROJ_API int32_t gproj_add_circularity(gproj_form *form, double weight) {
    int32_t group, f, k, h;
    if (!gproji_form_ready(form)) return -1;
    if (!form->axis) {
        form->axis = (int32_t *)gproji_take(&form->own, (size_t)form->mesh->face_count, sizeof *form->axis);
        if (!form->axis) {
            gproji_fail_memory(&form->error);
            return -1;
        }
        for (f = 0; f < form->mesh->face_count; ++f) form->axis[f] = -1;
    }
    group = gproji_new_group(form, "circularity", GPROJ_CONSTRAINT, GPROJ_PLACE_FACE, weight, NULL, NULL);
    gproji_update_areas(form);
    for (f = 0; f < form->mesh->face_count && gproji_form_ready(form); ++f) {
        double start[3];
        if (form->mesh->face_degree[f] == 3) continue;
        gproji_start_axis_point(form, f, start);
        if (form->axis[f] < 0) form->axis[f] = gproj_system_add_variables(form->system, 3, 3, start);
        h = form->mesh->face_halfedge[f];
        for (k = 0; k < form->mesh->face_degree[f] && gproji_form_ready(form); ++k, h = form->mesh->next[h])
            gproji_add_axis_row(form, group, f, form->axis[f], h);
    }
    return gproji_form_ready(form) ? group : -1;
}

/* How many faces meet at a vertex. */
GPROJI_INTERNAL int32_t gproji_faces_at(const gproj_mesh *mesh, int32_t vertex) {
    return gproj_mesh_valence(mesh, vertex) - gproj_mesh_is_boundary_vertex(mesh, vertex);
}

/* The row det(a, e, m) / (2 |e|) = 0 of a half-edge, linearised at x: a the axis of its origin, e = v_j - v_i, m = n_f
   + n_g. Its derivatives are e x m, m x a, a x e; |e| is frozen. Terms: a, v_i, v_j, n_f, n_g. */
GPROJI_INTERNAL void gproji_refresh_cone_row(const gproj_form *form, gproj_system *system, int32_t group, int32_t row,
                                             int32_t halfedge) {
    const gproj_mesh *mesh = form->mesh;
    const double *x = gproj_system_values(system), *a = x + form->cone[mesh->origin[halfedge]];
    double e[3], m[3], slope[5][3], scale;
    int32_t count, k, c;
    gproj_term *term = gproji_row_terms(system, group, row, &count);
    gproji_sub3(x + 3 * (size_t)mesh->origin[halfedge ^ 1], x + 3 * (size_t)mesh->origin[halfedge], e);
    gproji_copy3(x + form->normal[mesh->face[halfedge]], m);
    gproji_add_scaled3(1, x + form->normal[mesh->face[halfedge ^ 1]], m);
    gproji_cross3(e, m, slope[0]);
    gproji_cross3(a, m, slope[1]);
    gproji_cross3(m, a, slope[2]);
    gproji_cross3(a, e, slope[3]);
    gproji_copy3(slope[3], slope[4]);
    scale = 0.5 / gproji_fmax(gproji_length3(e), 1e-6);
    for (k = 0; k < 5; ++k)
        for (c = 0; c < 3; ++c) term[3 * k + c].a = scale * slope[k][c];
    gproj_system_set_row(system, group, row, NULL, -2 * scale * gproji_dot3(a, slope[0]));
}

GPROJI_INTERNAL void gproji_refresh_cones(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    int32_t i;
    for (i = 0; i < part->count; ++i)
        if (part->vertex[i] >= 0) gproji_refresh_cone_row(part->form, system, group, i, part->vertex[i]);
}

/* The rows of one vertex: a'a = 1, and one for each edge between two faces. */
GPROJI_INTERNAL void gproji_add_cone_rows(gproj_form *form, gproji_part *part, int32_t vertex) {
    const gproj_mesh *mesh = form->mesh;
    int32_t axis = form->cone[vertex], start = mesh->vertex_halfedge[vertex], h = start, c;
    gproj_term term[15];
    for (c = 0; c < 3; ++c) gproji_set_term(&term[c], axis + c, axis + c, 1);
    gproj_system_add_row(form->system, part->group, 3, term, -1, vertex);
    part->vertex[part->count++] = -1;
    do {
        int32_t face = mesh->face[h], other = mesh->face[h ^ 1];
        for (c = 0; c < 3 && face >= 0 && other >= 0; ++c) {
            gproji_set_term(&term[c], axis + c, -1, 0);
            gproji_set_term(&term[3 + c], 3 * vertex + c, -1, 0);
            gproji_set_term(&term[6 + c], 3 * mesh->origin[h ^ 1] + c, -1, 0);
            gproji_set_term(&term[9 + c], form->normal[face] + c, -1, 0);
            gproji_set_term(&term[12 + c], form->normal[other] + c, -1, 0);
        }
        if (face >= 0 && other >= 0) {
            gproj_system_add_row(form->system, part->group, 15, term, 0, vertex);
            part->vertex[part->count++] = h;
        }
        h = gproji_rotate(mesh, h);
    } while (h != start && gproji_form_ready(form));
}

/* Gives the vertices where four or more faces meet the axes of their cones as variables, if they have none. Returns the
   number of rows that they will have; -1 without memory. */
GPROJI_INTERNAL int32_t gproji_add_cones(gproj_form *form) {
    const gproj_mesh *mesh = form->mesh;
    int32_t v, rows = 0;
    if (!form->cone) {
        form->cone = (int32_t *)gproji_take(&form->own, (size_t)mesh->vertex_count, sizeof *form->cone);
        if (!form->cone) {
            gproji_fail_memory(&form->error);
            return -1;
        }
        for (v = 0; v < mesh->vertex_count; ++v) form->cone[v] = -1;
    }
    for (v = 0; v < mesh->vertex_count; ++v) {
        double start[3];
        if (gproji_faces_at(mesh, v) < 4) continue;
        gproji_cone_axis(mesh, gproj_system_values(form->system), v, start);
        if (form->cone[v] < 0) form->cone[v] = gproj_system_add_variables(form->system, 3, 3, start);
        rows += gproj_mesh_valence(mesh, v) + 1;
    }
    return gproji_form_ready(form) ? rows : -1;
}

GPROJ_API int32_t gproj_add_conicality(gproj_form *form, double weight) {
    gproji_part *part;
    int32_t rows, v;
    if (!gproji_form_ready(form) || !gproji_add_missing_normals(form, "conicality")) return -1;
    rows = gproji_add_cones(form);
    part = rows < 0 ? NULL : gproji_new_part(form, rows);
    if (!part) return -1;
    part->count = 0;
    part->group =
        gproji_new_group(form, "conicality", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, weight, gproji_refresh_cones, part);
    for (v = 0; v < form->mesh->vertex_count && gproji_form_ready(form); ++v)
        if (form->cone[v] >= 0) gproji_add_cone_rows(form, part, v);
    return gproji_form_ready(form) ? part->group : -1;
}

GPROJ_API int32_t gproj_add_parallelograms(gproj_form *form, double weight) {
    int32_t group, f, k, c;
    if (!gproji_form_ready(form)) return -1;
    group = gproji_new_group(form, "parallelograms", GPROJ_WISH, GPROJ_PLACE_FACE, weight, NULL, NULL);
    for (f = 0; f < form->mesh->face_count; ++f) {
        gproj_term term[4];
        if (form->mesh->face_degree[f] != 4) continue;
        for (k = 0; k < 3; ++k) {
            int32_t h = form->mesh->face_halfedge[f];
            for (c = 0; c < 4; ++c, h = form->mesh->next[h])
                gproji_set_term(&term[c], 3 * form->mesh->origin[h] + k, -1, c % 2 ? -1 : 1);
            gproj_system_add_row(form->system, group, 4, term, 0, f);
        }
    }
    return gproji_form_ready(form) ? group : -1;
}

/* The gradient of a face's area by the vertex where half-edge h of it starts: (v_(i+1) - v_(i-1)) x a / (2 |a|). */
GPROJI_INTERNAL void gproji_area_slope(const gproj_form *form, int32_t h, const double normal[3], double out[3]) {
    const gproj_mesh *mesh = form->mesh;
    const double *x = gproj_system_values(form->system);
    double across[3];
    int32_t k;
    gproji_sub3(x + 3 * (size_t)mesh->origin[mesh->next[h]], x + 3 * (size_t)mesh->origin[mesh->prev[h]], across);
    gproji_cross3(across, normal, out);
    for (k = 0; k < 3; ++k) out[k] /= 2;
}

/* scale (|a(v)| + grad |a|'(v' - v)) of a face at form->area: 3 coefficients a corner; returns the constant. */
GPROJI_INTERNAL double gproji_linearise_area(const gproj_form *form, int32_t face, double scale, gproj_term *term) {
    static const double none[3] = {0, 0, 0};
    const gproj_mesh *mesh = form->mesh;
    const double *x = gproj_system_values(form->system);
    int32_t h = mesh->face_halfedge[face], k, c;
    double normal[3], slope[3], constant;
    gproji_copy3(form->area + 3 * (size_t)face, normal);
    constant = scale * gproji_length3(normal);
    gproji_normalise3(normal, none);
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h]) {
        const double *v = x + 3 * (size_t)mesh->origin[h];
        gproji_area_slope(form, h, normal, slope);
        for (c = 0; c < 3; ++c) term[3 * k + c].a = scale * slope[c];
        constant -= scale * gproji_dot3(slope, v);
    }
    return constant;
}

/* The terms of gproji_linearise_area, for variables that are there; returns how many. */
GPROJI_INTERNAL int32_t gproji_set_area_terms(const gproj_mesh *mesh, int32_t face, gproj_term *term) {
    int32_t h = mesh->face_halfedge[face], k, c;
    for (k = 0; k < mesh->face_degree[face]; ++k, h = mesh->next[h])
        for (c = 0; c < 3; ++c) gproji_set_term(&term[3 * k + c], 3 * mesh->origin[h] + c, -1, 0);
    return 3 * mesh->face_degree[face];
}

/* The row |a(v)| - A = 0 of each face. */
GPROJI_INTERNAL void gproji_refresh_areas(void *user, gproj_system *system, int32_t group) {
    gproj_form *form = ((const gproji_part *)user)->form;
    int32_t f, count;
    gproji_update_areas(form);
    for (f = 0; f < form->mesh->face_count; ++f) {
        gproj_term *term = gproji_row_terms(system, group, f, &count);
        gproj_system_set_row(system, group, f, NULL, gproji_linearise_area(form, f, 1, term));
    }
}

GPROJ_API int32_t gproj_add_equal_areas(gproj_form *form, double weight) {
    gproji_part *part = gproji_form_ready(form) ? gproji_new_part(form, 0) : NULL;
    gproj_term *term = part ? gproji_take_terms(form) : NULL;
    int32_t common, f, count;
    double area = 0;
    if (!term) return -1;
    gproji_update_areas(form);
    for (f = 0; f < form->mesh->face_count; ++f)
        area += gproji_length3(form->area + 3 * (size_t)f) / form->mesh->face_count;
    common = gproj_system_add_variables(form->system, 1, 1, &area);
    part->group =
        gproji_new_group(form, "equal areas", GPROJ_WISH, GPROJ_PLACE_FACE, weight, gproji_refresh_areas, part);
    for (f = 0; f < form->mesh->face_count && gproji_form_ready(form); ++f) {
        count = gproji_set_area_terms(form->mesh, f, term);
        gproji_set_term(&term[count], common, -1, -1);
        gproj_system_add_row(form->system, part->group, count + 1, term, 0, f);
    }
    gproji_give_terms(form, term);
    return gproji_form_ready(form) ? part->group : -1;
}

/* The row (V(v) + grad V'(v' - v) - volume) / area; the terms are those of all vertices in order. */
GPROJI_INTERNAL void gproji_refresh_volume(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    gproj_form *form = part->form;
    const double *x = gproj_system_values(system);
    double height = form->centre[2] * form->scale, area = 0, constant;
    int32_t count, t, f;
    gproj_term *term = gproji_row_terms(system, group, 0, &count);
    gproji_update_areas(form);
    for (f = 0; f < form->mesh->face_count; ++f) area += gproji_length3(form->area + 3 * (size_t)f);
    area = gproji_fmax(area, 1e-12);
    memset(part->gradient, 0, (size_t)count * sizeof *part->gradient);
    constant = (gproji_volume(form->mesh, x, height, 1 / area, part->gradient) - part->target) / area;
    for (t = 0; t < count; ++t) {
        term[t].a = part->gradient[t];
        constant -= part->gradient[t] * x[t];
    }
    gproj_system_set_row(system, group, 0, NULL, constant);
}

GPROJ_API int32_t gproj_add_volume(gproj_form *form, double volume, double weight) {
    gproji_part *part = gproji_form_ready(form) ? gproji_new_part(form, 0) : NULL;
    size_t count;
    gproj_term *term;
    int32_t t;
    if (!part) return -1;
    if (!gproji_is_finite(volume)) {
        gproji_fail(&form->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1, "the volume is not a finite number");
        return -1;
    }
    count = 3 * (size_t)form->mesh->vertex_count;
    part->target = volume * form->scale * form->scale * form->scale;
    part->gradient = (double *)gproji_take(&form->own, count, sizeof *part->gradient);
    term = part->gradient ? (gproj_term *)gproji_take(&form->own, count, sizeof *term) : NULL;
    if (!term) {
        gproji_fail_memory(&form->error);
        return -1;
    }
    part->group = gproji_new_global_group(form, "volume", GPROJ_CONSTRAINT, weight, gproji_refresh_volume, part);
    for (t = 0; t < (int32_t)count; ++t) gproji_set_term(&term[t], t, -1, 0);
    gproj_system_add_row(form->system, part->group, (int32_t)count, term, 0, 0);
    gproji_give(&form->own, term, count, sizeof *term);
    return gproji_form_ready(form) ? part->group : -1;
}

/* -- bounds, total area, cost -- */

/* bound = the caller's at least and at most, times `scale`, 0 and infinite where there is none; refuses those that make
   no sense. */
GPROJI_INTERNAL bool gproji_take_bounds(gproj_form *form, const char *name, double min, double max, double scale,
                                        double bound[2]) {
    if (max >= 0 && !(max > 0)) max = HUGE_VAL;
    if (!(min >= 0) || !(max >= min) || !gproji_is_finite(min)) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "%s: at least %g and at most %g: bounds need 0 <= min <= max", name, min, max);
        return false;
    }
    bound[0] = min * scale;
    bound[1] = gproji_is_finite(max) ? max * scale : HUGE_VAL;
    return true;
}

/* Is there a bound: side 0 at least, side 1 at most? */
GPROJI_INTERNAL bool gproji_has_bound(const double bound[2], int32_t side) {
    return side == 0 ? bound[0] > 0 : gproji_is_finite(bound[1]);
}

GPROJ_API int32_t gproj_add_length_bounds(gproj_form *form, int32_t count, const int32_t *edges, double min, double max,
                                          double weight) {
    static const char name[] = "length bounds";
    double bound[2];
    int32_t group, k, side;
    if (!gproji_form_ready(form) || !gproji_edges_are_valid(form, name, count, edges)) return -1;
    if (!gproji_take_bounds(form, name, min, max, form->scale, bound)) return -1;
    group = gproji_new_group(form, name, GPROJ_BOUND, GPROJ_PLACE_EDGE, weight, NULL, NULL);
    for (k = 0; k < count; ++k) {
        int32_t edge = edges ? edges[k] : k;
        for (side = 0; side < 2; ++side) {
            gproj_term term[9];
            double sign = side == 0 ? 1 : -1, length = bound[side];
            if (!gproji_has_bound(bound, side)) continue;
            gproji_set_length_terms(form->mesh, edge, sign * 0.5 / length, term);
            gproj_system_add_row(form->system, group, 9, term, -sign * length / 2, edge);
        }
    }
    return gproji_form_ready(form) ? group : -1;
}

/* The rows (|a| - min) / (2 sqrt(min)) and (max - |a|) / (2 sqrt(max)) of each face. */
GPROJI_INTERNAL void gproji_refresh_area_bounds(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    int32_t i, side, count, row = 0;
    gproji_update_areas(part->form);
    for (i = 0; i < part->count; ++i) {
        for (side = 0; side < 2; ++side) {
            double sign = side == 0 ? 1 : -1, area = part->bound[side], scale, constant;
            if (!gproji_has_bound(part->bound, side)) continue;
            scale = sign / (2 * sqrt(area));
            constant =
                gproji_linearise_area(part->form, part->vertex[i], scale, gproji_row_terms(system, group, row, &count));
            gproj_system_set_row(system, group, row++, NULL, constant - scale * area);
        }
    }
}

GPROJ_API int32_t gproj_add_area_bounds(gproj_form *form, int32_t count, const int32_t *faces, double min, double max,
                                        double weight) {
    static const char name[] = "area bounds";
    gproji_part *part;
    gproj_term *term;
    int32_t k, side;
    if (!gproji_form_ready(form) || !gproji_faces_are_valid(form, name, count, faces)) return -1;
    part = gproji_new_part(form, count);
    if (!part || !gproji_take_bounds(form, name, min, max, form->scale * form->scale, part->bound)) return -1;
    term = gproji_take_terms(form);
    if (!term) return -1;
    part->group = gproji_new_group(form, name, GPROJ_BOUND, GPROJ_PLACE_FACE, weight, gproji_refresh_area_bounds, part);
    for (k = 0; k < count; ++k) {
        part->vertex[k] = faces ? faces[k] : k;
        for (side = 0; side < 2; ++side) {
            int32_t terms = gproji_set_area_terms(form->mesh, part->vertex[k], term);
            if (gproji_has_bound(part->bound, side))
                gproj_system_add_row(form->system, part->group, terms, term, 0, part->vertex[k]);
        }
    }
    gproji_give_terms(form, term);
    return gproji_form_ready(form) ? part->group : -1;
}

/* gradient += price * grad |v_i - v_j| over all edges; returns the sum of the lengths. */
GPROJI_INTERNAL double gproji_add_length_gradient(const gproj_form *form, double price, double *gradient) {
    static const double none[3] = {0, 0, 0};
    const int32_t *origin = form->mesh->origin;
    const double *x = gproj_system_values(form->system);
    gproji_sum sum = {0, 0};
    int32_t e;
    for (e = 0; e < form->mesh->edge_count; ++e, origin += 2) {
        double d[3];
        gproji_sub3(x + 3 * (size_t)origin[0], x + 3 * (size_t)origin[1], d);
        gproji_sum_add(&sum, gproji_length3(d));
        gproji_normalise3(d, none);
        gproji_add_scaled3(price, d, gradient + 3 * (size_t)origin[0]);
        gproji_add_scaled3(-price, d, gradient + 3 * (size_t)origin[1]);
    }
    return gproji_sum_value(&sum);
}

/* gradient += price * grad |a_k| over all faces at form->area; returns the sum of the areas. */
GPROJI_INTERNAL double gproji_add_area_gradient(const gproj_form *form, double price, double *gradient) {
    static const double none[3] = {0, 0, 0};
    const gproj_mesh *mesh = form->mesh;
    gproji_sum sum = {0, 0};
    int32_t f, k;
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        double normal[3];
        gproji_copy3(form->area + 3 * (size_t)f, normal);
        gproji_sum_add(&sum, gproji_length3(normal));
        gproji_normalise3(normal, none);
        for (k = 0; k < mesh->face_degree[f]; ++k, h = mesh->next[h]) {
            double slope[3];
            gproji_area_slope(form, h, normal, slope);
            gproji_add_scaled3(price, slope, gradient + 3 * (size_t)mesh->origin[h]);
        }
    }
    return gproji_sum_value(&sum);
}

/* The cost and its gradient at the system's x. */
GPROJI_INTERNAL double gproji_cost(gproj_form *form, const gproji_part *part, double *size) {
    double length, area;
    gproji_update_areas(form);
    memset(part->gradient, 0, 3 * (size_t)form->mesh->vertex_count * sizeof *part->gradient);
    length = part->price[0] * gproji_add_length_gradient(form, part->price[0], part->gradient);
    area = gproji_add_area_gradient(form, part->price[1], part->gradient);
    if (size) *size = (length + 2 * part->price[1] * area) / gproji_fmax(sqrt(area), 1e-6);
    return length + part->price[1] * area;
}

/* The rows (C(v) + grad C'(v' - v) - min) / unit and (max - ...) / unit; the terms are those of all vertices in order.
   A prescribed cost has the first one only. */
GPROJI_INTERNAL void gproji_refresh_cost(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    const double *x = gproj_system_values(system);
    gproji_sum ahead = {0, 0};
    int32_t side, t, count = 3 * part->form->mesh->vertex_count, row = 0;
    ahead.high = gproji_cost(part->form, part, NULL);
    for (t = 0; t < count; ++t) gproji_sum_add_product(&ahead, -part->gradient[t], x[t]);
    for (side = 0; side < 2; ++side) {
        double scale = (side == 0 ? 1 : -1) / part->unit;
        gproj_term *term;
        if (!gproji_has_bound(part->bound, side)) continue;
        term = gproji_row_terms(system, group, row, &count);
        for (t = 0; t < count; ++t) term[t].a = scale * part->gradient[t];
        gproj_system_set_row(system, group, row++, NULL, scale * (gproji_sum_value(&ahead) - part->bound[side]));
    }
}

/* The global rows of a cost whose part has its bounds and prices. `term`: room for all vertices. */
GPROJI_INTERNAL int32_t gproji_add_cost_rows(gproj_form *form, gproji_part *part, const char *name, gproj_kind kind,
                                             double weight, gproj_term *term) {
    int32_t count = 3 * form->mesh->vertex_count, side, t;
    gproji_cost(form, part, &part->unit);
    part->unit = gproji_fmax(part->unit, 1e-12);
    part->group = gproji_new_global_group(form, name, kind, weight, gproji_refresh_cost, part);
    for (t = 0; t < count; ++t) gproji_set_term(&term[t], t, -1, 0);
    for (side = 0; side < 2; ++side)
        if (gproji_has_bound(part->bound, side)) gproj_system_add_row(form->system, part->group, count, term, 0, 0);
    return gproji_form_ready(form) ? part->group : -1;
}

/* The prices of lengths and areas as the caller gives them. */
GPROJI_INTERNAL int32_t gproji_add_total(gproj_form *form, const char *name, gproj_kind kind, const double price[2],
                                         double min, double max, double weight) {
    gproji_part *part = gproji_form_ready(form) ? gproji_new_part(form, 0) : NULL;
    size_t count;
    gproj_term *term;
    int32_t group;
    if (!part) return -1;
    if (!(price[0] >= 0) || !(price[1] >= 0) || !(price[0] + price[1] > 0) || !gproji_is_finite(price[0] + price[1])) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "%s: the prices %g and %g must be >= 0 and not both 0", name, price[0], price[1]);
        return -1;
    }
    if (!gproji_take_bounds(form, name, min, max, 1, part->bound)) return -1;
    count = 3 * (size_t)form->mesh->vertex_count;
    part->price[0] = price[0] / form->scale;
    part->price[1] = price[1] / form->scale / form->scale;
    part->gradient = (double *)gproji_take(&form->own, count, sizeof *part->gradient);
    term = part->gradient ? (gproj_term *)gproji_take(&form->own, count, sizeof *term) : NULL;
    if (!term) {
        gproji_fail_memory(&form->error);
        return -1;
    }
    group = gproji_add_cost_rows(form, part, name, kind, weight, term);
    gproji_give(&form->own, term, count, sizeof *term);
    return group;
}

/* What is prescribed is > 0: so "0 means no bound" does not apply to it. */
GPROJI_INTERNAL int32_t gproji_add_prescribed_total(gproj_form *form, const char *name, const double price[2],
                                                    double value, double weight) {
    if (!gproji_form_ready(form)) return -1;
    if (!(value > 0) || !gproji_is_finite(value)) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "%s: %g is not > 0", name, value);
        return -1;
    }
    return gproji_add_total(form, name, GPROJ_CONSTRAINT, price, value, HUGE_VAL, weight);
}

GPROJ_API int32_t gproj_add_total_area(gproj_form *form, double area, double weight) {
    static const double price[2] = {0, 1};
    return gproji_add_prescribed_total(form, "total area", price, area, weight);
}

GPROJ_API int32_t gproj_add_total_area_bounds(gproj_form *form, double min, double max, double weight) {
    static const double price[2] = {0, 1};
    return gproji_add_total(form, "total area bounds", GPROJ_BOUND, price, min, max, weight);
}

GPROJ_API int32_t gproj_add_cost(gproj_form *form, double length_price, double area_price, double cost, double weight) {
    double price[2];
    price[0] = length_price;
    price[1] = area_price;
    return gproji_add_prescribed_total(form, "cost", price, cost, weight);
}

GPROJ_API int32_t gproj_add_cost_bounds(gproj_form *form, double length_price, double area_price, double min,
                                        double max, double weight) {
    double price[2];
    price[0] = length_price;
    price[1] = area_price;
    return gproji_add_total(form, "cost bounds", GPROJ_BOUND, price, min, max, weight);
}

/* ============================================================================================================
   >>statics   Force densities in the edges: equilibrium, bounds on forces, their start. Uses all earlier sections.

   Based on Tang et al. (2014), sections 3.1 and 3.5; force densities: Schek, The force density method for form finding
   and computation of general networks (1974).

   Edge e has the variable force[e] = w_e load_scale / scale, and the rows of its ends are in internal lengths and loads
   times load_scale, chosen at the start so that these variables have mean square 1. The weight on a vertex depends on
   the vertices load_vertex[load_start[i] .. load_start[i + 1] - 1], as linear terms at the end of its z row whose
   coefficients the refresh fills in. */

enum {
    GPROJI_AXES = 7 /* x, y and z */
};

/* Initial forces are drawn a little to this one, so that among equally good ones those of a dome of half its radius are
   found; a shape that leaves more than `lost` of its load unbalanced starts from uniform forces. */
static const double gproji_force_damping = 0.03, gproji_force_lost = 0.75;

/* Forces that are given are scaled to 1 where they are at least this part of what the loads ask for. */
static const double gproji_least_force = 1e-4;

/* The factors from the caller's loads to other units. */
typedef struct gproji_load_units {
    double force, per_length, per_area;
} gproji_load_units;

GPROJI_INTERNAL gproji_load_units gproji_internal_loads(const gproj_form *form) {
    gproji_load_units units;
    units.force = form->statics->load_scale;
    units.per_length = units.force / form->scale;
    units.per_area = units.per_length / form->scale;
    return units;
}

GPROJI_INLINE double gproji_density(const gproj_loads *loads, int32_t edge) {
    return loads->edge_density ? loads->edge_density[edge] : loads->density;
}

/* The weight on a face is h'a, a its vectorial area and h a direction that depends on a only: area_load a / |a|, and
   snow (0, 0, 1) with the sign of a. Returns it. */
GPROJI_INTERNAL double gproji_face_load(const gproj_mesh *mesh, const gproj_loads *loads, const double *x, int32_t face,
                                        double h[3]) {
    static const double up[3] = {0, 0, 1};
    double area[3], direction[3];
    int32_t k;
    gproji_area_vector(mesh, x, face, area);
    gproji_copy3(area, direction);
    gproji_normalise3(direction, up);
    for (k = 0; k < 3; ++k) h[k] = loads->area_load * direction[k];
    h[2] += area[2] < 0 ? -loads->snow : loads->snow;
    return gproji_dot3(h, area);
}

/* The load on each vertex at positions x, 3 numbers each. */
GPROJI_INTERNAL void gproji_loads_at(const gproj_mesh *mesh, const gproj_loads *loads, gproji_load_units units,
                                     const double *x, double *out) {
    int32_t v, e, f, c, k;
    for (v = 0; v < mesh->vertex_count; ++v)
        for (k = 0; k < 3; ++k)
            out[3 * (size_t)v + (size_t)k] =
                loads->point_load ? units.force * loads->point_load[3 * (size_t)v + (size_t)k] : 0;
    for (e = 0; e < mesh->edge_count; ++e) {
        const double *a = x + 3 * (size_t)mesh->origin[2 * e], *b = x + 3 * (size_t)mesh->origin[2 * e + 1];
        double half = 0.5 * units.per_length * gproji_density(loads, e) * gproji_distance3(a, b);
        out[3 * (size_t)mesh->origin[2 * e] + 2] -= half;
        out[3 * (size_t)mesh->origin[2 * e + 1] + 2] -= half;
    }
    if (loads->area_load == 0 && loads->snow == 0) return;
    for (f = 0; f < mesh->face_count; ++f) {
        double h[3], part = units.per_area * gproji_face_load(mesh, loads, x, f, h) / mesh->face_degree[f];
        int32_t corner = mesh->face_halfedge[f];
        for (c = 0; c < mesh->face_degree[f]; ++c, corner = mesh->next[corner])
            out[3 * (size_t)mesh->origin[corner] + 2] -= part;
    }
}

/* -- the rows of equilibrium -- */

/* Has the vertex an equation along z whose weight can change? */
GPROJI_INLINE bool gproji_has_weight(const gproji_statics *s, int32_t vertex) { return (s->axes[vertex] & 4) != 0; }

/* The row of a vertex for an axis (0, 1, 2) along which it is in equilibrium; axis 3: how far its rows go. */
GPROJI_INTERNAL int32_t gproji_axis_row(const gproji_statics *s, int32_t vertex, int32_t axis) {
    int32_t row = s->first_row[vertex], c;
    for (c = 0; c < axis; ++c) row += s->axes[vertex] >> c & 1;
    return row;
}

/* The coefficients of the weight on `vertex` in its z row, for vertex `other`: += s d. */
GPROJI_INTERNAL void gproji_add_weight_terms(const gproj_form *form, int32_t vertex, int32_t other, double s,
                                             const double d[3]) {
    const gproji_statics *statics = form->statics;
    int64_t at = statics->load_start[vertex];
    int32_t count, k;
    gproj_term *term = gproji_row_terms(form->system, statics->group, gproji_axis_row(statics, vertex, 2), &count);
    term += count - 3 * (statics->load_start[vertex + 1] - at);
    while (statics->load_vertex[at] != other) ++at;
    term += 3 * (at - statics->load_start[vertex]);
    for (k = 0; k < 3; ++k) term[k].a += s * d[k];
}

/* The weight of an edge, w'(a - b) / 2 on each end with w along the edge: linear, without a constant. */
GPROJI_INTERNAL void gproji_linearise_edge_load(const gproj_form *form, const double *x, double per_length,
                                                int32_t edge) {
    static const double none[3] = {0, 0, 0};
    const int32_t *end = form->mesh->origin + 2 * (size_t)edge;
    double d[3], half = 0.5 * per_length * gproji_density(&form->statics->loads, edge);
    int32_t k;
    if (half == 0) return;
    gproji_sub3(x + 3 * (size_t)end[0], x + 3 * (size_t)end[1], d);
    gproji_normalise3(d, none);
    for (k = 0; k < 2; ++k) {
        if (!gproji_has_weight(form->statics, end[k])) continue;
        gproji_add_weight_terms(form, end[k], end[0], -half, d);
        gproji_add_weight_terms(form, end[k], end[1], half, d);
    }
}

/* The same for a face: its weight is quadratic, with the gradient (x_(j+1) - x_(j-1)) x h / 2 at corner j, so
   linearised it is its gradient times x minus its value. */
GPROJI_INTERNAL void gproji_linearise_face_load(const gproj_form *form, const double *x, double per_area,
                                                int32_t face) {
    const gproj_mesh *mesh = form->mesh;
    const gproji_statics *statics = form->statics;
    int32_t degree = mesh->face_degree[face], hi = mesh->face_halfedge[face], hj = hi, i, j;
    double h[3], scale = per_area / degree;
    double part = scale * gproji_face_load(mesh, &statics->loads, x, face, h);
    for (j = 0; j < degree; ++j, hj = mesh->next[hj]) {
        double across[3], gradient[3];
        gproji_sub3(x + 3 * (size_t)mesh->origin[mesh->next[hj]], x + 3 * (size_t)mesh->origin[mesh->prev[hj]], across);
        gproji_cross3(across, h, gradient);
        for (i = 0; i < degree; ++i, hi = mesh->next[hi])
            if (gproji_has_weight(statics, mesh->origin[hi]))
                gproji_add_weight_terms(form, mesh->origin[hi], mesh->origin[hj], -0.5 * scale, gradient);
        if (gproji_has_weight(statics, mesh->origin[hj]))
            form->system->group[statics->group].row[gproji_axis_row(statics, mesh->origin[hj], 2)].constant += part;
    }
}

/* The loads at the present x. */
GPROJI_INTERNAL void gproji_refresh_equilibrium(void *user, gproj_system *system, int32_t group) {
    gproj_form *form = (gproj_form *)user;
    gproji_statics *statics = form->statics;
    const gproj_mesh *mesh = form->mesh;
    const double *x = gproj_system_values(system);
    gproji_load_units units = gproji_internal_loads(form);
    int32_t v, c, row = 0, e, f;
    for (v = 0; v < mesh->vertex_count; ++v) {
        for (c = 0; c < 3; ++c) {
            int32_t count, t;
            gproj_term *term;
            if (!(statics->axes[v] >> c & 1)) continue;
            term = gproji_row_terms(system, group, row, &count);
            for (t = 0; c == 2 && t < 3 * (statics->load_start[v + 1] - statics->load_start[v]); ++t)
                term[count - 1 - t].a = 0;
            gproj_system_set_row(
                system, group, row++, NULL,
                statics->loads.point_load ? units.force * statics->loads.point_load[3 * (size_t)v + (size_t)c] : 0);
        }
    }
    for (e = 0; e < mesh->edge_count; ++e) gproji_linearise_edge_load(form, x, units.per_length, e);
    if (statics->loads.area_load == 0 && statics->loads.snow == 0) return;
    for (f = 0; f < mesh->face_count; ++f) gproji_linearise_face_load(form, x, units.per_area, f);
}

/* The rows of one vertex: y_e (x_i - x_j) summed over its edges with a force, and room for the weight's terms. */
GPROJI_INTERNAL void gproji_add_vertex_equilibrium(gproj_form *form, int32_t vertex, gproj_term *term) {
    const gproj_mesh *mesh = form->mesh;
    const gproji_statics *statics = form->statics;
    int32_t c, k;
    int64_t l;
    for (c = 0; c < 3; ++c) {
        int32_t start = mesh->vertex_halfedge[vertex], h = start, count = 0;
        if (!(statics->axes[vertex] >> c & 1)) continue;
        do {
            int32_t force = statics->force[h / 2];
            if (force >= 0) {
                gproji_set_term(&term[count++], force, 3 * vertex + c, 1);
                gproji_set_term(&term[count++], force, 3 * mesh->origin[mesh->twin[h]] + c, -1);
            }
            h = mesh->next[mesh->twin[h]];
        } while (h != start);
        for (l = statics->load_start[vertex]; c == 2 && l < statics->load_start[vertex + 1]; ++l)
            for (k = 0; k < 3; ++k) gproji_set_term(&term[count++], 3 * statics->load_vertex[l] + k, -1, 0);
        gproj_system_add_row(form->system, statics->group, count, term, 0, vertex);
    }
}

/* Notes `other` among the vertices that the weight on `vertex` depends on, once. */
GPROJI_INTERNAL void gproji_note_weight(gproji_statics *statics, int32_t vertex, int32_t other, int32_t *mark,
                                        int64_t *count) {
    if (mark[other] == vertex) return;
    mark[other] = vertex;
    if (statics->load_vertex) statics->load_vertex[*count] = other;
    ++*count;
}

/* The vertices that the weight on each vertex depends on; without load_vertex only counts. `mark`: work, one number a
   vertex. */
GPROJI_INTERNAL void gproji_list_weights(const gproj_form *form, int32_t *mark) {
    const gproj_mesh *mesh = form->mesh;
    gproji_statics *statics = form->statics;
    bool areas = statics->loads.area_load != 0 || statics->loads.snow != 0;
    bool lengths = statics->loads.density != 0 || statics->loads.edge_density;
    int64_t count = 0;
    int32_t v;
    for (v = 0; v < mesh->vertex_count; ++v) mark[v] = -1;
    for (v = 0; v < mesh->vertex_count; ++v) {
        int32_t start = mesh->vertex_halfedge[v], h = start, around;
        statics->load_start[v] = count;
        if (!gproji_has_weight(statics, v) || start < 0 || !(areas || lengths)) continue;
        gproji_note_weight(statics, v, v, mark, &count);
        do {
            gproji_note_weight(statics, v, mesh->origin[mesh->twin[h]], mark, &count);
            for (around = mesh->next[h]; areas && mesh->face[h] >= 0 && around != h; around = mesh->next[around])
                gproji_note_weight(statics, v, mesh->origin[around], mark, &count);
            h = mesh->next[mesh->twin[h]];
        } while (h != start);
    }
    statics->load_start[mesh->vertex_count] = count;
}

/* -- making the statics of a form -- */

GPROJI_INTERNAL double *gproji_copy_numbers(gproj_form *form, const double *numbers, size_t count) {
    double *copy = (double *)gproji_take(&form->own, count, sizeof *copy);
    if (copy && count) memcpy(copy, numbers, count * sizeof *copy);
    return copy;
}

/* Refuses loads that are no numbers. */
GPROJI_INTERNAL bool gproji_loads_are_valid(gproj_form *form, const gproj_loads *loads) {
    int32_t e, v;
    bool finite = loads && gproji_is_finite(loads->density) && gproji_is_finite(loads->area_load) &&
                  gproji_is_finite(loads->snow);
    if (!finite) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "equilibrium: there are no loads, or density, area load or snow is not a finite number");
        return false;
    }
    for (e = 0; loads->edge_density && e < form->mesh->edge_count; ++e) {
        if (gproji_is_finite(loads->edge_density[e])) continue;
        gproji_fail(&form->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_EDGE, e,
                    "equilibrium: the density of edge %d is not a finite number", e);
        return false;
    }
    for (v = 0; loads->point_load && v < 3 * form->mesh->vertex_count; ++v) {
        if (gproji_is_finite(loads->point_load[v])) continue;
        gproji_fail(&form->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_VERTEX, v / 3,
                    "equilibrium: the load on vertex %d is not a finite number", v / 3);
        return false;
    }
    return true;
}

/* Takes the arrays; what is missing is seen by the caller. */
GPROJI_INTERNAL bool gproji_take_statics(gproj_form *form, const gproj_loads *loads) {
    size_t vertices = (size_t)form->mesh->vertex_count, edges = (size_t)form->mesh->edge_count;
    gproji_statics *s = (gproji_statics *)gproji_take_zeroed(&form->own, 1, sizeof *s);
    form->statics = s;
    if (!s) return false;
    s->group = s->guidance = -1;
    s->load_scale = 1;
    s->loads = *loads;
    if (loads->edge_density) s->edge_density = gproji_copy_numbers(form, loads->edge_density, edges);
    if (loads->point_load) s->point_load = gproji_copy_numbers(form, loads->point_load, 3 * vertices);
    s->loads.edge_density = s->edge_density;
    s->loads.point_load = s->point_load;
    s->axes = (uint8_t *)gproji_take(&form->own, vertices, sizeof *s->axes);
    s->force = (int32_t *)gproji_take(&form->own, edges, sizeof *s->force);
    s->first_row = (int32_t *)gproji_take(&form->own, vertices, sizeof *s->first_row);
    s->load_start = (int64_t *)gproji_take_zeroed(&form->own, vertices + 1, sizeof *s->load_start);
    s->work = (double *)gproji_take(&form->own, 3 * vertices, sizeof *s->work);
    return (s->edge_density || !loads->edge_density) && (s->point_load || !loads->point_load) && s->axes && s->force &&
           s->first_row && s->load_start && s->work;
}

/* Which vertices are in equilibrium along which axes, which edges have a force. */
GPROJI_INTERNAL void gproji_set_supports(gproj_form *form, const gproj_supports *supports) {
    const gproj_mesh *mesh = form->mesh;
    gproji_statics *s = form->statics;
    int32_t v, e, k, first, carrying = 0;
    for (v = 0; v < mesh->vertex_count; ++v) s->axes[v] = mesh->vertex_halfedge[v] < 0 ? 0 : GPROJI_AXES;
    for (k = 0; k < supports->count; ++k)
        s->axes[supports->vertex[k]] = supports->slides ? supports->slides[k] & GPROJI_AXES : 0;
    for (v = 0, k = 0; v < mesh->vertex_count; ++v) {
        s->first_row[v] = k;
        k = gproji_axis_row(s, v, 3);
    }
    for (e = 0; e < mesh->edge_count; ++e) {
        s->force[e] = s->axes[mesh->origin[2 * e]] || s->axes[mesh->origin[2 * e + 1]] ? carrying++ : -1;
    }
    first = gproj_system_add_variables(form->system, carrying, 1, NULL);
    for (e = 0; e < mesh->edge_count; ++e)
        if (s->force[e] >= 0) s->force[e] += first;
}

/* The lists of weights; `mark`: work, one number a vertex. */
GPROJI_INTERNAL bool gproji_take_weights(gproj_form *form, int32_t *mark) {
    gproji_statics *s = form->statics;
    gproji_list_weights(form, mark);
    s->load_vertex =
        (int32_t *)gproji_take(&form->own, (size_t)s->load_start[form->mesh->vertex_count], sizeof *s->load_vertex);
    if (!s->load_vertex) return false;
    gproji_list_weights(form, mark);
    return true;
}

GPROJI_INTERNAL void gproji_add_equilibrium_rows(gproj_form *form) {
    gproji_statics *s = form->statics;
    int64_t most = 0, v;
    size_t count;
    gproj_term *term;
    for (v = 0; v < form->mesh->vertex_count; ++v)
        if (s->load_start[v + 1] - s->load_start[v] > most) most = s->load_start[v + 1] - s->load_start[v];
    gproji_expect_group(form, s->group, 0, 3 * (size_t)v,
                        12 * (size_t)form->mesh->edge_count + 3 * (size_t)s->load_start[v]);
    count = 2 * (size_t)form->ring_size + 3 * (size_t)most;
    term = (gproj_term *)gproji_take(&form->own, count, sizeof *term);
    if (!term) {
        gproji_fail_memory(&form->error);
        return;
    }
    for (v = 0; v < form->mesh->vertex_count && gproji_form_ready(form); ++v)
        if (s->axes[v]) gproji_add_vertex_equilibrium(form, (int32_t)v, term);
    gproji_give(&form->own, term, count, sizeof *term);
}

GPROJ_API int32_t gproj_add_equilibrium(gproj_form *form, const gproj_loads *loads, const gproj_supports *supports,
                                        double weight) {
    int32_t *mark;
    if (!gproji_form_ready(form)) return -1;
    if (form->statics) {
        gproji_fail(&form->error, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1,
                    "the form has its equilibrium already: set its schedule, or make a new form");
        return -1;
    }
    if (!supports || supports->count < 0 || (supports->count > 0 && !supports->vertex)) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1, "equilibrium: there are no supports");
        return -1;
    }
    if (!gproji_vertices_are_valid(form, "supports", supports->count, supports->vertex) ||
        !gproji_loads_are_valid(form, loads))
        return -1;
    mark = (int32_t *)gproji_take(&form->own, (size_t)form->mesh->vertex_count, sizeof *mark);
    if (mark && gproji_take_statics(form, loads)) {
        gproji_set_supports(form, supports);
        if (!gproji_take_weights(form, mark)) gproji_fail_memory(&form->error);
    } else {
        gproji_fail_memory(&form->error);
    }
    gproji_give(&form->own, mark, (size_t)form->mesh->vertex_count, sizeof *mark);
    if (!gproji_form_ready(form)) return -1;
    form->statics->group = gproji_new_group(form, "equilibrium", GPROJ_CONSTRAINT, GPROJ_PLACE_VERTEX, weight,
                                            gproji_refresh_equilibrium, form);
    if (form->statics->group < 0) return -1;
    gproji_add_equilibrium_rows(form);
    return gproji_form_ready(form) ? form->statics->group : -1;
}

/* -- bounds and fairness of forces -- */

/* Refuses what needs equilibrium and has none. */
GPROJI_INTERNAL bool gproji_has_statics(gproj_form *form, const char *name) {
    if (!gproji_form_ready(form)) return false;
    if (!form->statics)
        gproji_fail(&form->error, GPROJ_ERROR_STATE, GPROJ_PLACE_NONE, -1,
                    "%s: there are no forces yet: call gproj_add_equilibrium before", name);
    return form->statics != NULL;
}

static const char gproji_compression_name[] = "compression", gproji_tension_name[] = "tension";

/* sign w >= 0. */
GPROJI_INTERNAL int32_t gproji_add_sign(gproj_form *form, const char *name, double sign, int32_t count,
                                        const int32_t *edges, double weight) {
    int32_t group, k;
    if (!gproji_has_statics(form, name) || !gproji_edges_are_valid(form, name, count, edges)) return -1;
    group = gproji_new_group(form, name, GPROJ_BOUND, GPROJ_PLACE_EDGE, weight, NULL, NULL);
    for (k = 0; k < count && gproji_form_ready(form); ++k) {
        int32_t edge = edges ? edges[k] : k;
        gproj_term term;
        gproji_set_term(&term, form->statics->force[edge], -1, sign);
        if (term.i >= 0) gproj_system_add_row(form->system, group, 1, &term, 0, edge);
    }
    return gproji_form_ready(form) ? group : -1;
}

GPROJ_API int32_t gproj_add_compression(gproj_form *form, int32_t count, const int32_t *edges, double weight) {
    return gproji_add_sign(form, gproji_compression_name, 1, count, edges, weight);
}

GPROJ_API int32_t gproj_add_tension(gproj_form *form, int32_t count, const int32_t *edges, double weight) {
    return gproji_add_sign(form, gproji_tension_name, -1, count, edges, weight);
}

/* The terms s y l of the force in an edge: l = u'(v_i - v_j) with u along the edge, filled in by a refresh. */
GPROJI_INTERNAL void gproji_set_force_terms(const gproj_form *form, int32_t edge, gproj_term *term) {
    const int32_t *end = form->mesh->origin + 2 * (size_t)edge;
    int32_t k;
    for (k = 0; k < 3; ++k) {
        gproji_set_term(&term[k], form->statics->force[edge], 3 * end[0] + k, 0);
        gproji_set_term(&term[3 + k], form->statics->force[edge], 3 * end[1] + k, 0);
    }
}

GPROJI_INTERNAL void gproji_refresh_force_terms(const gproj_form *form, int32_t edge, double s, gproj_term *term) {
    static const double none[3] = {0, 0, 0};
    const double *x = gproj_system_values(form->system);
    const int32_t *end = form->mesh->origin + 2 * (size_t)edge;
    double u[3];
    int32_t k;
    gproji_sub3(x + 3 * (size_t)end[0], x + 3 * (size_t)end[1], u);
    gproji_normalise3(u, none);
    for (k = 0; k < 3; ++k) {
        term[k].a = s * u[k];
        term[3 + k].a = -s * u[k];
    }
}

/* Rows of forces: y l - load_scale A min >= 0 where part->factor is A, and load_scale A max - y l >= 0 where it is -A;
   part->bound holds min and max. */
GPROJI_INTERNAL void gproji_refresh_stress(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    double load_scale = part->form->statics->load_scale;
    int32_t r, count;
    for (r = 0; r < part->count; ++r) {
        gproj_term *term = gproji_row_terms(system, group, r, &count);
        bool above = part->factor[r] < 0;
        gproji_refresh_force_terms(part->form, part->vertex[r], above ? -1 : 1, term);
        gproj_system_set_row(system, group, r, NULL, -load_scale * part->factor[r] * part->bound[above]);
    }
}

GPROJI_INTERNAL bool gproji_stress_is_valid(gproj_form *form, int32_t count, const int32_t *edges,
                                            const double *sections, double min, double max) {
    int32_t k;
    if (!gproji_edges_are_valid(form, "stress bounds", count, edges)) return false;
    if (!(min <= max) || (min > 0 && !gproji_is_finite(min)) || (max < 0 && !gproji_is_finite(max))) {
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_NONE, -1,
                    "stress bounds: the least, %g, is not below the greatest, %g", min, max);
        return false;
    }
    for (k = 0; sections && k < count; ++k) {
        if (sections[k] > 0 && gproji_is_finite(sections[k])) continue;
        gproji_fail(&form->error, GPROJ_ERROR_ARGUMENT, GPROJ_PLACE_EDGE, edges ? edges[k] : k,
                    "stress bounds: edge %d would have the cross-section %g, which is not > 0", edges ? edges[k] : k,
                    sections[k]);
        return false;
    }
    return true;
}

GPROJ_API int32_t gproj_add_stress_bounds(gproj_form *form, int32_t count, const int32_t *edges, const double *sections,
                                          double min, double max, double weight) {
    gproji_part *part;
    gproj_term term[6];
    int32_t k, side;
    if (!gproji_has_statics(form, "stress bounds") || !gproji_stress_is_valid(form, count, edges, sections, min, max))
        return -1;
    part = gproji_new_part(form, 2 * count);
    if (!part) return -1;
    part->count = 0;
    part->bound[0] = min;
    part->bound[1] = max;
    part->factor = (double *)gproji_take(&form->own, (size_t)part->capacity, sizeof *part->factor);
    if (!part->factor) {
        gproji_fail_memory(&form->error);
        return -1;
    }
    part->group =
        gproji_new_group(form, "stress bounds", GPROJ_BOUND, GPROJ_PLACE_EDGE, weight, gproji_refresh_stress, part);
    for (side = 0; side < 2; ++side) {
        for (k = 0; k < count && gproji_form_ready(form); ++k) {
            int32_t edge = edges ? edges[k] : k;
            if (form->statics->force[edge] < 0 || !gproji_is_finite(part->bound[side])) continue;
            part->vertex[part->count] = edge;
            part->factor[part->count++] = (side ? -1 : 1) * (sections ? sections[k] : 1);
            gproji_set_force_terms(form, edge, term);
            gproj_system_add_row(form->system, part->group, 6, term, 0, edge);
        }
    }
    return gproji_form_ready(form) ? part->group : -1;
}

/* Rows y_e l_e - y_f l_f = 0; part->vertex holds the pairs e, f. */
GPROJI_INTERNAL void gproji_refresh_force_fairness(void *user, gproj_system *system, int32_t group) {
    const gproji_part *part = (const gproji_part *)user;
    int32_t r, count;
    for (r = 0; r < part->count / 2; ++r) {
        gproj_term *term = gproji_row_terms(system, group, r, &count);
        gproji_refresh_force_terms(part->form, part->vertex[2 * r], 1, term);
        gproji_refresh_force_terms(part->form, part->vertex[2 * r + 1], -1, term + 6);
    }
}

GPROJ_API int32_t gproj_add_force_fairness(gproj_form *form, double weight) {
    const gproj_mesh *mesh;
    gproji_part *part;
    gproj_term term[12];
    int32_t f, k;
    if (!gproji_has_statics(form, "force fairness")) return -1;
    mesh = form->mesh;
    part = gproji_new_part(form, 4 * mesh->face_count);
    if (!part) return -1;
    part->count = 0;
    part->group = gproji_new_group(form, "force fairness", GPROJ_WISH, GPROJ_PLACE_FACE, weight,
                                   gproji_refresh_force_fairness, part);
    for (f = 0; f < mesh->face_count; ++f) {
        int32_t h = mesh->face_halfedge[f];
        for (k = 0; mesh->face_degree[f] == 4 && k < 2; ++k, h = mesh->next[h]) {
            int32_t e = h / 2, opposite = mesh->next[mesh->next[h]] / 2;
            if (form->statics->force[e] < 0 || form->statics->force[opposite] < 0) continue;
            part->vertex[part->count++] = e;
            part->vertex[part->count++] = opposite;
            gproji_set_force_terms(form, e, term);
            gproji_set_force_terms(form, opposite, term + 6);
            gproj_system_add_row(form->system, part->group, 12, term, 0, f);
        }
    }
    return gproji_form_ready(form) ? part->group : -1;
}

/* -- the forces that balance a given shape best -- */

/* The edge whose force the row of a bound keeps on one side of 0, and `sign`: 1 for w >= 0, -1 for w <= 0. -1: none. */
GPROJI_INTERNAL int32_t gproji_bounded_force(const gproj_form *form, int32_t group, int32_t row, double *sign) {
    const gproji_group *g = &form->system->group[group];
    int32_t count, edge = g->row[row].element;
    const gproj_term *term = gproji_row_terms(form->system, group, row, &count);
    if (edge < 0 || edge >= form->mesh->edge_count || form->statics->force[edge] < 0) return -1;
    if (count != 1 || term->j >= 0) return -1;
    if (gproji_variable_of(g, &g->row[row], term->i) != form->statics->force[edge]) return -1;
    if (g->row[row].constant != 0) return -1;
    *sign = term->a;
    return edge;
}

/* May the force of an edge be negative or positive? Bounds with weight 0 do not count. */
GPROJI_INTERNAL void gproji_force_limits(const gproj_form *form, double *lower, double *upper) {
    int32_t e, g, r;
    double sign;
    for (e = 0; e < form->mesh->edge_count; ++e) {
        lower[e] = -HUGE_VAL;
        upper[e] = HUGE_VAL;
    }
    for (g = 0; g < form->system->group_count; ++g) {
        const gproji_group *group = &form->system->group[g];
        if (group->kind != GPROJ_BOUND || group->place != GPROJ_PLACE_EDGE || !(group->schedule.weight > 0)) continue;
        for (r = 0; r < group->row_count; ++r) {
            if (!(group->row[r].weight > 0)) continue;
            e = gproji_bounded_force(form, g, r, &sign);
            if (e >= 0 && sign > 0) lower[e] = 0;
            if (e >= 0 && sign < 0) upper[e] = 0;
        }
    }
}

static const char gproji_loads_too_large[] = "equilibrium: the loads are too large, their squares overflow";

/* The least-squares problem of equilibrium at positions x: a column for each edge, rows as in the group; and its
   solution. */
typedef struct gproji_balance {
    gproj_least_squares problem;
    int32_t row_count;
    int64_t *start;
    int32_t *row;
    double *value, *load, *b, *lower, *upper, *force;
    size_t edges, vertices;
} gproji_balance;

GPROJI_INTERNAL void gproji_give_balance(gproj_form *form, gproji_balance *p) {
    gproji_give(&form->own, p->start, p->edges + 1, sizeof *p->start);
    gproji_give(&form->own, p->row, 6 * p->edges, sizeof *p->row);
    gproji_give(&form->own, p->value, 6 * p->edges, sizeof *p->value);
    gproji_give(&form->own, p->load, 3 * p->vertices, sizeof *p->load);
    gproji_give(&form->own, p->b, 3 * p->vertices, sizeof *p->b);
    gproji_give(&form->own, p->lower, p->edges, sizeof *p->lower);
    gproji_give(&form->own, p->upper, p->edges, sizeof *p->upper);
    gproji_give(&form->own, p->force, p->edges, sizeof *p->force);
}

GPROJI_INTERNAL bool gproji_take_balance(gproj_form *form, gproji_balance *p) {
    memset(p, 0, sizeof *p);
    p->edges = (size_t)form->mesh->edge_count;
    p->vertices = (size_t)form->mesh->vertex_count;
    p->start = (int64_t *)gproji_take(&form->own, p->edges + 1, sizeof *p->start);
    p->row = (int32_t *)gproji_take(&form->own, 6 * p->edges, sizeof *p->row);
    p->value = (double *)gproji_take(&form->own, 6 * p->edges, sizeof *p->value);
    p->load = (double *)gproji_take(&form->own, 3 * p->vertices, sizeof *p->load);
    p->b = (double *)gproji_take(&form->own, 3 * p->vertices, sizeof *p->b);
    p->lower = (double *)gproji_take(&form->own, p->edges, sizeof *p->lower);
    p->upper = (double *)gproji_take(&form->own, p->edges, sizeof *p->upper);
    p->force = (double *)gproji_take_zeroed(&form->own, p->edges, sizeof *p->force);
    if (p->start && p->row && p->value && p->load && p->b && p->lower && p->upper && p->force) return true;
    gproji_give_balance(form, p);
    gproji_fail_memory(&form->error);
    return false;
}

/* The entries of the matrix: (x_i - x_j) in the rows of i, the opposite in those of j, for edges with a force. */
GPROJI_INTERNAL void gproji_fill_balance(const gproj_form *form, const double *x, gproji_balance *p) {
    const gproj_mesh *mesh = form->mesh;
    const gproji_statics *s = form->statics;
    int64_t count = 0;
    int32_t e, side, c;
    for (e = 0; e < mesh->edge_count; ++e) {
        p->start[e] = count;
        for (side = 0; s->force[e] >= 0 && side < 2; ++side) {
            int32_t i = mesh->origin[2 * e + side], j = mesh->origin[2 * e + 1 - side];
            for (c = 0; c < 3; ++c) {
                if (!(s->axes[i] >> c & 1)) continue;
                p->row[count] = gproji_axis_row(s, i, c);
                p->value[count++] = x[3 * (size_t)i + (size_t)c] - x[3 * (size_t)j + (size_t)c];
            }
        }
    }
    p->start[mesh->edge_count] = count;
    p->row_count = mesh->vertex_count ? gproji_axis_row(s, mesh->vertex_count - 1, 3) : 0;
}

/* b = -load, in the rows of the group. */
GPROJI_INTERNAL void gproji_fill_loads(const gproj_form *form, gproji_balance *p) {
    int32_t v, c;
    for (v = 0; v < form->mesh->vertex_count; ++v)
        for (c = 0; c < 3; ++c)
            if (form->statics->axes[v] >> c & 1)
                p->b[gproji_axis_row(form->statics, v, c)] = -p->load[3 * (size_t)v + (size_t)c];
}

/* The mean load on the vertices that are not pinned. */
GPROJI_INTERNAL double gproji_mean_load(const gproj_form *form, const double *load) {
    double sum = 0;
    int32_t v, count = 0;
    for (v = 0; v < form->mesh->vertex_count; ++v) {
        if (!form->statics->axes[v]) continue;
        sum += gproji_length3(load + 3 * (size_t)v);
        ++count;
    }
    return count ? sum / count : 0;
}

/* p->force: the best forces y for the loads p->load at x, drawn by `damping` to `mean`. False after an error. */
GPROJI_INTERNAL bool gproji_solve_balance(gproj_form *form, const double *x, double damping, double mean,
                                          gproji_balance *p) {
    gproj_least_squares_result result;
    gproj_error error;
    int32_t e;
    int64_t t;
    gproji_error_clear(&error);
    gproji_fill_balance(form, x, p);
    gproji_fill_loads(form, p);
    gproji_force_limits(form, p->lower, p->upper);
    for (e = 0; e < form->mesh->edge_count; ++e) { /* y = mean + z: the same problem for z, with 0 in the middle */
        p->lower[e] -= mean;
        p->upper[e] -= mean;
        for (t = p->start[e]; t < p->start[e + 1]; ++t) p->b[p->row[t]] -= mean * p->value[t];
    }
    memset(&p->problem, 0, sizeof p->problem);
    p->problem.rows = p->row_count;
    p->problem.columns = form->mesh->edge_count;
    p->problem.start = p->start;
    p->problem.row = p->row;
    p->problem.value = p->value;
    p->problem.b = p->b;
    p->problem.lower = p->lower;
    p->problem.upper = p->upper;
    p->problem.damping = damping;
    if (gproj_solve_least_squares(&p->problem, &form->host, p->force, &result, &error) != GPROJ_OK) {
        gproji_fail(&form->error, error.code, error.place, error.index, "%s", error.message);
        return false;
    }
    for (e = 0; e < form->mesh->edge_count; ++e) p->force[e] = form->statics->force[e] >= 0 ? p->force[e] + mean : 0;
    return true;
}

/* Adds the forces of an edge with density w to those on its ends. */
GPROJI_INTERNAL void gproji_add_force(const gproj_mesh *mesh, const double *x, int32_t edge, double w, double *out) {
    size_t i = 3 * (size_t)mesh->origin[2 * edge], j = 3 * (size_t)mesh->origin[2 * edge + 1], c;
    for (c = 0; c < 3; ++c) {
        out[i + c] += w * (x[i + c] - x[j + c]);
        out[j + c] -= w * (x[i + c] - x[j + c]);
    }
}

/* out = load + the forces' sum in each vertex at x (NULL: no forces), nothing along the axes of supports. */
GPROJI_INTERNAL void gproji_unbalanced(const gproj_form *form, const double *x, const double *force, const double *load,
                                       double *out) {
    const gproj_mesh *mesh = form->mesh;
    int32_t v, e, c;
    for (c = 0; c < 3 * mesh->vertex_count; ++c) out[c] = load[c];
    for (e = 0; force && e < mesh->edge_count; ++e) gproji_add_force(mesh, x, e, force[e], out);
    for (v = 0; v < mesh->vertex_count; ++v)
        for (c = 0; c < 3; ++c)
            if (!(form->statics->axes[v] >> c & 1)) out[3 * (size_t)v + (size_t)c] = 0;
}

/* p->load, at positions x, as parts of the mean load. Returns this mean, 0 without loads; -1 after an error. */
GPROJI_INTERNAL double gproji_relative_loads(gproj_form *form, const double *x, gproji_balance *p) {
    static const gproji_load_units units = {1, 1, 1};
    double mean;
    size_t i;
    gproji_loads_at(form->mesh, &form->statics->loads, units, x, p->load);
    mean = gproji_mean_load(form, p->load);
    if (!gproji_is_finite(mean)) {
        gproji_fail(&form->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1, "%s", gproji_loads_too_large);
        return -1;
    }
    for (i = 0; mean > 0 && i < 3 * p->vertices; ++i) p->load[i] /= mean;
    return mean;
}

GPROJ_API gproj_code gproj_find_forces(gproj_form *form, double *densities, double *residuals) {
    gproji_balance p;
    double *x, mean;
    int32_t v, e;
    if (!form) return GPROJ_ERROR_ARGUMENT;
    if (!gproji_has_statics(form, "find forces") || !gproji_positions_are_finite(form) ||
        !gproji_take_balance(form, &p))
        return gproj_form_error(form)->code;
    x = (double *)gproji_take(&form->own, 3 * p.vertices, sizeof *x);
    if (!x) gproji_fail_memory(&form->error);
    mean = x ? gproji_relative_loads(form, form->mesh->position, &p) : -1;
    for (v = 0; x && v < form->mesh->vertex_count; ++v)
        gproji_to_internal(form, form->mesh->position + 3 * (size_t)v, x + 3 * (size_t)v);
    if (mean >= 0 && gproji_solve_balance(form, x, 0, 0, &p)) {
        gproji_unbalanced(form, x, p.force, p.load, p.load);
        for (v = 0; residuals && v < form->mesh->vertex_count; ++v)
            residuals[v] = mean > 0 ? gproji_length3(p.load + 3 * (size_t)v) : 0;
        for (e = 0; densities && e < form->mesh->edge_count; ++e) densities[e] = p.force[e] * mean * form->scale;
    }
    gproji_give(&form->own, x, 3 * p.vertices, sizeof *x);
    gproji_give_balance(form, &p);
    return gproj_form_error(form)->code;
}

/* -- the start of a solve -- */

/* The largest distance of a vertex from the supports, in edges; 1 where there are none. `queue`, `distance`: work, one
   number a vertex each. */
GPROJI_INTERNAL int32_t gproji_support_radius(const gproj_form *form, int32_t *queue, int32_t *distance) {
    const gproj_mesh *mesh = form->mesh;
    int32_t v, head, tail = 0, radius = 1;
    for (v = 0; v < mesh->vertex_count; ++v) {
        distance[v] = form->statics->axes[v] == GPROJI_AXES ? -1 : 0;
        if (distance[v] == 0) queue[tail++] = v;
    }
    for (head = 0; head < tail; ++head) {
        int32_t start = mesh->vertex_halfedge[queue[head]], h = start;
        if (h < 0) continue;
        do {
            int32_t other = mesh->origin[mesh->twin[h]];
            if (distance[other] < 0) {
                distance[other] = distance[queue[head]] + 1;
                radius = gproji_max(radius, distance[other]);
                queue[tail++] = other;
            }
            h = mesh->next[mesh->twin[h]];
        } while (h != start);
    }
    return radius;
}

/* Are most of the edges for tension only? */
GPROJI_INTERNAL bool gproji_hangs(const gproj_form *form, const double *upper) {
    int32_t e, hanging = 0, carrying = 0;
    for (e = 0; e < form->mesh->edge_count; ++e) {
        carrying += form->statics->force[e] >= 0;
        hanging += form->statics->force[e] >= 0 && upper[e] <= 0;
    }
    return 2 * hanging > carrying;
}

/* Every force becomes `force`, or the nearest one that is allowed. */
GPROJI_INTERNAL void gproji_set_uniform(const gproj_form *form, double force, gproji_balance *p) {
    int32_t e;
    gproji_force_limits(form, p->lower, p->upper);
    for (e = 0; e < form->mesh->edge_count; ++e)
        p->force[e] = form->statics->force[e] >= 0 ? gproji_fmin(gproji_fmax(force, p->lower[e]), p->upper[e]) : 0;
}

/* Takes the forces p->force as variables, scaled to mean square 1, and the loads with them. */
GPROJI_INTERNAL void gproji_take_forces(gproj_form *form, const gproji_balance *p) {
    gproji_statics *s = form->statics;
    double *x = gproj_system_values(form->system), sum = 0;
    int32_t e, carrying = 0;
    for (e = 0; e < form->mesh->edge_count; ++e) carrying += s->force[e] >= 0;
    sum = sqrt(gproji_dot(p->force, p->force, p->edges) / gproji_fmax(1, carrying));
    if (!(sum > 0)) sum = 1;
    s->load_scale /= sum;
    for (e = 0; e < form->mesh->edge_count; ++e)
        if (s->force[e] >= 0) x[s->force[e]] = p->force[e] / sum;
}

/* The first forces: those that balance the shape best; uniform ones where it carries nothing. Returns whether they are
   uniform. `work`: 2 numbers a vertex. */
GPROJI_INTERNAL bool gproji_start_forces(gproj_form *form, gproji_balance *p, int32_t *work) {
    gproji_statics *s = form->statics;
    const double *x = gproj_system_values(form->system);
    double load, all, lost, typical = 0.5 * gproji_support_radius(form, work, work + form->mesh->vertex_count);
    size_t count = 3 * p->vertices;
    s->load_scale = 1;
    gproji_loads_at(form->mesh, &s->loads, gproji_internal_loads(form), x, p->load);
    load = gproji_mean_load(form, p->load);
    if (!gproji_is_finite(load)) {
        gproji_fail(&form->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_NONE, -1, "%s", gproji_loads_too_large);
        return false;
    }
    if (load > 0) s->load_scale = 1 / load;
    gproji_loads_at(form->mesh, &s->loads, gproji_internal_loads(form), x, p->load);
    gproji_force_limits(form, p->lower, p->upper);
    if (gproji_hangs(form, p->upper)) typical = -typical;
    if (!gproji_solve_balance(form, x, gproji_force_damping, typical, p)) return false;
    gproji_unbalanced(form, x, NULL, p->load, p->b);
    all = gproji_dot(p->b, p->b, count);
    gproji_unbalanced(form, x, p->force, p->load, p->b);
    lost = all > 0 ? sqrt(gproji_dot(p->b, p->b, count) / all) : 0;
    if (lost > gproji_force_lost) gproji_set_uniform(form, 2 * typical, p);
    gproji_take_forces(form, p);
    return lost > gproji_force_lost;
}

/* Draws the forces to where they are, with weights 0.3^n, n <= 5, where they bend the shape first; weight 0 otherwise.
   */
GPROJI_INTERNAL void gproji_set_force_guidance(gproj_form *form, bool wanted) {
    gproji_statics *s = form->statics;
    gproj_schedule schedule = {0, 0.3, 5};
    const double *x;
    int32_t e, row = 0;
    gproj_term term;
    if (s->guidance < 0 && !wanted) return;
    if (s->guidance < 0) {
        s->guidance = gproji_new_group(form, "force guidance", GPROJ_WISH, GPROJ_PLACE_EDGE, 0, NULL, NULL);
        for (e = 0; e < form->mesh->edge_count && gproji_form_ready(form); ++e) {
            gproji_set_term(&term, s->force[e], -1, 1);
            if (term.i >= 0) gproj_system_add_row(form->system, s->guidance, 1, &term, 0, e);
        }
    }
    schedule.weight = wanted ? 1 : 0;
    gproj_system_set_schedule(form->system, s->guidance, schedule);
    x = gproj_system_values(form->system);
    for (e = 0; e < form->mesh->edge_count && gproji_form_ready(form); ++e)
        if (s->force[e] >= 0) gproj_system_set_row(form->system, s->guidance, row++, NULL, -x[s->force[e]]);
}

/* What comes before a solve: forces, if there are none yet, and their guidance. */
GPROJI_INTERNAL void gproji_begin_forces(gproj_form *form) {
    gproji_statics *s = form->statics;
    size_t vertices = (size_t)form->mesh->vertex_count;
    gproji_balance p;
    int32_t *work;
    bool uniform = false;
    if (!s || s->group < 0 || !(form->system->group[s->group].schedule.weight > 0)) return;
    if (!s->started) {
        work = (int32_t *)gproji_take(&form->own, 2 * vertices, sizeof *work);
        if (!work) {
            gproji_fail_memory(&form->error);
            return;
        }
        if (gproji_take_balance(form, &p)) {
            uniform = gproji_start_forces(form, &p, work);
            gproji_give_balance(form, &p);
        }
        gproji_give(&form->own, work, 2 * vertices, sizeof *work);
        s->started = gproji_form_ready(form);
    }
    gproji_set_force_guidance(form, uniform);
}

/* -- forces for the caller -- */

/* Densities in the caller's units. */
GPROJI_INTERNAL double gproji_force_density(const gproj_form *form, int32_t edge) {
    const gproji_statics *s = form->statics;
    if (!s || s->force[edge] < 0) return 0;
    return gproj_system_values(form->system)[s->force[edge]] * form->scale / s->load_scale;
}

GPROJ_API gproj_code gproj_get_forces(const gproj_form *form, double *densities) {
    int32_t e;
    if (!form || !densities) return GPROJ_ERROR_ARGUMENT;
    if (!gproji_form_ready(form)) return gproj_form_error(form)->code;
    for (e = 0; e < form->mesh->edge_count; ++e) densities[e] = gproji_force_density(form, e);
    return GPROJ_OK;
}

GPROJ_API int32_t gproj_force_variable(const gproj_form *form, int32_t edge) {
    if (!form || !form->statics || edge < 0 || edge >= form->mesh->edge_count) return -1;
    return form->statics->force[edge];
}

GPROJ_API gproj_code gproj_get_loads(const gproj_form *form, double *loads) {
    static const gproji_load_units units = {1, 1, 1};
    if (!form || !loads) return GPROJ_ERROR_ARGUMENT;
    if (!gproji_form_ready(form)) return gproj_form_error(form)->code;
    if (!form->statics) return GPROJ_ERROR_STATE;
    gproji_loads_at(form->mesh, &form->statics->loads, units, form->mesh->position, loads);
    return GPROJ_OK;
}

/* Root of the mean square of the densities of edges with a force; without overflow. */
GPROJI_INTERNAL double gproji_mean_density(const gproj_form *form, const double *densities) {
    double largest = 0, sum = 0;
    int32_t e, carrying = 0;
    for (e = 0; e < form->mesh->edge_count; ++e)
        if (form->statics->force[e] >= 0) largest = gproji_fmax(largest, fabs(densities[e]));
    for (e = 0; e < form->mesh->edge_count; ++e) {
        double part = largest > 0 ? densities[e] / largest : 0;
        if (form->statics->force[e] < 0) continue;
        sum += part * part;
        ++carrying;
    }
    return carrying ? largest * sqrt(sum / carrying) : 0;
}

/* The density that balances the mean load at an angle of 45 degrees in a mean edge. */
GPROJI_INTERNAL double gproji_density_of_loads(const gproj_form *form) {
    double density;
    gproj_get_loads(form, form->statics->work);
    density = gproji_mean_load(form, form->statics->work) * form->scale;
    return gproji_is_finite(density) ? density : 0;
}

GPROJ_API gproj_code gproj_set_forces(gproj_form *form, const double *densities) {
    double *x, mean, of_loads;
    int32_t e;
    if (!form) return GPROJ_ERROR_ARGUMENT;
    if (!gproji_has_statics(form, "set forces")) return gproj_form_error(form)->code;
    form->statics->started = false;
    x = gproj_system_values(form->system);
    for (e = 0; !densities && e < form->mesh->edge_count; ++e)
        if (form->statics->force[e] >= 0) x[form->statics->force[e]] = 0;
    if (!densities) return GPROJ_OK;
    for (e = 0; e < form->mesh->edge_count; ++e) {
        if (form->statics->force[e] < 0 || gproji_is_finite(densities[e])) continue;
        return gproji_fail(&form->error, GPROJ_ERROR_NUMBER, GPROJ_PLACE_EDGE, e,
                           "set forces: the density of edge %d is not a finite number", e);
    }
    of_loads = gproji_density_of_loads(form);
    mean = gproji_mean_density(form, densities);
    /* forces that are next to nothing must not make the loads huge */
    if (mean < gproji_least_force * of_loads) mean = of_loads;
    if (!(mean > DBL_MIN)) mean = 1;
    form->statics->load_scale = form->scale / mean;
    for (e = 0; e < form->mesh->edge_count; ++e)
        if (form->statics->force[e] >= 0) x[form->statics->force[e]] = densities[e] / mean;
    form->statics->started = true;
    return GPROJ_OK;
}

/* out += the forces' sum in each vertex, at the mesh's positions. */
GPROJI_INTERNAL void gproji_add_force_sums(const gproj_form *form, double *out) {
    int32_t e;
    for (e = 0; e < form->mesh->edge_count; ++e)
        gproji_add_force(form->mesh, form->mesh->position, e, gproji_force_density(form, e), out);
}

GPROJ_API gproj_code gproj_get_reactions(const gproj_form *form, double *reactions) {
    int32_t v, c;
    gproj_code code = gproj_get_loads(form, reactions);
    if (code) return code;
    gproji_add_force_sums(form, reactions);
    for (v = 0; v < form->mesh->vertex_count; ++v) {
        bool idle = form->mesh->vertex_halfedge[v] < 0;
        for (c = 0; c < 3; ++c) {
            double *r = &reactions[3 * (size_t)v + (size_t)c];
            *r = idle || form->statics->axes[v] >> c & 1 ? 0 : -*r;
        }
    }
    return GPROJ_OK;
}

/* The measures that belong to edges. */
GPROJI_INTERNAL void gproji_measure_members(const gproj_form *form, gproj_forces *m) {
    const gproj_mesh *mesh = form->mesh;
    int32_t e;
    bool first = true;
    for (e = 0; e < mesh->edge_count; ++e) {
        double w = gproji_force_density(form, e), length, force;
        if (form->statics->force[e] < 0) continue;
        length = gproji_distance3(mesh->position + 3 * (size_t)mesh->origin[2 * e],
                                  mesh->position + 3 * (size_t)mesh->origin[2 * e + 1]);
        force = w * length;
        m->load_path += fabs(force) * length;
        m->min_density = first ? w : gproji_fmin(m->min_density, w);
        m->max_density = first ? w : gproji_fmax(m->max_density, w);
        m->min_force = first ? force : gproji_fmin(m->min_force, force);
        m->max_force = first ? force : gproji_fmax(m->max_force, force);
        first = false;
    }
}

/* The measures that belong to vertices; `sum`: 3 numbers a vertex, loads on entry, destroyed. */
GPROJI_INTERNAL void gproji_measure_nodes(const gproj_form *form, double *sum, gproj_forces *m) {
    const gproj_mesh *mesh = form->mesh;
    double largest = 0;
    int32_t v, c;
    for (v = 0; v < mesh->vertex_count; ++v) {
        largest = gproji_fmax(largest, gproji_length3(sum + 3 * (size_t)v));
        m->total_load -= sum[3 * (size_t)v + 2];
    }
    gproji_add_force_sums(form, sum);
    for (v = 0; v < mesh->vertex_count; ++v) {
        double left[3], given[3];
        if (mesh->vertex_halfedge[v] < 0) continue;
        for (c = 0; c < 3; ++c) {
            bool balanced = form->statics->axes[v] >> c & 1;
            left[c] = balanced ? sum[3 * (size_t)v + (size_t)c] : 0;
            given[c] = balanced ? 0 : sum[3 * (size_t)v + (size_t)c];
        }
        m->max_reaction = gproji_fmax(m->max_reaction, gproji_length3(given));
        if (!form->statics->axes[v]) continue;
        if (!(gproji_length3(left) > m->residual) && m->residual_vertex >= 0) continue;
        m->residual = gproji_length3(left);
        m->residual_vertex = v;
    }
    if (largest > 0) m->residual /= largest;
}

GPROJ_API gproj_forces gproj_measure_forces(gproj_form *form) {
    gproj_forces m;
    memset(&m, 0, sizeof m);
    m.residual_vertex = -1;
    if (!form || !gproji_has_statics(form, "measure forces")) return m;
    gproj_get_loads(form, form->statics->work);
    gproji_measure_members(form, &m);
    gproji_measure_nodes(form, form->statics->work, &m);
    return m;
}

/* ============================================================================================================
   >>guard   A face must not lose its area on the way. Uses platform, vector, system, loop, mesh, form.

   On the way to planarity a skew face may collapse and come out turned over in its own plane; on the way to equilibrium
   a loaded face may. While the wishes guide, and two iterations longer, a face's area along its normal is bounded: it
   shall keep 0.4 of what it was, s (A(v)'n / a0 - 0.4) >= 0, A = 1/2 sum v_i x v_(i+1), n frozen in each iteration,
   s = sqrt(a0), and a step that would leave less than 0.2 is found again. These bounds act on the steps only: they are
   no part of residual and verdict. Where the mesh slides to the nearest one they ask for 0.1, and a step is refused that
   takes 3/4 of a face's area. */

static const double gproji_guard_weight = 0.3, gproji_guard_wanted = 0.4, gproji_guard_slack = 0.2,
                    gproji_guard_small = 0.1, gproji_guard_kept = 0.25, gproji_guard_area = 1e-4;
enum {
    GPROJI_GUARD_DEGREE = 64,
    GPROJI_GUARD_LONGER = 2
};

/* The normal of a guarded face as its variables say at x; a triangle has its first one. */
GPROJI_INTERNAL void gproji_guard_normal(const gproj_form *form, const double *x, int32_t index, double out[3]) {
    static const double none[3] = {0, 0, 0};
    int32_t normal = form->normal[form->guard->vertex[index]];
    gproji_copy3(normal >= 0 ? x + normal : form->guard_area + 3 * (size_t)index, out);
    gproji_normalise3(out, none);
}

/* The rows with the normals at x. Faces that had no area are let go. */
GPROJI_INTERNAL void gproji_refresh_guard(void *user, gproj_system *system, int32_t group) {
    const gproj_form *form = (const gproj_form *)user;
    int32_t i, count, t, k;
    for (i = 0; i < form->guard->count; ++i) {
        double n[3], area = gproji_length3(form->guard_area + 3 * (size_t)i);
        gproj_term *term = gproji_row_terms(system, group, i, &count);
        system->group[group].row[i].weight = area > gproji_guard_area ? sqrt(area) : 0;
        system->group[group].row[i].constant = -(system->sliding ? gproji_guard_small : gproji_guard_wanted);
        if (!(area > gproji_guard_area)) continue;
        gproji_guard_normal(form, system->x, i, n);
        /* for each edge the six products of (a x b)'n / 2, in the order of gproji_add_guard_row */
        for (t = 0; t < count; t += 6) {
            for (k = 0; k < 3; ++k) {
                term[t + 2 * k].a = 0.5 * n[(k + 2) % 3] / area;
                term[t + 2 * k + 1].a = -term[t + 2 * k].a;
            }
        }
    }
}

/* Has a face lost most of its area in the step from `saved`, seen along its normal or the one it had at first? */
GPROJI_INTERNAL bool gproji_refuse_turned(void *user, const gproj_system *system) {
    const gproj_form *form = (const gproj_form *)user;
    int32_t i, k;
    for (i = 0; form->guard_on && i < form->guard->count; ++i) {
        const double *first = form->guard_area + 3 * (size_t)i;
        double axis[2][3], before[3], after[3];
        if (gproji_length3(first) <= gproji_guard_area) continue;
        gproji_area_vector(form->mesh, system->saved, form->guard->vertex[i], before);
        gproji_area_vector(form->mesh, system->x, form->guard->vertex[i], after);
        gproji_guard_normal(form, system->saved, i, axis[0]);
        gproji_copy3(first, axis[1]);
        for (k = 0; k < 2; ++k) {
            double had = gproji_dot3(before, axis[k]);
            if (had > 0 && gproji_dot3(after, axis[k]) < gproji_guard_kept * had) return true;
        }
    }
    return false;
}

/* The row of a face: for each edge a b the products a_x b_y, - a_y b_x (n_z), a_y b_z, - a_z b_y (n_x), ... */
GPROJI_INTERNAL void gproji_add_guard_row(gproj_form *form, int32_t face) {
    const gproj_mesh *mesh = form->mesh;
    gproj_term term[6 * GPROJI_GUARD_DEGREE];
    int32_t h = mesh->face_halfedge[face], c, k, count = 0;
    for (c = 0; c < mesh->face_degree[face]; ++c, h = mesh->next[h]) {
        int32_t a = 3 * mesh->origin[h], b = 3 * mesh->origin[mesh->next[h]];
        for (k = 0; k < 3; ++k) {
            gproji_set_term(&term[count++], a + k, b + (k + 1) % 3, 0);
            gproji_set_term(&term[count++], a + (k + 1) % 3, b + k, 0);
        }
    }
    gproj_system_add_row(form->system, form->guard->group, count, term, -gproji_guard_wanted, face);
}

/* The guard's group and rows, once. */
GPROJI_INTERNAL void gproji_add_guard(gproj_form *form) {
    int32_t f, count = 0;
    for (f = 0; f < form->mesh->face_count; ++f) count += form->mesh->face_degree[f] <= GPROJI_GUARD_DEGREE;
    form->guard = gproji_new_part(form, count);
    if (!form->guard) return;
    form->guard_area = (double *)gproji_take(&form->own, 3 * (size_t)count, sizeof *form->guard_area);
    if (!form->guard_area) {
        gproji_fail_memory(&form->error);
        return;
    }
    form->guard->group = gproji_new_group(form, "guard", GPROJ_BOUND, GPROJ_PLACE_FACE, 0, gproji_refresh_guard, form);
    if (form->guard->group < 0) return;
    form->system->group[form->guard->group].guard = true;
    form->system->group[form->guard->group].slack = gproji_guard_slack;
    form->system->refuse_step = gproji_refuse_turned;
    form->system->refuse_user = form;
    for (f = 0, count = 0; f < form->mesh->face_count; ++f) {
        if (form->mesh->face_degree[f] > GPROJI_GUARD_DEGREE) continue;
        form->guard->vertex[count++] = f;
        gproji_add_guard_row(form, f);
    }
}

GPROJI_INTERNAL bool gproji_is_on(const gproj_form *form, int32_t group) {
    return group >= 0 && form->system->group[group].schedule.weight > 0;
}

/* Has the form forces, and a shape that carries, so that its faces need not turn over to do so? */
GPROJI_INTERNAL bool gproji_carries(const gproj_form *form) {
    const gproji_statics *s = form->statics;
    return s && gproji_is_on(form, s->group) && !gproji_is_on(form, s->guidance);
}

/* Sets the guard for a solve in which wishes guide until iteration `guided`; 0: none do, and it guards the first few
   iterations. */
GPROJI_INTERNAL void gproji_set_guard(gproj_form *form, int32_t guided, bool skip) {
    gproj_schedule schedule;
    int32_t i;
    bool wanted = !skip && (gproji_is_on(form, form->planarity) || gproji_carries(form));
    form->guard_on = wanted;
    if (wanted && !form->guard) gproji_add_guard(form);
    if (!form->guard || !gproji_form_ready(form)) return;
    schedule.weight = wanted ? gproji_guard_weight : 0;
    schedule.decay = 1;
    schedule.last = gproji_max(guided, GPROJI_GUARD_LONGER) + GPROJI_GUARD_LONGER;
    gproj_system_set_schedule(form->system, form->guard->group, schedule);
    for (i = 0; i < form->guard->count; ++i)
        gproji_area_vector(form->mesh, gproj_system_values(form->system), form->guard->vertex[i],
                           form->guard_area + 3 * (size_t)i);
}

/* ============================================================================================================
   >>solve   A form's solve: positions in, guidance, guard, the system's solve, positions out. Uses all earlier
   sections. */

/* x = the mesh's positions, and normals and axes as they are now. */
GPROJI_INTERNAL void gproji_load_positions(gproj_form *form) {
    double *x = gproj_system_values(form->system);
    int32_t i;
    for (i = 0; i < form->mesh->vertex_count; ++i)
        gproji_to_internal(form, form->mesh->position + 3 * (size_t)i, x + 3 * (size_t)i);
    gproji_update_areas(form);
    for (i = 0; i < form->mesh->face_count; ++i)
        if (form->normal[i] >= 0) gproji_face_normal(form, i, x + form->normal[i]);
    for (i = 0; form->axis && i < form->mesh->face_count; ++i)
        if (form->axis[i] >= 0) gproji_start_axis_point(form, i, x + form->axis[i]);
    for (i = 0; form->cone && i < form->mesh->vertex_count; ++i)
        if (form->cone[i] >= 0) gproji_cone_axis(form->mesh, x, i, x + form->cone[i]);
}

/* The mesh's positions = x; a vertex that has not moved keeps its coordinates to the bit. */
GPROJI_INTERNAL void gproji_store_positions(gproj_form *form) {
    const double *x = gproj_system_values(form->system);
    int32_t i;
    for (i = 0; i < form->mesh->vertex_count; ++i) {
        double before[3], *position = form->mesh->position + 3 * (size_t)i;
        gproji_to_internal(form, position, before);
        if (memcmp(before, x + 3 * (size_t)i, sizeof before) != 0)
            gproji_from_internal(form, x + 3 * (size_t)i, position);
    }
}

/* Is there a wish with a weight other than the default guidance? */
GPROJI_INTERNAL bool gproji_has_active_wish(const gproj_form *form) {
    int32_t g;
    for (g = 0; g < gproj_system_group_count(form->system); ++g) {
        gproj_group_info info = gproj_system_group_info(form->system, g);
        bool guidance = g == form->closeness || (form->statics && g == form->statics->guidance);
        if (!guidance && !form->system->group[g].guard && info.kind == GPROJ_WISH && info.schedule.weight > 0 &&
            info.rows > 0)
            return true;
    }
    return false;
}

/* Half of the iterations, rounded up and at least 1: as long as wishes last by default. */
GPROJI_INTERNAL int32_t gproji_half(int32_t iterations) { return gproji_max(1, iterations / 2 + iterations % 2); }

/* Where no wish guides, closeness to where this solve begins does, with weights 0.03 * 0.3^n in the first half, at
   most 5 times. Guidance that fades more slowly moves the mesh less, but lets rounding of the input grow, and
   longer guidance leaves too few iterations for meshes near singular points. Returns the iteration in which guidance
   ends, 0 without any. Where the nearest mesh is asked for, closeness is what it is nearest by. */
GPROJI_INTERNAL int32_t gproji_set_default_guidance(gproj_form *form, int32_t iterations, bool skip, bool nearest) {
    bool others = gproji_has_active_wish(form), wanted = !skip && !others;
    int32_t half = gproji_half(iterations), i;
    gproj_schedule schedule;
    if (wanted && form->closeness < 0) form->closeness = gproj_add_closeness(form, 0);
    if (form->closeness >= 0) {
        schedule.weight = wanted ? 0.03 : 0;
        schedule.decay = 0.3;
        schedule.last = gproji_min(5, half);
        if (nearest && wanted) schedule.weight = 1, schedule.decay = 0, schedule.last = 0;
        gproj_system_set_schedule(form->system, form->closeness, schedule);
        for (i = 0; i < 3 * form->mesh->vertex_count; ++i)
            gproj_system_set_row(form->system, form->closeness, i, NULL, -gproj_system_values(form->system)[i]);
    }
    if (nearest) return GPROJI_NEAREST_GUIDED;
    return others ? half : wanted ? gproji_min(5, half) : 0;
}

/* How long wishes last that do not say so. In equilibrium they keep the shape away from it, and the longer the farther:
   then they get 9 iterations at most. */
GPROJI_INTERNAL int32_t gproji_guided_iterations(const gproj_form *form, int32_t iterations) {
    bool forces = form->statics && gproji_is_on(form, form->statics->group);
    return forces ? gproji_min(9, gproji_half(iterations)) : gproji_half(iterations);
}

/* -- what statics add to the verdict -- */

/* Is equilibrium, or a bound on forces, what does not hold? */
GPROJI_INTERNAL bool gproji_is_unbalanced(const gproj_form *form, const gproj_result *result) {
    const gproji_statics *s = form->statics;
    if (!s || !gproji_is_on(form, s->group)) return false;
    if (result->outcome != GPROJ_STALLED && result->outcome != GPROJ_ITERATION_LIMIT) return false;
    return gproj_system_group_info(form->system, s->group).max > 1e-9;
}

/* The three rows of equilibrium with the largest |phi|, of different vertices; -1 where there are fewer. */
GPROJI_INTERNAL void gproji_worst_balanced(const gproj_form *form, int32_t vertex[3], double *largest) {
    const gproji_group *g = &form->system->group[form->statics->group];
    double phi[3] = {0, 0, 0};
    int32_t r, k;
    for (k = 0; k < 3; ++k) vertex[k] = -1;
    for (r = 0; r < g->row_count; ++r) {
        double size = fabs(g->row[r].phi);
        int32_t v = g->row[r].element;
        for (k = 0; k < 3 && vertex[k] != v && vertex[k] >= 0; ++k) continue; /* its place, or a free one */
        if (k == 3) k = 2;
        if (!(size > phi[k])) continue;
        phi[k] = size;
        vertex[k] = v;
        for (; k > 0 && phi[k] > phi[k - 1]; --k) {
            double other = phi[k - 1];
            int32_t w = vertex[k - 1];
            phi[k - 1] = phi[k], vertex[k - 1] = vertex[k];
            phi[k] = other, vertex[k] = w;
        }
    }
    *largest = phi[0];
}

GPROJI_INTERNAL bool gproji_has_group_on(const gproj_form *form, const char *name) {
    int32_t g;
    for (g = 0; g < form->system->group_count; ++g)
        if (strcmp(form->system->group[g].name, name) == 0 && gproji_is_on(form, g)) return true;
    return false;
}

/* Says that no equilibrium was found, which one, and where it is missing. */
GPROJI_INTERNAL void gproji_tell_unbalanced(gproj_form *form, gproj_result *result) {
    bool up = gproji_has_group_on(form, gproji_compression_name), down = gproji_has_group_on(form, gproji_tension_name);
    const char *kind = up && down ? "" : up ? "compression-only " : down ? "tension-only " : "";
    const char *planar = gproji_is_on(form, form->planarity) ? " with planar faces" : "";
    gproj_forces forces = gproj_measure_forces(form);
    size_t length = strlen(result->message);
    char others[48];
    int32_t vertex[3];
    double largest;
    gproji_worst_balanced(form, vertex, &largest);
    gproji_format(others, sizeof others, "vertex ");
    if (vertex[2] >= 0) gproji_format(others, sizeof others, "vertices %d, %d, ", vertex[2], vertex[1]);
    gproji_format(result->message + length, sizeof result->message - length,
                  "; no %sequilibrium%s was found near this shape: %s%d out of balance by up to %g of the largest load",
                  kind, planar, others, vertex[0], forces.residual);
}

/* The largest |phi| of the rows of equilibrium that count, over the largest part of a load on a vertex; 0 without loads.
   `largest`: that part, in the form's units. -1 after an error. */
GPROJI_INTERNAL double gproji_part_unbalanced(gproj_form *form, double *largest) {
    const gproji_group *g = &form->system->group[form->statics->group];
    size_t count = 3 * (size_t)form->mesh->vertex_count, i;
    double worst = 0, *load = (double *)gproji_take(&form->own, count, sizeof *load);
    int32_t r;
    *largest = 0;
    if (!load) {
        gproji_fail_memory(&form->error);
        return -1;
    }
    gproji_loads_at(form->mesh, &form->statics->loads, gproji_internal_loads(form), gproj_system_values(form->system),
                    load);
    for (i = 0; i < count; ++i) *largest = gproji_fmax(*largest, fabs(load[i]));
    gproji_give(&form->own, load, count, sizeof *load);
    for (r = 0; r < g->row_count; ++r)
        if (g->row[r].weight > 0) worst = gproji_fmax(worst, fabs(g->row[r].phi));
    return *largest > 0 ? worst / *largest : 0;
}

/* Do some of the loads follow the shape, so that they vanish with it? */
GPROJI_INTERNAL bool gproji_loads_follow(const gproj_loads *loads, int32_t edges) {
    int32_t e;
    for (e = 0; loads->edge_density && e < edges; ++e)
        if (loads->edge_density[e] != 0) return true;
    return (!loads->edge_density && loads->density != 0) || loads->area_load != 0 || loads->snow != 0;
}

/* Equilibrium to the tolerance says nothing where the loads themselves are below it: where the mesh has shrunk to a
   point, or beside huge forces. */
GPROJI_INTERNAL void gproji_doubt_equilibrium(gproj_form *form, gproj_result *result) {
    static const double noticeable = 1e-3;
    const gproji_statics *s = form->statics;
    double part, largest;
    if (!s || !gproji_is_on(form, s->group) || result->outcome != GPROJ_CONVERGED) return;
    part = gproji_part_unbalanced(form, &largest);
    if (part < 0) {
        *result = gproji_failed_result(gproj_form_error(form));
    } else if (largest == 0 && gproji_loads_follow(&s->loads, form->mesh->edge_count)) {
        result->outcome = GPROJ_STALLED;
        gproji_format(result->message, sizeof result->message,
                      "no equilibrium: the mesh has shrunk to a point, and its loads with it; fix vertices or let them "
                      "glide");
    } else if (part > noticeable && largest <= 10 * result->tolerance) {
        result->outcome = GPROJ_STALLED;
        gproji_format(result->message, sizeof result->message,
                      "no equilibrium: the loads have become nothing beside the forces, and %g of the largest load is "
                      "unbalanced; where the mesh has shrunk to a point, fix vertices or let them glide",
                      part);
    }
}

/* Does a row hold vertices in space: linear in them, and not the same wherever the mesh is moved to; or quadratic in
   them, as lengths and areas are? Differences of vertices, and products with normals, do not hold. */
GPROJI_INTERNAL bool gproji_row_holds(const gproj_form *form, const gproji_group *g, const gproji_row *row) {
    int32_t vertices = 3 * form->mesh->vertex_count;
    double sum[3] = {0, 0, 0};
    int64_t t;
    for (t = row->term; t < row[1].term; ++t) {
        int32_t i = gproji_variable_of(g, row, g->term[t].i), j = gproji_variable_of(g, row, g->term[t].j);
        if (i >= vertices) continue;
        if (j >= 0 && j < vertices) return true;
        if (j < 0) sum[i % 3] += g->term[t].a;
    }
    return fabs(sum[0]) + fabs(sum[1]) + fabs(sum[2]) > 1e-9;
}

/* Would a bound's row be violated by a mesh that has shrunk to a point? (At the origin: bounds of lengths and areas do
   not depend on where it is.) */
GPROJI_INTERNAL bool gproji_bound_holds(const gproji_row *row) { return row->constant < 0; }

/* Is there a group with a weight whose rows hold the mesh, so that fairness cannot shrink it to a point? */
GPROJI_INTERNAL bool gproji_is_held(const gproj_form *form) {
    int32_t i, r;
    for (i = 0; i < form->system->group_count; ++i) {
        const gproji_group *g = &form->system->group[i];
        for (r = 0; !g->guard && g->schedule.weight > 0 && r < g->row_count; ++r) {
            const gproji_row *row = &g->row[r];
            if (!(row->weight > 0)) continue;
            if (g->kind == GPROJ_BOUND ? gproji_bound_holds(row) : g->global || gproji_row_holds(form, g, row))
                return true;
        }
    }
    return false;
}

/* -- what else the verdict must not hide -- */

/* Edges without length at the system's x, and the mean length. */
GPROJI_INTERNAL int32_t gproji_collapsed_edges(const gproj_form *form, double *mean) {
    const gproj_mesh *mesh = form->mesh;
    const double *x = gproj_system_values(form->system);
    int32_t e, collapsed = 0;
    *mean = 0;
    for (e = 0; e < mesh->edge_count; ++e) {
        double length = gproji_distance3(x + 3 * (size_t)mesh->origin[2 * e], x + 3 * (size_t)mesh->origin[2 * e + 1]);
        collapsed += length <= 1e-6;
        *mean += length / mesh->edge_count;
    }
    return collapsed;
}

/* A mesh can satisfy everything and yet be spoiled: says so. `collapsed`, `mean`: what they were before. */
GPROJI_INTERNAL void gproji_tell_spoiled(const gproj_form *form, int32_t collapsed, double mean, gproj_result *result) {
    size_t length = strlen(result->message);
    double mean_now;
    int32_t more = gproji_collapsed_edges(form, &mean_now) - collapsed;
    if (result->outcome != GPROJ_CONVERGED) return;
    if (mean_now < 0.2 * mean)
        gproji_format(result->message + length, sizeof result->message - length,
                      "; but the mesh has shrunk to %g of its size: fix vertices or add a reference", mean_now / mean);
    else if (more > 0)
        gproji_format(result->message + length, sizeof result->message - length, "; but %d edge%s collapsed", more,
                      more == 1 ? " has" : "s have");
}

GPROJ_API gproj_result gproj_solve(gproj_form *form, int32_t iterations, const gproj_solve_options *options) {
    static const char shrinks[] =
        "; nothing holds the mesh, so the wishes may shrink it: fix vertices or add a reference";
    gproj_result result;
    int32_t guided, collapsed;
    double mean;
    if (!gproji_form_ready(form) || !gproji_positions_are_finite(form))
        return gproji_failed_result(gproj_form_error(form));
    gproji_load_positions(form);
    gproji_restart_gliding(form);
    gproji_begin_forces(form);
    if (form->statics && options && options->nearest) gproji_set_force_guidance(form, false); /* forces are free */
    if (!gproji_form_ready(form)) return gproji_failed_result(gproj_form_error(form));
    gproji_restart_planes(form);
    guided =
        gproji_set_default_guidance(form, iterations, options && options->skip_closeness, options && options->nearest);
    gproji_set_guard(form, guided, options && options->skip_guard);
    if (!gproji_form_ready(form)) return gproji_failed_result(gproj_form_error(form));
    collapsed = gproji_collapsed_edges(form, &mean);
    form->system->default_last = gproji_guided_iterations(form, iterations);
    result = gproj_system_solve(form->system, iterations, options);
    form->system->default_last = 0;
    if (result.outcome == GPROJ_FAILED) return result;
    gproji_doubt_equilibrium(form, &result);
    if (result.outcome == GPROJ_FAILED) return result;
    gproji_store_positions(form);
    if (gproji_has_active_wish(form) && !gproji_is_held(form))
        gproji_append(result.message, sizeof result.message, strlen(result.message), shrinks, sizeof shrinks - 1);
    if (gproji_is_unbalanced(form, &result)) gproji_tell_unbalanced(form, &result);
    gproji_tell_spoiled(form, collapsed, mean, &result);
    return result;
}

#endif /* GPROJI_IMPLEMENTED */
#endif /* GUIDEDPROJ_IMPLEMENTATION */
