// What the library says of itself, names, and the options of speech.
#include <array>
#include <string>
#include <string_view>

#include "fap/arkit.h"
#include "fap/tables.h"
#include "tools/bindings/c/c_internal.h"
#include "tools/bindings/c/speak_options_internal.h"

using namespace animeme;

namespace animeme::c {

namespace {

animeme_speak_options speak_defaults() {
  animeme_speak_options options{};
  options.rate_num = 25;
  options.rate_den = 1;
  options.style = options.sharpness = options.idle_motion = 1;
  options.articulation = -1;
  options.seed = 1;
  options.look_ahead = -1;
  options.tongue = 1;
  return options;
}

// kArkitNames are pieces of one text; C wants a 0 behind each.
std::array<std::string, fap::kArkitChannelCount> ended_names() {
  std::array<std::string, fap::kArkitChannelCount> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = fap::kArkitNames[i];
  return names;
}

}  // namespace

animeme_status take_speak_options(const animeme_speak_options* given,
                                  animeme_speak_options& options, animeme_error* error) {
  options = speak_defaults();
  if (given == nullptr || take(*given, options, speak_defaults())) return ANIMEME_OK;
  return invalid(error, "this is no animeme_speak_options, see animeme_speak_options_init()");
}

}  // namespace animeme::c

uint32_t animeme_version(void) { return ANIMEME_VERSION_NUMBER; }

const char* animeme_version_text(void) { return ANIMEME_VERSION; }

int32_t animeme_has(const char* feature) {
  if (feature == nullptr) return 0;
  for (const std::string_view one : {"decode", "encode", "text", "fill", "arkit"}) {
    if (one == feature) return 1;
  }
  return ANIMEME_SPEAKS && std::string_view(feature) == "speak" ? 1 : 0;
}

const char* animeme_status_text(animeme_status status) {
  switch (status) {
    case ANIMEME_OK:
      return "ok";
    case ANIMEME_NEED_DATA:
      return "more data are needed";
    case ANIMEME_END:
      return "end of stream";
    case ANIMEME_INVALID_ARGUMENT:
      return "invalid argument";
    case ANIMEME_SYNTAX:
      return "syntax";
    case ANIMEME_OUT_OF_RANGE:
      return "out of range";
    case ANIMEME_TRUNCATED:
      return "truncated";
    case ANIMEME_UNSUPPORTED:
      return "unsupported";
    case ANIMEME_NOT_FOUND:
      return "not found";
    case ANIMEME_IO:
      return "input or output";
    case ANIMEME_INTERNAL:
      return "internal";
    case ANIMEME_NO_MEMORY:
      return "no memory";
    default:
      return "unknown status";
  }
}

const char* animeme_fap_name(int32_t fap) {
  return fap < 1 || fap > fap::kFapCount ? nullptr : animeme::fap::info(fap).name.data();
}

const char* animeme_arkit_name(int32_t channel) {
  if (channel < 0 || channel >= fap::kArkitChannelCount) return nullptr;
  static const auto names = c::ended_names();
  return names[std::size_t(channel)].c_str();
}

void animeme_speak_options_init(animeme_speak_options* options, size_t size) {
  c::init(options, size, c::speak_defaults());
}
