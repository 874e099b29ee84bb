// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <sys/resource.h>

#include <array>
#include <cctype>
#include <cmath>
#include <sstream>

#include "geometry/cad/cad_reader.h"
#include "geometry/cad/example_models.h"
#include "geometry/mesh/check_mesh.h"
#include "tests/fuzz/draw.h"
#include "tests/fuzz/target.h"

namespace delquad::fuzz {

namespace {

/// Pieces of a file that are replaced as a whole: numbers, references, words, signs.
std::vector<std::string> tokens_of(const std::string& text) {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  const auto in_number = [&](char c) { return in_word(c) || c == '.' || c == '-' || c == '+'; };
  std::vector<std::string> tokens;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    if (in_number(text[i]) || text[i] == '#')
      while (end < text.size() && in_number(text[end])) ++end;
    tokens.push_back(text.substr(i, end - i));
    i = end;
  }
  return tokens;
}

std::string example_file(int number, CadFormat format) {
  constexpr std::array kNames = {"thin_box", "sphere", "torus", "cone_tip"};
  std::ostringstream text;
  write_example(kNames[static_cast<std::size_t>(number) % kNames.size()], format, text);
  return text.str();
}

/// An example's file in which the bytes change some tokens: most of it still says something.
class Editor {
 public:
  Editor(Draw& draw, CadFormat format) : draw_(draw) {
    static std::array<std::array<std::vector<std::string>, 4>, 2> files;
    const int number = draw_.below(4);
    std::vector<std::string>& file =
        files[format == CadFormat::kStep ? 0 : 1][static_cast<std::size_t>(number)];
    if (file.empty()) file = tokens_of(example_file(number, format));
    tokens_ = file;
  }

  std::string text() {
    while (!draw_.at_end()) edit();
    std::string text;
    for (const std::string& token : tokens_) text += token;
    return text;
  }

 private:
  std::size_t place() {
    const int high = draw_.byte(), low = draw_.byte();
    return static_cast<std::size_t>(256 * high + low) % tokens_.size();
  }

  /// The next token from there that is a number or a reference.
  std::string& number() {
    std::size_t at = place();
    for (std::size_t n = 0; n < tokens_.size() && !is_number(tokens_[at]); ++n)
      at = (at + 1) % tokens_.size();
    return tokens_[at];
  }
  static bool is_number(const std::string& token) {
    return token.find_first_of("0123456789") != std::string::npos;
  }

  void edit() {
    constexpr std::array kNumbers = {"0.",  "-1.",        "1.E308", "-1.E-308", "1.E-9", "1.E9",
                                     "NAN", "2147483648", "0",      "1",        "-1",    "99999999"};
    switch (draw_.below(6)) {
      case 0:
        number() = kNumbers[static_cast<std::size_t>(draw_.below(kNumbers.size()))];
        return;
      case 1: {  // one for another
        const std::string other = number();
        number() = other;
        return;
      }
      case 2: {
        std::string& text = number();
        text = fmt::format("{}{}", text, draw_.byte());
        return;
      }
      case 3: {
        const std::string other = tokens_[place()];
        tokens_[place()] = other;
        return;
      }
      case 4:
        tokens_[place()].clear();
        return;
      default: {  // some are lost
        const std::size_t first = place(), n = static_cast<std::size_t>(draw_.byte());
        for (std::size_t i = first; i < std::min(first + n, tokens_.size()); ++i) tokens_[i].clear();
      }
    }
  }

  Draw& draw_;
  std::vector<std::string> tokens_;
};

/// A model that was read has indices in range, finite points, and finite points on its faces.
void check_model(const SurfaceModel& model) {
  try {
    require_readable(model.fine, "read");
  } catch (const InputError& error) {
    require(false, error.what());
  }
  require(!model.fine.triangles.empty(), "a model without triangles");
  for (std::size_t t = 0; t < model.fine.triangles.size(); t += 1 + model.fine.triangles.size() / 16) {
    const auto [a, b, c] = model.fine.triangles[t];
    const auto& points = model.fine.points;
    const Vec3 on = model.projector->to_face(model.fine.triangle_region[t],
                                             1.0 / 3 * (points[a] + points[b] + points[c]));
    require(std::isfinite(on.x) && std::isfinite(on.y) && std::isfinite(on.z),
            "a projected point is not finite");
  }
}

/// Belongs to the largest process that has ended.
void check_memory_of_workers() {
  constexpr long kMost = 2L << 20;  // KiB
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  require(used.ru_maxrss < kMost, "the process that reads took more than 2 GiB");
}

/// Bytes that begin as such a file does are one; others change one.
template <CadFormat format>
bool try_cad(std::string_view bytes) {
  constexpr std::size_t kHead = 100;
  const std::string_view head = format == CadFormat::kStep ? "ISO-10303-21" : "CASCADE Topology";
  CadModel model;
  if (bytes.substr(0, kHead).find(head) != std::string_view::npos) {
    model.bytes = bytes;
  } else {
    Draw draw(bytes);
    model.bytes = Editor(draw, format).text();
  }
  const bool came = result_or_input_error("CAD data", [&] {
    check_model(read_cad(model, {.deflection = 0.02, .angle = 0.6, .keep_going = true}));
  });
  check_memory_of_workers();
  return came;
}

template <CadFormat format>
std::vector<std::string> cad_seeds() {
  // Each example as it is, and one written out.
  return {std::string(1, '\0'), std::string(1, '\1'), std::string(1, '\2'), std::string(1, '\3'),
          example_file(1, format)};
}

}  // namespace

std::vector<Target> cad_targets() {
  constexpr int kLongest = 1 << 14;
  return {{"step", try_cad<CadFormat::kStep>, cad_seeds<CadFormat::kStep>, kLongest},
          {"brep", try_cad<CadFormat::kBrep>, cad_seeds<CadFormat::kBrep>, kLongest}};
}

}  // namespace delquad::fuzz
