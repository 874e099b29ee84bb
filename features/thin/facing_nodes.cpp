#include "features/thin/facing_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

#include "base/box_tree.h"
#include "base/segment.h"
#include "geometry/mesh/quad_corners.h"
#include "patches/boundary_cap.h"

namespace delquad {
namespace {

/// Samples of phases, an edge.
constexpr double kPerEdge = 4;
/// Curves face each other up to so many sizes apart,
constexpr double kReach = 1.5;
/// where the way across is within so much (sine) of a normal, and tangents are as parallel.
constexpr double kAside = 0.6, kParallel = 0.8;
/// In corners of less than this angle, up to so many sizes wide, two rows of quads lie between nodes that
/// face each other: a single one could only end in a flat quad.
constexpr double kSharp = kLeastSharedAngle, kWedge = 0.5;
/// So many edges behind a wedge nodes are free to come from one way of facing each other to the other.
constexpr double kBehind = 3;
/// Weight of edges that are longer or shorter than the size. A pair of facing nodes has the square of size
/// over gap as its weight, up to a limit, which is higher in wedges.
constexpr double kStiffness = 20, kMostWeight = 4, kMostInWedges = 1e4;
/// Where the difference of phases jumps by more, as at the beginning of a closed curve, a new strip begins.
constexpr double kJump = 0.75;
constexpr int kNumberings = 2, kSweeps = 3;
/// Edges are no shorter than this part of equal ones.
constexpr double kShortest = 0.3;

/// A link from a sample to the place across from it.
struct Link {
  int at;           ///< sample
  double other_at;  ///< place between samples of the other piece
  double weight;
};

/// A part of a piece that faces a part of another one, or of itself.
struct Strip {
  std::array<int, 2> sides;  ///< 2 i: on the left of piece i; 2 i + 1: on its right
  int sign;                  ///< -1: they run against each other
  int wedge;                 ///< lies in that which begins before this side; -1: in none
  std::vector<Link> links = {};
  double weight = 0;
  double shift = 0;  ///< phase of the first, without `sign` times that of the other
  bool counts = false;
};

/// An end of a side, up to the phase where a wedge ends that begins there.
struct WedgeEnd {
  int sign;  ///< 1: of the beginning
  double phase;
  int corner = -1;  ///< the side after it; -1: none
};

struct Track {
  bool is_free, has_images;
  double natural;              ///< edges by the size
  double end;                  ///< edges
  std::vector<Vec2> points;    ///< at the samples
  std::vector<double> phases;  ///< there
  std::vector<int> strips = {};

  void reset() {
    const auto m = static_cast<double>(phases.size() - 1);
    for (std::size_t k = 0; k < phases.size(); ++k) phases[k] = end * static_cast<double>(k) / m;
  }
  double phase(double at) const {
    const std::size_t i = std::min(static_cast<std::size_t>(at), phases.size() - 2);
    return phases[i] + (at - static_cast<double>(i)) * (phases[i + 1] - phases[i]);
  }
};

class FacingNodes {
 public:
  FacingNodes(const Arrangement& arrangement, const FaceRegions& regions, std::vector<CurvePiece>& pieces)
      : pieces_(pieces) {
    collect_loops(arrangement, regions);
    for (const CurvePiece& p : pieces) tracks_.push_back(track_of(p));
    for (const CurvePiece& p : pieces)
      if (p.master >= 0) tracks_[p.master].has_images = true;
    for (const Track& t : tracks_)
      wedges_.insert(wedges_.end(), 2, {WedgeEnd{1, 0}, WedgeEnd{-1, t.natural}});
    for (const std::vector<int>& loop : loops_)
      for (std::size_t i = 0; i < loop.size(); ++i) find_wedge(loop, i);
    find_strips();
  }

  /// How many edges each piece wants, a whole number or not.
  std::vector<double> wanted() {
    solve_all(true);
    std::vector<double> wanted;
    for (const Track& t : tracks_) wanted.push_back(t.end);
    return wanted;
  }

