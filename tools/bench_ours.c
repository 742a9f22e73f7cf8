/* bench_ours.c - one build of our solver for tools/bench: BENCH_NAME is its table's name, and GPROJ_NO_SIMD or
   GPROJ_USE_CBLAS make it another one. The only part that looks inside the library. */
#define GPROJ_STATIC
#include "guidedproj.h"
#include "bench.h"
#include "threads.h"

struct bench_form {
    gproj_mesh *mesh;
    gproj_form *form;
    double *start; /* the mesh's positions */
    double *force; /* the densities at the start; NULL without statics */
    gprojx_threads *threads;
    double rows_seconds, analyse_seconds, rows_bytes;
    double held, peak; /* bytes of the form and all it makes, now and at most */
    bench_visit visit;
    void *user;
    bench_task task;
    bool guided; /* the next iteration */
};

static double bench_processor_time(void *user) { return (void)user, bench_now(); }
static double bench_wall_time(void *user) { return (void)user, bench_wall(); }

/* Memory that is counted: gproj_form_memory adds up the peaks of its parts, which need not come together. */
static void *bench_count(bench_form *f, void *block, size_t old_size, size_t new_size) {
    if (!block) return NULL;
    f->held += (double)new_size - (double)old_size;
    if (f->held > f->peak) f->peak = f->held;
    return block;
}
static void *bench_allocate(void *user, size_t size) { return bench_count((bench_form *)user, malloc(size), 0, size); }
static void *bench_reallocate(void *user, void *block, size_t old_size, size_t new_size) {
    return bench_count((bench_form *)user, realloc(block, new_size), old_size, new_size);
}
static void bench_release(void *user, void *block, size_t size) {
    ((bench_form *)user)->held -= (double)size;
    free(block);
}

static void bench_destroy_form(bench_form *f) {
    if (!f) return;
    gproj_form_destroy(f->form);
    gproj_mesh_destroy(f->mesh);
    gprojx_threads_destroy(f->threads);
    free(f->start);
    free(f->force);
    free(f);
}

static void bench_add_statics(bench_form *f) {
    int32_t v, e, *support = (int32_t *)bench_take((size_t)f->mesh->vertex_count, sizeof *support);
    gproj_loads loads;
    gproj_supports supports;
    memset(&loads, 0, sizeof loads);
    memset(&supports, 0, sizeof supports);
    loads.area_load = 1;
    supports.vertex = support;
    for (v = 0; v < f->mesh->vertex_count; ++v)
        if (gproj_mesh_is_boundary_vertex(f->mesh, v)) support[supports.count++] = v;
    gproj_add_fixed_boundary(f->form, 1);
    gproj_add_equilibrium(f->form, &loads, &supports, 1);
    free(support);
    /* The dome's: see bench_grid_points. */
    f->force = (double *)bench_take((size_t)f->mesh->edge_count, sizeof *f->force);
    for (e = 0; e < f->mesh->edge_count; ++e) f->force[e] = 1;
}

static void bench_add_rows(bench_form *f, bench_task task) {
    gproj_add_planarity(f->form, 1);
    if (task == BENCH_STATICS) bench_add_statics(f);
    if (task == BENCH_FAIRNESS) gproj_set_schedule(f->form, gproj_add_fairness(f->form, 0.2), gproj_keep(0.2));
    f->task = task;
    if (task == BENCH_VOLUME) gproj_add_volume(f->form, gproj_volume(f->mesh), 1);
}

static bench_form *bench_create_form(const bench_mesh *mesh, bench_task task, int32_t workers) {
    bench_form *f = (bench_form *)bench_take(1, sizeof *f);
    size_t size = 3 * (size_t)mesh->vertex_count * sizeof(double);
    gproj_host host;
    gproj_error error;
    double began;
    memset(&host, 0, sizeof host);
    host.clock.now = workers ? bench_wall_time : bench_processor_time;
    host.allocator.allocate = bench_allocate;
    host.allocator.reallocate = bench_reallocate;
    host.allocator.release = bench_release;
    host.allocator.user = f;
    if (workers > 1) f->threads = gprojx_threads_create(workers);
    host.parallel = gprojx_threads_hook(f->threads);
    f->mesh = gproj_mesh_create(mesh->vertex_count, mesh->position, mesh->face_count, mesh->degree, mesh->corner, NULL,
                                &error);
    if (!f->mesh) {
        fprintf(stderr, "bench: %s\n", error.message);
        bench_destroy_form(f);
        return NULL;
    }
    f->start = (double *)bench_take(1, size);
    memcpy(f->start, mesh->position, size);
    began = bench_now();
    f->form = gproj_form_create(f->mesh, &host);
    bench_add_rows(f, task);
    f->rows_seconds = bench_now() - began;
    f->rows_bytes = f->held;
    return f;
}

