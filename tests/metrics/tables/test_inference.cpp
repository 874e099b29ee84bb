// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/inference.h"
#include "metrics/tables/tables.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// A study made up: what each pipeline has on a domain, with a seed. No meshes.
struct Shape {
  Strings words;
  int domains, seeds;
  Strings measures = {"eta_mean", "eta_worst", "d4", "tau"};
  int copies = 1;  ///< cases of each domain, with its values
  bool has_ties = false;
  std::vector<Hypothesis> hypotheses = {};
};

using Value = std::function<double(int word, int domain, int seed)>;

/// Values of a study that is there, in the order of its records.
void draw(StudyResults& results, const Shape& shape, const Value& value) {
  const auto n_words = static_cast<int>(shape.words.size());
  auto record = results.records.begin();
  for (int c = 0; c < shape.domains * shape.copies; ++c)
    for (int s = 0; s < shape.seeds; ++s)
      for (int w = 0; w < n_words; ++w, ++record)
        for (const std::string& key : shape.measures)
          record->values[key] = c % shape.copies == 0 ? value(w, c / shape.copies, s)
                                                      : (record - shape.seeds * n_words)->values.at(key);
}

StudyResults make_study(const Shape& shape, const Value& value) {
  StudyResults results;
  results.study.title = "Made up";
  results.study.pipelines = shape.words;
  results.study.hypotheses = shape.hypotheses;
  for (int c = 0; c < shape.domains * shape.copies; ++c) {
    const std::string name = "domain" + std::to_string(c);
    results.study.cases.push_back(name);
    for (int s = 0; s < shape.seeds; ++s)
      for (const std::string& word : shape.words) {
        const std::string seed = std::to_string(s + 1);
        CellRecord record{name + "@seed=" + seed, word, "", {}};
        record.name = name;
        record.domain = "domain" + std::to_string(c - c % shape.copies);
        record.variant = {{"seed", seed}};
        record.values = {{"n_quads", 100}, {"n_triangles", 0}, {"seconds", 1}};
        results.records.push_back(record);
      }
  }
  results.study.cells = results.records.size();
  draw(results, shape, value);
  return results;
}

int planned_claims_of(const Inference& inference) {
  return static_cast<int>(std::ranges::count_if(inference.hypotheses(), [&](const PairComparison& h) {
    return inference.planned().finding(h.test) == Finding::kProven;
  }));
}

int claims_of(const StudyResults& results) {
  const Inference inference(results.study, results.records);
  int claims = 0;
  for (std::size_t i = 0; i < inference.family().size(); ++i)
    claims += inference.family().finding(i) == Finding::kProven;
  return claims + planned_claims_of(inference);
}

/// All that a table shows as proven.
int claims_of(const Table& table) {
  int claims = 0;
  for (const TableRow& row : table.rows) {
    const auto word = row.texts.find("first_is");
    claims += word != row.texts.end() && (word->second == "better" || word->second == "worse");
    claims += static_cast<int>(row.bold.size());
  }
  return claims;
}

int pair_claims_of(const StudyResults& results) {
  const Inference inference(results.study, results.records);
  return planned_claims_of(inference) +
         static_cast<int>(std::ranges::count_if(inference.pairs(), [&](const PairComparison& pair) {
           return inference.family().finding(pair.test) == Finding::kProven;
         }));
}

/// The number of studies without any effect that may claim something: 5 %. If the tests use all of their
/// 5 %, some standard errors are added.
struct Alike {
  int studies;
  double errors;
  int most_claiming() const {
    return static_cast<int>(std::ceil(0.05 * studies + errors * std::sqrt(0.05 * 0.95 * studies)));
  }
};
constexpr Alike kFew{200, 5}, kMany{1000, 3};  // many: `make test-long`

void PrintTo(const Shape& shape, std::ostream* out) {
  *out << shape.words.size() << " words, " << shape.domains << " domains, " << shape.seeds << " seeds, "
       << shape.copies << " copies";
}
const std::vector<Hypothesis> kPlan = {{"", "A", "B", {"eta_mean"}}, {"", "C", "B", {"eta_mean", "d4"}}};

