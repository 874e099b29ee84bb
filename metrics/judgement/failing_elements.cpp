// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/judgement/failing_elements.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <set>

#include "base/box.h"
#include "base/box_tree.h"
#include "base/segment.h"
#include "base/text.h"
#include "features/sizes/curve_options.h"
#include "features/symmetry/mirrored_surface.h"
#include "geometry/mesh/half_edges.h"
#include "metrics/judgement/poor_quads.h"
#include "metrics/judgement/soundness.h"

namespace delquad {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSharpAngle = kBadEta * std::numbers::pi / 2;
/// A corner explains a quad whose eta is at least kPartOfBound of its bound, up to the bend of its curves
/// along an edge. Below the angle kCusp (radians) it explains any quad.
constexpr double kPartOfBound = 0.9, kCusp = kDegree;
/// Edges on curves, and gaps between curves, below this part of the size leave no space for good quads.
constexpr double kFine = 0.25;
constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr const char* kSizeKey = "size";

/// Edges of a mesh on curves of its model, with their faces.
class CurveEdges {
 public:
  /// `prepared` is the problem of the mesh; null: curves of the mesh count as the model's.
  CurveEdges(const MeshingSetup* prepared, const Mesh& mesh)
      : mesh_(mesh),
        shortest_(mesh.points.size(), kAny),
        shortest_curve_(shortest_),
        shortest_on_(mesh.points.size(), -1) {
    curve_length_.resize(mesh.curves.size());
    std::vector<char> is_cut(mesh.curves.size(), 0);
    if (prepared && prepared->surface)
      for (const SurfaceCut& cut : prepared->surface->all_cuts()) is_cut[cut.curve] = 1;
    for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
      if (is_cut[mesh.line_curve[l]]) continue;
      const auto [a, b] = mesh.lines[l];
      edges_.push_back({std::min(a, b), std::max(a, b), mesh.line_curve[l]});
      // Uses places before nodes moved along curves, which is not due to the model.
      const Mesh& first = prepared ? prepared->boundary : mesh;
      const bool is_there = l < first.lines.size() && first.lines[l] == mesh.lines[l];
      const auto& points = is_there ? first.points : mesh.points;
      const double length = norm(points[b] - points[a]);
      curve_length_[mesh.line_curve[l]] += length;
      for (const int v : {a, b})
        if (length < shortest_[v]) shortest_[v] = length, shortest_on_[v] = mesh.line_curve[l];
    }
    for (const auto& [a, b, c] : edges_)
      for (const int v : {a, b}) shortest_curve_[v] = std::min(shortest_curve_[v], curve_length_[c]);
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
  /// Returns the curve of the edge from a to b; -1: none.
  int curve(int a, int b) const {
    const std::array<int, 3> first{std::min(a, b), std::max(a, b), -1};
    const auto at = std::ranges::lower_bound(edges_, first);
    return at != edges_.end() && (*at)[0] == first[0] && (*at)[1] == first[1] ? (*at)[2] : -1;
  }
  /// Returns the shortest edge at a node; infinite: none.
  double shortest(int v) const { return shortest_[v]; }
  bool has(int v) const { return shortest_[v] < kAny; }
  /// Returns the curve of that edge; -1: none.
  int shortest_on(int v) const { return shortest_on_[v]; }
  /// Returns the width of a face, as in ignore_small().
  double width(int region) const { return width_[region]; }
  /// Returns the length of the shortest curve at a node.
  double shortest_curve(int v) const { return shortest_curve_[v]; }
  /// Returns the nearest curve that is at most so long; -1: none.
  int nearest_short(const Vec3& x, double most) const {
    double limit2 = kAny;
    int found = -1;
    tree_.nearest(x, limit2, [&](int i) {
      const auto& [a, b, face] = sides_[i];
      const int c = curve(a, b);
      if (curve_length_[c] > most) return;
      const double d = distance_to_segment(x, mesh_.points[a], mesh_.points[b]);
      if (d * d < limit2) found = c, limit2 = d * d;
    });
    return found;
  }
  /// Returns the distance from a node on a curve to the nearest other edge on its face's outline, up to
  /// `most`. Edges that begin at the node or next to it do not count. Infinite: none.
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
  std::vector<double> shortest_, curve_length_, shortest_curve_, width_;
  std::vector<int> shortest_on_;
  std::vector<std::array<int, 3>> sides_;  ///< two nodes and a region
  BoxTree<Vec3> tree_;
};

/// Finds the causes of failing elements.
class CauseFinder {
 public:
  explicit CauseFinder(FailingElements& all)
      : all_(all), prepared_(all.judged.prepared), mesh_(all.judged.mesh), edges_(prepared_, mesh_) {
    if (prepared_) sharp_corners_ = prepared_->sharp_corners();
  }
  void find() {
    for (FailingElement& failing : all_.elements)
      if (is_explained(failing)) explain(failing);
    spread_causes();
    find_irregular();
    for (FailingElement& failing : all_.elements)
      if (failing.cause == kOtherwise && failing.element >= all_.n_triangles()) explain_choice(failing);
  }

