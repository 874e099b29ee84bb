// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "delquad/mesh.h"
#include "geometry/mesh/cell_shapes.h"

// This header reads and rewrites decks of solvers. The formats of Abaqus and Nastran use it.

namespace delquad {

/// Order of names without regard to case, as in Abaqus and CalculiX.
struct LessBlindToCase {
  bool operator()(const std::string& a, const std::string& b) const { return upper(a) < upper(b); }
};
/// Members of sets, as indices.
using DeckSets = std::map<std::string, std::vector<int>, LessBlindToCase>;

/// A file of Abaqus, CalculiX or Nastran in pieces, so that it can be written again with another mesh.
struct Deck {
  /// A keyword line, "*ELSET, ELSET=name, GENERATE", with its lines of data. Cards of Nastran are represented
  /// in these terms. GRIDs with the same last fields are a NODE card. Elements with the same fields except
  /// numbers and angle are an ELEMENT card. SPC1 is an NSET, and PLOAD2 is an ELSET.
  struct Card {
    std::string name = {};                               ///< in capitals, without the star
    std::map<std::string, std::string> parameters = {};  ///< by name in capitals; empty: a flag
    int line = 0;
    std::size_t begin = 0, data = 0, end = 0;  ///< offsets in `text`: of the card, of its data, and behind it
    std::vector<long long> numbers = {};       ///< of a set, as in its lines
    std::vector<std::string> names = {};       ///< names of other sets in it

    std::string parameter(const std::string& key) const {
      const auto at = parameters.find(key);
      return at == parameters.end() ? "" : at->second;
    }
    /// Returns whether its name is among keywords such as "|MPC|EQUATION|".
    bool is_among(std::string_view keywords) const {
      return keywords.find('|' + name + '|') != std::string_view::npos;
    }
  };
  struct Node {
    long long number;
    Vec3 at;
    std::size_t begin, end;  ///< of its lines
    int pin = -1;            ///< line that names it, so that it stays; 0: a set; -1: none
    int joined = -1;         ///< index of the node that replaces it; -1: none
  };
  /// A line, triangle or quad, or a cell of a volume of a deck that is no one to improve.
  struct Element {
    long long number;
    std::vector<int> nodes;  ///< indices
    int line, card;
    std::size_t begin, end;              ///< of its lines
    std::vector<std::string> sets = {};  ///< elements of the same sets are a region
    int region = -1;                     ///< index into Mesh::regions; for a line into Mesh::curves
    int pin = -1;                        ///< see Node
    double angle = 0;                    ///< from the first side to the material's direction, in degrees
    bool is_solid = false;

    /// A quad that repeats its last corner counts as a triangle.
    CellShape shape() const {
      using enum CellShape;
      const std::size_t n = nodes.size();
      if (is_solid) return n == 4 || n == 10 ? kTetrahedron : n == 6 || n == 15 ? kPrism : kHexahedron;
      return n == 2 ? kLine : n == 3 || (n == 4 && nodes[2] == nodes[3]) ? kTriangle : kQuad;
    }
    std::size_t corners() const { return static_cast<std::size_t>(corners_of(shape())); }
  };
  /// A row of a surface: a side "S2" or "E2" of elements, by their number or set.
  struct Side {
    std::string surface, elements, label;
    int line, card;  ///< card -1: a set "_NAME_E2" of our files
  };
  /// A name or number in a line that is kept as text.
  struct Word {
    std::string text;
    int line, card;
    long long number = 0;       ///< 0: a name
    bool of_element = false;    ///< the number may be the number of an element
    bool has_side = false;      ///< a set of elements, followed by a side of them
    bool forbids_join = false;  ///< the node of this number cannot be joined to another
    bool counts_nodes = false;  ///< each node of the set counts, so none can be joined
    bool may_grow = false;      ///< the set of nodes may get new ones

    /// Returns the name of the set: "P-1.TOP" is the set TOP.
    std::string set() const { return text.substr(text.rfind('.') + 1); }
  };

  /// A card PSHELL or MAT1 of Nastran. Blank fields are 0, and fields without a number are NaN.
  struct Property {
    std::string name;
    std::vector<double> fields;
  };

  std::string source, text;
  std::vector<Property> properties;
  std::vector<Card> cards = {{}};  ///< the first stands for lines before all cards
  std::vector<Node> nodes;
  std::vector<Element> elements;
  std::map<long long, int> node_of, element_of;
  std::set<long long> unread;  ///< numbers of elements of unsupported types
  DeckSets element_sets, node_sets;
  std::vector<Side> sides;
  std::vector<Word> words;
  int n_named = 0;  ///< inner nodes and elements that stay because a line or a set names them
  std::map<std::string, int> others;  ///< counts of ignored keywords and types of elements
  bool has_directions = false;        ///< elements have angles
  Mesh mesh;
  std::vector<int> point_of;  ///< point of the mesh for each node; -1: none
  DeckSets growing;           ///< sets of all nodes of regions, which get their new nodes, with these regions

