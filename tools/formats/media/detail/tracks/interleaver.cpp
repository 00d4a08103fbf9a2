#include "tools/formats/media/detail/tracks/interleaver.h"

#include <algorithm>
#include <utility>

namespace animeme::media {
namespace {

constexpr int kReportEvery = 64;
constexpr double kShortestFile = 0.5;  // seconds; readers cannot tell what less is (TS)

/// Packets that are there as a whole.
template <class Packet>
class ListFeed : public TrackFeed {
 public:
  using Write = std::function<Result<void>(const Packet&)>;
  ListFeed(const std::vector<Packet>& packets, AVRational base, bool Packet::*sync, Write how)
      : packets_(packets), base_(base), sync_(sync), write_(std::move(how)) {}

  Result<void> begin() override { return {}; }
  bool ready() const override { return next_ < packets_.size(); }
  std::int64_t time() const override { return packets_[next_].time; }
  AVRational time_base() const override { return base_; }
  bool sync() const override { return packets_[next_].*sync_; }
  Result<void> write() override { return write_(packets_[next_++]); }
  double end() const override {
    if (next_ == 0) return 0;
    const Packet& last = packets_[next_ - 1];
    return double(last.time + duration_of(last)) * base_.num / base_.den;
  }
  double share() const override { return double(next_) / double(packets_.size()); }

 private:
  static std::int64_t duration_of(const fba::AccessUnit& unit) { return unit.duration; }
  static std::int64_t duration_of(const VideoPacket&) { return 1; }

  const std::vector<Packet>& packets_;
  AVRational base_;
  bool Packet::*sync_;
  Write write_;
  std::size_t next_ = 0;
};

/// Units that are read while they are written.
class UnitFeed : public TrackFeed {
 public:
  UnitFeed(Muxer& muxer, fba::UnitReader& units, int number)
      : muxer_(muxer), units_(units), number_(number) {}

  Result<void> begin() override {
    units_.rewind();
    return next();
  }
  bool ready() const override { return unit_ != nullptr; }
  std::int64_t time() const override { return unit_->time; }
  AVRational time_base() const override { return {1, int(units_.summary().timescale)}; }
  bool sync() const override { return unit_->intra; }
  Result<void> write() override {
    end_ = unit_->time + unit_->duration;
    Result<void> written = muxer_.write_unit(*unit_, number_);
    return written ? next() : written;
  }
  double end() const override { return double(end_) / units_.summary().timescale; }
  double share() const override { return double(end_) / double(units_.summary().end); }

 private:
  Result<void> next() {
    const Result<const fba::AccessUnit*> unit = units_.next();
    if (!unit) return unit.error();
    unit_ = *unit;
    return {};
  }

  Muxer& muxer_;
  fba::UnitReader& units_;
  int number_;
  const fba::AccessUnit* unit_ = nullptr;
  std::int64_t end_ = 0;
};

class SoundFeed : public TrackFeed {
 public:
  SoundFeed(Muxer& muxer, SoundSource& sound, double seconds, int number)
      : muxer_(muxer), sound_(sound), seconds_(seconds), number_(number) {}

  Result<void> begin() override {
    Result<const AudioPacket*> packet = sound_.next();
    if (!packet) return packet.error();
    packet_ = *packet;
    return {};
  }
  bool ready() const override { return packet_ != nullptr; }
  std::int64_t time() const override { return packet_->time; }
  AVRational time_base() const override { return {1, sound_.format().sample_rate}; }
  bool sync() const override { return true; }
  Result<void> write() override {
    end_ = packet_->time + packet_->duration;
    Result<void> written = muxer_.write_sound(*packet_, number_);
    return written ? begin() : written;
  }
  double end() const override { return double(end_) / sound_.format().sample_rate; }
  double share() const override { return seconds_ > 0 ? end() / seconds_ : 1; }

