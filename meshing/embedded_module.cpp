// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/embedded_module.hpp"

#include <dlfcn.h>
#include <sys/mman.h>
#include <unistd.h>

namespace sunder {
namespace {

[[noreturn]] void fail(const EmbeddedModule& module, const std::string& why) {
  throw Error(module.code, module.needs + ": " + why);
}

}  // namespace

const void* load_module(const EmbeddedModule& module) {
  const std::string symbol = "sunder_" + module.name + "_module";
  // It stays open: a later module must not get the same number, because the loader takes a path
  // that it has seen before for the same file.
  const int file = memfd_create(symbol.c_str(), MFD_CLOEXEC);
  if (file < 0) fail(module, "there is no memory file to load it from");
  for (std::string_view rest = module.file; !rest.empty();) {
    const ssize_t written = write(file, rest.data(), rest.size());
    if (written <= 0) fail(module, "the memory file to load it from could not be written");
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  void* const loaded = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) fail(module, dlerror());
  const void* const table = dlsym(loaded, symbol.c_str());
  if (table == nullptr) fail(module, "it has no " + symbol);
  return table;
}

}  // namespace sunder
