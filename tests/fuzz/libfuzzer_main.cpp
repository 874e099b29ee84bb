// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/target.h"

// A program of libFuzzer. The environment variable DELQUAD_FUZZ_TARGET says which of its targets it tries;
// a list of them is printed where it names none.

namespace {

using delquad::fuzz::Target;

Target chosen() {
  const std::vector<Target> targets = delquad::fuzz::DELQUAD_FUZZ_TARGETS();
  const char* name = std::getenv("DELQUAD_FUZZ_TARGET");
  const auto found = std::ranges::find(targets, std::string(name == nullptr ? "" : name), &Target::name);
  if (found != targets.end()) return *found;
  for (const Target& target : targets) std::puts(target.name.c_str());
  std::exit(EXIT_FAILURE);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Target target = chosen();
  target.try_input({reinterpret_cast<const char*>(data), size});
  return 0;
}
