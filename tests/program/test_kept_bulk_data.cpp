// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

/// Bulk data as an independent reader finds it.
struct ReadBulk {
  struct Element {
    std::string type;
    int property;
    std::vector<int> nodes;
    std::string angle;
  };
  std::map<int, std::array<double, 3>> nodes;
  std::map<int, std::string> last_fields;  ///< of nodes
  std::map<int, Element> elements;
  std::vector<Strings> cards;         ///< all others, with their names
  std::map<int, std::set<int>> sets;  ///< of case control
};

Strings fields_of(const std::string& line) {
  Strings fields;
  const auto add = [&](std::string field) {
    field.erase(0, field.find_first_not_of(" \r"));
    fields.push_back(field.substr(0, field.find_last_not_of(" \r") + 1));
  };
  if (line.find(',') != std::string::npos) {
    std::stringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) add(field);
    return fields;
  }
  add(line.substr(0, 8));
  const std::size_t width = line.substr(0, 8).find('*') == std::string::npos ? 8 : 16;
  for (std::size_t at = 8; at < line.size() && at < 72; at += width) add(line.substr(at, width));
  fields.resize(width == 8 ? 9 : 5);
  return fields;
}

ReadBulk read_bulk(const fs::path& path) {
  ReadBulk bulk;
  std::vector<Strings> cards;
  std::stringstream lines(read_text(path));
  bool in_bulk = false;
  std::string set;
  for (std::string line; std::getline(lines, line) && line.substr(0, 7) != "ENDDATA";) {
    if (line.substr(0, 4) == "SET " || (!set.empty() && set.back() == ',')) {
      set += line;
      if (set.back() == ',') continue;
      std::stringstream members(set.substr(set.find('=') + 1));
      for (std::string member; std::getline(members, member, ',');)
        bulk.sets[std::stoi(set.substr(4))].insert(std::stoi(member));
      set.clear();
    }
    const bool begins = line.substr(0, 5) == "BEGIN";
    if (line[0] == '$' || begins || !in_bulk) {
      in_bulk |= begins;
      continue;
    }
    const Strings fields = fields_of(line);
    if (fields[0].empty() || fields[0][0] == '*' || fields[0][0] == '+')
      cards.back().insert(cards.back().end(), fields.begin() + 1, fields.end());
    else
      cards.push_back(fields);
  }
  for (Strings& card : cards) {
    std::erase(card[0], '*');
    card.resize(std::max<std::size_t>(card.size(), 9));
    if (card[0] == "GRID") {
      const int number = std::stoi(card[1]);
      EXPECT_TRUE(
          bulk.nodes.emplace(number, std::array{std::stod(card[3]), std::stod(card[4]), std::stod(card[5])})
              .second);
      bulk.last_fields[number] = card[6] + ',' + card[7];
    } else if (card[0] == "CQUAD4" || card[0] == "CTRIA3") {
      const std::size_t n = card[0] == "CQUAD4" ? 4 : 3;
      ReadBulk::Element e{card[0], std::stoi(card[2]), {}, card[3 + n]};
      for (std::size_t k = 0; k < n; ++k) e.nodes.push_back(std::stoi(card[3 + k]));
      EXPECT_TRUE(bulk.elements.emplace(std::stoi(card[1]), e).second) << card[1];
    } else {
      while (card.back().empty()) card.pop_back();
      bulk.cards.push_back(card);
    }
  }
  return bulk;
}

std::vector<Strings> cards_of(const ReadBulk& bulk, const std::string& name) {
  std::vector<Strings> found;
  for (const auto& card : bulk.cards)
    if (card[0] == name) found.push_back(card);
  return found;
}

constexpr int kAcross = 12, kUp = 8;
int node_at(int i, int j) { return 101 + 3 * (j * (kAcross + 1) + i); }
std::string node(int i, int j) { return std::to_string(node_at(i, j)); }

