#include "experiments/suite/suite_list.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "experiments/suite/planar_models.h"
#include "experiments/suite/suite_text.h"
#include "experiments/suite/triangle_models.h"
#include "geometry/cad/example_models.h"
#include "io/text_writer.h"

namespace delquad {
namespace {

SuiteFamily family_of(const std::string& name) {
  for (const SuiteFamily family : {SuiteFamily::kPlanar, SuiteFamily::kCad, SuiteFamily::kTriangles})
    if (name == name_of(family)) return family;
  throw std::logic_error("models.toml: unknown family " + name);
}

std::string size_text(const toml::node& size) {
  if (const auto text = size.value<std::string>()) return *text;
  return fmt::format("{}", size.value<double>().value());
}

SuiteModel read_model(const toml::table& table) {
  const auto text = [&](const char* key) { return table[key].value<std::string>().value(); };
  SuiteModel model{text("name"), text("about"), family_of(text("family")), {}, text("sha256")};
  for (const toml::node& size : *table["sizes"].as_array()) model.sizes.push_back(size_text(size));
  return model;
}

template <class Maker>
const Maker& find_maker(const std::vector<Maker>& makers, const std::string& name) {
  const auto at = std::ranges::find_if(makers, [&](const Maker& maker) { return maker.name == name; });
  if (at == makers.end()) throw std::logic_error("nothing makes the model " + name);
  return *at;
}

std::string obj_text(const Mesh& mesh) {
  std::ostringstream stream;
  TextWriter out(stream);
  for (const Vec3& p : mesh.points) out << "v " << p.x << " " << p.y << " " << p.z << "\n";
  for (const auto& [a, b, c] : mesh.triangles) out << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  out.flush();
  return stream.str();
}

}  // namespace

const char* name_of(SuiteFamily family) {
  switch (family) {
    case SuiteFamily::kPlanar:
      return "planar";
    case SuiteFamily::kCad:
      return "CAD";
    case SuiteFamily::kTriangles:
      break;
  }
  return "triangles";
}

const Suite& suite() {
  static const Suite list = [] {
    const toml::table table = toml::parse(kSuiteText);
    Suite result{table["version"].value<long long>().value(), {}};
    for (const toml::node& model : *table["model"].as_array())
      result.models.push_back(read_model(*model.as_table()));
    return result;
  }();
  return list;
}

std::string case_name(const SuiteModel& model, std::size_t size) {
  return fmt::format("{}_{}", model.name, size + 1);
}

std::string file_name(const SuiteModel& model) {
  switch (model.family) {
    case SuiteFamily::kPlanar:
      return model.name + ".toml";
    case SuiteFamily::kCad:
      return model.name + ".step";
    case SuiteFamily::kTriangles:
      break;
  }
  return model.name + ".obj";
}

std::string suite_title() { return fmt::format("Suite {}", suite().version); }

std::string make_suite_model(const SuiteModel& model) {
  if (model.family == SuiteFamily::kPlanar) return find_maker(planar_suite_models(), model.name).make();
  if (model.family == SuiteFamily::kTriangles)
    return obj_text(find_maker(triangle_suite_models(), model.name).make());
  std::ostringstream out;
  write_example(model.name, CadFormat::kStep, out);
  return out.str();
}

}  // namespace delquad
