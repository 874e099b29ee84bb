#include "io/cases/size_file.h"

#include <utility>

#include "base/located.h"
#include "fields/fields.h"
#include "io/mesh_io.h"

namespace delquad {

std::optional<SizeFile> size_file_of(const std::string& text, const std::filesystem::path& folder) {
  if (holds_values(text)) return SizeFile{folder / text, ""};
  for (std::size_t at = text.find(':'); at != std::string::npos; at = text.find(':', at + 1))
    if (const std::string file = text.substr(0, at); holds_values(file))
      return SizeFile{folder / file, text.substr(at + 1)};
  return std::nullopt;
}

std::unique_ptr<SizeField> make_file_size(const std::filesystem::path& file, const std::string& field) {
  NodalValues size = read_values(file, field);
  return located(file.string(), [&] { return make_nodal_size(size.mesh, std::move(size.values)); });
}

}  // namespace delquad
