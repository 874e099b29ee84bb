#include "experiments/sweep/sweep_progress.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <new>
#include <string>

#include "experiments/console/progress.h"

namespace delquad {
namespace {

std::string clock_text(double seconds) {
  const auto s = static_cast<long long>(seconds + 0.5);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

SweepProgress::SweepProgress(std::size_t cells)
    : cells_(cells), shown_(isatty(STDERR_FILENO) != 0 && verbosity() != Verbosity::kQuiet) {
  void* memory = mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  counts_ = new (memory) Counts;
}

SweepProgress::~SweepProgress() {
  if (shown_) fmt::print(stderr, "\r\x1b[2K");
  munmap(counts_, sizeof(Counts));
}

void SweepProgress::found(std::size_t cells) {
  found_ += cells;
  counts_->done += cells;
}

void SweepProgress::draw() {
  if (!shown_ || cells_ == 0) return;
  constexpr std::size_t kWidth = 24;  // of the bar, in characters
  const std::size_t done = std::min<std::size_t>(counts_->done, cells_), failed = counts_->failed;
  const std::size_t filled = kWidth * done / cells_;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  std::string left;
  if (done > found_)
    left = ", about " +
           clock_text(elapsed * static_cast<double>(cells_ - done) / static_cast<double>(done - found_)) +
           " left";
  fmt::print(stderr, "\r\x1b[2K[{}{}] {}/{} cells{}{}", std::string(filled, '#'),
             std::string(kWidth - filled, '.'), done, cells_,
             failed > 0 ? fmt::format(", {} failed", failed) : "", left);
  std::fflush(stderr);
}

}  // namespace delquad
