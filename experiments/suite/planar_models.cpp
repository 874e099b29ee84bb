#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/segment.h"
#include "delquad/mesh.h"
#include "experiments/suite/model_makers.h"
#include "experiments/suite/random.h"

namespace delquad {

namespace {

/// A number with nine digits after the point, and no minus in front of zero.
std::string nine_digits(double value) {
  const std::string text = fmt::format("{:.9f}", value);
  return text == "-0.000000000" ? text.substr(1) : text;
}

std::string point(Vec2 p) { return "[" + nine_digits(p.x) + ", " + nine_digits(p.y) + "]"; }

/// What a loop is called: its curves, and what is inside; empty: nothing.
struct LoopNames {
  std::string boundary, region;
};

/// The text of a model file, loop by loop.
class ModelText {
 public:
  void polygon(const std::vector<Vec2>& corners, const LoopNames& names) {
    std::string list;
    for (const Vec2& p : corners) list += (list.empty() ? "" : ", ") + point(p);
    begin_loop("polygon = [" + list + "]", names);
  }

  void rectangle(Vec2 low, Vec2 high, const LoopNames& names) {
    begin_loop("rectangle = [" + point(low) + ", " + point(high) + "]", names);
  }

  void circle(Vec2 centre, double radius, const LoopNames& names) {
    begin_loop("circle = { centre = " + point(centre) + ", radius = " + nine_digits(radius) + " }", names);
  }

  /// Formulas in t.
  void curve(const std::string& name, const std::string& x, const std::string& y, double from, double to) {
    text_ += fmt::format(
        "[[curve]]\nname = \"{}\"\nexpression = {{ x = \"{}\", y = \"{}\", from = {}, to = {} }}\n", name, x,
        y, nine_digits(from), nine_digits(to));
  }

  void segment(const std::string& name, Vec2 a, Vec2 b) {
    text_ += fmt::format("[[curve]]\nname = \"{}\"\nsegment = [{}, {}]\n", name, point(a), point(b));
  }

  /// Of curves that close up.
  void hole(const std::vector<std::string>& curves) {
    std::string list;
    for (const std::string& name : curves) list += (list.empty() ? "\"" : ", \"") + name + "\"";
    begin_loop("curves = [" + list + "]", {});
  }

  const std::string& text() const { return text_; }

 private:
  void begin_loop(const std::string& shape, const LoopNames& names) {
    text_ += "[[loop]]\n" + shape + "\n";
    if (!names.boundary.empty()) text_ += "boundary = \"" + names.boundary + "\"\n";
    if (!names.region.empty()) text_ += "region = \"" + names.region + "\"\n";
  }

