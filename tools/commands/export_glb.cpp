#include "tools/commands/export_glb.h"

#include <filesystem>

#include "fap/rate_text.h"
#include "tools/commands/common.h"
#include "tools/gltf/glb.h"

namespace animeme::tools {

Result<void> export_glb(const std::string& path, const fap::Sequence& filled,
                        const GlbExport& options) {
  const Result<head::Head> head = studio::load_head(options.head, talk());
  if (!head) return head.error();
  ProgressLine progress("exporting");
  gltf::GlbOptions settings;
  settings.morphs = options.morphs == "fap" ? gltf::MorphNames::fap : gltf::MorphNames::arkit;
  settings.audio = options.audio;
  settings.normals = options.normals;
  settings.name = std::filesystem::path(path).stem().string();
  settings.progress = [&](double done) { progress.update(done); };
  Result<std::vector<std::uint8_t>> file =
      gltf::make_glb(*head, head::make_rig(*head), filled, settings);
  if (!file) return file.error();
  if (auto written = write_file(path, *file); !written) return written;
  progress.clear();
  say(path + ": head \"" + head->name + "\", " + std::to_string(filled.frames.size()) + " keys, " +
      fap::format_rate(filled.rate) + " a second, " + std::to_string(file->size() / 1000) + " kB");
  return {};
}

}  // namespace animeme::tools
