// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/page.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "io/export.hpp"
#include "io/glb.hpp"
#include "io/page_file.hpp"
#include "io/sample_asset.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

constexpr const char* kTemplate = "<title><!--sunder-title--></title>A<!--sunder-data-->B";

std::string bytes_of(std::size_t count, std::uint64_t seed) {
  std::string bytes(count, '\0');
  for (std::size_t i = 0; i < count; ++i)
    bytes[i] = static_cast<char>(random_unit(seed, i / 3, 0) * 256);
  return bytes;
}

std::string decode_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(word >> bits & 255);
  }
  return bytes;
}

std::string inflate_raw(const std::string& packed, std::size_t size) {
  std::string bytes(size + 1, '\0');
  z_stream stream{};
  inflateInit2(&stream, -15);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return bytes;
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from) + from.size();
  return text.substr(begin, text.find(to, begin) - begin);
}

Json list_of(const std::string& page) {
  return Json::parse(between(page, "id=\"sunder-list\">", "</script>"));
}

// An embedded file as the page's script unpacks it.
std::string embedded(const std::string& page, const Json& file) {
  const std::string text =
      between(page, "id=\"" + file["id"].get<std::string>() + "\">", "</script>");
  const std::string planes = inflate_raw(decode_base64(text), file["size"]);
  const std::size_t start = file["words"], count = (planes.size() - start) / 4;
  std::string bytes = planes;
  for (std::size_t i = 0; i < 4 * count; ++i)
    bytes[start + i] = planes[start + i % 4 * count + i / 4];
  return bytes;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Asset sample_asset() {
  Asset asset;
  asset.walls.push_back(sample_wall("facade", 5, 3));
  return asset;
}

std::filesystem::path scratch() {
  const auto folder =
      std::filesystem::temp_directory_path() / ("sunder-page-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  return folder;
}

std::string message_of(const std::function<void()>& action, ErrorCode code) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

TEST(Page, HoldsExactlyTheBytesOfItsFiles) {
  for (const std::size_t size : {1, 2, 3, 4, 5, 7, 19, 20, 21, 1000, 70001}) {
    PageModel model{"run", bytes_of(size, size), bytes_of(size / 2, 3), ""};
    const std::string page = page_text({&model, 1}, kTemplate);
    const Json files = list_of(page)[0]["files"];
    EXPECT_EQ(embedded(page, files[0]), model.file) << size;
    ASSERT_EQ(files.size(), model.companion.empty() ? 1u : 2u);
    if (files.size() == 2) {
      EXPECT_EQ(embedded(page, files[1]), model.companion) << size;
    }
    EXPECT_EQ(page, page_text({&model, 1}, kTemplate));
  }
}

TEST(Page, OfAnAssetHoldsTheFileThatExportWrites) {
  if (page_template().empty()) GTEST_SKIP() << "built without a page";
  const auto folder = scratch();
  const Asset asset = sample_asset();
  const MeshedAsset meshed = mesh_asset(asset);
  export_asset(meshed, folder / "wall.glb");
  export_asset(meshed, folder / "wall.html");
  const std::string page = read(folder / "wall.html"), glb = read(folder / "wall.glb");
  const Json list = list_of(page);
  EXPECT_EQ(list[0]["name"], "wall");
  EXPECT_EQ(embedded(page, list[0]["files"][0]), glb);
  const PageModel model = read_page_model(folder / "wall.glb");
  EXPECT_EQ(model.file, glb);
  std::filesystem::remove_all(folder);
}

TEST(Page, NamesAndReportsAreNeverTags) {
  PageModel model{"</script><b>&\"'", "x", "", R"({"version": "</script><!--"})"};
  const std::string page = page_text({&model, 1}, kTemplate);
  EXPECT_NE(page.find("<title>&lt;/script&gt;&lt;b&gt;&amp;\"' – sunder</title>"),
            std::string::npos);
  std::size_t ends = 0;
  for (std::size_t at = page.find("</"); at != std::string::npos; at = page.find("</", at + 1))
    ++ends;
  EXPECT_EQ(ends, 3u);  // title, list, file
  EXPECT_EQ(page.find("<!--"), std::string::npos);
  const Json list = list_of(page);
  EXPECT_EQ(list[0]["name"], model.name);
  EXPECT_EQ(list[0]["report"]["version"], "</script><!--");
}

TEST(Page, AbsentFromTheBuildSaysWhatToInstall) {
  const std::string message = message_of([] { page_text({}, ""); }, ErrorCode::output);
  EXPECT_NE(message.find("nodejs npm"), std::string::npos) << message;
}

TEST(Page, IsOneFileWithoutLinks) {
  if (page_template().empty()) GTEST_SKIP() << "built without a page";
  const std::string page(page_template());
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(page.find(" src=\""), std::string::npos);
  EXPECT_EQ(page.find("@import"), std::string::npos);
  EXPECT_EQ(page.find("fetch(\"http"), std::string::npos);
}

// A GLB with a header that says what it is told to.
std::string glb_with(const std::string& json, std::uint32_t version = 2, int more_bytes = 0) {
  std::string bytes = "glTF";
  const auto put = [&bytes](std::uint32_t word) {
    bytes.append(reinterpret_cast<const char*>(&word), 4);
  };
  put(version);
  put(static_cast<std::uint32_t>(20 + static_cast<int>(json.size()) + more_bytes));
  put(static_cast<std::uint32_t>(json.size()));
  return bytes + "JSON" + json;
}

TEST(PageFile, TakesASoundGlbOnly) {
  EXPECT_NO_THROW(check_glb(glb_with(R"({"asset":{"version":"2.0"}})"), "a.glb"));
  const std::string deep = R"({"asset":)" + std::string(100, '[') + std::string(100, ']') + "}";
  const std::pair<std::string, const char*> bad[] = {
      {"", "does not begin"},
      {"solid cube, an STL file", "does not begin"},
      {glb_with("{}", 1), "is glTF 1"},
      {glb_with(R"({"asset":{}})", 2, 4), "may be cut off"},
      {glb_with(R"({"asset":{})"), "not well-formed"},
      {glb_with(deep), "not well-formed"},
      {glb_with(R"({"nodes":[{"asset":1}]})"), "no \"asset\""},
      {glb_with(R"({"asset":{},"buffers":[{"uri":"a.bin"}]})"), "other files"},
  };
  for (const auto& [bytes, what] : bad) {
    const std::string message =
        message_of([&bytes = bytes] { check_glb(bytes, "a.glb"); }, ErrorCode::input);
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_TRUE(message.starts_with("a.glb: ")) << message;
  }
}

TEST(PageFile, OfAGltfStaysInItsFolder) {
  const auto text = [](const std::string& buffers) {
    return R"({"asset":{},"buffers":[)" + buffers + "]}";
  };
  EXPECT_EQ(companion_in(text(R"({"uri":"a b.bin"})"), "in/x.gltf"), "in/a b.bin");
  for (const char* buffers :
       {"", R"({"uri":"../a.bin"})", R"({"uri":"a.bin"},{"uri":"b.bin"})", R"({"uri":"/a.bin"})"})
    message_of([&] { companion_in(text(buffers), "in/x.gltf"); }, ErrorCode::input);
}

TEST(PageFile, ReadsTheFormatsWithoutExtrasToo) {
  const auto folder = scratch();
  const Asset asset = sample_asset();
  const MeshedAsset meshed = mesh_asset(asset);
  for (const char* suffix : {".obj", ".stl", ".ply", ".gltf"}) {
    const auto path = folder / (std::string("wall") + suffix);
    export_asset(meshed, path);
    const PageModel model = read_page_model(path);
    EXPECT_EQ(model.name, path.filename());
    EXPECT_EQ(model.companion.empty(), std::string(suffix) != ".gltf");
    if (!model.companion.empty()) continue;
    check_glb(model.file, suffix);
    const Glb glb(model.file);
    EXPECT_EQ(glb.json["nodes"].size(), std::string(suffix) == ".obj" ? 15u : 1u);
    std::size_t indices = 0;
    for (const Json& mesh : glb.json["meshes"])
      for (const Json& primitive : mesh["primitives"])
        indices += glb.json["accessors"][primitive["indices"].get<std::size_t>()]["count"]
                       .get<std::size_t>();
    EXPECT_EQ(indices, 15u * 12 * 3) << suffix;  // a hexahedron each
  }
  std::filesystem::remove_all(folder);
}

TEST(PageFile, KnowsAReportFromAScene) {
  const auto folder = scratch();
  const auto put = [&folder](const char* text) {
    std::ofstream(folder / "a.json") << text;
    return folder / "a.json";
  };
  EXPECT_EQ(read_page_report(put(R"({"version": "1"})")), R"({"version": "1"})");
  const auto refusal = [&](const char* text) {
    const auto path = put(text);
    return message_of([&] { read_page_report(path); }, ErrorCode::input);
  };
  EXPECT_NE(refusal(R"({"sunder": 1})").find("is a scene"), std::string::npos);
  EXPECT_NE(refusal("[1]").find("not a report"), std::string::npos);
  refusal("{");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace sunder
