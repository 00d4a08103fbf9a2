// A project is read, and a word that is not known refused with its line.
#include <animeme/crossmap/project.h>

int main() {
  using animeme::crossmap::read_project;
  const auto project = read_project("inputs = [\"take.csv\"]\n[target]\nto = \"arkit\"\n", "");
  const auto wrong = read_project("tow = \"arkit\"\n", "");
  return project && project->to == "arkit" && !wrong ? 0 : 1;
}
