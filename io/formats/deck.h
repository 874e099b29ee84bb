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

// This header reads and rewrites decks of solvers. The formats of Abaqus and Nastran use it.

namespace delquad {

/// Ignores case, as Abaqus and CalculiX do in names.
struct LessBlindToCase {
  bool operator()(const std::string& a, const std::string& b) const { return upper(a) < upper(b); }
};
/// Members of sets, as indices.
using DeckSets = std::map<std::string, std::vector<int>, LessBlindToCase>;

/// A file of Abaqus, CalculiX or Nastran, piece by piece, so that it can be written again with another mesh.
struct Deck {
  /// A keyword line, "*ELSET, ELSET=name, GENERATE", and the lines of data behind it. Cards of Nastran are
  /// told in these terms. GRIDs with the same last fields are a NODE card. Elements with the same fields but
  /// numbers and angle are an ELEMENT card. SPC1 is an NSET, and PLOAD2 is an ELSET.
  struct Card {
    std::string name = {};                               ///< in capitals, without the star
    std::map<std::string, std::string> parameters = {};  ///< by name in capitals; empty: a flag
    int line = 0;
    std::size_t begin = 0, data = 0, end = 0;  ///< places in `text`: of both, and behind the data
    std::vector<long long> numbers = {};       ///< of a set, as its lines have them
    std::vector<std::string> names = {};       ///< of other sets in it

    std::string parameter(const std::string& key) const {
      const auto at = parameters.find(key);
      return at == parameters.end() ? "" : at->second;
    }
    /// Returns whether its name is one of these, such as "|MPC|EQUATION|".
    bool is_among(std::string_view keywords) const {
      return keywords.find('|' + name + '|') != std::string_view::npos;
    }
  };
  struct Node {
    long long number;
    Vec3 at;
    std::size_t begin, end;  ///< of its lines
    int pin = -1;            ///< the line that names it, so that it stays; 0: a set; -1: none
    int joined = -1;         ///< the node that takes its place, by index; -1: none
  };
  /// A line, triangle or quad, or a hexahedron of a deck that is no one to improve.
  struct Element {
    long long number;
    std::vector<int> nodes;  ///< indices
    int line, card;
    std::size_t begin, end;              ///< of its lines
    std::vector<std::string> sets = {};  ///< elements with the same ones are a region
    int region = -1;                     ///< index into Mesh::regions, or Mesh::curves of a line
    int pin = -1;                        ///< see Node
    double angle = 0;                    ///< from the first side to the material's direction, in degrees
    bool is_solid = false;

    /// Returns 2, 3, 4 or 8; some programs write triangles as quads that name a corner twice.
    std::size_t corners() const {
      if (is_solid) return 8;
      return nodes.size() == 4 && nodes[2] == nodes[3] ? 3 : std::min<std::size_t>(nodes.size(), 4);
    }
  };
  /// A row of a surface: a side "S2" or "E2" of elements, by their number or set.
  struct Side {
    std::string surface, elements, label;
    int line, card;  ///< card -1: a set "_NAME_E2" of our files
  };
  /// A name or number in a line that is not read.
  struct Word {
    std::string text;
    int line, card;
    long long number = 0;       ///< 0: a name
    bool of_element = false;    ///< the number may be one of an element
    bool has_side = false;      ///< a set of elements, with a side of them behind it
    bool forbids_join = false;  ///< of the node of this number with another
    bool counts_nodes = false;  ///< one by one: no two nodes of the set may be joined
    bool may_grow = false;      ///< the set of nodes may get new ones

    /// Returns the set that it may name: "P-1.TOP" is the set TOP.
    std::string set() const { return text.substr(text.rfind('.') + 1); }
  };

  /// A card PSHELL or MAT1 of Nastran. Blank fields are 0, and those that are no numbers are NaN.
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
  std::set<long long> unread;  ///< numbers of elements of other types
  DeckSets element_sets, node_sets;
  std::vector<Side> sides;
  std::vector<Word> words;
  int n_named = 0;  ///< inner nodes and elements that stay because a line or a set names them
  std::map<std::string, int>
      others;                   ///< how many keywords with lines that are not read, and types of elements
  bool has_directions = false;  ///< elements have angles of their own
  Mesh mesh;
  std::vector<int> point_of;  ///< the mesh's point of each node of a deck to improve; -1: none
  DeckSets growing;           ///< sets of all nodes of some regions: these regions, whose new nodes they get

