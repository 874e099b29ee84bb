#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "base/context.h"
#include "base/located.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "delquad/adapt.h"
#include "delquad/error.h"
#include "experiments/console/interrupt.h"
#include "experiments/console/progress.h"
#include "io/cases/read_problem.h"
#include "io/mesh_io.h"
#include "program/commands.h"
#include "program/options.h"
#include "program/print.h"

namespace delquad {
namespace {

struct AdaptArguments : AdaptSpec {
  std::vector<std::string> fields;
  std::string weight_field, norm_text = "2";
  std::filesystem::path model, output;
  Transfer transfer = Transfer::kInterpolated;
  MshOptions msh{false, MshCurves::kNamed};
  int threads = thread_count();
};

/// The mesh of the first field, and all fields.
struct Solution {
  std::vector<std::filesystem::path> files;
  Mesh mesh;
  std::vector<NodalField> fields;
};

/// The components of FILE:FIELD, or of another FIELD of the first file.
std::vector<NodalField> read_fields(const std::string& text, Solution& solution) {
  SizeFile from{solution.files.empty() ? "" : solution.files[0], text};
  if (const auto given = size_file_of(text, {})) from = *given;
  if (from.path.empty()) refuse("'{}': expected FILE:FIELD with a .msh or .vtu file", text);
  PointField read = read_point_field(from.path, from.field);
  solution.files.push_back(from.path);
  if (solution.files.size() == 1) {
    solution.mesh = read.mesh;
  } else if (read.mesh.points != solution.mesh.points || read.mesh.triangles != solution.mesh.triangles ||
             read.mesh.quads != solution.mesh.quads)
    refuse("{}: its mesh is another one than that of {}: expected fields on the same", text,
           solution.files[0].string());
  std::vector<NodalField> fields;
  for (auto& [name, values] : read.components) fields.push_back({name, std::move(values)});
  return fields;
}

std::string name_of_norm(double p) { return std::isinf(p) ? "maximum" : fmt::format("L{:g}", p); }

void print_errors(double norm, const Solution& solution, const Adapted& made) {
  for (std::size_t f = 0; f < solution.fields.size(); ++f) {
    const auto& [now, gradient, after] = made.errors[f];
    fmt::print(
        "  {}: error {:.4g} ({} of interpolation), gradient {:.4g} (L2), estimated by {} elements; "
        "expected {:.4g}\n",
        solution.fields[f].name, now, name_of_norm(norm), gradient,
        solution.mesh.triangles.size() + solution.mesh.quads.size(), after);
  }
}

int adapt_command(const AdaptArguments& arguments) {
  const Stopwatch command;
  const RunScope run({.threads = arguments.threads});
  check_mesh_format(arguments.output, arguments.msh);
  check_output(arguments.output);
  AdaptSpec spec = arguments;
  const auto norm = as_number(arguments.norm_text);
  spec.norm = arguments.norm_text == "inf" ? std::numeric_limits<double>::infinity() : norm.value_or(0);
  Solution solution;
  for (const std::string& text : arguments.fields)
    for (NodalField& field : read_fields(text, solution)) solution.fields.push_back(std::move(field));
  if (!arguments.weight_field.empty()) {
    std::vector<NodalField> weight = read_fields(arguments.weight_field, solution);
    if (weight.size() > 1)
      refuse("--goal-weight {}: expected one number at each point", arguments.weight_field);
    spec.weight = std::move(weight[0].values);
  }
  std::optional<MeshProblem> problem;
  if (!arguments.model.empty()) problem = read_model_file(arguments.model);
  const std::string kind = kind_of_file(arguments.output);
  const bool holds = kind == ".msh" || kind == ".vtu";
  const std::filesystem::path with_fields =
      holds ? arguments.output : std::filesystem::path(arguments.output).replace_extension(".vtu");
  for (const std::filesystem::path& file : solution.files)
    check_distinct({{"the solution", file},
                    {"the model", arguments.model},
                    {"-o", arguments.output},
                    {"the fields beside it", holds ? "" : with_fields}});
  Progress progress;
  Adapted made = adapt(solution.mesh, solution.fields, spec, problem ? &*problem : nullptr);
  progress.warn(made.result.warnings);
  {
    const Uninterrupted whole;
    Mesh& mesh = made.result.mesh;
    reduce_bandwidth(mesh);
    PointData data;
    for (const NodalField& field : solution.fields)
      data[field.name] = transfer_points(solution.mesh, field.values, mesh, arguments.transfer);
    if (!holds) write_mesh(arguments.output, mesh, arguments.msh);
    write_point_data(with_fields, mesh, data, holds ? arguments.msh : MshOptions{});
  }
  fmt::print("{}: {} quads, {} triangles, {} vertices in {:.2f} s\n", arguments.output.string(),
             made.result.mesh.quads.size(), made.result.mesh.triangles.size(), made.result.mesh.points.size(),
             command.seconds());
  if (!holds) fmt::print("{}: the same mesh with the fields\n", with_fields.string());
  print_errors(spec.norm, solution, made);
  print_metrics(made.result.metrics);
  return kDone;
}

}  // namespace

void add_adapt(CLI::App& app, Commands& commands) {
  const auto [adapt, arguments] = add_command(
      app, commands, "adapt", "Mesh anew so that a solution has the least error", adapt_command, true);
  adapt
      ->add_option("fields", arguments.fields,
                   "FILE:FIELD, values at the points of an .msh or .vtu file, and more fields; of vectors "
                   "each component")
      ->required();
  adapt
      ->add_option("-o,--output", arguments.output,
                   "mesh to write, with the fields (.msh, .vtu), or with these beside it (.vtu)")
      ->required();
  CLI::Option* quads = adapt->add_option("--quads", arguments.quads, "about how many")->check(kLength);
  adapt
      ->add_option("--error", arguments.error,
                   "that is to be left, in the norm; of several fields the largest")
      ->check(kLength)
      ->excludes(quads);
  adapt->add_option("--norm", arguments.norm_text, "p of the Lp norm of the error, from 1; or inf")
      ->capture_default_str();
  adapt->add_option("--h-min", arguments.limits.min, "least length")->check(kLength);
  adapt->add_option("--h-max", arguments.limits.max, "largest length; default: the domain's diagonal")
      ->check(kLength);
  adapt->add_option("--aspect", arguments.limits.aspect, "the most that a length is of the one across")
      ->check(kLength);
  adapt
      ->add_option("--gradation", arguments.gradation,
                   "the most that lengths grow by per unit length, a factor")
      ->capture_default_str();
  adapt->add_option(
      "--goal-weight", arguments.weight_field,
      "FILE:FIELD, or a field of the first file, at least 0: how much errors count, such as an adjoint");
  adapt->add_flag("--isotropic", arguments.isotropic, "squares");
  adapt->add_option("--model", arguments.model,
                    "planar model to mesh (.toml); default: what the mesh of the file bounds");
  static const std::map<std::string, Transfer> ways = {{"interpolated", Transfer::kInterpolated},
                                                       {"conservative", Transfer::kConservative},
                                                       {"bounded", Transfer::kBounded}};
  adapt
      ->add_option(
          "--transfer", arguments.transfer,
          "of the fields: interpolated (default), conservative: their integrals stay, or bounded: so, within "
          "their extremes nearby")
      ->transform(CLI::CheckedTransformer(ways).description("interpolated, conservative or bounded"));
  adapt->add_option("--quality", arguments.quality, "fast, good or best")->capture_default_str();
  adapt->add_flag("--binary", arguments.msh.binary, "write .msh as bytes");
  add_threads(*adapt, arguments.threads);
}

}  // namespace delquad
