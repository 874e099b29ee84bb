#include "experiments/sweep/machine.h"

#include <fmt/chrono.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

namespace delquad {
namespace {

std::string cpu_model() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name"))
      if (const auto at = line.find(": "); at != line.npos) return line.substr(at + 2);
  return "";
}

}  // namespace

const Machine& this_machine() {
  static const Machine machine = [] {
    utsname names = {};
    uname(&names);
    return Machine{std::string(names.sysname) + " " + names.release, names.machine, cpu_model(),
                   std::thread::hardware_concurrency()};
  }();
  return machine;
}

MachineState machine_state() {
  MachineState state;
  state.time = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  double load = 0;
  if (getloadavg(&load, 1) == 1) state.load = load;
  return state;
}

}  // namespace delquad
