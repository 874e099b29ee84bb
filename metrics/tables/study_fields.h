// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tuple>

#include "delquad/metrics.h"
#include "io/cases/description.h"
#include "metrics/tables/study_file.h"

// This header describes the fields of an experiment's tables in files. Readers and writers of studies use it.

namespace delquad {

/// Limit of digits of a measure after the decimal point.
inline constexpr int kMostDigits = 12;

template <>
inline constexpr auto kFields<Metric> = std::tuple(
    field("name", &Metric::key, "name in tables and records",
          {.required = true, .type = R"({"type": "string", "pattern": "^[A-Za-z][A-Za-z0-9_-]{0,59}$"})"}),
    field("title", &Metric::title, "title in tables; default: the name"),
    field("unit", &Metric::unit, "unit, for people"),
    field("better", &Metric::better, "which values are better", {.words = "higher|lower|neither"}),
    ignored(&Metric::worst, "it is known of the project's own measures alone"),
    ignored(&Metric::source, "it says where the measure is defined"),
    field("digits", &Metric::digits, "digits after the decimal point, in tables",
          {.least = 0, .most = kMostDigits}));
template <>
inline constexpr auto kFields<Hypothesis> = std::tuple(
    field("better", &Hypothesis::better, "pipeline, or value of 'along', that is expected to be better",
          {.form = Form::kFormula, .required = true}),
    field("than", &Hypothesis::than, "pipeline or value that it is compared with",
          {.form = Form::kFormula, .required = true}),
    field("along", &Hypothesis::along, "title of the axis whose values are compared; default: pipelines"),
    field("measures", &Hypothesis::measures, "keys of measures, each of them a test",
          {.least = 1, .required = true, .unique = true}));
template <>
inline constexpr auto kFields<MayFail> =
    std::tuple(field("case", &MayFail::name, "name of the case; default: any"),
               field("variant", &MayFail::variant, "name of the variant; default: any"),
               field("pipeline", &MayFail::pipeline, "one of the pipelines; default: any"));
template <>
inline constexpr auto kFields<PublishedRow> = std::tuple(inner("name", &PublishedRow::name),
                                                         inner("source", &PublishedRow::source),
                                                         inner("values", &PublishedRow::values));
template <>
inline constexpr auto kFields<TablePlan> = std::tuple(
    field("title", &TablePlan::title, "title of the tables; default: the name of the file",
          {.no_result = "it is for people"}),
    field("published", &TablePlan::published, "",
          {.form = Form::kNone, .no_result = "published rows stand beside results"}),
    field("step_times", &TablePlan::step_times, "whether tables have a column for each step's time",
          {.no_result = "it chooses columns"}),
    field("columns", &TablePlan::columns, "columns of tables in Markdown and LaTeX, by key",
          {.least = 1, .unique = true, .no_result = "it chooses columns"}),
    field("pairs", &TablePlan::pairs, "titles of axes whose values are compared as pipelines are",
          {.least = 1, .unique = true}),
    field("hypotheses", &TablePlan::hypotheses, "claims that are fixed before the run"),
    field("may_fail", &TablePlan::may_fail, "cells that may fail",
          {.no_result = "it says what the exit code is"}));
template <>
inline constexpr auto kFields<CaseGeometry> = std::tuple(inner("domain", &CaseGeometry::domain),
                                                         inner("digest", &CaseGeometry::digest),
                                                         inner("shape", &CaseGeometry::shape),
                                                         inner("chord_error", &CaseGeometry::chord_error));
template <>
inline constexpr auto kFields<StudyCells> =
    std::tuple(inner("experiment", &StudyCells::experiment), inner("problems", &StudyCells::problems),
               inner("cases", &StudyCells::cases), inner("pipelines", &StudyCells::pipelines),
               inner("axes", &StudyCells::axes), inner("geometry", &StudyCells::geometry),
               inner("plan", &StudyCells::plan), inner("cells", &StudyCells::cells),
               inner("compare", &StudyCells::compare), inner("plan_changed", &StudyCells::plan_changed));

}  // namespace delquad
