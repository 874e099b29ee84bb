#include "geometry/cad/shape_file.h"

#include <fmt/format.h>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <TCollection_AsciiString.hxx>
#include <fstream>
#include <functional>
#include <sstream>

#include "delquad/error.h"
#include "geometry/cad/step_names.h"

namespace delquad::cad {

namespace {

/// Keeps the kernel's first complaint in place of printing it.
class FirstComplaint : public Message_Printer {
 public:
  /// " (...)", or nothing when there was none.
  std::string why() const { return text_.empty() ? "" : " (" + text_ + ")"; }

 protected:
  void send(const TCollection_AsciiString& message, const Message_Gravity gravity) const override {
    if (gravity < Message_Alarm || !text_.empty()) return;
    for (const char c : std::string(message.ToCString()))
      if (c != '*' && (c != ' ' || !text_.empty())) text_ += c == '\n' ? ' ' : c;
    while (!text_.empty() && text_.back() == ' ') text_.pop_back();
  }

 private:
  mutable std::string text_;
};

/// Takes the kernel's messages from here on.
Handle(FirstComplaint) listen() {
  const Handle(FirstComplaint) complaint = new FirstComplaint;
  Message::DefaultMessenger()->ChangePrinters().Clear();
  Message::DefaultMessenger()->AddPrinter(complaint);
  return complaint;
}

/// Enough of it to tell its kind.
constexpr std::size_t kBeginning = 4096;

std::string beginning(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError("a folder; expected a STEP or BREP file");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError("cannot be opened");
  std::string text(kBeginning, '\0');
  in.read(text.data(), kBeginning);
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

CadShape read_step(const std::function<IFSelect_ReturnStatus(STEPControl_Reader&)>& load) {
  const Handle(FirstComplaint) complaint = listen();
  STEPControl_Reader reader;
  if (load(reader) != IFSelect_RetDone) throw InputError("not a readable STEP file" + complaint->why());
  CadShape cad;
  const int roots = reader.NbRootsForTransfer();
  const int transferred = reader.TransferRoots();
  if (reader.NbShapes() == 0) throw InputError("the STEP file holds no shape" + complaint->why());
  if (transferred < roots) {
    cad.warnings.push_back(fmt::format("{} of {} shapes of the STEP file cannot be read{}",
                                       roots - transferred, roots, complaint->why()));
  }
  cad.shape = reader.OneShape();
  cad.names = step_names(reader);
  cad.unit = "mm";  // what the kernel converts to
  return cad;
}

CadShape read_brep(std::istream& in) {
  const Handle(FirstComplaint) complaint = listen();
  // The kernel reads on and on behind the end of a truncated file unless the stream stops it.
  in.exceptions(std::ios::failbit | std::ios::badbit);
  CadShape cad;
  try {
    BRepTools::Read(cad.shape, in, BRep_Builder());
  } catch (const std::ios::failure&) {
    throw InputError("not a readable BREP file (it ends too early or is damaged)");
  }
  if (cad.shape.IsNull()) throw InputError("not a readable BREP file" + complaint->why());
  return cad;
}

enum class Kind { kStep, kBrep };

Kind kind_of(const std::string& beginning) {
  if (beginning.find("ISO-10303-21") != std::string::npos) return Kind::kStep;
  if (beginning.find("CASCADE Topology V") != std::string::npos) return Kind::kBrep;
  throw InputError("neither STEP (ISO-10303-21) nor BREP (CASCADE Topology)");
}

}  // namespace

CadShape read_shape(const std::filesystem::path& path) {
  if (kind_of(beginning(path)) == Kind::kStep)
    return read_step([&](STEPControl_Reader& reader) { return reader.ReadFile(path.c_str()); });
  std::ifstream in(path, std::ios::binary);
  return read_brep(in);
}

CadShape read_shape_bytes(const std::string& bytes) {
  std::istringstream in(bytes);
  if (kind_of(bytes.substr(0, kBeginning)) == Kind::kStep)
    return read_step([&](STEPControl_Reader& reader) { return reader.ReadStream("bytes", in); });
  return read_brep(in);
}

}  // namespace delquad::cad
