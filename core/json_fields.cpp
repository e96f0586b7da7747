// SPDX-License-Identifier: Apache-2.0
#include "core/json_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace airlight {
namespace {

// Insertions, deletions and replacements between two names.
std::size_t distance_between(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

std::string wanted_number(double low, double high) {
    if (low == -kAnyNumber) {
        return high == kAnyNumber ? "a number" : fmt::format("a number <= {}", high);
    }
    return high == kAnyNumber ? fmt::format("a number >= {}", low)
                              : fmt::format("a number in [{}, {}]", low, high);
}

std::string list_of(std::initializer_list<const char*> choices) {
    std::string text;
    std::size_t left = choices.size();
    for (const char* choice : choices) {
        text += choice;
        --left;
        text += left > 1 ? ", " : left == 1 ? " or " : "";
    }
    return text;
}

}  // namespace

JsonFields::JsonFields(const JsonValue& object, std::string path, std::string file)
    : object_(&object), path_(std::move(path)), file_(std::move(file)) {
    if (object.kind() != JsonValue::Kind::object) {
        throw Error(
            ErrorCode::data,
            fmt::format("{}is {}, not an object", path_.empty() ? "" : path_ + " ", object.quote()),
            fmt::format("{}:{}", file_, object.line()));
    }
}

std::string JsonFields::path_of(const std::string& key) const {
    return path_.empty() ? key : path_ + "." + key;
}

void JsonFields::refuse(const std::string& key, const std::string& sentence) const {
    const JsonValue* const value = object_->find(key.substr(0, key.find('[')));
    throw Error(ErrorCode::data, path_of(key) + " " + sentence,
                fmt::format("{}:{}", file_, (value ? value : object_)->line()));
}

void JsonFields::refuse_value(const std::string& key, const JsonValue& value,
                              const std::string& wanted) const {
    throw Error(ErrorCode::data, path_of(key) + " is " + value.quote() + ", not " + wanted,
                fmt::format("{}:{}", file_, value.line()));
}

void JsonFields::know(std::initializer_list<const char*> keys) const {
    for (std::size_t i = 0; i < object_->keys().size(); ++i) {
        const std::string& key = object_->keys()[i];
        if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
        std::string nearest;
        std::size_t least = 3;  // more mistakes make it another word
        for (const char* known : keys) {
            const std::size_t distance =
                key.size() < 40 ? distance_between(key, known) : key.size();
            if (distance < least && distance < std::string(known).size() && !has(known)) {
                least = distance;
                nearest = known;
            }
        }
        throw Error(ErrorCode::data,
                    "the field " + path_of(shorten_json(key)) + " is unknown" +
                        (nearest.empty() ? "" : "; is " + nearest + " meant?"),
                    fmt::format("{}:{}", file_, object_->items()[i].line()));
    }
}

const JsonValue& JsonFields::at(const char* key) const {
    if (const JsonValue* value = object_->find(key)) return *value;
    throw Error(ErrorCode::data, "the field " + path_of(key) + " is missing",
                fmt::format("{}:{}", file_, object_->line()));
}

double JsonFields::number_of(const std::string& key, const JsonValue& value, double low,
                             double high) const {
    const double number = value.number();
    if (value.kind() != JsonValue::Kind::number || !(number >= low && number <= high)) {
        refuse_value(key, value, wanted_number(low, high));
    }
    return number;
}

double JsonFields::number(const char* key, double low, double high) const {
    return number_of(key, at(key), low, high);
}

int JsonFields::integer(const char* key, int low, int high) const {
    const JsonValue& value = at(key);
    const double number = value.number();
    if (value.kind() != JsonValue::Kind::number || number != std::floor(number) ||
        !(number >= low && number <= high)) {
        refuse_value(key, value, fmt::format("an integer in [{}, {}]", low, high));
    }
    return static_cast<int>(number);
}

bool JsonFields::boolean(const char* key) const {
    const JsonValue& value = at(key);
    if (value.kind() != JsonValue::Kind::boolean) refuse_value(key, value, "true or false");
    return value.boolean();
}

std::string JsonFields::text(const char* key) const {
    const JsonValue& value = at(key);
    if (value.kind() != JsonValue::Kind::string) refuse_value(key, value, "a text");
    return value.text();
}

std::vector<double> JsonFields::all_of(const char* key, const JsonValue& array, double low,
                                       double high) const {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < array.items().size(); ++i) {
        numbers.push_back(number_of(fmt::format("{}[{}]", key, i), array.items()[i], low, high));
    }
    return numbers;
}

std::vector<double> JsonFields::numbers(const char* key, std::size_t count, double low,
                                        double high) const {
    const JsonValue& value = at(key);
    if (value.kind() != JsonValue::Kind::array || value.items().size() != count) {
        refuse_value(key, value, fmt::format("an array of {} numbers", count));
    }
    return all_of(key, value, low, high);
}

std::vector<double> JsonFields::channels(const char* key, double low, double high) const {
    const JsonValue& value = at(key);
    if (value.kind() == JsonValue::Kind::number) return {number_of(key, value, low, high)};
    const std::size_t count = value.items().size();
    if (value.kind() != JsonValue::Kind::array || (count != 1 && count != 3)) {
        refuse_value(key, value, "an array of one number or three");
    }
    return all_of(key, value, low, high);
}

int JsonFields::choice(const char* key, std::initializer_list<const char*> choices) const {
    const JsonValue& value = at(key);
    const auto* const found = std::find(choices.begin(), choices.end(), value.text());
    if (value.kind() != JsonValue::Kind::string || found == choices.end()) {
        refuse_value(key, value, list_of(choices));
    }
    return static_cast<int>(found - choices.begin());
}

JsonFields JsonFields::object(const char* key) const {
    return JsonFields(at(key), path_of(key), file_);
}

std::vector<JsonFields> JsonFields::objects(const char* key) const {
    const JsonValue& value = at(key);
    if (value.kind() != JsonValue::Kind::array) refuse_value(key, value, "an array of objects");
    std::vector<JsonFields> fields;
    for (std::size_t i = 0; i < value.items().size(); ++i) {
        fields.emplace_back(value.items()[i], fmt::format("{}[{}]", path_of(key), i), file_);
    }
    return fields;
}

JsonFields versioned_fields(const JsonValue& root, const char* key, int version,
                            const std::string& what, const std::string& file) {
    if (root.find(key) == nullptr) {
        throw Error(ErrorCode::data, fmt::format("is no {}: the field {} is missing", what, key),
                    file);
    }
    JsonFields fields(root, "", file);
    const JsonValue& value = fields.at(key);
    if (!value.is_integer() || value.number() != version) {
        fields.refuse_value(key, value, fmt::format("version {}, the only one known", version));
    }
    return fields;
}

}  // namespace airlight
