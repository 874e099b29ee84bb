// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/activity.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>

#include "base/run.h"
#include "base/system.h"

namespace delquad {

/// Content of an entry, without copies of its texts.
struct FaceSnapshot {
  const char *stage, *kind;
  int tag;
  long long since;
};

namespace {

constexpr std::size_t kMostListed = 4;  // faces in a text for people

constexpr long long kNanosecondsPerSecond = 1'000'000'000;

long long ticks() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double seconds_of(long long nanoseconds) { return static_cast<double>(nanoseconds) / kNanosecondsPerSecond; }

/// Text in a given buffer, without allocation.
class Text {
 public:
  Text(char* to, std::size_t size) : to_(to), room_(size > 0 ? size - 1 : 0) {}
  void add(const char* text) {
    while (*text != 0 && n_ < room_) to_[n_++] = *text++;
  }
  void add(std::int64_t number) {
    char digits[24];
    std::size_t k = sizeof digits;
    digits[--k] = 0;
    const bool negative = number < 0;
    std::uint64_t rest =
        negative ? 0 - static_cast<std::uint64_t>(number) : static_cast<std::uint64_t>(number);
    do digits[--k] = static_cast<char>('0' + rest % 10);
    while ((rest /= 10) > 0);
    if (negative) digits[--k] = '-';
    add(digits + k);
  }
  /// Adds " (4.2 s)".
  void add_age(long long since) {
    const std::int64_t tenths = (ticks() - since) / (kNanosecondsPerSecond / 10);
    add(" (");
    add(tenths / 10);
    add(".");
    add(tenths % 10);
    add(" s)");
  }
  /// Adds the number of faces after the first few of `n`.
  void add_others(int n) {
    const int others = n - static_cast<int>(kMostListed);
    if (others <= 0) return;
    add(" and ");
    add(std::int64_t{others});
    add(others == 1 ? " other" : " others");
  }
  std::size_t finish() {
    to_[n_] = 0;
    return n_;
  }

 private:
  char* to_;
  std::size_t room_, n_ = 0;
};

}  // namespace

struct Activities::Entry {
  std::atomic<bool> taken{false}, filled{false};
  std::atomic<const char*> stage{nullptr}, kind{nullptr};
  std::atomic<int> tag{0};
  std::atomic<long long> since{0}, cpu_since{0};
  std::atomic<ThreadClock> cpu_clock{0};
  std::atomic<bool> is_elsewhere{false};

  bool look(FaceSnapshot& seen) const {
    if (!filled.load(std::memory_order_acquire)) return false;
    seen = {stage, kind, tag, since};
    return seen.kind != nullptr;
  }
};
static_assert(std::atomic<const char*>::is_always_lock_free && std::atomic<long long>::is_always_lock_free,
              "signal handlers read them");

Activities::Activities(int most_faces) : entries_(static_cast<std::size_t>(std::max(most_faces, 1))) {}
Activities::~Activities() = default;

/// Returns -1 if the limit of faces is reached.
int Activities::take_entry(int tag, const char* kind, const char* stage, bool is_of_this_thread) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    bool free = false;
    if (entry.taken.load(std::memory_order_relaxed) || !entry.taken.compare_exchange_strong(free, true))
      continue;
    entry.stage = stage;
    entry.kind = kind;
    entry.tag = tag;
    entry.since = ticks();
    entry.is_elsewhere = !is_of_this_thread;
    entry.cpu_clock = clock_of_this_thread();
    entry.cpu_since = nanoseconds_of_this_thread();
    entry.filled.store(true, std::memory_order_release);
    return static_cast<int>(i);
  }
  return -1;
}

void Activities::release(int i) {
  Entry& entry = entries_[static_cast<std::size_t>(i)];
  entry.filled = false;
  entry.taken = false;
}

/// Writes up to `most` faces that have been at work longest. Returns the number of all faces.
int Activities::longest(std::size_t most, FaceSnapshot* first) const {
  std::size_t n = 0;
  for (const Entry& entry : entries_) {
    FaceSnapshot seen;
    if (!entry.look(seen)) continue;
    std::size_t at = std::min(n, most);
    for (; at > 0 && first[at - 1].since > seen.since; --at)
      if (at < most) first[at] = first[at - 1];
    if (at < most) first[at] = seen;
    ++n;
  }
  return static_cast<int>(n);
}

