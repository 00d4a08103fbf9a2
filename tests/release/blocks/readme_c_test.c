/* The C example of the README, with the variables that it uses. */
#include <animeme/animeme.h>
#include <stdio.h>
#include <string.h>

int main(void) {
  static const char script[] = "0.0 0.1 HH\n0.1 0.4 AY\n0.4 0.6 SIL\n";
  animeme_model* model = NULL;
  animeme_clip* clip = NULL;
  animeme_error error;
  uint8_t* bytes = NULL;
  size_t size = 0;
#include "README_md.c.1.inc"
  if (model == NULL || clip == NULL || bytes == NULL || size < 10) {
    fprintf(stderr, "the example of the README made nothing: %s\n", error.message);
    return 1;
  }
  printf("%lu frames, %lu bytes\n", (unsigned long)animeme_clip_count(clip), (unsigned long)size);
  animeme_free(bytes);
  animeme_clip_free(clip);
  animeme_model_free(model);
  return 0;
}
