#pragma once

#include <vector>

namespace delquad {

/// The containers of many trees, each tree a list of blocks of one cache line, which are used again.
class TreeMembers {
 public:
  /// A new list, empty.
  int make() {
    int tree;
    if (unused_.empty()) {
      tree = static_cast<int>(heads_.size());
      heads_.push_back(-1);
      births_.push_back(0);
    } else {
      tree = unused_.back();
      unused_.pop_back();
    }
    births_[tree] = ++last_birth_;
    return tree;
  }

  void add(int tree, int container) {
    const int head = heads_[tree];
    if (head >= 0 && blocks_[head].count < kPerBlock) {
      blocks_[head].item[blocks_[head].count++] = container;
      return;
    }
    int block = first_unused_;
    if (block >= 0) {
      first_unused_ = blocks_[block].next;
    } else {
      block = static_cast<int>(blocks_.size());
      blocks_.emplace_back();
    }
    blocks_[block].next = head;
    blocks_[block].count = 1;
    blocks_[block].item[0] = container;
    heads_[tree] = block;
  }

  void collect(int tree, std::vector<int>& containers) const {
    containers.clear();
    for (int b = heads_[tree]; b >= 0; b = blocks_[b].next) {
      containers.insert(containers.end(), blocks_[b].item, blocks_[b].item + blocks_[b].count);
    }
  }

  void drop(int tree) {
    for (int b = heads_[tree]; b >= 0;) {
      const int next = blocks_[b].next;
      blocks_[b].next = first_unused_;
      first_unused_ = b;
      b = next;
    }
    heads_[tree] = -1;
    births_[tree] = 0;
    unused_.push_back(tree);
  }

  /// Tells a tree from an earlier one of the same number; 0 when it is no more.
  long long birth(int tree) const { return births_[tree]; }

 private:
  static constexpr int kPerBlock = 14;
  struct Block {
    int next, count;
    int item[kPerBlock];
  };
  std::vector<int> heads_, unused_;
  std::vector<long long> births_;
  long long last_birth_ = 0;
  std::vector<Block> blocks_;
  int first_unused_ = -1;
};

}  // namespace delquad
