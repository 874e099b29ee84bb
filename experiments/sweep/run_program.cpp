// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/process.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "io/digest.h"
#include "metrics/tables/table.h"

namespace delquad {
namespace {

/// The watcher's report on the program.
struct Report {
  int error, status;
  rusage usage;
};

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

extern "C" void kill_group(int) { kill(0, SIGKILL); }

[[noreturn]] void exec_program(char* const* words, const char* folder, int log, int errors, int reports) {
  for (const int number : {SIGTERM, SIGALRM, SIGINT}) signal(number, SIG_DFL);
  if (dup2(open("/dev/null", O_RDONLY), STDIN_FILENO) >= 0 && dup2(log, STDOUT_FILENO) >= 0 &&
      dup2(errors, STDERR_FILENO) >= 0 && chdir(folder) == 0)
    execvp(words[0], words);
  const Report report = {errno, 0, {}};
  [[maybe_unused]] const ssize_t written = write(reports, &report, sizeof report);
  _exit(127);
}

/// Leads a group of processes, which ends as a whole: with the program, after `seconds`, or when the process
/// that wants the result dies.
[[noreturn]] void watch(char* const* words, const char* folder, int log, int errors, int reports,
                        pid_t parent, unsigned seconds) {
  setpgid(0, 0);
  signal(SIGTERM, kill_group);
  signal(SIGALRM, kill_group);
  signal(SIGINT, SIG_DFL);
  end_with_parent(parent, SIGTERM);
  alarm(seconds);
  const pid_t program = fork();
  if (program == 0) exec_program(words, folder, log, errors, reports);
  Report report = {program < 0 ? errno : 0, 0, {}};
  while (program > 0 && wait4(program, &report.status, 0, &report.usage) < 0 && errno == EINTR) {
  }
  [[maybe_unused]] const ssize_t written = write(reports, &report, sizeof report);
  kill(0, SIGKILL);
  _exit(0);
}

/// Made anew, and closed at the end.
class LogFile {
 public:
  explicit LogFile(const std::filesystem::path& path)
      : number_(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (number_ < 0) throw std::system_error(errno, std::generic_category(), path.string());
  }
  ~LogFile() { close(number_); }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

}  // namespace

int ProgramRun::exit_code() const { return WIFEXITED(status) ? WEXITSTATUS(status) : -1; }

std::string how_it_ended(const ProgramRun& run, const std::vector<int>& good) {
  if (run.error == ENOENT) return "not found: is it installed, and on the PATH?";
  if (run.error != 0) return std::string("cannot be run: ") + std::strerror(run.error);
  if (WIFSIGNALED(run.status))
    return "ended by signal " + std::to_string(WTERMSIG(run.status)) + " (" +
           strsignal(WTERMSIG(run.status)) + ")";
  const int code = run.exit_code();
  return std::ranges::find(good, code) == good.end() ? "ended with exit code " + std::to_string(code) : "";
}

ProgramRun run_program(const std::vector<std::string>& words, const std::filesystem::path& folder,
                       const std::filesystem::path& log, unsigned seconds,
                       const std::filesystem::path& errors) {
  const auto throw_errno = [&] { throw std::system_error(errno, std::generic_category(), words[0]); };
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const LogFile log_file(log);
  const LogFile errors_file(errors.empty() ? "/dev/null" : errors);
  const Pipe reports;
  const Stopwatch clock;
  const pid_t parent = getpid();
  std::fflush(stdout);
  const pid_t watcher = fork();
  if (watcher < 0) throw_errno();
  if (watcher == 0)
    watch(arguments.data(), folder.c_str(), log_file.number(),
          errors.empty() ? log_file.number() : errors_file.number(), reports.write_end, parent, seconds);
  close(reports.write_end);
  ProgramRun run;
  run.status = wait_for_end(watcher);
  run.seconds = clock.seconds();
  Report report;
  if (read(reports.read_end, &report, sizeof report) == sizeof report) {
    run.error = report.error;
    run.status = report.status;
    run.cpu_seconds = seconds_of(report.usage.ru_utime) + seconds_of(report.usage.ru_stime);
    run.peak_memory = 1024LL * report.usage.ru_maxrss;
  }
  close(reports.read_end);
  return run;
}

namespace fs = std::filesystem;

fs::path file_of_word(const fs::path& folder, const std::vector<std::string>& words, std::size_t i) {
  const std::string& word = words[i];
  if (i == 0 && word.find('/') == std::string::npos) return {};
  if (word.empty() || word.find('{') != std::string::npos) return {};
  std::error_code nothing_there;
  const fs::path file = fs::absolute(folder / word).lexically_normal();
  return fs::is_regular_file(file, nothing_there) ? file : fs::path();
}

std::vector<std::string> filled_in(const fs::path& folder, const std::vector<std::string>& words,
                                   const std::vector<Filling>& fillings) {
  std::vector<std::string> filled = words;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_path = words[i].find('/') != std::string::npos && words[i].find('{') == std::string::npos;
    if (const fs::path file = file_of_word(folder, words, i); !file.empty() || (i == 0 && is_path))
      filled[i] = fs::absolute(folder / words[i]).lexically_normal().string();
    for (const auto& [placeholder, text] : fillings)
      if (filled[i].find(placeholder) != std::string::npos)
        filled[i] = replace_all(filled[i], placeholder, text());
  }
  return filled;
}

std::vector<std::string> lines_printed(const fs::path& file) {
  constexpr std::size_t kLongestLine = 200;  // in a message
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    if (!trimmed(line).empty()) lines.push_back(line.substr(0, kLongestLine));
  return lines;
}

std::string complaint(const fs::path& file) {
  const std::vector<std::string> lines = lines_printed(file);
  const auto at = std::ranges::find_if(lines, [](const std::string& line) {
    return line[0] != ' ' && line.find("rror") != std::string::npos;
  });
  return lines.empty() ? "" : ": " + (at == lines.end() ? lines.back() : *at);
}

std::map<std::string, std::string> command_files(const fs::path& folder,
                                                 const std::vector<std::string>& words) {
  std::map<std::string, std::string> digests;
  for (std::size_t i = 0; i < words.size(); ++i)
    if (const fs::path file = file_of_word(folder, words, i); !file.empty())
      digests[words[i]] = file_digest(file);
  return digests;
}

}  // namespace delquad
