#include "tools/formats/media/detail/tracks/recording_writer.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "tools/formats/media/detail/ffmpeg/invalid.h"
#include "tools/formats/media/detail/ffmpeg/output_stream.h"
#include "tools/formats/media/detail/mp4/boxes.h"
#include "tools/formats/media/detail/mp4/mp4_fix.h"
#include "tools/formats/media/detail/sound/sound_recoder.h"
#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/detail/tracks/mux_parts.h"
#include "tools/formats/media/detail/tracks/muxer.h"
#include "tools/formats/media/detail/tracks/unit_facts.h"
#include "tools/formats/media/detail/ts/ts_pmt.h"
#include "tools/formats/media/detail/ts/ts_sections.h"

namespace animeme::media {

namespace {

class GrowingMp4 {
 public:
  GrowingMp4() = default;
  ~GrowingMp4();
  GrowingMp4(const GrowingMp4&) = delete;
  GrowingMp4& operator=(const GrowingMp4&) = delete;

  // The file, which is there. Error: io.
  Result<void> open(const std::string& path);
  // What libavformat writes: `ftyp`, `moov`, then fragments. Kept until write().
  void take(std::span<const std::uint8_t> bytes);
  // Everything that was taken, which ends with a whole box, to the file; `ticks` of the movie is
  // its length by then. Error: io.
  Result<void> write(std::uint64_t ticks);

 private:
  std::vector<std::uint8_t> complete_head(std::span<const std::uint8_t> bytes);
  bool put(std::uint64_t at, std::span<const std::uint8_t> bytes) const;

