// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/surface_editor.h"

#include <algorithm>
#include <cassert>

namespace delquad {

SurfaceEditor::SurfaceEditor(SurfaceModel& model) : mesh_(model.fine), triangles_at_(mesh_.points.size()) {
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    for (int v : mesh_.triangles[t]) triangles_at_[v].push_back(static_cast<int>(t));
  index_lines();
}

void SurfaceEditor::index_lines() {
  lines_at_.assign(mesh_.points.size(), {});
  for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
    for (int v : mesh_.lines[l]) lines_at_[v].push_back(static_cast<int>(l));
  next_line_.assign(mesh_.lines.size(), -1);
  begins_.assign(mesh_.lines.size(), 1);
}

int SurfaceEditor::add_node(const Vec3& x) {
  mesh_.points.push_back(x);
  triangles_at_.emplace_back();
  lines_at_.emplace_back();
  return static_cast<int>(mesh_.points.size()) - 1;
}

void SurfaceEditor::find_triangles_on(int a, int b, std::vector<int>& found) const {
  found.clear();
  if (triangles_at_[b].size() < triangles_at_[a].size()) std::swap(a, b);
  for (int t : triangles_at_[a]) {
    const auto& v = mesh_.triangles[t];
    if (v[0] == b || v[1] == b || v[2] == b) found.push_back(t);
  }
  std::ranges::sort(found);
}

std::vector<int> SurfaceEditor::triangles_on(int a, int b) const {
  std::vector<int> found;
  find_triangles_on(a, b, found);
  return found;
}

int SurfaceEditor::line_on(int a, int b) const {
  for (int l : lines_at_[a])
    if (mesh_.lines[l][0] == b || mesh_.lines[l][1] == b) return l;
  return -1;
}

void SurfaceEditor::replace_corner(int triangle, int from, int to) {
  std::ranges::replace(mesh_.triangles[triangle], from, to);
  std::erase(triangles_at_[from], triangle);
  triangles_at_[to].push_back(triangle);
}

int SurfaceEditor::split_edge(int a, int b, const Vec3& x) {
  const std::vector<int> on_edge = triangles_on(a, b);
  const int line = line_on(a, b);
  assert(!on_edge.empty() || line >= 0);
  const int node = add_node(x);
  for (int t : on_edge) {
    const int half = static_cast<int>(mesh_.triangles.size());
    mesh_.triangles.push_back(mesh_.triangles[t]);
    mesh_.triangle_region.push_back(mesh_.triangle_region[t]);
    std::ranges::replace(mesh_.triangles[half], a, node);
    for (int v : mesh_.triangles[half]) triangles_at_[v].push_back(half);
    replace_corner(t, b, node);
    splits_.push_back({t, half});
  }
  if (line >= 0) {
    const int half = static_cast<int>(mesh_.lines.size());
    const int last = mesh_.lines[line][1];
    mesh_.lines[line][1] = node;
    mesh_.lines.push_back({node, last});
    mesh_.line_curve.push_back(mesh_.line_curve[line]);
    std::ranges::replace(lines_at_[last], line, half);
    lines_at_[node] = {line, half};
    next_line_.push_back(next_line_[line]);
    next_line_[line] = half;
    begins_.push_back(0);
  }
  return node;
}

int SurfaceEditor::split_triangle(int triangle, const Vec3& x) {
  assert(triangle >= 0 && triangle < static_cast<int>(mesh_.triangles.size()));
  const auto corners = mesh_.triangles[triangle];
  const int node = add_node(x);
  for (int k = 1; k < 3; ++k) {
    const int part = static_cast<int>(mesh_.triangles.size());
    mesh_.triangles.push_back(corners);
    mesh_.triangles.back()[k] = node;
    mesh_.triangle_region.push_back(mesh_.triangle_region[triangle]);
    for (const int v : mesh_.triangles.back()) triangles_at_[v].push_back(part);
    splits_.push_back({triangle, part});
  }
  replace_corner(triangle, corners[0], node);
  return node;
}

bool SurfaceEditor::flip_edge(int a, int b) {
  const std::vector<int> pair = triangles_on(a, b);
  if (pair.size() != 2 || line_on(a, b) >= 0) return false;
  auto opposite = [&](int t) {
    for (int v : mesh_.triangles[t])
      if (v != a && v != b) return v;
    return -1;
  };
  const int c = opposite(pair[0]), d = opposite(pair[1]);
  if (c == d || !triangles_on(c, d).empty()) return false;
  replace_corner(pair[0], b, d);
  replace_corner(pair[1], a, c);
  return true;
}

int SurfaceEditor::add_curve(std::span<const int> chain) {
  assert(chain.size() >= 2 && std::ranges::adjacent_find(chain, [&](int a, int b) {
                                return triangles_on(a, b).empty();
                              }) == chain.end());
  const int curve = static_cast<int>(mesh_.curves.size());
  int tag = 0;
  for (const Entity& e : mesh_.curves) tag = std::max(tag, e.tag);
  mesh_.curves.push_back({tag + 1, {}});
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const int line = static_cast<int>(mesh_.lines.size());
    mesh_.lines.push_back({chain[i], chain[i + 1]});
    mesh_.line_curve.push_back(curve);
    for (int v : mesh_.lines.back()) lines_at_[v].push_back(line);
    next_line_.push_back(-1);
    begins_.push_back(1);
  }
  return curve;
}

void SurfaceEditor::finish() {
  std::vector<std::array<int, 2>> lines;
  std::vector<int> line_curve;
  for (std::size_t first = 0; first < mesh_.lines.size(); ++first) {
    if (!begins_[first]) continue;
    for (int l = static_cast<int>(first); l >= 0; l = next_line_[l]) {
      lines.push_back(mesh_.lines[l]);
      line_curve.push_back(mesh_.line_curve[l]);
    }
  }
  mesh_.lines = std::move(lines);
  mesh_.line_curve = std::move(line_curve);
  index_lines();
}

}  // namespace delquad
