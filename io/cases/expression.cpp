// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "base/located.h"

namespace delquad {

namespace {

/// At most kMostShown characters from `first` on, on one line.
std::string excerpt(const std::string& text, std::size_t first) {
  std::string part = text.substr(first, Expression::kMostShown);
  for (char& c : part)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  return (first > 0 ? "..." : "") + part + (first + part.size() < text.size() ? "..." : "");
}

[[noreturn]] void fail(const std::string& text, const std::string& reason, int position) {
  if (position < 0) refuse("expression '{}': {}", excerpt(text, 0), reason);
  // A long text is shown around the position.
  constexpr std::size_t kBefore = Expression::kMostShown / 2;
  const std::size_t at = std::min(static_cast<std::size_t>(position), text.size());
  const std::size_t first = text.size() > Expression::kMostShown && at > kBefore ? at - kBefore : 0;
  refuse("expression '{}', position {}: {}", excerpt(text, first), at + 1, reason);
}

std::string join(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

std::string trimmed(const std::string& s) {
  const auto end = s.find_last_not_of(". \n");
  return s.substr(0, end == std::string::npos ? 0 : end + 1);
}

// muParser's own texts repeat the formula and the position, which fail() states already.
std::string reason_of(const mu::ParserError& error, const std::vector<std::string>& variables) {
  switch (error.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN: {
      const auto at = static_cast<std::size_t>(std::max(error.GetPos(), 0));
      const bool is_unit = at > 0 && at < error.GetExpr().size() && std::isdigit(error.GetExpr()[at - 1]);
      return fmt::format("'{}' is not known (variables: {}){}", excerpt(trimmed(error.GetToken()), 0),
                         join(variables), is_unit ? "; a number has no unit here" : "");
    }
    case mu::ecUNEXPECTED_EOF:
    case mu::ecEMPTY_EXPRESSION:
      return "the expression ends too early: expected an operand";
    case mu::ecMISSING_PARENS:
      return "a closing parenthesis is missing";
    default:
      break;
  }
  std::string message = error.GetMsg();
  for (const char* place : {" found at position", " at position", " at expression position"})
    message = message.substr(0, message.find(place));
  return excerpt(trimmed(message), 0);
}

// muParser would let a formula overwrite its variables.
void reject_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool comparison_begins = i + 1 < text.size() && text[i + 1] == '=';
    const bool comparison_ends = i > 0 && std::string("=!<>").find(text[i - 1]) != std::string::npos;
    if (!comparison_begins && !comparison_ends)
      fail(text, "assignment is not allowed: compare by '=='", static_cast<int>(i));
  }
}

}  // namespace

struct Expression::Parsed {
  std::string text;
  std::vector<std::string> variables;
  std::vector<double> values;
  mu::Parser parser;
  // The parser evaluates on storage of its own; a lock costs less than one evaluation.
  std::mutex mutex;

  Parsed(std::string formula, std::vector<std::string> names)
      : text(std::move(formula)), variables(std::move(names)), values(variables.size()) {
    reject_assignment(text);
    int results = 0;
    try {
      parser.DefineConst("pi", 3.14159265358979323846);
      parser.DefineConst("e", 2.71828182845904523536);
      for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(variables[i], &values[i]);
      parser.SetExpr(text);
      parser.Eval(results);
    } catch (const mu::ParserError& error) {
      fail(text, reason_of(error, variables), error.GetPos());
    }
    if (results != 1) fail(text, fmt::format("expected one value, found {}", results), -1);
  }
};

Expression::Expression(const std::string& text, std::vector<std::string> variables)
    : parsed_(std::make_unique<Parsed>(text, std::move(variables))) {}

Expression::Expression(const Expression& other) : Expression(other.parsed_->text, other.parsed_->variables) {}
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression other) noexcept {
  parsed_ = std::move(other.parsed_);
  return *this;
}
Expression::~Expression() = default;

const std::string& Expression::text() const { return parsed_->text; }

std::string Expression::shown() const { return excerpt(parsed_->text, 0); }

double Expression::operator()(std::span<const double> values) const {
  if (values.size() != parsed_->values.size())
    throw std::invalid_argument(fmt::format("expression '{}' takes {} values, not {}", parsed_->text,
                                            parsed_->values.size(), values.size()));
  const std::lock_guard lock(parsed_->mutex);
  std::ranges::copy(values, parsed_->values.begin());
  try {
    return parsed_->parser.Eval();
  } catch (const mu::ParserError& error) {
    fail(parsed_->text, reason_of(error, parsed_->variables), -1);
  }
}

}  // namespace delquad