  int file_ = -1;
  std::vector<std::uint8_t> taken_;
  std::uint64_t end_ = 0;                   // of what is in the file
  std::optional<std::uint64_t> length_at_;  // in the file; known: the head is written
};

constexpr std::size_t kTypeAt = 4;         // in a box
constexpr std::size_t kFullBoxHeader = 4;  // version and flags, in front of the length in mehd
constexpr std::array<std::uint8_t, 4> kFree = {'f', 'r', 'e', 'e'};
constexpr std::array<std::uint8_t, 4> kFragment = {'m', 'o', 'o', 'f'};

GrowingMp4::~GrowingMp4() {
  if (file_ >= 0) ::close(file_);
}

Result<void> GrowingMp4::open(const std::string& path) {
  file_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  return file_ >= 0 ? Result<void>() : write_error(AVERROR(errno));
}

void GrowingMp4::take(std::span<const std::uint8_t> bytes) {
  taken_.insert(taken_.end(), bytes.begin(), bytes.end());
}

bool GrowingMp4::put(std::uint64_t at, std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(file_, bytes.data(), bytes.size(), off_t(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += std::uint64_t(count);
    bytes = bytes.subspan(std::size_t(count));
  }
  return true;
}

/// `bytes` with contents that have a length; where that stands is noted. Unchanged: there are no
/// contents yet.
std::vector<std::uint8_t> GrowingMp4::complete_head(Bytes bytes) {
  const Box moov = find_box(bytes, {"", 0, bytes.size()}, "moov");
  std::vector<std::uint8_t> out(bytes.begin(), bytes.end());
  if (moov.begin == 0) return out;
  const std::size_t begin = moov.begin - 8;
  const auto contents = complete_moov(bytes.subspan(begin, moov.end - begin), TrackTypes(), 0);
  out.resize(begin);
  out.insert(out.end(), contents.begin(), contents.end());
  const Box whole = find_box(out, {"", begin, out.size()}, "moov");
  const Box extends = find_box(out, whole, "mvex");
  const Box length = find_box(out, extends, "mehd");
  if (length.begin != 0) length_at_ = end_ + length.begin + kFullBoxHeader;
  out.insert(out.end(), bytes.begin() + std::ptrdiff_t(moov.end), bytes.end());
  return out;
}

Result<void> GrowingMp4::write(std::uint64_t ticks) {
  std::vector<std::uint8_t> bytes = length_at_ ? taken_ : complete_head(taken_);
  taken_.clear();
  // Readers refuse a file that ends within a moof. Whoever kills the program while it writes leaves
  // free space there.
  std::vector<std::size_t> fragments;
  for_each_box(bytes, 0, bytes.size(), [&](const Box& box) {
    if (box.type == "moof") fragments.push_back(box.begin - 8 + kTypeAt);
  });
  for (const std::size_t at : fragments) {
    std::copy(kFree.begin(), kFree.end(), bytes.begin() + std::ptrdiff_t(at));
  }
  bool good = put(end_, bytes);
  for (const std::size_t at : fragments) good = good && put(end_ + at, kFragment);
  end_ += bytes.size();
  if (length_at_) {
    std::array<std::uint8_t, 8> length{};
    write_big_endian(length, 0, 8, ticks);
    good = good && put(*length_at_, length);
  }
  return good ? Result<void>() : write_error(AVERROR(errno));
}

constexpr double kUsualRate = 25;  // planes a second, which the contents want to know first

Result<void> check_recorded(const LiveUnit& unit) {
  if (unit.bytes.empty() || unit.bytes.size() > kLargestUnit) {
    return invalid("a unit is empty or larger than 16 MB");
  }
  if (unit.time > kLongestTime || unit.duration <= 0 || unit.duration > kLongestTime) {
    return invalid("a unit is years away from the first one");
  }
  return {};
}

/// Access units one after the other.
class StreamRecording : public RecordingWriter {
 public:
  ~StreamRecording() override {
    if (file_ != nullptr) std::fclose(file_);
  }
  Result<void> open(const std::string& path) {
    file_ = std::fopen(path.c_str(), "wb");
    return file_ != nullptr ? Result<void>() : write_error(AVERROR(errno));
  }
  Result<void> write(const LiveUnit& unit) override {
    if (unit.track != LiveTrack::face) return {};
    return put(unit.bytes);
  }
  Result<void> flush() override {
    return std::fflush(file_) == 0 ? Result<void>() : write_error(AVERROR(errno));
  }
  Result<void> finish() override {
    static constexpr std::uint8_t kObjectEnd[] = {0, 0, 1, 0xB1};
    if (auto ended = put(kObjectEnd); !ended) return ended;
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    return closed ? Result<void>() : write_error(AVERROR(errno));
  }
  void moved(const std::string&) override {}

 private:
  Result<void> put(std::span<const std::uint8_t> bytes) {
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size();
    return written ? Result<void>() : write_error(AVERROR(errno));
  }

  std::FILE* file_ = nullptr;
};

class ContainerRecording : public RecordingWriter {
 public:
  ContainerRecording(std::string format, std::string path, const LiveInfo& info)
      : format_(std::move(format)), path_(std::move(path)), info_(info) {}

  Result<void> open();
  Result<void> write(const LiveUnit& unit) override;
  Result<void> flush() override;
  Result<void> finish() override;
  void moved(const std::string& path) override { path_ = path; }
  bool recodes() const override { return recoder_.has_value(); }

 private:
  bool is(std::string_view format) const { return format_ == format; }
  int profile() const { return has_face_ ? info_.visual_profile : 0xFF; }
  OutputStream::Filter filter();
  Result<void> add_tracks();
  Result<void> write_sound(const AudioPacket& packet);

  const std::string format_;  // of libavformat
  std::string path_;
  const LiveInfo info_;
  bool has_face_ = false;
  fba::AccessUnits face_;  // what is known of it; the muxer wants it to stay
  std::optional<AudioFormat> sound_;
  std::optional<SoundRecoder> recoder_;
  GrowingMp4 mp4_;
  std::unique_ptr<Muxer> muxer_;
  bool begun_[2] = {false, false};  // by LiveTrack
  bool flushed_ = false;
  double end_ = 0;  // seconds
};

OutputStream::Filter ContainerRecording::filter() {
  if (is("mp4")) {
    return [this](std::span<const std::uint8_t> bytes) {
      mp4_.take(bytes);
      return std::vector<std::uint8_t>();
    };
  }
  if (!is("mpegts") || !has_face_) return nullptr;
  const auto tables = std::make_shared<ProgramMapFilter>(std::uint8_t(profile()));
  return [tables](std::span<const std::uint8_t> bytes) { return tables->push(bytes); };
}

Result<void> ContainerRecording::add_tracks() {
  if (has_face_) {
    face_.config = info_.face_config;
    face_.timescale = info_.timescale;
    face_.units.push_back({{}, true, 0, std::int64_t(std::max(1.0, info_.timescale / kUsualRate))});
    if (auto added = muxer_->add_face(face_, std::nullopt); !added) return added;
  }
  if (!info_.audio) return {};
  sound_ = *info_.audio;
  if (is("mpegts") && sound_->codec == AudioCodec::opus) {
    Result<SoundRecoder> recoder = SoundRecoder::open(*sound_);
    if (!recoder) return recoder.error();
    recoder_.emplace(std::move(*recoder));
    sound_ = recoder_->format();
  }
  return muxer_->add_sound(*sound_, 0);
}

Result<void> ContainerRecording::open() {
  has_face_ = !info_.face_config.empty();
  if (!has_face_ && !info_.audio) return invalid("there is neither a face nor a sound to write");
  if (info_.timescale == 0 || info_.timescale > INT32_MAX ||
      (has_face_ && read_visual_headers(info_.face_config).kind != VisualKind::face)) {
    return invalid("the face's decoder configuration or its time scale is not that of a face");
  }
  Result<std::unique_ptr<Muxer>> opened = Muxer::open(path_, format_.c_str(), filter());
  if (!opened) return opened.error();
  muxer_ = std::move(*opened);
  if (auto added = add_tracks(); !added) return added;
  av::Options header;
  if (is("mp4")) {
    if (auto found = mp4_.open(path_); !found) return found;
    set_mp4_options({has_face_ ? &face_ : nullptr, profile(), sound_ ? &*sound_ : nullptr}, header);
    set_fragment_options("frag_custom", 0, header);
  }
  if (is("mpegts")) set_ts_options(0, header);
  return muxer_->write_header(header);
}

Result<void> ContainerRecording::write_sound(const AudioPacket& packet) {
  end_ = std::max(end_, double(packet.time + packet.duration) / sound_->sample_rate);
  return muxer_->write_sound(packet);
}

Result<void> ContainerRecording::write(const LiveUnit& unit) {
  if (auto legal = check_recorded(unit); !legal) return legal;
  if (!std::exchange(begun_[std::size_t(unit.track)], true) && flushed_) muxer_->allow_late_track();
  if (unit.track == LiveTrack::face) {
    if (!has_face_) return {};
    end_ = std::max(end_, double(unit.time + unit.duration) / info_.timescale);
    return muxer_->write_unit({unit.bytes, unit.intra, unit.time, unit.duration});
  }
  if (!sound_) return {};
  const AudioPacket packet{unit.bytes, unit.time, unit.duration};
  if (!recoder_) return write_sound(packet);
  Result<std::vector<AudioPacket>> packets = recoder_->push(packet);
  if (!packets) return packets.error();
  for (const AudioPacket& each : *packets) {
    if (auto written = write_sound(each); !written) return written;
  }
  return {};
}

Result<void> ContainerRecording::flush() {
  if (auto flushed = muxer_->end_fragment(); !flushed) return flushed;
  flushed_ = true;
  if (!is("mp4")) return {};
  const int ticks = sound_ ? sound_->sample_rate : int(info_.timescale);  // set_mp4_options()
  return mp4_.write(std::uint64_t(end_ * ticks));
}

Result<void> ContainerRecording::finish() {
  if (recoder_) {
    Result<std::vector<AudioPacket>> packets = recoder_->finish();
    if (!packets) return packets.error();
    for (const AudioPacket& each : *packets) {
      if (auto written = write_sound(each); !written) return written;
    }
  }
  if (auto flushed = flush(); !flushed) return flushed;
  if (auto finished = muxer_->finish(); !finished) return finished;
  return is("mpegts") ? fill_up_ts(path_) : Result<void>();
}

const char* format_of(const std::string& extension) {
  if (extension == ".mp4") return "mp4";
  if (extension == ".mkv") return "matroska";
  return extension == ".ts" ? "mpegts" : nullptr;
}

}  // namespace

Result<std::unique_ptr<RecordingWriter>> open_recording(const std::string& extension,
                                                        const std::string& path,
                                                        const LiveInfo& info) {
  if (extension == ".fba") {
    auto writer = std::make_unique<StreamRecording>();
    if (auto opened = writer->open(path); !opened) return opened.error();
    return std::unique_ptr<RecordingWriter>(std::move(writer));
  }
  const char* format = format_of(extension);
  if (format == nullptr) {
    return make_error(Code::unsupported, "a recording is an .mp4, .mkv, .ts or .fba file");
  }
  auto writer = std::make_unique<ContainerRecording>(format, path, info);
  if (auto opened = writer->open(); !opened) return opened.error();
  return std::unique_ptr<RecordingWriter>(std::move(writer));
}

}  // namespace animeme::media
