// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

// This header draws figures by matplotlib. Commands on results use it.

namespace delquad {

/// Draws the figures of folders of results from their tables, as SVG and PDF in DIR/figures, by
/// experiments/figures.py with matplotlib. Old figures of these folders are removed. Returns why none is
/// drawn; empty: all are. Throws InputError if the script fails otherwise.
std::string draw_figures(const std::vector<std::filesystem::path>& folders);

}  // namespace delquad
