// Private to the importer: which files a model may make its reader open.
#pragma once

#include "rig/error.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace tutu::rig::import_detail {

/// The model itself, and what is in its folder or below it; symbolic links count as what they lead to.
class Reach {
public:
  explicit Reach(const std::filesystem::path& model);

  /// Is this path within reach? What does not exist is where its name says it would be.
  bool holds(const std::filesystem::path& path) const;
  /// The same of a name as the model writes it. Absolute paths, drives and addresses ("file://…") are not, wherever
  /// they lead.
  bool holds_name(std::string_view name) const;

private:
  std::filesystem::path model_, folder_; ///< without links
};

/// For a file that the reader cannot do without.
InputError out_of_reach(const std::string& model, const std::string& place, std::string_view name);

} // namespace tutu::rig::import_detail
