// SPDX-License-Identifier: Apache-2.0
// Reading the objects of a JSON text strictly: each complaint names the file, the line, the field
// by its path, what it is and what it should be.
#pragma once

#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "core/json_tree.h"

namespace airlight {

/// The whole of the doubles.
inline constexpr double kAnyNumber = std::numeric_limits<double>::max();

/// An object of the text. Everything it throws is an Error(data) at "file:line". It refers to the
/// tree, which must live on.
class JsonFields {
  public:
    /// `path` is what messages call the object: "media[0]", or nothing for the whole text. Throws
    /// unless the value is an object.
    JsonFields(const JsonValue& object, std::string path, std::string file);

    const std::string& file() const { return file_; }

    /// Refuses fields that are not among `keys`, with the nearest of those that are.
    void know(std::initializer_list<const char*> keys) const;

    bool has(const char* key) const { return object_->find(key) != nullptr; }
    /// What the field holds; throws when it is missing.
    const JsonValue& at(const char* key) const;

    double number(const char* key, double low = -kAnyNumber, double high = kAnyNumber) const;
    int integer(const char* key, int low, int high) const;
    bool boolean(const char* key) const;
    std::string text(const char* key) const;
    /// `count` numbers.
    std::vector<double> numbers(const char* key, std::size_t count, double low = -kAnyNumber,
                                double high = kAnyNumber) const;
    /// One number, alone or in an array, or three.
    std::vector<double> channels(const char* key, double low, double high) const;
    /// An index into `choices`.
    int choice(const char* key, std::initializer_list<const char*> choices) const;
    JsonFields object(const char* key) const;
    /// The objects of an array.
    std::vector<JsonFields> objects(const char* key) const;

    /// "the field's path and `sentence`", at the field's line or else the object's.
    [[noreturn]] void refuse(const std::string& key, const std::string& sentence) const;
    /// "… is VALUE, not `wanted`".
    [[noreturn]] void refuse_value(const std::string& key, const JsonValue& value,
                                   const std::string& wanted) const;

    /// One of the numbers of a field, whose name `key` may hold an index.
    double number_of(const std::string& key, const JsonValue& value, double low, double high) const;

  private:
    std::string path_of(const std::string& key) const;
    std::vector<double> all_of(const char* key, const JsonValue& array, double low,
                               double high) const;

    const JsonValue* object_;
    std::string path_, file_;
};

/// The fields of a text whose format, `what` ("scene"), names its version in the field `key`.
/// Throws Error(data) for what lacks that field or has another version.
JsonFields versioned_fields(const JsonValue& root, const char* key, int version,
                            const std::string& what, const std::string& file);

}  // namespace airlight
