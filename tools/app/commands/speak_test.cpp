#include "tools/app/commands/speak_test.h"

#include <cstdio>

#include "fap/head/rig.h"
#include "tools/app/commands/common.h"
#include "tools/formats/common/json.h"
#include "tools/view/studio/head_view.h"
#include "tools/view/studio/picture_file.h"
#include "tools/view/studio/speak_check.h"

namespace animeme::tools {
namespace {

constexpr int kPictureSize = 256;
constexpr int kColumns = 5;

Result<void> draw_visemes(const studio::HeadChoice& choice, const std::string& path) {
  const auto frames = studio::shape_frames("visemes");
  if (!frames) return frames.error();
  const studio::HeadLook look{
      .head = choice, .zoom = 1.4, .width = kPictureSize, .height = kPictureSize};
  const auto sheet = studio::draw_sheet(look, *frames, kColumns);
  if (!sheet) return sheet.error();
  const auto file = studio::picture_of(*sheet, extension_of(path));
  if (!file) return file.error();
  return write_file(path, *file);
}

void print_row(const studio::SpeakRow& row) {
  std::printf("  %-14s %-26s %7.2f  %-8s (%s %g)\n", row.sound.c_str(), row.what.c_str(), row.value,
              row.ok() ? "ok" : "short of", row.at_most ? "at most" : "at least", row.limit);
}

}  // namespace

Result<int> test_speech(const studio::HeadChoice& choice, const std::string& sheet, bool json) {
  if (!sheet.empty() && !studio::is_picture(extension_of(sheet))) {
    return usage_error("--speak-test draws its sheet as .png, .jpg or .webp, not " + sheet);
  }
  const Result<studio::LoadedHead> loaded = studio::load_head(choice);
  if (!loaded) return loaded.error();
  const head::Head& head = loaded->head;
  const auto rows = studio::check_speech(head, head::make_rig(head));
  if (!rows) return rows.error().in_file(choice.head);
  if (!sheet.empty()) {
    if (auto drawn = draw_visemes(choice, sheet); !drawn) return drawn.error();
  }
  if (!json) {
    std::printf("%s, as if its eyes were %g mm apart, lips opened %.2f times as wide (--gain)\n",
                head.name.c_str(), studio::kEyesApart, head.mouth_gain);
    for (const studio::SpeakRow& row : *rows) print_row(row);
    return kOk;
  }
  Json list = Json::array();
  for (const studio::SpeakRow& row : *rows) {
    list.push_back({{"sound", row.sound},
                    {"measure", row.what},
                    {"value", row.value},
                    {row.at_most ? "at_most" : "at_least", row.limit},
                    {"ok", row.ok()}});
  }
  const Json all = {{"name", head.name},
                    {"eyes_apart_mm", studio::kEyesApart},
                    {"gain", head.mouth_gain},
                    {"rows", list}};
  std::printf("%s\n", pretty(all).c_str());
  return kOk;
}

}  // namespace animeme::tools
