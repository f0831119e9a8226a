// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/reader_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr rlim_t kStack = rlim_t{64} << 20;
constexpr std::size_t kLongestText = 4096;
enum class Answer : std::uint8_t { asset = 1, error = 2, out_of_memory = 3 };

// --- the child
// ------------------------------------------------------------------------------------

class PipeWriter {
 public:
  explicit PipeWriter(int descriptor) : descriptor_(descriptor) { buffer_.reserve(kSize); }
  ~PipeWriter() { flush(); }
  template <class T>
  void value(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(&value, sizeof value);
  }
  void text(std::string_view text) {
    text = text.substr(0, kLongestText);
    value(static_cast<std::uint32_t>(text.size()));
    bytes(text.data(), text.size());
  }
  template <class T>
  void array(const std::vector<T>& values) {
    value(static_cast<std::uint64_t>(values.size()));
    bytes(values.data(), values.size() * sizeof(T));
  }

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 18;
  void bytes(const void* data, std::size_t size) {
    if (size == 0) return;
    if (buffer_.size() + size > kSize) flush();
    if (size > kSize) return send(static_cast<const char*>(data), size);
    const auto* begin = static_cast<const char*>(data);
    buffer_.insert(buffer_.end(), begin, begin + size);
  }
  void flush() {
    send(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  void send(const char* data, std::size_t size) {
    while (size > 0) {
      const ssize_t count = ::write(descriptor_, data, size);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) ::_exit(1);  // the parent has gone
      data += count;
      size -= static_cast<std::size_t>(count);
    }
  }
  int descriptor_;
  std::vector<char> buffer_;
};

void send_asset(const ImportedAsset& asset, PipeWriter& out) {
  out.value(Answer::asset);
  out.value(asset.has_chunks);
  out.value(asset.has_materials);
  out.value(static_cast<std::uint64_t>(asset.walls.size()));
  for (const ImportedWall& wall : asset.walls) {
    out.text(wall.name);
    out.text(wall.material);
    out.value(wall.volume_expected);
    out.value(wall.bonds);
    out.value(static_cast<std::uint64_t>(wall.chunks.size()));
    for (const ImportedChunk& chunk : wall.chunks) {
      out.text(chunk.name);
      out.array(chunk.positions);
      out.array(chunk.triangles);
      out.array(chunk.inner);
    }
  }
}

// Bytes of address space this process has already, which the limit comes on top of.
std::uint64_t address_space() {
  unsigned long long pages = 0;
  if (FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void limit(int resource, rlim_t value) {
  rlimit now = {};
  ::getrlimit(static_cast<__rlimit_resource_t>(resource), &now);
  if (now.rlim_max != RLIM_INFINITY) value = std::min(value, now.rlim_max);
  const rlimit wanted{value, value};
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &wanted);
}

// The child answers to no one's handlers, says nothing, dies with its parent, and gets what the
// limits give.
void confine(const ImportLimits& limits) {
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int null = ::open("/dev/null", O_RDWR);
  for (int descriptor = 0; descriptor <= 2; ++descriptor) ::dup2(null, descriptor);
  ::malloc_trim(0);  // memory the parent no longer uses is not a reserve beyond the limit
  limit(RLIMIT_AS, address_space() + limits.memory);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_STACK, kStack);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds) + 1);
  const auto whole = static_cast<time_t>(limits.seconds);
  const auto micro = static_cast<suseconds_t>((limits.seconds - static_cast<double>(whole)) * 1e6);
  const itimerval timer{{0, 0}, {whole, std::max<suseconds_t>(micro, 1)}};
  ::setitimer(ITIMER_PROF, &timer, nullptr);  // finer than whole seconds; its signal kills
}

[[noreturn]] void run_child(int descriptor, const ImportLimits& limits,
                            const std::function<ImportedAsset()>& read) {
  confine(limits);
  {
    PipeWriter out(descriptor);
    try {
      send_asset(read(), out);
    } catch (const std::bad_alloc&) {
      out.value(Answer::out_of_memory);
    } catch (const std::exception& error) {
      out.value(Answer::error);
      out.text(error.what());
    }
  }
  ::_exit(0);
}

// --- the parent
// -----------------------------------------------------------------------------------

// Reads what the child sent; every size is checked against what really came.
class PipeReader {
 public:
  explicit PipeReader(std::span<const char> bytes) : left_(bytes) {}
  template <class T>
  T value() {
    T result{};
    std::memcpy(&result, take(sizeof result).data(), sizeof result);
    return result;
  }
  std::string text() {
    const auto size = value<std::uint32_t>();
    if (size > kLongestText) fail();
    const auto part = take(size);
    std::string result(part.begin(), part.end());
    for (char& c : result) {
      if (static_cast<unsigned char>(c) < ' ' || c == 0x7F) c = '?';
    }
    return result;
  }
  template <class T>
  std::vector<T> array() {
    const auto count = value<std::uint64_t>();
    if (count > left_.size() / sizeof(T)) fail();
    std::vector<T> result(count);
    const auto part = take(count * sizeof(T));
    if (count > 0) std::memcpy(result.data(), part.data(), part.size());
    return result;
  }
  /// Number of items that follow, each at least `least` bytes long.
  std::uint64_t count(std::size_t least) {
    const auto result = value<std::uint64_t>();
    if (result > left_.size() / least) fail();
    return result;
  }
  bool at_end() const { return left_.empty(); }
  [[noreturn]] static void fail() {
    throw Error(ErrorCode::input, "the reader's answer is damaged");
  }

