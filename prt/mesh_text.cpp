// SPDX-License-Identifier: Apache-2.0
#include "prt/mesh_text.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

namespace airlight::detail {
namespace {

constexpr std::size_t kLongestQuote = 24;

bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Whether a decimal number outside double's range is a large one. Its value is its first digit
/// that is not 0, times ten to a power: that power's sign tells.
bool is_large(std::string_view word) {
    std::int64_t power = 0;
    bool point = false, begun = false;
    std::size_t i = 0;
    for (; i < word.size() && (is_digit(word[i]) || word[i] == '.' || word[i] == '-'); ++i) {
        if (word[i] == '.') point = true;
        if (!is_digit(word[i])) continue;
        begun = begun || word[i] != '0';
        if (begun && !point) ++power;
        if (!begun && point) --power;
    }
    std::int64_t exponent = 0;
    if (i + 1 < word.size()) parse_integer(word.substr(i + 1), exponent);
    // Neither sum can wrap around: a word has fewer than 2^62 digits.
    constexpr std::int64_t kMost = std::int64_t{1} << 62;
    return std::clamp(exponent, -kMost, kMost) + power > 0;
}

std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

}  // namespace

TextLines::TextLines(std::string_view text, char comment, bool continued, std::size_t first_number)
    : text_(text),
      comment_(comment),
      continued_(continued),
      line_end_(text.find('\n') == std::string_view::npos ? '\r' : '\n'),
      next_number_(first_number) {}

// A backslash that joins lines; both it and the line's end separate words.
bool TextLines::is_break(std::size_t at) const {
    if (is_space(text_[at])) return true;
    if (!continued_ || text_[at] != '\\') return false;
    if (at + 1 < stop_ && text_[at + 1] == line_end_) return true;
    return at + 2 < stop_ && text_[at + 1] == '\r' && text_[at + 2] == line_end_;
}

std::size_t TextLines::find_end(std::size_t from) const {
    const void* found = from < text_.size()
                            ? std::memchr(text_.data() + from, line_end_, text_.size() - from)
                            : nullptr;
    return found == nullptr
               ? text_.size()
               : static_cast<std::size_t>(static_cast<const char*>(found) - text_.data());
}

bool TextLines::next() {
    if (end_ >= text_.size()) return false;
    at_ = end_;
    number_ = next_number_;
    for (std::size_t from = at_;;) {
        stop_ = find_end(from);
        end_ = std::min(stop_ + 1, text_.size());
        ++next_number_;
        std::size_t last = stop_;
        if (last > from && text_[last - 1] == '\r') --last;
        if (!continued_ || end_ >= text_.size() || last == from || text_[last - 1] != '\\') break;
        from = end_;
    }
    if (comment_ != 0 && stop_ > at_) {
        if (const void* found = std::memchr(text_.data() + at_, comment_, stop_ - at_)) {
            stop_ = static_cast<std::size_t>(static_cast<const char*>(found) - text_.data());
        }
    }
    return true;
}

bool TextLines::next_filled() {
    while (next()) {
        while (at_ < stop_ && is_break(at_)) ++at_;
        if (at_ < stop_) return true;
    }
    return false;
}

std::string_view TextLines::word() {
    while (at_ < stop_ && is_break(at_)) ++at_;
    const std::size_t begin = at_;
    while (at_ < stop_ && !is_break(at_)) ++at_;
    return text_.substr(begin, at_ - begin);
}

std::size_t TextLines::words_left() const {
    std::size_t count = 0;
    bool inside = false;
    for (std::size_t at = at_; at < stop_; ++at) {
        const bool part = !is_break(at);
        count += part && !inside;
        inside = part;
    }
    return count;
}

bool parse_real(std::string_view word, double& value) {
    word = without_plus(word);
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end || error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range) {
        value = is_large(word) ? std::numeric_limits<double>::infinity() : 0.0;
        if (word[0] == '-') value = -value;
    }
    return true;
}

bool parse_integer(std::string_view word, std::int64_t& value) {
    word = without_plus(word);
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end || error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range) {
        value = word[0] == '-' ? std::numeric_limits<std::int64_t>::min()
                               : std::numeric_limits<std::int64_t>::max();
    }
    return true;
}

std::string quote_word(std::string_view word) {
    std::string text(word.substr(0, kLongestQuote));
    for (char& c : text) {
        if (c < ' ' || c > '~') c = '?';
    }
    return "\"" + text + (word.size() > kLongestQuote ? "...\"" : "\"");
}

std::string lower_case(std::string_view word) {
    std::string text(word.substr(0, 16));
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return text;
}

}  // namespace airlight::detail
