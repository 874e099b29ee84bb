#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "delquad/error.h"
#include "geometry/planar/arc_measure.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/domain_builder.h"
#include "geometry/planar/face_regions.h"
#include "geometry/planar/loops_apart.h"
#include "geometry/planar/model_chain.h"
#include "geometry/planar/planar_model.h"
#include "geometry/planar/whiskers.h"
#include "matching/t_join.h"

namespace delquad {

namespace {

/// The part of a curve between two compulsory nodes.
struct Piece {
  std::vector<int> curves;  ///< of the model; several where these lie on each other; none: a whisker
  std::array<int, 2> ends;  ///< nodes
  std::shared_ptr<const Curve> shape;
  double from = 0, to = 1;
  std::optional<ArcMeasure> measure = {};
  int least = 1;                      ///< fewest edges
  int n = 1;                          ///< edges
  std::vector<double> interior = {};  ///< parameters of its nodes
  int curve = -1;                     ///< of the mesh; -1: a whisker

  void set_edges(int edges) {
    n = edges;
    interior = measure->interior_nodes(n);
  }
  std::pair<int, int> sorted_ends() const { return std::minmax(ends[0], ends[1]); }
};

class CurveMesher {
 public:
  CurveMesher(const PlanarModel& model, const PointSize& size, const CurveMeshOptions& options)
      : model_(model), chain_(chain_model(model)) {
    cut_at_stops();
    join_equal_pieces();
    check_angles();
    measure(size, options.max_edges);
    name_curves();
    set_least();
    for (Piece& p : pieces_)
      p.set_edges(std::max(p.least, static_cast<int>(std::lround(p.measure->integral()))));
    add_whiskers(size);
    make_even();
  }

  Mesh mesh() const {
    Mesh mesh;
    for (Vec2 p : chain_.nodes) mesh.points.push_back({p.x, p.y, 0});
    for (const Piece& piece : pieces_) {
      int last = piece.ends[0];
      for (const double t : piece.interior) {
        const Vec2 p = piece.shape->point(t);
        const int next = static_cast<int>(mesh.points.size());
        mesh.points.push_back({p.x, p.y, 0});
        mesh.lines.push_back({last, next});
        last = next;
      }
      mesh.lines.push_back({last, piece.ends[1]});
      mesh.line_curve.resize(mesh.lines.size(), piece.curve < 0 ? whisker_curve() : piece.curve);
    }
    mesh.curves = curves_;
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
    check_embedded(lines, arrangement, regions);
    PlanarDomain domain = build_domain(std::move(lines), arrangement, std::move(regions), names,
                                       {cracks(), has_whiskers() ? whisker_curve() : -1, true});
    check_loops_apart(loop_edges(), names);
    domain.places = places();
    domain.places.resize(domain.boundary.points.size());
    for (const int v : domain.on_crack) domain.places[v] = {};
    for (const Piece& piece : pieces_)
      if (piece.curve >= 0) domain.pieces.push_back({piece.ends, piece.shape, piece.from, piece.to});
    domain.model_curves = of_curve_;
    domain.model_curves.resize(domain.boundary.curves.size());
    if (domain.has_junctions) drop_stray_lines(domain);
    return domain;
  }

 private:
  bool has_whiskers() const { return pieces_.back().curve < 0; }
  int whisker_curve() const { return static_cast<int>(curves_.size()); }
  std::string prefix() const { return model_.source.empty() ? "" : model_.source + ": "; }

  BoundaryNames names() const {
    return {model_.source,
            [this](int c) {
              return c == whisker_curve() ? "the edge at a point" : curve_label(model_, of_curve_[c].front());
            },
            "the curves meet there, or the size is too large to keep them apart",
            has_whiskers() ? whisker_curve() : -1};
  }

  /// Of the mesh's points.
  std::vector<CurvePlace> places() const {
    std::vector<CurvePlace> places(chain_.nodes.size());
    for (const Piece& piece : pieces_)
      if (piece.curve < 0) places[piece.ends[1]].is_free = true;
    for (const Piece& piece : pieces_)
      for (const double t : piece.interior) places.push_back({piece.shape, t, piece.from, piece.to});
    return places;
  }

