#include "src/measure/validation.h"

#include "rig/body_regions.h"
#include "rig/error.h"
#include "src/base/workers.h"
#include "src/run/garment_pins.h"
#include "src/run/posed_body.h"
#include "src/run/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>

namespace tutu::app {
namespace {

constexpr int k_frames_a_thread = 4;      // measured before the figures are gathered: bounds what waits in memory
constexpr int k_volume_points = 65'536;   // in all: 0.3 % of a body's volume
constexpr int k_least_volume_points = 64; // a frame
constexpr std::size_t k_worst_frames = 3;
constexpr double k_apart = 0.5; // s between worst frames: two of one moment show the same

bool is_core(rig::BodyRegion region) {
  return region != rig::BodyRegion::head && region != rig::BodyRegion::hands && region != rig::BodyRegion::feet;
}

/// Everything of a sample that no pose changes, as indices into groups.
struct SkinGroups {
  std::vector<int> joint, region; ///< [sample]
};

/// What one frame yields before it is gathered.
struct FrameMeasure {
  proxies::FrameErrors errors;
  proxies::VolumeCount volume;
  ClothDepths cloth;
  ClothCrossings<proxies::SurfaceCrossings> crossings;
};

/// What a thread needs of its own.
struct ThreadState {
  explicit ThreadState(const Scene& scene)
      : posed(scene), body(body_of(scene.character)), skin(skin_surface(body)), reach(scene) {
    for (const cloth::Garment& garment : scene.garments) garments.emplace_back(garment);
  }

  PosedBody posed;
  proxies::BodyMesh body;
  proxies::CrossingSurface skin;
  std::vector<GarmentSurface> garments;
  WearerReach reach;
};

/// As many states as threads work at once, made when first asked for.
class ThreadStates {
public:
  explicit ThreadStates(const Scene& scene) : scene_(&scene) {}

  std::unique_ptr<ThreadState> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<ThreadState> state = std::move(idle_.back());
        idle_.pop_back();
        return state;
      }
    }
    return std::make_unique<ThreadState>(*scene_);
  }
  void give_back(std::unique_ptr<ThreadState> state) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(state));
  }

private:
  const Scene* scene_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<ThreadState>> idle_;
};

/// Under and over of one group.
struct PairGatherer {
  proxies::ErrorGatherer under, over;

  ErrorPair figures() const { return {under.figures(), over.figures()}; }
};

struct WholeGatherer {
  PairGatherer pair;
  proxies::BoundedMax under, over;
  double covered = 0.0;

  void add_bounds(const proxies::BoundedMax& u, const proxies::BoundedMax& o) {
    under = {std::max(under.value, u.value), std::max(under.bound, u.bound)};
    over = {std::max(over.value, o.value), std::max(over.bound, o.bound)};
  }
  void add_skin(double distance, double area, double tolerance) {
    pair.under.add(std::max(0.0, distance), area);
    if (distance <= tolerance) covered += area;
  }
  WholeErrors result(double skin_area) const {
    WholeErrors errors{pair.figures(), under, over, 0.0, 0.0};
    if (pair.under.weight() > 0.0) errors.coverage = covered / pair.under.weight();
    if (skin_area > 0.0) errors.skin_share = pair.under.weight() / skin_area;
    return errors;
  }
};

/// Where simulated garments were in each measured frame.
struct ClothRun {
  std::vector<GarmentPositions> positions; ///< [measured frame][garment]
  std::optional<std::string> failure;
};

class Validator {
public:
  Validator(const Scene& scene, const ValidationOptions& options)
      : scene_(&scene), options_(options), first_body_(body_of(scene.character)),
        regions_(rig::body_regions(scene.character.skeleton)) {
    const std::vector<char> outer = proxies::outer_triangles(first_body_);
    samples_ =
        proxies::sample_skin(scene.character.mesh.positions, scene.character.mesh.triangles, options.samples, outer);
    result_.options = options;
    result_.census = first_body_.census();
    if (scene.character.skin.method == rig::Skinning::dual_quaternion) result_.skinning = "dual quaternion skinning";
    if (scene.character.skin.method == rig::Skinning::centres_of_rotation)
      result_.skinning = "skinning about centres of rotation";
    result_.skin_samples = static_cast<int>(samples_.size());
    result_.buried_share = 1.0 - samples_.area / result_.census.area;
    effort_.surface_samples = std::max(100, options.samples / 5);
    for (const auto& sample : samples_.samples) {
      const int joint =
          rig::main_joint(scene.character.skin, scene.character.mesh.triangles[sample.triangle], sample.weights);
      groups_.joint.push_back(joint);
      groups_.region.push_back(static_cast<int>(regions_[joint]));
    }
    for (int f = 0, last = frames_of(scene); f < last; f += options.every) frames_.push_back(f);
  }

