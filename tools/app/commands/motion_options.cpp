#include "tools/app/commands/motion_options.h"
#include "tools/app/commands/bounds.h"

namespace animeme::tools {

void add_motion_options(CLI::App& app, dam::SynthesisOptions& options) {
  options.articulation = 1;
  app.add_option("--style", options.style,
                 "Intensity: 0 keeps the mouth at rest, 1 is as learned, 1.5 exaggerates")
      ->option_text("0..1.5=1")
      ->check(between(0.0, dam::kMostStyle));
  app.add_option("--sharpness", options.sharpness,
                 "Quickness: 0 as a mean of sentences, 1 more as people")
      ->option_text("0..3=1")
      ->check(between(0.0, dam::kMostSharpness));
  app.add_option("--articulate", options.articulation,
                 "Vowels clearer than learned: round o, u, w, wide a, narrow i; 0 as learned")
      ->option_text("0..2=1")
      ->check(between(0.0, dam::kMostArticulation));
}

}  // namespace animeme::tools
