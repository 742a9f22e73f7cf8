"""test_blender.py - run by test_python.sh in headless Blender: -- ROOT. Installs examples/blender/guidedproj_blender.py as an
add-on and uses its operator on meshes, with undo and errors. The last line of its own says how many checks have passed."""
import os
import shutil
import sys

import addon_utils
import bpy
import numpy as np

root = sys.argv[sys.argv.index("--") + 1]
passed = failed = 0


def check(holds, *what):
    global passed, failed
    if holds:
        passed += 1
    else:
        failed += 1
        print("FAILED:", *what)


def new_object(V, F):
    mesh = bpy.data.meshes.new("roof")
    mesh.from_pydata([list(v) for v in V], [], [list(face) for face in F])
    thing = bpy.data.objects.new("roof", mesh)
    bpy.context.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    bpy.context.view_layer.update()
    return thing


def positions(thing):
    return np.array([thing.matrix_world @ vertex.co for vertex in thing.data.vertices])


def solve(**options):
    return bpy.ops.object.guided_projection(**options)


def measure(thing):
    return guidedproj.Mesh(positions(thing), [list(face.vertices) for face in thing.data.polygons]).measure()


addons = bpy.utils.user_resource("SCRIPTS", path="addons", create=True)
bpy.ops.preferences.addon_install(filepath=os.path.join(root, "examples", "blender", "guidedproj_blender.py"))
for part in "examples/python/guidedproj.py", "guidedproj.h":  # what the user puts beside it
    shutil.copy(os.path.join(root, part), addons)
addon_utils.modules_refresh()
bpy.ops.preferences.addon_enable(module="guidedproj_blender")
import guidedproj

roof = guidedproj.Mesh.load(os.path.join(root, "examples", "roof.obj"))
corners = [v for v in range(roof.vertex_count) if roof.valence(v) == 2]

import guidedproj_blender
check(os.path.dirname(guidedproj.__file__) == addons.rstrip("/"), guidedproj.__file__, addons)
check(guidedproj_blender.bl_info["version"] == tuple(int(part) for part in guidedproj.VERSION.split(".")), "the version")

# ---- planar panels, and undo ----

thing = new_object(roof.V, roof.F)
before, warped = positions(thing), measure(thing).planarity_max
bpy.ops.ed.undo_push(message="a roof")
check(solve() == {"FINISHED"}, "the operator finishes")
bpy.ops.ed.undo_push(message="flat")
flat = positions(thing)
check(measure(thing).planarity_max < 3e-6 < warped, warped, measure(thing).planarity_max)
check(np.array_equal(flat[corners], before[corners]), "corners stay")
check(abs(flat - before).max() > 0.01, "vertices move")
bpy.ops.ed.undo()
check(np.array_equal(positions(bpy.context.active_object), before), "undo puts all back")
bpy.ops.ed.redo()
check(np.array_equal(positions(bpy.context.active_object), flat), "redo makes it flat again")

# ---- the vertex group "fixed", in an object that is moved, turned and scaled ----

thing = new_object(roof.V, roof.F)
thing.location, thing.rotation_euler, thing.scale = (5, 6, 7), (0, 0, 1), (2, 2, 2)
bpy.context.view_layer.update()
held = [30, 200, 201, 300]
thing.vertex_groups.new(name="fixed").add(held, 1.0, "REPLACE")
thing.vertex_groups.new(name="others").add([40], 1.0, "REPLACE")
before = positions(thing)
check(solve(boundary="FREE", fairness=0.05) == {"FINISHED"}, "with a vertex group")
moved = np.linalg.norm(positions(thing) - before, axis=1)
check(moved[held].max() < 1e-5 < moved[40], moved[held], moved[40])
check(measure(thing).planarity_max < 3e-6, measure(thing).planarity_max)

# ---- in edit mode ----

