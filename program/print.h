// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "delquad/hexahedra.h"
#include "delquad/mesher.h"
#include "delquad/options.h"
#include "metrics/tables/tables.h"

// This header prints measures and tables. The commands use it.

namespace delquad {

// All to stdout.

/// Prints a measure on a line; "-" if it is not defined.
void print_metric(const Metric& metric, const MeshMetrics& metrics);
/// Prints every measure except the measures of solvers.
void print_metrics(const MeshMetrics& metrics);

/// Prints the main measures, in four lines: shapes, sizes, irregular vertices, and their charges.
void print_summary(const MeshMetrics& metrics);
/// Prints every measure with -v, otherwise the summary.
void print_measures(const MeshMetrics& metrics);

/// Returns "9 quads, 0 triangles, 16 vertices", cells first if there are any; "nodes" if elements are
/// curved and have more than corners.
std::string show_counts(const Mesh& mesh);

/// Prints the names of the parts of a mesh in one line, and nothing if no part has a name.
void print_names(const Mesh& mesh);

/// Prints the results of criteria, the causes of failures, and their cures.
void print_criteria(const CriteriaReport& report, const Mesh& mesh);
/// Returns one cure for each key: it has all causes and elements of the key, and the value that is enough for
/// all.
std::vector<Cure> cures_by_key(const CriteriaReport& report);

/// Prints the time of each step in seconds, added up over threads.
void print_seconds(const StepTimes& times);

/// Prints numbers, shares of the volume, and least and mean scaled Jacobian of cells by shape, and the
/// defects.
void print_cells(const Mesh& mesh, const CellMeasures& measures,
                 const std::vector<std::string>& defects = {});
/// Returns the same with the parts of the mesh, in JSON.
std::string cells_record(const std::string& source, const Mesh& mesh, const CellMeasures& measures,
                         const std::vector<std::string>& defects = {});

/// Prints how the mesh fits its surface, in one line.
void print_surface_summary(const SurfaceReport& report);
/// Prints the whole comparison, with the quality of the surface's maps and its cuts.
void print_surface_report(const Prepared& prepared, const SurfaceReport& report);

/// Prints the tables of an experiment that have rows.
void print_tables(const Outcome& outcome);

}  // namespace delquad
