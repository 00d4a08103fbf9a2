#include "tools/app/commands/avatar_export.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "fap/head/people.h"
#include "fap/rate_text.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/report.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/programs/scratch_folder.h"
#include "tools/view/gltf/vrm_animation.h"

namespace animeme::tools {

namespace fs = std::filesystem;

namespace {

bool starts_with(const std::vector<std::uint8_t>& bytes, std::size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin() + std::ptrdiff_t(at));
}

// What the extension takes stays as it is; all else becomes WAV, and so does the sound of the clip
// itself, from where the face begins.
Result<gltf::FileSound> sound_of(const std::string& path, const AvatarClip& clip) {
  const bool of_clip = path == clip.path && clip.start != 0;
  const std::string ending = extension_of(path);
  if (!of_clip && (ending == ".wav" || ending == ".mp3")) {
    auto bytes = read_file(path);
    if (!bytes) return bytes.error();
    if (starts_with(*bytes, 0, "RIFF") && starts_with(*bytes, 8, "WAVE")) {
      return gltf::FileSound{"audio/wav", std::move(*bytes)};
    }
    if (starts_with(*bytes, 0, "ID3") || (bytes->size() > 1 && (*bytes)[0] == 0xFF)) {
      return gltf::FileSound{"audio/mpeg", std::move(*bytes)};
    }
  }
  auto pcm = media::read_audio(path);
  if (!pcm) return pcm.error();
  if (of_clip) {
    const auto shift = std::lround(clip.start * pcm->sample_rate);
    const std::vector<float>& all = pcm->samples;
    if (shift > 0) {
      pcm->samples.erase(all.begin(),
                         all.begin() + std::min<std::ptrdiff_t>(shift, std::ptrdiff_t(all.size())));
    } else {
      pcm->samples.insert(all.begin(), std::size_t(-shift), 0.0f);
    }
  }
  const auto folder = ScratchFolder::make();
  if (!folder) {
    return make_error(Code::io, "there is no folder for temporary files: set TMPDIR to one");
  }
  const std::string file = (*folder)->file("sound.wav");
  if (auto written = media::write_wav(file, *pcm); !written) return written.error();
  auto bytes = read_file(file);
  if (!bytes) return bytes.error();
  return gltf::FileSound{"audio/wav", std::move(*bytes)};
}

bool is_vrma(const std::string& path) { return extension_of(path) == ".vrma"; }

// Empty: nothing is wrong.
std::string problem_of_files(const AvatarExport& job) {
  const bool text = extension_of(job.head.head) == ".gltf";
  if (is_vrma(job.output)) {
    return job.sounds.empty() ? "" : "a .vrma has no sound: leave --sound out, or write a .vrm";
  }
  if (text != (extension_of(job.output) == ".gltf")) {
    return job.head.head + " stays the kind of file that it is: --output must end in " +
           (text ? ".gltf" : ".glb or .vrm (.vrma: the motion alone)") + ", not " + job.output;
  }
  std::error_code unknown;
  const auto folder_of = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, unknown).parent_path(), unknown);
  };
  if (text && folder_of(job.head.head) != folder_of(job.output)) {
    return "a .gltf names files beside it: write " + job.output + " into the folder of " +
           job.head.head;
  }
  if (!job.sounds.empty() && job.sounds.size() != job.clips.size()) {
    return "--sound names one sound for each clip: " + std::to_string(job.sounds.size()) + " for " +
           std::to_string(job.clips.size());
  }
  return {};
}

Result<void> write_parts(const std::string& path, const gltf::AnimatedFile& file) {
  OutputFile out(path);
  for (const std::span<const std::uint8_t> part :
       {std::span<const std::uint8_t>(file.front), file.middle,
        std::span<const std::uint8_t>(file.back)}) {
    if (auto done = out.write(part); !done) return done;
  }
  return out.publish();
}

