#include "program/extrude_options.h"

#include <CLI/CLI.hpp>

namespace delquad {

CLI::App* add_extrude(CLI::App& app, ExtrudeArguments& arguments) {
  CLI::App* extrude = app.add_subcommand("extrude", "Sweep a mesh of quads: hexahedra");
  extrude->add_option("mesh", arguments.mesh, "mesh file, quads alone")->required();
  extrude->add_option("-o,--output", arguments.output, "hexahedra to write (.msh, .vtu or .inp)")->required();
  extrude->add_option("--along", arguments.along,
                      "X,Y,Z: the vector from the first layer of nodes to the last");
  extrude->add_option("--around", arguments.around,
                      "PX,PY,PZ,DX,DY,DZ: a point of the axis and its direction");
  extrude->add_option("--angle", arguments.angle,
                      "degrees around the axis; default: 360, which closes the ring");
  extrude->add_option("--curve", arguments.curve,
                      "points of a line (.txt, x y z on each), or FILE[:NAME], lines of a mesh file");
  extrude->add_flag("--normals", arguments.normals, "along the normals: shells get a thickness");
  extrude->add_option("--thickness", arguments.thickness,
                      "with --normals, negative against them; with --along the length in the vector's place");
  extrude->add_flag("--both-sides", arguments.both_sides, "half of the thickness to each side");
  extrude
      ->add_option("--layers", arguments.layers, "of hexahedra; default with --curve: one for each segment")
      ->check(CLI::PositiveNumber);
  extrude->add_option("--growth", arguments.growth, "height of each layer over that of the one before")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  extrude->add_flag("--binary", arguments.binary, "write .msh as bytes");
  extrude->add_option("--json", arguments.json, "record to write");
  return extrude;
}

}  // namespace delquad