  Validation run(const std::optional<GarmentPositions>& cloth_start, const std::function<bool(int, int)>& progress) {
    const auto start = std::chrono::steady_clock::now();
    if (cloth_start && !scene_->garments.empty()) simulate(*cloth_start, progress);
    if (!result_.stopped) measure(progress);
    finish();
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(result_);
  }

private:
  double time_of(int frame) const { return frame / static_cast<double>(scene_->settings.frames_per_second); }

  void simulate(const GarmentPositions& start, const std::function<bool(int, int)>& progress) {
    Session session(*scene_);
    session.start(start);
    const int total = static_cast<int>(frames_.size());
    constexpr int k_ask = 16; // frames between questions: a frame takes less than a millisecond
    for (const int frame : frames_) {
      while (session.frame() < frame && !session.failure()) session.advance();
      if (session.failure()) {
        cloth_.failure = session.failure()->message();
        return;
      }
      auto& positions = cloth_.positions.emplace_back();
      for (std::size_t g = 0; g < scene_->garments.size(); ++g)
        positions.push_back(session.garment(static_cast<int>(g)).particles().positions);
      if (frame % k_ask == 0 && !progress(0, total)) {
        result_.stopped = true;
        return;
      }
    }
  }

  void measure(const std::function<bool(int, int)>& progress) {
    Workers workers(options_.threads);
    ThreadStates states(*scene_);
    for (const cloth::Garment& garment : scene_->garments) probes_.emplace_back(garment);
    const PosedBody rest(*scene_);
    const std::size_t colliders = rest.colliders().size(), joints = regions_.size();
    by_proxy_.resize(colliders);
    by_joint_.resize(joints);
    by_region_.resize(rig::k_region_names.size());
    for (const proxies::Proxy& proxy : rest.proxies()) proxy_joint_.push_back(main_joint_of(proxy));

    const std::size_t batch = static_cast<std::size_t>(options_.threads) * k_frames_a_thread;
    std::vector<FrameMeasure> measures(std::min(batch, frames_.size()));
    const int total = static_cast<int>(frames_.size());
    for (std::size_t first = 0; first < frames_.size(); first += batch) {
      const std::size_t count = std::min(batch, frames_.size() - first);
      workers.for_each(count, [&](std::size_t k) {
        std::unique_ptr<ThreadState> state = states.take();
        measure_one(first + k, *state, measures[k]);
        states.give_back(std::move(state));
      });
      for (std::size_t k = 0; k < count; ++k) gather(first + k, measures[k]);
      if (!progress(static_cast<int>(first + count), total)) {
        result_.stopped = first + count < frames_.size();
        if (result_.stopped) return;
      }
    }
  }

  void measure_one(std::size_t index, ThreadState& state, FrameMeasure& measure) const {
    state.posed.pose_at(time_of(frames_[index]));
    state.body.pose(state.posed.positions());
    const auto balls = state.reach.balls(state.posed.world_from_joint());
    const bool everything = state.reach.everything() || scene_->garments.empty();
    proxies::measure_frame(state.body, samples_, state.posed.colliders(), balls, everything, effort_, measure.errors);
    const int points =
        std::max(k_least_volume_points, static_cast<int>(k_volume_points / static_cast<int>(frames_.size())));
    measure.volume =
        proxies::count_volume(state.body, state.posed.colliders(), static_cast<std::int64_t>(index) * points, points);
    measure.cloth.clear();
    if (index >= cloth_.positions.size()) return;
    for (std::size_t g = 0; g < probes_.size(); ++g)
      probes_[g].measure(state.body, cloth_.positions[index][g], measure.cloth);
    count_crossings(cloth_.positions[index], state, measure.crossings);
  }

  static void count_crossings(const GarmentPositions& positions, ThreadState& state,
                              ClothCrossings<proxies::SurfaceCrossings>& found) {
    state.skin.move(state.body.positions());
    found = {};
    for (std::size_t g = 0; g < positions.size(); ++g) {
      GarmentSurface& garment = state.garments[g];
      garment.move(positions[g]);
      found.garments.push_back({proxies::crossings_between(garment.surface(), state.skin),
                                garment.with(state.posed.colliders()), garment.with_itself()});
      for (std::size_t other = 0; other < g; ++other)
        found.each_other.add(proxies::crossings_between(state.garments[other].surface(), garment.surface()));
    }
  }

