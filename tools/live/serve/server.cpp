#include "tools/live/serve/server.h"

#include <algorithm>
#include <system_error>

#include "tools/live/serve/say_intake.h"
#include "tools/speech/talking/spoken.h"
#include "tools/speech/talking/voice_command.h"

namespace animeme::serve {
namespace {

constexpr std::size_t kMostAsked = 256;                    // requests that wait
constexpr std::size_t kMostRequest = 65536;                // bytes of one
constexpr std::size_t kMostSound = std::size_t(64) << 20;  // bytes that wait for all heads together
constexpr int kMostHeads = 10000;
// A server that cannot keep up: a share of its planes comes so much later than it is due.
constexpr double kLate = 0.1, kLateShare = 0.01;  // seconds
constexpr std::size_t kLateSeconds = 11;          // ten seconds
constexpr std::int64_t kFewPlanes = 25;

Error bad(const std::string& sentence) { return make_error(Code::invalid_argument, sentence); }

// A body that nobody wants.
class Refused : public web::Intake {
 public:
  Refused(web::ServerReply reply, web::ServerAnswer answer)
      : reply_(std::move(reply)), answer_(std::move(answer)) {}
  void take(std::string, bool) override {}
  bool full() const override { return false; }
  void end(bool whole) override {
    if (whole) answer_(std::move(reply_));
  }

 private:
  web::ServerReply reply_;
  const web::ServerAnswer answer_;
};

Result<void> check_options(const ServerOptions& options) {
  if (options.most_heads < 1 || options.most_heads > kMostHeads) {
    return bad("a server has 1 to 10000 heads");
  }
  if (!(options.expire >= 0)) return bad("heads cannot expire before they are made");
  if (!(options.most_seconds >= 1)) return bad("a second of speech may wait at least");
  if (options.guard_viewers && options.token.empty()) {
    return bad("tickets of viewers are made with the token, and there is none");
  }
  return {};
}

int threads_of(const ServerOptions& options) {
  return options.threads > 0 ? options.threads : int(std::thread::hardware_concurrency());
}

}  // namespace

HeadServer::HeadServer(const ServerOptions& options)
    : options_(std::make_shared<const ServerOptions>(options)), journal_(options.log) {}

Result<std::unique_ptr<HeadServer>> HeadServer::open(
    const ServerOptions& options, const std::vector<std::pair<std::string, HeadSettings>>& heads) {
  if (auto ok = check_options(options); !ok) return ok.error();
  std::unique_ptr<HeadServer> server(new HeadServer(options));
  voice::keep_voices();  // one thread speaks: that of the voices
  try {
    server->voices_ =
        std::make_unique<Voices>(options.voices ? options.voices : [](const auto& voice) {
          return speech::voice_lines(voice);
        });
    server->loop_ =
        std::make_unique<ClockLoop>(media::steady_clock(), LoopOptions{threads_of(options)});
    // Processes of voices begin as copies of this one: the first one while it is small.
    Result<speech::LineMaker> voice = server->voices_->maker(options.defaults.voice);
    if (!voice) return voice.error();
    for (Desk* desk : {&server->others_, &server->makers_}) {
      desk->thread = std::thread([raw = server.get(), desk] { raw->work(*desk); });
    }
  } catch (const std::system_error&) {
    return make_error(Code::io, "no threads can be started for the heads");
  }
  web::ServerOptions web_options;
  web_options.web = options.web;
  web_options.most_message = SayIntake::kMostFile;
  web_options.intake = [raw = server.get()](const web::ServerRequest& request,
                                            web::ServerAnswer answer) {
    return raw->open_intake(request, std::move(answer));
  };
  if (options.guard_viewers) {
    web_options.may_watch = [raw = server.get()](const web::ServerRequest& request) {
      return raw->may_watch(request);
    };
  }
  auto web = web::WebServer::open(
      options.url, web_options,
      [raw = server.get()](web::ServerRequest request, web::ServerAnswer answer) {
        raw->ask(std::move(request), std::move(answer));
      });
  if (!web) return web.error();
  {
    const std::lock_guard lock(server->mutex_);
    server->server_ = std::move(*web);
  }
  for (const auto& [name, settings] : heads) {
    const auto made = server->make(name, settings, false);
    if (!made) return make_error(made.error().code, name + ": " + made.error().describe());
  }
  return server;
}

Result<void> HeadServer::change(const ServerOptions& options) {
  if (auto ok = check_options(options); !ok) return ok;
  const std::lock_guard one_at_a_time(making_);
  ServerOptions next = *this->options();
  next.token = options.token;
  next.most_heads = options.most_heads;
  next.expire = options.expire;
  next.most_seconds = options.most_seconds;
  next.most_bytes = options.most_bytes;
  next.make_on_say = options.make_on_say;
  next.defaults = options.defaults;
  next.models = options.models;
  next.tts = options.tts;
  next.performances = options.performances;
  if (next.guard_viewers && next.token.empty()) {
    return bad("tickets of viewers are made with the token, and there is none");
  }
  models_.clear();  // files may be others
  const std::lock_guard lock(options_mutex_);
  options_ = std::make_shared<const ServerOptions>(std::move(next));
  return {};
}

HeadServer::~HeadServer() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  if (server_) finish();
  for (Desk* desk : {&others_, &makers_}) {
    desk->changed.notify_all();
    if (desk->thread.joinable()) desk->thread.join();
  }
  for (const auto& [name, head] : all()) head->finish();
  const std::lock_guard lock(mutex_);
  heads_.clear();
}

