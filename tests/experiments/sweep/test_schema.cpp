// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/experiment.h"
#include "experiments/sweep/schema.h"
#include "io/cases/problem_record.h"
#include "io/cases/read_described.h"
#include "io/cases/shapes.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// A table of an experiment with scalar keys: what stands before and after one of them.
struct KeyPlace {
  std::string path;  ///< empty: the top
  TomlKeys keys;
  std::string beside;  ///< other keys that it needs
};

std::vector<KeyPlace> places() {
  std::vector<KeyPlace> all = {{"", case_keys(), ""},
                               {"size", keys_of<SizeSpec>(), "base = 1, curvature = 20, max = 100"},
                               {"surface", keys_of<SurfaceSpec>(), ""}};
  for (const OptionGroup& group : option_groups()) all.push_back({group.name, keys_of(group), ""});
  return all;
}

class Schema : public testing::Test {
 protected:
  /// The program's message to a key with this value; empty: nothing.
  std::string complaint(const KeyPlace& place, const std::string& key, const std::string& value) {
    std::string line = key + " = " + value;
    if (!place.path.empty()) {
      std::string beside;
      for (std::size_t from = 0, to; from < place.beside.size(); from = to + 2) {
        const std::string& all = place.beside;
        to = std::min(all.find(", ", from), all.size());
        const std::string other = all.substr(from, to - from);
        if (!other.starts_with(key + " ")) beside += ", " + other;
      }
      line = place.path + " = { " + line + beside + " }";
    }
    const std::string size = line.starts_with("size =") ? "" : "size = 1\n";
    const auto file =
        write_text(folder_ / "e.toml",
                   line + "\n" + size + "[[case]]\nname = 'a'\nloop = { rectangle = [[0, 0], [1, 1]] }\n");
    try {
      Experiment::read(file);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  void expect(bool good, const KeyPlace& place, const std::string& key, const std::string& value) {
    EXPECT_EQ(complaint(place, key, value) == "", good)
        << place.path << "." << key << " = " << value << ": " << complaint(place, key, value);
  }

  Folder folder_;
};

bool allows(const Json& type, const char* name) {
  const Json names = type.value("type", Json::array());
  return names.is_array() ? std::ranges::find(names, name) != names.end() : names == name;
}

/// Every limit of the schema is one of the program, and the other way round as far as values next to them
/// tell.
TEST_F(Schema, SaysOfValuesWhatTheProgramSays) {
  int checked = 0;
  for (const KeyPlace& place : places())
    for (const TomlKey& key : place.keys) {
      if (key.type.empty() || key.name == "compare" || key.name == "compound") continue;
      if (place.path.empty() && key.name != "size" && key.name != "cross" && key.name != "seed") continue;
      SCOPED_TRACE(key.name);
      const Json type = Json::parse(key.type);
      ++checked;
      if (type.contains("enum")) {
        for (const Json& value : type["enum"]) expect(true, place, key.name, value.dump());
        for (const char* value : {"\"nonsense\"", "3", "18", "true"}) expect(false, place, key.name, value);
        continue;
      }
      const bool is_number = allows(type, "number"), is_integer = allows(type, "integer");
      expect(is_number && !type.contains("exclusiveMinimum") && !type.contains("minimum"), place, key.name,
             "-1.5");
      expect(allows(type, "string"), place, key.name, "\"x\"");
      expect(allows(type, "boolean"), place, key.name, "true");
      expect(false, place, key.name, "[[1]]");
      if (is_integer) expect(false, place, key.name, "20.5");
      const auto text = [&](double v) {
        return is_integer ? std::to_string(std::llround(v)) : std::to_string(v);
      };
      const double step = is_integer ? 1 : 0.01;
      if (type.contains("minimum")) {
        expect(true, place, key.name, text(type["minimum"]));
        expect(false, place, key.name, text(type["minimum"].get<double>() - step));
      }
      if (type.contains("exclusiveMinimum")) {
        expect(false, place, key.name, text(type["exclusiveMinimum"]));
        expect(true, place, key.name, text(type["exclusiveMinimum"].get<double>() + step));
      }
      if (type.contains("maximum")) {
        expect(true, place, key.name, text(type["maximum"]));
        expect(false, place, key.name, text(type["maximum"].get<double>() + step));
      }
    }
  EXPECT_GT(checked, 25);
}

/// All tables with their names.
void for_each_table(const TomlKeys& keys, const std::string& name,
                    const std::function<void(const std::string&, const TomlKeys&)>& visit) {
  visit(name, keys);
  for (const TomlKey& key : keys)
    if (key.table != nullptr) for_each_table(key.table(), key.name, visit);
}

/// Keys that the schema has and the program does not know would be refused as unknown.
TEST_F(Schema, HasNoKeyThatTheProgramLacks) {
  for (const KeyPlace& place : places())
    for (const TomlKey& key : place.keys) {
      const std::string said = complaint(place, key.name, "{ nonsense = 1 }");
      EXPECT_FALSE(
          holds(said, "unknown key '" + (place.path.empty() ? "" : place.path + ".") + key.name + "'"));
    }
}

/// In its tables of keys, such as "| `on` |", "| `polygon = [...]` |". docs/keys.md is made from the schema.
TEST_F(Schema, DocumentationHasNoOtherKey) {
  std::set<std::string> known;
  for_each_table(experiment_keys(), "the top", [&](const std::string&, const TomlKeys& keys) {
    for (const TomlKey& key : keys) known.insert(key.name);
  });
  const fs::path docs = fs::path(DELQUAD_EXPERIMENTS) / "../docs";
  std::istringstream text(read_text(docs / "models.md") + read_text(docs / "experiments.md"));
  bool of_keys = false;
  int found = 0;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("|")) of_keys = false;
    if (line.starts_with("| key | value |") || line.starts_with("| key | shape |")) of_keys = true;
    if (!of_keys || !line.starts_with("| `")) continue;
    const std::string cell = line.substr(0, line.find(" |", 2));
    for (std::size_t from = 0; (from = cell.find('`', from)) != std::string::npos; ++found) {
      const std::size_t to = cell.find('`', from + 1);
      std::string key = cell.substr(from + 1, to - from - 1);
      key = key.substr(0, key.find(" = "));
      EXPECT_TRUE(known.contains(key.substr(key.rfind('.') + 1))) << key;
      from = to + 1;
    }
  }
  EXPECT_GT(found, 40);
}

