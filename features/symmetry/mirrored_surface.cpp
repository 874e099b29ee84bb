// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/mirrored_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "delquad/error.h"
#include "features/embedded/imprint.h"
#include "features/symmetry/symmetry_planes.h"
#include "geometry/mesh/entity_names.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/model_kind.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {
namespace {

/// Seams without an image, which are only where a surface was cut open, go.
void drop_loose_seams(SurfaceModel& model, const std::vector<MirrorMatch>& matches) {
  Mesh& mesh = model.fine;
  keep_lines(mesh, [&](std::size_t l) {
    return std::ranges::none_of(
        matches, [&](const MirrorMatch& m) { return m.is_loose_seam[mesh.line_curve[l]] != 0; });
  });
}

/// The divisions of a curve of the whole, as divisions of its pieces.
class DivisionSharing {
 public:
  explicit DivisionSharing(const CutSurface& surface)
      : surface_(surface),
        whole_lengths_(lengths_of_curves(surface.whole.fine)),
        part_lengths_(lengths_of_curves(surface.half.model.fine)),
        pieces_(surface.whole.fine.curves.size()) {
    for (std::size_t i = 0; i < surface.half.whole_curve.size(); ++i)
      if (const int c = surface.half.whole_curve[i]; c >= 0) pieces_[c].push_back(static_cast<int>(i));
  }

  void add(const CurveDivision& division) {
    const std::vector<int> named = entities_named(surface_.whole.fine.curves, "curve", division.name);
    for (const int c : named) {
      asked_.emplace(c, division);
      if (!pieces_[c].empty()) share(division, c);
    }
    if (named.empty()) result.push_back(division);
  }

  /// Curves behind a plane are divided as those before it.
  void check_images() const {
    for (const auto& [curve, division] : asked_) {
      if (!pieces_[curve].empty()) continue;
      const int image = image_of(curve);
      const auto other = asked_.find(image);
      if (other != asked_.end() && other->second.edges == division.edges &&
          other->second.progression == division.progression && other->second.bump == division.bump)
        continue;
      throw InputError(fmt::format("{}: {} is divided differently from {}, whose mirror image it is",
                                   division.where, title(curve), title(image)));
    }
  }

  std::vector<CurveDivision> result;

 private:
  std::string title(int curve) const { return curve_title(surface_.whole.fine.curves[curve]); }

  int image_of(int curve) const {
    std::vector<int> reached{curve};
    for (std::size_t i = 0; i < reached.size(); ++i) {
      if (!pieces_[reached[i]].empty()) return reached[i];
      for (const MirrorMatch& match : surface_.matches)
        for (const int other : match.curves[reached[i]])
          if (std::ranges::find(reached, other) == reached.end()) reached.push_back(other);
    }
    return curve;
  }

  /// Returns whether a curve of the part ends nearer to a plane than it begins.
  bool runs_to_plane(int curve) const {
    const Mesh& fine = surface_.half.model.fine;
    const std::vector<int> points = points_of_curves(fine)[curve];
    const auto distance = [&](int p) {
      double least = std::numeric_limits<double>::infinity();
      for (int k = 0; k < surface_.planes.count(); ++k)
        least = std::min(least, std::abs(surface_.planes.height(k, fine.points[p])));
      return least;
    };
    return distance(points.back()) < distance(points.front());
  }

