#include "dam/evaluation/evaluate_series_internal.h"

#include <algorithm>
#include <cmath>

#include "dam/corpus/statistics_internal.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

Result<std::vector<std::size_t>> find_channels(const Layout& layout, const Signal& signal,
                                               const std::string& id, const char* owner) {
  std::vector<std::size_t> channels;
  for (const Control& control : layout.controls) {
    const auto at = std::find(signal.names.begin(), signal.names.end(), control.name);
    if (at == signal.names.end())
      return make_error(Code::not_found, "sentence '" + id + "': " + owner + " has no control '" +
                                             control.name + "', which is to be compared");
    channels.push_back(std::size_t(at - signal.names.begin()));
  }
  return channels;
}

std::vector<std::vector<double>> to_series(const Layout& layout, const Signal& signal,
                                           const std::vector<std::size_t>& channels) {
  std::vector<std::vector<double>> series(layout.series(), std::vector<double>(signal.frames()));
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    for (std::size_t c = 0; c < channels.size(); ++c) series[c][i] = signal.at(i, channels[c]);
    for (std::size_t m = 0; m < layout.measures.size(); ++m)
      for (const auto& [control, weight] : layout.measures[m].parts)
        series[channels.size() + m][i] += weight * series[control][i];
  }
  return series;
}

void mark_phones(PairSeries& out) {
  const std::vector<Phone>& phones = out.script().phones;
  std::size_t next = 0;
  for (std::size_t i = 0; i < out.frames(); ++i) {
    const double time = out.seconds(double(i));
    while (next < phones.size() && phones[next].end <= time) ++next;
    const bool inside = next < phones.size() && phones[next].start <= time;
    out.phone.push_back(inside ? std::ptrdiff_t(next) : -1);
  }
}

}  // namespace

bool is_scored_lip_fap(std::string_view name) {
  const int fap = fap_of_channel(name);
  return (fap >= 3 && fap <= 13) || (fap >= 51 && fap <= 60);
}

std::size_t Layout::scored_count() const {
  return std::size_t(std::count(scored.begin(), scored.end(), true));
}

std::string Layout::name(std::size_t series) const {
  return series < controls.size() ? controls[series].name : measures[series - controls.size()].name;
}

Layout make_layout(std::vector<Control> controls) {
  Layout layout;
  layout.controls = std::move(controls);
  for (const Control& c : layout.controls)
    layout.scored.push_back(is_scored_lip_fap(c.name) && c.sd > 0);
  if (layout.scored_count() == 0)
    for (std::size_t c = 0; c < layout.controls.size(); ++c)
      layout.scored[c] = layout.controls[c].sd > 0;
  const auto find = [&](int fap) {
    for (std::size_t c = 0; c < layout.controls.size(); ++c)
      if (fap_of_channel(layout.controls[c].name) == fap) return std::ptrdiff_t(c);
    return std::ptrdiff_t(-1);
  };
  const auto add = [&](const char* name, std::initializer_list<std::pair<int, double>> parts) {
    Measure measure{name, {}};
    for (const auto& [fap, weight] : parts) {
      if (find(fap) < 0) return std::ptrdiff_t(-1);
      measure.parts.emplace_back(std::size_t(find(fap)), weight);
    }
    layout.measures.push_back(std::move(measure));
    return std::ptrdiff_t(layout.series()) - 1;
  };
  layout.gap = add("inner_gap", {{4, -1}, {5, -1}});
  layout.width = add("width", {{6, 1}, {7, 1}});
  add("jaw", {{3, 1}});
  add("corner_height", {{12, 0.5}, {13, 0.5}});
  layout.lower_lip = find(5);
  return layout;
}

Result<PairSeries> make_series(const SentencePair& pair, const Layout& layout) {
  const Signal& recorded = pair.recorded.signal;
  const std::string& id = pair.recorded.id;
  const auto from_recorded = find_channels(layout, recorded, id, "the recording");
  if (!from_recorded) return from_recorded.error();
  const auto from_made = find_channels(layout, pair.synthesised, id, "the synthesised motion");
  if (!from_made) return from_made.error();
  if (!(pair.synthesised.rate == recorded.rate) || pair.synthesised.frames() != recorded.frames())
    return make_error(Code::invalid_argument,
                      "sentence '" + id + "': " + std::to_string(pair.synthesised.frames()) +
                          " frames were made for a recording of " +
                          std::to_string(recorded.frames()) +
                          ", or at another rate; resample them");
  PairSeries out;
  out.pair = &pair;
  out.recorded = to_series(layout, recorded, *from_recorded);
  out.synthesised = to_series(layout, pair.synthesised, *from_made);
  out.speech = speech_frames(pair.recorded);
  for (std::size_t i = 0; i < out.speech.size(); ++i)
    out.silence.push_back(!out.speech[i] && is_measured(recorded, i));
  mark_phones(out);
  return out;
}

std::vector<FrameRun> frame_runs(const std::vector<bool>& mask) {
  std::vector<FrameRun> runs;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) continue;
    if (i == 0 || !mask[i - 1]) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

}  // namespace animeme::dam
