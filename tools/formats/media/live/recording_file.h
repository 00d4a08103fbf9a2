/// @file
/// Records a face and its sound to a file as they arrive. However the program ends, the file is
/// complete except for the last second.
///
/// | file | while recording | at the end |
/// |---|---|---|
/// | .mp4 | fragments, half a second each; the length so far in front of them | the same |
/// | .mkv | clusters, half a second each | length and index |
/// | .ts | packets | the same |
/// | .fba | access units | the end code |
///
/// The file appears under its name as soon as it has content, after a second of sound or face at
/// the latest; an existing file is replaced only then. An .mp4 stays fragmented, since a recording
/// must survive a cut anywhere; `animeme mux` converts it to an ordinary one. Source:
/// tools/formats/media/containers.md, section 2.2.
#pragma once

#include <memory>
#include <string>

#include "fap/result.h"
#include "tools/formats/media/live/recorder.h"

namespace animeme::media {

/// One file, written in constant memory. Not thread safe; movable.
class RecordingFile {
 public:
  /// Opens nothing yet. `path` has one of the above extensions.
  explicit RecordingFile(std::string path);
  RecordingFile(RecordingFile&&) noexcept;  ///< movable
  RecordingFile& operator=(RecordingFile&&) noexcept;
  /// Without finish() the file is as if the program had been killed.
  ~RecordingFile();

  /// Takes units from the recorder and writes them to disk every half second.
  /// Errors: unsupported (another extension; sound that cannot be decoded to be re-encoded as AAC,
  /// as .ts does not support Opus), invalid_argument (no configuration of a face, units larger than
  /// 16 MB or times beyond years), io (folder, full disk ...). Nothing is written after an error.
  Result<void> write(Recorder& recorder);
  /// Writes pending units to disk now, for use while nothing arrives. Errors: as write().
  Result<void> flush();
  /// Writes the rest and the trailer. If nothing was taken, there is no file. Errors: as write().
  Result<void> finish();

  /// Is the sound re-encoded?
  bool recodes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::media
