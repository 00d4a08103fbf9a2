// A page needs a head; the script that draws one is there.
#include <animeme/viewer/viewer.h>

int main() {
  const bool refused = !animeme::viewer::make_page({});
  return refused && !animeme::viewer::head_script().empty() ? 0 : 1;
}
