// The model file. Layout: dam/README.md.
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

#include "dam/detail/bytes.h"
#include "dam/kinds/kind.h"
#include "dam/model.h"

namespace animeme::dam {
namespace {

constexpr std::string_view kMagic = "ANIMEDAM";
constexpr std::uint16_t kMajor = 2, kMinor = 0;
constexpr std::size_t kHeader = 8 + 2 + 2 + 8, kChecksum = 4;

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ ((c & 1) != 0 ? 0xEDB88320u : 0u);
    table[i] = c;
  }
  return table;
}
constexpr auto kCrcTable = make_crc_table();

/// CRC-32 as in zip and PNG.
std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t c = 0xFFFFFFFFu;
  for (const std::uint8_t b : bytes) c = kCrcTable[(c ^ b) & 0xFF] ^ (c >> 8);
  return ~c;
}

Error damaged(const std::string& how) {
  return make_error(Code::syntax, "the model file is damaged (" + how +
                                      "); get it again or train the model anew");
}

Result<Model> read_payload(ByteReader& in, bool newer_minor) {
  Model model;
  model.method = Method(in.number<std::uint8_t>());
  if (method_name(model.method).empty())
    return make_error(
        Code::unsupported,
        "the model was made by a method that this version does not know; use a newer one");
  model.pause_edge = in.real();
  model.closure_gap = in.real();
  const auto has_raise = in.number<std::uint8_t>();
  const double raise = in.real();
  if (has_raise > 1) return damaged("unknown flag");
  if (has_raise == 1) model.lip_tooth_raise = raise;
  model.rate.num = in.number<std::uint32_t>();
  model.rate.den = in.number<std::uint32_t>();
  model.attribution = in.text();
  model.provenance = in.text();
  model.controls.resize(in.count(4 + 3 * 8));
  for (Control& c : model.controls) {
    c.name = in.text();
    c.rest = in.real();
    c.mean = in.real();
    c.sd = in.real();
  }
  model.phones.resize(in.count(4 + 4 + 4 + 8 + 8));
  for (PhoneModel& p : model.phones) {
    p.label = in.text();
    p.examples = in.number<std::uint32_t>();
    p.context_class = in.number<std::uint32_t>();
    p.duration = in.real();
    p.longest = in.real();
  }
  if (auto ok = kind_of(model.method).read(in, model); !ok) return damaged(ok.error().message);
  if (in.failed()) return damaged("its parts are larger than the file");
  if (!in.at_end() && !newer_minor) return damaged("something follows the model");
  if (auto ok = validate(model); !ok) return make_error(Code::syntax, ok.error().message);
  return model;
}

}  // namespace

std::vector<std::uint8_t> write_model(const Model& model) {
  ByteWriter body;
  body.number(std::uint8_t(model.method));
  body.real(model.pause_edge);
  body.real(model.closure_gap);
  body.number(std::uint8_t(model.lip_tooth_raise ? 1 : 0));
  body.real(model.lip_tooth_raise.value_or(0));
  body.number(model.rate.num);
  body.number(model.rate.den);
  body.text(model.attribution);
  body.text(model.provenance);
  body.number(std::uint32_t(model.controls.size()));
  for (const Control& c : model.controls) {
    body.text(c.name);
    body.real(c.rest);
    body.real(c.mean);
    body.real(c.sd);
  }
  body.number(std::uint32_t(model.phones.size()));
  for (const PhoneModel& phone : model.phones) {
    body.text(phone.label);
    body.number(phone.examples);
    body.number(phone.context_class);
    body.real(phone.duration);
    body.real(phone.longest);
  }
  kind_of(model.method).write(model, body);
  ByteWriter file;
  file.bytes.assign(kMagic.begin(), kMagic.end());
  file.number(kMajor);
  file.number(kMinor);
  file.number(std::uint64_t(body.bytes.size()));
  file.bytes.insert(file.bytes.end(), body.bytes.begin(), body.bytes.end());
  file.number(crc32(file.bytes));
  return std::move(file.bytes);
}

Result<Model> read_model(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
    return make_error(Code::syntax, "this is not a model file of Animeme");
  if (bytes.size() < kHeader + kChecksum)
    return make_error(Code::truncated, "the model file ends within its header");
  ByteReader header(bytes.subspan(kMagic.size()));
  const auto major = header.number<std::uint16_t>(), minor = header.number<std::uint16_t>();
  const auto size = header.number<std::uint64_t>();
  if (major != kMajor)
    return make_error(Code::unsupported, "the model file has version " + std::to_string(major) +
                                             "." + std::to_string(minor) + ", this program reads " +
                                             std::to_string(kMajor) + ".x; use a " +
                                             (major > kMajor ? "newer" : "matching") +
                                             " version of Animeme or train the model anew");
  const std::size_t there = bytes.size() - kHeader - kChecksum;
  if (size > there) return make_error(Code::truncated, "the model file is cut off");
  if (size < there) return damaged("bytes behind its end");
  ByteReader checksum(bytes.last(kChecksum));
  if (crc32(bytes.first(bytes.size() - kChecksum)) != checksum.number<std::uint32_t>())
    return damaged("its checksum does not match");
  ByteReader body(bytes.subspan(kHeader, there));
  return read_payload(body, minor > kMinor);
}

Result<Model> load_model(const std::filesystem::path& path) {
  const auto at = [&](Code code, const char* what) {
    return Error{code, what, {path.string(), 0, 0, -1}};
  };
  std::ifstream in(path, std::ios::binary);
  if (!in) return at(Code::not_found, "cannot open the model file");
  const std::vector<char> text{std::istreambuf_iterator<char>(in),
                               std::istreambuf_iterator<char>()};
  if (in.bad()) return at(Code::io, "cannot read the model file");
  auto model = read_model({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (!model) return std::move(model).error().in_file(path.string());
  return model;
}

Result<void> save_model(const Model& model, const std::filesystem::path& path) {
  if (auto ok = validate(model); !ok) return ok;
  const auto fail = [&] {
    return Error{Code::io,
                 "cannot write the model file; check the folder and the free space",
                 {path.string(), 0, 0, -1}};
  };
  const std::vector<std::uint8_t> bytes = write_model(model);
  std::filesystem::path temporary = path;
  temporary += ".part";
  std::error_code error;
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    out.close();
    if (!out) {
      std::filesystem::remove(temporary, error);
      return fail();
    }
  }
  std::filesystem::rename(temporary, path, error);
  if (!error) return {};
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  return fail();
}

}  // namespace animeme::dam
