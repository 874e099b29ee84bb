#pragma once

#include <string>
#include <utility>
#include <vector>

namespace delquad {

/// Something suspicious about a model or a mesh, for people.
struct Warning {
  /// One that stands alone.
  Warning(std::string text_) : text(std::move(text_)) {}
  Warning(const char* text_) : text(text_) {}
  /// One of a kind, named in the plural: "curves shorter than the size". The larger `severity_`, in whatever
  /// unit the kind has, the worse.
  Warning(std::string kind_, double severity_, std::string text_)
      : kind(std::move(kind_)), severity(severity_), text(std::move(text_)) {}

  std::string kind;  ///< empty: it stands alone
  double severity = 0;
  std::string text;

  bool operator==(const Warning&) const = default;
};

/// A line for each kind, in the order of the first of each: its only text, or how many there are and the text
/// of the worst.
std::vector<std::string> summaries(const std::vector<Warning>& warnings);

/// The text of each.
std::vector<std::string> texts(const std::vector<Warning>& warnings);

}  // namespace delquad
