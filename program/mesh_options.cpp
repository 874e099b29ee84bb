#include "program/mesh_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "base/length_unit.h"
#include "base/located.h"
#include "base/text.h"
#include "delquad/error.h"
#include "fields/fields.h"
#include "geometry/surface/triangulated_model.h"
#include "io/cases/case_file.h"
#include "io/cases/read_problem.h"
#include "program/options.h"

namespace delquad {
namespace {

constexpr double kMostPerTurn = 1e6;

/// How the faces of surfaces are made.
void add_feature_angle(CLI::App& command, SurfaceArguments& arguments) {
  command.add_option(
      "--feature-angle", arguments.feature_angle,
      "degrees by which triangles must turn for a curve between them, and curves for a corner");
}

void add_set(CLI::App& mesh, MeshArguments& arguments) {
  mesh.add_option(
          "--set", arguments.set,
          "OPTION=VALUE, such as regularity.tolerance=5 ('delquad schema --options' lists all); may be "
          "repeated")
      ->allow_extra_args(false);
}

void add_sizes(CLI::App& mesh, MeshArguments& arguments) {
  mesh.add_option("--size-max", arguments.max, "largest size")->check(kLength);
  mesh.add_option("--gradation", arguments.gradation,
                  "the most by which sizes grow per unit length; 0.3 with --curvature")
      ->check(kLength);
  mesh.add_option("--cross", arguments.cross,
                  "directions: 'boundary', 'size-aware', 'gradient' or an angle expression (radians)");
}

/// What comes out, and how.
void add_mesh_output(CLI::App& mesh, MeshArguments& arguments) {
  mesh.add_option(
          "-o,--output", arguments.output,
          "mesh to write (.msh, .vtu, .inp, ...: 'delquad formats' lists all), or a picture of it (.svg)")
      ->required();
  mesh.add_option("--order", arguments.order,
                  "of the elements: 2 to 4 are curved along the model (.msh, .vtu; 2 also .inp)")
      ->check(CLI::Range(1, kMostOrder));
  mesh.add_flag("--serendipity", arguments.serendipity,
                "with --order 2: quads of 8 nodes, without a middle one, in .msh and .vtu, too");
  mesh.add_option("--json", arguments.json, "record to write");
  mesh.add_flag("--view", arguments.view,
                "show the mesh in a browser, too, by a page beside it, as 'delquad view' does");
  add_max_elements(mesh, arguments.max_elements);
  add_threads(mesh, arguments.threads);
  mesh.add_flag("--allow-triangles", arguments.allow_triangles, kAllowHelp);
  add_msh(mesh, arguments.msh);
  mesh.add_flag("--keep-numbers", arguments.keep_numbers,
                "do not number the nodes anew for a small bandwidth");
  mesh.add_flag("--allow-unsound", arguments.allow_unsound, kUnsoundHelp);
  mesh.add_option("--min-angle", arguments.min_angle,
                  "degrees: an element with a smaller angle is an error (exit code 5)");
  mesh.add_option(
      "--max-aspect", arguments.max_aspect,
      "an element whose longest side is longer than this times its shortest is an error, but in layers");
  add_criteria(mesh, arguments.criteria, arguments.strict);
  mesh.add_flag("--failing-sets", arguments.failing_sets,
                "elements beyond the criteria are in sets 'failing', 'failing_min_length', ... of the mesh");
}

/// What "NAME=SIZE" says.
NamedSize named_size(const std::string& text) {
  const std::size_t at = text.rfind('=');
  const auto size = at == std::string::npos ? std::nullopt : as_number(text.substr(at + 1));
  if (!size || !(*size > 0) || !std::isfinite(*size) || at == 0)
    throw InputError("--size-on '" + text + "': expected NAME=SIZE with a size above 0, such as inlet=0.5");
  return {.name = text.substr(0, at), .size = *size, .where = "--size-on " + text};
}

void set_mapped(const MeshArguments& arguments, MappedSpec& mapped) {
  if (arguments.mapped.empty()) return;
  if (std::ranges::find(arguments.mapped, "") != arguments.mapped.end())
    throw InputError("--mapped '': expected the name of a region, or auto");
  mapped = {arguments.mapped, false, "--mapped", {}};
  mapped.automatic = std::erase(mapped.names, "auto") > 0;
}

/// What "LEAST-MOST:ROWS", and of washers perhaps ":EDGES:WIDTH" says.
template <class Spec>
std::vector<Spec> rows_of(const std::vector<std::string>& texts, const char* option,
                          std::size_t most_numbers) {
  std::vector<Spec> specs;
  for (const std::string& text : texts) {
    std::vector<double> numbers;
    for (std::size_t at = 0; at <= text.size(); ++at) {
      const std::size_t end = std::min(text.find_first_of(numbers.empty() ? "-" : ":", at), text.size());
      numbers.push_back(as_number(text.substr(at, end - at)).value_or(-1));
      at = end;
    }
    const auto is_whole = [&](std::size_t i) {
      return numbers.size() <= i || std::floor(numbers[i]) == numbers[i];
    };
    if (numbers.size() < 3 || numbers.size() > most_numbers || std::ranges::min(numbers) < 0 ||
        !is_whole(2) || !is_whole(3) || std::ranges::max(numbers) > 1e9)
      refuse("{} '{}': expected LEAST-MOST:ROWS{}", option, text,
             most_numbers > 3 ? ", perhaps with :EDGES and :WIDTH, such as 5-12:2:16" : ", such as 2-5:3");
    Spec& spec = specs.emplace_back();
    spec = {.least = numbers[0],
            .most = numbers[1],
            .rows = static_cast<int>(numbers[2]),
            .where = std::string(option) + " " + text};
    if constexpr (requires { spec.edges; }) {
      if (numbers.size() > 3) spec.edges = static_cast<int>(numbers[3]);
      if (numbers.size() > 4) spec.width = numbers[4];
    }
  }
  return specs;
}

/// The model's sizes, with what the command line says in their place.
SizeSpec with_arguments(SizeSpec size, const MeshArguments& arguments) {
  if (arguments.size) {
    if (arguments.size->empty())
      throw InputError("--size: the size is empty: expected a number, an expression, a file or 'boundary'");
    if (arguments.quads && as_number(*arguments.size))
      throw InputError(
          "--size and --quads: a size that is a number says how many quads there are: expected one of both");
    size = {.text = *arguments.size, .where = "--size"};
  }
  const std::pair<double, double*> given[] = {{arguments.curvature, &size.curvature},
                                              {arguments.min, &size.min},
                                              {arguments.max, &size.max},
                                              {arguments.gradation, &size.gradation}};
  for (const auto& [value, target] : given) {
    if (!(value > 0)) continue;
    *target = value;
    if (size.where.empty()) size.where = "command line";
  }
  for (const std::string& text : arguments.size_on) size.named.push_back(named_size(text));
  if (size.where.empty() && !size.named.empty()) size.where = "--size-on";
  check_size_limits(size);
  return size;
}

/// A value as it is written in TOML, texts without quotes.
OptionValue value_of(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  const char *end = text.data() + text.size(), *begin = text.data();
  if (long long whole = 0; std::from_chars(begin, end, whole) == std::from_chars_result{end, {}})
    return whole;
  if (double number = 0; std::from_chars(begin, end, number) == std::from_chars_result{end, {}})
    return number;
  return text;
}

void set_options(const MeshArguments& arguments, Options& options) {
  if (arguments.min_angle) options.set("limits.min_angle", *arguments.min_angle);
  if (arguments.max_aspect) options.set("limits.max_aspect", *arguments.max_aspect);
  for (const std::string& text : arguments.set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      refuse("--set '{}': expected OPTION=VALUE, such as regularity.tolerance=5", text);
    try {
      options.set(text.substr(0, equals), value_of(text.substr(equals + 1)));
    } catch (const InputError& error) {
      refuse("--set: {}", error.what());
    }
  }
}

void set_criteria(const MeshArguments& arguments, Criteria& criteria) {
  if (!arguments.criteria.empty()) criteria = read_criteria(arguments.criteria);
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

void add_surface(CLI::App& command, SurfaceArguments& arguments) {
  command.add_option("--compound", arguments.compound,
                     "faces of a surface to mesh as one: 'all' that hang together, or 'tangent' ones");
  add_feature_angle(command, arguments);
  command.add_option("--weld", arguments.weld_tolerance,
                     "join ends of open edges of a triangulation up to this part of its diagonal");
  command.add_option(
      "--ignore-below", arguments.ignore_below,
      "length: close smaller holes, join narrower faces to neighbours, shorter curves to points");
  command.add_flag("--idealize", arguments.idealize, "ignore what is below min_length of the criteria");
  command.add_option("--keep", arguments.keep,
                     "name of a face or curve that is not left out; may be repeated");
  command.add_option("--fill-holes", arguments.fill_holes, "diameter: close holes that are not wider")
      ->check(kLength);
  command.add_option("--simplify", arguments.simplify,
                     "sizes: planar polylines lose points nearer than that to what stays (0.1 for GeoJSON)");
  command.add_flag("--glue", arguments.glue,
                   "bodies of a CAD model that touch share faces, curves and nodes there");
  command.add_option("--unit", arguments.unit,
                     "of the lengths, of CAD (else mm) and 3MF: um, mm, cm, m, km, in or ft");
  command.add_flag("--keep-going", arguments.keep_going,
                   "leave out what cannot be read or meshed, name it, do the rest and exit with 4");
}

void set_surface(const SurfaceArguments& arguments, Case& c) {
  SurfaceSpec& surface = c.surface;
  c.keep_going = arguments.keep_going;
  const auto given = [&](const char* option) { return surface.where = option; };
  if (!arguments.compound.empty()) {
    surface.compounds = parse_compounds(arguments.compound, given("--compound"));
    surface.groups.clear();
  }
  if (arguments.feature_angle)
    surface.feature_angle = checked_feature_angle(*arguments.feature_angle, given("--feature-angle"));
  if (arguments.ignore_below) {
    if (!(*arguments.ignore_below > 0) || !std::isfinite(*arguments.ignore_below))
      refuse("--ignore-below {}: expected a length > 0", *arguments.ignore_below);
    given("--ignore-below");
    surface.ignore_below = *arguments.ignore_below;
  }
  if (arguments.idealize) {
    given("--idealize");
    surface.idealize = true;
  }
  if (!arguments.keep.empty()) {
    given("--keep");
    surface.keep = arguments.keep;
  }
  if (arguments.fill_holes) {
    given("--fill-holes");
    surface.fill_holes = *arguments.fill_holes;
  }
  if (arguments.simplify) {
    if (!(*arguments.simplify >= 0) || !std::isfinite(*arguments.simplify))
      refuse("--simplify {}: expected a number of sizes, at least 0", *arguments.simplify);
    given("--simplify");
    surface.simplify = arguments.simplify;
  }
  if (arguments.glue) {
    given("--glue");
    surface.glue = true;
  }
  if (!arguments.unit.empty())
    surface.unit = located(given("--unit"), [&] { return length_unit(arguments.unit).name; });
  if (arguments.weld_tolerance)
    surface.weld_tolerance = checked_weld_tolerance(*arguments.weld_tolerance, given("--weld"));
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
  add_size(*mesh, arguments.size, kSizeHelp);
  mesh->add_option("--size-on", arguments.size_on,
                   "NAME=SIZE: at most this size on and in what has the name; may be repeated")
      ->allow_extra_args(false);
  mesh->add_option(
          "--mapped", arguments.mapped,
          "name of a region or face that becomes a grid, or 'auto' for all where that pays; may be repeated")
      ->allow_extra_args(false);
  mesh->add_option(
          "--washers", arguments.washers,
          "LEAST-MOST:ROWS[:EDGES[:WIDTH]]: rows of quads around holes of these diameters; may be repeated")
      ->allow_extra_args(false);
  mesh->add_option("--fillet-rows", arguments.fillet_rows,
                   "LEAST-MOST:ROWS: rows of quads across fillets of these radii; may be repeated")
      ->allow_extra_args(false);
  mesh->add_option_function<int>(
          "--gap-rows",
          [&set = arguments.set](int n) { set.push_back(fmt::format("curves.gap_rows={}", n)); },
          "of planar models: at least so many rows of quads between curves of a region")
      ->check(CLI::PositiveNumber);
  mesh->add_option("--refine", arguments.refine, "divide all sizes by this, for studies of convergence")
      ->check(kLength);
  mesh->add_option("--quads", arguments.quads,
                   "about how many, by sizes that are all larger or smaller; no --size is needed then")
      ->transform(kCount);
  mesh->add_option("--curvature", arguments.curvature, "elements per full turn of a curved face or curve")
      ->check(kLength & CLI::Range(kLeastPerTurn, kMostPerTurn));
  mesh->add_option("--size-min", arguments.min, "least size by curvature; default: 1/20 of --size")
      ->check(kLength);
  add_sizes(*mesh, arguments);
  mesh->add_option(
      "--metric", arguments.metric,
      "lengths by direction, in place of a size: FILE or FILE:FIELD, an MSH, VTU, SOL or MTR file with "
      "tensors at "
      "the points of its mesh; of surfaces also KEY=NUMBER,... with the keys chord (how far sides stray "
      "from an arc), min, max, aspect, gradation and complexity (formulas: [metric] in model files)");
  add_surface(*mesh, arguments);
  std::string qualities;
  for (const Quality& q : quality_registry())
    qualities += (qualities.empty() ? "" : ", ") + q.name + " (" + q.word + ", cross " +
                 text_of(CrossSpec{.kind = q.cross}) + ")";
  CLI::Option* quality =
      mesh->add_option("--quality", arguments.quality, "time against quality: " + qualities)
          ->capture_default_str();
  mesh->add_option("--pipeline", arguments.pipeline,
                   "instead: letters of stages: F, D or P, then perhaps L, then B, or K alone; then perhaps "
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
  add_size(*improve, arguments.size, kSizeHelp)->default_str("what the mesh has");
  add_sizes(*improve, arguments);
  improve->add_option(
      "--pipeline", arguments.pipeline,
      "letters of stages: L, then B, G or T, of triangles; C, Q, R and O of quads; default: CO, or "
      "BCO of triangles alone");
  add_set(*improve, arguments);
  add_feature_angle(*improve, arguments);
  add_mesh_output(*improve, arguments);
  return improve;
}

namespace {

/// KEY=NUMBER, parted by commas.
void set_metric_numbers(const std::string& text, MetricSpec& metric) {
  const std::map<std::string, double*> keys = {
      {"chord", &metric.chord},         {"min", &metric.limits.min},
      {"max", &metric.limits.max},      {"aspect", &metric.limits.aspect},
      {"gradation", &metric.gradation}, {"complexity", &metric.complexity}};
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const auto key = keys.find(part.substr(0, equals));
    const auto number =
        key == keys.end() ? std::nullopt : as_number(part.substr(equals + (equals < part.size())));
    if (!number || !(*number > 0))
      throw InputError("--metric: '" + part +
                       "': expected a key of chord, min, max, aspect, gradation and complexity, = and a "
                       "number above 0");
    *key->second = *number;
  }
}

}  // namespace

void set_problem(const MeshArguments& arguments, Case& c) {
  c.max_elements = arguments.max_elements;
  c.size = with_arguments(std::move(c.size), arguments);
  if (arguments.order) c.order = *arguments.order;
  if (arguments.refine) c.refine = *arguments.refine;
  if (arguments.quads) c.quads = *arguments.quads;
  set_mapped(arguments, c.mapped);
  if (!arguments.washers.empty()) c.washers = rows_of<WasherSpec>(arguments.washers, "--washers", 5);
  if (!arguments.fillet_rows.empty())
    c.fillet_rows = rows_of<FilletRows>(arguments.fillet_rows, "--fillet-rows", 3);
  set_options(arguments, c.options);
  set_criteria(arguments, c.criteria);
  set_surface(arguments, c);
  if (!arguments.metric.empty()) {
    c.metric = {.limits = c.metric.limits,
                .gradation = c.metric.gradation,
                .complexity = c.metric.complexity,
                .where = "--metric"};
    if (arguments.metric.find('=') < arguments.metric.find_first_of("/."))
      set_metric_numbers(arguments.metric, c.metric);
    else
      c.metric.file = arguments.metric;
  }
  if (!arguments.cross.empty()) c.cross = {.text = arguments.cross, .where = "--cross"};
}

}  // namespace delquad
