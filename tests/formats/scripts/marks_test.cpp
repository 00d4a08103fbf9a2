// Marks are no words, in the readers of every format.
#include "dam/script/marks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "dam/script/phones.h"
#include "dam/script/script.h"
#include "dam/script/script_text_internal.h"
#include "tests/support/shared.h"
#include "tools/formats/scripts/script_text.h"

namespace animeme::scripts {
namespace marks_test {

using testing::HasSubstr;

// "<bob> my B -": words in angle brackets, silence as "-".
std::string said(const dam::Timings& timings) {
  std::string out;
  for (const dam::TimedLabel& label : timings.labels) {
    out += out.empty() ? "" : " ";
    out += label.label.empty() ? "-" : label.is_word ? "<" + label.label + ">" : label.label;
  }
  return out;
}

std::string read(const std::string& text, const dam::ScriptOptions& options = {}) {
  const auto timings = read_labels(text, options);
  return timings ? said(*timings) : timings.error().describe();
}

std::vector<dam::ScriptNote> notes(const std::string& text) {
  const auto timings = read_labels(text);
  return timings ? timings->notes : std::vector<dam::ScriptNote>{};
}

TEST(Marks, AreToldFromWordsAndPhones) {
  for (const char* mark : {"[noise]",
                           "<unk>",
                           "[Music]",
                           "(laughs)",
                           "{BR}",
                           "{CG}",
                           "*giggles*",
                           "[BLANK_AUDIO]",
                           "<usb>",
                           "gb",
                           "++NOISE++",
                           "+SPN+",
                           "[vocalized-noise]",
                           "<nib>",
                           "(door slams)",
                           "{LG}",
                           "&=laughs",
                           "[__]",
                           "<LAUGH-yeah>",
                           "NSN"}) {
    EXPECT_TRUE(dam::is_mark(mark) || dam::is_silence_spelling(mark)) << mark;
  }
  for (const char* word : {"Bob", "it's", "(a) or (b)", "{", "<", "*", "GB", "5", "a*b", "noise",
                           "(Bob", "Bob)", "[", "", "+", "C++", "#1", "usb", "laugh"}) {
    EXPECT_FALSE(dam::is_mark(word)) << word;
  }
  for (const char* mark : {"noise", "LAUGH", "breath_S", "NOISE1", "VOCNOISE", "fp", "dummy", "@@",
                           "*", "unk", "cough", "{B_TRANS}", "IVER"}) {
    EXPECT_TRUE(dam::is_mark_among_phones(mark)) << mark;
  }
  for (const dam::PhoneInfo& phone : dam::phones()) {
    EXPECT_FALSE(dam::is_mark_among_phones(phone.label)) << phone.label;
    EXPECT_FALSE(dam::is_mark_among_phones(phone.ipa)) << phone.ipa;
  }
  for (const char* phone : {"{", "}", "@", "&", "{:", "_", "ng", "ts", "aI", "i3", "N\\", "3:"}) {
    EXPECT_FALSE(dam::is_mark_among_phones(phone)) << phone;
  }
}

TEST(Marks, LeaveATextAsItIs) {
  using dam::MarksOf;
  const auto prose = [](std::string_view text) {
    return dam::without_marks(text, MarksOf::prose).text;
  };
  EXPECT_EQ(prose("[laughs] Hi Bob. (sighs) *giggles* Pam."), "Hi Bob. Pam.");
  EXPECT_EQ(prose("Bob (my dog) is *really* good [1]."), "Bob (my dog) is *really* good [1].");
  EXPECT_EQ(prose("2 * 3 * 4 (a sigh of relief"), "2 * 3 * 4 (a sigh of relief");
  EXPECT_EQ(prose("Well [clears throat], yes."), "Well, yes.");
  EXPECT_EQ(dam::without_marks("Hi [my dog] Bob", MarksOf::captions).text, "Hi Bob");
  const auto two = dam::without_marks("(coughs) I [noise] see", MarksOf::captions);
  EXPECT_EQ(two.count, 2u);
  EXPECT_EQ(two.mark, "(coughs)");
}

TEST(OddBytes, CostNoMoreThanThemselves) {
  const std::string rows = "start_s\tend_s\tword\n0\t0.5\tZ\xC3\xBCrich\n0.5\t1\tK\xF6ln\n";
  EXPECT_EQ(read(rows), "<Zürich> <Köln>");
  const auto told = notes(rows);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, dam::ScriptNote::Kind::odd_bytes);
  EXPECT_EQ(told[0].describe(),
            "line 3: 1 byte is not UTF-8; read as Windows-1252 where that gives a letter, else as "
            "U+FFFD");
  const std::string json = R"([{"word": "Zürich", "start": 0, "end": 1},)"
                           "\n{\"word\": \"K\xF6ln\", \"start\": 1, \"end\": 2}]";
  EXPECT_EQ(read(json), "<Zürich> <Köln>");
  ASSERT_EQ(notes(json).size(), 1u);
  EXPECT_EQ(notes(json)[0].line, 2);
}

TEST(Marks, OfRecognisersAreSilence) {
  const std::string ctm =
      "take 1 0.00 0.30 [noise]\ntake 1 0.30 0.35 bob\ntake 1 0.65 0.30 my\n"
      "take 1 0.95 0.55 puppy\ntake 1 1.50 0.40 <unk>\ntake 1 1.90 0.60 [laughter]\n";
  EXPECT_EQ(read(ctm), "- <bob> <my> <puppy> - -");
  const auto told = notes(ctm);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].count, 3u);
  EXPECT_EQ(told[0].line, 1);
  EXPECT_THAT(told[0].describe(), HasSubstr("line 1: the mark \"[noise]\" is silence"));
  EXPECT_THAT(told[0].describe(), HasSubstr("(3 in all)"));
  dam::ScriptOptions speak;
  speak.speak_marks = true;
  EXPECT_EQ(read(ctm, speak), "<[noise]> <bob> <my> <puppy> <<unk>> <[laughter]>");
}

