// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/case_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "delquad/mesher.h"
#include "geometry/cad/example_models.h"
#include "geometry/surface/triangulated_model.h"
#include "io/cases/case_keys.h"
#include "io/cases/model_file.h"
#include "io/cases/outline_files.h"
#include "io/cases/read_described.h"
#include "io/cases/read_problem.h"
#include "io/mesh_io.h"

namespace delquad {

namespace {

void read_limits(const TomlTable& table, const std::string& on, Criteria& criteria) {
  for (const Criterion& criterion : criterion_registry())
    if (table.has(criterion.key))
      criteria.set(criterion.key, table.expression(criterion.key), on, table.where(criterion.key));
}

const Criteria& preset_named(const std::string& name, const std::string& where) {
  const auto at = std::ranges::find(criteria_presets(), name, &Criteria::name);
  if (at != criteria_presets().end()) return *at;
  std::vector<std::string> known;
  for (const Criteria& preset : criteria_presets()) known.push_back(preset.name);
  refuse("{}: unknown criteria '{}': expected {} or a .toml file{}", where, name, fmt::join(known, ", "),
         suggestion(name, known));
}

Criteria read_table(const TomlTable& table) {
  table.require_known(criteria_keys());
  Criteria criteria;
  if (table.has("preset")) criteria = preset_named(table.text("preset"), table.where("preset"));
  criteria.name = table.text("name", criteria.name);
  criteria.where = table.where();
  read_limits(table, "", criteria);
  for (const TomlTable& part : table.tables("on")) {
    part.require_known(named_criteria_keys());
    read_limits(part, part.text("name"), criteria);
  }
  read_fields(table, criteria);
  if (criteria.empty()) throw InputError(table.where() + ": no criteria: expected a preset or limits");
  check_criteria(criteria);
  return criteria;
}

Criteria read_text(const std::string& text, const std::filesystem::path& folder, const std::string& where) {
  if (kind_of_file(text) != ".toml") return preset_named(text, where);
  const std::filesystem::path file = folder / text;
  Criteria criteria = read_table(TomlTable::read(file));
  if (criteria.name.empty()) criteria.name = file.stem().string();
  return criteria;
}

/// The key `criteria` of a table: a preset, a file from the folder of the table's file, or a table. Throws
/// InputError with file and line.
Criteria read_criteria_key(const TomlTable& table) {
  if (table.kind("criteria") == TomlKind::kTable) return read_table(table.table("criteria"));
  const std::string where = table.where("criteria");
  return located(where, [&] { return read_text(table.text("criteria"), table.file().parent_path(), where); });
}

}  // namespace

std::string limited_type(const std::string& type, const Rule& rule) {
  std::string text = fmt::format(R"({{"type": {})", type);
  const auto add = [&](const char* name, const std::optional<double>& limit) {
    if (limit) text += fmt::format(R"(, "{}": {})", name, *limit);
  };
  add("minimum", rule.least);
  add("exclusiveMinimum", rule.above);
  add("maximum", rule.most);
  return text + "}";
}

std::string list_type(const std::string& item, const Rule& rule) {
  return fmt::format(R"({{"type": "array", "items": {}{}{}}})", item,
                     rule.required ? R"(, "minItems": 1)" : "",
                     rule.unique ? R"(, "uniqueItems": true)" : "");
}

std::size_t described::read_word(const TomlTable& table, const std::string& key, const Rule& rule) {
  const std::string word = table.text(key);
  check_text(word, {.required = true, .words = rule.words}, {table.where(key), key});
  const std::vector<std::string> words = words_of(rule.words);
  return static_cast<std::size_t>(std::ranges::find(words, word) - words.begin());
}

namespace {

void read_options(const TomlTable& table, const OptionGroup& group, Options& options) {
  if (group.name == "smoothing")
    table.refuse_removed({{"method", "L takes the exact gradient, so remove the key"}});
  table.require_known(keys_of(group));
  for (const OptionKey& key : group.keys) {
    const auto read = [&](const auto& like) { return OptionValue(table.get(key.name, like)); };
    if (table.has(key.name))
      located(table.where(key.name),
              [&] { return options.set(group.name + "." + key.name, std::visit(read, key.value)); });
  }
}

/// Names, numbers, or tables of rules.
std::vector<PartRule> read_faces(const TomlTable& table) {
  std::vector<PartRule> faces;
  const auto [texts, tables] = table.texts_and_tables("faces");
  for (const std::string& text : texts) {
    const auto number = as_number(text);
    const bool is_number = number && *number >= 1 && *number == static_cast<int>(*number);
    faces.push_back(is_number ? PartRule{.numbers = {static_cast<int>(*number)}} : PartRule{.like = text});
  }
  for (const TomlTable& one : tables) read_described(one, faces.emplace_back());
  return faces;
}

MappedSpec read_mapped(const TomlTable& table) {
  MappedSpec mapped{.names = {}, .automatic = false, .where = table.where("mapped"), .corners = {}};
  auto [names, tables] = table.texts_and_tables("mapped");
  mapped.names = std::move(names);
  mapped.automatic = std::erase(mapped.names, "auto") > 0;
  for (const TomlTable& one : tables) read_described(one, mapped.corners.emplace_back());
  return mapped;
}

SymmetrySpec read_symmetry(const TomlTable& table) {
  const auto [texts, planes] = table.texts_and_tables("symmetry");
  SymmetrySpec symmetry{.planes = {}, .automatic = !texts.empty(), .where = table.where("symmetry")};
  for (const std::string& text : texts)
    if (text != "auto" || !planes.empty())
      refuse("{}: '{}': expected \"auto\" or planes", symmetry.where, text);
  for (const TomlTable& plane : planes) read_described(plane, symmetry.planes.emplace_back());
  return symmetry;
}

void read_size(const TomlTable& table, SizeSpec& size) {
  if (table.kind("size") == TomlKind::kTable) return read_value(table, "size", {}, size);
  size = {
      .text = table.expression("size"), .folder = table.file().parent_path(), .where = table.where("size")};
}

void set_model(Model model, Case& target) {
  target.model = std::move(model);
  target.model_file.clear();
  target.may_be_absent = false;
}

/// A file of lines, triangles or CAD as the case's model, if its extension says so.
bool set_model_file(const std::filesystem::path& file, Case& target) {
  const std::string kind = kind_of_file(file);
  if (kind != ".msh" && !outline_file_of(file) && !is_surface_file(file)) return false;
  set_model(ModelFile{file}, target);
  return true;
}

void read_data(const TomlTable& table, Case& target) {
  if (target.data_folder.empty())
    refuse("{}: 'data' is for cases of experiments: expected 'model'", table.where("data"));
  const std::filesystem::path file = target.data_folder / table.text("data");
  if (!set_model_file(file, target))
    refuse("{}: '{}' is no data: expected a .msh, {} file", table.where("data"), file.string(),
           surface_files());
  target.may_be_absent = true;
}

void read_model_keys(const TomlTable& table, Case& target) {
  const std::filesystem::path folder = table.file().parent_path();
  const bool drawn = has_planar_model(table);
  if (table.has("start") && !table.has("mesh"))
    refuse("{}: 'start' is for a mesh: expected 'mesh', too", table.where("start"));
  int models = drawn ? 1 : 0;
  for (const char* key : {"mesh", "model", "data", "example"})
    if (table.has(key) && ++models > 1)
      refuse("{}: '{}' and another model exclude each other: expected one of them", table.where(key), key);
  if (table.has("data")) {
    read_data(table, target);
  } else if (table.has("model")) {
    Case other =
        located(table.where("model"), [&] { return read_model_case(folder / table.text("model"), target); });
    other.name = target.name;
    other.where = target.where;
    target = std::move(other);
  } else if (table.has("example")) {
    set_model(ExampleModel{table.text("example")}, target);
    located(table.where("example"), [&] { check_example(example_of(target)); });
  } else if (table.has("mesh")) {
    const ModelFile file{folder / table.text("mesh"), table.get("start", false)};
    if (kind_of_file(file.path) != ".msh" && !file.given)
      refuse("{}: '{}' is not a .msh file: expected one, such as 'delquad convert' writes",
             table.where("mesh"), file.path.string());
    set_model(file, target);
  } else if (drawn) {
    set_model(read_planar_model(table), target);
  }
}

}  // namespace

void finish_reading(const TomlTable& table, SizeSource& source) {
  if (!table.has("to")) source.b = source.a;
}

void finish_reading(const TomlTable& table, MetricSpec& metric) {
  if (!metric.asks() && !table.is_of_options())
    refuse("{}: expected one of 'tensor', 'sizes', 'solution', 'file' and 'chord'", metric.where);
}

void finish_reading(const TomlTable& table, PeriodicPair& pair) {
  if (!table.has("translate") && !table.has("rotate"))
    refuse("{}: the motion from '{}' to '{}' is missing: expected 'translate' or 'rotate'", table.where(),
           pair.from, pair.to);
}

void finish_reading(const TomlTable& table, GridCorners& grid) {
  for (const auto& corner : table.get<std::vector<std::variant<std::string, Vec3>>>("corners")) {
    if (const auto* name = std::get_if<std::string>(&corner))
      grid.corners.push_back({*name, {}});
    else
      grid.corners.push_back({{}, std::get<Vec3>(corner)});
  }
}

void finish_reading(const TomlTable& table, SurfaceSpec& surface) {
  if (table.kind("compound") == TomlKind::kText) {
    surface.compounds = parse_compounds(table.text("compound"), table.where("compound"));
  } else if (table.has("compound")) {
    surface.compounds = Compounds::kGroups;
    surface.groups = table.get<std::vector<std::vector<int>>>("compound");
    check_together(surface, table.where("compound"));
  }
  if (table.has("faces")) surface.faces = read_faces(table);
  if (const auto mirror = table.optional_table("mirror"); mirror && !mirror->has("tolerance"))
    surface.mirror->tolerance = surface.weld_tolerance.value_or(TriangulatedOptions{}.weld_tolerance);
}

Criteria read_criteria(const std::string& preset_or_file) {
  return read_text(preset_or_file, {}, "criteria");
}

const PlanarModel* planar_model(const MeshProblem& problem) {
  const auto* model = std::get_if<PlanarModel>(&problem.model);
  return model == nullptr || model->source.empty() ? nullptr : model;
}

bool has_model(const MeshProblem& problem) {
  return !std::holds_alternative<PlanarModel>(problem.model) || planar_model(problem) != nullptr;
}

std::string example_of(const MeshProblem& problem) {
  const auto* example = std::get_if<ExampleModel>(&problem.model);
  return example == nullptr ? "" : example->name;
}

std::filesystem::path model_path(const MeshProblem& problem) {
  const auto* file = std::get_if<ModelFile>(&problem.model);
  if (const auto outlines = outline_file_of(file == nullptr ? "" : file->path)) return outlines->path;
  return file == nullptr ? std::filesystem::path() : file->path;
}

void read_case_keys(const TomlTable& table, Case& target) {
  read_model_keys(table, target);
  if (const auto surface = table.optional_table("surface"))
    surface->refuse_removed({{"merge_curves", "surface.simplify joins short curves"}});
  std::vector<EmbeddedLine> embed = std::move(target.surface.embed);
  for_each_field(static_cast<MeshProblem&>(target), [&](const FieldInfo& info, auto& member) {
    // At the top of an experiment [[metric]] is a measure.
    if (info.rule.form != Form::kPlain || table.kind(info.key) == TomlKind::kNone) return;
    if (info.key == std::string("metric") && table.kind(info.key) != TomlKind::kTable) return;
    read_value(table, info.key, info.rule, member);
  });
  target.surface.embed = std::move(embed);
  if (table.has("embed") && !has_planar_model(table)) target.surface.embed = read_embedded_lines(table);
  if (table.has("size")) read_size(table, target.size);
  if (table.has("mapped")) target.mapped = read_mapped(table);
  if (table.has("symmetry")) target.symmetry = read_symmetry(table);
  if (table.has("cross")) target.cross = {.text = table.expression("cross"), .where = table.where("cross")};
  if (table.has("criteria")) target.criteria = read_criteria_key(table);
  for (const OptionGroup& group : option_groups())
    if (const auto given = table.optional_table(group.name)) read_options(*given, group, target.options);
}

MeshProblem read_model_file(const std::filesystem::path& file) { return read_files(read_model_case(file)); }

Case read_model_case(const std::filesystem::path& file, const Case& defaults) {
  Case result = defaults;
  result.name = file.stem().string();
  result.where = file.string();
  set_model({}, result);
  if (set_model_file(file, result)) return result;
  std::error_code ignored;
  if (kind_of_file(file) != ".toml" && std::filesystem::is_regular_file(file, ignored))
    throw InputError(file.string() + ": unknown kind of model '" + file.extension().string() +
                     "'; known: .toml (curves and loops), .msh (lines or triangles), " + surface_files() +
                     ", and outlines: " + outline_files() +
                     "; 'delquad metrics' and 'delquad improve' read other meshes [unknown-format]");
  const TomlTable table = TomlTable::read(file);
  if (table.has("case"))
    refuse("{}: this is an experiment with cases of its own: run it with 'delquad run' [experiment-or-model]",
           table.where("case"));
  table.require_known(case_keys());
  if (table.has("model") && kind_of_file(table.text("model")) == ".toml")
    throw InputError(table.where("model") + ": a model file cannot take its model from another one");
  read_case_keys(table, result);
  result.model_file = file;
  if (!has_model(result))
    throw InputError(file.string() + ": no model: expected 'loop', 'pattern', 'mesh', 'model' or 'example'");
  return result;
}

Compounds parse_compounds(const std::string& text, const std::string& where) {
  if (text == "all") return Compounds::kAll;
  if (text == "tangent") return Compounds::kTangent;
  refuse("{}: compound '{}': expected all or tangent", where, text);
}

}  // namespace delquad
