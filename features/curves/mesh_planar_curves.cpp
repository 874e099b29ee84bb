// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/mesh_planar_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "algorithms/fields/fields.h"
#include "base/budget.h"
#include "base/disjoint_sets.h"
#include "delquad/error.h"
#include "features/curves/flat_curves.h"
#include "features/divisions/divisions.h"
#include "features/embedded/embedded_pieces.h"
#include "features/grids/grids.h"
#include "features/periodic/periodic.h"
#include "geometry/patches/across_view.h"
#include "geometry/patches/even_counts.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/domain_builder.h"
#include "geometry/planar/face_regions.h"
#include "geometry/planar/loops_apart.h"

namespace delquad {

namespace {

/// Numbers of edges of pieces, which are curves of a surface here.
class PieceCounts {
 public:
  PieceCounts(const PlanarModel& model, FlatCurves flat, const std::vector<ChainPair>& images,
              const SizeField& size, double shortest, std::vector<CurvePiece>& pieces)
      : model_(model), pieces_(pieces), flat_(std::move(flat)) {
    flat_.curves.images = images;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const CurvePiece& p = pieces[i];
      const bool is_free = p.is_free();
      const double integral = is_free ? p.measure->integral() : p.n;
      const auto lines = static_cast<double>(flat_.curves.chains[i].points.size() - 1);
      wanted_.demands.push_back({integral, p.least, {}, is_free ? 0 : p.n, most_edges(integral, shortest)});
      wanted_.integrals.push_back({{{0, 0}, {lines, integral}}});
      wanted_.lengths.push_back(integral);
      // Each by itself: means of strips make numbers that fit worse.
      wanted_.group.push_back(static_cast<int>(i));
    }
    for (std::size_t p = 0; p < flat_.curves.maps.size(); ++p) {
      wanted_.quads.push_back(expected_quads(flat_.curves.maps[p].flat, size, kQuadsError, kCoarsest));
      std::vector<CurveSide> around;
      for (const auto& loop : flat_.curves.outlines[p])
        for (const CurveSide& side : loop)
          if (side.begins(flat_.curves.chains[side.chain])) around.push_back(side);
      for (const CurveSide& side : around) {
        std::vector<int>& patches = wanted_.demands[side.chain].patches;
        patches.insert(side.forward ? patches.begin() : patches.end(), static_cast<int>(p));
      }
    }
  }

  /// Changes numbers by one, where it costs least. Throws InputError where the numbers that are given forbid
  /// it.
  void make_even() { set(even(wanted_.demands)); }

  std::vector<MappedFace> find_grids(const MappedSpec& spec) const {
    return find_surface_grids(spec, flat_.fine, flat_.curves, wanted_);
  }

  /// Gives the sides of grids numbers that fit. `size`: by which these are chosen; null: as all others.
  /// Faces that are not asked for may drop out; where all do, numbers stay.
  void balance(const MappedSpec& spec, const SizeField* size, std::vector<MappedFace>& mapped) {
    CurveDemands wanted = wanted_;
    for (const MappedFace& face : mapped)
      for (const auto& side : face.sides)
        for (const int i : side)
          if (const CurvePiece& p = pieces_[i]; size != nullptr && p.is_free())
            wanted.demands[i].integral =
                ArcMeasure(*p.shape, p.from, p.to, *size, curve_label(model_, p.curves[0]), kMostEdges)
                    .integral();
    std::vector<int> odd;
    const std::vector<int> counts = grid_counts(spec, flat_.fine, flat_.curves, wanted, mapped, odd);
    if (mapped.empty()) return;
    check_even(odd);
    set(counts);
  }

  const SurfaceCurves& curves() const { return flat_.curves; }

