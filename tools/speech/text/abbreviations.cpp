#include "tools/speech/text/abbreviations_internal.h"

#include <algorithm>
#include <span>

#include "tools/speech/text/context_internal.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

enum class Beside : std::uint8_t {
  anything,
  name,       // a word in upper case follows
  number,     // a digit follows
  amount,     // a digit is before
  place,      // a word in upper case is before, and no name follows
  place_end,  // as `place`, but what follows does not matter
  end,        // anything, and it is often at the end of a sentence
};

// In `written` a blank is any number of blanks or none, a last ~ a full stop or none.
// A first letter in lower case is one in upper case as well.
struct Abbreviation {
  std::u32string_view written, said;
  Beside where = Beside::anything;
};

constexpr Abbreviation kEnglish[] = {
    {U"WWI", U"World War one"},
    {U"WWII", U"World War two"},
    {U"WW II", U"World War two"},
    {U"St~", U"street", Beside::place},
    {U"Dr~", U"drive", Beside::place},
    {U"Ave~", U"avenue", Beside::place_end},
    {U"Blvd~", U"boulevard", Beside::place_end},
    {U"Rd~", U"road", Beside::place_end},
    {U"Hwy~", U"highway", Beside::number},
    {U"Dr~", U"doctor", Beside::name},
    {U"Mr~", U"mister", Beside::name},
    {U"Mrs~", U"missis", Beside::name},
    {U"Ms~", U"miz", Beside::name},
    {U"Messrs~", U"messers", Beside::name},
    {U"St~", U"saint", Beside::name},
    {U"Sgt~", U"sergeant", Beside::name},
    {U"Lt~", U"lieutenant", Beside::name},
    {U"Capt~", U"captain", Beside::name},
    {U"Cpt~", U"captain", Beside::name},
    {U"Cpl~", U"corporal", Beside::name},
    {U"Pvt~", U"private", Beside::name},
    {U"Cmdr~", U"commander", Beside::name},
    {U"Col.", U"colonel", Beside::name},
    {U"Gen.", U"general", Beside::name},
    {U"Maj.", U"major", Beside::name},
    {U"Adm.", U"admiral", Beside::name},
    {U"Gov.", U"governor", Beside::name},
    {U"Sen.", U"senator", Beside::name},
    {U"Rep.", U"representative", Beside::name},
    {U"Pres.", U"president", Beside::name},
    {U"Prof~", U"professor", Beside::name},
    {U"Rev.", U"reverend", Beside::name},
    {U"Hon.", U"honorable", Beside::name},
    {U"Supt~", U"superintendent", Beside::name},
    {U"Mt~", U"mount", Beside::name},
    {U"Ft~", U"fort", Beside::name},
    {U"Jr~", U"junior", Beside::end},
    {U"Sr~", U"senior", Beside::place_end},
    {U"Esq~", U"esquire", Beside::end},
    {U"vs~", U"versus"},
    {U"etc.", U"et cetera", Beside::end},
    {U"i. e.", U"that is"},
    {U"e. g.", U"for example"},
    {U"approx~", U"approximately"},
    {U"dept~", U"department"},
    {U"Co.", U"company", Beside::place_end},
    {U"Corp~", U"corporation", Beside::place_end},
    {U"Bros~", U"brothers", Beside::end},
    {U"no.", U"number", Beside::number},
    {U"nos.", U"numbers", Beside::number},
    {U"nr.", U"number", Beside::number},
    {U"Vol.", U"volume", Beside::number},
    {U"Vols.", U"volumes", Beside::number},
    {U"Fig.", U"figure", Beside::number},
    {U"Figs.", U"figures", Beside::number},
    {U"Ch.", U"chapter", Beside::number},
    {U"Sec.", U"section", Beside::number},
    {U"Eq.", U"equation", Beside::number},
    {U"p.", U"page", Beside::number},
    {U"pp.", U"pages", Beside::number},
    {U"est.", U"established", Beside::number},
    {U"ca.", U"circa", Beside::number},
    {U"c.", U"circa", Beside::number},
    {U"Jan.", U"January", Beside::number},
    {U"Feb.", U"February", Beside::number},
    {U"Mar.", U"March", Beside::number},
    {U"Apr.", U"April", Beside::number},
    {U"Aug.", U"August", Beside::number},
    {U"Sept.", U"September", Beside::number},
    {U"Sep.", U"September", Beside::number},
    {U"Oct.", U"October", Beside::number},
    {U"Nov.", U"November", Beside::number},
    {U"Dec.", U"December", Beside::number},
    {U"ft.", U"feet", Beside::amount},
    {U"lb~", U"pounds", Beside::amount},
    {U"lbs~", U"pounds", Beside::amount},
    {U"oz~", U"ounces", Beside::amount},
    {U"min.", U"minutes", Beside::amount},
    {U"sec.", U"seconds", Beside::amount},
    {U"hr~", U"hours", Beside::amount},
    {U"hrs~", U"hours", Beside::amount},
    {U"yrs~", U"years", Beside::amount},
};

