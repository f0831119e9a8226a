// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "io/output.hpp"
#include "io/text_writer.hpp"

namespace sunder {

/// Writes to a file on a thread of its own, so that making the bytes and handing them to the kernel
/// (half the time of a large export) overlap. Spans below kBlock are copied, larger ones must stay
/// as they are until finish(). The first kAtOnce bytes are written at once: a small file is not
/// worth a thread. At most kQueue blocks wait.
class BackgroundSink : public ByteSink {
 public:
  explicit BackgroundSink(OutputFile& file) : file_(file) {}
  ~BackgroundSink() override;
  void write(std::span<const std::byte> bytes) override;
  void rewrite_front(std::span<const std::byte> bytes) override;
  /// All bytes are in the file; throws what writing them threw.
  void finish();

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 20;
  static constexpr std::size_t kAtOnce = std::size_t{8} << 20;
  static constexpr std::size_t kQueue = 16;
  struct Block {
    std::vector<std::byte> owned;
    std::span<const std::byte> borrowed;
  };
  void enqueue(Block block);
  void enqueue_pending();
  void run();
  void stop() noexcept;

  OutputFile& file_;
  std::vector<std::byte> pending_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Block> queue_;
  bool closing_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace sunder
