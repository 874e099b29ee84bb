// SPDX-License-Identifier: GPL-3.0-or-later
#include <mutex>

#include "base/find_program.h"
#include "delquad/error.h"
#include "delquad/model.h"
#include "geometry/cad/cad_reader.h"
#include "geometry/cad/cad_request.h"

namespace delquad {

namespace {

/// The worker and the cache that the program has chosen for all its threads.
struct Chosen {
  std::mutex mutex;
  std::filesystem::path program, cache;
};
Chosen& chosen() {
  static Chosen one;
  return one;
}

}  // namespace

void set_cad_worker(const std::filesystem::path& program) {
  const std::lock_guard lock(chosen().mutex);
  chosen().program = program;
}

void set_cad_cache(const std::filesystem::path& folder) {
  const std::lock_guard lock(chosen().mutex);
  chosen().cache = folder;
}

std::filesystem::path cad::cache_folder() {
  const std::lock_guard lock(chosen().mutex);
  return chosen().cache;
}

std::filesystem::path cad::find_worker() {
  const std::lock_guard lock(chosen().mutex);
  return find_program({"delquad-cad", "CAD files", "DELQUAD_CAD_WORKER"}, chosen().program,
                      "set_cad_worker()");
}

std::filesystem::path cad_program() {
  try {
    return cad::find_worker();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace delquad
