// SPDX-License-Identifier: GPL-3.0-or-later
#include <BOPAlgo_Builder.hxx>
#include <cstdio>
#include "tests/geometry/cad/cad_files.h"
#include "tests/geometry/cad/shell_joints.h"

namespace delquad {
namespace {

/// Which of some things hang together.
class Parts {
 public:
  explicit Parts(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) const { return parent_[i] == i ? i : find(parent_[i]); }
  void join(int i, int j) { parent_[find(i)] = find(j); }
  int count() const {
    int n = 0;
    for (int i = 0; i < std::ssize(parent_); ++i) n += find(i) == i;
    return n;
  }

 private:
  std::vector<int> parent_;
};

/// Elements across their sides.
Parts parts_of(const Mesh& mesh) {
  Parts parts(mesh.triangles.size() + mesh.quads.size());
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    for (const HalfEdge& side : edge) parts.join(edge[0].element, side.element);
  });
  return parts;
}

/// The warnings that tell of loose joints.
std::vector<std::string> loose_joints_of(const SurfaceModel& model) {
  std::vector<std::string> told;
  for (const Warning& warning : model.warnings)
    if (warning.text.find("share no nodes (--glue") != std::string::npos) told.push_back(warning.text);
  return told;
}

/// "face 2 touches face 1 at (...); ..." joins these faces.
void join_named(const std::string& text, const Mesh& mesh, Parts& parts) {
  const auto triangle_of = [&](int face) {
    return static_cast<int>(std::ranges::find(mesh.triangle_region, face - 1) - mesh.triangle_region.begin());
  };
  std::size_t from = text.find("): ");
  ASSERT_NE(from, std::string::npos);
  for (std::size_t end; from != std::string::npos; from = end) {
    end = text.find(';', from + 1);
    const std::string joint = text.substr(from, end - from);
    EXPECT_NE(joint.find(" at ("), std::string::npos) << joint;
    const auto face_at = [&](std::size_t at) {
      return std::stoi(joint.substr(at + std::string("face ").size()));
    };
    parts.join(triangle_of(face_at(joint.find("face "))), triangle_of(face_at(joint.rfind("face "))));
  }
}

MeshProblem problem_of(const std::filesystem::path& file, bool glue) {
  MeshProblem problem = problem_of(CadModel{file}, 0.8);
  problem.surface.glue = glue;
  return problem;
}

using Writer = std::filesystem::path (*)(const std::filesystem::path&, const TopoDS_Shape&);
struct Format {
  const char* name;
  Writer write;
};
constexpr Format kFormats[] = {{"step", write_step}, {"iges", write_iges}, {"brep", write_brep}};

class ShellJoints : public ::testing::TestWithParam<Format> {
 protected:
  std::filesystem::path write(const std::string& name, const TopoDS_Shape& shape) {
    return GetParam().write(folder_ / (name + "." + GetParam().name), shape);
  }
  TemporaryFolder folder_;
};

TEST_P(ShellJoints, AreNamedInOneWarning) {
  for (const ShellJoint& joint : shell_joints()) {
    SCOPED_TRACE(joint.name);
    const SurfaceModel model = read_cad(write(joint.name, compound_of(joint.faces)));
    Parts parts = parts_of(model.fine);
    const std::vector<std::string> told = loose_joints_of(model);
    ASSERT_EQ(told.size(), parts.count() > 1 ? 1u : 0u);
    if (!told.empty()) join_named(told[0], model.fine, parts);
    EXPECT_EQ(parts.count(), 1) << (told.empty() ? "" : told[0]);
  }
}

TEST_P(ShellJoints, AreGlued) {
  for (const ShellJoint& joint : shell_joints()) {
    SCOPED_TRACE(joint.name);
    const SurfaceModel model = read_cad(write(joint.name, compound_of(joint.faces)), {.glue = true});
    EXPECT_TRUE(loose_joints_of(model).empty());
    EXPECT_EQ(parts_of(model.fine).count(), 1);
    expect_sound(model);
    EXPECT_EQ(static_cast<int>(model.fine.regions.size()), joint.n_glued);
    // IGES has nine digits.
    EXPECT_NEAR(count(model.fine).area / joint.area, 1, joint.is_flat ? 1e-8 : 1e-3);
  }
}

