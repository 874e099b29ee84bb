#include "io/cases/case_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "delquad/mesher.h"

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
const std::string kTextsAndTables =
    R"({"type": ["string", "array"], "items": {"type": ["string", "object"]}})";
const std::string kTextsOrPoints =
    R"({"type": "array", "items": {"type": ["string", "array"], "items": {"type": "number"}}, "minItems": 3, "maxItems": 4})";
const std::string kWords = R"({"type": "object", "additionalProperties": {"type": "string"}})";
const std::string kCompound =
    R"({"anyOf": [{"enum": ["all", "tangent"]},
                  {"type": "array", "items": {"type": "array", "items": {"type": "integer"}, "minItems": 2}}]})";

std::string points(int least, const std::string& point = kPoint) {
  return fmt::format(R"({{"type": "array", "items": {}, "minItems": {}}})", point, least);
}

std::string points_or_file() { return fmt::format(R"({{"anyOf": [{}, {{"type": "string"}}]}})", points(2)); }

std::string two_points() {
  return fmt::format(R"({{"type": "array", "items": {}, "minItems": 2, "maxItems": 2}})", kPoint);
}

/// Shapes that are closed by themselves, and what may stand beside each.
TomlKeys closed_shapes() {
  return {
      {"rectangle", "two opposite corners", two_points()},
      {"polygon", "corners, in either direction", points(3)},
      {"circle", "a circle", "", circle_keys},
      {"boundary", "name of its curves, or one for each; not with 'curves', which have names", kTextOrTexts},
      {"region", "name of what is inside", kText},
      {"hole", "whether it must be a hole", kFlag}};
}

constexpr const char* kCompare = "compare";

/// The type of an option's value, as JSON Schema.
std::string type_of(const OptionKey& key) {
  if (const std::vector<OptionValue> allowed = allowed_values(key); !allowed.empty()) {
    std::vector<std::string> texts;
    for (const OptionValue& value : allowed) texts.push_back(text_of(value));
    return fmt::format(R"({{"enum": [{}]}})", fmt::join(texts, ", "));
  }
  const char* types[] = {"boolean", "integer", "number", "string"};
  std::string type = fmt::format(R"({{"type": "{}")", types[key.value.index()]);
  const auto add = [&](const char* name, const std::optional<double>& limit) {
    if (limit) type += fmt::format(R"(, "{}": {})", name, *limit);
  };
  add("minimum", key.least);
  add("exclusiveMinimum", key.above);
  add("maximum", key.most);
  return type + "}";
}

}  // namespace

TomlKeys circle_keys() {
  return {{"centre", "[x, y]", kPoint, nullptr, false, true},
          {"radius", "a length", kPositive, nullptr, false, true}};
}

TomlKeys arc_keys() {
  return {{"centre", "[x, y]", kPoint, nullptr, false, true},
          {"radius", "a length", kPositive, nullptr, false, true},
          {"from", "degrees", kNumber, nullptr, false, true},
          {"to", "degrees; counterclockwise where it is more", kNumber, nullptr, false, true}};
}

TomlKeys expression_keys() {
  return {{"x", "formula in t", kExpression, nullptr, false, true},
          {"y", "formula in t", kExpression, nullptr, false, true},
          {"from", "first t", kNumber, nullptr, false, true},
          {"to", "last t", kNumber, nullptr, false, true}};
}

namespace {

/// Those that begin, then the shapes.
TomlKeys with_shapes(TomlKeys keys) {
  for (const TomlKey& shape :
       TomlKeys{{"segment", "two points", two_points()},
                {"polyline", "points, each of which gets a node, or a file of them", points_or_file()},
                {"spline", "points that a smooth curve goes through, or a file", points_or_file()},
                {"arc", "a part of a circle", "", arc_keys},
                {"circle", "a circle", "", circle_keys},
                {"expression", "formulas", "", expression_keys}})
    keys.push_back(shape);
  return keys;
}

}  // namespace

