#include "features/periodic/paired_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "base/nearest_name.h"
#include "delquad/error.h"
#include "features/sizes/named_parts.h"

namespace delquad {
namespace {

/// What a name stands for.
struct NamedSide {
  std::string name;
  std::vector<int> faces, curves;
};

NamedSide named_side(const Mesh& fine, const PeriodicPair& pair, const std::string& name) {
  NamedSide side{name, entities_named(fine.regions, "region", name),
                 entities_named(fine.curves, "curve", name)};
  if (!side.faces.empty() || !side.curves.empty()) return side;
  std::vector<std::string> known;
  for (const auto* entities : {&fine.regions, &fine.curves})
    for (const Entity& e : *entities) known.insert(known.end(), e.names.begin(), e.names.end());
  throw InputError(fmt::format("{}: no curve and no face is called '{}'{}", pair.where, name,
                               suggestion_or_all(name, known)));
}

void warn_of_both(const PeriodicPair& pair, const NamedSide& side, std::vector<Warning>& warnings) {
  if (!side.faces.empty() && !side.curves.empty())
    warnings.push_back({"names of periodic sides that faces and curves have", 0,
                        fmt::format("{}: '{}' is the name of faces and of curves: the faces are paired",
                                    pair.where, side.name)});
}

void check_faces_once(const Mesh& fine, const FacePair& pair, const std::vector<FacePair>& known) {
  for (const FacePair& other : known)
    for (const int face : {pair.face, pair.master})
      if (face == other.face || face == other.master)
        throw InputError(fmt::format(
            "{}: face {} is in two pairs of periodic sides, with '{}' and '{}', and "
            "with '{}' and '{}'",
            pair.of.where, fine.regions[face].tag, other.of.from, other.of.to, pair.of.from, pair.of.to));
}

}  // namespace

PeriodicSides find_periodic_sides(const SurfaceModel& model, const std::vector<PeriodicPair>& asked,
                                  std::vector<Warning>& warnings) {
  const Mesh& fine = model.fine;
  PeriodicSides sides;
  for (const PeriodicPair& pair : asked) {
    if (pair.from == pair.to)
      throw InputError(fmt::format("{}: '{}' is 'from' and 'to': expected two sides", pair.where, pair.from));
    const NamedSide from = named_side(fine, pair, pair.from), to = named_side(fine, pair, pair.to);
    if (!from.faces.empty() && !to.faces.empty()) {
      for (const NamedSide* side : {&from, &to}) warn_of_both(pair, *side, warnings);
      for (const int face : from.faces)
        if (std::ranges::count(to.faces, face) > 0)
          throw InputError(fmt::format("{}: face {} is one of '{}' and one of '{}': expected two sides",
                                       pair.where, fine.regions[face].tag, pair.from, pair.to));
      for (FacePair& found : pair_faces(model, from.faces, to.faces, pair)) {
        check_faces_once(fine, found, sides.faces);
        sides.faces.push_back(std::move(found));
      }
      continue;
    }
    if (from.curves.empty() || to.curves.empty()) {
      const NamedSide& face = from.curves.empty() ? from : to;
      const NamedSide& curve = from.curves.empty() ? to : from;
      throw InputError(fmt::format("{}: '{}' is a face and '{}' a curve: expected two faces, or two curves",
                                   pair.where, face.name, curve.name));
    }
    sides.curves.push_back(pair);
  }
  return sides;
}

}  // namespace delquad
