// A plain walk over the boxes of an MP4, for checks of its structure. Shares nothing with the
// writers and readers of the library. Source: ISO 14496-12.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace animeme::test {

struct Box {
  std::string type;
  std::size_t start = 0;   ///< in the file
  std::size_t header = 8;  ///< bytes in front of the content
  std::size_t size = 0;    ///< with the header
  std::vector<Box> boxes;

  std::size_t content() const { return start + header; }
  std::size_t end() const { return start + size; }
  /// The first box inside with this path, "mdia/minf"; nullptr: there is none.
  const Box* find(const std::string& path) const {
    const std::size_t slash = path.find('/');
    for (const Box& box : boxes) {
      if (box.type != path.substr(0, slash)) continue;
      return slash == std::string::npos ? &box : box.find(path.substr(slash + 1));
    }
    return nullptr;
  }
  std::vector<const Box*> all(const std::string& of) const {
    std::vector<const Box*> out;
    for (const Box& box : boxes) {
      if (box.type == of) out.push_back(&box);
    }
    return out;
  }
};

/// A file with its boxes.
class BoxFile {
 public:
  explicit BoxFile(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {
    root_.header = 0;
    root_.size = bytes_.size();
    walk(root_, 0);
  }

  const Box& root() const { return root_; }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  /// What does not fit: boxes that leave their parent, bytes between boxes.
  const std::vector<std::string>& errors() const { return errors_; }

  /// `count` bytes of a box's content, most significant first; 0 where the box ends.
  std::uint64_t number(const Box& box, std::size_t offset, std::size_t count) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = box.content() + offset + i;
      value = value << 8 | (at < box.end() ? bytes_[at] : 0);
    }
    return value;
  }
  std::string text(const Box& box, std::size_t offset) const {
    std::string out;
    for (std::size_t i = 0; i < 4; ++i) out += char(number(box, offset + i, 1));
    return out;
  }

 private:
  // Bytes of a box's content in front of the boxes inside; -1: there are none.
  static int fields_of(const std::string& type) {
    static const std::map<std::string, int> fields = {
        {"moov", 0},  {"trak", 0},  {"edts", 0},  {"mdia", 0}, {"minf", 0},
        {"dinf", 0},  {"stbl", 0},  {"tref", 0},  {"udta", 0}, {"mvex", 0},
        {"moof", 0},  {"traf", 0},  {"meta", 4},  {"dref", 8}, {"stsd", 8},
        {"mp4v", 78}, {"mp4a", 28}, {"Opus", 28}, {"mp4s", 8}, {"mfra", 0}};
    const auto found = fields.find(type);
    return found == fields.end() ? -1 : found->second;
  }

  std::uint64_t raw(std::size_t at, std::size_t count) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes_[at + i];
    return value;
  }

  void walk(Box& parent, std::size_t fields) {
    std::size_t at = parent.content() + fields;
    while (at < parent.end()) {
      if (parent.end() - at < 8) {
        errors_.push_back(parent.type + ": " + std::to_string(parent.end() - at) + " bytes left");
        return;
      }
      Box box;
      box.start = at;
      box.size = raw(at, 4);
      for (std::size_t i = 4; i < 8; ++i) box.type += char(bytes_[at + i]);
      if (box.size == 1 && parent.end() - at >= 16) {
        box.size = raw(at + 8, 8);
        box.header = 16;
      }
      if (box.size < box.header || box.size > parent.end() - at) {
        errors_.push_back(box.type + " at " + std::to_string(at) + " does not fit into " +
                          (parent.type.empty() ? "the file" : parent.type));
        return;
      }
      const int inner = fields_of(box.type);
      if (inner >= 0) walk(box, std::size_t(inner));
      at = box.end();
      parent.boxes.push_back(std::move(box));
    }
  }

  std::vector<std::uint8_t> bytes_;
  Box root_;
  std::vector<std::string> errors_;
};

}  // namespace animeme::test
