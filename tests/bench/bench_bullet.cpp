// dancer-skirt on tutu and on Bullet, in one process, a frame of each in turn, with the ratio of their times.
//   bench_bullet [N ...]      particles a side; 30 and 64 when left out
#include "src/measure/frame_metrics.h"
#include "tests/bench/bullet_skirt.h"

#include <charconv>
#include <fmt/format.h>
#include <memory>
#include <string_view>

namespace {

using namespace tutu;

constexpr int k_first_measured = 60;

/// What holds the skirt, and for finer cloth also one substep a frame, which costs less and does not.
std::vector<bench::BulletSetup> bullet_setups(int n) {
  std::vector<bench::BulletSetup> setups = {{n, 5, 10, 0.02}};
  if (n > 30) setups.push_back({n, 1, 10, 0.05});
  return setups;
}

/// One program's frames.
class Watch {
public:
  template <class Skirt> void frame(Skirt& skirt, bool measured) {
    before_last_.swap(last_);
    last_ = skirt.particles().positions;
    skirt.advance();
    if (!measured) return;
    frames_.push_back(app::measure_frame(app::ClothProbe(skirt.skirt()), skirt.particles().positions, last_,
                                         before_last_, skirt.proxies(), 1.0 / app::k_dancer_frames_per_second));
    ms_.push_back(skirt.cpu_ms());
  }
  app::RunMetrics summary() const { return app::summarise(frames_, ms_); }

private:
  std::vector<Vec3> last_, before_last_;
  std::vector<app::FrameMetrics> frames_;
  std::vector<double> ms_;
};

void print_row(std::string_view program, std::string_view setting, int n, int substeps, const app::RunMetrics& m) {
  fmt::print("{:<8}{:>5}  {:<30}{:>9.3f}{:>9.3f}{:>8.0f}   "
             "{:>7.2f}/{:<7.2f}{:>7.2f}/{:<7.2f}{:>7.2f}/{:<7.2f}{:>8.1f}/{:<7.1f}\n",
             program, n, setting, m.ms_median, m.ms_p99, 1e6 * m.ms_median / (static_cast<double>(n) * n * substeps),
             1e3 * m.pen.max, 1e3 * m.pen.median, 1e3 * m.cen.max, 1e3 * m.cen.median, 1e3 * m.surface.max,
             1e3 * m.surface.median, 1e2 * m.longer.worst.max, 1e2 * m.longer.worst.median);
}

struct Other {
  bench::BulletSetup setup;
  std::unique_ptr<bench::BulletSkirt> skirt;
  Watch watch;
};

void compare(int n) {
  std::vector<Other> others;
  for (const bench::BulletSetup& setup : bullet_setups(n))
    others.push_back({setup, std::make_unique<bench::BulletSkirt>(setup), {}});
  app::DancerSkirtSetup our_setup;
  our_setup.n = n;
  our_setup.uneven_mm = 0.0; // as Bullet's starts
  our_setup.substeps = app::default_substeps(our_setup.solver, n);
  app::DancerSkirt ours(our_setup);
  Watch our_watch;
  for (int frame = 0; frame < app::k_dancer_frames; ++frame) { // in turn: all meet the same noise of the machine
    our_watch.frame(ours, frame >= k_first_measured);
    for (Other& other : others) other.watch.frame(*other.skirt, frame >= k_first_measured);
  }
  const app::RunMetrics our = our_watch.summary();
  print_row("tutu", fmt::format("{} substeps", our_setup.substeps), n, our_setup.substeps, our);
  for (const Other& other : others) {
    const bench::BulletSetup& s = other.setup;
    const app::RunMetrics their = other.watch.summary();
    print_row("Bullet", fmt::format("{} x {}, voxel {} m", s.substeps, s.iterations, s.voxel), n, s.substeps, their);
    fmt::print(
        "        ratio: {:.2f} times tutu's time, {:.1f} times its lengthening, {:.2f} mm of depth against {:.2f} mm\n",
        their.ms_median / our.ms_median, their.longer.worst.median / our.longer.worst.median, 1e3 * their.pen.max,
        1e3 * our.pen.max);
  }
  fmt::print("\n");
}

} // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes;
  for (int k = 1; k < argc; ++k) {
    const std::string_view text = argv[k];
    int n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || end != text.data() + text.size() || n < 8 || n > 512) {
      fmt::print(stderr, "bench_bullet: found {}, expected particles a side, 8 to 512\n", text);
      return 2;
    }
    sizes.push_back(n);
  }
  if (sizes.empty()) sizes = {30, 64};
  fmt::print("{:<8}{:>5}  {:<30}{:>9}{:>9}{:>8}   {:^15}{:^15}{:^15}{:^15}\n", "", "N", "setting", "ms", "p99",
             "ns/p/ss", "pen mm", "cen mm", "surf mm", "longer %");
  fmt::print("{:<70}   {:^15}{:^15}{:^15}{:^15}\n", "", "max/median", "max/median", "max/median", "max/median");
  for (const int n : sizes) compare(n);
  return 0;
}
