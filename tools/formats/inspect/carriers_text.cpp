#include <algorithm>
#include <cmath>

#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/carriers_internal.h"

namespace animeme::inspect {

namespace {

// What the last column compares with: FBA at the error that was asked for, as a stream or a file.
const Carrier* measure_of(const ClipCarriers& clip, const Carrier& by) {
  const char* name = by.headers == Headers::none ? kFbaFile : kFbaLive;
  const auto found = std::find_if(clip.carriers.begin(), clip.carriers.end(),
                                  [&](const auto& c) { return c.fitted && c.name == name; });
  return found == clip.carriers.end() ? nullptr : &*found;
}

double times(const ClipCarriers& clip, const Carrier& by) {
  const Carrier* one = measure_of(clip, by);
  return one == nullptr ? 0 : clip.kbps(by, true) / clip.kbps(*one, true);
}

tools::Json carrier_json(const ClipCarriers& clip, const Carrier& by) {
  return {{"carrier", by.name},
          {"setting", by.setting},
          {"fitted", by.fitted},
          {"headers", headers_name(by.headers)},
          {"error_mm", by.error},
          {"messages", by.messages},
          {"bytes", by.bytes},
          {"bytes_with_headers", by.bytes + by.bytes_of_headers},
          {"kbit_per_s", clip.kbps(by, false)},
          {"kbit_per_s_with_headers", clip.kbps(by, true)},
          {"times_fba", times(clip, by)}};
}

tools::Json carried_json(const ClipCarriers& clip) {
  return {{"clip", clip.name},
          {"frames", clip.frames},
          {"rate", clip.rate},
          {"seconds", clip.seconds},
          {"points", clip.points},
          {"shapes_error_mm", clip.shapes_error},
          {"carriers", tools::json_list(clip.carriers, [&](const Carrier& by) {
             return carrier_json(clip, by);
           })}};
}

}  // namespace

std::string carriers_text(const ClipCarriers& clip, const CarrierOptions& options) {
  std::string text = tools::format(
      "%s: %zu frames at %.4g a second; errors over %zu moving points of the skin;\n"
      "the error of the fit with 52 shapes is %.3f mm. * chosen for %g mm RMS (! missed)\n"
      "%-43s %-12s %8s %9s %8s %8s %7s  %s\n",
      clip.name.c_str(), clip.frames, clip.rate, clip.points, clip.shapes_error, options.error,
      "carrier", "", "error mm", "bytes", "kbit/s", "on wire", "x FBA", "headers");
  for (const Carrier& by : clip.carriers) {
    text += tools::format("%-43s %-12s %7.4f%s %9.1f %8.2f %8.2f %7.2f  %s\n", by.name.c_str(),
                          by.setting.c_str(), by.error,
                          !by.fitted                  ? " "
                          : by.error <= options.error ? "*"
                                                      : "!",
                          double(by.bytes) / double(by.messages), clip.kbps(by, false),
                          clip.kbps(by, true), times(clip, by),
                          std::string(headers_name(by.headers)).c_str());
  }
  return text;
}

ClipCarriers carriers_of_all(const std::vector<ClipCarriers>& clips) {
  ClipCarriers all = clips.front();
  all.name = tools::format("all %zu clips", clips.size());
  const auto squares = [](double error, const ClipCarriers& clip) {
    return error * error * double(clip.frames);
  };
  all.frames = all.points = 0;
  all.seconds = 0;
  double shapes = 0;
  for (const ClipCarriers& clip : clips) {
    all.frames += clip.frames;
    all.seconds += clip.seconds;
    all.points = std::max(all.points, clip.points);
    all.rate = std::max(all.rate, clip.rate);
    shapes += squares(clip.shapes_error, clip);
  }
  all.shapes_error = std::sqrt(shapes / double(all.frames));
  for (std::size_t i = 0; i < all.carriers.size(); ++i) {
    Carrier& sum = all.carriers[i];
    const bool fitted = sum.fitted;
    sum.messages = sum.bytes = sum.bytes_of_headers = 0;
    double error = 0;
    for (const ClipCarriers& clip : clips) {
      const Carrier& by = clip.carriers[i];
      sum.messages += by.messages;
      sum.bytes += by.bytes;
      sum.bytes_of_headers += by.bytes_of_headers;
      error += squares(by.error, clip);
      if (fitted && by.setting != clips.front().carriers[i].setting) sum.setting = "each its own";
    }
    sum.error = std::sqrt(error / double(all.frames));
  }
  return all;
}

std::string carriers_json(const std::vector<ClipCarriers>& clips, const CarrierOptions& options) {
  tools::Json json{{"fap_quant", options.quant},
                   {"error_mm", options.error},
                   {"clips", tools::json_list(clips, carried_json)}};
  if (clips.size() > 1) json["all"] = carried_json(carriers_of_all(clips));
  return tools::pretty(json);
}

}  // namespace animeme::inspect
