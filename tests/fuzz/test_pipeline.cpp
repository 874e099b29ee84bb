// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "io/cases/case_file.h"
#include "io/cases/read_problem.h"
#include "tests/fuzz/reader_seeds.h"
#include "tests/fuzz/target.h"
#include "tests/support/temporary_folder.h"
#if DELQUAD_HAS_CAD
#include <BRepPrimAPI_MakeBox.hxx>
#include <TopoDS_Shape.hxx>

#include "geometry/cad/example_models.h"
#include "tests/geometry/cad/cad_files.h"
#endif

namespace delquad::fuzz {
namespace {

/// A small file of each format that `mesh` takes.
struct Whole {
  std::string name, bytes;
  double size;
};

std::vector<Whole> whole_files() {
  std::vector<Whole> files = {{"a.toml",
                               "loop = [{rectangle = [[0, 0], [4, 2]], region = \"plate\"}, {circle = "
                               "{centre = [1, 1], radius = 0.5}}]\n",
                               0.5}};
  const auto add = [&](const std::string& extension, const std::vector<std::string>& seeds) {
    for (std::size_t i = 0; i < seeds.size(); ++i)
      files.push_back({std::to_string(i) + extension, seeds[i], 0.5});
  };
  add(".msh", msh_seeds());
  add(".obj", obj_seeds());
  add(".off", off_seeds());
  add(".stl", stl_seeds());
  add(".ply", ply_seeds());
  add(".3mf", three_mf_seeds());
#if DELQUAD_HAS_CAD
  for (const auto& [extension, format] :
       {std::pair{".step", CadFormat::kStep}, {".brep", CadFormat::kBrep}}) {
    std::ostringstream text;
    write_example("cone_tip", format, text);
    files.push_back({std::string("a") + extension, text.str(), 10});
  }
  const testing_support::TemporaryFolder folder;
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  files.push_back(
      {"a.igs", testing_support::read_text(testing_support::write_iges(folder / "a.igs", box)), 1});
#endif
  return files;
}

/// Some bytes changed, lost, or there twice; 0: none.
std::string mutated(std::string text, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const std::string signs = "0123456789.,-+eE #()";
  for (unsigned n = seed == 0 ? 0 : 1 + seed % 7; n > 0 && !text.empty(); --n) {
    const std::size_t at = below(text.size()), length = below(20);
    switch (below(4)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      default:
        text[at] = signs[below(signs.size())];
    }
  }
  return text;
}

/// For any file, the public API returns a valid mesh or throws an error that says why.
TEST(Pipeline, TakesOrRefusesWhatIsInFiles) {
  const testing_support::TemporaryFolder folder;
  constexpr unsigned kMutations = 10;
  constexpr double kSeconds = 1;  // time that is up is an answer, too
  int meshed = 0, refused = 0;
  for (const Whole& whole : whole_files()) {
    for (unsigned seed = 0; seed < kMutations; ++seed) {
      SCOPED_TRACE(whole.name + ", seed " + std::to_string(seed));
      const auto path = testing_support::write_text(folder / whole.name, mutated(whole.bytes, seed));
      try {
        Case c = read_model_case(path);
        c.size.text = std::to_string(whole.size);
        MeshProblem problem = read_files(c);
        problem.max_elements = 2000;
        const MeshResult result = mesh(problem, "DB", {.threads = 1, .time_limit = kSeconds});
        ++meshed;
        EXPECT_TRUE(result.soundness.sound());
        EXPECT_FALSE(result.mesh.quads.empty() && result.mesh.triangles.empty());
      } catch (const InputError& error) {
        ++refused;
        EXPECT_NO_THROW(check_message(error.what(), "")) << error.what();
      } catch (const UnsoundError&) {
        ++refused;
      } catch (const TimeIsUp&) {
      }
    }
  }
  EXPECT_GT(meshed, 20);
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace delquad::fuzz
