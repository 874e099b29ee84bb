// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/shape_file.h"

#include <BinTools.hxx>
#include <sstream>
#include <utility>

#include "geometry/cad/byte_archive.h"

namespace delquad::cad {

namespace {

/// Calls visit(member) for all members except the shape.
template <class Shape, class Visit>
void visit_values(Shape& cad, const Visit& visit) {
  visit(cad.diagonal), visit(cad.unit), visit(cad.missing), visit(cad.why_not);
  for (auto& line : cad.loose) visit(line.names), visit(line.where), visit(line.points);
}

/// Returns faces, then edges, in the order of their names in the bytes.
std::vector<TopoDS_Shape> named_parts(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> all;
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE}) {
    const TopTools_IndexedMapOfShape some = parts(shape, kind);
    for (int p = 1; p <= some.Extent(); ++p) all.push_back(some(p));
  }
  return all;
}

}  // namespace

std::string to_bytes(const CadShape& cad) {
  std::ostringstream shape;
  BinTools::Write(cad.shape, shape);
  std::string bytes;
  put(bytes, cad.loose.size());
  visit_values(cad, [&](const auto& value) { put(bytes, value); });
  put(bytes, texts(cad.warnings));
  put(bytes, shape.str());
  for (const TopoDS_Shape& part : named_parts(cad.shape)) put(bytes, cad.names.of(part));
  return bytes;
}

CadShape from_bytes(const std::string& bytes) {
  std::string_view rest = bytes;
  CadShape cad;
  std::size_t n_loose = 0;
  get(rest, n_loose);
  cad.loose.resize(n_loose);
  visit_values(cad, [&](auto& value) { get(rest, value); });
  std::vector<std::string> warnings, names;
  get(rest, warnings);
  for (std::string& text : warnings) cad.warnings.emplace_back(std::move(text));
  std::string shape;
  get(rest, shape);
  std::istringstream in(std::move(shape));
  BinTools::Read(cad.shape, in);
  for (const TopoDS_Shape& part : named_parts(cad.shape)) {
    names.clear();
    get(rest, names);
    cad.names.add(part, names);
  }
  return cad;
}

}  // namespace delquad::cad
