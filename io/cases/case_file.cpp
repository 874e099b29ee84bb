#include "io/cases/case_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "base/length_unit.h"
#include "base/located.h"
#include "delquad/error.h"
#include "delquad/mesher.h"
#include "fields/fields.h"
#include "geometry/cad/example_models.h"
#include "geometry/surface/compound.h"
#include "geometry/surface/triangulated_model.h"
#include "io/cases/case_keys.h"
#include "io/cases/model_file.h"
#include "io/cases/outline_files.h"
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
    part.finish(named_criteria_keys());
  }
  if (const auto material = table.optional_table("material")) {
    material->require_known(material_keys());
    criteria.material = Material{material->positive_number("young"), material->number("poisson"),
                                 material->positive_number("density")};
    material->finish(material_keys());
  }
  criteria.time_step_by = table.text("time_step_by", criteria.time_step_by);
  criteria.strict = table.flag("strict", false);
  table.finish(criteria_keys());
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

double number_at_least(const TomlTable& table, const std::string& key, double least, double absent) {
  const double value = table.number(key, absent);
  if (table.has(key) && value < least)
    refuse("{}: '{}' is {}: expected at least {}", table.where(key), key, value, least);
  return value;
}

namespace {

/// A whole number between `least` and `most`.
long long integer_between(const TomlTable& table, const std::string& key, long long least, long long most,
                          long long absent) {
  if (!table.has(key)) return absent;
  const long long value = table.integer(key);
  if (value >= least && value <= most) return value;
  refuse("{}: '{}' is {}: expected {} to {}", table.where(key), key, value, least, most);
}

OptionValue read_value(const TomlTable& table, const OptionKey& key) {
  if (std::holds_alternative<bool>(key.value)) return table.flag(key.name, false);
  if (std::holds_alternative<double>(key.value)) return table.number(key.name);
  if (std::holds_alternative<std::string>(key.value)) return table.text(key.name);
  return table.integer(key.name);
}

void read_options(const TomlTable& table, const OptionGroup& group, Options& options) {
  for (const OptionKey& key : group.keys)
    if (table.has(key.name))
      located(table.where(key.name),
              [&] { return options.set(group.name + "." + key.name, read_value(table, key)); });
  table.finish(keys_of(group));
}

SizeSource read_source(const TomlTable& table) {
  table.require_known(source_keys());
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

NamedSize read_named_size(const TomlTable& table) {
  table.require_known(named_size_keys());
  NamedSize named{.name = table.text("name"), .where = table.where()};
  if (table.has("size")) named.size = table.positive_number("size");
  named.reach = number_at_least(table, "reach", 0, 0);
  if (table.has("growth")) named.growth = table.positive_number("growth");
  named.curvature = number_at_least(table, "curvature", kLeastPerTurn, 0);
  table.finish(named_size_keys());
  if (!table.has("size") && !table.has("curvature"))
    throw InputError(table.where() + ": '" + named.name + "' gets no size: expected 'size' or 'curvature'");
  return named;
}

constexpr long long kMostDivided = 100'000'000;

CurveDivision read_division(const TomlTable& table) {
  table.require_known(division_keys());
  CurveDivision division{.name = table.text("name"), .where = table.where()};
  if (!table.has("edges")) table.integer("edges");  // says that it is missing
  division.edges = static_cast<int>(integer_between(table, "edges", 1, kMostDivided, 0));
  for (const auto& [key, value] :
       {std::pair("progression", &division.progression), std::pair("bump", &division.bump)})
    if (table.has(key)) *value = table.positive_number(key);
  table.finish(division_keys());
  return division;
}

PeriodicPair read_periodic(const TomlTable& table) {
  PeriodicPair pair{.from = table.text("from"), .to = table.text("to"), .motion = {}, .where = table.where()};
  if (table.has("translate")) pair.motion.shift = table.space_point("translate");
  if (table.has("rotate")) pair.motion.angle = table.number("rotate") * std::numbers::pi / 180;
  if (table.has("centre")) pair.motion.centre = table.space_point("centre");
  if (table.has("axis")) pair.motion.axis = table.space_point("axis");
  if (!table.has("translate") && !table.has("rotate"))
    throw InputError(table.where() + ": how '" + pair.from + "' moves to '" + pair.to +
                     "' is missing: expected 'translate' or 'rotate'");
  table.finish(periodic_keys());
  return pair;
}

GridCorners read_grid_corners(const TomlTable& table) {
  GridCorners corners{.region = table.text("name"), .corners = {}, .where = table.where()};
  for (const auto& corner : table.texts_and_points("corners")) {
    if (const auto* name = std::get_if<std::string>(&corner))
      corners.corners.push_back({*name, {}});
    else
      corners.corners.push_back({{}, std::get<Vec3>(corner)});
  }
  table.finish(mapped_keys());
  return corners;
}

MappedSpec read_mapped(const TomlTable& table) {
  MappedSpec mapped{.names = {}, .automatic = false, .where = table.where("mapped"), .corners = {}};
  if (table.kind("mapped") == TomlKind::kFlag)
    throw InputError(mapped.where + ": 'mapped' must be names of regions, or \"auto\"");
  auto [names, tables] = table.texts_and_tables("mapped");
  mapped.names = std::move(names);
  if (table.kind("mapped") == TomlKind::kText) mapped.automatic = std::erase(mapped.names, "auto") > 0;
  for (const TomlTable& one : tables) mapped.corners.push_back(read_grid_corners(one));
  return mapped;
}

LayerSpec read_layer(const TomlTable& table) {
  table.require_known(layer_keys());
  LayerSpec layer;
  layer.where = table.where();
  layer.on = table.kind("on") == TomlKind::kText ? std::vector{table.text("on")} : table.texts("on");
  layer.first = table.positive_number("first");
  layer.growth = table.number("growth", layer.growth);
  layer.number = static_cast<int>(integer_between(table, "number", 1, 10000, 0));
  if (table.has("thickness")) layer.thickness = table.positive_number("thickness");
  layer.fan = table.number("fan", layer.fan);
  if (table.has("into"))
    layer.into =
        table.kind("into") == TomlKind::kText ? std::vector{table.text("into")} : table.texts("into");
  table.finish(layer_keys());
  layer_heights(layer);
  return layer;
}

/// `Spec`: WasherSpec or FilletRows.
template <class Spec>
Spec read_rows(const TomlTable& table, const std::string& range, const TomlKeys& keys) {
  table.require_known(keys);
  Spec spec;
  spec.where = table.where();
  const std::vector<double> ends = table.numbers(range);
  if (ends.size() != 2)
    throw InputError(fmt::format("{}: '{}' has {} numbers: expected the least and the most", spec.where,
                                 range, ends.size()));
  spec.least = ends[0], spec.most = ends[1];
  spec.rows = static_cast<int>(integer_between(table, "rows", 1, 1000, spec.rows));
  if constexpr (requires { spec.edges; }) {
    spec.edges = static_cast<int>(integer_between(table, "edges", 4, kMostDivided, spec.edges));
    if (table.has("width")) spec.width = table.positive_number("width");
  }
  table.finish(keys);
  return spec;
}

SymmetrySpec read_symmetry(const TomlTable& table) {
  SymmetrySpec symmetry{.planes = {}, .automatic = false, .where = table.where("symmetry")};
  if (table.kind("symmetry") == TomlKind::kFlag)
    throw InputError(symmetry.where + ": 'symmetry' must be planes, or \"auto\"");
  if (table.kind("symmetry") == TomlKind::kText) {
    if (const std::string text = table.text("symmetry"); text != "auto")
      throw InputError(symmetry.where + ": '" + text + "': expected \"auto\" or planes");
    symmetry.automatic = true;
    return symmetry;
  }
  for (const TomlTable& plane : table.tables("symmetry")) {
    symmetry.planes.push_back({plane.space_point("point"), plane.space_point("normal")});
    plane.finish(symmetry_keys());
    if (norm(symmetry.planes.back().normal) == 0)
      throw InputError(plane.where("normal") + ": the normal has no length");
  }
  return symmetry;
}

SizeSpec read_size(const TomlTable& table) {
  SizeSpec size;
  size.where = table.where("size");
  size.folder = table.file().parent_path();
  if (table.kind("size") != TomlKind::kTable) {
    size.text = table.expression("size");
    return size;
  }
  const TomlTable fields = table.table("size");
  fields.require_known(size_keys());
  if (fields.has("base")) size.text = fields.expression("base");
  for (const TomlTable& source : fields.tables("source")) size.sources.push_back(read_source(source));
  for (const TomlTable& named : fields.tables("on")) size.named.push_back(read_named_size(named));
  if (fields.has("gradation")) size.gradation = fields.positive_number("gradation");
  size.curvature = number_at_least(fields, "curvature", kLeastPerTurn, 0);
  if (fields.has("min")) size.min = fields.positive_number("min");
  if (fields.has("max")) size.max = fields.positive_number("max");
  fields.finish(size_keys());
  check_size_limits(size);
  return size;
}

MetricSpec read_metric_spec(const TomlTable& table) {
  table.require_known(metric_spec_keys());
  MetricSpec metric;
  metric.where = table.where();
  metric.folder = table.file().parent_path();
  const auto formulas = [&](const char* key) {
    return table.has(key) ? table.texts(key) : std::vector<std::string>();
  };
  metric.tensor = formulas("tensor");
  metric.sizes = formulas("sizes");
  metric.solution = table.text("solution", "");
  metric.file = table.text("file", "");
  if (table.has("tensor") + table.has("sizes") + table.has("solution") + table.has("file") +
          table.has("chord") !=
      1)
    throw InputError(metric.where + ": expected one of 'tensor', 'sizes', 'solution', 'file' and 'chord'");
  const auto length = [&](const char* key) { return table.has(key) ? table.positive_number(key) : 0; };
  metric.chord = length("chord");
  metric.limits = {length("min"), length("max"), number_at_least(table, "aspect", 1, 0)};
  if (metric.limits.max > 0 && metric.limits.min > metric.limits.max)
    throw InputError(table.where("min") + ": 'min' is larger than 'max'");
  metric.gradation = number_at_least(table, "gradation", 1, 0);
  metric.complexity = length("complexity");
  table.finish(metric_spec_keys());
  return metric;
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
    throw InputError(table.where("data") + ": 'data' is for cases of experiments: expected 'model'");
  const std::filesystem::path file = target.data_folder / table.text("data");
  if (!set_model_file(file, target))
    throw InputError(table.where("data") + ": '" + file.string() + "' is no data: expected a .msh, " +
                     surface_files() + " file");
  target.may_be_absent = true;
}

void read_model_keys(const TomlTable& table, Case& target) {
  const std::filesystem::path folder = table.file().parent_path();
  const bool drawn = has_planar_model(table);
  if (table.has("mesh") && drawn)
    throw InputError(table.where("mesh") + ": 'mesh' and curves or loops exclude each other");
  if (table.has("start") && !table.has("mesh"))
    throw InputError(table.where("start") + ": 'start' is for a mesh: expected 'mesh', too");
  int models = (drawn || table.has("mesh")) ? 1 : 0;
  for (const char* key : {"model", "data", "example"})
    if (table.has(key) && ++models > 1)
      refuse("{}: '{}' and another model exclude each other", table.where(key), key);
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
    const ModelFile file{folder / table.text("mesh"), table.flag("start", false)};
    if (kind_of_file(file.path) != ".msh" && !file.given)
      throw InputError(table.where("mesh") + ": '" + file.path.string() + "' is not a .msh file");
    set_model(file, target);
  } else if (drawn) {
    set_model(read_planar_model(table), target);
  }
}

Vec3 read_vector(const TomlTable& table, const std::string& key) {
  const std::vector<double> v = table.numbers(key);
  if (v.size() != 3) refuse("{}: '{}' must be three numbers [x, y, z]", table.where(key), key);
  return {v[0], v[1], v[2]};
}

MirrorPlane read_mirror(const TomlTable& table, double weld_tolerance) {
  MirrorPlane plane{read_vector(table, "point"), read_vector(table, "normal"), weld_tolerance};
  if (!(norm(plane.normal) > 0))
    throw InputError(table.where("normal") + ": the normal of the mirror's plane has no length");
  if (table.has("tolerance"))
    plane.tolerance =
        checked_weld_tolerance(table.number("tolerance"), table.where("tolerance"), "tolerance");
  plane.join = table.flag("join", plane.join);
  table.finish(mirror_keys());
  return plane;
}

NamedPart read_named_part(const TomlTable& table) {
  table.require_known(named_part_keys());
  NamedPart part{.name = table.text("as"), .where = table.where()};
  const std::string of = table.text("of", "faces");
  if (of != "faces" && of != "curves")
    throw InputError(table.where("of") + ": '" + of + "': expected 'faces' or 'curves'");
  part.curves = of == "curves";
  if (table.has("number"))
    for (const double n : table.numbers("number")) {
      if (!(n >= 1 && n <= std::numeric_limits<int>::max() && n == std::floor(n)))
        throw InputError(fmt::format("{}: {}: expected whole numbers from 1 on", table.where("number"), n));
      part.numbers.push_back(static_cast<int>(n));
    }
  part.like = table.text("like", "");
  if (table.has("box")) {
    const std::vector<Vec3> corners = table.space_points("box");
    if (corners.size() != 2) throw InputError(table.where("box") + ": expected two opposite corners");
    part.box = {corners[0], corners[1]};
  }
  if (table.has("normal")) part.normal = read_vector(table, "normal");
  if (table.has("at")) part.at = read_vector(table, "at");
  table.finish(named_part_keys());
  return part;
}

/// The keys of a [surface] table: compound, merge_curves, ignore_below, idealize, keep, feature_angle,
/// weld_tolerance, mirror, glue, unit. Throws InputError with file and line.
SurfaceSpec read_surface_spec(const TomlTable& table) {
  SurfaceSpec spec;
  spec.where = table.where();
  if (table.kind("compound") == TomlKind::kText) {
    spec.compounds = parse_compounds(table.text("compound"), table.where("compound"));
  } else if (table.has("compound")) {
    spec.compounds = Compounds::kGroups;
    spec.groups = table.integer_lists("compound");
    for (const auto& group : spec.groups)
      if (group.size() < 2) throw InputError(table.where("compound") + ": a compound has two faces or more");
  }
  if (table.has("ignore_below")) spec.ignore_below = table.positive_number("ignore_below");
  spec.idealize = table.flag("idealize", false);
  if (table.has("keep")) spec.keep = table.texts("keep");
  for (const TomlTable& part : table.tables("name")) spec.names.push_back(read_named_part(part));
  if (table.has("fill_holes")) spec.fill_holes = table.positive_number("fill_holes");
  if (table.has("simplify")) spec.simplify = number_at_least(table, "simplify", 0, 0);
  if (table.has("merge_curves")) spec.merge_curves = table.positive_number("merge_curves");
  if (table.has("feature_angle"))
    spec.feature_angle = checked_feature_angle(table.number("feature_angle"), table.where("feature_angle"));
  if (table.has("weld_tolerance"))
    spec.weld_tolerance =
        checked_weld_tolerance(table.number("weld_tolerance"), table.where("weld_tolerance"));
  if (const auto mirror = table.optional_table("mirror"))
    spec.mirror = read_mirror(*mirror, spec.weld_tolerance.value_or(TriangulatedOptions{}.weld_tolerance));
  spec.glue = table.flag("glue", false);
  if (table.has("unit")) {
    spec.unit = table.text("unit");
    located(table.where("unit"), [&] { length_unit(spec.unit); });
  }
  table.finish(surface_keys());
  return spec;
}

}  // namespace

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
  if (const auto surface = table.optional_table("surface")) {
    std::vector<EmbeddedLine> embed = std::move(target.surface.embed);
    target.surface = read_surface_spec(*surface);
    target.surface.embed = std::move(embed);
  }
  if (table.has("embed") && !has_planar_model(table)) target.surface.embed = read_embedded_lines(table);
  if (table.has("layer")) target.layers.clear();
  for (const TomlTable& layer : table.tables("layer")) target.layers.push_back(read_layer(layer));
  if (table.has("washers")) target.washers.clear();
  for (const TomlTable& washer : table.tables("washers"))
    target.washers.push_back(read_rows<WasherSpec>(washer, "diameter", washer_keys()));
  if (table.has("fillet_rows")) target.fillet_rows.clear();
  for (const TomlTable& fillet : table.tables("fillet_rows"))
    target.fillet_rows.push_back(read_rows<FilletRows>(fillet, "radius", fillet_keys()));
  if (table.has("size")) target.size = read_size(table);
  if (table.kind("metric") == TomlKind::kTable) target.metric = read_metric_spec(table.table("metric"));
  if (table.has("divide")) target.divisions.clear();
  for (const TomlTable& division : table.tables("divide"))
    target.divisions.push_back(read_division(division));
  if (table.has("mapped")) target.mapped = read_mapped(table);
  if (table.has("symmetry")) target.symmetry = read_symmetry(table);
  if (table.has("periodic")) target.periodic.clear();
  for (const TomlTable& pair : table.tables("periodic")) target.periodic.push_back(read_periodic(pair));
  if (table.has("cross")) target.cross = {.text = table.expression("cross"), .where = table.where("cross")};
  if (table.has("criteria")) target.criteria = read_criteria_key(table);
  target.order = static_cast<int>(integer_between(table, "order", 1, kMostOrder, target.order));
  if (table.has("refine")) target.refine = table.positive_number("refine");
  if (table.has("quads"))
    target.quads = integer_between(table, "quads", 1, std::numeric_limits<long long>::max(), 0);
  target.seed = integer_between(table, "seed", 0, std::numeric_limits<long long>::max(), target.seed);
  for (const OptionGroup& group : option_groups())
    if (const auto given = table.optional_table(group.name)) read_options(*given, group, target.options);
  if (const auto compare = table.optional_table("compare"))
    for (const std::string& word : compare->keys()) target.compare[word] = compare->text(word);
}

MeshProblem read_model_file(const std::filesystem::path& file) { return read_files(read_model_case(file)); }

Case read_model_case(const std::filesystem::path& file, const Case& defaults) {
  Case result = defaults;
  result.name = file.stem().string();
  result.where = file.string();
  set_model({}, result);
  if (set_model_file(file, result)) return result;
  if (kind_of_file(file) != ".toml")
    throw InputError(file.string() + ": unknown kind of model '" + file.extension().string() +
                     "'; known: .toml (curves and loops), .msh (lines or triangles), " + surface_files() +
                     ", and outlines: " + outline_files());
  const TomlTable table = TomlTable::read(file);
  if (table.has("case"))
    refuse("{}: this is an experiment with cases of its own: run it with 'delquad run'", table.where("case"));
  table.require_known(case_keys());
  if (table.has("model") && kind_of_file(table.text("model")) == ".toml")
    throw InputError(table.where("model") + ": a model file cannot take its model from another one");
  read_case_keys(table, result);
  result.model_file = file;
  table.finish();
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
