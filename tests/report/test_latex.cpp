#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/report/report_results.h"

namespace delquad::testing_support {
namespace {

namespace fs = std::filesystem;

bool has_latex() {
  return std::system("kpsewhich booktabs.sty >/dev/null 2>&1 && command -v pdflatex >/dev/null") == 0;
}

/// Where LaTeX finds nothing to complain of, "" and a PDF; else what it said.
std::string compile(const fs::path& folder, const std::string& name) {
  const ProgramResult result = run_program(
      "/bin/sh",
      {{"-c", "cd '" + folder.string() + "' && pdflatex -interaction=nonstopmode -halt-on-error " + name},
       0,
       {}});
  return result.exit_code == 0 && fs::exists(folder / (fs::path(name).stem().string() + ".pdf")) ? ""
                                                                                                 : result.out;
}

TEST(Latex, TheStudyOfTheReadme) {
  if (!has_latex()) GTEST_SKIP() << "pdflatex and booktabs are not installed";
  const TemporaryFolder folder;
  for (const char* file : {"study.toml", "paper.tex"})
    fs::copy_file(fs::path(DELQUAD_EXAMPLES) / "study" / file, folder / file);
  ASSERT_EQ(delquad({"run", folder / "study.toml", "-o", folder / "results"}).exit_code, 0);
  EXPECT_EQ(compile(folder.path(), "paper.tex"), "");
  EXPECT_NE(read_text(folder / "results/table.tex").find("$\\pm$"), std::string::npos);
}

TEST(Latex, TextsThatMeanSomethingToIt) {
  if (!has_latex()) GTEST_SKIP() << "pdflatex and booktabs are not installed";
  const TemporaryFolder folder;
  write_text(folder / "reference.toml",
             "source = \"50 % & #1 of {A}\"\n[[row]]\nname = \"a_b^c~d \\\\ $e$\"\neta_mean = 0.5\n");
  run_into(
      folder, "odd",
      "title = \"100 % & \\\\ten_x {\\n} ^2 ~ #3 $\"\nreference = \"reference.toml\"\npipelines = [\"DB\"]\n"
      "size = 0.5\n[[case]]\nname = \"a_b\"\nloop = { rectangle = [[0, 0], [1, 1]] }\n"
      "[[case]]\nname = \"broken\"\nmesh = \"50%_&{}#$^~.msh\"\n");
  write_text(folder / "t.tex",
             "\\documentclass{article}\\usepackage{booktabs}\\begin{document}\\input{results/odd/"
             "table}\\end{document}\n");
  EXPECT_EQ(compile(folder.path(), "t.tex"), "");
}

}  // namespace
}  // namespace delquad::testing_support
