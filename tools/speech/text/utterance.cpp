#include "tools/speech/text/utterance.h"

#include <algorithm>

#include "tools/speech/text/chinese.h"
#include "tools/speech/text/japanese.h"
#include "tools/speech/text/late_internal.h"
#include "tools/speech/text/ssml.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/written.h"

namespace animeme::text {

namespace {

std::string digits_of(const SpokenText& said) {
  std::string digits;
  for (const char32_t c : said.text) {
    if (digit_value(c) >= 0) digits += char('0' + digit_value(c));
  }
  return digits;
}

// Letters and digits one by one.
SpokenText say_apart(const SpokenText& said) {
  SpokenText out;
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (!is_letter_or_digit(said.text[i])) continue;
    if (out.size() > 0) out.add(U" ", said.places[i]);
    out.add(said, i, i + 1);
  }
  return out;
}

// Digits one by one, with a pause where something else is between.
SpokenText say_telephone(const SpokenText& said) {
  SpokenText out;
  bool gap = false;
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (digit_value(said.text[i]) < 0) {
      gap = true;
      continue;
    }
    if (out.size() > 0) out.add(gap ? U", " : U" ", said.places[i]);
    out.add(said, i, i + 1);
    gap = false;
  }
  return out;
}

// Other words (UTF-8) that stand for all of it; as it is if there are none.
SpokenText say_instead(const SpokenText& said, const std::string& words) {
  if (words.empty() || said.size() == 0) return said;
  SpokenText out;
  out.add(code_points(words), said.place(0, said.size()));
  return out;
}

// The digits of it as "5th"; as it is if there are none, or the language has no such words.
SpokenText say_ordinal(const SpokenText& said, const std::string& language) {
  return say_instead(said, spell_number(digits_of(said), language, NumberForm::ordinal_digits));
}

// By the order of its format: `say-as interpret-as="date" format="dmy"`; as it is if it is no
// date.
SpokenText say_date(const SpokenText& said, const std::string& format,
                    const std::string& language) {
  std::vector<int> values;
  bool inside = false;
  for (const char32_t c : said.text) {
    const int digit = digit_value(c);
    if (digit >= 0 && !inside) values.push_back(0);
    if (digit >= 0 && values.back() < 100000) values.back() = values.back() * 10 + digit;
    inside = digit >= 0;
  }
  std::string order = format;
  std::erase_if(order, [](char c) { return c != 'd' && c != 'm' && c != 'y'; });
  order.erase(std::unique(order.begin(), order.end()), order.end());
  if (order.size() != 3 || values.size() != 3) return said;
  const auto part = [&](char name) { return values[std::min(order.find(name), std::size_t(2))]; };
  int year = part('y');
  if (year < 100) year += year < 70 ? 2000 : 1900;
  if (!is_date(year, part('m'), part('d'))) return said;
  return say_instead(said, spell_date(year, part('m'), part('d'), language));
}

constexpr std::string_view kNoWords =
    "Chinese is read character by character, which is wrong for words as 银行; install the Debian "
    "packages rime-data-pinyin-simp and rime-data-terra-pinyin";

// ＡＢＣ１２３ as ABC123, blanks as blanks.
SpokenText narrow(const SpokenText& said) {
  SpokenText out = said;
  for (char32_t& c : out.text) {
    if (c >= 0xFF01 && c <= 0xFF5E) c -= 0xFEE0;
    if (c == 0x3000) c = U' ';
  }
  return out;
}

// The characters of an item in the text as written. A pause parts words: "<s>Yes</s><s>No</s>".
std::u32string source_of(const Item& item) {
  return item.kind == ItemKind::pause ? std::u32string(U"\n") : item.text;
}

void replace_brackets(SpokenText& said) {
  std::replace(said.text.begin(), said.text.end(), U'[', U' ');
}

