// scale_table CORPUS: time and memory of training on corpora that no disk has to hold. Sentences
// are copies of those of CORPUS, shifted and with noise, made one at a time. Prints the table of
// tools/app/cluster/README.md and what more machines would take, computed from it.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/model/builtin.h"
#include "dam/model/model.h"
#include "dam/training/accumulate.h"
#include "dam/training/alignment.h"

namespace {

using namespace animeme;
namespace fs = std::filesystem;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// What a child took.
struct Used {
  double cpu = 0, peak_mb = 0;
  bool good = false;
};

template <class Work>
pid_t start(Work work) {
  std::fflush(stdout);
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work() ? 0 : 1);
  return child;
}

Used wait_for(pid_t child) {
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return {seconds(used.ru_utime) + seconds(used.ru_stime), double(used.ru_maxrss) / 1024,
          status == 0};
}

/// Sentence `number` of a corpus of any size.
dam::Utterance copy_of(const std::vector<dam::Utterance>& base, std::size_t number) {
  dam::Utterance u = base[number % base.size()];
  std::mt19937 random(static_cast<std::mt19937::result_type>(number));
  const auto uniform = [&] { return double(random()) / 4294967296.0 - 0.5; };
  u.id += "_" + std::to_string(number);
  u.script = dam::shifted_script(u.script, 0.04 * uniform());
  for (double& value : u.signal.values) value += std::round(8 * uniform());
  return u;
}

bool write(const fs::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  return bool(out);
}

bool sum_part(const std::vector<dam::Utterance>& base, std::size_t sentences, std::size_t part,
              std::size_t parts, const fs::path& file) {
  const auto dominance = dam::builtin_model();
  auto sums = dam::TrainingSums::start({}, &*dominance);
  for (std::size_t i = part; sums && i < sentences; i += parts)
    if (const auto added = sums->add(copy_of(base, i)); !added) {
      std::fprintf(stderr, "%s\n", added.error().describe().c_str());
      return false;
    }
  return sums && write(file, dam::write_training_sums(*sums));
}

bool solve(const std::vector<fs::path>& files, const fs::path& model) {
  auto sums = dam::merge_training_sums(files);
  if (!sums) return false;
  const auto made = dam::train_from_sums(std::move(*sums));
  return made && write(model, dam::write_model(*made));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Training at scale: time and memory"};
  std::string corpus;
  std::vector<double> hours{1, 10, 100};
  std::vector<std::size_t> processes{1, 2};
  double large = 50;
  app.add_option("corpus", corpus, "Folder of a corpus, of which copies are made")->required();
  app.add_option("--hours", hours, "Sizes of corpora")->delimiter(',');
  app.add_option("--processes", processes, "At once")->delimiter(',');
  app.add_option("--large", large, "From so many hours by the most processes only");
  CLI11_PARSE(app, argc, argv);
  const auto read = dam::read_corpus(corpus);
  if (!read) return std::fprintf(stderr, "%s\n", read.error().describe().c_str()), 3;
  const std::vector<dam::Utterance>& base = read->utterances;
  const double seconds = read->duration() / double(base.size());
  const fs::path dir = fs::temp_directory_path() / ("scale_" + std::to_string(::getpid()));
  fs::create_directories(dir);

  // Other work on the machine stretches the wall clock, hardly the seconds of processors: speed-ups
  // are of these, of the slowest process.
  std::printf(
      "| hours | sentences | processes | summing, s | CPU, s | of the slowest | speed-up | MB each "
      "| "
      "sums, MB | adding and solving, s, CPU s | MB | model "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  bool good = true;
  double cpu_per_hour = 0, slowest_per_hour = 0, file_mb = 0, solving = 0;
  std::size_t most = 1;
  for (const double size : hours) {
    const auto sentences = std::size_t(size * 3600 / seconds);
    std::string first;
    double alone = 0;
    for (const std::size_t count : processes) {
      if (size >= large && count != processes.back()) continue;
      std::vector<fs::path> files;
      std::vector<pid_t> children;
      const double begin = now();
      for (std::size_t p = 0; p < count; ++p) {
        files.push_back(dir / (std::to_string(p) + ".stats"));
        children.push_back(start([&, p] { return sum_part(base, sentences, p, count, files[p]); }));
      }
      Used all{0, 0, true};
      double slowest = 0;
      for (const pid_t child : children) {
        const Used one = wait_for(child);
        slowest = std::max(slowest, one.cpu);
        all = {all.cpu + one.cpu, std::max(all.peak_mb, one.peak_mb), all.good && one.good};
      }
      const double wall = now() - begin;
      const fs::path model = dir / "model.dam";
      const double before = now();
      const Used solved = wait_for(start([&] { return solve(files, model); }));
      const double solve_wall = now() - before;
      std::ifstream in(model, std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(in)), {});
      const bool same = first.empty() || first == bytes;
      first = bytes;
      good = good && all.good && solved.good && same;
      file_mb = double(fs::file_size(files[0])) / 1e6;
      if (count == 1) alone = slowest;
      std::printf(
          "| %g | %zu | %zu | %.0f | %.1f | %.1f | %s | %.0f | %.0f | %.0f, %.0f | %.0f | %s |\n",
          size, sentences, count, wall, all.cpu, slowest,
          alone > 0 ? std::to_string(alone / slowest).substr(0, 4).c_str() : "", all.peak_mb,
          file_mb, solve_wall, solved.cpu, solved.peak_mb,
          !all.good || !solved.good ? "FAILED"
          : same                    ? "same"
                                    : "OTHER");
      std::fflush(stdout);
      cpu_per_hour = all.cpu / size;
      slowest_per_hour = slowest / size;
      most = count;
      solving = solved.cpu;
    }
  }
  // Sums travel at 1 Gbit/s along a tree. A level costs reading and adding two of them, which is
  // less than solving.
  const double machines = 100, size = 1000, levels = std::ceil(std::log2(machines));
  const double each = slowest_per_hour * size / machines, move = levels * (file_mb / 117 + solving);
  std::printf(
      "\n%g hours on %g machines, %zu free cores each: summing %.0f s (%.1f s of CPU an hour of "
      "speech), "
      "adding in %g levels %.0f s at most, solving %.0f s: %.0f s\n",
      size, machines, most, each, cpu_per_hour, levels, move, solving, each + move + solving);
  fs::remove_all(dir);
  return good ? 0 : 1;
}
