// Names and languages of tracks as formats write them. Source: tools/formats/media/containers.md,
// section 2.6.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/track_labels.h"

namespace animeme::media {

/// The tag of a text in `code` that goes with speech of language `tag`: "zxx-x-de" for phones,
/// which have no language.
std::string tag_of_text(std::string_view code, const std::string& tag);

/// A sentence about what is wanted and not there (not_found).
Error no_wanted_track();

/// Of a rendition of a playlist, which says its speaker in its name, in front of its language:
/// "words (Ann, de)". Empty where the name is not of this form.
TrackLabels labels_of_text(const std::string& name, const std::string& tag);

/// "words (Ann)"; without a speaker the name alone.
std::string name_with_speaker(std::string_view name, std::string_view speaker);
/// "Ann" of a name that is one of ours (FBA, sound, words, phones, captions); empty: there is none.
std::string speaker_in_name(std::string_view name);
/// "words" of it; any other name as it is.
std::string name_without_speaker(std::string_view name);

/// libavformat 5.1 writes no LanguageBCP47. So the title of a track is made longer by as much as
/// that element takes, and put_language_tags() puts it there. Without a tag: the title.
std::string title_with_tag(const std::string& title, const std::string& tag);

/// Completes the tracks of a finished Matroska file in place. Error: io.
Result<void> put_language_tags(const std::string& path);

/// The tags of the tracks of a Matroska file that begins with these bytes, in order; empty: none.
std::vector<std::string> language_tags(std::span<const std::uint8_t> beginning);

/// What the headers of an open file say of a stream. `tag`: its language as the file has it beside
/// libavformat's, or empty.
TrackLabels labels_of(const AVStream& stream, const std::string& tag);

}  // namespace animeme::media
