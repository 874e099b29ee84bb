# SPDX-License-Identifier: GPL-3.0-or-later
"""QuadriFlow in Blender: blender --background --python quadriflow.py -- INPUT.obj OUTPUT.obj SIZE SEED"""
import sys

import bpy

source, output, size, seed = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
bpy.ops.wm.obj_import(filepath=source, forward_axis="Y", up_axis="Z")
parts = list(bpy.context.selected_objects)
bpy.context.view_layer.objects.active = parts[0]
if len(parts) > 1:
    bpy.ops.object.join()
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.mesh.select_all(action="SELECT")
bpy.ops.mesh.delete_loose(use_faces=False)
bpy.ops.object.mode_set(mode="OBJECT")
area = sum(p.area for p in bpy.context.object.data.polygons)
done = bpy.ops.object.quadriflow_remesh(mode="FACES", target_faces=max(1, round(area / float(size) ** 2)), seed=int(seed), use_preserve_sharp=True, use_preserve_boundary=True)
if "FINISHED" not in done:
    sys.exit("Error: QuadriFlow did not finish")
mesh = bpy.context.object.data
with open(output, "w") as out:
    out.writelines("v %.9g %.9g %.9g\n" % tuple(v.co) for v in mesh.vertices)
    out.writelines("f " + " ".join(str(v + 1) for v in p.vertices) + "\n" for p in mesh.polygons)
