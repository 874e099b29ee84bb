// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <TopExp_Explorer.hxx>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "base/activity.h"
#include "base/box.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/cad/agree_faces.h"
#include "geometry/cad/cad_shape.h"
#include "geometry/cad/heal_shape.h"
#include "geometry/cad/kernel.h"
#include "geometry/cad/loose_joints.h"
#include "geometry/cad/shape_projector.h"
#include "geometry/cad/tessellate.h"
#include "geometry/cad/weld_faces.h"
#include "geometry/surface/model_report.h"
#include "geometry/surface/surface_editor.h"

namespace delquad {

namespace cad {

namespace {

/// Last step of a projection, over the diagonal: a thousandth of the promised accuracy. Newton's method
/// converges linearly on surfaces with a singular parametrization.
constexpr double kProjection = 1e-12;
/// Distance, over the diagonal, within which faces lie on each other, as for sewn edges.
constexpr double kTouching = 1e-6;
/// Distance, over the diagonal, within which faces are near: a tenth of an edge of 1/20 of the diagonal.
constexpr double kNear = 1.0 / 200;

/// Returns the faces of each body or shell.
std::vector<std::vector<int>> faces_of(const TopTools_ListOfShape& some,
                                       const TopTools_IndexedMapOfShape& faces) {
  std::vector<std::vector<int>> all;
  for (const TopoDS_Shape& one : some) {
    std::vector<int>& of = all.emplace_back();
    const TopTools_IndexedMapOfShape own = parts(one, TopAbs_FACE);
    for (int f = 1; f <= own.Extent(); ++f) of.push_back(faces.FindIndex(own(f)) - 1);
  }
  return all;
}

TopTools_ListOfShape shells_of_solids(const TopoDS_Shape& shape) {
  TopTools_ListOfShape shells;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
    for (TopExp_Explorer shell(solid.Current(), TopAbs_SHELL); shell.More(); shell.Next())
      shells.Append(shell.Current());
  return shells;
}

/// Returns whether the faces of a group, and no others, share a name other than a color.
bool has_own_name(const Mesh& mesh, const std::vector<int>& group) {
  const auto has = [&](int face, const std::string& name) {
    return std::ranges::find(mesh.regions[face].names, name) != mesh.regions[face].names.end();
  };
  return std::ranges::any_of(mesh.regions[group[0]].names, [&](const std::string& name) {
    int holders = 0;
    for (int f = 0; f < static_cast<int>(mesh.regions.size()); ++f) holders += has(f, name);
    return !name.starts_with(kColourName) && holders == static_cast<int>(group.size()) &&
           std::ranges::all_of(group, [&](int f) { return has(f, name); });
  });
}

/// If there are several solids, names the nameless ones "solid 1", ... by their order in the file. Faces that
/// solids share have the names of both. `groups` has the faces of each body; solids come first.
void name_solids(const TopTools_ListOfShape& bodies, const std::vector<std::vector<int>>& groups,
                 Mesh& mesh) {
  const auto n_solids = std::count_if(bodies.begin(), bodies.end(), [](const TopoDS_Shape& body) {
    return body.ShapeType() == TopAbs_SOLID;
  });
  if (n_solids < 2) return;
  std::vector<char> named;
  for (int k = 0; k < n_solids; ++k) named.push_back(groups[k].empty() || has_own_name(mesh, groups[k]));
  for (int k = 0; k < n_solids; ++k) {
    const std::string name = fmt::format("solid {}", k + 1);
    for (const int f : groups[k])
      if (!named[k]) mesh.regions[f].names.push_back(name);
  }
}

/// Limit of places in messages.
constexpr std::size_t kMostPlaces = 20;

std::string title_of(const Mesh& mesh, int face) {
  return face_title(mesh.regions[face].tag, mesh.regions[face].names);
}

/// Returns "face 2 touches face 1 (lid) at (1, 0, 2); face 4 is 0.1 from face 3 at ...", up to kMostPlaces.
std::string list_joints(const Mesh& mesh, const std::vector<LooseJoint>& joints) {
  std::vector<std::string> all;
  for (const auto& [faces, at, distance] : joints)
    all.push_back(fmt::format("{} {} {} at {}", title_of(mesh, faces[0]),
                              distance > 0 ? fmt::format("is {:.3g} from", distance) : "touches",
                              title_of(mesh, faces[1]), show_point(at)));
  return first_of(all, kMostPlaces, "; ");
}

/// Warns of parts that nearly touch, whose meshes would not be joined.
void warn_of_near(SurfaceModel& model, std::vector<LooseJoint> contacts, double diagonal,
                  const std::function<double(const Vec3&)>& size) {
  constexpr double kPartOfSize = 0.1, kPartOfDiagonal = 1.0 / 50;
  std::vector<std::vector<Vec3>> corners(model.fine.regions.size());
  for (std::size_t t = 0; t < model.fine.triangles.size(); ++t)
    for (const int v : model.fine.triangles[t])
      corners[model.fine.triangle_region[t]].push_back(model.fine.points[v]);
  const auto length_of = [&](int face) { return norm(Box<Vec3>::around(corners[face]).size()); };
  // Contacts farther than a part of the smaller face or of the size do not count.
  std::erase_if(contacts, [&](const LooseJoint& c) {
    const double shorter = std::min(length_of(c.faces[0]), length_of(c.faces[1]));
    return c.distance > kPartOfSize * shorter ||
           c.distance > kPartOfSize * (size ? size(c.at) : kPartOfDiagonal * diagonal);
  });
  if (contacts.empty()) return;
  const double widest = std::ranges::max(contacts, {}, &LooseJoint::distance).distance;
  const double digit = std::pow(10, std::floor(std::log10(widest / diagonal)));
  model.warnings.push_back(fmt::format(
      "faces nearly touch at {} and stay apart: {}: move them together in CAD, or try --glue --weld {:.0e} "
      "(surface.glue, weld_tolerance: a part of the diagonal) [near-bodies]",
      counted(std::ssize(contacts), "place"), list_joints(model.fine, contacts),
      (std::floor(widest / diagonal / digit) + 1) * digit));
}

/// Warns of bodies that touch without common nodes, or throws InputError if they should be glued.
void check_joints(SurfaceModel& model, const CadShape& cad, const TopTools_IndexedMapOfShape& faces,
                  const CadOptions& options) {
  const auto [joints, near] =
      loose_joints(model, faces, faces_of(shells_of_solids(cad.shape), faces),
                   {options.deflection * cad.diagonal, kTouching * cad.diagonal, kNear * cad.diagonal});
  warn_of_near(model, near, cad.diagonal, options.size);
  if (joints.empty()) return;
  const std::string list = list_joints(model.fine, joints);
  if (options.glue)
    throw InputError(
        fmt::format("cannot be glued at {}: {}: expected faces that meet along edges or overlap [not-glued]",
                    counted(std::ssize(joints), "place"), list));
  model.warnings.push_back(
      fmt::format("faces touch at {} and share no nodes (--glue, surface.glue = true): {} [touching-bodies]",
                  counted(std::ssize(joints), "place"), list));
}

/// Throws InputError for common points that no node can join, as in fragmented shapes.
void refuse_joints_at_points(const Mesh& mesh, const TopTools_IndexedMapOfShape& faces) {
  const std::vector<LooseJoint> joints = joints_at_points(faces);
  if (!joints.empty())
    throw InputError(fmt::format(
        "faces share single points inside of them at {}: {}: expected faces that share edges, or corners of "
        "both. Bodies in files that share nothing are meshed apart [contact-at-a-point]",
        counted(std::ssize(joints), "place"), list_joints(mesh, joints)));
}

/// Splits embedded curves of one line, so that a patch can be opened between their ends.
void split_single_lines(SurfaceModel& model) {
  SurfaceEditor editor(model);
  const std::vector<int> curve_of = model.fine.line_curve;
  std::set<int> embedded;
  for (const EmbeddedCurve& e : model.embedded) embedded.insert(e.curve);
  for (const int curve : embedded) {
    const auto [first, last] = std::ranges::equal_range(curve_of, curve);
    if (last - first != 1) continue;
    const auto [a, b] = model.fine.lines[static_cast<std::size_t>(first - curve_of.begin())];
    const Vec3 middle = 0.5 * (model.fine.points[a] + model.fine.points[b]);
    editor.split_edge(a, b, model.projector->to_curve(curve, middle));
  }
  editor.finish();
}

void orient(SurfaceModel& model, const std::vector<std::vector<int>>& groups) {
  const Agreement agreement = agree_faces(model.fine);
  if (!agreement.orientable)
    model.warnings.push_back(
        "the faces cannot be oriented alike, as on a Moebius strip: normals jump on some curve");
  if (agreement.n_turned > 0) {
    model.warnings.push_back(fmt::format(
        "{} faces were oriented against their neighbors and were turned over", agreement.n_turned));
  }
  if (const int n = turn_outwards(model.fine, groups); n > 0) {
    model.warnings.push_back(fmt::format("{} bodies were inside out: their faces were turned over", n));
  }
}

/// Throws InputError with the faces that cannot be used, grouped by reason.
[[noreturn]] void refuse(const CadShape& cad, const TopTools_IndexedMapOfShape& faces,
                         const std::vector<std::string>& why_not) {
  std::vector<std::pair<std::string, std::string>> lists;
  for (int f = 0; f < faces.Extent(); ++f) {
    if (why_not[f].empty()) continue;
    const std::string title = face_title(f + 1, cad.names.of(faces(f + 1)));
    const auto at = std::ranges::find(lists, why_not[f], &std::pair<std::string, std::string>::first);
    if (at == lists.end())
      lists.emplace_back(why_not[f], title);
    else
      at->second += ", " + title;
  }
  std::string text;
  for (const auto& [reason, list] : lists) text += (text.empty() ? "" : "; ") + reason + ": " + list;
  throw InputError(text);
}

}  // namespace

TopTools_ListOfShape bodies_of(const TopoDS_Shape& shape) {
  TopTools_ListOfShape bodies;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) bodies.Append(solid.Current());
  for (TopExp_Explorer shell(shape, TopAbs_SHELL, TopAbs_SOLID); shell.More(); shell.Next())
    bodies.Append(shell.Current());
  for (TopExp_Explorer face(shape, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
    bodies.Append(face.Current());
  return bodies;
}

SurfaceModel model_of(const std::string& source, CadShape cad, const CadOptions& options) {
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE),
                                   edges = parts(cad.shape, TopAbs_EDGE);
  SurfaceModel model;
  std::vector<std::string> why_not;
  std::vector<FaceMesh> meshes = face_meshes(cad, faces, why_not);
  WeldedFaces welded = weld_usable(meshes, edges, options.deflection * cad.diagonal, why_not);
  for (int f = 0; f < faces.Extent(); ++f)
    if (!why_not[f].empty())
      model.left_out.push_back({f, face_title(f + 1, cad.names.of(faces(f + 1))) + ": " + why_not[f]});
  if (!model.left_out.empty() && (!options.keep_going || welded.mesh.triangles.empty()))
    refuse(cad, faces, why_not);
  if (welded.mesh.triangles.empty()) throw InputError("its faces have no area: nothing is left to mesh");
  for (const std::string& part : cad.missing) model.left_out.push_back({-1, part});

  model.source = source;
  model.warnings = std::move(cad.warnings);
  model.fine = std::move(welded.mesh);
  model.fine.unit = cad.unit;
  model.loose = std::move(cad.loose);
  for (LooseLine& line : model.loose) line.where = source + ": " + line.where;
  model.corners = std::move(welded.corners);
  for (int f = 0; f < faces.Extent(); ++f) model.fine.regions[f].names = cad.names.of(faces(f + 1));
  for (Entity& curve : model.fine.curves)
    if (curve.tag <= edges.Extent()) curve.names = cad.names.of(edges(curve.tag));
  model.embedded = std::move(welded.embedded);
  const TopTools_ListOfShape bodies = bodies_of(cad.shape);
  const std::vector<std::vector<int>> groups = faces_of(bodies, faces);
  name_solids(bodies, groups, model.fine);
  orient(model, groups);
  report_edges(model);
  model.projector = make_projector(std::move(meshes), welded.curves, kProjection * cad.diagonal);
  for (const auto& [point, face] : welded.inside)
    model.fine.points[point] = model.projector->to_face(face, model.fine.points[point]);
  if (!model.embedded.empty()) split_single_lines(model);
  check_joints(model, cad, faces, options);
  refuse_joints_at_points(model.fine, faces);
  return model;
}

SurfaceModel read_by_kernel(const CadModel& cad, const CadOptions& options) {
  const StageScope stage("reading");
  const std::string name = cad.file.empty() ? "CAD data" : cad.file.string();
  if (cad.file.empty() && cad.bytes.empty())
    throw InputError("a CAD model without a file and without bytes: expected one of them");
  try {
    return model_of(name, prepare_shape(cad, options), options);
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.starts_with(name)) throw;
    throw InputError(fmt::format("{}: {}", name, message));
  }
}

}  // namespace cad

}  // namespace delquad
