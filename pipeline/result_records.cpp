#include "pipeline/result_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "mesh/error.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

CellRecord parse(const Json& json) {
  CellRecord record;
  record.group = json.at("case").get<std::string>();
  record.pipeline = json.at("pipeline").get<std::string>();
  if (json.at("status") != "ok") {
    record.failure = json.at("reason").get<std::string>();
    return record;
  }
  for (const auto& [key, value] : json.at("metrics").items())
    record.values[key] = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  record.values["seconds"] = json.at("meshing_seconds").get<double>();
  return record;
}

}  // namespace

std::vector<CellRecord> read_records(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().filename() == "record.json") files.push_back(at->path());
  if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
  if (files.empty()) throw InputError(folder.string() + ": holds no record.json of an experiment");
  std::sort(files.begin(), files.end());

  std::vector<CellRecord> records;
  std::set<std::pair<std::string, std::string>> seen;
  for (const fs::path& file : files) {
    try {
      std::ifstream in(file);
      records.push_back(parse(Json::parse(in)));
    } catch (const Json::exception& e) {
      throw InputError(fmt::format("{}: is no record of a cell: {}", file.string(), e.what()));
    }
    const CellRecord& r = records.back();
    if (!seen.insert({r.group, r.pipeline}).second)
      throw InputError(
          fmt::format("{}: there is another record of {} {} in {}: give the folder of one experiment",
                      file.string(), r.group, r.pipeline, folder.string()));
  }
  return records;
}

}  // namespace delquad
