#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cctype>
#include <numeric>
#include <string_view>

#include "metrics/tables/table.h"

// Tables for LaTeX. They are set at 8 points, and columns that do not fit beside each other stand below each
// other, over the same rows.

namespace delquad {
namespace {

constexpr double kPageWidth = 345;    ///< points: \textwidth of LaTeX's classes on A4 at 10 points
constexpr double kColumnSpace = 6;    ///< points: twice \tabcolsep as set below
constexpr double kMostOfNames = 100;  ///< points that one of the names' columns takes; longer ones are broken
constexpr std::size_t kLongestPiece = 12;  ///< characters of a name without a place to break it
constexpr std::size_t kLongestWord = 30;   ///< characters of a note without one
constexpr std::size_t kFullPage = 32;     ///< lines of groups, after which the next one has a page of its own
constexpr std::size_t kMostRows = 40;     ///< that fit on a page, with head and notes
constexpr double kLeastOfTexts = 70;      ///< points that a column of broken values takes
constexpr std::size_t kLongestText = 16;  ///< characters of a word in it

/// The next character of UTF-8 and its bytes; U+FFFD for what is none.
std::pair<char32_t, std::size_t> decode(std::string_view text) {
  auto at = text.begin();
  const auto code = boost::locale::utf::utf_traits<char>::decode(at, text.end());
  if (!boost::locale::utf::is_valid_codepoint(code)) return {0xFFFD, 1};
  return {code, static_cast<std::size_t>(at - text.begin())};
}

/// Letters of western Europe that every LaTeX has in its first fonts; others would end its run.
bool is_in_every_font(char32_t code) {
  constexpr std::u32string_view kMissing = U"\u00D0\u00D7\u00DE\u00F0\u00F7\u00FE";
  return code >= 0xC0 && code <= 0xFF && kMissing.find(code) == kMissing.npos;
}

std::string tex_character(char c) {
  switch (c) {
    case '\\':
      return "\\textbackslash{}";
    case '^':
      return "\\^{}";
    case '~':
      return "$\\sim$";
    case '<':
    case '>':
    case '|':
      return fmt::format("${}$", c);
    case '&':
    case '%':
    case '$':
    case '#':
    case '_':
    case '{':
    case '}':
      return fmt::format("\\{}", c);
    default:
      return static_cast<unsigned char>(c) < ' ' || c == 0x7F ? " " : std::string(1, c);
  }
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

/// Comments end with their line.
std::string in_one_line(const std::string& text) { return replace_all(text, "\n", " "); }

constexpr TableStyle kTex = {"\\textbf{", "}", " $\\pm$ ", tex_escaped};

/// In points, at 8 points and rounded up, of text that is not escaped.
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

/// Escaped, with places where words of more than `longest` characters may be broken: after what is no letter
/// or figure, and after every few characters.
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

/// The columns of one tabular beside the names.
struct Block {
  std::size_t first, last;
};

class TexTable {
 public:
  /// `in_one_piece`: all columns stand beside each other. Then, and where groups have long names, these stand
  /// above their rows, in place of a column.
  explicit TexTable(const Table& table, bool in_one_piece = false)
      : title_(table.title),
        plain_(render(table, {"", "", " +- ", [](const std::string& text) { return text; }})),
        rendered_(render(table, kTex)),
        in_one_piece_(in_one_piece),
        in_groups_(in_one_piece) {
    for (const std::size_t k : {0, 1}) {
      const double width = widest([&](const auto& line) { return line.names[k]; });
      if (k == 0) in_groups_ |= width > kMostOfNames;
      if (k == 0 && in_groups_) continue;
      names_[k] = std::min(width, kMostOfNames);
      broken_[k] = width > kMostOfNames;
    }
    for (const TableColumn& column : shown_columns(table))
      are_texts_.push_back(std::ranges::none_of(
          table.rows, [&](const TableRow& row) { return row.values.contains(column.key); }));
    const double failed = widest([](const auto& line) { return line.missing; });
    for (std::size_t k = 0; k < are_texts_.size(); ++k)
      values_.push_back(std::max(failed, widest([&](const auto& line) { return line.values[k]; })) +
                        kColumnSpace);
    // What is too wide is broken: alone, or the widest of a table that is to stay in one piece.
    paragraphs_.assign(values_.size(), 0);
    const double excess = std::accumulate(values_.begin(), values_.end(), -room());
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const bool is_widest = in_one_piece_ && values_[k] == *std::ranges::max_element(values_);
      const double most = std::max(is_widest ? std::min(values_[k] - excess, room()) : room(), kLeastOfTexts);
      if (values_[k] > most) paragraphs_[k] = values_[k] = most;
    }
  }

  std::string text() const {
    return fmt::format("% {}\n% Set at 8 points; to be input between paragraphs{}.\n", in_one_line(title_),
                       is_long() ? ", not in a float, with booktabs and longtable"
                                 : " or in a float, with booktabs") +
           body();
  }

  std::string body() const {
    std::string text = "\\begingroup\\fontsize{8}{9.5}\\selectfont\\setlength{\\tabcolsep}{3pt}%\n";
    for (const Block& block : blocks()) text += tabular(block) + "\\par\\medskip\n";
    if (!plain_.notes.empty()) text += "{\\raggedright\n";
    for (const std::string& note : plain_.notes)
      text += fmt::format("\\noindent {}\\par\n",
                          replace_all(breakable(in_one_line(note), kLongestWord), " \\%", "~\\%"));
    if (!plain_.notes.empty()) text += "}\n";
    return text + "\\endgroup\n";
  }

 private:
  /// The greatest width in the head and all lines.
  template <class Text>
  double widest(Text text) const {
    double width = width_of(text(plain_.head));
    for (const auto& line : plain_.lines) width = std::max(width, width_of(text(line)));
    return width;
  }

  /// Points for columns beside those of names.
  double room() const { return kPageWidth - names_[0] - names_[1] - 2 * kColumnSpace; }

  /// As many columns beside each other as fit, at least one.
  std::vector<Block> blocks() const {
    std::vector<Block> result = {{0, 0}};
    double used = 0;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (used + values_[k] > room() + 0.01 && result.back().last > result.back().first) {
        result.push_back({k, k});
        used = 0;
      }
      used += values_[k];
      result.back().last = k + 1;
    }
    return result;
  }

