#include "rig/io/memory_limit.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace tutu {
namespace {

constexpr const char* k_variable = "TUTU_MEMORY_GIB";
constexpr double k_gib = 1024.0 * 1024.0 * 1024.0;
constexpr double k_usual_limit = 2.0; // GiB

/// With one digit behind the point where that says more.
std::string gib(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text,
                bytes < 0.095 * k_gib  ? "%.2g GiB"
                : bytes < 99.5 * k_gib ? "%.3g GiB"
                                       : "%.0f GiB",
                bytes / k_gib);
  return text;
}

} // namespace

double memory_limit() {
  const char* chosen = std::getenv(k_variable);
  if (!chosen) return k_usual_limit * k_gib;
  const std::string_view text = chosen;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0.0) || !std::isfinite(value))
    throw InputError(std::string("$") + k_variable, "", '"' + std::string(text.substr(0, 40)) + '"',
                     "a number of GiB above 0");
  return value * k_gib;
}

void check_memory(double bytes, const std::string& file, const std::string& place, const std::string& what) {
  const double limit = memory_limit();
  if (bytes <= limit) return;
  throw InputError(file, place, what + ", about " + gib(bytes),
                   "at most " + gib(limit) + "; " + k_variable + "=" +
                       std::to_string(static_cast<std::uint64_t>(std::min(std::ceil(bytes / k_gib), 1e15))) +
                       " raises the limit");
}

std::string with_commas(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

InputError out_of_memory(const std::string& file) {
  return {file, "", "more than there is memory for", "something smaller, or more memory"};
}

} // namespace tutu
