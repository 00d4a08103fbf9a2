#include "tools/speech/voice/sphinx.h"

#include <pthread.h>
#include <sphinxbase/err.h>

namespace animeme::voice {

namespace {

void no_message(void*, err_lvl_t, const char*, ...) {}

std::mutex& sphinx_mutex() {
  static std::mutex mutex;
  return mutex;
}

// A forked child has the lock of a thread that it does not have: nobody holds it during a fork.
void free_in_children() {
  ::pthread_atfork([] { sphinx_mutex().lock(); }, [] { sphinx_mutex().unlock(); },
                   [] { sphinx_mutex().unlock(); });
}

}  // namespace

std::unique_lock<std::mutex> quiet_sphinx() {
  static std::once_flag once;
  std::call_once(once, free_in_children);
  std::unique_lock lock(sphinx_mutex());
  err_set_logfp(nullptr);                 // the configuration goes there,
  err_set_callback(no_message, nullptr);  // all else here
  return lock;
}

}  // namespace animeme::voice
