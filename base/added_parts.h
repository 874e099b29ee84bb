#pragma once

#include <cctype>
#include <deque>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace delquad {

/// Parts of one kind that can be chosen by name, in the order in which they were added.
template <class Part>
class AddedParts {
 public:
  /// `kind`: for messages, "matching solver".
  explicit AddedParts(std::string kind) : kind_(std::move(kind)) {}

  /// Throws std::invalid_argument for a name that is taken, empty or begins with no letter, and for nothing.
  void add(const std::string& name, Part part) {
    if (name.empty() || std::isalpha(static_cast<unsigned char>(name[0])) == 0)
      throw std::invalid_argument(kind_ + " '" + name + "': expected a name that begins with a letter");
    if (!part) throw std::invalid_argument(kind_ + " '" + name + "': there is nothing to call");
    if (find(name) != nullptr) throw std::invalid_argument("there is a " + kind_ + " '" + name + "' already");
    parts_.emplace_back(name, std::move(part));
  }

  /// Null: there is none of that name.
  const Part* find(const std::string& name) const {
    for (const auto& [known, part] : parts_)
      if (known == name) return &part;
    return nullptr;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& part : parts_) all.push_back(part.first);
    return all;
  }

 private:
  std::string kind_;
  std::deque<std::pair<std::string, Part>> parts_;
};

}  // namespace delquad
