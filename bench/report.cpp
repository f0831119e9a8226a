// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/report.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>

namespace sunder {
namespace {

std::string setting(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr ? otherwise : value;
}

}  // namespace

Block::Block(const std::string& name) {
  std::printf("\n<!-- bench: %s -->\n", name.c_str());
}

Block::~Block() {
  std::printf("<!-- end -->\n");
  std::fflush(stdout);
}

std::string text(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  const int size = std::vsnprintf(nullptr, 0, format, values);
  std::string result(static_cast<std::size_t>(size) + 1, '\0');
  std::vsnprintf(result.data(), result.size(), format, again);
  va_end(again);
  va_end(values);
  result.pop_back();
  return result;
}

std::string results_folder() {
  return setting("SUNDER_BENCH_RESULTS", "");
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  char day[11];
  std::strftime(day, sizeof day, "%F", std::gmtime(&now));
  return day;
}

std::string commit() {
  return setting("SUNDER_BENCH_COMMIT", "unknown");
}

}  // namespace sunder
