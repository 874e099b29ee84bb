#include "mesh/activity.h"

#include <pthread.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <utility>

namespace delquad {

namespace {

constexpr int kMostEntries = 2048;  // faces at a time: twice the most threads
constexpr int kMostTold = 4;        // faces in a text for people

constexpr std::int64_t kTick = 1'000'000'000;  // nanoseconds

std::int64_t read_clock(clockid_t clock) {
  timespec t = {};
  return clock_gettime(clock, &t) == 0 ? t.tv_sec * kTick + t.tv_nsec : 0;
}

double seconds_of(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) / kTick; }

struct Entry {
  std::atomic<pid_t> process{0};  ///< 0: free
  std::atomic<bool> filled{false};
  std::atomic<const char*> stage{nullptr}, kind{nullptr};
  std::atomic<int> tag{0};
  std::atomic<std::int64_t> since{0}, cpu_since{0};
  std::atomic<clockid_t> cpu_clock{0};
};
static_assert(std::atomic<const char*>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "signal handlers and other processes read them");

struct Registry {
  std::atomic<const char*> stage{nullptr};
  std::atomic<std::int64_t> since{0};
  std::array<Entry, kMostEntries> entries;
};

/// In memory that children share. Texts have the same addresses there.
Registry* new_registry() {
  void* memory = mmap(nullptr, sizeof(Registry), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return new (memory) Registry;
}

std::atomic<Registry*>& registry() {
  static std::atomic<Registry*> one = new_registry();
  return one;
}

/// Made before main(): a child shares only what was there before it.
[[maybe_unused]] const Registry* const made_early = registry();

thread_local int my_entry = -1;

std::atomic<const char*>& my_stage() {
  Registry& r = *registry();
  return my_entry < 0 ? r.stage : r.entries[static_cast<std::size_t>(my_entry)].stage;
}

/// -1: so many threads that this one is not told of.
int take_entry(Registry& r) {
  const pid_t process = getpid();
  for (int i = 0; i < kMostEntries; ++i) {
    pid_t free = 0;
    std::atomic<pid_t>& owner = r.entries[static_cast<std::size_t>(i)].process;
    if (owner.load(std::memory_order_relaxed) == 0 && owner.compare_exchange_strong(free, process)) return i;
  }
  return -1;
}

void release(Entry& entry) {
  entry.filled = false;
  entry.process = 0;
}

/// What an entry says, without its texts copied.
struct Seen {
  const char *stage, *kind;
  int tag;
  std::int64_t since;
};

bool look_at(const Entry& entry, Seen& seen) {
  if (!entry.filled.load(std::memory_order_acquire)) return false;
  seen = {entry.stage, entry.kind, entry.tag, entry.since};
  return seen.kind != nullptr;
}

/// Characters put together without memory of their own.
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
  /// " (4.2 s)"
  void add_age(std::int64_t since) {
    const std::int64_t tenths = (read_clock(CLOCK_MONOTONIC) - since) / (kTick / 10);
    add(" (");
    add(tenths / 10);
    add(".");
    add(tenths % 10);
    add(" s)");
  }
  std::size_t finish() {
    to_[n_] = 0;
    return n_;
  }

 private:
  char* to_;
  std::size_t room_, n_ = 0;
};

/// The entries that have been at their faces for longest, and how many there are.
int longest(const Registry& r, std::array<Seen, kMostTold>& first) {
  int n = 0;
  for (const Entry& entry : r.entries) {
    Seen seen;
    if (!look_at(entry, seen)) continue;
    int at = std::min(n, kMostTold);
    for (; at > 0 && first[static_cast<std::size_t>(at - 1)].since > seen.since; --at)
      if (at < kMostTold) first[static_cast<std::size_t>(at)] = first[static_cast<std::size_t>(at - 1)];
    if (at < kMostTold) first[static_cast<std::size_t>(at)] = seen;
    ++n;
  }
  return n;
}

void add_others(Text& text, int n) {
  if (n <= kMostTold) return;
  text.add(" and ");
  text.add(n - kMostTold);
  text.add(n - kMostTold == 1 ? " other" : " others");
}

}  // namespace

