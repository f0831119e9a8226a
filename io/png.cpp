// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/png.hpp"

#include "io/png_module.hpp"
#include "meshing/embedded_module.hpp"

namespace sunder {

std::string_view png_file();

namespace {

const PngModule& png_module() {
  static const void* const module = load_module(
      {"png", png_file(), "PNG pictures need librsvg's library (librsvg2-2)", ErrorCode::output});
  return *static_cast<const PngModule*>(module);
}

}  // namespace

std::string png_of(std::string_view svg, int width) {
  if (width < kLeastPictureWidth || width > kMostPictureWidth) {
    throw Error(ErrorCode::usage, "a picture's width of " + std::to_string(width) +
                                      " pixels is outside [" + std::to_string(kLeastPictureWidth) +
                                      ", " + std::to_string(kMostPictureWidth) + "]");
  }
  PngModule::Png png = png_module().render(svg, width, kMostPictureWidth);
  if (!png.error.empty()) {
    throw Error(ErrorCode::output,
                "the picture cannot be drawn as PNG, an .svg of it can: " + png.error);
  }
  return std::move(png.bytes);
}

}  // namespace sunder