 private:
  const std::array<int, 4>& quad(int element) const { return mesh_.quads[element - all_.n_triangles()]; }

  /// Returns whether causes apply: to quads that are narrow, short or oblique, not to long or warped ones.
  bool is_explained(const FailingElement& failing) const {
    const auto& limits = all_.criteria.limits;
    for (std::size_t k = 0; k < limits.size(); ++k)
      if ((failing.beyond >> k & 1) != 0 && limits[k].key != criterion_registry()[kMaxLength].key &&
          limits[k].key != criterion_registry()[kMaxWarpage].key)
        return failing.element >= all_.n_triangles();
    return false;
  }
  /// Returns the largest limit of a kind that the element exceeds; 0: none. `size` is the size there.
  double limit_beyond(const FailingElement& failing, CriterionKind kind, double size = 1) const {
    double largest = 0;
    const auto& limits = all_.criteria.limits;
    for (std::size_t k = 0; k < limits.size(); ++k)
      if ((failing.beyond >> k & 1) != 0 && limits[k].key == criterion_registry()[kind].key)
        largest = std::max(largest, limits[k].value * (limits[k].in_sizes ? size : 1));
    return largest;
  }

  bool explain_by_corner(FailingElement& failing) const {
    const auto& v = quad(failing.element);
    const ElementShape<4> shape = quad_shape(mesh_, failing.element - all_.n_triangles(), all_.judged.sides);
    const double eta = eta_of(shape.angle);
    const double sharp = std::max({kSharpAngle, limit_beyond(failing, kMinAngle) * kDegree,
                                   limit_beyond(failing, kMinEta) * std::numbers::pi / 2});
    const auto in_corner = [&](double angle, double bound, std::array<int, 2> curves) {
      if (eta < kPartOfBound * bound && angle > kCusp) return false;
      failing.cause = kAtCorner, failing.what = angle, failing.curves = curves;
      return true;
    };
    for (int k = 0; k < 4; ++k) {
      const int before = edges_.curve(v[(k + 3) % 4], v[k]), after = edges_.curve(v[k], v[(k + 1) % 4]);
      if (before >= 0 && after >= 0 && shape.angle[k] < sharp &&
          in_corner(shape.angle[k], shape.angle[k] / (std::numbers::pi / 2), {before, after}))
        return true;
      for (const SharpCorner& c : sharp_corners_)
        if (is_at(c, mesh_.points[v[k]]) && in_corner(c.angle, c.eta_bound, {c.curves[0], c.curves[1]}))
          return true;
    }
    return false;
  }
  void explain(FailingElement& failing) const {
    if (explain_by_corner(failing)) return;
    const auto& v = quad(failing.element);
    const auto found = [&](FailingCause cause, double what) { failing.cause = cause, failing.what = what; };
    const int finest = *std::ranges::min_element(v, {}, [&](int i) { return edges_.shortest(i); });
    const int q = failing.element - all_.n_triangles();
    const double size = failing.size;
    const double asked =
        std::max({limit_beyond(failing, kMinLength, size), limit_beyond(failing, kMinHeight, size),
                  limit_beyond(failing, kMinTimeStep) * speed_of_sound(all_.criteria)});
    const double fine = edges_.shortest(finest), least = std::max(kFine * size, asked);
    const int region = std::max(mesh_.quad_region[q], 0);
    double narrow = kAny;
    for (const int i : v)
      if (edges_.has(i)) narrow = std::min(narrow, edges_.gap(i, region, least));
    const auto ignored = [&](double length) { failing.ignored_below = length < least ? length : 0; };
    if (narrow < least && narrow < fine / 2) {
      ignored(edges_.width(region));
      return found(kAtGap, narrow);
    }
    // An edge that is not much shorter makes sides short, but no sharp angles.
    if (fine < (asked > 0 ? least : kPoorEdge * size)) {
      ignored(std::min(edges_.shortest_curve(finest), edges_.width(region)));
      failing.curves[0] = edges_.shortest_on(finest);
      return found(kAtFineCurve, fine);
    }
    if (is_triangulated() && edges_.has(finest)) found(kAtSharpEdge, 0);
  }
  /// Passes causes by curves or gaps on to failing quads that share a node, repeatedly.
  void spread_causes() {
    std::vector<FailingElement>& elements = all_.elements;
    std::vector<int> from(mesh_.points.size(), -1);  // by node: such a quad
    const auto is_known = [](const FailingElement& e) {
      return e.cause == kAtFineCurve || e.cause == kAtGap;
    };
    for (bool grows = true; grows;) {
      grows = false;
      for (std::size_t i = 0; i < elements.size(); ++i)
        if (is_known(elements[i]))
          for (const int v : quad(elements[i].element))
            if (from[v] < 0) from[v] = static_cast<int>(i), grows = true;
      for (FailingElement& failing : elements)
        if (is_explained(failing) && (failing.cause == kOtherwise || failing.cause == kAtSharpEdge))
          for (const int v : quad(failing.element))
            if (from[v] >= 0 && !is_known(failing)) {
              const FailingElement& known = elements[from[v]];
              failing.cause = known.cause, failing.cause_at = known.cause_at, failing.what = known.what,
              failing.curves = known.curves, failing.ignored_below = known.ignored_below;
            }
    }
  }
  /// Finds the number of quads at each node, and an irregular node inside of faces near to each node.
  void find_irregular() {
    constexpr int kRings = 2;
    valence_.assign(mesh_.points.size(), 0);
    irregular_.assign(mesh_.points.size(), -1);
    for (const auto& v : mesh_.quads)
      for (const int i : v) ++valence_[i];
    for (std::size_t i = 0; i < irregular_.size(); ++i)
      if (valence_[i] > 0 && valence_[i] != 4 && !edges_.has(static_cast<int>(i)))
        irregular_[i] = static_cast<int>(i);
    for (int ring = 0; ring < kRings; ++ring) {
      const std::vector<int> inner = irregular_;
      for (const auto& v : mesh_.quads)
        for (const int i : v)
          for (const int j : v)
            if (irregular_[i] < 0) irregular_[i] = inner[j];
    }
  }
  /// Explains an element that the model does not force.
  void explain_choice(FailingElement& failing) const {
    const auto& v = quad(failing.element);
    const double size = failing.size;
    const auto found = [&](FailingCause cause, double what) { failing.cause = cause, failing.what = what; };
    if (const double limit = limit_beyond(failing, kMaxWarpage); limit > 0)
      return found(kAtBend, size * limit * kDegree / quad_warp(corners_of(mesh_, v)));
    constexpr double kReduced = 0.9;
    if (int hint = -1; prepared_ && prepared_->size.asked) {
      const Vec3 at = all_.place_of(failing.element).at;
      const double here = prepared_->size.field->at(at, hint);
      failing.curves[0] = here < kReduced * size ? edges_.nearest_short(at, here) : -1;
      if (failing.curves[0] >= 0) return found(kAtFineSize, here);
    }
    double shortest = kAny;
    for (int k = 0; k < 4; ++k)
      if (const int a = v[k], b = v[(k + 1) % 4], c = edges_.curve(a, b); c >= 0)
        if (const double length = norm(mesh_.points[b] - mesh_.points[a]); length < shortest)
          shortest = length, failing.curves[0] = c;
    if (limit_beyond(failing, kMinLength, size) > shortest) return found(kAtNumber, shortest);
    for (const int i : v)
      if (irregular_[i] >= 0) return found(kAtIrregular, valence_[irregular_[i]]);
    if (shortest < kAny) found(kAtNumber, shortest);
  }
  bool is_triangulated() const {
    return prepared_ && prepared_->surface && !prepared_->surface->given &&
           !prepared_->surface->model.projector;
  }
  /// Returns whether x is the place of the corner or an image of it.
  bool is_at(const SharpCorner& corner, const Vec3& x) const {
    constexpr double kSamePlace = 1e-9;  // part of the coordinates
    const auto& mirrored = prepared_->surface->mirrored;
    const Vec3 at = prepared_->boundary.points[corner.node], here = mirrored ? mirrored->planes.fold(x) : x;
    return norm(here - at) <= kSamePlace * norm(at);
  }

