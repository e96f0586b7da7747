// SPDX-License-Identifier: Apache-2.0
#include "core/csv.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"

namespace airlight {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
constexpr std::size_t kLongestRecord = std::size_t{1} << 20;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// The position of the line end after `begin` that is not within quotes. A quote opens only at the
// start of a field, and never in a comment.
std::size_t record_end(std::string_view text, std::size_t begin) {
    if (begin < text.size() && text[begin] == '#') return text.find('\n', begin);
    bool quoted = false;
    bool field_start = true;
    bool quoted_field = false;
    for (std::size_t i = begin; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            quoted = c != '"';
            continue;
        }
        if (c == '\n') return i;
        if (c == '"' && field_start) {
            quoted = quoted_field = true;
        } else if (c == '"' && quoted_field && text[i - 1] == '"') {
            // A doubled quote closed the field and opens it again.
            quoted = true;
        } else if (c == ',') {
            quoted_field = false;
        }
        field_start = c == ',' || (field_start && (c == ' ' || c == '\t'));
    }
    return std::string_view::npos;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

}  // namespace

CsvReader::CsvReader(int descriptor, std::string name)
    : descriptor_(descriptor), name_(std::move(name)) {}

bool CsvReader::fill() {
    const std::size_t size = buffer_.size();
    buffer_.resize(size + kBlockBytes);
    std::size_t got = 0;
    while (got < kBlockBytes) {
        const ssize_t step = read(descriptor_, buffer_.data() + size + got, kBlockBytes - got);
        if (step < 0 && errno == EINTR) continue;
        if (step < 0) {
            throw Error(ErrorCode::io, "cannot be read: " + system_message(errno), name_);
        }
        if (step == 0) {
            at_end_ = true;
            break;
        }
        got += static_cast<std::size_t>(step);
        // Whoever types, or feeds rows one by one, sees each answer.
        if (buffer_[size + got - 1] == '\n') break;
    }
    buffer_.resize(size + got);
    return got > 0;
}

void CsvReader::take_records() {
    const std::string_view text = buffer_;
    while (used_ < text.size()) {
        std::size_t end = record_end(text, used_);
        if (end == std::string_view::npos) {
            if (text.size() - used_ > kLongestRecord) {
                throw Error(ErrorCode::data, "a record is longer than 1 MiB; is a quote left open?",
                            name_ + ":" + std::to_string(line_));
            }
            if (!at_end_) return;
            end = text.size();
        }
        std::string_view record = text.substr(used_, end - used_);
        const std::size_t line = line_;
        for (const char c : record) line_ += c == '\n';
        ++line_;
        used_ = std::min(end + 1, text.size());
        if (!record.empty() && record.back() == '\r') {
            record.remove_suffix(1);
            crlf_ = crlf_ || at_start_;
        }
        if (at_start_ && record.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
            record.remove_prefix(kByteOrderMark.size());
        }
        at_start_ = false;
        if (trimmed(record).empty() || record[0] == '#') continue;
        records_.push_back({record, line});
    }
}

const std::vector<CsvRecord>& CsvReader::next_block() {
    records_.clear();
    while (records_.empty() && !(at_end_ && used_ == buffer_.size())) {
        buffer_.erase(0, used_);
        used_ = 0;
        if (!at_end_) fill();
        take_records();
    }
    return records_;
}

void csv_fields(std::string_view record, std::vector<std::string>& fields) {
    std::size_t count = 0;
    std::size_t i = 0;
    while (true) {
        if (count == fields.size()) fields.emplace_back();
        std::string& field = fields[count++];
        field.clear();
        while (i < record.size() && (record[i] == ' ' || record[i] == '\t')) ++i;
        if (i < record.size() && record[i] == '"') {
            for (++i; i < record.size(); ++i) {
                if (record[i] == '"') {
                    if (i + 1 == record.size() || record[i + 1] != '"') break;
                    ++i;
                }
                field += record[i];
            }
            ++i;
        }
        // A plain field, or what follows a closing quote by mistake.
        const std::size_t comma = std::min(record.find(',', i), record.size());
        if (i < comma) field += trimmed(record.substr(i, comma - i));
        if (comma >= record.size()) break;
        i = comma + 1;
    }
    fields.resize(count);
}

std::vector<std::string> csv_fields(std::string_view record) {
    std::vector<std::string> fields;
    csv_fields(record, fields);
    return fields;
}

// "inf" and "nan" count as numbers; what underflows is 0 or denormal, what overflows is refused.
std::optional<double> parse_double(std::string_view text) {
    if (!text.empty() && text[0] == '+') text.remove_prefix(1);
    if (text.empty() || text[0] == '+') return std::nullopt;
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (stop != text.data() + text.size()) return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        value = std::strtod(std::string(text).c_str(), nullptr);
        if (std::isinf(value)) return std::nullopt;
    } else if (error != std::errc()) {
        return std::nullopt;
    }
    return value;
}

}  // namespace airlight
