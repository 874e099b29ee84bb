#pragma once

#include <string_view>

namespace delquad {

/// experiments/suite/models.toml, as it was when the program was built.
extern const std::string_view kSuiteText;

}  // namespace delquad
