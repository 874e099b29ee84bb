#include "features/curves/mesh_planar_curves.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "base/disjoint_sets.h"
#include "delquad/error.h"
#include "features/divisions/divisions.h"
#include "features/embedded/embedded_pieces.h"
#include "features/grids/grids.h"
#include "features/periodic/periodic.h"
#include "features/symmetry/planar_symmetry.h"
#include "features/thin/facing_nodes.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/domain_builder.h"
#include "geometry/planar/face_regions.h"
#include "geometry/planar/loops_apart.h"
#include "patches/even_counts.h"

namespace delquad {

namespace {

/// Changes numbers of edges by one, where it costs least, until every region has an even number of them.
/// Throws InputError where what was divided forbids that.
class EvenCounts {
 public:
  EvenCounts(const PlanarModel& model, const Arrangement& arrangement, const FaceRegions& regions,
             std::vector<CurvePiece>& pieces)
      : model_(model), arrangement_(arrangement), regions_(regions), pieces_(pieces) {
    for (const CurvePiece& p : pieces_) {
      first_line_.push_back(n_lines_);
      n_lines_ += static_cast<std::size_t>(p.n);
    }
  }

  void of_groups() {
    for (const std::vector<int>& group : groups()) {
      int total = 0;
      for (int i : group) total += pieces_[i].n;
      if (total % 2 != 0) change_by_one(group);
    }
  }

  /// Every face with a region gets an even number of sides at the least cost; the others do not matter.
  /// `wanted`: edges of each piece; empty: the integrals.
  void by_t_join(const std::vector<double>& wanted = {}) {
    // Mirror images have the numbers of their masters.
    std::vector<char> counts_not(regions_.region.size(), 0);
    for (std::size_t f = 0; f < counts_not.size(); ++f) counts_not[f] = regions_.region[f] < 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (const int side : {0, 1})
        if (const int face = face_beside(i, side); pieces_[i].image && face >= 0) counts_not[face] = 1;
    std::vector<std::set<int>> odd_beside(pieces_.size());  // of each with those that follow it
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].image) continue;
      auto& odd = odd_beside[pieces_[i].master < 0 ? i : static_cast<std::size_t>(pieces_[i].master)];
      for (const int side : {0, 1})
        if (const int face = face_beside(i, side); face >= 0 && !counts_not[face])
          if (const auto [at, is_new] = odd.insert(face); !is_new) odd.erase(at);
    }
    std::vector<CurveDemand> demands;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      demands.push_back(demand_of(pieces_[i], {odd_beside[i].begin(), odd_beside[i].end()}));
    for (std::size_t i = 0; i < wanted.size(); ++i) demands[i].integral = wanted[i];
    std::vector<int> odd_faces;
    const std::vector<int> counts = even_counts(
        demands, static_cast<int>(counts_not.size()), *matching_solver(matching_solver_names().front()),
        odd_faces,
        [](int n, const CurveDemand& d) { return std::abs(std::log(changed_by_one(n, d) / d.integral)); });
    if (!odd_faces.empty()) throw odd_error(odd_faces.back());
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (counts[i] != pieces_[i].n) pieces_[i].set_edges(counts[i]);
  }

 private:
  bool is_filled(int face) const { return face >= 0 && regions_.region[face] >= 0; }
  static CurveDemand demand_of(const CurvePiece& p, std::vector<int> faces) {
    const bool is_free = !p.is_divided && p.master < 0 && p.measure;
    return {p.measure ? p.measure->integral() : 1, p.least, std::move(faces), is_free ? 0 : p.n};
  }
  /// Of the first line of a piece, on its left (0) or right.
  int face_beside(std::size_t piece, int side) const {
    return arrangement_.face_of[2 * first_line_[piece] + side];
  }

  /// Pieces whose edges must be even in number, each group by itself, where all loops are apart: components,
  /// and interfaces.
  std::vector<std::vector<int>> groups() const {
    // The plain holes of a region are counted with its outer loop, unless that is an interface, even by
    // itself.
    const std::size_t n = arrangement_.faces.size();
    std::vector<std::vector<int>> outlines(n), holes(n);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const int left = face_beside(i, 0), right = face_beside(i, 1);
      const int inner = left >= 0 && arrangement_.faces[left].around == right ? left : right;
      const int around = arrangement_.faces[inner].around;
      if (is_filled(inner))
        outlines[inner].push_back(static_cast<int>(i));
      else
        (is_filled(around) && is_filled(arrangement_.faces[around].around) ? holes : outlines)[around]
            .push_back(static_cast<int>(i));
    }
    outlines.insert(outlines.end(), holes.begin(), holes.end());
    return outlines;
  }

  void change_by_one(const std::vector<int>& group) {
    const auto changed = [&](int i) { return changed_by_one(pieces_[i].n, demand_of(pieces_[i], {})); };
    const auto cost = [&](int i) {
      return pieces_[i].is_divided ? std::numeric_limits<double>::infinity()
                                   : std::abs(std::log(changed(i) / pieces_[i].measure->integral()));
    };
    const int best = *std::ranges::min_element(group, {}, cost);
    if (pieces_[best].is_divided)
      throw odd_error(is_filled(face_beside(best, 0)) ? face_beside(best, 0) : face_beside(best, 1));
    pieces_[best].set_edges(changed(best));
  }

  /// What was divided leaves no way to an even number around that face.
  InputError odd_error(int face) const {
    std::set<std::string> names;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if ((pieces_[i].is_divided || pieces_[i].master >= 0) &&
          (face_beside(i, 0) == face || face_beside(i, 1) == face))
        names.insert(curve_label(model_, pieces_[i].curves[0]));
    const Entity& region = regions_.regions[regions_.region[face]];
    return InputError(fmt::format(
        "{}the numbers of edges that are given leave {} with an odd number around it, and quads need an even "
        "one: change that of one of {}",
        message_prefix(model_),
        region.names.empty() ? fmt::format("region {}", region.tag) : "'" + region.names[0] + "'",
        fmt::join(names, ", ")));
  }

  const PlanarModel& model_;
  const Arrangement& arrangement_;
  const FaceRegions& regions_;
  std::vector<CurvePiece>& pieces_;
  std::vector<std::size_t> first_line_;  ///< of each piece
  std::size_t n_lines_ = 0;
};

