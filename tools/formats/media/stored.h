/// @file
/// Faces and sounds of files that are written into another one, in a temporary file meanwhile, so
/// that memory does not grow with them.
///
///     auto face = store_face("de.mp4");               // nullopt: read_container() knows more
///     auto sound = StoredAudio::read("de.mp4");
///     MuxInput input{.face_units = &**face, .stored = &*sound};
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "codec/decode/unit_reader.h"
#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

/// The units of read_container(), with their times. nullopt: there is something to repair or to
/// warn of, the face begins before the sound, or the file is a playlist; read_container() reads it.
/// Errors: those of read_container(); io (the temporary file).
Result<std::optional<fba::UnitReader>> store_face(const std::string& path);

/// The sound of read_encoded_audio(), which is read again packet by packet. Movable, not copyable.
class StoredAudio {
 public:
  /// Reads it for the first time. Errors: those of read_encoded_audio(); io (the temporary file).
  static Result<StoredAudio> read(const std::string& path);
  StoredAudio(StoredAudio&&) noexcept;  ///< movable
  StoredAudio& operator=(StoredAudio&&) noexcept;
  ~StoredAudio();

  const AudioFormat& format() const;  ///< as EncodedAudio::format
  std::int64_t length() const;        ///< as EncodedAudio::length, > 0
  std::int64_t bit_rate() const;      ///< mean, bits a second
  /// The next packet, valid until the next call; null: there are no more. Errors: io.
  Result<const AudioPacket*> next();
  /// next() gives the first packet again. Errors: io.
  Result<void> rewind();

 private:
  struct Impl;
  explicit StoredAudio(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::media
