// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include "experiments/sweep/run_experiment.h"
#include "experiments/sweep/verify.h"
#include "metrics/tables/result_records.h"
#include "tests/support/files.h"
#include "tests/support/needs_file.h"

namespace delquad {
namespace {

const std::string kSweep =
    "title = 'A sweep'\npipelines = ['F', 'FB', 'DB', 'DBC']\n[matrix]\nseed = [1, 2, 3]\n"
    "[[case]]\nname = 'square'\nsize = 0.2\nloop = { rectangle = [[0, 0], [1, 1]] }\n"
    "[[case]]\nname = 'disc'\nsize = 0.3\nloop = { circle = { centre = [0, 0], radius = 1 } }\n";
constexpr int kResumedCells = 24;

class Resume : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    done_ = std::make_unique<Folder>();
    run_experiment(Experiment::read(write_text(*done_ / "sweep.toml", kSweep)), *done_ / "out");
  }
  static void TearDownTestSuite() { done_.reset(); }
  /// Copies the results of the sweep, which is run once for all tests, to a folder.
  std::string done(const std::string& name = "out") const {
    fs::copy(*done_ / "out", out(name), fs::copy_options::recursive);
    return out(name);
  }
  fs::path write(const std::string& text) { return write_text(folder_ / "sweep.toml", text); }
  ProgramResult program(Strings arguments) {
    return run_program(DELQUAD_PROGRAM, {std::move(arguments), 0, {}});
  }
  std::string out(const std::string& name = "out") const { return (folder_ / name).string(); }

  Folder folder_;
  static inline std::unique_ptr<Folder> done_;
};

/// Everything but times, by cell.
std::map<std::string, std::map<std::string, double>> values_of(const fs::path& folder) {
  std::map<std::string, std::map<std::string, double>> values;
  for (CellRecord& record : read_records(folder)) {
    EXPECT_EQ(record.reason, "");
    std::erase_if(record.values,
                  [](const auto& v) { return v.first.starts_with("seconds") || std::isnan(v.second); });
    values[record.group + " " + record.pipeline] = record.values;
  }
  return values;
}

std::map<fs::path, fs::file_time_type> record_times(const fs::path& folder) {
  std::map<fs::path, fs::file_time_type> times;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == "record.json" && entry.path().parent_path().extension() != ".tmp")
      times[entry.path()] = entry.last_write_time();
  return times;
}

TEST_F(Resume, DoneCellsAreLeftAloneUntilTheyAreOutdated) {
  const Experiment experiment = Experiment::read(write(kSweep));
  const auto first = record_times(done());
  ASSERT_EQ(first.size(), std::size_t{kResumedCells});
  run_experiment(experiment, out());
  EXPECT_EQ(record_times(out()), first);

  const fs::path one = fs::path(out()) / "disc@seed=2" / "DB" / "record.json";
  fs::remove(one);
  run_experiment(experiment, out());
  auto times = record_times(out());
  EXPECT_NE(times.at(one), first.at(one));
  times[one] = first.at(one);
  EXPECT_EQ(times, first);

  std::string finer = kSweep;
  finer.replace(finer.find("0.3"), 3, "0.2");  // of the discs
  const Experiment changed = Experiment::read(write(finer));
  EXPECT_TRUE(holds(list_cells(changed, out()), "outdated       disc@seed=1 DB\n",
                    "done           square@seed=1 DB\n"));
  run_experiment(changed, out());
  for (const auto& [path, time] : record_times(out()))
    EXPECT_EQ(time == first.at(path), path.string().find("square") != std::string::npos) << path;

  SweepOptions force;
  force.force = true;
  run_experiment(changed, out(), force);
  for (const auto& [path, time] : record_times(out())) EXPECT_NE(time, first.at(path)) << path;
}

TEST_F(Resume, AnyNumberOfProcessesAndShardsMakesTheSame) {
  const Experiment experiment = Experiment::read(write(kSweep));
  SweepOptions parallel;
  parallel.limits.jobs = 4;
  run_experiment(experiment, out("parallel"), parallel);
  for (std::size_t i = 0; i < 4; ++i) {
    SweepOptions part;
    part.shard = {i, 4};
    run_experiment(experiment, out("shards"), part);
    // Six variants of four cells: two, two, one and one.
    constexpr std::size_t kSoFar[] = {8, 16, 20, 24};
    EXPECT_EQ(record_times(out("shards")).size(), kSoFar[i]);
  }
  const auto whole = values_of(done("whole"));
  ASSERT_EQ(whole.size(), std::size_t{kResumedCells});
  EXPECT_EQ(values_of(out("parallel")), whole);
  EXPECT_EQ(values_of(out("shards")), whole);
  for (const char* mesh : {"square@seed=1/F/mesh.msh", "disc@seed=3/DBC/mesh.msh"})
    EXPECT_EQ(read_text(out("parallel") + "/" + mesh), read_text(out("whole") + "/" + mesh)) << mesh;
}

