#include <fmt/format.h>

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepTools.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPConstruct.hxx>
#include <STEPControl_Writer.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <Transfer_FinderProcess.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <stdexcept>

#include "cad/example_models.h"
#include "cad/examples/shapes.h"

namespace delquad {

namespace cad {

CadShape make_example(const std::string& name) {
  if (name == "bracket") return make_bracket();
  if (name == "hood") return make_hood();
  if (name == "pipe_tee") return make_pipe_tee();
  if (name == "sphere") return make_sphere();
  if (name == "torus") return make_torus();
  if (name == "wing_body") return make_wing_body();
  throw std::logic_error("no example " + name);
}

namespace {

Handle(TCollection_HAsciiString) text(const std::string& value) {
  return new TCollection_HAsciiString(value.c_str());
}

/// Names file and product after the model, and leaves the date out: else the bytes would differ each time.
void write_titles(const std::string& name, const Handle(StepData_StepModel) & model) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text(name));
  header.SetTimeStamp(text("1970-01-01T00:00:00"));
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto product = Handle(StepBasic_Product)::DownCast(model->Value(i));
    if (product.IsNull()) continue;
    product->SetId(text(name));
    product->SetName(text(name));
  }
}

void name_faces(const CadShape& cad, const STEPControl_Writer& writer) {
  const auto process = writer.WS()->TransferWriter()->FinderProcess();
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(cad.shape, TopAbs_FACE, faces);
  for (int f = 1; f <= faces.Extent(); ++f) {
    TopLoc_Location place;  // a face that was moved may be written where it came from
    const Handle(StepRepr_RepresentationItem) item = STEPConstruct::FindEntity(process, faces(f), place);
    if (item.IsNull()) throw std::logic_error("a face was not written");
    for (const std::string& name : cad.names.of(faces(f))) item->SetName(text(name));
  }
}

void write_step(const std::string& name, const CadShape& cad, std::ostream& out) {
  Message::DefaultMessenger()->ChangePrinters().Clear();  // it would print statistics
  STEPControl_Writer writer;
  if (writer.Transfer(cad.shape, STEPControl_AsIs) != IFSelect_RetDone)
    throw std::logic_error("the example " + name + " cannot be written");
  name_faces(cad, writer);
  const Handle(StepData_StepModel) model = writer.Model();
  write_titles(name, model);
  StepData_StepWriter lines(model);
  lines.SendModel(Handle(StepData_Protocol)::DownCast(writer.WS()->Protocol()));
  lines.Print(out);
}

}  // namespace

}  // namespace cad

void write_example(const std::string& name, CadFormat format, std::ostream& out) {
  check_example(name);
  const cad::CadShape shape = cad::make_example(name);
  if (format == CadFormat::kStep)
    cad::write_step(name, shape, out);
  else
    BRepTools::Write(shape.shape, out);
}

}  // namespace delquad
