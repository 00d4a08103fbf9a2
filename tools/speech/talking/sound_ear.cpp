#include "tools/speech/talking/sound_ear.h"

#include <algorithm>
#include <span>
#include <utility>

namespace animeme::speech {

namespace {

constexpr double kBefore = 0.3;      // seconds of sound before a part that matter to it
constexpr double kKeptHearing = 2;   // seconds of results
constexpr double kSame = 1e-6;       // seconds
constexpr int kLeastEarRate = 4000;  // Hz

}  // namespace

std::optional<dam::Script> SoundEar::hear(const std::vector<Piece>& pieces, double begin,
                                          double end) {
  if (!why_.empty()) return std::nullopt;
  const auto piece = std::find_if(pieces.begin(), pieces.end(),
                                  [begin](const Piece& one) { return one.end() > begin + kSame; });
  if (piece == pieces.end()) return std::nullopt;
  const int rate = piece->sound->sample_rate;
  if (rate < kLeastEarRate) {
    why_ = "sound of less than 4000 Hz";
    return std::nullopt;
  }
  // Sound between that was not listened to, or of another rate: it begins anew.
  const bool goes_on =
      listener_ && rate == rate_ && from_ <= begin + kSame && until_ >= begin - kBefore - kSame;
  if (!goes_on) {
    voice::ListenOptions options;
    options.language = language_;
    auto opened = voice::SoundListener::open(rate, options);
    if (!opened) {
      why_ = opened.error().message;
      return std::nullopt;
    }
    listener_ = std::move(*opened);
    rate_ = rate;
    from_ = begin;
    for (auto before = piece;; --before) {
      if (before->sound->sample_rate != rate) break;
      from_ = std::max(before->start, begin - kBefore);
      if (before->start <= from_ || before == pieces.begin()) break;
    }
    until_ = from_;
    forgotten_ = 0;
  }
  for (const Piece& one : pieces) {
    if (one.end() <= until_ + kSame) continue;
    if (one.sound->sample_rate != rate || one.start > end + kLookAhead) break;
    const auto skipped = std::size_t(std::max(0.0, (until_ - one.start) * rate + 0.5));
    if (skipped < one.sound->samples.size()) {
      listener_->push(std::span(one.sound->samples).subspan(skipped));
    }
    until_ = one.end();
  }
  const double ear = std::max(begin - from_, 0.0);
  if (ear < forgotten_) return dam::Script{};  // it was asked for before
  voice::Recognition heard = listener_->hear(ear);
  forgotten_ = std::max(forgotten_, ear - kKeptHearing);
  listener_->forget(forgotten_);
  dam::Script script;
  for (dam::Phone& phone : heard.script.phones) {
    if (phone.start >= end - begin) break;
    phone.end = std::min(phone.end, end - begin);
    phone.word.clear();  // recognised words are guesses; nobody is told of them
    phone.link = dam::WordLink::automatic;
    script.phones.push_back(std::move(phone));
  }
  // What is not decided yet goes on as it was.
  if (!script.phones.empty()) script.phones.back().end = end - begin;
  return script;
}

}  // namespace animeme::speech
