// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/read_record.h"
#include "io/digest.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// Before other tests add some.
const std::vector<OptionGroup> kOptionGroups = option_groups();

/// Gives all lists one element and all that is optional a value, then changes one part of a problem.
class Change {
 public:
  /// `part`: the number of the part; -1: none.
  Change(fs::path folder, int part) : folder_(std::move(folder)), left_(part) {}

  /// Nothing changed: there are fewer parts.
  bool is_done() const { return key_.empty(); }
  const std::string& key() const { return key_; }
  bool has_result() const { return has_result_; }
  bool in_memory() const { return in_memory_; }

  void of(Case& c) {
    object(static_cast<MeshProblem&>(c), "", true);
    object(static_cast<CaseOfStudy&>(c), "", true);
  }
  /// The model alone.
  void of(Model& model) { part(model, ".model", true); }

 private:
  template <Described T>
  void object(T& value, const std::string& path, bool counts) {
    for_each_field(value, [&](const FieldInfo& info, auto& member) {
      part(member, path + "." + info.key, counts && info.rule.no_result == nullptr);
    });
  }
  template <class T>
  void part(T& value, const std::string& key, bool counts) {
    if constexpr (Described<T>) {
      object(value, key, counts);
    } else if constexpr (std::is_same_v<T, bool>) {
      leaf(key, counts, [&] { value = !value; });
    } else if constexpr (std::is_enum_v<T>) {
      leaf(key, counts, [&] { value = static_cast<T>(static_cast<int>(value) + 1); });
    } else if constexpr (std::is_arithmetic_v<T>) {
      leaf(key, counts, [&] { value += 1; });
    } else {
      other(value, key, counts);
    }
  }
  void other(std::string& text, const std::string& key, bool counts) {
    if (text.empty()) text = "a";
    leaf(key, counts, [&] { text += "b"; });
  }
  void other(fs::path& file, const std::string& key, bool counts) {
    file = write_text(folder_ / "a.stl", "some content");
    leaf(key, counts, [&] { file = write_text(folder_ / "b.stl", "other content"); });
  }
  void other(Vec2& p, const std::string& key, bool counts) {
    for (double* x : {&p.x, &p.y}) part(*x, key, counts);
  }
  void other(Vec3& p, const std::string& key, bool counts) {
    for (double* x : {&p.x, &p.y, &p.z}) part(*x, key, counts);
  }
  template <class T>
  void other(std::vector<T>& list, const std::string& key, bool counts) {
    list.resize(1);
    part(list[0], key, counts);
    leaf(key, counts, [&] { list.push_back(list[0]); });
  }
  template <class T, std::size_t N>
  void other(std::array<T, N>& list, const std::string& key, bool counts) {
    for (T& value : list) part(value, key, counts);
  }
  template <class A, class B>
  void other(std::pair<A, B>& pair, const std::string& key, bool counts) {
    part(pair.first, key, counts);
    part(pair.second, key, counts);
  }
  template <class T>
  void other(std::optional<T>& value, const std::string& key, bool counts) {
    part(value.emplace(), key, counts);
    leaf(key, counts, [&] { value.reset(); });
  }
  void other(std::map<std::string, std::string>& map, const std::string& key, bool counts) {
    leaf(key, counts, [&] { map["a"] = "b"; });
  }
  void other(Model& model, const std::string& key, bool counts) {
    std::visit([&](auto& one) { object(one, key, counts); }, model);
    leaf(key, counts, [&] { model.index() == 0 ? void(model = LineModel()) : void(model = PlanarModel()); });
  }
  void other(std::shared_ptr<const Curve>& curve, const std::string& key, bool counts) {
    curve = make_segment({0, 0}, {1, 0});
    leaf(key, counts, [&] { curve = make_segment({0, 0}, {1, 1e-15}); });
    leaf(
        key, counts,
        [&] {
          curve = make_parametric_curve([](double t) { return Vec2{t, 0}; }, 0, 1);
        },
        true);
  }
  void other(Mesh& mesh, const std::string& key, bool counts) {
    leaf(
        key, counts, [&] { mesh.points.emplace_back(); }, true);
  }
  void other(DeclaredSurfaces& all, const std::string& key, bool counts) {
    leaf(
        key, counts, [&] { all.surfaces.emplace_back(); }, true);
  }
  void other(std::shared_ptr<const SizeField>& field, const std::string& key, bool counts) {
    leaf(
        key, counts, [&] { field = make_constant_size(1); }, true);
  }
  void other(std::shared_ptr<const CrossField>& field, const std::string& key, bool counts) {
    leaf(
        key, counts, [&] { field = make_function_cross([](Vec2) { return 0.0; }, "f"); }, true);
  }
  void other(std::shared_ptr<const MetricPlane>&, const std::string&, bool counts) {
    EXPECT_FALSE(counts) << "only prepare() can make it";
  }
  template <class R, class... T>
  void other(std::function<R(T...)>& function, const std::string& key, bool counts) {
    leaf(
        key, counts, [&] { function = [](T...) { return R(); }; }, true);
  }
  void other(Options& options, const std::string& key, bool counts) {
    for (const OptionGroup& group : kOptionGroups)
      for (const OptionKey& option : group.keys) {
        if (allowed_values(option).size() == 1) continue;  // parts from outside add others
        const std::string name = group.name + "." + option.name;
        leaf(key + "." + name, counts, [&] { set_other(options, name, option); });
      }
  }
  static void set_other(Options& options, const std::string& name, const OptionKey& option) {
    std::vector<OptionValue> values = allowed_values(option);
    values.insert(values.end(), {true, false, 1LL, 2LL, 16LL, 0.01, 0.3, 1.25, 2.5, 15.0, std::string("x")});
    for (const OptionValue& value : values) {
      try {
        if (Options().set(name, value).value(name) == Options().value(name)) continue;
        options.set(name, value);
        return;
      } catch (const InputError&) {  // of another type, or beyond the limits
      }
    }
    ADD_FAILURE() << name << ": no other value was found";
  }

