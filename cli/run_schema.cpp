// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include "cli/command_table.hpp"
#include "cli/run.hpp"
#include "io/scene.hpp"

namespace sunder {

int run_schema(const Options& options) {
  const std::string text = options.schema == "parameters" ? parameters_markdown()
                           : options.schema == "man"      ? man_page(command_table())
                                                          : json_schema(options.schema);
  std::fputs(text.c_str(), stdout);
  return kExitOk;
}

}  // namespace sunder