 private:
  Muxer& muxer_;
  SoundSource& sound_;
  double seconds_;
  int number_;
  const AudioPacket* packet_ = nullptr;
  std::int64_t end_ = 0;
};

class TextFeed : public TrackFeed {
 public:
  TextFeed(Muxer& muxer, const TextSamples& text, int number)
      : muxer_(muxer), text_(text), number_(number) {}

  Result<void> begin() override { return {}; }
  bool ready() const override { return next_ < text_.samples.size(); }
  std::int64_t time() const override { return text_.samples[next_].time; }
  AVRational time_base() const override { return text_.time_base; }
  bool sync() const override { return true; }
  Result<void> write() override { return muxer_.write_text(text_.samples[next_++], number_); }
  double end() const override { return 0; }  // what is shown does not make the file longer
  double share() const override { return 1; }
  bool sparse() const override { return true; }

 private:
  Muxer& muxer_;
  const TextSamples& text_;
  int number_;
  std::size_t next_ = 0;
};

/// The feed whose packet is due first, the earlier feed on a tie; nullptr: all are empty.
TrackFeed* first_due(const std::vector<std::unique_ptr<TrackFeed>>& feeds) {
  TrackFeed* first = nullptr;
  for (const auto& feed : feeds) {
    if (!feed->ready()) continue;
    const bool earlier = first == nullptr || av_compare_ts(feed->time(), feed->time_base(),
                                                           first->time(), first->time_base()) < 0;
    if (earlier) first = feed.get();
  }
  return first;
}

}  // namespace

std::unique_ptr<TrackFeed> face_feed(Muxer& muxer, const fba::AccessUnits& face, int number) {
  const auto write = [&muxer, number](const fba::AccessUnit& unit) {
    return muxer.write_unit(unit, number);
  };
  return std::make_unique<ListFeed<fba::AccessUnit>>(face.units, AVRational{1, int(face.timescale)},
                                                     &fba::AccessUnit::intra, write);
}

std::unique_ptr<TrackFeed> face_feed(Muxer& muxer, fba::UnitReader& units, int number) {
  return std::make_unique<UnitFeed>(muxer, units, number);
}

std::unique_ptr<TrackFeed> video_feed(Muxer& muxer, const EncodedVideo& video) {
  const auto write = [&muxer](const VideoPacket& packet) { return muxer.write_picture(packet); };
  return std::make_unique<ListFeed<VideoPacket>>(
      video.packets, AVRational{int(video.rate.den), int(video.rate.num)}, &VideoPacket::key,
      write);
}

std::unique_ptr<TrackFeed> sound_feed(Muxer& muxer, SoundSource& sound, double seconds,
                                      int number) {
  return std::make_unique<SoundFeed>(muxer, sound, seconds, number);
}

std::unique_ptr<TrackFeed> text_feed(Muxer& muxer, const TextSamples& samples, int text) {
  return std::make_unique<TextFeed>(muxer, samples, text);
}

Result<Interleaved> interleave(std::vector<std::unique_ptr<TrackFeed>>& feeds,
                               const std::function<bool()>& stop,
                               const std::function<void(double)>& progress) {
  for (const auto& feed : feeds) {
    if (auto begun = feed->begin(); !begun) return begun.error();
  }
  Interleaved result;
  const auto has_begun = [](const auto& feed) {
    return feed->sparse() || feed->end() >= kShortestFile || !feed->ready();
  };
  for (int steps = 1; TrackFeed* feed = first_due(feeds); ++steps) {
    if (stop && std::all_of(feeds.begin(), feeds.end(), has_begun) && stop()) {
      result.stopped = true;
      break;
    }
    if (feed->before) {
      if (auto done = feed->before(*feed); !done) return done.error();
    }
    if (auto written = feed->write(); !written) return written.error();
    if (!progress || steps % kReportEvery != 0) continue;
    double done = 1;
    for (const auto& each : feeds) done = std::min(done, each->share());
    progress(std::clamp(done, 0.0, 0.999));
  }
  for (const auto& feed : feeds) result.seconds = std::max(result.seconds, feed->end());
  return result;
}

}  // namespace animeme::media
