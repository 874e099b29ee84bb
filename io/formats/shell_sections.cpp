// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/formats/shell_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "base/sort_unique.h"
#include "base/text.h"
#include "io/cell_view.h"
#include "io/entity_names.h"
#include "io/formats/deck.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

/// Adds a material once; another one of its name has another name. Returns its name.
std::string add_material(ShellSections& all, ShellMaterial material) {
  const auto with_name = [&] {
    return std::ranges::find(all.materials, material.name, &ShellMaterial::name);
  };
  while (with_name() != all.materials.end() && *with_name() != material) material.name += '_';
  if (with_name() == all.materials.end()) all.materials.push_back(material);
  return material.name;
}

/// The numbers of the only line of data of a card; nothing if there are other lines or texts.
std::optional<std::vector<double>> only_row(const Deck& deck, const Deck::Card& card) {
  std::vector<std::string_view> rows;
  for (std::size_t at = card.data, next = 0; at < card.end; at = next) {
    next = std::min(deck.text.find('\n', at), deck.text.size() - 1) + 1;
    const std::string_view row = trimmed(std::string_view(deck.text).substr(at, next - at));
    if (!row.empty() && !row.starts_with("**")) rows.push_back(row);
  }
  if (rows.size() != 1) return std::nullopt;
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= rows[0].size();) {
    const std::size_t comma = std::min(rows[0].find(',', at), rows[0].size());
    const std::string_view field = trimmed(rows[0].substr(at, comma - at));
    const auto number = as_number(field);
    if (!number && !field.empty()) return std::nullopt;
    numbers.push_back(number.value_or(0));
    at = comma + 1;
  }
  return numbers;
}

/// A material and the keywords that hold it; `problem` is empty if it can be carried.
struct InpMaterial {
  ShellMaterial material = {};
  std::vector<std::string> keywords = {"*MATERIAL"};
  std::string problem = {};
};

std::map<std::string, InpMaterial> inp_materials(const Deck& deck) {
  std::map<std::string, InpMaterial> all;
  InpMaterial* last = nullptr;
  for (const Deck::Card& card : deck.cards) {
    if (card.name == "MATERIAL") {
      last = &all[upper(card.parameter("NAME"))];
      last->material.name = card.parameter("NAME");
    }
    if (last == nullptr || !card.is_among("|ELASTIC|DENSITY|")) continue;
    const auto row = only_row(deck, card);
    const std::string type = upper(card.parameter("TYPE"));
    if (!row)
      last->problem = fmt::format("its *{} is no single line of numbers", card.name);
    else if (card.name == "DENSITY")
      last->material.density = row->at(0);
    else if (!type.empty() && !type.starts_with("ISO"))
      last->problem = fmt::format("its *ELASTIC is of type {}", type);
    else
      last->material.young = row->at(0), last->material.poisson = row->size() > 1 ? row->at(1) : 0;
    last->keywords.push_back('*' + card.name);
  }
  for (auto& [name, material] : all)
    if (material.problem.empty() && !(material.material.young > 0))
      material.problem = "it has no *ELASTIC with a positive modulus";
  return all;
}

/// The regions of an element set; nothing if some of their elements are in no such set.
std::vector<int> regions_of_set(const Deck& deck, const std::string& set) {
  const auto members = deck.element_sets.find(set);
  if (members == deck.element_sets.end()) return {};
  std::vector<int> n_outside(deck.mesh.regions.size(), 0), regions;
  for (const Deck::Element& e : deck.elements)
    if (e.corners() > 2) ++n_outside[e.region];
  for (const int e : members->second) {
    if (deck.elements[e].corners() == 2) continue;
    --n_outside[deck.elements[e].region];
    regions.push_back(deck.elements[e].region);
  }
  sort_unique(regions);
  const bool are_whole = std::ranges::all_of(regions, [&](int r) { return n_outside[r] == 0; });
  return are_whole ? regions : std::vector<int>();
}

/// Returns why a PSHELL is no homogeneous shell; empty: it is one.
std::string problem_of_shell(const std::vector<double>& f) {
  const double material = f[1];
  if (!(f[2] > 0)) return "it has no thickness";
  if (f[3] != material) return "its material for bending (MID2) is not that for membranes (MID1)";
  if (f[4] != 0 && std::abs(f[4] - 1) > 1e-6) return "its bending stiffness has a factor (12I/T**3)";
  if (f[5] != 0 && f[5] != material) return "its material for shear (MID3) is not that for membranes (MID1)";
  return f[10] != 0 ? "it couples membrane and bending (MID4)" : "";
}

