// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "algorithms/cleanup/cleanup.h"
#include "base/stopwatch.h"
#include "geometry/mesh/quad_blocks.h"

// This header runs an editing stage on blocks of a patch, in parallel. Stages C and Q use it.

namespace delquad {

/// Returns the mesh after an editing stage, with one process for each block. The summary, unless null, counts
/// irregular vertices before and after. Throws as the process does.
template <class Process, class Summary, class StageOptions>
QuadPatch edit_in_blocks(const QuadPatch& mesh, const ParametricSize& size, const StageOptions& options,
                         Summary* summary) {
  const Stopwatch watch;
  Summary total;
  QuadPatch result = work_in_blocks(mesh, total, [&](const QuadBlock& block, Summary& part) {
    Process process(block, size, options);
    process.run();
    part = process.summary();
    return process.result();
  });
  if (summary == nullptr) return result;
  *summary = total;
  summary->irregular_before = count_irregular(mesh);
  summary->irregular_after = count_irregular(result);
  summary->seconds = watch.seconds();
  return result;
}

}  // namespace delquad
