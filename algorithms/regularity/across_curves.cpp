// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/across_curves.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "algorithms/regularity/visit.h"
#include "base/parallel.h"
#include "base/stopwatch.h"

namespace delquad {

namespace across {
namespace {

/// Vertices visited in parallel.
constexpr std::size_t kAtOnce = 32;

class AcrossCurves {
 public:
  AcrossCurves(CurveNetwork& network, const RegularityOptions& options)
      : network_(network), shared_{network, options, {}, {}} {}

  AcrossCurvesSummary run() {
    begin();
    while (!pending_.empty()) {
      const std::size_t n = std::min(kAtOnce, pending_.size());
      std::vector<Visited> found(n);
      parallel_for(n, [&](std::size_t i) {
        const auto searches = acquire_searches();
        found[i] = visit(shared_, *searches, pending_[i].patch, pending_[i].vertex);
        release_searches(searches);
      });
      take(found);
    }
    parallel_for(network_.patches.size(), [&](std::size_t p) {
      if (network_.patches[p].changed) relax(network_.patches[p]);
    });
    summary_.patches = static_cast<int>(std::ranges::count_if(network_.patches, &PatchAtCurves::changed));
    return summary_;
  }

 private:
  /// An irregular vertex to visit; negative: it was removed.
  struct Place {
    int patch, vertex;
    friend bool operator==(const Place&, const Place&) = default;
  };

  void begin() {
    const std::size_t n = network_.patches.size();
    shared_.works.resize(n);
    parallel_for(n, [&](std::size_t p) {
      PatchAtCurves& patch = network_.patches[p];
      const auto crosses = [&](const CurveEdge& e) { return shared_.may_cross(e); };
      if (patch.size != nullptr && std::ranges::any_of(patch.edges, crosses))
        shared_.works[p] = std::make_unique<PatchWork>(patch, p);
    });
    versions_ = n;
    // Patches alternate, since vertices of one patch examine the same quads.
    std::vector<std::pair<int, Place>> places;
    for (std::size_t p = 0; p < n; ++p)
      if (const auto& w = shared_.works[p])
        for (int v = 0, rank = 0; v < w->mesh.vertex_slots(); ++v)
          if (w->energy.of(v) > 0) places.push_back({rank++, {static_cast<int>(p), v}});
    std::ranges::stable_sort(places, {}, &std::pair<int, Place>::first);
    for (const auto& [rank, place] : places) pending_.push_back(place);
  }

  std::shared_ptr<SearchPool> acquire_searches() {
    const std::scoped_lock held(lock_);
    if (idle_.empty()) return std::make_shared<SearchPool>();
    auto one = std::move(idle_.back());
    idle_.pop_back();
    return one;
  }
  void release_searches(std::shared_ptr<SearchPool> one) {
    const std::scoped_lock held(lock_);
    idle_.push_back(std::move(one));
  }

  /// Accepts results of the first pending vertices. A vertex is visited again if an earlier result changed a
  /// patch that it examined.
  void take(std::vector<Visited>& found) {
    std::vector<char> changed(network_.patches.size(), 0);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (std::ranges::any_of(found[i].looked_at, [&](int p) { return changed[p] != 0; })) continue;
      pending_[i].vertex = -1;
      shared_.lost.insert(found[i].lost.begin(), found[i].lost.end());
      summary_.tried += found[i].tried;
      if (found[i].parts.empty()) continue;
      accept(found[i]);
      for (const Filled& part : found[i].parts) changed[part.patch] = 1;
    }
    std::erase_if(pending_, [](const Place& place) { return place.vertex < 0; });
  }

  void accept(const Visited& found) {
    ++summary_.accepted;
    summary_.gained += found.gain;
    summary_.longest = std::max(summary_.longest, static_cast<int>(found.parts.size()));
    std::vector<std::pair<Change, std::vector<double>>> changed;
    std::vector<Place> near;
    for (std::size_t i = 0; i < found.parts.size(); ++i) {
      const Filled& part = found.parts[i];
      PatchWork& w = *shared_.works[part.patch];
      FillTaking taking(w, *searches_.take(w, part.patch, part.elements), *part.fill, part.rim);
      taking.finish(part.changes);
      for (Place& place : pending_)
        if (place.patch == part.patch && place.vertex >= 0) place.vertex = taking.number[place.vertex];
      for (const int v : taking.of_local) near.push_back({part.patch, v});
      if (i + 1 < found.parts.size())
        changed.emplace_back(part.changes.back(), shared_.new_places(part.changes.back()));
    }
    for (const auto& [change, places] : changed) {
      auto& nodes = network_.nodes[change.curve];
      nodes.erase(nodes.begin() + change.from + 1, nodes.begin() + change.to);
      nodes.insert(nodes.begin() + change.from + 1, places.begin() + 1, places.end() - 1);
    }
    for (const Filled& part : found.parts)
      shared_.works[part.patch] = std::make_unique<PatchWork>(network_.patches[part.patch], versions_++);
    for (const Place& place : near)
      if (shared_.works[place.patch]->energy.of(place.vertex) > 0 &&
          std::ranges::find(pending_, place) == pending_.end())
        pending_.push_back(place);
  }

  static void relax(PatchAtCurves& patch) {
    QuadTopology mesh(patch.mesh);
    QuadRelocation relocation(mesh, *patch.size);
    limit_relocation(relocation);
    relocation.activate_all();
    relax_at_last(relocation);
    patch.mesh = mesh.to_patch();
  }

  CurveNetwork& network_;
  Shared shared_;
  std::uint64_t versions_ = 0;
  std::vector<Place> pending_;
  std::mutex lock_;
  std::vector<std::shared_ptr<SearchPool>> idle_;  ///< guarded by lock_
  SearchPool searches_;
  AcrossCurvesSummary summary_;
};

}  // namespace
}  // namespace across

AcrossCurvesSummary make_regular_across_curves(CurveNetwork& network, const RegularityOptions& options) {
  const Stopwatch watch;
  AcrossCurvesSummary summary = across::AcrossCurves(network, options).run();
  summary.seconds = watch.seconds();
  return summary;
}

}  // namespace delquad