/// Points are inserted once for pipelines that begin alike: their records show the same time, to the last
/// bit.
TEST_F(Resume, PipelinesThatBeginAlikeShareTheirStages) {
  done();
  const auto inserting = [&](const std::string& word) {
    for (const CellRecord& record : read_records(out()))
      if (record.group == "disc@seed=2" && record.pipeline == word)
        return record.values.at("seconds_insertion");
    return -1.0;
  };
  EXPECT_GT(inserting("F"), 0);
  EXPECT_EQ(inserting("F"), inserting("FB"));
  EXPECT_EQ(inserting("DB"), inserting("DBC"));
  EXPECT_NE(inserting("F"), inserting("DB"));
}

/// Remains of an earlier run do not stand for files that a new one failed to make.
TEST_F(Resume, AForcedRunThatFailsLeavesNoOldResult) {
  const std::string file = write(kSweep).string();
  done();
  EXPECT_EQ(program({"run", file, "-o", out(), "--force", "--timeout", "0.001"}).exit_code, 1);
  for (const CellRecord& record : read_records(out())) EXPECT_EQ(record.kind, "timeout") << record.group;
}

/// A scheduler takes the machine away: that says nothing of the mesh. The parent of a command is the watcher
/// of its group, whose parent is the cell.
TEST_F(Resume, AnInterruptedCellIsToBeMadeYet) {
  NEEDS_FILE("/proc/self/stat");
  const std::string flag = out("flag");
  const std::string file =
      write(kSweep + "[[metric]]\nname = 'one'\ncommand = ['sh', '-c', '''[ -e " + flag + " ] || { touch " +
            flag + "; kill -TERM $(cut -d ' ' -f 4 /proc/$PPID/stat); sleep 5; }; echo 1''', \"{mesh}\"]\n")
          .string();
  const auto first = program({"run", file, "-o", out()});
  EXPECT_EQ(first.exit_code, 1) << first.err;
  EXPECT_TRUE(holds(first.err, "interrupted from outside"));
  EXPECT_TRUE(holds(first.out, "1 of 24 cells have no result yet"));
  const auto before = record_times(out());
  EXPECT_EQ(before.size(), std::size_t{kResumedCells - 1});
  EXPECT_EQ(program({"run", file, "-o", out()}).exit_code, 0);
  const auto after = record_times(out());
  EXPECT_EQ(after.size(), std::size_t{kResumedCells});
  for (const auto& [path, time] : before) EXPECT_EQ(after.at(path), time) << path;
}

TEST_F(Resume, TablesLeaveOutWhatTheExperimentNoLongerHas) {
  done();
  std::string fewer = kSweep;
  fewer.replace(fewer.find("[1, 2, 3]"), 9, "[1, 2]");
  const Outcome outcome = run_experiment(Experiment::read(write(fewer)), out());
  EXPECT_EQ(outcome.table.notes.back(), "8 records of cells that the experiment no longer has are left out");
}

/// At any moment: no result is lost, none is half there, and the end is the same.
TEST_F(Resume, SurvivesBeingKilled) {
  const std::string file = write(kSweep).string();
  const Experiment experiment = Experiment::read(file);
  SweepOptions two;
  two.limits.jobs = 2;
  std::mt19937 random(3);
  std::map<fs::path, fs::file_time_type> before;
  std::size_t kills = 0;
  for (; kills < 200 && before.size() < kResumedCells; ++kills) {
    const pid_t child = fork();
    if (child == 0) {
      const int null = open("/dev/null", O_WRONLY);
      dup2(null, STDOUT_FILENO);
      dup2(null, STDERR_FILENO);
      run_experiment(experiment, out("killed"), two);
      _exit(0);
    }
    std::this_thread::sleep_for(
        std::chrono::milliseconds(random() % (20 + 25 * kills)));  // it comes to an end
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const int lock = open((out("killed") + "/.lock").c_str(), O_RDWR);
    if (lock < 0) continue;
    flock(lock, LOCK_EX);  // which processes of the cells hold until they are over, too
    close(lock);
    const auto now = record_times(out("killed"));
    for (const auto& [path, time] : before) {
      ASSERT_TRUE(now.contains(path)) << path;
      EXPECT_EQ(now.at(path), time) << path;
    }
    for (const auto& [path, time] : now)
      for (const char* name : {"mesh.msh", "mesh.vtu", "picture.svg"})
        EXPECT_TRUE(fs::exists(path.parent_path() / name)) << path.parent_path() / name;
    before = now;
  }
  const auto last = program({"run", file, "-o", out("killed")});
  ASSERT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(values_of(out("killed")), values_of(done("whole")));
}

