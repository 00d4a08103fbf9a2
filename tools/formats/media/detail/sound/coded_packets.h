// The packets of read_encoded_audio(), one by one.
#pragma once

#include <functional>
#include <string>

#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

/// Hands over all packets; what it returns has none. Errors: those of read_encoded_audio() and of
/// `give`.
Result<EncodedAudio> read_coded_packets(const std::string& path,
                                        const std::function<Result<void>(AudioPacket)>& give);

}  // namespace animeme::media