  void leaf(const std::string& key, bool counts, const std::function<void()>& change,
            bool in_memory = false) {
    if (left_-- != 0) return;
    change();
    key_ = key;
    has_result_ = counts;
    in_memory_ = in_memory;
  }

  fs::path folder_;
  int left_;
  std::string key_;
  bool has_result_ = false, in_memory_ = false;
};

/// Reads the case of a record, with files in a folder.
Case case_of(const RecordJson& record, const fs::path& folder) {
  const RecordReader reader([&](const fs::path&, const std::string& digest) {
    for (const auto& entry : fs::directory_iterator(folder))
      if (file_digest(entry.path()) == digest) return entry.path();
    throw InputError("there is no such file");
  });
  Case c;
  reader.object<MeshProblem>(record, c);
  reader.object<CaseOfStudy>(record, c);
  return c;
}

const std::vector<Model> kModels = {PlanarModel(), LineModel(),    TriangleModel(), GivenMesh(),
                                    CadModel(),    ExampleModel(), ModelFile()};

TEST(ProblemRecord, EveryFieldThatCountsIsInTheDigest) {
  const Folder folder;
  int parts = 0, ignored = 0, functions = 0;
  ASSERT_EQ(kModels.size(), std::variant_size_v<Model>);
  const auto change_all = [&](const Model& model, const auto& of) {
    Case c;
    c.model = model;
    Change none(folder / "", -1);
    of(none, c);
    const ProblemRecord before = record_of(c);
    EXPECT_TRUE(before.in_memory.empty());
    std::map<std::string, std::string> digests = {{before.digest(), "nothing"}};
    for (int part = 0;; ++part) {
      Case other = c;
      Change change(folder / "", part);
      of(change, other);
      if (change.is_done()) break;
      const ProblemRecord record = record_of(other);
      EXPECT_EQ(record.digest() != before.digest(), change.has_result()) << change.key();
      EXPECT_EQ(!record.in_memory.empty(), change.in_memory()) << change.key();
      if (change.has_result() && !change.in_memory()) {
        EXPECT_TRUE(digests.emplace(record.digest(), change.key()).second)
            << change.key() << " and " << digests[record.digest()];
      }
      if (change.in_memory() || std::holds_alternative<CadModel>(other.model))  // whose bytes are in memory
        EXPECT_THROW(case_of(record.json, folder / ""), InputError) << change.key();
      else
        EXPECT_EQ(record_of(case_of(record.json, folder / "")).json, record.json) << change.key();
      ++parts;
      ignored += !change.has_result();
      functions += change.in_memory();
    }
  };
  for (const Model& model : kModels) change_all(model, [](Change& change, Case& c) { change.of(c.model); });
  change_all(PlanarModel(), [](Change& change, Case& c) { change.of(c); });
  EXPECT_GT(parts, 200);
  EXPECT_GT(ignored, 25);
  EXPECT_GE(functions, 12);
}

