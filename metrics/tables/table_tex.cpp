// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cctype>
#include <numeric>
#include <string_view>

#include "metrics/tables/table.h"

// Tables for LaTeX, at 8 points. A line above each group has its name. Columns that do not fit beside each
// other follow below, over the same rows.

namespace delquad {
namespace {

constexpr double kPageWidth = 345;         ///< points: \textwidth of LaTeX's classes on A4 at 10 points
constexpr double kColumnSpace = 6;         ///< points: twice \tabcolsep as set below
constexpr double kMostOfNames = 100;       ///< points of the column of names; longer names are broken
constexpr double kLeastOfTexts = 70;       ///< points of a column of broken texts
constexpr std::size_t kLongestPiece = 12;  ///< characters of a name without a place to break it
constexpr std::size_t kLongestText = 16;   ///< characters of a word in a text
constexpr std::size_t kLongestWord = 30;   ///< characters of a word in a note
constexpr std::size_t kFullPage = 32;      ///< lines of groups, after which the next group starts a page

/// Returns the next character of UTF-8 and its number of bytes; U+FFFD if it is invalid.
std::pair<char32_t, std::size_t> decode(std::string_view text) {
  auto at = text.begin();
  const auto code = boost::locale::utf::utf_traits<char>::decode(at, text.end());
  if (!boost::locale::utf::is_valid_codepoint(code)) return {0xFFFD, 1};
  return {code, static_cast<std::size_t>(at - text.begin())};
}

/// Returns whether LaTeX's default fonts have this letter of western Europe; other characters would stop
/// LaTeX.
bool is_in_every_font(char32_t code) {
  constexpr std::u32string_view kMissing = U"\u00D0\u00D7\u00DE\u00F0\u00F7\u00FE";
  return code >= 0xC0 && code <= 0xFF && kMissing.find(code) == kMissing.npos;
}

std::string tex_character(char c) {
  constexpr std::string_view kOfMath = "<>|", kOfTex = "&%$#_{}";
  if (c == '\\') return "\\textbackslash{}";
  if (c == '^') return "\\^{}";
  if (c == '~') return "$\\sim$";
  if (kOfMath.find(c) != kOfMath.npos) return fmt::format("${}$", c);
  if (kOfTex.find(c) != kOfTex.npos) return fmt::format("\\{}", c);
  return static_cast<unsigned char>(c) < ' ' || c == 0x7F ? " " : std::string(1, c);
}

std::string tex_escaped(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const auto [code, bytes] = decode(std::string_view(text).substr(at));
    if (code < 0x80)
      result += tex_character(text[at]);
    else if (code == 0xB1)
      result += "$\\pm$";
    else
      result += is_in_every_font(code) ? text.substr(at, bytes) : "?";
    at += bytes;
  }
  return result;
}

/// Returns the text in one line, since comments end with their line.
std::string in_one_line(const std::string& text) { return replace_all(text, "\n", " "); }

constexpr TableStyle kTex = {"\\textbf{", "}", " $\\pm$ ", tex_escaped};

/// Returns the width of unescaped text in points, at 8 points, rounded up.
double width_of(const std::string& text) {
  constexpr std::string_view kThinOnes = " .,:;'!il|[]()/", kWideOnes = "mwMW%";
  double width = 0;
  for (const char c : text)
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80)
      width += kThinOnes.find(c) != kThinOnes.npos              ? 3.2
               : kWideOnes.find(c) != kWideOnes.npos            ? 8.9
               : (c >= 'A' && c <= 'Z') || c == '=' || c == '+' ? 7.1
                                                                : 4.8;
  return width;
}

/// Returns the escaped text, with breaks allowed in words of more than `longest` characters: after characters
/// other than letters and digits, and after every few characters.
std::string breakable(const std::string& text, std::size_t longest) {
  std::string result;
  for (std::size_t begin = 0, end; begin <= text.size(); begin = end + 1) {
    end = std::min(text.find(' ', begin), text.size());
    if (begin > 0) result += ' ';
    std::size_t piece = 0;
    for (std::size_t i = begin, bytes; i < end; i += bytes) {
      bytes = decode(std::string_view(text).substr(i)).second;
      result += tex_escaped(text.substr(i, bytes));
      const bool is_plain = std::isalnum(static_cast<unsigned char>(text[i])) != 0;
      if (end - begin <= longest || (is_plain && ++piece < kLongestPiece)) continue;
      result += "\\allowbreak{}";
      piece = 0;
    }
  }
  return result;
}

