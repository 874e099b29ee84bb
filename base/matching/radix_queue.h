#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace delquad {

/// Events in the order of their times, those of one time in the order in which they were pushed. Times are >=
/// 0 and never before the time of the last event popped: then an event moves at most once for each bit of its
/// time.
template <class Time>
class RadixQueue {
 public:
  struct Event {
    Time time;
    int node;
    int arc;
  };

  void push(Time time, int node, int arc) { put({time, node, arc}); }

  /// False when there is no event left.
  bool pop(Event& event) {
    std::vector<Event>& now = buckets_[0];
    if (next_ == now.size()) {
      now.clear();
      next_ = 0;
      if (!refill()) return false;
    }
    event = now[next_++];
    return true;
  }

  /// Drops all events and starts again at time zero.
  void reset() {
    for (int k = 0; k < kBuckets; ++k) buckets_[k].clear();
    for (std::uint64_t& word : used_) word = 0;
    next_ = 0;
    last_ = 0;
  }

 private:
  static constexpr int kBuckets = 8 * sizeof(Time) + 1;
  static constexpr int kWords = (kBuckets + 63) / 64;

  /// One more than the highest bit in which a time differs from the last one; 0 when it does not.
  static int bucket(Time difference) {
    if constexpr (sizeof(Time) > 8) {
      const auto high = static_cast<std::uint64_t>(difference >> 64);
      if (high != 0) return 64 + static_cast<int>(std::bit_width(high));
    }
    return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(difference)));
  }

  void put(const Event& event) {
    const int k = bucket(event.time ^ last_);
    buckets_[k].push_back(event);
    if (k > 0) used_[k / 64] |= std::uint64_t{1} << (k % 64);
  }

  /// Brings the events of the next time to bucket 0.
  bool refill() {
    for (int word = 0; word < kWords; ++word) {
      if (used_[word] == 0) continue;
      const int k = 64 * word + std::countr_zero(used_[word]);
      std::vector<Event>& events = buckets_[k];
      last_ = events[0].time;
      for (const Event& e : events) last_ = std::min(last_, e.time);
      for (const Event& e : events) put(e);  // each goes to a lower bucket
      events.clear();
      used_[word] &= ~(std::uint64_t{1} << (k % 64));
      return true;
    }
    return false;
  }

  std::vector<Event> buckets_[kBuckets];
  std::uint64_t used_[kWords] = {};
  std::size_t next_ = 0;
  Time last_ = 0;
};

}  // namespace delquad
