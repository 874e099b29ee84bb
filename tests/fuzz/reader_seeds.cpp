// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/reader_seeds.h"

#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "io/mesh_io.h"
#include "tests/io/msh_files.h"
#include "tests/support/curved_grid.h"
#include "tests/support/temporary_folder.h"

namespace delquad::fuzz {

namespace {

/// Two quads or four triangles in two regions, one of them with two names, and their outline as two curves.
Mesh strip(bool of_quads) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  mesh.lines = {{0, 1}, {1, 2}, {2, 5}, {5, 4}, {4, 3}, {3, 0}};
  mesh.line_curve = {0, 0, 0, 1, 1, 1};
  mesh.curves = {{1, {"wall"}}, {3, {}}};
  mesh.regions = {{1, {"left", "both"}}, {2, {"colour #ff8000"}}};
  if (of_quads) {
    mesh.quads = {{0, 1, 4, 3}, {1, 2, 5, 4}};
    mesh.quad_region = {0, 1};
  } else {
    mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    mesh.triangle_region = {0, 0, 1, 1};
  }
  return mesh;
}

/// Quads and triangles as the project writes them, and further files.
std::vector<std::string> written(const std::string& extension, const MshOptions& options = {}) {
  const testing_support::TemporaryFolder folder;
  std::vector<std::string> all;
  for (const bool of_quads : {true, false}) {
    Mesh mesh = strip(of_quads);
    if (of_quads) mesh.unit = "mm";
    write_mesh(folder / ("seed" + extension), mesh, options);
    all.push_back(testing_support::read_text(folder / ("seed" + extension)));
  }
  return all;
}

/// A curved grid of each order up to `most`.
std::vector<std::string> written_curved(const std::string& extension, int most,
                                        const MshOptions& options = {}) {
  const testing_support::TemporaryFolder folder;
  std::vector<std::string> all;
  for (int order = 2; order <= most; ++order) {
    write_mesh(folder / ("seed" + extension), testing_support::curved_grid(1, 1, order, order == 3), options);
    all.push_back(testing_support::read_text(folder / ("seed" + extension)));
  }
  return all;
}

std::vector<std::string> operator+(std::vector<std::string> all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// Numbers as bytes of either order.
class Bytes {
 public:
  explicit Bytes(std::endian order = std::endian::little) : order_(order) {}
  template <class T>
  Bytes& operator<<(T value) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    text.append(order_ == std::endian::native ? std::string(raw.begin(), raw.end())
                                              : std::string(raw.rbegin(), raw.rend()));
    return *this;
  }
  std::string text;

 private:
  std::endian order_;
};

std::string gzipped(const std::string& text) {
  constexpr int kGzip = 16;
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzip, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::string binary_msh22() {
  Bytes bytes;
  bytes << 1;
  bytes.text += "\n$EndMeshFormat\n$Nodes\n3\n";
  for (const auto& [tag, x, y] : {std::tuple{1, 0., 0.}, {2, 1., 0.}, {3, 0., 1.}})
    bytes << tag << x << y << 0.;
  bytes.text += "$EndNodes\n$Elements\n1\n";
  for (const int number : {2, 1, 2, 1, 5, 7, 1, 2, 3}) bytes << number;
  return "$MeshFormat\n2.2 1 8\n" + bytes.text + "$EndElements\n";
}

const std::string kOff =
    "OFF\n# by hand\n5 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 .5 0\n3 0 1 2\n4 0 1 2 3 255 0 0\n3 1 4 2\n";

std::string binary_off() {
  Bytes bytes(std::endian::big);
  bytes << 3 << 1 << 0;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) bytes << x;
  for (const int number : {3, 0, 1, 2, 0}) bytes << number;
  return "OFF BINARY\n" + bytes.text;
}

const std::string kStl =
    "solid one\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid one\nsolid two\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1e0 0\n"
    "endloop\nendfacet\nendsolid\n";

std::string binary_stl() {
  Bytes bytes;
  bytes.text.assign(80, ' ');
  bytes << std::uint32_t{2};
  for (const auto& facet : {std::array{0.f, 0.f, 1.f, 0.f, 0.f, 1.f}, {1.f, 0.f, 1.f, 1.f, 0.f, 1.f}}) {
    for (int k = 0; k < 3; ++k) bytes << 0.f;
    for (int k = 0; k < 6; k += 2) bytes << facet[k] << facet[k + 1] << 0.f;
    bytes << std::uint16_t{0};
  }
  return bytes.text;
}

const std::string kPly =
    "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement vertex 4\nproperty float x\nproperty "
    "float y\n"
    "property double z\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n"
    "3 0 2 3 0 255 0\n";

std::string binary_ply(std::endian order) {
  Bytes bytes(order);
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) bytes << x;
  bytes << std::uint8_t{3} << std::int16_t{0} << std::int16_t{1} << std::int16_t{2} << std::uint8_t{1} << 0.5;
  return std::string("ply\nformat binary_") + (order == std::endian::big ? "big" : "little") +
         "_endian 1.0\nelement vertex 3\nproperty float32 x\nproperty float32 y\nproperty float32 z\n"
         "element face 1\nproperty list uint8 int16 vertex_index\nproperty list uint8 float64 "
         "texcoord\nend_header\n" +
         bytes.text;
}

