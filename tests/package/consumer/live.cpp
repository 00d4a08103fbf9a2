// Addresses tell their transport.
#include <animeme/live/address.h>

int main() { return animeme::live::is_rtp("rtp://127.0.0.1:5004") ? 0 : 1; }
