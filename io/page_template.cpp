// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/page.hpp"

#ifdef SUNDER_PAGE
// The page is part of the library, so that there is no place where it must be found.
asm(R"(
  .section .rodata
  .global sunder_page, sunder_page_end
sunder_page:
  .incbin ")" SUNDER_PAGE R"("
sunder_page_end:
  .byte 0
  .previous
)");
extern "C" const char sunder_page[], sunder_page_end[];
#endif

namespace sunder {

std::string_view page_template() {
#ifdef SUNDER_PAGE
  return {sunder_page, static_cast<std::size_t>(sunder_page_end - sunder_page)};
#else
  return {};
#endif
}

}  // namespace sunder
