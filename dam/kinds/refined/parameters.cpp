// Checks of the parameters, and their place in the model file.
#include <algorithm>
#include <cmath>

#include "dam/kinds/refined/refined.h"
#include "dam/kinds/refined/terms.h"

namespace animeme::dam {
namespace {

Result<void> check_dominance(const PhoneDominance& d, const std::string& label) {
  const auto fine = [](double x, double most) { return x > 0 && x <= most; };
  if (!fine(d.left, 10) || !fine(d.right, 10) || !fine(d.strength, 1e6))
    return invalid_model("phone " + label + " has a dominance out of range");
  return {};
}

Result<void> check_table(const Model& model, const TermTable& table) {
  if (std::size_t(table.term) >= kTermCount) return invalid_model("a term is unknown");
  if (table.orders < 1 || table.orders > kRefinedOrders)
    return invalid_model("a term has a wrong number of coefficients");
  if (table.values.size() != table.keys.size() * table.orders * model.controls.size())
    return invalid_model("a term has a wrong number of values");
  const std::uint32_t most = largest_key(table.term, model.phones.size());
  for (std::size_t i = 0; i < table.keys.size(); ++i)
    if (table.keys[i] > most || (i > 0 && table.keys[i] <= table.keys[i - 1]))
      return invalid_model("the keys of a term are not those of its phones or not ascending");
  if (!std::all_of(table.values.begin(), table.values.end(),
                   [](float v) { return std::isfinite(v); }))
    return invalid_model("a term has a coefficient without value");
  return {};
}

}  // namespace

Result<void> validate_refined(const Model& model) {
  const auto* p = std::get_if<RefinedParameters>(&model.parameters);
  if (p == nullptr) return invalid_model("its parameters are not those of its method");
  if (!(p->time_margin >= 0) || !(p->time_margin <= 100))
    return invalid_model("its time margin is out of range");
  if (!(p->duration_exponent >= 0) || !(p->duration_exponent <= 2))
    return invalid_model("its duration exponent is out of range");
  if (p->dominance.size() != model.phones.size())
    return invalid_model("its phones and their dominances differ in number");
  for (std::size_t i = 0; i < p->dominance.size(); ++i)
    if (auto ok = check_dominance(p->dominance[i], model.phones[i].label); !ok) return ok;
  for (std::size_t i = 0; i < p->tables.size(); ++i) {
    if (i > 0 && p->tables[i].term <= p->tables[i - 1].term)
      return invalid_model("its terms are not ascending");
    if (auto ok = check_table(model, p->tables[i]); !ok) return ok;
  }
  return {};
}

void write_refined(const Model& model, ByteWriter& out) {
  const auto& p = std::get<RefinedParameters>(model.parameters);
  out.put(p.time_margin, p.duration_exponent);
  for (const PhoneDominance& d : p.dominance) out.put(d.left, d.right, d.strength);
  out.count(p.tables.size());
  for (const TermTable& table : p.tables) {
    out.put(table.term, table.orders);
    out.count(table.keys.size());
    out.put(table.keys, table.values);
  }
}

Result<void> read_refined(ByteReader& in, Model& model) {
  RefinedParameters p;
  in.get(p.time_margin, p.duration_exponent);
  p.dominance.resize(in.limited(model.phones.size(), 24));
  for (PhoneDominance& d : p.dominance) in.get(d.left, d.right, d.strength);
  p.tables.resize(in.count(1 + 4 + 4));
  for (TermTable& table : p.tables) {
    in.get(table.term, table.orders);
    if (table.orders > kRefinedOrders) return make_error(Code::syntax, "a term of unknown shape");
    const std::size_t row = table.orders * model.controls.size();
    table.keys.resize(in.count(4 + 4 * row));
    table.values.resize(table.keys.size() * row);
    in.get(table.keys, table.values);
  }
  model.parameters = std::move(p);
  return {};
}

}  // namespace animeme::dam
