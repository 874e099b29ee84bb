#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "delquad/error.h"
#include "geometry/planar/arc_measure.h"
#include "geometry/planar/domain_builder.h"
#include "geometry/planar/loops_apart.h"
#include "geometry/planar/model_chain.h"
#include "geometry/planar/planar_model.h"

namespace delquad {

namespace {

/// The part of a curve between two compulsory nodes.
struct Piece {
  int curve;
  std::array<int, 2> ends;  ///< nodes
  ArcMeasure measure;
  int least = 1;  ///< fewest edges
  int n = 0;      ///< edges
  double from = 0, to = 1;
  std::vector<double> interior = {};  ///< parameters of its nodes

  void set_edges(int edges) {
    n = edges;
    interior = measure.interior_nodes(n);
  }
};

class CurveMesher {
 public:
  CurveMesher(const PlanarModel& model, const PointSize& size, const CurveMeshOptions& options)
      : model_(model), chain_(chain_model(model)) {
    cut_at_corners(size, options.max_edges);
    set_least();
    for (Piece& p : pieces_)
      p.set_edges(std::max(p.least, static_cast<int>(std::lround(p.measure.integral()))));
    make_even();
  }

  Mesh mesh() const {
    Mesh mesh;
    for (Vec2 p : chain_.nodes) mesh.points.push_back({p.x, p.y, 0});
    for (const Piece& piece : pieces_) {
      int last = piece.ends[0];
      for (const double t : piece.interior) {
        const Vec2 p = model_.curves[static_cast<std::size_t>(piece.curve)].shape->point(t);
        const int next = static_cast<int>(mesh.points.size());
        mesh.points.push_back({p.x, p.y, 0});
        mesh.lines.push_back({last, next});
        last = next;
      }
      mesh.lines.push_back({last, piece.ends[1]});
      mesh.line_curve.resize(mesh.lines.size(), piece.curve);
    }
    for (std::size_t c = 0; c < model_.curves.size(); ++c) {
      Entity curve{static_cast<int>(c) + 1, {}};
      if (!model_.curves[c].name.empty()) curve.names.push_back(model_.curves[c].name);
      mesh.curves.push_back(std::move(curve));
    }
    return mesh;
  }

  /// Of the mesh's points.
  std::vector<CurvePlace> places() const {
    std::vector<CurvePlace> places(chain_.nodes.size());
    for (const Piece& piece : pieces_)
      for (const double t : piece.interior)
        places.push_back(
            {model_.curves[static_cast<std::size_t>(piece.curve)].shape, t, piece.from, piece.to});
    return places;
  }

  /// The regions that the model names, each by a node of its loop.
  std::vector<std::pair<int, std::string>> loop_regions() const {
    std::vector<std::pair<int, std::string>> regions;
    for (const ModelLoop& loop : chain_.loops)
      if (!loop.region.empty())
        regions.emplace_back(chain_.curve_ends[static_cast<std::size_t>(loop.curves[0])][0], loop.region);
    return regions;
  }

  /// All edges, each with the loop that its curve is on.
  std::vector<LoopEdge> loop_edges() const {
    std::vector<int> loop_of(model_.curves.size(), -1);
    for (std::size_t l = 0; l < chain_.loops.size(); ++l)
      for (const int c : chain_.loops[l].curves) loop_of[static_cast<std::size_t>(c)] = static_cast<int>(l);
    std::vector<LoopEdge> edges;
    for (const Piece& piece : pieces_) {
      const auto c = static_cast<std::size_t>(piece.curve);
      const Curve* shape = model_.curves[c].shape.get();
      double t = piece.from;
      Vec2 p = chain_.nodes[static_cast<std::size_t>(piece.ends[0])];
      for (std::size_t i = 0; i <= piece.interior.size(); ++i) {
        const bool is_last = i == piece.interior.size();
        const double next = is_last ? piece.to : piece.interior[i];
        const Vec2 q = is_last ? chain_.nodes[static_cast<std::size_t>(piece.ends[1])] : shape->point(next);
        edges.push_back({shape, t, next, p, q, loop_of[c], piece.curve});
        t = next;
        p = q;
      }
    }
    return edges;
  }

  BoundaryNames names() const {
    return {model_.source, [this](int c) { return curve_label(model_, c); },
            "the curves meet there, or the size is too large to keep them apart"};
  }

