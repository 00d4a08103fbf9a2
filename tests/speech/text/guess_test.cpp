#include "tools/speech/text/guess.h"

#include <gtest/gtest.h>

#include <iostream>

#include "tools/speech/text/spoken_text.h"

namespace animeme::text {
namespace guess_test {

std::string guess(std::string_view text) { return guess_language(code_points(text)); }

#define SKIP_WITHOUT_CLD2() \
  if (!can_guess()) GTEST_SKIP() << "built without CLD2"

TEST(Guess, LanguagesOfOneAlphabet) {
  SKIP_WITHOUT_CLD2();
  const std::pair<const char*, const char*> texts[] = {
      {"en", "The last train leaves at nine, so hurry up."},
      {"de", "Der letzte Zug fährt um neun, also beeil dich."},
      {"fr", "Le dernier train part à neuf heures, dépêche-toi."},
      {"es", "El último tren sale a las nueve, date prisa."},
      {"it", "L'ultimo treno parte alle nove, sbrigati."},
      {"pt", "O último comboio parte às nove, despacha-te."},
      {"nl", "De laatste trein vertrekt om negen uur, schiet op."},
      {"nb", "Det siste toget går klokken ni, så skynd deg."},
      {"sv", "Det sista tåget går klockan nio, så skynda dig."},
      {"pl", "Ostatni pociąg odjeżdża o dziewiątej, pospiesz się."},
      {"tr", "Son tren saat dokuzda kalkıyor, acele et."},
      {"fi", "Viimeinen juna lähtee yhdeksältä, pidä kiirettä."},
      {"bg", "Последният влак тръгва в девет, побързай."},
      {"ru", "Последний поезд отходит в девять, поторопись."},
      {"uk", "Останній поїзд відходить о дев'ятій, поспішай."},
      {"et", "Ma olen väsinud ja tahan magada."},
      {"lv", "Es esmu noguris un gribu gulēt."},
      {"lt", "Aš esu pavargęs ir noriu miegoti."},
      {"ro", "Sunt obosit și vreau să dorm."},
      {"ca", "Estic cansat i vull dormir."},
      {"sk", "Som unavený a chcem spať."},
      {"hr", "Umoran sam i želim spavati."},
      {"sl", "Utrujen sem in želim spati."},
      {"da", "Jeg er træt og vil gerne sove."},
      {"id", "Aku lelah dan ingin tidur."},
      {"sw", "Nimechoka na nataka kulala."},
  };
  std::size_t right = 0;
  for (const auto& [language, text] : texts) {
    right += guess(text) == language ? 1 : 0;
    if (guess(text) != language)
      std::cout << language << " as " << guess(text) << ": " << text << "\n";
  }
  std::cout << right << " of " << std::size(texts) << " sentences in their language\n";
  EXPECT_GE(right, 22u);
}

TEST(Guess, NothingOfTooLittle) {
  for (const char* text : {"", "12:30", "Hello", "No.", "a b", "🙂🙂"}) {
    EXPECT_EQ(guess(text), "") << text;
  }
}

TEST(Guess, SentenceBySentence) {
  SKIP_WITHOUT_CLD2();
  const std::u32string text =
      U"The last train is late. Le dernier train est en retard! Yes? Wir warten auf den Zug";
  const auto languages = guess_sentences(text);
  ASSERT_EQ(languages.size(), text.size());
  EXPECT_EQ(languages[0], "en");
  EXPECT_EQ(languages[text.find(U"Le dernier")], "fr");
  EXPECT_EQ(languages.back(), "de");
  EXPECT_EQ(languages[text.find(U"Yes")], guess_language(text)) << "too short for itself";
  EXPECT_TRUE(guess_sentences(U"").empty());
}

}  // namespace guess_test
}  // namespace animeme::text
