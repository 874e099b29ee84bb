#include "metrics/judgement/poor_quads.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "base/box.h"
#include "base/option_table.h"
#include "base/segment.h"
#include "base/text.h"
#include "features/layers/planar_layers.h"
#include "metrics/judgement/soundness.h"
#include "features/symmetry/mirrored_surface.h"
#include "metrics/shape.h"

namespace delquad {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSharpAngle = kBadEta * std::numbers::pi / 2;
/// A corner explains a quad that is as good as it allows, up to the bend of its curves along one edge.
constexpr double kPartOfBound = 0.9;
/// Edges on curves, and places between curves, below this part of the size leave no room for good quads.
constexpr double kFine = 0.25;
constexpr double kAny = std::numeric_limits<double>::infinity();

const OptionTable<LimitOptions>& limit_table() {
  static const auto all =
      OptionTable<LimitOptions>("limits", "beyond which an element is an error")
          .add({.name = "min_angle", .help = "degrees", .least = 0, .most = 90}, &LimitOptions::min_angle)
          .add({.name = "max_aspect", .help = "longest over shortest side", .least = 1, .absent = "any"},
               &LimitOptions::max_aspect);
  return all;
}

/// The edges of a mesh on curves of its model.
class CurveEdges {
 public:
  CurveEdges(const PreparedProblem& prepared, const Mesh& mesh) : shortest_(mesh.points.size(), kAny) {
    std::vector<char> is_cut(mesh.curves.size(), 0);
    if (prepared.surface)
      for (const SurfaceCut& cut : prepared.surface->all_cuts()) is_cut[cut.curve] = 1;
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      if (is_cut[mesh.line_curve[l]]) continue;
      const auto [a, b] = mesh.lines[l];
      edges_.push_back({std::min(a, b), std::max(a, b), mesh.line_curve[l]});
      const double length = norm(mesh.points[b] - mesh.points[a]);
      for (const int v : {a, b}) shortest_[v] = std::min(shortest_[v], length);
    }
    std::ranges::sort(edges_);
  }
  /// That of the edge from a to b; -1: it is on none.
  int curve(int a, int b) const {
    const std::array<int, 3> first{std::min(a, b), std::max(a, b), -1};
    const auto at = std::ranges::lower_bound(edges_, first);
    return at != edges_.end() && (*at)[0] == first[0] && (*at)[1] == first[1] ? (*at)[2] : -1;
  }
  /// Of the edges at a node; infinite: none.
  double shortest(int v) const { return shortest_[v]; }
  bool has(int v) const { return shortest_[v] < kAny; }

 private:
  std::vector<std::array<int, 3>> edges_;
  std::vector<double> shortest_;
};

enum Cause { kAtCorner, kAtFineCurve, kAtGap, kAtSharpEdge, kOtherwise, kCauses };

/// A poor quad, and why it is.
struct PoorQuad {
  int quad;
  double eta, aspect, edge;  ///< `edge`: the shortest in sizes
  Cause cause = kOtherwise;
  double what = 0;              ///< radians of the corner, or a length
  std::array<int, 2> curves{};  ///< at a corner: their tags
  /// How many times beyond its limit.
  double badness() const {
    return std::max({kBadEta / std::max(eta, 1e-300), aspect / kPoorAspect, kPoorEdge / edge});
  }
};

