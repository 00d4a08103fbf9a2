#include "dam/model/builtin.h"

namespace animeme::dam {

Result<Model> builtin_model() { return read_model(builtin_model_bytes()); }

}  // namespace animeme::dam
