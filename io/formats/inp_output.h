#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "delquad/hexahedra.h"
#include "io/text_writer.h"

// What Abaqus input files have in common, whatever elements they hold.

namespace delquad {

/// Numbers on one line of a set, which may have no more.
inline constexpr std::size_t kInpNumbersPerLine = 16;
/// The longest name that Abaqus takes is 80; what is left is for numbers, and for names of sides.
inline constexpr std::size_t kLongestInpName = 60;
/// Part of the model's diagonal below which a coordinate is zero: some hundred steps of a double there, what
/// rotations and projections leave of zeros.
inline constexpr double kInpNegligible = 1e-13;

/// In at most 20 characters: CalculiX cuts off what follows, perhaps within the exponent. "0" below
/// `negligible`.
std::string inp_number(double x, double negligible);

/// Sorts them first, and leaves out what is there twice.
void write_inp_numbers(TextWriter& out, std::vector<int>& numbers, std::size_t per_line);

/// C3D8. Every name of volumes is an ELSET and an NSET, of faces an NSET and, on the boundary, a SURFACE, of
/// curves an NSET.
void write_hex_inp(const std::filesystem::path& path, const HexMesh& mesh);

}  // namespace delquad
