#include "io/entity_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <tuple>

namespace delquad {
namespace {

/// UTF-8 text cut to so many bytes, not within a character.
std::string cut(const std::string& text, size_t longest) {
  if (text.size() <= longest) return text;
  size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

std::string_view without_return(std::string_view line) {
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

}  // namespace

std::string tag_label(int dim, int tag) {
  constexpr std::array kKinds = {"point_", "curve_", "region_", "volume_"};
  return kKinds.at(static_cast<size_t>(dim)) + std::to_string(tag);
}

std::map<std::string, std::vector<std::int32_t>> tags_of_names(const std::vector<Entity>& entities) {
  std::map<std::string, std::vector<std::int32_t>> tags;
  for (const Entity& entity : entities)
    for (const std::string& name : entity.names) tags[name].push_back(entity.tag);
  return tags;
}

std::string one_line(std::string_view name) {
  std::string text;
  for (const char c : name) text += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  constexpr size_t kLongest = 200;
  return cut(text, kLongest);
}

std::vector<std::string> group_names(const std::vector<Entity>& entities, int dim) {
  std::map<std::string, size_t> holders;
  for (const Entity& entity : entities)
    for (const std::string& name : std::set(entity.names.begin(), entity.names.end())) ++holders[name];
  const auto says_little = [&](const std::string& name) {
    const size_t n = holders.at(name);
    return std::tuple(entities.size() > 1 && n == entities.size(), name.starts_with(kColourName), n);
  };
  std::vector<std::string> result;
  for (const Entity& entity : entities) {
    const auto best =
        std::min_element(entity.names.begin(), entity.names.end(),
                         [&](const auto& a, const auto& b) { return says_little(a) < says_little(b); });
    result.push_back(best == entity.names.end() ? "" : *best);
  }
  for (size_t i = 0; i < entities.size(); ++i) {
    if (!entities[i].names.empty()) continue;
    const std::string label = tag_label(dim, entities[i].tag);
    result[i] = label;
    for (int k = 2; !holders.emplace(result[i], 1).second; ++k) result[i] = label + "_" + std::to_string(k);
  }
  return result;
}

UniqueLabels::UniqueLabels(const std::vector<Key>& keys, const Rules& rules) {
  const auto plain = [&](const Key& key) { return cut(rules.plain(key.second), rules.longest); };
  for (const Key& key : keys)
    if (plain(key) == key.second && !label_of_.contains(key) && take(key.second, rules.blind_to_case))
      label_of_[key] = key.second;
  for (const Key& key : keys) {
    if (label_of_.contains(key)) continue;
    const std::string label = plain(key);
    std::string candidate = label;
    for (int k = 2; !take(candidate, rules.blind_to_case); ++k) candidate = label + "_" + std::to_string(k);
    label_of_[key] = candidate;
    renamed_.emplace_back(key, candidate);
  }
}

bool UniqueLabels::take(const std::string& label, bool blind_to_case) {
  std::string text = label;
  for (char& c : text)
    if (blind_to_case && c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return taken_.insert(text).second;
}

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