  void share(const CurveDivision& division, int curve) {
    const std::vector<int>& pieces = pieces_[curve];
    double length = 0;
    for (const int p : pieces) length += part_lengths_[p];
    const int shares = static_cast<int>(std::lround(whole_lengths_[curve] / length));
    const int n_pieces = static_cast<int>(pieces.size()), least = shares * n_pieces;
    if (division.edges % shares != 0 || division.edges < least) {
      const int below = division.edges / shares * shares, above = below + shares;
      throw InputError(fmt::format(
          "{}: {} edges for {}, of which planes of symmetry make {} equal parts: expected {}", division.where,
          division.edges, title(curve), shares,
          below >= least ? fmt::format("{} or {}", below, above) : fmt::format("at least {}", least)));
    }
    const bool is_halved = least == 2 && n_pieces == 1;
    if (least > 1 && (division.progression != 1 || (division.bump != 1 && !is_halved)))
      throw InputError(fmt::format("{}: {} goes through a plane of symmetry: expected edges of equal length",
                                   division.where, title(curve)));
    int rest = division.edges / shares, left = n_pieces;
    double ahead = length;
    for (const int p : pieces) {
      CurveDivision own = division;
      own.name = fmt::format("curve_{}", surface_.half.model.fine.curves[p].tag);
      own.edges = left == 1 ? rest
                            : std::clamp(static_cast<int>(std::lround(rest * part_lengths_[p] / ahead)), 1,
                                         rest - left + 1);
      rest -= own.edges;
      ahead -= part_lengths_[p];
      --left;
      if (is_halved && division.bump != 1) {
        // Lengths of edges between an end and the middle have equal ratios.
        own.bump = 1;
        own.progression = std::pow(division.bump, (runs_to_plane(p) ? -2.0 : 2.0) / (division.edges - 1));
      }
      result.push_back(std::move(own));
    }
  }

  const CutSurface& surface_;
  std::vector<double> whole_lengths_, part_lengths_;
  std::vector<std::vector<int>> pieces_;
  std::map<int, CurveDivision> asked_;  // by curve of the whole
};

}  // namespace

std::optional<CutSurface> cut_at_planes(const MeshProblem& problem, SurfaceModel& model,
                                        std::shared_ptr<const SizeField>& size) {
  SymmetrySpec spec = problem.symmetry;
  if (!spec.automatic && spec.planes.empty()) return std::nullopt;
  if (!problem.periodic.empty())
    throw InputError(spec.where + ": symmetry does not go with periodic sides: expected one of these");
  const bool is_flat = kind_of(problem.model).in_plane;
  for (SymmetryPlane& p : spec.planes)
    if (is_flat) p.point.z = p.normal.z = 0;
  auto [given, matches] = find_symmetry_planes(spec, model, is_flat, model.warnings);
  if (given.empty()) return std::nullopt;
  const SymmetryPlanes planes(given);
  drop_loose_seams(model, matches);
  size = least_of_images(std::move(size), planes);
  SymmetricHalf half = cut_symmetric(model, planes, matches, *size, spec.where);
  if (half.model.fine.triangles.empty())
    throw InputError(
        spec.where +
        ": nothing of the model lies on the positive sides of the planes: expected opposite normals");
  return CutSurface{std::move(model), planes, std::move(matches), std::move(half)};
}

std::vector<CurveDivision> divisions_of_part(const std::vector<CurveDivision>& divisions,
                                             const CutSurface& surface) {
  DivisionSharing sharing(surface);
  for (const CurveDivision& division : divisions) sharing.add(division);
  sharing.check_images();
  return std::move(sharing.result);
}

std::vector<double> most_of_faces(std::vector<double> values, const CutSurface& surface) {
  for (const MirrorMatch& match : surface.matches) {
    const std::vector<double> own = values;
    for (std::size_t f = 0; f < own.size(); ++f) values[f] = std::max(own[f], own[match.face[f]]);
  }
  return values;
}

std::vector<double> most_of_curves(const std::vector<double>& values, const CutSurface& surface) {
  std::vector<double> most = values;
  for (const MirrorMatch& match : surface.matches) {
    const std::vector<double> own = most;
    for (std::size_t c = 0; c < own.size(); ++c)
      for (const int image : match.curves[c]) most[c] = std::max(most[c], own[image]);
  }
  std::vector<double> of_part;
  for (const int c : surface.half.whole_curve) of_part.push_back(c >= 0 ? most[c] : 0);
  return of_part;
}