  void place() {
    solve_all(false);
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      if (tracks_[p].is_free && !tracks_[p].strips.empty()) place(tracks_[p], pieces_[p]);
  }

 private:
  static Track track_of(const CurvePiece& p) {
    const bool is_free = p.measure && !p.is_divided && p.master < 0;
    const double natural = is_free ? p.measure->integral() : p.n;
    const int m = is_free ? std::max(2, static_cast<int>(std::ceil(kPerEdge * natural))) : p.n;
    std::vector<double> places = p.interior;
    if (is_free) {
      places.clear();
      for (int k = 1; k < m; ++k) places.push_back(natural * k / m);
      places = p.measure->nodes_at(places);
    }
    Track track{is_free, p.master >= 0, natural, natural, {}, std::vector<double>(places.size() + 2)};
    track.points.push_back(p.shape->point(p.from));
    for (const double t : places) track.points.push_back(p.shape->point(t));
    track.points.push_back(p.shape->point(p.to));
    track.reset();
    return track;
  }

  /// The loops around faces with regions, as sides of pieces.
  void collect_loops(const Arrangement& arrangement, const FaceRegions& regions) {
    std::vector<int> first, last;  // the piece that begins or ends with this line; -1: none
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const std::size_t begin = first.size();
      first.resize(begin + static_cast<std::size_t>(pieces_[i].n), -1);
      last.resize(first.size(), -1);
      first[begin] = last.back() = static_cast<int>(i);
    }
    face_of_.assign(2 * pieces_.size(), -1);
    loop_of_ = base_ = face_of_;
    for (std::size_t f = 0; f < arrangement.faces.size(); ++f) {
      if (regions.region[f] < 0) continue;
      for (const Arrangement::Cycle& cycle : arrangement.faces[f].cycles) {
        std::vector<int>& loop = loops_.emplace_back();
        for (const int line_side : cycle) {
          const int piece = (line_side % 2 == 0 ? first : last)[line_side / 2];
          if (piece < 0) continue;
          const int side = 2 * piece + line_side % 2;
          loop.push_back(side);
          face_of_[side] = static_cast<int>(f);
          loop_of_[side] = static_cast<int>(loops_.size()) - 1;
        }
      }
    }
  }

  /// Goes away from a corner on both sides, as far as the wedge between them is narrow; not further than half
  /// the way to an end that is no sharp corner: there one row lies between nodes.
  void find_wedge(const std::vector<int>& loop, std::size_t corner) {
    struct Way {
      std::size_t at;     ///< side in the loop
      double before = 0;  ///< edges of those before
    };
    const std::size_t n = loop.size();
    std::array<Way, 2> ways{Way{corner}, Way{(corner + n - 1) % n}};  // onwards, and back
    double total = 0;
    for (const int side : loop) total += tracks_[side / 2].natural;
    std::vector<std::array<std::pair<WedgeEnd*, double>, 2>> reached;
    bool is_lens = false;
    for (double edges = 1 / kPerEdge; edges < total / 2; edges += 1 / kPerEdge) {
      std::array<Vec2, 2> x;
      reached.emplace_back();
      double size = std::numeric_limits<double>::infinity();
      for (const std::size_t k : {0, 1}) {
        Way& way = ways[k];
        for (; edges - way.before > tracks_[loop[way.at] / 2].natural;
             way.at = (way.at + (k == 0 ? 1 : n - 1)) % n)
          way.before += tracks_[loop[way.at] / 2].natural;
        const int side = loop[way.at];
        const Track& track = tracks_[side / 2];
        const bool is_along = (side % 2 == 0) == (k == 0);
        const double phase = is_along ? edges - way.before : track.natural - (edges - way.before);
        reached.back()[k] = {&wedges_[side][is_along ? 0 : 1], phase};
        const auto m = static_cast<double>(track.points.size() - 1);
        const double at = phase * m / track.natural;
        const std::size_t i = std::min(static_cast<std::size_t>(at), track.points.size() - 2);
        const Vec2 along = track.points[i + 1] - track.points[i];
        x[k] = track.points[i] + (at - static_cast<double>(i)) * along;
        size = std::min(size, norm(along) * m / track.natural);
      }
      const double width = norm(x[1] - x[0]) / size;
      is_lens = width <= kSharp * (total / 2 - edges);
      if (width > std::min(kWedge, kSharp * edges)) {
        reached.pop_back();
        is_lens = false;
        break;
      }
    }
    if (!is_lens) reached.resize(std::min(reached.size(), static_cast<std::size_t>(kPerEdge * total / 4)));
    for (const auto& step : reached)
      for (const auto& [end, phase] : step)
        if (end->sign * (phase - end->phase) > 0) end->phase = phase, end->corner = loop[corner];
  }
  /// In which both places are; -1: in none.
  int wedge_of(std::array<int, 2> sides, std::array<double, 2> phases) const {
    for (const WedgeEnd& a : wedges_[sides[0]])
      for (const WedgeEnd& b : wedges_[sides[1]])
        if (a.corner == b.corner && a.sign * (a.phase - phases[0]) >= 0 &&
            b.sign * (b.phase - phases[1]) >= 0)
          return a.corner;
    return -1;
  }

