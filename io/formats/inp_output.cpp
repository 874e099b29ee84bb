#include "io/formats/inp_output.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace delquad {

namespace {

constexpr std::ptrdiff_t kLongestInpNumber = 20;
/// On one line of a set, which may have no more.
constexpr std::size_t kInpNumbersPerLine = 16;

/// In at most 20 characters: CalculiX cuts off what follows, perhaps within the exponent. "0" below
/// `negligible`.
std::string inp_number(double x, double negligible) {
  if (std::abs(x) < negligible) return "0";
  char digits[32];
  char* end = std::to_chars(digits, digits + sizeof digits, x).ptr;
  for (int n = 17; end - digits > kLongestInpNumber; --n)
    end = std::to_chars(digits, digits + sizeof digits, x, std::chars_format::general, n).ptr;
  return {digits, end};
}

}  // namespace

void write_inp_node(TextWriter& out, std::size_t number, const Vec3& p, double negligible) {
  out << number;
  for (const double x : {p.x, p.y, p.z}) out << ", " << inp_number(x, negligible);
  out << '\n';
}

void write_inp_sets(TextWriter& out, const char* keyword, InpSets& sets) {
  for (auto& [label, numbers] : sets) {
    out << '*' << keyword << ", " << keyword << '=' << label << '\n';
    write_inp_numbers(out, numbers, kInpNumbersPerLine);
  }
}

void write_inp_numbers(TextWriter& out, std::vector<int>& numbers, std::size_t per_line) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool last = i + 1 == numbers.size() || (i + 1) % per_line == 0;
    out << numbers[i] << (last ? "\n" : ", ");
  }
}

}  // namespace delquad
