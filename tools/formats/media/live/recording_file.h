/// @file
/// A face and its sound into a file while they come, so that whatever ends the program, the file
/// holds all but the last second.
///
/// | file | while it is made | at its end |
/// |---|---|---|
/// | .mp4 | fragments, half a second each; the length so far in front of them | the same |
/// | .mkv | clusters, half a second each | length and index |
/// | .ts | packets | the same |
/// | .fba | access units | the end code |
///
/// The file has its name as soon as there is something to see, a second of sound or of the face at
/// the latest; one of that name is replaced then, and not before. An .mp4 stays fragmented, since a
/// file that can be cut anywhere is what a recording is for; `animeme mux` makes one in one piece
/// of it. Source: tools/formats/media/containers.md, section 2.2.
#pragma once

#include <memory>
#include <string>

#include "fap/result.h"
#include "tools/formats/media/live/recorder.h"

namespace animeme::media {

/// One file. Its memory does not grow with it. Not thread safe; movable.
class RecordingFile {
 public:
  /// Nothing is opened yet. `path` ends in one of the above.
  explicit RecordingFile(std::string path);
  RecordingFile(RecordingFile&&) noexcept;  ///< movable
  RecordingFile& operator=(RecordingFile&&) noexcept;
  /// Without finish() the file stays as it would if the program had been killed.
  ~RecordingFile();

  /// Takes what the recorder has for a file. Half a second after the last time it goes to the disk.
  /// Errors: unsupported (another extension; sound that cannot be decoded, where a .ts takes no
  /// Opus and it is coded again as AAC), invalid_argument (no configuration of a face, units larger
  /// than 16 MB or times beyond years), io (folder, full disk ...). Nothing is written after an
  /// error.
  Result<void> write(Recorder& recorder);
  /// All that was taken goes to the disk now: for when nothing comes. Errors: as write().
  Result<void> flush();
  /// The rest, and what belongs to the end. Nothing was taken: there is no file. Errors: as
  /// write().
  Result<void> finish();

  /// Is the sound coded again?
  bool recodes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::media
