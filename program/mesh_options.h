// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "io/cases/case.h"

// This header has the command-line options of meshing. The program uses it.

namespace delquad {

/// Keys of a problem that the command line sets.
struct KeyArguments {
  struct Given {
    std::string option, key;
    std::vector<std::string> values;
  };
  std::vector<Given> given;
  bool keep_going = false;  ///< leave out parts that cannot be read or meshed
};
/// Adds options for the faces of surfaces, and `--keep-going`.
void add_surface(CLI::App& command, KeyArguments& arguments);
/// Sets the keys, which override the model. Throws InputError that names the option.
void set_keys(const KeyArguments& arguments, Case& c);

struct MeshArguments : KeyArguments {
  bool improve = false;  ///< the model is a mesh from which pipelines begin
  std::filesystem::path model, output, json;
  std::filesystem::path fields;  ///< file of wanted fields; empty: none
  std::string depth;             ///< raster of depths for the mesh; empty: none
  std::string metric;            ///< empty: as the model says
  bool serendipity = false;      ///< quads of order 2 have 8 nodes
  bool keep_numbers = false;     ///< keep the numbers of nodes from the stages
  std::string quality = kDefaultQuality;
  std::optional<std::string> pipeline;  ///< absent: the pipeline of that quality
  long long max_elements = 50'000'000;
  int threads = thread_count();
  bool view = false;  ///< show the mesh afterwards
  bool allow_triangles = false;
  bool allow_unsound = false;
  bool strict = false, failing_sets = false, try_cures = false;
  MshOptions msh{false, MshCurves::kNamed};
};
/// Throws InputError for `--triangles` with a deck whose elements are kept.
void check_triangles(const std::filesystem::path& source, const std::filesystem::path& output,
                     const MshOptions& msh);
/// Adds `--binary`, `--triangles` and `--curves`.
void add_msh(CLI::App& command, MshOptions& msh);
/// Adds --binary and --msh-version alone.
void add_msh_file(CLI::App& command, MshOptions& msh);
/// Adds the model and all options for its quads. Returns the option of the model.
CLI::Option* add_model(CLI::App* mesh, MeshArguments& arguments);
/// Add the commands `mesh` and `improve` with their options, and return them.
CLI::App* add_mesh_options(CLI::App& app, MeshArguments& arguments);
CLI::App* add_improve_options(CLI::App& app, MeshArguments& arguments);
/// Sets all options of the command line, which override the model. Throws InputError that names the option.
void set_problem(const MeshArguments& arguments, Case& c);

}  // namespace delquad
