#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "mesher/stages.h"

namespace delquad {

/// The wanted size, as it was written.
struct SizeText {
  /// A number, an expression in x, y, z, "boundary" or a file, see size_file_of(); empty: boundary for line
  /// meshes.
  std::string base = {};
  std::filesystem::path folder = {};  ///< that files count from
  std::vector<SizeSource> sources = {};
  std::vector<NamedSize> named = {};
  double gradation = 0;    ///< the most |grad delta|; 0: no limit, or kCurvatureGradation with `curvature`
  double curvature = 0;    ///< elements per full turn, of surfaces; 0: sizes do not follow curvature
  double min = 0;          ///< least size that curvature asks for; 0: a twentieth of what it would be without
  double max = 0;          ///< largest size; 0: none
  std::string where = {};  ///< for messages
};

/// The wanted directions: "boundary", "size-aware", "gradient" or an angle expression in x, y, z (radians).
struct CrossText {
  std::string text = "boundary";
  std::string where;
};

/// Where data lies, seen from the folder that the program is called in, unless it is told otherwise.
inline constexpr const char* kDataFolder = "../shared/data";

/// A model with its fields and options: what a pipeline works on.
struct Case {
  std::string name;
  std::string where;  ///< file and line it was read from
  /// What an experiment varies, by title, and the folder of the results.
  std::vector<std::pair<std::string, std::string>> variant;
  std::string folder;
  long long seed = 0;  ///< 0: as it is; else the domain is turned, and nodes are shifted along curves
  std::optional<PlanarModel> model;    ///< analytic curves, or else
  std::filesystem::path mesh_file;     ///< a mesh of lines or of triangles in space, or else
  bool start = false;                  ///< words may begin from the elements of mesh_file, of any format
  std::filesystem::path surface_file;  ///< CAD or triangles, or else
  std::string example;                 ///< a model that the program makes itself
  std::filesystem::path model_file;    ///< the .toml file that one of these comes from; empty: none
  bool may_be_absent = false;          ///< the model's file is data that the case is skipped without
  SurfaceSpec surface;                 ///< of a mesh of triangles, surface_file or example
  std::vector<LayerSpec> layers;       ///< of a planar domain
  SizeText size;
  std::vector<CurveDivision> divisions;
  std::vector<PeriodicPair> periodic;
  MappedSpec mapped;
  SymmetrySpec symmetry;
  CrossText cross;
  int order = 1;  ///< of the elements
  Options options;
  long long max_elements = MeshProblem{}.max_elements;
  bool keep_going = false;  ///< leave faces out that cannot be meshed, instead of refusing the model
  std::filesystem::path data_folder;           ///< that the key `data` counts from; empty: it is not allowed
  std::map<std::string, std::string> compare;  ///< pipeline -> name of the published row to show beside it
};

bool has_model(const Case& c);
/// Where words on a case may begin.
inline WordStart word_start(const Case& c) { return c.start ? WordStart::kGivenMesh : WordStart::kBoundary; }
/// The file that the case's model is read from; empty: none.
const std::filesystem::path& model_path(const Case& c);

}  // namespace delquad
