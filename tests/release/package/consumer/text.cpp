// A text on its way to a voice; what stands behind it may have been left out.
#include <animeme/text/utterance.h>

int main() {
  animeme::text::Speakers speakers;
  speakers.list.push_back(
      {.language = "en-us", .voice = "gmw/en-US", .name = "English", .scripts = {}});
  const auto made = animeme::text::make_utterance("Hello", speakers, {});
  return made && made->source == U"Hello" ? 0 : 1;
}
