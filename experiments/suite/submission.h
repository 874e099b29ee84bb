#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesher.h"

namespace delquad {

/// Who made the meshes of a folder: its result.toml.
struct Submission {
  std::filesystem::path folder;
  std::string program;  ///< in tables: small letters, digits, - and _
  std::string version, command;
  std::vector<std::string> authors;
};
/// Throws InputError with file and line for what is missing or unknown.
Submission read_submission(const std::filesystem::path& folder);

/// How many of the suite's cases a submission has a good mesh of.
struct SubmissionCount {
  int measured = 0, refused = 0, missing = 0;
};

/// Measures the meshes of a submission, NAME_1.msh or NAME_1.obj and so on, and writes them with records to
/// results/PROGRAM, as `delquad run` does for a peer; cells of an earlier submission of the program are
/// replaced. A mesh that is missing, cannot be read or is not one of its model is a failed cell that says
/// so. The suite's models are written to results/models. Throws InputError when the folder cannot be
/// written to, belongs to a run, or has no mesh of any case.
SubmissionCount add_submission(const Submission& submission, const std::filesystem::path& results);

/// Throws PeerError unless the mesh is conforming, has the model's area and lies on it: no place of the model
/// is further from the mesh, and none of the mesh further from the model, than 1.25 times the size there. Of
/// planar domains that is asked of the boundaries. Makes planar meshes run counterclockwise.
void check_is_of_model(const Prepared& prepared, Mesh& mesh);

}  // namespace delquad
