#include "tools/formats/media/detail/tracks/track_names.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tools/formats/media/detail/ffmpeg/output_stream.h"
#include "tools/formats/media/language_codes.h"
#include "tools/formats/media/text_track.h"

namespace animeme::media {
namespace {

// In front of the language of phones.
constexpr std::string_view kNoLanguage = "zxx-x-";

// Elements of Matroska (RFC 9559).
constexpr std::uint32_t kMkvSegment = 0x18538067, kMkvTracks = 0x1654AE6B, kMkvTrackEntry = 0xAE;
constexpr std::uint32_t kMkvName = 0x536E, kMkvLanguageTag = 0x22B59D, kMkvChecksum = 0xBF;
constexpr std::size_t kMkvBeginning = 1 << 16;  // bytes in which the tracks are

// A title is followed by this and the tag; no name has it.
constexpr char kTagMark = '\x01';

struct MkvElement {
  std::uint32_t id = 0;
  std::size_t at = 0, begin = 0, end = 0;  // of the header and the content; end 0: there is none
};

// The element at `at`. Sizes that are not known reach to `end`.
MkvElement element_at(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t end) {
  const auto length_at = [&](std::size_t place, std::size_t most) -> std::size_t {
    if (place >= end || bytes[place] == 0) return 0;
    std::size_t length = 1;
    while (((bytes[place] << (length - 1)) & 0x80) == 0) ++length;
    return length <= most && length <= end - place ? length : 0;
  };
  const std::size_t id_length = length_at(at, 4);
  if (id_length == 0) return {};
  MkvElement element;
  element.at = at;
  for (std::size_t i = 0; i < id_length; ++i) element.id = element.id << 8 | bytes[at + i];
  const std::size_t size_length = length_at(at + id_length, 8);
  if (size_length == 0) return {};
  std::uint64_t size = bytes[at + id_length] & (0xFFu >> size_length);
  bool unknown = size == (0xFFu >> size_length);
  for (std::size_t i = 1; i < size_length; ++i) {
    const std::uint8_t byte = bytes[at + id_length + i];
    size = size << 8 | byte;
    unknown = unknown && byte == 0xFF;
  }
  element.begin = at + id_length + size_length;
  if (unknown || size > end - element.begin) {
    element.end = element.id == kMkvSegment || unknown ? end : 0;
    return element;
  }
  element.end = element.begin + std::size_t(size);
  return element;
}

template <class Visit>
void each_element(std::span<const std::uint8_t> bytes, std::size_t begin, std::size_t end,
                  const Visit& visit) {
  for (std::size_t at = begin; at < end;) {
    const MkvElement element = element_at(bytes, at, end);
    if (element.end <= at) return;
    visit(element);
    at = element.end;
  }
}

// The element of all tracks in the beginning of a file.
std::optional<MkvElement> find_tracks(std::span<const std::uint8_t> bytes) {
  std::optional<MkvElement> tracks;
  each_element(bytes, 0, bytes.size(), [&](const MkvElement& top) {
    if (top.id != kMkvSegment) return;
    each_element(bytes, top.begin, top.end, [&](const MkvElement& part) {
      if (part.id == kMkvTracks && !tracks) tracks = part;
    });
  });
  return tracks;
}

std::string mkv_text(std::span<const std::uint8_t> bytes, const MkvElement& element) {
  return {reinterpret_cast<const char*>(bytes.data()) + element.begin, element.end - element.begin};
}

std::uint32_t checksum_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

// Name with a mark and a tag becomes a shorter Name, and a LanguageBCP47. False: it is another.
bool split_title(std::span<std::uint8_t> bytes, const MkvElement& name) {
  const std::string text = mkv_text(bytes, name);
  const std::size_t mark = text.find(kTagMark);
  if (mark == std::string::npos) return false;
  const std::string title = text.substr(0, mark);
  const std::string tag = text.substr(text.rfind(kTagMark) + 1);
  std::vector<std::uint8_t> made;
  const auto put = [&](std::uint32_t id, const std::string& value) {
    for (int shift = 24; shift >= 0; shift -= 8)
      if (id >> shift != 0) made.push_back(std::uint8_t(id >> shift));
    made.push_back(std::uint8_t(0x80 | value.size()));
    made.insert(made.end(), value.begin(), value.end());
  };
  if (!title.empty()) put(kMkvName, title);
  put(kMkvLanguageTag, tag);
  if (made.size() != name.end - name.at) return false;
  std::copy(made.begin(), made.end(), bytes.begin() + std::ptrdiff_t(name.at));
  return true;
}

void renew_checksum(std::span<std::uint8_t> bytes, const MkvElement& tracks) {
  const MkvElement first = element_at(bytes, tracks.begin, tracks.end);
  if (first.id != kMkvChecksum || first.end - first.begin != 4) return;
  const std::uint32_t crc = checksum_of(bytes.subspan(first.end, tracks.end - first.end));
  for (std::size_t i = 0; i < 4; ++i) bytes[first.begin + i] = std::uint8_t(crc >> (8 * i));
}

// Of a name of ours in front of a speaker; of any other its whole length.
std::size_t length_of_base(std::string_view name) {
  constexpr std::array<std::string_view, 5> kOurs = {"FBA", "sound", "words", "phones", "captions"};
  if (!name.ends_with(')')) return name.size();
  for (const std::string_view base : kOurs) {
    if (name.starts_with(base) && name.substr(base.size()).starts_with(" (")) return base.size();
  }
  return name.size();
}

std::string stream_tag(const AVStream& stream, const char* key) {
  const AVDictionaryEntry* entry = av_dict_get(stream.metadata, key, nullptr, 0);
  return entry == nullptr ? std::string() : clean_text(entry->value, 100);
}

}  // namespace

std::string name_with_speaker(std::string_view name, std::string_view speaker) {
  if (speaker.empty()) return std::string(name);
  return std::string(name) + " (" + std::string(speaker) + ")";
}

std::string speaker_in_name(std::string_view name) {
  const std::size_t base = length_of_base(name);
  return base == name.size() ? std::string()
                             : std::string(name.substr(base + 2, name.size() - base - 3));
}

std::string name_without_speaker(std::string_view name) {
  return std::string(name.substr(0, length_of_base(name)));
}

std::string tag_of_text(std::string_view code, const std::string& tag) {
  return code == "zxx" && !tag.empty() ? std::string(kNoLanguage) + tag : tag;
}

Error no_wanted_track() {
  const TrackLabels& wanted = wanted_track();
  std::string what = wanted.language.empty() ? "" : " in the language " + wanted.language;
  if (!wanted.speaker.empty()) what += " of " + wanted.speaker;
  return make_error(Code::not_found,
                    "the file has no track" + what + "; animeme info lists its tracks");
}

TrackLabels labels_of_text(const std::string& name, const std::string& tag) {
  const std::string told = speaker_in_name(name);
  if (told.empty() || !is_language_tag(tag)) return {};
  TrackLabels labels;
  labels.language = tag.starts_with(kNoLanguage) ? tag.substr(kNoLanguage.size()) : tag;
  if (told != tag) labels.speaker = told.substr(0, told.rfind(", "));
  return labels;
}

std::string title_with_tag(const std::string& title, const std::string& tag) {
  // Sizes of one byte; longer names have no tag.
  constexpr std::size_t kLongest = 120;
  if (tag.empty() || title.size() + tag.size() + 4 > kLongest) return title;
  // A Name takes 3 bytes more than its text, a LanguageBCP47 4. Without a title the Name goes.
  const std::size_t marks = title.empty() ? 1 : 4;
  return title + std::string(marks, kTagMark) + tag;
}

Result<void> put_language_tags(const std::string& path) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "r+b"), close);
  if (!file) return write_error(AVERROR(EIO));
  std::vector<std::uint8_t> bytes(kMkvBeginning);
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  const auto tracks = find_tracks(bytes);
  if (!tracks) return {};
  bool changed = false;
  each_element(bytes, tracks->begin, tracks->end, [&](const MkvElement& track) {
    if (track.id != kMkvTrackEntry) return;
    each_element(bytes, track.begin, track.end, [&](const MkvElement& element) {
      if (element.id == kMkvName && split_title(bytes, element)) changed = true;
    });
  });
  if (!changed) return {};
  renew_checksum(bytes, *tracks);
  const bool written = std::fseek(file.get(), 0, SEEK_SET) == 0 &&
                       std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size() &&
                       std::fflush(file.get()) == 0;
  return written ? Result<void>() : write_error(AVERROR(EIO));
}

