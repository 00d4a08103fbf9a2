#include "tools/speech/live_sound.h"

#include <algorithm>
#include <utility>

#include "dam/maths/raised_cosine.h"

namespace animeme::speech {

namespace {

// Encoders look ahead less than this; more blocks without a packet are a defect.
constexpr int kMostBlocks = 100;

}  // namespace

Result<LiveSound> LiveSound::open(int sample_rate, const media::AudioSettings& settings) {
  if (sample_rate < 1000) {
    return make_error(Code::invalid_argument, "the sample rate of a voice must be at least 1000");
  }
  Result<media::AudioEncoder> encoder = media::AudioEncoder::open(sample_rate, settings);
  if (!encoder) return encoder.error();
  return LiveSound(std::move(*encoder), sample_rate);
}

void LiveSound::add(std::int64_t start, std::vector<float> samples) {
  pieces_.push_back({start, std::move(samples)});
}

void LiveSound::end_at(std::int64_t end, std::int64_t fade) {
  const std::int64_t from = std::max(made_, end - fade);
  for (Piece& piece : pieces_) {
    const std::int64_t length = std::max<std::int64_t>(end - piece.start, 0);
    if (length < std::int64_t(piece.samples.size())) piece.samples.resize(std::size_t(length));
    for (std::int64_t at = std::max(from, piece.start);
         at < piece.start + std::int64_t(piece.samples.size()); ++at) {
      // One more than the samples, so that neither end is at 0 or 1 already.
      const double share = double(at - from + 1) / double(end - from + 1);
      piece.samples[std::size_t(at - piece.start)] *= float(dam::raised_bell(share));
    }
  }
  std::erase_if(pieces_, [](const Piece& piece) { return piece.samples.empty(); });
}

std::vector<float> LiveSound::block() {
  std::vector<float> block(block_, 0.0F);
  const std::int64_t end = made_ + std::int64_t(block_);
  for (const Piece& piece : pieces_) {
    const std::int64_t first = std::max(made_, piece.start);
    const std::int64_t last = std::min(end, piece.start + std::int64_t(piece.samples.size()));
    for (std::int64_t at = first; at < last; ++at) {
      block[std::size_t(at - made_)] += piece.samples[std::size_t(at - piece.start)];
    }
  }
  made_ = end;
  while (!pieces_.empty() &&
         pieces_.front().start + std::int64_t(pieces_.front().samples.size()) <= made_) {
    pieces_.pop_front();
  }
  return block;
}

Result<media::AudioPacket> LiveSound::next() {
  for (int i = 0; ready_.empty(); ++i) {
    if (i == kMostBlocks) return make_error(Code::internal, "the encoder of the sound is stuck");
    auto packets = encoder_.push(block());
    if (!packets) return packets.error();
    for (media::AudioPacket& packet : *packets) ready_.push_back(std::move(packet));
  }
  media::AudioPacket packet = std::move(ready_.front());
  ready_.pop_front();
  next_time_ = ready_.empty() ? packet.time + packet.duration : ready_.front().time;
  return packet;
}

}  // namespace animeme::speech
