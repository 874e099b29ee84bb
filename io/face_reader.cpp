// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/face_reader.h"

#include <fmt/format.h>

#include <set>

#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/drop_unused_points.h"
#include "geometry/mesh/split_polygon.h"
#include "geometry/mesh/stray_points.h"
#include "io/mesh_io.h"

namespace delquad {

void FaceReader::add_face(const std::vector<int>& corners, int region) {
  const size_t n = corners.size();
  if (n < 3) in_.fail("face of {} vertices: expected three or more", n);
  if (n == 4) {
    mesh_.quads.push_back({corners[0], corners[1], corners[2], corners[3]});
    mesh_.quad_region.push_back(region);
    return;
  }
  std::vector<std::array<int, 3>> triangles = {{0, 1, 2}};
  if (n > 4) {
    std::vector<Vec3> points;
    for (const int v : corners) points.push_back(mesh_.points[v]);
    auto parts = split_polygon(points);
    if (!parts && std::set<int>(corners.begin(), corners.end()).size() < n)
      in_.fail("face of {} vertices: expected each vertex once, to split it into triangles", n);
    for (int k = 2; !parts && k + 1 < static_cast<int>(n); ++k) triangles.push_back({0, k, k + 1});
    if (parts)
      triangles = std::move(*parts);
    else
      ++n_odd_;
    ++n_polygons_;
    n_triangles_ += static_cast<long long>(triangles.size());
  }
  for (const auto& t : triangles) mesh_.triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
  mesh_.triangle_region.insert(mesh_.triangle_region.end(), triangles.size(), region);
}

std::vector<Entity>& entities_of(Mesh& mesh, int dim) {
  return dim == 1 ? mesh.curves : dim == 2 ? mesh.regions : mesh.volumes;
}

std::string add_element(Mesh& mesh, CellShape shape, std::span<const int> nodes, int entity,
                        std::vector<int> (*places)(int order)) {
  if (dimension_of(shape) == 3) {
    for_each_shape(mesh, [&](const SolidShape& solid, auto& cells, std::vector<int>& volumes) {
      if (solid.shape != shape) return;
      std::copy_n(nodes.begin(), solid.n_corners, cells.emplace_back().begin());
      volumes.push_back(entity);
    });
    return "";
  }
  const int order = shape == CellShape::kLine       ? order_of_line(nodes.size())
                    : shape == CellShape::kTriangle ? 1
                                                    : order_of_quad(nodes.size());
  if (!takes_order(mesh, order)) return other_order(order, mesh.order);
  if (shape == CellShape::kLine) {
    add_line(mesh, nodes, entity);
  } else if (shape == CellShape::kTriangle) {
    mesh.triangles.push_back({nodes[0], nodes[1], nodes[2]});
    mesh.triangle_region.push_back(entity);
  } else if (order == 1) {
    mesh.quads.push_back({nodes[0], nodes[1], nodes[2], nodes[3]});
    mesh.quad_region.push_back(entity);
  } else {
    add_quad(mesh, nodes, places(order), entity);
  }
  return "";
}

void NamedPoints::add(Mesh& mesh, int point, const std::string& name) {
  const auto [at, is_new] = index_.emplace(point, mesh.named_points.size());
  if (is_new) mesh.named_points.push_back({point, {static_cast<int>(at->second) + 1, {}}});
  mesh.named_points[at->second].entity.names.push_back(name);
}

void check_strays(const Mesh& mesh, Strays strays, const std::function<std::string(int)>& place) {
  if (strays == Strays::kKept) return;
  if (const auto found = stray_points(mesh); !found.empty())
    throw InputError(place(found[0].point) + ": " + describe(found[0], mesh));
}

FaceReader::FaceReader(const std::filesystem::path& path, const char* kind, Strays strays)
    : in_(path), strays_(strays) {
  refuse_other_kinds(in_, kind);
}

void FaceReader::add_point(const Vec3& p) {
  mesh_.points.push_back(p);
  places_.push_back(in_.position());
}

double FaceReader::coordinate() {
  if (in_.at_end_of_line()) in_.fail("expected three coordinates");
  return in_.real("a coordinate", strays_);
}

Mesh FaceReader::finished(ReadNotes* notes) {
  if (notes && n_polygons_ > 0)
    notes->push_back(fmt::format(
        "{} of more than four vertices {} split into {} triangles{}", counted(n_polygons_, "face"),
        n_polygons_ == 1 ? "was" : "were", n_triangles_,
        n_odd_ == 0 ? ""
                    : fmt::format("; from the first vertex where they cross themselves or have no area ({})",
                                  n_odd_)));
  check_strays(mesh_, strays_, [&](int i) { return in_.place(places_[static_cast<size_t>(i)]); });
  drop_unused_points(mesh_);
  return std::move(mesh_);
}

std::string colour_text(const std::array<int, 3>& rgb) {
  return fmt::format("{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

void FaceColours::finish(Mesh& mesh, ReadNotes* notes) const {
  std::set<std::string> colours;
  for (const auto& [key, at] : index_) colours.insert(key.second);
  if (colours.size() <= kMost) {
    mesh.regions = regions_;
    return;
  }
  FaceColours plain;
  std::vector<int> part(regions_.size());
  for (const auto& [key, at] : index_) part[at] = plain.region(key.first, "");
  for (auto* regions : {&mesh.triangle_region, &mesh.quad_region})
    for (int& region : *regions) region = part[region];
  mesh.regions = plain.regions_;
  if (notes)
    notes->push_back(fmt::format("the faces' {} colors are left out: up to {} would become regions",
                                 colours.size(), kMost));
}

}  // namespace delquad
