/// @file
/// Scripts of visemes: the phone for each mouth shape of other programs.
///
/// A viseme stands for several sounds, so the phone for it is a choice: the sound that came nearest
/// to recorded motion (P of "p b m", N of "d t n"), else the most common one (AX of "ae ax ah").
/// Sources and the resulting error: dam/script/phoneme_scripts.md, section 2.
#pragma once

#include <optional>
#include <string_view>

namespace animeme::dam {

/// Known sets of visemes.
enum class VisemeSet : unsigned char {
  rhubarb,        ///< A to H and X of Rhubarb Lip Sync
  preston_blair,  ///< AI E O U L WQ MBP FV etc rest: Moho, Papagayo, OpenToonz
  azure,          ///< 0 to 21 of Azure Speech and of SAPI
  polly,          ///< Amazon Polly: p t S T f k i r s u @ a e E o O sil ...
  oculus,         ///< sil PP FF TH DD kk CH SS nn RR aa E I O U, with or without "viseme_"
};

/// The label (dam/script/phones.h) for a viseme; nullopt for a name that is not in the set. Names
/// are case sensitive, as in the original programs.
std::optional<std::string_view> phone_of_viseme(VisemeSet set, std::string_view name);

}  // namespace animeme::dam
