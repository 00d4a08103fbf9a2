// 68 points of a face in a video as a table: ffmpeg decodes, dlib looks.
//
//     c++ -O2 -o track68 track68.cpp -ldlib -lblas -llapack
//     ./track68 clip.mp4 clip.csv
//
// Debian: libdlib-dev (the library), libdlib-data (the model), ffmpeg.
#include <dlib/image_processing.h>
#include <dlib/image_processing/frontal_face_detector.h>
#include <dlib/image_transforms.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr int kPoints = 68;
constexpr double kDetect =
    640;  // pixels of the longer side of the picture in which the face is looked for
constexpr double kPredict = 1280;  // the least in which its points are: dlib tells whole pixels
constexpr double kShift = 0.04;    // of the face's size, see points_of()
const char* const kModel = "/usr/share/dlib/shape_predictor_68_face_landmarks.dat";

[[noreturn]] void fail(const std::string& text, int code = 1) {
  std::cerr << "track68: " << text << "\n";
  std::exit(code);
}

// As one word of a shell.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string line_of(std::FILE* stream) {
  std::string line;
  for (int c = std::fgetc(stream); c != EOF && c != '\n'; c = std::fgetc(stream)) line += char(c);
  return line;
}

// Pictures as they are shown, upright and with square pixels, one after the other (PAM).
class Pictures {
 public:
  // `said`: a file for what ffmpeg says, with the times of the pictures (showinfo). Behind that all
  // are evenly apart, so that none is doubled or dropped.
  Pictures(const std::string& video, const std::string& said)
      : stream_(::popen(("exec ffmpeg -hide_banner -nostats -nostdin -i " + quoted(video) +
                         " -map 0:v:0 -vf showinfo,settb=1/25,setpts=N,scale=iw*sar:ih,setsar=1"
                         " -r 25 -f image2pipe -c:v pam -pix_fmt rgb24 - 2>" +
                         quoted(said))
                            .c_str(),
                        "r")) {
    if (stream_ == nullptr) fail("ffmpeg cannot be started");
  }
  bool next(dlib::array2d<dlib::rgb_pixel>& picture) {
    long width = 0, height = 0;
    for (std::string line = line_of(stream_); line != "ENDHDR"; line = line_of(stream_)) {
      if (line.empty()) return false;
      std::sscanf(line.c_str(), "WIDTH %ld", &width);
      std::sscanf(line.c_str(), "HEIGHT %ld", &height);
    }
    picture.set_size(height, width);
    for (long y = 0; y < height; ++y) {
      if (std::fread(&picture[y][0], 3, std::size_t(width), stream_) < std::size_t(width))
        return false;
    }
    return true;
  }
  bool close() { return ::pclose(stream_) == 0; }

 private:
  std::FILE* stream_;
};

// Times of the pictures by what showinfo said; `last` is the last line of all others.
std::vector<double> times_in(const std::string& said, std::string& last) {
  std::vector<double> times;
  std::ifstream file(said);
  for (std::string line; std::getline(file, line);) {
    const std::size_t at = line.find("pts_time:");
    if (line.find("showinfo") == line.npos) {
      last = line;
    } else if (at != line.npos) {
      times.push_back(std::strtod(line.c_str() + at + 9, nullptr));
    }
  }
  return times;
}

dlib::array2d<dlib::rgb_pixel> scaled(const dlib::array2d<dlib::rgb_pixel>& picture, double scale) {
  dlib::array2d<dlib::rgb_pixel> out(std::lround(picture.nr() * scale),
                                     std::lround(picture.nc() * scale));
  dlib::resize_image(picture, out, dlib::interpolate_bilinear());
  return out;
}

// The largest face of a picture, in its pixels; empty: none.
dlib::drectangle face_in(const dlib::array2d<dlib::rgb_pixel>& picture,
                         dlib::frontal_face_detector& detector) {
  const double scale = kDetect / double(std::max(picture.nc(), picture.nr()));
  dlib::drectangle largest;
  for (const dlib::rectangle& face : detector(scaled(picture, scale))) {
    if (face.area() > largest.area()) largest = face;
  }
  return {largest.left() / scale, largest.top() / scale, largest.right() / scale,
          largest.bottom() / scale};
}

