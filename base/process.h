// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>

// This header starts and ends processes. The program, the bench and readers of files use it.

namespace delquad {

/// Returns the number by which the system knows this process.
int process_number();

/// Both ends of a pipe, which started programs do not inherit and the caller closes. Throws std::system_error
/// if the system has no more.
struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe();
};

/// Lets the system send this new process a signal when its parent ends. Exits with code 1 if the parent, the
/// process of this number, has ended already.
void end_with_parent(int parent, int signal_number);
/// Waits for the end of a child. Returns its status as by waitpid(); -1: no such child.
int wait_for_end(int child);

/// Calls `work` in a forked process, which prints nothing. Returns its result; nothing if the process died,
/// as by `seconds` of its processor (0: no limit). Throws std::system_error if none can start.
/// `work` has one thread, and may not wait for others of this process.
std::optional<std::string> call_in_child(const std::function<std::string()>& work, unsigned seconds = 0);

/// Starts a program that prints nothing and outlives this process. A missing program is no error.
void start_detached(std::string program, std::string argument);

}  // namespace delquad
