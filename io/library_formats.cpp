// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include "base/system.h"
#include "io/entity_names.h"
#include "io/library_format.h"
#include "io/mesh_formats.h"

namespace delquad {

namespace {

constexpr char kExodus[] = "exodus", kCgns[] = "cgns", kMed[] = "med", kUgrid[] = "ugrid", kXdmf[] = "xdmf";

template <const char* name>
const LibraryFormat& loaded() {
  static const auto* format = static_cast<const LibraryFormat*>(
      symbol_of_library(std::string("libdelquad-") + name + ".so", "delquad_format"));
  return *format;
}

template <const char* name>
Mesh read_loaded(const std::filesystem::path& path, ReadNotes* notes, Strays strays) {
  return loaded<name>().read(path, notes, strays);
}
template <const char* name>
void write_loaded(const std::filesystem::path& path, const Mesh& mesh) {
  loaded<name>().write(path, mesh);
}

/// `is_built`: whether this program has the library.
template <const char* name>
MeshFormat loaded_format(bool is_built, MeshFormat format) {
  if (!is_built) return format.has_cells = false, format;
  format.write = write_by<write_loaded<name>>;
  format.package = "";
  return format;
}

constexpr UniqueLabels::Rules kUgridLabels{word_label};

}  // namespace

MeshFormat exodus_format() {
  return loaded_format<kExodus>(DELQUAD_HAS_EXODUS,
                                {.extensions = {".e", ".exo", ".ex2"},
                                 .description = "Exodus II: MOOSE, Cubit",
                                 .read = DELQUAD_HAS_EXODUS ? read_loaded<kExodus> : nullptr,
                                 .most_order = 2,
                                 .package = "libexodusii-dev",
                                 .has_cells = true,
                                 .labels = &kExodusLabels});
}

MeshFormat cgns_format() {
  return loaded_format<kCgns>(DELQUAD_HAS_CGNS, {.extensions = {".cgns"},
                                                 .description = "CGNS",
                                                 .most_order = 2,
                                                 .package = "libcgns-dev",
                                                 .has_cells = true,
                                                 .labels = &kCgnsLabels});
}

MeshFormat med_format() {
  return loaded_format<kMed>(DELQUAD_HAS_MED, {.extensions = {".med"},
                                               .description = "MED: Code_Aster, Salome",
                                               .most_order = 2,
                                               .package = "libmedc-dev",
                                               .has_cells = true,
                                               .labels = &kMedLabels});
}

MeshFormat xdmf_format() {
  return loaded_format<kXdmf>(DELQUAD_HAS_XDMF,
                              {.extensions = {".xdmf"},
                               .description = "XDMF with numbers in HDF5: dolfinx, ParaView",
                               .most_order = 2,
                               .package = "libhdf5-dev",
                               .names = kAllNames & ~kPointNames});
}

MeshFormat ugrid_format() {
  return loaded_format<kUgrid>(DELQUAD_HAS_UGRID, {.extensions = {".nc"},
                                                   .description = "UGRID in netCDF: Delft3D FM, QGIS",
                                                   .read = DELQUAD_HAS_UGRID ? read_loaded<kUgrid> : nullptr,
                                                   .package = "libnetcdf-dev",
                                                   .has_depths = true,
                                                   .labels = &kUgridLabels});
}

}  // namespace delquad
