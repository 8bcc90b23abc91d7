// Whatever byte stands in a name, no name is a command: not to gnuplot, not to a shell, not in a page.
#include "cloth/garment/garment_file.h"
#include "proxies/proxy_file.h"
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "rig/mannequin/mannequin.h"
#include "src/scene/scene_file.h"
#include "src/study/chart/chart_page.h"
#include "src/study/chart/chart_picture.h"
#include "src/study/chart/settings_grid.h"
#include "src/study/report/cell_chart.h"
#include "src/study/report/gnuplot_chart.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace tutu;
using namespace tutu::app;
using namespace tutu::test;

namespace {

namespace fs = std::filesystem;

class HostileNames : public ::testing::Test {
protected:
  HostileNames() : folder_(scratch_folder()), trap_(folder_ / "trap") {}
  ~HostileNames() override { fs::remove_all(folder_); }

  /// Text that makes the trap's file wherever it is read as a command of gnuplot or of a shell, after this byte.
  std::vector<std::string> payloads(char byte) const {
    const std::string touch = "touch " + trap_.string(), b(1, byte);
    return {b + "system('" + touch + "')" + b,
            b + "!" + touch + b,
            b + "`" + touch + "`" + b,
            b + "$(" + touch + ")" + b,
            "'" + b + "EOD" + b + "!" + touch + b,
            "\"" + b + "';" + touch + ";'" + b,
            "\\" + b + "!" + touch + b};
  }
  std::vector<std::string> all_payloads() const {
    std::vector<std::string> all;
    for (int byte = 1; byte < 256; ++byte)
      for (std::string& text : payloads(static_cast<char>(byte))) all.push_back(std::move(text));
    return all;
  }
  void expect_no_trap(const std::string& what) { EXPECT_FALSE(fs::exists(trap_)) << what; }

