// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace sunder {

/// A part of a page of docs/ while it lives: what is printed meanwhile stands between
/// `<!-- bench: NAME -->` and `<!-- end -->`, by which bench/into_docs.sh finds its place. NAME is
/// the program's, less "bench_", and one word more.
class Block {
 public:
  explicit Block(const std::string& name);
  ~Block();
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
};

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

/// Where results go, the folder docs/; empty: nowhere (the program was not run by `./dev bench`).
std::string results_folder();
/// "Intel Xeon …", of /proc/cpuinfo.
std::string processor();
/// "2026-11-23"
std::string today();
/// Of the sources, as `./dev bench` tells it; else "unknown".
std::string commit();

}  // namespace sunder
