/* statics_suite.c - does equilibrium come out? Each mesh, its boundary supported and free to move, fixed or gliding along
   itself, with and without planar faces, compression only and with forces of either sign, under its own weight and a load
   per area: 24 cases.

   Run:    statics_suite MESH.obj ...       or: make statics-suite MESHES='a.obj b.obj'
           statics_suite --paper MESH.obj ...  the recipe of the paper, for comparison: compression by squares, w = s^2
                                               with variables s, full steps, constant epsilon, no guard
   Prints: a line for each case: solved (all constraints to 1e-9), and then how many places are spoiled: faces that turned
           over or cross themselves, folds, edges below a tenth of their length; certified: impossible, because of a face
           that is held by fixed vertices and is not flat; out of reach, without a proof: the best forces leave some of
           the load at the shape where it ended (for this shape, gproj_find_imbalance proves that), and a few starts from
           disturbed meshes did not do better by more than 2 times; else undecided. At the end how many of each, for each
           kind of boundary. Exit code 1 if a case is undecided, or solved and spoiled. */

#define GUIDEDPROJ_IMPLEMENTATION
#include "../guidedproj.h"

enum {
    ITERATIONS = 300,
    STARTS = 3,
    CASES = 24
};

enum {
    FREE,
    FIXED,
    GLIDING,
    BOUNDARIES
};

static const char *const boundary_name[] = {"free", "fixed", "gliding"};

typedef struct suite_case {
    int boundary;
    bool planar, compressive, area;
} suite_case;

typedef struct suite_end {
    gproj_result result;
    double residual; /* of all constraints */
    double left;     /* the imbalance by the best forces for the shape at the end, over the mean load */
    double moved;
    int32_t spoiled;
} suite_end;

/* What became of the cases with one kind of boundary. */
typedef struct suite_count {
    int32_t cases, solved, sound, certified, out_of_reach, most;
} suite_count;

/* w_e - s_e^2 = 0 for every force (paper 3.1), s_e variables that start at 1. */
static void add_squares(gproj_form *form, int32_t edges) {
    gproj_system *system = gproj_form_system(form);
    gproj_group group = {"squares", GPROJ_CONSTRAINT, false, GPROJ_PLACE_EDGE, gproj_keep(1), NULL, NULL};
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
    if (what->boundary == FIXED) gproj_add_fixed_boundary(form, 1);
    if (what->boundary == GLIDING) gproj_add_gliding_boundary(form, 1);
    gproj_add_equilibrium(form, &loads, &supports, 1);
    if (what->compressive && paper) add_squares(form, mesh->edge_count);
    if (what->compressive && !paper) gproj_add_compression(form, mesh->edge_count, NULL, 1);
    free(boundary);
    return form;
}

/* The places that are spoiled beside the original: see the comment at the top. */
static int32_t count_spoiled(gproj_mesh *mesh, double *original) {
    gproj_measures now = gproj_measure(mesh, original, NULL), before;
    double *position = mesh->position, mean;
    int32_t short_edges = 0, e;
    mesh->position = original; /* the original's own measures */
    before = gproj_measure(mesh, NULL, NULL);
    mesh->position = position;
    mean = before.mean_edge;
    for (e = 0; e < mesh->edge_count; ++e) {
        const double *p = position + 3 * mesh->origin[2 * e], *q = position + 3 * mesh->origin[2 * e + 1];
        const double *a = original + 3 * mesh->origin[2 * e], *b = original + 3 * mesh->origin[2 * e + 1];
        double was =
            sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
        double is = sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
        short_edges += is < 0.1 * was && is < 0.1 * mean;
    }
    return short_edges + now.turned_faces + (int32_t)fmax(0, now.folded_edges - before.folded_edges) +
           (int32_t)fmax(0, now.bow_tie_faces - before.bow_tie_faces);
}

static suite_end run(gproj_mesh *mesh, double *original, const suite_case *what, bool paper) {
    gproj_form *form = make_form(mesh, what, paper);
    gproj_solve_options options;
    double *left = (double *)calloc(3 * (size_t)mesh->vertex_count + 1, sizeof *left);
    suite_end end;
    int32_t v;
    memset(&end, 0, sizeof end);
    memset(&options, 0, sizeof options);
    options.epsilon = paper ? 1e-3 : 0;
    options.skip_damping = options.skip_closeness = options.skip_guard = paper;
    options.smooth = !paper;
    end.result = gproj_solve(form, ITERATIONS, &options);
    end.residual = end.result.residual;
    end.moved = gproj_measure(mesh, original, NULL).displacement_mean;
    end.spoiled = count_spoiled(mesh, original);
    if (left && gproj_find_imbalance(form, left, NULL) == GPROJ_OK)
        for (v = 0; v < 3 * mesh->vertex_count; ++v) end.left = fmax(end.left, fabs(left[v]));
    free(left);
    gproj_form_destroy(form);
    return end;
}