TEST_P(ShellJoints, AreMeshedInOnePiece) {
  for (const ShellJoint& joint : shell_joints()) {
    SCOPED_TRACE(joint.name);
    const MeshResult result = mesh(problem_of(write(joint.name, compound_of(joint.faces)), true), "DB");
    EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
    EXPECT_TRUE(result.mesh.triangles.empty());
    EXPECT_EQ(parts_of(result.mesh).count(), 1);
  }
}

TEST_P(ShellJoints, ManyFacesAtAnEdgeAreSewn) {
  for (const int n : {3, 4, 5}) {
    SCOPED_TRACE(n);
    const SurfaceModel model = read_cad(write("star", compound_of(star_of_faces(n))));
    EXPECT_EQ(parts_of(model.fine).count(), 1);
    EXPECT_EQ(count(model.fine).free_sides, 3 * n);
    EXPECT_TRUE(loose_joints_of(model).empty());
    EXPECT_TRUE(std::ranges::any_of(model.warnings, [&](const Warning& w) {
      return w.text.starts_with(std::to_string(n) + " of " + std::to_string(4 * n) + " free edges coincided");
    }));
  }
}

const auto name_of_format = [](const auto& of) { return std::string(of.param.name); };
INSTANTIATE_TEST_SUITE_P(Formats, ShellJoints, ::testing::Values(kFormats[0]), name_of_format);
INSTANTIATE_TEST_SUITE_P(OthersLong, ShellJoints, ::testing::Values(kFormats[1], kFormats[2]),
                         name_of_format);

/// Whether all nodes hang together.
bool is_one_piece(const Mesh& mesh) {
  Parts parts(mesh.points.size());
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) parts.join(triangle[0], v);
  return parts.count() == 1;
}

/// The place that a message names.
Vec3 place_in(const std::string& text) {
  Vec3 at{1e9, 1e9, 1e9};
  const std::size_t from = text.rfind(" at (");
  if (from != std::string::npos) std::sscanf(text.c_str() + from, " at (%lf, %lf, %lf)", &at.x, &at.y, &at.z);
  return at;
}

TEST_P(ShellJoints, ContactsAtAPointAreNamedAndGluedOrRefused) {
  constexpr double kNear = 0.02;  // so far around the ball in a ball is within the tolerance
  for (const PointContact& contact : point_contacts()) {
    SCOPED_TRACE(contact.name);
    const auto file = write("contact", compound_of(contact.bodies));
    const std::vector<std::string> told = loose_joints_of(read_cad(file));
    ASSERT_EQ(told.size(), 1u);
    EXPECT_TRUE(holds(told[0], "at 1 place "));
    EXPECT_LT(norm(place_in(told[0]) - contact.at), kNear) << told[0];
    try {
      const SurfaceModel model = read_cad(file, {.glue = true});
      EXPECT_TRUE(is_one_piece(model.fine));
      EXPECT_TRUE(loose_joints_of(model).empty());
      // Rims have a node on both sides. Others have a small face in common, within the tolerance.
      EXPECT_TRUE(contact.name == "rims" || model.fine.regions.size() > contact.bodies.size());
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_TRUE(holds(text, "cannot be glued at 1 place"));
      EXPECT_LT(norm(place_in(text) - contact.at), kNear) << text;
    }
  }
}

/// Never a closed body of two faces without anything between them.
TEST_P(ShellJoints, FacesOnEachOtherAreNamedAndBecomeOne) {
  for (const DoubleFaces& some : double_faces()) {
    SCOPED_TRACE(some.name);
    const auto file = write("double", compound_of(some.faces));
    const SurfaceModel apart = read_cad(file);
    const std::vector<std::string> told = loose_joints_of(apart);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_TRUE(holds(told[0], " touches face "));
    EXPECT_EQ(apart.fine.regions.size(), some.faces.size());
    EXPECT_EQ(parts_of(apart.fine).count(), 1 + static_cast<int>(some.faces.size()) - some.n_others);
    const SurfaceModel glued = read_cad(file, {.glue = true});
    EXPECT_TRUE(loose_joints_of(glued).empty());
    EXPECT_EQ(static_cast<int>(glued.fine.regions.size()), some.n_others);
    EXPECT_EQ(count(glued.fine).free_sides > 0, some.n_others == 1);
    EXPECT_NEAR(count(glued.fine).area / some.area, 1, 1e-3);
  }
}

