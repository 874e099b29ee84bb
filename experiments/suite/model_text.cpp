#include "experiments/suite/model_text.h"

#include <fmt/format.h>

namespace delquad {
namespace {

std::string point(Vec2 p) { return "[" + nine_digits(p.x) + ", " + nine_digits(p.y) + "]"; }

}  // namespace

std::string nine_digits(double value) {
  const std::string text = fmt::format("{:.9f}", value);
  return text == "-0.000000000" ? text.substr(1) : text;
}

void ModelText::begin_loop(const std::string& shape, const LoopNames& names) {
  text_ += "[[loop]]\n" + shape + "\n";
  if (!names.boundary.empty()) text_ += "boundary = \"" + names.boundary + "\"\n";
  if (!names.region.empty()) text_ += "region = \"" + names.region + "\"\n";
}

void ModelText::polygon(const std::vector<Vec2>& corners, const LoopNames& names) {
  std::string list;
  for (const Vec2& p : corners) list += (list.empty() ? "" : ", ") + point(p);
  begin_loop("polygon = [" + list + "]", names);
}

void ModelText::rectangle(Vec2 low, Vec2 high, const LoopNames& names) {
  begin_loop("rectangle = [" + point(low) + ", " + point(high) + "]", names);
}

void ModelText::circle(Vec2 centre, double radius, const LoopNames& names) {
  begin_loop("circle = { centre = " + point(centre) + ", radius = " + nine_digits(radius) + " }", names);
}

void ModelText::curve(const std::string& name, const std::string& x, const std::string& y, double from,
                      double to) {
  text_ +=
      fmt::format("[[curve]]\nname = \"{}\"\nexpression = {{ x = \"{}\", y = \"{}\", from = {}, to = {} }}\n",
                  name, x, y, nine_digits(from), nine_digits(to));
}

void ModelText::segment(const std::string& name, Vec2 a, Vec2 b) {
  text_ += fmt::format("[[curve]]\nname = \"{}\"\nsegment = [{}, {}]\n", name, point(a), point(b));
}

void ModelText::hole(const std::vector<std::string>& curves) {
  std::string list;
  for (const std::string& name : curves) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  begin_loop("curves = [" + list + "]", {});
}

}  // namespace delquad
