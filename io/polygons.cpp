#include "io/polygons.h"

#include <fmt/format.h>

#include "io/mesh_io.h"
#include "mesh/drop_unused_points.h"
#include "mesh/split_polygon.h"

namespace delquad {

void FaceSplitter::add_face(const std::vector<int>& corners, int region, Mesh& mesh, const TextScanner& in) {
  const size_t n = corners.size();
  if (n < 3) in.fail(fmt::format("face of {} vertices: expected three or more", n));
  if (n == 4) {
    mesh.quads.push_back({corners[0], corners[1], corners[2], corners[3]});
    mesh.quad_region.push_back(region);
    return;
  }
  std::vector<std::array<int, 3>> triangles = {{0, 1, 2}};
  if (n > 4) {
    std::vector<Vec3> points;
    for (const int v : corners) points.push_back(mesh.points[v]);
    auto parts = split_polygon(points);
    if (!parts)
      in.fail(
          fmt::format("face of {} vertices: expected a polygon that does not cross itself, to split it "
                      "into triangles",
                      n));
    triangles = std::move(*parts);
    ++n_polygons_;
    n_triangles_ += static_cast<long long>(triangles.size());
  }
  for (const auto& t : triangles) mesh.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  mesh.triangle_region.insert(mesh.triangle_region.end(), triangles.size(), region);
}

void FaceSplitter::note(ReadNotes* notes) const {
  if (!notes || n_polygons_ == 0) return;
  notes->push_back(fmt::format("{} of more than four vertices {} split into {} triangles",
                               n_polygons_ == 1 ? "1 face" : fmt::format("{} faces", n_polygons_),
                               n_polygons_ == 1 ? "was" : "were", n_triangles_));
}

FaceReader::FaceReader(const std::filesystem::path& path, const char* kind) : in_(path) {
  refuse_other_kinds(in_, kind);
}

double FaceReader::coordinate() {
  if (in_.at_end_of_line()) in_.fail("expected three coordinates");
  return in_.real("a coordinate");
}

Mesh FaceReader::finished(ReadNotes* notes) {
  splitter_.note(notes);
  drop_unused_points(mesh_);
  return std::move(mesh_);
}

}  // namespace delquad