thing = new_object(roof.V, roof.F)
bpy.ops.object.mode_set(mode="EDIT")
check(solve(boundary="FIXED") == {"FINISHED"} and thing.mode == "EDIT", "in edit mode")
bpy.ops.object.mode_set(mode="OBJECT")
check(measure(thing).planarity_max < 3e-6, measure(thing).planarity_max)

# ---- circular, conical, equilibrium ----

number = np.arange(81).reshape(9, 9)
F = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
V = [[i, j, 3 - 0.1 * (i - 4) ** 2 - 0.1 * (j - 4) ** 2 + 0.02 * (i * j % 3)] for i in range(9) for j in range(9)]
thing = new_object(V, F)
check(solve(circular=True, boundary="FREE", closeness=0.03) == {"FINISHED"}, "circular")
check(measure(thing).circularity_max < 3e-6, measure(thing).circularity_max)
thing = new_object(V, F)
check(solve(conical=True, boundary="FREE", closeness=0.03) == {"FINISHED"}, "conical")
check(measure(thing).conicality_max < 1e-5, measure(thing).conicality_max)
thing = new_object(V, F)
check(solve(planar=False, equilibrium=True, boundary="FIXED") == {"FINISHED"}, "equilibrium")
form = guidedproj.Form(positions(thing), F)
form.add_equilibrium(area_load=1, supports=[v for v in range(81) if form.mesh.is_boundary_vertex(v)])
form.add_compression()
check(form.find_forces()[1].max() < 1e-4, "stands by compression, but for floats:", form.find_forces()[1].max())

# ---- errors are reported with the library's sentence, and nothing changes ----


def refused(says, **options):
    thing, before = bpy.context.active_object, positions(bpy.context.active_object)
    try:
        check(solve(**options) == {"CANCELLED"} and False, "no error is reported for", says)
    except RuntimeError as error:
        check(says in str(error), "says:", error)
    check(np.array_equal(positions(thing), before), "a refusal moves nothing")


new_object([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]], [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
refused("edge 0-1 has 3 faces")
thing = new_object(V, F)
thing.shape_key_add(name="Basis")
refused("shape keys")
thing = new_object(V, F)
thing.scale = (1, 1, 0)
bpy.context.view_layer.update()
refused("scaled to nothing")
new_object(V, F)
refused("equilibrium needs supports, and the boundary is free", planar=False, equilibrium=True, boundary="FREE")
kept, sys.modules["guidedproj"] = guidedproj, None  # as if it were not there
refused("guidedproj.py and guidedproj.h have to be beside the add-on")
sys.modules["guidedproj"] = kept
cache, os.environ["GUIDEDPROJ_CACHE"] = os.environ["GUIDEDPROJ_CACHE"], os.path.join(root, "README.md", "below")
guidedproj._lib.cache_clear()
refused("GUIDEDPROJ_CACHE may name another folder")
os.environ["GUIDEDPROJ_CACHE"] = cache
around = [[r * np.cos(a), r * np.sin(a), 4 - 0.2 * r * r] for r in (1, 2, 3) for a in np.arange(24) * np.pi / 12]
rings = [[24 * r + k, 24 * r + k + 24, 24 * r + (k + 1) % 24 + 24, 24 * r + (k + 1) % 24] for r in (0, 1) for k in range(24)]
new_object([[0, 0, 4], *around], [[0, k + 1, (k + 1) % 24 + 1] for k in range(24)] + [[v + 1 for v in face] for face in rings])
refused("equilibrium needs supports, and the boundary has no corners", planar=False, equilibrium=True, boundary="CORNERS")
new_object([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)],
           [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
refused("equilibrium needs supports, and the mesh has no boundary", planar=False, equilibrium=True, boundary="FIXED")
bpy.context.view_layer.objects.active = None
check(not bpy.ops.object.guided_projection.poll(), "nothing to do without a mesh")
bpy.ops.preferences.addon_disable(module="guidedproj_blender")
check("guided_projection" not in dir(bpy.ops.object), "the add-on goes away")
print(f"{passed} {failed}")
