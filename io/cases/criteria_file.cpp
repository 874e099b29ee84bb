#include "io/cases/criteria_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/located.h"
#include "io/cases/case_keys.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

void read_limits(const TomlTable& table, const std::string& on, Criteria& criteria) {
  for (const Criterion& criterion : criterion_registry())
    if (table.has(criterion.key))
      criteria.set(criterion.key, table.expression(criterion.key), on, table.where(criterion.key));
}

const Criteria& preset_named(const std::string& name, const std::string& where) {
  const auto at = std::ranges::find(criteria_presets(), name, &Criteria::name);
  if (at != criteria_presets().end()) return *at;
  std::vector<std::string> known;
  for (const Criteria& preset : criteria_presets()) known.push_back(preset.name);
  throw InputError(fmt::format("{}: unknown criteria '{}': expected {} or a .toml file{}", where, name,
                               fmt::join(known, ", "), suggestion(name, known)));
}

Criteria read_table(const TomlTable& table) {
  table.require_known(criteria_keys());
  Criteria criteria;
  if (table.has("preset")) criteria = preset_named(table.text("preset"), table.where("preset"));
  criteria.name = table.text("name", criteria.name);
  criteria.where = table.where();
  read_limits(table, "", criteria);
  for (const TomlTable& part : table.tables("on")) {
    part.require_known(named_criteria_keys());
    read_limits(part, part.text("name"), criteria);
    part.finish(named_criteria_keys());
  }
  if (const auto material = table.optional_table("material")) {
    material->require_known(material_keys());
    criteria.material = Material{material->positive_number("young"), material->number("poisson"),
                                 material->positive_number("density")};
    material->finish(material_keys());
  }
  criteria.time_step_by = table.text("time_step_by", criteria.time_step_by);
  criteria.strict = table.flag("strict", false);
  table.finish(criteria_keys());
  if (criteria.empty()) throw InputError(table.where() + ": no criteria: expected a preset or limits");
  check_criteria(criteria);
  return criteria;
}

Criteria read_text(const std::string& text, const std::filesystem::path& folder, const std::string& where) {
  if (kind_of_file(text) != ".toml") return preset_named(text, where);
  const std::filesystem::path file = folder / text;
  Criteria criteria = read_table(TomlTable::read(file));
  if (criteria.name.empty()) criteria.name = file.stem().string();
  return criteria;
}

}  // namespace

Criteria read_criteria(const std::string& preset_or_file) {
  return read_text(preset_or_file, {}, "criteria");
}

Criteria read_criteria_key(const TomlTable& table) {
  if (table.kind("criteria") == TomlKind::kTable) return read_table(table.table("criteria"));
  const std::string where = table.where("criteria");
  return located(where, [&] { return read_text(table.text("criteria"), table.file().parent_path(), where); });
}

}  // namespace delquad
