// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/fields/size_aware_cross_field.h"
#include "tests/algorithms/fields/backgrounds.h"

namespace delquad {
namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;

struct SeamEnd {
  FieldSeam::Side side;
  double at;  ///< where its middle lies along the seam
};

/// The boundary sides of a patch whose middles `along` knows, in ascending order; NaN: no seam.
std::vector<SeamEnd> seam_ends(const BackgroundMesh& background, int patch,
                               const std::function<double(Vec2)>& along) {
  const TriPatch& tri = background.triangles();
  std::vector<SeamEnd> ends;
  for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      if (tri.neighbours[t][k] >= 0) continue;
      const auto& v = tri.triangles[t];
      const double at = along(0.5 * (tri.points[v[(k + 1) % 3]] + tri.points[v[(k + 2) % 3]]));
      if (!std::isnan(at)) ends.push_back({{patch, t, k}, at});
    }
  std::ranges::sort(ends, {}, &SeamEnd::at);
  return ends;
}

void add_seams(const std::vector<SeamEnd>& one, const std::vector<SeamEnd>& other, double alignment,
               std::vector<FieldSeam>& seams) {
  ASSERT_EQ(one.size(), other.size());
  ASSERT_FALSE(one.empty());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_NEAR(one[i].at, other[i].at, 1e-9);
    seams.push_back({{one[i].side, other[i].side}, alignment});
  }
}

/// Greatest angle between a field and the direction `theta` at random points.
double farthest_apart(const BackgroundMesh& background, const CrossField& field, double theta) {
  std::mt19937_64 random(3);
  double farthest = 0;
  int hint = -1;
  for (int i = 0; i < 500; ++i) {
    const double angle = field.at(random_point(background.triangles(), random), hint).angle();
    farthest = std::max(farthest, std::abs(std::remainder(angle - theta, kQuarterTurn)));
  }
  return farthest;
}

FieldPatch field_patch(const std::shared_ptr<const BackgroundMesh>& background, const ParametricSize& size) {
  return {background, &size, std::make_shared<HarmonicCrossField>(background)};
}

/// [0, 2] x [0, 1], divided along the slanted line from (1.2, 0) to (0.8, 1). The right half is turned by
/// kTurn and three times as large in its plane.
class SlantedCut : public testing::Test {
 protected:
  static constexpr double kTurn = 0.7, kScale = 3;
  static double line_at(double y) { return 1.2 - 0.4 * y; }
  static Vec2 moved(Vec2 u) {
    const Vec2 axis = kScale * Vec2{std::cos(kTurn), std::sin(kTurn)};
    return u.x * axis + u.y * perp(axis);
  }
  static Vec2 moved_back(Vec2 u) {
    const Vec2 axis = (1 / kScale) * Vec2{std::cos(kTurn), std::sin(kTurn)};
    return {dot(u, axis), cross(axis, u)};
  }
  static double along_line(Vec2 u) { return std::abs(u.x - line_at(u.y)) < 1e-9 ? u.y : NAN; }

  std::vector<FieldSeam> seams(double alignment) const {
    std::vector<FieldSeam> all;
    add_seams(seam_ends(*left, 0, along_line),
              seam_ends(*right, 1, [](Vec2 u) { return along_line(moved_back(u)); }), alignment, all);
    return all;
  }
  std::vector<FieldPatch> patches() const {
    return {field_patch(left, left_size), field_patch(right, right_size)};
  }

  std::shared_ptr<const BackgroundMesh> left = image_of_grid(1, 1, 1.0 / 16, [](Vec2 w) {
    return Vec2{line_at(w.y) * w.x, w.y};
  });
  std::shared_ptr<const BackgroundMesh> right = image_of_grid(1, 1, 1.0 / 16, [](Vec2 w) {
    return moved({line_at(w.y) + (2 - line_at(w.y)) * w.x, w.y});
  });
  FunctionSize left_size{0.05}, right_size{0.05 * kScale};
};

