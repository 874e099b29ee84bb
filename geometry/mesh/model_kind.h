// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "delquad/model.h"

// This header says what a model allows, whatever holds it. Checks, features and the preparation use it.

namespace delquad {

struct ModelKind {
  bool in_plane = false;  ///< its domain is planar
  bool is_given = false;  ///< its elements stay, or are improved
  /// The source of lines that are kept as they are; null: its curves are meshed.
  const std::string* kept = nullptr;

  bool has_outlines() const { return in_plane && kept == nullptr; }
};

/// Returns the kind of a model that is read and outlives the result.
ModelKind kind_of(const Model& model);

/// Returns whether the elements of a mesh are not all in one plane of constant z.
bool is_in_space(const Mesh& mesh);

}  // namespace delquad
