#include "rig/mannequin/mannequin.h"
#include "rig/error.h"
#include "rig/io/file_io.h"
#include "src/base/outputs.h"
#include "src/commands/commands.h"

#include <fmt/format.h>

namespace tutu::app {

void add_mannequin(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("mannequin", "Write the built-in dancer as a Collada file");
  auto out = std::make_shared<std::string>();
  command->add_option("-o,--out", *out, "File to write (.dae)")->required();
  command->callback([out, &status] {
    if (std::filesystem::path(*out).extension() != ".dae")
      throw InputError("", "--out", *out, "a name that ends in .dae");
    check_outputs({{"--out", *out}}, {});
    const rig::Mannequin mannequin = rig::make_mannequin();
    write_file(*out, rig::collada_of(mannequin));
    fmt::print("{}: {} joints, {} + {} vertices\n", *out, mannequin.skeleton.joint_count(),
               mannequin.surface.vertex_count(), mannequin.spheres.vertex_count());
    status = k_ok;
  });
}

} // namespace tutu::app
