// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_formats.h"
#include "tests/support/failing_disk.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

using testing_support::FailingDisk;

/// The contents of a folder.
std::map<std::string, std::string> contents(const Folder& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    all[entry.path().lexically_relative(folder.path())] = entry.is_directory() ? "" : read_text(entry);
  return all;
}

/// A file that is written, and by what.
struct Writer {
  std::string name;
  std::function<void(const fs::path&)> write;
};

void PrintTo(const Writer& writer, std::ostream* out) { *out << writer.name; }

class FullDisk : public ::testing::TestWithParam<Writer> {
 protected:
  FullDisk() { setenv("TMPDIR", temporary_.path().c_str(), 1); }
  ~FullDisk() override { before_ ? setenv("TMPDIR", before_, 1) : unsetenv("TMPDIR"); }

  /// Writes on such a disk: there is the whole file then, or what was there before and a message.
  template <class MakeDisk>
  void try_on(MakeDisk make_disk, const std::string& what, const char* reason) {
    SCOPED_TRACE(GetParam().name + ", " + what);
    const Folder folder;
    write_text(folder / GetParam().name, "before");
    const auto before = contents(folder);
    std::string message;
    testing::internal::CaptureStderr();
    try {
      [[maybe_unused]] const FailingDisk disk = make_disk();
      GetParam().write(folder / GetParam().name);
    } catch (const InputError& error) {
      message = error.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(temporary_.names(), std::vector{folder.path().filename().string()});
    if (message.empty()) {
      EXPECT_TRUE(contents(folder) == good_) << "a file that is not whole";
      return;
    }
    ++messages_;
    EXPECT_TRUE(contents(folder) == before) << "something is left";
    EXPECT_TRUE(holds(message, folder.path().string()));
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_TRUE(holds(message, reason));
  }

  const char* before_ = getenv("TMPDIR");
  const Folder temporary_;
  std::map<std::string, std::string> good_;
  int messages_ = 0;
};

TEST_P(FullDisk, LeavesWholeFilesOrNone) {
  long long bytes = 0, calls = 0;
  {
    const Folder folder;
    const FailingDisk disk = FailingDisk::sound();
    GetParam().write(folder / GetParam().name);
    bytes = disk.bytes(), calls = disk.calls();
    good_ = contents(folder);
  }
  ASSERT_GT(calls, 1);
  constexpr int kSteps = 25;
  for (int k = 0; k < kSteps; ++k) {
    const long long room = bytes * k / kSteps;
    try_on([&] { return FailingDisk::full_after(room); }, "room for " + std::to_string(room) + " bytes",
           "No space left");
  }
  try_on([&] { return FailingDisk::full_after(bytes - 1); }, "one byte is missing", "No space left");
  EXPECT_EQ(messages_, kSteps + 1);
  // CGNS asks nobody whether data that HDF5 held back were written in the end; on a full disk it notices
  // later.
  if (GetParam().name.ends_with(".cgns")) return;
  for (long long call = 1; call <= calls; ++call)
    try_on([&] { return FailingDisk::failing_at(call); },
           "call " + std::to_string(call) + " of " + std::to_string(calls), "cannot be written: ");
}

TEST_P(FullDisk, NeedsAFolderForTemporaryFilesWhereItHasThem) {
  const Folder folder;
  setenv("TMPDIR", (folder / "nowhere").c_str(), 1);
  const std::string message = message_of([&] { GetParam().write(folder / GetParam().name); });
  if (message.empty()) return;  // it has none
  EXPECT_TRUE(holds(message, (folder / "").string(), "(TMPDIR): "));
  EXPECT_TRUE(folder.names().empty());
}

std::vector<Writer> writers() {
  std::vector<Writer> all;
  const auto add = [&](const std::string& name, auto write) {
    const MeshFormat* format = nullptr;
    for (const MeshFormat& one : mesh_formats())
      if (name.ends_with(one.extensions[0])) format = &one;
    if (format->package.empty()) all.push_back({name, write});
  };
  constexpr int kAcross = 20;
  for (const MeshFormat& format : mesh_formats()) {
    const std::string extension = format.extensions[0];
    if (can_write(format) && format.has_faces)
      add("flat" + extension, [&format, extension](const auto& path) {
        const bool triangles = std::ranges::count(format.of_triangles, extension) > 0;
        write_mesh(path, quad_grid(kAcross, kAcross), {.triangles = triangles});
      });
    if (can_write(format) && format.most_order > 1)
      add("curved" + extension, [](const auto& path) { write_mesh(path, curved_grid(8, 8, 2, false)); });
    if (format.has_cells)
      add("hexahedra" + extension, [](const auto& path) {
        Mesh mesh;
        for (int i = 0; i <= kAcross; ++i)
          for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
            mesh.points.push_back({double(x), double(y), double(i)});
        for (int i = 0; i < kAcross; ++i)
          mesh.hexahedra.push_back(
              {4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3, 4 * i + 4, 4 * i + 5, 4 * i + 6, 4 * i + 7});
        mesh.hex_volume.assign(mesh.hexahedra.size(), 0);
        mesh.volumes = {{1, {"bar"}}};
        write_mesh(path, mesh);
      });
  }
  add("bytes.msh", [](const auto& path) { write_mesh(path, quad_grid(kAcross, kAcross), {.binary = true}); });
  return all;
}

INSTANTIATE_TEST_SUITE_P(Formats, FullDisk, ::testing::ValuesIn(writers()), [](const auto& test) {
  std::string name = test.param.name;
  name[name.find('.')] = '_';
  return name;
});

}  // namespace
}  // namespace delquad
