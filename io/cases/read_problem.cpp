// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/read_problem.h"

#include "geometry/mesh/model_kind.h"
#include "io/cases/outline_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "algorithms/fields/added_fields.h"
#include "algorithms/fields/fields.h"
#include "base/activity.h"
#include "base/added_parts.h"
#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "delquad/error.h"
#include "delquad/fields.h"
#include "delquad/model.h"
#include "geometry/mesh/outline.h"
#include "geometry/mesh/weld.h"
#include "geometry/planar/defined_curve.h"
#include "geometry/planar/model_chain.h"
#include "geometry/planar/planar_model.h"
#include "io/cases/expression.h"
#include "io/formats/msh.h"
#include "io/gdal/gdal_files.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

const std::set<std::string> kCadFiles = {".step", ".stp", ".iges", ".igs", ".brep"};
const std::set<std::string> kTriangleFiles = {".stl", ".obj", ".off", ".ply", ".3mf"};

constexpr const char* kFromBoundary = "boundary";

/// How people write kinds of crosses, from kBoundary to kGradient.
const std::vector<std::string> kCrosses = {kFromBoundary, "size-aware", "metric", "gradient"};

const std::vector<std::string> kPlane = {"x", "y"};

/// A field whose errors say where it was written.
template <class Field, class Point, class Value>
class Located final : public Field {
 public:
  Located(std::shared_ptr<const Field> base, std::string where)
      : base_(std::move(base)), where_(std::move(where)) {}
  Value at(Point x, int& hint) const override {
    return located(where_, [&] { return base_->at(x, hint); });
  }

 private:
  std::shared_ptr<const Field> base_;
  std::string where_;
};

/// These and the names of parts from outside.
template <class Part>
std::vector<std::string> known_words(std::vector<std::string> words, const AddedParts<Part>& parts) {
  const std::vector<std::string> added = parts.names();
  words.insert(words.end(), added.begin(), added.end());
  return words;
}

/// Reads a formula in whose place one of `words` could stand: it may be one of them, misspelt.
template <class F>
auto formula_or_word(const std::string& text, const std::vector<std::string>& words, F&& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(error.what() + suggestion(text, words));
  }
}

/// A formula of the place and the value of a raster there, which is in `crs`, where that is known.
std::function<double(const Vec3&)> raster_function(const SizeFile& file, const std::string& crs) {
  const Expression formula(file.field.empty() ? "value" : file.field, {"x", "y", "z", "value"});
  const auto raster = std::make_shared<const Raster>(read_raster(file.path, crs));
  return [formula, raster, path = file.path.string()](const Vec3& x) {
    const Vec2 p{x.x, x.y};
    if (!raster->grid.covers(p))
      refuse("{}: the raster does not cover {} [no-raster-data]", path, show_point(p));
    const double values[] = {x.x, x.y, x.z, raster->at(p)};
    if (std::isnan(values[3]))
      refuse("{}: the raster has no data around {} [no-raster-data]", path, show_point(p));
    return formula(values);
  };
}

std::shared_ptr<const SizeField> make_raster_size(const SizeFile& file, const std::string& crs) {
  return make_function_size(
      raster_function(file, crs),
      fmt::format("size field '{}' of {}", file.field.empty() ? "value" : file.field, file.path.string()));
}

/// A number, an expression or a file as a field, in the coordinate system `crs`, where that is known.
std::shared_ptr<const SizeField> make_field(const SizeSpec& size, const std::string& crs = {}) {
  const std::string &text = size.text, &where = size.where;
  if (const auto number = as_number(text)) {
    if (!(*number > 0) || *number > std::numeric_limits<double>::max())
      throw InputError(where + ": size " + text + ": expected a finite number > 0 [bad-size]");
    return make_constant_size(*number);
  }
  if (const auto file = size_file_of(text, size.folder))
    return located(where, [&]() -> std::shared_ptr<const SizeField> {
      if (is_raster_file(file->path)) return make_raster_size(*file, crs);
      return make_file_size(file->path, file->field);
    });
  return located(where, [&] {
    return std::make_shared<Located<SizeField, const Vec3&, double>>(
        formula_or_word(text, known_words({kFromBoundary}, added_sizes()),
                        [&] { return make_expression_size(text); }),
        where);
  });
}

void read_size(SizeSpec& size, const Options& options, const std::string& crs) {
  if (size.text.empty() || size.field || size.function || size.from_boundary) return;
  if (const auto* fill = added_sizes().find(size.text)) {
    located(size.where, [&] { (*fill)(options, size); });
    if (!size.field && !size.function) throw Error(size.where + ": '" + size.text + "' made no size");
    return;
  }
  size.from_boundary = size.text == kFromBoundary;
  if (!size.from_boundary) size.field = make_field(size, crs);
}

