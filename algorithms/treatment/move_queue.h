#pragma once

#include <optional>
#include <queue>

#include "algorithms/treatment/treatment_moves.h"

namespace delquad {

/// A move and what it takes off the valence energy.
struct Candidate {
  int gain;
  TreatmentMove move;
  bool operator<(const Candidate& other) const {
    return gain != other.gain ? gain < other.gain : other.move < move;
  }
};

/// Moves that lower the valence energy, the largest gain first.
class MoveQueue {
 public:
  /// Both outlive this object.
  MoveQueue(const QuadTopology& mesh, const ValenceEnergy& energy) : mesh_(mesh), energy_(energy) {}

  void push(const Candidate& candidate) { queue_.push(candidate); }
  /// Takes out the best move that is legal by now, with what it gains by now; none when none is left.
  std::optional<TreatmentMove> pop();

 private:
  const QuadTopology& mesh_;
  const ValenceEnergy& energy_;
  std::priority_queue<Candidate> queue_;
  Candidate last_{0, {}};  ///< what was taken out, 0: nothing since the queue was empty
};

}  // namespace delquad
