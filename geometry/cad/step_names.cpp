// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/step_names.h"

#include <fmt/format.h>

#include <Interface_InterfaceModel.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct_Styles.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepShape_TopologicalRepresentationItem.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <string>

#include "delquad/mesh.h"
#include "geometry/cad/text_encoding.h"

namespace delquad::cad {

namespace {

/// Returns whether writers put this text in place of a missing name.
bool is_placeholder(const std::string& name) {
  return name.find_first_not_of(' ') == std::string::npos || name == "NONE" ||
         name.starts_with("Open CASCADE STEP translator");
}

std::string name_of(const Handle(Standard_Transient) & entity) {
  Handle(TCollection_HAsciiString) name;
  if (const auto product = Handle(StepBasic_ProductDefinition)::DownCast(entity); !product.IsNull()) {
    if (product->Formation().IsNull() || product->Formation()->OfProduct().IsNull()) return "";
    name = product->Formation()->OfProduct()->Name();
  } else if (entity->IsKind(STANDARD_TYPE(StepShape_TopologicalRepresentationItem)) ||
             entity->IsKind(STANDARD_TYPE(StepShape_SolidModel))) {
    name = Handle(StepRepr_RepresentationItem)::DownCast(entity)->Name();
  }
  return name.IsNull() || is_placeholder(name->ToCString()) ? "" : name->ToCString();
}

}  // namespace

PartNames step_names(const STEPControl_Reader& reader, bool is_ascii, std::vector<Warning>& warnings) {
  PartNames names;
  const Handle(Transfer_TransientProcess) transfer = reader.WS()->TransferReader()->TransientProcess();
  const auto add = [&](const Handle(Standard_Transient) & entity, const std::string& name) {
    const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer, entity);
    if (shape.IsNull()) return;
    if (shape.ShapeType() == TopAbs_EDGE) names.add(shape, name);
    for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) names.add(face.Current(), name);
  };

  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  std::vector<std::string> names_of;
  for (int i = 1; i <= model->NbEntities(); ++i) names_of.push_back(name_of(model->Value(i)));
  if (!is_ascii)
    if (const std::string warning = decode_kernel_texts(names_of); !warning.empty())
      warnings.push_back(warning);
  for (int i = 1; i <= model->NbEntities(); ++i)
    if (const std::string& name = names_of[i - 1]; !name.empty()) add(model->Value(i), name);

  STEPConstruct_Styles styles(reader.WS());
  if (!styles.LoadStyles()) return names;
  for (int i = 1; i <= styles.NbStyles(); ++i) {
    const Handle(StepVisual_StyledItem) style = styles.Style(i);
    Handle(StepVisual_Colour) surface, boundary, curve, render;
    double transparency = 0;
    bool is_component = false;
    Quantity_Color colour;
    if (!styles.GetColors(style, surface, boundary, curve, render, transparency, is_component)) continue;
    if (surface.IsNull() || !STEPConstruct_Styles::DecodeColor(surface, colour)) continue;
    add(style->Item(), fmt::format("{}{}", kColourName, Quantity_Color::ColorToHex(colour).ToCString() + 1));
  }
  return names;
}

}  // namespace delquad::cad
