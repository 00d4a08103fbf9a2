// Scripts to frames, at once or as they are made.
#include <algorithm>
#include <deque>

#include "dam/model/builtin.h"
#include "dam/model/model.h"
#include "dam/script/script.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "dam/speaking/stream.h"
#include "dam/speaking/synthesise.h"
#include "tools/bindings/c/c_internal.h"
#include "tools/bindings/c/speak_options_internal.h"

using namespace animeme;

struct animeme_model {
  std::shared_ptr<const dam::Model> model;
};

struct animeme_speech {
  std::shared_ptr<const dam::Model> model;
  dam::SpeechStream stream;
  std::deque<fap::Frame> frames;  // final, not given out yet
  fap::Rate rate;
  bool finished = false;
};

namespace animeme::c {

namespace {

animeme_status give_model(animeme_model** out, Result<dam::Model> model, animeme_error* error) {
  if (!model) return fail(error, model.error());
  auto shared = std::make_shared<const dam::Model>(std::move(*model));
  return give(out, std::make_unique<animeme_model>(animeme_model{std::move(shared)}));
}

dam::SynthesisOptions synthesis_options(const animeme_speak_options& from) {
  dam::SynthesisOptions options;
  options.rate = fap::make_rate(from.rate_num, from.rate_den);
  options.style = from.style;
  options.sharpness = from.sharpness;
  options.articulation = std::nullopt;
  if (!(from.articulation < 0)) options.articulation = from.articulation;
  options.tail = from.tail;
  options.tongue = from.tongue != 0;
  options.symmetric_rest = from.asymmetric_rest == 0;
  return options;
}

template <std::size_t kSize>
std::string_view text_of(const char (&field)[kSize]) {
  return {field, std::size_t(std::find(field, field + kSize, '\0') - field)};
}

Result<dam::Mood> mood_of(const animeme_speak_options& options) {
  const std::string_view mood = text_of(options.mood);
  return mood.empty() ? dam::Mood{} : dam::read_mood(mood);
}

Result<dam::IdleMotionOptions> idle_options(const animeme_speak_options& from) {
  dam::IdleMotionOptions options{from.idle_motion, from.seed};
  const auto still = dam::parse_still(text_of(from.still));
  if (!still) return still.error();
  options.still = *still;
  if (text_of(from.look).empty()) return options;
  const auto look = dam::parse_look(text_of(from.look));
  if (!look) return look.error();
  options.look = *look;
  return options;
}

animeme_status speak_clip(const dam::Model& model, std::string_view text,
                          const animeme_speak_options& options, animeme_clip** out,
                          animeme_error* error) {
  const auto script = dam::read_script(text);
  if (!script) return fail(error, script.error());
  auto signal = dam::synthesise(model, *script, synthesis_options(options));
  if (!signal) return fail(error, signal.error());
  const auto idle = idle_options(options);
  if (!idle) return fail(error, idle.error());
  if (!(options.idle_motion < 0)) {
    const auto added = dam::add_idle_motion(*signal, *script, *idle);
    // Whose rig is unknown moves by its own channels alone.
    if (!added && added.error().code != Code::unsupported) return fail(error, added.error());
  }
  const auto mood = mood_of(options);
  if (!mood) return fail(error, mood.error());
  const auto moody = dam::add_moods(*signal, *script, dam::MoodTrack(*mood));
  if (!moody) return fail(error, moody.error());
  auto sequence = dam::to_sequence(*signal);
  if (!sequence) return fail(error, sequence.error());
  auto clip = std::make_unique<animeme_clip>();
  clip->sequence = std::move(*sequence);
  clip->rules.resize(clip->sequence.frames.size());
  return give(out, std::move(clip));
}

animeme_status queue_frames(animeme_speech& speech, const Result<dam::Signal>& signal,
                            animeme_error* error) {
  if (!signal) return fail(error, signal.error());
  if (signal->frames() == 0) return ANIMEME_OK;
  const auto made = dam::to_sequence(*signal);
  if (!made) return fail(error, made.error());
  for (fap::Frame frame : made->frames) {
    frame.number += std::int64_t(signal->first_frame);
    speech.frames.push_back(frame);
  }
  return ANIMEME_OK;
}

}  // namespace

}  // namespace animeme::c

