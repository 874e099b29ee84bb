// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>

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
#include "io/nodal_values.h"
#include "program/commands.h"
#include "program/mesh_options.h"
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

struct SolutionFile {
  std::filesystem::path path;
  MeshWithFields content;  ///< the mesh of the first file
};
struct SolutionField {
  std::filesystem::path file;
  MeshField field;
};

/// FILE:FIELD, or another FIELD of the first file.
SolutionField find_field(const std::string& text, std::vector<SolutionFile>& files) {
  SizeFile from{files.empty() ? "" : files[0].path, text};
  if (const auto given = size_file_of(text, {})) from = *given;
  if (from.path.empty()) refuse("'{}': expected FILE:FIELD with a .msh or .vtu file", text);
  auto file = std::ranges::find(files, from.path, &SolutionFile::path);
  if (file == files.end()) {
    MeshWithFields read = read_fields(from.path);
    const Mesh& first = files.empty() ? read.mesh : files[0].content.mesh;
    if (read.mesh.points != first.points || read.mesh.triangles != first.triangles ||
        read.mesh.quads != first.quads)
      refuse("{}: its mesh differs from the mesh of {}: expected fields on one mesh", text,
             files[0].path.string());
    if (!files.empty()) read.mesh = {};
    file = files.insert(files.end(), {from.path, std::move(read)});
  }
  const std::vector<MeshField>& fields = file->content.fields;
  return {from.path, fields[choose_field(fields, from.field, from.path.string(), {{1, 2, 3}, true})]};
}

/// Each component by its name: u, or u_x, u_y and u_z.
std::vector<NodalField> components_of(const MeshField& field, const std::string& name) {
  const auto width = static_cast<std::size_t>(field.n_components);
  std::vector<NodalField> components;
  for (std::size_t k = 0; k < width; ++k) {
    NodalField& one = components.emplace_back(NodalField{width == 1 ? name : name + "_" + "xyz" [k], {}});
    for (std::size_t i = k; i < field.values.size(); i += width) one.values.push_back(field.values[i]);
  }
  return components;
}

MeshField transferred(const Mesh& from, const MeshField& field, const Mesh& to, Transfer how) {
  const auto width = static_cast<std::size_t>(field.n_components);
  MeshField made{field.name, field.is_of_points, field.n_components, {}};
  std::vector<double> old(field.values.size() / width);
  for (std::size_t k = 0; k < width; ++k) {
    for (std::size_t i = 0; i < old.size(); ++i) old[i] = field.values[width * i + k];
    const std::vector<double> values =
        (field.is_of_points ? transfer_points : transfer_elements)(from, old, to, how);
    made.values.resize(width * values.size());
    for (std::size_t i = 0; i < values.size(); ++i) made.values[width * i + k] = values[i];
  }
  return made;
}

/// Returns all fields of the files on the next mesh. If several have one name, the last one counts. Fields
/// whose values are no numbers are left out with a warning.
std::vector<MeshField> carried_over(const Mesh& from, std::span<const SolutionFile> files,
                                    const std::vector<SolutionField>& asked, const Mesh& to, Transfer how,
                                    std::vector<Warning>& warnings) {
  std::map<std::pair<bool, std::string>, const MeshField*> last;
  for (const SolutionFile& file : files)
    for (const MeshField& field : file.content.fields) last[{!field.is_of_points, field.name}] = &field;
  last.erase({true, "eta"});  // write_mesh()'s of the old quads
  std::vector<MeshField> carried;
  for (const auto& [key, field] : last) {
    const bool is_requested =
        field->is_of_points && std::ranges::any_of(asked, [&](const SolutionField& other) {
          return other.field.name == field->name;
        });
    try {
      carried.push_back(transferred(from, *field, to, how));
    } catch (const InputError& error) {
      if (is_requested) throw;
      warnings.emplace_back(fmt::format("the field {} is not carried over: {}", field->name, error.what()));
    }
  }
  return carried;
}

std::string name_of_norm(double p) { return std::isinf(p) ? "maximum" : fmt::format("L{:g}", p); }

void print_errors(double norm, const Mesh& mesh, const std::vector<NodalField>& fields, const Adapted& made) {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto& [now, gradient, after] = made.errors[f];
    fmt::print(
        "  {}: error of interpolation {:.4g} ({}), of its gradient {:.4g} (L2), estimated on the {} elements "
        "of before; {:.4g} expected now\n",
        fields[f].name, now, name_of_norm(norm), gradient, mesh.triangles.size() + mesh.quads.size(), after);
  }
}

