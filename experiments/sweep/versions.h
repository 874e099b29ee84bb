#pragma once

#include <string>
#include <utility>
#include <vector>

namespace delquad {

/// The program's own version ("delquad"), "commit", "build" and "compiler", then the libraries' by name.
std::vector<std::pair<std::string, std::string>> versions();

}  // namespace delquad
