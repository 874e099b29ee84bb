#include "sweep/cells.h"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <string_view>

#include "sweep/digest.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

/// The program: its bytes, which no change of an algorithm, an option of the compiler or a library inside
/// leaves alone.
const std::string& program_digest() {
  static const std::string program = digest(file_digest("/proc/self/exe") + versions_record());
  return program;
}

/// Curves by points on them, which tell any two that differ apart.
std::string describe(const PlanarModel& model) {
  constexpr int kPoints = 17;  // odd, so that none falls on a symmetry but the middle
  std::string text;
  for (const ModelCurve& curve : model.curves) {
    text += curve.name + '\n';
    const auto add = [&](double t) {
      const Vec2 p = curve.shape->point(t);
      text += fmt::format("{:a} {:a}\n", p.x, p.y);
    };
    for (int k = 0; k <= kPoints; ++k) add(double(k) / kPoints);
    for (const double t : curve.shape->fixed_parameters()) add(t);
  }
  for (const ModelLoop& loop : model.loops) {
    text += loop.region + '\n';
    for (const int curve : loop.curves) text += fmt::format("{} ", curve);
  }
  return text;
}

/// The text of a key of a record's first lines.
std::string value_of(std::string_view head, const std::string& key) {
  const std::string opening = "\n  \"" + key + "\": \"";
  const auto at = head.find(opening);
  if (at == std::string_view::npos) return "";
  const auto begin = at + opening.size(), end = head.find('"', begin);
  return end == std::string_view::npos ? "" : std::string(head.substr(begin, end - begin));
}

/// Asked once; empty where the peer does not tell, as its cells will say.
const std::string& version_of(const Peer& peer) {
  static std::map<std::vector<std::string>, std::string> known;
  const auto [at, is_new] = known.try_emplace(peer.version);
  if (is_new) try {
      at->second = peer_version(peer);
    } catch (const PeerError&) {
    }
  return at->second;
}

}  // namespace

std::string model_digest(const Case& c) {
  if (c.model) {
    std::string text = describe(*c.model);
    for (const ModelLoop& loop : c.model->loops) {
      if (!loop.is_hole) continue;
      const Vec2 first = c.model->curves[loop.curves.front()].shape->point(0);
      text += fmt::format("hole {:a} {:a}\n", first.x, first.y);
    }
    return digest(text);
  }
  return c.example.empty() ? file_digest(model_path(c)) : digest("example " + c.example);
}

CellIdentity identify(const Experiment& experiment, const Case& c, const std::string& model,
                      const std::array<std::size_t, 3>& place) {
  CellIdentity cell;
  cell.model_digest = model;
  cell.program_digest = program_digest();
  cell.experiment = fs::absolute(experiment.file).lexically_normal().string();
  cell.data = fs::absolute(c.data_folder).lexically_normal().string();
  cell.place = place;
  std::string pipeline = experiment.words[place[2]].text;
  if ((cell.peer = experiment.peer_of(experiment.words[place[2]])) != nullptr) {
    cell.peer_version = version_of(*cell.peer);
    pipeline += peer_record(*cell.peer, cell.peer_version);
  }
  for (const MetricCommand& metric : experiment.metrics)
    cell.metrics.push_back({&metric, metric_files(metric)});
  cell.solvers = experiment.solvers;
  pipeline += metrics_by_command_record(cell);
  cell.key = digest(
      fmt::format("{}\n{}\n{}\n{}\n{}", model, options_record(c), c.seed, pipeline, cell.program_digest));
  return cell;
}

fs::path cell_folder(const fs::path& folder, const Case& c, const Word& word) {
  return folder / c.folder / word.text;
}

std::optional<RecordHead> read_head(const fs::path& cell) {
  std::ifstream in(cell / "record.json", std::ios::binary);
  char bytes[1024];
  in.read(bytes, sizeof bytes);
  const std::string_view head(bytes, static_cast<std::size_t>(in.gcount()));
  RecordHead result{value_of(head, "key"), value_of(head, "status"), value_of(head, "metrics_status")};
  return result.key.empty() ? std::nullopt : std::optional(std::move(result));
}

}  // namespace delquad