class Maker {
 public:
  Maker(Utterance& out, Speakers& speakers, const Helpers& helpers)
      : out_(out), speakers_(speakers), helpers_(helpers) {}

  Result<void> plain(const SpokenText& said, bool keep_emoji) {
    auto passages = part_passages(narrow(said), speakers_);
    if (!passages) return passages.error();
    keep_emoji_ = keep_emoji;
    out_.markup = passages->size() > 1 || (!passages->empty() && passages->front().speaker != 0);
    for (const Passage& passage : *passages) {
      auto read = read_passage(passage);
      if (!read) return read.error();
      emit(*read, passage.speaker, {});
    }
    close();
    return {};
  }

  Result<void> document(const Document& document) {
    out_.markup = true;
    out_.warnings.insert(out_.warnings.end(), document.warnings.begin(), document.warnings.end());
    const auto speaks = [](const Item& item) {
      const auto is_letter = [](char32_t c) { return c > U' ' && c != 0xA0; };
      return item.kind == ItemKind::text &&
             std::any_of(item.text.begin(), item.text.end(), is_letter);
    };
    const std::vector<Item>& items = document.items;
    const auto speech = std::find_if(items.begin(), items.end(), speaks);
    const auto rest = std::find_if(items.rbegin(), items.rend(), speaks).base();
    std::size_t at = 0, marks_before = 0;
    for (auto place = items.begin(); place != items.end(); ++place) {
      const Item& item = *place;
      const std::size_t first = at;
      at += source_of(item).size();
      const bool before = place < speech, behind = place >= rest;
      if (item.kind == ItemKind::pause && item.is_break && (before || behind)) {
        (before ? out_.lead_break : out_.tail_break) += item.seconds;
        continue;
      }
      if (item.kind == ItemKind::pause) add_pause(item.seconds);
      if (item.kind == ItemKind::mark) {
        tag("<mark name=\"" + std::to_string(out_.marks.size()) + "\"/>");
        out_.marks.push_back(item.name);
        out_.mark_shifts.push_back(before ? out_.lead_break : out_.tail_break);
        if (before) ++marks_before;
      }
      if (item.kind != ItemKind::text) continue;
      if (item.mood || item.mood_gain != 1) {
        out_.moods.push_back(
            {{std::uint32_t(first), std::uint32_t(at)}, item.mood, item.mood_gain});
      }
      SpokenText said = as_written(item.text, first);
      blank_smileys(said);
      if (!item.alias.empty() && said.size() > 0) said = say_instead(said, utf8(item.alias));
      if (auto done = add_text(item, said); !done) return done;
    }
    // The voice puts those in front of all words behind the breaks there.
    for (std::size_t i = 0; i < marks_before; ++i) out_.mark_shifts[i] -= out_.lead_break;
    close();
    return {};
  }

 private:
  void tag(const std::string& markup) { out_.input.add(code_points(markup), {}); }

  void close() {
    if (!(manner_ == Manner{}) && open_) tag("</prosody>");
    if (open_) tag("</voice>");
    open_ = false;
    manner_ = {};
  }

  void add_pause(double seconds) {
    tag("<break time=\"" + std::to_string(int(seconds * 1000)) + "ms\"/>");
  }

  // Opens voice and prosody if they are others than before. espeak-ng 1.51 forgets which voice
  // spoke around an element <voice>, so that there is one around everything.
  void begin(std::size_t speaker, const Manner& manner) {
    Manner wanted = manner;
    wanted.language.clear();
    wanted.voice.clear();
    if (open_ && speaker == speaker_ && wanted == manner_) return;
    if (open_ && speaker == speaker_) {
      if (!(manner_ == Manner{})) tag("</prosody>");
    } else {
      close();
      tag("<voice name=\"" + out_speaker(speaker).voice + "\">");
    }
    if (!(wanted == Manner{})) {
      const auto percent = [](const char* name, int value, int usual) {
        return value == usual ? std::string()
                              : std::string(" ") + name + "=\"" + std::to_string(value) + "%\"";
      };
      tag("<prosody" + percent("rate", wanted.rate, 100) + percent("pitch", wanted.pitch, 100) +
          percent("range", wanted.range, 100) + percent("volume", wanted.volume, 100) + ">");
    }
    open_ = true;
    speaker_ = speaker;
    manner_ = wanted;
  }

