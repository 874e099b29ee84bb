// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

// This header has formulas. Readers of sizes and crosses use it.

namespace delquad {

/// A formula in named variables, parsed once: + - * / ^ (power), comparisons, && || ?:, the usual functions
/// (sin, sqrt, exp, abs, min, max, atan2, ...) and the constants pi and e. Several threads may evaluate it.
class Expression {
 public:
  /// Throws InputError, with the text, the position (characters from 1) and the reason, for syntax errors and
  /// for names other than `variables`.
  Expression(const std::string& text, std::vector<std::string> variables);
  Expression(const Expression& other);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression other) noexcept;
  ~Expression();

  /// Returns the value of the formula, which may be infinite or NaN. `values` has one value for each
  /// variable, in their order; another number throws std::invalid_argument.
  double operator()(std::span<const double> values) const;

  const std::string& text() const;
  /// Returns the text for messages: one line of at most kMostShown characters.
  std::string shown() const;
  static constexpr std::size_t kMostShown = 80;

 private:
  struct Parsed;
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace delquad
