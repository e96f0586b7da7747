// SPDX-License-Identifier: Apache-2.0
// Text files of numbers, line by line, for the sources of this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace airlight::detail {

/// The words of a text, line by line. Lines end at line feeds, in a text that has none at carriage
/// returns; the rest of ASCII's white space separates words.
class TextLines {
  public:
    /// `comment` begins a comment that reaches to the end of the line, 0 for none; with
    /// `continued`, a backslash at the end of a line joins the next one to it. Lines are counted
    /// from `first_number`.
    TextLines(std::string_view text, char comment, bool continued, std::size_t first_number = 1);

    /// Goes to the next line, which may be blank; false at the end.
    bool next();
    /// Goes to the next line that holds a word; false at the end.
    bool next_filled();
    /// The next word of the line, empty behind the last.
    std::string_view word();
    /// The number of words that are left on the line.
    std::size_t words_left() const;

    std::size_t number() const { return number_; }
    std::size_t bytes_left() const { return text_.size() - end_; }

  private:
    bool is_break(std::size_t at) const;
    std::size_t find_end(std::size_t from) const;

    std::string_view text_;
    char comment_;
    bool continued_;
    char line_end_;
    std::size_t at_ = 0;       ///< where the next word is looked for
    std::size_t stop_ = 0;     ///< end of the line's words
    std::size_t end_ = 0;      ///< begin of the next line
    std::size_t number_ = 0;   ///< of this line
    std::size_t next_number_;  ///< of the next one
};

/// Takes a whole word as a number; false when it is none. "nan" and "inf" are numbers, what is too
/// large for a double is infinite, what is too small is 0.
bool parse_real(std::string_view word, double& value);

/// Takes a whole word as an integer; false when it is none. What is too large for the type becomes
/// its largest or smallest value.
bool parse_integer(std::string_view word, std::int64_t& value);

/// A word for messages: in quotation marks, shortened, without what does not print.
std::string quote_word(std::string_view word);

/// The word in small letters of ASCII, at most the first 16.
std::string lower_case(std::string_view word);

}  // namespace airlight::detail
