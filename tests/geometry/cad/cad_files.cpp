// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/cad/cad_files.h"
#include <BRepTools.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Shape.hxx>
#include "tests/support/meshing.h"

namespace delquad::testing_support {

std::filesystem::path write_brep(const std::filesystem::path& path, const TopoDS_Shape& shape) {
  if (!BRepTools::Write(shape, path.c_str())) throw std::runtime_error("cannot write " + path.string());
  return path;
}

std::filesystem::path write_step(const std::filesystem::path& path, const TopoDS_Shape& shape) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPControl_Writer writer;
  if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone ||
      writer.Write(path.c_str()) != IFSelect_RetDone) {
    throw std::runtime_error("cannot write " + path.string());
  }
  return path;
}

std::filesystem::path write_iges(const std::filesystem::path& path, const TopoDS_Shape& shape) {
  IGESControl_Controller::Init();
  IGESControl_Writer writer("MM", 1);  // faces, edges and solids as they are
  if (!writer.AddShape(shape) || !writer.Write(path.c_str()))
    throw std::runtime_error("cannot write " + path.string());
  return path;
}

}  // namespace delquad::testing_support
