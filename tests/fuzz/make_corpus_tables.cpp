// Writes the seeds of fuzz_curves, fuzz_case, fuzz_lines and fuzz_c3d: make_corpus_tables CORPUS
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "conformance/case_file.h"
#include "tests/support/c3d_writer.h"

namespace {

using namespace animeme;

std::filesystem::path g_folder;

void seed(const std::string& target, const std::string& name, const std::string& bytes) {
  std::filesystem::create_directories(g_folder / target);
  std::ofstream(g_folder / target / name, std::ios::binary) << bytes;
}

// The same numbers on every machine.
class Random {
 public:
  std::uint32_t next(std::uint32_t below) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return std::uint32_t(state_ >> 33) % below;
  }

 private:
  std::uint64_t state_ = 2026;
};

// Markers: each processor, both kinds of numbers, some of them hidden; and tables of points.
void captured(Random& random) {
  for (int i = 0; i < 12; ++i) {
    test::C3dFile file;
    file.processor = test::C3dFile::Processor(84 + i % 3);
    file.scale = i % 2 == 0 ? -1 : 0.05;
    file.rate = i % 4 == 3 ? 119.88 : 100;
    file.analogue = i % 5 == 4 ? 6 : 0;
    for (int m = 0; m <= i % 4; ++m) file.labels.push_back("M" + std::to_string(m % 3));
    for (int frame = 0; frame < 3 + i; ++frame) {
      file.frames.emplace_back();
      for (std::size_t k = 0; k < 4 * file.labels.size(); ++k) {
        file.frames.back().push_back(k % 4 == 3 ? double(random.next(3)) - 1
                                                : double(random.next(2000)) / 10 - 100);
      }
    }
    const auto bytes = file.bytes();
    seed("c3d", "markers_" + std::to_string(i) + ".c3d", std::string(bytes.begin(), bytes.end()));
  }
  const char* headers[] = {"time_s,a_x,a_y", "time_s;x61;y61", "timestamp\tUL.x\tUL.y\tUL.z",
                           "frame,timestamp,success,x_0,y_0,X_0,Y_0,Z_0", "a_x,a_y"};
  for (int i = 0; i < 10; ++i) {
    std::string text = headers[i % 5];
    const std::size_t columns = 1 + std::size_t(std::count_if(text.begin(), text.end(), [](char c) {
                                  return c == ',' || c == ';' || c == '\t';
                                }));
    const char separator = i % 5 == 1 ? ';' : i % 5 == 2 ? '\t' : ',';
    for (int row = 0; row < 4; ++row) {
      text += '\n';
      for (std::size_t c = 0; c < columns; ++c) {
        if (c > 0) text += separator;
        if (c == 0 || (i % 5 == 3 && c == 1)) {
          text += std::to_string(row * 0.04);
        } else if (random.next(6) > 0) {
          text += std::to_string(int(random.next(200)));
        }
      }
    }
    seed("c3d", "table_" + std::to_string(i) + ".csv", text + "\n");
  }
}

// Curves as corpora hold them: rates, columns, endings and marks differ.
void curves(Random& random) {
  const std::vector<std::string> names = {
      "fap3_open_jaw", "fap4_lower_t_midlip", "jaw", "fap51_lower_t_o", "a b", "x1"};
  const double rates[] = {25, 29.97, 50, 100, 1, 240};
  for (int i = 0; i < 36; ++i) {
    const double rate = rates[i % 6];
    const int columns = 1 + int(random.next(5)), rows = 1 + int(random.next(9));
    const char* end = i % 5 == 1 ? "\r\n" : "\n";
    std::string text = i % 7 == 2 ? "\xEF\xBB\xBF" : "";
    text += "time_s";
    for (int c = 0; c < columns; ++c) text += "," + names[std::size_t(c)];
    if (i % 4 == 3) text += ",measured";
    text += end;
    for (int row = 0; row < rows; ++row) {
      char number[40];
      std::snprintf(number, sizeof number, i % 3 == 0 ? "%.6f" : "%.4f", row / rate);
      text += number;
      for (int c = 0; c < columns; ++c) {
        std::snprintf(number, sizeof number, i % 2 == 0 ? ",%.3g" : ",%.0f",
                      std::sin(0.7 * row + c) * 400);
        text += number;
      }
      if (i % 4 == 3) text += row % 2 == 0 ? ",1" : ",0";
      text += end;
    }
    if (i % 6 == 4) text.resize(text.size() - 3);
    seed("curves", "curves_" + std::to_string(i), std::string(1, char(i % 2)) + text);
  }
  const char* const faults[] = {"time_s\n",
                                "time_s,a\n0,nan\n",
                                "time_s,a\n0,1e400\n",
                                "time_s,a\n0.5,1\n0.54,1\n",
                                "time_s,a,a\n0,1,2\n",
                                "time_s,a\n0,1\n0.04,2\n9,3\n",
                                "a,time_s\n1,0\n",
                                "time_s,a\n0,1,2\n",
                                "\n\n",
                                "time_s;a\n0;1\n"};
  for (std::size_t i = 0; i < std::size(faults); ++i) {
    seed("curves", "fault_" + std::to_string(i), std::string(1, char(i % 2)) + faults[i]);
  }
}

