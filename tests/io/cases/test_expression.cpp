// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/expression.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

double value(const std::string& text, double x = 2) { return Expression(text, {"x"})(std::array{x}); }

TEST(Expression, KnowsOperatorsFunctionsAndConstants) {
  EXPECT_DOUBLE_EQ(value("x^2^3"), 256);
  EXPECT_DOUBLE_EQ(value("-x^2"), -4);
  EXPECT_DOUBLE_EQ(value("2e-3*x"), 0.004);
  EXPECT_DOUBLE_EQ(value("pi"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(value("e^x"), std::exp(2.0));
  EXPECT_DOUBLE_EQ(value("atan2(1, -2*x)"), std::atan2(1, -4));
  EXPECT_DOUBLE_EQ(value("x < 1 ? 10 : min(20, 30)"), 20);
  EXPECT_DOUBLE_EQ(value("x >= 2 && x != 3 && x == 2 && x <= 2"), 1);
}

TEST(Expression, TakesVariablesInTheOrderGiven) {
  const Expression f("x - 2*y + 4*z", {"z", "x", "y"});
  EXPECT_DOUBLE_EQ(f(std::array{1.0, 10.0, 100.0}), 10 - 200 + 4);
  EXPECT_THROW(f(std::array{1.0}), std::invalid_argument);
}

TEST(Expression, ReturnsNonFiniteValuesAsTheyCome) {
  EXPECT_TRUE(std::isnan(value("sqrt(-x)")));
  EXPECT_TRUE(std::isinf(value("1/(x-2)")));
}

TEST(Expression, CopiesAreIndependent) {
  Expression a("x+1", {"x"});
  const Expression b = a;
  a = Expression("x*10", {"x"});
  EXPECT_DOUBLE_EQ(a(std::array{3.0}), 30);
  EXPECT_DOUBLE_EQ(b(std::array{3.0}), 4);
  EXPECT_EQ(b.text(), "x+1");
}

TEST(Expression, ThreadsMayShareOne) {
  const Expression f("x*x", {"x"});
  std::vector<int> wrong(4, 0);
  {
    std::vector<std::jthread> threads;
    for (int k = 0; k < 4; ++k)
      threads.emplace_back([&f, &wrong, k] {
        for (int i = 0; i < 20000; ++i)
          wrong[static_cast<std::size_t>(k)] += f(std::array{k + 1.0 * i}) != (k + 1.0 * i) * (k + i);
      });
  }
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(Expression, SaysWhatDoesNotParseAndWhere) {
  const auto parse = [](const char* text) { return [text] { Expression(text, {"x", "y"}); }; };
  expect_input_error(parse("x+foo"), {"'x+foo'", "position 3", "'foo' is not known", "x, y"});
  expect_input_error(parse("x+"), {"'x+'", "position 3", "operand"});
  expect_input_error(parse("(x"), {"'(x'", "parenthesis"});
  expect_input_error(parse("x)"), {"'x)'", "position 2"});
  expect_input_error(parse(""), {"''", "operand"});
  expect_input_error(parse("x y"), {"position 3"});
  expect_input_error(parse("1,2"), {"one value"});
  expect_input_error(parse("sin()"), {"Too few"});
  expect_input_error(parse("x = 3"), {"position 3", "assignment"});
}

}  // namespace
}  // namespace delquad