TomlKeys curve_keys() {
  return with_shapes({{"name", "what loops call it", kText, nullptr, false, true},
                      {"boundary", "its name in all but loops; else 'name'", kText}});
}

TomlKeys embed_keys() {
  TomlKeys all = with_shapes({{"name", "its physical group", kText},
                              {"crack", "whether the mesh comes apart along it", kFlag},
                              {"point", "a point that becomes a node", kSpacePoint}});
  std::ranges::find(all, "polyline", &TomlKey::name)->type = points(2, kSpacePoint);
  return all;
}

TomlKeys loop_keys() {
  TomlKeys all = closed_shapes();
  all.push_back({"curves", "names of curves that close up", kTexts});
  return all;
}

TomlKeys pattern_keys() {
  TomlKeys all = closed_shapes();
  all.push_back({"count", "how many, [nx, ny]", kPoint, nullptr, false, true});
  all.push_back({"step", "from one to the next, [dx, dy]", kPoint, nullptr, false, true});
  return all;
}

TomlKeys mirror_keys() {
  return {{"point", "of the plane, [x, y, z]", kVector, nullptr, false, true},
          {"normal", "of the plane, [x, y, z]", kVector, nullptr, false, true},
          {"tolerance", "how far from it shared edges are, in diagonals", between("number", 0, 0.1)},
          {"join", "whether faces run on through the plane", kFlag}};
}

TomlKeys named_part_keys() {
  return {{"as", "the name that it gets", kText, nullptr, false, true},
          {"of", "faces, or curves", one_of({"faces", "curves"})},
          {"number", "as 'delquad info' lists them", R"({"type": "array", "items": {"type": "integer"}})"},
          {"like", "one of its names: * is any text, ? a letter", kText},
          {"box", "that holds it whole: two opposite corners", points(2, kVector)},
          {"normal", "its own everywhere, within 5 degrees", kVector},
          {"at", "it is nearest to this place", kVector}};
}

TomlKeys surface_keys() {
  return {{"compound", "faces to mesh as one", kCompound},
          {"merge_curves", "shorter curves become one with a neighbour", kPositive},
          {"feature_angle", "degrees", above(0, 180)},
          {"weld_tolerance", "how far apart open edges may be, in diagonals", between("number", 0, 0.1)},
          {"mirror", "the model is one half", "", mirror_keys},
          {"ignore_below", "narrower faces become part of neighbours, shorter curves points", kPositive},
          {"idealize", "whether ignore_below is min_length of the criteria", kFlag},
          {"name", "names of faces and curves", "", named_part_keys, true},
          {"keep", "names of faces and curves that are not left out", kTexts},
          {"fill_holes", "diameter: holes that are not wider are closed", kPositive},
          {"simplify", "polylines, to so many sizes", at_least("number", 0)},
          {"glue", "whether bodies of CAD share what they touch at", kFlag},
          {"unit", "of lengths", one_of({"um", "mm", "cm", "m", "km", "in", "ft"})}};
}

TomlKeys source_keys() {
  return {{"at", "a point", kSpacePoint, nullptr, false, true},
          {"to", "the other end, of a segment", kSpacePoint},
          {"near", "size up to radius_near", kPositive, nullptr, false, true},
          {"far", "size beyond radius_far", kPositive, nullptr, false, true},
          {"radius_near", "a length; 0 if absent", at_least("number", 0)},
          {"radius_far", "a length", kPositive, nullptr, false, true}};
}

TomlKeys division_keys() {
  return {{"name", "of curves", kText, nullptr, false, true},
          {"edges", "of each of them", at_least("integer", 1), nullptr, false, true},
          {"progression", "length of each edge, of that before it", kPositive},
          {"bump", "length of edges at the ends, of those in the middle", kPositive}};
}

