// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace sunder {

/// What CalculiX prints (`job.dat`) for an input file. A run that fails leaves its folder.
inline std::string run_ccx(const std::string& input) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("sunder_ccx_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "job.inp") << input;
  const std::string command =
      "cd '" + folder.string() + "' && OMP_NUM_THREADS=1 '" SUNDER_CCX "' job > log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << "see " << folder / "log";
  std::ostringstream printed;
  printed << std::ifstream(folder / "job.dat").rdbuf();
  if (!testing::Test::HasFailure()) std::filesystem::remove_all(folder);
  return printed.str();
}

}  // namespace sunder
