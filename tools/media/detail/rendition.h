// Which part of a presentation holds what.
#pragma once

#include "tools/media/container.h"
#include "tools/media/detail/presentation.h"

namespace animeme::media {

/// The first rendition with a track of this kind; nullptr: there is none.
inline const std::vector<std::uint8_t>* find_rendition(const Presentation& presentation,
                                                       TrackKind kind) {
  for (const std::vector<std::uint8_t>& bytes : presentation.renditions) {
    const Result<ContainerInfo> info = probe(bytes);
    if (info && info->first(kind) != nullptr) return &bytes;
  }
  return nullptr;
}

/// Runs `read` on the sound of a presentation. Errors: those of reading it; not_found (silent).
template <class Read>
auto read_sound_of(const std::string& path, const Read& read)
    -> decltype(read(std::span<const std::uint8_t>())) {
  const Result<Presentation> presentation = read_presentation(path);
  if (!presentation) return presentation.error();
  const std::vector<std::uint8_t>* sound = find_rendition(*presentation, TrackKind::audio);
  if (sound == nullptr) return make_error(Code::not_found, "the presentation has no sound");
  return read(std::span<const std::uint8_t>(*sound));
}

}  // namespace animeme::media
