/* report.h - a solve as JSON, for the command line: counts, every iteration, verdict, measures, seconds.

       gprojx_history_keep(&history, form, system, iteration);         from gproj_solve_options.on_iteration
       if (gprojx_report_write(file, &report) != GPROJ_OK) ...

   Include guidedproj.h before this file. Memory by malloc; no global state. */
#ifndef GPROJX_REPORT_H
#define GPROJX_REPORT_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json.h"

typedef struct gprojx_group_record {
    double weight, norm, max;
} gprojx_group_record;

typedef struct gprojx_record { /* of one iteration */
    gproj_iteration iteration;
    double planarity_max, planarity_mean;
    int32_t group_start, group_count; /* in gprojx_history.group */
} gprojx_record;

typedef struct gprojx_history { /* zeroed: empty */
    gproj_mesh *probe;          /* a copy of the mesh, for measures of the shape between iterations */
    gprojx_record *record;
    gprojx_group_record *group;
    int32_t record_count, record_capacity, group_count, group_capacity;
} gprojx_history;

typedef struct gprojx_report {
    const char *version, *input, *output;
    const gproj_mesh *mesh;
    gproj_form *form;
    const gprojx_history *history;
    const gproj_result *result;
    bool nearest; /* the solve was: iterations and result have an optimality */
    int exit_code;
    const gproj_measures *before, *after;
    double volume_before, volume;
    const double *cost;                  /* before and after; NULL: the mesh is not priced */
    const gproj_forces *forces;          /* NULL: no statics */
    const gproj_offset_measures *offset; /* NULL: no offset */
    const char *offset_kind;
    double offset_distance;
    double reading, set_up, solving, total; /* seconds */
} gprojx_report;

/* ---- history ---- */

/* Returns the list with room for `needed` entries, moved if it has to grow; NULL without memory. */
static void *gprojx_grown(void *list, int32_t *capacity, int32_t needed, size_t size) {
    if (needed <= *capacity) return list;
    list = realloc(list, 2 * (size_t)needed * size);
    if (list) *capacity = 2 * needed;
    return list;
}

/* Appends an iteration, with its groups and the planarity of the shape after it; false without memory. */
static bool gprojx_history_keep(gprojx_history *history, const gproj_form *form, gproj_system *system,
                                const gproj_iteration *iteration) {
    const double *values = gproj_system_values(system);
    double centre[3], scale = 1;
    int32_t groups = gproj_system_group_count(system), i;
    gprojx_record *record = (gprojx_record *)gprojx_grown(history->record, &history->record_capacity,
                                                          history->record_count + 1, sizeof *record);
    gprojx_group_record *group;
    if (!record) return false;
    history->record = record;
    group = (gprojx_group_record *)gprojx_grown(history->group, &history->group_capacity,
                                                history->group_count + groups + 1, sizeof *group);
    if (!group) return false;
    history->group = group;
    record = &history->record[history->record_count++];
    record->iteration = *iteration;
    record->group_start = history->group_count;
    record->group_count = groups;
    for (i = 0; i < groups; ++i) {
        gproj_group_info info = gproj_system_group_info(system, i);
        group = &history->group[history->group_count++];
        group->weight = info.weight;
        group->norm = info.rms * sqrt((double)info.rows);
        group->max = info.max;
    }
    /* Vertex i is variables 3 i .. 3 i + 2, in the form's units. */
    gproj_form_units(form, centre, &scale);
    for (i = 0; i < 3 * history->probe->vertex_count; ++i)
        history->probe->position[i] = centre[i % 3] + values[i] / scale;
    record->planarity_max = gproj_measure_planarity(history->probe, NULL, &record->planarity_mean);
    return true;
}

static void gprojx_history_free(gprojx_history *history) {
    gproj_mesh_destroy(history->probe);
    free(history->record), free(history->group);
}

/* ---- parts of the report ---- */

/* Names an element, as "vertex": 7; nothing for rows that belong to none, such as that of a volume. */
static void gprojx_report_element(gprojx_json *j, gproj_place place, int32_t element) {
    if (element < 0) return;
    if (place == GPROJ_PLACE_VERTEX) gprojx_json_integer(j, "vertex", element);
    if (place == GPROJ_PLACE_EDGE) gprojx_json_integer(j, "edge", element);
    if (place == GPROJ_PLACE_FACE) gprojx_json_integer(j, "face", element);
}

