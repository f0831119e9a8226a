// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the project's own models. Usage: make_models data/models
#include <fstream>
#include <string>

#include "models/sample_models.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto write = [&](const char* name, const std::string& bytes) {
    std::ofstream(std::string(argv[1]) + "/" + name, std::ios::binary) << bytes;
  };
  write("vase.obj", sunder::vase_model().bytes);
  write("gear.stl", sunder::gear_model().bytes);
  write("scan.ply", sunder::scan_model().bytes);
}