  std::string text_;
};

Vec2 polar(double radius, double angle) { return radius * Vec2{std::cos(angle), std::sin(angle)}; }

/// The outline of a gear: teeth with straight flanks between two radii.
std::vector<Vec2> toothed(int teeth, double root, double tip) {
  // Where a tooth's corners are, as parts of the pitch.
  constexpr double kRoot = 0.28, kTip = 0.13;
  std::vector<Vec2> outline;
  const double pitch = 2 * std::numbers::pi / teeth;
  for (int k = 0; k < teeth; ++k)
    for (const auto& [radius, part] : {std::pair(root, -kRoot), {tip, -kTip}, {tip, kTip}, {root, kRoot}})
      outline.push_back(polar(radius, pitch * (k + part)));
  return outline;
}

/// An airfoil of the four-digit NACA series, without camber or with a parabola's.
struct Airfoil {
  double thickness, camber, chord;
  double angle;  ///< nose up, in degrees
  Vec2 nose;
  bool sharp;  ///< the series' own tail is blunt
};

/// The formula of half the thickness at x = t^2, which is smooth at the nose.
std::string half_thickness(const Airfoil& a) {
  return fmt::format("{}*5*(0.2969*t-0.126*t^2-0.3516*t^4+0.2843*t^6-{}*t^8)", a.thickness,
                     a.sharp ? "0.1036" : "0.1015");
}

void add_side(ModelText& model, const Airfoil& a, const std::string& name, const char* sign) {
  const double turn = -a.angle * std::numbers::pi / 180;
  const std::string c = nine_digits(a.chord * std::cos(turn)), s = nine_digits(a.chord * std::sin(turn));
  const std::string y = fmt::format("({}*4*t^2*(1-t^2){}{})", a.camber, sign, half_thickness(a));
  model.curve(name, fmt::format("{}+{}*t^2-({})*{}", nine_digits(a.nose.x), c, s, y),
              fmt::format("{}+({})*t^2+{}*{}", nine_digits(a.nose.y), s, c, y), 0, 1);
}

/// The point of the tail on a side (1 or -1).
Vec2 tail(const Airfoil& a, double side) {
  const double turn = -a.angle * std::numbers::pi / 180;
  const double y = side * a.thickness * 5 * (0.2969 - 0.126 - 0.3516 + 0.2843 - 0.1015);
  const double c = a.chord * std::cos(turn), s = a.chord * std::sin(turn);
  return {a.nose.x + c - s * y, a.nose.y + s + c * y};
}

void add_airfoil(ModelText& model, const Airfoil& a, const std::string& name) {
  std::vector<std::string> curves = {name + "_upper", name + "_lower"};
  add_side(model, a, curves[0], "+");
  add_side(model, a, curves[1], "-");
  if (!a.sharp) {
    curves.push_back(name + "_tail");
    model.segment(curves[2], tail(a, 1), tail(a, -1));
  }
  model.hole(curves);
}

struct Disc {
  Vec2 centre;
  double radius;
};

struct Packing {
  Vec2 high;  ///< corner of the rectangle from the origin
  int count;
  double smallest, largest, gap;  ///< radii, and what is left between two at least
};

/// Discs that are thrown in one after the other, the largest first, each where there is room. Every second
/// one slides towards its nearest neighbour until only the gap is left.
std::vector<Disc> throw_in(const Packing& packing, std::uint64_t seed) {
  constexpr int kTrials = 4000;
  Random random(seed);
  std::vector<Disc> discs;
  for (int n = 0; n < packing.count; ++n) {
    const double part = static_cast<double>(n) / packing.count;
    const double radius = packing.largest + part * (packing.smallest - packing.largest);
    const auto free = [&](Vec2 p) {
      const double edge = std::min({p.x, p.y, packing.high.x - p.x, packing.high.y - p.y}) - radius;
      return edge >= packing.gap && std::ranges::all_of(discs, [&](const Disc& d) {
               return norm(d.centre - p) >= d.radius + radius + packing.gap * (1 - 1e-9);
             });
    };
    for (int trial = 0; trial < kTrials; ++trial) {
      Vec2 p = {random.between(0, packing.high.x), random.between(0, packing.high.y)};
      if (!free(p)) continue;
      if (n % 2 == 1) {
        const Disc& d = *std::ranges::min_element(
            discs, {}, [&](const Disc& other) { return norm(other.centre - p) - other.radius; });
        const Vec2 moved = d.centre + (d.radius + radius + packing.gap) / norm(p - d.centre) * (p - d.centre);
        if (free(moved)) p = moved;
      }
      discs.push_back({p, radius});
      break;
    }
  }
  return discs;
}

std::string pore_space(const Packing& packing, std::uint64_t seed) {
  ModelText model;
  model.rectangle({0, 0}, packing.high, {"outer", "fluid"});
  for (const Disc& d : throw_in(packing, seed)) model.circle(d.centre, d.radius, {"grain", ""});
  return model.text();
}

/// A convex polygon with its corners on a circle, at least half as far apart as on average.
std::vector<Vec2> random_polygon(const Disc& d, int corners, Random& random) {
  std::vector<Vec2> polygon;
  const double turn = random.between(0, 2 * std::numbers::pi);
  for (int k = 0; k < corners; ++k) {
    const double angle = turn + 2 * std::numbers::pi * (k + random.between(-0.25, 0.25)) / corners;
    polygon.push_back(d.centre + d.radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  return polygon;
}

struct Segment {
  Vec2 a, b;
};

bool cross_each_other(const Segment& s, const Segment& t) {
  const auto side = [](const Segment& line, Vec2 p) { return cross(line.b - line.a, p - line.a) > 0; };
  return side(s, t.a) != side(s, t.b) && side(t, s.a) != side(t, s.b);
}

double distance(const Segment& s, const Segment& t) {
  if (cross_each_other(s, t)) return 0;
  return std::min({distance_to_segment(s.a, t.a, t.b), distance_to_segment(s.b, t.a, t.b),
                   distance_to_segment(t.a, s.a, s.b), distance_to_segment(t.b, s.a, s.b)});
}

/// What of a convex polygon lies left of the line from `a` along `direction`.
std::vector<Vec2> left_part(const std::vector<Vec2>& polygon, Vec2 a, Vec2 direction) {
  std::vector<Vec2> part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const double at_p = cross(direction, p - a), at_q = cross(direction, q - a);
    if (at_p >= 0) part.push_back(p);
    if ((at_p >= 0) != (at_q >= 0)) part.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return part;
}

/// A convex polygon, counterclockwise, with every side moved inwards.
std::vector<Vec2> shrunk(const std::vector<Vec2>& polygon, double by) {
  std::vector<Vec2> inner = polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const Vec2 along = 1 / norm(q - p) * (q - p);
    inner = left_part(inner, p + by * perp(along), along);
  }
  return inner;
}

double area(const std::vector<Vec2>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

double shortest_side(const std::vector<Vec2>& polygon) {
  double least = norm(polygon.back() - polygon.front());
  for (std::size_t i = 1; i < polygon.size(); ++i) least = std::min(least, norm(polygon[i] - polygon[i - 1]));
  return least;
}

/// Cuts the largest of the blocks by a random line, unless that leaves a splinter.
void cut_largest(std::vector<std::vector<Vec2>>& blocks, Random& random) {
  constexpr double kShortest = 0.02;
  auto largest = std::ranges::max_element(blocks, {}, area);
  Vec2 middle;
  for (const Vec2& p : *largest) middle = middle + 1.0 / static_cast<double>(largest->size()) * p;
  const double angle = random.between(0, std::numbers::pi);
  const Vec2 along = {std::cos(angle), std::sin(angle)};
  const Vec2 from = middle + random.between(-0.06, 0.06) * perp(along);
  const std::vector<Vec2> left = left_part(*largest, from, along), right = left_part(*largest, from, -along);
  if (std::min(shortest_side(left), shortest_side(right)) < kShortest) return;
  *largest = left;
  blocks.push_back(right);
}

/// 24 teeth, a bore with a keyway and six holes.
std::string make_gear() {
  ModelText model;
  model.polygon(toothed(24, 0.86, 1), {"teeth", "steel"});
  constexpr double kBore = 0.22, kKey = 0.06, kDepth = 0.29;
  std::vector<Vec2> bore;
  const double begin = std::asin(kKey / kBore);
  constexpr int kSides = 48;
  for (int k = 0; k <= kSides; ++k)
    bore.push_back(polar(kBore, begin + (2 * std::numbers::pi - 2 * begin) * k / kSides));
  bore.push_back({kDepth, -kKey});
  bore.push_back({kDepth, kKey});
  model.polygon(bore, {"bore", ""});
  for (int k = 0; k < 6; ++k)
    model.circle(polar(0.56, std::numbers::pi / 6 + k * std::numbers::pi / 3), 0.13, {"holes", ""});
  return model.text();
}

/// Teeth inside around a wheel, and grease between: the teeth come within 0.02.
std::string make_ring_gear() {
  ModelText model;
  model.circle({0, 0}, 1, {"rim", "ring"});
  model.polygon(toothed(40, 0.82, 0.9), {"ring teeth", "grease"});
  model.polygon(toothed(16, 0.66, 0.8), {"wheel teeth", "wheel"});
  model.circle({0, 0}, 0.2, {"shaft", ""});
  return model.text();
}

/// Rectangular slits in all directions, 100 times as long as wide.
std::string make_slits() {
  constexpr double kWidth = 0.004;
  Random random(9);
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "plate"});
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 2; ++j) {
      const Vec2 middle = {0.25 + 0.5 * i, 0.25 + 0.5 * j};
      const Vec2 along = polar(0.2, random.between(0, std::numbers::pi)), up = kWidth / 0.4 * perp(along);
      model.polygon({middle - along - up, middle + along - up, middle + along + up, middle - along + up},
                    {"slit", ""});
    }
  return model.text();
}

/// A channel that turns 14 times between thin walls.
std::string make_serpentine() {
  constexpr int kWalls = 14;
  constexpr double kThickness = 0.01;
  std::vector<Vec2> outline = {{0, 0}};
  const double step = 2.0 / (kWalls + 1);
  const auto wall = [&](double x, double foot, double tip, double side) {
    for (const Vec2 p : {Vec2{x - side, foot}, {x - side, tip}, {x + side, tip}, {x + side, foot}})
      outline.push_back(p);
  };
  for (int k = 1; k <= kWalls; k += 2) wall(step * k, 0, 0.88, kThickness / 2);
  outline.push_back({2, 0});
  outline.push_back({2, 1});
  for (int k = kWalls; k > 0; k -= 2) wall(step * k, 1, 0.12, -kThickness / 2);
  outline.push_back({0, 1});
  ModelText model;
  model.polygon(outline, {"wall", "channel"});
  return model.text();
}

/// A corner that points inwards, and a hole: the size, which the list has, varies by a factor of 100.
std::string make_graded() {
  ModelText model;
  model.polygon({{-1, -1}, {1, -1}, {1, 1}, {0, 1}, {0, 0}, {-1, 0}}, {"outer", "domain"});
  model.circle({0.5, -0.5}, 0.2, {"hole", ""});
  return model.text();
}

std::string make_naca_sharp() {
  ModelText model;
  model.rectangle({-1.5, -1.5}, {3.5, 1.5}, {"far", "air"});
  add_airfoil(model, {0.12, 0, 1, 4, {0, 0}, true}, "wing");
  return model.text();
}

std::string make_naca_blunt() {
  ModelText model;
  model.rectangle({-1.5, -1.5}, {3.5, 1.5}, {"far", "air"});
  add_airfoil(model, {0.21, 0.04, 1, 8, {0, 0}, false}, "wing");
  return model.text();
}

/// Slat, wing and flap with narrow gaps; the wing's tail is blunt, the others' are sharp.
std::string make_high_lift() {
  ModelText model;
  model.rectangle({-1.5, -1.5}, {3.5, 1.5}, {"far", "air"});
  add_airfoil(model, {0.12, 0.06, 0.17, -24, {-0.165, -0.11}, true}, "slat");
  add_airfoil(model, {0.14, 0.03, 0.8, 2, {0, 0}, false}, "wing");
  add_airfoil(model, {0.13, 0.05, 0.32, 32, {0.79, -0.055}, true}, "flap");
  return model.text();
}

std::string make_porous() { return pore_space({{2, 1}, 60, 0.04, 0.13, 0.01}, 3); }

std::string make_porous_fine() { return pore_space({{2, 1}, 220, 0.012, 0.06, 0.004}, 4); }

/// Inclusions in inclusions: rings of up to three materials, some with a hole, some off their middle.
std::string make_circles() {
  Random random(5);
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "matrix"});
  for (const Disc& d : throw_in({{2, 1}, 16, 0.06, 0.24, 0.015}, 6)) {
    model.circle(d.centre, d.radius, {"interface", "shell"});
    const double inner = random.between(0.5, 0.8) * d.radius, angle = random.between(0, 2 * std::numbers::pi);
    const double shift = random.between(0, 0.8) * (d.radius - inner);
    const Vec2 centre = d.centre + shift * Vec2{std::cos(angle), std::sin(angle)};
    model.circle(centre, inner, {"interface", random.between(0, 1) < 0.6 ? "core" : ""});
  }
  return model.text();
}

