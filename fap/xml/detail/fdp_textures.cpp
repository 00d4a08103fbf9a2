#include <algorithm>

#include "fap/detail/text_scanner.h"
#include "fap/xml/detail/fdp_file.h"

namespace animeme::head::detail {

using fap::detail::in_quotes;

namespace {
constexpr std::size_t kAllTexels = 64'000'000;  // read for one .wrl; a texture may count twice
}  // namespace

bool stays_in_folder(std::string_view name) {
  if (name.empty() || name.front() == '/' || name.front() == '\\') return false;
  if (name.find(':') != name.npos || name.find('\0') != name.npos) return false;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find_first_of("/\\"), name.size());
    if (name.substr(0, end) == "..") return false;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return true;
}

const TgaPicture* FdpTextures::picture(const std::string& url) {
  if (url == url_) return picture_ ? &*picture_ : nullptr;
  url_ = url;
  picture_.reset();
  const auto leave_out = [&](const std::string& why) {
    std::string note = "the texture " + in_quotes(url) + " is left out: " + why;
    if (told_.insert(note).second) notes_.push_back(std::move(note));
    return nullptr;
  };
  if (texels_ > kAllTexels) return leave_out("earlier textures already have 64 million texels");
  const std::string name = folder_ + url;
  if (!stays_in_folder(name)) {
    return leave_out(
        "it is not in the folder of the .fdp file; put it there and name it without a path");
  }
  const Result<std::string> bytes = load_(name);
  if (!bytes) return leave_out("it cannot be read (" + bytes.error().describe() + ")");
  Result<TgaPicture> read = read_tga(*bytes);
  if (!read) return leave_out(read.error().message);
  picture_ = std::move(*read);
  texels_ += picture_->rgb.size() / 3;
  if (!picture_->trouble.empty()) {
    std::string note = "Xface does not show the texture " + in_quotes(url) +
                       " as it is: " + picture_->trouble + "; save it as an uncompressed TGA";
    if (told_.insert(note).second) notes_.push_back(std::move(note));
  }
  return &*picture_;
}

void FdpTextures::paint(const std::string& mesh, const ScenePicture& from, Piece& piece) {
  if (from.urls.empty()) return;
  if (!from.problem.empty()) {
    notes_.push_back("the texture of the mesh " + mesh + " is left out: the mesh " + from.problem);
    return;
  }
  const TgaPicture* found = nullptr;
  for (std::size_t i = 0; i < from.urls.size() && found == nullptr; ++i) {
    found = picture(from.urls[i]);
  }
  if (found == nullptr) return;
  const std::size_t count = piece.mesh.positions.size();
  std::vector<Vec3> sums(count);
  std::vector<int> counts(count);
  for (const ScenePicture::Corner& corner : from.corners) {
    sums[corner.vertex] += colour_at(*found, corner.place);
    ++counts[corner.vertex];
  }
  piece.mesh.colours.resize(count, kNoColour);
  for (std::size_t v = 0; v < count; ++v) {
    if (counts[v] > 0) piece.mesh.colours[v] = sums[v] * (1 / float(counts[v]));
  }
}

}  // namespace animeme::head::detail