class JoinedShells : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name) {
    const auto all = shell_joints();
    const auto at = std::ranges::find(all, name, &ShellJoint::name);
    return write_step(folder_ / (name + ".step"), compound_of(at->faces));
  }
  TemporaryFolder folder_;
};

using JoinedShellsLong = JoinedShells;

/// Shells that another program fragmented have edges that stand in faces and bound others.
TEST_F(JoinedShellsLong, FragmentedBefore) {
  for (const ShellJoint& joint : shell_joints()) {
    SCOPED_TRACE(joint.name);
    BOPAlgo_Builder builder;
    for (const TopoDS_Face& face : joint.faces) builder.AddArgument(face);
    builder.Perform();
    const auto file = write_brep(folder_ / "fragmented.brep", builder.Shape());
    for (const bool glue : {false, true}) {
      const SurfaceModel model = read_cad(file, {.glue = glue});
      EXPECT_EQ(parts_of(model.fine).count(), 1);
      EXPECT_EQ(static_cast<int>(model.fine.regions.size()), joint.n_glued);
      EXPECT_TRUE(loose_joints_of(model).empty());
    }
    EXPECT_EQ(parts_of(mesh(problem_of(file, false), "DB").mesh).count(), 1);
  }
}

/// A pole, or a point in a plate, is no node.
TEST_F(JoinedShells, FragmentedContactsAtAPointAreRefused) {
  for (const PointContact& contact : point_contacts()) {
    if (!contact.name.starts_with("pole")) continue;
    SCOPED_TRACE(contact.name);
    BOPAlgo_Builder builder;
    for (const TopoDS_Shape& body : contact.bodies) builder.AddArgument(body);
    builder.Perform();
    const auto file = write_brep(folder_ / "fragmented.brep", builder.Shape());
    expect_input_error([&] { read_cad(file); }, {"share single points", "at 1 place", " touches face "});
  }
}

TEST_F(JoinedShells, CompoundsOrdersAndSymmetry) {
  for (const char* name : {"web_across", "web_inside", "plates_crossing", "pipe_through_a_plate"}) {
    const auto file = write(name);
    const std::pair<const char*, std::function<void(MeshProblem&)>> changes[] = {
        {"compound", [](MeshProblem& p) { p.surface.compounds = Compounds::kAll; }},
        {"order", [](MeshProblem& p) { p.order = 2; }},
        {"ignored", [](MeshProblem& p) { p.surface.ignore_below = 0.1; }},
        {"symmetric", [](MeshProblem& p) { p.symmetry.automatic = true; }},
        {"embedded", [](MeshProblem& p) {
           p.surface.embed = {{{{1, 1, 0}, {2, 3, 0}}, "", ""}};
         }}};
    for (const auto& [what, change] : changes) {
      SCOPED_TRACE(std::string(name) + ", " + what);
      MeshProblem problem = problem_of(file, true);
      change(problem);
      const MeshResult result = mesh(problem, "DB");
      EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
      EXPECT_EQ(parts_of(result.mesh).count(), 1);
    }
  }
}

/// A node inside of a face would hold nothing but this corner.
TEST_F(JoinedShells, ATipOnAFaceIsNamedAndRefused) {
  const auto file = write_step(folder_ / "tip.step", compound_of(tip_on_a_plate()));
  const std::vector<std::string> told = loose_joints_of(read_cad(file));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(holds(told[0], "face 1 touches face 2 at (4, 3, 0)"));
  expect_input_error([&] { read_cad(file, {.glue = true}); }, {"cannot be glued at 1 place", "(4, 3, 0)"});
}

TEST_F(JoinedShells, EdgesFromACommonCornerAreNamed) {
  const auto file = write_step(folder_ / "gusset.step", compound_of(gusset_from_a_corner()));
  const SurfaceModel model = read_cad(file);
  EXPECT_EQ(parts_of(model.fine).count(), 1);
  const std::vector<std::string> told = loose_joints_of(model);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(holds(told[0], "at 1 place ", "face 3 touches face 1 at (8, 2, 0)"));
}

TEST_F(JoinedShells, NoOthersAreNamed) {
  for (const auto& faces : faces_apart()) {
    const SurfaceModel model = read_cad(write_brep(folder_ / "apart.brep", compound_of(faces)));
    EXPECT_TRUE(loose_joints_of(model).empty()) << loose_joints_of(model)[0];
    EXPECT_EQ(parts_of(model.fine).count(), 2);
  }
}

}  // namespace
}  // namespace delquad