TEST_F(Schema, EveryKeySaysWhatItIs) {
  for_each_table(experiment_keys(), "the top", [](const std::string& table, const TomlKeys& keys) {
    for (const TomlKey& key : keys) EXPECT_FALSE(key.about.empty()) << key.name << " of " << table;
  });
}

/// Looks for a described key in files, the schema, documents and records.
template <Described T>
void expect_everywhere(const std::string& schema, const std::string& docs) {
  const T value{};
  const RecordJson record = Recorder(true).object(value);
  const TomlKeys keys = keys_of<T>();
  int described = 0;
  for_each_field(value, [&](const FieldInfo& info, const auto&) {
    EXPECT_TRUE(record.contains(info.key)) << info.key;
    if (info.rule.form == Form::kNone || info.rule.form == Form::kMost) return;
    ++described;
    EXPECT_EQ(std::ranges::count(keys, info.key, &TomlKey::name), 1) << info.key;
    EXPECT_TRUE(holds(schema, "\"" + std::string(info.key) + "\": {")) << info.key;
    EXPECT_TRUE(holds(docs, "`" + std::string(info.key) + "`")) << info.key;
  });
  EXPECT_GT(described, 0);
}

template <Described... T>
void expect_all_everywhere() {
  const std::string docs = read_text(fs::path(DELQUAD_EXPERIMENTS) / "../docs/keys.md");
  (expect_everywhere<T>(experiment_schema(), docs), ...);
}

TEST_F(Schema, DescribedKeysAreEverywhere) {
  expect_all_everywhere<MeshProblem, SurfaceSpec, MirrorPlane, NamedPart, LayerSpec, SizeSpec, SizeSource,
                        NamedSize, MetricSpec, CurveDivision, PeriodicPair, SymmetryPlane, GridCorners,
                        WasherSpec, FilletRows, CircleShape, ArcShape, ExpressionShape, NamedShape,
                        EmbeddedShape, LoopShape, PatternShape, Criteria, Material, CaseOfStudy, AdaptLoop,
                        TablePlan, ExperimentKeys, Peer, MetricCommand, Hypothesis, MayFail>();
}

