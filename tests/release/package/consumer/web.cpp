// An address that is none is an error, with libwebsockets or without.
#include <animeme/web/web.h>

int main() { return animeme::web::make_web_sink("no address") ? 1 : 0; }
