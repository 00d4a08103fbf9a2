// Makes the head and its rig.
#include <animeme/head/model.h>
#include <animeme/head/rig.h>

int main() {
  const auto head = animeme::head::make_head();
  if (!head) return 1;
  const animeme::head::Rig rig = animeme::head::make_rig(*head);
  return head->parts.empty() ? 1 : 0;
}