/// Of all quads those that are poor.
class PoorQuads {
 public:
  PoorQuads(const PreparedProblem& prepared, const Mesh& mesh, const ElementSides& sides,
            const std::vector<char>& on_purpose)
      : prepared_(prepared), mesh_(mesh), edges_(prepared, mesh) {
    int hint = -1;
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      const auto corners = corners_of(mesh, mesh.quads[q]);
      const ElementShape<4> shape = quad_shape(mesh, static_cast<int>(q), sides);
      PoorQuad quad{static_cast<int>(q), eta_of(shape.angle), 1, kAny};
      double shortest = kAny;
      if (!on_purpose[q]) {
        for (int k = 0; k < 4; ++k) shortest = std::min(shortest, norm(corners[(k + 1) % 4] - corners[k]));
        quad.aspect = quad_aspect(corners);
        quad.edge = shortest /
                    prepared.size.field->at(0.25 * (corners[0] + corners[1] + corners[2] + corners[3]), hint);
      }
      if (quad.badness() <= 1) continue;
      explain(shape, shortest / quad.edge, quad);
      quads.push_back(quad);
    }
    std::ranges::stable_sort(quads, std::greater<>(), &PoorQuad::badness);
  }

  std::vector<PoorQuad> quads;  ///< the worst first

 private:
  /// `size`: there; not a number where it is on purpose what it is.
  void explain(const ElementShape<4>& shape, double size, PoorQuad& quad) const {
    const auto& v = mesh_.quads[quad.quad];
    const auto found = [&](Cause cause, double what) {
      quad.cause = cause;
      quad.what = what;
    };
    const auto in_corner = [&](double angle, double bound, std::array<int, 2> curves) {
      if (quad.eta < kPartOfBound * bound) return false;
      quad.curves = curves;
      found(kAtCorner, angle);
      return true;
    };
    for (int k = 0; k < 4; ++k) {
      const int before = edges_.curve(v[(k + 3) % 4], v[k]), after = edges_.curve(v[k], v[(k + 1) % 4]);
      if (before >= 0 && after >= 0 && shape.angle[k] < kSharpAngle &&
          in_corner(shape.angle[k], shape.angle[k] / (std::numbers::pi / 2),
                    {mesh_.curves[before].tag, mesh_.curves[after].tag}))
        return;
      for (const SharpCorner& c : sharp_corners_)
        if (is_at(c, mesh_.points[v[k]]) && in_corner(c.angle, c.eta_bound,
                                                      {prepared_.boundary.curves[c.curves[0]].tag,
                                                       prepared_.boundary.curves[c.curves[1]].tag}))
          return;
    }
    const int finest = *std::ranges::min_element(v, {}, [&](int i) { return edges_.shortest(i); });
    const double fine = edges_.shortest(finest), narrow = width_between_curves(v);
    if (narrow < kFine * size && narrow < fine / 2) return found(kAtGap, narrow);
    if (fine < kFine * size) return found(kAtFineCurve, fine);
    if (is_triangulated(prepared_) && edges_.has(finest)) found(kAtSharpEdge, 0);
  }

 public:
  static bool is_triangulated(const PreparedProblem& prepared) {
    return prepared.surface && !prepared.surface->given && !prepared.surface->model.projector;
  }

 private:
  /// Or an image of it.
  bool is_at(const SharpCorner& corner, const Vec3& x) const {
    constexpr double kSamePlace = 1e-9;  // of the coordinates
    const auto& mirrored = prepared_.surface->mirrored;
    const Vec3 at = prepared_.boundary.points[corner.node], here = mirrored ? mirrored->planes.fold(x) : x;
    return norm(here - at) <= kSamePlace * norm(at);
  }
  /// From corners on curves to others, and to sides on curves, that do not follow along a curve.
  double width_between_curves(const std::array<int, 4>& v) const {
    double width = kAny;
    for (int k = 0; k < 4; ++k) {
      const int a = v[k], b = v[(k + 1) % 4], c = v[(k + 2) % 4], d = v[(k + 3) % 4];
      const Vec3& x = mesh_.points[a];
      if (!edges_.has(a)) continue;
      const bool meets_b = edges_.curve(a, b) >= 0, meets_d = edges_.curve(d, a) >= 0;
      if (!meets_b && edges_.has(b)) width = std::min(width, norm(mesh_.points[b] - x));
      if (!meets_b && edges_.curve(b, c) >= 0) width = std::min(width, distance_to_side(x, b, c));
      if (!meets_d && edges_.curve(c, d) >= 0) width = std::min(width, distance_to_side(x, c, d));
    }
    return width;
  }
  double distance_to_side(const Vec3& x, int a, int b) const {
    const Vec3 &from = mesh_.points[a], &to = mesh_.points[b];
    return norm(x - from - nearest_part(x, from, to) * (to - from));
  }

  const PreparedProblem& prepared_;
  const Mesh& mesh_;
  CurveEdges edges_;
  std::vector<SharpCorner> sharp_corners_ = prepared_.sharp_corners();
};

bool is_given(const PreparedProblem& prepared) {
  return std::ranges::any_of(prepared.patches,
                             [](const PreparedPatch& patch) { return !patch.given.points.empty(); });
}

