// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/png.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "io/export.hpp"
#include "io/export_recording.hpp"
#include "io/sample_asset.hpp"
#include "io/sample_recording.hpp"
#include "io/strip_steps.hpp"
#include "io/strip_svg.hpp"
#include "meshing/error.hpp"
#include "meshing/level_set_module.hpp"

namespace sunder {
namespace {

using Colour = std::array<int, 3>;

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

// A reader of our own: 8-bit RGB without interlacing.
struct Image {
  std::uint32_t width = 0, height = 0;
  std::vector<unsigned char> data;

  explicit Image(const std::string& png) {
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    std::string packed;
    for (std::size_t at = 8; at < png.size(); at += 12 + big_endian(png, at)) {
      const std::string kind = png.substr(at + 4, 4);
      if (kind == "IDAT") packed += png.substr(at + 8, big_endian(png, at));
      if (kind != "IHDR") continue;
      width = big_endian(png, at + 8), height = big_endian(png, at + 12);
      EXPECT_EQ(png.substr(at + 16, 5), std::string("\x08\x02\0\0\0", 5));
    }
    data.resize(std::size_t{height} * (1 + 3 * width));
    uLongf size = data.size();
    EXPECT_EQ(uncompress(data.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                         packed.size()),
              Z_OK);
    EXPECT_EQ(size, data.size());
    for (std::uint32_t y = 0; y < height; ++y)
      for (std::uint32_t k = 0; k < 3 * width; ++k) unfilter(y, k);
  }

  Colour at(std::uint32_t x, std::uint32_t y) const {
    const unsigned char* p = &data[row(y) + 1 + 3 * x];
    return {p[0], p[1], p[2]};
  }

 private:
  std::size_t row(std::uint32_t y) const { return std::size_t{y} * (1 + 3 * width); }
  void unfilter(std::uint32_t y, std::uint32_t k) {
    const std::size_t here = row(y) + 1 + k;
    const int left = k >= 3 ? data[here - 3] : 0;
    const int up = y > 0 ? data[here - 1 - 3 * width] : 0;
    const int corner = y > 0 && k >= 3 ? data[here - 4 - 3 * width] : 0;
    const int p = left + up - corner;
    const int a = std::abs(p - left), b = std::abs(p - up), c = std::abs(p - corner);
    const int paeth = a <= b && a <= c ? left : b <= c ? up : corner;
    const int guesses[] = {0, left, up, (left + up) / 2, paeth};
    data[here] = static_cast<unsigned char>(data[here] + guesses[data[row(y)]]);
  }
};

std::string svg_of(double width, double height, const std::string& content) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + std::to_string(width) + " " +
         std::to_string(height) + "\">" + content + "</svg>";
}

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Png, HasTheColoursOfTheSvgWhereTheyAre) {
  const std::string halves =
      "<rect width=\"20\" height=\"10\" fill=\"#ff0000\"/>"
      "<rect x=\"20\" width=\"10\" height=\"10\" fill=\"#0000ff\"/>";
  const Image image(png_of(svg_of(40, 10, halves), 400));
  EXPECT_EQ(image.width, 400u);
  EXPECT_EQ(image.height, 100u);
  for (const std::uint32_t y : {0u, 50u, 99u}) {
    EXPECT_EQ(image.at(0, y), (Colour{255, 0, 0}));
    EXPECT_EQ(image.at(199, y), (Colour{255, 0, 0}));
    EXPECT_EQ(image.at(200, y), (Colour{0, 0, 255}));
    EXPECT_EQ(image.at(350, y), (Colour{255, 255, 255})) << "nothing is white";
  }
}

TEST(Png, IsNarrowerWhereItWouldBeTooHigh) {
  const Image image(png_of(svg_of(1, 100, ""), 1000));
  EXPECT_EQ(image.width, 82u);
  EXPECT_EQ(image.height, 8192u);
}

