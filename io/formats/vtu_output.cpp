#include "io/formats/vtu_output.h"

#include <bit>
#include <string_view>

#include "io/mesh_io.h"
#include "io/text_writer.h"
#include "io/xml.h"

namespace delquad {

namespace {

/// Base64 of a block of bytes after its length, as VTK wants it inline (header_type UInt64).
class Base64Array {
 public:
  explicit Base64Array(TextWriter& out) : out_(out) {}

  template <class T>
  void write(const std::vector<T>& values) {
    const std::uint64_t n_bytes = values.size() * sizeof(T);
    put(&n_bytes, sizeof n_bytes);
    put(values.data(), n_bytes);
    if (n_held_ > 0) {
      const int padding = 3 - n_held_;
      held_ <<= 8 * padding;
      emit(4 - padding);
      out_ << (padding == 1 ? "=" : "==");
    }
  }

 private:
  void put(const void* data, size_t n_bytes) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (size_t i = 0; i < n_bytes; ++i) {
      held_ = held_ << 8 | bytes[i];
      if (++n_held_ == 3) emit(4);
    }
  }
  void emit(int n_digits) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char text[4];
    for (int k = 0; k < n_digits; ++k) text[k] = kDigits[held_ >> (18 - 6 * k) & 63];
    out_ << std::string_view(text, static_cast<size_t>(n_digits));
    held_ = 0;
    n_held_ = 0;
  }

  TextWriter& out_;
  std::uint32_t held_ = 0;
  int n_held_ = 0;
};

template <class T>
void write_array(TextWriter& out, std::string_view attributes, const std::vector<T>& values) {
  out << "        <DataArray " << attributes << " format=\"binary\">";
  Base64Array(out).write(values);
  out << "</DataArray>\n";
}

/// Arrays of numbers, which every reader takes: meshio refuses arrays of strings.
void write_name_arrays(TextWriter& out, const std::string& kind, const NumbersOfNames& numbers) {
  for (const auto& [name, all] : numbers)
    write_array(out,
                "type=\"Int32\" Name=\"" + kind + ' ' + xml_escaped(name) + "\" NumberOfTuples=\"" +
                    std::to_string(all.size()) + '"',
                all);
}

void write_content(TextWriter& out, const VtuContent& content) {
  constexpr bool kLittle = std::endian::native == std::endian::little;
  const VtuCells& cells = content.cells;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
      << (kLittle ? "LittleEndian" : "BigEndian") << "\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n";
  if (!content.unit.empty()) out << "    <!-- lengths in " << content.unit << " -->\n";
  out << "      <FieldData>\n";
  for (const auto& [kind, numbers] : content.names) write_name_arrays(out, kind, numbers);
  out << "      </FieldData>\n";
  out << "    <Piece NumberOfPoints=\"" << content.points.size() << "\" NumberOfCells=\""
      << cells.types.size() << "\">\n";
  std::vector<double> coordinates;
  coordinates.reserve(3 * content.points.size());
  for (const Vec3& p : content.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  out << "      <Points>\n";
  write_array(out, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", coordinates);
  out << "      </Points>\n      <Cells>\n";
  write_array(out, "type=\"Int64\" Name=\"connectivity\"", cells.connectivity);
  write_array(out, "type=\"Int64\" Name=\"offsets\"", cells.offsets);
  write_array(out, "type=\"UInt8\" Name=\"types\"", cells.types);
  out << "      </Cells>\n      <CellData>\n";
  for (const auto& [name, tags] : content.tags) write_array(out, "type=\"Int32\" Name=\"" + name + '"', tags);
  for (const auto& [name, values] : content.values)
    write_array(out, "type=\"Float64\" Name=\"" + xml_escaped(name) + "\"", values);
  out << "      </CellData>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace

NumbersOfNames tags_of_names(const std::vector<Entity>& entities) {
  NumbersOfNames tags;
  for (const Entity& entity : entities)
    for (const std::string& name : entity.names) tags[name].push_back(entity.tag);
  return tags;
}

void write_vtu_content(const std::filesystem::path& path, const VtuContent& content) {
  write_file_atomically(path, [&](std::ostream& stream) {
    TextWriter out(stream);
    write_content(out, content);
    out.flush();
  });
}

}  // namespace delquad
