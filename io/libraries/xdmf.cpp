// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <utility>

#include "io/cell_view.h"
#include "io/library_file.h"
#include "io/library_format.h"
#include "io/mesh_io.h"
#include "io/text_writer.h"
#include "io/xml.h"

#include <hdf5.h>

namespace delquad {

namespace {

/// The file with the numbers, in the group "/mesh".
class Hdf5File {
 public:
  Hdf5File(const std::filesystem::path& path, const std::filesystem::path& temporary) : path_(path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are told by what is returned
    file_.id = H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    check(file_ >= 0);
  }

  void put(const char* name, hsize_t rows, hsize_t columns, const void* values, bool are_reals) {
    const hsize_t sizes[2] = {rows, columns};
    const hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, sizes, nullptr);
    const hid_t memory = are_reals ? H5T_NATIVE_DOUBLE : H5T_NATIVE_LLONG;
    const hid_t in_file = are_reals ? H5T_IEEE_F64LE : H5T_STD_I64LE;
    // Times would make the same mesh other bytes.
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(how, false);
    const hid_t set = H5Dcreate2(file_, name, in_file, space, H5P_DEFAULT, how, H5P_DEFAULT);
    const bool written = set >= 0 && H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    const bool closed = H5Dclose(set) >= 0;
    H5Pclose(how), H5Sclose(space);
    check(written && closed);
  }
  void close() {
    check(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0);  // what closing cannot write it does not tell
    check(file_.close_now() >= 0);
  }

 private:
  void check(bool done) const { require_written(done, path_, "the HDF5 library", "it"); }
  const std::filesystem::path& path_;
  OpenFile<hid_t, H5Fclose> file_;
};

/// Elements of one kind: their nodes, and the numbers of their names.
struct XdmfGrid {
  std::string name, topology, attribute;
  std::size_t nodes_each;
  std::vector<long long> nodes = {}, numbers = {};
  std::size_t count() const { return numbers.size(); }
};

/// Quads, triangles, and lines that have a name.
std::vector<XdmfGrid> xdmf_grids(const Mesh& mesh, const std::vector<MeshGroup>& groups) {
  using enum CellShape;
  constexpr CellCode<std::array<const char*, 3>> kKinds[] = {
      {kLine, 2, {"lines", "PolyLine", "curve"}},
      {kLine, 3, {"lines", "Edge_3", "curve"}},
      {kTriangle, 3, {"triangles", "Triangle", "region"}},
      {kQuad, 4, {"mesh", "Quadrilateral", "region"}},
      {kQuad, 9, {"mesh", "Quadrilateral_9", "region"}}};
  std::vector<XdmfGrid> grids;
  for (const CellBlock& cells : cell_blocks(mesh)) {
    const auto& [name, topology, attribute] = code_of(cells, kKinds);
    XdmfGrid grid{name, topology, attribute, cells.n_nodes};
    const std::vector<int> numbers = group_numbers(mesh, groups, cells.dim);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (numbers[cells.first + i] == 0) continue;
      grid.numbers.push_back(numbers[cells.first + i]);
      for (const int v : cells.nodes(i)) grid.nodes.push_back(v);
    }
    if (grid.count() > 0) grids.insert(grids.begin(), std::move(grid));
  }
  return grids;
}

void write_xdmf_text(TextWriter& out, const Mesh& mesh, const std::vector<MeshGroup>& groups,
                     const std::vector<XdmfGrid>& grids, const std::string& numbers, bool planar) {
  out << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n";
  if (!mesh.unit.empty()) out << "    <Information Name=\"unit\" Value=\"" << mesh.unit << "\"/>\n";
  for (const MeshGroup& group : groups)
    if (group.dim > 0)
      out << "    <Information Name=\"" << (group.dim == 1 ? "curve " : "region ") << group.number
          << "\" Value=\"" << xml_escaped(group.name) << "\"/>\n";
  for (const XdmfGrid& grid : grids) {
    out << "    <Grid Name=\"" << grid.name << "\" GridType=\"Uniform\">\n      <Topology TopologyType=\""
        << grid.topology << "\" NumberOfElements=\"" << grid.count() << "\" NodesPerElement=\""
        << grid.nodes_each << "\">\n        <DataItem Dimensions=\"" << grid.count() << ' ' << grid.nodes_each
        << "\" NumberType=\"Int\" Precision=\"8\" Format=\"HDF\">" << numbers << ":/" << grid.name
        << "_nodes</DataItem>\n      </Topology>\n      <Geometry GeometryType=\"" << (planar ? "XY" : "XYZ")
        << "\">\n        <DataItem Dimensions=\"" << mesh.points.size() << ' ' << (planar ? 2 : 3)
        << "\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">" << numbers
        << ":/points</DataItem>\n      </Geometry>\n      <Attribute Name=\"" << grid.attribute
        << "\" AttributeType=\"Scalar\" Center=\"Cell\">\n        <DataItem Dimensions=\"" << grid.count()
        << "\" NumberType=\"Int\" Precision=\"8\" Format=\"HDF\">" << numbers << ":/" << grid.name << '_'
        << grid.attribute << "</DataItem>\n      </Attribute>\n    </Grid>\n";
  }
  out << "  </Domain>\n</Xdmf>\n";
}

/// XDMF 3, the numbers in an HDF5 file of the same name beside it. Grids "mesh" (quads), "triangles" and
/// "lines" have the numbers of names, which are Information elements.
void write_xdmf(const std::filesystem::path& path, const Mesh& mesh) {
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const std::vector<XdmfGrid> grids = xdmf_grids(mesh, groups);
  const bool planar = is_planar(mesh);
  const std::filesystem::path numbers = std::filesystem::path(path).replace_extension(".h5");
  const auto write_numbers = [&](const std::filesystem::path& temporary) {
    Hdf5File file(numbers, temporary);
    std::vector<double> places;
    for (const Vec3& p : mesh.points) {
      places.insert(places.end(), {p.x, p.y});
      if (!planar) places.push_back(p.z);
    }
    file.put("points", mesh.points.size(), planar ? 2 : 3, places.data(), true);
    for (const XdmfGrid& grid : grids) {
      file.put((grid.name + "_nodes").c_str(), grid.count(), grid.nodes_each, grid.nodes.data(), false);
      file.put((grid.name + "_" + grid.attribute).c_str(), grid.count(), 1, grid.numbers.data(), false);
    }
    file.close();
  };
  const auto write_text = as_text([&](TextWriter& out) {
    write_xdmf_text(out, mesh, groups, grids, numbers.filename().string(), planar);
  });
  write_files_atomically({{numbers, by_library(numbers, write_numbers)}, {path, write_text}});
}

}  // namespace

}  // namespace delquad

extern "C" const delquad::LibraryFormat delquad_format = {nullptr, delquad::write_xdmf};
