#include "cad/prepare_shape.h"

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
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <exception>
#include <new>

#include "cad/child_process.h"
#include "cad/heal_shape.h"
#include "cad/shape_bytes.h"
#include "cad/shape_file.h"
#include "cad/tessellate.h"
#include "cad/unwind_faces.h"
#include "mesh/error.h"
#include "mesh/parallel.h"

namespace delquad::cad {

namespace {

/// Free edges closer than this fraction of the diagonal are one; well above rounding, below any feature.
constexpr double kSewing = 1e-6;
/// Processor time granted: a hundred times what files need.
constexpr unsigned kSeconds = 60, kSecondsPerMegabyte = 60;

/// First byte of the child's answer.
constexpr char kShape = 'S', kMessage = 'M';

TopTools_IndexedMapOfShape parts(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map;
}

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  // The geometry's own box: an old triangulation may lie.
  BRepBndLib::Add(shape, box, /*useTriangulation=*/false);
  if (box.IsVoid() || box.IsOpen()) throw InputError("the model has no extent, or an infinite one");
  const double diagonal = std::sqrt(box.SquareExtent());
  if (!(diagonal > 0) || Precision::IsInfinite(diagonal)) {
    throw InputError("the model has no extent, or an infinite one");
  }
  return diagonal;
}

/// A face needs a surface, and a boundary unless its surface ends by itself.
void check_faces(const CadShape& cad, const TopTools_IndexedMapOfShape& faces) {
  if (faces.IsEmpty()) throw InputError("the model holds no face");
  for (int f = 1; f <= faces.Extent(); ++f) {
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(TopoDS::Face(faces(f)));
    const std::string title = face_title(f, cad.names.of(faces(f)));
    if (surface.IsNull()) throw InputError(title + " has no surface");
    double u0, u1, v0, v1;
    surface->Bounds(u0, u1, v0, v1);
    if (TopExp_Explorer(faces(f), TopAbs_EDGE).More()) continue;
    if (Precision::IsInfinite(u0) || Precision::IsInfinite(u1) || Precision::IsInfinite(v0) ||
        Precision::IsInfinite(v1)) {
      throw InputError(title + " has no boundary and its surface is infinite");
    }
  }
}

/// Every edge must have a curve in space; those that have one on a surface only get it computed.
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

CadShape prepare(CadShape cad, const CadOptions& options) {
  check_faces(cad, parts(cad.shape, TopAbs_FACE));
  cad.diagonal = diagonal_of(cad.shape);
  heal_shape(cad, kSewing * cad.diagonal);
  unwind_faces(cad);
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  check_faces(cad, faces);
  complete_edges(cad.shape, parts(cad.shape, TopAbs_EDGE));
  triangulate(cad.shape, faces, options.deflection * cad.diagonal, options.angle);
  return cad;
}

/// The kernel's own threads, as many as parallel_for() has: those of oneTBB do not live on in a child.
void set_kernel_threads() {
  OSD_Parallel::SetUseOcctThreads(true);
  OSD_ThreadPool::DefaultPool()->Init(thread_count());
}

std::string answer(const std::function<CadShape()>& make, const CadOptions& options) {
  try {
    set_kernel_threads();
    return kShape + to_bytes(prepare(make(), options));
  } catch (const Standard_Failure& failure) {
    return kMessage + fmt::format("damaged: the CAD kernel gave up: {} {}", failure.DynamicType()->Name(),
                                  failure.GetMessageString());
  } catch (const std::bad_alloc&) {
    return kMessage + std::string("damaged, or too large for the memory");
  } catch (const std::exception& error) {
    return kMessage + std::string(error.what());
  }
}

CadShape prepare_apart(const std::function<CadShape()>& make, const CadOptions& options, unsigned seconds) {
  const auto bytes = run_apart([&] { return answer(make, options); }, seconds);
  if (!bytes || bytes->empty()) throw InputError("damaged: the CAD kernel crashes or finds no end");
  if (bytes->front() == kMessage) throw InputError(bytes->substr(1));
  return from_bytes(bytes->substr(1));
}

}  // namespace

CadShape prepare_shape(const std::filesystem::path& path, const CadOptions& options) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  const auto megabytes = unknown ? 0u : static_cast<unsigned>(size >> 20);
  return prepare_apart([&] { return read_shape(path); }, options, kSeconds + kSecondsPerMegabyte * megabytes);
}

CadShape prepare_shape(const std::function<CadShape()>& make, const CadOptions& options) {
  return prepare_apart(make, options, kSeconds);
}

}  // namespace delquad::cad

#ifdef __SANITIZE_ADDRESS__
/// The kernel keeps tables until the end of the program.
extern "C" const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() { return "leak:libTK\n"; }
#endif
