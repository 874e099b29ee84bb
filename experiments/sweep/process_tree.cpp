// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/process_tree.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include "base/parallel.h"
#include "base/process.h"
#include "experiments/console/interrupt.h"
#include "experiments/sweep/peer.h"

namespace delquad {
namespace {

constexpr int kTick = 200;                    // milliseconds
constexpr std::size_t kLongestReport = 4000;  // fits a pipe, so that nobody waits for a reader

[[noreturn]] void throw_errno(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// As many tokens as processes may work at the same time. A process that starts another one passes its own
/// token on, or takes one from a pipe that the whole tree shares. It gets the token back when that process
/// ends.
class Tokens {
 public:
  explicit Tokens(int n) {
    for (int i = 0; i < n; ++i) release();
  }
  ~Tokens() {
    close(pipe_.read_end);
    close(pipe_.write_end);
  }
  Tokens(const Tokens&) = delete;
  Tokens& operator=(const Tokens&) = delete;
  int fd() const { return pipe_.read_end; }
  bool take() const {
    // Others may have been faster since poll() spoke.
    pollfd entry{pipe_.read_end, POLLIN, 0};
    char token;
    return poll(&entry, 1, 0) == 1 && read(pipe_.read_end, &token, 1) == 1;
  }
  void release() const {
    const char token = 0;
    if (write(pipe_.write_end, &token, 1) != 1) throw_errno("pipe");
  }

 private:
  Pipe pipe_;
};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// SIGALRM after so many seconds; 0: never.
void set_alarm(double seconds) {
  itimerval timer = {};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - std::floor(seconds)) * 1e6);
  setitimer(ITIMER_REAL, &timer, nullptr);
}

std::string bytes_text(long long bytes) {
  return fmt::format("{:.3g} GiB", static_cast<double>(bytes) / (1LL << 30));
}

/// Data for the handler of a process whose time is up.
struct TimeIsUp {
  int report = -1;
  char text[200] = {};  ///< "timeout", a line break and what to say
} time_is_up;

/// Says where the process is, and ends it.
extern "C" void report_timeout(int) {
  char text[600];
  std::size_t n = std::strlen(std::strcpy(text, time_is_up.text));
  n += program_activities().describe(text + n, sizeof text - n);
  [[maybe_unused]] const ssize_t written = write(time_is_up.report, text, n);
  _exit(1);
}

/// From now on SIGALRM is report_timeout().
void report_timeouts(double seconds, int report) {
  time_is_up.report = report;
  const auto end = fmt::format_to_n(time_is_up.text, sizeof time_is_up.text - 1,
                                    "timeout\nstopped after {:g} s (--timeout): ", seconds);
  *end.out = 0;
  signal(SIGALRM, report_timeout);
}

/// The processes that one process has started.
class ChildProcesses {
 public:
  ChildProcesses(const ProcessLimits& limits, const Tokens& tokens, double spent)
      : limits_(limits), tokens_(tokens), spent_(spent) {}

  /// Runs all jobs, on this process's own token and what others can be had.
  void run(const std::function<std::optional<Job>()>& next_job, const std::function<void()>& tick) {
    while (std::optional<Job> job = next_job()) {
      while (!own_token_free_ && !borrow()) wait(true, tick);
      start(std::move(*job));
    }
    while (!children_.empty()) wait(false, tick);
  }

 private:
  struct Child {
    pid_t pid;
    int report;  ///< what it says of its failure; at its end when the process and what it started have ended
    bool borrowed;
    Job job;
  };

  bool borrow() { return borrowed_ = tokens_.take(); }

  void start(Job job) {
    const Pipe report;
    const pid_t parent = getpid();
    std::fflush(stdout);
    finish_threads();
    const pid_t pid = fork();
    if (pid < 0) throw_errno("fork");
    if (pid == 0) run_child(job, report.write_end, parent);
    close(report.write_end);
    children_.push_back({pid, report.read_end, std::exchange(borrowed_, false), std::move(job)});
    if (!children_.back().borrowed) own_token_free_ = false;
  }

