// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/dxf_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/length_unit.h"
#include "base/located.h"
#include "base/text.h"
#include "geometry/planar/join_outlines.h"
#include "io/text_scanner.h"

namespace delquad {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A non-uniform rational B-spline, by de Boor's algorithm.
std::shared_ptr<const Curve> make_nurbs(std::size_t degree, std::vector<double> knots,
                                        std::vector<double> weights, std::vector<Vec2> points) {
  const std::size_t n = points.size();
  weights.resize(n, 1);
  if (degree < 1 || n <= degree || knots.size() != n + degree + 1 || !std::ranges::is_sorted(knots) ||
      !(knots[degree] < knots[n]) || std::ranges::any_of(weights, [](double w) { return !(w > 0); }))
    refuse(
        "a spline of degree {} with {} points and {} knots: expected {} ascending knots, and weights above 0",
        degree, n, knots.size(), n + degree + 1);
  const double first = knots[degree], last = knots[n];
  return make_parametric_curve(
      [degree, knots = std::move(knots), weights = std::move(weights), points = std::move(points),
       n](double t) {
        const auto after = std::upper_bound(knots.begin() + static_cast<std::ptrdiff_t>(degree) + 1,
                                            knots.begin() + static_cast<std::ptrdiff_t>(n), t);
        const std::size_t span = static_cast<std::size_t>(after - knots.begin()) - 1;
        std::vector<Vec3> d;
        for (std::size_t i = span - degree; i <= span; ++i)
          d.push_back({weights[i] * points[i].x, weights[i] * points[i].y, weights[i]});
        for (std::size_t r = 1; r <= degree; ++r)
          for (std::size_t j = degree; j >= r; --j) {
            const std::size_t i = j + span - degree;
            const double a = (t - knots[i]) / (knots[i + 1 + degree - r] - knots[i]);
            d[j] = (1 - a) * d[j - 1] + a * d[j];
          }
        return Vec2{d[degree].x / d[degree].z, d[degree].y / d[degree].z};
      },
      first, last);
}

/// Where a block stands: turned, scaled, then moved.
struct Placement {
  Vec2 x{1, 0}, y{0, 1}, at{};
  double z_scale = 1, z_at = 0;
  Vec2 turned(Vec2 p) const { return p.x * x + p.y * y; }
  Vec2 operator()(Vec2 p) const { return at + turned(p); }
  Vec3 operator()(const Vec3& p) const {
    const Vec2 q = (*this)(Vec2{p.x, p.y});
    return {q.x, q.y, z_at + z_scale * p.z};
  }
  /// First `inner`, then this.
  Placement after(const Placement& inner) const {
    return {turned(inner.x), turned(inner.y), (*this)(inner.at), z_scale * inner.z_scale,
            z_at + z_scale * inner.z_at};
  }
};

class CurveOfBlock final : public Curve {
 public:
  CurveOfBlock(std::shared_ptr<const Curve> base, const Placement& place)
      : base_(std::move(base)), place_(place) {}
  Vec2 point(double t) const override { return place_(base_->point(t)); }
  std::vector<double> fixed_parameters() const override { return base_->fixed_parameters(); }

