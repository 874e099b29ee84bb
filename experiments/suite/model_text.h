#pragma once

#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// What a loop is called: its curves, and what is inside; empty: nothing.
struct LoopNames {
  std::string boundary, region;
};

/// The text of a model file, loop by loop.
class ModelText {
 public:
  void polygon(const std::vector<Vec2>& corners, const LoopNames& names);
  void rectangle(Vec2 low, Vec2 high, const LoopNames& names);
  void circle(Vec2 centre, double radius, const LoopNames& names);
  /// Formulas in t.
  void curve(const std::string& name, const std::string& x, const std::string& y, double from, double to);
  void segment(const std::string& name, Vec2 a, Vec2 b);
  /// Of curves that close up.
  void hole(const std::vector<std::string>& curves);
  const std::string& text() const { return text_; }

 private:
  void begin_loop(const std::string& shape, const LoopNames& names);
  std::string text_;
};

/// A number with nine digits after the point, and no minus in front of zero.
std::string nine_digits(double value);

}  // namespace delquad
