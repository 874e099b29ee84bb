// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "delquad/adapt.h"
#include "delquad/mesher.h"

// This header has cases of experiments. The program, the bench and readers and writers use it.

namespace delquad {

/// Where data lies, seen from the folder that the program is called in, unless it is told otherwise.
inline constexpr const char* kDataFolder = "../shared/data";

/// Meshes that follow a solution, of which the last one counts.
struct AdaptLoop {
  std::string kind = "stretched";  ///< one of adapt_kinds()
  int meshes = 6;                  ///< the first of which is uniform
  AdaptSpec spec = {};             ///< its number of quads is the number of the case
};

/// The part of a case that is no problem of meshing.
struct CaseOfStudy {
  /// Keys that an experiment varies, by title, with their values; the folder of the results.
  std::vector<std::pair<std::string, std::string>> variant = {};
  std::string folder = {};
  std::filesystem::path model_file = {};   ///< the .toml file that the model comes from; empty: none
  bool may_be_absent = false;              ///< the model's file is data that the case is skipped without
  std::filesystem::path data_folder = {};  ///< that the key `data` counts from; empty: it is not allowed
  std::string domain = {};                 ///< what its results count as, with others; empty: its geometry
  std::string solution = {};  ///< a formula in x and y, that is computed with; empty: the domain's own
  std::optional<AdaptLoop> adapt = {};  ///< to it
  std::map<std::string, std::string> compare =
      {};  ///< pipeline -> name of the published row to show beside it
};

/// A problem, and what else its file says: what a pipeline works on.
struct Case : MeshProblem, CaseOfStudy {
  Case() { where.clear(), size.where.clear(), cross.where.clear(); }  // nobody has asked for anything
};

bool has_model(const MeshProblem& problem);
/// Returns the planar model; null unless the model is one of curves.
const PlanarModel* planar_model(const MeshProblem& problem);
/// Returns the name of the example that the model is; empty: it is none.
std::string example_of(const MeshProblem& problem);
/// Returns the file that the model is read from; empty: none.
std::filesystem::path model_path(const MeshProblem& problem);

}  // namespace delquad
