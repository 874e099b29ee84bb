#pragma once

#include <string_view>

#include "io/text_scanner.h"

namespace delquad::msh {

/// The numbers of an MSH file, which are text or bytes. All throw InputError as the scanner does.
class NumberReader {
 public:
  explicit NumberReader(TextScanner& in) : in_(in) {}

  /// From here on numbers are bytes. Reads the number 1, which tells the order of bytes.
  void expect_bytes();
  bool are_bytes() const { return are_bytes_; }
  /// Four bytes or text.
  long long integer(std::string_view what, long long low, long long high);
  /// Eight bytes or text.
  long long size(std::string_view what, long long low, long long high);
  /// A finite number.
  double real(std::string_view what);

 private:
  template <class T>
  T raw(std::string_view what);
  long long checked(long long value, std::string_view what, long long low, long long high) const;

  TextScanner& in_;
  bool are_bytes_ = false, other_order_ = false;
};

}  // namespace delquad::msh