TomlKeys periodic_keys() {
  return {{"from", "name of curves or faces", kText, nullptr, false, true},
          {"to", "name of their images", kText, nullptr, false, true},
          {"translate", "[x, y] or [x, y, z]", kSpacePoint},
          {"rotate", "degrees, counterclockwise", kNumber},
          {"centre", "of the rotation; the origin if absent", kSpacePoint},
          {"axis", "of the rotation; z if absent", kVector}};
}

TomlKeys mapped_keys() {
  return {{"name", "of a region or face", kText, nullptr, false, true},
          {"corners", "three or four: names of points, or places", kTextsOrPoints, nullptr, false, true}};
}

TomlKeys symmetry_keys() {
  return {{"point", "of the plane", kSpacePoint, nullptr, false, true},
          {"normal", "of the plane", kSpacePoint, nullptr, false, true}};
}

TomlKeys named_size_keys() {
  return {{"name", "of curves, points, regions or faces", kText, nullptr, false, true},
          {"size", "at most, on them and in them", kPositive},
          {"reach", "how far from them, too; 0 if absent", at_least("number", 0)},
          {"growth", "of sizes from there on, per length; 0.3 if absent", kPositive},
          {"curvature", "elements per full turn", at_least("number", 3)}};
}

TomlKeys size_keys() {
  return {{"base", "a number, an expression, a file or \"boundary\"", kSize},
          {"source", "points and segments with sizes", "", source_keys, true},
          {"on", "sizes of what has a name", "", named_size_keys, true},
          {"gradation", "the most that sizes grow by per length", kPositive},
          {"curvature", "elements per full turn of curves and faces", at_least("number", 3)},
          {"min", "least size that curvature asks for", kPositive},
          {"max", "largest size", kPositive}};
}

TomlKeys metric_spec_keys() {
  return {{"tensor", "formulas of m11, m12, m22; of surfaces m11, m12, m13, m22, m23, m33", kTexts},
          {"chord", "of surfaces: how far sides stray from an arc, by direction", kPositive},
          {"sizes", "formulas of h1, h2 and the direction of h1, in radians", kTexts},
          {"solution", "a formula that is to be interpolated well", kText},
          {"file", "FILE or FILE:FIELD with tensors at the points of its mesh", kText},
          {"min", "least length", kPositive},
          {"max", "largest length", kPositive},
          {"aspect", "the most that one length is of the other", at_least("number", 1)},
          {"gradation", "the most that lengths grow by per unit length, a factor", at_least("number", 1)},
          {"complexity", "about the number of quads: lengths are scaled to it", kPositive}};
}

TomlKeys layer_keys() {
  return {{"on", "names of curves that bound regions", kTextOrTexts, nullptr, false, true},
          {"into", "names of the regions that get them; absent: on both sides of the curves", kTextOrTexts},
          {"first", "height of the quads at the curve", kPositive, nullptr, false, true},
          {"growth", "height of a quad by that of the one below", at_least("number", 1)},
          {"number", "quads that stand on each other", between("integer", 1, 10000)},
          {"thickness", "instead of the number: height of all of them", kPositive},
          {"fan", "degrees by which corners with a fan turn away", above(0, 120)}};
}

namespace {

TomlKeys range_and_rows(const char* range, const char* of) {
  return {{range, of, R"({"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2})",
           nullptr, false, true},
          {"rows", "of quads; 1 if absent", at_least("integer", 1)}};
}

}  // namespace

TomlKeys washer_keys() {
  TomlKeys keys = range_and_rows("diameter", "of the holes, [least, most]");
  keys.push_back({"edges", "around, even; absent: as the size asks for", at_least("integer", 4)});
  keys.push_back({"width", "of all rows; absent: as high as edges are long", kPositive});
  return keys;
}

TomlKeys fillet_keys() { return range_and_rows("radius", "of the fillets, [least, most]"); }

TomlKeys material_keys() {
  return {{"young", "Young's modulus", kPositive, nullptr, false, true},
          {"poisson", "Poisson's ratio", between("number", 0, 1), nullptr, false, true},
          {"density", "mass per volume", kPositive, nullptr, false, true}};
}