static const char *gprojx_outcome_name(gproj_outcome outcome) {
    switch (outcome) {
    case GPROJ_CONVERGED: return "converged";
    case GPROJ_ITERATION_LIMIT: return "iteration limit";
    case GPROJ_STALLED: return "stalled";
    case GPROJ_CANCELLED: return "cancelled";
    case GPROJ_TIME_OUT: return "time out";
    default: return "failed";
    }
}

/* How many faces have this many sides. */
static int32_t gprojx_count_degree(const gproj_mesh *mesh, int32_t degree) {
    int32_t i, count = 0;
    for (i = 0; i < mesh->face_count; ++i) count += mesh->face_degree[i] == degree;
    return count;
}

/* The smallest degree of a face above `degree`; 0: there is none. */
static int32_t gprojx_next_degree(const gproj_mesh *mesh, int32_t degree) {
    int32_t i, best = 0;
    for (i = 0; i < mesh->face_count; ++i)
        if (mesh->face_degree[i] > degree && (best == 0 || mesh->face_degree[i] < best)) best = mesh->face_degree[i];
    return best;
}

static void gprojx_report_mesh(gprojx_json *j, const gproj_mesh *mesh) {
    int32_t degree;
    gprojx_json_open(j, "mesh", '{');
    gprojx_json_integer(j, "vertices", mesh->vertex_count);
    gprojx_json_integer(j, "edges", mesh->edge_count);
    gprojx_json_integer(j, "faces", mesh->face_count);
    gprojx_json_open_row(j, "faces_by_degree");
    for (degree = gprojx_next_degree(mesh, 0); degree > 0; degree = gprojx_next_degree(mesh, degree)) {
        char key[16];
        snprintf(key, sizeof key, "%ld", (long)degree);
        gprojx_json_integer(j, key, gprojx_count_degree(mesh, degree));
    }
    gprojx_json_close(j, '}');
    gprojx_json_integer(j, "boundary_loops", mesh->loop_count);
    gprojx_json_integer(j, "components", mesh->component_count);
    gprojx_json_integer(j, "isolated_vertices", mesh->isolated_count);
    gprojx_json_integer(j, "reoriented_faces", mesh->reoriented_count);
    gprojx_json_close(j, '}');
}

static void gprojx_report_groups(gprojx_json *j, gproj_system *system) {
    static const char *const kind[] = {"constraint", "bound", "wish"};
    int32_t count = gproj_system_group_count(system), i;
    int64_t rows = 0;
    for (i = 0; i < count; ++i) rows += gproj_system_group_info(system, i).rows;
    gprojx_json_integer(j, "variables", gproj_system_variable_count(system));
    gprojx_json_integer(j, "rows", rows);
    gprojx_json_open(j, "groups", '[');
    for (i = 0; i < count; ++i) {
        gproj_group_info group = gproj_system_group_info(system, i);
        bool ends = group.schedule.last > 0 && group.schedule.last < INT32_MAX;
        gprojx_json_open_row(j, NULL);
        gprojx_json_string(j, "name", group.name);
        gprojx_json_string(j, "kind", kind[group.kind == GPROJ_CONSTRAINT ? 0 : group.kind == GPROJ_BOUND ? 1 : 2]);
        gprojx_json_number(j, "weight", group.schedule.weight);
        gprojx_json_number(j, "decay", group.schedule.decay);
        gprojx_json_number(j, "last_iteration", ends ? group.schedule.last : INFINITY);
        gprojx_json_integer(j, "rows", group.rows);
        gprojx_json_number(j, "norm", group.rms * sqrt((double)group.rows));
        gprojx_json_number(j, "max", group.max);
        gprojx_report_element(j, group.place, group.worst_element);
        gprojx_json_close(j, '}');
    }
    gprojx_json_close(j, ']');
}

static void gprojx_report_phases(gprojx_json *j, const double *seconds) {
    gprojx_json_number(j, "analysis", seconds[GPROJ_PHASE_ANALYSE]);
    gprojx_json_number(j, "evaluation", seconds[GPROJ_PHASE_REFRESH]);
    gprojx_json_number(j, "assembly", seconds[GPROJ_PHASE_ASSEMBLE]);
    gprojx_json_number(j, "factorisation", seconds[GPROJ_PHASE_FACTOR]);
    gprojx_json_number(j, "solve", seconds[GPROJ_PHASE_SOLVE]);
}