 private:
  std::shared_ptr<const Curve> base_;
  Placement place_;
};

/// The drawing, or a block of it.
struct Block {
  struct Insert {
    std::string block, layer, where;
    Placement place;
  };
  struct Face {
    std::array<Vec3, 4> corners;
    std::string layer;
  };
  Vec2 base = {};
  std::vector<ModelCurve> curves = {};
  std::vector<ModelCurve> fills = {};  ///< outlines of filled areas
  std::vector<ModelPoint> points = {};
  std::vector<Face> faces = {};
  std::vector<Insert> inserts = {};
  std::string why_not = {};  ///< why it cannot be read; empty: it can
};

/// Returns the unit of $INSUNITS, a name of length_unit.h; empty: none of them.
std::string unit_of(double code) {
  static const std::map<double, const char*> kUnits = {{1, "in"}, {2, "ft"}, {4, "mm"}, {5, "cm"},
                                                       {6, "m"},  {7, "km"}, {13, "um"}};
  const auto at = kUnits.find(code);
  return at == kUnits.end() ? "" : at->second;
}

class DxfReader {
 public:
  DxfReader(const std::filesystem::path& path, std::string& unit) : in_(path), unit_(unit) {
    model_.source = path.string();
    if (in_.text().starts_with("AutoCAD Binary DXF")) in_.fail("binary DXF: expected it as text");
    bool has_entities = false;
    for (next(); value_ != "EOF"; next()) {
      if (code_ == 9 && value_ == "$INSUNITS") next(), unit_of_file_ = unit_of(number());
      if (code_ == 2) has_entities = value_ == "ENTITIES" || value_ == "BLOCKS";
      while (code_ == 0 && has_entities && value_ != "ENDSEC") entity();
      if (value_ == "ENDSEC") has_entities = false;
      if (value_ == "EOF") break;
    }
    if (unit_.empty()) unit_ = unit_of_file_;
    if (unit_of_file_.empty() && !unit_.empty())
      refuse(
          "{}: the drawing does not say its unit ($INSUNITS), so that lengths cannot be in {}: leave it out",
          model_.source, unit_);
    const double factor =
        unit_ == unit_of_file_ ? 1 : length_unit(unit_of_file_).metres / length_unit(unit_).metres;
    put(drawing_, {{factor, 0}, {0, factor}, {}, factor, 0}, "", 0);
  }

  Model model() {
    if (!faces_.empty()) return surface();
    std::string loose = join_outlines(model_);
    if (model_.loops.empty() && !fills_.empty()) {
      model_.curves.insert(model_.curves.end(), fills_.begin(), fills_.end());
      loose = join_outlines(model_);
      for (const char* kind : {"HATCH", "SOLID", "TRACE"}) left_out_.erase(kind);
      model_.notes.push_back(model_.source + ": no curves close up: filled areas are the outlines");
    }
    std::vector<std::string> others;
    for (const auto& [kind, n] : left_out_) others.push_back(fmt::format("{} {}", n, kind));
    const std::string left_out =
        others.empty() ? ""
                       : fmt::format("{} are left out: expected lines, arcs, polylines and splines",
                                     fmt::join(others, ", "));
    if (model_.loops.empty())
      refuse("{}: no curves close up to an outline{}{} [open-outline]", model_.source,
             left_out.empty() ? "" : "; " + left_out,
             loose.empty() ? "" : "; " + loose + ": expected ends that meet");
    if (!left_out.empty()) model_.notes.push_back(model_.source + ": " + left_out);
    if (const int n = leave_out_outside(model_); n > 0)
      model_.notes.push_back(fmt::format("{}: {} outside of all outlines left out", model_.source,
                                         counted(n, "curve or point")));
    return std::move(model_);
  }

 private:
  struct Corner {
    Vec2 at;
    double bulge = 0;  ///< tangent of a fourth of the angle of the arc that begins here
  };

  void next() {
    code_ = static_cast<int>(in_.integer("a group code", -5, 1071));
    if (!in_.next_line()) in_.fail("the file ends within a group: expected EOF");
    value_ = std::string(trimmed(in_.rest_of_line()));
    in_.next_line();
  }
  double number() const {
    const auto value = as_number(value_);
    if (!value || !std::isfinite(*value))
      in_.fail_at(in_.line() - 1, "group {} is {}: expected a number", code_, TextScanner::printable(value_));
    return *value;
  }

