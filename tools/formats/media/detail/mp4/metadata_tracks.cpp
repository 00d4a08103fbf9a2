#include "tools/formats/media/detail/mp4/metadata_tracks.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/detail/tracks/track_names.h"
#include "tools/formats/media/track_labels.h"

namespace animeme::media {
namespace {

constexpr std::size_t kHandlerAt = 8;      // in the content of hdlr
constexpr std::size_t kEntriesAt = 8;      // in the content of stsd
constexpr std::size_t kElngFields = 4;     // version and flags
constexpr std::size_t kSizeOfPicture = 8;  // width and height, the last of tkhd
constexpr std::uint8_t kDecoderConfig = 4, kDecoderSpecific = 5;
constexpr std::uint8_t kVisual = 0x20;  // object type: ISO/IEC 14496-2
// Of mett: no encoding, then the type of samples as tx3g has them (RFC 4396).
constexpr std::array<std::uint8_t, 15> kTextType = {0,   'v', 'i', 'd', 'e', 'o', '/', '3',
                                                    'g', 'p', 'p', '-', 't', 't', 0};
constexpr std::size_t kDecoderFields = 13;  // of a DecoderConfigDescriptor, in front of others

Box box_in(Bytes bytes, Box box, std::initializer_list<std::string_view> path) {
  for (const std::string_view type : path) {
    if (box.begin != 0) box = find_box(bytes, box, type);
  }
  return box;
}

Box first_entry(Bytes moov, const Box& trak) {
  const Box table = box_in(moov, trak, {"mdia", "minf", "stbl", "stsd"});
  if (table.begin == 0 || table.end - table.begin < kEntriesAt) return {};
  return box_at(moov, table.begin + kEntriesAt, table.end);
}

bool has_handler(Bytes moov, const Box& trak, std::string_view wanted) {
  const Box handler = box_in(moov, trak, {"mdia", "hdlr"});
  if (handler.begin == 0 || handler.end - handler.begin < kHandlerAt + 4) return false;
  const char* at = reinterpret_cast<const char*>(moov.data()) + handler.begin + kHandlerAt;
  return std::string_view(at, 4) == wanted;
}

// The handler's name is that of the track.
bool is_named(Bytes moov, const Box& trak, std::string_view wanted) {
  constexpr std::size_t kNameAt = 24;  // in the content of hdlr
  const Box handler = box_in(moov, trak, {"mdia", "hdlr"});
  if (handler.begin == 0 || handler.end - handler.begin < kNameAt + wanted.size()) return false;
  const char* name = reinterpret_cast<const char*>(moov.data()) + handler.begin + kNameAt;
  const std::string_view rest(name, handler.end - handler.begin - kNameAt);
  return name_without_speaker(rest.substr(0, rest.find('\0'))) == wanted;
}

// A descriptor of MPEG-4 Systems; its content. Empty: another tag, or broken.
Bytes descriptor(Bytes bytes, std::uint8_t tag) {
  if (bytes.empty() || bytes[0] != tag) return {};
  std::size_t at = 1, size = 0;
  for (int i = 0; i < 4; ++i) {
    if (at >= bytes.size()) return {};
    size = size << 7 | (bytes[at] & 0x7Fu);
    if ((bytes[at++] & 0x80) == 0) break;
  }
  return size <= bytes.size() - at ? bytes.subspan(at, size) : Bytes();
}

// The configuration of a visual stream in the content of an esds, which may be empty; nullopt: the
// stream is another one.
std::optional<Bytes> visual_config(Bytes esds) {
  if (esds.size() < 4) return std::nullopt;
  const Bytes stream = descriptor(esds.subspan(4), kEsDescriptor);
  if (stream.size() < 3) return std::nullopt;
  const unsigned flags = stream[2];
  std::size_t at = 3 + ((flags & 0x80) != 0 ? 2 : 0);                        // depends on another
  if ((flags & 0x40) != 0) at += at < stream.size() ? 1u + stream[at] : 1u;  // has an address
  at += (flags & 0x20) != 0 ? 2 : 0;                                         // has a clock
  if (at > stream.size()) return std::nullopt;
  const Bytes decoder = descriptor(stream.subspan(at), kDecoderConfig);
  if (decoder.size() < kDecoderFields || decoder[0] != kVisual) return std::nullopt;
  return descriptor(decoder.subspan(kDecoderFields), kDecoderSpecific);
}

// The configuration of what is a face or may be one, since it has none.
std::optional<Bytes> face_config(Bytes moov, const Box& entry, std::size_t fields) {
  if (entry.begin == 0 || entry.end - entry.begin < fields) return std::nullopt;
  const Box esds = find_box(moov, {entry.type, entry.begin + fields, entry.end}, "esds");
  if (esds.begin == 0) return std::nullopt;
  std::optional<Bytes> config = visual_config(moov.subspan(esds.begin, esds.end - esds.begin));
  const bool other = config && read_visual_headers(*config).kind == VisualKind::other;
  return other ? std::nullopt : config;
}

Bytes content_of(Bytes moov, const Box& box) {
  return moov.subspan(box.begin, box.end - box.begin);
}

void put_entries(BoxWriter& out, Bytes moov, const Box& table) {
  const Box entry = box_at(moov, table.begin + kEntriesAt, table.end);
  out.begin("stsd");
  out.raw(moov.subspan(table.begin, kEntriesAt));
  const bool face = entry.type == "mp4v";
  out.begin(face ? "mp4s" : "mett");
  out.raw(moov.subspan(entry.begin, kPlainFields));
  if (face) {
    out.raw(moov.subspan(entry.begin + kVisualFields, entry.end - entry.begin - kVisualFields));
  } else {
    out.raw(kTextType);
  }
  out.end();
  out.raw(moov.subspan(entry.end, table.end - entry.end));
  out.end();
}

void put_boxes(BoxWriter& out, Bytes moov, const Box& parent) {
  constexpr std::array<std::string_view, 3> kParents = {"mdia", "minf", "stbl"};
  for_each_box(moov, parent.begin, parent.end, [&](const Box& box) {
    if (box.type == "stsd") return put_entries(out, moov, box);
    if (box.type == "vmhd" || box.type == "sthd") {
      out.begin_full("nmhd", 0, 0);
      return out.end();
    }
    out.begin(box.type);
    if (std::find(kParents.begin(), kParents.end(), box.type) != kParents.end()) {
      put_boxes(out, moov, box);
    } else if (box.type == "hdlr") {
      out.raw(content_of(moov, box).first(kHandlerAt));
      out.text("meta");
      out.raw(content_of(moov, box).subspan(kHandlerAt + 4));
    } else if (box.type == "tkhd" && box.end - box.begin > kSizeOfPicture) {
      out.raw(moov.subspan(box.begin, box.end - box.begin - kSizeOfPicture));
      out.zeros(kSizeOfPicture);
    } else {
      out.raw(content_of(moov, box));
    }
    out.end();
  });
}

// The content of `elng` of a track; empty: it has none, or one that is no tag.
std::string extended_language(Bytes moov, const Box& trak) {
  const Box box = box_in(moov, trak, {"mdia", "elng"});
  if (box.begin == 0 || box.end - box.begin < kElngFields) return {};
  const char* at = reinterpret_cast<const char*>(moov.data()) + box.begin + kElngFields;
  const std::string_view rest(at, box.end - box.begin - kElngFields);
  const std::string tag(rest.substr(0, rest.find('\0')));
  return is_language_tag(tag) ? tag : std::string();
}

// The boxes of a track, with what its mark says.
void put_marked(BoxWriter& out, Bytes moov, const Box& parent, const TrackMark& mark) {
  for_each_box(moov, parent.begin, parent.end, [&](const Box& box) {
    if (box.type == "elng") return;
    out.begin(box.type);
    // The alternate group lies 12 bytes in front of the matrix and the picture.
    constexpr std::size_t kGroupToEnd = 2 + 2 + 2 + 36 + 8;
    if (box.type == "mdia") {
      put_marked(out, moov, box, mark);
    } else if (box.type == "tkhd" && mark.group != 0 && box.end - box.begin > kGroupToEnd) {
      out.raw(moov.subspan(box.begin, box.end - box.begin - kGroupToEnd));
      out.u16(mark.group);
      out.raw(moov.subspan(box.end - kGroupToEnd + 2, kGroupToEnd - 2));
    } else {
      out.raw(content_of(moov, box));
    }
    out.end();
    if (box.type == "mdhd" && !mark.tag.empty()) {
      out.begin_full("elng", 0, 0);
      out.text(mark.tag);
      out.u8(0);
      out.end();
    }
  });
}

}  // namespace

bool becomes_metadata(Bytes moov, const Box& trak, const TrackTypes& types) {
  const Box entry = first_entry(moov, trak);
  if (entry.begin == 0) return false;
  if (types.text == TextTrackType::metadata && entry.type == "tx3g") {
    return has_handler(moov, trak, "sbtl") && entry.end - entry.begin >= kPlainFields &&
           !is_named(moov, trak, kCaptionTrack);
  }
  return types.face == FaceTrackType::metadata && entry.type == "mp4v" &&
         has_handler(moov, trak, "vide") &&
         !face_config(moov, entry, kVisualFields).value_or(Bytes()).empty();
}

void put_metadata(BoxWriter& out, Bytes moov, const Box& trak) {
  out.begin("trak");
  put_boxes(out, moov, trak);
  out.end();
}

std::vector<MetadataTrack> metadata_tracks(Bytes moov) {
  std::vector<MetadataTrack> tracks;
  const Box whole = box_at(moov, 0, moov.size());
  if (whole.begin == 0 || whole.type != "moov") return tracks;
  for_each_box(moov, whole.begin, whole.end, [&](const Box& trak) {
    if (trak.type != "trak") return;
    const Box entry = first_entry(moov, trak);
    if (entry.begin == 0) return;
    if (entry.type == "mp4s") {
      const std::optional<Bytes> config = face_config(moov, entry, kPlainFields);
      if (config) tracks.push_back({track_id(moov, trak), true, {config->begin(), config->end()}});
    } else if (entry.type == "mett" && has_handler(moov, trak, "meta") &&
               entry.end - entry.begin >= kPlainFields + kTextType.size()) {
      const Bytes type = content_of(moov, entry).subspan(kPlainFields, kTextType.size());
      const bool text = std::equal(type.begin(), type.end(), kTextType.begin());
      if (text) tracks.push_back({track_id(moov, trak), false, {}});
    }
  });
  return tracks;
}

std::map<std::uint32_t, std::string> extended_languages(Bytes moov) {
  std::map<std::uint32_t, std::string> tags;
  const Box whole = box_at(moov, 0, moov.size());
  if (whole.begin == 0 || whole.type != "moov") return tags;
  for_each_box(moov, whole.begin, whole.end, [&](const Box& trak) {
    if (trak.type != "trak") return;
    std::string tag = extended_language(moov, trak);
    if (!tag.empty()) tags[track_id(moov, trak)] = std::move(tag);
  });
  return tags;
}

std::vector<std::uint8_t> marked_moov(Bytes moov, const std::vector<TrackMark>& marks) {
  const Box whole = box_at(moov, 0, moov.size());
  std::size_t next = 0;
  BoxWriter out;
  out.begin("moov");
  for_each_box(moov, whole.begin, whole.end, [&](const Box& box) {
    out.begin(box.type);
    if (box.type == "trak" && next < marks.size()) {
      put_marked(out, moov, box, marks[next++]);
    } else {
      out.raw(content_of(moov, box));
    }
    out.end();
  });
  out.end();
  return out.bytes();
}

}  // namespace animeme::media