/// Words that are alike on every domain: nothing at all may be claimed, anywhere.
void expect_few_claims(const Shape& shape, const Alike& alike) {
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  const Value value = [&](int, int, int) {
    return shape.has_ties ? std::round(normal(random)) : normal(random);
  };
  StudyResults study = make_study(shape, value);
  int claiming = 0;
  for (int k = 0; k < alike.studies; ++k, draw(study, shape, value)) claiming += claims_of(study) > 0;
  EXPECT_LE(claiming, alike.most_claiming());
}

/// Now the one, now the other is truly better on a domain, with all of its seeds, and none over domains.
/// Nothing may be claimed of pairs.
void expect_few_claims_of_pairs(const Shape& shape, const Alike& alike) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::map<std::pair<int, int>, double> leaning;  // of a word on a domain
  const Value value = [&](int word, int domain, int) {
    const auto [at, is_new] = leaning.try_emplace({word, domain});
    if (is_new) at->second = 3 * normal(random);
    return at->second + 0.3 * normal(random);
  };
  StudyResults study = make_study(shape, value);
  int claiming = 0;
  for (int k = 0; k < alike.studies; ++k, leaning.clear(), draw(study, shape, value))
    claiming += pair_claims_of(study) > 0;
  EXPECT_LE(claiming, alike.most_claiming());
}

class NoEffect : public testing::TestWithParam<Shape> {};
using NoEffectLong = NoEffect;

TEST_P(NoEffect, AtMostOneStudyInTwentyClaimsAnything) { expect_few_claims(GetParam(), kFew); }
TEST_P(NoEffect, SeedsOfOneDomainDoNotClaimAnythingOfPairs) { expect_few_claims_of_pairs(GetParam(), kFew); }
TEST_P(NoEffectLong, AtMostOneStudyInTwentyClaimsAnything) { expect_few_claims(GetParam(), kMany); }
TEST_P(NoEffectLong, SeedsOfOneDomainDoNotClaimAnythingOfPairs) {
  expect_few_claims_of_pairs(GetParam(), kMany);
}

const auto kShapes = testing::Values(Shape{{"A", "B", "C"}, 25, 4}, Shape{{"A", "B"}, 6, 8},
                                     Shape{{"A", "B"}, 12, 1}, Shape{{"A", "B", "C"}, 2, 20},
                                     Shape{{"A", "B"}, 1, 12}, Shape{{"A", "B"}, 8, 2, {"eta_mean"}, 4},
                                     Shape{{"A", "B", "C"}, 12, 3, {"eta_mean", "d4"}, 1, true},
                                     Shape{{"A", "B", "C"}, 12, 1, {"eta_mean", "d4"}, 1, false, kPlan},
                                     Shape{{"A", "B", "C"}, 6, 3, {"eta_mean", "d4"}, 1, true, kPlan});
INSTANTIATE_TEST_SUITE_P(Shapes, NoEffect, kShapes);
INSTANTIATE_TEST_SUITE_P(Shapes, NoEffectLong, kShapes);

