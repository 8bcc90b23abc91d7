#include "src/scene/scene_override.h"

#include "rig/error.h"

#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {

void override_setting(SceneDescription& description, const std::string& assignment, const std::string& option) {
  const std::size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : assignment.substr(equals + 1);
  const auto refuse = [&](const std::string& expected) { throw InputError("", option, assignment, expected); };
  const auto whole = [&](int least, int most) {
    int number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size() || number < least || number > most)
      refuse(fmt::format("{} from {} to {}", key, least, most));
    return number;
  };
  const auto yes = [&] {
    if (value != "true" && value != "false") refuse(key + " true or false");
    return value == "true";
  };
  const auto among = [&](const auto& names) {
    if (std::find(names.begin(), names.end(), value) == names.end())
      refuse(fmt::format("{}, one of: {}", key, fmt::join(names, ", ")));
    return value;
  };
  if (key == "solver") description.settings.solver = cloth::solver_named(among(cloth::k_solver_names));
  else if (key == "substeps") description.settings.substeps = whole(1, 10000);
  else if (key == "passes") description.settings.passes = whole(1, 100);
  else if (key == "adaptive_substeps") description.settings.adaptive_substeps = yes();
  else if (key == "double_precision") description.settings.double_precision = yes();
  else if (key == "backend") description.settings.backend = proxies::backend_named(among(proxies::k_backend_names));
  else if (key == "features")
    description.settings.features = cloth::contact_features_named(among(cloth::k_contact_features_names));
  else if (key == "swept") description.settings.swept = yes();
  else if (key == "self_collision") description.settings.self_collision = yes();
  else if (key == "proxies" && value == "none") description.proxies.reset();
  else if (key == "proxies") {
    if (!std::filesystem::is_regular_file(value)) refuse("a proxies file, or none");
    description.proxies = value;
  } else {
    refuse("KEY=VALUE with one of: solver, substeps, passes, adaptive_substeps, double_precision, backend, features, "
           "swept, self_collision, proxies");
  }
}

} // namespace tutu::app