class TexTable {
 public:
  explicit TexTable(const Table& table)
      : plain_(render(table, {"", "", " +- ", [](const std::string& text) { return text; }})),
        rendered_(render(table, kTex)) {
    name_ = widest([](const auto& line) { return line.names[1]; });
    is_name_broken_ = name_ > kMostOfNames;
    name_ = std::min(name_, kMostOfNames);
    const std::vector<TableColumn> columns = shown_columns(table);
    const double missing = widest([](const auto& line) { return line.missing; });
    for (std::size_t k = 0; k < columns.size(); ++k)
      widths_.push_back(std::max(missing, widest([&](const auto& line) { return line.values[k]; })) +
                        kColumnSpace);
    const double excess = std::accumulate(widths_.begin(), widths_.end(), -room());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const bool is_text = std::ranges::none_of(
          table.rows, [&](const TableRow& row) { return row.values.contains(columns[k].key); });
      const double most = is_text ? std::max(widths_[k] - std::max(excess, 0.0), kLeastOfTexts) : room();
      are_broken_.push_back(widths_[k] > most);
      widths_[k] = std::min(widths_[k], most);
    }
  }

  /// Returns as many columns beside each other as fit, at least one: `tabular` below `tabular`, or
  /// `longtable`.
  std::string body(const std::string& environment) const {
    std::string text = "\\begingroup\\fontsize{8}{9.5}\\selectfont\\setlength{\\tabcolsep}{3pt}%\n";
    std::size_t first = 0;
    double used = 0;
    for (std::size_t k = 0; k < widths_.size(); ++k) {
      if (k > first && used + widths_[k] > room() + 0.01) {
        text += tabular(environment, first, k);
        first = k;
        used = 0;
      }
      used += widths_[k];
    }
    text += tabular(environment, first, widths_.size());
    if (!plain_.notes.empty()) text += "{\\raggedright\n";
    for (const std::string& note : plain_.notes)
      text += fmt::format("\\noindent {}\\par\n",
                          replace_all(breakable(in_one_line(note), kLongestWord), " \\%", "~\\%"));
    if (!plain_.notes.empty()) text += "}\n";
    return text + "\\endgroup\n";
  }

 private:
  /// Returns the greatest width in the head and all lines.
  template <class Text>
  double widest(Text text) const {
    double width = width_of(text(plain_.head));
    for (const auto& line : plain_.lines) width = std::max(width, width_of(text(line)));
    return width;
  }

  /// Returns the points for columns beside the names.
  double room() const { return kPageWidth - name_ - kColumnSpace; }

  std::string line(const RenderedTable::Line& plain, const RenderedTable::Line& line, std::size_t first,
                   std::size_t last) const {
    const std::string& name = plain.names[1];
    std::string text = is_name_broken_ ? "\\raggedright " + breakable(name, 0) : tex_escaped(name);
    bool said = line.missing.empty();
    for (std::size_t k = first; k < last; ++k) {
      std::string value =
          are_broken_[k] ? "\\raggedright " + breakable(plain.values[k], kLongestText) : line.values[k];
      if (!said && line.values[k].empty()) {
        value = line.missing;
        said = true;
      }
      text += " & " + value;
    }
    return text + " \\tabularnewline\n";
  }

  /// Returns the group's name above its rows, broken if it is wider than the page.
  static std::string group_line(const std::string& group, std::size_t columns) {
    return fmt::format("\\multicolumn{{{}}}{{@{{}}l@{{}}}}{{{}}} \\tabularnewline\n", columns,
                       width_of(group) <= kPageWidth
                           ? "\\emph{" + tex_escaped(group) + "}"
                           : fmt::format("\\parbox[t]{{{}pt}}{{\\raggedright\\emph{{{}}}}}", kPageWidth,
                                         breakable(group, 0)));
  }

  std::string tabular(const std::string& environment, std::size_t first, std::size_t last) const {
    const bool is_long = environment == "longtable";
    std::string text = fmt::format("\\{}begin{{{}}}{}{{@{{}}", is_long ? "" : "noindent\\", environment,
                                   is_long ? "[l]" : "");
    text += is_name_broken_ ? fmt::format("p{{{:.0f}pt}}", kMostOfNames) : "l";
    for (std::size_t k = first; k < last; ++k)
      text += are_broken_[k] ? fmt::format("p{{{:.0f}pt}}", widths_[k] - kColumnSpace) : "r";
    text += "@{}}\n\\toprule\n" + line(plain_.head, rendered_.head, first, last) + "\\midrule\n";
    if (is_long) text += "\\endhead\n\\bottomrule\n\\endfoot\n";
    for (std::size_t i = 0; i < plain_.lines.size(); ++i) {
      const std::string& group = plain_.lines[i].names[0];
      if (i == 0 || group != plain_.lines[i - 1].names[0])
        text += (i == 0 ? "" : "\\addlinespace\n") + group_line(group, 1 + last - first);
      text += line(plain_.lines[i], rendered_.lines[i], first, last);
    }
    return text + (is_long ? "" : "\\bottomrule\n") + "\\end{" + environment + "}\\par\\medskip\n";
  }

  RenderedTable plain_, rendered_;
  double name_ = 0;  ///< width of names
  bool is_name_broken_ = false;
  std::vector<double> widths_;    ///< widths of columns, with the space between them
  std::vector<char> are_broken_;  ///< columns whose texts are broken over lines
};

}  // namespace

std::string to_tex(const Table& table) {
  return fmt::format(
      "% {}\n% Set at 8 points; to be input between paragraphs, with booktabs and longtable.\n{}",
      in_one_line(table.title), TexTable(table).body("longtable"));
}

std::string to_tex_floats(const Table& table, const std::string& label, const std::string& caption) {
  std::string text;
  Table page = table;
  page.rows.clear();
  page.notes.clear();
  for (std::size_t i = 0, lines = 0; i < table.rows.size(); ++i) {
    const bool is_last = i + 1 == table.rows.size();
    page.rows.push_back(table.rows[i]);
    lines += page.rows.size() == 1 || table.rows[i].group != table.rows[i - 1].group ? 2 : 1;
    if (!is_last && (table.rows[i + 1].group == table.rows[i].group || lines < kFullPage)) continue;
    if (is_last) page.notes = table.notes;
    const std::string begin = "\\begin{table*}[tbp]\n\\caption{" + in_one_line(tex_escaped(table.title));
    text += text.empty() ? begin + ". " + caption + "}\\label{" + label + "}\n" : begin + ", continued.}\n";
    text += "\\smallskip\n" + TexTable(page).body("tabular") + "\\end{table*}\n";
    page.rows.clear();
    lines = 0;
  }
  return text;
}

}  // namespace delquad
