#include "tools/formats/media/live/recording_file.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "tools/formats/files/output_file.h"
#include "tools/formats/media/detail/ffmpeg/extension.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/tracks/recording_writer.h"
#include "tools/formats/media/live/presentation.h"

namespace animeme::media {

namespace {

constexpr double kFlushEvery = 0.5;  // seconds of what is recorded

}  // namespace

struct RecordingFile::Impl {
  std::string path;
  std::optional<tools::OutputFile> place;  // until it has its name
  std::unique_ptr<RecordingWriter> writer;
  bool failed = false;
  bool waiting = false;                // something was written that is not on the disk
  std::optional<double> flushed = {};  // time in the file

  Result<void> begin(const LiveInfo& info);
  Result<void> write(const LiveInfo& info, std::span<const LiveUnit> units);
  Result<void> flush();
  Result<void> finish();

  /// Runs a step; nothing is written after one that failed.
  template <class Step>
  Result<void> guarded(const Step& step) {
    if (failed) return {};
    Result<void> done = av::guarded(path, [&]() -> Result<void> {
      const av::LogCapture quiet;
      return step();
    });
    failed = !done;
    return done;
  }
};

Result<void> RecordingFile::Impl::begin(const LiveInfo& info) {
  const Result<std::string> temporary = place.emplace(path).place();
  if (!temporary) return temporary.error();
  auto opened = open_recording(extension_of(path), *temporary, info);
  if (!opened) return opened.error();
  writer = std::move(*opened);
  return {};
}

Result<void> RecordingFile::Impl::write(const LiveInfo& info, std::span<const LiveUnit> units) {
  if (units.empty()) return {};
  if (writer == nullptr) {
    if (auto begun = begin(info); !begun) return begun;
  }
  double newest = 0;
  for (const LiveUnit& unit : units) {
    if (auto written = writer->write(unit); !written) return written;
    newest = std::max(newest, seconds_of(info, unit.track, unit.time));
  }
  waiting = true;
  if (flushed && newest - *flushed < kFlushEvery) return {};
  flushed = newest;
  return flush();
}

Result<void> RecordingFile::Impl::flush() {
  if (!waiting) return {};
  waiting = false;
  if (auto done = writer->flush(); !done) return done;
  if (!place) return {};
  // The name goes to what is there by now, and whatever is written then goes into the same file.
  if (auto named = place->publish(); !named) return named;
  place.reset();
  writer->moved(path);
  return {};
}

Result<void> RecordingFile::Impl::finish() {
  if (writer == nullptr) return {};
  if (auto done = flush(); !done) return done;
  Result<void> done = writer->finish();
  writer.reset();
  failed = true;  // nothing can be added
  return done;
}

RecordingFile::RecordingFile(std::string path) : impl_(new Impl{.path = std::move(path)}) {}
RecordingFile::RecordingFile(RecordingFile&&) noexcept = default;
RecordingFile& RecordingFile::operator=(RecordingFile&&) noexcept = default;
RecordingFile::~RecordingFile() = default;

Result<void> RecordingFile::write(Recorder& recorder) {
  const std::vector<LiveUnit> units = recorder.take_units();
  if (!recorder.info()) return {};
  return impl_->guarded([&] { return impl_->write(*recorder.info(), units); });
}

Result<void> RecordingFile::flush() {
  return impl_->guarded([&] { return impl_->flush(); });
}

Result<void> RecordingFile::finish() {
  return impl_->guarded([&] { return impl_->finish(); });
}

bool RecordingFile::recodes() const { return impl_->writer != nullptr && impl_->writer->recodes(); }

}  // namespace animeme::media
