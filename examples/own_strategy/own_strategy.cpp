// SPDX-License-Identifier: GPL-3.0-or-later
// M: new points at the tip of an equilateral triangle, as F does, but measured by the larger of the two
// norms.
#include <delquad/bench.h>
#include <delquad/extend.h>

#include <algorithm>

namespace {

using namespace delquad;

class Mixed final : public PointPlacement {
 public:
  std::string name() const override { return "equilateral, by the larger norm"; }
  double default_h_max() const override { return l2_->default_h_max(); }
  double triangle_size(const std::array<Vec2, 3>& t, Cross cross, double delta) const override {
    return std::max(l2_->triangle_size(t, cross, delta), linf_->triangle_size(t, cross, delta));
  }
  Candidates candidates(const FrontEdge& edge) const override { return l2_->candidates(edge); }
  double length(Vec2 v, const Frame& frame) const override {
    return std::min(l2_->length(v, frame), linf_->length(v, frame));
  }

 private:
  std::unique_ptr<PointPlacement> l2_ = make_l2_frontal(), linf_ = make_linf_delquad();
};

}  // namespace

int main(int argc, char** argv) {
  add_stage(
      insertion_stage('M', "mixed insertion", [](const Options&) { return std::make_unique<Mixed>(); }));
  return run_program(argc, argv);
}
