#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "base/text.h"
#include "delquad/error.h"
#include "io/mesh_io.h"
#include "io/text_scanner.h"

namespace delquad {

namespace {

constexpr size_t kBlock = 1 << 16;
constexpr std::string_view kGzip = "\x1f\x8b";

std::string small_letters(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return text;
}

/// Ends the stream whatever happens.
struct Inflation {
  z_stream stream{};
  Inflation() {
    constexpr int kGzipOnly = 16;
    if (inflateInit2(&stream, MAX_WBITS + kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;
  ~Inflation() { inflateEnd(&stream); }
};

/// All members of a gzip file, one after the other.
std::string unpacked(std::string packed, const std::string& name) {
  Inflation inflation;
  z_stream& stream = inflation.stream;
  std::string text;
  size_t fed = 0;
  while (true) {
    if (stream.avail_in == 0 && fed < packed.size()) {
      const size_t n = std::min(packed.size() - fed, size_t{1} << 30);  // zlib counts in 32 bits
      stream.next_in = reinterpret_cast<Bytef*>(packed.data() + fed);
      stream.avail_in = static_cast<uInt>(n);
      fed += n;
    }
    const size_t before = text.size();
    text.resize(before + kBlock);
    stream.next_out = reinterpret_cast<Bytef*>(text.data() + before);
    stream.avail_out = kBlock;
    const int status = inflate(&stream, Z_NO_FLUSH);
    text.resize(before + kBlock - stream.avail_out);
    const bool all_fed = stream.avail_in == 0 && fed == packed.size();
    if (status == Z_STREAM_END) {
      if (all_fed) return text;
      inflateReset(&stream);
    } else if (status == Z_MEM_ERROR) {
      throw std::bad_alloc();
    } else if (status != Z_OK || (all_fed && stream.avail_out > 0)) {
      throw InputError(name + ": is packed by gzip and damaged: expected a whole file");
    }
  }
}

bool begins(std::string_view text, std::string_view with) {
  const size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  return text.substr(first).starts_with(with);
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& path) {
  std::string bytes = file_bytes(path);
  return bytes.starts_with(kGzip) ? unpacked(std::move(bytes), path.string()) : bytes;
}

std::string kind_of_file(const std::filesystem::path& path) {
  const std::string kind = small_letters(path.extension().string());
  return kind == ".gz" ? small_letters(path.stem().extension().string()) : kind;
}

std::string content_kind(std::string_view text) {
  constexpr size_t kBeginning = 400;  // bytes: a BREP file may have some lines before its title
  const std::string_view beginning = text.substr(0, kBeginning);
  if (begins(text, "ISO-10303-21")) return "a STEP file";
  if (beginning.find("CASCADE Topology V") != std::string_view::npos) return "a BREP file";
  if (begins(text, "$MeshFormat") || begins(text, "$NOD")) return "an MSH file";
  if (begins(text, "MeshVersionFormatted")) return "a Medit file";
  if (begins(text, "MFEM ")) return kMfemFile;
  if (beginning.find("<VTKFile") != std::string_view::npos) return "a VTU file";
  if (begins(text, "# vtk DataFile")) return "a legacy VTK file";
  if (begins(text, "ply\n") || begins(text, "ply\r")) return "a PLY file";
  if (begins(text, "*HEADING") || begins(text, "*Heading") || begins(text, "*NODE") || begins(text, "*Node"))
    return "an INP file";
  for (const char* title : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF"})
    if (begins(text, title)) return "an OFF file";
  if (text.starts_with("PK\x03\x04")) return "a ZIP archive";
  if (text.starts_with("%PDF")) return "a PDF file";
  return "";
}

void refuse_other_kinds(const TextScanner& in, std::string_view expected) {
  const std::string kind = content_kind(in.text());
  if (kind.empty() || kind.find(' ' + std::string(expected) + ' ') != std::string::npos) return;
  in.fail(
      fmt::format("holds {}: expected {}; files are told apart by the end of their name", kind, expected));
}

}  // namespace delquad
