#include "tools/app/late/sphinx_functions.h"
#include "tools/formats/common/module.h"

namespace animeme::voice {
namespace {

constexpr SphinxFunctions kTable = {CepstraReader::open, read_phone_pairs, denoise,
                                    RateChange::open, WordSearch::open};

}  // namespace
}  // namespace animeme::voice

ANIMEME_MODULE(animeme::voice::kTable);
