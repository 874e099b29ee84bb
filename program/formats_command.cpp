#include <fmt/format.h>

#include "io/mesh_formats.h"
#include "program/commands.h"

namespace delquad {

int formats_command() {
  constexpr const char* kRow = "{:<18}{:<7}{:<8}{:<7}{}\n";
  fmt::print(kRow, "extension", "reads", "writes", "order", "what it is");
  for (const MeshFormat& format : mesh_formats()) {
    const bool written = can_write(format);
    std::string what = format.description;
    if (format.write_hexahedra != nullptr) what += "; hexahedra, too";
    if (!format.package.empty())
      what += fmt::format(" (not in this program: install {} and build it again)", format.package);
    fmt::print(kRow, fmt::format("{}", fmt::join(format.extensions, " ")), format.read ? "yes" : "-",
               written ? "yes" : "-",
               !written                ? "-"
               : format.most_order > 1 ? fmt::format("1-{}", format.most_order)
                                       : "1",
               what);
  }
  return kDone;
}

}  // namespace delquad