  /// Lets numbers agree, and nodes face each other across narrow places. `mapped`: faces that are grids,
  /// whose sides keep their numbers; none: all numbers are chosen anew.
  void agree(const CurveAgreement& by, const SizeField& field, const std::vector<MappedFace>& mapped) {
    const Mesh& fine = flat_.fine;
    const SurfaceCurves& curves = flat_.curves;
    const AcrossView across(fine, curves.chains, curves.maps, curves.outlines);
    const SizeOnLine size = [&](int, int, double, const Vec3& x, int& hint) { return field.at(x, hint); };
    CurveDemands wanted = wanted_;
    if (by.round_holes) widen_round_holes(fine, curves, across, by.price, wanted);
    std::vector<int> counts;
    for (const CurvePiece& p : pieces_) counts.push_back(p.n);
    if (mapped.empty()) counts = even(wanted.demands);
    std::set<int> kept, stays;  // sides of all grids, and of those that are asked for
    for (const MappedFace& face : mapped)
      for (const auto& side : face.sides) {
        kept.insert(side.begin(), side.end());
        if (face.is_requested) stays.insert(side.begin(), side.end());
      }
    const double quads = std::accumulate(wanted.quads.begin(), wanted.quads.end(), 0.0);
    Budget steps(std::min(by.most_steps, static_cast<long long>(kStepsPerQuad * quads)));
    agree_on_counts(curves, wanted, by.price, kept, steps, counts);
    Budget looks(by.most_steps);
    for (const ChainPair& pair : curves.images) counts[pair.chain] = counts[pair.master];
    const CurvePlaces places = align_opposite_nodes(fine, curves.chains, across, wanted.integrals, counts,
                                                    wanted.group, size, looks);
    set(counts);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      double farthest = 0;
      for (std::size_t k = 0; k < places[i].size(); ++k)
        farthest = std::max(farthest, std::abs(places[i][k] - static_cast<double>(k)));
      if (!pieces_[i].is_free() || farthest < kLeastMove || stays.contains(static_cast<int>(i))) continue;
      std::vector<double> at(places[i].begin() + 1, places[i].end() - 1);
      for (double& x : at) x *= wanted_.demands[i].integral / counts[i];
      pieces_[i].interior = pieces_[i].measure->nodes_at(at);
    }
  }

 private:
  /// Error of the number of quads in a patch, and part of its diagonal at which its size is seen at least.
  static constexpr double kQuadsError = 0.1, kCoarsest = 0.25;
  /// Steps of agreement: what regions with hundreds of curves gain comes early.
  static constexpr double kStepsPerQuad = 50;
  /// In edges: what lies across is known no better, by chords.
  static constexpr double kLeastMove = 0.15;
  static constexpr double kMostEdges = 1e8;  ///< of a side of a grid

  std::vector<int> even(const std::vector<CurveDemand>& demands) const {
    std::vector<int> odd;
    std::vector<int> counts = even_counts(
        joined_demands(demands, flat_.curves.images), static_cast<int>(flat_.curves.maps.size()),
        *matching_solver(matching_solver_names().front()), odd,
        [](int n, const CurveDemand& d) { return std::abs(std::log(changed_by_one(n, d) / d.integral)); });
    check_even(odd);
    return counts;
  }

  void check_even(const std::vector<int>& odd) const {
    check_divisions_even(message_prefix(model_), flat_.fine, flat_.curves, wanted_, odd);
  }

  void set(const std::vector<int>& counts) {
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (pieces_[i].is_free() && counts[i] != pieces_[i].n) pieces_[i].set_edges(counts[i]);
  }

  const PlanarModel& model_;
  std::vector<CurvePiece>& pieces_;
  FlatCurves flat_;
  CurveDemands wanted_;
};

class CurveMesher {
 public:
  CurveMesher(const PlanarModel& model, const SizeField& size, const CurveMeshOptions& options)
      : model_(model),
        mapped_spec_(options.mapped),
        grid_size_(options.grid_size.get()),
        agreement_(options.agreement),
        size_(size),
        chain_(chain_model(model)),
        pieces_(cut_curves(model, chain_)) {
    measure(options.max_edges);
    name_curves();
    set_least();
    divide_pieces(model_, options.divisions, pieces_);
    for (CurvePiece& p : pieces_)
      if (!p.is_divided) p.set_edges(std::max(p.least, static_cast<int>(std::lround(p.measure->integral()))));
    if (!options.periodic.empty())
      images_ = pair_pieces(model_, options.periodic, mesh(), node_chains(), chain_, pieces_);
    follow_masters(model_, images_, pieces_);
    add_dangling_edges(model_, size, mesh(), chain_, pieces_);
    make_even();
    follow_masters(model_, images_, pieces_);
  }

