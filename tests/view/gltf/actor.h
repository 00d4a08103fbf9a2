// The head that the tests of glTF write and read.
#pragma once

#include "fap/head/rig.h"

namespace animeme::gltf {

/// A head and its rig.
struct Actor {
  head::Head head;
  head::Rig rig;
};

/// The woman with half her vertices, which tests of files need not wait for.
inline const Actor& actor() {
  static const Actor made = [] {
    head::HeadParameters parameters = *head::head_parameters("woman");
    parameters.density = 0.5;
    Actor out{*head::make_head(parameters), {}};
    out.rig = head::make_rig(out.head);
    return out;
  }();
  return made;
}

}  // namespace animeme::gltf
