// results.csv: one row a run, added as runs end, by any number of processes, and read back whatever happened meanwhile.
#pragma once

#include "src/study/chart/row.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tutu::app {

/// Adds a row in one piece and flushes it to disk. Only one process writes at a time (flock). What a crash left of a
/// row at the end is cut off first; a new file begins with the names of the columns. Throws InputError on a file of
/// other columns, std::runtime_error with the system's reason.
void add_row(const std::filesystem::path& file, const Row& row);

struct Results {
  std::vector<Row> rows;          ///< one a key: the first that did not crash, or the first
  std::vector<std::string> notes; ///< what was dropped, one sentence each, with its line
};

/// No rows for a file that is not there. A row that is cut or has another number of columns is dropped and noted, a
/// second row of one key is dropped. Throws InputError on a file of other columns.
Results read_results(const std::filesystem::path& file);

/// Adds the rows of `from` whose keys `into` does not have, or has from a crash only; returns how many.
int merge_rows(const std::filesystem::path& from, const std::filesystem::path& into);

/// One line of CSV [RFC 4180], quoted where it must be; line breaks in values become blanks.
std::string csv_line(const std::vector<std::string>& values);
/// Its values; nothing for an open quote.
std::optional<std::vector<std::string>> values_of_csv(std::string_view line);

} // namespace tutu::app
