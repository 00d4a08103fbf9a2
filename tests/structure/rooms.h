// The rooms of the source tree and the homes of the libraries of others, as tables. A new room
// gets a row here and a README; include_violations() of rules.h fails for a folder without a row.
#pragma once

#include <string_view>

namespace animeme::test {

/// A room is a folder and its detail/; folders that know each other are one room, with one row.
/// Names are separated by spaces, "x/*" are all folders below x/.
struct Room {
  std::string_view folders;  ///< or single files, if their row is above that of the folder
  /// The rooms it stands on: its files include these, and whatever those may include. They have
  /// rows above this one, so that nothing goes round in circles.
  std::string_view stands_on;
  bool installed = true;  ///< its headers, unless they are internal
};

inline constexpr Room kRooms[] = {
    {"fap", ""},
    {"fap/head", "fap"},
    {"fap/xml", "fap/head"},

    {"codec/syntax", "fap"},
    {"codec/decode", "codec/syntax"},
    {"codec/encode", "codec/decode"},
    {"codec/text", "codec/encode"},

    {"dam/maths", ""},
    {"dam/script", "fap"},
    {"dam/signal", "dam/script dam/maths"},
    {"dam/crossmap", "dam/signal"},
    {"dam/model", "dam/signal"},
    {"dam/corpus", "dam/model"},
    {"dam/speaking", "dam/model"},
    // A kind of model knows no other kind. Their list knows all.
    {"dam/kinds/animeme", "dam/corpus dam/speaking"},
    {"dam/kinds/refined", "dam/corpus dam/speaking"},
    {"dam/kinds/table", "dam/corpus dam/speaking"},
    {"dam/kinds/trajectory", "dam/corpus dam/speaking"},
    {"dam/kinds", "dam/kinds/*"},
    {"dam/evaluation", "dam/corpus dam/speaking"},
    {"dam/training", "dam/kinds"},

    {"conformance", "codec/text", false},

    {"tools/xml.h tools/json.h tools/text.h tools/exit_code.h tools/module.h", "fap", false},
    {"tools/files", "fap"},
    {"tools/programs", "tools/files tools/text.h"},
    {"tools/c", "codec/encode dam/speaking", false},  // installs one header, of C
    {"tools/npm", "tools/c", false},                  // the npm package
    {"tools/examples", "", false},                    // what users of libanimeme write
    {"tools/exchange", "codec/text dam/corpus dam/crossmap"},
    {"tools/render", "fap/head"},
    {"tools/scripts", "dam/script"},
    {"tools/gltf", "fap/head tools/files"},
    {"tools/media tools/media/live", "codec/decode fap/xml tools/files"},
    {"tools/media/late", "tools/media tools/exit_code.h tools/module.h", false},
    {"tools/mpi", "fap tools/module.h", false},
    {"tools/text", "dam/script"},
    {"tools/voice", "tools/text tools/media"},
    {"tools/speech", "dam/speaking codec/encode tools/voice tools/scripts tools/programs"},
    {"tools/viewer/rig", "fap/head", false},  // also the page's WebAssembly
    {"tools/viewer", "dam/script tools/render tools/viewer/rig tools/xml.h"},
    {"tools/web", "tools/media"},
    {"tools/webrtc", "tools/web tools/module.h"},
    {"tools/engines", "codec/encode tools/media"},
    {"tools/plot", "dam/evaluation tools/media tools/files tools/xml.h"},
    {"tools/sheet", "tools/plot tools/viewer"},
    {"tools/inspect", "codec/text dam/evaluation dam/training fap/head tools/xml.h"},
    {"tools/live", "tools/engines tools/speech tools/viewer tools/webrtc"},
    {"tools/serve", "tools/live tools/json.h tools/text.h", false},
    {"tools/studio", "fap/xml tools/gltf tools/plot tools/render"},
    {"tools/crossmap", "tools/exchange tools/studio"},
    {"tools/check", "conformance tools/programs tools/xml.h", false},
    {"tools/capture", "tools/exchange tools/speech", false},
    {"tools/batch", "conformance tools/programs tools/json.h tools/text.h tools/xml.h", false},
    {"tools/python", "tools/exchange tools/inspect tools/speech tools/studio", false},
    {"tools/commands",
     "tools/batch tools/capture tools/crossmap tools/exchange tools/inspect tools/live tools/serve "
     "tools/sheet tools/studio tools/check tools/mpi",
     false},
    {"tools/trackers/dlib", "", false},  // a program for dlib's users, no part of ours
    {"tools", "tools/commands", false},

    // Tests of a room may use its neighbours to make what they test.
    {"tests/*", "fap/* fap codec/* dam/* conformance tools/*", false},
};

/// A library of others. Headers that are installed show none; some show in no header at all.
struct Library {
  std::string_view name;
  std::string_view headers;  ///< what their names start with, separated by spaces
  std::string_view homes;    ///< the files and folders that may include them, with all below
  bool sources_only = false;
};

/// The first row that fits counts. What has neither '.' nor '/' is the C++ library and no row.
inline constexpr Library kLibraries[] = {
    {"libxml2", "libxml/", "fap/xml", true},
    {"Eigen", "Eigen/ unsupported/Eigen/", "dam tests/dam tests/bench"},
    {"FFmpeg", "libav libsw libpost", "tools/media tests/media"},
    {"espeak-ng", "espeak speak_lib", "tools/voice tests/voice"},
    {"pocketsphinx", "pocketsphinx sphinxbase", "tools/voice tests/voice"},
    {"speexdsp", "speex", "tools/voice"},
    {"ICU", "unicode/", "tools/text", true},
    {"expat", "expat", "tools/text", true},
    {"MeCab", "mecab", "tools/text", true},
    {"CLD2", "cld2/", "tools/text", true},
    {"Draco", "draco/", "tools/gltf", true},
    {"meshoptimizer", "meshoptimizer.h", "tools/gltf", true},
    {"libwebsockets", "libwebsockets", "tools/web/detail"},
    {"libanimeme", "animeme/animeme.h", "tools/examples tests"},
    {"zlib", "zlib", "tools/inspect tools/render tools/viewer tools/web/detail tests"},
    {"libpng, libjpeg, libwebp", "png jpeglib jerror webp/",
     "tools/gltf/detail tools/studio tests"},
    {"MPI", "mpi.h", "tools/mpi", true},
    {"GStreamer", "gst/", "tools/webrtc/detail"},
    {"libcurl", "curl/", "tools/webrtc/detail", true},
    {"pybind11", "pybind11/", "tools/python"},
    {"toml++", "toml++/", "tools/crossmap", true},
    {"nlohmann_json", "nlohmann/", "tools conformance tests"},
    {"CLI11", "CLI/", "tools/commands tools/main.cpp tests/bench"},
    {"GoogleTest", "gtest/ gmock/ benchmark/", "tests"},
    {"the system", "", "tools tests dam/maths/square_matrix.cpp"},  // pages of memory
};

}  // namespace animeme::test
