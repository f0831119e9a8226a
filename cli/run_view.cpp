// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <vector>

#include "cli/run.hpp"
#include "cli/usage.hpp"
#include "io/page.hpp"

namespace sunder {

int run_view(const Options& options) {
  std::vector<PageModel> models;
  for (const auto& path : options.inputs) {
    if (path.extension() != ".json") {
      models.push_back(read_page_model(path));
      continue;
    }
    if (models.empty() || !models.back().report.empty())
      usage(path.string() + ": a report belongs to the file before it, and there is " +
            (models.empty() ? "none" : "a report of that one already"));
    models.back().report = read_page_report(path);
  }
  for (const auto& path : options.outputs) {
    write_page(path, models);
    if (!options.quiet) std::fprintf(stderr, "wrote %s\n", path.c_str());
  }
  return kExitOk;
}

}  // namespace sunder
