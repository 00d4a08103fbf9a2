#include "fap/xml/detail/numbers.h"

#include "fap/detail/number_text.h"
#include "fap/detail/text_scanner.h"

namespace animeme::head::detail {
namespace {

using fap::detail::finite_number;
using fap::detail::in_quotes;

constexpr std::string_view kBlanks = " \t\r\n,";

std::string attribute_of(const XmlElement& element, std::string_view attribute) {
  return "attribute " + std::string(attribute) + " of <" + element.name + ">";
}

}  // namespace

Result<std::vector<double>> number_list(const XmlElement& element, std::string_view what,
                                        std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t i = text.find_first_not_of(kBlanks); i != text.npos;
       i = text.find_first_not_of(kBlanks, i)) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, i), text.size());
    const std::string_view word = text.substr(i, end - i);
    const std::optional<double> number = finite_number(word);
    if (!number) {
      return element.error(Code::syntax,
                           std::string(what) + " has " + in_quotes(word) + ", which is no number");
    }
    numbers.push_back(*number);
    i = end;
  }
  return numbers;
}

Result<std::vector<double>> numbers_of(const XmlElement& element, std::string_view attribute) {
  const std::string* text = element.attribute(attribute);
  if (text == nullptr) return std::vector<double>();
  return number_list(element, attribute_of(element, attribute), *text);
}

Result<std::optional<double>> number_in(const XmlElement& element, std::string_view attribute) {
  if (element.attribute(attribute) == nullptr) return std::optional<double>();
  const auto numbers = numbers_of(element, attribute);
  if (!numbers) return numbers.error();
  if (numbers->size() != 1) {
    return element.error(Code::syntax, attribute_of(element, attribute) + " needs one number");
  }
  return std::optional<double>(numbers->front());
}

Result<std::uint32_t> index_in(const XmlElement& element, std::string_view attribute,
                               std::uint32_t most) {
  const auto number = number_in(element, attribute);
  if (!number) return number.error();
  if (!*number) {
    return element.error(Code::syntax, attribute_of(element, attribute) + " is missing");
  }
  const double value = **number;
  if (value != std::floor(value)) {
    return element.error(Code::syntax,
                         attribute_of(element, attribute) + " has to be a whole number");
  }
  if (value < 0 || value > double(most)) {
    return element.error(Code::out_of_range, attribute_of(element, attribute) +
                                                 " has to be in 0.." + std::to_string(most));
  }
  return std::uint32_t(value);
}

}  // namespace animeme::head::detail
