// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

// This header runs the worker process that reads CAD. The program delquad-cad uses it.

namespace delquad::cad {

/// Returns the version of the loaded OpenCASCADE, such as "7.6.3".
std::string kernel_version();

/// Runs a worker process, which answers one request from the socket. A damaged file may crash or block the
/// kernel, and thus only this process. It ends with its parent, the process of this number.
[[noreturn]] void run_worker(int socket, int parent);

}  // namespace delquad::cad
