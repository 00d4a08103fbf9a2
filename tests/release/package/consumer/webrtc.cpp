// An option that no address has, with GStreamer or without.
#include <animeme/webrtc/webrtc.h>

int main() { return animeme::webrtc::make_whip_sink("whip://host/path?nonsense") ? 1 : 0; }
