// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/program/program.h"

namespace delquad::testing_support {
namespace {

/// A deck as an independent reader finds it: it knows nodes, elements of four nodes, sets and other lines.
struct ReadDeck {
  std::map<int, std::array<double, 3>> nodes;
  std::map<int, std::vector<int>> elements;
  std::map<int, std::string> types;
  std::map<std::string, std::set<int>> nsets, elsets;
  Strings surface_rows, others;
};

Strings split(const std::string& line) {
  Strings fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) {
    field.erase(0, field.find_first_not_of(" \r"));
    if (!field.empty()) fields.push_back(field.substr(0, field.find_last_not_of(" \r") + 1));
  }
  return fields;
}

ReadDeck read_deck(const fs::path& path) {
  ReadDeck deck;
  std::map<std::string, std::string> parameters;
  std::string keyword;
  std::stringstream lines(read_text(path));
  for (std::string line; std::getline(lines, line);) {
    const Strings fields = split(line);
    if (line[0] == '*' && line[1] != '*') {
      keyword = fields[0];
      parameters.clear();
      for (const std::string& field : fields)
        parameters[field.substr(0, field.find('='))] =
            field.find('=') == std::string::npos ? "" : field.substr(field.find('=') + 1);
    }
    const bool is_data = line[0] != '*';
    const auto members = [&](std::set<int>& set, const std::map<std::string, std::set<int>>& sets) {
      if (parameters.contains("GENERATE"))
        for (int i = std::stoi(fields[0]); i <= std::stoi(fields[1]); i += std::stoi(fields[2]))
          set.insert(i);
      else
        for (const std::string& field : fields)
          if (sets.contains(field))
            set.insert(sets.at(field).begin(), sets.at(field).end());
          else
            set.insert(std::stoi(field));
    };
    if (is_data && keyword == "*NODE") {
      deck.nodes[std::stoi(fields[0])] = {std::stod(fields[1]), std::stod(fields[2]), std::stod(fields[3])};
      if (parameters.contains("NSET")) deck.nsets[parameters["NSET"]].insert(std::stoi(fields[0]));
    } else if (is_data && keyword == "*ELEMENT") {
      const int number = std::stoi(fields[0]);
      EXPECT_FALSE(deck.elements.contains(number)) << number;
      for (std::size_t k = 1; k < fields.size(); ++k) deck.elements[number].push_back(std::stoi(fields[k]));
      deck.types[number] = parameters["TYPE"];
      deck.elsets[parameters["ELSET"]].insert(number);
    } else if (is_data && keyword == "*NSET") {
      members(deck.nsets[parameters["NSET"]], deck.nsets);
    } else if (is_data && keyword == "*ELSET") {
      members(deck.elsets[parameters["ELSET"]], deck.elsets);
    } else if (is_data && keyword == "*SURFACE") {
      deck.surface_rows.push_back(line);
    } else if (keyword != "*NODE" && keyword != "*ELEMENT" && keyword != "*NSET" && keyword != "*ELSET") {
      deck.others.push_back(line);
    }
  }
  return deck;
}

constexpr int kColumns = 12, kRows = 8;
int node_number(int i, int j) { return 101 + 3 * (j * (kColumns + 1) + i); }

/// A plate of 12 x 8 units with moved nodes. The right third looks down, and `bend` rolls all up.
std::string plate(const std::string& type, double bend, const std::string& more) {
  std::string text = "*HEADING\nby hand\n*NODE, NSET=EVERY\n";
  for (int j = 0; j <= kRows; ++j)
    for (int i = 0; i <= kColumns; ++i) {
      const bool inside = i > 0 && i < kColumns && j > 0 && j < kRows;
      const double x = i + (inside ? 0.3 * std::sin(7.0 * i + 3.0 * j) : 0),
                   y = j + (inside ? 0.3 * std::cos(5.0 * i - 4.0 * j) : 0);
      const double at[] = {bend > 0 ? std::sin(bend * x) / bend : x, y,
                           bend > 0 ? std::cos(bend * x) / bend : 0};
      text += std::to_string(node_number(i, j));
      for (const double c : at) text += ", " + std::to_string(c);
      text += '\n';
    }
  text += "*NODE\n9000, 6, 4, 20\n*ELEMENT, TYPE=" + type + ", ELSET=PLATE\n";
  for (int j = 0, e = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i) {
      int v[] = {node_number(i, j), node_number(i + 1, j), node_number(i + 1, j + 1), node_number(i, j + 1)};
      if (bend > 0 && 3 * i >= 2 * kColumns) std::swap(v[1], v[3]);
      text += std::to_string(1001 + e++);
      for (const int n : v) text += ", " + std::to_string(n);
      text += '\n';
    }
  return text + more;
}

/// Sets, elements and loads that hang on nodes and elements in all ways.
std::string hangers() {
  const auto node = [](int i, int j) { return std::to_string(node_number(i, j)); };
  return "** of the left half\n*ELSET, ELSET=LEFT, GENERATE\n1001, 1006, 1\n1013, 1018, 1\n"
         "*ELSET, ELSET=SOME\nLEFT\n1096\n"
         "*ELEMENT, TYPE=SPRINGA, ELSET=SPRING\n2000, 9000, " +
         node(3, 3) +
         "\n"
         "*ELEMENT, TYPE=B31, ELSET=BEAM\n2001, " +
         node(9, 2) + ", " + node(9, 3) +
         "\n"
         "*NSET, NSET=CLAMP, GENERATE\n" +
         node(0, 0) + ", " + node(0, kRows) +
         ", 39\n"
         "*NSET, NSET=SENSOR\n" +
         node(5, 5) +
         ",\n"
         "*NSET, NSET=LOADED\n" +
         node(7, 4) + "\n" + node(8, 4) +
         "\n"
         "*ELSET, ELSET=_RIM_E3\n1096\n1095\n*SURFACE, NAME=RIM, TYPE=ELEMENT\n_RIM_E3, E3\n"
         "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*SHELL SECTION, ELSET=PLATE, MATERIAL=STEEL\n0.5\n"
         "*EQUATION\n2\n" +
         node(4, 6) + ", 3, 1., " + node(6, 6) +
         ", 3, -1.\n"
         "*STEP\n*STATIC\n*BOUNDARY\nCLAMP, 1, 6\n" +
         node(10, 4) +
         ", 2, 2, 0.1\n*CLOAD\nLOADED, 3, -1.\n"
         "*DLOAD\nPLATE, P, 0.01\n1054, P, 0.5\n*NODE PRINT, NSET=EVERY\nU\n*END STEP\n";
}

/// Twice the area of an element, as a vector.
std::array<double, 3> area_of(const ReadDeck& deck, const std::vector<int>& v) {
  std::array<double, 3> a{}, b{};
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = deck.nodes.at(v[2])[k] - deck.nodes.at(v[0])[k];
    b[k] = deck.nodes.at(v[3])[k] - deck.nodes.at(v[1])[k];
  }
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The sum of the areas of a set as seen along x and z, with their signs.
std::array<double, 2> area_of(const ReadDeck& deck, const std::string& set) {
  std::array<double, 2> sum{};
  for (const int e : deck.elsets.at(set)) {
    const auto area = area_of(deck, deck.elements.at(e));
    sum[0] += area[0] / 2;
    sum[1] += area[2] / 2;
  }
  return sum;
}

/// The ends of the sides of the only surface, as their elements run.
std::set<std::pair<int, int>> sides_of_rim(const ReadDeck& deck) {
  std::set<std::pair<int, int>> sides;
  for (const std::string& row : deck.surface_rows) {
    const Strings fields = split(row);
    const std::size_t k = static_cast<std::size_t>(fields[1][1] - '1');
    const std::set<int> elements =
        deck.elsets.contains(fields[0]) ? deck.elsets.at(fields[0]) : std::set<int>{std::stoi(fields[0])};
    for (const int e : elements) sides.emplace(deck.elements.at(e)[k], deck.elements.at(e)[(k + 1) % 4]);
  }
  return sides;
}

TEST(KeptDecks, ConvertingKeepsEveryByte) {
  const Folder folder;
  write_text(folder / "a.inp", plate("S4R", 0.1, hangers()));
  ASSERT_EQ(delquad({"convert", folder / "a.inp", folder / "b.inp"}).err, "");
  EXPECT_EQ(read_text(folder / "b.inp"), read_text(folder / "a.inp"));
  write_mesh(folder / "c.inp", curved_grid(3, 2, 2, false));  // of eight nodes
  ASSERT_EQ(delquad({"convert", folder / "c.inp", folder / "d.inp"}).err, "");
  EXPECT_EQ(read_text(folder / "d.inp"), read_text(folder / "c.inp"));
}

TEST(KeptDecks, SetsOfAnAssemblyStayThere) {
  const Folder folder;
  const std::string part =
      "*Part, name=P\n" +
      plate("S4", 0, "*End Part\n*Assembly, name=A\n*Instance, name=P-1, part=P\n*End Instance\n");
  const std::string set = "*Elset, elset=TOP,\n instance=P-1, generate\n1001, 1096, 1\n";
  write_text(folder / "a.inp", part + set + "*End Assembly\n");
  ASSERT_EQ(delquad({"improve", folder / "a.inp", "-o", folder / "b.inp"}).exit_code, 0);
  const std::string text = read_text(folder / "b.inp");
  const std::size_t of_set = text.find("*ELSET, ELSET=TOP, INSTANCE=P-1\n"), end = text.find("*End Assembly");
  ASSERT_NE(of_set, std::string::npos) << text;
  EXPECT_GT(of_set, text.find("*End Instance"));
  EXPECT_EQ(split(text.substr(of_set + 32, end - of_set - 32)).size(),
            96u - 5u);  // a comma short on five lines
  write_text(folder / "c.inp", part + "*Elset, elset=plate, instance=P-1\n1001\n*End Assembly\n");
  const auto refused = delquad({"improve", folder / "c.inp", "-o", folder / "d.inp"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(holds(refused.err, "set PLATE is in a part and in its assembly"));
}

TEST(KeptDecks, ImprovingKeepsAllButTheMesh) {
  for (const double bend : {0.0, 0.1}) {
    const Folder folder;
    write_text(folder / "a.inp", plate("S4", bend, hangers()));
    const auto result = delquad({"improve", folder / "a.inp", "-o", folder / "b.inp"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, "inner nodes and elements that stay, as lines or sets name them: "));
    const ReadDeck before = read_deck(folder / "a.inp"), after = read_deck(folder / "b.inp");
    EXPECT_EQ(after.others, before.others);
    for (const char* set : {"CLAMP", "SENSOR", "LOADED"})
      EXPECT_EQ(after.nsets.at(set), before.nsets.at(set)) << set;
    // Numbers that stay have their place, and others lie above.
    int moved = 0;
    std::set<int> used;
    for (const auto& [number, v] : after.elements) {
      used.insert(v.begin(), v.end());
      moved += !before.elements.contains(number);
      if (before.elements.contains(number)) {
        EXPECT_EQ(v, before.elements.at(number));
      }
      EXPECT_TRUE(before.elements.contains(number) || number > 2001) << number;
      EXPECT_EQ(after.types.at(number), number == 2000 ? "SPRINGA" : number == 2001 ? "B31" : "S4");
    }
    EXPECT_GT(moved, 50);
    for (const auto& [number, at] : after.nodes) {
      EXPECT_TRUE(used.contains(number)) << number;
      EXPECT_EQ(after.nsets.at("EVERY").contains(number), number != 9000) << number;
      if (before.nodes.contains(number)) {
        EXPECT_EQ(at, before.nodes.at(number));
      }
      EXPECT_TRUE(before.nodes.contains(number) || number > 9000) << number;
    }
    for (const int v :
         {node_number(3, 3), node_number(9, 2), node_number(5, 5), node_number(4, 6), node_number(10, 4)})
      EXPECT_TRUE(used.contains(v)) << v;
    EXPECT_EQ(after.elements.at(1054), before.elements.at(1054));
    for (const char* set : {"PLATE", "LEFT", "SOME"})
      for (const int k : {0, 1}) EXPECT_NEAR(area_of(after, set)[k], area_of(before, set)[k], 0.02) << set;
    EXPECT_EQ(sides_of_rim(after), sides_of_rim(before));
    EXPECT_EQ(sides_of_rim(after).size(), 2u);
  }
}

TEST(KeptDecks, SetsOfSidesOfOurFilesFollow) {
  const Folder folder;
  write_text(folder / "a.inp", plate("S4", 0.1, ""));
  ASSERT_EQ(delquad({"convert", folder / "a.inp", folder / "a.msh"}).exit_code, 0);
  Mesh mesh = read_mesh(folder / "a.msh");
  mesh.curves = {{1, {"rim"}}};
  for (int i = 0; i < kColumns; ++i) mesh.lines.push_back({i, i + 1}), mesh.line_curve.push_back(0);
  write_mesh(folder / "b.inp", mesh);
  ASSERT_EQ(delquad({"improve", folder / "b.inp", "-o", folder / "c.inp"}).exit_code, 0);
  const ReadDeck before = read_deck(folder / "b.inp"), after = read_deck(folder / "c.inp");
  const auto ends_of = [](const ReadDeck& deck) {
    std::set<std::set<int>> ends;
    for (const auto& [name, elements] : deck.elsets)
      for (const int e : elements)
        if (name.starts_with("_rim_E"))
          ends.insert({deck.elements.at(e)[name[6] - '1'], deck.elements.at(e)[(name[6] - '0') % 4]});
    return ends;
  };
  EXPECT_EQ(ends_of(before).size(), 12u);
  EXPECT_EQ(ends_of(after), ends_of(before));
  EXPECT_NE(after.elsets, before.elsets);
  EXPECT_EQ(after.nsets.at("rim"), before.nsets.at("rim"));
}

TEST(KeptDecks, TrianglesBecomeQuadsOfTheirType) {
  const Folder folder;
  std::string text = plate("CPS3", 0, "*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n1.\n");
  std::stringstream lines(text);
  text.clear();
  for (std::string line; std::getline(lines, line);) {
    const auto v = split(line);
    if (v.size() == 5 && v[0].size() == 4 && v[0] > "1000" && v[0] != "9000")
      text += v[0] + ", " + v[1] + ", " + v[2] + ", " + v[3] + "\n1" + v[0] + ", " + v[1] + ", " + v[3] +
              ", " + v[4] + '\n';
    else
      text += line + '\n';
  }
  write_text(folder / "a.inp", text);
  ASSERT_EQ(delquad({"improve", folder / "a.inp", "-o", folder / "b.inp"}).exit_code, 0);
  const ReadDeck after = read_deck(folder / "b.inp");
  EXPECT_EQ(after.elsets.at("PLATE").size(), 96u);
  for (const auto& [number, type] : after.types) EXPECT_EQ(type, "CPS4");
}

/// A part of a cylinder of 8 x 8 quads of eight nodes, with moved corners; `more` lines follow.
std::string curved_plate(const std::string& more) {
  constexpr int kSide = 8, kRow = 2 * kSide + 1;
  const auto number = [](int i, int j) { return 1 + j * kRow + i; };
  std::string nodes = "*NODE\n", elements = "*ELEMENT, TYPE=S8R, ELSET=SHELL\n";
  for (int j = 0; j < kRow; ++j)
    for (int i = 0; i < kRow; ++i) {
      if (i % 2 == 1 && j % 2 == 1) continue;
      const bool moves = i % 2 + j % 2 == 0 && i > 0 && j > 0 && i < kRow - 1 && j < kRow - 1;
      const double x = 0.05 * i + (moves ? 0.03 * std::sin(7.0 * i + 3.0 * j) : 0), y = 0.05 * j;
      nodes += std::to_string(number(i, j));
      for (const double c : {std::sin(x), y, std::cos(x)}) nodes += ", " + std::to_string(c);
      nodes += '\n';
    }
  for (int e = 0; e < kSide * kSide; ++e) {
    const int i = e % kSide * 2, j = e / kSide * 2;
    elements += std::to_string(e + 1);
    for (const auto& [a, b] : {std::pair{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}})
      elements += ", " + std::to_string(number(i + a, j + b));
    elements += '\n';
  }
  return nodes + elements + more;
}

TEST(KeptDecks, QuadsOfEightNodesKeepTheirType) {
  const Folder folder;
  write_text(folder / "a.inp", curved_plate("*NSET, NSET=CLAMP, GENERATE\n1, 17, 1\n"));
  const auto result = delquad({"improve", folder / "a.inp", "-o", folder / "b.inp"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const ReadDeck before = read_deck(folder / "a.inp"), after = read_deck(folder / "b.inp");
  EXPECT_EQ(after.nsets.at("CLAMP"), before.nsets.at("CLAMP"));
  std::map<std::pair<int, int>, std::set<int>> middles;
  int moved = 0;
  for (const auto& [number, v] : after.elements) {
    EXPECT_EQ(after.types.at(number), "S8R");
    ASSERT_EQ(v.size(), 8u);
    moved += !before.elements.contains(number);
    for (std::size_t k = 0; k < 4; ++k) {
      middles[std::minmax(v[k], v[(k + 1) % 4])].insert(v[4 + k]);
      const auto &a = after.nodes.at(v[k]), &b = after.nodes.at(v[(k + 1) % 4]),
                 &m = after.nodes.at(v[4 + k]);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(m[c], (a[c] + b[c]) / 2, 2e-2);
    }
  }
  EXPECT_GT(moved, 20);
  for (const auto& [side, nodes] : middles) EXPECT_EQ(nodes.size(), 1u);
  for (const auto& [number, at] : before.nodes)
    if (after.nodes.contains(number)) {
      EXPECT_EQ(after.nodes.at(number), at);
    }

  write_text(folder / "c.inp", curved_plate("*NSET, NSET=INSIDE\n" + std::to_string(1 + 8 * 17 + 7) + "\n"));
  const auto refused = delquad({"improve", folder / "c.inp", "-o", folder / "d.inp"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(holds(refused.err, "node 144 on a side is in a set and would be removed"));
}

TEST(KeptDecks, ALoadOnAllNodesIsNotSpread) {
  const Folder folder;
  write_text(folder / "a.inp", plate("S4", 0, "*STEP\n*STATIC\n*CLOAD\nEVERY, 3, -1.\n*END STEP\n"));
  ASSERT_EQ(delquad({"improve", folder / "a.inp", "-o", folder / "b.inp"}).exit_code, 0);
  EXPECT_EQ(read_deck(folder / "b.inp").nsets, read_deck(folder / "a.inp").nsets);
}

/// Two plates of 2 x 2 elements with node sets. Nodes 7, 8, 9 of the left one lie at 11, 12, 13 of the right.
std::string two_plates(const std::string& more) {
  std::string text = "*HEADING\nby hand\n", elements = "*ELEMENT, TYPE=S4, ELSET=PLATES\n";
  for (int body = 0; body < 2; ++body) {
    text += body == 0 ? "*NODE, NSET=NLEFT\n" : "*NODE, NSET=NRIGHT\n";
    for (int k = 0; k < 9; ++k)
      text += std::to_string(1 + 10 * body + k) + ", " + std::to_string(2 * body + k / 3) + ", " +
              std::to_string(k % 3) + ", " + std::to_string(body * (k / 3)) + '\n';
    for (int k = 0; k < 4; ++k) {
      const int v = 1 + 10 * body + k + k / 2;
      elements += std::to_string(1 + 10 * body + k);
      for (const int n : {v, v + 3, v + 4, v + 1}) elements += ", " + std::to_string(n);
      elements += '\n';
    }
  }
  return text + elements + "*NSET, NSET=SEAM_R\n11, 12, 13, 12\n*NSET, NSET=MIDDLE\n8, 12\n" + more;
}

TEST(KeptDecks, WeldingKeepsThePlacesInSets) {
  const Folder folder;
  write_text(folder / "a.inp", two_plates("*ELEMENT, TYPE=B31, ELSET=BEAM\n30, 11, 19\n"
                                          "*SURFACE, NAME=EDGE, TYPE=NODE\n 12, 0.5\n8\n13\n"
                                          "*DLOAD\n11, P, 1.\n*CLOAD\nSEAM_R, 3, 1.\n"
                                          "*BOUNDARY\nNRIGHT, 1, 6\nMIDDLE, 1\n"));
  for (const char* command : {"convert", "improve"}) {
    Strings arguments = {command, folder / "a.inp", "--weld", "1e-6"};
    if (command[0] == 'i') arguments.push_back("-o");
    arguments.push_back(folder / "b.inp");
    const ProgramResult result = delquad(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    ReadDeck deck = read_deck(folder / "b.inp");
    EXPECT_EQ(deck.nodes.size(), 15u);
    EXPECT_EQ(deck.nsets["NLEFT"], (std::set{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(deck.nsets["NRIGHT"], (std::set{7, 8, 9, 14, 15, 16, 17, 18, 19}));
    EXPECT_EQ(deck.nsets["SEAM_R"], (std::set{7, 8, 9}));
    EXPECT_EQ(deck.nsets["MIDDLE"], (std::set{8}));
    EXPECT_EQ(deck.elements[11], (std::vector{7, 14, 15, 8}));
    EXPECT_EQ(deck.elements[30], (std::vector{7, 19}));
    EXPECT_EQ(deck.surface_rows.back(), "9");
    EXPECT_EQ(deck.surface_rows.size(), 2u);
    EXPECT_EQ(deck.others, read_deck(folder / "a.inp").others);
  }
}

TEST(KeptDecks, WeldingTellsWhichLineForbidsIt) {
  const Folder folder;
  const std::pair<std::string, const char*> lines[] = {
      {"*EQUATION\n2\n8, 3, 1., 12, 3, -1.\n", "join node 12 to node 8, but this line of EQUATION names 12"},
      {"*CLOAD\nMIDDLE, 3, 1.\n", "join node 12 to node 8, but CLOAD counts each node of the set MIDDLE"}};
  for (const auto& [line, why] : lines) {
    write_text(folder / "a.inp", two_plates(line));
    EXPECT_EQ(delquad({"convert", folder / "a.inp", folder / "b.inp"}).exit_code, 0);
    const ProgramResult result = delquad({"convert", folder / "a.inp", folder / "c.inp", "--weld", "1e-6"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(holds(result.err, why, "change this line, or leave --weld out"));
  }
}

TEST(KeptDecks, OtherFormatsGetSetsAndTellTheRest) {
  const Folder folder;
  write_text(folder / "a.inp", plate("S4", 0, hangers()));
  for (const char* command : {"convert", "improve"}) {
    Strings arguments = {command, folder / "a.inp", folder / "b.msh"};
    if (command[0] == 'i') arguments.insert(arguments.begin() + 2, "-o");
    const auto result = delquad(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, "*MATERIAL", "*ELEMENT, TYPE=SPRINGA", "*CLOAD"));
    const std::string text = read_text(folder / "b.msh");
    EXPECT_TRUE(holds(text, "\"SOME\"", "\"RIM\""));
    std::map<std::string, int> points;
    for (const NamedPoint& named : read_mesh(folder / "b.msh").named_points)
      for (const std::string& name : named.entity.names) ++points[name];
    EXPECT_EQ(points, (std::map<std::string, int>{{"CLAMP", kRows + 1}, {"LOADED", 2}, {"SENSOR", 1}}))
        << command;
  }
  EXPECT_TRUE(holds(delquad({"metrics", folder / "a.inp"}).err, "note: *ELEMENT, TYPE=SPRINGA is not read"));
}

TEST(KeptDecks, RefusesWhatMakesNodesOfItsOwn) {
  const Folder folder;
  for (const char* card : {"*INCLUDE, INPUT=more.inp\n", "*NGEN\n1, 5\n", "*SYSTEM\n0, 0, 1\n"}) {
    write_text(folder / "a.inp", std::string("*HEADING\nx\n") + card);
    const auto result = delquad({"improve", folder / "a.inp", "-o", folder / "b.inp"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(holds(result.err, "a.inp:3: *"));
  }
}

}  // namespace
}  // namespace delquad::testing_support
