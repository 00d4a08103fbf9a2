// Numbers in XML text.
#pragma once

#include <optional>

#include "fap/xml/detail/document.h"

namespace animeme::head::detail {

/// The numbers of a text, separated by blanks, line ends and commas; empty for an empty text.
/// Errors: syntax, at the line of `element`, naming the word that is no finite number. `what` says
/// what the text is ("attribute point of Coordinate").
Result<std::vector<double>> number_list(const XmlElement& element, std::string_view what,
                                        std::string_view text);

/// The numbers of an attribute; none if it is not there.
Result<std::vector<double>> numbers_of(const XmlElement& element, std::string_view attribute);

/// One number in an attribute; nothing if the attribute is not there.
Result<std::optional<double>> number_in(const XmlElement& element, std::string_view attribute);

/// An attribute that has to be a whole number from 0 to `most`.
/// Errors: syntax (missing, or no whole number), out_of_range.
Result<std::uint32_t> index_in(const XmlElement& element, std::string_view attribute,
                               std::uint32_t most);

}  // namespace animeme::head::detail
