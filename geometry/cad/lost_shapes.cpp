// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/lost_shapes.h"

#include <fmt/format.h>

#include <IGESData_IGESEntity.hxx>
#include <IGESToBRep.hxx>
#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_InterfaceModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <StepShape_SolidModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>

namespace delquad::cad {

namespace {

using Transient = Handle(Standard_Transient);

/// Types of IGES entities that are faces by themselves.
constexpr std::array kIgesFaces = {143, 144, 510};
/// Types of shells and solids of faces.
constexpr std::array kIgesBodies = {186, 514};

int iges_type(const Transient& entity) {
  const Handle(IGESData_IGESEntity) iges = Handle(IGESData_IGESEntity)::DownCast(entity);
  return iges.IsNull() ? 0 : iges->TypeNumber();
}

bool is_face(const Transient& entity) {
  return entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface)) ||
         std::ranges::count(kIgesFaces, iges_type(entity)) > 0;
}

bool is_surface_or_body(const Transient& entity) {
  const Handle(IGESData_IGESEntity) iges = Handle(IGESData_IGESEntity)::DownCast(entity);
  return is_face(entity) || entity->IsKind(STANDARD_TYPE(StepShape_ConnectedFaceSet)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_SolidModel)) ||
         std::ranges::count(kIgesBodies, iges_type(entity)) > 0 ||
         (!iges.IsNull() && IGESToBRep::IsTopoSurface(iges));
}

/// Returns whether no shape depends on the entity: text, colors and leaders of a drawing.
bool is_drawn(const Transient& entity) {
  return std::string_view(entity->DynamicType()->Name()).starts_with("StepVisual_");
}

/// Returns whether no shape depends on the subject of a complaint: names, and the declared form of a curve.
bool is_harmless(const std::string& complaint) {
  constexpr std::array kFields = {"name)",      "description)",    "form)",
                                  "knot_spec)", "self_intersect)", "closed_"};
  return std::ranges::any_of(kFields,
                             [&](const char* field) { return complaint.find(field) != std::string::npos; });
}

class LossFinder {
 public:
  explicit LossFinder(XSControl_Reader& reader)
      : reader_(reader),
        model_(reader.WS()->Model()),
        process_(reader.WS()->TransferReader()->TransientProcess()) {}

  std::vector<std::string> find_unreadable_parts() {
    for (const auto& [i, why] : find_unreadable())
      if (!model_->Value(i)->IsKind(STANDARD_TYPE(StepShape_ConnectedFaceSet)))
        add(lost_.damaged, model_->Value(i), why);
    return std::move(lost_.damaged);
  }

  LostShapes find() {
    for (const auto& [i, why] : find_unreadable()) add(lost_.damaged, model_->Value(i), why);
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      const Transient entity = model_->Value(i);
      if (!is_face(entity) || has_face(entity)) continue;
      const Handle(Transfer_Binder) tried = process_->Find(entity);
      if (!tried.IsNull() || is_damaged_)
        add(lost_.damaged, entity, tried.IsNull() ? "" : complaint(*tried->Check()));
      else
        add(lost_.unused, entity, "");
    }
    for (int i = 1; i <= reader_.NbRootsForTransfer(); ++i)
      if (const Transient root = reader_.RootForTransfer(i);
          !is_face(root) && is_surface_or_body(root) && !has_face(root))
        add(lost_.damaged, root, "");
    for (int i = 1; i <= model_->NbEntities(); ++i)
      if (const Handle(Transfer_Binder) tried = process_->Find(model_->Value(i));
          !tried.IsNull() && tried->Check()->HasFailed())
        add(lost_.doubtful, model_->Value(i), complaint(*tried->Check()));
    return std::move(lost_);
  }

 private:
  /// Returns the complaints about entities that shapes are made of, by their index in the model.
  std::map<int, std::string> find_unreadable() {
    const Interface_Graph graph(model_);
    std::vector<char> met(model_->NbEntities() + 1, 0);
    std::vector<Transient> open;
    const auto meet = [&](const Transient& entity) {
      const int number = entity.IsNull() ? 0 : model_->Number(entity);
      if (number == 0 || met[number] || is_drawn(entity)) return;
      met[number] = 1;
      open.push_back(entity);
    };
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      const Transient entity = model_->Value(i);
      if (is_surface_or_body(entity)) meet(entity);
      const auto shapes = Handle(StepShape_ShapeRepresentation)::DownCast(entity);
      for (int k = 1; !shapes.IsNull() && k <= shapes->NbItems(); ++k) meet(shapes->ItemsValue(k));
    }
    while (!open.empty()) {
      const Transient entity = open.back();
      open.pop_back();
      for (Interface_EntityIterator used = graph.Shareds(entity); used.More(); used.Next())
        meet(used.Value());
    }
    std::map<int, std::string> found;
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      const Handle(Interface_Check) check = model_->Check(i, /*syntactic=*/true);
      if (!check->HasFailed() || is_harmless(check->CFail(1)) || is_drawn(model_->Value(i))) continue;
      is_damaged_ = true;
      if (met[i]) found.emplace(i, complaint(*check));
    }
    return found;
  }

  bool has_face(const Transient& entity) const {
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process_, entity);
    return !shape.IsNull() && TopExp_Explorer(shape, TopAbs_FACE).More();
  }

  static std::string complaint(const Interface_Check& check) {
    return check.HasFailed() ? check.CFail(1) : "";
  }

  void add(std::vector<std::string>& list, const Transient& entity, const std::string& why) {
    if (!listed_.insert(model_->Number(entity)).second) return;
    const std::string type = entity->DynamicType()->Name();
    list.push_back(fmt::format("{} ({}){}{}", model_->StringLabel(entity)->ToCString(),
                               type.substr(type.find('_') + 1), why.empty() ? "" : ": ", why));
  }

  XSControl_Reader& reader_;
  Handle(Interface_InterfaceModel) model_;
  Handle(Transfer_TransientProcess) process_;
  bool is_damaged_ = false;  ///< whether something other than a name could not be read
  std::set<int> listed_;     ///< numbers of entities
  LostShapes lost_;
};

}  // namespace

LostShapes lost_shapes(XSControl_Reader& reader) { return LossFinder(reader).find(); }

std::vector<std::string> unreadable_parts(XSControl_Reader& reader) {
  return LossFinder(reader).find_unreadable_parts();
}

std::vector<std::string> lost_in_brep(const std::string& text, int n_faces) {
  std::vector<std::string> lost;
  int line = 1, n_written = 0;
  const auto is_blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t i = std::min(text.find("CASCADE Topology"), text.size()); i < text.size();) {
    if (is_blank(text[i])) {
      line += text[i++] == '\n';
      continue;
    }
    const std::size_t begin = i;
    while (i < text.size() && !is_blank(text[i])) ++i;
    const std::string word = text.substr(begin, i - begin);
    n_written += word == "Fa";
    if (word.find_first_of("0123456789") != std::min<std::size_t>(word.find_first_not_of("+-."), word.size()))
      continue;
    // The kernel writes no blank before a continuity.
    constexpr std::array kContinuities = {"", "C0", "C1", "C2", "C3", "CN", "G1", "G2"};
    char* end = nullptr;
    std::strtod(word.c_str(), &end);
    if (std::ranges::count(kContinuities, std::string_view(end)) == 0)
      lost.push_back(fmt::format("line {}: '{}' is no number", line, word));
  }
  if (n_faces < n_written)
    lost.push_back(fmt::format("{} of {} faces belong to no shape", n_written - n_faces, n_written));
  return lost;
}

}  // namespace delquad::cad
