// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/model_chain.h"
#include "tests/geometry/planar/models.h"

namespace delquad {
namespace {

class NotFinite final : public Curve {
  Vec2 point(double t) const override { return {t, std::numeric_limits<double>::quiet_NaN()}; }
};

TEST(ModelChain, JoinsCurvesInAnyOrderAndDirection) {
  std::mt19937 engine(1);
  const std::vector<Vec2> corners{{0, 0}, {2, 0}, {3, 1}, {1, 0.5}, {0, 4}};
  for (int round = 0; round < 50; ++round) {
    std::vector<ModelMaker::Shape> sides;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
      sides.push_back(engine() % 2 ? make_segment(a, b) : make_segment(b, a));
    }
    std::ranges::shuffle(sides, engine);
    const PlanarModel model = ModelMaker().loop(sides);
    const ModelChain chain = chain_model(model);
    ASSERT_EQ(chain.nodes.size(), corners.size());
    std::vector<int> uses(corners.size(), 0);
    for (std::size_t c = 0; c < sides.size(); ++c)
      for (int end : {0, 1}) {
        const int node = chain.curve_ends[c][end];
        ++uses[node];
        EXPECT_EQ(chain.nodes[node], sides[c]->point(end));
      }
    EXPECT_EQ(uses, std::vector<int>(corners.size(), 2));
  }
}

TEST(ModelChain, JoinsEndsThatRoundingSeparates) {
  const double s = std::sqrt(0.5);
  const PlanarModel rounded =
      ModelMaker().loop({make_arc({0, 0}, 1, std::numbers::pi / 4, 3 * std::numbers::pi / 4),
                         make_segment({-0.70710678, 0.70710678}, {0, -1}), make_segment({0, -1}, {s, s})});
  EXPECT_EQ(chain_model(rounded).nodes.size(), 3u);
}

TEST(ModelChain, ToleranceFollowsTheModelsSize) {
  for (double scale : {1e-9, 1.0, 1e9}) {
    const auto triangle = [&](double gap) {
      return ModelMaker().loop({make_segment({0, 0}, {scale, 0}),
                                make_segment({scale, gap * scale}, {0, scale}),
                                make_segment({0, scale}, {0, 0})});
    };
    EXPECT_EQ(chain_model(triangle(1e-8)).nodes.size(), 3u) << scale;
    expect_input_error([&] { chain_model(triangle(1e-5)); }, {"test.toml", "open", "curve 1", "curve 2"});
  }
}

TEST(ModelChain, ClosedCurvesAreLoopsAlone) {
  const ModelChain chain = chain_model(ModelMaker().loop({make_circle({0, 0}, 1)}));
  EXPECT_EQ(chain.nodes.size(), 1u);
  EXPECT_EQ(chain.curve_ends[0], (std::array{0, 0}));
}

TEST(ModelChain, FillingOfAHoleMayBeALoopOfItsOwn) {
  PlanarModel model = ModelMaker().loop(rectangle_sides(0, 0, 4, 4)).loop({make_circle({2, 2}, 1)});
  model.loops.push_back({{4}, "steel", ""});
  const ModelChain chain = chain_model(model);
  ASSERT_EQ(chain.loops.size(), 2u);
  EXPECT_EQ(chain.loops[1].region, "steel");
  model.loops.push_back({{4}, "brass", ""});
  expect_input_error([&] { chain_model(model); }, {"loop 2 and loop 4", "same curves"});
}

TEST(ModelChain, NamesWhatIsWrong) {
  const auto chain = [](const PlanarModel& model) { return [model] { chain_model(model); }; };
  PlanarModel open = ModelMaker().loop({make_segment({0, 0}, {1, 0}), make_segment({1, 0}, {1, 1})});
  expect_input_error(chain(open), {"test.toml: ", "open between (0, 0)", "(1, 1) of curve 2"});
  open.curves[0].name = "inlet";
  open.curves[0].where = "test.toml:7";
  open.loops[0].where = "test.toml:9";
  expect_input_error(chain(open), {"test.toml:9: ", "'inlet' (test.toml:7)"});

  auto two = rectangle_sides(0, 0, 1, 1);
  for (const auto& side : rectangle_sides(3, 3, 4, 4)) two.push_back(side);
  expect_input_error(chain(ModelMaker().loop(two)), {"several closed chains", "4 of 8"});

  expect_input_error(chain({"test.toml", {}, {}}), {"no loops"});
  expect_input_error(chain(ModelMaker().loop({})), {"loop 1 has no curves"});
  expect_input_error(chain(ModelMaker().loop({std::make_shared<NotFinite>()})), {"curve 1", "finite"});
  expect_input_error(chain(ModelMaker().loop({make_circle({0, 0}, 1), make_circle({1e9, 0}, 1)})),
                     {"curve 1", "no length"});

  PlanarModel square = ModelMaker().loop(rectangle_sides(0, 0, 1, 1));
  square.loops.push_back({{0, 1}, "", ""});
  expect_input_error(chain(square), {"open"});
  square.loops[1].curves = {0, 17};
  expect_input_error(chain(square), {"loop 2", "does not exist"});
  square.loops = {{{0, 1, 1, 2, 3}, "", ""}};
  expect_input_error(chain(square), {"loop 1", "curve 2", "twice"});
}

}  // namespace
}  // namespace delquad
