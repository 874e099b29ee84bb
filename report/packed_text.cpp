#include "report/packed_text.h"

#include <zlib.h>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <new>
#include <vector>

namespace delquad {

std::string packed_text(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<unsigned char> packed(size);
  const auto* begin = reinterpret_cast<const unsigned char*>(bytes.data());
  if (compress2(packed.data(), &size, begin, bytes.size(), Z_BEST_COMPRESSION) != Z_OK)
    throw std::bad_alloc();  // its only reason, given room enough
  packed.resize(size);
  const std::size_t missing = (3 - size % 3) % 3;
  packed.insert(packed.end(), missing, 0);
  using namespace boost::archive::iterators;
  using Digits = base64_from_binary<transform_width<const unsigned char*, 6, 8>>;
  std::string text(Digits(packed.data()), Digits(packed.data() + packed.size()));
  text.replace(text.size() - missing, missing, missing, '=');
  return text;
}

}  // namespace delquad
