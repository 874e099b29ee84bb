#include "sweep/versions.h"

#include "build_info.h"

namespace delquad {

std::vector<std::pair<std::string, std::string>> versions() {
  return {{"delquad", kVersion},          {"commit", kCommit},      {"build", kBuildType},
          {"compiler", kCompiler},        {"cgal", kCgalVersion},   {"eigen", kEigenVersion},
          {"lemon", kLemonVersion},       {"fmt", kFmtVersion},     {"nlohmann_json", kJsonVersion},
          {"muparser", kMuparserVersion}, {"ceres", kCeresVersion}, {"opencascade", kOcctVersion}};
}

}  // namespace delquad
