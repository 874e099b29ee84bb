#pragma once

#include <string>
#include <utility>
#include <vector>

namespace delquad {

/// What a step took, in seconds. Of steps that follow or overlap each other, on one thread or many, `clock`
/// adds up to the time on the wall, and `alone` to that part of it which a further thread would not have
/// shortened.
struct TimeSpent {
  double work = 0;   ///< on the clock, of all threads that worked for it, added up
  double cpu = 0;    ///< processor time of these threads
  double clock = 0;  ///< on the clock: where N threads of the run are at work, each has an Nth of the time
  double alone = 0;  ///< of `clock`: while one thread was at work in the whole run
};

inline TimeSpent operator+(const TimeSpent& a, const TimeSpent& b) {
  return {a.work + b.work, a.cpu + b.cpu, a.clock + b.clock, a.alone + b.alone};
}
inline TimeSpent operator-(const TimeSpent& a, const TimeSpent& b) {
  return {a.work - b.work, a.cpu - b.cpu, a.clock - b.clock, a.alone - b.alone};
}

/// By step, in order of first use.
using StepTimes = std::vector<std::pair<std::string, TimeSpent>>;

}  // namespace delquad