  /// Puts what a block holds, and the blocks in it, into the model.
  void put(const Block& block, const Placement& place, const std::string& layer, int depth) {
    constexpr int kMostDepth = 16;
    constexpr std::size_t kMostParts = 1'000'000;
    if (!block.why_not.empty()) refuse("{}", block.why_not);
    n_parts_ += 1 + block.curves.size() + block.fills.size() + block.points.size() + block.faces.size();
    if (depth > kMostDepth || n_parts_ > kMostParts)
      refuse("{}: blocks stand in each other more than {} deep, or hold more than {} parts", model_.source,
             kMostDepth, kMostParts);
    const auto layer_of = [&](const std::string& own) { return own.empty() ? layer : own; };
    const auto put_curves = [&](const std::vector<ModelCurve>& from, std::vector<ModelCurve>& to) {
      for (const ModelCurve& curve : from)
        to.push_back(
            {depth == 0 && place.x.x == 1 ? curve.shape : std::make_shared<CurveOfBlock>(curve.shape, place),
             layer_of(curve.name), curve.where});
    };
    put_curves(block.curves, model_.curves);
    put_curves(block.fills, fills_);
    for (const ModelPoint& p : block.points)
      model_.points.push_back({place(p.at), layer_of(p.name), p.where});
    for (const Block::Face& face : block.faces) {
      faces_.push_back({face.corners, layer_of(face.layer)});
      for (Vec3& corner : faces_.back().corners) corner = place(corner);
    }
    for (const Block::Insert& insert : block.inserts) {
      const auto inner = blocks_.find(insert.block);
      if (inner == blocks_.end())
        refuse("{}: there is no block '{}': expected a whole drawing", insert.where, insert.block);
      put(inner->second, place.after(insert.place).after({{1, 0}, {0, 1}, Vec2{} - inner->second.base}),
          layer_of(insert.layer), depth + 1);
    }
  }

  /// The faces, with a region for each layer.
  TriangleModel surface() const {
    TriangleModel surface{{}, model_.source};
    Mesh& mesh = surface.mesh;
    mesh.unit = unit_;
    std::map<std::string, int> region_of;
    for (const auto& [corners, layer] : faces_) {
      const auto [at, is_new] = region_of.try_emplace(layer, static_cast<int>(mesh.regions.size()));
      if (is_new) mesh.regions.push_back({at->second + 1, {}});
      if (is_new && !layer.empty()) mesh.regions.back().names.push_back(layer);
      const bool is_triangle = corners[3] == corners[2];
      const int v = static_cast<int>(mesh.points.size());
      mesh.points.insert(mesh.points.end(), corners.begin(), corners.end() - is_triangle);
      if (is_triangle)
        mesh.triangles.push_back({v, v + 1, v + 2}), mesh.triangle_region.push_back(at->second);
      else
        mesh.quads.push_back({v, v + 1, v + 2, v + 3}), mesh.quad_region.push_back(at->second);
    }
    if (!model_.curves.empty())
      surface.notes.push_back(
          fmt::format("{} beside 3D faces are left out", counted(std::ssize(model_.curves), "curve")));
    return surface;
  }

  /// One entity, up to what follows it.
  void entity() {
    const std::string kind = value_, where = in_.place(static_cast<std::size_t>(in_.line()) - 1);
    layer_.clear(), name_.clear(), values_.clear(), corners_.clear(), fit_.clear(), knots_.clear(),
        weights_.clear(), hatch_.clear(), hatch_at_ = 0, is_fill_ = false;
    groups(kind);
    if (kind == "POLYLINE") {
      const auto of_line = values_;
      while (value_ == "VERTEX") groups("LWPOLYLINE");
      values_ = of_line;
    }
    where_ = where + ": " + kind;
    if (kind == "BLOCK") {
      into_ = &(blocks_[name_] = {point(10)});
    } else if (kind == "ENDBLK") {
      into_ = &drawing_;
    } else if (into_ == &drawing_) {
      located(where_, [&] { add(kind); });
    } else {
      try {
        located(where_, [&] { add(kind); });
      } catch (const InputError& error) {  // nobody may need the block
        into_->why_not = error.what();
      }
    }
  }

