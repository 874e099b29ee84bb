// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "io/cases/read_problem.h"
#include "mesher/prepare.h"

namespace delquad {

/// All that is prepared of a problem, the files of which are read first.
inline MeshingSetup prepare_case(const MeshProblem& problem) { return prepare_problem(read_files(problem)); }

}  // namespace delquad