constexpr Abbreviation kGerman[] = {
    {U"z. B.", U"zum Beispiel"},
    {U"bspw.", U"beispielsweise"},
    {U"d. h.", U"das heißt"},
    {U"u. a.", U"unter anderem"},
    {U"u. ä.", U"und Ähnliches", Beside::end},
    {U"o. ä.", U"oder Ähnliches", Beside::end},
    {U"o. Ä.", U"oder Ähnliches", Beside::end},
    {U"u. Ä.", U"und Ähnliches", Beside::end},
    {U"v. a.", U"vor allem"},
    {U"i. d. R.", U"in der Regel"},
    {U"z. T.", U"zum Teil"},
    {U"z. Zt.", U"zur Zeit"},
    {U"z. Z.", U"zur Zeit"},
    {U"u. U.", U"unter Umständen"},
    {U"m. E.", U"meines Erachtens"},
    {U"s. o.", U"siehe oben", Beside::end},
    {U"s. u.", U"siehe unten", Beside::end},
    {U"v. Chr.", U"vor Christus", Beside::end},
    {U"n. Chr.", U"nach Christus", Beside::end},
    {U"usw.", U"und so weiter", Beside::end},
    {U"u. s. w.", U"und so weiter", Beside::end},
    {U"usf.", U"und so fort", Beside::end},
    {U"etc.", U"et cetera", Beside::end},
    {U"bzw.", U"beziehungsweise"},
    {U"ca.", U"circa"},
    {U"evtl.", U"eventuell"},
    {U"ggf.", U"gegebenenfalls"},
    {U"inkl.", U"inklusive"},
    {U"exkl.", U"exklusive"},
    {U"vgl.", U"vergleiche"},
    {U"sog.", U"sogenannte"},
    {U"mind.", U"mindestens", Beside::number},
    {U"max.", U"maximal", Beside::number},
    {U"Nr.", U"Nummer"},
    {U"Tel.", U"Telefon"},
    {U"Mio~", U"Millionen"},
    {U"Mrd~", U"Milliarden"},
    {U"Tsd.", U"Tausend"},
    {U"Dr~", U"Doktor", Beside::name},
    {U"Prof~", U"Professor", Beside::name},
    {U"Hr~", U"Herr", Beside::name},
    {U"Hrn~", U"Herrn", Beside::name},
    {U"Fr~", U"Frau", Beside::name},
    {U"St~", U"Sankt", Beside::name},
    {U"Str.", U"Straße", Beside::place_end},
    {U"jr~", U"junior", Beside::end},
    {U"sen.", U"senior", Beside::end},
    {U"Abs.", U"Absatz", Beside::number},
    {U"Art.", U"Artikel", Beside::number},
    {U"S.", U"Seite", Beside::number},
    {U"Bd.", U"Band", Beside::number},
    {U"Kap.", U"Kapitel", Beside::number},
    {U"Abb.", U"Abbildung", Beside::number},
    {U"geb.", U"geboren", Beside::number},
    {U"gest.", U"gestorben", Beside::number},
    {U"Jh.", U"Jahrhundert", Beside::end},
    {U"Jhd.", U"Jahrhundert", Beside::end},
    {U"Std.", U"Stunden", Beside::amount},
    {U"Min.", U"Minuten", Beside::amount},
    {U"Sek.", U"Sekunden", Beside::amount},
    {U"Jan.", U"Januar", Beside::number},
    {U"Feb.", U"Februar", Beside::number},
    {U"Apr.", U"April", Beside::number},
    {U"Aug.", U"August", Beside::number},
    {U"Sept.", U"September", Beside::number},
    {U"Okt.", U"Oktober", Beside::number},
    {U"Nov.", U"November", Beside::number},
    {U"Dez.", U"Dezember", Beside::number},
};

