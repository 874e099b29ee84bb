#pragma once

#include <filesystem>
#include <string>

class TopoDS_Shape;

namespace delquad::testing_support {

/// Writes a shape; both return the path.
std::filesystem::path write_brep(const std::filesystem::path& path, const TopoDS_Shape& shape);
/// `unit`: of lengths in the file, "MM" or "INCH".
std::filesystem::path write_step(const std::filesystem::path& path, const TopoDS_Shape& shape,
                                 const std::string& unit = "MM");

}  // namespace delquad::testing_support