  const Speaker& out_speaker(std::size_t speaker) const { return speakers_.list[speaker]; }

  void emit(const SpokenText& said, std::size_t speaker, const Manner& manner) {
    if (out_.markup) begin(speaker, manner);
    const std::size_t first = out_.input.size();
    for (std::size_t i = 0; i < said.size(); ++i) {
      const char32_t c = said.text[i];
      const bool special = out_.markup && (c == U'<' || c == U'>' || c == U'&');
      if (!special) {
        out_.input.add(said, i, i + 1);
      } else {
        out_.input.add(c == U'<' ? U"&lt;" : c == U'>' ? U"&gt;" : U"&amp;", said.places[i]);
      }
    }
    if (said.size() > 0) out_.stretches.push_back({first, out_.input.size(), speaker});
  }

  Result<void> add_text(const Item& item, const SpokenText& said) {
    const auto main = speaker_of(item.manner);
    if (!main) return main.error();
    // The voice of the item first, the others by their scripts.
    Speakers around = speakers_;
    std::vector<std::size_t> numbers = {*main};
    for (std::size_t i = 0; i < speakers_.list.size(); ++i) {
      if (i != *main) numbers.push_back(i);
    }
    around.list.clear();
    for (const std::size_t i : numbers) around.list.push_back(speakers_.list[i]);
    around.by_words = item.manner.language.empty() && item.manner.voice.empty();
    auto passages = part_passages(narrow(said), around);
    if (!passages) return passages.error();
    for (std::size_t i = numbers.size(); i < around.list.size(); ++i) {
      numbers.push_back(speakers_.list.size());
      speakers_.list.push_back(around.list[i]);
    }
    for (Passage& passage : *passages) {
      passage.speaker = numbers[passage.speaker];
      if (auto done = add_passage(item, passage); !done) return done;
    }
    return {};
  }

  Result<void> add_passage(const Item& item, Passage passage) {
    const Speaker& speaker = speakers_.list[passage.speaker];
    replace_brackets(passage.said);
    if (!item.ipa.empty()) return add_ipa(item, passage);
    switch (item.say_as) {
      case SayAs::characters:
        begin(passage.speaker, item.manner);
        tag("<say-as interpret-as=\"characters\">");
        emit(passage.said, passage.speaker, item.manner);
        tag("</say-as>");
        return {};
      case SayAs::digits:
        passage.said = say_apart(passage.said);
        break;
      case SayAs::telephone:
        passage.said = say_telephone(passage.said);
        break;
      case SayAs::ordinal:
        passage.said = say_ordinal(passage.said, speaker.language);
        break;
      case SayAs::date:
        passage.said = say_date(passage.said, item.format, speaker.language);
        break;
      case SayAs::words:
        break;
    }
    auto read = read_passage(passage);
    if (!read) return read.error();
    emit(*read, passage.speaker, item.manner);
    return {};
  }

  Result<void> add_ipa(const Item& item, const Passage& passage) {
    const Speaker& speaker = speakers_.list[passage.speaker];
    std::vector<std::string> replaced;
    const std::string names =
        helpers_.mnemonics ? helpers_.mnemonics(speaker, item.ipa, replaced) : "";
    if (names.empty()) {
      out_.warnings.push_back("<phoneme ph=\"" + item.ipa + "\"> is no sound of the voice " +
                              speaker.name + "; its text is spoken");
      auto read = read_passage(passage);
      if (!read) return read.error();
      emit(*read, passage.speaker, item.manner);
      return {};
    }
    std::string list;
    for (const std::string& one : replaced) list += (list.empty() ? "" : ", ") + one;
    if (!list.empty()) {
      out_.warnings.push_back("<phoneme ph=\"" + item.ipa + "\"> has sounds that the voice " +
                              speaker.name + " does not have; it says " + list);
    }
    out_.mnemonics = true;
    SpokenText said;
    if (passage.said.size() > 0) {
      said.add(U" [[" + code_points(names) + U"]] ", passage.said.place(0, passage.said.size()));
    }
    emit(said, passage.speaker, item.manner);
    return {};
  }

