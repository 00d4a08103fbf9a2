// What a recording is written by, unit by unit.
#pragma once

#include <memory>
#include <string>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"

namespace animeme::media {

class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  /// Times as RecordedTimes has them. Units of a track that the writer was not told of are left
  /// out.
  virtual Result<void> write(const LiveUnit& unit) = 0;
  /// To the disk, so that what is there can be read.
  virtual Result<void> flush() = 0;
  /// Completes the file.
  virtual Result<void> finish() = 0;
  /// The file has another name now.
  virtual void moved(const std::string& path) = 0;
  virtual bool recodes() const { return false; }
};

/// A writer of files with this extension. Errors: unsupported, invalid_argument, io.
Result<std::unique_ptr<RecordingWriter>> open_recording(const std::string& extension,
                                                        const std::string& path,
                                                        const LiveInfo& info);

}  // namespace animeme::media
