/// @file
/// A face as one HTML file: the head, the motion, the sound and the program that plays them.
///
///     head::Head head = *head::make_head();
///     head::Rig rig = head::make_rig(head);
///     viewer::Page page{.head = &head, .rig = &rig};
///     page.clips.push_back({.motion = filled, .name = "talk.fba"});
///     std::string html = viewer::make_page(page);
///
/// The file needs a browser with WebGL2 and WebAssembly and nothing else: it opens from disk and
/// loads nothing. What it can do, and how its parts serve other pages, stands in README.md of this
/// folder.
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

/// A page that shows a talking head.
namespace animeme::viewer {

/// A motion to show.
struct Clip {
  /// Complete: what fap::fill() or fba::fill() gave. FAP 1 and 2 are shown by the tables of the
  /// head (head/shapes.h).
  fap::Sequence motion;
  double start = 0;  ///< seconds on the clock of the sound at which frame number 0 is shown
  std::string name;  ///< shown to people; any text
};

/// Coded sound in a file that browsers read.
struct Sound {
  std::vector<std::uint8_t> file;  ///< the whole file
  std::string type;                ///< "audio/mp4"
};

/// Another head that the page can show.
struct OtherHead {
  const head::Head* head = nullptr;  ///< borrowed
  const head::Rig* rig = nullptr;    ///< borrowed
  std::string name;                  ///< what people choose; any text
};

/// What goes into a page; heads and rigs are borrowed.
struct Page {
  const head::Head* head = nullptr;  ///< borrowed
  const head::Rig* rig = nullptr;    ///< borrowed
  std::vector<Clip> clips;           ///< one, or two to compare
  std::optional<Sound> sound;        ///< nothing: the page is silent
  dam::Script script;                ///< phones below the curves; empty: none
  /// Further heads: 0.6 to 0.8 MB each. With them the page has a list to choose from.
  std::vector<OtherHead> others;
  std::string head_name;  ///< of the first head, in that list
};

/// The page. The same input gives the same bytes with the same zlib. Texts from outside (names,
/// labels, words) are shown as text, whatever is in them. Errors: invalid_argument (a head or rig
/// is missing; not one clip or two; a clip without frames).
Result<std::string> make_page(const Page& page);

/// A head for the browser, as model.js reads it: about 1.8 MB. The format stands in README.md.
std::vector<std::uint8_t> pack_head(const head::Head& head, const head::Rig& rig);

/// The modules that draw a head, as one script without imports and exports, and the WebAssembly
/// that moves it: class HeadView and what it needs, for pages that have their own source of motion.
/// A module script; a policy of its page must allow 'wasm-unsafe-eval'.
std::string_view head_script();

}  // namespace animeme::viewer
