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
#include "base/box_tree.h"
#include "base/option_table.h"
#include "base/segment.h"
#include "base/text.h"
#include "features/layers/planar_layers.h"
#include "features/symmetry/mirrored_surface.h"
#include "metrics/judgement/soundness.h"
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

/// The edges of a mesh on curves of its model, with the faces that they bound or lie in.
class CurveEdges {
 public:
  CurveEdges(const PreparedProblem& prepared, const Mesh& mesh)
      : mesh_(mesh), shortest_(mesh.points.size(), kAny), shortest_curve_(shortest_) {
    std::vector<double> curve_length(mesh.curves.size());
    std::vector<char> is_cut(mesh.curves.size(), 0);
    if (prepared.surface)
      for (const SurfaceCut& cut : prepared.surface->all_cuts()) is_cut[cut.curve] = 1;
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      if (is_cut[mesh.line_curve[l]]) continue;
      const auto [a, b] = mesh.lines[l];
      edges_.push_back({std::min(a, b), std::max(a, b), mesh.line_curve[l]});
      // As it was before nodes moved along the curves, which is no matter of the model.
      const Mesh& first = prepared.boundary;
      const bool is_there = l < first.lines.size() && first.lines[l] == mesh.lines[l];
      const auto& points = is_there ? first.points : mesh.points;
      const double length = norm(points[b] - points[a]);
      curve_length[mesh.line_curve[l]] += length;
      for (const int v : {a, b}) shortest_[v] = std::min(shortest_[v], length);
    }
    for (const auto& [a, b, c] : edges_)
      for (const int v : {a, b}) shortest_curve_[v] = std::min(shortest_curve_[v], curve_length[c]);
    std::ranges::sort(edges_);
    std::vector<Face> faces(mesh.regions.size());
    std::vector<Box<Vec3>> boxes;
    const auto add = [&](const auto& element, int region) {
      faces[region].area += norm(area_vector(corners_of(mesh, element))) / 2;
      for (std::size_t k = 0; k < element.size(); ++k) {
        const int a = element[k], b = element[(k + 1) % element.size()];
        if (curve(a, b) < 0) continue;
        faces[region].outline += norm(mesh.points[b] - mesh.points[a]);
        sides_.push_back({a, b, region});
        boxes.push_back(Box<Vec3>::around({mesh.points[a], mesh.points[b]}));
      }
    };
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) add(mesh.quads[q], mesh.quad_region[q]);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) add(mesh.triangles[t], mesh.triangle_region[t]);
    for (const Face& face : faces) width_.push_back(face.outline > 0 ? 2 * face.area / face.outline : kAny);
    tree_ = BoxTree<Vec3>(boxes);
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
  /// Of a face, as ignore_small() has it.
  double width(int region) const { return width_[region]; }
  /// The length of the shortest curve at a node.
  double shortest_curve(int v) const { return shortest_curve_[v]; }
  /// From a node on a curve to the nearest other edge of its face's outline, up to `most`: not to those that
  /// begin there, nor to the next. Infinite: there is none.
  double gap(int v, int region, double most) const {
    const Vec3& x = mesh_.points[v];
    double limit2 = most * most, gap = kAny;
    tree_.nearest(x, limit2, [&](int i) {
      const auto& [a, b, face] = sides_[i];
      if (face != region || a == v || b == v || curve(a, v) >= 0 || curve(b, v) >= 0) return;
      const double d = distance_to_segment(x, mesh_.points[a], mesh_.points[b]);
      if (d * d <= limit2) gap = d, limit2 = d * d;
    });
    return gap;
  }

 private:
  struct Face {
    double area = 0, outline = 0;
  };
  const Mesh& mesh_;
  std::vector<std::array<int, 3>> edges_;
  std::vector<double> shortest_, shortest_curve_, width_;
  std::vector<std::array<int, 3>> sides_;  ///< two nodes and a region
  BoxTree<Vec3> tree_;
};

enum Cause { kAtCorner, kAtFineCurve, kAtGap, kAtSharpEdge, kOtherwise, kCauses };

