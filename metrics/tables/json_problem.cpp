#include "metrics/tables/json_problem.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

namespace delquad {
namespace {

/// ":LINE:COLUMN", as the parser has it in its text; empty where it has not.
std::string place_in(const std::string& text) {
  const auto at = text.find("at line ");
  int line = 0, column = 0;
  if (at == std::string::npos || std::sscanf(text.c_str() + at, "at line %d, column %d", &line, &column) != 2)
    return "";
  return fmt::format(":{}:{}", line, column);
}

std::string why(const std::exception& error) {
  const std::string text = error.what();
  const auto* json = dynamic_cast<const nlohmann::json::exception*>(&error);
  if (json == nullptr) return text;
  if (dynamic_cast<const nlohmann::json::parse_error*>(json) != nullptr) {
    const auto says = [&](const char* part) { return text.find(part) != std::string::npos; };
    return says("end of input") || says("missing closing quote") ? "it ends there, too early"
                                                                 : "no JSON there";
  }
  constexpr int kKeyNotFound = 403;
  const auto first = text.find('\''), last = text.rfind('\'');
  if (json->id == kKeyNotFound && first < last) return text.substr(first, last + 1 - first) + " is missing";
  return "a value in it is not of the expected kind";
}

}  // namespace

std::string json_problem(const std::filesystem::path& file, const std::string& what,
                         const std::exception& error) {
  return fmt::format("{}{}: {}{}{}", file.string(), place_in(error.what()), what, what.empty() ? "" : ": ",
                     why(error));
}

}  // namespace delquad
