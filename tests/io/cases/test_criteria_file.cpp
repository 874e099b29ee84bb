// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cases/case_file.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

Criteria read_sheet(const std::string& text) {
  const Folder folder;
  return read_criteria(write_text(folder / "sheet.toml", text).string());
}

const CriterionLimit* find(const Criteria& criteria, const std::string& key, const std::string& on = "") {
  for (const CriterionLimit& limit : criteria.limits)
    if (limit.key == key && limit.on == on) return &limit;
  return nullptr;
}

TEST(CriteriaFile, IsReadWhole) {
  const Criteria sheet = read_sheet(R"(preset = "batch"
min_length = 2
max_length = "1.5 size"
min_time_step = 1e-6
time_step_by = "radioss"
strict = true
material = { young = 210e3, poisson = 0.3, density = 7.85e-9 }
[[on]]
name = "rim"
min_length = "0.2 size"
)");
  EXPECT_EQ(sheet.name, "batch");
  EXPECT_EQ(find(sheet, "min_length")->value, 2);
  EXPECT_FALSE(find(sheet, "min_length")->in_sizes);
  EXPECT_EQ(find(sheet, "max_length")->value, 1.5);
  EXPECT_TRUE(find(sheet, "max_length")->in_sizes);
  EXPECT_EQ(find(sheet, "min_length", "rim")->value, 0.2);
  EXPECT_EQ(find(sheet, "max_aspect")->value, 5);
  EXPECT_EQ(sheet.time_step_by, "radioss");
  EXPECT_EQ(sheet.material->density, 7.85e-9);
  EXPECT_TRUE(sheet.strict);
  EXPECT_EQ(read_sheet("max_aspect = 3\n").name, "sheet");
}

TEST(CriteriaFile, IsAKeyOfModels) {
  const Folder folder;
  write_text(folder / "sheet.toml", "max_aspect = 3\n");
  const auto criteria_of = [&](const std::string& value) {
    return read_model_case(write_text(folder / "m.toml", "model = 'part.step'\ncriteria = " + value))
        .criteria;
  };
  EXPECT_EQ(criteria_of("\"static\"\n").name, "static");
  EXPECT_EQ(find(criteria_of("\"sheet.toml\"\n"), "max_aspect")->value, 3);
  EXPECT_EQ(find(criteria_of("{ min_angle = 30 }\n"), "min_angle")->value, 30);
}

TEST(CriteriaFile, MustBeThere) {
  expect_input_error([] { read_criteria("nowhere.toml"); }, {"nowhere.toml"});
}

}  // namespace
}  // namespace delquad
