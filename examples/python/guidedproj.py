"""guidedproj.py - guidedproj.h for Python: this one file, ctypes and numpy.

    import numpy as np, guidedproj
    form = guidedproj.Form(V, F)      # V: n x 3 numbers; F: lists of corners, or an m x k array
    form.add_planarity()              # each returns the number of its group
    form.add_fixed_corners()
    result = form.solve(smooth=True)  # a verdict: result.outcome, result.message, ...
    print(result.message, form.V)     # V: the positions themselves, without a copy

The library   is compiled from guidedproj.h (beside this file, or two folders up) by the system's C compiler (CC, or cc, gcc,
    clang) at the first use, into a cache folder (GUIDEDPROJ_CACHE, or the user's). `python3 guidedproj.py [PATH]` does it
    at once and prints the path. GUIDEDPROJ_LIBRARY names a library that is compiled already, with GPROJ_API exported.
Names         are those of the header without gproj_: gproj_add_planarity(form, 1) is form.add_planarity(1), GPROJ_CONVERGED
    is Outcome.CONVERGED, structs are records with the same fields. Equations, units and sources stand in the header.
Lists         of vertices, edges or faces: None means all, an empty list none. In the options `supports`,
    `creases` and `corners` None, or an empty list, stands for the default that each function tells.
Errors        are raised as guidedproj.Error with the library's sentence, code, place and index. A form keeps its first
    error: make a new one. "Not converged" is a result, no error.
Callbacks     may raise: the solve is cancelled, and the exception comes out of the call. So does Control-C, after the
    iteration.
Lifetimes     Arrays like form.V are views of the library's memory, which lives as long as they do. close() (or `with`)
    gives an object up: it then raises Error, and the memory goes with the last view. Nothing has to be closed.
Threads       One object by one thread at a time, as in the header; a form with its mesh, system and drag is one object.
Tried         with CPython 3.11 and numpy 1.24 on Linux.
"""
import contextlib
import ctypes
import functools
import glob
import hashlib
import itertools
import math
import operator
import os
import platform
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import types
import weakref
from ctypes import byref, c_double, c_int32, c_int64, c_size_t, c_uint64, c_void_p
from enum import IntEnum

import numpy as np

VERSION = "0.2"  # of the header that this file belongs to

# ---- enumerations and structs ------------------------------------------------------------------------------------

ENUMS = {}    # the names in C: {"gproj_code": Code, ...}
STRUCTS = {}  # {"gproj_error": a ctypes.Structure, ...}


class _Int32(c_int32):
    """An int32_t argument: refuses numbers that do not fit, which ctypes would cut."""

    @classmethod
    def from_param(cls, value):
        number = operator.index(value)
        if not -2**31 <= number < 2**31:
            raise OverflowError(f"{number} does not fit into 32 bits")
        return c_int32(number)


_TYPES = {"void": None, "bool": ctypes.c_bool, "int32": c_int32, "int64": c_int64, "uint64": c_uint64, "size": c_size_t,
          "double": c_double, "pointer": c_void_p, "string": ctypes.c_char_p}


def _enum(name, python, prefix, members, values=None):
    """Defines an enumeration of the header, whose members follow each other from 0."""
    members = members.split()
    enum = IntEnum(python, list(zip(members, values or range(len(members)))), module=__name__)
    enum.__str__ = lambda member: f"{python}.{member.name}"
    enum.prefix = prefix
    ENUMS[name] = enum
    _TYPES[name.replace("gproj_", "")] = type(name, (c_int32,), {"enum": enum})
    return enum


Code = _enum("gproj_code", "Code", "GPROJ_", "OK ERROR_MEMORY ERROR_ARGUMENT ERROR_FILE ERROR_SYNTAX ERROR_NUMBER "
             "ERROR_INDEX ERROR_DEGENERATE ERROR_NON_MANIFOLD ERROR_NON_ORIENTABLE ERROR_SIZE ERROR_STATE")
Place = _enum("gproj_place", "Place", "GPROJ_PLACE_", "NONE VERTEX EDGE FACE LINE VARIABLE GROUP ROW COLUMN")
LeastSquaresOutcome = _enum("gproj_least_squares_outcome", "LeastSquaresOutcome", "GPROJ_LEAST_SQUARES_",
                            "SOLVED LIMIT FAILED")
Kind = _enum("gproj_kind", "Kind", "GPROJ_", "CONSTRAINT WISH BOUND")
Phase = _enum("gproj_phase", "Phase", "GPROJ_PHASE_", "ANALYSE REFRESH ASSEMBLE FACTOR SOLVE COUNT")
Outcome = _enum("gproj_outcome", "Outcome", "GPROJ_", "CONVERGED ITERATION_LIMIT STALLED CANCELLED TIME_OUT FAILED")
Format = _enum("gproj_format", "Format", "GPROJ_FORMAT_", "DETECT OBJ OFF")
Scheme = _enum("gproj_scheme", "Scheme", "GPROJ_", "CATMULL_CLARK LOOP")
Unit = _enum("gproj_unit", "Unit", "GPROJ_UNIT_", "NUMBER LENGTH POINT")
MESSAGE_SIZE, NAME_SIZE, LAST_GUIDING = 768, 32, -1


class _Struct(ctypes.Structure):
    """A struct of the header: refuses integers that do not fit into their fields, which ctypes would cut."""

    def __setattr__(self, name, value):
        kind = self._kinds.get(name, object)
        if issubclass(kind, (c_int32, c_int64, c_uint64, c_size_t)):
            value = operator.index(value)
            if kind(value).value != value:
                raise OverflowError(f"{name}: {value} does not fit into {8 * ctypes.sizeof(kind)} bits")
        super().__setattr__(name, value)


def _struct(name, fields):
    """Defines a struct of the header by its fields as in C: 'double min, max; double[3] point'."""
    list_of = []
    for part in fields.split(";"):
        kind, names = part.split(None, 1)
        base, _, length = kind.rstrip("]").partition("[")
        kind = ctypes.c_char if base == "char" else _TYPES[base]
        list_of += [(field.strip(), kind * int(length) if length else kind) for field in names.split(",")]
    struct = type(name, (_Struct,), {"_fields_": list_of, "_kinds": dict(list_of)})
    STRUCTS[name] = struct
    _TYPES[name.replace("gproj_", "")] = struct
    return struct


_struct("gproj_allocator", "pointer allocate, reallocate, release, user; size limit")
_struct("gproj_parallel", "pointer run, user")
_struct("gproj_clock", "pointer now, user")
_struct("gproj_host", "allocator allocator; parallel parallel; clock clock")
_struct("gproj_memory", "size used, peak; uint64 allocations")
_Error = _struct("gproj_error", "code code; place place; int64 index; char[768] message")
_LeastSquares = _struct("gproj_least_squares", "int32 rows, columns; pointer start, row, value, b, lower, upper; "
                        "double damping")
_LeastSquaresResult = _struct("gproj_least_squares_result", "least_squares_outcome outcome; int32 factorisations, "
                              "at_bounds; double residual, kkt; memory memory; size factor_bytes, work_bytes")
_Schedule = _struct("gproj_schedule", "double weight, decay; int32 last")
_Term = _struct("gproj_term", "int32 i, j; double a")
_Progress = _struct("gproj_progress", "int32 iteration, iterations, unguided; bool tangential, trial")
_Group = _struct("gproj_group", "string name; kind kind; bool global; place place; schedule schedule; "
                 "pointer refresh, refresh_user")
_struct("gproj_group_info", "char[32] name; kind kind; place place; schedule schedule; double weight; int32 rows; "
        "double max, rms; int32 worst_row, worst_element")
_Iteration = _struct("gproj_iteration", "int32 number; double residual, merit, energy, step, epsilon, length; "
                     "int32 factorisations; double optimality; double[5] seconds")
_SolveOptions = _struct("gproj_solve_options", "double tolerance, epsilon, time_budget; pointer on_iteration, user; "
                        "bool skip_damping, skip_closeness, skip_guard, smooth, nearest")
_struct("gproj_spoiled", "int32 turned, crossed, folded, collapsed_edges, collapsed_faces, spikes, total; place place; "
        "int32 element")
_struct("gproj_result", "outcome outcome; int32 iterations, damped, attempts; double residual, tolerance, step, "
        "optimality; int32 worst_group, worst_element; spoiled spoiled; double[5] seconds; char[768] message")
_Mesh = _struct("gproj_mesh", "int32 vertex_count, face_count, edge_count, halfedge_count, loop_count, component_count, "
                "isolated_count, reoriented_count; pointer position, vertex_halfedge, face_halfedge, face_degree, "
                "loop_halfedge, twin, next, prev, origin, face, edge; int32 polyline_count; pointer polyline_start, "
                "polyline_vertex")
_Edit = _struct("gproj_edit", "int32 vertex_count, edge_count, face_count; pointer position, vertex_halfedge, "
                "face_halfedge, face_degree, face_parent, next, prev, origin, face, vertex_number, edge_number, "
                "face_number")
_SubdivideOptions = _struct("gproj_subdivide_options", "scheme scheme; int32 levels, stencil_level, crease_count; "
                            "pointer creases, sharpness; int32 corner_count; pointer corners; bool round_corners")
_Stencil = _struct("gproj_stencil", "int32 row_count, column_count; pointer start, column, weight")
_struct("gproj_curve_hit", "double[3] point, tangent; double distance; int32 segment; double parameter")
_struct("gproj_surface_hit", "double[3] point, normal; double distance; int32 face")
_struct("gproj_measures", "double mean_edge, min_edge, max_edge, length, area, min_face_area, max_face_area, "
        "planarity_max, planarity_mean; int32 planarity_face; double circularity_max, area_spread, diagonal_max, "
        "conicality_max, deviation_max, deviation_rms, displacement_mean, displacement_max; int32 "
        "displacement_vertex, turned_faces, folded_edges, bow_tie_faces, degenerate_faces, degenerate_edges; double "
        "gauss_variation")
_struct("gproj_offset_measures", "double face_distance_min, face_distance_max, vertex_distance_min, "
        "vertex_distance_max, parallel_max, support_planarity_max; int32 reversed_edges")
_FillOptions = _struct("gproj_fill_options", "int32 corner_count; pointer corners; int32 side_count; "
                       "pointer subdivisions; double edge_length; bool keep_points; int32 rings, variant")
_FillInfo = _struct("gproj_fill_info", "int32 boundary_count, side_count, patch_count, irregular_count, min_valence, "
                    "max_valence; double min_angle, max_angle")
_Loads = _struct("gproj_loads", "double density; pointer edge_density; double area_load, snow; pointer point_load")
_Supports = _struct("gproj_supports", "int32 count; pointer vertex, slides")
_struct("gproj_forces", "double residual; int32 residual_vertex; double min_density, max_density, min_force, max_force, "
        "load_path, total_load, max_reaction")