/// Stones of three to seven corners: holes and inclusions.
std::string make_polygons() {
  Random random(7);
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "mortar"});
  for (const Disc& d : throw_in({{2, 1}, 40, 0.05, 0.18, 0.01}, 8)) {
    const int corners = 3 + static_cast<int>(random.between(0, 5));
    const std::vector<Vec2> polygon = random_polygon(d, corners, random);
    model.polygon(polygon, {"stone", random.between(0, 1) < 0.5 ? "stone" : ""});
  }
  return model.text();
}

/// Lenses with sharp ends that come close and do not cross.
std::string make_fractures() {
  constexpr int kCount = 24;
  constexpr double kGap = 0.02, kAperture = 0.05;  // the latter as a part of the length
  Random random(1);
  std::vector<Segment> segments;
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "rock"});
  while (segments.size() < kCount) {
    const double length = random.between(0.12, 0.5), angle = random.between(0, std::numbers::pi);
    const Vec2 half = length / 2 * Vec2{std::cos(angle), std::sin(angle)};
    const Vec2 middle = {random.between(0, 2), random.between(0, 1)};
    const Segment s = {middle - half, middle + half};
    const auto inside = [](Vec2 p) { return p.x > 0.03 && p.x < 1.97 && p.y > 0.03 && p.y < 0.97; };
    const double gap = kGap + kAperture * length;
    if (!inside(s.a) || !inside(s.b)) continue;
    if (std::ranges::any_of(segments, [&](const Segment& t) { return distance(s, t) < gap; })) continue;
    segments.push_back(s);
    const Vec2 up = kAperture * perp(half);
    model.polygon({s.a, middle - up, s.b, middle + up}, {"fracture", "filling"});
  }
  return model.text();
}

