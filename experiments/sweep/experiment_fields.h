// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "experiments/sweep/metric_command.h"
#include "experiments/sweep/peer.h"
#include "io/cases/read_described.h"
#include "metrics/tables/study_fields.h"

// This header has the structs of an experiment, beside its cases and tables. Each has its description.

namespace delquad {

/// A file of peers.
struct PeerFile {
  std::vector<Peer> peers;
};

struct ExperimentKeys {
  std::vector<std::string> pipelines = {"F", "D", "FB", "DB"};
  std::vector<Peer> peers;
  std::vector<std::filesystem::path> peer_files;  ///< sources of further peers
  bool calibrate = false;                         ///< peers are compared at our number of quads
  std::string calibrate_to;                       ///< the pipeline with that number; empty: none
  std::vector<MetricCommand> metrics;
  std::vector<std::string> solvers;  ///< solvers that measure every mesh, by name
  double minutes = 0;                ///< minutes of a run with two jobs; 0: not known
  std::filesystem::path reference;   ///< file of the published rows; empty: none
};

template <>
inline constexpr auto kFields<Peer> = std::tuple(
    field("name", &Peer::name, "name in pipelines and tables",
          {.required = true, .type = R"({"type": "string", "pattern": "^[a-z][A-Za-z0-9_.-]{0,99}$"})"}),
    field("command", &Peer::command, "program and arguments, with {input} and {output}",
          {.least = 1, .required = true}),
    field("version", &Peer::version, "program and arguments that print the version",
          {.least = 1, .required = true}),
    field("input", &Peer::input, "format that it reads", {.words = "geo|msh|obj|inp|mesh"}),
    field("output", &Peer::output, "format that it writes", {.words = "msh|obj|off|stl"}),
    field("exit_codes", &Peer::exit_codes, "exit codes with which its mesh is worth a look",
          {.least = 0, .most = 255}),
    field("keeps_boundary", &Peer::keeps_boundary, "whether it has the boundary's edges"),
    field("planar", &Peer::planar, "input for planar domains", {.words = "boundary|triangles|none"}),
    field("surfaces", &Peer::surfaces, "input for surfaces", {.words = "file|triangles|none"}),
    field("size_field", &Peer::size_field, "format of the file that {size_field} stands for",
          {.words = "pos|sol|points"}),
    field("metrics", &Peer::metrics, "whether it knows metrics, and finds their tensors in that file"),
    field("calibrate", &Peer::calibrate, "whether its size is changed until it has our number of quads",
          {.words = "none|quads"}),
    field("calibrate_to", &Peer::calibrate_to, "pipeline whose number of quads that is"),
    ignored(&Peer::file, "it is the place of the peer"),
    ignored(&Peer::folder, "the contents of its files count"));
template <>
inline constexpr auto kFields<PeerFile> = std::tuple(field("peer", &PeerFile::peers, "other meshers",
                                                           {.required = true}));
template <>
inline constexpr auto kFields<MetricCommand> =
    std::tuple(field("", &MetricCommand::metric),
               field("command", &MetricCommand::command, "program and arguments, with {mesh}",
                     {.least = 1, .required = true}),
               field("files", &MetricCommand::files, "files that its value depends on, too"),
               field("timeout", &MetricCommand::timeout, "seconds that it may take",
                     {.least = 1, .most = 604'800}),  // a week
               ignored(&MetricCommand::folder, "the contents of its files count"));
template <>
inline constexpr auto kFields<ExperimentKeys> = std::tuple(
    field("pipelines", &ExperimentKeys::pipelines, "pipelines and names of peers",
          {.no_result = "the plan has the pipelines that are run"}),
    field("peer", &ExperimentKeys::peers, "other meshers"),
    field("peer_files", &ExperimentKeys::peer_files, "files with further peers",
          {.no_result = "the peers in them count"}),
    field("calibrate", &ExperimentKeys::calibrate, "whether peers are compared at our number of quads",
          {.words = "none|quads", .no_result = "the peers have it"}),
    field("calibrate_to", &ExperimentKeys::calibrate_to, "pipeline whose number of quads that is",
          {.no_result = "the peers have it"}),
    field("metric", &ExperimentKeys::metrics, "measures that other programs take"),
    field("solver", &ExperimentKeys::solvers, "finite elements that measure every mesh",
          {.unique = true, .words = "poisson|elasticity"}),
    field("minutes", &ExperimentKeys::minutes,
          "minutes of a run on two cores, as measured: for the time left",
          {.above = 0, .no_result = "it is for people"}),
    field("reference", &ExperimentKeys::reference, "file of published rows",
          {.no_result = "published rows stand beside results"}));

/// These check what descriptions cannot express, and complete the structs. Throw InputError with file and
/// line.
void finish_reading(const TomlTable& table, Peer& peer);
void finish_reading(const TomlTable& table, MetricCommand& metric);

}  // namespace delquad
