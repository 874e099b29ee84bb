#pragma once

#include <string>
#include <vector>

#include "delquad/model.h"
#include "geometry/surface/surface_model.h"

namespace delquad {

/// A face that gets the mesh of another, moved.
struct FacePair {
  int face, master;  ///< indices into SurfaceModel::fine.regions
  Motion motion;     ///< that takes the master there
  bool is_reversed;  ///< the moved triangles of the master look away from the face
  PeriodicPair of;   ///< who asked for it, for messages
};

/// In what a surface model is periodic.
struct PeriodicSides {
  std::vector<PeriodicPair> curves;
  std::vector<FacePair> faces;
  bool empty() const { return curves.empty() && faces.empty(); }
};

/// To each face of `from` its image among those of `to`. Throws InputError where there is none, and where the
/// two are apart: by more than 1e-6 of the model's diagonal, and on triangulations by more than chords of one
/// surface may be.
std::vector<FacePair> pair_faces(const SurfaceModel& model, const std::vector<int>& from,
                                 const std::vector<int>& to, const PeriodicPair& pair);

}  // namespace delquad
