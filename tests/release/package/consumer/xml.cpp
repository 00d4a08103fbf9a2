// What is no XML is an error, by libxml2.
#include <animeme/xml/xmt.h>

int main() { return animeme::head::read_xmt("<XMT-A><nothing>") ? 1 : 0; }
