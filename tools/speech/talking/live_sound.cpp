#include "tools/speech/talking/live_sound.h"

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
  const bool follows = std::any_of(pieces_.begin(), pieces_.end(), [start](const Piece& piece) {
    return piece.start + std::int64_t(piece.samples.size()) == start;
  });
  const std::int64_t from = std::max(start, made_);
  for (std::int64_t at = from; !follows && at < from + fade_; ++at) {
    if (at - start >= std::int64_t(samples.size())) break;
    samples[std::size_t(at - start)] *=
        float(dam::raised_step(double(at - from + 1) / double(fade_ + 1)));
  }
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

std::vector<float> LiveSound::rest() const {
  std::vector<float> rest;
  for (const Piece& piece : pieces_) {
    const std::int64_t over = piece.start + std::int64_t(piece.samples.size());
    const std::int64_t first = std::max(made_, piece.start);
    if (over <= first) continue;
    rest.resize(std::max(rest.size(), std::size_t(over - made_)), 0.0F);
    for (std::int64_t at = first; at < over; ++at) {
      rest[std::size_t(at - made_)] += piece.samples[std::size_t(at - piece.start)];
    }
  }
  return rest;
}

// Whether a piece is heard at a sample.
bool LiveSound::goes_on(std::int64_t at) const {
  return std::any_of(pieces_.begin(), pieces_.end(), [at](const Piece& piece) {
    return piece.start <= at && at < piece.start + std::int64_t(piece.samples.size());
  });
}

std::vector<float> LiveSound::block() {
  // No piece ends shortly behind the block: its end would be too short for a fade.
  std::int64_t end = made_ + std::int64_t(block_);
  for (const Piece& piece : pieces_) {
    const std::int64_t last = piece.start + std::int64_t(piece.samples.size());
    if (last > end && last <= end + fade_) end = last;
  }
  std::vector<float> block(std::size_t(end - made_), 0.0F);
  for (const Piece& piece : pieces_) {
    const std::int64_t over = piece.start + std::int64_t(piece.samples.size());
    const std::int64_t first = std::max(made_, piece.start), last = std::min(end, over);
    const bool breaks_off = over <= end && !goes_on(over);
    for (std::int64_t at = first; at < last; ++at) {
      const double left = breaks_off ? double(over - at) / double(fade_ + 1) : 1;
      block[std::size_t(at - made_)] +=
          piece.samples[std::size_t(at - piece.start)] * float(dam::raised_step(left));
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
