#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "io/cases/read_described.h"
#include "io/mesh_io.h"
#include "metrics/metrics.h"
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

std::set<std::string> names_of(const std::vector<Entity>& entities) {
  std::set<std::string> names;
  for (const Entity& entity : entities) names.insert(entity.names.begin(), entity.names.end());
  return names;
}

TEST(MeshCommand, SquareIsExactAndKeepsItsNames) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  const ProgramResult result =
      delquad({"mesh", model, "-o", folder / "out.msh", "--size", "0.05", "--json", folder / "record.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");  // no terminal: no progress bar
  const Mesh mesh = read_mesh(folder / "out.msh");
  EXPECT_EQ(mesh.quads.size(), 400u);
  EXPECT_EQ(names_of(mesh.curves), (std::set<std::string>{"bottom", "right", "top", "left"}));
  EXPECT_EQ(names_of(mesh.regions), std::set<std::string>{"square"});
  for (const double eta : quad_etas(mesh)) EXPECT_NEAR(eta, 1, 1e-9);
  const std::string record = read_text(folder / "record.json");
  for (const char* key :
       {"\"eta_mean\"", "\"seconds\"", "\"peak_memory_bytes\"", "\"commit\"", "\"compiler\"", "\"cgal\"",
        "\"h_max\": 1.4", "\"rejection\"", "\"treatment\": \"paper\"", "\"status\": \"ok\""})
    EXPECT_TRUE(contains(record, key)) << key;
}

TEST(MeshCommand, TellsWhatALargeMeshCostsBeforeItBegins) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  const auto mesh = [&](const std::string& size) {
    return delquad({"mesh", model, "-o", folder / "out.msh", "--size", size, "--time-limit", "5"});
  };
  const std::string told = mesh("0.0007").err;
  EXPECT_TRUE(contains(told, "about 2 million quads are expected: some 1.4 GB of memory and 2 minutes"))
      << told;
  EXPECT_TRUE(contains(told, "--max-elements")) << told;
  EXPECT_EQ(mesh("0.02").err, "");
}

TEST(MeshCommand, SizesAreDividedAndFoundByNumber) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare + "size = 0.1\nrefine = 2\n");
  std::string printed;
  const auto quads = [&](std::vector<std::string> more, const std::string& of) {
    more.insert(more.begin(), {"mesh", of, "-o", folder / "out.msh", "--json", folder / "record.json"});
    const ProgramResult result = delquad(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    printed = result.out;
    return read_mesh(folder / "out.msh").quads.size();
  };
  EXPECT_EQ(quads({}, model), 400u);
  EXPECT_TRUE(contains(read_text(folder / "record.json"), "\"refine\": 2.0"));
  EXPECT_EQ(quads({"--refine", "3"}, model), 900u);
  const auto counted = write_text(folder / "counted.toml", kSquare + "quads = 1600\n");
  EXPECT_EQ(quads({}, counted), 1600u);
  EXPECT_TRUE(contains(printed, "size: 0.025 for 1600 quads")) << printed;
  EXPECT_TRUE(contains(read_text(folder / "record.json"), "\"asked\": 1600"));
  EXPECT_NEAR(double(quads({"--quads", "900", "--size", "0.1 + 0.3*x"}, counted)), 900, 27);
  for (const auto& [given, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--quads", "100"}, "refine"},
           {{"--quads", "100", "--size", "0.1"}, "--size and --quads"},
           {{"--quads", "0"}, "--quads: 'quads' is 0: expected at least 1"},
           {{"--refine", "-1"}, "expected a number above 0"}}) {
    std::vector<std::string> command = {"mesh", model, "-o", folder / "no.msh"};
    command.insert(command.end(), given.begin(), given.end());
    const ProgramResult result = delquad(command);
    EXPECT_EQ(result.exit_code, 2) << said;
    EXPECT_TRUE(contains(result.err, said)) << result.err;
  }
}

