#include "pipeline/case_file.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "cad/example_models.h"
#include "io/mesh_io.h"
#include "pipeline/case_keys.h"
#include "pipeline/located.h"
#include "pipeline/model_file.h"
#include "pipeline/prepare_surface.h"

namespace delquad {
namespace {

double number_at_least(const TomlTable& table, const std::string& key, double least, double absent) {
  const double value = table.number(key, absent);
  if (table.has(key) && value < least)
    throw InputError(
        fmt::format("{}: '{}' is {}: expected at least {}", table.where(key), key, value, least));
  return value;
}

/// In (0, most] or [least, most]: `least` 0 is left out itself.
double number_between(const TomlTable& table, const std::string& key, double least, double most,
                      double absent) {
  const double value = table.number(key, absent);
  if (!table.has(key) || (value > 0 && value >= least && value <= most)) return value;
  throw InputError(fmt::format("{}: '{}' is {}: expected {} {} and at most {}", table.where(key), key, value,
                               least > 0 ? "at least" : "above", least, most));
}

/// A whole number between `least` and `most`.
long long integer_between(const TomlTable& table, const std::string& key, long long least, long long most,
                          long long absent) {
  if (!table.has(key)) return absent;
  const long long value = table.integer(key);
  if (value >= least && value <= most) return value;
  throw InputError(
      fmt::format("{}: '{}' is {}: expected {} to {}", table.where(key), key, value, least, most));
}

void read_cleanup(const TomlTable& table, CleanupOptions& options) {
  options.rounds = static_cast<int>(integer_between(table, "rounds", 0, 1'000'000, options.rounds));
  options.tolerance = number_between(table, "tolerance", 0, 1, options.tolerance);
  constexpr long long kMostSeed = std::numeric_limits<long long>::max();
  options.seed = integer_between(table, "seed", 0, kMostSeed, options.seed);
  table.finish(cleanup_keys());
}

void read_optimisation(const TomlTable& table, OptimisationOptions& options) {
  options.passes = static_cast<int>(integer_between(table, "passes", 0, 1000, options.passes));
  options.iterations = static_cast<int>(integer_between(table, "iterations", 1, 100'000, options.iterations));
  options.size = number_at_least(table, "size", 0, options.size);
  options.alignment = number_at_least(table, "alignment", 0, options.alignment);
  table.finish(optimisation_keys());
}

void read_repair(const TomlTable& table, RepairOptions& options) {
  options.part_twins = table.flag("part_twins", options.part_twins);
  options.lift_bad_quads = table.flag("lift_bad_quads", options.lift_bad_quads);
  table.finish(repair_keys());
}

SizeSource read_source(const TomlTable& table) {
  const Vec3 at = table.space_point("at");
  SizeSource source{at,
                    table.has("to") ? table.space_point("to") : at,
                    table.positive_number("near"),
                    table.positive_number("far"),
                    number_at_least(table, "radius_near", 0, 0),
                    table.positive_number("radius_far")};
  if (source.radius_far <= source.radius_near)
    throw InputError(table.where("radius_far") + ": 'radius_far' must be larger than 'radius_near'");
  table.finish(source_keys());
  return source;
}

}  // namespace

void check_size_limits(const SizeSpec& size) {
  if (size.min > 0 && !(size.curvature > 0))
    throw InputError(size.where +
                     ": a least size is for sizes that follow curvature: expected 'curvature' too");
  if (size.min > 0 && size.max > 0 && size.min > size.max)
    throw InputError(
        fmt::format("{}: the least size {} is larger than the largest, {}", size.where, size.min, size.max));
}

namespace {

SizeSpec read_size(const TomlTable& table) {
  SizeSpec size;
  size.where = table.where("size");
  if (table.kind("size") != TomlKind::kTable) {
    size.base = table.expression("size");
    return size;
  }
  const TomlTable fields = table.table("size");
  if (fields.has("base")) size.base = fields.expression("base");
  for (const TomlTable& source : fields.tables("source")) size.sources.push_back(read_source(source));
  if (fields.has("gradation")) size.gradation = fields.positive_number("gradation");
  size.curvature = number_at_least(fields, "curvature", kLeastPerTurn, 0);
  if (fields.has("min")) size.min = fields.positive_number("min");
  if (fields.has("max")) size.max = fields.positive_number("max");
  fields.finish(size_keys());
  check_size_limits(size);
  return size;
}

void read_insertion(const TomlTable& table, MeshingOptions& options) {
  FrontalOptions& frontal = options.frontal;
  // Outside of these ranges the front never ends, or nothing can be inserted.
  frontal.h_max = number_between(table, "h_max", 1.1, 3, frontal.h_max);
  frontal.rejection = number_between(table, "rejection", 0, 0.95, frontal.rejection);
  frontal.boundary_height = number_between(table, "boundary_height", 0, 0.95, frontal.boundary_height);
  options.linf.lower_clamp = table.flag("lower_clamp", options.linf.lower_clamp);
  table.finish(insertion_keys());
}

void read_recombination(const TomlTable& table, MeshingOptions& options) {
  if (table.has("treatment")) {
    const std::string text = table.text("treatment");
    if (text != "none" && text != "paper")
      throw InputError(table.where("treatment") + ": 'treatment' is '" + text +
                       "': expected \"none\" or \"paper\"");
    options.treatment = text == "none" ? Treatment::kNone : Treatment::kPaper;
  }
  if (table.has("max_rounds")) {
    const long long rounds = table.integer("max_rounds");
    if (rounds < 0 || rounds > 1'000'000)
      throw InputError(table.where("max_rounds") + ": 'max_rounds' must lie between 0 and 1000000");
    options.treatment_options.max_rounds = static_cast<int>(rounds);
  }
  table.finish(recombination_keys());
}

void drop_model(Case& target) {
  target.model.reset();
  target.holes.clear();
  target.mesh_file.clear();
  target.surface_file.clear();
  target.example.clear();
  target.may_be_absent = false;
}

/// A file of lines, triangles or CAD as the case's model, if its extension says so.
bool set_model_file(const std::filesystem::path& file, Case& target) {
  drop_model(target);
  const bool is_msh = kind_of_file(file) == ".msh";
  if (!is_msh && !is_surface_file(file)) return false;
  (is_msh ? target.mesh_file : target.surface_file) = file;
  return true;
}

void read_data(const TomlTable& table, Case& target) {
  if (target.data_folder.empty())
    throw InputError(table.where("data") + ": 'data' is for cases of experiments: expected 'model'");
  const std::filesystem::path file = target.data_folder / table.text("data");
  if (!set_model_file(file, target))
    throw InputError(table.where("data") + ": '" + file.string() +
                     "' is no data: expected a .msh, .step, .stp, .brep, .stl, .obj or .off file");
  target.may_be_absent = true;
}

/// An integer key between `least` and `most`.
void read_count(const TomlTable& table, const std::string& key, long long least, long long most, int& value) {
  if (!table.has(key)) return;
  const long long count = table.integer(key);
  if (count < least || count > most)
    throw InputError(
        fmt::format("{}: '{}' is {}: expected {} to {}", table.where(key), key, count, least, most));
  value = static_cast<int>(count);
}

void read_smoothing(const TomlTable& table, MeshingOptions& options) {
  SmoothingOptions& smoothing = options.smoothing_options;
  if (table.has("method")) {
    const std::string text = table.text("method");
    if (text != "lpcvt" && text != "lloyd")
      throw InputError(table.where("method") + ": 'method' is '" + text +
                       "': expected \"lpcvt\" or \"lloyd\"");
    options.smoothing = text == "lpcvt" ? SmoothingMethod::kLpCvt : SmoothingMethod::kLloyd;
  }
  constexpr long long kMost = 1'000'000;
  read_count(table, "p", -kMost, kMost, smoothing.p);
  if (table.has("p")) located(table.where("p"), [&] { check_norm(smoothing.p); });
  read_count(table, "outer_iterations", 0, kMost, smoothing.outer_iterations);
  read_count(table, "inner_iterations", 0, kMost, smoothing.inner.iterations);
  read_count(table, "rank", 1, 1000, smoothing.inner.rank);
  smoothing.inner.function_tolerance =
      number_at_least(table, "function_tolerance", 0, smoothing.inner.function_tolerance);
  smoothing.inner.gradient_tolerance =
      number_at_least(table, "gradient_tolerance", 0, smoothing.inner.gradient_tolerance);
  table.finish(smoothing_keys());
}

void read_model_keys(const TomlTable& table, Case& target) {
  const std::filesystem::path folder = table.file().parent_path();
  const bool drawn = has_planar_model(table);
  if (table.has("mesh") && drawn)
    throw InputError(table.where("mesh") + ": 'mesh' and curves or loops exclude each other");
  int models = (drawn || table.has("mesh")) ? 1 : 0;
  for (const char* key : {"model", "data", "example"})
    if (table.has(key) && ++models > 1)
      throw InputError(fmt::format("{}: '{}' and another model exclude each other", table.where(key), key));
  if (table.has("data")) {
    read_data(table, target);
  } else if (table.has("model")) {
    Case other =
        located(table.where("model"), [&] { return read_model_case(folder / table.text("model"), target); });
    other.name = target.name;
    other.where = target.where;
    target = std::move(other);
  } else if (table.has("example")) {
    drop_model(target);
    target.example = table.text("example");
    located(table.where("example"), [&] { check_example(target.example); });
  } else if (table.has("mesh")) {
    drop_model(target);
    target.mesh_file = folder / table.text("mesh");
    if (kind_of_file(target.mesh_file) != ".msh")
      throw InputError(table.where("mesh") + ": '" + target.mesh_file.string() + "' is not a .msh file");
  } else if (drawn) {
    ModelFile file = read_planar_model(table);
    drop_model(target);
    target.model = std::move(file.model);
    target.holes = std::move(file.holes);
  }
}

}  // namespace

bool has_model(const Case& c) {
  return c.model || !c.mesh_file.empty() || !c.surface_file.empty() || !c.example.empty();
}

std::optional<double> as_number(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  return status == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

const std::filesystem::path& model_path(const Case& c) {
  return c.surface_file.empty() ? c.mesh_file : c.surface_file;
}

void read_case_keys(const TomlTable& table, Case& target) {
  read_model_keys(table, target);
  if (const auto surface = table.optional_table("surface")) target.surface = read_surface_spec(*surface);
  if (table.has("size")) target.size = read_size(table);
  if (table.has("cross")) target.cross = {table.expression("cross"), table.where("cross")};
  target.seed = integer_between(table, "seed", 0, std::numeric_limits<long long>::max(), target.seed);
  if (const auto insertion = table.optional_table("insertion")) read_insertion(*insertion, target.options);
  if (const auto smoothing = table.optional_table("smoothing")) read_smoothing(*smoothing, target.options);
  if (const auto merging = table.optional_table("recombination"))
    read_recombination(*merging, target.options);
  if (const auto cleanup = table.optional_table("cleanup")) read_cleanup(*cleanup, target.options.cleanup);
  if (const auto optimisation = table.optional_table("optimisation"))
    read_optimisation(*optimisation, target.options.optimisation);
  if (const auto repair = table.optional_table("repair")) read_repair(*repair, target.options.repair);
  if (const auto compare = table.optional_table("compare"))
    for (const std::string& word : compare->keys()) target.compare[word] = compare->text(word);
}

Case read_model_case(const std::filesystem::path& file, const Case& defaults) {
  Case result = defaults;
  result.name = file.stem().string();
  result.where = file.string();
  if (set_model_file(file, result)) return result;
  if (kind_of_file(file) != ".toml")
    throw InputError(file.string() + ": unknown kind of model '" + file.extension().string() +
                     "'; known: .toml (curves and loops), .msh (lines or triangles), .step, .stp, .brep, "
                     ".stl, .obj, .off");
  const TomlTable table = TomlTable::read(file);
  if (table.has("case"))
    throw InputError(table.where("case") +
                     ": this is an experiment with cases of its own: run it with 'delquad run'");
  if (table.has("model") && kind_of_file(table.text("model")) == ".toml")
    throw InputError(table.where("model") + ": a model file cannot take its model from another one");
  read_case_keys(table, result);
  table.finish();
  if (!has_model(result))
    throw InputError(file.string() + ": no model: expected 'loop', 'pattern', 'mesh', 'model' or 'example'");
  return result;
}

}  // namespace delquad
