// SPDX-License-Identifier: GPL-3.0-or-later
#include <zlib.h>

#include <algorithm>
#include <filesystem>

#include "geometry/mesh/check_mesh.h"
#include "io/formats/msh.h"
#include "io/formats/readers.h"
#include "io/formats/vtu.h"
#include "io/mesh_formats.h"
#include "metrics/metrics.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/reader_seeds.h"
#include "tests/fuzz/target.h"

namespace delquad::fuzz {

namespace {

/// A mesh that was read has indices in range and finite points, and what looks at every mesh can look at it.
void check_mesh(const Mesh& mesh) {
  try {
    require_readable(mesh, "read");
  } catch (const InputError& error) {
    require(false, error.what());
  }
  require(!mesh.lines.empty() || !mesh.triangles.empty() || !mesh.quads.empty(), "a mesh without elements");
  check_invariants(mesh);
  evaluate_metrics(mesh, nullptr);
}

template <auto read>
bool try_reader(std::string_view bytes) {
  static InputFile file("input");
  const std::filesystem::path& path = file.hold(bytes);
  return result_or_input_error(path.string(), [&] { check_mesh(read(path)); });
}

Mesh msh(const std::filesystem::path& path) {
  DeclaredSurfaces surfaces;
  return read_msh(path, &surfaces);
}

/// By the reader of files of this kind, whatever the file is called.
Mesh read_as(const char* kind, const std::filesystem::path& path, ReadNotes* notes = nullptr) {
  const auto is_it = [&](const MeshFormat& format) { return format.extensions[0] == kind; };
  return std::ranges::find_if(mesh_formats(), is_it)->read(path, notes, Strays::kRefused);
}

/// Mostly bytes of the model alone: no mutation finds the checksums of an archive.
bool try_3mf(std::string_view bytes) {
  static InputFile file("input");
  const std::string archive = bytes.starts_with("PK") ? std::string(bytes) : archive_of(bytes);
  const std::filesystem::path& path = file.hold(archive);
  return result_or_input_error(path.string(), [&] {
    ReadNotes notes;
    check_mesh(read_as(".3mf", path, &notes));
  });
}

Mesh vtu(const std::filesystem::path& path) { return read_as(".vtu", path); }
Mesh inp(const std::filesystem::path& path) { return read_as(".inp", path); }
Mesh nastran(const std::filesystem::path& path) { return read_as(".bdf", path); }
Mesh obj(const std::filesystem::path& path) { return read_as(".obj", path); }
Mesh off(const std::filesystem::path& path) { return read_as(".off", path); }
Mesh ply(const std::filesystem::path& path) { return read_as(".ply", path); }
Mesh stl(const std::filesystem::path& path) { return read_as(".stl", path); }

}  // namespace

std::vector<Target> reader_targets() {
  return {{"msh", try_reader<msh>, msh_seeds},
          {"obj", try_reader<obj>, obj_seeds},
          {"off", try_reader<off>, off_seeds},
          {"stl", try_reader<stl>, stl_seeds},
          {"ply", try_reader<ply>, ply_seeds},
          {"3mf", try_3mf, three_mf_seeds},
          {"vtu", try_reader<vtu>, vtu_seeds},
          {"inp", try_reader<inp>, inp_seeds},
          {"medit", try_reader<read_medit>, medit_seeds},
          {"mfem", try_reader<read_mfem>, mfem_seeds},
          {"nastran", try_reader<nastran>, nastran_seeds}};
}

}  // namespace delquad::fuzz
