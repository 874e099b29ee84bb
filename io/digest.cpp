// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/digest.h"

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <system_error>
#include <utility>

#include "base/text.h"

namespace delquad {

std::string digest(std::string_view bytes) {
  const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
  return to_string(generate(bytes.data(), bytes.size()));
}

namespace {

constexpr std::string_view kOpening = "{\n", kSealBegin = "{\n  \"digest\": \"", kSealEnd = "\",\n";
constexpr std::size_t kDigestLength = 36;

}  // namespace

FileMark mark_of(const std::filesystem::path& file) {
  const std::string bytes = file_bytes(file);
  return {bytes.size(), digest(bytes)};
}

std::map<std::string, FileMark> marks_of(const std::filesystem::path& folder) {
  std::map<std::string, FileMark> marks;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      marks[entry.path().lexically_relative(folder).generic_string()] = mark_of(entry.path());
  return marks;
}

std::string difference(const std::filesystem::path& file, const FileMark& mark) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown)) return "is missing";
  const FileMark now = mark_of(file);
  if (now.bytes != mark.bytes)
    return "holds " + std::to_string(now.bytes) + " bytes, expected " + std::to_string(mark.bytes);
  return now == mark ? "" : "was changed: its digest is " + now.digest + ", expected " + mark.digest;
}

std::string sealed(const std::string& object) {
  return std::string(kSealBegin) + digest(object) + std::string(kSealEnd) + object.substr(kOpening.size());
}

bool is_sealed(std::string_view text) {
  const std::size_t head = kSealBegin.size() + kDigestLength + kSealEnd.size();
  if (text.size() <= head || !text.starts_with(kSealBegin) ||
      text.substr(head - kSealEnd.size(), kSealEnd.size()) != kSealEnd)
    return false;
  return text.substr(kSealBegin.size(), kDigestLength) ==
         digest(std::string(kOpening) + std::string(text.substr(head)));
}

std::string file_digest(const std::filesystem::path& file) {
  using Stamp = std::pair<std::filesystem::file_time_type, std::uintmax_t>;
  static std::map<std::filesystem::path, std::pair<Stamp, std::string>> known;
  std::error_code unknown;
  const Stamp stamp = {std::filesystem::last_write_time(file, unknown),
                       std::filesystem::file_size(file, unknown)};
  if (const auto at = known.find(file); at != known.end() && at->second.first == stamp)
    return at->second.second;
  return (known[file] = {stamp, mark_of(file).digest}).second;
}

}  // namespace delquad