static void gprojx_report_iteration(gprojx_json *j, const gprojx_report *report, const gprojx_record *record) {
    const gproj_iteration *iteration = &record->iteration;
    const gprojx_group_record *group = report->history->group + record->group_start;
    int32_t i;
    gprojx_json_open(j, NULL, '{');
    gprojx_json_integer(j, "number", iteration->number);
    gprojx_json_number(j, "residual", iteration->residual);
    gprojx_json_number(j, "planarity_max", record->planarity_max);
    gprojx_json_number(j, "planarity_mean", record->planarity_mean);
    gprojx_json_number(j, "merit", iteration->merit);
    gprojx_json_number(j, "energy", iteration->energy);
    gprojx_json_number(j, "step", iteration->step);
    if (report->nearest) gprojx_json_number(j, "optimality", iteration->optimality);
    gprojx_json_number(j, "epsilon", iteration->epsilon);
    gprojx_json_integer(j, "factorisations", iteration->factorisations);
    gprojx_json_open(j, "groups", '[');
    for (i = 0; i < record->group_count; ++i) {
        gprojx_json_open_row(j, NULL);
        gprojx_json_string(j, "name", gproj_system_group_info(gproj_form_system(report->form), i).name);
        gprojx_json_number(j, "weight", group[i].weight);
        gprojx_json_number(j, "norm", group[i].norm);
        gprojx_json_number(j, "max", group[i].max);
        gprojx_json_close(j, '}');
    }
    gprojx_json_close(j, ']');
    gprojx_json_open_row(j, "seconds");
    gprojx_report_phases(j, iteration->seconds);
    gprojx_json_close(j, '}');
    gprojx_json_close(j, '}');
}

static void gprojx_report_result(gprojx_json *j, const gprojx_report *report) {
    const gproj_result *result = report->result;
    const gproj_spoiled *spoiled = &result->spoiled;
    gprojx_json_open(j, "result", '{');
    gprojx_json_string(j, "outcome", gprojx_outcome_name(result->outcome));
    gprojx_json_integer(j, "exit_code", report->exit_code);
    gprojx_json_string(j, "sentence", result->message);
    gprojx_json_integer(j, "iterations", result->iterations);
    gprojx_json_integer(j, "damped", result->damped);
    gprojx_json_integer(j, "attempts", result->attempts);
    gprojx_json_number(j, "residual", result->residual);
    gprojx_json_number(j, "tolerance", result->tolerance);
    gprojx_json_number(j, "last_step", result->step);
    if (report->nearest) gprojx_json_number(j, "optimality", result->optimality);
    if (result->worst_group >= 0) {
        gproj_group_info group = gproj_system_group_info(gproj_form_system(report->form), result->worst_group);
        gprojx_json_open(j, "worst", '{');
        gprojx_json_string(j, "group", group.name);
        gprojx_report_element(j, group.place, result->worst_element);
        gprojx_json_close(j, '}');
    }
    gprojx_json_open(j, "spoiled", '{');
    gprojx_json_integer(j, "total", spoiled->total);
    gprojx_json_integer(j, "turned_faces", spoiled->turned);
    gprojx_json_integer(j, "crossed_faces", spoiled->crossed);
    gprojx_json_integer(j, "folded_edges", spoiled->folded);
    gprojx_json_integer(j, "collapsed_edges", spoiled->collapsed_edges);
    gprojx_json_integer(j, "collapsed_faces", spoiled->collapsed_faces);
    gprojx_json_integer(j, "spikes", spoiled->spikes);
    if (spoiled->total > 0) {
        gprojx_json_open(j, "first", '{');
        gprojx_report_element(j, spoiled->place, spoiled->element);
        gprojx_json_close(j, '}');
    }
    gprojx_json_close(j, '}');
    gprojx_json_close(j, '}');
}

