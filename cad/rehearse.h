#pragma once

#include <functional>

namespace delquad::cad {

/// Does `action` in a child process, whose output is dropped. False when the child crashes or takes longer
/// than `seconds`. The kernel's STEP reader follows broken references without looking.
bool rehearse(const std::function<void()>& action, unsigned seconds);

}  // namespace delquad::cad
