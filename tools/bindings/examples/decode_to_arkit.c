/* An FBA stream to ARKit weights, a line a frame, and back into a live stream:
 *
 *     decode_to_arkit talk.fba [again.fba]
 *
 * Plain C99. See tools/bindings/c/README.md for how to build it. */
#include <animeme/animeme.h>
#include <stdio.h>
#include <stdlib.h>

static void check(animeme_status status, const animeme_error* error) {
  if (status >= 0) return;
  fprintf(stderr, "%s: %s\n", animeme_status_text(status), error->message);
  exit(3);
}

static void show(const animeme_frame* frame, animeme_arkit* arkit) {
  float weights[ANIMEME_ARKIT_SHAPES];
  animeme_error error;
  int i;
  check(animeme_arkit_fit(arkit, frame, weights, ANIMEME_ARKIT_SHAPES, &error), &error);
  printf("%.3f", frame->seconds);
  for (i = 0; i < ANIMEME_ARKIT_SHAPES; ++i) {
    if (weights[i] > 0.005f) printf(" %s=%.2f", animeme_arkit_name(i), (double)weights[i]);
  }
  printf("\n");
}

static void send(animeme_encoder* encoder, const animeme_frame* frame, FILE* out) {
  const uint8_t* bytes;
  size_t size;
  animeme_error error;
  if (frame != NULL) {
    check(animeme_encoder_write(encoder, frame, NULL, 0, &bytes, &size, NULL, &error), &error);
  } else {
    check(animeme_encoder_finish(encoder, &bytes, &size, &error), &error);
  }
  fwrite(bytes, 1, size, out);
}

int main(int argc, char** argv) {
  FILE* in = argc > 1 ? fopen(argv[1], "rb") : NULL;
  FILE* out = argc > 2 ? fopen(argv[2], "wb") : NULL;
  animeme_decoder* decoder = NULL;
  animeme_receiver* receiver = NULL;
  animeme_arkit* arkit = NULL;
  animeme_encoder* encoder = NULL;
  animeme_encode_options options;
  animeme_error error;
  animeme_frame plane;
  animeme_frame shown;
  animeme_status status = ANIMEME_NEED_DATA;
  uint8_t buffer[4096];
  if (argc < 2) {
    fprintf(stderr, "usage: decode_to_arkit talk.fba [again.fba]\n");
    return 2;
  }
  if (in == NULL || (argc > 2 && out == NULL)) {
    perror(in == NULL ? argv[1] : argv[2]);
    return 3;
  }
  check(animeme_decoder_new(&decoder, &error), &error);
  check(animeme_receiver_new(ANIMEME_FILL_COMPLETE | ANIMEME_FILL_EXPAND, &receiver, &error),
        &error);
  check(animeme_arkit_new(&arkit, &error), &error);
  animeme_frame_init(&plane, sizeof plane);
  animeme_frame_init(&shown, sizeof shown);
  while (status != ANIMEME_END) {
    if (status == ANIMEME_NEED_DATA) {
      const size_t size = fread(buffer, 1, sizeof buffer, in);
      check(animeme_decoder_push(decoder, buffer, size, &error), &error);
      if (size == 0) check(animeme_decoder_finish(decoder, &error), &error);
    }
    status = animeme_decoder_next(decoder, &plane, NULL, &error);
    if (status < 0) fprintf(stderr, "%s\n", error.message); /* it goes on behind the damage */
    if (status != ANIMEME_OK || !(plane.flags & ANIMEME_FRAME_FACE)) continue;
    check(animeme_receiver_next(receiver, &plane, &shown, &error), &error);
    show(&shown, arkit);
    if (out == NULL) continue;
    if (encoder == NULL) { /* the rate comes with the first plane */
      animeme_encode_options_init(&options, sizeof options, ANIMEME_PRESET_LIVE);
      options.rate_num = plane.rate_num;
      options.rate_den = plane.rate_den;
      check(animeme_encoder_new(&options, &encoder, &error), &error);
    }
    send(encoder, &shown, out);
  }
  if (encoder != NULL) send(encoder, NULL, out);
  animeme_encoder_free(encoder);
  animeme_arkit_free(arkit);
  animeme_receiver_free(receiver);
  animeme_decoder_free(decoder);
  if (out != NULL) fclose(out);
  fclose(in);
  return 0;
}
