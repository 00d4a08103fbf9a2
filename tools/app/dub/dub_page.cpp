// report.html of a dub.
#include <algorithm>
#include <cmath>

#include "tools/app/dub/dub_report.h"
#include "tools/formats/common/text.h"
#include "tools/formats/common/xml.h"

namespace animeme::dub {

using tools::escape_xml;
using tools::format;

namespace {

// On narrow screens each row is a block of lines "name: value"; roles keep it a table for those
// who hear it.
constexpr const char* kDubStyle =
    ":root{color-scheme:light dark;--line:#c8c8c8;--bad:#a40019;--soft:#595959;--ink:#1b1b1b;"
    "--paper:#fff}"
    "@media(prefers-color-scheme:dark){"
    ":root{--line:#555;--bad:#ff9aa5;--soft:#b5b5b5;--ink:#eee;--paper:#16181b}}"
    "html{color:var(--ink);background:var(--paper)}"
    "*{box-sizing:border-box}"
    "body{font:16px/1.45 system-ui,sans-serif;margin:0 auto;max-width:80rem;padding:1rem}"
    "h1{font-size:1.5rem}h2{font-size:1.2rem;margin-top:2rem}"
    "table{border-collapse:collapse;width:100%}"
    "caption{text-align:left;color:var(--soft);padding-bottom:.5rem}"
    "th,td{padding:.35rem .4rem;text-align:left;vertical-align:top;"
    "border-bottom:1px solid var(--line);overflow-wrap:break-word}"
    "thead th{border-bottom:2px solid}"
    ".n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}"
    "thead th.n{white-space:normal}td span{overflow-wrap:anywhere}tbody th{min-width:6rem}"
    ".w{min-width:12rem}.n span{overflow-wrap:normal}.s span{overflow-wrap:normal}"
    ".bad{color:var(--bad);font-weight:600}"
    "@media(max-width:66rem){"
    "table,tbody,tr,td,tbody th,caption{display:block}"
    "thead{position:absolute;width:1px;height:1px;overflow:hidden;clip-path:inset(50%)}"
    "tr{border:1px solid var(--line);border-radius:.4rem;margin:0 0 .8rem;padding:.3rem 0}"
    "td,tbody th,.n,.w{border:0;min-width:0;padding:.15rem .7rem;display:grid;"
    "grid-template-columns:8.5rem 1fr;gap:.5rem;text-align:left;white-space:normal}"
    "td::before,tbody th::before{content:attr(data-name);color:var(--soft);font-weight:400}"
    "td:empty{display:none}}";

struct Column {
  const char* name;
  bool number;
};

std::string table_head(const char* caption, std::initializer_list<Column> columns) {
  std::string text = std::string("<table role=\"table\"><caption>") + caption +
                     "</caption>\n<thead role=\"rowgroup\"><tr role=\"row\">";
  for (const Column& one : columns) {
    text += std::string("<th scope=\"col\" role=\"columnheader\"") +
            (one.number ? " class=\"n\">" : ">") + one.name + "</th>";
  }
  return text + "</tr></thead>\n<tbody role=\"rowgroup\">\n";
}

std::string text_cell(const char* name, const std::string& text, const char* more = "") {
  return std::string("<td role=\"cell\" data-name=\"") + name + "\"" + more + ">" +
         (text.empty() ? "" : "<span>" + escape_xml(text) + "</span>") + "</td>";
}

std::string row_name(const char* name, const std::string& text) {
  return std::string("<th scope=\"row\" role=\"rowheader\" data-name=\"") + name + "\"><span>" +
         escape_xml(text) + "</span></th>";
}

std::string number_cell(const char* name, const std::string& text) {
  return text_cell(name, text, " class=\"n\"");
}

std::string name_of(const LanguageRow& row) {
  return row.speaker.empty() ? row.lang : row.lang + ", " + row.speaker;
}

std::string closed_text(const CueClosures& closures) {
  return closures.phones == 0 ? "" : format("%zu of %zu", closures.closed, closures.phones);
}

std::string time_text(double seconds) {
  const double whole = std::floor(std::max(0.0, seconds) / 60);
  return format("%.0f:%05.2f", whole, std::max(0.0, seconds) - 60 * whole);
}

std::string confidence_text(const std::optional<double>& confidence) {
  return confidence ? format("%.2f", *confidence) : "";
}

std::string state_text(const LanguageRow& row) {
  std::string text = row.error.empty() ? row.state : row.state + ": " + row.error;
  for (const std::string& warning : row.warnings) text += "; " + warning;
  return text;
}

std::string languages_table(const DubReport& report) {
  std::string text =
      table_head("Each language, in the order of the table", {{"Language", false},
                                                              {"State", false},
                                                              {"Subtitles", true},
                                                              {"Too long", true},
                                                              {"Characters to cut", true},
                                                              {"Latest end", true},
                                                              {"Speed", true},
                                                              {"Confidence", true},
                                                              {"P B M closed", true},
                                                              {"Length", true}});
  for (const LanguageRow& row : report.languages) {
    const bool made = row.state == "made", timed = made && row.cues > 0;
    text += "<tr role=\"row\">" + row_name("Language", name_of(row));
    text += text_cell("State", state_text(row),
                      !row.error.empty()     ? " class=\"bad w\""
                      : row.warnings.empty() ? " class=\"s\""
                                             : " class=\"w\"");
    text += number_cell("Subtitles", timed ? std::to_string(row.cues) : "");
    text += number_cell("Too long", timed ? std::to_string(row.late) : "");
    text += number_cell("Characters to cut", row.cut > 0 ? std::to_string(row.cut) : "");
    text += number_cell("Latest end", row.late > 0 ? format("%.2f s late", row.most_late) : "");
    text += number_cell(
        "Speed",
        timed ? format("%.2f to %.2f, mean %.2f", row.slowest, row.fastest, row.mean_speed) : "");
    text += number_cell("Confidence", confidence_text(row.confidence));
    text += number_cell("P B M closed", closed_text(row.closures));
    text += number_cell("Length", made ? time_text(row.seconds) : "") + "</tr>\n";
  }
  return text + "</tbody></table>\n";
}

std::string note_of(const CueRow& cue) {
  std::string note;
  const auto add = [&note](const std::string& one) { note += (note.empty() ? "" : "; ") + one; };
  if (cue.cut > 0) {
    add(format("ends %.2f s late: cut %zu character%s", cue.late, cue.cut,
               cue.cut == 1 ? "" : "s"));
  }
  if (cue.closures.closed < cue.closures.phones) {
    add(format("%zu of P, B, M stay open", cue.closures.phones - cue.closures.closed));
  }
  if (cue.pauses_cut >= 0.01) add(format("%.2f s of pauses taken out", cue.pauses_cut));
  if (cue.said - cue.start > 0.05) add(format("begins %.2f s later", cue.said - cue.start));
  return note;
}

std::string cues_table(const DubReport& report, std::size_t most) {
  std::string text = table_head("Each subtitle in each language, worst first. Lengths in seconds",
                                {{"Subtitle", false},
                                 {"Time", true},
                                 {"Text", false},
                                 {"Wanted", true},
                                 {"Made", true},
                                 {"Speed", true},
                                 {"Confidence", true},
                                 {"P B M closed", true},
                                 {"Note", false}});
  for (std::size_t i = 0; i < std::min(most, report.cues.size()); ++i) {
    const CueRow& cue = report.cues[i];
    const LanguageRow& row = report.languages[cue.language];
    const bool bad = cue.cut > 0 || cue.closures.closed < cue.closures.phones;
    const std::string in = " dir=\"auto\" lang=\"" + escape_xml(row.lang) + "\"";
    text += "<tr role=\"row\">" +
            row_name("Subtitle",
                     name_of(row) + (cue.number > 0 ? " " + std::to_string(cue.number)
                                                    : std::string(", the whole recording")));
    text += number_cell("Time", cue.number > 0 ? time_text(cue.start) : "");
    // The name in front of it on narrow screens is English.
    text += "<td role=\"cell\" data-name=\"Text\" class=\"w\">" +
            (cue.text.empty() ? "" : "<span" + in + ">" + escape_xml(cue.text) + "</span>") +
            "</td>";
    text += number_cell("Wanted", cue.wanted ? format("%.2f", *cue.wanted) : "");
    text += number_cell("Made", format("%.2f", cue.made));
    text += number_cell("Speed", format("%.2f", cue.speed));
    text += number_cell("Confidence", confidence_text(cue.confidence));
    text += number_cell("P B M closed", closed_text(cue.closures));
    text += text_cell("Note", note_of(cue), bad ? " class=\"bad w\"" : " class=\"w\"") + "</tr>\n";
  }
  return text + "</tbody></table>\n";
}

}  // namespace

std::string report_page(const DubReport& report, std::size_t most) {
  std::size_t cues = 0, late = 0, failed = 0, made = 0;
  CueClosures closures;
  for (const LanguageRow& row : report.languages) {
    cues += row.cues;
    late += row.late;
    failed += row.state == "failed" ? 1 : 0;
    made += row.state == "made" ? 1 : 0;
    closures.phones += row.closures.phones;
    closures.closed += row.closures.closed;
  }
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n<title>Dub</title>\n<style>" +
      std::string(kDubStyle) + "</style></head>\n<body><main><h1>Dub</h1>\n";
  page += format(
      "<p>%zu rows: %zu made, %zu failed. %zu subtitles: %zu in their time, %zu too "
      "long.",
      report.languages.size(), made, failed, cues, cues - late, late);
  if (closures.phones > 0) {
    page += format(" %zu of %zu P, B and M close the lips.", closures.closed, closures.phones);
  }
  page += "</p>\n<p>";
  page += report.film.name.empty()
              ? "There is no file with all languages."
              : "All languages are in <code>" + escape_xml(report.film.name) + "</code>" +
                    format(" (%llu bytes).", static_cast<unsigned long long>(report.film.bytes));
  page += " The same in numbers: <code>report.csv</code> and <code>report.json</code>.</p>\n";
  page += "<h2>Languages</h2>\n" + languages_table(report) + "<h2>Subtitles</h2>\n";
  if (report.cues.size() > most) {
    page += format("<p>The worst %zu of %zu; <code>report.csv</code> has all.</p>\n", most,
                   report.cues.size());
  }
  return page + cues_table(report, most) + "</main></body></html>\n";
}

}  // namespace animeme::dub
