#include "tools/speech/voice/word_paths.h"

#include <algorithm>
#include <cmath>

namespace animeme::voice {

namespace {

constexpr float kNever = -1e30f;
constexpr std::uint8_t kByPause = 250, kByForeign = 251, kBySkip = 252, kByNothing = 253;

struct Node {
  std::size_t hub = 0;        // border that it is entered from; kNone inside a chain
  std::size_t state = 0;      // of the model; kNone: any sound
  float stay = 0, leave = 0;  // logarithms
  float enter = 0;            // paid by who enters it, but by a leap
  float frame = 0;            // paid a frame
};

// All states of a text, and where chains end.
struct Graph {
  struct End {
    std::size_t node, hub;
    std::uint8_t by;
  };
  // Over a pause inside of a word, from the node before it to the one behind.
  struct Leap {
    std::size_t node, from;
  };
  std::vector<Node> nodes;
  std::vector<Leap> leaps;             // ascending
  std::vector<End> ends;               // by hub
  std::vector<std::size_t> ends_from;  // of each hub, and one more
  struct Place {
    PartKind kind;
    std::size_t word, variant, index;
  };
  std::vector<Place> places;  // of each node
};

std::size_t phone_number(const SoundModel& model, std::string_view name) {
  const auto one = std::find(model.phones.begin(), model.phones.end(), name);
  return one == model.phones.end() ? kNone : std::size_t(one - model.phones.begin());
}

Graph make_graph(const SoundModel& model, std::span<const WordModel> words,
                 const PathCosts& costs) {
  Graph graph;
  const std::size_t silence = phone_number(model, "SIL");
  const auto chain = [&](std::size_t hub, float enter, std::span<const std::uint8_t> phones,
                         PartKind kind, std::size_t word, std::size_t variant) {
    const auto is_gap = [&](std::size_t i) {
      return i > 0 && i + 1 < phones.size() && phones[i] == silence;
    };
    for (std::size_t i = 0; i < phones.size(); ++i) {
      if (i > 1 && is_gap(i - 1)) {
        const std::size_t node = graph.nodes.size();
        graph.leaps.push_back({node, node - kStatesPerPhone - 1});
      }
      for (std::size_t part = 0; part < kStatesPerPhone; ++part) {
        const std::size_t state = phones[i] * kStatesPerPhone + part;
        const float paid = i + part == 0 ? enter : is_gap(i) && part == 0 ? costs.pause : 0;
        graph.nodes.push_back({i + part == 0 ? hub : kNone, state, std::log(model.stay[state]),
                               std::log(1 - model.stay[state]), paid, 0});
        graph.places.push_back({is_gap(i) ? PartKind::pause : kind, word, variant, i});
      }
    }
  };
  const auto any = [&](std::size_t hub, float enter, float frame, std::size_t word) {
    graph.nodes.push_back({hub, kNone, 0, 0, enter, frame});
    graph.places.push_back({PartKind::foreign, word, 0, 0});
  };
  for (std::size_t hub = 0; hub <= words.size(); ++hub) {
    graph.ends_from.push_back(graph.ends.size());
    if (hub > 0) {
      const WordModel& word = words[hub - 1];
      for (std::size_t v = 0; v < word.variants.size() && !word.left_out; ++v) {
        const float paid = v >= word.complete ? costs.skip + costs.skip_word : 0;
        chain(hub - 1, paid, word.variants[v], PartKind::phone, hub - 1, v);
        graph.ends.push_back({graph.nodes.size() - 1, hub, std::uint8_t(v)});
      }
      if (word.variants.empty()) {
        any(hub - 1, 0, costs.unknown_frame, hub - 1);
        graph.ends.push_back({graph.nodes.size() - 1, hub, 0});
      }
    }
    if (silence != kNone) {
      const auto phone = std::uint8_t(silence);
      const bool inside = hub > 0 && hub < words.size();
      chain(hub, inside ? costs.pause : 0, {&phone, 1}, PartKind::pause, kNone, 0);
      graph.ends.push_back({graph.nodes.size() - 1, hub, kByPause});
    }
    any(hub, costs.foreign, costs.foreign_frame, kNone);
    graph.ends.push_back({graph.nodes.size() - 1, hub, kByForeign});
  }
  graph.ends_from.push_back(graph.ends.size());
  return graph;
}

class Bits {
 public:
  Bits(std::size_t rows, std::size_t columns)
      : columns_(columns), words_(rows * columns / 64 + 1) {}
  void set(std::size_t row, std::size_t column) {
    const std::size_t at = row * columns_ + column;
    words_[at / 64] |= std::uint64_t(1) << (at % 64);
  }
  bool operator()(std::size_t row, std::size_t column) const {
    const std::size_t at = row * columns_ + column;
    return (words_[at / 64] >> (at % 64) & 1) != 0;
  }

