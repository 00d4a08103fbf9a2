// A script of JSON is read, nothing is no script.
#include <animeme/scripts/script_text.h>

int main() {
  const auto cues =
      animeme::scripts::read_labels(R"({"mouthCues": [{"start": 0, "end": 1, "value": "A"}]})");
  return cues && cues->labels.size() == 1 && !animeme::scripts::read_labels("") ? 0 : 1;
}