  bool is_behind_wedge(int side, double phase) const {
    return std::ranges::any_of(wedges_[side], [&](const WedgeEnd& end) {
      const double behind = end.sign * (phase - end.phase);
      return end.corner >= 0 && behind > 0 && behind < kBehind;
    });
  }

  void find_strips() {
    std::vector<Box<Vec2>> boxes;
    for (std::size_t p = 0; p < tracks_.size(); ++p)
      for (std::size_t k = 0; k + 1 < tracks_[p].points.size(); ++k) {
        const Vec2 a = tracks_[p].points[k], b = tracks_[p].points[k + 1];
        boxes.push_back({lower(a, b), upper(a, b)});
        segments_.emplace_back(static_cast<int>(p), static_cast<int>(k));
      }
    tree_ = BoxTree<Vec2>(boxes);
    for (std::size_t p = 0; p < tracks_.size(); ++p) {
      if (tracks_[p].has_images) continue;
      std::array<int, 2> strip{-1, -1};  // on either side
      double before[2];
      for (int j = 1; j + 1 < static_cast<int>(tracks_[p].points.size()); ++j)
        link(static_cast<int>(p), j, strip, before);
    }
  }

  /// Links one sample with what it faces on both sides.
  void link(int p, int j, std::array<int, 2>& strip, double (&before)[2]) {
    const Track& track = tracks_[p];
    const Vec2 x = track.points[j], chord = track.points[j + 1] - track.points[j - 1];
    const double spacing = norm(chord) / 2;
    const double size = spacing * static_cast<double>(track.points.size() - 1) / track.natural;
    const Vec2 tangent = 1 / norm(chord) * chord;
    std::array<double, 2> gap{}, where{};
    std::array<int, 2> found{-1, -1};
    for (const int side : {0, 1})
      if (face_of_[2 * p + side] >= 0) gap[side] = kReach * size;
    double limit2 = std::pow(std::max(gap[0], gap[1]), 2);
    tree_.nearest(x, limit2, [&](int i) {
      const auto [q, k] = segments_[i];
      if (q == p && std::abs(k - j) <= 2) return;
      const Vec2 a = tracks_[q].points[k], b = tracks_[q].points[k + 1];
      const double part = nearest_part(x, a, b);
      const Vec2 across = a + part * (b - a) - x;
      const double distance = norm(across);
      const int side = cross(tangent, across) > 0 ? 0 : 1;
      if (!(distance > 0) || distance >= gap[side] || std::abs(dot(across, tangent)) > kAside * distance)
        return;
      gap[side] = distance, found[side] = i, where[side] = k + part;
      limit2 = std::pow(std::max(gap[0], gap[1]), 2);
    });
    for (const int side : {0, 1}) {
      const int known = std::exchange(strip[side], -1);
      if (found[side] < 0) continue;
      const auto [q, k] = segments_[found[side]];
      const Track& other = tracks_[q];
      const Vec2 d = other.points[k + 1] - other.points[k];
      const double parallel = dot(d, tangent) / norm(d);
      const std::array sides{2 * p + side, 2 * q + (cross(d, x - other.points[k]) > 0 ? 0 : 1)};
      // Once from either side is enough.
      if (!(std::abs(parallel) > kParallel) || q < p || other.has_images ||
          !(track.is_free || other.is_free) || face_of_[sides[0]] != face_of_[sides[1]])
        continue;
      const int sign = parallel > 0 ? 1 : -1;
      if (is_behind_wedge(sides[0], track.phase(j)) || is_behind_wedge(sides[1], other.phase(where[side])))
        continue;
      const int wedge = wedge_of(sides, {track.phase(j), other.phase(where[side])});
      const double difference = track.phase(j) - sign * other.phase(where[side]);
      strip[side] = known;
      if (known < 0 || strips_[known].sides != sides || strips_[known].sign != sign ||
          strips_[known].wedge != wedge || std::abs(difference - before[side]) > kJump) {
        strip[side] = static_cast<int>(strips_.size());
        strips_.push_back({sides, sign, wedge});
        tracks_[p].strips.push_back(strip[side]);
        if (q != p) tracks_[q].strips.push_back(strip[side]);
      }
      before[side] = difference;
      const double slope = size / gap[side];
      const double weight = std::min(slope * slope, wedge < 0 ? kMostWeight : kMostInWedges) * spacing / size;
      strips_[strip[side]].weight += weight;
      strips_[strip[side]].links.push_back({j, where[side], weight});
    }
  }