TEST(Hypotheses, AreAllThatIsClaimed) {
  // Better by 1 in everything, C by 2; d4 of A is the other way round.
  StudyResults results = make_study({{"A", "B", "C"}, 12, 8, {"eta_mean", "d4"}, 1, false, {}},
                                    [](int word, int d, int s) { return word + 0.01 * d + 0.001 * s; });
  results.study.hypotheses = {{"", "B", "A", {"eta_mean", "d4"}}, {"", "A", "C", {"eta_mean"}}};
  const Outcome outcome = make_tables(results);
  ASSERT_EQ(outcome.hypotheses.rows.size(), 3u);
  const auto verdict = [&](std::size_t row) { return outcome.hypotheses.rows[row].texts.at("first_is"); };
  const auto p = [&](std::size_t row, const char* key) {
    return outcome.hypotheses.rows[row].values.at(key);
  };
  EXPECT_EQ(outcome.hypotheses.rows[0].group, "B better than A");
  EXPECT_EQ(verdict(0), "proven");
  EXPECT_EQ(verdict(1), "proven");
  EXPECT_DOUBLE_EQ(p(0, "p"), std::exp2(-11)) << "two-sided";
  EXPECT_DOUBLE_EQ(p(0, "p_corrected"), 3 * std::exp2(-11));
  EXPECT_EQ(outcome.hypotheses.rows[2].group, "A better than C");
  EXPECT_EQ(verdict(2), "refuted");
  // The rest would be proven a hundred times over.
  EXPECT_EQ(claims_of(outcome.table) + claims_of(outcome.pairs), 0);
  for (const TableRow& row : outcome.pairs.rows) EXPECT_EQ(row.texts.at("first_is"), "exploratory");
  EXPECT_TRUE(holds(to_markdown(outcome.pairs), "Exploratory: "));
  EXPECT_FALSE(holds(to_markdown(outcome.hypotheses), "Not planned"));
  results.study.plan_changed = true;
  const Outcome changed = make_tables(results);
  EXPECT_TRUE(holds(to_markdown(changed.hypotheses), "Not planned"));
  EXPECT_EQ(claims_of(changed.hypotheses), 0);
  EXPECT_EQ(changed.hypotheses.rows[0].texts.at("first_is"), "exploratory");
  EXPECT_TRUE(holds(changed.files.at("tables.tex"), "\\textbf{Not planned: "));
  results.study.plan_changed = false;
  for (CellRecord& record : results.records) record.values["d4"] = 90;
  EXPECT_EQ(make_tables(results).hypotheses.rows[1].texts.at("first_is"), "no difference");
}

TEST(Hypotheses, CountWhateverCameOfThem) {
  const auto table_of = [](int domains, Strings measures) {
    return make_tables(
               make_study({{"A", "B"}, domains, 1, {"eta_mean"}, 1, false, {{"", "B", "A", measures}}},
                          [](int word, int domain, int) { return word + 0.1 * domain; }))
        .hypotheses;
  };
  EXPECT_EQ(table_of(6, {"eta_mean"}).rows[0].texts.at("first_is"), "proven") << "p = 1/32";
  EXPECT_EQ(table_of(5, {"eta_mean"}).rows[0].texts.at("first_is"), "too few domains");
  const Table table = table_of(12, {"eta_mean", "no_such"});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[1].texts.at("first_is"), "too few domains") << "no record has it";
}

/// With one pair and one measure the only test is Wilcoxon's of twelve normal differences with a mean of 0.8
/// deviations: its power at 5 % is 0.669 by 200 000 draws with NumPy.
constexpr double kPower = 0.669;
constexpr int kStudies = 600;
constexpr double kTolerance = 0.06;  // three standard errors of the part of so many studies

TEST(Inference, FindsEffectsOverDomainsAsOftenAsComputed) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Shape shape = {{"A", "B"}, 12, 4, {"eta_mean"}};
  int found = 0;
  for (int study = 0; study < kStudies; ++study) {
    double lean = 0;
    const auto value = [&](int word, int, int seed) {
      if (word == 0 && seed == 0) lean = 0.8 + std::sqrt(0.75) * normal(random);
      return word == 0 ? lean + normal(random) : 0;  // of four seeds: a variance of 0.25
    };
    const StudyResults results = make_study(shape, value);
    const Inference inference(results.study, results.records);
    ASSERT_EQ(inference.pairs().size(), 1u);
    found += inference.family().finding(inference.pairs()[0].test) == Finding::kProven;
  }
  EXPECT_NEAR(double(found) / kStudies, kPower, kTolerance);
}

