// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/background_sink.hpp"

#include <utility>

namespace sunder {

BackgroundSink::~BackgroundSink() {
  stop();
}

void BackgroundSink::write(std::span<const std::byte> bytes) {
  if (!thread_.joinable() && file_.size() < kAtOnce) return file_.write(bytes);
  if (bytes.size() >= kBlock) {
    enqueue_pending();
    return enqueue({{}, bytes});
  }
  if (pending_.size() + bytes.size() > kBlock) enqueue_pending();
  pending_.reserve(kBlock);
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
}

void BackgroundSink::rewrite_front(std::span<const std::byte> bytes) {
  finish();
  file_.seek(0);
  file_.write(bytes);
  file_.seek(file_.size());
}

void BackgroundSink::finish() {
  if (thread_.joinable()) enqueue_pending();
  stop();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  file_.write(pending_);
  pending_.clear();
}

void BackgroundSink::enqueue_pending() {
  if (!pending_.empty()) enqueue({std::exchange(pending_, {}), {}});
}

void BackgroundSink::enqueue(Block block) {
  if (!thread_.joinable()) {
    closing_ = false;
    thread_ = std::thread([this] { run(); });
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return queue_.size() < kQueue || error_; });
  if (error_) return;  // finish() reports it
  queue_.push_back(std::move(block));
  changed_.notify_all();
}

void BackgroundSink::run() {
  for (;;) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !queue_.empty() || closing_; });
    if (queue_.empty()) return;
    const Block block = std::move(queue_.front());
    queue_.pop_front();
    changed_.notify_all();
    lock.unlock();
    try {
      file_.write(block.owned.empty() ? block.borrowed : std::span<const std::byte>(block.owned));
    } catch (...) {
      lock.lock();
      error_ = std::current_exception();
      queue_.clear();
      changed_.notify_all();
      return;
    }
  }
}

void BackgroundSink::stop() noexcept {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

}  // namespace sunder
