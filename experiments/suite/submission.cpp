#include "experiments/suite/submission.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "base/located.h"
#include "experiments/console/progress.h"
#include "experiments/suite/suite_list.h"
#include "experiments/suite/write_suite.h"
#include "experiments/sweep/cell_folder.h"
#include "experiments/sweep/cells.h"
#include "experiments/sweep/folder_lock.h"
#include "experiments/sweep/machine.h"
#include "geometry/mesh/check_mesh.h"
#include "io/cases/toml_reader.h"
#include "io/digest.h"
#include "io/library_file.h"
#include "io/mesh_io.h"
#include "io/picture.h"
#include "metrics/shape.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/tables.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

constexpr const char *kModelsFolder = "models", *kDescription = "result.toml";

/// The mesh of a case; empty: there is none.
fs::path find_mesh(const fs::path& folder, const std::string& name) {
  const fs::path msh = folder / (name + ".msh"), obj = folder / (name + ".obj");
  if (fs::exists(msh) && fs::exists(obj))
    throw InputError(fmt::format("{} and {}: expected one of them", msh.string(), obj.filename().string()));
  return fs::exists(msh) ? msh : fs::exists(obj) ? obj : fs::path();
}

/// As a peer's mesh is measured.
MeshResult measure(const Prepared& prepared, const fs::path& file) {
  Mesh mesh = read_mesh(file);
  require_straight(mesh, file.string());
  check_is_of_model(prepared, mesh);
  MeshResult result = prepared.measure(std::move(mesh));
  result.warnings = prepared->warnings;
  return result;
}

/// The cells of one submission.
class Adding {
 public:
  Adding(const Submission& submission, Experiment& experiment, const fs::path& results)
      : submission_(submission), experiment_(experiment), folder_(results / submission.program) {
    peer_.name = submission.program;
    peer_.command = {submission.command};
    peer_.folder = submission.folder;
    peer_.file = submission.folder / kDescription;
    experiment.words = {Word{submission.program, {}}};
    experiment.peers = {peer_};
  }

  SubmissionCount run() {
    prepare_folder(folder_);
    const FolderLock lock(folder_, 0, 1);
    write_study(folder_, describe(experiment_));
    write_file_atomically(folder_ / kDescription, [&](std::ostream& out) { copy_into(out, peer_.file); });
    Progress progress(static_cast<int>(experiment_.n_cases()));
    for (std::size_t i = 0; i < experiment_.n_cases(); ++i) {
      const Case c = experiment_.read_variant(i);
      progress.step(c.name);
      add(c);
    }
    for (const std::string& error : write_tables(folder_, make_tables(folder_))) throw InputError(error);
    return count_;
  }

 private:
  void add(const Case& c) {
    const fs::path file = find_mesh(submission_.folder, c.name);
    CellIdentity identity;
    identity.model_digest = model_digest(c);
    identity.start = machine_state();
    identity.peer = &peer_;
    identity.peer_version = submission_.version;
    identity.key = digest(identity.model_digest + (file.empty() ? "" : file_digest(file)));
    if (file.empty()) {
      ++count_.missing;
      return refuse(c, identity, "missing", fmt::format("there is no {0}.msh and no {0}.obj", c.name));
    }
    try {
      write(c, identity, file);
      ++count_.measured;
    } catch (const std::runtime_error& error) {  // InputError or PeerError
      ++count_.refused;
      refuse(c, identity, "bad input", fmt::format("{}: {}", file.filename().string(), error.what()));
    }
  }

  void write(const Case& c, CellIdentity& identity, const fs::path& file) {
    const MeshResult result = measure(prepare(c), file);
    const Word& word = experiment_.words[0];
    write_cell(cell_folder(folder_, c, word), [&](const fs::path& at) {
      write_mesh(at / "mesh.msh", result.mesh);
      identity.files = marks_of(at);
      write_file_atomically(at / "record.json",
                            [&](std::ostream& out) { out << run_record(c, word, result, &identity); });
    });
  }

  void refuse(const Case& c, const CellIdentity& identity, const char* kind, const std::string& reason) {
    const Word& word = experiment_.words[0];
    write_cell(cell_folder(folder_, c, word), [&](const fs::path& at) {
      write_file_atomically(at / "record.json", [&](std::ostream& out) {
        out << failure_record(c, word, "failed", kind, reason, &identity);
      });
    });
  }

  const Submission& submission_;
  Experiment& experiment_;
  const fs::path folder_;
  Peer peer_;
  SubmissionCount count_;
};

/// Small letters, digits, - and _, a letter first.
bool is_name(const std::string& text) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !text.empty() && is_letter(text[0]) && std::ranges::all_of(text, [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

}  // namespace

Submission read_submission(const fs::path& folder) {
  const TomlTable table = TomlTable::read(folder / kDescription);
  Submission submission{folder, table.text("program"), table.text("version"), table.text("command"),
                        table.texts("authors")};
  table.finish();
  if (!is_name(submission.program) || submission.program == kModelsFolder)
    throw InputError(
        fmt::format("{}: program '{}': expected small letters, digits, - and _, such as 'mesher-2'",
                    table.where("program"), submission.program));
  if (submission.authors.empty()) throw InputError(table.where("authors") + ": expected at least one");
  return submission;
}

SubmissionCount add_submission(const Submission& submission, const fs::path& results) {
  const auto has_mesh = [&](const SuiteModel& model) {
    for (std::size_t k = 0; k < model.sizes.size(); ++k)
      if (!find_mesh(submission.folder, case_name(model, k)).empty()) return true;
    return false;
  };
  if (std::ranges::none_of(suite().models, has_mesh))
    throw InputError(fmt::format("{}: no mesh of any case: expected {}.msh or .obj and so on",
                                 submission.folder.string(), case_name(suite().models[0], 0)));
  const fs::path folder = results / submission.program;
  if (const auto study = read_study(folder); study && study->pipelines != std::vector{submission.program})
    throw InputError(folder.string() + ": holds the results of a run: call the program otherwise");
  Experiment experiment = write_suite_experiment(results / kModelsFolder);
  return Adding(submission, experiment, results).run();
}

}  // namespace delquad
