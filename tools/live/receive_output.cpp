#include "tools/live/receive_output.h"

#include <unistd.h>

#include <filesystem>
#include <utility>

#include "fap/text.h"
#include "tools/files/files.h"
#include "tools/media/mux.h"

namespace animeme::live {

namespace {

std::string name_of(const std::string& output) {
  return output == "-" ? "live" : std::filesystem::path(output).stem().string();
}

std::optional<fap::FillOptions> shown_by(const FapOutputOptions& options) {
  if (options.coded) return std::nullopt;
  return fap::FillOptions{
      .keep_high_level = !options.fill, .expand = options.expand, .complete = options.fill};
}

}  // namespace

bool is_container_output(const std::string& output) {
  const std::string extension = tools::extension_of(output);
  return extension == ".mp4" || extension == ".mkv" || extension == ".ts";
}

bool is_fap_output(const std::string& output) {
  return output == "-" || tools::extension_of(output) == ".fap";
}

Result<void> check_folder(const std::string& output) {
  if (output == "-") return {};
  const std::filesystem::path folder = std::filesystem::path(output).parent_path();
  if (::access(folder.empty() ? "." : folder.c_str(), W_OK) == 0) return {};
  return make_error(Code::io, "cannot write into this folder").in_file(output);
}

FapOutput::FapOutput(const std::string& output, const FapOutputOptions& options)
    : output_(output), options_(options), frames_(options.gap, shown_by(options)) {
  options_.exact = options.exact || options.coded || options.gap == media::GapRule::skip;
}

std::string FapOutput::push(const media::LiveUnit& unit, std::uint32_t timescale, bool after_gap) {
  if (!wanted() || unit.track != media::LiveTrack::face) return {};
  const std::vector<fap::Frame> frames = frames_.push(unit, timescale, after_gap);
  clip_.rate = frames_.rate();
  if (output_ != "-") {
    clip_.frames.insert(clip_.frames.end(), frames.begin(), frames.end());
    return {};
  }
  std::string text;
  if (!begun_ && !frames.empty()) {
    text = fap::text_header(clip_.rate, name_of(output_), 0, {.whole_rate = !options_.exact});
    begun_ = true;
  }
  for (const fap::Frame& frame : frames) fap::append_text(text, frame);
  return text;
}

Result<void> FapOutput::finish() {
  if (output_ == "-") return {};
  clip_.name = name_of(output_);
  if (!options_.coded && !clip_.frames.empty()) {
    const fap::Mask all = clip_.frames.back().mask;
    for (fap::Frame& frame : clip_.frames) frame = fap::with_mask(frame, all);
  }
  return tools::write_file(output_, fap::write_text(clip_, {.whole_rate = !options_.exact}));
}

Result<void> write_recording(const std::string& output, const media::Recording& recording,
                             const tools::Talk& talk) {
  const bool face = !recording.face.units.empty(), sound = !recording.sound.packets.empty();
  if (tools::extension_of(output) == ".fba")
    return tools::write_file(output, fba::join_access_units(recording.face));
  media::MuxInput input;
  media::Pcm decoded;
  if (face) input.face = &recording.face;
  if (sound) input.encoded = &recording.sound;
  const bool opus = sound && recording.sound.format.codec == media::AudioCodec::opus;
  if (opus && tools::extension_of(output) == ".ts") {
    Result<media::Pcm> pcm = media::decode_audio(recording.sound);
    if (!pcm) return pcm.error();
    talk.say("the sound is coded again as aac, since .ts files take no opus");
    decoded = std::move(*pcm);
    input.encoded = nullptr;
    input.audio = &decoded;
  }
  const auto written = media::write_container(output, input);
  if (!written) return written.error().in_file(output);
  return {};
}

}  // namespace animeme::live
