#include "pipeline/case_keys.h"

#include <fmt/format.h>

namespace delquad {
namespace toml_types {

std::string at_least(const std::string& type, double least) {
  return fmt::format(R"({{"type": "{}", "minimum": {}}})", type, least);
}

std::string between(const std::string& type, double least, double most) {
  return fmt::format(R"({{"type": "{}", "minimum": {}, "maximum": {}}})", type, least, most);
}

std::string above(double low, double most) {
  return fmt::format(R"({{"type": "number", "exclusiveMinimum": {}, "maximum": {}}})", low, most);
}

std::string one_of(const std::vector<std::string>& texts) {
  return fmt::format(R"({{"enum": ["{}"]}})", fmt::join(texts, R"(", ")"));
}

}  // namespace toml_types

namespace {

using namespace toml_types;

const std::string kPoint = R"({"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2})";
const std::string kSpacePoint =
    R"({"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 3})";
const std::string kVector = R"({"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3})";
const std::string kTextOrTexts = R"({"type": ["string", "array"], "items": {"type": "string"}})";
const std::string kWords = R"({"type": "object", "additionalProperties": {"type": "string"}})";
const std::string kCompound =
    R"({"anyOf": [{"enum": ["all", "tangent"]},
                  {"type": "array", "items": {"type": "array", "items": {"type": "integer"}, "minItems": 2}}]})";
constexpr double kMostRounds = 1e6;

std::string points(int least) {
  return fmt::format(R"({{"type": "array", "items": {}, "minItems": {}}})", kPoint, least);
}

std::string two_points() {
  return fmt::format(R"({{"type": "array", "items": {}, "minItems": 2, "maxItems": 2}})", kPoint);
}

/// Shapes that are closed by themselves, and what may stand beside each.
TomlKeys closed_shapes() {
  return {{"rectangle", "two opposite corners", two_points()},
          {"polygon", "corners, in either direction", points(3)},
          {"circle", "a circle", "", &circle_keys()},
          {"boundary", "name of its curves, or one for each", kTextOrTexts},
          {"region", "name of what is inside", kText},
          {"hole", "whether it must be a hole", kFlag}};
}

}  // namespace

const TomlKeys& circle_keys() {
  static const TomlKeys keys = {{"centre", "[x, y]", kPoint, nullptr, false, true},
                                {"radius", "a length", kPositive, nullptr, false, true}};
  return keys;
}

const TomlKeys& arc_keys() {
  static const TomlKeys keys = {
      {"centre", "[x, y]", kPoint, nullptr, false, true},
      {"radius", "a length", kPositive, nullptr, false, true},
      {"from", "degrees", kNumber, nullptr, false, true},
      {"to", "degrees; counterclockwise where it is more", kNumber, nullptr, false, true}};
  return keys;
}

const TomlKeys& expression_keys() {
  static const TomlKeys keys = {{"x", "formula in t", kExpression, nullptr, false, true},
                                {"y", "formula in t", kExpression, nullptr, false, true},
                                {"from", "first t", kNumber, nullptr, false, true},
                                {"to", "last t", kNumber, nullptr, false, true}};
  return keys;
}

const TomlKeys& curve_keys() {
  static const TomlKeys keys = {{"name", "what loops call it", kText, nullptr, false, true},
                                {"boundary", "its physical group; else the name", kText},
                                {"segment", "two points", two_points()},
                                {"polyline", "points, each of which gets a node", points(2)},
                                {"arc", "a part of a circle", "", &arc_keys()},
                                {"circle", "a circle", "", &circle_keys()},
                                {"expression", "formulas", "", &expression_keys()}};
  return keys;
}

const TomlKeys& loop_keys() {
  static const TomlKeys keys = [] {
    TomlKeys all = closed_shapes();
    all.push_back({"curves", "names of curves that close up", kTexts});
    return all;
  }();
  return keys;
}

const TomlKeys& pattern_keys() {
  static const TomlKeys keys = [] {
    TomlKeys all = closed_shapes();
    all.push_back({"count", "how many, [nx, ny]", kPoint, nullptr, false, true});
    all.push_back({"step", "from one to the next, [dx, dy]", kPoint, nullptr, false, true});
    return all;
  }();
  return keys;
}

const TomlKeys& mirror_keys() {
  static const TomlKeys keys = {
      {"point", "of the plane, [x, y, z]", kVector, nullptr, false, true},
      {"normal", "of the plane, [x, y, z]", kVector, nullptr, false, true},
      {"tolerance", "how far from it shared edges are, in diagonals", between("number", 0, 0.1)},
      {"join", "whether faces run on through the plane", kFlag}};
  return keys;
}

const TomlKeys& surface_keys() {
  static const TomlKeys keys = {
      {"compound", "faces to mesh as one", kCompound},
      {"merge_curves", "shorter curves become one with a neighbour", kPositive},
      {"feature_angle", "degrees", above(0, 180)},
      {"weld_tolerance", "how far apart open edges may be, in diagonals", between("number", 0, 0.1)},
      {"mirror", "the model is one half", "", &mirror_keys()}};
  return keys;
}

