// An address that no transport has.
#include <animeme/live/address.h>

int main() { return animeme::live::open_sink("nonsense", {}) ? 1 : 0; }
