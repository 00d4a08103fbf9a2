#include "dam/model/builtin.h"

namespace animeme::dam {

Result<Model> builtin_model() {
  auto model = read_model(builtin_model_bytes());
  if (model) model->articulation = 1;
  return model;
}

}  // namespace animeme::dam
