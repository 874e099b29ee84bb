// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiments/sweep/machine.h"
#include "experiments/sweep/metric_command.h"
#include "experiments/sweep/peer.h"
#include "io/digest.h"

// This header writes the records of cells. The program, the bench and the report use it.

namespace delquad {

/// The parts of a cell's record that identify the cell, so that it can be found and repeated.
struct CellIdentity {
  std::string key;  ///< digest of everything that determines the result
  std::string model_digest, program_digest;
  std::string experiment = {};                         ///< its copy, relative to the folder of the results
  MachineState start = {};                             ///< at the beginning of the work
  std::map<std::string, FileMark> files = {};          ///< files of the cell, except the record
  const Peer* peer = nullptr;                          ///< in place of a pipeline
  std::string peer_version = {};                       ///< empty: not known
  std::string no_peer_version = {};                    ///< why it is not known
  std::map<std::string, std::string> peer_files = {};  ///< files that its command names, with their digests
  std::string peer_file = {};  ///< file of the peer, relative to the folder of the experiment's file
  /// Measures by command, and the digests of the files that determine each.
  struct IdentifiedMetric {
    const MetricCommand* metric;
    std::map<std::string, std::string> files;
  };
  std::vector<IdentifiedMetric> metrics = {};
  std::vector<std::string> solvers = {};  ///< solvers that measure the mesh
};

/// Returns the JSON record of a pipeline on a case, with a newline at the end: every option, work of stages,
/// times, measures, versions. In experiments it is sealed(); `cell` is null outside of these.
std::string run_record(const Case& c, const Pipeline& pipeline, const MeshResult& result,
                       const CellIdentity* cell = nullptr);
/// Returns the record of a cell that was not run: its status "failed" or "skipped", and the kind of the
/// reason. Kinds are as in ProcessFailure, or "data not found".
std::string failure_record(const Case& c, const Pipeline& pipeline, const std::string& status,
                           const std::string& kind, const std::string& reason,
                           const CellIdentity* cell = nullptr);
/// Returns the record of the measures of a mesh file; `criteria` is null if it was not judged.
std::string metrics_record(const std::string& mesh_file, const Mesh& mesh, const std::string& size,
                           const MeshMetrics& metrics, const CriteriaReport* criteria = nullptr);
/// Returns the inputs besides the case that determine the mesh of a peer, in one line of JSON.
std::string peer_record(const CellIdentity& cell);
/// Returns the inputs that determine a cell's measures by command and by solvers, in one line of JSON.
std::string metrics_by_command_record(const CellIdentity& cell);
/// Returns version, commit, compiler and libraries in one line of JSON.
std::string versions_record();

}  // namespace delquad