Result<std::shared_ptr<const dam::Model>> HeadServer::model(const std::string& name) {
  const auto known = models_.find(name);
  if (known != models_.end()) return known->second;
  const auto options = this->options();
  const auto file = options->models.find(name);
  if (!name.empty() && file == options->models.end()) {
    std::string all;
    for (const auto& [each, path] : options->models) all += (all.empty() ? "" : ", ") + each;
    return make_error(
        Code::not_found,
        "there is no model '" + name.substr(0, 60) + "'" +
            (all.empty() ? "; models are named with --model NAME=FILE" : "; there are " + all));
  }
  Result<dam::Model> read = speech::read_model(name.empty() ? std::string() : file->second);
  if (!read) return read.error();
  return models_[name] = std::make_shared<const dam::Model>(std::move(*read));
}

Result<std::shared_ptr<const dam::Performance>> HeadServer::performance(
    const std::string& name) const {
  if (name.empty()) return std::shared_ptr<const dam::Performance>();
  const auto options = this->options();
  const auto known = options->performances.find(name);
  if (known != options->performances.end()) return known->second;
  std::string all;
  for (const auto& [each, over] : options->performances) all += (all.empty() ? "" : ", ") + each;
  return make_error(
      Code::not_found,
      "there is no performance '" + name.substr(0, 60) + "'" +
          (all.empty() ? "; performances are named with --over NAME=FILE" : "; there are " + all));
}

Result<std::shared_ptr<Head>> HeadServer::make(const std::string& name,
                                               const HeadSettings& settings, bool expires) {
  if (!is_head_name(name)) {
    return bad("a head is called by 1 to 64 letters, digits, -, _ and .");
  }
  const std::lock_guard one_at_a_time(making_);
  {
    const std::lock_guard lock(mutex_);
    const auto known = heads_.find(name);
    if (known != heads_.end()) {
      if (settings_json(known->second.head->settings()) == settings_json(settings)) {
        return known->second.head;
      }
      return bad("there is a head " + name + " with other settings; DELETE it before");
    }
    if (heads_.size() >= std::size_t(options()->most_heads)) {
      return make_error(Code::out_of_range, "there are " + std::to_string(heads_.size()) +
                                                " heads already, as many as may be (--max-heads)");
    }
  }
  Result<std::shared_ptr<Head>> head = open_head(name, settings);
  if (!head) return head;
  {
    const std::lock_guard lock(mutex_);
    heads_[name] = {*head, expires};
    most_ = std::max(most_, heads_.size());
  }
  loop_->add(*head);
  journal_.head(name, "made");
  return head;
}

