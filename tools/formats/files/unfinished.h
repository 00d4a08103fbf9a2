/// @file
/// Files that are not finished yet, so that a program that is stopped leaves none behind.
#pragma once

#include <cstddef>
#include <string>

namespace animeme::tools {

/// Notes a temporary file, or folder with files but no folders in it; the number is for
/// forget_unfinished(). 0: there are too many already (64), or the path is too long; such a file is
/// removed by its owner alone.
std::size_t note_unfinished(const std::string& path);
void forget_unfinished(std::size_t note);  ///< it is finished, or removed; 0 is nothing

/// Removes all that are noted. May be called from a signal handler. Does nothing in a process that
/// was forked from the one that noted them.
void remove_unfinished();

/// For the main function of a program: from now on the signals that end it (SIGINT, SIGTERM,
/// SIGHUP, those of a crash ...) remove unfinished files first, and so does exit(). Signals that
/// are ignored or handled already stay so.
void clean_up_on_signals();

}  // namespace animeme::tools
