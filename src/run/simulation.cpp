#include "src/run/simulation.h"

#include <utility>

namespace tutu::app {

Simulation::Simulation(const Scene& scene, GarmentPositions start, std::size_t most_bytes)
    : recording_(most_bytes), start_(std::move(start)), session_(scene), thread_([this] { work(); }) {}

Simulation::~Simulation() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void Simulation::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [&] { return stop_ || jump_ || (!failed_ && !recording_.empty() && recording_.last() < until_); });
    if (stop_) return;
    const std::optional<int> jump = std::exchange(jump_, std::nullopt);
    lock.unlock();
    if (jump && *jump == 0) session_.start(start_);
    else if (jump) session_.jump(*jump * session_.frame_seconds());
    else session_.advance();
    const bool held = !session_.failure();
    auto state = std::make_shared<FrameState>();
    if (held) capture(session_, *state);
    lock.lock();
    if (jump_) continue; // somebody wants to be elsewhere by now
    failed_ = !held;
    message_ = held ? "" : session_.failure()->message();
    if (held) recording_.add(std::move(state));
    done_.notify_all();
  }
}

void Simulation::run_until(int index) {
  {
    const std::lock_guard lock(mutex_);
    until_ = index;
  }
  wake_.notify_all();
}

void Simulation::jump(int index) {
  {
    const std::lock_guard lock(mutex_);
    jump_ = until_ = index;
    recording_.clear();
    failed_ = false;
    message_.clear();
  }
  wake_.notify_all();
}

Simulation::Extent Simulation::extent() const {
  const std::lock_guard lock(mutex_);
  if (recording_.empty()) return {};
  return {recording_.first(), recording_.last(), failed_, recording_.bytes()};
}

Recording::Frame Simulation::frame(int index) const {
  const std::lock_guard lock(mutex_);
  return recording_.at(index);
}

std::string Simulation::message() const {
  const std::lock_guard lock(mutex_);
  return message_;
}

void Simulation::wait_for(int index) const {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return failed_ || (!recording_.empty() && recording_.last() >= index); });
}

} // namespace tutu::app