TEST(Inference, SeedsOfOneDomainAreNoSampleOfDomains) {
  // Better on the one domain, with every one of thirty seeds; a little worse on the other.
  const StudyResults results =
      make_study({{"A", "B"}, 2, 30, {"eta_mean"}}, [](int word, int domain, int seed) {
        return word == 0 ? (domain == 0 ? 0.1 : -0.01) + 1e-4 * seed : 0;
      });
  const Outcome outcome = make_tables(results);
  ASSERT_EQ(outcome.pairs.rows.size(), 1u);
  const TableRow& row = outcome.pairs.rows[0];
  EXPECT_EQ(row.texts.at("first_is"), "too few domains");
  EXPECT_EQ(row.values.at("domains"), 2);
  EXPECT_EQ(row.values.at("runs"), 60);
  EXPECT_EQ(row.values.at("better"), 1) << "the second; first minus second is B - A";
  EXPECT_TRUE(row.bold.empty());
  EXPECT_TRUE(holds(to_markdown(outcome.pairs), "fewer than 6 domains nothing can be proven"));
}

TEST(Inference, PairsSayWhatIsProvenWithEffectAndInterval) {
  const StudyResults results = make_study(
      {{"A", "B"}, 12, 2, {"eta_mean"}},
      [](int word, int domain, int seed) { return word == 1 ? 0.02 + 0.001 * domain + 0.0001 * seed : 0; });
  const Outcome outcome = make_tables(results);
  ASSERT_EQ(outcome.pairs.rows.size(), 1u);
  const TableRow& row = outcome.pairs.rows[0];
  EXPECT_EQ(row.name, "eta mean");
  EXPECT_EQ(row.texts.at("first_is"), "better");
  EXPECT_NEAR(row.values.at("effect"), 0.02 + 0.0055 + 0.00005, 1e-12);
  EXPECT_LT(row.values.at("low"), row.values.at("effect"));
  EXPECT_GT(row.values.at("low"), 0.02);
  EXPECT_GT(row.values.at("high"), row.values.at("effect"));
  EXPECT_DOUBLE_EQ(row.values.at("p"), std::exp2(-11));
  EXPECT_EQ(to_markdown(outcome.pairs), to_markdown(make_tables(results).pairs)) << "the same bytes";
}

/// Nine names of one rectangle, on which B is better: one domain, of which nothing is proven.
TEST(Inference, CopiesOfADomainAreTheSameDomain) {
  const StudyResults results = make_study({{"A", "B"}, 1, 2, {"eta_mean"}, 9},
                                          [](int word, int, int seed) { return word + 0.01 * seed; });
  const Inference inference(results.study, results.records);
  EXPECT_TRUE(inference.pairs().empty());
  EXPECT_EQ(claims_of(results), 0);
}

TEST(Inference, SizesOfADomainAreTheSameDomain) {
  StudyResults results =
      make_study({{"A", "B"}, 2, 4, {"eta_mean"}}, [](int word, int, int) { return word == 0 ? 1 : 0.5; });
  const std::vector<CellRecord> fine = results.records;
  for (CellRecord record : fine) {
    record.variant.insert(record.variant.begin(), {"size", "0.1"});
    record.group = record.name + "@size=0.1,seed=" + record.variant[1].second;
    results.records.push_back(record);
  }
  const Inference inference(results.study, results.records);
  ASSERT_EQ(inference.pairs().size(), 1u);
  EXPECT_EQ(inference.pairs()[0].domains.names.size(), 2u);
  EXPECT_EQ(inference.pairs()[0].domains.runs, 16u);
}

