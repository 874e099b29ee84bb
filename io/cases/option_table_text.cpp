#include "io/cases/option_table_text.h"

#include <fmt/format.h>

#include "delquad/options.h"

namespace delquad {

std::string option_table_text() {
  std::string text = "| option | value | default | |\n|---|---|---|---|\n";
  for (const OptionGroup& group : option_groups())
    for (const OptionKey& key : group.keys)
      text += fmt::format("| `{}.{}` | {} | {} | {} |\n", group.name, key.name, expected_of(key),
                          key.absent.empty() ? text_of(key.value) : key.absent, key.help);
  return text;
}

}  // namespace delquad
