#include "codec/decode/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "codec/decode/decoder_internal.h"
#include "codec/decode/plane_header.h"
#include "codec/decode/unit_writer_internal.h"
#include "codec/syntax/bits.h"
#include "codec/syntax/plane.h"

namespace animeme::fba {
namespace {

constexpr std::array<std::uint8_t, 4> kPlaneCode = {0x00, 0x00, 0x01, 0xBB};
constexpr std::array<std::uint8_t, 4> kEndCode = {0x00, 0x00, 0x01, 0xB1};
constexpr std::int64_t kMostHeld = std::int64_t(1) << 20;  // frames; more is not believed
constexpr std::uint32_t kMostSkipped = 1 << 12;  // the same of a header that may be damaged
constexpr std::size_t kUsual = 3;                // planes that are alike make a rule

// The bytes of a unit: start codes, one plane or several, stuffing.
struct Piece {
  std::span<const std::uint8_t> bytes;
  std::int64_t offset = 0;        // of the first byte in the whole
  std::size_t plane_at = 0;       // of the first byte of its first plane
  bool object = false;            // begins with an object start code
  bool coded = false;             // has a plane start code
  bool after_gap = false;         // units before it are missing
  bool foreign = false;           // behind a start code of something else, which ends an object
  std::optional<double> seconds;  // its time, if a container says it

  bool intra() const { return plane_at < bytes.size() && (bytes[plane_at] & 0x80) != 0; }
};

Piece piece_of(std::span<const std::uint8_t> unit, std::int64_t offset) {
  Piece piece;
  piece.bytes = unit;
  piece.offset = offset;
  const BitReader in(unit);
  piece.object = is_object_start(in.peek32(0));
  if (piece.object) piece.plane_at = unit.size() > 4 && unit[4] == 0x7F ? 5 : 4;
  piece.coded = is_plane_start(in.peek32(piece.plane_at * 8));
  if (piece.coded) piece.plane_at += kPlaneCode.size();
  return piece;
}

// Whether stuffing follows a plane, and then a start code of which one byte is wrong.
bool ends_at_damaged_code(std::span<const std::uint8_t> bytes, const Plane& plane) {
  const auto end = std::size_t(plane.bit_end);
  const std::size_t at = end / 8 + 1;
  if (!BitReader(bytes, end).at_stuffing() || at + kPlaneCode.size() >= bytes.size()) return false;
  const auto same =
      std::inner_product(kPlaneCode.begin(), kPlaneCode.end(), bytes.begin() + std::ptrdiff_t(at),
                         std::size_t(0), std::plus<>(), std::equal_to<>());
  return same + 1 == kPlaneCode.size();
}

// A plane that can be decoded.
struct Kept {
  std::size_t piece = 0;
  std::int64_t bit_begin = 0, bit_end = 0;  // in the piece
  bool intra = false, object = false;       // an object begins
  std::int64_t number = 0;                  // of its frame
  std::int64_t skip = 0;                    // frames that it says it skips
  fap::Rate rate;
};

class Repairer {
 public:
  // What is borrowed is changed where pieces turn out to be one. `careful`: a plane that depends
  // on what follows it is damage.
  Repairer(std::span<Piece> pieces, bool careful) : pieces_(pieces), careful_(careful) {
    written_.push(kPlaneCode);
  }

  void run() {
    for (std::size_t i = 0; i < pieces_.size();) i = take(i);
  }

  const std::vector<Kept>& kept() const { return kept_; }
  std::vector<Damage>& damage() { return damage_; }
  std::int64_t next() const { return next_; }  // number of the frame behind the last one
  const std::optional<Error>& first_failure() const { return failure_; }
  bool following() const { return following_; }  // the last unit is intact
  bool careful() const { return careful_; }

