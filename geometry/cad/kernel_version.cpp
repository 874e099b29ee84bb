#include <dlfcn.h>

#include <Standard.hxx>
#include <Standard_Version.hxx>
#include <filesystem>
#include <string>
#include <system_error>

#include "geometry/cad/cad_worker.h"

namespace delquad {

/// By the name of the library's file, "libTKernel.so.7.6.3": it need not be the one that was compiled for.
std::string cad::kernel_version() {
  Dl_info here = {};
  std::error_code unknown;
  std::string file;
  if (dladdr(reinterpret_cast<void*>(&Standard::Purge), &here) != 0 && here.dli_fname != nullptr)
    file = std::filesystem::canonical(here.dli_fname, unknown).filename().string();
  const std::string before = ".so.";
  const auto at = file.find(before);
  return at == std::string::npos ? OCC_VERSION_COMPLETE : file.substr(at + before.size());
}

}  // namespace delquad