std::vector<std::string> language_tags(std::span<const std::uint8_t> beginning) {
  std::vector<std::string> tags;
  const auto tracks = find_tracks(beginning);
  if (!tracks) return tags;
  each_element(beginning, tracks->begin, tracks->end, [&](const MkvElement& track) {
    if (track.id != kMkvTrackEntry) return;
    std::string tag;
    each_element(beginning, track.begin, track.end, [&](const MkvElement& element) {
      if (element.id == kMkvLanguageTag) tag = mkv_text(beginning, element);
    });
    tags.push_back(is_language_tag(tag) ? tag : std::string());
  });
  return tags;
}

TrackLabels labels_of(const AVStream& stream, const std::string& tag) {
  TrackLabels labels;
  const std::string language = stream_tag(stream, "language");
  labels.language = tag.starts_with(kNoLanguage) ? tag.substr(kNoLanguage.size()) : tag;
  if (!language.empty() && language != "und") {
    if (language.size() == 3) {
      labels.code = terminological_code(language);
    } else if (labels.language.empty() && is_language_tag(language)) {
      labels.language = language;
    }
  }
  const std::string title = stream_tag(stream, "title");
  labels.speaker = speaker_in_name(title.empty() ? stream_tag(stream, "handler_name") : title);
  return labels;
}

}  // namespace animeme::media