_Handles = _struct("gproj_handles", "int32 count; pointer start, vertex, weight, position")
_DragOptions = _struct("gproj_drag_options", "double residual_bound; bool keep_wishes")
_struct("gproj_drag_info", "int32 handles, freedom, linearisations, solves; double behind")

# The functions, in the header's order: names without gproj_, enumerations and booleans in structs as above.
FUNCTIONS = {}  # {"gproj_version": (result, [arguments]), ...}
for _line in """
int32 version()
host default_host()
string code_string(int32)
int32 solve_least_squares(pointer, pointer, pointer, pointer, pointer)
schedule keep(double)
schedule fade(double, int32)
schedule guide(double)
pointer system_create(pointer)
void system_destroy(pointer)
pointer system_error(pointer)
memory system_memory(pointer)
int32 system_add_variables(pointer, int32, int32, pointer)
int32 system_variable_count(pointer)
pointer system_values(pointer)
int32 system_add_group(pointer, pointer)
int32 system_group_count(pointer)
group_info system_group_info(pointer, int32)
int32 system_set_schedule(pointer, int32, schedule)
int32 system_add_row(pointer, int32, int32, pointer, double, int32)
int32 system_set_row(pointer, int32, int32, pointer, double)
int32 system_set_row_weight(pointer, int32, int32, double)
double system_row_value(pointer, int32, int32, pointer)
double system_check_gradients(pointer)
result system_solve(pointer, int32, pointer)
pointer mesh_create(int32, pointer, int32, pointer, pointer, pointer, pointer)
pointer mesh_copy(pointer, pointer, pointer)
void mesh_destroy(pointer)
memory mesh_memory(pointer)
int32 mesh_valence(pointer, int32)
bool mesh_is_boundary_vertex(pointer, int32)
int32 mesh_one_ring(pointer, int32, pointer, int32)
void mesh_face_area_vector(pointer, int32, pointer)
double mesh_mean_edge_length(pointer)
pointer mesh_read(pointer, size, int32, pointer, pointer)
int32 mesh_write(pointer, int32, pointer, pointer, pointer)
pointer mesh_load(pointer, pointer, pointer)
int32 mesh_save(pointer, pointer, pointer)
pointer edit_create(pointer, pointer, pointer)
void edit_destroy(pointer)
memory edit_memory(pointer)
pointer edit_mesh(pointer, pointer, pointer)
int32 edit_vertex(pointer, int32)
int32 edit_edge(pointer, int32, int32)
int32 edit_split_edge(pointer, int32, double, pointer)
int32 edit_split_face(pointer, int32, int32, int32, pointer)
int32 edit_collapse_edge(pointer, int32, double, pointer)
int32 edit_triangulate(pointer, int32, pointer)
int32 edit_insert_strip(pointer, int32, double, pointer)
int32 edit_remove_strip(pointer, int32, double, pointer)
pointer mesh_dual(pointer, pointer, pointer, pointer)
pointer mesh_diagonals(pointer, pointer, pointer)
pointer mesh_subdivide(pointer, pointer, pointer, pointer, pointer)
void stencil_destroy(pointer)
memory stencil_memory(pointer)
void stencil_apply(pointer, int32, pointer, pointer)
pointer stencil_multiply(pointer, pointer, pointer, pointer)
pointer stencil_transpose(pointer, pointer, pointer)
pointer curve_create(int32, pointer, bool, pointer, pointer)
pointer curve_from_loop(pointer, int32, pointer, pointer)
pointer curve_from_polyline(pointer, int32, pointer, pointer)
void curve_destroy(pointer)
curve_hit curve_closest(pointer, pointer)
pointer surface_create(pointer, pointer, pointer)
void surface_destroy(pointer)
surface_hit surface_closest(pointer, pointer)
measures measure(pointer, pointer, pointer)
spoiled measure_spoiled(pointer, pointer)
double measure_planarity(pointer, pointer, pointer)
double volume(pointer)
pointer mesh_vertex_offset(pointer, double, pointer, pointer)
pointer mesh_face_offset(pointer, double, pointer, pointer)
pointer mesh_support(pointer, pointer, pointer, pointer)
offset_measures measure_offset(pointer, pointer)
pointer mesh_fill(int32, pointer, pointer, pointer, pointer, pointer)
pointer form_create(pointer, pointer)
void form_destroy(pointer)
pointer form_error(pointer)
memory form_memory(pointer)
pointer form_system(pointer)
void form_units(pointer, pointer, pointer)
int32 add_planarity(pointer, double)
int32 add_fixed(pointer, int32, pointer, double)
int32 add_fixed_boundary(pointer, double)
int32 add_fixed_corners(pointer, double)
int32 add_targets(pointer, int32, pointer, pointer, double)
int32 set_targets(pointer, int32, pointer)
int32 add_gliding(pointer, pointer, int32, pointer, double)
int32 add_gliding_boundary(pointer, double)
int32 add_circularity(pointer, double)
int32 add_conicality(pointer, double)
int32 add_lengths(pointer, int32, pointer, pointer, double)
int32 add_equal_lengths(pointer, int32, pointer, double)
int32 add_midsphere(pointer, int32, pointer, double)
int32 add_coplanar(pointer, int32, pointer, double)
int32 add_collinear(pointer, int32, pointer, double)
int32 add_planar_boundary(pointer, double)
int32 add_straight_boundary(pointer, double)
int32 add_orthogonal_edges(pointer, pointer, int32, pointer, double)
int32 add_orthogonal_boundary(pointer, double)
int32 add_lifting(pointer, double)
int32 add_volume(pointer, double, double)
int32 add_total_area(pointer, double, double)
int32 add_cost(pointer, double, double, double, double)
int32 add_length_bounds(pointer, int32, pointer, double, double, double)
int32 add_area_bounds(pointer, int32, pointer, double, double, double)
int32 add_total_area_bounds(pointer, double, double, double)
int32 add_cost_bounds(pointer, double, double, double, double, double)
int32 add_closeness(pointer, double)
int32 add_reference(pointer, pointer, double)
int32 add_fairness(pointer, double)
int32 add_boundary_fairness(pointer, double)
int32 add_tangential_fairness(pointer, double)
int32 add_gauss_fairness(pointer, double)
int32 add_parallelograms(pointer, double)
int32 add_equal_areas(pointer, double)
int32 add_rows(pointer, pointer, int32, int32, double)
int32 form_add_unknowns(pointer, int32, int32, int32, pointer, pointer, pointer)
int32 form_get_unknowns(pointer, int32, int32, pointer, pointer)
int32 form_add_row(pointer, int32, int32, pointer, double, int32)
int32 form_residuals(pointer, int32, pointer, pointer)
int32 set_schedule(pointer, int32, schedule)
int32 set_element_weights(pointer, int32, int32, pointer, pointer)
group_info form_group_info(pointer, int32)
bool form_is_corner(pointer, int32)
result solve(pointer, int32, pointer)
bool solve_begin(pointer, int32, pointer, pointer)
size solve_memory(pointer, pointer)
bool solve_is_on(pointer)
result solve_advance(pointer, double)
void solve_stop(pointer)
int32 add_equilibrium(pointer, pointer, pointer, double)
int32 add_compression(pointer, int32, pointer, double)
int32 add_tension(pointer, int32, pointer, double)
int32 add_stress_bounds(pointer, int32, pointer, pointer, double, double, double)
int32 add_force_fairness(pointer, double)
int32 get_forces(pointer, pointer, pointer)
int32 set_forces(pointer, pointer, pointer)
int32 force_variable(pointer, int32)
int32 get_loads(pointer, pointer, pointer)
int32 get_reactions(pointer, pointer, pointer)
int32 find_forces(pointer, pointer, pointer, pointer)
int32 find_imbalance(pointer, pointer, pointer)
forces measure_forces(pointer, pointer)
pointer drag_begin(pointer, pointer, pointer, pointer)
int32 drag_move(pointer, pointer)
double drag_residual(pointer)
drag_info drag_get_info(pointer)
pointer drag_error(pointer)
memory drag_memory(pointer)
result drag_end(pointer)
bool drag_release(pointer)
void drag_cancel(pointer)
int32 find_reach(pointer, int32, double, pointer, pointer)
size state_size(pointer)
int32 state_save(pointer, pointer, size, pointer)
int32 state_restore(pointer, pointer, size, pointer)
""".strip().split("\n"):
    _result, _rest = _line.split(" ", 1)
    _name, _rest = _rest.rstrip(")").split("(")
    FUNCTIONS["gproj_" + _name] = (_result, [argument for argument in _rest.split(", ") if argument])

# Parts of the interface that are not here, and why: names of functions, structs and enumerations that begin so.
LEFT_OUT = {
    "gproj_number_": "Python reads and writes the shortest decimal text itself",
    "gproj_cholesky": "scipy.sparse.linalg has factorisations for numpy's users",
    "gproj_ordering": "of gproj_cholesky",
    "gproj_factor_outcome": "of gproj_cholesky",
    "gproj_mesh_from_data": "numpy turns other arrays into those of gproj_mesh_create",
    "gproj_mesh_data": "of gproj_mesh_from_data",
}


# ---- errors and exceptions ---------------------------------------------------------------------------------------


class Error(Exception):
    """A refusal: the library's sentence with `code` (Code), `place` (Place) and `index` (-1: none), see >>api-error."""

    def __init__(self, message, code=Code.ERROR_ARGUMENT, place=Place.NONE, index=-1):
        super().__init__(message)
        self.code, self.place, self.index = Code(code), Place(place), index


def _failure(error):
    return Error(error.message.decode("utf-8", "replace"), error.code.value, error.place.value, error.index)


def code_string(code):
    """The general sentence for a code (gproj_code_string)."""
    return _lib().gproj_code_string(code).decode()


# What a callback has raised waits here until the call into the library is over: C has no exceptions.
_waiting = threading.local()


def _raise_waiting():
    exception = getattr(_waiting, "exception", None)
    if exception is not None:
        _waiting.exception = None
        raise exception


def _guarded(function, otherwise, always=False):
    """A callback that never raises: after an exception it returns `otherwise`, as do those that would follow."""

    def call(*arguments):
        try:
            if getattr(_waiting, "exception", None) is not None and not always:
                return otherwise
            _waiting.inside = True
            try:
                return function(*arguments)
            finally:
                _waiting.inside = False
        except BaseException as exception:  # KeyboardInterrupt as well
            _waiting.exception = getattr(_waiting, "exception", None) or exception
            return otherwise

    return call