// Names that only the server knows.
Result<void> HeadServer::check(const HeadSettings& settings) const {
  const auto list = [](const auto& names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return all;
  };
  const auto options = this->options();
  if (!settings.tts.empty() && !options->tts.contains(settings.tts)) {
    std::vector<std::string> names;
    for (const auto& [name, command] : options->tts) names.push_back(name);
    return bad("there is no voice '" + settings.tts.substr(0, 60) + "'" +
               (names.empty() ? "; commands are named with --tts NAME=COMMAND"
                              : "; there are " + list(names)));
  }
  if (settings.head.empty()) return {};
  std::vector<std::string> names{options->web.head_name};
  for (const web::WebHead& head : options->web.other_heads) names.push_back(head.name);
  std::erase(names, std::string());
  if (std::find(names.begin(), names.end(), settings.head) != names.end()) return {};
  return bad("the page has no head '" + settings.head.substr(0, 60) + "'" +
             (names.empty() ? "; heads are named with --head" : "; there are " + list(names)));
}

Result<HeadServer::Voice> HeadServer::voice(const HeadSettings& settings) {
  if (auto ok = check(settings); !ok) return ok.error();
  if (settings.tts.empty()) {
    Result<speech::LineMaker> maker = voices_->maker(settings.voice);
    if (!maker) return maker.error();
    return Voice{std::move(*maker), false};
  }
  speech::VoiceCommand command{.command = options()->tts.at(settings.tts)};
  command.input.language = settings.voice.language;
  Result<speech::LineMaker> maker = speech::command_lines(command);
  if (!maker) return maker.error();
  return Voice{std::move(*maker), true};
}

// With making_.
Result<std::shared_ptr<Head>> HeadServer::open_head(const std::string& name,
                                                    const HeadSettings& settings) {
  auto found = model(settings.model);
  if (!found) return found.error();
  Result<Voice> spoken = voice(settings);
  if (!spoken) return spoken.error();
  auto over = performance(settings.over);
  if (!over) return over.error();
  return Head::open(name, settings, *found, *over,
                    {*voices_, std::move(spoken->maker), spoken->slow, *server_, *loop_,
                     media::steady_clock(), journal_, options()->most_seconds});
}

Result<void> HeadServer::update(const std::string& name, const HeadSettings& settings) {
  const std::lock_guard one_at_a_time(making_);
  Kept known;
  {
    const std::lock_guard lock(mutex_);
    const auto found = heads_.find(name);
    if (found == heads_.end()) return make_error(Code::not_found, "there is no such head");
    known = found->second;
  }
  const HeadSettings old = known.head->settings();
  if (settings_json(old) == settings_json(settings)) return {};
  Result<Voice> spoken = voice(settings);
  if (!spoken) return spoken.error();
  if (settings_json(with_live_parts(old, settings)) == settings_json(settings)) {
    known.head->update(settings, std::move(spoken->maker), spoken->slow);
    journal_.head(name, "changed");
    return {};
  }
  if (auto found = model(settings.model); !found) return found.error();
  if (auto over = performance(settings.over); !over) return over.error();
  {
    const std::lock_guard lock(mutex_);
    heads_.erase(name);
  }
  end(known.head, true);
  Result<std::shared_ptr<Head>> head = open_head(name, settings);
  if (!head) return head.error();
  {
    const std::lock_guard lock(mutex_);
    heads_[name] = {*head, known.expires};
  }
  loop_->add(*head);
  journal_.head(name, "made anew");
  return {};
}

