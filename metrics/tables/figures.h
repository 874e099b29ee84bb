#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/diagram.h"
#include "metrics/tables/inference.h"
#include "metrics/tables/result_records.h"

namespace delquad {

/// A diagram with the data behind it.
struct Figure {
  std::string name;  ///< of its files, without extension
  Diagram diagram;
  std::string csv;
};

/// Folder of the figures, below that of the results.
inline constexpr const char* kFigures = "figures";

/// Comparisons of pipelines over at least three cases: quality against time, tau against irregular vertices,
/// and performance profiles (Dolan and More 2002) of 1 - eta, 100 - tau and time, in which every cell counts
/// and one without a sound mesh is infinitely bad. None where there are fewer cases, or one pipeline that
/// makes quads. Variants that some pipeline has no record of yet, or whose data was absent, are left out.
std::vector<Figure> make_figures(const std::vector<CellRecord>& records);

/// For each measure of pairs their effects, with 95 % intervals: dots of what is proven, without a failure,
/// are full.
std::vector<Figure> figures_of_effects(const Inference& inference);
/// Writes them to DIR/figures as SVG, PDF and CSV, and removes those of earlier runs that there are no
/// longer; returns what could not be written.
std::vector<std::string> write_figures(const std::filesystem::path& folder,
                                       const std::vector<Figure>& figures);

}  // namespace delquad