@contextlib.contextmanager
def _interruptible():
    """For calls that take long: Control-C ends them at the next callback. Python would raise KeyboardInterrupt at the first
    line of a callback, before its `try`, where ctypes drops it; so it waits as well, unless the caller's code is under
    way."""
    outer, _waiting.inside = getattr(_waiting, "inside", False), False
    ours = threading.current_thread() is threading.main_thread() and \
        signal.getsignal(signal.SIGINT) is signal.default_int_handler

    def interrupt(number, frame):
        if _waiting.inside:
            raise KeyboardInterrupt
        _waiting.exception = KeyboardInterrupt()

    if ours:
        signal.signal(signal.SIGINT, interrupt)
    try:
        yield
    finally:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        _waiting.inside = outer
    _raise_waiting()  # an interrupt after the last callback


def _after(result, function, arguments):
    """Raises what callbacks have raised, when a function that returns no pointer has returned."""
    _raise_waiting()
    return result


_ON_ITERATION = ctypes.CFUNCTYPE(ctypes.c_bool, c_void_p, c_void_p, ctypes.POINTER(_Iteration))
_REFRESH = ctypes.CFUNCTYPE(None, c_void_p, c_void_p, c_int32, ctypes.POINTER(_Progress))
_START = ctypes.CFUNCTYPE(None, c_void_p, c_void_p, c_int32, c_int32, ctypes.POINTER(c_double))
_WRITE = ctypes.CFUNCTYPE(ctypes.c_bool, c_void_p, c_void_p, c_size_t)
_ALLOCATE = ctypes.CFUNCTYPE(c_void_p, c_void_p, c_size_t)
_REALLOCATE = ctypes.CFUNCTYPE(c_void_p, c_void_p, c_void_p, c_size_t, c_size_t)
_RELEASE = ctypes.CFUNCTYPE(None, c_void_p, c_void_p, c_size_t)
_NOW = ctypes.CFUNCTYPE(c_double, c_void_p)


# ---- the library -------------------------------------------------------------------------------------------------