/// The material of a MAT1; Poisson's ratio or the modulus may follow from the shear modulus.
ShellMaterial nastran_material(const std::vector<double>& f) {
  ShellMaterial material = {fmt::format("material_{:.0f}", f[0]), f[1], f[3], f[4]};
  const double shear = f[2];
  if (material.young == 0) material.young = 2 * shear * (1 + material.poisson);
  if (material.poisson == 0 && shear > 0) material.poisson = material.young / (2 * shear) - 1;
  return material;
}

/// Fields of a card beyond `first` that have a value, by their names.
std::string other_fields(const Deck::Property& card, std::size_t first,
                         const std::vector<const char*>& names) {
  std::vector<std::string> found;
  for (std::size_t k = 0; k < names.size() && first + k < card.fields.size(); ++k)
    if (card.fields[first + k] != 0) found.emplace_back(names[k]);
  return first_of(found, found.size());
}

/// Names of materials by number, as add_nastran_sections() leaves them in comments.
std::map<double, std::string> told_materials(const std::string& text) {
  constexpr std::string_view kMark = "$ material ";
  std::map<double, std::string> names;
  for (std::size_t at = text.find(kMark); at != std::string::npos; at = text.find(kMark, at + 1)) {
    const std::string_view line =
        std::string_view(text).substr(at + kMark.size(), text.find('\n', at) - at - kMark.size());
    const std::size_t colon = line.find(": ");
    if (const auto number = as_number(line.substr(0, colon)); number && colon != std::string_view::npos)
      names[*number] = trimmed(line.substr(colon + 2));
  }
  return names;
}

/// The elements' regions, triangles first.
std::vector<int> regions_of_elements(const Mesh& mesh) {
  std::vector<int> regions = mesh.triangle_region;
  regions.insert(regions.end(), mesh.quad_region.begin(), mesh.quad_region.end());
  return regions;
}

std::string real_field(double x) { return std::string(trimmed(nastran_number(x))); }

}  // namespace

ShellSections inp_sections(const std::filesystem::path& path) {
  const Deck deck = read_inp_deck(path, false);
  const auto materials = inp_materials(deck);
  ShellSections all;
  std::set<std::string> used;
  for (const Deck::Card& card : deck.cards) {
    if (card.name != "SHELL SECTION") continue;
    const std::string set = card.parameter("ELSET");
    const auto material = materials.find(upper(card.parameter("MATERIAL")));
    const auto row = only_row(deck, card);
    const std::vector<int> regions = regions_of_set(deck, set);
    std::string problem;
    for (const auto& [key, value] : card.parameters)
      if (key != "ELSET" && key != "MATERIAL") problem = fmt::format("it has the parameter {}", key);
    if (problem.empty() && material == materials.end()) problem = "its *MATERIAL is not there";
    if (problem.empty()) problem = material->second.problem;
    if (problem.empty() && (!row || !(row->at(0) > 0)))
      problem = "its data are not one line with a thickness";
    if (problem.empty() && regions.empty())
      problem = "its set has no shells, or a part of a set that another name divides";
    if (!problem.empty()) {
      all.lost.push_back(fmt::format("*SHELL SECTION of {}: {}", set, problem));
      continue;
    }
    all.sections.push_back({regions, row->at(0), add_material(all, material->second.material)});
    ++all.carried["*SHELL SECTION"];
    if (used.insert(material->first).second)
      for (const std::string& keyword : material->second.keywords) ++all.carried[keyword];
  }
  return all;
}

