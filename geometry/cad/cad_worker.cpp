// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/cad_worker.h"

#include <fmt/format.h>

#include <BRepBndLib.hxx>
#include <BRepLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <OSD_Parallel.hxx>
#include <OSD_ThreadPool.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <exception>
#include <new>
#include <numeric>

#include "base/activity.h"
#include "base/context.h"
#include "base/parallel.h"
#include "base/utf8.h"
#include "base/worker_process.h"
#include "delquad/error.h"
#include "geometry/cad/cad_request.h"
#include "geometry/cad/cad_shape.h"
#include "geometry/cad/heal_shape.h"
#include "geometry/cad/mesh_by_outline.h"
#include "geometry/cad/shape_file.h"
#include "geometry/cad/tessellate.h"
#include "geometry/cad/weld_faces.h"

namespace delquad::cad {

namespace {

/// Largest distance of edges that bound no face from their chords, over the diagonal.
constexpr double kLooseDeflection = 1e-5;

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  // The box of the geometry, since an old triangulation may be wrong.
  BRepBndLib::Add(shape, box, /*useTriangulation=*/false);
  if (box.IsVoid() || box.IsOpen())
    throw InputError("the model has no extent or an infinite one: expected finite faces");
  const double diagonal = std::sqrt(box.SquareExtent());
  if (!(diagonal > 0) || Precision::IsInfinite(diagonal)) {
    throw InputError("the model has no extent or an infinite one: expected finite faces");
  }
  return diagonal;
}

/// Throws InputError unless each face has a surface, and a boundary or a finite surface.
void check_faces(const CadShape& cad, const TopTools_IndexedMapOfShape& faces) {
  if (faces.IsEmpty()) throw InputError("the model holds no face [no-face]");
  for (int f = 1; f <= faces.Extent(); ++f) {
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(TopoDS::Face(faces(f)));
    const std::string title = face_title(f, cad.names.of(faces(f)));
    if (surface.IsNull()) throw InputError(title + " has no surface [no-face]");
    double u0, u1, v0, v1;
    surface->Bounds(u0, u1, v0, v1);
    if (TopExp_Explorer(faces(f), TopAbs_EDGE).More()) continue;
    if (Precision::IsInfinite(u0) || Precision::IsInfinite(u1) || Precision::IsInfinite(v0) ||
        Precision::IsInfinite(v1)) {
      throw InputError(title + " has no boundary and its surface is infinite");
    }
  }
}

/// Computes missing curves in space from curves on surfaces. Throws InputError for an edge without either.
void complete_edges(const TopoDS_Shape& shape, const TopTools_IndexedMapOfShape& edges) {
  BRepLib::BuildCurves3d(shape);
  for (int e = 1; e <= edges.Extent(); ++e) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(e));
    double first, last;
    if (!BRep_Tool::Degenerated(edge) && BRep_Tool::Curve(edge, first, last).IsNull()) {
      throw InputError(fmt::format("edge {} has no curve", e));
    }
  }
}

void heal(CadShape& cad, const CadOptions& options) {
  const StageScope stage(kHealing);
  heal_shape(cad, options.weld * cad.diagonal);
  unwind_faces(cad);
}

/// Returns the faces (numbers) for which the kernel's mesher failed.
std::vector<int> without_triangles(const CadShape& cad, const TopTools_IndexedMapOfShape& faces, double gap) {
  std::vector<std::string> why_not;
  std::vector<FaceMesh> meshes = face_meshes(cad, faces, why_not);
  weld_usable(meshes, parts(cad.shape, TopAbs_EDGE), gap, why_not);
  std::vector<int> numbers;
  for (int f = 1; f <= faces.Extent(); ++f)
    if (!why_not[static_cast<std::size_t>(f) - 1].empty()) numbers.push_back(f);
  return numbers;
}

/// Triangulates wanted faces (numbers) from their outlines. Adds these and too coarse faces to the maps.
/// Returns the faces that failed.
std::vector<int> triangulate_by_outline(CadShape& cad, const std::vector<int>& wanted,
                                        const CadOptions& options, TopTools_IndexedMapOfShape& meshed,
                                        TopTools_IndexedMapOfShape& coarse) {
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  const OutlineMeshes result =
      mesh_by_outline(cad, faces, wanted, options.deflection * cad.diagonal, options.angle);
  for (const int f : result.meshed) meshed.Add(faces(f));
  for (const int f : result.coarse) coarse.Add(faces(f));
  cad.why_not.assign(static_cast<std::size_t>(faces.Extent()), "");
  std::vector<int> failed;
  for (const auto& [face, reason] : result.failed) {
    cad.why_not[static_cast<std::size_t>(face) - 1] = reason;
    failed.push_back(face);
  }
  return failed;
}

