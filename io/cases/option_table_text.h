#pragma once

#include <string>

namespace delquad {

/// The options of all stages as a table in Markdown: name, what it may be, default, what it is. Ends with a
/// newline.
std::string option_table_text();

}  // namespace delquad
