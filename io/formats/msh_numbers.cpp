#include "io/formats/msh_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace delquad::msh {

template <class T>
T NumberReader::raw(std::string_view what) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, in_.bytes(sizeof bytes, what).data(), sizeof bytes);
  if (other_order_) std::reverse(bytes, bytes + sizeof bytes);
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

void NumberReader::expect_bytes() {
  constexpr std::int32_t kOneInOtherOrder = 1 << 24;
  in_.rest_of_line();
  in_.bytes(1, "the end of the line");
  are_bytes_ = true;
  const auto one = raw<std::int32_t>("the number 1");
  other_order_ = one == kOneInOtherOrder;
  if (one != 1 && !other_order_) in_.fail(fmt::format("expected the number 1 in four bytes, found {}", one));
}

long long NumberReader::checked(long long value, std::string_view what, long long low, long long high) const {
  if (value < low || value > high)
    in_.fail(fmt::format("expected {} from {} to {}, found {}", what, low, high, value));
  return value;
}

long long NumberReader::integer(std::string_view what, long long low, long long high) {
  if (!are_bytes_) return in_.integer(what, low, high);
  return checked(raw<std::int32_t>(what), what, low, high);
}

long long NumberReader::size(std::string_view what, long long low, long long high) {
  if (!are_bytes_) return in_.integer(what, low, high);
  return checked(static_cast<long long>(raw<std::uint64_t>(what)), what, low, high);
}

double NumberReader::real(std::string_view what) {
  if (!are_bytes_) return in_.real(what);
  const auto value = raw<double>(what);
  if (!std::isfinite(value)) in_.fail(fmt::format("expected {} (a finite number), found {}", what, value));
  return value;
}

}  // namespace delquad::msh
