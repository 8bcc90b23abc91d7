#include "rig/import/detail/reach.h"

#include <algorithm>
#include <cctype>

namespace tutu::rig::import_detail {
namespace fs = std::filesystem;
namespace {

/// "C:", "file:", "http:" [RFC 3986, 3.1].
bool has_scheme(std::string_view name) {
  const std::string_view scheme = name.substr(0, name.find_first_of(":/"));
  if (scheme.empty() || scheme.size() == name.size() || name[scheme.size()] != ':') return false;
  return std::all_of(scheme.begin(), scheme.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

} // namespace

Reach::Reach(const fs::path& model)
    : model_(fs::canonical(model)), folder_(fs::canonical(fs::absolute(model).parent_path())) {}

bool Reach::holds(const fs::path& path) const {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) return false; // links in a circle, a name too long
  return real == model_ ||
         std::mismatch(folder_.begin(), folder_.end(), real.begin(), real.end()).first == folder_.end();
}

bool Reach::holds_name(std::string_view name) const {
  std::string path(name);
  std::replace(path.begin(), path.end(), '\\', '/');
  return !path.starts_with('/') && !has_scheme(path) && holds(folder_ / path);
}

InputError out_of_reach(const std::string& model, const std::string& place, std::string_view name) {
  constexpr std::size_t k_longest = 120;
  const std::string shown = std::string(name.substr(0, k_longest)) + (name.size() > k_longest ? "..." : "");
  return InputError(model, place, shown + ", outside of its folder", "a file in the model's folder or below");
}

} // namespace tutu::rig::import_detail
