"""test_python.py ROOT WORK - tests examples/python/guidedproj.py. In WORK, test_python.sh has put `agree`, a C program that
prints what the binding must give to the bit. The last line says how many checks have passed and failed."""
import copy
import ctypes
import gc
import math
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import traceback
import weakref

import numpy as np

root, work = sys.argv[1:3]
sys.path.insert(0, os.path.join(root, "examples", "python"))
import guidedproj
from guidedproj import Code, Error, Form, Kind, Mesh, Outcome, Place, Unit

passed = failed = 0
ROOF = os.path.join(root, "examples", "roof.obj")


def check(holds, *what):
    global passed, failed
    if holds:
        passed += 1
    else:
        failed += 1
        print("FAILED:", *what)


def raises(kind, function, *arguments, code=None, says="", **options):
    """The exception that the call must raise."""
    try:
        function(*arguments, **options)
    except kind as exception:
        check(code is None or exception.code == code, function, "has code", getattr(exception, "code", None))
        check(says in str(exception), function, "says:", exception)
        return exception
    except Exception as exception:
        check(False, function, arguments, "raises", repr(exception))
    else:
        check(False, function, arguments, "raises nothing")
    return None


def grid(rows, columns, height=lambda x, y: 0.0):
    """V, F of rows x columns quads over a square of side `rows`."""
    number = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
    V = np.array([[i, j, height(i / rows - 0.5, j / columns - 0.5)] for i in range(rows + 1) for j in range(columns + 1)])
    F = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return V, F


def dome(n=8):
    return grid(n, n, lambda x, y: n * (0.4 - 0.5 * (x * x + y * y) + 0.1 * x * x * y + 0.05 * x * y))


CUBE = ([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)],
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])


class Counting:
    """A host whose allocator counts: malloc from C, blocks and bytes here."""

    def __init__(self, fail_at=0, **options):
        libc = ctypes.CDLL(None)
        libc.malloc.restype = libc.realloc.restype = ctypes.c_void_p
        libc.malloc.argtypes, libc.free.argtypes = [ctypes.c_size_t], [ctypes.c_void_p]
        libc.realloc.argtypes = [ctypes.c_void_p, ctypes.c_size_t]
        self.blocks, self.calls, self.wrong, sizes = 0, 0, 0, {}

        def count():
            self.calls += 1
            if self.calls == fail_at:
                raise ArithmeticError("no memory here")

        def allocate(size):
            count()
            address = libc.malloc(size)
            self.blocks += 1
            sizes[address] = size
            return address

        def reallocate(address, old, new):
            count()
            self.wrong += sizes.pop(address, None) != old
            address = libc.realloc(address, new)
            sizes[address] = new
            return address

        def release(address, size):
            self.wrong += sizes.pop(address, None) != size
            self.blocks -= 1
            libc.free(address)

        self.host = guidedproj.Host(allocate=allocate, reallocate=reallocate, release=release, **options)


# ---- to the bit as in C ----


def bits(values):
    return " ".join(f"{number:016x}" for number in np.ascontiguousarray(values, np.float64).ravel().view(np.uint64))


