#pragma once

#include <functional>

#include "geometry/surface/surface_model.h"
#include "io/mesh_io.h"
#include "pipeline/prepare.h"

namespace delquad {

/// Whether the file holds a surface by its extension: CAD (.step, .stp, .brep) or triangles (.stl, .obj,
/// .off).
bool is_surface_file(const std::filesystem::path& path);

/// Whether some triangle or quad does not lie in the plane of constant z of the first.
bool holds_surface(const Mesh& mesh);

/// The surface model of a mesh in space from a file, its quads split. `notes` become warnings.
SurfaceModel make_triangle_model(const Case& c, Mesh mesh, const std::string& source, ReadNotes notes = {});

/// Reads the surface model of a case, with its compounds.
SurfaceModel read_surface(const Case& c);

/// Faces flattened, curves meshed once each, all patches even; cross field and size on each patch. Refuses
/// sizes that would need more than options.max_elements through `check_count`. Throws InputError naming faces
/// that cannot be meshed, unless options.keep_going leaves them out and others remain.
PreparedCase prepare_surface(const Case& c, SurfaceModel model, std::shared_ptr<const SizeField> size,
                             const std::function<void(double quads)>& check_count);

}  // namespace delquad