 private:
  std::size_t columns_;
  std::vector<std::uint64_t> words_;
};

// The hubs of one frame: how a border is reached, by itself or by leaving words out.
class Hubs {
 public:
  Hubs(const Graph& graph, std::span<const WordModel> words, const PathCosts& costs)
      : graph_(graph), words_(words), costs_(costs), best(words.size() + 1, kNever) {}
  void reach(const std::vector<float>& scores, std::uint8_t* by, std::uint8_t* skipped) {
    float chain = kNever;
    for (std::size_t hub = 0; hub < best.size(); ++hub) {
      if (!(begin_ && hub == 0)) best[hub] = kNever;
      by[hub] = kByNothing;
      skipped[hub] = 0;
      for (std::size_t i = graph_.ends_from[hub]; !begin_ && i < graph_.ends_from[hub + 1]; ++i) {
        const auto& end = graph_.ends[i];
        const float score = scores[end.node] + graph_.nodes[end.node].leave;
        if (score <= best[hub]) continue;
        best[hub] = score;
        by[hub] = end.by;
      }
      if (hub > 0) {
        // Words that nobody can say, or says, are missing for nothing.
        const WordModel& word = words_[hub - 1];
        const bool known = !word.variants.empty() && !word.left_out;
        const float anew = best[hub - 1] - (known ? costs_.skip : 0);
        const bool goes_on = chain >= anew;
        chain = std::max(chain, anew) - (known ? costs_.skip_word * word.words : 0);
        skipped[hub] = goes_on ? 2 : 1;
        if (chain > best[hub]) {
          best[hub] = chain;
          by[hub] = kBySkip;
        }
      }
    }
    begin_ = false;
  }

 private:
  const Graph& graph_;
  std::span<const WordModel> words_;
  const PathCosts& costs_;
  bool begin_ = true;

 public:
  std::vector<float> best;
};

}  // namespace

FoundPath find_path(const SoundModel& model, const FrameScores& scores,
                    std::span<const WordModel> words, const PathCosts& costs, bool open_end) {
  const std::size_t frames = scores.frames();
  if (frames == 0) return {};
  const Graph graph = make_graph(model, words, costs);
  const std::size_t size = graph.nodes.size(), borders = words.size() + 1;
  std::vector<float> best(size, kNever), next(size);
  Bits moved(frames, size), leapt(frames, graph.leaps.size());
  std::vector<std::uint8_t> by((frames + 1) * borders), skipped((frames + 1) * borders);
  Hubs hubs(graph, words, costs);
  hubs.best[0] = 0;
  hubs.reach(best, by.data(), skipped.data());
  for (std::size_t t = 0; t < frames; ++t) {
    const auto now = scores[t];
    for (std::size_t n = 0; n < size; ++n) {
      const Node& node = graph.nodes[n];
      const float held = best[n] + node.stay;
      const float come =
          (node.hub != kNone ? hubs.best[node.hub] : best[n - 1] + graph.nodes[n - 1].leave) -
          node.enter;
      if (come > held) moved.set(t, n);
      next[n] = std::max(held, come) + (node.state == kNone ? -node.frame : now[node.state]);
    }
    for (std::size_t k = 0; k < graph.leaps.size(); ++k) {
      const auto& leap = graph.leaps[k];
      const float come =
          best[leap.from] + graph.nodes[leap.from].leave + now[graph.nodes[leap.node].state];
      if (come <= next[leap.node]) continue;
      next[leap.node] = come;
      moved.set(t, leap.node);
      leapt.set(t, k);
    }
    std::swap(best, next);
    hubs.reach(best, &by[(t + 1) * borders], &skipped[(t + 1) * borders]);
  }
  std::size_t hub = words.size();
  if (open_end)
    hub = std::size_t(std::max_element(hubs.best.begin(), hubs.best.end()) - hubs.best.begin());
  FoundPath path;
  path.total = hubs.best[hub];
  std::vector<PathPart>& parts = path.parts;
  for (std::size_t t = frames; t > 0;) {  // hub is reached after t frames
    const std::uint8_t how = by[t * borders + hub];
    if (how == kByNothing) return {};
    if (how == kBySkip) {
      while (skipped[t * borders + hub] == 2) --hub;
      --hub;
      continue;
    }
    std::size_t node = 0;
    for (std::size_t i = graph.ends_from[hub]; i < graph.ends_from[hub + 1]; ++i) {
      if (graph.ends[i].by == how) node = graph.ends[i].node;
    }
    // Back through the chain to its border.
    while (true) {
      const auto& place = graph.places[node];
      --t;
      const bool same = !parts.empty() && parts.back().kind == place.kind &&
                        parts.back().word == place.word && parts.back().index == place.index &&
                        parts.back().first == t + 1;
      if (!same) parts.push_back({place.kind, t + 1, 0, place.word, place.variant, place.index, 0});
      PathPart& part = parts.back();
      part.first = t;
      ++part.frames;
      if (graph.nodes[node].state != kNone) part.score += scores[t][graph.nodes[node].state];
      if (!moved(t, node)) continue;
      if (graph.nodes[node].hub != kNone) {
        hub = graph.nodes[node].hub;
        break;
      }
      const auto leap = std::lower_bound(
          graph.leaps.begin(), graph.leaps.end(), node,
          [](const Graph::Leap& one, std::size_t number) { return one.node < number; });
      const bool over = leap != graph.leaps.end() && leap->node == node &&
                        leapt(t, std::size_t(leap - graph.leaps.begin()));
      node = over ? leap->from : node - 1;
    }
  }
  std::reverse(parts.begin(), parts.end());
  return path;
}

}  // namespace animeme::voice
