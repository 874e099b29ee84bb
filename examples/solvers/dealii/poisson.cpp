// SPDX-License-Identifier: GPL-3.0-or-later
// Solves by bilinear elements of deal.II.
// Usage: `poisson heat MESH.msh SOLUTION.json`, or `poisson shock MESH.msh SOLUTION.json SOLUTION.msh`.
// SOLUTION.msh has the mesh, with u at its points. `heat` conducts heat through the plate of ../heat.toml.
// `shock` is Poisson's equation for atan(60 (r - pi/3)), r from (1.25, -0.25), a layer along an arc.
#include <deal.II/base/function.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/numerics/matrix_creator.h>
#include <deal.II/numerics/vector_tools.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <utility>
using namespace dealii;

// Numbers of curves by name: $PhysicalNames of an MSH file, which deal.II leaves out. They are the boundary
// ids.
std::map<std::string, types::boundary_id> names_of_curves(const std::string& path) {
  std::map<std::string, types::boundary_id> ids;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line) && line != "$PhysicalNames") continue;
  std::getline(file, line);  // how many
  while (std::getline(file, line) && line[0] != '$')
    if (line[0] == '1') {
      const auto quote = line.find('"');
      ids[line.substr(quote + 1, line.rfind('"') - quote - 1)] = std::stoi(line.substr(2));
    }
  return ids;
}

// The true solution of shock.
class Shock : public Function<2> {
 public:
  double value(const Point<2>& x, unsigned) const override { return std::atan(at(x)); }
  Tensor<1, 2> gradient(const Point<2>& x, unsigned) const override {
    return slope(x) / radius(x) * (x - centre);
  }
  double laplacian(const Point<2>& x, unsigned) const override {
    return slope(x) / radius(x) - 2 * at(x) * slope(x) * slope(x);
  }

 private:
  double radius(const Point<2>& x) const { return x.distance(centre); }
  double at(const Point<2>& x) const { return 60 * (radius(x) - numbers::PI / 3); }
  double slope(const Point<2>& x) const { return 60 / (1 + at(x) * at(x)); }
  const Point<2> centre{1.25, -0.25};
};

// For ../picture.py: the corners of each cell, around it.
void write_cells(const std::string& path, const DoFHandler<2>& dofs, const Vector<double>& u) {
  std::ofstream out(path);
  out.precision(8);
  const char* comma = "[";
  for (const auto& cell : dofs.active_cell_iterators()) {
    const char* inner = "[";
    out << comma;
    for (const unsigned k : {0, 1, 3, 2}) {
      out << inner << '[' << cell->vertex(k)[0] << ", " << cell->vertex(k)[1] << ", 0, "
          << u(cell->vertex_dof_index(k, 0)) << ']';
      inner = ", ";
    }
    out << ']';
    comma = ",\n";
  }
  out << "]\n";
}

// The mesh with u as a view, for delquad: MSH 2.2.
void write_points(const std::string& path, const DoFHandler<2>& dofs, const Vector<double>& u) {
  std::map<unsigned, std::pair<Point<2>, double>> points;
  for (const auto& cell : dofs.active_cell_iterators())
    for (const unsigned k : cell->vertex_indices())
      points[cell->vertex_index(k)] = {cell->vertex(k), u(cell->vertex_dof_index(k, 0))};
  std::ofstream out(path);
  out.precision(17);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << points.size() << '\n';
  for (const auto& [vertex, at] : points) out << vertex + 1 << ' ' << at.first << " 0\n";
  out << "$EndNodes\n$Elements\n" << dofs.get_triangulation().n_active_cells() << '\n';
  for (const auto& cell : dofs.active_cell_iterators()) {
    out << cell->active_cell_index() + 1 << " 3 2 1 1";
    for (const unsigned k : {0, 1, 3, 2}) out << ' ' << cell->vertex_index(k) + 1;
    out << '\n';
  }
  out << "$EndElements\n$NodeData\n1\n\"u\"\n1\n0\n3\n0\n1\n" << points.size() << '\n';
  for (const auto& [vertex, at] : points) out << vertex + 1 << ' ' << at.second << '\n';
  out << "$EndNodeData\n";
}

int main(int argc, char** argv) {
  const std::string problem = argc > 1 ? argv[1] : "";
  const bool is_heat = problem == "heat";
  if (argc != (is_heat ? 4 : 5))
    return std::cerr << "expected heat MESH.msh SOLUTION.json, or shock and SOLUTION.msh besides\n", 2;
  Triangulation<2> grid;
  GridIn<2> reader(grid);
  std::ifstream file(argv[2]);
  reader.read_msh(file);
  const FE_Q<2> fe(1);
  DoFHandler<2> dofs(grid);
  dofs.distribute_dofs(fe);
  const Shock shock;
  const Functions::ZeroFunction<2> zero;
  AffineConstraints<double> fixed;
  if (is_heat) {
    const auto ids = names_of_curves(argv[2]);
    VectorTools::interpolate_boundary_values(dofs, ids.at("hot"), Functions::ConstantFunction<2>(1), fixed);
    VectorTools::interpolate_boundary_values(dofs, ids.at("cold"), zero, fixed);
  } else {
    for (const auto id : grid.get_boundary_ids())
      VectorTools::interpolate_boundary_values(dofs, id, shock, fixed);
  }
  fixed.close();
  DynamicSparsityPattern pattern(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, pattern);
  SparsityPattern sparsity;
  sparsity.copy_from(pattern);
  SparseMatrix<double> matrix(sparsity);
  Vector<double> u(dofs.n_dofs()), on_cells(grid.n_active_cells());
  const QGauss<2> places(is_heat ? 2 : 9);  // the layer within one quad of a coarse mesh
  const ScalarFunctionFromFunctionObject<2> load(
      [&](const Point<2>& x) { return is_heat ? 0 : -shock.laplacian(x, 0); });
  const Function<2>* const no_coefficient = nullptr;
  MatrixCreator::create_laplace_matrix(dofs, places, matrix, load, u, no_coefficient, fixed);
  SparseDirectUMFPACK solver;
  solver.solve(matrix, u);
  fixed.distribute(u);
  const auto error = [&](const Function<2>& true_solution, VectorTools::NormType norm) {
    VectorTools::integrate_difference(dofs, u, true_solution, on_cells, places, norm);
    return on_cells.l2_norm();
  };
  std::cout.precision(10);
  if (is_heat) {
    // Between a difference of temperatures of one, the heat that flows is the energy.
    const double heat = std::pow(error(zero, VectorTools::H1_seminorm), 2);
    std::cout << grid.n_active_cells() << " elements of order 1\nheat from hot to cold: " << heat << '\n';
  } else {
    std::cout << grid.n_active_cells() << ' ' << error(shock, VectorTools::L2_norm) << ' '
              << error(shock, VectorTools::H1_seminorm) << '\n';
    write_points(argv[4], dofs, u);
  }
  write_cells(argv[3], dofs, u);
}
