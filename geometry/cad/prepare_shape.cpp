// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/heal_shape.h"

#include <fmt/format.h>

#include <Standard.hxx>
#include <Standard_Version.hxx>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "base/activity.h"
#include "base/parallel.h"
#include "base/system.h"
#include "base/text.h"
#include "base/worker_process.h"
#include "delquad/error.h"
#include "geometry/cad/byte_archive.h"
#include "geometry/cad/cad_request.h"
#include "geometry/cad/cad_worker.h"
#include "geometry/cad/kept_shapes.h"
#include "geometry/cad/shape_file.h"

namespace delquad::cad {

namespace {

/// Limit of processor time, at least ten times the time for files of 24 models.
constexpr unsigned kSeconds = 15, kSecondsPerMegabyte = 60;

/// Reports the activity of a worker to the run of this thread.
class WorkersActivity {
 public:
  void on_reply(Reply reply, const std::string& text) {
    if (reply == Reply::kStage) {
      stage_.reset();
      for (const char* known : {kHealing, kTriangulation})
        if (text == known) stage_.emplace(known);
    }
    if (reply == Reply::kFaceBegins)
      faces_.emplace_back(text, std::make_unique<RemoteFaceScope>(std::stoi(text), kTriangulation));
    if (reply == Reply::kFaceEnds)
      if (const auto at = std::ranges::find(faces_, text, &Face::first); at != faces_.end()) faces_.erase(at);
  }
  /// Returns ": at the triangulation of face 7, face 9"; empty without a face.
  std::string text() const {
    std::string text;
    for (const auto& [face, face_scope] : faces_)
      text += fmt::format("{}face {}", text.empty() ? fmt::format(": at the {} of ", kTriangulation) : ", ",
                          face);
    return text;
  }

 private:
  using Face = std::pair<std::string, std::unique_ptr<RemoteFaceScope>>;
  std::optional<StageScope> stage_;
  std::vector<Face> faces_;  ///< faces in the order in which they began
};

/// Returns the last reply of a new worker. Throws InputError if there is none.
std::pair<Reply, std::string> ask_worker(const CadRequest& request) {
  std::optional<std::pair<Reply, std::string>> last;
  WorkersActivity activity;
  WorkerProcess worker(find_worker());
  worker.ask(to_bytes(request), [&](char kind, const std::string& text) {
    activity.on_reply(Reply{kind}, text);
    if (is_last(kind)) last.emplace(Reply{kind}, text);
  });
  if (!last)
    throw InputError("the CAD kernel crashes or does not end: expected an undamaged file" + activity.text() +
                     " [damaged-cad]");
  return *std::move(last);
}

/// Returns the prepared shape as bytes.
std::string ask_for_shape(const CadRequest& request) {
  auto [reply, text] = ask_worker(request);
  if (reply == Reply::kShape) return std::move(text);
  if (reply == Reply::kMessage) throw InputError(text);
  throw InputError(find_worker().string() + " is not the program that reads CAD files");
}

/// Returns all on which the prepared shape depends: content of the file, its name, options, and versions.
std::string question_of(CadRequest request) {
  const std::filesystem::path worker = find_worker();
  std::string question = fmt::format("{} {} {} {}\n", kernel_version(), worker.string(), file_size(worker),
                                     last_write_time(worker).time_since_epoch().count());
  if (request.source == CadRequest::Source::kFile) {
    const std::filesystem::path file = request.text;
    request.text = file.filename().string() + '\n' + file_bytes(file);
  }
  request.threads = 1;
  request.seconds = 0;
  return question + to_bytes(request);
}

CadShape prepare(const CadRequest& request) {
  const std::filesystem::path folder = cache_folder();
  return from_bytes(kept_or_asked(folder, folder.empty() ? "" : question_of(request),
                                  [&] { return ask_for_shape(request); }));
}

unsigned seconds_for(std::uintmax_t bytes) {
  return kSeconds + kSecondsPerMegabyte * static_cast<unsigned>(bytes >> 20);
}

}  // namespace

/// Takes the version from the file name "libTKernel.so.7.6.3", since the loaded library may differ from the
/// headers.
std::string kernel_version() {
  std::error_code unknown;
  const std::string file = std::filesystem::canonical(file_of(&Standard::Purge), unknown).filename().string();
  const std::string before = ".so.";
  const auto at = file.find(before);
  return at == std::string::npos ? OCC_VERSION_COMPLETE : file.substr(at + before.size());
}

CadShape prepare_shape(const CadModel& model, const CadOptions& options) {
  using Source = CadRequest::Source;
  if (model.file.empty())
    return prepare({Source::kBytes, model.bytes, options, thread_count(), seconds_for(model.bytes.size())});
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(model.file, unknown);
  return prepare({Source::kFile, model.file, options, thread_count(), seconds_for(unknown ? 0 : size)});
}

CadShape prepare_shape(const CadShape& shape, const CadOptions& options) {
  const std::string bytes = to_bytes(shape);
  return prepare({CadRequest::Source::kShape, bytes, options, thread_count(), seconds_for(bytes.size())});
}

}  // namespace delquad::cad

#ifdef __has_feature
#if __has_feature(address_sanitizer)  // Clang's word for it
#define __SANITIZE_ADDRESS__
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
/// The kernel keeps tables until the end of the program.
extern "C" const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() { return "leak:libTK\n"; }
#endif
