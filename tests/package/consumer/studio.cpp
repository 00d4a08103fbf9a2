// Names of files tell films from pictures.
#include <animeme/studio/film.h>

int main() {
  using animeme::studio::is_film;
  return (is_film("mp4") || is_film(".mp4")) && !is_film("png") ? 0 : 1;
}
