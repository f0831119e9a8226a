// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/reader_process.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
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
#include <span>
#include <vector>

#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr rlim_t kStack = rlim_t{64} << 20;
enum class Answer : std::uint8_t { result = 1, error = 2, out_of_memory = 3 };

// --- the child
// ------------------------------------------------------------------------------------

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

[[noreturn]] void run_child(int descriptor, const ImportLimits& limits, const ChildWork& read) {
  confine(limits);
  {
    AnswerWriter out(descriptor);
    try {
      const auto send = read();
      out.value(Answer::result);
      send(out);
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

void understand(const std::string& name, const ImportLimits& limits, int status,
                std::span<const char> bytes, const std::function<void(AnswerReader&)>& receive) {
  if (status != 0 || bytes.empty()) report_death(name, limits, status);
  try {
    AnswerReader in(bytes);
    switch (in.value<Answer>()) {
      case Answer::result:
        receive(in);
        if (!in.at_end()) AnswerReader::fail();
        return;
      case Answer::error: throw Error(ErrorCode::input, in.text());
      case Answer::out_of_memory:
        throw Error(ErrorCode::input, "the reader ran out of memory (limit " +
                                          std::to_string(limits.memory >> 20) + " MiB)");
    }
    AnswerReader::fail();
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
}

}  // namespace

void AnswerWriter::send(const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = ::write(descriptor_, data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) ::_exit(1);  // the parent has gone
    data += count;
    size -= static_cast<std::size_t>(count);
  }
}

void AnswerReader::fail() {
  throw Error(ErrorCode::input, "the reader's answer is damaged");
}

void run_reader(const std::string& name, const ImportLimits& limits, const ChildWork& read,
                const std::function<void(AnswerReader&)>& understand_result) {
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
  understand(name, limits, child.finish(false), bytes, understand_result);
}

}  // namespace sunder
