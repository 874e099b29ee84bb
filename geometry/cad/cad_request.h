// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "base/worker_process.h"
#include "geometry/cad/cad_reader.h"

// This header has the messages between program and CAD worker. Geometry uses it.

namespace delquad::cad {

/// Returns the program that works on CAD files: what DELQUAD_CAD_WORKER names, else what set_cad_worker() was
/// given, else see find_program().
std::filesystem::path find_worker();

/// The task of a worker: to read, heal and triangulate a shape.
struct CadRequest {
  enum class Source { kFile, kBytes, kShape };
  Source source = Source::kFile;
  std::string text;  ///< path, contents of a file, or a shape as in shape_file.h
  CadOptions options;
  int threads = 1;
  unsigned seconds = 0;  ///< of processor time, then the worker ends
};

/// Stages of a worker, as it tells them (activity.h).
inline constexpr const char *kHealing = "healing", *kTriangulation = "triangulation";

/// Turns a request into bytes, and back. Throws InputError for the bytes of a program of another version.
std::string to_bytes(const CadRequest& request);
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
