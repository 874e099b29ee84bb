// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/wanted_fields.h"

#include <utility>
#include <vector>

#include "io/mesh_io.h"

namespace delquad {

void write_wanted(const std::filesystem::path& path, const Mesh& mesh, const Prepared& prepared) {
  WantedAt wanted = wanted_at(prepared, mesh);
  std::vector<MeshField> fields = {
      {"size", true, 1, std::move(wanted.size)}, {"cross_1", true, 3, {}}, {"cross_2", true, 3, {}}};
  for (const auto& edges : wanted.edges)
    for (const std::size_t k : {0, 1})
      for (const double v : {edges[k].x, edges[k].y, edges[k].z}) fields[k + 1].values.push_back(v);
  write_fields(path, mesh, fields);
}

}  // namespace delquad
