#pragma once

#include <functional>
#include <optional>
#include <string>

namespace delquad::cad {

/// Does `work` in a child process, whose standard output and error are dropped, and returns its result;
/// nothing when the child crashes or computes for longer than `seconds`. `work` must not throw.
std::optional<std::string> run_apart(const std::function<std::string()>& work, unsigned seconds);

}  // namespace delquad::cad
