#include "sweep/digest.h"

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cerrno>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "delquad/error.h"

namespace delquad {

std::string digest(std::string_view bytes) {
  const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
  return to_string(generate(bytes.data(), bytes.size()));
}

std::string file_digest(const std::filesystem::path& file) {
  using Stamp = std::pair<std::filesystem::file_time_type, std::uintmax_t>;
  static std::map<std::filesystem::path, std::pair<Stamp, std::string>> known;
  std::error_code unknown;
  const Stamp stamp = {std::filesystem::last_write_time(file, unknown),
                       std::filesystem::file_size(file, unknown)};
  if (const auto at = known.find(file); at != known.end() && at->second.first == stamp)
    return at->second.second;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  if (!in) throw InputError(file.string() + ": cannot be read: " + std::generic_category().message(errno));
  return (known[file] = {stamp, digest(bytes.view())}).second;
}

}  // namespace delquad
