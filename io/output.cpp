// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstring>

#include "meshing/error.hpp"

namespace sunder {
namespace {

// The names of the temporary files still open. A signal handler can only reach what is global and
// never moves, so this is a fixed table; everything else about an OutputFile is a value.
constexpr int kSlots = 32;
constexpr std::size_t kLongestName = 4096;
struct Slot {
  std::atomic<int> state{0};  // 0 free, 1 being filled, 2 names a temporary file
  char name[kLongestName];
};
Slot slots[kSlots];
std::atomic<std::uint64_t> counter{0};

int take_slot(const std::string& name) {
  if (name.size() >= kLongestName) return -1;
  for (int i = 0; i < kSlots; ++i) {
    int expected = 0;
    if (!slots[i].state.compare_exchange_strong(expected, 1)) continue;
    std::memcpy(slots[i].name, name.c_str(), name.size() + 1);
    slots[i].state.store(2);
    return i;
  }
  return -1;
}

void free_slot(int& slot) {
  if (slot >= 0) slots[slot].state.store(0);
  slot = -1;
}

// Bytes after which the disk is told to begin.
constexpr std::uint64_t kWriteback = std::uint64_t{8} << 20;

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

// A file system that cannot sync (some network and FUSE ones) says EINVAL; that is not a failure
// to write.
bool sync_failed(int descriptor) {
  int result = 0;
  do {
    result = ::fsync(descriptor);
  } while (result != 0 && errno == EINTR);
  return result != 0 && errno != EINVAL && errno != ENOTSUP && errno != ENOSYS;
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  if (path_.empty() || !path_.has_filename()) fail("is not the name of a file", 0);
  std::error_code ignored;
  // A link stays a link: the file it points to is the one replaced.
  if (std::filesystem::is_symlink(path_, ignored)) {
    const std::filesystem::path target = std::filesystem::canonical(path_, ignored);
    if (!ignored) path_ = target;
  }
  struct stat info = {};
  if (::stat(path_.c_str(), &info) == 0) {
    if (S_ISDIR(info.st_mode)) fail("is a folder", 0);
    if (!S_ISREG(info.st_mode)) fail("exists and is not a regular file", 0);
  }
  create();
}

void OutputFile::create() {
  for (int attempt = 0; attempt < 100; ++attempt) {
    const std::string name = ".sunder-" + std::to_string(::getpid()) + "-" +
                             std::to_string(counter.fetch_add(1)) + ".tmp";
    temporary_ = folder_of(path_) / name;
    slot_ = take_slot(temporary_.string());
    if (slot_ < 0) fail("too many files are being written, or the name is too long", 0);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) return;
    const int error = errno;
    free_slot(slot_);
    if (error != EEXIST && error != EINTR) fail("cannot create a file in its folder", error);
  }
  fail("cannot create a file in its folder", EEXIST);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (slot_ >= 0) ::unlink(temporary_.c_str());
  free_slot(slot_);
}

void OutputFile::fail(const std::string& what, int error) const {
  std::string message = path_.string() + ": " + what;
  if (error != 0) message += std::string(": ") + std::strerror(error);
  throw Error(ErrorCode::output, message);
}

void OutputFile::write(std::span<const std::byte> bytes) {
  assert(descriptor_ >= 0);
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("cannot write", errno);
    if (count == 0) fail("cannot write", ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    position_ += static_cast<std::uint64_t>(count);
    if (position_ > size_) size_ = position_;
    start_writeback();
  }
}

// The disk starts on what is there while the rest is being made, so that fsync has less to wait
// for.
void OutputFile::start_writeback() {
#ifdef __linux__
  if (position_ < started_ + kWriteback) return;
  ::sync_file_range(descriptor_, static_cast<off64_t>(started_),
                    static_cast<off64_t>(position_ - started_), SYNC_FILE_RANGE_WRITE);
  started_ = position_;
#endif
}

void OutputFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text)));
}

void OutputFile::seek(std::uint64_t position) {
  assert(descriptor_ >= 0 && position <= size_);
  if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) fail("cannot seek", errno);
  position_ = position;
}

void OutputFile::flush() {
  assert(descriptor_ >= 0);
  if (sync_failed(descriptor_)) fail("cannot write to the disk", errno);
}

void OutputFile::commit() {
  flush();
  const int closed = ::close(descriptor_);
  const int close_error = errno;
  descriptor_ = -1;
  if (closed != 0 && close_error != EINTR) fail("cannot close", close_error);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be replaced", errno);
  free_slot(slot_);
  const int folder = ::open(folder_of(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;  // a folder that may be written but not read: the rename stands
  const bool failed = sync_failed(folder);
  const int error = errno;
  ::close(folder);
  if (failed) fail("cannot write its folder to the disk", error);
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.commit();
}

void remove_temporaries() noexcept {
  for (Slot& slot : slots) {
    if (slot.state.load() == 2) ::unlink(slot.name);
  }
}

}  // namespace sunder
