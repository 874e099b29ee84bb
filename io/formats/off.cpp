// SPDX-License-Identifier: GPL-3.0-or-later

#include <bit>
#include <climits>
#include <cstdint>
#include <utility>

#include "io/cell_view.h"
#include "io/face_reader.h"
#include "io/mesh_formats.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"
#include "io/text_writer.h"

namespace delquad {

namespace {

class OffReader : FaceReader {
 public:
  OffReader(const std::filesystem::path& path, Strays strays) : FaceReader(path, "OFF", strays) {}

  Mesh read(ReadNotes* notes) {
    if (read_header()) return read_bytes(notes);
    const long long n_points = integer("the number of vertices", 0, INT_MAX);
    const long long n_faces = integer("the number of faces", 0, INT_MAX);
    integer("the number of edges", 0, LLONG_MAX);
    constexpr long long kLeastPoint = 6,
                        kLeastFace = 8;  // bytes of "0 0 0" and "3 0 0 0" with their line ends
    if (n_points * kLeastPoint + n_faces * kLeastFace > static_cast<long long>(in_.bytes_left()) + 1) {
      in_.fail("{} vertices and {} faces do not fit in the {} bytes that follow", n_points, n_faces,
               in_.bytes_left());
    }
    for (long long i = 0; i < n_points; ++i) read_point();
    for (long long i = 0; i < n_faces; ++i) {
      in_.skip_comments();
      if (in_.at_end())
        in_.fail("the header announces {} vertices and {} faces, but {} faces follow the vertices", n_points,
                 n_faces, i);
      read_face();
    }
    in_.skip_comments();
    if (!in_.at_end()) {
      const std::string_view found = in_.token("the end");
      in_.fail("expected the end of the file after {} vertices and {} faces, as the header says, found {}",
               n_points, n_faces, TextScanner::printable(found));
    }
    return whole(notes);
  }

 private:
  Mesh whole(ReadNotes* notes) {
    if (mesh_.triangles.empty() && mesh_.quads.empty()) in_.fail("the file holds no faces");
    mesh_.regions = {{1, {}}};
    return finished(notes);
  }

  /// Vertices may have texture coordinates, colors and normals (ST, C, N); these follow the three
  /// coordinates. True where all that follows are bytes.
  bool read_header() {
    in_.skip_comments();
    const std::string_view word = in_.token("'OFF'");
    const bool known = word == "OFF" || word == "COFF" || word == "NOFF" || word == "CNOFF" ||
                       word == "STOFF" || word == "STCOFF" || word == "STNOFF" || word == "STCNOFF";
    if (!known) {
      in_.fail("expected 'OFF' (points of three coordinates), found {}", TextScanner::printable(word));
    }
    for (const auto& [letter, numbers] : {std::pair{"ST", 2}, {"C", 4}, {"N", 3}})
      if (word.find(letter) < word.find("OFF")) numbers_beside_ += numbers;
    if (!in_.next_is('B')) return false;
    if (in_.token("'BINARY'") != "BINARY" || !in_.skip_past("\n"))
      in_.fail("expected 'BINARY' and a line's end");
    return true;
  }

  std::uint32_t word32(std::string_view what) {
    std::uint32_t value = 0;
    for (const char byte : in_.bytes(4, what)) value = value << 8 | static_cast<unsigned char>(byte);
    return is_little_ ? swapped(value) : value;
  }

  static std::uint32_t swapped(std::uint32_t value) {
    return value << 24 | (value & 0xff00) << 8 | (value >> 8 & 0xff00) | value >> 24;
  }

  /// A number of things that take at least so many bytes each.
  std::uint32_t count(std::string_view what, std::size_t bytes_each) {
    std::uint32_t n = word32(what);
    const std::size_t most = in_.bytes_left() / bytes_each;
    if (mesh_.points.empty() && n > most && swapped(n) <= most) is_little_ = true, n = swapped(n);
    if (n > most) in_.fail("{}: {} do not fit in the {} bytes that follow", what, n, in_.bytes_left());
    return n;
  }

  double real32() {
    const float value = std::bit_cast<float>(word32("a coordinate"));
    return in_.finite(double{value}, strays_);
  }

  /// Big-endian words of four bytes, as Geomview writes them: each face ends with how many parts its color
  /// has, and these. PMP writes little-endian words and no colors.
  Mesh read_bytes(ReadNotes* notes) {
    const std::size_t beside = 4 * static_cast<std::size_t>(numbers_beside_);
    const std::uint32_t n_points = count("the number of vertices", 12 + beside);
    const std::uint32_t n_faces = count("the number of faces", 8);
    word32("the number of edges");
    for (std::uint32_t i = 0; i < n_points; ++i) {
      const double x = real32(), y = real32(), z = real32();
      add_point({x, y, z});
      in_.bytes(beside, "colors or normals");
    }
    for (std::uint32_t i = 0; i < n_faces; ++i) {
      std::vector<int> v(count("the number of a face's vertices", 4));
      for (int& vertex : v) {
        const std::uint32_t index = word32("a vertex");
        if (index >= n_points) in_.fail("expected a vertex below {}, found {}", n_points, index);
        vertex = static_cast<int>(index);
      }
      add_face(v, 0);
      if (!is_little_) in_.bytes(4 * std::size_t{count("the number of a color's parts", 4)}, "a color");
    }
    if (in_.bytes_left() > 0)
      in_.fail("{} bytes follow the {} vertices and {} faces that the header announces", in_.bytes_left(),
               n_points, n_faces);
    return whole(notes);
  }

  long long integer(std::string_view what, long long low, long long high) {
    in_.skip_comments();
    return in_.integer(what, low, high);
  }

  void read_point() {
    in_.skip_comments();
    const double x = in_.real("a coordinate", strays_), y = coordinate(), z = coordinate();
    add_point({x, y, z});
    in_.rest_of_line();  // colors, normals
  }

  void read_face() {
    const long long n = in_.integer("the number of a face's vertices", 0, INT_MAX);
    const long long last = static_cast<long long>(mesh_.points.size()) - 1;
    if (n < 3)
      in_.fail(
          "face of {} vertices: expected three or more; is the number of vertices in the header "
          "right ({})?",
          n, last + 1);
    std::vector<int> v;
    for (long long k = 0; k < n; ++k) v.push_back(static_cast<int>(in_.integer("a vertex", 0, last)));
    add_face(v, 0);
    in_.rest_of_line();  // colors
  }

  int numbers_beside_ = 0;  ///< of each vertex, beside its coordinates
  bool is_little_ = false;  ///< words are little-endian
};

/// Reads Object File Format, text or binary, with or without colors and normals, which are ignored. Faces of
/// more than four vertices are split into triangles.
Mesh read_off(const std::filesystem::path& path, ReadNotes* notes, Strays strays) {
  return OffReader(path, strays).read(notes);
}

void write_off(const std::filesystem::path& path, const Mesh& mesh) {
  write_text_file(path, [&](TextWriter& out) {
    out << "OFF\n" << mesh.points.size() << ' ' << mesh.triangles.size() + mesh.quads.size() << " 0\n";
    write_points_and_faces(out, mesh);
  });
}

}  // namespace

MeshFormat off_format() {
  return {.extensions = {".off"},
          .description = "Object File Format",
          .read = read_off,
          .write = write_by<write_off>,
          .names = 0};
}

}  // namespace delquad
