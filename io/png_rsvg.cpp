// SPDX-License-Identifier: GPL-3.0-or-later
#include <librsvg/rsvg.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "io/png_module.hpp"

namespace sunder {
namespace {

struct Release {
  void operator()(GInputStream* stream) const { g_object_unref(stream); }
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
template <class Thing>
using Owned = std::unique_ptr<Thing, Release>;

PngModule::Png failed(GError* error) {
  PngModule::Png result{{}, error != nullptr ? error->message : "unknown reason"};
  g_clear_error(&error);
  return result;
}

struct Size {
  int width = 1, height = 1;
};

Size size_of(RsvgHandle* handle, int width, int most_height) {
  gboolean has_box = FALSE;
  RsvgRectangle box{0, 0, 1, 1};
  rsvg_handle_get_intrinsic_dimensions(handle, nullptr, nullptr, nullptr, nullptr, &has_box, &box);
  const double steepness = has_box && box.width > 0 ? box.height / box.width : 1;
  const double most_width = std::min<double>(width, most_height / std::max(steepness, 1e-9));
  const auto pixels = [](double value) { return std::max(1, static_cast<int>(value + 0.5)); };
  return {pixels(most_width), std::min(pixels(most_width * steepness), most_height)};
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

PngModule::Png render(std::string_view svg, int width, int most_height) {
  GError* error = nullptr;
  const Owned<GInputStream> text(
      g_memory_input_stream_new_from_data(svg.data(), static_cast<gssize>(svg.size()), nullptr));
  // Without it a path's text may have at most ten million characters.
  const Owned<RsvgHandle> handle(rsvg_handle_new_from_stream_sync(
      text.get(), nullptr, RSVG_HANDLE_FLAG_UNLIMITED, nullptr, &error));
  if (!handle) return failed(error);
  const Size size = size_of(handle.get(), width, most_height);
  const Owned<cairo_surface_t> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, size.width, size.height));
  const Owned<cairo_t> context(cairo_create(surface.get()));
  cairo_set_source_rgb(context.get(), 1, 1, 1);
  cairo_paint(context.get());
  const RsvgRectangle viewport{0, 0, static_cast<double>(size.width),
                               static_cast<double>(size.height)};
  if (!rsvg_handle_render_document(handle.get(), context.get(), &viewport, &error))
    return failed(error);
  PngModule::Png png;
  const cairo_status_t status =
      cairo_surface_write_to_png_stream(surface.get(), append, &png.bytes);
  if (status != CAIRO_STATUS_SUCCESS) png.error = cairo_status_to_string(status);
  return png;
}

}  // namespace
}  // namespace sunder

extern "C" __attribute__((visibility("default")))
const sunder::PngModule sunder_png_module{sunder::render};
