// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <TopoDS_Shape.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <string>

#include "geometry/cad/cad_shape.h"

// This header has the shapes of the example models. The example models use it.

namespace delquad::cad {

/// Returns a cylinder from the center of its first end along a direction; lengths in millimeters.
TopoDS_Shape cylinder(const gp_Pnt& from, const gp_Dir& along, double radius, double length);

/// Return the example models, in millimeters, with the names of their faces.
CadShape make_bracket();
CadShape make_hood();
CadShape make_pipe_tee();
CadShape make_sphere();
CadShape make_torus();
CadShape make_wing_body();
CadShape make_blended_tee();
CadShape make_cone_tip();
CadShape make_cross_drilled();
CadShape make_elbow();
CadShape make_fins();
CadShape make_free_form();
CadShape make_loft();
CadShape make_sheet();
CadShape make_thin_box();
CadShape make_variable_fillet();

/// Returns an example by its name. Throws std::logic_error for an unknown name.
CadShape make_example(const std::string& name);

}  // namespace delquad::cad
