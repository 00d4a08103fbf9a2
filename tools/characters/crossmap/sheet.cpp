#include "tools/characters/crossmap/sheet.h"

#include <algorithm>
#include <cmath>

#include "tools/characters/crossmap/target_view_internal.h"
#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"

namespace animeme::crossmap {
namespace {

constexpr int kCell = 170, kPoints = 130, kText = 34, kColumns = 6, kMargin = 16, kRowGap = 12;
constexpr std::size_t kMostKeys = 48;
constexpr const char *kRest = "#b8b8b8", *kCaptured = "#0072b2", *kFitted = "#d55e00";

struct Spot {
  double x = 0, y = 0;
};

// Places in the plane of the face, as one sees a person: their left is on the right.
class Projection {
 public:
  explicit Projection(const Mapped& mapped)
      : dimensions_(mapped.capture.tracks[0].dimensions), neutral_(mapped.capture.neutral) {
    if (mapped.capture.face) {
      left_ = mapped.capture.face->axes.of[0];
      up_ = mapped.capture.face->axes.of[1];
    } else {
      left_ = {1, 0, 0};
      up_ = {0, dimensions_ == 2 ? -1.0 : 1.0, 0};  // rows of a picture count downwards
    }
    // All key shapes have to fit.
    const auto& keys = mapped.keys.shapes;
    const std::size_t size = neutral_.size();
    Spot low{1e300, 1e300}, high{-1e300, -1e300};
    for (std::size_t k = 0; k <= keys.names.size(); ++k) {
      const double* shape = k == 0 ? nullptr : &keys.values[(k - 1) * size];
      for (std::size_t p = 0; p < size / dimensions_; ++p) {
        const Spot s = flat(shape, p);
        low = {std::min(low.x, s.x), std::min(low.y, s.y)};
        high = {std::max(high.x, s.x), std::max(high.y, s.y)};
      }
    }
    const double wide = std::max({high.x - low.x, 1e-9}), tall = std::max(high.y - low.y, 1e-9);
    scale_ = std::min((kCell - 24) / wide, (kPoints - 20) / tall);
    middle_ = {(low.x + high.x) / 2, (low.y + high.y) / 2};
  }

  /// In a cell of kCell x kPoints; `shape`: displacement, nullptr: neutral.
  Spot at(const double* shape, std::size_t point) const {
    const Spot s = flat(shape, point);
    return {kCell / 2.0 + (s.x - middle_.x) * scale_, kPoints / 2.0 + (s.y - middle_.y) * scale_};
  }
  std::size_t points() const { return neutral_.size() / dimensions_; }

 private:
  Spot flat(const double* shape, std::size_t point) const {
    Spot out;
    for (std::size_t k = 0; k < dimensions_; ++k) {
      const std::size_t i = point * dimensions_ + k;
      const double place = neutral_[i] + (shape == nullptr ? 0 : shape[i]);
      out.x += left_[k] * place;
      out.y -= up_[k] * place;
    }
    return out;
  }

