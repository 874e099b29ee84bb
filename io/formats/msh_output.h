#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "io/entity_names.h"
#include "io/text_writer.h"

// What files of MSH 4.1 have in common, whatever elements they hold.

namespace delquad {

/// Numbers as text, separated by blanks, or as bytes.
class MshNumbers {
 public:
  MshNumbers(std::ostream& stream, bool binary) : out_(stream), binary_(binary) {}

  MshNumbers& integer(int value) { return put(value); }
  MshNumbers& size(size_t value) { return put(static_cast<std::uint64_t>(value)); }
  MshNumbers& real(double value) { return put(value); }
  MshNumbers& point(const Vec3& p) { return real(p.x).real(p.y).real(p.z); }
  void end_line() {
    if (!binary_) out_ << '\n';
    at_start_ = true;
  }
  void line(std::string_view text) { out_ << text << '\n'; }
  void end_section(std::string_view name) {
    if (binary_) out_ << '\n';
    line(name);
  }
  void flush() { out_.flush(); }

 private:
  template <class T>
  MshNumbers& put(T value) {
    if (binary_) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      out_ << std::string_view(bytes, sizeof value);
      return *this;
    }
    if (!at_start_) out_ << ' ';
    at_start_ = false;
    out_ << value;
    return *this;
  }

  TextWriter out_;
  bool binary_, at_start_ = true;
};

void write_msh_header(MshNumbers& out, bool binary);

/// Physical groups: their numbers, by dimension and name, and the labels that files have.
struct MshGroups {
  std::map<UniqueLabels::Key, int> tags;
  std::set<std::tuple<int, int, std::string>> labels;  ///< dimension, number, label
};
/// A name that is a number is that group's number; others take those that are left, in order of appearance.
MshGroups number_msh_groups(const std::vector<UniqueLabels::Key>& keys);
void write_msh_groups(MshNumbers& out, const MshGroups& groups);

struct MshEntity {
  int dim;
  const Entity* entity;
  std::string group;
};
/// Names of entities beside their groups, which other programs skip.
void write_more_names(std::ostream& stream, const std::vector<MshEntity>& entities);

/// Where it is known.
void write_msh_unit(std::ostream& stream, const std::string& unit);

}  // namespace delquad
