// Changes in the text of a JSON object that leave every other byte as it is: white space, the order
// of members, numbers as they are spelled.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::gltf {

/// A text that a parser has accepted; it is borrowed.
class JsonText {
 public:
  /// Where a value stands.
  struct Span {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  explicit JsonText(std::string_view text);

  /// The whole object.
  Span root() const { return root_; }
  /// The character with which a value begins; 0 beyond the text.
  char at(Span value) const { return value.begin < text_.size() ? text_[value.begin] : '\0'; }
  /// Member of an object; of several with one name the last, as parsers take it. Nothing: there is
  /// none, or `object` is none.
  std::optional<Span> member(Span object, std::string_view key) const;
  /// The same with its key.
  std::optional<Span> member_and_key(Span object, std::string_view key) const;
  /// Entries of an array; none if it is none.
  std::vector<Span> entries(Span array) const;

  /// Another text in the place of a value.
  void replace(Span value, std::string text);
  /// One more member of an object, or one more entry of an array, at its end. `text`: what stands
  /// there, with its key for a member.
  void append(Span list, const std::string& text);

  /// The text with all changes. Those of one value must not overlap.
  std::string changed() const;

 private:
  struct Change {
    Span at;
    std::string text;
  };
  struct Member {
    Span whole;  // with its key
    Span value;
  };
  std::optional<Member> find(Span object, std::string_view key) const;
  std::size_t skip_space(std::size_t at) const;
  std::size_t skip_string(std::size_t at) const;
  std::size_t skip_value(std::size_t at) const;

  std::string_view text_;
  Span root_;
  std::vector<Change> changes_;
};

/// A text between quotes, as JSON wants it.
std::string quoted_json(std::string_view text);

}  // namespace animeme::gltf
