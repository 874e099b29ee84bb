#include "cases/problem.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>

#include "base/activity.h"
#include "base/located.h"
#include "base/nearest_name.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "cases/formulas.h"
#include "cases/located_fields.h"
#include "cases/size_file.h"
#include "delquad/error.h"
#include "fields/fields.h"
#include "geometry/planar/boundary_report.h"
#include "geometry/planar/planar_model.h"
#include "io/formats/msh.h"
#include "io/mesh_io.h"
#include "mesher/refine_unsound.h"
#include "mesher/surface_input.h"

namespace delquad {
namespace {

const std::set<std::string> kCadFiles = {".step", ".stp", ".iges", ".igs", ".brep"};
const std::set<std::string> kTriangleFiles = {".stl", ".obj", ".off", ".ply", ".3mf"};

constexpr const char* kFromBoundary = "boundary";
constexpr const char* kFromGradient = "gradient";
constexpr const char* kSizeAware = "size-aware";

/// Reads a formula in whose place one of `words` could stand: it may be one of them, misspelt.
template <class F>
auto formula_or_word(const std::string& text, const std::vector<std::string>& words, F&& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(error.what() + suggestion(text, words));
  }
}

/// A number, an expression or a file as a field.
std::shared_ptr<const SizeField> make_field(const SizeText& size) {
  const std::string &text = size.base, &where = size.where;
  if (text.empty()) throw InputError(where + ": the size is empty: expected a number or an expression");
  if (const auto number = as_number(text)) {
    if (!(*number > 0) || *number > std::numeric_limits<double>::max())
      throw InputError(where + ": size " + text + ": expected a finite number > 0");
    return make_constant_size(*number);
  }
  if (const auto file = size_file_of(text, size.folder))
    return located(where, [&] { return std::shared_ptr<const SizeField>(make_file_size(*file)); });
  return located(where, [&] {
    return std::make_shared<LocatedSize>(
        formula_or_word(text, {kFromBoundary}, [&] { return make_expression_size(text); }), where);
  });
}

SizeSpec make_size(const Case& c) {
  const SizeText& text = c.size;
  SizeSpec size;
  size.where = text.where.empty() ? c.where : text.where;
  size.from_boundary = text.base == kFromBoundary;
  if (!size.from_boundary && !text.base.empty()) size.field = make_field(text);
  size.sources = text.sources;
  size.named = text.named;
  size.gradation = text.gradation;
  size.curvature = text.curvature;
  size.min = text.min;
  size.max = text.max;
  return size;
}

CrossSpec make_cross(const CrossText& text) {
  CrossSpec cross;
  cross.where = text.where;
  if (text.text == kFromBoundary) return cross;
  if (text.text == kSizeAware) return cross.kind = CrossKind::kSizeAware, cross;
  if (text.text == kFromGradient) return cross.kind = CrossKind::kGradient, cross;
  cross.kind = CrossKind::kField;
  cross.field = located(text.where, [&] {
    return std::make_shared<LocatedCross>(
        formula_or_word(text.text, {kFromBoundary, kFromGradient, kSizeAware},
                        [&] { return make_expression_cross(text.text); }),
        text.where);
  });
  return cross;
}

TriangleModel read_triangles(const Case& c) {
  return located(c.where, [&] {
    TriangleModel model{{}, c.surface_file.string()};
    model.mesh = read_mesh(c.surface_file, &model.notes, c.keep_going ? Strays::kKept : Strays::kRefused);
    return model;
  });
}

/// A file of lines, or of triangles or quads in space.
Model read_msh_model(const Case& c) {
  LineModel lines{{}, {}, c.mesh_file.string()};
  lines.mesh = located(c.where, [&] { return read_msh(c.mesh_file, &lines.surfaces); });
  if (holds_surface(lines.mesh)) return TriangleModel{std::move(lines.mesh), lines.source};
  return lines;
}

GivenMesh read_given_mesh(const Case& c) {
  return located(c.where, [&] {
    GivenMesh given{{}, c.mesh_file.string()};
    given.mesh = read_mesh(c.mesh_file, &given.notes);
    return given;
  });
}

Model read_model(const Case& c) {
  const DoingStage stage("reading");
  if (c.start) return read_given_mesh(c);
  if (!c.example.empty()) return ExampleModel{c.example};
  if (kCadFiles.count(kind_of_file(c.surface_file)) > 0) return CadModel{c.surface_file};
  if (!c.surface_file.empty()) return read_triangles(c);
  if (c.model) return *c.model;
  return read_msh_model(c);
}

}  // namespace

bool is_surface_file(const std::filesystem::path& path) {
  return kCadFiles.count(kind_of_file(path)) + kTriangleFiles.count(kind_of_file(path)) > 0;
}

std::string surface_files() {
  return fmt::format("{}, {}", fmt::join(kCadFiles, ", "), fmt::join(kTriangleFiles, ", "));
}

std::string text_of(CrossKind kind) {
  switch (kind) {
    case CrossKind::kBoundary:
      return kFromBoundary;
    case CrossKind::kSizeAware:
      return kSizeAware;
    case CrossKind::kGradient:
      return kFromGradient;
    case CrossKind::kField:
      break;
  }
  return "angle";
}

MeshProblem make_problem(const Case& c) {
  MeshProblem problem;
  problem.name = c.name;
  problem.where = c.where;
  problem.model = read_model(c);
  problem.surface = c.surface;
  problem.layers = c.layers;
  problem.size = make_size(c);
  problem.divisions = c.divisions;
  problem.periodic = c.periodic;
  problem.mapped = c.mapped;
  problem.symmetry = c.symmetry;
  problem.cross = make_cross(c.cross);
  problem.seed = c.seed;
  problem.order = c.order;
  problem.options = c.options;
  problem.max_elements = c.max_elements;
  problem.keep_going = c.keep_going;
  return problem;
}

void check_case(const Case& c) {
  if (const auto& file = model_path(c); !c.may_be_absent && !file.empty() && !std::filesystem::exists(file))
    throw InputError(fmt::format("{}: case '{}': there is no file '{}'", c.where, c.name, file.string()));
  make_size(c);
  make_cross(c.cross);
}

PreparedProblem prepare_case(const Case& c, const Refinement& refinement) {
  const Stopwatch reading;
  const MeshProblem problem = make_problem(c);
  const TimeSpent time = reading.time();
  PreparedProblem prepared = prepare(problem, refinement);
  StepTimes& times = prepared.times;
  if (times.empty() || times.front().first != "read") times.insert(times.begin(), {"read", {}});
  times.front().second = times.front().second + time;
  return prepared;
}

RunResult run_case(const Case& c, const Word& word, PreparedProblem& prepared,
                   const std::function<void(const std::string& stage)>& begins) {
  RunResult result = run_word(prepared, word, begins);
  refine_unsound([&](const Refinement& r) { return prepare_case(c, r); }, word, prepared, result);
  return result;
}

std::shared_ptr<const SizeField> size_of_mesh(const Mesh& mesh, const std::string& text) {
  if (text != kFromBoundary) return make_field({.base = text, .where = "--size"});
  const PlanarDomain domain = make_domain(outline(mesh), {"boundary of the mesh", {}});
  return make_boundary_size(std::make_shared<BackgroundMesh>(domain.patches), domain.boundary);
}

}  // namespace delquad
