// Private to read_bvh(): the words of a BVH file one after the other, each with its line.
#pragma once

#include "rig/error.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace tutu::rig::bvh_detail {

/// A byte order mark is passed over; lines end in LF, CR LF or CR. Braces are words of their own wherever they stand.
/// All functions throw InputError with file and line on what is not there.
class Words {
public:
  explicit Words(const std::filesystem::path& file);
  Words(const Words&) = delete; // views its own content
  Words& operator=(const Words&) = delete;

  std::string_view next(const char* expected);
  /// Takes the next word where it is this one, in any case.
  bool take(std::string_view word);
  void expect(const char* word);
  /// From the next word to the end of its line or to a brace, without the blanks around it; empty before a brace.
  std::string_view phrase();
  /// "Frame Time:", in any case, with as many blanks or none between its words and before the colon, or no colon.
  void label(std::string_view text);
  double number();
  int count(int most); ///< a whole number, 0 to `most`

  bool at_end();          ///< nothing but blanks is left
  bool ends_line() const; ///< nothing but blanks is left of this line
  int line() const { return line_; }
  int next_line();                ///< the line of the next word
  int numbers_on(int line) const; ///< words of that line
  int words_left() const;

  InputError error(std::string found, std::string expected) const { return error_at(line_, found, expected); }
  InputError error_at(int line, std::string found, std::string expected) const;
  static std::string quoted(std::string_view word);

private:
  std::string_view look() const; ///< the next word, which stays
  void skip_blanks();
  void skip(std::size_t bytes);

  std::string file_, content_;
  std::string_view rest_;
  int line_ = 1;
};

} // namespace tutu::rig::bvh_detail
