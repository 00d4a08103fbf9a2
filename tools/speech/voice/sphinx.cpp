#include "tools/speech/voice/sphinx.h"

#include <sphinxbase/err.h>

namespace animeme::voice {

namespace {

void no_message(void*, err_lvl_t, const char*, ...) {}

}  // namespace

std::unique_lock<std::mutex> quiet_sphinx() {
  static std::mutex mutex;
  std::unique_lock lock(mutex);
  err_set_logfp(nullptr);                 // the configuration goes there,
  err_set_callback(no_message, nullptr);  // all else here
  return lock;
}

}  // namespace animeme::voice
