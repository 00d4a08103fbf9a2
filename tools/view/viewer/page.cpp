#include <algorithm>
#include <span>

#include "dam/script/captions.h"
#include "dam/script/words.h"
#include "fap/head/shapes.h"
#include "fap/tables.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/xml.h"
#include "tools/view/viewer/detail/bytes.h"
#include "tools/view/viewer/detail/parts.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::viewer {
namespace {

using detail::Bytes;
using tools::Json;
using tools::json_list;

// JSON inside of a script element: nothing in it can end the element.
std::string script_text(const Json& json) {
  std::string out;
  for (const char c : detail::text_of(json)) out += c == '<' ? "\\u003c" : std::string(1, c);
  return out;
}

std::string packed(std::span<const std::uint8_t> bytes) {
  return detail::base64(detail::deflated(bytes));
}

void write_column(const std::vector<head::ControlValues>& frames, std::size_t control, Bytes& out) {
  std::int64_t last = 0;
  for (const head::ControlValues& frame : frames) {
    const std::int64_t value = std::lround(frame[control]);
    out.zigzag(value - last);
    last = value;
  }
}

// The columns of a clip: for each control that moves, differences from frame to frame; then those
// that the clip does not carry and that follow from others.
std::string pack_clip(const Clip& clip, const head::Rig& rig) {
  std::vector<head::ControlValues> frames;
  frames.reserve(clip.motion.frames.size());
  fap::Mask carried;
  for (const fap::Frame& frame : clip.motion.frames) {
    head::PoseOptions options;
    if (frames.size() < clip.visemes.size()) options.visemes = clip.visemes[frames.size()];
    frames.push_back(head::control_values(rig, frame, options));
    carried |= head::low_level(frame).mask;
  }
  std::vector<std::size_t> controls;
  std::vector<std::size_t> derived;
  for (std::size_t c = fap::kFirstLowLevel; c < frames.front().size(); ++c) {
    const bool moves = std::any_of(frames.begin(), frames.end(),
                                   [c](const auto& frame) { return std::lround(frame[c]) != 0; });
    const bool own = c > std::size_t(fap::kFapCount) || carried[c];
    if (moves) (own ? controls : derived).push_back(c);
  }
  Bytes data;
  for (const auto* list : {&controls, &derived}) {
    for (const std::size_t c : *list) write_column(frames, c, data);
  }
  const fap::Rate rate = clip.motion.rate;
  const Json header{{"name", clip.name},       {"rate", {rate.num, rate.den}},
                    {"start", clip.start},     {"first", clip.motion.frames.front().number},
                    {"frames", frames.size()}, {"controls", controls},
                    {"derived", derived}};
  return packed(detail::with_header(header, data));
}

Json fap_of(const fap::FapInfo& info) {
  return {{"number", info.number},
          {"name", info.name},
          {"group", info.group},
          {"unit", fap::unit_name(info.unit)},
          {"point", info.feature_point}};
}

Json phone_of(const dam::Phone& phone) {
  return Json::array({phone.start, phone.end, phone.label, phone.word});
}

// Lines of words [start, end, text, whether a blank follows]: captions of one line.
Json caption_lines(const dam::Script& script) {
  Json lines = Json::array();
  if (dam::words_of(script).empty()) return lines;
  for (const dam::Caption& caption : dam::captions_of(script, {.lines = 1})) {
    Json line = Json::array();
    const std::vector<dam::ScriptWord>& words = caption.lines.front();
    for (std::size_t i = 0; i < words.size(); ++i) {
      const bool blank =
          i + 1 == words.size() || dam::blank_between(words[i].text, words[i + 1].text);
      line.push_back(Json::array({words[i].start, words[i].end, words[i].text, blank}));
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

// Those of several people, each line as one of them says it, by time.
Json caption_lines_of(const std::vector<dam::Script>& scripts) {
  std::vector<Json> lines;
  for (const dam::Script& script : scripts) {
    const Json own = caption_lines(script);
    lines.insert(lines.end(), own.begin(), own.end());
  }
  const auto start = [](const Json& line) { return line.front().front().get<double>(); };
  std::stable_sort(lines.begin(), lines.end(),
                   [&](const Json& a, const Json& b) { return start(a) < start(b); });
  return json_list(lines, [](const Json& line) { return line; });
}

// The number of each one's head, from 0: who has the same shares it.
std::vector<std::size_t> heads_of(const std::vector<PagePerson>& people) {
  std::vector<const head::Head*> heads;
  std::vector<std::size_t> numbers;
  for (const PagePerson& person : people) {
    const auto known = std::find(heads.begin(), heads.end(), person.head);
    numbers.push_back(std::size_t(known - heads.begin()));
    if (known == heads.end()) heads.push_back(person.head);
  }
  return numbers;
}

Json facts_of(const Page& page) {
  Json facts{{"faps", json_list(fap::kFaps, fap_of)},
             {"groups", json_list(fap::kGroups, &fap::GroupInfo::name)},
             {"phones", json_list(page.script.phones, phone_of)},
             {"captions",
              page.scripts.empty() ? caption_lines(page.script) : caption_lines_of(page.scripts)}};
  const std::vector<std::size_t> heads = heads_of(page.people);
  if (!page.people.empty()) facts["people"] = Json::array();
  for (std::size_t i = 0; i < heads.size(); ++i) {
    const PagePerson& person = page.people[i];
    facts["people"].push_back(
        {{"name", person.clip.name}, {"model", heads[i]}, {"turned", person.turned}});
  }
  if (page.sound) facts["sound"] = page.sound->type;
  if (!page.tracks.empty()) {
    facts["tracks"] = Json::array({Json{{"lang", page.lang}, {"speaker", page.speaker}}});
    for (const OtherTrack& track : page.tracks) {
      Json one{{"lang", track.lang},
               {"speaker", track.speaker},
               {"phones", json_list(track.script.phones, phone_of)},
               {"captions", caption_lines(track.script)}};
      if (track.sound) one["sound"] = track.sound->type;
      facts["tracks"].push_back(std::move(one));
    }
  }
  if (!page.others.empty()) {
    facts["heads"] = {page.head_name};
    for (const OtherHead& other : page.others) facts["heads"].push_back(other.name);
  }
  return facts;
}

std::string data_element(const std::string& id, const std::string& text) {
  return "<script type=\"text/plain\" id=\"" + id + "\">" + text + "</script>\n";
}

// Heads and clips of people.
std::string people_elements(const Page& page) {
  std::string out;
  const std::vector<std::size_t> heads = heads_of(page.people);
  std::size_t next = 0;  // head
  for (std::size_t i = 0; i < heads.size(); ++i) {
    const PagePerson& person = page.people[i];
    if (heads[i] == next) {
      const std::string id = next == 0 ? "model" : "model_" + std::to_string(next);
      out += data_element(id, packed(pack_head(*person.head, *person.rig)));
      ++next;
    }
    out += data_element("clip" + std::to_string(i), pack_clip(person.clip, *person.rig));
  }
  return out;
}

std::string data_elements(const Page& page) {
  std::string out = "<script type=\"application/json\" id=\"facts\">" +
                    script_text(facts_of(page)) + "</script>\n";
  if (!page.people.empty()) {
    out += people_elements(page);
    if (page.sound) out += data_element("sound", detail::base64(page.sound->file));
    return out;
  }
  out += data_element("model", packed(pack_head(*page.head, *page.rig)));
  std::vector<std::string> clips;
  for (std::size_t i = 0; i < page.clips.size(); ++i) {
    clips.push_back(pack_clip(page.clips[i], *page.rig));
    out += data_element("clip" + std::to_string(i), clips.back());
  }
  for (std::size_t k = 0; k < page.others.size(); ++k) {
    const OtherHead& other = page.others[k];
    const std::string number = "_" + std::to_string(k + 1);
    out += data_element("model" + number, packed(pack_head(*other.head, *other.rig)));
    // Shapes have columns of their own; what moves by FAPs takes those of the first head.
    for (std::size_t i = 0; i < page.clips.size(); ++i) {
      const std::string clip = pack_clip(page.clips[i], *other.rig);
      if (clip != clips[i]) out += data_element("clip" + std::to_string(i) + number, clip);
    }
  }
  if (page.sound) out += data_element("sound", detail::base64(page.sound->file));
  for (std::size_t i = 0; i < page.tracks.size(); ++i) {
    const OtherTrack& track = page.tracks[i];
    const std::string name = "track" + std::to_string(i + 1);
    const std::string first = pack_clip(track.clip, *page.rig);
    out += data_element(name + "clip", first);
    for (std::size_t k = 0; k < page.others.size(); ++k) {
      const std::string clip = pack_clip(track.clip, *page.others[k].rig);
      if (clip != first) out += data_element(name + "clip_" + std::to_string(k + 1), clip);
    }
    if (track.sound) out += data_element(name + "sound", detail::base64(track.sound->file));
  }
  return out;
}

struct Mark {
  std::string_view name;
  std::string text;
};

// One pass: marks inside of what was put in are no marks.
std::string filled(std::string_view text, const std::vector<Mark>& marks) {
  std::string out;
  while (!text.empty()) {
    std::size_t first = std::string_view::npos;
    const Mark* next = nullptr;
    for (const Mark& mark : marks) {
      const std::size_t at = text.find(mark.name);
      if (at < first) {
        first = at;
        next = &mark;
      }
    }
    out += text.substr(0, first);
    if (next == nullptr) break;
    out += next->text;
    text.remove_prefix(first + next->name.size());
  }
  return out;
}

std::string head_modules() {
  return "const RIG_MODULE = '" + packed(detail::kRigModule) + "';\n" +
         std::string(detail::kHeadModules);
}

bool is_empty(const Clip& clip) { return clip.motion.frames.empty() || !clip.motion.rate.valid(); }

Result<void> check_people(const Page& page) {
  constexpr std::size_t kMostPeople = 8;
  if (page.people.size() > kMostPeople) {
    return make_error(Code::invalid_argument, "a page shows at most eight people");
  }
  for (const PagePerson& person : page.people) {
    if (person.head == nullptr || person.rig == nullptr || is_empty(person.clip)) {
      return make_error(Code::invalid_argument, "a person needs a head, its rig and a clip");
    }
  }
  return {};
}

std::string page_of(const Page& page, const std::string& title) {
  // Through JSON and back: what is no UTF-8 becomes a replacement mark.
  const std::string name = Json::parse(detail::text_of(title))->text();
  const std::string script = head_modules() + std::string(detail::kPageModules);
  return filled(detail::kTemplate, {{"<!--title-->", tools::escape_xml(name)},
                                    {"/*style*/", std::string(detail::kStyle)},
                                    {"<!--data-->", data_elements(page)},
                                    {"/*script*/", script}});
}

}  // namespace

Result<std::string> make_page(const Page& page) {
  if (!page.people.empty()) {
    if (auto good = check_people(page); !good) return good.error();
    return page_of(page, page.title.empty() ? page.people.front().clip.name : page.title);
  }
  if (page.head == nullptr || page.rig == nullptr) {
    return make_error(Code::invalid_argument, "a page needs a head and its rig");
  }
  for (const OtherHead& other : page.others) {
    if (other.head == nullptr || other.rig == nullptr) {
      return make_error(Code::invalid_argument, "another head needs its rig, too");
    }
  }
  if (page.clips.empty() || page.clips.size() > 2) {
    return make_error(Code::invalid_argument, "a page shows one clip, or two to compare");
  }
  if (page.clips.size() > 1 && !page.tracks.empty()) {
    return make_error(Code::invalid_argument, "two clips are compared in one language");
  }
  if (std::any_of(page.clips.begin(), page.clips.end(), is_empty) ||
      std::any_of(page.tracks.begin(), page.tracks.end(),
                  [&](const OtherTrack& track) { return is_empty(track.clip); })) {
    return make_error(Code::invalid_argument, "a clip needs frames and a rate");
  }
  return page_of(page, page.clips[0].name);
}

std::string_view head_script() {
  // Who uses it reads heads at once; the page has something else to do meanwhile.
  static const std::string script = head_modules() + "await rigReady;\n";
  return script;
}

}  // namespace animeme::viewer