/* The smallest residual of all from meshes whose vertices were moved at random by up to 0.05 mean edges. */
static double best_of_disturbed(gproj_mesh *mesh, double *original, const suite_case *what, bool paper) {
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

/* Runs one case, prints its line and counts it. */
static void run_case(gproj_mesh *mesh, double *original, const suite_case *what, bool paper, suite_count *count) {
    suite_end end;
    double best;
    memcpy(mesh->position, original, 3 * (size_t)mesh->vertex_count * sizeof *original);
    end = run(mesh, original, what, paper);
    ++count->cases;
    if (end.residual <= 1e-9) {
        ++count->solved;
        count->sound += end.spoiled == 0;
        count->most = end.result.iterations > count->most ? end.result.iterations : count->most;
        printf("solved in %d, moved %.2f edges", (int)end.result.iterations, end.moved);
        if (end.spoiled) printf(", %d places spoiled", (int)end.spoiled);
    } else if (strstr(end.result.message, "cannot become flat")) {
        ++count->certified;
        printf("certified: a face whose vertices are held cannot become flat");
    } else {
        bool minimum;
        best = best_of_disturbed(mesh, original, what, paper);
        minimum = end.left > 1e-9 && 2 * best >= end.residual;
        count->out_of_reach += minimum;
        printf("%s after %d: residual %.1e, the best forces leave %.1e of the load; disturbed starts %.1e",
               minimum ? "out of reach" : "undecided", (int)end.result.iterations, end.residual, end.left, best);
    }
    puts("");
    fflush(stdout);
}

int main(int count, char **path) {
    int32_t k, c;
    bool paper = count > 1 && strcmp(path[1], "--paper") == 0, good = true;
    suite_count sum[BOUNDARIES];
    memset(sum, 0, sizeof sum);
    if (count < 2 + paper || path[1 + paper][0] == '-')
        return puts("usage: statics_suite [--paper] MESH.{obj,off} ..."), 2;
    printf("%-24s %-8s %-7s %-12s %-5s  %s\n", "mesh", "boundary", "faces", "forces", "load", "outcome");
    for (k = 1 + paper; k < count; ++k) {
        gproj_error error;
        gproj_mesh *mesh = gproj_mesh_load(path[k], NULL, &error);
        const char *name = strrchr(path[k], '/') ? strrchr(path[k], '/') + 1 : path[k];
        double *original;
        if (!mesh) return printf("%s: %s\n", path[k], error.message), 2;
        original = (double *)malloc((3 * (size_t)mesh->vertex_count + 1) * sizeof *original);
        if (!original) return puts("out of memory"), 2;
        memcpy(original, mesh->position, 3 * (size_t)mesh->vertex_count * sizeof *original);
        for (c = 0; c < CASES; ++c) {
            suite_case what = {c / 8, c % 8 < 4, c % 4 < 2, c % 2 == 1};
            printf("%-24s %-8s %-7s %-12s %-5s  ", name, boundary_name[what.boundary], what.planar ? "planar" : "any",
                   what.compressive ? "compression" : "any", what.area ? "area" : "own");
            run_case(mesh, original, &what, paper, &sum[what.boundary]);
        }
        free(original);
        gproj_mesh_destroy(mesh);
    }
    for (c = 0; c < BOUNDARIES; ++c) {
        const suite_count *s = &sum[c];
        int32_t decided = s->certified + s->out_of_reach;
        good = good && s->sound + decided == s->cases;
        printf("boundary %-8s %d cases: %d solved in at most %d iterations, %d of them sound; %d certified, %d out of "
               "reach, "
               "%d undecided\n",
               boundary_name[c], (int)s->cases, (int)s->solved, (int)s->most, (int)s->sound, (int)s->certified,
               (int)s->out_of_reach, (int)(s->cases - s->solved - decided));
    }
    return !good;
}
