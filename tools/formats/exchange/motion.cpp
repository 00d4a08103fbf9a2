#include "tools/formats/exchange/motion.h"

#include <utility>

#include "codec/encode/splice.h"
#include "fap/text.h"
#include "tools/formats/exchange/curves.h"

namespace animeme::exchange {

Result<Motion> read_motion(std::vector<std::uint8_t> bytes, FrameNumbers numbers,
                           std::vector<fba::Damage>* damage) {
  if (bytes.empty()) return make_error(Code::truncated, "the file is empty");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  Motion motion;
  motion.kind = kind_of(bytes);
  switch (motion.kind) {
    case FileKind::fap_text: {
      const bool keep = numbers == FrameNumbers::keep;
      auto clip = fap::read_text(text, {.keep_numbers = keep}, &motion.warnings);
      if (!clip) return clip.error();
      motion.face = std::move(*clip);
      return motion;
    }
    case FileKind::bap_text: {
      auto body = fba::read_bap_text(text, &motion.warnings);
      if (!body) return body.error();
      motion.body = std::move(*body);
      return motion;
    }
    case FileKind::curves: {
      auto table = read_any_table(text);
      if (!table) return table.error();
      motion.face = std::move(table->clip);
      motion.warnings = std::move(table->warnings);
      return motion;
    }
    case FileKind::fba_stream:
      return decode_motion(std::move(bytes), damage);
    case FileKind::media:
      return make_error(Code::unsupported, "a container must be opened before it is read");
    default:
      return make_error(Code::syntax,
                        "this contains no face: .fap text, a raw .fba stream or an mp4, mkv or ts "
                        "file with an FBA track is needed");
  }
}

std::string note_of(const fba::JoinedStreams& joined) {
  return std::to_string(joined.count) + " streams, one behind the other, are read as one";
}

Result<Motion> decode_motion(std::vector<std::uint8_t> stream, std::vector<fba::Damage>* damage) {
  Motion motion;
  motion.kind = FileKind::fba_stream;
  motion.stream = std::move(stream);
  Result<fba::DecodedStream> decoded = fba::decode(motion.stream);
  bool sound = decoded && decoded->warnings.empty();
  if (decoded && !sound) {
    if (auto joined = fba::join_streams(motion.stream)) {
      motion.stream = std::move(joined->stream);
      decoded = fba::decode(motion.stream);
      motion.warnings.push_back(note_of(*joined));
      sound = true;
    }
  }
  if (!sound && damage != nullptr) {
    auto repaired = fba::repair_stream(motion.stream);
    if (repaired && !repaired->damage.empty()) {
      *damage = std::move(repaired->damage);
      motion.stream = std::move(repaired->stream);
      decoded = fba::decode(motion.stream);
    }
  }
  if (!decoded) return decoded.error();
  motion.face = fba::face_sequence(*decoded);
  motion.body = fba::body_sequence(*decoded);
  motion.warnings.insert(motion.warnings.end(), decoded->warnings.begin(), decoded->warnings.end());
  motion.decoded = std::move(*decoded);
  return motion;
}

}  // namespace animeme::exchange
