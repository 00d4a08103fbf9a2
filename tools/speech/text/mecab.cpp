#include <mecab.h>

#include <memory>

#include "tools/speech/text/japanese.h"

namespace animeme::text {
namespace {

struct MecabCloser {
  void operator()(mecab_t* mecab) const { mecab_destroy(mecab); }
};

// A field of "名詞,一般,*,*,*,*,東京,トウキョウ,トーキョー"; empty for "*" and what is not there.
std::string_view field(std::string_view features, std::size_t number) {
  for (; number > 0; --number) {
    const std::size_t comma = features.find(',');
    if (comma == std::string_view::npos) return {};
    features.remove_prefix(comma + 1);
  }
  features = features.substr(0, features.find(','));
  return features == "*" ? std::string_view() : features;
}

constexpr std::size_t kPronunciation = 8;

}  // namespace

Result<std::vector<JapaneseWord>> japanese_words(std::u32string_view text,
                                                 const std::string& folder) {
  const std::string command = "mecab -r /dev/null -d " + folder;
  const std::unique_ptr<mecab_t, MecabCloser> mecab(mecab_new2(command.c_str()));
  const mecab_dictionary_info_t* info =
      mecab == nullptr ? nullptr : mecab_dictionary_info(mecab.get());
  const std::string charset = info == nullptr ? std::string() : info->charset;
  if (charset != "UTF-8" && charset != "utf-8" && charset != "UTF8" && charset != "utf8") {
    return make_error(Code::not_found,
                      "Japanese with Chinese characters needs a dictionary; install the Debian "
                      "package mecab-ipadic-utf8 (there is none at " +
                          folder + ")");
  }
  const std::string bytes = utf8(text);
  std::vector<JapaneseWord> words;
  const mecab_node_t* node = mecab_sparse_tonode2(mecab.get(), bytes.c_str(), bytes.size());
  if (node == nullptr) {
    return make_error(Code::invalid_argument, "MeCab cannot read this Japanese text");
  }
  // Blanks before a word are not in it.
  std::size_t byte = 0, character = 0;
  const auto count_to = [&](std::size_t end) {
    for (; byte < end && byte < bytes.size(); ++byte) {
      character += (static_cast<unsigned char>(bytes[byte]) & 0xC0) != 0x80;
    }
    return character;
  };
  for (; node != nullptr; node = node->next) {
    if (node->stat == MECAB_BOS_NODE || node->stat == MECAB_EOS_NODE || node->length == 0) continue;
    const auto start = std::size_t(node->surface - bytes.c_str());
    JapaneseWord word;
    word.first = count_to(start);
    word.last = count_to(start + node->length);
    const std::string_view features = node->feature;
    word.kana = code_points(field(features, kPronunciation));
    const std::string_view part = field(features, 0), kind = field(features, 1);
    // 記号 is punctuation, whose "reading" is itself.
    if (part == "記号") word.kana.clear();
    word.leans = part == "助詞" || part == "助動詞" || kind == "接尾" || kind == "非自立";
    words.push_back(std::move(word));
  }
  return words;
}

}  // namespace animeme::text
