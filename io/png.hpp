// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace sunder {

/// Pixels of a picture's width: what is taken when nobody says, the least and the most.
constexpr int kPictureWidth = 1800, kLeastPictureWidth = 64, kMostPictureWidth = 8192;

/// The bytes of a PNG of an SVG, `width` pixels wide, as high as the SVG's viewBox says, on white.
/// One that would be higher than kMostPictureWidth is narrower. Texts are set in the fonts of the
/// machine; where there are none they are boxes. Same text, same bytes on one machine. Takes 4
/// bytes a pixel and about a kilobyte per element of the SVG. Throws Error{usage} when the width is
/// out of range, Error{output} when librsvg is not there or cannot draw it (more than a million
/// elements).
std::string png_of(std::string_view svg, int width = kPictureWidth);

}  // namespace sunder
