#include "tools/speech/voice/wrong_texts.h"

#include "dam/script/phones.h"

namespace animeme::voice {

namespace {

// Neighbours sound unlike each other, so that any turn of the list makes other sounds.
constexpr const char* kVowelRing[] = {"IY", "AO", "EY", "UW", "AE", "OW", "IH", "AA",
                                      "ER", "EH", "OY", "AH", "AY", "UH", "AW"};
constexpr const char* kConsonantRing[] = {"P", "Z", "N",  "K",  "V",  "R",  "S",  "M",
                                          "T", "W", "F",  "D",  "L",  "CH", "B",  "SH",
                                          "G", "Y", "TH", "NG", "HH", "DH", "JH", "ZH"};
// How far the rings are turned for each text; no pair of texts shares many phones.
constexpr std::size_t kVowelTurns[kWrongTexts] = {1, 4, 7, 9, 11, 13};
constexpr std::size_t kConsonantTurns[kWrongTexts] = {1, 5, 8, 11, 17, 21};

template <std::size_t size>
const char* turned(const char* const (&ring)[size], std::string_view phone, std::size_t turn) {
  for (std::size_t i = 0; i < size; ++i) {
    if (ring[i] == phone) return ring[(i + turn) % size];
  }
  return nullptr;
}

}  // namespace

std::vector<WordModel> wrong_text(const SoundModel& model, const std::vector<WordModel>& words,
                                  std::size_t number) {
  std::vector<std::uint8_t> other(model.phones.size());
  for (std::size_t i = 0; i < other.size(); ++i) {
    const std::string& phone = model.phones[i];
    const char* name = turned(kVowelRing, phone, kVowelTurns[number]);
    if (name == nullptr) name = turned(kConsonantRing, phone, kConsonantTurns[number]);
    other[i] = std::uint8_t(i);
    for (std::size_t k = 0; name != nullptr && k < other.size(); ++k) {
      if (model.phones[k] == name) other[i] = std::uint8_t(k);
    }
  }
  std::vector<WordModel> wrong = words;
  for (WordModel& word : wrong) {
    for (auto& variant : word.variants) {
      for (std::uint8_t& phone : variant) phone = other[phone];
    }
  }
  return wrong;
}

}  // namespace animeme::voice
