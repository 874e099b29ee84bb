# SPDX-License-Identifier: GPL-3.0-or-later
"""In Blender: the add-on keeps materials, shading and sharp edges, and says what is wrong."""
import math
import os
import sys

import bpy

sys.path.insert(0, os.environ["INTEGRATIONS"])
import blender_delquad  # noqa: E402


def areas(mesh):
    found = {}
    for face in mesh.polygons:
        kind = (face.material_index, face.use_smooth)
        found[kind] = found.get(kind, 0) + face.area
    return found


def check_torus():
    """Two materials, smooth and flat halves."""
    bpy.ops.mesh.primitive_torus_add(major_radius=1, minor_radius=0.4)
    mesh = bpy.context.object.data
    for name in ("red", "blue"):
        mesh.materials.append(bpy.data.materials.new(name))
    for face in mesh.polygons:
        face.material_index, face.use_smooth = int(face.center.x > 0), face.center.y > 0
    before = areas(mesh)
    bpy.context.object.vertex_groups.new(name="arm")
    assert blender_delquad.losses(bpy.context.object) == ["UV map UVMap", "the weights of vertex group arm"]
    assert bpy.ops.object.delquad(quads=1000) == {"FINISHED"}
    assert not mesh.validate() and all(len(face.vertices) == 4 for face in mesh.polygons) and abs(len(mesh.polygons) - 1000) < 100
    assert [material.name for material in mesh.materials] == ["red", "blue"]
    assert all(face.material_index == (face.center.x > 0) and face.use_smooth == (face.center.y > 0) for face in mesh.polygons)
    assert not mesh.uv_layers
    after = areas(mesh)
    assert all(abs(after[kind] / before[kind] - 1) < 0.05 for kind in before)
    assert len(mesh.edges) == 2 * len(mesh.polygons) == 2 * len(mesh.vertices)


def check_sharp_edges():
    """The equator of a sphere."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
    mesh = bpy.context.object.data
    for edge in mesh.edges:
        edge.use_edge_sharp = all(abs(mesh.vertices[v].co.z) < 1e-6 for v in edge.vertices)
    assert bpy.ops.object.delquad(by="SIZE", size=0.2, quality="fast") == {"FINISHED"}
    ends = [[mesh.vertices[v].co for v in edge.vertices] for edge in mesh.edges if edge.use_edge_sharp]
    assert abs(sum((b - a).length for a, b in ends) / (2 * math.pi) - 1) < 0.02


def check_messages():
    mesh = bpy.context.object.data
    faces = len(mesh.polygons)
    for expected, size, path in (("max-elements", 1e-5, os.environ["PATH"]), ("no program 'delquad'", 1, "/nowhere")):
        os.environ["PATH"] = path
        try:
            bpy.ops.object.delquad(by="SIZE", size=size)
        except RuntimeError as error:
            assert expected in str(error), error
        else:
            raise AssertionError(expected)
    assert len(mesh.polygons) == faces


blender_delquad.register()
check_torus()
check_sharp_edges()
check_messages()
blender_delquad.unregister()
print("\ngood")
