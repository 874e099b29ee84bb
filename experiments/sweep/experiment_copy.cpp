// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/experiment_copy.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <system_error>

#include "base/text.h"
#include "io/digest.h"
#include "io/library_file.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kCopies = "experiment";
/// Larger files are models, which are looked for by name and digest.
constexpr std::uintmax_t kMostCopied = std::uintmax_t{4} << 20;
constexpr std::size_t kDigestDigits = 12;  // of a digest, in names

/// The deepest folder that holds all of the files, which are absolute.
fs::path common_folder(const std::vector<fs::path>& files) {
  fs::path common = files[0].parent_path();
  const auto holds = [&](const fs::path& file) { return *file.lexically_relative(common).begin() != ".."; };
  while (!std::ranges::all_of(files, holds)) common = common.parent_path();
  return common;
}

std::string list_of_files(const std::vector<fs::path>& files, const fs::path& root,
                          const fs::path& experiment) {
  Json json = {{"experiment", experiment.lexically_relative(root).generic_string()},
               {"files", Json::object()},
               {"too_large", Json::object()}};
  for (const fs::path& file : files) {
    const FileMark mark = mark_of(file);
    json[mark.bytes > kMostCopied ? "too_large" : "files"][file.lexically_relative(root).generic_string()] = {
        {"bytes", mark.bytes}, {"digest", mark.digest}};
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void keep_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  write_file_atomically(to, [&](std::ostream& out) { copy_into(out, from); });
  // Programs stay programs.
  fs::permissions(to, fs::status(from, error).permissions(), error);
}

/// `list`: <digest>.json
std::vector<std::string> check_list(const fs::path& list) {
  const std::string text = file_bytes(list);
  if (digest(text).substr(0, kDigestDigits) != list.stem().string())
    return {list.string() + ": was changed: it is not the list of the files of this copy"};
  std::vector<std::string> wrong;
  const Json json = Json::parse(text, nullptr, false);
  const fs::path folder = fs::path(list).replace_extension();
  for (const auto& [name, mark] : json.at("files").items())
    if (const std::string how = difference(folder / name, {mark.at("bytes"), mark.at("digest")});
        !how.empty())
      wrong.push_back((folder / name).string() + ": " + how);
  return wrong;
}

}  // namespace

fs::path keep_experiment(const Experiment& experiment, const fs::path& folder) {
  const std::vector<fs::path> files = experiment.files();
  const fs::path file = fs::absolute(experiment.file).lexically_normal(), root = common_folder(files);
  const std::string list = list_of_files(files, root, file);
  const std::string name = digest(list).substr(0, kDigestDigits);
  const fs::path copy = folder / kCopies / name, listed = folder / kCopies / (name + ".json");
  const Json json = Json::parse(list);
  for (const auto& [path, mark] : json.at("files").items())
    if (!difference(copy / path, {mark.at("bytes"), mark.at("digest")}).empty())
      keep_file(root / path, copy / path);
  if (!fs::exists(listed) || file_bytes(listed) != list) write_text_file(listed, list);
  return fs::path(kCopies) / name / file.lexically_relative(root);
}

std::vector<std::string> check_copies(const fs::path& folder) {
  std::vector<fs::path> lists;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder / kCopies, none))
    if (entry.path().extension() == ".json" && !entry.path().filename().string().starts_with('.'))
      lists.push_back(entry.path());
  std::ranges::sort(lists);
  std::vector<std::string> wrong;
  for (const fs::path& list : lists) std::ranges::move(check_list(list), std::back_inserter(wrong));
  return wrong;
}

}  // namespace delquad