  /// Returns the type of an element, in capitals.
  std::string type_of(const Element& element) const { return upper(cards[element.card].parameter("TYPE")); }
  /// Returns the side of an element that a label names, from 0; -1: none, such as the top of a shell.
  int side_of(const Element& element, const std::string& label) const;
  /// Returns the elements that a row of a surface names, if they are read.
  std::vector<int> elements_of(const Side& row) const;
  /// Returns whether such a row names sides on curves.
  bool names_side(const Side& row) const;
  /// Sets of elements that have a side on a curve: they are made again from these sides.
  std::set<std::string, LessBlindToCase> sets_of_sides() const;
  /// Returns the regions all of whose nodes a set has, for each set without other nodes of regions.
  DeckSets filled_regions() const;
};

/// Writes pieces of a deck, each with the line break behind it.
class DeckText {
 public:
  explicit DeckText(const Deck& deck) : deck_(deck) {}
  virtual ~DeckText() = default;
  /// Returns a node of the set of a card; null: it is in no such set.
  virtual std::string node(long long number, const Vec3& at, const Deck::Card* card) const = 0;
  /// Says of further nodes that they belong to the set of a card of nodes, too.
  virtual std::string as_in(const Deck::Card& card, const std::vector<long long>& nodes,
                            bool are_new) const = 0;
  /// Returns the line before new nodes, and the line before new elements of a card.
  virtual std::string head_of_nodes() const { return ""; }
  virtual std::string head(const Deck::Card& /*card*/, const std::string& /*type*/) const { return ""; }
  /// Returns an element like another one.
  virtual std::string element(long long number, const Deck::Element& model, const std::string& type,
                              const std::vector<long long>& nodes, double angle) const = 0;
  /// Returns the type of quads beside triangles of a type, or the other way round.
  virtual std::string type_with(std::string type, std::size_t corners) const = 0;
  /// Returns the card of a set again, with other members.
  virtual std::string set(const Deck::Card& card, const std::vector<long long>& numbers) const = 0;

 protected:
  const Deck& deck_;
};

/// Reads the lines of a file. With `as_deck` its mesh is one to improve. Then elements of a region agree on
/// their side, and elements that lines name by number have regions of their own. Some nodes must stay, and
/// their place alone does not tell them. They are named points without names; tags are their numbers.
///
/// Abaqus input: *NODE, *ELEMENT of two to four or eight nodes (shells, membranes, plane ones, bars), and of
/// hexahedra unless it is `as_deck`, *ELSET. Element sets become names of regions or volumes, unless their
/// own begins with an underscore. Surfaces of elements' sides (S1 to S6, E1 to E4) become curves or faces.
/// Other keywords are left out.
Deck read_inp_deck(const std::filesystem::path& path, bool as_deck);
/// Reads Nastran's bulk data, in free, small and large fields: GRID, CQUAD4, CQUAD8, CTRIA3, and as lines
/// CBAR, CBEAM, CROD, CTUBE, CONROD and PLOTEL. Properties are tags, names those that write_nastran() leaves
/// in comments. Nodes must be in the basic coordinate system. Other cards are left out.
Deck read_nastran_deck(const std::filesystem::path& path, bool as_deck);
/// Parts the regions, before there is a mesh, and names the points of such a deck.
void part_elements(Deck& deck);
void name_points(Deck& deck);
/// Returns the mesh of a deck to improve, of corners alone; notes how much must stay.
Mesh given_mesh(Deck deck, ReadNotes* notes);

/// Writes a deck again with a mesh that read_..._deck() and stages made from it. Elements and nodes that
/// are not new keep their lines, and so does all else that new ones do not change. On new sides of elements
/// with eight nodes the middle node lies halfway. `weld` is the part of the diagonal that weld_open_edges()
/// had: in sets the kept nodes take the places of the joined ones. Throws InputError if a line names a node
/// or an element that is gone.
void rewrite_deck(Deck& deck, const DeckText& text, const std::filesystem::path& path, const Mesh& mesh,
                  double weld);
void rewrite_inp(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                 double weld);
void rewrite_nastran(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                     double weld);

/// Numbers in lines of 16.
std::string inp_lines(const std::vector<long long>& numbers);
/// Returns a coordinate in at most 20 characters: CalculiX cuts off what follows. "0" below `negligible`.
std::string inp_number(double x, double negligible);

}  // namespace delquad