class CurveMesher {
 public:
  CurveMesher(const PlanarModel& model, const PointSize& size, const CurveMeshOptions& options,
              const Symmetry* symmetry = nullptr)
      : model_(model),
        mapped_spec_(options.mapped),
        narrow_grids_(options.narrow_grids),
        thin_rows_(options.thin_rows),
        grid_size_(options.grid_size),
        chain_(chain_model(model)),
        pieces_(cut_curves(model, chain_)) {
    if (symmetry != nullptr) first_axis_ = static_cast<int>(model.curves.size()) - symmetry->n_planes();
    measure(size, options.max_edges);
    name_curves();
    set_least();
    divide_pieces(model_, options.divisions, pieces_);
    for (CurvePiece& p : pieces_)
      if (!p.is_divided) p.set_edges(std::max(p.least, static_cast<int>(std::lround(p.measure->integral()))));
    pair_pieces(model_, options.periodic, chain_, pieces_);
    if (symmetry != nullptr) {
      drop_axes_outside(mesh(), first_axis_, chain_, pieces_);
      pair_symmetric(model_, *symmetry, options.symmetry.where, chain_, pieces_);
    }
    follow_masters(model_, pieces_);
    const auto fold = [&](Vec2 at, Vec2 x) {
      return symmetry != nullptr ? symmetry->reflect(symmetry->folds_of(at), x) : x;
    };
    add_whiskers(model_, size, fold, chain_, pieces_);
    make_even();
    follow_masters(model_, pieces_);
  }

