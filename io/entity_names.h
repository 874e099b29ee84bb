#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// What an entity without a name is called in files: "point_7" (dimension 0), "curve_7" (1) or "region_7"
/// (2), "volume_7" (3).
std::string tag_label(int dim, int tag);

/// One name for each entity of one dimension, for formats that take no more. Of several the one that says
/// most, which the fewest entities have (of equal ones the first): a part's own name, not that of the
/// product; a colour, or a name that all have, only where there is nothing else. Without any: tag_label(),
/// with a number behind it where that is taken. Entities have the same name here only if they share it.
std::vector<std::string> group_names(const std::vector<Entity>& entities, int dim);

/// The name in one line of at most 200 bytes, for comments.
std::string one_line(std::string_view name);

/// Names as a format can hold them. Different names get different labels: a name that can stay as it is does,
/// others get a number where their label is taken.
class UniqueLabels {
 public:
  /// A name and what it is the name of; the same name of another kind has another label.
  using Key = std::pair<int, std::string>;
  struct Rules {
    std::string (*plain)(const std::string&);  ///< turns every name into one that the format can hold
    bool blind_to_case = false;                ///< whether the format takes "A" and "a" for the same
    size_t longest = 70;                       ///< bytes; numbers may make labels ten bytes longer
  };
  UniqueLabels(const std::vector<Key>& keys, const Rules& rules);

  const std::string& of(const Key& key) const { return label_of_.at(key); }
  /// Keys whose label is not their name, with it.
  const std::vector<std::pair<Key, std::string>>& renamed() const { return renamed_; }

 private:
  bool take(const std::string& label, bool blind_to_case);

  std::map<Key, std::string> label_of_;
  std::set<std::string> taken_;
  std::vector<std::pair<Key, std::string>> renamed_;
};

}  // namespace delquad