constexpr Abbreviation kFrench[] = {
    {U"M.", U"monsieur", Beside::name},
    {U"MM.", U"messieurs", Beside::name},
    {U"Mr~", U"monsieur", Beside::name},
    {U"Mme~", U"madame", Beside::name},
    {U"Mmes~", U"mesdames", Beside::name},
    {U"Mlle~", U"mademoiselle", Beside::name},
    {U"Mlles~", U"mesdemoiselles", Beside::name},
    {U"Dr~", U"docteur", Beside::name},
    {U"Pr~", U"professeur", Beside::name},
    {U"Mgr~", U"monseigneur", Beside::name},
    {U"St~", U"saint", Beside::name},
    {U"Ste~", U"sainte", Beside::name},
    {U"n°", U"numéro", Beside::number},
    {U"nº", U"numéro", Beside::number},
    {U"n°s", U"numéros", Beside::number},
    {U"p. ex.", U"par exemple"},
    {U"par ex.", U"par exemple"},
    {U"c.-à-d.", U"c'est-à-dire"},
    {U"càd~", U"c'est-à-dire"},
    {U"etc.", U"et cetera", Beside::end},
    {U"av. J.-C.", U"avant Jésus-Christ", Beside::end},
    {U"apr. J.-C.", U"après Jésus-Christ", Beside::end},
    {U"ap. J.-C.", U"après Jésus-Christ", Beside::end},
    {U"av.", U"avenue", Beside::name},
    {U"bd~", U"boulevard", Beside::name},
    {U"env.", U"environ"},
    {U"tél.", U"téléphone"},
    {U"vol.", U"volume", Beside::number},
    {U"chap.", U"chapitre", Beside::number},
    {U"art.", U"article", Beside::number},
    {U"p.", U"page", Beside::number},
    {U"pp.", U"pages", Beside::number},
    {U"cf~", U"confer"},
    {U"s. v. p.", U"s'il vous plaît", Beside::end},
    {U"svp~", U"s'il vous plaît", Beside::end},
    {U"Cie", U"compagnie", Beside::end},
    {U"min.", U"minutes", Beside::amount},
    {U"janv.", U"janvier"},
    {U"févr.", U"février"},
    {U"juil.", U"juillet"},
    {U"sept.", U"septembre", Beside::amount},
    {U"oct.", U"octobre", Beside::amount},
    {U"nov.", U"novembre", Beside::amount},
    {U"déc.", U"décembre", Beside::amount},
};

constexpr Abbreviation kSpanish[] = {
    {U"Sr~", U"señor", Beside::name},
    {U"Sra~", U"señora", Beside::name},
    {U"Srta~", U"señorita", Beside::name},
    {U"Sres~", U"señores", Beside::name},
    {U"Dr~", U"doctor", Beside::name},
    {U"Dra~", U"doctora", Beside::name},
    {U"Prof~", U"profesor", Beside::name},
    {U"Profa~", U"profesora", Beside::name},
    {U"D.", U"don", Beside::name},
    {U"D.ª", U"doña", Beside::name},
    {U"Dña~", U"doña", Beside::name},
    {U"Sto~", U"santo", Beside::name},
    {U"Sta~", U"santa", Beside::name},
    {U"Ing.", U"ingeniero", Beside::name},
    {U"Lic.", U"licenciado", Beside::name},
    {U"Ud~", U"usted", Beside::end},
    {U"Uds~", U"ustedes", Beside::end},
    {U"Vd~", U"usted", Beside::end},
    {U"Vds~", U"ustedes", Beside::end},
    {U"EE. UU.", U"Estados Unidos", Beside::end},
    {U"EEUU", U"Estados Unidos"},
    {U"p. ej.", U"por ejemplo"},
    {U"etc.", U"etcétera", Beside::end},
    {U"núm.", U"número"},
    {U"n.º", U"número", Beside::number},
    {U"nº", U"número", Beside::number},
    {U"n°", U"número", Beside::number},
    {U"pág.", U"página"},
    {U"págs.", U"páginas"},
    {U"cap.", U"capítulo", Beside::number},
    {U"art.", U"artículo", Beside::number},
    {U"vol.", U"volumen", Beside::number},
    {U"avda.", U"avenida"},
    {U"Av.", U"avenida", Beside::name},
    {U"a. C.", U"antes de Cristo", Beside::end},
    {U"d. C.", U"después de Cristo", Beside::end},
    {U"tel.", U"teléfono"},
    {U"tfno.", U"teléfono"},
    {U"aprox.", U"aproximadamente"},
    {U"Cía.", U"compañía", Beside::end},
    {U"min.", U"minutos", Beside::amount},
};