static bool bench_after_iteration(void *user, gproj_system *system, const gproj_iteration *iteration) {
    static const gproj_phase phase[BENCH_PHASES] = {GPROJ_PHASE_REFRESH, GPROJ_PHASE_ASSEMBLE, GPROJ_PHASE_FACTOR,
                                                    GPROJ_PHASE_SOLVE};
    bench_form *f = (bench_form *)user;
    bench_step step;
    int p;
    step.once = iteration->factorisations == 1;
    if (!step.once && f->task != BENCH_DEFAULT) {
        fprintf(stderr, "bench: %d factorisations in one iteration\n", (int)iteration->factorisations);
        return false;
    }
    for (p = 0; p < BENCH_PHASES; ++p) step.seconds[p] = iteration->seconds[phase[p]];
    step.number = iteration->number;
    step.variables = system->variable_count;
    step.dx = system->vector.step;
    step.largest = iteration->step;
    step.guided = f->guided;
    f->guided = system->stiffness > 0;
    return f->visit(f->user, &step);
}

static bool bench_solve_form(bench_form *f, int32_t iterations, bench_visit visit, void *user) {
    gproj_solve_options options;
    gproj_result result;
    memset(&options, 0, sizeof options);
    if (f->task == BENCH_DEFAULT) {
        options.smooth = f->guided = true;
    } else {
        options.epsilon = BENCH_EPSILON;
        options.skip_damping = options.skip_closeness = options.skip_guard = true;
    }
    options.on_iteration = bench_after_iteration;
    options.user = f;
    f->visit = visit;
    f->user = user;
    memcpy(f->mesh->position, f->start, 3 * (size_t)f->mesh->vertex_count * sizeof(double));
    if (f->force) gproj_set_forces(f->form, f->force, NULL);
    result = gproj_solve(f->form, iterations, &options);
    if (result.seconds[GPROJ_PHASE_ANALYSE] > f->analyse_seconds)
        f->analyse_seconds = result.seconds[GPROJ_PHASE_ANALYSE];
    if (result.outcome == GPROJ_FAILED) fprintf(stderr, "bench: %s\n", result.message);
    return result.outcome != GPROJ_FAILED;
}

static bench_facts bench_facts_of_form(const bench_form *f) {
    gproj_cholesky_info info = gproj_cholesky_get_info(f->form->system->cholesky);
    bench_facts facts;
    facts.vertices = f->mesh->vertex_count;
    facts.unknowns = info.columns;
    facts.entries = (double)info.exact_entries;
    facts.flops = info.flops;
    facts.part_seconds = f->rows_seconds;
    facts.setup_seconds = f->rows_seconds + f->analyse_seconds;
    facts.rows_bytes = f->rows_bytes;
    facts.peak_bytes = f->peak;
    return facts;
}

/* Iterations take right-hand sides along while they factor; CHOLMOD does not. */
static double bench_factor_form(bench_form *f) {
    gproj_system *s = f->form->system;
    double began = bench_now();
    bool done = s->schur.on
                    ? gproji_cholesky_factor_with(s->cholesky, gproji_schur_load_front, s, 0, NULL) == GPROJ_FACTORED
                    : gproji_factor_matrix(s, BENCH_EPSILON, false, 0, NULL);
    return done ? bench_now() - began : HUGE_VAL;
}

/* -- the rows as they are linearised now -- */

static bool bench_takes_part(const gproji_group *g, const gproji_row *row) {
    return g->weight > 0 && row->weight > 0 && !row->wide;
}

