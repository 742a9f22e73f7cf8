/* compare.c - five ways to planar faces, three to circular ones: Figure 10 of "Form-finding with Polyhedral Meshes Made
   Simple" in full. Each method is a file, compare_*.h, written from the mathematics of its paper:

       guided projection    normals are variables: the library                        Tang et al. 2014
       guided, nearest      on to the nearest planar mesh, by multipliers: the library
       guided, cubic        the same steps on determinants, without normals           Tang et al. 2014, Figure 10 (C)
       Shape-Up             local planes, global least squares                        Bouaziz et al. 2012
       ADMM                 augmented Lagrangian, hard constraints                    Deng et al. 2014
       alternating          normals and vertices by turns, with a growing penalty     Poranne et al. 2013

   All begin from the same mesh and are close to the same positions. What weighs planarity against closeness is tuned on
   a small grid for each method: of the runs that end within 4 times the deviation of guided projection, the one with the
   least residual, and of those below 1e-12 the one with the fewest iterations to there. Guided projection has the
   library's weights, untuned. The residual is the planarity, the largest distance of a corner from its face's
   least-squares plane in mean edge lengths, and in the second comparison the larger of planarity and circularity;
   deviation is the root mean square of the distances from the start over the bounding box's diagonal. All run on one
   thread; seconds are those of the processor, and their ratios hold within one run.

   Run:     compare [--quick] [--iterations N] [--mesh FILE] [FOLDER]
   Prints:  the methods' claims on small cases, the tuning, and a table for each comparison
   Writes:  plots and pictures to the folder, if one is given
   Exits:   with 1 if a claim fails, with 2 if it cannot run */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"
#include "../examples/grid.h"
#include "compare_claims.h"
#include "compare_report.h"

#include <sys/stat.h>

static const compare_method *const compare_methods[COMPARE_METHODS] = {
    &compare_projection, &compare_nearest, &compare_cubic, &compare_shapeup, &compare_admm, &compare_poranne};

typedef struct compare_options {
    bool quick;
    int32_t iterations;
    const char *mesh, *folder;
} compare_options;

enum {
    COMPARE_SIDE = 30,
    COMPARE_QUICK_SIDE = 12
};

/* A wavy roof over a square with side 20: a translational surface, whose quads are planar, twisted and dented. */
static void compare_roof(int32_t i, int32_t j, int32_t side, double p[3]) {
    double x = p[0] = 20.0 * i / side - 10, y = p[1] = 20.0 * j / side - 10;
    p[2] = 2.2 * cos(0.32 * x) + 1.6 * cos(0.22 * y + 0.001 * x * x) + 0.03 * sin(x + 2 * y);
}

/* A part of a dented funnel, bent by an inversion, x -> c + r^2 (x - c) / |x - c|^2, which keeps circles. */
static void compare_funnel(int32_t i, int32_t j, int32_t side, double p[3]) {
    const double centre[3] = {9, 0, 5};
    double turn = 2.6 * j / side - 0.3, z = 5.6 * i / side, square;
    double radius = 1.6 + 0.08 * z * z + 0.03 * sin(26 * turn / 3 + z);
    int32_t k;
    p[0] = radius * cos(turn) - centre[0], p[1] = radius * sin(turn) - centre[1], p[2] = z - centre[2];
    square = compare_dot(p, p);
    for (k = 0; k < 3; ++k) p[k] = centre[k] + 60 * p[k] / square;
}

static void compare_roof_full(int32_t i, int32_t j, double p[3]) { compare_roof(i, j, COMPARE_SIDE, p); }
static void compare_roof_quick(int32_t i, int32_t j, double p[3]) { compare_roof(i, j, COMPARE_QUICK_SIDE, p); }
static void compare_funnel_full(int32_t i, int32_t j, double p[3]) { compare_funnel(i, j, COMPARE_SIDE, p); }
static void compare_funnel_quick(int32_t i, int32_t j, double p[3]) { compare_funnel(i, j, COMPARE_QUICK_SIDE, p); }