  FailingElements& all_;
  const MeshingSetup* prepared_;
  const Mesh& mesh_;
  CurveEdges edges_;
  std::vector<SharpCorner> sharp_corners_;
  std::vector<int> valence_, irregular_;  ///< by node; -1: none
};

bool is_given(const MeshingSetup& prepared) {
  return std::ranges::any_of(prepared.patches,
                             [](const PatchSetup& patch) { return !patch.given.points.empty(); });
}

/// Returns whether elements of a size may keep the least length, which is no part of the size then.
bool allows_size(const Criteria& criteria, double size) {
  const CriterionLimit* least = least_length(criteria);
  return least == nullptr || least->in_sizes || size >= least->value;
}

/// Returns a remedy for a cause with `n` elements; empty: none is known.
std::string advice(const MeshingSetup* prepared, const Criteria& criteria, const FailingElement& first, int n,
                   const std::vector<Cure>& cures) {
  if (!prepared || is_given(*prepared) || (first.cause != kAtGap && first.cause != kAtFineCurve)) return "";
  if (prepared->surface) {
    if (cures.empty() || cures[0].key == kSizeKey) return "";
    return fmt::format(": --ignore-below {:.3g} may help{}", cures[0].value,
                       cures[0].count < n ? fmt::format(" against {} of them", cures[0].count) : "");
  }
  if (!(first.what > 0)) return "";
  constexpr double kAbove = 1.01;
  const PlaneSetup& plane = prepared->plane;
  std::vector<std::string> remedies;
  if (first.cause == kAtFineCurve && plane.curve_places.empty()) remedies.emplace_back("fewer points");
  if (first.cause == kAtFineCurve && !plane.curve_places.empty() && !plane.ignores_small)
    remedies.push_back(
        fmt::format("--ignore-below {:.3g} (of a hole: more than it is around)", kAbove * first.what));
  if (first.cause == kAtGap && !plane.curve_places.empty() &&
      curve_options(prepared->settings.options).gap_rows == 0)
    remedies.emplace_back("--gap-rows 1 (but in corners)");
  if (allows_size(criteria, first.what))
    remedies.push_back(fmt::format("a size of {:.3g} there", first.what));
  return remedies.empty() ? "" : fmt::format(": {} would help", fmt::join(remedies, ", or "));
}

/// Returns "curve 7 (rim)".
std::string show_curve(const Mesh& mesh, int curve) {
  const Entity& entity = mesh.curves[curve];
  return fmt::format("curve {}{}", entity.tag, entity.names.empty() ? "" : " (" + entity.names[0] + ")");
}

/// Returns 1 for each element in regions or along curves of a name.
std::vector<char> elements_named(const Mesh& mesh, const std::string& name) {
  const auto has_name = [&](const Entity& entity) { return std::ranges::count(entity.names, name) > 0; };
  std::set<std::array<int, 2>> on_curves;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if (const auto [a, b] = mesh.lines[l]; has_name(mesh.curves[mesh.line_curve[l]]))
      on_curves.insert({std::min(a, b), std::max(a, b)});
  std::vector<int> regions = mesh.triangle_region;
  regions.insert(regions.end(), mesh.quad_region.begin(), mesh.quad_region.end());
  std::vector<char> in;
  for_each_element(mesh, [&](int e, const auto& v) {
    bool is_in = has_name(mesh.regions[regions[e]]);
    for (std::size_t k = 0; k < v.size() && !is_in; ++k) {
      const auto [low, high] = std::minmax(v[k], v[(k + 1) % v.size()]);
      is_in = on_curves.contains({low, high});
    }
    in.push_back(is_in);
  });
  return in;
}

}  // namespace