  // The number of the voice that an item asks for.
  Result<std::size_t> speaker_of(const Manner& manner) {
    if (manner.language.empty() && manner.voice.empty()) return std::size_t(0);
    const std::string language =
        manner.language.empty() ? speakers_.list[0].language : manner.language;
    const auto found = helpers_.find ? helpers_.find(language, manner.voice) : std::nullopt;
    if (!found) {
      return make_error(Code::not_found,
                        manner.voice.empty()
                            ? "no voice for xml:lang=\"" + manner.language +
                                  "\" of this document; espeak-ng --voices lists all"
                            : "no voice \"" + manner.voice +
                                  "\" for this document; espeak-ng --voices lists all");
    }
    for (std::size_t i = 0; i < speakers_.list.size(); ++i) {
      if (speakers_.list[i].voice == found->voice) return i;
    }
    speakers_.list.push_back(*found);
    return speakers_.list.size() - 1;
  }

  Result<SpokenText> read_passage(const Passage& passage) {
    const Speaker& speaker = speakers_.list[passage.speaker];
    const bool han = speaker.letters != Letters::as_written || speaker.language == "yue";
    const SpokenText written =
        read_written(passage.said, {speaker.language, keep_emoji_, !han && !speaker.says_digits});
    std::u32string unread;
    SpokenText said = written;
    if (speaker.letters == Letters::pinyin) {
      if (!has_chinese_words() && !warned_) out_.warnings.emplace_back(kNoWords);
      warned_ = warned_ || !has_chinese_words();
      said = read_chinese(spell_han_numbers(written, false), unread);
    } else if (speaker.letters == Letters::kana) {
      auto kana = read_japanese(written, unread);
      if (!kana) return kana.error();
      said = *std::move(kana);
    } else if (speaker.language == "yue") {
      said = spell_han_numbers(written, false);
    }
    if (!unread.empty()) {
      out_.warnings.push_back("no reading for \"" + utf8(unread) + "\", which is left out");
    }
    return said;
  }

  Utterance& out_;
  Speakers& speakers_;
  const Helpers& helpers_;
  bool keep_emoji_ = false;
  bool open_ = false, warned_ = false;
  std::size_t speaker_ = 0;
  Manner manner_;
};

}  // namespace

Result<Utterance> make_utterance(std::string_view text, Speakers speakers, const Helpers& helpers) {
  Utterance out;
  Maker maker(out, speakers, helpers);
  if (is_ssml(text)) {
    const auto document = read_ssml(text);
    if (!document) return document.error();
    for (const Item& item : document->items) out.source += source_of(item);
    if (auto done = maker.document(*document); !done) return done.error();
  } else {
    out.source = code_points(text);
    const bool only_pictures = !has_words(out.source);
    SpokenText said = as_written(out.source);
    blank_smileys(said);
    if (auto done = maker.plain(said, only_pictures); !done) return done.error();
  }
  for (MoodPlace& place : find_moods(out.source)) out.moods.push_back(std::move(place));
  const auto is_ascii = [](char32_t code) { return code < 0x80; };
  if (!unicode_here() && !std::all_of(out.source.begin(), out.source.end(), is_ascii)) {
    out.warnings.push_back(late_text().error().message + "; the text goes to the voice as it is");
  }
  out.speakers = std::move(speakers.list);
  return out;
}

}  // namespace animeme::text
