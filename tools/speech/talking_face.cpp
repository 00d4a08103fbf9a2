#include "tools/speech/talking_face.h"

#include <string>
#include <utility>

#include "dam/maths/raised_cosine.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/life.h"

namespace animeme::speech {

namespace {

constexpr double kFade = 0.25;       // seconds
constexpr double kIdleSeconds = 20;  // of one piece
constexpr std::size_t kNoFrame = ~std::size_t(0);

dam::Script silence() {
  dam::Script script;
  script.phones.push_back({0, kIdleSeconds, std::string(dam::kSilence), {}});
  return script;
}

/// `last` is what was shown before row 0: the difference fades.
void lead_over(const std::vector<double>& last, dam::Signal& signal) {
  const std::size_t controls = signal.names.size();
  if (last.size() != controls || signal.frames() == 0) return;
  std::vector<double> offset(controls);
  for (std::size_t c = 0; c < controls; ++c) offset[c] = last[c] - signal.at(0, c);
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    // Row 0 comes one frame after `last`.
    const double share = dam::raised_bell(signal.rate.seconds(double(i + 1)) / kFade);
    if (share <= 0) return;
    for (std::size_t c = 0; c < controls; ++c) signal.at(i, c) += share * offset[c];
  }
}

std::vector<double> row(const dam::Signal& signal, std::size_t frame) {
  if (frame == kNoFrame || frame >= signal.frames()) return {};
  const std::size_t controls = signal.names.size();
  const auto begin = signal.values.begin() + std::ptrdiff_t(frame * controls);
  return {begin, begin + std::ptrdiff_t(controls)};
}

bool mouth_differs(const fap::Frame& a, const fap::Frame& b, const fap::Mask& mouth) {
  for (std::size_t fap = fap::kFirstLowLevel; fap < mouth.size(); ++fap) {
    if (mouth[fap] && a.value[fap] != b.value[fap]) return true;
  }
  return false;
}

}  // namespace

Result<TalkingFace> TalkingFace::open(const dam::Model& model, const FaceOptions& options) {
  TalkingFace face(model, options);
  if (auto ok = face.begin(silence()); !ok) return ok.error();
  face.mask_ = face.clip_.frames.front().mask;
  return face;
}

Result<void> TalkingFace::begin(const dam::Script& script) {
  dam::SynthesisOptions synthesis = options_.synthesis;
  synthesis.frames = 0;
  synthesis.tail = 0;
  Result<dam::Signal> signal = dam::synthesise(*model_, script, synthesis);
  if (!signal) return signal.error();
  if (options_.life) {
    auto added = dam::add_life(*signal, script, {1, options_.seed + pieces_});
    if (!added) return added.error();
  }
  lead_over(row(signal_, at_ == 0 ? kNoFrame : at_ - 1), *signal);
  Result<fap::Sequence> clip = dam::to_sequence(*signal);
  if (!clip) return clip.error();
  if (clip->frames.empty()) return make_error(Code::invalid_argument, "the script lasts no time");
  ++pieces_;
  signal_ = std::move(*signal);
  clip_ = std::move(*clip);
  at_ = 0;
  return {};
}

Result<Line> TalkingFace::say(const dam::Script& script) {
  const fap::Frame before = at_ == 0 ? clip_.frames.front() : clip_.frames[at_ - 1];
  if (auto ok = begin(script); !ok) return ok.error();
  speaking_ = true;
  fap::Mask mouth;
  for (const dam::Control& control : model_->controls) {
    const int fap = dam::fap_of_channel(control.name);
    if (fap > 0) mouth.set(std::size_t(fap));
  }
  Line line{number_, std::int64_t(clip_.frames.size()), number_};
  for (std::size_t i = 0; i < clip_.frames.size(); ++i) {
    if (!mouth_differs(clip_.frames[i], before, mouth)) continue;
    line.first_moved += std::int64_t(i);
    break;
  }
  return line;
}

Result<fap::Frame> TalkingFace::next() {
  if (at_ >= clip_.frames.size()) {
    if (auto ok = begin(silence()); !ok) return ok.error();
    speaking_ = false;
  }
  fap::Frame frame = clip_.frames[at_++];
  frame.number = number_++;
  return frame;
}

}  // namespace animeme::speech
