// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/stress/command.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

namespace sunder::stress {
namespace {

[[noreturn]] void become(const std::vector<std::string>& arguments, const std::string& talk,
                         const Limits& limits) {
  const int to = open(talk.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(to, STDERR_FILENO);
  const rlimit memory{limits.bytes, limits.bytes};
  setrlimit(RLIMIT_AS, &memory);
  alarm(limits.seconds);
  std::vector<char*> words;
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(words[0], words.data());
  _exit(127);
}

std::string head_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(4096, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

}  // namespace

Outcome run_command(const std::vector<std::string>& arguments, const std::filesystem::path& scratch,
                    const Limits& limits) {
  const std::string talk = scratch.string() + ".talk";
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) become(arguments, talk, limits);
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (child > 0 && WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  if (child > 0 && WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  outcome.talk = head_of(talk);
  std::filesystem::remove(talk);
  return outcome;
}

}  // namespace sunder::stress