TEST(Marks, OfJsonAndCaptionsAreSilence) {
  EXPECT_EQ(read(R"json([{"word": "[BLANK_AUDIO]", "start": 0, "end": 1},
                     {"word": "Bob", "start": 1, "end": 1.4},
                     {"word": "[upbeat", "start": 1.5, "end": 2},
                     {"word": "music]", "start": 2, "end": 2.5},
                     {"word": "(I", "start": 2.5, "end": 2.6},
                     {"word": "think)", "start": 2.6, "end": 3},
                     {"word": "gb", "start": 3, "end": 4}])json"),
            "- <Bob> - - <(I> <think)> -");
  EXPECT_EQ(read("1\n00:00:00,000 --> 00:00:01,000\n[Music] Hi Bob (laughs)\n\n"
                 "2\n00:00:01,000 --> 00:00:02,000\n<i>*giggles*</i>\n"),
            "<Hi Bob> -");
}

TEST(Marks, AmongPhonesOfEachAligner) {
  // FAVE, MAUS, SPPAS, Buckeye, Kaldi, PocketSphinx.
  EXPECT_EQ(read("0 0.1 {BR}\n0.1 0.2 B\n0.2 0.3 AA1\n0.3 0.4 {CG}\n0.4 0.5 B\n"), "- B AA1 - B");
  EXPECT_EQ(read("0 0.1 <usb>\n0.1 0.2 b\n0.2 0.3 Q\n0.3 0.4 b\n0.4 0.5 <nib>\n"), "- b Q b -");
  EXPECT_EQ(read("0 0.1 gb\n0.1 0.2 b\n0.2 0.3 A\n0.3 0.4 b\n0.4 0.5 noise\n0.5 0.6 @@\n"),
            "- b A b - -");
  EXPECT_EQ(read("0 0.1 VOCNOISE\n0.1 0.2 b\n0.2 0.3 aa\n0.3 0.4 LAUGH\n"), "- b aa -");
  EXPECT_EQ(read("u 1 0 0.1 SPN_S\nu 1 0.1 0.1 B_B\nu 1 0.2 0.1 AA1_E\nu 1 0.3 0.1 LAUGHTER_S\n"),
            "SPN_S B_B AA1_E -");
}

// Audacity's first label may be an empty one.
TEST(Marks, EmptyLabelsAreSilence) {
  EXPECT_EQ(read("0.0\t0.2\t\n0.2\t0.55\tBob\n0.55\t0.85\tmy\n0.85\t1.4\tpuppy\n"),
            "- <Bob> <my> <puppy>");
}

// Julius, TIMIT's 48 phones, Japanese labels: pauses, and closures that belong to the next stop.
TEST(Marks, PausesAndClosures) {
  const auto phones = [](const std::string& text) {
    const auto script = dam::read_script(text);
    if (!script) return script.error().describe();
    std::string out;
    for (const dam::Phone& phone : script->phones) {
      out += phone.label + " " + std::to_string(std::llround(phone.end * 1000)) + " ";
    }
    return out;
  };
  EXPECT_EQ(phones("0 0.2 silB\n0.2 0.3 b\n0.3 0.4 a\n0.4 0.6 sp\n0.6 0.8 silE\n"),
            "SIL 200 B 300 AA 400 SIL 800 ");
  EXPECT_EQ(phones("0 0.1 sil\n0.1 0.2 cl\n0.2 0.3 p\n0.3 0.4 aa\n0.4 0.5 vcl\n0.5 0.6 b\n0.6 0.7 "
                   "epi\n0.7 0.8 s\n0.8 0.9 cl\n0.9 1 sil\n"),
            "SIL 100 P 300 AA 400 B 600 SIL 700 S 800 SIL 1000 ");
}

