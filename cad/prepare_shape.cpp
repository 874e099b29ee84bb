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
#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>

#include "cad/child_process.h"
#include "cad/heal_shape.h"
#include "cad/shape_bytes.h"
#include "cad/shape_file.h"
#include "cad/tessellate.h"
#include "cad/unwind_faces.h"
#include "cad/watch_kernel.h"
#include "mesh/activity.h"
#include "mesh/error.h"
#include "mesh/parallel.h"

namespace delquad::cad {

namespace {

/// Free edges closer than this fraction of the diagonal are one; well above rounding, below any feature.
constexpr double kSewing = 1e-6;
/// Processor time granted: a hundred times what files need.
constexpr unsigned kSeconds = 60, kSecondsPerMegabyte = 60;

/// First byte of the child's answer: what follows it is the shape, a message, or the bytes of the numbers of
/// the faces that take too long.
constexpr char kShape = 'S', kMessage = 'M', kLateFaces = 'F', kLateHealing = 'H';
/// So many times the child begins anew, without what took too long.
constexpr int kMostTrials = 4;

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

/// What the child leaves out, having taken too long for it before.
struct Trial {
  bool heals = true;
  std::vector<int> late_faces;  ///< ascending
};

void heal(CadShape& cad, const CadOptions& options, bool heals, KernelWatch& watch) {
  if (!heals) {
    cad.warnings.push_back(
        fmt::format("checking and healing the shape takes longer than {:g} s: it is taken as it is",
                    options.healing_seconds));
    return;
  }
  const DoingStage stage(kHealing);
  const KernelWatch::Healing limited(watch);
  heal_shape(cad, kSewing * cad.diagonal);
  unwind_faces(cad);
}

CadShape prepare(CadShape cad, const CadOptions& options, const Trial& trial, KernelWatch& watch) {
  check_faces(cad, parts(cad.shape, TopAbs_FACE));
  cad.diagonal = diagonal_of(cad.shape);
  cad.late_faces = trial.late_faces;
  heal(cad, options, trial.heals, watch);
  const TopTools_IndexedMapOfShape faces = parts(cad.shape, TopAbs_FACE);
  check_faces(cad, faces);
  complete_edges(cad.shape, parts(cad.shape, TopAbs_EDGE));
  triangulate(cad, faces, options.deflection * cad.diagonal, options.angle);
  return cad;
}

/// The kernel's own threads, as many as parallel_for() has: those of oneTBB do not live on in a child.
void set_kernel_threads() {
  OSD_Parallel::SetUseOcctThreads(true);
  OSD_ThreadPool::DefaultPool()->Init(thread_count());
}

std::string answer(const std::function<CadShape()>& make, const CadOptions& options, const Trial& trial,
                   const Answer& now) {
  KernelWatch watch(
      {options.face_seconds, options.healing_seconds},
      [&](const std::vector<int>& late) {
        now(kLateFaces +
            std::string(reinterpret_cast<const char*>(late.data()), late.size() * sizeof late[0]));
      },
      [&] { now({kLateHealing}); });
  try {
    set_kernel_threads();
    return kShape + to_bytes(prepare(make(), options, trial, watch));
  } catch (const Standard_Failure& failure) {
    return kMessage + fmt::format("damaged: the CAD kernel gave up: {} {}", failure.DynamicType()->Name(),
                                  failure.GetMessageString());
  } catch (const std::bad_alloc&) {
    return kMessage + std::string("damaged, or too large for the memory");
  } catch (const std::exception& error) {
    return kMessage + std::string(error.what());
  }
}

/// The numbers that follow the first byte.
std::vector<int> numbers_in(const std::string& bytes) {
  std::vector<int> numbers((bytes.size() - 1) / sizeof(int));
  std::memcpy(numbers.data(), bytes.data() + 1, numbers.size() * sizeof(int));
  return numbers;
}

/// What the child was at when it ended without an answer.
std::string last_seen(const std::vector<FaceAtWork>& faces) {
  std::string text;
  for (const FaceAtWork& face : faces)
    text +=
        fmt::format("{}{} {}", text.empty() ? ": at the " + face.stage + " of " : ", ", face.kind, face.tag);
  return text;
}

CadShape prepare_apart(const std::function<CadShape()>& make, const CadOptions& options, unsigned seconds) {
  Trial trial;
  for (int n = 0; n < kMostTrials; ++n) {
    std::vector<FaceAtWork> faces;
    const auto bytes =
        run_apart([&](const Answer& now) { return answer(make, options, trial, now); }, seconds, &faces);
    if (!bytes || bytes->empty())
      throw InputError("damaged: the CAD kernel crashes or finds no end" + last_seen(faces));
    const std::vector<int> late = bytes->front() == kLateFaces ? numbers_in(*bytes) : std::vector<int>{};
    switch (bytes->front()) {
      case kMessage:
        throw InputError(bytes->substr(1));
      case kLateHealing:
        trial.heals = false;
        break;
      case kLateFaces:
        trial.late_faces.insert(trial.late_faces.end(), late.begin(), late.end());
        std::ranges::sort(trial.late_faces);
        break;
      default:
        CadShape cad = from_bytes(bytes->substr(1));
        cad.late_faces = trial.late_faces;
        return cad;
    }
  }
  throw InputError(
      fmt::format("cannot be triangulated: faces {}, ... take the CAD kernel longer than {:g} s each",
                  fmt::join(trial.late_faces, ", "), options.face_seconds));
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
