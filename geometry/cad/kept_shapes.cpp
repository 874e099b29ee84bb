// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/kept_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/process.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/cad/byte_archive.h"

namespace delquad::cad {

namespace {

namespace fs = std::filesystem;

std::size_t sum_of(const std::string& bytes) { return std::hash<std::string>()(bytes); }

/// Returns the answer in a file; nothing if the file is missing, damaged, or has another question.
std::optional<std::string> answer_in(const fs::path& file, const std::string& question) {
  std::error_code unknown;
  if (!fs::is_regular_file(file, unknown)) return std::nullopt;
  const std::string bytes = file_bytes(file);
  std::string_view rest = bytes;
  std::string kept, answer;
  std::size_t sum = 0;
  try {
    get(rest, kept), get(rest, answer), get(rest, sum);
  } catch (const InputError&) {
    return std::nullopt;
  }
  if (kept != question || sum != sum_of(answer)) return std::nullopt;
  return answer;
}

/// Removes the files that were used the longest time ago, until the others are small enough.
void keep_within_limit(const fs::path& folder) {
  struct Kept {
    fs::file_time_type used;
    fs::path path;
    std::uintmax_t size;
  };
  std::vector<Kept> all;
  std::uintmax_t sum = 0;
  std::error_code gone;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, gone)) {
    const std::uintmax_t size = file.file_size(gone);
    if (gone) continue;  // a folder, or removed by another program
    all.push_back({file.last_write_time(gone), file.path(), size});
    sum += size;
  }
  std::ranges::sort(all, {}, &Kept::used);
  for (const Kept& kept : all) {
    if (sum <= kMostKeptBytes) return;
    if (fs::remove(kept.path, gone)) sum -= std::min(sum, kept.size);
  }
}

}  // namespace

std::string kept_or_asked(const fs::path& folder, const std::string& question,
                          const std::function<std::string()>& ask) {
  if (folder.empty()) return ask();
  const fs::path file = folder / fmt::format("{:016x}", sum_of(question));
  std::error_code ignored;
  if (std::optional<std::string> kept = answer_in(file, question)) {
    fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
    return *std::move(kept);
  }
  const std::string answer = ask();
  std::string bytes;
  put(bytes, question), put(bytes, answer), put(bytes, sum_of(answer));
  fs::create_directories(folder, ignored);
  const fs::path unfinished = fmt::format("{}.{}", file.string(), process_number());
  std::ofstream out(unfinished, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out) fs::rename(unfinished, file, ignored);
  fs::remove(unfinished, ignored);  // still there if the disk is full, or a folder has the name
  keep_within_limit(folder);
  return answer;
}

}  // namespace delquad::cad
