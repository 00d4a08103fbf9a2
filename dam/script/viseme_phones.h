/// @file
/// Scripts of visemes: the phone that stands for each mouth of other programs.
///
/// A viseme is what several sounds look like, so that a phone for it is a choice: the one of its
/// sounds that came nearest to recorded motion (P of "p b m", N of "d t n"), else the most common
/// (AX of "ae ax ah"). Sources and what it costs: dam/script/phoneme_scripts.md, section 2.
#pragma once

#include <optional>
#include <string_view>

namespace animeme::dam {

/// Who names the visemes.
enum class VisemeSet : unsigned char {
  rhubarb,        ///< A to H and X of Rhubarb Lip Sync
  preston_blair,  ///< AI E O U L WQ MBP FV etc rest: Moho, Papagayo, OpenToonz
  azure,          ///< 0 to 21 of Azure Speech and of SAPI
  polly,          ///< Amazon Polly: p t S T f k i r s u @ a e E o O sil ...
  oculus,         ///< sil PP FF TH DD kk CH SS nn RR aa E I O U, with or without "viseme_"
};

/// The label (dam/script/phones.h) that stands for a viseme; nothing for a name that is not in the
/// set. Upper and lower case differ, as they do there.
std::optional<std::string_view> phone_of_viseme(VisemeSet set, std::string_view name);

}  // namespace animeme::dam
