// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

// This header decodes texts of CAD files. Readers of shapes and names use it.

namespace delquad::cad {

/// Converts all texts of a file of unknown encoding to UTF-8 (own rule). They are UTF-8 if all of them are
/// valid in it. Otherwise they are GB 2312, Shift-JIS or GBK if no byte above 0x7F stands alone, or beside a
/// small letter as in European words. Otherwise they are ISO 8859-1. Returns a warning with the encoding and
/// an example; empty if all are UTF-8.
std::string decode_texts(std::vector<std::string>& texts);

/// Does the same for texts whose bytes the kernel read as ISO 8859-1. Texts with other characters, from
/// escapes (\X2\...\X0\), stay.
std::string decode_kernel_texts(std::vector<std::string>& texts);

}  // namespace delquad::cad
