#include "src/study/report/validation_json.h"

#include "rig/body_regions.h"
#include "src/measure/uneven_json.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>

namespace tutu::app {
namespace {

using nlohmann::ordered_json;

double mm(double metres) { return 1000.0 * metres; }

ordered_json json_of(const proxies::ErrorFigures& f) {
  return {{"mean", mm(f.mean)}, {"rms", mm(f.rms)}, {"p95", mm(f.p95)}, {"p99", mm(f.p99)}, {"max", mm(f.max)}};
}

/// `max` is of samples and of what the search for the bound found.
ordered_json json_of(const proxies::ErrorFigures& f, const proxies::BoundedMax& most) {
  ordered_json json = json_of(f);
  json["max"] = mm(std::max(f.max, most.value));
  json["bound"] = mm(most.bound);
  return json;
}

ordered_json json_of(const DepthCount& count) {
  return {{"asked", count.asked},
          {"inside", count.inside},
          {"share", count.asked > 0 ? static_cast<double>(count.inside) / static_cast<double>(count.asked) : 0.0},
          {"max_mm", mm(count.deepest)}};
}

ordered_json json_of(const proxies::SurfaceCrossings& count) {
  return {{"crossings", count.crossings}, {"placed", count.placed}};
}

ordered_json json_of(const CrossingTally& tally) {
  return {{"frames", tally.frames},
          {"worst", tally.worst},
          {"worst_frame", tally.worst_frame >= 0 ? ordered_json(tally.worst_frame) : ordered_json(nullptr)},
          {"total", tally.total},
          {"placed", tally.placed}};
}

template <class Count>
ordered_json crossings_json(const ClothCrossings<Count>& crossings, const std::vector<cloth::Garment>& garments) {
  ordered_json json = {{"garments", ordered_json::array()}, {"each_other", json_of(crossings.each_other)}};
  for (std::size_t g = 0; g < garments.size(); ++g) {
    const auto& of = crossings.garments[g];
    json["garments"].push_back({{"name", garments[g].name},
                                {"body", json_of(of.body)},
                                {"proxies", json_of(of.proxies)},
                                {"itself", json_of(of.itself)}});
  }
  return json;
}

ordered_json json_of(const GroupErrors& group) {
  ordered_json json = {{"name", group.name}};
  if (!group.joint.empty()) json["joint"] = group.joint;
  json["under_mm"] = json_of(group.figures.under);
  json["over_mm"] = json_of(group.figures.over);
  json["skin_share"] = group.skin_share;
  return json;
}

ordered_json json_of(const WholeErrors& whole) {
  return {{"under_mm", json_of(whole.figures.under, whole.under)},
          {"over_mm", json_of(whole.figures.over, whole.over)},
          {"coverage", whole.coverage},
          {"skin_share", whole.skin_share}};
}

ordered_json groups_json(const std::vector<GroupErrors>& groups) {
  ordered_json json = ordered_json::array();
  for (const int g : worst_first(groups)) json.push_back(json_of(groups[g]));
  return json;
}

ordered_json census_json(const proxies::MeshCensus& census, double buried_share) {
  return {{"vertices", census.vertices},
          {"triangles", census.triangles},
          {"shells", census.shells},
          {"open_edges", census.open_edges},
          {"nonmanifold_edges", census.nonmanifold_edges},
          {"mended_triangles", census.mended_triangles},
          {"side_rule", census.rule == proxies::SideRule::pseudonormal ? "pseudonormal" : "winding number"},
          {"reason", census.reason},
          {"buried_share", buried_share}};
}

ordered_json frame_json(const FrameReport& frame, const Validation& validation, const Scene& scene) {
  ordered_json json = {
      {"frame", frame.frame},
      {"time", frame.time},
      {"under_mm",
       {{"p95", mm(frame.figures.under.p95)}, {"max", mm(frame.under.value)}, {"bound", mm(frame.under.bound)}}},
      {"over_mm",
       {{"p95", mm(frame.figures.over.p95)}, {"max", mm(frame.over.value)}, {"bound", mm(frame.over.bound)}}},
      {"coverage", frame.coverage}};
  const auto names = [&](const std::vector<int>& colliders) {
    ordered_json list = ordered_json::array();
    for (const int c : colliders) list.push_back(validation.proxies[c].name);
    return list;
  };
  json["collisions"] = names(frame.collisions);
  json["wholly_inside"] = names(frame.inside);
  if (frame.cloth) {
    json["cloth_in_body"] = {{"particles", json_of(frame.cloth->particles)},
                             {"edges", json_of(frame.cloth->edges)},
                             {"triangles", json_of(frame.cloth->triangles)},
                             {"surface_max_mm", mm(frame.cloth->surface)}};
    json["crossings"] = crossings_json(frame.crossings, scene.garments);
  }
  return json;
}

std::string figures_text(const proxies::ErrorFigures& f) {
  return fmt::format("{:7.2f} {:7.2f} {:7.2f} {:7.2f} {:7.2f}", mm(f.mean), mm(f.rms), mm(f.p95), mm(f.p99), mm(f.max));
}

std::string whole_text(const char* name, const WholeErrors& whole, double tolerance) {
  const auto line = [&](const char* side, const proxies::ErrorFigures& figures, const proxies::BoundedMax& most) {
    proxies::ErrorFigures f = figures;
    f.max = std::max(f.max, most.value);
    return fmt::format("{:<24} {}  {:7.2f}\n", fmt::format("{}, {}", name, side), figures_text(f), mm(most.bound));
  };
  return line("under", whole.figures.under, whole.under) + line("over", whole.figures.over, whole.over) +
         fmt::format("{:<24} {:.2f} % of the skin sticks out by no more than {:g} mm\n", "", 100.0 * whole.coverage,
                     mm(tolerance));
}

std::string groups_text(const char* title, const std::vector<GroupErrors>& groups, std::size_t most) {
  std::string text =
      fmt::format("{:<24} {:>7} {:>7} {:>7}   {:>7} {:>7} {:>7}\n", title, "under", "p95", "max", "over", "p95", "max");
  const std::vector<int> order = worst_first(groups);
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k) {
    const GroupErrors& g = groups[order[k]];
    const proxies::ErrorFigures &u = g.figures.under, &o = g.figures.over;
    text += fmt::format("  {:<22} {:7.2f} {:7.2f} {:7.2f}   {:7.2f} {:7.2f} {:7.2f}\n", g.name, mm(u.mean), mm(u.p95),
                        mm(u.max), mm(o.mean), mm(o.p95), mm(o.max));
  }
  if (order.size() > most) text += fmt::format("  and {} more\n", order.size() - most);
  return text;
}

std::string cloth_text(const Validation& validation) {
  const ClothReport& cloth = *validation.cloth;
  const auto share = [](const DepthCount& c) {
    return c.asked > 0 ? 100.0 * static_cast<double>(c.inside) / static_cast<double>(c.asked) : 0.0;
  };
  std::string text =
      fmt::format("cloth in the true body: particles {:.3f} % inside, {:.2f} mm at most, {:.2f} p99; "
                  "edges (middle) {:.3f} %, {:.2f} "
                  "mm; triangles (centroid) {:.3f} %, {:.2f} mm; surface {:.2f} mm\n",
                  share(cloth.particles), mm(cloth.particles.deepest), mm(cloth.particles_p99), share(cloth.edges),
                  mm(cloth.edges.deepest), share(cloth.triangles), mm(cloth.triangles.deepest), mm(cloth.surface));
  if (!cloth.worst_frames.empty()) {
    text += "  deepest in frames";
    for (const int f : cloth.worst_frames)
      text += fmt::format("  {} ({:.2f} mm)", validation.frames[f].frame, mm(validation.frames[f].cloth->surface));
    text += "\n";
  }
  return text;
}

std::string crossings_text(const Validation& validation, const Scene& scene) {
  std::string text = fmt::format("{:<32} {:>7} {:>7} {:>7} {:>7} {:>7}\n", "cloth goes through (exact)", "frames",
                                 "worst", "frame", "total", "placed");
  for (const auto& [what, tally] : crossing_lines(validation, scene))
    text += fmt::format("  {:<30} {:>7} {:>7} {:>7} {:>7} {:>7}\n", what, tally->frames, tally->worst,
                        tally->worst_frame >= 0 ? std::to_string(tally->worst_frame) : "", tally->total, tally->placed);
  return text;
}

} // namespace

