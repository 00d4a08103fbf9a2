#include "tools/app/commands/bounds.h"

#include <cstdlib>
#include <utility>

#include "fap/rate_text.h"
#include "tools/formats/common/text.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::tools {

namespace {

constexpr double kManyAtMost = 1e9;  // seconds of thirty years, frames of one

CLI::Validator number(double low, double high, const std::string& range) {
  const auto problem = [low, high, range](const std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool whole = !text.empty() && *end == 0;
    // NaN is in no range.
    return whole && value >= low && value <= high ? "" : "'" + text + "' is not " + range;
  };
  return CLI::Validator(problem, "");
}

}  // namespace

CLI::Validator between(double low, double high) {
  return number(low, high, format("a number from %.10g to %.10g", low, high))
      .description(format("%.10g..%.10g", low, high));
}

CLI::Validator above_zero() {
  return number(1e-6, kManyAtMost, "a number above 0").description(">0");
}

CLI::Validator at_least_zero() {
  return number(0, kManyAtMost, "a number of 0 or more").description(">=0");
}

CLI::Validator frame_rate() {
  return written_so([](const std::string& text) -> std::string {
    const Result<fap::Rate> rate = fap::parse_rate(text);
    return rate && rate->valid() ? "" : "'" + text + "' is no frame rate; write 25 or 29.97";
  });
}

CLI::Validator picture_size() {
  return written_so([](const std::string& text) -> std::string {
    return exchange::parse_picture_size(text) ? "" : "'" + text + "' is no size; write 1280x720";
  });
}

CLI::Validator written_so(std::function<std::string(const std::string&)> problem) {
  return CLI::Validator(
      [problem = std::move(problem)](const std::string& text) { return problem(text); }, "");
}

}  // namespace animeme::tools
