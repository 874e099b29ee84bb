// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "delquad/mesher.h"
#include "tests/fuzz/draw.h"
#include "tests/fuzz/target.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad::fuzz {

namespace {

constexpr double kWidth = 16;  // of what is drawn

/// Draws loops: plain ones, and what models have that nobody looked at twice.
class LoopDrawer {
 public:
  explicit LoopDrawer(Draw& draw) : draw_(draw) { model_.source = "drawn"; }

  PlanarModel model() {
    if (draw_.flag()) polygon({{0, 0}, {kWidth, 0}, {kWidth, kWidth}, {0, kWidth}});
    for (int loops = 1 + draw_.below(4); loops > 0; --loops) add_loop();
    return model_;
  }

 private:
  Vec2 point() {
    const double x = draw_.byte(), y = draw_.byte();
    return {x / 16, y / 16};
  }

  void add_loop() {
    switch (draw_.below(8)) {
      case 0:
        return any_polygon();
      case 1:
        return star();
      case 2:
        return any_circle();
      case 3:
        return needle();
      case 4:
        return rectangle(1);
      case 5:
        return rectangle(std::ldexp(1, -draw_.below(16)));
      case 6:
        return touching_circle();
      default:
        return lens();
    }
  }

  void any_polygon() {
    std::vector<Vec2> corners(static_cast<std::size_t>(3 + draw_.below(5)));
    for (Vec2& corner : corners) corner = point();
    polygon(corners);
  }

  /// Corners as sharp as the bytes say, and never crossing itself.
  void star() {
    const int n = 3 + draw_.below(8);
    const Vec2 centre = point();
    std::vector<Vec2> corners;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      corners.push_back(centre + draw_.between(0.02, kWidth / 2) * Vec2{std::cos(angle), std::sin(angle)});
    }
    polygon(corners);
  }

  void any_circle() {
    const Vec2 centre = point();
    circle(centre, draw_.between(0.1, kWidth / 2));
  }

  void needle() {
    const Vec2 a = point(), along = point() - Vec2{kWidth / 2, kWidth / 2};
    const double part = draw_.between(0, 1), height = std::ldexp(1, -draw_.below(12));
    polygon({a, a + along, a + part * along + height * perp(along)});
  }

  /// As thin as `part`: a slit.
  void rectangle(double part) {
    const Vec2 a = point(), along = point() - Vec2{kWidth / 2, kWidth / 2};
    const Vec2 across = part * draw_.between(0.05, 1) * perp(along);
    polygon({a, a + along, a + along + across, a + across});
  }

  /// Touches the last circle, from outside or from inside.
  void touching_circle() {
    if (!last_circle_) return circle({kWidth / 2, kWidth / 2}, kWidth / 4);
    const auto [centre, radius] = *last_circle_;
    const double mine = radius * draw_.between(0.05, 1), angle = draw_.between(0, 2 * std::numbers::pi);
    const double distance = draw_.flag() ? radius + mine : radius - mine;
    circle(centre + distance * Vec2{std::cos(angle), std::sin(angle)}, mine);
  }

  /// Two arcs, or an arc and a chord, between the same two points.
  void lens() {
    const Vec2 centre = point();
    const double radius = draw_.between(0.1, kWidth / 2), half = draw_.between(0.02, 3.1),
                 turn = draw_.between(0, 6.28);
    const auto arc = make_arc(centre, radius, turn - half, turn + half);
    const Vec2 first = arc->point(0), last = arc->point(1);
    if (draw_.flag()) return loop({arc, make_segment(last, first)});
    const Vec2 mirrored = first + last - centre;
    loop({arc, make_arc(mirrored, radius, turn + std::numbers::pi - half, turn + std::numbers::pi + half)});
  }

  void circle(Vec2 centre, double radius) {
    last_circle_ = {centre, radius};
    loop({make_circle(centre, radius)});
  }

  void polygon(const std::vector<Vec2>& corners) {
    std::vector<std::shared_ptr<const Curve>> sides;
    for (std::size_t i = 0; i < corners.size(); ++i)
      sides.push_back(make_segment(corners[i], corners[(i + 1) % corners.size()]));
    loop(sides);
  }

  void loop(const std::vector<std::shared_ptr<const Curve>>& curves) {
    ModelLoop loop;
    loop.where = "loop " + std::to_string(model_.loops.size());
    for (const auto& curve : curves) {
      loop.curves.push_back(static_cast<int>(model_.curves.size()));
      model_.curves.push_back({curve, "", "curve " + std::to_string(model_.curves.size())});
    }
    model_.loops.push_back(loop);
  }

