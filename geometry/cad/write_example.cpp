// SPDX-License-Identifier: GPL-3.0-or-later
#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepTools.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_SequenceOfPrinters.hxx>
#include <STEPConstruct.hxx>
#include <STEPControl_Writer.hxx>
#include <StepBasic_Product.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopLoc_Location.hxx>
#include <Transfer_FinderProcess.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <map>
#include <stdexcept>
#include <utility>

#include "base/activity.h"
#include "geometry/cad/examples/shapes.h"
#include "geometry/cad/heal_shape.h"
#include "geometry/cad/kernel.h"

namespace delquad {

namespace cad {

CadShape make_example(const std::string& name) {
  static const std::map<std::string, CadShape (*)()> kMakers = {
      {"bracket", make_bracket},
      {"hood", make_hood},
      {"pipe_tee", make_pipe_tee},
      {"sphere", make_sphere},
      {"torus", make_torus},
      {"wing_body", make_wing_body},
      {"blended_tee", make_blended_tee},
      {"cone_tip", make_cone_tip},
      {"cross_drilled", make_cross_drilled},
      {"elbow", make_elbow},
      {"fins", make_fins},
      {"free_form", make_free_form},
      {"loft", make_loft},
      {"sheet", make_sheet},
      {"thin_box", make_thin_box},
      {"variable_fillet", make_variable_fillet},
  };
  const auto at = kMakers.find(name);
  if (at != kMakers.end()) return at->second();
  throw std::logic_error("no example " + name);
}

namespace {

Handle(TCollection_HAsciiString) text(const std::string& value) {
  return new TCollection_HAsciiString(value.c_str());
}

/// Names file and product after the model, counts its bodies from 1 and leaves out the date, so that bytes
/// are reproducible.
void write_titles(const std::string& name, const Handle(StepData_StepModel) & model) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(text(name));
  header.SetTimeStamp(text("1970-01-01T00:00:00"));
  int bodies = 0;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    if (const auto body = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(model->Value(i));
        !body.IsNull())
      body->SetId(text(std::to_string(++bodies)));
    const auto product = Handle(StepBasic_Product)::DownCast(model->Value(i));
    if (product.IsNull()) continue;
    product->SetId(text(name));
    product->SetName(text(name));
  }
}

/// Silences the kernel during its lifetime.
class SilentKernel {
 public:
  SilentKernel() { std::swap(printers_, Message::DefaultMessenger()->ChangePrinters()); }
  ~SilentKernel() { std::swap(printers_, Message::DefaultMessenger()->ChangePrinters()); }
  SilentKernel(const SilentKernel&) = delete;
  SilentKernel& operator=(const SilentKernel&) = delete;

 private:
  Message_SequenceOfPrinters printers_;
};

void name_faces(const CadShape& cad, const STEPControl_Writer& writer) {
  const auto process = writer.WS()->TransferWriter()->FinderProcess();
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  for (int f = 1; f <= faces.Extent(); ++f) {
    TopLoc_Location place;  // a moved face may be written at its former place
    const Handle(StepRepr_RepresentationItem) item = STEPConstruct::FindEntity(process, faces(f), place);
    if (item.IsNull()) throw std::logic_error("a face was not written");
    for (const std::string& name : cad.names.of(faces(f))) item->SetName(text(name));
  }
}

void write_step(const std::string& name, const CadShape& cad, std::ostream& out) {
  const SilentKernel silent;  // avoids printed statistics
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

/// Returns an example whose faces have its name first, like the name of a product in a STEP file.
CadShape make_product(const std::string& name) {
  const CadShape example = make_example(name);
  CadShape product{example.shape};
  product.unit = "mm";
  const TopTools_IndexedMapOfShape faces = parts(example.shape, TopAbs_FACE);
  for (int f = 1; f <= faces.Extent(); ++f) {
    product.names.add(faces(f), name);
    product.names.add(faces(f), example.names.of(faces(f)));
  }
  return product;
}

}  // namespace

SurfaceModel read_example_by_kernel(const std::string& name, const CadOptions& options) {
  const StageScope stage("reading");
  return model_of(name, prepare_shape(make_product(name), options), options);
}

void write_example_by_kernel(const std::string& name, CadFormat format, std::ostream& out) {
  const CadShape shape = make_example(name);
  if (format == CadFormat::kStep)
    write_step(name, shape, out);
  else
    BRepTools::Write(shape.shape, out);
}

}  // namespace cad

}  // namespace delquad