TEST(MeshCommand, ItsFirstLineCountsAllSteps) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare + R"([size]
base = 0.02
gradation = 0.1
source = [{ at = [0.5, 0.5], near = 0.004, far = 0.02, radius_far = 0.2 }]
)");
  const ProgramResult result =
      delquad({"mesh", model, "-o", folder / "out.msh", "--quality", "fast", "--threads", "1", "-v"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto number_behind = [&](const std::string& text) {
    return std::stod(result.out.substr(result.out.find(text) + text.size()));
  };
  constexpr double kDigits = 0.01;
  EXPECT_GE(number_behind(" vertices in "), number_behind("; all ") - kDigits) << result.out;
}

TEST(MeshCommand, SaysInAFewLinesWhatTheMeshIsLike) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare + "size = 0.25\n");
  const ProgramResult result = delquad({"mesh", model, "-o", folder / "out.msh"});
  EXPECT_EQ(result.out.substr(result.out.find('\n') + 1),
            "  shape: eta mean 1.000, worst 1.000, scaled Jacobian mean 1.000, least 1.000, angles from 90.0 "
            "to 90.0 degrees, aspect mean 1.00, largest 1.00\n"
            "  size: tau 100.0 %, edges from 1.000 to 1.000 sizes\n"
            "  vertices: d4 100.0 %, 0 irregular, 0 of them on curves, 0 necessary, 0 more than necessary\n"
            "  names: regions square; curves bottom, right, top, left\n");
  const ProgramResult all = delquad({"mesh", model, "-o", folder / "out.msh", "-v"});
  for (const char* part : {"SJ min", "eta 5 %", "seconds: "}) EXPECT_TRUE(contains(all.out, part)) << part;
}

TEST(MeshCommand, WritesEveryFormatAndMetricsReadsIt) {
  const TemporaryFolder folder;
  // An interface without a name lies inside the mesh.
  const auto model = write_text(
      folder / "MODEL.TOML",
      kSquareLoop + "[[loop]]\ncircle = { centre = [0.5, 0.5], radius = 0.2 }\nregion = \"core\"\n");
  std::set<std::string> measured;
  for (const char* name : {"a.msh", "b.MSH", "a.vtu", "a.obj", "a.inp", "a.mesh"}) {
    std::vector<std::string> arguments = {"mesh", model, "-o", folder / name, "--size", "0.1"};
    if (std::string(name) == "b.MSH") arguments.insert(arguments.end(), {"--binary", "--curves", "all"});
    ASSERT_EQ(delquad(arguments).exit_code, 0) << name;
    const ProgramResult result = delquad({"metrics", folder / name});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    measured.insert(result.out.substr(result.out.find('\n')));
  }
  EXPECT_EQ(measured.size(), 1u);
  EXPECT_EQ(read_mesh(folder / "a.msh").curves.size() + 1, read_mesh(folder / "b.MSH").curves.size());

  EXPECT_EQ(delquad({"mesh", model, "-o", folder / "a.svg", "--size", "0.1"}).exit_code, 0);
  EXPECT_TRUE(contains(read_text(folder / "a.svg"), "<svg"));
  const ProgramResult refused = delquad({"mesh", model, "-o", folder / "c.obj", "--size", "0.1", "--binary"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "c.obj")) << refused.err;
}

TEST(MeshCommand, SaysWhatAPolygonModelBecame) {
  const TemporaryFolder folder;
  const auto model = write_text(
      folder / "roof.OBJ", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 3 1\nv 0 2 0\nf 1 2 3 5\nf 3 4 5\nf 1 5 4 3 2\n");
  const ProgramResult result = delquad({"info", model});
  EXPECT_TRUE(contains(result.out + result.err, "1 quad was split")) << result.out << result.err;
  EXPECT_TRUE(
      contains(result.out + result.err, "1 face of more than four vertices was split into 3 triangles"))
      << result.out << result.err;
}

TEST(MeshCommand, QualityChoosesWordAndCross) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  const auto record = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"mesh", model, "-o", folder / "out.msh", "--size", "0.02 + 0.05*x",
                                     "--json", folder / "record.json"});
    const ProgramResult result = delquad(options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_text(folder / "record.json");
  };
  const auto has = [](const std::string& text, const std::string& word, const std::string& cross) {
    return contains(text, "\"pipeline\": \"" + word + "\"") && contains(text, cross);
  };
  EXPECT_TRUE(has(record({}), "DBQO", "\"kind\": \"size-aware\""));
  EXPECT_TRUE(has(record({"--quality", "fast"}), "DB", "\"kind\": \"boundary\""));
  EXPECT_TRUE(has(record({"--quality", "good"}), "DBQO", "\"kind\": \"size-aware\""));
  EXPECT_TRUE(has(record({"--quality", "best"}), "DBCQO", "\"kind\": \"size-aware\""));
  // What is said elsewhere counts.
  EXPECT_TRUE(has(record({"--cross", "0.1"}), "DBQO", "\"text\": \"0.1\""));
  EXPECT_TRUE(has(record({"--pipeline", "DBC"}), "DBC", "\"text\": null"));
}

