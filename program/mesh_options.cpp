// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/mesh_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "io/cases/case_file.h"
#include "io/cases/case_keys.h"
#include "io/cases/read_problem.h"
#include "io/mesh_formats.h"
#include "program/options.h"

namespace delquad {
namespace {

/// Keys by their dotted names.
using KeysByName = std::vector<std::pair<std::string, TomlKey>>;

void collect(const TomlKeys& keys, const std::string& prefix, KeysByName& all) {
  for (const TomlKey& key : keys) {
    all.emplace_back(prefix + key.name, key);
    if (key.table != nullptr) collect(key.table(), prefix + key.name + ".", all);
  }
}

/// All keys of model files.
KeysByName all_keys() {
  KeysByName all;
  collect(case_keys(), "", all);
  for (auto& [name, key] : all) {  // options of stages have no description
    if (name == "curves.gap_rows") key.option = "--gap-rows";
    if (name == "limits.min_angle") key.option = "--min-angle";
    if (name == "limits.max_aspect") key.option = "--max-aspect";
  }
  return all;
}

/// Keys with options for meshes that are improved, too.
const std::set<std::string> kOfImprove = {"size.base",
                                          "size.max",
                                          "size.gradation",
                                          "cross",
                                          "order",
                                          "limits.min_angle",
                                          "limits.max_aspect",
                                          "surface.feature_angle",
                                          "surface.weld_tolerance",
                                          "criteria"};

/// Keys of surfaces that change no model, but what is meshed of it.
const std::set<std::string> kOfMesh = {"surface.faces", "surface.midsurface"};

bool accepts_type(const TomlKey& key, const char* type) {
  return key.type.find('"' + std::string(type) + '"') != std::string::npos;
}

/// TOML and JSON have the same texts.
std::string in_quotes(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// How a table is written on the command line: "NAME=SIZE[:REACH[:GROWTH]]", "LEAST-MOST[:ROWS]".
std::string form_of(const TomlKeys& keys) {
  std::string form, end;
  for (const TomlKey& key : keys) {
    std::string name = key.type == toml_types::kRange ? "LEAST-MOST" : key.name;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
    const bool is_first = &key == &keys[0], is_named = keys[0].type == toml_types::kText;
    form += is_first ? name : is_named && &key == &keys[1] ? "=" + name : "[:" + name;
    if (!is_first && !(is_named && &key == &keys[1])) end += "]";
  }
  return form + end;
}

std::string toml_text(const std::string& value, const TomlKey* key);

/// A table of its values in the order of the keys.
std::string table_text(const std::string& text, const TomlKeys& keys) {
  const bool is_named = keys[0].type == toml_types::kText;
  std::string table;
  std::size_t at = 0;
  for (const TomlKey& key : keys) {
    if (at > text.size()) break;
    const std::size_t end =
        &key == &keys[0] && is_named ? text.rfind('=') : std::min(text.find(':', at), text.size());
    if (end == text.npos) break;
    table += fmt::format("{} {} = {}", table.empty() ? "{" : ",", key.name,
                         toml_text(text.substr(at, end - at), &key));
    at = end + 1;
  }
  if (at <= text.size() || (is_named && text.starts_with('=')))
    refuse("'{}': expected {}", text, form_of(keys));
  return table + " }";
}

/// As TOML writes it: numbers and true, false, lists and tables as they are, all else in quotes. `key`: null
/// for keys that are not known.
std::string toml_text(const std::string& value, const TomlKey* key) {
  const bool is_toml = value == "true" || value == "false" || value.starts_with('[') ||
                       value.starts_with('{') || value.starts_with('"') || value.starts_with('\'');
  if (key != nullptr && key->type.empty() && key->many && !is_toml) return table_text(value, key->table());
  if (const std::size_t to = value.find('-', 1);
      to != value.npos && key != nullptr && key->type == toml_types::kRange) {
    const auto least = as_number(value.substr(0, to)), most = as_number(value.substr(to + 1));
    if (least && most) return fmt::format("[{}, {}]", *least, *most);
  }
  const bool is_text = key != nullptr && !accepts_type(*key, "number") && !accepts_type(*key, "integer") &&
                       !accepts_type(*key, "boolean") &&
                       (accepts_type(*key, "string") || accepts_type(*key, "enum"));
  if (const auto number = as_number(value);
      number && std::isfinite(*number) && (!is_text || accepts_type(*key, "enum"))) {
    const bool is_whole = *number == std::floor(*number) && std::abs(*number) < 1e15;
    return is_whole ? fmt::format("{}", static_cast<long long>(*number)) : fmt::format("{}", *number);
  }
  return is_toml && !(is_text && key->many && value[0] != '{') ? value : in_quotes(value);
}

/// Adds the options of keys that are wanted by their dotted names.
template <class IsWanted>
void add_keys(CLI::App& command, KeyArguments& arguments, const IsWanted& is_wanted) {
  for (const auto& [name, key] : all_keys()) {
    if (key.option == nullptr || !is_wanted(name)) continue;
    const bool is_list = accepts_type(key, "array") || key.many;
    const auto given = [&given = arguments.given, option = key.option,
                        name = name](const std::vector<std::string>& values) {
      given.push_back({option, name, values});
    };
    const std::string help =
        fmt::format("{}set {}: {}{}", key.many && key.type.empty() ? form_of(key.table()) + ": " : "", name,
                    key.about, is_list ? "; may be repeated" : "");
    if (accepts_type(key, "boolean"))
      command.add_flag_callback(
          key.option, [given] { given({"true"}); }, help);
    else
      command.add_option_function<std::vector<std::string>>(key.option, given, help)
          ->expected(1, is_list ? CLI::detail::expected_max_vector_size : 1)
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

/// Adds the options for results and their form.
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
  mesh.add_option(
      "--depth", arguments.depth,
      "write depths at the nodes, positive downwards, of a raster FILE or \"FILE: FORMULA\" in its "
      "value (files gr3, 14, 2dm, nc)");
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
  mesh.add_flag("--try-cures", arguments.try_cures,
                "if elements fail the criteria, mesh again with the proposed --ignore-below, and tell how "
                "many are left");
}

void set_criteria(const MeshArguments& arguments, Criteria& criteria) {
  criteria.strict |= arguments.strict;
  // Elsewhere an element is in one set, and would leave the set of its region.
  if (arguments.failing_sets && arguments.output.extension() != ".inp")
    refuse("--failing-sets: {}: expected an .inp file, where an element may be in several sets",
           arguments.output.string());
  if (arguments.failing_sets && arguments.improve && keeps_file(arguments.model, arguments.output))
    refuse("--failing-sets: {} keeps the sets of {} and gets no new ones: leave it out",
           arguments.output.string(), arguments.model.string());
  if ((arguments.failing_sets || arguments.strict || arguments.try_cures) && criteria.empty())
    refuse("{}: there are no criteria: expected --criteria, too", arguments.strict      ? "--strict"
                                                                  : arguments.try_cures ? "--try-cures"
                                                                                        : "--failing-sets");
}

}  // namespace

void add_surface(CLI::App& command, KeyArguments& arguments) {
  add_keys(command, arguments,
           [](const std::string& key) { return key.starts_with("surface.") && !kOfMesh.contains(key); });
  command.add_flag("--keep-going", arguments.keep_going,
                   "leave out what cannot be read or meshed, name it, do the rest and exit with 4");
}

void set_keys(const KeyArguments& arguments, Case& c) {
  c.keep_going = arguments.keep_going;
  const KeysByName keys = all_keys();
  std::vector<std::pair<std::string, std::string>> lines;
  for (const auto& [option, name, values] : arguments.given) {
    const auto at = std::ranges::find(keys, name, &KeysByName::value_type::first);
    const TomlKey* key = at == keys.end() ? nullptr : &at->second;
    std::vector<std::string> texts;
    for (const std::string& value : values)
      texts.push_back(located(option, [&] { return toml_text(value, key); }));
    const bool is_list =
        values.size() > 1 ||
        (key != nullptr && key->type.starts_with(R"({"type": "array")") && !values[0].starts_with('['));
    lines.emplace_back(option, fmt::format("{} = {}{}{}", name, is_list ? "[" : "", fmt::join(texts, ", "),
                                           is_list ? "]" : ""));
    if (name == "size.base" || name == "size") c.size = {.where = {}};
    if (name == "washers") c.washers.clear();
    if (name == "fillet_rows") c.fillet_rows.clear();
  }
  const TomlTable table = TomlTable::of_options(lines);
  table.require_known(case_keys());
  read_case_keys(table, c);
}

void check_triangles(const std::filesystem::path& source, const std::filesystem::path& output,
                     const MshOptions& msh) {
  if (msh.triangles && keeps_file(source, output))
    refuse("--triangles: {} keeps the elements of {}: leave it out, or write another format", output.string(),
           source.string());
}

void add_msh_file(CLI::App& command, MshOptions& msh) {
  command.add_flag("--binary", msh.binary, "write .msh as bytes");
  command.add_option_function<std::string>(
      "--msh-version",
      [&is_msh22 = msh.is_msh22](const std::string& version) {
        is_msh22 = version == "2.2";
        if (!is_msh22 && version != "4.1") refuse("--msh-version {}: expected 4.1 or 2.2", version);
      },
      "of .msh: 4.1 (the default) or 2.2");
}

void add_msh(CLI::App& command, MshOptions& msh) {
  add_msh_file(command, msh);
  command.add_flag("--triangles", msh.triangles,
                   "split each quad along its better diagonal; STL and ADCIRC have no quads");
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

CLI::Option* add_model(CLI::App* mesh, MeshArguments& arguments) {
  CLI::Option* model = mesh->add_option(
      "model", arguments.model,
      "a model (.toml), outlines (.geojson), lines or triangles (.msh), triangles (.stl, .obj, "
      ".off, .ply, .3mf), CAD (.step, .stp, .iges, .igs, .brep), or a record (.json)");
  add_keys(*mesh, arguments,
           [](const std::string& key) { return !key.starts_with("surface.") || kOfMesh.contains(key); });
  mesh->add_option("--metric", arguments.metric,
                   "set lengths by direction, in place of a size: FILE or FILE:FIELD with tensors at the "
                   "points of its mesh (MSH, "
                   "VTU, SOL or MTR), or of surfaces KEY=NUMBER,... with keys of [metric] in model files");
  add_surface(*mesh, arguments);
  std::string qualities;
  for (const Quality& q : quality_registry())
    qualities += (qualities.empty() ? "" : ", ") + q.name + " (" + q.pipeline + ", cross " +
                 text_of(CrossSpec{.kind = q.cross}) + ")";
  CLI::Option* quality =
      mesh->add_option("--quality", arguments.quality, "trade time against quality: " + qualities)
          ->capture_default_str();
  mesh->add_option("--pipeline", arguments.pipeline,
                   "run these stages instead: F, D or P, then perhaps L, then B, or K alone; then perhaps "
                   "C, Q, R and O")
      ->excludes(quality);
  add_set(*mesh, arguments);
  return model;
}

CLI::App* add_mesh_options(CLI::App& app, MeshArguments& arguments) {
  CLI::App* mesh = app.add_subcommand("mesh", "Mesh a planar domain or a surface");
  add_model(mesh, arguments)->required();
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
  add_keys(*improve, arguments, [](const std::string& key) { return kOfImprove.contains(key); });
  improve->add_option(
      "--pipeline", arguments.pipeline,
      "run these stages: L, then B, G or T, of triangles; C, Q, R and O of quads; default: CO, or "
      "BCO of triangles alone");
  add_set(*improve, arguments);
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
  set_keys(all, c);
  if (!arguments.metric.empty() && !c.metric.asks())
    throw InputError("--metric: expected a file of tensors, or 'chord' among the keys");
  set_criteria(arguments, c.criteria);
}

}  // namespace delquad
