// What a libavformat muxer writes, on its way to a file.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"

namespace animeme::media {

class OutputStream {
 public:
  /// Looks at bytes before they are written and may change them; what it returns is written. Only
  /// for formats that never go back.
  using Filter = std::function<std::vector<std::uint8_t>(std::span<const std::uint8_t>)>;

  /// A file, which is emptied. Error: io.
  static Result<std::unique_ptr<OutputStream>> to_file(const std::string& path,
                                                       Filter filter = nullptr);
  ~OutputStream();
  OutputStream(const OutputStream&) = delete;
  OutputStream& operator=(const OutputStream&) = delete;

  AVIOContext* io() const { return io_.get(); }
  /// Flushes and closes. Error: io (disk full, for one).
  Result<void> close();

 private:
  OutputStream() = default;
  static int write(void* self, std::uint8_t* bytes, int size);
  static std::int64_t seek(void* self, std::int64_t offset, int whence);
  int write_all(std::span<const std::uint8_t> bytes);

  std::FILE* file_ = nullptr;
  Filter filter_;
  av::Io io_;
};

/// "cannot be written: ..." with a remedy where there is one.
Error write_error(int status);

}  // namespace animeme::media