constexpr Abbreviation kItalian[] = {
    {U"Sig~", U"signor", Beside::name},
    {U"Sig.ra", U"signora", Beside::name},
    {U"Sig.na", U"signorina", Beside::name},
    {U"Sigg~", U"signori", Beside::name},
    {U"Dott~", U"dottor", Beside::name},
    {U"Dr~", U"dottor", Beside::name},
    {U"Dott.ssa", U"dottoressa", Beside::name},
    {U"Prof~", U"professor", Beside::name},
    {U"Prof.ssa", U"professoressa", Beside::name},
    {U"Avv~", U"avvocato", Beside::name},
    {U"Ing~", U"ingegner", Beside::name},
    {U"Arch.", U"architetto", Beside::name},
    {U"On.", U"onorevole", Beside::name},
    {U"Mons.", U"monsignor", Beside::name},
    {U"S.", U"san", Beside::name},
    {U"ecc~", U"eccetera", Beside::end},
    {U"etc.", U"eccetera", Beside::end},
    {U"p. es.", U"per esempio"},
    {U"per es.", U"per esempio"},
    {U"ad es.", U"ad esempio"},
    {U"n.", U"numero", Beside::number},
    {U"n°", U"numero", Beside::number},
    {U"nº", U"numero", Beside::number},
    {U"pag.", U"pagina"},
    {U"pagg.", U"pagine"},
    {U"cap.", U"capitolo", Beside::number},
    {U"art.", U"articolo", Beside::number},
    {U"vol.", U"volume", Beside::number},
    {U"a. C.", U"avanti Cristo", Beside::end},
    {U"d. C.", U"dopo Cristo", Beside::end},
    {U"tel.", U"telefono"},
    {U"ca.", U"circa"},
    {U"min.", U"minuti", Beside::amount},
};

constexpr Abbreviation kPortuguese[] = {
    {U"Sr~", U"senhor", Beside::name},
    {U"Sra~", U"senhora", Beside::name},
    {U"Srta~", U"senhorita", Beside::name},
    {U"Srs~", U"senhores", Beside::name},
    {U"Dr~", U"doutor", Beside::name},
    {U"Dra~", U"doutora", Beside::name},
    {U"Prof~", U"professor", Beside::name},
    {U"Profa~", U"professora", Beside::name},
    {U"Prof.ª", U"professora", Beside::name},
    {U"D. Maria", U"dona Maria"},
    {U"D. Ana", U"dona Ana"},
    {U"D. Isabel", U"dona Isabel"},
    {U"D.ª", U"dona", Beside::name},
    {U"D.", U"dom", Beside::name},
    {U"Eng.", U"engenheiro", Beside::name},
    {U"S.", U"são", Beside::name},
    {U"Sto~", U"santo", Beside::name},
    {U"Sta~", U"santa", Beside::name},
    {U"V. Exa.", U"vossa excelência", Beside::end},
    {U"V. Ex.ª", U"vossa excelência", Beside::end},
    {U"Exmo~", U"excelentíssimo"},
    {U"Exma~", U"excelentíssima"},
    {U"n.º", U"número", Beside::number},
    {U"nº", U"número", Beside::number},
    {U"n°", U"número", Beside::number},
    {U"núm.", U"número"},
    {U"etc.", U"et cétera", Beside::end},
    {U"p. ex.", U"por exemplo"},
    {U"por ex.", U"por exemplo"},
    {U"Av.", U"avenida", Beside::name},
    {U"pág.", U"página"},
    {U"págs.", U"páginas"},
    {U"cap.", U"capítulo", Beside::number},
    {U"art.", U"artigo", Beside::number},
    {U"vol.", U"volume", Beside::number},
    {U"a. C.", U"antes de Cristo", Beside::end},
    {U"d. C.", U"depois de Cristo", Beside::end},
    {U"tel.", U"telefone"},
    {U"aprox.", U"aproximadamente"},
    {U"Cia.", U"companhia", Beside::end},
    {U"min.", U"minutos", Beside::amount},
};

