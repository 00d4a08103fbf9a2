#include "dam/model/model.h"
#include "fap/rate_text.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/file_internal.h"

namespace animeme::inspect {

namespace {

using tools::Json;

std::string shown_value(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  return tools::format("%.3f", value.get<double>());
}

void add_lines(const Json& json, std::size_t indent, std::string& text) {
  const std::string pad(indent, ' ');
  for (const auto& [key, value] : json.items()) {
    if (value.is_object()) {
      text += pad + key + ":\n";
      add_lines(value, indent + 2, text);
    } else if (value.is_array() && !value.empty() && value.front().is_object()) {
      text += pad + key + ":\n";
      for (const Json& item : value) {
        std::string line;
        for (const auto& [name, field] : item.items()) {
          line += (line.empty() ? "" : "  ") + name + " " + shown_value(field);
        }
        text += pad + "  " + line + "\n";
      }
    } else if (value.is_array()) {
      std::string line;
      for (const Json& item : value) line += (line.empty() ? "" : ", ") + shown_value(item);
      if (!line.empty()) text += pad + key + ": " + line + "\n";
    } else if (const std::string shown = shown_value(value); !shown.empty()) {
      text += pad + key + ": " + shown + "\n";
    }
  }
}

}  // namespace

Result<Json> describe_model(std::span<const std::uint8_t> bytes) {
  Result<dam::Model> model = dam::read_model(bytes);
  if (!model) return model.error();
  Json phones = Json::array();
  const auto* animemes = std::get_if<dam::AnimemeParameters>(&model->parameters);
  std::size_t modes = 0;
  for (std::size_t i = 0; i < model->phones.size(); ++i) {
    const dam::PhoneModel& phone = model->phones[i];
    Json json = {{"phone", phone.label}, {"examples", phone.examples}};
    if (animemes != nullptr) {
      json["modes"] = animemes->phones[i].modes.size();
      modes += animemes->phones[i].modes.size();
    }
    phones.push_back(std::move(json));
  }
  Json json = {{"kind", "model"},
               {"method", dam::method_name(model->method)},
               {"bytes", bytes.size()},
               {"rate", fap::format_rate(model->rate)}};
  if (animemes != nullptr) {
    json["order"] = animemes->order;
    json["modes"] = modes;
  }
  json.update({{"phones", phones},
               {"controls", tools::json_list(model->controls, &dam::Control::name)},
               {"attribution", model->attribution},
               {"provenance", model->provenance}});
  return json;
}

Result<Json> describe_script(const dam::Timings& timings) {
  Json json = {{"kind", "script"}, {"format", timings.format}};
  if (!timings.notes.empty())
    json["warnings"] = tools::json_list(timings.notes, &dam::ScriptNote::describe);
  if (dam::has_words(timings)) {
    json["words"] = timings.labels.size();
    json["seconds"] = timings.labels.back().end;
    return json;
  }
  Result<dam::Script> script = dam::make_script(timings);
  if (!script) return script.error();
  json["phones"] = script->phones.size();
  json["seconds"] = script->duration();
  return json;
}

std::string tree_text(const Json& object) {
  std::string text;
  add_lines(object, 0, text);
  return text;
}

}  // namespace animeme::inspect
