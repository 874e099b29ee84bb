#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cases/case.h"
#include "mesher/runner.h"

namespace delquad {

/// Another mesher: a program that is run in place of a pipeline, and whose mesh is measured as ours are.
struct Peer {
  std::string name;  ///< in place of a pipeline's word
  /// Program and arguments; {input}, {output}, {size} and {seed} stand for these. A program with a slash in
  /// it counts from `folder`; words that name files there stand for them.
  std::vector<std::string> command;
  std::vector<std::string> version;  ///< program and arguments that print its version
  /// Extension of what it reads: ".geo" is Gmsh's language, for every case; with others it gets the lines of
  /// a planar domain in that format, and the file of a surface as it is.
  std::string input = ".geo";
  std::string output = ".msh";        ///< extension of what it writes
  std::vector<int> exit_codes = {0};  ///< with which it ends when its mesh is worth a look
  /// Its planar meshes have just the boundary edges that they were given; else they are made to cover the
  /// same area.
  bool keeps_boundary = true;
  std::filesystem::path folder;
};

/// A peer is missing, failed, or wrote no sound mesh of the case.
class PeerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the peer says of its version, in one line. Throws PeerError.
std::string peer_version(const Peer& peer);

/// Lets the peer mesh a case. Planar cases: with the same boundary edges, and the size as a number or, for
/// .geo, between the corners of an F mesh. Surfaces: with the model and a size that has to be uniform. Works
/// in the folder `scratch`, made anew, where peer.log has what it printed. `label` as in finish_meshing().
/// Throws PeerError. A mesh whose elements are not sound, see check_elements(), is a result that says so.
RunResult run_peer(const Peer& peer, const Case& c, const PreparedProblem& prepared, const std::string& label,
                   const std::filesystem::path& scratch);

/// delta where it is the same everywhere, as it was written.
std::optional<double> uniform_size(const Case& c);

/// Writes what the peer reads to `folder`; returns the file. Throws PeerError when the case cannot be told.
std::filesystem::path write_peer_input(const Peer& peer, const Case& c, const PreparedProblem& prepared,
                                       const std::filesystem::path& folder);

/// Makes `mesh` run counterclockwise on planar domains. Throws PeerError when it is not sound, does not cover
/// the domain or, where the peer keeps it, has other edges on the boundary.
void check_peer_mesh(const Peer& peer, const PreparedProblem& prepared, Mesh& mesh);

}  // namespace delquad
