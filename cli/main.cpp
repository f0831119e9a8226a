// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "cli/run.hpp"
#include "io/output.hpp"
#include "meshing/error.hpp"

namespace {

void stop(int signal) {
  sunder::remove_temporaries();
  _exit(128 + signal);
}

int exit_code(sunder::ErrorCode code) {
  switch (code) {
    case sunder::ErrorCode::usage: return sunder::kExitUsage;
    case sunder::ErrorCode::input:
    case sunder::ErrorCode::geometry: return sunder::kExitInput;
    case sunder::ErrorCode::output: return sunder::kExitOutput;
  }
  return sunder::kExitBug;
}

int run(int argc, char** argv) {
  const auto options = sunder::parse_options(argc, argv);
  if (!options) return sunder::kExitOk;
  switch (options->verb) {
    case sunder::Verb::fracture: return sunder::run_fracture(*options);
    case sunder::Verb::impact: return sunder::run_impact(*options);
    case sunder::Verb::collapse: return sunder::run_collapse(*options);
    case sunder::Verb::check: return sunder::run_check(*options);
    case sunder::Verb::schema: return sunder::run_schema(*options);
    case sunder::Verb::view: return sunder::run_view(*options);
    case sunder::Verb::completion: return sunder::run_completion(*options);
  }
  return sunder::kExitBug;
}

// What was printed must have arrived: a full disk behind stdout is an error too.
int finish(int code) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  std::fprintf(stderr, "sunder: error: cannot write to standard output\n");
  return sunder::kExitOutput;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  if (std::signal(SIGHUP, stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // under nohup
  std::signal(SIGXFSZ, SIG_IGN);  // a full quota is a write error, reported as such
  try {
    return finish(run(argc, argv));
  } catch (const sunder::Error& error) {
    std::fprintf(stderr, "sunder: error: %s\n", error.what());
    return exit_code(error.code());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "sunder: error: out of memory; ask for fewer or larger cells\n");
    return sunder::kExitInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sunder: internal error: %s\n", error.what());
    return sunder::kExitBug;
  }
}
