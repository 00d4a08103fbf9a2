#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "dam/script/script.h"
#include "dam/script/table_text_internal.h"
#include "dam/script/timings.h"
#include "dam/script/viseme_phones.h"
#include "tests/support/shared.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::scripts {
namespace formats_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

fs::path folder(const std::string& name) { return test::data_dir() / "scripts" / name; }

std::string file_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// "B 250-300 IH 300-400", in milliseconds; words are in angle brackets, the word of a phone behind
// /.
std::string shown(const dam::Timings& timings) {
  std::string out;
  const auto milliseconds = [](double seconds) {
    return std::to_string(std::llround(seconds * 1000));
  };
  const auto add = [&](const std::string& label, double start, double end) {
    out += (out.empty() ? "" : " ") + label + " " + milliseconds(start) + "-" + milliseconds(end);
  };
  if (dam::has_words(timings)) {
    for (const dam::TimedLabel& label : timings.labels) {
      add(label.is_word ? "<" + label.label + ">" : label.label, label.start, label.end);
    }
    return out;
  }
  const auto script = dam::make_script(timings);
  if (!script) return script.error().describe();
  EXPECT_TRUE(dam::check_script(*script));
  for (const dam::Phone& phone : script->phones) {
    add(phone.label + (phone.word.empty() ? "" : "/" + phone.word), phone.start, phone.end);
  }
  return out;
}

// What most files say, with and without words, and with the silence at the end or without.
const std::string kPhones =
    "SIL 0-250 B 250-300 IH 300-400 N 400-500 SIL 500-600 B 600-650 L 650-720 UW 720-900";
const std::string kBoth =
    "SIL 0-250 B/bin 250-300 IH/bin 300-400 N/bin 400-500 SIL 500-600 B/blue 600-650 L/blue "
    "650-720 "
    "UW/blue 720-900";
const std::string kEnd = " SIL 900-1000";
const std::string kWords = "<bin> 250-500 <blue> 600-900";

