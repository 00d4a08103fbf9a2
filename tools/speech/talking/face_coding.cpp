#include <cstddef>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "tools/speech/talking/face_coding_internal.h"

namespace animeme::speech {

namespace {

// What is still to be said is not known, so the level is the one that allows the higher rate.
constexpr std::uint8_t kSimpleFaceLevel2 = 0x62;
constexpr std::size_t kProfileByte = 4;  // of the configuration

// How fast a face moves each FAP, on an example: the phones of its model, each between open mouths,
// at a quick pace.
fba::PredictiveRanges ranges_of_face(const dam::Model& model, int fap_quant, TalkingFace face) {
  constexpr double kSeconds = 0.08;
  dam::Script script;
  const auto add = [&script](const std::string& label) {
    const double start = script.duration();
    script.phones.push_back({start, start + kSeconds, label, {}});
  };
  for (const dam::PhoneModel& phone : model.phones) {
    add("AA");
    add(phone.label);
  }
  fap::Sequence clip;
  if (!face.say(script)) return {};
  while (face.speaking()) {
    const Result<fap::Frame> frame = face.next();
    if (!frame) return {};
    clip.frames.push_back(*frame);
  }
  return fba::ranges_of(clip, fap_quant);
}

}  // namespace

fba::LiveOptions coding_of_face(const dam::Model& model, const TalkingFace& face,
                                const fap::Rate& rate, int fap_quant, double intra_seconds,
                                double delay) {
  fba::LiveOptions coding;
  coding.rate = rate;
  coding.fap_quant = fap_quant;
  coding.intra_seconds = intra_seconds;
  coding.delay_seconds = delay;
  // All FAPs that occur: those of a mood join, with an intra plane, when it is first shown. At rest
  // they would cost a third of the stream.
  coding.ranges = ranges_of_face(model, fap_quant, face);
  coding.mirror = true;  // most of the time lids, eyes, cheeks and nose move alike
  return coding;
}

Result<FaceShape> shape_of_face(const fba::LiveOptions& options, TalkingFace face) {
  const Result<fap::Frame> frame = face.next();
  if (!frame) return frame.error();
  fba::LiveEncoder encoder(options);
  Result<std::vector<std::uint8_t>> stream = encoder.write(*frame);
  if (!stream) return stream.error();
  const auto end = encoder.finish();
  stream->insert(stream->end(), end.begin(), end.end());
  const Result<fba::AccessUnits> units = fba::split_access_units(*stream);
  if (!units) return units.error();
  FaceShape shape;
  shape.info.face_config = units->config;
  shape.info.face_config[kProfileByte] = kSimpleFaceLevel2;
  shape.info.visual_profile = kSimpleFaceLevel2;
  shape.info.timescale = units->timescale;
  shape.frame_ticks = units->units.front().duration;
  return shape;
}

}  // namespace animeme::speech