std::vector<CrossingLine> crossing_lines(const Validation& validation, const Scene& scene) {
  std::vector<CrossingLine> lines;
  const auto& crossings = validation.cloth->crossings;
  for (std::size_t g = 0; g < scene.garments.size(); ++g) {
    const std::string& name = scene.garments[g].name;
    lines.push_back({name + ", the body", &crossings.garments[g].body});
    lines.push_back({name + ", proxies", &crossings.garments[g].proxies});
    lines.push_back({name + ", itself", &crossings.garments[g].itself});
  }
  if (scene.garments.size() > 1) lines.push_back({"garments, each other", &crossings.each_other});
  return lines;
}

std::string Verdict::text() const {
  const char* what = judge == Judge::max ? "the bound" : judge == Judge::p99 ? "p99" : "p95";
  return fmt::format("tolerance of {:g} mm {}: {}{} is {:.2f} mm under, {:.2f} mm over", mm(tolerance),
                     met() ? "met" : "NOT met", what, in_reach ? " within reach of the garments" : "", mm(under),
                     mm(over));
}

Verdict judge(const Validation& validation, double tolerance, Judge judge, bool in_reach) {
  const WholeErrors& whole = in_reach && validation.in_reach ? *validation.in_reach : validation.whole;
  Verdict verdict{tolerance, judge, in_reach, 0.0, 0.0};
  const auto held = [&](const proxies::ErrorFigures& f, const proxies::BoundedMax& most) {
    return judge == Judge::max ? most.bound : judge == Judge::p99 ? f.p99 : f.p95;
  };
  verdict.under = held(whole.figures.under, whole.under);
  verdict.over = held(whole.figures.over, whole.over);
  return verdict;
}

