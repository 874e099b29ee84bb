// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

// This header runs the worker process that reads CAD. The program delquad-cad uses it.

namespace delquad::cad {

/// Returns the version of the OpenCASCADE that is at work here, such as "7.6.3".
std::string kernel_version();

/// Runs a worker process, which answers the one request that comes through the socket. On damaged files the
/// kernel crashes, follows broken references or runs in circles: nobody but this process suffers. It ends
/// when its parent, the process of this number, does.
[[noreturn]] void run_worker(int socket, int parent);

}  // namespace delquad::cad