  /// Divides the curves into chords, as true to them as `fineness` says, see divide_by_chords().
  CurveMesher(const PlanarModel& model, const SizeField& size, double fineness)
      : model_(model), size_(size), chain_(chain_model(model)), pieces_(cut_curves(model, chain_)) {
    name_curves();
    set_least();
    for (CurvePiece& p : pieces_) divide_by_chords(size, fineness, p);
  }

  /// The nodes of each piece, numbered as in mesh().
  std::vector<CurveChain> node_chains() const {
    std::vector<CurveChain> chains;
    int next = static_cast<int>(chain_.nodes.size());
    for (const CurvePiece& piece : pieces_) {
      CurveChain& chain = chains.emplace_back(CurveChain{piece.curve, {piece.ends[0]}});
      for (std::size_t k = 0; k < piece.interior.size(); ++k) chain.points.push_back(next++);
      chain.points.push_back(piece.ends[1]);
    }
    return chains;
  }

  Mesh mesh() const {
    Mesh mesh;
    const auto add = [&](Vec2 p) { mesh.points.push_back({p.x, p.y, 0}); };
    std::ranges::for_each(chain_.nodes, add);
    for (const CurvePiece& piece : pieces_)
      for (std::size_t k = 0; k < piece.interior.size(); ++k) add(piece.node(k));
    for (const CurveChain& chain : node_chains())
      for (std::size_t k = 1; k < chain.points.size(); ++k) {
        mesh.lines.push_back({chain.points[k - 1], chain.points[k]});
        mesh.line_curve.push_back(chain.curve < 0 ? dangling_curve() : chain.curve);
      }
    mesh.curves = curves_;
    if (has_dangling()) mesh.curves.push_back({dangling_curve() + 1, {}});
    for (std::size_t i = 0; i < model_.points.size(); ++i) {
      const ModelPoint& point = model_.points[i];
      Entity entity{static_cast<int>(i) + 1, {}};
      if (!point.name.empty()) entity.names.push_back(point.name);
      mesh.named_points.push_back({chain_.point_nodes[i], std::move(entity)});
    }
    return mesh;
  }

  /// Regions, patches and places of the meshed curves.
  PlanarDomain domain() const {
    Mesh lines = mesh();
    std::vector<ChainPair> by_piece = images_;
    std::ranges::sort(by_piece, {}, &ChainPair::chain);
    add_pairs_of_chains(node_chains(), by_piece, lines.periodic);
    const BoundaryNames names = this->names();
    const Arrangement arrangement = arrange_lines(lines, names);
    FaceRegions regions = regions_of_loops(lines, arrangement, chain_.loops, loops_of_curve(), names);
    check_embedded(model_, chain_, pieces_, lines, arrangement, regions);
    std::vector<MappedPatch> mapped;
    if (!mapped_.empty()) mapped = mapped_patches(mapped_, counts_->curves(), pieces_, arrangement, regions);
    PlanarDomain domain = build_domain(std::move(lines), arrangement, std::move(regions), names,
                                       {cracks(), has_dangling() ? dangling_curve() : -1, true});
    check_loops_apart(loop_edges(), names);
    domain.places = places();
    domain.places.resize(domain.boundary.points.size());
    for (const int v : domain.on_crack) domain.places[v] = {};
    domain.pieces = domain_pieces();
    domain.model_curves = of_curve_;
    domain.model_curves.resize(domain.boundary.curves.size());
    domain.mapped = std::move(mapped);
    if (domain.has_junctions) drop_stray_lines(domain);
    for (const auto& curves : domain.model_curves) domain.curve_shapes.push_back(shapes_of(curves));
    return domain;
  }

 private:
  /// Belongs to curves of the model; where there are none, to all cracks.
  std::vector<std::shared_ptr<const Curve>> shapes_of(const std::vector<int>& curves) const {
    std::vector<std::shared_ptr<const Curve>> shapes;
    for (const int c : curves) shapes.push_back(model_.curves[c].shape);
    if (curves.empty())
      for (const ModelCurve& curve : model_.curves)
        if (curve.is_crack) shapes.push_back(curve.shape);
    return shapes;
  }

  bool has_dangling() const { return pieces_.back().curve < 0; }
  int dangling_curve() const { return static_cast<int>(curves_.size()); }
  std::string prefix() const { return message_prefix(model_); }

