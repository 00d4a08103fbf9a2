#include <algorithm>
#include <string_view>

#include "tools/formats/exchange/capture_table.h"
#include "tools/formats/exchange/file_kind.h"

namespace animeme::exchange {

namespace {

struct Sign {
  std::size_t at;
  std::string_view bytes;
  const char* what;
};

using namespace std::string_view_literals;

constexpr const char* kVideo =
    "this is not text; if it is a video, run a tracker on it: --tracker "
    "\"command {in} {out}\" (tools/characters/trackers has two)";

// What a file begins with. Longer signs stand before those that they begin with.
constexpr Sign kSigns[] = {
    {0, "\x1f\x8b"sv, "this is a compressed file; unpack it with gunzip first"},
    {0, "BZh"sv, "this is a compressed file; unpack it with bunzip2 first"},
    {0,
     "\xFD"
     "7zXZ"sv,
     "this is a compressed file; unpack it with unxz first"},
    {0, "(\xB5/\xFD"sv, "this is a compressed file; unpack it with unzstd first"},
    {0, "PK\x03\x04"sv,
     "this is a spreadsheet (.xlsx, .ods), an archive (.zip, .npz) or similar; save the table as "
     "CSV, or unpack it"},
    {0, "\xD0\xCF\x11\xE0"sv, "this is a spreadsheet (.xls); save the table as CSV"},
    {0, "\x93NUMPY"sv,
     "this is a numpy array; write it as a table with numpy.savetxt, header x_0,y_0 ..."},
    {0, "\x89HDF\r\n"sv, "this is HDF5 (.h5, .mat); write the points as CSV"},
    {0, "MATLAB 5.0"sv, "this is a MATLAB file; write the points as CSV (writematrix)"},
    {0, "PAR1"sv, "this is Parquet; write it as CSV"},
    {0, "\x80\x03"sv, "this is a Python pickle; write the points as CSV or JSON"},
    {0, "\x80\x04"sv, "this is a Python pickle; write the points as CSV or JSON"},
    {0, "\x80\x05"sv, "this is a Python pickle; write the points as CSV or JSON"},
    {0, "\x89PNG"sv, "this is a picture; a capture is a tracker's table for a video"},
    {0, "\xFF\xD8\xFF"sv, "this is a picture; a capture is a tracker's table for a video"},
    {0, "%PDF"sv, "this is a PDF; a capture is a tracker's table for a video"},
    {0, "Kaydara FBX"sv,
     "this is a scene (FBX); export the curves of the blend shapes as CSV, or the points"},
    {0, "; FBX"sv,
     "this is a scene (FBX); export the curves of the blend shapes as CSV, or the points"},
    {0, "glTF"sv, "this is a head (glTF); use it with --head of other commands"},
    {0, "HIERARCHY"sv, "this is skeletal motion (BVH); it has no facial points"},
    {0, "ANIMEDAM"sv, "this is a trained model; use it with animeme speak --model"},
    {0, "version: 1"sv,
     "these are the points of one picture (.pts); a table with a row for each picture of the video "
     "is needed"},
    {0, "\xFF\xFE"sv, "this is text in UTF-16; save it as UTF-8"},
    {0, "\xFE\xFF"sv, "this is text in UTF-16; save it as UTF-8"},
    {0, "File type = \"ooTextFile\""sv,
     "this is a TextGrid with the transcript; the capture of the face is another file"},
    {0, "WEBVTT"sv, "these are subtitles; the capture of the face is another file"},
    {0, "<"sv, "this is XML or HTML; a table (CSV) or a JSON of landmarks is needed"},
};

}  // namespace

std::string foreign_sign(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const Sign& sign : kSigns) {
    if (text.substr(std::min(sign.at, text.size())).starts_with(sign.bytes)) return sign.what;
  }
  return {};
}

std::string foreign_file(std::span<const std::uint8_t> bytes) {
  if (std::string what = foreign_sign(bytes); !what.empty()) return what;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  switch (kind_of(bytes)) {
    case FileKind::fba_stream:
      return "this is already an FBA stream; animeme decode converts it to text";
    case FileKind::fap_text:
      // A table without a header is no FAP text: the first line of that has spaces between fields.
      if (text.substr(0, text.find('\n')).find_first_of(",;\t") != std::string_view::npos)
        return {};
      return "these are already FAPs; use them directly, for example with animeme encode";
    case FileKind::bap_text:
      if (text.substr(0, text.find('\n')).find_first_of(",;\t") != std::string_view::npos)
        return {};
      return "these are body animation parameters (BAP), not a face";
    case FileKind::media:
      return kVideo;
    default:
      return {};
  }
}

}  // namespace animeme::exchange
