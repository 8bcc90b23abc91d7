#include "rig/io/detail/bvh_words.h"

#include "rig/io/file_io.h"
#include "rig/math.h"
#include "rig/text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace tutu::rig::bvh_detail {
namespace {

constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";

bool is_end_of_line(char c) { return c == '\n' || c == '\r'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || is_end_of_line(c); }
bool is_brace(char c) { return c == '{' || c == '}'; }

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// Whether a line ends with the byte at `at`: the LF of CR LF does, its CR does not.
bool breaks_line(std::string_view text, std::size_t at) {
  return text[at] == '\n' || (text[at] == '\r' && !(at + 1 < text.size() && text[at + 1] == '\n'));
}

int count_words(std::string_view text) {
  int count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) count += !is_blank(text[i]) && (i == 0 || is_blank(text[i - 1]));
  return count;
}

} // namespace

Words::Words(const std::filesystem::path& file) : file_(file.string()), content_(read_file(file)), rest_(content_) {
  if (rest_.starts_with(k_byte_order_mark)) rest_.remove_prefix(k_byte_order_mark.size());
}

std::string_view Words::next(const char* expected) {
  skip_blanks();
  const std::string_view word = look();
  if (word.empty()) throw error("the end of the file", expected);
  skip(word.size());
  return word;
}

bool Words::take(std::string_view word) {
  skip_blanks();
  const std::string_view found = look();
  if (!std::ranges::equal(found, word, same_letter)) return false;
  skip(found.size());
  return true;
}

void Words::expect(const char* word) {
  if (take(word)) return;
  throw error(look().empty() ? "the end of the file" : quoted(look()), word);
}

std::string_view Words::phrase() {
  skip_blanks();
  std::size_t size = 0;
  while (size < rest_.size() && !is_end_of_line(rest_[size]) && !is_brace(rest_[size])) ++size;
  std::string_view text = rest_.substr(0, size);
  skip(size);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

void Words::label(std::string_view text) {
  skip_blanks();
  const std::string found = look().empty() ? "the end of the file" : quoted(look());
  for (const char c : text) {
    if (c == ' ' || c == ':') skip_blanks();
    if (c == ' ') continue;
    if (!rest_.empty() && same_letter(rest_.front(), c)) skip(1);
    else if (c != ':') throw error(found, std::string(text));
  }
}

double Words::number() {
  const std::string_view shown = next("a number");
  std::string_view word = shown;
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0.0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failure != std::errc() || end != word.data() + word.size() || !(std::abs(value) <= k_largest_number))
    throw error(quoted(shown), word.find(',') == word.npos ? "a finite number" : "a finite number, without a comma");
  return value;
}

int Words::count(int most) {
  const double value = number();
  if (!(value >= 0.0 && value <= most) || value != std::floor(value))
    throw error(std::to_string(value), "a whole number up to " + std::to_string(most));
  return static_cast<int>(value);
}

bool Words::at_end() {
  skip_blanks();
  return rest_.empty();
}

bool Words::ends_line() const {
  const std::size_t end = rest_.find_first_not_of(" \t");
  return end == rest_.npos || is_end_of_line(rest_[end]);
}

int Words::next_line() {
  skip_blanks();
  return line_;
}

int Words::numbers_on(int line) const {
  const std::string_view text = content_;
  std::size_t start = 0, i = 0;
  for (int number = 1; i < text.size(); ++i) {
    if (!breaks_line(text, i)) continue;
    if (number++ == line) break;
    start = i + 1;
  }
  return count_words(text.substr(start, i - start));
}

int Words::words_left() const { return count_words(rest_); }

InputError Words::error_at(int line, std::string found, std::string expected) const {
  return {file_, "line " + std::to_string(line), std::move(found), std::move(expected)};
}

std::string Words::quoted(std::string_view word) { return '"' + plain_text(word.substr(0, 40)) + '"'; }

std::string_view Words::look() const {
  if (!rest_.empty() && is_brace(rest_.front())) return rest_.substr(0, 1);
  std::size_t size = 0;
  while (size < rest_.size() && !is_blank(rest_[size]) && !is_brace(rest_[size])) ++size;
  return rest_.substr(0, size);
}

void Words::skip_blanks() {
  std::size_t size = 0;
  for (; size < rest_.size() && is_blank(rest_[size]); ++size) line_ += breaks_line(rest_, size);
  skip(size);
}

void Words::skip(std::size_t bytes) { rest_.remove_prefix(bytes); }

} // namespace tutu::rig::bvh_detail
