# SPDX-License-Identifier: GPL-3.0-or-later
"""In freecadcmd: groups of faces, and the stress beside a small hole in a plate that is pulled, by CalculiX."""
import os
import sys
import tempfile
from importlib.machinery import SourceFileLoader

import FreeCAD
import ObjectsFem
import Part
from femtools.ccxtools import FemToolsCcx

macro = SourceFileLoader("delquad_macro", os.path.join(os.environ["INTEGRATIONS"], "freecad_delquad.FCMacro")).load_module()
PULL, WIDTH, LENGTH, RADIUS, THICKNESS = 1000.0, 100.0, 200.0, 5.0, 1.0  # N, mm
# Peterson's Stress Concentration Factors, 4th ed., chart 4.1: by the stress far away, of a hole in a strip
RATIO = 1 - 2 * RADIUS / WIDTH
FACTOR = 0.284 + 2 / RATIO - 0.600 * RATIO + 1.32 * RATIO**2


def check_groups(document):
    box = document.addObject("Part::Feature", "Box")
    box.Shape = Part.makeBox(10, 20, 30).cut(Part.makeCylinder(3, 40, FreeCAD.Vector(5, 10, -1)))
    box.Placement.Base = FreeCAD.Vector(1, 2, 3)
    mesh = macro.make_mesh(box, 3).FemMesh
    assert mesh.QuadrangleCount == mesh.FaceCount > 200
    assert {len(mesh.getElementNodes(face)) for face in mesh.Faces} == {8}
    groups = {mesh.getGroupName(group): set(mesh.getGroupElements(group)) for group in mesh.Groups}
    assert groups == {f"Face{k + 1}": set(mesh.getFacesByFace(face)) for k, face in enumerate(box.Shape.Faces)}


def edge_at(plate, axis, value):
    """The name of the edge whose middle has this coordinate."""
    return next(f"Edge{k + 1}" for k, edge in enumerate(plate.Shape.Edges) if abs(edge.CenterOfMass[axis] - value) < 1e-9)


def check_stress(document):
    plate = document.addObject("Part::Feature", "Plate")
    plate.Shape = Part.makePlane(LENGTH, WIDTH).cut(Part.makeCylinder(RADIUS, 2, FreeCAD.Vector(LENGTH / 2, WIDTH / 2, -1)))
    mesh = macro.make_mesh(plate, 5, "--curvature", "48")
    analysis = ObjectsFem.makeAnalysis(document)
    solver = ObjectsFem.makeSolverCalculixCcxTools(document)
    material = ObjectsFem.makeMaterialSolid(document)
    material.Material = {**material.Material, "Name": "Steel", "YoungsModulus": "210000 MPa", "PoissonRatio": "0.3"}
    fixed, force = ObjectsFem.makeConstraintFixed(document), ObjectsFem.makeConstraintForce(document)
    fixed.References = [(plate, edge_at(plate, 0, 0))]
    force.References, force.Direction, force.Force = [(plate, edge_at(plate, 0, LENGTH))], (plate, [edge_at(plate, 1, 0)]), PULL
    for member in (mesh, solver, material, fixed, force, ObjectsFem.makeElementGeometry2D(document, THICKNESS)):
        analysis.addObject(member)
    document.recompute()
    tools = FemToolsCcx(analysis, solver)
    tools.update_objects()
    tools.setup_working_dir(tempfile.mkdtemp(dir=os.environ["HOME"]))
    tools.setup_ccx()
    assert not tools.check_prerequisites()
    tools.write_inp_file()
    assert tools.ccx_run() == 0
    tools.load_results()
    result = next(one for one in document.Objects if one.isDerivedFrom("Fem::FemResultObject"))
    factor = max(result.PrincipalMax) / (PULL / WIDTH / THICKNESS)
    print(f"stress concentration {factor:.3f}, expected {FACTOR:.3f}")
    assert abs(factor / FACTOR - 1) < 0.03


def check_messages(document):
    macro.PROGRAM = "no-such-program"
    try:
        macro.make_mesh(document.Objects[0], 1)
    except RuntimeError as error:
        assert "no program 'no-such-program'" in str(error)
        return
    raise AssertionError("a program that is not there was called")


try:
    opened = FreeCAD.newDocument("Test")
    check_groups(opened)
    check_stress(opened)
    check_messages(opened)
    print("\ngood")
except Exception:
    import traceback

    traceback.print_exc(file=sys.stdout)