/// Triangulates faces by the kernel, and from their outlines if it fails.
void triangulate_faces(CadShape& cad, const CadOptions& options) {
  const double deflection = options.deflection * cad.diagonal;
  TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  std::vector<int> wanted(static_cast<std::size_t>(faces.Extent()));
  std::iota(wanted.begin(), wanted.end(), 1);
  if (!options.by_outline) {
    triangulate(cad, faces, deflection, options.angle);
    wanted = without_triangles(cad, faces, deflection);
  }
  if (wanted.empty()) return;
  TopTools_IndexedMapOfShape meshed, coarse;
  if (drop_strips(cad, triangulate_by_outline(cad, wanted, options, meshed, coarse))) {
    faces = parts(cad.shape, TopAbs_FACE);
    triangulate_by_outline(cad, without_triangles(cad, faces, deflection), options, meshed, coarse);
  }
  const auto titles = [&](const TopTools_IndexedMapOfShape& some) {
    std::vector<std::string> all;
    for (int f = 1; f <= faces.Extent(); ++f)
      if (some.Contains(faces(f))) all.push_back(face_title(f, cad.names.of(faces(f))));
    return fmt::format("{}", fmt::join(all, ", "));
  };
  if (const std::string names = titles(meshed); !options.by_outline && !names.empty())
    cad.warnings.push_back(
        "the CAD kernel could not triangulate all faces; triangulated from their outlines instead: " + names);
  if (const std::string names = titles(coarse); !names.empty())
    cad.warnings.push_back("triangulated more coarsely than asked for, which takes too many points: " +
                           names);
}

CadShape prepare(CadShape cad, const CadOptions& options) {
  check_faces(cad, parts(cad.shape, TopAbs_FACE));
  cad.diagonal = diagonal_of(cad.shape);
  cad.loose = loose_edges(cad, kLooseDeflection * cad.diagonal);
  drop_inner_edges(cad);
  heal(cad, options);
  if (options.glue) glue_shape(cad, options.weld * cad.diagonal);
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  check_faces(cad, faces);
  complete_edges(cad.shape, parts(cad.shape, TopAbs_EDGE));
  triangulate_faces(cad, options);
  return cad;
}

/// Sets the number of the kernel's own threads.
void set_kernel_threads() {
  OSD_Parallel::SetUseOcctThreads(true);
  OSD_ThreadPool::DefaultPool()->Init(thread_count());
}

CadShape read(const CadRequest& request) {
  switch (request.source) {
    case CadRequest::Source::kBytes:
      return read_shape_bytes(request.text, request.options);
    case CadRequest::Source::kShape:
      return from_bytes(request.text);
    case CadRequest::Source::kFile:
      break;
  }
  return read_shape(request.text, request.options);
}

/// Returns the message of the current exception.
std::string why_not() {
  try {
    throw;
  } catch (const Standard_Failure& failure) {
    return fmt::format("damaged: the CAD kernel gave up: {} {}", failure.DynamicType()->Name(),
                       failure.GetMessageString());
  } catch (const std::bad_alloc&) {
    return "damaged, or too large for the memory";
  } catch (const std::exception& error) {
    return error.what();
  }
}

void send(int socket, Reply reply, const std::string& text) {
  send_reply(socket, static_cast<char>(reply), text);
}

void answer(const CadRequest& request, int socket) {
  constexpr int kMostFaces = 1024;  // at a time: as many as threads
  Activities activities(kMostFaces);
  activities.on_stage = [socket](const char* name) { send(socket, Reply::kStage, name); };
  activities.on_face = [socket](int face, bool begins) {
    send(socket, begins ? Reply::kFaceBegins : Reply::kFaceEnds, std::to_string(face));
  };
  const RunScope run({.threads = request.threads, .activities = &activities});
  set_kernel_threads();
  send(socket, Reply::kShape, to_bytes(prepare(read(request), request.options)));
}

}  // namespace

void run_worker(int socket, int parent) {
  delquad::run_worker(
      socket, parent,
      [&](const std::string& bytes) {
        const CadRequest request = request_from(bytes);
        limit_to(request.seconds);
        answer(request, socket);
      },
      [] { return as_utf8(why_not()); });
}

}  // namespace delquad::cad
