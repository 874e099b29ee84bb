#pragma once

#include <filesystem>

class TopoDS_Shape;

namespace delquad::testing_support {

/// Writes a shape (STEP: in millimetres; IGES: in inches); all return the path.
std::filesystem::path write_brep(const std::filesystem::path& path, const TopoDS_Shape& shape);
std::filesystem::path write_step(const std::filesystem::path& path, const TopoDS_Shape& shape);

std::filesystem::path write_iges(const std::filesystem::path& path, const TopoDS_Shape& shape);

}  // namespace delquad::testing_support
