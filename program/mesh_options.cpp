#include "program/mesh_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "io/cases/case_file.h"
#include "io/cases/case_keys.h"
#include "io/cases/read_problem.h"
#include "program/options.h"

namespace delquad {
namespace {

/// An option that stands for a key of model files.
struct KeyOption {
  const char *option, *key;
};

constexpr KeyOption kSurfaceKeys[] = {{"--compound", "surface.compound"},
                                      {"--feature-angle", "surface.feature_angle"},
                                      {"--weld", "surface.weld_tolerance"},
                                      {"--ignore-below", "surface.ignore_below"},
                                      {"--idealize", "surface.idealize"},
                                      {"--keep", "surface.keep"},
                                      {"--fill-holes", "surface.fill_holes"},
                                      {"--simplify", "surface.simplify"},
                                      {"--glue", "surface.glue"},
                                      {"--unit", "surface.unit"}};
constexpr KeyOption kMeshKeys[] = {{"--curvature", "size.curvature"},
                                   {"--size-min", "size.min"},
                                   {"--mapped", "mapped"},
                                   {"--refine", "refine"},
                                   {"--quads", "quads"},
                                   {"--gap-rows", "curves.gap_rows"}};
/// Also of meshes that are improved.
constexpr KeyOption kCommonKeys[] = {{"--size", "size.base"},
                                     {"--size-max", "size.max"},
                                     {"--gradation", "size.gradation"},
                                     {"--cross", "cross"},
                                     {"--order", "order"},
                                     {"--min-angle", "limits.min_angle"},
                                     {"--max-aspect", "limits.max_aspect"},
                                     {"--criteria", "criteria"}};
constexpr KeyOption kFeatureAngle[] = {{"--feature-angle", "surface.feature_angle"}};

/// Finds a dotted key; nothing: there is none.
std::optional<TomlKey> find_key(const std::string& dotted) {
  TomlKeys keys = case_keys();
  for (std::size_t from = 0;;) {
    const std::size_t dot = std::min(dotted.find('.', from), dotted.size());
    const auto at = std::ranges::find(keys, dotted.substr(from, dot - from), &TomlKey::name);
    if (at == keys.end()) return std::nullopt;
    if (dot == dotted.size()) return *at;
    if (at->table == nullptr) return std::nullopt;
    keys = TomlKeys(at->table());
    from = dot + 1;
  }
}

bool may_be(const TomlKey& key, const char* type) {
  return key.type.find('"' + std::string(type) + '"') != std::string::npos;
}

/// TOML and JSON have the same texts.
std::string in_quotes(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// As TOML writes it: numbers and true, false, lists and tables as they are, all else in quotes.
std::string toml_text(const std::string& value, const std::optional<TomlKey>& key) {
  const bool is_text = key && !may_be(*key, "number") && !may_be(*key, "integer") &&
                       !may_be(*key, "boolean") && (may_be(*key, "string") || may_be(*key, "enum"));
  if (const auto number = as_number(value);
      number && std::isfinite(*number) && (!is_text || may_be(*key, "enum"))) {
    const bool is_whole = *number == std::floor(*number) && std::abs(*number) < 1e15;
    return is_whole ? fmt::format("{}", static_cast<long long>(*number)) : fmt::format("{}", *number);
  }
  const bool is_toml = value == "true" || value == "false" || value.starts_with('[') ||
                       value.starts_with('{') || value.starts_with('"') || value.starts_with('\'');
  return is_toml && !(is_text && key->many) ? value : in_quotes(value);
}

void add_keys(CLI::App& command, KeyArguments& arguments, std::span<const KeyOption> options) {
  for (const auto& [option, dotted] : options) {
    const TomlKey key = find_key(dotted).value();
    const std::string help = fmt::format("set {}: {}", dotted, key.about);
    const auto given = [&given = arguments.given, option, dotted](const std::vector<std::string>& values) {
      given.push_back({option, dotted, values});
    };
    if (may_be(key, "boolean"))
      command.add_flag_callback(
          option, [given] { given({"true"}); }, help);
    else
      command
          .add_option_function<std::vector<std::string>>(
              option, given, help + (may_be(key, "array") ? "; may be repeated" : ""))
          ->expected(1, may_be(key, "array") ? CLI::detail::expected_max_vector_size : 1)
          ->allow_extra_args(false);
  }
}

void add_set(CLI::App& mesh, MeshArguments& arguments) {
  mesh.add_option_function<std::vector<std::string>>(
          "--set",
          [&given = arguments.given](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const std::size_t equals = text.find('=');
              if (equals == std::string::npos || equals == 0)
                refuse("--set '{}': expected KEY=VALUE, such as regularity.tolerance=5", text);
              given.push_back({"--set " + text, text.substr(0, equals), {text.substr(equals + 1)}});
            }
          },
          "KEY=VALUE: set any key of model files, such as regularity.tolerance=5 (docs/keys.md lists all); "
          "may be "
          "repeated")
      ->allow_extra_args(false);
}

/// What comes out, and how.
void add_mesh_output(CLI::App& mesh, MeshArguments& arguments) {
  mesh.add_option("-o,--output", arguments.output,
                  "write the mesh to this file (.msh, .vtu, .inp, ...: 'delquad formats' lists all), or a "
                  "picture of it (.svg)")
      ->required();
  mesh.add_flag("--serendipity", arguments.serendipity,
                "write quads of order 2 with 8 nodes, without a middle one, in .msh and .vtu, too");
  mesh.add_option("--json", arguments.json, "write a record to this file");
  mesh.add_option("--fields", arguments.fields,
                  "write the wanted sizes and directions at the nodes to this file (.vtu)");
  mesh.add_flag("--view", arguments.view,
                "show the mesh in a browser, too, by a page beside it, as 'delquad view' does");
  add_max_elements(mesh, arguments.max_elements);
  add_threads(mesh, arguments.threads);
  mesh.add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
  add_msh(mesh, arguments.msh);
  mesh.add_flag("--keep-numbers", arguments.keep_numbers,
                "do not number the nodes anew for a small bandwidth");
  mesh.add_flag("--allow-unsound", arguments.allow_unsound, kUnsoundHelp);
  mesh.add_flag("--strict", arguments.strict, "exit with 5 if elements fail the criteria, and write no mesh");
  mesh.add_flag("--failing-sets", arguments.failing_sets,
                "put elements beyond the criteria in sets 'failing', 'failing_min_length', ... of the mesh");
}

/// "NAME=SIZE" as a table.
std::string size_table(const std::string& text) {
  const std::size_t at = text.rfind('=');
  if (at == std::string::npos || at == 0)
    refuse("--size-on '{}': expected NAME=SIZE, such as inlet=0.5", text);
  return fmt::format("{{ name = {}, size = {} }}", in_quotes(text.substr(0, at)),
                     toml_text(text.substr(at + 1), {}));
}

/// "LEAST-MOST:ROWS", and of washers perhaps ":EDGES:WIDTH", as a table.
std::string rows_table(const std::string& text, const char* option, const char* range,
                       std::size_t most_parts) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size(); ++at) {
    const std::size_t end = std::min(text.find_first_of(parts.empty() ? "-" : ":", at), text.size());
    parts.push_back(toml_text(text.substr(at, end - at), {}));
    at = end;
  }
  const bool are_numbers =
      std::ranges::none_of(parts, [](const std::string& part) { return part.starts_with('"'); });
  if (parts.size() < 3 || parts.size() > most_parts || !are_numbers)
    refuse("{} '{}': expected LEAST-MOST:ROWS{}", option, text,
           most_parts > 3 ? ", perhaps with :EDGES and :WIDTH, such as 5-12:2:16" : ", such as 2-5:3");
  std::string table = fmt::format("{{ {} = [{}, {}], rows = {}", range, parts[0], parts[1], parts[2]);
  if (parts.size() > 3) table += ", edges = " + parts[3];
  if (parts.size() > 4) table += ", width = " + parts[4];
  return table + " }";
}

