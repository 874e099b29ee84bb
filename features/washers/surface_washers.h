#pragma once

#include <map>
#include <string>
#include <vector>

#include "delquad/model.h"
#include "features/washers/hole_rows.h"
#include "geometry/planar/planar_model.h"
#include "geometry/surface/surface_model.h"

namespace delquad {

/// Rings around holes in faces of a surface: curves at equal distance from the holes, along the surface, part
/// faces of their own from those around, with as many edges on both sides and so many rows.
class SurfaceWashers {
 public:
  /// Adds the curves to the lines that are to be imprinted. Holes with curves that `divisions` name get none.
  /// Warnings, of the model, tell of those that get fewer rows than asked for, or none.
  void plan(const std::vector<WasherSpec>& washers, const std::vector<CurveDivision>& divisions,
            const PointSize& size, SurfaceModel& model);
  /// Once they are imprinted: parts the faces, and adds what their curves and rings are to have.
  void cut(SurfaceModel& model, std::vector<CurveDivision>& divisions, MappedSpec& mapped) const;

 private:
  struct Ring {
    int face;
    std::vector<int> curves;  ///< of the hole
    HoleRows rows;
    std::string where, at;
  };
  std::vector<Ring> rings_;
};

/// Numbers of edges by curve.
std::map<int, int> divided_curves(const Mesh& mesh, const std::vector<CurveDivision>& divisions);

/// Adds what the fillets of a CAD model are to have: numbers of edges of the curves that run across them,
/// rows of those that are rings. Curves that are divided already stay as they are.
void divide_fillets(const std::vector<FilletRows>& fillets, const SurfaceModel& model,
                    std::vector<CurveDivision>& divisions, MappedSpec& mapped);

}  // namespace delquad
