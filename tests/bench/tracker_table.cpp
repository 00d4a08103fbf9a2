// Prints the table of tools/characters/trackers/README.md: heads say sentences of the sample, a
// tracker looks at the video, and what `animeme import` makes of it stands beside what the head was
// moved by.
//   ANIMEME_TRACKER="node tools/characters/trackers/mediapipe/track.js"
//   build/release/bin/tracker_table [HEAD...]
// Heads are those of `animeme render --head`; without any: woman, man, child.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "dam/corpus/corpus.h"
#include "dam/script/script.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tests/support/tracked_head.h"

namespace {

using namespace animeme;
namespace fs = std::filesystem;

const fs::path kSample = fs::path(test::kSourceFolder) / "tests/data/grid_s1_sample";
constexpr const char* kSentences[] = {"bbbmzn", "lwbf2n", "pbwdzp", "pwbq5s"};  // with P, B, M, F
constexpr double kClosed = dam::kClosedGap;

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().describe().c_str());
  std::exit(1);
}

void must(const std::vector<std::string>& arguments) {
  const auto done = test::animeme(arguments);
  if (done.exit_code == 0) return;
  std::fprintf(stderr, "%s", done.err.c_str());
  std::exit(1);
}

// P, B and M that close the lips.
int closed(const dam::Signal& signal, const dam::Script& script, int& phones) {
  const auto lips = dam::inner_lip_channels(signal.names);
  int count = 0;
  phones = 0;
  for (const dam::Phone& phone : script.phones) {
    if (!lips || !dam::is_bilabial(phone.label)) continue;
    const dam::FrameSpan span = dam::frames_near(signal, phone, dam::kClosureSearch);
    bool shut = false;
    for (std::size_t i = span.first; i < span.last; ++i) {
      shut = shut || dam::inner_gap(signal, i, *lips) < kClosed;
    }
    ++phones;
    count += shut ? 1 : 0;
  }
  return count;
}

void add(std::vector<double>& all, const std::vector<double>& some, std::size_t count) {
  all.insert(all.end(), some.begin(), some.begin() + std::ptrdiff_t(std::min(count, some.size())));
}

void measure(const std::string& head) {
  const test::TempDir dir;
  std::ofstream(dir / "utterances.tsv") << "id\n";  // a corpus: curves go to fap/
  std::vector<std::string> import = {"import", "-o", dir.path().string()};
  for (const char* id : kSentences) {
    const std::string video = dir / (std::string(id) + ".mp4");
    must({"render", (kSample / "fap" / (std::string(id) + ".csv")).string(), "--head", head,
          "--size", "320x320", "--zoom", "1.4", "-o", video});
    import.push_back(video);
  }
  const auto begin = std::chrono::steady_clock::now();
  must(import);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::vector<double> drawn[5], seen[5];  // jaw, gap, corners out, corners up, lower lip forward
  const int faps[] = {3, 0, 6, 12, 16};
  std::size_t frames = 0, lost = 0;
  int phones = 0, drawn_shut = 0, seen_shut = 0;
  for (const char* id : kSentences) {
    const std::string name = std::string("fap/") + id + ".csv";
    const dam::Signal a = need(dam::read_curves(test::slurp((kSample / name).string())));
    const dam::Signal b = need(dam::read_curves(test::slurp(dir / name)));
    const std::size_t both = std::min(a.frames(), b.frames());
    frames += a.frames();
    lost += a.frames() - both;
    for (std::size_t i = 0; i < b.measured.size(); ++i) lost += b.measured[i] ? 0 : 1;
    for (int k = 0; k < 5; ++k) {
      add(drawn[k], k == 1 ? test::lip_gap(a) : test::curve_of(a, faps[k]), both);
      add(seen[k], k == 1 ? test::lip_gap(b) : test::curve_of(b, faps[k]), both);
    }
    const std::string script_file = (kSample / "phonemes" / (std::string(id) + ".tsv")).string();
    const dam::Script script = need(dam::read_script(test::slurp(script_file)));
    int here = 0;
    drawn_shut += closed(a, script, here);
    seen_shut += closed(b, script, here);
    phones += here;
  }
  std::printf("| %s |", fs::path(head).stem().c_str());
  for (int k = 0; k < 5; ++k) {
    if (seen[k].empty()) {
      std::printf(" |");
      continue;
    }
    const test::Agreement one = test::agreement(drawn[k], seen[k]);
    std::printf(" %.2f (%.2f) |", one.correlation, one.gain);
  }
  std::printf(" %d, %d of %d | %zu of %zu | %.0f |\n", drawn_shut, seen_shut, phones, lost, frames,
              double(frames) / seconds);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  std::vector<std::string> heads(words + 1, words + count);
  if (heads.empty()) heads = {"woman", "man", "child"};
  std::printf(
      "| head | FAP 3 jaw | lip gap | FAP 6 corner out | FAP 12 corner up | FAP 16 lip forward | P "
      "B M closed: drawn, "
      "seen | lost | pictures a second |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& head : heads) measure(head);
}
