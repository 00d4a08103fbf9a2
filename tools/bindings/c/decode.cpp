// The decoder.

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "tools/bindings/c/c_internal.h"

struct animeme_decoder {
  animeme::fba::Decoder decoder;
  std::int64_t warnings = 0;
  animeme_error last{};
};

namespace animeme::c {

fap::GroupRules rules_of(const fba::Plane& plane) {
  fap::GroupRules rules;
  rules.fill(fap::GroupRule::hold);
  return plane.face_settings ? fba::group_rules(*plane.face_settings) : rules;
}

namespace {

void put_plane(const fba::Plane& plane, animeme_frame* out) {
  FrameTimes times;
  times.flags = (plane.intra ? ANIMEME_FRAME_INTRA : 0) |
                (fba::has_face(plane.object_mask) ? ANIMEME_FRAME_FACE : 0) |
                (fba::has_body(plane.object_mask) ? ANIMEME_FRAME_BODY : 0);
  times.seconds = plane.seconds;
  times.rate = plane.rate;
  put_frame(out, plane.face, rules_of(plane), times);
}

void put_body(const fba::Plane& plane, animeme_body* out) {
  animeme_body made{};
  made.number = plane.number;
  if (plane.body) {
    for (std::size_t i = 0; i < fba::kBapCount; ++i) {
      made.present[i] = plane.body->mask[i + 1] ? 1 : 0;
      made.value[i] = plane.body->value[i + 1];
    }
  }
  put(out, out->size, made);
}

animeme_status no_decoder(animeme_error* error) { return invalid(error, "decoder is NULL"); }

animeme_status next_plane(animeme_decoder& handle, animeme_frame* frame, animeme_body* body,
                          animeme_error* error) {
  for (;;) {
    const Result<fba::Event> event = handle.decoder.next();
    if (!event) {
      const Code code = event.error().code;
      if (code == Code::need_data) return ANIMEME_NEED_DATA;
      if (code == Code::end_of_stream) return ANIMEME_END;
      return fail(error, event.error());
    }
    if (event->kind == fba::Event::Kind::warning) {
      ++handle.warnings;
      fail(&handle.last, error_at_bit(Code::syntax, event->text, event->bit));
      handle.last.status = ANIMEME_OK;
    } else if (event->kind == fba::Event::Kind::plane) {
      put_plane(event->plane, frame);
      if (body != nullptr) put_body(event->plane, body);
      return ANIMEME_OK;
    }
  }
}

}  // namespace

}  // namespace animeme::c

using namespace animeme;

animeme_status animeme_decoder_new(animeme_decoder** decoder, animeme_error* error) {
  if (decoder == nullptr) return c::no_decoder(error);
  *decoder = nullptr;
  return c::guarded(error, [&] { return c::give(decoder, std::make_unique<animeme_decoder>()); });
}

void animeme_decoder_free(animeme_decoder* decoder) { delete decoder; }

animeme_status animeme_decoder_reset(animeme_decoder* decoder, animeme_error* error) {
  if (decoder == nullptr) return c::no_decoder(error);
  return c::guarded(error, [&]() -> animeme_status {
    *decoder = {};
    return ANIMEME_OK;
  });
}

animeme_status animeme_decoder_push(animeme_decoder* decoder, const uint8_t* bytes, size_t size,
                                    animeme_error* error) {
  if (decoder == nullptr) return c::no_decoder(error);
  if (bytes == nullptr && size > 0) return c::invalid(error, "bytes is NULL");
  return c::guarded(error, [&]() -> animeme_status {
    if (size > 0) decoder->decoder.push({bytes, size});
    return ANIMEME_OK;
  });
}

animeme_status animeme_decoder_finish(animeme_decoder* decoder, animeme_error* error) {
  if (decoder == nullptr) return c::no_decoder(error);
  decoder->decoder.finish();
  return ANIMEME_OK;
}

animeme_status animeme_decoder_next(animeme_decoder* decoder, animeme_frame* frame,
                                    animeme_body* body, animeme_error* error) {
  if (decoder == nullptr) return c::no_decoder(error);
  if (!c::writable(frame, error)) return ANIMEME_INVALID_ARGUMENT;
  if (body != nullptr && body->size < c::kFirstSize) {
    return c::invalid(error, "this is no animeme_body, see animeme_body_init()");
  }
  return c::guarded(error, [&] { return c::next_plane(*decoder, frame, body, error); });
}

int64_t animeme_decoder_warnings(const animeme_decoder* decoder, animeme_error* last) {
  if (decoder == nullptr) return 0;
  if (last != nullptr && decoder->warnings > 0) *last = decoder->last;
  return decoder->warnings;
}
