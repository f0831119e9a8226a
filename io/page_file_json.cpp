// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "io/page.hpp"
#include "io/page_file.hpp"
#include "io/printable.hpp"
#include "io/strict_json.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::input, name + ": " + what);
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// The top level's keys and all "uri" texts below it, without keeping the document.
struct UriFinder : nlohmann::json_sax<nlohmann::json> {
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool string(string_t& text) override {
    if (is_uri && !text.starts_with("data:")) uris.insert(text);
    return true;
  }
  bool start_object(std::size_t) override { return ++depth < kDeepest; }
  bool end_object() override { return --depth, true; }
  bool start_array(std::size_t) override { return ++depth < kDeepest; }
  bool end_array() override { return --depth, true; }
  bool key(string_t& key) override {
    is_uri = key == "uri";
    has_asset = has_asset || (depth == 1 && key == "asset");
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

  static constexpr int kDeepest = 64;
  std::set<std::string> uris;
  int depth = 0;
  bool is_uri = false, has_asset = false;
};

UriFinder scan(std::string_view json, const std::string& name) {
  UriFinder finder;
  if (!nlohmann::json::sax_parse(json.begin(), json.end(), &finder))
    refuse(name, "its JSON is not well-formed");
  if (!finder.has_asset) refuse(name, "is no glTF: it has no \"asset\"");
  return finder;
}

}  // namespace

std::string read_page_file(const std::filesystem::path& path) {
  return read_text_file(path, std::size_t{2} << 30);
}

void check_glb(const std::string& bytes, const std::string& name) {
  constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a;
  if (bytes.size() < 20 || word_at(bytes, 0) != kMagic)
    refuse(name, "is not a glTF binary: it does not begin with \"glTF\"");
  if (word_at(bytes, 4) != 2)
    refuse(name, "is glTF " + std::to_string(word_at(bytes, 4)) + ", only 2 is read");
  if (word_at(bytes, 8) != bytes.size())
    refuse(name, "has " + std::to_string(bytes.size()) + " bytes and should have " +
                     std::to_string(word_at(bytes, 8)) + "; it may be cut off");
  const std::uint64_t length = word_at(bytes, 12);
  if (word_at(bytes, 16) != kJson || 20 + length > bytes.size())
    refuse(name, "its first chunk is not the JSON of a glTF");
  if (!scan(std::string_view(bytes).substr(20, length), name).uris.empty())
    refuse(name, "refers to other files; a page takes a .glb that holds all it needs");
}

std::filesystem::path companion_in(const std::string& text, const std::filesystem::path& path) {
  const UriFinder finder = scan(text, path.string());
  std::set<std::string> binaries;
  for (const std::string& uri : finder.uris)
    if (uri.ends_with(".bin")) binaries.insert(uri);
  if (binaries.size() != 1)
    refuse(path.string(), "refers to " + std::to_string(binaries.size()) +
                              " .bin files; a page takes a .gltf with one, or a .glb");
  const std::string& uri = *binaries.begin();
  if (uri.find('/') != std::string::npos || uri.find('\\') != std::string::npos)
    refuse(path.string(), "refers to \"" + printable(uri) + "\", which is not in the same folder");
  return path.parent_path() / uri;
}

std::string read_page_report(const std::filesystem::path& path) {
  std::string text = read_text_file(path);
  const JsonValue value = parse_json(text, path.string());
  if (value.find("version") == nullptr)
    refuse(path.string(),
           value.find("sunder") != nullptr
               ? "is a scene; a page takes what fracture, impact or collapse made of it"
               : "is not a report of sunder: it has no \"version\"");
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

}  // namespace sunder
