// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace delquad::testing_support {

struct ProgramResult {
  int exit_code = -1;  ///< -1: ended by a signal; -2: had to be killed because it hung
  std::string out, err;
};

struct ProgramOptions {
  std::vector<std::string> arguments;
  long long file_size_limit = 0;  ///< bytes; 0: none
  /// Asked every 10 ms; the signal, Ctrl-C unless it says otherwise, is sent once, when it says yes.
  std::function<bool()> interrupt_when;
  int interrupt_by = SIGINT;
};

/// Runs a program; stdout and stderr are kept in `folder` meanwhile.
inline ProgramResult run_program(const std::string& program, const ProgramOptions& options) {
  constexpr auto kPatience = std::chrono::seconds(120);
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string(), err = (folder / "err").string();
  std::vector<std::string> words = {program};
  words.insert(words.end(), options.arguments.begin(), options.arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0) {
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    if (options.file_size_limit > 0) {
      const rlimit limit = {static_cast<rlim_t>(options.file_size_limit),
                            static_cast<rlim_t>(options.file_size_limit)};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    execv(argv[0], argv.data());
    _exit(127);
  }
  ProgramResult result;
  int status = 0;
  bool interrupted = false;
  for (const auto start = std::chrono::steady_clock::now(); waitpid(child, &status, WNOHANG) == 0;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (options.interrupt_when && !interrupted && options.interrupt_when()) {
      interrupted = true;
      kill(child, options.interrupt_by);
    }
    if (std::chrono::steady_clock::now() - start < kPatience) continue;
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    result.exit_code = -2;
    break;
  }
  if (result.exit_code != -2 && WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  result.out = read_text(out);
  result.err = read_text(err);
  return result;
}

#ifdef DELQUAD_PROGRAM
inline ProgramResult delquad(std::vector<std::string> arguments) {
  return run_program(DELQUAD_PROGRAM, {std::move(arguments), 0, {}});
}
#endif

}  // namespace delquad::testing_support