  /// In the order of the frames, whatever thread measured them: sums keep their bits.
  void gather(std::size_t index, const FrameMeasure& measure) {
    const proxies::FrameErrors& errors = measure.errors;
    WholeGatherer frame;
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const double area = samples_.samples[s].area, distance = errors.skin[s], under = std::max(0.0, distance);
      whole_.add_skin(distance, area, options_.tolerance);
      frame.add_skin(distance, area, options_.tolerance);
      if (errors.skin_in_reach[s]) reached_.add_skin(distance, area, options_.tolerance);
      by_proxy_[errors.nearest[s]].under.add(under, area);
      by_joint_[groups_.joint[s]].under.add(under, area);
      by_region_[groups_.region[s]].under.add(under, area);
      if (is_core(regions_[groups_.joint[s]])) core_.under.add(under, area);
    }
    for (const proxies::SurfaceError& e : errors.surface) {
      const double over = std::max(0.0, e.distance);
      const int joint = proxy_joint_[e.collider];
      whole_.pair.over.add(over, e.area);
      frame.pair.over.add(over, e.area);
      if (e.in_reach) reached_.pair.over.add(over, e.area);
      by_proxy_[e.collider].over.add(over, e.area);
      by_joint_[joint].over.add(over, e.area);
      by_region_[static_cast<int>(regions_[joint])].over.add(over, e.area);
      if (is_core(regions_[joint])) core_.over.add(over, e.area);
    }
    whole_.add_bounds(errors.under, errors.over);
    reached_.add_bounds(errors.under_in_reach, errors.over_in_reach);
    gather_volume(measure.volume);