void say_animations(const AvatarExport& job, const std::vector<gltf::NamedClip>& clips,
                    const std::vector<std::string>& names, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) say(job.head.head + ": " + note);
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const fap::Sequence& clip = clips[i].clip;
    say(job.output + ": animation \"" + names[i] + "\", " + std::to_string(clip.frames.size()) +
        " keys, " + fap::format_rate(clip.rate) + " a second" +
        (clips[i].sound ? ", with its sound" : ""));
  }
}

}  // namespace

bool is_gltf_name(const std::string& path) {
  const std::string kind = extension_of(path);
  return kind == ".glb" || kind == ".gltf" || kind == ".vrm";
}

bool is_head_output(const std::string& path) { return is_gltf_name(path) || is_vrma(path); }

bool moves_by_itself(const studio::HeadChoice& choice) {
  return choice.points.empty() && !head::names_person(choice.head) && is_gltf_name(choice.head);
}

std::string problem_of_built_head(const std::string& output, const studio::HeadChoice& choice) {
  if (extension_of(output) == ".glb") return {};
  return "--output must end in .glb for head " + choice.head + ", not " + output;
}

Result<int> export_avatar(const AvatarExport& job) {
  if (const std::string problem = problem_of_files(job); !problem.empty()) {
    return usage_error(problem);
  }
  std::vector<gltf::NamedClip> clips;
  for (std::size_t i = 0; i < job.clips.size(); ++i) {
    const AvatarClip& clip = job.clips[i];
    const bool pipe = clip.path == "-";
    clips.push_back({fs::path(pipe ? job.output : clip.path).stem().string(),
                     clip.clip,
                     {},
                     fs::path(job.audio).filename().string(),
                     clip.visemes});
    if (job.sounds.empty()) continue;
    auto sound = sound_of(job.sounds[i], clip);
    if (!sound) return sound.error();
    clips.back().sound = std::move(*sound);
    if (job.audio.empty()) clips.back().audio = fs::path(job.sounds[i]).filename().string();
  }
  ProgressLine progress("exporting");
  gltf::AnimateOptions options;
  options.progress = [&](double done) { progress.update(done); };
  if (const auto problem = studio::problem_of(job.head); !problem.empty()) {
    return usage_error(problem);
  }
  if (job.head.gain != "1") {
    const auto measured = studio::load_head(job.head);
    if (!measured) return measured.error();
    options.mouth_gain = measured->head.mouth_gain;
  }
  auto rules = gltf::shape_rules_of(job.head.shape_names, job.head.shape_table);
  if (!rules) return rules.error();
  options.reading.rules = std::move(*rules);
  const auto bytes = read_file(job.head.head, options.reading.limits.bytes);
  if (!bytes) return bytes.error();
  options.reading.load = gltf::files_of(fs::path(job.head.head).parent_path().string());
  if (is_vrma(job.output)) {
    const auto file = gltf::vrm_animation(*bytes, clips, options);
    if (!file) return file.error().in_file(job.head.head);
    if (auto written = write_file(job.output, file->file); !written) return written.error();
    progress.clear();
    say_animations(job, clips, file->names, file->notes);
    report_output(job.output,
                  std::to_string(file->expressions.size()) + " expressions, " +
                      std::to_string(file->file.size() / 1000) + " kB",
                  {{"animations", file->names},
                   {"expressions", file->expressions.size()},
                   {"bytes", file->file.size()}});
    return kOk;
  }
  const auto file = gltf::animate_file(*bytes, clips, options);
  if (!file) return file.error().in_file(job.head.head);
  if (auto written = write_parts(job.output, *file); !written) return written.error();
  progress.clear();
  say_animations(job, clips, file->names, file->notes);
  report_output(job.output,
                std::to_string(file->shapes) + " shapes on " + std::to_string(file->meshes) +
                    " meshes, " + std::to_string(file->bones) + " bones, " +
                    std::to_string(file->size() / 1000) + " kB",
                {{"animations", file->names},
                 {"shapes", file->shapes},
                 {"meshes", file->meshes},
                 {"bones", file->bones},
                 {"bytes", file->size()}});
  return kOk;
}

}  // namespace animeme::tools
