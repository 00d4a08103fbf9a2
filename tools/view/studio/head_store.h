/// @file
/// A cache of the built-in heads, ready to move, in the user's cache folder.
///
/// The folder is $XDG_CACHE_HOME/animeme, else ~/.cache/animeme; with a file of about 5 MB per
/// head. It belongs to the user alone (mode 0700; see private_folder.h): no link is followed. A
/// file is used only if it is intact, from this build, and a head that a rig can move (each index
/// within its list, each number finite), and is otherwise rewritten; without such a folder, heads
/// are made each time. Cached heads are identical, bit by bit. The files may be removed at any
/// time.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "fap/head/model.h"
#include "fap/result.h"

namespace animeme::studio {

/// Folder of the cache, which may not exist yet; empty if the environment names none.
std::string cache_folder();

/// The head of a description (head::parse_head()), with Head::targets as found by make_rig().
/// `folder`: the cache; empty: no cache. Errors: those of parse_head(); errors of the cache are
/// ignored.
Result<head::Head> ready_head(std::string_view name, const std::string& folder = cache_folder());

/// Serialises a head, without materials, shapes and corners, which built-in heads do not have.
std::string store_head(const head::Head& head);
/// Restores the head; nullopt if the bytes are not complete output of store_head() of this build,
/// or say something that no head has: an index behind its list, a number that is not finite.
std::optional<head::Head> restore_head(std::string_view bytes);

}  // namespace animeme::studio
