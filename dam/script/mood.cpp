#include "dam/script/mood.h"

#include <algorithm>

#include "dam/script/script_text_internal.h"
#include "fap/detail/real_text.h"

namespace animeme::dam {
namespace {

constexpr double kMostFactor = 2;  // Azure's styledegree

constexpr std::string_view kMoods[] = {
    "neutral",    "joy",      "sadness",     "anger",    "fear",        "disgust",  "surprise",
    "friendly",   "excited",  "loving",      "hopeful",  "proud",       "calm",     "serious",
    "determined", "thinking", "doubtful",    "confused", "ironic",      "contempt", "bored",
    "sleepy",     "worried",  "embarrassed", "pain",     "disgruntled", "shouting", "whispering"};

// Other words, and the styles of Azure (https://learn.microsoft.com/azure/ai-services/
// speech-service/speech-synthesis-markup-voice), which are neither of them at full strength at
// their usual degree of 1.
struct OtherName {
  std::string_view name, mood;
  double intensity;
};

constexpr OtherName kOtherNames[] = {
    // words
    {"none", "neutral", 1},
    {"default", "neutral", 1},
    {"normal", "neutral", 1},
    {"happy", "joy", 1},
    {"happiness", "joy", 1},
    {"joyful", "joy", 1},
    {"glad", "joy", 0.8},
    {"fun", "joy", 0.8},
    {"amused", "joy", 0.7},
    {"laughing", "joy", 1},
    {"smile", "friendly", 1},
    {"smiling", "friendly", 1},
    {"pleased", "friendly", 0.9},
    {"sorrow", "sadness", 1},
    {"unhappy", "sadness", 0.8},
    {"upset", "sadness", 0.8},
    {"angry", "anger", 0.9},
    {"rage", "anger", 1},
    {"furious", "anger", 1},
    {"mad", "anger", 0.8},
    {"annoyed", "anger", 0.5},
    {"afraid", "fear", 0.9},
    {"scared", "fear", 0.9},
    {"frightened", "fear", 0.9},
    {"disgusted", "disgust", 0.9},
    {"surprised", "surprise", 0.9},
    {"astonished", "surprise", 1},
    {"amazed", "surprise", 0.8},
    {"enthusiastic", "excited", 1},
    {"love", "loving", 1},
    {"tender", "loving", 0.8},
    {"relaxed", "calm", 1},
    {"content", "calm", 1},
    {"pensive", "thinking", 1},
    {"thoughtful", "thinking", 1},
    {"skeptical", "doubtful", 1},
    {"sceptical", "doubtful", 1},
    {"puzzled", "confused", 1},
    {"irony", "ironic", 1},
    {"sarcastic", "ironic", 1},
    {"smug", "ironic", 0.8},
    {"tired", "sleepy", 0.8},
    {"anxious", "worried", 1},
    {"nervous", "worried", 0.8},
    {"shy", "embarrassed", 0.8},
    // styles of Azure
    {"general", "neutral", 1},
    {"cheerful", "joy", 0.8},
    {"sad", "sadness", 0.8},
    {"depressed", "sadness", 1},
    {"sorry", "sadness", 0.5},
    {"fearful", "fear", 0.8},
    {"terrified", "fear", 1},
    {"unfriendly", "anger", 0.4},
    {"gentle", "loving", 0.6},
    {"affectionate", "loving", 1},
    {"empathetic", "worried", 0.5},
    {"envious", "disgruntled", 0.5},
    {"relieved", "calm", 1},
    {"lyrical", "calm", 0.8},
    {"poetry reading", "calm", 0.8},
    {"whisper", "whispering", 1},
    {"shout", "shouting", 1},
    {"chat", "friendly", 0.7},
    {"chat casual", "friendly", 0.7},
    {"conversation", "friendly", 0.5},
    {"assistant", "friendly", 0.5},
    {"customerservice", "friendly", 0.8},
    {"customer service", "friendly", 0.8},
    {"story", "friendly", 0.4},
    {"advertisement upbeat", "joy", 0.7},
    {"livecommercial", "joy", 0.6},
    {"sports commentary", "excited", 0.7},
    {"sports commentary excited", "excited", 1},
    {"newscast", "serious", 0.4},
    {"newscast casual", "friendly", 0.4},
    {"newscast formal", "serious", 0.6},
    {"narration professional", "serious", 0.3},
    {"narration relaxed", "calm", 0.8},
    {"documentary narration", "calm", 0.6},
    // of Amazon Polly and Google
    {"disappointed", "sadness", 0.6},
    {"apologetic", "sadness", 0.5},
    {"firm", "determined", 0.6},
    {"lively", "excited", 0.6},
};

// In lower case, with single blanks for whatever parts words.
std::string plain_name(std::string_view text) {
  std::string name;
  for (const char c : lower_case(trimmed(text))) {
    const bool blank = c == ' ' || c == '-' || c == '_' || c == '\t';
    if (!blank) {
      name += c;
    } else if (!name.empty() && name.back() != ' ') {
      name += ' ';
    }
  }
  while (name.ends_with(' ')) name.pop_back();
  return name;
}

std::string nearest_mood(const std::string& name) {
  constexpr std::size_t kLongest = 40;
  if (name.empty() || name.size() > kLongest) return {};
  std::string nearest;
  std::size_t fewest = std::max<std::size_t>(1, name.size() / 3) + 1;
  const auto compare = [&](std::string_view known) {
    const std::size_t steps = edit_distance(name, known);
    if (steps >= fewest) return;
    fewest = steps;
    nearest = known;
  };
  for (const std::string_view known : kMoods) compare(known);
  for (const OtherName& known : kOtherNames) compare(known.name);
  return nearest;
}

Error unknown(std::string_view text, const std::string& name) {
  std::string all;
  for (const std::string_view known : kMoods) all += (all.empty() ? "" : ", ") + std::string(known);
  const std::string nearest = nearest_mood(name);
  return make_error(Code::not_found,
                    "there is no mood \"" + std::string(text.substr(0, 40)) + "\"" +
                        (nearest.empty() ? "" : "; did you mean " + nearest + "?") +
                        " The moods are " + all);
}

}  // namespace

std::vector<std::string> mood_names() { return {std::begin(kMoods), std::end(kMoods)}; }

Result<Mood> make_mood(std::string_view name, double intensity) {
  if (!(intensity >= 0 && intensity <= kMostFactor)) {
    return make_error(Code::invalid_argument,
                      "the intensity of a mood lies between 0 and 1 (2 for styles)");
  }
  const std::string plain = plain_name(name);
  for (const std::string_view known : kMoods) {
    if (plain == known) return Mood{plain, std::min(intensity, 1.0)};
  }
  for (const OtherName& known : kOtherNames) {
    if (plain == known.name)
      return Mood{std::string(known.mood), std::min(known.intensity * intensity, 1.0)};
  }
  return unknown(name, plain);
}

Result<Mood> read_mood(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return make_mood(text, 1);
  const std::string_view number = trimmed(text.substr(colon + 1));
  double intensity = 0;
  const auto [end, error] =
      fap::detail::read_real(number.data(), number.data() + number.size(), intensity);
  if (error != std::errc{} || end != number.data() + number.size()) {
    return make_error(Code::invalid_argument,
                      "a mood is written NAME or NAME:INTENSITY, as joy:0.6, not \"" +
                          std::string(text.substr(0, 40)) + "\"");
  }
  return make_mood(text.substr(0, colon), intensity);
}

std::string mood_text(const Mood& mood) {
  if (mood.intensity == 1) return mood.name;
  std::string text = mood.name + ":";
  fap::detail::append_shortest(text, mood.intensity);
  return text;
}

}  // namespace animeme::dam
