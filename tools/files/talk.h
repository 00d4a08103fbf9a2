/// @file
/// What a library wants said while it works. It prints nothing itself.
#pragma once

#include <functional>
#include <string>

namespace animeme::tools {

/// Who listens; a function that is empty hears nothing. Each call is one line without its end.
struct Talk {
  std::function<void(const std::string&)> say = [](const std::string&) {};   ///< what is done
  std::function<void(const std::string&)> warn = [](const std::string&) {};  ///< of bad input
};

/// Long work tells how far it is, 0..1, and asks whether it is to go on. What was done when it is
/// not is complete as far as it goes.
struct Watch {
  std::function<void(double)> progress = [](double) {};  ///< 0..1
  std::function<bool()> stop = [] { return false; };     ///< true: stop soon
};

}  // namespace animeme::tools
