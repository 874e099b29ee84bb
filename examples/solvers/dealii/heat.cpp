// Conducts heat through the plate of ../heat.toml by deal.II: heat MESH.msh SOLUTION.json. Elements are
// bilinear.
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

#include <fstream>
#include <iostream>
#include <map>
#include <string>
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

int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "expected MESH.msh SOLUTION.json\n", 2;
  Triangulation<2> grid;
  GridIn<2> reader(grid);
  std::ifstream file(argv[1]);
  reader.read_msh(file);
  const FE_Q<2> fe(1);
  DoFHandler<2> dofs(grid);
  dofs.distribute_dofs(fe);
  const auto ids = names_of_curves(argv[1]);
  AffineConstraints<double> fixed;
  VectorTools::interpolate_boundary_values(dofs, ids.at("hot"), Functions::ConstantFunction<2>(1), fixed);
  VectorTools::interpolate_boundary_values(dofs, ids.at("cold"), Functions::ZeroFunction<2>(), fixed);
  fixed.close();
  DynamicSparsityPattern pattern(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, pattern);
  SparsityPattern sparsity;
  sparsity.copy_from(pattern);
  SparseMatrix<double> matrix(sparsity);
  Vector<double> u(dofs.n_dofs()), on_cells(grid.n_active_cells());
  const Functions::ZeroFunction<2> zero;
  const Function<2>* const no_coefficient = nullptr;
  MatrixCreator::create_laplace_matrix(dofs, QGauss<2>(2), matrix, zero, u, no_coefficient, fixed);
  SparseDirectUMFPACK solver;
  solver.solve(matrix, u);
  fixed.distribute(u);
  VectorTools::integrate_difference(dofs, u, zero, on_cells, QGauss<2>(2), VectorTools::H1_seminorm);
  // Between a difference of temperatures of one, the heat that flows is the energy.
  std::cout.precision(10);
  std::cout << grid.n_active_cells() << " elements of order 1\nheat from hot to cold: " << on_cells.norm_sqr()
            << '\n';

  std::ofstream out(argv[2]);
  out.precision(8);
  const char* comma = "[";
  for (const auto& cell : dofs.active_cell_iterators()) {
    const char* inner = "[";
    out << comma;
    for (const unsigned k : {0, 1, 3, 2}) {  // around the cell
      out << inner << '[' << cell->vertex(k)[0] << ", " << cell->vertex(k)[1] << ", 0, "
          << u(cell->vertex_dof_index(k, 0)) << ']';
      inner = ", ";
    }
    out << ']';
    comma = ",\n";
  }
  out << "]\n";
}