  BoundaryNames names() const {
    return {model_.source,
            [this](int c) {
              return c == dangling_curve() ? "the edge at a point"
                                           : curve_label(model_, of_curve_[c].front());
            },
            "the curves meet there, or the size is too large to keep them apart",
            has_dangling() ? dangling_curve() : -1};
  }

  /// At the mesh's points.
  std::vector<CurvePlace> places() const {
    std::vector<CurvePlace> places(chain_.nodes.size());
    for (const CurvePiece& piece : pieces_)
      if (piece.curve < 0) places[piece.ends[1]].is_free = true;
    std::vector<char> stays;
    for (const CurvePiece& piece : pieces_) stays.push_back(piece.is_divided);
    for (const ChainPair& pair : images_) stays[pair.chain] = stays[pair.master] = 1;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const CurvePiece& piece = pieces_[i];
      for (const double t : piece.interior)
        places.push_back(stays[i] ? CurvePlace{} : CurvePlace{piece.shape, t, piece.from, piece.to});
    }
    return places;
  }

  std::vector<DomainPiece> domain_pieces() const {
    std::vector<DomainPiece> pieces;
    const std::vector<CurveChain> chains = node_chains();
    std::vector<char> is_divided;
    for (const CurvePiece& piece : pieces_) is_divided.push_back(piece.is_divided);
    for (const ChainPair& pair : images_) is_divided[pair.chain] = is_divided[pair.master];
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (const CurvePiece& p = pieces_[i]; p.curve >= 0)
        pieces.push_back({p.ends,
                          p.shape,
                          p.from,
                          p.to,
                          {chains[i].points.begin() + 1, chains[i].points.end() - 1},
                          p.interior,
                          is_divided[i] != 0});
    return pieces;
  }

  std::vector<std::vector<int>> loops_of_curve() const {
    const auto of_model = loops_of_model_curves(model_, chain_);
    std::vector<std::vector<int>> loops(curves_.size() + has_dangling());
    for (std::size_t c = 0; c < of_curve_.size(); ++c)
      for (const int m : of_curve_[c])
        loops[c].insert(loops[c].end(), of_model[m].begin(), of_model[m].end());
    return loops;
  }

  /// By curve of the mesh; empty: none.
  std::vector<char> cracks() const {
    std::vector<char> cracks;
    for (const std::vector<int>& of : of_curve_) cracks.push_back(is_crack(model_, of));
    if (std::ranges::find(cracks, 1) == cracks.end()) return {};
    cracks.resize(curves_.size() + has_dangling(), 0);
    return cracks;
  }

  /// All edges, each with the connected curves that it is of.
  std::vector<LoopEdge> loop_edges() const {
    DisjointSets joined(chain_.nodes.size());
    for (const CurvePiece& piece : pieces_) joined.join(piece.ends[0], piece.ends[1]);
    std::vector<LoopEdge> edges;
    for (const CurvePiece& piece : pieces_) {
      if (piece.curve < 0) continue;
      double t = piece.from;
      Vec2 p = chain_.nodes[piece.ends[0]];
      for (std::size_t i = 0; i <= piece.interior.size(); ++i) {
        const bool is_last = i == piece.interior.size();
        const double next = is_last ? piece.to : piece.interior[i];
        const Vec2 q = is_last ? chain_.nodes[piece.ends[1]] : piece.shape->point(next);
        edges.push_back({piece.shape.get(), t, next, p, q, joined.root(piece.ends[0]), piece.curve});
        t = next;
        p = q;
      }
    }
    return edges;
  }

  void measure(double max_edges) {
    double total = 0;
    for (CurvePiece& p : pieces_) {
      p.measure.emplace(*p.shape, p.from, p.to, size_, prefix() + curve_label(model_, p.curves[0]),
                        max_edges - total);
      total += p.measure->integral();
    }
    if (total > max_edges)
      throw InputError(fmt::format(
          "{}the boundary needs about {:.3g} edges of this size, more than {:.3g}: expected a larger size",
          prefix(), total, max_edges));
  }

  /// The model's curves, then the curves of pieces where several lie on each other, which have all their
  /// names. Names of curves that are in no loop come first, as most formats hold one name.
  void name_curves() {
    const auto loops = loops_of_model_curves(model_, chain_);
    curves_ = curve_entities(model_);
    for (std::size_t c = 0; c < curves_.size(); ++c) of_curve_.push_back({static_cast<int>(c)});
    std::map<std::vector<int>, int> known;
    for (CurvePiece& piece : pieces_) {
      piece.curve = piece.curves[0];
      if (piece.curves.size() == 1) continue;
      const auto [at, is_new] = known.try_emplace(piece.curves, static_cast<int>(curves_.size()));
      piece.curve = at->second;
      if (!is_new) continue;
      Entity& curve = curves_.emplace_back(Entity{static_cast<int>(curves_.size()) + 1, {}});
      of_curve_.push_back(piece.curves);
      std::vector<int> of = piece.curves;
      std::ranges::stable_partition(of, [&](int c) { return loops[c].empty(); });
      for (const int c : of)
        if (const std::string& name = model_.curves[c].name;
            !name.empty() && std::ranges::find(curve.names, name) == curve.names.end())
          curve.names.push_back(name);
    }
  }

  // A closed piece needs three edges, two between the same nodes two each: else they would fold up. One by
  // itself needs two: else it could not be opened (see build_domain()), nor could a crack between two tips.
  void set_least() {
    std::map<std::pair<int, int>, int> count;
    for (const CurvePiece& p : pieces_) ++count[p.sorted_ends()];
    const std::vector<int> valence = pieces_at_nodes(pieces_, chain_.nodes.size());
    std::vector<CurvePiece> cracks;
    std::ranges::copy_if(pieces_, std::back_inserter(cracks),
                         [&](const CurvePiece& p) { return is_crack(model_, p.curves); });
    const std::vector<int> crack_valence = pieces_at_nodes(cracks, chain_.nodes.size());
    for (CurvePiece& p : pieces_) {
      const bool is_single = valence[p.ends[0]] == 1 && valence[p.ends[1]] == 1;
      const bool has_tips =
          is_crack(model_, p.curves) && crack_valence[p.ends[0]] == 1 && crack_valence[p.ends[1]] == 1;
      p.least = p.ends[0] == p.ends[1] ? 3 : count[p.sorted_ends()] > 1 || is_single || has_tips ? 2 : 1;
    }
  }
  void make_even() {
    const Mesh lines = mesh();
    const BoundaryNames names = this->names();
    const Arrangement arrangement = arrange_lines(lines, names);
    const FaceRegions regions = regions_of_loops(lines, arrangement, chain_.loops, loops_of_curve(), names);
    PieceCounts& counts = counts_.emplace(model_, flat_curves(lines, arrangement, regions, names, pieces_),
                                          images_, size_, agreement_.shortest, pieces_);
    if (mapped_spec_.asks() || agreement_.narrow_grids) mapped_ = counts.find_grids(mapped_spec_);
    if (!mapped_.empty()) counts.balance(mapped_spec_, grid_size_, mapped_);
    if (mapped_.empty()) counts.make_even();
    if (agreement_.price > 0) counts.agree(agreement_, size_, mapped_);
  }

  const PlanarModel& model_;
  const MappedSpec mapped_spec_ = {};
  const SizeField* const grid_size_ = nullptr;
  const CurveAgreement agreement_ = {};
  const SizeField& size_;
  ModelChain chain_;
  std::vector<CurvePiece> pieces_;
  std::vector<ChainPair> images_;
  std::optional<PieceCounts> counts_;
  std::vector<MappedFace> mapped_;
  std::vector<Entity> curves_;              ///< of the mesh
  std::vector<std::vector<int>> of_curve_;  ///< the model's curves of each
};

}  // namespace

PlanarDomain make_domain(const PlanarModel& model, const SizeField& size, const CurveMeshOptions& options) {
  if (options.agreement.price > 0) try {
      return CurveMesher(model, size, options).domain();
    } catch (const InputError&) {
      // Numbers that agree may keep curves apart no longer.
    }
  CurveMeshOptions by_size = options;
  by_size.agreement.price = 0;
  return CurveMesher(model, size, by_size).domain();
}

PlanarDomain chord_domain(const PlanarModel& model, const SizeField& size) {
  constexpr double kFinest = 1.0 / 256, kFiner = 1.0 / 4;
  for (double fineness = 1;; fineness *= kFiner) try {
      return CurveMesher(model, size, fineness).domain();
    } catch (const InputError&) {
      if (fineness <= kFinest) throw;
    }
}

}  // namespace delquad
