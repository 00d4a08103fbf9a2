#include <filesystem>
#include <span>

#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/moods.h"
#include "dam/speaking/tongue.h"
#include "dam/speaking/viseme_track.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/mood_options.h"
#include "tools/app/commands/speak_parts.h"

namespace animeme::tools {

namespace {

// nullopt: the signal has no lips of FAPs.
std::optional<LipClosures> lip_closures_of(const dam::Signal& signal, const dam::Script& script) {
  const auto lips = dam::inner_lip_channels(signal.names);
  if (!lips) return {};
  LipClosures all;
  for (const dam::Phone& phone : script.phones) {
    if (!dam::is_bilabial(phone.label)) continue;
    const dam::FrameSpan span = dam::frames_near(signal, phone, dam::kClosureSearch);
    bool closed = false;
    for (std::size_t frame = span.first; frame < span.last; ++frame)
      closed = closed || dam::inner_gap(signal, frame, *lips) < dam::kClosedGap;
    all.phones.emplace_back((phone.start + phone.end) / 2, closed);
  }
  return all;
}

dam::MoodTrack moods_of(const SpeakOptions& options, const speech::Spoken& spoken) {
  // The performance has moods of its own.
  const bool own = !options.performance || !options.mood.empty();
  return dam::MoodTrack(mood_of(options.mood),
                        own ? std::span(spoken.moods) : std::span<const dam::MoodSpan>());
}

}  // namespace

Error not_faps(const Error& error) {
  if (error.code != Code::not_found) return error;
  return make_error(Code::not_found,
                    "the controls of this model are neither FAPs nor ARKit blend shapes; write "
                    "them as curves with -o NAME.csv");
}

std::string language_of(const SpeakOptions& options, const speech::Spoken& spoken) {
  if (!spoken.languages.empty()) return spoken.languages.front().language;
  const bool script = !options.spoken.script.empty() && options.spoken.tts.empty();
  return script && !options.language_told ? std::string() : options.spoken.language;
}

// talk.json, and talk.livelink.csv beside talk.csv, which has the controls of the model.
bool is_arkit_output(const std::string& path) {
  const std::string inner = extension_of(std::filesystem::path(path).stem().string());
  return extension_of(path) == ".json" || (extension_of(path) == ".csv" && inner == ".livelink");
}

bool is_model_curves(const std::string& path) {
  return extension_of(path) == ".csv" && !is_arkit_output(path);
}

Result<void> add_life(const SpeakOptions& options, dam::Signal& signal,
                      const speech::Spoken& spoken, ShownFace& shown) {
  // Curves belong to the model's rig, and players of visemes have no brows.
  const bool curves = is_model_curves(options.output);
  const bool plain = curves || options.visemes == "instead";
  // A lossless stream cannot hold a tongue that curls: FAP 47 goes far beyond 1860 units.
  if (options.tongue && !plain && options.stream.quant > 0) dam::add_tongue(signal, spoken.script);
  const bool lives = options.idle.on.value_or(!plain);
  // Without being asked: where the names of a rig are not known, writing will say what it needs.
  dam::IdleMotionOptions idle = options.idle.motion;
  if (options.prosody) idle.prosody = &*options.prosody;
  idle.attention = options.attention;
  // Without quantisation, angles end at one degree.
  if (options.stream.quant == 0) idle.still.gaze = idle.still.head = true;
  if (options.performance) {
    dam::OverOptions settings{options.keep, options.over.bend};
    settings.idle = lives ? std::optional(idle) : std::nullopt;
    auto put = dam::speak_over(signal, spoken.script, *options.performance, settings);
    if (!put) return put.error();
    shown.over = std::move(*put);
  } else if (!plain || lives) {
    if (!lives) idle.liveliness = 0;
    auto added = dam::add_idle_motion(signal, spoken.script, idle);
    if (!added && options.idle.on.value_or(false)) return added.error();
  }
  if (!curves || !options.mood.empty()) {
    auto added = dam::add_moods(signal, spoken.script, moods_of(options, spoken));
    if (!added && !options.mood.empty()) return added.error();
  }
  if (!shown.lips) shown.lips = lip_closures_of(signal, spoken.script);
  return {};
}

Result<fap::Sequence> shown_clip(const SpeakOptions& options, const dam::Signal& signal,
                                 const speech::Spoken& spoken) {
  Result<fap::Sequence> clip = dam::to_sequence(signal);
  if (!clip) return not_faps(clip.error());
  clip->name = std::filesystem::path(options.output).stem().string();
  if (!options.visemes.empty()) {
    const bool instead = options.visemes == "instead";
    dam::show_visemes(spoken.script, *clip,
                      instead ? dam::VisemePlace::instead : dam::VisemePlace::beside);
  }
  if (!options.expressions.empty()) {
    const bool instead = options.expressions == "instead";
    dam::show_expressions(moods_of(options, spoken), *clip,
                          instead ? dam::ExpressionPlace::instead : dam::ExpressionPlace::beside);
  }
  return clip;
}

}  // namespace animeme::tools