  Mesh mesh() const {
    Mesh mesh;
    for (Vec2 p : chain_.nodes) mesh.points.push_back({p.x, p.y, 0});
    for (const CurvePiece& piece : pieces_) {
      int last = piece.ends[0];
      for (std::size_t k = 0; k < piece.interior.size(); ++k) {
        const Vec2 p = piece.master < 0 ? piece.shape->point(piece.interior[k]) : piece.images[k];
        const int next = static_cast<int>(mesh.points.size());
        mesh.points.push_back({p.x, p.y, 0});
        mesh.lines.push_back({last, next});
        last = next;
      }
      mesh.lines.push_back({last, piece.ends[1]});
      mesh.line_curve.resize(mesh.lines.size(), piece.curve < 0 ? whisker_curve() : piece.curve);
    }
    mesh.curves = curves_;
    add_pairs_of_pieces(pieces_, chain_.nodes.size(), mesh);
    if (has_whiskers()) mesh.curves.push_back({whisker_curve() + 1, {}});
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
    const BoundaryNames names = this->names();
    const Arrangement arrangement = arrange_lines(lines, names);
    FaceRegions regions = regions_of_loops(lines, arrangement, chain_.loops, loops_of_curve(), names);
    check_embedded(model_, chain_, pieces_, first_axis_, lines, arrangement, regions);
    PlanarDomain domain = build_domain(std::move(lines), arrangement, std::move(regions), names,
                                       {cracks(), has_whiskers() ? whisker_curve() : -1, true});
    check_loops_apart(loop_edges(), names);
    domain.places = places();
    domain.places.resize(domain.boundary.points.size());
    for (const int v : domain.on_crack) domain.places[v] = {};
    domain.pieces = domain_pieces();
    domain.model_curves = of_curve_;
    domain.model_curves.resize(domain.boundary.curves.size());
    domain.mapped = mapped_patches(mapped_, pieces_, domain.patches, domain.boundary.points);
    if (domain.has_junctions) drop_stray_lines(domain);
    drop_axes(first_axis_, domain);
    for (const auto& curves : domain.model_curves) domain.curve_shapes.push_back(shapes_of(curves));
    return domain;
  }

 private:
  /// Of curves of the model; where there are none, of all cracks.
  std::vector<std::shared_ptr<const Curve>> shapes_of(const std::vector<int>& curves) const {
    std::vector<std::shared_ptr<const Curve>> shapes;
    for (const int c : curves) shapes.push_back(model_.curves[c].shape);
    if (curves.empty())
      for (const ModelCurve& curve : model_.curves)
        if (curve.is_crack) shapes.push_back(curve.shape);
    return shapes;
  }

  bool has_whiskers() const { return pieces_.back().curve < 0; }
  int whisker_curve() const { return static_cast<int>(curves_.size()); }
  std::string prefix() const { return message_prefix(model_); }

  BoundaryNames names() const {
    return {model_.source,
            [this](int c) {
              return c == whisker_curve() ? "the edge at a point" : curve_label(model_, of_curve_[c].front());
            },
            "the curves meet there, or the size is too large to keep them apart",
            has_whiskers() ? whisker_curve() : -1};
  }