  Draw& draw_;
  PlanarModel model_;
  std::optional<std::pair<Vec2, double>> last_circle_;
};

/// Words that leave no triangles.
std::string draw_word(Draw& draw) {
  constexpr std::array kWords = {"DB", "FB", "DBC", "DBCO", "PB", "DLB"};
  return kWords[static_cast<std::size_t>(draw.below(kWords.size()))];
}

SizeSpec draw_size(Draw& draw, double width) {
  SizeSpec size;
  const double base = width / (1 + draw.below(16));
  size.field = make_constant_size(base);
  if (draw.flag())
    size.sources.push_back({{kWidth / 2, kWidth / 2, 0},
                            {kWidth / 2, kWidth / 2, 0},
                            base * draw.between(0.1, 1),
                            base,
                            0,
                            kWidth / 2});
  return size;
}

/// Meshes it: a sound mesh of quads, and the same again, where it is small.
void require_mesh(const MeshProblem& problem, const std::string& word) {
  constexpr std::size_t kSmall = 60;  // quads
  const Context context{.threads = 1};
  const MeshResult result = mesh(problem, word, context);
  require(result.soundness.sound(), "a mesh that is not sound was returned");
  require(!result.mesh.quads.empty() && result.mesh.triangles.empty(), "expected quads alone");
  const std::vector<std::string> wrong = check_invariants(result.mesh);
  require(wrong.empty(), wrong.empty() ? "" : wrong[0]);
  if (result.mesh.quads.size() > kSmall) return;
  const MeshResult again = mesh(problem, word, context);
  require(again.mesh.points == result.mesh.points && again.mesh.quads == result.mesh.quads,
          "another mesh next time");
}

bool try_domain(std::string_view bytes) {
  return result_or_input_error("", [&] {
    Draw draw(bytes);
    MeshProblem problem;
    problem.max_elements = 500;
    const std::string word = draw_word(draw);
    problem.size = draw_size(draw, kWidth);
    if (draw.below(4) == 0) problem.cross.kind = CrossKind::kSizeAware;
    problem.seed = draw.below(3);
    problem.model = LoopDrawer(draw).model();
    require_mesh(problem, word);
  });
}

/// Layers on some of the curves, on both sides or into the regions of one name.
std::vector<LayerSpec> draw_layers(Draw& draw, PlanarModel& model) {
  constexpr int kNames = 4;
  const auto name = [](int i) { return "part " + std::to_string(i); };
  int n = 0;
  for (ModelCurve& curve : model.curves) curve.name = name(n++ % kNames);
  for (std::size_t l = 0; l < model.loops.size(); ++l)
    if (draw.flag()) model.loops[l].region = "region " + std::to_string(l % 2);
  std::vector<LayerSpec> layers;
  for (int on = 0; on < std::min(n, kNames); ++on) {
    if (draw.flag()) continue;
    if (layers.empty() || draw.flag()) {
      LayerSpec& layer = layers.emplace_back();
      layer.first = std::ldexp(1, -draw.below(12));
      layer.number = 1 + draw.below(5);
      layer.growth = draw.between(1, 1.5);
      layer.fan = draw.between(20, 120);
      if (draw.below(4) == 0) layer.into = {"region 0"};
    }
    layers.back().on.push_back(name(on));
  }
  return layers;
}

bool try_layers(std::string_view bytes) {
  return result_or_input_error("", [&] {
    Draw draw(bytes);
    MeshProblem problem;
    problem.max_elements = 1000;
    const std::string word = draw_word(draw);
    problem.size = draw_size(draw, kWidth);
    problem.seed = draw.below(2);
    problem.symmetry.automatic = draw.below(4) == 3;
    problem.mapped.automatic = draw.below(4) == 3;
    PlanarModel model = LoopDrawer(draw).model();
    problem.layers = draw_layers(draw, model);
    problem.model = std::move(model);
    require_mesh(problem, word);
  });
}

