#include "src/study/report/validation_html.h"

#include "src/scene/load.h"
#include "src/study/report/html.h"
#include "src/study/report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {
namespace {

// Okabe and Ito 2008; the same two sides as in the heat maps.
constexpr const char *k_under = "#d55e00", *k_over = "#0072b2", *k_cloth = "#7a3b8f";

constexpr const char* k_style = R"(
main{max-width:62rem}
.met{border-color:#0072b2}.missed{border-color:#d55e00}
.tiles{display:grid;grid-template-columns:repeat(auto-fill,minmax(10.5rem,1fr));gap:.7rem;margin:1rem 0}
.tile{background:#fff;border-radius:.5rem;padding:.6rem .8rem;box-shadow:0 1px 3px #0002}
.tile b{display:block;font-size:1.45rem;line-height:1.2;font-variant-numeric:tabular-nums}
.tile span{font-size:.85rem;color:#59616e}
.under b{color:#b04d00}.over b{color:#00609a}.cloth b{color:#7a3b8f}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,26rem),1fr));gap:1rem}
figcaption{font-weight:600;font-size:.95rem;margin-bottom:.3rem}
svg .small{font-size:10px}
.mark{stroke:#8a919c;stroke-dasharray:1 3}.level{stroke:#20242c;stroke-dasharray:6 3}
.legend{font-size:.85rem;color:#3b424d}.legend span{white-space:nowrap;margin-right:1rem}
.legend i{display:inline-block;width:1.6rem;margin-right:.35rem;vertical-align:middle}
.maps{display:grid;grid-template-columns:1fr 1fr;gap:.5rem}
.maps img{width:100%;height:auto;border-radius:.3rem}
.worst{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,26rem),1fr));gap:1rem}
.name{text-align:left;color:#59616e}
thead th{color:#59616e;font-weight:600}
details{margin:.8rem 0}summary{cursor:pointer;font-weight:600}
@media print{.tile,figure,.scroll{box-shadow:none;border:1px solid #ddd}}
)";

double mm(double metres) { return 1000.0 * metres; }

std::string tile(const char* kind, const std::string& value, const std::string& what) {
  return fmt::format("<div class=\"tile {}\"><b>{}</b><span>{}</span></div>\n", kind, value, what);
}

std::string tiles(const Validation& v) {
  const WholeErrors& w = v.whole;
  std::string html = "<div class=\"tiles\">\n";
  html += tile("under", fmt::format("{:.1f} mm", mm(w.figures.under.p95)), "under, p95: the skin sticks out");
  html += tile("under", fmt::format("{:.1f} mm", mm(w.under.value)),
               fmt::format("under, greatest; no point more than {:.1f}", mm(w.under.bound)));
  html += tile("over", fmt::format("{:.1f} mm", mm(w.figures.over.p95)), "over, p95: the proxies stick out");
  html += tile("over", fmt::format("{:.1f} mm", mm(w.over.value)),
               fmt::format("over, greatest; no point more than {:.1f}", mm(w.over.bound)));
  html += tile("", fmt::format("{:.1f} %", 100.0 * w.coverage),
               fmt::format("of the skin out by {:g} mm or less", mm(v.options.tolerance)));
  html += tile("", fmt::format("{:.3f}", v.volume_ratio()),
               fmt::format("volume of the proxies to the body's {:.1f} l", 1000.0 * v.body_volume));
  if (v.cloth) {
    const DepthCount& p = v.cloth->particles;
    const double share = p.asked > 0 ? static_cast<double>(p.inside) / static_cast<double>(p.asked) : 0.0;
    html += tile("cloth", fmt::format("{:.3f} %", 100.0 * share), "of cloth particles inside the true body");
    html += tile("cloth", fmt::format("{:.1f} mm", mm(p.deepest)),
                 fmt::format("deepest particle; surface {:.1f} mm", mm(v.cloth->surface)));
  }
  return html + "</div>\n";
}

std::string plots(const Validation& v) {
  Plot under, over, cloth;
  const auto series = [&](const char* name, const char* colour, bool dashed, const auto& value) {
    PlotSeries s{name, colour, {}, dashed};
    for (const FrameReport& frame : v.frames) s.y.push_back(mm(value(frame)));
    return s;
  };
  for (Plot* plot : {&under, &over, &cloth}) {
    plot->x_name = "s";
    plot->y_name = "mm";
    for (const FrameReport& frame : v.frames) plot->x.push_back(frame.time);
  }
  for (const int f : v.worst_frames)
    for (Plot* plot : {&under, &over}) plot->marks.push_back({v.frames[f].time, std::to_string(v.frames[f].frame)});
  under.title = "Under: the skin sticks out of the proxies";
  under.series = {series("p95", k_under, false, [](const FrameReport& f) { return f.figures.under.p95; }),
                  series("greatest", k_under, true, [](const FrameReport& f) { return f.under.value; })};
  over.title = "Over: the proxies stick out of the skin";
  over.series = {series("p95", k_over, false, [](const FrameReport& f) { return f.figures.over.p95; }),
                 series("greatest", k_over, true, [](const FrameReport& f) { return f.over.value; })};
  for (Plot* plot : {&under, &over}) {
    plot->level = mm(v.options.tolerance);
    plot->level_name = fmt::format("{:g} mm", plot->level);
  }
  std::string html = "<div class=\"plots\">\n" + svg_of(under) + svg_of(over);
  if (v.cloth) {
    cloth.title = "Cloth inside the true body: the deepest";
    cloth.series = {
        series("particle", k_cloth, false,
               [](const FrameReport& f) { return f.cloth ? f.cloth->particles.deepest : 0.0; }),
        series("surface", k_cloth, true, [](const FrameReport& f) { return f.cloth ? f.cloth->surface : 0.0; })};
    for (const int f : v.cloth->worst_frames)
      cloth.marks.push_back({v.frames[f].time, std::to_string(v.frames[f].frame)});
    html += svg_of(cloth);
  }
  return html + "</div>\n";
}

std::string maps_html(const Validation& v, const std::vector<HeatMap>& maps, const std::string& no_maps) {
  std::string html =
      "<h2>The worst frames</h2>\n<p class=\"soft\">By the larger of the two p95. Orange to dark red: the "
      "skin sticks out of the proxies (under). Blue: it lies below their surface (over). White: within "
      "the tolerance.</p>\n";
  if (maps.empty()) return html + fmt::format("<p>No pictures: {}</p>\n", html_escaped(no_maps));
  html += "<div class=\"worst\">\n";
  for (const HeatMap& map : maps) {
    const auto frame =
        std::find_if(v.frames.begin(), v.frames.end(), [&](const FrameReport& f) { return f.frame == map.frame; });
    const auto image = [&](const std::string& png, const char* side) {
      return fmt::format("<img alt=\"frame {}, {}\" src=\"data:image/png;base64,{}\">", map.frame, side, base64(png));
    };
    html += fmt::format("<figure><figcaption>Frame {} ({:.2f} s): p95 {:.1f} under, {:.1f} over; front and "
                        "back</figcaption><div class=\"maps\">{}{}</div></figure>\n",
                        map.frame, frame->time, mm(frame->figures.under.p95), mm(frame->figures.over.p95),
                        image(map.front, "front"), image(map.back, "back"));
  }
  return html + "</div>\n";
}

/// A number with a bar behind it: `share` of the cell.
std::string bar_cell(double value, double most, const char* colour) {
  const double share = most > 0.0 ? std::clamp(100.0 * value / most, 0.0, 100.0) : 0.0;
  return fmt::format("<td style=\"background:linear-gradient(90deg,{0}33 {1:.0f}%,transparent {1:.0f}%)\">{2:.1f}</td>",
                     colour, share, mm(value));
}

std::string table(const char* first, const std::vector<GroupErrors>& groups, bool with_joint) {
  double most = 0.0; // of the p95: one scale for both sides
  for (const GroupErrors& g : groups) most = std::max({most, g.figures.under.p95, g.figures.over.p95});
  std::string html = fmt::format(
      "<div class=\"scroll\"><table><thead><tr><th>{}</th>{}<th>skin %</th><th>under mean</th><th>p95</th><th>max</th>"
      "<th>over mean</th><th>p95</th><th>max</th></tr></thead><tbody>\n",
      first, with_joint ? "<th class=\"name\">joint</th>" : "");
  for (const int k : worst_first(groups)) {
    const GroupErrors& g = groups[k];
    const auto side = [&](const proxies::ErrorFigures& f, const char* colour) {
      return fmt::format("<td>{:.1f}</td>{}<td>{:.1f}</td>", mm(f.mean), bar_cell(f.p95, most, colour), mm(f.max));
    };
    html += fmt::format("<tr><td>{}</td>{}<td>{:.1f}</td>{}{}</tr>\n", html_escaped(g.name),
                        with_joint ? "<td class=\"name\">" + html_escaped(g.joint) + "</td>" : "", 100.0 * g.skin_share,
                        side(g.figures.under, k_under), side(g.figures.over, k_over));
  }
  return html + "</tbody></table></div>\n";
}

std::string whole_table(const Validation& v) {
  std::string html = "<div class=\"scroll\"><table><thead><tr><th>mm</th><th>mean</th><th>RMS</th><th>p95</th>"
                     "<th>p99</th><th>max</th><th>bound</th></tr></thead><tbody>\n";
  const auto row = [&](const char* name, const proxies::ErrorFigures& f, const proxies::BoundedMax& most) {
    html +=
        fmt::format("<tr><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td>"
                    "<td>{:.2f}</td></tr>\n",
                    name, mm(f.mean), mm(f.rms), mm(f.p95), mm(f.p99), mm(std::max(f.max, most.value)), mm(most.bound));
  };
  row("under, whole body", v.whole.figures.under, v.whole.under);
  row("over, whole body", v.whole.figures.over, v.whole.over);
  if (v.in_reach) {
    row("under, within reach of the garments", v.in_reach->figures.under, v.in_reach->under);
    row("over, within reach of the garments", v.in_reach->figures.over, v.in_reach->over);
  }
  html += "</tbody></table></div>\n";
  if (v.in_reach)
    html +=
        fmt::format("<p class=\"soft\">The garments can reach {:.0f} % of the skin; {:.1f} % of that is out by {:g} "
                    "mm or less.</p>\n",
                    100.0 * v.in_reach->skin_share, 100.0 * v.in_reach->coverage, mm(v.options.tolerance));
  return html;
}

std::string cloth_table(const Validation& v) {
  const ClothReport& c = *v.cloth;
  std::string html = "<h2>Cloth in the true body</h2>\n<div class=\"scroll\"><table><thead><tr><th></th><th>asked</th>"
                     "<th>inside</th><th>share %</th><th>deepest mm</th></tr></thead><tbody>\n";
  const auto row = [&](const char* name, const DepthCount& d) {
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.3f}</td><td>{:.2f}</td></tr>\n", name, d.asked, d.inside,
        d.asked > 0 ? 100.0 * static_cast<double>(d.inside) / static_cast<double>(d.asked) : 0.0, mm(d.deepest));
  };
  row("particles", c.particles);
  row("edges, at their middle", c.edges);
  row("triangles, at their centroid", c.triangles);
  html += fmt::format(
      "</tbody></table></div>\n<p>Surface, the deepest of 28 points of each triangle: {:.2f} mm. p99 over particles: "
      "{:.2f} mm.</p>\n",
      mm(c.surface), mm(c.particles_p99));
  return html;
}

std::string crossings_table(const Validation& v, const Scene& scene) {
  std::string html =
      "<h2>What cloth goes through</h2>\n<p class=\"soft\">Curves along which its triangles cut others, by "
      "exact tests; those that touch cloth between pinned particles are counted apart, as placed.</p>\n"
      "<div class=\"scroll\"><table><thead><tr><th></th><th>frames with any</th><th>most in one</th>"
      "<th>in frame</th><th>over all frames</th><th>placed</th></tr></thead><tbody>\n";
  for (const auto& [what, tally] : crossing_lines(v, scene))
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        html_escaped(what), tally->frames, tally->worst,
                        tally->worst_frame >= 0 ? std::to_string(tally->worst_frame) : "", tally->total, tally->placed);
  return html + "</tbody></table></div>\n";
}

/// Runs of frames with the same proxies, so that a long motion stays readable.
std::string collisions_html(const Validation& v) {
  std::string html =
      "<details><summary>Which proxies meet the mesh, frame by frame (exact)</summary>\n<p class=\"soft\">"
      "A proxy that never meets it is wholly outside; one wholly inside counts as meeting it and is "
      "marked.</p>\n<div class=\"scroll\"><table><thead><tr><th>frames</th><th>meet</th><th>do not meet"
      "</th><th>wholly inside</th></tr></thead><tbody>\n";
  const auto same = [](const FrameReport& x, const FrameReport& y) {
    return x.collisions == y.collisions && x.inside == y.inside;
  };
  for (std::size_t first = 0; first < v.frames.size();) {
    std::size_t last = first;
    while (last + 1 < v.frames.size() && same(v.frames[first], v.frames[last + 1])) ++last;
    std::vector<std::string> apart, inside;
    for (int c = 0; c < static_cast<int>(v.proxies.size()); ++c)
      if (!std::binary_search(v.frames[first].collisions.begin(), v.frames[first].collisions.end(), c))
        apart.push_back(v.proxies[c].name);
    for (const int c : v.frames[first].inside) inside.push_back(v.proxies[c].name);
    const std::string frames = first == last ? std::to_string(v.frames[first].frame)
                                             : fmt::format("{} to {}", v.frames[first].frame, v.frames[last].frame);
    html += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"name\">{}</td><td class=\"name\">{}</td></tr>\n", frames,
                        v.frames[first].collisions.size(), html_escaped(fmt::format("{}", fmt::join(apart, ", "))),
                        html_escaped(fmt::format("{}", fmt::join(inside, ", "))));
    first = last + 1;
  }
  return html + "</tbody></table></div></details>\n";
}

std::string method_html(const Validation& v) {
  const proxies::MeshCensus& c = v.census;
  return fmt::format(
      "<details><summary>How this was measured</summary>\n"
      "<p><b>Under</b>: {} fixed points of the skin, weighted by their area at rest, against the union of the posed "
      "proxies; what is inside counts as 0. <b>Over</b>: points of the proxies' outer surface against the posed mesh. "
      "Percentiles are over all points of all measured frames. The <b>bound</b>: both distances change no faster than "
      "the place, so a point speaks for its whole cell up to the cell's radius, and cells are divided until that says "
      "enough; no point of either surface is farther out than the bound.</p>\n"
      "<p>Body: {} vertices, {} triangles, {} shell{}; posed by {}. Inside is told by {}: {}. {:.1f} % of the mesh's "
      "area is inside the body at rest and left out. Skin that folds into itself in a pose is not left out.</p>\n"
      "<p>Volumes by counting points: {:.2f} l body, {:.2f} l proxies; {:.2f} l of the body outside the proxies, "
      "{:.2f} "
      "l of the proxies outside the body. {} frames{}, {:.1f} s.</p></details>\n",
      v.skin_samples, c.vertices, c.triangles, c.shells, c.shells == 1 ? "" : "s", v.skinning,
      c.rule == proxies::SideRule::pseudonormal ? "pseudonormals" : "winding numbers", html_escaped(c.reason),
      100.0 * v.buried_share, 1000.0 * v.body_volume, 1000.0 * v.proxies_volume, 1000.0 * v.only_body_volume,
      1000.0 * v.only_proxies_volume, v.frames.size(),
      v.options.every > 1 ? fmt::format(", every {}th", v.options.every) : "", v.seconds);
}

} // namespace

std::string validation_html(const Validation& v, const LoadedScene& scene, const std::optional<Verdict>& verdict,
                            const std::vector<HeatMap>& maps, const std::string& no_maps) {
  const std::string title = scene.name() + ": proxies against the true body";
  std::string html = page_head(title, k_style);
  html += fmt::format("<p class=\"soft\">{} proxies ({}) on {}, {} frames measured.</p>\n", v.proxies.size(),
                      html_escaped(scene.files.proxies ? scene.files.proxies->filename().string() : ""),
                      html_escaped(scene.files.character.filename().string()), v.frames.size());
  if (verdict)
    html += fmt::format("<div class=\"verdict {}\">{}</div>\n", verdict->met() ? "met" : "missed",
                        html_escaped(verdict->text()));
  if (v.cloth_failure) html += "<div class=\"verdict missed\">" + html_escaped(*v.cloth_failure) + "</div>\n";
  html += tiles(v);
  html += "<h2>Over the motion</h2>\n" + plots(v);
  html += maps_html(v, maps, no_maps);
  html += "<h2>All in numbers</h2>\n" + whole_table(v);
  if (v.cloth) html += cloth_table(v) + crossings_table(v, scene);
  html += "<h2>Proxies, the worst first</h2>\n<p class=\"soft\">mm. Under: of the skin that is nearest to the "
          "proxy.</p>\n" +
          table("proxy", v.proxies, true);
  std::vector<GroupErrors> regions = v.regions;
  regions.push_back(v.core);
  html += "<h2>Regions of the body</h2>\n" + table("region", regions, false);
  html += "<h2>Joints, the worst first</h2>\n<p class=\"soft\">Skin belongs to the joint with most of its weight, a "
          "proxy to the joint that carries most of it.</p>\n" +
          table("joint", v.joints, false);
  html += collisions_html(v) + method_html(v);
  return html + k_page_end;
}

} // namespace tutu::app
