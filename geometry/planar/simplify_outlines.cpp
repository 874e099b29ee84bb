// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/simplify_outlines.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyline_simplification_2/simplify.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "base/segment.h"
#include "geometry/planar/model_chain.h"
#include "geometry/planar/snap_outlines.h"

namespace delquad {
namespace {

namespace simplification = CGAL::Polyline_simplification_2;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Structure = CGAL::Triangulation_data_structure_2<simplification::Vertex_base_2<Kernel>,
                                                       CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>>;

/// Number of chords for a curve that is no polyline and stays.
constexpr int kChordsThatStay = 256;

/// The least tolerance of the curves at each point.
using Tolerances = std::map<Point, double>;

/// Squared distance of removed points from their chord, the largest, over their tolerances.
struct RelativeDistance {
  const Tolerances& tolerances;
  boost::optional<double> operator()(const Triangulation&,
                                     Triangulation::Vertices_in_constraint_iterator at) const {
    const Triangulation::Points_in_constraint_iterator from(boost::prior(at)), to(boost::next(at));
    const Kernel::Segment_2 chord(*from, *to);
    double most = 0;
    for (auto p = boost::next(from); p != to; ++p) {
      const auto allowed = tolerances.find(*p);
      if (allowed == tolerances.end()) return boost::none;  // outlines that cross
      most = std::max(most, CGAL::squared_distance(chord, *p) / (allowed->second * allowed->second));
    }
    return most;
  }
};

class OutlineSimplifier {
 public:
  OutlineSimplifier(PlanarModel& model, const OutlineTolerance& tolerance, bool all,
                    std::vector<Warning>& warnings)
      : model_(model), tolerance_(tolerance), warnings_(warnings) {
    for (std::size_t c = 0; c < model.curves.size(); ++c) {
      const ModelCurve& curve = model.curves[c];
      if (curve.is_gone) continue;
      auto points = all || curve.is_data ? polyline_of(*curve.shape) : std::nullopt;
      points ? add(static_cast<int>(c), *points) : add_that_stays(*curve.shape);
    }
  }

  void run() {
    simplification::simplify(triangulation_, RelativeDistance{tolerances_},
                             simplification::Stop_above_cost_threshold(1), true);
    for (const Outline& outline : outlines_) take(outline);
  }

 private:
  struct Outline {
    int curve;
    std::vector<Vec2> points;
    Triangulation::Constraint_id constraint;
  };

  void add(int curve, const std::vector<Vec2>& points) {
    std::vector<Point> corners;
    for (const Vec2 p : points) {
      corners.emplace_back(p.x, p.y);
      const double allowed = tolerance_(curve, {p.x, p.y, 0});
      double& least = tolerances_.try_emplace(corners.back(), allowed).first->second;
      least = std::min(least, allowed);
    }
    const auto constraint = triangulation_.insert_constraint(corners.begin(), corners.end());
    if (constraint != Triangulation::Constraint_id()) outlines_.push_back({curve, points, constraint});
  }

  void add_that_stays(const Curve& curve) {
    std::vector<Point> points;
    for (int k = 0; k <= kChordsThatStay; ++k) {
      const Vec2 p = curve.point(double(k) / kChordsThatStay);
      points.emplace_back(p.x, p.y);
    }
    const auto constraint = triangulation_.insert_constraint(points.begin(), points.end());
    if (constraint == Triangulation::Constraint_id()) return;  // all points are one
    for (auto v = triangulation_.vertices_in_constraint_begin(constraint);
         v != triangulation_.vertices_in_constraint_end(constraint); ++v)
      (*v)->set_removable(false);
  }

  void take(const Outline& outline) {
    std::vector<Vec2> points;
    for (auto v = triangulation_.vertices_in_constraint_begin(outline.constraint);
         v != triangulation_.vertices_in_constraint_end(outline.constraint); ++v)
      points.push_back({(*v)->point().x(), (*v)->point().y()});
    if (points.size() >= outline.points.size()) return;
    double farthest = 0;
    std::size_t next = 1;
    for (const Vec2 x : outline.points) {
      farthest = std::max(farthest, distance_to_segment(x, points[next - 1], points[next]));
      if (x == points[next] && next + 1 < points.size()) ++next;
    }
    ModelCurve& curve = model_.curves[outline.curve];
    curve.shape = make_polyline(points);
    warnings_.emplace_back(
        "outlines with fewer points", farthest,
        fmt::format("{}: {} of {} points stay, and the others lie up to {:.3g} from the lines between them",
                    curve_label(model_, outline.curve), points.size(), outline.points.size(), farthest));
  }

  PlanarModel& model_;
  const OutlineTolerance& tolerance_;
  Tolerances tolerances_;
  std::vector<Warning>& warnings_;
  Triangulation triangulation_;
  std::vector<Outline> outlines_;
};

}  // namespace

PlanarModel simplify_outlines(PlanarModel model, const OutlineTolerance& tolerance, bool all,
                              std::vector<Warning>& warnings) {
  if (all || std::ranges::any_of(model.curves, &ModelCurve::is_data))
    OutlineSimplifier(model, tolerance, all, warnings).run();
  for (ModelCurve& curve : model.curves) curve.is_data = false;
  return model;
}

}  // namespace delquad