namespace {

/// Returns the second lip of a crack that is open.
int second_lip(const SurfaceModel& model, int crack) {
  for (const auto& lips : model.lips)
    if (lips[0] == crack) return lips[1];
  return crack;
}

/// Opens the cracks of the whole, and tells the images of their lips. A crack on a plane has its other lip as
/// its image, so that the part and its image do not share its nodes.
void open_whole(CutSurface& cut) {
  const std::vector<EmbeddedCurve> embedded = cut.whole.embedded;
  std::vector<FlatPatch> none;
  open_cracks(cut.whole, none);
  for (MirrorMatch& match : cut.matches) {
    match.curves.resize(cut.whole.fine.curves.size());
    for (const auto& [crack, lip] : cut.whole.lips)
      for (const int image : match.curves[crack]) match.curves[lip].push_back(second_lip(cut.whole, image));
  }
  for (const EmbeddedCurve& e : embedded)
    for (std::size_t c = 0; e.is_crack && c < cut.half.whole_curve.size(); ++c) {
      if (cut.half.whole_curve[c] != e.curve) continue;
      int& planes = cut.half.curve_planes[c];
      for (std::size_t k = 0; k < cut.matches.size(); ++k) {
        if (!((planes & ~cut.half.face_planes[e.face]) >> k & 1)) continue;
        const int lip = second_lip(cut.whole, e.curve);
        cut.matches[k].curves[e.curve] = {lip};
        cut.matches[k].curves[lip] = {e.curve};
      }
      planes &= cut.half.face_planes[e.face];
    }
}

}  // namespace

void add_whole(CutSurface cut, SurfaceSetup& surface, MeshingSetup& p) {
  p.symmetry = cut.planes.all();
  open_whole(cut);
  for (auto* size : {&p.size.field, &p.size.asked, &p.size.curved})
    if (*size) *size = folded_size(*size, cut.planes);
  const int first_cut = static_cast<int>(cut.whole.fine.curves.size());
  MirroredSurface m{{std::move(cut.whole), {}},
                    first_cut,
                    cut.planes,
                    std::move(cut.matches),
                    std::move(cut.half.whole_curve),
                    std::move(cut.half.curve_planes),
                    std::move(cut.half.face_planes),
                    {}};
  // The images of each cut follow each other, by the bits of the planes.
  const int images = 1 << m.planes.count();
  int tag = 0;
  for (const Entity& e : m.whole.model.fine.curves) tag = std::max(tag, e.tag);
  for (std::size_t c = m.whole_curve.size(); c < surface.model.fine.curves.size(); ++c) {
    const auto at = std::ranges::find(surface.cuts, static_cast<int>(c), &SurfaceCut::curve);
    const auto lip = std::ranges::find_if(surface.model.lips,
                                          [&](const auto& lips) { return lips[1] == static_cast<int>(c); });
    if (lip != surface.model.lips.end()) {
      m.whole_curve.push_back(second_lip(m.whole.model, m.whole_curve[(*lip)[0]]));
      m.curve_planes.push_back(int(m.curve_planes[(*lip)[0]]));
      continue;
    }
    const int face = at != surface.cuts.end() ? at->face : 0;
    m.whole_curve.push_back(static_cast<int>(m.whole.model.fine.curves.size()));
    m.curve_planes.push_back(m.face_planes[face]);
    for (int mask = 0; mask < images; ++mask) {
      m.whole.model.fine.curves.push_back({++tag, {}});
      if (at == surface.cuts.end()) continue;
      SurfaceCut image = *at;
      image.curve = static_cast<int>(m.whole.model.fine.curves.size()) - 1;
      image.face = image_face(m, mask, face);
      m.whole.cuts.push_back(image);
    }
  }
  const SurfaceDomain& domain = surface.domain;
  m.node_planes.assign(domain.boundary.points.size(), 0);
  for (std::size_t c = 0; c < domain.chains.size(); ++c)
    for (const CurveNode& node : domain.nodes.on_curve[c])
      m.node_planes[node.node] |= m.curve_planes[domain.chains[c].curve];
  for (const SymmetricHalf::Place& place : cut.half.touching)
    for (std::size_t v = 0; v < m.node_planes.size(); ++v)
      if (domain.boundary.points[v] == place.at) m.node_planes[v] |= place.planes;
  const auto shared = std::make_shared<const MirroredSurface>(std::move(m));
  surface.mirrored = shared;
  surface.full_model = {shared, &shared->whole};
}

}  // namespace delquad
