#pragma once

#include <filesystem>
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

/// What the readers of text files of points and faces share.
class FaceReader {
 protected:
  FaceReader(const std::filesystem::path& path, const char* kind);
  /// One more coordinate of the point on this line.
  double coordinate();
  /// Adds a face of these vertices to the mesh.
  void add_face(const std::vector<int>& corners, int region) {
    splitter_.add_face(corners, region, mesh_, in_);
  }
  /// The mesh without points that nothing uses.
  Mesh finished(ReadNotes* notes);

  TextScanner in_;
  Mesh mesh_;

 private:
  FaceSplitter splitter_;
};

}  // namespace delquad