  /// Returns the type of an element, in capitals.
  std::string type_of(const Element& element) const { return upper(cards[element.card].parameter("TYPE")); }
  /// Returns the side of an element for a label, from 0; -1: none, such as the top of a shell.
  int side_of(const Element& element, const std::string& label) const;
  /// Returns the supported elements of a row of a surface.
  std::vector<int> elements_of(const Side& row) const;
  /// Returns whether a row has sides on curves.
  bool names_side(const Side& row) const;
  /// Returns sets of elements that have a side on a curve, which are made again from these sides.
  std::set<std::string, LessBlindToCase> sets_of_sides() const;
  /// Returns, for each set whose nodes fill regions exactly, these regions.
  DeckSets filled_regions() const;
};

/// Writes pieces of a deck, each with its line break.
class DeckText {
 public:
  explicit DeckText(const Deck& deck) : deck_(deck) {}
  virtual ~DeckText() = default;
  /// Returns the text of a node in the set of a card; null: in no set.
  virtual std::string node(long long number, const Vec3& at, const Deck::Card* card) const = 0;
  /// Returns the text that adds further nodes to the set of a card of nodes.
  virtual std::string as_in(const Deck::Card& card, const std::vector<long long>& nodes,
                            bool are_new) const = 0;
  /// Returns the line before new nodes, and the line before new elements of a card.
  virtual std::string head_of_nodes() const { return ""; }
  virtual std::string head(const Deck::Card& /*card*/, const std::string& /*type*/) const { return ""; }
  /// Returns the text of an element with the properties of `model`; the angle is in degrees.
  virtual std::string element(long long number, const Deck::Element& model, const std::string& type,
                              const std::vector<long long>& nodes, double angle) const = 0;
  /// Returns the type of elements with this number of corners, beside elements of a type.
  virtual std::string type_with(std::string type, std::size_t corners) const = 0;
  /// Returns the text of a set with other members.
  virtual std::string set(const Deck::Card& card, const std::vector<long long>& numbers) const = 0;

 protected:
  const Deck& deck_;
};

/// Reads Abaqus input: *NODE, *ELEMENT of lines, faces and cells but pyramids (shells, membranes, plane ones,
/// bars, C3D4 to C3D20), *ELSET. Element sets become names of regions, unless they begin with an underscore.
/// Surfaces of sides (S1 to S4, E1 to E4) become curves. Other keywords are left out.
///
/// With `as_deck` its mesh is one to improve. Then elements of a region have one orientation, and elements
/// that lines name by number have regions of their own. Nodes that must stay for other reasons than their
/// place are named points without names, whose tags are their numbers. Throws InputError with file and line.
Deck read_inp_deck(const std::filesystem::path& path, bool as_deck);
/// Reads Nastran's bulk data, in free, small and large fields: GRID, CQUAD4, CQUAD8, CTRIA3, and as lines
/// CBAR, CBEAM, CROD, CTUBE, CONROD and PLOTEL. Properties are tags, and comments of write_nastran() give
/// names. Nodes must be in the basic coordinate system. Other cards are left out. Throws InputError with file
/// and line.
Deck read_nastran_deck(const std::filesystem::path& path, bool as_deck);
/// Divides the regions before there is a mesh, and names the points of such a deck.
void part_elements(Deck& deck);
void name_points(Deck& deck);
/// Returns the mesh of a deck to improve, of corners only; notes the number of pinned parts.
Mesh given_mesh(Deck deck, ReadNotes* notes);

/// Writes a deck again with a mesh from read_..._deck() and stages after it. Old elements and nodes keep
/// their lines, and everything else stays unless new ones change it. On new sides of elements with eight
/// nodes the middle node lies halfway. `weld` is the share of the diagonal for weld_open_edges(): sets get
/// the replacements of joined nodes. Throws InputError if a line names a removed node or element.
void rewrite_deck(Deck& deck, const DeckText& text, const std::filesystem::path& path, const Mesh& mesh,
                  double weld);
void rewrite_inp(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                 double weld);
void rewrite_nastran(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                     double weld);

/// Returns numbers in lines of 16.
std::string inp_lines(const std::vector<long long>& numbers);
/// Returns a coordinate in at most 20 characters, because CalculiX cuts off the rest; "0" if |x| is below
/// `negligible`.
std::string inp_number(double x, double negligible);

}  // namespace delquad
