#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <charconv>
#include <stdexcept>

#include "experiments/suite/suite_list.h"

namespace delquad {
namespace {

std::string sha256(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256 failed");
  std::string text;
  for (unsigned i = 0; i < length; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Not inside of a word or of an entity's number.
bool begins_number(const std::string& before, const char* at, const char* end) {
  if (!before.empty() && (is_digit(before.back()) || before.back() == '#')) return false;
  return is_digit(*at) || (*at == '-' && at + 1 < end && is_digit(at[1]));
}

std::string six_digits(double value) {
  const std::string text = fmt::format("{:.6f}", value);
  return text == "-0.000000" ? text.substr(1) : text;
}

/// The data of a STEP file, its line breaks left out and its numbers with a point rounded.
std::string rounded_step(const std::string& content) {
  const auto begin = content.find("\nDATA;");
  if (begin == std::string::npos) throw std::logic_error("a STEP file without data");
  std::string data = content.substr(begin), result;
  std::erase_if(data, [](char c) { return c == '\n' || c == '\r'; });
  const char *at = data.data(), *const end = at + data.size();
  while (at < end) {
    if (!begins_number(result, at, end)) {
      result += *at++;
      continue;
    }
    double value = 0;
    const char* rest = std::from_chars(at, end, value).ptr;
    const std::string_view digits(at, rest);
    result += digits.find('.') == std::string_view::npos ? std::string(digits) : six_digits(value);
    at = rest;
  }
  return result;
}

}  // namespace

std::string suite_digest(const SuiteModel& model, const std::string& content) {
  return sha256(model.family == SuiteFamily::kCad ? rounded_step(content) : content);
}

}  // namespace delquad
