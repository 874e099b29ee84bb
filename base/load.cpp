#include "base/load.h"

namespace delquad {

void Load::advance() {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - until_).count();
  shares_.clock += seconds / threads_;
  if (threads_ == 1) shares_.alone += seconds;
  until_ = now;
}

void Load::change(int by) {
  const std::scoped_lock lock(mutex_);
  advance();
  threads_ += by;
}

Load::Shares Load::shares() {
  const std::scoped_lock lock(mutex_);
  advance();
  shares_.now = std::chrono::duration<double>(until_.time_since_epoch()).count();
  return shares_;
}

}  // namespace delquad
