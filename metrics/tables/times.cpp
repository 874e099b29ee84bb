#include "metrics/tables/times.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>

#include "delquad/error.h"
#include "io/mesh_io.h"
#include "metrics/tables/json_problem.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr const char* kTimesFile = "times.json";

Json to_json(const CellTimes& cell) {
  Json json = {{"pipeline", cell.pipeline}, {"key", cell.key}};
  if (!cell.failure.empty()) json["failure"] = cell.failure;
  for (const auto& [key, seconds] : cell.seconds) json[key] = seconds;
  return json;
}

CellTimes times_of(const Json& json, std::size_t repetitions) {
  CellTimes cell{json.at("pipeline"), json.at("key"), {}, json.value("failure", "")};
  for (const char* key : {"seconds", "seconds_total"})
    if (json.contains(key)) json.at(key).get_to(cell.seconds[key]);
  for (const auto& [key, seconds] : cell.seconds)
    if (seconds.size() != repetitions || std::ranges::any_of(seconds, [](double s) { return !(s >= 0); }))
      throw InputError(fmt::format("'{}' of {} holds no {} times", key, cell.pipeline, repetitions));
  return cell;
}

VariantTimes times_of(const Json& json) {
  VariantTimes times;
  json.at("repetitions").get_to(times.repetitions);
  times.load_before = json.at("load_average").at(0);
  times.load_after = json.at("load_average").at(1);
  for (const Json& cell : json.at("cells"))
    times.cells.push_back(times_of(cell, static_cast<std::size_t>(times.repetitions)));
  return times;
}

/// The times of one cell, or what is wrong with them.
std::string attach(const VariantTimes& times, const fs::path& file, CellRecord& record) {
  const auto at = std::ranges::find(times.cells, record.pipeline, &CellTimes::pipeline);
  if (at == times.cells.end() || !record.reason.empty()) return "";
  if (!has_mesh(state_of_cell(record.folder, at->key)))
    return fmt::format("{}: the times of {} were taken of another program, model or option: run it again",
                       file.string(), record.pipeline);
  if (!at->failure.empty())
    return fmt::format("{}: no times of {}: {}", file.string(), record.pipeline, at->failure);
  record.times = at->seconds;
  return "";
}

}  // namespace

void write_times(const fs::path& folder, const VariantTimes& times) {
  Json json = {{"repetitions", times.repetitions},
               {"load_average", {times.load_before, times.load_after}},
               {"cells", Json::array()}};
  for (const CellTimes& cell : times.cells) json["cells"].push_back(to_json(cell));
  write_file_atomically(folder / kTimesFile, [&](std::ostream& out) {
    out << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  });
}

std::optional<VariantTimes> read_times(const fs::path& folder) {
  std::ifstream in(folder / kTimesFile);
  if (!in) return std::nullopt;
  const auto damaged = [&](const std::exception& why) {
    return InputError(json_problem(folder / kTimesFile, "is no file of repeated times", why));
  };
  try {
    return times_of(Json::parse(in));
  } catch (const Json::exception& error) {
    throw damaged(error);
  } catch (const InputError& error) {
    throw damaged(error);
  }
}

std::vector<std::string> attach_times(std::vector<CellRecord>& records) {
  std::vector<std::string> problems;
  std::map<fs::path, std::optional<VariantTimes>> known;
  for (CellRecord& record : records) {
    if (record.folder.empty()) continue;
    const fs::path folder = record.folder.parent_path();
    const auto [at, is_new] = known.try_emplace(folder);
    if (is_new) try {
        at->second = read_times(folder);
      } catch (const InputError& error) {
        problems.push_back(error.what());
      }
    if (!at->second) continue;
    if (std::string problem = attach(*at->second, folder / kTimesFile, record); !problem.empty())
      problems.push_back(std::move(problem));
  }
  return problems;
}

}  // namespace delquad
