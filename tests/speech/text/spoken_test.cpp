// Numerals, fractions, abbreviations and amounts as people say them.
#include <gtest/gtest.h>

#include "tests/support/growth.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/written.h"

namespace animeme::text {
namespace spoken_test {

struct Reading {
  const char *language, *text, *said;
};

void check(const Reading& row) {
  const std::string said =
      utf8(read_written(as_written(code_points(row.text)), {row.language}).text);
  EXPECT_EQ(said, row.said) << row.language << ": " << row.text;
}

#define SKIP_WITHOUT_ICU() \
  if (!unicode_here()) GTEST_SKIP() << "built without ICU"

TEST(Spoken, RomanNumerals) {
  SKIP_WITHOUT_ICU();
  const Reading kRows[] = {
      {"en", "World War II, Henry VIII, chapter IV",
       "World War two, Henry the eighth, chapter four"},
      {"en", "World War I began", "World War one began"},
      {"en", "Pope John Paul II and King George V.",
       "Pope John Paul the second and King George the fifth."},
      {"en", "Henry VIII's wives", "Henry the eighth's wives"},
      {"en", "Queen Elizabeth I. She", "Queen Elizabeth the first. She"},
      {"en", "Elizabeth I of England", "Elizabeth the first of England"},
      {"en", "Rocky IV, Apollo XIII, Super Bowl LVII",
       "Rocky four, Apollo thirteen, Super Bowl fifty-seven"},
      {"en", "Act V, Scene II", "Act five, Scene two"},
      {"en", "an IV drip, the IV fluids, XX chromosomes",
       "an I V drip, the I V fluids, X X chromosomes"},
      {"en", "Malcolm X and I am", "Malcolm X and I am"},
      {"en", "vitamin C, an X-ray, Charles I know", "vitamin C, an X-ray, Charles I know"},
      {"en", "the chapter I read, the part I like", "the chapter I read, the part I like"},
      {"en", "I'm V. Smith, Louis I. Kahn", "I'm V. Smith, Louis I. Kahn"},
      {"en", "IIII VX IXI CIV MIX DVD", "IIII VX IXI CIV MIX DVD"},
      {"de", "Karl IV. war Kaiser.", "Karl der vierte war Kaiser."},
      {"de", "Elisabeth II. Sie kam.", "Elisabeth die zweite. Sie kam."},
      {"de", "unter Kaiser Wilhelm II.", "unter Kaiser Wilhelm dem zweiten."},
      {"de", "Papst Johannes Paul II. und Kapitel IV",
       "Papst Johannes Paul der zweite und Kapitel vier"},
      {"de", "die Frauen Heinrichs VIII.", "die Frauen Heinrichs des achten."},
      {"fr", "Louis XIV et François Ier au XVIIe siècle",
       "Louis quatorze et François premier au dix-septième siècle"},
      {"fr", "le XXe siècle, chapitre V", "le vingtième siècle, chapitre cinq"},
      {"es", "Felipe II, Isabel II y Alfonso XIII",
       "Felipe segundo, Isabel segunda y Alfonso XIII"},
      {"es", "Juan Carlos I, siglo XX", "Juan Carlos primero, siglo XX"},
      {"it", "Papa Leone X ed Elisabetta II", "Papa Leone decimo ed Elisabetta seconda"},
      {"pt", "Dom João VI, capítulo IV", "Dom João sexto, capítulo quatro"},
      {"nl", "Willem II en hoofdstuk IV", "Willem de tweede en hoofdstuk vier"},
      {"de", "im II. Weltkrieg, das II. Kapitel", "im zweiten Weltkrieg, das zweite Kapitel"},
      {"en", "WWII, Type II, Chapter VII: Home", "World War two, Type two, Chapter seven: Home"},
  };
  for (const Reading& row : kRows) check(row);
}

TEST(Spoken, Fractions) {
  SKIP_WITHOUT_ICU();
  const Reading kRows[] = {
      {"en", "2/3 of a cup, 5/8 inch, 1/2 hour",
       "two thirds of a cup, five eighths inch, one half hour"},
      {"en", "3/4, 1/3, 7/16, ½, ⅔",
       "three quarters, one third, seven sixteenths, one half, two thirds"},
      {"en", "1 1/2 cups, 2½ miles, 3 3/4.",
       "one and a half cups, two and a half miles, three and three quarters."},
      {"en", "2/3rds", "two thirds"},
      {"en", "24/7, 9/11, 7/11, 4/8, on 3/4, 1/2/2024, 3/4 time",
       "24 7, 9 11, 7 11, 4 8, on 3 4, January 2nd, 2024, 3 4 time"},
      {"en", "page 1/2, 0.1/2", "page 1 2, 0.1 2"},
      {"de", "3/4 der Zeit, 1/3, 2/3, 5/8",
       "drei Viertel der Zeit, ein Drittel, zwei Drittel, fünf achtel"},
      {"de", "2 1/2 Stunden, 1½", "zwei einhalb Stunden, ein einhalb"},
      {"fr", "3/4, 2/3, 1/2, 4/5", "trois quarts, deux tiers, un demi, quatre cinquièmes"},
      {"fr", "2 1/2 heures", "deux et demi heures"},
      {"es", "3/4, 2/3, 1/2, 5/12", "tres cuartos, dos tercios, un medio, cinco doceavos"},
      {"it", "3/4, 2/3, 2/5", "tre quarti, due terzi, due quinti"},
      {"pt", "3/4, 2/3, 5/12", "três quartos, dois terços, cinco doze avos"},
      {"nl", "3/4, 2/3, 1 1/2", "drie vierde, twee derde, een en een half"},
      {"sv", "3/4", "3 4"},
  };
  for (const Reading& row : kRows) check(row);
}

TEST(Spoken, Millions) {
  SKIP_WITHOUT_ICU();
  const Reading kRows[] = {
      {"en", "$1.5M and €2.5B", "1.5 million dollars and 2.5 billion euros"},
      {"en", "£3bn, $20k, $5 million, $1M.",
       "3 billion pounds, 20 thousand dollars, 5 million dollars, 1 million dollars."},
      {"en", "a $5 T-shirt, $5T", "a 5 dollars T-shirt, 5 trillion dollars"},
      {"en", "5 M people, $5 men", "5 M people, 5 dollars men"},
      {"de", "2,5 Mio. €, 3 Mrd. Euro", "2,5 Millionen Euro, 3 Milliarden Euro"},
      {"de", "$1,5M", "1,5 Millionen Dollar"},
      {"fr", "2,5 M€ et $5", "2,5 millions d'euros et 5 dollars"},
      {"es", "$3M", "3 millones de dólares"},
  };
  for (const Reading& row : kRows) check(row);
}

TEST(Spoken, Abbreviations) {
  SKIP_WITHOUT_ICU();
  const Reading kRows[] = {
      {"en", "Smith Jr., Sgt. Pepper, Mt. Fuji, cats vs. dogs",
       "Smith junior, sergeant Pepper, mount Fuji, cats versus dogs"},
      {"en", "Smith Jr. He said", "Smith junior. He said"},
      {"en", "It was Smith Jr.", "It was Smith junior."},
      {"en", "Dr. Smith lives in St. Ives on St. James St.",
       "doctor Smith lives in saint Ives on saint James street."},
      {"en", "42 Elm Dr. is near Main St. The end", "42 Elm drive is near Main street. The end"},
      {"en", "Lt. Col. Capt Ms. Lee", "lieutenant colonel captain miz Lee"},
      {"en", "No. 5, I said no. 5 came, Vol. 2", "number 5, I said no. 5 came, volume 2"},
      {"en", "apples, etc. Then", "apples, et cetera. Then"},
      {"en", "C# and C++, F# or B♭", "C sharp and C plus plus, F sharp or B flat"},
      {"en", "5 ft. tall, 3 lbs", "5 feet tall, 3 pounds"},
      {"en", "a mt. st. dr.", "a mt. st. dr."},
      {"de", "z.B. das, z. B. dies, d.h. so, d. h. so",
       "zum Beispiel das, zum Beispiel dies, das heißt so, das heißt so"},
      {"de", "Äpfel usw. Dann bzw. ca. 5", "Äpfel und so weiter. Dann beziehungsweise circa 5"},
      {"de", "Nr. 5, Dr. Müller, Fr. Maier, St. Pauli",
       "Nummer 5, Doktor Müller, Frau Maier, Sankt Pauli"},
      {"de", "Das ist Max. Er kam.", "Das ist Max. Er kam."},
      {"de", "am 2. Mai, der 3. Mann, Er ist 3. Dann",
       "am zweiten Mai, der dritte Mann, Er ist 3. Dann"},
      {"de", "in der 5. Minute, vom 1. bis 5. Mai, die 3. Klasse",
       "in der fünften Minute, vom ersten bis fünften Mai, die dritte Klasse"},
      {"fr", "M. Dupont et Mme Curie, n° 5, p. ex. ceci",
       "monsieur Dupont et madame Curie, numéro 5, par exemple ceci"},
      {"fr", "le 2e étage, la 1re fois, le 1er mai",
       "le deuxième étage, la première fois, le premier mai"},
      {"es", "el Sr. Pérez, la Sra. López, EE. UU., p. ej. esto",
       "el señor Pérez, la señora López, Estados Unidos, por ejemplo esto"},
      {"es", "1.º y 2.ª, núm. 5", "primero y segunda, número 5"},
      {"it", "il Sig. Rossi, la Sig.ra Bianchi, ecc. Poi",
       "il signor Rossi, la signora Bianchi, eccetera. Poi"},
      {"pt", "o Sr. Silva e a D. Maria, n.º 5", "o senhor Silva e a dona Maria, número 5"},
      {"nl", "bijv. dit, d.w.z. dat, dhr. Jansen, enz. Dan",
       "bijvoorbeeld dit, dat wil zeggen dat, de heer Jansen, enzovoort. Dan"},
  };
  for (const Reading& row : kRows) check(row);
}

TEST(Spoken, DecadesRanksAndFullHours) {
  SKIP_WITHOUT_ICU();
  const Reading kRows[] = {
      {"en", "the 1980s, the '90s, 1900's",
       "the nineteen eighties, the 'nineties, nineteen hundreds"},
      {"en", "the 100th and 5th, 5 s", "the one hundredth and 5th, 5 s"},
      {"en", "at 9:00, 9:00pm, 9:00 am, 9:05 or 15:30",
       "at 9 o'clock, 9 pm, 9 am, 9 oh 5 or 15:30"},
      {"en", "No.1, J. M. Dent", "number 1, J. M. Dent"},
      {"fr", "J. M. Dupont, M. Dupont", "J. M. Dupont, monsieur Dupont"},
  };
  for (const Reading& row : kRows) check(row);
}

TEST(Spoken, GermanClock) {
  SKIP_WITHOUT_ICU();
  const Reading kRows[] = {
      {"de", "um 9:30 Uhr", "um 9 Uhr 30"}, {"de", "9.00 Uhr, 21:05 Uhr.", "9 Uhr, 21 Uhr 5."},
      {"de", "1:15 Uhr", "ein Uhr 15"},     {"de", "um 9:30", "um 9:30"},
      {"de", "9.75 Uhr", "9.75 Uhr"},
  };
  for (const Reading& row : kRows) check(row);
}

// Each of them made a search start again at every character.
TEST(Spoken, LongTextsInLinearTime) {
  SKIP_WITHOUT_ICU();
  for (const char* unit :
       {"1,1,", "1 1 ", "( ( ", "a-", "5 - ", "$ ", "I ", "st. ", "1/2/", "w.", "1:", "9 Dr. "}) {
    const auto say = [&](std::size_t letters) {
      std::u32string text;
      while (text.size() < letters) text += code_points(unit);
      EXPECT_GT(read_written(as_written(text), {"en-us"}).size(), 0u);
    };
    EXPECT_LT(test::growth(say, 15'000), test::kMoreThanLinear) << unit;
  }
}

}  // namespace spoken_test
}  // namespace animeme::text
