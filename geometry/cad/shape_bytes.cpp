#include "geometry/cad/shape_file.h"

#include <BinTools.hxx>
#include <sstream>
#include <utility>

#include "geometry/cad/cad_shape.h"

namespace delquad::cad {

namespace {

template <class T>
void put(std::ostream& out, const T& number) {
  out.write(reinterpret_cast<const char*>(&number), sizeof number);
}
template <class T>
T get(std::istream& in) {
  T number{};
  in.read(reinterpret_cast<char*>(&number), sizeof number);
  return number;
}

void put(std::ostream& out, const std::vector<std::string>& texts) {
  put(out, texts.size());
  for (const std::string& text : texts) {
    put(out, text.size());
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
  }
}
void put(std::ostream& out, const std::vector<LooseLine>& lines) {
  put(out, lines.size());
  for (const LooseLine& line : lines) {
    put(out, line.names);
    put(out, std::vector<std::string>{line.where});
    put(out, line.points.size());
    for (const Vec3& x : line.points) put(out, x);
  }
}
std::vector<std::string> get_texts(std::istream& in) {
  std::vector<std::string> texts(get<std::size_t>(in));
  for (std::string& text : texts) {
    text.resize(get<std::size_t>(in));
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
  }
  return texts;
}

std::vector<LooseLine> get_lines(std::istream& in) {
  std::vector<LooseLine> lines(get<std::size_t>(in));
  for (LooseLine& line : lines) {
    line.names = get_texts(in);
    line.where = get_texts(in).at(0);
    line.points.resize(get<std::size_t>(in));
    for (Vec3& x : line.points) x = get<Vec3>(in);
  }
  return lines;
}

}  // namespace

std::string to_bytes(const CadShape& cad) {
  std::ostringstream out;
  put(out, cad.diagonal);
  put(out, texts(cad.warnings));
  put(out, std::vector<std::string>{cad.unit});
  put(out, cad.missing);
  put(out, cad.why_not);
  put(out, cad.loose);
  // The shape last: its reader looks ahead. The names are in the order of its faces and edges, so they come
  // by number.
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE}) {
    const TopTools_IndexedMapOfShape all = parts(cad.shape, kind);
    for (int p = 1; p <= all.Extent(); ++p) put(out, cad.names.of(all(p)));
  }
  std::ostringstream shape;
  BinTools::Write(cad.shape, shape);
  std::ostringstream all;
  put(all, out.str().size());
  all << out.str() << shape.str();
  return all.str();
}

CadShape from_bytes(const std::string& bytes) {
  std::istringstream in(bytes);
  const auto n_before = get<std::size_t>(in);
  CadShape cad;
  std::istringstream shape(bytes.substr(sizeof n_before + n_before));
  BinTools::Read(cad.shape, shape);
  cad.diagonal = get<double>(in);
  for (std::string& text : get_texts(in)) cad.warnings.emplace_back(std::move(text));
  cad.unit = get_texts(in).at(0);
  cad.missing = get_texts(in);
  cad.why_not = get_texts(in);
  cad.loose = get_lines(in);
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE}) {
    const TopTools_IndexedMapOfShape all = parts(cad.shape, kind);
    for (int p = 1; p <= all.Extent(); ++p)
      for (const std::string& name : get_texts(in)) cad.names.add(all(p), name);
  }
  return cad;
}

}  // namespace delquad::cad
