// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/files.h"

namespace delquad {
namespace {

/// Where a written file has a number of things that follow: behind which text.
struct Announced {
  const char *extension, *before;
};

std::string changed(const std::string& text, const std::string& before, int by) {
  const std::size_t at = text.find(before);
  EXPECT_NE(at, std::string::npos) << before;
  std::size_t length = 0;
  const std::size_t begin = at + before.size();
  const int n = std::stoi(text.substr(begin), &length);
  return text.substr(0, begin) + std::to_string(n + by) + text.substr(begin + length);
}

/// The items of a header must be there, and no more. Else a reader would leave out the rest, or take one
/// thing for another.
TEST(AnnouncedNumbers, MustBeThoseThatFollow) {
  const Folder folder;
  const Mesh mesh = quad_grid(3, 2);
  for (const Announced& in : {Announced{".mesh", "Vertices\n"}, Announced{".mesh", "Quadrilaterals\n"},
                              Announced{".mesh", "Edges\n"}, Announced{".vtu", "NumberOfPoints=\""},
                              Announced{".vtu", "NumberOfCells=\""}, Announced{".mfem", "elements\n"},
                              Announced{".mfem", "boundary\n"}, Announced{".mfem", "vertices\n"},
                              Announced{".msh", "$Nodes\n"}, Announced{".msh", "$Elements\n"}}) {
    const std::string name = std::string("case") + in.extension;
    SCOPED_TRACE(name + " " + in.before);
    const fs::path path = folder / name;
    write_mesh(path, mesh);
    const std::string text = read_text(path);
    EXPECT_EQ(read_mesh(path).quads.size(), mesh.quads.size());
    for (const int by : {-1, 1})
      expect_input_error([&] { read_mesh(write_text(path, changed(text, in.before, by))); }, {name.c_str()});
  }
}

}  // namespace
}  // namespace delquad