/// Half of the cells with another option: more of eta by a hundredth of the domain's number.
TEST(Inference, OptionsAreComparedAsPipelinesAre) {
  StudyResults results = make_study({{"A", "B", "G"}, 12, 2, {"eta_mean", "tau"}},
                                    [](int word, int, int seed) { return word + 0.3 * seed; });
  const std::vector<CellRecord> plain = results.records;
  for (CellRecord& record : results.records) record.variant.insert(record.variant.begin(), {"cross", "x"});
  for (CellRecord record : plain) {
    record.variant.insert(record.variant.begin(), {"cross", "y"});
    record.values["eta_mean"] += 0.01 * std::stoi(record.name.substr(6));
    results.records.push_back(record);
  }
  for (CellRecord& record : results.records) {
    record.group = record.name + "@cross=" + record.variant[0].second + ",seed=" + record.variant[1].second;
    if (record.pipeline == "G") record.values["n_triangles"] = 1;
  }
  results.study.axes = {{"cross", {"x", "y"}}, {"seed", {"1", "2"}}};
  const std::size_t of_words = Inference(results.study, results.records).pairs().size();
  results.study.pairs = {"cross"};
  results.study.hypotheses = {{"cross", "y", "x", {"eta_mean"}}};
  const Inference inference(results.study, results.records);
  ASSERT_EQ(inference.pairs().size(), of_words + 2);
  const PairComparison &eta = inference.pairs()[of_words], &tau = inference.pairs()[of_words + 1];
  EXPECT_EQ(eta.first + " " + eta.second, "cross=y cross=x");
  EXPECT_EQ(eta.domains.runs, 48u) << "without the word that leaves triangles";
  EXPECT_EQ(tau.domains.runs, 72u);
  for (std::size_t d = 0; d < 12; ++d)
    EXPECT_NEAR(eta.domains.differences[d], 0.01 * static_cast<double>(d), 1e-12);
  ASSERT_EQ(inference.hypotheses().size(), 1u);
  EXPECT_DOUBLE_EQ(inference.planned().test(0).p, std::exp2(-10)) << "one domain has no difference";
}

/// Better by 1 on each of twelve domains, but for those on which it crashes.
StudyResults study_with_crashes(const std::vector<int>& of_first, const std::vector<int>& of_second) {
  StudyResults results = make_study({{"B", "A"}, 12, 1, {"eta_mean"}},
                                    [](int word, int domain, int) { return word + 0.01 * domain; });
  for (const auto& [word, domains] : {std::pair("A", of_first), {"B", of_second}})
    for (CellRecord& record : results.records)
      if (record.pipeline == word && std::ranges::count(domains, std::stoi(record.name.substr(6))) > 0) {
        record.values.clear();
        record.reason = record.kind = "crash";
      }
  return results;
}

TEST(Failures, WhoFailsLoses) {
  for (const bool is_planned : {false, true}) {
    StudyResults results = study_with_crashes({0, 1, 2, 3, 4, 5, 6}, {});
    if (is_planned) results.study.hypotheses = {{"", "A", "B", {"eta_mean"}}};
    const Outcome outcome = make_tables(results);
    const TableRow& row = (is_planned ? outcome.hypotheses : outcome.pairs).rows.at(0);
    EXPECT_EQ(row.texts.at("first_is"), "not proven") << "better on five, and failed on seven";
    EXPECT_EQ(row.values.at("first_failed"), 7);
    EXPECT_EQ(row.values.at("worse"), 7);
    EXPECT_EQ(row.values.at("domains"), 12);
    EXPECT_DOUBLE_EQ(row.values.at("effect"), 1);
    EXPECT_EQ(claims_of(outcome.summary), 0);
  }
}

TEST(Failures, ClaimsSayHowManyAndAreNeverBold) {
  for (const bool is_planned : {false, true}) {
    StudyResults results = study_with_crashes({3}, {5, 6});
    if (is_planned) results.study.hypotheses = {{"", "A", "B", {"eta_mean"}}};
    const Outcome outcome = make_tables(results);
    const Table& table = is_planned ? outcome.hypotheses : outcome.pairs;
    const std::string failures = "A failed on 1, B failed on 2";
    EXPECT_EQ(table.rows.at(0).texts.at("first_is"), (is_planned ? "proven (" : "better (") + failures + ")");
    EXPECT_TRUE(holds(to_markdown(outcome.summary), "B (" + failures + ")"));
    for (const Table* one : {&table, &outcome.summary})
      for (const TableRow& row : one->rows) EXPECT_TRUE(row.bold.empty()) << row.name;
    const std::string& tex = outcome.files.at("tables.tex");
    EXPECT_FALSE(holds(tex, "\\textbf"));
    EXPECT_TRUE(holds(tex, "B (A failed on 1, B failed on 2)", "1/2"));
  }
}