const TomlKeys& source_keys() {
  static const TomlKeys keys = {{"at", "a point", kSpacePoint, nullptr, false, true},
                                {"to", "the other end, of a segment", kSpacePoint},
                                {"near", "size up to radius_near", kPositive, nullptr, false, true},
                                {"far", "size beyond radius_far", kPositive, nullptr, false, true},
                                {"radius_near", "a length; 0 if absent", at_least("number", 0)},
                                {"radius_far", "a length", kPositive, nullptr, false, true}};
  return keys;
}

const TomlKeys& size_keys() {
  static const TomlKeys keys = {{"base", "a number, an expression or \"boundary\"", kExpression},
                                {"source", "points and segments with sizes", "", &source_keys(), true},
                                {"gradation", "the most that sizes grow by per length", kPositive},
                                {"curvature", "of surfaces: elements per full turn", at_least("number", 3)},
                                {"min", "least size that curvature asks for", kPositive},
                                {"max", "largest size", kPositive}};
  return keys;
}

const TomlKeys& insertion_keys() {
  static const TomlKeys keys = {
      {"h_max", "size of the triangles' circles that count as resolved", between("number", 1.1, 3)},
      {"rejection", "least distance between points, in sizes", above(0, 0.95)},
      {"boundary_height", "least height over the boundary, in sizes", above(0, 0.95)},
      {"lower_clamp", "whether triangles have a least size", kFlag}};
  return keys;
}

const TomlKeys& smoothing_keys() {
  static const TomlKeys keys = {{"method", "what makes the energy smaller", one_of({"lpcvt", "lloyd"})},
                                {"p", "norm", R"({"enum": [2, 4, 6, 8, 10, 12, 14, 16]})"},
                                {"outer_iterations", "how often size and directions are taken anew",
                                 between("integer", 0, kMostRounds)},
                                {"inner_iterations", "steps for each", between("integer", 0, kMostRounds)},
                                {"rank", "of L-BFGS", between("integer", 1, 1000)},
                                {"function_tolerance", "relative", at_least("number", 0)},
                                {"gradient_tolerance", "absolute", at_least("number", 0)}};
  return keys;
}

const TomlKeys& recombination_keys() {
  static const TomlKeys keys = {{"treatment", "after the matching", one_of({"none", "paper"})},
                                {"max_rounds", "of the treatment", between("integer", 0, kMostRounds)}};
  return keys;
}

const TomlKeys& cleanup_keys() {
  static const TomlKeys keys = {
      {"rounds", "of annealing; 0: greedy only", between("integer", 0, kMostRounds)},
      {"tolerance", "what an edit may cost in the first round", above(0, 1)},
      {"seed", "of the annealing", at_least("integer", 0)}};
  return keys;
}

const TomlKeys& optimisation_keys() {
  static const TomlKeys keys = {{"passes", "how often", between("integer", 0, 1000)},
                                {"iterations", "of L-BFGS in each", between("integer", 1, 1e5)},
                                {"size", "weight", at_least("number", 0)},
                                {"alignment", "weight", at_least("number", 0)}};
  return keys;
}

const TomlKeys& repair_keys() {
  static const TomlKeys keys = {
      {"part_twins", "whether edges and quads that two faces have in common are parted", kFlag},
      {"lift_bad_quads", "whether quads that are bad in space are lifted there", kFlag}};
  return keys;
}

const TomlKeys& case_keys() {
  static const TomlKeys keys = {
      {"loop", "closed loops", "", &loop_keys(), true},
      {"pattern", "a loop repeated on a grid", "", &pattern_keys(), true},
      {"curve", "curves that loops are made of", "", &curve_keys(), true},
      {"example", "a surface that the program makes itself", kText},
      {"mesh", "an MSH file", kText},
      {"model", "a model file, a surface or an MSH file", kText},
      {"data", "a surface or MSH file in the folder of --data", kText},
      {"surface", "what becomes of a surface's faces", "", &surface_keys()},
      {"size", "wanted edge length", kExpression, &size_keys()},
      {"cross", "wanted directions: boundary, size-aware, gradient or an angle", kExpression},
      {"seed", "above 0, the domain is changed a little at random", at_least("integer", 0)},
      {"insertion", "options of F, D and P", "", &insertion_keys()},
      {"smoothing", "options of L", "", &smoothing_keys()},
      {"recombination", "options of B", "", &recombination_keys()},
      {"cleanup", "options of C", "", &cleanup_keys()},
      {"optimisation", "options of O", "", &optimisation_keys()},
      {"repair", "of surfaces: what happens beside the stages", "", &repair_keys()},
      {"compare", "published row beside each pipeline", kWords}};
  return keys;
}

}  // namespace delquad