TEST_F(Resume, AFolderHasOneRunAndOneExperiment) {
  const Experiment experiment = Experiment::read(write(kSweep));
  done();
  const Experiment other = Experiment::read(write_text(folder_ / "other.toml", kSweep));
  expect_input_error([&] { run_experiment(other, out()); }, {"'sweep'", "'other'"});
  const int lock = open((out() + "/.lock").c_str(), O_RDWR);
  ASSERT_EQ(flock(lock, LOCK_EX | LOCK_NB), 0);
  expect_input_error([&] { run_experiment(experiment, out()); }, {"/out: another run"});
  close(lock);
  EXPECT_NO_THROW(run_experiment(experiment, out()));
}

TEST_F(Resume, FailuresAreCellsWithReasons) {
  const std::string file =
      write(
          "pipelines = ['DB']\n[[case]]\nname = 'good'\nsize = 0.2\nloop = { rectangle = [[0, 0], [1, 1]] }\n"
          "[[case]]\nname = 'bad'\nsize = '0.2 - x'\nloop = { rectangle = [[0, 0], [1, 1]] }\n"
          "[[case]]\nname = 'long'\nsize = 0.0004\nloop = { rectangle = [[0, 0], [1, 1]] }\n")
          .string();
  const auto result = program({"run", file, "-o", out(), "--timeout", "1", "-j", "2"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(holds(result.err, "error: long DB: stopped after 1 s (--timeout): ", "error: bad DB: "));
  const auto records = read_records(out());
  ASSERT_EQ(records.size(), 3u);
  EXPECT_EQ(records[0].reason, "");
  EXPECT_EQ(records[1].kind, "bad input");
  EXPECT_EQ(records[2].kind, "timeout");
  EXPECT_TRUE(holds(program({"run", file, "-o", out(), "--dry-run"}).out, "failed         long DB\n"));
}

TEST_F(Resume, TablesComeFromRecordsAlone) {
  const std::string file = write(kSweep).string();
  ASSERT_EQ(program({"run", file, "-o", out()}).exit_code, 0);
  const std::string table = read_text(out() + "/table.md"), pairs = read_text(out() + "/pairs.csv");
  EXPECT_TRUE(holds(table, "| square | DBC "));
  EXPECT_TRUE(holds(pairs, "DBC - DB,eta mean,ok,,2,"));
  for (const char* name : {"table.md", "table.csv", "table.tex", "table.json", "pairs.md"})
    fs::remove(out() + "/" + name);
  fs::remove(file);
  fs::remove_all(out() + "/disc@seed=3");
  const auto result = program({"tables", out()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(holds(result.out, "4 of 24 cells have no result yet"));
  EXPECT_TRUE(fs::exists(out() + "/table.tex"));
  write_text(out() + "/disc@seed=2/DB/record.json", "{\"case\": 1");
  const auto broken = program({"tables", out()});
  EXPECT_EQ(broken.exit_code, 0);
  EXPECT_TRUE(holds(broken.out, "damaged record: " + out() + "/disc@seed=2/DB/record.json"));
}

TEST_F(Resume, RecordsCanBeMadeAgain) {
  done();
  const fs::path record = out() + "/disc@seed=2/DBC/record.json";
  Rerun rerun = rerun_record(record);
  EXPECT_TRUE(rerun.same_mesh);
  EXPECT_TRUE(rerun.differences.empty()) << rerun.differences[0];
  std::string finer = read_text(record);
  finer.replace(finer.find("\"base\": \"0.3\""), 13, "\"base\": \"0.2\"");
  write_text(record, finer);
  rerun = rerun_record(record);
  EXPECT_FALSE(rerun.same_mesh) << "the record alone counts";
  EXPECT_FALSE(rerun.values.empty());
  finer.replace(finer.find("\"size\": {"), 9, "\"sise\": {");
  write_text(record, finer);
  expect_input_error([&] { rerun_record(record); }, {"DBC/record.json", "'size' is missing"});
}

}  // namespace
}  // namespace delquad
