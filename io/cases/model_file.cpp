#include "io/cases/model_file.h"

#include "base/box.h"
#include "delquad/fields.h"
#include "io/cases/outline_files.h"

#include <algorithm>
#include <functional>
#include <map>

#include "base/located.h"
#include "delquad/model.h"
#include "io/cases/read_described.h"
#include "io/cases/shapes.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

constexpr long long kMostPatternLoops = 1'000'000;

/// One curve of a loop's shape, wherever the loop is put.
using PlacedCurve = std::function<std::shared_ptr<const Curve>(Vec2 offset)>;

template <Described Shape>
Shape shape_of(const TomlTable& table, const std::string& key) {
  Shape shape{};
  read_described(table.table(key), shape);
  return shape;
}

std::string only_key(const TomlTable& table, const std::vector<std::string>& choices) {
  std::string list, found;
  for (const std::string& key : choices) {
    list += (list.empty() ? "" : ", ") + key;
    if (!table.has(key)) continue;
    if (!found.empty())
      refuse("{}: '{}' and '{}' exclude each other: expected one of {}", table.where(key), found, key, list);
    found = key;
  }
  if (!found.empty()) return found;
  throw InputError(table.where() + ": no shape: expected one of " + list);
}

std::vector<PlacedCurve> polygon(const std::vector<Vec2>& corners) {
  std::vector<PlacedCurve> sides;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    sides.push_back([a, b](Vec2 offset) { return make_segment(a + offset, b + offset); });
  }
  return sides;
}

std::vector<PlacedCurve> read_closed_shape(const TomlTable& table, const std::string& key) {
  if (key == "circle") {
    const auto [centre, radius] = shape_of<CircleShape>(table, key);
    return {[centre, radius](Vec2 offset) { return make_circle(centre + offset, radius); }};
  }
  const std::vector<Vec2> points = table.get<std::vector<Vec2>>(key);
  if (key == "polygon") {
    if (points.size() < 3) throw InputError(table.where(key) + ": a polygon has at least three corners");
    return polygon(points);
  }
  if (points.size() != 2) throw InputError(table.where(key) + ": 'rectangle' must be two opposite corners");
  const auto [low, high] = Box<Vec2>::around({points[0], points[1]});
  if (low.x == high.x || low.y == high.y) throw InputError(table.where(key) + ": the rectangle has no area");
  return polygon({low, {high.x, low.y}, high, {low.x, high.y}});
}

/// A name that becomes a physical group.
std::string group_name(const TomlTable& table, const std::string& key, std::string name) {
  if (!fits_msh(name))
    throw InputError(table.where(key) + ": '" + key +
                     "' is a name of a mesh file: expected one without double quotes and line breaks");
  return name;
}

/// `boundary`: one name for every curve, or one each.
std::vector<std::string> read_boundary_names(const TomlTable& table, std::size_t n_curves) {
  if (!table.has("boundary")) return std::vector<std::string>(n_curves);
  if (table.kind("boundary") == TomlKind::kText)
    return std::vector<std::string>(n_curves, group_name(table, "boundary", table.text("boundary")));
  const std::vector<std::string> names = table.texts("boundary");
  for (const std::string& name : names) group_name(table, "boundary", name);
  if (names.size() != n_curves)
    throw InputError(table.where("boundary") + ": " + std::to_string(names.size()) + " boundary names for " +
                     std::to_string(n_curves) + " curves: expected one, or one for each");
  return names;
}

/// What `region` and `hole` say of a loop's inside.
struct Inside {
  std::string region;
  bool is_hole;
};

Inside read_inside(const TomlTable& table) {
  const Inside inside{group_name(table, "region", table.text("region", "")), table.flag("hole", false)};
  if (inside.is_hole && !inside.region.empty())
    refuse("{}: 'hole' and 'region' exclude each other: a region fills its loop", table.where("hole"));
  return inside;
}

class ModelReader {
 public:
  explicit ModelReader(std::string source) { model_.source = std::move(source); }

  void read_curve(const TomlTable& table) {
    static const TomlKeys keys = curve_keys();
    table.require_known(keys);
    const std::string name = table.text("name");
    const std::string boundary_key = table.has("boundary") ? "boundary" : "name";
    const std::string boundary = group_name(table, boundary_key, table.text(boundary_key));
    if (!named_.emplace(name, model_.curves.size()).second)
      throw InputError(table.where("name") + ": a second curve '" + name + "'; names of curves must differ");
    const auto shape = located(table.where(), [&] { return read_shape(table); });
    table.finish(keys);
    model_.curves.push_back({shape, boundary, table.where()});
    used_.push_back(false);
  }

  void read_embedded(const TomlTable& table) {
    static const TomlKeys keys = embed_keys();
    table.require_known(keys);
    const std::string name = group_name(table, "name", table.text("name", ""));
    const bool is_crack = table.flag("crack", false);
    if (table.has("point")) {
      if (is_crack) throw InputError(table.where("crack") + ": a point is no crack: expected a curve");
      model_.points.push_back({table.get<Vec2>("point"), name, table.where()});
    } else {
      const auto shape = located(table.where(), [&] { return read_shape(table); });
      model_.curves.push_back({shape, name, table.where(), is_crack});
      used_.push_back(true);
    }
    table.finish(keys);
  }

