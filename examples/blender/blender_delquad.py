# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender: Object > Quad remesh (Delquad) makes the active mesh one of quads.

Install this file by Edit > Preferences > Add-ons > Install. It calls the program `delquad`, whose path stands in its preferences.
Materials stay with their faces, and so does smooth shading; edges that are marked sharp stay edges. Data of the old vertices and
corners are lost with a message: UV maps, colors, weights of vertex groups.
"""

bl_info = {
    "name": "Delquad quad remesher",
    "blender": (3, 0, 0),
    "category": "Object",
    "location": "Object > Quad remesh (Delquad)",
    "description": "Makes the active mesh one of quadrilaterals",
}

import math
import os
import shutil
import subprocess
import tempfile

import bpy


def write_obj(path, mesh):
    """Triangles in a group for each material and kind of shading, and sharp edges as lines."""
    mesh.calc_loop_triangles()
    with open(path, "w", encoding="utf-8") as file:
        for v in mesh.vertices:
            file.write("v {!r} {!r} {!r}\n".format(*v.co))
        groups = {}
        for t in mesh.loop_triangles:
            groups.setdefault((t.material_index, int(t.use_smooth)), []).append(t.vertices)
        for (material, smooth), triangles in sorted(groups.items()):
            file.write(f"g {material}/{smooth}\n")
            file.writelines("f {} {} {}\n".format(*(v + 1 for v in t)) for t in triangles)
        file.write("g sharp\n")
        file.writelines("l {} {}\n".format(*(v + 1 for v in e.vertices)) for e in mesh.edges if e.use_edge_sharp)


def read_obj(path):
    """Points, faces, the material and shading of each, and the sharp edges."""
    points, faces, kinds, sharp, group = [], [], [], set(), ""
    with open(path, encoding="utf-8") as file:
        for line in file:
            key, *words = line.split() or [""]
            if key == "v":
                points.append(tuple(map(float, words)))
            elif key == "g":
                group = words[0] if words else ""
            elif key == "f":
                faces.append([int(word) - 1 for word in words])
                kinds.append([int(word) for word in group.split("/")])
            elif key == "l" and group == "sharp":
                sharp.add(frozenset(int(word) - 1 for word in words))
    return points, faces, kinds, sharp


def remesh(program, mesh, *arguments):
    """Replaces the mesh's geometry; what the program has to say. Raises RuntimeError with one line."""
    with tempfile.TemporaryDirectory() as folder:
        given, made = (os.path.join(folder, name) for name in ("given.obj", "made.obj"))
        write_obj(given, mesh)
        result = subprocess.run([program, "mesh", given, "-o", made, *arguments], capture_output=True, text=True)
        said = (result.stderr.strip().splitlines() or [f"exit code {result.returncode}"])[-1]
        if result.returncode != 0:
            raise RuntimeError(said.removeprefix("error: ").replace(given, mesh.name))
        points, faces, kinds, sharp = read_obj(made)
    mesh.clear_geometry()
    mesh.from_pydata(points, [], faces)
    mesh.polygons.foreach_set("material_index", [material for material, _ in kinds])
    mesh.polygons.foreach_set("use_smooth", [bool(smooth) for _, smooth in kinds])
    for edge in mesh.edges:
        edge.use_edge_sharp = frozenset(edge.vertices) in sharp
    mesh.update()
    return result.stdout.strip().splitlines()[0].removeprefix(made).lstrip(": ")


def losses(item):
    """Returns the data of an object that are lost with its vertices and corners: "UV map UVMap"."""
    kinds = (("UV map", item.data.uv_layers), ("colours", item.data.vertex_colors), ("the weights of vertex group", item.vertex_groups))
    return [f"{kind} {one.name}" for kind, all_of_kind in kinds for one in all_of_kind]


class DelquadPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: bpy.props.StringProperty(name="Program", default="delquad", subtype="FILE_PATH")

    def draw(self, context):
        self.layout.prop(self, "program")


class OBJECT_OT_delquad(bpy.types.Operator):
    """Make the active mesh one of quads; UV maps, colors and weights are lost"""

    bl_idname = "object.delquad"
    bl_label = "Quad remesh (Delquad)"
    bl_options = {"REGISTER", "UNDO"}

    by: bpy.props.EnumProperty(name="By", items=[("QUADS", "Number of quads", ""), ("SIZE", "Size", "")])
    quads: bpy.props.IntProperty(name="Quads", default=5000, min=10, soft_max=200000)
    size: bpy.props.FloatProperty(name="Size", default=0.1, min=1e-6, unit="LENGTH", description="Length of edges, before the object's scale")
    quality: bpy.props.EnumProperty(name="Quality", default="good", items=[(q, q.capitalize(), "") for q in ("fast", "good", "best", "regular")])
    angle: bpy.props.FloatProperty(name="Feature angle", default=math.radians(60), min=math.radians(1), max=math.pi, subtype="ANGLE",
                                   description="Edges at which faces turn by more than this stay edges")

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and context.object is not None and context.object.type == "MESH"

    def execute(self, context):
        addon = context.preferences.addons.get(__name__)
        wanted = bpy.path.abspath(addon.preferences.program) if addon else "delquad"
        program, mesh = shutil.which(wanted), context.object.data
        lost = losses(context.object)
        problem = None
        if program is None:
            problem = f"There is no program '{wanted}': build Delquad, and set its path in the preferences of this add-on"
        elif mesh.shape_keys:
            problem = f"{mesh.name} has shape keys, which cannot be kept: apply or remove them first"
        else:
            amount = ["--quads", str(self.quads)] if self.by == "QUADS" else ["--size", repr(self.size)]
            try:
                said = remesh(program, mesh, *amount, "--quality", self.quality, "--feature-angle", repr(min(math.degrees(self.angle), 180.0)))
            except RuntimeError as error:
                problem = str(error)
        if problem:
            self.report({"ERROR"}, problem)
            return {"CANCELLED"}
        self.report({"INFO"}, said)
        if lost:
            self.report({"WARNING"}, f"{mesh.name} has lost {', '.join(lost)}")
        return {"FINISHED"}


def menu(self, context):
    self.layout.operator(OBJECT_OT_delquad.bl_idname)


def register():
    bpy.utils.register_class(DelquadPreferences)
    bpy.utils.register_class(OBJECT_OT_delquad)
    bpy.types.VIEW3D_MT_object.append(menu)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(menu)
    bpy.utils.unregister_class(OBJECT_OT_delquad)
    bpy.utils.unregister_class(DelquadPreferences)


if __name__ == "__main__":
    register()
