// SPDX-License-Identifier: GPL-3.0-or-later
#include <pty.h>
#include <cerrno>

#include "experiments/console/interrupt.h"
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

/// Takes more than three seconds on any machine, nearly all of them in smoothing.
const Strings kLong = {"--size", "0.0025*(1+x)", "--pipeline", "DLLLLLLLLLLLL", "--threads", "1"};

Strings mesh_words(const Folder& folder, const Strings& more) {
  Strings words = {"mesh",   write_text(folder / "model.toml", kSquare),
                   "-o",     folder / "out.msh",
                   "--json", folder / "out.json"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(StageTimes, NameTheLongestStageUnlessItIsTheLast) {
  StageTimes times;
  EXPECT_EQ(times.longest(9), "") << "no stage has begun";
  times.begin("boundary", 10);
  times.begin("lifting", 50);
  EXPECT_EQ(times.longest(58), "; boundary took longest: 40.0 s");
  times.begin("boundary", 60);
  EXPECT_EQ(times.longest(61), "");
  times.begin("lifting", 62);
  EXPECT_EQ(times.longest(94), "; boundary took longest: 42.0 s");
  EXPECT_EQ(times.longest(95), "");
}

struct Ending {
  int signal_number, exit_code;
};
class Signals : public testing::TestWithParam<Ending> {};

TEST_P(Signals, EndTheRunWithoutAFile) {
  const Folder folder;
  ProgramOptions options{mesh_words(folder, kLong), 0, {}, GetParam().signal_number};
  int asked = 0;
  options.interrupt_when = [&] { return ++asked > 50; };  // half a second
  const ProgramResult result = run_program(DELQUAD_PROGRAM, options);
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.err;
  EXPECT_EQ(folder.names(), Strings{"model.toml"});
}
INSTANTIATE_TEST_SUITE_P(Of, Signals, testing::Values(Ending{SIGINT, 130}, Ending{SIGTERM, 143}),
                         [](const auto& ending) { return std::to_string(ending.param.exit_code); });

/// A file that is being written then is written to its end.
TEST(Signals, WhileAFileIsWritten) {
  const Folder folder;
  const auto is_temporary = [&] {
    return std::ranges::any_of(folder.names(),
                               [](const std::string& name) { return name.ends_with(".tmp"); });
  };
  ProgramOptions options{{"mesh", write_text(folder / "model.toml", kSquare), "-o", folder / "out.msh",
                          "--size", "0.003", "--pipeline", "D"},
                         0,
                         is_temporary,
                         SIGTERM};
  const ProgramResult result = run_program(DELQUAD_PROGRAM, options);
  EXPECT_EQ(result.exit_code, 143) << result.err;
  EXPECT_EQ(folder.names(), (Strings{"model.toml", "out.msh"}));
}

TEST(Progress, NamesTheFaceOnATerminal) {
  const Folder folder;
  auto words = mesh_words(folder, kLong);
  words.insert(words.begin(), DELQUAD_PROGRAM);
  words.insert(words.end(), {"--time-limit", "1.5"});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    execv(argv[0], argv.data());
    _exit(127);
  }
  if (child < 0) GTEST_SKIP() << "no terminal can be opened on this machine: " << std::strerror(errno);
  std::string text;
  char part[4096];
  for (ssize_t n = 0; (n = read(terminal, part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(n));
  close(terminal);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(holds(text, "model DLLLLLLLLLLLL: Lp-CVT smoothing, region 1"));
}

}  // namespace
}  // namespace delquad::testing_support
