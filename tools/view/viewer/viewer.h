/// @file
/// A talking head as one HTML file: the head, the motion, the sound and the player.
///
///     head::Head head = *head::make_head();
///     head::Rig rig = head::make_rig(head);
///     viewer::Page page{.head = &head, .rig = &rig};
///     page.clips.push_back({.motion = filled, .name = "talk.fba"});
///     std::string html = viewer::make_page(page);
///
/// The file only needs a browser with WebGL2 and WebAssembly: it opens from disk and loads nothing.
/// README.md of this folder documents its features and how other pages can use its parts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/head/rig.h"
#include "fap/result.h"

/// Web pages with talking heads.
namespace animeme::viewer {

/// A motion to show.
struct Clip {
  /// Complete, as returned by fap::fill() or fba::fill(). FAP 1 and 2 use the tables of the head
  /// (head/shapes.h).
  fap::Sequence motion;
  double start = 0;  ///< time of frame number 0 on the clock of the sound, seconds
  std::string name;  ///< display name; any text
  /// What is said, by frame: see head::PoseOptions::visemes. Empty: unknown.
  std::vector<fap::VisemeWeights> visemes = {};
};

/// A sound file for browsers.
struct Sound {
  std::vector<std::uint8_t> file;  ///< the whole file
  std::string type;                ///< "audio/mp4"
};

/// A further head that the page can show.
struct OtherHead {
  const head::Head* head = nullptr;  ///< borrowed
  const head::Rig* rig = nullptr;    ///< borrowed
  std::string name;                  ///< display name in the list; any text
};

/// The same in another language, or of another person.
struct OtherTrack {
  std::string lang;            ///< language tag (BCP 47); empty: unknown
  std::string speaker;         ///< who speaks; empty: unknown
  Clip clip;                   ///< the face
  std::optional<Sound> sound;  ///< nullopt: silent
  dam::Script script;          ///< what is said; empty: none
};

/// One of people who are shown side by side.
struct PagePerson {
  const head::Head* head = nullptr;  ///< borrowed; may be that of another one
  const head::Rig* rig = nullptr;    ///< borrowed
  double turned = 0;                 ///< degrees that they are seen further from their left
  Clip clip;                         ///< the face; its name is theirs
};

/// Contents of a page; heads and rigs are borrowed.
struct Page {
  const head::Head* head = nullptr;  ///< borrowed
  const head::Rig* rig = nullptr;    ///< borrowed
  std::vector<Clip> clips;           ///< one, or two to compare
  std::optional<Sound> sound;        ///< nullopt: silent
  dam::Script script;                ///< phones below the curves; empty: none
  /// Further heads: 0.6 to 0.8 MB each. With them the page has a list to choose from.
  std::vector<OtherHead> others;
  std::string head_name;  ///< of the first head, in that list
  /// Further languages or people, beside one clip. With them the page has a list that switches
  /// face, sound and words at the same instant.
  std::vector<OtherTrack> tracks;
  std::string lang;     ///< of the first one: language tag
  std::string speaker;  ///< of the first one
  /// People side by side, from left to right, two to eight: in place of `clips`, `head`, `rig`,
  /// `others` and `tracks`. `script` is what all of them say.
  std::vector<PagePerson> people;
  /// With `people`: what each of them says, for captions; may be empty.
  std::vector<dam::Script> scripts;
  std::string title;  ///< of the page with `people`; else the name of its first clip
};

/// Makes the page. The same input gives the same bytes with the same zlib. External texts (names,
/// labels, words) are escaped. Errors: invalid_argument (a head or rig is missing; not one clip or
/// two; two clips in several languages; a clip without frames).
Result<std::string> make_page(const Page& page);

/// A head in the format read by model.js (see README.md): about 1.8 MB.
std::vector<std::uint8_t> pack_head(const head::Head& head, const head::Rig& rig);

/// The modules that draw a head as one script without imports and exports, with the WebAssembly
/// rig: class HeadView and its dependencies, for pages with their own source of motion. A module
/// script; the page's policy must allow 'wasm-unsafe-eval'.
std::string_view head_script();

}  // namespace animeme::viewer