std::vector<ActiveFace> Activities::faces() const {
  std::vector<ActiveFace> faces;
  const long long at = ticks();
  for (const Entry& entry : entries_) {
    FaceSnapshot seen;
    if (!entry.look(seen)) continue;
    const double cpu = entry.is_elsewhere ? 0 : seconds_of(nanoseconds_of(entry.cpu_clock) - entry.cpu_since);
    faces.push_back(
        {seen.stage != nullptr ? seen.stage : "", seen.kind, seen.tag, seconds_of(at - seen.since), cpu});
  }
  std::ranges::stable_sort(faces, std::ranges::greater{}, &ActiveFace::seconds);
  return faces;
}

std::size_t Activities::describe(char* text, std::size_t size) const noexcept {
  std::array<FaceSnapshot, kMostListed> first;
  const int n = longest(kMostListed, first.data());
  Text out(text, size);
  if (n == 0) {
    const char* stage = stage_;
    out.add(stage != nullptr ? stage : "starting");
    if (stage != nullptr) out.add_age(since_);
  }
  const char* last = nullptr;
  for (std::size_t i = 0; i < std::min(static_cast<std::size_t>(n), kMostListed); ++i) {
    const FaceSnapshot& seen = first[i];
    if (i > 0) out.add(", ");
    if (seen.stage != nullptr && seen.stage != last) {
      out.add(seen.stage);
      out.add(" of ");
    }
    last = seen.stage;
    out.add(seen.kind);
    out.add(" ");
    out.add(std::int64_t{seen.tag});
    out.add_age(seen.since);
  }
  out.add_others(n);
  return out.finish();
}

std::string Activities::text() const {
  char text[400];  // some faces with their stages
  return {text, describe(text, sizeof text)};
}

std::string Activities::faces_text() const {
  std::array<FaceSnapshot, kMostListed> first;
  const int n = longest(kMostListed, first.data());
  char text[200];
  Text out(text, sizeof text);
  for (std::size_t i = 0; i < std::min(static_cast<std::size_t>(n), kMostListed); ++i) {
    if (i > 0) out.add(", ");
    out.add(first[i].kind);
    out.add(" ");
    out.add(std::int64_t{first[i].tag});
  }
  out.add_others(n);
  return {text, out.finish()};
}

std::string Activities::stage() const {
  const char* stage = stage_;
  return stage != nullptr ? stage : "";
}

void Activities::clear() {
  stage_ = nullptr;
  for (std::size_t i = 0; i < entries_.size(); ++i) release(static_cast<int>(i));
}

StageScope::StageScope(const char* name) : name_(nullptr) {
  Activities* activities = current_activities();
  if (activities == nullptr) return;
  const int entry = this_thread().entry;
  name_ = entry < 0 ? &activities->stage_ : &activities->entries_[static_cast<std::size_t>(entry)].stage;
  before_ = name_->exchange(name);
  if (entry >= 0) return;
  activities->since_ = ticks();
  if (activities->on_stage) activities->on_stage(name);
}

StageScope::~StageScope() {
  if (name_ != nullptr) *name_ = before_;
}

FaceScope::FaceScope(int tag, const char* kind) : activities_(current_activities()), tag_(tag) {
  if (activities_ == nullptr) return;
  ThreadState& thread = this_thread();
  const char* stage = thread.entry < 0
                          ? activities_->stage_.load()
                          : activities_->entries_[static_cast<std::size_t>(thread.entry)].stage.load();
  before_ = thread.entry;
  entry_ = activities_->take_entry(tag, kind, stage, true);
  if (entry_ >= 0) thread.entry = entry_;
  if (activities_->on_face) activities_->on_face(tag, true);
}

FaceScope::~FaceScope() {
  if (activities_ == nullptr) return;
  if (entry_ >= 0) {
    activities_->release(entry_);
    this_thread().entry = before_;
  }
  if (activities_->on_face) activities_->on_face(tag_, false);
}

RemoteFaceScope::RemoteFaceScope(int tag, const char* stage) : activities_(current_activities()) {
  if (activities_ != nullptr) entry_ = activities_->take_entry(tag, "face", stage, false);
}

RemoteFaceScope::~RemoteFaceScope() {
  if (entry_ >= 0) activities_->release(entry_);
}

}  // namespace delquad
