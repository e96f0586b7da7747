// SPDX-License-Identifier: Apache-2.0
#include "core/json_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "core/error.h"

namespace airlight {
namespace {

constexpr std::size_t kLongestQuote = 40;
constexpr double kExactIntegers = 9007199254740992;  // 2^53

std::string cut(std::string text) {
    if (text.size() <= kLongestQuote) return text;
    text.resize(kLongestQuote);
    // Not in the middle of a character.
    while (!text.empty() && (text.back() & 0xC0) == 0x80) text.pop_back();
    if (!text.empty() && (text.back() & 0x80) != 0) text.pop_back();
    return text + "...";
}

// The parser says nothing of places, so the text counts its lines while it is read. Of a number the
// parser needs the character behind it, which may begin the next line.
struct ReadingPlace {
    int line = 1;        ///< of the next character
    int value_line = 1;  ///< of the last one that was no white space
};

class CountedText {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountedText(const char* at, ReadingPlace* place) : at_(at), place_(place) {}

    reference operator*() const { return *at_; }
    CountedText& operator++() {
        if (*at_ == '\n') {
            ++place_->line;
        } else if (*at_ != ' ' && *at_ != '\t' && *at_ != '\r') {
            place_->value_line = place_->line;
        }
        ++at_;
        return *this;
    }
    CountedText operator++(int) {
        CountedText before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountedText& other) const { return at_ == other.at_; }
    bool operator!=(const CountedText& other) const { return at_ != other.at_; }

  private:
    const char* at_;
    ReadingPlace* place_;
};

std::string at_line(const std::string& name, int line) {
    return fmt::format("{}:{}", name, line);
}

}  // namespace

const JsonValue::Content JsonValue::kNothing;

const std::string& JsonValue::text() const {
    return content().text;
}

const std::vector<JsonValue>& JsonValue::items() const {
    return content().items;
}

const std::vector<std::string>& JsonValue::keys() const {
    return content().keys;
}

const JsonValue* JsonValue::find(std::string_view key) const {
    const auto& names = keys();
    const auto at = std::find(names.begin(), names.end(), key);
    return at == names.end() ? nullptr : &items()[static_cast<std::size_t>(at - names.begin())];
}

std::string shorten_json(const std::string& text) {
    const std::string quoted = nlohmann::json(text).dump();
    return cut(quoted.substr(1, quoted.size() - 2));
}

std::string JsonValue::quote() const {
    switch (kind_) {
        case Kind::null:
            return "null";
        case Kind::boolean:
            return boolean() ? "true" : "false";
        case Kind::number: {
            if (!text().empty()) return cut(text());
            std::string digits = fmt::format("{}", number_);
            const bool whole = digits.find_first_not_of("-0123456789") == std::string::npos;
            return whole && !integer_ ? digits + ".0" : digits;
        }
        case Kind::string:
            return cut(nlohmann::json(text()).dump());
        case Kind::array:
            return fmt::format("an array of {} values", items().size());
        case Kind::object:
            return "an object";
    }
    return {};
}

// Takes the parser's events. The open arrays and objects are kept apart until they are closed, so
// that nothing points into a vector that grows.
class JsonTreeBuilder {
  public:
    JsonTreeBuilder(std::string name, int deepest, const ReadingPlace& place)
        : name_(std::move(name)), deepest_(deepest), place_(place) {}

    bool null() { return add(make(JsonValue::Kind::null)); }
    bool boolean(bool value) {
        JsonValue made = make(JsonValue::Kind::boolean);
        made.number_ = value ? 1 : 0;
        return add(std::move(made));
    }
    bool number_integer(std::int64_t value) { return add_integer(value); }
    bool number_unsigned(std::uint64_t value) { return add_integer(value); }
    bool number_float(double value, const std::string&) {
        JsonValue made = make(JsonValue::Kind::number);
        made.number_ = value;
        return add(std::move(made));
    }
    bool string(std::string& value) {
        JsonValue made = make(JsonValue::Kind::string);
        made.content_->text = std::move(value);
        return add(std::move(made));
    }
    bool binary(nlohmann::json::binary_t&) { return false; }
    bool start_object(std::size_t) { return open(JsonValue::Kind::object); }
    bool start_array(std::size_t) { return open(JsonValue::Kind::array); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }
    bool key(std::string& value) {
        Open& object = open_.back();
        if (!object.known.insert(value).second) {
            throw Error(ErrorCode::data, "the field " + shorten_json(value) + " is given twice",
                        at_line(name_, place_.value_line));
        }
        object.value.content_->keys.push_back(std::move(value));
        return true;
    }
    bool parse_error(std::size_t position, const std::string& token,
                     const nlohmann::json::exception& error) {
        fault_ = position;
        // 406: a number out of range.
        if (error.id == 406) {
            throw Error(ErrorCode::data, cut(token) + " is beyond 1.8e308, the largest number",
                        at_line(name_, place_.value_line));
        }
        return false;
    }

    JsonValue take() { return std::move(root_); }
    std::size_t fault() const { return fault_; }  ///< characters read when it was found

  private:
    struct Open {
        JsonValue value;
        std::unordered_set<std::string> known;
    };

    JsonValue make(JsonValue::Kind kind) const {
        if (open_.size() > static_cast<std::size_t>(deepest_)) {
            throw Error(ErrorCode::data, fmt::format("is nested more than {} deep", deepest_),
                        at_line(name_, place_.value_line));
        }
        JsonValue value;
        value.kind_ = kind;
        value.line_ = place_.value_line;
        if (kind >= JsonValue::Kind::string) {
            value.content_ = std::make_unique<JsonValue::Content>();
        }
        return value;
    }

    template <class Integer>
    bool add_integer(Integer value) {
        JsonValue made = make(JsonValue::Kind::number);
        made.integer_ = true;
        made.number_ = static_cast<double>(value);
        if (std::abs(made.number_) >= kExactIntegers) {
            made.content_ = std::make_unique<JsonValue::Content>();
            made.content_->text = std::to_string(value);
        }
        return add(std::move(made));
    }

    bool open(JsonValue::Kind kind) {
        open_.push_back({make(kind), {}});
        return true;
    }

    bool close() {
        JsonValue value = std::move(open_.back().value);
        open_.pop_back();
        return add(std::move(value));
    }

    bool add(JsonValue value) {
        if (open_.empty()) {
            root_ = std::move(value);
        } else {
            open_.back().value.content_->items.push_back(std::move(value));
        }
        return true;
    }

    std::string name_;
    int deepest_;
    const ReadingPlace& place_;
    std::vector<Open> open_;
    JsonValue root_;
    std::size_t fault_ = 0;
};

JsonValue parse_json(const std::string& text, const std::string& name, int deepest) {
    if (text.empty()) throw Error(ErrorCode::data, "is empty", name);
    ReadingPlace place;
    JsonTreeBuilder builder(name, deepest, place);
    const char* const begin = text.data();
    if (!nlohmann::json::sax_parse(CountedText(begin, &place),
                                   CountedText(begin + text.size(), &place), &builder)) {
        if (builder.fault() > text.size()) {
            throw Error(ErrorCode::data, "is no whole JSON: it ends too early", name);
        }
        throw Error(ErrorCode::data, "is no JSON: this line cannot be read",
                    at_line(name, place.value_line));
    }
    return builder.take();
}

}  // namespace airlight
