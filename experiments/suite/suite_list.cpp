#include "experiments/suite/suite_list.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "base/located.h"
#include "base/nearest_name.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/suite/model_makers.h"
#include "experiments/sweep/folders.h"
#include "experiments/sweep/peer.h"
#include "geometry/cad/example_models.h"
#include "io/cases/case.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"
#include "metrics/tables/table.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kAsksForSize = "size = \"SIZE\"";

void write_models(const fs::path& folder, const std::vector<SuiteModel>& models) {
  for (const SuiteModel& model : models) {
    const std::string content = make_suite_model(model), digest = suite_digest(model, content);
    if (!model.sha256.empty() && digest != model.sha256)
      refuse("{}: SHA-256 is {}: expected {}, of suite {}{}", file_name(model), digest, model.sha256,
             suite().version,
             model.extension == ".step" && model.file.empty()
                 ? "; another version of OpenCASCADE would explain it"
                 : "");
    write_text_file(folder / file_name(model), content);
  }
}

std::string experiment_text(const std::vector<SuiteModel>& models) {
  std::string text = fmt::format("title = \"{}\"\npipelines = [\"DB\", \"DBCO\"]\n", suite_title());
  for (const SuiteModel& model : models)
    for (std::size_t k = 0; k < model.sizes.size(); ++k)
      text += fmt::format("\n[[case]]\nname = \"{}\"\nmodel = \"{}\"\n{}\n", case_name(model, k),
                          file_name(model), replace_all(model.asks, "SIZE", model.sizes[k]));
  return text;
}

/// Of models that are in the folder.
std::string cases_text(const fs::path& folder, const std::vector<SuiteModel>& models) {
  Json json = {{"suite", suite().version}, {"cases", Json::array()}};
  for (const SuiteModel& model : models)
    for (std::size_t k = 0; k < model.sizes.size(); ++k) {
      const std::string name = case_name(model, k);
      const bool planar = model.extension == ".toml", sized = model.asks == kAsksForSize;
      const auto number = as_number(model.sizes[k]);
      json["cases"].push_back(
          {{"name", name},
           {"family", name_of(model.family)},
           {"model", file_name(model)},
           {"sha256", suite_digest(model, read_whole_file(folder / file_name(model)))},
           {"boundary", planar && model.family != SuiteFamily::kMetric ? Json(name + ".msh") : Json()},
           {"size", !sized   ? Json()
                    : number ? Json(*number)
                             : Json(model.sizes[k])}});
      if (!sized) json["cases"].back()["asks"] = replace_all(model.asks, "SIZE", model.sizes[k]);
    }
  return json.dump(2) + "\n";
}

}  // namespace

Experiment write_suite_experiment(const fs::path& folder, const std::vector<SuiteModel>& models) {
  prepare_folder(folder);
  write_models(folder, models);
  write_text_file(folder / "suite.toml", experiment_text(models));
  return Experiment::read(folder / "suite.toml");
}

void write_suite(const fs::path& folder, const std::vector<SuiteModel>& models) {
  const Experiment experiment = write_suite_experiment(folder, models);
  for (std::size_t i = 0; i < experiment.n_cases(); ++i) {
    const Case c = experiment.read_variant(i);
    if (planar_model(c) != nullptr && !c.metric.asks())  // a metric divides curves by itself
      write_mesh(folder / (c.name + ".msh"), boundary_of(prepare(c)));
  }
  write_text_file(folder / "cases.json", cases_text(folder, models));
}

