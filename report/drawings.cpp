#include "report/drawings.h"

#include <algorithm>

#include "base/text.h"
#include "delquad/error.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = 500'000;       // of one
constexpr std::uintmax_t kMostTogether = 3'000'000;  // of a page

void add_drawings(const fs::path& folder, std::vector<fs::path>& files) {
  std::error_code error;
  const std::size_t first = files.size();
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->path().extension() == ".svg" && at->is_regular_file()) files.push_back(at->path());
  if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
  std::sort(files.begin() + static_cast<std::ptrdiff_t>(first), files.end());
}

}  // namespace

std::vector<fs::path> list_drawings(const fs::path& folder, bool has_cells) {
  std::vector<fs::path> files;
  if (!has_cells) add_drawings(folder, files);
  if (fs::is_directory(folder / "figures")) add_drawings(folder / "figures", files);
  return files;
}

Json DrawingShelf::put(const fs::path& file) {
  Json json = {{"name", file.stem().string()}};
  const std::uintmax_t bytes = fs::file_size(file);
  if (bytes > kMostBytes || written_ + bytes > kMostTogether) {
    json["left_out"] = file.string();
    return json;
  }
  written_ += bytes;
  json["svg"] = file_bytes(file);
  return json;
}

}  // namespace delquad