// ",x,y" of each point in pixels of the picture. The detector's box goes by steps, and the points
// go with it: the mean over nine boxes around it is steadier.
std::string points_of(const dlib::array2d<dlib::rgb_pixel>& picture, const dlib::drectangle& face,
                      const dlib::shape_predictor& predictor) {
  const double scale = std::max(1.0, kPredict / double(std::max(picture.nc(), picture.nr())));
  const dlib::array2d<dlib::rgb_pixel> large = scaled(picture, scale);
  std::vector<dlib::dpoint> sum(kPoints);
  for (int k = 0; k < 9; ++k) {
    const dlib::dpoint by(kShift * (k % 3 - 1) * face.width(),
                          kShift * (k / 3 - 1) * face.height());
    const dlib::drectangle box = translate_rect(face, by);
    const auto shape = predictor(
        large,
        dlib::rectangle(std::lround(box.left() * scale), std::lround(box.top() * scale),
                        std::lround(box.right() * scale), std::lround(box.bottom() * scale)));
    for (int i = 0; i < kPoints; ++i)
      sum[std::size_t(i)] += dlib::dpoint(shape.part(std::size_t(i)));
  }
  std::ostringstream row;
  row << std::fixed << std::setprecision(3);
  for (const dlib::dpoint& point : sum)
    row << ',' << point.x() / 9 / scale << ',' << point.y() / 9 / scale;
  return row.str();
}

void write(const std::string& path, const std::vector<double>& times,
           const std::vector<std::string>& rows) {
  const std::string part = path + ".part";
  std::ofstream table(part);
  table << "time_s,confidence";
  for (int i = 0; i < kPoints; ++i) table << ",x_" << i << ",y_" << i;
  table << std::fixed << '\n';
  for (std::size_t i = 0; i < rows.size(); ++i) {
    table << times[i] - times[0]
          << (rows[i].empty() ? ",0" + std::string(2 * kPoints, ',') : ",1" + rows[i]) << '\n';
  }
  table.close();
  if (!table || std::rename(part.c_str(), path.c_str()) != 0) fail(path + " cannot be written");
}

}  // namespace

int main(int count, char** words) {
  std::vector<std::string> arguments(words + 1, words + count);
  std::string model = kModel;
  if (arguments.size() == 4 && arguments[0] == "--model") {
    model = arguments[1];
    arguments.erase(arguments.begin(), arguments.begin() + 2);
  }
  if (arguments.size() != 2) fail("usage: track68 [--model MODEL.dat] VIDEO TABLE.csv", 2);
  const std::string said = arguments[1] + ".said";
  try {
    dlib::frontal_face_detector detector = dlib::get_frontal_face_detector();
    dlib::shape_predictor predictor;
    dlib::deserialize(model) >> predictor;
    Pictures pictures(arguments[0], said);
    std::vector<std::string> rows;
    std::size_t found = 0;
    for (dlib::array2d<dlib::rgb_pixel> picture; pictures.next(picture);) {
      const dlib::drectangle face = face_in(picture, detector);
      rows.emplace_back();
      if (face.area() <= 0) continue;
      rows.back() = points_of(picture, face, predictor);
      ++found;
    }
    const bool good = pictures.close();
    std::string last;
    const std::vector<double> times = times_in(said, last);
    ::unlink(said.c_str());
    if (!good) fail("ffmpeg: " + last);
    if (found == 0)
      fail("no face was found in any of " + std::to_string(rows.size()) + " pictures");
    if (times.size() < rows.size()) fail("ffmpeg does not report the times of all frames");
    write(arguments[1], times, rows);
    std::cerr << "track68: a face in " << found << " of " << rows.size() << " pictures\n";
  } catch (const std::exception& error) {
    fail(std::string(error.what()) + " (" + model + "; Debian package libdlib-data)");
  }
}
