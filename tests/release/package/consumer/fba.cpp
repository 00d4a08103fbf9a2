// Uses the text reader of fap and a function of codec, so both libraries have to link.
#include <animeme/fap/text.h>
#include <animeme/fba/access_unit.h>

int main() {
  const auto clip = animeme::fap::read_text("2.1 empty 25 0\n");
  if (!clip || animeme::fap::write_text(*clip) != "2.1 empty 25 0\n") return 1;
  animeme::fba::AccessUnits units;
  units.units.push_back({{0, 0, 1, 0xba}, true, 0, 1000});
  return animeme::fba::join_access_units(units).size() >= 4 ? 0 : 1;
}
