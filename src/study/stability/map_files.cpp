#include "src/study/stability/map_files.h"

#include "src/study/stability/margin.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

using nlohmann::json;

json axis_json(const MapAxis& axis) {
  json values = json::array();
  for (const double value : axis.values) values.push_back(axis.scale * value);
  return {{"name", axis.name},
          {"unit", axis.unit},
          {"values", values},
          {"own", axis.own ? json(axis.scale * *axis.own) : json(nullptr)}};
}

json cell_json(const StabilityMap& map, std::size_t ix, std::size_t iy) {
  const MapCell& cell = map.cell(ix, iy);
  json outcomes = json::object();
  for (std::size_t k = 0; k < k_outcomes; ++k) outcomes[std::string(k_outcome_names[k])] = cell.outcomes[k];
  json result = {{"x", map.x.scale * map.x.values[ix]},
                 {"y", map.y.scale * map.y.values[iy]},
                 {"starts", cell.starts},
                 {"outcomes", outcomes}};
  if (cell.largest_step) result["largest_step_ms"] = 1e3 * *cell.largest_step;
  return result;
}

json margin_json(const StabilityMap& map, double step) {
  const std::optional<Margin> margin = margin_of(map, step);
  if (!margin) return nullptr;
  json result = {{"holds", margin->holds}, {"words", in_words(map, step)}};
  if (margin->nearest) {
    const MapAxis& axis = margin->nearest->along_x ? map.x : map.y;
    result["nearest"] = {{"axis", axis.name},
                         {"value", axis.scale * margin->nearest->value},
                         {"ratio", margin->nearest->ratio},
                         {"how", k_outcome_names[index_of(margin->nearest->how)]}};
  }
  if (margin->largest) result["largest_step_ms"] = 1e3 * *margin->largest;
  return result;
}

std::string quoted(const std::string& text) { return '"' + text + '"'; } // names here hold no quotes

constexpr Rgb k_held = {237, 237, 237};
/// In the order of Outcome [Okabe and Ito 2002]: none, vermilion, orange, blue, reddish purple.
constexpr std::array<Rgb, k_outcomes> k_outcome_colours = {k_held, Rgb{213, 94, 0}, Rgb{230, 159, 0}, Rgb{0, 114, 178},
                                                           Rgb{204, 121, 167}};
constexpr double k_palest = 0.35; ///< one failure among many starts is still seen

ChartCell outcome_cell(const MapCell& cell) {
  if (cell.failed() == 0) return {k_held, ""};
  const double share = static_cast<double>(cell.failed()) / cell.starts;
  const std::size_t worst = index_of(cell.worst());
  return {blend(k_held, k_outcome_colours[worst], k_palest + (1.0 - k_palest) * share),
          share < 1.0 ? fmt::format("{} {}/{}", k_outcome_letters[worst], cell.failed(), cell.starts)
                      : std::string(1, k_outcome_letters[worst])};
}

/// From dark blue (small) to yellow (large), in lightness alone a scale too [Nunez, Anderton, Renslow 2018, cividis].
Rgb step_colour(double share) {
  constexpr std::array<Rgb, 3> k_scale = {Rgb{0, 34, 78}, Rgb{125, 124, 120}, Rgb{254, 232, 56}};
  return share < 0.5 ? blend(k_scale[0], k_scale[1], 2.0 * share) : blend(k_scale[1], k_scale[2], 2.0 * share - 1.0);
}

void colour_steps(const StabilityMap& map, CellChart& chart) {
  double least = 1e300, most = 0.0;
  for (const MapCell& cell : map.cells)
    if (const double step = cell.largest_step.value_or(0.0); step > 0.0) {
      least = std::min(least, step);
      most = std::max(most, step);
    }
  for (const MapCell& cell : map.cells) {
    const double step = cell.largest_step.value_or(0.0);
    const double share = step > 0.0 && most > least ? std::log(step / least) / std::log(most / least) : 0.0;
    chart.cells.push_back(
        {step_colour(share),
         step > 0.0 ? fmt::format("{:.3g} {}", 1e3 * step, k_outcome_letters[index_of(cell.worst())]) : "none"});
  }
  chart.key = {{step_colour(1.0), "larger steps hold"}, {step_colour(0.0), "only small steps"}};
}

} // namespace

std::string maps_csv(const std::vector<StabilityMap>& maps) {
  std::string text = "map,x_name,x_unit,x,y_name,y_unit,y,starts";
  for (const std::string_view name : k_outcome_names) text += fmt::format(",{}", name);
  text += ",largest_step_ms\n";
  for (const StabilityMap& map : maps)
    for (std::size_t iy = 0; iy < map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < map.x.values.size(); ++ix) {
        const MapCell& cell = map.cell(ix, iy);
        text += fmt::format("{},{},{},{:.9g},{},{},{:.9g},{}", map.name, quoted(map.x.name), map.x.unit,
                            map.x.scale * map.x.values[ix], quoted(map.y.name), map.y.unit,
                            map.y.scale * map.y.values[iy], cell.starts);
        for (const int count : cell.outcomes) text += fmt::format(",{}", count);
        text += cell.largest_step ? fmt::format(",{:.9g}\n", 1e3 * *cell.largest_step) : ",\n";
      }
  return text;
}

