// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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
  /// With the faces of the whole, some without triangles, and the pieces of its curves; sections at the
  /// planes are curves of their own. All of its places on planes lie on them to rounding.
  SurfaceModel model;
  std::vector<int> whole_curve;   ///< of each curve of the half; -1: a section
  std::vector<int> curve_planes;  ///< of each curve of the half, the bits of the planes that it lies on
  struct Place {
    Vec3 at;
    int planes;  ///< bits
  };
  std::vector<Place> touching;   ///< places on planes where the half meets its image, and on no such curve
  std::vector<int> face_planes;  ///< of each face, the bits of the planes that it lies in, its own image
};

/// Cuts a model at its planes and keeps what lies on their positive sides. `matches`: of each plane. Curves
/// that leave a plane and come back to it, shorter than some sizes, get a corner between. A mesh of two
/// images must not have both as the same edge. Throws InputError, beginning with `where`, where a face lies
/// in a plane in part, and where a corner or a named point has no image.
SymmetricHalf cut_symmetric(const SurfaceModel& whole, const SymmetryPlanes& planes,
                            const std::vector<MirrorMatch>& matches, const SizeField& size,
                            const std::string& where);

/// A surface of which one part is meshed, and the rest is its mirror image.
struct MirroredSurface {
  WholeSurface whole;  ///< its curves end with the images of the cuts
  int first_cut;       ///< the first of these
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

/// Cuts a surface at the planes of the problem. None: no planes are asked for, or none are found, which a
/// warning of the model says then. `size` becomes the least of the sizes at the images of a place. Throws
/// InputError for planes at which it is not symmetric, naming the part without an image and its distance. So
/// it does where periodic sides are asked for, too.
std::optional<CutSurface> cut_at_planes(const MeshProblem& problem, SurfaceModel& model,
                                        std::shared_ptr<const SizeField>& size);

/// Returns the divisions of the curves of the part: divisions of curves that go through a plane are shared by
/// both sides. Throws InputError for numbers that cannot be, naming one that can, and for curves that are
/// divided otherwise than their images.
std::vector<CurveDivision> divisions_of_part(const std::vector<CurveDivision>& divisions,
                                             const CutSurface& surface);

/// Returns the most of these values, of the faces or curves of the whole, at their images; of the part.
std::vector<double> most_of_faces(std::vector<double> values, const CutSurface& surface);
std::vector<double> most_of_curves(const std::vector<double>& values, const CutSurface& surface);

/// Makes a domain of the whole symmetric surface from the domain of the part, its model and its cuts. The
/// sizes of the problem count at all images.
void add_whole(CutSurface cut, SurfaceSetup& surface, MeshingSetup& p);

/// Returns the image of a face of the whole at all planes whose bits are set.
int image_face(const MirroredSurface& mirrored, int planes, int face);

/// Returns the faces that are marked, and all that are their images.
std::vector<char> with_images(const MirroredSurface& mirrored, std::vector<char> faces);

/// Adds the faces that are images of those that failed, for the same reasons.
void add_failures_of_images(const MirroredSurface& mirrored, std::vector<FaceFailure>& failures);

/// Returns the mesh of the part, whose first points are the nodes on its curves, completed by its images.
/// Nodes on planes, which are moved onto them to rounding, stand once, and so do elements in them. It has the
/// curves, faces and named points of the whole.
Mesh mirror_mesh(const MirroredSurface& mirrored, Mesh part);

}  // namespace delquad
