#include "algorithms/treatment/move_queue.h"

#include "base/cancel.h"

namespace delquad {

std::optional<TreatmentMove> MoveQueue::pop() {
  while (!queue_.empty()) {
    check_cancelled();
    const Candidate candidate = queue_.top();
    queue_.pop();
    // A move is seen from several elements and vertices.
    if (candidate.gain == last_.gain && candidate.move == last_.move) continue;
    last_ = candidate;
    if (!is_legal(mesh_, candidate.move)) continue;
    const int gain = energy_.gain(candidate.move);
    if (gain <= 0) continue;
    if (gain == candidate.gain) return candidate.move;
    queue_.push({gain, candidate.move});
  }
  last_ = {0, {}};
  return std::nullopt;
}

}  // namespace delquad
