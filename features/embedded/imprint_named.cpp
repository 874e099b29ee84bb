#include <utility>

#include "features/embedded/imprint.h"
#include "features/sizes/named_parts.h"
#include "features/sizes/size_warnings.h"

namespace delquad {

std::shared_ptr<const SizeField> imprint_named(const std::vector<NamedSize>& named,
                                               std::shared_ptr<const SizeField> size, SurfaceModel& model,
                                               std::vector<Warning>& warnings) {
  const auto imprint_with = [&](const std::shared_ptr<const SizeField>& at) {
    imprint(model, [&at, hint = -1](const Vec3& x) mutable { return at->at(x, hint); });
  };
  if (named.empty()) {
    imprint_with(size);
    return size;
  }
  // Of the triangles before they are split: the same sizes to the last bit, whatever is imprinted.
  NamedParts parts(model.fine);
  const std::size_t n_curves = model.fine.curves.size(), n_points = model.fine.named_points.size();
  // Edges at single points follow their sizes, before the lines have their places on the surface.
  std::vector<FineSpot> spots = parts.known_spots(named);
  const std::vector<FineSpot> loose = NamedParts(model.loose).known_spots(named);
  spots.insert(spots.end(), loose.begin(), loose.end());
  imprint_with(finer_near(size, std::move(spots)));
  parts.add_lines(model.fine, n_curves, n_points);
  warn_of_idle_sizes(named, parts, *size, warnings);
  return finer_near(size, parts.spots(named));
}

}  // namespace delquad
