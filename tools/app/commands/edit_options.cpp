#include "tools/app/commands/edit_options.h"

#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "fap/edit.h"
#include "tools/app/commands/fap_names.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {
namespace {

// A number of 0 or more, without a sign; nullopt: it is none.
std::optional<double> plain_number(std::string_view text) {
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = status == std::errc() && end == text.data() + text.size();
  if (!whole || !std::isfinite(value) || std::signbit(value)) return std::nullopt;
  return value;
}

Error invalid(std::string message) {
  return make_error(Code::invalid_argument, std::move(message));
}

// Before and behind the first '='; without one the name is empty.
std::pair<std::string, std::string> named(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return {{}, text};
  return {text.substr(0, equals), text.substr(equals + 1)};
}

constexpr double kLatest = 1e7;  // seconds or frames; four months

}  // namespace

std::int64_t EditTime::frame(fap::Rate rate) const {
  return std::llround(frames ? value : value * rate.frames_per_second());
}

Result<EditTime> parse_edit_time(const std::string& text) {
  const auto wrong = [&] {
    return invalid("'" + text +
                   "' is not a time; write seconds (12.5), minutes and seconds (1:02.5) "
                   "or frames (375f)");
  };
  EditTime time;
  std::string_view rest = text;
  time.frames = rest.ends_with('f');
  if (time.frames || rest.ends_with('s')) rest.remove_suffix(1);
  int parts = 0;
  for (bool more = true; more; ++parts) {
    const std::size_t colon = rest.find(':');
    more = colon != std::string_view::npos;
    const auto value = plain_number(rest.substr(0, colon));
    if (!value || parts == 3 || (parts > 0 && *value >= 60)) return wrong();
    time.value = time.value * 60 + *value;
    if (more) rest.remove_prefix(colon + 1);
  }
  if (time.frames && (parts > 1 || time.value != std::floor(time.value))) return wrong();
  if (time.value > kLatest) return wrong();
  return time;
}

Result<EditPiece> parse_edit_piece(const std::string& text) {
  const std::size_t dash = text.find('-');
  if (dash == std::string::npos || text.size() == 1) {
    return invalid("'" + text + "' is not a piece; write FROM-TO, such as 1.5-4, 1:10- or 0f-75f");
  }
  EditPiece piece;
  if (dash > 0) {
    const auto from = parse_edit_time(text.substr(0, dash));
    if (!from) return from.error();
    piece.from = *from;
  }
  if (dash + 1 < text.size()) {
    const auto to = parse_edit_time(text.substr(dash + 1));
    if (!to) return to.error();
    piece.to = *to;
  }
  if (piece.to && piece.to->frames == piece.from.frames && piece.to->value <= piece.from.value) {
    return invalid("'" + text + "' ends before it begins");
  }
  return piece;
}

void add_span_options(OptionTable& cli, EditSpan& span) {
  cli.add("--from", span.from, "Begin here: seconds (12.5), 1:02.5, or frames (375f)")
      ->type("TIME")
      ->check(problem_of<parse_edit_time>);
  cli.add("--to", span.to, "End here")->type("TIME")->check(problem_of<parse_edit_time>);
}

Result<fap::Mask> parse_edit_faps(const std::string& name) {
  if (name == "all") return ~fap::Mask();
  if (const auto region = fap::region_faps(name)) return *region;
  const auto numbers = fap_numbers({name});
  if (!numbers) {
    std::string names;
    for (const fap::Region& region : fap::regions()) names += std::string(region.name) + ", ";
    return invalid("'" + name + "' is no part of the face; there are " + names +
                   "all, and FAPs such as open_jaw or 31-38");
  }
  fap::Mask faps;
  for (const int fap : *numbers) faps.set(std::size_t(fap));
  return faps;
}

Result<EditAmount> parse_edit_amount(const std::string& text) {
  const auto [name, number] = named(text);
  const auto faps = parse_edit_faps(name.empty() ? "all" : name);
  if (!faps) return faps.error();
  const auto value = plain_number(number);
  if (!value || *value > 1e6) {
    return invalid("'" + text + "' needs a number of 0 or more, such as brows=1.4");
  }
  return EditAmount{*faps, *value};
}

Result<EditTake> parse_edit_take(const std::string& text) {
  const auto [name, path] = named(text);
  if (name.empty() || path.empty()) {
    return invalid("'" + text + "' is not PART=FILE, such as lips=a.fba");
  }
  EditTake take;
  take.path = path;
  if (name == "rest") {
    take.what = EditTake::What::rest;
  } else if (name == "body") {
    take.what = EditTake::What::body;
  } else {
    const auto faps = parse_edit_faps(name);
    if (!faps) return faps.error();
    take.faps = *faps;
  }
  return take;
}

}  // namespace animeme::tools