std::shared_ptr<Head> HeadServer::find(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = heads_.find(name);
  return found == heads_.end() ? nullptr : found->second.head;
}

void HeadServer::end(const std::shared_ptr<Head>& head, bool comes_back) {
  loop_->remove(head.get());
  const HeadFigures figures = head->figures();
  {
    const std::lock_guard lock(mutex_);
    head->add_lateness(gone_late_);
    gone_planes_ += figures.planes;
  }
  head->finish(comes_back);
}

bool HeadServer::remove(const std::string& name) {
  std::shared_ptr<Head> head;
  {
    const std::lock_guard lock(mutex_);
    const auto found = heads_.find(name);
    if (found == heads_.end()) return false;
    head = std::move(found->second.head);
    heads_.erase(found);
  }
  end(head);
  journal_.head(name, "ended");
  return true;
}

std::vector<std::pair<std::string, std::shared_ptr<Head>>> HeadServer::all() const {
  std::vector<std::pair<std::string, std::shared_ptr<Head>>> heads;
  const std::lock_guard lock(mutex_);
  for (const auto& [name, kept] : heads_) heads.emplace_back(name, kept.head);
  return heads;
}

// Over ten seconds. New heads would make it worse.
void HeadServer::look_at_lateness() {
  media::LatenessMeter late;
  for (const auto& [name, head] : all()) head->add_lateness(late);
  const std::lock_guard lock(mutex_);
  late.add(gone_late_);
  seconds_.push_back({late.count(), late.count() - late.count_below(kLate)});
  if (seconds_.size() > kLateSeconds) seconds_.pop_front();
  const std::int64_t planes = seconds_.back().all - seconds_.front().all;
  const std::int64_t behind = seconds_.back().late - seconds_.front().late;
  late_ = planes >= kFewPlanes && double(behind) > kLateShare * double(planes);
}

void HeadServer::look() {
  look_at_lateness();
  std::size_t sound = 0;
  for (const auto& [name, head] : all()) sound += head->sound_waiting();
  sound_waiting_ = sound;
  const double expire = options()->expire;
  if (expire <= 0) return;
  std::vector<std::string> old;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, kept] : heads_) {
      if (kept.expires && kept.head->figures().idle > expire) old.push_back(name);
    }
  }
  for (const std::string& name : old) remove(name);
}

void HeadServer::drain() {
  const std::lock_guard lock(mutex_);
  draining_ = true;
}

bool HeadServer::draining() const {
  const std::lock_guard lock(mutex_);
  return draining_;
}

bool HeadServer::silent() const {
  const auto heads = all();
  return std::all_of(heads.begin(), heads.end(),
                     [](const auto& one) { return one.second->silent(); });
}

void HeadServer::finish() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = draining_ = true;
  }
  for (Desk* desk : {&others_, &makers_}) {
    desk->changed.notify_all();
    if (desk->thread.joinable()) desk->thread.join();
  }
  for (const auto& [name, head] : all()) {
    loop_->remove(head.get());
    head->hush("the server ends");
  }
  server_->finish();
}

bool HeadServer::makes_a_head(const web::ServerRequest& request) const {
  constexpr std::string_view kPath = "/heads/", kSaying = "/say";
  if (!request.path.starts_with(kPath)) return false;
  if (request.method != "PUT" && request.method != "POST" && request.method != "PATCH") {
    return false;
  }
  std::string name = request.path.substr(kPath.size());
  if (!name.ends_with(kSaying)) return name.find('/') == std::string::npos;
  name.resize(name.size() - kSaying.size());
  return options()->make_on_say && !heads_.contains(name);
}

