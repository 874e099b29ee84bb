#include "io/svg_to_pdf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <boost/locale/utf.hpp>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <cassert>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <span>
#include <sstream>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// io/font/dejavu_sans.ttf
extern const std::span<const unsigned char> kSansFont;

namespace {

using Element = boost::property_tree::ptree;

/// Widths of the font's characters from the blank on, in thousandths of its size, in Windows' code page 1252.
constexpr std::array<int, 224> kWidths = {
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838,  318, 361, 318, 337, 636,  636, 636, 636, 636,
    636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,  575, 775, 752, 295,
    295, 656, 557, 863, 748, 787, 603, 787, 695, 635, 611, 732,  684, 989, 685, 611, 685,  390, 337, 390, 838,
    500, 500, 613, 635, 550, 635, 615, 352, 635, 634, 278, 278,  579, 278, 974, 634, 612,  635, 635, 411, 521,
    392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838, 0,    0,   0,   0,   0,   0,    0,   0,   0,   0,
    0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,    0,   500, 0,   0,   0,    0,   0,   0,   0,
    0,   0,   318, 401, 636, 636, 636, 636, 337, 500, 500, 1000, 471, 612, 838, 361, 1000, 500, 500, 838, 401,
    401, 500, 636, 636, 318, 500, 401, 471, 612, 969, 969, 969,  531, 684, 684, 684, 684,  684, 684, 974, 698,
    632, 632, 632, 632, 295, 295, 295, 295, 775, 748, 787, 787,  787, 787, 787, 838, 787,  732, 732, 732, 732,
    611, 605, 630, 613, 613, 613, 613, 613, 613, 982, 550, 615,  615, 615, 615, 278, 278,  278, 278, 612, 634,
    612, 612, 612, 612, 612, 838, 612, 634, 634, 634, 634, 592,  635, 592};
constexpr int kFirst = 32;

std::string attribute(const Element& element, const char* key, const char* otherwise = "") {
  return element.get<std::string>(std::string("<xmlattr>.") + key, otherwise);
}

double number(const Element& element, const char* key, double otherwise = 0) {
  const std::string text = attribute(element, key);
  return text.empty() ? otherwise : std::strtod(text.c_str(), nullptr);
}

/// "1 0 0" of "#f00" or "#ff0000".
std::string colour_of(const std::string& text) {
  assert(text.starts_with('#') && (text.size() == 4 || text.size() == 7));
  const std::size_t digits = text.size() / 3;
  std::string result;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = std::strtol(text.substr(1 + digits * k, digits).c_str(), nullptr, 16);
    result += fmt::format("{:.3g} ", static_cast<double>(value) / (digits == 1 ? 15 : 255));
  }
  return result;
}

std::string latin(const std::string& text) {
  std::string result;
  for (auto at = text.begin(); at != text.end();) {
    const auto code = boost::locale::utf::utf_traits<char>::decode(at, text.end());
    const bool is_there = (code >= kFirst && code < 0x7F) || (code >= 0xA0 && code <= 0xFF);
    result += is_there ? static_cast<char>(code) : '?';
  }
  return result;
}

/// What a path draws.
class PathOperators {
 public:
  explicit PathOperators(const std::string& data) {
    const char* at = data.c_str();
    const auto next = [&] {
      char* end = nullptr;
      const double value = std::strtod(at, &end);
      assert(end != at);
      at = end;
      return value;
    };
    while (*at != 0) {
      const char command = *at++;
      const bool is_relative = std::islower(static_cast<unsigned char>(command)) != 0;
      const Vec2 from = is_relative ? at_ : Vec2{0, 0};
      Vec2 to = at_;
      if (command == 'z') {
        text_ += "h ";
        continue;
      }
      if (command == 'a')
        for (int k = 0; k < 5; ++k) next();  // radii and which of the halves: the same each time
      if (command != 'V' && command != 'v') to.x = from.x + next();
      if (command != 'H' && command != 'h') to.y = from.y + next();
      if (command == 'a') {
        half_circle(to - at_);
        continue;
      }
      text_ += fmt::format("{:.2f} {:.2f} {} ", to.x, to.y, command == 'M' || command == 'm' ? 'm' : 'l');
      at_ = to;
    }
  }

  const std::string& text() const { return text_; }

 private:
  /// Two quarters, each a cubic.
  void half_circle(Vec2 across) {
    constexpr double kOfRadius = 0.5522847498;
    const Vec2 along = 0.5 * across, aside = {-along.y, along.x};
    curve(kOfRadius * aside, aside + (1 - kOfRadius) * along, aside + along);
    curve(kOfRadius * along, along - (1 - kOfRadius) * aside, along - aside);
  }

  void curve(Vec2 a, Vec2 b, Vec2 to) {
    for (const Vec2 p : {a, b, to}) text_ += fmt::format("{:.2f} {:.2f} ", at_.x + p.x, at_.y + p.y);
    text_ += "c ";
    at_ = at_ + to;
  }

  Vec2 at_ = {0, 0};
  std::string text_;
};

class PdfPage {
 public:
  explicit PdfPage(const Element& svg)
      : width_(number(svg, "width")), height_(number(svg, "height")), size_(number(svg, "font-size")) {
    content_ = fmt::format("1 0 0 -1 0 {:g} cm\n", height_);
    add_all(svg);
  }

