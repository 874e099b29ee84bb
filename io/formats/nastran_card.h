// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// This header has cards of Nastran. Its reader uses it.

namespace delquad {

inline constexpr long long kMostNastran = 99'999'999;

/// The name of a card and its fields, from one line or several.
struct NastranCard {
  std::string name;                      ///< in capitals, without the star
  std::vector<std::string> fields = {};  ///< eight of a line, or four wide ones
  int line = 0;
  std::size_t begin = 0, end = 0;  ///< of its lines
  std::string mark = {};           ///< at the end of the last line

  std::string_view field(std::size_t k) const {
    return k < fields.size() ? std::string_view(fields[k]) : std::string_view();
  }
  /// Takes a line: the first one, or one that goes on. Returns what is wrong, or nothing.
  std::string take(const std::string& text);
};

/// Returns a line with blanks for its tabs, without what stands behind a "$".
std::string without_tabs(std::string_view line);
/// Returns whether a line goes on with the card before it.
bool continues_card(const std::string& text);
/// Returns the first card of a text that begins with it.
NastranCard first_card(std::string_view text);
/// Returns the card in lines of fields that it fits.
std::string card_text(const std::string& name, std::vector<std::string> fields);
/// Returns whether a card is an element, of any kind.
bool is_nastran_element(const std::string& name);

/// Returns a number from 1 on.
std::optional<long long> as_nastran_integer(std::string_view text);
/// Reads a number: "1.5-3" and "1.5D-3" are 0.0015, and nothing is 0.
std::optional<double> as_nastran_real(std::string_view text);
/// Returns a coordinate in 16 characters, with the point that Nastran wants.
std::string nastran_number(double x);
/// Returns "SET 5 = 1, 2, 3," in lines of at most 72 characters.
std::string nastran_set(const std::string& number, const std::vector<long long>& members);

}  // namespace delquad