TEST(Failures, DomainsOnWhichBothFailAreLeftOutAndNamed) {
  const Outcome outcome = make_tables(study_with_crashes({2, 4}, {2, 4, 7}));
  EXPECT_EQ(outcome.pairs.rows.at(0).values.at("domains"), 10);
  EXPECT_EQ(outcome.pairs.rows[0].texts.at("first_is"), "better (B failed on 1)");
  const std::string note = "A and B both failed on domain2, domain4: left out";
  EXPECT_TRUE(holds(to_markdown(outcome.pairs), note));
  EXPECT_TRUE(holds(outcome.files.at("tables.tex"), note));
}

/// A measure that the case has not, and a mesh that nobody made yet, are no failures.
TEST(Failures, WhatIsNotThereForBothIsNone) {
  StudyResults results = study_with_crashes({}, {});
  for (CellRecord& record : results.records) {
    if (record.name == "domain3") record.values.erase("eta_mean");
    if (record.name != "domain4" || record.pipeline != "A") continue;
    record.values.clear();
    record.reason = record.kind = kNotApplicable;
    record.skipped = true;
  }
  const TableRow row = make_tables(results).pairs.rows.at(0);
  EXPECT_EQ(row.values.at("domains"), 10);
  EXPECT_EQ(row.values.at("first_failed") + row.values.at("second_failed"), 0);
  EXPECT_EQ(row.texts.at("first_is"), "better");
}

/// Ranks prove what the mean does not: nothing is claimed beside an interval with 0.
TEST(Inference, ClaimsAndIntervalsAgree) {
  const Outcome outcome =
      make_tables(make_study({{"B", "A"}, 12, 1, {"eta_mean"}}, [](int word, int domain, int) {
        return word == 0 ? 0 : domain == 0 ? -0.8 : 0.1 + 0.001 * domain;
      }));
  const TableRow& row = outcome.pairs.rows.at(0);
  EXPECT_LT(row.values.at("p_corrected"), 0.05);
  EXPECT_LT(row.values.at("low"), 0);
  EXPECT_GT(row.values.at("high"), 0);
  EXPECT_EQ(row.texts.at("first_is"), "not proven");
  EXPECT_TRUE(row.bold.empty());
}

TEST(Domains, AreGeometriesOrWhatCasesSay) {
  StudyFile study;
  study.cases = {"a", "b", "c", "d", "e", "f"};
  study.geometry = {{"a", {"", "", {1, 2}}},
                    {"b", {"", "", {1 + 1e-7, 2}}},
                    {"c", {"", "x", {}}},
                    {"d", {"own", "x", {}}},
                    {"e", {"", "x", {}}}};
  EXPECT_EQ(domains_of(study),
            (std::map<std::string, std::string>{
                {"a", "a"}, {"b", "a"}, {"c", "c"}, {"d", "own"}, {"e", "c"}, {"f", "f"}}));
}

TEST(Pairs, WordsThatLeaveTrianglesDoNotCompeteInMeasuresOfQuads) {
  StudyResults results = make_study({{"A", "B", "G"}, 12, 20, {"eta_mean", "tau"}},
                                    [](int word, int, int seed) { return word + 0.001 * seed; });
  for (CellRecord& record : results.records)
    if (record.pipeline == "G") record.values["n_triangles"] = 7;
  for (const TableRow& row : make_tables(results).pairs.rows)
    EXPECT_FALSE(row.group.find('G') != row.group.npos && row.name == "eta mean") << row.group;
}