/// Prints how many regions and curves the mesh bounds, so that lost names are noticed.
void print_traced(const Mesh& mesh) {
  const auto count = [](const std::vector<Entity>& entities, const std::string& kind) {
    const auto named = std::ranges::count_if(entities, [](const Entity& e) { return !e.names.empty(); });
    return fmt::format("{} {}{} ({} with names)", entities.size(), kind, entities.size() == 1 ? "" : "s",
                       named);
  };
  fmt::print("  traced from the mesh: {}, {}\n", count(mesh.regions, "region"), count(mesh.curves, "curve"));
}

void print_carried(const std::vector<MeshField>& carried) {
  std::vector<std::string> names;
  for (const MeshField& field : carried)
    names.push_back(field.name + (field.is_of_points ? "" : " (of elements)"));
  fmt::print("  with the fields {}\n", fmt::join(names, ", "));
}

/// Warns of quads that are longer than solvers like, if nobody limited them.
void warn_of_long_quads(const AdaptSpec& spec, MeshResult& result) {
  constexpr double kLong = 100, kUsual = 20;
  const double aspect = result.metrics.values.at("aspect_max");
  if (spec.limits.aspect == 0 && !spec.isotropic && aspect > kLong)
    result.warnings.emplace_back(fmt::format(
        "quads are up to {:.3g} times as long as wide: --aspect {} limits the ratio", aspect, kUsual));
}

int adapt_command(const AdaptArguments& arguments) {
  const Stopwatch command;
  const RunScope run({.threads = arguments.threads});
  check_mesh_format(arguments.output, arguments.msh);
  check_output(arguments.output);
  AdaptSpec spec = arguments;
  if (spec.quads == 0 && spec.error == 0)
    refuse("expected --quads N, the number of quads, or --error E, the largest error");
  const auto norm = as_number(arguments.norm_text);
  spec.norm = arguments.norm_text == "inf" ? std::numeric_limits<double>::infinity() : norm.value_or(0);
  std::vector<SolutionFile> files;
  std::vector<SolutionField> asked;
  for (const std::string& text : arguments.fields) asked.push_back(find_field(text, files));
  std::vector<NodalField> fields;
  for (const auto& [file, field] : asked)
    for (NodalField& one :
         components_of(field, files.size() > 1 ? file.string() + ":" + field.name : field.name))
      fields.push_back(std::move(one));
  const std::size_t n_solutions = files.size();
  if (!arguments.weight_field.empty()) {
    MeshField weight = find_field(arguments.weight_field, files).field;
    if (weight.n_components > 1)
      refuse("--goal-weight {}: expected one number at each point", arguments.weight_field);
    spec.weight = std::move(weight.values);
  }
  const Mesh& mesh = files[0].content.mesh;
  std::optional<MeshProblem> problem;
  if (!arguments.model.empty()) problem = read_model_file(arguments.model);
  check_mesh_format(arguments.output, arguments.msh, std::max(mesh.order, problem ? problem->order : 1));
  const std::string kind = kind_of_file(arguments.output);
  const bool holds = kind == ".msh" || kind == ".vtu";
  const std::filesystem::path with_fields =
      holds ? arguments.output : std::filesystem::path(arguments.output).replace_extension(".vtu");
  for (const SolutionFile& file : files)
    check_distinct({{"the solution", file.path},
                    {"the model", arguments.model},
                    {"-o", arguments.output},
                    {"the fields beside it", holds ? "" : with_fields}});
  Progress progress;
  Adapted made = adapt(mesh, fields, spec, problem ? &*problem : nullptr);
  Mesh& next = made.result.mesh;
  reduce_bandwidth(next);
  const std::vector<MeshField> carried = carried_over(mesh, std::span(files).first(n_solutions), asked, next,
                                                      arguments.transfer, made.result.warnings);
  warn_of_long_quads(spec, made.result);
  progress.warn(made.result.warnings);
  {
    const Uninterrupted whole;
    if (!holds) write_mesh(arguments.output, next, arguments.msh);
    write_fields(with_fields, next, carried, holds ? arguments.msh : MshOptions{});
  }
  fmt::print("{}: {} in {:.2f} s\n", arguments.output.string(), show_counts(next), command.seconds());
  if (!holds) fmt::print("{}: the same mesh with the fields\n", with_fields.string());
  if (!problem) print_traced(mesh);
  print_carried(carried);
  print_errors(spec.norm, mesh, fields, made);
  print_measures(made.result.metrics);
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
  adapt->add_option("--quality", arguments.quality, "fast, good, best or regular")->capture_default_str();
  add_msh_file(*adapt, arguments.msh);
  add_threads(*adapt, arguments.threads);
}

}  // namespace delquad