namespace {

/// By family, as the list calls it.
constexpr std::array<std::string_view, 6> kFamilies = {"planar", "CAD",    "triangles",
                                                       "hard",   "metric", "public"};

SuiteFamily family_of(const std::string& name) {
  for (const SuiteFamily family : kSuiteFamilies)
    if (name == name_of(family)) return family;
  throw std::logic_error("models.toml: unknown family " + name);
}

std::string size_text(const toml::node& size) {
  if (const auto text = size.value<std::string>()) return *text;
  return fmt::format("{}", size.value<double>().value());
}

SuiteModel read_model(const toml::table& table) {
  const auto text = [&](const char* key) { return table[key].value<std::string>().value(); };
  const auto maybe = [&](const char* key, std::string_view or_else = "") {
    return table[key].value_or(std::string(or_else));
  };
  static const std::map<std::string, const char*> kExtensions = {
      {"planar", ".toml"}, {"metric", ".toml"}, {"CAD", ".step"}, {"triangles", ".obj"}};
  SuiteModel model{text("name"),
                   text("about"),
                   family_of(text("family")),
                   {},
                   maybe("sha256"),
                   "",
                   maybe("asks", kAsksForSize),
                   maybe("text"),
                   fs::path(maybe("file"))};
  model.extension =
      model.file.empty() ? kExtensions.at(maybe("kind", text("family"))) : model.file.extension().string();
  for (const toml::node& size : *table["sizes"].as_array()) model.sizes.push_back(size_text(size));
  return model;
}

/// The models of a [[collection]].
void read_collection(const toml::table& table, std::vector<SuiteModel>& models) {
  const auto folder = table["folder"].value<std::string>().value();
  for (const toml::node& node : *table["models"].as_array()) {
    const toml::array& row = *node.as_array();
    const fs::path file = folder / fs::path(row[0].value<std::string>().value());
    toml::table model = table;
    model.insert("name", file.stem().string());
    model.insert("file", file.string());
    model.insert("sizes", toml::array{row[1]});
    if (row.size() > 2) model.insert("sha256", row[2]);
    models.push_back(read_model(model));
  }
}

template <class Made>
Made make_model(const std::vector<SuiteMaker<Made>>& makers, const std::string& name) {
  for (const SuiteMaker<Made>& maker : makers)
    if (name == maker.name) return maker.make();
  throw std::logic_error("nothing makes the model " + name);
}

std::string obj_text(const Mesh& mesh) {
  std::ostringstream stream;
  TextWriter out(stream);
  for (const Vec3& p : mesh.points) out << "v " << p.x << " " << p.y << " " << p.z << "\n";
  for (const auto& [a, b, c] : mesh.triangles) out << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  out.flush();
  return stream.str();
}

std::string sha256(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
    throw Error("SHA-256 failed");
  std::string text;
  for (unsigned i = 0; i < length; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Not inside of a word or of an entity's number.
bool begins_number(const std::string& before, const char* at, const char* end) {
  if (!before.empty() && (is_digit(before.back()) || before.back() == '#')) return false;
  return is_digit(*at) || (*at == '-' && at + 1 < end && is_digit(at[1]));
}

std::string six_digits(double value) {
  const std::string text = fmt::format("{:.6f}", value);
  return text == "-0.000000" ? text.substr(1) : text;
}

/// The data of a STEP file, its line breaks left out and its numbers with a point rounded.
std::string rounded_step(const std::string& content) {
  const auto begin = content.find("\nDATA;");
  if (begin == std::string::npos) throw std::logic_error("a STEP file without data");
  std::string data = content.substr(begin), result;
  std::erase_if(data, [](char c) { return c == '\n' || c == '\r'; });
  const char *at = data.data(), *const end = at + data.size();
  while (at < end) {
    if (!begins_number(result, at, end)) {
      result += *at++;
      continue;
    }
    double value = 0;
    const char* rest = std::from_chars(at, end, value).ptr;
    const std::string_view digits(at, rest);
    result += digits.find('.') == std::string_view::npos ? std::string(digits) : six_digits(value);
    at = rest;
  }
  return result;
}

}  // namespace

bool is_for_all(SuiteFamily family) {
  return family != SuiteFamily::kMetric && family != SuiteFamily::kPublic;
}

const char* name_of(SuiteFamily family) { return kFamilies[static_cast<std::size_t>(family)].data(); }

const Suite& suite() {
  static const Suite list = [] {
    const toml::table table = toml::parse(kSuiteText);
    Suite result{table["version"].value<long long>().value(), {}};
    for (const toml::node& model : *table["model"].as_array())
      result.models.push_back(read_model(*model.as_table()));
    for (const toml::node& collection : *table["collection"].as_array())
      read_collection(*collection.as_table(), result.models);
    return result;
  }();
  return list;
}

std::vector<SuiteModel> select_models(const SuiteSelection& selection) {
  const auto& [names, families, folders] = selection;
  for (const std::string& family : families)
    if (std::ranges::find(kFamilies, family) == kFamilies.end())
      refuse("--family: '{}': expected {}", family, fmt::join(kFamilies, ", "));
  for (const fs::path& folder : folders)
    if (!fs::is_directory(folder)) refuse("--public: {}: is no folder", folder.string());
  const auto is_in = [](const std::vector<std::string>& wanted, std::string_view name) {
    return wanted.empty() || std::ranges::find(wanted, name) != wanted.end();
  };
  std::vector<std::string> known;
  for (const SuiteModel& model : suite().models)
    if (is_in(families, name_of(model.family))) known.push_back(model.name);
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end()) {
      const std::string near = families.empty() ? suggestion(name, known) : "";
      refuse("--models: '{}' is none of {}{}", name,
             families.empty() ? "the suite" : fmt::format("{}", fmt::join(families, ", ")),
             near.empty() ? fmt::format(": expected some of {}", fmt::join(known, ", ")) : near);
    }
  std::vector<SuiteModel> selected;
  for (SuiteModel model : suite().models) {
    if (!is_in(names, model.name) || !is_in(families, name_of(model.family))) continue;
    if (!model.file.empty()) {
      const auto at =
          std::ranges::find_if(folders, [&](const fs::path& f) { return fs::exists(f / model.file); });
      if (at == folders.end() && !names.empty())
        refuse("'{}': its file {} is in no folder of --public; 'make public_models' fetches it", model.name,
               model.file.string());
      if (at == folders.end()) continue;
      model.file = *at / model.file;
    }
    selected.push_back(std::move(model));
  }
  if (selected.empty())
    throw InputError("no model is left: public ones need --public; 'make public_models' fetches them");
  return selected;
}

std::string case_name(const SuiteModel& model, std::size_t size) {
  return fmt::format("{}_{}", model.name, size + 1);
}

std::string file_name(const SuiteModel& model) { return model.name + model.extension; }

std::string suite_title() { return fmt::format("Suite {}", suite().version); }

std::string make_suite_model(const SuiteModel& model) {
  if (!model.text.empty()) return model.text;
  if (!model.file.empty()) return read_whole_file(model.file);
  if (model.extension == ".toml") return make_model(planar_suite_models(), model.name);
  if (model.extension == ".obj") return obj_text(make_model(triangle_suite_models(), model.name));
  std::ostringstream out;
  write_suite_model(model.name, out);
  return out.str();
}

std::string suite_digest(const SuiteModel& model, const std::string& content) {
  return sha256(model.extension == ".step" && model.file.empty() ? rounded_step(content) : content);
}

}  // namespace delquad
