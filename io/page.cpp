// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/page.hpp"

#include <algorithm>
#include <cstring>

#include "io/export_files.hpp"
#include "io/imported_glb.hpp"
#include "io/json_lines.hpp"
#include "io/output.hpp"
#include "io/page_file.hpp"
#include "io/page_zlib.hpp"
#include "io/string_sink.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::string_view kDataPlace = "<!--sunder-data-->", kTitlePlace = "<!--sunder-title-->";
constexpr std::uint64_t kMostCharacters = (std::uint64_t{1} << 29) - 64;  // of a text in a browser

void append_base64(std::string_view bytes, std::string& out) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  out.reserve(out.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= count ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
}

// A JSON text between script tags: nothing in it may look like a tag. `<` stands in texts only.
std::string without_tags(std::string_view json) {
  std::string result;
  for (const char c : json) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

// From `start` on the first bytes of all words of four, then the second, third and fourth ones,
// then what is left of the last word: floats that are alike pack better so.
std::string in_planes(const std::string& bytes, std::size_t start) {
  const std::size_t count = (bytes.size() - start) / 4;
  std::string result = bytes;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < count; ++i)
      result[start + k * count + i] = bytes[start + 4 * i + k];
  return result;
}

// Where a GLB's binary chunk begins; a .gltf's text has none.
std::size_t words_of(const std::string& file) {
  if (!file.starts_with("glTF") || file.size() < 20) return file.size();
  std::uint32_t json = 0;
  std::memcpy(&json, file.data() + 12, sizeof json);
  return std::min(file.size(), std::size_t{20} + json);
}

// Appends an embedded file as an element, and what the list says of it.
void add_file(const std::string& bytes, std::size_t words, const std::string& name,
              std::size_t number, std::string& elements, std::string& list) {
  const std::string id = "sunder-file-" + std::to_string(number);
  const std::string packed = deflate_raw(in_planes(bytes, words));
  if (packed.size() / 3 * 4 > kMostCharacters)
    throw Error(ErrorCode::output, name + " has " + std::to_string(packed.size() >> 20) +
                                       " MiB when packed, and a page holds at most 384");
  elements.append("<script type=\"application/octet-stream\" id=\"").append(id).append("\">");
  append_base64(packed, elements);
  elements += "</script>\n";
  list.append("{\"id\":\"").append(id).append("\",\"size\":");
  list.append(std::to_string(bytes.size())).append(",\"words\":");
  list.append(std::to_string(words)) += '}';
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '&': result += "&amp;"; break;
      default: result += c;
    }
  }
  return result;
}

}  // namespace

void require_page(std::string_view page) {
  if (!page.empty()) return;
  throw Error(ErrorCode::output,
              "this build of sunder has no 3D page: install node and npm (Debian: nodejs npm) and "
              "build again with -DSUNDER_VIEWER=ON");
}

std::string page_text(std::span<const PageModel> models, std::string_view page) {
  require_page(page);
  std::string list = "[", elements;
  std::size_t number = 0;
  for (const PageModel& model : models) {
    list += list.size() > 1 ? ",{\"name\":" : "{\"name\":";
    list += without_tags(json_quoted(model.name)) + ",\"files\":[";
    add_file(model.file, words_of(model.file), model.name, number++, elements, list);
    if (!model.companion.empty()) {
      list += ',';
      add_file(model.companion, 0, model.name, number++, elements, list);
    }
    list += "],\"report\":";
    list += model.report.empty() ? "null" : without_tags(model.report);
    list += '}';
  }
  const std::size_t title_at = page.find(kTitlePlace), data_at = page.find(kDataPlace);
  std::string text(page.substr(0, title_at));
  if (!models.empty()) text += escaped(models.front().name).append(" – ");
  text += "sunder";
  text += page.substr(title_at + kTitlePlace.size(), data_at - title_at - kTitlePlace.size());
  text += "<script type=\"application/json\" id=\"sunder-list\">";
  text.append(list).append("]</script>\n");
  text += elements;
  text += page.substr(data_at + kDataPlace.size());
  return text;
}

void write_page(const std::filesystem::path& path, std::span<const PageModel> models) {
  write_file(path, page_text(models));
}

PageModel read_page_model(const std::filesystem::path& path) {
  const std::string suffix = suffix_of(path);
  PageModel model{path.filename().string(), {}, {}, {}};
  if (suffix == ".glb") {
    model.file = read_page_file(path);
    check_glb(model.file, path.string());
  } else if (suffix == ".gltf") {
    model.file = read_page_file(path);
    model.companion = read_page_file(companion_in(model.file, path));
  } else if (is_import_suffix(suffix)) {
    model.file = glb_of(import_asset(path));
  } else {
    throw Error(ErrorCode::usage, path.string() + ": suffix \"" + suffix +
                                      "\" is not one of .glb .gltf .obj .stl .ply (or .json: a "
                                      "report)");
  }
  return model;
}

}  // namespace sunder