  /// In the new process.
  [[noreturn]] void run_child(const Job& job, int report, pid_t parent) {
    end_with_parent(parent, SIGKILL);
    for (const int signal_number : {SIGINT, SIGTERM}) signal(signal_number, SIG_DFL);
    program_activities().clear();  // the streams of the parent
    if (limits_.seconds > 0) report_timeouts(limits_.seconds, report);
    if (limits_.bytes > 0) {
      const rlimit limit = {static_cast<rlim_t>(limits_.bytes), static_cast<rlim_t>(limits_.bytes)};
      setrlimit(RLIMIT_DATA, &limit);
    }
    const auto fail = [&](const char* kind, const std::string& reason) {
      const std::string text = (std::string(kind) + '\n' + reason).substr(0, kLongestReport);
      [[maybe_unused]] const ssize_t written = write(report, text.data(), text.size());
      _exit(1);
    };
    try {
      const double start = now();
      // A limit that the work before has used up is noticed at once.
      if (limits_.seconds > 0) set_alarm(std::max(1e-3, limits_.seconds - spent_));
      job.work();
      set_alarm(0);
      if (job.next) {
        std::vector<Job> jobs = job.next();
        std::size_t k = 0;
        ChildProcesses(limits_, tokens_, spent_ + now() - start)
            .run([&] { return k < jobs.size() ? std::optional(std::move(jobs[k++])) : std::nullopt; }, {});
      }
    } catch (const InputError& error) {
      fail("bad input", error.what());
    } catch (const UnsoundError& error) {
      fail("unsound", error.what());
    } catch (const NotApplicable& error) {
      fail(kNotApplicable, error.what());
    } catch (const PeerError& error) {
      fail("peer", error.what());
    } catch (const JobFailed& error) {
      fail(error.kind().c_str(), error.what());
    } catch (const std::bad_alloc&) {
      fail("memory", limits_.bytes > 0
                         ? "out of memory: more than " + bytes_text(limits_.bytes) + " (--memory)"
                         : "out of memory");
    } catch (const std::exception& error) {
      fail("internal error", std::string("internal error: ") + error.what());
    }
    _exit(0);
  }

  /// Until a process ends, a token can be had (if one is wanted) or a moment has passed.
  void wait(bool for_token, const std::function<void()>& tick) {
    std::vector<pollfd> entries;
    for (const Child& child : children_) entries.push_back({child.report, POLLIN, 0});
    if (for_token) entries.push_back({tokens_.fd(), POLLIN, 0});
    if (poll(entries.data(), entries.size(), tick ? kTick : -1) < 0 && errno != EINTR) throw_errno("poll");
    for (std::size_t i = children_.size(); i-- > 0;)
      if (entries[i].revents != 0) reap_child(i);
    if (tick) tick();
  }

  void reap_child(std::size_t i) {
    Child child = std::move(children_[i]);
    children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(i));
    const int status = wait_for_end(child.pid);
    std::string report(kLongestReport, '\0');
    const ssize_t length = read(child.report, report.data(), report.size());
    report.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
    close(child.report);
    if (child.borrowed)
      tokens_.release();
    else
      own_token_free_ = true;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) child.job.failed(failure(status, report));
  }

  ProcessFailure failure(int status, const std::string& report) const {
    if (const auto line = report.find('\n'); line != std::string::npos)
      return {report.substr(0, line), report.substr(line + 1)};
    if (!WIFSIGNALED(status)) return {"crash", fmt::format("ended with exit code {}", WEXITSTATUS(status))};
    const int number = WTERMSIG(status);
    if (number == SIGTERM || number == SIGINT || number == SIGHUP)
      return {"interrupted", fmt::format("interrupted from outside ({})", strsignal(number))};
    return {"crash", fmt::format("ended by signal {} ({}){}", number, strsignal(number),
                                 number == SIGKILL ? ": perhaps the machine ran out of memory" : "")};
  }

  const ProcessLimits& limits_;
  const Tokens& tokens_;
  double spent_;  ///< seconds that the work before this took
  bool own_token_free_ = true, borrowed_ = false;
  std::vector<Child> children_;
};

}  // namespace

void run_jobs(const std::function<std::optional<Job>()>& next_job, const ProcessLimits& limits,
              const std::function<void()>& tick) {
  const Tokens tokens(limits.jobs - 1);
  ChildProcesses(limits, tokens, 0).run(next_job, tick);
}

}  // namespace delquad