  std::string name(std::size_t k, const std::string& text) const {
    return broken_[k] ? "\\raggedright " + breakable(text, 0) : tex_escaped(text);
  }

  /// A name above its rows; one that is wider than the page is broken.
  static std::string group_line(const std::string& group) {
    if (width_of(group) <= kPageWidth) return "\\emph{" + tex_escaped(group) + "}";
    return fmt::format("\\parbox[t]{{{}pt}}{{\\raggedright\\emph{{{}}}}}", kPageWidth, breakable(group, 0));
  }

  std::string line(const RenderedTable::Line& plain, const RenderedTable::Line& line,
                   const Block& block) const {
    std::string text = (in_groups_ ? "" : name(0, plain.names[0]) + " & ") + name(1, plain.names[1]);
    bool said = line.missing.empty();
    for (std::size_t k = block.first; k < block.last; ++k) {
      std::string value = line.values[k];
      if (!said && value.empty()) {
        value = line.missing;
        said = true;
      } else if (are_texts_[k] && paragraphs_[k] > 0) {
        value = breakable(plain.values[k], kLongestText);
      }
      if (paragraphs_[k] > 0)
        value = (are_texts_[k] ? "\\raggedright" : "\\raggedleft") + ("\\let\\\\\\tabularnewline " + value);
      text += " & " + value;
    }
    return text + " \\\\\n";
  }

  bool is_long() const { return !in_one_piece_ && rendered_.lines.size() > kMostRows; }

  /// One that is long runs over pages, with its head on each of them.
  std::string tabular(const Block& block) const {
    std::string text = is_long() ? "\\begin{longtable}[l]{@{}" : "\\noindent\\begin{tabular}{@{}";
    for (std::size_t k = in_groups_ ? 1 : 0; k < 2; ++k)
      text += broken_[k] ? fmt::format("p{{{:.0f}pt}}", kMostOfNames) : "l";
    for (std::size_t k = block.first; k < block.last; ++k)
      text += paragraphs_[k] > 0 ? fmt::format("p{{{:.0f}pt}}", paragraphs_[k] - kColumnSpace) : "r";
    text += "@{}}\n\\toprule\n" + line(plain_.head, rendered_.head, block) + "\\midrule\n";
    if (is_long()) text += "\\endhead\n\\bottomrule\n\\endfoot\n";
    for (std::size_t i = 0; i < plain_.lines.size(); ++i) {
      const std::string& group = plain_.lines[i].names[0];
      if (in_groups_ && (i == 0 || group != plain_.lines[i - 1].names[0]))
        text +=
            fmt::format("{}\\multicolumn{{{}}}{{@{{}}l@{{}}}}{{{}}} \\\\\n", i == 0 ? "" : "\\addlinespace\n",
                        1 + block.last - block.first, group_line(group));
      text += line(plain_.lines[i], rendered_.lines[i], block);
    }
    return text + (is_long() ? "\\end{longtable}" : "\\bottomrule\n\\end{tabular}");
  }

  std::string title_;
  RenderedTable plain_, rendered_;
  bool in_one_piece_, in_groups_;
  double names_[2] = {0, 0};  ///< widths
  bool broken_[2] = {false, false};
  std::vector<char> are_texts_;     ///< of columns
  std::vector<double> values_;      ///< widths, with the space between columns
  std::vector<double> paragraphs_;  ///< the same of values that are broken; 0: they are not
};

}  // namespace

std::string to_tex(const Table& table) { return TexTable(table).text(); }

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
    text += "\\smallskip\n" + TexTable(page, true).body() + "\\end{table*}\n";
    page.rows.clear();
    lines = 0;
  }
  return text;
}

}  // namespace delquad
