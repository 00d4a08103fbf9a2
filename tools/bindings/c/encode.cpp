// The encoders: live and of whole clips.

#include "codec/encode/encode.h"
#include "codec/encode/live.h"
#include "tools/bindings/c/c_internal.h"

using namespace animeme;

struct animeme_encoder {
  fba::LiveEncoder encoder;
  std::vector<std::uint8_t> bytes;  // given out last
  bool ended = false;
};

namespace animeme::c {

namespace {

animeme_encode_options encode_defaults(std::uint32_t preset) {
  const fba::EncodeOptions from = preset == ANIMEME_PRESET_FILE   ? fba::file_options()
                                  : preset == ANIMEME_PRESET_LIVE ? fba::live_options()
                                                                  : fba::EncodeOptions{};
  animeme_encode_options options{};
  options.rate_num = 25;
  options.rate_den = 1;
  options.fap_quant = from.fap_quant;
  options.bap_quant = from.bap_quant;
  options.start_codes = std::uint32_t(from.stream.plane_start_codes);
  if (preset == ANIMEME_PRESET_LIVE) {
    options.start_codes = std::uint32_t(fba::PlaneStartCodes::all);
  }
  options.intra_seconds = from.intra_seconds;
  options.leave_out = from.leave_out ? 1 : 0;
  options.extra_intra = from.extra_intra ? 1 : 0;
  options.skip_still = from.skip_still ? 1 : 0;
  options.verify = from.verify ? 1 : 0;
  return options;
}

animeme_status take_options(const animeme_encode_options* given, std::uint32_t preset,
                            animeme_encode_options& options, animeme_error* error) {
  options = encode_defaults(preset);
  if (given == nullptr) return ANIMEME_OK;
  if (!take(*given, options, encode_defaults(ANIMEME_PRESET_PLAIN))) {
    return invalid(error, "this is no animeme_encode_options, see animeme_encode_options_init()");
  }
  if (options.start_codes > 2) return invalid(error, "start_codes is neither 0, 1 nor 2");
  return ANIMEME_OK;
}

fba::EncodeOptions clip_options(const animeme_encode_options& from) {
  fba::EncodeOptions options;
  options.fap_quant = from.fap_quant;
  options.bap_quant = from.bap_quant;
  options.intra_seconds = from.intra_seconds;
  options.stream.plane_start_codes = fba::PlaneStartCodes(from.start_codes);
  options.leave_out = from.leave_out != 0;
  options.extra_intra = from.extra_intra != 0;
  options.skip_still = from.skip_still != 0;
  options.max_rms = from.max_rms;
  options.max_bits_per_second = from.max_bits_per_second;
  options.still_below = from.still_below;
  options.verify = from.verify != 0;
  return options;
}

fba::LiveOptions live_options_of(const animeme_encode_options& from) {
  fba::LiveOptions options;
  options.rate = fap::make_rate(from.rate_num, from.rate_den);
  options.fap_quant = from.fap_quant;
  options.bap_quant = from.bap_quant;
  options.intra_seconds = from.intra_seconds;
  options.plane_start_codes = fba::PlaneStartCodes(from.start_codes);
  options.verify = from.verify != 0;
  return options;
}

animeme_status take_body(const animeme_body& given, fba::BodyFrame& body, animeme_error* error) {
  animeme_body copy;
  if (!take(given, copy, animeme_body{})) {
    return invalid(error, "this is no animeme_body, see animeme_body_init()");
  }
  body = {};
  for (std::size_t i = 0; i < fba::kBapCount; ++i) {
    if (copy.present[i] == 0) continue;
    body.mask.set(i + 1);
    body.value[i + 1] = copy.value[i];
  }
  return ANIMEME_OK;
}

animeme_status write_frame(animeme_encoder& handle, const animeme_frame* frame,
                           const animeme_body* body, std::uint32_t skip, animeme_error* error) {
  fap::Frame taken;
  if (auto status = take_frame(frame, taken, nullptr, error); status != ANIMEME_OK) return status;
  fba::BodyFrame taken_body;
  if (body != nullptr) {
    if (auto status = take_body(*body, taken_body, error); status != ANIMEME_OK) return status;
  }
  const auto written =
      handle.encoder.write(taken, handle.bytes, skip, body == nullptr ? nullptr : &taken_body);
  if (!written) return fail(error, written.error());
  return ANIMEME_OK;
}

}  // namespace

}  // namespace animeme::c

