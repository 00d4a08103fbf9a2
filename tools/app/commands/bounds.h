/// @file
/// What a value of an option may be: looked at while the line is read, before anything is opened,
/// and told with the option's name (exit code 2).
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace animeme::tools {

/// A number from `low` to `high`. No NaN, which CLI::Range lets through.
CLI::Validator between(double low, double high);
/// A number above 0, up to a thousand million.
CLI::Validator above_zero();
/// 0 or more, up to a thousand million.
CLI::Validator at_least_zero();
/// Frames a second: 25, 29.97, 30000/1001.
CLI::Validator frame_rate();
/// The size of a picture on which points lie: 1280x720.
CLI::Validator picture_size();
/// Anything that `problem` finds nothing wrong with: it returns a sentence, or nothing.
CLI::Validator written_so(std::function<std::string(const std::string&)> problem);

/// What a reader reads that gives a Result: its sentence is told.
template <class Read>
CLI::Validator read_by(Read read) {
  return written_so([read](const std::string& text) {
    const auto value = read(text);
    return value ? std::string() : value.error().message;
  });
}

}  // namespace animeme::tools