def build(path=None, anew=False):
    """Compiles guidedproj.h into the shared library `path`, or into the cache folder unless it is there; `anew`: also then.
    Returns the absolute path."""
    here = os.path.dirname(os.path.abspath(__file__))
    headers = [os.path.join(here, "guidedproj.h"), os.path.join(here, "..", "..", "guidedproj.h")]
    header = next((os.path.normpath(name) for name in headers if os.path.isfile(name)), None)
    if not header:
        raise Error(f"there is no guidedproj.h in {here} or two folders up", Code.ERROR_FILE)
    try:
        compiler = shlex.split(os.environ.get("CC", "")) or \
            next(([name] for name in ("cc", "gcc", "clang") if shutil.which(name)), None)
    except ValueError as problem:
        raise Error(f"CC is no command, {os.environ['CC']!r}: {problem}", Code.ERROR_FILE) from None
    if not compiler or not shutil.which(compiler[0]):
        raise Error("there is no C compiler to compile guidedproj.h with: install one (Debian: apt-get install gcc "
                    "libc6-dev), name one in CC, or a compiled library in GUIDEDPROJ_LIBRARY", Code.ERROR_FILE)
    export = "__declspec(dllexport)" if os.name == "nt" else '__attribute__((visibility("default")))'
    command = [*compiler, "-std=c99", "-O2", "-shared", "-fPIC", "-fvisibility=hidden", "-DGUIDEDPROJ_IMPLEMENTATION",
               "-D_POSIX_C_SOURCE=200809L", "-DGPROJ_API=" + export]  # POSIX, for a clock of real time
    if path:
        path, other = os.path.abspath(path), "name another path"
    else:
        other = "GUIDEDPROJ_CACHE may name another folder"
        with open(header, "rb") as file:
            system = f"{sys.platform} {platform.machine()} {8 * ctypes.sizeof(c_void_p)}"
            digest = hashlib.sha256(file.read() + "\0".join([*command, system]).encode()).hexdigest()
        folder = os.environ.get("GUIDEDPROJ_CACHE") or os.path.join(
            os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache"), "guidedproj")
        cached = os.path.abspath(os.path.join(folder, f"guidedproj-{digest[:16]}-"))
        for found in glob.glob(glob.escape(cached) + "*.so"):
            if found == f"{cached}{os.path.getsize(found)}.so" and not anew:  # one that was cut off would end the process
                return found
        print(f"guidedproj: compiling {header} once, into {folder}", file=sys.stderr)
    folder = os.path.dirname(path or cached)
    try:
        os.makedirs(folder, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as work:  # whole or not at all, beside others that do the same
            made = os.path.join(work, "guidedproj.so")
            done = subprocess.run([*command, "-x", "c", header, "-o", made, "-lm"], stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            if done.returncode or not os.path.isfile(made):
                said = done.stdout.decode("utf-8", "replace").strip()
                raise Error(f"'{shlex.join(compiler)}' does not compile guidedproj.h: {said[:2000]}", Code.ERROR_FILE)
            path = path or f"{cached}{os.path.getsize(made)}.so"
            os.replace(made, path)
    except OSError as problem:
        raise Error(f"the library cannot be put into '{folder}': {problem}; {other}", Code.ERROR_FILE) from None
    return path


def _load(path):
    """Loads the library; one in the cache folder that does not load is compiled anew."""
    try:
        return ctypes.CDLL(path)
    except OSError:
        if os.environ.get("GUIDEDPROJ_LIBRARY"):
            raise
        return ctypes.CDLL(build(anew=True))


@functools.lru_cache(maxsize=None)
def _lib():
    path = os.environ.get("GUIDEDPROJ_LIBRARY") or build()
    try:
        library = _load(path)
        version = library.gproj_version()
    except (OSError, AttributeError) as problem:
        raise Error(f"'{path}' is no library of guidedproj.h that exports its functions: {problem}",
                    Code.ERROR_FILE) from None
    if f"{version // 1000}.{version % 1000}" != VERSION:
        raise Error(f"'{path}' is version {version // 1000}.{version % 1000} of the library, and this is the binding "
                    f"of version {VERSION}", Code.ERROR_FILE)
    arguments = {**_TYPES, "int32": _Int32}
    for name, (result, takes) in FUNCTIONS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = _TYPES[result], [arguments[take] for take in takes]
        if result != "pointer" and not name.endswith(("_destroy", "_cancel")):
            function.errcheck = _after  # not where the collector may call it, in the middle of another call
    return library


# ---- numbers to and from C ---------------------------------------------------------------------------------------


class Record(types.SimpleNamespace):
    """A struct of the header, copied: the same fields, with enumerations, strings and tuples."""


def _read(value):
    """What Python makes of a struct and of its fields."""
    if isinstance(value, ctypes.Structure):
        return Record(**{name: _read(getattr(value, name)) for name, _ in value._fields_})
    if isinstance(value, ctypes.Array):
        return tuple(value)
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value.enum(value.value) if hasattr(value, "enum") else value


def _doubles(values, shape, what):
    """float64 in C's order; `shape` has None where any length will do."""
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.ndim != len(shape) or any(want is not None and want != has for want, has in zip(shape, array.shape)):
        wanted = " x ".join("n" if want is None else str(want) for want in shape)
        raise ValueError(f"{what}: an array of {wanted} numbers is wanted, not of {' x '.join(map(str, array.shape))}")
    return array


def _integers(values, what, dtype=np.int32):
    array = np.atleast_1d(np.asarray(values)).ravel()
    if array.size == 0:
        return np.empty(0, dtype)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{what}: integers are wanted, not {array.dtype}")
    limits = np.iinfo(dtype)
    if array.min() < limits.min or array.max() > limits.max:
        raise OverflowError(f"{what}: a number does not fit into {limits.bits} bits")
    return np.ascontiguousarray(array, dtype=dtype)


def _list(elements, what):
    """count, list: None means all."""
    if elements is None:
        return 0, None
    array = _integers(elements, what)
    return len(array), array.ctypes


def _address(array):
    """For a field of a struct; the array must outlive it."""
    return None if array is None else array.ctypes.data


def _beside(values, elements, what):
    """Numbers beside a list, an entry for each: broadcast from one; None stays."""
    if values is None:
        return None
    array = np.asarray(values, np.float64)
    if array.shape not in ((), (1,), (elements,)):
        raise ValueError(f"{what}: one number or {elements} are wanted, not {' x '.join(map(str, array.shape))}")
    return np.ascontiguousarray(np.broadcast_to(array, (elements,)))


def _path(path):
    path = os.fsencode(path)
    if b"\0" in path:
        raise ValueError("a path has no NUL")
    return ctypes.c_char_p(path)


def _terms(terms):
    array = [(i, j, a) for i, j, a in terms]
    _integers([k for i, j, _ in array for k in (i, j)], "terms")
    return len(array), (_Term * max(len(array), 1))(*array)


# ---- objects -----------------------------------------------------------------------------------------------------


class _Handle:
    """Owns an object of the library: destroys it after all others that need it, however Python's collector orders
    them."""
    users = 0

    def __init__(self, pointer, destroy, needs=(), keep=()):
        self._as_parameter_ = c_void_p(pointer)
        self.destroy, self.needs = destroy, []
        self.keep, self.frames, self.terms = list(keep), None, {}  # callbacks and hosts; a solve's; rows' numbers of terms
        self.under_way = False  # of a form: a call that moves the mesh, and may call back
        self.drag = lambda: None  # of a form: a weak reference to the handle of its last drag
        self.users = 1
        for other in needs:
            self.need(other)

    @property
    def address(self):
        return self._as_parameter_.value

    def need(self, other):
        other.users += 1
        self.needs.append(other)

    def drop(self):
        self.users -= 1
        if self.users == 0:
            if self.destroy:
                self.destroy(self._as_parameter_)
            for other in self.needs:
                other.drop()

    def __del__(self):
        if self.users:
            self.drop()

    @contextlib.contextmanager
    def calling(self):
        """Marks a call whose callbacks must not end a drag, which would free what the call uses."""
        outer, self.under_way = self.under_way, True
        drag = self.drag()  # a drag that nobody has any more is cancelled after the call
        try:
            yield drag
        finally:
            self.under_way = outer


class _Object:
    """What all objects have in common: they can be closed, and not be copied."""
    _handle, _destroy = None, None

    def __reduce__(self):  # copy, deepcopy and pickle ask for it
        raise TypeError("an object of the library is not copied or pickled: use mesh.copy(), form.save_state()")

    @property
    def _c(self):
        if self._handle is None:
            raise Error(f"this {type(self).__name__} is closed", Code.ERROR_STATE)
        return self._handle

    @classmethod
    def _as(cls, thing):
        """The handle of an argument, which must be an object of this class."""
        if not isinstance(thing, cls):
            raise TypeError(f"a {cls.__name__} is wanted, not {type(thing).__name__}")
        return thing._c

    @classmethod
    def _of(cls, handle):
        """An object of this class with this handle, which others may have as well."""
        made = cls.__new__(cls)
        made._handle = handle
        return made

    @classmethod
    def _own(cls, pointer, error=None, needs=(), keep=()):
        """The handle for a pointer that the library has just returned."""
        handle = _Handle(pointer, getattr(_lib(), cls._destroy), needs, keep) if pointer else None
        try:
            _raise_waiting()
        except BaseException:
            if handle:
                handle.drop()  # a drag locks its form; the traceback would keep it
            raise
        if not handle:
            raise _failure(error) if error else Error(code_string(Code.ERROR_MEMORY), Code.ERROR_MEMORY)
        return handle

    @classmethod
    def _make(cls, function, *arguments, host=None, into=None):
        """Calls a function that ends with `host, error` and returns a new object."""
        error, host = _Error(), host or _default_host()
        pointer = getattr(_lib(), function)(*arguments, byref(host._c), byref(error))
        handle = cls._own(pointer, error, keep=[host])
        if into is None:
            return cls._of(handle)
        into._handle = handle
        return into

    def _get(self, function, *arguments):
        """Calls a function that ends with `error` and returns a code."""
        error = _Error()
        if getattr(_lib(), function)(self._c, *arguments, byref(error)) != Code.OK:
            raise _failure(error)

    def close(self):
        """Gives the object up: using it again raises Error. Its memory goes with the last array that views it."""
        self._handle = None

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def _view(self, address, count, dtype, writeable=False):
        """An array of the library's memory, which keeps the object's handle, and so the memory."""
        if not count or not address:
            return np.empty(0, dtype)
        memory = (ctypes.c_char * (count * np.dtype(dtype).itemsize)).from_address(address)
        memory.handle = self._c
        array = np.frombuffer(memory, dtype)
        array.flags.writeable = writeable
        return array


class _Sticky(_Object):
    """An object that keeps its first error, which the function `_error` of the library gives."""
    _error = None

    def _check(self, number):
        """Raises the object's error if it has one: refusals return -1 or a code."""
        error = _Error.from_address(getattr(_lib(), self._error)(self._c))
        if error.code.value != Code.OK:
            raise _failure(error)
        return number

    def _verdict(self, result):
        """The result of a solve, unless an error ended it."""
        result = _read(result)  # a record stays
        if result.outcome == Outcome.FAILED:
            self._check(None)
            raise Error(result.message, Code.ERROR_STATE)
        return result


class Host:
    """Services for the library, see >>api-host: `limit`, bytes for each object (0: none); `now`, a clock in seconds;
    allocate(size), reallocate(address, old_size, new_size) and release(address, size), which take and return addresses
    (None: no memory). By default malloc, one thread, and a monotonic clock."""

    def __init__(self, limit=0, now=None, allocate=None, reallocate=None, release=None):
        self._c = _lib().gproj_default_host()
        self._c.allocator.limit = limit
        self._callbacks = []

        def give(struct, field, kind, function, otherwise=None, always=False):
            if function:
                callback = kind(_guarded(lambda user, *arguments: function(*arguments), otherwise, always))
                self._callbacks.append(callback)
                setattr(struct, field, ctypes.cast(callback, c_void_p))

        give(self._c.clock, "now", _NOW, now, 0.0)
        give(self._c.allocator, "allocate", _ALLOCATE, allocate)
        give(self._c.allocator, "reallocate", _REALLOCATE, reallocate)
        give(self._c.allocator, "release", _RELEASE, release, always=True)


@functools.lru_cache(maxsize=None)
def _default_host():
    return Host()


# ---- meshes ------------------------------------------------------------------------------------------------------


class Mesh(_Object):
    """A half-edge mesh, see >>api-mesh: Mesh(V, F) from n x 3 numbers and lists of corners, or an m x k array."""
    _destroy = "gproj_mesh_destroy"

    def __init__(self, V, F, host=None):
        V = _doubles(V, (None, 3), "V")
        if isinstance(F, np.ndarray) and F.ndim == 1 and F.size:
            raise ValueError("F: lists of corners, or an m x k array, are wanted, not one row of numbers")
        if isinstance(F, np.ndarray) and F.ndim == 2:
            degree = np.full(len(F), F.shape[1], np.int32)
            corner = _integers(F, "F")
        else:
            F = [list(face) for face in F]
            degree = np.array([len(face) for face in F], np.int32)
            corner = _integers(list(itertools.chain.from_iterable(F)), "F")
        Mesh._make("gproj_mesh_create", len(V), V.ctypes, len(degree), degree.ctypes, corner.ctypes, host=host,
                   into=self)

    @classmethod
    def load(cls, path, host=None):
        """Reads an OBJ or OFF file (gproj_mesh_load)."""
        return cls._make("gproj_mesh_load", _path(path), host=host)

    @classmethod
    def read(cls, text, format=Format.DETECT, host=None):
        """Reads OBJ or OFF from a str or bytes (gproj_mesh_read)."""
        text = text.encode() if isinstance(text, str) else bytes(memoryview(text))
        return cls._make("gproj_mesh_read", ctypes.c_char_p(text), len(text), format, host=host)

    def save(self, path):
        """Writes an OBJ or OFF file, whole or not at all (gproj_mesh_save)."""
        self._get("gproj_mesh_save", _path(path))

    def write(self, format=Format.OBJ):
        """The text of an OBJ or OFF file (gproj_mesh_write)."""
        pieces = []
        write = _WRITE(_guarded(lambda user, text, size: pieces.append(ctypes.string_at(text, size)) is None, False))
        self._get("gproj_mesh_write", format, ctypes.cast(write, c_void_p), None)
        return b"".join(pieces).decode()

    def __repr__(self):
        return "<Mesh, closed>" if self._handle is None else \
            f"<Mesh of {self.vertex_count} vertices, {self.edge_count} edges, {self.face_count} faces>"

    def copy(self, host=None):
        """A mesh like this one."""
        return Mesh._make("gproj_mesh_copy", self._c, host=host)

    @property
    def memory(self):
        """The bytes held, and allocations: a record of gproj_memory."""
        return _read(_lib().gproj_mesh_memory(self._c))

    # -- arrays --

    @property
    def V(self):
        """The positions, n x 3: a view, to read and to write; `mesh.V = array` copies into it."""
        m = self._struct
        return self._view(m.position, 3 * m.vertex_count, np.float64, True).reshape(-1, 3)

    @V.setter
    def V(self, positions):
        self.V[:] = _doubles(positions, self.V.shape, "V")

    @property
    def F(self):
        """The corners of the faces: an m x k array if all have k, else a list of lists."""
        m = self._struct
        degree, next_one, origin, at = self.face_degree, self.next, self.origin, self.face_halfedge
        start = np.concatenate([[0], np.cumsum(degree, dtype=np.int64)])
        corner, faces = np.empty(start[-1], np.int32), np.arange(m.face_count)
        for k in range(degree.max() if len(degree) else 0):
            corner[start[faces] + k] = origin[at]
            left = degree[faces] > k + 1
            faces, at = faces[left], next_one[at[left]]
        if len(degree) and (degree == degree[0]).all():
            return corner.reshape(-1, degree[0])
        return [list_of.tolist() for list_of in np.split(corner, start[1:-1])] if len(degree) else []

    @property
    def edges(self):
        """The two vertices of each edge, the origins of half-edges 2e and 2e + 1."""
        return self.origin.reshape(-1, 2)

    @property
    def polylines(self):
        """The vertices of each polyline."""
        start = self.polyline_start
        return [self.polyline_vertex[start[k]:start[k + 1]] for k in range(self.polyline_count)]

    @property
    def _struct(self):
        return _Mesh.from_address(self._c.address)

    # The counts and arrays of gproj_mesh under their names there: see __getattr__.
    _COUNTS = [name for name, kind in _Mesh._fields_ if kind is c_int32]
    _ARRAYS = {"vertex_halfedge": "vertex_count", "face_halfedge": "face_count", "face_degree": "face_count",
               "loop_halfedge": "loop_count", "twin": "halfedge_count", "next": "halfedge_count",
               "prev": "halfedge_count", "origin": "halfedge_count", "face": "halfedge_count",
               "edge": "halfedge_count"}

    def __getattr__(self, name):
        if name in self._COUNTS:
            return getattr(self._struct, name)
        m = self._struct if name in self._ARRAYS or name.startswith("polyline_") else None
        if name in self._ARRAYS:
            return self._view(getattr(m, name), getattr(m, self._ARRAYS[name]), np.int32)
        if name == "polyline_start":
            return self._view(m.polyline_start, m.polyline_count + 1, np.int32)
        if name == "polyline_vertex":
            return self._view(m.polyline_vertex, int(self.polyline_start[-1]) if m.polyline_count else 0, np.int32)
        raise AttributeError(f"a mesh has no '{name}'")

    def __dir__(self):
        return [*super().__dir__(), *self._COUNTS, *self._ARRAYS, "polyline_start", "polyline_vertex"]

    # -- questions --

    def valence(self, vertex):
        """The number of edges at a vertex."""
        return _lib().gproj_mesh_valence(self._c, vertex)

    def is_boundary_vertex(self, vertex):
        """Is the vertex at the boundary?"""
        return _lib().gproj_mesh_is_boundary_vertex(self._c, vertex)

    def one_ring(self, vertex):
        """The neighbours of a vertex, counter-clockwise (gproj_mesh_one_ring)."""
        ring = np.empty(self.valence(vertex), np.int32)
        _lib().gproj_mesh_one_ring(self._c, vertex, ring.ctypes, len(ring))
        return ring

    def face_area_vector(self, face):
        """The vectorial area 1/2 sum v_i x v_(i+1)."""
        area = np.empty(3)
        _lib().gproj_mesh_face_area_vector(self._c, face, area.ctypes)
        return area

    def mean_edge_length(self):
        """The mean over all edges; 0 without edges."""
        return _lib().gproj_mesh_mean_edge_length(self._c)

    def measure(self, original=None):
        """Sizes, planarity, deviation from the positions `original`, damage: see gproj_measures."""
        if original is not None:
            original = _doubles(original, (self.vertex_count, 3), "original")
        return _read(_lib().gproj_measure(self._c, None if original is None else original.ctypes, None))

    def measure_spoiled(self, original):
        """Counts what is spoiled, compared with the positions `original`: see gproj_spoiled."""
        original = _doubles(original, (self.vertex_count, 3), "original")
        return _read(_lib().gproj_measure_spoiled(self._c, original.ctypes))

    def planarity(self):
        """How far each face is from planar, in mean edge lengths (gproj_measure_planarity)."""
        planarity = np.zeros(self.face_count)
        _lib().gproj_measure_planarity(self._c, planarity.ctypes, None)
        return planarity

    def volume(self):
        """The volume that is enclosed, or over the plane z = 0 (gproj_volume)."""
        return _lib().gproj_volume(self._c)

    def measure_offset(self, offset):
        """How parallel an offset is, and at which distances: see gproj_offset_measures."""
        return _read(_lib().gproj_measure_offset(self._c, Mesh._as(offset)))

    # -- other meshes from this one --

    def dual(self, host=None):
        """The dual mesh and, for each vertex, its face there or -1 (gproj_mesh_dual)."""
        face = np.empty(self.vertex_count, np.int32)
        return Mesh._make("gproj_mesh_dual", self._c, face.ctypes, host=host), face

    def diagonals(self, host=None):
        """The mesh along the diagonals: a vertex amid each edge, a face for each face and vertex (gproj_mesh_diagonals)."""
        return Mesh._make("gproj_mesh_diagonals", self._c, host=host)

    def subdivide(self, levels=1, scheme=Scheme.CATMULL_CLARK, creases=None, sharpness=None, corners=None,
                  round_corners=False, stencil_level=0, host=None):
        """The finer mesh and the Stencil that leads to it, fine = stencil.apply(coarse), see >>api-subdivide. `creases`:
        sharp edges (None: none), `sharpness`: one number for each (None: always sharp), `corners`: vertices that stay
        (None: none)."""
        creases = _integers([] if creases is None else creases, "creases")
        corners = _integers([] if corners is None else corners, "corners")
        if sharpness is not None and not len(creases):
            raise ValueError("sharpness: there are no creases that it belongs to")
        sharpness = _beside(sharpness, len(creases), "sharpness")
        options = _SubdivideOptions(scheme=scheme, levels=levels, stencil_level=stencil_level, crease_count=len(creases),
                                    creases=_address(creases), sharpness=_address(sharpness),
                                    corner_count=len(corners), corners=_address(corners), round_corners=round_corners)
        pointer = c_void_p()
        mesh = Mesh._make("gproj_mesh_subdivide", self._c, byref(options), byref(pointer), host=host)
        return mesh, Stencil._of(Stencil._own(pointer.value, keep=[host]))

    def vertex_offset(self, distance, host=None):
        """The parallel mesh with its vertices at a distance: circular meshes (gproj_mesh_vertex_offset)."""
        return Mesh._make("gproj_mesh_vertex_offset", self._c, distance, host=host)

    def face_offset(self, distance, host=None):
        """The parallel mesh with its faces at a distance: conical meshes (gproj_mesh_face_offset)."""
        return Mesh._make("gproj_mesh_face_offset", self._c, distance, host=host)

    def support(self, offset, host=None):
        """The quads between this mesh and an offset, with four vertices each (gproj_mesh_support)."""
        return Mesh._make("gproj_mesh_support", self._c, Mesh._as(offset), host=host)


def fill(points, corners=None, subdivisions=None, edge_length=0, keep_points=False, rings=0, variant=0, host=None):
    """Fills a closed curve, n x 3 points, with quads: the mesh, and a record of gproj_fill_info, see >>api-fill. `corners`:
    points (None: it finds them), `subdivisions`: edges of each side (None: by edge_length)."""
    points = _doubles(points, (None, 3), "points")
    corners = _integers([] if corners is None else corners, "corners")
    sides = _integers([] if subdivisions is None else subdivisions, "subdivisions")
    options = _FillOptions(corner_count=len(corners), corners=_address(corners), side_count=len(sides),
                           subdivisions=_address(sides), edge_length=edge_length, keep_points=keep_points, rings=rings,
                           variant=variant)
    info = _FillInfo()
    mesh = Mesh._make("gproj_mesh_fill", len(points), points.ctypes, byref(options), byref(info), host=host)
    return mesh, _read(info)


class Edit(_Object):
    """A copy of a mesh whose combinatorics change, see >>api-edit. Arrays are copies, under the names of gproj_edit."""
    _destroy = "gproj_edit_destroy"

    def __init__(self, mesh, host=None):
        Edit._make("gproj_edit_create", Mesh._as(mesh), host=host, into=self)

    def mesh(self, host=None):
        """A mesh of the present state; then vertex_number, edge_number and face_number are the maps to it."""
        mesh = Mesh._make("gproj_edit_mesh", self._c, host=host)
        self._numbered = {part: getattr(self, part + "_count") for part in ("vertex", "edge", "face")}
        return mesh

    @property
    def memory(self):
        """The bytes held, and allocations: a record of gproj_memory."""
        return _read(_lib().gproj_edit_memory(self._c))

    def __getattr__(self, name):
        if name not in self._KINDS:
            raise AttributeError(f"an edit has no '{name}'")
        edit, part = _Edit.from_address(self._c.address), name.split("_")[0]
        if self._KINDS[name] is c_int32:
            return getattr(edit, name)
        if name == "position":
            return self._view(edit.position, 3 * edit.vertex_count, np.float64).reshape(-1, 3).copy()
        if name in ("next", "prev", "origin", "face"):
            count = 2 * edit.edge_count
        elif name.endswith("_number"):
            count = self._numbered.get(part, 0)
        else:
            count = edit.vertex_count if part == "vertex" else edit.face_count
        return self._view(getattr(edit, name), count, np.int32).copy()

    _KINDS, _numbered = dict(_Edit._fields_), {}

    def set_position(self, vertex, position):
        """Moves a vertex."""
        edit = _Edit.from_address(self._c.address)
        if not 0 <= vertex < edit.vertex_count:
            raise Error(f"there is no vertex {vertex}", Code.ERROR_INDEX, Place.VERTEX, vertex)
        self._view(edit.position, 3 * edit.vertex_count, np.float64, True)[3 * vertex:3 * vertex + 3] = position

    def vertex(self, vertex):
        """The vertex that this number stands for: itself, or the one it was merged into; -1 out of range."""
        return _lib().gproj_edit_vertex(self._c, vertex)

    def edge(self, vertex, other):
        """The edge between two vertices; -1: none."""
        return _lib().gproj_edit_edge(self._c, vertex, other)

    def _change(self, name, *arguments):
        error = _Error()
        number = getattr(_lib(), "gproj_edit_" + name)(self._c, *arguments, byref(error))
        if number < 0:
            raise _failure(error)
        return number

    def split_edge(self, edge, t=0.5):
        """Splits an edge; returns the new vertex (gproj_edit_split_edge)."""
        return self._change("split_edge", edge, t)

    def split_face(self, face, vertex, other):
        """Cuts a face by a diagonal; returns the new edge (gproj_edit_split_face)."""
        return self._change("split_face", face, vertex, other)

    def collapse_edge(self, edge, t=0.5):
        """Merges an edge's ends; returns the vertex (gproj_edit_collapse_edge)."""
        return self._change("collapse_edge", edge, t)

    def triangulate(self, face=-1):
        """Cuts a face, or all, into triangles; returns the number of new faces (gproj_edit_triangulate)."""
        return self._change("triangulate", face)

    def insert_strip(self, edge, t=0.5):
        """Inserts a strip of quads beside that of an edge; returns a rung (gproj_edit_insert_strip)."""
        return self._change("insert_strip", edge, t)

    def remove_strip(self, edge, t=0.5):
        """Removes the strip of an edge; returns the number of rungs (gproj_edit_remove_strip)."""
        return self._change("remove_strip", edge, t)


class Stencil(_Object):
    """A sparse matrix by rows, fine = stencil * coarse, from mesh.subdivide: see gproj_stencil."""
    _destroy = "gproj_stencil_destroy"

    @property
    def _struct(self):
        return _Stencil.from_address(self._c.address)

    @property
    def shape(self):
        """Fine and coarse vertices: rows and columns."""
        return self._struct.row_count, self._struct.column_count

    @property
    def start(self):
        """Row i has the entries start[i] to start[i + 1] - 1."""
        return self._view(self._struct.start, self._struct.row_count + 1, np.int64)

    @property
    def column(self):
        """The coarse vertex of each entry."""
        return self._view(self._struct.column, int(self.start[-1]), np.int32)

    @property
    def weight(self):
        """The weight of each entry."""
        return self._view(self._struct.weight, int(self.start[-1]), np.float64)

    @property
    def memory(self):
        """The bytes held, and allocations: a record of gproj_memory."""
        return _read(_lib().gproj_stencil_memory(self._c))

    def apply(self, coarse):
        """stencil * coarse, for n x k numbers (gproj_stencil_apply)."""
        rows, columns = self.shape
        coarse = _doubles(coarse, (columns, None), "coarse")
        fine = np.empty((rows, coarse.shape[1]))
        _lib().gproj_stencil_apply(self._c, coarse.shape[1], coarse.ctypes, fine.ctypes)
        return fine

    def multiply(self, coarse, host=None):
        """The stencil that leads through both, self * coarse (gproj_stencil_multiply)."""
        return Stencil._make("gproj_stencil_multiply", self._c, Stencil._as(coarse), host=host)

    def transpose(self, host=None):
        """Row j has the fine vertices that coarse vertex j moves (gproj_stencil_transpose)."""
        return Stencil._make("gproj_stencil_transpose", self._c, host=host)


class Curve(_Object):
    """A polyline to glide on, see >>api-reference: Curve(points, closed), or along a mesh."""
    _destroy = "gproj_curve_destroy"

    def __init__(self, points, closed=False, host=None):
        points = _doubles(points, (None, 3), "points")
        Curve._make("gproj_curve_create", len(points), points.ctypes, closed, host=host, into=self)

    @classmethod
    def from_loop(cls, mesh, loop=0, host=None):
        """A boundary loop of a mesh."""
        return cls._make("gproj_curve_from_loop", Mesh._as(mesh), loop, host=host)

    @classmethod
    def from_polyline(cls, mesh, polyline=0, host=None):
        """A polyline of a mesh."""
        return cls._make("gproj_curve_from_polyline", Mesh._as(mesh), polyline, host=host)

    def closest(self, point):
        """The closest point: a record of gproj_curve_hit."""
        return _read(_lib().gproj_curve_closest(self._c, _doubles(point, (3,), "point").ctypes))


class Surface(_Object):
    """A mesh as a surface to stay close to, see >>api-reference."""
    _destroy = "gproj_surface_destroy"

    def __init__(self, mesh, host=None):
        Surface._make("gproj_surface_create", Mesh._as(mesh), host=host, into=self)

    def closest(self, point):
        """The closest point: a record of gproj_surface_hit."""
        return _read(_lib().gproj_surface_closest(self._c, _doubles(point, (3,), "point").ctypes))


# ---- schedules, options, systems ---------------------------------------------------------------------------------


def keep(weight):
    """The same weight in all iterations (gproj_keep). Its `decay` may be set afterwards."""
    return _lib().gproj_keep(weight)


def fade(weight, last):
    """The weight until iteration `last`, then none (gproj_fade)."""
    return _lib().gproj_fade(weight, last)


def guide(weight):
    """The weight while wishes guide, then none (gproj_guide)."""
    return _lib().gproj_guide(weight)


def schedule(weight, decay=1.0, last=2**31 - 1):
    """weight * decay^n for iterations n = 1 .. last, then 0 (gproj_schedule)."""
    return _Schedule(weight, decay, last)


def _limit(iterations, options):
    """The iterations that a solve with these options is allowed, if none are given."""
    if iterations is not None:
        return iterations
    return 60 if options.get("nearest") else 300 if options.get("smooth") else 20


def _solve_options(callback, options):
    """The options, and the callback that they hold: always one, because Python notices Control-C there."""

    def call(user, system, iteration):
        answer = None if callback is None else callback(_read(iteration.contents))
        return answer is None or bool(answer)

    on_iteration = _ON_ITERATION(_guarded(call, False))
    known = {name for name, _ in _SolveOptions._fields_} - {"on_iteration", "user"}
    for name in options:
        if name not in known:
            raise TypeError(f"there is no option '{name}': there are {', '.join(sorted(known))}")
    return _SolveOptions(on_iteration=ctypes.cast(on_iteration, c_void_p), **options), on_iteration


class System(_Sticky):
    """Quadratic equations and guided projection without meshes, see >>api-system; form.system is that of a form."""
    _destroy, _error = "gproj_system_destroy", "gproj_system_error"

    def __init__(self, host=None):
        host = host or _default_host()
        self._handle = System._own(_lib().gproj_system_create(byref(host._c)), keep=[host])
        self._root = self._handle

    @classmethod
    def _borrow(cls, pointer, root):
        """The system of a form, whose handle is `root`, or of a callback."""
        system = cls._of(_Handle(pointer, None, [root]))
        system._root = root
        return system

    @property
    def memory(self):
        """The bytes held, and allocations: a record of gproj_memory."""
        return _read(_lib().gproj_system_memory(self._c))

    def add_variables(self, values, block=1):
        """Appends variables with these start values; returns the first one's number."""
        values = np.ascontiguousarray(values, np.float64).ravel()
        return self._check(_lib().gproj_system_add_variables(self._c, len(values), block, values.ctypes))

    @property
    def values(self):
        """All variables: a copy; `system.values = array` sets them."""
        return self._values().copy()

    @values.setter
    def values(self, values):
        self._values()[:] = values

    def _values(self):
        count = _lib().gproj_system_variable_count(self._c)
        return self._view(_lib().gproj_system_values(self._c), count, np.float64, True)

    def add_group(self, name, kind=Kind.CONSTRAINT, schedule=None, place=Place.NONE, is_global=False, refresh=None):
        """Adds an empty group of rows, see gproj_group. refresh(system, group, progress) may replace rows by set_row
        before each iteration."""
        callback, root = None, weakref.ref(self._root)
        if refresh:
            callback = _REFRESH(_guarded(lambda user, system, group, progress: refresh(
                System._borrow(system, root()), group, _read(progress.contents)), None))
        group = _Group(name=name.encode(), kind=kind, place=place, schedule=schedule or keep(1.0),
                       refresh=ctypes.cast(callback, c_void_p) if refresh else None, **{"global": is_global})
        number = self._check(_lib().gproj_system_add_group(self._c, byref(group)))
        self._root.keep.append(callback)
        return number

    @property
    def group_count(self):
        """The number of groups."""
        return _lib().gproj_system_group_count(self._c)

    def group_info(self, group):
        """Residuals of a group at the last evaluation: a record of gproj_group_info."""
        return _read(_lib().gproj_system_group_info(self._c, group))

    def set_schedule(self, group, schedule):
        """Sets a group's weights: keep(w), fade(w, last), guide(w), or schedule(w, decay, last)."""
        self._check(_lib().gproj_system_set_schedule(self._c, group, schedule))

    def add_row(self, group, terms, constant=0.0, element=-1):
        """Adds a row to a group of add_group (those of a form take none): terms (i, j, a) for a x_i x_j, or a x_i where
        j is -1. Returns its number in the group."""
        count, terms = _terms(terms)
        row = self._check(_lib().gproj_system_add_row(self._c, group, count, terms, constant, element))
        self._root.terms[group, row] = count
        return row

    def set_row(self, group, row, coefficients, constant):
        """Replaces the constant of a row, and the coefficients in the order of its terms (None: as they are; only of
        rows that were added here, because the library does not ask how many there are)."""
        if coefficients is not None:
            if (group, row) not in self._root.terms:
                raise ValueError(f"coefficients: row {row} of group {group} was not added by add_row of a system")
            coefficients = _doubles(coefficients, (self._root.terms[group, row],), "coefficients").ctypes
        self._check(_lib().gproj_system_set_row(self._c, group, row, coefficients, constant))

    def set_row_weight(self, group, row, weight):
        """Sets the weight of one row, times the group's."""
        self._check(_lib().gproj_system_set_row_weight(self._c, group, row, weight))

    def row_value(self, group, row):
        """phi of a row and its gradient."""
        gradient = np.zeros(_lib().gproj_system_variable_count(self._c))
        return _lib().gproj_system_row_value(self._c, group, row, gradient.ctypes), gradient

    def check_gradients(self):
        """The largest relative difference between gradients and central differences: about 1e-9."""
        return _lib().gproj_system_check_gradients(self._c)

    def solve(self, iterations=20, callback=None, **options):
        """Takes at most `iterations` steps (gproj_system_solve); options and callback as in form.solve."""
        options, callback = _solve_options(callback, options)
        with _interruptible():
            result = _lib().gproj_system_solve(self._c, iterations, byref(options))
        return self._verdict(result)


def least_squares(A, b, lower=None, upper=None, damping=0.0, start=None, host=None):
    """Minimises 1/2 |A x - b|^2 + 1/2 damping^2 |x|^2 within bounds, see >>api-least-squares. A: an m x n array, or a
    matrix by columns as scipy's csc_matrix, to which scipy's others are converted. Returns x and a record of
    gproj_least_squares_result."""
    if hasattr(A, "tocsc"):
        A = A.tocsc()
    if all(hasattr(A, name) for name in ("indptr", "indices", "data")):
        rows, columns = A.shape
        begin, row, value = _integers(A.indptr, "A", np.int64), _integers(A.indices, "A"), A.data
        if getattr(A, "format", "csc") != "csc" or len(begin) != columns + 1 or not begin[-1] == len(row) == len(value):
            raise ValueError("A: compressed columns are wanted (scipy's csc_matrix)")
    else:
        A = _doubles(A, (None, None), "A")
        rows, columns = A.shape
        column, row = np.nonzero(A.T)
        begin = np.concatenate([[0], np.cumsum(np.bincount(column, minlength=columns))]).astype(np.int64)
        row, value = row.astype(np.int32), A[row, column]
    value, b = np.ascontiguousarray(value, np.float64), _doubles(b, (rows,), "b")
    lower, upper = _beside(lower, columns, "lower"), _beside(upper, columns, "upper")
    x = np.zeros(columns) if start is None else _doubles(start, (columns,), "start").copy()
    problem = _LeastSquares(rows=rows, columns=columns, start=_address(begin), row=_address(row),
                            value=_address(value), b=_address(b), lower=_address(lower), upper=_address(upper),
                            damping=damping)
    result, error, host = _LeastSquaresResult(), _Error(), host or _default_host()
    if _lib().gproj_solve_least_squares(byref(problem), byref(host._c), x.ctypes, byref(result), byref(error)) != Code.OK:
        raise _failure(error)
    return x, _read(result)


# ---- forms -------------------------------------------------------------------------------------------------------


class Form(_Sticky):
    """A mesh, what must hold and what is wished, see >>api-form: Form(V, F), or Form(mesh).

    Every add_... returns the number of its group. Weights: 1 for what must hold, 0.01 to 0.3 for wishes."""
    _destroy, _error = "gproj_form_destroy", "gproj_form_error"

    def __init__(self, V, F=None, host=None):
        if isinstance(V, Mesh) and F is not None:
            raise TypeError("a form of a mesh has its faces: F is for positions")
        mesh, host = V if isinstance(V, Mesh) else Mesh(V, F, host), host or _default_host()
        self._handle = Form._own(_lib().gproj_form_create(mesh._c, byref(host._c)), needs=[mesh._c], keep=[host])
        self._mesh, self._targets = Mesh._of(mesh._c), {}  # the caller may close `mesh`
        self._check(None)

    def _add(self, name, *arguments):
        number = getattr(_lib(), "gproj_add_" + name)(self._c, *arguments)
        return self._check(number)

    @property
    def mesh(self):
        """The Mesh, which outlives the form; after close() another one of the same memory."""
        if self._c and self._mesh._handle is None:
            self._mesh = Mesh._of(self._c.needs[0])
        return self._mesh

    @property
    def V(self):
        """The positions, n x 3: the mesh's, a view to read and to write; `form.V = array` copies into it."""
        return self.mesh.V

    @V.setter
    def V(self, positions):
        self.mesh.V = positions

    @property
    def memory(self):
        """The bytes held, and allocations: a record of gproj_memory."""
        return _read(_lib().gproj_form_memory(self._c))

    @property
    def system(self):
        """The System underneath: variables 3i, 3i+1, 3i+2 are vertex i in the form's units."""
        return System._borrow(_lib().gproj_form_system(self._c), self._c)

    @property
    def units(self):
        """centre, scale: internal = (position - centre) * scale (gproj_form_units)."""
        centre, scale = np.empty(3), c_double()
        _lib().gproj_form_units(self._c, centre.ctypes, byref(scale))
        return centre, scale.value

    # -- what must hold --

    def add_planarity(self, weight=1.0):
        """Faces are planar: n'n = 1, n'(v_i - v_j) = 0 (gproj_add_planarity)."""
        return self._add("planarity", weight)

    def add_fixed(self, vertices, weight=1.0):
        """Vertices keep their positions: v_i = p_i (gproj_add_fixed)."""
        return self._add("fixed", *_list(vertices, "vertices"), weight)

    def add_fixed_boundary(self, weight=1.0):
        """Boundary vertices keep their positions."""
        return self._add("fixed_boundary", weight)

    def add_fixed_corners(self, weight=1.0):
        """The boundary's corners (is_corner) keep their positions."""
        return self._add("fixed_corners", weight)

    def add_targets(self, vertices, positions, weight=1.0):
        """Handles: vertices go to n x 3 positions (gproj_add_targets); set_targets moves them."""
        positions = _doubles(positions, (None, 3), "positions")
        count, list_of = _list(vertices, "vertices")
        if len(positions) != (self.mesh.vertex_count if vertices is None else count):
            raise ValueError(f"positions: one for each vertex is wanted, not {len(positions)}")
        number = self._add("targets", count, list_of, positions.ctypes, weight)
        self._targets[number] = len(positions)
        return number

    def set_targets(self, group, positions):
        """Moves the targets of a group of add_targets: positions n x 3, as many as there."""
        positions = _doubles(positions, (self._targets.get(group), 3), "positions")
        self._check(_lib().gproj_set_targets(self._c, group, positions.ctypes))

    def add_gliding(self, curve, vertices, weight=1.0):
        """Vertices stay on a Curve (gproj_add_gliding)."""
        number = self._add("gliding", Curve._as(curve), *_list(vertices, "vertices"), weight)
        self._c.need(curve._c)
        return number

    def add_gliding_boundary(self, weight=1.0):
        """Boundary vertices glide along their original loop; corners stay."""
        return self._add("gliding_boundary", weight)

    def add_circularity(self, weight=1.0):
        """Faces have a circumcircle, with add_planarity: (v_j - v_i)'((v_i + v_j)/2 - c) = 0 (gproj_add_circularity)."""
        return self._add("circularity", weight)

    def add_conicality(self, weight=1.0):
        """Faces around a vertex touch a cone, after add_planarity: a'(n_i - n_(i+1)) = 0 (gproj_add_conicality)."""
        return self._add("conicality", weight)

    def add_lengths(self, edges, lengths=None, weight=1.0):
        """Edges have these lengths, or their original ones: |v_i - v_j| = l (gproj_add_lengths)."""
        count, list_of = _list(edges, "edges")
        lengths = _beside(lengths, self.mesh.edge_count if edges is None else count, "lengths")
        return self._add("lengths", count, list_of, None if lengths is None else lengths.ctypes, weight)

    def add_equal_lengths(self, edges=None, weight=1.0):
        """Edges have one common, unknown length (gproj_add_equal_lengths)."""
        return self._add("equal_lengths", *_list(edges, "edges"), weight)

    def add_midsphere(self, edges=None, weight=1.0):
        """The midpoints of edges are on one unknown sphere (gproj_add_midsphere)."""
        return self._add("midsphere", *_list(edges, "edges"), weight)

    def add_coplanar(self, vertices, weight=1.0):
        """Vertices are on one unknown plane: n'(v_i - m) = d, n'n = 1 (gproj_add_coplanar)."""
        return self._add("coplanar", *_list(vertices, "vertices"), weight)

    def add_collinear(self, vertices, weight=1.0):
        """Vertices are on one unknown line (gproj_add_collinear)."""
        return self._add("collinear", *_list(vertices, "vertices"), weight)

    def add_planar_boundary(self, weight=1.0):
        """Each part of the boundary from corner to corner is planar."""
        return self._add("planar_boundary", weight)

    def add_straight_boundary(self, weight=1.0):
        """Each part of the boundary from corner to corner is straight."""
        return self._add("straight_boundary", weight)

    def add_orthogonal_edges(self, normal, edges, weight=1.0):
        """Edges are orthogonal to the planes with this normal (gproj_add_orthogonal_edges)."""
        normal = _doubles(normal, (3,), "normal")
        return self._add("orthogonal_edges", normal.ctypes, *_list(edges, "edges"), weight)

    def add_orthogonal_boundary(self, weight=1.0):
        """Inner edges meet the boundary at right angles: (t - b)'(q - p) / 2 = 0 (gproj_add_orthogonal_boundary)."""
        return self._add("orthogonal_boundary", weight)

    def add_lifting(self, weight=1.0):
        """Vertices move in z only."""
        return self._add("lifting", weight)

    def add_volume(self, volume, weight=1.0):
        """The volume, enclosed or over z = 0 (gproj_add_volume)."""
        return self._add("volume", volume, weight)

    def add_total_area(self, area, weight=1.0):
        """The face areas sum to `area`."""
        return self._add("total_area", area, weight)

    def add_cost(self, length_price, area_price, cost, weight=1.0):
        """length_price * (length of all edges) + area_price * (area of all faces) = cost (gproj_add_cost)."""
        return self._add("cost", length_price, area_price, cost, weight)

    def add_length_bounds(self, edges=None, min=-math.inf, max=math.inf, weight=1.0):
        """Lengths of edges within bounds (gproj_add_length_bounds)."""
        return self._add("length_bounds", *_list(edges, "edges"), min, max, weight)

    def add_area_bounds(self, faces=None, min=-math.inf, max=math.inf, weight=1.0):
        """Areas of faces within bounds (gproj_add_area_bounds)."""
        return self._add("area_bounds", *_list(faces, "faces"), min, max, weight)

    def add_total_area_bounds(self, min=-math.inf, max=math.inf, weight=1.0):
        """The area of all faces within bounds."""
        return self._add("total_area_bounds", min, max, weight)

    def add_cost_bounds(self, length_price, area_price, min=-math.inf, max=math.inf, weight=1.0):
        """The cost of add_cost within bounds."""
        return self._add("cost_bounds", length_price, area_price, min, max, weight)

    # -- what is wished --

    def add_closeness(self, weight):
        """Closeness to the original: v_i = p_i."""
        return self._add("closeness", weight)

    def add_reference(self, surface, weight):
        """Closeness to a Surface: v_i on the tangent plane at the closest point (gproj_add_reference)."""
        number = self._add("reference", Surface._as(surface), weight)
        self._c.need(surface._c)
        return number

    def add_fairness(self, weight):
        """Fair mesh polylines: v = mean of opposite neighbours (gproj_add_fairness)."""
        return self._add("fairness", weight)

    def add_boundary_fairness(self, weight):
        """Fairness along the boundary alone."""
        return self._add("boundary_fairness", weight)

    def add_tangential_fairness(self, weight):
        """Fairness within the tangent planes (gproj_add_tangential_fairness)."""
        return self._add("tangential_fairness", weight)

    def add_gauss_fairness(self, weight):
        """Fairness of the normals (gproj_add_gauss_fairness)."""
        return self._add("gauss_fairness", weight)

    def add_parallelograms(self, weight):
        """Quads are parallelograms: v_1 - v_2 + v_3 - v_4 = 0."""
        return self._add("parallelograms", weight)

    def add_equal_areas(self, weight):
        """Faces have one common, unknown area: |a_k| = A (gproj_add_equal_areas)."""
        return self._add("equal_areas", weight)

    # -- constraints of your own --

    def add_rows(self, name, kind=Kind.CONSTRAINT, place=Place.NONE, weight=1.0):
        """Adds an empty group for rows of your own, in the mesh's units (gproj_add_rows)."""
        return self._add("rows", ctypes.c_char_p(name.encode()), kind, place, weight)

    def add_unknowns(self, group, values, unit=Unit.NUMBER, start=None):
        """Adds unknowns to a group of add_rows; returns the first one's number. start(V, values) may write better start
        values when a solve or a drag begins with the positions V (gproj_start)."""
        values, mesh, callback = np.ascontiguousarray(values, np.float64).ravel(), Mesh._of(self._mesh._c), None

        def begin(user, _, first, count, there):
            there = np.ctypeslib.as_array(there, (count,))
            given = there.copy()  # the memory is the library's, for the time of the call
            start(mesh.V, given)
            there[:] = given

        if start:
            callback = _START(_guarded(begin, None))
            self._c.keep.append(callback)
        return self._check(_lib().gproj_form_add_unknowns(
            self._c, group, unit, len(values), values.ctypes, ctypes.cast(callback, c_void_p) if start else None, None))

    def get_unknowns(self, first, count):
        """Unknowns of your own in the mesh's units."""
        values = np.zeros(max(count, 0))
        self._get("gproj_form_get_unknowns", first, count, values.ctypes)
        return values

    def add_row(self, group, terms, constant=0.0, element=-1):
        """Adds the row sum of terms + constant: terms (i, j, a) for a x_i x_j, or a x_i where j is -1, with 3 v + c for
        coordinate c of vertex v, or numbers of unknowns. Scale it to be a length (gproj_form_add_row)."""
        count, terms = _terms(terms)
        return self._check(_lib().gproj_form_add_row(self._c, group, count, terms, constant, element))

    # -- groups --

    def _elements(self, group):
        """The number of vertices, edges or faces, by the group's place; 0 elsewhere."""
        place, mesh = self.group_info(group).place, self.mesh
        return {Place.VERTEX: mesh.vertex_count, Place.EDGE: mesh.edge_count, Place.FACE: mesh.face_count}.get(place, 0)

    def residuals(self, group):
        """What each element of the group's place lacks after a solve, in mean edge lengths (gproj_form_residuals)."""
        lacks = np.zeros(self._elements(group))
        self._get("gproj_form_residuals", group, lacks.ctypes)
        return lacks

    def set_schedule(self, group, schedule):
        """Sets a group's weights: keep(w), fade(w, last), guide(w), or schedule(w, decay, last)."""
        self._check(_lib().gproj_set_schedule(self._c, group, schedule))

    def set_element_weights(self, group, elements, weights):
        """Sets weights for parts of a group, times the group's (gproj_set_element_weights)."""
        count, list_of = _list(elements, "elements")
        weights = _beside(np.asarray(weights, np.float64), self._elements(group) if elements is None else count, "weights")
        self._check(_lib().gproj_set_element_weights(self._c, group, count, list_of, weights.ctypes))

    def group_info(self, group):
        """Residuals of a group at the last evaluation: a record of gproj_group_info."""
        return _read(_lib().gproj_form_group_info(self._c, group))

    def is_corner(self, vertex):
        """Is this boundary vertex a corner (gproj_form_is_corner)?"""
        return _lib().gproj_form_is_corner(self._c, vertex)

    # -- solving --

    def solve(self, iterations=None, callback=None, **options):
        """Solves (gproj_solve) and returns a record of gproj_result; the positions are then in form.V.

        iterations: by default 60 if nearest, 300 if smooth, else 20. callback(iteration) gets a record of gproj_iteration
        after each, and returns False to cancel. Options, as in gproj_solve_options: smooth, nearest, tolerance, epsilon,
        time_budget, skip_damping, skip_closeness, skip_guard. Raises Error only where the outcome is FAILED."""
        iterations = _limit(iterations, options)
        options, callback = _solve_options(callback, options)
        with self._c.calling(), _interruptible():
            result = _lib().gproj_solve(self._c, iterations, byref(options))
        return self._verdict(result)

    def solve_begin(self, iterations=None, callback=None, **options):
        """Begins a solve in frames (gproj_solve_begin): while form.solve_is_on: form.solve_advance(0.01). Arguments as in
        solve."""
        iterations = _limit(iterations, options)
        options, callback = _solve_options(callback, options)
        before, self._c.frames = self._c.frames, [self._c.frames, callback]
        error = _Error()
        if not _lib().gproj_solve_begin(self._c, iterations, byref(options), byref(error)):
            self._c.frames = before
            raise _failure(error)
        self._c.frames = callback

    @property
    def solve_is_on(self):
        """Is there more to do in a solve in frames?"""
        return _lib().gproj_solve_is_on(self._c)

    def solve_advance(self, seconds=0.0):
        """Takes the iterations that fit into `seconds`; 0: one, inf: all (gproj_solve_advance)."""
        with self._c.calling(), _interruptible():
            result = _lib().gproj_solve_advance(self._c, seconds)
        return self._verdict(result)

    def solve_memory(self):
        """The bytes that the solve that was begun will hold at most, before it takes them (gproj_solve_memory)."""
        error = _Error()
        told = _lib().gproj_solve_memory(self._c, byref(error))
        if not told:
            raise _failure(error)
        return told

    def solve_stop(self):
        """Ends a solve in frames at the present positions."""
        _lib().gproj_solve_stop(self._c)

    # -- forces --

    def add_equilibrium(self, weight=1.0, density=0.0, edge_density=None, area_load=0.0, snow=0.0, point_load=None,
                        supports=None, slides=None):
        """Forces w in the edges balance the loads f: sum_j w_ij (v_i - v_j) + f_i = 0, see >>api-statics.

        Loads as in gproj_loads; `supports`: vertices (None, or none: those of the boundary), `slides`: for each that is
        given the free axes, sums of 1 (x), 2 (y), 4 (z)."""
        mesh = self.mesh
        edge_density = _beside(edge_density, mesh.edge_count, "edge_density")
        if point_load is not None:
            point_load = _doubles(point_load, (mesh.vertex_count, 3), "point_load")
        supports = _integers([] if supports is None else supports, "supports")
        if slides is not None:
            if not len(supports):
                raise ValueError("slides: there are no supports that they belong to")
            slides = np.ascontiguousarray(np.broadcast_to(_integers(slides, "slides", np.uint8), (len(supports),)))
        if not len(supports):
            supports = np.unique(mesh.origin[mesh.face < 0])
        loads = _Loads(density=density, edge_density=_address(edge_density), area_load=area_load, snow=snow,
                       point_load=_address(point_load))
        held = _Supports(count=len(supports), vertex=_address(supports), slides=_address(slides))
        return self._add("equilibrium", byref(loads), byref(held), weight)

    def add_compression(self, edges=None, weight=1.0):
        """Only compression, w >= 0, after add_equilibrium."""
        return self._add("compression", *_list(edges, "edges"), weight)

    def add_tension(self, edges=None, weight=1.0):
        """Only tension, w <= 0, after add_equilibrium."""
        return self._add("tension", *_list(edges, "edges"), weight)

    def add_stress_bounds(self, edges=None, min=-math.inf, max=math.inf, sections=None, weight=1.0):
        """min <= w l / A <= max, with A = sections, or 1 (gproj_add_stress_bounds)."""
        count, list_of = _list(edges, "edges")
        sections = _beside(sections, self.mesh.edge_count if edges is None else count, "sections")
        return self._add("stress_bounds", count, list_of, None if sections is None else sections.ctypes, min, max, weight)

    def add_force_fairness(self, weight):
        """A wish: opposite edges in quads carry equal forces (gproj_add_force_fairness)."""
        return self._add("force_fairness", weight)

    def get_forces(self):
        """The force densities of all edges."""
        densities = np.zeros(self.mesh.edge_count)
        self._get("gproj_get_forces", densities.ctypes)
        return densities

    def set_forces(self, densities):
        """Force densities as the start of the next solve; None: it finds a start."""
        if densities is not None:
            densities = _doubles(densities, (self.mesh.edge_count,), "densities").ctypes
        self._get("gproj_set_forces", densities)

    def force_variable(self, edge):
        """The variable for an edge's force in form.system; -1: none."""
        return _lib().gproj_force_variable(self._c, edge)

    def get_loads(self):
        """The loads on the mesh as it is, n x 3."""
        loads = np.zeros((self.mesh.vertex_count, 3))
        self._get("gproj_get_loads", loads.ctypes)
        return loads

    def get_reactions(self):
        """The supports' reactions, n x 3."""
        reactions = np.zeros((self.mesh.vertex_count, 3))
        self._get("gproj_get_reactions", reactions.ctypes)
        return reactions

    def find_forces(self):
        """The densities that balance the mesh as it is best, and each vertex's residual (gproj_find_forces)."""
        densities, residuals = np.zeros(self.mesh.edge_count), np.zeros(self.mesh.vertex_count)
        self._get("gproj_find_forces", densities.ctypes, residuals.ctypes)
        return densities, residuals

    def find_imbalance(self):
        """Why no allowed forces balance the mesh: n x 3 displacements (gproj_find_imbalance)."""
        displacements = np.zeros((self.mesh.vertex_count, 3))
        self._get("gproj_find_imbalance", displacements.ctypes)
        return displacements

    def measure_forces(self):
        """Measures the forces of the last solve: a record of gproj_forces."""
        error = _Error()
        forces = _lib().gproj_measure_forces(self._c, byref(error))
        if error.code.value != Code.OK:
            raise _failure(error)
        return _read(forces)

    # -- dragging, states --

    def drag(self, vertices, weights=None, start=None, position=None, residual_bound=0.0, keep_wishes=False):
        """Begins a Drag: one handle for each vertex; or with `start`, handle k has vertices[start[k]:start[k + 1]] with
        their weights (gproj_handles). `position`: the handles' places now, k x 3; None: the means of their vertices."""
        return Drag(self, vertices, weights, start, position, residual_bound, keep_wishes)

    def find_reach(self, vertex, reach):
        """The vertices nearer to `vertex` than `reach`, and their weights as one handle (gproj_find_reach)."""
        count = self.mesh.vertex_count
        vertices, weights = np.empty(count, np.int32), np.empty(count)
        found = _lib().gproj_find_reach(self._c, vertex, reach, vertices.ctypes, weights.ctypes)
        if not found:
            self._check(None)
            raise Error(f"there is no vertex {vertex}", Code.ERROR_INDEX, Place.VERTEX, vertex)
        return vertices[:found].copy(), weights[:found].copy()

    def save_state(self):
        """Everything that a solve depends on, as bytes, see >>api-state."""
        state = np.empty(self._check(_lib().gproj_state_size(self._c)), np.uint8)
        self._get("gproj_state_save", state.ctypes, len(state))
        return state.tobytes()

    def restore_state(self, state):
        """Puts a saved state back; other bytes are refused without a change."""
        state = np.frombuffer(state, np.uint8)
        self._get("gproj_state_restore", state.ctypes, len(state))


class Drag(_Object):
    """Handles that are dragged while everything holds, see >>api-drag: made by form.drag.

        with form.drag([17]) as drag:      # released at the end, cancelled by an exception
            drag.move([[x, y, z]])     # a row for each handle; of a single one also [x, y, z]
        print(drag.result.message)
    """
    _destroy = "gproj_drag_cancel"

    def __init__(self, form, vertices, weights, start, position, residual_bound, keep_wishes):
        vertices = _integers(vertices, "vertices")
        count = len(vertices)
        if start is not None:
            start = _integers(start, "start", np.int64)
            count = len(start) - 1
            if count < 0 or start.max() > len(vertices):
                raise ValueError("start: one entry more than handles is wanted, none beyond the number of vertices")
        weights = _beside(weights, len(vertices), "weights")
        position = None if position is None else self._places(position, count, "position")
        handles = _Handles(count=count, start=_address(start), vertex=_address(vertices), weight=_address(weights),
                           position=_address(position))
        options, error = _DragOptions(residual_bound=residual_bound, keep_wishes=keep_wishes), _Error()
        pointer = _lib().gproj_drag_begin(Form._as(form), byref(handles), byref(options), byref(error))
        self._handle = Drag._own(pointer, error, needs=[form._c])
        self._form, self._root, self.count, self.result = form, form._c, count, None
        self._root.drag = weakref.ref(self._handle)

    @property
    def _c(self):
        if self._root.under_way:
            raise Error("a call of this Drag or of its form is under way: its callbacks leave the drag alone",
                        Code.ERROR_STATE)
        return super()._c

    @staticmethod
    def _places(positions, count, what):
        """k x 3 numbers, or 3 of a single handle."""
        return _doubles(positions, (3,) if count == 1 and np.ndim(positions) == 1 else (count, 3), what)

    def move(self, positions):
        """Moves the handles to k x 3 positions, and form.V with them (gproj_drag_move)."""
        positions, handle = self._places(positions, self.count, "positions"), self._c
        with self._root.calling():
            code = _lib().gproj_drag_move(handle, positions.ctypes)
        if code != Code.OK:
            raise _failure(_Error.from_address(_lib().gproj_drag_error(handle)))

    @property
    def residual(self):
        """The largest |phi| of what must hold, on the mesh as it has been dragged."""
        handle = self._c
        with self._root.calling():
            return _lib().gproj_drag_residual(handle)

    @property
    def info(self):
        """The state of the drag: a record of gproj_drag_info."""
        return _read(_lib().gproj_drag_get_info(self._c))

    @property
    def memory(self):
        """The bytes held, and allocations: a record of gproj_memory."""
        return _read(_lib().gproj_drag_memory(self._c))

    def release(self):
        """Begins the release in frames: form.solve_advance goes on, end() gives the verdict (gproj_drag_release)."""
        handle = self._c
        with self._root.calling():
            return _lib().gproj_drag_release(handle)

    def end(self):
        """Releases the handles and returns the verdict (gproj_drag_end). Control-C and exceptions of callbacks stop the
        release after an iteration; `result` has the verdict all the same."""
        handle, form, library = self._c, self._root, _lib()
        with form.calling():
            try:
                library.gproj_drag_release(handle)
                with _interruptible():
                    while library.gproj_solve_is_on(form):
                        library.gproj_solve_advance(form, 0.0)
            finally:
                if library.gproj_solve_is_on(form):
                    library.gproj_solve_stop(form)
                self._handle, handle.destroy = None, None  # the next call destroys it
                self.result = _read(library.gproj_drag_end(handle))
        return self._form._verdict(self.result)

    def cancel(self):
        """Puts the form back to its state before the drag (gproj_drag_cancel)."""
        handle, self._handle = self._c, None
        handle.destroy = None
        _lib().gproj_drag_cancel(handle)
        _raise_waiting()

    def close(self):
        """Gives the drag up: it is cancelled."""
        if self._handle is not None:
            self.cancel()

    def __exit__(self, kind, *exception):
        if self._handle is not None:
            self.cancel() if kind else self.end()


if __name__ == "__main__":
    usage = "usage: python3 guidedproj.py [PATH]\nCompiles the library to PATH, or to the cache folder, and prints its path."
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(usage)
        sys.exit()
    if len(sys.argv) > 2 or sys.argv[1:] and sys.argv[1].startswith("-"):
        sys.exit(usage)
    try:
        print(build(*sys.argv[1:2]))
    except Error as refusal:
        sys.exit(f"guidedproj: {refusal}")
