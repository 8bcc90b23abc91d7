// What goes wrong with input, in one form.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace tutu {

/// Input that cannot be used. The program prints `what()` as one message and exits with status 2.
///
/// `what()` reads "FILE: PLACE: found FOUND, expected EXPECTED"; empty parts are left out.
/// `place` is a JSON pointer ("/garments/0/fabric"), "line 12", or a named part ("joint LeftArm").
class InputError : public std::runtime_error {
public:
  InputError(std::string file, std::string place, std::string found, std::string expected)
      : std::runtime_error(message(file, place, found, expected)), file_(std::move(file)), place_(std::move(place)),
        found_(std::move(found)), expected_(std::move(expected)) {}

  const std::string& file() const { return file_; }
  const std::string& place() const { return place_; }
  const std::string& found() const { return found_; }
  const std::string& expected() const { return expected_; }

private:
  static std::string message(const std::string& file, const std::string& place, const std::string& found,
                             const std::string& expected) {
    std::string text = file;
    if (!place.empty()) text += (text.empty() ? "" : ": ") + place;
    if (!found.empty()) text += (text.empty() ? "found " : ": found ") + found;
    if (!expected.empty()) text += (found.empty() ? ": expected " : ", expected ") + expected;
    return text;
  }

  std::string file_, place_, found_, expected_;
};

} // namespace tutu
