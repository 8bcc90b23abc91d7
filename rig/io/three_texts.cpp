// The three texts of the report: translations, rotations, times.
#include "rig/error.h"
#include "rig/io/clip_file.h"
#include "rig/io/detail/unit_rotations.h"
#include "rig/io/file_io.h"
#include "rig/io/json_file.h"
#include "rig/io/memory_limit.h"
#include "rig/length_unit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

namespace tutu::rig {
namespace {

constexpr std::string_view k_blanks = " \t\r";

/// A file with its lines that are not blank.
struct Text {
  struct Line {
    int number; ///< 1 is the first line of the file
    std::string_view text;
  };
  std::string file, content;
  std::vector<Line> lines;

  InputError error(const Line& line, std::string found, std::string expected) const {
    return {file, "line " + std::to_string(line.number), std::move(found), std::move(expected)};
  }
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(k_blanks);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(k_blanks) + 1 - first);
}

/// Cuts the first word off `text`; empty when there is none.
std::string_view next_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(k_blanks));
  text.remove_prefix(word.size());
  return word;
}

void read_text(const std::filesystem::path& file, Text& text) {
  text.file = file.string();
  text.content = read_file(file);
  const auto lines = static_cast<double>(std::count(text.content.begin(), text.content.end(), '\n'));
  check_memory(static_cast<double>(text.content.size()) + 2.0 * sizeof(Text::Line) * lines, text.file, "",
               "a text of " + with_commas(static_cast<std::uint64_t>(lines)) + " lines");
  std::string_view rest = text.content;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = trimmed(rest.substr(0, end));
    if (!line.empty()) text.lines.push_back({number, line});
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (text.lines.empty()) throw InputError(text.file, "", "an empty file", "numbers");
}

/// from_chars takes the whole word; '.' is the decimal point whatever the locale.
template <class Number> bool read_word(std::string_view word, Number& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

std::vector<double> numbers(const Text& text, const Text::Line& line) {
  std::vector<double> values;
  std::string_view rest = line.text;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    double value = 0.0;
    if (!read_word(word, value) || !(std::abs(value) <= k_largest_number))
      throw text.error(line, "\"" + std::string(word.substr(0, 40)) + "\"", "a finite number");
    values.push_back(value);
  }
  return values;
}

std::vector<double> numbers(const Text& text, const Text::Line& line, std::size_t count, const std::string& meaning) {
  std::vector<double> values = numbers(text, line);
  if (values.size() != count)
    throw text.error(line, std::to_string(values.size()) + " numbers", std::to_string(count) + " (" + meaning + ")");
  return values;
}

std::vector<double> read_times(const std::filesystem::path& file) {
  Text text;
  read_text(file, text);
  std::vector<double> times;
  for (const Text::Line& line : text.lines) {
    for (const double time : numbers(text, line)) {
      if (!times.empty() && !(time > times.back()))
        throw text.error(line, "time " + std::to_string(time) + " after " + std::to_string(times.back()),
                         "strictly rising times");
      times.push_back(time);
    }
  }
  return times;
}

/// The skeleton's joint of each column group.
std::vector<int> read_joints(const std::filesystem::path& file, const Skeleton& skeleton) {
  Text text;
  read_text(file, text);
  const int count = static_cast<int>(text.lines.size());
  std::vector<int> joints, parents;
  for (const Text::Line& line : text.lines) {
    std::string_view rest = line.text;
    int index = 0, parent = 0;
    if (!read_word(next_word(rest), index) || !read_word(next_word(rest), parent) || trimmed(rest).empty())
      throw text.error(line, "\"" + std::string(line.text.substr(0, 60)) + "\"", "index, parent and name of a joint");
    if (index != static_cast<int>(joints.size()))
      throw text.error(line, "index " + std::to_string(index), std::to_string(joints.size()));
    if (parent < k_no_parent || parent >= count || parent == index)
      throw text.error(line, "parent " + std::to_string(parent), "the index of another joint, or -1");
    const std::string name(trimmed(rest));
    const std::optional<int> joint = skeleton.find(name);
    if (!joint) throw text.error(line, "joint " + name, "a joint of the skeleton");
    if (std::find(joints.begin(), joints.end(), *joint) != joints.end())
      throw text.error(line, "joint " + name + " again", "every joint once");
    joints.push_back(*joint);
    parents.push_back(parent);
  }
  // The numbers are relative to the parent, so the parents have to agree. A joint with -1 may hang on one that is not
  // listed.
  for (int j = 0; j < count; ++j) {
    const int found = parents[j] == k_no_parent ? k_no_parent : joints[parents[j]],
              expected = skeleton.parents[joints[j]];
    const bool listed = std::find(joints.begin(), joints.end(), expected) != joints.end();
    if (found == expected || (found == k_no_parent && !listed)) continue;
    throw text.error(text.lines[j], found == k_no_parent ? "no parent" : "parent " + skeleton.names[found],
                     expected == k_no_parent ? "no parent"
                                             : "parent " + skeleton.names[expected] + ", as in the skeleton");
  }
  return joints;
}

