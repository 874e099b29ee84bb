#include "geometry/cad/iges_names.h"

#include <fmt/format.h>

#include <IGESData_ColorEntity.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESGraph_Color.hxx>
#include <Interface_InterfaceModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "geometry/cad/text_encoding.h"

namespace delquad::cad {

namespace {

/// A name that is long (a property), or short (the label).
std::string name_of(const IGESData_IGESEntity& entity) {
  if (!entity.HasName()) return "";
  const Handle(TCollection_HAsciiString) name = entity.NameValue();
  const std::string text = name.IsNull() ? "" : name->ToCString();
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// One of the eight that have numbers, or any other in percent of red, green and blue; empty: none is said.
std::string colour_of(const IGESData_IGESEntity& entity) {
  static constexpr std::array<const char*, 9> kNumbered = {"",       "000000", "ff0000", "00ff00", "0000ff",
                                                           "ffff00", "ff00ff", "00ffff", "ffffff"};
  const int number = entity.RankColor();
  if (number > 0 && number < static_cast<int>(kNumbered.size())) return kNumbered[number];
  const Handle(IGESGraph_Color) colour = Handle(IGESGraph_Color)::DownCast(entity.Color());
  if (colour.IsNull()) return "";
  double red = 0, green = 0, blue = 0;
  colour->RGBIntensity(red, green, blue);
  const auto byte = [](double percent) { return std::lround(std::clamp(percent, 0.0, 100.0) * 2.55); };
  return fmt::format("{:02x}{:02x}{:02x}", byte(red), byte(green), byte(blue));
}

}  // namespace

PartNames iges_names(const IGESControl_Reader& reader, std::vector<Warning>& warnings) {
  PartNames names;
  const Handle(Transfer_TransientProcess) transfer = reader.WS()->TransferReader()->TransientProcess();
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  std::vector<std::string> names_of;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(IGESData_IGESEntity) entity = Handle(IGESData_IGESEntity)::DownCast(model->Value(i));
    names_of.push_back(entity.IsNull() ? "" : name_of(*entity));
  }
  if (const std::string warning = decode_texts(names_of); !warning.empty()) warnings.push_back(warning);
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(IGESData_IGESEntity) entity = Handle(IGESData_IGESEntity)::DownCast(model->Value(i));
    if (entity.IsNull()) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer, entity);
    if (shape.IsNull()) continue;
    const std::string name = names_of[i - 1], colour = colour_of(*entity);
    for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
      if (!name.empty()) names.add(face.Current(), name);
      if (!colour.empty()) names.add(face.Current(), std::string(kColourName) + colour);
    }
  }
  return names;
}

}  // namespace delquad::cad
