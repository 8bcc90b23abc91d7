#include "src/study/chart/results_file.h"

#include "rig/error.h"
#include "rig/io/file_io.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <map>
#include <stdexcept>
#include <sys/file.h>
#include <unistd.h>

namespace tutu::app {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
  throw std::runtime_error(file.string() + ": " + what + ": " + std::strerror(errno));
}

/// An open file that only this process writes to.
class LockedFile {
public:
  explicit LockedFile(const std::filesystem::path& file)
      : file_(file), descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) fail(file, "cannot be opened");
    if (::flock(descriptor_, LOCK_EX) != 0) {
      ::close(descriptor_);
      fail(file, "cannot be locked");
    }
  }
  ~LockedFile() { ::close(descriptor_); }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  /// Cuts the file to `size` bytes and adds `bytes`.
  void write_at(std::size_t size, const std::string& bytes) {
    if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail(file_, "cannot be cut");
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t wrote =
          ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(size + done));
      if (wrote < 0) fail(file_, "cannot be written");
      done += static_cast<std::size_t>(wrote);
    }
    if (::fsync(descriptor_) != 0) fail(file_, "cannot be flushed");
  }

private:
  std::filesystem::path file_;
  int descriptor_;
};

void check_header(const std::filesystem::path& file, std::string_view line) {
  const auto found = values_of_csv(line);
  if (found == row_columns()) return;
  std::size_t first = 0; // that is another
  while (found && first < std::min(found->size(), row_columns().size()) && (*found)[first] == row_columns()[first])
    ++first;
  const auto name = [first](const std::vector<std::string>& columns) {
    return first < columns.size() ? '"' + columns[first].substr(0, 60) + '"' : std::string("no more");
  };
  throw InputError(file.string(), "line 1",
                   found ? fmt::format("{} as column {} of {}", name(*found), first + 1, found->size())
                         : "an open quote",
                   fmt::format("the columns of this version ({}, here {}); move the file away to begin anew",
                               row_columns().size(), name(row_columns())));
}

} // namespace

std::string csv_line(const std::vector<std::string>& values) {
  std::string line;
  for (const std::string& value : values) {
    if (&value != &values.front()) line += ',';
    std::string plain = value;
    for (char& c : plain)
      if (c == '\n' || c == '\r') c = ' ';
    if (plain.find_first_of(",\"") == plain.npos) {
      line += plain;
      continue;
    }
    line += '"';
    for (const char c : plain) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + '\n';
}

std::optional<std::vector<std::string>> values_of_csv(std::string_view line) {
  if (line.ends_with('\n')) line.remove_suffix(1);
  std::vector<std::string> values(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') values.back() += line[++i];
    else if (c == '"') quoted = !quoted;
    else if (c == ',' && !quoted) values.emplace_back();
    else values.back() += c;
  }
  if (quoted) return {};
  return values;
}

void add_row(const std::filesystem::path& file, const Row& row) {
  LockedFile locked(file);
  const std::string old = read_file(file);
  const std::size_t whole = old.rfind('\n') == old.npos ? 0 : old.rfind('\n') + 1;
  if (whole == 0) {
    locked.write_at(0, csv_line(row_columns()) + csv_line(row.values()));
    return;
  }
  check_header(file, std::string_view(old).substr(0, old.find('\n')));
  locked.write_at(whole, csv_line(row.values()));
}

Results read_results(const std::filesystem::path& file) {
  Results results;
  if (!std::filesystem::exists(file)) return results;
  const std::string text = read_file(file);
  std::map<std::string, std::size_t> places; // of the keys, in the rows
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    const bool cut = end == text.npos;
    const std::string_view line = std::string_view(text).substr(begin, cut ? text.npos : end - begin);
    begin = cut ? text.size() : end + 1;
    if (++number == 1) {
      if (cut) return results; // not even the columns were written
      check_header(file, line);
      continue;
    }
    const auto values = values_of_csv(line);
    const std::size_t found = values ? values->size() : 0;
    if (cut || found != row_columns().size()) {
      results.notes.push_back(fmt::format(
          "{}: line {}: found {}, expected {} values; this row is dropped and its run done again", file.string(),
          number, cut ? "a row cut off in the middle" : std::to_string(found) + " values", row_columns().size()));
      continue;
    }
    Row row(*values);
    const auto [known, is_new] = places.try_emplace(values->front(), results.rows.size());
    if (is_new) results.rows.push_back(std::move(row));
    else if (Row& old = results.rows[known->second]; old.text("outcome") == k_crashed) old = std::move(row);
  }
  return results;
}

int merge_rows(const std::filesystem::path& from, const std::filesystem::path& into) {
  std::map<std::string, bool> crashed; // by key, of what is there
  for (const Row& row : read_results(into).rows) crashed[row.text("key")] = row.text("outcome") == k_crashed;
  int added = 0;
  for (const Row& row : read_results(from).rows) {
    const auto known = crashed.find(row.text("key"));
    if (known != crashed.end() && (!known->second || row.text("outcome") == k_crashed)) continue;
    add_row(into, row);
    ++added;
  }
  return added;
}

} // namespace tutu::app
