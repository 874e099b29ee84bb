#include "experiments/suite/write_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "base/text.h"
#include "delquad/error.h"
#include "experiments/suite/suite_list.h"
#include "experiments/sweep/folders.h"
#include "io/cases/case.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void write_models(const fs::path& folder) {
  for (const SuiteModel& model : suite().models) {
    const std::string content = make_suite_model(model), digest = suite_digest(model, content);
    if (digest != model.sha256)
      throw InputError(
          fmt::format("{}: SHA-256 is {}: expected {}, of suite {}; another version of OpenCASCADE would "
                      "explain it for CAD",
                      file_name(model), digest, model.sha256, suite().version));
    write_text_file(folder / file_name(model), content);
  }
}

std::string experiment_text() {
  std::string text = fmt::format("title = \"{}\"\npipelines = [\"DB\", \"DBCO\"]\n", suite_title());
  for (const SuiteModel& model : suite().models)
    for (std::size_t k = 0; k < model.sizes.size(); ++k)
      text += fmt::format("\n[[case]]\nname = \"{}\"\nmodel = \"{}\"\nsize = \"{}\"\n", case_name(model, k),
                          file_name(model), model.sizes[k]);
  return text;
}

std::string cases_text() {
  Json json = {{"suite", suite().version}, {"cases", Json::array()}};
  for (const SuiteModel& model : suite().models)
    for (std::size_t k = 0; k < model.sizes.size(); ++k) {
      const std::string name = case_name(model, k);
      const bool planar = model.family == SuiteFamily::kPlanar;
      const auto number = as_number(model.sizes[k]);
      json["cases"].push_back({{"name", name},
                               {"family", name_of(model.family)},
                               {"model", file_name(model)},
                               {"boundary", planar ? Json(name + ".msh") : Json()},
                               {"size", number ? Json(*number) : Json(model.sizes[k])}});
    }
  return json.dump(2) + "\n";
}

}  // namespace

Experiment write_suite_experiment(const fs::path& folder) {
  prepare_folder(folder);
  write_models(folder);
  write_text_file(folder / "suite.toml", experiment_text());
  return Experiment::read(folder / "suite.toml");
}

void write_suite(const fs::path& folder) {
  const Experiment experiment = write_suite_experiment(folder);
  for (std::size_t i = 0; i < experiment.n_cases(); ++i) {
    const Case c = experiment.read_variant(i);
    if (planar_model(c) != nullptr) write_mesh(folder / (c.name + ".msh"), prepare(c)->boundary);
  }
  write_text_file(folder / "cases.json", cases_text());
}

}  // namespace delquad
