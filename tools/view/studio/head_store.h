/// @file
/// Heads of our own are made once: they wait in the user's cache, ready to move.
///
/// The folder is $XDG_CACHE_HOME/animeme, else ~/.cache/animeme; a file of some 5 MB a head. What
/// lies there is taken only if this build made it and it is whole, and is made anew otherwise;
/// without a folder that can be written to, heads are made each time. The heads are the same, bit
/// by bit. Anybody may remove the files at any time.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "fap/head/model.h"
#include "fap/result.h"

namespace animeme::studio {

/// Folder of the cache; empty if the environment names none. It may not be there yet.
std::string cache_folder();

/// The head of that name (head::kHeadNames), with Head::targets as make_rig() finds them. `folder`:
/// of the cache; empty: none is used. Errors: not_found for another name; the cache has none.
Result<head::Head> ready_head(std::string_view name, const std::string& folder = cache_folder());

/// A head as bytes, without coats, shapes and corners, which heads of our own do not have.
std::string store_head(const head::Head& head);
/// The head; nothing if the bytes are not those of store_head() of this build, whole.
std::optional<head::Head> restore_head(std::string_view bytes);

}  // namespace animeme::studio
