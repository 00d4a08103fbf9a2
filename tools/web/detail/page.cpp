#include "tools/web/detail/page.h"

namespace animeme::web {
namespace {

constexpr std::string_view kMark = "<!-- head -->\n";

}  // namespace

std::string make_page(std::string_view head_script) {
  std::string page(page_text());
  const std::size_t at = page.find(kMark);
  if (at == std::string::npos) return page;
  std::string head;
  if (!head_script.empty()) {
    head = "<script type=\"module\">\n" + std::string(head_script) + std::string(head_glue()) +
           "</script>\n";
  }
  return page.replace(at, kMark.size(), head);
}

}  // namespace animeme::web