/// A poor quad, and why it is.
struct PoorQuad {
  int quad, cause_at;        ///< `cause_at`: the quad at which its cause is
  double eta, aspect, edge;  ///< `edge`: the shortest in sizes
  Cause cause = kOtherwise;
  double what = 0;              ///< radians of the corner, or a length
  std::array<int, 2> curves{};  ///< at a corner: their tags
  double ignored_below = 0;  ///< of a surface: a length below which the cause is left out; 0: none is known
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
      PoorQuad quad{static_cast<int>(q), static_cast<int>(q), eta_of(shape.angle), 1, kAny};
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
    spread_causes();
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
    const double fine = edges_.shortest(finest), least = kFine * size;
    const int region = mesh_.quad_region[quad.quad];
    double narrow = kAny;
    for (const int i : v)
      if (edges_.has(i)) narrow = std::min(narrow, edges_.gap(i, region, least));
    const auto ignored = [&](double length) { quad.ignored_below = length < least ? length : 0; };
    if (narrow < least && narrow < fine / 2) {
      ignored(edges_.width(region));
      return found(kAtGap, narrow);
    }
    // An edge that is not much shorter makes sides short, but no sharp angles.
    if (fine < (quad.edge < kPoorEdge ? kFine : kPoorEdge) * size) {
      ignored(std::min(edges_.shortest_curve(finest), edges_.width(region)));
      return found(kAtFineCurve, fine);
    }
    if (is_triangulated(prepared_) && edges_.has(finest)) found(kAtSharpEdge, 0);
  }
  /// Quads that share a node with one that is explained by curves or a gap, and so on, are so for that.
  void spread_causes() {
    std::vector<int> from(mesh_.points.size(), -1);  // by node: such a quad
    const auto is_known = [](const PoorQuad& quad) {
      return quad.cause == kAtFineCurve || quad.cause == kAtGap;
    };
    for (bool grows = true; grows;) {
      grows = false;
      for (std::size_t i = 0; i < quads.size(); ++i)
        if (is_known(quads[i]))
          for (const int v : mesh_.quads[quads[i].quad])
            if (from[v] < 0) from[v] = static_cast<int>(i), grows = true;
      for (PoorQuad& quad : quads)
        if (quad.cause == kOtherwise || quad.cause == kAtSharpEdge)
          for (const int v : mesh_.quads[quad.quad])
            if (from[v] >= 0 && !is_known(quad)) {
              const PoorQuad& known = quads[from[v]];
              quad.cause = known.cause, quad.cause_at = known.cause_at, quad.what = known.what,
              quad.ignored_below = known.ignored_below;
            }
    }
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

  const PreparedProblem& prepared_;
  const Mesh& mesh_;
  CurveEdges edges_;
  std::vector<SharpCorner> sharp_corners_ = prepared_.sharp_corners();
};

bool is_given(const PreparedProblem& prepared) {
  return std::ranges::any_of(prepared.patches,
                             [](const PreparedPatch& patch) { return !patch.given.points.empty(); });
}

/// What helps against a cause; empty: nothing that is known. Of its quads, `n`, so many are `ignored` below
/// that length.
std::string advice(const PreparedProblem& prepared, const PoorQuad& first, int n, int ignored, double below) {
  if (is_given(prepared) || (first.cause != kAtGap && first.cause != kAtFineCurve)) return "";
  if (prepared.surface && ignored == 0) return "";
  if (prepared.surface)
    return fmt::format(": --ignore-below {:.3g} may help{}", below,
                       ignored < n ? fmt::format(" against {} of them", ignored) : "");
  return fmt::format(": {}a size of {:.3g} there would help",
                     first.cause == kAtGap ? "" : "fewer points, or ", first.what);
}

std::string text_of(const PreparedProblem& prepared, const Mesh& mesh, const std::vector<PoorQuad>& quads,
                    Cause cause) {
  const PoorQuad* first = nullptr;
  double below = 0;
  int n = 0, ignored = 0;
  for (const PoorQuad& quad : quads) {
    if (quad.cause != cause) continue;
    if (++n == 1 || quad.what < first->what) first = &quad;
    ignored += quad.ignored_below > 0;
    below = std::max(below, quad.ignored_below);
  }
  if (n == 0) return "";
  const std::string at = show_place(mesh, middle_of_quad(mesh, first->cause_at));
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
  constexpr double kAbove = 1.05;  // of what is to be below
  return fmt::format("; {} {}{}", n, why, advice(prepared, *first, n, ignored, kAbove * below));
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
