#include "geometry/surface/surface_messages.h"

#include <fmt/format.h>

namespace delquad {

std::string show_point(const Vec3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); }

std::string counted(long long n, std::string_view what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

}  // namespace delquad
