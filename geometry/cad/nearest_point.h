#pragma once

#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>

namespace delquad::cad {

/// The point of a surface near S(u, v), a first guess, whose distance to x is smallest, by damped Newton
/// steps. Stops when a step moves it by less than `tolerance`, a length.
gp_Pnt nearest_point(const Geom_Surface& surface, const gp_Pnt& x, double u, double v, double tolerance);

/// The same on the stretch [first, last] of a curve.
gp_Pnt nearest_point(const Geom_Curve& curve, double first, double last, const gp_Pnt& x, double t,
                     double tolerance);

}  // namespace delquad::cad
