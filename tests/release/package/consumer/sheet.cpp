// A sheet of nothing is refused.
#include <animeme/sheet/sheet.h>

int main() { return animeme::sheet::make_sheet({}) ? 1 : 0; }
