// SPDX-License-Identifier: Apache-2.0
// Comma-separated values in, record by record, in blocks of bounded size.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace airlight {

/// One record of a CSV file as it stands there, without its line end.
struct CsvRecord {
    std::string_view text;
    std::size_t line = 0;  ///< of its start, from 1
};

/// Reads RFC 4180 records from a descriptor: fields may be quoted, and quoted fields may hold
/// commas, doubled quotes and line ends. Lines end with LF or CRLF; blank lines and lines that
/// begin with # are skipped, and so is a byte order mark.
class CsvReader {
  public:
    /// `name` is for messages.
    CsvReader(int descriptor, std::string name);

    /// The next records, about a megabyte of them, valid until the next call; none at the end.
    /// Throws Error: io when reading fails, data for a record beyond 1 MiB (an open quote).
    const std::vector<CsvRecord>& next_block();

    /// Whether the first line ended with CRLF, so that the output may too.
    bool crlf() const { return crlf_; }

  private:
    bool fill();
    void take_records();

    int descriptor_;
    std::string name_;
    std::string buffer_;
    std::vector<CsvRecord> records_;
    std::size_t used_ = 0;
    std::size_t line_ = 1;
    bool at_start_ = true;
    bool at_end_ = false;
    bool crlf_ = false;
};

/// The record's fields, unquoted and without white space around them.
std::vector<std::string> csv_fields(std::string_view record);

/// The same into a vector whose memory is used again.
void csv_fields(std::string_view record, std::vector<std::string>& fields);

/// A number as CSV files hold it, all of the text; nothing when it is none.
std::optional<double> parse_double(std::string_view text);

}  // namespace airlight
