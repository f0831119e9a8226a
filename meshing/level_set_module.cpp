// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/level_set_module.hpp"

#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "meshing/error.hpp"

// The module's file is part of the library, so that there is no place where it must be found.
asm(R"(
  .section .rodata
  .global sunder_level_set_file, sunder_level_set_file_end
  .balign 16
sunder_level_set_file:
  .incbin ")" SUNDER_LEVEL_SET_FILE R"("
sunder_level_set_file_end:
  .byte 0
  .previous
)");
extern "C" const char sunder_level_set_file[], sunder_level_set_file_end[];

namespace sunder {
namespace {

[[noreturn]] void fail(const std::string& why) {
  throw Error(ErrorCode::input, "level sets need OpenVDB's library (libopenvdb 10): " + why);
}

const LevelSetModule* load() {
  const int file = memfd_create("sunder_level_set", MFD_CLOEXEC);
  if (file < 0) fail("there is no memory file to load it from");
  for (const char* at = sunder_level_set_file; at != sunder_level_set_file_end;) {
    const auto rest = static_cast<std::size_t>(sunder_level_set_file_end - at);
    const ssize_t written = write(file, at, rest);
    if (written <= 0) fail("the memory file to load it from could not be written");
    at += written;
  }
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) fail(dlerror());
  close(file);
  return static_cast<const LevelSetModule*>(dlsym(module, "sunder_level_set_module"));
}

}  // namespace

const LevelSetModule& level_set_module() {
  static const LevelSetModule* const module = load();
  return *module;
}

}  // namespace sunder