// 5 % of the labels of any file become marks: what is left is spoken as before.
struct FileKind {
  const char* name;
  std::function<std::string(const dam::Script&)> write;
};

std::string rows(const dam::Script& script,
                 const std::function<std::string(const dam::Phone&)>& row, std::string text = {}) {
  for (const dam::Phone& phone : script.phones) text += row(phone) + "\n";
  return text;
}

std::string milliseconds(double seconds, double scale) {
  return std::to_string(std::llround(seconds * scale));
}

std::vector<FileKind> kinds() {
  const auto times = [](const dam::Phone& p, double scale, const char* between) {
    return milliseconds(p.start, scale) + between + milliseconds(p.end, scale) + between + p.label;
  };
  return {
      {"tsv", dam::write_script_tsv},
      {"textgrid", dam::write_textgrid},
      {"pho", dam::write_pho},
      {"labels",
       [=](const dam::Script& s) {
         return rows(s, [](const dam::Phone& p) {
           return std::to_string(p.start) + "\t" + std::to_string(p.end) + "\t" + p.label;
         });
       }},
      {"htk",
       [=](const dam::Script& s) {
         return rows(s, [=](const dam::Phone& p) { return times(p, 1e7, " "); });
       }},
      {"timit",
       [=](const dam::Script& s) {
         return rows(s, [=](const dam::Phone& p) { return times(p, 16000, " "); });
       }},
      {"ctm",
       [=](const dam::Script& s) {
         return rows(s, [](const dam::Phone& p) {
           return "u 1 " + std::to_string(p.start) + " " + std::to_string(p.duration()) + " " +
                  p.label;
         });
       }},
      {"phseg",
       [=](const dam::Script& s) {
         return rows(
             s,
             [](const dam::Phone& p) {
               return milliseconds(p.start, 100) + " " +
                      std::to_string(std::llround(p.end * 100) - 1) + " -5 " + p.label;
             },
             "SFrm Efrm SegAScr Phone\n");
       }},
      {"esps",
       [=](const dam::Script& s) {
         return rows(
             s, [](const dam::Phone& p) { return std::to_string(p.end) + " 121 " + p.label; },
             "separator ;\n#\n");
       }},
      {"mfa",
       [=](const dam::Script& s) {
         return rows(
             s,
             [](const dam::Phone& p) {
               return std::to_string(p.start) + "," + std::to_string(p.end) + "," + p.label +
                      ",phones,";
             },
             "Begin,End,Label,Type,Speaker\n");
       }},
  };
}

TEST(Marks, AFileWithSomeOfThemSpeaksTheSamePhones) {
  constexpr const char* kMarks[] = {"[noise]", "<unk>",   "{BR}",      "(laughs)", "*giggles*",
                                    "<usb>",   "gb",      "++NOISE++", "{LG}",     "noise",
                                    "LAUGH",   "[Music]", "<nib>",     "spn",      "sil"};
  std::mt19937 random(3);
  for (const FileKind& kind : kinds()) {
    for (int round = 0; round < 8; ++round) {
      dam::Script good;
      for (int i = 0; i < 200; ++i) {
        const double start = good.duration();
        const std::string label(dam::phones()[1 + random() % (dam::kPhoneCount - 1)].label);
        good.phones.push_back({start, start + 0.05 + double(random() % 10) / 100, label, {}});
      }
      dam::Script marked = good, silent = good;
      for (int k = 0; k < 10; ++k) {
        const std::size_t at = random() % good.phones.size();
        marked.phones[at].label = kMarks[random() % std::size(kMarks)];
        silent.phones[at].label = dam::kSilence;
      }
      const auto want = read_labels(kind.write(silent)), got = read_labels(kind.write(marked));
      ASSERT_TRUE(want) << want.error().describe();
      ASSERT_TRUE(got) << got.error().describe();
      EXPECT_EQ(got->format, kind.name);
      const auto first = dam::make_script(*want), second = dam::make_script(*got);
      ASSERT_TRUE(first) << kind.name << ": " << first.error().describe();
      ASSERT_TRUE(second) << kind.name << ": " << second.error().describe();
      EXPECT_EQ(*first, *second) << kind.name;
    }
  }
}

}  // namespace marks_test
}  // namespace animeme::scripts