/* cost: NULL: the mesh is not priced. */
static void gprojx_report_measures(gprojx_json *j, const char *key, const gproj_measures *m, double volume,
                                   const double *cost) {
    gprojx_json_open(j, key, '{');
    gprojx_json_number(j, "planarity_max", m->planarity_max);
    gprojx_json_number(j, "planarity_mean", m->planarity_mean);
    gprojx_json_integer(j, "planarity_face", m->planarity_face);
    gprojx_json_number(j, "diagonal_distance_max", m->diagonal_max);
    gprojx_json_number(j, "circularity_max", m->circularity_max);
    gprojx_json_number(j, "conicality_max", m->conicality_max);
    gprojx_json_number(j, "area_spread", m->area_spread);
    gprojx_json_number(j, "deviation_max", m->deviation_max);
    gprojx_json_number(j, "deviation_rms", m->deviation_rms);
    gprojx_json_number(j, "displacement_mean", m->displacement_mean);
    gprojx_json_number(j, "displacement_max", m->displacement_max);
    gprojx_json_integer(j, "displacement_vertex", m->displacement_vertex);
    gprojx_json_integer(j, "turned_faces", m->turned_faces);
    gprojx_json_integer(j, "folded_edges", m->folded_edges);
    gprojx_json_integer(j, "bow_tie_faces", m->bow_tie_faces);
    gprojx_json_integer(j, "degenerate_faces", m->degenerate_faces);
    gprojx_json_integer(j, "degenerate_edges", m->degenerate_edges);
    gprojx_json_number(j, "gauss_variation", m->gauss_variation);
    gprojx_json_number(j, "mean_edge", m->mean_edge);
    gprojx_json_number(j, "min_edge", m->min_edge);
    gprojx_json_number(j, "max_edge", m->max_edge);
    gprojx_json_number(j, "length", m->length);
    gprojx_json_number(j, "volume", volume);
    gprojx_json_number(j, "area", m->area);
    gprojx_json_number(j, "min_face_area", m->min_face_area);
    gprojx_json_number(j, "max_face_area", m->max_face_area);
    if (cost) gprojx_json_number(j, "cost", *cost);
    gprojx_json_close(j, '}');
}

static void gprojx_report_forces(gprojx_json *j, const gproj_forces *m) {
    gprojx_json_open(j, "forces", '{');
    gprojx_json_number(j, "equilibrium_residual", m->residual);
    gprojx_json_integer(j, "residual_vertex", m->residual_vertex);
    gprojx_json_number(j, "min_density", m->min_density);
    gprojx_json_number(j, "max_density", m->max_density);
    gprojx_json_number(j, "min_force", m->min_force);
    gprojx_json_number(j, "max_force", m->max_force);
    gprojx_json_number(j, "load_path", m->load_path);
    gprojx_json_number(j, "total_load", m->total_load);
    gprojx_json_number(j, "max_reaction", m->max_reaction);
    gprojx_json_close(j, '}');
}

static void gprojx_report_offset(gprojx_json *j, const gprojx_report *report) {
    const gproj_offset_measures *m = report->offset;
    gprojx_json_open(j, "offset", '{');
    gprojx_json_string(j, "kind", report->offset_kind);
    gprojx_json_number(j, "distance", report->offset_distance);
    gprojx_json_number(j, "face_distance_min", m->face_distance_min);
    gprojx_json_number(j, "face_distance_max", m->face_distance_max);
    gprojx_json_number(j, "vertex_distance_min", m->vertex_distance_min);
    gprojx_json_number(j, "vertex_distance_max", m->vertex_distance_max);
    gprojx_json_number(j, "parallel_max", m->parallel_max);
    gprojx_json_number(j, "support_planarity_max", m->support_planarity_max);
    gprojx_json_integer(j, "reversed_edges", m->reversed_edges);
    gprojx_json_close(j, '}');
}

static gproj_code gprojx_report_write(FILE *file, const gprojx_report *report) {
    gprojx_json writer = {NULL, 0, false, false}, *j = &writer;
    int32_t i;
    writer.file = file;
    gprojx_json_open(j, NULL, '{');
    gprojx_json_string(j, "version", report->version);
    gprojx_json_string(j, "input", report->input);
    gprojx_json_string(j, "output", report->output);
    gprojx_report_mesh(j, report->mesh);
    gprojx_report_groups(j, gproj_form_system(report->form));
    gprojx_json_open(j, "iterations", '[');
    for (i = 0; i < report->history->record_count; ++i) gprojx_report_iteration(j, report, &report->history->record[i]);
    gprojx_json_close(j, ']');
    gprojx_report_result(j, report);
    gprojx_report_measures(j, "measures_before", report->before, report->volume_before, report->cost);
    gprojx_report_measures(j, "measures", report->after, report->volume, report->cost ? report->cost + 1 : NULL);
    if (report->forces) gprojx_report_forces(j, report->forces);
    if (report->offset) gprojx_report_offset(j, report);
    gprojx_json_open(j, "seconds", '{');
    gprojx_json_number(j, "reading", report->reading);
    gprojx_json_number(j, "set_up", report->set_up);
    gprojx_report_phases(j, report->result->seconds);
    gprojx_json_number(j, "all_iterations", report->solving);
    gprojx_json_number(j, "total", report->total);
    gprojx_json_close(j, '}');
    gprojx_json_close(j, '}');
    fputc('\n', file);
    return ferror(file) ? GPROJ_ERROR_FILE : GPROJ_OK;
}

#endif
