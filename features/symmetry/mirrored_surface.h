// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "features/symmetry/mirror_match.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/planar/planar_model.h"

// This header cuts a symmetric surface, so that one part is meshed. The pipeline, features and measures use
// it.

namespace delquad {

/// The part of a symmetric model on the positive side of its planes: a half, a quarter or an eighth.
struct SymmetricHalf {
  /// It has the faces of the whole model, some without triangles, and the pieces of its curves; sections at
  /// the planes are further curves. Its places on planes lie on them to rounding.
  SurfaceModel model;
  std::vector<int> whole_curve;   ///< by curve of the half; -1: a section
  std::vector<int> curve_planes;  ///< by curve of the half, bits of the planes that it lies on
  struct Place {
    Vec3 at;
    int planes;  ///< bits
  };
  std::vector<Place> touching;  ///< places on planes where the half meets its image, but not on a curve there
  std::vector<int> face_planes;  ///< by face, bits of the planes that it lies in, as its own image
};

/// Cuts a model at its planes and returns the part on their positive sides. `matches` has an entry for each
/// plane. Curves that leave a plane and return to it within some sizes get a corner between, and so do cracks
/// on planes. Otherwise two images could share an edge of the mesh. Throws InputError, beginning with
/// `where`, if a face lies in a plane in part, and if a corner or a named point has no image.
SymmetricHalf cut_symmetric(const SurfaceModel& whole, const SymmetryPlanes& planes,
                            const std::vector<MirrorMatch>& matches, const SizeField& size,
                            const std::string& where);

/// A surface of which one part is meshed, and the rest is its mirror image.
struct MirroredSurface {
  WholeSurface whole;  ///< its last curves are the images of the cuts
  int first_cut;       ///< index of the first such curve
  SymmetryPlanes planes;
  std::vector<MirrorMatch> matches;  ///< of each plane
  std::vector<int> whole_curve;      ///< of each curve of the part; -1: a section, which is none of the whole
  std::vector<int> curve_planes, face_planes;  ///< as in SymmetricHalf, with cuts
  std::vector<int>
      node_planes;  ///< of the nodes on curves, the bits of the planes where they are their images
};

/// A symmetric surface, cut at its planes.
struct CutSurface {
  SurfaceModel whole;
  SymmetryPlanes planes;
  std::vector<MirrorMatch> matches;
  SymmetricHalf half;
};

/// Cuts a surface at the planes of the problem. Returns nothing if no planes are requested, or, with a
/// warning of the model, if none are found. `size` becomes the least of the sizes at the images of a place.
/// Throws InputError for planes at which it is not symmetric, with the part without an image and its
/// distance. Also throws beside periodic sides.
std::optional<CutSurface> cut_at_planes(const MeshProblem& problem, SurfaceModel& model,
                                        std::shared_ptr<const SizeField>& size);

/// Returns the divisions of the curves of the part; the two sides of a plane share the edges of a curve
/// through it. Throws InputError for impossible numbers, with a possible one, and for curves that are divided
/// differently from their images.
std::vector<CurveDivision> divisions_of_part(const std::vector<CurveDivision>& divisions,
                                             const CutSurface& surface);

/// Returns for each face or curve of the part the largest value of its images in the whole.
std::vector<double> most_of_faces(std::vector<double> values, const CutSurface& surface);
std::vector<double> most_of_curves(const std::vector<double>& values, const CutSurface& surface);

/// Makes the domain of the whole symmetric surface from the domain of the part, its model and its cuts. The
/// sizes of the problem count at all images.
void add_whole(CutSurface cut, SurfaceSetup& surface, MeshingSetup& p);

/// Returns the image of a face of the whole at all planes whose bits are set.
int image_face(const MirroredSurface& mirrored, int planes, int face);

/// Returns the curves of the whole that have the image of a curve of it at all planes whose bits are set.
std::vector<int> image_curves(const MirroredSurface& mirrored, int planes, int curve);

/// Returns the image of a node on curves of the part, which lies on its planes.
Vec3 image_node(const MirroredSurface& mirrored, int planes, int node, const Vec3& x);

/// Returns the marked faces and all their images.
std::vector<char> with_images(const MirroredSurface& mirrored, std::vector<char> faces);

/// Adds the images of failed faces, with the same reasons.
void add_failures_of_images(const MirroredSurface& mirrored, std::vector<FaceFailure>& failures);

/// Returns the mesh of the part, completed by its images. Its first points are the nodes on its curves. Nodes
/// on planes are moved onto them to rounding and exist once, like elements in them. The mesh has the curves,
/// faces and named points of the whole. The images of its first `n_first` quads follow these.
Mesh mirror_mesh(const MirroredSurface& mirrored, Mesh part, std::size_t n_first);

}  // namespace delquad