/// An independent checker of schemas: Python's jsonschema. Prints "file: good" or "file: bad".
constexpr const char* kChecker = R"(
import json, sys, tomllib, jsonschema
schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
checker = jsonschema.Draft202012Validator(schema)
for name in sys.argv[2:]:
    errors = [e.message for e in checker.iter_errors(tomllib.load(open(name, "rb")))]
    print(name, "bad" if errors else "good", *errors[:1], sep=": ")
)";

using SchemaPrograms = Schema;
TEST_F(SchemaPrograms, AgreesWithThePeersOfJsonSchema) {
  if (std::system("python3 -c 'import jsonschema, tomllib' 2>/dev/null") != 0)
    GTEST_SKIP() << "Python's jsonschema and tomllib are not installed";
  Strings arguments = {"-c", kChecker, write_text(folder_ / "schema.json", experiment_schema()).string()};
  std::string expected;
  const auto add = [&](const fs::path& file, const char* verdict) {
    arguments.push_back(file.string());
    expected += file.string() + ": " + verdict + "\n";
  };
  std::vector<fs::path> files;
  for (const char* folder : {"paper", "studies", "studies/on_suite", "suite", "peers"})
    for (const auto& entry : fs::directory_iterator(fs::path(DELQUAD_EXPERIMENTS) / folder))
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::ranges::sort(files);
  ASSERT_GT(files.size(), 10u);
  for (const fs::path& file : files) add(file, "good");
  const std::string square = "[[case]]\nname = 'a'\nsize = 1\nloop = { rectangle = [[0, 0], [1, 1]] }\n";
  const auto expect = [&](const std::string& name, const std::string& text, bool good) {
    const fs::path file = write_text(folder_ / (name + ".toml"), text);
    add(file, good ? "good" : "bad");
    EXPECT_EQ(good, [&] {
      try {
        Experiment::read(file);
        return true;
      } catch (const InputError&) {
        return false;
      }
    }()) << name;
  };
  expect("plain", square, true);
  expect("matrix",
         "[matrix]\nsize = [1, \"x\"]\ninsertion.h_max = [1.3]\n\"regularity.rounds\" = [2]\n" + square,
         true);
  expect("unknown", "titel = 'x'\n" + square, false);
  expect("unknown_inside", square + "insertion = { hmax = 1.3 }\n", false);
  expect("unknown_varied", "[matrix]\ncrosss = [1]\n" + square, false);
  expect("no_list", "[matrix]\nseed = 1\n" + square, false);
  expect("no_pairs", "pairs = []\n" + square, false);
  expect("solver_twice", "solver = ['poisson', 'poisson']\n" + square, false);
  expect("point_sets", "[linf_delaunay]\npoints = [10]\n" + square, false);
  expect("no_case", "title = 'x'\n", false);
  expect("no_name", "[[case]]\nloop = { rectangle = [[0, 0], [1, 1]] }\n", false);
  expect("bad_shape", "[[case]]\nname = 'a'\nloop = { rectangle = [[0, 0]] }\n", false);
  expect("peer_without_version", "[[peer]]\nname = 'p'\ncommand = ['p', '{input}', '{output}']\n" + square,
         false);
  const ProgramResult checked = run_program("/usr/bin/env", {[&] {
                                                               arguments.insert(arguments.begin(), "python3");
                                                               return arguments;
                                                             }(),
                                                             0,
                                                             {}});
  ASSERT_EQ(checked.exit_code, 0) << checked.err;
  std::string said;
  for (std::size_t at = 0, end; (end = checked.out.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = checked.out.substr(at, end - at);
    const std::string bad = ": bad";
    said += (line.find(bad) == std::string::npos ? line : line.substr(0, line.find(bad) + bad.size())) + "\n";
  }
  EXPECT_EQ(said, expected) << checked.out;
}

}  // namespace
}  // namespace delquad