void set_criteria(const MeshArguments& arguments, Criteria& criteria) {
  criteria.strict |= arguments.strict;
  // Elsewhere an element is in one set, and would leave that of its region.
  if (arguments.failing_sets && arguments.output.extension() != ".inp")
    refuse("--failing-sets: {}: expected an .inp file, where an element may be in several sets",
           arguments.output.string());
  if ((arguments.failing_sets || arguments.strict) && criteria.empty())
    refuse("{}: there are no criteria: expected --criteria, too",
           arguments.strict ? "--strict" : "--failing-sets");
}

}  // namespace

void add_surface(CLI::App& command, KeyArguments& arguments) {
  add_keys(command, arguments, kSurfaceKeys);
  command.add_flag("--keep-going", arguments.keep_going,
                   "leave out what cannot be read or meshed, name it, do the rest and exit with 4");
}

void set_keys(const KeyArguments& arguments, Case& c) {
  c.keep_going = arguments.keep_going;
  std::vector<std::pair<std::string, std::string>> lines;
  for (const auto& [option, dotted, values] : arguments.given) {
    const auto key = find_key(dotted);
    std::vector<std::string> texts;
    for (const std::string& value : values) texts.push_back(toml_text(value, key));
    const bool is_list =
        key &&
        (values.size() > 1 || (key->type.starts_with(R"({"type": "array")") && !values[0].starts_with('[')));
    lines.emplace_back(option, fmt::format("{} = {}{}{}", dotted, is_list ? "[" : "", fmt::join(texts, ", "),
                                           is_list ? "]" : ""));
    if (dotted == "size.base" || dotted == "size") c.size = {.where = {}};
  }
  const TomlTable table = TomlTable::of_options(lines);
  table.require_known(case_keys());
  read_case_keys(table, c);
  table.finish();
}