  /// Of each piece, whether its nodes stay in all stages: they were asked for, or are paired.
  std::vector<char> staying() const {
    std::vector<char> stays(pieces_.size(), 0);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].is_divided) stays[i] = 1;
      if (pieces_[i].master >= 0) stays[i] = stays[pieces_[i].master] = 1;
    }
    return stays;
  }

  /// Of the mesh's points.
  std::vector<CurvePlace> places() const {
    std::vector<CurvePlace> places(chain_.nodes.size());
    for (const CurvePiece& piece : pieces_)
      if (piece.curve < 0) places[piece.ends[1]].is_free = true;
    const std::vector<char> stays = staying();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const CurvePiece& piece = pieces_[i];
      for (const double t : piece.interior)
        places.push_back(stays[i] ? CurvePlace{} : CurvePlace{piece.shape, t, piece.from, piece.to});
    }
    return places;
  }

  std::vector<DomainPiece> domain_pieces() const {
    std::vector<DomainPiece> pieces;
    int next = static_cast<int>(chain_.nodes.size());
    for (const CurvePiece& piece : pieces_) {
      std::vector<int> nodes(piece.interior.size());
      std::iota(nodes.begin(), nodes.end(), next);
      next += static_cast<int>(nodes.size());
      const bool is_divided = piece.is_divided || (piece.master >= 0 && pieces_[piece.master].is_divided);
      if (piece.curve >= 0)
        pieces.push_back(
            {piece.ends, piece.shape, piece.from, piece.to, std::move(nodes), piece.interior, is_divided});
    }
    return pieces;
  }

  std::vector<std::vector<int>> loops_of_curve() const {
    const auto of_model = loops_of_model_curves(model_, chain_);
    std::vector<std::vector<int>> loops(curves_.size() + has_whiskers());
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
    cracks.resize(curves_.size() + has_whiskers(), 0);
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

  void measure(const PointSize& size, double max_edges) {
    double total = 0;
    for (CurvePiece& p : pieces_) {
      p.measure.emplace(*p.shape, p.from, p.to, size, prefix() + curve_label(model_, p.curves[0]),
                        max_edges - total);
      total += p.measure->integral();
    }
    if (total > max_edges)
      throw InputError(
          fmt::format("{}the boundary needs about {:.3g} edges of this size; at most {:.3g} are allowed",
                      prefix(), total, max_edges));
  }

  /// The model's curves, then those of pieces where several lie on each other, which have all their names.
  /// Names of curves that are in no loop come first, as most formats hold one name.
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
    if (mapped_spec_.asks() || narrow_grids_)
      mapped_ = find_mapped_faces(model_, mapped_spec_, lines, arrangement, regions, chain_, pieces_);
    EvenCounts even(model_, arrangement, regions, pieces_);
    const auto number = [&](const std::vector<double>& wanted) {
      if (!mapped_.empty() && wanted.empty())
        balance_mapped(model_, mapped_, arrangement, regions, grid_size_, pieces_);
      if (!mapped_.empty()) return;
      const bool are_apart =
          std::ranges::all_of(pieces_at_nodes(pieces_, chain_.nodes.size()), [](int n) { return n == 2; });
      const bool are_free = std::ranges::all_of(pieces_, [](const CurvePiece& p) { return p.master < 0; });
      are_apart&& are_free&& wanted.empty() ? even.of_groups() : even.by_t_join(wanted);
    };
    thin_rows_ ? face_nodes(arrangement, regions, pieces_, number) : number({});
  }

  const PlanarModel& model_;
  const MappedSpec mapped_spec_;
  const bool narrow_grids_;
  const bool thin_rows_;
  const PointSize grid_size_;
  ModelChain chain_;
  std::vector<CurvePiece> pieces_;
  std::vector<MappedPlanarFace> mapped_;
  int first_axis_ = std::numeric_limits<int>::max();  ///< from it on curves of the model are axes
  std::vector<Entity> curves_;                        ///< of the mesh
  std::vector<std::vector<int>> of_curve_;            ///< the model's curves of each
};

}  // namespace

PlanarDomain make_domain(const PlanarModel& model, const PointSize& size, const CurveMeshOptions& options) {
  const bool asked = options.symmetry.automatic || !options.symmetry.planes.empty();
  const auto symmetry = asked ? find_symmetry(model, options.symmetry) : std::nullopt;
  if (!symmetry) {
    PlanarDomain domain = CurveMesher(model, size, options).domain();
    if (asked) {
      const std::string spoiled = what_spoils_symmetry(model);
      domain.notes.push_back(options.symmetry.where +
                             ": no plane of symmetry was found: all of the model is meshed" +
                             (spoiled.empty() ? "" : "; " + spoiled));
    }
    return domain;
  }
  const PlanarModel whole = with_axes(model, *symmetry);
  PlanarDomain domain = CurveMesher(whole, size, options, &*symmetry).domain();
  const int n_points = static_cast<int>(model.points.size());
  std::erase_if(domain.boundary.named_points, [&](const NamedPoint& p) { return p.entity.tag > n_points; });
  domain.images = patch_images(domain.patches, *symmetry, options.symmetry.where);
  return domain;
}

}  // namespace delquad