 private:
  std::size_t take(std::size_t index);  // which one is next
  // What the decoder makes of a piece; the failure, if there is one.
  std::optional<Error> decode_piece(const Piece& piece, std::vector<Plane>& planes);
  // The decoder continues behind what was kept: `following_`, with the next plane, else with an
  // intra plane.
  void restart();
  // Tries a piece that cannot be decoded with those behind it that have no start code of ours.
  // True: it is longer now, `planes` and `failed` are what comes out of it, and `next` lies behind
  // it.
  bool extend(std::size_t index, std::vector<Plane>& planes, std::optional<Error>& failed,
              std::size_t& next);
  void keep(std::size_t index, const std::vector<Plane>& planes);
  void place(double seconds);
  void lose(std::int64_t bit, const Error& error, std::int64_t frames, bool estimated);
  double lost_at() const;
  // Frames of a piece that was not decoded.
  std::int64_t frames_of(const Piece& piece, std::int64_t bits, bool& estimated) const;

  std::span<Piece> pieces_;
  bool careful_ = true;
  std::vector<Kept> kept_;
  std::vector<Damage> damage_;
  std::optional<Error> failure_;
  // Both have had a plane start code for what comes next, so that they know where a plane ends.
  Decoder decoder_;       // of the pieces
  Decoder written_;       // of what was kept, as it is written
  std::int64_t fed_ = 0;  // bytes that decoder_ has had
  std::int64_t written_bytes_ = std::int64_t(kPlaneCode.size());  // that written_ has had
  fap::Rate rate_{30, 1};
  bool following_ = false;  // the decoder has what the next predictive plane builds on
  bool single_ = true;      // so far each unit was one plane ...
  bool stuffed_ = true;     // ... and the bits behind it were stuffing
  bool in_damage_ = false;  // the last entry of damage_ goes on
  std::int64_t next_ = 0;   // number of the next frame
  std::int64_t bits_ = 0;   // of what was kept
};

// Ranges of an intra plane last until others are sent, and a face may begin while a body goes on:
// the decoder has to know all that was kept, and nothing else.
void Repairer::restart() {
  decoder_ = written_;
  fed_ = written_bytes_;
  if (following_) return;
  constexpr std::array<std::uint8_t, 3> kNoPlane = {0xB0, 0x00, 0xFF};  // intra, with a rate of 0
  decoder_.push(kNoPlane);
  decoder_.push(kPlaneCode);
  while (decoder_.next()) {
  }
  fed_ += std::int64_t(kNoPlane.size() + kPlaneCode.size());
}

std::optional<Error> Repairer::decode_piece(const Piece& piece, std::vector<Plane>& planes) {
  const auto ahead = std::int64_t(piece.plane_at);
  const std::int64_t begin = fed_ - ahead;
  decoder_.push(piece.bytes.subspan(piece.plane_at));
  decoder_.push(kPlaneCode);
  fed_ = begin + std::int64_t(piece.bytes.size() + kPlaneCode.size());
  const auto misplaced = [](std::int64_t bit) {
    return error_at_bit(Code::syntax, "a plane does not end where the next one begins", bit);
  };
  for (;;) {
    Result<Event> event = decoder_.next();
    if (!event && event.error().code == Code::need_data) break;
    if (!event) return event.error();
    if (careful_ && event->kind == Event::Kind::warning && event->text == internal::kUnsettled) {
      planes.pop_back();
      return error_at_bit(Code::syntax, "the last values of a plane depend on what follows it",
                          event->bit);
    }
    if (event->kind != Event::Kind::plane) continue;
    Plane& plane = event->plane;
    plane.bit_begin -= begin * 8;
    plane.bit_end -= begin * 8;
    if (planes.empty() && plane.bit_begin != std::int64_t(piece.plane_at) * 8) {
      return misplaced(plane.bit_begin);
    }
    planes.push_back(std::move(plane));
  }
  if (planes.empty()) return make_error(Code::truncated, "a plane is incomplete");
  const std::int64_t end = planes.back().bit_end;
  const std::int64_t stuffing = std::int64_t(piece.bytes.size()) * 8 - end;
  if (stuffing < 0 || stuffing > 8) return misplaced(end);
  const bool alike = kept_.size() >= kUsual;
  if (single_ && alike && planes.size() > 1) return misplaced(planes.front().bit_end);
  const bool stuffed = BitReader(piece.bytes, std::size_t(end)).at_stuffing();
  if (stuffed_ && alike && !stuffed) return misplaced(end);
  stuffed_ = stuffed_ && stuffed;
  single_ = single_ && planes.size() == 1;
  return std::nullopt;
}

// Encoders that do not look at their output write start codes in planes.
bool Repairer::extend(std::size_t index, std::vector<Plane>& planes, std::optional<Error>& failed,
                      std::size_t& next) {
  const Piece& piece = pieces_[index];
  Piece whole = piece;
  std::size_t behind = index + 1;
  for (; behind < pieces_.size(); ++behind) {
    const Piece& more = pieces_[behind];
    const std::size_t size = whole.bytes.size();
    if (more.coded || more.object || more.bytes.data() != whole.bytes.data() + size) break;
    whole.bytes = {whole.bytes.data(), size + more.bytes.size()};
  }
  if (behind == index + 1) return false;
  restart();
  std::vector<Plane> all;
  std::optional<Error> error = decode_piece(whole, all);
  if (error) {
    // The plane across the start code is one if another follows it, or the stream is cut off.
    const auto size = std::int64_t(piece.bytes.size()) * 8;
    const std::size_t sure = all.size() - (all.empty() || behind == pieces_.size() ? 0 : 1);
    const bool further = sure > 0 && all[sure - 1].bit_end > size;
    if (!further || (single_ && kept_.size() >= kUsual)) return false;
  }
  pieces_[index] = whole;
  planes = std::move(all);
  failed = std::move(error);
  next = behind;
  return true;
}

void Repairer::keep(std::size_t index, const std::vector<Plane>& planes) {
  const Piece& piece = pieces_[index];
  for (const Plane& plane : planes) {
    if (plane.temporal.rate) rate_ = plane.temporal.rate->rate();
    if (in_damage_ && piece.seconds && !kept_.empty()) place(*piece.seconds);
    Kept& kept = kept_.emplace_back();
    kept.piece = index;
    kept.bit_begin = plane.bit_begin;
    kept.bit_end = plane.bit_end;
    kept.intra = plane.intra;
    kept.object = piece.object && &plane == &planes.front();
    kept.number = next_;
    kept.skip = std::int64_t(plane.temporal.skip.value_or(0));
    kept.rate = rate_;
    next_ += 1 + kept.skip;
    bits_ += kept.bit_end - kept.bit_begin;
    const auto unit = internal::write_unit(piece.bytes, kept.bit_begin, kept.bit_end, false);
    written_.push(std::span(unit).subspan(kPlaneCode.size()));
    written_.push(kPlaneCode);
    while (written_.next()) {
    }
    written_bytes_ += std::int64_t(unit.size());
    in_damage_ = false;
  }
}

// Behind lost planes: the container knows how long they took.
void Repairer::place(double seconds) {
  const Kept& last = kept_.back();
  const double since = seconds - *pieces_[last.piece].seconds;
  const auto frames = std::llround(since * last.rate.frames_per_second());
  next_ = last.number + std::clamp<std::int64_t>(frames, 1, kMostHeld);
  damage_.back().frames = std::max<std::int64_t>(0, next_ - last.number - 1 - last.skip);
  damage_.back().estimated = false;
}

std::int64_t Repairer::frames_of(const Piece& piece, std::int64_t bits, bool& estimated) const {
  if (single_ || kept_.empty()) {
    const auto header = read_plane_header(piece.bytes);
    const bool skips = header && header->temporal.skip && *header->temporal.skip < kMostSkipped;
    return 1 + (skips ? std::int64_t(*header->temporal.skip) : 0);
  }
  estimated = true;
  const double mean = double(bits_) / double(kept_.size());
  return std::max<std::int64_t>(1, std::llround(double(bits) / std::max(1.0, mean)));
}

void Repairer::lose(std::int64_t bit, const Error& error, std::int64_t frames, bool estimated) {
  if (!failure_) failure_ = error_at_bit(error.code, error.message, bit);
  if (!in_damage_) {
    Damage& damage = damage_.emplace_back();
    damage.bit = bit;
    damage.seconds = lost_at();
    damage.reason = error.message;
    in_damage_ = true;
  }
  frames = std::min(frames, kMostHeld - damage_.back().frames);
  damage_.back().frames += frames;
  damage_.back().estimated |= estimated;
  next_ += frames;
  following_ = false;
}

double Repairer::lost_at() const {
  if (kept_.empty()) return 0;
  const Kept& last = kept_.back();
  const std::optional<double>& from = pieces_[last.piece].seconds;
  const double ahead = last.rate.seconds(double(next_ - last.number));
  return from ? *from + ahead : last.rate.seconds(double(last.number)) + ahead;
}

std::size_t Repairer::take(std::size_t index) {
  const Piece& piece = pieces_[index];
  std::size_t next = index + 1;
  if (piece.foreign) return next;
  if (piece.after_gap) {
    lose(piece.offset * 8, make_error(Code::truncated, "planes are missing"), 0, false);
  }
  following_ = following_ && !piece.object && piece.coded;
  bool estimated = false;
  const bool begins = piece.intra() && (piece.coded || piece.object);
  if (!following_ && !begins) {
    const auto bits = std::int64_t(piece.bytes.size()) * 8;
    const std::int64_t frames = frames_of(piece, bits, estimated);
    const char* why = piece.coded || piece.object ? "there is no intra plane to begin with"
                                                  : "a plane has no start code";
    lose(piece.offset * 8, make_error(Code::syntax, why), frames, estimated);
    return next;
  }
  if (!following_) restart();
  std::vector<Plane> planes;
  std::optional<Error> failed = decode_piece(piece, planes);
  if (failed) extend(index, planes, failed, next);
  following_ = true;
  if (!failed) {
    keep(index, planes);
    return next;
  }
  const std::int64_t size = std::int64_t(piece.bytes.size()) * 8;
  // What reaches into the next unit is no plane. Of several planes, those before the last one are
  // followed by another one, unless the stream is cut off here; where each has a start code of its
  // own, the first is whole if what follows it was one.
  std::erase_if(planes, [&](const Plane& plane) { return plane.bit_end > size; });
  const bool cut_off = failed->code == Code::truncated || next == pieces_.size();
  std::size_t good = planes.size() - (planes.empty() || cut_off ? 0 : 1);
  if (single_ && kept_.size() >= kUsual) {
    good = !planes.empty() && ends_at_damaged_code(piece.bytes, planes.front()) ? 1 : 0;
  } else {
    single_ = single_ && planes.size() <= 1;
  }
  planes.resize(good);
  keep(index, planes);
  const std::int64_t from = planes.empty() ? 0 : planes.back().bit_end;
  lose(piece.offset * 8 + from, *failed, frames_of(piece, size - from, estimated), estimated);
  return next;
}

// The units of the planes that were kept, with as many skipped frames as lie behind each. With
// `from_start` the first one is there twice if frames before it are lost: it is held from the start
// of the stream. The second is a plane of the same object, as decoders may end at another one.
std::vector<AccessUnit> units_of(std::span<const Kept> kept, std::span<const Piece> pieces,
                                 bool from_start) {
  std::vector<AccessUnit> units;
  units.reserve(kept.size() + 1);
  if (from_start && kept.front().number > 0) {
    const Kept& first = kept.front();
    AccessUnit& held = units.emplace_back();
    held.bytes = internal::write_unit(pieces[first.piece].bytes, first.bit_begin, first.bit_end,
                                      true, std::uint32_t(first.number - 1));
    held.intra = true;
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Kept& plane = kept[i];
    std::optional<std::uint32_t> skip;
    if (i + 1 < kept.size()) {
      const std::int64_t between = kept[i + 1].number - plane.number - 1;
      if (between != plane.skip)
        skip = std::uint32_t(std::clamp<std::int64_t>(between, 0, kMostHeld));
    }
    AccessUnit& unit = units.emplace_back();
    unit.bytes = internal::write_unit(pieces[plane.piece].bytes, plane.bit_begin, plane.bit_end,
                                      units.size() == 1 || (i > 0 && plane.object), skip);
    unit.intra = plane.intra;
  }
  return units;
}

// Cuts a raw stream at its start codes: what lies before the first object or plane is left out, an
// end code ends it. A start code of something else ends an object (codec/bitstream.md, section 1);
// where planes go on behind it, it was that of a plane.
struct Cut {
  std::vector<Piece> pieces;
  bool ended = false;  // by an end code
};

Cut cut(std::span<const std::uint8_t> stream) {
  Cut out;
  const BitReader in(stream);
  std::optional<std::size_t> begin;
  bool foreign = false;  // a start code of something else, or one that is damaged
  const auto close = [&](std::size_t end, bool goes_on) {
    if (begin) {
      out.pieces.push_back(piece_of(stream.subspan(*begin, end - *begin), *begin));
      out.pieces.back().foreign = foreign && !goes_on;
    }
    begin.reset();
    foreign = false;
  };
  for (std::size_t at = 0; at + 4 <= stream.size(); ++at) {
    if (stream[at] != 0 || stream[at + 1] != 0 || stream[at + 2] != 1) continue;
    const std::uint32_t code = in.peek32(at * 8);
    if (code == kSequenceEnd) {
      close(at, false);
      if (internal::begins_stream(stream.subspan(at + 4))) continue;
      out.ended = true;
      return out;
    }
    if (is_plane_start(code) || is_object_start(code)) {
      close(at, is_plane_start(code));
      begin = at;
      const Piece piece = piece_of(stream.subspan(at), 0);
      if (piece.object && piece.coded) at = *begin + piece.plane_at - 1;
    } else if (code == kSequenceStart || code == kUserData || code == kVisualObject) {
      close(at, false);
    } else if (begin) {
      close(at, true);
      begin = at;
      foreign = true;
    }
  }
  // A stream that is cut in a start code.
  std::size_t end = stream.size();
  const bool whole_prefix =
      end >= 3 && stream[end - 1] == 1 && stream[end - 2] == 0 && stream[end - 3] == 0;
  if (whole_prefix) --end;
  while (end > 0 && stream[end - 1] == 0) --end;
  close(stream.size() - end <= 3 ? end : stream.size(), false);
  return out;
}

Error nothing_left(const std::optional<Error>& failure) {
  return failure.value_or(make_error(Code::truncated, "the stream holds no plane"));
}

// Where no intra plane is beyond doubt, those that can be decoded are better than nothing.
Repairer repaired(std::vector<Piece>& pieces) {
  std::vector<Piece> copy = pieces;
  Repairer careful(copy, true);
  careful.run();
  if (careful.kept().empty()) {
    Repairer tolerant(pieces, false);
    tolerant.run();
    return tolerant;
  }
  pieces = std::move(copy);
  return careful;
}

// Whether a stream decodes, and without a doubt.
enum class Soundness : std::uint8_t { damaged, doubtful, sound };

// `next` gives the bytes piece by piece, and nothing at the end. Only a plane at a time is kept.
// `end`: the byte behind the end code.
Soundness soundness(const std::function<std::span<const std::uint8_t>()>& next,
                    std::size_t* end = nullptr) {
  Decoder decoder;
  bool doubt = false;
  for (;;) {
    const Result<Event> event = decoder.next();
    if (event) {
      doubt = doubt || event->kind == Event::Kind::warning;
      continue;
    }
    if (event.error().code == Code::end_of_stream) {
      if (end != nullptr) *end = std::size_t(event.error().where.bit / 8);
      break;
    }
    if (event.error().code != Code::need_data) return Soundness::damaged;
    const std::span<const std::uint8_t> bytes = next();
    decoder.push(bytes);
    if (bytes.empty()) decoder.finish();
  }
  return doubt ? Soundness::doubtful : Soundness::sound;
}

// A stream with another one behind its end code is doubtful.
Soundness soundness(std::span<const std::uint8_t> stream) {
  std::span<const std::uint8_t> rest = stream;
  std::size_t end = stream.size();
  const auto next = [&] {
    const auto piece = rest.first(std::min(internal::kPieceBytes, rest.size()));
    rest = rest.subspan(piece.size());
    return piece;
  };
  const Soundness found = soundness(next, &end);
  const bool more = found == Soundness::sound && internal::begins_stream(stream.subspan(end));
  return more ? Soundness::doubtful : found;
}

Soundness soundness(const AccessUnits& units) {
  std::size_t at = 0;
  return soundness([&]() -> std::span<const std::uint8_t> {
    if (at < units.units.size()) return units.units[at++].bytes;
    return at++ == units.units.size() ? std::span(kEndCode) : std::span<const std::uint8_t>();
  });
}

}  // namespace

std::string Damage::describe() const {
  char text[96];
  std::snprintf(text, sizeof text, "at %.2f s (bit %lld): ", seconds, static_cast<long long>(bit));
  std::string out = text + reason;
  if (frames > 0) {
    out += "; " + std::string(estimated ? "about " : "") + std::to_string(frames) +
           (frames == 1 ? " frame is lost" : " frames are lost");
  }
  return out;
}

Result<Repaired> repair_stream(std::span<const std::uint8_t> stream) {
  Repaired out;
  const Soundness found = soundness(stream);
  if (found == Soundness::sound) {
    out.stream.assign(stream.begin(), stream.end());
    return out;
  }
  Cut parts = cut(stream);
  Repairer repairer = repaired(parts.pieces);
  const std::span<const Kept> kept = repairer.kept();
  if (kept.empty()) return nothing_left(repairer.first_failure());
  out.damage = std::move(repairer.damage());
  const bool cut_off = !parts.ended && found == Soundness::damaged;
  if (cut_off && (out.damage.empty() || repairer.following())) {
    Damage& damage = out.damage.emplace_back();
    damage.bit = std::int64_t(stream.size()) * 8;
    damage.seconds = kept.back().rate.seconds(double(repairer.next()));
    damage.reason = "the stream ends without an end code; it may be truncated";
  }
  if (out.damage.empty() && found != Soundness::damaged) {
    out.stream.assign(stream.begin(), stream.end());
    return out;
  }
  if (out.damage.empty()) out.damage.emplace_back().reason = "the headers are damaged";
  AccessUnits units;
  units.units = units_of(kept, parts.pieces, true);
  out.stream = join_access_units(units);
  if (!repairer.careful() && soundness(out.stream) == Soundness::damaged) {
    return nothing_left(repairer.first_failure());
  }
  return out;
}

Result<std::vector<Damage>> repair_units(AccessUnits& units, std::span<const std::size_t> gaps) {
  if (gaps.empty() && soundness(units) == Soundness::sound) return std::vector<Damage>();
  std::vector<Piece> pieces;
  std::int64_t offset = 0;
  for (const AccessUnit& unit : units.units) {
    Piece& piece = pieces.emplace_back(piece_of(unit.bytes, offset));
    piece.seconds = double(unit.time) / units.timescale;
    piece.after_gap = std::binary_search(gaps.begin(), gaps.end(), pieces.size() - 1);
    offset += std::int64_t(unit.bytes.size());
  }
  Repairer repairer = repaired(pieces);
  const std::span<const Kept> kept = repairer.kept();
  if (kept.empty()) return nothing_left(repairer.first_failure());
  if (repairer.damage().empty()) return std::vector<Damage>();
  std::vector<AccessUnit> intact = units_of(kept, pieces, false);
  for (std::size_t i = 0; i < intact.size(); ++i) {
    AccessUnit& unit = intact[i];
    const AccessUnit& from = units.units[kept[i].piece];
    unit.time = from.time;
    if (i == 0) continue;
    AccessUnit& before = intact[i - 1];
    if (unit.time <= before.time) {  // a further plane of the same unit
      const double frames = double(kept[i].number - kept[i - 1].number);
      unit.time =
          before.time +
          std::max<std::int64_t>(1, std::llround(kept[i].rate.seconds(frames) * units.timescale));
    }
    before.duration = unit.time - before.time;
  }
  const AccessUnit& last = units.units.back();
  intact.back().duration =
      std::max<std::int64_t>(1, last.time + last.duration - intact.back().time);
  std::swap(units.units, intact);
  if (!repairer.careful() && soundness(units) == Soundness::damaged) {
    std::swap(units.units, intact);
    return nothing_left(repairer.first_failure());
  }
  return std::move(repairer.damage());
}

}  // namespace animeme::fba
