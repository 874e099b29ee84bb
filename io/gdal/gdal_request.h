#pragma once

#include <cstddef>
#include <string>
#include <vector>

// What the process that loads GDAL is asked for, and the kinds of its replies.

namespace delquad {

/// File, layer, projection. The reply: kDegrees or another character, the coordinate system, a zero, GeoJSON.
constexpr char kAskOutlines = 'O';
constexpr char kDegrees = 'd';
/// File, coordinate system. The reply: a RasterGrid, values as float.
constexpr char kAskRaster = 'R';

inline std::string gdal_request(char kind, const std::vector<std::string>& texts) {
  std::string request(1, kind);
  for (const std::string& text : texts) request += text + '\0';
  return request;
}

inline std::vector<std::string> texts_of(const std::string& request) {
  std::vector<std::string> texts;
  for (std::size_t at = 1, end = 0; at < request.size(); at = end + 1) {
    end = request.find('\0', at);
    texts.push_back(request.substr(at, end - at));
  }
  return texts;
}

}  // namespace delquad