def test_agreement_with_c():
    mesh = Mesh.load(ROOF)
    form = Form(mesh)
    form.add_planarity()
    form.add_fixed_corners()
    form.add_length_bounds(max=1.3 * mesh.mean_edge_length())
    form.set_schedule(form.add_fairness(0.2), guidedproj.schedule(0.2, 0.9, 6))
    form.add_closeness(0.01)
    system, lines = form.system, []
    lines.append(f"gradients {bits(system.check_gradients())}")
    check(system.check_gradients() < 1e-7, "gradients differ from differences by", system.check_gradients())
    for group in range(system.group_count):
        info = system.group_info(group)
        lines.append(f"group {info.name} {info.kind.value} {info.place.value} {info.rows}")
        for row in range(0, info.rows, 1 + info.rows // 20):
            value, gradient = system.row_value(group, row)
            lines.append(f"row {row} {bits(value)} {bits(gradient[gradient != 0])}")
    result = form.solve(12, lambda it: lines.append(f"iteration {it.number} {bits([it.residual, it.merit, it.step])}"))
    lines.append(f"{result.outcome.value} {result.iterations} {bits([result.residual, result.tolerance])}")
    lines.append(result.message)
    for group in range(system.group_count):
        info = form.group_info(group)
        lines.append(f"after {bits([info.max, info.rms])} {info.worst_row} {info.worst_element}")
    measures = mesh.measure(Mesh.load(ROOF).V)
    lines.append(f"measures {bits([measures.planarity_max, measures.area_spread, measures.deviation_rms])}")
    lines.append(bits(form.V))
    in_c = subprocess.run([os.path.join(work, "agree"), ROOF], capture_output=True, text=True).stdout.strip().split("\n")
    check(len(in_c) == len(lines), len(in_c), "lines in C,", len(lines), "in Python")
    for here, there in zip(lines, in_c):
        check(here == there, "Python:", here[:200], "C:", there[:200])


def test_planar_roof():
    form = Form(Mesh.load(ROOF))
    form.add_planarity()
    form.add_fixed_corners()
    result = form.solve(smooth=True)
    check(result.outcome is Outcome.CONVERGED and result.spoiled.total == 0, result)
    check(form.mesh.measure().planarity_max < 1e-12 and form.mesh.planarity().max() < 1e-12, form.mesh.measure())
    check(form.residuals(0).max() < 1e-12 and form.residuals(0).shape == (400,), form.residuals(0).max())


# ---- arrays ----


def test_meshes():
    V, F = dome()
    for faces in F, F.astype(np.uint8), F.tolist(), [tuple(face) for face in F], list(F):
        check((Mesh(V, faces).F == F).all(), "faces", type(faces))
    check(Mesh(V.astype(np.float32), F).V.dtype == np.float64, "positions of floats")
    check((Mesh(np.asfortranarray(V), F[:, ::-1][:, ::-1]).V == V).all(), "positions in another order")
    mixed = [[0, 1, 2], [0, 2, 3, 4, 5]]
    mesh = Mesh([[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 3, 0], [0, 2, 0], [-1, 1, 0], [9, 9, 9]], mixed)
    check(mesh.F == mixed and mesh.isolated_count == 1, mesh.F)
    check(Mesh([[0, 0, 0]], []).F == [] and Mesh([[0, 0, 0]], np.empty((0, 4), int)).face_count == 0, "no faces")
    check((mesh.twin == np.arange(mesh.halfedge_count) ^ 1).all() and (mesh.edge == np.arange(14) // 2).all(), "half-edges")
    check(mesh.edges.shape == (7, 2) and mesh.valence(2) == 3 and list(mesh.one_ring(1)) in ([0, 2], [2, 0]), "one-ring")
    check(mesh.is_boundary_vertex(0) and not mesh.is_boundary_vertex(99), "boundary")
    check(np.allclose(mesh.face_area_vector(0), [0, 0, 2]), mesh.face_area_vector(0))
    check(Mesh(*CUBE).volume() == 1 and Mesh(*CUBE).measure().area == 6, "the cube's volume")
    text = mesh.write()
    again = Mesh.read(text)
    check((again.V == mesh.V).all() and again.F == mesh.F, "OBJ written and read")
    check(Mesh.read(mesh.write(guidedproj.Format.OFF)).F == mesh.F, "OFF written and read")
    path = os.path.join(work, "ein Dach é.off")
    mesh.save(path)
    check((Mesh.load(path).V == mesh.V).all(), "OFF saved and loaded")
    lines = Mesh.read("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\nl 3 1\n")
    check([list(line) for line in lines.polylines] == [[0, 1, 2], [2, 0]], lines.polylines)
    check(guidedproj.Curve.from_polyline(lines).closest([0.5, -1, 0]).point == (0.5, 0, 0), "a polyline as a curve")
    check(repr(mesh) == "<Mesh of 7 vertices, 7 edges, 2 faces>", mesh)
    check("V" in dir(mesh) and "twin" in dir(mesh), "names of a mesh")
    raises(AttributeError, getattr, mesh, "nothing")


def test_views():
    form = Form(*dome())
    V = form.V
    check(not V.flags.owndata and V.flags.writeable and V.ctypes.data == form.mesh.V.ctypes.data, "V is a view")
    form.add_planarity()
    form.add_fixed_boundary()
    before = V.copy()
    form.solve()
    check((V == form.V).all() and (V != before).any(), "the view follows the solve")
    V[40] += [0, 0, 1]
    check(form.mesh.V[40, 2] == V[40, 2], "the view writes")
    form.V = before
    check((V == before).all(), "positions are set")
    raises(ValueError, setattr, form, "V", before[:-1], says="81 x 3")
    for name in "origin", "next", "face_degree", "loop_halfedge":
        raises(ValueError, getattr(form.mesh, name).__setitem__, 0, 7)


def test_lifetimes():
    form = Form(*dome())
    form.add_planarity()
    form.solve()
    V, mesh, copied = form.V, form.mesh, form.V.copy()
    part = V[3:5, 1]
    form.close()
    mesh.close()
    again = Mesh(*dome())
    other = Form(again)
    again.close()
    check(other.add_planarity() == 0 and other.V.shape == (81, 3), "the caller's mesh is closed, the form's is not")
    noise = [Form(*dome()) for _ in range(20)]  # what was freed too early would be written over
    check((V == copied).all() and (part == copied[3:5, 1]).all(), "a view after close()")
    V[0] = 7
    for name in "V", "mesh", "system", "memory", "units", "solve_is_on":
        raises(Error, getattr, form, name, code=Code.ERROR_STATE, says="this Form is closed")
    for function in (form.solve, form.add_planarity, form.save_state, form.get_forces, form.solve_begin,
                     form.solve_advance, form.solve_stop, form.measure_forces):
        raises(Error, function, code=Code.ERROR_STATE, says="closed")
    for function in mesh.measure, mesh.copy, mesh.planarity, mesh.write:
        raises(Error, function, code=Code.ERROR_STATE, says="this Mesh is closed")
    raises(Error, Form, mesh, code=Code.ERROR_STATE)
    raises(Error, getattr, mesh, "vertex_count", code=Code.ERROR_STATE)
    form.close()
    del noise

    # Objects outlive those that they need, in any order.
    def first_positions():
        return Form(*dome()).V
    V = first_positions()
    gc.collect()
    check(V.shape == (81, 3) and V[80, 0] == 8, "a view of a form without a name")
    form = Form(*dome())
    form.add_planarity()
    form.add_reference(guidedproj.Surface(form.mesh), 0.1)
    form.add_gliding(guidedproj.Curve.from_loop(form.mesh), [1, 2, 3])
    system, drag = form.system, form.drag([40])
    closed = form.mesh
    closed.close()
    gc.collect()
    check(drag.move(np.array([[4, 4, 3.0]])) is None, "a drag without its mesh's object")
    raises(Error, closed.measure, code=Code.ERROR_STATE, says="this Mesh is closed")
    check(form.V.shape == (81, 3) and form.mesh is form.mesh and form.mesh is not closed, "a form whose mesh was closed")
    form.close()
    check(system.group_count == 3, "a system without its form's object")
    check(drag.info.handles == 1, "a drag without its form's object")
    check(drag.end().outcome == Outcome.CONVERGED, "the end of a drag without its form's object")
    raises(Error, drag.move, [[0, 0, 0]], code=Code.ERROR_STATE, says="this Drag is closed")
    form = Form(*dome())
    for thing in (form, form.mesh, form.system, form.drag([40]), guidedproj.Curve(form.V[:3]), guidedproj.Surface(form.mesh),
                  guidedproj.Edit(form.mesh), form.mesh.subdivide()[1]):
        for function in copy.copy, copy.deepcopy, pickle.dumps:
            raises(TypeError, function, thing, says="not copied or pickled")
    with Form(*dome()) as form:
        form.add_planarity()
    raises(Error, form.solve, code=Code.ERROR_STATE)

    # Callbacks that know the form make a circle, which the collector takes apart.
    def circle():
        form = Form(*dome())
        group = form.add_rows("own")
        form.add_unknowns(group, [0.0], start=lambda V, values: form)
        form.solve_begin(5, lambda iteration: form)
        form.kept = form.drag([40])
        form.me = form
        return weakref.ref(form), weakref.ref(form._handle)
    refs = circle()
    gc.collect()
    check([ref() for ref in refs] == [None, None], "a circle stays")


def use_everything(host, callback=None):
    """A life with all kinds of objects."""
    V, F = dome(6)
    mesh = Mesh(V, F, host)
    form = Form(mesh, host=host)
    form.add_planarity()
    form.add_gliding(guidedproj.Curve.from_loop(mesh, 0, host), [1, 2, 3])
    form.add_reference(guidedproj.Surface(mesh, host), 0.1)
    form.add_equilibrium(area_load=1, supports=[v for v in range(49) if mesh.is_boundary_vertex(v)])
    form.solve(4, callback)
    state = form.save_state()
    with form.drag([24]) as drag:
        drag.move([form.V[24] + [0, 0, 0.2]])
    form.restore_state(state)
    form.solve_begin(3)
    form.solve_advance()
    edit = guidedproj.Edit(mesh, host)
    edit.split_edge(3)
    edit.triangulate()
    fine, stencil = edit.mesh(host).subdivide(host=host)
    stencil.transpose(host).multiply(stencil, host)
    guidedproj.fill(V[[0, 6, 48, 42]], corners=[0, 1, 2, 3], subdivisions=[4, 4, 4, 4], host=host)
    mesh.dual(host), mesh.diagonals(host), mesh.vertex_offset(0.1, host), mesh.support(mesh.face_offset(0.1, host), host)
    system = guidedproj.System(host)
    system.add_variables([1.0, 2.0])
    system.add_row(system.add_group("circle"), [(0, 0, 1.0), (1, 1, 1.0)], -1.0)
    system.solve()
    guidedproj.least_squares(np.eye(3), [1, 2, 3], lower=2, host=host)
    Mesh.read(mesh.copy(host).write(), host=host)
    return form.V


def test_no_leaks():
    counting = Counting()
    kept = use_everything(counting.host)
    gc.collect()
    check(counting.blocks > 0, "the view keeps its mesh")
    del kept
    gc.collect()
    check(counting.calls > 500 and counting.blocks == 0 and counting.wrong == 0,
          f"{counting.blocks} blocks are left of {counting.calls}, {counting.wrong} with a wrong size")
    calls = counting.calls
    for fail_at in [*range(1, 40), *range(40, calls, calls // 60)]:
        counting = Counting(fail_at)
        try:
            use_everything(counting.host)
            check(False, "the allocator's exception does not come out of call", fail_at)
        except ArithmeticError as exception:
            check(str(exception) == "no memory here", exception)
        except Error as exception:
            check(False, f"allocation {fail_at} gives: {exception}")
        gc.collect()
        if counting.blocks or counting.wrong:
            check(False, f"allocation {fail_at} fails: {counting.blocks} blocks are left")
    made = [Mesh(*dome(), Counting().host), Form(*dome(), host=Counting().host), guidedproj.System(Counting().host)]
    gc.collect()  # hosts stay as long as what was made with them
    noise = [guidedproj.Host(now=time.monotonic) for _ in range(50)]
    check(made[1].add_planarity() == 0 and made[1].solve().iterations > 0 and made[2].add_variables([1.0]) == 0, noise)
    del made
    limited = guidedproj.Host(limit=20000)
    raises(Error, Mesh, *dome(40), limited, code=Code.ERROR_MEMORY)
    form = Form(*dome(20))
    check(form.memory.used > 0 and form.mesh.memory.peak >= form.mesh.memory.used, form.memory)


# ---- errors and callbacks ----


def test_errors():
    V, F = dome()
    error = raises(Error, Mesh, V, [[0, 1, 99]], code=Code.ERROR_INDEX)
    check(error.place == Place.FACE and error.index == 0 and "99" in str(error), error)
    raises(Error, Mesh, V, [[0, 1, 2], [0, 1, 3], [0, 1, 4]], code=Code.ERROR_NON_MANIFOLD)
    raises(Error, Mesh, [[0, 0, math.nan]], [], code=Code.ERROR_NUMBER)
    raises(Error, Mesh.load, os.path.join(work, "nothing.obj"), code=Code.ERROR_FILE, says="cannot be opened")
    error = raises(Error, Mesh.read, "v 0 0 0\nv 1 x\n", code=Code.ERROR_SYNTAX)
    check(error.place == Place.LINE and error.index == 2, error.place, error.index)
    raises(Error, Mesh(V, F).save, os.path.join(work, "no", "folder.obj"), code=Code.ERROR_FILE)
    raises(TypeError, Mesh, V, F.astype(float), says="integers are wanted")
    raises(OverflowError, Mesh, V, [[0, 1, 2**40]])
    raises(ValueError, Mesh, V, F.ravel(), says="lists of corners, or an m x k array")
    raises(TypeError, Mesh.read, 5)
    raises(TypeError, Form, Mesh(V, F), F, says="F is for positions")
    for function, *arguments in ((guidedproj.schedule, 0.1, 1, 2**32 + 3), (Mesh(V, F).subdivide, 2**32 + 1),
                                 (guidedproj.fill, V[[0, 8, 80, 72]], None, None, 0, False, 2**32), (guidedproj.Host, -1)):
        raises(OverflowError, function, *arguments, says="does not fit into")
    check(guidedproj.schedule(0.1, 1, np.int64(3)).last == 3 and guidedproj.Host(2**40)._c.allocator.limit == 2**40, "integers")
    raises(ValueError, Mesh(V, F).subdivide, sharpness=2.0, says="no creases")
    raises(ValueError, Form(V, F).add_equilibrium, slides=3, says="no supports")
    raises(ctypes.ArgumentError, Mesh(V, F).valence, 2**33)
    raises(ValueError, Mesh, V[:, :2], F, says="n x 3")
    raises(ValueError, Mesh, ["one", "two"], F)
    form = Form(V, F)
    raises(TypeError, form.solve, quick=True, says="there is no option 'quick'")
    raises(ValueError, form.add_targets, [1, 2], [[0, 0, 0]])
    raises(Error, form.add_lengths, [5000], code=Code.ERROR_INDEX)
    raises(Error, form.add_planarity, code=Code.ERROR_INDEX)  # a form keeps its first error
    raises(Error, form.solve, code=Code.ERROR_INDEX)
    raises(Error, form.save_state, code=Code.ERROR_INDEX)
    form = Form(V, F)
    raises(Error, form.measure_forces, code=Code.ERROR_STATE)
    raises(Error, form.solve_advance, says="")
    raises(Error, form.drag, [4000], code=Code.ERROR_INDEX)
    raises(Error, form.find_reach, 4000, 1.0, code=Code.ERROR_INDEX)
    raises(Error, form.restore_state, b"nothing", code=Code.ERROR_SYNTAX)
    raises(ValueError, form.drag, [1, 2], start=[0, 5], says="start")
    raises(ValueError, form.drag, [1, 2], start=[0, 500, 2], says="start")
    raises(Error, form.drag, [1, 2], start=[0, 2, 1])
    raises(ValueError, Mesh.load, "a\0b.obj", says="NUL")
    raises(ValueError, form.add_lengths, [1, 2, 3], [1.0, 2.0], says="lengths: one number or 3 are wanted, not 2")
    form.add_rows("without a place")
    raises(Error, form.set_element_weights, 0, None, 1.0)
    form = Form(V, F)
    raises(Error, guidedproj.Curve, [[0, 0, 0]])
    raises(Error, guidedproj.fill, V[:3] * [1, 0, 0])
    edit = guidedproj.Edit(form.mesh)
    raises(Error, edit.split_edge, -1, code=Code.ERROR_INDEX)
    raises(Error, edit.set_position, 81, [0, 0, 0], code=Code.ERROR_INDEX)
    raises(Error, form.mesh.subdivide, scheme=guidedproj.Scheme.LOOP, code=Code.ERROR_ARGUMENT)
    check(guidedproj.code_string(Code.ERROR_MEMORY) == "out of memory", guidedproj.code_string(Code.ERROR_MEMORY))
    mesh, form, curve = Mesh(V, F), Form(V, F), guidedproj.Curve(V[:3])
    stencil = mesh.subdivide()[1]
    for function, *arguments in ((guidedproj.Edit, form), (guidedproj.Surface, curve), (guidedproj.Curve.from_loop, form),
                                 (guidedproj.Curve.from_polyline, V), (mesh.support, form), (mesh.measure_offset, V),
                                 (stencil.multiply, mesh), (form.add_gliding, mesh, [1]), (form.add_reference, mesh, 0.1),
                                 (form.set_schedule, 0, 1.0), (guidedproj.Drag, mesh, [1], None, None, None, 0, False)):
        raises((TypeError, ctypes.ArgumentError), function, *arguments)  # others would crash
    contradiction = Form(V, F)
    contradiction.add_fixed([0])
    contradiction.add_targets([0], [[0, 0, 5]])
    result = contradiction.solve(5)
    check(result.outcome in (Outcome.STALLED, Outcome.ITERATION_LIMIT) and result.message, "no exception:", result.message)
    check(not hasattr(guidedproj._waiting, "exception") or guidedproj._waiting.exception is None, "something waits")


def flat_form(**options):
    form = Form(*dome(), **options)
    form.add_planarity()
    form.add_fixed_corners()
    return form


def test_callbacks():
    seen, form = [], flat_form()
    result = form.solve(20, lambda iteration: seen.append(iteration))
    check([one.number for one in seen] == list(range(1, result.iterations + 1)), "iterations", len(seen))
    check(seen[-1].residual == result.residual and len(seen[0].seconds) == 5, seen[-1])
    form = flat_form()
    result = form.solve(20, lambda iteration: iteration.number < 2)
    check(result.outcome == Outcome.CANCELLED and result.iterations == 2, result.outcome, result.iterations)
    check(form.solve(20, lambda iteration: np.True_).outcome == Outcome.CONVERGED, "solves on after a cancellation")

    def broken(*_):
        calls.append(1)
        raise LookupError("mine")
    calls, form = [], flat_form()
    raises(LookupError, form.solve, 20, broken, says="mine")
    check(len(calls) == 1, "a broken callback is called once, not", len(calls))
    check(form.solve(20).outcome == Outcome.CONVERGED, "solves on after an exception")

    def interrupt(iteration):
        signal.raise_signal(signal.SIGINT)
        for _ in range(10):
            pass
    form = flat_form()
    try:
        form.solve(20, interrupt)
        check(False, "Control-C does not come out of the solve")
    except KeyboardInterrupt:
        check(form.solve(20).outcome == Outcome.CONVERGED, "solves on after Control-C")

    # Control-C while no line of Python runs: a clock in C raises the signal.
    for callback in None, lambda iteration: True:
        tick, clock = ctypes.CDLL(os.path.join(work, "tick.so")), guidedproj.Host()
        clock._c.clock.now = ctypes.cast(tick.now, ctypes.c_void_p)
        form, count = flat_form(host=clock), ctypes.c_int.in_dll(tick, "ticks")
        count.value = 0
        raises(KeyboardInterrupt, form.solve, 20, callback)
        check(signal.getsignal(signal.SIGINT) is signal.default_int_handler and count.value < 60, count.value)
        form.solve_begin(20, callback)
        count.value = 0
        raises(KeyboardInterrupt, form.solve_advance, math.inf)
        check(form.solve(20).outcome == Outcome.CONVERGED, "solves on after Control-C in C")

    # start values, a clock, an allocator, refreshes
    calls, form = [], flat_form()
    raises(LookupError, form.add_unknowns, form.add_rows("own"), [1.0], start=broken)
    calls = []
    raises(LookupError, Form(*dome(), host=guidedproj.Host(now=broken)).solve, 5)
    ticks = iter(range(10**6))
    form = flat_form(host=guidedproj.Host(now=lambda: next(ticks)))
    check(form.solve(20, time_budget=3).outcome == Outcome.TIME_OUT, "a clock of one's own")
    system = guidedproj.System()
    system.add_variables([3.0])

    def refresh(system, group, progress):
        if progress.iteration == 2:
            raise LookupError("second")
        x = system.values[0]
        system.set_row(group, 0, [math.cos(x)], math.sin(x) - x * math.cos(x))
        seen.append(progress.iteration)
    seen = []
    group = system.add_group("sine", refresh=refresh)
    system.add_row(group, [(0, -1, 1.0)])
    raises(LookupError, system.solve, 20, says="second")
    check(seen == [0, 1], "refreshed in", seen)
    raises(ValueError, system.set_row, group, 0, [1.0, 2.0], 0.0)
    form = flat_form()
    raises(ValueError, form.system.set_row, 0, 5, [1.0], 0.0, says="row 5 of group 0 was not added by add_row")


def test_refresh_and_systems():
    """sin x = 0 by tangents, from 3: pi; and two circles that meet."""
    system = guidedproj.System()
    first = system.add_variables([3.0])
    check(first == 0 and (system.values == [3.0]).all(), "variables")

    def refresh(system, group, progress):
        x = system.values[0]
        system.set_row(group, 0, [math.cos(x)], math.sin(x) - x * math.cos(x))
    group = system.add_group("sine", refresh=refresh, place=Place.VARIABLE)
    system.add_row(group, [(0, -1, 1.0)], 0.0, 0)
    result = system.solve(20)
    check(result.outcome == Outcome.CONVERGED and abs(system.values[0] - math.pi) < 1e-12, result.message, system.values)
    circles = guidedproj.System()
    circles.add_variables([0.2, 0.7])
    group = circles.add_group("circles", Kind.CONSTRAINT)
    circles.add_row(group, [(0, 0, 1.0), (1, 1, 1.0)], -1.0)
    circles.add_row(group, [(0, 0, 1.0), (0, -1, -2.0), (1, 1, 1.0)], 0.0)
    check(circles.solve(30).outcome == Outcome.CONVERGED, "circles")
    check(np.allclose(circles.values, [0.5, math.sqrt(0.75)], atol=1e-12), circles.values)
    value, gradient = circles.row_value(group, 0)
    check(abs(value) < 1e-12 and np.allclose(gradient, 2 * circles.values), value, gradient)
    circles.values = [1.0, 0.0]
    check(circles.row_value(group, 1)[0] == -1, "values are set")
    check(circles.group_info(group).rows == 2 and circles.group_count == 1, circles.group_info(group))
    circles.set_schedule(group, guidedproj.keep(0))
    circles.set_row_weight(group, 1, 0.5)
    check(circles.check_gradients() < 1e-7 and circles.memory.used > 0, "gradients of circles")
    raises(Error, circles.add_row, group, [(0, 7, 1.0)], code=Code.ERROR_INDEX)


def test_refresh_in_a_form():
    """Rows of the form's system, anew in each iteration: a vertex on the curve z = sin x / 2."""
    form = Form(*dome())
    form.add_planarity()
    form.add_closeness(0.01)
    seen, (centre, scale) = [], form.units

    def refresh(system, group, progress):
        x = system.values[120] / scale + centre[0]
        seen.append(system)
        system.set_row(group, 0, [1.0, -math.cos(x) / 2], (centre[2] - math.sin(x) / 2 + math.cos(x) / 2 *
                                                        (x - centre[0])) * scale)
    group = form.system.add_group("wave", refresh=refresh, place=Place.VERTEX)
    form.system.add_row(group, [(122, -1, 1.0), (120, -1, 1.0)], 0.0, 40)
    gc.collect()
    result = form.solve(30)
    x, _, z = form.V[40]
    check(result.outcome == Outcome.CONVERGED and abs(z - math.sin(x) / 2) < 1e-9, result.message, x, z)
    form.close()
    check(seen[0].group_count >= 3, "a system from a callback keeps its form")


def test_threads():
    """Forms in threads of their own: each exception comes out where it belongs."""
    came = {}

    def life(name):
        def broken(iteration):
            if iteration.number == 2 + name % 2:
                raise LookupError(name)
        try:
            flat_form().solve(20, broken)
        except LookupError as exception:
            came[name] = exception.args[0]
    threads = [threading.Thread(target=life, args=(name,)) for name in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    check(came == {name: name for name in range(6)}, came)


def test_documented():
    for kind in (Mesh, guidedproj.Edit, guidedproj.Stencil, guidedproj.Curve, guidedproj.Surface, guidedproj.System, Form,
                 guidedproj.Drag):
        for name, what in vars(kind).items():
            check(name.startswith("_") or what.__doc__, kind, name, "has no documentation")


# ---- forms ----


def test_all_builders():
    V, F = dome()
    mesh = Mesh(V, F)
    inner = [v for v in range(81) if not mesh.is_boundary_vertex(v)]
    curve, surface = guidedproj.Curve.from_loop(mesh), guidedproj.Surface(mesh)
    calls = {
        "planarity": (), "fixed": ([0, 8],), "fixed_boundary": (), "fixed_corners": (), "targets": ([0, 8], V[[0, 8]]),
        "gliding": (curve, [1, 2]), "gliding_boundary": (), "circularity": (), "conicality": (), "lengths": ([0, 1],),
        "equal_lengths": ([0, 1],), "midsphere": (), "coplanar": (inner[:5],), "collinear": (inner[:3],),
        "planar_boundary": (), "straight_boundary": (), "orthogonal_edges": ([0, 0, 1], [0, 1]),
        "orthogonal_boundary": (), "lifting": (), "volume": (200.0,), "total_area": (80.0,),
        "cost": (1.0, 0.5, 100.0), "length_bounds": (None, 0.5, 2.0), "area_bounds": ([3], 0.5),
        "total_area_bounds": (1.0, 200.0), "cost_bounds": (1.0, 0.5, 1.0), "closeness": (0.1,), "reference": (surface, 0.1),
        "fairness": (0.1,), "boundary_fairness": (0.1,), "tangential_fairness": (0.1,), "gauss_fairness": (0.1,),
        "parallelograms": (0.1,), "equal_areas": (0.1,), "rows": ("own",), "equilibrium": (),
        "compression": (), "tension": (), "stress_bounds": ([1, 2], -5.0, 5.0), "force_fairness": (0.1,),
    }
    builders = {name[4:] for name in dir(Form) if name.startswith("add_")} - {"row", "unknowns"}
    check(builders == set(calls), "not tried:", builders ^ set(calls))
    for name, arguments in calls.items():
        form = Form(V, F)
        if name in ("conicality", "circularity", "gauss_fairness"):
            form.add_planarity()
        if name in ("compression", "tension", "stress_bounds", "force_fairness"):
            form.add_equilibrium(density=1, supports=[0, 8, 72, 80])
        before = form.system.group_count
        number = getattr(form, "add_" + name)(*arguments)
        info = form.group_info(number)
        check(number >= 0 and form.system.group_count > before and info.name, name, number, info.name)
        known = {"fixed": "fixed vertices", "gauss_fairness": "Gauss image fairness", "rows": "own"}
        check(info.name == known.get(name, name.replace("_", " ")), name, "adds", info.name)
        check((info.rows > 0) == (name != "rows"), name, "has", info.rows, "rows")
    form = Form(V, F)
    check([form.group_info(form.add_fixed(list_of)).rows for list_of in (None, [], [5, 6])] == [243, 0, 6],
          "lists: all, none, two")
    for bad, what in ((dict(min=5.0, max=1.0), "bounds"), (dict(min=math.nan), "bounds")):
        raises(Error, Form(V, F).add_length_bounds, **bad)


def test_own_rows():
    """Vertices on a sphere whose centre and radius are unknown."""
    V, F = dome()
    form = Form(V, F)
    group, started = form.add_rows("sphere", place=Place.VERTEX), []

    def start(V, values):
        started.append((V.shape, values))
        values[:] = [*(V.mean(axis=0) - [0, 0, 8]), 9.0]
    centre = form.add_unknowns(group, np.zeros(3), Unit.POINT)
    radius = form.add_unknowns(group, [9.0], Unit.LENGTH)
    other = form.add_rows("other")
    first = form.add_unknowns(other, np.ones(4), start=start)
    for v in range(81):  # |v - c|^2 - r^2 = 0, over 2 r
        terms = [(3 * v + k, 3 * v + k, 1 / 18) for k in range(3)] + [(centre + k, centre + k, 1 / 18) for k in range(3)]
        terms += [(3 * v + k, centre + k, -1 / 9) for k in range(3)] + [(radius, radius, -1 / 18)]
        form.add_row(group, terms, 0.0, v)
    result = form.solve(20)
    c, r = form.get_unknowns(centre, 3), form.get_unknowns(radius, 1)[0]
    far = np.linalg.norm(form.V - c, axis=1)
    check(result.outcome == Outcome.CONVERGED and abs(far - abs(r)).max() < 1e-9, result.message, far.max() - r)
    check(len(started) == 2 and started[0][0] == (81, 3), "start values were asked for:", len(started))
    check(form.get_unknowns(first, 4)[3] == 9.0 and started[0][1][3] == 9.0, "start values:", form.get_unknowns(first, 4))
    started[0][1][:] = 0  # what a callback keeps is a copy
    form.set_element_weights(group, [0, 1], [0.0, 0.5])
    form.set_element_weights(group, None, 1.0)
    check(form.residuals(group).shape == (81,) and form.system.check_gradients() < 1e-6, "residuals by vertex")
    raises(Error, form.get_unknowns, 5000, 2)
    raises(Error, form.residuals, other)
    centre, scale = form.units
    check(np.allclose((form.V[7] - centre) * scale, form.system.values[21:24]), "units")


def test_statics():
    V, F = dome()
    form = Form(V, F)
    boundary = [v for v in range(81) if form.mesh.is_boundary_vertex(v)]
    form.add_equilibrium(area_load=1, snow=0.5, density=0.1, supports=boundary)
    form.add_compression()
    form.add_fixed_boundary()
    densities, residuals = form.find_forces()
    for supports in None, []:
        usual = Form(V, F)
        usual.add_equilibrium(area_load=1, snow=0.5, density=0.1, supports=supports)
        usual.add_compression()
        check((usual.find_forces()[0] == densities).all(), "the boundary carries where supports are", supports)
    check(densities.min() >= 0 and residuals.shape == (81,) and form.find_imbalance().shape == (81, 3), "forces found")
    result = form.solve(60)
    forces = form.measure_forces()
    check(result.outcome == Outcome.CONVERGED and forces.residual < 1e-9, result.message)
    w, e = form.get_forces(), form.mesh.edges
    push = w[:, None] * (form.V[e[:, 0]] - form.V[e[:, 1]])
    total = form.get_loads()
    np.add.at(total, e[:, 0], push)
    np.add.at(total, e[:, 1], -push)
    check(abs(total + form.get_reactions()).max() < 1e-8 * abs(form.get_loads()).max(), abs(total).max())
    check(np.isclose(forces.total_load, -form.get_loads()[:, 2].sum()), forces.total_load)
    form.set_forces(w)
    form.set_forces(None)
    check(form.force_variable(int(np.flatnonzero(w)[0])) > 0, "the variable of a force")
    rollers = Form(V, F)
    rollers.add_equilibrium(point_load=-np.ones((81, 3)), edge_density=np.full(144, 0.1), supports=boundary, slides=4)
    check(rollers.find_forces()[0].shape == (144,), "rollers")
    raises(ValueError, Form(V, F).add_equilibrium, point_load=[[0, 0, 1]], says="81 x 3")


def test_frames_and_states():
    whole, frames = flat_form(), flat_form()
    result, seen = whole.solve(20), []
    frames.solve_begin(20, lambda iteration: seen.append(iteration.number))
    gc.collect()
    state = None
    while frames.solve_is_on:
        frame = frames.solve_advance()
        if len(seen) == 2:
            state = frames.save_state()
    check(frame.outcome == Outcome.CONVERGED and (whole.V == frames.V).all(), "frames give the bytes of a solve")
    check(seen == list(range(1, result.iterations + 1)), seen)
    frames.restore_state(state)
    check(frames.solve_is_on, "a restored solve is on")
    frames.solve_advance(math.inf)
    check((whole.V == frames.V).all(), "a restored solve gives the bytes of a solve")
    check(isinstance(state, bytes) and flat_form().restore_state(state) is None, "a state in another form like it")
    raises(Error, Form(*dome()).restore_state, state, code=Code.ERROR_ARGUMENT)
    raises(Error, frames.restore_state, state[:-3], code=Code.ERROR_SYNTAX)
    raises(Error, frames.solve_begin, 20, tolerance=-1.0, code=Code.ERROR_ARGUMENT)
    limits = [guidedproj._limit(given, {"smooth": smooth, "nearest": nearest})
              for given, smooth, nearest in [(7, 1, 1), (None, 0, 0), (None, 1, 0), (None, 1, 1)]]
    check(limits == [7, 20, 300, 60], "iterations that are allowed", limits)
    frames.solve_begin(20, lambda iteration: 1 // 0)
    raises(ZeroDivisionError, frames.solve_advance)
    raises(Error, frames.solve_memory, code=Code.ERROR_STATE)
    frames.solve_begin(20)
    told = frames.solve_memory()
    frames.solve_advance()
    check(0.7 * told <= frames.memory.peak <= told, (told, frames.memory.peak))
    frames.solve_stop()
    check(not frames.solve_is_on, "stopped")


def test_drag():
    form = flat_form()
    form.solve(20)
    before, at = form.V.copy(), form.V[40].copy()
    with form.drag([40]) as drag:
        for way in 0.1, 0.2:
            drag.move([at + [0, 0, way]])
            check(np.allclose(form.V[40], at + [0, 0, way]), "the handle follows")
        check(drag.residual < 0.1 and drag.info.freedom == 3 and drag.memory.used > 0, drag.info)
        raises(Error, form.solve, 3, code=Code.ERROR_STATE)
    check(drag.result.outcome == Outcome.CONVERGED and form.mesh.measure().planarity_max < 1e-12, drag.result.message)
    form = flat_form()
    form.solve(20)
    try:
        with form.drag([40]) as drag:
            drag.move([at + [0, 0, 1]])
            raise LookupError
    except LookupError:
        check((form.V == before).all(), "cancelled by an exception")
    drag = form.drag([40, 30])
    drag.move(form.V[[40, 30]] + [0, 0, 0.1])
    check(drag.release(), "released in frames")
    while form.solve_is_on:
        form.solve_advance()
    check(drag.end().outcome == Outcome.CONVERGED, "the end of frames")
    vertices, weights = form.find_reach(40, 2.5)
    check(vertices[0] == 40 and weights[0] == 1 and len(vertices) > 5, vertices, weights)
    drag = form.drag(vertices, weights, start=[0, len(vertices)], position=form.V[40], residual_bound=0.1)
    drag.move(form.V[40] + [0, 0, 0.3])  # of a single handle
    for positions in [[0, 0]], [0, 0], [[0, 0, 0], [0, 0, 0]], 0:
        raises(ValueError, drag.move, positions)
    raises(Error, drag.move, [[0, 0, math.nan]], code=Code.ERROR_NUMBER)
    drag.cancel()
    raises(Error, drag.cancel, code=Code.ERROR_STATE)
    before = form.V.copy()
    drag = form.drag([40])
    drag.move([at + [0, 0, 1]])
    drag.close()
    drag.close()
    check((form.V == before).all() and form.drag([40]).info.handles == 1, "a drag that is closed is cancelled")


def test_exceptions_in_drags():
    # Control-C while no line of Python runs, in a release.
    tick, clock = ctypes.CDLL(os.path.join(work, "tick.so")), guidedproj.Host()
    clock._c.clock.now = ctypes.cast(tick.now, ctypes.c_void_p)
    form, count = flat_form(host=clock), ctypes.c_int.in_dll(tick, "ticks")
    count.value = 100
    form.solve(20)
    drag = form.drag([40])
    drag.move([form.V[40] + [0, 0, 0.5]])
    count.value = 0
    raises(KeyboardInterrupt, drag.end)
    check(drag.result.outcome == Outcome.CANCELLED and drag.result.iterations < 5, drag.result)
    check(form.solve(20).outcome == Outcome.CONVERGED, "solves on after Control-C in a release")

    # A start function that raises as a drag begins: the form is free at once, though the traceback is kept.
    form, on, kept = flat_form(), [], []
    group = form.add_rows("own")
    first = form.add_unknowns(group, [1.0], start=lambda V, values: on and 1 // 0)
    form.add_row(group, [(first, -1, 1.0)], -1.0)
    on.append(1)
    for begin in lambda: form.drag([40]), lambda: form.solve(3):
        kept.append(raises(ZeroDivisionError, begin))
    on.clear()
    check(form.drag([40]).info.handles == 1, "a drag after one that did not begin")
    drag = form.drag([40])
    drag.move([form.V[40] + [0, 0, 0.5]])
    on.append(1)
    kept.append(raises(ZeroDivisionError, drag.end))
    check(drag.result.outcome == Outcome.CANCELLED, "a verdict after an exception:", drag.result)
    on.clear()
    check(form.solve(20).outcome == Outcome.CONVERGED, "solves on after an exception in a release")


def test_drags_from_callbacks():
    """What would end a drag while the library works on it is refused."""
    form, said, box = flat_form(), set(), []

    def refresh(system, group, progress):
        for drag in box:
            for name, *arguments in ("cancel",), ("end",), ("close",), ("release",), ("move", [[0, 0, 0]]):
                try:
                    getattr(drag, name)(*arguments)
                except Error as error:
                    said.add((name, str(error)))
    group = form.system.add_group("own", refresh=refresh)
    form.system.add_row(group, [(0, -1, 1.0)], -form.system.values[0])
    form.solve(20)
    for work_on in (lambda drag: drag.end(), lambda drag: drag.release() and form.solve_advance(math.inf) and drag.end()):
        drag = form.drag([40], residual_bound=1e-3)
        box.append(drag)
        drag.move([form.V[40] + [0, 0, 2]])
        check({name for name, _ in said} == {"cancel", "end", "close", "release", "move"}, "while it moves:", said)
        check(all("under way" in sentence for _, sentence in said), said)
        said.clear()
        work_on(drag)
        check(len(said) == 5 and drag.result.outcome in (Outcome.CONVERGED, Outcome.ITERATION_LIMIT), said, drag.result)
        said.clear()
        box.clear()
    before, seen = form.V.copy(), []

    def forget(system, group, progress):
        box.clear()
        seen.append(form.solve_is_on)
    group = form.system.add_group("other", refresh=forget)
    form.system.add_row(group, [(0, -1, 1.0)], -form.system.values[0])
    box.append(form.drag([40]))
    box[0].move([form.V[40] + [0, 0, 1]])
    del drag
    seen.clear()
    check(box[0].release() and form.solve_is_on, "a release in frames")
    form.solve_advance()
    check(seen[0] and not box, "a drag that a callback forgets is cancelled in the middle of a call:", seen)
    check((form.V == before).all() and not form.solve_is_on, "a drag that a callback forgets is not cancelled")
    check(form.solve(20).outcome == Outcome.CONVERGED, "solves on after a drag that was forgotten")


# ---- other meshes ----


def test_edits_and_meshes():
    mesh = Mesh(*dome())
    edit = guidedproj.Edit(mesh)
    vertex = edit.split_edge(edit.edge(40, 41), 0.25)
    check(np.allclose(edit.position[vertex], 0.75 * mesh.V[40] + 0.25 * mesh.V[41]) or
          np.allclose(edit.position[vertex], 0.25 * mesh.V[40] + 0.75 * mesh.V[41]), "the new vertex")
    check(edit.vertex_count == 82 and edit.vertex(vertex) == vertex and edit.edge(0, 80) == -1, "counts")
    check(len(edit.vertex_number) == 0, "no maps before a mesh")
    after = edit.mesh()
    check(after.vertex_count == 82 and edit.vertex_number[vertex] == 81 and len(edit.face_number) == 64, "maps")
    rung = edit.insert_strip(0)
    check(edit.remove_strip(rung, 1.0) == 9, "strips")
    edit.set_position(0, [9, 9, 9])
    check(edit.collapse_edge(edit.edge(30, 31)) == 30 and edit.vertex(31) == 30, "collapsed")
    face = int(np.flatnonzero(edit.face_degree == 4)[0])
    check(edit.split_face(face, *edit.origin[[edit.face_halfedge[face],
                                              edit.next[edit.next[edit.face_halfedge[face]]]]]) >= 0, "split")
    check(edit.triangulate() > 50 and set(edit.mesh().face_degree) == {3}, "triangles")
    check(edit.memory.used > 0 and tuple(edit.mesh().V[0]) == (9, 9, 9), "the edit's position")
    dual, face = mesh.dual()
    check(dual.vertex_count == 64 + 32 + 4 and face.shape == (81,) and face.min() >= 0, dual.vertex_count)
    along = mesh.diagonals()
    check(along.vertex_count == 144 + 4 and along.face_count == 64 + 81, along.vertex_count)
    fine, stencil = mesh.subdivide(2, creases=[0, 1], sharpness=[1.5, math.inf], corners=[40])
    check(fine.face_count == 1024 and stencil.shape == (fine.vertex_count, 81), stencil.shape)
    check(np.allclose(stencil.apply(mesh.V), fine.V), "the stencil gives the fine positions")
    check(np.allclose(np.add.reduceat(stencil.weight, stencil.start[:-1]), 1), "weights sum to 1")
    once, first = mesh.subdivide()
    twice, second = once.subdivide()
    both = second.multiply(first)
    check(np.allclose(both.apply(mesh.V), twice.V) and both.transpose().shape == both.shape[::-1], "stencils multiplied")
    weight, copied = stencil.weight, stencil.weight.copy()
    stencil.close()
    once.subdivide(3)
    check((weight == copied).all(), "a view of a closed stencil")
    ring = np.array([[math.cos(a), math.sin(a), 0.1 * a] for a in np.linspace(0, 6.28, 40, endpoint=False)])
    filled, info = guidedproj.fill(ring, edge_length=0.2)
    check(filled.F.shape[1] == 4 and info.side_count >= 2 and info.boundary_count > 20, info)
    offset = filled.face_offset(0.1)
    check(filled.measure_offset(offset).vertex_distance_max > 0.09, "offset")
    check(filled.support(offset).face_count == filled.edge_count, "support")
    original = mesh.V.copy()
    mesh.V = original * [1, 1, -1]
    check(mesh.measure_spoiled(original).total == 0 and mesh.measure(original).deviation_max > 0, "measures")
    curve = guidedproj.Curve([[0, 0, 0], [2, 0, 0], [2, 2, 0]], closed=True)
    check(curve.closest([1, -1, 0]).distance == 1 and curve.closest([1, -1, 0]).segment == 0, "a curve")
    check(guidedproj.Surface(mesh).closest([4, 4, 50]).face >= 0, "a surface")


def test_least_squares():
    rng = np.random.default_rng(7)
    A, b = rng.normal(size=(12, 5)), rng.normal(size=12)
    x, result = guidedproj.least_squares(A, b)
    check(np.allclose(x, np.linalg.lstsq(A, b, rcond=None)[0]) and result.kkt < 1e-9, result)
    x, result = guidedproj.least_squares(A, b, lower=0, upper=[1, 1, 1, 1, math.inf], damping=0.1, start=np.ones(5))
    check(x.min() >= 0 and result.at_bounds > 0 and result.outcome == guidedproj.LeastSquaresOutcome.SOLVED, x, result)

    class Columns:  # what scipy's csc_matrix shows
        shape, indptr, indices, data = (2, 2), np.array([0, 1, 3]), np.array([0, 0, 1]), np.array([2.0, 1.0, 4.0])
    check(np.allclose(guidedproj.least_squares(Columns, [3.0, 4.0])[0], [1, 1]), "columns")
    Columns.indptr = np.array([0, 1, 300])
    raises(ValueError, guidedproj.least_squares, Columns, [3.0, 4.0], says="compressed columns")

    class Rows:  # csr_matrix, which looks alike where it is square
        shape, indptr, indices, data, format = (2, 2), np.array([0, 1, 3]), np.array([0, 0, 1]), np.array([2., 1., 4.]), "csr"
    raises(ValueError, guidedproj.least_squares, Rows, [2.0, 9.0], says="compressed columns")
    Columns.indptr, Columns.indices, Columns.data = np.array([0, 2, 3]), np.array([0, 1, 1]), np.array([2.0, 1.0, 4.0])
    Rows.tocsc = staticmethod(lambda: Columns)
    check(np.allclose(guidedproj.least_squares(Rows, [2.0, 9.0])[0], [1, 2]), "rows are converted")
    raises(Error, guidedproj.least_squares, A, b, lower=2, upper=1, code=Code.ERROR_ARGUMENT)


# ---- the library ----


def run(*arguments, **environment):
    return subprocess.run([sys.executable, "-B", *arguments], capture_output=True, text=True, cwd=work,
                          env={**os.environ, **environment})


def test_building():
    module = os.path.join(root, "examples", "python", "guidedproj.py")
    path = run(module).stdout.strip()
    check(os.path.dirname(path) == os.environ["GUIDEDPROJ_CACHE"] and os.path.isfile(path), path)
    empty = {"PATH": os.path.join(work, "empty"), "CC": "", "GUIDEDPROJ_CACHE": os.path.join(work, "other")}
    done = run(module, **empty)
    check(done.returncode == 1 and "there is no C compiler" in done.stderr and "apt-get install" in done.stderr, done.stderr)
    done = run(module, CC="false", GUIDEDPROJ_CACHE=os.path.join(work, "other"))
    check(done.returncode == 1 and "'false' does not compile guidedproj.h" in done.stderr, done.stderr)
    check(os.listdir(os.path.join(work, "other")) == [], "nothing stays of what failed")
    done = run(module, CC='gcc "', GUIDEDPROJ_CACHE=os.path.join(work, "other"))
    check(done.returncode == 1 and "guidedproj: CC is no command" in done.stderr, done.stderr)
    done = run(module, GUIDEDPROJ_CACHE=os.path.join(ROOF, "below"))
    check(done.returncode == 1 and "guidedproj: the library cannot be put into" in done.stderr and
          "GUIDEDPROJ_CACHE may name another" in done.stderr, done.stderr)
    copies = {"CC": os.path.join(work, "compiler")}
    named = run(module, "plain.so", **copies).stdout.strip()
    check(named == os.path.join(os.path.realpath(work), "plain.so") and os.path.isfile(named), named)
    done = run(module, "--help", **copies)
    check(done.returncode == 0 and done.stdout.startswith("usage: ") and not os.path.exists(os.path.join(work, "--help")),
          done.stdout, done.stderr)
    for wrong in ["--nothing"], ["one.so", "two.so"]:
        done = run(module, *wrong, **copies)
        check(done.returncode == 1 and "usage: " in done.stderr and not os.path.exists(os.path.join(work, "one.so")), done.stderr)
    use = f"import sys; sys.path.insert(0, {os.path.dirname(module)!r}); import guidedproj; guidedproj.Mesh([[0, 0, 0]], [])"
    check(run("-c", use, GUIDEDPROJ_LIBRARY=path, **empty).returncode == 0, "a compiled library is taken")
    copies["GUIDEDPROJ_CACHE"] = os.path.join(work, "cut off")
    cut = run(module, **copies).stdout.strip()
    size = os.path.getsize(cut)
    os.truncate(cut, size // 2)
    check(run("-c", use, **copies).returncode == 0 and os.path.getsize(cut) == size, "a library that was cut off stays")
    with open(cut, "wb") as file:
        file.write(bytes(size))
    check(run("-c", use, **copies).returncode == 0, "a library that does not load stays")
    done = run("-c", use, GUIDEDPROJ_LIBRARY="nothing.so")
    check("'nothing.so' is no library of guidedproj.h" in done.stderr, done.stderr)
    done = run("-c", use.replace("; guidedproj.Mesh", "; guidedproj.VERSION = '9.9'; guidedproj.Mesh"))
    check("this is the binding of version 9.9" in done.stderr, done.stderr)


def test_examples():
    for name in "planarize", "self_supporting_roof", "circular_mesh":
        done = run(os.path.join(root, "examples", "python", name + ".py"))
        with open(os.path.join(root, "tests", "expected", name + ".txt"), encoding="utf-8") as file:
            check(done.stdout == file.read(), name, "prints", done.stdout + done.stderr)


for test in [function for name, function in list(globals().items()) if name.startswith("test_")]:
    try:
        test()
    except Exception:
        check(False, test.__name__, traceback.format_exc())
print(passed, failed)
