#pragma once

#include <string>

namespace delquad {

/// What draw_diagram() has drawn as a page of PDF 1.4, a point for each pixel, with the font inside, as
/// publishers ask. Characters that are not in Latin-1 become "?". The same drawing gives the same bytes.
std::string svg_to_pdf(const std::string& svg);

}  // namespace delquad