void add_msh(CLI::App& command, MshOptions& msh) {
  command.add_flag("--binary", msh.binary, "write .msh as bytes");
  static const std::map<std::string, MshCurves> curves = {
      {"all", MshCurves::kAll}, {"named", MshCurves::kNamed}, {"boundary", MshCurves::kBoundary}};
  command
      .add_option(
          "--curves", msh.curves,
          "line elements in .msh: 'boundary' of the mesh only, also those inside it that are 'named', "
          "or 'all'; deal.II takes none inside")
      ->default_str(msh.curves == MshCurves::kAll ? "all" : "named")
      ->transform(CLI::CheckedTransformer(curves).description("all, boundary or named"));
}

CLI::App* add_mesh_options(CLI::App& app, MeshArguments& arguments) {
  CLI::App* mesh = app.add_subcommand("mesh", "Mesh a planar domain or a surface");
  mesh->add_option("model", arguments.model,
                   "a model file (.toml), outlines (.geojson), lines or triangles (.msh), triangles (.stl, "
                   ".obj, .off, .ply, .3mf) or CAD "
                   "(.step, .stp, .iges, .igs, .brep)")
      ->required();
  add_keys(*mesh, arguments, kCommonKeys);
  add_keys(*mesh, arguments, kMeshKeys);
  const auto add_many = [&](const char* option, std::vector<std::string>& values, const char* help) {
    mesh->add_option(option, values, help)->allow_extra_args(false);
  };
  add_many("--size-on", arguments.size_on,
           "NAME=SIZE: set at most this size on and in what has the name; may be repeated");
  add_many(
      "--washers", arguments.washers,
      "LEAST-MOST:ROWS[:EDGES[:WIDTH]]: put rows of quads around holes of these diameters; may be repeated");
  add_many("--fillet-rows", arguments.fillet_rows,
           "LEAST-MOST:ROWS: put rows of quads across fillets of these radii; may be repeated");
  mesh->add_option("--metric", arguments.metric,
                   "set lengths by direction, in place of a size: FILE or FILE:FIELD with tensors at the "
                   "points of its mesh (MSH, "
                   "VTU, SOL or MTR), or of surfaces KEY=NUMBER,... with keys of [metric] in model files");
  add_surface(*mesh, arguments);
  std::string qualities;
  for (const Quality& q : quality_registry())
    qualities += (qualities.empty() ? "" : ", ") + q.name + " (" + q.word + ", cross " +
                 text_of(CrossSpec{.kind = q.cross}) + ")";
  CLI::Option* quality =
      mesh->add_option("--quality", arguments.quality, "trade time against quality: " + qualities)
          ->capture_default_str();
  mesh->add_option("--pipeline", arguments.pipeline,
                   "run these stages instead: F, D or P, then perhaps L, then B, or K alone; then perhaps "
                   "C, Q, R and O")
      ->excludes(quality);
  add_set(*mesh, arguments);
  add_mesh_output(*mesh, arguments);
  return mesh;
}

