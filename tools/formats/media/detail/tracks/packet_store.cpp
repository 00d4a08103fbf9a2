#include "tools/formats/media/detail/tracks/packet_store.h"

#include <string>

namespace animeme::media {

namespace {

Error store_error(const char* what) {
  return make_error(Code::io, std::string("the temporary file cannot be ") + what +
                                  "; check the free space of the folder for temporary files");
}

}  // namespace

Result<PacketStore> PacketStore::make() {
  PacketStore store;
  store.file_.reset(std::tmpfile());
  if (!store.file_) return store_error("made");
  return store;
}

Result<void> PacketStore::add(Head head, std::span<const std::uint8_t> bytes) {
  head.size = std::uint32_t(bytes.size());
  const bool written = std::fwrite(&head, sizeof head, 1, file_.get()) == 1 &&
                       std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
  if (!written) return store_error("written");
  return {};
}

Result<void> PacketStore::rewind() {
  if (std::fflush(file_.get()) != 0) return store_error("written");
  if (std::fseek(file_.get(), 0, SEEK_SET) != 0) return store_error("read");
  return {};
}

Result<bool> PacketStore::next(Head& head, std::vector<std::uint8_t>& bytes) {
  if (std::fread(&head, sizeof head, 1, file_.get()) != 1) {
    if (std::ferror(file_.get()) != 0) return store_error("read");
    return false;
  }
  bytes.resize(head.size);
  if (std::fread(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
    return store_error("read");
  }
  return true;
}

}  // namespace animeme::media
