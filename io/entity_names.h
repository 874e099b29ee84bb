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

/// Returns the name of a nameless entity in files: "point_7" (dimension 0), "curve_7" (1), "region_7" (2) or
/// "volume_7" (3).
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

/// Returns whether a name has the word in it, in small letters or large ones.
bool name_contains(std::string name, std::string_view word);

/// Returns the name in one line of at most 200 bytes, for comments.
std::string one_line(std::string_view name);

/// Names as a format can hold them. Different names get different labels: a name that can stay as it is does,
/// others get a number where their label is taken.
class UniqueLabels {
 public:
  /// A name and what it is the name of; the same name of another kind has another label.
  using Key = std::pair<int, std::string>;
  struct Rules {
    std::string (*plain)(const std::string&);  ///< turns every name into one that the format can hold
    bool ignores_case = false;                 ///< whether the format takes "A" and "a" for the same
    size_t longest = 70;                       ///< bytes; numbers may make labels ten bytes longer
  };
  UniqueLabels(const std::vector<Key>& keys, const Rules& rules);

  const std::string& of(const Key& key) const { return label_of_.at(key); }
  /// Keys whose label is not their name, with it.
  const std::vector<std::pair<Key, std::string>>& renamed() const { return renamed_; }

 private:
  bool take(const std::string& label, bool ignores_case);

  std::map<Key, std::string> label_of_;
  std::set<std::string> taken_;
  std::vector<std::pair<Key, std::string>> renamed_;
};

/// Curves (dimension 1) and regions (2) by the numbers that a file has for them, in the order in which
/// elements first have them. Numbers are tags where they are positive; others stand behind those.
class NumberedEntities {
 public:
  /// Largest number of an entity; twice as much is still a tag.
  static constexpr long long kMostNumber = 999'999'999;

  /// Takes a comment that is `before`, a number, `after` and a name, such as "# curve 3: north", which may
  /// end in
  /// "\r". It must stand before the elements. False: it is no such comment.
  bool take_name(std::string_view comment, std::string_view before, std::string_view after, int dim);
  /// Returns the index into Mesh::curves or Mesh::regions.
  int index(int dim, long long number, Mesh& mesh);

 private:
  std::map<std::pair<int, long long>, std::vector<std::string>> names_;
  std::map<std::pair<int, long long>, int> index_;
};

/// Returns the unit of lengths that a comment of our writers tells after its mark ("#"); empty: it tells
/// none.
std::string unit_in_comment(std::string_view comment, std::string_view mark);

/// Returns whether all points have one z and the elements run counterclockwise as seen from above.
bool is_planar(const Mesh& mesh);

/// Throws InputError where is_planar() is false.
void require_planar(const std::filesystem::path& path, const std::string& format, const Mesh& mesh);
/// Does the same but for meshes of z over the plane, such as the ground below water.
void require_terrain(const std::filesystem::path& path, const std::string& format, const Mesh& mesh);
/// Throws InputError where there are triangles.
void require_quads(const std::filesystem::path& path, const std::string& format, const Mesh& mesh);

/// Throws InputError where there are more of something than numbers that a format can hold.
void require_fits(const std::filesystem::path& path, const std::string& format, std::size_t n,
                  const std::string& what, std::size_t most);
/// Throws InputError unless the format holds the numbers of nodes, and of lines, triangles and quads
/// together. These are numbered from 1.
void require_numbers(const std::filesystem::path& path, const std::string& format, const Mesh& mesh,
                     std::size_t most);

/// Returns a name in one line.
std::string one_line_label(const std::string& name);
/// Returns a name for CGNS, where it has no slash.
std::string cgns_label(const std::string& name);
/// Returns a name for MED, whose readers take letters of other alphabets in several ways.
std::string ascii_label(const std::string& name);
/// Labels of formats that have no comments to tell what was renamed. Names of CGNS have at most 32
/// characters, names of MED 80 bytes, names of Exodus as many as the file says.
inline constexpr UniqueLabels::Rules kExodusLabels{one_line_label, false, 70};
inline constexpr UniqueLabels::Rules kCgnsLabels{cgns_label, false, 22};
inline constexpr UniqueLabels::Rules kMedLabels{ascii_label, false, 70};
/// Returns a name of ASCII letters, digits and _-.+@, as flag_meanings of netCDF are.
std::string word_label(const std::string& name);
/// Returns a name of letters, digits and underscores that begins with a letter.
std::string plain_label(const std::string& name);

}  // namespace delquad
