#include "tools/formats/common/module.h"
#include "tools/speech/text/late_internal.h"

namespace animeme::text {
namespace {

constexpr TextFunctions kTable = {
#define ANIMEME_TEXT_ADDRESS(name) &text::name,
    ANIMEME_TEXT_FUNCTIONS(ANIMEME_TEXT_ADDRESS)
#undef ANIMEME_TEXT_ADDRESS
};

}  // namespace
}  // namespace animeme::text

ANIMEME_MODULE(animeme::text::kTable);
