#include "tools/app/commands/mood_options.h"

#include "tools/app/commands/options.h"

namespace animeme::tools {

void add_mood_option(OptionTable& cli, std::string& mood) {
  cli.add("--mood", mood,
          "Mood: joy, sadness, anger, fear, disgust, surprise, friendly, ironic ...; joy:0.6 is "
          "less "
          "of it; SSML and emoji change it")
      ->value("NAME[:0..1]")
      ->check(problem_of<dam::read_mood>);
}

dam::Mood mood_of(const std::string& option) {
  if (option.empty()) return {};
  const auto mood = dam::read_mood(option);
  return mood ? *mood : dam::Mood{};
}

}  // namespace animeme::tools
