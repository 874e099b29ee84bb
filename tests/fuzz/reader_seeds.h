// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace delquad::fuzz {

// Small files of each format, as the project writes them and as others do: what they have in common is that
// they can be read.
std::vector<std::string> msh_seeds();
std::vector<std::string> obj_seeds();
std::vector<std::string> off_seeds();
std::vector<std::string> stl_seeds();
std::vector<std::string> ply_seeds();
std::vector<std::string> three_mf_seeds();
std::vector<std::string> vtu_seeds();
std::vector<std::string> inp_seeds();
std::vector<std::string> medit_seeds();
std::vector<std::string> mfem_seeds();
std::vector<std::string> nastran_seeds();

/// A ZIP archive with 3D/3dmodel.model, stored.
std::string archive_of(std::string_view model);

}  // namespace delquad::fuzz
