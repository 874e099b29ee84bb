#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh/activity.h"

namespace delquad::cad {

/// Hands a result back and ends the child, from any of its threads.
using Answer = std::function<void(const std::string& result)>;

/// Does `work` in a child process, whose standard output and error are dropped, and returns its result, or
/// what it answers before; nothing when the child crashes or computes for longer than `seconds`. `work` must
/// not throw. What the child is at (see activity.h) is seen here until it ends; `left` receives the faces
/// that it did not come to the end of.
std::optional<std::string> run_apart(const std::function<std::string(const Answer&)>& work, unsigned seconds,
                                     std::vector<FaceAtWork>* left = nullptr);

}  // namespace delquad::cad
