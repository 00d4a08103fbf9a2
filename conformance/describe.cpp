#include "conformance/describe.h"

#include <algorithm>

#include "conformance/analyse.h"
#include "conformance/features.h"
#include "conformance/sha256.h"
#include "conformance/trial.h"
#include "fap/rate_text.h"
#include "fap/text.h"

namespace animeme::conformance {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Error wrong(const std::string& what) { return make_error(Code::internal, what); }

Result<void> check_face(const MadeCase& made, const fba::DecodedStream& got) {
  const fap::Sequence clip = fba::face_sequence(got);
  const auto found = made.content.find("face");
  if (found == made.content.end()) {
    if (clip.frames.empty()) return {};
    return wrong("the decoder returns faces; none were expected");
  }
  Result<fap::Sequence> expected = fap::read_text(found->second, {.keep_numbers = true});
  if (!expected) return expected.error();
  if (clip.frames.size() != expected->frames.size()) {
    return wrong("the decoder gives " + std::to_string(clip.frames.size()) +
                 " faces, expected are " + std::to_string(expected->frames.size()));
  }
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    if (clip.frames[i] != expected->frames[i]) {
      return wrong("the decoder differs in face " + std::to_string(i));
    }
  }
  return {};
}

Result<void> check_body(const MadeCase& made, const fba::DecodedStream& got) {
  const fba::BodySequence bodies = fba::body_sequence(got);
  const auto found = made.content.find("body");
  if (found == made.content.end()) {
    if (bodies.frames.empty()) return {};
    return wrong("the decoder returns bodies; none were expected");
  }
  Result<fba::BodySequence> expected = fba::read_bap_text(found->second);
  if (!expected) return expected.error();
  if (bodies.frames != expected->frames) return wrong("the decoder differs in the body");
  return {};
}

Result<void> check_errors(const Case& info, const std::vector<Error>& errors) {
  if (!info.damaged) {
    if (errors.empty()) return {};
    return wrong("the decoder says: " + errors.front().describe());
  }
  if (errors.empty()) return wrong("the decoder reports no error");
  for (const Error& error : errors) {
    const std::string kind = kind_of_error(error.code);
    if (std::find(info.errors.begin(), info.errors.end(), kind) == info.errors.end()) {
      return wrong("an error of another kind, " + kind + ": " + error.describe());
    }
  }
  return {};
}

Result<void> check_encoder(const MadeCase& made) {
  const auto text = [&](const char* role) -> std::string_view {
    const auto found = made.content.find(role);
    return found == made.content.end() ? std::string_view() : std::string_view(found->second);
  };
  if (text("parameters").empty()) return {};
  auto again =
      encode_again(made.info, text("parameters"), text("source_face"), text("source_body"));
  if (!again) return again.error();
  const auto stream = bytes_of(made.content.at("stream"));
  if (std::equal(again->begin(), again->end(), stream.begin(), stream.end())) return {};
  return wrong("the encoder writes other bytes from the parameters");
}

void describe_stream(const std::string& stream, const fba::DecodedStream& decoded, Case& info,
                     StreamFacts& facts) {
  facts = analyse(bytes_of(stream), decoded);
  info.features = facts.features;
  info.planes = facts.planes;
  info.intra_planes = facts.intra_planes;
  info.largest_alphabet = facts.largest_alphabet;
  info.largest_plane_bits = facts.largest_plane_bits;
  info.object = facts.face_planes > 0 && facts.body_planes > 0 ? "both"
                : facts.body_planes > 0                        ? "body"
                                                               : "face";
}

}  // namespace

Result<void> describe(MadeCase& made) {
  Case& info = made.info;
  const auto found = made.content.find("stream");
  if (found == made.content.end()) return make_error(Code::not_found, "there is no .fba file");
  const Trial trial = decode_all(bytes_of(found->second));
  if (auto ok = check_errors(info, trial.errors); !ok) return ok;
  if (auto ok = check_face(made, trial.stream); !ok) return ok;
  if (auto ok = check_body(made, trial.stream); !ok) return ok;
  if (!trial.stream.planes.empty()) {
    const std::string rate = fap::format_rate(trial.stream.rate);
    const auto expected = fap::parse_rate(info.rate);
    if (!info.rate.empty() && (!expected || *expected != trial.stream.rate)) {
      return wrong("the decoder says " + rate + " frames per second, expected are " + info.rate);
    }
    if (info.rate.empty()) info.rate = rate;
  }
  if (!info.damaged) {
    if (trial.stream.planes.empty()) return wrong("the stream has no plane");
    StreamFacts facts;
    describe_stream(found->second, trial.stream, info, facts);
    if (!facts.same_when_rewritten) {
      return wrong("the second encoder differs at bit " +
                   std::to_string(facts.first_difference_bit));
    }
    if (facts.ambiguous_bit >= 0) {
      return wrong("the plane at bit " + std::to_string(facts.ambiguous_bit) +
                   " can be mistaken for the end of the object");
    }
    set_switches(bytes_of(found->second), trial.stream, info);
    if (auto ok = check_encoder(made); !ok) return ok;
  }
  sort_features(info.features);
  for (const std::string& feature : info.features) {
    if (family_of(feature) == nullptr) return wrong("not in the vocabulary: " + feature);
  }
  info.sections = sections_of(info.features);
  info.certainty = std::string(1, certainty_of(info.features));
  info.files.clear();
  for (const std::string& role : file_roles()) {
    const auto file = made.content.find(role);
    if (file == made.content.end()) continue;
    info.files.push_back({role, info.name + extension_of_role(role, info.damaged),
                          sha256(file->second), std::int64_t(file->second.size())});
  }
  return {};
}

}  // namespace animeme::conformance
