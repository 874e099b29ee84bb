// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/problem_record.h"

#include <fmt/format.h>

#include <system_error>

#include "base/text.h"
#include "geometry/planar/defined_curve.h"
#include "io/cases/outline_files.h"
#include "io/digest.h"
#include "io/mesh_io.h"

namespace delquad {

std::vector<std::string> words_of(const char* words) {
  std::vector<std::string> all(1);
  for (; *words != '\0'; ++words)
    if (*words == '|')
      all.emplace_back();
    else
      all.back() += *words;
  return all;
}

std::optional<NamedFile> file_of(const SizeSpec& size) {
  const auto file = size_file_of(size.text, size.folder);
  return file ? std::optional(NamedFile{"base", *file}) : std::nullopt;
}

std::optional<NamedFile> file_of(const MetricSpec& metric) {
  const auto file = size_file_of(metric.file, metric.folder);
  return file ? std::optional(NamedFile{"file", *file}) : std::nullopt;
}

RecordJson Recorder::number(double value) {
  return std::isfinite(value) ? RecordJson(value) : RecordJson(fmt::format("{}", value));
}

RecordJson Recorder::write_in_memory(bool is_there) {
  if (!is_there) return {};
  in_memory.push_back(path_);
  return "in memory";
}

RecordJson Recorder::write_other(const std::shared_ptr<const Curve>& curve, const Rule&) {
  if (!curve) return {};
  const auto* defined = dynamic_cast<const DefinedCurve*>(curve.get());
  return defined != nullptr ? RecordJson(defined->definition()) : write_in_memory(true);
}

RecordJson Recorder::write_other(const std::string& text, const Rule& rule) {
  if (rule.form == Form::kBytes) return text.empty() ? RecordJson() : RecordJson(digest(text));
  if (rule.form != Form::kFormula || whole_) return text;
  if (const auto value = as_number(text)) return fmt::format("{}", *value);  // however it is spelled
  return text.empty() ? RecordJson() : RecordJson(text);
}

/// All options by group; null: the default of the strategy.
RecordJson Recorder::write_other(const Options& options, const Rule&) {
  RecordJson json = RecordJson::object();
  for (const OptionGroup& group : option_groups())
    for (const OptionKey& key : group.keys) {
      const std::string name = group.name + "." + key.name;
      const bool is_own = !key.absent.empty() && options.find(name) == nullptr;
      json[group.name][key.name] =
          is_own ? RecordJson()
                 : std::visit([](const auto& v) { return RecordJson(v); }, options.value(name));
    }
  return json;
}

RecordJson Recorder::content(const std::filesystem::path& file) {
  if (file.empty()) return {};
  const OutlineFile whole = outline_file_of(file).value_or(OutlineFile{file, "", ""});
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(whole.path, unknown)) return {};
  RecordJson json = {{"kind", kind_of_file(whole.path)}, {"digest", file_digest(whole.path)}};
  if (!whole.layer.empty()) json["layer"] = whole.layer;
  if (!whole.project.empty()) json["project"] = whole.project;
  return json;
}

std::string ProblemRecord::digest() const {
  return delquad::digest(json.dump(-1, ' ', false, RecordJson::error_handler_t::replace));
}

ProblemRecord record_of(const Case& c) {
  Recorder recorder;
  ProblemRecord record{recorder.object<MeshProblem>(c), {}};
  record.json.update(recorder.object<CaseOfStudy>(c));
  record.in_memory = std::move(recorder.in_memory);
  return record;
}

}  // namespace delquad
