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

/// How a domain is handed to a peer.
enum class HandOver {
  kModel,      ///< planar: our boundary edges; surfaces: the file of the model as it is
  kTriangles,  ///< our triangles of F, of the wanted size
  kNothing     ///< it cannot mesh such domains
};

/// Gmsh's language, for every case.
inline constexpr const char* kGmshScript = "geo";

/// Another mesher: a program that is run in place of a pipeline, and whose mesh is measured as ours are.
struct Peer {
  std::string name;  ///< in place of a pipeline's word
  /// Program and arguments; {input}, {output} and the others of peer_placeholders() stand for these. A
  /// program with a slash in it counts from `folder`; words that name files there stand for them.
  std::vector<std::string> command;
  std::vector<std::string> version;  ///< program and arguments that print its version
  /// Format that it reads. "geo" is Gmsh's language, for every case. With another format it gets the lines of
  /// a planar domain, and the file of a surface as it is.
  std::string input = kGmshScript;
  std::string output = "msh";         ///< format that it writes
  std::vector<int> exit_codes = {0};  ///< with which it ends when its mesh is worth a look
  /// Its planar meshes have just the boundary edges that they were given; else they are made to cover the
  /// same area.
  bool keeps_boundary = true;
  HandOver planar = HandOver::kModel, surfaces = HandOver::kModel;
  /// Format of the file that {size_field} stands for: "pos", "sol" or "points", which docs/experiments.md
  /// describes; empty: none.
  std::string size_field = {};
  bool metrics = false;                ///< it knows metrics, whose tensors that file has then
  std::optional<bool> calibrate = {};  ///< absent in its file: as the experiment says
  std::string calibrate_to = {};  ///< word whose number of quads it shall have; empty: the size is as given
  std::filesystem::path file = {}, folder = {};  ///< that it was read from
};

/// The case is none that the peer can be told: nothing has failed.
class NotApplicable : public Error {
 public:
  using Error::Error;
};

/// A peer is missing, failed, or wrote no sound mesh of the case.
class PeerError : public Error {
 public:
  using Error::Error;
};

/// Returns the placeholders in the arguments of a peer's command.
const std::vector<std::string>& peer_placeholders();

/// Returns the peer's own word on its version, in one line: it is asked once. Throws PeerError, and
/// InputError where there is no room for what it prints.
std::string peer_version(const Peer& peer);

/// The task that a peer gets for a case.
struct PeerTask {
  const Peer& peer;
  const Case& c;
  const Prepared& prepared;  ///< with the boundary that it gets
  double scale = 1;          ///< the sizes that it is told, over the sizes of the case
  double field_scale = 1;    ///< the same, over the size of `prepared`
};

/// Where the record of the word that a peer is calibrated to will be, and the key that makes it valid; empty:
/// nowhere.
struct ReferenceCell {
  std::filesystem::path folder;
  std::string key;
};

/// Lets the peer mesh a case. Planar cases: Gmsh by the curves, others with the same boundary edges.
/// Surfaces: with the model. Sizes: a number, or what they are at the nodes of F. If the peer is calibrated,
/// its size and the boundary that it gets change until it has the reference's number of quads. See
/// calibrate_scale(). Works in the folder `scratch`, made anew, where peer.log has what it
/// printed. `label` names the case and the peer in warnings. Throws NotApplicable, PeerError, and JobFailed
/// where the word that it is calibrated to fails: then it is not run. A mesh whose elements are not sound,
/// see Prepared::measure(), is a result that says so.
MeshResult run_peer(const Peer& peer, const Case& c, const Prepared& prepared, const std::string& label,
                    const std::filesystem::path& scratch, const ReferenceCell& reference = {});
/// Returns the mesh of a cell, by the word or, unless it is null, by the peer. If the case asks for it, a
/// loop runs peers at the sizes that they are told.
MeshResult mesh_cell(const Case& c, const Word& word, const Peer* peer, const std::filesystem::path& scratch);

/// Returns delta where it is the same everywhere, as it was written.
std::optional<double> uniform_size(const Case& c);

/// Returns the program and arguments for a task. Throws NotApplicable where they ask for what the case does
/// not have.
std::vector<std::string> peer_command(const PeerTask& task, const std::filesystem::path& input,
                                      const std::string& output, const std::filesystem::path& size_field);

/// Returns the command with the case's name in it: files that it names belong to the cell's key.
std::vector<std::string> command_of_case(const Peer& peer, const std::string& name);

/// A size field by its values at the nodes of triangles that are as large as it says, or a metric.
struct SampledSize {
  Mesh mesh;
  std::vector<double> delta;    ///< at its points; none of a metric
  std::vector<Tensor2> metric;  ///< the same of that
};
/// Returns the sizes that the peer gets.
SampledSize sample_sizes(const PeerTask& task);

/// Writes size.FORMAT and returns the file. "pos" is a view of Gmsh, "sol" has values for Medit's size.mesh
/// beside it, "points" has lines "x y z delta". Metrics are 3 x 3 numbers, or m11, m12 and m22.
std::filesystem::path write_size_field(const SampledSize& size, const std::string& format,
                                       const std::filesystem::path& folder);

/// Returns the lines of a planar domain, in its own plane also where a metric has another.
Mesh boundary_of(const Prepared& prepared);

/// Writes what the peer reads to `folder`; returns the file. Throws NotApplicable when the case cannot be
/// told.
std::filesystem::path write_peer_input(const PeerTask& task, const std::filesystem::path& folder);

/// Makes `mesh` run counterclockwise on planar domains. Throws PeerError if it is not sound or does not cover
/// the domain. On a boundary that the peer keeps it may have no other edges; else throws as check_place().
void check_peer_mesh(const Peer& peer, const Prepared& prepared, Mesh& mesh);

/// Throws PeerError if a place of the mesh or of the model is further from the other than 1.25 times the size
/// there. In the plane the boundaries are compared, and the edges have to follow the curves between regions.
void check_place(const Prepared& prepared, const Mesh& mesh);

/// Returns the number of quads that a word makes of a case, see count_of_quads(). It comes from the record of
/// its cell. If that is missing or of something else, a process of its own runs the word, which gives the
/// same number. Nothing if the word has no mesh of the case. Throws JobFailed if that process crashes.
std::optional<double> reference_quads(const Prepared& prepared, const std::string& word,
                                      const ReferenceCell& cell);

/// Returns the planar problem with every size multiplied by `scale`, its boundary made anew at those. Throws
/// InputError as prepare() does.
Prepared prepare_scaled(const Prepared& prepared, double scale);

}  // namespace delquad