double JudgedMesh::size_at(std::span<const int> v, int& hint) const {
  Vec3 sum;
  for (const int i : v) sum = sum + mesh.points[i];
  return size->at((1.0 / static_cast<double>(v.size())) * sum, hint);
}

/// The limits of the criteria, as they apply to elements.
struct FailingElements::Limits {
  Limits(const Mesh& mesh, const Criteria& criteria)
      : by(step_length_named(criteria.time_step_by)), speed(speed_of_sound(criteria)) {
    std::vector<std::vector<char>> named;
    for (const CriterionLimit& limit : criteria.limits) {
      kinds.push_back(criterion_kind(limit.key));
      named.push_back(limit.on.empty() ? std::vector<char>() : elements_named(mesh, limit.on));
      has_sizes |= limit.in_sizes;
    }
    counts = named;
    for (std::size_t k = 0; k < kinds.size(); ++k)
      for (std::size_t j = 0; j < kinds.size(); ++j) {
        if (kinds[j] != kinds[k] || !named[k].empty() || named[j].empty()) continue;
        counts[k].resize(named[j].size(), 1);
        for (std::size_t i = 0; i < named[j].size(); ++i)
          if (named[j][i]) counts[k][i] = 0;
      }
  }
  StepLength by;
  double speed;
  bool has_sizes = false;
  std::vector<CriterionKind> kinds;
  std::vector<std::vector<char>> counts;  ///< by limit and element; empty: for all
};

