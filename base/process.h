#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

// Processes, as far as the standard library has none: see system.h.

namespace delquad {

int process_number();

/// Both ends of a pipe, which programs that are started do not inherit. Throws std::system_error.
struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe();
};

/// In a process just made: it gets this signal when its parent, the process of this number, ends, or has.
void end_with(int parent, int signal_number);
/// Waits for a child to end, and says how, as waitpid() does; -1: it is none.
int wait_for_end(int child);

/// Calls `work` in a child of this process, which prints nothing. Returns what it returned; nothing where the
/// child ended before. Throws std::system_error when there can be no child.
std::optional<std::string> call_apart(const std::function<std::string()>& work);

/// Starts a program that prints nothing and outlives this process. That there is none is no error.
void start_apart(std::string program, std::string argument);

}  // namespace delquad