void rows() {
  const std::vector<std::string> tables = {
      "id\ttext\tsplit\na\thello there\ttrain\nb\tgood bye\ttest\n",
      "text\tid\nhello\ta1\n",
      "id\nbbaf2n\n",
      "# a comment\nid\tsplit\tspeaker\nx\ttrain\ts1\ny\ttrain\ts2\n",
      "id\tsplit\r\nx\ttrain\r\n",
      "id\ttext\na\n",
      "id\na\na\n",
      "id\n../a\n",
      "id\n.\n",
      "id\na/b\n",
      "text\nhello\n",
      "id\tsplit\nx\ttest\n",
      "id\tid\na\tb\n",
      "id\t\n\t\n",
      "\xEF\xBB\xBFid\tsplit\nx\ttrain\n"};
  for (std::size_t i = 0; i < tables.size(); ++i) {
    for (const char kind : {'\2', '\3'}) {
      seed("curves", "rows_" + std::to_string(i) + (kind == '\2' ? "_all" : "_split"),
           kind + tables[i]);
    }
  }
}

void poses() {
  const std::vector<std::string> tables = {
      "pose,jawOpen,mouthPucker\nrest,0.02,0\nAA,0.8,0.05\nUW,0.2,0.9\n",
      "key;jaw;lip\r\nNeutral;0;1\r\nM;;2\r\n",
      "jaw\tpose\n1\ta\n2\tb\n",
      "pose,jaw\nrest,0\nsil,1\n",
      "pose,jaw\na,1\nA,2\n",
      "pose,jaw,jaw\na,1,2\n",
      "pose,key,jaw\na,b,1\n",
      "pose,jaw\na,nan\nb,1e400\n",
      "pose,jaw\n,1\n",
      "pose,jaw\na,1e300\nb,-1e300\n",
      "pose\na\n",
      "pose,jaw\n"};
  for (std::size_t i = 0; i < tables.size(); ++i) {
    seed("curves", "poses_" + std::to_string(i),
         std::string(1, i % 3 == 1 ? '\5' : '\4') + tables[i]);
  }
}

void cases(Random& random) {
  for (int i = 0; i < 30; ++i) {
    conformance::Case one;
    one.name = "case_" + std::to_string(i);
    one.title = i % 3 == 0 ? "A face \"in quotes\" \\ \u00e4" : "A face";
    one.note = i % 2 == 0 ? "" : "line\nbreak";
    one.origin = "generated";
    one.object = i % 3 == 0 ? "face" : i % 3 == 1 ? "body" : "both";
    one.damaged = i % 4 == 3;
    if (one.damaged) one.errors = {"syntax", "truncated"};
    one.certainty = std::string(1, "CSMT?"[i % 5]);
    for (std::uint32_t f = random.next(12); f > 0; --f) {
      one.features.push_back("feature_" + std::to_string(f));
    }
    one.sections = {"3.1", "4"};
    if (i % 5 != 0) one.rate = "29.97";
    one.planes = int(random.next(100));
    one.intra_planes = int(random.next(10));
    one.largest_alphabet = int(random.next(1000));
    one.largest_plane_bits = std::int64_t(random.next(100000));
    one.files.push_back({"stream", one.name + ".fba", std::string(64, 'a'), 100});
    if (i % 2 == 0) one.files.push_back({"face", one.name + ".dec.fap", std::string(64, '0'), 7});
    if (i % 4 == 0) {
      one.files.push_back({"parameters", one.name + ".epf", std::string(64, '1'), 9});
      one.plane_start_codes = i % 8 == 0 ? "all" : "intra";
    }
    std::string text = conformance::write_case(one);
    seed("case", one.name, text);
    // Faults, one each.
    const std::pair<const char*, const char*> changes[] = {
        {"\"planes\": ", "\"planes\": \"many\", \"x\": "},
        {"case_", "../case_"},
        {"\"stream\"", "\"river\""},
        {"{", "[{"},
        {"\"features\": [", "\"features\": [[[["},
        {"decode", "perhaps"}};
    const auto& [what, by] = changes[std::size_t(i) % std::size(changes)];
    const std::size_t at = text.find(what);
    if (at == std::string::npos) continue;
    seed("case", "fault_" + std::to_string(i), text.replace(at, std::string(what).size(), by));
  }
}

void lines() {
  const std::string phones = "0 0.12 SIL\n0.12 0.2 HH\n0.2\t0.31\tAY\n0.31 0.4 B word more\n";
  const std::vector<std::string> texts = {
      phones,
      "start_s\tend_s\tphone\n" + phones,
      "# comment\n\n  \n" + phones,
      "0 1 aa1\r\n1 2 AH0\r\n",
      "0 1\n",
      "0 1 QQ\n",
      "nan inf AA\n-1 -2 AA\n1e308 1e309 AA\n",
      "+0.5 +0.75 m\n.5 .75 p\n0x1 0x2 b\n",
      "1,5 2,5 AA\n",
      std::string(5000, 'x') + "\n",
      std::string(3990, 'y') + " " + std::string(3000, 'z') + "\nend",
      "Hello, world. How are you?\nFine!\n",
      "\u4f60\u597d\n\u00dcber \u00c4rger\n",
      "last line without an end",
      "\n\n\n\n",
      std::string("zero \0 byte\n", 12),
      "\x1b[31m 0 1 AA\n",
      "{\"say\": \"hello\"}\n"};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    for (const int piece : {0, 2, 255}) {
      seed("lines", "lines_" + std::to_string(i) + "_" + std::to_string(piece),
           std::string(1, char(piece)) + texts[i]);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_corpus_tables CORPUS\n", stderr);
    return 2;
  }
  g_folder = argv[1];
  Random random;
  curves(random);
  poses();
  rows();
  cases(random);
  lines();
  Random own;  // so that the seeds above stay what they are
  captured(own);
  return 0;
}
