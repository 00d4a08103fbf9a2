// What is served whole: packed once, with a version that browsers can ask for.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace animeme::web {

struct Document {
  std::string bytes;
  std::string packed;  ///< by gzip; empty where that is not smaller
  std::string etag;    ///< of `bytes`, with its quotes

  /// Of the form that is sent: they are different for caches.
  std::string etag_of(bool as_gzip) const {
    return as_gzip ? etag.substr(0, etag.size() - 1) + "-gzip\"" : etag;
  }
};

using DocumentPtr = std::shared_ptr<const Document>;

DocumentPtr make_document(std::string bytes);

}  // namespace animeme::web