bool FailingElements::is_on_purpose(int element) const {
  const std::vector<char>& on_purpose = judged.on_purpose;
  return element >= n_triangles() && !on_purpose.empty() && on_purpose[element - n_triangles()];
}

Place FailingElements::place_of(int element) const {
  const Mesh& mesh = judged.mesh;
  if (element >= n_triangles()) return middle_of_quad(mesh, element - n_triangles());
  const auto [a, b, c] = corners_of(mesh, mesh.triangles[element]);
  const auto& regions = mesh.triangle_region;
  return {(1.0 / 3) * (a + b + c),
          static_cast<std::size_t>(element) < regions.size() ? regions[element] : -1};
}

template <std::size_t N>
void FailingElements::judge(int element, const std::array<int, N>& v, const Limits& limits, int& hint) {
  constexpr double kRounding = 1e-9;  // relative: rounding of coordinates (1e-16), a million times a side
  const auto corners = corners_of(judged.mesh, v);
  const Vec3 side =
      N == 3 ? judged.sides.of_triangle(element) : judged.sides.of_quad(element - n_triangles());
  const ElementShape<N> shape = element_shape(corners, side);
  const double size = limits.has_sizes ? judged.size_at(v, hint) : 1;
  const bool on_purpose = is_on_purpose(element);
  FailingElement failing{element, element, 0, 0, 0};
  for (std::size_t k = 0; k < limits.kinds.size(); ++k) {
    const CriterionKind kind = limits.kinds[k];
    if ((on_purpose && kind <= kMaxAspect) || (!limits.counts[k].empty() && !limits.counts[k][element]))
      continue;
    const CriterionLimit& limit = criteria.limits[k];
    const double value =
        criterion_value(kind, corners, shape, limits.by, limits.speed) / (limit.in_sizes ? size : 1);
    LimitTally& tally = tallies[k];
    if (tally.worst_element < 0 ||
        (criterion_registry()[kind].is_most ? value > tally.worst : value < tally.worst))
      tally.worst = value, tally.worst_element = element;
    const double badness = times_beyond(kind, value, limit.value);
    if (badness <= 1 + kRounding) continue;
    failing.beyond |= std::uint64_t{1} << k;
    failing.badness = std::max(failing.badness, badness);
    tally.failing.push_back(element);
  }
  if (failing.beyond == 0) return;
  failing.size = on_purpose ? std::nan("") : limits.has_sizes ? size : judged.size_at(v, hint);
  elements.push_back(failing);
}

FailingElements::FailingElements(const JudgedMesh& mesh, const Criteria& asked, bool with_triangles)
    : judged(mesh), criteria(asked), tallies(asked.limits.size()) {
  const Limits limits(judged.mesh, criteria);
  int hint = -1;
  for_each_element(judged.mesh, [&](int element, const auto& v) {
    if (with_triangles || element >= n_triangles()) judge(element, v, limits, hint);
  });
  for (LimitTally& tally : tallies) {
    // Quads come first.
    const auto quads = std::ranges::lower_bound(tally.failing, n_triangles());
    for (auto i = quads; i != tally.failing.end(); ++i) tally.places.add(place_of(*i));
    for (auto i = tally.failing.begin(); i != quads; ++i) tally.places.add(place_of(*i));
  }
  std::ranges::stable_sort(elements, std::greater<>(), &FailingElement::badness);
}

