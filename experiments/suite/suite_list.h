#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace delquad {

enum class SuiteFamily { kPlanar, kCad, kTriangles };

/// As the list and tables call it: "planar", "CAD" or "triangles".
const char* name_of(SuiteFamily family);

/// A model of the suite, which comes in one case for each size: NAME_1, NAME_2, ...
struct SuiteModel {
  std::string name, about;
  SuiteFamily family;
  std::vector<std::string> sizes;  ///< coarse first: numbers in the model's unit, or formulas in x and y
  std::string sha256;              ///< see suite_digest()
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

/// The content of a model's file: a model file without a size, STEP or OBJ. The same bytes each time, but
/// for STEP of different machines, whose numbers differ in their last digits. Throws InputError where the
/// program was built without OpenCASCADE and the model is CAD.
std::string make_suite_model(const SuiteModel& model);

/// SHA-256 of a model's file, in hexadecimal. Of STEP: without the header, all numbers rounded to six digits
/// after the point, so that it does not depend on the machine.
std::string suite_digest(const SuiteModel& model, const std::string& content);

}  // namespace delquad
