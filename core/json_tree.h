// SPDX-License-Identifier: Apache-2.0
// JSON texts as a tree that knows the line of every value, for formats that answer for every key.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace airlight {

/// Bytes of memory that a tree takes per byte of its text, at most.
inline constexpr std::size_t kJsonTreeBytes = 64;

/// A value and what is in it.
class JsonValue {
  public:
    enum class Kind : std::uint8_t { null, boolean, number, string, array, object };

    Kind kind() const { return kind_; }
    int line() const { return line_; }  ///< where it begins, counted from 1

    bool boolean() const { return number_ != 0; }
    double number() const { return number_; }      ///< rounded to nearest
    bool is_integer() const { return integer_; }   ///< written without fraction and exponent
    const std::string& text() const;               ///< of a string, UTF-8
    const std::vector<JsonValue>& items() const;   ///< of an array, or the values of an object
    const std::vector<std::string>& keys() const;  ///< of an object, in the order of its items

    /// What an object has under that key, or null.
    const JsonValue* find(std::string_view key) const;

    /// The value as messages show it: on one line, cut after 40 characters; "an array of 3 values".
    std::string quote() const;

  private:
    friend class JsonTreeBuilder;

    struct Content {
        std::string text;
        std::vector<JsonValue> items;
        std::vector<std::string> keys;
    };
    static const Content kNothing;
    const Content& content() const { return content_ ? *content_ : kNothing; }

    Kind kind_ = Kind::null;
    bool integer_ = false;
    int line_ = 1;
    double number_ = 0;
    std::unique_ptr<Content> content_;
};

/// The tree of a JSON text. `deepest` is the depth of the deepest value that is taken, 0 being the
/// whole text's own.
///
/// Throws Error(data) naming `name` and the line, for what is empty, cut off or no JSON, a number
/// beyond the largest double, a key that an object has twice, what is nested too deep.
JsonValue parse_json(const std::string& text, const std::string& name, int deepest);

/// A key or a text on one line as JSON would write it, cut after 40 characters.
std::string shorten_json(const std::string& text);

}  // namespace airlight