    FrameReport report;
    report.frame = frames_[index];
    report.time = time_of(report.frame);
    report.figures = frame.pair.figures();
    report.under = errors.under;
    report.over = errors.over;
    report.coverage = frame.result(0.0).coverage;
    report.collisions = errors.collisions;
    report.inside = errors.inside;
    if (index < cloth_.positions.size()) {
      report.cloth = measure.cloth;
      report.cloth->particle_depths = {};
      report.crossings = measure.crossings;
      for (const double depth : measure.cloth.particle_depths) particle_depths_.add(depth, 1.0);
    }
    result_.frames.push_back(std::move(report));
  }

  void gather_volume(const proxies::VolumeCount& count) {
    const double each = count.box / static_cast<double>(count.points);
    result_.body_volume += each * static_cast<double>(count.body);
    result_.proxies_volume += each * static_cast<double>(count.proxies);
    result_.only_body_volume += each * static_cast<double>(count.body - count.both);
    result_.only_proxies_volume += each * static_cast<double>(count.proxies - count.both);
  }

  void finish() {
    const auto frames = static_cast<double>(std::max<std::size_t>(1, result_.frames.size()));
    const double area = samples_.area * frames;
    result_.whole = whole_.result(area);
    if (!scene_->garments.empty()) result_.in_reach = reached_.result(area);
    for (double* volume :
         {&result_.body_volume, &result_.proxies_volume, &result_.only_body_volume, &result_.only_proxies_volume})
      *volume /= frames;

    const rig::Skeleton& skeleton = scene_->character.skeleton;
    const auto group = [&](const PairGatherer& g, std::string name, std::string joint) {
      return GroupErrors{std::move(name), std::move(joint), g.figures(), g.under.weight() / area};
    };
    result_.core = group(core_, "all but head, hands, feet", "");
    std::size_t collider = 0;
    for (const proxies::Proxy& proxy : scene_->proxies) {
      if (!proxy.enabled || collider >= by_proxy_.size()) continue;
      result_.proxies.push_back(group(by_proxy_[collider], proxy.name, skeleton.names[proxy_joint_[collider]]));
      ++collider;
    }
    for (std::size_t j = 0; j < by_joint_.size(); ++j)
      if (by_joint_[j].under.weight() > 0.0 || by_joint_[j].over.weight() > 0.0)
        result_.joints.push_back(group(by_joint_[j], skeleton.names[j], ""));
    for (std::size_t r = 0; r < by_region_.size(); ++r)
      if (by_region_[r].under.weight() > 0.0 || by_region_[r].over.weight() > 0.0)
        result_.regions.push_back(group(by_region_[r], std::string(rig::k_region_names[r]), ""));

    result_.worst_frames = worst([](const FrameReport& f) { return badness(f); });
    if (cloth_.failure) result_.cloth_failure = cloth_.failure;
    if (!cloth_.positions.empty()) finish_cloth();
  }

  void finish_cloth() {
    ClothReport report;
    report.crossings.garments.resize(scene_->garments.size());
    for (const FrameReport& frame : result_.frames) {
      if (!frame.cloth) continue;
      for (std::size_t g = 0; g < scene_->garments.size(); ++g) {
        report.crossings.garments[g].body.add(frame.frame, frame.crossings.garments[g].body);
        report.crossings.garments[g].proxies.add(frame.frame, frame.crossings.garments[g].proxies);
        report.crossings.garments[g].itself.add(frame.frame, frame.crossings.garments[g].itself);
      }
      report.crossings.each_other.add(frame.frame, frame.crossings.each_other);
      report.particles.add(frame.cloth->particles);
      report.edges.add(frame.cloth->edges);
      report.triangles.add(frame.cloth->triangles);
      report.surface = std::max(report.surface, frame.cloth->surface);
    }
    report.particles_p99 = particle_depths_.figures().p99;
    report.worst_frames = worst([](const FrameReport& f) { return f.cloth ? f.cloth->surface : 0.0; });
    report.end = cloth_end();
    result_.cloth = std::move(report);
  }

  RunEnd cloth_end() {
    const std::size_t last = cloth_.positions.size() - 1;
    ThreadState state(*scene_);
    state.posed.pose_at(time_of(frames_[last]));
    state.body.pose(state.posed.positions());
    RunEnd end;
    for (std::size_t g = 0; g < probes_.size(); ++g) {
      const std::vector<Vec3>& positions = cloth_.positions[last][g];
      ClothDepths depths;
      probes_[g].measure(state.body, positions, depths);
      const cloth::LongestThread longest = cloth::longest_thread(probes_[g].parts(), positions);
      end.garments.push_back(
          {scene_->garments[g].name,
           longest,
           {},
           deepest_of(depths),
           place_among(cloth::middle_of(longest, positions), state.posed.colliders(), state.posed.proxies())});
    }
    return end;
  }

  /// The first k_worst_frames by `score`, each k_apart from those before; none without a score.
  std::vector<int> worst(const std::function<double(const FrameReport&)>& score) const {
    std::vector<int> order(result_.frames.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int x, int y) { return score(result_.frames[x]) > score(result_.frames[y]); });
    std::vector<int> chosen;
    for (const int candidate : order) {
      if (chosen.size() == k_worst_frames || !(score(result_.frames[candidate]) > 0.0)) break;
      const double time = result_.frames[candidate].time;
      if (std::all_of(chosen.begin(), chosen.end(),
                      [&](int c) { return std::abs(result_.frames[c].time - time) >= k_apart; }))
        chosen.push_back(candidate);
    }
    return chosen;
  }

  static int main_joint_of(const proxies::Proxy& proxy) {
    const proxies::Anchor& anchor = proxy.a;
    const auto first = anchor.weights.begin(), last = first + anchor.count;
    return anchor.joints[static_cast<std::size_t>(std::max_element(first, last) - first)];
  }

  const Scene* scene_;
  ValidationOptions options_;
  proxies::BodyMesh first_body_;         ///< in its bind pose
  std::vector<rig::BodyRegion> regions_; ///< [joint]
  proxies::SkinSamples samples_;
  proxies::ValidationEffort effort_;
  SkinGroups groups_;
  std::vector<int> frames_; ///< measured
  std::vector<int> proxy_joint_;
  std::vector<ClothProbe> probes_;
  ClothRun cloth_;
  WholeGatherer whole_, reached_;
  PairGatherer core_;
  std::vector<PairGatherer> by_proxy_, by_joint_, by_region_;
  proxies::ErrorGatherer particle_depths_;
  Validation result_;
};

} // namespace

int frames_to_measure(const Scene& scene, int every) { return (frames_of(scene) + every - 1) / every; }

double badness(const FrameReport& frame) { return std::max(frame.figures.under.p95, frame.figures.over.p95); }

Validation validate(const Scene& scene, const ValidationOptions& options,
                    const std::optional<GarmentPositions>& cloth_start, const std::function<bool(int, int)>& progress) {
  const auto enabled = [](const proxies::Proxy& proxy) { return proxy.enabled; };
  if (std::none_of(scene.proxies.begin(), scene.proxies.end(), enabled))
    throw InputError(scene.file, "/proxies", "none", "proxies to validate");
  return Validator(scene, options).run(cloth_start, progress);
}

} // namespace tutu::app