namespace {

/// Those that begin, then the limits.
TomlKeys with_criteria(TomlKeys keys) {
  for (const Criterion& criterion : criterion_registry())
    keys.push_back({criterion.key, "limit, by " + criterion.source, kExpression});
  return keys;
}

}  // namespace

TomlKeys named_criteria_keys() {
  return with_criteria({{"name", "of curves or regions", kText, nullptr, false, true}});
}

TomlKeys criteria_keys() {
  return with_criteria(
      {{"name", "for reports", kText},
       {"preset", "limits to begin with: batch, crash or static", one_of({"batch", "crash", "static"})},
       {"on", "limits of what has a name, in place of the others", "", named_criteria_keys, true},
       {"material", "for times", "", material_keys},
       {"time_step_by", "whose length times go by", one_of({"ls-dyna", "radioss", "abaqus"})},
       {"strict", "whether a mesh with elements that fail is not written", kFlag}});
}

TomlKeys keys_of(const OptionGroup& group) {
  TomlKeys keys;
  for (const OptionKey& key : group.keys) keys.push_back({key.name, key.help, type_of(key)});
  return keys;
}

TomlKeys case_keys() {
  TomlKeys keys = {
      {"loop", "closed loops", "", loop_keys, true},
      {"pattern", "a loop repeated on a grid", "", pattern_keys, true},
      {"curve", "curves that loops are made of", "", curve_keys, true},
      {"embed", "curves and points inside of regions, polylines and points on surfaces", "", embed_keys,
       true},
      {"example", "a surface that the program makes itself", kText},
      {"mesh", "an MSH file; with 'start' of any format", kText},
      {"start", "words may begin from the elements of that mesh", kFlag},
      {"model", "a model file, a surface or an MSH file", kText},
      {"data", "a surface or MSH file in the folder of --data", kText},
      {"surface", "what becomes of a surface's faces", "", surface_keys},
      {"layer", "thin quads along curves", "", layer_keys, true},
      {"washers", "rows of quads around holes", "", washer_keys, true},
      {"fillet_rows", "rows of quads across fillets", "", fillet_keys, true},
      {"size", "wanted edge length", kSize, size_keys},
      {"metric", "lengths by direction, in place of a size", "", metric_spec_keys},
      {"divide", "numbers of edges of curves", "", division_keys, true},
      {"periodic", "curves and faces that get the nodes of others", "", periodic_keys, true},
      {"symmetry", "planes of symmetry, or \"auto\"", one_of({"auto"}), symmetry_keys, true},
      {"mapped", "regions or faces that become grids, or \"auto\"", kTextsAndTables, mapped_keys, true},
      {"cross", "wanted directions: boundary, size-aware, gradient or an angle", kExpression},
      {"order", "of the elements, 1 to 4: curved above 1", at_least("integer", 1)},
      {"refine", "by which all sizes are divided", kPositive},
      {"quads", "about how many, by other sizes", at_least("integer", 1)},
      {"criteria", "that meshes are judged by: a preset, a file or limits", kText, criteria_keys},
      {"seed", "above 0, the domain is changed a little at random", at_least("integer", 0)}};
  for (const OptionGroup& group : option_groups()) {
    if (std::ranges::find(keys, group.name, &TomlKey::name) != keys.end() || group.name == kCompare)
      throw std::logic_error("options '" + group.name + "': a key of cases has that name");
    keys.push_back({group.name, group.help, "", [group] { return keys_of(group); }});
  }
  keys.push_back({kCompare, "published row beside each pipeline", kWords});
  return keys;
}

std::string option_table_text() {
  std::string text = "| option | value | default | |\n|---|---|---|---|\n";
  for (const OptionGroup& group : option_groups())
    for (const OptionKey& key : group.keys)
      text += fmt::format("| `{}.{}` | {} | {} | {} |\n", group.name, key.name, expected_of(key),
                          key.absent.empty() ? text_of(key.value) : key.absent, key.help);
  return text;
}

}  // namespace delquad