/// Channels that cross each other between the blocks of a broken plate.
std::string make_fracture_network() {
  constexpr int kBlocks = 32, kTrials = 400;
  constexpr double kAperture = 0.012;
  Random random(2);
  std::vector<std::vector<Vec2>> blocks = {{{0, 0}, {2, 0}, {2, 1}, {0, 1}}};
  for (int trial = 0; trial < kTrials && blocks.size() < kBlocks; ++trial) cut_largest(blocks, random);
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "fractures"});
  for (const auto& block : blocks) model.polygon(shrunk(block, kAperture / 2), {"wall", "rock"});
  return model.text();
}

/// Layers that thin out to corners of half a degree.
std::string make_wedges() {
  constexpr double kAngle = 0.5 * std::numbers::pi / 180, kLength = 1.6, kApart = 0.16;
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"outer", "rock"});
  for (int k = 0; k < 5; ++k) {
    const Vec2 tip = {k % 2 == 0 ? 0.2 : 1.8, kApart * (k + 1)};
    const double end = k % 2 == 0 ? tip.x + kLength : tip.x - kLength;
    const double height = (k + 1) * kLength * std::tan(kAngle);
    model.polygon({tip, {end, tip.y}, {end, tip.y + height}}, {"layer", "layer"});
  }
  return model.text();
}

