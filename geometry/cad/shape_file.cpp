// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/shape_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_BasicEditor.hxx>
#include <IGESData_ColorEntity.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGraph_Color.hxx>
#include <Interface_Check.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Resource_FormatType.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_DocumentFile.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

#include "base/length_unit.h"
#include "base/system.h"
#include "base/text.h"
#include "base/utf8.h"
#include "delquad/error.h"
#include "delquad/mesh.h"
#include "geometry/cad/lost_shapes.h"
#include "geometry/cad/step_names.h"
#include "geometry/cad/text_encoding.h"

namespace delquad::cad {

namespace {

/// Returns the long name (a property), or the short one (the label).
std::string name_of(const IGESData_IGESEntity& entity) {
  if (!entity.HasName()) return "";
  const Handle(TCollection_HAsciiString) name = entity.NameValue();
  const std::string text = name.IsNull() ? "" : name->ToCString();
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Returns one of the eight numbered colors, or a color by percentages of red, green and blue; empty: none.
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

/// Returns names and colors of the transferred faces, from all entities that hold them. `warnings` gets the
/// assumed encoding of bytes beyond ASCII.
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

/// Keeps the kernel's first complaint in place of printing it.
class FirstComplaint : public Message_Printer {
 public:
  /// Returns " (...)"; empty if there was no complaint.
  std::string why() const { return text_.empty() ? "" : " (" + as_utf8(text_) + ")"; }

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

/// Collects the kernel's messages from now on.
Handle(FirstComplaint) collect_messages() {
  const Handle(FirstComplaint) complaint = new FirstComplaint;
  Message::DefaultMessenger()->ChangePrinters().Clear();
  Message::DefaultMessenger()->AddPrinter(complaint);
  return complaint;
}

/// Number of bytes that tell the kind of a file.
constexpr std::size_t kBeginning = 4096;

std::string beginning(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError(cannot_be_read("it is a folder"));
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(cannot_be_read(std::generic_category().message(errno)));
  std::string text(kBeginning, '\0');
  in.read(text.data(), kBeginning);
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

/// Limit of items that messages list.
constexpr std::size_t kMostNamed = 5;

/// Returns "2 parts of the STEP file cannot be read: ...".
std::string unread(const std::string& kind, const std::vector<std::string>& lost,
                   const std::string& why = "") {
  return fmt::format("{} of the {} file cannot be read: {}{}", counted(std::ssize(lost), "part"), kind,
                     first_of(lost, kMostNamed), why);
}

/// Throws InputError unless `keep_going` is set and a rest exists; then the shape lists the lost parts.
void lose(const std::string& text, bool keep_going, bool is_rest, CadShape& cad) {
  if (!is_rest) throw InputError(text + ": no face is left");
  if (!keep_going) throw InputError(text + ": expected a whole model (--keep-going meshes the rest)");
  cad.missing.push_back(text);
}

/// Returns the parser's first complaint, " (Unresolved Reference, Ent.Id.#15 Param.n0 2 (Id.#16))"; empty:
/// none.
std::string first_failure(const XSControl_Reader& reader) {
  const Handle(Interface_Check) check = reader.WS()->Model()->GlobalCheck();
  return check->HasFailed() ? fmt::format(" ({})", check->CFail(1)) : "";
}

/// "; its parts lie in other files (A.stp, B.stp): ...", or nothing.
std::string other_files(const XSControl_Reader& reader) {
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  std::vector<std::string> names;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(StepBasic_DocumentFile) file = Handle(StepBasic_DocumentFile)::DownCast(model->Value(i));
    if (!file.IsNull() && !file->Id().IsNull()) names.push_back(as_utf8(file->Id()->ToCString()));
  }
  if (names.empty()) return "";
  return fmt::format("; its parts lie in other files ({}): mesh these, or export all parts in one file",
                     first_of(names, kMostNamed));
}

/// Names of the units of lengths, in capitals.
std::vector<std::string> units_of_file(STEPControl_Reader& reader) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  std::vector<std::string> units;
  for (TCollection_AsciiString& length : lengths) {
    length.UpperCase();
    units.emplace_back(length.ToCString());
  }
  return units;
}
std::vector<std::string> units_of_file(IGESControl_Reader& reader) {
  constexpr int kByName = 3;
  const IGESData_GlobalSection& global =
      Handle(IGESData_IGESModel)::DownCast(reader.WS()->Model())->GlobalSection();
  const Handle(TCollection_HAsciiString) name = global.UnitName();
  if (global.UnitFlag() == kByName && !name.IsNull()) return {upper(name->ToCString())};
  return {IGESData_BasicEditor::UnitFlagName(global.UnitFlag())};
}

void warn_of_unit(const std::vector<std::string>& in_file, const LengthUnit& wanted, CadShape& cad) {
  const bool is_same = std::ranges::all_of(in_file, [&](const std::string& unit) {
    return unit == wanted.kernel || unit == upper(wanted.name) || unit == wanted.long_name;
  });
  if (!is_same)
    cad.warnings.push_back(
        fmt::format("the file's lengths are in {}: the model, --size and the mesh are in {} "
                    "(--unit chooses another unit) [other-unit]",
                    fmt::join(in_file, " and "), wanted.name));
}

/// Returns the shape of a STEP or IGES file.
template <class Reader>
CadShape transfer(Reader& reader, const std::string& kind, const CadOptions& options,
                  const std::function<IFSelect_ReturnStatus(Reader&)>& load) {
  const Handle(FirstComplaint) complaint = collect_messages();
  const LengthUnit& wanted = length_unit(options.unit.empty() ? "mm" : options.unit);
  Interface_Static::SetCVal("xstep.cascade.unit", wanted.kernel);
  if (load(reader) != IFSelect_RetDone)
    throw InputError("not a readable " + kind + " file" + complaint->why());
  CadShape cad;
  const int roots = reader.NbRootsForTransfer();
  const int transferred = reader.TransferRoots();
  const LostShapes lost = lost_shapes(reader);
  if (!lost.damaged.empty())
    lose(unread(kind, lost.damaged, first_failure(reader)), options.keep_going, reader.NbShapes() > 0, cad);
  if (reader.NbShapes() == 0)
    throw InputError("the " + kind + " file holds no shape" + other_files(reader) + complaint->why());
  if (lost.damaged.empty() && transferred < roots)
    cad.warnings.push_back(fmt::format("{} of {} entries of the {} file are no faces and cannot be read{}",
                                       roots - transferred, roots, kind, complaint->why()));
  if (!lost.doubtful.empty())
    cad.warnings.push_back(fmt::format("parts of the {} file were read with errors: {} [damaged-cad]", kind,
                                       first_of(lost.doubtful, kMostNamed)));
  if (!lost.unused.empty())
    cad.warnings.push_back(fmt::format("{} faces of the {} file belong to no shape and are left out: {}",
                                       lost.unused.size(), kind, first_of(lost.unused, kMostNamed)));
  cad.shape = reader.OneShape();
  cad.unit = wanted.name;
  warn_of_unit(units_of_file(reader), wanted, cad);
  return cad;
}

CadShape read_step(const CadOptions& options, const std::string& bytes) {
  STEPControl_Reader reader;
  CadShape cad = transfer<STEPControl_Reader>(reader, "STEP", options, [&bytes](STEPControl_Reader& r) {
    // The kernel takes each byte for a character; decode_texts() finds the encoding from all names.
    Interface_Static::SetIVal("read.step.codepage", Resource_FormatType_iso8859_1);
    std::istringstream in(bytes);
    const IFSelect_ReturnStatus status = r.ReadStream("bytes", in);
    // The kernel may crash when it makes shapes of damaged parts.
    if (status == IFSelect_RetDone)
      if (const auto lost = unreadable_parts(r); !lost.empty())
        throw InputError(unread("STEP", lost, first_failure(r)) +
                         ": expected a whole file; export it again from CAD [damaged-cad]");
    return status;
  });
  const bool is_ascii =
      std::ranges::all_of(bytes, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  cad.names = step_names(reader, is_ascii, cad.warnings);
  return cad;
}

CadShape read_iges(const std::string& path, const CadOptions& options) {
  IGESControl_Reader reader;
  CadShape cad = transfer<IGESControl_Reader>(
      reader, "IGES", options, [&](IGESControl_Reader& r) { return r.ReadFile(path.c_str()); });
  cad.names = iges_names(reader, cad.warnings);
  return cad;
}

/// Reads IGES by a temporary file, since the kernel reads it from files only.
CadShape read_iges_bytes(const std::string& bytes, const CadOptions& options) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "model.igs").string();
  std::ofstream out(path, std::ios::binary);
  if (!out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush())
    throw InputError("the IGES file's bytes do not fit into a temporary file, " + path);
  return read_iges(path, options);
}

CadShape read_brep(const std::string& bytes, const CadOptions& options) {
  if (!options.unit.empty())
    throw InputError(
        "BREP files do not say their unit: lengths stay as they are, and no unit can be asked for");
  const Handle(FirstComplaint) complaint = collect_messages();
  // The stream must stop the kernel at the end of a truncated file, or it reads forever.
  std::istringstream in(bytes);
  in.exceptions(std::ios::failbit | std::ios::badbit);
  CadShape cad;
  try {
    BRepTools::Read(cad.shape, in, BRep_Builder());
  } catch (const std::ios::failure&) {
    throw InputError("not a readable BREP file (it ends too early or is damaged) [damaged-cad]");
  }
  if (cad.shape.IsNull()) throw InputError("not a readable BREP file" + complaint->why() + " [damaged-cad]");
  TopTools_MapOfShape faces;
  for (TopExp_Explorer face(cad.shape, TopAbs_FACE); face.More(); face.Next())
    faces.Add(unplaced(face.Current()));
  if (const auto lost = lost_in_brep(bytes, faces.Extent()); !lost.empty())
    lose(unread("BREP", lost), options.keep_going, !faces.IsEmpty(), cad);
  return cad;
}

enum class Kind { kStep, kIges, kBrep };

/// Returns whether a text begins like an IGES file: its first line ends with the mark of section S at
/// character 80.
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

CadShape read_shape(const std::filesystem::path& path, const CadOptions& options) {
  const Kind kind = kind_of(beginning(path));
  if (kind == Kind::kIges) return read_iges(path.string(), options);
  const std::string bytes = file_bytes(path);
  return kind == Kind::kStep ? read_step(options, bytes) : read_brep(bytes, options);
}

CadShape read_shape_bytes(const std::string& bytes, const CadOptions& options) {
  const Kind kind = kind_of(bytes.substr(0, kBeginning));
  if (kind == Kind::kIges) return read_iges_bytes(bytes, options);
  return kind == Kind::kStep ? read_step(options, bytes) : read_brep(bytes, options);
}

}  // namespace delquad::cad
