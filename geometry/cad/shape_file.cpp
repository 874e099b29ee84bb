#include "geometry/cad/shape_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <TCollection_AsciiString.hxx>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>

#include "base/length_unit.h"
#include "delquad/error.h"
#include "geometry/cad/iges_names.h"
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
    throw InputError("a folder; expected a STEP, IGES or BREP file");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError("cannot be opened");
  std::string text(kBeginning, '\0');
  in.read(text.data(), kBeginning);
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

/// What STEP and IGES have in common.
template <class Reader>
CadShape transfer(Reader& reader, const std::string& kind, const std::string& unit,
                  const std::function<IFSelect_ReturnStatus(Reader&)>& load) {
  const Handle(FirstComplaint) complaint = listen();
  const LengthUnit& wanted = length_unit(unit.empty() ? "mm" : unit);
  Interface_Static::SetCVal("xstep.cascade.unit", wanted.kernel);
  if (load(reader) != IFSelect_RetDone)
    throw InputError("not a readable " + kind + " file" + complaint->why());
  CadShape cad;
  const int roots = reader.NbRootsForTransfer();
  const int transferred = reader.TransferRoots();
  if (reader.NbShapes() == 0) throw InputError("the " + kind + " file holds no shape" + complaint->why());
  if (transferred < roots) {
    cad.warnings.push_back(fmt::format("{} of {} shapes of the {} file cannot be read{}", roots - transferred,
                                       roots, kind, complaint->why()));
  }
  cad.shape = reader.OneShape();
  cad.unit = wanted.name;
  return cad;
}

CadShape read_step(const std::string& unit,
                   const std::function<IFSelect_ReturnStatus(STEPControl_Reader&)>& load) {
  STEPControl_Reader reader;
  CadShape cad = transfer(reader, "STEP", unit, load);
  cad.names = step_names(reader);
  return cad;
}

CadShape read_iges(const std::string& path, const std::string& unit) {
  IGESControl_Reader reader;
  CadShape cad = transfer<IGESControl_Reader>(
      reader, "IGES", unit, [&](IGESControl_Reader& r) { return r.ReadFile(path.c_str()); });
  cad.names = iges_names(reader);
  return cad;
}

struct TemporaryFile {
  std::string path = (std::filesystem::temp_directory_path() / "delquad-XXXXXX").string();
  TemporaryFile() {
    const int file = mkstemp(path.data());
    if (file < 0) throw InputError(path + ": no temporary file can be made for the IGES file's bytes");
    close(file);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

/// The kernel reads IGES from files only.
CadShape read_iges_bytes(const std::string& bytes, const std::string& unit) {
  const TemporaryFile file;
  std::ofstream out(file.path, std::ios::binary);
  if (!out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush())
    throw InputError("the IGES file's bytes do not fit into a temporary file, " + file.path);
  return read_iges(file.path, unit);
}

CadShape read_brep(std::istream& in, const std::string& unit) {
  if (!unit.empty())
    throw InputError(
        "BREP files do not say their unit: lengths stay as they are, and no unit can be asked for");
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

enum class Kind { kStep, kIges, kBrep };

/// The first line of an IGES file is the first of its section S: it says so at the end of its 80 characters.
bool begins_iges(const std::string& text) {
  constexpr std::size_t kSection = 72;
  const std::size_t end = text.find_first_of("\r\n");
  return end > kSection && end != std::string::npos && text[kSection] == 'S' &&
         text.find_first_not_of(" 0", kSection + 1) < end;
}

Kind kind_of(const std::string& beginning) {
  if (beginning.find("ISO-10303-21") != std::string::npos) return Kind::kStep;
  if (beginning.find("CASCADE Topology V") != std::string::npos) return Kind::kBrep;
  if (begins_iges(beginning)) return Kind::kIges;
  throw InputError("neither STEP (ISO-10303-21), IGES (section S) nor BREP (CASCADE Topology)");
}

}  // namespace

CadShape read_shape(const std::filesystem::path& path, const std::string& unit) {
  const Kind kind = kind_of(beginning(path));
  if (kind == Kind::kStep)
    return read_step(unit, [&](STEPControl_Reader& reader) { return reader.ReadFile(path.c_str()); });
  if (kind == Kind::kIges) return read_iges(path.string(), unit);
  std::ifstream in(path, std::ios::binary);
  return read_brep(in, unit);
}

CadShape read_shape_bytes(const std::string& bytes, const std::string& unit) {
  const Kind kind = kind_of(bytes.substr(0, kBeginning));
  if (kind == Kind::kIges) return read_iges_bytes(bytes, unit);
  std::istringstream in(bytes);
  if (kind == Kind::kStep)
    return read_step(unit, [&](STEPControl_Reader& reader) { return reader.ReadStream("bytes", in); });
  return read_brep(in, unit);
}

}  // namespace delquad::cad