void animeme_encode_options_init(animeme_encode_options* options, size_t size, uint32_t preset) {
  c::init(options, size, c::encode_defaults(preset));
}

animeme_status animeme_clip_encode(const animeme_clip* clip, const animeme_encode_options* options,
                                   uint8_t** bytes, size_t* size, animeme_error* error) {
  if (bytes == nullptr || size == nullptr) return c::invalid(error, "bytes or size is NULL");
  *bytes = nullptr;
  *size = 0;
  if (clip == nullptr) return c::invalid(error, "clip is NULL");
  return c::guarded(error, [&]() -> animeme_status {
    animeme_encode_options taken;
    const auto status = c::take_options(options, ANIMEME_PRESET_FILE, taken, error);
    if (status != ANIMEME_OK) return status;
    const auto stream = fba::encode(clip->sequence, c::clip_options(taken));
    if (!stream) return c::fail(error, stream.error());
    return c::give_copy(bytes, size, *stream);
  });
}

animeme_status animeme_encoder_new(const animeme_encode_options* options, animeme_encoder** encoder,
                                   animeme_error* error) {
  if (encoder == nullptr) return c::invalid(error, "encoder is NULL");
  *encoder = nullptr;
  return c::guarded(error, [&]() -> animeme_status {
    animeme_encode_options taken;
    const auto status = c::take_options(options, ANIMEME_PRESET_LIVE, taken, error);
    if (status != ANIMEME_OK) return status;
    const fba::LiveOptions live = c::live_options_of(taken);
    // The encoder checks its options with the first frame; check them here.
    if (auto tried = fba::LiveEncoder(live).write({}); !tried) return c::fail(error, tried.error());
    return c::give(encoder, std::make_unique<animeme_encoder>(
                                animeme_encoder{fba::LiveEncoder(live), {}, false}));
  });
}

void animeme_encoder_free(animeme_encoder* encoder) { delete encoder; }

animeme_status animeme_encoder_write(animeme_encoder* encoder, const animeme_frame* frame,
                                     const animeme_body* body, uint32_t skip, const uint8_t** bytes,
                                     size_t* size, int32_t* intra, animeme_error* error) {
  if (bytes == nullptr || size == nullptr) return c::invalid(error, "bytes or size is NULL");
  *bytes = nullptr;
  *size = 0;
  if (encoder == nullptr) return c::invalid(error, "encoder is NULL");
  if (encoder->ended) return c::invalid(error, "the stream has been ended");
  return c::guarded(error, [&]() -> animeme_status {
    const auto status = c::write_frame(*encoder, frame, body, skip, error);
    if (status != ANIMEME_OK) return status;
    *bytes = encoder->bytes.data();
    *size = encoder->bytes.size();
    if (intra != nullptr) *intra = encoder->encoder.intra() ? 1 : 0;
    return status;
  });
}

animeme_status animeme_encoder_finish(animeme_encoder* encoder, const uint8_t** bytes, size_t* size,
                                      animeme_error* error) {
  if (bytes == nullptr || size == nullptr) return c::invalid(error, "bytes or size is NULL");
  *bytes = nullptr;
  *size = 0;
  if (encoder == nullptr) return c::invalid(error, "encoder is NULL");
  if (encoder->ended) return c::invalid(error, "the stream has been ended");
  return c::guarded(error, [&]() -> animeme_status {
    encoder->bytes = encoder->encoder.finish();
    encoder->ended = true;
    *bytes = encoder->bytes.data();
    *size = encoder->bytes.size();
    return ANIMEME_OK;
  });
}

animeme_status animeme_encoder_shown(const animeme_encoder* encoder, animeme_frame* frame,
                                     animeme_error* error) {
  if (encoder == nullptr) return c::invalid(error, "encoder is NULL");
  if (!c::writable(frame, error)) return ANIMEME_INVALID_ARGUMENT;
  c::put_frame(frame, encoder->encoder.reconstruction());
  return ANIMEME_OK;
}
