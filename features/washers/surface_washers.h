// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "delquad/error.h"
#include "delquad/mesher.h"
#include "features/washers/hole_rows.h"
#include "geometry/planar/planar_model.h"
#include "geometry/surface/chart.h"
#include "geometry/surface/surface_model.h"

// This header adds rings around holes of surfaces. The pipeline and features use it.

namespace delquad {

/// A chart with the curve of each side of its loops.
struct OutlinedChart : Chart {
  std::vector<std::vector<int>> curve_of = {};
};
/// Returns the charts of all faces of a triangulation.
std::vector<OutlinedChart> outlined_charts(const Mesh& mesh);

/// Rows around holes in faces of a surface: layers with equal numbers of edges on both sides. The other end
/// of a bore gets the edges of the first, and the face between becomes a grid if that pays. Curves across
/// fillets get numbers of edges, and fillets that are rings get rows. Own method.
class SurfaceWashers {
 public:
  /// `divisions`, `mapped` and `layers` belong to the model, and get the demands of holes and fillets.
  /// Divided curves stay.
  SurfaceWashers(const MeshProblem& problem, SurfaceModel& model, std::vector<CurveDivision>& divisions,
                 MappedSpec& mapped, std::vector<LayerSpec>& layers)
      : problem_(problem), model_(model), divisions_(divisions), mapped_(mapped), layers_(layers) {}

  /// Divides the outlines of holes and adds layers there. Warnings, of the model, tell of holes that get
  /// other rows than asked for, or none.
  void plan(const SizeField& size);
  void divide_fillets();
  /// Removes added divisions, and their layers, of curves of a face that cannot be meshed with them. Returns
  /// whether there were any.
  bool give_way(const FaceError& error);
  bool can_give_way() const { return n_added_ > 0; }

 private:
  /// Curves at both ends of a tube, or on opposite sides of a strip.
  struct FacingSides {
    int face;
    std::array<std::vector<int>, 2> sides;
  };
  static std::vector<FacingSides> facing_sides(const OutlinedChart& chart);
  void find_divided();
  void divide(int curve, int edges, const std::string& where);
  bool are_rims(const std::vector<int>& side) const;
  /// Gives the edges of rims to the curves that face them along bores, and from there on.
  void spread(const std::vector<FacingSides>& facing, double size, const std::string& where);

  const MeshProblem& problem_;
  SurfaceModel& model_;
  std::vector<CurveDivision>& divisions_;
  MappedSpec& mapped_;
  std::vector<LayerSpec>& layers_;
  std::map<int, int> edges_;    ///< by divided curve
  std::set<int> rims_;          ///< divided curves around holes with rows, and at other ends of bores
  std::ptrdiff_t n_added_ = 0;  ///< divisions, the last ones
};

}  // namespace delquad
