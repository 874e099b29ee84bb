#include "io/numbered_entities.h"

#include <charconv>
#include <system_error>

namespace delquad {

namespace {

std::string_view without_return(std::string_view line) {
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

}  // namespace

bool NumberedEntities::take_name(std::string_view comment, std::string_view before, std::string_view after,
                                 int dim) {
  if (!comment.starts_with(before)) return false;
  comment.remove_prefix(before.size());
  long long number = 0;
  const auto [end, error] = std::from_chars(comment.data(), comment.data() + comment.size(), number);
  if (error != std::errc()) return false;
  comment.remove_prefix(static_cast<std::size_t>(end - comment.data()));
  if (!comment.starts_with(after)) return false;
  names_[{dim, number}].emplace_back(without_return(comment.substr(after.size())));
  return true;
}

int NumberedEntities::index(int dim, long long number, Mesh& mesh) {
  std::vector<Entity>& entities = dim == 1 ? mesh.curves : mesh.regions;
  const auto [it, is_new] = index_.emplace(std::pair{dim, number}, static_cast<int>(entities.size()));
  if (is_new) {
    const long long tag = number > 0 ? number : kMostNumber + 1 - number;
    entities.push_back({static_cast<int>(tag), names_[{dim, number}]});
  }
  return it->second;
}

std::string unit_in_comment(std::string_view comment, std::string_view mark) {
  const std::string before = std::string(mark) + " lengths in ";
  return comment.starts_with(before) ? std::string(without_return(comment.substr(before.size()))) : "";
}

}  // namespace delquad