  std::vector<std::vector<int>> loops_of_model_curves() const {
    std::vector<std::vector<int>> loops(model_.curves.size());
    for (std::size_t l = 0; l < chain_.loops.size(); ++l)
      for (const int c : chain_.loops[l].curves) loops[c].push_back(static_cast<int>(l));
    return loops;
  }

  std::vector<std::vector<int>> loops_of_curve() const {
    const auto of_model = loops_of_model_curves();
    std::vector<std::vector<int>> loops(curves_.size() + has_whiskers());
    for (std::size_t c = 0; c < of_curve_.size(); ++c)
      for (const int m : of_curve_[c])
        loops[c].insert(loops[c].end(), of_model[m].begin(), of_model[m].end());
    return loops;
  }

  /// By curve of the mesh; empty: none.
  std::vector<char> cracks() const {
    std::vector<char> cracks;
    for (const std::vector<int>& of : of_curve_)
      cracks.push_back(std::ranges::any_of(of, [&](int c) { return model_.curves[c].is_crack; }));
    if (std::ranges::find(cracks, 1) == cracks.end()) return {};
    cracks.resize(curves_.size() + has_whiskers(), 0);
    return cracks;
  }

  /// All edges, each with the connected curves that it is of.
  std::vector<LoopEdge> loop_edges() const {
    std::vector<int> joined(chain_.nodes.size());
    std::iota(joined.begin(), joined.end(), 0);
    const auto root = [&](int v) {
      while (joined[v] != v) v = joined[v] = joined[joined[v]];
      return v;
    };
    for (const Piece& piece : pieces_) {
      const int a = root(piece.ends[0]), b = root(piece.ends[1]);
      joined[std::max(a, b)] = std::min(a, b);
    }
    std::vector<LoopEdge> edges;
    for (const Piece& piece : pieces_) {
      if (piece.curve < 0) continue;
      double t = piece.from;
      Vec2 p = chain_.nodes[piece.ends[0]];
      for (std::size_t i = 0; i <= piece.interior.size(); ++i) {
        const bool is_last = i == piece.interior.size();
        const double next = is_last ? piece.to : piece.interior[i];
        const Vec2 q = is_last ? chain_.nodes[piece.ends[1]] : piece.shape->point(next);
        edges.push_back({piece.shape.get(), t, next, p, q, root(piece.ends[0]), piece.curve});
        t = next;
        p = q;
      }
    }
    return edges;
  }

  void cut_at_stops() {
    for (std::size_t c = 0; c < model_.curves.size(); ++c) {
      std::vector<CurveStop> stops = chain_.stops[c];
      stops.push_back({1, chain_.curve_ends[c][1]});
      double t = 0;
      int node = chain_.curve_ends[c][0];
      for (const auto& [stop, next] : stops) {
        pieces_.push_back({{static_cast<int>(c)}, {node, next}, model_.curves[c].shape, t, stop});
        t = stop;
        node = next;
      }
    }
  }

  /// Of those that lie on each other the first one stays.
  void join_equal_pieces() {
    std::map<std::pair<int, int>, std::vector<std::size_t>> by_ends;
    for (std::size_t i = 0; i < pieces_.size(); ++i) by_ends[pieces_[i].sorted_ends()].push_back(i);
    std::vector<char> is_copy(pieces_.size(), 0);
    for (const auto& [ends, group] : by_ends) {
      for (std::size_t j = 1; j < group.size(); ++j) {
        for (std::size_t i = 0; i < j && !is_copy[group[j]]; ++i) {
          if (is_copy[group[i]] || !are_equal(pieces_[group[i]], pieces_[group[j]])) continue;
          is_copy[group[j]] = 1;
          pieces_[group[i]].curves.push_back(pieces_[group[j]].curves[0]);
        }
      }
    }
    std::vector<Piece> kept;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (!is_copy[i]) kept.push_back(std::move(pieces_[i]));
    pieces_ = std::move(kept);
  }

