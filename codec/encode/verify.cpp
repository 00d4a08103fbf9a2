#include <cstdlib>
#include <string>

#include "codec/decode/decoder.h"
#include "codec/encode/clip_planes_internal.h"

namespace animeme::fba::internal {

namespace {

Error verify_error(std::int64_t number, const std::string& what) {
  return make_error(Code::internal, "the stream does not decode to what was coded: frame " +
                                        std::to_string(number) + ", " + what);
}

// FAP 1 and 2 as given; what has a scale within half a quantiser step.
bool high_level_agrees(const fap::Frame& got, const fap::Frame& want, const ClipData& clip,
                       int fap_quant) {
  if (got.mask[1] != clip.has_viseme || got.mask[2] != clip.has_expression) return false;
  const auto near = [&](std::int32_t& value, std::int32_t other) {
    const bool is = std::abs(value - other) <= fap_scale(fap_quant) / 2;
    value = other;
    return is;
  };
  fap::Viseme viseme = got.viseme;
  fap::Expression expression = got.expression;
  if (clip.has_viseme && (!near(viseme.blend, want.viseme.blend) || viseme != want.viseme)) {
    return false;
  }
  return !clip.has_expression ||
         (near(expression.intensity1, want.expression.intensity1) &&
          near(expression.intensity2, want.expression.intensity2) && expression == want.expression);
}

}  // namespace

Result<void> verify(const std::vector<std::uint8_t>& stream, const ClipData& clip,
                    const Decision& decision) {
  Decoder decoder;
  decoder.push(stream);
  decoder.finish();
  ClipPlanes expected(clip, decision);
  for (std::size_t plane = 0; plane < clip.planes(); ++plane) {
    Result<Event> event = decoder.next();
    if (event && event->kind == Event::Kind::info) event = decoder.next();
    const std::int64_t number = clip.number[plane];
    if (!event) return verify_error(number, event.error().describe());
    if (event->kind != Event::Kind::plane) return verify_error(number, event->text);
    expected.load(plane);
    if (event->plane.number != number - clip.number.front()) {
      return verify_error(number, "its number");
    }
    if (!high_level_agrees(event->plane.face, expected.face(), clip, expected.fap_quant(plane))) {
      return verify_error(number, "FAP 1 or 2");
    }
    for (std::size_t i = 0; i < clip.channels.size(); ++i) {
      const Channel& channel = clip.channels[i];
      if (decision.rows[i].role != Role::coded) continue;
      const std::size_t n = std::size_t(channel.number);
      const bool same = channel.body ? event->plane.body->mask[n] &&
                                           event->plane.body->value[n] == expected.body().value[n]
                                     : event->plane.face.mask[n] &&
                                           event->plane.face.value[n] == expected.face().value[n];
      if (!same) {
        return verify_error(number, (channel.body ? "BAP " : "FAP ") + std::to_string(n));
      }
    }
  }
  const Result<Event> end = decoder.next();
  if (end || end.error().code != Code::end_of_stream) {
    return verify_error(clip.number.back(), "something follows");
  }
  return {};
}

}  // namespace animeme::fba::internal