constexpr Abbreviation kDutch[] = {
    {U"bijv.", U"bijvoorbeeld"},
    {U"bv.", U"bijvoorbeeld"},
    {U"b. v.", U"bijvoorbeeld"},
    {U"d. w. z.", U"dat wil zeggen"},
    {U"enz.", U"enzovoort", Beside::end},
    {U"etc.", U"et cetera", Beside::end},
    {U"o. a.", U"onder andere"},
    {U"e. d.", U"en dergelijke", Beside::end},
    {U"a. u. b.", U"alstublieft", Beside::end},
    {U"m. b. t.", U"met betrekking tot"},
    {U"i. v. m.", U"in verband met"},
    {U"t. o. v.", U"ten opzichte van"},
    {U"i. p. v.", U"in plaats van"},
    {U"m. a. w.", U"met andere woorden"},
    {U"n. a. v.", U"naar aanleiding van"},
    {U"z. s. m.", U"zo snel mogelijk", Beside::end},
    {U"t/m", U"tot en met"},
    {U"evt.", U"eventueel"},
    {U"incl.", U"inclusief"},
    {U"excl.", U"exclusief"},
    {U"ca.", U"circa"},
    {U"nr.", U"nummer"},
    {U"tel.", U"telefoon"},
    {U"blz.", U"bladzijde"},
    {U"dhr~", U"de heer", Beside::name},
    {U"mevr~", U"mevrouw", Beside::name},
    {U"mw~", U"mevrouw", Beside::name},
    {U"dr~", U"doctor", Beside::name},
    {U"drs~", U"doctorandus", Beside::name},
    {U"ir~", U"ingenieur", Beside::name},
    {U"mr~", U"meester", Beside::name},
    {U"prof~", U"professor", Beside::name},
    {U"St~", U"Sint", Beside::name},
    {U"jl.", U"jongstleden", Beside::end},
    {U"v. Chr.", U"voor Christus", Beside::end},
    {U"n. Chr.", U"na Christus", Beside::end},
    {U"mln~", U"miljoen", Beside::amount},
    {U"mld~", U"miljard", Beside::amount},
    {U"min.", U"minuten", Beside::amount},
};

std::span<const Abbreviation> table_of(std::string_view base) {
  if (base == "en") return kEnglish;
  if (base == "de") return kGerman;
  if (base == "fr") return kFrench;
  if (base == "es") return kSpanish;
  if (base == "it") return kItalian;
  if (base == "pt") return kPortuguese;
  if (base == "nl") return kDutch;
  return {};
}

// Where it ends if it stands at `at`; 0 if not.
std::size_t written_end(std::u32string_view text, std::size_t at, const Abbreviation& row) {
  const std::u32string_view written = row.written;
  std::size_t i = at;
  for (std::size_t k = 0; k < written.size(); ++k) {
    const char32_t c = written[k];
    if (c == U' ') {
      if (i < text.size() && is_space(text[i])) ++i;
    } else if (c == U'~') {
      if (i < text.size() && text[i] == U'.') ++i;
    } else if (i < text.size() && (text[i] == c || (k == 0 && lower(text[i]) == c))) {
      ++i;
    } else {
      return 0;
    }
  }
  if (i >= text.size()) return i;
  const bool digit = text[i - 1] == U'.' && digit_value(text[i]) >= 0;  // Nr.5
  return is_letter_or_digit(text[i]) && !digit ? 0 : i;
}

bool upper_before(std::u32string_view text, std::size_t at) {
  if (at > 1 && text[at - 2] == U'&' && is_space(text[at - 1])) return true;  // Smith & Co.
  const WordPlace word = word_before(text, at);
  return !word.empty() && word.last < at && is_upper(text[word.first]);
}

bool number_before(std::u32string_view text, std::size_t at) {
  for (std::size_t k = 0; k < 2 && at > 0 && is_space(text[at - 1]); ++k) --at;
  return at > 0 && kind_of(text[at - 1]) == Kind::digit;
}

bool number_behind(std::u32string_view text, std::size_t at) {
  const std::size_t next = spaces_end(text, at);
  return next < text.size() && digit_value(text[next]) >= 0;
}

// Words that a "no." behind them answers: "I said no. 5 people came."
bool answers(std::u32string_view text, std::size_t at) {
  const WordPlace word = word_before(text, at);
  return word.empty() ? at > 0
                      : has_word(" is said say says was answer answered answers oh told with ",
                                 lower_word(text, word));
}

// "J. M. Dupont", "Washington D. C.": a letter with others beside it.
bool is_initial(std::u32string_view text, std::size_t at, std::size_t end) {
  std::size_t last = at;
  while (last > 0 && at - last < 2 && is_space(text[last - 1])) --last;
  const bool before = last > 1 && text[last - 1] == U'.' && is_upper(text[last - 2]);
  const WordPlace next = word_behind(text, end);
  const bool behind =
      next.last == next.first + 1 && next.last < text.size() && text[next.last] == U'.';
  return before || behind;
}