 private:
  std::span<const char> take(std::size_t size) {
    if (size > left_.size()) fail();
    const auto part = left_.first(size);
    left_ = left_.subspan(size);
    return part;
  }
  std::span<const char> left_;
};

ImportedChunk receive_chunk(PipeReader& in) {
  ImportedChunk chunk;
  chunk.name = in.text();
  chunk.positions = in.array<float>();
  chunk.triangles = in.array<std::uint32_t>();
  chunk.inner = in.array<std::uint8_t>();
  const std::size_t vertices = chunk.positions.size() / 3;
  if (chunk.positions.size() % 3 != 0 || chunk.triangles.size() != 3 * chunk.inner.size() ||
      std::ranges::any_of(chunk.triangles, [&](std::uint32_t v) { return v >= vertices; })) {
    PipeReader::fail();
  }
  return chunk;
}

ImportedAsset receive_asset(PipeReader& in) {
  ImportedAsset asset;
  asset.has_chunks = in.value<std::uint8_t>() != 0;
  asset.has_materials = in.value<std::uint8_t>() != 0;
  const std::uint64_t walls = in.count(4);
  for (std::uint64_t w = 0; w < walls; ++w) {
    ImportedWall wall;
    wall.name = in.text();
    wall.material = in.text();
    wall.volume_expected = in.value<double>();
    wall.bonds = in.value<std::uint64_t>();
    const std::uint64_t chunks = in.count(4);
    for (std::uint64_t c = 0; c < chunks; ++c) wall.chunks.push_back(receive_chunk(in));
    asset.walls.push_back(std::move(wall));
  }
  if (!in.at_end()) PipeReader::fail();
  return asset;
}

// A child that is killed and waited for on every path.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() { finish(true); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  /// Exit status as waitpid gives it.
  int finish(bool kill) {
    if (id_ <= 0) return status_;
    if (kill) ::kill(id_, SIGKILL);
    while (::waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status_;
  }

 private:
  pid_t id_;
  int status_ = 0;
};

class Descriptor {
 public:
  explicit Descriptor(int id) : id_(id) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return id_; }
  void close() {
    if (id_ >= 0) ::close(id_);
    id_ = -1;
  }

 private:
  int id_;
};

enum class Ending { answered, late, too_much };

Ending receive(int descriptor, const ImportLimits& limits, std::vector<char>& bytes) {
  using Clock = std::chrono::steady_clock;
  // Waiting for a slow disk takes no processor time; the clock on the wall is a second bound.
  const auto end = Clock::now() + std::chrono::duration<double>(2 * limits.seconds + 1);
  std::vector<char> part(std::size_t{1} << 18);
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd wait{descriptor, POLLIN, 0};
    const int ready = left.count() <= 0 ? 0 : ::poll(&wait, 1, static_cast<int>(left.count()));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return Ending::late;
    const ssize_t count = ::read(descriptor, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return Ending::answered;
    bytes.insert(bytes.end(), part.begin(), part.begin() + count);
    if (bytes.size() > limits.memory) return Ending::too_much;
  }
}

[[noreturn]] void report_death(const std::string& name, const ImportLimits& limits, int status) {
  char text[120];
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGPROF || signal == SIGXCPU) {
    std::snprintf(text, sizeof text, "the reader took too long (limit %g s)", limits.seconds);
  } else if (signal == SIGKILL) {
    std::snprintf(text, sizeof text, "the reader was killed, perhaps for lack of memory");
  } else if (signal != 0) {
    std::snprintf(text, sizeof text, "the reader crashed (signal %d): the file is damaged", signal);
  } else {
    std::snprintf(text, sizeof text, "the reader gave up: the file is damaged");
  }
  throw Error(ErrorCode::input, name + ": " + text);
}

ImportedAsset understand(const std::string& name, const ImportLimits& limits, int status,
                         std::span<const char> bytes) {
  if (status != 0 || bytes.empty()) report_death(name, limits, status);
  try {
    PipeReader in(bytes);
    switch (in.value<Answer>()) {
      case Answer::asset: return receive_asset(in);
      case Answer::error: throw Error(ErrorCode::input, in.text());
      case Answer::out_of_memory:
        throw Error(ErrorCode::input, "the reader ran out of memory (limit " +
                                          std::to_string(limits.memory >> 20) + " MiB)");
    }
    PipeReader::fail();
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
}

}  // namespace

ImportedAsset run_reader(const std::string& name, const ImportLimits& limits,
                         const std::function<ImportedAsset()>& read) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(ErrorCode::input, name + ": no pipe for the reader: " + std::strerror(errno));
  }
  Descriptor in(ends[0]), out(ends[1]);
  const pid_t id = ::fork();
  if (id < 0) {
    throw Error(ErrorCode::input, name + ": no process for the reader: " + std::strerror(errno));
  }
  if (id == 0) {
    in.close();
    run_child(out.get(), limits, read);
  }
  Child child(id);
  out.close();
  std::vector<char> bytes;
  const Ending ending = receive(in.get(), limits, bytes);
  if (ending == Ending::late) {
    char text[80];
    std::snprintf(text, sizeof text, "the reader took too long (limit %g s)", limits.seconds);
    throw Error(ErrorCode::input, name + ": " + text);
  }
  if (ending == Ending::too_much) {
    throw Error(ErrorCode::input, name + ": the reader's answer is above the memory limit");
  }
  return understand(name, limits, child.finish(false), bytes);
}

}  // namespace sunder