/// What helps against a cause, of which `first` is the worst; empty: nothing that is known.
std::string advice(const PreparedProblem& prepared, const PoorQuad& first, double most) {
  if (is_given(prepared) || first.cause == kAtCorner || first.cause == kOtherwise) return "";
  if (PoorQuads::is_triangulated(prepared))
    return ": a smaller size there would help, and perhaps --feature-angle 180 where such edges are noise";
  if (prepared.surface) return fmt::format(": --ignore-below {:.3g} may help", most);
  return fmt::format(": {}a size of {:.3g} there would help",
                     first.cause == kAtGap ? "" : "fewer points, or ", first.what);
}

std::string text_of(const PreparedProblem& prepared, const Mesh& mesh, const std::vector<PoorQuad>& quads,
                    Cause cause) {
  const PoorQuad* first = nullptr;
  double most = 0;
  int n = 0;
  for (const PoorQuad& quad : quads) {
    if (quad.cause != cause) continue;
    if (++n == 1 || (cause == kAtCorner && quad.what < first->what)) first = &quad;
    most = std::max(most, quad.what);
  }
  if (n == 0) return "";
  const std::string at = show_place(mesh, middle_of_quad(mesh, first->quad));
  std::string why;
  switch (cause) {
    case kAtCorner:
      why = fmt::format(
          "in sharp corners of the model, the sharpest of {:.3g} degrees between curves {} and {} in {}",
          first->what / kDegree, first->curves[0], first->curves[1], at);
      break;
    case kAtFineCurve:
      why =
          fmt::format("where curves are finer than the size, with an edge of {:.3g} in {}", first->what, at);
      break;
    case kAtGap:
      why = fmt::format("in places narrower than the size, {:.3g} in {}", first->what, at);
      break;
    case kAtSharpEdge:
      why = fmt::format("at sharp edges of the triangulation, as in {}", at);
      break;
    default:
      return fmt::format("; {} for other reasons, as in {}", n, at);
  }
  // Sizes and lengths that leave none of them.
  constexpr double kAbove = 1.05;
  return fmt::format("; {} {}{}", n, why, advice(prepared, *first, kAbove * most));
}

void warn_of_poor_quads(const PreparedProblem& prepared, const std::string& label,
                        const std::vector<PoorQuad>& quads, const Mesh& mesh,
                        std::vector<Warning>& warnings) {
  if (quads.empty()) return;
  std::string what;
  const auto count = [&](const char* kind, auto&& is_so) {
    if (const auto n = std::ranges::count_if(quads, is_so); n > 0)
      what += fmt::format("{}{} with {}", what.empty() ? "" : ", ", n, kind);
  };
  count("an angle below 10 or above 170 degrees", [](const PoorQuad& q) { return q.eta < kBadEta; });
  count("an aspect above 20", [](const PoorQuad& q) { return q.aspect > kPoorAspect; });
  count("a side below a tenth of the size", [](const PoorQuad& q) { return q.edge < kPoorEdge; });
  const PoorQuad& worst = quads[0];
  std::string text =
      fmt::format("{}: {} of {} quads {} poor ({}), the worst in {} (eta {:.2g}, aspect {:.3g})", label,
                  quads.size(), mesh.quads.size(), quads.size() == 1 ? "is" : "are", what,
                  show_place(mesh, middle_of_quad(mesh, worst.quad)), worst.eta,
                  quad_aspect(corners_of(mesh, mesh.quads[worst.quad])));
  for (int cause = 0; cause < kCauses; ++cause)
    text += text_of(prepared, mesh, quads, static_cast<Cause>(cause));
  warnings.emplace_back(std::move(text));
}

/// Quads that are sound, but not once they were rounded.
void warn_of_single_precision(const std::string& label, const Mesh& mesh, const ElementSides& sides,
                              std::vector<Warning>& warnings) {
  Places spoilt;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto corners = corners_of(mesh, mesh.quads[q]);
    double shortest = kAny;
    for (int k = 0; k < 4; ++k) shortest = std::min(shortest, norm(corners[(k + 1) % 4] - corners[k]));
    if (shortest < kSingleHolds * single_rounding(corners) &&
        !(single_jacobian(corners, sides.of_quad(static_cast<int>(q))) > kLeastJacobian))
      spoilt.add(middle_of_quad(mesh, static_cast<int>(q)));
  }
  if (spoilt.count == 0) return;
  const auto box = Box<Vec3>::around(mesh.points);
  const Vec3 centre = 0.5 * (box.low + box.high);
  const bool is_far = norm(centre) > norm(box.size());
  const std::string help = is_far ? fmt::format("move the model's origin near to {}", show_point(centre))
                                  : "read the mesh in double precision";
  warnings.emplace_back(
      fmt::format("{}: rounded to single precision, as many programs read coordinates, {}; {}", label,
                  describe(mesh, spoilt, "1 quad is inverted or flat", "quads are inverted or flat"), help));
}