  fs::path folder_, trap_;
};

TEST_F(HostileNames, TheTrapWorks) {
  // The forms above are commands where nobody quotes them: the test can see what it looks for.
  ASSERT_EQ(
      std::system(("printf '%s\\n' 'set title \"\"' '!touch " + trap_.string() + "' | gnuplot 2> /dev/null").c_str()),
      0);
  EXPECT_TRUE(fs::exists(trap_));
}

TEST_F(HostileNames, InChartsAreText) {
  if (std::system("command -v gnuplot > /dev/null") != 0) GTEST_SKIP() << "no gnuplot here";
  const std::vector<std::string> names = all_payloads();
  Chart chart{"", "", "", "", {}};
  CellChart cells;
  cells.x_values = cells.y_values = {"1"};
  cells.cells = {{}};
  for (const std::string& name : names) chart.lines.push_back({name, {{0.0, 1.0}}});
  for (std::string* text : {&chart.title, &chart.x, &chart.y, &chart.right, &cells.title, &cells.subtitle, &cells.x,
                            &cells.y, &cells.line_name, &cells.cells[0].text, &cells.x_values[0]})
    for (const std::string& name : names) *text += name;
  cells.line = {{0.0, 0.0}};
  write_chart(chart, folder_ / "chart.svg");
  expect_no_trap("chart");
  write_cell_chart(cells, folder_ / "cells.svg");
  expect_no_trap("cells");
  EXPECT_GT(fs::file_size(folder_ / "chart.svg"), 1000u);
}

TEST_F(HostileNames, InTheChartOfSettingsAndItsPageAreText) {
  if (std::system("command -v gnuplot > /dev/null") != 0) GTEST_SKIP() << "no gnuplot here";
  std::vector<ChartPoint> points;
  for (const std::string& name : all_payloads()) {
    ChartPoint& point = points.emplace_back();
    point.name = point.reason = name;
    point.named = true;
    point.failed = points.size() % 2;
    Row row;
    row.set("name", name);
    row.set("ms_p99", 1.0 + 0.001 * static_cast<double>(points.size()));
    row.set(error_axes().front().column, 1.0);
    point.rows = {row};
  }
  write_chart_picture(points, error_axes().front(), points.front().name, folder_ / "chart.svg");
  expect_no_trap("picture");
  for (ChartPoint& point : points) point.name += "</script><script>alert(1)</script><!--<script>";
  const std::string page =
      chart_page(points, {}, points.front().name, {points.front().name}, SettingValues(setting_columns().size()));
  std::size_t scripts = 0;
  for (std::size_t at = page.find("<script"); at != page.npos; at = page.find("<script", at + 1)) ++scripts;
  EXPECT_EQ(scripts, 1u);
  EXPECT_EQ(page.find("<!--"), page.npos);
}

TEST_F(HostileNames, InThePageAreTextToABrowser_slow) {
  if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "no chromium here";
  const auto opened = [&](const std::string& page) {
    write_file(folder_ / "page.html", page);
    const std::string command =
        "timeout 60 chromium --headless --no-sandbox --disable-gpu --user-data-dir=" + (folder_ / "profile").string() +
        " --dump-dom file://" + (folder_ / "page.html").string() + " > " + (folder_ / "dom").string() + " 2> /dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return read_file(folder_ / "dom");
  };
  const std::string mark = "document.body.append('obe' + 'yed')";
  ASSERT_NE(opened("<body><!--<b>--><script>" + mark + "</script>").find("obeyed"), std::string::npos)
      << "the browser obeys what is a script";
  for (const std::string opener :
       {"</script>", "<!--<script>", "]]>", "\u003c/script>", "'\"`>", "${", "</td></style>"}) {
    ChartPoint point;
    point.name = point.reason = opener + "<script>" + mark + "</script><img src=x onerror=\"" + mark + "\">";
    point.named = true;
    Row row;
    row.set("name", point.name);
    row.set("ms_p99", 1.0);
    row.set(error_axes().front().column, 1.0);
    point.rows = {row};
    const std::string dom =
        opened(chart_page({point}, {}, point.name, {point.name}, SettingValues(setting_columns().size())));
    EXPECT_EQ(dom.find("obeyed"), std::string::npos) << opener;
    EXPECT_NE(dom.find("<circle"), std::string::npos) << "its own script ran, and drew: " << opener;
  }
}

TEST_F(HostileNames, OfPicturesAreNames_slow) {
  if (std::system("command -v gnuplot > /dev/null") != 0) GTEST_SKIP() << "no gnuplot here";
  const Chart chart{"", "x", "y", "", {{"line", {{0.0, 1.0}}}}};
  for (int byte = 1; byte < 256; ++byte) {
    if (byte == '/') continue;
    // A name holds no '/': the trap is made in the folder that the test stands in.
    const std::string b(1, static_cast<char>(byte));
    const fs::path file = folder_ / (b + "';system('touch trap')#" + b + "!touch trap" + b + ".svg");
    const fs::path before = fs::current_path();
    fs::current_path(folder_);
    write_chart(chart, file);
    fs::current_path(before);
    EXPECT_TRUE(fs::exists(file)) << byte;
    expect_no_trap(fmt::format("byte {}", byte));
  }
}

TEST_F(HostileNames, WithControlCharactersAreRefusedWhenRead) {
  const rig::Skeleton skeleton = rig::make_mannequin().skeleton;
  for (int byte = 1; byte < 256; ++byte) {
    if (byte >= 0x20 && byte < 0x7F) continue;
    // Above 0x7F: no character of its own in UTF-8, and as a code (C1, then Latin) refused up to 0x9F.
    const std::string raw = std::string("a") + static_cast<char>(byte), escaped = fmt::format("a\\u{:04x}", byte);
    for (const std::string& name : {raw, escaped}) {
      const bool fine = &name != &raw && name == escaped && byte > 0x9F;
      const auto write = [&](const char* file, const std::string& text) {
        write_file(folder_ / file, text);
        return folder_ / file;
      };
      const auto expect = [&](const char* what, const std::function<void()>& read) {
        if (fine) EXPECT_NO_THROW(read()) << what << byte;
        else EXPECT_THROW(read(), InputError) << what << byte;
      };
      expect("garment", [&] {
        cloth::read_garment(write("g.json", R"({"name": ")" + name + R"(", "shape": {"grid": {"rows": 4, "columns": 4,
            "corner": [0, 1, 0], "across": [1, 0, 0], "down": [0, 0, 1]}}})"));
      });
      expect("proxy", [&] {
        proxies::read_proxies(
            write("p.json", R"({"proxies": [{"name": ")" + name +
                                R"(", "sphere": {"joint": "Hips", "center": [0, 0, 0], "radius": 0.1}}]})"),
            skeleton);
      });
      expect("setting", [&] {
        read_settings(write("s.json", R"({"settings": [{"name": ")" + name + R"(", "substeps": 3}]})"), {});
      });
    }
  }
}

} // namespace