void FailingElements::explain() { CauseFinder(*this).find(); }

std::string FailingElements::text_of(std::size_t limit) const {
  const LimitTally& tally = tallies[limit];
  if (tally.failing.empty()) return "";
  const CriterionLimit& asked = criteria.limits[limit];
  const Criterion& criterion = criterion_registry()[criterion_kind(asked.key)];
  const std::string what =
      fmt::format("{} {}{}, the {} {:.{}g}", criterion.fails, delquad::text_of(asked),
                  asked.on.empty() ? "" : " at '" + asked.on + "'", criterion.is_most ? "largest" : "least",
                  tally.worst, criterion.is_most ? 4 : 3);
  return describe(judged.mesh, tally.places, "1 element has " + what, "elements have " + what);
}

std::vector<Cure> FailingElements::cures_of(FailingCause cause) const {
  constexpr double kAbove = 1.05;   // part of the length that must be exceeded
  constexpr double kFinest = 0.25;  // of the wanted size; smaller sizes chase the tips of wedges
  if (!judged.prepared || !judged.prepared->surface || is_given(*judged.prepared)) return {};
  Cure leave_out{kCauseNames[cause], "surface.ignore_below"}, refine{kCauseNames[cause], kSizeKey, kAny};
  for (const FailingElement& element : elements) {
    if (element.cause != cause) continue;
    if (element.ignored_below > 0)
      ++leave_out.count, leave_out.value = std::max(leave_out.value, kAbove * element.ignored_below);
    else if ((cause == kAtBend || cause == kAtGap || cause == kAtFineCurve) &&
             element.what > kFinest * element.size && allows_size(criteria, element.what))
      ++refine.count, refine.value = std::min(refine.value, element.what);
  }
  std::vector<Cure> cures{std::move(leave_out), std::move(refine)};
  std::erase_if(cures, [](const Cure& cure) { return cure.count == 0; });
  return cures;
}

std::string FailingElements::text_of(FailingCause cause, bool named, bool advised) const {
  const Mesh& mesh = judged.mesh;
  const FailingElement* first = nullptr;
  int n = 0;
  for (const FailingElement& quad : elements)
    if (quad.cause == cause && (++n == 1 || quad.what < first->what)) first = &quad;
  if (n == 0) return "";
  const std::string at = show_place(mesh, place_of(first->cause_at));
  std::string why;
  switch (cause) {
    case kAtCorner:
      why = fmt::format(
          "in sharp corners of the model, the sharpest of {:.3g} degrees between curves {} and {} in {}",
          first->what / kDegree, mesh.curves[first->curves[0]].tag, mesh.curves[first->curves[1]].tag, at);
      break;
    case kAtFineCurve:
      why = fmt::format("where curves are finer than the size, with an edge of {:.3g} {}in {}", first->what,
                        named ? "on " + show_curve(mesh, first->curves[0]) + " " : "", at);
      break;
    case kAtGap:
      why = fmt::format("in places narrower than the size, {:.3g} in {}", first->what, at);
      break;
    case kAtSharpEdge:
      why = fmt::format("at sharp edges of the triangulation, as in {}", at);
      break;
    case kAtBend:
      why = fmt::format("where faces bend within an element, as in {}", at);
      break;
    case kAtFineSize:
      why = fmt::format("where short curves reduce the size, to {:.3g} {}in {}", first->what,
                        named ? "by " + show_curve(mesh, first->curves[0]) + " " : "", at);
      break;
    case kAtNumber:
      why = fmt::format("at curves whose numbers of edges leave no better quads, as {}in {}",
                        named ? show_curve(mesh, first->curves[0]) + " " : "", at);
      break;
    case kAtIrregular:
      why = fmt::format("near irregular vertices, as one with {} quads in {}", first->what, at);
      break;
    default:
      return fmt::format("{} without a known cause, as in {}", n, at);
  }
  return fmt::format(
      "{} {}{}", n, why,
      advice(judged.prepared, criteria, *first, n, advised ? cures_of(cause) : std::vector<Cure>()));
}

}  // namespace delquad
