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

namespace delquad {

/// Ignores case, as Abaqus and CalculiX do in names.
struct LessBlindToCase {
  bool operator()(const std::string& a, const std::string& b) const { return upper(a) < upper(b); }
};
/// Members of sets, as indices.
using InpSets = std::map<std::string, std::vector<int>, LessBlindToCase>;

/// An Abaqus or CalculiX file, line by line, so that it can be written again with another mesh.
struct InpDeck {
  /// A keyword line, "*ELSET, ELSET=name, GENERATE", and the lines of data behind it.
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
    /// Whether its name is one of these, such as "|MPC|EQUATION|".
    bool is_among(std::string_view keywords) const {
      return keywords.find('|' + name + '|') != std::string_view::npos;
    }
  };
  struct Node {
    long long number;
    Vec3 at;
    std::size_t begin;  ///< of its line
    int pin = -1;       ///< the line that names it, so that it stays; 0: a set; -1: none
    int joined = -1;    ///< the node that takes its place, by index; -1: none
  };
  /// A line, triangle or quad.
  struct Element {
    long long number;
    std::vector<int> nodes;  ///< indices
    int line, card;
    std::size_t begin, end;              ///< of its lines
    std::vector<std::string> sets = {};  ///< elements with the same ones are a region
    int region = -1;                     ///< index into Mesh::regions, or Mesh::curves of a line
    int pin = -1;                        ///< see Node

    /// 2, 3 or 4; some programs write triangles as quads that name a corner twice.
    std::size_t corners() const {
      return nodes.size() == 4 && nodes[2] == nodes[3] ? 3 : std::min<std::size_t>(nodes.size(), 4);
    }
  };
  /// A row of a surface: a side "S2" or "E2" of elements, by their number or set.
  struct Side {
    std::string surface, elements, label;
    int line, card;  ///< card -1: a set "_NAME_E2" of our files
  };
  /// A name or number in a line of data that is not read.
  struct Word {
    std::string text, next;  ///< with the field behind it
    int line, card;
    long long number = 0;   ///< 0: a name
    bool is_first = false;  ///< on its line
  };

  std::string source, text;
  std::vector<Card> cards = {{}};  ///< the first stands for lines before all cards
  std::vector<Node> nodes;
  std::vector<Element> elements;
  std::map<long long, int> node_of, element_of;
  std::set<long long> unread;  ///< numbers of elements of other types
  InpSets element_sets, node_sets;
  std::vector<Side> sides;
  std::vector<Word> words;
  int n_named = 0;               ///< inner nodes and elements that stay because a line or a set names them
  std::set<std::string> others;  ///< keywords whose lines are not read, and types of elements
  Mesh mesh;
  std::vector<int> point_of;  ///< the mesh's point of each node of a deck to improve; -1: none
  InpSets growing;            ///< sets of all nodes of some regions: these regions, whose new nodes they get

  /// The type of an element, in capitals.
  std::string type_of(const Element& element) const { return upper(cards[element.card].parameter("TYPE")); }
  /// The side of an element that a label names, from 0; -1: none, such as the top of a shell.
  int side_of(const Element& element, const std::string& label) const;
  /// The elements that a row of a surface names, if they are read.
  std::vector<int> elements_of(const Side& row) const;
  /// The regions all of whose nodes a set has, for each set without other nodes of regions.
  InpSets filled_regions() const;
};

/// Reads the lines of a file. With `as_deck` its mesh is one to improve. Then elements of a region agree on
/// their side, and elements that lines name by number have regions of their own. Some nodes must stay, and
/// their place alone does not tell them. They are named points without names; tags are their numbers.
InpDeck read_inp_deck(const std::filesystem::path& path, bool as_deck);
/// Parts the regions, before there is a mesh, and names the points of such a deck.
void part_elements(InpDeck& deck);
void name_points(InpDeck& deck);

/// Writes `source` again with a mesh that read_inp_deck() and stages made from it. Elements and nodes that
/// are not new keep their lines, and so does all else that new ones do not change. `weld` is the part of the
/// diagonal that weld_open_edges() had: in sets the kept nodes take the places of the joined ones. Throws
/// InputError if a line names a node or an element that is gone.
void rewrite_inp(const std::filesystem::path& source, const std::filesystem::path& path, const Mesh& mesh,
                 double weld);

/// A coordinate in at most 20 characters: CalculiX cuts off what follows. "0" below `negligible`.
std::string inp_number(double x, double negligible);

}  // namespace delquad