struct Case {
  const char* file;
  const char* format;
  std::string says;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"short.TextGrid", "textgrid", kBoth + kEnd},
      {"mfa.json", "mfa", kBoth + kEnd},
      {"mfa.csv", "mfa", kBoth + kEnd},
      {"htk.lab", "htk",
       "SIL 0-250 B/BIN 250-300 IH/BIN 300-400 N/BIN 400-500 SIL 500-600 B/BLUE 600-650 "
       "L/BLUE 650-720 UW/BLUE 720-900 SIL 900-1000"},
      {"htk.mlf", "htk", kPhones + kEnd},
      {"festival.lab", "esps", kPhones + kEnd},
      {"timit.phn", "timit", kPhones + kEnd},
      {"timit.wrd", "timit", kWords},
      {"mbrola.pho", "pho", kPhones + kEnd},
      {"flite.txt", "flite", kPhones + kEnd},
      {"phones.ctm", "ctm", kPhones + kEnd},
      {"words.ctm", "ctm", kWords},
      {"gentle.json", "gentle", kBoth},
      {"whisperx.json", "words", "<Bin> 250-500 <2> 500-600 <blue.> 600-900"},
      {"sphinx.phseg", "phseg", kPhones + kEnd},
      {"sphinx.wdseg", "phseg", " 0-250 <BIN> 250-500  500-600 <BLUE> 600-900  900-1000"},
      {"audacity.txt", "labels", kPhones + kEnd},
      {"words.txt", "labels", kWords},
      {"rhubarb.tsv", "rhubarb",
       "SIL 0-250 P 250-300 S 300-500 SIL 500-600 P 600-650 S 650-720 UW 720-900"},
      {"rhubarb.json", "rhubarb",
       "SIL 0-250 P 250-300 S 300-500 SIL 500-600 P 600-650 S 650-720 UW 720-900 SIL 900-1000"},
      {"rhubarb.xml", "rhubarb",
       "SIL 0-250 P 250-300 S 300-500 SIL 500-600 P 600-650 S 650-720 UW 720-900 SIL 900-1000"},
      {"moho.dat", "moho",
       "SIL 0-250 P 250-292 S 292-500 SIL 500-583 P 583-625 L 625-708 UW 708-917"},
      {"words.srt", "subtitles", "<bin> 250-500 <blue.> 600-900"},
      {"highlighted.srt", "subtitles", "<Bin> 250-500 <blue.> 600-900"},
      {"karaoke.vtt", "subtitles", "<bin> 250-450 <a> 450-500 <blue> 600-800 <& so> 800-900"},
      {"azure_visemes.json", "azure",
       "SIL 0-250 P 250-300 IY 300-400 N 400-500 SIL 500-600 P 600-650 L 650-720 UW 720-900"},
      {"azure_messages.json", "azure", kWords},
      {"azure_batch.word.json", "azure", kWords},
      {"polly.json", "polly",
       "SIL 0-250 P/bin 250-300 IY/bin 300-400 N/bin 400-500 SIL 500-600 P/blue 600-650 "
       "N/blue 650-720 UW/blue 720-900"},
      // The last mark of a word has no end: 0.2 s and 0.1 s a letter, or the next word.
      {"polly_words.json", "polly", "<bin> 250-600 <blue> 600-1200"},
      {"elevenlabs.json", "elevenlabs", "<bin,> 250-500 <two.> 600-900"},
      {"elevenlabs_stream.json", "elevenlabs", "<bin> 250-500 <blue> 600-900"},
      {"inworld.json", "inworld",
       " 0-250 b 250-300 ɪ 300-400 n 400-500 b 600-650 l 650-720 uː 720-900 <2> 900-1000"},
      {"kokoro.json", "kokoro",
       "SIL 0-250 B/bin 250-324 IH/bin 324-426 N/bin 426-500 SIL 500-600 G/go 600-707 OW/go "
       "707-900"},
      {"kokoro_fastapi.json", "words", kWords},
      {"headtts.json", "headtts",
       "SIL 0-250 P/bin 250-300 IH/bin 300-400 N/bin 400-500 SIL 500-600 P/blue 600-650 "
       "N/blue 650-720 UW/blue 720-900"},
      {"cartesia.json", "cartesia", kPhones},
      {"pocketsphinx5.json", "pocketsphinx",
       "SIL 0-250 B/bin 250-300 IH/bin 300-400 N/bin 400-500 SIL 500-600 B/blue 600-650 L/blue "
       "650-720 UW/blue 720-900"},
      {"pocketsphinx5_words.json", "pocketsphinx", " 0-250 <bin> 250-500 <blue> 600-900  900-1000"},
      {"whispercpp.json", "whispercpp", "<Bin,> 250-500 <blue.> 600-900"},
      {"whispercpp_full.json", "whispercpp", "<Bin,> 250-500 <blue.> 600-900"},
      {"deepgram.json", "deepgram", "<Bin,> 250-500 <blue.> 600-900"},
      {"transcribe.json", "aws", "<Bin,> 250-500 <blue.> 600-900"},
      {"google.json", "google", kWords},
      {"azure_nbest.json", "azure",
       "SIL 0-250 B/bin 250-300 IH/bin 300-400 N/bin 400-490 SIL 490-600 B/blue 600-650 L/blue "
       "650-720 UW/blue 720-890"},
      {"aeneas.json", "aeneas", "<Bin,> 250-500 <so blue> 600-900"},
      {"speechmatics.json", "speechmatics", "<Bin> 250-500 <blue> 600-900"},
      {"rev.json", "rev", "<Bin,> 250-500 <blue.> 600-900"},
      {"papagayo.json", "papagayo",
       "SIL 0-250 P/bin 250-300 EH/bin 300-400 S/bin 400-500 SIL 500-600 P/blue 600-650 L/blue "
       "650-720 UW/blue 720-900"},
      {"papagayo.pgo", "papagayo",
       "SIL 0-250 P/bin 250-300 EH/bin 300-400 S/bin 400-500 SIL 500-600 P/blue 600-650 L/blue "
       "650-720 UW/blue 720-900"},
      {"vosk.json", "vosk", kWords},
      {"assemblyai.json", "words", "<Bin,> 250-500 <blue.> 600-900"},
      {"whisper.tsv", "tsv", "<Bin,> 250-500 <so blue> 600-900"},
      {"karaoke.lrc", "lrc", "<Bin> 250-600 <blue> 600-900 <go> 2000-2400 <go> 3000-3400"},
      {"karaoke.ass", "ass", "<Bin> 250-500 <blue> 600-900 <Hi, Bob> 1000-2000"},
      {"captions.ttml", "ttml", "<Bin & co> 250-500 <so blue> 600-900"},
      {"captions.sbv", "subtitles", "<Bin> 250-500 <so blue> 600-900"},
      {"pinyin.ctm", "ctm",
       "SIL 0-200 N 200-300 IY 300-450 K 450-550 AW 550-750 P 750-850 Y 850-950 AA 950-1050 NG "
       "1050-1150 CH 1150-1350 IH 1350-1550"},
      {"julius.lab", "labels",
       "SIL 0-200 K 200-300 OW 300-400 M 400-500 B 500-600 AA 600-700 K 700-900 IH 900-1000 SIL "
       "1000-1400"},
      {"latin1.tsv", "tsv", "<Tür> 250-500 <blau> 600-900"},
      {"utf16le.tsv", "tsv", "<Tür> 250-500 <blau> 600-900"},
      {"utf16be.tsv", "tsv", "<Tür> 250-500 <blau> 600-900"},
  };
  return all;
}

