// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "base/worker_process.h"
#include "geometry/cad/cad_reader.h"

// This header has the messages between program and CAD worker. Geometry uses it.

namespace delquad::cad {

/// Returns the program that reads CAD files: from the variable DELQUAD_CAD_WORKER, else from
/// set_cad_worker(), else as find_program(), which may throw.
std::filesystem::path find_worker();
/// Returns the folder of set_cad_cache().
std::filesystem::path cache_folder();

/// The task of a worker: to read, heal and triangulate a shape.
struct CadRequest {
  enum class Source { kFile, kBytes, kShape };
  Source source = Source::kFile;
  std::string text;  ///< path, contents of a file, or a shape as in shape_file.h
  CadOptions options;
  int threads = 1;
  unsigned seconds = 0;  ///< limit of processor time, after which the worker ends
};

/// Stages that a worker reports (activity.h).
inline constexpr const char *kHealing = "healing", *kTriangulation = "triangulation";

/// Returns a request as bytes.
std::string to_bytes(const CadRequest& request);
/// Returns the request of such bytes. Throws InputError for bytes of another version of the program.
CadRequest request_from(const std::string& bytes);

/// The kinds of a worker's replies: the shape, a message, the name of a stage, or the number of a face that
/// begins or ends.
enum class Reply : char {
  kShape = 'S',
  kMessage = delquad::kMessage,
  kStage = 's',
  kFaceBegins = 'b',
  kFaceEnds = 'e'
};

}  // namespace delquad::cad
