#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/surface/surface_model.h"

namespace delquad {

/// A curve as it lies between faces.
struct CurveReport {
  double length = 0;
  bool closed = false;
  std::vector<int> faces;  ///< that it bounds, ascending indices; one that lies on both sides stands twice
};

/// Where two curves of a face's boundary meet at a corner.
struct CornerReport {
  int face = -1;
  std::array<int, 2> curves{};  ///< that run into the corner and out of it, the face on their left
  Vec3 at;
  double angle = 0;  ///< inside the face, degrees
};

struct FaceReport {
  double area = 0;
  int pieces = 0;  ///< that lines divide it into
  int loops = 0;   ///< of its boundary
  int handles = 0;
  std::vector<int> curves;  ///< ascending
  /// How narrow the face is: the least distance between boundary sides that look at each other, or four times
  /// its area by its perimeter (a circle's diameter) where that is less, least of all pieces. Curves that
  /// meet at less than 60 degrees count as a corner, not as a narrow place. Infinite without boundary.
  double width = 0;
};

/// Faces that hang together along curves.
struct ShellReport {
  std::vector<int> faces;  ///< ascending
  double area = 0;
  int euler_characteristic = 0;  ///< vertices - edges + triangles
  bool closed = false;           ///< no side has less than two triangles
};

/// What a surface model consists of, measured on its fine triangulation. Indices are those of fine.curves and
/// fine.regions.
struct ModelReport {
  Vec3 low, high;
  double diagonal = 0, area = 0;
  double free_length = 0;  ///< of the curves that bound one face only, once
  int vertices = 0;        ///< corners
  std::vector<CurveReport> curves;
  std::vector<FaceReport> faces;
  std::vector<ShellReport> shells;    ///< by their first face
  std::vector<CornerReport> corners;  ///< by face, in the order of its loops
};

/// Throws InputError as extract_charts() does.
ModelReport report_model(const SurfaceModel& model);

/// "disk", "annulus", "disk with 3 holes", "closed", "2 handles, 1 loop": what a map of the face has to cope
/// with.
std::string topology(const FaceReport& face);

}  // namespace delquad