/// Squares, some of them halved, in two regions, with lines between these and on the outline.
Mesh draw_given(Draw& draw) {
  const int n = 1 + draw.below(4), m = 1 + draw.below(4);
  Mesh mesh;
  mesh.regions = {{1, {"one"}}, {2, {"two"}}};
  mesh.curves = {{1, {"outline"}}, {2, {}}};
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) mesh.points.push_back({double(i), double(j), 0});
  const auto at = [&](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const std::array<int, 4> q = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      const int kind = draw.below(8), region = draw.below(4) == 1;
      if (kind == 1) continue;  // a hole
      if (kind < 6) {
        mesh.quads.push_back(q);
        mesh.quad_region.push_back(region);
        continue;
      }
      for (const int k : {0, 2}) {
        mesh.triangles.push_back({q[k], q[k + 1], q[(k + 2) % 4]});
        mesh.triangle_region.push_back(region);
      }
    }
  for (int lines = draw.below(4); lines > 0; --lines) {
    const int i = draw.below(n), j = draw.below(m + 1);
    mesh.lines.push_back({at(i, j), at(i + 1, j)});
    mesh.line_curve.push_back(draw.below(2));
  }
  for (int named = draw.below(3); named > 0; --named)
    mesh.named_points.push_back({draw.below(static_cast<int>(mesh.points.size()) + 1), {named, {"point"}}});
  for (int moves = draw.below(6); moves > 0; --moves) {
    Vec3& p = mesh.points[static_cast<std::size_t>(draw.byte()) % mesh.points.size()];
    const double x = draw.between(-0.7, 0.7);
    p = p + Vec3{x, draw.between(-0.7, 0.7), 0};
  }
  if (draw.below(8) == 7 && !mesh.quads.empty()) std::swap(mesh.quads[0][1], mesh.quads[0][3]);
  if (draw.below(8) == 7 && !mesh.quads.empty()) mesh.quads[0][0] = mesh.quads[0][1];
  return mesh;
}

/// Whether all corners of all elements turn left.
bool is_convex(const Mesh& mesh) {
  const auto turns_left = [&](const auto& element) {
    const std::size_t n = element.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 &a = mesh.points[static_cast<std::size_t>(element[k])],
                 &b = mesh.points[static_cast<std::size_t>(element[(k + 1) % n])],
                 &c = mesh.points[static_cast<std::size_t>(element[(k + 2) % n])];
      if (!(cross(b - a, c - b).z > 0)) return false;
    }
    return true;
  };
  return std::ranges::all_of(mesh.quads, turns_left) && std::ranges::all_of(mesh.triangles, turns_left);
}

/// A mesh that is not sound may stay so, and only such a mesh.
bool try_given(std::string_view bytes) {
  return result_or_input_error("", [&] {
    constexpr std::array kGivenWords = {"CO", "BCO", "B", "C", "O", "DB", "G", "T", "L", "DBCO"};
    Draw draw(bytes);
    MeshProblem problem;
    problem.max_elements = 500;
    const std::string word = kGivenWords[static_cast<std::size_t>(draw.below(kGivenWords.size()))];
    if (draw.flag()) problem.size.field = make_constant_size(draw.between(0.2, 3));
    problem.seed = draw.below(2);
    Mesh given = draw_given(draw);
    problem.allow_unsound = !is_convex(given);
    problem.model = GivenMesh{std::move(given), "drawn"};
    const MeshResult result = mesh(problem, word, {.threads = 1});
    require(problem.allow_unsound || result.soundness.sound(), "a mesh that is not sound was returned");
    const std::vector<std::string> wrong = check_invariants(result.mesh);
    require(wrong.empty(), wrong.empty() ? "" : wrong[0]);
  });
}