  /// Of two pieces with the same ends, whether some places of one lie on the other.
  bool are_equal(const Piece& a, const Piece& b) const {
    if (a.curves == b.curves) return false;
    Box<Vec2> all = Box<Vec2>::around(std::span(chain_.nodes));
    const double tolerance = kTouch * norm(all.size());
    const CurveSpan other(*b.shape, b.from, b.to);
    return std::ranges::all_of(std::array{0.21, 0.5, 0.83}, [&](double s) {
      return other.nearest(a.shape->point(a.from + s * (a.to - a.from))).distance <= tolerance;
    });
  }

  /// Curves of different loops that meet have an angle between them: else they would enclose nothing but
  /// slivers.
  void check_angles() const {
    constexpr double kLeast = 1e-4;  // radians
    struct End {
      int node;
      double angle;
      const Piece* piece;
    };
    std::vector<End> ends;
    for (const Piece& p : pieces_) {
      const double step = 1e-6 * (p.to - p.from);
      for (const int k : {0, 1}) {
        const double t = k == 0 ? p.from : p.to;
        const Vec2 d = p.shape->point(k == 0 ? t + step : t - step) - p.shape->point(t);
        ends.push_back({p.ends[k], std::atan2(d.y, d.x), &p});
      }
    }
    std::ranges::sort(ends, {}, [](const End& e) { return std::pair(e.node, e.angle); });
    const auto loops = loops_of_model_curves();
    const auto apart = [&](const Piece& p, const Piece& q) {
      return p.curves != q.curves && (loops[p.curves[0]].empty() || loops[p.curves[0]] != loops[q.curves[0]]);
    };
    for (auto first = ends.begin(); first != ends.end();) {
      const auto last = std::find_if(first, ends.end(), [&](const End& e) { return e.node != first->node; });
      for (auto e = first; e != last; ++e) {
        const auto next = e + 1 == last ? first : e + 1;
        const double turn = next->angle - e->angle + (next == first ? 2 * std::numbers::pi : 0);
        if (next == e || turn >= kLeast || !apart(*e->piece, *next->piece)) continue;
        const Vec2 at = chain_.nodes[e->node];
        throw InputError(fmt::format("{}{} and {} touch at ({:.4g}, {:.4g}), without an angle between them",
                                     prefix(), curve_label(model_, e->piece->curves[0]),
                                     curve_label(model_, next->piece->curves[0]), at.x, at.y));
      }
      first = last;
    }
  }

  void measure(const PointSize& size, double max_edges) {
    double total = 0;
    for (Piece& p : pieces_) {
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
  void name_curves() {
    for (std::size_t c = 0; c < model_.curves.size(); ++c) {
      Entity curve{static_cast<int>(c) + 1, {}};
      if (!model_.curves[c].name.empty()) curve.names.push_back(model_.curves[c].name);
      curves_.push_back(std::move(curve));
      of_curve_.push_back({static_cast<int>(c)});
    }
    std::map<std::vector<int>, int> known;
    for (Piece& piece : pieces_) {
      piece.curve = piece.curves[0];
      if (piece.curves.size() == 1) continue;
      const auto [at, is_new] = known.try_emplace(piece.curves, static_cast<int>(curves_.size()));
      piece.curve = at->second;
      if (!is_new) continue;
      Entity& curve = curves_.emplace_back(Entity{static_cast<int>(curves_.size()) + 1, {}});
      of_curve_.push_back(piece.curves);
      for (const int c : piece.curves)
        if (const std::string& name = model_.curves[c].name;
            !name.empty() && std::ranges::find(curve.names, name) == curve.names.end())
          curve.names.push_back(name);
    }
  }

  // A closed piece needs three edges, two between the same nodes two each: else they would fold up. One by
  // itself needs two: else it could not be opened (see build_domain()).
  void set_least() {
    std::map<std::pair<int, int>, int> count;
    for (const Piece& p : pieces_) ++count[p.sorted_ends()];
    const std::vector<int> valence = this->valence();
    for (Piece& p : pieces_) {
      const bool is_single = valence[p.ends[0]] == 1 && valence[p.ends[1]] == 1;
      p.least = p.ends[0] == p.ends[1] ? 3 : count[p.sorted_ends()] > 1 || is_single ? 2 : 1;
    }
  }

  /// How many pieces end at each node.
  std::vector<int> valence() const {
    std::vector<int> valence(chain_.nodes.size(), 0);
    for (const Piece& p : pieces_)
      for (const int v : p.ends) ++valence[v];
    return valence;
  }

  /// Points that are on no curve get two edges.
  void add_whiskers(const PointSize& size) {
    std::vector<char> has_piece(chain_.nodes.size(), 0);
    for (const Piece& p : pieces_)
      for (const int v : p.ends) has_piece[v] = 1;
    std::vector<int> nodes;
    std::vector<Vec2> points;
    std::vector<double> sizes;
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < model_.points.size(); ++i) {
      const int v = chain_.point_nodes[i];
      if (has_piece[v]) continue;
      has_piece[v] = 1;
      nodes.push_back(v);
      points.push_back(chain_.nodes[v]);
      sizes.push_back(size({points.back().x, points.back().y, 0}));
      labels.push_back(prefix() + point_label(model_, static_cast<int>(i)));
    }
    if (nodes.empty()) return;
    std::vector<CurveSpan> curves;
    for (const Piece& p : pieces_) curves.emplace_back(*p.shape, p.from, p.to);
    const auto ends = whisker_ends(curves, points, sizes, labels);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const Vec2 end : ends[i]) {
        pieces_.push_back(
            {{}, {nodes[i], static_cast<int>(chain_.nodes.size())}, make_segment(points[i], end)});
        chain_.nodes.push_back(end);
      }
  }