/// The unit in which the bones of the file are as long as the skeleton's.
LengthUnit unit_of(const RawClip& clip, const std::vector<int>& joints, const Skeleton& skeleton) {
  constexpr double k_shortest_bone = 1e-6; // m; shorter ones say nothing about the unit
  constexpr double k_near = 0.1; // a proportion may differ this much from the skeleton's and still be the same unit
  std::vector<double> ratios;
  for (const int joint : joints) {
    const double length = skeleton.rest_local[joint].translation.norm();
    if (skeleton.parents[joint] == k_no_parent || length < k_shortest_bone) continue;
    for (const RawClip::Key& key : clip.keys)
      ratios.push_back(key.joints.at(skeleton.names[joint]).translation->norm() / length);
  }
  if (ratios.empty()) return k_length_units[0];
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  for (const LengthUnit& unit : k_length_units)
    if (std::abs(*middle / unit.per_metre() - 1.0) <= k_near) return unit;
  throw InputError(clip.file, "", "bones " + std::to_string(*middle) + " times as long as the skeleton's in metres",
                   "translations in metres, decimetres, centimetres, millimetres, inches or feet");
}

template <std::size_t k_count> void append(std::string& text, const std::array<double, k_count>& values) {
  for (const double value : values) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    if (!text.empty() && text.back() != '\n') text += ' ';
    text.append(digits, end);
  }
}

} // namespace

RawClip read_three_texts(const ThreeTexts& files, const Skeleton& skeleton, std::vector<std::string>* notes) {
  std::vector<int> joints;
  if (files.joints) joints = read_joints(*files.joints, skeleton);
  else
    for (int j = 0; j < skeleton.joint_count(); ++j) joints.push_back(j);
  const std::vector<double> times = read_times(files.times);
  Text translations, rotations;
  read_text(files.translations, translations);
  read_text(files.rotations, rotations);
  for (const Text* text : {&translations, &rotations})
    if (text->lines.size() != times.size())
      throw InputError(text->file, "", std::to_string(text->lines.size()) + " poses",
                       std::to_string(times.size()) + ", one a time of " + files.times.string());

  constexpr double k_bytes_a_joint = 192.0; // of a key: a node of RawClip::Key::joints and its name
  check_memory(k_bytes_a_joint * static_cast<double>(times.size()) * static_cast<double>(joints.size()),
               translations.file, "",
               with_commas(times.size()) + " poses of " + with_commas(joints.size()) + " joints");

  RawClip clip;
  clip.file = translations.file;
  clip.name = files.translations.stem().string();
  UnitRotations unit_rotations;
  const std::string of_joints = " numbers for each of " + std::to_string(joints.size()) + " joints";
  for (std::size_t k = 0; k < times.size(); ++k) {
    RawClip::Key& key = clip.keys.emplace_back();
    key.time = times[k];
    const auto t = numbers(translations, translations.lines[k], 3 * joints.size(), "3" + of_joints);
    const auto q = numbers(rotations, rotations.lines[k], 4 * joints.size(), "4" + of_joints);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const std::string& name = skeleton.names[joints[j]];
      const Quat as_given(q[4 * j + 3], q[4 * j], q[4 * j + 1], q[4 * j + 2]);
      const std::optional<Quat> rotation = unit_rotations.normalised(as_given);
      if (!rotation)
        throw rotations.error(rotations.lines[k],
                              "a rotation of length " + std::to_string(as_given.norm()) + " for joint " + name,
                              UnitRotations::k_expected);
      key.joints[name] = {Vec3(t[3 * j], t[3 * j + 1], t[3 * j + 2]), rotation};
    }
  }

  const LengthUnit unit = unit_of(clip, joints, skeleton);
  if (unit.per_metre() != 1.0) {
    for (RawClip::Key& key : clip.keys)
      for (auto& [name, joint] : key.joints) *joint.translation /= unit.per_metre();
    if (notes)
      notes->push_back("The translations of " + clip.file + " are in " + unit.name +
                       ", as their bones tell; they were converted to metres.");
  }
  if (const auto note = unit_rotations.note(); note && notes) notes->push_back(rotations.file + ": " + *note);
  return clip;
}

void write_three_texts(const RawClip& clip, const Skeleton& skeleton, const ThreeTexts& files) {
  const Clip dense = build_clip(clip, skeleton);
  std::string translations, rotations, times, joints;
  for (int k = 0; k < static_cast<int>(dense.times.size()); ++k) {
    for (const Transform& local : dense.key(k)) {
      append<3>(translations, {local.translation.x(), local.translation.y(), local.translation.z()});
      append<4>(rotations, {local.rotation.x(), local.rotation.y(), local.rotation.z(), local.rotation.w()});
    }
    translations += '\n';
    rotations += '\n';
    append<1>(times, {dense.times[k]});
  }
  times += '\n';
  write_file(files.translations, translations);
  write_file(files.rotations, rotations);
  write_file(files.times, times);
  if (!files.joints) return;
  for (int j = 0; j < skeleton.joint_count(); ++j)
    joints += std::to_string(j) + " " + std::to_string(skeleton.parents[j]) + " " + skeleton.names[j] + "\n";
  write_file(*files.joints, joints);
}

} // namespace tutu::rig
