// SPDX-License-Identifier: GPL-3.0-or-later
// Opens an MSH file in deal.II and prints what it holds as JSON: points, quads, and how many cells and
// boundary faces have each number. With the argument 3 "quads" are the cells of a volume.
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>

#include <fstream>
#include <iostream>
#include <map>

namespace {

void print(const std::map<long long, long long>& counts) {
  std::cout << "{";
  const char* between = "";
  for (const auto& [tag, n] : counts) {
    std::cout << between << '"' << tag << "\": " << n;
    between = ", ";
  }
  std::cout << "}";
}

template <int dim>
void open(const char* path) {
  dealii::Triangulation<dim, 3> grid;
  dealii::GridIn<dim, 3> reader;
  reader.attach_triangulation(grid);
  std::ifstream file(path);
  reader.read_msh(file);
  std::map<long long, long long> cells, faces;
  for (const auto& cell : grid.active_cell_iterators()) {
    ++cells[cell->material_id()];
    for (const auto f : cell->face_indices())
      if (cell->face(f)->at_boundary()) ++faces[cell->face(f)->boundary_id()];
  }
  std::cout << "{\"points\": " << grid.n_used_vertices() << ", \"quads\": " << grid.n_active_cells()
            << ", \"tags\": {\"2\": ";
  print(cells);
  std::cout << ", \"1\": ";
  print(faces);
  std::cout << "}}\n";
}

}  // namespace

int main(int n, char** arguments) {
  try {
    (n > 2 ? open<3> : open<2>)(arguments[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