/// Step of second differences of a solution that is known as a formula, in diagonals of the domain. It is far
/// below the resolution of a mesh and far above rounding.
constexpr double kHessianStep = 5e-5;

double hessian_step(const Model& model) {
  constexpr int kChords = 64;  // a curve
  const auto* planar = std::get_if<PlanarModel>(&model);
  if (planar == nullptr || planar->curves.empty()) return kHessianStep;
  const Box<Vec2> box = box_of(*planar, kChords);
  return kHessianStep * norm(box.high - box.low);
}

SizeFile file_of_metric(const MetricSpec& metric) {
  const auto file = size_file_of(metric.file, metric.folder);
  if (!file)
    throw InputError("the metric '" + metric.file +
                     "': expected FILE or FILE:FIELD, .msh, .vtu, .sol, .mtr or .metric");
  return *file;
}

void read_surface_metric(MetricSpec& metric) {
  if (metric.in_space || metric.chord > 0) return;
  metric.in_space = located(metric.where, [&]() -> SpaceMetricFunction {
    if (metric.tensor.size() == 6) {
      std::array<std::string, 6> formulas;
      std::ranges::copy(metric.tensor, formulas.begin());
      return make_expression_space_metric(formulas);
    }
    if (metric.file.empty())
      throw InputError(
          "a metric of a surface: expected 'chord', a 'file' or a 'tensor' of m11, m12, m13, m22, m23 and "
          "m33");
    const SizeFile file = file_of_metric(metric);
    return make_file_space_metric(file.path, file.field);
  });
}

void read_metric(const Model& model, MetricSpec& metric) {
  if (metric.function || !metric.asks()) return;
  if (!kind_of(model).in_plane) return read_surface_metric(metric);
  metric.function = located(metric.where, [&]() -> MetricFunction {
    if (metric.in_space || metric.chord > 0)
      throw InputError("a chord and tensors in space are for surfaces, and this is a planar domain");
    if (!metric.tensor.empty() && metric.tensor.size() != 3)
      throw InputError(
          fmt::format("a tensor of {} formulas: expected m11, m12 and m22", metric.tensor.size()));
    if (!metric.tensor.empty())
      return make_expression_metric({metric.tensor[0], metric.tensor[1], metric.tensor[2]});
    if (!metric.sizes.empty() && metric.sizes.size() != 2 && metric.sizes.size() != 3)
      throw InputError(
          fmt::format("{} sizes: expected h1, h2 and, if it is not 0, theta", metric.sizes.size()));
    if (!metric.sizes.empty())
      return make_sizes_metric(metric.sizes[0], metric.sizes[1],
                               metric.sizes.size() == 3 ? metric.sizes[2] : "0");
    if (!metric.solution.empty()) return make_solution_metric(metric.solution, hessian_step(model));
    const SizeFile file = file_of_metric(metric);
    return make_file_metric(file.path, file.field);
  });
}

void read_cross(CrossSpec& cross, const Options& options) {
  if (cross.text.empty() || cross.kind) return;
  if (const auto word = std::ranges::find(kCrosses, cross.text); word != kCrosses.end()) {
    cross.kind = static_cast<CrossKind>(word - kCrosses.begin());
    return;
  }
  if (const auto* fill = added_crosses().find(cross.text)) {
    located(cross.where, [&] { (*fill)(options, cross); });
    if (!cross.kind) throw Error(cross.where + ": '" + cross.text + "' made no cross field");
    return;
  }
  cross.kind = CrossKind::kField;
  cross.field = located(cross.where, [&] {
    return std::make_shared<Located<CrossField, Vec2, Cross>>(
        formula_or_word(cross.text, known_words(kCrosses, added_crosses()),
                        [&] { return make_expression_cross(cross.text); }),
        cross.where);
  });
}

/// A file of lines, or of triangles or quads in space.
Model read_msh_model(const std::filesystem::path& path) {
  LineModel lines{{}, {}, path.string()};
  lines.mesh = read_msh(path, &lines.surfaces);
  if (holds_surface(lines.mesh)) return TriangleModel{std::move(lines.mesh), lines.source};
  return lines;
}

/// With the coordinate system of outlines, or the unit of a drawing, where that is known.
Model read_model(const ModelFile& file, const MeshProblem& problem, std::string& crs, std::string& unit) {
  const StageScope stage("reading");
  const std::string kind = kind_of_file(file.path);
  if (file.given) {
    GivenMesh given{{}, file.path.string()};
    given.mesh = read_given_mesh(file.path, &given.notes);
    if (std::string torn = describe_unjoined(given.mesh); !torn.empty() && !problem.surface.weld_tolerance)
      given.notes.push_back(std::move(torn));
    return given;
  }
  if (const auto outlines = outline_file_of(file.path)) return read_outlines(*outlines, crs, unit);
  if (kCadFiles.count(kind) > 0) return CadModel{file.path};
  if (kTriangleFiles.count(kind) == 0) return read_msh_model(file.path);
  TriangleModel triangles{{}, file.path.string()};
  triangles.mesh =
      read_mesh(file.path, &triangles.notes, problem.keep_going ? Strays::kKept : Strays::kRefused);
  return triangles;
}

}  // namespace

