#include "tools/media/detail/interleaver.h"

#include <algorithm>

namespace animeme::media {
namespace {

constexpr int kReportEvery = 64;
constexpr double kShortestFile = 0.5;  // seconds; readers cannot tell what less is (TS)

class FaceFeed : public TrackFeed {
 public:
  FaceFeed(Muxer& muxer, const fba::AccessUnits& face) : muxer_(muxer), face_(face) {}

  Result<void> begin() override { return {}; }
  bool ready() const override { return next_ < face_.units.size(); }
  std::int64_t time() const override { return face_.units[next_].time; }
  AVRational time_base() const override { return {1, int(face_.timescale)}; }
  bool sync() const override { return face_.units[next_].intra; }
  Result<void> write() override { return muxer_.write_unit(face_.units[next_++]); }
  double end() const override {
    if (next_ == 0) return 0;
    const fba::AccessUnit& last = face_.units[next_ - 1];
    return double(last.time + last.duration) / face_.timescale;
  }
  double share() const override { return double(next_) / double(face_.units.size()); }

 private:
  Muxer& muxer_;
  const fba::AccessUnits& face_;
  std::size_t next_ = 0;
};

class VideoFeed : public TrackFeed {
 public:
  VideoFeed(Muxer& muxer, const EncodedVideo& video) : muxer_(muxer), video_(video) {}

  Result<void> begin() override { return {}; }
  bool ready() const override { return next_ < video_.packets.size(); }
  std::int64_t time() const override { return video_.packets[next_].time; }
  AVRational time_base() const override { return {int(video_.rate.den), int(video_.rate.num)}; }
  bool sync() const override { return video_.packets[next_].key; }
  Result<void> write() override { return muxer_.write_picture(video_.packets[next_++]); }
  double end() const override {
    return next_ == 0 ? 0 : video_.rate.seconds(double(video_.packets[next_ - 1].time + 1));
  }
  double share() const override { return double(next_) / double(video_.packets.size()); }

 private:
  Muxer& muxer_;
  const EncodedVideo& video_;
  std::size_t next_ = 0;
};

class SoundFeed : public TrackFeed {
 public:
  SoundFeed(Muxer& muxer, SoundSource& sound, double seconds)
      : muxer_(muxer), sound_(sound), seconds_(seconds) {}

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
    Result<void> written = muxer_.write_sound(*packet_);
    return written ? begin() : written;
  }
  double end() const override { return double(end_) / sound_.format().sample_rate; }
  double share() const override { return seconds_ > 0 ? end() / seconds_ : 1; }

 private:
  Muxer& muxer_;
  SoundSource& sound_;
  double seconds_;
  const AudioPacket* packet_ = nullptr;
  std::int64_t end_ = 0;
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

std::unique_ptr<TrackFeed> face_feed(Muxer& muxer, const fba::AccessUnits& face) {
  return std::make_unique<FaceFeed>(muxer, face);
}

std::unique_ptr<TrackFeed> video_feed(Muxer& muxer, const EncodedVideo& video) {
  return std::make_unique<VideoFeed>(muxer, video);
}

std::unique_ptr<TrackFeed> sound_feed(Muxer& muxer, SoundSource& sound, double seconds) {
  return std::make_unique<SoundFeed>(muxer, sound, seconds);
}

Result<Interleaved> interleave(std::vector<std::unique_ptr<TrackFeed>>& feeds,
                               const std::function<bool()>& stop,
                               const std::function<void(double)>& progress) {
  for (const auto& feed : feeds) {
    if (auto begun = feed->begin(); !begun) return begun.error();
  }
  Interleaved result;
  const auto has_begun = [](const auto& feed) {
    return feed->end() >= kShortestFile || !feed->ready();
  };
  for (int steps = 1; TrackFeed* feed = first_due(feeds); ++steps) {
    if (stop && std::all_of(feeds.begin(), feeds.end(), has_begun) && stop()) {
      result.stopped = true;
      break;
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
