#include "dam/speaking/viseme_curves.h"

#include <algorithm>
#include <array>

#include "dam/maths/raised_cosine.h"
#include "dam/speaking/shown_phones_internal.h"
#include "fap/tables.h"

namespace animeme::dam {
namespace {

constexpr double kSoundComes = 0.08, kSoundGoes = 0.06;  // seconds
constexpr double kContactComes = 0.055;  // likewise of lips that close, which is faster
constexpr double kLeastContact = 0.021;  // half: a frame of 25 a second falls into it
constexpr double kContactShare = 0.3;    // or so much of the sound before and after its middle

// By viseme: sil PP FF TH DD kk CH SS nn RR aa E ih oh ou.
constexpr std::array<double, fap::kVisemeCount> kDominance = {1,   1,   1, 3, 1.2, 0.7, 3, 2,
                                                              1.2, 1.5, 2, 2, 2,   2.5, 3};

double presence(double time, double start, double end, double before, double after) {
  return raised_step((time - start) / before + 1) * raised_step((end - time) / after + 1);
}

}  // namespace

VisemeCurves::VisemeCurves(const Script& script) {
  for (const internal::ShownPhone& phone : internal::shown_phones(script)) {
    const double middle = (phone.start + phone.end) / 2;
    if (phone.first == phone.last) {
      add(phone.start, phone.end, phone.first);
    } else {
      add(phone.start, middle, phone.first);
      add(middle, phone.end, phone.last);
    }
    const PhoneInfo* own = phone.own;
    if (own == nullptr) continue;
    const bool dental = own->phone_class == PhoneClass::dental;
    if (!own->bilabial && !own->labiodental && !dental) continue;
    const double half = std::max(kLeastContact, kContactShare * (phone.end - phone.start));
    contacts_.push_back(
        {middle - half, middle + half, kContactComes, kContactComes, phone.first, 1});
  }
  const auto by_start = [](const Sound& a, const Sound& b) { return a.start < b.start; };
  std::stable_sort(sounds_.begin(), sounds_.end(), by_start);
  std::stable_sort(contacts_.begin(), contacts_.end(), by_start);
  limit_contacts();
}

void VisemeCurves::add(double start, double end, int viseme) {
  if (viseme == 0) return;  // silence is what is left
  sounds_.push_back({start, end, kSoundComes, kSoundGoes, viseme, kDominance[std::size_t(viseme)]});
  longest_ = std::max(longest_, end - start + kSoundGoes);
}

// Two that follow each other: the one does not reach into the middle of the other.
void VisemeCurves::limit_contacts() {
  for (std::size_t i = 1; i < contacts_.size(); ++i) {
    Sound& one = contacts_[i - 1];
    Sound& two = contacts_[i];
    if (one.end > two.start) one.end = two.start = (one.end + two.start) / 2;
    constexpr double kAtOnce = 0.01;
    const double between = std::max(two.start - one.end, kAtOnce);
    one.after = std::min(one.after, between);
    two.before = std::min(two.before, between);
  }
}

// Calls `take` with each that is there and its presence, 0 to 1.
template <class Take>
void VisemeCurves::for_present(const std::vector<Sound>& sounds, double seconds, double comes,
                               const Take& take) const {
  auto sound = std::lower_bound(sounds.begin(), sounds.end(), seconds - longest_,
                                [](const Sound& one, double time) { return one.start < time; });
  for (; sound != sounds.end() && sound->start <= seconds + comes; ++sound) {
    take(*sound, presence(seconds, sound->start, sound->end, sound->before, sound->after));
  }
}

fap::VisemeWeights VisemeCurves::at(double seconds) const {
  fap::VisemeWeights weights{};
  double sum = 0, present = 0;
  for_present(sounds_, seconds, kSoundComes, [&](const Sound& sound, double share) {
    weights[std::size_t(sound.viseme)] += share * sound.dominance;
    sum += share * sound.dominance;
    present = std::max(present, share);
  });
  // Where nothing is quite there it is silent.
  const double scale = sum > 0 ? present / sum : 0;
  for (double& weight : weights) weight *= scale;
  fap::VisemeWeights touch{};
  double touching = 0;
  for_present(contacts_, seconds, kContactComes, [&](const Sound& sound, double share) {
    touch[std::size_t(sound.viseme)] += share;
    touching += share;
  });
  const double whole = std::max(touching, 1.0);
  double rest = 1;
  for (std::size_t v = 1; v < weights.size(); ++v) {
    weights[v] = (1 - touching / whole) * weights[v] + touch[v] / whole;
    rest -= weights[v];
  }
  weights[0] = std::max(rest, 0.0);
  return weights;
}

std::vector<fap::VisemeWeights> viseme_weights(const Script& script, const fap::Sequence& clip,
                                               double start) {
  std::vector<fap::VisemeWeights> weights;
  if (script.phones.empty()) return weights;
  const VisemeCurves curves(script);
  weights.reserve(clip.frames.size());
  for (const fap::Frame& frame : clip.frames) {
    weights.push_back(curves.at(start + clip.rate.seconds(double(frame.number))));
  }
  return weights;
}

}  // namespace animeme::dam
