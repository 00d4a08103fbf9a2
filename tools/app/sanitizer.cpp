// Part of sanitized builds only: what is not ours to free.

// fontconfig, which librsvg asks for the letters of pictures, keeps its tables until the end; GLib
// what it makes when it is loaded.
extern "C" const char* __lsan_default_suppressions();   // NOLINT: a name of the sanitizer
extern "C" const char* __lsan_default_suppressions() {  // NOLINT
  return "leak:libfontconfig\nleak:_dl_init\n";
}