/// A plate of 12 x 8 units with moved nodes, bent to a roof. The right third looks down. Each element has an
/// angle, so that its material looks along x.
std::string bulk_plate(const std::string& more, const std::string& last = "") {
  std::string text = "SOL 101\nCEND\nDISP = 4\nSTRESS(PLOT) = 5\nSET 4 = " + node(5, 5) +
                     "\nSET 5 = 1001 THRU 1006," + "\n 1013 THRU 1018\nSPC = 1\nBEGIN BULK\n";
  std::map<std::pair<int, int>, std::array<double, 2>> at;
  char line[128];
  for (int j = 0; j <= kUp; ++j)
    for (int i = 0; i <= kAcross; ++i) {
      const bool inside = i > 0 && i < kAcross && j > 0 && j < kUp;
      const double x = i + (inside ? 0.3 * std::sin(7.0 * i + 3.0 * j) : 0),
                   y = j + (inside ? 0.3 * std::cos(5.0 * i - 4.0 * j) : 0);
      at[{i, j}] = {x, y};
      std::snprintf(line, sizeof line, "GRID    %-8d        %-8.5f%-8.5f%-8.5f%s\n", node_at(i, j), x, y,
                    0.1 * y, last.c_str());
      text += line;
    }
  text += "GRID,9000,,6.,4.,20.\n";
  for (int j = 0, e = 1001; j < kUp; ++j)
    for (int i = 0; i < kAcross; ++i, ++e) {
      std::array<std::pair<int, int>, 4> v = {{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
      if (3 * i >= 2 * kAcross) std::swap(v[1], v[3]);
      const double x = at[v[1]][0] - at[v[0]][0], y = std::sqrt(1.01) * (at[v[1]][1] - at[v[0]][1]);
      const double angle = (3 * i >= 2 * kAcross ? 1 : -1) * std::atan2(y, x) * 180 / std::numbers::pi;
      std::snprintf(line, sizeof line, "CQUAD4,%d,7,%d,%d,%d,%d,%.3f\n", e, node_at(v[0].first, v[0].second),
                    node_at(v[1].first, v[1].second), node_at(v[2].first, v[2].second),
                    node_at(v[3].first, v[3].second), angle);
      text += line;
    }
  return text + "PSHELL,7,1,.5\nMAT8,1,2.+5,1.+4,.3,5.+3\n" + more + "ENDDATA\nleft as it is\n";
}

std::string loads_and_others() {
  std::string text = "CBUSH,2000,8,9000," + node(3, 3) + "\nPBUSH,8,K,1.+3\nCBAR    2001    9       " +
                     node(9, 2) + "     " + node(9, 3) + "     " + node(9, 5) + "\nPBARL,9,1,,ROD\n,0.1\n" +
                     "RBE2,2002," + node(4, 6) + ",123456," + node(6, 6) + "\n" + "SPC1,1,123456," +
                     node(0, 0) + ",THRU," + node(0, 0) + "\nSPC1,1,3," + node(10, 4) + "," + node(10, 5) +
                     "\nFORCE,2," + node(7, 4) + ",0,1.,0.,0.,1.\n" + "SPC1,1,6," + node(0, 0) + ",THRU," +
                     node(kAcross, kUp) + "\n" + "PLOAD2,2,.5,1001,THRU,1048\n" + "PLOAD1,2,1054,FX\n";
  for (int e = 1001; e <= 1096; ++e)
    if ((e - 1001) % kAcross < 6) text += "PLOAD4,2," + std::to_string(e) + ",1.5\n";
  return text;
}

/// Twice the area of an element, as a vector.
std::array<double, 3> area_of(const ReadBulk& bulk, const std::vector<int>& v) {
  std::array<double, 3> a{}, b{};
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = bulk.nodes.at(v[2])[k] - bulk.nodes.at(v[0])[k];
    b[k] = bulk.nodes.at(v.back())[k] - bulk.nodes.at(v[1])[k];
  }
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The area that a set of elements has from above, with its sign.
double area_of(const ReadBulk& bulk, const std::set<int>& elements) {
  double sum = 0;
  for (const int e : elements) sum += area_of(bulk, bulk.elements.at(e).nodes)[2] / 2;
  return sum;
}

std::set<int> loaded(const ReadBulk& bulk, const std::string& name) {
  std::set<int> elements;
  for (const auto& card : cards_of(bulk, name)) {
    const std::size_t first = name == "PLOAD4" ? 2 : 3;
    if (card.size() > first + 1 && card[first + 1] == "THRU")
      for (int e = std::stoi(card[first]); e <= std::stoi(card[first + 2]); ++e) elements.insert(e);
    else
      for (std::size_t k = first; k < (name == "PLOAD4" ? 3 : card.size()); ++k)
        EXPECT_TRUE(elements.insert(std::stoi(card[k])).second);
  }
  return elements;
}

TEST(KeptBulkData, ConvertingKeepsEveryByte) {
  const TemporaryFolder folder;
  write_text(folder / "a.bdf", bulk_plate(loads_and_others()));
  ASSERT_EQ(delquad({"convert", folder / "a.bdf", "-o", folder / "b.nas"}).err, "");
  EXPECT_EQ(read_text(folder / "b.nas"), read_text(folder / "a.bdf"));
}

TEST(KeptBulkData, ImprovingKeepsAllButTheMesh) {
  const TemporaryFolder folder;
  write_text(folder / "a.bdf", bulk_plate(loads_and_others(), "               6"));
  const auto result = delquad({"improve", folder / "a.bdf", "-o", folder / "b.bdf"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const ReadBulk before = read_bulk(folder / "a.bdf"), after = read_bulk(folder / "b.bdf");
  for (const char* name : {"CBUSH", "CBAR", "RBE2", "FORCE", "PSHELL", "PBARL", "MAT8", "PLOAD1"})
    EXPECT_EQ(cards_of(after, name), cards_of(before, name)) << name;
  EXPECT_TRUE(holds(read_text(folder / "b.bdf"), "ENDDATA\nleft as it is\n"));
  EXPECT_EQ(after.sets.at(4), before.sets.at(4));
  int moved = 0;
  std::set<int> used = {9000, node_at(9, 5)};
  for (const auto& [number, e] : after.elements) {
    used.insert(e.nodes.begin(), e.nodes.end());
    const bool stays = before.elements.contains(number);
    moved += !stays;
    EXPECT_TRUE(stays || number > 2002) << number;
    if (stays) {
      EXPECT_EQ(e.nodes, before.elements.at(number).nodes);
    }
    EXPECT_EQ(e.type, "CQUAD4");
    EXPECT_EQ(e.property, 7);
    // The material looks along x.
    const auto &p = after.nodes.at(e.nodes[0]), &q = after.nodes.at(e.nodes[1]);
    const double sign = area_of(after, e.nodes)[2] > 0 ? 1 : -1;
    const double angle = std::stod(e.angle) * std::numbers::pi / 180 +
                         sign * std::atan2(std::sqrt(1.01) * (q[1] - p[1]), q[0] - p[0]);
    EXPECT_NEAR(std::cos(angle), 1, 1e-4) << number;
  }
  EXPECT_GT(moved, 30);
  for (const auto& [number, at] : after.nodes) {
    EXPECT_TRUE(used.contains(number)) << number;
    const bool stays = before.nodes.contains(number);
    EXPECT_TRUE(stays || number > 9000) << number;
    if (stays) {
      EXPECT_EQ(at, before.nodes.at(number));
    }
    EXPECT_EQ(after.last_fields.at(number), number == 9000 ? "," : ",6") << number;
  }
  for (const int v :
       {node_at(3, 3), node_at(9, 2), node_at(5, 5), node_at(4, 6), node_at(6, 6), node_at(10, 4)})
    EXPECT_TRUE(used.contains(v)) << v;
  EXPECT_TRUE(after.nodes.contains(node_at(9, 5))) << "the beam looks there";
  EXPECT_TRUE(after.elements.contains(1054));
  for (const char* name : {"PLOAD2", "PLOAD4"}) {
    EXPECT_NE(loaded(after, name), loaded(before, name));
    EXPECT_NEAR(area_of(after, loaded(after, name)), area_of(before, loaded(before, name)), 1e-3) << name;
  }
  const std::vector<Strings> fixed = cards_of(after, "SPC1");
  ASSERT_EQ(fixed.size(), 3u);
  EXPECT_EQ(fixed[1], cards_of(before, "SPC1")[1]);
  std::set<int> of_all;
  for (std::size_t k = 3; k < fixed[2].size(); ++k)
    if (!fixed[2][k].empty()) of_all.insert(std::stoi(fixed[2][k]));
  used.erase(9000);
  EXPECT_EQ(of_all, used) << "the set of all nodes has the new ones, too";
}

TEST(KeptBulkData, KeepsLineEndsAndFieldsOfEveryKind) {
  const TemporaryFolder folder;
  std::string text = bulk_plate(loads_and_others());
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\r\n");
  write_text(folder / "a.bdf", text);
  const std::string more = "PLOAD4* 2               1001            1.5\n*\n";
  write_text(folder / "c.bdf", bulk_plate(more));
  for (const char* name : {"a.bdf", "c.bdf"}) {
    const auto result = delquad({"improve", folder / name, "-o", folder / "b.bdf"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string improved = read_text(folder / "b.bdf");
    EXPECT_EQ(std::ranges::count(improved, '\r'), name[0] == 'a' ? std::ranges::count(improved, '\n') : 0);
    EXPECT_EQ(delquad({"metrics", folder / "b.bdf"}).exit_code, 0);
  }
}

TEST(KeptBulkData, RefusesWhatItCannotKeep) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> cards[] = {
      {"INCLUDE 'more.bdf'\n", "INCLUDE"},
      {"GRID,9001,5,0.,0.,0.\n", "coordinate system '5'"},
      {"=,*(1),=,=,=,=\n", "a card that repeats the one before"},
      {"SPC1    1       123     101                                                     +A1\n+A2     104\n",
       "goes on with 'A2' behind one that ends with 'A1'"},
      {"SPC1,1,123,1,2,3,4,5,6,7,8\n", "more than 10 fields"},
      {"CQUAD4,1001,7,101,104,107,110\n", "element 1001 is there twice"}};
  for (const auto& [card, why] : cards) {
    write_text(folder / "a.bdf", bulk_plate(card));
    const auto result = delquad({"improve", folder / "a.bdf", "-o", folder / "b.bdf"});
    EXPECT_EQ(result.exit_code, 2) << card;
    EXPECT_TRUE(holds(result.err, why, "a.bdf:2"));
  }
}

/// Two plates of 2 x 2 elements. Nodes 7, 8, 9 of the left one lie at 11, 12, 13 of the right.
std::string two_plates_of_bulk(const std::string& more) {
  std::string text = "BEGIN BULK\n";
  for (int body = 0; body < 2; ++body) {
    for (int k = 0; k < 9; ++k)
      text += "GRID," + std::to_string(1 + 10 * body + k) + ",," + std::to_string(2 * body + k / 3) + ".," +
              std::to_string(k % 3) + ".," + std::to_string(body * (k / 3)) + ".\n";
    for (int k = 0; k < 4; ++k) {
      const int v = 1 + 10 * body + k + k / 2;
      text += "CQUAD4," + std::to_string(1 + 10 * body + k) + ",1";
      for (const int n : {v, v + 3, v + 4, v + 1}) text += ',' + std::to_string(n);
      text += ",3\n";
    }
  }
  return text + more + "ENDDATA\n";
}

TEST(KeptBulkData, WeldingKeepsThePlacesInSets) {
  const TemporaryFolder folder;
  write_text(folder / "a.bdf",
             two_plates_of_bulk("CBAR,30,2,11,19,0.,0.,1.\nSPC1,1,123,11,12,13,19\nPLOAD2,1,2.,11\n"));
  write_text(folder / "c.bdf", two_plates_of_bulk("FORCE,1,12,0,1.,0.,0.,1.\n"));
  const Strings weld = {"convert", folder / "a.bdf", folder / "b.bdf", "--weld", "1e-6"};
  ASSERT_EQ(delquad(weld).exit_code, 0);
  const ReadBulk bulk = read_bulk(folder / "b.bdf");
  EXPECT_EQ(bulk.nodes.size(), 15u);
  EXPECT_EQ(bulk.elements.at(11).nodes, (std::vector{7, 14, 15, 8}));
  EXPECT_EQ(bulk.elements.at(11).angle, "3");
  const auto first = [&](const char* name) { return cards_of(bulk, name).at(0); };
  EXPECT_EQ(first("CBAR"), (Strings{"CBAR", "30", "2", "7", "19", "0.", "0.", "1."}));
  EXPECT_EQ(first("SPC1"), (Strings{"SPC1", "1", "123", "7", "8", "9", "19"}));
  EXPECT_EQ(first("PLOAD2"), (Strings{"PLOAD2", "1", "2.", "11"}));
  const auto refused = delquad({"convert", folder / "c.bdf", folder / "d.bdf", "--weld", "1e-6"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(holds(refused.err, "c.bdf:28: --weld would join node 12 to node 8, but this line of FORCE"));
}

TEST(KeptBulkData, OtherFormatsTellWhatTheyLose) {
  const TemporaryFolder folder;
  write_text(folder / "a.bdf", bulk_plate(loads_and_others() + "CTETRA,3000,9,101,104,107,9000\n"));
  for (const char* command : {"convert", "improve"}) {
    const auto result = delquad({command, folder / "a.bdf", "-o", folder / "b.inp"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, "CTETRA (1)", "FORCE (1)", "PLOAD4 (48)", "SPC1 (3)"));
    EXPECT_TRUE(
        holds(read_text(folder / "b.inp"), command[0] == 'c' ? "ELSET=region_7" : "ELSET=property_7"));
  }
  EXPECT_TRUE(holds(delquad({"metrics", folder / "a.bdf"}).err, "note: CTETRA is not read"));
}

}  // namespace
}  // namespace delquad::testing_support