ShellSections nastran_sections(const std::filesystem::path& path) {
  const Deck deck = read_nastran_deck(path, false);
  const auto told = told_materials(deck.text);
  std::map<double, const Deck::Property*> materials;
  for (const Deck::Property& card : deck.properties)
    if (card.name == "MAT1") materials.emplace(card.fields[0], &card);
  ShellSections all;
  std::set<double> used;
  for (const Deck::Property& card : deck.properties) {
    if (card.name != "PSHELL") continue;
    const auto& f = card.fields;
    const auto material = materials.find(f[1]);
    std::string problem = problem_of_shell(f);
    if (problem.empty() && material == materials.end()) problem = "its MAT1 is not there";
    ShellMaterial values =
        material == materials.end() ? ShellMaterial() : nastran_material(material->second->fields);
    if (problem.empty() && !(values.young > 0 && values.poisson > -1 && values.poisson <= 0.5))
      problem = "its MAT1 has no modulus (E) and Poisson's ratio (NU) that fit";
    ShellSections::Section section = {{}, f[2], ""};
    for (std::size_t r = 0; r < deck.mesh.regions.size(); ++r)
      if (deck.mesh.regions[r].tag == f[0]) section.regions.push_back(static_cast<int>(r));
    if (problem.empty() && section.regions.empty()) problem = "no element has it";
    if (!problem.empty()) {
      all.lost.push_back(fmt::format("PSHELL {:.0f}: {}", f[0], problem));
      continue;
    }
    if (const auto name = told.find(f[1]); name != told.end()) values.name = name->second;
    section.material = add_material(all, values);
    all.sections.push_back(std::move(section));
    ++all.carried["PSHELL"];
    if (const std::string others = other_fields(card, 6, {"TS/T", "NSM", "Z1", "Z2"}); !others.empty())
      all.lost.push_back(fmt::format("{} of PSHELL {:.0f}", others, f[0]));
    if (!used.insert(f[1]).second) continue;
    ++all.carried["MAT1"];
    if (const std::string others =
            other_fields(*material->second, 5, {"A", "TREF", "GE", "ST", "SC", "SS", "MCSID"});
        !others.empty())
      all.lost.push_back(fmt::format("{} of MAT1 {:.0f}", others, f[1]));
  }
  return all;
}

void add_inp_sections(const std::filesystem::path& path, const Mesh& mesh, ShellSections& sections) {
  std::vector<UniqueLabels::Key> names;
  for (const ShellMaterial& material : sections.materials) names.emplace_back(0, material.name);
  const UniqueLabels labels(names, {plain_label, true});
  for (const auto& [key, label] : labels.renamed())
    sections.lost.push_back(
        fmt::format("a name as it was: material \"{}\" is {}", one_line(key.second), label));
  std::string text = file_bytes(path);
  for (const ShellMaterial& m : sections.materials) {
    text += fmt::format("*MATERIAL, NAME={}\n*ELASTIC\n{}, {}\n", labels.of({0, m.name}),
                        inp_number(m.young, 0), inp_number(m.poisson, 0));
    if (m.density != 0) text += fmt::format("*DENSITY\n{}\n", inp_number(m.density, 0));
  }
  for (const ShellSections::Section& section : sections.sections)
    for (const int r : section.regions)
      text += fmt::format("*SHELL SECTION, ELSET={}, MATERIAL={}\n{}\n", tag_label(2, mesh.regions[r].tag),
                          labels.of({0, section.material}), inp_number(section.thickness, 0));
  write_text_file(path, std::string_view(text));
}

void add_nastran_sections(const std::filesystem::path& path, const Mesh& mesh, ShellSections& sections) {
  std::vector<int> section_of(mesh.regions.size(), -1);
  for (std::size_t s = 0; s < sections.sections.size(); ++s)
    for (const int r : sections.sections[s].regions) section_of[r] = static_cast<int>(s);
  const std::vector<int> property = group_numbers(mesh, mesh_groups(mesh, {one_line_label}), 2),
                         region = regions_of_elements(mesh);
  std::map<int, std::set<int>> sections_of;  // by property
  for (std::size_t e = 0; e < region.size(); ++e) sections_of[property[e]].insert(section_of[region[e]]);
  std::string cards;
  for (std::size_t m = 0; m < sections.materials.size(); ++m) {
    const ShellMaterial& material = sections.materials[m];
    cards += fmt::format("$ material {}: {}\nMAT1,{},{},,{}", m + 1, one_line(material.name), m + 1,
                         real_field(material.young), real_field(material.poisson));
    cards += material.density == 0 ? "\n" : fmt::format(",{}\n", real_field(material.density));
  }
  for (const auto& [pid, of_pid] : sections_of) {
    if (of_pid.size() > 1)
      sections.lost.push_back(
          fmt::format("the shell sections of property {}, whose elements have several", pid));
    if (of_pid.size() > 1 || *of_pid.begin() < 0) continue;
    const ShellSections::Section& section = sections.sections[*of_pid.begin()];
    const auto m = std::ranges::find(sections.materials, section.material, &ShellMaterial::name) -
                   sections.materials.begin() + 1;
    cards += fmt::format("PSHELL,{},{},{},{},,{}\n", pid, m, real_field(section.thickness), m, m);
  }
  std::string text = file_bytes(path);
  text.insert(std::min(text.rfind("ENDDATA"), text.size()), cards);
  write_text_file(path, std::string_view(text));
}

}  // namespace delquad
