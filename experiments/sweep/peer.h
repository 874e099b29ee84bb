// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "delquad/error.h"
#include "delquad/extend.h"
#include "io/cases/case.h"
#include "metrics/tables/table.h"

// This header runs other meshers. The bench uses it.

namespace delquad {

/// Input for a peer.
enum class HandOver {
  kModel,      ///< planar: our boundary edges; surfaces: the file of the model as it is
  kTriangles,  ///< our triangles of F, of the wanted size
  kNothing     ///< it cannot mesh such domains
};

/// Name of the format of Gmsh's language, which suits every case.
inline constexpr const char* kGmshScript = "geo";

/// Another mesher: a program that runs in place of a pipeline, and whose mesh is measured in the same way.
struct Peer {
  std::string name;  ///< in place of a pipeline
  /// Program and arguments with peer_placeholders(), such as {input} and {output}. A program with a slash,
  /// and words that name files, are relative to `folder`.
  std::vector<std::string> command;
  std::vector<std::string> version;  ///< program and arguments that print its version
  /// Format of its input. "geo" is Gmsh's language, for every case. With another format it gets the lines of
  /// a planar domain, or the file of a surface.
  std::string input = kGmshScript;
  std::string output = "msh";         ///< format of its output
  std::vector<int> exit_codes = {0};  ///< exit codes with a usable mesh
  /// Its planar meshes have exactly the given boundary edges; else they must cover the same area.
  bool keeps_boundary = true;
  HandOver planar = HandOver::kModel, surfaces = HandOver::kModel;
  /// Format of the file {size_field}: "pos", "sol" or "points", see docs/experiments.md; empty: none.
  std::string size_field = {};
  bool metrics = false;                ///< it knows metrics, and gets their tensors in that file
  std::optional<bool> calibrate = {};  ///< absent: as the experiment says
  std::string calibrate_to = {};  ///< pipeline whose number of quads it should have; empty: the size is given
  std::filesystem::path file = {}, folder = {};  ///< its source
};

/// The peer cannot get the case; nothing has failed.
class NotApplicable : public Error {
 public:
  using Error::Error;
};

/// A peer is missing, failed, or wrote no sound mesh of the case.
class PeerError : public Error {
 public:
  using Error::Error;
};

/// Returns all placeholders of commands of peers.
const std::vector<std::string>& peer_placeholders();

/// Returns the version that the peer prints, in one line; it is asked once. Throws PeerError, and InputError
/// if its output cannot be stored.
std::string peer_version(const Peer& peer);

/// The task of a peer for a case.
struct PeerTask {
  const Peer& peer;
  const Case& c;
  const Prepared& prepared;  ///< with the boundary for the peer
  double scale = 1;          ///< sizes for the peer over sizes of the case
  double field_scale = 1;    ///< the same, over the size of `prepared`
};

/// Folder and key of the cell of the pipeline to which a peer is calibrated; empty: none.
struct ReferenceCell {
  std::filesystem::path folder;
  std::string key;
};

/// Returns the mesh of a peer. For planar cases Gmsh gets the curves, others the same boundary edges; for
/// surfaces they get the model. Sizes are a number, or values at the nodes of F. For a calibrated peer, its
/// size and boundary change until it has the reference's number of quads, see calibrate_scale().
///
/// It works in the new folder `scratch`, where peer.log has its output. `label` names case and peer in
/// warnings. Throws NotApplicable and PeerError, and JobFailed if the reference fails: then the peer is not
/// run. A mesh with unsound elements, see Prepared::measure(), is a result that says so.
MeshResult run_peer(const Peer& peer, const Case& c, const Prepared& prepared, const std::string& label,
                    const std::filesystem::path& scratch, const ReferenceCell& reference = {});
/// Returns the mesh of a cell by the pipeline, or by the peer unless that is null. If the case has a loop,
/// peers run at its sizes. Throws as run_peer() and delquad::mesh().
MeshResult mesh_cell(const Case& c, const Pipeline& word, const Peer* peer,
                     const std::filesystem::path& scratch);

/// Returns delta, as it was written, if it is uniform; otherwise nothing.
std::optional<double> uniform_size(const Case& c);

/// Returns the program and arguments for a task. Throws NotApplicable if they need something that the case
/// lacks.
std::vector<std::string> peer_command(const PeerTask& task, const std::filesystem::path& input,
                                      const std::string& output, const std::filesystem::path& size_field);

/// Returns the command with the name of the case; files that it names belong to the key of the cell.
std::vector<std::string> command_of_case(const Peer& peer, const std::string& name);

/// Values of a size field or a metric at the nodes of triangles of that size.
struct SampledSize {
  Mesh mesh;
  std::vector<double> delta;    ///< at its points; empty for a metric
  std::vector<Tensor2> metric;  ///< at its points; empty for a size
};
/// Returns the sizes for the peer.
SampledSize sample_sizes(const PeerTask& task);

/// Writes size.FORMAT and returns the file. "pos" is a view of Gmsh, "sol" has values for Medit's size.mesh
/// beside it, "points" has lines "x y z delta". Metrics are 3 x 3 numbers, or m11, m12 and m22.
std::filesystem::path write_size_field(const SampledSize& size, const std::string& format,
                                       const std::filesystem::path& folder);

/// Returns the lines of a planar domain, in its own plane even if a metric has another one.
Mesh boundary_of(const Prepared& prepared);

/// Writes the input of the peer to `folder` and returns the file. Throws NotApplicable if the case cannot be
/// written.
std::filesystem::path write_peer_input(const PeerTask& task, const std::filesystem::path& folder);

/// Turns elements of a planar mesh counterclockwise. Throws PeerError if it is not sound or does not cover
/// the domain. A kept boundary may have no other edges; else throws as check_place().
void check_peer_mesh(const Peer& peer, const Prepared& prepared, Mesh& mesh);

/// Throws PeerError if a place of the mesh or of the model is farther from the other than 1.25 sizes there.
/// In the plane the boundaries are compared, and edges must follow the curves between regions.
void check_place(const Prepared& prepared, const Mesh& mesh);

/// Returns the number of quads of a pipeline for a case, see count_of_quads(); nothing if it has no mesh. It
/// comes from the record of its cell. If that is missing or outdated, a separate process runs the pipeline,
/// with the same number. Throws JobFailed if that process crashes.
std::optional<double> reference_quads(const Prepared& prepared, const std::string& word,
                                      const ReferenceCell& cell);

/// Returns the planar problem with all sizes multiplied by `scale`, above 0, and a new boundary. Throws
/// InputError as prepare().
Prepared prepare_scaled(const Prepared& prepared, double scale);

}  // namespace delquad
