/// @file
/// How a live command says how it goes.
#pragma once

#include <string>

namespace animeme::tools {

/// One line on standard error that is renewed on a terminal and added to elsewhere.
class StatusLine {
 public:
  StatusLine();
  ~StatusLine();
  /// Replaces the line on a terminal, else prints a further one.
  void show(const std::string& text);
  /// Takes it away from a terminal, so that something else can be printed.
  void clear();

 private:
  bool terminal_;
  bool shown_ = false;
};

}  // namespace animeme::tools