json maps_json(const std::vector<StabilityMap>& maps, const Scene& scene, const SceneSetting& setting,
               const MapOptions& options) {
  json garments = json::array();
  for (const GarmentSetting& garment : setting.garments)
    garments.push_back({{"name", garment.name},
                        {"mass_spring_largest_step_ms",
                         std::isfinite(garment.step_limit) ? json(1e3 * garment.step_limit) : json(nullptr)},
                        {"stiffest_cell_mm", 1e3 * garment.stiffest_cell},
                        {"largest_cell_mm", 1e3 * garment.largest_cell},
                        {"mass_ratio", garment.mass_ratio}});
  json result = {{"scene", scene.name()},
                 {"solver", cloth::name_of(scene.settings.solver)},
                 {"substeps", scene.settings.substeps},
                 {"adaptive_substeps", scene.settings.adaptive_substeps},
                 {"step_ms", 1e3 * setting.step},
                 {"quick", options.quick},
                 {"starts", options.starts},
                 {"garments", garments},
                 {"maps", json::array()}};
  for (const StabilityMap& map : maps) {
    json cells = json::array();
    for (std::size_t iy = 0; iy < map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < map.x.values.size(); ++ix) cells.push_back(cell_json(map, ix, iy));
    json one = {{"name", map.name},          {"title", map.title},
                {"what", map.what},          {"own_method", map.own_method},
                {"x", axis_json(map.x)},     {"y", axis_json(map.y)},
                {"cells", std::move(cells)}, {"margin", margin_json(map, setting.step)}};
    if (!map.bound.empty()) {
      json bound = json::array();
      for (const double y : map.bound) bound.push_back(map.y.scale * y);
      one["bound"] = {{"name", map.bound_name}, {"y", bound}};
    }
    result["maps"].push_back(std::move(one));
  }
  return result;
}

std::string maps_text(const std::vector<StabilityMap>& maps, const Scene& scene, const SceneSetting& setting) {
  std::string text = fmt::format("{}: {}, {} substeps a frame ({:.3g} ms each)\n", scene.name(),
                                 cloth::name_of(scene.settings.solver), scene.settings.substeps, 1e3 * setting.step);
  for (const GarmentSetting& garment : setting.garments)
    text += fmt::format("{}: mass_spring stands at most {:.3g} ms (from its largest eigenvalue); cells as stiff as "
                        "squares of {:.3g} mm, up to {:.3g} mm; masses 1 : {:.2g}\n",
                        garment.name, 1e3 * garment.step_limit, 1e3 * garment.stiffest_cell, 1e3 * garment.largest_cell,
                        garment.mass_ratio);
  for (const bool own : {true, false}) {
    text += own ? "as the scene is:\n" : "were it run otherwise:\n";
    for (const StabilityMap& map : maps)
      if (map.own_method == own) text += fmt::format("  {:<28} {}\n", map.name, in_words(map, setting.step));
  }
  return text;
}

CellChart chart_of(const StabilityMap& map, const SceneSetting& setting) {
  CellChart chart;
  chart.title = map.title;
  const auto label = [](const MapAxis& axis) {
    return axis.unit.empty() ? axis.name : fmt::format("{}, {}", axis.name, axis.unit);
  };
  chart.subtitle = map.own_method ? "The scene " + in_words(map, setting.step) : map.what;
  chart.x = label(map.x);
  chart.y = label(map.y);
  const auto number = [](const MapAxis& axis, double value) {
    return in_words(MapAxis{"", "", axis.scale, {}, {}}, value); // the unit stands in the label
  };
  for (const double value : map.x.values) chart.x_values.push_back(number(map.x, value));
  for (const double value : map.y.values) chart.y_values.push_back(number(map.y, value));
  if (map.of_steps) {
    colour_steps(map, chart);
  } else {
    for (const MapCell& cell : map.cells) chart.cells.push_back(outcome_cell(cell));
    for (std::size_t k = 0; k < k_outcomes; ++k)
      chart.key.emplace_back(k_outcome_colours[k],
                             k == 0 ? std::string(k_outcome_words[k])
                                    : fmt::format("{} {}", k_outcome_letters[k], k_outcome_words[k]));
  }
  for (std::size_t ix = 0; ix < map.bound.size(); ++ix)
    if (const auto y = map.y.place(map.bound[ix])) chart.line.emplace_back(static_cast<double>(ix), *y);
  chart.line_name = map.bound_name;
  if (map.x.own && map.y.own) {
    const auto x = map.x.place(*map.x.own), y = map.y.place(*map.y.own);
    if (x && y) chart.marks.push_back({*x, *y, "this scene"});
  }
  return chart;
}

} // namespace tutu::app
