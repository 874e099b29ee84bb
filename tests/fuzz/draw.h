// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace delquad::fuzz {

/// Numbers drawn from bytes, one after the other; zeros when there are no more. Arguments of one call must
/// not draw: their order is the compiler's choice.
class Draw {
 public:
  explicit Draw(std::string_view bytes) : bytes_(bytes) {}

  bool at_end() const { return bytes_.empty(); }
  int byte() {
    if (bytes_.empty()) return 0;
    const int value = static_cast<unsigned char>(bytes_[0]);
    bytes_.remove_prefix(1);
    return value;
  }
  /// From 0 to n - 1; n at most 256.
  int below(int n) { return byte() % n; }
  bool flag() { return byte() % 2 == 1; }
  /// From `low` to `high`, in 255 steps.
  double between(double low, double high) { return low + (high - low) * byte() / 255; }

 private:
  std::string_view bytes_;
};

}  // namespace delquad::fuzz