const std::string kThreeMf =
    R"(<model unit="inch"><resources><basematerials id="9"><base name="r" displaycolor="#FF0000"/></basematerials>)"
    R"(<object id="1" name="a"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>)"
    R"(<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices><triangles>)"
    R"(<triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3" pid="9" p1="0"/></triangles></mesh></object>)"
    R"(<object id="2"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 -1 5 0 0"/></components>)"
    R"(</object></resources><build><item objectid="1"/><item objectid="2"/></build></model>)";

const std::string kVtu =
    R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="2"><Points>)"
    R"(<DataArray type="Float32" NumberOfComponents="3">0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points><Cells>)"
    R"(<DataArray type="Int32" Name="connectivity">0 1 2 3 0 1</DataArray><DataArray type="Int32" Name="offsets">4 6)"
    R"(</DataArray><DataArray type="UInt8" Name="types">9 3</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";

std::string raw_vtu() {
  Bytes bytes;
  const auto array = [&](auto... numbers) {
    bytes << static_cast<std::uint32_t>(sizeof...(numbers) * 4);
    (bytes << ... << numbers);
  };
  array(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f);
  array(0, 1, 2);
  array(3);
  array(5);
  return R"(<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid><Piece><Points>)"
         R"(<DataArray type="Float32" format="appended" offset="0"/></Points><Cells>)"
         R"(<DataArray type="Int32" Name="connectivity" format="appended" offset="40"/>)"
         R"(<DataArray type="Int32" Name="offsets" format="appended" offset="56"/>)"
         R"(<DataArray type="Int32" Name="types" format="appended" offset="64"/></Cells></Piece></UnstructuredGrid>)"
         R"(<AppendedData encoding="raw">_)" +
         bytes.text + "</AppendedData></VTKFile>";
}

std::string base64(const std::string& bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const auto byte = [&](std::size_t k) {
      return at + k < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k]))
                                   : 0u;
    };
    const std::uint32_t held = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k)
      text += at + k <= bytes.size() ? kDigits[held >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// An array of bytes, packed in one block, with its header apart.
template <class... Numbers>
std::string packed_array(Numbers... numbers) {
  Bytes bytes;
  (bytes << ... << numbers);
  std::string packed(compressBound(bytes.text.size()), '\0');
  uLongf length = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &length,
           reinterpret_cast<const Bytef*>(bytes.text.data()), bytes.text.size());
  packed.resize(length);
  Bytes header;
  for (const std::size_t number : {std::size_t{1}, bytes.text.size(), std::size_t{0}, packed.size()})
    header << static_cast<std::uint32_t>(number);
  return base64(header.text) + base64(packed);
}

std::string packed_vtu() {
  return R"(<VTKFile type="UnstructuredGrid" compressor="vtkZLibDataCompressor"><UnstructuredGrid><Piece><Points>)"
         R"(<DataArray type="Float64" format="binary">)" +
         packed_array(0., 0., 0., 1., 0., 0., 0., 1., 0.) +
         R"(</DataArray></Points><Cells><DataArray type="Int64" Name="connectivity" format="binary">)" +
         packed_array(std::int64_t{0}, std::int64_t{1}, std::int64_t{2}) +
         R"(</DataArray><DataArray type="UInt16" Name="offsets" format="binary">)" +
         packed_array(std::uint16_t{3}) +
         R"(</DataArray><DataArray type="Int8" Name="types" format="binary">)" +
         packed_array(std::int8_t{5}) + R"(</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";
}

const std::string kInp =
    "*HEADING\n by hand\n*NODE, NSET=all\n1, 0, 0, 0\n2, 1., 0.\n3, 1, 1, 0\n4, 0, 1e0, 0\n"
    "*ELEMENT, TYPE=S4R, ELSET=plate\n7, 1, 2, 3,\n4\n*ELEMENT, TYPE=T3D2\n8, 1, 2\n*ELSET, ELSET=set, "
    "GENERATE\n"
    "7, 7, 1\n*SURFACE, NAME=side\n7, S1\nset, S2\n*ELSET, ELSET=other\nplate,\n** end\n";

const std::string kMedit =
    "MeshVersionFormatted 2\nDimension 3\n# by hand\nVertices\n4\n0 0 0 0\n1 0 0 0\n1 1 0 1\n0 1 0 "
    "0\nEdges\n1\n1 2 7\n"
    "Corners\n1\n1\nTriangles\n1\n1 2 3 5\nQuadrilaterals\n1\n1 2 3 4 6\nEnd\n";