TEST(MeshCommand, StagesAreToldByOptions) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare + "size = 0.1\n");
  const auto with = [&](const std::string& option) {
    return delquad(
        {"mesh", model, "-o", folder / "out.msh", "--json", folder / "record.json", "--set", option});
  };
  ASSERT_EQ(with("regularity.tolerance=7.5").exit_code, 0);
  EXPECT_TRUE(contains(read_text(folder / "record.json"), "\"tolerance\": 7.5"));
  EXPECT_EQ(with("recombination.solver=lemon").exit_code, 0);
  // Any key of model files will do.
  ASSERT_EQ(with("size.max=0.05").exit_code, 0);
  EXPECT_TRUE(contains(read_text(folder / "record.json"), "\"max\": 0.05"));
  ASSERT_EQ(with("layer={ on = \"wall\", first = 0.01, number = 2 }").exit_code, 2)
      << "no curve has that name";
  EXPECT_EQ(with("order=2").exit_code, 0);
  for (const char* bad : {"regularity.tolerance", "regularity.tolerance=-1", "regularity.tolerance=much",
                          "regularity.tolerence=1", "surface.glew=true", "=1", "order=2\n["}) {
    const ProgramResult result = with(bad);
    EXPECT_EQ(result.exit_code, 2) << bad;
    EXPECT_TRUE(contains(result.err, "--set")) << result.err;
  }
  const ProgramResult twice =
      delquad({"mesh", model, "-o", folder / "out.msh", "--set", "order=2", "--set", "order=1"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_TRUE(contains(twice.err, "--set order=1: another option sets this key, too")) << twice.err;
}

TEST(MeshCommand, OtherFormatsHoldTheSameMesh) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare + "size = \"0.05 + 0.1*x\"\n");
  for (const char* name : {"out.msh", "out.vtu", "out.obj", "out.inp", "out.mesh"}) {
    ASSERT_EQ(delquad({"mesh", model, "-o", folder / name}).exit_code, 0) << name;
    EXPECT_GT(std::filesystem::file_size(folder / name), 1000u) << name;
  }
  EXPECT_EQ(read_mesh(folder / "out.msh").quads, read_mesh(folder / "out.obj").quads);
}

TEST(MeshCommand, SameBytesTwice) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml",
                                kSquareLoop + "[[loop]]\ncircle = { centre = [0.4, 0.5], radius = 0.2 }\n");
  for (const char* name : {"a.msh", "b.msh"})
    ASSERT_EQ(delquad({"mesh", model, "-o", folder / name, "--size", "0.02 + 0.05*x"}).exit_code, 0);
  EXPECT_EQ(read_text(folder / "a.msh"), read_text(folder / "b.msh"));
}

std::string ring(int n) {
  std::vector<std::pair<double, double>> nodes;
  for (int i = 0; i < n; ++i)
    nodes.emplace_back(std::cos(2 * std::numbers::pi * i / n), std::sin(2 * std::numbers::pi * i / n));
  return line_mesh(nodes, "rim of iron");
}

TEST(MeshCommand, LineMeshIsRespectedNodeForNode) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "ring.msh", ring(40));
  const ProgramResult result = delquad({"mesh", model, "-o", folder / "out.msh"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Mesh before = read_mesh(model), after = read_mesh(folder / "out.msh");
  EXPECT_EQ(after.triangles.size(), 0u);
  ASSERT_EQ(after.lines.size(), 40u);
  std::set<std::pair<double, double>> given, kept;
  for (const Vec3& p : before.points) given.insert({p.x, p.y});
  for (const auto& line : after.lines)
    for (const int v : line) kept.insert({after.points[v].x, after.points[v].y});
  EXPECT_EQ(given, kept);
  EXPECT_EQ(names_of(after.curves), std::set<std::string>{"rim of iron"});
}

TEST(MeshCommand, OddBoundaryLeavesOneTriangleAndSaysWhere) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "ring.msh", ring(41));
  ProgramResult result = delquad({"mesh", model, "-o", folder / "out.msh"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "'rim of iron'")) << result.err;
  EXPECT_TRUE(contains(result.err, "41")) << result.err;
  EXPECT_EQ(read_mesh(folder / "out.msh").triangles.size(), 1u);

  result = delquad({"mesh", model, "-o", folder / "out.msh", "--allow-triangles"});
  EXPECT_EQ(result.exit_code, 0);
  // Triangles are what these pipelines make.
  EXPECT_EQ(delquad({"mesh", model, "-o", folder / "out.msh", "--pipeline", "F"}).exit_code, 0);
}

