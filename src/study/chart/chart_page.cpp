#include "src/study/chart/chart_page.h"

#include "src/study/chart/chart_page_script.h"
#include "src/study/report/html.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tutu::app {
namespace {

using nlohmann::ordered_json;

/// A word of a command line that a shell takes as it is.
std::string shell_word(const std::string& word) {
  const auto plain = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("-_./,=+:", c); };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string command_of(const ChartPoint& point, const std::vector<std::string>& scene_words,
                       const SettingValues& default_setting) {
  std::string command = "tutu cell";
  for (const std::string& word : scene_words) command += " " + shell_word(word);
  for (const std::string& word : setting_options(point.values(), default_setting)) command += " " + shell_word(word);
  return command;
}

/// What the script draws and shows.
ordered_json data_of(const std::vector<ChartPoint>& points, const std::vector<std::string>& scene_words,
                     const SettingValues& default_setting) {
  ordered_json axes = ordered_json::array();
  for (const ErrorAxis& axis : error_axes())
    axes.push_back({{"column", axis.column},
                    {"title", axis.title},
                    {"scale", axis.scale},
                    {"floor", axis.floor},
                    {"front", front_of(points, axis)}});
  ordered_json list = ordered_json::array();
  for (const ChartPoint& point : points) {
    ordered_json figures = ordered_json::object(), setting = ordered_json::object();
    for (const std::string& column : row_columns())
      if (const auto value = point.figure(column)) figures[column] = *value;
    for (const std::string& column : setting_columns()) {
      setting[column] = point.rows.front().text(column);
      figures.erase(column);
    }
    list.push_back({{"name", point.name},
                    {"named", point.named},
                    {"runs", point.rows.size()},
                    {"failed", point.failed},
                    {"reason", point.reason},
                    {"why", point.rows.front().text("reason")},
                    {"machine", point.rows.front().text("machine")},
                    {"command", command_of(point, scene_words, default_setting)},
                    {"setting", setting},
                    {"figures", figures}});
  }
  return {{"axes", axes}, {"points", list}};
}

} // namespace

std::string chart_page(const std::vector<ChartPoint>& points, const Reference& reference, const std::string& verdict,
                       const std::vector<std::string>& scene_words, const SettingValues& default_setting) {
  const std::string title = reference.scene + ": speed against accuracy";
  const Protocol& p = reference.protocol;
  return page_head(title, k_chart_page_style) +
         fmt::format("<p class=\"soft\">{} settings; {} frames of motion, then {} to settle and {} held. "
                     "Times are the thread's own with one thread.</p>\n<div class=\"verdict\">{}</div>\n",
                     points.size(), p.frames, p.settle, p.held, html_lines(verdict)) +
         fmt::format("<p><label>Error: <select id=\"axis\"></select></label></p>\n<figure id=\"chart\"></figure>\n"
                     "<div id=\"shown\" class=\"verdict\">Click a point or a row: here comes the command that measures "
                     "it again.</div>\n<h2>All settings</h2>\n<p class=\"soft\">Medians over the runs. Click a heading "
                     "to sort.</p>\n<div class=\"scroll\"><table id=\"table\"></table></div>\n<h2>The reference</h2>\n"
                     "<p>xpbd in double precision against the true body, {} substeps a frame, {:g} times the scene's "
                     "cells. How far each level is from the next finer one:</p><p class=\"code\">{}</p>\n",
                     reference.substeps, reference.resolution, html_lines(convergence_text(reference))) +
         "<script>\nconst data = " + script_value(data_of(points, scene_words, default_setting)) + ";\n" +
         k_chart_page_script + "</script>\n" + k_page_end;
}

} // namespace tutu::app