  /// Where each side begins in its loop, in nodes, or ends, if that runs against the piece.
  void number_loops() {
    length_.resize(loops_.size());
    for (const std::vector<int>& loop : loops_) {
      int at = 0;
      for (const int side : loop) {
        if (side % 2 == 0) base_[side] = at;
        at += pieces_[side / 2].n;
        if (side % 2 == 1) base_[side] = at;
      }
      length_[loop_of_[loop[0]]] = at;
    }
  }

  /// The nearest whole number to the difference of phases of that parity for which a line between nodes that
  /// face each other has even numbers of edges on both sides. Where it joins two loops the first one tells.
  /// In wedges nodes face each other that are as many edges from the corner.
  void choose_shift(Strip& s) {
    double sum = 0;
    for (const Link& l : s.links)
      sum += l.weight *
             (tracks_[s.sides[0] / 2].phase(l.at) - s.sign * tracks_[s.sides[1] / 2].phase(l.other_at));
    const double difference = sum / s.weight;
    s.counts = true;
    if (s.wedge >= 0) {
      const int n = length_[loop_of_[s.wedge]],
                corner = base_[s.wedge] - (s.wedge % 2) * pieces_[s.wedge / 2].n;
      const int at = (s.sides[0] % 2 == 0 ? 1 : -1) * (2 * corner - base_[s.sides[0]] - base_[s.sides[1]]);
      s.shift = at + n * std::round((difference - at) / n);
      return;
    }
    const auto loops = std::minmax(loop_of_[s.sides[0]], loop_of_[s.sides[1]]);
    const int base = base_[s.sides[0]] + base_[s.sides[1]];
    const int nearest = static_cast<int>(std::lround(difference));
    const int parity =
        parity_.emplace(loops, loops.first == loops.second ? 1 : (base + nearest) & 1).first->second;
    const int odd = (base + parity) & 1;
    s.shift = 2 * std::round((difference - odd) / 2) + odd;
  }