TEST(Png, TheLeastAndTheMostWidthAreTakenAndNoOther) {
  const std::string svg = svg_of(10, 1, "");
  EXPECT_EQ(Image(png_of(svg, kLeastPictureWidth)).width, 64u);
  EXPECT_EQ(Image(png_of(svg, kMostPictureWidth)).width, 8192u);
  for (const int width : {-1, 0, 63, 8193}) {
    try {
      png_of(svg, width);
      ADD_FAILURE() << width;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      EXPECT_NE(std::string(error.what()).find("is outside [64, 8192]"), std::string::npos);
    }
  }
}

TEST(Png, WhatCannotBeDrawnIsAnErrorThatSaysWhy) {
  for (const std::string& svg : {std::string("no picture"), std::string(), svg_of(1, 1, "<g>")}) {
    try {
      png_of(svg, 100);
      ADD_FAILURE() << svg;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::output);
      EXPECT_GT(std::string(error.what()).size(), 60u) << error.what();
    }
  }
}

TEST(Png, BothModulesOfTheLibraryLoadInOneProgram) {
  const LevelSetModule& level_set = level_set_module();
  EXPECT_FALSE(png_of(svg_of(1, 1, ""), 64).empty());
  EXPECT_EQ(&level_set, &level_set_module());
  EXPECT_TRUE(level_set.quads({}, 3, 1).quads.empty());
}

TEST(Png, OfAnAssetIsItsSvgDrawnAndTheSameEachTime) {
  Asset asset;
  asset.walls.push_back(sample_wall("facade", 6, 4));
  const auto folder = std::filesystem::temp_directory_path();
  const std::string name = "sunder_png_test_" + std::to_string(::getpid());
  const auto svg = folder / (name + ".svg"), png = folder / (name + ".png");
  MeshedAsset meshes = mesh_asset(asset);
  meshes.picture_width = 320;
  export_asset(meshes, svg);
  export_asset(meshes, png);
  const std::string bytes = read(png);
  EXPECT_EQ(bytes, png_of(read(svg), 320));
  EXPECT_EQ(Image(bytes).width, 320u);
  std::filesystem::remove(svg);
  std::filesystem::remove(png);
}

TEST(Png, OfARecordingIsItsStripOrTheMoment) {
  const Recording recording = sample_recording({sample_wall("facade", 12, 6)}, {.steps = 60});
  const auto path = std::filesystem::temp_directory_path() /
                    ("sunder_png_test_run_" + std::to_string(::getpid()) + ".png");
  export_recording(recording, path, {.picture_width = 300});
  EXPECT_EQ(read(path), png_of(draw_strip(recording), 300));
  const double at = recording.times[40];
  export_recording(recording, path, {.at = at, .picture_width = 300});
  EXPECT_EQ(read(path), png_of(draw_strip(recording, {.only = 40}), 300));
  std::filesystem::remove(path);
}

// --- a single picture

std::string inside_of(const std::string& svg, std::size_t picture) {
  std::size_t at = 0;
  for (std::size_t i = 0; i <= picture; ++i) at = svg.find("<use href=\"#scenery\"/>", at + 1);
  return svg.substr(at, svg.find("</g>\n", at) - at);
}

TEST(Strip, ASinglePictureIsThatOfTheStripLarger) {
  const Recording recording = sample_recording({sample_wall("facade", 12, 6)}, {.steps = 120});
  const std::string strip = draw_strip(recording);
  const std::vector<std::uint32_t> steps = strip_steps(recording, 6);
  ASSERT_EQ(steps.size(), 6u);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string one = draw_strip(recording, {.only = steps[i]});
    EXPECT_EQ(inside_of(one, 0), inside_of(strip, i));
    EXPECT_GT(inside_of(one, 0).size(), 1000u);
    EXPECT_NE(one.find("width=\"1020\" height=\"660\""), std::string::npos) << one.substr(0, 200);
    EXPECT_EQ(one.find("<svg x=", one.find("<svg x=") + 1), std::string::npos) << "one picture";
  }
}

}  // namespace
}  // namespace sunder
