#include "experiments/sweep/repeat_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "delquad/error.h"
#include "experiments/sweep/cells.h"
#include "io/mesh_io.h"
#include "metrics/tables/result_records.h"
#include "metrics/tables/statistics.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The steps of a run that tables count as its time.
double total_seconds(const StepTimes& times) {
  double total = 0;
  for (const auto& [step, time] : times) {
    const auto counts = [&](const StepTime& column) { return column.step == step; };
    if (step == "peer" || std::ranges::any_of(step_times_of_tables(), counts)) total += time.work;
  }
  return total;
}

double load_average() {
  double minute = 0;
  return getloadavg(&minute, 1) == 1 ? minute : 0;
}

/// A variant of a case, whose cells are run again.
class RepeatedVariant {
 public:
  RepeatedVariant(const Experiment& experiment, const fs::path& folder, std::size_t variant)
      : experiment_(experiment),
        variant_(variant),
        case_(experiment.read_variant(variant / experiment.n_variants(), variant % experiment.n_variants())),
        folder_(folder / case_.folder) {
    find_cells(folder);
  }

  bool is_done() const {
    try {
      const auto times = read_times(folder_);
      return times && times->repetitions == experiment_.repeat_times &&
             std::ranges::equal(times->cells, cells_, [](const CellTimes& a, const CellTimes& b) {
               return a.pipeline == b.pipeline && a.key == b.key;
             });
    } catch (const InputError&) {  // damaged: it is made again
      return false;
    }
  }

  void run(ProcessLimits limits) {
    if (cells_.empty()) return;
    fs::remove_all(scratch());
    fs::create_directories(scratch());
    limits.jobs = 1;
    VariantTimes times{experiment_.repeat_times, load_average(), 0, {}};
    run_jobs([&] { return next_job(); }, limits);
    times.load_after = load_average();
    for (std::size_t i = 0; i < cells_.size(); ++i) collect(i);
    times.cells = cells_;
    write_times(folder_, times);
    fs::remove_all(scratch());
  }

 private:
  fs::path scratch() const { return folder_ / ".times"; }
  fs::path file_of(std::size_t cell, int round) const {
    return scratch() / fmt::format("{}-{}.json", cell, round);
  }

  /// Those that were made, of what there is now.
  void find_cells(const fs::path& folder) {
    if (case_.may_be_absent && !fs::exists(model_path(case_))) return;
    std::string model;
    try {
      model = model_digest(case_);
    } catch (const InputError&) {  // its cells have failed
      return;
    }
    for (const Word& word : experiment_.words) {
      const std::string key = identify(experiment_, case_, model, word).key;
      if (!has_mesh(state_of_cell(cell_folder(folder, case_, word), key))) continue;
      words_.push_back(&word);
      cells_.push_back({word.text, key, {}});
    }
  }

  std::optional<Job> next_job() {
    const std::size_t n = cells_.size(), run = next_++;
    if (run == n * static_cast<std::size_t>(experiment_.repeat_times)) return std::nullopt;
    const std::size_t round = run / n, cell = order_of_round(n, variant_, round)[run % n];
    Job job;
    job.work = [this, cell, round] { time(cell, static_cast<int>(round)); };
    job.failed = [this, cell](const ProcessFailure& why) {
      if (cells_[cell].failure.empty()) cells_[cell].failure = why.reason;
    };
    return job;
  }

  /// In a process of its own.
  void time(std::size_t cell, int round) const {
    const Word& word = *words_[cell];
    const Peer* peer = experiment_.peer_of(word);
    const MeshResult result = mesh_cell(case_, word, peer, scratch() / "peer");
    Json json = {{"seconds_total", total_seconds(result.log.times)}};
    if (peer == nullptr) json["seconds"] = result.seconds;
    write_text_file(file_of(cell, round), json.dump());
  }

  void collect(std::size_t i) {
    CellTimes& cell = cells_[i];
    for (int round = 0; round < experiment_.repeat_times && cell.failure.empty(); ++round) try {
        std::ifstream in(file_of(i, round));
        const Json json = Json::parse(in);
        for (const auto& [key, value] : json.items()) cell.seconds[key].push_back(value);
      } catch (const Json::exception&) {
        cell.failure = fmt::format("{}: was not written", file_of(i, round).string());
      }
    if (cell.failure.empty()) return;
    cell.seconds.clear();
    fmt::print(stderr, "warning: {} {}: no repeated times: {}\n", case_.folder, cell.pipeline, cell.failure);
  }

  const Experiment& experiment_;
  std::size_t variant_;
  Case case_;
  fs::path folder_;
  std::vector<const Word*> words_;
  std::vector<CellTimes> cells_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<std::size_t> order_of_round(std::size_t n, std::size_t variant, std::size_t round) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  constexpr std::uint64_t kMostRounds = 1'000'000;
  RandomIndex draw(variant * kMostRounds + round);
  for (std::size_t k = n; k > 1; --k) std::swap(order[k - 1], order[draw(k)]);
  return order;
}

void repeat_times(const Experiment& experiment, const fs::path& folder, const SweepOptions& options) {
  const std::size_t n = experiment.n_cases() * experiment.n_variants();
  for (std::size_t i = options.shard.index; i < n; i += options.shard.count) {
    RepeatedVariant variant(experiment, folder, i);
    if (options.force || !variant.is_done()) variant.run(options.limits);
  }
}

}  // namespace delquad