std::vector<int> worst_first(const std::vector<GroupErrors>& groups) {
  std::vector<int> order(groups.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int g) {
    const ErrorPair& f = groups[g].figures;
    return std::pair(std::max(f.under.p95, f.over.p95), std::max(f.under.max, f.over.max));
  };
  std::stable_sort(order.begin(), order.end(), [&](int x, int y) { return key(x) > key(y); });
  return order;
}

std::vector<std::string> never_touching(const Validation& validation) {
  std::vector<bool> touches(validation.proxies.size(), false);
  for (const FrameReport& frame : validation.frames)
    for (const int c : frame.collisions) touches[c] = true;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < touches.size(); ++c)
    if (!touches[c]) names.push_back(validation.proxies[c].name);
  return names;
}

ordered_json validation_json(const Validation& validation, const Scene& scene, const std::optional<Verdict>& verdict) {
  ordered_json json = {{"scene", scene.name()},
                       {"frames", validation.frames.size()},
                       {"every", validation.options.every},
                       {"tolerance_mm", mm(validation.options.tolerance)}};
  if (verdict)
    json["verdict"] = {{"met", verdict->met()},
                       {"judged", k_judge_names[static_cast<std::size_t>(verdict->judge)]},
                       {"in_reach", verdict->in_reach},
                       {"under_mm", mm(verdict->under)},
                       {"over_mm", mm(verdict->over)}};
  const ordered_json whole = json_of(validation.whole);
  for (const auto& [key, value] : whole.items()) json[key] = value;
  json["hausdorff_mm"] = {{"value", mm(validation.hausdorff())}, {"bound", mm(validation.hausdorff_bound())}};
  json["volume_ratio"] = validation.volume_ratio();
  json["volume_l"] = {{"body", 1000.0 * validation.body_volume},
                      {"proxies", 1000.0 * validation.proxies_volume},
                      {"only_body", 1000.0 * validation.only_body_volume},
                      {"only_proxies", 1000.0 * validation.only_proxies_volume}};
  if (validation.in_reach) json["in_reach"] = json_of(*validation.in_reach);
  json["core"] = json_of(validation.core);
  json["proxies"] = groups_json(validation.proxies);
  json["joints"] = groups_json(validation.joints);
  json["regions"] = groups_json(validation.regions);
  json["worst_frames"] = ordered_json::array();
  for (const int f : validation.worst_frames) json["worst_frames"].push_back(validation.frames[f].frame);
  if (validation.cloth) {
    const ClothReport& cloth = *validation.cloth;
    json["cloth_in_body"] = {{"share", json_of(cloth.particles)["share"]},
                             {"max_mm", mm(cloth.particles.deepest)},
                             {"p99_mm", mm(cloth.particles_p99)},
                             {"particles", json_of(cloth.particles)},
                             {"edges", json_of(cloth.edges)},
                             {"triangles", json_of(cloth.triangles)},
                             {"surface_max_mm", mm(cloth.surface)},
                             {"end", cloth.end.json()}};
    json["cloth_in_body"].update(uneven_json(scene.settings));
    json["cloth_in_body"]["worst_frames"] = ordered_json::array();
    for (const int f : cloth.worst_frames) json["cloth_in_body"]["worst_frames"].push_back(validation.frames[f].frame);
  }
  if (validation.cloth) json["crossings"] = crossings_json(validation.cloth->crossings, scene.garments);
  if (validation.cloth_failure) json["cloth_failure"] = *validation.cloth_failure;
  json["body"] = census_json(validation.census, validation.buried_share);
  json["skinning"] = validation.skinning;
  json["skin_samples"] = validation.skin_samples;
  json["never_touching"] = never_touching(validation);
  json["seconds"] = validation.seconds;
  json["per_frame"] = ordered_json::array();
  for (const FrameReport& frame : validation.frames) json["per_frame"].push_back(frame_json(frame, validation, scene));
  return json;
}

