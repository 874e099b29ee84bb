#include "cad/shape_file.h"

#include <fmt/format.h>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <TCollection_AsciiString.hxx>
#include <XSControl_WorkSession.hxx>
#include <fstream>
#include <iostream>
#include <sstream>

#include "cad/rehearse.h"
#include "cad/step_names.h"
#include "mesh/error.h"

namespace delquad::cad {

namespace {

/// Keeps the kernel's first complaint in place of printing it.
class FirstComplaint : public Message_Printer {
 public:
  const std::string& text() const { return text_; }

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

/// The kernel's messages go nowhere but here while it lives; some it writes to the standard output directly.
class QuietKernel {
 public:
  QuietKernel() : before_(Message::DefaultMessenger()->Printers()), complaint_(new FirstComplaint) {
    cout_ = std::cout.rdbuf(printed_.rdbuf());
    Message::DefaultMessenger()->ChangePrinters().Clear();
    Message::DefaultMessenger()->AddPrinter(complaint_);
  }
  QuietKernel(const QuietKernel&) = delete;
  QuietKernel& operator=(const QuietKernel&) = delete;
  ~QuietKernel() {
    std::cout.rdbuf(cout_);
    Message::DefaultMessenger()->ChangePrinters() = before_;
  }

  /// " (...)" with the first complaint, if there was one.
  std::string why() const { return complaint_->text().empty() ? "" : " (" + complaint_->text() + ")"; }

 private:
  Message_SequenceOfPrinters before_;
  Handle(FirstComplaint) complaint_;
  std::ostringstream printed_;
  std::streambuf* cout_;
};

std::string beginning(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(fmt::format("{}: a folder; expected a STEP or BREP file", path.string()));
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be opened", path.string()));
  constexpr std::size_t kEnough = 4096;
  std::string text(kEnough, '\0');
  in.read(text.data(), kEnough);
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

/// How long the trial of a file may take, seconds: a hundred times what large models need.
constexpr unsigned kPatience = 300;

/// True when the file's entities are what its schema says.
bool is_consistent(const STEPControl_Reader& reader) {
  Interface_CheckIterator checks = reader.WS()->ModelCheckList();
  for (checks.Start(); checks.More(); checks.Next())
    if (checks.Value()->HasFailed()) return false;
  return true;
}

void load(STEPControl_Reader& reader, const std::filesystem::path& path, const QuietKernel& quiet) {
  if (reader.ReadFile(path.c_str()) == IFSelect_RetDone) return;
  throw InputError(fmt::format("{}: not a readable STEP file{}", path.string(), quiet.why()));
}

CadShape transfer(STEPControl_Reader& reader, const std::filesystem::path& path, const QuietKernel& quiet) {
  CadShape cad;
  const int roots = reader.NbRootsForTransfer();
  const int transferred = reader.TransferRoots();
  if (reader.NbShapes() == 0) {
    throw InputError(fmt::format("{}: the STEP file holds no shape{}", path.string(), quiet.why()));
  }
  if (transferred < roots) {
    cad.warnings.push_back(fmt::format("{} of {} shapes of the STEP file cannot be read{}",
                                       roots - transferred, roots, quiet.why()));
  }
  cad.shape = reader.OneShape();
  cad.names = step_names(reader);
  return cad;
}

CadShape read_step(const std::filesystem::path& path) {
  const QuietKernel quiet;
  // What loads and is consistent transfers safely; the transfer of anything else is tried too.
  const auto trial = [&] {
    STEPControl_Reader reader;
    load(reader, path, quiet);
    if (!is_consistent(reader)) transfer(reader, path, quiet);
  };
  if (!rehearse(trial, kPatience)) {
    throw InputError(
        fmt::format("{}: not a readable STEP file (damaged: the CAD kernel crashes on it)", path.string()));
  }
  STEPControl_Reader reader;
  load(reader, path, quiet);
  return transfer(reader, path, quiet);
}

CadShape read_brep(const std::filesystem::path& path) {
  const QuietKernel quiet;
  std::ifstream in(path, std::ios::binary);
  // The kernel reads on and on behind the end of a truncated file unless the stream stops it.
  in.exceptions(std::ios::failbit | std::ios::badbit);
  CadShape cad;
  try {
    BRepTools::Read(cad.shape, in, BRep_Builder());
  } catch (const std::ios::failure&) {
    throw InputError(
        fmt::format("{}: not a readable BREP file (it ends too early or is damaged)", path.string()));
  }
  if (cad.shape.IsNull()) {
    throw InputError(fmt::format("{}: not a readable BREP file{}", path.string(), quiet.why()));
  }
  return cad;
}

}  // namespace

CadShape read_shape(const std::filesystem::path& path) {
  const std::string text = beginning(path);
  if (text.find("ISO-10303-21") != std::string::npos) return read_step(path);
  if (text.find("CASCADE Topology V") != std::string::npos) return read_brep(path);
  throw InputError(fmt::format("{}: neither STEP (ISO-10303-21) nor BREP (CASCADE Topology)", path.string()));
}

}  // namespace delquad::cad