void hold_to_limits(const LimitOptions& limits, const Mesh& mesh, const ElementSides& sides,
                    const std::vector<char>& on_purpose, Soundness& soundness) {
  if (limits.min_angle == 0 && limits.max_aspect == 0) return;
  constexpr double kRounding = 1e-9;  // relative: of coordinates (1e-16) a million times a side
  Places narrow, long_ones;
  double least = limits.min_angle * kDegree, most = limits.max_aspect;
  const auto add = [&](double angle, double aspect, const Place& at) {
    if (angle < (1 - kRounding) * limits.min_angle * kDegree) narrow.add(at), least = std::min(least, angle);
    if (limits.max_aspect > 0 && aspect > (1 + kRounding) * limits.max_aspect)
      long_ones.add(at), most = std::max(most, aspect);
  };
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const int i = static_cast<int>(q);
    add(std::ranges::min(quad_shape(mesh, i, sides).angle),
        on_purpose[q] ? 1 : quad_aspect(corners_of(mesh, mesh.quads[q])), middle_of_quad(mesh, i));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[t]);
    const auto [low, high] = std::minmax({norm(b - a), norm(c - b), norm(a - c)});
    add(std::ranges::min(triangle_shape(mesh, static_cast<int>(t), sides).angle), high / low,
        {(1.0 / 3) * (a + b + c), mesh.triangle_region[t]});
  }
  const auto tell = [&](const Places& places, const std::string& what) {
    if (places.count > 0)
      soundness.beyond.push_back(describe(mesh, places, "1 element has " + what, "elements have " + what));
  };
  tell(narrow,
       fmt::format("an angle below {:.6g} degrees, the least {:.3g}", limits.min_angle, least / kDegree));
  tell(long_ones, fmt::format("an aspect above {:.6g}, the largest {:.4g}", limits.max_aspect, most));
}

/// By quad: those whose sides and aspects were asked for.
std::vector<char> quads_on_purpose(const PreparedProblem& prepared, const Mesh& mesh) {
  std::vector<char> is_grid(mesh.regions.size(), 0);
  for (const PreparedPatch& patch : prepared.patches)
    if (patch.grid && patch.grid_stays) is_grid[patch.region] = 1;
  std::vector<char> on_purpose = quads_in_layers(prepared, mesh);
  for (std::size_t q = 0; q < on_purpose.size(); ++q)
    if (is_grid[mesh.quad_region[q]]) on_purpose[q] = 1;
  return on_purpose;
}

}  // namespace

OptionGroup limit_group() { return limit_table().group(); }

BadQuads judge_quads(const PreparedProblem& prepared, const std::string& label, const Mesh& mesh,
                     const MeshMetrics& metrics, std::vector<Warning>& warnings, Soundness& soundness) {
  const auto& values = metrics.values;
  const std::vector<char> on_purpose = quads_on_purpose(prepared, mesh);
  const ElementSides sides = prepared.surface ? ElementSides(mesh) : ElementSides(mesh, {0, 0, 1});
  BadQuads bad;
  // Most meshes have none.
  if (values.at("eta_worst") < kBadEta || values.at("aspect_max") > kPoorAspect ||
      values.at("edge_min") < kPoorEdge) {
    const std::vector<PoorQuad> quads = PoorQuads(prepared, mesh, sides, on_purpose).quads;
    for (const PoorQuad& quad : quads)
      if (quad.eta < kBadEta) ++(quad.cause == kAtCorner ? bad.in_corners : bad.elsewhere);
    warn_of_poor_quads(prepared, label, quads, mesh, warnings);
  }
  warn_of_single_precision(label, mesh, sides, warnings);
  hold_to_limits(limit_table().read(prepared.settings.options), mesh, sides, on_purpose, soundness);
  return bad;
}

}  // namespace delquad