  /// Pieces whose edges must be even in number, each group by itself, where all loops are apart: components,
  /// and interfaces.
  std::vector<std::vector<int>> even_groups(const Arrangement& arrangement,
                                            const FaceRegions& regions) const {
    const auto is_filled = [&](int face) { return face >= 0 && regions.region[face] >= 0; };
    // The plain holes of a region are counted with its outer loop, unless that is an interface, even by
    // itself.
    const std::size_t n = arrangement.faces.size();
    std::vector<std::vector<int>> outlines(n), holes(n);
    std::size_t line = 0;
    for (std::size_t i = 0; i < pieces_.size(); line += pieces_[i++].n) {
      const int left = arrangement.face_of[2 * line], right = arrangement.face_of[2 * line + 1];
      const int inner = left >= 0 && arrangement.faces[left].around == right ? left : right;
      const int around = arrangement.faces[inner].around;
      if (is_filled(inner))
        outlines[inner].push_back(static_cast<int>(i));
      else
        (is_filled(around) && is_filled(arrangement.faces[around].around) ? holes : outlines)[around]
            .push_back(static_cast<int>(i));
    }
    outlines.insert(outlines.end(), holes.begin(), holes.end());
    return outlines;
  }

  bool loops_are_apart() const {
    return std::ranges::all_of(valence(), [](int n) { return n == 2; });
  }

  void make_even() {
    const Mesh lines = mesh();
    const BoundaryNames names = this->names();
    const Arrangement arrangement = arrange_lines(lines, names);
    const FaceRegions regions = regions_of_loops(lines, arrangement, chain_.loops, loops_of_curve(), names);
    if (!loops_are_apart()) return change_by_t_join(arrangement, regions);
    for (const std::vector<int>& group : even_groups(arrangement, regions)) {
      int total = 0;
      for (int i : group) total += pieces_[i].n;
      if (total % 2 != 0) change_by_one(group);
    }
  }

  /// The cheapest way to an edge more or less, and its cost.
  std::pair<int, double> cheapest_change(const Piece& p) const {
    int best = p.n + 1;
    double least_cost = std::numeric_limits<double>::infinity();
    for (int n : {p.n + 1, p.n - 1}) {
      if (n < p.least) continue;
      const double cost = std::abs(std::log(n / p.measure->integral()));
      if (cost >= least_cost) continue;
      best = n;
      least_cost = cost;
    }
    return {best, least_cost};
  }

  void change_by_one(const std::vector<int>& group) {
    const auto best =
        std::ranges::min_element(group, {}, [&](int i) { return cheapest_change(pieces_[i]).second; });
    pieces_[*best].set_edges(cheapest_change(pieces_[*best]).first);
  }

