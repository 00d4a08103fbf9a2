/// @file
/// What all users of pocketsphinx share: its messages and some of its tables are global. Internal.
#pragma once

#include <mutex>

namespace animeme::voice {

/// Turns the messages of the library off; nobody else opens or closes parts of it while the lock is
/// held. Searches that are open already do not need it.
std::unique_lock<std::mutex> quiet_sphinx();

}  // namespace animeme::voice