animeme_status animeme_model_builtin(animeme_model** model, animeme_error* error) {
  if (model == nullptr) return c::invalid(error, "model is NULL");
  *model = nullptr;
  return c::guarded(error, [&] { return c::give_model(model, dam::builtin_model(), error); });
}

animeme_status animeme_model_read(const uint8_t* bytes, size_t size, animeme_model** model,
                                  animeme_error* error) {
  if (model == nullptr) return c::invalid(error, "model is NULL");
  *model = nullptr;
  if (bytes == nullptr) return c::invalid(error, "bytes is NULL");
  return c::guarded(error, [&] {
    return c::give_model(model, dam::read_model({bytes, size}), error);
  });
}

void animeme_model_free(animeme_model* model) { delete model; }

const char* animeme_model_attribution(const animeme_model* model) {
  return model == nullptr ? nullptr : model->model->attribution.c_str();
}

animeme_status animeme_speak(const animeme_model* model, const char* script, size_t length,
                             const animeme_speak_options* options, animeme_clip** clip,
                             animeme_error* error) {
  if (clip == nullptr) return c::invalid(error, "clip is NULL");
  *clip = nullptr;
  if (model == nullptr) return c::invalid(error, "model is NULL");
  if (script == nullptr) return c::invalid(error, "script is NULL");
  return c::guarded(error, [&]() -> animeme_status {
    animeme_speak_options taken;
    const auto status = c::take_speak_options(options, taken, error);
    if (status != ANIMEME_OK) return status;
    return c::speak_clip(*model->model, {script, length}, taken, clip, error);
  });
}

animeme_status animeme_speech_new(const animeme_model* model, const animeme_speak_options* options,
                                  animeme_speech** speech, animeme_error* error) {
  if (speech == nullptr) return c::invalid(error, "speech is NULL");
  *speech = nullptr;
  if (model == nullptr) return c::invalid(error, "model is NULL");
  return c::guarded(error, [&]() -> animeme_status {
    animeme_speak_options taken;
    const auto status = c::take_speak_options(options, taken, error);
    if (status != ANIMEME_OK) return status;
    dam::StreamOptions stream;
    stream.synthesis = c::synthesis_options(taken);
    if (auto valid = dam::validate(stream.synthesis); !valid) return c::fail(error, valid.error());
    if (taken.look_ahead > 60) return c::invalid(error, "look_ahead must be 60 s at most");
    auto mood = c::mood_of(taken);
    if (!mood) return c::fail(error, mood.error());
    stream.mood = std::move(*mood);
    if (taken.look_ahead >= 0) stream.look_ahead = taken.look_ahead;
    return c::give(
        speech,
        std::make_unique<animeme_speech>(animeme_speech{
            model->model, dam::SpeechStream(*model->model, stream), {}, stream.synthesis.rate}));
  });
}

void animeme_speech_free(animeme_speech* speech) { delete speech; }

animeme_status animeme_speech_push(animeme_speech* speech, double start, double end,
                                   const char* phone, animeme_error* error) {
  if (speech == nullptr) return c::invalid(error, "speech is NULL");
  if (phone == nullptr) return c::invalid(error, "phone is NULL");
  return c::guarded(error, [&]() -> animeme_status {
    auto pushed = speech->stream.push({start, end, phone, {}});
    if (!pushed) return c::fail(error, pushed.error());
    return c::queue_frames(*speech, speech->stream.pull(), error);
  });
}

animeme_status animeme_speech_finish(animeme_speech* speech, animeme_error* error) {
  if (speech == nullptr) return c::invalid(error, "speech is NULL");
  if (speech->finished) return ANIMEME_OK;
  return c::guarded(error, [&]() -> animeme_status {
    const auto status = c::queue_frames(*speech, speech->stream.finish(), error);
    speech->finished = true;
    return status;
  });
}

animeme_status animeme_speech_next(animeme_speech* speech, animeme_frame* frame,
                                   animeme_error* error) {
  if (speech == nullptr) return c::invalid(error, "speech is NULL");
  if (!c::writable(frame, error)) return ANIMEME_INVALID_ARGUMENT;
  if (speech->frames.empty()) return speech->finished ? ANIMEME_END : ANIMEME_NEED_DATA;
  const fap::Frame& front = speech->frames.front();
  const double seconds = speech->rate.seconds(double(front.number));
  c::put_frame(frame, front, {}, {ANIMEME_FRAME_FACE, seconds, speech->rate});
  speech->frames.pop_front();
  return ANIMEME_OK;
}