  /// Every face with a region gets an even number of sides at the least cost; the others do not matter, and
  /// are one node of the graph.
  void change_by_t_join(const Arrangement& arrangement, const FaceRegions& regions) {
    const int rest = static_cast<int>(regions.region.size());
    const auto node_of = [&](int face) { return face < 0 || regions.region[face] < 0 ? rest : face; };
    WeightedGraph graph{rest + 1, {}};
    std::vector<std::size_t> piece_of;
    std::vector<int> sides(graph.n_nodes, 0);
    std::size_t line = 0;
    for (std::size_t i = 0; i < pieces_.size(); line += pieces_[i++].n) {
      const int a = node_of(arrangement.face_of[2 * line]), b = node_of(arrangement.face_of[2 * line + 1]);
      if (a == b) continue;
      for (const int face : {a, b}) sides[face] += pieces_[i].n;
      graph.edges.push_back({a, b, cheapest_change(pieces_[i]).second});
      piece_of.push_back(i);
    }
    std::vector<int> odd;
    for (int face = 0; face < rest; ++face)
      if (sides[face] % 2 != 0) odd.push_back(face);
    if (odd.size() % 2 != 0) odd.push_back(rest);
    for (const int e : minimum_t_join(graph, odd, *matching_solver(matching_solver_names().front())).edges) {
      Piece& piece = pieces_[piece_of[e]];
      piece.set_edges(cheapest_change(piece).first);
    }
  }

  /// Points with whiskers lie in a region, and curves that no loop has on no boundary.
  void check_embedded(const Mesh& lines, const Arrangement& arrangement, const FaceRegions& regions) const {
    const auto loops = loops_of_model_curves();
    const auto is_filled = [&](std::size_t side) {
      const int face = arrangement.face_of[side];
      return face >= 0 && regions.region[face] >= 0;
    };
    std::size_t line = 0;
    for (std::size_t i = 0; i < pieces_.size(); line += pieces_[i++].n) {
      const Piece& piece = pieces_[i];
      const Vec3 &a = lines.points[piece.ends[0]], &b = lines.points[piece.ends[1]];
      const bool is_inside = is_filled(2 * line) && is_filled(2 * line + 1);
      if (is_inside) continue;
      if (piece.curve < 0) {
        const auto at = std::ranges::find(chain_.point_nodes, piece.ends[0]) - chain_.point_nodes.begin();
        throw InputError(fmt::format("{}{} at ({:.10g}, {:.10g}) lies outside of every region", prefix(),
                                     point_label(model_, static_cast<int>(at)), a.x, a.y));
      }
      const auto embedded = std::ranges::find_if(piece.curves, [&](int c) { return loops[c].empty(); });
      const auto bounding = std::ranges::find_if(piece.curves, [&](int c) { return !loops[c].empty(); });
      if (embedded != piece.curves.end() && !is_filled(2 * line) && !is_filled(2 * line + 1))
        throw InputError(
            fmt::format("{}{} lies outside of every region from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g})",
                        prefix(), curve_label(model_, *embedded), a.x, a.y, b.x, b.y));
      if (embedded == piece.curves.end() || bounding == piece.curves.end()) continue;
      throw InputError(fmt::format(
          "{}{} lies on the boundary, {}, between ({:.10g}, {:.10g}) and ({:.10g}, {:.10g}): "
          "expected it inside of a region, or across",
          prefix(), curve_label(model_, *embedded), curve_label(model_, *bounding), a.x, a.y, b.x, b.y));
    }
  }

  const PlanarModel& model_;
  ModelChain chain_;
  std::vector<Piece> pieces_;
  std::vector<Entity> curves_;              ///< of the mesh
  std::vector<std::vector<int>> of_curve_;  ///< the model's curves of each
};

}  // namespace

Mesh mesh_curves(const PlanarModel& model, const PointSize& size, const CurveMeshOptions& options) {
  return CurveMesher(model, size, options).mesh();
}

PlanarDomain make_domain(const PlanarModel& model, const PointSize& size, const CurveMeshOptions& options) {
  return CurveMesher(model, size, options).domain();
}

}  // namespace delquad