  /// The phases of one piece, those of the others being as they are: a tridiagonal system.
  void solve(int piece, bool end_is_free) {
    Track& track = tracks_[piece];
    const std::size_t m = track.phases.size() - 1;
    const double step = (end_is_free ? track.natural : track.end) / static_cast<double>(m);
    const double stiff = kStiffness / step;
    std::vector<double> diagonal(m + 1, 0), above(m + 1, 0), right(m + 1, 0);
    for (std::size_t k = 0; k < m; ++k) {
      diagonal[k] += stiff, diagonal[k + 1] += stiff, above[k] -= stiff;
      right[k] -= stiff * step, right[k + 1] += stiff * step;
    }
    const auto want = [&](double at, double phase, double weight) {
      const std::size_t i = std::min(static_cast<std::size_t>(at), m - 1);
      const double b = at - static_cast<double>(i), a = 1 - b;
      diagonal[i] += weight * a * a, diagonal[i + 1] += weight * b * b, above[i] += weight * a * b;
      right[i] += weight * a * phase, right[i + 1] += weight * b * phase;
    };
    for (const int i : track.strips) {
      const Strip& s = strips_[i];
      const int p = s.sides[0] / 2, q = s.sides[1] / 2;
      if (!s.counts) continue;
      for (const Link& l : s.links) {
        if (p == piece) want(l.at, s.sign * tracks_[q].phase(l.other_at) + s.shift, l.weight);
        if (q == piece) want(l.other_at, s.sign * (tracks_[p].phase(l.at) - s.shift), l.weight);
      }
    }
    const std::size_t last = end_is_free ? m : m - 1;
    if (!end_is_free) right[m - 1] -= above[m - 1] * track.end;
    for (std::size_t k = 2; k <= last; ++k) {
      const double f = above[k - 1] / diagonal[k - 1];
      diagonal[k] -= f * above[k - 1];
      right[k] -= f * right[k - 1];
    }
    track.phases[0] = 0;
    track.phases[m] = track.end;
    for (std::size_t k = last; k >= 1; --k)
      track.phases[k] = (right[k] - (k < last ? above[k] * track.phases[k + 1] : 0)) / diagonal[k];
    track.end = track.phases[m];
  }

  void solve_all(bool ends_are_free) {
    number_loops();
    parity_.clear();
    for (Strip& s : strips_) s.counts = false;
    // How much a piece faces those that are done, its length, and its number.
    std::priority_queue<std::tuple<double, double, int>> waiting;
    std::vector<double> facing(tracks_.size(), 0);
    std::vector<char> is_done(tracks_.size(), 0);
    for (std::size_t p = 0; p < tracks_.size(); ++p) {
      Track& t = tracks_[p];
      t.end = ends_are_free && t.is_free ? t.natural : pieces_[p].n;
      t.reset();
      if (!t.strips.empty())
        waiting.emplace(t.is_free ? 0 : std::numeric_limits<double>::infinity(), t.natural,
                        -static_cast<int>(p));
    }
    while (!waiting.empty()) {
      const int p = -std::get<2>(waiting.top());
      waiting.pop();
      if (std::exchange(is_done[p], 1) != 0) continue;
      std::vector<int> known;
      for (const int i : tracks_[p].strips) {
        const int other = (strips_[i].sides[0] / 2 == p ? strips_[i].sides[1] : strips_[i].sides[0]) / 2;
        if (is_done[other]) {
          known.push_back(i);
        } else {
          facing[other] += strips_[i].weight;
          waiting.emplace(facing[other], tracks_[other].natural, -other);
        }
      }
      std::ranges::sort(known, {}, [&](int i) { return std::pair(-strips_[i].weight, i); });
      for (const int i : known) {
        choose_shift(strips_[i]);
        if (tracks_[p].is_free) solve(p, ends_are_free);
      }
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (Strip& s : strips_) choose_shift(s);
      for (std::size_t p = 0; p < tracks_.size(); ++p)
        if (tracks_[p].is_free && !tracks_[p].strips.empty()) solve(static_cast<int>(p), ends_are_free);
    }
  }

