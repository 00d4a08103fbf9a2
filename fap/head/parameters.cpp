// The heads that are ready.
#include "fap/head/model.h"

namespace animeme::head {

const std::array<std::string_view, 3> kHeadNames = {"woman", "man", "child"};

namespace {

HeadParameters man() {
  HeadParameters p;
  p.name = "man";
  p.hair = HairStyle::short_cut;
  return p;
}

HeadParameters child() {
  HeadParameters p;
  p.name = "child";
  p.hair = HairStyle::fringe;
  return p;
}

}  // namespace

std::optional<HeadParameters> head_parameters(std::string_view name) {
  if (name == "woman") return HeadParameters{};
  if (name == "man") return man();
  if (name == "child") return child();
  return std::nullopt;
}

}  // namespace animeme::head
