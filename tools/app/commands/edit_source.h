/// @file
/// The inputs of edit on one time line: motion, sound and words.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/app/commands/common.h"
#include "tools/app/commands/fap_file.h"
#include "tools/app/commands/plane_file.h"
#include "tools/formats/media/text_track.h"
#include "tools/formats/programs/scratch_folder.h"

namespace animeme::tools {

/// An intact stream that is read again whenever its planes are wanted, so that memory does not grow
/// with it.
struct EditStream {
  PlaneFile file{std::string()};          ///< the stream
  bool start_codes = true;                ///< before every plane
  bool one_rate = true;                   ///< all planes have the same
  std::vector<std::int64_t> intra;        ///< numbers of its intra planes
  std::shared_ptr<ScratchFolder> folder;  ///< where it is, if it was taken out of a container
};

/// One input file. Its frames count from 0; frame k is shown at k / rate seconds.
struct EditSource {
  std::string path;    ///< of the file
  MotionInput motion;  ///< with the decoded planes, if it is a stream in memory; kind and names
  std::shared_ptr<const EditStream> stream;  ///< it stays in its file; null: see below
  std::optional<FapFile> text;               ///< likewise; neither: the motion is in memory
  fap::Rate rate;                            ///< of the face, or of the body if there is none
  std::int64_t lead = 0;    ///< frames of sound before the motion, in which its first pose is held
  std::int64_t frames = 0;  ///< of the whole: motion, the frames that its last plane skips, sound
  bool sound = false;       ///< there is some
  double origin = 0;        ///< time of frame 0 on the clock of the sound, seconds
  std::vector<media::TextTrack> texts;  ///< on the same clock

  /// It has planes, which can be copied.
  bool coded() const { return stream != nullptr || !motion.stream.empty(); }
};

/// Opens an input with motion. An intact stream in a file, or in a container on disk, stays there,
/// and so does a FAP text; anything else is read into memory. Errors: those of read_motion();
/// not_found (there is no motion).
Result<EditSource> open_edit_source(const std::string& path);

/// Frames `first` up to `end` of a source.
struct EditCut {
  const EditSource* source = nullptr;  ///< borrowed
  std::int64_t first = 0;              ///< first frame
  std::int64_t end = 0;                ///< behind the last frame
};

}  // namespace animeme::tools
