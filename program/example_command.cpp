#include <fmt/format.h>

#include <ostream>

#include "delquad/error.h"
#include "geometry/cad/example_models.h"
#include "io/mesh_io.h"
#include "program/check_files.h"
#include "program/commands.h"

namespace delquad {
namespace {

CadFormat format_of(const std::filesystem::path& path) {
  const std::string extension = kind_of_file(path);
  if (extension == ".step" || extension == ".stp") return CadFormat::kStep;
  if (extension == ".brep") return CadFormat::kBrep;
  throw InputError(path.string() + ": unknown CAD format '" + extension + "'; known: .step, .stp, .brep");
}

}  // namespace

int example_command(const ExampleArguments& arguments) {
  if (arguments.list) {
    for (const Example& example : example_models())
      fmt::print("{:<10} {}\n", example.name, example.description);
    return kDone;
  }
  if (arguments.name.empty()) throw InputError("example: expected a name, or --list to see all");
  check_example(arguments.name);
  if (arguments.output.empty()) throw InputError("example: expected -o and a CAD file to write");
  const CadFormat format = format_of(arguments.output);
  check_output(arguments.output);
  write_file_atomically(arguments.output,
                        [&](std::ostream& out) { write_example(arguments.name, format, out); });
  fmt::print("{}\n", arguments.output.string());
  return kDone;
}

}  // namespace delquad
