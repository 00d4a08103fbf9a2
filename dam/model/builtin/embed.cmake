# Turns a file into a C++ array: cmake -DINPUT=x.dam -DOUTPUT=x.cpp -P embed.cmake
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"dam/model/builtin.h\"

namespace animeme::dam {

namespace {
constexpr std::uint8_t kBytes[] = {
${bytes}};
}  // namespace

std::span<const std::uint8_t> builtin_model_bytes() { return kBytes; }

}  // namespace animeme::dam
")
