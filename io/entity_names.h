// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "delquad/mesh.h"

// This header makes names for formats that restrict them. The program, features and readers and writers use
// it.

namespace delquad {

/// Returns the name of a nameless entity in files, by dimension: "point_7" (0), "curve_7" (1), "region_7" (2)
/// or "volume_7" (3).
std::string tag_label(int dim, int tag);

/// Gives entities that are called by a number, as in our files ("curve_7"), this number again.
void take_numbers(Mesh& mesh);

/// Returns one name for each entity of one dimension, for formats that take no more. If an entity has several
/// names, the name that the fewest entities have is chosen, the first of equal ones. So a part's own name
/// comes before the name of the product. A color, or a name that all have, is used only if there is nothing
/// else. A nameless entity gets tag_label(), with a number behind it if that is taken. Entities have the same
/// name here only if they share it.
std::vector<std::string> group_names(const std::vector<Entity>& entities, int dim);

/// Returns the tags of the entities that have each name.
std::map<std::string, std::vector<std::int32_t>> tags_of_names(const std::vector<Entity>& entities);

/// Returns whether a name contains the word, in any case.
bool name_contains(std::string name, std::string_view word);

/// Returns the name in one line of at most 200 bytes, for comments.
std::string one_line(std::string_view name);

/// Labels of names that suit a format. Different names get different labels. A suitable name is its own
/// label; others get a number if their label is taken.
class UniqueLabels {
 public:
  /// A kind and a name; the same name of another kind has another label.
  using Key = std::pair<int, std::string>;
  struct Rules {
    std::string (*plain)(const std::string&);  ///< turns a name into one that suits the format
    bool ignores_case = false;                 ///< the format does not distinguish "A" and "a"
    size_t longest = 70;                       ///< bytes; numbers may make labels ten bytes longer
  };
  UniqueLabels(const std::vector<Key>& keys, const Rules& rules);

  const std::string& of(const Key& key) const { return label_of_.at(key); }
  /// Returns the keys whose label is not their name, with the label.
  const std::vector<std::pair<Key, std::string>>& renamed() const { return renamed_; }

 private:
  bool take(const std::string& label, bool ignores_case);

  std::map<Key, std::string> label_of_;
  std::set<std::string> taken_;
  std::vector<std::pair<Key, std::string>> renamed_;
};

/// Curves (dimension 1) and regions (2) by their numbers in a file, in the order of first use. Positive
/// numbers are tags; others get further tags.
class NumberedEntities {
 public:
  /// Largest number of an entity; twice this number still fits a tag.
  static constexpr long long kMostNumber = 999'999'999;

  /// Reads a name from a comment of the form `before`, number, `after`, name, such as "# curve 3: north",
  /// which may end in "\r". It must precede the elements. Returns false for other comments.
  bool take_name(std::string_view comment, std::string_view before, std::string_view after, int dim);
  /// Returns the index into Mesh::curves or Mesh::regions, and adds the entity if it is new.
  int index(int dim, long long number, Mesh& mesh);

 private:
  std::map<std::pair<int, long long>, std::vector<std::string>> names_;
  std::map<std::pair<int, long long>, int> index_;
};

/// Returns the unit of lengths in a comment of our writers behind its mark ("#"); empty: none.
std::string unit_in_comment(std::string_view comment, std::string_view mark);

/// Returns whether all points have one z and the elements run counterclockwise as seen from above.
bool is_planar(const Mesh& mesh);

/// Throws InputError, with path and format, if is_planar() is false.
void require_planar(const std::filesystem::path& path, const std::string& format, const Mesh& mesh);
/// Does the same, but allows z over the plane, such as the ground below water.
void require_terrain(const std::filesystem::path& path, const std::string& format, const Mesh& mesh);
/// Throws InputError, with path and format, if there are triangles.
void require_quads(const std::filesystem::path& path, const std::string& format, const Mesh& mesh);

/// Throws InputError if there are more than `most` of the things `what`, the largest number of the format.
void require_fits(const std::filesystem::path& path, const std::string& format, std::size_t n,
                  const std::string& what, std::size_t most);
/// Throws InputError unless the format can number the nodes, and all elements together, from 1.
void require_numbers(const std::filesystem::path& path, const std::string& format, const Mesh& mesh,
                     std::size_t most);

/// Returns a name in one line.
std::string one_line_label(const std::string& name);
/// Returns a name for CGNS, without slashes.
std::string cgns_label(const std::string& name);
/// Returns a name of ASCII letters for MED; its readers interpret other letters differently.
std::string ascii_label(const std::string& name);
/// Rules for formats without comments, which cannot list renamed entities. Names of CGNS have at most 32
/// characters, names of MED 80 bytes, names of Exodus as many as the file says.
inline constexpr UniqueLabels::Rules kExodusLabels{one_line_label, false, 70};
inline constexpr UniqueLabels::Rules kCgnsLabels{cgns_label, false, 22};
inline constexpr UniqueLabels::Rules kMedLabels{ascii_label, false, 70};
/// Returns a name of ASCII letters, digits and _-.+@, as flag_meanings of netCDF are.
std::string word_label(const std::string& name);
/// Returns a name of letters, digits and underscores that begins with a letter.
std::string plain_label(const std::string& name);

}  // namespace delquad