CLI::App* add_improve_options(CLI::App& app, MeshArguments& arguments) {
  arguments.improve = true;
  CLI::App* improve =
      app.add_subcommand("improve", "Make a mesh better that is there already, on its own boundary");
  improve
      ->add_option("mesh", arguments.model,
                   "triangles, quads or both (.msh, .vtu, .inp, .mesh, .obj, .off, .stl, .ply, .3mf)")
      ->required();
  add_keys(*improve, arguments, kCommonKeys);
  improve->add_option(
      "--pipeline", arguments.pipeline,
      "run these stages: L, then B, G or T, of triangles; C, Q, R and O of quads; default: CO, or "
      "BCO of triangles alone");
  add_set(*improve, arguments);
  add_keys(*improve, arguments, kFeatureAngle);
  add_mesh_output(*improve, arguments);
  return improve;
}

void set_problem(const MeshArguments& arguments, Case& c) {
  c.max_elements = arguments.max_elements;
  MeshArguments all = arguments;
  const auto find = [&](const char* option) {
    return std::ranges::find(arguments.given, option, &KeyArguments::Given::option);
  };
  if (const auto size = find("--size"); size != arguments.given.end()) {
    if (size->values[0].empty())
      throw InputError("--size: the size is empty: expected a number, an expression, a file or 'boundary'");
    if (find("--quads") != arguments.given.end() && as_number(size->values[0]))
      throw InputError(
          "--size and --quads: a size that is a number says how many quads there are: expected one of both");
  }
  if (const std::string& text = arguments.metric; !text.empty()) {
    c.metric = {.limits = c.metric.limits,
                .gradation = c.metric.gradation,
                .complexity = c.metric.complexity,
                .where = "--metric"};
    const bool has_keys = text.find('=') < text.find_first_of("/.");
    all.given.push_back(
        {"--metric", has_keys ? "metric" : "metric.file", {has_keys ? "{" + text + "}" : text}});
  }
  const auto add_tables = [&](const char* option, const char* key, const std::vector<std::string>& texts,
                              const auto& table_of) {
    std::vector<std::string> tables;
    for (const std::string& text : texts) tables.push_back(table_of(text));
    if (!texts.empty())
      all.given.push_back(
          {fmt::format("{} {}", option, texts[0]), key, {fmt::format("[{}]", fmt::join(tables, ", "))}});
  };
  if (!arguments.washers.empty()) c.washers.clear();
  if (!arguments.fillet_rows.empty()) c.fillet_rows.clear();
  add_tables("--size-on", "size.on", arguments.size_on, size_table);
  add_tables("--washers", "washers", arguments.washers,
             [](const std::string& text) { return rows_table(text, "--washers", "diameter", 5); });
  add_tables("--fillet-rows", "fillet_rows", arguments.fillet_rows,
             [](const std::string& text) { return rows_table(text, "--fillet-rows", "radius", 3); });
  set_keys(all, c);
  if (!arguments.metric.empty() && !c.metric.asks())
    throw InputError("--metric: expected a file of tensors, or 'chord' among the keys");
  set_criteria(arguments, c.criteria);
}

}  // namespace delquad
