// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/draw_figures.h"

#include <fmt/format.h>

#include "base/find_program.h"
#include "base/located.h"
#include "base/system.h"
#include "base/text.h"
#include "delquad/error.h"
#include "experiments/sweep/run_program.h"

namespace delquad {

std::string draw_figures(const std::vector<std::filesystem::path>& folders) {
  constexpr int kNoMatplotlib = 3, kNoPython = 127;
  std::vector<std::string> words;
  try {
    words = {find_program({"delquad-figures", "tables of results", "DELQUAD_FIGURES"}).string()};
  } catch (const InputError& error) {
    return std::string("figures are not drawn: ") + error.what();
  }
  for (const auto& folder : folders) words.push_back(std::filesystem::absolute(folder).string());
  const TemporaryFolder scratch;
  const ProgramRun run = run_program(words, scratch.path(), scratch.path() / "log");
  if (run.error == 0 && run.exit_code() == 0) return "";
  std::string said(trimmed(file_bytes(scratch.path() / "log")));
  said = said.substr(said.rfind('\n') + 1);
  if (run.error == 0 && (run.exit_code() == kNoMatplotlib || run.exit_code() == kNoPython))
    return fmt::format(
        "figures are not drawn: {}: install python3-matplotlib, then call 'delquad tables' on the folder",
        said);
  refuse("figures are not drawn: {} {}: {}", words[0], how_it_ended(run), said);
}

}  // namespace delquad