  /// The groups behind one of code 0, up to the next.
  void groups(const std::string& kind) {
    const bool is_polyline = kind == "LWPOLYLINE", is_spline = kind == "SPLINE", is_hatch = kind == "HATCH";
    for (next(); code_ != 0; next()) {
      if (code_ == 2) name_ = value_;
      if (code_ == 8) layer_ = value_ == "0" ? "" : value_;
      const bool is_of_hatch = is_hatch && code_ > 90 && code_ < 98;
      if (code_ < 10 || (code_ > 79 && code_ != 230 && !is_of_hatch)) continue;
      const double value = number();
      if (is_hatch) hatch_.push_back({code_, value});
      if (code_ == 10 && (is_polyline || is_spline)) corners_.push_back({{value, 0}});
      if (code_ == 20 && !corners_.empty()) corners_.back().at.y = value;
      if (code_ == 42 && is_polyline && !corners_.empty()) corners_.back().bulge = value;
      if (code_ == 40 && is_spline) knots_.push_back(value);
      if (code_ == 41 && is_spline) weights_.push_back(value);
      if (code_ == 11 && is_spline) fit_.push_back({value, 0});
      if (code_ == 21 && !fit_.empty()) fit_.back().y = value;
      values_[code_] = value;
    }
  }

  double value(int code, double otherwise = 0) const {
    const auto at = values_.find(code);
    return at == values_.end() ? otherwise : at->second;
  }
  Vec2 point(int code) const { return {value(code), value(code + 10)}; }

  void add(const std::string& kind) {
    constexpr int kMesh = 16 | 64;  // flags of a polyline
    if (value(67) != 0) return;     // it is on paper, around views of the model
    // If the plane of a shape is seen from below, x points to the left.
    const double side = value(230, 1) < 0 ? -1 : 1;
    const Vec2 centre{side * value(10), value(20)};
    if (kind == "LINE") {
      if (point(10) != point(11)) push(make_segment(point(10), point(11)));
    } else if (kind == "CIRCLE") {
      push(make_circle(centre, value(40)));
    } else if (kind == "ARC") {
      push_arc(side, centre, value(40), value(50), value(51));
    } else if (kind == "ELLIPSE") {
      push_ellipse(side, point(10), point(11), value(40), value(41), value(42, 2 * std::numbers::pi));
    } else if (kind == "POLYLINE" && (static_cast<int>(value(70)) & kMesh) != 0) {
      ++left_out_["mesh (POLYLINE)"];
    } else if (kind == "LWPOLYLINE" || kind == "POLYLINE") {
      add_polyline(side);
    } else if (kind == "SPLINE") {
      std::vector<Vec2> points;
      for (const Corner& corner : corners_) points.push_back(corner.at);
      if (!points.empty())
        push(make_nurbs(static_cast<std::size_t>(std::max(0., value(71))), knots_, weights_, points));
      else
        push(make_spline(fit_));
    } else if (kind == "POINT") {
      into_->points.push_back({point(10), layer_, where_});
    } else if (kind == "3DFACE") {
      Block::Face& face = into_->faces.emplace_back(Block::Face{{}, layer_});
      for (int k = 0; k < 4; ++k) face.corners[k] = {value(10 + k), value(20 + k), value(30 + k)};
    } else if (kind == "INSERT") {
      add_inserts(side);
    } else if (kind == "HATCH" || kind == "SOLID" || kind == "TRACE") {
      is_fill_ = true;
      try {
        kind == "HATCH" ? add_hatch(side) : add_solid(side);
        ++left_out_[kind];
      } catch (const InputError&) {  // nobody may need it
        ++left_out_["damaged " + kind];
      }
    } else if (kind != "VERTEX" && kind != "SEQEND" && kind != "ATTRIB") {
      ++left_out_[kind];
    }
  }

  /// From and to are degrees, counterclockwise.
  void push_arc(double side, Vec2 centre, double radius, double from, double to) {
    const double turn = std::fmod(to - from + 720, 360), begin = side > 0 ? from : 180 - from;
    push(make_arc(centre, radius, begin * kDegree, (begin + side * (turn > 0 ? turn : 360)) * kDegree));
  }

