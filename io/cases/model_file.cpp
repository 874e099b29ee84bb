// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/model_file.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "base/box.h"
#include "base/located.h"
#include "base/text.h"
#include "delquad/fields.h"
#include "delquad/model.h"
#include "io/cases/read_described.h"
#include "io/cases/shapes.h"

namespace delquad {
namespace {

constexpr long long kMostPatternLoops = 1'000'000;

using Curves = std::vector<std::shared_ptr<const Curve>>;

template <Described Shape>
Shape read_shape(const TomlTable& table) {
  Shape shape{};
  read_described(table, shape);
  return shape;
}

/// Throws InputError unless the table has exactly one of the keys.
void require_one(const TomlTable& table, const std::vector<std::string>& keys) {
  std::string found;
  for (const std::string& key : keys) {
    if (!table.has(key)) continue;
    if (!found.empty())
      refuse("{}: '{}' and '{}' exclude each other: expected one of {}", table.where(key), found, key,
             fmt::join(keys, ", "));
    found = key;
  }
  if (found.empty()) refuse("{}: no shape: expected one of {}", table.where(), fmt::join(keys, ", "));
}

/// `other`: another key that may stand in place of the curve's.
void require_one_curve(const TomlTable& table, const char* other = nullptr) {
  std::vector<std::string> keys;
  for (const TomlKey& key : keys_of<CurveShape>()) keys.push_back(key.name);
  if (other != nullptr) keys.emplace_back(other);
  require_one(table, keys);
}

Vec2 in_plane(const Vec3& p) {
  if (p.z != 0) refuse("{} has a third coordinate: expected [x, y]", show_point(p));
  return {p.x, p.y};
}

std::shared_ptr<const Curve> curve_of(const CurveShape& shape) {
  if (shape.segment) return make_segment((*shape.segment)[0], (*shape.segment)[1]);
  if (const auto& arc = shape.arc)
    return make_arc(arc->circle.centre, arc->circle.radius, arc->from, arc->to);
  if (shape.circle) return make_circle(shape.circle->centre, shape.circle->radius);
  if (const auto& f = shape.expression) return make_expression_curve(f->x, f->y, f->from, f->to);
  std::vector<Vec2> points;
  for (const auto* given : {&shape.polyline, &shape.spline})
    std::ranges::transform(*given, std::back_inserter(points), in_plane);
  return shape.spline.empty() ? make_polyline(points) : make_spline(points);
}

Curves curves_of(const TomlTable& table, const ClosedShape& shape, Vec2 offset) {
  if (shape.circle) return {make_circle(shape.circle->centre + offset, shape.circle->radius)};
  std::vector<Vec2> corners = shape.polygon;
  if (shape.rectangle) {
    const auto [low, high] = Box<Vec2>::around(*shape.rectangle);
    if (low.x == high.x || low.y == high.y)
      refuse("{}: the rectangle has no area: expected two opposite corners", table.where("rectangle"));
    corners = {low, {high.x, low.y}, high, {low.x, high.y}};
  }
  Curves sides;
  for (std::size_t i = 0; i < corners.size(); ++i)
    sides.push_back(make_segment(corners[i] + offset, corners[(i + 1) % corners.size()] + offset));
  return sides;
}

class ModelReader {
 public:
  explicit ModelReader(std::string source) { model_.source = std::move(source); }

  void read_curve(const TomlTable& table) {
    const auto shape = read_shape<NamedShape>(table);
    require_one_curve(table);
    if (!named_.emplace(shape.name, model_.curves.size()).second)
      refuse("{}: a second curve '{}': expected another name", table.where("name"), shape.name);
    const auto curve = located(table.where(), [&] { return curve_of(shape.shape); });
    model_.curves.push_back({curve, table.has("boundary") ? shape.boundary : shape.name, table.where()});
    used_.push_back(false);
  }

  void read_embedded(const TomlTable& table) {
    const auto shape = read_shape<EmbeddedShape>(table);
    require_one_curve(table, "point");
    if (shape.point && shape.is_crack)
      refuse("{}: a point is no crack: expected a curve", table.where("crack"));
    located(table.where(), [&] {
      if (shape.point) return model_.points.push_back({in_plane(*shape.point), shape.name, table.where()});
      model_.curves.push_back({curve_of(shape.shape), shape.name, table.where(), shape.is_crack});
      used_.push_back(true);
    });
  }

