#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "io/text_scanner.h"

namespace delquad {

/// Adds faces to a mesh as triangles and quads.
class FaceSplitter {
 public:
  /// Throws InputError with the scanner's line for faces that cannot be split.
  void add_face(const std::vector<int>& corners, int region, Mesh& mesh, const TextScanner& in);
  /// Says how many were split, if any.
  void note(ReadNotes* notes) const;

 private:
  long long n_polygons_ = 0, n_triangles_ = 0;
};

/// Throws InputError for the first stray point of a mesh, unless they are kept. `place`: where the file has a
/// point.
void check_strays(const Mesh& mesh, Strays strays, const std::function<std::string(int)>& place);

/// What the readers of text files of points and faces share.
class FaceReader {
 protected:
  FaceReader(const std::filesystem::path& path, const char* kind, Strays strays);
  /// One more coordinate of the point on this line.
  double coordinate();
  /// A point that was read just now.
  void add_point(const Vec3& p);
  /// Adds a face of these vertices to the mesh.
  void add_face(const std::vector<int>& corners, int region) {
    splitter_.add_face(corners, region, mesh_, in_);
  }
  /// The mesh without points that nothing uses.
  Mesh finished(ReadNotes* notes);

  TextScanner in_;
  Mesh mesh_;
  Strays strays_;

 private:
  std::vector<size_t> places_;  ///< of the points in the file
  FaceSplitter splitter_;
};

}  // namespace delquad