TEST(ProblemRecord, CurvesAreReadAsTheyWere) {
  const std::vector<Vec2> drop = {{0, 0}, {2, -0.5}, {3, 0.1}, {2, 0.5}, {0, 0}};
  std::vector<Vec2> turned = drop;
  turned.pop_back();
  std::ranges::rotate(turned, turned.begin() + 2);
  turned.push_back(turned[0]);
  for (const auto& curve :
       {make_segment({0, 0.1}, {1, 1e-300}), make_polyline(drop), make_spline(drop), make_spline(turned, 1.8),
        make_spline({{0, 0}, {1, 1}, {2, -0.0}}, 2), make_circle({1.0 / 3, 2}, 1e5),
        make_arc({0, 0}, 0.1, 2, -1), make_expression_curve("cos(t) + t^2", "sin(t) > 0 ? t : 1", 0.1, 3)}) {
    Case c;
    c.model = PlanarModel{"m", {{curve, "wall", "m:1"}}, {}};
    const Case read = case_of(record_of(c).json, {});
    const auto& same = std::get<PlanarModel>(read.model).curves.at(0).shape;
    for (int i = 0; i <= 1000; ++i) {
      const Vec2 p = curve->point(i / 1000.0), q = same->point(i / 1000.0);
      EXPECT_TRUE(p == q) << record_of(c).json.at("model") << " at " << i;
    }
    EXPECT_EQ(curve->fixed_parameters(), same->fixed_parameters());
  }
}

/// Where a file lies, what it is called and how a number is spelled change nothing.
TEST(ProblemRecord, PlacesAndSpellingsDoNotCount) {
  const Folder folder;
  Case c, moved;
  c.model = ModelFile{write_text(folder / "a.stl", "content")};
  fs::create_directories(folder / "other");
  moved.model = ModelFile{write_text(folder / "other/b.stl", "content")};
  c.size.text = "0.10";
  moved.size.text = "1e-1";
  moved.where = "other.toml:3";
  EXPECT_EQ(record_of(c).digest(), record_of(moved).digest());
  moved.model = ModelFile{write_text(folder / "other/b.stl", "contents")};
  EXPECT_NE(record_of(c).digest(), record_of(moved).digest());
}

/// A size counts by the content of its file, and the part of it that is read.
TEST(ProblemRecord, FilesOfSizesCountByContent) {
  const Folder folder;
  const auto digest_with = [&](const std::string& content, const std::string& text) {
    Case c;
    write_text(folder / "size.msh", content);
    c.size = {.text = text, .folder = folder / ""};
    return record_of(c).digest();
  };
  const std::string one = digest_with("one", "size.msh:h");
  EXPECT_EQ(one, digest_with("one", "size.msh:h"));
  EXPECT_NE(one, digest_with("other", "size.msh:h"));
  EXPECT_NE(one, digest_with("one", "size.msh:k"));
  fs::create_directories(folder / "far");
  EXPECT_EQ(one,
            (fs::rename(folder / "size.msh", folder / "far/size.msh"), digest_with("one", "far/size.msh:h")));
  Case c;
  c.size = {.text = "far/size.msh: h", .folder = folder / ""};
  const Case read = case_of(record_of(c).json, folder / "far");
  EXPECT_EQ(read.size.folder / "size.msh", folder / "far/size.msh");
  EXPECT_EQ(record_of(read).digest(), record_of(c).digest());
}

TEST(ProblemRecord, CurvesCountByTheirDefinition) {
  const auto record = [](const std::shared_ptr<const Curve>& curve) {
    return record_of(ModelCurve{curve, "", ""});
  };
  const std::string flat = "0", bent = "max(0, 0.02 - abs(t - 0.5))";
  EXPECT_EQ(record(make_expression_curve("t", flat, 0, 1)), record(make_expression_curve("t", flat, 0, 1)));
  EXPECT_NE(record(make_expression_curve("t", flat, 0, 1)), record(make_expression_curve("t", bent, 0, 1)));
  EXPECT_NE(record(make_circle({0, 0}, 1)), record(make_circle({0, 0}, 1 + 1e-15)));
  const std::vector<Vec2> points = {{0, 0}, {1, 1}, {2, 0}};
  EXPECT_NE(record(make_spline(points, 2)), record(make_spline(points, 0.5))) << "with a corner";
  EXPECT_NE(record(make_spline(points)), record(make_polyline(points)));
  const std::vector<Vec2> drop = {{0, 0}, {2, -0.5}, {3, 0}, {2, 0.5}, {0, 0}};
  EXPECT_NE(record(make_spline(drop, 2.4)), record(make_spline(drop, 3.1))) << "with a corner at its end";
}

TEST(ProblemRecord, GivenKeysAreThoseThatDifferFromDefaults) {
  SurfaceSpec surface;
  EXPECT_TRUE(given_keys(surface).empty());
  surface.where = "a.toml:1";
  surface.glue = true;
  surface.weld_tolerance = 1e-6;
  EXPECT_EQ(given_keys(surface), (Strings{"weld_tolerance", "glue"}));
  EXPECT_FALSE(are_same(surface, SurfaceSpec()));
}

}  // namespace
}  // namespace delquad
