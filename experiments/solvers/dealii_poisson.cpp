// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of bilinear elements of deal.II for the planar solution of 'solver = ["poisson"]', as JSON:
// dealii_poisson MESH.msh
#include <deal.II/base/function.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/numerics/vector_tools.h>

#include <fstream>
#include <iostream>
using namespace dealii;

// sin(pi/2 r^2) with r the distance from the centroid in radii of gyration.
struct Wave : Function<2> {
  Point<2> centre;
  double radius = 1;
  double value(const Point<2>& p, unsigned int = 0) const override {
    return std::sin(numbers::PI_2 * (p - centre).norm_square() / (radius * radius));
  }
  Tensor<1, 2> gradient(const Point<2>& p, unsigned int = 0) const override {
    const double r2 = radius * radius;
    return numbers::PI / r2 * std::cos(numbers::PI_2 * (p - centre).norm_square() / r2) * (p - centre);
  }
};

int main(int, char** argv) {
  Triangulation<2> grid;
  GridIn<2> reader(grid);
  std::ifstream file(argv[1]);
  reader.read_msh(file);
  Wave u;
  FE_Q<2> fe(1);
  DoFHandler<2> dofs(grid);
  dofs.distribute_dofs(fe);
  FEValues<2> two(fe, QGauss<2>(2), update_gradients | update_quadrature_points | update_JxW_values);
  FEValues<2> three(fe, QGauss<2>(3), update_quadrature_points | update_JxW_values);
  double area = 0, second = 0;
  Tensor<1, 2> first;
  for (const auto& cell : dofs.active_cell_iterators())
    for (unsigned q = (three.reinit(cell), 0); q < 9; ++q) {
      const Point<2> x = three.quadrature_point(q);
      area += three.JxW(q), first += three.JxW(q) * x, second += three.JxW(q) * x.square();
    }
  u.centre = Point<2>(first / area), u.radius = std::sqrt(second / area - u.centre.square());
  AffineConstraints<double> fixed;
  VectorTools::interpolate_boundary_values(dofs, 0, u, fixed);
  for (const auto id : grid.get_boundary_ids()) VectorTools::interpolate_boundary_values(dofs, id, u, fixed);
  fixed.close();
  DynamicSparsityPattern pattern(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, pattern);
  SparsityPattern sparsity;
  sparsity.copy_from(pattern);
  SparseMatrix<double> matrix(sparsity);
  Vector<double> right(dofs.n_dofs()), on_cells(grid.n_active_cells());
  std::vector<types::global_dof_index> rows(4);
  for (const auto& cell : dofs.active_cell_iterators()) {
    FullMatrix<double> local(4, 4);
    Vector<double> load(4);
    for (unsigned q = (two.reinit(cell), 0); q < 4; ++q)
      for (unsigned i = 0; i < 4; ++i) {
        load(i) += two.JxW(q) * (u.gradient(two.quadrature_point(q)) * two.shape_grad(i, q));
        for (unsigned j = 0; j < 4; ++j)
          local(i, j) += two.JxW(q) * (two.shape_grad(i, q) * two.shape_grad(j, q));
      }
    cell->get_dof_indices(rows);
    fixed.distribute_local_to_global(local, load, rows, matrix, right);
  }
  SparseDirectUMFPACK solver;
  solver.solve(matrix, right);
  fixed.distribute(right);
  const auto norm = [&](const Vector<double>& v, VectorTools::NormType type) {
    VectorTools::integrate_difference(dofs, v, u, on_cells, QGauss<2>(3), type);
    return VectorTools::compute_global_error(grid, on_cells, type);
  };
  const Vector<double> zero(dofs.n_dofs());
  std::cout.precision(15);
  std::cout << "{\"l2\": " << norm(right, VectorTools::L2_norm) / norm(zero, VectorTools::L2_norm)
            << ", \"h1\": " << norm(right, VectorTools::H1_seminorm) / norm(zero, VectorTools::H1_seminorm)
            << "}\n";
}
