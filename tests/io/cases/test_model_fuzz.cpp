// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/meshing_setup.h"
#include "io/cases/case_file.h"
#include "mesher/runner.h"
#include "tests/support/files.h"
#include "tests/support/prepare_case.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

/// Damaged files of each format that models are read from are meshed or refused: no crash, no other error.
/// DELQUAD_FUZZ_TRIALS: how many files of each format, for long runs.
int trials() {
  const char* text = std::getenv("DELQUAD_FUZZ_TRIALS");
  return text != nullptr ? std::atoi(text) : 60;
}

std::string off_text(const Mesh& mesh) {
  std::ostringstream out;
  out << "OFF\n" << mesh.points.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const Vec3& p : mesh.points) out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& v : mesh.triangles) out << "3 " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
  return out.str();
}

std::string stl_text(const Mesh& mesh) {
  std::ostringstream out;
  out << "solid box\n";
  for (const auto& v : mesh.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const int i : v)
      out << "vertex " << mesh.points[i].x << ' ' << mesh.points[i].y << ' ' << mesh.points[i].z << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid box\n";
  return out.str();
}

std::string binary_stl(const Mesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](const auto& number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& v : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const int i : v)
      for (const double x : {mesh.points[i].x, mesh.points[i].y, mesh.points[i].z})
        put(static_cast<float>(x));
    put(std::uint16_t{0});
  }
  return bytes;
}

std::string msh22_text(const Mesh& mesh) {
  std::ostringstream out;
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.points.size() << '\n';
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    out << i + 1 << ' ' << mesh.points[i].x << ' ' << mesh.points[i].y << ' ' << mesh.points[i].z << '\n';
  out << "$EndNodes\n$Elements\n" << mesh.triangles.size() << '\n';
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles[t];
    out << t + 1 << " 2 2 0 " << mesh.triangle_region[t] + 1 << ' ' << v[0] + 1 << ' ' << v[1] + 1 << ' '
        << v[2] + 1 << '\n';
  }
  out << "$EndElements\n";
  return out.str();
}

std::string damaged(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random() % n); };
  for (std::size_t changes = 1 + below(3); changes > 0 && !text.empty(); --changes) {
    const std::size_t at = below(text.size()), length = below(60);
    switch (below(7)) {
      case 0:
        text[at] = static_cast<char>('0' + below(10));
        break;
      case 1:
        text[at] ^= static_cast<char>(1u << below(8));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 4:
        text.resize(at);
        break;
      case 5:
        text.insert(at, "-");
        break;
      default:
        text.insert(at, "e300");
        break;
    }
  }
  return text;
}

struct Format {
  std::string name, extension, text;
};

std::vector<Format> formats() {
  const Mesh box = testing_support::box(2), can = testing_support::can(8, 2);
  std::vector<Format> all = {{"stl_text", ".stl", stl_text(box)},
                             {"stl_binary", ".stl", binary_stl(can)},
                             {"off", ".off", off_text(can)},
                             {"msh22", ".msh", msh22_text(box)}};
  for (const std::string extension : {".obj", ".msh"}) {
    const Folder folder;
    write_mesh(folder / ("model" + extension), box);
    std::ifstream in(folder / ("model" + extension), std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    all.push_back({extension == ".obj" ? "obj" : "msh41", extension, text.str()});
  }
  return all;
}

class ModelFuzz : public ::testing::TestWithParam<Format> {};

TEST_P(ModelFuzz, DamagedFilesAreMeshedOrRefused) {
  const Folder folder;
  const fs::path file = folder / ("case" + GetParam().extension);
  int refused = 0, meshed = 0;
  for (int trial = 0; trial < trials(); ++trial) {
    std::mt19937 random(static_cast<unsigned>(trial));
    std::ofstream(file, std::ios::binary)
        << (trial == 0 ? GetParam().text : damaged(GetParam().text, random));
    Case c = read_model_case(file);
    c.size.text = "0.3";
    c.max_elements = 2000;
    c.keep_going = trial % 2 == 1;
    try {
      run_pipeline(prepare_case(c), parse_pipeline("DB"));
      ++meshed;
    } catch (const InputError& error) {
      ++refused;
      EXPECT_TRUE(holds(error.what(), "case"));
    } catch (const std::exception& error) {
      ADD_FAILURE() << "trial " << trial << ": " << error.what();
    }
  }
  EXPECT_GT(meshed, 0);
  EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, ModelFuzz, ::testing::ValuesIn(formats()),
                         [](const auto& format) { return format.param.name; });

}  // namespace
}  // namespace delquad
