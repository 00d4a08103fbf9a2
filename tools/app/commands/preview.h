/// @file
/// Films that commands write: with progress, and a line about each.
#pragma once

#include <string>

#include "codec/decode/access_unit.h"
#include "tools/view/studio/film.h"

namespace animeme::tools {

struct OptionTable;

/// Adds --preview. The name that it gets is empty, or that of a film.
void add_preview_option(OptionTable& cli, std::string& path);

/// As studio::write_film(). Ctrl-C completes what was rendered: exit code kInterrupted.
Result<int> write_preview(const std::string& path, const fap::Sequence& clip,
                          const media::MuxInput& sound, const studio::FilmOptions& options);

/// The same for a coded face, with its usual looks. Error: that of the stream.
Result<int> write_preview(const std::string& path, const fba::AccessUnits& face,
                          const media::MuxInput& sound);

}  // namespace animeme::tools