DoingStage::DoingStage(const char* name) : name_(my_stage()), before_(name_.exchange(name)) {
  if (my_entry < 0) registry().load()->since = read_clock(CLOCK_MONOTONIC);
}

DoingStage::~DoingStage() { name_ = before_; }

DoingFace::DoingFace(int tag, const char* kind) : entry_(-1), before_(my_entry) {
  Registry& r = *registry();
  entry_ = take_entry(r);
  if (entry_ < 0) return;
  Entry& entry = r.entries[static_cast<std::size_t>(entry_)];
  entry.stage = my_stage().load();
  entry.kind = kind;
  entry.tag = tag;
  entry.since = read_clock(CLOCK_MONOTONIC);
  clockid_t clock = CLOCK_THREAD_CPUTIME_ID;
  pthread_getcpuclockid(pthread_self(), &clock);
  entry.cpu_clock = clock;
  entry.cpu_since = read_clock(clock);
  entry.filled.store(true, std::memory_order_release);
  my_entry = entry_;
}

DoingFace::~DoingFace() {
  if (entry_ < 0) return;
  release(registry().load()->entries[static_cast<std::size_t>(entry_)]);
  my_entry = before_;
}

std::vector<FaceAtWork> faces_at_work() {
  std::vector<FaceAtWork> faces;
  const std::int64_t now = read_clock(CLOCK_MONOTONIC);
  for (const Entry& entry : registry().load()->entries) {
    Seen seen;
    if (!look_at(entry, seen)) continue;
    const bool is_ours = entry.process == getpid();
    const double cpu = is_ours ? seconds_of(read_clock(entry.cpu_clock) - entry.cpu_since) : 0;
    faces.push_back(
        {seen.stage != nullptr ? seen.stage : "", seen.kind, seen.tag, seconds_of(now - seen.since), cpu});
  }
  std::ranges::stable_sort(faces, std::ranges::greater{}, &FaceAtWork::seconds);
  return faces;
}

std::size_t describe_doing(char* text, std::size_t size) noexcept {
  const Registry& r = *registry();
  std::array<Seen, kMostTold> first;
  const int n = longest(r, first);
  Text out(text, size);
  if (n == 0) {
    const char* stage = r.stage;
    out.add(stage != nullptr ? stage : "starting");
    if (stage != nullptr) out.add_age(r.since);
  }
  const char* last = nullptr;
  for (int i = 0; i < std::min(n, kMostTold); ++i) {
    const Seen& seen = first[static_cast<std::size_t>(i)];
    if (i > 0) out.add(", ");
    if (seen.stage != nullptr && seen.stage != last) {
      out.add(seen.stage);
      out.add(" of ");
    }
    last = seen.stage;
    out.add(seen.kind);
    out.add(" ");
    out.add(seen.tag);
    out.add_age(seen.since);
  }
  add_others(out, n);
  return out.finish();
}

std::string doing() {
  char text[400];  // some faces with their stages
  return {text, describe_doing(text, sizeof text)};
}

std::string faces_doing() {
  std::array<Seen, kMostTold> first;
  const int n = longest(*registry(), first);
  char text[200];
  Text out(text, sizeof text);
  for (int i = 0; i < std::min(n, kMostTold); ++i) {
    if (i > 0) out.add(", ");
    out.add(first[static_cast<std::size_t>(i)].kind);
    out.add(" ");
    out.add(first[static_cast<std::size_t>(i)].tag);
  }
  add_others(out, n);
  return {text, out.finish()};
}

void start_own_activities() {
  registry() = new_registry();
  my_entry = -1;
}

void forget_activities(pid_t process) {
  for (Entry& entry : registry().load()->entries)
    if (entry.process == process) release(entry);
}

}  // namespace delquad