 private:
  void cut_at_corners(const PointSize& size, double max_edges) {
    double total = 0;
    for (std::size_t c = 0; c < model_.curves.size(); ++c) {
      const Curve& shape = *model_.curves[c].shape;
      const std::string prefix = model_.source.empty() ? "" : model_.source + ": ";
      const std::string label = prefix + curve_label(model_, static_cast<int>(c));
      std::vector<double> stops = shape.fixed_parameters();
      stops.push_back(1);
      double t = 0;
      int node = chain_.curve_ends[c][0];
      for (double stop : stops) {
        int next = chain_.curve_ends[c][1];
        if (stop < 1) {
          next = static_cast<int>(chain_.nodes.size());
          chain_.nodes.push_back(shape.point(stop));
        }
        pieces_.push_back(
            {static_cast<int>(c), {node, next}, ArcMeasure(shape, t, stop, size, label, max_edges - total)});
        pieces_.back().from = t;
        pieces_.back().to = stop;
        total += pieces_.back().measure.integral();
        t = stop;
        node = next;
      }
    }
    if (total > max_edges)
      throw InputError(
          fmt::format("{}{}the boundary needs about {:.3g} edges of this size; at most {:.3g} are allowed",
                      model_.source, model_.source.empty() ? "" : ": ", total, max_edges));
  }

  // A loop of one piece needs three edges, one of two pieces two on each: else it would fold up.
  void set_least() {
    std::vector<std::vector<Piece*>> of_curve(model_.curves.size());
    for (Piece& p : pieces_) of_curve[static_cast<std::size_t>(p.curve)].push_back(&p);
    for (const ModelLoop& loop : chain_.loops) {
      std::vector<Piece*> pieces;
      for (int c : loop.curves)
        pieces.insert(pieces.end(), of_curve[static_cast<std::size_t>(c)].begin(),
                      of_curve[static_cast<std::size_t>(c)].end());
      if (pieces.size() > 2) continue;
      for (Piece* p : pieces) p->least = pieces.size() == 1 ? 3 : 2;
    }
  }

  // Components and interfaces, as pieces whose edges must be even in number.
  std::vector<std::vector<int>> even_groups() const {
    const Mesh lines = mesh();
    const std::vector<BoundaryLoop> loops = find_loops(lines, names());
    const std::vector<int> loop_of = loop_of_nodes(loops, lines.points.size());
    std::vector<bool> named(loops.size(), false);
    for (const auto& [node, name] : loop_regions())
      named[static_cast<std::size_t>(loop_of[static_cast<std::size_t>(node)])] = true;
    const std::vector<bool> filled = filled_loops(loops, named);
    const auto is_interface = [&](std::size_t l) {
      return filled[l] && loops[l].parent >= 0 && filled[static_cast<std::size_t>(loops[l].parent)];
    };
    // The plain holes of a region are counted with its outer loop, unless that is an interface, even by
    // itself.
    std::vector<std::vector<int>> outlines(loops.size()), holes(loops.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const auto loop = static_cast<std::size_t>(loop_of[static_cast<std::size_t>(pieces_[i].ends[0])]);
      const auto parent = static_cast<std::size_t>(std::max(loops[loop].parent, 0));
      if (filled[loop])
        outlines[loop].push_back(static_cast<int>(i));
      else
        (is_interface(parent) ? holes : outlines)[parent].push_back(static_cast<int>(i));
    }
    outlines.insert(outlines.end(), holes.begin(), holes.end());
    return outlines;
  }

  void make_even() {
    for (const std::vector<int>& group : even_groups()) {
      int total = 0;
      for (int i : group) total += pieces_[static_cast<std::size_t>(i)].n;
      if (total % 2 != 0) change_by_one(group);
    }
  }

  void change_by_one(const std::vector<int>& group) {
    double least_cost = 0;
    Piece* best = nullptr;
    int best_n = 0;
    for (int i : group) {
      Piece& p = pieces_[static_cast<std::size_t>(i)];
      for (int n : {p.n + 1, p.n - 1}) {
        if (n < p.least) continue;
        const double cost = std::abs(std::log(n / p.measure.integral()));
        if (best && cost >= least_cost) continue;
        best = &p;
        best_n = n;
        least_cost = cost;
      }
    }
    best->set_edges(best_n);
  }

  const PlanarModel& model_;
  ModelChain chain_;
  std::vector<Piece> pieces_;
};

}  // namespace

Mesh mesh_curves(const PlanarModel& model, const PointSize& size, const CurveMeshOptions& options) {
  return CurveMesher(model, size, options).mesh();
}

PlanarDomain make_domain(const PlanarModel& model, const PointSize& size, const CurveMeshOptions& options) {
  const CurveMesher mesher(model, size, options);
  PlanarDomain domain = build_domain(mesher.mesh(), mesher.loop_regions(), mesher.names());
  check_loops_apart(mesher.loop_edges(), mesher.names());
  domain.places = mesher.places();
  return domain;
}

}  // namespace delquad
