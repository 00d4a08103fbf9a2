#include "tools/live/sessions/stream_report.h"

#include <algorithm>
#include <cmath>

#include "tools/formats/common/bit_rate.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"

namespace animeme::live {

namespace {

using tools::format;
using tools::Json;
using tools::kbit_per_s;

double rounded(double value, double step = 0.001) { return std::round(value / step) * step; }

std::string sentence(Sign sign, Turn turn, const Latency& latency) {
  return format(
      "text to the first %s: %.0f ms on average, %.0f at worst, %zu lines%s (voice %.0f, mouth "
      "%.1f, "
      "coding %.1f, sending %.1f, the clock%s %.0f)\n",
      sign == Sign::face ? "plane that shows it" : "packet of its sound", latency.mean,
      latency.worst, latency.lines, turn == Turn::waited ? " that waited" : "", latency.voice,
      latency.synthesis, latency.coding, latency.sending,
      turn == Turn::waited ? " and other lines" : "", latency.waiting);
}

Json to_json(const Latency& latency) {
  return {{"lines", latency.lines},
          {"mean_ms", rounded(latency.mean)},
          {"worst_ms", rounded(latency.worst)},
          {"voice_ms", rounded(latency.voice)},
          {"synthesis_ms", rounded(latency.synthesis)},
          {"coding_ms", rounded(latency.coding)},
          {"sending_ms", rounded(latency.sending)},
          {"waiting_ms", rounded(latency.waiting)}};
}

Json to_json(const Address& address) {
  const media::SendStats stats = address.sink->stats();
  return {{"url", address.url},         {"broken", address.broken},
          {"packets", stats.packets},   {"bytes", stats.bytes},
          {"repeated", stats.repeated}, {"receivers", stats.receivers},
          {"dropped", stats.dropped},   {"reported_loss", rounded(stats.reported_loss, 1e-6)}};
}

}  // namespace

void StreamReport::add(const media::LiveUnit& unit) {
  Track& track = unit.track == media::LiveTrack::face ? face_ : sound_;
  ++track.units;
  track.intra += unit.intra;
  track.bytes += std::int64_t(unit.bytes.size());
  track.seconds += media::seconds_of(info_, unit.track, unit.duration);
}

double StreamReport::kbps(const Track& track) const {
  return kbit_per_s(std::size_t(track.bytes), track.seconds);
}

std::string StreamReport::line(double now, const Sinks& sinks, const media::Pacer& pacer) {
  const double span = std::max(1e-3, now - last_);
  const media::SendStats stats = sinks.stats();
  const auto rate = [&](std::int64_t bytes, std::int64_t before) {
    return kbit_per_s(std::size_t(bytes - before), span);
  };
  std::string text =
      format("%.0f s: face %.1f planes/s %.2f kbit/s", now,
             double(face_.units - last_face_.units) / span, rate(face_.bytes, last_face_.bytes));
  if (info_.audio) text += format(", sound %.1f kbit/s", rate(sound_.bytes, last_sound_.bytes));
  text += format(", %.0f packets/s, receivers %lld, loss %.1f %%, late %.2f ms (99 %%), %.2f worst",
                 double(stats.packets - last_packets_) / span, (long long)(stats.receivers),
                 100 * stats.reported_loss, 1e3 * pacer.lateness().percentile(0.99),
                 1e3 * pacer.lateness().worst());
  last_face_ = face_;
  last_sound_ = sound_;
  last_packets_ = stats.packets;
  last_ = now;
  return text;
}

std::string StreamReport::summary(double seconds, const Sinks& sinks, const media::Pacer& pacer,
                                  const std::deque<speech::LineTrace>& traces) const {
  std::string text = format("%.1f s sent: %lld planes (%lld intra), %.2f kbit/s", seconds,
                            (long long)(face_.units), (long long)(face_.intra), kbps(face_));
  if (info_.audio) {
    text += format("; %lld packets of sound, %.1f kbit/s", (long long)(sound_.units), kbps(sound_));
  }
  text += "\n";
  for (const Address& address : sinks.addresses()) {
    const media::SendStats stats = address.sink->stats();
    text += address.url +
            format(": %lld packets (%lld repeated), %lld bytes, receivers %lld, loss %.1f %%%s\n",
                   (long long)(stats.packets), (long long)(stats.repeated),
                   (long long)(stats.bytes), (long long)(stats.receivers),
                   100 * stats.reported_loss, address.broken ? ", broken" : "");
  }
  const media::LatenessMeter& late = pacer.lateness();
  text += format("sent late by %.2f ms on average, %.2f (99 %%), %.2f at worst", 1e3 * late.mean(),
                 1e3 * late.percentile(0.99), 1e3 * late.worst());
  text += "\n";
  for (const Turn turn : {Turn::at_once, Turn::waited}) {
    for (const Sign sign : {Sign::face, Sign::sound}) {
      const Latency latency = latency_of(traces, sign, turn);
      if (latency.lines > 0) text += sentence(sign, turn, latency);
    }
  }
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

std::string StreamReport::json(double seconds, const Sinks& sinks, const media::Pacer& pacer,
                               const std::deque<speech::LineTrace>& traces) const {
  const auto track = [this](const Track& of) {
    return Json{
        {"units", of.units}, {"intra", of.intra}, {"bytes", of.bytes}, {"kbps", rounded(kbps(of))}};
  };
  Json addresses = Json::array();
  for (const Address& address : sinks.addresses()) addresses.push_back(to_json(address));
  const media::LatenessMeter& late = pacer.lateness();
  Json json = {{"seconds", rounded(seconds)},
               {"face", track(face_)},
               {"sound", track(sound_)},
               {"addresses", addresses},
               {"late_mean_ms", rounded(1e3 * late.mean())},
               {"late_99_ms", rounded(1e3 * late.percentile(0.99))},
               {"late_worst_ms", rounded(1e3 * late.worst())}};
  if (!traces.empty()) {
    json["lines"] = traces.size();
    json["text_to_face"] = to_json(latency_of(traces, Sign::face));
    json["text_to_sound"] = to_json(latency_of(traces, Sign::sound));
    json["waited_to_face"] = to_json(latency_of(traces, Sign::face, Turn::waited));
    json["waited_to_sound"] = to_json(latency_of(traces, Sign::sound, Turn::waited));
  }
  return tools::pretty(json);
}

Latency latency_of(const std::deque<speech::LineTrace>& traces, Sign sign, Turn turn) {
  Latency out;
  for (const speech::LineTrace& trace : traces) {
    const bool face = sign == Sign::face;
    const double begun = face ? trace.face_begun : trace.sound_begun;
    const double coded = face ? trace.face_coded : trace.sound_coded;
    const double sent = face ? trace.face_sent : trace.sound_sent;
    if (trace.waited != (turn == Turn::waited) || sent == 0) continue;
    const double whole = 1e3 * (sent - trace.arrived);
    const double voice = 1e3 * (trace.spoken - trace.arrived);
    const double synthesis = 1e3 * (trace.synthesised - trace.begun);
    const double coding = 1e3 * (coded - begun), sending = 1e3 * (sent - coded);
    ++out.lines;
    out.voice += voice;
    out.synthesis += synthesis;
    out.coding += coding;
    out.sending += sending;
    out.waiting += whole - voice - synthesis - coding - sending;
    out.mean += whole;
    out.worst = std::max(out.worst, whole);
  }
  if (out.lines == 0) return out;
  for (double* sum :
       {&out.voice, &out.synthesis, &out.coding, &out.sending, &out.waiting, &out.mean}) {
    *sum /= double(out.lines);
  }
  return out;
}

}  // namespace animeme::live