  std::size_t dimensions_;
  const std::vector<double>& neutral_;
  fap::Point left_{}, up_{};
  double scale_ = 1;
  Spot middle_;
};

std::string circle(Spot at, double radius, const char* fill, const char* stroke) {
  return tools::format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\" stroke=\"%s\"/>\n",
                       at.x, at.y, radius, fill, stroke);
}

// Captured points, the way they went from rest, and where `fitted` puts them (nullptr: not drawn).
std::string drawn(const Projection& projection, const double* shape, const double* fitted) {
  std::string out;
  for (std::size_t p = 0; p < projection.points(); ++p) {
    const Spot rest = projection.at(nullptr, p), at = projection.at(shape, p);
    out += circle(rest, 1.2, kRest, "none");
    if (!std::isfinite(at.x + at.y)) continue;
    out += tools::format(
        "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" "
        "stroke-width=\"0.7\"/>\n",
        rest.x, rest.y, at.x, at.y, kRest);
    out += circle(at, 2, kCaptured, "none");
    if (fitted != nullptr) out += circle(projection.at(fitted, p), 3.2, "none", kFitted);
  }
  return out;
}

// One column of the sheet: two lines of text, the points, the target.
std::string cell(std::size_t place, int top, int target, const std::string& title,
                 const std::string& subtitle, const std::string& points, const std::string& png) {
  const int x = kMargin + int(place % kColumns) * kCell;
  const int y = top + int(place / kColumns) * (kText + kPoints + target + kRowGap);
  std::string out = tools::format("<g transform=\"translate(%d %d)\">\n", x, y);
  out += tools::format("<text x=\"%d\" y=\"13\" font-weight=\"bold\">", kCell / 2) +
         tools::escape_xml(title) + "</text>\n";
  out += tools::format("<text x=\"%d\" y=\"27\" fill=\"#555\" font-size=\"10\">", kCell / 2) +
         tools::escape_xml(subtitle) + "</text>\n";
  out += tools::format("<g transform=\"translate(0 %d)\">\n", kText) + points + "</g>\n";
  if (!png.empty()) {
    out += tools::format("<image x=\"5\" y=\"%d\" width=\"%d\" height=\"%d\" href=\"",
                         kText + kPoints, kCell - 10, kCell - 10);
    out += png + "\"/>\n";
  }
  return out + "</g>\n";
}

// Frames of the first recording: the worst, and others evenly between its ends.
std::vector<std::size_t> frames_of(const Mapped& mapped) {
  const std::size_t frames = mapped.takes[0].blend.measured.size();
  std::size_t worst = 0;
  double most = -1;
  for (std::size_t r = 0; r < mapped.capture.regions.size(); ++r) {
    const RegionResidual residual = region_residual(mapped, 0, r);
    if (residual.worst <= most) continue;
    most = residual.worst;
    worst = residual.frame;
  }
  std::vector<std::size_t> out = {worst};
  for (std::size_t i = 1; i < std::size_t(kColumns); ++i) out.push_back(frames * i / kColumns);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

int rows_of(std::size_t cells) { return int((cells + kColumns - 1) / kColumns); }

}  // namespace

Result<std::string> sheet_svg(const Mapped& mapped) {
  Result<TargetView> view = TargetView::make(mapped.target, kCell * 2);
  if (!view) return view.error();
  const Projection projection(mapped);
  const dam::KeyShapes& keys = mapped.keys.shapes;
  const dam::PointTrack& track = mapped.capture.tracks[0];
  const std::size_t shapes = std::min(keys.names.size(), kMostKeys);
  const std::size_t controls = mapped.target.character.controls.size();
  const int target = view->draws() ? kCell : 0;
  const std::vector<std::size_t> frames = frames_of(mapped);
  const int first = kMargin + 26, row = kText + kPoints + target + kRowGap;
  const int second = first + rows_of(shapes) * row + 26;

  std::string body;
  const auto heading = [&](int y, const std::string& text) {
    body += tools::format("<text x=\"%d\" y=\"%d\" text-anchor=\"start\" font-size=\"15\">",
                          kMargin, y) +
            tools::escape_xml(text) + "</text>\n";
  };
  heading(kMargin + 12, "Key shapes: captured (blue, from rest in grey)" +
                            std::string(target > 0 ? " and on the target" : ""));
  for (std::size_t k = 0; k < shapes; ++k) {
    const KeySource& source = mapped.keys.sources[k];
    std::string from = tools::format("%s %.2f s", source.input.c_str(), source.seconds);
    if (source.share > 0) from += tools::format(", %.0f %%", 100 * source.share);
    const auto png = view->key(k, &mapped.target.values[k * controls]);
    if (!png) return png.error();
    body += cell(k, first, target, keys.names[k] + (mapped.target.adjusted[k] ? " (adjusted)" : ""),
                 from, drawn(projection, &keys.values[k * track.size()], nullptr), *png);
  }
  heading(second - 14, track.name + ": frames captured (blue), fitted (orange)" +
                           std::string(target > 0 ? ", on the target" : ""));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t frame = frames[i];
    const auto fitted = dam::blended(mapped.takes[0].blend, keys, frame);
    const auto png = view->values(&mapped.takes[0].retarget.signal.values[frame * controls]);
    if (!png) return png.error();
    double worst = 0;
    for (std::size_t r = 0; r < mapped.capture.regions.size(); ++r) {
      const double value =
          mapped.takes[0].blend.residuals[frame * mapped.capture.regions.size() + r];
      if (std::isfinite(value)) worst = std::max(worst, value);
    }
    body += cell(i, second, target, tools::format("%.2f s", track.rate.seconds(double(frame))),
                 tools::format("residual %.3g %s", worst, mapped.capture.unit.c_str()),
                 drawn(projection, track.frame(frame).data(), fitted.data()), *png);
  }
  const int width = 2 * kMargin + kColumns * kCell, height = second + row + kMargin;
  return tools::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
             "viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12\" "
             "text-anchor=\"middle\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
             width, height, width, height) +
         body + "</svg>\n";
}

}  // namespace animeme::crossmap
