#include <fmt/format.h>

#include <climits>

#include "io/mesh_io.h"
#include "io/polygons.h"
#include "io/text_scanner.h"

namespace delquad {

namespace {

class OffReader : FaceReader {
 public:
  explicit OffReader(const std::filesystem::path& path) : FaceReader(path, "OFF") {}

  Mesh read(ReadNotes* notes) {
    read_header();
    const long long n_points = integer("the number of vertices", 0, INT_MAX);
    const long long n_faces = integer("the number of faces", 0, INT_MAX);
    integer("the number of edges", 0, LLONG_MAX);
    constexpr long long kLeastPoint = 6,
                        kLeastFace = 8;  // bytes of "0 0 0" and "3 0 0 0" with their line ends
    if (n_points * kLeastPoint + n_faces * kLeastFace > static_cast<long long>(in_.bytes_left()) + 1) {
      in_.fail(fmt::format("{} vertices and {} faces do not fit in the {} bytes that follow", n_points,
                           n_faces, in_.bytes_left()));
    }
    for (long long i = 0; i < n_points; ++i) read_point();
    for (long long i = 0; i < n_faces; ++i) read_face();
    skip_comments();
    if (!in_.at_end()) {
      const std::string_view found = in_.token("the end");
      in_.fail(fmt::format("expected the end of the file after {} faces, found {}", n_faces,
                           TextScanner::printable(found)));
    }
    if (mesh_.triangles.empty() && mesh_.quads.empty()) in_.fail("the file holds no faces");
    mesh_.regions = {{1, {}}};
    return finished(notes);
  }

 private:
  /// Vertices may have texture coordinates, colours and normals (ST, C, N); these follow the three
  /// coordinates.
  void read_header() {
    skip_comments();
    const std::string_view word = in_.token("'OFF'");
    const bool known = word == "OFF" || word == "COFF" || word == "NOFF" || word == "CNOFF" ||
                       word == "STOFF" || word == "STCOFF" || word == "STNOFF" || word == "STCNOFF";
    if (!known) {
      in_.fail(fmt::format("expected 'OFF' (points of three coordinates), found {}",
                           TextScanner::printable(word)));
    }
    if (in_.next_is('B')) in_.fail("binary OFF file: expected text");
  }

  void skip_comments() {
    while (in_.next_is('#')) in_.rest_of_line();
  }

  long long integer(std::string_view what, long long low, long long high) {
    skip_comments();
    return in_.integer(what, low, high);
  }

  void read_point() {
    skip_comments();
    const double x = in_.real("a coordinate"), y = coordinate(), z = coordinate();
    mesh_.points.push_back({x, y, z});
    in_.rest_of_line();  // colours, normals
  }

  void read_face() {
    const long long n = integer("the number of a face's vertices", 0, INT_MAX);
    const long long last = static_cast<long long>(mesh_.points.size()) - 1;
    std::vector<int> v;
    for (long long k = 0; k < n; ++k) v.push_back(static_cast<int>(in_.integer("a vertex", 0, last)));
    add_face(v, 0);
    in_.rest_of_line();  // colours
  }
};

}  // namespace

Mesh read_off(const std::filesystem::path& path, ReadNotes* notes) { return OffReader(path).read(notes); }

}  // namespace delquad
