// Grids of settings: read, told apart, and made into what a cell is started with.
#include "src/study/chart/row.h"
#include "src/study/chart/settings_grid.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_settings(std::string_view input) {
  for (static bool first = true; first; first = false) write_input("", "hand.json");
  const app::RunSettings scene;
  const std::vector<app::Setting> settings = app::read_settings(write_input(input, "settings.json"), scene);
  const app::SettingValues own = app::setting_values(app::own_setting(scene));
  require(!settings.empty() && app::setting_values(settings.front()) == own, "the scene's own setting comes first");
  for (std::size_t k = 0; k < std::min<std::size_t>(settings.size(), 100); ++k) {
    const app::SettingValues values = app::setting_values(settings[k]);
    require(app::setting_options(values, own).empty() == (k == 0), "no setting is there twice");
    (void)app::difference(values, own);
    if (!app::fitted_count(settings[k])) (void)app::cell_key({"scene", "reference", {}, settings[k]});
  }
}

} // namespace tutu::fuzz