TEST(ScriptFormats, EachIsToldByItsContentAndRead) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.file);
    const auto timings = read_labels(file_text(folder("formats") / c.file));
    ASSERT_TRUE(timings) << timings.error().describe();
    EXPECT_EQ(timings->format, c.format);
    EXPECT_EQ(shown(*timings), c.says);
  }
}

TEST(ScriptFormats, EachIsReadByItsName) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.file);
    dam::ScriptOptions options;
    options.format = c.format;
    const auto timings = read_labels(file_text(folder("formats") / c.file), options);
    ASSERT_TRUE(timings) << timings.error().describe();
    EXPECT_EQ(shown(*timings), c.says);
  }
}

TEST(ScriptFormats, EveryFileAndEveryFormatHasACase) {
  std::set<std::string> files, formats;
  for (const Case& c : cases()) {
    files.insert(c.file);
    formats.insert(c.format);
  }
  for (const auto& entry : fs::directory_iterator(folder("formats"))) {
    EXPECT_TRUE(files.contains(entry.path().filename().string())) << entry.path();
  }
  for (const dam::ScriptFormat& format : script_formats()) {
    EXPECT_TRUE(formats.contains(std::string(format.name))) << format.name;
    EXPECT_FALSE(format.title.empty()) << format.name;
  }
}

// A label knows where it stands, so that what is wrong with it can be shown.
TEST(ScriptFormats, EveryLabelHasItsPlace) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.file);
    const auto timings = read_labels(file_text(folder("formats") / c.file));
    ASSERT_TRUE(timings);
    for (const dam::TimedLabel& label : timings->labels) {
      EXPECT_GT(label.line, 0) << label.label;
      EXPECT_TRUE(label.column > 0 || label.label.empty()) << label.label;
    }
  }
  const auto gentle = read_labels(file_text(folder("formats") / "gentle.json"));
  ASSERT_TRUE(gentle);
  EXPECT_EQ(gentle->labels[1].line, 9);
  EXPECT_EQ(gentle->labels[1].column, 9);
}

// The table of broken files: file, place, a part of the message.
TEST(ScriptFormats, BrokenFilesSayWhatIsWrongAndWhere) {
  std::set<std::string> named;
  const std::string table = file_text(folder("broken") / "messages.tsv");
  for (const dam::TableLine& line : dam::table_lines(table)) {
    const auto fields = dam::split_fields(line.text, '\t');
    ASSERT_EQ(fields.size(), 3u) << line.text;
    const std::string file(fields[0]);
    SCOPED_TRACE(file);
    named.insert(file);
    auto timings = read_labels(file_text(folder("broken") / file));
    const auto failed = [&]() -> Error {
      if (!timings) return timings.error();
      const auto script = dam::make_script(*timings);
      if (!script) return script.error();
      ADD_FAILURE() << "accepted: " << shown(*timings);
      return {};
    };
    const std::string said = failed().in_file("f").describe();
    EXPECT_EQ(said.substr(0, said.find(' ')), "f:" + std::string(fields[1])) << said;
    EXPECT_THAT(said, HasSubstr(std::string(fields[2])));
  }
  for (const auto& entry : fs::directory_iterator(folder("broken"))) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name == "messages.tsv" || named.contains(name)) << name << " has no line";
  }
}

