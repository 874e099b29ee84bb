#include "metrics/surface/near_cuts.h"

#include <algorithm>
#include <array>

#include "metrics/shape.h"

namespace delquad {
namespace {

/// Quads with a vertex less than this many quads away from a cut lie near it.
constexpr int kRings = 3;

enum class Where : char { kOff, kNear, kOnCurve };

void put(const Mesh& mesh, const std::vector<char>& is_cut, bool cuts, Where here,
         std::vector<Where>& where) {
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if ((is_cut[mesh.line_curve[l]] != 0) == cuts)
      for (const int v : mesh.lines[l]) where[v] = here;
}

/// Of each vertex.
std::vector<Where> places(const Mesh& mesh, const std::vector<char>& is_cut) {
  std::vector<Where> where(mesh.points.size(), Where::kOff);
  put(mesh, is_cut, true, Where::kNear, where);
  for (int ring = 1; ring < kRings; ++ring) {
    const std::vector<Where> before = where;
    for (const auto& quad : mesh.quads)
      if (std::ranges::any_of(quad, [&](int v) { return before[v] == Where::kNear; }))
        for (const int v : quad) where[v] = Where::kNear;
  }
  put(mesh, is_cut, false, Where::kOnCurve, where);
  return where;
}

}  // namespace

void measure_near_cuts(const Mesh& mesh, const std::vector<char>& is_cut, QuadShare& near, QuadShare& off) {
  if (std::ranges::find(is_cut, 1) == is_cut.end()) return;
  const std::vector<Where> where = places(mesh, is_cut);
  std::vector<int> valence(mesh.points.size(), 0);
  for (const auto& quad : mesh.quads) {
    for (const int v : quad) ++valence[v];
    const bool is_near = std::ranges::any_of(quad, [&](int v) { return where[v] == Where::kNear; });
    QuadShare& share = is_near ? near : off;
    const std::array<Vec3, 4> corners = corners_of(mesh, quad);
    share.eta += std::max(0.0, eta_of(element_shape(corners, area_vector(corners)).angle));
    ++share.quads;
  }
  for (std::size_t v = 0; v < where.size(); ++v) {
    if (where[v] == Where::kOnCurve || valence[v] == 0) continue;
    QuadShare& share = where[v] == Where::kNear ? near : off;
    share.d4 += valence[v] == 4 ? 100 : 0;
    ++share.vertices;
  }
  for (QuadShare* share : {&near, &off}) {
    share->eta /= std::max(1, share->quads);
    share->d4 /= std::max(1, share->vertices);
  }
}

}  // namespace delquad
