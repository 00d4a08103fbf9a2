/// @file
/// What a library wants said while it works. It prints nothing itself.
#pragma once

#include <functional>
#include <string>

namespace animeme::tools {

/// Who listens; silence unless set. Each call is one line without its end.
struct Talk {
  std::function<void(const std::string&)> say = [](const std::string&) {};   ///< what is done
  std::function<void(const std::string&)> warn = [](const std::string&) {};  ///< of bad input
};

/// How long work is watched: it tells how far it is, 0..1, and asks whether it is to stop. What was
/// done then is complete as far as it goes.
struct Progress {
  std::function<void(double)> at = [](double) {};     ///< told how far it is
  std::function<bool()> stop = [] { return false; };  ///< true: stop
};

}  // namespace animeme::tools
