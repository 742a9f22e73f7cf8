/* statics_suite.c - does equilibrium come out? Each mesh, its boundary supported, with and without planar faces,
   compression only and with forces of either sign, under its own weight and a load per area.

   Run:    statics_suite MESH.obj ...       or: make statics-suite MESHES='a.obj b.obj'
           statics_suite --paper MESH.obj ...  the recipe of the paper, for comparison: compression by squares, w = s^2
                                               with variables s, full steps, constant epsilon, no guard
   Prints: a line for each case: solved (all constraints to 1e-9), or out of reach: then how much of the load the best
           forces leave at the shape where it ended, and whether five starts from disturbed meshes did better by more
           than 2 times ("not a minimum"). At the end the share of each. Exit code 1 if a case is neither. */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

enum {
    ITERATIONS = 40,
    STARTS = 5
};

typedef struct suite_case {
    bool planar, compressive, area;
} suite_case;

typedef struct suite_end {
    gproj_result result;
    double residual;    /* of all constraints */
    double equilibrium; /* largest imbalance over the largest load */
    double left;        /* the same by the best forces for the shape at the end, over the mean load */
    double moved;
} suite_end;

/* w_e - s_e^2 = 0 for every force (paper 3.1), s_e variables that start at 1. */
static void add_squares(gproj_form *form, int32_t edges) {
    gproj_system *system = gproj_form_system(form);
    gproj_group group = {"squares", GPROJ_CONSTRAINT, false, GPROJ_PLACE_EDGE, {1, 0, 0}, NULL, NULL};
    int32_t number = gproj_system_add_group(system, &group), e;
    for (e = 0; e < edges; ++e) {
        double one = 1;
        gproj_term term[2] = {{gproj_force_variable(form, e), -1, 1}, {0, 0, -1}};
        if (term[0].i < 0) continue;
        term[1].i = term[1].j = gproj_system_add_variables(system, 1, 1, &one);
        gproj_system_add_row(system, number, 2, term, 0, e);
    }
}

static gproj_form *make_form(gproj_mesh *mesh, const suite_case *what, bool paper) {
    gproj_form *form = gproj_form_create(mesh, NULL);
    int32_t *boundary = (int32_t *)malloc(((size_t)mesh->vertex_count + 1) * sizeof *boundary), v;
    gproj_supports supports = {0, NULL, NULL};
    gproj_loads loads = {0, NULL, 0, 0, NULL};
    if (!boundary) return NULL;
    for (v = 0; v < mesh->vertex_count; ++v)
        if (gproj_mesh_is_boundary_vertex(mesh, v)) boundary[supports.count++] = v;
    supports.vertex = boundary;
    loads.density = what->area ? 0 : 1;
    loads.area_load = what->area ? 1 : 0;
    if (what->planar) gproj_add_planarity(form, 1);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    if (what->compressive && paper) add_squares(form, mesh->edge_count);
    if (what->compressive && !paper) gproj_add_compression(form, mesh->edge_count, NULL, 1);
    free(boundary);
    return form;
}

static suite_end run(gproj_mesh *mesh, const double *original, const suite_case *what, bool paper) {
    gproj_form *form = make_form(mesh, what, paper);
    gproj_solve_options options;
    double *left = (double *)calloc((size_t)mesh->vertex_count + 1, sizeof *left);
    suite_end end;
    int32_t v;
    memset(&end, 0, sizeof end);
    memset(&options, 0, sizeof options);
    options.epsilon = paper ? 1e-3 : 0;
    options.skip_damping = options.skip_closeness = options.skip_guard = paper;
    end.result = gproj_solve(form, ITERATIONS, &options);
    end.residual = end.result.residual;
    end.equilibrium = gproj_measure_forces(form).residual;
    end.moved = gproj_measure(mesh, original, NULL).displacement_mean;
    if (left && gproj_find_forces(form, NULL, left) == GPROJ_OK)
        for (v = 0; v < mesh->vertex_count; ++v) end.left = left[v] > end.left ? left[v] : end.left;
    free(left);
    gproj_form_destroy(form);
    return end;
}

/* The smallest residual of all from meshes whose vertices were moved at random by up to 0.05 mean edges. */
static double best_of_disturbed(gproj_mesh *mesh, const double *original, const suite_case *what, bool paper) {
    double best = HUGE_VAL, size;
    uint32_t noise = 1;
    int32_t start, i;
    for (start = 0; start < STARTS; ++start) {
        memcpy(mesh->position, original, 3 * (size_t)mesh->vertex_count * sizeof *original);
        size = 0.1 * gproj_mesh_mean_edge_length(mesh);
        for (i = 0; i < 3 * mesh->vertex_count; ++i) {
            noise = noise * 1664525u + 1013904223u;
            mesh->position[i] += size * ((noise >> 8) / 16777216.0 - 0.5);
        }
        best = fmin(best, run(mesh, original, what, paper).residual);
    }
    return best;
}

int main(int count, char **path) {
    int32_t k, c, total = 0, solved = 0, infeasible = 0, most = 0;
    bool paper = count > 1 && strcmp(path[1], "--paper") == 0;
    printf("%-24s %-7s %-12s %-5s  %s\n", "mesh", "faces", "forces", "load", "outcome");
    for (k = 1 + paper; k < count; ++k) {
        gproj_error error;
        gproj_mesh *mesh = gproj_mesh_load(path[k], NULL, &error);
        const char *name = strrchr(path[k], '/') ? strrchr(path[k], '/') + 1 : path[k];
        double *original;
        if (!mesh) return printf("%s: %s\n", path[k], error.message), 2;
        original = (double *)malloc((3 * (size_t)mesh->vertex_count + 1) * sizeof *original);
        if (!original) return puts("out of memory"), 2;
        memcpy(original, mesh->position, 3 * (size_t)mesh->vertex_count * sizeof *original);
        for (c = 0; c < 8; ++c) {
            suite_case what = {c < 4, c % 4 < 2, c % 2 == 1};
            suite_end end;
            memcpy(mesh->position, original, 3 * (size_t)mesh->vertex_count * sizeof *original);
            end = run(mesh, original, &what, paper);
            printf("%-24s %-7s %-12s %-5s  ", name, what.planar ? "planar" : "any",
                   what.compressive ? "compression" : "any", what.area ? "area" : "own");
            ++total;
            if (end.residual <= 1e-9) {
                ++solved;
                most = end.result.iterations > most ? end.result.iterations : most;
                printf("solved in %d, moved %.2f edges\n", (int)end.result.iterations, end.moved);
            } else {
                double best = best_of_disturbed(mesh, original, &what, paper);
                bool minimum = end.left > 1e-9 && 2 * best >= end.residual;
                infeasible += minimum;
                printf("out of reach after %d: residual %.1e, the best forces leave %.1e of the load; disturbed starts "
                       "%.1e%s\n",
                       (int)end.result.iterations, end.residual, end.left, best, minimum ? "" : " (not a minimum)");
            }
            fflush(stdout);
        }
        free(original);
        gproj_mesh_destroy(mesh);
    }
    printf("%d cases: %d solved in at most %d iterations, %d out of reach, %d undecided\n", (int)total, (int)solved,
           (int)most, (int)infeasible, (int)(total - solved - infeasible));
    return solved + infeasible < total;
}
