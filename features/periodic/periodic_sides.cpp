// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/periodic/paired_lines.h"

#include <fmt/format.h>

#include <cassert>
#include <utility>

#include "base/nearest_name.h"
#include "delquad/error.h"
#include "features/periodic/periodic.h"
#include "features/sizes/named_parts.h"

namespace delquad {
namespace {

/// The parts that a name stands for.
struct NamedSide {
  std::string name;
  std::vector<int> faces, curves;
};

NamedSide named_side(const Mesh& fine, const PeriodicPair& pair, const std::string& name) {
  NamedSide side{name, entities_named(fine.regions, "region", name),
                 entities_named(fine.curves, "curve", name)};
  if (!side.faces.empty() || !side.curves.empty()) return side;
  std::vector<std::string> known;
  for (const auto* entities : {&fine.regions, &fine.curves})
    for (const Entity& e : *entities) known.insert(known.end(), e.names.begin(), e.names.end());
  throw InputError(fmt::format("{}: no curve and no face is called '{}'{} [unknown-name]", pair.where, name,
                               suggestion_or_all(name, known)));
}

void warn_of_both(const PeriodicPair& pair, const NamedSide& side, std::vector<Warning>& warnings) {
  if (!side.faces.empty() && !side.curves.empty())
    warnings.push_back({"names of periodic sides that faces and curves have", 0,
                        fmt::format("{}: '{}' is the name of faces and of curves: the faces are paired",
                                    pair.where, side.name)});
}

void check_faces_once(const Mesh& fine, const FacePair& pair, const std::vector<FacePair>& known) {
  for (const FacePair& other : known)
    for (const int face : {pair.face, pair.master})
      if (face == other.face || face == other.master)
        throw InputError(fmt::format(
            "{}: face {} is in two pairs of periodic sides, with '{}' and '{}', and with '{}' and '{}': "
            "expected one pair",
            pair.of.where, fine.regions[face].tag, other.of.from, other.of.to, pair.of.from, pair.of.to));
}

}  // namespace

PeriodicSides find_periodic_sides(const SurfaceModel& model, const std::vector<PeriodicPair>& asked,
                                  std::vector<Warning>& warnings) {
  const Mesh& fine = model.fine;
  PeriodicSides sides;
  for (const PeriodicPair& pair : asked) {
    if (pair.from == pair.to)
      throw InputError(fmt::format("{}: '{}' is 'from' and 'to': expected two sides", pair.where, pair.from));
    const NamedSide from = named_side(fine, pair, pair.from), to = named_side(fine, pair, pair.to);
    if (!from.faces.empty() && !to.faces.empty()) {
      for (const NamedSide* side : {&from, &to}) warn_of_both(pair, *side, warnings);
      for (const int face : from.faces)
        if (std::ranges::count(to.faces, face) > 0)
          throw InputError(fmt::format("{}: face {} is one of '{}' and one of '{}': expected two sides",
                                       pair.where, fine.regions[face].tag, pair.from, pair.to));
      for (FacePair& found : pair_faces(model, from.faces, to.faces, pair)) {
        check_faces_once(fine, found, sides.faces);
        sides.faces.push_back(std::move(found));
      }
      continue;
    }
    if (from.curves.empty() || to.curves.empty()) {
      const NamedSide& face = from.curves.empty() ? from : to;
      const NamedSide& curve = from.curves.empty() ? to : from;
      throw InputError(fmt::format("{}: '{}' is a face and '{}' a curve: expected two faces, or two curves",
                                   pair.where, face.name, curve.name));
    }
    sides.curves.push_back(pair);
  }
  return sides;
}

namespace {

class FaceCopy {
 public:
  FaceCopy(PeriodicFaces& pair, Mesh& mesh) : pair_(pair), mesh_(mesh), image_(mesh.points.size(), -1) {
    for (const auto& [node, of] : pair.nodes) image_[of] = node;
  }

  template <std::size_t N>
  void add(std::vector<std::array<int, N>>& elements, std::vector<int>& regions) {
    const std::size_t n = elements.size();
    for (std::size_t e = 0; e < n; ++e) {
      if (regions[e] != pair_.master) continue;
      std::array<int, N> element = elements[e];
      for (int& v : element) v = image(v);
      if (pair_.is_reversed) std::reverse(element.begin() + 1, element.end());
      elements.push_back(element);
      regions.push_back(pair_.face);
    }
  }

 private:
  int image(int v) {
    if (image_[v] < 0) {
      image_[v] = static_cast<int>(mesh_.points.size());
      mesh_.points.push_back(pair_.motion(mesh_.points[v]));
      pair_.nodes.push_back({image_[v], v});
    }
    return image_[v];
  }

  PeriodicFaces& pair_;
  Mesh& mesh_;
  std::vector<int> image_;
};

}  // namespace

void add_face_images(const std::vector<char>& left_out, Mesh& mesh) {
  assert(left_out.size() == mesh.regions.size());
  std::erase_if(mesh.periodic_faces, [&](const PeriodicFaces& pair) { return left_out[pair.face] != 0; });
  for (PeriodicFaces& pair : mesh.periodic_faces) {
    FaceCopy copy(pair, mesh);
    copy.add(mesh.triangles, mesh.triangle_region);
    copy.add(mesh.quads, mesh.quad_region);
  }
}

}  // namespace delquad
