// SPDX-License-Identifier: GPL-3.0-or-later
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <cerrno>
#include "base/activity.h"
#include "base/find_program.h"
#include "geometry/cad/cad_request.h"
#include "tests/geometry/cad/cad_files.h"
#include "tests/support/needs_file.h"

namespace delquad {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Sets where the worker is looked for, or removes that, until the end of the scope.
class Variable {
 public:
  explicit Variable(const char* value) {
    if (const char* before = std::getenv(kName)) before_ = before;
    if (value != nullptr)
      setenv(kName, value, 1);
    else
      unsetenv(kName);
  }
  ~Variable() {
    if (before_)
      setenv(kName, before_->c_str(), 1);
    else
      unsetenv(kName);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  static constexpr const char* kName = "DELQUAD_CAD_WORKER";
  std::optional<std::string> before_;
};

class CadWorker : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path box_ = write_step(folder_ / "box.step", BRepPrimAPI_MakeBox(1, 2, 3).Shape());
  /// Takes seconds at kFine.
  std::filesystem::path torus_ = write_brep(folder_ / "torus.brep", BRepPrimAPI_MakeTorus(20, 5).Shape());
  static inline const CadOptions kFine{.deflection = 1e-7};
};

TEST_F(CadWorker, BytesGiveWhatTheirFileGives) {
  for (const auto& file : {box_, torus_}) {
    const SurfaceModel of_file = read_cad(file), of_bytes = read_cad(CadModel{"", contents(file)});
    EXPECT_EQ(of_file.fine.points, of_bytes.fine.points);
    EXPECT_EQ(of_file.fine.triangles, of_bytes.fine.triangles);
    EXPECT_EQ(of_bytes.source, "CAD data");
    ASSERT_EQ(of_file.fine.regions.size(), of_bytes.fine.regions.size());
    for (std::size_t r = 0; r < of_file.fine.regions.size(); ++r)
      EXPECT_EQ(of_file.fine.regions[r].names, of_bytes.fine.regions[r].names);
  }
}

/// Reads a model with kept models in a folder, and returns whether the worker triangulated it.
bool is_triangulated(const std::filesystem::path& file, const std::filesystem::path& cache,
                     const CadOptions& options = {}) {
  const SurfaceModel anew = read_cad(file, options);
  Activities activities(1);
  bool triangulated = false;
  activities.on_stage = [&](const char* name) { triangulated |= name == std::string(cad::kTriangulation); };
  const RunScope run({.activities = &activities});
  set_cad_cache(cache);
  const SurfaceModel model = read_cad(file, options);
  set_cad_cache({});
  EXPECT_EQ(model.fine.points, anew.fine.points);
  EXPECT_EQ(model.fine.triangles, anew.fine.triangles);
  return triangulated;
}

TEST_F(CadWorker, IsAskedOnceForEachContent) {
  const auto cache = folder_ / "cache";
  const auto is_asked = [&](const CadOptions& options = {}) { return is_triangulated(box_, cache, options); };
  EXPECT_TRUE(is_asked());
  EXPECT_FALSE(is_asked());
  EXPECT_TRUE(is_asked({.unit = "m"}));
  EXPECT_FALSE(is_asked({.unit = "m"}));
  write_step(box_, BRepPrimAPI_MakeBox(1, 2, 4).Shape());
  EXPECT_TRUE(is_asked());
  EXPECT_FALSE(is_asked());
  for (const auto& kept : std::filesystem::directory_iterator(cache))
    std::filesystem::resize_file(kept, kept.file_size() - 20);
  EXPECT_TRUE(is_asked());
  EXPECT_FALSE(is_asked());
  const auto files = [&] {
    std::vector<std::filesystem::path> all;
    for (const auto& kept : std::filesystem::directory_iterator(cache)) all.push_back(kept.path());
    return all;
  };
  const auto before = files();
  for (const auto& kept : before) {
    std::filesystem::remove(kept);
    std::filesystem::create_directory(kept);
  }
  EXPECT_TRUE(is_asked());
  EXPECT_EQ(files().size(), before.size());
  EXPECT_TRUE(is_triangulated(box_, "/dev/null/cache"));
  EXPECT_TRUE(is_triangulated(box_, "/dev/null/cache"));
}

TEST_F(CadWorker, BadBytesAreRefused) {
  expect_input_error([] { read_cad(CadModel{}); }, {"CAD model", "without bytes"});
  expect_input_error([] { read_cad(CadModel{"", "solid cube\n"}); }, {"CAD data", "neither STEP"});
  const std::string half = contents(box_).substr(0, contents(box_).size() / 2);
  expect_input_error([&] { read_cad(CadModel{"", half}); }, {"CAD data", "STEP"});
}

TEST_F(CadWorker, OneThatIsNotThereIsNamed) {
  {
    const Variable variable("/nowhere/delquad-cad");
    expect_input_error([&] { read_cad(box_); }, {"box.step", "DELQUAD_CAD_WORKER", "/nowhere/delquad-cad"});
  }
  const Variable none(nullptr);
  set_cad_worker("/nowhere/else");
  expect_input_error([&] { read_cad(box_); }, {"set_cad_worker()", "/nowhere/else"});
  set_cad_worker("");
}

TEST_F(CadWorker, IsFoundWhereTheProgramSays) {
  const std::filesystem::path worker = cad::find_worker();
  const Variable none(nullptr);
  set_cad_worker(worker);
  EXPECT_EQ(cad::find_worker(), worker);
  EXPECT_EQ(read_cad(box_).fine.regions.size(), 6u);
  set_cad_worker("");
  EXPECT_EQ(cad::find_worker(), worker) << "it lies beside the library";
  expect_input_error(
      [] {
        find_program({"delquad-none", "nothing", "DELQUAD_NONE"});
      },
      {"delquad-none", "DELQUAD_NONE", "libexec"});
}

/// One that ends without a word, one that says something else, one that is no program.
TEST_F(CadWorker, OthersAreRefused) {
  {
    const Variable variable("/bin/true");
    expect_input_error([&] { read_cad(box_); }, {"box.step", "crashes or does not end"});
  }
  const Variable variable(box_.c_str());
  expect_input_error([&] { read_cad(box_); }, {"box.step", "cannot be run"});
}

std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> all;
  for (const auto& thread :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    std::ifstream in(thread.path() / "children");
    for (pid_t child; in >> child;) all.push_back(child);
  }
  return all;
}

