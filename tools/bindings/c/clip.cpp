// Clips: frames, text, whole streams, filling.

#include "codec/decode/decoder.h"
#include "fap/text.h"
#include "tools/bindings/c/c_internal.h"

using namespace animeme;

namespace animeme::c {

namespace {

constexpr std::string_view kClipIsNull = "clip is NULL";

// Returns a clip; `rules` say what its absent FAPs mean, if that is known.
animeme_status give_clip(animeme_clip** out, fap::Sequence sequence,
                         std::vector<fap::GroupRules> rules = {}) {
  auto clip = std::make_unique<animeme_clip>();
  rules.resize(sequence.frames.size());
  clip->sequence = std::move(sequence);
  clip->rules = std::move(rules);
  return give(out, std::move(clip));
}

animeme_status decode_clip(const uint8_t* bytes, size_t size, animeme_clip** out,
                           animeme_error* error) {
  auto stream = fba::decode({bytes, size});
  if (!stream) return fail(error, stream.error());
  std::vector<fap::GroupRules> rules;
  for (const fba::Plane& plane : stream->planes) {
    if (!fba::has_face(plane.object_mask)) continue;
    rules.push_back(rules_of(plane));
  }
  return give_clip(out, fba::face_sequence(*stream), std::move(rules));
}

}  // namespace

bool fill_options(std::uint32_t flags, fap::FillOptions& options) {
  options.interpolate = (flags & ANIMEME_FILL_INTERPOLATE) != 0;
  options.keep_high_level = (flags & ANIMEME_FILL_KEEP_HIGH_LEVEL) != 0;
  options.expand = (flags & ANIMEME_FILL_EXPAND) != 0;
  options.complete = (flags & ANIMEME_FILL_COMPLETE) != 0;
  return flags < 2 * ANIMEME_FILL_COMPLETE;
}

}  // namespace animeme::c

animeme_status animeme_clip_new(uint32_t rate_num, uint32_t rate_den, animeme_clip** clip,
                                animeme_error* error) {
  if (clip == nullptr) return c::invalid(error, c::kClipIsNull);
  *clip = nullptr;
  const fap::Rate rate = fap::make_rate(rate_num, rate_den);
  if (!rate.valid()) return c::invalid(error, "both parts of the rate must be above 0");
  return c::guarded(error, [&] { return c::give_clip(clip, {rate, {}, {}}); });
}

void animeme_clip_free(animeme_clip* clip) { delete clip; }

animeme_status animeme_clip_add(animeme_clip* clip, const animeme_frame* frame,
                                animeme_error* error) {
  if (clip == nullptr) return c::invalid(error, c::kClipIsNull);
  return c::guarded(error, [&]() -> animeme_status {
    fap::Frame taken;
    fap::GroupRules rules;
    if (auto status = c::take_frame(frame, taken, &rules, error); status != 0) return status;
    auto& frames = clip->sequence.frames;
    if (taken.number < 0 || (!frames.empty() && taken.number <= frames.back().number)) {
      return c::invalid(error, "the numbers of frames have to ascend from 0 or more");
    }
    frames.push_back(taken);
    clip->rules.resize(frames.size(), rules);
    return ANIMEME_OK;
  });
}

size_t animeme_clip_count(const animeme_clip* clip) {
  return clip == nullptr ? 0 : clip->sequence.frames.size();
}

animeme_status animeme_clip_get(const animeme_clip* clip, size_t index, animeme_frame* frame,
                                animeme_error* error) {
  if (clip == nullptr) return c::invalid(error, c::kClipIsNull);
  if (!c::writable(frame, error)) return ANIMEME_INVALID_ARGUMENT;
  if (index >= clip->sequence.frames.size()) {
    return c::fail(error, ANIMEME_OUT_OF_RANGE, "the clip has no frame of this index");
  }
  const fap::Frame& from = clip->sequence.frames[index];
  const fap::Rate rate = clip->sequence.rate;
  const c::FrameTimes times{ANIMEME_FRAME_FACE, rate.seconds(double(from.number)), rate};
  c::put_frame(frame, from, clip->rules[index], times);
  return ANIMEME_OK;
}

animeme_status animeme_clip_rate(const animeme_clip* clip, uint32_t* rate_num, uint32_t* rate_den,
                                 animeme_error* error) {
  if (clip == nullptr) return c::invalid(error, c::kClipIsNull);
  if (rate_num != nullptr) *rate_num = clip->sequence.rate.num;
  if (rate_den != nullptr) *rate_den = clip->sequence.rate.den;
  return ANIMEME_OK;
}

animeme_status animeme_clip_from_text(const char* text, size_t length, animeme_clip** clip,
                                      animeme_error* error) {
  if (clip == nullptr) return c::invalid(error, c::kClipIsNull);
  *clip = nullptr;
  if (text == nullptr) return c::invalid(error, "text is NULL");
  return c::guarded(error, [&]() -> animeme_status {
    auto sequence = fap::read_text({text, length});
    if (!sequence) return c::fail(error, sequence.error());
    return c::give_clip(clip, std::move(*sequence));
  });
}

animeme_status animeme_clip_to_text(const animeme_clip* clip, char** text, size_t* length,
                                    animeme_error* error) {
  if (text == nullptr) return c::invalid(error, "text is NULL");
  *text = nullptr;
  if (clip == nullptr) return c::invalid(error, c::kClipIsNull);
  return c::guarded(error,
                    [&] { return c::give_copy(text, length, fap::write_text(clip->sequence)); });
}

animeme_status animeme_clip_decode(const uint8_t* bytes, size_t size, animeme_clip** clip,
                                   animeme_error* error) {
  if (clip == nullptr) return c::invalid(error, c::kClipIsNull);
  *clip = nullptr;
  if (bytes == nullptr) return c::invalid(error, "bytes is NULL");
  return c::guarded(error, [&] { return c::decode_clip(bytes, size, clip, error); });
}

animeme_status animeme_clip_fill(const animeme_clip* clip, uint32_t flags, animeme_clip** filled,
                                 animeme_error* error) {
  if (filled == nullptr) return c::invalid(error, "filled is NULL");
  *filled = nullptr;
  if (clip == nullptr) return c::invalid(error, c::kClipIsNull);
  fap::FillOptions options;
  if (!c::fill_options(flags, options)) return c::invalid(error, "these are not ANIMEME_FILL_...");
  return c::guarded(error, [&]() -> animeme_status {
    auto made = fap::fill(clip->sequence, clip->rules, options);
    if (!made) return c::fail(error, made.error());
    return c::give_clip(filled, std::move(*made));
  });
}
