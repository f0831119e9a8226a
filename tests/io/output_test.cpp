// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/output.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <string>

#include "io/export.hpp"
#include "io/sample_asset.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

// The message of the Error{output} that `action` throws, empty if it throws none.
std::string output_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::output);
    return error.what();
  }
  return "";
}

bool mentions(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

TEST(OutputFile, AppearsWholeOnlyAfterCommit) {
  const TestFolder folder;
  {
    OutputFile file(folder / "a.txt");
    file.write("hello ");
    file.write("world");
    EXPECT_EQ(file.size(), 11u);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    file.commit();
  }
  EXPECT_EQ(content_of(folder / "a.txt"), "hello world");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.txt"});
}

TEST(OutputFile, WithoutCommitLeavesTheOldFileAndNothingElse) {
  const TestFolder folder;
  put_content(folder / "a.txt", "old");
  { OutputFile(folder / "a.txt").write("new"); }
  EXPECT_EQ(content_of(folder / "a.txt"), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.txt"});
}

TEST(OutputFile, SeekingBackReplacesBytesWithoutChangingTheSize) {
  const TestFolder folder;
  OutputFile file(folder / "a.txt");
  file.write("....rest");
  file.seek(0);
  file.write("head");
  EXPECT_EQ(file.position(), 4u);
  file.seek(file.size());
  file.write("!");
  file.commit();
  EXPECT_EQ(content_of(folder / "a.txt"), "headrest!");
}

TEST(OutputFile, RefusesFoldersMissingFoldersAndDevicesByName) {
  const TestFolder folder;
  EXPECT_TRUE(mentions(output_error([&] { OutputFile file(folder.path()); }), "is a folder"));
  const auto missing = folder / "none/a.txt";
  const std::string message = output_error([&] { OutputFile file(missing); });
  EXPECT_TRUE(mentions(message, missing.string())) << message;
  EXPECT_TRUE(mentions(message, "No such file")) << message;
  EXPECT_TRUE(mentions(output_error([] { OutputFile file("/dev/null"); }), "not a regular file"));
  EXPECT_FALSE(output_error([] { OutputFile file(""); }).empty());
  EXPECT_TRUE(folder.names().empty());
}

TEST(OutputFile, WritesThroughALinkInsteadOfReplacingIt) {
  const TestFolder folder;
  put_content(folder / "target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  write_file(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(content_of(folder / "target"), "new");
}

TEST(OutputFile, AFolderThatTakesItsNameMeanwhileIsAnErrorThatLeavesNothing) {
  const TestFolder folder;
  const std::string message = output_error([&] {
    OutputFile file(folder / "a.txt");
    file.write("text");
    std::filesystem::create_directories(folder / "a.txt/inside");
    file.commit();
  });
  EXPECT_TRUE(mentions(message, "a.txt")) << message;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.txt"});
}

TEST(OutputFile, RemoveTemporariesLeavesNothingOfOpenFiles) {
  const TestFolder folder;
  OutputFile a(folder / "a.txt"), b(folder / "b.txt");
  a.write("a");
  EXPECT_EQ(folder.names().size(), 2u);
  remove_temporaries();
  EXPECT_TRUE(folder.names().empty());
}

TEST(OutputFile, FileSizeLimitIsAnErrorThatLeavesNothing) {
  const TestFolder folder;
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  rlimit old = {};
  ::getrlimit(RLIMIT_FSIZE, &old);
  const rlimit small{100000, old.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string message =
      output_error([&] { write_file(folder / "a.txt", std::string(200000, 'x')); });
  ::setrlimit(RLIMIT_FSIZE, &old);
  ::signal(SIGXFSZ, handler);
  EXPECT_TRUE(mentions(message, "File too large")) << message;
  EXPECT_TRUE(folder.names().empty());
}

// Every format on disks of several sizes: a whole file or an error, never a part of one.
TEST(OutputFile, AFullDiskIsAnErrorThatLeavesNothing) {
  const TestFolder folder;
  if (::mount("none", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
    GTEST_SKIP() << "cannot mount a small disk here";
  }
  Asset asset;
  asset.walls.push_back(sample_wall("facade", 24, 12));  // above 64 KiB in every format
  const MeshedAsset meshed = mesh_asset(asset);
  for (const char* name : {"a.glb", "a.gltf", "a.obj", "a.stl", "a.ply"}) {
    const std::string message = output_error([&] { export_asset(meshed, folder / name); });
    EXPECT_TRUE(mentions(message, "No space left")) << name << ": " << message;
    EXPECT_TRUE(mentions(message, (folder / name).stem().string())) << name << ": " << message;
    const std::string again = output_error([&] { export_through_assimp(meshed, folder / name); });
    EXPECT_TRUE(mentions(again, "No space left")) << name << ": " << again;
    EXPECT_TRUE(folder.names().empty()) << name;
  }
  ::umount(folder.path().c_str());
}

TEST(OutputFile, AReadOnlyDiskIsAnErrorThatNamesThePath) {
  const TestFolder folder;
  if (::mount("none", folder.path().c_str(), "tmpfs", MS_RDONLY, "size=64k") != 0) {
    GTEST_SKIP() << "cannot mount a disk here";
  }
  const std::string message = output_error([&] { write_file(folder / "a.txt", "text"); });
  ::umount(folder.path().c_str());
  EXPECT_TRUE(mentions(message, "a.txt")) << message;
  EXPECT_TRUE(mentions(message, "Read-only")) << message;
}

// A process killed while it writes leaves the old file whole: the new one has another name.
TEST(OutputFile, BeingKilledLeavesTheOldFileWhole) {
  const TestFolder folder;
  put_content(folder / "a.txt", "old");
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFile file(folder / "a.txt");
    file.write("new");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(content_of(folder / "a.txt"), "old");
}

}  // namespace
}  // namespace sunder
