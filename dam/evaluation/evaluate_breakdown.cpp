// Errors by phoneme, viseme, context and word.
#include <algorithm>
#include <array>

#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kVisemes = 15;

/// Sums of one group. Phones come in order, so each occurrence is counted once.
struct Group {
  std::size_t phones = 0;
  ErrorSums sums;
  const Phone* last = nullptr;

  void add(const Layout& layout, const PairSeries& pair, std::size_t frame, const Phone& phone) {
    if (last != &phone) ++phones;
    last = &phone;
    add_frame(layout, pair, frame, sums);
  }
  GroupScore score(std::string name) const {
    return {std::move(name), phones, sums.frames, sums.nrmse(), sums.mean_l2(), sums.gap_rmse()};
  }
};

struct Groups {
  std::array<Group, kPhoneCount> labels;
  std::array<Group, kVisemes> visemes;
  std::array<Group, 2> triphones, words;  // seen, unseen
};

std::string triphone(const Script& script, std::size_t at) {
  const std::vector<Phone>& phones = script.phones;
  const auto beside = [&](bool left) -> std::string_view {
    if (left ? at == 0 : at + 1 == phones.size()) return kSilence;
    const Phone& a = phones[left ? at - 1 : at];
    const Phone& b = phones[left ? at : at + 1];
    if (b.start - a.end > kTimeTolerance) return kSilence;
    return left ? a.label : b.label;
  };
  return std::string(beside(true)) + " " + phones[at].label + " " + std::string(beside(false));
}

void sort_unique(std::vector<std::string>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

bool holds(const std::vector<std::string>& list, const std::string& text) {
  return std::binary_search(list.begin(), list.end(), text);
}

void add_contexts(const Layout& layout, const PairSeries& pair, std::size_t frame,
                  const SeenContexts& seen, Groups& groups) {
  const auto at = std::size_t(pair.phone[frame]);
  const Phone& phone = pair.script().phones[at];
  if (phone.label == kSilence) return;
  if (seen.known()) {
    const bool old = holds(seen.triphones, triphone(pair.script(), at));
    groups.triphones[old ? 0 : 1].add(layout, pair, frame, phone);
  }
  if (!seen.words.empty() && !phone.word.empty())
    groups.words[holds(seen.words, phone.word) ? 0 : 1].add(layout, pair, frame, phone);
}

void add_to_groups(const Layout& layout, const PairSeries& pair, std::size_t frame,
                   const SeenContexts& seen, Groups& groups) {
  if (pair.phone[frame] < 0) return;
  const Phone& phone = pair.script().phones[std::size_t(pair.phone[frame])];
  const PhoneInfo* info = find_phone(phone.label);
  if (info == nullptr) return;
  groups.labels[std::size_t(info - phones().data())].add(layout, pair, frame, phone);
  const bool first_half = pair.seconds(double(frame)) < (phone.start + phone.end) / 2;
  const std::size_t viseme = first_half ? info->viseme_start : info->viseme_end;
  groups.visemes[viseme].add(layout, pair, frame, phone);
  add_contexts(layout, pair, frame, seen, groups);
}

}  // namespace

SeenContexts seen_contexts(std::span<const Utterance> utterances) {
  SeenContexts seen;
  for (const Utterance& u : utterances) {
    for (std::size_t i = 0; i < u.script.phones.size(); ++i) {
      const Phone& phone = u.script.phones[i];
      if (phone.label == kSilence) continue;
      seen.triphones.push_back(triphone(u.script, i));
      if (!phone.word.empty()) seen.words.push_back(phone.word);
    }
  }
  sort_unique(seen.triphones);
  sort_unique(seen.words);
  return seen;
}

void score_breakdown(const Layout& layout, const AllSeries& all, const SeenContexts& seen,
                     Evaluation& result) {
  Groups groups;
  for (const PairSeries& pair : all)
    for (std::size_t i = 0; i < pair.frames(); ++i)
      if (pair.speech[i]) add_to_groups(layout, pair, i, seen, groups);
  Breakdown& out = result.breakdown;
  for (std::size_t p = 0; p < kPhoneCount; ++p)
    if (groups.labels[p].phones > 0)
      out.phones.push_back(groups.labels[p].score(std::string(phones()[p].label)));
  for (std::size_t v = 0; v < kVisemes; ++v)
    if (groups.visemes[v].phones > 0)
      out.visemes.push_back(groups.visemes[v].score(std::to_string(v)));
  for (const std::size_t i : {0, 1}) {
    const char* name = i == 0 ? "seen" : "unseen";
    if (seen.known()) out.triphones.push_back(groups.triphones[i].score(name));
    if (!seen.words.empty()) out.words.push_back(groups.words[i].score(name));
  }
}

}  // namespace animeme::dam
