/* A decoder for `animeme check --decoder "text_decoder {in} {out} {bap}"`: all that it knows of FBA
 * comes through the C interface. Ends at the first failure with what came before it. */
#include <animeme/animeme.h>
#include <stdio.h>
#include <stdlib.h>

static animeme_error error;

static void check(animeme_status status) {
  if (status >= 0) return;
  fprintf(stderr, "%s\n", error.message);
  exit(3);
}

static void write_body(FILE* file, const animeme_body* body) {
  int i;
  for (i = 0; i < ANIMEME_BAP_COUNT; ++i) fprintf(file, "%d ", body->present[i]);
  fprintf(file, "\n%ld", (long)body->number);
  for (i = 0; i < ANIMEME_BAP_COUNT; ++i) {
    if (body->present[i]) fprintf(file, " %ld", (long)body->value[i]);
  }
  fprintf(file, "\n");
}

/* The frames of a body, behind a header that counts them. */
static void write_bodies(const char* path, FILE* bodies, double rate, long count) {
  FILE* file = fopen(path, "wb");
  int letter;
  if (file == NULL) exit(4);
  fprintf(file, "3.2 body %.9g %ld\n", rate, count);
  rewind(bodies);
  while ((letter = fgetc(bodies)) != EOF) fputc(letter, file);
  fclose(file);
}

static void write_faces(const char* path, const animeme_clip* clip) {
  FILE* file = fopen(path, "wb");
  char* text;
  size_t length;
  if (file == NULL) exit(4);
  check(animeme_clip_to_text(clip, &text, &length, &error));
  fwrite(text, 1, length, file);
  animeme_free(text);
  fclose(file);
}

int main(int argc, char** argv) {
  FILE* in = argc == 4 ? fopen(argv[1], "rb") : NULL;
  FILE* bodies = tmpfile();
  animeme_decoder* decoder;
  animeme_clip* clip = NULL;
  animeme_frame frame;
  animeme_body body;
  animeme_status status = ANIMEME_NEED_DATA;
  uint8_t buffer[1000];
  double rate = 25;
  long count = 0;
  if (in == NULL || bodies == NULL) return 2;
  check(animeme_decoder_new(&decoder, &error));
  animeme_frame_init(&frame, sizeof frame);
  animeme_body_init(&body, sizeof body);
  while (status >= 0 && status != ANIMEME_END) {
    if (status == ANIMEME_NEED_DATA) {
      const size_t size = fread(buffer, 1, sizeof buffer, in);
      check(animeme_decoder_push(decoder, buffer, size, &error));
      if (size == 0) check(animeme_decoder_finish(decoder, &error));
    }
    status = animeme_decoder_next(decoder, &frame, &body, &error);
    if (status != ANIMEME_OK) continue;
    if (clip == NULL) {
      rate = (double)frame.rate_num / (double)frame.rate_den;
      check(animeme_clip_new(frame.rate_num, frame.rate_den, &clip, &error));
    }
    if (frame.flags & ANIMEME_FRAME_FACE) check(animeme_clip_add(clip, &frame, &error));
    if (!(frame.flags & ANIMEME_FRAME_BODY)) continue;
    write_body(bodies, &body);
    ++count;
  }
  if (status < 0) fprintf(stderr, "%s\n", error.message);
  if (clip != NULL && animeme_clip_count(clip) > 0) write_faces(argv[2], clip);
  if (count > 0) write_bodies(argv[3], bodies, rate, count);
  animeme_clip_free(clip);
  animeme_decoder_free(decoder);
  fclose(bodies);
  fclose(in);
  return status < 0 ? 1 : 0;
}
