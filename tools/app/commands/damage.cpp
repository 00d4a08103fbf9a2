#include "tools/app/commands/damage.h"

#include <algorithm>
#include <set>
#include <string>

#include "tools/app/commands/terminal.h"

namespace animeme::tools {
namespace {

constexpr std::size_t kMostNamed = 5;
bool strict_setting = false;
std::set<std::string> damaged_files;

}  // namespace

void set_strict(bool strict) { strict_setting = strict; }
bool is_strict() { return strict_setting; }
bool damage_reported() { return !damaged_files.empty(); }

void report_damage(const std::string& path, std::span<const fba::Damage> damage) {
  // Some commands read a file twice.
  if (damage.empty() || !damaged_files.insert(path).second) return;
  std::int64_t frames = 0;
  for (const fba::Damage& one : damage) frames += one.frames;
  for (const fba::Damage& one : damage.first(std::min(damage.size(), kMostNamed))) {
    warn(path + ": damaged " + one.describe());
  }
  if (damage.size() <= kMostNamed) return;
  warn(path + ": and " + std::to_string(damage.size() - kMostNamed) + " more damaged places; " +
       std::to_string(frames) + " frames are lost in all");
}

}  // namespace animeme::tools
