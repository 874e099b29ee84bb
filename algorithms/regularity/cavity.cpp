// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/cavity.h"

namespace delquad {

void Cavity::begin(int most) {
  ++pass_;
  most_ = most;
  element_pass_.resize(mesh_.element_slots(), 0);
  vertex_pass_.resize(mesh_.vertex_slots(), 0);
  quads_at_.resize(mesh_.vertex_slots(), 0);
  checked_at_.resize(mesh_.vertex_slots(), 0);
  elements_.clear(), vertices_.clear(), to_check_.clear();
}

bool Cavity::add(int element) {
  if (has(element)) return true;
  if (elements_.size() >= most_ || !mesh_.is_quad(element)) return false;
  element_pass_[element] = pass_;
  elements_.push_back(element);
  for (int k = 0; k < 4; ++k) {
    const int v = mesh_.corner(element, k);
    if (mesh_.held(v)) return false;
    if (vertex_pass_[v] != pass_) {
      vertex_pass_[v] = pass_;
      quads_at_[v] = checked_at_[v] = 0;
      vertices_.push_back(v);
    }
    ++quads_at_[v];
    to_check_.push_back(v);
  }
  return true;
}

bool Cavity::close() {
  while (!to_check_.empty()) {
    const int v = to_check_.back();
    to_check_.pop_back();
    if (checked_at_[v] == quads_at_[v] || is_inside(v)) continue;
    checked_at_[v] = quads_at_[v];
    const int want = wanted(v), most = quads_at_[v] == mesh_.valence(v) ? 3 : 2;
    if (want >= 1 && want <= most && fans_at(v) == 1) continue;
    if (most == 3 || !add_around(v)) return false;
  }
  return trace();
}

std::uint64_t Cavity::key() const {
  std::uint64_t sum = 0;
  for (const int e : elements_) sum += hash_bits(2 * static_cast<std::uint64_t>(e));
  for (const int v : vertices_)
    if (!is_inside(v))
      sum += hash_bits((static_cast<std::uint64_t>(v) << 5) + 2 * std::min(wanted(v) + 1, 7) + 1);
  return sum;
}

int Cavity::fans_at(int v) const {
  if (quads_at(v) == 1 || (!mesh_.on_boundary(v) && quads_at(v) == mesh_.valence(v) - 1)) return 1;
  int fans = 0, first = -1, last = -1;
  mesh_.for_each_out(v, [&](int h) {
    const int in = has(QuadTopology::element(h)) ? 1 : 0;
    if (first < 0) first = in;
    if (in == 1 && last != 1) ++fans;
    last = in;
  });
  return fans - (!mesh_.on_boundary(v) && first == 1 && last == 1 && fans > 1 ? 1 : 0);
}

bool Cavity::trace() {
  rim_.clear(), turns_.clear(), corners_ = 0;
  const auto is_outer = [&](int h) {
    return mesh_.twin(h) < 0 || !has(QuadTopology::element(mesh_.twin(h)));
  };
  std::size_t n_outer = 0;
  int first = -1;
  for (const int e : elements_)
    for (int h = 4 * e; h < 4 * e + 4; ++h) {
      if (!is_outer(h)) continue;
      ++n_outer;
      if (first < 0 || h < first) first = h;
    }
  int h = first;
  do {
    if (rim_.size() == n_outer) return false;
    rim_.push_back(h);
    turns_.push_back(2 - wanted(mesh_.origin(h)));
    corners_ += turns_.back();
    h = mesh_.next(h);
    while (!is_outer(h)) h = mesh_.next(mesh_.twin(h));
  } while (h != first);
  return rim_.size() == n_outer && corners_ >= 2 && corners_ <= 8;
}

bool CavitySearch::add_path(int from) {
  if (!cavity_.add_around(from)) return false;
  bool good = true;
  for (int v = from; from_[v] != v && good; v = from_[v])
    mesh_.for_each_out(v, [&](int h) {
      const int e = QuadTopology::element(h);
      bool on_way = false;
      for (int k = 0; k < 4; ++k) on_way |= mesh_.corner(e, k) == from_[v];
      if (on_way) good = good && cavity_.add(e);
    });
  return good;
}

bool CavitySearch::add_ring() {
  return std::ranges::all_of(cavity_.rim(), [&](int h) { return cavity_.add_around(mesh_.origin(h)); });
}

}  // namespace delquad