/// A node in the middle of a triangle's side: one quad, with an angle of 180 degrees.
std::filesystem::path flat_quad(const TemporaryFolder& folder) {
  write_text(folder / "flat.msh", line_mesh({{0, 0}, {1, 0}, {2, 0}, {1, 1}}, "rim"));
  return write_text(folder / "flat.toml",
                    "mesh = \"flat.msh\"\nsize = 2\nrecombination = { treatment = \"none\" }\n");
}

const std::string kFlat = "1 quad is inverted or flat: face 1 at (1, 0.25, 0)";

TEST(MeshCommand, AMeshThatIsNotSoundIsNotWritten) {
  const TemporaryFolder folder;
  const auto model = flat_quad(folder);
  std::vector<std::string> arguments = {"mesh",       model, "-o",     folder / "out.msh",
                                        "--pipeline", "DB",  "--json", folder / "r.json"};
  const ProgramResult refused = delquad(arguments);
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_TRUE(contains(refused.err, "\nerror: " + model.string() + ": the mesh is not sound: " + kFlat +
                                        ": nothing was written (--allow-unsound writes it)\n"))
      << refused.err;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"flat.msh", "flat.toml"}));

  arguments.push_back("--allow-unsound");
  const ProgramResult allowed = delquad(arguments);
  EXPECT_EQ(allowed.exit_code, 0);
  EXPECT_TRUE(contains(allowed.err, "warning: the mesh is not sound: " + kFlat + "\n")) << allowed.err;
  EXPECT_EQ(read_mesh(folder / "out.msh").quads.size(), 1u);
  const std::string record = read_text(folder / "r.json");
  EXPECT_TRUE(contains(record, "\"sound\": false")) << record;
  EXPECT_TRUE(contains(record, kFlat));
}

TEST(MeshCommand, ExceededLimitsAreInTheRecord) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "m.toml", kSquareLoop);
  const std::string beyond = "an aspect above 1, the largest ";
  ASSERT_EQ(delquad({"mesh", model, "-o", folder / "m.msh", "--size", "0.27", "--pipeline", "DB",
                     "--allow-unsound", "--max-aspect", "1", "--json", folder / "r.json"})
                .exit_code,
            0);
  const std::string record = read_text(folder / "r.json");
  EXPECT_TRUE(contains(record, "\"sound\": false")) << record;
  const auto at = record.find(beyond);  // among the reasons, and the warnings
  ASSERT_NE(at, std::string::npos) << record;
  EXPECT_NE(record.find(beyond, at + 1), std::string::npos) << record;
}

TEST(MeshCommand, HelpHasTheOptionsOfAllDescriptions) {
  const std::string help = delquad({"mesh", "--help"}).out;
  int options = 0;
  for (const TomlKeys& keys : {keys_of<MeshProblem>(), keys_of<SizeSpec>(), keys_of<SurfaceSpec>()})
    for (const TomlKey& key : keys) {
      if (key.option == nullptr) continue;
      ++options;
      EXPECT_TRUE(contains(help, std::string("  ") + key.option)) << key.option;
      EXPECT_TRUE(contains(help, ": " + key.about)) << key.option;
    }
  EXPECT_GT(options, 20);
}

TEST(MeshCommand, HelpHasTheExitCodes) {
  const std::string help = delquad({"--help"}).out;
  for (const char* code : {"3: triangles are left", "4: faces were left out", "5: the mesh is not sound"})
    EXPECT_TRUE(contains(help, code)) << help;
}

TEST(RunCommand, ACellThatIsNotSoundHasFailed) {
  const TemporaryFolder folder;
  flat_quad(folder);
  const auto experiment = write_text(
      folder / "e.toml", "pipelines = [\"DB\"]\n[[case]]\nname = \"flat\"\nmodel = \"flat.toml\"\n");
  const auto cell = folder / "results" / "flat" / "DB";
  EXPECT_EQ(delquad({"run", experiment, "-o", folder / "results"}).exit_code, 5);
  EXPECT_FALSE(std::filesystem::exists(cell / "mesh.msh"));
  const std::string failed = read_text(cell / "record.json");
  EXPECT_TRUE(contains(failed, "\"kind\": \"unsound\"")) << failed;
  EXPECT_TRUE(contains(failed, kFlat)) << failed;
  EXPECT_TRUE(
      contains(read_text(folder / "results/table.md"), "flat DB failed: flat DB: the mesh is not sound"));
  EXPECT_EQ(delquad({"rerun", cell / "record.json"}).exit_code, 2);

  EXPECT_EQ(delquad({"run", experiment, "-o", folder / "results", "--allow-unsound"}).exit_code, 0);
  EXPECT_TRUE(contains(read_text(cell / "record.json"), "\"sound\": false"));
  const std::string table = read_text(folder / "results/table.md");
  EXPECT_TRUE(contains(table, "| DB (unsound) ")) << table;
  EXPECT_TRUE(contains(table, "flat DB is not sound: " + kFlat)) << table;
  EXPECT_TRUE(contains(read_text(folder / "results/table.csv"), "flat,DB,unsound,"));
  EXPECT_TRUE(contains(read_text(folder / "results/table.json"), "\"unsound\": \"unsound\""));
  EXPECT_EQ(delquad({"rerun", cell / "record.json"}).exit_code, 0);
}

