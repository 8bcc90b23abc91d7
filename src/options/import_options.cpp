#include "src/options/import_options.h"

#include "src/options/scene_options.h"

namespace tutu::app {

void add_import_options(CLI::App& command, rig::ImportOptions& import, const std::string& height_option) {
  command.add_option("--influences", import.max_influences, "Joints a vertex may hang on")
      ->check(CLI::IsMember({4, 8}))
      ->capture_default_str();
  CLI::Option* height =
      command.add_option(height_option, import.height, "How high the body is, m, whatever the file says of its unit")
          ->check(finite_number())
          ->check(CLI::PositiveNumber);
  const auto set_unit = [&import](const std::string& word) { import.metres_per_unit = rig::metres_in(word); };
  const auto is_unit = [](const std::string& word) {
    return rig::metres_in(word) ? std::string() : word + ": expected " + rig::k_expected_unit;
  };
  command.add_option_function<std::string>("--unit", set_unit, "The file's unit, in place of what it says")
      ->check(CLI::Validator(is_unit, "m, cm, mm, dm, in, ft or metres"))
      ->excludes(height);
  const auto set_rest = [&import](const std::string& word) { import.rest = rig::rest_pose_named(word); };
  command
      .add_option_function<std::string>("--rest", set_rest,
                                        "Rest in the pose the skin was bound in, or where the file's nodes stand")
      ->check(one_of(rig::k_rest_pose_names))
      ->default_str("bind");
}

} // namespace tutu::app