  void read_loop(const TomlTable& table) {
    const auto loop = read_shape<LoopShape>(table);
    require_one(table, {"curves", "rectangle", "polygon", "circle"});
    if (loop.curves.empty()) return place(table, loop.closed, {0, 0}, table.where());
    if (table.has("boundary"))
      refuse(
          "{}: 'boundary' names the curves of a rectangle, polygon or circle: expected it, or 'name', at "
          "the curves themselves",
          table.where("boundary"));
    std::vector<int> curves;
    for (const std::string& name : loop.curves) {
      const auto at = named_.find(name);
      if (at == named_.end()) {
        std::vector<std::string> known;
        for (const auto& [other, index] : named_) known.push_back(other);
        refuse("{}: unknown curve '{}'{}", table.where("curves"), name, suggestion(name, known));
      }
      used_[at->second] = true;
      curves.push_back(static_cast<int>(at->second));
    }
    add_loop(table, std::move(curves), loop.closed, table.where());
  }

  void read_pattern(const TomlTable& table) {
    const auto pattern = read_shape<PatternShape>(table);
    require_one(table, {"rectangle", "polygon", "circle"});
    const auto [nx, ny] = pattern.count;
    if (nx < 1 || ny < 1 || static_cast<long long>(nx) * ny > kMostPatternLoops)
      refuse("{}: 'count' must be [nx, ny], two integers >= 1 whose product is at most {}",
             table.where("count"), kMostPatternLoops);
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        place(table, pattern.closed, {i * pattern.step.x, j * pattern.step.y},
              fmt::format("{} (copy {}, {})", table.where(), i + 1, j + 1));
  }

  PlanarModel finish() {
    for (const auto& [name, index] : named_)
      if (!used_[index])
        refuse("{}: no loop uses the curve '{}': remove it, or add 'crack = true' or a loop",
               model_.curves[index].where, name);
    return std::move(model_);
  }

 private:
  void place(const TomlTable& table, const ClosedShape& shape, Vec2 offset, const std::string& where) {
    const Curves curves = located(where, [&] { return curves_of(table, shape, offset); });
    const std::vector<std::string>& names = shape.boundary;
    if (names.size() > 1 && names.size() != curves.size())
      refuse("{}: {} boundary names for {} curves: expected one, or one for each", table.where("boundary"),
             names.size(), curves.size());
    std::vector<int> loop;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      loop.push_back(static_cast<int>(model_.curves.size()));
      model_.curves.push_back({curves[i], names.empty() ? "" : names[names.size() == 1 ? 0 : i], where});
      used_.push_back(true);
    }
    add_loop(table, std::move(loop), shape, where);
  }

  void add_loop(const TomlTable& table, std::vector<int> curves, const ClosedShape& shape,
                const std::string& where) {
    if (shape.is_hole && !shape.region.empty())
      refuse("{}: 'hole' and 'region' exclude each other: a region fills its loop", table.where("hole"));
    model_.loops.push_back({std::move(curves), shape.region, where, shape.is_hole});
  }

  PlanarModel model_;
  std::map<std::string, std::size_t> named_;
  std::vector<bool> used_;  // by a loop, for each curve
};

}  // namespace

bool has_planar_model(const TomlTable& table) {
  return table.has("curve") || table.has("loop") || table.has("pattern");
}

std::vector<EmbeddedLine> read_embedded_lines(const TomlTable& table) {
  std::vector<EmbeddedLine> lines;
  for (const TomlTable& one : table.tables("embed")) {
    const auto shape = read_shape<EmbeddedShape>(one);
    for (const TomlKey& key : keys_of<CurveShape>())
      if (key.name != "polyline" && one.has(key.name))
        refuse("{}: '{}' on a surface: expected one of polyline, point", one.where(key.name), key.name);
    require_one(one, {"polyline", "point"});
    lines.push_back({shape.point ? std::vector{*shape.point} : shape.shape.polyline, shape.name, one.where(),
                     shape.is_crack});
  }
  return lines;
}

PlanarModel read_planar_model(const TomlTable& table) {
  ModelReader reader(table.file().string());
  for (const TomlTable& curve : table.tables("curve")) reader.read_curve(curve);
  for (const TomlTable& loop : table.tables("loop")) reader.read_loop(loop);
  for (const TomlTable& pattern : table.tables("pattern")) reader.read_pattern(pattern);
  for (const TomlTable& embedded : table.tables("embed")) reader.read_embedded(embedded);
  PlanarModel model = reader.finish();
  if (model.loops.empty())
    refuse("{}: the model has no loops: expected 'loop', or curves that close", table.where());
  return model;
}

}  // namespace delquad