  /// `a` is half of the long axis, and the short axis is `ratio` times as long; from and to are parameters.
  void push_ellipse(double side, Vec2 centre, Vec2 a, double ratio, double from, double to) {
    const Vec2 b{side * -ratio * a.y, side * ratio * a.x};
    push(make_parametric_curve([=](double t) { return centre + std::cos(t) * a + std::sin(t) * b; }, from,
                               to > from ? to : to + 2 * std::numbers::pi));
  }

  /// Corners 3 and 4 are exchanged; they are equal in a triangle.
  void add_solid(double side) {
    for (const int code : {10, 11, 13, 12}) corners_.push_back({point(code)});
    values_[70] = 1;
    add_polyline(side);
  }

  /// The value of the next group of a hatch with that code.
  double next_of_hatch(int code) {
    while (hatch_at_ < hatch_.size() && hatch_[hatch_at_].first != code) ++hatch_at_;
    if (hatch_at_ == hatch_.size()) refuse("its outline ends before group {}: expected a whole hatch", code);
    return hatch_[hatch_at_++].second;
  }
  Vec2 next_point_of_hatch(int code, double side) {
    const double x = side * next_of_hatch(code);
    return {x, next_of_hatch(code + 10)};
  }
  /// Degrees, counterclockwise; angles of clockwise edges are negative.
  std::array<double, 2> next_turn_of_hatch() {
    const double from = next_of_hatch(50), to = next_of_hatch(51);
    return next_of_hatch(73) != 0 ? std::array{from, to} : std::array{-to, -from};
  }

  /// The outlines of a hatch: polylines, or lists of edges.
  void add_hatch(double side) {
    for (double outlines = next_of_hatch(91); outlines > 0; --outlines) {
      const bool is_polyline = std::fmod(next_of_hatch(92), 4) >= 2;
      corners_.clear();
      for (double n = next_of_hatch(93); n > 0; --n) {
        if (!is_polyline) {
          add_edge_of_hatch(side);
          continue;
        }
        corners_.push_back({next_point_of_hatch(10, 1)});
        if (hatch_at_ < hatch_.size() && hatch_[hatch_at_].first == 42)
          corners_.back().bulge = next_of_hatch(42);
      }
      values_[70] = 1;
      add_polyline(side);
    }
  }

  void add_edge_of_hatch(double side) {
    const double kind = next_of_hatch(72);
    if (kind == 1) {
      const Vec2 a = next_point_of_hatch(10, side), b = next_point_of_hatch(11, side);
      if (a != b) push(make_segment(a, b));
    } else if (kind == 2) {
      const Vec2 centre = next_point_of_hatch(10, side);
      const double radius = next_of_hatch(40);
      const auto [from, to] = next_turn_of_hatch();
      push_arc(side, centre, radius, from, to);
    } else if (kind == 3) {
      const Vec2 centre = next_point_of_hatch(10, side), axis = next_point_of_hatch(11, side);
      const double ratio = next_of_hatch(40);
      const auto [from, to] = next_turn_of_hatch();
      const auto parameter = [&](double angle) {
        return std::atan2(std::sin(angle * kDegree) / ratio, std::cos(angle * kDegree));
      };
      push_ellipse(side, centre, axis, ratio, parameter(from), parameter(to));
    } else if (kind == 4) {
      const double degree = next_of_hatch(94), is_rational = next_of_hatch(73), n_knots = next_of_hatch(95),
                   n_points = next_of_hatch(96);
      std::vector<double> knots, weights;
      std::vector<Vec2> points;
      while (static_cast<double>(knots.size()) < n_knots) knots.push_back(next_of_hatch(40));
      while (static_cast<double>(points.size()) < n_points) {
        points.push_back(next_point_of_hatch(10, side));
        if (is_rational != 0) weights.push_back(next_of_hatch(42));
      }
      push(make_nurbs(static_cast<std::size_t>(std::clamp(degree, 0., 100.)), knots, weights, points));
    } else {
      refuse("an edge of kind {:g}: expected 1 (line), 2 (arc), 3 (ellipse) or 4 (spline)", kind);
    }
  }

