#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "delquad/hexahedra.h"
#include "io/text_writer.h"

// What Abaqus input files have in common, whatever elements they hold.

namespace delquad {

/// The longest name that Abaqus takes is 80; what is left is for numbers, and for names of sides.
inline constexpr std::size_t kLongestInpName = 60;
/// Part of the model's diagonal below which a coordinate is zero: some hundred steps of a double there, what
/// rotations and projections leave of zeros.
inline constexpr double kInpNegligible = 1e-13;

/// "1, 0.5, 2, 0"
void write_inp_node(TextWriter& out, std::size_t number, const Vec3& p, double negligible);
/// "1, 4, 7, 9": the number of an element and those of its nodes, from 1.
template <class Nodes>
void write_inp_element(TextWriter& out, std::size_t number, const Nodes& nodes) {
  out << number;
  for (const int v : nodes) out << ", " << v + 1;
  out << '\n';
}

/// Sets of nodes or elements, by label; as write_inp_numbers().
using InpSets = std::map<std::string, std::vector<int>>;
void write_inp_sets(TextWriter& out, const char* keyword, InpSets& sets);
/// Sorts them first, and leaves out what is there twice.
void write_inp_numbers(TextWriter& out, std::vector<int>& numbers, std::size_t per_line);

/// C3D8. Every name of volumes is an ELSET and an NSET, of faces an NSET and, on the boundary, a SURFACE, of
/// curves an NSET.
void write_hex_inp(const std::filesystem::path& path, const HexMesh& mesh);

}  // namespace delquad
