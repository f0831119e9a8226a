// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace sunder {

/// Calls work(begin, end) over [0, count) split into `threads` ranges of equal size, one thread
/// each (the caller's among them). The work writes results by index, so they do not depend on the
/// number of threads. The first range's exception is rethrown after all have ended.
template <class Work>
void for_each_range(std::size_t count, int threads, Work work) {
  const std::size_t parts = threads <= 1 || count < 2048 ? 1 : static_cast<std::size_t>(threads);
  if (parts == 1) return work(std::size_t{0}, count);
  std::vector<std::exception_ptr> errors(parts);
  const auto run = [&](std::size_t i) {
    try {
      work(count * i / parts, count * (i + 1) / parts);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> pool;
    for (std::size_t i = 1; i < parts; ++i) pool.emplace_back(run, i);
    run(0);
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace sunder
