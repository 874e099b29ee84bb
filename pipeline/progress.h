#pragma once

#include <string>

namespace delquad {

/// A bar with the name of what runs, on the last line of a terminal; silent where stderr is not one.
class Progress {
 public:
  /// `steps`: how many times step() will be called; 0: no bar.
  explicit Progress(int steps = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What begins now.
  void step(const std::string& label);
  /// Steps that will not be taken.
  void skip(int steps);
  /// Prints a line to stderr, above the bar.
  void message(const std::string& text);
  /// Takes the bar away.
  void finish();

 private:
  void draw() const;
  void clear() const;

  bool shown_;
  int steps_, done_ = 0;
  std::string label_;
};

}  // namespace delquad
