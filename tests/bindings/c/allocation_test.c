/* Counts what is allocated by the calls for a plane, once the handles have run for a second:
 * nothing. Replaces malloc for the whole program, the library and operator new in it. */
#include <animeme/animeme.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* block, size_t size);

static long allocations = 0;

void* malloc(size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* block, size_t size) {
  ++allocations;
  return __libc_realloc(block, size);
}

enum { RATE = 25, SECONDS = 40, WARM = 3 }; /* models are made when first used */

static animeme_error error;
static int failures = 0;

static void check(animeme_status status) {
  if (status >= 0) return;
  printf("%s\n", error.message);
  exit(1);
}

static void report(const char* what, long planes, long count) {
  printf("%s: %ld allocations in %ld planes\n", what, count, planes);
  if (planes == 0 || count > 0) ++failures;
}

/* All low-level FAPs in motion. */
static void move(animeme_frame* frame, int time) {
  int i;
  for (i = 2; i < ANIMEME_FAP_COUNT; ++i) {
    const int phase = (time * (3 + i % 5) + 7 * i) % 200;
    frame->present[i] = 1;
    frame->value[i] = (phase < 100 ? phase : 200 - phase) * 4 - 200;
  }
}

int main(void) {
  static uint8_t stream[1 << 20];
  static size_t ends[RATE * SECONDS];
  size_t used = 0;
  animeme_encode_options options;
  animeme_encoder* encoder;
  animeme_decoder* decoder;
  animeme_receiver* receiver;
  animeme_arkit* arkit;
  animeme_frame frame;
  animeme_frame shown;
  float weights[ANIMEME_ARKIT_COUNT];
  long encoding = 0;
  long decoding = 0;
  long receiving = 0;
  long fitting = 0;
  long planes = 0;
  long later = 0;
  int time;
  animeme_encode_options_init(&options, sizeof options, ANIMEME_PRESET_LIVE);
  check(animeme_encoder_new(&options, &encoder, &error));
  check(animeme_decoder_new(&decoder, &error));
  check(animeme_receiver_new(ANIMEME_FILL_COMPLETE, &receiver, &error));
  check(animeme_arkit_new(&arkit, &error));
  animeme_frame_init(&frame, sizeof frame);
  animeme_frame_init(&shown, sizeof shown);
  for (time = 0; time < RATE * SECONDS; ++time) {
    const uint8_t* bytes;
    size_t size;
    const long before = allocations;
    move(&frame, time);
    check(animeme_encoder_write(encoder, &frame, NULL, 0, &bytes, &size, NULL, &error));
    if (time > WARM * RATE) encoding += allocations - before;
    if (used + size > sizeof stream) return 1;
    memcpy(stream + used, bytes, size);
    used += size;
    ends[time] = used;
  }
  for (time = 0; time < RATE * SECONDS; ++time) {
    const size_t begin = time == 0 ? 0 : ends[time - 1];
    long before = allocations;
    animeme_status status;
    check(animeme_decoder_push(decoder, stream + begin, ends[time] - begin, &error));
    while ((status = animeme_decoder_next(decoder, &frame, NULL, &error)) == ANIMEME_OK) ++planes;
    check(status);
    if (planes > WARM * RATE) decoding += allocations - before;
    before = allocations;
    check(animeme_receiver_next(receiver, &frame, &shown, &error));
    if (planes > WARM * RATE) receiving += allocations - before;
    before = allocations;
    if (planes % RATE > 5) continue; /* a fit takes long */
    check(animeme_arkit_fit(arkit, &shown, weights, ANIMEME_ARKIT_COUNT, &error));
    if (planes > WARM * RATE) fitting += allocations - before;
  }
  later = planes - WARM * RATE;
  report("encoder", RATE * SECONDS - WARM * RATE, encoding);
  report("decoder", later, decoding);
  report("receiver", later, receiving);
  report("arkit", later, fitting);
  animeme_arkit_free(arkit);
  animeme_receiver_free(receiver);
  animeme_decoder_free(decoder);
  animeme_encoder_free(encoder);
  return failures == 0 ? 0 : 1;
}
