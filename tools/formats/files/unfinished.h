/// @file
/// Registry of unfinished files, so that a terminated program leaves none behind.
#pragma once

#include <cstddef>
#include <string>

namespace animeme::tools {

/// Registers a temporary file or folder; returns a number for forget_unfinished(). 0: too many
/// entries (64), or the path is too long; then only its owner removes it.
std::size_t note_unfinished(const std::string& path);
void forget_unfinished(std::size_t note);  ///< unregisters it; ignores 0

/// Removes all registered files. May be called from a signal handler. Does nothing in a forked
/// child process.
void remove_unfinished();

/// For main(): from now on signals that end the program (SIGINT, SIGTERM, SIGHUP, crashes ...) and
/// exit() remove unfinished files first. Signals that are ignored or already handled are not
/// affected.
void clean_up_on_signals();

}  // namespace animeme::tools
