#pragma once

#include <exception>
#include <filesystem>
#include <string>

namespace delquad {

/// What is wrong with a file of results, for people, by what reading its JSON has thrown: "FILE:LINE:COLUMN:
/// WHAT: why" where it is no JSON, "FILE: WHAT: why" where another thing was expected in it. `what`: such as
/// "is no record of a cell"; empty: nothing is said there.
std::string json_problem(const std::filesystem::path& file, const std::string& what,
                         const std::exception& error);

}  // namespace delquad