TEST(Notes, SayThatFewDomainsProveNothing) {
  const auto pairs_of = [](int domains, int seeds) {
    return to_markdown(
        make_tables(make_study({{"A", "B"}, domains, seeds, {"eta_mean"}}, [](int word, int, int seed) {
          return word + 0.001 * seed;
        })).pairs);
  };
  const std::string few = "fewer than 6 domains nothing can be proven", seeds = pairs_of(2, 20),
                    cases = pairs_of(12, 1);
  EXPECT_TRUE(holds(seeds, few));
  EXPECT_FALSE(holds(seeds, "Holm"));
  EXPECT_TRUE(holds(cases, "Corrected (Holm) over 1 test,"));
  EXPECT_FALSE(holds(cases, few));
}

TEST(Notes, SayWhichWordLeavesTrianglesAndWhere) {
  StudyResults results = make_study({{"A", "B", "G", "H"}, 12, 2, {"eta_mean", "tau"}},
                                    [](int word, int, int seed) { return word + 0.001 * seed; });
  for (CellRecord& record : results.records) {
    if (record.pipeline == "G" && record.name.size() == 7) record.values["n_triangles"] = 7;
    if (record.pipeline == "H" && record.group == "domain11@seed=2") record.values["n_triangles"] = 1;
    if (record.pipeline == "H" && record.name == "domain3") record.values["n_quads"] = 0;
  }
  const Outcome outcome = make_tables(results);
  const std::string g =
      "G leaves triangles in 10 of 12 cases (domain0, domain1, domain2, domain3, domain4 and 5 more): ";
  const std::string h = "H leaves triangles in 1 of 11 cases (domain11): ";
  for (const auto print : {to_markdown, to_json}) {
    const std::string table = print(outcome.table), pairs = print(outcome.pairs);
    EXPECT_TRUE(holds(table, g + "measures of quads (eta, d4 and the like) leave these triangles out",
                      h + "measures of quads"));
    EXPECT_TRUE(holds(pairs, g + "no pair with it is compared in measures of quads (eta, d4",
                      h + "no pair with it",
                      "H made no quads on one case (domain3): it failed there in pairs"));
    EXPECT_FALSE(holds(pairs, "A made no quads"));
    EXPECT_FALSE(holds(table, "A leaves"));
  }
}

TEST(Times, OneRunOfEachSaysNothing) {
  StudyResults results =
      make_study({{"A", "B"}, 12, 12}, [](int word, int, int) { return 0.5 + 0.1 * word; });
  for (CellRecord& record : results.records) record.values["seconds"] = record.pipeline == "A" ? 1 : 100;
  const Outcome outcome = make_tables(results);
  for (const TableRow& row : outcome.pairs.rows) EXPECT_NE(row.name, "s");
}

TEST(Columns, TellWhereIrregularVerticesLieOnceAStageLessensThem) {
  for (const char* word : {"DBCO", "DBCQO"}) {
    const StudyResults results = make_study({{"DB", word}, 1, 1}, [](int w, int, int) { return w; });
    const std::vector<TableColumn> columns = table_columns(results.study, results.records);
    for (const char* key : {"n_irregular", "n_irregular_on_curves", "n_necessary", "n_beyond"})
      EXPECT_EQ(std::ranges::count(columns, key, &TableColumn::key), word == std::string("DBCQO")) << key;
  }
}

TEST(Rows, SayHowManyRunsTheyAreOfAndHowManyFailed) {
  StudyResults results = make_study({{"A", "B"}, 1, 4}, [](int word, int, int seed) { return word + seed; });
  results.records[0].reason = "no way";
  for (CellRecord& record : results.records)
    if (record.pipeline == "B") record.reason = "neither";
  const Outcome outcome = make_tables(results);
  for (const std::string& text : {to_markdown(outcome.table), to_tex(outcome.table)}) {
    EXPECT_TRUE(holds(text, "A (1 of 4 failed)", "failed", "neither", "no way"));
  }
  EXPECT_EQ(outcome.table.rows[0].values.at(kRuns), 3);
  EXPECT_EQ(outcome.table.rows[1].values.at(kRuns), 0);
}

}  // namespace
}  // namespace delquad