TEST(ScriptFormats, TruncatedFilesNeverCrash) {
  for (const auto& entry : fs::directory_iterator(folder("formats"))) {
    const std::string good = file_text(entry.path());
    for (std::size_t size = 0; size < good.size(); size += 13) {
      const auto timings = read_labels(good.substr(0, size));
      if (timings && !dam::has_words(*timings)) (void)dam::make_script(*timings);
    }
  }
}

TEST(ScriptOptions, RateUnitAndTier) {
  dam::ScriptOptions options;
  options.format = "timit";
  options.rate = 8000;
  const auto slow = read_labels("0 2000 h#\n2000 4000 m\n", options);
  ASSERT_TRUE(slow);
  EXPECT_EQ(shown(*slow), "SIL 0-250 M 250-500");
  options = {};
  options.unit = dam::LabelUnit::words;
  const auto words = read_labels("0.1 0.2 to\n0.2 0.5 be\n", options);
  ASSERT_TRUE(words);
  EXPECT_EQ(shown(*words), "<to> 100-200 <be> 200-500");
  options = {};
  options.tier = "two";
  const auto recording =
      read_labels("#!MLF!#\n\"one\"\n0 500000 m\n.\n\"two\"\n0 600000 b\n.\n", options);
  ASSERT_TRUE(recording);
  EXPECT_EQ(shown(*recording), "B 0-60");
  options.tier = "words";
  const auto tier = read_labels(file_text(folder("formats") / "short.TextGrid"), options);
  ASSERT_TRUE(tier);
  EXPECT_EQ(shown(*tier), " 0-250 <bin> 250-500  500-600 <blue> 600-900  900-1000");
  options = {};
  options.format = "excel";
  const auto unknown = read_labels("x", options);
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("textgrid"));
}

// What is written is read again: .pho to a microsecond, WebVTT to a millisecond of each word.
TEST(ScriptWriters, PhoAndWebVttComeBack) {
  const auto timings = read_labels(file_text(folder("formats") / "mfa.csv"));
  ASSERT_TRUE(timings);
  const auto script = dam::make_script(*timings);
  ASSERT_TRUE(script);
  const auto pho = dam::read_script(dam::write_pho(*script));
  ASSERT_TRUE(pho) << pho.error().describe();
  ASSERT_EQ(pho->phones.size(), script->phones.size());
  for (std::size_t i = 0; i < script->phones.size(); ++i) {
    EXPECT_EQ(pho->phones[i].label, script->phones[i].label);
    EXPECT_NEAR(pho->phones[i].end, script->phones[i].end, 1e-6);
  }
  const auto vtt = read_labels(dam::write_webvtt(*script));
  ASSERT_TRUE(vtt);
  EXPECT_EQ(vtt->format, "subtitles");
  EXPECT_EQ(shown(*vtt), kWords);
  dam::Script wordless = *script;
  for (dam::Phone& phone : wordless.phones) phone.word.clear();
  const auto phones = read_labels(dam::write_webvtt(wordless));
  ASSERT_TRUE(phones);
  EXPECT_EQ(shown(*phones), kPhones);
  EXPECT_EQ(dam::write_script(*script, ".PHO"), dam::write_pho(*script));
  EXPECT_EQ(dam::write_script(*script, ".vtt"), dam::write_webvtt(*script));
  EXPECT_EQ(dam::write_script(*script, ".tsv"), dam::write_script_tsv(*script));
  EXPECT_EQ(dam::write_script(*script, ".TextGrid"), dam::write_textgrid(*script));
}

TEST(VisemePhones, HaveTheMouthOfTheirViseme) {
  using dam::VisemeSet;
  EXPECT_EQ(dam::phone_of_viseme(VisemeSet::azure, "21"), "P");
  EXPECT_EQ(dam::phone_of_viseme(VisemeSet::azure, "22"), std::nullopt);
  EXPECT_EQ(dam::phone_of_viseme(VisemeSet::polly, "S"), "SH");
  EXPECT_EQ(dam::phone_of_viseme(VisemeSet::polly, "s"), "S");
  EXPECT_EQ(dam::phone_of_viseme(VisemeSet::oculus, "viseme_PP"), "P");
  EXPECT_EQ(dam::phone_of_viseme(VisemeSet::rhubarb, "X"), "SIL");
}

}  // namespace formats_test
}  // namespace animeme::scripts
