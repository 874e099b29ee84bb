#include "features/layers/curve_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/nearest_name.h"
#include "delquad/error.h"
#include "geometry/mesh/entity_names.h"

namespace delquad {
namespace {

bool is_named(const Entity& entity, const std::string& name) {
  return std::ranges::find(entity.names, name) != entity.names.end();
}

std::vector<std::string> names_of(const std::vector<Entity>& entities) {
  std::vector<std::string> names;
  for (const Entity& entity : entities) names.insert(names.end(), entity.names.begin(), entity.names.end());
  return names;
}

/// Curves of which each line has a patch beside it, another one or none on the other side, and no crack.
std::vector<char> bounding_curves(const PlanarDomain& domain) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> patches;
  for (std::size_t p = 0; p < domain.patches.size(); ++p)
    for (const auto& [a, b] : domain.patches[p].edges)
      patches[std::minmax(domain.patches[p].point_node[a], domain.patches[p].point_node[b])].push_back(p);
  const std::set<int> on_crack(domain.on_crack.begin(), domain.on_crack.end());
  std::vector<char> bounds(domain.boundary.curves.size(), 1);
  for (std::size_t l = 0; l < domain.boundary.lines.size(); ++l) {
    const auto& [a, b] = domain.boundary.lines[l];
    const std::vector<std::size_t>& beside = patches[std::minmax(a, b)];
    const bool stands_inside = beside.size() == 2 && beside[0] == beside[1];
    if (beside.empty() || stands_inside || (on_crack.contains(a) && on_crack.contains(b)))
      bounds[domain.boundary.line_curve[l]] = 0;
  }
  return bounds;
}

std::vector<std::set<int>> regions_of_curves(const PlanarDomain& domain) {
  std::vector<std::set<int>> regions(domain.boundary.curves.size());
  for (std::size_t p = 0; p < domain.patches.size(); ++p)
    for (const int curve : domain.patches[p].edge_curve)
      if (curve >= 0) regions[curve].insert(domain.patch_region[p]);
  return regions;
}

std::vector<char> regions_named(const PlanarDomain& domain, const LayerSpec& spec) {
  const std::vector<Entity>& regions = domain.boundary.regions;
  if (spec.into.empty()) return {};
  std::vector<char> into(regions.size(), 0);
  for (const std::string& name : spec.into) {
    const std::vector<std::string> known = names_of(regions);
    if (std::ranges::find(known, name) == known.end())
      throw InputError(
          fmt::format("{}: no region has the name '{}'{}", spec.where, name, suggestion_or_all(name, known)));
    for (std::size_t r = 0; r < regions.size(); ++r)
      if (is_named(regions[r], name)) into[r] = 1;
  }
  return into;
}

}  // namespace

int CurveLayers::at(int curve, int region) const {
  if (curve < 0) return -1;
  for (const int s : of_curve[curve])
    if (into[s].empty() || into[s][region]) return s;
  return -1;
}

CurveLayers layers_of_curves(const PlanarDomain& domain, std::span<const LayerSpec> specs) {
  const std::vector<Entity>& curves = domain.boundary.curves;
  const std::vector<std::string> known = names_of(curves);
  const std::vector<char> bounds = bounding_curves(domain);
  const std::vector<std::set<int>> regions = regions_of_curves(domain);
  CurveLayers layers{std::vector<std::vector<int>>(curves.size()), {}};
  for (std::size_t s = 0; s < specs.size(); ++s) {
    layers.into.push_back(regions_named(domain, specs[s]));
    const auto goes_into = [&](std::size_t spec, int r) {
      return layers.into[spec].empty() || layers.into[spec][r];
    };
    for (const std::string& name : specs[s].on) {
      if (std::ranges::find(known, name) == known.end())
        throw InputError(fmt::format("{}: no curve has the name '{}'{}", specs[s].where, name,
                                     suggestion_or_all(name, known)));
      bool is_beside = specs[s].into.empty();  // one of the regions
      for (std::size_t c = 0; c < curves.size(); ++c) {
        std::vector<int>& here = layers.of_curve[c];
        if (!is_named(curves[c], name)) continue;
        for (const int r : regions[c]) is_beside = is_beside || goes_into(s, r);
        if (std::ranges::find(here, static_cast<int>(s)) != here.end()) continue;
        if (!bounds[c])
          throw InputError(
              fmt::format("{}: {} stands inside of one region, or is a crack: expected a curve that bounds "
                          "a region",
                          specs[s].where, curve_title(curves[c])));
        for (const int r : regions[c]) {
          if (!goes_into(s, r)) continue;
          const auto other =
              std::ranges::find_if(here, [&](int o) { return goes_into(static_cast<std::size_t>(o), r); });
          if (other != here.end())
            throw InputError(fmt::format("{}: {} has a layer already, by {}", specs[s].where,
                                         curve_title(curves[c]), specs[*other].where));
        }
        here.push_back(static_cast<int>(s));
      }
      if (!is_beside)
        throw InputError(fmt::format("{}: '{}' bounds none of the regions '{}'", specs[s].where, name,
                                     fmt::join(specs[s].into, "', '")));
    }
  }
  return layers;
}

}  // namespace delquad
