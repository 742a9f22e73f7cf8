"""guidedproj_blender.py - an add-on for Blender: panels of the active mesh become planar, circular or conical, or stand by
their forces, with the options in the panel of the last operation. The whole thing is one operator over guidedproj.py.

Install: Edit > Preferences > Add-ons > Install, this file; and put guidedproj.py (of ../python) and guidedproj.h beside it in
Blender's add-ons folder. The first use compiles the library and takes a quarter of a minute; see guidedproj.py.
Use: Object > Guided Projection. Vertices in the vertex group "fixed" stay, those in the group "supports" carry in equilibrium
(without it: the fixed ones, and the corners of the boundary where these are fixed, or all of it where it glides or is fixed).
Blender keeps positions as floats: panels are planar to about 1e-7 of the mesh's size, or of its distance from the object's
origin where that is larger."""
import os
import sys

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

bl_info = {
    "name": "Guided Projection",
    "description": "Flat, circular and conical panels, equilibrium: form-finding by guidedproj.h",
    "version": (0, 2),
    "blender": (3, 0, 0),
    "location": "View3D > Object > Guided Projection",
    "category": "Mesh",
}

_here = os.path.dirname(os.path.realpath(__file__))
for _folder in _here, os.path.join(_here, "..", "python"):
    if os.path.isfile(os.path.join(_folder, "guidedproj.py")) and _folder not in sys.path:
        sys.path.append(_folder)


def group_members(thing, name):
    """The vertices in a vertex group of the object, by its name; none without such a group."""
    group = thing.vertex_groups.get(name)
    if group is None:
        return []
    return [vertex.index for vertex in thing.data.vertices
            if any(one.group == group.index and one.weight > 0 for one in vertex.groups)]


def read_mesh(thing):
    """The positions, in the world, and the faces of a mesh object."""
    mesh = thing.data
    local = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", local)
    matrix = np.array(thing.matrix_world)
    V = local.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return V, [list(face.vertices) for face in mesh.polygons]


def write_mesh(thing, V):
    """Puts positions, in the world, into a mesh object."""
    matrix = np.array(thing.matrix_world)
    local = np.linalg.solve(matrix[:3, :3], (V - matrix[:3, 3]).T).T
    thing.data.vertices.foreach_set("co", local.astype(np.float32).ravel())
    thing.data.update()


class OBJECT_OT_guided_projection(bpy.types.Operator):
    """Move the vertices of the active mesh so that all that is ticked holds"""
    bl_idname = "object.guided_projection"
    bl_label = "Guided Projection"
    bl_options = {"REGISTER", "UNDO"}

    planar: BoolProperty(name="Planar", description="Faces are planar", default=True)
    circular: BoolProperty(name="Circular", description="Faces are planar and have a circumcircle")
    conical: BoolProperty(name="Conical", description="Faces are planar and touch a cone around each vertex")
    equilibrium: BoolProperty(name="Equilibrium", description="Forces in the edges carry the load of the faces")
    compression: BoolProperty(name="Compression Only", description="In equilibrium, edges only push", default=True)
    load: FloatProperty(name="Load", description="Downwards, per area of the faces", default=1, min=0)
    boundary: EnumProperty(name="Boundary", default="CORNERS", items=[
        ("FREE", "Free", "Boundary vertices move"),
        ("CORNERS", "Corners Fixed", "The corners of the boundary stay"),
        ("GLIDES", "Glides", "Boundary vertices stay on the boundary's curve"),
        ("FIXED", "Fixed", "Boundary vertices stay")])
    fairness: FloatProperty(name="Fairness", description="Wish for fair mesh lines", default=0, min=0, soft_max=1)
    closeness: FloatProperty(name="Closeness", description="Wish for closeness to the mesh", default=0, min=0, soft_max=1)
    smooth: BoolProperty(name="Smooth", description="Of all changes that do it, take the smoothest", default=True)
    iterations: IntProperty(name="Iterations", description="At most", default=300, min=1, max=10000)

    @classmethod
    def poll(cls, context):
        return context.active_object is not None and context.active_object.type == "MESH"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        for name in "planar", "circular", "conical", "equilibrium":
            layout.prop(self, name)
        forces = layout.column()
        forces.enabled = self.equilibrium
        forces.prop(self, "compression")
        forces.prop(self, "load")
        for name in "boundary", "fairness", "closeness", "smooth", "iterations":
            layout.prop(self, name)

    def execute(self, context):
        thing, mode = context.active_object, context.active_object.mode
        if mode != "OBJECT":  # the mesh of an object in edit mode is an old one
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            return self.solve(thing)
        finally:
            if mode != "OBJECT":
                bpy.ops.object.mode_set(mode=mode)

    def solve(self, thing):
        try:
            import guidedproj
        except ImportError as problem:
            return self.refuse(f"guidedproj.py and guidedproj.h have to be beside the add-on, in {_here}: {problem}")
        if thing.data.shape_keys:
            return self.refuse("the mesh has shape keys, which would hide new positions: apply or remove them")
        if abs(thing.matrix_world.determinant()) < 1e-30:
            return self.refuse("the object is scaled to nothing in some direction")
        try:
            V, F = read_mesh(thing)
            form = guidedproj.Form(V, F)
            self.add_all(form, thing)
            result = form.solve(self.iterations, smooth=self.smooth)
        except (guidedproj.Error, ValueError) as error:
            return self.refuse(str(error))
        write_mesh(thing, form.V)
        sound = result.outcome == guidedproj.Outcome.CONVERGED and result.spoiled.total == 0
        self.report({"INFO" if sound else "WARNING"}, result.message)
        return {"FINISHED"}

    def add_all(self, form, thing):
        """Adds what is ticked to the form."""
        fixed, supports = group_members(thing, "fixed"), group_members(thing, "supports")
        if self.planar or self.circular or self.conical:
            form.add_planarity()
        if self.circular:
            form.add_circularity()
        if self.conical:
            form.add_conicality()
        if fixed:
            form.add_fixed(fixed)
        if self.boundary == "CORNERS":
            form.add_fixed_corners()
        if self.boundary == "GLIDES":
            form.add_gliding_boundary()
        if self.boundary == "FIXED":
            form.add_fixed_boundary()
        if self.equilibrium:
            if not supports:
                held = {"FREE": lambda v: False, "CORNERS": form.is_corner}.get(self.boundary, form.mesh.is_boundary_vertex)
                supports = sorted({*fixed, *(v for v in range(form.mesh.vertex_count) if held(v))})
            if not supports:
                nothing = "the mesh has no boundary" if form.mesh.loop_count == 0 else \
                    "the boundary is free" if self.boundary == "FREE" else "the boundary has no corners"
                raise ValueError(f"equilibrium needs supports, and {nothing}: fix the boundary or let it glide, or put "
                                 "vertices into a vertex group 'fixed' or 'supports'")
            form.add_equilibrium(area_load=self.load, supports=supports)
            if self.compression:
                form.add_compression()
        if self.fairness > 0:
            form.add_fairness(self.fairness)
        if self.closeness > 0:
            form.add_closeness(self.closeness)

    def refuse(self, sentence):
        self.report({"ERROR"}, sentence)
        return {"CANCELLED"}


def menu(self, context):
    self.layout.operator(OBJECT_OT_guided_projection.bl_idname)


def register():
    bpy.utils.register_class(OBJECT_OT_guided_projection)
    bpy.types.VIEW3D_MT_object.append(menu)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(menu)
    bpy.utils.unregister_class(OBJECT_OT_guided_projection)


if __name__ == "__main__":
    register()
