#include "tools/speech/voice/phoneme_table.h"

#include <cstdint>
#include <map>

#include "dam/script/script_text_internal.h"

namespace animeme::voice {
namespace {

constexpr std::size_t kFileHead = 4, kTableHead = 36, kNameAt = 4, kEntry = 16;
constexpr std::size_t kMostDepth = 16;  // of tables on tables

enum Type : std::uint8_t { kPause = 0, kStress = 1, kVowel = 2, kVirtual = 9 };

struct TablePlace {
  std::size_t at = 0, count = 0, below = 0;
  std::string_view name;
};

std::uint8_t byte_at(std::string_view bytes, std::size_t at) { return std::uint8_t(bytes[at]); }

std::string_view until_zero(std::string_view text) { return text.substr(0, text.find('\0')); }

Result<std::vector<TablePlace>> find_tables(std::string_view bytes) {
  const auto truncated = [&] {
    return make_error(Code::truncated, "espeak-ng's phontab ends in the middle of a table");
  };
  if (bytes.size() < kFileHead) return truncated();
  std::vector<TablePlace> tables;
  std::size_t at = kFileHead;
  for (std::size_t left = byte_at(bytes, 0); left > 0; --left) {
    if (bytes.size() - at < kTableHead) return truncated();
    TablePlace table{at + kTableHead, byte_at(bytes, at), byte_at(bytes, at + 1),
                     until_zero(bytes.substr(at + kNameAt, kTableHead - kNameAt))};
    if ((bytes.size() - table.at) / kEntry < table.count) return truncated();
    at = table.at + table.count * kEntry;
    tables.push_back(table);
  }
  return tables;
}

// A voice without a table of its own has that of its language: "de-at" that of "de".
const TablePlace* find_table(const std::vector<TablePlace>& tables, std::string_view name) {
  for (;;) {
    for (const TablePlace& table : tables) {
      if (table.name == name) return &table;
    }
    const std::size_t dash = name.rfind('-');
    if (dash == name.npos) return nullptr;
    name = name.substr(0, dash);
  }
}

}  // namespace

Result<std::vector<PhonemeName>> read_phoneme_table(std::string_view bytes, std::string_view name) {
  const auto tables = find_tables(bytes);
  if (!tables) return tables.error();
  const TablePlace* table = find_table(*tables, name);
  if (table == nullptr) {
    return make_error(Code::not_found, "espeak-ng's phontab has no table \"" + std::string(name) +
                                           "\"; its data may be of another version");
  }
  std::map<std::uint8_t, std::pair<PhonemeName, std::uint8_t>> by_code;
  for (std::size_t depth = 0; table != nullptr; ++depth) {
    if (depth == kMostDepth || table->below > tables->size()) {
      return make_error(Code::syntax, "a table of espeak-ng's phontab has an invalid base table");
    }
    for (std::size_t i = 0; i < table->count; ++i) {
      const std::string_view entry = bytes.substr(table->at + i * kEntry, kEntry);
      const std::uint8_t code = byte_at(entry, 10), type = byte_at(entry, 11);
      const bool bilabial = type > kVowel && type < kVirtual && (byte_at(entry, 6) & 0xF) == 1;
      // The upper table counts.
      if (code != 0) {
        by_code.try_emplace(
            code, PhonemeName{std::string(until_zero(entry.substr(0, 4))), bilabial}, type);
      }
    }
    table = table->below == 0 ? nullptr : &(*tables)[table->below - 1];
  }
  std::vector<PhonemeName> phonemes;
  for (const auto& [code, phoneme] : by_code) {
    const std::uint8_t type = phoneme.second;
    if (type > kStress && type < kVirtual && !phoneme.first.mnemonic.empty()) {
      phonemes.push_back(phoneme.first);
    }
  }
  return phonemes;
}

std::string phoneme_table_name(std::string_view voice_file) {
  std::string language;
  dam::LineReader reader(voice_file);
  for (dam::Line line; reader.next(line);) {
    const std::string_view text = dam::trimmed(line.text);
    const std::size_t blank = text.find_first_of(" \t");
    if (blank == text.npos) continue;
    const std::string_view value = dam::trimmed(text.substr(blank));
    const std::string word(value.substr(0, value.find_first_of(" \t")));
    if (text.substr(0, blank) == "phonemes") return word;
    if (text.substr(0, blank) == "language" && language.empty()) language = word;
  }
  return language;
}

}  // namespace animeme::voice
