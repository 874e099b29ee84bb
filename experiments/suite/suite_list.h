#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/sweep/experiment.h"

namespace delquad {

enum class SuiteFamily { kPlanar, kCad, kTriangles, kHard, kMetric, kPublic };
inline constexpr std::array kSuiteFamilies = {SuiteFamily::kPlanar,    SuiteFamily::kCad,
                                              SuiteFamily::kTriangles, SuiteFamily::kHard,
                                              SuiteFamily::kMetric,    SuiteFamily::kPublic};

/// As the list and tables call it: "planar", "CAD", "triangles", "hard", "metric" or "public".
const char* name_of(SuiteFamily family);
/// Whether the ranking over all families has it: what every program can be asked, and has been.
bool is_for_all(SuiteFamily family);

/// A model of the suite, which comes in one case for each size: NAME_1, NAME_2, ...
struct SuiteModel {
  std::string name, about;
  SuiteFamily family;
  std::vector<std::string> sizes;  ///< coarse first: numbers in the model's unit, or formulas in x and y
  std::string sha256;              ///< see suite_digest(); empty: of a public model that is not checked
  std::string extension;           ///< of its file, with the dot
  std::string asks;                ///< the key of a case, in which SIZE is one of the sizes
  std::string text;                ///< the model file itself; empty: a maker has it, or a file
  std::filesystem::path file;      ///< of public models: below the folder where it is
};

/// The models that results are compared on, as experiments/suite/models.toml has them.
struct Suite {
  long long version = 0;
  std::vector<SuiteModel> models;
};
const Suite& suite();
/// That file, as it was when the program was built.
extern const std::string_view kSuiteText;

std::string case_name(const SuiteModel& model, std::size_t size);
/// "bracket.step"
std::string file_name(const SuiteModel& model);
/// What `delquad run` calls the experiment with all cases: it has the version.
std::string suite_title();

/// The content of a model's file: a model file without a size, STEP or OBJ, or a public file as it is. The
/// same bytes each time, but for STEP of different machines, whose numbers differ in their last digits.
/// Throws InputError where the program was built without OpenCASCADE and the model is CAD.
std::string make_suite_model(const SuiteModel& model);

/// SHA-256 of a model's file, in hexadecimal. Of STEP: without the header, all numbers rounded to six digits
/// after the point, so that it does not depend on the machine.
std::string suite_digest(const SuiteModel& model, const std::string& content);

/// What to take of the suite: models of these names in these families, all where none are given, and the
/// folders in which files of public models lie.
struct SuiteSelection {
  std::vector<std::string> names = {}, families = {};
  std::vector<std::filesystem::path> folders = {};
};

/// Of public models those whose files are there; one that is named has to be. Throws InputError for a name
/// that these families do not have, for a folder that is none, and where nothing is left.
std::vector<SuiteModel> select_models(const SuiteSelection& selection);

/// Writes all that other programs and ours need to mesh the cases of these models to a folder, which is made:
/// the models (.toml, .step, .obj), of planar cases the boundary as lines (NAME_1.msh, ...), cases.json with
/// the sizes, and suite.toml, the experiment. Throws InputError when something cannot be written, and when a
/// model is not the one that the list has the SHA-256 of: results could not be compared.
void write_suite(const std::filesystem::path& folder, const std::vector<SuiteModel>& models);

/// The models and suite.toml alone, as an experiment with one case for each model and size, in their order.
Experiment write_suite_experiment(const std::filesystem::path& folder, const std::vector<SuiteModel>& models);

}  // namespace delquad