/// What the program wrote is a model again, with all of its names.
TEST(MeshCommand, OutputFedBackKeepsItsRegions) {
  const TemporaryFolder folder;
  const auto model =
      write_text(folder / "model.toml",
                 kSquareLoop +
                     "[[loop]]\ncircle = { centre = [0.5, 0.5], radius = 0.3 }\nregion = \"core\"\n"
                     "[[loop]]\ncircle = { centre = [0.5, 0.5], radius = 0.1 }\n");
  ASSERT_EQ(delquad({"mesh", model, "-o", folder / "once.msh", "--size", "0.05"}).exit_code, 0);
  ASSERT_EQ(delquad({"mesh", folder / "once.msh", "-o", folder / "twice.msh"}).exit_code, 0);
  const Mesh once = read_mesh(folder / "once.msh"), twice = read_mesh(folder / "twice.msh");
  EXPECT_EQ(names_of(twice.regions), (std::set<std::string>{"square", "core"}));
  EXPECT_EQ(names_of(twice.curves), names_of(once.curves));
  EXPECT_EQ(twice.lines.size(), once.lines.size());
}

TEST(MeshCommand, InclusionAndSecondComponent) {
  const TemporaryFolder folder;
  const auto model =
      write_text(folder / "model.toml", kSquareLoop +
                                            "[[loop]]\ncircle = { centre = [0.5, 0.5], radius = 0.2 }\n"
                                            "boundary = \"interface\"\nregion = \"inclusion\"\n"
                                            "[[loop]]\nrectangle = [[2, 0], [3, 1]]\nregion = \"other\"\n");
  const ProgramResult result = delquad({"mesh", model, "-o", folder / "out.msh", "--size", "0.06"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Mesh mesh = read_mesh(folder / "out.msh");
  EXPECT_EQ(names_of(mesh.regions), (std::set<std::string>{"square", "inclusion", "other"}));
  EXPECT_EQ(mesh.triangles.size(), 0u);
  EXPECT_EQ(check_invariants(mesh), std::vector<std::string>{});
}

TEST(MetricsCommand, MeasuresWhatWasWritten) {
  const TemporaryFolder folder;
  const auto model = write_text(folder / "model.toml", kSquare);
  ASSERT_EQ(delquad({"mesh", model, "-o", folder / "out.msh", "--size", "0.1"}).exit_code, 0);
  ProgramResult result = delquad({"metrics", folder / "out.msh", "--json", folder / "m.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(read_text(folder / "m.json"), "\"tau\": null"));
  for (const char* size : {"0.1", "0.1 + 0*x", "boundary"}) {
    result = delquad({"metrics", folder / "out.msh", "--size", size, "--json", folder / "m.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FALSE(contains(read_text(folder / "m.json"), "\"tau\": null")) << size;
    EXPECT_TRUE(contains(read_text(folder / "m.json"), "\"n_quads\": 100")) << size;
  }
}

TEST(MetricsCommand, LinksOfFlowAreForThePlane) {
  const TemporaryFolder folder;
  const auto square = write_text(folder / "square.obj",
                                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                                 "f 1 2 3 4\nf 2 5 6 3\n");
  ProgramResult result = delquad({"metrics", square, "--links", "--json", folder / "m.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "links of flow: 1\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "least 1 (at (1, 0.5, 0))")) << result.out;
  EXPECT_TRUE(contains(read_text(folder / "m.json"), "\"link_cos_max\": 0")) << result.out;
  const auto bent = write_text(folder / "bent.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 1\nf 1 2 3 4\n");
  result = delquad({"metrics", bent, "--links"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "bent.obj: --links is for planar meshes")) << result.err;
}

}  // namespace
}  // namespace delquad::testing_support