/// Whether it is gone, but perhaps for being waited for.
bool is_over(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/stat");
  std::string number, name, state;
  return !(in >> number >> name >> state) || state == "Z" || state == "X";
}

TEST_F(CadWorker, EndsWhenTheRunIsCancelled) {
  NEEDS_FILE("/proc/thread-self/children");
  std::stop_source stop;
  std::jthread canceller([&] {
    while (children_of(getpid()).empty()) std::this_thread::yield();
    stop.request_stop();
  });
  const RunScope run({.cancel = stop.get_token()});
  EXPECT_THROW(read_cad(torus_, kFine), Cancelled);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(CadWorker, IsToldOfByTheTimeLimit) {
  std::string what;
  // On a busy machine the first second may pass before a face begins.
  for (double seconds = 1; seconds < 50 && what.find("face 1 (") == std::string::npos; seconds *= 2) {
    const RunScope run({.seconds = seconds});
    try {
      read_cad(torus_, kFine);
      FAIL() << "no end";
    } catch (const TimeIsUp& error) {
      what = error.what();
      EXPECT_TRUE(what.starts_with(fmt::format("stopped after {:g} s: ", seconds))) << what;
    }
    EXPECT_EQ(current_activities()->faces_text(), "");
  }
  EXPECT_NE(what.find(" s: triangulation of face 1 ("), std::string::npos) << what;
}

TEST_F(CadWorker, DiesWithItsHost) {
  NEEDS_FILE("/proc/thread-self/children");
  const pid_t host = fork();
  if (host == 0) {
    try {
      read_cad(torus_, kFine);
    } catch (...) {
    }
    _exit(0);
  }
  std::vector<pid_t> workers;
  while (workers.empty() && !is_over(host)) workers = children_of(host);
  ASSERT_EQ(workers.size(), 1u);
  kill(host, SIGKILL);
  waitpid(host, nullptr, 0);
  while (!is_over(workers[0])) std::this_thread::yield();
}

/// A host's own handlers, mask, printers and output are its own.
TEST_F(CadWorker, ChangesNothingOfItsHost) {
  const auto dispositions = [] {
    std::vector<void (*)(int)> all;
    for (int s = 1; s < NSIG; ++s) {
      struct sigaction action = {};
      if (sigaction(s, nullptr, &action) == 0) all.push_back(action.sa_handler);
    }
    return all;
  };
  const auto before = dispositions();
  sigset_t mask_before, mask_after;
  pthread_sigmask(SIG_SETMASK, nullptr, &mask_before);
  const Handle(Message_Printer) printer = new Message_PrinterOStream;
  Message::DefaultMessenger()->AddPrinter(printer);
  const int printers = Message::DefaultMessenger()->Printers().Length();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::ostringstream written;
  write_example("bracket", CadFormat::kStep, written);
  read_cad(CadModel{"", written.str()});
  expect_input_error([] { read_cad(CadModel{"", "ISO-10303-21;\n#= ((;\n"}); }, {"STEP"});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(Message::DefaultMessenger()->Printers().Length(), printers);
  EXPECT_TRUE(Message::DefaultMessenger()->RemovePrinter(printer));
  EXPECT_EQ(dispositions(), before);
  pthread_sigmask(SIG_SETMASK, nullptr, &mask_after);
  for (int s = 1; s < NSIG; ++s) EXPECT_EQ(sigismember(&mask_before, s), sigismember(&mask_after, s)) << s;
}

/// A host may ignore its children, or wait for all of them itself.
TEST_F(CadWorker, WorksWhereTheHostReapsItsChildren) {
  struct sigaction ignore = {}, before = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGCHLD, &ignore, &before);
  EXPECT_EQ(read_cad(box_).fine.regions.size(), 6u);
  expect_input_error([] { read_cad(CadModel{"", "nothing"}); }, {"CAD data"});
  sigaction(SIGCHLD, &before, nullptr);
}

TEST_F(CadWorker, SeveralWorkAtOnce) {
  const SurfaceModel alone = read_cad(box_);
  std::vector<SurfaceModel> models(4);
  {
    std::vector<std::jthread> threads;
    for (SurfaceModel& model : models) threads.emplace_back([&] { model = read_cad(box_); });
  }
  for (const SurfaceModel& model : models) EXPECT_EQ(model.fine.points, alone.fine.points);
}

}  // namespace
}  // namespace delquad
