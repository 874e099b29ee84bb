#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Curves (dimension 1) and regions (2) by the numbers that a file has for them, in the order in which
/// elements first have them. Numbers are tags where they are positive; others stand behind those.
class NumberedEntities {
 public:
  /// What numbers may be: twice as much is still a tag.
  static constexpr long long kMostNumber = 999'999'999;

  /// Takes a comment that is `before`, a number, `after` and a name, such as "# curve 3: north", which may
  /// end in
  /// "\r". It must stand before the elements. False: it is no such comment.
  bool take_name(std::string_view comment, std::string_view before, std::string_view after, int dim);
  /// Index into Mesh::curves or Mesh::regions.
  int index(int dim, long long number, Mesh& mesh);

 private:
  std::map<std::pair<int, long long>, std::vector<std::string>> names_;
  std::map<std::pair<int, long long>, int> index_;
};

/// The unit of lengths that a comment of our writers tells after its mark ("#"); empty: it tells none.
std::string unit_in_comment(std::string_view comment, std::string_view mark);

}  // namespace delquad