bool is_surface_file(const std::filesystem::path& path) {
  return kCadFiles.count(kind_of_file(path)) + kTriangleFiles.count(kind_of_file(path)) > 0;
}

std::string surface_files() {
  return fmt::format("{}, {}", fmt::join(kCadFiles, ", "), fmt::join(kTriangleFiles, ", "));
}

std::string text_of(const CrossSpec& cross) {
  if (!cross.text.empty()) return cross.text;
  const auto kind = static_cast<std::size_t>(cross.kind.value_or(CrossKind::kBoundary));
  return kind < kCrosses.size() ? kCrosses[kind] : "angle";
}

MeshProblem read_files(MeshProblem problem) {
  std::string crs;
  if (const auto* file = std::get_if<ModelFile>(&problem.model))
    problem.model =
        located(problem.where, [&] { return read_model(*file, problem, crs, problem.surface.unit); });
  if (auto* given = std::get_if<GivenMesh>(&problem.model); given && problem.surface.weld_tolerance) {
    const double tolerance = *problem.surface.weld_tolerance * diagonal(given->mesh);
    if (std::string welded = weld_open_edges(given->mesh, tolerance); !welded.empty())
      given->notes.push_back(std::move(welded));
    problem.surface.weld_tolerance.reset();  // it is done
  }
  if (problem.size.where.empty()) problem.size.where = problem.where;
  read_size(problem.size, problem.options, crs);
  read_metric(problem.model, problem.metric);
  read_cross(problem.cross, problem.options);
  return problem;
}

void check_case(const Case& c) {
  if (const auto file = model_path(c); !c.may_be_absent && !file.empty() && !std::filesystem::exists(file))
    refuse("{}: case '{}': there is no file '{}': expected its path from the folder of this file", c.where,
           c.name, file.string());
  MeshProblem fields;
  fields.size = c.size;
  fields.cross = c.cross;
  // The model is not read here, and the content of some files alone tells whether they are a surface.
  const auto* model = std::get_if<ModelFile>(&c.model);
  if (model && is_surface_file(model->path)) fields.model = TriangleModel{};
  if (!model) fields.model = c.model;
  if (!model || is_surface_file(model->path)) fields.metric = c.metric;
  read_files(fields);
}

std::function<double(const Vec3&)> read_depths(const std::string& text, const Model& model) {
  return located("--depth", [&]() -> std::function<double(const Vec3&)> {
    const auto raster = size_file_of(text, "");
    if (!raster || !is_raster_file(raster->path))
      refuse("'{}' is no raster: expected FILE or \"FILE: FORMULA\" in value, such as \"dem.tif: -value\"",
             text);
    std::string crs, unit;
    const auto* file = std::get_if<ModelFile>(&model);
    if (const auto outlines = file != nullptr ? outline_file_of(file->path) : std::nullopt)
      read_outlines(*outlines, crs, unit);
    return raster_function(*raster, crs);
  });
}

std::shared_ptr<const SizeField> size_of_mesh(const Mesh& mesh, const std::string& text) {
  if (text.empty()) throw InputError("--size: the size is empty: expected a number or an expression");
  if (text != kFromBoundary) return make_field({.text = text, .where = "--size"});
  const PlanarDomain domain = make_domain(outline(mesh), "boundary of the mesh");
  return make_boundary_size(std::make_shared<BackgroundMesh>(domain.patches), domain.boundary);
}

std::optional<SizeFile> size_file_of(const std::string& text, const std::filesystem::path& folder) {
  const auto is_file = [](const std::string& name) { return holds_values(name) || is_raster_file(name); };
  if (is_file(text)) return SizeFile{folder / text, ""};
  for (std::size_t at = text.find(':'); at != std::string::npos; at = text.find(':', at + 1))
    if (const std::string file = text.substr(0, at); is_file(file))
      return SizeFile{folder / file, std::string(trimmed(text.substr(at + 1)))};
  return std::nullopt;
}

std::unique_ptr<SizeField> make_file_size(const std::filesystem::path& file, const std::string& field) {
  NodalValues size = read_values(file, field);
  return located(file.string(), [&] { return make_nodal_size(size.mesh, std::move(size.values)); });
}

std::unique_ptr<SizeField> make_expression_size(const std::string& text) {
  const Expression delta(text, {"x", "y", "z"});
  return make_function_size(
      [delta](const Vec3& x) {
        const double values[] = {x.x, x.y, x.z};
        return delta(values);
      },
      fmt::format("size field '{}'", delta.shown()));
}

