// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

// This header decodes texts of CAD files. Readers of shapes and names use it.

namespace delquad::cad {

/// Makes UTF-8 of all texts of a file, which does not say how they are encoded. They are UTF-8 if all of them
/// are valid in it. Otherwise they are GB 2312, Shift-JIS or GBK if no byte above 0x7F stands alone, or
/// beside a small letter as in European words. Otherwise they are ISO 8859-1. Returns a warning that says so
/// with an example, or nothing where all are UTF-8.
std::string decode_texts(std::vector<std::string>& texts);

/// Decodes texts whose bytes the kernel took for ISO 8859-1, in the same way. Texts with characters beyond
/// it, which only escapes (\X2\...\X0\) can express, stay as they are.
std::string decode_kernel_texts(std::vector<std::string>& texts);

}  // namespace delquad::cad
