#pragma once

#include <array>
#include <string>
#include <vector>

#include "delquad/metrics.h"

namespace delquad {

/// What a size (length) is too coarse for, as indices.
struct SmallFeatures {
  std::vector<int> curves;  ///< shorter than the size
  std::vector<int> faces;   ///< narrower, see FaceReport::width
};
SmallFeatures smaller_than(const ModelReport& report, double size);

/// Corners below 30 degrees, the sharpest first. A quad in a corner of angle a has at best an eta of a / 90.
std::vector<CornerReport> sharp_corners(const ModelReport& report);

/// The bounding box of each face: its lowest and highest corner.
std::vector<std::array<Vec3, 2>> boxes_of_faces(const Mesh& mesh);

/// The report as JSON; `size` 0: not given.
std::string info_record(const ModelInfo& info, double size);

}  // namespace delquad