std::string validation_text(const Validation& validation, const Scene& scene, const std::optional<Verdict>& verdict) {
  const proxies::MeshCensus& census = validation.census;
  std::string text = fmt::format(
      "{}: {} proxies against {} triangles ({}), {} frames{}, {} samples on the skin, {:.1f} s\n", scene.name(),
      validation.proxies.size(), census.triangles, validation.skinning, validation.frames.size(),
      validation.options.every > 1 ? fmt::format(", every {}th", validation.options.every) : "",
      validation.skin_samples, validation.seconds);
  text +=
      fmt::format("inside is told by {}: {}\n",
                  census.rule == proxies::SideRule::pseudonormal ? "pseudonormals" : "winding numbers", census.reason);
  if (validation.buried_share > 0.0005)
    text +=
        fmt::format("{:.1f} % of the mesh is inside the body at rest and left out\n", 100.0 * validation.buried_share);
  text +=
      fmt::format("\n{:<24} {:>7} {:>7} {:>7} {:>7} {:>7}  {:>7}\n", "mm", "mean", "rms", "p95", "p99", "max", "bound");
  text += whole_text("whole body", validation.whole, validation.options.tolerance);
  if (validation.in_reach) text += whole_text("within reach", *validation.in_reach, validation.options.tolerance);
  text += fmt::format("Hausdorff {:.2f} mm, at most {:.2f}   volume of the proxies {:.3f} of the body's ({:.2f} l)\n\n",
                      mm(validation.hausdorff()), mm(validation.hausdorff_bound()), validation.volume_ratio(),
                      1000.0 * validation.body_volume);
  constexpr std::size_t k_lines = 8;
  std::vector<GroupErrors> regions = validation.regions;
  regions.push_back(validation.core);
  text += groups_text("regions", regions, regions.size());
  text += groups_text("worst proxies", validation.proxies, k_lines);
  text += groups_text("worst joints", validation.joints, k_lines);
  if (!validation.worst_frames.empty()) {
    text += "worst frames";
    for (const int f : validation.worst_frames)
      text += fmt::format("  {} (p95 {:.1f} under, {:.1f} over)", validation.frames[f].frame,
                          mm(validation.frames[f].figures.under.p95), mm(validation.frames[f].figures.over.p95));
    text += "\n";
  }
  std::size_t collisions = 0;
  for (const FrameReport& frame : validation.frames) collisions += frame.collisions.size();
  text += fmt::format(
      "{} of {} proxies meet the mesh in a frame, on average",
      validation.frames.empty()
          ? 0.0
          : std::round(10.0 * static_cast<double>(collisions) / static_cast<double>(validation.frames.size())) / 10.0,
      validation.proxies.size());
  const std::vector<std::string> never = never_touching(validation);
  text += never.empty() ? "\n" : fmt::format("; never: {}\n", fmt::join(never, ", "));
  if (validation.cloth) text += cloth_text(validation) + crossings_text(validation, scene);
  if (verdict) text += verdict->text() + "\n";
  return text;
}

} // namespace tutu::app