std::unique_ptr<CrossField> make_expression_cross(const std::string& text) {
  const Expression theta(text, {"x", "y", "z"});
  return make_function_cross(
      [theta](Vec2 u) {
        const double values[] = {u.x, u.y, 0};
        return theta(values);
      },
      fmt::format("cross field '{}'", theta.shown()));
}

MetricFunction make_expression_metric(const std::array<std::string, 3>& tensor) {
  std::vector<Expression> m;
  for (const std::string& text : tensor) m.emplace_back(text, kPlane);
  return [m](std::span<const Vec2> points, std::span<Tensor2> metric) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double at[] = {points[i].x, points[i].y};
      metric[i] = {m[0](at), m[1](at), m[2](at)};
    }
  };
}

SpaceMetricFunction make_expression_space_metric(const std::array<std::string, 6>& tensor) {
  std::vector<Expression> m;
  for (const std::string& text : tensor) m.emplace_back(text, std::vector<std::string>{"x", "y", "z"});
  return [m](std::span<const Vec3> points, std::span<Tensor3> metric) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double at[] = {points[i].x, points[i].y, points[i].z};
      metric[i] = {m[0](at), m[1](at), m[2](at), m[3](at), m[4](at), m[5](at)};
    }
  };
}

MetricFunction make_sizes_metric(const std::string& h1, const std::string& h2, const std::string& theta) {
  const Expression along(h1, kPlane), across(h2, kPlane), angle(theta, kPlane);
  return [along, across, angle](std::span<const Vec2> points, std::span<Tensor2> metric) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double at[] = {points[i].x, points[i].y};
      const MetricAxes axes{along(at), across(at), angle(at)};
      if (!(axes.h1 > 0) || !(axes.h2 > 0) || !std::isfinite(axes.h1 + axes.h2 + axes.theta))
        throw InputError(fmt::format("h1 is {}, h2 {} and theta {} at {}: expected finite lengths > 0",
                                     axes.h1, axes.h2, axes.theta, show_point(points[i])));
      metric[i] = tensor_of(axes);
    }
  };
}

SpaceMetricFunction make_file_space_metric(const std::filesystem::path& file, const std::string& field) {
  const NodalValues tensors = read_tensors(file, field);
  std::vector<Tensor3> metric;
  const std::vector<double>& m = tensors.values;
  for (std::size_t i = 0; i + 5 < m.size(); i += 6)
    metric.push_back({m[i], m[i + 1], m[i + 2], m[i + 3], m[i + 4], m[i + 5]});
  return located(file.string(), [&] { return make_nodal_space_metric(tensors.mesh, std::move(metric)); });
}

MetricFunction make_file_metric(const std::filesystem::path& file, const std::string& field) {
  const NodalValues tensors = read_tensors(file, field);
  std::vector<Tensor2> metric;
  const std::vector<double>& m = tensors.values;
  for (std::size_t i = 0; i + 5 < m.size(); i += 6) metric.push_back({m[i], m[i + 1], m[i + 3]});
  return located(file.string(), [&] { return make_nodal_metric(tensors.mesh, std::move(metric)); });
}

MetricFunction make_solution_metric(const std::string& solution, double step) {
  const Expression u(solution, kPlane);
  return [u, step](std::span<const Vec2> points, std::span<Tensor2> metric) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto value = [&](int a, int b) {
        const double at[] = {points[i].x + a * step, points[i].y + b * step};
        return u(at);
      };
      const double here = value(0, 0), h2 = step * step;
      metric[i] = l2_metric({(value(1, 0) - 2 * here + value(-1, 0)) / h2,
                             (value(1, 1) - value(1, -1) - value(-1, 1) + value(-1, -1)) / (4 * h2),
                             (value(0, 1) - 2 * here + value(0, -1)) / h2});
    }
  };
}

namespace {

class ExpressionCurve final : public DefinedCurve {
 public:
  ExpressionCurve(std::shared_ptr<const Curve> curve, std::string definition)
      : curve_(std::move(curve)), definition_(std::move(definition)) {}
  Vec2 point(double t) const override { return curve_->point(t); }
  std::string definition() const override { return definition_; }

 private:
  std::shared_ptr<const Curve> curve_;
  std::string definition_;
};

}  // namespace

std::shared_ptr<const Curve> make_expression_curve(const std::string& x_text, const std::string& y_text,
                                                   double t0, double t1) {
  const Expression x(x_text, {"t"}), y(y_text, {"t"});
  const auto point = [x, y](double t) {
    const double value[] = {t};
    return Vec2{x(value), y(value)};
  };
  return std::make_shared<ExpressionCurve>(
      make_parametric_curve(point, t0, t1),
      fmt::format("'{}' '{}' from {:a} to {:a}", x_text, y_text, t0, t1));
}

}  // namespace delquad