  std::string file() const {
    std::string states;
    for (const std::string& opacity : opacities_) states += fmt::format("/A{0} << /ca {0} >> ", opacity);
    const std::string font(kSansFont.begin(), kSansFont.end());
    const auto last = kFirst + kWidths.size() - 1;
    std::vector<std::string> objects = {
        "<< /Type /Catalog /Pages 2 0 R >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:g} {:g}] /Contents 4 0 R /Resources << "
                    "/Font << /F 5 0 R >> /ExtGState << {}>> >> >>",
                    width_, height_, states),
        stream(content_, ""),
        fmt::format("<< /Type /Font /Subtype /TrueType /BaseFont /DQSANS+DejaVuSans /Encoding "
                    "/WinAnsiEncoding /FirstChar {} /LastChar {} /Widths [{}] /FontDescriptor 6 0 R >>",
                    kFirst, last, fmt::join(kWidths, " ")),
        "<< /Type /FontDescriptor /FontName /DQSANS+DejaVuSans /Flags 32 /FontBBox [-412 -236 957 929] "
        "/ItalicAngle 0 /Ascent 928 /Descent -236 /CapHeight 729 /StemV 80 /FontFile2 7 0 R >>",
        stream(font, fmt::format(" /Length1 {}", font.size()))};
    std::string text = "%PDF-1.4\n%\xE2\xE3\xCF\xD3\n", places;
    for (std::size_t k = 0; k < objects.size(); ++k) {
      places += fmt::format("{:010} 00000 n \n", text.size());
      text += fmt::format("{} 0 obj\n{}\nendobj\n", k + 1, objects[k]);
    }
    const std::size_t n = objects.size() + 1;
    return text + fmt::format(
                      "xref\n0 {0}\n0000000000 65535 f \n{1}trailer\n<< /Size {0} /Root 1 0 R >>\n"
                      "startxref\n{2}\n%%EOF\n",
                      n, places, text.size());
  }

 private:
  static std::string stream(const std::string& bytes, const std::string& entries) {
    return fmt::format("<< /Length {}{} >>\nstream\n{}\nendstream", bytes.size(), entries, bytes);
  }

  void add_all(const Element& parent) {
    for (const auto& [name, element] : parent) {
      if (name == "g") {
        size_ = number(element, "font-size", size_);
        add_all(element);
      } else if (name == "text") {
        add_text(element);
      } else if (name == "path") {
        paint(element, PathOperators(attribute(element, "d")).text());
      } else if (name == "rect") {
        const bool all = attribute(element, "width") == "100%";
        paint(element, fmt::format("{:g} {:g} {:g} {:g} re ", number(element, "x"), number(element, "y"),
                                   all ? width_ : number(element, "width"),
                                   all ? height_ : number(element, "height")));
      }
    }
  }

  void paint(const Element& element, const std::string& path) {
    const std::string fill = attribute(element, "fill", "none"),
                      stroke = attribute(element, "stroke", "none"),
                      opacity = attribute(element, "fill-opacity");
    const bool fills = fill != "none", strokes = stroke != "none";
    if (!fills && !strokes) return;
    content_ += "q ";
    if (fills) content_ += colour_of(fill) + "rg ";
    if (!opacity.empty()) content_ += "/A" + *opacities_.insert(opacity).first + " gs ";
    if (strokes)
      content_ += fmt::format("{}RG {:g} w [{}] 0 d {} J ", colour_of(stroke),
                              number(element, "stroke-width", 1), attribute(element, "stroke-dasharray"),
                              attribute(element, "stroke-linecap") == "round" ? 1 : 0);
    content_ += path + (fills && strokes ? "B" : fills ? "f" : "S") + " Q\n";
  }

  /// Level, or upwards where it is turned by a right angle: "translate(X Y) rotate(-90)".
  void add_text(const Element& element) {
    const std::string text = latin(element.data()), turn = attribute(element, "transform"),
                      anchor = attribute(element, "text-anchor");
    const double size = number(element, "font-size", size_);
    double width = 0;
    std::string escaped;
    for (const char c : text) {
      width += kWidths[static_cast<unsigned char>(c) - kFirst] * size / 1000;
      escaped += std::string("()\\").find(c) == std::string::npos ? std::string(1, c) : std::string("\\") + c;
    }
    const double before = anchor == "middle" ? width / 2 : anchor == "end" ? width : 0;
    Vec2 at = {number(element, "x"), number(element, "y")};
    if (!turn.empty()) {
      [[maybe_unused]] const int n =
          std::sscanf(turn.c_str(), "translate(%lf %lf) rotate(-90)", &at.x, &at.y);
      assert(n == 2);
    }
    const Vec2 start = turn.empty() ? Vec2{at.x - before, at.y} : Vec2{at.x, at.y + before};
    content_ += fmt::format("BT /F {:g} Tf {} {:.2f} {:.2f} Tm ({}) Tj ET\n", size,
                            turn.empty() ? "1 0 0 -1" : "0 -1 -1 0", start.x, start.y, escaped);
  }

  double width_, height_, size_;
  std::string content_;
  std::set<std::string> opacities_;
};

}  // namespace

std::string svg_to_pdf(const std::string& svg) {
  std::istringstream in(svg);
  Element document;
  boost::property_tree::read_xml(in, document);
  return PdfPage(document.get_child("svg")).file();
}

}  // namespace delquad