TEST_F(SlantedCut, FieldsGoOnAcross) {
  const auto fields = make_size_aware_fields(patches(), seams(0));
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_LT(farthest_apart(*left, *fields[0], 0), 0.01);
  EXPECT_LT(farthest_apart(*right, *fields[1], kTurn), 0.01);
  for (const auto& field : fields) {
    EXPECT_TRUE(field->singularities().empty());
    EXPECT_EQ(field->index_sum(), 4);
    EXPECT_EQ(field->euler_characteristic(), 1);
  }
}

TEST_F(SlantedCut, WithoutSeamsOrWithMuchAlignmentFieldsFollowTheLine) {
  const double slope = std::atan2(1, -0.4);
  const auto on_line = [&](const CrossField& field) {
    int hint = -1;
    return std::abs(std::remainder(field.at({line_at(0.5), 0.5}, hint).angle() - slope, kQuarterTurn));
  };
  EXPECT_LT(on_line(*make_size_aware_fields({patches()[0]}, {})[0]), 1e-3);
  double last = on_line(*make_size_aware_fields(patches(), seams(0))[0]);
  EXPECT_GT(last, 0.3);
  for (const double alignment : {0.1, 1.0, 100.0}) {
    const double now = on_line(*make_size_aware_fields(patches(), seams(alignment))[0]);
    EXPECT_LT(now, last) << alignment;
    last = now;
  }
  EXPECT_LT(last, 0.02);
}

TEST(FieldSeams, ATubeIsJoinedToItself) {
  const auto background = image_of_grid(2, 1, 1.0 / 16, [](Vec2 w) { return Vec2{w.x + 0.3 * w.y, w.y}; });
  const FunctionSize size(0.05);
  const auto side_at = [](double y) {
    return [y](Vec2 u) { return std::abs(u.y - y) < 1e-9 ? u.x - 0.3 * y : NAN; };
  };
  std::vector<FieldSeam> seams;
  add_seams(seam_ends(*background, 0, side_at(0)), seam_ends(*background, 0, side_at(1)), 0, seams);
  const auto field = make_size_aware_fields({field_patch(background, size)}, seams)[0];
  EXPECT_LT(farthest_apart(*background, *field, std::atan2(1, 0.3)), 0.02);
  EXPECT_TRUE(field->singularities().empty());
  EXPECT_EQ(field->euler_characteristic(), 0);
  EXPECT_EQ(field->index_sum(), 0);
}

// Two squares, one on the other: all the curvature is in the four corners.
TEST(FieldSeams, APillowHasItsSingularitiesInItsCorners) {
  const auto background = image_of_grid(1, 1, 1.0 / 16, [](Vec2 w) { return w; });
  const FunctionSize size(0.05);
  const auto around = [](Vec2 u) {
    return u.y < 1e-9 ? u.x : u.x > 1 - 1e-9 ? 1 + u.y : u.y > 1 - 1e-9 ? 3 - u.x : 4 - u.y;
  };
  std::vector<FieldSeam> seams;
  add_seams(seam_ends(*background, 0, around),
            seam_ends(*background, 1,
                      [&](Vec2 u) {
                        return around({1 - u.x, u.y});
                      }),
            0, seams);
  const FieldPatch square = field_patch(background, size);
  const auto fields = make_size_aware_fields({square, square}, seams);
  std::vector<Singularity> all;
  for (const auto& field : fields) {
    EXPECT_EQ(field->euler_characteristic(), 2);
    EXPECT_EQ(field->index_sum(), 8);
    all.insert(all.end(), field->singularities().begin(), field->singularities().end());
  }
  ASSERT_EQ(all.size(), 4u);
  for (const Singularity& s : all) {
    EXPECT_EQ(s.index, 2);
    EXPECT_NEAR(std::abs(s.at.x - 0.5), 0.5, 1e-9);
    EXPECT_NEAR(std::abs(s.at.y - 0.5), 0.5, 1e-9);
  }
}

}  // namespace
}  // namespace delquad