const std::string
    kMfem =
        "MFEM mesh v1.0\n# by hand\ndimension\n2\nelements\n2\n1 3 0 1 4 3\n2 3 4 1 2 5\nboundary\n1\n3 1 2 "
        "1\nvertices\n6\n",
    kMfemPlaces = "2\n0 0\n1 0\n2 0\n0 1\n1 1\n2 1\n",
    kMfemNodes =
        "nodes\nFiniteElementSpace\nFiniteElementCollection: H1_2D_P2\nVDim: 2\nOrdering: 1\n0 0 1 0 2 "
        "0 0 1 1 1 2 1 .5 0 1 .5 .5 1 0 .5 1.5 0 2 .5 1.5 1 .5 .5 1.5 .5\n";

const std::string kNastran =
    "SOL 101\nCEND\nBEGIN BULK\nGRID    1               0.      0.      0.\nGRID,2,,1.5-1,0.,0.\n"
    "GRID*   3                               .15             1.D-1\n*       0.\nGRID,4,,0.,.1,,,,,+A\n+A\n"
    "CQUAD4  10      7       1       2       3       "
    "4\nPLOTEL,11,1,2\nCBAR,12,9,2,3,0.,0.,1.\nCTRIA3,13,,1,2,3\n"
    "PSHELL,7,1,.1\nENDDATA\n";

}  // namespace

std::vector<std::string> msh_seeds() {
  return written(".msh") + written(".msh", {.binary = true}) + written_curved(".msh", kMostOrder) +
         written_curved(".msh", 2, {.binary = true}) +
         std::vector{msh_files::kSquare22, msh_files::kSquare41, binary_msh22()};
}
std::vector<std::string> obj_seeds() {
  return written(".obj") +
         std::vector<std::string>{
             "# by hand\no a\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nv -1 .5 0\nvt 0 0\nvn 0 0 1\ng "
             "one\nf 1/1/1 2//1 3/1 4 5\ng two three\nf -5 -4 -3\nl 1 2 3\nl -1 -2\n"};
}
std::vector<std::string> off_seeds() {
  return {kOff, gzipped(kOff), binary_off(),
          "CNOFF 3 1 0\n0 0 0 0 0 1 .5 .5 .5 1\n1 0 0 0 0 1 0 0 0 1\n0 1 0 0 0 1 1 1 1 1\n3 0 1 2\n"};
}
std::vector<std::string> stl_seeds() { return {kStl, binary_stl()}; }
std::vector<std::string> ply_seeds() {
  return {kPly, binary_ply(std::endian::little), binary_ply(std::endian::big)};
}
std::vector<std::string> three_mf_seeds() { return {kThreeMf, archive_of(kThreeMf)}; }
std::vector<std::string> vtu_seeds() {
  return written(".vtu") + written_curved(".vtu", kMostOrder) + std::vector{kVtu, raw_vtu(), packed_vtu()};
}
std::vector<std::string> inp_seeds() { return written(".inp") + std::vector{kInp}; }
std::vector<std::string> medit_seeds() { return written(".mesh") + std::vector{kMedit}; }
std::vector<std::string> mfem_seeds() {
  return written(".mfem") + written_curved(".mfem", kMostOrder) +
         std::vector{kMfem + kMfemPlaces, kMfem + kMfemNodes};
}
std::vector<std::string> nastran_seeds() {
  return written(".bdf") + written_curved(".bdf", 2) + std::vector{kNastran};
}

std::string archive_of(std::string_view model) {
  const std::string name = "3D/3dmodel.model";
  const auto sum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(model.data()), static_cast<uInt>(model.size())));
  const auto size = static_cast<std::uint32_t>(model.size()),
             name_size = static_cast<std::uint32_t>(name.size());
  /// The part that a file's own header and its entry in the list of files have in common.
  const auto put_file = [&](Bytes& bytes) {
    bytes << std::uint16_t{20} << std::uint16_t{0} << std::uint16_t{0} << std::uint16_t{0}
          << std::uint16_t{33} << sum << size << size << static_cast<std::uint16_t>(name_size)
          << std::uint16_t{0};
  };
  Bytes bytes;
  bytes << std::uint32_t{0x04034b50};
  put_file(bytes);
  bytes.text += name;
  bytes.text += model;
  const auto first = static_cast<std::uint32_t>(bytes.text.size());
  bytes << std::uint32_t{0x02014b50} << std::uint16_t{20};
  put_file(bytes);
  bytes << std::uint16_t{0} << std::uint16_t{0} << std::uint16_t{0} << std::uint32_t{0} << std::uint32_t{0};
  bytes.text += name;
  const auto list_size = static_cast<std::uint32_t>(bytes.text.size()) - first;
  bytes << std::uint32_t{0x06054b50} << std::uint16_t{0} << std::uint16_t{0} << std::uint16_t{1}
        << std::uint16_t{1} << list_size << first << std::uint16_t{0};
  return bytes.text;
}

}  // namespace delquad::fuzz