// In the thread of the server.
void HeadServer::ask(web::ServerRequest request, web::ServerAnswer answer) {
  answer = [this, method = request.method, path = request.path, answer = std::move(answer),
            begun = media::steady_clock().now()](web::ServerReply reply) {
    journal_.request(method, path, reply.status, media::steady_clock().now() - begun);
    answer(std::move(reply));
  };
  if (request.method == "GET" && request.path == "/health") return answer(health());
  if (request.method == "GET" && request.path == "/ready") return answer(ready());
  {
    const std::lock_guard lock(mutex_);
    Desk& desk = makes_a_head(request) ? makers_ : others_;
    if (!stopping_ && server_ && desk.jobs.size() < kMostAsked) {
      desk.jobs.push_back([this, request = std::move(request), answer = std::move(answer)] {
        try {
          answer(this->answer(request));
        } catch (const std::exception&) {  // memory
          answer({500, "{\"error\": \"There is not enough memory for this.\"}\n"});
        }
      });
      desk.changed.notify_one();
      return;
    }
  }
  web::ServerReply busy{503, "{\"error\": \"The server is busy or about to end; try again.\"}\n"};
  busy.retry_after = 1;
  answer(std::move(busy));
}

void HeadServer::post(std::function<void()> job) {
  const std::lock_guard lock(mutex_);
  if (stopping_) return;
  others_.jobs.push_back(std::move(job));
  others_.changed.notify_one();
}

void HeadServer::work(Desk& desk) {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (desk.jobs.empty()) {
      desk.changed.wait(lock);
      continue;
    }
    std::function<void()> job = std::move(desk.jobs.front());
    desk.jobs.pop_front();
    lock.unlock();
    try {
      job();
    } catch (const std::exception&) {  // memory: what it was for is lost, the server stays
    }
    job = nullptr;
    lock.lock();
  }
}

// In the thread of the server.
Result<std::shared_ptr<web::Intake>> HeadServer::open_intake(const web::ServerRequest& request,
                                                             web::ServerAnswer answer) {
  const std::shared_ptr<web::Intake> none;
  constexpr std::string_view kPath = "/heads/", kSaying = "/say";
  Result<IntakeFormat> format = intake_format(request.type, request.query);
  // What is small and whole is a request like others.
  const bool large = request.length < 0 || request.length > std::int64_t(kMostRequest);
  const bool lines = format && format->kind == IntakeFormat::Kind::lines;
  if (!request.socket && lines && !large) return none;
  if (!request.path.starts_with(kPath) || !request.path.ends_with(kSaying)) return none;
  const std::string name =
      request.path.substr(kPath.size(), request.path.size() - kPath.size() - kSaying.size());
  if (!request.socket) {
    answer = [this, method = request.method, path = request.path, answer = std::move(answer),
              begun = media::steady_clock().now()](web::ServerReply reply) {
      journal_.request(method, path, reply.status, media::steady_clock().now() - begun);
      answer(std::move(reply));
    };
  }
  const auto refused = [&](unsigned status, const Error& error) {
    if (request.socket) return Result<std::shared_ptr<web::Intake>>(error);
    web::ServerReply reply{status, tools::Json{{"error", error.describe()}}.dump() + "\n"};
    if (status == 503) reply.retry_after = 1;
    return Result<std::shared_ptr<web::Intake>>(
        std::make_shared<Refused>(std::move(reply), std::move(answer)));
  };
  if (!allowed(request)) return refused(401, bad("this needs the token of the server"));
  if (!format) return refused(400, format.error());
  const std::shared_ptr<Head> head = find(name);
  if (!head) return refused(404, make_error(Code::not_found, "there is no such head"));
  if (draining() && !request.socket) return refused(503, bad("the server is about to end"));
  SayIntake::Services services;
  services.post = [this](std::function<void()> job) { post(std::move(job)); };
  services.full = [this] { return sound_waiting_ > kMostSound; };
  services.say = [this, name](const std::string& body) { return say(name, body); };
  return std::shared_ptr<web::Intake>(std::make_shared<SayIntake>(
      head, std::move(*format), request.socket, "sound-" + std::to_string(++sounds_),
      std::move(services), std::move(answer)));
}

}  // namespace animeme::serve
