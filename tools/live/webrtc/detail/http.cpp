#include "tools/live/webrtc/detail/http.h"

#ifdef ANIMEME_HAS_CURL

#include <curl/curl.h>

namespace animeme::webrtc {
namespace {

constexpr std::size_t kMostAnswer = 1 << 20;  // bytes

size_t take(char* bytes, size_t, size_t size, void* answer) {
  std::string& body = static_cast<HttpAnswer*>(answer)->body;
  if (body.size() + size > kMostAnswer) return 0;  // ends it with an error
  body.append(bytes, size);
  return size;
}

}  // namespace

HttpAnswer exchange(const HttpRequest& request) {
  HttpAnswer answer;
  CURL* curl = curl_easy_init();
  if (curl == nullptr) return {.problem = "libcurl does not start"};
  curl_slist* headers = nullptr;
  if (!request.body.empty()) headers = curl_slist_append(headers, "Content-Type: application/sdp");
  if (!request.token.empty()) {
    headers = curl_slist_append(headers, ("Authorization: Bearer " + request.token).c_str());
  }
  curl_easy_setopt(curl, CURLOPT_URL, request.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, request.method.c_str());
  if (!request.body.empty()) {
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, long(request.body.size()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, request.body.c_str());
  }
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, long(request.seconds * 1000));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer);
  const CURLcode done = curl_easy_perform(curl);
  if (done != CURLE_OK) answer.problem = curl_easy_strerror(done);
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  answer.status = int(status);
  curl_header* location = nullptr;
  if (curl_easy_header(curl, "Location", 0, CURLH_HEADER, -1, &location) == CURLHE_OK) {
    // Resolved against the address of the request, as RFC 9725 has it.
    CURLU* whole = curl_url();
    char* text = nullptr;
    if (curl_url_set(whole, CURLUPART_URL, request.url.c_str(), 0) == CURLUE_OK &&
        curl_url_set(whole, CURLUPART_URL, location->value, 0) == CURLUE_OK &&
        curl_url_get(whole, CURLUPART_URL, &text, 0) == CURLUE_OK) {
      answer.location = text;
      curl_free(text);
    }
    curl_url_cleanup(whole);
  }
  curl_slist_free_all(headers);
  curl_easy_cleanup(curl);
  return answer;
}

}  // namespace animeme::webrtc

#else

namespace animeme::webrtc {

HttpAnswer exchange(const HttpRequest&) {
  return {.problem =
              "built without libcurl, which WHIP needs; install it (Debian: "
              "libcurl4-gnutls-dev) and build again"};
}

}  // namespace animeme::webrtc

#endif
