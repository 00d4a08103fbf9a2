// Rows and what became of them, on their way between processes.

#include "tools/app/batch/work.h"
#include "tools/formats/common/json.h"

namespace animeme::batch {

using tools::Json;

std::string task_message(const Task& task) {
  Json values = Json::array();
  for (const auto& [column, value] : task.row.values) values.push_back({column, value});
  return Json{{"line", task.row.line},
              {"values", values},
              {"known", task.known},
              {"bytes", task.known_bytes}}
      .dump();
}

Task read_task(std::string_view message) {
  const Json json = Json::parse(message).value();
  Task task;
  task.row.line = json["line"].get<std::int64_t>();
  for (const Json& one : json["values"]) task.row.values.emplace_back(one[0].text(), one[1].text());
  task.known = json["known"].text();
  task.known_bytes = json["bytes"].get<std::uint64_t>();
  return task;
}

std::string outcome_message(const Outcome& outcome) {
  const Entry& entry = outcome.entry;
  Json json = {{"id", entry.id},       {"good", entry.good},       {"outputs", entry.outputs},
               {"bytes", entry.bytes}, {"error", entry.error},     {"warnings", entry.warnings},
               {"hash", entry.hash},   {"version", entry.version}, {"same", outcome.same}};
  json["costs"] = Json::array();
  for (const tools::Cost& one : outcome.costs)
    json["costs"].push_back({one.cpu_seconds, one.bytes});
  if (entry.seconds) json["seconds"] = *entry.seconds;
  if (entry.confidence) json["confidence"] = *entry.confidence;
  return json.dump();
}

Outcome read_outcome(std::string_view message) {
  const Json json = Json::parse(message).value();
  Outcome outcome;
  Entry& entry = outcome.entry;
  entry.id = json["id"].text();
  entry.good = json["good"].get<bool>();
  entry.outputs = json["outputs"].get<std::vector<std::string>>();
  entry.bytes = json["bytes"].get<std::uint64_t>();
  entry.error = json["error"].text();
  entry.warnings = json["warnings"].get<std::vector<std::string>>();
  entry.hash = json["hash"].text();
  entry.version = json["version"].text();
  if (json.contains("seconds")) entry.seconds = json["seconds"].get<double>();
  if (json.contains("confidence")) entry.confidence = json["confidence"].get<double>();
  outcome.same = json["same"].get<bool>();
  for (std::size_t i = 0; i < outcome.costs.size(); ++i) {
    const Json& cost = json["costs"][i];
    outcome.costs[i] = {cost[0].get<double>(), cost[1].get<std::uint64_t>()};
  }
  return outcome;
}

}  // namespace animeme::batch
