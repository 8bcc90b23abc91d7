// A scene that runs on a thread of its own, frame after frame, and is recorded.
#pragma once

#include "src/run/recording.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace tutu::app {

/// What it does depends on the scene, the start, and the order of restarts and jumps only, never on when anybody looks:
/// without a jump frame n has the bits of the n-th Session::advance(). Functions may be called from any one thread and
/// do not wait for a frame, but for wait_for.
class Simulation {
public:
  /// The scene must outlive it. The recording takes no more than `most_bytes`.
  Simulation(const Scene& scene, GarmentPositions start, std::size_t most_bytes);
  ~Simulation(); ///< ends with the frame at hand
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Simulates on until the frame of this index is there.
  void run_until(int index);
  /// The recording begins anew with that frame: 0 is the draped start; for any other the garments are carried along to
  /// the pose there (Session::jump).
  void jump(int index);

  struct Extent {
    int first = 0, last = -1; ///< recorded; last < first: none
    bool failed = false;      ///< nothing comes after last
    std::size_t bytes = 0;
    bool has(int index) const { return first <= index && index <= last; }
  };
  Extent extent() const;
  Recording::Frame frame(int index) const; ///< null when not recorded
  std::string message() const;             ///< "" or why it stopped
  void wait_for(int index) const;          ///< until it is recorded or the run has failed; run_until it before

private:
  void work();

  mutable std::mutex mutex_; ///< of all below it but the session, which is the thread's
  mutable std::condition_variable wake_, done_;
  Recording recording_;
  std::optional<int> jump_ = 0;
  int until_ = 0;
  bool stop_ = false, failed_ = false;
  std::string message_;

  GarmentPositions start_;
  Session session_;
  std::thread thread_; ///< last: it uses all others
};

} // namespace tutu::app
