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
  std::vector<std::string> fields = {};  ///< eight for each line, or four wide ones
  int line = 0;
  std::size_t begin = 0, end = 0;  ///< offsets of its lines
  std::string mark = {};           ///< text at the end of the last line

  std::string_view field(std::size_t k) const {
    return k < fields.size() ? std::string_view(fields[k]) : std::string_view();
  }
  /// Adds the first or a continued line. Returns the problem; empty: none.
  std::string take(const std::string& text);
};

/// Returns a line with blanks for tabs, and without its comment behind "$".
std::string without_tabs(std::string_view line);
/// Returns whether a line continues the card before it.
bool continues_card(const std::string& text);
/// Returns the card at the beginning of a text.
NastranCard first_card(std::string_view text);
/// Returns the text of a card, in fields of fitting width.
std::string card_text(const std::string& name, std::vector<std::string> fields);
/// Returns whether a card is an element, of any kind.
bool is_nastran_element(const std::string& name);

/// Returns an integer from 1; nothing for other texts.
std::optional<long long> as_nastran_integer(std::string_view text);
/// Returns a number: "1.5-3" and "1.5D-3" are 0.0015, and blank is 0. Returns nothing for other texts.
std::optional<double> as_nastran_real(std::string_view text);
/// Returns a coordinate in 16 characters, with the decimal point that Nastran needs.
std::string nastran_number(double x);
/// Returns "SET 5 = 1, 2, 3," in lines of at most 72 characters.
std::string nastran_set(const std::string& number, const std::vector<long long>& members);

}  // namespace delquad