/// Islands whose outlines have points far below the size, some of them near to each other.
std::string make_dense_outlines() {
  constexpr int kPoints = 360;
  ModelText model;
  model.rectangle({0, 0}, {2, 1}, {"coast", "sea"});
  for (const auto& [centre, radius] : {Disc{{0.5, 0.5}, 0.3}, {{1.105, 0.5}, 0.29}, {{1.65, 0.4}, 0.2}}) {
    std::vector<Vec2> outline;
    for (int k = 0; k < kPoints; ++k) {
      const double angle = 2 * std::numbers::pi * k / kPoints;
      outline.push_back(centre + polar(radius * (1 - 0.06 * std::pow(std::sin(9 * angle), 2)), angle));
    }
    model.polygon(outline, {"island", ""});
  }
  return model.text();
}

}  // namespace

const std::vector<SuiteMaker<std::string>>& planar_suite_models() {
  static const std::vector<SuiteMaker<std::string>> kAll = {
      {"fractures", make_fractures},   {"fracture_network", make_fracture_network},
      {"circles", make_circles},       {"polygons", make_polygons},
      {"porous", make_porous},         {"porous_fine", make_porous_fine},
      {"naca_sharp", make_naca_sharp}, {"naca_blunt", make_naca_blunt},
      {"high_lift", make_high_lift},   {"gear", make_gear},
      {"ring_gear", make_ring_gear},   {"slits", make_slits},
      {"serpentine", make_serpentine}, {"graded", make_graded},
      {"wedges", make_wedges},         {"dense_outlines", make_dense_outlines},
  };
  return kAll;
}

}  // namespace delquad