  /// Rows and columns of a block.
  void add_inserts(double side) {
    constexpr double kMost = 1e6;
    const double turn = value(50) * kDegree, columns = std::max(1., value(70)),
                 rows = std::max(1., value(71));
    if (const double n = columns * rows + static_cast<double>(into_->inserts.size()); n > kMost)
      refuse("{:g} copies of blocks: expected at most {:g}", n, kMost);
    const Placement mirror{{side, 0}, {0, 1}, {}},
        turned{{std::cos(turn), std::sin(turn)}, {-std::sin(turn), std::cos(turn)}, point(10), 1, value(30)};
    for (int column = 0; column < static_cast<int>(columns); ++column)
      for (int row = 0; row < static_cast<int>(rows); ++row) {
        const Placement scaled{
            {value(41, 1), 0}, {0, value(42, 1)}, {column * value(44), row * value(45)}, value(43, 1)};
        into_->inserts.push_back({name_, layer_, where_, mirror.after(turned).after(scaled)});
      }
  }

  /// Straight parts, and an arc for each bulge.
  void add_polyline(double side) {
    for (Corner& corner : corners_) corner.at.x *= side, corner.bulge *= side;
    if (corners_.empty()) return;
    if ((static_cast<int>(value(70)) & 1) != 0) corners_.push_back({corners_[0].at});
    std::vector<Vec2> straight{corners_[0].at};
    const auto end_straight = [&](Vec2 at) {
      if (straight.size() > 1) push(make_polyline(straight));
      straight = {at};
    };
    for (std::size_t i = 0; i + 1 < corners_.size(); ++i) {
      const Vec2 a = corners_[i].at, b = corners_[i + 1].at;
      const double bulge = corners_[i].bulge;
      if (a == b) continue;
      if (bulge == 0) {
        straight.push_back(b);
        continue;
      }
      end_straight(b);
      const Vec2 d = b - a, centre = a + 0.5 * d + (1 - bulge * bulge) / (4 * bulge) * Vec2{-d.y, d.x};
      const double from = std::atan2(a.y - centre.y, a.x - centre.x);
      push(make_arc(centre, norm(a - centre), from, from + 4 * std::atan(bulge)));
    }
    end_straight({});
  }

  void push(std::shared_ptr<const Curve> shape) {
    (is_fill_ ? into_->fills : into_->curves).push_back({std::move(shape), layer_, where_});
  }

  TextScanner in_;
  PlanarModel model_;
  std::vector<ModelCurve> fills_;   ///< of the model, outlines if no curves close up
  std::vector<Block::Face> faces_;  ///< of the model
  Block drawing_;
  std::map<std::string, Block> blocks_;
  Block* into_ = &drawing_;  ///< what the next entities belong to
  std::size_t n_parts_ = 0;
  std::map<std::string, int> left_out_;  ///< entities by kind
  int code_ = -1;
  std::string& unit_;  ///< of lengths in the model
  std::string value_, layer_, name_, where_, unit_of_file_;
  std::map<int, double> values_;  ///< by group code; of several the last
  std::vector<Corner> corners_;
  std::vector<Vec2> fit_;
  std::vector<double> knots_, weights_;
  std::vector<std::pair<int, double>> hatch_;  ///< groups of a hatch, in order
  std::size_t hatch_at_ = 0;                   ///< the next of them
  bool is_fill_ = false;                       ///< what is pushed is the outline of a filled area
};

}  // namespace

Model read_dxf(const std::filesystem::path& path, std::string& unit) { return DxfReader(path, unit).model(); }

}  // namespace delquad