/* Loads or makes the mesh, with mean edge length 1. */
static gproj_mesh *compare_load(const compare_options *options, bool circular) {
    int32_t side = options->quick ? COMPARE_QUICK_SIDE : COMPARE_SIDE;
    gproj_error error;
    gproj_mesh *mesh = options->mesh ? gproj_mesh_load(options->mesh, NULL, &error)
                       : circular
                           ? make_grid(side, side, options->quick ? compare_funnel_quick : compare_funnel_full, &error)
                           : make_grid(side, side, options->quick ? compare_roof_quick : compare_roof_full, &error);
    double mean = mesh ? gproj_mesh_mean_edge_length(mesh) : 0;
    int32_t i, polygons = 0;
    for (i = 0; mesh && i < mesh->face_count; ++i) polygons += mesh->face_degree[i] > 3;
    if (!mesh || polygons == 0) compare_fail(mesh ? "the mesh has no faces with more than 3 sides" : error.message);
    for (i = 0; i < 3 * mesh->vertex_count; ++i) mesh->position[i] /= mean;
    return mesh;
}

static void compare_all(const compare_options *options, bool circular) {
    gproj_mesh *mesh = compare_load(options, circular);
    const char *what = circular ? "circularity" : "planarity";
    compare_run run[COMPARE_METHODS];
    double deviation = INFINITY;
    int count = 0, k;
    printf("%s faces, %d iterations: %d vertices, %d faces\n", circular ? "Circular" : "Planar", options->iterations,
           mesh->vertex_count, mesh->face_count);
    printf("  tuning               penalty growth %12s  iterations    deviation  spoiled\n", what);
    for (k = 0; k < COMPARE_METHODS; ++k) {
        if (circular && !compare_methods[k]->circular) continue;
        run[count++] = compare_tune(compare_methods[k], mesh, circular, options->iterations, deviation);
        if (count == 1) deviation = 4 * compare_last(&run[0], run[0].deviation);
    }
    compare_print_table(count, run, what);
    if (options->folder)
        compare_draw(options->folder, circular ? "circular" : "planar",
                     circular ? "Planarity or circularity, the larger" : "Planarity", count, run, mesh);
    for (k = 0; k < count; ++k) compare_run_free(&run[k]);
    gproj_mesh_destroy(mesh);
}

static void compare_usage(void) {
    fputs("usage: compare [--quick] [--iterations N] [--mesh FILE] [FOLDER]\n", stderr);
    exit(2);
}

/* A whole number from 1 to 100,000; 0: it is none. */
static int32_t compare_read_count(const char *text) {
    char *end;
    long count = strtol(text, &end, 10);
    return end != text && !*end && count >= 1 && count <= 100000 ? (int32_t)count : 0;
}

static compare_options compare_read_options(int count, char **argument) {
    compare_options options = {false, 0, NULL, NULL};
    bool counted = false;
    int k;
    for (k = 1; k < count; ++k) {
        if (strcmp(argument[k], "--quick") == 0)
            options.quick = true;
        else if (strcmp(argument[k], "--iterations") == 0 && k + 1 < count)
            options.iterations = compare_read_count(argument[++k]), counted = true;
        else if (strcmp(argument[k], "--mesh") == 0 && k + 1 < count)
            options.mesh = argument[++k];
        else if (argument[k][0] != '-' && !options.folder)
            options.folder = argument[k];
        else
            compare_usage();
    }
    if (counted && options.iterations == 0) compare_usage();
    if (!counted) options.iterations = options.quick ? 100 : 1000;
    return options;
}

int main(int count, char **argument) {
    compare_options options = compare_read_options(count, argument);
    if (options.folder) mkdir(options.folder, 0777);
    compare_show_claims();
    compare_all(&options, false);
    compare_all(&options, true);
    return compare_failures > 0;
}