/// A height field over n x n squares.
Mesh hills(int n, Draw& draw) {
  testing_support::TriangulatedShape shape;
  shape.region();
  std::vector<double> heights(static_cast<std::size_t>((n + 1) * (n + 1)));
  for (double& height : heights) height = draw.between(0, 1);
  const auto at = [&](int i, int j) {
    return Vec3{double(i) / n, double(j) / n, heights[static_cast<std::size_t>(i * (n + 1) + j)]};
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      shape.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      shape.triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return shape.mesh;
}

Mesh box(int n, Draw& draw) {
  const double x = draw.between(0.01, 1), y = draw.between(0.1, 1);
  return testing_support::box(n, x, y);
}

Mesh draw_shape(Draw& draw) {
  const int n = 1 + draw.below(3);
  switch (draw.below(3)) {
    case 0:
      return box(n, draw);
    case 1:
      return testing_support::can(3 + draw.below(8), n);
    default:
      return hills(n, draw);
  }
}

/// Points moved, triangles lost, doubled and turned over, as in files of scans.
void damage(Mesh& mesh, Draw& draw) {
  for (int changes = draw.below(6); changes > 0; --changes) {
    const auto t = static_cast<std::size_t>(draw.byte()) % mesh.triangles.size();
    switch (draw.below(5)) {
      case 0:
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
        mesh.triangle_region.erase(mesh.triangle_region.begin() + static_cast<std::ptrdiff_t>(t));
        if (mesh.triangles.empty()) return;
        break;
      case 1:
        mesh.triangles.push_back(mesh.triangles[t]);
        mesh.triangle_region.push_back(mesh.triangle_region[t]);
        break;
      case 2:
        std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
        break;
      default:
        Vec3& p = mesh.points[static_cast<std::size_t>(mesh.triangles[t][0])];
        p = p + Vec3{draw.between(-0.5, 0.5), draw.between(-0.5, 0.5), draw.between(-0.5, 0.5)};
    }
  }
}

bool try_triangulation(std::string_view bytes) {
  return result_or_input_error("", [&] {
    Draw draw(bytes);
    MeshProblem problem;
    problem.max_elements = 500;
    problem.size.field = make_constant_size(1.0 / (1 + draw.below(8)));
    problem.keep_going = draw.flag();
    if (draw.flag()) problem.surface.feature_angle = draw.between(1, 179);
    if (draw.below(4) == 0) problem.surface.weld_tolerance = draw.between(0, 0.1);
    TriangleModel model{draw_shape(draw), "drawn"};
    damage(model.mesh, draw);
    problem.model = std::move(model);
    require_mesh(problem, "DB");
  });
}

std::string bytes_of(std::initializer_list<int> numbers) {
  std::string bytes;
  for (const int number : numbers) bytes += static_cast<char>(number);
  return bytes;
}

std::vector<std::string> domain_seeds() {
  return {
      // DB, size 4, no source; a square with a star and a circle in it
      bytes_of({0, 3, 0, 1, 0, 1, 1, 1, 1, 128, 128, 60, 30, 60, 30, 2, 40, 40, 20}),
      // DBCO, size 2, a source; a lens
      bytes_of({3, 7, 1, 128, 1, 0, 0, 0, 7, 128, 128, 100, 60, 10, 1}),
      // FB, size 16 / 6; two circles
      bytes_of({1, 5, 0, 1, 0, 0, 1, 2, 60, 60, 80, 2, 200, 200, 60}),
      // PB, a thin rectangle and a needle in a square
      bytes_of({4, 5, 0, 1, 0, 1, 1, 5, 5, 100, 100, 180, 140, 128, 3, 40, 40, 160, 130, 128, 4}),
  };
}

std::vector<std::string> layer_seeds() {
  return {
      // DB, size 4, no source; a square, and layers on all of its sides
      bytes_of({0, 3, 0, 0, 0, 0, 1, 0, 4, 128, 128, 160, 128, 100, 0, 0, 0, 6, 3, 100, 200, 1, 0, 0, 0}),
      // DBCO, a circle in a square, with different layers
      bytes_of(
          {3, 5, 0, 0, 0, 0, 1, 0, 2, 128, 128, 60, 0, 0, 0, 7, 2, 60, 100, 1, 0, 1, 8, 3, 80, 90, 1, 1}),
  };
}

std::vector<std::string> given_seeds() {
  return {bytes_of({0, 0, 0, 2, 2}), bytes_of({1, 0, 0, 2, 2, 6, 0, 6, 1, 0, 0, 7, 0, 2, 0, 1, 1, 1, 1, 3}),
          bytes_of({4, 1, 100, 0, 3, 2, 0, 0, 0, 0, 0, 0, 0, 0,   0,
                    0, 0, 0,   0, 0, 0, 0, 0, 0, 0, 0, 2, 9, 150, 90})};
}

std::vector<std::string> triangulation_seeds() {
  return {bytes_of({3, 0, 0, 1, 1, 0, 255, 255, 0}), bytes_of({4, 1, 1, 40, 1, 2, 1, 5, 0}),
          bytes_of({5, 0, 0, 1, 2, 2, 10, 200, 30, 150, 60, 110, 80, 90, 70, 2, 5, 0, 7, 3, 1, 2, 3})};
}

}  // namespace

std::vector<Target> mesher_targets() {
  return {{"domain", try_domain, domain_seeds, 100},
          {"layers", try_layers, layer_seeds, 120},
          {"given", try_given, given_seeds, 100},
          {"triangulation", try_triangulation, triangulation_seeds, 60}};
}

}  // namespace delquad::fuzz