bool fits(std::u32string_view text, std::size_t at, std::size_t end, const Abbreviation& row,
          std::string_view base) {
  switch (row.where) {
    case Beside::name:
      if (row.written.size() == 2 && is_initial(text, at, end)) return false;
      return upper_follows(text, end) ||
             (end + 1 < text.size() && text[end] == U'-' && is_upper(text[end + 1]));  // St-Pierre
    case Beside::number:
      return number_behind(text, end) &&
             !(text[at] == U'n' && row.said == U"number" && answers(text, at));
    case Beside::amount:
      return number_before(text, at);
    case Beside::place:
      return upper_before(text, at) &&
             (!upper_follows(text, end) || starter_follows(text, end, base));
    case Beside::place_end:
      return upper_before(text, at);
    default:
      return true;
  }
}

}  // namespace

Amount abbreviation_at(std::u32string_view text, std::size_t at, std::string_view base) {
  const char32_t first = at < text.size() ? text[at] : U' ', small = lower(first);
  for (const Abbreviation& row : table_of(base)) {
    if (row.written[0] != first && row.written[0] != small) continue;
    const std::size_t end = written_end(text, at, row);
    if (end == 0 || !fits(text, at, end, row, base)) continue;
    std::u32string words(row.said);
    const bool stop = text[end - 1] == U'.';
    const bool often =
        row.where == Beside::end || row.where == Beside::place_end || row.where == Beside::place;
    const bool begins = often ? upper_follows(text, end) : starter_follows(text, end, base);
    const bool leads = row.where == Beside::name || row.where == Beside::number;
    if (stop && (ends_text(text, end) || (begins && !leads))) words += U'.';
    if (end < text.size() && is_letter_or_digit(text[end])) words += U' ';
    return {end, words};
  }
  return {};
}

std::vector<std::u32string> meanings_of(std::u32string_view token, std::string_view base) {
  std::vector<std::u32string> all;
  if (token.empty()) return all;
  const char32_t small = lower(token[0]);
  for (const Abbreviation& row : table_of(base)) {
    if (row.written[0] != token[0] && row.written[0] != small) continue;
    // A full stop may have been taken for that of the sentence.
    const std::u32string whole = std::u32string(token) + U".";
    const bool fits = written_end(token, 0, row) == token.size() ||
                      (token.back() != U'.' && written_end(whole, 0, row) == whole.size());
    if (fits && std::find(all.begin(), all.end(), row.said) == all.end())
      all.emplace_back(row.said);
  }
  return all;
}

Amount sharp_at(std::u32string_view text, std::size_t at, std::string_view base) {
  struct Names {
    std::string_view base;
    std::u32string_view sharp, flat, plus;
  };
  constexpr Names kNames[] = {
      {"en", U"sharp", U"flat", U"plus"},    {"de", U"Scharp", U"b", U"plus"},
      {"fr", U"charpe", U"bémol", U"plus"},  {"es", U"charp", U"bemol", U"más"},
      {"it", U"sciarp", U"bemolle", U"più"}, {"pt", U"charpe", U"bemol", U"mais"},
      {"nl", U"sjarp", U"mol", U"plus"}};
  if (at + 1 >= text.size() || !is_letter(text[at])) return {};
  const auto ends = [&](std::size_t i) {
    return i >= text.size() || !(is_letter_or_digit(text[i]) || text[i] == text[i - 1]);
  };
  const char32_t sign = text[at + 1];
  const bool plus = sign == U'+' && at + 2 < text.size() && text[at + 2] == U'+' && ends(at + 3);
  const bool note = text[at] < 0x80 && is_upper(text[at]);
  const bool sharp = note && (sign == U'#' || sign == U'♯') && ends(at + 2);
  const bool flat = note && text[at] <= U'G' && sign == U'♭' && ends(at + 2);
  if (!plus && !sharp && !flat) return {};
  for (const Names& names : kNames) {
    if (names.base != base) continue;
    std::u32string words(1, text[at]);
    words += U' ';
    words += sharp ? names.sharp : flat ? names.flat : names.plus;
    if (plus) words += U' ' + std::u32string(names.plus);
    return {at + (plus ? 3 : 2), words};
  }
  return {};
}

}  // namespace animeme::text
