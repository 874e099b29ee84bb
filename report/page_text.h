#pragma once

#include <string_view>

namespace delquad {

/// The parts of the page that are the same for all results, from report/page/ and report/three/.
extern const std::string_view kPageStyle, kPageBody, kPageScript, kThreeScript;

}  // namespace delquad
