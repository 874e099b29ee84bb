// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/formats/nastran_card.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/text.h"

namespace delquad {
namespace {
constexpr std::size_t kField = 8, kWide = 16;
}

std::string without_tabs(std::string_view line) {
  std::string result;
  for (const char c : line.substr(0, line.find('$')))
    if (c == '\t')
      result.resize((result.size() / kField + 1) * kField, ' ');
    else
      result += c;
  return result;
}

std::string NastranCard::take(const std::string& text) {
  std::vector<std::string> parts;
  const bool is_free = text.find(',') != std::string::npos,
             is_wide = text.substr(0, std::min(text.find(','), kField)).find('*') != std::string::npos;
  const std::size_t n_fields = is_wide ? 4 : 8;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t width = parts.empty()             ? kField
                              : parts.size() > n_fields ? text.size()
                              : is_wide                 ? kWide
                                                        : kField,
                      stop = std::min(is_free ? text.find(',', at) : at + width, text.size());
    parts.emplace_back(trimmed(std::string_view(text).substr(at, stop - at)));
    at = stop + (is_free || stop == text.size() ? 1 : 0);
  }
  while (parts.size() > n_fields + 2 && parts.back().empty()) parts.pop_back();
  if (parts.size() > n_fields + 2) return fmt::format("a line of more than {} fields", n_fields + 2);
  parts.resize(n_fields + 2);
  const std::string head = parts[0].substr(std::min(parts[0].find_first_not_of("+*"), parts[0].size()));
  if (!fields.empty() && !mark.empty() && !head.empty() && upper(head) != upper(mark))
    return fmt::format("a line that goes on with '{}' behind one that ends with '{}'", head, mark);
  if (fields.empty()) name = upper(parts[0]), std::erase(name, '*');
  fields.insert(fields.end(), parts.begin() + 1, parts.end() - 1);
  mark = parts.back().substr(std::min(parts.back().find_first_not_of("+*"), parts.back().size()));
  return "";
}

bool continues_card(const std::string& text) {
  const std::string_view head = trimmed(std::string_view(text).substr(0, std::min(text.find(','), kField)));
  return head.empty() || head[0] == '+' || head[0] == '*';
}

NastranCard first_card(std::string_view text) {
  NastranCard card;
  for (std::size_t at = 0, next = 0; at < text.size(); at = next) {
    next = std::min(text.find('\n', at), text.size() - 1) + 1;
    const std::string line = without_tabs(text.substr(at, next - at));
    if (trimmed(line).empty()) continue;
    if (!card.fields.empty() && !continues_card(line)) break;
    card.take(line);
  }
  card.fields.resize(std::max<std::size_t>(card.fields.size(), 8));
  return card;
}

std::string card_text(const std::string& name, std::vector<std::string> fields) {
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  const bool is_wide = std::ranges::any_of(fields, [](const auto& f) { return f.size() > kField; });
  std::string text = fmt::format("{:<8}", name + (is_wide ? "*" : ""));
  const std::size_t n = is_wide ? 4 : 8, width = is_wide ? kWide : kField;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (k > 0 && k % n == 0) text += is_wide ? "\n*       " : "\n        ";
    text += fields[k];
    text.append(width - std::min(width, fields[k].size()), ' ');
  }
  return text + '\n';
}

std::optional<long long> as_nastran_integer(std::string_view text) {
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1) return std::nullopt;
  return value;
}

std::optional<double> as_nastran_real(std::string_view text) {
  std::string digits;
  for (const char c : text) {
    const bool is_sign = c == '+' || c == '-';
    if (is_sign && !digits.empty() && digits.back() != 'e') digits += 'e';
    if (c != '+') digits += c == 'D' || c == 'd' || c == 'E' ? 'e' : c;
  }
  if (text.empty()) return 0;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

bool is_nastran_element(const std::string& name) { return name[0] == 'C' && !name.starts_with("CORD"); }

std::string nastran_number(double x) {
  char digits[48];
  for (int n = 16; n > 0; --n) {
    std::string text(digits,
                     std::to_chars(digits, digits + sizeof digits, x, std::chars_format::general, n).ptr);
    const std::size_t exponent = text.find('e');
    if (text.find('.') == std::string::npos)
      text.insert(exponent == std::string::npos ? text.size() : exponent, ".");
    if (text.size() <= kWide) return text + std::string(kWide - text.size(), ' ');
  }
  return fmt::format("{:<{}}", "0.", kWide);
}

std::string nastran_set(const std::string& number, const std::vector<long long>& members) {
  std::string text, line = "SET " + number + " = ";
  constexpr std::size_t kLongestLine = 70;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::string id = std::to_string(members[i]) + (i + 1 < members.size() ? "," : "");
    if (line.size() + id.size() > kLongestLine) text += line + '\n', line = "        ";
    line += id;
  }
  return text + line + '\n';
}

}  // namespace delquad