  /// Gives a piece the nodes of its phases, which are brought nearer to equal ones as far as they must be.
  static void place(Track& track, CurvePiece& piece) {
    std::vector<double>& phases = track.phases;
    const std::size_t m = phases.size() - 1;
    const double step = track.end / static_cast<double>(m);
    double least = step;
    for (std::size_t k = 0; k < m; ++k) least = std::min(least, phases[k + 1] - phases[k]);
    if (least < kShortest * step) {
      const double part = (1 - kShortest) * step / (step - least);
      for (std::size_t k = 0; k <= m; ++k)
        phases[k] = part * phases[k] + (1 - part) * step * static_cast<double>(k);
    }
    std::vector<double> nodes;
    std::size_t k = 0;
    for (int i = 1; i < piece.n; ++i) {
      while (k + 1 < m && phases[k + 1] < i) ++k;
      const double part = (i - phases[k]) / (phases[k + 1] - phases[k]);
      nodes.push_back((static_cast<double>(k) + part) * track.natural / static_cast<double>(m));
    }
    piece.interior = piece.measure->nodes_at(nodes);
  }

  std::vector<CurvePiece>& pieces_;
  std::vector<std::vector<int>> loops_;
  std::vector<int> face_of_, loop_of_, base_;  ///< of each side; -1: it has no region
  std::vector<int> length_;                    ///< of each loop, edges
  std::vector<Track> tracks_;
  std::vector<std::array<WedgeEnd, 2>> wedges_;  ///< of each side
  std::vector<Strip> strips_;
  std::vector<std::pair<int, int>> segments_;  ///< between samples: track and first sample
  BoxTree<Vec2> tree_;                         ///< of these
  std::map<std::pair<int, int>, int> parity_;  ///< of lines between two loops, see choose_shift()
};

}  // namespace

void face_nodes(const Arrangement& arrangement, const FaceRegions& regions, std::vector<CurvePiece>& pieces,
                const std::function<void(const std::vector<double>& wanted)>& number) {
  FacingNodes facing(arrangement, regions, pieces);
  number({});
  for (int round = 0; round < kNumberings; ++round) number(facing.wanted());
  facing.place();
}

void cut_wedges(PlanarDomain& domain) {
  Mesh& mesh = domain.boundary;
  std::vector<char> stays(domain.patches.size(), 0);
  for (const MappedPatch& grid : domain.mapped) stays[grid.patch] = 1;
  for (const PatchImage& image : domain.images) stays[image.patch] = stays[image.master] = 1;
  const CapNodes nodes{[](int) { return true; },
                       [&](int v) { return mesh.points[v]; },
                       [](const Vec3& x, Vec2) { return x; },
                       [](Vec2) {
                         return Vec3{0, 0, 1};
                       },
                       [&](const Vec3& x) {
                         mesh.points.push_back(x);
                         domain.places.emplace_back();
                         return static_cast<int>(mesh.points.size()) - 1;
                       },
                       kWedge,
                       false};
  std::vector<PatchBoundary> outlines = domain.patches;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    if (stays[p]) continue;
    PatchBoundary& patch = domain.patches[p];
    for (const BoundaryCap& cap : cap_corners(patch, nodes))
      for (const auto& quad : cap.quads) {
        mesh.quads.push_back(quad);
        mesh.quad_region.push_back(domain.patch_region[p]);
        for (const int v : quad) domain.places[v] = {};
      }
    for (std::size_t i = 0; i < patch.points.size(); ++i) {
      const Vec3& x = mesh.points[patch.point_node[i]];
      patch.points[i] = {x.x, x.y};
    }
  }
  if (!mesh.quads.empty()) domain.outlines = std::move(outlines);
}

}  // namespace delquad
