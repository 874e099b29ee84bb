#include <fmt/format.h>

#include <ostream>

#include "apps/check_files.h"
#include "apps/commands.h"
#include "apps/print_metrics.h"
#include "cases/problem.h"
#include "delquad/error.h"
#include "io/mesh_io.h"
#include "sweep/record.h"

namespace delquad {

int metrics_command(const MetricsArguments& arguments) {
  check_distinct({{"the mesh", arguments.mesh}, {"--json", arguments.json}});
  if (!arguments.json.empty()) check_output(arguments.json);
  ReadNotes notes;
  const Mesh mesh = read_mesh(arguments.mesh, &notes);
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
  if (mesh.triangles.empty() && mesh.quads.empty())
    throw InputError(arguments.mesh.string() + ": holds no triangles and no quads to measure");
  std::shared_ptr<const SizeField> size;
  if (arguments.size) size = size_of_mesh(mesh, *arguments.size);
  const MeshMetrics metrics = evaluate_metrics(mesh, size.get());
  if (!arguments.json.empty())
    write_file_atomically(arguments.json, [&](std::ostream& out) {
      out << metrics_record(arguments.mesh.string(), arguments.size.value_or(""), metrics);
    });
  fmt::print("{}\n", arguments.mesh.string());
  print_metrics(metrics);
  return kDone;
}

}  // namespace delquad