  void read_loop(const TomlTable& table) {
    static const TomlKeys keys = loop_keys();
    table.require_known(keys);
    const std::string key = only_key(table, {"curves", "rectangle", "polygon", "circle"});
    const Inside inside = read_inside(table);
    if (key == "curves") {
      if (table.has("boundary"))
        throw InputError(table.where("boundary") +
                         ": 'boundary' names the curves of a rectangle, polygon or circle: expected it, or "
                         "'name', at the curves themselves");
      add_loop_of_curves(table, inside);
    } else {
      const auto shape = read_closed_shape(table, key);
      place(shape, read_boundary_names(table, shape.size()), inside, {0, 0}, table.where());
    }
    table.finish(keys);
  }

  void read_pattern(const TomlTable& table) {
    table.require_known(pattern_keys());
    const auto shape = read_closed_shape(table, only_key(table, {"rectangle", "polygon", "circle"}));
    const auto names = read_boundary_names(table, shape.size());
    const Inside inside = read_inside(table);
    const std::vector<double> count = table.numbers("count");
    const Vec2 step = table.get<Vec2>("step");
    table.finish(pattern_keys());
    const auto whole = [](double n) { return n >= 1 && n <= kMostPatternLoops && n == std::floor(n); };
    if (count.size() != 2 || !whole(count[0]) || !whole(count[1]) || count[0] * count[1] > kMostPatternLoops)
      refuse("{}: 'count' must be [nx, ny], two integers >= 1 whose product is at most {}",
             table.where("count"), kMostPatternLoops);
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) {
        const std::string where =
            table.where() + " (copy " + std::to_string(i + 1) + ", " + std::to_string(j + 1) + ")";
        place(shape, names, inside, {i * step.x, j * step.y}, where);
      }
  }

  PlanarModel finish() {
    for (const auto& [name, index] : named_)
      if (!used_[index]) refuse("{}: no loop uses the curve '{}'", model_.curves[index].where, name);
    return std::move(model_);
  }

 private:
  static std::shared_ptr<const Curve> read_shape(const TomlTable& table) {
    const std::string key = only_key(table, {"segment", "polyline", "spline", "arc", "circle", "expression"});
    if (key == "segment" || key == "polyline" || key == "spline") {
      const bool is_file = table.kind(key) == TomlKind::kText;
      const std::vector<Vec2> points =
          is_file ? located(table.where(key),
                            [&] { return read_points(table.file().parent_path() / table.text(key)); })
                  : table.get<std::vector<Vec2>>(key);
      if (key == "polyline") return make_polyline(points);
      if (key == "spline") return make_spline(points);
      if (points.size() != 2) throw InputError("'segment' must be two points");
      return make_segment(points[0], points[1]);
    }
    if (key == "arc") {
      const auto arc = shape_of<ArcShape>(table, key);
      return make_arc(arc.circle.centre, arc.circle.radius, arc.from, arc.to);
    }
    if (key == "circle") {
      const auto circle = shape_of<CircleShape>(table, key);
      return make_circle(circle.centre, circle.radius);
    }
    const auto curve = shape_of<ExpressionShape>(table, key);
    return make_expression_curve(curve.x, curve.y, curve.from, curve.to);
  }

  void add_loop_of_curves(const TomlTable& table, const Inside& inside) {
    ModelLoop loop{{}, inside.region, table.where()};
    for (const std::string& name : table.texts("curves")) {
      const auto at = named_.find(name);
      if (at == named_.end()) {
        std::vector<std::string> known;
        for (const auto& [other, index] : named_) known.push_back(other);
        throw InputError(table.where("curves") + ": unknown curve '" + name + "'" + suggestion(name, known));
      }
      used_[at->second] = true;
      loop.curves.push_back(static_cast<int>(at->second));
    }
    if (loop.curves.empty()) throw InputError(table.where("curves") + ": the loop has no curves");
    add_loop(std::move(loop), inside);
  }

  void place(const std::vector<PlacedCurve>& shape, const std::vector<std::string>& names,
             const Inside& inside, Vec2 offset, const std::string& where) {
    ModelLoop loop{{}, inside.region, where};
    for (std::size_t i = 0; i < shape.size(); ++i) {
      loop.curves.push_back(static_cast<int>(model_.curves.size()));
      model_.curves.push_back({located(where, [&] { return shape[i](offset); }), names[i], where});
      used_.push_back(true);
    }
    add_loop(std::move(loop), inside);
  }

  void add_loop(ModelLoop loop, const Inside& inside) {
    loop.is_hole = inside.is_hole;
    model_.loops.push_back(std::move(loop));
  }

  PlanarModel model_;
  std::map<std::string, std::size_t> named_;
  std::vector<bool> used_;  // by a loop, for each curve
};

}  // namespace

bool has_planar_model(const TomlTable& table) {
  bool found = false;  // every key is asked for, so that all of them are known to finish()
  for (const char* key : {"curve", "loop", "pattern"}) found = table.has(key) || found;
  return found;
}

std::vector<EmbeddedLine> read_embedded_lines(const TomlTable& table) {
  std::vector<EmbeddedLine> lines;
  for (const TomlTable& embedded : table.tables("embed")) {
    embedded.require_known(embed_keys());
    EmbeddedLine line{{}, group_name(embedded, "name", embedded.text("name", "")), embedded.where()};
    const std::string key = only_key(embedded, {"polyline", "point"});
    if (key == "point")
      line.points = {embedded.get<Vec3>(key)};
    else if (line.points = embedded.get<std::vector<Vec3>>(key); line.points.size() < 2)
      throw InputError(embedded.where(key) + ": a polyline has two points or more");
    embedded.finish(embed_keys());
    lines.push_back(std::move(line));
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
  if (model.loops.empty()) throw InputError(table.where() + ": the model has no loops");
  return model;
}

}  // namespace delquad
