#include "io/formats/inp_output.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace delquad {

namespace {

constexpr std::ptrdiff_t kLongestInpNumber = 20;

}  // namespace

std::string inp_number(double x, double negligible) {
  if (std::abs(x) < negligible) return "0";
  char digits[32];
  char* end = std::to_chars(digits, digits + sizeof digits, x).ptr;
  for (int n = 17; end - digits > kLongestInpNumber; --n)
    end = std::to_chars(digits, digits + sizeof digits, x, std::chars_format::general, n).ptr;
  return {digits, end};
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
