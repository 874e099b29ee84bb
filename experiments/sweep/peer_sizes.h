#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/sweep/peer.h"

namespace delquad {

/// The triangles of F, of the wanted size: in the plane, or on the surface.
Mesh triangles_of_domain(const Prepared& prepared);

/// A size field by its values at the nodes of triangles that are as large as it says.
struct SampledSize {
  Mesh mesh;
  std::vector<double> delta;  ///< at its points
};
/// What the peer is told.
SampledSize sample_sizes(const PeerTask& task);

/// Writes size.FORMAT, one of size_field_formats(), and returns the file: "pos", a view of Gmsh; "sol",
/// values for Medit's size.mesh beside it; "points", lines "x y z delta".
std::filesystem::path write_size_field(const SampledSize& size, const std::string& format,
                                       const std::filesystem::path& folder);

}  // namespace delquad
