/// @file
/// Messages and progress of a library while it works. A library prints nothing itself.
#pragma once

#include <functional>
#include <string>

namespace animeme::tools {

/// Receives the messages of a library; ignores them unless set. Each call is one line without its
/// line end.
struct Log {
  std::function<void(const std::string&)> info = [](const std::string&) {};  ///< what was done
  std::function<void(const std::string&)> warn = [](const std::string&) {
  };  ///< what is wrong with the input
};

/// Reports the progress of long work and lets the caller stop it. What was done until then is
/// complete as far as it goes.
struct Progress {
  std::function<void(double)> at = [](double) {};     ///< receives the progress, 0..1
  std::function<bool()> stop = [] { return false; };  ///< returns true to stop the work
};

}  // namespace animeme::tools
