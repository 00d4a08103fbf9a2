// What is no glTF is an error.
#include <animeme/gltf/read_head.h>

int main() { return animeme::gltf::read_head({}, {}) ? 1 : 0; }
