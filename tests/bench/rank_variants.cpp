#include "tests/bench/rank_variants.h"

#include <cstdint>
#include <limits>

namespace animeme::bench {

std::vector<Variant> variants() {
  std::vector<Variant> list;
  const auto add = [&](const char* name, dam::Method method, auto change) {
    Variant variant{name, {}};
    variant.options.method = method;
    change(variant.options);
    list.push_back(variant);
  };
  const auto plain = [](dam::TrainOptions&) {};
  add("`dam`", dam::Method::dam, plain);
  add("`dam-paper`", dam::Method::dam_paper, plain);
  add("`dam-paper --plain-sum --free-time`: the printed equations", dam::Method::dam_paper,
      [](dam::TrainOptions& o) {
        o.animeme.normalised = false;
        o.animeme.time_margin = std::numeric_limits<double>::infinity();
      });
  add("`dam-paper --single-mode`", dam::Method::dam_paper,
      [](dam::TrainOptions& o) { o.animeme.modes = false; });
  add("`triphone`", dam::Method::triphone, plain);
  add("`mmm`, 3 states", dam::Method::mmm, plain);
  add("`mmm --states 1`", dam::Method::mmm, [](dam::TrainOptions& o) { o.trajectory.states = 1; });
  add("`cohen-massaro`", dam::Method::cohen_massaro, plain);
  add("`cohen-massaro --plain-sum`", dam::Method::cohen_massaro,
      [](dam::TrainOptions& o) { o.animeme.normalised = false; });
  add("`viseme`", dam::Method::viseme, plain);
  add("`mean`", dam::Method::mean, plain);
  return list;
}

std::vector<Variant> steps() {
  using enum dam::RefinedTerm;
  const auto bit = [](dam::RefinedTerm term) { return 1u << unsigned(term); };
  const std::uint32_t neighbours =
      bit(phone) | bit(class_left) | bit(class_right) | bit(phone_left) | bit(phone_right);
  const std::uint32_t second = bit(class_left_2) | bit(class_right_2);
  std::vector<Variant> list;
  dam::TrainOptions now;
  now.refined.terms = bit(phone);
  now.refined.offset_frames = 1e9;
  now.refined.width_prior = 5;
  now.refined.time_margin = 0.5;
  now.refined.duration_exponent = 0;
  now.refined.ridge = 1;
  const auto add = [&](const char* name) { list.push_back({name, now}); };
  dam::TrainOptions paper;
  paper.method = dam::Method::dam_paper;
  list.push_back({"`dam-paper`", paper});
  add("seconds, left and right, strength; no context");
  now.refined.terms = neighbours;
  add("+ neighbours");
  now.refined.offset_frames = 10;
  add("+ offset of the sentence");
  now.refined.width_prior = 50;
  add("+ firmer prior on the widths");
  now.refined.terms |= bit(duration);
  add("+ own duration");
  now.refined.terms |= second;
  add("+ second neighbours");
  now.refined.time_margin = 0.3;
  add("+ local time within [-0.3, 1.3]");
  now.refined.duration_exponent = 0.3;
  add("+ strength by duration");
  now.refined.terms |= bit(phone_class);
  add("+ curve of the class");
  now.refined.ridge = 0;
  add("+ factor of the ridges chosen: `dam`");
  now = {};
  now.refined.ridge = 0.5;
  add("`dam`, ridges x 0.5");
  now.refined.ridge = 2;
  add("`dam`, ridges x 2");
  now.refined.ridge = 4;
  add("`dam`, ridges x 4");
  now = {};
  now.refined.offset_frames = 1e9;
  add("`dam` without offsets");
  now = {};
  now.refined.width_prior = 5;
  add("`dam`, loose prior on the widths");
  return list;
}

}  // namespace animeme::bench
