#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace delquad {

/// Items that go by numbers, which several threads may make and drop at once. An item stays where it is, and
/// belongs to whoever made it; what is dropped is used again. Which number an item gets depends on the
/// threads: nothing else may depend on it.
template <class Item>
class SharedPool {
 public:
  /// At most this many items live at any time.
  explicit SharedPool(std::size_t most) : chunks_(most / kChunk + 1) {}

  Item& operator[](int i) { return chunks_[static_cast<std::size_t>(i) / kChunk][i % kChunk]; }
  const Item& operator[](int i) const { return chunks_[static_cast<std::size_t>(i) / kChunk][i % kChunk]; }

  int make() {
    const std::lock_guard lock(mutex_);
    if (!unused_.empty()) {
      const int i = unused_.back();
      unused_.pop_back();
      return i;
    }
    auto& chunk = chunks_[static_cast<std::size_t>(made_) / kChunk];
    if (!chunk) chunk = std::make_unique<Item[]>(kChunk);
    return made_++;
  }

  void drop(int i) {
    const std::lock_guard lock(mutex_);
    unused_.push_back(i);
  }

 private:
  static constexpr int kChunk = 1024;
  std::vector<std::unique_ptr<Item[]>> chunks_;
  std::vector<int> unused_;
  int made_ = 0;
  std::mutex mutex_;
};

}  // namespace delquad
