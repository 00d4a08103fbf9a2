// Frames and failures between C and C++.
#include <algorithm>

#include "fap/tables.h"
#include "tools/bindings/c/c_internal.h"

namespace animeme::c {

static_assert(sizeof(animeme_error) == 512 && sizeof(animeme_frame) == 432 &&
                  sizeof(animeme_body) == 1496 && sizeof(animeme_encode_options) == 64 &&
                  sizeof(animeme_speak_options) == 176,
              "a struct may grow at its end only, and then in a new version");

animeme_status status_of(Code code) {
  switch (code) {
    case Code::invalid_argument:
      return ANIMEME_INVALID_ARGUMENT;
    case Code::syntax:
      return ANIMEME_SYNTAX;
    case Code::out_of_range:
      return ANIMEME_OUT_OF_RANGE;
    case Code::truncated:
      return ANIMEME_TRUNCATED;
    case Code::need_data:
      return ANIMEME_NEED_DATA;
    case Code::end_of_stream:
      return ANIMEME_END;
    case Code::unsupported:
      return ANIMEME_UNSUPPORTED;
    case Code::not_found:
      return ANIMEME_NOT_FOUND;
    case Code::io:
      return ANIMEME_IO;
    case Code::internal:
      break;
  }
  return ANIMEME_INTERNAL;
}

animeme_status fail(animeme_error* error, animeme_status status, std::string_view message) {
  if (error == nullptr) return status;
  *error = {};
  error->status = status;
  error->bit = -1;
  std::size_t size = std::min(message.size(), sizeof error->message - 1);
  // Not in the middle of a letter.
  while (size < message.size() && size > 0 && (message[size] & 0xC0) == 0x80) --size;
  std::copy_n(message.data(), size, error->message);
  return status;
}

animeme_status fail(animeme_error* error, const Error& from) {
  const animeme_status status = status_of(from.code);
  if (error == nullptr) return status;
  fail(error, status, from.describe());
  error->line = from.where.line;
  error->column = from.where.column;
  error->bit = from.where.bit;
  return status;
}

animeme_status invalid(animeme_error* error, std::string_view message) {
  return fail(error, ANIMEME_INVALID_ARGUMENT, message);
}

animeme_status take_frame(const animeme_frame* given, fap::Frame& frame, fap::GroupRules* rules,
                          animeme_error* error) {
  if (given == nullptr) return invalid(error, "frame is NULL");
  animeme_frame copy;
  if (!take(*given, copy, animeme_frame{})) {
    return invalid(error, "this is no animeme_frame, see animeme_frame_init()");
  }
  frame = {};
  frame.number = copy.number;
  for (std::size_t i = 0; i < fap::kFapCount; ++i) {
    if (copy.present[i] == 0) continue;
    frame.mask.set(i + 1);
    if (i + 1 >= fap::kFirstLowLevel) frame.value[i + 1] = copy.value[i];
  }
  if (frame.mask[1]) {
    frame.viseme = {copy.viseme[0], copy.viseme[1], copy.viseme[2], copy.viseme[3] != 0};
  }
  if (frame.mask[2]) {
    const std::int32_t* e = copy.expression;
    frame.expression = {e[0], e[1], e[2], e[3], e[4] != 0, e[5] != 0};
  }
  if (rules == nullptr) return ANIMEME_OK;
  for (std::size_t group = 0; group < rules->size(); ++group) {
    if (copy.group_rule[group] > std::uint8_t(fap::GroupRule::interpolate)) {
      return invalid(error, "a group_rule is neither 0, 1 nor 2");
    }
    (*rules)[group] = fap::GroupRule(copy.group_rule[group]);
  }
  return ANIMEME_OK;
}

bool writable(const animeme_frame* frame, animeme_error* error) {
  if (frame != nullptr && frame->size >= kFirstSize) return true;
  invalid(error, frame == nullptr ? "frame is NULL"
                                  : "this is no animeme_frame, see animeme_frame_init()");
  return false;
}

namespace {

// All but size, flags, number and times. Once a plane, so without a branch for each FAP.
void write_values(const fap::Frame& frame, const fap::GroupRules& rules, animeme_frame& out) {
  std::uint64_t bits = ((frame.mask >> 1) & fap::Mask(~0ULL)).to_ullong();  // of FAP 1..64
  for (std::size_t i = 0; i < 64; ++i) out.present[i] = std::uint8_t(bits >> i & 1);
  bits = (frame.mask >> 65).to_ullong();
  for (std::size_t i = 64; i < fap::kFapCount; ++i) {
    out.present[i] = std::uint8_t(bits >> (i - 64) & 1);
  }
  for (std::size_t i = 0; i < fap::kFapCount; ++i) {
    out.value[i] = frame.value[i + 1] & -std::int32_t(out.present[i]);
  }
  out.value[0] = out.value[1] = 0;
  std::fill(std::begin(out.viseme), std::end(out.viseme), 0);
  std::fill(std::begin(out.expression), std::end(out.expression), 0);
  if (frame.mask[1]) {
    const fap::Viseme& v = frame.viseme;
    const std::int32_t all[] = {v.select1, v.select2, v.blend, v.def};
    std::copy(std::begin(all), std::end(all), out.viseme);
  }
  if (frame.mask[2]) {
    const fap::Expression& e = frame.expression;
    const std::int32_t all[] = {e.select1,    e.intensity1, e.select2,
                                e.intensity2, e.init_face,  e.def};
    std::copy(std::begin(all), std::end(all), out.expression);
  }
  for (std::size_t group = 0; group < rules.size(); ++group) {
    out.group_rule[group] = std::uint8_t(rules[group]);
  }
  std::fill(std::begin(out.reserved), std::end(out.reserved), std::uint8_t{0});
}

}  // namespace

void put_frame(animeme_frame* out, const fap::Frame& frame, const fap::GroupRules& rules,
               const FrameTimes& times) {
  animeme_frame older;  // for callers that have less
  animeme_frame& made = out->size < sizeof older ? older : *out;
  made.flags = times.flags;
  made.number = frame.number;
  made.seconds = times.seconds;
  made.rate_num = times.rate.num;
  made.rate_den = times.rate.den;
  write_values(frame, rules, made);
  if (&made == &older) {
    put(out, out->size, older);
  } else if (out->size > sizeof older) {
    std::memset(reinterpret_cast<unsigned char*>(out) + sizeof older, 0, out->size - sizeof older);
  }
}

void put_frame(animeme_frame* out, const fap::Frame& frame, const fap::GroupRules& rules) {
  put_frame(out, frame, rules, FrameTimes{});
}

}  // namespace animeme::c

void animeme_frame_init(animeme_frame* frame, size_t size) { animeme::c::init(frame, size, {}); }

void animeme_body_init(animeme_body* body, size_t size) { animeme::c::init(body, size, {}); }

void animeme_free(void* memory) { std::free(memory); }
