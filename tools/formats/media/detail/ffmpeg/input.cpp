#include "tools/formats/media/detail/ffmpeg/input.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <system_error>

#include "fap/result.h"
#include "tools/formats/media/detail/ffmpeg/extension.h"
#include "tools/formats/media/detail/mp4/boxes.h"
#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/detail/tracks/track_names.h"

namespace animeme::media {

namespace {

// Reads `buffer.size()` bytes at an offset; false: not there.
using ReadAt = std::function<bool(std::uint64_t offset, std::span<std::uint8_t> buffer)>;

constexpr int kMostTopBoxes = 4096;
constexpr std::uint64_t kLargestMoov = std::uint64_t(64) << 20;

struct TopBoxes {
  std::uint64_t moov = 0;
  std::uint64_t moov_size = 0;  // 0: there is none
  bool fragmented = false;
};

TopBoxes find_top_boxes(std::uint64_t size, const ReadAt& read) {
  TopBoxes top;
  std::uint64_t at = 0;
  for (int i = 0; i < kMostTopBoxes && size - at >= 8; ++i) {
    std::array<std::uint8_t, 16> header{};
    const std::size_t want = size - at >= 16 ? 16 : 8;
    if (!read(at, std::span(header).first(want))) break;
    const std::string_view type(reinterpret_cast<const char*>(header.data()) + 4, 4);
    std::uint64_t box_size = read_big_endian(header, 0, 4);
    if (box_size == 1) box_size = read_big_endian(header, 8, 8);
    if (box_size == 0 || box_size > size - at) box_size = size - at;
    if (type == "moof") top.fragmented = true;
    if (type == "moov" && top.moov_size == 0) {
      top.moov = at;
      top.moov_size = box_size;
    }
    if (box_size < 8 || (top.fragmented && top.moov_size != 0)) break;
    at += box_size;
  }
  return top;
}

/// What libavformat does not tell of an mp4.
struct Mp4Facts {
  std::vector<MetadataTrack> metadata;
  std::map<std::uint32_t, std::string> tags;
};

Mp4Facts facts_of(const std::vector<std::uint8_t>& moov) {
  return {metadata_tracks(moov), extended_languages(moov)};
}

// Refuses a fragmented mp4 with a track that has no track header or no number: libavformat 5.1
// then keeps an error code as a fragment number and counts up from it, a thousand million steps
// for each run of samples. Other files pass, whatever they are. Gives the tracks of timed
// metadata that libavformat does not look into. Error: syntax.
Result<Mp4Facts> look_at_mp4(std::uint64_t size, const ReadAt& read) {
  const TopBoxes top = find_top_boxes(size, read);
  if (top.moov_size == 0) return Mp4Facts();
  const Error damaged = make_error(Code::syntax, "the contents of this fragmented mp4 are damaged");
  std::vector<std::uint8_t> moov;
  if (top.moov_size <= kLargestMoov) moov.resize(static_cast<std::size_t>(top.moov_size));
  const bool whole = !moov.empty() && read(top.moov, moov);
  if (!top.fragmented) return whole ? facts_of(moov) : Mp4Facts();
  const Box box = whole ? box_at(moov, 0, moov.size()) : Box();
  if (box.begin == 0) return damaged;
  bool good = true;
  const std::size_t end = for_each_box(moov, box.begin, box.end, [&](const Box& inner) {
    if (inner.type == "trak") good = good && track_id(moov, inner) - 1 < 0x7FFFFFFF;
  });
  if (!good || end != box.end) return damaged;
  return facts_of(moov);
}

// Reading a file more often than this is not needed for anything but a hostile index.
constexpr std::int64_t kRereads = 16;
constexpr std::int64_t kSpareBudget = std::int64_t(64) << 20;

int refuse_open(AVFormatContext*, AVIOContext**, const char*, int, AVDictionary**) {
  return AVERROR(EPERM);
}

// Only the extension: a name must not choose a protocol or a file pattern.
std::string name_hint(const std::string& path) {
  const std::string extension = extension_of(path);
  const bool plain = extension.size() >= 2 && extension.size() <= 6 &&
                     std::all_of(extension.begin() + 1, extension.end(),
                                 [](unsigned char c) { return std::isalnum(c) != 0; });
  return plain ? "input" + extension : "input";
}

Error file_error(const std::string& path, int number) {
  const Code code = number == ENOENT || number == ENOTDIR ? Code::not_found : Code::io;
  return make_error(code, std::string("cannot be opened: ") + std::strerror(number)).in_file(path);
}

}  // namespace

Result<std::unique_ptr<Input>> Input::open(const std::string& path, const char* formats) {
  std::error_code status;
  if (std::filesystem::is_directory(path, status)) return file_error(path, EISDIR);
  std::unique_ptr<Input> input(new Input);
  input->file_ = std::fopen(path.c_str(), "rb");
  if (input->file_ == nullptr) return file_error(path, errno);
  if (std::fseek(input->file_, 0, SEEK_END) == 0) {
    input->size_ = std::ftell(input->file_);
    std::rewind(input->file_);
  }
  if (input->size_ == 0) {
    return make_error(Code::truncated, "the file is empty").in_file(path);
  }
  Result<void> started = input->start(name_hint(path), formats);
  if (!started) return std::move(started.error()).in_file(path);
  return input;
}

Result<std::unique_ptr<Input>> Input::open(std::span<const std::uint8_t> memory,
                                           const char* formats) {
  if (memory.empty()) return make_error(Code::truncated, "the input is empty");
  std::unique_ptr<Input> input(new Input);
  input->memory_ = memory;
  input->size_ = std::int64_t(memory.size());
  Result<void> started = input->start("input", formats);
  if (!started) return started.error();
  return input;
}

Result<void> Input::start(const std::string& hint, const char* formats) {
  budget_ = size_ < 0 ? INT64_MAX : std::min(size_, INT64_MAX / 32) * kRereads + kSpareBudget;
  context_ = avformat_alloc_context();
  io_ = av::make_io(this, &Input::read, nullptr, size_ < 0 ? nullptr : &Input::seek);
  if (!io_ || context_ == nullptr) return av::no_memory();
  if (holds_raw_stream()) {
    return make_error(Code::unsupported,
                      "a raw FBA stream, not a container; decode or mux it as it is");
  }
  if (auto looked = look_at_boxes(); !looked) return looked;
  context_->pb = io_.get();
  context_->io_open = refuse_open;
  av::Options options;
  options.set("protocol_whitelist", std::string("none"));  // for demuxers that open others
  if (formats != nullptr) options.set("format_whitelist", std::string(formats));
  const AVInputFormat* known = holds_transport_stream() ? av_find_input_format("mpegts") : nullptr;
  const int status = avformat_open_input(&context_, hint.c_str(), known, options.get());
  if (status >= 0) {
    reveal_metadata();
    return show_wanted();
  }
  if (formats != nullptr && status == AVERROR(EINVAL)) {
    return make_error(Code::unsupported,
                      "this format cannot carry a face; give an mp4, mkv, ts or nut file");
  }
  return av::make_av_error(status, "not a media file that can be read, or damaged");
}

// The first bytes mean other things to libavformat, so look before it does.
bool Input::holds_raw_stream() {
  if (size_ < 0) return false;
  std::array<std::uint8_t, 64> head{};
  const int count = read_some(head.data(), int(head.size()));
  seek_to(0, SEEK_SET);
  return count > 0 && looks_like_raw_stream(std::span(head).first(std::size_t(count)));
}

Result<void> Input::look_at_boxes() {
  if (size_ < 0) return {};
  Result<Mp4Facts> facts = look_at_mp4(
      std::uint64_t(size_), [this](std::uint64_t offset, std::span<std::uint8_t> buffer) {
        return seek_to(std::int64_t(offset), SEEK_SET) >= 0 &&
               read_some(buffer.data(), int(buffer.size())) == int(buffer.size());
      });
  seek_to(0, SEEK_SET);
  if (!facts) return facts.error();
  metadata_ = std::move(facts->metadata);
  for (auto& [track, tag] : facts->tags) tags_[track] = std::move(tag);
  if (facts->metadata.empty() && tags_.empty()) read_language_tags();
  return {};
}

// libavformat calls these tracks data without a codec, and reads no configuration.
void Input::reveal_metadata() {
  for (unsigned i = 0; i < context_->nb_streams; ++i) {
    const AVStream& stream = *context_->streams[i];
    AVCodecParameters& parameters = *stream.codecpar;
    if (parameters.codec_type != AVMEDIA_TYPE_DATA || parameters.codec_id != AV_CODEC_ID_NONE) {
      continue;
    }
    // A pipe has no header to look at; the first packet decides.
    if (size_ < 0 && parameters.codec_tag == MKTAG('m', 'p', '4', 's')) {
      parameters.codec_id = AV_CODEC_ID_BIN_DATA;
    }
    for (const MetadataTrack& track : metadata_) {
      if (std::int64_t(track.id) != stream.id) continue;
      if (!track.config.empty() && !av::set_extradata(parameters, track.config)) continue;
      parameters.codec_type = track.face ? AVMEDIA_TYPE_VIDEO : AVMEDIA_TYPE_SUBTITLE;
      parameters.codec_id = track.face ? AV_CODEC_ID_MPEG4 : AV_CODEC_ID_MOV_TEXT;
    }
  }
}

// Several faces, whose planes have start codes, look to libavformat like a program stream.
bool Input::holds_transport_stream() {
  constexpr std::size_t kPackets = 5, kPacketSize = 188;
  if (size_ < std::int64_t(kPackets * kPacketSize)) return false;
  std::array<std::uint8_t, kPackets * kPacketSize> head{};
  const int count = read_some(head.data(), int(head.size()));
  seek_to(0, SEEK_SET);
  if (count < int(head.size())) return false;
  for (std::size_t at = 0; at < head.size(); at += kPacketSize)
    if (head[at] != 0x47) return false;
  return true;
}

// Of Matroska, whose tracks lie in front of the data.
void Input::read_language_tags() {
  constexpr std::int64_t kLooked = 1 << 16;
  std::vector<std::uint8_t> bytes(std::size_t(std::min(size_, kLooked)));
  const int count = read_some(bytes.data(), int(bytes.size()));
  seek_to(0, SEEK_SET);
  constexpr std::array<std::uint8_t, 4> kEbml = {0x1A, 0x45, 0xDF, 0xA3};
  if (count < 64 || !std::equal(kEbml.begin(), kEbml.end(), bytes.begin())) return;
  listed_tags_ = language_tags(std::span(bytes).first(std::size_t(count)));
}

TrackLabels Input::labels(const AVStream& stream) const {
  const auto index = std::size_t(stream.index);
  if (index < listed_tags_.size()) return labels_of(stream, listed_tags_[index]);
  const auto tag = tags_.find(stream.id);
  return labels_of(stream, tag == tags_.end() ? std::string() : tag->second);
}

// Each kind of track for itself, so that a sound without labels goes with any face.
Result<void> Input::show_wanted() {
  const TrackLabels& wanted = wanted_track();
  if (wanted.empty()) return {};
  bool found = false, labelled = false;
  for (const AVMediaType kind : {AVMEDIA_TYPE_VIDEO, AVMEDIA_TYPE_AUDIO, AVMEDIA_TYPE_SUBTITLE}) {
    const auto is_of_kind = [&](const AVStream& stream) {
      const AVCodecParameters& parameters = *stream.codecpar;
      return parameters.codec_type == kind &&
             (kind != AVMEDIA_TYPE_VIDEO || parameters.codec_id == AV_CODEC_ID_MPEG4);
    };
    bool languages = false, speakers = false;
    for (unsigned i = 0; i < context_->nb_streams; ++i) {
      if (!is_of_kind(*context_->streams[i])) continue;
      const TrackLabels here = labels(*context_->streams[i]);
      languages = languages || !here.language.empty() || !here.code.empty();
      speakers = speakers || !here.speaker.empty();
    }
    labelled = labelled || languages || speakers;
    TrackLabels told = wanted;
    if (!languages) told.language.clear();
    if (!speakers) told.speaker.clear();
    for (unsigned i = 0; i < context_->nb_streams; ++i) {
      AVStream& stream = *context_->streams[i];
      if (!is_of_kind(stream)) continue;
      if (is_wanted(told, labels(stream))) {
        found = found || languages || speakers;
        continue;
      }
      stream.codecpar->codec_type = AVMEDIA_TYPE_UNKNOWN;
      stream.codecpar->codec_id = AV_CODEC_ID_NONE;
      stream.discard = AVDISCARD_ALL;
    }
  }
  if (found || !labelled) return {};
  return no_wanted_track();
}

Input::~Input() {
  avformat_close_input(&context_);
  if (file_ != nullptr) std::fclose(file_);
}

int Input::read(void* self, std::uint8_t* buffer, int size) {
  return static_cast<Input*>(self)->read_some(buffer, size);
}

int Input::read_some(std::uint8_t* buffer, int size) {
  if (size <= 0) return AVERROR(EINVAL);
  if (budget_ <= 0) {
    exhausted_ = true;
    return AVERROR_EOF;
  }
  std::size_t count = 0;
  if (file_ != nullptr) {
    count = std::fread(buffer, 1, std::size_t(size), file_);
    if (count == 0 && std::ferror(file_) != 0) return AVERROR(EIO);
  } else if (position_ < size_) {
    count = std::size_t(std::min<std::int64_t>(size, size_ - position_));
    std::memcpy(buffer, memory_.data() + position_, count);
    position_ += std::int64_t(count);
  }
  if (count == 0) return AVERROR_EOF;
  budget_ -= std::int64_t(count);
  return int(count);
}

std::int64_t Input::seek(void* self, std::int64_t offset, int whence) {
  return static_cast<Input*>(self)->seek_to(offset, whence & ~AVSEEK_FORCE);
}

std::int64_t Input::seek_to(std::int64_t offset, int whence) {
  if (whence == AVSEEK_SIZE) return size_;
  if (file_ != nullptr) {
    if (std::fseek(file_, long(offset), whence) != 0) return AVERROR(errno);
    return std::ftell(file_);
  }
  const std::int64_t base = whence == SEEK_CUR ? position_ : whence == SEEK_END ? size_ : 0;
  if (offset < -base || offset > INT64_MAX - base) return AVERROR(EINVAL);
  return position_ = base + offset;
}

std::string Input::format() const {
  const std::string names = context_->iformat->name;
  if (is_mp4_family()) {
    const AVDictionaryEntry* brand = av_dict_get(context_->metadata, "major_brand", nullptr, 0);
    return brand != nullptr && std::string(brand->value) == "qt  " ? "mov" : "mp4";
  }
  return names.substr(0, names.find(','));
}

bool Input::is_mp4_family() const {
  return std::string(context_->iformat->name).find("mp4") != std::string::npos;
}

}  // namespace animeme::media
