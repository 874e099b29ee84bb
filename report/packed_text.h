#pragma once

#include <string>
#include <string_view>

namespace delquad {

/// Base64 of the zlib-compressed bytes, as `inflate` of page/packed_mesh.js takes it apart.
std::string packed_text(std::string_view bytes);

}  // namespace delquad
