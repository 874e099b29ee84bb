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

constexpr UniqueLabels::Rules kUgridLabels{word_label};

}  // namespace

MeshFormat exodus_format() {
  MeshFormat format{.extensions = {".e", ".exo", ".ex2"},
                    .description = "Exodus II: MOOSE, Cubit",
                    .most_order = 2,
                    .package = "libexodusii-dev",
                    .labels = &kExodusLabels};
#ifdef DELQUAD_HAS_EXODUS
  format.write = write_by<write_loaded<kExodus>>, format.has_hexahedra = true;
  format.package = "";
#endif
  return format;
}

MeshFormat cgns_format() {
  MeshFormat format{.extensions = {".cgns"},
                    .description = "CGNS",
                    .most_order = 2,
                    .package = "libcgns-dev",
                    .labels = &kCgnsLabels};
#ifdef DELQUAD_HAS_CGNS
  format.write = write_by<write_loaded<kCgns>>, format.has_hexahedra = true;
  format.package = "";
#endif
  return format;
}

MeshFormat med_format() {
  MeshFormat format{.extensions = {".med"},
                    .description = "MED: Code_Aster, Salome",
                    .most_order = 2,
                    .package = "libmedc-dev",
                    .labels = &kMedLabels};
#ifdef DELQUAD_HAS_MED
  format.write = write_by<write_loaded<kMed>>, format.has_hexahedra = true;
  format.package = "";
#endif
  return format;
}

MeshFormat xdmf_format() {
  MeshFormat format{.extensions = {".xdmf"},
                    .description = "XDMF with numbers in HDF5: dolfinx, ParaView",
                    .most_order = 2,
                    .package = "libhdf5-dev",
                    .names = kAllNames & ~kPointNames};
#ifdef DELQUAD_HAS_XDMF
  format.write = write_by<write_loaded<kXdmf>>, format.package = "";
#endif
  return format;
}

MeshFormat ugrid_format() {
  MeshFormat format{.extensions = {".nc"},
                    .description = "UGRID in netCDF: Delft3D FM, QGIS",
                    .package = "libnetcdf-dev",
                    .has_depths = true,
                    .labels = &kUgridLabels};
#ifdef DELQUAD_HAS_UGRID
  format.read = read_loaded<kUgrid>, format.write = write_by<write_loaded<kUgrid>>, format.package = "";
#endif
  return format;
}

}  // namespace delquad
