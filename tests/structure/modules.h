// The modules of the source tree and where third-party libraries may be used, as tables. A new
// module gets a row here and a README; include_violations() of rules.h fails for a folder without a
// row.
#pragma once

#include <string_view>

namespace animeme::test {

/// A module is a folder and its detail/. Folders that include each other are one module, with one
/// row. Names are separated by spaces, "x/*" are all folders below x/.
struct Module {
  std::string_view folders;  ///< or single files, if their row is above that of the folder
  /// The modules it depends on: its files may include these, and whatever those may include. They
  /// have rows above this one, so that nothing goes round in circles.
  std::string_view depends_on;
  bool installed = true;  ///< its headers, unless they are internal
};

inline constexpr Module kModules[] = {
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
    {"dam/behaviour", "dam/script dam/maths"},
    {"dam/speaking", "dam/model dam/behaviour"},
    {"dam/performance", "dam/speaking"},
    // A kind of model knows no other kind. Their list knows all.
    {"dam/kinds/animeme", "dam/corpus dam/speaking"},
    {"dam/kinds/refined", "dam/corpus dam/speaking"},
    {"dam/kinds/table", "dam/corpus dam/speaking"},
    {"dam/kinds/trajectory", "dam/corpus dam/speaking"},
    {"dam/kinds", "dam/kinds/*"},
    {"dam/evaluation", "dam/corpus dam/speaking"},
    {"dam/training", "dam/kinds"},

    {"conformance", "codec/text", false},

    {"tools/formats/common", "fap", false},
    {"tools/formats/files", "fap"},
    {"tools/formats/programs", "tools/formats/files tools/formats/common"},
    {"tools/bindings/c", "codec/encode dam/speaking", false},  // installs one header, of C
    {"tools/bindings/npm", "tools/bindings/c", false},         // the npm package
    {"tools/bindings/examples", "", false},                    // what users of libanimeme write
    {"tools/formats/exchange", "codec/text dam/corpus dam/crossmap tools/formats/common"},
    {"tools/view/render", "fap/head"},
    {"tools/formats/scripts", "dam/script tools/formats/common"},
    {"tools/view/gltf", "fap/head tools/formats/files tools/formats/common"},
    {"tools/formats/media tools/formats/media/live "
     "tools/formats/media/rtp tools/formats/media/detail/*",
     "codec/decode fap/xml tools/formats/files"},
    {"tools/app/mpi", "fap tools/formats/common", false},
    {"tools/speech/text", "dam/script"},
    {"tools/speech/voice", "dam/behaviour tools/speech/text tools/formats/media"},
    {"tools/speech/talking",
     "dam/performance codec/encode tools/speech/voice tools/formats/scripts "
     "tools/formats/programs"},
    {"tools/view/viewer/rig", "fap/head", false},  // also the page's WebAssembly
    {"tools/view/viewer",
     "dam/script tools/view/render tools/view/viewer/rig tools/formats/common"},
    {"tools/live/web", "codec/encode tools/formats/media tools/formats/common"},
    {"tools/live/webrtc", "tools/live/web tools/formats/common"},
    {"tools/live/engines", "codec/encode tools/formats/media"},
    {"tools/view/plot",
     "dam/evaluation tools/formats/media tools/formats/files tools/formats/common"},
    {"tools/view/sheet", "tools/view/plot tools/view/viewer"},
    {"tools/formats/inspect",
     "codec/text dam/evaluation dam/training fap/head tools/formats/common"},
    {"tools/live/sessions",
     "tools/live/engines tools/speech/talking tools/view/viewer tools/live/webrtc"},
    {"tools/live/serve", "tools/live/sessions tools/formats/common conformance", false},
    {"tools/view/studio", "fap/xml tools/view/gltf tools/view/plot tools/view/render"},
    {"tools/characters/crossmap", "tools/formats/exchange tools/view/studio"},
    {"tools/app/check", "conformance tools/formats/programs tools/formats/common", false},
    {"tools/characters/capture", "tools/formats/exchange tools/speech/talking", false},
    {"tools/app/batch", "conformance tools/formats/programs tools/formats/common", false},
    {"tools/app/dub", "tools/app/batch tools/formats/media tools/formats/scripts", false},
    {"tools/bindings/python",
     "tools/formats/exchange tools/formats/inspect tools/speech/talking tools/view/studio", false},
    {"tools/app/commands",
     "tools/app/dub tools/characters/capture tools/characters/crossmap tools/formats/exchange "
     "tools/formats/inspect tools/live/sessions tools/live/serve "
     "tools/view/sheet tools/view/studio tools/app/check tools/app/mpi",
     false},
    {"tools/app/late",
     "tools/speech/voice tools/speech/text tools/formats/media tools/formats/common fap/xml",
     false},
    {"tools/characters/trackers/dlib", "", false},  // a program for dlib's users, no part of ours
    {"tools/app", "tools/app/commands", false},

    // Tests of a module may use its neighbours to make what they test.
    {"tests/*", "fap/* fap codec/* dam/* conformance tools/*", false},
};

/// A library of others. Headers that are installed show none; some show in no header at all.
struct Library {
  std::string_view name;
  std::string_view headers;     ///< what their names start with, separated by spaces
  std::string_view allowed_in;  ///< the files and folders that may include them, with all below
  bool sources_only = false;
};

/// The first row that fits counts. What has neither '.' nor '/' is the C++ library and no row.
inline constexpr Library kLibraries[] = {
    {"libxml2", "libxml/", "fap/xml", true},
    {"Eigen", "Eigen/ unsupported/Eigen/", "dam/maths tests/dam tests/bench"},
    {"FFmpeg", "libav libsw libpost", "tools/formats/media tests/formats/media"},
    {"espeak-ng", "espeak speak_lib", "tools/speech/voice tests/speech/voice"},
    {"pocketsphinx", "pocketsphinx sphinxbase", "tools/speech/voice tests/speech/voice"},
    {"speexdsp", "speex", "tools/speech/voice"},
    {"ICU", "unicode/", "tools/speech/text", true},
    {"expat", "expat", "tools/speech/text", true},
    {"MeCab", "mecab", "tools/speech/text", true},
    {"CLD2", "cld2/", "tools/speech/text", true},
    {"Draco", "draco/", "tools/view/gltf", true},
    {"meshoptimizer", "meshoptimizer.h", "tools/view/gltf", true},
    {"libwebsockets", "libwebsockets", "tools/live/web/detail"},
    {"libanimeme", "animeme/animeme.h", "tools/bindings/examples tests"},
    {"zlib", "zlib",
     "tools/formats/inspect tools/view/gltf/detail tools/view/render tools/view/viewer "
     "tools/live/web/detail tests"},
    {"libpng, libjpeg, libwebp", "png jpeglib jerror webp/",
     "tools/view/gltf/detail tools/view/studio tests"},
    {"MPI", "mpi.h", "tools/app/mpi", true},
    {"GStreamer", "gst/", "tools/live/webrtc/detail"},
    {"libcurl", "curl/", "tools/live/webrtc/detail", true},
    {"pybind11", "pybind11/", "tools/bindings/python"},
    {"toml++", "toml++/", "tools/characters/crossmap", true},
    {"nlohmann_json", "nlohmann/", "tools/formats/common/json.cpp conformance tests"},
    {"CLI11", "CLI/", "tools/app/commands/parse_line.cpp tests/bench", true},
    {"GoogleTest", "gtest/ gmock/ benchmark/", "tests"},
    {"the system", "", "tools tests dam/maths/lower_triangle.cpp"},  // pages of memory
};

}  // namespace animeme::test