static void bench_take_rows(const bench_form *f, bench_rows *rows) {
    const gproj_system *s = f->form->system;
    size_t count = 0, entries = 0;
    int32_t i, r;
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; r < g->row_count; ++r) {
            if (!bench_takes_part(g, &g->row[r])) continue;
            ++count;
            entries += (size_t)(g->row[r + 1].local - g->row[r].local);
        }
    }
    rows->rows = (int32_t)count;
    rows->variables = s->variable_count;
    rows->start = (int64_t *)bench_take(count + 1, sizeof *rows->start);
    rows->regularisation = (double *)bench_take((size_t)s->variable_count, sizeof *rows->regularisation);
    rows->phi = (double *)bench_take(count, sizeof *rows->phi);
    rows->weight2 = (double *)bench_take(count, sizeof *rows->weight2);
    rows->variable = (int32_t *)bench_take(entries, sizeof *rows->variable);
    rows->gradient = (double *)bench_take(entries, sizeof *rows->gradient);
}

/* One more entry, at `end`, of the row that begins at `start`: kept ascending. */
static void bench_insert(bench_rows *rows, int64_t start, int64_t end, int32_t variable, double gradient) {
    for (; end > start && rows->variable[end - 1] > variable; --end) {
        rows->variable[end] = rows->variable[end - 1];
        rows->gradient[end] = rows->gradient[end - 1];
    }
    rows->variable[end] = variable;
    rows->gradient[end] = gradient;
}

/* The metric of steps by multipliers at a node: 1, and more beside small faces. */
static double bench_metric_at(const gproji_schur *schur, int32_t node) {
    double metric = 1;
    int64_t k;
    for (k = schur->w.entry_start[node]; schur->turns[node] && k < schur->w.entry_start[node + 1]; ++k)
        metric += schur->share[schur->w.entry[k]];
    return metric;
}

/* eps^2 for all variables; where steps are found by multipliers, none for auxiliary ones and more at small faces. */
static void bench_regularise(gproj_system *s, bench_rows *rows) {
    int32_t v;
    if (s->schur.on) gproji_schur_assemble(s, BENCH_EPSILON);
    for (v = 0; v < s->variable_count; ++v) {
        double metric = !s->schur.on ? 1 : s->blocks.auxiliary[v] ? 0 : bench_metric_at(&s->schur, s->nodes.of[v]);
        rows->regularisation[v] = BENCH_EPSILON * BENCH_EPSILON * metric;
    }
}

static void bench_rows_of_form(bench_form *f, bench_rows *rows) {
    const gproj_system *s = f->form->system;
    int64_t filled = 0, count = 0, l;
    int32_t i, r;
    if (!rows->start) bench_take_rows(f, rows);
    for (i = 0; i < s->group_count; ++i) {
        const gproji_group *g = &s->group[i];
        for (r = 0; r < g->row_count; ++r) {
            const gproji_row *row = &g->row[r];
            if (!bench_takes_part(g, row)) continue;
            rows->phi[count] = row->phi;
            rows->weight2[count] = gproji_weight2(g, row);
            rows->start[count++] = filled;
            for (l = row->local; l < row[1].local; ++l)
                bench_insert(rows, rows->start[count - 1], filled++, g->local.variable[l], g->local.gradient[l]);
        }
    }
    rows->start[count] = filled;
    bench_regularise(f->form->system, rows);
}

static bool bench_load_mesh(const char *path, bench_mesh *mesh) {
    gproj_mesh *m = gproj_mesh_load(path, NULL, NULL);
    int32_t f, k, h, *corner;
    memset(mesh, 0, sizeof *mesh);
    if (!m) return false;
    mesh->vertex_count = m->vertex_count;
    mesh->face_count = m->face_count;
    mesh->position = (double *)bench_take((size_t)m->vertex_count, 3 * sizeof(double));
    mesh->degree = (int32_t *)bench_take((size_t)m->face_count, sizeof(int32_t));
    mesh->corner = corner = (int32_t *)bench_take((size_t)m->halfedge_count, sizeof(int32_t));
    memcpy(mesh->position, m->position, 3 * (size_t)m->vertex_count * sizeof(double));
    memcpy(mesh->degree, m->face_degree, (size_t)m->face_count * sizeof(int32_t));
    for (f = 0; f < m->face_count; ++f)
        for (k = 0, h = m->face_halfedge[f]; k < m->face_degree[f]; ++k, h = m->next[h]) *corner++ = m->origin[h];
    gproj_mesh_destroy(m);
    return true;
}

const bench_solver BENCH_NAME = {bench_load_mesh,   bench_create_form,  bench_destroy_form, bench_solve_form,
                                 bench_factor_form, bench_rows_of_form, bench_facts_of_form};
