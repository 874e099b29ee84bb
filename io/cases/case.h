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

/// Default folder of data, relative to the working folder.
inline constexpr const char* kDataFolder = "../shared/data";

/// Meshes that follow a solution; the last one counts.
struct AdaptLoop {
  std::string kind = "stretched";  ///< one of adapt_kinds()
  int meshes = 6;                  ///< number of meshes, from 2 to 100; the first is uniform
  AdaptSpec spec = {};             ///< its number of quads is the number of the case
};

/// The part of a case that is no problem of meshing.
struct CaseOfStudy {
  /// Keys that an experiment varies, by title, with their values; folder of the results.
  std::vector<std::pair<std::string, std::string>> variant = {};
  std::string folder = {};
  std::filesystem::path model_file = {};   ///< the .toml file that the model comes from; empty: none
  bool may_be_absent = false;              ///< without the model's file, which is data, the case is skipped
  std::filesystem::path data_folder = {};  ///< base of the key `data`; empty: the key is not allowed
  std::string domain = {};    ///< domain of its results, which cases may share; empty: by geometry
  std::string solution = {};  ///< formula in x and y of Poisson's solution; empty: made from the domain
  std::optional<AdaptLoop> adapt = {};              ///< loop to this solution
  std::map<std::string, std::string> compare = {};  ///< published row beside each pipeline
};

/// A problem with the further entries of its file: the input of a pipeline.
struct Case : MeshProblem, CaseOfStudy {
  Case() { where.clear(), size.where.clear(), cross.where.clear(); }  // nobody has asked for anything
};

bool has_model(const MeshProblem& problem);
/// Returns the planar model; null unless the model is one of curves.
const PlanarModel* planar_model(const MeshProblem& problem);
/// Returns the name of the example that is the model; empty: none is.
std::string example_of(const MeshProblem& problem);
/// Returns the file that the model is read from; empty: none.
std::filesystem::path model_path(const MeshProblem& problem);

}  // namespace delquad
